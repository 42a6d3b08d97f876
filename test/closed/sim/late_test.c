/* SPDX-License-Identifier: MIT */
/* No order of packets makes a step of force. One finger of the scene moves at random and gets
 * planes at random: early, late, none, of two objects, invalid, from peers that start anew. Faults
 * come between. Its force may rise as the finger's movement into a fixed wall makes it rise. It may
 * rise by no more than late_slew if a plane came too late. */
#include "check.h"

#include "bilateral/bilateral.h"

#include "exhand/error.h"
#include "exhand/fix.h"

#define F          EXH_INDEX
#define MM(v)      ((int32_t)((v)*1073741.824))
#define RATE_HZ    2000
#define TICKS      200
#define WALL_M     0.060 /* the pad's middle where it touches the first object */
#define K_NPM      20000
#define B_NSPM     10
#define SPEED      0.2 /* m/s, at most */
#define RAMP_TICKS 64  /* of the permit, once it is open again */
#define LSB_N      (1.0 / 1048576)
#define NOISE_M    1e-5 /* what the fingertip is beside the string */

static struct bilateral s;
static struct bilateral_cfg cfg;
static struct bilateral_par par;

static struct {
    double z_m, v_mps; /* of the fingertip; the string runs out on the way down */
    double force_N;
    int told_free; /* since the box pulls and the peer is the one it is */
    int late;      /* the contact there is was late, and its force has not come to the law's */
    int touched;   /* in the tick before */
    double lates;  /* counted */
    double steepest_N;
} is;

static double real_in(double lo, double hi)
{
    return lo + (hi - lo) * (double)(check_u64() >> 11) * 0x1p-53;
}

static void set_up(void)
{
    const struct exh_scene_board board = {{1, RATE_HZ}, 16};
    exh_scene_bilateral.defaults();
    par = *(const struct bilateral_par *)(const void *)exh_scene_bilateral.params->active;
    par.own.fingers = 1 << F;
    par.calib.uncalibrated = 1;
    for (int m = 0; m < BILATERAL_MATERIALS; m++) {
        par.material[m] = (struct exh_material_par){K_NPM << 10, B_NSPM << 20, 40 << 20};
    }
    par.precontact[F].late_slew_Nps = (int32_t)(1 + check_u64() % 1000);
    par.precontact[F].age_max_ms = 20;
    memset(&s, 0, sizeof s);
    CHECK_EQ_I64(bilateral_setup(&cfg, &s, &par, board, NULL), 0);
    memset(&is, 0, sizeof is);
    is.z_m = WALL_M + real_in(-0.01, 0.03);
}

/* The world's plane of this tick, if any. It may be old, or of an object in another place. */
static void tell(void)
{
    struct exh_plane p = {EXH_PLANE_HIT, 0, 1, {0, 0, 1 << 30}, {0, 0, 0}};
    const double at_m = WALL_M - par.hand[F].pad_m_q30 / 1073741824.0;
    const uint64_t how = check_u64() % 64;
    p.point_m_q30.z = MM(1e3 * at_m);
    if (how < 40) { return; }
    if (how == 40) { p.kind = EXH_PLANE_NONE; }
    if (how == 41) { p.object = 2, p.point_m_q30.z += MM(real_in(-20, 20)); }
    if (how == 42) { p.normal_q30.z = 0; }
    if (how == 43) { p.kind = (uint8_t)check_u64(); }
    if (how == 44) { p.material = (uint8_t)check_u64(); }
    if (how == 45) { p.point_m_q30.z += MM(real_in(-5, 5)); }
    if (how == 46) {
        exh_precontact_forget(&s.finger[F].precontact);
        is.told_free = 0;
        return;
    }
    if (exh_precontact_update(&s.finger[F].precontact, &cfg.finger[F].precontact, &p,
            (uint32_t)(check_u64() % (how == 47 ? 60 : 10))) == 0 &&
        p.kind == EXH_PLANE_NONE) {
        is.told_free = 1;
    }
}

static void move(void)
{
    if (check_u64() % 20 == 0) { is.v_mps = real_in(-SPEED, SPEED); }
    if (check_u64() % 50 == 0) { is.v_mps = 0; }
    is.z_m += is.v_mps / RATE_HZ;
}

/* One tick: the force may rise by so much. */
static void feel(const struct exh_permit *permit)
{
    struct exh_precontact *p = &s.finger[F].precontact;
    struct bilateral_paper paper = {0};
    struct exh_current_ledger i;
    const uint32_t late_before = p->late_n;
    const double before_N = is.force_N, down_mps = is.v_mps < 0 ? -is.v_mps : 0;
    double may_N, rise_N;
    int32_t bits;
    s.glove_age_ticks = 0;
    s.finger[F].tip_m_q30 =
        (struct exh_vec3){0, 0, MM(1e3 * (is.z_m + real_in(-NOISE_M, NOISE_M)))};
    s.finger[F].slope_q24 = (struct exh_vec3){0, 0, -(1 << 24)};
    paper.q_m_q30 = MM(1e3 * (0.1 - is.z_m));
    paper.qd_mps_q27 = (int32_t)(-is.v_mps * 134217728);
    (void)bilateral_finger_feel(&s, &cfg, 0, permit, &i, &paper, &bits);
    is.force_N = paper.f_des_N_q20 * LSB_N;
    rise_N = is.force_N - before_N;
    if (p->late_n != late_before) {
        is.late = 1;
        is.lates++;
        CHECK(is.told_free && is.v_mps < -0.0099 && permit->mode == EXH_PERMIT_OPEN,
            "late, but it never must: told free %d, %g m/s", is.told_free, is.v_mps);
    }
    /* The rise at a fixed wall for an approaching finger: k v T, and the damper's share. F0 where
     * it begins to act. */
    may_N = is.late ? (double)par.precontact[F].late_slew_Nps / RATE_HZ
                    : K_NPM * down_mps / RATE_HZ + B_NSPM * (2 * SPEED) + 0.2;
    if (permit->share_q30 < 1 << 30) {
        may_N += 40.0 / RAMP_TICKS;
    } /* and what the ramp gives back */
    CHECK(rise_N <= may_N + 4 * LSB_N, "%s: a rise of %g N, %g may be",
        is.late ? "late" : "in time", rise_N, may_N);
    is.steepest_N = is.late && rise_N > is.steepest_N ? rise_N : is.steepest_N;
    if (p->phase == EXH_PRECONTACT_TRACK) { is.told_free = permit->mode == EXH_PERMIT_OPEN; }
    is.late &= p->late;
}

TEST(no_order_of_packets_makes_a_step_of_force)
{
    double lates = 0, steepest_N = 0;
    int sequences = 0;
    while (check_case(100)) {
        struct exh_permit permit = {EXH_PERMIT_OPEN, 0, INT32_MAX, 1, {1 << 30, 0}};
        set_up();
        for (int t = 0; t < TICKS; t++) {
            move();
            tell();
            if (check_u64() % 100 == 0) {
                permit.mode = permit.mode == EXH_PERMIT_OPEN ? EXH_PERMIT_CLOSED : EXH_PERMIT_OPEN;
                permit.share_q30 = 0;
                is.told_free &= permit.mode == EXH_PERMIT_OPEN;
            }
            permit.share_q30 = exh_clamp32(permit.share_q30 + (1 << 30) / RAMP_TICKS, 0, 1 << 30);
            feel(&permit);
        }
        lates += is.lates;
        steepest_N = is.steepest_N > steepest_N ? is.steepest_N : steepest_N;
        sequences++;
    }
    CHECK(sequences < 1000 || (lates > sequences / 20 && steepest_N > 0.1),
        "%g late contacts, %g N: tells nothing", lates, steepest_N);
    check_note("%d sequences of packets, %.0f late contacts: no step of force", sequences, lates);
}

TEST_MAIN("sim/late", no_order_of_packets_makes_a_step_of_force);
