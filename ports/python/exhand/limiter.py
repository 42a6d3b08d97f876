# SPDX-License-Identifier: MIT
"""The limiter (exhand/limiter.h): one guard for anybody's motor, between commander and drive."""
from __future__ import annotations

import ctypes as c
import math
from dataclasses import dataclass
from typing import Any, Iterable, Optional, Union

import numpy as np
from numpy.typing import NDArray

from ._lib import LIMITER_B, LIMITER_CFG_B, at, lib, memory

NONE = -2 ** 31  # there is no number


class In(c.Structure):
    """struct exh_limiter_in."""
    _fields_ = [("now_us", c.c_uint32), ("command", c.c_int32), ("pos", c.c_int32),
                ("vel", c.c_int32), ("effort", c.c_int32), ("age_us", c.c_uint32),
                ("deadman", c.c_uint32), ("run", c.c_uint32)]


class Out(c.Structure):
    """struct exh_limiter_out."""
    _fields_ = [("send", c.c_int32), ("enable", c.c_uint32), ("state", c.c_uint32),
                ("limits", c.c_uint32), ("first", c.c_uint32), ("causes", c.c_uint32),
                ("present", c.c_uint32)]


#: The same as types of numpy arrays, for Limiter.run().
IN, OUT = np.dtype(In), np.dtype(Out)


def _all(name_of: Any) -> tuple[str, ...]:
    found: list[str] = []
    while (name := name_of(len(found)).decode()):
        found.append(name)
    return tuple(found)


FIELDS = _all(lib.exh_limiter_field_name)  # of struct exh_limiter_par, in its order
LIMITS = _all(lib.exh_limiter_limit_name)
CAUSES = _all(lib.exh_limiter_cause_name)
STATES = _all(lib.exh_state_name)
_WORDS = {"kind": ("effort", "position", "wall"), "first": ("refuse", "approach"),
          "after": ("limp", "hold"), "uses": ("pos", "vel", "effort", "deadman")}
_UNITS = (("_milli", "", 1e3), ("_ms", "_s", 1e3), ("_us", "_s", 1e6))


def micro(x: float) -> int:
    """Nearest millionth, half away from 0; NaN and infinity are NONE; limited at +-2147."""
    if not math.isfinite(x):
        return NONE
    return max(-2 ** 31 + 1, min(2 ** 31 - 1, int(x * 1e6 + math.copysign(0.5, x))))


def _argument(field: str) -> tuple[str, float]:
    """What a field is called here, and its scale: SI without milli and micro."""
    if field == "rate_milli":
        return "rate_Hz", 1e3
    for ending, ours, scale in _UNITS:
        if field.endswith(ending):
            return field[:-len(ending)] + ours, scale
    return field, 1.0 if field in _WORDS or field == "wall_below" else 1e6


#: Arguments of Limiter, and the scale of each to its field.
ARGUMENTS = dict(map(_argument, FIELDS))


def _raw(name: str, value: Any) -> int:
    words = _WORDS.get(name)
    if words is None:
        value = round(float(value) * ARGUMENTS[name])
    elif name == "uses":
        unknown = set(value) - set(words)
        if unknown:
            raise ValueError("uses: %s: give some of %s" % (sorted(unknown), ", ".join(words)))
        value = sum(1 << words.index(w) for w in set(value))
    elif value not in words:
        raise ValueError("%s: %s: give one of %s" % (name, value, ", ".join(words)))
    else:
        value = words.index(value)
    if not -2 ** 31 <= value < 2 ** 31:
        raise ValueError("%s: too large" % name)
    return int(value)


def _words(bits: int, names: tuple[str, ...]) -> tuple[str, ...]:
    return tuple(n for k, n in enumerate(names) if bits >> k & 1)


@dataclass(frozen=True)
class Step:
    """What a step gives."""
    send: float  # effort or position to send, SI
    enable: bool  # the drive may be on; else it must be off
    state: str  # off, arm, run, limit, release, fault
    limits: tuple[str, ...]  # that act in this step
    first: Optional[str]  # the cause that came first, until the next arming
    causes: tuple[str, ...]  # latched
    present: tuple[str, ...]  # seen in this step


class Limiter:
    """Limits, ramps, watches and latches a command. All values are SI.

    kind: "effort" (torque, force or current), "position", or "wall" (the command is its place).
    uses: the inputs of each step, of "pos", "vel", "effort", "deadman"; others are not read.
    Further arguments are the fields of struct exh_limiter_par in SI, without _milli. Times end in
    _s: ramp_s, age_max_s. Other examples: rate_Hz, pos_max, effort_up (a second).
    exhand.limiter.ARGUMENTS lists all. lib/include/exhand/limiter.h has ranges and says where 0
    means "not watched". An argument that is not given is 0.

    Raises TypeError for an unknown argument, ValueError with the first that is out of its range.
    This is software: it is no safety function, and it does not replace an emergency stop.
    """

    def __init__(self, kind: str, uses: Iterable[str] = (), **par: Union[float, str]):
        given: dict[str, Any] = {"kind": kind, "uses": tuple(uses), **par}
        unknown = set(given) - set(ARGUMENTS)
        if unknown:
            raise TypeError("Limiter: %s: no such argument: give some of %s" %
                            (", ".join(sorted(unknown)), ", ".join(ARGUMENTS)))
        raw = np.array([_raw(n, given[n]) if n in given else 0 for n in ARGUMENTS], np.int32)
        self._cfg, self._state = memory(LIMITER_CFG_B), memory(LIMITER_B)
        bad = lib.exh_limiter_setup(self._cfg, at(raw))
        if bad < 0:
            name = list(ARGUMENTS)[-bad - 1]
            raise ValueError("%s: %s: out of its range, or it does not go with the others "
                             "(exhand/limiter.h)" % (name, given.get(name, 0)))
        self._out = Out()

    def step(self, now_s: float, command: float, pos: float = math.nan, vel: float = math.nan,
             effort: float = math.nan, age_s: float = 0.0, deadman: bool = False,
             run: bool = True) -> Step:
        """One step. now_s: a clock that only rises, any origin. command: by kind; NaN and infinity
        are the cause not_a_number. pos, vel, effort: measured. age_s: of the command, infinite if
        there never was one. run: is to run; else it is to be off."""
        age = age_s * 1e6
        i = In(round(now_s * 1e6) & 0xFFFFFFFF, micro(command), micro(pos), micro(vel),
               micro(effort), round(age) if 0 <= age < 2 ** 32 - 1 else 2 ** 32 - 1, deadman, run)
        o = self._out
        lib.door_limiter(self._state, self._cfg, c.byref(i), c.byref(o), 1)
        return Step(o.send * 1e-6, bool(o.enable), STATES[o.state], _words(o.limits, LIMITS),
                    next(iter(_words(o.first, CAUSES)), None), _words(o.causes, CAUSES),
                    _words(o.present, CAUSES))

    def run(self, steps: NDArray[Any]) -> NDArray[Any]:
        """Many steps: an array of IN, shape (n,), in the library's units (millionths); an array of
        OUT, shape (n,)."""
        i = np.ascontiguousarray(steps, dtype=IN)
        out = np.empty(len(i), OUT)
        lib.door_limiter(self._state, self._cfg, at(i), at(out), len(i))
        return out
