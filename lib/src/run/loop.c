/* SPDX-License-Identifier: MIT */
/* The loop: waits for a tick, reads, runs the scene, writes and logs. */
#include "exhand/run/loop.h"

#include "exhand/board.h"
#include "exhand/error.h"
#include "exhand/fix.h"
#include "exhand/safety.h"

/* Initialises the board, stages the parameters, sets up the scene. */
static int set_up(const struct exh_scene *sc, uint32_t rate_Hz, struct exh_scene_board *board)
{
    int err;
    EXH_ASSERT(!sc->params || sc->apply);
    if (exh_board_info.version != EXH_BOARD_VERSION) { return -EXH_E_VERSION; }
    if (exh_board_info.fingers < sc->fingers) { return -EXH_E_ABSENT; }
    board->enc_bits = exh_board_info.enc_bits;
    err = exh_board_init(rate_Hz ? rate_Hz : sc->rate_Hz, &board->T);
    if (err == 0 && !exh_period_ok(board->T)) { err = -EXH_E_RATE; }
    if (sc->params) { (void)sc->apply(sc->params); }
    if (err == 0) { err = sc->setup(*board); }
    if (err == 0 && sc->params) { sc->params->locked = 1; }
    return err;
}

/* The glove frame of the last tick, with its age increased by this tick and those missed. */
static void same_glove(struct exh_scene_in *in)
{
    const uint32_t age = in->glove.age_ticks + 1u + in->missed;
    in->glove.age_ticks = (uint16_t)(age < UINT16_MAX ? age : UINT16_MAX);
    in->glove_new = 0;
}

/* *wait: ticks to the next frame, counted, since a tick must not divide. There may be no newer
 * frame. */
static int read_glove(const struct exh_scene *sc, struct exh_scene_in *in, uint32_t *wait)
{
    struct exh_glove_in got;
    int err;
    same_glove(in);
    if (*wait > 0) {
        --*wait;
        return 0;
    }
    if (sc->glove_every && *sc->glove_every > 1) { *wait = (uint32_t)*sc->glove_every - 1; }
    err = sc->read_glove(&got);
    if (err < 0) { return err; }
    in->glove_new = got.age_ticks < in->glove.age_ticks && got.age_ticks < UINT16_MAX;
    in->glove = got;
    return 0;
}

/* Reads all inputs of this tick from the board. */
static int read_board(const struct exh_scene *sc, struct exh_scene_in *in, uint32_t *wait)
{
    struct exh_drive_in got;
    const int err = exh_board_read_drive(&got);
    if (err < 0) {
        if (sc->read_glove) { same_glove(in); }
        return err;
    }
    in->drive = got;
    return sc->read_glove ? read_glove(sc, in, wait) : 0;
}

static void read_link(const struct exh_scene_link *link)
{
    struct exh_scene_mail *in = link->in;
    in->packets = 0;
    while (in->packets < EXH_SCENE_PACKETS) {
        const int n = link->recv(in->byte[in->packets], EXH_SCENE_PACKET_B);
        if (n <= 0 || n > EXH_SCENE_PACKET_B) { return; }
        in->len_B[in->packets++] = (uint16_t)n;
    }
}

static void write_link(const struct exh_scene_link *link)
{
    link->write();
    for (unsigned i = 0; i < link->out->packets; i++) {
        (void)link->send(link->out->byte[i], link->out->len_B[i]);
    }
}

/* put: 1, write the outputs; 0, leave them unchanged. */
static int one_tick(const struct exh_scene *sc, const struct exh_loop_hooks *h, uint32_t tick,
    struct exh_scene_in *in, int put)
{
    struct exh_drive_out out;
    int err;
    if (sc->link) { read_link(sc->link); }
    if (h->before) { h->before(tick, in); }
    if (sc->params) { (void)sc->apply(sc->params); }
    sc->tick(in, &out);
    err = put ? exh_board_write_drive(&out) : 0;
    if (sc->link) { write_link(sc->link); }
    if (sc->tell) { sc->tell(); }
    if (h->after) { h->after(tick, in, &out); }
    in->command = EXH_CMD_NONE;
    return err;
}

/* After a card failure, runs one last tick with the last inputs and EXH_DIN_CARDS open. So the
 * fault with its cause reaches the scene, the log and the clients. The outputs are safe before, and
 * this tick does not change them. */
static void last_tick(const struct exh_scene *sc, const struct exh_loop_hooks *h, uint32_t tick,
    struct exh_scene_in *in)
{
    exh_board_safe();
    in->drive.din &= ~(uint32_t)EXH_DIN_CARDS;
    (void)one_tick(sc, h, tick, in, 0);
}

int exh_loop(const struct exh_scene *sc, uint32_t rate_Hz, const struct exh_loop_hooks *hooks)
{
    static const struct exh_loop_hooks none;
    const struct exh_loop_hooks *h = hooks ? hooks : &none;
    struct exh_scene_in in = {.command = EXH_CMD_NONE, .glove.age_ticks = UINT16_MAX};
    struct exh_scene_board board;
    uint32_t tick = 0, glove_wait = 0;
    int missed;

    int err = set_up(sc, rate_Hz, &board);
    if (err == 0 && h->start) { h->start(sc, board); }
    while (err == 0 && (missed = exh_board_wait()) >= 0) {
        in.missed = (uint32_t)missed;
        err = read_board(sc, &in, &glove_wait);
        if (err == 0) {
            err = one_tick(sc, h, tick++, &in, 1);
            in.missed = 0;
            if (err < 0 && sc->read_glove) { same_glove(&in); }
        }
        if (err < 0) { last_tick(sc, h, tick, &in); }
    }
    exh_board_safe();
    if (sc->end) { sc->end(); }
    return err;
}

/* Writes "file.c:123" backwards from end, without a C library. */
static const char *place(char *end, const char *file, int line)
{
    size_t n = 0;
    *--end = '\0';
    for (; line > 0; line /= 10) { *--end = (char)('0' + line % 10); }
    *--end = ':';
    while (file[n] != '\0' && n < 48) { n++; }
    while (n > 0) { *--end = file[--n]; }
    return end;
}

void exh_assert_failed(const char *file, int line)
{
    char text[80];
    exh_board_safe(); /* currents first, then text */
    exh_board_halt(place(text + sizeof text, file, line));
}
