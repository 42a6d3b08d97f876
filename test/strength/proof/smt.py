# SPDX-License-Identifier: MIT
"""Lemmas about single expressions of the tick, for every value of their arguments.

Bit vectors where wrapping and shifting are the point, integers where only size is. What is
written here is the expression, not the source: the sources are judged by eva/ and wp/.
"""
import sys

import z3

import smt_hand
import smt_passivity

MS = 60000


def holds(claim):
    s = z3.Solver()
    s.set("timeout", MS)
    s.add(z3.Not(claim))
    return s.check() == z3.unsat


def shr_is_floor():
    """>> of a negative 64-bit number is the floor, for every count 0..63."""
    v, n = z3.BitVecs("v n", 64)
    q = v >> n
    back = q << n
    return holds(z3.Implies(z3.ULT(n, 64),
                            z3.And(v - back >= 0, z3.ULT(v - back, z3.BitVecVal(1, 64) << n))))


def from_u64_keeps_bits():
    """exh_from_u64() by arithmetic alone gives the same 64 bits."""
    u = z3.BitVec("u", 64)
    top = z3.BitVecVal((1 << 63) - 1, 64)
    return holds(z3.If(z3.ULE(u, top), u, -(z3.BitVecVal(-1, 64) - u) - 1) == u)


def wrapped_sum_is_the_sum():
    """exh_wrap_add(), exh_wrap_add64() and exh_wrap_diff64() are exact wherever the result has as
    many bits."""
    return all(wrapped_of(bits) for bits in (32, 64))


def wrapped_of(bits):
    a, b = z3.BitVecs("a b", bits)
    wide = z3.SignExt(1, a) + z3.SignExt(1, b)
    less = z3.SignExt(1, a) - z3.SignExt(1, b)
    fits = z3.And(z3.BVAddNoOverflow(a, b, True), z3.BVAddNoUnderflow(a, b))
    less_fits = z3.And(z3.BVSubNoOverflow(a, b), z3.BVSubNoUnderflow(a, b, True))
    return holds(z3.Implies(fits, z3.SignExt(1, a + b) == wide)) and \
        holds(z3.Implies(less_fits, z3.SignExt(1, a - b) == less))


def gain_floor_is_no_more():
    """exh_gain_floor() of x >= 0 is within 0..x when the gain is below 1 (shift 31..62)."""
    x, m = z3.Ints("x m")
    box = z3.And(x >= 0, x < 1 << 31, m >= 0, m < 1 << 31)
    if not holds(z3.Implies(box, z3.And(x * m >= 0, x * m <= x * (1 << 31)))):
        return False
    p = z3.Int("p")  # the product
    return all(holds(z3.Implies(z3.And(x >= 0, p >= 0, p <= x * (1 << 31)),
                                z3.And(p / (1 << s) >= 0, p / (1 << s) <= x)))
               for s in range(31, 63))


def share_of_limit():
    """A share 0..2^30 of a force limit, shifted down by 30, is within 0..limit."""
    top, share, p = z3.Ints("top share p")
    box = z3.And(top >= 0, top < 1 << 31, share >= 0, share <= 1 << 30)
    return holds(z3.Implies(box, z3.And(top * share >= 0, top * share <= top * (1 << 30)))) and \
        holds(z3.Implies(z3.And(top >= 0, p >= 0, p <= top * (1 << 30)),
                         z3.And(p / (1 << 30) >= 0, p / (1 << 30) <= top)))


def whole_codes_are_no_more():
    """Whole D/A codes of a current 0..6.6 A are not negative and are no more than it."""
    cur, scale, p = z3.Ints("cur scale p")
    box = z3.And(cur >= 0, cur <= 442918502, scale >= 0, scale < 1 << 31)
    return holds(z3.Implies(box, cur * scale >= 0)) and \
        holds(z3.Implies(p >= 0, z3.And(p / (1 << 42) >= 0, p / (1 << 42) * (1 << 42) <= p)))


def gain_of(ticks):
    """What exh_gain_set(1 / ticks) leaves: 31 bits, rounded to nearest."""
    shift = 30
    while ((1 << shift + 1) + ticks) // (2 * ticks) < 1 << 30:
        shift += 1
    return ((1 << shift + 1) + ticks) // (2 * ticks), shift


def release_ends():
    """R steps of the release law take any force 0..100 N to zero, R = 3..360 (18 ms at 20 kHz)."""
    f = z3.Int("f")
    for ticks in range(3, 361):
        mant, shift = gain_of(ticks)
        fall = (f * mant) / (1 << shift) + 1
        if not holds(z3.Implies(z3.And(f >= 0, f <= 100 << 20), f - ticks * fall <= 0)):
            return False
    return True


def release_step_is_bounded():
    """A step of the release law is the force held by R, and 1 LSB more at most."""
    f = z3.Int("f")
    for ticks in range(3, 361):
        mant, shift = gain_of(ticks)
        fall = (f * mant) / (1 << shift) + 1
        if not holds(z3.Implies(z3.And(f >= 0, f <= 100 << 20), (fall - 1) * ticks <= f + ticks)):
            return False
    return True


def unit_has_components_of_one():
    """What is_unit() of precontact.c lets pass has no component beyond 2^30 + 2^13."""
    square, v = z3.Ints("square v")  # of all three; one of them
    one, tol = 1 << 60, 1 << 44
    passes = z3.And((square - (one - tol)) % (1 << 64) <= 2 * tol, square >= 0, square <= 3 << 62)
    bounded = holds(z3.Implies(passes, square <= one + tol))
    most = (1 << 30) + (1 << 13)
    return bounded and holds(z3.Implies(z3.And(v * v <= square, square <= one + tol),
                                        z3.And(v <= most, v >= -most)))


def toward_stays_between():
    """exh_params_slew_step() of any two values and any shift stays between them and arrives."""
    now, goal = z3.BitVecs("now goal", 32)

    def stays(shift):
        up = goal - now
        left = z3.If(goal < now, -up, up)
        rest = left & ((1 << shift) - 1)
        part = z3.LShR(left, shift) + z3.If(rest != 0, z3.BitVecVal(1, 32), z3.BitVecVal(0, 32))
        to = now + z3.If(goal < now, -part, part)
        return z3.And(z3.If(goal < now, z3.And(to >= goal, to < now),
                            z3.And(to <= goal, to >= now)),
                      z3.Implies(goal > now, to > now))

    return all(holds(stays(shift)) for shift in range(32))


def mean_is_within_32_bits():
    """The quotient in exh_mean_value(): n values of 32 bits, lifted by 2^31 each, over n."""
    total, n, quot, rem = z3.Ints("total n quot rem")
    lift = n * (1 << 31)
    sums = z3.And(n >= 1, n < 1 << 31, total >= -lift, total <= n * ((1 << 31) - 1))
    divides = z3.And(total + lift == quot * n + rem, rem >= 0, rem < n)
    return holds(z3.Implies(z3.And(sums, divides), z3.And(quot >= 0, quot <= 1 << 32)))


def excess_is_a_square_at_most():
    """In setup_i2t(): of 0 <= i_cont <= i_peak <= 6.6 A, q16, the squares' difference is within 0
    .. (6.6 A)^2."""
    peak, cont, more = z3.Ints("peak cont more")
    most = 432537
    box = z3.And(cont >= 0, more >= 0, peak == cont + more, peak <= most)
    at_least = holds(z3.Implies(z3.And(cont >= 0, more >= 0),
                                (cont + more) * (cont + more) - cont * cont >= 0))
    return at_least and holds(z3.Implies(box, peak * peak - cont * cont <= most * most))


def line_is_below_32():
    """exh_calib_fit() of points with force <= 2047 / 64 of current, raw: so is sum(c f) / sum(c^2),
    by induction."""
    f, c, fi, ii = z3.Reals("f c fi ii")
    most = z3.RealVal(2047) / 64
    return holds(z3.Implies(z3.And(c > 0, f <= most * c, fi <= most * ii),
                            fi + c * f <= most * (ii + c * c)))


def cycle_is_within_60_bits():
    """chatter.c: a cycle's sum: within 2^58 as bytes leave it, then what ticks that count add."""
    was, given, ticks, most = z3.Ints("was given ticks most")
    bound = (1 << 58) + ticks * (1 << 49)
    box = z3.And(ticks >= 0, ticks < most, most <= 1100, given <= 1 << 49, given >= -(1 << 49),
                 was <= bound, was >= -bound)
    now = was + given
    return holds(z3.Implies(box, z3.And(now <= bound + (1 << 49), now >= -bound - (1 << 49),
                                        now <= 1 << 60, now >= -(1 << 60))))


LEMMAS = [cycle_is_within_60_bits, shr_is_floor, from_u64_keeps_bits, wrapped_sum_is_the_sum,
          gain_floor_is_no_more, share_of_limit, whole_codes_are_no_more, release_ends,
          release_step_is_bounded,
          unit_has_components_of_one, toward_stays_between, mean_is_within_32_bits,
          excess_is_a_square_at_most, line_is_below_32] + smt_passivity.LEMMAS + smt_hand.LEMMAS

if __name__ == "__main__":
    sys.exit(0 if {f.__name__: f for f in LEMMAS}[sys.argv[1]]() else 1)
