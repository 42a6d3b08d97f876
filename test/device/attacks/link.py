# SPDX-License-Identifier: MIT
"""Attacks on the link: what each sends. A function gives how often it tried."""

import os
import random
import socket
import struct
import time

import wire

MAT_K, MAT_F_MAX = 0x0B01, 0x0B03
HARDER = (wire.param(MAT_K, 1000000 << 10), wire.param(MAT_F_MAX, 100 << 20))
FROM_STATE_TO_STATE = 10
OTHERS = "packets of other senders"
FAR = (0.0, 0.0, 1.0)


class Aim:
    """Whom to hit: by the peer's own address, or by another port of its machine."""

    def __init__(self, world, flood):
        self.world, self.flood = world, flood
        self.chance, self.ahead = random.Random(1), 0
        self.stray = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)

    def next_numbers(self, n):
        """The first of n that the peer has not come to, and that were not used here."""
        first = max(self.world.number + 500, self.ahead)
        self.ahead = first + n
        return first

    def by_peer(self, data):
        self.world.put(data)

    def by_other(self, data):
        self.stray.sendto(data, self.world.box)


def paced(aim, send, many):
    """Slow enough that the box's queue is never full: what is counted was sent."""
    n = 0
    for data in many:
        send(data)
        n += 1
        if n % FROM_STATE_TO_STATE == 0:
            aim.world.next()
    return n


def param_other_port(aim):
    return paced(aim, aim.by_other, (wire.packet(wire.PARAM, 77, n, 0, HARDER[n % 2])
                                for n in range(1, 401)))


def param_of_session(aim):
    return paced(aim, aim.by_other, (aim.world.make(wire.PARAM, HARDER[n % 2], aim.world.number + n)
                                for n in range(1, 401)))


def param_as_peer(aim):
    """The best that he can do who sees the link and has the peer's address: next numbers."""
    at = aim.next_numbers(400)
    return paced(aim, aim.by_peer, [aim.world.make(wire.PARAM, HARDER[n % 2], at + n)
                               for n in range(400)])


def replay_session(aim):
    return paced(aim, aim.by_peer, aim.world.sent[:400])


def replay_earlier(aim):
    return paced(aim, aim.by_peer, aim.world.before[:400] * 3)


def reordered(aim):
    """Numbers that were skipped, brought when more than 64 newer ones have come."""
    with aim.world.lock:
        first = aim.world.number + 1
        aim.world.number += 200
    held = [aim.world.make(wire.PLANES, aim.world.plane(FAR, -0.3), first + n)
            for n in range(200)]
    while aim.world.number < first + 200 + 70:
        time.sleep(0.05)
    return paced(aim, aim.by_peer, held)


def hello_storm(aim):
    hello = wire.hello(aim.world.version)
    return paced(aim, aim.by_peer, (wire.packet(wire.HELLO, 1000 + n, 1, n, hello)
                               for n in range(1500)))


def planes_far(aim):
    at = aim.next_numbers(400)
    return paced(aim, aim.by_peer, (
        aim.world.make(wire.PLANES, aim.world.plane(FAR, (-1.9, 1.9)[n % 2]), at + n)
        for n in range(400)))


def planes_long(aim):
    at = aim.next_numbers(400)
    return paced(aim, aim.by_peer, (
        aim.world.make(wire.PLANES, aim.world.plane((1.2, 1.2, -1.06), 0.5), at + n)
        for n in range(400)))


def misshapen(aim):
    whole = aim.world.make(wire.PLANES, aim.world.plane(), aim.world.number + 500)
    cut = [whole[:n] for n in range(1, len(whole))]
    more = [whole + bytes(n) for n in range(1, 120)]
    return paced(aim, aim.by_peer, cut + more)


def tags_forged(aim):
    """Random tags, and tags of another key."""
    whole = aim.world.make(wire.PARAM, HARDER[0], aim.world.number + 500)
    echo = struct.pack("<QQ", aim.world.keyed.next + 500, aim.world.keyed.heard)
    false = wire.Keyed(os.urandom(16))
    false.heard, false.next = aim.world.keyed.heard, aim.world.keyed.next + 500
    return paced(aim, aim.by_peer, [whole + echo + os.urandom(8) for _ in range(200)] +
                 [false.seal(whole) for _ in range(200)])


def flood_of(send_to, aim):
    """In a separate process, as fast as possible: random bytes of all lengths."""
    bodies = [aim.chance.randbytes(aim.chance.randrange(1, 300)) for _ in range(100)]
    pid = os.fork()
    if pid == 0:
        for n in range(aim.flood):
            try:
                send_to.sendto(bodies[n % 100], aim.world.box)
            except OSError:
                pass
        os._exit(0)
    os.waitpid(pid, 0)
    return aim.flood


def flood_other_port(aim):
    return flood_of(aim.stray, aim)


def flood_as_peer(aim):
    return flood_of(aim.world.sock, aim)


# name, text, function, least shares, state of the true peer. A share is that of a counter (column)
# in the packets sent. The true peer "stays" heard, or is heard "again" within a second of the end.
# An attack may use the peer's address with the next numbers. A link without a key accepts it
# (docs/WIRE.md, "Whom to answer"). Then the peer's next HELLO after `quiet` is heard.
OPEN = (
    ("param-port", "PARAM mat_k 1e6, mat_f_max 100, another port", param_other_port,
     {OTHERS: 0.9}, "stays"),
    ("param-session", "the same, of the true session", param_of_session, {OTHERS: 0.9}, "stays"),
    ("replay", "the session's own packets once more", replay_session, {"late": 0.9}, "stays"),
    ("replay-earlier", "packets of the session before", replay_earlier, {"late": 0.9}, "stays"),
    ("reordered", "skipped numbers, more than 64 back", reordered, {"late": 0.9}, "stays"),
    ("hello-storm", "HELLO of fresh sessions, by the peer's address", hello_storm,
     {"late": 0.9}, "stays"),
    ("misshapen", "cut off and too long", misshapen,
     {"bad": 0.7, "of the world's too long": 0.2}, "stays"),
    ("flood-peer", "random bytes, the peer's address", flood_as_peer, {"bad": 0.0}, "again"),
    ("planes-far", "planes 1.9 m off, next numbers", planes_far, {"accepted": 0.9}, "again"),
    ("planes-long", "normals of length 2, next numbers", planes_long, {"refused": 0.9}, "again"),
    ("param-peer", "PARAM, the peer's address, next numbers", param_as_peer,
     {"accepted": 0.9, "set": 0.0}, "again"),
)
KEYED = (
    ("key-none", "PARAM without a tag", param_as_peer, {"without a key": 0.9}, "stays"),
    ("key-forged", "forged tags, and of another key", tags_forged, {"of another key": 0.9},
     "stays"),
    ("key-replay", "the session's own packets once more", replay_session, {"again": 0.9}, "stays"),
    ("key-earlier", "packets of the run before", replay_earlier, {"not proved": 0.9}, "stays"),
    ("key-misshapen", "cut off and too long", misshapen, {"damaged": 0.3}, "stays"),
    ("flood-port", "random bytes, another port", flood_other_port, {OTHERS: 0.0}, "again"),
)
# Of `exhand bilateral`, which prints no senders.
APPROACHES = (
    ("bil-session", "PARAM of the true session, another port", param_of_session, {}, "stays"),
    ("bil-storm", "HELLO of fresh sessions", hello_storm, {"late": 0.9}, "stays"),
    ("bil-param", "PARAM, the peer's address, next numbers", param_as_peer,
     {"accepted": 0.9, "set": 0.0}, "again"),
)
