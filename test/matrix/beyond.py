#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""beyond.py DIR GOLDEN: 2001..20000 Hz of every module of test/golden/digests.inc by the program
GOLDEN, as many at a time as JOBS says. Compares the CRC over each module's 180 hundreds with the
generator's, writes DIR/beyond.tsv, ends with `N passed, N failed`. `make matrix-beyond`. Standard
library only.
"""

import concurrent.futures
import os
import re
import subprocess
import sys

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
sys.dont_write_bytecode = True
sys.path.insert(1, os.path.join(ROOT, "test", "golden"))
import digests  # noqa: E402


def expected(crcs):
    """(rates, CRC over the hundreds), as the program says."""
    crcs = crcs[len(digests.RATES) // digests.HUNDRED:]
    return len(crcs) * digests.HUNDRED, "%08x" % digests.together(crcs)


def ran(golden, module):
    """(rates, CRC) as the program says, and what else it said of what is wrong."""
    done = subprocess.run([golden], cwd=ROOT, stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
                          text=True, env=dict(os.environ, EXH_TEST=module, EXH_RATES="2001..20000",
                                              EXH_CELLS="1"))
    said = re.search(r"^  \| hundreds: %s (\d+) ([0-9a-f]{8})$" % module, done.stdout, re.M)
    return ((int(said.group(1)) * digests.HUNDRED, said.group(2)) if said and done.returncode == 0
            else (0, "-"), done.stdout)


def main():
    where, golden = sys.argv[1:3]
    kept = digests.committed()
    modules = sorted(kept)
    failed = cells = 0
    with open(os.path.join(where, "beyond.tsv"), "w") as out, \
            concurrent.futures.ThreadPoolExecutor(int(os.environ.get("JOBS") or "1")) as pool:
        for m, (got, said) in zip(modules, pool.map(lambda m: ran(golden, m), modules)):
            agree = got == expected(kept[m])
            failed += not agree
            cells += got[0] * agree
            out.write("%s\t%d\t%s\t%s\n" % (m, got[0], got[1], "agrees" if agree else "differs"))
            if not agree:
                print(said)
    print("%d cells of %d modules at 2001..20000 Hz agree" % (cells, len(modules) - failed))
    print("%d passed, %d failed" % (len(modules) - failed, failed))
    return 1 if failed or not modules else 0


if __name__ == "__main__":
    sys.exit(main())
