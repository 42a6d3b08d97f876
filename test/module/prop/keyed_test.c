/* SPDX-License-Identifier: MIT */
/* keyed.h against an attacker who records, delays, repeats, reorders, damages and forges packets,
 * while both ends start and stop. No packet acts that the model does not accept as sent now. */
#include "exhand/keyed.h"

#include "check.h"

#define KEPT 256 /* recorded packets, the oldest are written over now and then */

struct kept {
    uint8_t byte[EXH_KEYED_MAX_B];
    size_t len_B;
    uint32_t world, box; /* runs of who said it, and of whom it had heard last */
    uint64_t number;     /* of what was said in this run; 0: by the box */
    uint8_t touched;
};

static struct kept kept[KEPT];
static struct exh_keyed box, world;
static uint32_t worlds, boxes; /* runs so far */
static uint32_t heard_box;     /* run of the box that the world heard last */
static struct exh_mac_key key, other;

static void start(struct exh_keyed *s, enum exh_wire_role role, uint32_t *runs)
{
    exh_keyed_setup(s, &key, role, check_u64());
    ++*runs;
}

static struct kept *any(void) { return &kept[check_u64() % KEPT]; }

static struct kept *put(
    struct kept *k, struct exh_keyed *s, const struct exh_mac_key *by, uint64_t number)
{
    struct exh_wire_tx tx = {5, (uint32_t)check_u64()};
    struct exh_wire_packet p = {.type = EXH_WIRE_PARAM};
    const struct exh_mac_key was = s->key;
    k->len_B = (size_t)exh_wire_encode(&tx, &p, 0, k->byte, sizeof k->byte);
    s->key = *by;
    k->len_B = (size_t)exh_keyed_encode(s, k->byte, k->len_B, sizeof k->byte);
    s->key = was;
    k->world = worlds;
    k->box = heard_box;
    k->number = number;
    k->touched = by != &key;
    return k;
}

static struct kept *say(struct exh_keyed *s, const struct exh_mac_key *by, uint64_t number)
{
    return put(any(), s, by, number);
}

/* One change of any kind. */
static void spoil(struct kept *k)
{
    const struct kept was = *k, *const from = any();
    const size_t at = (size_t)(check_u64() % k->len_B);
    const size_t tail_B = EXH_KEYED_B - (check_u64() & 1 ? EXH_MAC_B : 0);
    switch (check_u64() % 4) {
    case 0: k->byte[at] = (uint8_t)(k->byte[at] ^ 1u << check_u64() % 8); break;
    case 1: k->len_B = at; break;
    case 2: /* another packet's number, echo and perhaps tag behind this one */
        if (from->len_B < EXH_KEYED_B) { break; }
        memcpy(k->byte + k->len_B - EXH_KEYED_B, from->byte + from->len_B - EXH_KEYED_B, tail_B);
        break;
    default: k->len_B -= EXH_KEYED_B; break;
    }
    k->touched |= k->len_B != was.len_B || memcmp(k->byte, was.byte, k->len_B) != 0;
}

static void listen(const struct kept *k)
{
    if (exh_keyed_decode(&world, k->byte, k->len_B) >= 0) { heard_box = boxes; }
}

TEST(nothing_recorded_acts)
{
    uint64_t acted = 0, tried = 0;
    const uint8_t a[EXH_MAC_KEY_B] = {1}, b[EXH_MAC_KEY_B] = {2};
    key = exh_mac_key(a);
    other = exh_mac_key(b);
    while (check_case(100)) {
        uint32_t believed = 0; /* run of the world */
        uint64_t said = 0, seen[4096 / 64] = {0};
        memset(kept, 0, sizeof kept);
        worlds = boxes = heard_box = 0;
        start(&box, EXH_WIRE_CONTROLLER, &boxes);
        start(&world, EXH_WIRE_WORLD, &worlds);
        for (int step = 0; step < 100; step++) {
            const unsigned what = (unsigned)(check_u64() % 64);
            struct kept k;
            int32_t r;
            if (what == 0) { start(&box, EXH_WIRE_CONTROLLER, &boxes), believed = 0; }
            if (what == 1) { start(&world, EXH_WIRE_WORLD, &worlds), heard_box = 0, said = 0; }
            if (what < 16) { listen(say(&box, &key, 0)); }
            if (what < 24) {
                k = *say(&world, check_u64() % 8 ? &key : &other, ++said);
            } else {
                k = *any();
            }
            if (k.len_B > EXH_KEYED_B && check_u64() % 4 == 0) { spoil(&k); }
            tried++;
            r = exh_keyed_decode(&box, k.byte, k.len_B);
            if (r <= 0) { continue; }
            acted++;
            CHECK(!k.touched && k.number > 0, "spoilt, or of the box itself");
            CHECK(k.box == boxes, "said to a run of the box that is over");
            CHECK(k.world >= believed, "run %" PRIu32 " after %" PRIu32, k.world, believed);
            if (k.world != believed) { memset(seen, 0, sizeof seen); }
            believed = k.world;
            CHECK(!(seen[k.number / 64] >> k.number % 64 & 1), "twice");
            seen[k.number / 64] |= UINT64_C(1) << k.number % 64;
        }
    }
    CHECK(tried == 0 || acted > tried / 1000, "nothing was said: %d of %d", (int)acted, (int)tried);
}

static int32_t hear(const struct kept *k) { return exh_keyed_decode(&box, k->byte, k->len_B); }

/* A run of both that is over, one of the world, and this one: all of it came, none is held back.
 * Some have another key. */
static void record(void)
{
    const struct exh_mac_key *const by[] = {&key, &key, &other};
    for (unsigned k = 0; k < KEPT; k++) {
        if (k == 0 || k == KEPT / 4) { start(&box, EXH_WIRE_CONTROLLER, &boxes); }
        if (k == 0 || k == KEPT / 4 || k == KEPT / 2) { start(&world, EXH_WIRE_WORLD, &worlds); }
        listen(put(&kept[k], &box, &key, 0));
        if (k % 4 == 0) { continue; }
        (void)hear(put(&kept[k], &world, by[k % 4 - 1], k));
    }
}

/* An attacker has all packets of this and earlier runs. He sends them in any order, complete,
 * damaged, combined or cut. None of his packets acts. Sometimes the world sends a true one. */
TEST(a_million_packets_act_never)
{
    const uint8_t a[EXH_MAC_KEY_B] = {1}, b[EXH_MAC_KEY_B] = {2};
    uint64_t tried = 0;
    key = exh_mac_key(a);
    other = exh_mac_key(b);
    record();
    while (check_case(1)) {
        struct kept k = *any();
        const uint32_t taken = box.taken;
        const uint64_t newest = box.newest, seen = box.seen;
        if (k.len_B > EXH_KEYED_B && check_u64() % 2) { spoil(&k); }
        CHECK(hear(&k) <= 0 && box.taken == taken, "it acts");
        CHECK(box.newest == newest && box.seen == seen, "the window is another");
        if (++tried % 4096 != 1) { continue; }
        listen(say(&box, &key, 0)); /* it proves the peer again */
        CHECK(hear(say(&world, &key, 1)) > 0, "the world is not heard");
    }
    check_note("keyed: %" PRIu64 " packets without the key or not of now, 0 act", tried);
}

/* Whatever was thrown at both, two that are there find each other in three packets. */
TEST(those_that_are_there_are_heard)
{
    const uint8_t a[EXH_MAC_KEY_B] = {1};
    key = exh_mac_key(a);
    while (check_case(1000)) {
        memset(kept, 0, sizeof kept);
        worlds = boxes = 0;
        start(&box, EXH_WIRE_CONTROLLER, &boxes);
        start(&world, EXH_WIRE_WORLD, &worlds);
        for (int step = 0; step < 60; step++) {
            const struct kept *k = any();
            if (check_u64() % 16 == 0) { start(&world, EXH_WIRE_WORLD, &worlds); }
            if (check_u64() % 16 == 0) { start(&box, EXH_WIRE_CONTROLLER, &boxes); }
            (void)exh_keyed_decode(&world, say(&box, &key, 0)->byte, any()->len_B);
            (void)exh_keyed_decode(&box, say(&world, &key, 1)->byte, any()->len_B);
            if (k->len_B > 0) { (void)exh_keyed_decode(&box, k->byte, k->len_B); }
        }
        for (int k = 0; k < 2; k++) {
            const struct kept *d = say(&world, &key, 1);
            (void)exh_keyed_decode(&box, d->byte, d->len_B);
            d = say(&box, &key, 0);
            (void)exh_keyed_decode(&world, d->byte, d->len_B);
        }
        {
            const struct kept *d = say(&world, &key, 1);
            CHECK(exh_keyed_decode(&box, d->byte, d->len_B) > 0, "the box is deaf");
            d = say(&box, &key, 0);
            CHECK(exh_keyed_decode(&world, d->byte, d->len_B) > 0, "the world is deaf");
        }
    }
}

TEST_MAIN("prop/keyed", nothing_recorded_acts, a_million_packets_act_never,
    those_that_are_there_are_heard);
