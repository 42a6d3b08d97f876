/* SPDX-License-Identifier: MIT */
/* Where each fault comes from: contacts, encoder, monitor, D/A, glove, cards, link, time, memory.
 */
#include "lab/faults/faults.h"

#include "posix.h"

#include "sim/random.h"

#include "exhand/board.h"
#include "exhand/error.h"

#include <string.h>

#define SENSOR 5 /* one that moves the index */

struct on {
    struct faults_what what;
    uint32_t from_tick, to_tick; /* first tick that can see it, first that can't */
    int64_t moved_cnt;           /* what is added to the encoder */
    uint32_t enc_raw;            /* its count */
    struct exh_drive_out out;    /* what the D/A holds */
    int begun;
};

static struct {
    const struct faults_base *base; /* NULL: nothing is wrong */
    struct sim_device device;
    struct on on[2];
    uint32_t tick; /* that is to come */
    uint32_t gone; /* ticks of a dead loop */
    double fed_s;  /* the watchdog's */
    uint8_t alive, fired, dead;
    struct exh_drive_in in;   /* the last, of a device with nothing wrong */
    struct exh_drive_out out; /* and what it was given */
} src;

static double period_s(void) { return 1.0 / src.base->rate_Hz; }

/* Of the how of a fault, 0 <= u < 1, its n-th; how 0: the middle. */
static double chance(const struct on *o, int n)
{
    struct sim_random r = {o->what.how};
    double u = 0;
    if (o->what.how == 0) { return 0.5; }
    for (int i = 0; i <= n; i++) { u = sim_random_unit(&r); }
    return u;
}

static int way(const struct on *o) { return o->what.how & 1 ? -1 : 1; }

static int is_on(const struct on *o)
{
    return src.base && o->what.source && src.tick >= o->from_tick && src.tick < o->to_tick;
}

/* --- on the wires to the box --- */

/* String per tick to counts. */
static double counts(double mps)
{
    return mps * period_s() / (src.device.step_m / src.device.decode);
}

/* Two ticks out, two in, at 1 m/s, and as far as moves a current: the spring is a tick late, and so
 * drives it. */
static int64_t swing(const struct on *o)
{
    const double by_speed = counts(0.5), least = counts(0.1e-3 / period_s());
    const double far = by_speed > least ? by_speed : least;
    return (int64_t)((src.tick - o->from_tick) / 2 % 2 ? -far : far);
}

static void encoder(struct on *o, uint32_t *enc_raw)
{
    if (!o->begun) { o->enc_raw = src.in.enc_raw[faults_finger(src.base->scene)]; }
    if (o->what.source == FAULTS_STILL) { *enc_raw = o->enc_raw; }
    if (o->what.source == FAULTS_JUMP && !o->begun) {
        o->moved_cnt = (int64_t)(way(o) * counts(10) * (1.5 + 3 * chance(o, 0))) + 300 * way(o);
    }
    if (o->what.source == FAULTS_SPEED) {
        o->moved_cnt += (int64_t)(way(o) * counts(4 + 4 * chance(o, 0)));
    }
    if (o->what.source == FAULTS_CHATTER) { o->moved_cnt = swing(o); }
    *enc_raw = (uint32_t)((int64_t)*enc_raw + o->moved_cnt) & 0xFFFFFF;
}

static void contact(const struct on *o, uint32_t *din)
{
    switch (o->what.source) {
    case FAULTS_ESTOP: *din &= ~(uint32_t)EXH_DIN_ESTOP; break;
    case FAULTS_DEADMAN: *din &= ~(uint32_t)EXH_DIN_DEADMAN; break;
    case FAULTS_WATCHDOG: *din &= ~(uint32_t)EXH_DIN_WATCHDOG; break;
    case FAULTS_DRIVE: *din &= ~((uint32_t)EXH_DIN_DRIVE0 << faults_finger(src.base->scene)); break;
    case FAULTS_CARD:
        if (!src.base->cards) { *din &= ~(uint32_t)EXH_DIN_CARDS; }
        break;
    default: break;
    }
}

static void analog(const struct on *o, int16_t *mon_raw, int16_t *supply_raw)
{
    const double mon = *mon_raw + way(o) * (0.4 + 1.2 * chance(o, 0)) / src.device.mon_apc;
    if (o->what.source == FAULTS_MONITOR) {
        *mon_raw = (int16_t)(mon > 32767 ? 32767 : mon < -32768 ? -32768 : mon);
    }
    if (o->what.source == FAULTS_SUPPLY_LOW) { *supply_raw = (int16_t)(*supply_raw / 2); }
    if (o->what.source == FAULTS_SUPPLY_HIGH) { *supply_raw = (int16_t)(*supply_raw / 2 * 3); }
}

void faults_wires_in(struct exh_drive_in *in)
{
    const struct exh_drive_in well = *in;
    if (src.base == NULL) {
        src.in = well;
        return;
    }
    for (unsigned k = 0; k < 2; k++) {
        struct on *o = &src.on[k];
        const unsigned f = faults_finger(src.base->scene);
        if (!is_on(o)) {
            if (o->begun) {
                in->enc_raw[f] = (uint32_t)((int64_t)in->enc_raw[f] + o->moved_cnt) & 0xFFFFFF;
            }
            continue;
        }
        contact(o, &in->din);
        encoder(o, &in->enc_raw[f]);
        analog(o, &in->mon_raw[f], &in->supply_raw);
        if (!o->begun) { o->out = src.out; }
        o->begun = 1;
    }
    if (src.fired) { in->din &= ~(uint32_t)EXH_DIN_WATCHDOG; }
    src.in = well;
}

/* --- on the wires to the device --- */

void faults_wires_out(struct exh_drive_out *out)
{
    if (out->alive != src.alive) { src.fed_s = posix_time_s(); }
    src.alive = out->alive;
    src.out = *out;
    for (unsigned k = 0; k < 2; k++) {
        const struct on *o = &src.on[k];
        if (!is_on(o) || o->what.source != FAULTS_DA || !o->begun) { continue; }
        memcpy(out->dac_raw, o->out.dac_raw, sizeof out->dac_raw);
    }
    if (src.fired) { out->enable = 0; }
}

/* --- time --- */

uint32_t faults_late(uint64_t tick)
{
    uint32_t missed = 0;
    (void)tick;
    if (src.dead) { return 0; } /* there is no loop that could be late */
    for (unsigned k = 0; k < 2; k++) {
        const struct on *o = &src.on[k];
        if (!is_on(o)) { continue; }
        if (o->what.source == FAULTS_LATE && src.tick == o->from_tick) {
            missed += 2 + (uint32_t)(2 * chance(o, 0));
        }
        if (o->what.source == FAULTS_SLOW) { missed += (src.tick - o->from_tick) % 2; }
    }
    return missed;
}

/* The loop is dead: the board's time goes on, and the watchdog is not fed. The watchdog, set to two
 * and a half periods, then disables the drives. */
static void dead(const struct on *o)
{
    const uint32_t ticks = 6 + (uint32_t)((FAULTS_DEAD_TICKS - 6) * chance(o, 0));
    src.dead = 1;
    for (uint32_t k = 0; k < ticks; k++) {
        (void)exh_board_wait();
        if (!src.fired && posix_time_s() - src.fed_s > 2.5 * period_s()) {
            src.fired = 1;
            exh_board_safe();
        }
        faults_dead_tick(src.fed_s);
    }
    src.dead = 0;
    src.gone += ticks;
}

/* --- cards, glove, link, memory: what is done once --- */

/* From its next access on. */
static void lose_card(const struct on *o)
{
    struct emu_box *box = posix_cards_box();
    if (!src.base->cards) { return; }
    if (box->wrong) { return; } /* one that is dead stays so, and with it the run ends */
    memset(&box->fault, 0, sizeof box->fault);
    memset(box->in_phase, 0, sizeof box->in_phase);
    box->fault.kind = EMU_ABSENT;
    box->fault.card = (uint8_t)(src.base->scene == FAULTS_BILATERAL && o->what.how >> 1 & 1);
    box->fault.phase = (uint8_t)(o->what.how >> 2 & 1 ? EMU_PHASE_WRITE : EMU_PHASE_READ);
}

#define AHEAD_TICKS 8u /* until it comes to the parameter */

static uint32_t bit_at(uint32_t size_B, uint32_t how) { return (how >> 3) % size_B; }

static uint32_t offset_in_area(const struct faults_memory *m, uint32_t how)
{
    return (uint32_t)((const uint8_t *)m->cal - (const uint8_t *)m->area) + bit_at(m->cal_B, how);
}

uint32_t faults_source_ahead(unsigned scene, unsigned source, uint32_t how)
{
    const struct faults_memory m = faults_memory((uint8_t)scene);
    if (source == FAULTS_PAR) { return AHEAD_TICKS; }
    return (m.area_B + 7) / 8 - offset_in_area(&m, how) / EXH_INTEGRITY_B - 1;
}

/* As if it had been sealed so much earlier: it goes on until it is there. */
static void place_guard(const struct faults_memory *m, const struct faults_what *w)
{
    const int passed = w->place == FAULTS_PASSED;
    const uint32_t part = offset_in_area(m, w->how) / EXH_INTEGRITY_B + (passed ? 1 : 0);
    const uint32_t pairs = m->pars / EXH_INTEGRITY_WORDS, pair = bit_at(m->pars * 4u, w->how) / 8;
    const uint32_t to = (passed ? pair + 1 : pair + pairs - AHEAD_TICKS) % pairs;
    if (w->place == FAULTS_ANYWHERE) { return; }
    for (uint32_t k = 0; k < 2 * (m->area_B + m->pars); k++) {
        if (w->source == FAULTS_CAL ? m->guard->at == part * EXH_INTEGRITY_B % m->area_B
                                    : m->guard->params->at == to * EXH_INTEGRITY_WORDS) {
            return;
        }
        (void)exh_integrity_step(m->guard);
    }
}

static void flip(void *memory, uint32_t size_B, uint32_t how)
{
    uint8_t *byte = memory;
    byte[bit_at(size_B, how)] ^= (uint8_t)(1u << (how & 7));
}

/* The next bit whose flip leaves its parameter in its row's range. A window longer than its memory,
 * for example, would end the process immediately. */
static uint32_t spanned(const struct faults_memory *m, uint32_t how)
{
    for (uint32_t k = 0; k < m->pars * 32u; k++, how++) {
        const uint32_t byte = bit_at(m->pars * 4u, how);
        const struct exh_signal *row = exh_signal_at(m->table, byte / 4, NULL);
        int32_t raw = m->par[byte / 4];
        ((uint8_t *)&raw)[byte % 4] ^= (uint8_t)(1u << (how & 7));
        if (raw >= row->min && raw <= row->max) { break; }
    }
    return how;
}

const struct exh_signal *faults_source_row(void)
{
    for (unsigned k = 0; k < 2; k++) {
        const struct on *o = &src.on[k];
        if (o->what.source == FAULTS_PAR && o->begun) {
            const struct faults_memory m = faults_memory(src.base->scene);
            return exh_signal_at(m.table, bit_at(m.pars * 4u, o->what.how) / 4, NULL);
        }
    }
    return NULL;
}

static void do_once(struct on *o)
{
    const struct faults_memory m = faults_memory(src.base->scene);
    if (o->what.source == FAULTS_PAR) { o->what.how = spanned(&m, o->what.how); }
    if (faults_is_memory(o->what.source)) { place_guard(&m, &o->what); }
    switch (o->what.source) {
    case FAULTS_GLOVE: posix_glove()->fault[SENSOR] = SIM_GLOVE_OPEN; break;
    case FAULTS_GLOVE_OLD: posix_glove_stop(); break;
    case FAULTS_CARD: lose_card(o); break;
    case FAULTS_LINK: posix_link()->way[SIM_LINK_IN].par.loss = 1; break;
    case FAULTS_DEAD_LOOP: dead(o); break;
    case FAULTS_PAR:
        flip(m.par, m.pars * 4u, o->what.how);
        o->begun = 1;
        break;
    case FAULTS_CAL: flip(m.cal, m.cal_B, o->what.how); break;
    case FAULTS_STATE: m.safety->state = (uint8_t)(200 + o->what.how % 56); break;
    default: break;
    }
}

/* --- the branch's --- */

void faults_source_start(
    const struct faults_base *b, const struct faults_what what[2], uint32_t tick)
{
    src.base = b;
    src.device = sim_device_default();
    src.tick = tick + 1;
    for (unsigned k = 0; k < 2; k++) {
        struct on *o = &src.on[k];
        memset(o, 0, sizeof *o);
        o->what = what[k];
        o->from_tick = src.tick + what[k].after_ticks;
        o->to_tick = what[k].for_ticks ? o->from_tick + what[k].for_ticks : UINT32_MAX;
        if (what[k].source && what[k].after_ticks == 0) { do_once(o); }
    }
}

void faults_source_step(uint32_t tick)
{
    src.tick = tick + 1;
    for (unsigned k = 0; k < 2; k++) {
        struct on *o = &src.on[k];
        if (o->what.source && o->what.after_ticks && o->from_tick == src.tick) { do_once(o); }
    }
}

uint32_t faults_source_gone(void)
{
    const uint32_t gone = src.gone;
    src.gone = 0;
    return gone;
}

int faults_source_off(void)
{
    int off = 0;
    for (unsigned k = 0; k < 2; k++) {
        off |= src.on[k].what.source == FAULTS_OFF && src.tick == src.on[k].from_tick;
    }
    return off && src.base != NULL;
}
