/* Runs a scene's tick and nothing else, for whoever counts its instructions: every input healthy,
 * the string at rest until the box runs (armed, ramp over), then pulled out and let in one count a
 * tick, so that a wall is entered and left, the glove bent and stretched along with it. Counted,
 * in counted_tick(), are the ticks of the sweep that are asked for:
 *     contact   RUN or LIMIT, and the tick before coded a current for finger 0
 *     run       RUN or LIMIT
 *     all       all: a scene without safety
 * Their number goes to stdout. Usage: ticks N contact|run|all. */
#include "scene.h"

#include "exhand/board.h"
#include "exhand/error.h"
#include "exhand/safety.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define SWEEP_CNT 1500u /* 99 mm of string: drop's wall is at 70 */
#define ARM_TICKS 20000u /* by then a box that can be armed runs   */
#define CODE_ZERO 32768
#define UNCALIBRATED_ID 0x8903 /* examples/calib: it has none, and arms */

enum which { ALL, RUN, CONTACT };

extern const struct exh_scene EXH_SCENE;

void exh_assert_failed(const char *file, int line)
{
    fprintf(stderr, "%s:%d: assertion\n", file, line);
    exit(1);
}

/* For scenes that name it; nobody calls it here. */
int exh_board_read_glove(struct exh_glove_in *in)
{
    (void)in;
    return 0;
}

/* Nor is anybody at a link. These are no port's, so that what is counted holds nothing of one. */
int exh_board_link_send(const void *buf, size_t len_B)
{
    (void)buf;
    (void)len_B;
    return 0;
}

int exh_board_link_recv(void *buf, size_t cap_B)
{
    (void)buf;
    (void)cap_B;
    return 0;
}

int exh_board_log(const void *rec, size_t len_B)
{
    (void)rec;
    return (int)len_B;
}

uint32_t exh_board_cycles(void)
{
    return 1;
}

/* As the loop does it. */
static int set_up(void)
{
    const struct exh_scene_board board = {{1, 1000}, 24};
    int err;

    if (EXH_SCENE.defaults) { EXH_SCENE.defaults(); }
    if (EXH_SCENE.calib) { (void)exh_params_stage(EXH_SCENE.params, UNCALIBRATED_ID, 0, 1); }
    if (EXH_SCENE.params) { exh_params_apply(EXH_SCENE.params); }
    err = EXH_SCENE.setup(board);
    if (err < 0) { fprintf(stderr, "%s: %s\n", EXH_SCENE.name, exh_error_text(err)); }
    return err;
}

__attribute__((noinline)) static void counted_tick(const struct exh_scene_in *in,
                                                   struct exh_drive_out *out)
{
    EXH_SCENE.tick(in, out);
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
    in->glove_new = 1;
    for (unsigned i = 0; i < EXH_GLOVE_SENSORS; i++) {
        in->glove.raw[i] = (int16_t)((int32_t)cnt * 8 / 3 - 2000);
    }
}

static int runs(void)
{
    return EXH_SCENE.safety != NULL && exh_safety_runs(EXH_SCENE.safety);
}

/* Until the box runs, or cannot. */
static void arm(struct exh_scene_in *in, struct exh_drive_out *out)
{
    for (uint32_t k = 0; k < ARM_TICKS && EXH_SCENE.safety != NULL && !runs(); k++) {
        in->command = (uint8_t)(k == 0 ? EXH_CMD_RUN : EXH_CMD_NONE);
        inputs(in, out, 0);
        EXH_SCENE.tick(in, out);
    }
    in->command = EXH_CMD_NONE;
}

static unsigned long sweep(unsigned long ticks, enum which which, struct exh_scene_in *in,
                           struct exh_drive_out *out)
{
    unsigned long counted = 0;
    for (unsigned long k = 0; k < ticks; k++) {
        const uint32_t at = (uint32_t)(k % (2 * SWEEP_CNT));
        const int coded = out->dac_raw[0] != CODE_ZERO;
        inputs(in, out, at < SWEEP_CNT ? at : 2 * SWEEP_CNT - at);
        if (which == ALL || (runs() && (which == RUN || coded))) {
            counted_tick(in, out);
            counted++;
        } else {
            EXH_SCENE.tick(in, out);
        }
    }
    return counted;
}

int main(int argc, char **argv)
{
    const unsigned long ticks = argc == 3 ? strtoul(argv[1], NULL, 10) : 0;
    struct exh_scene_in in = {.command = EXH_CMD_NONE};
    struct exh_drive_out out = {.enable = 0};
    enum which which = ALL;

    if (ticks == 0) {
        fprintf(stderr, "usage: ticks N contact|run|all (N > 0)\n");
        return 2;
    }
    if (strcmp(argv[2], "run") == 0) { which = RUN; }
    if (strcmp(argv[2], "contact") == 0) { which = CONTACT; }
    for (unsigned i = 0; i < EXH_FINGERS; i++) { out.dac_raw[i] = CODE_ZERO; }
    if (set_up() < 0) { return 1; }
    arm(&in, &out);
    printf("%lu\n", sweep(ticks, which, &in, &out));
    return 0;
}
