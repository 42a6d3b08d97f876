# SPDX-License-Identifier: MIT
"""fix, bytes and record: below everything else."""

import zlib
from struct import pack

from .num import (CRC, M32, MAX32, SHORT, TICKS, UNKNOWN, VERSION, Refused, Rng, clamp, gain,
                  sat32, shr, times, wrap, wrap64)


def any_period(r):
    """Mostly about as long or as short as they may be."""
    den = r.draw(1, M32) >> r.draw(0, 31)
    near = (den * 1001 // 1000, den // 20020, r.draw(0, M32))[r.draw(0, 2)] + r.draw(-1, 1)
    return clamp(near, 0, M32), den


def period_ok(num, den):
    return int(num > 0 and 1000 * num <= 1001 * den and den <= 20020 * num)


def fix(rate):
    r = Rng("fix", rate, 0)
    for _ in range(TICKS):
        v, a, b = r.corner(), wrap(r.corner()), wrap(r.corner())
        lo = wrap(r.corner())
        hi = r.draw(lo, MAX32)
        n = r.draw(1, 62)
        num = r.u64() >> r.draw(0, 63)
        den = r.u64() >> r.draw(0, 63) | 1
        err, g = 0, (0, 0)
        try:
            g = gain(num, den)
        except Refused as e:
            err = -e.args[0]
        T = any_period(r)
        yield (v, a, b, *T, sat32(v), clamp(v, lo, hi), shr(v, n), shr(a * b, n),
               shr(v * (b & MAX32), 31), wrap(b), wrap(a - b), wrap(a + b), err, g[0], g[1],
               times(g, a), wrap64(num // den), wrap64(num % den), period_ok(*T)), b""


FIX = ("v a b T_num T_den | sat32 clamp shr_round mul_shr mul64_q31 from_u32 wrap_diff wrap_add "
       "err mant shift gain_mul quotient remainder period_ok")

FIELDS = (("<B", 8, 0), ("<H", 16, 0), ("<h", 16, 1), ("<I", 32, 0), ("<i", 32, 1), ("<q", 64, 1))


def low(v, bits, signed):
    v &= (1 << bits) - 1
    return v - (1 << bits) if signed and v >> (bits - 1) else v


def bytes_(rate):
    """Fields of all widths into a buffer that may be too small, and back."""
    r, crc = Rng("bytes", rate, 0), 0
    for _ in range(TICKS):
        cap, buf, at = r.draw(0, 26), bytearray(b"\xa5" * 26), 0
        for form, bits, signed in FIELDS:
            field = pack(form, low(r.corner(), bits, signed))
            if at + len(field) <= cap:
                buf[at:at + len(field)] = field
            at += len(field)
        crc = zlib.crc32(bytes(buf), crc)
        got, at2 = [], 0
        for form, bits, signed in FIELDS:
            n = bits // 8
            got.append(low(int.from_bytes(buf[at2:at2 + n], "little"), bits, signed)
                       if at2 + n <= cap else 0)
            at2 += n
        yield (cap, at, 1 if at <= cap else 0, crc, *got), b""


BYTES = "cap | at ok crc u8 u16 i16 u32 i32 i64"


def read_record(buf):
    """What exh_record_decode() says of the bytes: (result, type, version, length, seq, tick)."""
    bad = lambda e: (-e, 0, 0, 0, 0, 0)
    if len(buf) < 2:
        return bad(SHORT)
    if buf[0:2] != b"\x45\x58":
        return bad(UNKNOWN)
    if len(buf) < 18:
        return bad(SHORT)
    n = int.from_bytes(buf[4:6], "little")
    if len(buf) < 18 + n:
        return bad(SHORT)
    if zlib.crc32(buf[:14 + n]) != int.from_bytes(buf[14 + n:18 + n], "little"):
        return bad(CRC)
    if buf[3] != 3:
        return bad(VERSION)
    return (18 + n, buf[2], buf[3], n, int.from_bytes(buf[6:10], "little"),
            int.from_bytes(buf[10:14], "little"))


def record(rate):
    """Records written into room that may be too small, and read back damaged or cut short."""
    r = Rng("record", rate, 0)
    for k in range(TICKS):
        kind, seq, n = r.draw(0, 255), r.u64() & 0xFFFFFFFF, r.draw(0, 40)
        cap = r.draw(0, 63) if r.draw(0, 7) == 0 else 64
        payload = bytes(r.draw(0, 255) for _ in range(n))
        whole = pack("<HBBHII", 0x5845, kind, 3, n, seq, k) + payload
        whole += pack("<I", zlib.crc32(whole))
        size = len(whole) if len(whole) <= cap else 0
        how, where, version = r.draw(0, 3), r.draw(0, 8 * len(whole) - 1), r.draw(0, 9)
        buf = bytearray(whole)
        if version == 0:  # a record of another version, whole otherwise
            buf[3] = 4
            buf[-4:] = pack("<I", zlib.crc32(bytes(buf[:-4])))
        if how & 1:
            at = where if how == 1 else where & 15
            buf[at >> 3] ^= 1 << (at & 7)
        if how & 2:
            del buf[where >> 3:]
        yield (size, zlib.crc32(whole[:-1]) if size else 0, how, len(buf),
               *read_record(bytes(buf))), b""


RECORD = "size crc how len read type version length seq tick"

MODULES = {"fix": (FIX, fix), "bytes": (BYTES, bytes_), "record": (RECORD, record)}
