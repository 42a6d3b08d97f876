/* SPDX-License-Identifier: MIT */
/* slots: images in two slots of flash, cut off and damaged, and which of them counts. */
#include "modules.h"

#include "exhand/slots.h"

#define MOST_B 84u
#define BUF_B  96u

struct box {
    uint8_t slot[2][MOST_B];
    uint32_t slot_B;
    uint8_t image[MOST_B]; /* the one before */
    uint32_t image_B;
};

static uint32_t any_sequence(struct golden_rng *r)
{
    static const uint32_t near[] = {1, 0x7FFFFFFFu, 0x80000000u, 0xFFFFFFFEu};
    const uint32_t at = near[golden_draw(r, 0, 3)];
    return at + (uint32_t)golden_draw(r, -1, 1);
}

/* As a box with this sequence would have written it. */
static void forge(uint8_t *slot, uint32_t sequence, uint32_t len_B)
{
    struct exh_bytes c = exh_bytes_writer(slot, MOST_B);
    uint32_t magic = 0x53485845u, crc;
    exh_bytes_u32(&c, &magic);
    exh_bytes_u32(&c, &sequence);
    exh_bytes_u32(&c, &len_B);
    for (uint32_t i = 0; i < len_B; i++) {
        uint8_t v = (uint8_t)(37 * i & 255);
        exh_bytes_u8(&c, &v);
    }
    crc = exh_crc32(0, slot, c.at);
    exh_bytes_u32(&c, &crc);
    exh_bytes_u32(&c, &sequence);
}

/* Blank, or each with an image of any sequence; often those two are close to where it turns. */
static void any_slots(struct box *b, struct golden_rng *r)
{
    static const uint32_t ahead[] = {0, 1, 0x7FFFFFFFu, 0x80000000u};
    uint32_t sequence = 0;
    b->slot_B = (uint32_t)golden_draw(r, 19, 84);
    b->image_B = 0;
    (void)memset(b->slot, 0xFF, sizeof b->slot);
    for (unsigned k = 0; k < 2; k++) {
        const int64_t forged = golden_draw(r, 0, 3);
        const uint32_t len_B = (uint32_t)golden_draw(r, 0, 31);
        const int kin = k > 0 && golden_draw(r, 0, 1) != 0;
        sequence = kin ? sequence + ahead[golden_draw(r, 0, 3)] : any_sequence(r);
        if (forged && EXH_SLOT_B(len_B) <= b->slot_B) { forge(b->slot[k], sequence, len_B); }
    }
}

/* The next image, and what is to be programmed: cut off, over ones, zeros or what was there. */
static void any_save(struct golden *g, struct box *b, struct golden_rng *r)
{
    const int64_t size = b->slot_B;
    const uint32_t length = (uint32_t)golden_draw(r, 0, size);
    const uint32_t first = (uint32_t)golden_draw(r, 0, 255);
    const int again = golden_draw(r, 0, 3) == 0;
    const int is_short = golden_draw(r, 0, 7) == 0;
    const uint32_t cap_B = is_short ? (uint32_t)golden_draw(r, 0, size) : BUF_B;
    uint8_t buf[BUF_B + MOST_B] = {0};
    unsigned to = 9;
    int64_t blank, cut;
    int32_t n;
    if (!again) {
        for (uint32_t i = 0; i < length; i++) { b->image[i] = (uint8_t)((first + 37 * i) & 255); }
        b->image_B = length;
    }
    if (!is_short && EXH_SLOT_B(b->image_B) > cap_B) { b->image_B = cap_B - EXH_SLOT_B(0); }
    (void)memcpy(buf + EXH_SLOT_HEAD_B, b->image, b->image_B);
    n = exh_slots_encode(&to, b->slot[0], b->slot[1], b->slot_B, buf, cap_B, b->image_B);
    golden_put(g, n);
    golden_put(g, to);
    blank = golden_draw(r, 0, 2);
    cut = golden_draw(r, 0, 3 * size);
    if (n <= 0) { return; }
    if (blank < 2) { (void)memset(b->slot[to], blank ? 0x00 : 0xFF, b->slot_B); }
    (void)memcpy(b->slot[to], buf, (size_t)(cut < n ? cut : n));
}

static void put_what_counts(struct golden *g, const struct box *b)
{
    struct exh_slot is = {NULL, 0, 0};
    for (unsigned k = 0; k < 2; k++) {
        struct exh_slot one;
        golden_put(g, exh_slot_decode(&one, b->slot[k], b->slot_B));
    }
    golden_put(g, exh_slots_find(&is, b->slot[0], b->slot[1], b->slot_B));
    golden_put(g, is.sequence);
    golden_put(g, is.len_B);
    golden_put(g, is.image ? exh_crc32(0, is.image, is.len_B) : 0);
}

static void memory_bytes(struct exh_bytes *c, struct box *b)
{
    for (uint32_t i = 0; i < 2 * b->slot_B; i++) {
        exh_bytes_u8(c, &b->slot[i >= b->slot_B][i % b->slot_B]);
    }
}

void golden_slots(struct golden *g, uint32_t rate_Hz)
{
    static struct box b;
    struct golden_rng r = golden_rng("slots", rate_Hz, 0);
    while (g->tick < GOLDEN_TICKS) {
        struct exh_bytes c;
        int64_t bit;
        if (g->tick % 4 == 0) { any_slots(&b, &r); }
        any_save(g, &b, &r);
        bit = golden_draw(&r, 0, 31 * (int64_t)b.slot_B);
        if (bit < 16 * (int64_t)b.slot_B) {
            b.slot[bit & 1][bit >> 4] ^= (uint8_t)(UINT32_C(1) << (bit >> 1 & 7));
        }
        put_what_counts(g, &b);
        c = golden_state(g);
        memory_bytes(&c, &b);
        golden_state_end(g, &c);
        golden_tick(g);
    }
}
