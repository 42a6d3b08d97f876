# SPDX-License-Identifier: MIT
"""quad: extension of a counter, position, and the decoder of two lines."""

from struct import Struct

from .num import AGAIN, M32, RANGE, TICKS, Refused, Rng, gain, period, sat32, shr, times, wave, wrap
from .velocity import scale


class Quad:
    pack = Struct("<IiBB").pack

    def __init__(self, step, speed, T, bits):
        fast = times(gain(T[0] << 15, T[1] * step), speed)
        if fast >= 1 << (bits - 2):
            raise Refused(RANGE)
        self.jump, self.bits = fast + 1, bits
        self.raw = self.cnt = self.started = self.lost = 0

    def tick(self, raw):
        moved = (raw - self.raw) << (32 - self.bits)
        moved = wrap(moved) >> (32 - self.bits)
        self.raw = raw
        if not self.started:
            self.started = 1
        elif abs(moved) > self.jump:
            self.lost = 1
        else:
            self.cnt = wrap(self.cnt + moved)
        return self.cnt

    def state(self):
        return self.pack(self.raw, self.cnt, self.started, self.lost)


def position(cnt, step):
    return sat32(shr(cnt * step, 12))


def narrowest(step, speed, T):
    """The narrowest counter, of 16, 20, 24, 28 or 32 bits, that set-up takes."""
    for bits in (16, 20, 24, 28, 32):
        try:
            return Quad(step, speed, T, bits), bits
        except Refused:
            pass


def quad(rate):
    rng = Rng("quad", rate, 0)
    step = scale(rng)
    for k in range(TICKS):
        if k in (0, AGAIN):
            speed = rng.draw(13421773, (1 << 31) - 1)
            q, bits = narrowest(step, speed, period(rate, k))
            moves = wave("quad", rate, 1 + (k > 0), -q.jump, q.jump, max(1, q.jump >> 4))
            raw = rng.u64() & M32
        raw += moves[k]
        if 184 <= k < AGAIN:  # some of them too fast
            raw += rng.draw(-q.jump, q.jump)
        # above the counter's width is nothing
        shown = raw & (1 << bits) - 1 | rng.u64() << bits & M32
        cnt = q.tick(shown)
        yield ((shown, bits, q.jump, cnt, position(cnt, step), position(wrap(shown), step)),
               q.state())


QUAD = "raw | bits jump_cnt cnt pos_m_q30 pos_of_raw_m_q30"

class Lines:
    """The decoder; mode 1, 2 or 4."""
    pack = Struct("<iIIBB").pack

    def __init__(self, mode):
        self.mode = mode
        self.cnt = self.edges = self.illegal = self.ab = self.started = 0

    def samples(self, several):
        before = self.ab
        for ab in several:
            if not self.started:
                before, self.started = ab, 1
            m = (ab ^ ab >> 1) - (before ^ before >> 1) & 3
            changed_a = (ab ^ before) & 2
            before = ab
            if m == 2:
                self.illegal = (self.illegal + 1) & M32
            elif m:
                self.edges = (self.edges + 1) & M32
                if self.mode == 4 or changed_a and (self.mode == 2 or ab & 1):
                    self.cnt = wrap(self.cnt + (1 if m == 1 else -1))
        self.ab = before

    def state(self):
        return self.pack(self.cnt, self.edges, self.illegal, self.ab, self.started)


class Index:
    pack = Struct("<iIBB").pack

    def __init__(self):
        self.cnt = self.seen = self.level = self.started = 0

    def tick(self, cnt, level):
        if self.started and level and not self.level:
            self.seen, self.cnt = (self.seen + 1) & M32, cnt
        self.level, self.started = level, 1

    def state(self):
        return self.pack(self.cnt, self.seen, self.level, self.started)


def quad_ab(rate):
    """16 samples a tick; one decoder takes them 64 at a time."""
    rng, place = Rng("quad_ab", rate, 0), 0
    for k in range(TICKS):
        if k in (0, AGAIN):
            x1, x2, x4, word, index = Lines(1), Lines(2), Lines(4), Lines(4), Index()
            waiting = []
        way, bits, several = -1 if k & 16 else 1, rng.u64(), []
        for i in range(16):
            n = bits >> 4 * i & 15
            place += 0 if n < 2 else 2 if n == 2 else -way if n == 3 else way
            several.append(place & 3 ^ (place & 3) >> 1)
        for s in (x1, x2, x4):
            s.samples(several)
        if k == 0:  # near their ends
            x4.cnt, x4.edges, x4.illegal = (1 << 31) - 20, M32 - 20, M32 - 3
        waiting += several
        if k % 4 == 3:
            word.samples(waiting)
            waiting = []
        level = rng.draw(0, 1)
        index.tick(x4.cnt, level)
        yield ((sum(ab << 2 * i for i, ab in enumerate(several)), level, x1.cnt, x2.cnt, x4.cnt,
                x4.edges, x4.illegal, word.cnt, index.cnt),
               b"".join(s.state() for s in (x1, x2, x4, word, index)))


QUAD_AB = "ab_of_16 index | x1 x2 x4 edges illegal x4_by_word latched"

MODULES = {"quad_ab": (QUAD_AB, quad_ab), "quad": (QUAD, quad)}
