/* SPDX-License-Identifier: MIT */
/* glove: 22 codes to 22 angles, faults channel by channel. */
#include "modules.h"

#include "exhand/glove.h"

static int is_crossed(int i) { return i == 3 || i == 10 || i == 14 || i == 18; }

static void any_sensor(struct golden_rng *r, int i, int present, struct exh_glove_sensor *s)
{
    int64_t gain;
    s->low_raw = (int16_t)golden_draw(r, -30000, 29000);
    s->high_raw = (int16_t)(s->low_raw + golden_draw(r, 64, INT64_C(30000) - s->low_raw));
    s->zero_raw_q15 = (int32_t)golden_draw(r, -(INT32_C(1) << 30), (INT32_C(1) << 30) - 32768);
    gain = golden_draw(r, INT32_C(1) << 17, INT32_MAX);
    gain >>= golden_draw(r, 0, 13);
    if (gain < INT32_C(1) << 17) { gain = INT32_C(1) << 17; }
    if (golden_draw(r, 0, 1) != 0) { gain = -gain; }
    s->gain_turnpraw_q38 = present ? (int32_t)gain : 0;
    s->cross_q30[0] = s->cross_q30[1] = 0;
    s->of[0] = s->of[1] = EXH_GLOVE_NONE;
    if (is_crossed(i)) {
        s->cross_q30[0] = (int32_t)golden_draw(r, INT32_MIN, INT32_MAX);
        s->cross_q30[1] = (int32_t)golden_draw(r, INT32_MIN, INT32_MAX);
        s->of[0] = (uint8_t)(i - 1);
        s->of[1] = (uint8_t)(i + 1);
        if (golden_draw(r, 0, 3) == 0) {
            s->cross_q30[1] = 0;
            s->of[1] = EXH_GLOVE_NONE;
        }
    }
}

struct exh_glove_par golden_glove_par(struct golden_rng *r, struct exh_period T)
{
    const int64_t most = (((int64_t)T.den << 15) - 1) / T.num;
    const int64_t least = (T.den >> 5) / T.num + 1;
    struct exh_glove_par p;
    int64_t fc;
    p.order = (int32_t)golden_draw(r, 0, 2);
    fc = golden_draw(r, 1, most);
    fc >>= golden_draw(r, 0, 10);
    if (fc < least) { fc = least; }
    p.fc_Hz_q16 = fc < 6553 ? 6553 : (int32_t)fc;
    p.bits = (int32_t)golden_draw(r, 4, 16);
    p.hyst_raw_q16 = (int32_t)golden_draw(r, 0, INT64_C(1) << (32 - p.bits));
    p.low_raw = (int32_t)golden_draw(r, -32768, -31000);
    p.high_raw = (int32_t)golden_draw(r, 31000, 32767);
    p.open_high = (int32_t)golden_draw(r, 0, 1);
    p.debounce_frames = (int32_t)golden_draw(r, 1, 6);
    p.margin_q16 = (int32_t)golden_draw(r, 0, 65536);
    p.margin_q16 >>= golden_draw(r, 0, 4);
    return p;
}

struct worn {
    struct exh_glove_par par;
    struct exh_glove_cal cal;
    struct exh_glove_cfg cfg;
    struct exh_glove s;
    uint32_t wrong; /* sensors whose codes are at an end or beyond it */
};

void golden_glove_sensors(struct exh_glove_cal *cal, struct golden_rng *r)
{
    static const uint8_t absent[] = {0, 5, 10, 14, 20, 21, 31, 31}; /* 31: none is */
    cal->present = 0x3FFFFFu & ~(UINT32_C(1) << absent[golden_draw(r, 0, 7)]);
    for (int i = 0; i < EXH_GLOVE_SENSORS; i++) {
        any_sensor(r, i, cal->present >> i & 1, &cal->sensor[i]);
    }
}

static void wear(struct worn *g, struct golden_rng *r, struct exh_period T)
{
    (void)memset(g, 0, sizeof *g);
    g->par = golden_glove_par(r, T);
    golden_glove_sensors(&g->cal, r);
    CHECK_EQ_I64(exh_glove_setup(&g->cfg, &g->par, &g->cal, T), 0);
}

/* A rail, or the last code that is believed, or the next. */
static int32_t bad_code(const struct worn *g, int i, uint32_t k)
{
    const struct exh_glove_sensor *s = &g->cal.sensor[i];
    const int64_t span = (int64_t)s->high_raw - s->low_raw;
    const int64_t past = ((span * g->par.margin_q16 + 32768) >> 16) + (k & 1);
    switch (((uint32_t)i + (k >> 5)) & 3) {
    case 0: return -32768;
    case 1: return 32767;
    case 2: return s->low_raw - past < -32768 ? -32768 : (int32_t)(s->low_raw - past);
    default: return s->high_raw + past > 32767 ? 32767 : (int32_t)(s->high_raw + past);
    }
}

static void any_frame(
    const struct worn *g, const struct golden_wave *w, uint32_t k, struct exh_glove_in *in)
{
    for (int i = 0; i < EXH_GLOVE_SENSORS; i++) {
        const struct exh_glove_sensor *s = &g->cal.sensor[i];
        const int32_t share = w[i & 3].at[k] + 32768;
        const int32_t good =
            s->low_raw + (int32_t)(share * ((int64_t)s->high_raw - s->low_raw) >> 16);
        in->raw[i] = (int16_t)(g->wrong >> i & 1 ? bad_code(g, i, k) : good);
    }
}

static uint32_t crc_of(int32_t *angle)
{
    uint8_t buf[4 * EXH_GLOVE_SENSORS];
    struct exh_bytes c = exh_bytes_writer(buf, sizeof buf);
    for (int i = 0; i < EXH_GLOVE_SENSORS; i++) { exh_bytes_i32(&c, &angle[i]); }
    return exh_crc32(0, buf, sizeof buf);
}

/* The loop's period times so many ticks a frame, which is a second at most. */
static struct exh_period frame_period(uint32_t rate_Hz, uint32_t k, uint32_t every)
{
    struct exh_period T = golden_period(rate_Hz, k);
    const uint32_t loop_Hz = (T.den + T.num / 2) / T.num;
    T.num *= every < loop_Hz ? every : loop_Hz;
    return T;
}

/* Frame by frame; `every` loop ticks lie between two. */
static void frames(struct golden *g, const char *name, uint32_t rate_Hz, uint32_t every)
{
    static struct golden_wave w[4];
    static struct worn worn;
    struct golden_rng r = golden_rng(name, rate_Hz, 0);
    for (uint32_t i = 0; i < 4; i++) {
        golden_wave(
            &w[i], name, rate_Hz, 1 + i, -32768, 32767, INT32_C(1) << golden_draw(&r, 0, 11));
    }
    while (g->tick < GOLDEN_TICKS) {
        struct exh_glove_in in = {.age_ticks = 0};
        int32_t angle[EXH_GLOVE_SENSORS];
        if (g->tick == 0 || g->tick == GOLDEN_AGAIN) {
            wear(&worn, &r, frame_period(rate_Hz, g->tick, every));
        }
        worn.wrong ^= UINT32_C(1) << golden_draw(&r, 0, 21);
        any_frame(&worn, w, g->tick, &in);
        for (int i = 0; i < EXH_GLOVE_SENSORS; i++) { golden_put(g, in.raw[i]); }
        golden_put(g, exh_glove_step(&worn.s, &worn.cfg, &in, angle));
        golden_put(g, angle[0]);
        golden_put(g, angle[3]);
        golden_put(g, angle[10]);
        golden_put(g, angle[21]);
        golden_put(g, crc_of(angle));
        GOLDEN_STATE(g, exh_glove_serialize, &worn.s);
        golden_tick(g);
    }
}

void golden_glove(struct golden *g, uint32_t rate_Hz) { frames(g, "glove", rate_Hz, 1); }

/* Every ratio of frames to ticks that a scene's row `every` takes, 1..1000. */
void golden_glove_every(struct golden *g, uint32_t rate_Hz)
{
    frames(g, "glove_every", rate_Hz, 1 + (rate_Hz - 1) % 1000);
}
