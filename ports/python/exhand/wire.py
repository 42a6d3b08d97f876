# SPDX-License-Identifier: MIT
"""A world over UDP (docs/WIRE.md): it receives the fingers' places, and sends a plane near each.

No packet of a world is a force: planes are where contacts may be, and the box decides.
"""
from __future__ import annotations

import os
import socket
import struct
import time
import zlib
from dataclasses import dataclass
from importlib.metadata import version
from typing import Any, Iterator, Mapping, Optional

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ._lib import RX_B, fixed, lib, memory
from .signals import FINGERS, SCENES

HELLO, STATE, PLANES, PARAM, ACK = range(1, 6)
_HEAD = struct.Struct("<HBBHIII")
_STATE = np.dtype([("tick", "<u4"), ("fingers", "u1"), ("state", "u1"), ("frozen", "u1"),
                   ("touching", "u1"), ("age_ms", "<u2"), ("faults", "<u4"),
                   ("of", [("turn", "<i4", 3), ("tip", "<i4", 3), ("force", "<i4"), ("d", "<i4"),
                           ("q", "<i4"), ("q_lim", "<i4")], 5)])
_PLANES = np.dtype([("echo", "<u4", 2), ("fingers", "u1"),
                    ("of", [("kind", "u1"), ("material", "u1"), ("object", "<u2"),
                            ("normal", "<i4", 3), ("point", "<i4", 3), ("hit", "<i4", 3)], 5)])
_ACK = struct.Struct("<HHihI")
_QUIET_US, _HELLO_S, _ASK_S = 1000000, 0.5, 0.1


@dataclass(frozen=True)
class Plane:
    """A tangent plane in the palm's frame {R}, m: outward normal and any point of it, (3,)."""
    normal: ArrayLike
    point: ArrayLike
    object: int = 1  # another number is another object
    material: int = 0


@dataclass(frozen=True)
class State:
    """Where fingers and box are; arrays by finger, thumb first; NaN where there is none."""
    tick: int
    state: str  # off, arm, run, limit, release, fault
    faults: tuple[str, ...]
    fingers: tuple[int, ...]  # in use
    frozen: NDArray[np.bool_]  # (5,)
    touching: NDArray[np.bool_]  # (5,)
    age_s: float  # of the newest planes; infinite: never, or longer than a minute
    joints_rad: NDArray[np.float64]  # (5, 3): q0, q1, q2
    tip_m: NDArray[np.float64]  # (5, 3): P_F in {R}
    force_N: NDArray[np.float64]  # (5,): commanded
    d_m: NDArray[np.float64]  # (5,): distance to the plane, below 0 before it
    q_m: NDArray[np.float64]  # (5,): string pulled out
    q_lim_m: NDArray[np.float64]  # (5,): where contact begins


def _mask(bits: int) -> NDArray[np.bool_]:
    return np.array([bits >> k & 1 == 1 for k in range(len(FINGERS))])


def _unless(raw: NDArray[Any], none: int) -> NDArray[np.float64]:
    return np.where(raw == none, np.nan, raw * 2.0 ** -30)


def _state(payload: bytes) -> State:
    s = np.frombuffer(payload, _STATE)[0]
    of = s["of"]
    return State(
        int(s["tick"]), lib.exh_state_name(int(s["state"])).decode(),
        tuple(lib.exh_fault_name(k).decode() for k in range(32) if int(s["faults"]) >> k & 1),
        tuple(np.flatnonzero(_mask(int(s["fingers"]))).tolist()), _mask(int(s["frozen"])),
        _mask(int(s["touching"])), float("inf") if s["age_ms"] == 65535 else s["age_ms"] / 1000,
        of["turn"] * (2 * np.pi * 2.0 ** -32), of["tip"] * 2.0 ** -30, of["force"] * 2.0 ** -20,
        _unless(of["d"], -2 ** 31), of["q"] * 2.0 ** -30, _unless(of["q_lim"], 2 ** 31 - 1))


class World:
    """A world that listens at host:port (0: a free one, in `port`) for one box.

    `with World() as world: for state in world.states(): world.answer({1: Plane(n, p)})`.
    Attributes: port (int), `told` (dict: the box's answers to ask(), by name).
    """

    def __init__(self, port: int = 0, host: str = "127.0.0.1"):
        self._socket = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        self._socket.bind((host, port))
        self.port: int = self._socket.getsockname()[1]
        self._rx, self._to, self._echo = memory(RX_B), None, (0, 0)
        self._session, self._seq = int.from_bytes(os.urandom(4), "little") | 1, 0
        self._wanted: dict[tuple[int, int], tuple[str, int]] = {}
        self._said = self._asked = self._polled = 0.0
        self.told: dict[str, str] = {}

    def __enter__(self) -> "World":
        return self

    def __exit__(self, *_: Any) -> None:
        self.close()

    def close(self) -> None:
        """No packet goes or comes any more."""
        self._socket.close()

    def _send(self, kind: int, payload: bytes) -> None:
        if self._to is None:
            return
        packet = _HEAD.pack(0x5758, 3, kind, len(payload), self._session, self._seq,
                            int(time.monotonic() * 1e6) & 0xFFFFFFFF) + payload
        self._seq = self._seq + 1 & 0xFFFFFFFF
        self._socket.sendto(packet + struct.pack("<I", zlib.crc32(packet)), self._to)

    def _hello(self) -> None:
        major, minor, patch = (int(n) for n in version("exhand").split(".")[:3])
        self._send(HELLO, struct.pack("<BII20x", 1, major << 16 | minor << 8 | patch, 0))

    def _now_and_then(self) -> None:
        now = time.monotonic()
        passed = int((now - self._polled) * 1e6)
        lib.exh_wire_poll(self._rx, min(passed, 2 ** 32 - 1), _QUIET_US)
        self._polled = now
        if now - self._said >= _HELLO_S:
            self._said = now
            self._hello()
        if now - self._asked >= _ASK_S:
            self._asked = now
            for (i, k), (_, raw) in list(self._wanted.items()):
                self._send(PARAM, struct.pack("<HHi", i, k, raw))

    def _take(self, timeout_s: float) -> Optional[State]:
        self._socket.settimeout(max(timeout_s, 1e-3))
        try:
            packet, who = self._socket.recvfrom(512)
        except (socket.timeout, ConnectionError):
            return None
        kind = lib.door_wire(self._rx, packet, len(packet))
        if kind <= 0:
            return None
        self._to, payload = who, packet[_HEAD.size:-4]
        if kind == HELLO:
            self._hello()
        if kind == ACK:
            i, k, _, result, _ = _ACK.unpack(payload)
            name, _ = self._wanted.pop((i, k), ("", 0))
            self.told[name] = lib.exh_error_text(result).decode() if result else "taken"
        if kind == STATE:
            self._echo = _HEAD.unpack_from(packet)[5:7]
            return _state(payload)
        return None

    def states(self, seconds: float = float("inf")) -> Iterator[State]:
        """Each STATE as it comes, for so many seconds; says HELLO meanwhile."""
        end = time.monotonic() + seconds
        while (left := end - time.monotonic()) > 0:
            self._now_and_then()
            state = self._take(min(left, 0.05))
            if state is not None:
                yield state

    def answer(self, planes: Mapping[int, Optional[Plane]]) -> None:
        """Sends planes of fingers 0 to 4 (None: there is none), in answer to the last STATE.
        Raises ValueError for a normal of length 0 and a point farther than 2 m."""
        p = np.zeros((), _PLANES)
        p["echo"] = self._echo
        for finger, plane in planes.items():
            of = p["of"][finger]
            p["fingers"] |= 1 << finger
            of["kind"] = 1 if plane is None else 2
            if plane is None:
                continue
            n, hit = np.asarray(plane.normal, float), np.asarray(plane.point, float)
            if n.shape != (3,) or hit.shape != (3,) or not np.linalg.norm(n) > 0:
                raise ValueError("plane of finger %d: give normal and point of three numbers" %
                                 finger)
            n = n / np.linalg.norm(n)
            of["material"], of["object"] = plane.material, plane.object
            of["normal"], of["hit"] = fixed(n, 30, "normal"), fixed(hit, 30, "point")
            of["point"] = fixed(n * (n @ hit), 30, "point")
        self._send(PLANES, p.tobytes())

    def ask(self, name: str, value: float, instance: int = 0) -> None:
        """Requests mat_k (N/m), mat_b (Ns/m) or mat_f_max (N) of a material, again until the box
        answers. Then `told[name]` is "taken", or the reason of a refusal. The box accepts only
        what its rules allow (docs/WIRE.md)."""
        for s in SCENES["bilateral"].params:
            if s.name == name and s.instance == instance:
                self._wanted[s.id, instance] = name, int(fixed(value, s.frac, name))
                return
        raise ValueError("%s[%d]: no such parameter" % (name, instance))
