# SPDX-License-Identifier: MIT
"""Plants errors one at a time: each verdict must detect the error that it is meant for."""

import contextlib
import multiprocessing
from unittest import mock

import image
import link
import ports
import wire

AT_ONCE = 4
SOFTER = wire.param(link.MAT_F_MAX, 1 << 20)


def of(table, name, **other):
    """The one row of this name, with another verdict."""
    row = next(row for row in table if row[0] == name)
    return (row[:3] + (other.get("want", row[3]), other.get("must", row[4])),)


def with_the_key(aim):
    """An attacker who knows the key makes a wall softer."""
    world = aim.world
    return link.paced(aim, aim.by_peer, [world.keyed.seal(world.make(wire.PARAM, SOFTER))
                                    for _ in range(100)])


def readers(port):
    """Clients that ask once, each for himself."""
    kept = []
    for _ in range(ports.IDLE):
        kept.append(ports.Client(port))
        kept[-1].test_int()
    return ports.IDLE, [client.sock for client in kept]


# Of each part a row that is short, where the planted one has no other.
FEW = {"link.OPEN": of(link.OPEN, "replay"), "link.KEYED": of(link.KEYED, "key-replay"),
       "link.APPROACHES": of(link.APPROACHES, "bil-session"),
       "image.OPEN": of(image.OPEN, "replay"), "image.SECONDS": 9}
MORE_A, MORE_N = {"rig.TOLD": {"person_i": 0.7}}, {"rig.TOLD": {"person_f": 3}}
F_MAX = {"ports.HARDER": (("f_max", 0.75),)}
CHANGED = "parameter f_max, instance 0: 0.75 N, by register"
# part, what is other than it must be, and how; what a row must say of it
PLANTED = (
    ("link", "0.2 A above the person's ceiling", MORE_A, "i_des_a is 0."),
    ("key", "1 N above it", MORE_N, "f_des_n is 3"),
    ("bilateral", "the same", MORE_N, "f_des_n is 3"),
    ("files", "the same", MORE_N, "f_des_n is 3"),
    ("image", "0.2 A above it", MORE_A, "i_des_a is 0."),
    ("link", "a silence of 1.5 s",
     {"rig.TOLD": {"quiet": 1500}, "link.OPEN": of(link.OPEN, "planes-far")},
     "behind it the peer was not heard for 1."),
    ("link", "the peer is not heard meanwhile",
     {"link.OPEN": of(link.OPEN, "planes-far", must="stays")}, " the peer was not heard for "),
    ("link", "a value that may be set",
     {"link.HARDER": (SOFTER, SOFTER), "link.OPEN": of(link.OPEN, "param-peer")}, "materials set"),
    ("link", "the peer's own port",
     {"link.OPEN": of(link.OPEN, "param-port"), "link.Aim.by_other": link.Aim.by_peer},
     "other senders: 0 of"),
    ("key", "an attacker with the key",
     {"link.KEYED": (("key-forged", "", with_the_key, {"of another key": 0.9}, "stays"),)},
     "of another key: 0 of"),
    ("modbus", "a value that may be set, and --modbus-write",
     {**F_MAX, "ports.READING": ["--modbus-write"]}, CHANGED),
    ("modbus", "--remote", {"ports.READING": ["--modbus-write", "--remote"]}, "of 4 taken"),
    ("modbus", "clients that read beside a slow monitor",
     {"ports.PAUSE_S": 2.0, "ports.idle": readers}, "lost its connection"),
    ("image-com2", "a value that may be set, and ,write",
     {**F_MAX, "image.MODBUS": image.MODBUS + ",write"}, CHANGED),
    ("files", "a sound calibration in the place of a damaged one",
     {"files.spoilt": lambda whole: whole}, "it was taken"),
    ("files", "a tenth that is none", {"files.heavier": lambda whole, times: whole},
     "it was taken"),
    ("listen", "a liar with the box's address", {"files.liar": lambda box, other, key: (box, key)},
     "or not the log's"),
)
WITH = {}  # what a process of the pool has from this one


def try_one(n):
    """What the rows of this part say: of four tries the first that shows the error. Whether the
    peer is lost meanwhile depends on when packets meet, so one try may show nothing."""
    part, _, other, must = PLANTED[n]
    with contextlib.ExitStack() as stack:
        for name, value in {**FEW, **other}.items():
            stack.enter_context(mock.patch(name, value))
        for _ in range(4):
            wrong = WITH["parts"](part, n)
            if any(must in line for line in wrong):
                break
        return wrong


def run(parts, names):
    """parts(name, number): the part run, and its findings. Returns 1 if an error was not
    detected."""
    missed, some = 0, [n for n, error in enumerate(PLANTED) if error[0] in names]
    WITH["parts"] = parts
    with multiprocessing.get_context("fork").Pool(AT_ONCE, maxtasksperchild=1) as pool:
        for (part, what, _, must), wrong in zip((PLANTED[n] for n in some),
                                                pool.imap(try_one, some, 1)):
            told = [line for line in wrong if must in line]
            missed += not told
            print("%-8s %-10s %-49s %s" % ("told" if told else "NOT TOLD", part, what,
                                           told[0] if told else wrong), flush=True)
    print("attacks: %d errors planted, %d not told" % (len(some), missed))
    return 1 if missed or not some else 0
