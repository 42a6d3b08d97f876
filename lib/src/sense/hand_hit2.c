/* SPDX-License-Identifier: MIT */
/* The DLR/HIT Hand II, right: its bones, and how the glove's sensors move it (glove.h
 * lends their names, no more). */
#include "exhand/hand.h"

#include "exhand/angle.h"
#include "exhand/glove.h"
#include "exhand/units.h"

/* --- bones --- */

/* 55 and 25 mm, and 25 mm to the middle of the pad: five fingers alike. */
#define BONES \
    { \
        EXH_Q(55, 1000, 34), EXH_Q(25, 1000, 34), EXH_Q(25, 1000, 34) \
    }

#define ONE    (INT32_C(1) << 30)
#define SIN_5  93582766 /* q30 */
#define COS_5  1069655912
#define SIN_10 186453311
#define COS_10 1057429273

/* Nearest q32 of a length in nm. */
#define NM(n) \
    ((int32_t)(((n) * (INT64_C(1) << 32) + ((n) < 0 ? -500000000 : 500000000)) / 1000000000))

/* Places and turns as published for the hand's model (roll, pitch, yaw about fixed axes). The four
 * fingers stand upright, spread by 5 degrees and 10 (little); the thumb's are 0.225810, -1.083656,
 * 0.411355 rad. Each constant is the nearest of its format. */
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

/* A sensor's span, in degrees, laid over a joint's: the joint is at its lower limit at `from` and
 * at its upper limit at `to`. The spans are a hand's: what joints of real hands in gloves that
 * nobody calibrated reach, in round numbers, so that few postures are cut off. The price is
 * that a flat hand in a calibrated glove bends the robot's knuckles by 18 degrees and its
 * middle joints by 10; a map of the person's own need not. */
#define SPAN_GAIN(lo, hi, from, to) EXH_Q((hi) - (lo), (to) - (from), 24)
#define SPAN_BIAS(lo, hi, from, to) \
    EXH_DEG((lo) * ((to) - (from)) - ((hi) - (lo)) * (from), (to) - (from))

#define SIDE_LIMITS     EXH_DEG(-15, 1), EXH_DEG(15, 1)
#define PROXIMAL_LIMITS 0, EXH_DEG(85, 1)
#define MIDDLE_LIMITS   0, EXH_DEG(65, 1)

/* Spreading: a quarter of it, so that 60 degrees between two fingers (a sensor's span is 45 to 50)
 * are the robot's 15. The robot's middle finger stands still, as no sensor tells where it
 * is; index and ring are turned from it, and little by its distance from ring more. */
#define SPREAD_GAIN EXH_Q(1, 4, 24)

/* Bending at the knuckle: from 30 degrees backwards to 110 forwards. */
#define KNUCKLE(mpj) \
    { \
        SPAN_BIAS(0, 85, -30, 110), {SPAN_GAIN(0, 85, -30, 110), 0}, {mpj, 0}, PROXIMAL_LIMITS \
    }

/* q2 and q3 are one in the robot and two in the hand: their sum is laid over the robot's sum, so
 * each sensor bends q2 by half. */
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
                    {/* Turning across the palm moves the robot's thumb against q0. */
                        {-SPAN_BIAS(-15, 15, -60, 130), {-SPAN_GAIN(-15, 15, -60, 130), 0},
                            {EXH_GLOVE_THUMB_ROTATE, 0}, SIDE_LIMITS},
                        /* The base bends as the thumb comes to the palm: by its own joint, or less
                           abduction. */
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
                /* The little finger's sensors reach farther in all recordings. */
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
