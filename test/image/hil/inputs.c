/* SPDX-License-Identifier: MIT */
#include "inputs.h"

#include "exhand/safety.h"

static uint32_t draw(struct inputs *s)
{
    s->state = s->state * UINT64_C(6364136223846793005) + UINT64_C(1442695040888963407);
    return (uint32_t)(s->state >> 32);
}

/* One time in n. */
static int one_in(struct inputs *s, uint32_t n) { return draw(s) % n == 0; }

/* From the whole range, its ends, or beside the last. */
static uint32_t value(struct inputs *s, uint32_t last, uint32_t mask)
{
    static const uint32_t ends[] = {0, 1, 0x7FFF, 0x8000, 0xFFFF, 0x7FFFFF, 0x800000, 0xFFFFFF};
    switch (draw(s) % 8) {
    case 0:
    case 1: return draw(s) & mask;
    case 2: return ends[draw(s) % 8] & mask;
    case 3: return last;
    case 4: return (last + draw(s) % 400) & mask;
    case 5: return (last - draw(s) % 400) & mask;
    default: return (last + draw(s) % 3 - 1) & mask;
    }
}

/* What runs is let run; what does not is helped to: a fault is cleared, then run. */
static uint8_t command(struct inputs *s, int runs, uint8_t given)
{
    if (runs) { return one_in(s, 1024) ? (uint8_t)(draw(s) % 4) : given; }
    return draw(s) & 1 ? EXH_CMD_CLEAR : EXH_CMD_RUN;
}

void inputs_next(struct inputs *s, int runs, struct exh_scene_in *in)
{
    struct exh_scene_in *last = &s->last;
    const int wild = one_in(s, 64); /* a fault, as a rule, and in a fault less happens */
    for (unsigned i = 0; i < EXH_FINGERS; i++) {
        s->walk[i] += draw(s) % 25 - 12;
        in->drive.enc_raw[i] = wild && s->torn && one_in(s, 8)
                                   ? value(s, last->drive.enc_raw[i], 0xFFFFFF)
                                   : (in->drive.enc_raw[i] + s->walk[i]) & 0xFFFFFF;
        if (!wild) { continue; }
        in->drive.mon_raw[i] = (int16_t)value(s, (uint16_t)last->drive.mon_raw[i], 0xFFFF);
    }
    in->drive.supply_raw = (int16_t)value(s, (uint16_t)last->drive.supply_raw, 0xFFFF);
    in->drive.din = wild && one_in(s, 8) ? draw(s)
                                         : EXH_DIN_ESTOP | EXH_DIN_DEADMAN | EXH_DIN_WATCHDOG |
                                               EXH_DIN_CARDS | 31u * EXH_DIN_DRIVE0;
    in->missed = wild && one_in(s, 8) ? draw(s) : 0;
    in->command = command(s, runs, in->command);
    for (unsigned i = 0; in->glove_new && i < EXH_GLOVE_SENSORS; i++) {
        if (wild && one_in(s, 8)) {
            in->glove.raw[i] = (int16_t)value(s, (uint16_t)last->glove.raw[i], 0xFFFF);
        }
    }
    *last = *in;
}
