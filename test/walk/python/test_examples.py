# SPDX-License-Identifier: MIT
"""examples/limiter/arm.py: without a limiter each incident does harm, with one none does."""
import csv
import re
import subprocess
import sys
from pathlib import Path

ARM = Path(__file__).parents[3] / "examples/limiter/arm.py"
WANTED = {"jump": "-", "stall": "stall", "nan": "not_a_number", "silent": "stale"}


def test_the_arm_and_its_leader(tmp_path):
    done = subprocess.run([sys.executable, ARM, "--out", tmp_path], capture_output=True, text=True)
    assert done.returncode == 0, done.stdout + done.stderr
    said = re.split(r"^(\w+) +highest.*\n", done.stdout, flags=re.M)[1:]
    rows = {name: [re.findall(r"[\d.]+(?= rad| Nm)|\S+$", line) for line in text.splitlines()]
            for name, text in zip(said[::2], said[1::2])}
    assert {name: row[1][3] for name, row in rows.items()} == WANTED
    for name, ((speed, torque, last, _), after) in rows.items():
        harm = {"jump": float(speed) > 10, "stall": float(last) > 4, "nan": float(torque) > 0.9,
                "silent": float(last) > 0.3}
        assert harm[name] and float(after[0]) <= max(float(speed), 2.2), name
        with open(tmp_path / (name + ".csv"), encoding="ascii") as f:
            table = list(csv.DictReader(f))
        assert len(table) == 4000
        if name in ("nan", "silent"):  # within its parameters in every step
            sent = [float(row["sent_after"]) for row in table]
            assert max(map(abs, sent)) <= 1.0
            assert max(abs(b - a) for a, b in zip(sent, sent[1:])) <= 0.041
