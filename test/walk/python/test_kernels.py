# SPDX-License-Identifier: MIT
"""The kernels of the package against the models of the golden vectors, bit for bit."""
import sys
from pathlib import Path

import numpy as np
import pytest

import exhand

sys.path.insert(0, str(Path(__file__).parents[2] / "golden"))
from model import contact, filter as filters, quad, velocity  # noqa: E402

RATE = 1000
RNG = np.random.default_rng(1)


def walk(n, most):
    """Counts of a random walk, across the wrap."""
    steps = RNG.integers(-most, most + 1, n)
    return ((np.cumsum(steps) + 2 ** 31) % 2 ** 32).astype(np.uint32).view(np.int32)


@pytest.mark.parametrize("order,cutoff", [(1, 5), (2, 5), (2, 60.5), (1, 300), (2, 300)])
def test_low_pass(order, cutoff):
    x = RNG.integers(-2 ** 31, 2 ** 31, (500, 3)).astype(np.int32)
    cfg = filters.Config(order, round(cutoff * 65536), (1, RATE))
    channels = [filters.Channel(int(v)) for v in x[0]]
    wanted = [[c.tick(cfg, int(v)) for c, v in zip(channels, row)] for row in x]
    f = exhand.LowPass(cutoff, RATE, order)
    ours = np.concatenate([f(x[:7]), f(x[7:])])
    assert ours.dtype == np.int32 and np.array_equal(ours, wanted)


def test_low_pass_of_floats_is_that_of_their_integers():
    x = RNG.normal(size=300)
    ours = exhand.LowPass(20, RATE, lsb=2.0 ** -20)(x)
    whole = exhand.LowPass(20, RATE)(np.rint(x * 2 ** 20).astype(np.int32))
    assert np.array_equal(ours, whole * 2.0 ** -20)


@pytest.mark.parametrize("mode", [1, 2, 4])
def test_quadrature(mode):
    ab = RNG.integers(0, 4, 4000)
    model, wanted, q = quad.Lines(mode), [], exhand.Quadrature(mode)
    for s in ab:
        model.samples([int(s)])
        wanted.append(model.cnt)
    ours = np.concatenate([q(ab[:99] >> 1, ab[:99] & 1), q(ab[99:] >> 1, ab[99:] & 1)])
    assert np.array_equal(ours, wanted) and q.illegal == model.illegal > 0


def test_counter_and_position():
    raw = np.cumsum(RNG.integers(-100, 101, 2000)) & 0xFFFFFF
    step = 5e-6
    q42 = round(step * 2 ** 42)
    model, c = quad.Quad(q42, 10 << 27, (1, RATE), 24), exhand.Counter(step, RATE, bits=24)
    cnt = c(raw)
    assert np.array_equal(cnt, [model.tick(int(r)) for r in raw]) and not c.lost
    assert np.array_equal(c.position_m(cnt) * 2 ** 30, [quad.position(int(k), q42) for k in cnt])
    c([int(raw[-1]) + 1 << 20])
    assert c.lost


@pytest.mark.parametrize("method,par,make", [
    ("window", 8, lambda s, T: velocity.Window(s, T, 3)),
    ("pole", 0.005, lambda s, T: velocity.Pole(s, T, 5000)),
    ("foaw", 12, lambda s, T: velocity.Foaw(s, T, 12, 1)),
    ("track", 0.003, lambda s, T: velocity.Track(s, T, 3000))])
def test_velocity(method, par, make):
    for most in (2, 3000):
        cnt = walk(2000, most)
        model = make(round(5e-6 * 2 ** 42), (1, RATE))
        v = exhand.Velocity(method, 5e-6, RATE, par)
        ours = np.concatenate([v(cnt[:33]), v(cnt[33:])]) * 2 ** 27
        assert np.array_equal(ours, [model.tick(int(k)) for k in cnt])


def test_contact():
    n = 3000
    pos = 0.02 + 0.01 * np.sin(np.arange(n) / 50) + RNG.normal(0, 1e-4, n)
    vel = RNG.normal(0, 0.3, n)
    par = (800, 2, 0.3, 2e-4, 1e-4)
    model = contact.Contact()
    raw = [round(v * 2 ** q) for v, q in zip(par, (10, 20, 20, 30, 30))]
    q, v, lim = np.rint(pos * 2 ** 30), np.rint(vel * 2 ** 27), round(0.02 * 2 ** 30)
    wanted = np.array([model.tick(raw, int(a), int(b), lim) for a, b in zip(q, v)])
    ours = exhand.Contact(*par)(pos, vel, 0.02)
    assert np.array_equal(ours["touching"], wanted[:, 0]) and 0 < wanted[:, 0].sum() < n
    for name, column in zip(("spring", "damper", "pullback"), wanted[:, 1:].T):
        assert np.array_equal(ours[name] * 2 ** 20, column), name
    force = exhand.Contact(800, 2).force_N(pos, vel, 0.02)
    assert np.allclose(force, np.maximum(0, np.where(pos >= 0.02, 800 * (pos - 0.02) + 2 * vel, 0)),
                       atol=2e-5)


@pytest.mark.parametrize("call,words", [
    (lambda: exhand.LowPass(500, 1000), "cut-off"),
    (lambda: exhand.LowPass(5, 30000), "rate_Hz: 30000 "),
    (lambda: exhand.LowPass(5, 1000)([np.nan]), "x: .*nan"),
    (lambda: exhand.Velocity("window", 5e-6, 1000, 3), "window of 3"),
    (lambda: exhand.Velocity("best", 5e-6, 1000, 3), "method: best"),
    (lambda: exhand.Contact(-1, 0), "k_Npm: -1 "),
    (lambda: exhand.Contact(1, 0)(3, 0, 0), "pos_m: 3|pos_m: .*3"),
    (lambda: exhand.Counter(5e-6, 1000)([0.5]), "raw: give integers"),
    (lambda: exhand.Counter(1, 1000), "counter: |step_m: ")])
def test_refusals_say_what_is_wrong(call, words):
    with pytest.raises(ValueError, match=words):
        call()
