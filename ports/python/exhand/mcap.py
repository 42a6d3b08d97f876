# SPDX-License-Identifier: MIT
"""A log as MCAP for Foxglove and PlotJuggler: `exhand-mcap LOG [OUT.mcap]`. Needs exhand[mcap]."""
from __future__ import annotations

import argparse
import json
import math
import os
import sys
from pathlib import Path
from typing import Union

from .log import Log


def write(log: Log, path: Union[str, "os.PathLike[str]"], start_s: float = 0.0) -> int:
    """Writes one JSON message a tick on the topic /SCENE, a field a column of `exhand csv --all`
    but for the time, and the events on /events. Log time is start_s + t_s. Returns the messages.
    The schema has the unit of each field; a field without a value is null."""
    from mcap.writer import Writer
    columns = {name: v.tolist() for name, v in log.arrays(all=True).items() if name != "t_s"}
    units = log.units(all=True)
    schema = {"type": "object", "properties": {
        name: {"type": "number", "description": units[name]} for name in columns}}
    times = [round((start_s + t) * 1e9) for t in log.t_s.tolist()]
    with open(path, "wb") as f:
        w = Writer(f)
        w.start(profile="", library="exhand")
        w.add_metadata("exhand", {"scene": log.scene, "board": log.board,
                                  "period_s": repr(log.period_s), "log": log.path.name})
        of = w.register_schema(log.scene, "jsonschema", json.dumps(schema).encode())
        topic = w.register_channel("/" + log.scene, "json", of)
        for k, t in enumerate(times):
            row = {n: None if math.isnan(v[k]) else v[k] for n, v in columns.items()}
            w.add_message(topic, t, json.dumps(row).encode(), t, k)
        of = w.register_schema("event", "jsonschema", b'{"type":"object"}')
        topic = w.register_channel("/events", "json", of)
        for k, e in enumerate(log.events):
            t = round((start_s + e["tick"] * log.period_s) * 1e9)
            w.add_message(topic, t, json.dumps(e).encode(), t, k)
        w.finish()
    return len(times) + len(log.events)


def main() -> int:
    """The command."""
    parser = argparse.ArgumentParser(description="Writes a log as MCAP, for Foxglove, PlotJuggler.")
    parser.add_argument("log", help="of `exhand drop --out`, `run --log`, or a black box")
    parser.add_argument("out", nargs="?", help="LOG with .mcap, if it is not given")
    args = parser.parse_args()
    out = args.out or Path(args.log).with_suffix(".mcap")
    try:
        print("%s: %d messages" % (out, write(Log(args.log), out)))
    except ImportError:
        print("exhand-mcap: mcap is missing: pip install 'exhand[mcap]'", file=sys.stderr)
        return 3
    except (OSError, ValueError) as e:
        print("exhand-mcap: %s" % e, file=sys.stderr)
        return 2
    return 0


if __name__ == "__main__":
    sys.exit(main())
