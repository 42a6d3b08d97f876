# SPDX-License-Identifier: MIT
"""Lemmas about the fingertip of hand.c: why its sums of products fit 32 bits.

They do because sine and cosine have length 1 within 2^-27 (every/sincos.c, of every angle), and
rows of a rotation 1 within 2^-21 (hand.c checks them). What turns and sums do to lengths is shown
by z3; the rest is a chain of bounds in exact fractions, each link one of these. A floor takes less
than 1.
"""
from fractions import Fraction as F

import z3

MS = 60000
UNIT = 1 + F(1, 1 << 27)  # the longest (sin, cos)
ROW = 1 + F(1, 1 << 21)  # the longest row of a rotation
LEN = (120 * (1 << 34) + 500) // 1000  # LEN_MAX_M_Q34, of all three bones
ARM_MIN = ((4 << 30) + 500) // 1000  # ARM_MIN_M_Q30
PULL = (250 << 20) + 32  # PULL_MAX_RADPM_Q20, and what the least arm's own rounding adds
FITS = LEN + 128  # what hand_tip.acsl has


def holds(claim):
    s = z3.Solver()
    s.set("timeout", MS)
    s.add(z3.Not(claim))
    return s.check() == z3.unsat


def turn_multiplies_lengths():
    """(x, y) turned by (c, s) has the product of both lengths."""
    x, y, c, s = z3.Reals("x y c s")
    out, up = x * c - y * s, x * s + y * c
    return holds(out * out + up * up == (x * x + y * y) * (c * c + s * s))


def sum_is_no_longer_than_both():
    """A vector of length r and one of length t along x make one of r + t at most."""
    x, y, r, t = z3.Reals("x y r t")
    return holds(z3.Implies(z3.And(r >= 0, t >= 0, x <= r, x * x + y * y <= r * r),
                            (x + t) * (x + t) + y * y <= (r + t) * (r + t)))


def row_multiplies_lengths():
    """A row times a vector is no more than the product of both lengths."""
    a, b, c, x, y, z = z3.Reals("a b c x y z")
    dot = a * x + b * y + c * z
    square = (a * a + b * b + c * c) * (x * x + y * y + z * z)
    rest = (a * y - b * x) ** 2 + (a * z - c * x) ** 2 + (b * z - c * y) ** 2
    return holds(square - dot * dot == rest)


def double_angle_by_cosine_alone():
    """l (2 c^2 - 1) is the double angle's l (c^2 - s^2), and l (c^2 + s^2 - 1) more."""
    length, c, s = z3.Reals("l c s")
    return holds(length * (2 * c * c - 1) == length * (c * c - s * s) + length *
                 (c * c + s * s - 1))


def chain(first, floors):
    """Of |first + l1 e + l2 e^2|, e = (cos q2, sin q2), first + l1 + l2 <= LEN, with floors in both
    components."""
    return first + UNIT * UNIT * (LEN - first) + (LEN - first) * (UNIT * UNIT - 1) + 2 * floors


def fingertip_fits_32_bits():
    """Every int_fast32_t on the way to the tip is within FITS or a sum of these that fits, and the
    tip's place is."""
    fold = LEN + 2  # l1 / 2 + l2 cos q2, two floors
    tip = max(chain(first, 5) for first in (0, LEN))  # twice two floors, and one
    turned = UNIT * tip + 1
    place = (1 << 29) + 3 * ((FITS << 30 >> 32) + 1) + 3  # base + three parts: by size alone
    return (fold <= FITS and tip <= FITS and UNIT * turned + 1 <= FITS and place < 1 << 31 and
            FITS < 1 << 31)


def slope_fits_32_bits():
    """The same on the way to the slope; sums in q54 are within 64 bits."""
    k = LEN + 3  # l1 / 4 + l2 cos q2, three floors
    tip = max(chain(first, 5) for first in (0, LEN))
    bend = chain(0, 7)  # |l1 / 2 e + l2 e^2|
    by_string = 2 * PULL * bend + PULL * tip
    v = by_string / (1 << 30) + 2  # rounded, both components
    turned = UNIT * UNIT * v + 4
    dot = ROW * (1 << 30) * turned
    return (k <= FITS and bend <= FITS and by_string < 1 << 63 and turned <= FITS and
            dot <= (1 << 61) - (1 << 31))


def pull_is_within_its_bound():
    """arm / (arm1^2 + arm2^2) of arms that set-up takes: arm is the root of the square at most, so
    it is 1 / root."""
    arm, other, root, least = z3.Reals("arm other root least")
    square = arm * arm + other * other
    shorter = holds(z3.Implies(z3.And(root >= 0, root * root == square, arm >= 0), arm <= root))
    # root / den falls as root rises: den = floor(root^2 / 2^14) > root^2 / 2^14 - 1
    falls = holds(z3.Implies(z3.And(least >= ARM_MIN, root >= least),
                             root * (least * least - (1 << 14)) <= least *
                             (root * root - (1 << 14))))
    most = F((ARM_MIN << 36) * (1 << 14), ARM_MIN * ARM_MIN - (1 << 14)) + F(1, 2)
    return shorter and falls and most <= PULL


LEMMAS = [pull_is_within_its_bound, turn_multiplies_lengths, sum_is_no_longer_than_both,
          row_multiplies_lengths, double_angle_by_cosine_alone, fingertip_fits_32_bits,
          slope_fits_32_bits]
