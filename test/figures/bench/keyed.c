/* SPDX-License-Identifier: MIT */
/* A link with a key: what the tag of a STATE costs, alone and in who sends and who takes it. */
#include "bench.h"

#include "exhand/keyed.h"

#define STATE_B (214 + EXH_WIRE_OVERHEAD)

static struct exh_keyed box, world;
static uint8_t packet[EXH_KEYED_MAX_B];

/* Both have met, and a packet is there that is the newest. */
static void meet(void)
{
    const struct exh_mac_key key = {{1, 2}};
    struct exh_wire_tx tx = {1, 1};
    struct exh_wire_packet p = {.type = EXH_WIRE_STATE};
    exh_keyed_setup(&box, &key, EXH_WIRE_CONTROLLER, 1);
    exh_keyed_setup(&world, &key, EXH_WIRE_WORLD, 1);
    for (int k = 0; k < 3; k++) {
        struct exh_keyed *const from = k & 1 ? &box : &world, *const to = k & 1 ? &world : &box;
        (void)exh_wire_encode(&tx, &p, 0, packet, sizeof packet);
        (void)exh_keyed_encode(from, packet, STATE_B, sizeof packet);
        bench_sink = exh_keyed_decode(to, packet, STATE_B + EXH_KEYED_B);
    }
}

static void mac_op(uint32_t i)
{
    (void)i;
    bench_sink = (int64_t)(exh_mac(&box.key, packet, STATE_B + 16) >> 1);
}

static void encode_op(uint32_t i)
{
    (void)i;
    bench_sink = exh_keyed_encode(&world, packet, STATE_B, sizeof packet);
}

static void decode_op(uint32_t i)
{
    (void)i;
    box.newest--; /* it comes for the first time */
    bench_sink = exh_keyed_decode(&box, packet, STATE_B + EXH_KEYED_B);
}

/* The paper's own example. */
static void mac_error(struct error *e)
{
    uint8_t byte[EXH_MAC_KEY_B];
    struct exh_mac_key key;
    for (unsigned i = 0; i < sizeof byte; i++) { byte[i] = (uint8_t)i; }
    key = exh_mac_key(byte);
    error_add(e, exh_mac(&key, byte, 15) != UINT64_C(0xA129CA6149BE45E5));
}

static void keyed_error(struct error *e)
{
    meet();
    decode_op(0);
    error_add(e, bench_sink != STATE_B);
}

static const struct kernel kernels[] = {
    {"mac_252B", "wrong", 1, 0, 1, meet, mac_op, mac_error, "the tag in the paper's appendix", 0,
        NULL},
    {"keyed_encode", "wrong", 1, 0, 1, meet, encode_op, keyed_error, "a STATE; what goes out", 0,
        NULL},
    {"keyed_decode", "wrong", 1, 0, 1, meet, decode_op, keyed_error, "a STATE; what is handed on",
        0, NULL},
};
const struct kernel_group keyed_group = {kernels, sizeof kernels / sizeof kernels[0]};
