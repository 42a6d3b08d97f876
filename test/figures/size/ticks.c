/* SPDX-License-Identifier: MIT */
/* Runs only a scene's ticks, so that a tool can count their instructions. All inputs are healthy.
 * The string is at rest until the box runs: armed, ramp over. Then it moves out and in by one count
 * a tick, so that the finger enters and leaves a wall. The glove bends with it. counted_tick() has
 * the ticks of the sweep that the option selects:
 *     contact   RUN or LIMIT, and the tick before coded a current for finger 0
 *     run       RUN or LIMIT
 *     all       all: a scene without safety
 * Their number goes to stdout. Usage: ticks N contact|run|all [WORD...]
 *     0xID=RAW    a parameter, of every finger or every item; 0xID.N=RAW: of one
 * With any other word, a tick is one of the loop with parameters applied, and with
 *     link=0|1|2  the link not called; packets written without a peer; a world that answers
 *     log=1       lib/src/run/log.c, to a board that takes every record
 *     glove=0     no glove frame ever came */
#include "world.h"

#include "exhand/run/log.h"

#include "exhand/board.h"
#include "exhand/error.h"
#include "exhand/exhand.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define SWEEP_CNT       1500u  /* 99 mm of string: drop's wall is at 70 */
#define PLANES_CNT      900u   /* of a world: where the fingertips are then */
#define ARM_TICKS       20000u /* by then a box that can be armed runs */
#define CODE_ZERO       32768
#define UNCALIBRATED_ID 0x8903 /* lib/src/run/calib_set: it has none, and arms */

enum which { ALL, RUN, CONTACT, NONE };

extern const struct exh_scene EXH_SCENE;

static struct variant {
    int whole, link, log, no_glove;
    uint32_t tick;
} as;

void exh_assert_failed(const char *file, int line)
{
    fprintf(stderr, "%s:%d: assertion\n", file, line);
    exit(1);
}

/* The rest of a board: test/no_board.c. */
int exh_board_log(const void *rec, size_t len_B)
{
    (void)rec;
    return (int)len_B;
}

/* Of every instance, or of one. */
static int stage(unsigned id, int one, int raw)
{
    struct exh_params *p = EXH_SCENE.params;
    if (one >= 0) { return exh_params_stage(p, (uint16_t)id, (uint16_t)one, raw); }
    for (uint16_t n = 0; exh_signal_find(p->table, (uint16_t)id, n) >= 0; n++) {
        const int err = exh_params_stage(p, (uint16_t)id, n, raw);
        if (err < 0) { return err; }
    }
    return 0;
}

static int word(const char *text)
{
    unsigned id;
    int one = -1, raw;
    if (sscanf(text, "%x.%d=%d", &id, &one, &raw) == 3 || sscanf(text, "%x=%d", &id, &raw) == 2) {
        return EXH_SCENE.params ? stage(id, one, raw) : -EXH_E_UNKNOWN;
    }
    as.whole = 1;
    if (strcmp(text, "glove=0") == 0) {
        as.no_glove = 1;
        return 0;
    }
    return sscanf(text, "link=%d", &as.link) == 1 || sscanf(text, "log=%d", &as.log) == 1
               ? 0
               : -EXH_E_UNKNOWN;
}

static int words(int argc, char **argv)
{
    int err = 0;
    for (int k = 0; err == 0 && k < argc; k++) { err = word(argv[k]); }
    return err;
}

/* As the loop does it. */
static int set_up(int argc, char **argv)
{
    const struct exh_scene_board board = {{1, 1000}, 24};
    int err;

    if (EXH_SCENE.defaults) { EXH_SCENE.defaults(); }
    if (EXH_SCENE.calib) { (void)exh_params_stage(EXH_SCENE.params, UNCALIBRATED_ID, 0, 1); }
    err = words(argc, argv);
    if (err < 0) {
        fprintf(stderr, "%s: a word that it does not take\n", EXH_SCENE.name);
        return err;
    }
    if (EXH_SCENE.params) { exh_params_apply(EXH_SCENE.params); }
    err = EXH_SCENE.setup(board);
    if (err < 0) { fprintf(stderr, "%s: %s\n", EXH_SCENE.name, exh_error_text(err)); }
    if (EXH_SCENE.params) { EXH_SCENE.params->locked = 1; }
    if (err == 0 && as.log) { exh_log_start(&EXH_SCENE, board); }
    return err;
}

__attribute__((noinline)) static void counted_tick(
    const struct exh_scene_in *in, struct exh_drive_out *out)
{
    EXH_SCENE.tick(in, out);
}

__attribute__((noinline)) static void whole_tick(struct exh_scene_in *in, struct exh_drive_out *out)
{
    if (as.log) { exh_log_before(as.tick, in); }
    if (EXH_SCENE.params) { exh_params_apply(EXH_SCENE.params); }
    EXH_SCENE.tick(in, out);
    if (as.link) { EXH_SCENE.link->write(); }
    if (as.log) { exh_log_after(as.tick, in, out); }
}

__attribute__((noinline)) static void counted_whole_tick(
    struct exh_scene_in *in, struct exh_drive_out *out)
{
    whole_tick(in, out);
}

/* What is around it in a variant. */
static void tick(struct exh_scene_in *in, struct exh_drive_out *out, int counts)
{
    if (!as.whole) {
        if (counts) {
            counted_tick(in, out);
        } else {
            EXH_SCENE.tick(in, out);
        }
        return;
    }
    if (as.link == 2) { world_answer(EXH_SCENE.link); }
    if (counts) {
        counted_whole_tick(in, out);
    } else {
        whole_tick(in, out);
    }
    as.tick++;
}

static void inputs(struct exh_scene_in *in, const struct exh_drive_out *out, uint32_t cnt)
{
    in->drive.din = EXH_DIN_ESTOP | EXH_DIN_DEADMAN | EXH_DIN_WATCHDOG | EXH_DIN_CARDS;
    for (unsigned i = 0; i < EXH_FINGERS; i++) {
        const int codes = out->dac_raw[i] - CODE_ZERO;
        in->drive.din |= (uint32_t)EXH_DIN_DRIVE0 << i;
        in->drive.enc_raw[i] = cnt;
        in->drive.mon_raw[i] = (int16_t)(codes + codes / 16); /* 1.06 for the drive's 1.05 */
    }
    if (as.no_glove) {
        in->glove.age_ticks = UINT16_MAX;
        return;
    }
    in->glove_new = 1;
    for (unsigned i = 0; i < EXH_GLOVE_SENSORS; i++) {
        const struct exh_glove_sensor *s = &exh_glove_cal_default.sensor[i];
        const int32_t bent = (s->high_raw - s->low_raw) * (int32_t)cnt / (int32_t)SWEEP_CNT;
        in->glove.raw[i] = (int16_t)(as.whole ? s->low_raw + bent : (int32_t)cnt * 8 / 3 - 2000);
    }
}

static int runs(void)
{
    return EXH_SCENE.safety != NULL && exh_safety_is_running(EXH_SCENE.safety);
}

/* Until the box runs, or cannot. */
static void arm(struct exh_scene_in *in, struct exh_drive_out *out)
{
    for (uint32_t k = 0; k < ARM_TICKS && EXH_SCENE.safety != NULL && !runs(); k++) {
        in->command = (uint8_t)(k == 0 ? EXH_CMD_RUN : EXH_CMD_NONE);
        inputs(in, out, 0);
        tick(in, out, 0);
    }
    in->command = EXH_CMD_NONE;
}

static unsigned long sweep(
    unsigned long ticks, enum which which, struct exh_scene_in *in, struct exh_drive_out *out)
{
    unsigned long counted = 0;
    for (unsigned long k = 0; k < ticks; k++) {
        const uint32_t at = (uint32_t)(k % (2 * SWEEP_CNT));
        const int coded = out->dac_raw[0] != CODE_ZERO;
        const int counts = which == ALL || (which != NONE && runs() && (which == RUN || coded));
        inputs(in, out, at < SWEEP_CNT ? at : 2 * SWEEP_CNT - at);
        tick(in, out, counts);
        if (which == NONE && at == PLANES_CNT) { world_place(); }
        counted += counts != 0;
    }
    return counted;
}

int main(int argc, char **argv)
{
    const unsigned long ticks = argc >= 3 ? strtoul(argv[1], NULL, 10) : 0;
    struct exh_scene_in in = {.command = EXH_CMD_NONE};
    struct exh_drive_out out = {.enable = 0};
    enum which which = ALL;

    if (ticks == 0) {
        fprintf(stderr, "usage: ticks N contact|run|all [WORD...] (N > 0)\n");
        return 2;
    }
    if (strcmp(argv[2], "run") == 0) { which = RUN; }
    if (strcmp(argv[2], "contact") == 0) { which = CONTACT; }
    for (unsigned i = 0; i < EXH_FINGERS; i++) { out.dac_raw[i] = CODE_ZERO; }
    if (set_up(argc - 3, argv + 3) < 0) { return 1; }
    arm(&in, &out);
    if (as.link == 2) { (void)sweep(2 * SWEEP_CNT, NONE, &in, &out); }
    printf("%lu\n", sweep(ticks, which, &in, &out));
    return 0;
}
