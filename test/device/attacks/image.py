# SPDX-License-Identifier: MIT
"""The pc104 image under QEMU, its network card at a user network of QEMU's own, COM2 at a socket.

Cards inside the image with a link have at their connectors what a log of the host recorded
(tape.c): a finger that approaches a wall. Its log comes over UDP.
"""

import os
import re
import socket
import struct
import subprocess
import time

import link
import ports
import rig

MODBUS = "modbus=com2,1,57600"
SECONDS = 20  # of the box's time
NAMES = {"no_key": "without a key", "other_key": "of another key", "unproved": "not proved",
         "again": "again", "damaged": "damaged", "drop_port": "packets of other senders",
         "drop_too_long": "of the world's too long"}


def tape(options, log):
    """The finger's approaches, as the host alone has them."""
    out = log + ".tape"
    subprocess.run([options.exhand, "bilateral", "--rate", str(rig.RATE_HZ), "--speed", "natural",
                    "--seeds", "1", "--approaches", "8", "--set", "track_tol=0.9", "--out",
                    out] + rig.ceiling(),
                   stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, check=False)
    return os.path.join(out, "bilateral_natural.exh")


class Image(rig.Box):
    """An image under QEMU; its log by another way than the host's."""

    flood, of, ends_with = 2000, [], (0,)  # QEMU's network keeps what it cannot pass on immediately

    def __init__(self, options, log, name, words, flags, **environment):
        self.exhand, self.log = options.exhand, log
        self.said = log + ".said"
        environment = {"QEMU_FLAGS": "-icount shift=3,sleep=on " + flags, "TIMEOUT_s": "300",
                       **environment}
        with open(self.said, "wb") as said:
            self.process = subprocess.Popen(
                ["ports/pc104/run.sh", os.path.join(options.images, name + ".elf"),
                 "rate=%d" % rig.RATE_HZ, "idle=spin"] + words, stdout=said, stderr=said,
                env={**os.environ, **environment})

    def named(self):
        return {NAMES[name]: int(n) for name, n in re.findall(r"^link (\w+) (\d+)", self.text(),
                                                              re.MULTILINE) if name in NAMES}

    def end(self):
        return self.process.wait(300)


class Linked(Image):
    """This world is its peer."""

    of = ["--finger", "index"]

    def __init__(self, options, folder, world, _):
        port, key = rig.free_port(), world.key
        log = os.path.join(folder, "image-key.exh" if key else "image.exh")
        self.listener = subprocess.Popen(
            [options.exhand, "listen", "--at", "127.0.0.1:%d" % port, "--out",
             log, "--silence", "5"] +
            (["--key", rig.key_file(folder, key)] if key else []),
            stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        super().__init__(
            options, log, "bilateral-tape",
            ["ip=10.0.2.15", "peer=10.0.2.2", "port=" + world.at.split(":")[1], "log=udp",
             "log_port=%d" % port, "budget=1", "scan=1", "ticks=%d" % (SECONDS * rig.RATE_HZ)] +
            (["key=" + key.hex()] if key else []),
            "-m 256 -initrd %s -device e1000e,netdev=n -netdev user,id=n" % tape(options, log))

    def end(self):
        status = super().end()
        self.listener.wait(30)
        return status


class Line:
    """A master on COM2, without a library. No request exceeds what QEMU's UART takes in one
    write."""

    def __init__(self, port):
        rig.until(lambda: self.opened(port), 30, "no COM2")
        self.sock.settimeout(3)

    def opened(self, port):
        self.sock = socket.socket()
        return self.sock.connect_ex(("127.0.0.1", port)) == 0

    def hear(self, n):
        """n bytes, or those that came in time."""
        data = b""
        try:
            for _ in range(n):
                data += self.sock.recv(1)
        except TimeoutError:
            pass
        return data

    def said(self, pdu):
        """0, or the exception. Asks again while there is no answer."""
        frame = b"\1" + pdu
        for _ in range(5):
            self.sock.sendall(frame + crc16(frame))
            head = self.hear(5)
            if len(head) == 5:
                return head[2] if head[1] & 0x80 else len(self.hear(3)) - 3
        return -1


def crc16(data):
    value = 0xFFFF
    for byte in data:
        value ^= byte
        for _ in range(8):
            value = value >> 1 ^ (0xA001 if value & 1 else 0)
    return struct.pack("<H", value)


def on_com2(report, options, folder):
    """An image whose master may only read: writes, coils, and noise on the line."""
    at, port = ports.addresses(options.exhand), rig.free_port(socket.SOCK_STREAM)
    log = os.path.join(folder, "com2.exh")
    box = Image(options, log, "drop-none",
                ["uncalibrated=1", "q_lim=-0.0004", "k=2000", "track_tol=0.9", "s526_a=576",
                 "log=debug", "ticks=%d" % (8 * rig.RATE_HZ), MODBUS],
                "-serial tcp:127.0.0.1:%d,server=on,wait=on" % port,
                RECORDS=log)
    rows, line = [], Line(port)
    asked = [struct.pack(">BHHBf", ports.WRITE, at[name], 2, 4, value)
             for name, value in ports.HARDER for _ in range(5)]
    coils = [struct.pack(">BHH", ports.COIL, n, 0xFF00) for n in (ports.RUN, ports.CLEAR,
                                                                  ports.APPLY, ports.SAVE)]
    for name, what, pdus in (("com2-write", "f_max up, k up, q_lim, no ,write", asked),
                             ("com2-coils", "RUN, CLEAR, APPLY, SAVE, no ,remote", coils)):
        refused = sum(line.said(pdu) > 0 for pdu in pdus)
        rows.append((name, what, len(pdus), "%d refused" % refused,
                     ports.refusals(len(pdus), refused)))
    for _ in range(100):
        line.sock.sendall(os.urandom(10))
        time.sleep(0.01)
    time.sleep(0.1)
    sound = line.said(struct.pack(">BHH", ports.INPUT, ports.TEST_INT, 2)) == 0
    rows.append(("com2-noise", "random bytes", 1000, "", [] if sound else ["it answers no more"]))
    ports.finish(report, box, rows, "")


OPEN = tuple(row for row in link.OPEN if row[0] in (
    "param-port", "replay", "hello-storm", "misshapen", "flood-peer", "param-peer"))
KEYED = tuple(row for row in link.KEYED if row[0] in ("key-none", "key-forged", "key-replay",
                                                      "key-misshapen"))
