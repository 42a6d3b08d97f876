# SPDX-License-Identifier: MIT
"""Forged images at the start, and forged pieces of a log."""

import csv
import glob
import os
import re
import signal
import socket
import struct
import subprocess
import time
import zlib

import rig
import wire

DATA_B = 1000
N_Q20, A_Q26 = 1 << 20, 1 << 26


def run(words):
    done = subprocess.run(words, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, check=False)
    return done.returncode, done.stdout.decode(errors="replace")


def rows_of(options, log):
    return list(csv.DictReader(run([options.exhand, "csv", log, "--all"])[1].splitlines()))


def sealed(body):
    return body + struct.pack("<I", zlib.crc32(body))


def spoilt(whole):
    return whole[:55] + bytes([whole[55] ^ 4]) + whole[56:]


def write(path, data):
    with open(path, "wb") as f:
        f.write(data)
    return path


def read(path):
    with open(path, "rb") as f:
        return f.read()


def image_forged(report, options, folder):
    """Every 40 N of an image becomes 100 N, the person's ceiling among them."""
    path = os.path.join(folder, "p.bin")
    words = [options.exhand, "drop", "--rate", "500", "--falls", "1", "--runs", "1"]
    status, said = run(words + ["--save-params", path])
    if status != 0:
        raise RuntimeError("no image: " + said)
    whole = read(path)
    at = [n for n in range(12, len(whole) - 4) if whole[n:n + 4] == struct.pack("<i", 40 * N_Q20)]
    body = whole[:-4].replace(struct.pack("<i", 40 * N_Q20), struct.pack("<i", 100 * N_Q20))
    kinds = (("image-crc", "a parameter image, its sum not made right", body + whole[-4:], False),
             ("image", "40 N of an image become 100 N, its sum right", sealed(body), True))
    for name, what, data, may_start in kinds:
        log = os.path.join(folder, name + ".exh")
        status, said = run([options.exhand, "run", "--seconds", "3", "--rate", "500", "--log", log,
                            "--load-params", write(path, data), "--set", "k=20000"] +
                           rig.ceiling())
        wrong = ["status %d: %s: not judged" % (status, said)] if may_start and status else []
        if status == 0:
            rows = rows_of(options, log)
            wrong += rig.above(rows) + rig.untried(rows)
            wrong += [] if may_start else ["it was taken"]
        if len(at) < 2:
            wrong.append("no ceiling in the image: not judged")
        report.row(name, what, len(at), "status %d" % status, wrong)


def calibration(folder, exhand):
    status, said = run([exhand, "calibrate", "--rate", "100", "--mass", "0.3,0.6", "--out", folder])
    if status != 0:
        raise RuntimeError("no calibration: " + said)
    return read(os.path.join(folder, "calibration.bin"))


def heavier(whole, times):
    """The same forces from so many times the current. A point is force, current, and two more."""
    body = bytearray(whole[:-4])
    for at in range(len(body) - 32, len(body), 16):
        current, = struct.unpack_from("<i", body, at + 4)
        struct.pack_into("<i", body, at + 4, int(min(current * times, 31.0 * A_Q26)))
    return sealed(bytes(body))


def calibration_forged(report, options, folder):
    whole = calibration(folder, options.exhand)
    for name, what, data, may_start in (
            ("calib-crc", "a damaged calibration", spoilt(whole), False),
            ("calib-tenth", "1 N is ten times the current", heavier(whole, 10), False),
            ("calib-1.9", "1 N is 1.9 times the current", heavier(whole, 1.9), True)):
        out = os.path.join(folder, name)
        status, _ = run([options.exhand, "drop", "--rate", "500", "--falls", "1", "--runs", "1",
                         "--out", out, "--calibration",
                         write(os.path.join(folder, name + ".bin"), data)] +
                        rig.ceiling())
        wrong, logs = [], glob.glob(os.path.join(out, "*.exh"))
        for log in logs:
            rows = rows_of(options, log)
            wrong += rig.above(rows) + rig.untried(rows, ["person_i"])
        if logs and not may_start:
            wrong.append("it was taken")
        if may_start and (status not in (0, 1) or not logs):  # 1: it fell as nothing measured
            wrong.append("status %d, %d logs: not judged" % (status, len(logs)))
        report.row(name, what, 1, "status %d" % status, wrong)


def attack(report, options, folder):
    image_forged(report, options, folder)
    calibration_forged(report, options, folder)


# --- pieces of a log -------------------------------------------------------------

def piece(session, number, place, last, data, key=None):
    body = (b"EXL3" if key else b"EXL2") + struct.pack(
        "<IIII", session, number, place & 0xFFFFFFFF, last) + data
    body = sealed(body)
    return body + (struct.pack("<Q", wire.mac(key, body)) if key else b"")


def lies(session, number, place, key):
    """What once ended or falsified a recording."""
    junk = b"Z" * 400
    return [piece(session, 0, 0xFFFFFFFF, 0, junk, key),
            piece(session, number, 0x90000000, 0, junk, key),
            piece(session, number, place, 1, junk, key),
            piece(session, number + 5000, 0, 0, junk, key),
            piece(session, number + 1, place + (1 << 31), 0, junk, key),
            piece(session + 1, number, place, 0, junk, key),
            piece(session, number, place, 0, junk, key)[:-3],
            piece(session, number, place, 0, bytes(2000), key)]


def liar(box, other, key):
    """With a key he has the box's own address and not its key; without, another port."""
    return (box, os.urandom(16)) if key else (other, None)


def recorded(options, folder, name, log, key):
    """A log sent to `exhand listen`, with false packets: (false packets sent, status, output,
    file)."""
    at, out = ("127.0.0.1", rig.free_port()), os.path.join(folder, name + ".out")
    words = [options.exhand, "listen", "--at", "%s:%d" % at, "--out", out, "--silence", "3",
             "--wait", "20"] + (["--key", rig.key_file(folder, key, "listen")] if key else [])
    program = subprocess.Popen(words, stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
    box, other = (socket.socket(socket.AF_INET, socket.SOCK_DGRAM) for _ in range(2))
    time.sleep(0.5)
    told, n = 0, -(-len(log) // DATA_B)
    who, false = liar(box, other, key)
    for k in range(n):
        for lie in lies(7, k, k * DATA_B, false) if k % 5 == 0 else []:
            who.sendto(lie, at)
            told += 1
        box.sendto(piece(7, k, k * DATA_B, int(k == n - 1), log[k * DATA_B:(k + 1) * DATA_B], key),
                   at)
        time.sleep(0.002)
    try:
        said = program.communicate(timeout=30)[0].decode(errors="replace")
    except subprocess.TimeoutExpired:
        program.send_signal(signal.SIGKILL)
        said = program.communicate()[0].decode(errors="replace")
    sane = os.path.exists(out) and os.path.getsize(out) <= 2 * len(log)
    return told, program.returncode, said, read(out) if sane else b""


def on_listen(report, options, folder):
    path = os.path.join(folder, "sent.exh")
    status, said = run([options.exhand, "run", "--seconds", "2", "--rate", "500", "--log", path])
    if status != 0:
        raise RuntimeError("no log: " + said)
    log = read(path)
    for name, what, key, pattern in (
            ("listen", "pieces of another, from another port", None,
             r"(\d+) datagrams (?:from \S+ were not|were too long)"),
            ("listen-key", "the box's address, another key", os.urandom(16),
             r"(\d+) (?:pieces have another key|datagrams were too long)")):
        told, status, said, got = recorded(options, folder, name, log, key)
        counted = sum(int(n) for n in re.findall(pattern, said))
        wrong = [] if got == log else ["%d bytes of %d, or not the log's" % (len(got), len(log))]
        wrong += [] if status == 0 else ["status %d: %s" % (status, said)]
        wrong += [] if counted >= 0.8 * told else ["%d of %d counted" % (counted, told)]
        report.row(name, what, told, "%d refused" % counted, wrong)
