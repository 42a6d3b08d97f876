# SPDX-License-Identifier: MIT
"""slots: images in two slots of flash, and which of them counts."""

import zlib
from struct import pack, unpack_from

from .num import CRC, M32, SHORT, TICKS, UNKNOWN, Rng

ABSENT, OVER = 10, 20
MAGIC = 0x53485845
AHEAD = (0, 1, 0x7FFFFFFF, 0x80000000)


def read(b):
    """(sequence, image), or the error."""
    if len(b) < OVER:
        return -SHORT
    magic, sequence, length = unpack_from("<III", b)
    if magic != MAGIC:
        return -UNKNOWN
    if length > len(b) - OVER:
        return -SHORT
    crc, again = unpack_from("<II", b, 12 + length)
    if sequence in (0, M32) or again != sequence or crc != zlib.crc32(b[:12 + length]):
        return -CRC
    return sequence, bytes(b[12:12 + length])


def pick(s):
    """(which, sequence, image)."""
    a, b = map(read, s)
    if isinstance(a, int) and isinstance(b, int):
        return -ABSENT, 0, b""
    if isinstance(a, int) or not isinstance(b, int) and 1 <= (b[0] - a[0] & M32) < 1 << 31:
        return (1, *b)
    return (0, *a)


def whole(sequence, image):
    head = pack("<III", MAGIC, sequence, len(image)) + image
    return head + pack("<II", zlib.crc32(head), sequence)


def after(s, cap, image):
    """(bytes to program or the error, which, they)."""
    room = min(cap, len(s[0]))
    if room < OVER or len(image) > room - OVER:
        return -SHORT, 9, b""
    which, sequence, stands = pick(s)
    if which >= 0 and stands == image:
        return 0, which, b""
    out = whole(1 if sequence == M32 - 1 else sequence + 1, image)
    return len(out), int(which == 0), out


def any_sequence(rng):
    near = (1, 0x7FFFFFFF, 0x80000000, M32 - 1)[rng.draw(0, 3)]
    return near + rng.draw(-1, 1) & M32


def any_slots(rng):
    """Blank, or each with an image of any sequence."""
    size = rng.draw(19, 84)
    s = [bytearray(b"\xff" * size) for _ in range(2)]
    for k in range(2):
        forged, length = rng.draw(0, 3), rng.draw(0, 31)
        sequence = (sequence + AHEAD[rng.draw(0, 3)] & M32 if k and rng.draw(0, 1)
                    else any_sequence(rng))
        out = whole(sequence, bytes(37 * i & 255 for i in range(length)))
        if forged and len(out) <= size:
            s[k][:len(out)] = out
    return s


def slots(rate):
    rng = Rng("slots", rate, 0)
    for k in range(TICKS):
        if k % 4 == 0:
            s, image = any_slots(rng), b""
            size = len(s[0])
        length, first, again, short = (rng.draw(0, size), rng.draw(0, 255), rng.draw(0, 3) == 0,
                                       rng.draw(0, 7) == 0)
        cap = rng.draw(0, size) if short else 96
        image = image if again else bytes(first + 37 * i & 255 for i in range(length))
        image = image if short else image[:cap - OVER]
        n, to, out = after(s, cap, image)
        blank, cut, bit = rng.draw(0, 2), rng.draw(0, 3 * size), rng.draw(0, 31 * size)
        if n > 0:
            if blank < 2:
                s[to][:] = bytes((0xFF, 0)[blank] for _ in range(size))
            s[to][:min(cut, n)] = out[:cut]
        if bit < 16 * size:
            s[bit & 1][bit >> 4] ^= 1 << (bit >> 1 & 7)
        a, b = map(read, s)
        which, sequence, stands = pick(s)
        told = (a if isinstance(a, int) else 0, b if isinstance(b, int) else 0)
        yield (n, to, *told, which, sequence, len(stands), zlib.crc32(stands)), bytes(s[0] + s[1])


COLUMNS = "n to | said0 said1 which sequence len crc"

MODULES = {"slots": (COLUMNS, slots)}
