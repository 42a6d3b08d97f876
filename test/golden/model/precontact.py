# SPDX-License-Identifier: MIT
"""precontact: distance to a plane sent, q_lim frozen before contact; advice."""

from struct import Struct

from .num import AGAIN, MAX32, MIN32, RANGE, TICKS, Rng, clamp, div, period, sat32, shr, wave
from .hand import any_turn

FINGERS = 4
NEVER = MAX32
UNTOLD, NONE, HIT = range(3)
IDLE, INSIDE, TRACK, FROZEN = range(4)
STANDS, TRACKS, AROUND, STALE, BENT, FREEZE, RELEASE, BLIND, DOUBT, LETGO, LATE = (
    1 << i for i in range(11))
TOUCH, RUNS_OUT = -8, 1342177  # LSB of d; of velocity, 0.01 m/s
RESTORED = 100  # the first tick after the state was read back
NO_PLANE = 0, (0, 0, 0), 0, 0


def dot(a, b):
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


def inverse(g):
    """1/g, both q24."""
    sh = 31 - g.bit_length()
    m = g << sh
    y = 3031741621 - (m * 2021161080 >> 31)
    for _ in range(3):
        y += y * (((1 << 61) - m * y) >> 31) >> 30
    return shr(y, 13 - sh)


class Par:
    """Of one finger; the options are the bits of its number."""

    def __init__(self, rng, f, rate):
        self.from_slope, self.printed_sign = f & 1, f >> 1 & 1
        self.again(rng)
        self.age_max = max(1, rng.draw(2, 60) * 1000 // rate)
        self.doubt_max = max(1, rng.draw(1, 3) * 1000 // rate)
        self.tip_age_max = max(1, rng.draw(1, 8) * 1000 // rate)
        self.pad, self.materials = rng.draw(0, 26843545), rng.draw(1, 3)

    def again(self, rng):
        """What may change without set-up."""
        self.d_lim = rng.draw(107375, 214748364)
        self.d_lim = -max(107375, self.d_lim >> rng.draw(0, 4))
        self.hyst = rng.draw(0, 53687091)
        self.hyst >>= rng.draw(0, 3)
        self.scale = rng.draw(1 << 21, 1 << 27)
        self.doubt = rng.draw(0, 53687091)
        self.doubt >>= rng.draw(0, 6)


class Finger:
    plane = Struct("<q3iHB").pack
    first, last = Struct("<5iB").pack, Struct("<9I2i4B").pack

    def __init__(self):
        self.d, self.lim, self.taken, self.phase = 0, 0, (0, 0, 0), IDLE
        self.newest = self.held = NO_PLANE
        self.left = self.frozen = self.born = self.refused = self.ignored = self.stale = 0
        self.doubts = self.let_go = 0
        self.late_n = self.late_d = self.ahead = self.met = self.near = self.late = self.told = 0
        self.resumed = False

    def setup(self, par, T):
        self.par, self.materials = par, par.materials
        self.pad = (-par.pad if par.printed_sign else par.pad) << 30
        self.age_ticks, self.doubt_ticks, self.tip_ticks = (
            ms * T[1] // (1000 * T[0]) + 1 for ms in (par.age_max, par.doubt_max, par.tip_age_max))

    def tell(self, kind, material, number, n, point, age):
        if kind == UNTOLD:
            return 0
        if (kind > HIT or kind == HIT and
            (material >= self.materials or abs(dot(n, n) - (1 << 60)) > 1 << 44)):
            self.refused += 1
            return -RANGE
        before, self.newest, self.left = self.newest, NO_PLANE, 0
        if kind == NONE:
            self.met = 1
        if kind == HIT:
            self.newest = dot(n, point) + self.pad + (1 << 29), tuple(n), number, material
            self.left = max(0, self.age_ticks - age)
        again = self.left and self.told and self.newest[2] == before[2]
        self.told = 2 if again else int(self.left > 0)
        if self.phase == FROZEN:
            self.ignored += self.newest != self.held
        elif self.left == 0 or self.newest[2] != before[2]:
            self.phase = IDLE
        return 0

    def scale(self, slope):
        """s and its bit."""
        if not self.par.from_slope:
            return self.par.scale, 0
        want = shr(-dot(self.newest[1], slope), 30)
        g = clamp(want, 1 << 21, 1 << 27)
        return inverse(g), BENT if g != want else 0

    def skip(self, missed):
        self.left = max(0, self.left - missed)
        if self.doubts:
            self.doubts = min(self.doubts + missed, (1 << 32) - 1)

    def step(self, tip, slope, age, pos, touching, material, pulls, vel):
        blind = age >= self.tip_ticks
        self.met = self.met if pulls else 0
        bits = self.phases(tip, slope, blind, pos, touching, material, pulls, vel)
        self.resumed = False
        bits |= LATE if self.late else 0
        return bits | (0, AROUND, TRACKS, STANDS)[self.phase] | (BLIND if blind else 0)

    def until(self):
        """The d below which q_lim moves along."""
        if self.phase == TRACK and not self.near:
            return self.par.d_lim
        return clamp(-self.par.hyst if self.phase == INSIDE else 0, self.par.d_lim, TOUCH)

    def freeze(self, material, pos):
        self.ahead = sat32(self.lim - pos)
        self.held, self.phase = self.newest, FROZEN
        self.taken = material[self.held[3] if self.held[3] < self.materials else 0]
        self.frozen += 1
        return FREEZE

    def phases(self, tip, slope, blind, pos, touching, material, pulls, vel):
        left = min(self.left, self.age_ticks)
        self.left = max(0, left - 1)
        par, bits, doubts = self.par, 0, self.doubts
        self.doubts = 0
        if self.phase == FROZEN:
            self.d = sat32((self.held[0] - dot(self.held[1], tip)) >> 30)
            free = (0 if self.near else par.d_lim) - par.hyst
            if blind or touching and self.d < free - par.doubt:
                self.doubts = min(doubts + 1, (1 << 32) - 1)
                if self.doubts <= self.doubt_ticks:
                    return DOUBT
                self.let_go += 1
                self.lim, self.phase, self.late = NEVER, IDLE, 0
                return RELEASE | DOUBT | LETGO
            back = self.lim - pos > self.ahead - par.d_lim
            if touching or self.d >= free and not back:
                return 0
            self.phase, bits = IDLE, RELEASE
        self.late = 0
        if left == 0 or blind:
            self.d, self.lim = MIN32, NEVER
            if left == 0 and self.newest[1] != (0, 0, 0):
                bits |= STALE
                self.stale += self.phase == TRACK
            self.phase = IDLE
            return bits
        self.d = sat32((self.newest[0] - dot(self.newest[1], tip)) >> 30)
        s, bent = self.scale(slope)
        lim = sat32(pos - shr(s * self.d, 24))
        if self.d < self.until():
            self.near, self.met = int(self.d >= par.d_lim), int(pulls != 0)
            self.lim, self.phase = lim, TRACK
            return bits | bent
        if self.phase == TRACK and not (self.resumed and pos >= self.lim):
            return bits | self.freeze(material, pos)
        if (self.phase == IDLE and self.met and not self.resumed and vel > RUNS_OUT and
            (self.told < 2 or not bent and pos - lim <= 2 * self.d)):
            if self.told < 2:
                self.lim = NEVER
                return bits | AROUND
            self.late_n, self.late_d, self.late, self.near = self.late_n + 1, self.d, 1, 0
            self.lim = lim
            return bits | self.freeze(material, pos)
        self.born += self.phase != INSIDE
        self.lim, self.phase = NEVER, INSIDE
        return bits

    def state(self):
        return (self.first(self.d, self.lim, *self.taken, self.phase) +
                b"".join(self.plane(p[0], *p[1], p[2], p[3]) for p in (self.newest, self.held)) +
                self.last(self.left, self.frozen, self.born, self.refused, self.ignored, self.stale,
                          self.doubts, self.let_go, self.late_n, self.late_d, self.ahead, self.met,
                          self.near, self.late, self.told))


# --- requests at set-up ---

SPOILT = 22


def refused(how):
    """What set-up says of parameters of which one is changed: of 0 none, of 1 one that stays in
    range."""
    return 0 if how < 2 else -RANGE


def ceil(num, den):
    return -(-num // den)


def advise(T, v, lag, noise, age, v_object, slide, radius, d_lim):
    """(result, d_lim, ray, error, speed)"""
    bad = -RANGE, 0, 0, 0, 0
    if (min(v, lag, noise, age, v_object, slide, radius) < 0 or max(lag, age) > 2000000 or
        d_lim >= 0):
        return bad
    tick, lag, age = ceil(10 ** 9 * T[0], T[1]), 1000 * lag, 1000 * age
    way = lambda v, t: ceil(v * t, 125000000)
    need = way(v, tick + lag) + noise
    ray = way(v, tick + age) + noise - d_lim
    error = way(v_object, age) + (ceil(slide * slide, 2 * radius) if radius else 0)
    if max(need, ray, error) > MAX32:
        return bad
    return 0, -need, ray, error, clamp((-d_lim - noise) * 125000000 // (tick + lag), 0, MAX32)


def any_need(rng):
    v = rng.draw(0, MAX32)
    v >>= rng.draw(0, 12)
    lag = rng.draw(0, 2000000)
    lag >>= rng.draw(0, 12)
    noise = rng.draw(0, 1 << 22)
    age = rng.draw(0, 2000000)
    age >>= rng.draw(0, 12)
    v_object = rng.draw(0, MAX32)
    v_object >>= rng.draw(0, 12)
    slide = rng.draw(0, 1 << 30)
    slide >>= rng.draw(0, 8)
    radius = rng.draw(1, 1 << 29) if rng.draw(0, 3) else 0
    need = [v, lag, noise, age, v_object, slide, radius, -rng.draw(1, 1 << 28)]
    bad = rng.draw(0, 31)
    if bad < 7:
        need[bad] = -1
    elif bad < 10:
        need[(1, 3, 7)[bad - 7]] = (2000001, 2000001, 0)[bad - 7]
    return need


# --- the world ---

def any_object(rng):
    """(normal, point, number, material)"""
    (c1, s1, d1), (c2, s2, d2) = any_turn(rng), any_turn(rng)
    n = [div(v << 30, d1 * d2) for v in (c1 * c2, s1 * c2, s2 * d1)]
    point = [rng.draw(-(1 << 28), 1 << 28) for _ in range(3)]
    return n, point, rng.draw(0, 65535), rng.draw(0, 2)


def any_material(rng):
    return rng.draw(0, 1024000000), rng.draw(0, 1048576000), rng.draw(0, 104857600)


def any_told(rng, finger, objects, at, f):
    """A plane as sent, and its age. The finger may go on to another object."""
    how = rng.draw(0, 31)
    if how == 27:
        at[f] = rng.draw(0, 3)
    normal, point, number, material = objects[at[f]]
    n, point, material, kind = normal[:], point[:], material % finger.materials, HIT
    if how < 10:
        kind = UNTOLD
    elif how == 24:
        kind = NONE
    elif how in (23, 25):
        i = rng.draw(0, 2)
        n[i] += rng.draw(-24576, 24576)
    elif how == 26:
        material = finger.materials + rng.draw(0, 2)
    elif how == 28:
        i = rng.draw(0, 2)
        point[i] += rng.draw(-(1 << 26), 1 << 26)
    elif how == 30:
        kind = rng.draw(3, 255)
    elif how == 31:
        number ^= 1
    age = (rng.draw(max(0, finger.age_ticks - 1), finger.age_ticks + 2) if how == 29
           else rng.draw(0, 3))
    return kind, material, number, n, point, age


def any_in(rng, k, obj, finger, d):
    """(fingertip, slope, touching, age, pulls, velocity), about d before the object, now and then
    about d_lim."""
    n, point = obj[:2]
    if rng.draw(0, 1) == 0:
        d = (finger.par.d_lim - (finger.pad >> 30) -
             rng.draw(-(1 << 16), 2 * finger.par.hyst + 2 * finger.par.doubt))
    tip = [sat32(p - (a * d >> 30)) for a, p in zip(n, point)]
    if (176 <= k < AGAIN or k >= 248) and rng.draw(0, 1):
        tip = [rng.draw(MIN32, MAX32) for _ in range(3)]
    g = rng.draw(0, 1 << 28)
    g >>= rng.draw(0, 8)
    slope = [-(a * g >> 30) + rng.draw(-65536, 65536) for a in n]
    if rng.draw(0, 15) == 0:
        slope = [rng.draw(MIN32, MAX32) for _ in range(3)]
    touching = rng.draw(1, 255) if rng.draw(0, 1) == 0 else 0
    age = finger.tip_ticks + rng.draw(0, 2) - 1 if rng.draw(0, 7) == 0 else 0
    pulls = int(rng.draw(0, 15) != 0)
    vel = rng.draw(-RUNS_OUT, 3 * RUNS_OUT)
    return tip, slope, touching, age, pulls, vel


def precontact(rate):
    rng = Rng("precontact", rate, 0)
    way = [wave("precontact", rate, 1 + f, -214748364, 1 << 25, 1 << rng.draw(16, 23))
           for f in range(FINGERS)]
    pos = [wave("precontact", rate, 5 + f, MIN32, MAX32, 1 << 24) for f in range(FINGERS)]
    for k in range(TICKS):
        T = period(rate, k)
        if k in (0, AGAIN):
            finger, at = [Finger() for _ in range(FINGERS)], [0] * FINGERS
            objects = [any_object(rng) for _ in range(4)]
        if k % 32 == 0:
            material = [any_material(rng) for _ in range(3)]
        for f, s in enumerate(finger):
            if k % 64 == 0 or k % 76 == 8:  # 8 and 236: just before a step to the far rail
                s.setup(Par(rng, f, rate), T)
            elif k % 32 == 0:
                s.par.again(rng)
        said, row = refused(rng.draw(0, SPOILT - 1)), []
        for f, s in enumerate(finger):
            told = any_told(rng, s, objects, at, f)
            tip, slope, touching, tip_age, pulls, vel = any_in(rng, k, objects[at[f]], s, way[f][k])
            if rng.draw(0, 2) == 0:
                s.skip(rng.draw(0, 4))
            s.resumed = k == RESTORED
            err = s.tell(*told)
            bits = s.step(tip, slope, tip_age, pos[f][k], touching, material, pulls, vel)
            if rng.draw(0, 7) == 0:
                s.met = 0
            if rng.draw(0, 3) == 0:
                s.late = 0
            row.append((told[0], told[5], touching, err, bits, s.d, s.lim))
        yield ((*(v[i] for i in range(7) for v in row), said, *advise(T, *any_need(rng))),
               b"".join(s.state() for s in finger))


def columns(*names):
    return " ".join("%s%d" % (n, f) for n in names for f in range(FINGERS))


PRECONTACT = (columns("kind", "age", "touching") + " | " + columns("told", "bits", "d", "lim") +
              " setup advise d_lim_m_q30 ray_m_q30 error_m_q30 speed_mps_q27")

MODULES = {"precontact": (PRECONTACT, precontact)}
