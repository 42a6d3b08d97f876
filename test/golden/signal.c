/* SPDX-License-Identifier: MIT */
/* signal: a table's CRC, and parameters staged, applied immediately or little by little, saved and
 * loaded. */
#include "modules.h"

#include "exhand/error.h"
#include "exhand/params.h"
#include "exhand/signal.h"

static const struct exh_signal some_rows[] = {
    {0x7001, 10, EXH_WHEN_LIMIT, 0, 1024000000, 7, "some", "", ""},
    {0x7002, 20, EXH_WHEN_SETUP, INT32_MIN, INT32_MAX, -1, "wide", "", ""},
    {0x7003, 0, EXH_WHEN_MATERIAL, -5, 5, 0, "five", "", ""},
};
static const struct exh_signal more_rows[] = {
    {0x7101, 0, EXH_WHEN_SETUP, 1, 2, 1, "narrow", "", ""},
    {0x7102, 30, EXH_WHEN_SLEWED, INT32_MIN, INT32_MAX, 0, "free", "", ""},
};
static const struct exh_signal_group groups[] = {{some_rows, 3, 2}, {more_rows, 2, 1}};
const struct exh_signal_table golden_signals = {groups, 2};

#define VALUES  GOLDEN_VALUES
#define IMAGE_B (12 + 4 * VALUES + 4)

static int64_t raw_of(struct golden_rng *r, const struct exh_signal *row)
{
    const int64_t how = golden_draw(r, 0, 3);
    const int64_t any = golden_draw(r, INT32_MIN, INT32_MAX);
    return how == 0 ? any : how == 1 ? row->min : how == 2 ? row->max : row->dflt;
}

/* Its own image with one value changed. */
static void change(uint8_t *image, struct golden_rng *r)
{
    const uint32_t i = (uint32_t)golden_draw(r, 0, VALUES - 1);
    int32_t raw = (int32_t)golden_draw(r, -2000, 2000);
    struct exh_bytes c = exh_bytes_writer(image, IMAGE_B);
    uint32_t crc;
    c.at = 12 + 4 * i;
    exh_bytes_i32(&c, &raw);
    c.at = IMAGE_B - 4;
    crc = exh_crc32(0, image, IMAGE_B - 4);
    exh_bytes_u32(&c, &crc);
}

static uint32_t keyframe_crc(struct exh_params *p)
{
    uint8_t b[8 * VALUES];
    struct exh_bytes c = exh_bytes_writer(b, sizeof b);
    exh_params_serialize(&c, p);
    return exh_crc32(0, b, c.at);
}

static void one(struct golden *g, struct golden_rng *r, struct exh_params *p)
{
    uint8_t image[IMAGE_B];
    uint16_t instance;
    uint32_t bad = 0;
    const struct exh_signal *row =
        exh_signal_at(&golden_signals, (uint32_t)golden_draw(r, 0, VALUES - 1), &instance);
    uint16_t id = row->id;
    int64_t raw;
    int load = 0;
    int err;
    int done;
    if (golden_draw(r, 0, 15) == 0) { id++; }
    if (golden_draw(r, 0, 15) == 0) { instance++; }
    raw = raw_of(r, row);
    err = exh_params_stage(p, id, instance, (int32_t)raw);
    done = golden_draw(r, 0, 3) ? exh_params_apply(p) : -1;
    CHECK_EQ_I64(exh_params_save(p, image, sizeof image), IMAGE_B);
    golden_put(g, id);
    golden_put(g, instance);
    golden_put(g, raw);
    golden_put(g, err);
    golden_put(g, done);
    golden_put(g, exh_crc32(0, image, sizeof image - 1)); /* over all, the CRC is constant */
    if (golden_draw(r, 0, 3) == 0) {
        change(image, r);
        load = exh_params_load(p, image, sizeof image, &bad);
    }
    golden_put(g, load);
    golden_put(g, load == 0 ? 0 : bad);
    golden_put(g, p->pending);
    golden_put(g, p->moving);
    golden_put(g, keyframe_crc(p));
    golden_put(g, exh_params_verify(p));
}

void golden_signal(struct golden *g, uint32_t rate_Hz)
{
    struct golden_rng r = golden_rng("signal", rate_Hz, 0);
    struct exh_params p;
    int32_t active[VALUES];
    int32_t staged[VALUES];
    CHECK_EQ_I64(exh_signal_count(&golden_signals), VALUES);
    while (g->tick < GOLDEN_TICKS) {
        if (g->tick == 0 || g->tick == GOLDEN_AGAIN) {
            exh_params_setup(&p, &golden_signals, active, staged);
        }
        if (g->tick % 64 == 0) {
            const struct exh_tune_par par = {
                (int32_t)golden_draw(&r, 0, 1000) >> golden_draw(&r, 0, 10)};
            exh_params_slew_setup(&p, &par, golden_period(rate_Hz, g->tick));
        }
        p.locked = g->tick >> 3 & 1;
        golden_put(g, p.shift);
        one(g, &r, &p);
        for (unsigned i = 0; i < VALUES; i++) { golden_put(g, active[i]); }
        golden_tick(g);
    }
}
