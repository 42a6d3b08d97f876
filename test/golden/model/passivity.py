# SPDX-License-Identifier: MIT
"""passivity: no contact gives back more energy than it was given."""

from struct import Struct

from .drive import Table, any_par
from .num import AGAIN, MAX32, MIN32, TICKS, Rng, clamp, gain, period, sat32, shr, times, wrap
from .velocity import scale

PASSIVITY = 1 << 10
MOST = 100 << 20
MAX60 = 1 << 60


class Passivity:
    pack = Struct("<qiiiBB").pack

    def __init__(self, f_top, held, step, T, speed):
        g = gain(T[0] << 15, T[1] * step)
        self.way = times(g, speed) + 1
        assert self.way <= 1 << 24
        self.sh = 0
        while MOST * self.way >> self.sh >= MAX32:
            self.sh += 1
        self.share = gain(1 << self.sh, self.way)
        self.f_top, self.table, self.step = f_top, held, step
        self.e = self.held = self.late = self.cnt = self.touching = self.started = 0

    def tick(self, on, f_max, cnt, touching, asked):
        """(bit, term)"""
        moved = wrap(cnt - self.cnt) if self.started else 0
        e = self.e + moved * (min(self.held, self.late) if moved >= 0
                              else max(self.held, self.late))
        if self.held == 0 and not (touching and self.touching) and (e > 0 or self.late == 0):
            e = 0
        self.e, self.cnt, self.touching, self.started = clamp(e, -MAX60, MAX60), cnt, touching, 1
        less = times(self.share, clamp((-self.e >> self.sh) + 1, 0, MAX32)) + 1
        limit = max(0, min(f_max, self.f_top) - less)
        if self.e < 0 and asked > limit and on:
            return PASSIVITY, limit - asked
        return 0, 0

    def hold(self, on, force, pull, coded):
        h = max(0, self.table.at(coded) - pull) if force > pull else 0
        self.late = self.held if on == 2 else h
        self.held = h

    def joule(self):
        return sat32(shr(shr(self.e * self.step, 31), 7))

    def state(self):
        return self.pack(self.e, self.held, self.late, self.cnt, self.touching, self.started)


def any_move(rng, way):
    how, near, far = rng.draw(0, 15), rng.draw(-way, way), rng.draw(MIN32, MAX32)
    return -way if how < 4 else way if how < 6 else 0 if how < 7 else far if how < 8 else near


def any_asked(rng, most):
    """Spring and damper."""
    how, some, any_ = rng.draw(0, 7), rng.draw(-(1 << 20), 1 << 27), rng.draw(MIN32, MAX32)
    spring = 0 if how < 1 else most if how < 3 else any_ << 11 if how < 4 else some
    return spring, rng.draw(-(1 << 22), 1 << 22)


def passivity(rate):
    rng = Rng("passivity", rate, 0)
    for k in range(TICKS):
        if k in (0, AGAIN):
            drive = any_par(rng, rate)
            f_max, person_f = drive[0], drive[11]
            knots = [(0, 0)]
            for _ in range(2):
                x = knots[-1][0] + rng.draw(1 << 20, 1 << 25)
                knots.append((x, knots[-1][1] + rng.draw(1 << 24, 1 << 27)))
            step, speed = scale(rng), rng.draw(13421773, 1342177280)
            to_cur = Table(knots)
            p = Passivity(min(knots[-1][0], person_f), to_cur.invert(), step, period(rate, k),
                          speed)
            cnt, touching, on = rng.draw(MIN32, MAX32), 0, 2
        if rng.draw(0, 9) == 0:
            on = rng.draw(0, 2)
        if rng.draw(0, 5) == 0:
            touching ^= 1
        cnt = wrap(cnt + any_move(rng, p.way))
        spring, damper = any_asked(rng, min(f_max, p.f_top))
        if not touching:
            spring = damper = 0
        pull = rng.draw(0, 20971520) if rng.draw(0, 3) == 0 else 0
        bit, term = p.tick(on, f_max, cnt, touching, spring + damper)
        force = clamp(spring + damper + pull + term, 0, min(f_max, p.f_top))
        off = rng.draw(-20000, 20000)
        coded = 0 if rng.draw(0, 31) == 0 else sat32(to_cur.at(force) + off)
        p.hold(on, force, pull, coded)
        yield (on, cnt, touching, spring, damper, pull, coded, bit, term, p.joule(), p.held,
               p.late), p.state()


COLUMNS = ("on cnt touching spring damper pull coded_A_q26 | limits passivity_N_q20 J_q24 "
           "held_N_q20 late_N_q20")

MODULES = {"passivity": (COLUMNS, passivity)}
