/* SPDX-License-Identifier: MIT */
/* hand.h: the published test vectors of the hand, and the map by hand. */
#include "exhand/hand.h"

#include "exhand/angle.h"
#include "exhand/error.h"
#include "exhand/glove.h"
#include "exhand/units.h"

#include "check.h"

static struct exh_hand_par defaults(void)
{
    const struct exh_hand_par par = {
        exh_hand_rows[0].dflt, exh_hand_rows[1].dflt, exh_hand_rows[2].dflt, exh_hand_rows[3].dflt};
    return par;
}

static struct exh_hand_finger finger(unsigned i)
{
    const struct exh_hand_par par = defaults();
    struct exh_hand_finger f;
    CHECK_EQ_I64(exh_hand_setup(&f, &exh_hit2_bones[i], &par), 0);
    return f;
}

/* --- fingertips --- */

/* |got - want| <= 1 um; want in um. */
static int near_um(int32_t got_m_q30, int32_t want_um)
{
    const int64_t off = (int64_t)got_m_q30 * 1000000 - want_um * (INT64_C(1) << 30);
    return off <= INT64_C(1) << 30 && off >= -(INT64_C(1) << 30);
}

/* Joints in urad, q3 = q2; P_F in um: of the hand's published model, by another program. */
TEST(published_vectors)
{
    static const struct {
        unsigned finger;
        int32_t q0, q1, q2, x, y, z;
    } row[] = {
        {EXH_THUMB, 0, 0, 0, 107226, 64026, 171521},
        {EXH_THUMB, 200000, 0, 0, 94416, 80619, 171857},
        {EXH_THUMB, -150000, 700000, 500000, 28130, 1506, 157946},
        {EXH_INDEX, 0, 0, 0, -2530, 36800, 212784},
        {EXH_INDEX, 0, 0, 1000000, 41073, 32985, 165887},
        {EXH_INDEX, -150000, 700000, 500000, 81301, 36652, 155150},
        {EXH_MIDDLE, 0, 0, 0, -3700, 10000, 222784},
        {EXH_MIDDLE, 0, 1000000, 0, 84654, 10000, 174515},
        {EXH_MIDDLE, -150000, 700000, 500000, 79825, 17159, 165150},
        {EXH_MIDDLE, 261799, 1483530, 1134460, 49252, 19663, 81720},
        {EXH_RING, 0, 0, 0, 0, -16800, 217584},
        {EXH_RING, -150000, 700000, 500000, 82583, -2389, 159950},
        {EXH_LITTLE, 0, 0, 0, 972, -43396, 198584},
        {EXH_LITTLE, 261799, 1483530, 1134460, 51441, -24685, 57520},
    };
    for (size_t i = 0; i < LEN(row); i++) {
        const struct exh_hand_finger f = finger(row[i].finger);
        const int32_t q[3] = {EXH_URAD(row[i].q0), EXH_URAD(row[i].q1), EXH_URAD(row[i].q2)};
        struct exh_vec3 tip;
        exh_hand_tip(&f, q, &tip);
        CHECK(near_um(tip.x, row[i].x), "row %zu: x %" PRId32, i, tip.x);
        CHECK(near_um(tip.y, row[i].y), "row %zu: y %" PRId32, i, tip.y);
        CHECK(near_um(tip.z, row[i].z), "row %zu: z %" PRId32, i, tip.z);
    }
}

/* Rows and columns of each finger's turn: of length 1 and square to each other to 3 LSB. */
TEST(turns_are_turns)
{
    for (unsigned f = 0; f < EXH_FINGERS; f++) {
        for (unsigned i = 0; i < 18; i++) {
            const unsigned a = i / 3 % 3, b = i % 3, columns = i / 9;
            const int64_t one_q60 = a == b ? INT64_C(1) << 60 : 0;
            int64_t dot_q60 = -one_q60;
            for (unsigned k = 0; k < 3; k++) {
                const int32_t(*r)[3] = exh_hit2_bones[f].rot_q30;
                dot_q60 += (int64_t)(columns ? r[k][a] : r[a][k]) * (columns ? r[k][b] : r[b][k]);
            }
            CHECK(dot_q60 <= INT64_C(3) << 30 && dot_q60 >= -(INT64_C(3) << 30),
                "finger %u, %s %u and %u: %" PRId64, f, columns ? "columns" : "rows", a, b,
                dot_q60);
        }
    }
}

/* A finger of one plain bone and all axes of the palm: worked on paper. */
TEST(slope_on_paper)
{
    static const struct exh_hand_bones plain = {
        {EXH_Q(60, 1000, 34), EXH_Q(20, 1000, 34), EXH_Q(10, 1000, 34)},
        {{1 << 30, 0, 0}, {0, 1 << 30, 0}, {0, 0, 1 << 30}}, {0, 0, 0}};
    const struct exh_hand_par par = {EXH_Q(10, 1000, 30), 0, 0, 0};
    const int32_t straight[3] = {0, 0, 0};
    const int32_t aside[3] = {EXH_DEG(90, 1), EXH_DEG(90, 1), 0};
    struct exh_hand_finger f;
    struct exh_vec3 tip, slope;
    CHECK_EQ_I64(exh_hand_setup(&f, &plain, &par), 0);
    CHECK_EQ_I64(f.pull_radpm_q20[1], 0); /* all string turns q1, by 100 rad/m */
    CHECK(f.pull_radpm_q20[0] - (100 << 20) <= 2 && f.pull_radpm_q20[0] >= 100 << 20, "%" PRId32,
        f.pull_radpm_q20[0]);
    exh_hand_tip_slope(&f, straight, &tip, &slope); /* 90 mm at 100 rad/m, upwards */
    CHECK(slope.x == 0 && slope.y == 0, "%" PRId32 " %" PRId32, slope.x, slope.y);
    CHECK(slope.z - (9 << 24) <= 4 && (9 << 24) - slope.z <= 4, "%" PRId32, slope.z);
    exh_hand_tip_slope(&f, aside, &tip, &slope); /* in y-z, pointing up, moving to -y */
    CHECK(slope.x <= 1 && slope.x >= -1 && slope.z <= 1 && slope.z >= -1, "%" PRId32 " %" PRId32,
        slope.x, slope.z);
    CHECK(slope.y + (9 << 24) <= 4 && slope.y + (9 << 24) >= -4, "%" PRId32, slope.y);
}

/* --- set-up --- */

TEST(setup_refuses)
{
    static const struct exh_hand_par bad[] = {{0, 0, 0, 0}, {EXH_Q(39, 10000, 30), 0, 0, 0},
        {EXH_Q(51, 1000, 30), 0, 0, 0}, {EXH_Q(20, 1000, 30), -1, 0, 0},
        {EXH_Q(20, 1000, 30), 0, INT32_MAX, 0}, {EXH_Q(20, 1000, 30), 0, 0, -1},
        {EXH_Q(20, 1000, 30), 0, 0, EXH_Q(26, 1000, 30)}};
    const struct exh_hand_par good = defaults(), least = {0, EXH_Q(4, 1000, 30), 0, 0};
    struct exh_hand_finger f;
    for (size_t i = 0; i < LEN(bad); i++) {
        CHECK(exh_hand_setup(&f, &exh_hit2_bones[0], &bad[i]) == -EXH_E_RANGE, "row %zu", i);
    }
    CHECK_EQ_I64(exh_hand_setup(&f, &exh_hit2_bones[0], &good), 0);
    CHECK_EQ_I64(exh_hand_setup(&f, &exh_hit2_bones[0], &least), 0);
    for (unsigned i = 0; i < 12; i++) {
        struct exh_hand_bones b = exh_hit2_bones[EXH_THUMB];
        switch (i) {
        case 0: b.len_m_q34[1] = 0; break;
        case 1: b.len_m_q34[2] = -1; break;
        case 2: b.len_m_q34[0] = EXH_Q(71, 1000, 34); break; /* 121 mm in all */
        case 3: b.base_m_q32[1] = INT32_MIN; break;
        case 4: b.base_m_q32[2] = EXH_Q(126, 1000, 32); break;
        case 5: b.rot_q30[1][1] = -b.rot_q30[1][1]; break;
        case 6: /* a left hand's: mirrored */
            for (unsigned c = 0; c < 3; c++) { b.rot_q30[1][c] = -b.rot_q30[1][c]; }
            break;
        case 7: b.rot_q30[0][0] = (1 << 30) + 1; break; /* 2e-9 more than there is */
        case 9: /* too short; lying in the plane of the others */
            for (unsigned c = 0; c < 3; c++) { b.rot_q30[2][c] /= 2; }
            break;
        case 10:
            for (unsigned c = 0; c < 3; c++) {
                b.rot_q30[2][c] = b.rot_q30[2][c] / 2 + b.rot_q30[1][c] / 2;
            }
            break;
        case 8: b.rot_q30[0][0] = -(1 << 30) - 1; break;
        default: b.rot_q30[2][0] = INT32_MIN; break;
        }
        CHECK(exh_hand_setup(&f, &b, &good) == -EXH_E_RANGE, "bones %u", i);
    }
}

/* --- the map --- */

TEST(map_of_the_hand_is_sound)
{
    int32_t sensor[EXH_GLOVE_SENSORS] = {0};
    CHECK_EQ_I64(exh_hand_map_validate(&exh_hit2_map), 0);
    for (unsigned f = 0; f < EXH_FINGERS; f++) {
        int32_t q[3];
        CHECK(exh_hand_joints(&exh_hit2_map, f, sensor, q) == 0, "finger %u at rest", f);
    }
}

/* Bending a finger's sensor bends that finger and no other. */
TEST(a_finger_follows_its_own_sensors)
{
    static const struct {
        unsigned sensor, finger, joint;
        int sign;
    } row[] = {{EXH_GLOVE_THUMB_ROTATE, EXH_THUMB, 0, -1}, {EXH_GLOVE_THUMB_AB, EXH_THUMB, 1, -1},
        {EXH_GLOVE_THUMB_IJ, EXH_THUMB, 2, 1}, {EXH_GLOVE_INDEX_MPJ, EXH_INDEX, 1, 1},
        {EXH_GLOVE_INDEX_PIJ, EXH_INDEX, 2, 1}, {EXH_GLOVE_INDEX_DIJ, EXH_INDEX, 2, 1},
        {EXH_GLOVE_MIDDLE_INDEX_AB, EXH_INDEX, 0, -1}, {EXH_GLOVE_MIDDLE_MPJ, EXH_MIDDLE, 1, 1},
        {EXH_GLOVE_MIDDLE_PIJ, EXH_MIDDLE, 2, 1}, {EXH_GLOVE_MIDDLE_DIJ, EXH_MIDDLE, 2, 1},
        {EXH_GLOVE_RING_MPJ, EXH_RING, 1, 1}, {EXH_GLOVE_RING_PIJ, EXH_RING, 2, 1},
        {EXH_GLOVE_RING_DIJ, EXH_RING, 2, 1}, {EXH_GLOVE_LITTLE_MPJ, EXH_LITTLE, 1, 1},
        {EXH_GLOVE_LITTLE_PIJ, EXH_LITTLE, 2, 1}, {EXH_GLOVE_LITTLE_DIJ, EXH_LITTLE, 2, 1},
        {EXH_GLOVE_LITTLE_RING_AB, EXH_LITTLE, 0, 1}};
    for (size_t i = 0; i < LEN(row); i++) {
        for (unsigned f = 0; f < EXH_FINGERS; f++) {
            int32_t sensor[EXH_GLOVE_SENSORS] = {0}, rest[3], bent[3];
            (void)exh_hand_joints(&exh_hit2_map, f, sensor, rest);
            sensor[row[i].sensor] = EXH_DEG(20, 1);
            CHECK(exh_hand_joints(&exh_hit2_map, f, sensor, bent) == 0, "row %zu", i);
            for (unsigned j = 0; j < 3; j++) {
                const int moved = (bent[j] > rest[j]) - (bent[j] < rest[j]);
                CHECK(moved == (f == row[i].finger && j == row[i].joint ? row[i].sign : 0),
                    "row %zu, finger %u, joint %u: %d", i, f, j, moved);
            }
        }
    }
}

/* Ends of the spans as documented, and what lies beyond them. */
TEST(spans_end_at_the_limits)
{
    static const struct {
        unsigned sensor, finger, joint;
        int32_t from_deg, lo_deg, to_deg, hi_deg;
    } row[] = {{EXH_GLOVE_THUMB_ROTATE, EXH_THUMB, 0, -60, 15, 130, -15},
        {EXH_GLOVE_MIDDLE_INDEX_AB, EXH_INDEX, 0, -60, 15, 60, -15},
        {EXH_GLOVE_RING_MIDDLE_AB, EXH_RING, 0, -60, -15, 60, 15},
        {EXH_GLOVE_INDEX_MPJ, EXH_INDEX, 1, -30, 0, 110, 85},
        {EXH_GLOVE_MIDDLE_MPJ, EXH_MIDDLE, 1, -30, 0, 110, 85},
        {EXH_GLOVE_RING_MPJ, EXH_RING, 1, -30, 0, 110, 85},
        {EXH_GLOVE_LITTLE_MPJ, EXH_LITTLE, 1, -30, 0, 110, 85}};
    for (size_t i = 0; i < LEN(row); i++) {
        for (int end = 0; end < 2; end++) {
            const int32_t at = end ? row[i].to_deg : row[i].from_deg;
            const int32_t want = EXH_DEG(end ? row[i].hi_deg : row[i].lo_deg, 1);
            const int32_t sign = end ? 1 : -1;
            int32_t sensor[EXH_GLOVE_SENSORS] = {0}, q[3];
            sensor[row[i].sensor] = EXH_DEG(at - sign, 1);
            CHECK(exh_hand_joints(&exh_hit2_map, row[i].finger, sensor, q) == 0, "row %zu", i);
            sensor[row[i].sensor] = EXH_DEG(at + sign, 1);
            CHECK(exh_hand_joints(&exh_hit2_map, row[i].finger, sensor, q) == 1u << row[i].joint,
                "row %zu", i);
            CHECK(q[row[i].joint] == want, "row %zu: %" PRId32, i, q[row[i].joint]);
        }
    }
}

TEST(map_check_refuses)
{
    for (unsigned i = 0; i < 5; i++) {
        struct exh_hand_map m = exh_hit2_map;
        struct exh_hand_joint *j = &m.joint[EXH_LITTLE][2];
        switch (i) {
        case 0: j->sensor[1] = EXH_GLOVE_SENSORS; break;
        case 1: j->gain_q24[0] = EXH_HAND_GAIN_MAX_Q24 + 1; break;
        case 2: j->gain_q24[0] = INT32_MIN; break;
        case 3: m.bent[EXH_LITTLE][2] = EXH_GLOVE_SENSORS; break;
        default: j->lo_turn_q32 = j->hi_turn_q32 + 1; break;
        }
        CHECK(exh_hand_map_validate(&m) == -EXH_E_RANGE, "map %u", i);
    }
}

/* Robot joints and tip of a finger of which so much string is out, as the wearer's joints share it.
 */
static void pulled(const struct exh_hand_finger *own, const struct exh_hand_finger *f, unsigned i,
    int64_t out_um, int32_t *q, struct exh_vec3 *tip)
{
    const uint8_t *bent = exh_hit2_map.bent[i];
    int32_t sensor[EXH_GLOVE_SENSORS] = {0};
    for (unsigned k = 0; k < 3; k++) { /* 683.565 LSB are 1 urad */
        sensor[bent[k]] =
            (int32_t)((own->pull_radpm_q20[k > 0] * out_um >> 10) * 683565 / 1000 >> 10);
    }
    CHECK(exh_hand_joints(&exh_hit2_map, i, sensor, q) == 0, "at a limit");
    exh_hand_tip(f, q, tip);
}

static int32_t axis(const struct exh_vec3 *v, int c)
{
    return c == 0 ? v->x : c == 1 ? v->y : v->z;
}

/* The string bends the wearer, the map the robot: what the slope says is what the tip does. */
TEST(slope_is_that_of_the_string_through_the_map)
{
    for (unsigned i = 0; i < EXH_FINGERS; i++) {
        const struct exh_hand_finger own = finger(i);
        struct exh_hand_finger f = own;
        CHECK_EQ_I64(exh_hand_couple(&f, &exh_hit2_map, i), 0);
        for (int64_t out_um = 2000; out_um <= 30000; out_um += 4000) {
            struct exh_vec3 before, after, tip, slope;
            int32_t q[EXH_HAND_JOINTS];
            pulled(&own, &f, i, out_um - 500, q, &before);
            pulled(&own, &f, i, out_um + 500, q, &after);
            pulled(&own, &f, i, out_um, q, &tip);
            exh_hand_tip_slope(&f, q, &tip, &slope);
            for (int c = 0; c < 3; c++) { /* 1 mm of string: within 1 um, a thousandth */
                const int64_t went = (int64_t)axis(&after, c) - axis(&before, c);
                const int64_t said = (int64_t)axis(&slope, c) * (1 << 6) / 1000;
                CHECK(went - said <= 1100 && said - went <= 1100,
                    "finger %u, %d um, axis %d: %d LSB, slope says %d", i, (int)out_um, c,
                    (int)went, (int)said);
            }
        }
    }
}

TEST(follow_by_hand)
{
    struct exh_hand_map m = exh_hit2_map;
    const struct exh_hand_finger own = finger(EXH_THUMB);
    struct exh_hand_finger f = own;
    struct exh_hand_joint *j = m.joint[EXH_THUMB];
    const int32_t w1 = own.pull_radpm_q20[0], w2 = own.pull_radpm_q20[1];
    j[1].gain_q24[0] = 3 << 23;    /* 1.5 of the knuckle */
    j[1].gain_q24[1] = -(1 << 24); /* and abduction, which no string moves */
    j[2].gain_q24[0] = 1 << 24;
    j[2].gain_q24[1] = -(1 << 25);
    CHECK_EQ_I64(exh_hand_couple(&f, &m, EXH_THUMB), 0);
    CHECK_EQ_I64(f.pull_radpm_q20[0], (3 * (int64_t)w1 + 1) / 2);
    CHECK_EQ_I64(f.pull_radpm_q20[1], w1 - 2 * (int64_t)w2);
    for (int sign = -1; sign <= 1; sign += 2) { /* 24 rad/m, 8 times, and more */
        struct exh_hand_par par = defaults();
        par.arm1_m_q30 = 0;
        par.arm2_m_q30 = par.arm3_m_q30 = EXH_Q(4, 1000, 30);
        CHECK_EQ_I64(exh_hand_setup(&f, &exh_hit2_bones[0], &par), 0); /* 125 rad/m */
        j[2].gain_q24[0] = 0;
        j[2].gain_q24[1] = sign * (5 << 23);
        CHECK_EQ_I64(exh_hand_couple(&f, &m, EXH_THUMB), -EXH_E_RANGE);
        CHECK(f.pull_radpm_q20[0] == 0 && f.pull_radpm_q20[1] > 0, "as it was");
        j[2].gain_q24[1] = sign * (3 << 23);
        CHECK_EQ_I64(exh_hand_couple(&f, &m, EXH_THUMB), 0);
    }
}

/* Of the 48 ways to lay axes onto axes half are turns. */
TEST(mirror_images_are_no_turns)
{
    const struct exh_hand_par par = defaults();
    for (unsigned i = 0; i < 6 * 8; i++) {
        static const uint8_t to[6][3] = {
            {0, 1, 2}, {1, 2, 0}, {2, 0, 1}, {0, 2, 1}, {2, 1, 0}, {1, 0, 2}};
        const unsigned way = i / 8, negative = i % 8;
        const unsigned odd = (way >= 3) ^ (negative & 1) ^ (negative >> 1 & 1) ^ (negative >> 2);
        struct exh_hand_bones b = exh_hit2_bones[EXH_INDEX];
        struct exh_hand_finger f;
        for (unsigned r = 0; r < 9; r++) { b.rot_q30[r / 3][r % 3] = 0; }
        for (unsigned r = 0; r < 3; r++) {
            b.rot_q30[r][to[way][r]] = negative >> r & 1 ? -(INT32_C(1) << 30) : INT32_C(1) << 30;
        }
        CHECK(exh_hand_setup(&f, &b, &par) == (odd ? -EXH_E_RANGE : 0), "way %u, signs %u", way,
            negative);
    }
}

/* What the hand's description leaves open is 0, so that two of them can be compared. */
TEST(what_a_hand_does_not_use_is_zero)
{
    for (unsigned f = 0; f < EXH_FINGERS; f++) {
        for (unsigned q = 0; q < EXH_HAND_JOINTS; q++) {
            const struct exh_hand_joint *j = &exh_hit2_map.joint[f][q];
            for (unsigned t = 0; t < EXH_HAND_TERMS; t++) {
                CHECK(j->gain_q24[t] != 0 || j->sensor[t] == 0, "finger %u, joint %u", f, q);
            }
        }
    }
    for (unsigned f = EXH_INDEX; f < EXH_FINGERS;
         f++) { /* fingers bend about an axis of the palm */
        const int32_t(*r)[3] = exh_hit2_bones[f].rot_q30;
        CHECK(r[0][0] == 0 && r[1][0] == 0 && r[2][0] == 1 << 30 && r[2][1] == 0 && r[2][2] == 0,
            "finger %u", f);
        CHECK(
            r[0][1] == r[1][2] && r[0][2] == -r[1][1], "finger %u: an angle and its complement", f);
    }
}

/* The last value that is allowed, and the first that is not. */
TEST(ends_to_the_bit)
{
    const struct exh_hand_par par = defaults();
    struct exh_hand_map m = exh_hit2_map;
    struct exh_hand_joint *j = &m.joint[EXH_THUMB][1];
    for (int32_t more = 0; more < 2; more++) {
        struct exh_hand_bones b = exh_hit2_bones[EXH_INDEX];
        struct exh_hand_finger f;
        for (unsigned r = 0; r < 9; r++) { b.rot_q30[r / 3][r % 3] = r % 4 == 0 ? 1 << 30 : 0; }
        b.len_m_q34[0] = EXH_Q(120, 1000, 34) - b.len_m_q34[1] - b.len_m_q34[2] + more;
        CHECK_EQ_I64(exh_hand_setup(&f, &b, &par), more ? -EXH_E_RANGE : 0);
        b.len_m_q34[0] -= more;
        b.rot_q30[2][2] -= 512 + more; /* 2^-20 of its square, a little less, and more */
        CHECK_EQ_I64(exh_hand_setup(&f, &b, &par), more ? -EXH_E_RANGE : 0);
        for (int sign = -1; sign <= 1; sign += 2) {
            m = exh_hit2_map;
            j->gain_q24[0] = sign * (EXH_HAND_GAIN_MAX_Q24 + more);
            CHECK_EQ_I64(exh_hand_map_validate(&m), more ? -EXH_E_RANGE : 0);
            f = finger(EXH_THUMB);
            f.pull_radpm_q20[0] = EXH_Q(250, 1, 20) + more;
            for (unsigned t = 0; t < EXH_HAND_TERMS; t++) { j->gain_q24[t] = 0; }
            j->gain_q24[0] = sign * (1 << 24);
            j->sensor[0] = m.bent[EXH_THUMB][0];
            CHECK_EQ_I64(exh_hand_couple(&f, &m, EXH_THUMB), more ? -EXH_E_RANGE : 0);
            CHECK(more || f.pull_radpm_q20[0] == sign * EXH_Q(250, 1, 20), "sign %d", sign);
        }
    }
}

TEST_MAIN("unit/hand", published_vectors, turns_are_turns, slope_on_paper, setup_refuses,
    map_of_the_hand_is_sound, a_finger_follows_its_own_sensors, spans_end_at_the_limits,
    map_check_refuses, slope_is_that_of_the_string_through_the_map, follow_by_hand,
    mirror_images_are_no_turns, what_a_hand_does_not_use_is_zero, ends_to_the_bit);
