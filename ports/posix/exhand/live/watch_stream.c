/* SPDX-License-Identifier: MIT */
/* The log of a box, as it comes over the network: each frame has every signal. */
#include "live/watch.h"

#include "base/key.h"
#include "base/option.h"
#include "udp.h"
#include "base/until.h"

#include "box/pieces.h"

#include "exhand/error.h"
#include "exhand/fix.h"

#include <errno.h>
#include <poll.h>
#include <string.h>

#define BUFFER_B (65536u + STREAM_PIECE_B)
#define NEW_S    2.0 /* silence after which another or a restarted box may begin */

static struct {
    struct udp udp;
    struct pieces pieces;
    struct sockaddr_in peer;
    struct exh_mac_key key;
    uint64_t end; /* of the log, of the byte behind the last */
    double heard_s;
    uint8_t byte[BUFFER_B]; /* not yet records */
    uint32_t n;
} in;

int watch_stream_open(const char *at, const char *peer, const char *key)
{
    if (key && key_read(key, &in.key)) { return 2; }
    if (peer != NULL && udp_open(&in.udp, "0.0.0.0:0", peer) < 0) {
        cli_complain("--peer: %s: %s: give ADDRESS:PORT of the box", peer, strerror(errno));
        return 2;
    }
    if (peer != NULL) {
        in.peer = in.udp.peer;
        udp_close(&in.udp);
    }
    pieces_open(&in.pieces, peer ? &in.peer : NULL, key ? &in.key : NULL);
    if (udp_open(&in.udp, at, NULL) == 0) { return 0; }
    cli_complain("--listen: %s: %s: give ADDRESS:PORT of this machine", at, strerror(errno));
    return 2;
}

void watch_stream_close(void)
{
    udp_close(&in.udp);
    pieces_complain(&in.pieces, in.udp.bad_length);
}

/* --- records --- */

static int on_header(struct watch_box *b, const struct exh_record *r)
{
    struct exh_bytes c = exh_bytes_reader(r->payload, r->len_B);
    struct exh_record_header h;
    memset(&h, 0, sizeof h);
    exh_record_header_serialize(&c, &h);
    if (!exh_bytes_ok(&c) || !exh_period_ok(h.T)) { return 0; }
    h.scene[sizeof h.scene - 1] = '\0';
    b->T = h.T;
    return watch_scene(b, h.scene, h.signal_crc, h.signals);
}

/* All bits that any value of this name has. */
static uint32_t bits_of(const struct watch_box *b, const char *name)
{
    const struct exh_signal_table *t = b->scene->signals;
    const uint32_t n = exh_signal_count(t);
    uint32_t bits = 0;
    for (uint32_t i = 0; i < n; i++) {
        if (strcmp(exh_signal_at(t, i, NULL)->name, name) == 0) { bits |= (uint32_t)b->value[i]; }
    }
    return bits;
}

static int on_frame(struct watch_box *b, const struct exh_record *r, watch_fresh fresh)
{
    struct exh_bytes c = exh_bytes_reader(r->payload, r->len_B);
    struct exh_scene_in was;
    struct exh_drive_out out;
    if (b->scene == NULL) { return 0; } /* its header did not come */
    memset(&was, 0, sizeof was);
    exh_log_frame_serialize(&c, b->scene, &was, &out, b->value);
    if (!exh_bytes_ok(&c) || c.at != r->len_B) { return 0; }
    if (b->heard > 0 && r->tick - b->tick - 1 < UINT32_C(0x80000000)) {
        b->lost += r->tick - b->tick - 1;
    }
    b->tick = r->tick;
    b->state = (uint8_t)bits_of(b, "state");
    b->faults = bits_of(b, "faults");
    b->present = bits_of(b, "present");
    b->limits = bits_of(b, "limits");
    b->heard++;
    b->heard_s = until_now_s();
    return fresh(b);
}

/* Whole records at the start of the buffer; what is damaged is skipped. */
static int records(struct watch_box *b, watch_fresh fresh)
{
    uint32_t at = 0;
    int err = 0;
    while (err == 0 && at < in.n) {
        struct exh_record r;
        const int32_t len = exh_record_decode(in.byte + at, in.n - at, &r);
        if (len == -EXH_E_SHORT && in.n - at < BUFFER_B - STREAM_DATA_B) { break; }
        at += len > 0 ? (uint32_t)len : 1;
        if (len <= 0) { continue; }
        if (r.type == EXH_RECORD_HEADER) { err = on_header(b, &r); }
        if (r.type == EXH_RECORD_FRAME) { err = on_frame(b, &r, fresh); }
        if (r.type == EXH_RECORD_END) { b->ended = 1; }
    }
    in.n -= at;
    memmove(in.byte, in.byte + at, in.n);
    return err;
}

/* --- pieces --- */

static void add(const uint8_t *byte, uint32_t n)
{
    if (n == 0) { return; }
    memcpy(in.byte + in.n, byte, n);
    in.n += n;
}

/* Takes the pieces in their order. It does not wait for a late one. */
static int take(struct watch_box *b, const struct pieces_part *part, watch_fresh fresh)
{
    if (part->more) { /* a log begins */
        in.n = 0;
        in.end = 0;
        b->heard = 0;
        b->ended = 0;
    }
    if (part->at < in.end) { return 0; }
    if (part->at != in.end) { in.n = 0; }
    in.heard_s = until_now_s();
    in.end = part->at + part->n + part->more_n;
    add(part->byte, part->n);
    add(part->more, part->more_n);
    b->trouble = NULL;
    return records(b, fresh);
}

/* After a long silence, another or a restarted box may begin; counts of foreign packets stay. */
static void let_others(void)
{
    struct pieces *p = &in.pieces;
    const uint64_t foreign = p->foreign;
    struct pieces_source source[PIECES_SOURCES];
    if (!p->begun || until_now_s() - in.heard_s < NEW_S) { return; }
    memcpy(source, p->source, sizeof source);
    pieces_open(p, p->given ? &in.peer : NULL, p->key);
    memcpy(p->source, source, sizeof source);
    p->foreign = foreign;
}

int watch_stream_look(struct watch_box *b, double until_s, watch_fresh fresh)
{
    uint8_t datagram[STREAM_PIECE_B];
    struct pollfd f = {in.udp.fd, POLLIN, 0};
    const double left_s = until_s - until_now_s();
    int err = 0, n;
    (void)poll(&f, 1, left_s > 0 ? 1 + (int)(1000 * left_s) : 0);
    while (err == 0 && (n = udp_recv(&in.udp, datagram, sizeof datagram)) > 0) {
        struct pieces_part part;
        let_others();
        if (pieces_take(&in.pieces, &in.udp.from, datagram, (size_t)n, &part)) {
            err = take(b, &part, fresh);
        } else if (!in.pieces.begun && b->scene == NULL) {
            b->trouble = "no header of a log came yet, which names the scene: it comes every "
                         "4096 ticks";
        }
        if (until_now_s() > until_s + 0.2) { break; } /* the picture, too, wants to be drawn */
    }
    return err;
}
