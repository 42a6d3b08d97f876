/* SPDX-License-Identifier: MIT */
/* wire.h over links that lose, delay, repeat, reorder and damage: what gets through is in
 * order, each once, and every packet is counted once. */
#include "exhand/wire.h"

#include "exhand/error.h"

#include "check.h"

#define PACKETS 300
#define FLIGHT  40

static struct exh_wire_packet any_packet(uint8_t type)
{
    struct exh_wire_packet p = {.type = type};
    if (type == EXH_WIRE_HELLO) {
        p.u.hello = (struct exh_wire_hello){
            .role = check_u64() & 1, .lib_version = (uint32_t)check_u64(), .table_crc = 7};
    } else if (type == EXH_WIRE_STATE) {
        p.u.state.fingers = check_u64() & 31;
        p.u.state.frozen = check_u64() & 31;
        p.u.state.state = (uint8_t)(check_u64() % 3);
        for (unsigned f = 0; f < EXH_FINGERS; f++) {
            p.u.state.tip_m_q30[f][f % 3] = check_i32();
            p.u.state.q_lim_m_q30[f] = check_i32();
        }
    } else if (type == EXH_WIRE_PLANES) {
        p.u.planes.echo_seq = (uint32_t)check_u64();
        p.u.planes.fingers = check_u64() & 31;
        for (unsigned f = 0; f < EXH_FINGERS; f++) {
            p.u.planes.plane[f].kind = p.u.planes.fingers >> f & 1 ? (uint8_t)(check_u64() % 3) : 0;
            p.u.planes.plane[f].point_m_q30[f % 3] = check_i32();
        }
    } else if (type == EXH_WIRE_PARAM) {
        p.u.param = (struct exh_wire_param){(uint16_t)check_u64(), 1, check_i32()};
    } else if (type == EXH_WIRE_TRACE_ASK) {
        p.u.trace_ask.every = (uint32_t)check_u64();
        p.u.trace_ask.index[check_u64() & 3] = (uint16_t)check_u64();
    } else if (type == EXH_WIRE_TRACE) {
        p.u.trace.first = (uint32_t)check_u64();
        p.u.trace.frames = (uint8_t)(check_u64() % (EXH_WIRE_FRAMES + 1));
        for (unsigned i = 0; i < p.u.trace.frames; i++) {
            p.u.trace.frame[i].raw[i & 3] = check_i32();
        }
    } else {
        p.u.ack.result = (int16_t)check_i32_in(-12, 0);
    }
    return p;
}

static uint32_t counted(const struct exh_wire_rx *rx)
{
    return rx->accepted + rx->duplicate + rx->reordered + rx->old + rx->stranger + rx->corrupt +
           rx->version + rx->unknown + rx->far;
}

TEST(there_and_back)
{
    while (check_case(10)) {
        struct exh_wire_tx tx = {(uint32_t)check_u64() | 1, (uint32_t)check_u64()};
        struct exh_wire_rx rx = {0};
        struct exh_wire_packet p = any_packet(EXH_WIRE_HELLO), back;
        uint8_t a[EXH_WIRE_MAX_B], b[EXH_WIRE_MAX_B];
        const int32_t hello_B = exh_wire_encode(&tx, &p, 0, a, sizeof a);
        const uint8_t type = (uint8_t)(1 + check_u64() % EXH_WIRE_TRACE);
        int32_t n, m;
        CHECK(exh_wire_decode(&rx, &back, a, (size_t)hello_B) == EXH_WIRE_HELLO, "hello");
        p = any_packet(type);
        n = exh_wire_encode(&tx, &p, (uint32_t)check_u64(), a, sizeof a);
        CHECK(exh_wire_decode(&rx, &back, a, (size_t)n) == type, "type %d", type);
        CHECK(back.seq == p.seq && back.stamp_us == p.stamp_us, "head");
        tx.seq = p.seq;
        m = exh_wire_encode(&tx, &back, p.stamp_us, b, sizeof b);
        CHECK(m == n && memcmp(a, b, (size_t)n) == 0, "bytes of type %d", type);
    }
}

TEST(noise_is_no_packet)
{
    while (check_case(10)) {
        struct exh_wire_rx rx = {0}, was = {0};
        struct exh_wire_packet p;
        uint8_t noise[EXH_WIRE_MAX_B + 8];
        const size_t n = (size_t)(check_u64() % sizeof noise);
        for (size_t i = 0; i < n; i++) { noise[i] = (uint8_t)check_u64(); }
        if (check_u64() & 1) { /* at least it looks like one */
            struct exh_bytes c = exh_bytes_writer(noise, n);
            uint16_t magic = EXH_WIRE_MAGIC, len = (uint16_t)(n - EXH_WIRE_OVERHEAD);
            uint8_t version = EXH_WIRE_VERSION, type = (uint8_t)(check_u64() % 7);
            exh_bytes_u16(&c, &magic);
            exh_bytes_u8(&c, &version);
            exh_bytes_u8(&c, &type);
            exh_bytes_u16(&c, &len);
        }
        CHECK(exh_wire_decode(&rx, &p, noise, n) < 0 && rx.corrupt == 1, "%d bytes", (int)n);
        was.corrupt = 1;
        CHECK(memcmp(&rx, &was, sizeof rx) == 0, "state");
    }
}

/* Packets in flight; each tick one is sent, perhaps twice, and one at random arrives. */
struct flight {
    uint8_t byte[EXH_WIRE_MAX_B];
    int32_t n;
    uint32_t seq;
    uint8_t damaged, may_be_late;
};

TEST(what_gets_through_is_in_order_and_each_once)
{
    static struct flight air[FLIGHT];
    uint32_t seen[5] = {0, 0, 0, 0, 0};
    while (check_case(2000)) {
        struct exh_wire_tx tx = {5, (uint32_t)check_u64()};
        const uint32_t first = tx.seq;
        struct exh_wire_rx rx = {0};
        struct exh_wire_packet p = any_packet(EXH_WIRE_HELLO);
        uint32_t came = 1, last = first, damaged = 0;
        uint8_t there[PACKETS + 1] = {1}; /* undamaged, within the window or in order */
        int in_air = 0;
        const int32_t n = exh_wire_encode(&tx, &p, 0, air[0].byte, sizeof air[0].byte);
        CHECK(exh_wire_decode(&rx, &p, air[0].byte, (size_t)n) == EXH_WIRE_HELLO, "hello");
        for (int k = 1; k <= PACKETS || in_air > 0; k++) {
            if (k <= PACKETS) {
                struct flight *f = &air[in_air];
                p = any_packet((uint8_t)(2 + check_u64() % 4));
                f->n = exh_wire_encode(&tx, &p, 0, f->byte, sizeof f->byte);
                f->seq = p.seq;
                f->may_be_late = p.type == EXH_WIRE_PARAM || p.type == EXH_WIRE_ACK;
                f->damaged = check_u64() % 20 == 0;
                if (f->damaged) {
                    const size_t bit = (size_t)(check_u64() % (8 * (uint64_t)f->n));
                    f->byte[bit / 8] = (uint8_t)(f->byte[bit / 8] ^ 1u << bit % 8);
                }
                in_air += check_u64() % 10 != 0; /* lost */
                if (check_u64() % 10 == 0 && in_air > 0 && in_air < FLIGHT - 1) {
                    air[in_air] = air[in_air - 1];
                    in_air++;
                }
            }
            while (in_air > 0 && (in_air >= FLIGHT - 2 || check_u64() & 1)) {
                const int i = check_u64() % 4 ? 0 : (int)(check_u64() % (uint64_t)in_air);
                const struct flight f = air[i];
                const int r = exh_wire_decode(&rx, &p, f.byte, (size_t)f.n);
                const int newer = f.seq - last - 1u < 0x7FFFFFFFu;
                in_air--;
                for (int j = i; j < in_air; j++) { air[j] = air[j + 1]; }
                came++;
                damaged += f.damaged;
                if (f.damaged) {
                    CHECK(r < 0, "damaged");
                    continue;
                }
                CHECK((r > 0) ==
                          (newer || (f.may_be_late && last - f.seq < 64 && !there[f.seq - first])),
                    "seq %" PRIu32 " after %" PRIu32, f.seq, last);
                last = newer ? f.seq : last;
                if (newer || last - f.seq < 64) { there[f.seq - first] = 1; }
            }
        }
        CHECK(counted(&rx) == came && rx.corrupt == damaged, "each counted once");
        {
            uint32_t lost = 0;
            for (uint32_t k = 0; k <= last - first; k++) { lost += !there[k]; }
            CHECK(rx.missing == lost, "missing %" PRIu32 ", %" PRIu32 " did not come", rx.missing,
                lost);
        }
        seen[0] += rx.accepted;
        seen[1] += rx.duplicate;
        seen[2] += rx.reordered;
        seen[3] += rx.corrupt;
        seen[4] += rx.missing;
    }
    CHECK(seen[0] == 0 || (seen[1] && seen[2] && seen[3] && seen[4]), "all kinds seen");
}

/* Before a good peer speaks, anything that is whole has come: any types, sessions, numbers. */
TEST(a_good_peer_is_heard_after_a_silence)
{
    while (check_case(200)) {
        struct exh_wire_tx good = {5, (uint32_t)check_u64()};
        struct exh_wire_rx rx = {0};
        struct exh_wire_packet p;
        uint8_t b[EXH_WIRE_MAX_B];
        const uint32_t limit_us = 1 + (uint32_t)(check_u64() % 5000000);
        int32_t n;
        for (int k = 0; k < 100; k++) {
            struct exh_wire_tx any = {3 + (uint32_t)(check_u64() % 4), (uint32_t)check_u64()};
            if (check_u64() & 1) { any.seq = rx.seq + (uint32_t)check_i32_in(-70, 70000); }
            p = any_packet((uint8_t)(check_u64() % 3 ? 1 : 1 + check_u64() % EXH_WIRE_TRACE));
            n = exh_wire_encode(&any, &p, 0, b, sizeof b);
            (void)exh_wire_decode(&rx, &p, b, (size_t)n);
            (void)exh_wire_poll(&rx, (uint32_t)(check_u64() % limit_us), limit_us);
        }
        if (rx.session == good.session && rx.seq == good.seq) { good.seq++; }
        (void)exh_wire_poll(&rx, limit_us, limit_us);
        p = any_packet(EXH_WIRE_HELLO);
        n = exh_wire_encode(&good, &p, 0, b, sizeof b);
        CHECK(exh_wire_decode(&rx, &p, b, (size_t)n) == EXH_WIRE_HELLO, "deaf");
        p = any_packet(EXH_WIRE_PLANES);
        n = exh_wire_encode(&good, &p, 0, b, sizeof b);
        CHECK(exh_wire_decode(&rx, &p, b, (size_t)n) == EXH_WIRE_PLANES, "deaf");
    }
}

TEST_MAIN("prop/wire", there_and_back, noise_is_no_packet,
    what_gets_through_is_in_order_and_each_once, a_good_peer_is_heard_after_a_silence);
