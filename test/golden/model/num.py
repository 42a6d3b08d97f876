# SPDX-License-Identifier: MIT
"""The arithmetic of docs/NUMERICS.md in Python's exact integers, and the stimuli of README.md."""

import zlib

TICKS = 256
AGAIN = 192  # at this tick everything is set up anew, at another rate

M32 = 0xFFFFFFFF
M64 = 0xFFFFFFFFFFFFFFFF
MIN32, MAX32 = -(1 << 31), (1 << 31) - 1
MIN64, MAX64 = -(1 << 63), (1 << 63) - 1


# --- docs/NUMERICS.md: "Notation" and "Definitions" ---

def sat32(v):
    return MIN32 if v < MIN32 else MAX32 if v > MAX32 else v


def clamp(v, lo, hi):
    return lo if v < lo else hi if v > hi else v


def shr(v, n):
    """v / 2^n, round half up."""
    return (v + (1 << n >> 1)) >> n


def div(num, den):
    """num / den, round half up."""
    return (2 * num + den) // (2 * den)


def wrap(v):
    """v modulo 2^32 as int32."""
    return ((v + (1 << 31)) & M32) - (1 << 31)


def wrap64(v):
    return ((v + (1 << 63)) & M64) - (1 << 63)


class Refused(Exception):
    """What set-up refuses; the argument is the positive error number."""


RANGE, UNKNOWN, STATE, CRC, VERSION, SHORT, MONOTONE, STALE, CUTOFF = 1, 2, 3, 4, 5, 6, 7, 11, 12


def gain(num, den):
    """num / den as (mant, shift)."""
    if den == 0 or den >= 1 << 63:
        raise Refused(RANGE)
    if num == 0:
        return 0, 1
    if div(num, den) >= 1 << 31 or num << 32 < den:
        raise Refused(RANGE)
    s = max(0, den.bit_length() - num.bit_length() + 29)
    while (num << (s + 1)) // den < 1 << 31:
        s += 1
    mant = div(num << s, den)
    if mant == 1 << 31:
        mant, s = mant >> 1, s - 1
    return mant, s


def times(g, x):
    """The gain times x, one rounding."""
    return (x * g[0] + (1 << g[1] >> 1)) >> g[1]


# --- stimuli: README.md; test/golden/golden.c has the same in C ---

class Rng:
    """splitmix64, one stream of a module and rate."""
    __slots__ = ("state",)

    def __init__(self, module, rate, stream):
        self.state = zlib.crc32(module.encode()) << 32 | stream << 16 | rate

    def u64(self):
        self.state = z = (self.state + 0x9E3779B97F4A7C15) & M64
        z = (z ^ z >> 30) * 0xBF58476D1CE4E5B9 & M64
        z = (z ^ z >> 27) * 0x94D049BB133111EB & M64
        return z ^ z >> 31

    def draw(self, lo, hi):
        """Uniform in lo..hi, hi - lo < 2^32."""
        return lo + ((self.u64() >> 32) * (hi - lo + 1) >> 32)

    def corner(self):
        """An int64: uniform, of any size, or at the ends of an int32 or int64."""
        how, s = self.u64(), wrap64(self.u64())
        if how % 3 == 0:
            return s
        if how % 3 == 1:
            return s >> (how >> 8) % 64
        return wrap64((MIN64, MIN32, 0, MAX32, MAX64)[(how >> 8) % 5] + (s & 3) - 2)


def wave(module, rate, stream, lo, hi, small):
    """256 values in lo..hi."""
    draw = Rng(module, rate, stream).draw
    mid = (lo + hi) >> 1
    x, slope, out = mid, 0, []
    for k in range(TICKS):
        if k < 8:
            x = mid
        elif k < 32:
            x = hi
        elif k < 56:
            x = lo
        elif k < 120:
            if k == 56:
                x, slope = mid, draw(1, small)
            x += slope if k < 88 else -slope
        elif k < 144:
            if k == 120:
                slope = draw(-small, small)
            x = mid + slope + draw(-1, 1)
        elif k < 176:
            x += draw(-small, small)
        elif k < 192:
            x = draw(lo, hi)
        elif k < 200:
            x = mid
        elif k < 216:
            x += draw(-small, small)
        elif k < 232:
            x += small if k < 224 else -small
        elif k < 248:
            x = hi if k & 4 else lo
        else:
            x = draw(lo, hi)
        x = lo if x < lo else hi if x > hi else x
        out.append(x)
    return out


def period(rate, k):
    """The loop's period from tick k on: 1/rate, then a divider of a PC's timer."""
    if k < AGAIN:
        return 1, rate
    other = 1 + rate * 797 % (2000 if rate <= 2000 else 20000)
    return (1193182 + other // 2) // other, 1193182
