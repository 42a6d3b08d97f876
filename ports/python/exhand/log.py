# SPDX-License-Identifier: MIT
"""Logs and black boxes: records into arrays, with names and units of the scene's signal table."""
from __future__ import annotations

import os
import struct
import subprocess
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any, Iterator, Optional, Union

import ctypes as c
import numpy as np
from numpy.typing import NDArray

from ._lib import at, lib, real
from .signals import FINGERS, SCENES, Scene, Signal

if TYPE_CHECKING:
    import pandas

HEADER, FRAME, EVENT, KEYFRAME, DROPPED, END, PACKET = range(1, 8)
EVENTS = ("", "param", "command", "missed", "mark", "froze")
_HEAD = struct.Struct("<16s16sIIIIHHH")
_EVENT = np.dtype([("type", "<u2"), ("id", "<u2"), ("instance", "<u2"), ("value", "<i4"),
                   ("source", "<u2")])
_NONE = {0x8707: -2 ** 31, 0x8708: 2 ** 31 - 1}  # no plane, no contact (examples/bilateral)
_COLUMNS = 5  # door_records(): at, type, length, sequence, tick


@dataclass
class Damage:
    """What a file lacks. Nothing of it is an error: what is whole was read."""
    bytes: int = 0    # that are of no record
    missing: int = 0  # records, by their numbers
    lost: int = 0     # of these, reported by the writer
    left_out: int = 0  # frames of another length, or whose tick does not rise
    ended: bool = False  # it has its end


def _records(data: NDArray[np.uint8]) -> tuple[NDArray[np.uint64], int]:
    place, damaged, found = c.c_size_t(0), c.c_size_t(0), []
    while True:
        some = np.empty((65536, _COLUMNS), np.uint64)
        n = lib.door_records(at(data), data.size, c.byref(place), c.byref(damaged), at(some),
                             len(some))
        found.append(some[:n])
        if n < len(some):
            return np.concatenate(found), damaged.value


def _ticks(tick: NDArray[np.uint64]) -> NDArray[np.int64]:
    """Beyond 32 bits: each is less than half a wrap from the one before."""
    steps = np.diff(tick.astype(np.uint32)).view(np.int32)
    return int(tick[0]) + np.concatenate([[0], np.cumsum(steps, dtype=np.int64)])


class Log:
    """A log of `exhand drop --out`, `run --log`, or the dump of a black box.

    Attributes: scene, board (str), library (int), period_s (float), fingers (int).
    Arrays of n ticks: tick (int64), t_s (float64), raw (int32, (n, signals): the outputs).
    inputs (structured, (n,)): enc_raw, mon_raw, din, ..., dac_raw, enable.
    Others: params (dict, SI), events (list of dict), damage (Damage).

    Raises FileNotFoundError, and ValueError for what is no log of this library.
    """

    def __init__(self, path: Union[str, "os.PathLike[str]"]):
        self.path = Path(path)
        data = np.fromfile(self.path, np.uint8)
        records, damaged = _records(data)
        if not len(records) or records[0, 1] != HEADER:
            raise ValueError("%s: not a log: it does not start with a header of this record "
                             "version: give a file made by `exhand drop --out DIR`" % path)
        self.damage = Damage(damaged, ended=bool(records[-1, 1] == END))
        steps = np.diff(records[:, 3].astype(np.uint32)) - np.uint32(1)
        self.damage.missing = int(steps.sum(dtype=np.uint32))
        of = self._read_header(data[int(records[0, 0]):][:int(records[0, 2])].tobytes())
        records = records[records[:, 1] != HEADER]
        ticks = _ticks(records[:, 4]) if len(records) else np.empty(0, np.int64)
        self._read_frames(data, records, ticks, of)
        self._read_events(data, records, ticks)

    def _read_header(self, head: bytes) -> Scene:
        if len(head) < _HEAD.size:
            raise ValueError("%s: its header is too short" % self.path)
        scene, board, self.library, crc, num, den, self.fingers, self.enc_bits, signals = \
            _HEAD.unpack_from(head)
        self.scene, self.board = (b.split(b"\0")[0].decode("latin-1") for b in (scene, board))
        of = SCENES.get(self.scene)
        if of is None or not num or not den:
            raise ValueError("%s: made by the scene %s, which this package does not have" %
                             (self.path, self.scene))
        if (crc, signals) != (of.outputs_crc, len(of.outputs)):
            raise ValueError("%s: its signal table is another than this package's: read it with "
                             "the version that made it" % self.path)
        self.signals: tuple[Signal, ...] = of.outputs
        self._num, self._den, self.period_s = num, den, num / den
        raw = np.frombuffer(head, "<i4", len(of.params), _HEAD.size + 12) if of.params else ()
        self.params = {_name(s): float(v) * 2.0 ** -s.frac for s, v in zip(of.params, raw)}
        return of

    def _read_frames(self, data: NDArray[np.uint8], records: NDArray[np.uint64],
                     ticks: NDArray[np.int64], of: Scene) -> None:
        f = self.fingers
        glove = [("glove_new", "u1"), ("glove_age", "<u2"), ("glove_raw", "<i2", 22)]
        frame = np.dtype([("enc_raw", "<u4", f), ("mon_raw", "<i2", f), ("supply_raw", "<i2"),
                          ("din", "<u4"), *(glove if of.has_glove else []),
                          ("dac_raw", "<u2", f), ("enable", "u1"), ("alive", "u1"),
                          ("signal", "<i4", len(of.outputs))])
        which = records[:, 1] == FRAME
        places, tick = records[which], ticks[which]
        good = places[:, 2] == frame.itemsize
        highest = np.maximum.accumulate(np.where(good, tick, -1)) if len(tick) else tick
        good[1:] &= tick[1:] > highest[:-1]
        self.damage.left_out = int((~good).sum())
        where = places[good, 0].astype(np.int64)[:, None] + np.arange(frame.itemsize)
        self.inputs = data[where].reshape(-1).view(frame)
        self.tick = tick[good]
        self.t_s = self.tick.astype(np.float64) * self._num / self._den
        self.raw = self.inputs["signal"]

    def _read_events(self, data: NDArray[np.uint8], records: NDArray[np.uint64],
                     ticks: NDArray[np.int64]) -> None:
        self.events: list[dict[str, Any]] = []
        for (place, kind, length, _, _), tick in zip(records.tolist(), ticks.tolist()):
            if kind == DROPPED and length == 4:
                self.damage.lost += int(data[place:place + 4].view("<u4")[0])
            if kind != EVENT or length != _EVENT.itemsize:
                continue
            e = data[place:place + length].view(_EVENT)[0]
            known = int(e["type"]) if e["type"] < len(EVENTS) else 0
            self.events.append({"tick": tick, "type": EVENTS[known],
                                **{k: int(e[k]) for k in ("id", "instance", "value", "source")}})

    def _chosen(self, everything: bool) -> Iterator[tuple[str, int, Signal]]:
        """The columns of `exhand csv`: those of the paper, of the fingers in use; or all."""
        used = int(self.params.get("fingers", 0))
        wanted = -1 if everything or not used else used
        alone = wanted > 0 and wanted & (wanted - 1) == 0
        for i, s in enumerate(self.signals):
            if s.instances > 1 and not wanted >> s.instance & 1 or s.group and not everything:
                continue
            name = s.name + ("_" + s.unit if s.unit else "")
            if s.instances > 1 and not alone:
                name += "_" + (FINGERS[s.instance] if used else str(s.instance))
            yield name, i, s

    def arrays(self, all: bool = False) -> dict[str, NDArray[np.float64]]:
        """`t_s` and each signal in its unit, float64, shape (n,), exact; NaN where there is none.

        Names are those of `exhand csv`: f_des_n is f_des in newton. all: those of --all, too.
        """
        found = {"t_s": self.t_s}
        for name, i, s in self._chosen(all):
            v = self.raw[:, i]
            found[name] = real(v, s.frac)
            if s.id in _NONE:
                found[name][v == _NONE[s.id]] = np.nan
        return found

    def units(self, all: bool = False) -> dict[str, str]:
        """The unit of each column, in ASCII (n_per_m); "" for none."""
        return {"t_s": "s", **{name: s.unit for name, _, s in self._chosen(all)}}

    def frame(self, all: bool = False) -> "pandas.DataFrame":
        """The same as a pandas DataFrame; needs pandas."""
        import pandas
        return pandas.DataFrame(self.arrays(all))

    def replay(self, program: Optional[str] = None) -> str:
        """Runs the recorded inputs through the scene again by the program `exhand replay`, which
        compares every output bit. Its words; ValueError with them where a bit differs.

        program: its path; else the variable EXHAND, else `exhand`. FileNotFoundError without it.
        """
        run = subprocess.run([program or os.environ.get("EXHAND", "exhand"), "replay",
                              str(self.path)], capture_output=True, text=True, check=False)
        if run.returncode:
            raise ValueError((run.stdout + run.stderr).strip())
        return run.stdout.strip()


def _name(s: Signal) -> str:
    """As in the Modbus map: k[2] of several."""
    return "%s[%d]" % (s.name, s.instance) if s.instances > 1 else s.name
