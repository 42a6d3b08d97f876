# SPDX-License-Identifier: MIT
"""The scene bilateral: the models of all its modules put together, and the world's packets."""

import zlib
from struct import Struct, pack, unpack_from

from . import precontact as pre
from .chatter import Chatter, any_par as any_chatter
from .contact import Contact
from .drive import SLEW, Drive, Table, any_par as any_drive
from .filter import Channel
from .glove import CROSSED, NONE as NO_SENSOR, SENSORS, Glove, any_par as any_glove
from .guard import Rail, Supply, any_supply
from .hand import any_turn, joints
from .hit2 import BENT, MAP, bones, sensors_of
from .num import (AGAIN, M32, M64, MAX32, RANGE, STATE, TICKS, UNKNOWN, Rng, clamp, div, period,
                  gain, sat32, shr, times, wave, wrap)
from .quad import Quad, narrowest, position
from .safety import ENCODER, FAULT, GLOVE, HEALTHY, LINK, SUPPLY, TRACKING, Safety, any_safety
from .trace import Trace
from .track import Monitor, Track, any_par as any_track
from .velocity import Window, scale
from .watch import Watch, any_par as any_watch
from .wire import ACK, HELLO, PARAM, PLANES, TELL, TRACE, TRACE_ASK, Receiver, Sender

FINGERS, MATERIALS, ROOM, LATE = 5, 8, 8, 4
SIGNALS = FINGERS * (8 + 17) + 22
# of the library, and of the parameters: not these, which may change
VERSION, TABLE = 0x00010203, 0x89ABCDEF


def any_size(rng, most):
    return rng.draw(0, most) >> rng.draw(0, 12)


def any_ms(rng, lo, hi, rate):
    """So many ticks in ms, 1 .. 60000."""
    return clamp(rng.draw(lo, hi) * 1000 // rate, 1, 60000)


class FingerPar:
    """Drawn in this order; the part of precontact is what its model wants."""

    def __init__(self, rng, rate):
        self.step, self.speed, self.p = scale(rng), rng.draw(13421773, MAX32), rng.draw(0, 4)
        self.f0 = any_size(rng, 20971520), any_size(rng, 10737418), any_size(rng, 10737418)
        self.drive, self.track, self.watch = (any_drive(rng, rate), any_track(rng, rate),
                                              any_watch(rng, rate))
        self.kf = rng.draw(104858, 104857600)
        self.chatter = any_chatter(rng)
        self.arms = rng.draw(4294968, 53687091), rng.draw(0, 53687091), rng.draw(0, 53687091)
        self.pad, self.materials = rng.draw(0, 26843545), MATERIALS
        self.from_slope, self.printed_sign = rng.draw(0, 1), rng.draw(0, 1)
        self.d_lim, self.hyst = -rng.draw(1 << 22, 1 << 25), rng.draw(0, 1 << 22)
        self.scale = rng.draw(1 << 21, 1 << 27)
        self.age_max = any_ms(rng, 20, 120, rate)
        self.doubt, self.doubt_max = rng.draw(0, 1 << 23), any_ms(rng, 1, 20, rate)
        self.tip_age_max = any_ms(rng, 1, 12, rate)
        self.late_slew = rng.draw(1, 100000)


def any_sensor(rng, i):
    low, high = rng.draw(-24000, -8000), rng.draw(8000, 24000)
    zero, gain = rng.draw(-(8000 << 15), 8000 << 15), rng.draw(1500000, 4000000)
    gain = gain if rng.draw(0, 7) else -gain
    if i in (3, 10, 14, 18):
        return (zero, gain, [rng.draw(-(1 << 28), 1 << 28) for _ in range(2)], low, high,
                [i - 1, i + 1])
    return zero, gain, [0, 0], low, high, [NO_SENSOR, NO_SENSOR]


class Par:
    def __init__(self, rng, rate, T):
        self.fingers, self.state_every = rng.draw(1, 31), rng.draw(1, 12)
        self.session, self.quiet = rng.draw(1, MAX32), rng.draw(100, 2000)
        self.f0_rest = any_ms(rng, 1, 12, rate)
        self.glove_time = any_ms(rng, 4, 10, rate) if rng.draw(0, 15) else 0
        self.link_time = any_ms(rng, 10, 14, rate) if rng.draw(0, 15) else 0
        self.every = rng.draw(1, 8 if T[0] < T[1] else 4)  # below 0.25 Hz, no cutoff is legal
        self.finger = [FingerPar(rng, rate) for _ in range(FINGERS)]
        self.material = [[any_size(rng, m) for m in (1024000000, 1048576000, 104857600)]
                         for _ in range(MATERIALS)]
        self.safety = any_safety(rng, rate)
        if rng.draw(0, 3):  # most arm
            self.safety = (self.safety[0], 10485760, *self.safety[2:])
        self.supply = any_supply(rng, rate, 31)
        self.glove = any_glove(rng, (T[0] * self.every, T[1]))
        self.sensor = [any_sensor(rng, i) for i in range(SENSORS)]


# --- parameters over the link: materials are the world's, and nothing else ---

MOST = {0x0B01: 1024000000, 0x0B02: 1048576000, 0x0B03: 104857600}
# how many of each, and their ranges
OWN = {0x0C01: (FINGERS, -214748364, -107374), 0x0C02: (FINGERS, 0, 53687091),
       0x0C03: (FINGERS, 2097152, 134217728), 0x0C04: (FINGERS, 0, 1), 0x8611: (1, 1, 10000),
       0x8612: (1, 0, MAX32), 0x0401: (FINGERS, 0, 1024000000), 0x0501: (FINGERS, 0, 104857600)}


class Params:
    """What was staged since it was applied."""

    def __init__(self, par):
        self.par, self.staged = par, {}

    def stage(self, ident, n, raw, state):
        """Outside OFF and FAULT no value of a material rises."""
        own, lo, hi = OWN.get(ident, (0, 0, 0))
        if n < own:
            return -STATE if lo <= raw <= hi else -RANGE
        if ident not in MOST or n >= MATERIALS:
            return -UNKNOWN
        if not 0 <= raw <= MOST[ident]:
            return -RANGE
        was = self.staged.get((ident, n), self.par.material[n][ident - 0x0B01])
        if state not in (0, 5) and raw > was:
            return -STATE
        self.staged[ident, n] = raw
        return 0

    def apply(self):
        for (ident, n), raw in self.staged.items():
            self.par.material[n][ident - 0x0B01] = raw
        self.staged = {}


class Finger:
    where = Struct("<iI9iB").pack

    def __init__(self, f, par, T, bits):
        self.f, self.par, self.sensors = f, par, sensors_of(f)
        self.quad, self.velocity = None, Window(par.step, T, par.p)
        if bits:
            self.quad = Quad(par.step, par.speed, T, bits)
        self.hand = bones(f, par.arms)
        self.hand.follow(MAP[f], BENT[f])
        self.pull = self.hand.pull
        self.contact, self.pre = Contact(), pre.Finger()
        self.pre.setup(par, T)
        peak = par.drive[3]
        top = sat32(shr(par.kf * peak, 26))
        self.chatter = Chatter(par.chatter, (top, peak), par.step, T)
        self.drive = Drive(par.drive, T, Table([(0, 0), (top, peak)]),
                           Table([(-peak, -top), (peak, top)]))
        self.slew_up = self.drive.up
        self.late_up = max(1, times(gain(T[0] << 20, T[1]), par.late_slew))
        self.track, self.last, self.monitor = Track(par.track, T), 0, Monitor()
        self.joint, self.tip, self.slope, self.clamped = [0] * 3, [0] * 3, [0] * 3, 0
        self.watch, self.cnt = Watch(par.watch, T), 0
        self.out = self.rest = 0

    def wind_in(self, ticks):
        """A string that has run out no farther for so long counts as running in."""
        c = self.contact
        if c.touching or c.inward or c.turn != self.out:
            self.rest = 0
        elif self.rest < ticks:
            self.rest += 1
        else:
            c.inward = 1
        self.out = c.turn

    def see(self, angle):
        self.clamped, self.joint = joints(MAP[self.f], angle)
        self.hand.pull = [0 if self.clamped >> 1 + i & 1 else v for i, v in enumerate(self.pull)]
        self.tip, slope = self.hand.tip_slope(self.joint)
        if self.par.from_slope:
            self.slope = slope

    def feel(self, age, permit, materials, rest_ticks, q, v):
        """(bits, d, q_lim, c, limits, force, current)"""
        bits = self.pre.step(self.tip, self.slope, age, q, self.contact.touching, materials,
                             permit[0] == 1, v)
        d, lim = self.pre.d, self.pre.lim
        self.pre.taken = k, b, most = tuple(self.pre.taken)  # it keeps what it took
        own = self.par.drive[0]
        self.drive.f_max = min(own, most) if self.pre.phase == pre.FROZEN else own
        there = lim if self.pre.phase >= pre.TRACK else None
        self.drive.up = min(self.slew_up, self.late_up) if self.pre.late else self.slew_up
        c, spring, damper, pull = self.contact.tick((k, b, *self.par.f0), q, v, there)
        self.wind_in(rest_ticks)
        limits, _, _, _, force = self.drive.take(permit, spring + damper + pull)
        if not limits & SLEW:
            self.pre.late = 0
        more, i0, peak, i2t = self.drive.current()
        return bits, d, lim, c, limits | more, force, i0 + peak + i2t

    def state(self):
        quad = self.quad.state() if self.quad else bytes(10)
        return (quad + self.velocity.state() + self.contact.state() + self.drive.state() +
                self.track.state() + self.watch.state() + self.chatter.state() + self.pre.state() +
                self.where(self.out, self.rest, *self.joint, *self.tip, *self.slope, self.clamped))


class Wire:
    pack = Struct("<q7IB").pack

    def __init__(self, session, T):
        self.tick_us = (1000000 * T[0] << 20) // T[1]
        self.ms_per_tick, self.ticks_per_us = self.tick_us // 1000, (T[1] << 32) // (1000000 * T[0])
        self.tx, self.rx = Sender(session, 0), Receiver()
        self.now = self.trip = self.exchanges = self.set = self.wait = self.differs = self.odd = 0
        self.age, self.acks, self.trace = M32, [], Trace()
        self.due = self.heard = 0

    def us(self):
        return self.now >> 20 & M32

    def state(self):
        now = self.now - (1 << 64) if self.now >> 63 else self.now
        return (pack("<II", self.tx.session, self.tx.seq) + self.rx.state() +
                self.pack(now, self.age, self.trip, self.exchanges, self.set, self.wait,
                          self.differs, self.odd, self.due) +
                self.trace.state())


class Bilateral:
    frame = Struct("<22iIIB").pack

    def __init__(self, par, T):
        self.par = par
        self.at = [f for f in range(FINGERS) if par.fingers >> f & 1]
        self.n = len(self.at)
        bits = max(narrowest(par.finger[f].step, par.finger[f].speed, T)[1] for f in self.at)
        self.finger = [Finger(f, par.finger[f], T, bits if f in self.at else 0)
                       for f in range(FINGERS)]
        self.safety = Safety(par.safety, T)
        self.glove = Glove(par.glove, par.sensor, (1 << SENSORS) - 1, (T[0] * par.every, T[1]))
        for i in range(SENSORS):
            self.glove.channel[i] = Channel(0)
            self.glove.channel[i].pos = 0
        self.wire, self.params = Wire(par.session, T), Params(par)
        self.rest_ticks = par.f0_rest * T[1] // (1000 * T[0]) + 1
        self.supply = Supply(par.supply, T)
        self.glove_ticks, self.link_ticks = (ms * T[1] // (1000 * T[0]) + 1 if ms else 0
                                             for ms in (par.glove_time, par.link_time))
        self.worn = self.faulty = self.unsure = 0
        self.seen = M32
        # a glove frame: its angles, its faults, the age of the one before, parts still to do
        self.angle, self.doubts, self.before, self.left = [0] * SENSORS, 0, 0, 0
        units = 4 + (self.n + 1) // 2
        self.parts = min(par.every, units)
        # sensors that the fingers in use need, directly or as a cross term of one
        need = {i for f in self.at for i in range(SENSORS) if self.finger[f].sensors >> i & 1}
        self.crossed = sorted(need.intersection(CROSSED))
        need |= {a for i in self.crossed for a in par.sensor[i][5] if a != NO_SENSOR}
        self.first, self.end = min(need), max(need) + 1
        self.part = [self.upto(-(-p * units // self.parts)) for p in range(self.parts + 1)]

    def upto(self, unit):
        """Sensors and places of fingers that are done behind so many units."""
        sensors, places = ((0, 4, 10, 16, 22, 22, 22, 22)[unit], (0, 0, 0, 0, 0, 2, 4, 5)[unit])
        return max(self.first, min(sensors, self.end)), min(self.n, places)

    def age(self, f):
        """Of what is known of where a finger is."""
        if self.faulty & self.finger[f].sensors:
            return M32
        there = self.part[self.parts - self.left][1] > self.at.index(f)
        return self.seen if there else self.before

    def take(self, mail, missed):
        w = self.wire
        before = w.us()
        w.now = w.now + w.tick_us * (missed + 1) & M64
        if w.rx.wait(w.us() - before & M32, 1000 * self.par.quiet):
            w.exchanges = 0
        w.age, w.acks, w.heard = min(M32, w.age + missed + 1), [], len(mail)
        for p in mail:
            session = w.rx.session
            got = w.rx.take(p)
            if w.rx.session != session:
                for f in self.at:
                    self.finger[f].pre.met = 0
                w.exchanges = 0
                w.trace.stop()
            if got == HELLO:
                role, version, table = unpack_from("<BII", p, 18)
                w.differs = (role == 0) | (version != VERSION) << 1 | (table not in (0, TABLE)) << 2
                w.odd += w.differs != 0
            elif got == PLANES:
                self.planes(p[18:-4])
            elif got == PARAM:
                ident, n, value = unpack_from("<HHi", p, 18)
                said = self.params.stage(ident, n, value, self.safety.state_)
                w.set += said == 0
                w.acks.append(pack("<HHihI", ident, n, value, said, unpack_from("<I", p, 10)[0]))
            elif got == TRACE_ASK:
                w.trace.ask(unpack_from("<I", p, 10)[0], p[18:-4], SIGNALS)

    def planes(self, body):
        w = self.wire
        w.trip, w.age = w.us() - unpack_from("<I", body, 4)[0] & M32, 0
        age = w.trip * w.ticks_per_us >> 32
        for f in self.at:
            kind, material, number, *v = unpack_from("<BBH9i", body, 9 + 40 * f)
            if self.age(f) != M32:
                self.finger[f].pre.tell(kind, material, number, v[:3], v[3:6], age)

    def see_some(self):
        """The next part of the newest frame."""
        (s0, p0), (s1, p1) = self.part[self.parts - self.left:][:2]
        for i in range(s0, s1):
            self.angle[i] = self.glove.own(i, self.angle[i])
        if s0 < s1 == self.end:
            self.angle = self.glove.cross(self.angle, self.crossed)
        for f in self.at[p0:p1]:
            self.finger[f].see(self.angle)
        self.left -= 1
        if self.left == 0:
            self.faulty = self.doubts

    def see(self, raw, age):
        if raw:
            while self.left:
                self.see_some()
            self.doubts, self.angle = self.glove.believe(raw)
            self.faulty |= self.doubts
            self.worn, self.seen, self.left = 1, age, self.parts
        if self.left:
            self.see_some()

    def causes(self, code, missed):
        """Of the box: glove, link, supply."""
        ages, t = [self.age(f) for f in self.at], self.glove_ticks
        known = [a for a in ages if a < M32]
        self.unsure = max(min(M32, self.unsure + missed + 1) if M32 in ages else 0, *known, 0)
        lost = t and self.unsure >= t
        cut = self.link_ticks and self.wire.age >= self.link_ticks
        return ((GLOVE if lost else 0) | (LINK if cut else 0) |
                (SUPPLY if self.supply.step(code, missed) else 0))

    def tick(self, enc, mon, supply, din, missed, command, raw, glove_age, mail):
        """Signals by finger, those of the box, and codes for the D/A."""
        par, at = self.par, self.at
        moved, seen, early, raised = {}, {}, {}, 0
        for f in at:
            s = self.finger[f]
            seen[f] = s.drive.monitor(mon[f])
            s.cnt = cnt = s.quad.tick(enc[f])
            fast, v, early[f] = s.watch.step(s.velocity.tick(cnt))
            moved[f] = position(cnt, s.par.step), v
            raised |= (fast | s.chatter.step() | (ENCODER if s.quad.lost else 0) |
                       (TRACKING if s.track.step(seen[f][0]) else 0))
        placed = din & 255 | sum(1 << 8 + k for k, f in enumerate(at) if din >> 8 + f & 1)
        age = glove_age if glove_age < 65535 else M32
        self.seen = age if self.worn else M32
        older = min(M32, self.before + missed + 1)
        self.before = (self.seen if not raw and not self.left
                       else older if self.worn and older < 65535 else M32)
        for f in at:
            self.finger[f].pre.skip(missed)
        self.take(mail, missed)
        self.see(raw, age)
        ready = 7 | (0 if raised & ENCODER else 8)
        permit = self.safety.step(placed, raised | self.causes(supply, missed), missed, command,
                                  self.n, ready)
        felt = {f: self.finger[f].feel(self.age(f), permit, par.material, self.rest_ticks,
                                       *moved[f]) for f in at}
        gated, enable = self.safety.gate([par.finger[f].drive for f in at],
                                         [felt[f][6] for f in at],
                                         [felt[f][4] | early[f] for f in at])
        paper, more = [[0] * 8 for _ in range(FINGERS)], [[0] * 17 for _ in range(FINGERS)]
        dac, enabled = [f.drive[6] for f in par.finger], 0
        for k, f in enumerate(at):
            s, (bits, d, lim, c, _, force, _) = self.finger[f], felt[f]
            limits, _, _, coded, dac[f] = gated[k]
            enabled |= (enable >> k & 1) << f
            paper[f] = [*moved[f], force, coded, c, seen[f][1], d, lim]
            s.track.coded(coded)
            s.watch.coded(s.cnt, coded)
            s.chatter.coded(s.cnt, coded)
            s.last = coded
            p = s.pre
            more[f] = [bits, limits, *s.joint, s.clamped, *s.tip,
                       *map(wrap, (p.frozen, p.born, p.refused, p.ignored, p.stale, p.let_go,
                                   p.late_n)), p.late_d]
        w, sf = self.wire, self.safety
        box = [sf.state_, sf.faults, sf.present, self.faulty, glove_age, min(w.age, MAX32),
               min(w.trip, MAX32), wrap(w.set),
               *map(wrap,
                    (w.rx.count[c] for c in ("accepted missing duplicate reordered old stranger "
                                             "corrupt version unknown far silences").split())),
               w.differs, wrap(w.odd), sf.arm_step()]
        return paper, more, box, (dac, enabled, self.safety.alive)

    def put(self, out, kind, body):
        if len(out) < ROOM:
            out.append(self.wire.tx.write(kind, body, self.wire.us(), 256))

    def write(self, paper, signals):
        w, out = self.wire, []
        if w.wait == 0 or w.wait >= self.par.state_every:
            often = 8 if w.age == M32 or w.rx.open else 128
            w.wait = self.par.state_every
            w.due |= 3 if w.exchanges % often == 0 else 2
            w.exchanges += 1
        last = w.wait == 1
        for bit in 1, 2:  # one a tick, and in one with packets none, but in the last
            if w.due & bit and (last or not out and not (w.heard and w.tx.seq)):
                self.put(out, *((TELL, self.told(paper)) if bit == 2 else
                                (HELLO, pack("<BII20x", 0, VERSION, TABLE))))
                w.due &= ~bit
        w.wait -= 1
        for ack in w.acks:
            self.put(out, ACK, ack)
        w.acks = []
        traced = w.trace.tick(self.safety.tick, signals, len(out) < ROOM)
        if traced is not None:
            self.put(out, TRACE, traced)
        return out

    def told(self, paper):
        w, frozen, touching, rows = self.wire, 0, 0, b""
        for f, s in enumerate(self.finger):
            if f not in self.at:
                rows += bytes(40)
                continue
            q, _, force, _, c, _, d, lim = paper[f]
            frozen |= (s.pre.phase == pre.FROZEN) << f
            touching |= c << f
            rows += pack("<10i", *s.joint, *s.tip, force, d, q, lim)
        ms = min(65535, w.age * w.ms_per_tick >> 20)
        return pack("<IBBBBHI", self.safety.tick, self.par.fingers, self.safety.state_, frozen,
                    touching, ms, self.safety.faults) + rows

    def state(self):
        return (b"".join(s.state() for s in self.finger) + self.safety.state() +
                self.glove.state() + self.frame(*self.angle, self.doubts, self.before, self.left) +
                self.wire.state() + pack("<BIII", self.worn, self.faulty, self.supply.off,
                                         self.unsure))


# --- stimuli ---

ASK = ((0x0B01, MATERIALS, 0, 1024000000, 1024000001), (0x0B02, MATERIALS, 0, 1048576000, -1),
       (0x0B03, MATERIALS, 0, 104857600, 104857601), (0x0C01, FINGERS, -(1 << 25), -(1 << 22), 0),
       (0x0C02, FINGERS, 0, 1 << 22, -1), (0x0C03, FINGERS, 1 << 21, 1 << 27, (1 << 27) + 1),
       (0x0C04, FINGERS, 0, 1, 2), (0x8611, 1, 1, 12, 10001), (0x8612, 1, 1, 1000, -1),
       (0x0401, FINGERS, 0, 1000, -1), (0x0501, FINGERS, 0, 1000, -1), (0x7FFF, 1, 0, 1, 2))


def away(k):
    """Twice a run no planes come, and no sensor is believed."""
    return 104 <= k % 128 < 124


def asks(k):
    """So seldom that a trace comes to wait for a packet's worth of frames, and no longer."""
    return k % 128 < 24


class World:
    def __init__(self, rng, scene):
        self.scene, self.object, self.late, self.begun = scene, [None] * FINGERS, [], 0
        self.trace = [0] * 5
        self.tx = Sender(rng.u64() & M32 | 1, rng.draw(-40, 40) & M32)

    def arrive(self, p):
        if len(self.mail) < ROOM:
            self.mail.append(bytes(p))

    def send(self, rng, kind, body):
        """Lost, twice, damaged, late, or as it should."""
        stamp, how = rng.u64() & M32, rng.draw(0, 23)
        p = bytearray(self.tx.write(kind, body, stamp, 256))
        if how == 2:
            bit = rng.draw(0, 8 * len(p) - 1)
            p[bit >> 3] ^= 1 << (bit & 7)
        if how == 3 and len(self.late) < LATE:
            self.late.append(p)
        elif how != 0:
            self.arrive(p)
        if how == 1:
            self.arrive(p)

    def any_object(self, rng, f):
        (c1, s1, d1), (c2, s2, d2) = any_turn(rng), any_turn(rng)
        n = [div(v << 30, d1 * d2) for v in (c1 * c2, s1 * c2, s2 * d1)]
        self.object[f] = [pre.HIT, rng.draw(0, 65535), rng.draw(0, MATERIALS), n, None]
        self.put_before(rng, f)

    def put_before(self, rng, f):
        """So far from where the fingertip is now."""
        way, o = rng.draw(0, 1 << 26), self.object[f]
        o[4] = [sat32(t - (a * way >> 30)) for t, a in zip(self.scene.finger[f].tip, o[3])]

    def plane(self, rng, f):
        how = rng.draw(0, 63)
        if how < 2 or self.object[f] is None:
            self.any_object(rng, f)
        if 9 <= how < 18:
            self.put_before(rng, f)
        kind, number, material, n, point = self.object[f]
        n, point = n[:], point[:]
        if how == 4:
            return pack("<BBH9i", pre.NONE, 0, 0, *[0] * 9)
        if how in (5, 6):
            i = rng.draw(0, 2)
            n[i] += rng.draw(-24576, 24576)
        elif how == 7:
            number ^= 1
        elif how == 8:
            i = rng.draw(0, 2)
            point[i] += rng.draw(-(1 << 22), 1 << 22)
        return pack("<BBH9i", kind, material, number, *n, *point, *point)

    def planes(self, rng, rate):
        ago, seq, fingers = rng.draw(0, 40) * 1000000 // rate, rng.u64() & M32, 31
        if rng.draw(0, 3) == 0:
            fingers = rng.draw(0, 31)
        body = pack("<IIB", seq, self.scene.wire.us() - ago & M32, fingers)
        for f in range(FINGERS):
            body += self.plane(rng, f) if fingers >> f & 1 else bytes(40)
        self.send(rng, PLANES, body)

    def param(self, rng):
        ident, n, lo, hi, bad = ASK[rng.draw(0, len(ASK) - 1)]
        n, value = rng.draw(0, n), rng.draw(lo, hi)
        if rng.draw(0, 7) == 0:
            value = bad
        self.send(rng, PARAM, pack("<HHi", ident, n, value))

    def trace_ask(self, rng):
        """Now and then the same as before, or what is none of the signals."""
        if rng.draw(0, 2):
            every = rng.draw(0, 24)
            self.trace = [every >> rng.draw(0, 4), *(rng.draw(0, SIGNALS - 1) for _ in range(4))]
            if rng.draw(0, 7) == 0:
                i, most = rng.draw(0, 3), 65535 - SIGNALS
                beyond = rng.draw(0, most)
                self.trace[1 + i] = SIGNALS + (beyond >> rng.draw(0, 16))
        self.send(rng, TRACE_ASK, pack("<I4H", *self.trace))

    def frame(self, rng, rate, k):
        """The packets of a tick."""
        before, self.mail = len(self.late), []
        if rng.draw(0, 127) == 0:
            self.tx, self.begun = Sender(rng.u64() & M32 | 1, self.tx.seq), 0
        if not self.begun and rng.draw(0, 1):
            self.begun = 1
            self.send(rng, HELLO, pack("<BII20x", rng.draw(0, 1), VERSION + rng.draw(0, 1),
                                       TABLE * rng.draw(0, 2) & M32))
        if rng.draw(0, 1) and not away(k):
            self.planes(rng, rate)
        if rng.draw(0, 7) == 0:
            self.param(rng)
        if asks(k) and rng.draw(0, 3) == 0:
            self.trace_ask(rng)
        for p in self.late[:before]:
            self.arrive(p)
        del self.late[:before]
        return self.mail


def mail_crc(mail):
    return zlib.crc32(b"".join(mail))


class Hand:
    """The glove's codes."""

    def __init__(self, par, codes):
        self.par, self.codes, self.wrong, self.age = par, codes, 0, 0

    def frame(self, rng, k):
        """Codes, or None where there is no new frame. Now and then one is missing, or early."""
        self.age = min(65535, self.age + 1)
        if rng.draw(0, 47) == 0:
            self.wrong ^= 1 << rng.draw(0, 21)
        elif rng.draw(0, 7) == 0:
            self.wrong = 0
        if away(k):
            self.wrong = (1 << SENSORS) - 1
        if (k % self.par.every != 0) != (rng.draw(0, 31) == 0):
            return None
        self.age = 0
        return [(-32768 if i & 1 else 32767) if self.wrong >> i & 1 else
                s[3] + ((self.codes[i & 3][k] + 32768) * (s[4] - s[3]) >> 16)
                for i, s in enumerate(self.par.sensor)]


def bilateral(rate):
    rng = Rng("bilateral", rate, 0)
    codes = [wave("bilateral", rate, 20 + i, -32768, 32767, 1 << rng.draw(4, 9)) for i in range(4)]
    for k in range(TICKS):
        if k in (0, AGAIN):
            T = period(rate, k)
            par = Par(rng, rate, T)
            s = Bilateral(par, T)
            world, hand = World(rng, s), Hand(par, codes)
            raw, din, rail = [rng.u64() & M32 for _ in range(FINGERS)], HEALTHY, Rail(par.supply[4])
            jump = [s.finger[f].quad.jump if f in s.at else 0 for f in range(FINGERS)]
            moves = [wave("bilateral", rate, 1 + f + (8 if k else 0), -j, j, max(1, j >> 10))
                     for f, j in enumerate(jump)]
        mail = world.frame(rng, rate, k)
        glove = hand.frame(rng, k)
        mon = []
        for f in range(FINGERS):
            raw[f] += moves[f][k] >> 3 if 8 <= k < 56 else moves[f][k]
            if 184 <= k < AGAIN:
                raw[f] += rng.draw(-2 * jump[f], 2 * jump[f])
            raw[f] &= M32
            mon.append(s.finger[f].monitor.draw(rng, par.finger[f].drive, s.finger[f].last))
        if rng.draw(0, 127) == 0:
            din ^= 1 << rng.draw(0, 12)
        elif rng.draw(0, 3) == 0:
            din = HEALTHY
        if s.safety.state_ == FAULT and rng.draw(0, 1) == 0:
            din ^= 2
        supply = rail.draw(rng, k)
        missed = 1 if rng.draw(0, 127) == 0 else 0
        command = 1 if k % 4 == 2 or k % AGAIN == 0 else 3 if k % 4 == 1 else 0
        for f in s.finger:
            f.pre.resumed = k == pre.RESTORED
        paper, more, box, (dac, enable, alive) = s.tick(raw, mon, supply, din, missed, command,
                                                        glove, hand.age,
                                                        mail)
        flat = [v for row in paper + more for v in row] + box
        out = s.write(paper, flat)
        if k % 8 == 7:
            s.params.apply()
        yield ((len(mail), mail_crc(mail), int(glove is not None), din, missed, command,
                *(v for p, m in zip(paper, more) for v in (m[0], p[6], p[7], p[2])),
                box[0], box[1], box[3], box[5], box[7], box[8],
                zlib.crc32(pack("<%di" % len(flat), *flat)),
                zlib.crc32(pack("<5HBB", *dac, enable, alive)), len(out), mail_crc(out)), s.state())


COLUMNS = ("packets mail_crc glove_new din missed command | " + " ".join(
    "%s%d" % (n, f) for f in range(FINGERS)
    for n in ("bits", "d_m_q30_", "q_lim_m_q30_", "f_des_N_q20_")) +
    " state faults glove_faults age set accepted signals_crc out_crc written written_crc")

MODULES = {"bilateral": (COLUMNS, bilateral)}
