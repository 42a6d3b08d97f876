# SPDX-License-Identifier: MIT
"""probe: the motions of calibration, over a toy of a string with a mass."""

from .num import AGAIN, TICKS, Rng, clamp, div, period, wrap
from .velocity import scale

BUSY, DONE, WRONG_WAY, STILL, TRAVEL, TIME, JAM = range(7)
CUR_MAX = 33 * (1 << 26) // 10


def ticks(ms, T):
    return max(1, ms * T[1] // (1000 * T[0]))


def counts(m_q30, step):
    return (m_q30 << 12) // step


class Probe:
    def __init__(self, par, step, T):
        self.step, self.end, dwell_ms, time_ms, move, travel = par
        self.dwell_ticks, self.ticks = max(2, ticks(dwell_ms, T)), ticks(time_ms, T)
        self.move, self.travel = max(2, counts(move, step)), counts(travel, step)

    def start(self, cnt, cur):
        self.cur = clamp(cur, 0, CUR_MAX)
        self.from_, self.dwell_from = cnt, cnt
        self.dwell = self.tick_ = self.settled = 0
        self.result = BUSY

    def ends(self, result):
        self.result = result
        if result != DONE:
            self.cur = 0
        return result

    def tick(self, cnt):
        if self.result != BUSY:
            return self.result
        moved = wrap(cnt - self.dwell_from)
        self.tick_ += 1
        self.dwell += 1
        if abs(wrap(cnt - self.from_)) > self.travel:
            return self.ends(TRAVEL)
        if self.step > 0 and moved >= self.move:
            return self.ends(WRONG_WAY)
        if self.step > 0 and self.settled and moved <= -self.move:
            return self.ends(DONE)
        if self.step < 0 and moved >= self.move:
            return self.ends(DONE)
        if self.tick_ >= self.ticks:
            return self.ends(TIME)
        if self.dwell >= self.dwell_ticks:
            self.dwell, self.dwell_from = 0, cnt
            if self.step < 0 or abs(moved) < self.move:
                self.settled = 1
                to = self.cur + self.step
                if to > self.end if self.step > 0 else to < self.end:
                    return self.ends(STILL)
                self.cur = to
        return BUSY

    def row(self):
        return (self.cur, self.from_, self.dwell_from, self.dwell, self.tick_, self.settled,
                self.result)


def toy(rng, k, cnt, cur, lift, quick):
    """Where the string is after a tick: slack comes in, a mass lifts above a current, or sinks."""
    way = -1 if k % 32 < 6 or cur > lift else 1 if cur < lift // 2 and k % 32 > 20 else 0
    cnt += way * quick + rng.draw(-1, 1)
    if rng.draw(0, 31) == 0:
        cnt += rng.draw(-4, 4) * quick
    return wrap(cnt)


def probe(rate):
    rng = Rng("probe", rate, 0)
    for k in range(TICKS):
        if k % 32 == 0:
            T, step = period(rate, k), scale(rng)
            falls = rng.draw(0, 1)
            up = rng.draw(67, 33554432) >> rng.draw(0, 4)
            end = rng.draw(0, CUR_MAX) >> rng.draw(0, 2)
            few = 1000 * T[0] // T[1] + 1
            move = rng.draw(1, 1 << 22)
            dwell, time = min(10000, few * rng.draw(1, 3)), min(1000000, few * rng.draw(8, 64))
            par = (-max(67, up) if falls else max(67, up), end, dwell, time, move,
                   rng.draw(1 << 23, 1 << 26))
            p, cnt = Probe(par, step, T), wrap(rng.u64())
            cur = rng.draw(-1000, CUR_MAX + 1000)
            lift, quick = rng.draw(0, CUR_MAX), p.move // 2 + 1
            p.start(cnt, cur)
        cnt = toy(rng, k, cnt, p.cur, lift, quick)
        yield (cnt, p.tick(cnt), *p.row()), b""


PROBE = "cnt | step_result cur_A_q26 start_cnt dwell_cnt dwell tick settled result"

class Home:
    def __init__(self, par, step, T):
        self.flows, dwell_ms, time_ms, move, least, most = par
        self.dwell_ticks, self.ticks = max(2, ticks(dwell_ms, T)), ticks(time_ms, T)
        self.move, self.least, self.most = (max(2, counts(move, step)), counts(least, step),
                                            counts(most, step))

    def start(self, cnt):
        self.cur, self.from_, self.dwell_from, self.home = self.flows, cnt, cnt, 0
        self.dwell = self.tick_ = 0
        self.result = BUSY

    def ends(self, result):
        self.result, self.cur = result, 0
        return result

    def tick(self, cnt):
        if self.result != BUSY:
            return self.result
        moved, far = wrap(cnt - self.dwell_from), wrap(cnt - self.from_)
        self.tick_ += 1
        self.dwell += 1
        if -far > self.most:
            return self.ends(TRAVEL)
        if moved >= self.move:
            return self.ends(WRONG_WAY)
        if self.tick_ >= self.ticks:
            return self.ends(TIME)
        if self.dwell >= self.dwell_ticks:
            self.dwell, self.dwell_from, self.home = 0, cnt, cnt
            if -moved < self.move:
                return self.ends(JAM if -far < self.least else DONE)
        return BUSY

    def row(self):
        return self.cur, self.from_, self.dwell_from, self.home, self.dwell, self.tick_, self.result


def home(rate):
    rng = Rng("home", rate, 0)
    for k in range(TICKS):
        if k % 16 == 0:
            T, step = period(rate, k), scale(rng)
            few = 1000 * T[0] // T[1] + 1
            flows = rng.draw(1, 33554432)
            dwell, time = min(10000, few * rng.draw(1, 3)), min(1000000, few * rng.draw(4, 32))
            move, least, most = (rng.draw(1, 1 << 21), rng.draw(0, 1 << 23) >> rng.draw(0, 3),
                                 rng.draw(1 << 23, 1 << 25))
            h, cnt = Home((flows, dwell, time, move, least, most), step, T), wrap(rng.u64())
            quick, stops = max(1, h.move // rng.draw(1, 3)), k + rng.draw(0, 15)
            h.start(cnt)
        cnt = toy(rng, 0 if k < stops else 8, cnt, 0, 0, quick)
        yield (cnt, h.tick(cnt), *h.row()), b""


HOME = "cnt | step_result cur_A_q26 start_cnt dwell_cnt home_cnt dwell tick result"

class Weigh:
    def __init__(self, par, slack, hold_ms, step, T):
        by, _, dwell, time, move, travel = par
        self.up, self.down = Probe(par, step, T), Probe((-by, 0, dwell, time, move, travel), step,
                                                        T)
        self.slack, self.hold = slack, ticks(hold_ms, T)

    def start(self, cnt):
        self.probe = self.up
        self.probe.start(cnt, self.slack)
        self.cur, self.lift, self.sink, self.tick_, self.phase, self.result = (self.probe.cur, 0, 0,
                                                                               0, 0, BUSY)
        self.from_, self.sums, self.n = cnt, [0, 0], 0

    def ends(self, result):
        self.result, self.cur = result, 0
        return result

    def tick(self, cnt, coded, mon):
        if self.result != BUSY:
            return self.result
        if self.phase < 2:
            r = self.probe.tick(cnt)
            self.cur = self.probe.cur
            if r == DONE and self.phase == 0:
                self.lift, self.phase, self.probe = self.cur, 1, self.down
                self.probe.start(cnt, self.lift)
                self.probe.from_ = self.from_
            elif r == DONE:
                self.sink, self.phase = self.cur, 2
                self.cur = (self.lift + self.sink) // 2
                self.probe.start(cnt, self.cur)
                self.probe.from_ = self.from_
            elif r != BUSY:
                return self.ends(r)
            return BUSY
        p = self.probe
        if abs(wrap(cnt - self.from_)) > p.travel:
            return self.ends(TRAVEL)
        self.tick_ += 1
        if self.tick_ >= p.ticks:
            return self.ends(TIME)
        if abs(wrap(cnt - p.dwell_from)) >= p.move:  # it moves: to rest again, and anew
            self.phase, p.dwell, p.dwell_from, self.sums, self.n = 2, 0, cnt, [0, 0], 0
            return BUSY
        p.dwell += 1
        if self.phase == 2:
            if p.dwell >= p.dwell_ticks:
                self.phase, p.dwell, p.dwell_from = 3, 0, cnt
            return BUSY
        self.sums = [self.sums[0] + coded, self.sums[1] + mon]
        self.n += 1
        return self.ends(DONE) if self.n >= self.hold else BUSY

    def row(self):
        return (self.cur, self.lift, self.sink, *self.sums, self.n, self.tick_, self.phase,
                self.result, *self.probe.row())

    def point(self, force):
        a, b = (div(s, self.n) if self.n else 0 for s in self.sums)
        return force, a, b, (self.lift - self.sink) // 2


def weigh(rate):
    rng = Rng("weigh", rate, 0)
    for k in range(TICKS):
        if k % 32 == 0:
            T, step = period(rate, k), scale(rng)
            few = 1000 * T[0] // T[1] + 1
            by, end = rng.draw(1 << 20, 1 << 23), rng.draw(1 << 26, CUR_MAX)
            dwell, time = min(10000, few * rng.draw(1, 2)), min(1000000, few * rng.draw(16, 40))
            par = by, end, dwell, time, rng.draw(1, 1 << 21), rng.draw(1 << 23, 1 << 26)
            slack = rng.draw(1 << 23, 1 << 26)
            w, cnt = Weigh(par, slack, few * rng.draw(4, 12), step, T), wrap(rng.u64())
            lift = slack + by * rng.draw(0, 4)
            sink, quick = lift - by * rng.draw(1, 4), w.up.move // 2 + 1
            w.start(cnt)
        way = -1 if w.cur > lift else 1 if w.cur < sink else 0
        odd = rng.draw(0, 15)  # noise, or a knock
        knock = odd == 0 or w.phase > 1
        cnt = wrap(cnt + way * quick +
                   (rng.draw(-1, 1) * (w.up.move if knock else 1) if odd < 4 else 0))
        coded, mon = rng.draw(-(1 << 20), 1 << 28), rng.draw(-(1 << 20), 1 << 28)
        r = w.tick(cnt, coded, mon)
        yield (cnt, coded, mon, r, *w.row(), *w.point(k)), b""


WEIGH = ("cnt coded_A_q26 mon_A_q26 | step_result cur_A_q26 lift_A_q26 sink_A_q26 coded_sum "
         "mon_sum n tick phase "
         "result probe_cur_A_q26 start_cnt dwell_cnt dwell probe_tick settled probe_result "
         "force_N_q20 "
         "point_cur_A_q26 point_mon_A_q26 point_friction_A_q26")

MODULES = {"probe": (PROBE, probe), "home": (HOME, home), "weigh": (WEIGH, weigh)}
