# SPDX-License-Identifier: MIT
"""The scenes' tables of signals: what each output and each parameter is."""
from __future__ import annotations

import ctypes as c
from dataclasses import dataclass

from ._lib import lib

FINGERS = ("thumb", "index", "middle", "ring", "little")


class Row(c.Structure):
    """struct exh_signal (exhand/signal.h)."""
    _fields_ = [("id", c.c_uint16), ("frac", c.c_uint8), ("when", c.c_uint8), ("min", c.c_int32),
                ("max", c.c_int32), ("dflt", c.c_int32), ("name", c.c_char_p),
                ("unit", c.c_char_p), ("help", c.c_char_p)]


class Group(c.Structure):
    """struct exh_signal_group."""
    _fields_ = [("row", c.POINTER(Row)), ("rows", c.c_uint16), ("instances", c.c_uint16)]


class Table(c.Structure):
    """struct exh_signal_table."""
    _fields_ = [("group", c.POINTER(Group)), ("groups", c.c_uint16)]


@dataclass(frozen=True)
class Signal:
    """One value of a scene: value = raw / 2^frac, in `unit` (ASCII: n_per_m; "" for none)."""
    name: str
    unit: str
    help: str
    id: int
    frac: int
    instance: int  # of several, or None
    instances: int
    group: int  # 0: those of the paper


@dataclass(frozen=True)
class Scene:
    """A scene: its outputs and parameters in the order of a frame and of a parameter image."""
    name: str
    outputs: tuple[Signal, ...]
    params: tuple[Signal, ...]
    outputs_crc: int
    has_glove: bool


def _read(k: int, of_params: int) -> tuple[tuple[Signal, ...], int]:
    address = lib.door_table(k, of_params)
    if not address:
        return (), 0
    table, found = Table.from_address(address), []
    for g in range(table.groups):
        group = table.group[g]
        for instance in range(group.instances):
            for row in group.row[:group.rows]:
                found.append((g, instance, group.instances, row))
    return tuple(Signal(row.name.decode(), row.unit.decode(), row.help.decode(), row.id, row.frac,
                        instance, instances, g) for g, instance, instances, row in found), \
        lib.exh_signal_crc(address)


def _scenes() -> dict[str, Scene]:
    found: dict[str, Scene] = {}
    glove = c.c_int32()
    while (name := lib.door_scene(len(found), c.byref(glove))) is not None:
        outputs, crc = _read(len(found), 0)
        found[name.decode()] = Scene(name.decode(), outputs, _read(len(found), 1)[0], crc,
                                     bool(glove.value))
    return found


#: The scenes of the host program, by name.
SCENES = _scenes()
