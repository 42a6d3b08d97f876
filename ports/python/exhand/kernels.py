# SPDX-License-Identifier: MIT
"""The library's kernels on arrays: the same integers as in a firmware, bit for bit.

Inputs are rounded to the nearest value of the library's format. Outputs are exact in float64. An
object keeps its state: samples may come in one array or in pieces.
"""
from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ._lib import (COUNTER_B, FILTER_B, FILTER_CFG_B, LAW_B, LINES_B, VELOCITY_B, Rate, at, checked,
                   fixed, lib, memory, period, real)

Q_POS, Q_VEL, Q_FORCE, Q_K, Q_B, Q_STEP = 30, 27, 20, 10, 20, 42


def _counts(x: ArrayLike, what: str) -> NDArray[np.int32]:
    """Counts of any integer type, modulo 2^32."""
    a = np.asarray(x)
    if a.ndim != 1 or a.dtype.kind not in "iu":
        raise ValueError("%s: give integers of shape (n,), not %s of shape %s" %
                         (what, a.dtype, a.shape))
    return np.ascontiguousarray((a.astype(np.int64) & 0xFFFFFFFF).astype(np.uint32).view(np.int32))


class LowPass:
    """Butterworth low-pass of order 1 or 2, gain 1 at 0 Hz, exact for a constant.

    cutoff_Hz: 0.01 to 10000, below half the rate. rate_Hz: 1 to 20000. lsb: the value of one count
    of the 32-bit input; not used for integers. Raises ValueError for values outside.
    """

    def __init__(self, cutoff_Hz: float, rate_Hz: Rate, order: int = 2, lsb: float = 2.0 ** -24):
        self._cfg, self._state, self._lsb = memory(FILTER_CFG_B), None, lsb
        self._n = 0
        checked(lib.door_filter_setup(self._cfg, order, int(fixed(cutoff_Hz, 16, "cutoff_Hz")),
                                      *period(rate_Hz)), "low-pass")

    def __call__(self, x: ArrayLike) -> NDArray[Any]:
        """x: shape (n,) or (n, channels), float or integer; the same shape comes back, int32 for
        integers. It is settled at the first sample. Raises ValueError beyond 32 bits."""
        a = np.asarray(x)
        whole = a.dtype.kind in "iu"
        if a.ndim not in (1, 2) or not a.size:
            raise ValueError("x: give shape (n,) or (n, channels), not %s" % (a.shape,))
        raw = fixed(a if whole else a / self._lsb, 0, "x")
        channels = raw.shape[1] if raw.ndim == 2 else 1
        if self._state is None:
            self._state, self._n = memory(FILTER_B * channels), channels
            lib.exh_filter_reset(self._state, at(raw), channels)
        if channels != self._n:
            raise ValueError("x: %d channels, and there were %d before" % (channels, self._n))
        lib.door_filter(self._cfg, self._state, at(raw), at(raw), len(raw), channels)
        return raw if whole else raw * self._lsb


class Quadrature:
    """Software decoder of the lines A and B; 00 01 11 10 counts up. mode: 1, 2 or 4."""

    def __init__(self, mode: int = 4):
        if mode not in (1, 2, 4):
            raise ValueError("mode: %s: give 1, 2 or 4" % mode)
        self._state, self._mode = memory(LINES_B), mode
        self.illegal = 0  # steps in which both lines changed: direction lost

    def __call__(self, a: ArrayLike, b: ArrayLike) -> NDArray[np.int32]:
        """a, b: levels, shape (n,), 0 or not. Counts since the first sample, shape (n,)."""
        ab = np.asarray(a, bool).astype(np.uint8) << 1 | np.asarray(b, bool)
        ab = np.ascontiguousarray(ab)
        cnt = np.empty(ab.shape, np.int32)
        self.illegal = lib.door_quadrature(self._state, self._mode, at(ab), at(cnt), ab.size)
        return cnt


class Counter:
    """A hardware counter of 16 to 32 bits, extended to 32 across its wrap, and its position.

    step_m: m per count, 1e-6 to 488e-6. speed_max_mps: faster is a fault, 0.1 to 15.9.
    """

    def __init__(self, step_m: float, rate_Hz: Rate, bits: int = 32, speed_max_mps: float = 10):
        self._c, self._step = memory(COUNTER_B), int(fixed(step_m, Q_STEP, "step_m"))
        self.lost = False  # a sample moved faster than speed_max_mps: it is left out
        checked(lib.door_counter_setup(
            self._c, self._step, int(fixed(speed_max_mps, Q_VEL, "speed_max_mps")),
            *period(rate_Hz), bits), "counter")

    def __call__(self, raw: ArrayLike) -> NDArray[np.int32]:
        """raw: the counter, integers, shape (n,), one a tick. Counts since the first, (n,)."""
        a = _counts(raw, "raw")
        cnt = np.empty_like(a)
        self.lost = bool(lib.door_counter(self._c, at(a), at(cnt), a.size))
        return cnt

    def position_m(self, cnt: ArrayLike) -> NDArray[np.float64]:
        """Position of counts, m, shape (n,): within 0.47 nm, saturated at 2 m."""
        a = _counts(cnt, "cnt")
        pos = np.empty_like(a)
        lib.door_position(self._step, at(a), at(pos), a.size)
        return real(pos, Q_POS)


class Velocity:
    """Velocity of a counted position by one of four estimators; the first sample gives 0.

    - window: difference over `par` ticks: 1, 2, 4, 8 or 16.
    - pole: difference through one pole with time constant `par`, 0 to 1 s.
    - foaw: adaptive window of at most `par` ticks, 1 to 16. tol_cnt: 1 to 255 counts.
    - track: critically damped observer with time constant `par`, 0 to 1 s.

    step_m: m per count. rate_Hz: 1 to 20000. Raises ValueError for what is outside.
    """

    def __init__(self, method: str, step_m: float, rate_Hz: Rate, par: float, tol_cnt: int = 1):
        methods = ("window", "pole", "foaw", "track")
        if method not in methods:
            raise ValueError("method: %s: give one of %s" % (method, ", ".join(methods)))
        windows = (1, 2, 4, 8, 16)
        if method == "window" and par not in windows:
            raise ValueError("par: a window of %s ticks: give 1, 2, 4, 8 or 16" % par)
        a = (windows.index(int(par)) if method == "window" else
             par if method == "foaw" else par * 1e6)
        if not 0 <= a <= 1e6:
            raise ValueError("par: %s (allowed: 0 to 1 s, or 1 to 16 ticks)" % par)
        self._v = memory(VELOCITY_B)
        checked(lib.door_velocity_setup(self._v, methods.index(method),
                                        int(fixed(step_m, Q_STEP, "step_m")), *period(rate_Hz),
                                        round(a), tol_cnt), "velocity")

    def __call__(self, cnt: ArrayLike) -> NDArray[np.float64]:
        """cnt: counts, integers, shape (n,), one a tick. Velocity, m/s, (n,), at most 16."""
        a = _counts(cnt, "cnt")
        vel = np.empty_like(a)
        lib.door_velocity(self._v, at(a), at(vel), a.size)
        return real(vel, Q_VEL)


class Contact:
    """Contact law of one finger: F = b v + k (q - wall) + F0 in contact, F0 outside.

    k_Npm: 0 to 1e6 N/m. b_Nspm: 0 to 1000 Ns/m. f0_N: 0 to 20 N. f0_band_m, hyst_m: 0 to 0.01 m.
    """

    def __init__(self, k_Npm: float, b_Nspm: float, f0_N: float = 0, f0_band_m: float = 0,
                 hyst_m: float = 0):
        rows = (("k_Npm", k_Npm, 1e6, Q_K), ("b_Nspm", b_Nspm, 1e3, Q_B),
                ("f0_N", f0_N, 20, Q_FORCE), ("f0_band_m", f0_band_m, 0.01, Q_POS),
                ("hyst_m", hyst_m, 0.01, Q_POS))
        for name, value, most, _ in rows:
            if not 0 <= value <= most:
                raise ValueError("%s: %s (allowed: 0 to %g)" % (name, value, most))
        self._law = memory(LAW_B)
        par = np.array([int(fixed(v, frac, name)) for name, v, _, frac in rows], np.int32)
        self._law[:par.nbytes] = par.tobytes()

    @staticmethod
    def _inputs(pos_m: ArrayLike, vel_mps: ArrayLike, wall_m: ArrayLike) -> NDArray[np.int32]:
        return np.ascontiguousarray(np.stack(np.broadcast_arrays(
            fixed(np.atleast_1d(pos_m), Q_POS, "pos_m"), fixed(vel_mps, Q_VEL, "vel_mps"),
            fixed(wall_m, Q_POS, "wall_m")), axis=-1))

    def __call__(self, pos_m: ArrayLike, vel_mps: ArrayLike,
                 wall_m: ArrayLike) -> dict[str, NDArray[Any]]:
        """One tick for each element, shape (n,); a scalar is used for all. Returns arrays (n,):
        `spring`, `damper`, `pullback` in N, whose sum is the force before limits, and `touching`.
        """
        i = self._inputs(pos_m, vel_mps, wall_m)
        out = np.empty((len(i), 4), np.int64)
        lib.door_contact(self._law, at(i), at(out), len(i))
        newton = real(out[:, :3], Q_FORCE)
        return dict(spring=newton[:, 0], damper=newton[:, 1], pullback=newton[:, 2],
                    touching=out[:, 3].astype(bool))

    def force_N(self, pos_m: ArrayLike, vel_mps: ArrayLike,
                wall_m: ArrayLike) -> NDArray[np.float64]:
        """The law without memory (no hysteresis, no band), N, (n,), limited to 0 to 100."""
        i = self._inputs(pos_m, vel_mps, wall_m)
        out = np.empty(len(i), np.int32)
        lib.door_force(self._law, at(i), at(out), len(i))
        return real(out, Q_FORCE)
