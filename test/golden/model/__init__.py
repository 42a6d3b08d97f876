# SPDX-License-Identifier: MIT
"""The modules that have golden vectors: {name: (columns, run(rate) -> (row, state) a tick)}."""

from . import (basics, bilateral, calibrate, chatter, contact, drive, drop, filter,
               filter_cheap, gains, glove, glove_cal, guard, hand, limiter, mac, modbus, passivity,
               precontact, probe, quad, ring, safety, signal, slots, track, velocity, watch, wire)

MODULES = {}
for part in (basics, mac, ring, signal, slots, quad, velocity, contact, drive, track, passivity,
             watch, chatter, guard, safety, limiter, calibrate, filter, filter_cheap, gains, glove,
             glove_cal, hand, precontact, wire, modbus, drop, bilateral, probe):
    MODULES.update(part.MODULES)
