/* SPDX-License-Identifier: MIT */
/* Everything that may be wrong in a bring-up, in every stage, as a table. */
#include "bench/bringup_run.h"

#include <stdio.h>
#include <string.h>

/* In which phase what is wrong begins; those that are so from the start first. */
static int begins(enum bringup_wrong w, int stage)
{
    static const int busy[BRINGUP_STAGES] = {
        3, 1, 2, 3, 2}; /* output, load, polarity, force, force */
    static const int hands[BRINGUP_STAGES] = {2, -1, 0, 0, 0}; /* the phase before the question */
    const int from_start = w <= BRINGUP_UNPLUGGED || w == BRINGUP_STUCK || w == BRINGUP_AWAY ||
                           (w == BRINGUP_NOT_READY && stage == 1);
    if (w == BRINGUP_HELD) { return hands[stage - 1]; }
    return from_start ? -1 : busy[stage - 1];
}

/* Can a stage meet it? One without motor has none that is reversed. */
static int wrong_is_of(enum bringup_wrong w, int stage)
{
    switch (w) {
    case BRINGUP_MOTOR_REVERSED:
    case BRINGUP_STUCK: return stage == 3 || stage == 4;
    case BRINGUP_ENCODER_REVERSED: return stage != 2 && stage != 5;
    case BRINGUP_UNPLUGGED: return stage != 2;
    case BRINGUP_COMES_OFF: return stage >= 3;
    case BRINGUP_SLIPPED: return stage == 4;
    case BRINGUP_RIGHT:
    case BRINGUP_MONITOR_DEAD:
    case BRINGUP_MONITOR_HALF:
    case BRINGUP_DA_STILL:
    case BRINGUP_NOT_READY:
    case BRINGUP_ESTOP:
    case BRINGUP_LET_GO:
    case BRINGUP_AWAY:
    case BRINGUP_HELD:
    case BRINGUP_WRONGS:
    default: return 1;
    }
}

/* The numbers of a finger whose scales are the defaults. */
static int stage_run(const struct bringup_run_cfg *cfg, int stage, uint32_t shown, const char *more,
    struct bringup_run *r)
{
    struct bringup_run_cfg c = *cfg;
    char boot[120];
    snprintf(boot, sizeof boot, "stage=%d shown=%lu%s", stage, (unsigned long)shown, more);
    c.boot = boot;
    return bringup_run(&c, r);
}

static void cell(FILE *f, const struct bringup_run *r, int stage)
{
    const struct bringup_phase *p = bringup_phase((unsigned)stage, r->phase);
    if (r->result == EXH_PROBE_DONE) {
        fprintf(f, " not seen |");
        return;
    }
    fprintf(f, " %s, %.*f s", p->name, r->took_s < 10 ? 3 : 0, r->took_s);
    if (r->most_A > 0) { fprintf(f, ", %.0f mA, %.1f mm", r->most_A * 1e3, r->moved_m * 1e3); }
    fprintf(f, " |");
}

int bringup_faults(FILE *f, const struct bringup_run_cfg *cfg)
{
    const char *const reads[BRINGUP_STAGES] = {"", "", "", " read1=0.4 read2=0.85 read3=1.29", ""};
    struct bringup_run_cfg c = *cfg;
    uint32_t shown[BRINGUP_STAGES + 1] = {0};
    struct bringup_run r;
    int bad = 0;
    c.board.log = NULL;
    for (int stage = 1; stage <= BRINGUP_STAGES; stage++) {
        c.wrong = BRINGUP_RIGHT;
        if (stage_run(&c, stage, shown[stage - 1], reads[stage - 1], &r) < 0) { return 1; }
        bad |= r.result != EXH_PROBE_DONE || r.unsafe > 0;
        shown[stage] = r.number;
    }
    fprintf(f, "| | stage 1 | 2 | 3 | 4 | 5 |\n|---|---|---|---|---|---|\n");
    for (int w = BRINGUP_RIGHT + 1; w < BRINGUP_WRONGS; w++) {
        fprintf(f, "| %s |", bringup_wrong_row[w].what);
        for (int stage = 1; stage <= BRINGUP_STAGES; stage++) {
            c.wrong = (enum bringup_wrong)w;
            c.wrong_phase = begins(c.wrong, stage);
            if (!wrong_is_of(c.wrong, stage)) {
                fprintf(f, " |");
                continue;
            }
            if (stage_run(&c, stage, shown[stage - 1], reads[stage - 1], &r) < 0) { return 1; }
            cell(f, &r, stage);
            bad |= r.result == EXH_PROBE_DONE || r.unsafe > 0;
        }
        fprintf(f, "\n");
    }
    return bad;
}
