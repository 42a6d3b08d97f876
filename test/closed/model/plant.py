# SPDX-License-Identifier: MIT
"""The falling mass, string, motor and loop of docs/DESIGN.md in doubles: a separate model.

    T    = max(0, kc (x - q) + bc (v - w)), 0 when x < q
    m v' = m g - T - friction(mu_mass T)
    r w' = T - kf i - viscous w - friction(coulomb + mu_motor T)
    i'   = 2 pi fbw (ref - i),  monitor' = (i - monitor) / lag

It shares nothing with ports/posix/sim: Runge-Kutta of fourth order, and friction by events. A body
slides one way until its speed is zero, which is located within the step; then it sticks for as
long as friction can hold it. Standard library only.
"""

import math

GRAVITY = 9.81
STEP_S = 100e-6  # at most


def exp_neg(x):
    """exp(-x), x >= 0, by its series alone: the same bits on every machine, unlike a libm's."""
    halvings = 0
    while x > 0.125:
        x, halvings = x / 2, halvings + 1
    term = total = 1.0
    for n in range(1, 11):
        term *= -x / n
        total += term
    for _ in range(halvings):
        total *= total
    return total


class Wall:
    """The loop: rate, gains, and what the scene has by default."""

    def __init__(self, rate_Hz, k_Npm, b_Nspm, scene, phase):
        self.T_s = 1.0 / rate_Hz
        self.k, self.b = k_Npm, b_Nspm
        self.f0_N, self.band_m = scene["f0"], scene["f0_band"]
        self.f_max_N, self.slew_Nps = scene["f_max"], scene["slew_up"]
        self.window = 2 ** int(scene["vel_p"])
        self.phase = phase


def wall_m(d, phase):
    """Where the wall is, from where the string starts: so many counts above a count, next to the
    height of the fall."""
    step_m = d["step"] / d["decode"]
    return (math.floor(d["height"] / step_m - phase + 0.5) + phase) * step_m


class Body:
    """One fall: state, clocks, and the controller."""

    def __init__(self, d, wall, rng, zero_cnt, grid, first):
        self.d, self.wall, self.rng, self.grid = d, wall, rng, grid
        self.x = self.q = -d["height"] + d["height_jitter"] * (2 * rng.random() - 1)
        self.v = self.w = self.i = self.mon = self.ref = self.latched = 0.0
        self.t = 0.0
        self.tick_s = rng.random() * wall.T_s
        self.servo_s = rng.random() / d["servo_rate"]
        self.zero_cnt = zero_cnt
        self.lim_m = wall_m(d, wall.phase)
        self.inward = not first  # it was lifted
        self.force = wall.f0_N * self.inward
        self.i = self.mon = self.ref = self.latched = self.force / d["kf"]
        self.counts = [self.count()] * (wall.window + 1)
        self.turn_m = self.pos()
        self.outputs = []

    def count(self):
        return math.floor(self.q * self.d["decode"] / self.d["step"] + self.grid)

    def pos(self):
        return (self.counts[-1] - self.zero_cnt) * self.d["step"] / self.d["decode"]

    # --- the loop ---

    def law(self):
        wall, pos = self.wall, self.pos()
        back = pos - self.turn_m if self.inward else self.turn_m - pos
        if back > wall.band_m:
            self.inward = not self.inward
        if back > wall.band_m or back < 0:
            self.turn_m = pos
        past = pos - self.lim_m
        speed = ((self.counts[-1] - self.counts[-1 - wall.window]) / wall.window *
                 self.d["step"] / self.d["decode"] / wall.T_s)
        asked = wall.f0_N * self.inward
        if past >= 0:
            asked += wall.k * past + wall.b * speed
        asked = min(max(asked, 0.0), wall.f_max_N, self.d["kf"] * self.d["peak"])
        slew = wall.slew_Nps * wall.T_s
        return min(max(asked, self.force - slew), self.force + slew), past >= 0

    def tick(self):
        d = self.d
        self.counts = self.counts[1:] + [self.count()]
        noise_A = d["mon_noise"] * (sum(self.rng.random() for _ in range(4)) / 4 - 0.5)
        seen_A = math.floor((self.mon + noise_A) / d["mon_scale"] + 0.5) * d["mon_scale"]
        self.force, touching = self.law()
        code = math.floor(self.force / d["kf"] * d["dac_scale"] + 0.5)
        late_s = d["delay_tick"] * self.wall.T_s + d["delay"]
        self.outputs.append((self.t + late_s, code / d["dac_scale"]))
        self.tick_s += self.wall.T_s
        return self.t, self.pos(), d["kf"] * seen_A, touching

    # --- the motion ---

    def advance(self, until_s):
        """To the next tick: outputs and the drive's clock in between."""
        while True:
            out_s = self.outputs[0][0] if self.outputs else 1e9
            next_s = min(until_s, self.servo_s, out_s)
            self.move(next_s - self.t)
            self.t = next_s
            if out_s <= next_s:
                self.latched = self.outputs.pop(0)[1]
            elif self.servo_s <= next_s:
                self.ref = min(self.latched, self.d["peak"])
                self.servo_s += 1.0 / self.d["servo_rate"]
            else:
                return

    def move(self, dt_s):
        if dt_s <= 0:
            return
        if self.is_stuck() and abs(self.i - self.ref) < 1e-9:
            self.lags(dt_s)
            return
        n = math.ceil(dt_s / STEP_S - 1e-9)
        for _ in range(n):
            self.step(dt_s / n)

    def lags(self, h):
        """Current and monitor by their closed form; the mean current over h."""
        a, b = 2 * math.pi * self.d["current_bw"], 1.0 / self.d["mon_lag"]
        off, ea, eb = self.i - self.ref, exp_neg(a * h), exp_neg(b * h)
        mean = self.ref + off * (1 - ea) / (a * h)
        # mon' = b (ref + off e^(-a t) - mon)
        self.mon = (self.ref + (self.mon - self.ref) * eb + off * b * (ea - eb) / (b - a))
        self.i = self.ref + off * ea
        return mean

    def tension(self, x, q, v, w):
        if x < q:
            return 0.0
        T = self.d["cable_k"] * (x - q) + self.d["cable_b"] * (v - w)
        return T if T > 0 else 0.0

    def pulls(self, x, q, v, w, i):
        """Force without dry friction, and the most of that, on mass and rotor."""
        d = self.d
        T = self.tension(x, q, v, w)
        return (d["mass"] * GRAVITY - T, d["mu_mass"] * T,
                T - d["kf"] * i - d["viscous"] * w, d["coulomb"] + d["mu_motor"] * T)

    def is_stuck(self):
        if self.v or self.w:
            return False
        f, df, g, dg = self.pulls(self.x, self.q, 0.0, 0.0, self.i)
        return abs(f) <= df and abs(g) <= dg

    def ways(self, i):
        """+1, -1: which way mass and rotor slide; 0: they stick."""
        f, df, g, dg = self.pulls(self.x, self.q, self.v, self.w, i)
        way = (self.v > 0) - (self.v < 0) or (f > df) - (f < -df)
        turn = (self.w > 0) - (self.w < 0) or (g > dg) - (g < -dg)
        return way, turn

    def slopes(self, x, q, v, w, i, way, turn):
        f, df, g, dg = self.pulls(x, q, v, w, i)
        return (v, w, (f - way * df) / self.d["mass"] if way else 0.0,
                (g - turn * dg) / self.d["rotor"] if turn else 0.0)

    def runge_kutta(self, h, i, way, turn):
        x, q, v, w = self.x, self.q, self.v, self.w
        a = self.slopes(x, q, v, w, i, way, turn)
        b = self.slopes(x + h / 2 * a[0], q + h / 2 * a[1], v + h / 2 * a[2], w + h / 2 * a[3], i,
                        way, turn)
        c = self.slopes(x + h / 2 * b[0], q + h / 2 * b[1], v + h / 2 * b[2], w + h / 2 * b[3], i,
                        way, turn)
        e = self.slopes(x + h * c[0], q + h * c[1], v + h * c[2], w + h * c[3], i, way, turn)
        return [s + h / 6 * (a[n] + 2 * b[n] + 2 * c[n] + e[n])
                for n, s in enumerate((x, q, v, w))]

    def step(self, h):
        """One step, cut where a body stops."""
        mean = self.lags(h)
        for _ in range(8):
            way, turn = self.ways(mean)
            x, q, v, w = self.runge_kutta(h, mean, way, turn)
            part = 1.0
            if way and v * way < 0:
                part = min(part, self.v / (self.v - v)) if self.v else 0.0
            if turn and w * turn < 0:
                part = min(part, self.w / (self.w - w)) if self.w else part
            if part >= 1.0:
                self.x, self.q, self.v, self.w = x, q, v, w
                return
            stops_mass = way and v * way < 0 and (not self.v or self.v / (self.v - v) <= part)
            stops_rotor = turn and w * turn < 0 and self.w and self.w / (self.w - w) <= part
            x, q, v, w = self.runge_kutta(part * h, mean, way, turn)
            self.x, self.q = x, q
            self.v = 0.0 if stops_mass else v
            self.w = 0.0 if stops_rotor else w
            h *= 1 - part
        self.x, self.q, self.v, self.w = x, q, self.v, self.w


def fall(d, wall, rng, zero_cnt, grid, first):
    """Ticks (t, position, monitored force, touching) from the release to `observe` behind the
    first contact; None: no contact within 3 s."""
    b = Body(d, wall, rng, zero_cnt, grid, first)
    ticks, end_s = [], None
    while end_s is None or b.tick_s < end_s - wall.T_s / 2:
        b.advance(b.tick_s)
        ticks.append(b.tick())
        if end_s is None and ticks[-1][3]:
            end_s = ticks[-1][0] + d["observe"]
        if end_s is None and b.t > 3:
            return None
    return ticks


def run(d, rate_Hz, k_Npm, b_Nspm, scene, rng, falls=10):
    """Falls of one run: one place of the wall and of the encoder's counts, and one start."""
    wall = Wall(rate_Hz, k_Npm, b_Nspm, scene, rng.random())
    grid = rng.random()
    start = -d["height"] + d["height_jitter"] * (2 * rng.random() - 1)
    zero_cnt = math.floor(start * d["decode"] / d["step"] + grid)
    lim_m = wall_m(d, wall.phase)
    return lim_m, [fall(d, wall, rng, zero_cnt, grid, n == 0) for n in range(falls)]
