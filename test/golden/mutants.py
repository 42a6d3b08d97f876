#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Mutants: small changes of the library that the golden vectors must notice.

Each row names a module, a source, a text in it and its replacement. The changed source is compiled
and linked with the test's objects, and the module is run at every rate. The share of rates whose
digest differs is printed. Exit status 1: a share below 95 % (rows of THIN: below the number there),
or a build that fails. Exit status 2: a text that is not in its source, in any row.

    mutants.py [--some N] [--seed S] [MODULE...]

B, CC: where the test was built (build), the compiler (cc).
--some N: every Nth mutant of each module, and one at least, at a fifth of the rates. The seed
chooses them. Without --seed it is made of the commits, so that each commit has others.
"""

import argparse
import glob
import os
import random
import re
import shutil
import subprocess
import sys
import tempfile
from concurrent.futures import ThreadPoolExecutor

sys.dont_write_bytecode = True
from digests import commits, singles  # noqa: E402

ROOT = os.path.normpath(os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", ".."))
B, CC = os.environ.get("B", "build"), os.environ.get("CC", "cc").split()
LEAST = 0.95
# With --some: a fifth of the rates, of which the share may be less by so much. All mutants keep to
# it.
FIFTH, SLACK = "3..2000:5", 0.03
FLAGS = "-std=c99 -O1 -w -Ilib/include -Iexamples -Itest -D_POSIX_C_SOURCE=200809L".split()

L, H, X, Y = "lib/src/", "lib/include/exhand/", "examples/drop/", "examples/bilateral/"
VELOCITY, QUAD, DRIVE, SAFETY = (L + "sense/velocity.c", L + "sense/quad.c", L + "act/drive.c",
                                 L + "safe/safety.c")
TRACK, WATCH, GATE, TABLE = (L + "act/tracking.c", L + "safe/motion.c", L + "act/gate.c",
                             L + "act/table.c")
PASSIVITY, GAINS, CHATTER = (L + "law/passivity.c", L + "law/gains.c", L + "safe/chatter.c")

# module, source, text, its replacement. A changed header is compiled into the module's run, which
# is where its inline functions are.
MUTANTS = (
    ("fix", L + "num/fix.c", "if (rem >= den - rem) { mant++; }", ""),
    ("fix", L + "num/fix.c", "if (r >= den) {\n            r", "if (r > den) {\n            r"),
    ("fix", H + "fix.h", "((v >> (n - 1)) & 1)", "0"),
    ("fix", H + "fix.h", "(lo + (INT64_C(1) << 30)) >> 31", "lo >> 31"),
    ("fix", H + "fix.h", "return INT32_MIN;", "return -INT32_MAX;"),
    ("fix", L + "num/fix.c", "UINT64_C(1001) * T.den", "UINT64_C(1000) * T.den"),
    ("bytes", L + "num/bytes.c", "n <= c->cap - at", "n < c->cap - at"),
    ("bytes", L + "num/crc.c", "crc ^= *p;\n        crc = crc >> 4 ^ nibble[crc & 15];",
     "crc ^= *p;\n        crc = crc >> 4 ^ nibble[crc & 7];"),
    ("bytes", L + "num/bytes.c", "(int32_t)u - 0x10000", "(int32_t)u - 0xFFFF"),
    ("mac", L + "talk/mac.c", "TURN(v.d, 21)", "TURN(v.d, 20)"),
    ("mac", L + "talk/mac.c", "v.c ^= 0xFF;", ""),
    ("mac", L + "talk/mac.c", "(uint8_t)(len_B & 0xFF)", "0"),
    ("record", L + "talk/record.c", "len_B < end + 4", "len_B < end"),
    ("record", L + "talk/record.c", "if (crc != exh_crc32(0, p, end))", "if (0)"),
    ("record", L + "talk/record.c", "r->version != EXH_RECORD_VERSION", "0"),
    ("record", L + "talk/record.c", "#define LEN_AT 4u", "#define LEN_AT 6u"),
    ("ring", L + "talk/ring.c", "need >= r->cap_B - used(r)", "need > r->cap_B - used(r)"),
    ("ring", L + "talk/ring.c", "need >= r->cap_B ||", "need > r->cap_B ||"),
    ("ring", L + "talk/ring.c", "len_B > UINT16_MAX ||", "(len = (uint16_t)(len & 7)) > 7 ||"),
    ("ring", L + "talk/ring.c", ">= r->cap_B / EXH_RING_PARTS;", "> r->cap_B / EXH_RING_PARTS;"),
    ("ring", L + "talk/ring.c", "    if (parts(r) == 0 && !begins) { return lose(r); } /*", "/*"),
    ("ring", L + "talk/ring.c", "r->lost += r->lost < UINT32_MAX;", ""),
    ("ring", L + "talk/ring.c", "return at < r->cap_B ? at : at - r->cap_B;",
     "return at <= r->cap_B ? at : at - r->cap_B;"),
    ("ring", L + "talk/ring.c", "payload.len_B > p->left_B - EXH_RING_HEAD_B",
     "payload.len_B >= p->left_B - EXH_RING_HEAD_B"),
    ("ring", L + "talk/ring.c", "o->crc >> 8 * (from + i)", "o->crc >> 8 * i"),
    ("ring", L + "talk/ring.c", "cap_B < EXH_RING_MIN_B ||", "cap_B <= EXH_RING_MIN_B ||"),
    ("slots", L + "talk/slots.c", "u32_at(p, end + 4) != sequence ||", ""),
    ("slots", L + "talk/slots.c", "sequence == 0 || ", ""),
    ("slots", L + "talk/slots.c", "- 1 < 0x7FFFFFFFu", "< 0x80000000u"),
    ("slots", L + "talk/slots.c", "newest.sequence == SEQUENCE_LAST ? 1 : newest.sequence + 1",
     "newest.sequence + 1"),
    ("slots", L + "talk/slots.c", "newest.len_B == len_B && ", ""),
    ("slots", L + "talk/slots.c", "len_B > slot_B - EXH_SLOT_B(0)",
     "len_B >= slot_B - EXH_SLOT_B(0)"),
    ("signal", L + "num/signal.c", "exh_bytes_u8(&c, &row.when);", ""),
    ("signal", L + "num/params.c", "raw < row->min ||", "raw <= row->min ||"),
    ("signal", L + "num/params.c", "(left >> shift) + ((", "(left >> shift) + (0 * ("),
    # taken <= time: the two are the same at few rates; unit/params detects it.
    ("signal", L + "num/params.c", "if (p->locked && exh_signal_is_slewed(row)) {",
     "if (exh_signal_is_slewed(row)) {"),
    ("signal", L + "num/params.c", "falls ? 0 : p->shift & 31u", "p->shift & 31u"),
    ("signal", L + "num/params.c", "p->staged[i] < p->active[i];", "p->staged[i] > p->active[i];"),
    ("signal", L + "num/params.c", "p->moving |= p->active[i] != p->staged[i];",
     "p->moving |= p->active[i] > p->staged[i];"),
    ("signal", L + "num/params.c", "p->passed += i < p->at ? more : 0;",
     "p->passed += i <= p->at ? more : 0;"),
    ("signal", L + "num/params.c", "    p->sum += more;", ""),
    ("signal", L + "num/params.c", "wanted = p->staged[i];", "wanted = p->active[i];"),
    ("quad", QUAD, "moved > cfg->jump_cnt ||", "moved >= cfg->jump_cnt ||"),
    ("quad", QUAD, "<< (cfg->unused & 31)) >> (cfg->unused & 31)", ")"),
    ("quad", QUAD, "exh_sat32(exh_mul_shr(cnt,", "(int32_t)(exh_mul_shr(cnt,"),
    ("quad", QUAD, "par->speed_max_mps_q27) + 1;", "par->speed_max_mps_q27);"),
    ("quad_ab", QUAD, "{0, EDGE, EDGE, ILL, EDGE, 0, ILL, UP,",
     "{0, EDGE, EDGE, ILL, UP, 0, ILL, EDGE,"),
    ("quad_ab", QUAD, "{0, EDGE, DOWN, ILL,", "{0, EDGE, UP, ILL,"),
    ("quad_ab", QUAD, "(was_a ^ b)", "(a ^ b)"),
    ("quad_ab", QUAD, "now > s->level", "now >= s->level"),
    ("velocity_window", VELOCITY, "return exh_sat32(exh_gain_mul(cfg->gain, moved));",
     "return (int32_t)exh_gain_mul(cfg->gain, moved);"),
    ("velocity_window", VELOCITY, "(cfg->n - 1u)", "(EXH_VELOCITY_N - 1u)"),
    ("velocity_window", H + "fix.h", "(g.shift & 63u), 1) >> 1", "(g.shift & 63u), 0) >> 1"),
    ("velocity_pole", VELOCITY, "exh_shr_round(s->v_mps_q55, 28)", "(s->v_mps_q55 >> 28)"),
    ("velocity_pole", VELOCITY,
     "s->started ? exh_wrap_diff(cnt, s->cnt) : 0;\n    const int64_t diff_q55",
     "exh_wrap_diff(cnt, s->cnt);\n    const int64_t diff_q55"),
    ("velocity_pole", VELOCITY, "(int64_t)exh_sat32(exh_gain_mul(cfg->gain, moved)) *",
     "exh_gain_mul(cfg->gain, moved) *"),
    ("velocity_foaw", VELOCITY, "(n + 1) * d - sum;", "(n + 1) * d + sum;"),
    ("velocity_foaw", VELOCITY, "longest < s->have ? longest : s->have", "longest"),
    ("velocity_foaw", VELOCITY, "slope < lo || slope > hi", "slope < lo"),
    ("velocity_track", VELOCITY, "exh_clamp(moved, -(INT32_C(1) << 28), INT32_C(1) << 28)",
     "(int64_t)moved"),
    ("velocity_track", VELOCITY, "2 * (int64_t)a_q31 - cfg->beta_q31",
     "2 * (int64_t)a_q31 - cfg->beta_q31 - 1"),
    ("velocity_track", VELOCITY, "s->err_cnt_q32 = off - exh_mul64_q31(off, cfg->alpha_q31);",
     "s->err_cnt_q32 = off - (off >> 31) * cfg->alpha_q31;"),
    ("contact", H + "contact.h", "(uint32_t)turn - (uint32_t)pos > band",
     "(uint32_t)turn - (uint32_t)pos >= band"),
    ("contact", H + "contact.h", " & -(int32_t)s->touching;", ";"),
    ("contact", H + "contact.h", "= par->hyst_m_q30 & -", "= (par->hyst_m_q30 + 1) & -"),
    ("contact", L + "law/contact.c", "exh_diff_sat32(pos_m_q30, lim_m_q30)",
     "exh_wrap_diff(pos_m_q30, lim_m_q30)"),
    ("table", TABLE, "exh_clamp32(x, k->x, last->x);", "exh_clamp32(x, k->x, last->x - 1);"),
    ("table", TABLE, "(in >= k[half].x)", "(in > k[half].x + 1)"),
    ("table", H + "fix.h", "(g.shift & 63u), 1) >> 1", "(g.shift & 63u), 0) >> 1"),
    ("drive", DRIVE, "(held > end) == rises ? end : held", "(held < end) == rises ? end : held"),
    ("drive", DRIVE, ">> cfg->i2t_shift >> 2;", ">> cfg->i2t_shift >> 1;"),
    ("drive", DRIVE, "heat < 0 ? 0 :", ""),
    ("drive", DRIVE, "const int32_t allowed = i2t_limit(s, cfg);",
     "const int32_t allowed = cfg->par->i_peak_A_q26;"),
    ("drive", DRIVE, "hot = warm ? whole_codes(cfg, allowed) :", "hot = warm ? allowed :"),
    ("drive", DRIVE, "cfg->i_whole_A_q26 = whole_codes(cfg, par->i_peak_A_q26);",
     "cfg->i_whole_A_q26 = par->i_peak_A_q26;"),
    ("drive", DRIVE, "cfg->i2t_budget_q32 >> 1) {", "cfg->i2t_budget_q32) {"),
    ("drive", DRIVE, "coded(cfg, now) >>", "now >>"),
    ("drive", DRIVE, "cfg->f_top_N_q20 = cut ?", "cfg->f_top_N_q20 = 0 ?"),
    ("drive", DRIVE, "top = person ? cfg->i_top_A_q26 : drive;", "top = drive;"),
    ("safety", GATE, "par->person_A_q26 < par->i_peak_A_q26 ?", "0 ?"),
    ("drive", DRIVE, "exh_wrap_diff64(held, asked);", "exh_wrap_diff64(asked, held);"),
    ("drive", DRIVE, "permit->fall, s->force_N_q20) + 1;", "permit->fall, s->force_N_q20);"),
    ("drive", DRIVE, "if (s->fall_N_q20 == 0) {", "{"),
    ("drive", DRIVE, "rest = s->force_N_q20 - (int64_t)permit->ticks * s->fall_N_q20;",
     "rest = s->force_N_q20 - (int64_t)s->fall_N_q20;"),
    ("drive", DRIVE, "top * permit->share_q30 >> 30", "top"),
    ("drive", DRIVE, "    s->fall_N_q20 = 0;\n    return limits;", "    return limits;"),
    ("drive", DRIVE, "law_N_q20 > small_N_q20 ?", "0 ?"),
    ("drive", DRIVE, "most < top && asked > most", "most < top"),
    ("passivity", PASSIVITY, "cfg->share, x) + 1;", "cfg->share, x);"),
    ("passivity", PASSIVITY, "moved_cnt < 0 ? most : least", "held"),
    ("passivity", PASSIVITY, "(!touching || !s->touching) && (e > 0 || late == 0)",
     "!touching && !s->touching"),
    ("passivity", PASSIVITY, "(e > 0 || late == 0)", "1"),
    ("passivity", PASSIVITY, "speed_mps_q27) + 1;", "speed_mps_q27) + 2;"),
    ("passivity", PASSIVITY, "f->force_N_q20 > f->pullback_N_q20;", "1;"),
    ("passivity", PASSIVITY, "coded_A_q26) - f->pullback_N_q20;", "coded_A_q26);"),
    ("passivity", PASSIVITY, "par->on == LATE ? before", "par->on >= 1 ? before"),
    ("gains", GAINS, "area(at.k, k0, b1, b0) <=", "area(at.k, k0, b1, b0) <"),
    ("gains", GAINS, "return under && at.k >= rule", "return under && at.k > rule"),
    ("gains", GAINS, "(off < 0 ? -off : off) * 100", "off * 100"),
    ("gains", GAINS, "    (void)exh_params_stage_at(p, i, was);", ""),
    ("gains", GAINS, "    p->pending = pending;", ""),
    ("gains", GAINS, "straight &= at.b < goal.b ? line <= knot : line >= knot",
     "straight &= at.b < goal.b ? line < knot : line > knot"),
    ("gains", GAINS, "return straight ? goal.k : low", "return goal.k"),
    ("gains", GAINS, "    if (is_under(rule, next)) { return next; }", "    return next;"),
    ("gains", GAINS, "    if (next.k < at.k) {", "    if (next.k > at.k) {"),
    ("gains", GAINS, "at.k <= rule->k_min_Npm_q10", "at.k < rule->k_min_Npm_q10"),
    ("gains", GAINS, "    goal.k = rule->k_min_Npm_q10;", ""),
    ("gains", GAINS, "return ends <= 1", "return ends <= 2"),
    ("gains", GAINS, "    if (shift == 0) { return goal; }", ""),
    ("track", TRACK, "1 + LATE_TICKS;", "LATE_TICKS;"),
    ("track", TRACK, "mon_A_q26 >= lowest", "mon_A_q26 > lowest"),
    ("track", TRACK, "mon_A_q26 <= highest", "mon_A_q26 < highest"),
    ("track", TRACK, "s->off_ticks >= cfg->ticks;", "s->off_ticks + 1 >= cfg->ticks;"),
    ("track", TRACK, "anew || coded_A_q26 < s->lo_A_q26", "coded_A_q26 < s->lo_A_q26"),
    ("watch", WATCH, "exh_clamp32(*vel_mps_q27, -most, most)",
     "exh_clamp32(*vel_mps_q27, 0, most)"),
    ("watch", WATCH, "s->fast_ticks >= cfg->speed_ticks)", "s->fast_ticks > cfg->speed_ticks)"),
    ("watch", WATCH, "return !on ? 0 :", "return !on ? ticks :"),
    ("watch", WATCH, "    s->cnt = cnt;", ""),
    ("watch", WATCH, "exh_ticks_in(ms, T) + 1;", "exh_ticks_in(ms, T) + 2;"),
    ("limiter", L + "safe/limiter_state.c", "(EXH_LIMITER_FULL_Q30 - 1)) + cfg->ramp_q30",
     "(EXH_LIMITER_FULL_Q30 - 1)) + cfg->ramp_q30 + 1"),
    ("limiter", L + "safe/limiter_setup.c", "return -1 - (int)k;", "return -2 - (int)k;"),
    ("chatter", CHATTER, "s->net_Acnt_q20 >= cfg->energy_Acnt_q20", "s->net_Acnt_q20 > 0"),
    ("chatter", CHATTER, "back > SWING_A_Q26", "back > SWING_A_Q26 / 2"),
    ("chatter", CHATTER, "return turns && s->rises;", "return turns;"),
    ("chatter", CHATTER, "left & ~(left >> 63)", "left"),
    ("chatter", CHATTER, "s->ticks < cfg->ticks", "s->ticks <= cfg->ticks"),
    ("chatter", CHATTER, "turns || back < 0", "turns"),
    ("guard", L + "safe/integrity.c", "if (g->crc != g->want) {", "if (g->crc > g->want) {"),
    ("guard", L + "safe/integrity.c", "    g->at = g->crc = 0;\n}", "    g->at = 0;\n}"),
    ("guard", L + "num/params.c", "!p->pending && !p->moving;", "!p->moving;"),
    ("guard", L + "num/params.c", "!p->pending && !p->moving;", "!p->pending;"),
    ("guard", L + "num/params.c", "bad |= p->passed != p->sum;", ""),
    ("guard", H + "integrity.h", "EXH_INTEGRITY_WORDS 2", "EXH_INTEGRITY_WORDS 1"),
    ("supply", L + "act/supply.c", "raw <= cfg->max_raw", "raw < cfg->max_raw"),
    ("supply", L + "act/supply.c", "raw >= cfg->min_raw", "raw > cfg->min_raw"),
    ("supply", L + "act/supply.c", "least += rest != 0;", ""),
    ("supply", L + "act/supply.c", "most >= INT16_MAX ||", "most > UINT16_MAX ||"),
    ("supply", L + "act/supply.c", "missed < left ?", "1 ?"),
    ("supply", L + "act/supply.c", "exh_ticks_in(par->time_ms, T) + 1",
     "exh_ticks_in(par->time_ms, T)"),
    ("safety", SAFETY, "k <= MISSED_MAX", "k < MISSED_MAX"),
    ("safety", SAFETY, "s->faults |= now;", "s->faults = now;"),
    ("safety", SAFETY, "if (s->faults == 0 && now != 0) {", "if (now != 0) {"),
    ("safety", SAFETY, "s->present == EXH_FAULT_DEADMAN && !", "!"),
    ("safety", SAFETY, "s->steps >= cfg->arm_ticks", "s->steps > cfg->arm_ticks"),
    ("safety", SAFETY, "p.ticks = add_sat(missed, 1);", "p.ticks = 1;"),
    ("safety", L + "safe/safety_open.c", "(s->state == EXH_STATE_ARM && s->share_q30 > 0)",
     "s->state == EXH_STATE_ARM"),
    ("safety", GATE, "asked, -span, span", "asked, 0, span"),
    ("safety", GATE, "exh_clamp(peak, 0, most)", "most"),
    ("safety", GATE, "    s->limits = 0;", ""),
    ("safety", GATE, "falls ? s->off_raw[k] : UINT16_MAX", "UINT16_MAX"),
    ("calibrate", L + "bench/calibrate.c", "rem >= m->n - rem", "rem > m->n - rem"),
    ("calibrate", L + "bench/calibrate.c", "(int32_t)more);", "(int32_t)more - 1);"),
    ("calibrate", L + "bench/calibrate.c", "knot[half - 1 - i].y = -y;",
     "knot[half - 1 - i].y = 1 - y;"),
    ("probe", L + "bench/probe.c", "rises && s->settled &&", "rises &&"),
    ("probe", L + "bench/probe.c", "if (cfg->step_A_q26 < 0 || -out < cfg->move_cnt)", "if (1)"),
    ("probe", L + "bench/probe.c", "s->cur_A_q26 = exh_clamp(next, 0,",
     "s->cur_A_q26 = exh_clamp(next + 1, 0,"),
    ("home", L + "bench/probe.c", "far < cfg->least_cnt ? EXH", "far < cfg->move_cnt ? EXH"),
    ("home", L + "bench/probe.c", "if (s->result != EXH_PROBE_BUSY) { s->cur_A_q26 = 0; }", ""),
    ("home", L + "bench/probe.c", "s->home_cnt = cnt;\n        s->dwell_cnt = cnt;",
     "s->home_cnt = cnt;"),
    ("weigh", L + "bench/weigh.c", "s->probe.start_cnt = start_cnt;", ""),
    ("weigh", L + "bench/weigh.c", "(s->lift_A_q26 + at_A_q26) >> 1",
     "(s->lift_A_q26 + at_A_q26 + 2) >> 1"),
    ("weigh", L + "bench/weigh.c", "s->coded = s->mon = (struct exh_mean){0, 0};", ""),
    ("filter", L + "sense/filter_low.c", "(int64_t)high_word(p) * c",
     "(int64_t)high_word(s->vel) * c"),
    ("filter", L + "sense/filter_high.c", "<< Q | HALF;", "<< Q;"),
    ("filter", L + "sense/filter.c", "cfg->b = coefficient(b, n, 31);",
     "cfg->b = coefficient(b, n, 31) - 1;"),
    ("filter", L + "sense/filter.c", "{ s[i].vel = 0; }", "{ }"),
    ("filter", L + "sense/filter.c", "to->a >= from->a", "1"),
    ("filter_cheap", L + "sense/filter_cheap.c", "times(word(s->vel), a)",
     "times(word(s->vel), a) + 1"),
    ("filter_cheap", L + "sense/filter_cheap.c", "& (to ^ at)) < 0", "& (to ^ v)) < 0"),
    ("filter_cheap", L + "sense/filter_cheap.c", "s->in2 = s->in1;", "s->in2 = x;"),
    ("filter_cheap", L + "sense/filter_cheap.c", "exh_real_of(9)", "exh_real_of(8)"),
    ("quantizer", L + "sense/quantizer_tick.h", "off > cfg->keep", "off >= cfg->keep"),
    ("quantizer", L + "sense/quantizer_tick.h", "(uint32_t)(x < most ? x : most)", "(uint32_t)x"),
    ("quantizer", L + "sense/quantizer.c", "(uint32_t)par->hyst_raw_q16 / 2",
     "(uint32_t)par->hyst_raw_q16 / 4"),
    ("glove", L + "sense/glove.c", "(int64_t)s->low_raw - margin, par->low_raw + 1",
     "(int64_t)s->low_raw, par->low_raw + 1"),
    ("glove", L + "sense/glove.c", "s->run[i] + 1 < cfg->debounce_frames",
     "s->run[i] < cfg->debounce_frames"),
    ("glove", L + "sense/glove.c", "exh_wrap_diff(code >> 1, cal->zero_raw_q15)",
     "code / 2 - cal->zero_raw_q15 + 1"),
    ("glove", L + "sense/glove.c", "angle_turn_q32[i] = exh_sat32(sum);",
     "angle_turn_q32[i] = (int32_t)sum;"),
    ("glove_cal", L + "sense/glove_cal.c", "day - cal->day > cal->valid_days",
     "day - cal->day > 2 * cal->valid_days"),
    ("glove_cal", L + "sense/glove_cal.c", "size < GAIN_MIN_TURNPRAW_Q38 ||", "size == 0 ||"),
    ("glove_cal", L + "sense/glove_cal.c", "cal->sensor[of].of[0] != EXH_GLOVE_NONE ||", ""),
    ("glove_cal", L + "sense/glove_cal.c", "s->zero_raw_q15 >= ZERO_END_RAW_Q15", "0"),
    ("angle", L + "num/sincos.h", "(-693597423)", "(-693597424)"),
    ("angle", L + "num/sincos.h", "odd - (v_q31 ^ odd)", "-(v_q31 ^ odd)"),
    ("angle", L + "num/sincos.h", "top_mask((x + EIGHTH) << 1)", "top_mask(x << 1)"),
    ("hand", L + "sense/hand.c", " + (INT32_C(1) << 23);", ";"),
    ("hand", L + "sense/hand.c", "v_m_q34.z, 32) + 3)", "v_m_q34.z, 32) + 2)"),
    ("hand", L + "sense/hand.c", "+ den / 2, den", ", den"),
    ("hand", L + "sense/hand.c", "sensor == bent[1] || sensor == bent[2]", "sensor == bent[1]"),
    ("hand", L + "sense/hand.c", "exh_clamp32(want, j->lo_turn_q32, j->hi_turn_q32)", "want"),
    ("precontact", L + "law/precontact.c", "+ HALF_Q60, cfg", ", cfg"),
    ("precontact", L + "law/precontact.c", "par->printed_sign ? -pad_m_q30 : pad_m_q30",
     "pad_m_q30"),
    ("precontact", L + "law/precontact.c", "<= 2 * tol_q60", "<= 4 * tol_q60"),
    ("precontact", L + "law/precontact.c", "left == 0 || now.object != s->newest.object",
     "left == 0"),
    ("precontact", L + "law/precontact.c", "!is_same(&now, &s->held)",
     "!is_same(&now, &s->newest)"),
    ("precontact", L + "law/precontact.c", "if (in->touching || (s->d", "if ((s->d"),
    ("precontact", L + "law/precontact.c", "(int64_t)cfg->par->d_lim_m_q30) - cfg->par->hyst_m_q30",
     "(int64_t)cfg->par->d_lim_m_q30)"),
    ("precontact", L + "law/precontact.c", "s->phase == EXH_PRECONTACT_TRACK && !s->near",
     "s->phase == EXH_PRECONTACT_TRACK"),
    ("precontact", L + "law/precontact.c", "s->phase == EXH_PRECONTACT_IDLE && s->met",
     "s->phase == EXH_PRECONTACT_IDLE"),
    ("precontact", L + "law/precontact.c", "(int64_t)s->ahead_m_q30 - par->d_lim_m_q30", "0"),
    ("precontact", L + "law/precontact.c", "s->near ? 0 : (int64_t)", "(int64_t)"),
    ("precontact", L + "law/precontact.c", "if (left == 0 || blind) {",
     "if (s->left_ticks == 0 || blind) {"),
    ("precontact", L + "law/precontact.c", "if (left == 0 || blind) {", "if (left == 0) {"),
    ("precontact", L + "law/precontact.c", "free_m_q30 - cfg->par->doubt_m_q30", "free_m_q30"),
    ("precontact", L + "law/precontact.c", "s->doubt_ticks <= cfg->doubt_ticks",
     "s->doubt_ticks < cfg->doubt_ticks"),
    ("precontact", L + "law/precontact.c", "in->tip_age_ticks >= cfg->tip_ticks",
     "in->tip_age_ticks > cfg->tip_ticks"),
    ("precontact", L + "law/precontact.c", "missed < s->left_ticks ? missed : s->left_ticks;",
     "0;"),
    ("precontact", H + "fix.h", "(12 - shift)) + 1) >> 1", "(12 - shift))) >> 1"),
    ("precontact", L + "law/advise.c", "return quot + (rem > 0);", "return quot;"),
    ("precontact", L + "law/advise.c", "age_ns + tick_ns", "age_ns"),
    ("wire", L + "talk/wire.c", "h->seq - rx->seq - 1u < EXH_WIRE_AHEAD",
     "h->seq - rx->seq < EXH_WIRE_AHEAD"),
    ("wire", L + "talk/wire.c", "late > UINT32_C(0x80000000)", "late >= UINT32_C(0x80000000)"),
    ("wire", L + "talk/wire.c", "rx->open && h->seq != rx->seq", "0"),
    ("wire", L + "talk/wire.c", "rx->open || rx->session == 0", "rx->session == 0"),
    ("wire", L + "talk/wire.c", "rx->quiet_us >= limit_us", "rx->quiet_us > limit_us"),
    ("wire", L + "talk/wire.c", " && s->state <= EXH_STATE_FAULT", ""),
    ("wire", L + "talk/wire.c", "late >= WINDOW", "late >= WINDOW - 1"),
    ("wire", L + "talk/wire.c", "rx->missing--;", ""),
    ("wire", L + "talk/wire.c", "rx->seen = UINT64_MAX;", "rx->seen = 1;"),
    ("wire", L + "talk/wire.c", "h->session == rx->former", "0"),
    ("wire", L + "talk/wire.c", "h->session == 0 ||", ""),
    ("wire", L + "talk/wire.c", "h->version != EXH_WIRE_VERSION", "0"),
    ("wire", L + "talk/wire.c", "if (s->plane[f].kind > most) { return 0; }", ""),
    ("wire", L + "talk/wire.c", "s->fingers >> f & 1 ?", "1 ?"),
    ("wire", L + "talk/wire.c", "(len_B != whole_B && len_B != whole_B + EXH_WIRE_SEAL_B)",
     "(len_B < whole_B)"),
    ("wire", L + "talk/wire.c", "(int16_t)result, p->seq", "(int16_t)result, p->stamp_us"),
    ("wire", L + "talk/wire.c", "t->frames <= EXH_WIRE_FRAMES && ", ""),
    ("wire", L + "talk/wire.c", "(t->result == 0 || t->frames == 0)", "1"),
    ("bilateral", Y + "trace.c", "if (t->result < 0 || !same(", "if (1 || !same("),
    ("bilateral", Y + "trace.c", "if (err < 0) { bilateral_trace_stop(t); }", ""),
    ("bilateral", Y + "trace.c", "!t->answer && n < EXH_WIRE_FRAMES",
     "!t->answer && n <= EXH_WIRE_FRAMES"),
    ("bilateral", Y + "wire.c", "bilateral_trace_stop(&w->trace);", ""),
    ("bilateral", L + "talk/trace.c", "t->left = t->what.every - 1;", "t->left = t->what.every;"),
    ("bilateral", H + "axis.h", "if (a->quad->lost) { raised |= EXH_FAULT_ENCODER; }", ""),
    ("bilateral", Y + "bilateral.c", "out->dac_raw[f] = placed->dac_raw[k];",
     "out->dac_raw[k] = placed->dac_raw[k];"),
    ("bilateral", Y + "finger.c", "if (p->phase == EXH_PRECONTACT_FROZEN &&", "if ("),
    ("bilateral", Y + "wire.c", "w->set += ack.result == 0;", "w->set++;"),
    ("bilateral", Y + "wire.c", "if (w->heard && !last && w->tx.seq > 0) { return; }", ""),
    ("bilateral", Y + "frame.c", "s->worn && before_ticks < UINT16_MAX",
     "before_ticks < UINT16_MAX"),
    ("bilateral", Y + "wire.c", "s->age_ticks = UINT32_MAX;", "s->age_ticks = 0;"),
    ("bilateral", H + "axis.h", "raised |= EXH_FAULT_TRACKING;", ""),
    ("bilateral", Y + "cause.c", "s->unsure_ticks >= cfg->glove_ticks",
     "s->unsure_ticks > cfg->glove_ticks"),
    ("bilateral", Y + "cause.c", "s->wire.age_ticks >= cfg->link_ticks",
     "s->wire.age_ticks == UINT32_MAX"),
    ("bilateral", "lib/src/act/supply.c", "raw <= cfg->max_raw", "raw < INT16_MAX"),
    ("mirror", L + "talk/regs_float.c", "rest > 0x80u ||", "rest >= 0x80u ||"),
    ("mirror", L + "talk/regs_float.c", "(rest == 0x80u && (keep & 1u))", "0"),
    ("mirror", L + "talk/regs_float.c", "(rest == half && (mag & 1u))", "0"),
    ("mirror", L + "talk/regs_float.c", "(field ? field : 1)", "field"),
    ("mirror", L + "talk/regs_float.c", "v < INT32_MIN ||", "v <= INT32_MIN ||"),
    ("mirror", L + "talk/regs_float.c", "up >= -FRACTION - 2", "up >= -FRACTION"),
    ("modbus", L + "talk/modbus.c", "#define WRITE_REGS 123u", "#define WRITE_REGS 124u"),
    ("modbus", L + "talk/modbus.c", "#define READ_REGS  125u", "#define READ_REGS  124u"),
    ("modbus", L + "talk/modbus.c", "be16(q, 3) != 0xFF00u", "(be16(q, 3) & 0xFF00u) == 0"),
    ("modbus", L + "talk/modbus.c", "q->p[5] != 2 * n ||", ""),
    ("modbus", L + "talk/modbus.c", "q->len_B != 10u + q->p[9]", "0"),
    ("modbus", L + "talk/modbus.c", "(q->p[5 + i] & ~(uint32_t)q->p[3 + i] & 0xFFu)",
     "q->p[5 + i]"),
    ("modbus", L + "talk/modbus.c", "if (err == 0) { err = exh_regs_read(r, EXH_REGS_HOLDING, "
                                    "be16(q, 1), (uint16_t)get, &resp[2]); }",
     ""),
    ("modbus", L + "talk/modbus.c", "if (first >= OBJECTS) { first = 0; }",
     "if (first >= OBJECTS) { first = 1; }"),
    ("modbus", L + "talk/modbus.c", "q->p[1] != 14", "0"),
    ("modbus", L + "talk/modbus.c", "case 22: return mask_reg(r, q, resp);", ""),
    ("modbus", L + "talk/modbus.c", "bytes = (n + 7) >> 3;", "bytes = (n + 8) >> 3;"),
    ("modbus", L + "talk/regs.c", "s->end <= 2 * values ?", "s->end < 2 * values ?"),
    ("modbus", L + "talk/regs.c", "if (2 * i >= s->from) {", "if (2 * i > s->from) {"),
    ("modbus", L + "talk/regs.c", "n += (rest & 1u) && r->staged[i] != r->wanted[i];",
     "n += rest & 1u;"),
    ("modbus", L + "talk/regs.c", "r->box.state < 32 ?", "r->box.state < 64 ?"),
    ("modbus", L + "talk/regs.c", "? r->active[i]", "? r->wanted[i]"),
    ("modbus", L + "talk/regs_stage.c", "if (raw != r->wanted[i]) { r->touched",
     "if (1) { r->touched"),
    ("modbus", L + "talk/regs_stage.c", "r->touched[i >> 5] &= ~bit;", ""),
    ("modbus", L + "talk/regs_stage.c", "if (bits == exh_float_from_raw(now, row->frac))",
     "if (0)"),
    ("modbus", L + "talk/regs_stage.c",
     "} else if (bits == exh_float_from_raw(row->min, row->frac)) {", "} else if (0) {"),
    ("modbus", L + "talk/regs_stage.c",
     "} else if (bits == exh_float_from_raw(row->max, row->frac)) {", "} else if (0) {"),
    ("modbus", L + "talk/regs_stage.c", "raw < row->min || raw > row->max", "raw < row->min"),
    ("modbus", L + "talk/regs_stage.c", "row->when, r->wanted[i], raw)", "row->when, raw, raw)"),
    ("modbus", L + "talk/regs_stage.c", "r->refused += err == EXH_MODBUS_VALUE;", ""),
    ("modbus", L + "num/authority.c", "cell == FALL && raw < was", "cell == FALL && raw > was"),
    ("modbus", L + "num/authority.c", "cell == RISE && raw > was", "cell == RISE"),
    ("modbus", L + "num/authority.c", "cell >= REST && !who.open", "!who.open"),
    ("wire", L + "num/authority.c", "NEVER,\n        [EXH_WHEN_MATERIAL] = FALL",
     "NEVER,\n        [EXH_WHEN_MATERIAL] = ANY"),
    ("modbus", L + "talk/regs_stage.c", "s->is_float && (!high || !low)", "s->is_float && !high"),
    ("modbus", L + "talk/regs_stage.c",
     "if (r->asked >> EXH_COIL_APPLY & 1u) { return EXH_MODBUS_BUSY; }", ""),
    ("modbus", L + "talk/regs_stage.c", "(on & ~r->may) != 0 ||", ""),
    ("modbus", L + "talk/regs_stage.c",
     "if ((on & discard) && (r->asked & apply)) { return EXH_MODBUS_BUSY; }", ""),
    ("modbus", L + "talk/regs_stage.c", "r->asked |= on & ~discard;", "r->asked |= on;"),
    ("modbus", L + "talk/regs_stage.c",
     "if (asked >> EXH_COIL_CLEAR & 1u) { return EXH_CMD_CLEAR; }", ""),
    ("modbus", L + "talk/regs_stage.c", "    exh_regs_discard(r);\n    r->refused",
     "    r->refused"),
    ("modbus", L + "talk/regs_trace.c", "what->index[i] >= r->trace->signals",
     "what->index[i] > r->trace->signals"),
    ("modbus", L + "talk/regs_trace.c", "return k == 0 ?", "return k != 0 ?"),
    ("modbus", L + "talk/regs_stage.c", "        (void)exh_trace_start(r->trace, &what);\n", ""),
    ("modbus_rtu", L + "talk/modbus_rtu.c", "0xFFFFu;\n    for", "0;\n    for"),
    ("modbus_rtu", L + "talk/modbus_rtu.c", "0x8801, 0x4400", "0x8800, 0x4400"),
    ("modbus_rtu", L + "talk/modbus_rtu.c", "#define LEAST_B 4u", "#define LEAST_B 3u"),
    ("modbus_rtu", L + "talk/modbus_rtu.c", "baud > 19200 ?", "baud >= 19200 ?"),
    ("modbus_rtu", L + "talk/modbus_rtu.c", "UINT64_C(38500000) + baud - 1", "UINT64_C(38500000)"),
    ("modbus_rtu", L + "talk/modbus_rtu.c", "n <= EXH_MODBUS_ADU_B &&", "n < EXH_MODBUS_ADU_B &&"),
    ("modbus_rtu", L + "talk/modbus_rtu.c", " && u->frame[0] != 0)", ")"),
    ("modbus_rtu", L + "talk/modbus_rtu.c", "u->quiet_us >= u->silence_us",
     "u->quiet_us > u->silence_us"),
    ("modbus_rtu", L + "talk/modbus_rtu.c",
     "us < UINT32_MAX - u->quiet_us ? u->quiet_us + us : UINT32_MAX", "u->quiet_us + us"),
    ("modbus_rtu", L + "talk/modbus_rtu.c", "if (u->ready) { return; }", ""),
    ("modbus_rtu", L + "talk/modbus_rtu.c", "if (!u->ready) { u->len_B = EXH_MODBUS_ADU_B + 1; }",
     ""),
    ("modbus_rtu", L + "talk/modbus_rtu.c", "function == 22;", "function == 22 || function == 23;"),
    ("guarded", "examples/guarded/guarded.c", "now.cnt, sig->drop.c, &now.f",
     "now.cnt, !sig->drop.c, &now.f"),
    ("guarded", "examples/guarded/guarded.c", "par->drop.watch.speed_mps_q27);",
     "EXH_Q(3, 1, EXH_Q_VEL));"),
    ("drop", H + "axis.h", "if (a->quad->lost) { raised |= EXH_FAULT_ENCODER; }", ""),
    ("drop", X + "drop.c", "(starved ? EXH_FAULT_SUPPLY : 0u)", "0u"),
    ("drop", H + "axis.h", "exh_tracking_update(a->track, coded_A_q26);", "(void)coded_A_q26;"),
    ("drop", H + "axis.h", "return limits | exh_drive_current_step",
     "return exh_drive_current_step"),
    ("drop", H + "axis.h", "exh_velocity_window_step(a->velocity, a->velocity_cfg, cnt)",
     "exh_velocity_window_step(a->velocity, a->velocity_cfg, cnt + 1)"),
)
# The fingers of one box hinder each other at arming, so 256 ticks show these at fewer rates. A row
# has the share at which it must still be seen. A comment names another test that detects it. Open:
# stimuli that reach these at every rate.
THIN = {
    "if (p->phase == EXH_PRECONTACT_FROZEN &&": 0.60,  # sim/bilateral
    # a plane that comes near the finger is rare among random ones: unit/precontact, sim/late
    "s->phase == EXH_PRECONTACT_TRACK && !s->near": 0.80,
    "s->phase == EXH_PRECONTACT_IDLE && s->met": 0.80,
    "s->near ? 0 : (int64_t)": 0.09,
    "s->present == EXH_FAULT_DEADMAN && !": 0.93,      # unit/safety
    "!p->pending && !p->moving;": 0.50,                # unit/params
    "late > UINT32_C(0x80000000)": 0.93,               # unit/wire
    "if (t->result < 0 || !same(": 0.72,               # sim/bilateral_tick, as of all below
    "if (err < 0) { bilateral_trace_stop(t); }": 0.40,
    "t->left = t->what.every - 1;": 0.86,
    "out->dac_raw[f] = placed->dac_raw[k];": 0.93,
    "!t->answer && n < EXH_WIRE_FRAMES": 0.50,
    "falls ? s->off_raw[k] : UINT16_MAX": 0.80,        # unit/gate, proof
    # codes are few to an ampere: only then a limit is another
    "exh_clamp(peak, 0, most)": 0.50,                  # unit/gate, proof
    "coded(cfg, now) >>": 0.80,                        # unit/drive
    "cfg->i_whole_A_q26 = whole_codes(cfg, par->i_peak_A_q26);": 0.85,  # unit/drive
    # a person's ceiling that is drawn is seldom below i_peak
    "top = person ? cfg->i_top_A_q26 : drive;": 0.10,  # unit/drive, proof
    "cfg->f_top_N_q20 = cut ?": 0.20,
    "par->person_A_q26 < par->i_peak_A_q26 ?": 0.05,    # unit/gate, proof
    "s->ticks < cfg->ticks": 0.37,                     # unit/chatter, as of the next
    "left & ~(left >> 63)": 0.55,
    "to->a >= from->a": 0.28,                          # unit/filter; two high kinds are rare
    # Of 768 requests, 256 on the line, few come there. unit/modbus, unit/trace and unit/modbus_rtu
    # detect them.
    "q->len_B != 10u + q->p[9]": 0.88,
    "? r->active[i]": 0.50,
    "r->touched[i >> 5] &= ~bit;": 0.65,
    "} else if (bits == exh_float_from_raw(row->min, row->frac)) {": 0.53,
    "} else if (bits == exh_float_from_raw(row->max, row->frac)) {": 0.84,
    "raw < row->min || raw > row->max": 0.85,
    "s->end <= 2 * values ?": 0.94,
    "r->refused += err == EXH_MODBUS_VALUE;": 0.04,
    "cell == RISE && raw > was": 0.48,                 # unit/authority, as of the next
    "cell >= REST && !who.open": 0.19,
    "NEVER,\n        [EXH_WHEN_MATERIAL] = FALL": 0.11,
    "if ((on & discard) && (r->asked & apply)) { return EXH_MODBUS_BUSY; }": 0.68,
    "if (asked >> EXH_COIL_CLEAR & 1u) { return EXH_CMD_CLEAR; }": 0.82,
    "what->index[i] >= r->trace->signals": 0.72,
    "function == 22;": 0.30,
}

# Where the inline functions of a header are called for a module.
CALLS = {"fix": "test/golden/basics.c", "contact": "test/golden/contact.c",
         "velocity_window": VELOCITY, "table": TABLE,
         "angle": L + "num/angle.c", "precontact": L + "law/precontact.c",
         "quantizer": L + "sense/quantizer.c", "guard": L + "safe/integrity.c",
         "drop": X + "drop.c", "bilateral": Y + "bilateral.c"}


def objects_but(original):
    """The test's objects without the one that is made of `original`."""
    sources = sorted(glob.glob(os.path.join(ROOT, "test/golden/*.c")) +
                     glob.glob(os.path.join(ROOT, "examples/bilateral/*.c")))
    sources += ["test/support.c", "examples/drop/drop.c", "examples/guarded/guarded.c",
                "lib/src/run/calib_set.c", "examples/glove/cal.c"]
    names = [os.path.relpath(os.path.join(ROOT, s), ROOT) for s in sources]
    return [os.path.join(B, "posix", s[:-2] + ".o") for s in names if s != original]


def holds(source, old):
    """Whether the source has the text."""
    with open(os.path.join(ROOT, source)) as f:
        return old in f.read()


def changed(where, module, source, old, new):
    """Writes the mutant into a folder that comes before all others. Returns the file to compile,
    and the one that it replaces."""
    with open(os.path.join(ROOT, source)) as f:
        text = f.read()
    public = source.startswith(H)
    path = os.path.join(where, "exhand" if public else "", os.path.basename(source))
    os.makedirs(os.path.dirname(path), exist_ok=True)
    with open(path, "w") as f:
        f.write(text.replace(old, new, 1))
    if not source.endswith(".h"):
        return path, source
    return shutil.copy(os.path.join(ROOT, CALLS[module]), where), CALLS[module]


def run(command, **more):
    return subprocess.run(command, cwd=ROOT, capture_output=True, text=True, **more)


def share(mutant, rates):
    """The share of rates at which the module's digest differs, or why it is unknown."""
    module, source, old, new = mutant
    with tempfile.TemporaryDirectory() as where:
        path, original = changed(where, module, source, old, new)
        exe, obj = os.path.join(where, "test"), os.path.join(where, "mutant.o")
        near = ["-I" + where, *FLAGS, "-I" + os.path.dirname(original)]
        built = run(CC + near + ["-c", path, "-o", obj])
        if built.returncode == 0:
            rest = objects_but(original) + [os.path.join(B, "posix/libexhand.a"), "-lcmocka"]
            built = run(CC + ["-o", exe, obj] + rest)
        if built.returncode != 0:
            return "does not build: " + built.stderr.strip().split("\n")[0]
        ran = run([exe], env=dict(os.environ, EXH_TEST=module, EXH_EXPLAIN="0", **rates),
                  timeout=300)
        said = ran.stdout + ran.stderr
        found = re.search(r": (\d+) of (\d+) rates differ", said)
        if found:
            return int(found.group(1)) / int(found.group(2))
        return 0.0 if ran.returncode == 0 else "died: " + " ".join(said.split())[:120]


def dealt(every, seed):
    """One in `every` of each module's, rounded up: no module goes without."""
    deal = random.Random(seed)
    of = {}
    for m in MUTANTS:
        of.setdefault(m[0], []).append(m)
    return [m for ms in of.values() for m in deal.sample(ms, -(-len(ms) // every))]


def main():
    p = argparse.ArgumentParser(description=__doc__,
                                formatter_class=argparse.RawDescriptionHelpFormatter)
    p.add_argument("--some", type=int, default=1, metavar="N")
    p.add_argument("--seed", type=int, metavar="S")
    p.add_argument("module", nargs="*")
    a = p.parse_args()
    seed = commits() if a.seed is None else a.seed
    wanted = [m for m in (dealt(a.some, seed) if a.some > 1 else MUTANTS) if not a.module or
              m[0] in a.module]
    # Reported at every run, because --some has only some of them.
    lost = ["%s: %s" % (source, old) for _, source, old, _ in MUTANTS if not holds(source, old)]
    if lost:
        p.error("texts that no source has: change each as its source was\n  " + "\n  ".join(lost))
    homeless = sorted({m for m, source, _, _ in MUTANTS if source.endswith(".h")} - CALLS.keys())
    if homeless:  # reported in every run, not only when the deal has one of theirs
        p.error("modules with a mutant in a header that CALLS does not name: " + str(homeless))
    rates, slack = ({"EXH_RATES": FIFTH}, SLACK) if a.some > 1 else ({}, 0)
    if a.some > 1:
        print("%d of %d mutants, dealt by --some %d --seed %d:" %
              (len(wanted), len(MUTANTS), a.some, seed))
    bad = 0
    singles()  # a share is of single rates: without their digests, this ends here
    with ThreadPoolExecutor(os.cpu_count()) as pool:
        for (module, source, old, new), got in zip(
                wanted, pool.map(lambda m: share(m, rates), wanted)):
            ok = isinstance(got, float) and got >= THIN.get(old, LEAST) - slack
            bad += not ok
            said = "%5.1f %%" % (100 * got) if isinstance(got, float) else got
            print("%s %-16s %-12s %s  ->  %s" %
                  ("  " if ok else "! ", module, said, old.replace("\n", " ")[:60],
                   new.replace("\n", " ")[:50] or "nothing"))
    print("%d mutants, %d of them seen at less than %d %% of the rates (THIN: than stands there) "
          "or not at all" %
          (len(wanted), bad, 100 * LEAST))
    return 1 if bad or not wanted else 0


if __name__ == "__main__":
    sys.exit(main())
