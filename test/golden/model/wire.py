# SPDX-License-Identifier: MIT
"""wire: packets written, lost, late, twice, damaged and forged, and taken."""

import zlib
from struct import Struct, pack, unpack_from

from .num import AGAIN, CRC, M32, RANGE, SHORT, STALE, STATE, TICKS, UNKNOWN, VERSION, Rng
from .signal import VALUES, Params

HELLO, TELL, PLANES, PARAM, ACK, TRACE_ASK, TRACE = range(1, 8)
# of TRACE: the longest
LENGTH = {HELLO: 29, TELL: 214, PLANES: 209, PARAM: 8, ACK: 14, TRACE_ASK: 12, TRACE: 231}
MASKS = {TELL: (4, 6, 7), PLANES: (8,)}
COUNTS = ("accepted missing duplicate reordered old stranger corrupt version unknown far "
          "silences").split()
AHEAD, QUIET, SEAL = 1 << 16, 1000000, 24


def sealed(head):
    return head + pack("<I", zlib.crc32(head))


def length(kind, body):
    """A payload's, by what it says."""
    return (11 + 20 * body[10] if kind == TRACE and len(body) > 10 else 11 if kind == TRACE
            else LENGTH[kind])


def may_be(kind, body):
    """1 if the payload's values can be."""
    if (kind == HELLO and body[0] > 1 or kind == TELL and body[5] > 5 or
        any(body[i] > 31 for i in MASKS.get(kind, ()))):
        return 0
    if kind == PLANES:
        told = [body[9 + 40 * f] for f in range(5)]
        return int(max(told) <= 2 and all(body[8] >> f & 1 for f in range(5) if told[f]))
    if kind == TRACE:
        result, frames = unpack_from("<hB", body, 8)
        return int(frames <= 11 and result <= 0 and (result == 0 or frames == 0))
    return 1


class Sender:
    def __init__(self, session, seq):
        self.session, self.seq = session, seq

    def write(self, kind, body, stamp, cap):
        """The packet, or the negative error."""
        if kind not in LENGTH:
            return -UNKNOWN
        if self.session == 0 or not may_be(kind, body):
            return -RANGE
        if len(body) + 22 > cap:
            return -SHORT
        p = sealed(pack("<HBBHIII", 0x5758, 3, kind, len(body), self.session, self.seq, stamp) +
                   body)
        self.seq = self.seq + 1 & M32
        return p


class Receiver:
    pack = Struct("<Q16I").pack

    def __init__(self):
        self.seen = self.seq = self.session = self.former = self.quiet = self.open = 0
        self.count = dict.fromkeys(COUNTS, 0)

    def wrong(self, name, err):
        self.count[name] = self.count[name] + 1 & M32
        return -err

    def take(self, p):
        """The type, or the negative error."""
        more = len(p) - 22 - unpack_from("<H", p, 4)[0] if len(p) >= 18 else -1
        if more not in (0, SEAL):
            return self.wrong("corrupt", SHORT)
        p = p[:len(p) - more]
        magic, version, kind, n, session, seq = unpack_from("<HBBHII", p)
        if magic != 0x5758 or session == 0 or sealed(p[:-4]) != p:
            return self.wrong("corrupt", CRC)
        if version != 3 or more:
            return self.wrong("version", VERSION)
        if kind not in LENGTH:
            return self.wrong("unknown", UNKNOWN)
        if n != length(kind, p[18:-4]) or not may_be(kind, p[18:-4]):
            return self.wrong("corrupt", CRC)
        ahead, same = seq - self.seq & M32, session == self.session
        if same and 1 <= ahead <= AHEAD:
            self.seq, self.seen = seq, (self.seen << min(ahead, 64) | 1) & (1 << 64) - 1
            self.count["missing"] = self.count["missing"] + ahead - 1 & M32
            return self.accepted(kind)
        if kind == HELLO and (self.open and not (same and ahead == 0) or self.session == 0):
            if not same:
                self.former = self.session
            self.session, self.seq, self.seen = session, seq, (1 << 64) - 1
            return self.accepted(kind)
        if same:
            return self.not_next(ahead, kind)
        return self.wrong("old", STALE) if session == self.former else self.wrong("stranger", STATE)

    def accepted(self, kind):
        self.count["accepted"] += 1
        self.quiet = self.open = 0
        return kind

    def wait(self, time, limit=QUIET):
        was = self.open
        if self.session == 0:
            return 0
        self.quiet = min(self.quiet + time, M32)
        self.open = int(self.quiet >= limit)
        self.count["silences"] += self.open > was
        return int(self.open > was)

    def not_next(self, ahead, kind):
        count = self.count
        if ahead and ahead < 1 << 31:
            return self.wrong("far", RANGE)
        back = -ahead & M32
        if back >= 64:
            return self.wrong("old", STALE)
        if self.seen >> back & 1:
            return self.wrong("duplicate", STALE)
        self.seen |= 1 << back
        count["missing"] = count["missing"] - 1 & M32
        late = self.wrong("reordered", STALE)
        return kind if kind in (PARAM, ACK) else late

    def state(self):
        return self.pack(self.seen, self.seq, self.session, self.former, self.quiet, self.open,
                         *(self.count[c] for c in COUNTS))


# --- stimuli ---

def any_bytes(rng, n):
    return bytearray(b"".join(pack("<Q", rng.u64()) for _ in range((n + 7) // 8))[:n])


def any_body(rng, kind):
    """A payload that can be."""
    if kind == PARAM:
        row, instance = VALUES[rng.draw(0, len(VALUES) - 1)]
        ident = row[0] + (rng.draw(0, 7) == 0)
        value = rng.draw(-6, 6)
        return bytearray(pack("<HHi", ident, instance, value))
    body = any_bytes(rng, LENGTH.get(kind, 0))
    if kind == HELLO:
        body[0] &= 1
    for i in MASKS.get(kind, ()):
        body[i] &= 31
    if kind == TELL:
        body[5] %= 3
    if kind == TRACE:
        body[8:10] = bytes(2)
        body[10] = rng.draw(0, 11)
        if body[10] == 0:
            body[9] = rng.draw(128, 255)
    if kind == PLANES:
        for f in range(5):
            told = rng.draw(0, 2)
            body[9 + 40 * f] = told if body[8] >> f & 1 else 0
    return body


def spoil(rng, kind, body):
    """One value that cannot be."""
    if kind == HELLO:
        body[0] = rng.draw(2, 255)
    elif kind == TELL:
        i = (4, 6, 7, 5, 5)[rng.draw(0, 4)]
        if i == 5:
            body[5] = rng.draw(3, 255)
        else:
            body[i] |= 32 << rng.draw(0, 2)
    elif kind == PLANES:
        how, f = rng.draw(0, 2), rng.draw(0, 4)
        if how == 0:
            body[8] |= 32 << rng.draw(0, 2)
        elif how == 1:
            body[8] |= 1 << f
            body[9 + 40 * f] = rng.draw(3, 255)
        else:
            body[8] &= ~(1 << f)
            body[9 + 40 * f] = rng.draw(1, 2)
    elif kind == TRACE:
        how = rng.draw(0, 2)
        if how == 0:
            body[10] = rng.draw(12, 255)
        elif how == 1:
            body[9] = 1
        else:
            body[9], body[10] = 255, body[10] | 1


def forged(rng, p):
    """Something else with a CRC that is right."""
    head, how = bytearray(p[:-4]), rng.draw(0, 6)
    if how == 0:
        head[2] = rng.draw(2, 255)
    elif how == 1:
        head[3] = rng.draw(8, 255)
    elif how == 2:
        head[6:10] = bytes(4)
    elif how == 3:
        body = head[18:]
        spoil(rng, head[3], body)
        head[18:] = body
    elif how == 4:
        head[0] ^= 1 << rng.draw(0, 7)
    else:
        n = len(head) - 19 if how == 5 else 300
        head[4:6] = pack("<H", n)
        head = head[:18 + n] + bytes(max(0, 18 + n - len(head)))
    return sealed(bytes(head))


class World:
    """Both ends, and all packets of the present set-up."""

    def __init__(self, rng):
        self.tx = Sender(rng.u64() & M32 | 1, rng.draw(-40, 40) & M32)
        self.rx, self.params, self.sent, self.begun = Receiver(), Params(), [], 0

    def send(self, rng):
        """(type, room, what write said)"""
        if rng.draw(0, 31) == 0:
            self.tx, self.begun = Sender(rng.u64() & M32 | 1, self.tx.seq), 0
        if rng.draw(0, 31) == 0:
            self.tx.seq = self.tx.seq + rng.draw(1, 200) & M32
        kind = rng.draw(1, 7) if rng.draw(0, 31) else rng.draw(8, 255) % 255
        if not self.begun and rng.draw(0, 1):
            kind, self.begun = HELLO, 1
        if self.rx.open and rng.draw(0, 1):
            kind = HELLO
        body = any_body(rng, kind)
        if rng.draw(0, 7) < 3:
            spoil(rng, kind, body)
        if kind == TRACE:
            body = body[:11 + 20 * body[10]]
        stamp = rng.u64() & M32
        cap = 256 if rng.draw(0, 7) else rng.draw(0, 255)
        tx = self.tx if rng.draw(0, 63) else Sender(0, 0)
        p = tx.write(kind, bytes(body), stamp, cap)
        if isinstance(p, int):
            return kind, cap, p, 0
        self.sent.append(p)
        return kind, cap, len(p), unpack_from("<I", p, len(p) - 4)[0]

    def arriving(self, rng):
        """(how, a datagram)"""
        how, n = rng.draw(0, 15), len(self.sent)
        if n == 0:
            return how, b""
        if self.rx.open and rng.draw(0, 1):
            return how, self.sent[rng.draw(0, n - 1)]  # of any session, from any time
        if how < 2 or how == 6:
            return how, self.sent[n - 1 - min(n - 1, rng.draw(1, 6 if how == 6 else 80))]
        p = self.sent[-1]
        if how == 2:
            i, p = rng.draw(0, 8 * len(p) - 1), bytearray(p)
            p[i >> 3] ^= 1 << (i & 7)
        elif how == 3:
            p = p[:rng.draw(0, len(p) - 1)]
        elif how == 4:
            p = p + bytes(rng.draw(1, 8))
        elif how in (5, 10):
            p = forged(rng, p)
        elif how in (9, 11, 12, 13):
            p = self.numbered(rng, p)
        return how, bytes(p)

    def numbered(self, rng, p):
        """The packet with a number near an end of what is taken; the sender goes on from a newer
        one."""
        on = ((-64, 1 << 31, -64, 1 << 31, -64, 1 << 31, -64, 0, AHEAD)[rng.draw(0, 8)] +
              rng.draw(-1, 1))
        seq = self.rx.seq + on & M32
        if 0 < on <= AHEAD:
            self.tx.seq = seq + 1 & M32
        return sealed(p[:10] + pack("<I", seq) + p[14:-4])

    def taken(self, p):
        """What the receiver says and hands on; a parameter is staged."""
        got = self.rx.take(p)
        if got < 0:
            return (got,) + (0,) * 9
        seq, stamp = unpack_from("<II", p, 10)
        body, plane, trip, ack = p[18:-4], 0, 0, (0,) * 5
        if got == PLANES:
            at = 9 + 40 * (seq % 5)
            plane = zlib.crc32(body[at:at + 28])
            trip = stamp - unpack_from("<I", body, 4)[0] & M32
        if got == PARAM:
            ident, instance, value = unpack_from("<HHi", body)
            ack = ident, instance, value, self.params.stage(ident, instance, value, True), seq
        return (got, seq, stamp, zlib.crc32(body), plane, trip) + ack[:1] + ack[2:]

    def values(self):
        return zlib.crc32(pack("<%di" % (2 * len(VALUES)), *self.params.active,
                               *self.params.staged))


def wire(rate):
    rng = Rng("wire", rate, 0)
    for k in range(TICKS):
        if k in (0, AGAIN):
            w = World(rng)
        if k == 128:
            w.params.locked = 1
        quiet = w.rx.wait((1, 999999, 1000000, M32)[rng.draw(0, 3)] if rng.draw(0, 3) == 0
                          else rng.draw(0, 2))
        sent = w.send(rng)
        how, p = w.arriving(rng)
        row = w.taken(p)
        twice = w.rx.take(p) if how == 8 else 0
        if k % 8 == 7:
            w.params.apply()
        yield ((quiet, *sent[:2], how, len(p), *sent[2:], *row, twice, w.values()),
               pack("<II", w.tx.session, w.tx.seq) + w.rx.state())


WIRE = ("quiet type cap how len | written crc taken seq stamp_us payload plane trip_us ack_id "
        "ack_value ack_result "
        "ack_seq twice values")

MODULES = {"wire": (WIRE, wire)}
