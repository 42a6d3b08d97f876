# SPDX-License-Identifier: MIT
"""The DLR/HIT Hand II as docs/NUMERICS.md and hand_hit2.c have it: bones, and the map of a glove's
sensors."""

from .hand import Finger

SIN_5, COS_5, SIN_10, COS_10, ONE = 93582766, 1069655912, 186453311, 1057429273, 1 << 30


def toward0(num, den):
    return abs(num) // den * (1 if num >= 0 else -1)


def nm(n):
    return toward0(n * (1 << 32) + (500000000 if n >= 0 else -500000000), 1000000000)


LENGTH = [toward0(mm << 34, 1000) for mm in (55, 25, 25)]
ROT = (((460690812, -613157138, -751481074), (200973197, 874240148, -590114771),
        (948838898, 112534406, 489859427)),
       ((0, -SIN_5, COS_5), (0, -COS_5, -SIN_5), (ONE, 0, 0)),
       ((0, 0, ONE), (0, -ONE, 0), (ONE, 0, 0)),
       ((0, SIN_5, COS_5), (0, -COS_5, SIN_5), (ONE, 0, 0)),
       ((0, SIN_10, COS_10), (0, -COS_10, SIN_10), (ONE, 0, 0)))
BASE_NM = ((62175930, 44372912, 78734808), (-2529881, 36800130, 107783545),
           (-3700000, 10000000, 117783545), (0, -16800130, 112583540),
           (971571, -43396300, 93583545))


def bones(f, arms):
    return Finger(LENGTH, ROT[f], [nm(n) for n in BASE_NM[f]], *arms)


def deg(num, den=1):
    return toward0(num << 32, 360 * den)


def gain(lo, hi, at, to):
    return toward0((hi - lo) << 24, to - at)


def bias(lo, hi, at, to):
    return deg(lo * (to - at) - (hi - lo) * at, to - at)


SIDE, KNUCKLE, MIDDLE = (deg(-15), deg(15)), (0, deg(85)), (0, deg(65))
QUARTER = 1 << 22


def knuckle(sensor):
    return bias(0, 85, -30, 110), (gain(0, 85, -30, 110), 0), (sensor, 0), *KNUCKLE


def curl(a, b, at, to):
    g = gain(0, 65, at, to)
    return bias(0, 65, at, to), (g, g), (a, b), *MIDDLE


def side(g, term):
    return 0, g, term, *SIDE


# Sensors. Thumb: rotation 0, its two joints 1 2, abduction 3. Index: 4 5 6. Middle: 7 8 9, from
# index 10. Ring: 11 12 13, from middle 14. Little: 15 16 17, from ring 18.
_g = gain(-15, 15, -60, 130)
_h = gain(0, 85, -85, 45)
MAP = (((-bias(-15, 15, -60, 130), (-_g, 0), (0, 0), *SIDE),
        (bias(0, 85, -85, 45), (_h, -_h), (1, 3), *KNUCKLE), curl(1, 2, -30, 120)),
       (side((-QUARTER, 0), (10, 0)), knuckle(4), curl(5, 6, -40, 225)),
       (side((0, 0), (0, 0)), knuckle(7), curl(8, 9, -40, 225)),
       (side((QUARTER, 0), (14, 0)), knuckle(11), curl(12, 13, -40, 225)),
       (side((QUARTER, QUARTER), (14, 18)), knuckle(15), curl(16, 17, -40, 275)))
# Sensors of the joints that the string bends.
BENT = ((1, 2, 2), (4, 5, 6), (7, 8, 9), (11, 12, 13), (15, 16, 17))


def sensors_of(f):
    """Mask of those that move it."""
    return sum({1 << t for j in MAP[f] for t, g in zip(j[2], j[1]) if g})
