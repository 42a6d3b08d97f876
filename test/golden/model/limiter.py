# SPDX-License-Identifier: MIT
"""limiter: the guard of any motor, as limiter.h and docs/NUMERICS.md have it."""

from .num import AGAIN, M32, MAX32, MIN32, TICKS, Rng, clamp, period, wrap, wrap64

EFFORT, POSITION, WALL = range(3)
POS, VEL, MEASURED, DEADMAN = 1, 2, 4, 8
REFUSE, HOLD = 0, 1
OFF, ARM, RUN, LIMIT, RELEASE, FAULT = range(6)
BY = {n: 1 << i for i, n in enumerate(
    "effort rise heat ramp range vel acc release state".split())}
CAUSE = {n: 1 << i for i, n in enumerate(
    "logic number time released stale range speed stall heat far".split())}
FULL = 1 << 30
NONE = MIN32

# name, largest value, kinds that need it above 0, what must be measured if it is not 0
FIELDS = [
    ("kind", 2, (), 0), ("uses", 15, (), 0), ("rate_milli", 20000000, (0, 1, 2), 0),
    ("effort_max", 2 * 10**9, (0, 2), 0), ("effort_up_milli", 2 * 10**9, (0, 2), 0),
    ("effort_down_milli", 2 * 10**9, (0, 2), 0), ("ramp_ms", 10000, (0, 1, 2), 0),
    ("release_ms", 1000, (0, 2), 0), ("pos_min", 5 * 10**8, None, 0),
    ("pos_max", 5 * 10**8, None, 0), ("pos_over", 5 * 10**8, (), 0), ("vel_max", 10**9, (1,), 0),
    ("acc_max_milli", 2 * 10**9, (1,), 0), ("first_max", 10**9, (), 0), ("first", 1, (), 0),
    ("after", 1, (), 0), ("age_max_us", 10**7, (0, 1, 2), 0), ("gap_max_us", 10**7, (0, 1, 2), 0),
    ("speed_max", 2 * 10**9, (2,), VEL), ("speed_ms", 1000, (), 0),
    ("stall_effort", 2 * 10**9, (), POS), ("stall_move", 10**9, (), 0), ("stall_ms", 60000, (), 0),
    ("heat_nominal", 2 * 10**9, (), 0), ("heat_peak", 2 * 10**9, (), 0),
    ("heat_ms", 600000, (), 0), ("wall_below", 1, (), 0), ("wall_k_milli", 10**9, (), 0),
    ("wall_b", 10**9, (), 0), ("wall_f0", 10**8, (), 0)]
NUMBER = {f[0]: -1 - k for k, f in enumerate(FIELDS)}


class Wrong(Exception):
    """The first field that is wrong."""


def need(cond, name):
    if not cond:
        raise Wrong(NUMBER[name])


def cut(v):
    return min(v, MAX32)


class Setup:
    def __init__(self, par):
        self.__dict__.update(par)
        for name, most, kinds, use in FIELDS:
            v = par[name]
            least = -most if kinds is None else 1 if self.kind in kinds and v != NONE else 0
            if name == "kind":
                least = 0
            need(least <= v <= most and not (v and use & ~self.uses), name)
        place = self.kind == POSITION
        need(self.kind == EFFORT or self.uses & POS, "uses")
        need(not place or not (self.stall_effort or self.heat_peak) or self.uses & MEASURED, "uses")
        need(not self.stall_effort or self.stall_ms > 0, "stall_ms")
        self.near = (0, 0)
        if self.uses & POS:
            need(self.pos_min < self.pos_max, "pos_max")
            self.near = (self.pos_min - self.pos_over, self.pos_max + self.pos_over)
        self.times()
        self.heat()
        if place:
            self.place()
        if self.kind == WALL:
            self.wall()

    def steps(self, ms):
        return cut(ms * self.rate_milli // 10**6)

    def times(self):
        release = max(1, self.steps(self.release_ms))
        self.fall_q32 = 2 * cut((1 << 31) // release)
        self.ramp_q30 = (FULL - 1) // (self.steps(self.ramp_ms) + 1) + 1
        self.up = max(1, cut(self.effort_up_milli * 10**6 // self.rate_milli))
        self.down = max(1, cut(self.effort_down_milli * 10**6 // self.rate_milli))
        self.speed_steps = self.steps(self.speed_ms) + 1
        self.stall_steps = self.steps(self.stall_ms) + 1 if self.stall_effort else 0
        self.speed = self.speed_max or MAX32
        self.still = self.gap_max_us * self.rate_milli // 10**9
        need(self.still >= 2, "gap_max_us")

    def heat(self):
        self.top, self.bottom, self.square = MAX32, 0, 0
        self.shift, self.budget, self.knee = 31, 1 << 47, 30
        if not self.heat_peak:
            return
        shift = max(0, self.heat_peak.bit_length() - 11)
        nominal = (self.heat_nominal >> shift)**2
        above = (self.heat_peak >> shift)**2 - nominal
        steps = self.steps(self.heat_ms)
        need(nominal and self.heat_nominal < self.heat_peak and above >= 1 << 14, "heat_nominal")
        need(steps >= 64, "heat_ms")
        self.top, self.bottom, self.square = self.heat_peak, self.heat_nominal, nominal
        self.shift, self.budget = shift, above * steps
        self.knee = (self.budget >> 18).bit_length() - 1

    def place(self):
        second = cut(self.acc_max_milli * 10**6 // self.rate_milli)
        for frac in range(12, -1, -1):
            vel = cut(self.vel_max * (1000 << frac) // self.rate_milli)
            acc = cut(second * (1000 << frac) // self.rate_milli)
            need(vel, "vel_max")
            need(acc, "acc_max_milli")
            acc = min(acc, 2 * vel)
            brake = ((vel * vel // (2 * acc) + vel) >> frac) + 2
            if vel < 1 << 29 and brake < 1 << 30 >> frac:
                self.frac, self.vel, self.acc, self.brake = frac, vel, acc, brake
                return
        raise Wrong(NUMBER["vel_max"])

    @staticmethod
    def law(gain, unit, q):
        """In the law's format, and how many bits fewer."""
        fewer = 0
        while gain * (1 << (q - fewer)) // unit >= MAX32:
            fewer += 1
        return gain * (1 << (q - fewer)) // unit, fewer

    def wall(self):
        self.k, pos = self.law(self.wall_k_milli, 1000, 20)
        self.b, vel = self.law(self.wall_b, 10**6, 27)
        side = -1 if self.wall_below else 1
        self.pos_scale, self.vel_scale = side << pos, side << vel
        need(max(self.near[1], -self.near[0]) < FULL >> pos, "wall_k_milli")
        need(self.speed_max <= MAX32 >> vel, "wall_b")


def setup_says(par):
    try:
        return 0, Setup(par)
    except Wrong as w:
        return w.args[0], None


class Limiter:
    def __init__(self, cfg):
        self.c = cfg
        self.state = OFF
        self.opened = self.started = self.holds = False
        self.now = self.heat = self.sent = self.part = self.vel = self.fall = self.stood = 0
        self.share = self.causes = self.first = self.limits = self.still = 0
        self.fast = self.stuck = self.cnt = 0

    def time_is_bad(self, now):
        gap = (now - self.now) & M32 if self.started else 1
        self.still = 0 if gap else self.still + 1
        self.now, self.started = now, True
        return gap > self.c.gap_max_us or self.still >= self.c.still

    def watched(self, effort, vel):
        """Causes by motion; the velocity the wall damps."""
        c = self.c
        pulled = effort > c.stall_effort and self.stood == self.cnt
        self.stuck = min(self.stuck + 1, c.stall_steps) if pulled else 0
        self.cnt = self.stood
        held = clamp(vel, -c.speed, c.speed)
        self.fast = min(self.fast + 1, c.speed_steps) if held != vel else 0
        cause = CAUSE["speed"] if self.fast >= c.speed_steps else 0
        if c.stall_steps and self.stuck >= c.stall_steps:
            cause |= CAUSE["stall"]
        return cause, held

    def warm(self, effort):
        c = self.c
        most = c.budget + (c.budget >> 2)
        heat = max(0, self.heat + min(effort >> c.shift, 2896)**2 - c.square)
        self.heat = min(heat, most + 1)
        return heat > most

    def law(self, at, pos, vel):
        c = self.c
        q = wrap(pos * c.pos_scale)
        lim = wrap(clamp(at, *c.near) * c.pos_scale)
        v = wrap(vel * c.vel_scale)
        f = 0
        if q >= lim:
            total = wrap64(c.k * (q - lim) + (c.b * v >> 7))
            f = (total + (1 << 19)) >> 20
        if v < 0:
            f += c.wall_f0
        f = clamp(f, 0, 104857600)
        return f if c.wall_below else -f

    def look(self, now, command, pos, vel, effort, age, deadman):
        """Present causes, the requested output, and the position."""
        c = self.c
        cause = CAUSE["time"] if self.time_is_bad(now) else 0
        if c.uses & DEADMAN and not deadman:
            cause |= CAUSE["released"]
        if age > c.age_max_us:
            cause |= CAUSE["stale"]
        pos = pos if c.uses & POS else 0
        vel = vel if c.uses & VEL else 0
        if not c.uses & MEASURED:
            effort = 0 if c.kind == POSITION else self.sent
        if NONE in (command, pos, vel, effort):
            cause |= CAUSE["number"]
            command = pos = vel = effort = 0
        elif not c.near[0] <= pos <= c.near[1]:
            cause |= CAUSE["range"]
        elif abs(pos - self.stood) > c.stall_move:
            self.stood = pos
        more, vel = self.watched(abs(effort), vel)
        cause |= more
        if self.warm(abs(effort)):
            cause |= CAUSE["heat"]
        if cause & CAUSE["number"]:
            return cause, 0, pos
        asked = self.law(command, pos, vel) if c.kind == WALL else command
        start = self.sent if c.kind == POSITION else 0
        if (self.state == ARM and self.share == 0 and c.first == REFUSE and
                not -c.first_max <= wrap(asked - start) <= c.first_max):
            cause |= CAUSE["far"]
        return cause, asked, pos

    def go_on(self, present, deadman, run):
        before = self.state
        others = present & ~CAUSE["released"]
        if present and before != OFF:
            self.first = self.first if self.causes else present & -present
            self.causes |= present
        if others or not (deadman if self.c.uses & DEADMAN else run):
            self.opened = not others
        if before == RELEASE and (self.vel if self.c.kind == POSITION else self.sent) == 0:
            self.state = FAULT if self.causes else OFF
        elif present or not run:
            self.state = before if before in (OFF, FAULT) else RELEASE
        elif before == OFF and self.opened:
            self.state, self.opened, self.first = ARM, False, 0
        elif before == FAULT and self.opened:
            self.state, self.causes = OFF, 0
        elif before in (RUN, LIMIT):
            self.state = LIMIT if self.limits else RUN
        elif before == ARM and self.share == FULL:
            self.state = RUN
        if self.state != ARM:
            self.share = FULL
        else:
            self.share = min(self.share + self.c.ramp_q30, FULL) if before == ARM else 0

    def hot(self):
        """What heat leaves."""
        c = self.c
        part = max(0, self.heat_left()) >> 16
        if part >> c.knee:
            return c.top
        return c.bottom + (2 * (c.top - c.bottom) * (part << (31 - c.knee)) >> 32)

    def heat_left(self):
        return self.c.budget - self.heat

    def effort(self, asked):
        c = self.c
        held = self.sent
        if self.state == RELEASE:
            self.limits = BY["release"]
            if self.fall <= 0:
                self.fall = (abs(held) * c.fall_q32 >> 32) + 2
            rest = max(0, abs(held) - self.fall)
            return rest if held >= 0 else -rest
        self.fall = 0
        if self.state in (OFF, FAULT):
            self.limits = BY["state"] if asked else 0
            return 0
        most = c.effort_max * self.share >> 30
        hot = self.hot()
        size = abs(asked)
        self.limits = BY["effort"] if size > c.effort_max else 0
        if size > most and most < c.effort_max:
            self.limits |= BY["ramp"]
        if size > hot:
            self.limits |= BY["heat"]
        most = min(most, hot)
        want = clamp(asked, -most, most)
        side = -1 if (held or want) < 0 else 1
        low = max(abs(held) - c.down, -c.up)
        now = side * clamp(want * side, low, min(abs(held) + c.up, c.effort_max))
        if now != want:
            self.limits |= BY["rise"]
        return now

    def towards(self, v, d, vmax):
        acc = self.c.acc
        high, low = min(v + acc, vmax), max(v - acc, 0)
        if d <= high and d <= acc and d >= v - acc:
            return d
        self.limits |= BY["vel"] if high == vmax else BY["acc"]
        if high <= 0 or (2 * high + acc)**2 <= 8 * d * acc:
            return high
        self.limits |= BY["acc"]
        middle = (high + low) // 2
        return middle if (2 * middle + acc)**2 <= 8 * d * acc else low

    def move(self, asked):
        c = self.c
        to = clamp(asked, c.pos_min, c.pos_max)
        d = (clamp(wrap(to - self.sent), -c.brake, c.brake) << c.frac) - self.part
        side = -1 if d < 0 else 1
        v = self.vel * side
        if self.state == RELEASE:
            self.limits = BY["release"]
            v -= clamp(v, -c.acc, c.acc)
        else:
            self.limits = BY["range"] if to != asked else 0
            v = self.towards(v, abs(d), c.vel * self.share >> 30)
        self.vel = v * side
        at = self.part + self.vel
        self.sent = wrap(self.sent + (at >> c.frac))
        self.part = at & ((1 << c.frac) - 1)

    def position(self, asked, pos, present, run):
        if self.state not in (OFF, FAULT) and self.share > 0:
            self.holds = False
            self.move(asked)
        else:
            self.limits, self.vel = BY["state"], 0
            if self.state == FAULT:
                self.holds = self.c.after == HOLD
            elif not run:
                self.holds = False
            if not self.holds and not present & CAUSE["number"]:
                self.sent, self.part = pos, 0
        return clamp(self.sent, *self.c.near)

    def step(self, now, command, pos, vel, effort, age, deadman, run):
        present, asked, pos = self.look(now, command, pos, vel, effort, age, deadman)
        self.go_on(present, deadman, run)
        self.sent = (self.position(asked, pos, present, run) if self.c.kind == POSITION
                     else self.effort(asked))
        on = self.state not in (OFF, FAULT) or self.holds
        return (self.sent, int(on), self.state, self.limits, self.first, self.causes, present,
                self.heat, self.part, self.vel, self.share, self.stood)


# --- stimuli ---

def any_par(rng, T):
    draw, p = rng.draw, {}
    rate = T[1] // T[0] + 1

    def time(n, m, units, lo, hi):
        return clamp(draw(n, m) * units * 1000 // p["rate_milli"], lo, hi)

    def change(most, m):
        return clamp(most * rate // draw(2, m), 1, 10**9)

    p["kind"] = draw(0, 2)
    p["uses"] = draw(0, 15) | (0, POS, POS | VEL)[p["kind"]]
    p["rate_milli"] = T[1] * 1000 // T[0]
    p["effort_max"] = draw(100000, 5000000)
    p["effort_up_milli"] = change(p["effort_max"] // 1000, 40)
    p["effort_down_milli"] = change(p["effort_max"] // 1000, 40)
    p["ramp_ms"] = time(1, 20, 1000, 1, 10000)
    p["release_ms"] = time(0, 10, 1000, 1, 1000)
    p["pos_min"] = -draw(100000, 2000000)
    p["pos_max"] = draw(100000, 2000000)
    p["pos_over"] = draw(0, 1000000)
    p["vel_max"] = change(p["pos_max"], 50)
    p["acc_max_milli"] = change(p["vel_max"] // 1000 + 1, 30)
    p["first_max"] = draw(0, 3000000)
    p["first"] = draw(0, 1)
    p["after"] = draw(0, 1)
    p["age_max_us"] = draw(1, 100000)
    p["gap_max_us"] = time(3, 9, 1000000, 0, 9999999) + 1
    stalls, warms = draw(0, 1), draw(0, 2) > 0
    seen = p["uses"] & MEASURED or p["kind"] != POSITION
    p["speed_max"] = draw(300000, 3000000)
    if not p["uses"] & VEL:
        p["speed_max"] = 0
    p["speed_ms"] = time(0, 5, 1000, 0, 1000)
    p["stall_effort"] = draw(0, 4000000)
    if not (stalls and seen and p["uses"] & POS):
        p["stall_effort"] = 0
    p["stall_move"] = draw(0, 20000)
    p["stall_ms"] = time(1, 20, 1000, 1, 60000)
    p["heat_peak"] = draw(3000, 6000000 >> draw(0, 4))
    p["heat_nominal"] = p["heat_peak"] >> draw(1, 3)
    if not (warms and seen):
        p["heat_peak"] = 0
    p["heat_ms"] = time(65, 150, 1000, 1, 600000)
    p["wall_below"] = draw(0, 1)
    p["wall_k_milli"] = draw(0, 100000000 >> draw(0, 8))
    p["wall_b"] = draw(0, 10000000 >> draw(0, 4))
    p["wall_f0"] = draw(0, 1000000)
    return p


def any_wrong(par, rng):
    name = FIELDS[rng.draw(0, len(FIELDS) - 1)][0]
    v = rng.draw(MIN32, MAX32)
    return setup_says({**par, name: v >> rng.draw(0, 31)})[0]


class Inputs:
    def __init__(self, par, now):
        self.par, self.now, self.us = par, now, 10**9 // par["rate_milli"]
        self.command = self.pos = 0

    def tick(self, rng, rests):
        draw, par = rng.draw, self.par
        way = par["effort_max"] if par["kind"] == EFFORT else par["pos_max"]
        event = draw(0, 127)
        self.now += self.us if event else 0
        if event == 1:
            self.now += draw(0, 8) * self.us
        self.now &= M32
        deadman = int(draw(0, 3) > 0 if rests else event != 2)
        run = int(draw(0, 3) > 0 if rests else event != 3)
        if draw(0, 7) == 0:
            self.command = draw(-way, way)
        if event == 4:
            self.command = draw(-MAX32, MAX32)
        self.command = 0 if self.command == NONE else self.command
        self.pos = 0 if self.pos == NONE else self.pos
        if draw(0, 3) > (2 if par["stall_effort"] else 0):
            self.pos = clamp(self.pos + draw(-30000, 30000), par["pos_min"], par["pos_max"])
        if event == 5:
            self.pos = draw(MIN32, MAX32)
        vel = draw(-400000, 400000) * (16 if event < 16 else 1)
        effort = draw(-par["effort_max"], par["effort_max"])
        age = draw(0, par["age_max_us"])
        if event == 6:
            age = draw(0, M32)

        def number(v):
            return NONE if draw(0, 1023) == 0 else v

        self.command = number(self.command)
        self.pos = number(self.pos)
        return (self.now, self.command, self.pos, number(vel), number(effort), age, deadman, run)


def limiter(rate):
    rng = Rng("limiter", rate, 0)
    for k in range(TICKS):
        if k in (0, AGAIN):
            par = any_par(rng, period(rate, k))
            code, cfg = setup_says(par)
            s = Limiter(cfg)
            given = Inputs(par, rng.draw(0, M32))
        wrong = any_wrong(par, rng) if k % 16 == 0 else 0
        now = given.tick(rng, s.state in (OFF, FAULT))
        out = s.step(*now) if code == 0 else (0,) * 12
        yield (par["kind"], *now, code, *out, wrong), b""


COLUMNS = ("kind now_us command pos vel effort age_us deadman run | setup send enable state limits "
           "first causes present heat part_q vel_q share_q30 stood wrong")

MODULES = {"limiter": (COLUMNS, limiter)}
