/* SPDX-License-Identifier: MIT */
#define _FILE_OFFSET_BITS 64
/* exhand listen: the log of a box that sends it over UDP (log=udp), as a file. */
#include "base/cli.h"

#include "base/key.h"
#include "base/option.h"
#include "base/outfile.h"
#include "udp.h"
#include "base/until.h"
#include "posix.h"

#include "box/pieces.h"

#include <errno.h>
#include <inttypes.h>
#include <poll.h>
#include <stdio.h>
#include <string.h>

#define END_B (EXH_RECORD_OVERHEAD + 4u) /* the record that ends a log */

struct listen {
    const char *at, *peer, *key, *out;
    struct exh_mac_key secret;
    double silence_s, wait_s, heard_s;
    FILE *file;
    uint64_t bytes;
    int in_mid; /* it began before it was listened to */
    struct pieces pieces;
};

static int complain(const struct listen *l)
{
    cli_complain("--out: %s: can't be written: %s: make room or give another --out", l->out,
        strerror(errno));
    return 2;
}

static int put(struct listen *l, const uint8_t *byte, uint32_t n)
{
    l->bytes += n;
    return n > 0 && fwrite(byte, 1, n, l->file) != n;
}

/* What never comes stays zeros, which no reader takes for a record. */
static int take(struct listen *l, const struct udp *u, const uint8_t *datagram, size_t n)
{
    struct pieces_part part;
    if (!pieces_take(&l->pieces, &u->from, datagram, n, &part)) { return 0; }
    l->heard_s = until_now_s();
    l->in_mid |= part.more_n > 0 && part.n > 0;
    if (fseeko(l->file, (off_t)part.at, SEEK_SET) != 0 || put(l, part.byte, part.n) ||
        put(l, part.more, part.more_n)) {
        return complain(l);
    }
    return 0;
}

/* 1: what was written last is the record that ends a log. */
static int ends(struct listen *l)
{
    uint8_t byte[END_B];
    struct exh_record r;
    return l->pieces.end >= END_B &&
           fseeko(l->file, (off_t)(l->pieces.end - END_B), SEEK_SET) == 0 &&
           fread(byte, 1, END_B, l->file) == END_B && exh_record_decode(byte, END_B, &r) > 0 &&
           r.type == EXH_RECORD_END;
}

/* What is heard and not the log's is no reason to wait for longer. Never long: a signal may come
 * just before poll(). 0: it is over. */
static int wait_ms(const struct listen *l)
{
    const int begun = l->pieces.begun;
    const double most_s = l->pieces.ended ? 0.2 : begun ? l->silence_s : l->wait_s;
    const double left_s = most_s - (until_now_s() - l->heard_s);
    if (!begun && l->wait_s <= 0) { return 1000; }
    return left_s <= 0 ? 0 : left_s >= 1 ? 1000 : 1 + (int)(1000 * left_s);
}

static int go(struct listen *l, struct udp *u)
{
    uint8_t datagram[STREAM_PIECE_B];
    struct pollfd f = {u->fd, POLLIN, 0};
    int err = 0;
    while (err == 0 && !posix_interrupted() && !(l->pieces.ended && l->pieces.missing == 0)) {
        const int ms = wait_ms(l);
        int n;
        if (ms == 0) { break; }
        (void)poll(&f, 1, ms);
        while (err == 0 && (n = udp_recv(u, datagram, sizeof datagram)) > 0) {
            err = take(l, u, datagram, (size_t)n);
        }
    }
    return err;
}

static int report(const struct listen *l, uint64_t bad_length, int ended)
{
    const struct pieces *p = &l->pieces;
    pieces_complain(p, bad_length);
    if (!p->begun) {
        cli_complain("--at: %s: nothing of a log came%s: is it the box's log_port=, and this "
                     "machine its peer=?",
            l->at, posix_interrupted() ? "" : " in time");
        return 1;
    }
    printf("%s: %" PRIu64 " bytes in %" PRIu64 " pieces; missing %" PRIu64 ", late %" PRIu64
           ", twice %" PRIu64 ", not the log's %" PRIu64 "; %s%s\n",
        l->out, l->bytes, p->pieces, p->missing, p->late, p->twice,
        p->foreign + p->damaged + p->old + p->beyond + p->keyed + p->no_key + p->other_key +
            bad_length,
        l->in_mid ? "it begins in mid-run, at a keyframe; " : "",
        !p->ended ? "its end did not come"
        : ended   ? "its end came"
                  : "its end came, but not the record that ends a log");
    return p->ended && ended && p->missing == 0 ? 0 : 1;
}

static int open_line(struct listen *l, struct udp *u)
{
    struct udp to;
    if (l->peer != NULL) {
        if (udp_open(&to, "0.0.0.0:0", l->peer) < 0) {
            cli_complain("--peer: %s: %s: give ADDRESS:PORT of the box", l->peer, strerror(errno));
            return 2;
        }
        udp_close(&to);
    }
    if (l->key && key_read(l->key, &l->secret)) { return 2; }
    pieces_open(&l->pieces, l->peer ? &to.peer : NULL, l->key ? &l->secret : NULL);
    if (udp_open(u, l->at, NULL) == 0) { return 0; }
    cli_complain("--at: %s: %s: give ADDRESS:PORT of this machine", l->at, strerror(errno));
    return 2;
}

int cli_listen(int argc, char **argv)
{
    struct listen l = {.at = "0.0.0.0:4748", .silence_s = 5};
    const struct cli_option option[] = {
        {"at", CLI_TEXT, &l.at, 0, 0, "ADDRESS:PORT", "where the box sends its log (0.0.0.0:4748)"},
        {"peer", CLI_TEXT, &l.peer, 0, 0, "ADDRESS:PORT",
            "the box, as it sends (whoever sends the first whole header)"},
        {"key", CLI_TEXT, &l.key, 0, 0, "FILE",
            "of the box, 32 hexadecimal digits (pc104: key=): no other's pieces are taken"},
        {"out", CLI_TEXT, &l.out, 0, 0, "FILE", "the log, for `exhand replay` and `exhand csv`"},
        {"silence", CLI_REAL, &l.silence_s, 0.1, 1e6, "S",
            "once it began, so much of it is its end (5)"},
        {"wait", CLI_REAL, &l.wait_s, 0, 1e6, "S",
            "nothing for so long before it begins ends it, status 1 (0: waits for ever)"},
    };
    const struct cli_command c = {"listen", "--out FILE [options]",
        "The log of a box that sends it over UDP (pc104: log=udp), until its end or Ctrl-C.\n"
        "Lost packets are reported, and readers skip them. A late start gives the log from a "
        "later\n"
        "keyframe on.",
        option, (int)(sizeof option / sizeof option[0]), 0};
    struct udp u;
    int ended = 0, err = cli_parse(&c, argc, argv, NULL);
    if (err) { return err == 1 ? 0 : err; }
    if (l.out == NULL) {
        cli_complain("--out: is missing: give the file to be written");
        return 2;
    }
    if (open_line(&l, &u)) { return 2; }
    l.file = outfile_open("out", l.out);
    if (l.file == NULL) {
        err = 2;
    } else {
        until_catch(UNTIL_COMES_BACK);
        cli_complain("waits at %s for a log to begin (the box: log=udp or dump=udp)%s", l.at,
            l.wait_s > 0 ? "" : "; Ctrl-C or --wait ends it");
        l.heard_s = until_now_s();
        err = go(&l, &u);
        ended = err == 0 && ends(&l);
        if (outfile_end(l.file, err == 0 && l.bytes > 0) != 0) { err = 2; }
    }
    udp_close(&u);
    if (err) { return err; }
    err = report(&l, u.bad_length, ended);
    return posix_interrupted() ? 130 : err;
}
