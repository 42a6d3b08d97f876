/* SPDX-License-Identifier: MIT */
/* keyed.h: two ends with a key, with none, with another; what was recorded; who starts again. */
#include "exhand/keyed.h"

#include "exhand/error.h"

#include "check.h"

#define BOX   EXH_WIRE_CONTROLLER
#define WORLD EXH_WIRE_WORLD

struct datagram {
    uint8_t byte[EXH_KEYED_MAX_B];
    size_t len_B;
};

static struct exh_mac_key key_of(uint8_t first)
{
    uint8_t byte[EXH_MAC_KEY_B];
    for (unsigned i = 0; i < sizeof byte; i++) { byte[i] = (uint8_t)(first + i); }
    return exh_mac_key(byte);
}

static struct exh_keyed end_of(uint8_t key, enum exh_wire_role role, uint64_t start)
{
    const struct exh_mac_key k = key_of(key);
    struct exh_keyed s;
    exh_keyed_setup(&s, &k, role, start);
    return s;
}

static struct datagram plain(uint8_t role)
{
    struct exh_wire_tx tx = {9, 4};
    struct exh_wire_packet p = {.type = EXH_WIRE_HELLO};
    struct datagram d;
    p.u.hello.role = role;
    d.len_B = (size_t)exh_wire_encode(&tx, &p, 0, d.byte, sizeof d.byte);
    return d;
}

static struct datagram from(struct exh_keyed *s)
{
    struct datagram d = plain((uint8_t)(s->next >> 63));
    const size_t whole_B = d.len_B;
    d.len_B = (size_t)exh_keyed_encode(s, d.byte, d.len_B, sizeof d.byte);
    CHECK_EQ_I64((int64_t)d.len_B, (int64_t)whole_B + EXH_KEYED_B);
    return d;
}

static int32_t give(struct exh_keyed *s, const struct datagram *d)
{
    return exh_keyed_decode(s, d->byte, d->len_B);
}

static int32_t send(struct exh_keyed *a, struct exh_keyed *b)
{
    const struct datagram d = from(a);
    return give(b, &d);
}

#define HELLO_B (29 + EXH_WIRE_OVERHEAD)

/* Both believe each other after three packets. */
static void meet(struct exh_keyed *a, struct exh_keyed *b)
{
    CHECK_EQ_I64(send(a, b), 0);
    CHECK_EQ_I64(send(b, a), HELLO_B);
    CHECK_EQ_I64(send(a, b), HELLO_B);
    CHECK(b->unproved == 1 && a->unproved == 0 && a->taken == 1 && b->taken == 1, "met");
}

TEST(both_are_believed_after_three_packets)
{
    struct exh_keyed box = end_of(1, BOX, 77), world = end_of(1, WORLD, 77);
    meet(&box, &world);
    for (int k = 0; k < 100; k++) {
        CHECK_EQ_I64(send(&box, &world), HELLO_B);
        CHECK_EQ_I64(send(&world, &box), HELLO_B);
    }
}

TEST(what_is_handed_on_is_the_packet)
{
    struct exh_keyed box = end_of(1, BOX, 0), world = end_of(1, WORLD, 0);
    const struct datagram p = plain(BOX);
    struct datagram d;
    meet(&box, &world);
    d = from(&box);
    CHECK_EQ_I64(give(&world, &d), (int64_t)p.len_B);
    CHECK(memcmp(p.byte, d.byte, p.len_B) == 0, "the same bytes");
}

TEST(keys_that_do_not_fit_are_told_apart)
{
    struct exh_keyed box = end_of(1, BOX, 1), world = end_of(2, WORLD, 1);
    struct exh_wire_rx rx = {0};
    struct exh_wire_packet p;
    struct datagram d = plain(WORLD);
    CHECK_EQ_I64(give(&box, &d), -EXH_E_VERSION);
    CHECK_EQ_I64(send(&world, &box), -EXH_E_CRC);
    d.byte[9] ^= 4; /* without a key, and damaged */
    CHECK_EQ_I64(give(&box, &d), -EXH_E_SHORT);
    d = from(&world);
    d.byte[19] ^= 4;
    CHECK_EQ_I64(give(&box, &d), -EXH_E_SHORT);
    CHECK(box.no_key == 1 && box.other_key == 1 && box.damaged == 2 && box.heard == 0, "named");
    d = from(&world);
    CHECK_EQ_I64(exh_wire_decode(&rx, &p, d.byte, d.len_B), -EXH_E_VERSION);
    CHECK(rx.version == 1 && rx.session == 0, "who has no key says that it is another form");
}

TEST(every_bit_and_every_length)
{
    struct exh_keyed box = end_of(1, BOX, 5), world = end_of(1, WORLD, 6);
    struct datagram d;
    meet(&box, &world);
    d = from(&world);
    for (size_t bit = 0; bit < 8 * d.len_B; bit++) {
        struct exh_keyed is = box;
        d.byte[bit / 8] = (uint8_t)(d.byte[bit / 8] ^ 1u << bit % 8);
        CHECK(give(&is, &d) < 0 && is.damaged + is.other_key == 1, "bit %d", (int)bit);
        is.damaged = is.other_key = 0;
        CHECK(memcmp(&is, &box, sizeof is) == 0, "bit %d changed a state", (int)bit);
        d.byte[bit / 8] = (uint8_t)(d.byte[bit / 8] ^ 1u << bit % 8);
    }
    for (size_t n = 0; n <= sizeof d.byte; n++) {
        struct exh_keyed is = box;
        if (n != d.len_B) {
            CHECK(exh_keyed_decode(&is, d.byte, n) < 0 && is.taken == box.taken, "%d", (int)n);
        }
    }
    CHECK_EQ_I64(give(&box, &d), HELLO_B);
}

TEST(each_number_once_and_late_ones_too)
{
    struct exh_keyed box = end_of(1, BOX, 5), world = end_of(1, WORLD, 6);
    static struct datagram d[80];
    meet(&box, &world);
    for (int k = 0; k < 80; k++) { d[k] = from(&world); }
    CHECK_EQ_I64(give(&box, &d[70]), HELLO_B);
    CHECK_EQ_I64(give(&box, &d[70]), -EXH_E_STALE);
    CHECK_EQ_I64(give(&box, &d[7]), HELLO_B); /* 63 late */
    CHECK_EQ_I64(give(&box, &d[7]), -EXH_E_STALE);
    CHECK_EQ_I64(give(&box, &d[6]), -EXH_E_STALE);
    CHECK_EQ_I64(give(&box, &d[79]), HELLO_B);
    CHECK_EQ_I64(give(&box, &d[69]), HELLO_B);
    CHECK_EQ_I64(box.again, 3);
}

/* What it sent before the one that proved it is not waited for. */
TEST(what_came_before_the_proof_is_over)
{
    struct exh_keyed box = end_of(1, BOX, 5), world = end_of(1, WORLD, 6);
    struct datagram first, second;
    CHECK_EQ_I64(send(&box, &world), 0);
    first = from(&world);
    second = from(&world);
    CHECK_EQ_I64(give(&box, &second), HELLO_B);
    CHECK_EQ_I64(give(&box, &first), -EXH_E_STALE);
}

TEST(our_own_packets_come_back)
{
    struct exh_keyed box = end_of(1, BOX, 5);
    const struct datagram first = from(&box);
    struct datagram d;
    CHECK_EQ_I64(give(&box, &first), -EXH_E_STALE);
    d = from(&box);
    CHECK(give(&box, &d) == -EXH_E_STALE && box.heard == 0 && box.newest == 0, "an echo");
}

/* No end has restarted, there was a long silence, all recorded packets come again. */
TEST(a_recorded_run_is_not_believed)
{
    struct exh_keyed box = end_of(1, BOX, 1u << 20), world = end_of(1, WORLD, 2u << 20), anew;
    static struct datagram said[200];
    meet(&box, &world);
    for (int k = 0; k < 200; k++) {
        said[k] = from(&world);
        CHECK_EQ_I64(give(&box, &said[k]), HELLO_B);
        CHECK_EQ_I64(send(&box, &world), HELLO_B);
    }
    for (int k = 0; k < 200; k++) { CHECK_EQ_I64(give(&box, &said[k]), -EXH_E_STALE); }
    anew = end_of(1, WORLD, UINT64_C(3) << 40); /* the world starts again */
    CHECK_EQ_I64(send(&anew, &box), 0);
    CHECK_EQ_I64(send(&box, &anew), HELLO_B);
    CHECK_EQ_I64(send(&anew, &box), HELLO_B);
    for (int k = 0; k < 200; k++) { CHECK_EQ_I64(give(&box, &said[k]), 0); }
    CHECK_EQ_I64(send(&anew, &box), HELLO_B);
    box = end_of(1, BOX, UINT64_C(9) << 33); /* and the box */
    for (int k = 0; k < 200; k++) { CHECK_EQ_I64(give(&box, &said[k]), 0); }
    CHECK(box.taken == 0 && box.unproved == 200, "recorded before it was there");
    CHECK_EQ_I64(send(&anew, &box), 0);
    CHECK_EQ_I64(send(&box, &anew), HELLO_B);
    CHECK_EQ_I64(send(&anew, &box), HELLO_B);
}

/* Held back until it says nothing that is true. */
TEST(what_echoes_a_number_of_long_ago_is_not_taken)
{
    struct exh_keyed box = end_of(1, BOX, 5), world = end_of(1, WORLD, 6);
    struct datagram held[3];
    meet(&box, &world);
    for (int k = 0; k < 3; k++) { held[k] = from(&world); }
    box.next += EXH_WIRE_AHEAD - 1; /* lost, all of them */
    CHECK_EQ_I64(give(&box, &held[0]), HELLO_B);
    box.next++;
    CHECK_EQ_I64(give(&box, &held[1]), -EXH_E_STALE);
    world.heard = box.next; /* as if it knew what is still to be sent */
    held[2] = from(&world);
    CHECK_EQ_I64(give(&box, &held[2]), -EXH_E_STALE);
}

TEST(room)
{
    struct exh_keyed box = end_of(1, BOX, 5);
    struct datagram d = plain(BOX);
    const uint64_t next = box.next;
    CHECK_EQ_I64(exh_keyed_encode(&box, d.byte, d.len_B, d.len_B + EXH_KEYED_B - 1), -EXH_E_SHORT);
    CHECK_EQ_I64(exh_keyed_encode(&box, d.byte, d.len_B, 3), -EXH_E_SHORT);
    {
        struct exh_keyed fits = box;
        struct datagram whole = d;
        const uint32_t all_B = (uint32_t)d.len_B + EXH_KEYED_B;
        CHECK(exh_keyed_encode(&fits, whole.byte, d.len_B, all_B) == (int32_t)all_B, "just room");
    }
    CHECK(box.next == next, "nothing is used up");
}

TEST_MAIN("unit/keyed", both_are_believed_after_three_packets, what_is_handed_on_is_the_packet,
    keys_that_do_not_fit_are_told_apart, every_bit_and_every_length,
    each_number_once_and_late_ones_too, what_came_before_the_proof_is_over,
    our_own_packets_come_back, a_recorded_run_is_not_believed,
    what_echoes_a_number_of_long_ago_is_not_taken, room);
