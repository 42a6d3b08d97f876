# SPDX-License-Identifier: MIT
"""Digests of the golden vectors: digests.inc, which is committed, and the table of single rates
that the host makes."""

import os
import re
import subprocess
import sys
import zlib
from struct import pack

HERE = os.path.dirname(os.path.abspath(__file__))
COMMITTED = os.path.join(HERE, "digests.inc")
TABLE = os.environ.get("EXH_DIGESTS") or os.path.join(HERE, "..", "..", "build", "golden",
                                                      "rates.txt")
HUNDRED = 100
RATES = range(1, 2001)
BEYOND = range(2001, 20001)
LINES = """/* SPDX-License-Identifier: MIT */
/* What the generator found: the CRC-32 of each hundred rates' digests. Made by golden.py. */
"""


def commits():
    """How many there are: what is dealt to landings goes by it."""
    said = subprocess.run(["git", "rev-list", "--count", "HEAD"], cwd=HERE, capture_output=True,
                          text=True).stdout.strip()
    return int(said) if said.isdigit() else 1


def together(digests):
    """The CRC-32 of digests, each as 32 bits, little-endian."""
    return zlib.crc32(pack("<%dI" % len(digests), *digests))


def hundreds(digests):
    """The CRC-32 of each hundred of these digests."""
    return [together(digests[i:i + HUNDRED]) for i in range(0, len(digests), HUNDRED)]


def committed():
    """{module: [CRC of each hundred]}"""
    try:
        with open(COMMITTED) as f:
            found = re.findall(r"digest_(\w+)\[\w+\] = \{(.*)\};", f.read())
    except OSError:
        found = []
    return {m: [int(w, 16) for w in crcs.split(",")] for m, crcs in found}


def commit(crcs):
    """Writes these; 1 if the file was another."""
    text = LINES + "".join("const uint32_t digest_%s[GOLDEN_HUNDREDS] = {%s};\n" %
                           (m, ", ".join("0x%08x" % c for c in crcs[m]))
                           for m in sorted(crcs))
    with open(COMMITTED, "a+") as f:
        f.seek(0)
        if f.read() == text:
            return 0
        f.seek(0)
        f.truncate()
        f.write(text)
    return 1


def singles():
    """{module: [digest of each rate]} from the host's table. A table that is not the committed
    hundreds' ends the program."""
    try:
        with open(TABLE) as f:
            table = {line.split()[0]: [int(w, 16) for w in line.split()[1:]] for line in f}
    except OSError as e:
        sys.exit("no digests of single rates (make golden-rates): %s" % e)
    wrong = [m for m, crcs in committed().items()
             if len(table.get(m, [])) != len(RATES) or
             hundreds(table[m]) != crcs[:len(RATES) // HUNDRED]]
    if wrong:
        sys.exit("%s is not what digests.inc says (make golden-rates): %s" %
                 (TABLE, " ".join(wrong)))
    return table
