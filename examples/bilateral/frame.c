/* SPDX-License-Identifier: MIT */
/* A glove frame, processed over the ticks until the next: codes, angles, fingers. */
#include "bilateral.h"

/* Parts of about equal cost: sensors and places up to these. The first part also has all codes, the
 * part with the last sensor that is needed the cross terms. */
#define SENSOR_PARTS 4u
static const struct bilateral_part upto[BILATERAL_PARTS + 1] = {
    {0, 0}, {4, 0}, {10, 0}, {16, 0}, {22, 0}, {22, 2}, {22, 4}, {22, 5}};

static unsigned smaller(unsigned a, unsigned b) { return a < b ? a : b; }

/* Sensors that the fingers in use need. Cross terms of others are left out. A term refers to a
 * sensor without terms, so one pass finds all. */
static uint32_t sensors_needed(struct bilateral_cfg *cfg)
{
    uint32_t need = 0;
    unsigned kept = 0;
    for (unsigned k = 0; k < cfg->n; k++) { need |= cfg->finger[cfg->at[k]].sensors; }
    for (unsigned i = 0; i < EXH_GLOVE_SENSORS && kept < EXH_GLOVE_SENSORS; i++) {
        const uint8_t *of = cfg->cal.sensor[i].of;
        if (!(need >> i & 1u) || (of[0] & of[1]) == EXH_GLOVE_NONE) { continue; }
        cfg->glove.crossed[kept++] = (uint8_t)i;
        for (unsigned t = 0; t < 2; t++) { /* without a term: bit 31, which is no sensor's */
            need |= UINT32_C(1) << (of[t] & 31u);
        }
    }
    cfg->glove.crosses = (uint8_t)kept;
    return need & ((UINT32_C(1) << EXH_GLOVE_SENSORS) - 1u);
}

/* As many parts as defined, or as ticks to the next frame: so a frame is complete before the
 * next. */
void bilateral_frame_setup(struct bilateral_cfg *cfg)
{
    const unsigned all = SENSOR_PARTS + (cfg->n + 1u) / 2;
    const unsigned every = (unsigned)cfg->par->glove_own.every;
    const unsigned parts = every - 1u < all ? every : all; /* also for 0, which is refused */
    unsigned first = 0, end = EXH_GLOVE_SENSORS;
    cfg->sensors = sensors_needed(cfg);
    while (first < end && !(cfg->sensors >> first & 1u)) { first++; }
    while (end > first && !(cfg->sensors >> (end - 1u) & 1u)) { end--; }
    for (unsigned p = 0; p <= parts; p++) {
        struct bilateral_part *to = &cfg->part[p];
        *to = upto[smaller((p * all + parts - 1) / parts, BILATERAL_PARTS)];
        to->sensors = (uint8_t)(to->sensors < first ? first : smaller(to->sensors, end));
        if (to->places > cfg->n) { to->places = cfg->n; }
    }
    cfg->parts = (uint8_t)parts;
}

/* Number of finished parts. Damaged memory gives a wrong part, but stays within array bounds. */
static unsigned done(const struct bilateral *s, const struct bilateral_cfg *cfg)
{
    return smaller((unsigned)cfg->parts - s->frame.left, BILATERAL_PARTS);
}

static void compute(struct bilateral *s, const struct bilateral_cfg *cfg, unsigned part)
{
    int32_t *angle_turn_q32 = s->frame.angle_turn_q32;
    const struct bilateral_part *from = &cfg->part[part], *to = &cfg->part[part + 1];
    const unsigned first = smaller(from->sensors, EXH_GLOVE_SENSORS);
    const unsigned end = smaller(to->sensors, EXH_GLOVE_SENSORS);
    const unsigned places = smaller(to->places, bilateral_n(cfg));
    exh_glove_angles(&s->glove, &cfg->glove, first, end, angle_turn_q32);
    if (first < end && cfg->sensors >> end == 0) { exh_glove_cross(&cfg->glove, angle_turn_q32); }
    for (unsigned k = from->places; k < places; k++) {
        const unsigned f = bilateral_at(cfg, k);
        bilateral_finger_see(&s->finger[f], cfg, f, angle_turn_q32);
    }
}

static void next(struct bilateral *s, const struct bilateral_cfg *cfg)
{
    const unsigned part = smaller(done(s, cfg), BILATERAL_PARTS - 1);
    compute(s, cfg, part);
    s->frame.places = cfg->part[part + 1].places;
    s->frame.left--;
    if (s->frame.left == 0) { s->glove_faults = s->frame.faults; }
}

static void newest(struct bilateral *s, const struct exh_scene_in *in)
{
    s->glove_age_ticks =
        s->worn && in->glove.age_ticks < UINT16_MAX ? in->glove.age_ticks : UINT32_MAX;
}

uint32_t bilateral_later(uint32_t ticks, uint32_t missed)
{
    ticks += missed < UINT32_MAX - ticks ? missed : UINT32_MAX - ticks;
    return ticks + (ticks < UINT32_MAX);
}

/* The age of the previous frame applies to fingers that still use it. */
void bilateral_age(
    struct bilateral *s, const struct bilateral_cfg *cfg, const struct exh_scene_in *in)
{
    const uint32_t before_ticks = bilateral_later(s->frame.before_ticks, in->missed);
    newest(s, in);
    s->frame.places = cfg->part[done(s, cfg)].places;
    if (!in->glove_new && s->frame.left == 0) {
        s->frame.before_ticks = s->glove_age_ticks;
    } else {
        s->frame.before_ticks = s->worn && before_ticks < UINT16_MAX ? before_ticks : UINT32_MAX;
    }
}

static void take(
    struct bilateral *s, const struct bilateral_cfg *cfg, const struct exh_scene_in *in)
{
    while (s->frame.left > 0) { next(s, cfg); } /* early: first finish the last one */
    s->worn = 1;
    newest(s, in);
    s->frame.faults =
        exh_glove_believe(&s->glove, &cfg->glove, &in->glove, s->frame.angle_turn_q32);
    s->glove_faults |= s->frame.faults; /* a repaired sensor counts when all fingers are updated */
    s->frame.left = (uint8_t)smaller(cfg->parts, BILATERAL_PARTS);
}

void bilateral_see(
    struct bilateral *s, const struct bilateral_cfg *cfg, const struct exh_scene_in *in)
{
    if (in->glove_new) { take(s, cfg, in); }
    if (s->frame.left > 0) { next(s, cfg); }
}

uint32_t bilateral_finger_age(
    const struct bilateral *s, const struct bilateral_cfg *cfg, unsigned place)
{
    if (s->glove_faults && s->glove_faults & cfg->finger[bilateral_at(cfg, place)].sensors) {
        return UINT32_MAX;
    }
    return place < s->frame.places ? s->glove_age_ticks : s->frame.before_ticks;
}

void bilateral_frame_bytes(struct exh_bytes *c, struct bilateral_frame *s)
{
    exh_bytes_i32s(c, s->angle_turn_q32, EXH_GLOVE_SENSORS);
    exh_bytes_u32(c, &s->faults);
    exh_bytes_u32(c, &s->before_ticks);
    exh_bytes_u8(c, &s->left);
    if (s->left > BILATERAL_PARTS) { s->left = 0; }
}
