#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Runs every module of test/golden/digests.inc at 2001..20000 Hz: beyond.py DIR GOLDEN [N].
GOLDEN is the program. JOBS modules run at a time, all 180 hundreds of each (`make matrix-beyond`),
or N hundreds, drawn anew for each module (`make golden-beyond`; EXH_SEED repeats a draw). Compares
the CRC over a module's hundreds with the generator's, writes DIR/beyond.tsv, ends with `N passed, N
failed`. Standard library only.
"""

import concurrent.futures
import os
import random
import re
import subprocess
import sys

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
sys.dont_write_bytecode = True
sys.path.insert(1, os.path.join(ROOT, "test", "golden"))
import digests  # noqa: E402

FIRSTS = digests.BEYOND[::digests.HUNDRED]


def drawn(module, count, seed):
    """Which hundreds: each module has others, so that one rate is seen by some module more often
    than by one of them."""
    if count >= len(FIRSTS):
        return list(FIRSTS)
    return sorted(random.Random("%d %s" % (seed, module)).sample(FIRSTS, count))


def expected(crcs, firsts):
    """(rates, CRC over these hundreds), as the program says."""
    crcs = [crcs[first // digests.HUNDRED] for first in firsts]
    return len(crcs) * digests.HUNDRED, "%08x" % digests.together(crcs)


def ran(golden, module, firsts):
    """(rates, CRC) as the program says, and what else it said of what is wrong."""
    env = dict(os.environ, EXH_TEST=module, EXH_RATES="2001..20000", EXH_CELLS="1",
               EXH_HUNDREDS=",".join("%d" % f for f in firsts))
    done = subprocess.run([golden], cwd=ROOT, stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
                          text=True, env=env)
    said = re.search(r"^  \| hundreds: %s (\d+) ([0-9a-f]{8})$" % module, done.stdout, re.M)
    return ((int(said.group(1)) * digests.HUNDRED, said.group(2)) if said and done.returncode == 0
            else (0, "-"), done.stdout)


def main():
    where, golden = sys.argv[1:3]
    count = int(sys.argv[3]) if len(sys.argv) > 3 else len(FIRSTS)
    seed = int(os.environ.get("EXH_SEED") or random.SystemRandom().randrange(1, 10**6))
    kept = digests.committed()
    modules = sorted(kept)
    jobs = [(m, drawn(m, count, seed)) for m in modules]
    if count < len(FIRSTS):
        print("%d of %d hundreds of each module, drawn: EXH_SEED=%d repeats them" %
              (count, len(FIRSTS), seed), flush=True)
    failed = cells = 0
    with open(os.path.join(where, "beyond.tsv"), "w") as out, \
            concurrent.futures.ThreadPoolExecutor(int(os.environ.get("JOBS") or "1")) as pool:
        for (m, firsts), (got, said) in zip(jobs, pool.map(lambda j: ran(golden, *j), jobs)):
            agree = got == expected(kept[m], firsts)
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
