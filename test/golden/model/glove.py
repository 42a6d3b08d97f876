# SPDX-License-Identifier: MIT
"""glove: 22 codes to 22 angles, faults channel by channel."""

import zlib
from struct import Struct

from .filter import Channel, Config, Quantizer
from .num import AGAIN, TICKS, Rng, clamp, period, sat32, shr, wave

SENSORS = 22
NONE = 255
CROSSED = (3, 10, 14, 18)
GOOD, OPEN, SHORTED, OUTSIDE = range(4)


def any_sensor(rng, i, present):
    """(zero, gain, cross, low, high, of)"""
    low = rng.draw(-30000, 29000)
    high = low + rng.draw(64, 30000 - low)
    zero = rng.draw(-(1 << 30), (1 << 30) - 32768)
    gain = max(1 << 17, rng.draw(1 << 17, (1 << 31) - 1) >> rng.draw(0, 13))
    gain = -gain if rng.draw(0, 1) else gain
    cross, of = [0, 0], [NONE, NONE]
    if i in CROSSED:
        cross = [rng.draw(-(1 << 31), (1 << 31) - 1) for _ in range(2)]
        of = [i - 1, i + 1]
        if rng.draw(0, 3) == 0:
            cross[1], of[1] = 0, NONE
    return zero, gain if present else 0, cross, low, high, of


class Glove:
    angles = Struct("<22i").pack
    sensor = Struct("<qqBiBhHBB").pack

    def __init__(self, par, sensors, present, T):
        (self.order, fc, self.bits, self.hyst, self.low, self.high, self.open_high, self.debounce,
         margin) = par
        self.filter = Config(self.order, fc, T) if self.order else None
        self.sensors, self.span = sensors, []
        for i, s in enumerate(sensors):
            m = shr((s[4] - s[3]) * margin, 16)
            self.span.append((max(s[3] - m, self.low + 1), min(s[4] + m, self.high - 1))
                             if present >> i & 1
                             else (-32768, 32767))
        self.started = 0
        self.good, self.faults, self.run, self.cause = ([0] * SENSORS for _ in range(4))
        self.channel = [None] * SENSORS
        self.quantizer = [Quantizer() for _ in range(SENSORS)]

    def why(self, r):
        if r <= self.low:
            return SHORTED if self.open_high else OPEN
        if r >= self.high:
            return OPEN if self.open_high else SHORTED
        return OUTSIDE

    def believed(self, i, r):
        """The code that goes on for r."""
        bad = not self.span[i][0] <= r <= self.span[i][1]
        if not self.started:
            self.run[i], self.faults[i] = 0, int(bad)
            s = self.sensors[i]
            self.good[i] = clamp(s[0] >> 15, s[3], s[4]) if bad else r
            self.cause[i] = self.why(r) if bad else GOOD
        faulty = self.cause[i] != GOOD
        if bad == faulty:
            self.run[i] = 0
        else:
            self.run[i] += 1
            if self.run[i] >= self.debounce:
                self.run[i], faulty = 0, not faulty
                self.cause[i] = GOOD
                self.faults[i] = min(65535, self.faults[i] + faulty)
        if bad and faulty:
            self.cause[i] = self.why(r)
        elif not bad and not faulty:
            self.good[i] = r
        return self.good[i]

    def believe(self, raw):
        """Mask of faulty sensors, and 22 codes q16."""
        x = [self.believed(i, r) << 16 for i, r in enumerate(raw)]
        if not self.started:
            self.channel = [Channel(v) for v in x]
        self.started = 1
        return sum((c != GOOD) << i for i, c in enumerate(self.cause)), x

    def own(self, i, x):
        """Code q16 to the angle of sensor i alone."""
        if self.filter:
            x = self.channel[i].tick(self.filter, x)
        x = self.quantizer[i].tick(self.bits, self.hyst, x)
        s = self.sensors[i]
        return sat32(shr(((x >> 1) - s[0]) * s[1], 21))

    def cross(self, own, of=CROSSED):
        out = own[:]
        for i in of:
            s = self.sensors[i]
            out[i] = sat32(own[i] +
                           sum(shr(own[a] * c, 30) for c, a in zip(s[2], s[5]) if a != NONE))
        return out

    def tick(self, raw):
        faulty, x = self.believe(raw)
        return faulty, self.cross([self.own(i, v) for i, v in enumerate(x)])

    def state(self):
        sensors = zip(self.channel, self.quantizer, self.good, self.faults, self.run, self.cause)
        return b"".join([self.sensor(c.pos, c.vel, c.wide, q.value, q.started, *rest)
                         for c, q, *rest in sensors]) + bytes([self.started])


def any_par(rng, T):
    """The rows of the glove, in their order."""
    most, least = ((T[1] << 15) - 1) // T[0], (T[1] >> 5) // T[0] + 1
    order, fc = rng.draw(0, 2), max(6553, least, rng.draw(1, most) >> rng.draw(0, 10))
    bits = rng.draw(4, 16)
    return (order, fc, bits, rng.draw(0, 1 << min(28, 32 - bits)), rng.draw(-32768, -31000),
            rng.draw(31000, 32767), rng.draw(0, 1), rng.draw(1, 6),
            rng.draw(0, 65536) >> rng.draw(0, 4))


def frame_period(rate, k, every):
    """The loop's period times so many ticks a frame, which is a second at most."""
    num, den = period(rate, k)
    return num * min(every, (den + num // 2) // num), den


def glove(rate):
    return frames("glove", rate, 1)


def glove_every(rate):
    """Every ratio of frames to ticks that a scene's row `every` takes, 1..1000."""
    return frames("glove_every", rate, 1 + (rate - 1) % 1000)


def frames(name, rate, every):
    rng = Rng(name, rate, 0)
    w = [wave(name, rate, 1 + i, -32768, 32767, 1 << rng.draw(0, 11)) for i in range(4)]
    for k in range(TICKS):
        if k in (0, AGAIN):
            T = frame_period(rate, k, every)
            par = any_par(rng, T)
            present = 0x3FFFFF & ~(1 << (0, 5, 10, 14, 20, 21, 31, 31)[rng.draw(0, 7)])
            sensors = [any_sensor(rng, i, present >> i & 1) for i in range(SENSORS)]
            s, wrong = Glove(par, sensors, present, T), 0
        wrong ^= 1 << rng.draw(0, 21)
        raw = []
        for i, (_, _, _, low, high, _) in enumerate(sensors):
            m = shr((high - low) * par[8], 16)
            good = low + ((w[i & 3][k] + 32768) * (high - low) >> 16)
            past = m + (k & 1)
            bad = -32768, 32767, max(-32768, low - past), min(32767, high + past)
            raw.append(bad[i + (k >> 5) & 3] if wrong >> i & 1 else good)
        faulty, a = s.tick(raw)
        yield (*raw, faulty, a[0], a[3], a[10], a[21], zlib.crc32(s.angles(*a))), s.state()


COLUMNS = (" ".join("raw%d" % i for i in range(SENSORS)) +
           " | faulty angle0_turn_q32 angle3_turn_q32 angle10_turn_q32 angle21_turn_q32 crc_of_22")

MODULES = {"glove": (COLUMNS, glove), "glove_every": (COLUMNS, glove_every)}
