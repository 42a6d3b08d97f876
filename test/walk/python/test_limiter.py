# SPDX-License-Identifier: MIT
"""The limiter from Python: what it lets through, causes by name."""
import math

import numpy as np
import pytest

import exhand
from exhand import limiter

PAR = dict(rate_Hz=1000, effort_max=2, effort_up=100, effort_down=200, ramp_s=0.1, release_s=0.02,
           age_max_s=0.05, gap_max_s=0.02, first_max=2)


def make(**more):
    return exhand.Limiter("effort", uses=("deadman",), **{**PAR, **more})


def running(guard, command=1.0, n=400):
    """Armed and on its way, at time n ms."""
    guard.step(0, 0, deadman=False, run=False)
    for k in range(1, n):
        step = guard.step(k * 1e-3, command, deadman=k > 1)
    return step


def test_a_command_is_limited_in_size_and_rise():
    guard = make()
    running(guard)
    for k in range(400, 430):
        step = guard.step(k * 1e-3, 5.0, deadman=True)
    assert step.send == 2.0 and step.enable and step.first is None and "effort" in step.limits
    sent = [guard.step(0.43 + k * 1e-3, -5.0, deadman=True).send for k in range(100)]
    change = -np.diff([step.send, *sent])
    assert sent[-1] == -2.0 and change.max() <= 0.2 + 1e-9 and change.min() >= 0


@pytest.mark.parametrize("cause,more", [
    ("not_a_number", dict(command=math.nan)), ("not_a_number", dict(command=math.inf)),
    ("stale", dict(age_s=0.06)), ("stale", dict(age_s=math.inf)), ("deadman", dict(deadman=False)),
    ("time", dict(now_s=1.0))])
def test_causes_stop_and_have_a_name(cause, more):
    guard = make()
    assert running(guard).state == "run"
    step = guard.step(**{**dict(now_s=0.4, command=1.0, deadman=True), **more})
    assert step.first == cause and step.state == "release"
    for k in range(1, 60):
        step = guard.step(more.get("now_s", 0.4) + k * 1e-3, 1.0,
                          deadman=more.get("deadman", True))
    assert step.state == "fault" and step.first == cause and not step.enable and step.send == 0


def test_many_steps_are_as_one_by_one():
    rng = np.random.default_rng(2)
    n = 2000
    steps = np.zeros(n, limiter.IN)
    steps["now_us"] = 1000 * np.arange(n)
    steps["command"] = rng.integers(-2 ** 31, 2 ** 31, n)
    steps["command"][:1500] //= 1000
    steps["deadman"], steps["run"] = np.arange(n) > 2, 1
    out, one = make().run(steps), make()
    assert np.abs(out["send"].astype(np.int64)).max() <= 2000000
    for i, o in zip(steps, out):
        command = math.nan if i["command"] == limiter.NONE else i["command"] * 1e-6
        step = one.step(i["now_us"] * 1e-6, command, deadman=bool(i["deadman"]))
        assert limiter.micro(step.send) == o["send"] and limiter.STATES[o["state"]] == step.state
    assert len(set(out["state"])) >= 3


def test_micro():
    assert [limiter.micro(x) for x in (0, 1.5e-6, -1.5e-6, 2147.483647, 1e9, -1e9)] == \
        [0, 2, -2, 2 ** 31 - 1, 2 ** 31 - 1, -2 ** 31 + 1]
    assert limiter.micro(math.nan) == limiter.micro(-math.inf) == limiter.NONE


@pytest.mark.parametrize("error,words,make_it", [
    (TypeError, "torque_max: no such", lambda: make(torque_max=1)),
    (ValueError, "effort_max: 0", lambda: make(effort_max=0)),
    (ValueError, "uses: ..switch", lambda: exhand.Limiter("effort", uses=("switch",), **PAR)),
    (ValueError, "kind: torque", lambda: exhand.Limiter("torque", **PAR)),
    (ValueError, "uses: \\(", lambda: exhand.Limiter("position", pos_min=-1, pos_max=1,
                                                        vel_max=1, acc_max=1, **PAR))])
def test_refusals_name_the_argument(error, words, make_it):
    with pytest.raises(error, match=words):
        make_it()
