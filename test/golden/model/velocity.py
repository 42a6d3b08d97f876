# SPDX-License-Identifier: MIT
"""velocity: four estimators (the difference is the window of one tick)."""

from struct import Struct

from .num import (AGAIN, TICKS, Rng, clamp, gain, period, sat32, shr, times, wave, wrap)

N = 16


def scale(rng):
    """An encoder step, m q42: 1 to 488 um."""
    return max(4398047, rng.draw(4398047, (1 << 31) - 1) >> rng.draw(0, 8))


def counts(name, rate, step, small):
    """Counts that move by small in ramps and walks, or else some 8 m/s; its rails are the
    counter's."""
    return wave(name, rate, 1, -(1 << 31), (1 << 31) - 1,
                small or max(3, (1 << 45) // (step * rate)))


class Window:
    pack = Struct("<16iBB").pack

    def __init__(self, step, T, p):
        self.n = n = 1 << p
        self.gain = gain(step * T[1], T[0] * n << 15)
        self.cnt, self.at, self.started = [0] * N, 0, 0

    def tick(self, cnt):
        if not self.started:
            self.cnt, self.started = [cnt] * N, 1
        old, self.cnt[self.at] = self.cnt[self.at], cnt
        self.at = (self.at + 1) % self.n
        return sat32(times(self.gain, wrap(cnt - old)))

    def state(self):
        return self.pack(*self.cnt, self.at, self.started)


def pole_of(us, T):
    """T / (T + us) in q31, kept within 1 .. 2^31 - 1."""
    mant, s = gain(T[0] * 1000000, T[0] * 1000000 + us * T[1])
    return clamp(shr(mant, s - 31) if s > 31 else mant << (31 - s), 1, (1 << 31) - 1)


class Pole:
    pack = Struct("<qiB").pack

    def __init__(self, step, T, tau_us):
        self.gain = gain(step * T[1], T[0] << 15)
        self.a = pole_of(tau_us, T)
        self.v = self.cnt = self.started = 0

    def tick(self, cnt):
        if not self.started:
            self.cnt, self.started = cnt, 1
        d = sat32(times(self.gain, wrap(cnt - self.cnt))) << 28
        self.cnt = cnt
        self.v += shr((d - self.v) * self.a, 31)
        return sat32(shr(self.v, 28))

    def state(self):
        return self.pack(self.v, self.cnt, self.started)


class Foaw:
    pack = Struct("<16iBB").pack

    def __init__(self, step, T, n, tol):
        self.n, self.tol = n, tol
        self.gain = [gain(6 * step * T[1], T[0] * i * (i + 1) * (i + 2) << 15)
                     for i in range(1, n + 1)]
        self.cnt, self.at, self.have = [0] * N, 0, 0

    def tick(self, cnt):
        v = self.fit(cnt)
        self.at = (self.at + 1) % N
        self.cnt[self.at] = cnt
        self.have = min(self.have + 1, N)
        return v

    def fit(self, cnt):
        d, s0, s1, best, best_m = [], 0, 0, 0, 0
        for n in range(1, min(self.n, self.have) + 1):
            y = wrap(self.cnt[(self.at + 1 - n) % N] - cnt)
            d.append(y)
            s0 += y
            s1 += n * y
            m, c = n * s0 - 2 * s1, n * (n + 1) * (n + 2)
            limit = self.tol * c
            for j, y in enumerate(d, 1):
                if abs(y * c + 6 * j * m) > limit and n > 1:
                    return sat32(times(self.gain[best - 1], best_m))
            best, best_m = n, m
        return sat32(times(self.gain[best - 1], best_m)) if best else 0

    def state(self):
        return self.pack(*self.cnt, self.at, self.have)


class Track:
    pack = Struct("<qqiB").pack

    def __init__(self, step, T, tf_us):
        self.gain = gain(step * T[1], T[0] << 15)
        a = pole_of(tf_us, T)
        self.beta = shr(a * a, 31)
        self.alpha = min(2 * a - self.beta, (1 << 31) - 1)
        self.err = self.vel = self.cnt = self.started = 0

    def tick(self, cnt):
        if not self.started:
            self.cnt, self.started = cnt, 1
        end = 1 << 60
        moved = clamp(wrap(cnt - self.cnt), -(1 << 28), 1 << 28)
        e = clamp(self.err + self.vel - (moved << 32), -end, end)
        self.cnt = cnt
        self.err = e - shr(e * self.alpha, 31)
        self.vel = clamp(self.vel - shr(e * self.beta, 31), -end, end)
        mant, s = self.gain
        return sat32(shr(shr(self.vel * mant, 31), s + 1))

    def state(self):
        return self.pack(self.err, self.vel, self.cnt, self.started)


def run(name, rate, make, small=0):
    rng = Rng(name, rate, 0)
    step = scale(rng)
    est, cnt = None, counts(name, rate, step, small)
    for k in range(TICKS):
        if k in (0, AGAIN):
            est = make(step, period(rate, k), rng)
        yield (cnt[k], est.tick(cnt[k])), est.state()


COLUMNS = "cnt | vel_mps_q27"


def window(rate):
    return run("velocity_window", rate, lambda step, T, rng: Window(step, T, rng.draw(0, 4)))


def pole(rate):
    return run("velocity_pole", rate, lambda step, T, rng: Pole(step, T, tau(rng)))


def foaw(rate):
    def make(step, T, rng):
        return Foaw(step, T, rng.draw(2, 16), rng.draw(1, 255) >> rng.draw(0, 7) or 1)

    return run("velocity_foaw", rate, make, 40)


def track(rate):
    return run("velocity_track", rate, lambda step, T, rng: Track(step, T, tau(rng)))


def tau(rng):
    """A time constant, us: of any size up to a second."""
    return rng.draw(0, 1000000) >> rng.draw(0, 16)


MODULES = {"velocity_window": (COLUMNS, window), "velocity_pole": (COLUMNS, pole),
           "velocity_foaw": (COLUMNS, foaw), "velocity_track": (COLUMNS, track)}
