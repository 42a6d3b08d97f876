#include "inputs.h"

#include "exhand/safety.h"

static uint32_t draw(struct inputs *s)
{
    s->state = s->state * UINT64_C(6364136223846793005) + UINT64_C(1442695040888963407);
    return (uint32_t)(s->state >> 32);
}

/* One time in n. */
static int one_in(struct inputs *s, uint32_t n)
{
    return draw(s) % n == 0;
}

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

void inputs_next(struct inputs *s, struct exh_scene_in *in)
{
    struct exh_scene_in *last = &s->last;
    /* Wild encoders are a fault, and in a fault less happens: mostly tame ones, on their way. */
    for (unsigned i = 0; i < EXH_FINGERS; i++) {
        const uint32_t enc = last->drive.enc_raw[i];
        in->drive.enc_raw[i] =
            one_in(s, 512) ? value(s, enc, 0xFFFFFF) : (enc + draw(s) % 25 - 12) & 0xFFFFFF;
        in->drive.mon_raw[i] = (int16_t)value(s, (uint16_t)last->drive.mon_raw[i], 0xFFFF);
    }
    in->drive.supply_raw = (int16_t)value(s, (uint16_t)last->drive.supply_raw, 0xFFFF);
    in->drive.din =
        one_in(s, 512) ? draw(s) : EXH_DIN_ESTOP | EXH_DIN_DEADMAN | 31u * EXH_DIN_DRIVE0;
    in->missed = one_in(s, 256) ? draw(s) : 0;
    in->command = (uint8_t)(one_in(s, 4)   ? EXH_CMD_CLEAR
                            : one_in(s, 2) ? EXH_CMD_RUN
                                           : in->command);
    for (unsigned i = 0; in->glove_new && i < EXH_GLOVE_SENSORS; i++) {
        in->glove.raw[i] = (int16_t)value(s, (uint16_t)last->glove.raw[i], 0xFFFF);
    }
    *last = *in;
}
