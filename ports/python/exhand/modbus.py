# SPDX-License-Identifier: MIT
"""The box's Modbus map by names (docs/MODBUS.md), over TCP: `Box("host")["f_des"]`."""
from __future__ import annotations

import socket
import struct
from types import TracebackType
from typing import Any, Optional, Union

import ctypes as c

from ._lib import lib
from .signals import SCENES, Scene, Signal

INPUT, HOLDING = 4, 3
_SIGNAL_AT, _PARAM_AT, _HEADS, _COILS = 0x3000, 0x7000, 31, 6  # binary32; rows of the map


class _Row(c.Structure):
    """struct exh_regs_row."""
    _fields_ = [("name", c.c_char_p), ("format", c.c_char_p), ("help", c.c_char_p)]


def _rows(name: str, n: int) -> list[tuple[str, str]]:
    return [(r.name.decode(), r.format.decode()) for r in (_Row * n).in_dll(lib, name)]


HEAD = dict((name, (2 * i, kind)) for i, (name, kind) in
            enumerate(_rows("exh_regs_head_row", _HEADS)))
COILS = [name for name, _ in _rows("exh_regs_coil_row", _COILS)]
_EXCEPTIONS = {1: "no such function", 2: "no such register",
               3: "refused: value, or not allowed now", 4: "the box failed", 6: "busy: ask again"}


class ModbusError(OSError):
    """The box answered with an exception; `code` is its number."""

    def __init__(self, code: int):
        super().__init__("exception %d: %s" % (code, _EXCEPTIONS.get(code, "unknown")))
        self.code = code


class Box:
    """A box that serves Modbus TCP (`exhand run --modbus tcp:ADDRESS:PORT`).

    box["f_des"] reads an output in its unit, box["k"] a parameter in effect, box["state"] a value
    of the head; of several "q[2]". box["k"] = 800 stages a parameter, apply() takes what is staged.
    Raises KeyError for an unknown name, ModbusError for what the box refuses, OSError for the rest.
    Modbus has no password: see docs/MODBUS.md before you let clients write.
    """

    def __init__(self, host: str, port: int = 1502, timeout_s: float = 3.0):
        self._socket = socket.create_connection((host, port), timeout_s)
        self._number = 0
        if self._value(INPUT, 0, "u32") != 0x45584831:
            raise ValueError("%s:%d: no box of exhand: its magic number is another" % (host, port))
        text = b"".join(self.read(INPUT, HEAD["name_%d" % k][0], 2) for k in range(4))
        self.scene: Scene = SCENES[text.rstrip(b"\0").decode()]
        if self["signals_crc"] != self.scene.outputs_crc:
            raise ValueError("%s: its signal table is another than this package's" %
                             self.scene.name)
        self._at: dict[str, tuple[int, Signal, bool]] = {}
        for first, signals, is_param in ((_SIGNAL_AT, self.scene.outputs, False),
                                         (_PARAM_AT, self.scene.params, True)):
            for i, s in enumerate(signals):
                name = "%s[%d]" % (s.name, s.instance) if s.instances > 1 else s.name
                self._at.setdefault(name, (first + 2 * i, s, is_param))

    def __enter__(self) -> "Box":
        return self

    def __exit__(self, kind: Optional[type[BaseException]], error: Optional[BaseException],
                 trace: Optional[TracebackType]) -> None:
        self._socket.close()

    def _receive(self, n: int) -> bytes:
        got = b""
        while len(got) < n:
            more = self._socket.recv(n - len(got))
            if not more:
                raise ConnectionError("the box closed the connection")
            got += more
        return got

    def request(self, pdu: bytes) -> bytes:
        """Sends a request (function and data) and returns the answer's data."""
        self._number = self._number + 1 & 0xFFFF
        self._socket.sendall(struct.pack(">HHHB", self._number, 0, len(pdu) + 1, 1) + pdu)
        number, protocol, length, _ = struct.unpack(">HHHB", self._receive(7))
        answer = self._receive(length - 1)
        if number != self._number or protocol or answer[0] & 0x7F != pdu[0]:
            raise ConnectionError("the answer is of another request")
        if answer[0] & 0x80:
            raise ModbusError(answer[1])
        return answer[1:]

    def read(self, table: int, at: int, count: int) -> bytes:
        """Registers as bytes, high word first. table: INPUT or HOLDING; at most 125."""
        return self.request(struct.pack(">BHH", table, at, count))[1:]

    def _value(self, table: int, at: int, kind: str) -> Union[int, float, bytes]:
        word = self.read(table, at, 2)
        form = {"u32": ">I", "i32": ">i", "f32": ">f"}.get(kind)
        return struct.unpack(form, word)[0] if form else word

    def __getitem__(self, name: str) -> Any:
        if name in HEAD:
            return self._value(INPUT, *HEAD[name])
        return self._value(INPUT, self._at[name][0], "f32")

    def unit(self, name: str) -> str:
        """In ASCII (n_per_m); "" for none."""
        return "" if name in HEAD else self._at[name][1].unit

    def names(self) -> list[str]:
        """All that can be read."""
        return [*HEAD, *self._at]

    def __setitem__(self, name: str, value: float) -> None:
        at, _, is_param = self._at[name]
        if not is_param:
            raise KeyError("%s: an output cannot be set" % name)
        self.request(struct.pack(">BHHBf", 16, at, 2, 4, value))

    def command(self, name: str) -> None:
        """APPLY, DISCARD, SAVE, OFF, RUN or CLEAR, where the box allows it."""
        self.request(struct.pack(">BHH", 5, COILS.index(name), 0xFF00))

    def apply(self) -> None:
        """Applies all staged values between two ticks. `box["result"]` has the result."""
        self.command("APPLY")
