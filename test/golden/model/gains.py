# SPDX-License-Identifier: MIT
"""gains: rules set up and refused, pairs asked, values staged under a rule and moved under it."""

from fractions import Fraction

from .num import AGAIN, MAX32, MIN32, MONOTONE, RANGE, TICKS, UNKNOWN, Rng, period

RATE, GAINS = 8, 13
K_MAX, B_MAX, K, B = 1024000000, 1048576000, 0x0401, 0x0402

# id, largest value, default of the contact's rows; the smallest is 0.
CONTACT = ((0x0401, K_MAX, 1536000), (0x0402, B_MAX, 0), (0x0403, 20971520, 112197),
           (0x0404, 10737418, 214748), (0x0405, 10737418, 0))


def toward(now, goal, shift):
    part = -(-abs(goal - now) // (1 << shift))
    return now + part if goal > now else now - part


class Rule:
    def __init__(self, rng, T):
        b = rng.draw(0, 1 << 24)
        line = rng.draw(0, 2) == 0
        self.rate = (256 * T[1] + T[0] // 2) // T[0]
        self.n = rng.draw(2, 8)
        self.least = rng.draw(0, 1) * rng.draw(0, 1 << 24)
        self.b, self.k = [], []
        for _ in range(8):
            self.b.append(b)
            k = rng.draw(0, K_MAX)
            self.k.append(b if line else k)
            b += rng.draw(1, 1 << 26)

    def spoil(self, how):
        if how == 1:
            self.n = 1
        elif how == 2:
            self.n = 9
        elif how == 3:
            self.rate = 255
        elif how == 4:
            self.least = -1
        elif how == 5:
            self.b[0] = -1
        elif how == 6:
            self.b[self.n - 1] = B_MAX + 1
        elif how == 7:
            self.k[1] = -1
        elif how == 8:
            self.b[1] = self.b[0]
        elif how in (9, 12, 13):
            self.rate += self.rate // 50
        elif how == 10:
            self.k[7] = K_MAX + 1
        elif how == 11:
            self.rate -= self.rate // 120
        elif how in (14, 15):
            self.least |= 1
            self.k[1] = self.least - 1

    def setup(self, T):
        if not (256 <= self.rate <= 20000 << 8 and 2 <= self.n <= 8 and 0 <= self.least <= K_MAX):
            return -RANGE
        for i in range(self.n):
            if not (0 <= self.b[i] <= B_MAX and 0 <= self.k[i] <= K_MAX):
                return -RANGE
            if i > 0 and self.b[i] <= self.b[i - 1]:
                return -MONOTONE
        above = "".join("x" if k >= self.least else " " for k in self.k[:self.n])
        if len(above.split()) > 1:
            return -RANGE
        return -RATE if abs(256 * T[1] - T[0] * self.rate) * 100 > T[0] * self.rate else 0

    def allows(self, k, b):
        return int((k, b) == (0, 0) or self.under(k, b))

    def under(self, k, b):
        return k >= self.least and any(
            b0 <= b <= b1 and (k - k0) * (b1 - b0) <= (k1 - k0) * (b - b0)
            for b0, b1, k0, k1 in zip(self.b, self.b[1:self.n], self.k, self.k[1:]))

    def aim(self, at, goal):
        """The goal's k if the straight line there is above no knot on its way, else the lowest of
        all."""
        (k, b), (gk, gb) = at, goal
        between = [(kn, bn) for kn, bn in zip(self.k[:self.n], self.b)
                   if min(b, gb) < bn < max(b, gb)]
        if all(k + Fraction(gk - k, gb - b) * (bn - b) <= kn for kn, bn in between):
            return gk
        return min([k] + [kn for kn, _ in between])

    def step(self, at, goal, shift):
        if not self.allows(*goal):
            return at if self.under(*at) else (0, 0)
        if shift == 0:
            return goal
        if not self.under(*goal):  # no wall, apart
            if self.under(*at) and at[0] > self.least:
                return toward(at[0], self.least, shift), at[1]
            return 0, 0
        if not self.under(*at):
            return (self.least, goal[1]) if at == (0, 0) else (0, 0)
        k, b = toward(at[0], self.aim(at, goal), shift), toward(at[1], goal[1], shift)
        if self.under(k, b):
            return k, b
        return (k, at[1]) if k < at[0] else (at[0], b)

    def pair(self, rng):
        how, i = rng.draw(0, 3), rng.draw(0, self.n - 2)
        b0, b1, k0, k1 = self.b[i], self.b[i + 1], self.k[i], self.k[i + 1]
        k = rng.draw(MIN32, MAX32) if how == 0 else rng.draw(0, K_MAX)
        b = rng.draw(MIN32, MAX32) if how == 0 else rng.draw(b0, b1)
        if how == 2:
            b = b0
        if how >= 2:
            k = (k0 + (k1 - k0) * (b - b0) // (b1 - b0) if k1 >= k0
                 else k1 + (k0 - k1) * (b1 - b) // (b1 - b0))
            k += rng.draw(-2, 2)
        return k, b


    def place(self, rng):
        """Inside: no wall, a knot, below it, or anything under a piece."""
        how, i = rng.draw(0, 7), rng.draw(0, self.n - 1)
        j = i - 1 if i > 0 else 1
        k = rng.draw(self.least, min(self.k[i], self.k[j]))
        b = rng.draw(min(self.b[i], self.b[j]), max(self.b[i], self.b[j]))
        if how == 0:
            return 0, 0
        if how < 5:
            return self.k[i], self.b[i]
        return (self.least, self.b[i]) if how == 5 else (k, b)


class Params:
    """Two instances of the contact's rows."""

    def __init__(self, rule):
        self.active = [{row[0]: row[2] for row in CONTACT} for _ in range(2)]
        self.active[0][K] = 0
        self.active[1][K], self.active[1][B] = rule.least, rule.b[0]
        self.locked = 0
        self.drop()

    def drop(self):
        self.staged, self.pending, self.moving = [dict(v) for v in self.active], 0, 0

    def stage(self, rule, ident, instance, raw):
        most = {row[0]: row[1] for row in CONTACT}
        if ident not in most or instance > 1:
            return -UNKNOWN
        if not 0 <= raw <= most[ident]:
            return -RANGE
        now = dict(self.staged[instance])
        now[ident] = raw
        if rule and ident in (K, B) and not rule.allows(now[K], now[B]):
            return -GAINS
        self.staged[instance], self.pending = now, 1
        return 0

    def apply(self, shift):
        """k and b do not change here while locked. The other values do."""
        done = self.pending | self.moving
        if done:
            for is_, wanted in zip(self.active, self.staged):
                for ident, _, _ in CONTACT:
                    if not self.locked:
                        is_[ident] = wanted[ident]
                    elif ident == 0x0403:
                        is_[ident] = toward(is_[ident], wanted[ident], shift)
                    elif ident > 0x0403 and self.pending:
                        is_[ident] = wanted[ident]
            self.pending, self.moving = 0, int(self.active != self.staged)
        return done

    def step(self, rule, shift):
        moves = self.moving
        for is_, wanted in zip(self.active, self.staged):
            was = is_[K], is_[B]
            goal = (wanted[K], wanted[B]) if moves else was
            is_[K], is_[B] = now = rule.step(was, goal, shift)
            self.moving |= int((moves or now != was) and now != (wanted[K], wanted[B]))


def walk(rng, T):
    """Some ticks of two ways under a rule of their own, to somewhere else after them."""
    rule = Rule(rng, T)
    if rng.draw(0, 1):
        rule.b[0] = 0
    rule.k = [max(k, rule.least) for k in rule.k]
    at = [rule.place(rng) for _ in range(2)]
    shift = rng.draw(0, 5)
    for _ in range(2):
        ticks = rng.draw(1, 4)
        goals = [rule.place(rng) for _ in range(2)]
        for _ in range(ticks):
            at = [rule.step(is_, goal, shift) for is_, goal in zip(at, goals)]
        for pair in at:
            yield from pair


def gains(rate):
    rng = Rng("gains", rate, 0)
    for tick in range(TICKS):
        err = 1
        if tick in (0, AGAIN) or tick % 8 == 0:
            T = period(rate, tick)
            new = Rule(rng, T)
            how = rng.draw(0, 15)
            if tick not in (0, AGAIN):
                new.spoil(how)
            else:
                new.k = [max(k, new.least) for k in new.k]
            err = new.setup(T)
            if err == 0 and (tick == AGAIN or tick % 16 == 0):
                rule, params = new, Params(new)
            shift = rng.draw(0, 4)
        params.locked = int(tick % 16 > 1)
        k, b = rule.pair(rng)
        inside = rule.allows(k, b)
        how, instance, knot = rng.draw(0, 15), rng.draw(0, 1), rng.draw(0, rule.n - 1)
        wish = (0, 0) if how < 3 else (rule.k[knot], rule.b[knot]) if how < 8 else (k, b)
        if how <= 9 and rule.allows(*wish):
            params.staged[instance][K], params.staged[instance][B] = wish
            params.pending = 1
        instance, ident = rng.draw(0, 8) // 4, 0x0401 + rng.draw(0, 5)
        how, raw = rng.draw(0, 3), rng.draw(MIN32, MAX32)
        if how > 0:
            raw = raw & 0xFFFFFF if how == 1 else k if ident == K else b
        past = rng.draw(0, 7) == 0
        put = params.stage(None if past else rule, ident, instance, raw)
        at = next((i for i, v in enumerate(params.staged) if not rule.allows(v[K], v[B])), 99)
        bad = -GAINS if at < 99 else 0
        if bad:
            params.drop()
        done = -1
        if rng.draw(0, 3):
            done = params.apply(shift)
            params.step(rule, shift)
        yield (err, k, b, inside, put, ident, instance, raw, bad, at, done, params.pending,
               params.moving,
               *(v for s, a in zip(params.staged, params.active) for v in (s[K], s[B], a[K], a[B])),
               *walk(rng, period(rate, tick))), b""


COLUMNS = ("setup k_Npm_q10 b_Nspm_q20 | inside stage id instance raw staged at apply pending "
           "moving k0 b0 k0_is b0_is k1 b1 k1_is b1_is " \
           "way0_k way0_b way1_k way1_b then0_k then0_b then1_k then1_b")

MODULES = {"gains": (COLUMNS, gains)}
