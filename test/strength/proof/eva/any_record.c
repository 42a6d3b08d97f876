/* SPDX-License-Identifier: MIT */
/* PROVES: records
 * Any bytes of some lengths as a record, whatever length they claim. A record begun and ended
 * anywhere through a cursor that writes, reads or measures. Header and event through any cursor.
 *
 * EVA: -eva-slevel 100
 * PLANT: lib/src/talk/record.c: len_B < end + 4 -> len_B < end
 * PLANT: lib/src/talk/record.c: (char)(u < 0x80u ? (int)u : (int)u - 0x100) -> (char)u
 * PLANT: lib/src/talk/record.c: if (!exh_bytes_ok(c) || end < HEAD_B || end - HEAD_B > UINT16_MAX) { return 0; } -> (void)0;
 * PLANT: lib/src/talk/record.c: c->mode == EXH_BYTES_WRITE ? exh_crc32(0, c->p, end) : 0 -> exh_crc32(0, c->p, end)
 */
#include "num/bytes.c"
#include "num/crc.c"
#include "talk/record.c"

#include "any.h"

#define MAX_B 40

static uint8_t bytes_B[MAX_B];
static struct exh_record_header header;
static struct exh_event event;

/* Its end is the end of the array. */
static void read(uint32_t len_B)
{
    static struct exh_record r;
    int32_t n;
    ANY(bytes_B);
    n = exh_record_decode(bytes_B + (MAX_B - len_B), len_B, &r);
    if (n >= 0) {
        /*@ assert all_there: 18 <= n <= len_B; */
        if (r.len_B > 0) {
            const uint8_t last = r.payload[r.len_B - 1];
            (void)last;
        }
    }
}

static void through(struct exh_bytes c)
{
    uint32_t n;
    c.at = any_u32();
    exh_record_header_serialize(&c, &header);
    exh_event_serialize(&c, &event);
    exh_record_begin(&c, any8(), any_u32(), any_u32());
    c.at = any_u32();
    n = exh_record_end(&c);
    (void)n;
}

int main(void)
{
    static const uint32_t len_B[] = {0, 1, 2, 13, 14, 17, 18, 19, 22, MAX_B};
    static const size_t cap_B[] = {0, 3, 17, 18, MAX_B};
    for (unsigned i = 0; i < sizeof len_B / sizeof len_B[0]; i++) { read(len_B[i]); }
    ANY(header);
    ANY(event);
    for (unsigned i = 0; i < sizeof cap_B / sizeof cap_B[0]; i++) {
        through(exh_bytes_writer(bytes_B + (MAX_B - cap_B[i]), cap_B[i]));
        through(exh_bytes_reader(bytes_B + (MAX_B - cap_B[i]), cap_B[i]));
    }
    through(exh_bytes_measure());
    END();
    return 0;
}
