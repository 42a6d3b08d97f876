# SPDX-License-Identifier: MIT
"""calibrate: mean, fit, the two tables made of the points, the image."""

import zlib
from struct import pack

from .drive import Table
from .num import CRC, M32, MAX32, MONOTONE, STALE, TICKS, VERSION, Rng, div, gain, sat32, times

DEVICE, FINGER, AGE, SCALE, FORCE_TABLE, MONITOR_TABLE = 1, 2, 3, 4, 6, 7


def fit(points, which):
    """(gain, kf) of the line through the origin; which: 1 current, 2 monitor."""
    g = gain(sum(p[0] * p[which] for p in points), sum(p[which] ** 2 for p in points))
    return g, times(g, 1 << 26)


def force_table(points, end):
    g, last = fit(points, 1)[0], points[-1]
    knots = [(0, 0)] + [(p[0], p[1]) for p in points]
    if end > last[1]:
        knots.append((last[0] + times(g, end - last[1]), end))
    return knots


def monitor_table(points, end):
    g, last = fit(points, 2)[0], points[-1]
    knots = [(p[2], p[0]) for p in points]
    if end > last[1]:
        knots.append((last[2] + end - last[1], last[0] + times(g, end - last[1])))
    return [(-x, -y) for x, y in reversed(knots)] + [(0, 0)] + knots


def knots_bytes(knots):
    t = Table(knots)
    return b"".join(pack("<iiiB", *k, *s) for k, s in zip(knots, t.slope + [(0, 0)]))


def image(values, points):
    body = b"EXHC" + pack("<HH", 2, len(points)) + pack("<10I", *[v & M32 for v in values])
    body += b"".join(pack("<4i", *p) for p in points)
    return body + pack("<I", zlib.crc32(body))


def any_points(rng):
    """Rising points of one device: 1 to 20 N/A, each a little off."""
    kf, points, f, i, m = rng.draw(1, 20), [], 0, 0, 0
    for _ in range(rng.draw(1, 5)):
        df = rng.draw(1 << 18, 1 << 20)
        f += df
        i += df * 64 // kf * rng.draw(90, 110) // 100
        m += df * 64 // kf * rng.draw(80, 120) // 100
        points.append([f, i, m, rng.draw(0, 1 << 24)])
    return points


def mean(rng):
    n, total = rng.draw(0, 9), 0
    for _ in range(n):
        total += rng.draw(-(1 << 31), (1 << 31) - 1) >> rng.draw(0, 31)
    return div(total, n) if n else 0


def calibrate(rate):
    rng = Rng("calibrate", rate, 0)
    for k in range(TICKS):
        middle, points = mean(rng), any_points(rng)
        values = [rng.u64() & M32, rng.draw(0, 4), rng.draw(1, 30000), rng.draw(0, 366),
                  rng.draw(65536, MAX32), rng.draw(0, 65535), rng.draw(1, MAX32),
                  rng.draw(-32768, 32767), rng.draw(0, 442918502), rng.draw(0, 442918502)]
        (g1, kf1), (g2, kf2) = fit(points, 1), fit(points, 2)
        p, which = points[rng.draw(0, len(points) - 1)], 1 + rng.draw(0, 1)
        rest = sat32(p[0] - times((g1, g2)[which - 1], p[which]))
        size = crc = load = 0
        if k % 4 == 0:
            saved = image(values, points)
            size, crc = len(saved), zlib.crc32(saved[:-1])
            load = -CRC if rng.draw(0, 3) == 0 else 0
            rng.draw(64, 8 * size - 1)  # the bit
        other, by = rng.draw(0, 9), rng.draw(1, 500)
        wrong, what = 0, 0
        if other == 0:
            wrong, what = -VERSION, DEVICE
        elif other == 1:
            wrong, what = -VERSION, FINGER
        elif other == 2 and by > values[3]:
            wrong, what = -STALE, AGE
        elif other == 3:
            wrong, what = -STALE, AGE
        elif 4 <= other <= 7:
            wrong, what = -STALE, SCALE
        force, monitor = force_table(points, values[9]), monitor_table(points, values[9])
        at, which2, err, bad_what, bad_at = (rng.draw(0, len(points) - 1), 1 + rng.draw(0, 1), 0, 0,
                                             0)
        if at > 0:  # spoil one
            points[at][which2] = points[at - 1][which2] - rng.draw(0, 1)
            err, bad_what, bad_at = -MONOTONE, (FORCE_TABLE, MONITOR_TABLE)[which2 - 1], at
        yield ((middle, len(points), kf1, *g1, kf2, *g2, rest, size, crc, load, wrong, what, err,
                bad_what, bad_at), knots_bytes(force) + knots_bytes(monitor))


COLUMNS = ("mean points kf_NpA_q20 mant shift kf_mon_NpA_q20 mant_mon shift_mon residual_N_q20 "
           "image_B crc "
           "load check check_what valid valid_what valid_at")

MODULES = {"calibrate": (COLUMNS, calibrate)}
