# SPDX-License-Identifier: MIT
"""drive: tables, from force to current, and the monitor back."""

from struct import Struct

from .num import AGAIN, TICKS, MAX32, MIN32, Rng, clamp, gain, period, sat32, shr, times, wave

PULL, FORCE, SLEW, PEAK, I2T, DAC, GATE, RAMP, RELEASE = (1 << b for b in range(9))
PERSON = 1 << 11
FULL = 1 << 30


class Table:
    def __init__(self, knots):
        self.knots = knots
        self.slope = [gain(b[1] - a[1], b[0] - a[0]) for a, b in zip(knots, knots[1:])]

    def at(self, x):
        k = self.knots
        x = clamp(x, k[0][0], k[-1][0])
        i = len(k) - 2
        while i > 0 and x < k[i][0]:
            i -= 1
        y = k[i][1] + times(self.slope[i], x - k[i][0])
        return clamp(y, k[i][1], k[i + 1][1])

    def invert(self):
        return Table([(y, x) for x, y in self.knots])


def ramp(rng, n, most):
    """n differences of at least 1 and at most most, of any size."""
    return [rng.draw(1, most) >> rng.draw(0, 20) or 1 for _ in range(n)]


def table(rate):
    rng = Rng("table", rate, 0)
    for k in range(TICKS):
        if k % 64 == 0:
            n = rng.draw(2, 8)
            x, y = rng.draw(MIN32, 0), rng.draw(MIN32, 0)
            knots = [(x, y)]
            for dx, dy in zip(ramp(rng, n - 1, MAX32 // n), ramp(rng, n - 1, MAX32 // n)):
                knots.append((knots[-1][0] + dx, knots[-1][1] + dy))
            t, back = Table(knots), Table(knots).invert()
            g = t.slope + back.slope
        i = rng.draw(0, n - 1)
        x, y = knots[i][0] + rng.draw(-2, 2), knots[i][1] + rng.draw(-2, 2)
        if k & 1:
            x, y = rng.draw(knots[0][0], knots[-1][0]), rng.draw(knots[0][1], knots[-1][1])
        x, y = sat32(x), sat32(y)
        s = g[rng.draw(0, len(g) - 1)]
        yield (x, y, t.at(x), back.at(y), s[0], s[1]), b""


TABLE = "x y | y_at_x x_at_y mant shift"


class Drive:
    pack = Struct("<iiq").pack

    def __init__(self, par, T, to_cur, to_force):
        (self.f_max, self.up, self.down, self.peak, self.cont, ms, self.zero, self.span,
         self.dac, self.mon_zero, self.mon, person_f, person_i) = par
        self.to_cur, self.to_force = to_cur, to_force
        g = gain(T[0] << 20, T[1])
        self.up, self.down = max(1, times(g, self.up)), max(1, times(g, self.down))
        ticks = ms * T[1] // (1000 * T[0]) + 1
        self.cont2 = (self.cont >> 10) ** 2
        self.budget = ((self.peak >> 10) ** 2 - self.cont2) * ticks
        self.sh = max(0, self.budget.bit_length() - 31)
        # Currents that are one in q16 have no budget, and nothing is above i_cont.
        self.fold = (gain(self.peak - self.cont, self.budget >> self.sh >> 2) if self.budget
                     else (0, 1))
        self.amp = gain(1 << 42, self.dac)
        end = to_cur.knots[-1][0]
        self.top, self.top_bit = min(end, person_f), PERSON if person_f < end else FORCE
        self.i_top = self.whole(person_i)
        if self.i_top >= self.whole(self.peak):
            self.i_top = self.peak
        self.force = self.fall = self.heat = 0

    def take(self, permit, asked, term=0):
        """(limits, clamp, slew, release, force); permit: mode, share, small, ticks, fall"""
        mode, share, small, ticks, fall = permit
        if mode == 2:
            if self.fall == 0:
                self.fall = (self.force * fall[0] >> fall[1]) + 1
            self.force = max(0, self.force - ticks * self.fall)
            return RELEASE, 0, 0, self.force - asked, self.force
        self.fall = 0
        if mode != 1:
            self.force = 0
            limits = PULL if asked < 0 else GATE if asked > 0 else 0
            return limits | (FORCE if asked - term > small else 0), -asked, 0, 0, 0
        top = min(self.f_max, self.top)
        most = top * share // FULL
        held = clamp(asked, 0, most)
        bit = self.top_bit if self.f_max > self.top else FORCE
        limits = PULL if asked < 0 else bit if asked > top else 0
        if most < top and asked > most:
            limits |= RAMP
        force = clamp(held, self.force - self.down, self.force + self.up)
        if force != held:
            limits |= SLEW
        self.force = force
        return limits, held - asked, force - held, 0, force

    def whole(self, most):
        return min(most, (most * self.dac >> 42) * self.amp[0] >> self.amp[1])

    def current(self):
        """(limits, table, peak, i2t)"""
        i0 = self.to_cur.at(self.force)
        left = max(0, self.budget - self.heat) >> self.sh
        hot = self.cont + min(self.peak - self.cont, times(self.fold, left))
        whole = self.whole(hot)
        top = whole if hot == self.peak else self.peak
        peak = PERSON if self.i_top < top else PEAK
        i1 = min(i0, top, self.i_top)
        i2 = min(i1, whole)
        coded = sat32(times(self.amp, shr(i2 * self.dac, 42)))
        limits = (peak if i1 != i0 else 0) | (I2T if i2 != i1 else 0)
        self.heat = max(0, self.heat + (coded >> 10) ** 2 - self.cont2)
        return limits, i0, i1 - i0, i2 - i1

    def monitor(self, raw):
        i = sat32(shr((raw - self.mon_zero) * self.mon, 14))
        return i, self.to_force.at(i)

    def state(self):
        return self.pack(self.force, self.fall, self.heat)


def rising(rng, x, y, n, dx, dy):
    knots = [(x, y)]
    for _ in range(n - 1):
        x, y = x + rng.draw(1000, dx), y + rng.draw(1000, dy)
        knots.append((x, y))
    return Table(knots)


def any_par(rng, rate):
    """The rows of the drive, in their order."""
    f_max = rng.draw(1 << 20, 104857600)
    up, down = max(1, rate * rng.draw(10, 1000) // 100), max(1000, rate * rng.draw(10, 1000) // 100)
    peak = max(6710886, rng.draw(6710886, 442918502) >> rng.draw(0, 4))
    cont = rng.draw(0, min(peak - 1, 221459251)) >> rng.draw(0, 2)
    ms = rng.draw(1, min(2700, 12000 // rate + 1))
    zero, span = rng.draw(0, 65535), rng.draw(0, 32767) >> rng.draw(0, 8)
    dac = rng.draw(65536, MAX32)
    mon_zero, mon = rng.draw(-32768, 32767), rng.draw(1, MAX32)
    person = min(104857600, rng.draw(1 << 20, 1 << 28)), min(442918502, rng.draw(0, 1 << 30))
    return f_max, up, down, peak, cont, ms, zero, span, dac, mon_zero, mon, *person


def drive(rate):
    rng = Rng("drive", rate, 0)
    spring = wave("drive", rate, 1, -(1 << 26), 1 << 27, 1 << rng.draw(10, 22))
    damper = wave("drive", rate, 2, -(1 << 25), 1 << 25, 1 << rng.draw(10, 22))
    for k in range(TICKS):
        if k in (0, AGAIN):
            par = any_par(rng, rate)
            to_cur = rising(rng, 0, 0, rng.draw(2, 6), 1 << 25, 1 << 28)
            x, y, n = rng.draw(-(1 << 29), 0), rng.draw(-(1 << 27), 0), rng.draw(2, 6)
            to_force = rising(rng, x, y, n, 1 << 28, 1 << 25)
            d = Drive(par, period(rate, k), to_cur, to_force)
            fall = gain(1, rng.draw(3, 360))
        s, p = spring[k], rng.draw(0, 20971520) if k & 8 else 0
        if 180 <= k < AGAIN:
            s <<= rng.draw(0, 16)
        mode = 0 if k < 4 or 70 <= k < 76 else 3 if k == 130 else 1
        if 100 <= k < 110:
            mode = 2
        if k >= 160:
            mode = {0: 0, 1: 2, 2: 2, 3: 2, 4: 3}.get(rng.draw(0, 31), mode)
        share = rng.draw(0, FULL) if rng.draw(0, 3) == 0 else FULL
        small = rng.draw(0, 10485760)
        ticks = rng.draw(1, 3) if rng.draw(0, 1 if mode == 2 else 7) == 0 else 1
        limits, clamp_, slew, release, force = d.take((mode, share, small, ticks, fall),
                                                      s + damper[k] + p)
        more, i_table, i_peak, i_i2t = d.current()
        raw = rng.draw(-32768, 32767)
        i_mon, f_mon = d.monitor(raw)
        yield (s, damper[k], p, mode, share, small, ticks, raw, clamp_, slew, release, force,
               i_table, i_peak, i_i2t, limits | more, i_mon, f_mon), d.state()


DRIVE = ("spring_N_q20 damper_N_q20 pullback_N_q20 mode share_q30 small_N_q20 ticks mon_raw | "
         "clamp_N_q20 slew_N_q20 "
         "release_N_q20 force_N_q20 "
         "table_A_q26 peak_A_q26 i2t_A_q26 limits mon_A_q26 mon_N_q20")

MODULES = {"table": (TABLE, table), "drive": (DRIVE, drive)}
