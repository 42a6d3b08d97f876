/* SPDX-License-Identifier: MIT */
#include "lab/cards/cards.h"

#include "box/hand.h"

#include "../../../ports/cards/box.h"

#include "exhand/error.h"

#include <string.h>

#define RATE_HZ       1000
#define PRESSED_N     2
#define PRESSED_TICKS 20
#define SLACK_TICKS   100 /* a contact may end so much later */
#define AXIS          0   /* whose line is stuck or noisy: thumb on A, little finger on B */

/* --- the box in a scene: five fingers press once against walls --- */

static int run_box(const struct emu_fault *fault, uint32_t ticks, int keep, struct bilateral_run *r)
{
    static const struct run_setting own[] = {{"mat_f_max", 40}};
    struct bilateral_run_cfg c;
    memset(&c, 0, sizeof c);
    c.board = posix_config_default();
    c.board.exo = sim_exo_default();
    c.board.exo.fingers = (1u << EXH_FINGERS) - 1;
    for (unsigned f = 0; f < EXH_FINGERS; f++) {
        c.board.exo.path[f].speed_mps = sim_path_speed("fast");
        c.board.exo.path[f].approaches = 1;
        c.board.exo.path[f].first_s = 0.7; /* it runs before */
        c.board.exo.path[f].back_s = 0.3;
        c.board.exo.path[f].hold_s = 0.4;
    }
    c.board.max_ticks = ticks;
    c.board.cards.how = POSIX_CARDS_TIMED;
    c.board.cards.quiet = 1;
    c.board.cards.fault = *fault;
    c.rate_Hz = RATE_HZ;
    c.k_Npm = 5000;
    c.b_Nspm = 20;
    c.at_m = 0.03;
    c.fps = 400;
    c.until_s = 1e30;
    c.keep = keep;
    c.setting = own;
    c.settings = 1;
    return bilateral_run(&c, r);
}

/* The tick by which all fingers have pressed for a while. */
static uint32_t pressing(const struct bilateral_run *r)
{
    uint32_t long_enough = 0;
    for (size_t n = 0; n < r->finger[0].n; n++) {
        int all = 1;
        for (unsigned f = 0; f < EXH_FINGERS; f++) {
            const struct bilateral_paper *s = &r->finger[f].at[n].raw;
            all &= s->c && s->f_des_N_q20 > EXH_Q(PRESSED_N, 1, EXH_Q_FORCE);
        }
        long_enough = all ? long_enough + 1 : 0;
        if (long_enough == PRESSED_TICKS) { return (uint32_t)n; }
    }
    return 0;
}

/* Accesses of a card by phase, up to the end of so many ticks. */
static int accesses(unsigned card, uint32_t ticks, uint32_t n[EMU_PHASES])
{
    const struct emu_fault count = {
        .kind = EMU_KINDS, .card = (uint8_t)card}; /* no kind: only counted */
    struct bilateral_run r;
    const int err = run_box(&count, ticks, 0, &r);
    memcpy(n, posix_cards_box()->in_phase, sizeof posix_cards_box()->in_phase);
    bilateral_run_free(&r);
    return err;
}

int cards_healthy(struct cards_healthy *h)
{
    const struct emu_fault none = {.kind = EMU_WELL};
    struct bilateral_run r;
    int err = run_box(&none, 0, 1, &r);
    memset(h, 0, sizeof *h);
    h->watch = *posix_cards_watch();
    h->tick = pressing(&r);
    bilateral_run_free(&r);
    if (err == 0 && h->tick == 0) { err = -EXH_E_STATE; }
    for (unsigned card = 0; err == 0 && card < EMU_CARDS; card++) {
        uint32_t more[EMU_PHASES];
        err = accesses(card, h->tick, h->before[card]);
        if (err == 0) { err = accesses(card, h->tick + 1, more); }
        for (unsigned p = 0; err == 0 && p < EMU_PHASES; p++) {
            if (p < EMU_PHASE_READ || p == EMU_PHASE_SAFE) { h->before[card][p] = 0; }
            h->accesses[card][p] = more[p] - h->before[card][p];
        }
    }
    return err;
}

/* --- one run with something wrong --- */

static void count_end(struct cards_cell *c, enum cards_end end, const struct emu_fault *f)
{
    if (end == CARDS_OTHER && c->ends[CARDS_OTHER] == 0) { c->other = *f; }
    c->ends[end]++;
}

/* An error must name the card that is wrong, where it is, and leave the outputs safe. */
static void judge_error(struct cards_cell *c, const struct emu_fault *f)
{
    const struct exh_box_error *e = exh_box_error();
    const uint16_t base = c->card == EMU_MM32XAT ? posix_cards_box()->mm.cfg.base
                                                 : posix_cards_box()->s526[c->card].cfg.base;
    const int named = e->code < 0 && e->card == c->card && e->base == base;
    if (e->fault.what < EXH_CARD_WHATS) { c->what[e->fault.what]++; }
    count_end(c, named && posix_cards_watch()->now_raw <= 1 ? CARDS_ERROR : CARDS_OTHER, f);
}

static void judge_run(struct cards_cell *c, const struct cards_healthy *h,
    const struct emu_fault *f, const struct bilateral_run *r)
{
    const struct posix_cards_watch *w = posix_cards_watch();
    const uint32_t late = w->pressed > h->watch.pressed ? w->pressed - h->watch.pressed : 0;
    if (w->now_raw > 1) {
        count_end(c, CARDS_OTHER, f);
    } else if (r->faults) {
        c->faults |= r->faults;
        count_end(c, CARDS_FAULT, f);
    } else if (w->digest == h->watch.digest && w->ticks == h->watch.ticks) {
        count_end(c, CARDS_SAME, f);
    } else if (w->most_raw > exh_box_default.dac_span_raw) {
        count_end(c, CARDS_OTHER, f);
    } else if (late > SLACK_TICKS) {
        count_end(c, CARDS_UNSEEN, f);
    } else {
        if (late > c->late) { c->late = late; }
        count_end(c, CARDS_LET_GO, f);
    }
}

static void whole_run(
    struct cards_cell *c, const struct cards_healthy *h, const struct emu_fault *f)
{
    struct bilateral_run r;
    const int err = run_box(f, c->phase == EMU_PHASE_SAFE ? h->tick + 1 : 0, 0, &r);
    const uint32_t from = c->phase < EMU_PHASE_READ ? 0 : h->tick;
    if (err < 0 && !r.unarmed) {
        const uint32_t ticks = posix_cards_watch()->ticks;
        if (ticks > from && ticks - from > c->ticks) { c->ticks = ticks - from; }
        judge_error(c, f);
    } else if (c->phase == EMU_PHASE_SAFE) { /* there is no tick after it */
        count_end(c, posix_cards_watch()->now_raw > 1 ? CARDS_OTHER : CARDS_SAME, f);
    } else {
        judge_run(c, h, f, &r);
    }
    bilateral_run_free(&r);
}

/* Opening alone: 1 if it failed, and was judged. */
static int fails_to_open(struct cards_cell *c, const struct emu_fault *f)
{
    const struct posix_cards cards = {.how = POSIX_CARDS_TIMED, .quiet = 1, .fault = *f};
    struct exh_drive_out seen;
    if (cards_start(&cards, EXH_FINGERS, 1) == 0) { return 0; }
    cards_safe(&seen);
    judge_error(c, f);
    return 1;
}

/* n of them, or every so many, the last always: no more than most, and it. */
static int tried(const struct cards_cell *c, uint32_t i, uint32_t n, uint32_t most)
{
    return c->all || i % ((n + most - 1) / most) == 0 || i == n - 1;
}

void cards_cell(struct cards_cell *c, const struct cards_healthy *h)
{
    const int opening = c->phase < EMU_PHASE_READ;
    const uint32_t n = h->accesses[c->card][c->phase], most = c->all ? 64 : CARDS_RUNS / 4;
    uint32_t opened = 0;
    for (uint32_t i = 0; i < n; i++) {
        const struct emu_fault f = {.kind = c->kind,
            .card = c->card,
            .axis = AXIS,
            .phase = c->phase,
            .after = h->before[c->card][c->phase] + i};
        if (!tried(c, i, n, opening ? CARDS_OPENINGS : CARDS_RUNS)) { continue; }
        if (opening && fails_to_open(c, &f)) {
            c->accesses++;
        } else if (!opening || opened++ < most) {
            c->accesses++;
            whole_run(c, h, &f);
        }
    }
}
