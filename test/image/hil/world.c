/* SPDX-License-Identifier: MIT */
#include "world.h"

#include "exhand/board.h"

#include <string.h>

/* Offsets in a 32-bit struct exh_scene, and in its struct exh_params. */
enum { SCENE_PARAMS = 12, SCENE_SIGNAL = 20 };
enum { PARAMS_STAGED = 8, PARAMS_PENDING = 13 };

/* --- comparing --- */

static void differs(struct world *w, const char *what, unsigned i, int64_t image, int64_t posix)
{
    struct world_result *r = &w->result;
    if (image == posix) { return; }
    w->differs = 1;
    if (r->what[0] == 0) {
        r->first = w->ticks - 1;
        snprintf(r->what, sizeof r->what, "%s %u: %lld on pc104, %lld on posix", what, i,
            (long long)image, (long long)posix);
    }
}

static void compare_outputs(struct world *w, const struct exh_drive_out *out)
{
    const struct exh_drive_out *ref = &w->now.tick.out;
    const unsigned fingers = w->ref_cfg.scene->fingers;
    int pulls = 0;
    differs(w, "enable", 0, out->enable, ref->enable);
    differs(w, "alive", 0, out->alive, ref->alive & 1);
    for (unsigned i = 0; i < fingers; i++) {
        differs(w, "dac", i, out->dac_raw[i], ref->dac_raw[i]);
        pulls |= out->dac_raw[i] != 32768;
    }
    w->result.digest[0] =
        exh_crc32(w->result.digest[0], out->dac_raw, fingers * sizeof out->dac_raw[0]);
    w->result.digest[1] =
        exh_crc32(w->result.digest[1], ref->dac_raw, fingers * sizeof ref->dac_raw[0]);
    w->result.running += out->enable != 0;
    w->result.pulling += pulls != 0;
}

static void compare_signals(struct world *w)
{
    const struct exh_scene *sc = w->ref_cfg.scene;
    const uint32_t at = hil_word(w->h, w->scene + SCENE_SIGNAL), n = exh_signal_count(sc->signals);
    int32_t signal[REF_SIGNALS];
    if (at > HIL_RAM_B - sizeof signal) {
        differs(w, "signals", 0, at, 0);
        return;
    }
    memcpy(signal, &w->h->ram[at], n * sizeof signal[0]);
    for (uint32_t i = 0; i < n; i++) {
        uint16_t instance;
        const struct exh_signal *row = exh_signal_at(sc->signals, i, &instance);
        differs(w, row->name, instance, signal[i], w->now.signal[i]);
    }
    w->result.digest[0] = exh_crc32(w->result.digest[0], signal, n * sizeof signal[0]);
    w->result.digest[1] = exh_crc32(w->result.digest[1], w->now.signal, n * sizeof signal[0]);
}

static void compare_packets(struct world *w)
{
    if (w->ref_cfg.scene->link == NULL) { return; }
    differs(w, "packets out", 0, w->sent, w->now.mail_out.packets);
    differs(w, "packets in", 0, w->received, w->now.mail_in.packets);
}

/* The tick under way is over: what it put out goes to the drives. */
static void end_tick(struct world *w)
{
    struct exh_drive_out out;
    if (!w->open) { return; }
    w->open = 0;
    box_get(w->box, &out);
    w->result.ticks++;
    compare_outputs(w, &out);
    compare_signals(w);
    compare_packets(w);
    w->result.differ += w->differs != 0;
    w->differs = 0;
    (void)exh_board_write_drive(&out);
}

/* --- the device --- */

static void start(struct world *w)
{
    struct exh_period T = w->ref_cfg.board.T;
    struct posix_config alone = w->ref_cfg.board;
    memset(&w->result, 0, sizeof w->result);
    w->ref = ref_start(&w->ref_cfg);
    alone.line.on = 0; /* the link's packets come to the reference */
    posix_configure(&alone);
    w->broken = w->ref == NULL || exh_board_init(1, &T) < 0;
}

static void stop(struct world *w)
{
    ref_stop(w->ref);
    w->ref = NULL;
    w->ticks = 0;
    w->open = 0;
}

/* The image asks for the glove's samples: converted now, if they were not yet in this tick. */
static void on_glove(void *ctx)
{
    struct world *w = ctx;
    struct exh_glove_in in;
    if (!w->open || w->gloved) { return; }
    w->gloved = 1;
    if (exh_board_read_glove(&in) == 0) { box_put_glove(w->box, in.raw); }
}

/* --- parameters and packets --- */

void world_parameters(struct world *w)
{
    const struct exh_params *p = w->ref_cfg.scene->params;
    const uint32_t params = hil_word(w->h, w->scene + SCENE_PARAMS);
    const uint32_t staged = hil_word(w->h, params + PARAMS_STAGED);
    const size_t size = exh_signal_count(p->table) * sizeof p->staged[0];
    if (ref_parameters(&w->ref_cfg) < 0 || staged > HIL_RAM_B - size) {
        hil_broke(w->h, "the scene's parameters cannot be staged");
        return;
    }
    memcpy(&w->h->ram[staged], p->staged, size);
    w->h->ram[params + PARAMS_PENDING] = 1;
}

/* The buffer of a call (buffer, bytes), or NULL: it is nowhere. */
static uint8_t *argument(struct world *w, uint32_t *n)
{
    const uint32_t sp = hil_reg(w->h, UC_X86_REG_ESP), at = hil_word(w->h, sp + 4);
    *n = hil_word(w->h, sp + 8);
    return at < HIL_RAM_B && *n <= HIL_RAM_B - at ? &w->h->ram[at] : NULL;
}

void world_recv(struct world *w)
{
    const struct exh_scene_mail *mail = &w->now.mail_in;
    const unsigned i = w->received;
    uint32_t room;
    uint8_t *to = argument(w, &room);
    if (!w->open || to == NULL || i >= mail->packets || mail->len_B[i] > room) {
        hil_return(w->h, 0);
        return;
    }
    memcpy(to, mail->byte[i], mail->len_B[i]);
    w->received++;
    w->result.packets++;
    hil_return(w->h, mail->len_B[i]);
}

void world_send(struct world *w)
{
    const struct exh_scene_mail *mail = &w->now.mail_out;
    const unsigned i = w->sent++;
    uint32_t n;
    const uint8_t *from = argument(w, &n);
    if (w->open && from && i < mail->packets) {
        differs(w, "length of packet", i, n, mail->len_B[i]);
        differs(w, "packet", i, exh_crc32(0, from, n), exh_crc32(0, mail->byte[i], mail->len_B[i]));
        w->result.packets++;
    }
    hil_return(w->h, n);
}

void world_open(struct world *w, struct hil *h, struct box *b, uint32_t scene)
{
    w->h = h;
    w->box = b;
    w->scene = scene;
    b->glove = on_glove;
    b->ctx = w;
}

void world_waits(struct world *w)
{
    w->begun = 1;
    end_tick(w);
}

void world_rewind(struct world *w)
{
    if (w->ticks) { stop(w); }
}

void world_instant(struct world *w)
{
    struct exh_drive_in in;
    if (!w->begun || w->broken) { return; }
    if (w->ref == NULL) { start(w); }
    end_tick(w);
    if (w->broken || exh_board_wait() < 0 || !ref_next(w->ref, &w->now)) {
        w->broken = 1;
        return;
    }
    (void)exh_board_read_drive(&in);
    if (!ref_held(&w->ref_cfg, w->ticks)) { in.din &= ~(uint32_t)EXH_DIN_DEADMAN; }
    if ((int64_t)w->ticks == w->spoil) { in.enc_raw[0]++; }
    box_put(w->box, &in);
    w->gloved = 0;
    w->received = w->sent = 0;
    w->open = 1;
    w->ticks++;
}

void world_close(struct world *w)
{
    end_tick(w);
    stop(w);
}
