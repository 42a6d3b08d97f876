# SPDX-License-Identifier: MIT
"""angle and hand: sine and cosine, sensors to joints to a fingertip and its slope."""

from .num import AGAIN, MAX32, MIN32, TICKS, Rng, clamp, div, shr, wave, wrap

S = 1686629689, -693597423, 85551349, -4930933
C = 1324675872, -272375277, 22398564, -970686


def sincos(x):
    u = -abs(wrap(4 * x))
    z = u * u >> 32
    s = u * (S[0] + (z * (S[1] + (z * (S[2] + (z * S[3] >> 32)) >> 32)) >> 32)) >> 32
    c = (z * (C[0] + (z * (C[1] + (z * (C[2] + (z * C[3] >> 32)) >> 32)) >> 32)) >> 32) - (1 << 30)
    if x + (1 << 29) >> 30 & 1:
        s, c = c, s
    return s if x < 0 else -s, c if x + (1 << 30) >> 31 & 1 else -c


def angle(rate):
    x, rng = wave("angle", rate, 1, MIN32, MAX32, 1 << 24), Rng("angle", rate, 0)
    for k in range(TICKS):
        near = wrap((rng.draw(0, 7) << 29) + rng.draw(-3, 3))
        yield (x[k], near, *sincos(x[k]), *sincos(near)), b""


ANGLE = "x_turn_q32 near_turn_q32 | sin_q30 cos_q30 near_sin_q30 near_cos_q30"


def joints(of_finger, sensor):
    """(bits, angles): of each joint bias, two gains, two sensors, lo, hi."""
    bits, out = 0, []
    for j, (bias, gain, term, lo, hi) in enumerate(of_finger):
        want = shr((bias << 24) + gain[0] * sensor[term[0]] + gain[1] * sensor[term[1]], 24)
        got = clamp(want, lo, hi)
        bits |= (got != want) << j
        out.append(got)
    return bits, out


class Finger:
    def __init__(self, length, rot, base, arm1, arm2, arm3):
        self.length, self.rot, self.base = length, rot, base
        r = arm1, arm2 + arm3
        d = (r[0] ** 2 + r[1] ** 2) >> 14
        self.pull = [((v << 36) + (d >> 1)) // d for v in r]

    def follow(self, of_finger, bent):
        """The pulls with the map's gains."""
        def rate(sensor):
            return self.pull[0] if sensor == bent[0] else self.pull[1] if sensor in bent[1:] else 0

        pull = [shr(sum(g * rate(s) for g, s in zip(gain, term)), 24)
                for _, gain, term, _, _ in of_finger[1:]]
        if max(map(abs, pull)) <= 250 << 20:
            self.pull = pull

    def tip_slope(self, q):
        """P_F and its derivative along the string."""
        (s0, c0), (s1, c1), (s2, c2) = map(sincos, q)

        def turn(a, b):
            f = (a * c1 - b * s1) >> 30
            return c0 * f >> 30, s0 * f >> 30, (a * s1 + b * c1) >> 30

        l0, l1, l2 = self.length
        m = (l1 >> 1) + (l2 * c2 >> 30)
        a, b = l0 - l2 + (m * c2 >> 29), m * s2 >> 29
        v = turn(a, b)
        tip = [(place + sum(r * x >> 32 for r, x in zip(row, v)) + 3) >> 2
               for row, place in zip(self.rot, self.base)]
        k, (w1, w2) = m - (l1 >> 2), self.pull
        a1, b1 = -(k * s2 >> 29), (k * c2 >> 29) - l2
        v = turn(shr(2 * w2 * a1 - w1 * b, 30), shr(2 * w2 * b1 + w1 * a, 30))
        return tip, [shr(sum(r * x for r, x in zip(row, v)), 30) for row in self.rot]


def any_map(rng):
    """Of one finger."""
    out = []
    for _ in range(3):
        bias = rng.draw(MIN32, MAX32) >> rng.draw(0, 8)
        gain = [rng.draw(-(1 << 27), 1 << 27) >> rng.draw(0, 8) for _ in range(2)]
        term = [rng.draw(0, 21) for _ in range(2)]
        out.append((bias, gain, term, rng.draw(MIN32, 0), rng.draw(0, MAX32)))
    return out


def any_turn(rng):
    """Cosine and sine of some angle as n/d: (c, s, d)."""
    p, q = rng.draw(1, 50), rng.draw(1, 50)
    return p * p - q * q, 2 * p * q, p * p + q * q


def any_finger(rng):
    length = [rng.draw(1, 687194767) for _ in range(3)]
    (c1, s1, d1), (c2, s2, d2) = any_turn(rng), any_turn(rng)
    rot = ((c1 * d2, -s1 * c2, s1 * s2), (s1 * d2, c1 * c2, -c1 * s2), (0, s2 * d1, c2 * d1))
    rot = [[div(v << 30, d1 * d2) for v in row] for row in rot]
    base = [rng.draw(-536870912, 536870912) for _ in range(3)]
    arm = rng.draw(4294968, 53687091), rng.draw(0, 53687091), rng.draw(0, 53687091)
    return Finger(length, rot, base, *arm)


def hand(rate):
    rng = Rng("hand", rate, 0)
    waves = [wave("hand", rate, 1 + i, MIN32, MAX32, 1 << rng.draw(16, 28)) for i in range(4)]
    for k in range(TICKS):
        if k in (0, AGAIN):
            maps, fingers = [], []
            for _ in range(5):
                maps.append(any_map(rng))
                fingers.append(any_finger(rng))
                bent = [maps[-1][1 + j][2][rng.draw(0, 1)] for j in range(2)]
                last = rng.draw(0, 1)
                bent.append(maps[-1][1 + last][2][rng.draw(0, 1)])
                if rng.draw(0, 3):
                    fingers[-1].follow(maps[-1], bent)
        sensor = [waves[i & 3][k] ^ i for i in range(22)]
        f = k % 5
        bits, q = joints(maps[f], sensor)
        tip, slope = fingers[f].tip_slope(q)
        yield (f, bits, *q, *tip, *slope), b""


HAND = ("finger | limited q0_turn_q32 q1_turn_q32 q2_turn_q32 x_m_q30 y_m_q30 z_m_q30 "
        "x_slope_q24 y_slope_q24 z_slope_q24")

MODULES = {"angle": (ANGLE, angle), "hand": (HAND, hand)}
