/* SPDX-License-Identifier: MIT */
/* main() of an image: scene minimal over the inputs of ride.h on its own board, without the loop,
 * and the CRC of all that it coded. With its own set-up and frozen it is the same number. */
#include "ride.h"

#include "exhand/board.h"
#include "exhand/error.h"

#define TICKS 30000u

void SAY(const char *text); /* the port's */

extern const struct exh_scene EXH_SCENE;

static uint32_t crc_of(uint32_t crc, struct exh_drive_out *out)
{
    uint8_t byte[2 * EXH_FINGERS + 2];
    struct exh_bytes c = exh_bytes_writer(byte, sizeof byte);
    exh_drive_out_serialize(&c, out, EXH_FINGERS);
    return exh_crc32(crc, byte, sizeof byte);
}

static void say(uint32_t crc)
{
    char text[] = "digest 00000000\n";
    for (unsigned k = 0; k < 8; k++) { text[7 + k] = "0123456789abcdef"[crc >> (28 - 4 * k) & 15]; }
    SAY(text);
}

int main(void)
{
    struct exh_scene_board board = {.enc_bits = exh_board_info.enc_bits};
    struct exh_scene_in in = {.command = EXH_CMD_NONE};
    struct exh_drive_out out = {.dac_raw = {32768}};
    struct ride r = {.random = 1};
    uint32_t crc = 0;
    int err = exh_board_init(EXH_SCENE.rate_Hz, &board.T);
    if (err == 0) { err = EXH_SCENE.setup(board); }
    for (uint32_t k = 0; err == 0 && k < TICKS; k++) {
        if (ride(&r, &EXH_SCENE, &out, &in)) { err = EXH_SCENE.setup(board); }
        EXH_SCENE.tick(&in, &out);
        crc = crc_of(crc, &out);
    }
    say(crc);
    exh_board_halt(err < 0 ? exh_error_text(err) : "done");
    return 0;
}
