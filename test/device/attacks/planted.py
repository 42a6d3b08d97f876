# SPDX-License-Identifier: MIT
"""Errors planted one at a time: each verdict must tell the one that it is there for."""

import contextlib
import multiprocessing
import unittest.mock

import files
import link
import ports
import rig
import wire

AT_ONCE = 4
SOFTER = wire.param(link.MAT_F_MAX, 1 << 20)


def of(table, name, **other):
    """The one row of this name, with another verdict."""
    row = next(row for row in table if row[0] == name)
    return (row[:3] + (other.get("want", row[3]), other.get("must", row[4])),)


def with_the_key(aim):
    """Somebody who knows the key, and makes a wall softer."""
    world = aim.world
    return link.paced(aim.by_peer, [world.keyed.seal(world.make(wire.PARAM, SOFTER))
                                    for _ in range(100)])


def readers(port):
    """Clients that ask once, each for himself."""
    kept = []
    for _ in range(ports.IDLE):
        kept.append(ports.Client(port))
        kept[-1].test_int()
    return ports.IDLE, [client.sock for client in kept]


OPEN, KEYED = link.OPEN, link.KEYED
FEW = {"OPEN": of(OPEN, "replay"), "KEYED": of(KEYED, "key-replay"),
       "APPROACHES": of(link.APPROACHES, "bil-session")}
# part, what is other than it must be, in which module, what a row must say of it
PLANTED = (
    ("link", "0.2 A above the person's ceiling", rig, {"TOLD": {"person_i": 0.7}}, "i_des_a is 0."),
    ("key", "1 N above it", rig, {"TOLD": {"person_f": 3}}, "f_des_n is 3"),
    ("bilateral", "the same", rig, {"TOLD": {"person_f": 3}}, "f_des_n is 3"),
    ("link", "a silence of 1.5 s", rig, {"TOLD": {"quiet": 1500}, "OPEN": of(OPEN, "planes-far")},
     "behind it the peer was not heard for 1."),
    ("link", "the peer is not heard meanwhile", link,
     {"OPEN": of(OPEN, "planes-far", must="stays")}, " the peer was not heard for "),
    ("link", "a value that may be set", link,
     {"HARDER": (SOFTER, SOFTER), "OPEN": of(OPEN, "param-peer")}, "materials set"),
    ("link", "the peer's own port", link,
     {"OPEN": of(OPEN, "param-port"), "Aim.by_other": link.Aim.by_peer}, "other senders: 0 of"),
    ("key", "an attacker with the key", link,
     {"KEYED": (("key-forged", "", with_the_key, {"of another key": 0.9}, "stays"),)},
     "of another key: 0 of"),
    ("modbus", "a value that may be set, and --modbus-write", ports,
     {"HARDER": (("f_max", 0.75),), "READING": ["--modbus-write"]},
     "parameter f_max, instance 0: 0.75 N, by register"),
    ("modbus", "--remote", ports, {"READING": ["--modbus-write", "--remote"]}, "of 4 taken"),
    ("modbus", "clients that read beside a slow monitor", ports,
     {"PAUSE_S": 2.0, "idle": readers}, "lost its connection"),
    ("files", "a sound image in the place of a damaged one", files, {"spoilt": lambda whole: whole},
     "it was taken"),
    ("files", "a tenth that is none", files, {"heavier": lambda whole, times: whole},
     "it was taken"),
    ("files", "1 N above the ceiling", rig, {"TOLD": {"person_f": 3}}, "f_des_n is 3"),
    ("listen", "a liar with the box's address", files, {"liar": lambda box, other, key: (box, key)},
     "or not the log's"),
)


def patched(stack, module, other):
    for name, value in {**FEW, **other}.items():
        where = link if name in FEW else module
        for more in name.split(".")[:-1]:
            where = getattr(where, more)
        stack.enter_context(unittest.mock.patch.object(where, name.split(".")[-1], value))


def try_one(n):
    """What the rows of this part say."""
    part, _, module, other, _ = PLANTED[n]
    with contextlib.ExitStack() as stack:
        patched(stack, module, other)
        return WITH["parts"](part, n)


WITH = {}  # what a process of the pool has from this one


def run(parts):
    """parts(name, number): the part run, and what was wrong. 1 if an error was not told."""
    missed = 0
    WITH["parts"] = parts
    with multiprocessing.get_context("fork").Pool(AT_ONCE, maxtasksperchild=1) as pool:
        for error, wrong in zip(PLANTED, pool.imap(try_one, range(len(PLANTED)), 1)):
            told = [line for line in wrong if error[4] in line]
            missed += not told
            print("%-8s %-9s %-46s %s" % ("told" if told else "NOT TOLD", error[0], error[1],
                                          told[0] if told else wrong), flush=True)
    print("attacks: %d errors planted, %d not told" % (len(PLANTED), missed))
    return 1 if missed else 0
