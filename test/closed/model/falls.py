# SPDX-License-Identifier: MIT
"""Results of a run of falls, by the paper's steps: a separate analysis.

A fall is a list of ticks (t, position, monitored force, touching). Standard library only.
"""

import math

LOW_N, HIGH_N = 0.8, 4.5   # the band, both ends in it
MEAN_OF, KEPT = 10, 6      # ten positions; the force is the sixth's
WINDOW_S = 0.5
TRAVEL_M, SWING_N = 0.25e-3, 4.0


def contacts(fall):
    """Runs of ticks with contact."""
    runs, now = [], []
    for tick in fall:
        if tick[3]:
            now.append(tick)
        elif now:
            runs.append(now)
            now = []
    return runs + [now] if now else runs


def pairs(falls):
    """(force, position it answers, number of the fall): the monitor answers the tick before."""
    return [(c[n][2], c[n - 1][1], i) for i, f in enumerate(falls) for c in contacts(f)
            for n in range(1, len(c))]


def averaged(sorted_pairs):
    out = []
    for n in range(len(sorted_pairs) - MEAN_OF + 1):
        ten = sorted_pairs[n:n + MEAN_OF]
        out.append((ten[KEPT - 1][0], math.fsum(p[1] for p in ten) / MEAN_OF))
    return out


def slopes(points):
    """(N/m of force over position, m/N of position over force, r squared)"""
    n = len(points)
    mf, mq = math.fsum(p[0] for p in points) / n, math.fsum(p[1] for p in points) / n
    ff = math.fsum((p[0] - mf) ** 2 for p in points)
    qq = math.fsum((p[1] - mq) ** 2 for p in points)
    fq = math.fsum((p[0] - mf) * (p[1] - mq) for p in points)
    return fq / qq, fq / ff, fq * fq / (ff * qq)


def t_975(degrees):
    """97.5 % of Student's t: its density summed by Simpson, the end found by halving."""
    c = math.exp(math.lgamma((degrees + 1) / 2) - math.lgamma(degrees / 2)) / math.sqrt(
        degrees * math.pi)

    def above_zero(t, n=2000):
        y = [c * (1 + (t * i / n) ** 2 / degrees) ** (-(degrees + 1) / 2) for i in range(n + 1)]
        return t / n / 3 * (y[0] + y[-1] + 4 * sum(y[1:-1:2]) + 2 * sum(y[2:-1:2]))
    low, high = 0.0, 20.0
    while high - low > 1e-7:
        mid = (low + high) / 2
        low, high = (mid, high) if above_zero(mid) < 0.475 else (low, mid)
    return low


def stiffness(falls):
    """A, B, r squared, and the ends of B's 95 % interval by leaving out fall after fall. None:
    fewer than twelve pairs in the band, or force does not rise with position."""
    band = sorted((p for p in pairs(falls) if LOW_N <= p[0] <= HIGH_N), key=lambda p: p[0])
    if len(band) < MEAN_OF + 2:
        return None
    a, per_N, r2 = slopes(averaged(band))
    if per_N <= 0:
        return None
    less = [slopes(averaged([p for p in band if p[2] != i]))[1]
            for i in sorted({p[2] for p in band})]
    n = len(less)
    mean = sum(less) / n
    half = t_975(n - 1) * math.sqrt((n - 1) / n * sum((v - mean) ** 2 for v in less))
    high = 1 / (per_N - half) if per_N > half else math.inf
    return a, 1 / per_N, r2, 1 / (per_N + half), high


def end_of(fall):
    """The ticks that are judged: the last half second of the observation, four ticks at least."""
    T_s = (fall[-1][0] - fall[0][0]) / (len(fall) - 1)
    return [t for t in fall if t[0] >= fall[-1][0] + T_s / 2 - max(WINDOW_S, 4 * T_s)]


def rests(fall):
    end = end_of(fall)
    q, f = [t[1] for t in end], [t[2] for t in end]
    return max(q) - min(q) <= TRAVEL_M and max(f) - min(f) <= SWING_N


def seen(fall, lim_m, T_s):
    """(impact speed m/s, depth m, rest position m, contacts) of a fall."""
    first = next(n for n, t in enumerate(fall) if t[3])
    back = max(1, int(0.01 / T_s))
    impact = (fall[first][1] - fall[first - back][1]) / (back * T_s)
    end = end_of(fall)
    return (impact, max(t[1] for t in fall) - lim_m,
            math.fsum(t[1] for t in end) / len(end) - lim_m, len(contacts(fall)))
