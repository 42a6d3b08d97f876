/* SPDX-License-Identifier: MIT */
/* Pieces of a log received over UDP from one box. Its address, port and session are those of the
 * first sender of a complete header, or of a given peer. Other senders are counted and named at the
 * end; they change nothing. */
#ifndef CLI_PIECES_H
#define CLI_PIECES_H

#include "exhand/run/log.h"
#include "exhand/run/stream.h"

#include "udp.h"

#define PIECES_BACK    64u /* pieces that may still come, late */
#define PIECES_AHEAD   65536u
#define PIECES_TRIES   4u
#define PIECES_SOURCES 8u

/* A possible box: consecutive pieces until its log has a start. */
struct pieces_try {
    struct sockaddr_in from;
    uint32_t session, number, place; /* of the next piece and byte */
    uint64_t pieces, newest;         /* newest: when, in datagrams */
    uint8_t byte[8192], header[EXH_LOG_RECORD_B];
    uint32_t n, header_B;
};

struct pieces_source {
    struct sockaddr_in from;
    uint64_t n; /* datagrams that were not the log's */
};

struct pieces {
    struct sockaddr_in peer;       /* of the log, or that alone may be it */
    const struct exh_mac_key *key; /* NULL: none */
    int given, begun, ended;
    uint32_t session, next; /* number */
    uint32_t place;         /* in the stream, of byte `end` of the log */
    uint64_t end;           /* of the log, as far as it came */
    uint64_t low;           /* all before it came, or never will */
    uint64_t seen;          /* bit i: piece next - 1 - i came */
    struct {
        uint64_t at;
        uint32_t n;
    } was[PIECES_BACK]; /* of pieces seen, by number */
    uint64_t datagrams, pieces, missing, late, twice, beyond, damaged, old, foreign;
    uint64_t keyed, no_key, other_key; /* whose key does not fit ours */
    struct pieces_source source[PIECES_SOURCES];
    struct pieces_try who[PIECES_TRIES];
};

/* Bytes of the log and where they belong, good until the next call. Nothing is ever given for a
 * place that was given before. */
struct pieces_part {
    uint64_t at;
    const uint8_t *byte;
    uint32_t n;
    const uint8_t *more; /* behind them, of the beginning */
    uint32_t more_n;
};

/* peer NULL: the first sender of a header. key: the caller's, must stay valid; NULL: none. */
void pieces_open(struct pieces *p, const struct sockaddr_in *peer, const struct exh_mac_key *key);
/* A datagram as it came: 1, *part is the log's, or 0. */
int pieces_take(struct pieces *p, const struct sockaddr_in *from, const uint8_t *datagram, size_t n,
    struct pieces_part *part);
/* A line on stderr for each who sent what is not the log's, and what it was. bad_length: what the
 * socket dropped. */
void pieces_complain(const struct pieces *p, uint64_t bad_length);

#endif
