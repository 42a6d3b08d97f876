# SPDX-License-Identifier: MIT
"""The lemmas of docs/NUMERICS.md on passivity, for all integers.

Work of a tick is one variable, u = held * way, so that all is linear. P * way is B, and a movement
of at least -way takes at most u from e. By induction over ticks: what holds of a state holds of the
next.
"""
import z3

MS = 60000


def holds(claim):
    s = z3.Solver()
    s.set("timeout", MS)
    s.add(z3.Not(claim))
    return s.check() == z3.unsat


def least(a, b):
    return z3.If(a < b, a, b)


def most(a, b):
    return z3.If(a > b, a, b)


def may_hold(e, u, b):
    """Lemma 1: what is held after a tick that ended with e."""
    return z3.And(u >= 0, u <= most(0, b + least(0, e)))


def in_time_owes_no_more_than_a_tick():
    """Lemma 2, and that it is attained."""
    e, u, d, b = z3.Ints("e u d b")
    step = z3.And(b >= 0, e >= -b, may_hold(e, u, b), d >= -u)
    return holds(z3.Implies(step, e + d >= -b)) and not holds(z3.Implies(step, e + d > -b))


def late_owes_no_more_than_two():
    """Lemma 3: e, the work of the forces held before and before that. Also after a reset of e to 0
    or to less."""
    e, u, v, w, d, b = z3.Ints("e u v w d b")  # u: held before, v: before that, w: from now on

    def state(e, u, v):
        return z3.And(may_hold(e, u, b), v >= 0, v <= b, e >= -2 * b, e - most(u, v) >= -2 * b)
    now = e + d
    kept = z3.Implies(z3.And(b >= 0, state(e, u, v), d >= -most(u, v), may_hold(now, w, b)),
                      state(now, w, u))
    forgot = z3.Implies(z3.And(b >= 0, state(e, 0, v), d >= -v, now > 0, may_hold(0, w, b)),
                        state(z3.IntVal(0), w, 0))
    bound = z3.Implies(z3.And(b >= 0, state(e, u, v)), e >= -2 * b)
    return holds(kept) and holds(forgot) and holds(bound)


def late_counts_the_worse():
    """Of any part a of the way with the older force and the rest with the newer, moved without a
    turn, e takes no more."""
    h, g, a, c = z3.Ints("h g a c")
    out = z3.Implies(z3.And(h >= 0, g >= 0, a >= 0, c >= 0), h * a + g * c >= least(h, g) * (a + c))
    back = z3.Implies(z3.And(h >= 0, g >= 0, a <= 0, c <= 0), h * a + g * c >= most(h, g) * (a + c))
    return holds(out) and holds(back)


def in_time_keeps_its_bound_beside_late():
    """With on = 2 the energy of outputs in time is never below e, and so keeps the bound of one
    tick."""
    e, x, u, d, b = z3.Ints("e x u d b")
    return holds(z3.Implies(z3.And(b >= 0, x >= e, x >= -b, may_hold(e, u, b), d >= -u),
                            x + d >= -b))


def missed_ticks_count():
    """Lemma 4 for 0..16 consecutive missed ticks."""
    e, u, d, b = z3.Ints("e u d b")
    return all(
        holds(z3.Implies(z3.And(b >= 0, e >= -(m + 1) * b, may_hold(e, u, b), d >= -(m + 1) * u),
                         e + d >= -(m + 1) * b)) for m in range(17))


def gain_of(num, den):
    """What exh_gain_set() leaves: 31 bits, rounded to nearest."""
    s = max(0, den.bit_length() - num.bit_length() + 29)
    while (num << (s + 1)) // den < 1 << 31:
        s += 1
    mant = ((num << s + 1) + den) // (2 * den)
    return (mant, s) if mant < 1 << 31 else (mant >> 1, s - 1)


def less_is_never_too_little():
    """For every debt up to what may be owed at 100 N, `less` is owed / way and less than 3 LSB
    more: some 300 ways."""
    o = z3.Int("o")
    top = 100 << 20
    ways = (set(range(1, 257)) | {(1 << k) + d for k in range(8, 25) for d in (-1, 0, 1)} |
            {10 ** k for k in range(8)})
    ways |= {3 ** k for k in range(15)} | {7 * 11 ** k for k in range(7)}
    for way in sorted(w for w in ways if w <= 1 << 24):
        sh = 0
        while top * way >> sh >= (1 << 31) - 1:
            sh += 1
        mant, s = gain_of(1 << sh, way)
        less = ((o / (1 << sh) + 1) * mant + (1 << s >> 1)) / (1 << s) + 1
        if not holds(z3.Implies(z3.And(o > 0, o <= top * way),
                                z3.And(less * way >= o, (less - 3) * way < o))):
            return False
    return True


LEMMAS = [in_time_owes_no_more_than_a_tick, late_owes_no_more_than_two, late_counts_the_worse,
          in_time_keeps_its_bound_beside_late, missed_ticks_count, less_is_never_too_little]

if __name__ == "__main__":
    FAILED = 0
    for lemma in LEMMAS:
        ok = lemma()
        FAILED += not ok
        print("%-6s %s" % ("proved" if ok else "FAILED", lemma.__name__))
    raise SystemExit(FAILED != 0)
