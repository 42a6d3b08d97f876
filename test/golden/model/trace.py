# SPDX-License-Identifier: MIT
"""The trace that a world asks a controller for: docs/WIRE.md, packets 6 and 7."""

from struct import Struct, pack, unpack

from .num import M32, RANGE, wrap

FRAMES, PACKET, WAIT = 16, 11, 100


class Trace:
    pack = Struct("<9I").pack

    def __init__(self):
        self.what, self.frame = (0, 0, 0, 0, 0), [(0, 0, 0, 0, 0, 0)] * FRAMES
        self.first = self.head = self.runs = self.left = 0
        self.request = self.next = self.waited = self.result = self.answer = 0

    def start(self, what):
        self.what, self.first, self.left = what, self.head, 0
        self.runs = self.runs + 1 & M32
        self.next, self.waited = self.head, 0

    def stop(self):
        """Another world has requested nothing."""
        self.start((0, 0, 0, 0, 0))
        self.result = self.answer = 0

    def ask(self, seq, body, signals):
        what = unpack("<I4H", body)
        if self.result < 0 or what != self.what:
            if max(what[1:]) < signals:
                self.start(what)
                self.result = 0
            else:
                self.stop()
                self.result = -RANGE
        self.request, self.answer = seq, 1

    def take(self, tick, signals):
        if self.what[0] == 0:
            return
        if self.left:
            self.left -= 1
            return
        self.left = self.what[0] - 1
        self.frame[self.head % FRAMES] = (self.head, tick,
                                          *(wrap(signals[i]) for i in self.what[1:]))
        self.head = self.head + 1 & M32

    def tick(self, tick, signals, room):
        """The payload of a TRACE, or None."""
        if self.what[0] == 0 and not self.answer:
            return None
        self.take(tick, signals)
        oldest = max(self.first, self.head - FRAMES)  # no run is so long that numbers begin anew
        self.next = max(self.next, oldest)
        n = self.head - self.next
        if n > 0 and self.waited < WAIT:
            self.waited += 1
        if not room or not self.answer and n < PACKET and self.waited < WAIT:
            return None
        n = min(n, PACKET)
        body = pack("<IIhB", self.request, self.next, self.result, n)
        for i in range(n):
            body += pack("<I4i", *self.frame[(self.next + i) % FRAMES][1:])
        self.next += n
        self.waited = self.answer = 0
        return body

    def state(self):
        return (self.pack(*self.what, self.first, self.head, self.runs, self.left) +
                b"".join(pack("<II4i", *f) for f in self.frame) +
                pack("<IIIhB", self.request, self.next, self.waited, self.result, self.answer))
