/* Runs a scene's tick and nothing else, for whoever counts its instructions: every
 * input healthy, the string pulled out and let in one count a tick, so that the wall
 * is entered and left, the glove bent and stretched along with it. Usage: ticks N. */
#include "scene.h"

#include "exhand/board.h"
#include "exhand/error.h"
#include "exhand/safety.h"

#include <stdio.h>
#include <stdlib.h>

#define SWEEP_CNT 1000u /* 66 mm of string */

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
    if (EXH_SCENE.params) { exh_params_apply(EXH_SCENE.params); }
    err = EXH_SCENE.setup(board);
    if (err < 0) { fprintf(stderr, "%s: %s\n", EXH_SCENE.name, exh_error_text(err)); }
    return err;
}

int main(int argc, char **argv)
{
    const unsigned long ticks = argc == 2 ? strtoul(argv[1], NULL, 10) : 0;
    struct exh_scene_in in = {.command = EXH_CMD_RUN};
    struct exh_drive_out out = {.enable = 0};

    if (ticks == 0) {
        fprintf(stderr, "usage: ticks N (N > 0)\n");
        return 2;
    }
    if (set_up() < 0) { return 1; }
    in.drive.din = EXH_DIN_ESTOP | EXH_DIN_DEADMAN | EXH_DIN_WATCHDOG | EXH_DIN_CARDS;
    for (unsigned i = 0; i < EXH_FINGERS; i++) {
        in.drive.din |= (uint32_t)EXH_DIN_DRIVE0 << i;
    }
    for (unsigned long k = 0; k < ticks; k++) {
        const uint32_t at = (uint32_t)(k % (2 * SWEEP_CNT));
        for (unsigned i = 0; i < EXH_FINGERS; i++) {
            const int codes = k ? out.dac_raw[i] - 32768 : 0;
            in.drive.enc_raw[i] = at < SWEEP_CNT ? at : 2 * SWEEP_CNT - at;
            in.drive.mon_raw[i] = (int16_t)(codes + codes / 16); /* 1.06 for the drive's 1.05 */
        }
        in.glove_new = 1;
        for (unsigned i = 0; i < EXH_GLOVE_SENSORS; i++) {
            in.glove.raw[i] = (int16_t)((int32_t)in.drive.enc_raw[0] * 4 - 2000);
        }
        EXH_SCENE.tick(&in, &out);
        in.command = EXH_CMD_NONE;
    }
    return 0;
}
