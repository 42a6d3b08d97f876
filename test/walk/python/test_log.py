# SPDX-License-Identifier: MIT
"""A log read by the package is what `exhand csv` says of it, and replay has the same bits."""
import csv
import io
import math
import os
import subprocess

import pytest

import exhand

PROGRAM = os.environ["EXHAND"]


def run(*words, ok=(0,)):
    done = subprocess.run([PROGRAM, *map(str, words)], capture_output=True, text=True)
    assert done.returncode in ok, done.stderr
    return done.stdout


@pytest.fixture(scope="module")
def logs(tmp_path_factory):
    """One of each kind: scenes, a glove's, a black box, several fingers."""
    d = tmp_path_factory.mktemp("logs")
    run("drop", "--rate", 500, "--falls", 1, "--runs", 1, "--out", d / "drop")
    run("drop", "--rate", 500, "--falls", 2, "--runs", 1, "--guarded", "--let-go", 1.7,
        "--blackbox", d / "box.exh", ok=(0, 1))
    run("run", "--scene", "bilateral", "--fingers", "thumb,ring", "--rate", 500, "--seconds", 3,
        "--log", d / "two.exh")
    run("bilateral", "--rate", 500, "--approaches", 1, "--speed", "fast", "--out", d / "one")
    run("glove", "--record", d / "glove.exh", "--seconds", 1)
    return sorted(p for p in d.rglob("*.exh"))


def same_as_csv(log, words, everything):
    rows = list(csv.reader(io.StringIO(run("csv", log.path, *words))))
    frame = log.frame(all=everything)
    names = [n for n in rows[0] if not n.startswith("raw")]  # a glove's codes are in log.inputs
    assert list(frame.columns) == names
    assert len(frame) == len(rows) - 1 > 100
    for name in names:
        text = "%.9f" if name == "t_s" else "%.9g"
        ours = ["" if math.isnan(v) else text % v for v in frame[name].tolist()]
        assert ours == [row[rows[0].index(name)] for row in rows[1:]], name
    for name in set(rows[0]) - set(names):
        ours = log.inputs["glove_raw"][:, int(name[3:])].tolist()
        assert ours == [int(row[rows[0].index(name)]) for row in rows[1:]]
    assert set(log.units(everything)) == set(names)


def test_logs_of_every_kind_are_as_the_csv(logs):
    assert len(logs) >= 5
    scenes = set()
    for path in logs:
        log = exhand.Log(path)
        scenes.add(log.scene)
        same_as_csv(log, (), False)
        same_as_csv(log, ("--all",), True)
        assert log.damage.bytes == log.damage.missing == log.damage.left_out == 0
    assert scenes == {"drop", "guarded", "bilateral", "glove"}


def test_replay_has_the_same_bits(logs):
    said = exhand.Log(logs[0]).replay()
    assert "identical" in said and "ticks" in said


def test_header_events_and_units(logs):
    log = exhand.Log(next(p for p in logs if "drop" in str(p)))
    assert log.scene == "drop" and log.period_s == 1 / 500 and log.params["k"] > 0
    assert log.units()["f_des_n"] == "n" and {"command", "mark"} <= {e["type"] for e in log.events}


def test_damage_is_counted_and_the_rest_read(logs, tmp_path):
    whole = logs[0].read_bytes()
    cut = tmp_path / "cut.exh"
    cut.write_bytes(whole[:9000] + b"junk" + whole[9000:20000] + whole[20100:-50])
    log = exhand.Log(cut)
    assert log.damage.bytes > 0 and log.damage.missing > 0 and not log.damage.ended
    rows = run("csv", cut, ok=(1,)).splitlines()
    assert len(rows) - 1 == len(log.tick)


def test_what_is_no_log_is_refused(tmp_path):
    text = tmp_path / "text"
    for content in (b"", b"t_s,q\n0,1\n"):
        text.write_bytes(content)
        with pytest.raises(ValueError, match="not a log"):
            exhand.Log(text)
