/* SPDX-License-Identifier: MIT */
/* PROVES: slots
 * Anything in both slots, of sizes around the least and one of 40 bytes, whatever length they
 * claim. The next save of images of some lengths and any content, in buffers of some sizes.
 *
 * EVA: -eva-slevel 300
 * PLANT: lib/src/talk/slots.c: if (len_B > slot_B - EXH_SLOT_B(0)) { return -EXH_E_SHORT; } -> (void)0;
 * PLANT: lib/src/talk/slots.c: if (slot_B < EXH_SLOT_B(0)) { return -EXH_E_SHORT; } -> (void)0;
 * PLANT: lib/src/talk/slots.c: if (!has_a && !has_b) { return -EXH_E_ABSENT; } -> (void)0;
 * PLANT: lib/src/talk/slots.c: if (has_a && has_b) { -> {
 * PLANT: lib/src/talk/slots.c: || image_B > room_B - EXH_SLOT_B(0) -> || 0
 * PLANT: lib/src/talk/slots.c: uint32_t magic = MAGIC, len_B = (uint32_t)image_B, sequence, crc; -> uint32_t magic = MAGIC, len_B = (uint32_t)image_B + 1, sequence, crc;
 */
#include "num/bytes.c"
#include "num/crc.c"
#include "talk/slots.c"

#include "any.h"

#define SLOT_MAX_B 40

static uint8_t first[SLOT_MAX_B], second[SLOT_MAX_B], buf[SLOT_MAX_B];

static void read(size_t slot_B)
{
    struct exh_slot is;
    ANY(first);
    ANY(second);
    if (exh_slot_decode(&is, first + (SLOT_MAX_B - slot_B), slot_B) == 0 && is.len_B > 0) {
        const uint8_t last = is.image[is.len_B - 1];
        (void)last;
    }
    if (exh_slots_find(
            &is, first + (SLOT_MAX_B - slot_B), second + (SLOT_MAX_B - slot_B), slot_B) >= 0) {
        /*@ assert sequence: 1 <= is.sequence <= 0xFFFFFFFE; */
    }
}

static void image_next(size_t slot_B, size_t cap_B, size_t image_B)
{
    unsigned to = 0;
    int32_t n;
    ANY(first);
    ANY(second);
    ANY(buf);
    n = exh_slots_encode(&to, first + (SLOT_MAX_B - slot_B), second + (SLOT_MAX_B - slot_B), slot_B,
        buf + (SLOT_MAX_B - cap_B), cap_B, image_B);
    /*@ assert what_fits: n <= 40; */
    /*@ assert a_slot: to <= 1; */
}

int main(void)
{
    read(0);
    for (size_t B = 19; B <= 22; B++) { read(B); }
    read(SLOT_MAX_B);
    for (size_t image_B = 0; image_B <= SLOT_MAX_B - EXH_SLOT_B(0); image_B += 10) {
        image_next(SLOT_MAX_B, SLOT_MAX_B, image_B);
        image_next(EXH_SLOT_B(4), SLOT_MAX_B, image_B);
        image_next(SLOT_MAX_B, EXH_SLOT_B(4), image_B);
    }
    image_next(SLOT_MAX_B, SLOT_MAX_B, any_u32());
    image_next(12, SLOT_MAX_B, 0);
    image_next(SLOT_MAX_B, 12, 0);
    END();
    return 0;
}
