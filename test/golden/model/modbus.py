# SPDX-License-Identifier: MIT
"""mirror, modbus and modbus_rtu: binary32 by integers, requests and their answers, and a serial
line; from docs/MODBUS.md."""

import zlib
from struct import pack

from .num import M32, MAX32, MIN32, RANGE, STATE, TICKS, Rng, clamp, period, wrap

SETUP, ANY, SLEWED, LIMIT, WALL, REST = 1, 2, 3, 4, 7, 8
IO = 9

# --- binary32 ---


def even(v, n):
    """v / 2^n to the nearest integer, of two as near the even one."""
    if n <= 0:
        return v << -n
    return (v + (1 << n - 1) - 1 + (v >> n & 1)) >> n


def float_of(raw, frac):
    mag = abs(raw)
    if mag == 0:
        return 0
    exp = mag.bit_length() - 24
    mant = even(mag, exp) if exp > 0 else mag << -exp
    if mant == 1 << 24:
        mant, exp = 1 << 23, exp + 1
    return (raw < 0) << 31 | (exp - frac + 150) << 23 | mant - (1 << 23)


def float_raw(bits, frac):
    """None where there is none."""
    exp, mant = bits >> 23 & 255, bits & 0x7FFFFF
    if exp == 255:
        return None
    mant, exp = (mant | 1 << 23, exp - 150) if exp else (mant, -149)
    mag = even(mant, -(exp + frac))
    raw = -mag if bits >> 31 else mag
    return raw if MIN32 <= raw <= MAX32 else None


def any_bits(rng, frac):
    how, bits, near, small = (rng.draw(0, 7), rng.draw(0, M32), rng.draw(-2, 2),
                              rng.draw(-4096, 4096))
    if how == 0:
        return bits
    if how == 1:
        return bits & 0x807FFFFF | 0x7F800000
    if how == 2:
        return bits & 0x807FFFFF
    if how == 3:
        return float_of(small >> 10, frac + 2 if frac <= 124 else frac)
    if how == 4:
        return float_of(small, min(frac + 1, 126))
    return float_of((MIN32, MAX32, wrap(bits))[how - 5], frac) + near & M32


def mirror(rate):
    rng = Rng("mirror", rate, 0)
    for _ in range(TICKS):
        row = []
        for _ in range(4):
            frac, v = min(rng.draw(0, 144), 126), rng.draw(MIN32, MAX32)
            v >>= rng.draw(0, 31)
            bits = any_bits(rng, frac)
            raw = float_raw(bits, frac)
            row += [frac, v, bits, float_of(v, frac), 0 if raw is not None else -RANGE,
                    99 if raw is None else raw]
        yield row, b""


# --- the box ---

# (id, fraction, when, min, max, default) of each row, and how many instances of them.
OUT = ((((0x7011, 0, 0, MIN32, MAX32, 0), (0x7012, 26, 0, MIN32, MAX32, 0),
         (0x7013, 42, 0, MIN32, MAX32, 0)), 20),
       (((0x7021, 126, 0, MIN32, MAX32, 0),), 4))
PAR = ((((0x7201, 10, ANY, 0, 1024000000, 1536000), (0x7202, 0, SETUP, -5, 5, 0),
         (0x7203, 30, SLEWED, MIN32, MAX32, 0), (0x7204, 42, LIMIT, -70000, 70000, 1),
         (0x7205, 0, REST, 0, 1, 0), (0x7206, 24, WALL, 16777217, MAX32, 16777219)), 11),
       (((0x7301, 126, SETUP, MIN32, MAX32, -1),), 2))


def rows_of(groups):
    return [row for rows, n in groups for _ in range(n) for row in rows]


def table_crc(groups):
    return zlib.crc32(b"".join(pack("<H", len(rows)) +
                               b"".join(pack("<HBBiiH", *row[:5], n) for row in rows)
                               for rows, n in groups))


OUT_ROWS, OUT_CRC, PAR_ROWS, PAR_CRC = rows_of(OUT), table_crc(OUT), rows_of(PAR), table_crc(PAR)
SIGNALS, PARAMS, FRAMES = len(OUT_ROWS), len(PAR_ROWS), 8
VERSION = (0, 3, 0)  # of the library: in the head and in what it says it is
APPLY, DISCARD, SAVE, OFF, RUN, CLEAR = (1 << k for k in range(6))
HOLDING, INPUT = 3, 4


class Refuse(Exception):
    """A request; the argument is the exception."""


class Trace:
    def __init__(self):
        self.frame = [(i + 1, 0, 0, 0, 0, 0) for i in range(FRAMES)]
        self.set, self.first, self.head, self.run, self.left = [0] * 5, 0, 0, 0, 0

    def start(self, what):
        self.set, self.first, self.left = what, self.head, 0
        self.run += 1

    def tick(self, tick, signal):
        if self.set[0] == 0:
            return
        if self.left:
            self.left -= 1
            return
        self.left = self.set[0] - 1
        self.frame[self.head % FRAMES] = (self.head, tick, *(signal[i] for i in self.set[1:]))
        self.head += 1

    def values(self):
        return [FRAMES, self.head, max(self.first, self.head - FRAMES), self.run, *self.set]


class Box:
    def __init__(self, rng, T):
        no_trace, no_signals = rng.draw(0, 7) == 0, rng.draw(0, 15) == 0
        self.active = [row[5] for row in PAR_ROWS]
        self.wanted, self.staged = self.active[:], {}
        self.signal = [wrap(i * 0x9E3779B1) for i in range(SIGNALS)]
        self.signals = [] if no_signals else self.signal
        self.own = Trace()
        self.trace = None if no_trace else self.own
        self.name = (b"", b"x", b"bilateral", b"seventeen letters")[rng.draw(0, 3)]
        self.may = rng.draw(0, 63) | APPLY | DISCARD | OFF
        self.fingers, self.T = rng.draw(1, 5), T
        self.asked = self.done = self.result = self.locked = self.locks = self.refused = 0
        self.box_state = 0

    def tick(self, rng, k):
        u, v = rng.u64(), rng.u64()
        self.now, state = u & M32, v >> 56 & 0x27
        self.box_state, missed, first_tick = state, u >> 32, u >> 16 & M32
        faults, present, self.limits, first = (v & 0x7FFF, v >> 15 & 0x7FFF, v >> 30 & 0x7FF,
                                               v >> 41 & 0x7FFF)
        arm = u & 0x7F if state != 1 else 64 if u >> 40 & 1 else 32
        din = u >> 8 & 0x1FFF
        self.seen = (self.now, state, faults, first, first_tick, present, self.limits, arm, din,
                     missed)
        self.bits = (faults, present, din, 1 << state if state < 32 else 0, self.limits, arm)
        for _ in range(2):
            i, raw = rng.draw(0, SIGNALS - 1), rng.draw(MIN32, MAX32)
            self.signal[i] = raw >> rng.draw(0, 31)
        self.own.tick(self.now, self.signal)
        self.locks, self.locked = k + 3 >> 4 & 1, k >> 4 & 1
        if rng.draw(0, 7) == 0:
            i = rng.draw(0, PARAMS - 1)
            row = PAR_ROWS[i]
            raw = rng.draw(row[3], row[4])
            if rng.draw(0, 1) == 0:
                i = next((j for j in range(i, PARAMS) if j in self.staged), PARAMS - 1)
                raw = self.held(i)
            if self.may_be(i, raw):
                self.wanted[i] = raw

    def may_be(self, i, raw):
        return PAR_ROWS[i][2] != SETUP or not self.locks or raw == self.wanted[i]

    def register_may(self, i, raw, locked):
        """A client's wish, which in a box that may have a force is for less of it."""
        when, was = PAR_ROWS[i][2], self.wanted[i]
        if raw == was or not locked or when == ANY:
            return True
        if when == SETUP:
            return False
        calm = self.box_state in (0, 5)
        return calm or when in (SLEWED, LIMIT) and raw < was or when == WALL and raw > was

    def held(self, i):
        return self.staged.get(i, self.wanted[i])

    def differ(self):
        return sum(v != self.wanted[i] for i, v in self.staged.items())

    def head(self):
        name = (self.name + bytes(16))[:16]
        n = len(self.signals)
        return [0x45584831, 0x00010001, 0x12345678, 0x3F800000, *self.seen, n, PARAMS,
                OUT_CRC if n else 0, PAR_CRC, *self.T,
                VERSION[0] << 16 | VERSION[1] << 8 | VERSION[2], self.fingers, self.differ(),
                self.asked, self.done, self.result,
                *(int.from_bytes(name[i:i + 4], "big") for i in range(0, 16, 4)), self.refused]

    # --- registers ---

    def block(self, kind, at, n):
        """(the block's first register, the values from that of `at` to that of the last
        register)."""
        if kind == INPUT and at < 0x400:
            base, count, values = 0, 31, self.head
        elif kind == INPUT and 0x400 <= at < 0x440:
            base, count, values = 0x400, 9 if self.trace else 0, self.own.values
        elif kind == INPUT and 0x440 <= at < 0x1000:
            base, count, values = (0x440, 6 * FRAMES if self.trace else 0,
                                   lambda: [v for f in self.own.frame for v in f])
        elif kind == HOLDING and 0x400 <= at < 0x1000:
            base, count, values = 0x400, 5 if self.trace else 0, lambda: self.own.set
        elif kind == INPUT and 0x1000 <= at < 0x5000:
            base, count, values = (0x1000 if at < 0x3000 else 0x3000), len(self.signals), None
        elif 0x5000 <= at < 0x9000:
            base, count, values = (0x5000 if at < 0x7000 else 0x7000), PARAMS, None
        else:
            raise Refuse(2)
        first, last = at - base >> 1, at - base + n - 1 >> 1
        if last >= count:
            raise Refuse(2)
        if values:
            return base, values()[first:last + 1]
        out = []
        for i in range(first, last + 1):
            raw, row = ((self.signal[i], OUT_ROWS[i]) if base < 0x5000 else
                        (self.active[i] if kind == INPUT else self.held(i), PAR_ROWS[i]))
            out.append(float_of(raw, row[1]) if base in (0x3000, 0x7000) else raw)
        return base, out

    def read(self, kind, at, n):
        base, values = self.block(kind, at, n)
        b = b"".join((v & M32).to_bytes(4, "big") for v in values)
        from_b = (at - base) % 2 * 2
        return b[from_b:from_b + 2 * n]

    def counted(self, do, *what):
        """Wishes for what may not be."""
        try:
            do(*what)
        except Refuse as e:
            self.refused += e.args[0] == 3
            raise

    def write(self, at, n, data):
        self.counted(self.write_all, at, n, data)

    def write_bits(self, at, n, data):
        self.counted(self.write_coils, at, n, data)

    def write_all(self, at, n, data):
        """All or nothing."""
        base, values = self.block(HOLDING, at, n)
        if base != 0x400 and self.asked & APPLY:
            raise Refuse(6)
        odd, first = (at - base) % 2, at - base >> 1
        floats = base == 0x7000
        if floats and (odd or n % 2):
            raise Refuse(3)
        stands = b"".join((v & M32).to_bytes(4, "big") for v in values)
        b = stands[:2 * odd] + data + stands[2 * odd + len(data):]
        words = [int.from_bytes(b[i:i + 4], "big") for i in range(0, len(b), 4)]
        if base == 0x400:
            what = self.own.set[:first] + words + self.own.set[first + len(words):]
            if any(i >= SIGNALS for i in what[1:]):
                raise Refuse(3)
            self.own.start(what)
            return
        raws = []
        for i, w in enumerate(words, first):
            row = PAR_ROWS[i]
            raw = self.from_float(i, w) if floats else wrap(w)
            if (raw is None or not row[3] <= raw <= row[4] or
                not self.register_may(i, raw, self.locked)):
                raise Refuse(3)
            raws.append(raw)
        for i, raw in enumerate(raws, first):
            self.staged.pop(i, None)
            if raw != self.wanted[i]:
                self.staged[i] = raw

    def from_float(self, i, bits):
        _, frac, _, lo, hi, _ = PAR_ROWS[i]
        for raw in (self.held(i), lo, hi):
            if bits == float_of(raw, frac):
                return raw
        return float_raw(bits, frac)

    # --- bits ---

    def read_bits(self, f, at, n):
        total = sum(b << 32 * i for i, b in enumerate(self.bits)) if f == 2 else self.asked
        if at + n > (192 if f == 2 else 6):
            raise Refuse(2)
        return (total >> at & (1 << n) - 1).to_bytes(n + 7 >> 3, "little")

    def write_coils(self, at, n, data):
        if at + n > 6:
            raise Refuse(2)
        on = (int.from_bytes(data, "little") & (1 << n) - 1) << at
        if on & ~self.may or on & APPLY and on & DISCARD:
            raise Refuse(3)
        if on & DISCARD and self.asked & APPLY:
            raise Refuse(6)
        if on & DISCARD:
            self.staged = {}
            self.did(0)
        self.asked |= on & ~DISCARD

    # --- between two ticks ---

    def did(self, result):
        self.done, self.result = self.done + 1, result

    def apply(self):
        staged, self.staged = self.staged, {}
        if not all(self.register_may(i, raw, self.locks) for i, raw in staged.items()):
            self.refused += 1
            return -STATE
        for i, raw in staged.items():
            self.wanted[i] = raw
        return 0

    def between(self, rng):
        """Every other time what was commanded is carried out."""
        shown, command, staged = self.asked, 0, self.differ()
        if rng.draw(0, 1):
            asked, self.asked = self.asked, 0
            if asked & APPLY:
                self.did(self.apply())
            if asked & SAVE:
                self.did(-IO)
            command = 2 if asked & OFF else 3 if asked & CLEAR else 1 if asked & RUN else 0
            if command:
                self.did(0)
            self.active = self.wanted[:]
        return staged, shown, command, self.done, self.result

    def state(self):
        touched = sum(1 << i for i in self.staged)
        b = touched.to_bytes(12, "little")
        held = [self.held(i) for i in range(PARAMS)]
        b += pack("<%di" % (3 * PARAMS),
                  *(v for vs in zip(self.active, self.wanted, held) for v in vs))
        return b + pack("<II", self.own.run, self.own.set[0])


# --- a slave ---

def be(b):
    return int.from_bytes(b, "big")


TEXT = (b"exhand", b"exhand", b"%d.%d.%d" % VERSION)


def identify(q):
    if len(q) < 2 or q[1] != 14:
        raise Refuse(1)
    if len(q) != 4 or not 1 <= q[2] <= 4:
        raise Refuse(3)
    if q[2] == 4 and q[3] > 2:
        raise Refuse(2)
    first = q[3] if q[3] <= 2 else 0
    objects = range(first, first + 1 if q[2] == 4 else 3)
    return (bytes((14, q[2], 0x81, 0, 0, len(objects))) +
            b"".join(bytes((i, len(TEXT[i]))) + TEXT[i] for i in objects))


def done(box, q):
    """What is behind the function in the answer."""
    f = q[0]
    at, n = be(q[1:3]), be(q[3:5])
    if f in (1, 2, 3, 4):
        most = 2000 if f < 3 else 125
        if len(q) != 5 or not 1 <= n <= most:
            raise Refuse(3)
        data = box.read_bits(f, at, n) if f < 3 else box.read(f, at, n)
        return bytes((len(data),)) + data
    if f == 5:
        if len(q) != 5 or n not in (0, 0xFF00):
            raise Refuse(3)
        box.write_bits(at, 1, b"\1" if n else b"\0")
        return q[1:5]
    if f == 6:
        if len(q) != 5:
            raise Refuse(3)
        box.write(at, 1, q[3:5])
        return q[1:5]
    if f in (15, 16):
        size = n + 7 >> 3 if f == 15 else 2 * n
        if (len(q) < 6 or not 1 <= n <= (1968 if f == 15 else 123) or q[5] != size or
            len(q) != 6 + size):
            raise Refuse(3)
        (box.write_bits if f == 15 else box.write)(at, n, q[6:])
        return q[1:5]
    if f == 22:
        if len(q) != 7:
            raise Refuse(3)
        keep, put = n, be(q[5:7])
        now = be(box.read(HOLDING, at, 1))
        box.write(at, 1, (now & keep | put & ~keep & 0xFFFF).to_bytes(2, "big"))
        return q[1:7]
    if f == 23:
        put_at, put = be(q[5:7]), be(q[7:9])
        if (len(q) < 10 or not 1 <= n <= 125 or not 1 <= put <= 121 or q[9] != 2 * put or
            len(q) != 10 + 2 * put):
            raise Refuse(3)
        box.block(HOLDING, at, n)
        box.write(put_at, put, q[10:])
        data = box.read(HOLDING, at, n)
        return bytes((len(data),)) + data
    if f == 43:
        return identify(q)
    raise Refuse(1)


def answer(box, q):
    if not q:
        return b""
    try:
        return q[:1] + done(box, q)
    except Refuse as e:
        return bytes((q[0] | 0x80, e.args[0]))


# --- requests ---

COUNT = (0, 121, 122, 123, 124, 125, 126, 1968, 1969, 2000, 2001, 65535)
HELD = ((0x400, 10),) * 3 + ((0x5000, 136),) * 5 + ((0x7000, 136),) * 7 + ((0, 65535),)
SHOWN = (((0, 60),) * 2 + ((0x400, 18), (0x440, 96), (0x440, 96)) + ((0x1000, 128),) * 2 +
         ((0x3000, 128),) * 2 +
         ((0x5000, 136),) * 3 + ((0x7000, 136),) * 3 + ((0, 65535),))
FUNCTION = (1, 1, 2, 2, 2, 3, 3, 3, 3, 4, 4, 4, 4, 4, 5, 5, 5, 6, 6, 15, 15, 15, 16, 16, 16, 16, 16,
            22, 22, 23, 23, 43)


EDGE = {16: (123, 124, 0, 124), 23: (121, 122, 125, 126)}


def edge(draw):
    return COUNT[draw(0, 11)]


def registers(draw, f):
    base, size = (SHOWN if f == 4 else HELD)[draw(0, 15)]
    many = draw(0, 7) == 0
    n = draw(1, 125 if many else 8)
    at_edge = draw(0, 3) == 0
    if at_edge:
        n = EDGE.get(f, (125, 126, 0, 125))[draw(0, 3)]
    if draw(0, 7) == 0:
        at = base + draw(0, size + 4) - 2 & 0xFFFF
    else:
        at = base + draw(0, max(0, size - n))
    if draw(0, 3):
        at, n = at & 0xFFFE, n if at_edge else n + 1 & 0xFFFE
    return at, n


def value_at(box, draw, at):
    if 0x400 <= at < 0x40A:
        if at < 0x402:
            return draw(0, 3)
        return draw(SIGNALS - 1, SIGNALS) if draw(0, 7) == 0 else draw(0, SIGNALS - 1)
    i = (at - 0x1000 & 0x1FFF) >> 1
    if not (0x5000 <= at < 0x9000 and i < PARAMS):
        return draw(MIN32, MAX32) & M32
    _, frac, when, lo, hi, dflt = PAR_ROWS[i]
    how, raw = draw(0, 255), draw(lo, hi)
    if how == 0:
        return draw(MIN32, MAX32) & M32
    if how == 1:
        raw = clamp(hi + 1, MIN32, MAX32)
    elif how < 16:
        raw = lo
    elif how < 32:
        raw = hi
    elif how < 48:
        raw = dflt
    if how >= 96 or how >= 2 and box.locked and when == SETUP:
        raw = box.wanted[i] if how < 128 else box.held(i)
    return float_of(raw, frac) if at >= 0x7000 else raw & M32


def words(box, draw, at, n):
    b, v = b"", 0
    for k in range(at, at + min(n, 130)):
        if k == at or k % 2 == 0:
            v = value_at(box, draw, k)
        b += (v & 0xFFFF if k % 2 else v >> 16).to_bytes(2, "big")
    return b


def whole(box, draw):
    f = FUNCTION[draw(0, 31)]
    if draw(0, 31) == 0:
        f = draw(0, 255)
    if f in (1, 2):
        total = 6 if f == 1 else 192
        at = draw(0, total - 1)
        n = draw(1, total - at)
        n += draw(0, 7) == 0
        if draw(0, 15) == 0:
            n = edge(draw)
        return pack(">BHH", f, at, n)
    if f == 5:
        at, which, how, v = draw(0, 6), draw(0, 5), draw(0, 7), draw(0, 65535)
        return pack(">BHH", f, (0, 0, 1)[which] if which < 3 else at,
                    0 if how == 0 else v if how == 1 else 0xFF00)
    if f == 6:
        at, _ = registers(draw, f)
        return pack(">BH", f, at) + words(box, draw, at, 1)
    if f == 15:
        at = draw(0, 5)
        n = draw(1, 6 - at)
        n += draw(0, 7) == 0
        if draw(0, 7) == 0:
            n = edge(draw)
        size = n + 7 >> 3
        one = draw(0, 255)
        one &= draw(0, 255)
        return pack(">BHHB", f, at, n, size & 255) + (bytes((one,)) + bytes(254))[:min(size, 255)]
    if f == 16:
        at, n = registers(draw, f)
        return pack(">BHHB", f, at, n, 2 * n & 255) + words(box, draw, at, n)
    if f == 22:
        at, _ = registers(draw, f)
        how, keep = draw(0, 2), draw(0, 65535)
        b = pack(">BHH", f, at, (keep, 0xFFFF, 0)[how])
        return b + (pack(">H", draw(0, 65535)) if how == 0 else words(box, draw, at, 1))
    if f == 23:
        get, put = registers(draw, f), registers(draw, f)
        if draw(0, 1) == 0:
            put = get[0], min(get[1], 122)
        return pack(">BHHHHB", f, *get, *put, 2 * put[1] & 255) + words(box, draw, *put)
    if f == 43:
        kind = 13 if draw(0, 3) == 0 else 14
        return bytes((f, kind, draw(0, 5), draw(0, 4)))
    return pack(">BHH", f, *registers(draw, f))


def request(box, draw):
    q, how = whole(box, draw), draw(0, 31)
    if how == 0:
        return q[:draw(0, len(q))]
    if how == 1:
        return q + bytes(draw(1, 4))
    if how == 2:
        return flipped(q, draw)
    count_at = 5 if q[0] == 16 else 9
    if how < 6 and q[0] in (16, 23) and len(q) > count_at + 2:  # one register fewer than it says
        return q[:count_at] + bytes((q[count_at] - (how > 3) * 2 & 255,)) + q[count_at + 1:-2]
    return q


def flipped(q, draw):
    at = draw(0, len(q) - 1)
    return q[:at] + bytes((q[at] ^ 1 << draw(0, 7),)) + q[at + 1:]


def shown(b):
    return len(b), int.from_bytes((b + bytes(6))[:6], "big"), zlib.crc32(b)


def modbus(rate):
    rng = Rng("modbus", rate, 0)
    for k in range(TICKS):
        if k % 64 == 0:
            box = Box(rng, period(rate, k))
        box.tick(rng, k)
        row = ()
        for _ in range(3):
            q = request(box, rng.draw)
            row += shown(q) + shown(answer(box, q))
        yield row + box.between(rng), box.state()


# --- a serial line ---

BAUD = (299, 300, 9600, 19200, 19201, 115200, 10000000, 10000001)


def crc16(b):
    crc = 0xFFFF
    for byte in b:
        crc = crc >> 8 ^ CRC16[(crc ^ byte) & 255]
    return crc


def one_byte(crc):
    for _ in range(8):
        crc = crc >> 1 ^ (0xA001 if crc & 1 else 0)
    return crc


CRC16 = [one_byte(i) for i in range(256)]


class Line:
    def __init__(self, address, baud):
        # 3.5 characters of 11 bits, us
        self.silence = 1750 if baud > 19200 else -(-38500000 // baud)
        self.address = address
        self.frame, self.spoiled, self.quiet, self.ready = b"", False, 0, 0
        self.taken = self.others = self.damaged = 0

    def come(self, b):
        if b:
            self.quiet = 0
            if not self.ready:
                self.frame += b

    def bad(self):
        self.quiet = 0
        if not self.ready:
            self.spoiled = True

    def passed(self, us):
        if self.ready:
            return 1
        self.quiet += us
        if self.quiet >= self.silence and (self.frame or self.spoiled):
            f = self.frame
            if self.spoiled or not 4 <= len(f) <= 256 or crc16(f[:-2]) != f[-2] | f[-1] << 8:
                self.damaged += 1
            elif f[0] not in (0, self.address):
                self.others += 1
            else:
                self.taken += 1
                self.ready = 1
                return 1
            self.frame, self.spoiled = b"", False
        return 0

    def answer(self, box):
        if not self.ready:
            return b""
        f, self.frame, self.ready = self.frame, b"", 0
        if f[0] == 0:
            if f[1] in (5, 6, 15, 16, 22):
                answer(box, f[1:-2])
            return b""
        b = f[:1] + answer(box, f[1:-2])
        return b + pack("<H", crc16(b))


def any_line(draw):
    how, some, address = draw(0, 9), draw(300, 25000), draw(0, 255)
    baud = BAUD[how] if how < 8 else some
    if 1 <= address <= 247 and 300 <= baud <= 10000000:
        return 0, Line(address, baud)
    return -RANGE, Line(1 + (address & 127), some)


def any_frame(line, box, draw):
    q, who, how, other = request(box, draw), draw(0, 7), draw(0, 15), draw(0, 255)
    q = b"" if how == 3 else q
    b = bytes((0 if who < 2 else other if who == 2 else line.address,)) + q
    if how == 0:
        b += bytes(max(0, draw(253, 255) - len(b)))
    b += pack("<H", crc16(b))
    if how == 1:
        return b[:draw(1, len(b))]
    return flipped(b, draw) if how == 2 else b


def come(line, draw, b):
    at, how, us = draw(0, len(b)), draw(0, 15), draw(0, 2 * line.silence)
    line.come(b[:at])
    told = line.passed(line.silence if how == 0 else us if how == 1 else M32 if how == 2 else
                       line.silence - 1 if how < 8 else 0)
    if how == 15:
        line.bad()
    line.come(b[at:])
    return told


def modbus_rtu(rate):
    rng = Rng("modbus_rtu", rate, 0)
    draw = rng.draw
    for k in range(TICKS):
        err = 0
        if k % 64 == 0:
            box = Box(rng, period(rate, k))
        if k % 8 == 0:
            err, line = any_line(draw)
        box.tick(rng, k)
        b = any_frame(line, box, draw)
        row = (err, line.silence, *shown(b), crc16(b[:-1]), come(line, draw, b),
               line.passed(line.silence - 1))
        last = draw(0, 7)
        row += (line.passed((0, M32)[last] if last < 2 else 1),)
        got = line.answer(box) if draw(0, 7) else b""
        yield (row + shown(got) + (line.taken, line.others, line.damaged) + box.between(rng),
               box.state())


# Inputs and outputs take turns within a tick, so all are shown.
MODULES = {
    "mirror": (" ".join("frac%d of%d bits%d float%d err%d raw%d" % ((i,) * 6) for i in range(4)),
               mirror),
    "modbus": (" ".join("req%d_B req%d req%d_crc ans%d_B ans%d ans%d_crc" % ((i,) * 6)
                        for i in range(3)) +
               " staged asked command done result", modbus),
    "modbus_rtu": ("err silence_us frame_B frame frame_crc crc16 gap early ended ans_B ans ans_crc "
                   "taken others damaged "
                   "staged asked command done result", modbus_rtu),
}
