/* SPDX-License-Identifier: MIT */
/* exhand listen: the log of a box that sends it over UDP (log=udp), as a file. */
#include "base/cli.h"

#include "base/option.h"
#include "base/outfile.h"
#include "udp.h"
#include "base/until.h"
#include "posix.h"

#include "exhand/run/stream.h"

#include <errno.h>
#include <inttypes.h>
#include <poll.h>
#include <stdio.h>
#include <string.h>

#define BACK 64u /* pieces that may still come, late */

struct listen {
    const char *at, *out;
    double silence_s, wait_s, heard_s;
    FILE *file;
    uint32_t session, next; /* number */
    uint64_t end;           /* of the stream, as far as it came */
    uint64_t seen;          /* bit i: piece next - 1 - i came */
    uint64_t pieces, missing, late, twice, other, bytes;
    int begun, ended, gap;
};

static int complain(const struct listen *l)
{
    cli_complain("--out: %s: can't be written: %s: make room or give another --out", l->out,
        strerror(errno));
    return 2;
}

/* 1: came for the first time. */
static int count(struct listen *l, uint32_t number)
{
    const uint32_t ahead = number - l->next, back = l->next - 1 - number;
    if (ahead < UINT32_C(0x80000000)) {
        l->missing += ahead;
        l->seen = ahead < 63 ? l->seen << (ahead + 1) | 1 : 1;
        l->next = number + 1;
        return 1;
    }
    if (back >= BACK || l->seen >> back & 1) {
        l->twice++;
        return 0;
    }
    l->seen |= UINT64_C(1) << back;
    l->missing--;
    l->late++;
    return 1;
}

/* Its place says where it belongs; what never comes stays zeros, which no reader takes for a
 * record. */
static int put(struct listen *l, const struct stream_piece *p)
{
    const uint32_t ahead = p->place - (uint32_t)l->end;
    const uint64_t at =
        ahead < UINT32_C(0x80000000) ? l->end + ahead : l->end - (UINT64_C(0x100000000) - ahead);
    if (p->n == 0) { return 0; }
    if (fseek(l->file, (long)at, SEEK_SET) != 0 || fwrite(p->byte, 1, p->n, l->file) != p->n) {
        return complain(l);
    }
    l->bytes += p->n;
    l->end = at + p->n > l->end ? at + p->n : l->end;
    return 0;
}

static int take(struct listen *l, const uint8_t *datagram, size_t n)
{
    struct stream_piece p;
    if (!stream_read(&p, datagram, n) || (l->begun && p.session != l->session)) {
        l->other++;
        return 0;
    }
    l->heard_s = until_now_s();
    if (!l->begun) {
        l->begun = 1;
        l->session = p.session;
    }
    if (!count(l, p.number)) { return 0; }
    l->pieces++;
    l->ended |= p.last != 0;
    return put(l, &p);
}

/* What is heard and not the log's is no reason to wait for longer. Never long: a signal may come
 * just before poll(). 0: it is over. */
static int wait_ms(const struct listen *l)
{
    const double most_s = l->ended ? 0.2 : l->begun ? l->silence_s : l->wait_s;
    const double left_s = most_s - (until_now_s() - l->heard_s);
    if (!l->begun && l->wait_s <= 0) { return 1000; }
    return left_s <= 0 ? 0 : left_s >= 1 ? 1000 : 1 + (int)(1000 * left_s);
}

static int go(struct listen *l, struct udp *u)
{
    uint8_t datagram[STREAM_PIECE_B];
    struct pollfd f = {u->fd, POLLIN, 0};
    int err = 0;
    while (err == 0 && !posix_interrupted() && !(l->ended && l->missing == 0)) {
        const int ms = wait_ms(l);
        int n;
        if (ms == 0) { break; }
        (void)poll(&f, 1, ms);
        while (err == 0 && (n = udp_recv(u, datagram, sizeof datagram)) > 0) {
            err = take(l, datagram, (size_t)n);
        }
    }
    return err;
}

static int report(const struct listen *l)
{
    if (!l->begun) {
        cli_complain("--at: %s: nothing of a log came%s: is it the box's log_port=, and this "
                     "machine its peer=?",
            l->at, posix_interrupted() ? "" : " in time");
        return 1;
    }
    printf("%s: %" PRIu64 " bytes in %" PRIu64 " pieces; missing %" PRIu64 ", late %" PRIu64
           ", twice %" PRIu64 ", not the log's %" PRIu64 "; %s\n",
        l->out, l->bytes, l->pieces, l->missing, l->late, l->twice, l->other,
        l->ended ? "its end came" : "its end did not come");
    return l->ended && l->missing == 0 ? 0 : 1;
}

int cli_listen(int argc, char **argv)
{
    struct listen l = {.at = "0.0.0.0:4748", .silence_s = 5};
    const struct cli_option option[] = {
        {"at", CLI_TEXT, &l.at, 0, 0, "ADDRESS:PORT", "where the box sends its log (0.0.0.0:4748)"},
        {"out", CLI_TEXT, &l.out, 0, 0, "FILE", "the log, for `exhand replay` and `exhand csv`"},
        {"silence", CLI_REAL, &l.silence_s, 0.1, 1e6, "S",
            "once it began, so much of it is its end (5)"},
        {"wait", CLI_REAL, &l.wait_s, 0, 1e6, "S",
            "nothing for so long before it begins ends it, status 1 (0: waits for ever)"},
    };
    const struct cli_command c = {"listen", "--out FILE [options]",
        "The log of a box that sends it over UDP (pc104: log=udp), until its end or Ctrl-C.\n"
        "What is lost on the way is lost: it is told, and the readers skip it.",
        option, (int)(sizeof option / sizeof option[0]), 0};
    struct udp u;
    int err = cli_parse(&c, argc, argv, NULL);
    if (err) { return err == 1 ? 0 : err; }
    if (l.out == NULL) {
        cli_complain("--out: is missing: give the file to be written");
        return 2;
    }
    if (udp_open(&u, l.at, NULL) < 0) {
        cli_complain("--at: %s: %s: give ADDRESS:PORT of this machine", l.at, strerror(errno));
        return 2;
    }
    l.file = outfile_open("out", l.out);
    if (l.file == NULL) {
        err = 2;
    } else {
        until_catch(UNTIL_COMES_BACK);
        cli_complain("waits at %s for a log to begin (the box: log=udp or dump=udp)%s", l.at,
            l.wait_s > 0 ? "" : "; Ctrl-C or --wait ends it");
        l.heard_s = until_now_s();
        err = go(&l, &u);
        if (outfile_end(l.file, err == 0 && l.bytes > 0) != 0) { err = 2; }
    }
    udp_close(&u);
    if (err) { return err; }
    err = report(&l);
    return posix_interrupted() ? 130 : err;
}
