# SPDX-License-Identifier: MIT
"""Two strangers at the registers of a running box: pymodbus, and mbpoll beside it.

strangers.py WHERE MAP SAVED READ: WHERE is a port of 127.0.0.1 or the device of a serial line. MAP
is the output of `exhand regs --csv`, SAVED the --save file of the box. The box is OFF, so both
clients must read the same. Outputs and limits of a tick are excepted: they move with the simulated
finger. Their readings go to READ, with the ticks around. logged.py looks for them in the box's log.
Exit status 1 at the first error.
"""
import csv
import json
import re
import struct
import subprocess
import sys
import time

from pymodbus.client import ModbusSerialClient, ModbusTcpClient

where, saved, read_file = sys.argv[1], sys.argv[3], sys.argv[4]
serial = not where.isdigit()
rows = list(csv.DictReader(open(sys.argv[2])))
if serial:
    # 8N1: a pseudo-terminal refuses it the parity it has not
    box = ModbusSerialClient(where, baudrate=115200)
    PLACE, HOST = ("-m", "rtu", "-b", "115200", "-P", "none"), where
else:
    box = ModbusTcpClient("127.0.0.1", port=int(where))
    PLACE, HOST = ("-m", "tcp", "-p", where), "127.0.0.1"
box.connect()


def fail(text):
    sys.exit("strangers: " + text)


def check(good, text):
    if not good:
        fail(text)


def words(answer, what):
    check(not answer.isError(), f"{what}: {answer}")
    return answer.registers


def exception(answer, code, what):
    check(answer.isError() and getattr(answer, "exception_code", None) == code,
          f"{what}: {answer}, not {code}")


def u32(pair):
    return pair[0] << 16 | pair[1]


def i32(pair):
    return struct.unpack(">i", struct.pack(">HH", *pair))[0]


def pair(v):
    return list(struct.unpack(">HH", struct.pack(">i", v)))


def float_of(raw, frac):
    """The nearest binary32: raw is exact in a double, and so is its share."""
    return struct.unpack(">I", struct.pack(">f", raw / 2.0**frac))[0]


read = {"input": box.read_input_registers, "holding": box.read_holding_registers}
row_of = {(r["table"], int(r["address"], 16)): r for r in rows}


LIMITS, TICK, MISSED = 0x14, 0x08, 0x1A  # in the head
of_tick = []  # what was read of what moves: between which ticks, where, which registers or bits


def moves(table, at):
    """What the log has of every tick."""
    if table == "discrete":
        return 0x80 <= at < 0xA0
    return table == "input" and (at & ~1 in (LIMITS, TICK) or 0x1000 <= at < 0x5000)


def head():
    got = words(box.read_input_registers(TICK, count=MISSED + 2 - TICK), "the head")
    return {a: u32(got[a - TICK : a - TICK + 2]) for a in (TICK, MISSED)}


def keep(before, behind, who, table, at, values):
    if any(moves(table, at + i) for i in range(len(values))):
        of_tick.append([before[TICK], behind[TICK], who, table, at, values])


def pymodbus_reads():
    """Every value by a separate request. Returns what was read, a register a key."""
    seen = {}
    for (table, at), r in row_of.items():
        if table in read:
            got = words(read[table](at, count=2), r["name"])
            seen[table, at], seen[table, at + 1] = got
        else:
            f = box.read_coils if table == "coil" else box.read_discrete_inputs
            seen[table, at] = int(f(at, count=1).bits[0])
    return seen


def frac_of(r):
    return int(re.search(r"q(\d+)", r["format"]).group(1)) if "q" in r["format"] else 0


def check_values(seen):
    """The float block is the raw one; parameters are those of the image; the head's constants."""
    floats = 0
    for (table, at), r in row_of.items():
        raw_row = row_of.get((table, at - 0x2000))
        if r["format"] != "f32" or raw_row is None:
            continue
        # between two readings of the same raw value, which may have moved and come back
        for _ in range(3 if serial else 100):
            before = head()
            raw, got, again = (words(read[table](a, count=2), r["name"])
                               for a in (at - 0x2000, at, at - 0x2000))
            behind = head()
            keep(before, behind, "pymodbus", table, at - 0x2000, raw)
            keep(before, behind, "pymodbus", table, at, got)
            same = raw == again and u32(got) == float_of(i32(raw), frac_of(raw_row))
            if same or (raw == again and not moves(table, at)):
                break
        # over a line three requests are of three ticks: what moves is looked for in the log, float
        # and raw
        check(same or (serial and moves(table, at)), f"{r['name']}: float of {i32(raw)}")
        floats += 1
    check(seen["input", 0] == 0x4558 and seen["input", 1] == 0x4831, "magic")
    check(u32([seen["input", 4], seen["input", 5]]) == 0x12345678, "test_int")
    check(u32([seen["input", 6], seen["input", 7]]) == 0x3F800000, "test_float")
    return floats


def check_image(seen):
    """An image holds the values behind twelve bytes, little-endian."""
    check(not box.write_coil(2, True).isError(), "SAVE")
    time.sleep(0.5)
    image = open(saved, "rb").read()
    n = struct.unpack_from("<H", image, 6)[0]
    for i, v in enumerate(struct.unpack_from(f"<{n}i", image, 12)):
        check(pair(v) == [seen["input", 0x5000 + 2 * i], seen["input", 0x5001 + 2 * i]],
              f"parameter {i} is {v}")
    return n


def pymodbus_writes(seen):
    """Both ends of each range, and beyond; a set-up value does not change. As it was in the end."""
    live = 0
    for (table, at), r in row_of.items():
        if table != "holding" or r["format"] == "f32" or not r["min"]:  # the trace has no range
            continue
        now = [seen[table, at], seen[table, at + 1]]
        ends = [round(float(r[e]) * 2.0 ** frac_of(r)) for e in ("min", "max")]
        if r["when"] in ("set-up", "person", "word"):
            other = pair(i32(now) + (1 if i32(now) < ends[1] else -1))
            exception(box.write_registers(at, other), 3, f"{r['name']} is of the set-up")
            continue
        for e in (now, pair((ends[0] + ends[1]) // 2), now):
            check(not box.write_registers(at, e).isError(), f"{r['name']} := {e}")
            words_back = words(box.read_holding_registers(at, count=2), r["name"])
            check(words_back == e, f"{r['name']}: {words_back}, not {e}")
            whole = words(box.read_holding_registers(at + 0x2000, count=2), r["name"])
            check(u32(whole) == float_of(i32(e), frac_of(r)), f"{r['name']}: its float")
        for beyond in (ends[0] - 1 - abs(ends[0]) // 2**20, ends[1] + 1 + abs(ends[1]) // 2**20):
            if -(2**31) <= beyond < 2**31:
                exception(box.write_registers(at, pair(beyond)), 3, f"{r['name']} := {beyond}")
        exception(box.write_registers(at + 0x2000, [0x7FC0, 0]), 3, "no number")
        exception(box.write_register(at + 0x2000, 0), 3, "half a float")
        live += 1
    return live


def pymodbus_refused():
    exception(box.read_input_registers(0x0430, count=1), 2, "the gap behind the trace")
    exception(box.read_input_registers(0x0FFF, count=2), 2, "into a block")
    exception(box.read_holding_registers(0, count=1), 2, "no holding registers here")
    exception(box.read_coils(6, count=1), 2, "no coil")
    exception(box.read_discrete_inputs(192, count=1), 2, "no discrete input")
    exception(box.write_coil(4, True), 3, "RUN, which was not allowed")
    exception(box.write_coils(0, [True, True]), 3, "APPLY with DISCARD")
    # of a function with data libmodbus looks for the CRC in the wrong place: no answer
    if not serial:
        exception(box.read_fifo_queue(address=0), 1, "function 24")
    exception(box.read_exception_status(), 1, "function 7")
    exception(box.report_device_id(), 1, "function 17")


def mbpoll(*args):
    got = subprocess.run(["mbpoll", "-0", "-1", "-q", *PLACE, "-a", "1", *args],
                         stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
    return got.returncode, got.stdout


TYPE = {"coil": "0", "discrete": "1", "input": "3:hex", "holding": "4:hex"}


def mbpoll_reads(seen):
    """The same registers as pymodbus has read, up to 100 a request, with the same values or, of the
    tick, for the log; ticks and ticks missed in their order."""
    keys = sorted(seen)
    moved = 0
    while keys:
        table, at = keys[0]
        n = 1
        while n < min(100, len(keys)) and keys[n] == (table, at + n):
            n += 1
        keys = keys[n:]
        before = head()
        status, said = mbpoll("-t", TYPE[table], "-r", str(at), "-c", str(n), HOST)
        behind = head()
        got = [(int(where), int(v, 0)) for where, v in re.findall(r"\[(\d+)\]:\s+(\S+)", said)]
        check(status == 0 and [w for w, _ in got] == list(range(at, at + n)),
              f"mbpoll {table} {at:#x}: {said}")
        value = dict(got)
        keep(before, behind, "mbpoll", table, at, [v for _, v in got])
        for a in (TICK, MISSED):
            if table == "input" and a in value:
                v = u32([value.pop(a), value.pop(a + 1)])
                check(before[a] <= v <= behind[a],
                      f"mbpoll {a:#x}: {v}, not from {before[a]} to {behind[a]}")
        for where, v in value.items():
            if v != seen[table, where]:
                check(moves(table, where),
                      f"mbpoll {table} {where:#x}: {v:#x}, not {seen[table, where]:#x}")
                moved += 1
    return len(seen), moved


def mbpoll_writes(seen):
    live = 0
    for (table, at), r in row_of.items():
        if table != "holding" or r["format"] == "f32" or not r["min"]:  # the trace has no range
            continue
        now = [seen[table, at], seen[table, at + 1]]
        low = round(float(r["min"]) * 2.0 ** frac_of(r))
        high = round(float(r["max"]) * 2.0 ** frac_of(r))
        fixed = r["when"] == "set-up"
        v = pair((low + high) // 2 + 1)
        status, said = mbpoll("-t", "4:hex", "-r", str(at), HOST, *[f"0x{w:04X}" for w in v])
        if fixed:
            check(v == now or (status != 0 and "Illegal data value" in said),
                  f"mbpoll {r['name']}: {said}")
            continue
        check(status == 0, f"mbpoll {r['name']}: {said}")
        back = words(box.read_holding_registers(at, count=2), r["name"])
        check(back == v, f"mbpoll {r['name']}: wrote {v}, there is {back}")
        live += 1
    for args, want in ((("-t", "4:hex", "-r", "0", "-c", "1", HOST), "Illegal data address"),
                       (("-t", "0", "-r", "4", HOST, "1"), "Illegal data value")):
        status, said = mbpoll(*args)
        check(status != 0 and want in said, f"mbpoll {args}: {said}")
    check(mbpoll("-t", "0", "-r", "1", HOST, "1")[0] == 0, "mbpoll: DISCARD")
    for (table, at), v in seen.items():
        if table == "holding" and at < 0x7000:
            check(words(box.read_holding_registers(at, count=1), "")[0] == v,
                  f"{at:#x} was not discarded")
    return live


seen = pymodbus_reads()
print(f"pymodbus: {len(seen)} registers and bits, {check_values(seen)} floats of raw values,",
      end=" ")
print(f"{check_image(seen)} parameters as saved, {pymodbus_writes(seen)} written, refused as they "
      f"should be")
pymodbus_refused()
seen = pymodbus_reads()  # the box has counted a command
same, moved = mbpoll_reads(seen)
print(f"mbpoll:   {same} with the same values, but {moved} in motion; {mbpoll_writes(seen)} "
      f"written, refused likewise")
with open(read_file, "w") as f:
    json.dump(of_tick, f)
