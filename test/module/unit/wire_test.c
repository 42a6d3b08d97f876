/* SPDX-License-Identifier: MIT */
/* wire.h: every packet there and back, every bit flipped, every byte cut off, and whatever a
 * link does to the order. */
#include "exhand/wire.h"

#include "exhand/error.h"
#include "exhand/safety.h"

#include "check.h"

static uint8_t buf[EXH_WIRE_MAX_B + 20]; /* and a TRACE with a frame too many */

static struct exh_wire_packet sample(uint8_t type)
{
    struct exh_wire_packet p = {.type = type};
    int32_t v = 0x01020304;
    switch (type) {
    case EXH_WIRE_HELLO:
        p.u.hello = (struct exh_wire_hello){EXH_WIRE_WORLD, 0x100, 0xABCD, {{-5, 6}, {7, 0x1234}}};
        break;
    case EXH_WIRE_STATE:
        p.u.state.tick = 77;
        p.u.state.fingers = 31;
        p.u.state.state = 1;
        p.u.state.frozen = 3;
        p.u.state.touching = 2;
        p.u.state.age_ms = EXH_WIRE_NEVER_MS;
        p.u.state.faults = 0x80000001u;
        for (unsigned f = 0; f < EXH_FINGERS; f++) {
            for (unsigned k = 0; k < 3; k++) {
                p.u.state.joint_turn_q32[f][k] = v += 0x01010101;
                p.u.state.tip_m_q30[f][k] = -(v += 77);
            }
            p.u.state.force_N_q20[f] = v += 5;
            p.u.state.d_m_q30[f] = INT32_MIN;
            p.u.state.q_m_q30[f] = v += 3;
            p.u.state.q_lim_m_q30[f] = INT32_MAX;
        }
        break;
    case EXH_WIRE_PLANES:
        p.u.planes.echo_seq = 5;
        p.u.planes.echo_stamp_us = 0xFFFFFFF0u;
        p.u.planes.fingers = 3;
        p.u.planes.plane[0] = (struct exh_wire_plane){EXH_PLANE_NONE, 0, 0, {0}, {0}, {0}};
        p.u.planes.plane[1] = (struct exh_wire_plane){
            EXH_PLANE_HIT, 4, 0x1234, {0, 0, 1 << 30}, {0, 0, 100}, {5, -6, 100}};
        break;
    case EXH_WIRE_PARAM: p.u.param = (struct exh_wire_param){0x0401, 3, -9}; break;
    case EXH_WIRE_TRACE_ASK:
        p.u.trace_ask = (struct exh_wire_trace_request){20, {1, 0xFFFF, 3, 0x0102}};
        break;
    case EXH_WIRE_TRACE:
        p.u.trace.request_seq = 6;
        p.u.trace.first = 0xFFFFFFFEu;
        p.u.trace.frames = 3;
        for (unsigned i = 0; i < 3; i++) {
            p.u.trace.frame[i].tick = 100 + i;
            for (unsigned k = 0; k < EXH_TRACE_SIGNALS; k++) {
                p.u.trace.frame[i].raw[k] = -(v += 0x01010101);
            }
        }
        break;
    default: p.u.ack = (struct exh_wire_ack){{0x0401, 3, -9}, -EXH_E_RANGE, 6}; break;
    }
    return p;
}

static uint32_t write_as(uint8_t type, uint32_t session, uint32_t seq)
{
    struct exh_wire_tx tx = {session, seq};
    struct exh_wire_packet p = sample(type);
    const int32_t n = exh_wire_encode(&tx, &p, 1000, buf, sizeof buf);
    CHECK(n > 0 && tx.seq == seq + 1, "type %d", type);
    return (uint32_t)n;
}

/* Recomputes the CRC of what was changed. */
static void seal(uint32_t n)
{
    uint32_t crc = exh_crc32(0, buf, n - 4);
    struct exh_bytes c = exh_bytes_writer(buf + n - 4, 4);
    exh_bytes_u32(&c, &crc);
}

static int take(struct exh_wire_rx *rx, uint32_t n)
{
    struct exh_wire_packet p;
    return exh_wire_decode(rx, &p, buf, n);
}

static struct exh_wire_rx met(uint32_t session, uint32_t seq)
{
    struct exh_wire_rx rx = {0};
    CHECK_EQ_I64(take(&rx, write_as(EXH_WIRE_HELLO, session, seq)), EXH_WIRE_HELLO);
    return rx;
}

TEST(bytes_are_those_of_the_document)
{
    static const uint8_t param[] = {0x58, 0x57, 3, 4, 8, 0, 0x0D, 0xF0, 0xAD, 0xBA, 2, 0, 0, 0,
        0xE8, 3, 0, 0, 0x01, 0x04, 3, 0, 0xF7, 0xFF, 0xFF, 0xFF};
    static const uint32_t sizes[] = {51, 236, 231, 30, 36, 34, 93};
    CHECK_EQ_I64(write_as(EXH_WIRE_PARAM, 0xBAADF00Du, 2), sizeof param + 4);
    CHECK(memcmp(buf, param, sizeof param) == 0, "head and payload");
    CHECK(buf[26] == (exh_crc32(0, param, sizeof param) & 0xFF), "CRC");
    for (uint8_t t = 1; t <= EXH_WIRE_TRACE; t++) { CHECK_EQ_I64(write_as(t, 1, 0), sizes[t - 1]); }
}

TEST(there_and_back)
{
    for (uint8_t t = 1; t <= EXH_WIRE_TRACE; t++) {
        struct exh_wire_rx rx = met(9, 0);
        struct exh_wire_tx tx = {9, 1};
        struct exh_wire_packet p = sample(t), back = {.type = 0};
        uint8_t again[EXH_WIRE_MAX_B];
        const int32_t n =
            exh_wire_encode(&tx, &p, 0x12345678, memset(buf, 0xA5, sizeof buf), sizeof buf);
        for (size_t k = (size_t)n; k < sizeof buf; k++) { CHECK(buf[k] == 0xA5, "beyond %d", t); }
        CHECK_EQ_I64(exh_wire_decode(&rx, &back, buf, (size_t)n), t);
        CHECK(back.type == t && back.seq == 1 && back.stamp_us == 0x12345678 && rx.accepted == 2,
            "type %d", t);
        tx.seq = 1;
        CHECK_EQ_I64(exh_wire_encode(&tx, &back, 0x12345678, again, sizeof again), n);
        CHECK(memcmp(buf, again, (size_t)n) == 0, "type %d", t);
    }
}

TEST(every_bit_flipped_and_every_byte_cut_off)
{
    for (uint8_t t = 1; t <= EXH_WIRE_TRACE; t++) {
        const struct exh_wire_rx start = met(9, 0);
        const uint32_t n = write_as(t, 9, 1);
        const struct exh_wire_packet before = sample(5);
        for (uint32_t bit = 0; bit < 8 * n; bit++) {
            struct exh_wire_rx rx = start;
            struct exh_wire_packet p = before;
            buf[bit / 8] = (uint8_t)(buf[bit / 8] ^ 1u << bit % 8);
            CHECK(exh_wire_decode(&rx, &p, buf, n) < 0 && rx.corrupt == 1, "bit %" PRIu32, bit);
            rx.corrupt = 0;
            CHECK(memcmp(&rx, &start, sizeof rx) == 0 && memcmp(&p, &before, sizeof p) == 0,
                "bit %" PRIu32 " changed a state", bit);
            buf[bit / 8] = (uint8_t)(buf[bit / 8] ^ 1u << bit % 8);
        }
        for (uint32_t len = 0; len <= n + 1 && len <= sizeof buf; len++) {
            struct exh_wire_rx rx = start;
            if (len != n) { CHECK(take(&rx, len) < 0 && rx.corrupt == 1, "length %" PRIu32, len); }
        }
    }
}

TEST(values_that_cannot_be)
{
    static const struct {
        uint8_t type;
        uint32_t at;
        uint8_t byte;
        int want;
    } bad[] = {
        {EXH_WIRE_HELLO, 18, 2, -EXH_E_CRC},              /* role */
        {EXH_WIRE_STATE, 18 + 4, 32, -EXH_E_CRC},         /* sixth finger */
        {EXH_WIRE_STATE, 18 + 5, EXH_STATES, -EXH_E_CRC}, /* no such state */
        {EXH_WIRE_STATE, 18 + 5, 255, -EXH_E_CRC}, {EXH_WIRE_STATE, 18 + 6, 128, -EXH_E_CRC},
        {EXH_WIRE_STATE, 18 + 7, 64, -EXH_E_CRC}, {EXH_WIRE_PLANES, 18 + 8, 35, -EXH_E_CRC},
        {EXH_WIRE_PLANES, 18 + 9, 3, -EXH_E_CRC},          /* kind */
        {EXH_WIRE_PLANES, 18 + 9 + 2 * 40, 1, -EXH_E_CRC}, /* for a finger not in the mask */
        {EXH_WIRE_PARAM, 2, 1, -EXH_E_VERSION}, {EXH_WIRE_PARAM, 3, 0, -EXH_E_UNKNOWN},
        {EXH_WIRE_TRACE, 18 + 8, 1, -EXH_E_CRC},    /* no result is positive */
        {EXH_WIRE_TRACE, 18 + 9, 0xFF, -EXH_E_CRC}, /* refused, and frames */
        {EXH_WIRE_TRACE, 18 + 10, 2, -EXH_E_CRC},   /* fewer frames than there are */
        {EXH_WIRE_TRACE, 18 + 10, 4, -EXH_E_CRC},   /* more */
        {EXH_WIRE_TRACE, 18 + 10, EXH_WIRE_FRAMES + 1, -EXH_E_CRC},
        {EXH_WIRE_TRACE, 18 + 10, 255, -EXH_E_CRC},
        {EXH_WIRE_TRACE_ASK, 3, EXH_WIRE_PARAM, -EXH_E_CRC}, /* longer than that one */
        {EXH_WIRE_PARAM, 3, 8, -EXH_E_UNKNOWN},
        {EXH_WIRE_PARAM, 3, 5, -EXH_E_CRC}, /* another type of another length */
        {EXH_WIRE_PARAM, 0, 0, -EXH_E_CRC}, {EXH_WIRE_PARAM, 4, 9, -EXH_E_SHORT},
        {EXH_WIRE_PARAM, 6, 0, -EXH_E_CRC}, /* session 0, as 9 is the low byte */
    };
    for (size_t i = 0; i < LEN(bad); i++) {
        const struct exh_wire_rx start = met(9, 0);
        struct exh_wire_rx rx = start;
        const uint32_t n = write_as(bad[i].type, 9, 1);
        buf[bad[i].at] = bad[i].byte;
        seal(n);
        CHECK(take(&rx, n) == bad[i].want, "case %d", (int)i);
        CHECK(rx.corrupt + rx.version + rx.unknown == 1 && rx.seq == start.seq, "case %d", (int)i);
    }
}

/* Its length is right, and so is its CRC. */
TEST(a_trace_with_a_frame_too_many)
{
    const uint32_t len_B = 11 + (EXH_WIRE_FRAMES + 1) * (4 + 4 * EXH_TRACE_SIGNALS);
    struct exh_wire_rx rx = met(9, 0);
    (void)write_as(EXH_WIRE_TRACE, 9, 1);
    buf[4] = (uint8_t)(len_B & 0xFF);
    buf[5] = (uint8_t)(len_B >> 8);
    buf[18 + 10] = EXH_WIRE_FRAMES + 1;
    seal(18 + len_B + 4);
    CHECK_EQ_I64(take(&rx, 18 + len_B + 4), -EXH_E_CRC);
    CHECK_EQ_I64(rx.corrupt, 1);
}

TEST(a_trace_fits_a_packet_whole_and_no_frame_is_missed_unseen)
{
    struct exh_wire_rx rx = met(9, 0);
    struct exh_wire_packet p = sample(EXH_WIRE_TRACE), back;
    struct exh_wire_tx tx = {9, 1};
    uint32_t next = p.u.trace.first;
    for (uint8_t n = 0; n <= EXH_WIRE_FRAMES; n++) {
        p.u.trace.frames = n;
        CHECK_EQ_I64(exh_wire_encode(&tx, &p, 0, buf, sizeof buf), 33 + 20 * n);
        CHECK_EQ_I64(take(&rx, 33 + 20u * n), EXH_WIRE_TRACE);
    }
    p.u.trace.frames = EXH_WIRE_FRAMES + 1;
    CHECK_EQ_I64(exh_wire_encode(&tx, &p, 0, buf, sizeof buf), -EXH_E_RANGE);
    p.u.trace.frames = 1;
    p.u.trace.result = -EXH_E_RANGE;
    CHECK_EQ_I64(exh_wire_encode(&tx, &p, 0, buf, sizeof buf), -EXH_E_RANGE);
    p = sample(EXH_WIRE_TRACE);
    for (int k = 0; k < 5; k++) { /* the third does not come: numbers wrap in it */
        const int32_t n = exh_wire_encode(&tx, &p, 0, buf, sizeof buf);
        p.u.trace.first += 3;
        if (k == 2) { continue; }
        CHECK_EQ_I64(exh_wire_decode(&rx, &back, buf, (size_t)n), EXH_WIRE_TRACE);
        CHECK_EQ_I64(exh_wire_trace_missed(next, &back.u.trace), k == 3 ? 3 : 0);
        next = back.u.trace.first + back.u.trace.frames;
    }
    CHECK_EQ_I64(next, 13);
}

TEST(only_what_is_newer)
{
    static const struct {
        uint32_t seq;
        int ok;
        uint32_t missing, duplicate, reordered, old;
    } step[] = {
        {11, 1, 0, 0, 0, 0},
        {11, 0, 0, 1, 0, 0},
        {14, 1, 2, 1, 0, 0},
        {13, 0, 1, 1, 1, 0},
        {13, 0, 1, 2, 1, 0},
        {9, 0, 1, 3, 1, 0},
        {77, 1, 63, 3, 1, 0},
        {14, 0, 63, 4, 1, 0},
        {12, 0, 63, 4, 1, 1},
        {15, 0, 62, 4, 2, 1},
        {200, 1, 184, 4, 2, 1},
        {136, 0, 184, 4, 2, 2},
        {137, 0, 183, 4, 3, 2},
    };
    struct exh_wire_rx rx = met(9, 10);
    for (size_t i = 0; i < LEN(step); i++) {
        struct exh_wire_packet p = sample(EXH_WIRE_STATE);
        const struct exh_wire_packet was = p;
        const uint32_t n = write_as(EXH_WIRE_PLANES, 9, step[i].seq);
        const int r = exh_wire_decode(&rx, &p, buf, n);
        CHECK(step[i].ok || memcmp(&p, &was, sizeof p) == 0, "step %d: written", (int)i);
        CHECK(r == (step[i].ok ? EXH_WIRE_PLANES : -EXH_E_STALE), "step %d", (int)i);
        CHECK(rx.missing == step[i].missing && rx.duplicate == step[i].duplicate &&
                  rx.reordered == step[i].reordered && rx.old == step[i].old,
            "step %d: %" PRIu32 " %" PRIu32 " %" PRIu32 " %" PRIu32, (int)i, rx.missing,
            rx.duplicate, rx.reordered, rx.old);
    }
}

TEST(parameters_and_answers_may_be_late_but_once)
{
    static const uint8_t type[] = {EXH_WIRE_PARAM, EXH_WIRE_ACK};
    for (size_t i = 0; i < LEN(type); i++) {
        struct exh_wire_rx rx = met(9, 10);
        CHECK_EQ_I64(take(&rx, write_as(EXH_WIRE_PLANES, 9, 74)), EXH_WIRE_PLANES);
        CHECK_EQ_I64(take(&rx, write_as(type[i], 9, 11)), type[i]);
        CHECK(rx.reordered == 1 && rx.accepted == 2 && rx.seq == 74, "late");
        CHECK_EQ_I64(take(&rx, write_as(type[i], 9, 11)), -EXH_E_STALE);
        CHECK_EQ_I64(take(&rx, write_as(type[i], 9, 10)), -EXH_E_STALE);
        CHECK(rx.duplicate == 1 && rx.old == 1, "twice, and too late");
        CHECK_EQ_I64(take(&rx, write_as(type[i], 8, 12)), -EXH_E_STATE);
    }
}

TEST(sequence_numbers_wrap)
{
    struct exh_wire_rx rx = met(9, 0xFFFFFFFEu);
    CHECK_EQ_I64(take(&rx, write_as(EXH_WIRE_PARAM, 9, 0xFFFFFFFFu)), EXH_WIRE_PARAM);
    CHECK_EQ_I64(take(&rx, write_as(EXH_WIRE_PARAM, 9, 0)), EXH_WIRE_PARAM);
    CHECK_EQ_I64(take(&rx, write_as(EXH_WIRE_PARAM, 9, 0xFFFFFFFFu)), -EXH_E_STALE);
    CHECK_EQ_I64(take(&rx, write_as(EXH_WIRE_PARAM, 9, 0x80000000u)), -EXH_E_STALE); /* half way */
    CHECK_EQ_I64(rx.old, 1);
    CHECK_EQ_I64(take(&rx, write_as(EXH_WIRE_PARAM, 9, 0x7FFFFFFFu)), -EXH_E_RANGE);
    CHECK_EQ_I64(rx.far, 1);
}

TEST(far_ahead_is_not_believed)
{
    static const uint32_t ahead[] = {EXH_WIRE_AHEAD + 1, 0x12345678u, 0x7FFFFFFFu};
    struct exh_wire_rx rx = met(9, 0xFFFFFFF0u);
    for (uint8_t type = 1; type <= EXH_WIRE_TRACE; type++) {
        for (size_t i = 0; i < LEN(ahead); i++) {
            struct exh_wire_rx was = rx;
            CHECK_EQ_I64(take(&rx, write_as(type, 9, rx.seq + ahead[i])), -EXH_E_RANGE);
            was.far++;
            CHECK(memcmp(&was, &rx, sizeof rx) == 0, "type %d, ahead %d", type, (int)i);
        }
    }
    CHECK_EQ_I64(take(&rx, write_as(EXH_WIRE_PLANES, 9, 0xFFFFFFF1u)), EXH_WIRE_PLANES);
    CHECK_EQ_I64(take(&rx, write_as(EXH_WIRE_PLANES, 9, rx.seq + EXH_WIRE_AHEAD)), EXH_WIRE_PLANES);
    CHECK_EQ_I64(rx.missing, EXH_WIRE_AHEAD - 1);
}

#define LIMIT_US 1000000u

/* What makes it deaf to session 9 has come; session 9 goes on from 101, and is heard again after
 * the silence and its next HELLO. */
static void recovers(struct exh_wire_rx *rx)
{
    uint32_t seq = 101;
    const struct exh_wire_rx was = *rx;
    CHECK(take(rx, write_as(EXH_WIRE_PLANES, 9, seq++)) < 0, "not deaf");
    CHECK(take(rx, write_as(EXH_WIRE_HELLO, 9, seq++)) < 0, "not deaf");
    CHECK_EQ_I64(exh_wire_poll(rx, LIMIT_US - 1, LIMIT_US), 0);
    CHECK(take(rx, write_as(EXH_WIRE_HELLO, 9, seq++)) < 0, "too early");
    CHECK_EQ_I64(exh_wire_poll(rx, 1, LIMIT_US), 1);
    CHECK_EQ_I64(exh_wire_poll(rx, 1, LIMIT_US), 0);
    CHECK(rx->silences == was.silences + 1 && rx->open == 1, "a silence is counted once");
    CHECK(take(rx, write_as(EXH_WIRE_PLANES, 9, seq++)) < 0, "a HELLO is what begins");
    CHECK_EQ_I64(take(rx, write_as(EXH_WIRE_HELLO, 9, seq++)), EXH_WIRE_HELLO);
    CHECK(rx->open == 0 && rx->quiet_us == 0, "heard");
    CHECK_EQ_I64(take(rx, write_as(EXH_WIRE_PLANES, 9, seq++)), EXH_WIRE_PLANES);
    CHECK(rx->accepted == was.accepted + 2 && rx->missing == was.missing, "counts go on");
}

TEST(no_packet_makes_it_deaf_for_good)
{
    struct exh_wire_rx rx = met(9, 100);
    (void)exh_wire_poll(&rx, LIMIT_US, LIMIT_US);
    CHECK_EQ_I64(
        take(&rx, write_as(EXH_WIRE_HELLO, 7, 3)), EXH_WIRE_HELLO); /* long gone, and late */
    recovers(&rx);

    rx = met(9, 100);
    CHECK_EQ_I64(take(&rx, write_as(EXH_WIRE_ACK, 9, 100 + EXH_WIRE_AHEAD)), EXH_WIRE_ACK);
    recovers(&rx);

    rx = met(9, 100);
    CHECK_EQ_I64(take(&rx, write_as(EXH_WIRE_PLANES, 9, 60000)), EXH_WIRE_PLANES);
    CHECK(take(&rx, write_as(EXH_WIRE_HELLO, 9, 0)) < 0, "started anew, and of the same session");
    CHECK_EQ_I64(exh_wire_poll(&rx, LIMIT_US, LIMIT_US), 1);
    CHECK_EQ_I64(take(&rx, write_as(EXH_WIRE_HELLO, 9, 1)), EXH_WIRE_HELLO);
    CHECK_EQ_I64(take(&rx, write_as(EXH_WIRE_PLANES, 9, 2)), EXH_WIRE_PLANES);
}

TEST(silence_is_only_what_is_heard_of_nobody)
{
    struct exh_wire_rx rx = {0};
    CHECK(exh_wire_poll(&rx, UINT32_MAX, 1) == 0 && rx.silences == 0, "nobody was there");
    rx = met(9, 100);
    for (uint32_t k = 1; k < 50; k++) {
        CHECK_EQ_I64(exh_wire_poll(&rx, LIMIT_US - 1, LIMIT_US), 0);
        CHECK_EQ_I64(take(&rx, write_as(EXH_WIRE_PLANES, 9, 100 + k)), EXH_WIRE_PLANES);
    }
    (void)exh_wire_poll(&rx, UINT32_MAX - 1, LIMIT_US);
    (void)exh_wire_poll(&rx, 7, LIMIT_US); /* no wrap */
    CHECK(rx.open && rx.quiet_us == UINT32_MAX && rx.silences == 1, "%" PRIu32, rx.quiet_us);
    /* Traffic of the meantime is next, and is taken immediately. The newest one again is not. */
    CHECK_EQ_I64(take(&rx, write_as(EXH_WIRE_PLANES, 9, 9000)), EXH_WIRE_PLANES);
    CHECK_EQ_I64(take(&rx, write_as(EXH_WIRE_HELLO, 9, 9001)), EXH_WIRE_HELLO);
    (void)exh_wire_poll(&rx, LIMIT_US, LIMIT_US);
    CHECK_EQ_I64(take(&rx, write_as(EXH_WIRE_HELLO, 9, 9001)), -EXH_E_STALE);
    CHECK_EQ_I64(rx.duplicate, 1);
}

TEST(what_differs_is_said_by_name)
{
    const struct exh_wire_hello ours = {
        .role = EXH_WIRE_CONTROLLER, .lib_version = 0x100, .table_crc = 0xABCD};
    static const struct {
        struct exh_wire_hello theirs;
        uint32_t want;
    } c[] = {{{EXH_WIRE_WORLD, 0x100, 0xABCD, {{0}}}, 0},
        {{EXH_WIRE_WORLD, 0x100, 0, {{0}}}, 0}, /* has no table */
        {{EXH_WIRE_CONTROLLER, 0x100, 0xABCD, {{0}}}, EXH_WIRE_ROLE},
        {{EXH_WIRE_WORLD, 0x101, 0xABCD, {{0}}}, EXH_WIRE_LIB},
        {{EXH_WIRE_WORLD, 0x100, 0xABCE, {{0}}}, EXH_WIRE_TABLE},
        {{EXH_WIRE_CONTROLLER, 0, 1, {{0}}}, EXH_WIRE_ROLE | EXH_WIRE_LIB | EXH_WIRE_TABLE}};
    for (size_t i = 0; i < LEN(c); i++) {
        CHECK_EQ_I64(exh_wire_compare(&ours, &c[i].theirs), c[i].want);
    }
    for (uint32_t crc = 0; crc < 2; crc++) { /* 0 alone is no table of ours */
        const struct exh_wire_hello few = {
            .role = EXH_WIRE_CONTROLLER, .lib_version = 0x100, .table_crc = crc};
        CHECK_EQ_I64(exh_wire_compare(&few, &c[0].theirs), crc ? EXH_WIRE_TABLE : 0);
    }
}

/* The receiver remembers 64 numbers. A step of 64 leaves none of them. */
TEST(a_step_over_all_that_is_remembered)
{
    for (uint32_t step = 63; step <= 65; step++) {
        struct exh_wire_rx rx = met(9, 0);
        CHECK_EQ_I64(take(&rx, write_as(EXH_WIRE_PLANES, 9, step)), EXH_WIRE_PLANES);
        CHECK_EQ_I64(rx.missing, step - 1);
        for (uint32_t late = 1; late < 63; late++) {
            CHECK_EQ_I64(take(&rx, write_as(EXH_WIRE_PLANES, 9, step - late)), -EXH_E_STALE);
            CHECK(rx.reordered == late && rx.duplicate == 0, "step %" PRIu32 ": %" PRIu32 " late",
                step, late);
        }
        CHECK_EQ_I64(take(&rx, write_as(EXH_WIRE_PLANES, 9, step - 63)), -EXH_E_STALE);
        CHECK(rx.duplicate == (step == 63) && rx.missing == step - rx.reordered - 1,
            "step %" PRIu32, step);
    }
}

TEST(a_restart_is_seen_by_its_hello)
{
    struct exh_wire_rx rx = {0};
    CHECK_EQ_I64(take(&rx, write_as(EXH_WIRE_PLANES, 9, 0)), -EXH_E_STATE);
    CHECK(rx.stranger == 1 && rx.session == 0, "who are you?");
    CHECK_EQ_I64(take(&rx, write_as(EXH_WIRE_HELLO, 9, 1)), EXH_WIRE_HELLO);
    CHECK_EQ_I64(take(&rx, write_as(EXH_WIRE_PLANES, 9, 50000)), EXH_WIRE_PLANES);
    CHECK_EQ_I64(take(&rx, write_as(EXH_WIRE_PLANES, 10, 1)), -EXH_E_STATE);
    (void)exh_wire_poll(&rx, LIMIT_US, LIMIT_US);
    CHECK_EQ_I64(take(&rx, write_as(EXH_WIRE_HELLO, 10, 0)), EXH_WIRE_HELLO);
    CHECK_EQ_I64(take(&rx, write_as(EXH_WIRE_PLANES, 9, 50001)), -EXH_E_STALE);
    CHECK_EQ_I64(take(&rx, write_as(EXH_WIRE_HELLO, 9, 50002)), -EXH_E_STALE);
    CHECK_EQ_I64(rx.old, 2);
    CHECK_EQ_I64(take(&rx, write_as(EXH_WIRE_PLANES, 10, 1)), EXH_WIRE_PLANES);
    CHECK_EQ_I64(take(&rx, write_as(EXH_WIRE_HELLO, 10, 0)), -EXH_E_STALE);
    CHECK_EQ_I64(take(&rx, write_as(EXH_WIRE_HELLO, 10, 2)), EXH_WIRE_HELLO);
}

/* One HELLO of a fresh session every 0.1 ms, and the peer goes on: none begins. It starts again,
 * in the same flood: it is heard as soon as a second is over, if its HELLO is the first then. */
TEST(a_flood_of_sessions_keeps_nobody_out)
{
    struct exh_wire_rx rx = met(9, 0);
    uint32_t fresh = 1000, anew = 0, us = 0;
    for (uint32_t k = 1; k <= 20000; k++) {
        (void)exh_wire_poll(&rx, 100, LIMIT_US);
        CHECK_EQ_I64(take(&rx, write_as(EXH_WIRE_HELLO, fresh++, k)), -EXH_E_STATE);
        if (k % 20 == 0) {
            CHECK_EQ_I64(take(&rx, write_as(EXH_WIRE_PLANES, 9, k / 20)), EXH_WIRE_PLANES);
        }
    }
    CHECK(rx.session == 9 && rx.stranger == 20000 && rx.silences == 0, "kept out");
    while (take(&rx, write_as(EXH_WIRE_HELLO, 8, anew++)) < 0) {
        CHECK_EQ_I64(take(&rx, write_as(EXH_WIRE_HELLO, fresh++, 1)), -EXH_E_STATE);
        (void)exh_wire_poll(&rx, 100, LIMIT_US);
        us += 100;
    }
    CHECK(us == LIMIT_US && rx.session == 8 && rx.silences == 1, "after %" PRIu32 " us", us);
    CHECK_EQ_I64(take(&rx, write_as(EXH_WIRE_PLANES, 8, anew)), EXH_WIRE_PLANES);
}

/* Whole, and 24 bytes behind it: of a link with a key. */
TEST(a_packet_with_a_key_is_another_form)
{
    const struct exh_wire_rx was = met(9, 0);
    uint8_t longer[EXH_WIRE_MAX_B + 64] = {0};
    const uint32_t n = write_as(EXH_WIRE_PLANES, 9, 1);
    memcpy(longer, buf, n);
    for (uint32_t more = 0; more < 64; more++) {
        struct exh_wire_rx rx = was;
        struct exh_wire_packet p;
        const int r = exh_wire_decode(&rx, &p, longer, n + more);
        CHECK(r == (more == 0                    ? EXH_WIRE_PLANES
                       : more == EXH_WIRE_SEAL_B ? -EXH_E_VERSION
                                                 : -EXH_E_SHORT),
            "%" PRIu32 " more", more);
        CHECK(rx.version == (more == EXH_WIRE_SEAL_B), "%" PRIu32 " more", more);
    }
}

TEST(writing_refuses)
{
    struct exh_wire_tx tx = {9, 4};
    struct exh_wire_packet p = sample(EXH_WIRE_STATE);
    CHECK_EQ_I64(exh_wire_encode(&tx, &p, 0, buf, 235), -EXH_E_SHORT);
    CHECK_EQ_I64(exh_wire_encode(&tx, &p, 0, buf, 236), 236);
    p.u.state.fingers = p.u.state.frozen = p.u.state.touching = 32;
    CHECK_EQ_I64(exh_wire_encode(&tx, &p, 0, buf, sizeof buf), -EXH_E_RANGE);
    p = sample(EXH_WIRE_PLANES);
    p.u.planes.plane[4].kind = EXH_PLANE_HIT;
    CHECK_EQ_I64(exh_wire_encode(&tx, &p, 0, buf, sizeof buf), -EXH_E_RANGE);
    p.type = 0;
    CHECK_EQ_I64(exh_wire_encode(&tx, &p, 0, buf, sizeof buf), -EXH_E_UNKNOWN);
    tx.session = 0;
    p = sample(EXH_WIRE_HELLO);
    CHECK_EQ_I64(exh_wire_encode(&tx, &p, 0, buf, sizeof buf), -EXH_E_RANGE);
    CHECK_EQ_I64(tx.seq, 5);
}

TEST(planes_and_round_trip)
{
    const struct exh_wire_packet p = sample(EXH_WIRE_PLANES);
    const struct exh_plane none = exh_wire_plane_of(&p.u.planes, 0);
    const struct exh_plane hit = exh_wire_plane_of(&p.u.planes, 1);
    CHECK_EQ_I64(none.kind, EXH_PLANE_NONE);
    CHECK(hit.kind == EXH_PLANE_HIT && hit.material == 4 && hit.object == 0x1234 &&
              hit.normal_q30.z == 1 << 30 && hit.point_m_q30.z == 100 && hit.point_m_q30.x == 0,
        "hit");
    CHECK_EQ_I64(exh_wire_round_trip_us(0x10, &p.u.planes), 0x20);
}

TEST(parameters_are_staged_and_answered)
{
    static const struct exh_signal rows[] = {
        {0x0401, 10, EXH_WHEN_MATERIAL, 0, 100, 5, "k", "", ""},
        {0x0402, 10, EXH_WHEN_SETUP, 0, 100, 5, "b", "", ""}};
    static const struct exh_signal_group group[] = {{rows, 2, 2}};
    static const struct exh_signal_table table = {group, 1};
    static const struct {
        struct exh_wire_param ask;
        int want;
    } c[] = {{{0x0401, 1, 100}, 0}, {{0x0401, 1, 101}, -EXH_E_RANGE},
        {{0x0401, 2, 1}, -EXH_E_UNKNOWN}, {{0x0402, 0, 6}, -EXH_E_STATE}};
    int32_t active[4], staged[4];
    struct exh_params params;
    exh_params_setup(&params, &table, active, staged);
    params.locked = 1;
    for (size_t i = 0; i < LEN(c); i++) {
        struct exh_wire_packet p = {.type = EXH_WIRE_PARAM, .seq = 40 + (uint32_t)i};
        struct exh_wire_ack ack;
        p.u.param = c[i].ask;
        ack = exh_wire_stage(&params, &p, 0);
        CHECK(ack.result == c[i].want && ack.request_seq == p.seq &&
                  memcmp(&ack.param, &c[i].ask, sizeof ack.param) == 0,
            "case %d", (int)i);
    }
    CHECK_EQ_I64(active[2], 5); /* instance 1 of k; applied between ticks, not here */
    CHECK(exh_params_apply(&params) == 1 && active[2] == 100 && active[0] == 5, "applied");
}

TEST(state_round_trip)
{
    struct exh_wire_rx rx = met(9, 10), back = {0};
    struct exh_wire_tx tx = {3, 4}, tx_back = {0, 0};
    uint8_t b[80];
    struct exh_bytes c = exh_bytes_writer(b, sizeof b);
    (void)take(&rx, write_as(EXH_WIRE_PARAM, 9, 12));
    (void)take(&rx, write_as(EXH_WIRE_PARAM, 8, 12));
    (void)exh_wire_poll(&rx, 123, 100);
    exh_wire_rx_serialize(&c, &rx);
    exh_wire_tx_serialize(&c, &tx);
    CHECK_EQ_I64(c.at, 72 + 8);
    c = exh_bytes_reader(b, c.at);
    exh_wire_rx_serialize(&c, &back);
    exh_wire_tx_serialize(&c, &tx_back);
    CHECK(exh_bytes_ok(&c) && memcmp(&rx, &back, sizeof rx) == 0 &&
              memcmp(&tx, &tx_back, sizeof tx) == 0,
        "the same");
}

TEST_MAIN("unit/wire", bytes_are_those_of_the_document, there_and_back,
    every_bit_flipped_and_every_byte_cut_off, values_that_cannot_be, a_trace_with_a_frame_too_many,
    a_trace_fits_a_packet_whole_and_no_frame_is_missed_unseen, only_what_is_newer,
    parameters_and_answers_may_be_late_but_once, sequence_numbers_wrap, far_ahead_is_not_believed,
    no_packet_makes_it_deaf_for_good, silence_is_only_what_is_heard_of_nobody,
    what_differs_is_said_by_name, a_step_over_all_that_is_remembered,
    a_restart_is_seen_by_its_hello, a_flood_of_sessions_keeps_nobody_out,
    a_packet_with_a_key_is_another_form, writing_refuses, planes_and_round_trip,
    parameters_are_staged_and_answered, state_round_trip);
