# SPDX-License-Identifier: MIT
"""mac: SipHash-2-4 in Python's integers, as the paper has it."""

from functools import cache
from struct import pack

from .num import TICKS, Rng, wrap64

M64 = (1 << 64) - 1


def turn(v, by):
    return (v << by | v >> 64 - by) & M64


def one_round(v):
    """Halves in the paper's figure 2.1: (v0, v1), (v2, v3), then crosswise."""
    for x, y, z, w, by in ((0, 1, 2, 3, (13, 16)), (2, 1, 0, 3, (17, 21))):
        v[x], v[z] = v[x] + v[y] & M64, v[z] + v[w] & M64
        v[y], v[w] = turn(v[y], by[0]) ^ v[x], turn(v[w], by[1]) ^ v[z]
        v[x] = turn(v[x], 32)


def mac(key, text):
    k = [int.from_bytes(key[i:i + 8], "little") for i in (0, 8)]
    start = b"somepseudorandomlygeneratedbytes"
    v = [int.from_bytes(start[8 * i:8 * i + 8], "big") ^ k[i & 1] for i in range(4)]
    padded = text + bytes(-(len(text) + 1) % 8) + bytes([len(text) & 255])
    for at in range(0, len(padded), 8):
        m = int.from_bytes(padded[at:at + 8], "little")
        v[3] ^= m
        one_round(v)
        one_round(v)
        v[0] ^= m
    v[2] ^= 255
    for _ in range(4):
        one_round(v)
    return v[0] ^ v[1] ^ v[2] ^ v[3]


@cache
def published(n):
    return mac(bytes(range(16)), bytes(range(n)))


def ticks(rate):
    """The 64 tags of the paper's key and texts, then any key and up to 32 bytes."""
    r = Rng("mac", rate, 0)
    for tick in range(TICKS):
        if tick < 64:
            n, tag = tick, published(tick)
        else:
            n = r.draw(0, 32)
            key, text = pack("<QQ", r.u64(), r.u64()), pack("<QQQQ", *(r.u64() for _ in range(4)))
            tag = mac(key, text[:n])
        yield (n, wrap64(tag)), b""


MODULES = {"mac": ("n | tag", ticks)}
