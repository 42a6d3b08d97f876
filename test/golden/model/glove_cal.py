# SPDX-License-Identifier: MIT
"""glove_cal: a glove's calibration as an image, what is refused of it and when."""

import zlib
from struct import pack

from .glove import CROSSED, SENSORS, any_sensor
from .num import CRC, M32, RANGE, STALE, TICKS, VERSION, Rng

USER, GLOVE, AGE, PRESENT, GAIN, ZERO, SPAN, CROSS = 1, 2, 3, 4, 5, 6, 7, 8


def image(values, sensors):
    body = b"EXHG" + pack("<HH5I", 1, SENSORS, *values)
    body += b"".join(pack("<iiiihhBB", zero, gain, *cross, low, high, *of)
                     for zero, gain, cross, low, high, of in sensors)
    return body + pack("<I", zlib.crc32(body))


def glove_cal(rate):
    rng = Rng("glove_cal", rate, 0)
    for k in range(TICKS):
        if k % 8 == 0:
            present = 0x3FFFFF & ~(1 << (0, 5, 10, 14, 20, 21, 31, 31)[rng.draw(0, 7)])
            sensors = [any_sensor(rng, i, present >> i & 1) for i in range(SENSORS)]
        values = [rng.u64() & M32, rng.u64() & M32, rng.draw(1, 30000), rng.draw(0, 400), present]
        size = crc = load = 0
        if k % 4 == 0:
            saved = image(values, sensors)
            size, crc = len(saved), zlib.crc32(saved[:-1])
            load = -CRC if rng.draw(0, 3) == 0 else 0
            rng.draw(64, 8 * size - 1)  # the bit
        other, by = rng.draw(0, 4), rng.draw(1, 500)
        wrong, what = 0, 0
        if other < 2:
            wrong, what = -VERSION, (USER, GLOVE)[other]
        elif other == 2 and by > values[3] or other == 3:
            wrong, what = -STALE, AGE
        spoil, at, little = rng.draw(0, 6), rng.draw(0, SENSORS - 1), rng.draw(-131071, 131071)
        bad = (0, 0, 0)
        if spoil == 0:
            bad = (-RANGE, PRESENT, 0)
        elif spoil == 1 and (present >> at & 1 or little):
            bad = (-RANGE, GAIN, at)
        elif spoil == 2 and present >> at & 1:
            bad = (-RANGE, ZERO, at)
        elif spoil == 3 and present >> at & 1:
            bad = (-RANGE, SPAN, at)
        elif spoil in (4, 5):
            bad = (-RANGE, CROSS, CROSSED[at & 3])
        yield (size, crc, load, wrong, what, *bad), b""


COLUMNS = "image_B crc load check check_what valid valid_what valid_at"

MODULES = {"glove_cal": (COLUMNS, glove_cal)}
