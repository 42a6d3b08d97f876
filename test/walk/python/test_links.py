# SPDX-License-Identifier: MIT
"""World, registers and MCAP against the host program."""
import contextlib
import json
import os
import re
import subprocess

import numpy as np
import pytest

import exhand
from exhand import mcap, modbus

PROGRAM = os.environ["EXHAND"]


@contextlib.contextmanager
def box(*words):
    p = subprocess.Popen([PROGRAM, "run", *map(str, words)], stdout=subprocess.PIPE,
                         stderr=subprocess.STDOUT, text=True)
    try:
        yield p
    finally:
        p.terminate()
        p.communicate()


def test_a_wall_is_felt_where_the_world_says():
    with exhand.World() as world, box(
            "--scene", "bilateral", "--udp", "127.0.0.1:%d" % world.port, "--pace", "--slack", 1,
            "--rate", 500, "--seconds", 5):
        world.ask("mat_k", 500)
        world.ask("mat_b", 2000)  # beyond the row's range
        wall = exhand.Plane(normal=(0, 0, 2), point=(0.1, 0, 0.165))
        seen = []
        for state in world.states(6):
            world.answer({1: wall})
            seen.append(state)
    assert len(seen) > 100 and seen[-1].fingers == (1,)
    assert world.told["mat_k"] == "taken" and world.told["mat_b"] not in ("", "taken")
    deep = max(seen, key=lambda s: s.force_N[1])
    assert deep.frozen[1] and deep.touching[1] and deep.force_N[1] > 0.5
    # d is the tip's distance and the pad's radius, which does not change.
    pad = [s.d_m[1] + s.tip_m[1, 2] - 0.165 for s in seen if np.isfinite(s.d_m[1])]
    assert len(pad) > 100 and 0.002 < min(pad) and max(pad) - min(pad) < 1e-6


def test_packets_of_others_change_nothing():
    with exhand.World() as world:
        for junk in (b"", b"XW", bytes(236)):
            world._socket.sendto(junk, ("127.0.0.1", world.port))
        assert list(world.states(0.2)) == [] and world._to is None


@pytest.mark.parametrize("plane", [
    exhand.Plane((0, 0, 0), (0, 0, 0)), exhand.Plane((0, 0, 1), (0, 0, 3)),
    exhand.Plane((0, 1), (0, 0, 0))])
def test_a_plane_that_cannot_be_is_refused(plane):
    with exhand.World() as world, pytest.raises(ValueError, match="plane of finger 0|point"):
        world.answer({0: plane})


def served(p):
    for line in p.stdout:
        if found := re.match(r"modbus: tcp:127\.0\.0\.1:(\d+)$", line.strip()):
            return int(found.group(1))
    pytest.skip("this program has no Modbus server")


def test_registers_by_name():
    with box("--rate", 500, "--pace", "--modbus", "tcp:127.0.0.1:0", "--modbus-write") as p, \
            modbus.Box("127.0.0.1", served(p)) as b:
        assert b.scene.name == "drop" and b["test_int"] == 0x12345678 and b["test_float"] == 1.0
        assert b["period_num"] / b["period_den"] == 1 / 500 and b.unit("k") == "n_per_m"
        k = b["k"]
        b["k"] = k / 2
        b.apply()
        while b["pending"]:
            pass
        assert b["result"] == 0
        now = b["k"]
        while now != k / 2:  # it goes there little by little; the end of the box ends this, too
            before, now = now, b["k"]
            assert k / 2 <= now <= before <= k
        for name in b.names():
            assert b[name] is not None
        with pytest.raises(modbus.ModbusError, match="refused"):
            b["k"] = 1e9
        with pytest.raises(KeyError):
            b["f_des"] = 1
        with pytest.raises(KeyError):
            b["no_such_name"]


def test_mcap_has_every_value(tmp_path):
    from mcap.reader import make_reader
    subprocess.run([PROGRAM, "drop", "--rate", "500", "--falls", "1", "--runs", "1", "--out",
                    tmp_path], check=True, capture_output=True)
    path = next(tmp_path.rglob("*.exh"))
    log, out = exhand.Log(path), tmp_path / "log.mcap"
    assert mcap.write(log, out) == len(log.tick) + len(log.events)
    arrays = log.arrays(all=True)
    with open(out, "rb") as f:
        rows = [(m.log_time, json.loads(m.data), schema) for schema, channel, m in
                make_reader(f).iter_messages(topics=["/drop"])]
    assert len(rows) == len(log.tick)
    for k, (t, row, _) in enumerate(rows):
        assert t == round(log.t_s[k] * 1e9)
        assert row == {n: v[k] for n, v in arrays.items() if n != "t_s"}
    fields = json.loads(rows[0][2].data)["properties"]
    assert fields["f_des_n"]["description"] == "n"
