/* SPDX-License-Identifier: MIT */
/* precontact.h by worked examples. A finger comes down along -z onto the plane z = 0.1 m. Its pad
 * is 10 mm, so that it touches at z = 0.11. String and finger move alike. */
#include "exhand/precontact.h"

#include "exhand/contact.h"
#include "exhand/error.h"

#include "check.h"

#define MM(x)  EXH_Q(x, 1000, EXH_Q_POS)
#define ONE    (INT32_C(1) << 30)
#define TICK   ((struct exh_period){1, 1000})
#define TOUCH  MM(110)
#define Q_AT_0 MM(200) /* q where z would be 0: q = 0.2 - z */

static struct exh_material_par material[2] = {
    {EXH_Q(20000, 1, EXH_Q_K), EXH_Q(60, 1, EXH_Q_B), EXH_Q(12, 1, EXH_Q_FORCE)},
    {EXH_Q(500, 1, EXH_Q_K), EXH_Q(1, 1, EXH_Q_B), EXH_Q(3, 1, EXH_Q_FORCE)}};
static struct exh_precontact_par par;
static struct exh_precontact_cfg cfg;
static struct exh_precontact s;
static struct exh_precontact_in in;
static uint32_t bits;

#define MPS_CENTI 1342177 /* 0.01 m/s */

static const struct exh_plane floor_plane = {EXH_PLANE_HIT, 0, 1, {0, 0, ONE}, {0, 0, MM(100)}};

static void start(void)
{
    par =
        (struct exh_precontact_par){-MM(5), MM(1), INT32_C(1) << 24, 0, 0, 100, MM(5), 10, 20, 100};
    s = (struct exh_precontact){0};
    in = (struct exh_precontact_in){{0, 0, 0}, {0, 0, 0}, 0, 0, 0, 1, 0};
    CHECK_EQ_I64(exh_precontact_setup(&cfg, &par, material, 2, MM(10), TICK), 0);
}

/* One tick with the fingertip at height z. */
static void at(int32_t z_m_q30)
{
    in.tip_m_q30.z = z_m_q30;
    in.pos_m_q30 = Q_AT_0 - z_m_q30;
    bits = exh_precontact_step(&s, &cfg, &in);
}

static void tell(struct exh_plane p) { CHECK_EQ_I64(exh_precontact_update(&s, &cfg, &p, 0), 0); }

static void frozen_at_116(void)
{
    start();
    tell(floor_plane);
    at(MM(116));
    at(MM(114));
    CHECK(s.phase == EXH_PRECONTACT_FROZEN, "d = -4 mm");
    CHECK(!exh_precontact_none(&s), "a contact");
}

TEST(distance_has_the_sign_of_the_text)
{
    start();
    tell(floor_plane);
    at(MM(150));
    CHECK_EQ_I64(s.d_m_q30, MM(100) - MM(150) + MM(10));
    at(TOUCH);
    CHECK_EQ_I64(s.d_m_q30, MM(100) - MM(110) + MM(10));
    at(MM(90));
    CHECK_EQ_I64(s.d_m_q30, MM(100) - MM(90) + MM(10));
    par.printed_sign = 1; /* of planes sentfrom now on */
    s = (struct exh_precontact){0};
    CHECK_EQ_I64(exh_precontact_setup(&cfg, &par, material, 2, MM(10), TICK), 0);
    tell(floor_plane);
    at(MM(90));
    CHECK_EQ_I64(s.d_m_q30, MM(100) - MM(90) - MM(10));
}

TEST(rounds_once_and_half_up)
{
    start();
    CHECK_EQ_I64(exh_precontact_setup(&cfg, &par, material, 2, 0, TICK), 0);
    /* (0.6, 0, 0.8) and a tip of 3, 5, 1 LSB: products add up before they are rounded. */
    tell((struct exh_plane){EXH_PLANE_HIT, 0, 1, {644245094, 0, 858993459}, {0, 0, 0}});
    in.tip_m_q30 = (struct exh_vec3){-3, 5, 0};
    at(-1); /* 1.8 + 0.8 = 2.6 */
    CHECK_EQ_I64(s.d_m_q30, 3);
    in.tip_m_q30.x = -1;
    at(1); /* 0.6 - 0.8 = -0.2 */
    CHECK_EQ_I64(s.d_m_q30, 0);
    tell((struct exh_plane){EXH_PLANE_HIT, 0, 1, {ONE, 0, 0}, {INT32_MAX, 0, 0}});
    in.tip_m_q30.x = INT32_MIN; /* 4 m: saturates */
    at(0);
    CHECK_EQ_I64(s.d_m_q30, INT32_MAX);
}

TEST(no_plane_means_no_contact)
{
    start();
    at(MM(150));
    CHECK(
        s.lim_m_q30 == EXH_PRECONTACT_NO_LIM && s.d_m_q30 == INT32_MIN && bits == 0, "first tick");
    CHECK(exh_precontact_none(&s), "no plane");
    tell((struct exh_plane){EXH_PLANE_UNTOLD, 9, 9, {1, 2, 3}, {4, 5, 6}});
    at(MM(150));
    CHECK(s.lim_m_q30 == EXH_PRECONTACT_NO_LIM && bits == 0, "untold");
    tell((struct exh_plane){EXH_PLANE_NONE, 9, 9, {1, 2, 3}, {4, 5, 6}});
    at(MM(90));
    CHECK(s.lim_m_q30 == EXH_PRECONTACT_NO_LIM && bits == 0, "no hit");
    CHECK(s.born_n == 0 && s.refused_n == 0 && s.stale_n == 0, "nothing to count");
}

TEST(tracks_freezes_and_releases)
{
    start();
    tell(floor_plane);
    at(MM(150));
    CHECK(bits == EXH_PRECONTACT_TRACKS, "bits %" PRIx32, bits);
    CHECK_EQ_I64(s.lim_m_q30, in.pos_m_q30 + -(int64_t)s.d_m_q30);
    at(MM(116));
    CHECK_EQ_I64(s.lim_m_q30, Q_AT_0 - MM(116) - (MM(100) - MM(116) + MM(10)));
    {
        const int32_t lim = s.lim_m_q30;
        in.tip_m_q30.x = MM(3); /* along the plane: nothing */
        at(MM(100) + MM(15));   /* d = -5 mm, and a rounding less or more */
        at(MM(114));
        CHECK(bits & EXH_PRECONTACT_STANDS, "frozen");
        CHECK_EQ_I64(s.frozen_n, 1);
        at(MM(60));
        CHECK(s.lim_m_q30 >= lim - 1 && s.lim_m_q30 <= lim + 1, "stands");
        at(MM(115) + MM(1) / 2); /* back beyond d_lim, within the hysteresis */
        CHECK(bits == EXH_PRECONTACT_STANDS, "hysteresis");
        at(MM(117));
        CHECK(bits == (EXH_PRECONTACT_TRACKS | EXH_PRECONTACT_RELEASE), "released: %" PRIx32, bits);
        CHECK_EQ_I64(s.lim_m_q30, (int64_t)in.pos_m_q30 - s.d_m_q30);
    }
    tell(floor_plane);
    at(MM(117));
    CHECK(bits & EXH_PRECONTACT_TRACKS, "again");
    at(MM(114));
    CHECK(bits & EXH_PRECONTACT_FREEZE, "again");
}

TEST(the_boundary_is_d_lim_itself)
{
    start();
    CHECK_EQ_I64(exh_precontact_setup(&cfg, &par, material, 2, 0, TICK), 0);
    tell((struct exh_plane){EXH_PLANE_HIT, 0, 1, {0, 0, ONE}, {0, 0, 0}});
    at(MM(5) + 1);
    CHECK(bits & EXH_PRECONTACT_TRACKS, "d = d_lim - 1");
    at(MM(5));
    CHECK(bits & EXH_PRECONTACT_FREEZE, "d = d_lim");
    CHECK_EQ_I64(s.lim_m_q30, Q_AT_0);
    at(MM(5) + MM(1));
    CHECK(s.phase == EXH_PRECONTACT_FROZEN, "d = d_lim - hyst");
    at(MM(5) + MM(1) + 1);
    CHECK(bits & EXH_PRECONTACT_RELEASE, "d = d_lim - hyst - 1");
}

TEST(a_touching_finger_is_not_released)
{
    frozen_at_116();
    in.touching = 1;
    at(MM(150)); /* the glove says far, the string still pulls against the wall */
    CHECK(s.phase == EXH_PRECONTACT_FROZEN, "held");
    in.touching = 0;
    at(MM(150));
    CHECK(bits & EXH_PRECONTACT_RELEASE, "let go");
}

/* The string's zero has slipped by 60 mm: the law goes on touching wherever the finger is. */
TEST(a_contact_that_the_glove_denies_is_let_go)
{
    const uint32_t doubt = EXH_PRECONTACT_STANDS | EXH_PRECONTACT_DOUBT;
    struct exh_contact law = {0, 0, 0, 0};
    const struct exh_contact_par wall = {EXH_Q(20000, 1, EXH_Q_K), 0, 0, 0, MM(1)};
    struct exh_force_ledger f;
    int n = 0, c = 1;
    frozen_at_116();
    CHECK_EQ_I64(cfg.doubt_ticks, 11);
    in.touching = 1;
    at(MM(115) + MM(6)); /* d = d_lim - hyst - doubt */
    CHECK(bits == EXH_PRECONTACT_STANDS && s.doubt_ticks == 0, "not more than the margin");
    for (int i = 0; i < 11; i++) {
        at(MM(115) + MM(6) + 2);
        CHECK(bits == doubt, "tick %d: %" PRIx32, i, bits);
    }
    at(MM(112)); /* the glove had been wrong */
    CHECK(bits == EXH_PRECONTACT_STANDS && s.doubt_ticks == 0, "it was there");
    for (n = 0; c && n < 100; n++) {
        at(MM(150));
        in.pos_m_q30 += MM(60);
        c = exh_contact_step(
            &law, &wall, (struct exh_contact_in){in.pos_m_q30, 0, s.lim_m_q30}, &f);
        in.touching = (uint8_t)c;
    }
    CHECK(n == 12 && f.spring_N_q20 == 0, "force in %d ticks", n);
    CHECK(bits == (EXH_PRECONTACT_RELEASE | EXH_PRECONTACT_DOUBT | EXH_PRECONTACT_LETGO),
        "%" PRIx32, bits);
    CHECK(s.let_go_n == 1 && s.lim_m_q30 == EXH_PRECONTACT_NO_LIM, "counted");
    tell(floor_plane);
    at(MM(150));
    CHECK(bits == EXH_PRECONTACT_TRACKS && s.doubt_ticks == 0, "as new");
}

/* A doubt does not depend on the messages that arrive meanwhile. */
TEST(a_doubt_hangs_on_no_message)
{
    struct exh_plane p = floor_plane;
    frozen_at_116();
    in.touching = 1;
    for (int i = 0; i < 11; i++) {
        p.point_m_q30.z += MM(1);
        tell(p);
        at(MM(150));
        CHECK(bits & EXH_PRECONTACT_DOUBT, "tick %d", i);
    }
    at(MM(150));
    CHECK(bits & EXH_PRECONTACT_LETGO, "let go");
}

TEST(an_unknown_fingertip)
{
    start();
    CHECK_EQ_I64(cfg.tip_ticks, 21);
    tell(floor_plane);
    in.tip_age_ticks = 20;
    at(MM(150));
    CHECK(bits == EXH_PRECONTACT_TRACKS, "as old as may be");
    in.tip_age_ticks = 21;
    at(MM(150));
    CHECK(bits == EXH_PRECONTACT_BLIND && s.lim_m_q30 == EXH_PRECONTACT_NO_LIM &&
              s.d_m_q30 == INT32_MIN && s.stale_n == 0,
        "tracking: no contact, %" PRIx32, bits);
    in.tip_age_ticks = 0;
    at(MM(108));
    CHECK(bits == EXH_PRECONTACT_AROUND, "came in unseen");
    at(MM(150));
    at(MM(114));
    CHECK(bits & EXH_PRECONTACT_FREEZE, "left, and back");
    in.tip_age_ticks = UINT32_MAX;
    for (int i = 0; i < 11; i++) {
        in.touching = i & 1;
        at(MM(150));
        CHECK(bits == (EXH_PRECONTACT_STANDS | EXH_PRECONTACT_DOUBT | EXH_PRECONTACT_BLIND),
            "tick %d: %" PRIx32, i, bits);
    }
    at(MM(150));
    CHECK((bits & EXH_PRECONTACT_LETGO) && s.let_go_n == 1, "frozen: the string alone for 10 ms");
    at(MM(150));
    CHECK(bits == EXH_PRECONTACT_BLIND, "and then none");
}

TEST(missed_ticks_age_a_plane_and_a_doubt)
{
    start();
    tell(floor_plane);
    at(MM(150));
    exh_precontact_advance(&s, 99);
    at(MM(150));
    CHECK(bits == EXH_PRECONTACT_TRACKS, "its last tick");
    at(MM(150));
    CHECK(bits == EXH_PRECONTACT_STALE && s.stale_n == 1, "over");
    exh_precontact_advance(&s, UINT32_MAX);
    CHECK(s.left_ticks == 0 && s.doubt_ticks == 0, "no less than none");
    frozen_at_116();
    in.touching = 1;
    at(MM(150));
    exh_precontact_advance(&s, 10);
    at(MM(150));
    CHECK(bits & EXH_PRECONTACT_LETGO, "12 ticks");
    frozen_at_116();
    in.touching = 1;
    at(MM(150));
    exh_precontact_advance(&s, UINT32_MAX);
    at(MM(150));
    CHECK(bits & EXH_PRECONTACT_LETGO, "and no wrap");
}

TEST(what_comes_while_frozen_is_ignored_and_counted)
{
    struct exh_plane other = floor_plane;
    int32_t lim;
    frozen_at_116();
    lim = s.lim_m_q30;
    tell(floor_plane);
    CHECK_EQ_I64(s.ignored_n, 0);
    other.point_m_q30.z = MM(120);
    tell(other);
    at(MM(112));
    CHECK(
        s.ignored_n == 1 && s.lim_m_q30 == lim && s.d_m_q30 == MM(100) - MM(112) + MM(10), "moved");
    other.material = 1;
    other.object = 2;
    tell(other);
    tell((struct exh_plane){EXH_PLANE_NONE, 0, 0, {0, 0, 0}, {0, 0, 0}});
    at(MM(90));
    CHECK(s.ignored_n == 3 && s.lim_m_q30 == lim && s.phase == EXH_PRECONTACT_FROZEN, "gone");
    CHECK_EQ_I64(s.taken.k_Npm_q10, material[0].k_Npm_q10);
    at(MM(150));
    CHECK(s.lim_m_q30 == EXH_PRECONTACT_NO_LIM && bits == EXH_PRECONTACT_RELEASE,
        "left, and there is none any more");
}

TEST(what_came_while_frozen_is_new_at_the_release)
{
    struct exh_plane p = floor_plane;
    frozen_at_116();
    p.point_m_q30.z = MM(120); /* it follows the finger that leaves */
    tell(p);
    at(MM(117));
    CHECK(bits == (EXH_PRECONTACT_RELEASE | EXH_PRECONTACT_AROUND) && s.born_n == 1, "no snap");
    CHECK(s.lim_m_q30 == EXH_PRECONTACT_NO_LIM && s.d_m_q30 == MM(120) - MM(117) + MM(10), "d");
}

TEST(born_inside_gives_no_contact_until_left)
{
    struct exh_plane p = floor_plane;
    start();
    tell(p);
    at(MM(108));
    CHECK(bits == EXH_PRECONTACT_AROUND, "bits %" PRIx32, bits);
    CHECK(s.lim_m_q30 == EXH_PRECONTACT_NO_LIM && s.born_n == 1, "first");
    tell(p);
    at(MM(90));
    CHECK(s.lim_m_q30 == EXH_PRECONTACT_NO_LIM && s.born_n == 1, "the same is counted once");
    p.object = 7;
    tell(p);
    at(MM(90));
    CHECK(s.born_n == 2, "another object");
    at(TOUCH + MM(1));
    CHECK(bits & EXH_PRECONTACT_AROUND, "d = -1 mm: not by more than hyst");
    at(TOUCH + MM(1) + 1);
    CHECK(bits & EXH_PRECONTACT_TRACKS, "left");
    at(TOUCH + 9);
    CHECK((bits & EXH_PRECONTACT_TRACKS) && s.lim_m_q30 > in.pos_m_q30, "not yet touched");
    at(TOUCH + 8);
    CHECK((bits & EXH_PRECONTACT_FREEZE) && s.lim_m_q30 == Q_AT_0 - TOUCH, "and back");
}

TEST(born_near_follows_to_the_touch)
{
    struct exh_plane p = floor_plane;
    start();
    tell(p);
    at(MM(112));
    CHECK(bits == EXH_PRECONTACT_TRACKS && s.lim_m_q30 == Q_AT_0 - MM(110), "d = -2 mm");
    p.point_m_q30.z = MM(99);
    tell(p);
    at(MM(111));
    CHECK(bits == EXH_PRECONTACT_TRACKS && s.lim_m_q30 == Q_AT_0 - MM(109), "the object left");
    at(MM(109));
    CHECK(bits == (EXH_PRECONTACT_STANDS | EXH_PRECONTACT_FREEZE) &&
              s.lim_m_q30 == Q_AT_0 - MM(109) && s.late_n == 0,
        "frozen at the touch, where it was");
    at(MM(99) + MM(10) + MM(1));
    CHECK(bits == EXH_PRECONTACT_STANDS, "d = -1 mm: no more than hyst");
    at(MM(99) + MM(10) + MM(1) + 1);
    CHECK(bits == (EXH_PRECONTACT_RELEASE | EXH_PRECONTACT_TRACKS), "released before d_lim");
    at(MM(115));
    at(MM(113));
    CHECK(bits & EXH_PRECONTACT_FREEZE, "who has been beyond d_lim is frozen there");
}

TEST(who_went_around_it_leaves_by_the_string)
{
    frozen_at_116();
    in.tip_m_q30.z = MM(60); /* by the glove far behind the floor, while the string goes back */
    in.pos_m_q30 = s.lim_m_q30 - MM(4) - MM(5);
    bits = exh_precontact_step(&s, &cfg, &in);
    CHECK(bits == EXH_PRECONTACT_STANDS, "by |d_lim| since the freeze");
    in.touching = 1;
    in.pos_m_q30--;
    bits = exh_precontact_step(&s, &cfg, &in);
    CHECK(bits == EXH_PRECONTACT_STANDS, "but it touches");
    in.touching = 0;
    bits = exh_precontact_step(&s, &cfg, &in);
    CHECK(bits == (EXH_PRECONTACT_RELEASE | EXH_PRECONTACT_AROUND), "by more: %" PRIx32, bits);
}

/* Free, as the world said; then inside, running out. */
static void late_at(int32_t z_m_q30, int32_t vel_mps_q27)
{
    start();
    tell((struct exh_plane){EXH_PLANE_NONE, 0, 0, {0, 0, 0}, {0, 0, 0}});
    at(MM(150));
    tell(floor_plane);
    in.vel_mps_q27 = vel_mps_q27;
    at(z_m_q30);
    tell(floor_plane);
    at(z_m_q30);
}

TEST(late_is_at_the_true_place_and_slow)
{
    late_at(MM(107), MPS_CENTI + 1);
    CHECK(bits == (EXH_PRECONTACT_STANDS | EXH_PRECONTACT_FREEZE | EXH_PRECONTACT_LATE), "%" PRIx32,
        bits);
    CHECK(s.late_n == 1 && s.late_m_q30 == MM(103) - MM(100) && s.born_n == 0, "counted");
    CHECK(s.lim_m_q30 == Q_AT_0 - TOUCH && s.late, "where the object is");
    at(MM(106));
    CHECK(bits == (EXH_PRECONTACT_STANDS | EXH_PRECONTACT_LATE), "still");
    exh_precontact_arrived(&s);
    at(MM(106));
    CHECK(bits == EXH_PRECONTACT_STANDS, "no more");
    at(MM(150));
    CHECK(bits == (EXH_PRECONTACT_RELEASE | EXH_PRECONTACT_TRACKS), "left");
}

/* Bytes do not hold where a finger was: a plane that was about to be late counts as inside. */
TEST(from_bytes_nothing_is_late)
{
    uint8_t buf[512];
    for (int resumes = 0; resumes < 2; resumes++) {
        struct exh_bytes c = exh_bytes_writer(buf, sizeof buf);
        start();
        tell((struct exh_plane){EXH_PLANE_NONE, 0, 0, {0, 0, 0}, {0, 0, 0}});
        at(MM(150));
        tell(floor_plane);
        in.vel_mps_q27 = INT32_MAX;
        at(MM(107));
        tell(floor_plane);
        CHECK(s.phase == EXH_PRECONTACT_IDLE && s.met && s.told == 2, "told %d", s.told);
        if (resumes) {
            s.told = 3; /* damaged, or from another program */
            exh_precontact_serialize(&c, &s);
            c = exh_bytes_reader(buf, c.at);
            exh_precontact_serialize(&c, &s);
            CHECK(s.told == 2, "%d", s.told);
        }
        at(MM(107));
        CHECK(((bits & EXH_PRECONTACT_LATE) != 0) == !resumes, "%d: %" PRIx32, resumes, bits);
        CHECK(((bits & EXH_PRECONTACT_AROUND) != 0) == resumes, "%d: %" PRIx32, resumes, bits);
    }
}

TEST(never_is_who_rests_or_has_just_begun)
{
    late_at(MM(107), MPS_CENTI);
    CHECK(bits == EXH_PRECONTACT_AROUND && s.born_n == 1 && s.late_n == 0, "it rests");
    in.vel_mps_q27 = INT32_MAX;
    at(MM(106));
    CHECK(bits == EXH_PRECONTACT_AROUND, "and stays so");
    start(); /* the first word of the world */
    in.vel_mps_q27 = INT32_MAX;
    at(MM(150));
    tell(floor_plane);
    at(MM(107));
    CHECK(bits == EXH_PRECONTACT_AROUND, "armed just now");
    late_at(MM(150), INT32_MAX);
    exh_precontact_forget(&s);
    tell((struct exh_plane){EXH_PLANE_HIT, 0, 2, {0, 0, ONE}, {0, 0, MM(100)}});
    at(MM(107));
    CHECK(bits == EXH_PRECONTACT_AROUND, "a peer that has started anew");
    late_at(MM(150), INT32_MAX);
    in.pulls = 0;
    at(MM(150));
    in.pulls = 1;
    s.phase = EXH_PRECONTACT_IDLE; /* as if its plane had become too old meanwhile */
    at(MM(107));
    CHECK(bits == EXH_PRECONTACT_AROUND, "a fault between");
}

TEST(another_object_has_to_be_left_first)
{
    struct exh_plane p = floor_plane;
    start();
    tell(p);
    at(MM(130));
    p.object = 2;
    p.point_m_q30.z = MM(125);
    tell(p);
    at(MM(129)); /* d = 6 mm from one tick to the next; it rests */
    CHECK((bits & EXH_PRECONTACT_AROUND) && s.born_n == 1 && s.phase != EXH_PRECONTACT_FROZEN,
        "thrown onto the finger");
    p.point_m_q30.z = MM(100);
    tell(p);
    at(MM(129));
    CHECK(bits & EXH_PRECONTACT_TRACKS, "it went");
    p.object = 3;
    tell(p);
    at(MM(128));
    CHECK(bits & EXH_PRECONTACT_TRACKS, "a third one as far off");
}

TEST(the_same_object_may_come_to_the_finger)
{
    struct exh_plane p = floor_plane;
    int32_t lim;
    start();
    tell(p);
    at(MM(116));
    lim = s.lim_m_q30;
    p.point_m_q30.z = MM(102);
    tell(p);
    at(MM(116));
    CHECK((bits & EXH_PRECONTACT_FREEZE) && s.lim_m_q30 == lim, "q_lim of the tick before, eq. 3");
    CHECK_EQ_I64(s.d_m_q30, MM(102) - MM(116) + MM(10));
}

TEST(a_stale_plane_is_none)
{
    start();
    CHECK_EQ_I64(cfg.age_ticks, 101);
    tell(floor_plane);
    for (int i = 0; i < 101; i++) {
        at(MM(150));
        CHECK(bits & EXH_PRECONTACT_TRACKS, "tick %d", i);
    }
    at(MM(150));
    CHECK(bits == EXH_PRECONTACT_STALE && s.lim_m_q30 == EXH_PRECONTACT_NO_LIM && s.stale_n == 1,
        "too old: %" PRIx32, bits);
    at(MM(112));
    CHECK(bits == EXH_PRECONTACT_STALE && s.stale_n == 1, "counted once");
    tell(floor_plane);
    at(MM(108));
    CHECK(bits & EXH_PRECONTACT_AROUND, "who came in unseen, and rests, gets no contact");
}

TEST(a_message_may_be_old_when_it_comes)
{
    start();
    tell(floor_plane);
    at(MM(150));
    CHECK_EQ_I64(exh_precontact_update(&s, &cfg, &floor_plane, 101), 0);
    at(MM(150)); /* refreshed by nothing: it did not become old here */
    CHECK(bits == EXH_PRECONTACT_STALE && s.stale_n == 0, "too old from the start");
    tell(floor_plane);
    at(MM(150));
    tell((struct exh_plane){EXH_PLANE_NONE, 0, 1, {0, 0, 0}, {0, 0, 0}});
    tell(floor_plane); /* two messages in a tick: there was none between */
    at(MM(108));
    CHECK(bits == EXH_PRECONTACT_AROUND, "new again");
    start();
    CHECK_EQ_I64(exh_precontact_update(&s, &cfg, &floor_plane, 100), 0);
    at(MM(150));
    CHECK(bits & EXH_PRECONTACT_TRACKS, "its last tick");
    at(MM(150));
    CHECK(bits & EXH_PRECONTACT_STALE, "over");
    CHECK_EQ_I64(exh_precontact_update(&s, &cfg, &floor_plane, UINT32_MAX), 0);
    at(MM(150));
    CHECK(bits & EXH_PRECONTACT_STALE, "never young");
}

TEST(a_frozen_plane_does_not_age)
{
    frozen_at_116();
    for (int i = 0; i < 1000; i++) { at(MM(112)); }
    CHECK(s.phase == EXH_PRECONTACT_FROZEN && s.stale_n == 0, "world gone for 1 s");
    at(MM(150));
    CHECK(bits == (EXH_PRECONTACT_RELEASE | EXH_PRECONTACT_STALE) && s.stale_n == 0,
        "after it, nothing is known");
}

TEST(what_cannot_be_is_refused)
{
    struct exh_plane p = floor_plane;
    start();
    p.normal_q30.z = ONE - 1;
    CHECK_EQ_I64(exh_precontact_update(&s, &cfg, &p, 0), 0);
    p.normal_q30.z = ONE - 8191; /* |n|^2 = 1 - 2^-16 + a little */
    CHECK_EQ_I64(exh_precontact_update(&s, &cfg, &p, 0), 0);
    p.normal_q30.z = ONE - 8193;
    CHECK_EQ_I64(exh_precontact_update(&s, &cfg, &p, 0), -EXH_E_RANGE);
    p.normal_q30.z = ONE + 8191;
    CHECK_EQ_I64(exh_precontact_update(&s, &cfg, &p, 0), 0);
    p.normal_q30.z = ONE + 8193;
    CHECK_EQ_I64(exh_precontact_update(&s, &cfg, &p, 0), -EXH_E_RANGE);
    p.normal_q30 = (struct exh_vec3){0, 0, 0};
    CHECK_EQ_I64(exh_precontact_update(&s, &cfg, &p, 0), -EXH_E_RANGE);
    p.normal_q30 = (struct exh_vec3){INT32_MIN, INT32_MIN, INT32_MIN};
    CHECK_EQ_I64(exh_precontact_update(&s, &cfg, &p, 0), -EXH_E_RANGE);
    p = floor_plane;
    p.material = 2;
    CHECK_EQ_I64(exh_precontact_update(&s, &cfg, &p, 0), -EXH_E_RANGE);
    p.material = 0;
    p.kind = 3;
    CHECK_EQ_I64(exh_precontact_update(&s, &cfg, &p, 0), -EXH_E_RANGE);
    CHECK_EQ_I64(s.refused_n, 6);
    at(MM(150));
    CHECK(bits & EXH_PRECONTACT_TRACKS, "the plane before goes on");
}

TEST(material_is_taken_at_the_freeze)
{
    struct exh_plane p = floor_plane;
    const int32_t k = material[1].k_Npm_q10;
    start();
    p.material = 1;
    tell(p);
    at(MM(116));
    CHECK_EQ_I64(s.taken.k_Npm_q10, 0);
    material[1].k_Npm_q10 = k + 5;
    at(MM(114));
    material[1].k_Npm_q10 = k;
    at(MM(113));
    CHECK_EQ_I64(s.taken.k_Npm_q10, k + 5);
    CHECK(s.taken.b_Nspm_q20 == material[1].b_Nspm_q20 &&
              s.taken.f_max_N_q20 == material[1].f_max_N_q20,
        "b, f_max");
}

TEST(scale_and_slope)
{
    start();
    par.scale_q24 = INT32_C(3) << 23; /* 1.5 */
    tell(floor_plane);
    at(MM(130));
    CHECK_EQ_I64(s.lim_m_q30, (int64_t)in.pos_m_q30 - (3 * (int64_t)s.d_m_q30 + 1) / 2);
    par.from_slope = 1;
    in.slope_q24 = (struct exh_vec3){5, 6, -(INT32_C(1) << 23)}; /* half as fast as the string */
    at(MM(130));
    CHECK_EQ_I64(s.lim_m_q30, in.pos_m_q30 - 2 * (int64_t)s.d_m_q30);
    CHECK(!(bits & EXH_PRECONTACT_BENT), "fits");
    in.slope_q24.z = 100; /* moves away from the plane */
    at(MM(130));
    CHECK_EQ_I64(s.lim_m_q30, in.pos_m_q30 - 8 * (int64_t)s.d_m_q30);
    CHECK(bits & EXH_PRECONTACT_BENT, "limited");
    in.slope_q24.z = INT32_MIN; /* 128 times as fast */
    at(MM(130));
    CHECK_EQ_I64(s.lim_m_q30, in.pos_m_q30 - (((int64_t)s.d_m_q30 + 4) >> 3));
    CHECK(bits & EXH_PRECONTACT_BENT, "limited");
    par.from_slope = 0;
    par.scale_q24 = INT32_C(1) << 27;
    at(INT32_MAX); /* 1.89 m off, 8 times as far */
    CHECK_EQ_I64(s.lim_m_q30, EXH_PRECONTACT_NO_LIM);
}

TEST(set_up_refuses)
{
    struct exh_material_par odd[2];
    start();
    for (int i = 0; i < EXH_PRECONTACT_ROWS; i++) {
        int32_t *v = (int32_t *)&par + i;
        const int32_t was = *v;
        *v = exh_precontact_rows[i].min - 1;
        CHECK(exh_precontact_setup(&cfg, &par, material, 2, 0, TICK) == -EXH_E_RANGE, "row %d", i);
        *v = exh_precontact_rows[i].max + 1;
        CHECK(exh_precontact_setup(&cfg, &par, material, 2, 0, TICK) == -EXH_E_RANGE, "row %d", i);
        *v = was;
    }
    for (int i = 0; i < EXH_MATERIAL_ROWS; i++) {
        memcpy(odd, material, sizeof odd);
        ((int32_t *)&odd[1])[i] = exh_material_rows[i].max + 1;
        CHECK(exh_precontact_setup(&cfg, &par, odd, 2, 0, TICK) == -EXH_E_RANGE, "row %d", i);
        CHECK(exh_precontact_setup(&cfg, &par, odd, 1, 0, TICK) == 0, "row %d unused", i);
        memcpy(odd, material, sizeof odd);
        ((int32_t *)&odd[0])[i] = exh_material_rows[i].max + 1;
        CHECK(exh_precontact_setup(&cfg, &par, odd, 2, 0, TICK) == -EXH_E_RANGE,
            "row %d of the first", i);
    }
    CHECK_EQ_I64(exh_precontact_setup(&cfg, &par, material, 0, 0, TICK), -EXH_E_RANGE);
    CHECK_EQ_I64(exh_precontact_setup(&cfg, &par, material, 256, 0, TICK), -EXH_E_RANGE);
    CHECK_EQ_I64(exh_precontact_setup(&cfg, &par, material, 2, -1, TICK), -EXH_E_RANGE);
    CHECK_EQ_I64(exh_precontact_setup(&cfg, &par, material, 2, MM(25) + 1, TICK), -EXH_E_RANGE);
    CHECK_EQ_I64(exh_precontact_setup(&cfg, &par, material, 2, 0, (struct exh_period){0, 1000}),
        -EXH_E_RATE);
    for (int i = 0; i < EXH_PRECONTACT_ROWS; i++) {
        CHECK(exh_precontact_rows[i].dflt >= exh_precontact_rows[i].min &&
                  exh_precontact_rows[i].dflt <= exh_precontact_rows[i].max,
            "default %d", i);
    }
}

TEST(state_round_trip)
{
    struct exh_precontact back = {0};
    uint8_t buf[160], again[160];
    struct exh_bytes c = exh_bytes_writer(buf, sizeof buf);
    uint32_t n;
    frozen_at_116();
    s.ignored_n = 7;
    exh_precontact_serialize(&c, &s);
    n = c.at;
    CHECK_EQ_I64(n, 8 + 12 + 2 * 23 + 32 + 1 + 16);
    c = exh_bytes_reader(buf, n);
    exh_precontact_serialize(&c, &back);
    CHECK(exh_bytes_ok(&c), "reads");
    c = exh_bytes_writer(again, sizeof again);
    exh_precontact_serialize(&c, &back);
    CHECK(memcmp(buf, again, n) == 0 && back.phase == EXH_PRECONTACT_FROZEN && back.ignored_n == 7,
        "the same");
}

TEST(damaged_state_comes_back_into_range)
{
    struct exh_precontact back = {0};
    uint8_t buf[160];
    struct exh_bytes c;
    start();
    memset(buf, 0x7F, sizeof buf);
    c = exh_bytes_reader(buf, sizeof buf);
    exh_precontact_serialize(&c, &back);
    CHECK(back.phase == EXH_PRECONTACT_IDLE && back.left_ticks == 0, "no plane");
    CHECK(back.taken.f_max_N_q20 == exh_material_rows[2].max, "material");
    CHECK(back.held.normal_q30.x == 0 && back.newest.offset_m_q60 == 0, "zeros");
    for (int i = 0; i < 3; i++) {
        const int64_t far = (INT64_C(1) << 62) + 1; /* than any plane */
        frozen_at_116();
        if (i == 0) { s.held.normal_q30.x = 1 << 24; } /* no unit vector */
        if (i > 0) { s.held.offset_m_q60 = i == 1 ? far : -far; }
        c = exh_bytes_writer(buf, sizeof buf);
        exh_precontact_serialize(&c, &s);
        c = exh_bytes_reader(buf, sizeof buf);
        exh_precontact_serialize(&c, &back);
        CHECK(back.phase == EXH_PRECONTACT_IDLE && back.held.normal_q30.z == 0, "held, %d", i);
    }
    for (int sign = -1; sign <= 1; sign += 2) { /* that far may be */
        frozen_at_116();
        s.held.offset_m_q60 = sign < 0 ? -(INT64_C(1) << 62) : INT64_C(1) << 62;
        c = exh_bytes_writer(buf, sizeof buf);
        exh_precontact_serialize(&c, &s);
        c = exh_bytes_reader(buf, sizeof buf);
        exh_precontact_serialize(&c, &back);
        CHECK(back.phase == EXH_PRECONTACT_FROZEN && back.held.offset_m_q60 == s.held.offset_m_q60,
            "sign %d", sign);
    }
    frozen_at_116();
    s.newest = s.held;
    tell(floor_plane);
    s.phase = 200;
    s.newest.material = 77; /* of a box with more materials */
    c = exh_bytes_writer(buf, sizeof buf);
    exh_precontact_serialize(&c, &s);
    c = exh_bytes_reader(buf, sizeof buf);
    exh_precontact_serialize(&c, &s);
    CHECK(s.phase == EXH_PRECONTACT_IDLE && s.left_ticks > 0, "phase");
    s.phase = EXH_PRECONTACT_TRACK;
    at(MM(114));
    CHECK((bits & EXH_PRECONTACT_FREEZE) && s.taken.k_Npm_q10 == material[0].k_Npm_q10, "index");
}

static void round_trip(void)
{
    uint8_t buf[160];
    struct exh_bytes c = exh_bytes_writer(buf, sizeof buf);
    exh_precontact_serialize(&c, &s);
    c = exh_bytes_reader(buf, c.at);
    s = (struct exh_precontact){0};
    exh_precontact_serialize(&c, &s);
    CHECK(exh_bytes_ok(&c), "reads");
}

TEST(restored_tracking_touches_nothing_at_once)
{
    start();
    tell(floor_plane);
    at(MM(116));
    s.lim_m_q30 = INT32_MIN;
    s.left_ticks = UINT32_MAX;
    round_trip();
    at(MM(114));
    CHECK(bits == EXH_PRECONTACT_AROUND && s.lim_m_q30 == EXH_PRECONTACT_NO_LIM, "%" PRIx32, bits);
    CHECK(s.left_ticks == cfg.age_ticks - 1, "%" PRIu32 " left", s.left_ticks);
    start(); /* and what was written goes on as if it had not been */
    tell(floor_plane);
    at(MM(116));
    round_trip();
    at(MM(114));
    CHECK((bits & EXH_PRECONTACT_FREEZE) && s.lim_m_q30 > in.pos_m_q30, "frozen");
    start();
    tell(floor_plane);
    at(MM(116));
    round_trip();
    at(MM(116));
    s.lim_m_q30 = INT32_MIN; /* no: of bytes, the first tick alone */
    at(MM(114));
    CHECK(bits & EXH_PRECONTACT_FREEZE, "frozen");
}

/* All planes through the origin have the offset 0: only the normal distinguishes them. */
TEST(a_plane_that_turned_over_is_another)
{
    struct exh_plane p = {EXH_PLANE_HIT, 0, 1, {0, 0, ONE}, {0, 0, 0}};
    start();
    tell(p);
    at(MM(16));
    at(MM(14));
    CHECK(s.phase == EXH_PRECONTACT_FROZEN, "d = -4 mm");
    tell(p);
    CHECK_EQ_I64(s.ignored_n, 0);
    p.normal_q30.z = -ONE;
    tell(p);
    CHECK_EQ_I64(s.ignored_n, 1);
}

/* |n|^2 = 1 + 2^-16, which is 1^2 + (2^-8)^2, is the last one that is a normal. */
TEST(the_longest_normal)
{
    struct exh_plane p = floor_plane;
    start();
    p.normal_q30 = (struct exh_vec3){0, ONE >> 8, ONE};
    CHECK_EQ_I64(exh_precontact_update(&s, &cfg, &p, 0), 0);
    p.normal_q30.x = 1;
    CHECK_EQ_I64(exh_precontact_update(&s, &cfg, &p, 0), -EXH_E_RANGE);
}

TEST_MAIN("unit/precontact", distance_has_the_sign_of_the_text, rounds_once_and_half_up,
    no_plane_means_no_contact, tracks_freezes_and_releases, the_boundary_is_d_lim_itself,
    a_touching_finger_is_not_released, a_contact_that_the_glove_denies_is_let_go,
    a_doubt_hangs_on_no_message, an_unknown_fingertip, missed_ticks_age_a_plane_and_a_doubt,
    what_comes_while_frozen_is_ignored_and_counted, what_came_while_frozen_is_new_at_the_release,
    born_inside_gives_no_contact_until_left, born_near_follows_to_the_touch,
    who_went_around_it_leaves_by_the_string, late_is_at_the_true_place_and_slow,
    from_bytes_nothing_is_late, never_is_who_rests_or_has_just_begun,
    another_object_has_to_be_left_first, the_same_object_may_come_to_the_finger,
    a_stale_plane_is_none, a_message_may_be_old_when_it_comes, a_frozen_plane_does_not_age,
    what_cannot_be_is_refused, material_is_taken_at_the_freeze, scale_and_slope, set_up_refuses,
    state_round_trip, damaged_state_comes_back_into_range,
    restored_tracking_touches_nothing_at_once, a_plane_that_turned_over_is_another,
    the_longest_normal);
