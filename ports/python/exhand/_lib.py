# SPDX-License-Identifier: MIT
"""The C library, opened by ctypes, and what crosses into it."""
from __future__ import annotations

import ctypes as c
from fractions import Fraction
from pathlib import Path
from typing import Any, Union

import numpy as np
from numpy.typing import ArrayLike, NDArray

lib = c.CDLL(str(Path(__file__).with_name("_exhand.so")))
Rate = Union[int, float, Fraction]
(FILTER_CFG_B, FILTER_B, VELOCITY_B, COUNTER_B, LINES_B, LAW_B, RX_B, LIMITER_CFG_B,
 LIMITER_B) = (c.c_uint32 * 9).in_dll(lib, "door_B")

_p, _i, _u, _n = c.c_void_p, c.c_int32, c.c_uint32, c.c_size_t
for _name, _result, *_args in (
        ("door_filter_setup", c.c_int, _p, _i, _i, _u, _u),
        ("exh_filter_reset", None, _p, _p, c.c_uint),
        ("door_filter", None, _p, _p, _p, _p, _n, _u),
        ("door_velocity_setup", c.c_int, _p, _i, _i, _u, _u, _u, _u),
        ("door_velocity", None, _p, _p, _p, _n),
        ("door_counter_setup", c.c_int, _p, _i, _i, _u, _u, _u),
        ("door_counter", c.c_int, _p, _p, _p, _n),
        ("door_position", None, _i, _p, _p, _n),
        ("door_quadrature", _u, _p, _u, _p, _p, _n),
        ("door_contact", None, _p, _p, _p, _n),
        ("door_force", None, _p, _p, _p, _n),
        ("door_scene", c.c_char_p, _u, _p),
        ("door_table", _p, _u, _i),
        ("door_records", _n, _p, _n, _p, _p, _p, _n),
        ("door_wire", c.c_int, _p, c.c_char_p, _n),
        ("exh_wire_poll", c.c_int, _p, _u, _u),
        ("door_limiter", None, _p, _p, _p, _p, _n),
        ("exh_limiter_setup", c.c_int, _p, _p),
        ("exh_limiter_limit_name", c.c_char_p, c.c_uint),
        ("exh_limiter_cause_name", c.c_char_p, c.c_uint),
        ("exh_limiter_field_name", c.c_char_p, c.c_uint),
        ("exh_state_name", c.c_char_p, c.c_uint),
        ("exh_fault_name", c.c_char_p, c.c_uint),
        ("exh_signal_crc", _u, _p),
        ("exh_error_text", c.c_char_p, c.c_int)):
    _f = getattr(lib, _name)
    _f.restype, _f.argtypes = _result, _args


def memory(size_B: int) -> Any:
    """Zeros that C keeps its state in."""
    return c.create_string_buffer(size_B)


def at(array: NDArray[Any]) -> int:
    """Where the values of an array lie."""
    return array.ctypes.data


def checked(result: int, what: str) -> None:
    """Raises ValueError with the library's words for a negative result."""
    if result < 0:
        raise ValueError("%s: %s" % (what, lib.exh_error_text(result).decode()))


def fixed(x: ArrayLike, frac: int, what: str) -> NDArray[np.int32]:
    """x as int32 with `frac` fraction bits, each to the nearest, of two as near to the even one.

    Raises ValueError for NaN and for what is outside the format's range: nothing is cut off.
    """
    raw = np.rint(np.asarray(x, dtype=np.float64) * 2.0 ** frac)
    if not np.all((raw >= -2.0 ** 31) & (raw < 2.0 ** 31)):
        raise ValueError("%s: %s (allowed: %g to %g): no number, or too large for its format" %
                         (what, np.asarray(x), -2.0 ** (31 - frac), 2.0 ** (31 - frac)))
    return raw.astype(np.int32, order="C")


def real(raw: NDArray[Any], frac: int) -> NDArray[np.float64]:
    """Integers with `frac` fraction bits in their unit, exact."""
    return np.asarray(raw * 2.0 ** -frac, np.float64)


def period(rate_Hz: Rate) -> tuple[int, int]:
    """The period in seconds as a ratio of two integers, as the library wants it."""
    if not 1 <= rate_Hz <= 20000:
        raise ValueError("rate_Hz: %r (allowed: 1 to 20000)" % rate_Hz)
    rate = Fraction(rate_Hz).limit_denominator(10 ** 5)
    return rate.denominator, rate.numerator
