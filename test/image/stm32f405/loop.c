/* SPDX-License-Identifier: MIT */
#include "loop.h"

#include "../hil/setup.h"

#include "exhand/board.h"
#include "exhand/exhand.h"

#include <string.h>

/* Offsets in struct exh_scene and what it points to, of a 32-bit image. */
enum { PARAMS = 12, VALUES = 20, LINK = 32, TICK = 44, SHOW = 48 };
enum { STAGED = 8, PENDING = 13, MAIL_IN = 8 };
enum { TEXT = 2, LINK_LINE = 3 };
#define CALM 8u /* ticks behind one that was late */

struct loop loop;

static void differs(const char *what, unsigned i, int64_t image, int64_t posix)
{
    if (image == posix || loop.quiet) { return; }
    loop.differs = 1;
    if (loop.r.what[0] == 0) {
        loop.r.first = loop.r.ticks;
        snprintf(loop.r.what, sizeof loop.r.what, "%s %u: %lld on stm32f405, %lld on posix", what,
            i, (long long)image, (long long)posix);
    }
}

/* --- the link: frames of COBS over the line --- */

static unsigned encode(uint8_t *to, const uint8_t *from, unsigned n)
{
    unsigned code = 0, at = 1;
    for (unsigned i = 0; i <= n; i++) {
        if (i == n || from[i] == 0 || at - code == 255) {
            const int full = i < n && from[i] != 0;
            to[code] = (uint8_t)(at - code);
            code = at++;
            i -= (unsigned)full;
        } else {
            to[at++] = from[i];
        }
    }
    to[code] = 0;
    return code + 1;
}

static unsigned decode(uint8_t *to, const uint8_t *from, unsigned n)
{
    unsigned at = 0, i = 0;
    while (i < n) {
        const unsigned code = from[i++];
        for (unsigned k = 1; k < code && i < n; k++) { to[at++] = from[i++]; }
        if (code < 255 && i < n) { to[at++] = 0; }
    }
    return at;
}

static void take_link(uint8_t byte)
{
    uint8_t packet[300];
    if (byte) {
        if (loop.frame_B < sizeof loop.frame) { loop.frame[loop.frame_B++] = byte; }
        return;
    }
    if (loop.ready) {
        (void)exh_board_link_send(packet, decode(packet, loop.frame, loop.frame_B));
        loop.r.packets++;
    }
    loop.frame_B = 0;
}

/* The newest of it; records are on the same line. */
static void keep_text(char c)
{
    if (loop.text_n == sizeof loop.text - 1) {
        loop.text_n = sizeof loop.text / 2;
        memmove(loop.text, &loop.text[sizeof loop.text / 2 - 1], loop.text_n);
    }
    loop.text[loop.text_n++] = c;
    loop.text[loop.text_n] = 0;
}

static void on_sent(unsigned usart, uint8_t byte)
{
    if (usart == LINK_LINE) { take_link(byte); }
    if (usart == TEXT) { keep_text((char)(byte ? byte : ' ')); }
}

static void bring_link(void)
{
    uint8_t packet[EXH_SCENE_PACKET_B], frame[EXH_SCENE_PACKET_B + 8];
    int n;
    while ((n = exh_board_link_recv(packet, sizeof packet)) > 0) {
        const unsigned coded = encode(frame, packet, (unsigned)n);
        if (stm_usart_put(&loop.m->s, LINK_LINE, frame, coded) < coded) {
            machine_broke(loop.m, "more came over the link than its line takes");
        }
        loop.r.packets++;
    }
}

/* --- the device --- */

static void start_device(void)
{
    const struct stm_core *c = &loop.m->s.core;
    struct exh_period T = {c->systick[1] + 1, c->systick[0] & 4 ? 168000000 : 21000000};
    loop.T = loop.cfg.board.T = T;
    posix_configure(&loop.cfg.board);
    if (exh_board_init(1, &T) < 0) { machine_broke(loop.m, "the device does not start"); }
    loop.ready = 1;
}

/* SysTick's instant: outputs of the tick before act, the device moves on, inputs are set. */
static void on_instant(void *ctx)
{
    struct machine *m = loop.m;
    struct exh_drive_out out;
    struct exh_glove_in glove;
    (void)ctx;
    if (!loop.begun) { return; }
    if (!loop.ready) {
        if (loop.show_words) { loop.show_words((const char *)m->ctx); }
        start_device();
    }
    if (loop.open) {
        board_get(&loop.board, &m->s, &out);
        loop.last = out;
        (void)exh_board_write_drive(&out);
    }
    if (!loop.waits && loop.open && loop.r.missed++ == 0) { loop.r.first_missed = loop.r.ticks; }
    if (exh_board_wait() < 0 || loop.r.ticks >= loop.ticks_wanted) {
        machine_stop(m, M_DONE);
        return;
    }
    loop.before = loop.in;
    (void)exh_board_read_drive(&loop.in);
    if (!ref_held(&loop.cfg, loop.r.ticks)) { loop.in.din &= ~(uint32_t)EXH_DIN_DEADMAN; }
    loop.in.din &= ~loop.cut;
    board_put(&loop.board, &m->s, &loop.in);
    memcpy(loop.past[loop.instants++ % LOOP_PAST], loop.in.mon_raw, sizeof loop.past[0]);
    if (loop.cfg.board.glove && exh_board_read_glove(&glove) == 0) {
        memcpy(loop.board.glove, glove.raw, sizeof loop.board.glove);
    }
    if (loop.cfg.scene->link) { bring_link(); }
    loop.open = 1;
    if (!loop.waits) { return; } /* the tick before goes on */
    loop.waits = 0;
    cost_begin(&m->cost);
    loop.at_insns = m->insns;
    loop.at_cycles = m->cycles;
    loop.at_least = m->least;
    loop.at_accesses = m->s.accesses;
}

/* --- the twin --- */

static void start_twin(void)
{
    const struct exh_scene *sc = loop.cfg.scene;
    const uint32_t info = hil_symbol((const char *)loop.m->ctx, "exh_board_info");
    const struct exh_scene_board b = {loop.T, (uint8_t)(machine_word(loop.m, info + 4) >> 24)};
    if (ref_parameters(&loop.cfg) < 0) {
        machine_broke(loop.m, "the scene refuses its parameters");
    }
    if (sc->apply) { (void)sc->apply(sc->params); }
    if (sc->setup(b) < 0) { machine_broke(loop.m, "the scene refuses its set-up"); }
    if (sc->params) { sc->params->locked = 1; }
}

/* The port must read the signals at its pins: counts exactly, codes to a step of 12 bits of those
 * within the last ticks. */
static void check_inputs(const struct exh_scene_in *in)
{
    for (unsigned i = 0; i < loop.cfg.scene->fingers; i++) {
        int low = INT16_MAX, high = INT16_MIN;
        for (unsigned k = 0; k < LOOP_PAST; k++) {
            const int was = loop.past[k][i];
            low = was < low ? was : low;
            high = was > high ? was : high;
        }
        if (!loop.r.missed || in->drive.enc_raw[i] != (loop.before.enc_raw[i] & 0xFFFF)) {
            differs("encoder read", i, in->drive.enc_raw[i], loop.in.enc_raw[i] & 0xFFFF);
        }
        if (in->drive.mon_raw[i] < low - 16 || in->drive.mon_raw[i] > high + 16) {
            differs("monitor", i, in->drive.mon_raw[i], loop.in.mon_raw[i]);
        }
    }
    differs("contacts", 0, in->drive.din, loop.in.din);
}

static void run_twin(const struct exh_scene_in *in)
{
    const struct exh_scene *sc = loop.cfg.scene;
    if (loop.r.ticks == 0) { start_twin(); }
    if (sc->link) {
        const uint32_t link = machine_word(loop.m, loop.scene + LINK);
        const uint8_t *mail =
            machine_at(loop.m, machine_word(loop.m, link + MAIL_IN), sizeof *sc->link->in);
        if (mail) { memcpy(sc->link->in, mail, sizeof *sc->link->in); }
    }
    sc->tick(in, &loop.twin);
}

/* tick(in, out) is called. */
static void on_tick(struct machine *m)
{
    const uint8_t *in = machine_at(m, machine_reg(m, UC_ARM_REG_R0), sizeof loop.seen);
    static int watched;
    if (loop.ticking || loop.quiet || in == NULL) { return; }
    loop.ticking = 1;
    loop.out = machine_reg(m, UC_ARM_REG_R1);
    memcpy(&loop.seen, in, sizeof loop.seen);
    if ((int64_t)loop.r.ticks == loop.spoil) { loop.seen.drive.enc_raw[0]++; }
    /* Late, it may have read before or behind an instant. */
    if (loop.r.missed != loop.missed || loop.seen.missed) { loop.calm = loop.r.ticks + CALM; }
    loop.missed = loop.r.missed;
    if (loop.r.ticks >= loop.calm) { check_inputs(&loop.seen); }
    run_twin(&loop.seen);
    if (!watched) {
        extern machine_watch_fn loop_on_back;
        loop.back = machine_reg(m, UC_ARM_REG_LR);
        machine_watch(m, loop.back, loop_on_back);
        watched = 1;
    }
}

static void compare_signals(struct machine *m)
{
    const struct exh_scene *sc = loop.cfg.scene;
    const uint32_t n = exh_signal_count(sc->signals), values = machine_word(m, loop.scene + VALUES);
    const int32_t *mine = exh_scene_signals(sc);
    for (uint32_t i = 0; i < n; i++) {
        uint16_t instance;
        const struct exh_signal *row = exh_signal_at(sc->signals, i, &instance);
        differs(row->name, instance, (int32_t)machine_word(m, values + 4 * i), mine[i]);
    }
}

void loop_on_back(struct machine *m);
void loop_on_back(struct machine *m)
{
    const uint8_t *at = machine_at(m, loop.out, sizeof loop.last);
    struct exh_drive_out out;
    if (!loop.ticking) { return; }
    if (!loop.shown && loop.show) { /* a tick does not fill in signals */
        loop.shown = 1;
        machine_call(m, loop.show);
        return;
    }
    loop.shown = loop.ticking = 0;
    if (at == NULL) { return; }
    memcpy(&out, at, sizeof out);
    differs("enable", 0, out.enable, loop.twin.enable);
    differs("alive", 0, out.alive, loop.twin.alive);
    for (unsigned i = 0; i < loop.cfg.scene->fingers; i++) {
        differs("code", i, out.dac_raw[i], loop.twin.dac_raw[i]);
    }
    compare_signals(m);
}

/* The loop has done all of a tick: the pins must equal the twin. */
static void end_tick(struct machine *m)
{
    struct loop_result *r = &loop.r;
    const uint64_t cycles = m->cycles - loop.at_cycles, least = m->least - loop.at_least;
    struct exh_drive_out out;
    int pulls = 0;
    board_get(&loop.board, &m->s, &out);
    differs("drives at the pins", 0, out.enable, loop.twin.enable);
    for (unsigned i = 0; i < loop.cfg.scene->fingers; i++) {
        /* to half a step of the D/A's, 305 uV */
        const int64_t off_uV =
            da_uV(&loop.board.da, i) - ((int64_t)loop.twin.dac_raw[i] - 32768) * 1000000 / 3249;
        if (off_uV > 165 || off_uV < -165) { differs("uV off at the D/A", i, off_uV, 0); }
        pulls |= out.dac_raw[i] != 32768;
    }
    r->running += out.enable != 0;
    r->pulling += pulls != 0;
    r->differ += loop.differs;
    loop.differs = 0;
    r->ticks++;
    if (r->ticks == 1) { return; } /* set-up ends in it */
    r->insns += m->insns - loop.at_insns;
    r->cycles += cycles;
    r->least += least;
    r->accesses += m->s.accesses - loop.at_accesses;
    if (r->ticks - 2 < LOOP_KEEPS) {
        r->kept[r->ticks - 2] = (uint32_t)cycles;
        r->fewest[r->ticks - 2] = (uint32_t)least;
    }
    if (cycles > r->most_cycles) {
        cost_keep(&m->cost);
        r->dearest = r->ticks - 1;
        r->most_cycles = (uint32_t)cycles;
        r->most_insns = (uint32_t)(m->insns - loop.at_insns);
        r->most_accesses = (uint32_t)(m->s.accesses - loop.at_accesses);
    }
}

static void on_wait(struct machine *m)
{
    if (loop.open && !loop.waits) { end_tick(m); }
    loop.waits = loop.begun = 1;
}

/* exh_loop(scene, rate, hooks): parameters that flash would have kept. */
static void on_loop(struct machine *m)
{
    const struct exh_params *p = loop.cfg.scene->params;
    const uint32_t params = machine_word(m, loop.scene + PARAMS);
    const uint32_t staged = machine_word(m, params + STAGED);
    const int refused = ref_parameters(&loop.cfg) < 0;
    const uint32_t size = exh_signal_count(p->table) * (uint32_t)sizeof p->staged[0];
    uint8_t *to = machine_at(m, staged, size), *pending = machine_at(m, params + PENDING, 1);
    if (loop.rate_Hz) { machine_set_reg(m, UC_ARM_REG_R1, loop.rate_Hz); }
    if (refused || to == NULL || pending == NULL) {
        machine_broke(m, "the scene's parameters cannot be staged");
        return;
    }
    memcpy(to, p->staged, size);
    *pending = 1;
}

static void on_halt(struct machine *m) { machine_stop(m, M_HALTED); }

int loop_open(struct machine *m, const char *image, uint64_t seed)
{
    char symbol[64] = "exh_scene_*";
    loop.m = m;
    m->ctx = (void *)(uintptr_t)image;
    if (machine_open(m, image) < 0) { return -1; }
    loop.scene = hil_symbol_name(image, symbol, sizeof symbol);
    if (loop.scene == 0 || setup_for(&loop.cfg, symbol, seed, UINT32_MAX - 1) < 0) {
        fprintf(stderr, "stm32f405: %s: no scene that runs closed-loop\n", image);
        return -1;
    }
    loop.tick = machine_word(m, loop.scene + TICK);
    loop.show = machine_word(m, loop.scene + SHOW);
    board_open(&loop.board, &m->s);
    stm_outside.tick = on_instant;
    board_sent = on_sent;
    machine_watch(m, loop.tick, on_tick);
    machine_watch(m, hil_symbol(image, "exh_board_wait"), on_wait);
    machine_watch(m, hil_symbol(image, "exh_loop"), on_loop);
    machine_watch(m, hil_symbol(image, "stm_halted"), on_halt);
    return m->end == M_BROKEN ? -1 : 0;
}

void loop_run(void)
{
    stm_reset(&loop.m->s, STM_POWER_ON);
    machine_boot(loop.m);
    (void)machine_run(loop.m);
}
