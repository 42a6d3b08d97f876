/* SPDX-License-Identifier: MIT */
/* exhand listen: pieces of a log that come late, twice, never, or from another sender. */
#include "check.h"

#include "base/cli.h"
#include "udp.h"

#include "exhand/run/stream.h"

#include "exhand/record.h"

#include <arpa/inet.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

#define PIECE   64u
#define SESSION 77u

/* --- a log --- */

enum { HEADER_AGAIN = 30, RECORDS = 70 }; /* a header once more; behind it, a keyframe */

static uint8_t whole[8192];
static uint32_t whole_B, key_at, key_seq; /* of the second keyframe */

static void add_record(uint8_t type, uint32_t seq)
{
    struct exh_bytes c = exh_bytes_writer(whole + whole_B, sizeof whole - whole_B);
    struct exh_record_header h = {.scene = "drop", .T = {1, 2000}};
    exh_record_begin(&c, type, seq, seq);
    if (type == EXH_RECORD_HEADER) { exh_record_header_serialize(&c, &h); }
    if (type == EXH_RECORD_END) { exh_bytes_u32(&c, &seq); }
    for (uint32_t i = 0; type != EXH_RECORD_HEADER && type != EXH_RECORD_END && i < 40; i++) {
        uint8_t byte = (uint8_t)(seq * 7 + i);
        exh_bytes_u8(&c, &byte);
    }
    whole_B += exh_record_end(&c);
}

static void make_log(void)
{
    whole_B = 0;
    for (uint32_t k = 0; k <= RECORDS; k++) {
        if (k == HEADER_AGAIN + 3) {
            key_at = whole_B;
            key_seq = k;
        }
        add_record(k == 0 || k == HEADER_AGAIN       ? EXH_RECORD_HEADER
                   : k == 1 || k == HEADER_AGAIN + 3 ? EXH_RECORD_KEYFRAME
                   : k == RECORDS                    ? EXH_RECORD_END
                                                     : EXH_RECORD_FRAME,
            k);
    }
}

/* --- pieces --- */

static struct udp from, other;
static char at[32], peer[32], out[64], err[64];
static pid_t listener;

struct datagram {
    uint32_t session, number, place, last;
    const void *byte;
    uint32_t n;
    int flips, cut; /* a bit of its CRC; bytes off its end */
};

static void send_from(struct udp *u, struct datagram d)
{
    uint8_t to[STREAM_PIECE_B];
    struct exh_bytes c = exh_bytes_writer(to, sizeof to);
    uint32_t magic = STREAM_MAGIC, crc;
    exh_bytes_u32(&c, &magic);
    exh_bytes_u32(&c, &d.session);
    exh_bytes_u32(&c, &d.number);
    exh_bytes_u32(&c, &d.place);
    exh_bytes_u32(&c, &d.last);
    memcpy(to + c.at, d.byte, d.n);
    c.at += d.n;
    crc = exh_crc32(0, to, c.at) ^ (d.flips ? 1u : 0u);
    exh_bytes_u32(&c, &crc);
    CHECK(udp_send(u, to, c.at - (unsigned)d.cut) > 0, "piece %u", (unsigned)d.number);
}

static struct datagram datagram(uint32_t number)
{
    const uint32_t place = number * PIECE, left = whole_B - place;
    return (struct datagram){
        SESSION, number, place, 0, whole + place, left < PIECE ? left : PIECE, 0, 0};
}

static uint32_t pieces(void) { return (whole_B + PIECE - 1) / PIECE; }

static void send_some(uint32_t first, uint32_t behind)
{
    const struct timespec a_while = {0, 1000000};
    for (; first < behind; first++) {
        send_from(&from, datagram(first));
        if (first % 16 == 15) { (void)nanosleep(&a_while, NULL); } /* a socket's room ends */
    }
}

static void send_end(void)
{
    send_from(&from, (struct datagram){SESSION, pieces(), whole_B, 1, "", 0, 0, 0});
}

/* --- a listener --- */

static int call(int n, const char *const *words)
{
    static char word[12][64];
    char *argv[13] = {word[0]};
    (void)snprintf(word[0], sizeof word[0], "listen");
    for (int i = 0; i < n; i++) {
        (void)snprintf(word[i + 1], sizeof word[0], "%s", words[i]);
        argv[i + 1] = word[i + 1];
    }
    return cli_listen(n + 1, argv);
}

/* In a separate process, at a port that was just free. It listens when its file is there. */
static void start(int with_peer)
{
    const struct timespec a_while = {0, 20000000};
    struct udp probe;
    char part[80];
    make_log();
    (void)snprintf(out, sizeof out, "/tmp/exhand-listen-%ld", (long)getpid());
    (void)snprintf(part, sizeof part, "%s.part", out);
    (void)snprintf(err, sizeof err, "/tmp/exhand-listen-%ld.err", (long)getpid());
    CHECK_EQ_I64(udp_open(&probe, "127.0.0.1:0", NULL), 0);
    (void)snprintf(at, sizeof at, "127.0.0.1:%u", udp_port(&probe));
    udp_close(&probe);
    CHECK_EQ_I64(udp_open(&from, "127.0.0.1:0", at), 0);
    CHECK_EQ_I64(udp_open(&other, "127.0.0.1:0", at), 0);
    (void)snprintf(peer, sizeof peer, "127.0.0.1:%u", udp_port(&from));
    (void)fflush(NULL);
    listener = fork();
    if (listener == 0) {
        const char *const words[] = {"--at", at, "--out", out, "--silence", "1", "--peer", peer};
        if (!freopen("/dev/null", "w", stdout) || !freopen(err, "w", stderr)) { _exit(99); }
        with_peer = call(with_peer ? 8 : 6, words);
        (void)fflush(NULL);
        _exit(with_peer);
    }
    for (int i = 0; i < 400 && access(part, F_OK) != 0; i++) { (void)nanosleep(&a_while, NULL); }
    CHECK(access(part, F_OK) == 0, "it does not listen");
}

static uint8_t got[2 * sizeof whole];
static size_t got_B;
static char said[2048];

static size_t read_file(const char *path, void *to, size_t cap)
{
    FILE *f = fopen(path, "rb");
    const size_t n = f ? fread(to, 1, cap, f) : 0;
    if (f) { (void)fclose(f); }
    (void)remove(path);
    return n;
}

/* Its exit status; what it wrote and what it said. */
static int end(void)
{
    int status = 0;
    (void)waitpid(listener, &status, 0);
    got_B = read_file(out, got, sizeof got);
    said[read_file(err, said, sizeof said - 1)] = '\0';
    udp_close(&from);
    udp_close(&other);
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

static int is_whole(void) { return got_B == whole_B && memcmp(got, whole, whole_B) == 0; }

TEST(a_whole_log_in_whatever_order)
{
    start(0);
    send_some(0, 5);
    send_some(7, 8);
    send_some(5, 7);
    send_some(5, 9);
    for (uint32_t k = 40; k > 20; k--) { send_from(&from, datagram(k)); }
    send_some(9, 21);
    send_some(41, pieces());
    send_end();
    CHECK_EQ_I64(end(), 0);
    CHECK(is_whole(), "%zu of %u bytes", got_B, (unsigned)whole_B);
}

TEST(what_is_missing_is_told_and_leaves_a_hole)
{
    start(0);
    send_some(0, 5);
    send_some(6, pieces());
    send_end();
    CHECK_EQ_I64(end(), 1);
    memset(whole + 5 * PIECE, 0, PIECE);
    CHECK(is_whole(), "%zu of %u bytes", got_B, (unsigned)whole_B);
}

TEST(silence_ends_it_and_is_told)
{
    start(0);
    send_some(0, 5);
    CHECK_EQ_I64(end(), 1);
    CHECK(got_B == 5 * PIECE, "%zu bytes", got_B);
}

/* The end was announced, but a log ends with a record. */
TEST(an_end_is_a_record)
{
    start(0);
    send_some(0, 5);
    send_from(&from, (struct datagram){SESSION, 5, 5 * PIECE, 1, "", 0, 0, 0});
    CHECK_EQ_I64(end(), 1);
    CHECK(got_B == 5 * PIECE, "%zu bytes", got_B);
}

/* One datagram of each kind, when seven pieces came, the sixth not: none is taken. */
TEST(what_is_not_the_logs_changes_nothing)
{
    static const char junk[STREAM_DATA_B + 1] = "ZZZZZZZZZZZZZZZZZZZZZZZZZZZZZZZZZZZZZZZZZZZZZZZZ";
    static const struct {
        struct datagram d;
        int stranger;
        const char *says; /* of it */
    } row[] = {
        {{SESSION, 7, 7 * PIECE, 0, junk, 40, 0, 0}, 1, "1 datagrams from 127.0.0.1:"},
        {{SESSION, 7, 7 * PIECE, 1, junk, 0, 0, 0}, 1, "1 datagrams from 127.0.0.1:"},
        {{SESSION + 1, 7, 7 * PIECE, 0, junk, 40, 0, 0}, 0, "1 datagrams from 127.0.0.1:"},
        {{SESSION, 0, 0, 0, whole, PIECE, 0, 0}, 1, "1 datagrams from 127.0.0.1:"},
        {{SESSION + 9, 0, 0, 0, whole, 5 * PIECE, 0, 0}, 1, "1 datagrams from 127.0.0.1:"},
        {{SESSION, 8, 0x90000000u, 0, junk, 40, 0, 0}, 0, "1 had a place"},
        {{SESSION, 8, 0xFFFFFFFFu, 0, junk, 40, 0, 0}, 0, "1 had a place"},
        {{SESSION, 7, 7 * PIECE + 1, 0, junk, 40, 0, 0}, 0, "1 had a place"},
        {{SESSION, 7, 7 * PIECE - 1, 0, junk, 40, 0, 0}, 0, "1 had a place"},
        {{SESSION, 7, 0, 0, junk, 40, 0, 0}, 0, "1 had a place"},
        {{SESSION, 5007, 0, 0, junk, 400, 0, 0}, 0, "1 had a place"},
        {{SESSION, 100000, 8 * PIECE, 0, junk, 40, 0, 0}, 0, "1 had a place"},
        {{SESSION, 9, 7 * PIECE + 2 * STREAM_DATA_B + 1, 0, junk, 4, 0, 0}, 0, "1 had a place"},
        {{SESSION, 5, 5 * PIECE - 1, 0, junk, PIECE, 0, 0}, 0, "1 had a place"},
        {{SESSION, 5, 5 * PIECE, 0, junk, PIECE + 1, 0, 0}, 0, "1 had a place"},
        {{SESSION, 5, 0x80000000u, 0, junk, PIECE, 0, 0}, 0, "1 had a place"},
        {{SESSION, 3, 3 * PIECE, 0, junk, PIECE, 0, 0}, 0, ""},
        {{SESSION, 7, 7 * PIECE, 0, junk, PIECE, 1, 0}, 0, "1 pieces were damaged"},
        {{SESSION, 7, 7 * PIECE, 2, junk, PIECE, 0, 0}, 0, "1 pieces were damaged"},
        {{SESSION, 7, 7 * PIECE, 0, junk, PIECE, 0, 1}, 0, "1 pieces were damaged"},
        {{SESSION, 7, 7 * PIECE, 0, junk, 0, 0, 1}, 0, "1 pieces were damaged"},
        {{SESSION, 7, 7 * PIECE, 0, junk, 0, 0, 20}, 0, "1 datagrams from 127.0.0.1:"},
    };
    for (size_t i = 0; i < LEN(row); i++) {
        int status;
        start(0);
        send_some(0, 5);
        send_some(6, 7);
        send_from(row[i].stranger ? &other : &from, row[i].d);
        send_some(5, 6);
        send_some(7, pieces());
        send_end();
        status = end();
        CHECK(status == 0 && is_whole(), "row %zu: %d, %zu bytes, %s", i, status, got_B, said);
        CHECK(strstr(said, row[i].says), "row %zu: %s", i, said);
    }
}

/* A stranger that sends first, without a log's beginning; and a box of another release. */
TEST(a_stranger_who_is_first_is_not_the_box)
{
    static const uint8_t old[24] = {'E', 'X', 'H', 'L'};
    start(0);
    for (uint32_t i = 0; i < 9; i++) { /* more than are kept in mind */
        send_from(&other, (struct datagram){i, 0, i << 30, 0, "ZZZZ", 4, 0, 0});
    }
    (void)udp_send(&other, "what", 4);
    (void)udp_send(&from, old, sizeof old);
    send_some(0, pieces());
    send_end();
    CHECK_EQ_I64(end(), 0);
    CHECK(is_whole() && strstr(said, "10 datagrams from 127.0.0.1:") &&
              strstr(said, "1 pieces are of version 1"),
        "%s", said);
}

TEST(a_peer_is_the_box_alone)
{
    start(1);
    for (uint32_t k = 0; k < 5; k++) { send_from(&other, datagram(k)); }
    send_some(0, pieces());
    send_end();
    CHECK_EQ_I64(end(), 0);
    CHECK(is_whole() && strstr(said, "5 datagrams from 127.0.0.1:"), "%s", said);
}

/* Its log begins with the header, as of the keyframe that comes next. */
TEST(who_comes_late_has_a_log_all_the_same)
{
    struct exh_record r;
    int32_t n;
    uint32_t rest;
    start(0);
    send_some(20, pieces());
    send_end();
    CHECK_EQ_I64(end(), 0);
    n = exh_record_decode(got, (uint32_t)got_B, &r);
    CHECK(n > 0 && r.type == EXH_RECORD_HEADER, "no header: %d", (int)n);
    CHECK_EQ_I64(r.seq, key_seq - 1);
    rest = whole_B - key_at;
    CHECK(got_B == (size_t)n + rest && memcmp(got + n, whole + key_at, rest) == 0, "%zu bytes",
        got_B);
}

/* Words that are no log's do not prolong it. */
TEST(nothing_in_time_is_told)
{
    const char *const words[] = {"--at", at, "--out", out, "--wait", "0.3"};
    const struct timespec a_while = {0, 20000000};
    int status = 0, n = 0;
    start(0);
    CHECK_EQ_I64(kill(listener, SIGTERM), 0);
    CHECK_EQ_I64(waitpid(listener, &status, 0), listener);
    listener = fork();
    if (listener == 0) { _exit(call(6, words)); }
    while (waitpid(listener, &status, WNOHANG) == 0 && ++n < 500) {
        (void)udp_send(&from, "what", 4);
        (void)nanosleep(&a_while, NULL);
    }
    CHECK(n < 500 && WIFEXITED(status) && WEXITSTATUS(status) == 1, "%d after %d", status, n);
    CHECK(n > 5, "ended after %d", n);
    CHECK(access(out, F_OK) != 0, "a file of nothing is left");
    (void)remove(err);
    udp_close(&from);
    udp_close(&other);
}

TEST(bad_usage)
{
    const char *const where[] = {"--out", "x", "--at", "here"};
    const char *const who[] = {"--out", "x", "--peer", "there"};
    CHECK_EQ_I64(call(0, NULL), 2);
    CHECK_EQ_I64(call(4, where), 2);
    CHECK_EQ_I64(call(4, who), 2);
}

/* The meaning of a piece for a reader with this key, or with none. */
static enum stream_is is_to(const uint8_t *piece, size_t len_B, const struct exh_mac_key *key)
{
    struct stream_piece p;
    return stream_read(&p, piece, len_B, key);
}

TEST(with_a_key_no_other_piece_is_taken)
{
    static const uint8_t byte[STREAM_DATA_B] = {7}, a[EXH_MAC_KEY_B] = {1}, b[EXH_MAC_KEY_B] = {2};
    const struct exh_mac_key ours = exh_mac_key(a), others = exh_mac_key(b);
    uint8_t plain[STREAM_PIECE_B], tagged[STREAM_PIECE_B];
    size_t plain_B, tagged_B;
    stream_open(9);
    stream_key(NULL);
    plain_B = stream_piece(plain, byte, STREAM_DATA_B, 0);
    stream_key(&ours);
    tagged_B = stream_piece(tagged, byte, STREAM_DATA_B, 0);
    stream_key(NULL);
    CHECK_EQ_I64((int64_t)tagged_B, (int64_t)plain_B + EXH_MAC_B);
    CHECK_EQ_I64(is_to(plain, plain_B, NULL), STREAM_PIECE);
    CHECK_EQ_I64(is_to(tagged, tagged_B, &ours), STREAM_PIECE);
    CHECK_EQ_I64(is_to(plain, plain_B, &ours), STREAM_NO_KEY);
    CHECK_EQ_I64(is_to(tagged, tagged_B, NULL), STREAM_KEYED);
    CHECK_EQ_I64(is_to(tagged, tagged_B, &others), STREAM_OTHER_KEY);
    for (size_t bit = 0; bit < 8 * tagged_B; bit++) {
        tagged[bit / 8] = (uint8_t)(tagged[bit / 8] ^ 1u << bit % 8);
        CHECK(is_to(tagged, tagged_B, &ours) != STREAM_PIECE, "bit %zu", bit);
        tagged[bit / 8] = (uint8_t)(tagged[bit / 8] ^ 1u << bit % 8);
    }
    for (size_t n = 0; n < tagged_B; n++) {
        CHECK(is_to(tagged, n, &ours) != STREAM_PIECE, "%zu bytes", n);
    }
}

TEST_MAIN("listen", with_a_key_no_other_piece_is_taken, a_whole_log_in_whatever_order,
    what_is_missing_is_told_and_leaves_a_hole, silence_ends_it_and_is_told, an_end_is_a_record,
    what_is_not_the_logs_changes_nothing, a_stranger_who_is_first_is_not_the_box,
    a_peer_is_the_box_alone, who_comes_late_has_a_log_all_the_same, nothing_in_time_is_told,
    bad_usage);
