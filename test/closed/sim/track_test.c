/* SPDX-License-Identifier: MIT */
/* A D/A that no longer changes is detected in time in closed loop, at any rate. A current that does
 * follow never gives this fault, for any commands, with the latest outputs that the device allows.
 */
#include "check.h"

#include "posix.h"

#include "drop/drop.h"

#include "exhand/board.h"
#include "exhand/exhand.h"

#include <glob.h>
#include <stdlib.h>
#include <string.h>

#define NOISE   EXH_Q(3, 100, EXH_Q_CUR) /* of the monitor, either way, and its steps */
#define CODES_A (324900 / 176.0)         /* D/A codes an ampere */

static uint64_t rng = 1;

static uint32_t any(uint32_t n)
{
    rng ^= rng << 13;
    rng ^= rng >> 7;
    rng ^= rng << 17;
    return (uint32_t)(rng >> 32) % n;
}

/* --- false alarms --- */

/* Rests, full steps, a tick's pulses, ramps, whatever. */
static int next_code(int last)
{
    switch (any(24)) {
    case 0: return 12184;
    case 1: return -12184;
    case 2: return (int)any(24369) - 12184;
    case 3: return -last;
    case 4:
    case 5:
    case 6: return exh_clamp(last + (int)any(2001) - 1000, -12184, 12184);
    default: return last;
    }
}

/* Codes of any kind to the device; ticks until they were all held to have followed, or when not. */
static uint32_t told_at(const struct posix_config *c, uint32_t rate_Hz,
    const struct exh_tracking_cfg *cfg, uint32_t ticks)
{
    struct exh_tracking s = {0, 0, 0};
    struct exh_period T;
    int code = 0, toggle = 0;
    posix_configure(c);
    CHECK_EQ_I64(exh_board_init(rate_Hz, &T), 0);
    for (uint32_t n = 0; n < ticks && exh_board_wait() >= 0; n++) {
        struct exh_drive_in in;
        struct exh_drive_out out = {{0}, 1, 0};
        CHECK_EQ_I64(exh_board_read_drive(&in), 0);
        if (exh_tracking_step(&s, cfg,
                exh_sat32((int64_t)(in.mon_raw[0] * c->device.mon_apc * (1 << EXH_Q_CUR))))) {
            return n;
        }
        if (n % 512 == 0) { toggle = !toggle; }
        code = toggle ? next_code(code) : n % 2 ? 12184 : -12184;
        out.dac_raw[0] = (uint16_t)(32768 + code);
        CHECK_EQ_I64(exh_board_write_drive(&out), 0);
        exh_tracking_update(&s, (int32_t)(code / CODES_A * (1 << EXH_Q_CUR)));
    }
    return UINT32_MAX;
}

/* 3 ticks and 10 ms late. EXH_EVERY=1: all 20000 rates. */
TEST(what_follows_is_never_told)
{
    const char *every = getenv("EXH_EVERY");
    const uint32_t step = every ? (uint32_t)atoi(every) : 397;
    struct posix_config late = posix_config_default();
    uint32_t rates = 0;
    late.device.delay_tick = 3;
    late.device.delay_s = 0.01;
    for (uint32_t rate = 1; rate <= 20000; rate += rate < 40 ? 1 : step) {
        const struct exh_tracking_par par = {exh_tracking_rows[0].dflt, exh_tracking_rows[1].dflt};
        struct exh_tracking_cfg cfg;
        uint32_t at;
        CHECK_EQ_I64(exh_tracking_setup(&cfg, &par, (struct exh_period){1, rate}), 0);
        at = told_at(&late, rate, &cfg, 4 * cfg.ticks + 100);
        CHECK(at == UINT32_MAX, "%lu Hz: told at tick %lu of a current that follows",
            (unsigned long)rate, (unsigned long)at);
        rates++;
    }
    check_note("%lu rates, 3 ticks and 10 ms late: none told", (unsigned long)rates);
}

/* The test can fail: half as long is too short. */
TEST(with_too_short_a_time_it_would_be_told)
{
    const struct exh_tracking_cfg cfg = {EXH_Q(1, 4, EXH_Q_CUR), 20};
    struct posix_config late = posix_config_default();
    late.device.delay_tick = 3;
    late.device.delay_s = 0.01;
    CHECK(told_at(&late, 2000, &cfg, 1000) != UINT32_MAX, "not told");
}

/* --- a D/A that does not update --- */

struct stuck {
    struct drop_par par;
    struct drop_cfg cfg;
    struct drop s;
    struct drop_signals sig;
    struct exh_params params;
};

static void set_up(struct stuck *b, const struct posix_config *c, struct exh_period T)
{
    exh_scene_drop.defaults();
    memset(b, 0, sizeof *b);
    memcpy(&b->par, exh_scene_drop.params->active, sizeof b->par);
    b->par.calib.uncalibrated = 1;
    b->par.quad.step_m_q42 = (int32_t)(c->device.step_m * 4398046511104.0);
    b->par.contact.k_Npm_q10 = EXH_Q(1000, 1, EXH_Q_K);
    CHECK_EQ_I64(drop_setup(&b->cfg, &b->par, (struct exh_scene_board){T, 24}, NULL), 0);
}

/* The mass hangs at rest in the wall, then the D/A stops updating, and the string is pulled. Ticks
 * from the first current coded that is off by more than tolerance and noise to no current and no
 * enable. */
static uint32_t ticks_to_safe(uint32_t rate_Hz, uint32_t *limit, double *stood_A)
{
    static struct stuck b;
    struct posix_config c = posix_config_default();
    struct exh_period T;
    struct exh_drive_out stood = {{0}, 0, 0}, out;
    uint32_t off_at = 0, off = 0, n = 0;
    const uint32_t still = 2 * rate_Hz + 40;
    c.device.height_m = 0.01;
    c.device.observe_s = 100;
    posix_configure(&c);
    CHECK_EQ_I64(exh_board_init(rate_Hz, &T), 0);
    set_up(&b, &c, T);
    b.par.own.q_lim_m_q30 = EXH_Q(1, 100, EXH_Q_POS);
    *limit = b.cfg.track.ticks;
    for (; exh_board_wait() >= 0 && n < still + 4 * rate_Hz + 4000; n++) {
        struct exh_scene_in in = {.command = n == 0 ? EXH_CMD_RUN : EXH_CMD_NONE};
        CHECK_EQ_I64(exh_board_read_drive(&in.drive), 0);
        if (n > still) { /* 0.5 N a tick more */
            const uint32_t by = (n - still) * 8 < 150 ? (n - still) * 8 : 150;
            in.drive.enc_raw[0] += by;
        }
        drop_tick(&b.s, &b.cfg, &in, &out, &b.sig);
        if (b.sig.state == EXH_STATE_FAULT) { break; }
        CHECK(n < 5 + rate_Hz || exh_safety_is_running(&b.s.safety), "tick %lu: state %ld",
            (unsigned long)n, (long)b.sig.state);
        if (n == still) {
            stood = out;
            *stood_A = b.sig.i_des_A_q26 / 67108864.0;
        }
        if (n >= still) {
            const int64_t away = (int64_t)b.sig.i_des_A_q26 - (int64_t)(*stood_A * 67108864.0);
            const int is_off =
                away > EXH_Q(1, 4, EXH_Q_CUR) + NOISE || -away > EXH_Q(1, 4, EXH_Q_CUR) + NOISE;
            if (is_off && !off) { off_at = n; }
            off = (uint32_t)is_off;
            stood.enable = out.enable;
            stood.alive = out.alive;
        }
        CHECK_EQ_I64(exh_board_write_drive(n >= still ? &stood : &out), 0);
    }
    CHECK(b.sig.state == EXH_STATE_FAULT && b.sig.faults == EXH_FAULT_TRACKING,
        "%lu Hz: faults %#lx at tick %lu", (unsigned long)rate_Hz, (unsigned long)b.sig.faults,
        (unsigned long)n);
    CHECK(out.enable == 0 && out.dac_raw[0] == 32768, "not safe");
    return n - off_at;
}

TEST(what_stands_is_told_in_time)
{
    static const uint32_t rate[] = {90, 100, 200, 500, 1000, 2000, 20000};
    for (size_t i = 0; i < LEN(rate); i++) {
        uint32_t limit = 0;
        double stood_A = 0;
        const uint32_t ticks = ticks_to_safe(rate[i], &limit, &stood_A);
        CHECK(ticks <= limit, "%lu Hz: %lu ticks, stated %lu", (unsigned long)rate[i],
            (unsigned long)ticks, (unsigned long)limit);
        check_note("%lu Hz: D/A standing at %.2f A told after %lu ticks, %.1f ms; stated %lu",
            (unsigned long)rate[i], stood_A, (unsigned long)ticks, 1e3 * ticks / rate[i],
            (unsigned long)limit);
    }
}

/* --- no scene forgets it --- */

static int has(const char *path, const char *word)
{
    static char text[1 << 17];
    FILE *f = fopen(path, "r");
    CHECK(f != NULL, "%s", path);
    text[fread(text, 1, sizeof text - 1, f)] = '\0';
    fclose(f);
    return strstr(text, word) != NULL;
}

/* Only exhand/axis.h has the order of a tick. A scene without tracking names that. */
TEST(every_scene_ticks_by_the_axis_and_tracks_or_says_that_it_does_not)
{
    static const char *const by_hand[] = {"exh_quad_step(", "exh_motion_step(",
        "exh_tracking_step(", "exh_drive_force_step(", "exh_drive_current_step(",
        "exh_tracking_update("};
    glob_t g;
    int axes = 0;
    CHECK_EQ_I64(glob("examples/*/*.[ch]", 0, NULL, &g), 0);
    for (size_t i = 0; i < g.gl_pathc; i++) {
        const char *path = g.gl_pathv[i];
        for (size_t k = 0; k < sizeof by_hand / sizeof by_hand[0]; k++) {
            CHECK(!has(path, by_hand[k]), "%s calls %s by hand", path, by_hand[k]);
        }
        if (!has(path, "struct exh_axis){") && !has(path, "struct exh_axis axis = {")) { continue; }
        axes++;
        CHECK(has(path, "->track") || has(path, "&s.track") || has(path, "&track") ||
                  has(path, "EXH_UNTRACKED"),
            "%s", path);
    }
    globfree(&g);
    CHECK(axes >= 6, "%d axes found", axes);
}

TEST_MAIN("sim/track", every_scene_ticks_by_the_axis_and_tracks_or_says_that_it_does_not,
    what_follows_is_never_told, with_too_short_a_time_it_would_be_told,
    what_stands_is_told_in_time);
