/* SPDX-License-Identifier: MIT */
#include "box/pieces.h"

#include "base/option.h"

#include "exhand/error.h"
#include "exhand/fix.h"

#include <arpa/inet.h>
#include <inttypes.h>
#include <string.h>

#define HALF UINT32_C(0x80000000) /* of the numbers modulo 2^32 */

void pieces_open(struct pieces *p, const struct sockaddr_in *peer, const struct exh_mac_key *key)
{
    memset(p, 0, sizeof *p);
    p->key = key;
    p->given = peer != NULL;
    if (peer) { p->peer = *peer; }
}

static int same(const struct sockaddr_in *a, const struct sockaddr_in *b)
{
    return a->sin_addr.s_addr == b->sin_addr.s_addr && a->sin_port == b->sin_port;
}

/* --- whose they are not --- */

static void strange(struct pieces *p, const struct sockaddr_in *from, uint64_t n)
{
    p->foreign += n;
    for (unsigned i = 0; i < PIECES_SOURCES; i++) {
        struct pieces_source *s = &p->source[i];
        if (s->n == 0) { s->from = *from; }
        if (same(&s->from, from)) {
            s->n += n;
            return;
        }
    }
}

/* --- before it has begun --- */

static struct pieces_try *who_sends(
    struct pieces *p, const struct sockaddr_in *from, const struct stream_piece *s)
{
    struct pieces_try *oldest = &p->who[0];
    for (unsigned i = 0; i < PIECES_TRIES; i++) {
        struct pieces_try *t = &p->who[i];
        if (t->pieces > 0 && t->session == s->session && same(&t->from, from)) { return t; }
        if (t->newest < oldest->newest) { oldest = t; }
    }
    if (oldest->pieces > 0) { strange(p, &oldest->from, oldest->pieces); }
    memset(oldest, 0, sizeof *oldest);
    oldest->from = *from;
    oldest->session = s->session;
    return oldest;
}

static int is_header(const struct exh_record *r)
{
    struct exh_bytes c = exh_bytes_reader(r->payload, r->len_B);
    struct exh_record_header h;
    if (r->type != EXH_RECORD_HEADER || r->len_B > EXH_LOG_RECORD_B - EXH_RECORD_OVERHEAD) {
        return 0;
    }
    memset(&h, 0, sizeof h);
    exh_record_header_serialize(&c, &h);
    return exh_bytes_ok(&c) && exh_period_ok(h.T);
}

/* As the header before record seq. */
static void keep_header(struct pieces_try *t, const struct exh_record *r, uint32_t seq)
{
    struct exh_bytes c = exh_bytes_writer(t->header, sizeof t->header);
    exh_record_begin(&c, EXH_RECORD_HEADER, seq, 0);
    for (uint32_t i = 0; i < r->len_B; i++) {
        uint8_t byte = r->payload[i];
        exh_bytes_u8(&c, &byte);
    }
    t->header_B = exh_record_end(&c);
}

static void number_header(struct pieces_try *t, uint32_t seq)
{
    struct exh_record r;
    uint8_t copy[EXH_LOG_RECORD_B];
    memcpy(copy, t->header, t->header_B);
    if (exh_record_decode(copy, t->header_B, &r) > 0) { keep_header(t, &r, seq); }
}

/* Where its log begins among the bytes so far: at its very header, behind which all else will
 * come, or at a keyframe, with a header that came before. < 0: not yet, and what is of no use any
 * more is dropped. */
static int32_t beginning(struct pieces_try *t)
{
    uint32_t at = 0;
    int32_t found = -1;
    while (at < t->n) {
        struct exh_record r;
        const int32_t n = exh_record_decode(t->byte + at, t->n - at, &r);
        if (n == -EXH_E_SHORT && t->n - at < EXH_LOG_RECORD_B) { break; }
        if (n > 0 && is_header(&r)) {
            keep_header(t, &r, r.seq);
            if (r.seq == 0) {
                t->header_B = 0; /* it is there already */
                return (int32_t)at;
            }
        } else if (n > 0 && r.type == EXH_RECORD_KEYFRAME && t->header_B > 0) {
            number_header(t, r.seq - 1);
            return (int32_t)at;
        }
        at += n > 0 ? (uint32_t)n : 1;
    }
    t->n -= at;
    memmove(t->byte, t->byte + at, t->n);
    return found;
}

static void begin(struct pieces *p, const struct pieces_try *t, struct pieces_part *part)
{
    p->begun = 1;
    p->peer = t->from;
    p->session = t->session;
    p->next = t->number;
    p->place = t->place;
    p->end = p->low = t->header_B + part->more_n;
    p->seen = UINT64_MAX; /* older pieces are too late */
    p->pieces = t->pieces;
    for (unsigned i = 0; i < PIECES_BACK; i++) { p->was[i].at = p->end; }
    for (unsigned i = 0; i < PIECES_TRIES; i++) {
        if (&p->who[i] != t && p->who[i].pieces > 0) {
            strange(p, &p->who[i].from, p->who[i].pieces);
        }
    }
}

static int try_to_begin(struct pieces *p, const struct sockaddr_in *from,
    const struct stream_piece *s, struct pieces_part *part)
{
    struct pieces_try *t = who_sends(p, from, s);
    int32_t at;
    if (t->pieces == 0 || s->number != t->number || s->place != t->place) { t->n = 0; }
    t->pieces++;
    t->newest = p->datagrams;
    t->number = s->number + 1;
    t->place = s->place + (uint32_t)s->n;
    memcpy(t->byte + t->n, s->byte, s->n); /* of EXH_LOG_RECORD_B at most a piece is not used yet */
    t->n += (uint32_t)s->n;
    at = beginning(t);
    if (at < 0) { return 0; }
    *part = (struct pieces_part){0, t->header, t->header_B, t->byte + at, t->n - (uint32_t)at};
    begin(p, t, part);
    return 1;
}

/* --- and then --- */

/* Behind all that came: as many bytes behind as the pieces between can have. */
static int is_next(struct pieces *p, const struct stream_piece *s, uint64_t *at)
{
    const uint32_t ahead = s->number - p->next, gap = s->place - p->place;
    if (ahead > PIECES_AHEAD || gap > ahead * STREAM_DATA_B) {
        p->beyond++;
        return 0;
    }
    *at = p->end + gap;
    p->missing += ahead;
    if (ahead >= PIECES_BACK - 1) { p->low = p->end; }
    p->seen = ahead < PIECES_BACK - 1 ? p->seen << (ahead + 1) | 1 : 1;
    p->next = s->number + 1;
    p->end = *at + s->n;
    p->place = s->place + (uint32_t)s->n;
    return 1;
}

static int saw(const struct pieces *p, uint32_t back) { return p->seen >> back & 1; }

/* Into a hole: between those seen that are next to it. */
static int is_late(struct pieces *p, const struct stream_piece *s, uint64_t *at)
{
    const uint32_t back = p->next - 1 - s->number, less = p->place - s->place;
    uint32_t above = back - 1, below = back + 1; /* back > 0: the newest was seen */
    uint64_t from;
    if (back >= PIECES_BACK || saw(p, back)) {
        p->twice++;
        return 0;
    }
    while (above > 0 && !saw(p, above)) { above--; }
    while (below < PIECES_BACK && !saw(p, below)) { below++; }
    from = p->low;
    if (below < PIECES_BACK) {
        const unsigned k = (p->next - 1 - below) % PIECES_BACK;
        from = p->was[k].at + p->was[k].n;
    }
    *at = p->end - less;
    if (less > p->end || *at < from ||
        *at + s->n > p->was[(p->next - 1 - above) % PIECES_BACK].at) {
        p->beyond++;
        return 0;
    }
    p->seen |= UINT64_C(1) << back;
    p->missing--;
    p->late++;
    return 1;
}

static int follow(struct pieces *p, const struct stream_piece *s, struct pieces_part *part)
{
    uint64_t at = 0;
    const int ahead = s->number - p->next < HALF;
    if (!(ahead ? is_next(p, s, &at) : is_late(p, s, &at))) { return 0; }
    p->was[s->number % PIECES_BACK].at = at;
    p->was[s->number % PIECES_BACK].n = (uint32_t)s->n;
    p->pieces++;
    p->ended |= s->last != 0;
    *part = (struct pieces_part){at, s->byte, (uint32_t)s->n, NULL, 0};
    return 1;
}

int pieces_take(struct pieces *p, const struct sockaddr_in *from, const uint8_t *datagram, size_t n,
    struct pieces_part *part)
{
    const int may = !(p->given || p->begun) || same(from, &p->peer);
    struct stream_piece s;
    const enum stream_is is = stream_read(&s, datagram, n, p->key);
    p->datagrams++;
    if (is == STREAM_NONE || !may || (is == STREAM_PIECE && p->begun && s.session != p->session)) {
        strange(p, from, 1);
        return 0;
    }
    p->damaged += is == STREAM_DAMAGED;
    p->old += is == STREAM_OLD;
    p->keyed += is == STREAM_KEYED;
    p->no_key += is == STREAM_NO_KEY;
    p->other_key += is == STREAM_OTHER_KEY;
    if (is != STREAM_PIECE) { return 0; }
    return p->begun ? follow(p, &s, part) : try_to_begin(p, from, &s, part);
}

static void complain_of_keys(const struct pieces *p)
{
    const struct {
        uint64_t n;
        const char *what;
    } misfit[] = {{p->keyed, "have a key: give it as --key"},
        {p->no_key, "have no key: give the box key=, or leave --key out here"},
        {p->other_key, "have another key: give both the same"}};
    for (unsigned i = 0; i < sizeof misfit / sizeof misfit[0]; i++) {
        if (misfit[i].n == 0) { continue; }
        cli_complain("%" PRIu64 " pieces %s", misfit[i].n, misfit[i].what);
    }
}

void pieces_complain(const struct pieces *p, uint64_t bad_length)
{
    char name[INET_ADDRSTRLEN];
    uint64_t named = 0;
    for (unsigned i = 0; i < PIECES_SOURCES && p->source[i].n > 0; i++) {
        const struct sockaddr_in *a = &p->source[i].from;
        if (inet_ntop(AF_INET, &a->sin_addr, name, sizeof name) == NULL) { name[0] = '\0'; }
        cli_complain("%" PRIu64 " datagrams from %s:%u were not the log's%s", p->source[i].n, name,
            (unsigned)ntohs(a->sin_port),
            p->given ? "" : ": if that is the box, give it as --peer");
        named += p->source[i].n;
    }
    if (p->foreign > named) {
        cli_complain("%" PRIu64 " datagrams from others were not the log's", p->foreign - named);
    }
    if (p->damaged + p->beyond > 0) {
        cli_complain("%" PRIu64 " pieces were damaged, and %" PRIu64
                     " had a place where they can't "
                     "be: none of them was taken",
            p->damaged, p->beyond);
    }
    if (bad_length) { cli_complain("%" PRIu64 " datagrams were too long or empty", bad_length); }
    complain_of_keys(p);
    if (p->old > 0) {
        cli_complain("%" PRIu64 " pieces are of version 1, this program's is 2: give the box the "
                     "image of the same release",
            p->old);
    }
}
