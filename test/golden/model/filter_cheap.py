# SPDX-License-Identifier: MIT
"""filter_cheap: low-pass of several channels, settled anew with each cut-off."""

from struct import Struct

from .filter import ONE, P, PI, SQRT2, rounded, tan
from .num import (CUTOFF, MAX32, MIN32, RANGE, TICKS, Refused, Rng, period, sat32, wave,
                  wrap64)

EDGE = 3 << 26


class Config:
    def __init__(self, order, fc, T):
        num, den = T
        if order != 2 or fc * num <= 0 or den <= 0:
            raise Refused(RANGE)
        if 2 * fc * num >= den << 16:
            raise Refused(CUTOFF)
        if fc * num < (den << 16) >> 21:
            raise Refused(RANGE)
        g = tan((PI * fc * num // den) >> 16)
        whole = ONE + (g * (g + SQRT2) >> P)  # 1 + K
        square = g * g >> P
        self.high = int(rounded_wide(g << 32, ONE) > 7 << 27)
        if self.high:
            a = rounded(abs(ONE - square) << 30, whole)
            self.a = a if square < ONE else -a
            self.b = rounded(square << 29, whole)
            self.c = (1 << 29) - 4 * self.b - self.a
        else:
            self.a = -rounded((SQRT2 * g >> P) << 33, whole)
            self.b = rounded(4 * g << 32, 9 * whole)
            self.c = rounded(square << 64, self.b * whole)

    def row(self):
        return self.high, self.a, self.b, self.c


def rounded_wide(num, den):
    return (2 * num + den) // (2 * den)


class Channel:
    pack = Struct("<qqii").pack

    def __init__(self, f, x):
        self.x1 = self.x2 = x
        self.pos, self.vel = ((x << 32) + (1 << 28), x << 32) if f.high else at_rest(x)

    def tick(self, f, x):
        u = x + 2 * self.x1 + self.x2
        self.x1, self.x2 = x, self.x1
        y = self.pos >> 32
        if f.high:
            left = self.pos % (1 << 29)
            left = left if f.a > EDGE else (1 << 29) - 1 - left if f.a < -EDGE else 1 << 28
            total = left + y * f.a + (self.vel >> 32) * f.c + u * f.b
            self.vel = y << 32
            self.pos = (sat32(total >> 29) << 32) + total % (1 << 29)
        else:
            self.vel = wrap64(self.vel + (self.vel >> 32) * f.a + (u - 4 * y) * f.b)
            self.pos += (self.vel >> 32) * f.c
            if wrap64(self.pos) != self.pos:
                self.pos, self.vel = at_rest(MAX32 if self.pos > 0 else MIN32)
        return self.pos >> 32

    def state(self):
        return self.pack(self.pos, self.vel, self.x1, self.x2)


def at_rest(x):
    return (x << 32) + (1 << 31), 0


CHANNELS = 3


def any_config(rng, T):
    """(error of some cut-off, a configuration that is one)."""
    most = ((T[1] << 15) - 1) // T[0]
    least = (T[1] >> 5) // T[0] + 1
    err, order, fc = 0, rng.draw(0, 2), rng.draw(0, 2 * most) >> rng.draw(0, 12)
    try:
        Config(order, fc, T)
    except Refused as e:
        err = -e.args[0]
    return err, Config(2, max(least, rng.draw(1, most) >> rng.draw(0, 8)), T)


def filter_cheap(rate):
    rng = Rng("filter_cheap", rate, 0)
    x = [wave("filter_cheap", rate, 1 + i, MIN32, MAX32, 1 << rng.draw(8, 28))
         for i in range(CHANNELS)]
    for k in range(TICKS):
        if k % 24 == 0:
            err, f = any_config(rng, period(rate, k))
            s = [Channel(f, w[k]) for w in x]
        yield ([w[k] for w in x] + [err, *f.row()] + [c.tick(f, w[k]) for c, w in zip(s, x)],
               b"".join(c.state() for c in s))


MODULES = {"filter_cheap": ("x0 x1 x2 | err high a b c y0 y1 y2", filter_cheap)}
