/* SPDX-License-Identifier: MIT */
/* The right DLR/HIT Hand II: its bones, and its map from the glove's sensors. */
#include "exhand/hand.h"

#include "exhand/angle.h"
#include "exhand/glove.h"
#include "exhand/units.h"

/* --- bones --- */

/* 55 and 25 mm, and 25 mm to the pad's centre, equal for five fingers. */
#define BONES \
    { \
        EXH_Q(55, 1000, 34), EXH_Q(25, 1000, 34), EXH_Q(25, 1000, 34) \
    }

#define ONE    (INT32_C(1) << 30)
#define SIN_5  93582766 /* q30 */
#define COS_5  1069655912
#define SIN_10 186453311
#define COS_10 1057429273

/* The q32 value nearest to a length in nm. */
#define NM(n) \
    ((int32_t)(((n) * (INT64_C(1) << 32) + ((n) < 0 ? -500000000 : 500000000)) / 1000000000))

/* Positions and rotations as published for the model of the hand (roll, pitch, yaw about fixed
 * axes). The four fingers are upright, spread by 5 degrees, the little one by 10. The thumb has
 * 0.225810, -1.083656, 0.411355 rad. Each constant is the nearest in its format. */
const struct exh_hand_bones exh_hit2_bones[EXH_FINGERS] = {
    [EXH_THUMB] = {BONES,
        {{460690812, -613157138, -751481074}, {200973197, 874240148, -590114771},
            {948838898, 112534406, 489859427}},
        {NM(62175930), NM(44372912), NM(78734808)}},
    [EXH_INDEX] = {BONES, {{0, -SIN_5, COS_5}, {0, -COS_5, -SIN_5}, {ONE, 0, 0}},
        {NM(-2529881), NM(36800130), NM(107783545)}},
    [EXH_MIDDLE] = {BONES, {{0, 0, ONE}, {0, -ONE, 0}, {ONE, 0, 0}},
        {NM(-3700000), NM(10000000), NM(117783545)}},
    [EXH_RING] = {BONES, {{0, SIN_5, COS_5}, {0, -COS_5, SIN_5}, {ONE, 0, 0}},
        {NM(0), NM(-16800130), NM(112583540)}},
    [EXH_LITTLE] = {BONES, {{0, SIN_10, COS_10}, {0, -COS_10, SIN_10}, {ONE, 0, 0}},
        {NM(971571), NM(-43396300), NM(93583545)}},
};

/* --- map --- */

/* Maps a sensor's span in degrees to a joint's. The joint is at its lower limit at `from`, at its
 * upper limit at `to`. The spans are rounded ranges of real hands in uncalibrated gloves, so that
 * few postures are clipped. As a consequence, a flat hand in a calibrated glove bends the robot's
 * knuckles by 18 degrees and its middle joints by 10. A map for the person avoids this. */
#define SPAN_GAIN(lo, hi, from, to) EXH_Q((hi) - (lo), (to) - (from), 24)
#define SPAN_BIAS(lo, hi, from, to) \
    EXH_DEG((lo) * ((to) - (from)) - ((hi) - (lo)) * (from), (to) - (from))

#define SIDE_LIMITS     EXH_DEG(-15, 1), EXH_DEG(15, 1)
#define PROXIMAL_LIMITS 0, EXH_DEG(85, 1)
#define MIDDLE_LIMITS   0, EXH_DEG(65, 1)

/* Abduction, reduced to a quarter: 60 degrees between two fingers (a sensor spans 45 to 50) become
 * 15. The robot's middle finger stays, since no sensor measures it. Index and ring turn relative to
 * it, and the little finger also by its distance from the ring finger. */
#define SPREAD_GAIN EXH_Q(1, 4, 24)

/* Flexion of the knuckle: from 30 degrees backwards to 110 forwards. */
#define KNUCKLE(mpj) \
    { \
        SPAN_BIAS(0, 85, -30, 110), {SPAN_GAIN(0, 85, -30, 110), 0}, {mpj, 0}, PROXIMAL_LIMITS \
    }

/* q2 and q3 are coupled in the robot, but two joints in the hand. The sum of the sensors maps to
 * the robot's sum, so each sensor bends q2 by half. */
#define CURL(pij, dij, from, to) \
    { \
        SPAN_BIAS(0, 65, from, to), {SPAN_GAIN(0, 65, from, to), SPAN_GAIN(0, 65, from, to)}, \
            {pij, dij}, MIDDLE_LIMITS \
    }

const struct exh_hand_map exh_hit2_map =
    {
        .joint =
            {
                [EXH_THUMB] =
                    {/* Rotation across the palm moves the robot's thumb against q0. */
                        {-SPAN_BIAS(-15, 15, -60, 130), {-SPAN_GAIN(-15, 15, -60, 130), 0},
                            {EXH_GLOVE_THUMB_ROTATE, 0}, SIDE_LIMITS},
                        /* The base bends when the thumb moves to the palm: by flexion, or by less
                         * abduction. */
                        {SPAN_BIAS(0, 85, -85, 45),
                            {SPAN_GAIN(0, 85, -85, 45), -SPAN_GAIN(0, 85, -85, 45)},
                            {EXH_GLOVE_THUMB_MPJ, EXH_GLOVE_THUMB_AB}, PROXIMAL_LIMITS},
                        CURL(EXH_GLOVE_THUMB_MPJ, EXH_GLOVE_THUMB_IJ, -30, 120)},
                [EXH_INDEX] = {{0, {-SPREAD_GAIN, 0}, {EXH_GLOVE_MIDDLE_INDEX_AB, 0}, SIDE_LIMITS},
                    KNUCKLE(EXH_GLOVE_INDEX_MPJ),
                    CURL(EXH_GLOVE_INDEX_PIJ, EXH_GLOVE_INDEX_DIJ, -40, 225)},
                [EXH_MIDDLE] = {{0, {0, 0}, {0, 0}, SIDE_LIMITS}, KNUCKLE(EXH_GLOVE_MIDDLE_MPJ),
                    CURL(EXH_GLOVE_MIDDLE_PIJ, EXH_GLOVE_MIDDLE_DIJ, -40, 225)},
                [EXH_RING] = {{0, {SPREAD_GAIN, 0}, {EXH_GLOVE_RING_MIDDLE_AB, 0}, SIDE_LIMITS},
                    KNUCKLE(EXH_GLOVE_RING_MPJ),
                    CURL(EXH_GLOVE_RING_PIJ, EXH_GLOVE_RING_DIJ, -40, 225)},
                /* In all recordings the sensors of the little finger have a larger span. */
                [EXH_LITTLE] =
                    {{0, {SPREAD_GAIN, SPREAD_GAIN},
                         {EXH_GLOVE_RING_MIDDLE_AB, EXH_GLOVE_LITTLE_RING_AB}, SIDE_LIMITS},
                        KNUCKLE(EXH_GLOVE_LITTLE_MPJ),
                        CURL(EXH_GLOVE_LITTLE_PIJ, EXH_GLOVE_LITTLE_DIJ, -40, 275)},
            },
        .bent = {{EXH_GLOVE_THUMB_MPJ, EXH_GLOVE_THUMB_IJ, EXH_GLOVE_THUMB_IJ},
            {EXH_GLOVE_INDEX_MPJ, EXH_GLOVE_INDEX_PIJ, EXH_GLOVE_INDEX_DIJ},
            {EXH_GLOVE_MIDDLE_MPJ, EXH_GLOVE_MIDDLE_PIJ, EXH_GLOVE_MIDDLE_DIJ},
            {EXH_GLOVE_RING_MPJ, EXH_GLOVE_RING_PIJ, EXH_GLOVE_RING_DIJ},
            {EXH_GLOVE_LITTLE_MPJ, EXH_GLOVE_LITTLE_PIJ, EXH_GLOVE_LITTLE_DIJ}},
};
