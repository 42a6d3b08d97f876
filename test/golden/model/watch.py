# SPDX-License-Identifier: MIT
"""watch: too fast, or standing while pulled."""

from struct import Struct

from .num import AGAIN, MAX32, MIN32, TICKS, Rng, clamp, period, wave

SPEED_LIMIT, STUCK, SPEED = 1 << 9, 1 << 6, 1 << 7


def any_par(rng, rate):
    """speed_limit, speed_time, stuck_time, stuck_cur"""
    speed = rng.draw(13421773, 1342177280)
    ms = clamp(rng.draw(1, 5) * 1000 // rate, 1, 1000)
    stuck = clamp(rng.draw(1, 24) * 1000 // rate, 100, 60000)
    if rng.draw(0, 3) == 0:
        stuck = 0
    return speed, ms, stuck, rng.draw(3355443, 442918502)


class Watch:
    pack = Struct("<IIi").pack

    def __init__(self, par, T):
        self.most, ms, stuck, self.current = par
        self.fast_ticks = ms * T[1] // (1000 * T[0]) + 1
        self.stuck_ticks = stuck * T[1] // (1000 * T[0]) + 1 if stuck else 0
        self.fast = self.stuck = self.cnt = 0

    def step(self, v):
        """(faults, velocity, limits)"""
        fast = abs(v) > self.most
        self.fast = min(self.fast + 1, self.fast_ticks) if fast else 0
        faults = SPEED if self.fast == self.fast_ticks else 0
        if self.stuck_ticks and self.stuck == self.stuck_ticks:
            faults |= STUCK
        return faults, clamp(v, -self.most, self.most), SPEED_LIMIT if fast else 0

    def coded(self, cnt, current):
        if current > self.current and cnt == self.cnt:
            self.stuck = min(self.stuck + 1, self.stuck_ticks)
        else:
            self.stuck = 0
        self.cnt = cnt

    def state(self):
        return self.pack(self.fast, self.stuck, self.cnt)


def watch(rate):
    rng = Rng("watch", rate, 0)
    moves = wave("watch", rate, 1, MIN32, MAX32, 1 << rng.draw(20, 27))
    cnt = stands = fast = 0
    for k in range(TICKS):
        v = moves[k]
        if k in (0, AGAIN):
            par = any_par(rng, rate)
            s = Watch(par, period(rate, k))
        if rng.draw(0, 15) == 0:
            stands ^= 1
        fast ^= rng.draw(0, 15) == 0
        v = (MIN32 if v < 0 else MAX32) if fast else v >> 8
        if not stands:
            cnt += rng.draw(-2, 2)
        coded = par[3] + rng.draw(-1, 31 if stands else 1)
        out = s.step(v)
        s.coded(cnt, coded)
        yield (v, cnt, coded, *out), s.state()


COLUMNS = "vel_mps_q27 cnt coded_A_q26 | faults held_mps_q27 limits"

MODULES = {"watch": (COLUMNS, watch)}
