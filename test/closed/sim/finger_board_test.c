/* SPDX-License-Identifier: MIT */
/* Fingers through the board: codes of five axes, the glove that moves with them, and a wall
 * that stops them. */
#include "check.h"

#include "posix.h"

#include "sim/plant.h"

#include "exhand/board.h"
#include "exhand/error.h"

#include <math.h>
#include <string.h>

#define FINGERS SIM_FINGERS
#define ALL     0x1Fu

static struct posix_config with(unsigned fingers)
{
    struct posix_config c = posix_config_default();
    c.exo.fingers = fingers;
    for (unsigned i = 0; i < FINGERS; i++) { c.exo.path[i].vary = 0; }
    return c;
}

static void start(const struct posix_config *c, uint32_t rate_Hz)
{
    struct exh_period T;
    posix_configure(c);
    CHECK_EQ_I64(exh_board_init(rate_Hz, &T), 0);
}

static struct exh_drive_in read_codes(void)
{
    struct exh_drive_in in;
    CHECK_EQ_I64(exh_board_read_drive(&in), 0);
    return in;
}

static void write_codes(const int32_t from_zero[FINGERS], unsigned enable)
{
    struct exh_drive_out out = {{0}, (uint8_t)enable, 0};
    for (unsigned i = 0; i < FINGERS; i++) { out.dac_raw[i] = (uint16_t)(32768 + from_zero[i]); }
    CHECK_EQ_I64(exh_board_write_drive(&out), 0);
}

/* ---- Axes ---------------------------------------------------------------------------------- */

TEST(drives_of_the_fingers_in_use_are_ready)
{
    for (unsigned mask = 1; mask <= ALL; mask++) {
        struct posix_config c = with(mask);
        c.drives = 0;
        start(&c, 1000);
        CHECK_EQ_I64(exh_board_wait(), 0);
        CHECK(read_codes().din == (EXH_DIN_ESTOP | EXH_DIN_DEADMAN | EXH_DIN_WATCHDOG |
                                      EXH_DIN_CARDS | EXH_DIN_DRIVE0 * mask),
            "%#x", mask);
        for (unsigned i = 0; i < FINGERS; i++) {
            CHECK((posix_finger(i) != NULL) == (mask >> i & 1), "mask %#x, finger %u", mask, i);
        }
    }
    {
        struct posix_config c = with(0x20);
        struct exh_period T;
        posix_configure(&c);
        CHECK_EQ_I64(exh_board_init(1000, &T), -EXH_E_ABSENT);
    }
}

/* Every finger its own D/A, motor, monitor and enable bit. */
TEST(axes_are_not_mixed_up)
{
    for (unsigned mask = 1; mask <= ALL; mask++) {
        for (unsigned enable = 0; enable <= ALL; enable += 5) {
            struct posix_config c = with(mask);
            const int32_t code[FINGERS] = {1000, 2000, 3000, 4000, 5000};
            struct exh_drive_in in;
            c.device.mon_noise_a = 0;
            start(&c, 1000);
            for (int n = 0; n < 40; n++) {
                CHECK_EQ_I64(exh_board_wait(), 0);
                write_codes(code, enable);
            }
            in = read_codes();
            for (unsigned i = 0; i < FINGERS; i++) {
                const double A = code[i] / c.device.dac_perA;
                const double want = mask & enable & 1u << i ? A / c.device.mon_apc : 0;
                CHECK(fabs(in.mon_raw[i] - want) < 1,
                    "mask %#x, enable %#x, finger %u: %d, want %.1f", mask, enable, i,
                    in.mon_raw[i], want);
            }
        }
    }
}

TEST(encoders_count_the_string)
{
    const struct posix_config c = with(ALL);
    double lo[FINGERS] = {0}, hi[FINGERS] = {1, 1, 1, 1, 1};
    uint32_t most = 0;
    start(&c, 2000);
    for (int n = 0; n < 3000; n++) {
        struct exh_drive_in in;
        CHECK_EQ_I64(exh_board_wait(), 0);
        in = read_codes();
        for (unsigned i = 0; i < FINGERS; i++) {
            const double u = posix_finger(i)->plant.q_m * c.device.decode / c.device.step_m;
            const double code = in.enc_raw[i];
            lo[i] = code - u > lo[i] ? code - u : lo[i];
            hi[i] = code + 1 - u < hi[i] ? code + 1 - u : hi[i];
            most = in.enc_raw[i] > most ? in.enc_raw[i] : most;
            CHECK(
                lo[i] <= hi[i] + 1e-6, "finger %u, tick %d: phase %.6f..%.6f", i, n, lo[i], hi[i]);
        }
    }
    CHECK(most > 600 && most < 1000, "45 mm of string are %u counts", (unsigned)most);
    for (unsigned i = 0; i < FINGERS; i++) {
        CHECK(hi[i] - lo[i] < 0.1, "finger %u: too few edges to tell", i);
        CHECK(i == 0 || fabs(lo[i] - lo[0]) > 1e-3, "finger %u has the thumb's phase", i);
    }
}

TEST(safe_takes_every_current_away)
{
    const struct posix_config c = with(ALL);
    const int32_t code[FINGERS] = {5000, 5000, 5000, 5000, 5000};
    start(&c, 2000);
    for (int n = 0; n < 100; n++) {
        CHECK_EQ_I64(exh_board_wait(), 0);
        write_codes(code, ALL);
    }
    for (unsigned i = 0; i < FINGERS; i++) { CHECK(posix_finger(i)->plant.cur_A > 2.5, "%u", i); }
    exh_board_safe();
    for (int n = 0; n < 20; n++) { CHECK_EQ_I64(exh_board_wait(), 0); }
    for (unsigned i = 0; i < FINGERS; i++) {
        CHECK(posix_finger(i)->plant.cur_A < 1e-6, "finger %u: %.3g A", i,
            posix_finger(i)->plant.cur_A);
    }
}

/* Same seed, same digits; whatever the rate of the loop, which writes nothing here, nearly so. */
TEST(a_run_is_its_seed)
{
    double x[3][FINGERS];
    for (int k = 0; k < 3; k++) {
        struct posix_config c = with(ALL);
        c.seed = k < 2 ? 5 : 6;
        c.exo.path[2].vary = 0.2;
        start(&c, 2000);
        for (int n = 0; n < 2500; n++) { CHECK_EQ_I64(exh_board_wait(), 0); }
        for (unsigned i = 0; i < FINGERS; i++) { x[k][i] = posix_finger(i)->plant.x_m; }
    }
    CHECK(memcmp(x[0], x[1], sizeof x[0]) == 0, "the same seed differs");
    CHECK(x[0][2] != x[2][2], "another seed does not");
}

/* The board says stop when the last finger is through. */
TEST(the_run_ends_with_the_last_script)
{
    struct posix_config c = with(0x0A);
    int n = 0;
    c.exo.path[1].approaches = 1;
    c.exo.path[3].approaches = 2;
    start(&c, 1000);
    while (n < 20000 && exh_board_wait() >= 0) { n++; }
    CHECK(n > 4800 && n < 4900, "%d ms", n);
    CHECK(posix_finger(1)->path.number == 1 && posix_finger(3)->path.number == 2, "approaches");
}

/* The same digits on every machine and from every compiler: a digest of all that a run is. It
 * changes with whatever changes the physics; then say so. */
TEST(a_run_has_the_committed_digits)
{
    const uint64_t want = UINT64_C(0xf568d68d24de24f6);
    struct posix_config c = with(ALL);
    uint64_t h = UINT64_C(14695981039346656037);
    c.glove = 1;
    c.exo.apart_s = 0.03;
    for (unsigned i = 0; i < FINGERS; i++) {
        c.exo.path[i].vary = 0.1;
        c.exo.path[i].first_s = 0.5;
    }
    start(&c, 2000);
    for (int n = 0; n < 8000; n++) {
        const int32_t code[FINGERS] = {
            400, n % 5000, 5000 - n % 5000, n % 1000 < 500 ? 3000 : 0, 1500};
        struct exh_glove_in glove;
        struct exh_drive_in in;
        CHECK_EQ_I64(exh_board_wait(), 0);
        in = read_codes();
        write_codes(code, ALL);
        CHECK_EQ_I64(exh_board_read_glove(&glove), 0);
        for (unsigned i = 0; i < 22; i++) {
            h = (h ^ (uint16_t)glove.raw[i]) * UINT64_C(1099511628211);
        }
        for (unsigned i = 0; i < FINGERS; i++) {
            uint64_t x;
            memcpy(&x, &posix_finger(i)->plant.x_m, sizeof x);
            h = (h ^ x) * UINT64_C(1099511628211);
            h = (h ^ in.enc_raw[i] ^ (uint64_t)(uint16_t)in.mon_raw[i] << 32) *
                UINT64_C(1099511628211);
        }
    }
    CHECK(h == want, "%#" PRIx64 ", want %#" PRIx64, h, want);
}

/* ---- The glove --------------------------------------------------------------------------------
 */

/* A first-order lag over a way of straight pieces of h, exactly: y at each point. */
struct lagged {
    double keep, y, x, slope, tau_s;
};

static void lag_by(struct lagged *l, double x, double h)
{
    const double slope = (x - l->x) / h;
    l->y = x - l->tau_s * slope + (l->y - l->x + l->tau_s * slope) * l->keep;
    l->slope = slope;
    l->x = x;
}

/* s ago, within the last piece. */
static double lag_ago(const struct lagged *l, double s)
{
    const double now = l->x - l->tau_s * l->slope;
    return now - l->slope * s + (l->y - now) / sim_exp_neg(s / l->tau_s);
}

static const struct {
    unsigned sensor, finger, joint;
} bend[] = {{1, 0, 0}, {2, 0, 1}, {4, 1, 0}, {5, 1, 1}, {6, 1, 1}, {7, 2, 0}, {8, 2, 1}, {9, 2, 1},
    {11, 3, 0}, {12, 3, 1}, {13, 3, 1}, {15, 4, 0}, {16, 4, 1}, {17, 4, 1}};
#define BENDS (sizeof bend / sizeof bend[0])

static double code_of(unsigned sensor, double rad)
{
    const struct sim_glove_sensor *s = &sim_glove_sensor[sensor];
    const double deg = rad * 57.29577951308232;
    const double share = s->lo + (deg - s->lo_deg) / (s->hi_deg - s->lo_deg) * (s->hi - s->lo);
    return (-9 + 18 * share) * 3276.8;
}

/* Each channel at its own instant, behind its own low-pass; all other sensors at rest. */
static void follow_glove(unsigned mask, double interval_s)
{
    struct posix_config c = with(mask);
    static struct lagged at[400][BENDS]; /* the last ticks */
    const double h = 50e-6;
    const int every = interval_s > 1e-4 ? 250 : 50; /* a scan fits between */
    double worst = 0, span = 0;
    c.glove = 1;
    c.glove_par.noise_V = c.glove_par.couple = c.glove_par.settle_s = 0;
    c.glove_par.interval_s = interval_s;
    c.hand.pose = sim_pose_find("wrist_up");
    c.exo.apart_s = 0.05;
    start(&c, 20000);
    for (int n = 0; n < 24000; n++) {
        struct lagged *l = at[n % 400];
        struct exh_glove_in in;
        CHECK_EQ_I64(exh_board_wait(), 0);
        for (unsigned b = 0; b < BENDS; b++) {
            const struct sim_finger *f = posix_finger(bend[b].finger);
            const double rad = f ? f->bend_radpm[bend[b].joint] * f->plant.x_m : 0;
            if (n == 0) {
                l[b] = (struct lagged){
                    0, rad, rad, 0, 1 / (6.283185307179586 * c.glove_par.cutoff_Hz)};
                l[b].keep = sim_exp_neg(h / l[b].tau_s);
            } else {
                l[b] = at[(n - 1) % 400][b];
                lag_by(&l[b], rad, h);
            }
        }
        if (n < 400 || n % every || n % 4000 < 1000) { continue; } /* now and then no read */
        CHECK_EQ_I64(exh_board_read_glove(&in), 0);
        CHECK_EQ_I64(in.age_ticks, 0);
        for (unsigned b = 0; b < BENDS; b++) {
            const double ago_s = (22 - bend[b].sensor) * interval_s;
            const int ticks = (int)(ago_s / h);
            const double rad = lag_ago(&at[(n - ticks) % 400][b], ago_s - ticks * h);
            const double off = fabs(in.raw[bend[b].sensor] - code_of(bend[b].sensor, rad));
            CHECK(off < 1.0, "mask %#x, tick %d, %s: %d, want %.2f", mask, n,
                sim_glove_sensor[bend[b].sensor].name, in.raw[bend[b].sensor],
                code_of(bend[b].sensor, rad));
            worst = off > worst ? off : worst;
            span = fabs(rad) > span ? fabs(rad) : span;
        }
        CHECK(fabs(in.raw[20] - code_of(20, 40 / 57.29577951308232)) <= 0.501, "the wrist moved");
        CHECK(
            fabs(in.raw[0] - code_of(0, 0)) <= 0.501 && fabs(in.raw[10] - code_of(10, 0)) <= 0.501,
            "thumb_rotate or abduction moved");
    }
    CHECK(span > 0.8, "bent by %.3f rad only", span);
}

TEST(glove_angles_are_the_fingers_each_in_its_time)
{
    follow_glove(ALL, 4e-6);
    follow_glove(ALL, 20e-6);
    follow_glove(0x02, 1e-4);
    follow_glove(0x11, 5e-4);
}

/* After a long time without a frame the first is right, too. */
TEST(a_glove_that_nobody_read_is_right_at_once)
{
    struct posix_config c = with(ALL);
    struct exh_glove_in in;
    c.glove = 1;
    c.glove_par.noise_V = c.glove_par.couple = c.glove_par.settle_s = 0;
    start(&c, 20000);
    for (int n = 0; n < 25000; n++) { CHECK_EQ_I64(exh_board_wait(), 0); }
    CHECK(posix_finger(0)->path.phase == SIM_PATH_HOLD, "holds");
    CHECK_EQ_I64(exh_board_read_glove(&in), 0);
    for (unsigned b = 0; b < BENDS; b++) {
        const struct sim_finger *f = posix_finger(bend[b].finger);
        const double want = code_of(bend[b].sensor, f->bend_radpm[bend[b].joint] * f->plant.x_m);
        CHECK(fabs(in.raw[bend[b].sensor] - want) < 1.5, "%s: %d, want %.2f",
            sim_glove_sensor[bend[b].sensor].name, in.raw[bend[b].sensor], want);
    }
}

/* ---- A wall
 * -------------------------------------------------------------------------------------- */

#define WALL_M 0.030
#define RATE   2000

/* The contact law in doubles, from codes: what the library does, plainer. k, b, and a light pull
 * that winds the string up. */
static int32_t law(const struct sim_device *d, uint32_t enc, uint32_t before, double k, double b)
{
    const double q = (double)(int32_t)enc * d->step_m / d->decode;
    const double w =
        (double)((int32_t)enc - (int32_t)before) * d->step_m / d->decode * (RATE / 4.0);
    double F = q > WALL_M ? k * (q - WALL_M) + b * w : 0.3;
    if (F < 0) { F = 0; }
    if (F > 20) { F = 20; }
    return (int32_t)(F / d->kf_npa * d->dac_perA);
}

/* Five fingers together, at each of the three speeds. They stop at the wall, press as hand and wall
 * share the way, and none is pulled before it. */
TEST(a_wall_stops_five_fingers_at_once)
{
    static const char *const name[] = {"slow", "natural", "fast"};
    const double k = 2000, b = 5;
    for (unsigned s = 0; s < 3; s++) {
        struct posix_config c = with(ALL);
        uint32_t past[8][FINGERS] = {{0}};
        double at_mps[FINGERS] = {0}, deepest = 0;
        int held = 0, touched[FINGERS] = {0};
        for (unsigned i = 0; i < FINGERS; i++) {
            c.exo.path[i].speed_mps = sim_path_speed(name[s]);
            c.exo.path[i].hold_s = 1.5;
        }
        start(&c, RATE);
        for (int n = 0; n < 20 * RATE; n++) {
            int32_t code[FINGERS];
            struct exh_drive_in in;
            CHECK_EQ_I64(exh_board_wait(), 0);
            in = read_codes();
            for (unsigned i = 0; i < FINGERS; i++) {
                const struct sim_finger *f = posix_finger(i);
                code[i] = law(
                    &c.device, in.enc_raw[i], n < 8 ? in.enc_raw[i] : past[(n + 4) % 8][i], k, b);
                past[n % 8][i] = in.enc_raw[i];
                if (f->plant.q_m < WALL_M && !touched[i]) { at_mps[i] = f->plant.w_mps; }
                touched[i] |= f->plant.q_m >= WALL_M;
                deepest = f->plant.q_m - WALL_M > deepest ? f->plant.q_m - WALL_M : deepest;
            }
            write_codes(code, ALL);
            if (posix_finger(0)->path.phase == SIM_PATH_HOLD &&
                posix_finger(0)->path.end_s - posix_time_s() < 0.1) {
                held = 1;
                break;
            }
        }
        CHECK(held, "%s: it did not come to hold", name[s]);
        for (unsigned i = 0; i < FINGERS; i++) {
            const struct sim_finger *f = posix_finger(i);
            const double force_N = c.device.kf_npa * f->plant.cur_A;
            const double most_N = f->par.k_Npm * c.exo.path[i].push_m; /* were all of it stiff */
            CHECK(fabs(f->plant.w_mps) < 0.02, "%s, %u: moves at %.3f m/s", name[s], i,
                f->plant.w_mps);
            CHECK(force_N > 0.6 * most_N && force_N < 1.15 * most_N, "%s, %u: %.3f N of %.3f",
                name[s], i, force_N, most_N);
            CHECK(fabs(sim_finger_push_N(f) / most_N - 0.85) < 0.25, "%s, %u: feels %.3f N",
                name[s], i, sim_finger_push_N(f));
        }
        check_note("%s: at the wall with %.3f m/s, deepest %.1f mm, then %.2f N", name[s],
            at_mps[1], 1e3 * deepest, c.device.kf_npa * posix_finger(1)->plant.cur_A);
        CHECK(fabs(at_mps[1] - sim_path_speed(name[s])) < 0.2 * sim_path_speed(name[s]) + 0.01,
            "%s: %.4f m/s", name[s], at_mps[1]);
    }
}

TEST_MAIN("finger_board", drives_of_the_fingers_in_use_are_ready, axes_are_not_mixed_up,
    encoders_count_the_string, safe_takes_every_current_away, a_run_is_its_seed,
    the_run_ends_with_the_last_script, a_run_has_the_committed_digits,
    glove_angles_are_the_fingers_each_in_its_time, a_glove_that_nobody_read_is_right_at_once,
    a_wall_stops_five_fingers_at_once);
