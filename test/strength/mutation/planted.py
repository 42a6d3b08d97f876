#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Plants errors in the code that limits the force on a person, one at a time. The named test, a
unit test or a law, must detect each without any digest.

    planted.py --build DIR [--jobs N] [--some N] [--seed S] [GROUP...]

A row: source, a text in it, its replacement, the test, its case. Exit status 1 if the text is not
there exactly once, if the case fails without the error, or if it passes with it. The library is a
shared object (make mutation-built), and the changed source is preloaded. A source of lib/src/run is
in no library. There the test includes the source, and is compiled again.

--some N: every Nth, as the seed chooses them. The texts of all are checked.
"""

import argparse
import os
import random
import re
import subprocess
import sys
import tempfile
from concurrent.futures import ThreadPoolExecutor

sys.dont_write_bytecode = True
from mutation import CC, FLAGS, ROOT  # noqa: E402

CASES = "20000"
STUCK_S = 300

ROWS = {
    "ceiling": (
        ("act/gate", "par->person_A_q26 < par->i_peak_A_q26 ? par->person_A_q26 :", "",
         "unit/gate", "no_code_is_beyond_the_persons_ceiling"),
        ("act/gate", "par->person_A_q26 < par->i_peak_A_q26 ?",
         "par->person_A_q26 > par->i_peak_A_q26 ?", "prop/safety", "gate_holds_with_any_input"),
        ("act/gate", "(int64_t)top_A_q26 * par->dac_rawpA_q16 >>",
         "(((int64_t)top_A_q26 * par->dac_rawpA_q16) + (INT64_C(1) << 41)) >>", "prop/safety",
         "gate_holds_with_any_input"),
        ("act/drive", "cfg->f_top_N_q20 = cut ? par->person_N_q20 : end_N_q20;",
         "cfg->f_top_N_q20 = end_N_q20;", "unit/drive",
         "no_force_or_current_beyond_the_persons_ceiling"),
        ("act/drive", "own.f_max_N_q20 < cfg->f_top_N_q20 ? own.f_max_N_q20 : cfg->f_top_N_q20;",
         "own.f_max_N_q20;", "prop/drive", "force_ledger_sums_and_limits_hold"),
        ("act/drive", "const int32_t top = person ? cfg->i_top_A_q26 : drive;",
         "const int32_t top = drive;", "unit/drive",
         "no_force_or_current_beyond_the_persons_ceiling"),
        ("act/drive", "cfg->i_top_A_q26 = whole_codes(cfg, par->person_A_q26);",
         "cfg->i_top_A_q26 = par->person_A_q26;", "prop/drive",
         "current_ledger_sums_and_limits_hold"),
        ("act/drive", "exh_inside(par->person_N_q20, PERSON_MIN_N_Q20, EXH_FORCE_MAX_N_Q20) &&", "",
         "unit/drive", "setup_rejections"),
        ("act/drive", "exh_inside(par->person_A_q26, 0, I_PEAK_MAX_A_Q26) &&", "", "unit/drive",
         "setup_rejections"),
        ("act/drive", "{0x050C, EXH_Q_FORCE, EXH_WHEN_PERSON,",
         "{0x050C, EXH_Q_FORCE, EXH_WHEN_LIMIT,", "unit/rows", "rows_are_what_others_know"),
        ("num/params", "->when == EXH_WHEN_PERSON) { continue; }", "->when == 99) { continue; }",
         "unit/authority", "an_image_leaves_the_persons_values"),
    ),
    "authority": (
        ("num/authority", "[EXH_WHEN_SLEWED] = FALL,\n        [EXH_WHEN_LIMIT] = FALL,",
         "[EXH_WHEN_SLEWED] = FALL,\n        [EXH_WHEN_LIMIT] = ANY,", "unit/authority",
         "the_table"),
        ("num/authority", "[EXH_WHEN_PERSON] = SAME,", "[EXH_WHEN_PERSON] = REST,",
         "unit/authority", "the_table"),
        ("num/authority", "[EXH_WHEN_LIMIT] = NEVER,", "[EXH_WHEN_LIMIT] = FALL,",
         "unit/authority", "every_way_asks_the_table"),
        ("num/authority", "(cell == FALL && raw < was)", "(cell == FALL && raw != was)",
         "unit/authority", "every_way_asks_the_table"),
        ("num/authority", "(cell >= REST && !who.open)", "cell >= REST", "unit/authority",
         "the_table"),
        ("num/authority", "!who.locked ||", "1 ||", "unit/authority", "the_table"),
        ("num/authority", "when < EXH_WHENS ? may[who.source][when] : NEVER",
         "when < EXH_WHENS ? may[who.source][when] : ANY", "unit/authority", "the_table"),
        ("num/params", "who.locked = p->locked;", "", "unit/authority",
         "every_way_asks_the_table"),
        ("num/params", "p->by |= (uint8_t)(1u << (who.source & 7u));",
         "p->by = (uint8_t)(1u << (who.source & 7u));", "unit/authority",
         "who_staged_is_kept_until_it_is_applied"),
        ("talk/regs_stage", "r->locked, !exh_safety_is_at_rest(r->box.state)};",
         "r->locked, 0};", "unit/authority", "every_way_asks_the_table"),
        ("talk/regs_stage", "err = exh_params_validate_by(p, who, i, r->staged[i]);", "err = 0;",
         "unit/authority", "what_was_staged_is_judged_again"),
        ("talk/regs_stage", "if (!(r->may >> EXH_COIL_APPLY & 1u)) { return EXH_MODBUS_VALUE; }",
         "", "unit/authority", "without_apply_nothing_is_written"),
        ("talk/wire", "{EXH_FROM_WORLD, 1, open != 0};", "{EXH_FROM_PERSON, 1, open != 0};",
         "unit/authority", "every_way_asks_the_table"),
        ("talk/wire", "{EXH_FROM_WORLD, 1, open != 0};", "{EXH_FROM_WORLD, 1, 0};",
         "unit/authority", "every_way_asks_the_table"),
    ),
    "calibration": (
        ("bench/calibrate", "twice <= 3 * wanted", "twice <= 4 * wanted", "unit/calibrate",
         "near_is_within_half_of_kf"),
        ("bench/calibrate", "twice >= wanted &&", "twice > 0 &&", "unit/calibrate",
         "near_is_within_half_of_kf"),
        ("bench/calibrate", "if (!is_near(p->force_N_q20, p->mon_A_q26, kf_NpA_q20)) {",
         "if (0) {", "unit/calibrate", "near_is_within_half_of_kf"),
        ("bench/calibrate", "if (c->valid_days > EXH_CALIB_VALID_MAX_DAYS) {", "if (0) {",
         "unit/calibrate", "validity_has_a_ceiling"),
        ("bench/calibrate", "|| here->day - c->day > c->valid_days", "", "unit/calibrate",
         "another_device_and_stale_ones_are_refused"),
        ("bench/calibrate", "if (c->device_id != here->device_id) {", "if (0) {", "unit/calibrate",
         "another_device_and_stale_ones_are_refused"),
        ("run/calib_set", "if (k->images < 3) { return 0; }", "if (k->images < 6) { return 0; }",
         "unit/calib_set", "a_finger_far_from_the_others_is_refused"),
        ("run/calib_set", "return sorted[(k->images - 1) / 2];", "return sorted[0];",
         "unit/calib_set", "a_finger_far_from_the_others_is_refused"),
        ("run/calib_set", "par->far_allowed ? 0 : near(k, i, &now, of->kf_NpA_q20, 0);", "0;",
         "unit/calib_set", "a_finger_far_from_kf_is_refused"),
        ("run/calib_set", "t->vouches = par->uncalibrated ?", "t->vouches = 1 ?", "unit/calib_set",
         "without_an_image_nothing_vouches"),
        ("safe/polarity", "out < 0 ? EXH_POLARITY_SEEN : EXH_POLARITY_WRONG;",
         "EXH_POLARITY_SEEN;", "unit/polarity", "what_moves_is_what_is_told"),
        ("safe/polarity", "s->rest = moves ? 0 : s->rest + 1;", "s->rest = s->rest + 1;",
         "unit/polarity", "no_pull_before_it_was_at_rest"),
    ),
    "ramp": (
        ("safe/safety", "s->state == EXH_STATE_ARM ? s->share_q30 : FULL_Q30;",
         "s->state == EXH_STATE_ARM && s->share_q30 < FULL_Q30 / 2 ? s->share_q30 : FULL_Q30;",
         "unit/safety", "arming_takes_its_time_at_every_rate"),
        ("act/drive", "(int32_t)((int64_t)top * permit->share_q30 >> 30);",
         "permit->share_q30 > 1 << 29 ? top : (int32_t)((int64_t)top * permit->share_q30 >> 30);",
         "unit/drive", "ramp_is_a_share_all_the_way"),
        ("safe/safety", "(int64_t)s->share_q30 + cfg->ramp_q30, 0, FULL_Q30",
         "(int64_t)s->share_q30 + 2 * cfg->ramp_q30, 0, FULL_Q30", "unit/safety",
         "arming_takes_its_time_at_every_rate"),
        ("safe/safety", "s->steps >= cfg->arm_ticks && !waits", "s->steps >= cfg->arm_ticks",
         "unit/polarity", "the_ramp_waits_and_a_failed_pull_is_named"),
        ("safe/safety", "(s->limits & EXH_LIMIT_FORCE ? EXH_ARM_SMALL_FORCE : 0u);", "0u;",
         "unit/safety", "each_step_is_named_where_it_does_not_hold"),
        ("act/drive", "rises ? own.slew_up_Nps : cfg->par->slew_down_Nps",
         "rises ? own.slew_up_Nps : own.slew_up_Nps", "unit/drive", "slew_both_ways"),
        ("act/drive", "(held > end) == rises ? end : held;", "held;", "prop/drive",
         "force_ledger_sums_and_limits_hold"),
        ("act/drive", "s->fall_N_q20 = (int32_t)exh_gain_floor(permit->fall, s->force_N_q20) + 1;",
         "s->fall_N_q20 = s->force_N_q20 + 1;", "unit/drive", "release_is_bounded_and_ends"),
        ("num/params", "(left >> shift) + (", "left + 0 * (", "unit/params", "steps_worked_out"),
    ),
}


def source_of(row):
    return "lib/src/%s.c" % row[0]


class Bench:
    """Builds a changed source and runs a case of a test with it."""

    def __init__(self, build):
        self.build, self.well = os.path.abspath(build), {}

    def compile(self, where, text, row):
        name = os.path.basename(source_of(row))
        with open(os.path.join(where, name), "w", encoding="utf-8") as f:
            f.write(text)
        flags = [f if not f.startswith("-I") else "-I" + os.path.join(ROOT, f[2:]) for f in FLAGS]
        flags += ["-O1", "-I" + os.path.join(ROOT, os.path.dirname(source_of(row)))]
        if row[0].startswith("run/"):
            own = os.path.join(where, "own.c")
            with open(os.path.join(ROOT, "test/module", row[3] + "_test.c"),
                      encoding="utf-8") as f, open(own, "w", encoding="utf-8") as to:
                to.write(re.sub(r'"[./]*lib/src/\w+/(\w+\.c)"', r'"\1"', f.read()))
            made = CC + flags + ["-I" + os.path.join(ROOT, "test"), "-I" + where, own,
                                 self.build + "/obj/test/support.o", "-L" + self.build, "-lexhand",
                                 "-lcmocka", "-Wl,-rpath," + self.build, "-o", where + "/own"]
        else:
            made = CC + flags + ["-shared", os.path.join(where, name), "-o", where + "/m.so"]
        p = subprocess.run(made, cwd=where, capture_output=True, text=True)
        return p.stderr.strip().split("\n")[0] if p.returncode else ""

    def passes(self, where, row):
        """Whether the case does; None: there is no such case."""
        own = row[0].startswith("run/")
        env = {k: v for k, v in os.environ.items() if not k.startswith("EXH_")}
        env.update(EXH_SEED="1", EXH_CASES=CASES, EXH_TEST=row[4],
                   LD_PRELOAD="" if own else where + "/m.so")
        try:
            p = subprocess.run([where + "/own" if own else "%s/%s_test" % (self.build, row[3])],
                               cwd=ROOT, env=env, stdin=subprocess.DEVNULL, capture_output=True,
                               timeout=STUCK_S)
        except subprocess.TimeoutExpired:
            return False
        return None if p.returncode == 2 else p.returncode == 0

    def run(self, row, text):
        """(why it does not compile, whether the case passes) with that text of the source."""
        with tempfile.TemporaryDirectory(dir=self.build) as where:
            error = self.compile(where, text, row)
            return error, None if error else self.passes(where, row)

    def ask(self, row):
        """What is wrong with a row, '' if nothing is."""
        with open(os.path.join(ROOT, source_of(row)), encoding="utf-8") as f:
            text = f.read()
        if row[3:] not in self.well:
            self.well[row[3:]] = self.run(row, text)[1]
        error, passed = self.run(row, text.replace(row[1], row[2]))
        return ("no such case" if self.well[row[3:]] is None else
                "fails without the error, too" if not self.well[row[3:]] else
                "does not compile: " + error if error else "not told" if passed else "")


def unplantable(row):
    with open(os.path.join(ROOT, source_of(row)), encoding="utf-8") as f:
        n = f.read().count(row[1])
    return "" if n == 1 else "the text is there %d times: whoever changed it changes its row" % n


def main():
    p = argparse.ArgumentParser(description=__doc__,
                                formatter_class=argparse.RawDescriptionHelpFormatter)
    p.add_argument("--build", default="build/mutation")
    p.add_argument("--jobs", type=int, default=os.cpu_count())
    p.add_argument("--some", type=int, default=1, metavar="N")
    p.add_argument("--seed", type=int, default=1, metavar="S")
    p.add_argument("group", nargs="*")
    a = p.parse_args()
    rows = [(g, row) for g, all_ in ROWS.items() for row in all_]
    wrong = [(g, row, unplantable(row)) for g, row in rows if unplantable(row)]
    dealt = [r for r in rows if not a.group or r[0] in a.group]
    random.Random(a.seed).shuffle(dealt)
    dealt = [r for r in dealt[::a.some] if not unplantable(r[1])]
    bench = Bench(a.build)
    with ThreadPoolExecutor(a.jobs) as pool:
        for (g, row), said in zip(dealt, pool.map(lambda r: bench.ask(r[1]), dealt)):
            if said:
                wrong.append((g, row, said))
    for g, row, said in wrong:
        print("%s: %s: %s -> %s: %s, %s: %s" % (g, source_of(row), row[1], row[2] or "nothing",
                                                 row[3], row[4], said))
    print("planted: %d of %d errors, %d wrong; %s" %
          (len(dealt), len(rows), len(wrong),
           ", ".join("%s %d" % (g, len(all_)) for g, all_ in ROWS.items())))
    return 1 if wrong or not dealt else 0


if __name__ == "__main__":
    sys.exit(main())
