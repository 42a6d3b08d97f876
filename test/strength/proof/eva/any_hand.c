/* SPDX-License-Identifier: MIT */
/* PROVES: hand: map and joints
 * Any map is checked. With each accepted map: any sensors for the joints of each finger, and any
 * pulls of coupled joints. The check accepts the map of the DLR/HIT II.
 *
 * EVA: -eva-slevel 40
 * PLANT: lib/src/sense/hand.c: map->bent[f][j] >= EXH_GLOVE_SENSORS -> map->bent[f + 1][j] >= EXH_GLOVE_SENSORS
 * PLANT: lib/src/sense/hand.c: (int64_t)j->gain_q24[t] * sensor_turn_q32[j->sensor[t]] -> j->gain_q24[t] * sensor_turn_q32[j->sensor[t]]
 * PLANT: lib/src/sense/hand.c: exh_from_u32((uint32_t)((uint64_t)sum_q56 -> ((int32_t)((uint64_t)sum_q56
 * PLANT: lib/src/sense/hand.c: if (sum_q44 > PULL_MAX_RADPM_Q20 || sum_q44 < -PULL_MAX_RADPM_Q20) -> if (sum_q44 > PULL_MAX_RADPM_Q20)
 * PLANT: lib/src/sense/hand_hit2.c: #define SPREAD_GAIN EXH_Q(1, 4, 24) -> #define SPREAD_GAIN EXH_Q(9, 1, 24)
 */
#include "num/fix.c"
#include "sense/hand.c"
#include "sense/hand_hit2.c"

#include "any.h"

static struct exh_hand_map map;

static void checked(void)
{
    int ok = exh_hand_map_validate(&exh_hit2_map);
    /*@ assert hit2_passes: ok == 0; */
    ANY(map);
    ok = exh_hand_map_validate(&map);
    (void)ok;
}

/* As the check lets it. */
static void any_map(void)
{
    ANY(map);
    for (unsigned f = 0; f < EXH_FINGERS; f++) {
        for (unsigned i = 0; i < EXH_HAND_JOINTS; i++) {
            struct exh_hand_joint *j = &map.joint[f][i];
            for (unsigned t = 0; t < EXH_HAND_TERMS; t++) {
                j->gain_q24[t] = Frama_C_interval(-EXH_HAND_GAIN_MAX_Q24, EXH_HAND_GAIN_MAX_Q24);
                j->sensor[t] = (uint8_t)Frama_C_unsigned_int_interval(0, EXH_GLOVE_SENSORS - 1);
            }
            map.bent[f][i] = (uint8_t)Frama_C_unsigned_int_interval(0, EXH_GLOVE_SENSORS - 1);
        }
    }
}

static void finger(const struct exh_hand_map *of, unsigned at)
{
    static int32_t sensor_turn_q32[EXH_GLOVE_SENSORS], joint_turn_q32[EXH_HAND_JOINTS];
    static struct exh_hand_finger f;
    uint32_t limited;
    for (unsigned i = 0; i < EXH_GLOVE_SENSORS; i++) { sensor_turn_q32[i] = any32(); }
    limited = exh_hand_joints(of, at, sensor_turn_q32, joint_turn_q32);
    /*@ assert three: limited <= 7; */
    f.pull_radpm_q20[0] = Frama_C_interval(-PULL_MAX_RADPM_Q20, PULL_MAX_RADPM_Q20);
    f.pull_radpm_q20[1] = Frama_C_interval(-PULL_MAX_RADPM_Q20, PULL_MAX_RADPM_Q20);
    (void)exh_hand_couple(&f, of, at);
    /*@ assert pulls: -262144000 <= f.pull_radpm_q20[0] <= 262144000 && -262144000 <= f.pull_radpm_q20[1] <= 262144000; */
}

int main(void)
{
    checked();
    any_map();
    for (unsigned at = 0; at < EXH_FINGERS; at++) {
        finger(&map, at);
        finger(&exh_hit2_map, at);
    }
    END();
    return 0;
}
