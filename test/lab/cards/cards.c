/* SPDX-License-Identifier: MIT */
/* exhand-lab cards: every misbehaviour of a card in every phase of its driver, and how it ends. */
#include "lab/cards/cards.h"

#include "lab/lab.h"
#include "base/jobs.h"
#include "base/names.h"
#include "base/option.h"

#include "../../../ports/cards/box.h"

#include "exhand/error.h"
#include "exhand/safety.h"

#include <inttypes.h>
#include <stdio.h>
#include <string.h>

#define KINDS (EMU_KINDS - 1)
#define CELLS (KINDS * EMU_CARDS * EMU_PHASES)

static void describe(int i, struct cards_cell *c)
{
    memset(c, 0, sizeof *c);
    c->phase = (uint8_t)(i % EMU_PHASES);
    c->kind = (uint8_t)(1 + i / EMU_PHASES % KINDS);
    c->card = (uint8_t)(i / EMU_PHASES / KINDS);
}

struct asked {
    struct cards_healthy h;
    uint8_t all;
};

static void work(const void *ctx, int i, void *result)
{
    const struct asked *a = ctx;
    struct cards_cell c;
    describe(i, &c);
    c.all = a->all;
    cards_cell(&c, &a->h);
    memcpy(result, &c, sizeof c);
}

/* --- words --- */

/* What a card has not cannot go wrong in it. */
static const char *without(const struct cards_cell *c)
{
    if (c->card != EMU_MM32XAT) { return c->kind == EMU_OVERFLOW ? "has no FIFO" : NULL; }
    return c->kind == EMU_LINE_STUCK || c->kind == EMU_LINE_NOISY ? "has no encoder" : NULL;
}

static const char *fault_text(uint32_t bit)
{
    static char text[80];
    switch (bit) {
    case EXH_FAULT_ESTOP: return "e-stop";
    case EXH_FAULT_DRIVE: return "drive not ready";
    case EXH_FAULT_ENCODER: return "encoder";
    case EXH_FAULT_DEADMAN: return "dead-man";
    case EXH_FAULT_TRACKING: return "current tracking";
    default: break;
    }
    names_faults(text, sizeof text, bit);
    return text;
}

/* "a; b", and before each but the first what parts it. */
static void part(FILE *f, int *parts)
{
    if ((*parts)++) { fprintf(f, "; "); }
}

static void print_errors(FILE *f, const struct cards_cell *c, int *parts)
{
    for (unsigned w = 0; w < EXH_CARD_WHATS; w++) {
        if (c->what[w] == 0) { continue; }
        part(f, parts);
        fprintf(f, "**error**: %s, %u", exh_card_what_text(w), c->what[w]);
    }
    if (c->ends[CARDS_ERROR] && c->ticks > 1) {
        fprintf(f, ", %" PRIu32 " ticks later at most", c->ticks);
    }
}

static void print_cell(FILE *f, const struct cards_cell *c)
{
    int parts = 0;
    if (without(c)) {
        fprintf(f, " %s |", without(c));
        return;
    }
    if (c->accesses == 0) {
        fprintf(f, " not touched |");
        return;
    }
    fputc(' ', f);
    print_errors(f, c, &parts);
    for (uint32_t bit = 1; bit; bit <<= 1) {
        if (!(c->faults & bit)) { continue; }
        part(f, &parts);
        fprintf(f, "**safe**: fault %s, %u", fault_text(bit), c->ends[CARDS_FAULT]);
    }
    if (c->ends[CARDS_SAME]) {
        part(f, &parts);
        fprintf(
            f, c->phase == EMU_PHASE_SAFE ? "**safe**, %u" : "no effect, %u", c->ends[CARDS_SAME]);
    }
    if (c->ends[CARDS_LET_GO]) {
        part(f, &parts);
        fprintf(f, "**safe**: lets go, %u", c->ends[CARDS_LET_GO]);
        if (c->late) { fprintf(f, ", %" PRIu32 " ticks later at most", c->late); }
    }
    if (c->ends[CARDS_UNSEEN]) {
        part(f, &parts);
        fprintf(f, "NOT SEEN, %u", c->ends[CARDS_UNSEEN]);
    }
    if (c->ends[CARDS_OTHER]) {
        part(f, &parts);
        fprintf(f, "UNDEFINED, %u", c->ends[CARDS_OTHER]);
    }
    fprintf(f, " |");
}

static void print_card(FILE *f, const struct cards_cell *cell, unsigned card)
{
    fprintf(f, "\n%s at 0x%03X\n\n|", exh_box_card_text(card),
        card == EMU_MM32XAT  ? 0x300u
        : card == EMU_S526_B ? 0x280u
                             : 0x2C0u);
    for (unsigned p = 0; p < EMU_PHASES; p++) { fprintf(f, " | %s", emu_phase_text(p)); }
    fprintf(f, " |\n|---|---|---|---|---|---|---|\n");
    for (int i = 0; i < CELLS; i++) {
        if (cell[i].card != card) { continue; }
        if (cell[i].phase == 0) { fprintf(f, "| %s |", emu_kind_text(cell[i].kind)); }
        print_cell(f, &cell[i]);
        if (cell[i].phase == EMU_PHASES - 1) { fputc('\n', f); }
    }
}

static void print_legend(FILE *f)
{
    fprintf(f, "Five fingers press against walls at 1000 Hz. Numbers: at how many accesses of the "
               "phase it was\n"
               "made to begin; it then stays. How it ended:\n\n"
               "- **error**: the driver's, with the card's name and base; D/A at 0 A, drives "
               "disabled. Ticks:\n"
               "  from the beginning until then, where it takes more than the next one\n"
               "- **safe**: fault: the library's; its gate puts out 0 A. lets go: no error; "
               "currents differ, but\n"
               "  stay within their limits and end with the contact, or so many ticks later. In "
               "the phase safe:\n"
               "  D/A at 0 A or drives disabled behind it\n"
               "- no effect: everything that comes out is as without it\n"
               "- NOT SEEN: no error; the last current stays, within its limits, until the drives "
               "are disabled\n");
}

/* Cells that are undefined. */
static int print_table(FILE *f, const struct cards_cell *cell)
{
    int undefined = 0, unseen = 0, cells = 0;
    unsigned long runs = 0;
    print_legend(f);
    for (unsigned card = 0; card < EMU_CARDS; card++) { print_card(f, cell, card); }
    for (int i = 0; i < CELLS; i++) {
        undefined += cell[i].ends[CARDS_OTHER] != 0;
        unseen += cell[i].ends[CARDS_UNSEEN] != 0;
        cells += cell[i].accesses != 0 && !without(&cell[i]);
        runs += cell[i].accesses;
    }
    fprintf(f, "\n%d cells with an access, %lu beginnings tried: %d undefined, %d not seen.\n",
        cells, runs, undefined, unseen);
    return undefined;
}

int cli_cards(int argc, char **argv)
{
    static struct cards_cell cell[CELLS];
    static struct asked asked;
    int all = 0;
    int64_t parallel = jobs_cores();
    const struct cli_option option[] = {
        {"all", CLI_FLAG, &all, 0, 0, NULL, "begin at every access, not at some of each phase"},
        {"jobs", CLI_INT, &parallel, 1, 1024, "N", "processes at a time (one a core)"},
    };
    const struct cli_command c = {"cards", "[options]",
        "Every misbehaviour of an emulated card in every phase of its "
        "driver, and how it ends: the\n"
        "table of docs/CARDS.md. Five fingers press against walls; "
        "something goes wrong with one card,\n"
        "from one access of a phase on, then from another, and stays. "
        "Status 1: a cell is undefined.",
        option, (int)(sizeof option / sizeof option[0]), 0};
    struct jobs jobs = {CELLS, 1, sizeof cell[0], cell, work, &asked, "cells", posix_interrupt};
    int err = cli_parse(&c, argc, argv, NULL);
    if (err) { return err == 1 ? 0 : err; }
    err = cards_healthy(&asked.h);
    if (err < 0) {
        cli_complain("the box with nothing wrong: %s", exh_error_text(err));
        return 1;
    }
    for (int i = 0; i < CELLS; i++) { describe(i, &cell[i]); }
    asked.all = (uint8_t)all;
    jobs.parallel = (int)parallel;
    err = jobs_run(&jobs);
    if (err) { return err; }
    return print_table(stdout, cell) ? 1 : 0;
}
