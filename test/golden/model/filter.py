# SPDX-License-Identifier: MIT
"""filter and quantizer: low-pass of several channels, and codes that stay constant."""

from struct import Struct

from .num import (AGAIN, CUTOFF, MAX32, MIN32, RANGE, TICKS, Refused, Rng, clamp, period, sat32,
                  shr, wave, wrap64)

P = 256  # fraction bits of what the document calls real numbers
ONE = 1 << P


def arctan_of_inverse(n):
    total, term, k = 0, ONE * 4 // n, 1
    while term:
        total += term // k if k & 2 == 0 else -(term // k)
        term, k = term // (n * n), k + 2
    return total


def isqrt(n):
    x = 1 << (n.bit_length() + 1) // 2
    while True:
        y = (x + n // x) >> 1
        if y >= x:
            return x
        x = y


PI = 4 * arctan_of_inverse(5) - arctan_of_inverse(239)
SQRT2 = isqrt(2 << 2 * P)


def tan(x):
    """Of 0 < x < pi/2, all in fractions of ONE."""
    s, c, term, k = 0, 0, ONE, 0
    while term:
        if k & 1:
            s += term if k & 2 == 0 else -term
        else:
            c += term if k & 2 == 0 else -term
        k += 1
        term = (term * x >> P) // k
    return (s << P) // c


def rounded(num, den=ONE):
    """A coefficient: nearest, 2^31 - 1 at most."""
    return min(MAX32, (2 * num + den) // (2 * den))


def scaled(v, n):
    return v << n if n >= 0 else v >> -n


LOW2, LOW1, HIGH2, HIGH1 = range(4)


class Config:
    """Kind, shift and a, b, c; 0 what its kind has not."""

    def __init__(self, order, fc, T):
        num, den = T
        if order not in (1, 2) or fc * num <= 0 or den <= 0:
            raise Refused(RANGE)
        if 2 * fc * num >= den << 16:
            raise Refused(CUTOFF)
        if fc * num < (den << 16) >> 21:
            raise Refused(RANGE)
        g = tan((PI * fc * num // den) >> 16)
        k = g * (g + SQRT2) >> P
        high = (2 * (g << 32) + ONE) // (2 * ONE) > 11 << 27
        self.kind = (HIGH2 if high else LOW2) if order == 2 else (HIGH1 if high else LOW1)
        self.a = self.b = self.c = self.shift = 0
        if self.kind == LOW2:
            self.c = rounded(23 * g << 31, 16 * ONE)
            alpha = (g * g << 31) // ((ONE + k) * self.c)
            beta = (k << P) // (ONE + k)
            n = 0
            while scaled(alpha, n + 1) < ONE << 30 and scaled(beta, n + 1) < ONE << 31:
                n += 1
            self.a, self.b = min((1 << 30) - 1, rounded(scaled(alpha, n))), rounded(scaled(beta, n))
            self.shift = n - 32
        elif self.kind == LOW1:
            gamma, n = (g << P) // (ONE + g), 0
            while scaled(gamma, n + 1) < ONE << 30:
                n += 1
            self.a, self.shift = rounded(scaled(gamma, n)), n - 31
        elif self.kind == HIGH2:
            self.a = rounded((g * g >> P) << 31, ONE + k)
            self.b = rounded(ONE << 31, ONE + k)
        else:
            self.a = rounded(g << 31, ONE + g)

    def row(self):
        return self.kind, self.a, self.b, self.c, self.shift


class Channel:
    pack = Struct("<qqB").pack

    def __init__(self, x):
        self.pos, self.vel, self.wide = (x << 31) + (1 << 30), 0, 0

    def tick(self, f, x):
        pos, vel = self.pos, self.vel
        if f.kind == LOW2:
            v = ((x - (pos >> 31)) * f.a - (vel >> 32) * f.b) >> f.shift
            p = vel + v
            m = (p >> 32) * f.c
            l = pos + m
            self.vel, self.pos = p + v, l + m
            return sat32(l >> 31)
        if f.kind == LOW1:
            m = (x - (pos >> 31)) * f.a >> f.shift
            l = pos + m
            self.pos = l + m
            return sat32(l >> 31)
        if not self.wide:
            self.pos, self.wide = pos >> 9, 1
        pos = self.pos
        e = wrap64((x << 22) + (1 << 21) - pos)
        move = 4 * (e * f.a + (self.vel * f.b if f.kind == HIGH2 else 0) >> 32)
        self.pos = wrap64(pos + move)
        if f.kind == HIGH2:
            self.vel = wrap64(move - self.vel)
        twice = wrap64(pos + self.pos)
        y = sat32(twice >> 23)
        if abs(twice) > 1 << 56:
            self.__init__(y)
        return y

    def retune(self, before, f):
        if before.kind != f.kind or f.kind & 1 or (f.kind == HIGH2 and f.a < before.a):
            self.vel = 0
        if f.kind in (LOW2, LOW1) and self.wide:
            self.pos, self.wide = clamp(self.pos, -(1 << 53), 1 << 53) << 9, 0

    def state(self):
        return self.pack(self.pos, self.vel, self.wide)


CHANNELS = 3


def any_config(rng, T):
    """(error of some cut-off, a configuration that is one)."""
    most = ((T[1] << 15) - 1) // T[0]
    least = (T[1] >> 5) // T[0] + 1
    order, fc = (rng.draw(1, 2),
                 rng.draw(0, 2 * most) >> rng.draw(0, 26 if rng.draw(0, 2) == 0 else 1))
    try:
        return 0, Config(order, fc, T)
    except Refused as e:
        fc = max(least, rng.draw(1, most) >> rng.draw(0, 8))
        return -e.args[0], Config(order, fc, T)


def filter_(rate):
    rng = Rng("filter", rate, 0)
    x = [wave("filter", rate, 1 + i, MIN32, MAX32, 1 << rng.draw(8, 28)) for i in range(CHANNELS)]
    for k in range(TICKS):
        if k % 16 == 0:
            before = None if k in (0, AGAIN) else f
            err, f = any_config(rng, period(rate, k))
            if before is None:
                s = [Channel(w[k]) for w in x]
            else:
                for c in s:
                    c.retune(before, f)
        yield ([w[k] for w in x] + [err, *f.row()] + [c.tick(f, w[k]) for c, w in zip(s, x)],
               b"".join(c.state() for c in s))


FILTER = "x0 x1 x2 | err kind a b c shift y0 y1 y2"


class Quantizer:
    pack = Struct("<iB").pack

    def __init__(self):
        self.value = self.started = 0

    def tick(self, bits, hyst, x):
        q = 1 << (32 - bits)
        if not self.started or abs(x - self.value) > q // 2 + hyst // 2:
            self.value, self.started = q * min(shr(x, 32 - bits), (1 << (bits - 1)) - 1), 1
        return self.value

    def state(self):
        return self.pack(self.value, self.started)


def quantizer(rate):
    rng = Rng("quantizer", rate, 0)
    x = wave("quantizer", rate, 1, MIN32, MAX32, 1 << rng.draw(4, 30))
    for k in range(TICKS):
        if k in (0, AGAIN):
            s = Quantizer()
        if k % 32 == 0:
            bits = rng.draw(1, 24)
            hyst = min(MAX32, rng.draw(0, 1 << (32 - bits)))
            other, other_hyst = rng.draw(0, 25), rng.draw(-1, 1 << 24)
            err = 0 if 1 <= other <= 24 and 0 <= other_hyst <= 1 << (32 - other) else -RANGE
        q = 1 << (32 - bits)
        v = x[k]
        if k & 1:  # at the edge of what is kept, if there is one
            v = sat32(s.value + rng.draw(-1, 1) * (q // 2 + hyst // 2 + rng.draw(0, 1)))
        yield (v, bits, hyst, other, other_hyst, err, s.tick(bits, hyst, v)), s.state()


QUANTIZER = "x bits hyst other_bits other_hyst | other_err value"

MODULES = {"filter": (FILTER, filter_), "quantizer": (QUANTIZER, quantizer)}
