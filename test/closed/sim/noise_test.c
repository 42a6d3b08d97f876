/* SPDX-License-Identifier: MIT */
/* Noise at whole scenes. Every input of a tick is noise. Again and again random bytes restore their
 * state, and the box is put into any state. No code leaves the span. Only the code of 0 A leaves a
 * gate that is shut. From tick to tick the force moves no faster than slew or release allow. */
#include "check.h"

#include "bilateral/bilateral.h"
#include "drop/drop.h"

#include <stdlib.h>
#include <string.h>

#define RATE_HZ 1000
#define STATE_B 65536
#define TICKS   8 /* from one restored state */

static const struct exh_scene_board board = {{1, RATE_HZ}, 24};

static uint8_t bytes[STATE_B];
static struct exh_scene_in in;
static struct exh_scene_mail mail, sent;
static struct exh_drive_out out;
static uint32_t runs; /* ticks with an open gate */

static void noise(void *at, size_t n)
{
    uint8_t *p = at;
    for (size_t k = 0; k < n; k++) { p[k] = (uint8_t)(check_u64() >> 56); }
}

static void noise_in(void)
{
    noise(&in, sizeof in);
    in.missed = check_u64() % 4 ? 0 : (uint32_t)check_i32_in(0, 5);
    in.glove_new &= 1;
    if (check_u64() % 8) { /* a healthy box: or nothing would ever open */
        in.drive.din = UINT32_MAX;
        in.command = EXH_CMD_NONE;
    }
}

/* Any state of the box that its table has, and others. */
static void noise_box(struct exh_safety *s)
{
    if (check_u64() % 8 == 0) {
        noise(s, sizeof *s);
        return;
    }
    memset(s, 0, sizeof *s);
    s->state = (uint8_t)(check_u64() % EXH_STATES);
    s->share_q30 = check_i32_in(0, 1 << 30);
    if (s->state == EXH_STATE_FAULT) { s->faults = 1u << check_u64() % EXH_FAULTS; }
}

/* What was commanded in the tick before; -1: not known, as the state was restored since. */
struct before {
    int32_t force_N_q20;
};

/* Newtons q20 in a tick: of a slew rate, or of the release law in 15 ms from no more than f_max,
 * missed ticks made up for. */
static void check_slope(
    struct before *b, const struct exh_drive_par *par, int32_t force_N_q20, int open)
{
    const int64_t up = ((int64_t)par->slew_up_Nps << EXH_Q_FORCE) / RATE_HZ + 2;
    const int64_t down = ((int64_t)par->slew_down_Nps << EXH_Q_FORCE) / RATE_HZ + 2;
    const int64_t let_go = (1 + (int64_t)in.missed) * ((INT64_C(100) << EXH_Q_FORCE) / 15 + 2);
    const int64_t change = (int64_t)force_N_q20 - b->force_N_q20;
    CHECK(force_N_q20 >= 0 && force_N_q20 <= 100 << EXH_Q_FORCE, "%" PRId32 " N q20", force_N_q20);
    CHECK(open || force_N_q20 == 0, "shut: %" PRId32 " N q20", force_N_q20);
    if (b->force_N_q20 >= 0 && open) {
        CHECK(change <= up, "rise by %" PRId64 " of %" PRId64, change, up);
        CHECK(-change <= (down > let_go ? down : let_go), "fall by %" PRId64, -change);
    }
    b->force_N_q20 = force_N_q20;
}

static void check_code(unsigned f, const struct exh_drive_par *par, int open)
{
    const int32_t off = (int32_t)out.dac_raw[f] - par->dac_zero_raw;
    const int64_t peak = exh_mul_shr(par->i_peak_A_q26, par->dac_rawpA_q16, EXH_Q_CUR + EXH_Q_DAC);
    const int64_t most = !open ? 0 : peak < par->dac_span_raw ? peak : par->dac_span_raw;
    CHECK(off >= -most && off <= most, "finger %u: %" PRId32 " codes of %" PRId64, f, off, most);
}

/* --- one finger, one wall --- */

static struct drop_par drop_par;
static struct drop_cfg drop_cfg;
static struct drop drop;
static struct drop_signals drop_sig;

static void noise_drop(void)
{
    struct exh_bytes c = exh_bytes_reader(bytes, STATE_B);
    noise(bytes, 4096);
    exh_quad_serialize(&c, &drop.quad);
    exh_velocity_window_serialize(&c, &drop.velocity);
    exh_contact_serialize(&c, &drop.contact);
    exh_drive_serialize(&c, &drop.drive);
    exh_tracking_serialize(&c, &drop.track);
    exh_motion_serialize(&c, &drop.watch);
    if (check_u64() % 2) { /* these cause an immediate fault, which hides the rest */
        memset(&drop.quad, 0, sizeof drop.quad);
        memset(&drop.track, 0, sizeof drop.track);
        memset(&drop.watch, 0, sizeof drop.watch);
    }
    noise_box(&drop.safety);
}

TEST(drop_within_noise)
{
    struct before b = {-1};
    uint32_t n = 0;
    exh_scene_drop.defaults();
    memcpy(&drop_par, exh_scene_drop.params->active, sizeof drop_par);
    drop_par.calib.uncalibrated = 1;
    CHECK_EQ_I64(drop_setup(&drop_cfg, &drop_par, board, NULL), 0);
    drop_cfg.quad.jump_cnt = INT32_MAX; /* noise is no movement that a hand can make */
    while (check_case(1)) {
        int open;
        if (n++ % TICKS == 0) {
            noise_drop();
            b.force_N_q20 = -1;
        }
        noise_in();
        drop_tick(&drop, &drop_cfg, &in, &out, &drop_sig);
        open = exh_safety_is_open(&drop.safety);
        check_code(0, &drop_par.drive, open);
        for (unsigned f = 1; f < EXH_FINGERS; f++) { check_code(f, &drop_par.drive, 0); }
        CHECK(out.enable == (open ? 1 : 0), "enable %x", out.enable);
        check_slope(&b, &drop_par.drive, drop_sig.f_des_N_q20, open);
        runs += (uint32_t)open;
    }
    CHECK(n < 1000 || runs > n / 20, "open in %" PRIu32 " of %" PRIu32 " ticks", runs, n);
    check_note("drop: gate open in %" PRIu32 " of %" PRIu32 " ticks", runs, n);
}

/* --- the full box --- */

static struct bilateral_par par;
static struct bilateral_cfg cfg;
static struct bilateral box;
static struct bilateral_signals sig;

static void noise_bilateral(void)
{
    struct exh_bytes c = exh_bytes_reader(bytes, STATE_B);
    noise(bytes, sizeof bytes);
    bilateral_bytes(&c, &box);
    noise_box(&box.safety);
    if (check_u64() % 2) { return; }
    for (unsigned f = 0; f < BILATERAL_FINGERS; f++) {
        memset(&box.finger[f].quad, 0, sizeof box.finger[f].quad);
        memset(&box.finger[f].track, 0, sizeof box.finger[f].track);
    }
}

/* Packets of noise, and some whose frame is sound. */
static void noise_mail(void)
{
    mail.packets = (uint8_t)(check_u64() % (EXH_SCENE_PACKETS + 1));
    for (unsigned k = 0; k < mail.packets; k++) {
        mail.len_B[k] = (uint16_t)(check_u64() % (EXH_SCENE_PACKET_B + 1));
        noise(mail.byte[k], mail.len_B[k]);
    }
}

TEST(full_box_within_noise)
{
    struct before b[BILATERAL_FINGERS];
    uint32_t n = 0, used = 0;
    exh_scene_bilateral.defaults();
    memcpy(&par, exh_scene_bilateral.params->active, sizeof par);
    par.calib.uncalibrated = 1;
    par.own.fingers = (1 << BILATERAL_FINGERS) - 1;
    CHECK_EQ_I64(bilateral_setup(&cfg, &box, &par, board, NULL), 0);
    for (unsigned f = 0; f < BILATERAL_FINGERS; f++) { cfg.finger[f].quad.jump_cnt = INT32_MAX; }
    runs = 0;
    while (check_case(10)) {
        int open;
        if (n++ % TICKS == 0) {
            noise_bilateral();
            for (unsigned f = 0; f < BILATERAL_FINGERS; f++) { b[f].force_N_q20 = -1; }
        }
        noise_in();
        noise_mail();
        bilateral_tick(&box, &cfg, &in, &mail, exh_scene_bilateral.params, &out, &sig);
        bilateral_write(&box, &cfg, &sig, &sent);
        bilateral_tell(&box, &cfg, &sig);
        open = exh_safety_is_open(&box.safety);
        CHECK(out.enable == (open ? (1 << BILATERAL_FINGERS) - 1 : 0), "enable %x", out.enable);
        for (unsigned f = 0; f < BILATERAL_FINGERS; f++) {
            check_code(f, &par.drive[f], open);
            check_slope(&b[f], &par.drive[f], sig.paper[f].f_des_N_q20, open);
            used += sig.paper[f].f_des_N_q20 > 0;
        }
        runs += (uint32_t)open;
    }
    CHECK(n < 1000 || (runs > n / 200 && used > n / 200),
        "open in %" PRIu32 ", force in %" PRIu32 " of %" PRIu32 " ticks", runs, used, n);
    check_note("full box: gate open in %" PRIu32 " of %" PRIu32 " ticks, %" PRIu32 " forces", runs,
        n, used);
}

TEST_MAIN("sim/noise", drop_within_noise, full_box_within_noise);
