#include "loop.h"

#include "exhand/board.h"
#include "exhand/error.h"
#include "exhand/safety.h"

int exh_loop(const struct exh_scene *sc, uint32_t rate_Hz, const struct exh_loop_hooks *hooks)
{
    static const struct exh_loop_hooks none;
    const struct exh_loop_hooks *h = hooks ? hooks : &none;
    struct exh_scene_in in = {.command = EXH_CMD_RUN};
    struct exh_drive_out out;
    struct exh_period T;
    uint32_t tick = 0;
    int missed;

    int err = exh_board_init(rate_Hz ? rate_Hz : sc->rate_Hz, &T);
    if (sc->params) { exh_params_apply(sc->params); }
    if (err == 0) { err = sc->setup(T); }
    if (err == 0 && sc->params) { sc->params->locked = 1; }
    if (err == 0 && h->start) { h->start(sc, T); }
    while (err == 0 && (missed = exh_board_wait()) >= 0) {
        in.missed = (uint32_t)missed;
        err = exh_board_read_drive(&in.drive);
        if (err < 0) { break; }
        if (h->before) { h->before(tick, &in); }
        if (sc->params) { exh_params_apply(sc->params); }
        sc->tick(&in, &out);
        err = exh_board_write_drive(&out);
        if (h->after) { h->after(tick, &in, &out); }
        in.command = EXH_CMD_NONE;
        tick++;
    }
    exh_board_safe();
    return err;
}

/* "file.c:123" without a C library. */
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
    exh_board_safe(); /* first the currents, then the words */
    exh_board_halt(place(text + sizeof text, file, line));
}
