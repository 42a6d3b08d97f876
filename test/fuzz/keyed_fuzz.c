/* SPDX-License-Identifier: MIT */
/* A socket with a key gets any packets. The attacker knows the true packets, and sometimes the key.
 *
 * An input is a sequence of datagrams in the format of wire_fuzz.c, so both share a corpus. Before
 * each are a byte and a length (u16), whose upper 7 bits are its delay. Bits of the byte repair the
 * datagram: 0 length, 1 CRC, and behind the packet 2 number, 3 echo, 4 tag. Bit 5: the box sends
 * one before. Bit 6: the world starts again. Bit 7: the datagram comes twice.
 *
 * Rules: No read is outside the datagram. Each datagram raises one count. An accepted packet has a
 * tag of the key, a new number, and an echo of a number of ours. No packet of an earlier run is
 * accepted that is older than this run. A refused one changes only a count or the next echo.
 * Afterwards two honest peers hear each other. */
#include "fails.h"
#include "must.h"

#include "exhand/error.h"
#include "exhand/keyed.h"

#include <string.h>

#define LENGTH 1u
#define CRC    2u
#define NUMBER 4u
#define ECHO   8u
#define TAG    16u
#define SAYS   32u
#define ANEW   64u
#define TWICE  128u
#define TAKEN  4096u

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

static struct exh_keyed box, world;
static uint64_t taken[TAKEN], since; /* numbers that came; the box's when a run began */
static unsigned taken_n;

static void put(uint8_t *p, uint64_t v, unsigned n)
{
    for (unsigned i = 0; i < n; i++) { p[i] = (uint8_t)(v >> 8 * i & 0xFF); }
}

static uint64_t get(const uint8_t *p)
{
    uint64_t v = 0;
    for (unsigned i = 8; i > 0; i--) { v = v << 8 | p[i - 1]; }
    return v;
}

/* Repairs the requested fields, and returns the length of all. */
static size_t make(uint8_t *p, size_t n, unsigned right, unsigned late)
{
    uint8_t *const tail = p + n;
    if (n >= EXH_WIRE_OVERHEAD && right & LENGTH) { put(p + 4, n - EXH_WIRE_OVERHEAD, 2); }
    if (n >= EXH_WIRE_OVERHEAD && right & CRC) { put(tail - 4, exh_crc32(0, p, n - 4), 4); }
    if (!(right & (NUMBER | ECHO | TAG))) { return n; }
    put(tail, right & NUMBER ? world.next - late : late, 8);
    put(tail + 8, right & ECHO ? box.next - 1 - ((uint64_t)late / 16 << 14) : late, 8);
    put(tail + 16, right & TAG ? exh_mac(&world.key, p, n + 16) : late, 8);
    world.next += late == 0;
    return n + EXH_KEYED_B;
}

static uint32_t counts(const struct exh_keyed *s)
{
    return s->taken + s->no_key + s->other_key + s->unproved + s->again + s->damaged;
}

static void handed_on(const struct exh_keyed *was, const uint8_t *p, size_t n)
{
    const uint64_t number = get(p + n - 24), echo = get(p + n - 16);
    MUST(exh_mac(&world.key, p, n - 8) == get(p + n - 8));
    MUST(number >> 63 == 1 && box.next - echo - 1 < EXH_WIRE_AHEAD);
    for (unsigned i = 0; i < taken_n; i++) { MUST(taken[i] != number); }
    if (taken_n < TAKEN) { taken[taken_n++] = number; }
    if (was->newest != 0 && number - was->newest + (UINT64_C(1) << 32) < UINT64_C(2) << 32) {
        return;
    }
    MUST(echo - since < box.next - since); /* another run */
    since = box.next;
}

static void refused(const struct exh_keyed *was, int32_t r)
{
    struct exh_keyed is = box;
    MUST(r <= 0 && is.taken == was->taken);
    is.no_key = was->no_key;
    is.other_key = was->other_key;
    is.unproved = was->unproved;
    is.again = was->again;
    is.damaged = was->damaged;
    if (r == 0) { is.heard = was->heard; }
    MUST(memcmp(&is, was, sizeof is) == 0);
}

static void say(struct exh_keyed *from, struct exh_keyed *to, int must)
{
    struct exh_wire_tx tx = {1, 1};
    struct exh_wire_packet p = {.type = EXH_WIRE_HELLO};
    uint8_t buf[EXH_KEYED_MAX_B];
    const int32_t n = exh_wire_encode(&tx, &p, 0, buf, sizeof buf);
    const int32_t all = exh_keyed_encode(from, buf, (size_t)n, sizeof buf);
    const int32_t r = exh_keyed_decode(to, buf, (size_t)all);
    MUST(all == n + (int32_t)EXH_KEYED_B && (!must || r == n));
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    const struct exh_mac_key key = {{1, 2}};
    uint64_t start = UINT64_C(1) << 40;
    exh_keyed_setup(&box, &key, EXH_WIRE_CONTROLLER, 9);
    exh_keyed_setup(&world, &key, EXH_WIRE_WORLD, start);
    taken_n = 0;
    since = box.next;
    say(&box, &world, 0);
    while (size >= 3) {
        const unsigned right = data[0], late = data[2] >> 1;
        uint8_t p[512 + EXH_KEYED_B];
        size_t n = data[1] | (size_t)(data[2] & 1) << 8, all;
        n = n < size - 3 ? n : size - 3;
        if (right & SAYS) {
            box.next += (uint64_t)late << 10; /* lost, all of them */
            say(&box, &world, 0);
        }
        if (right & ANEW) {
            exh_keyed_setup(&world, &key, EXH_WIRE_WORLD, start += UINT64_C(1) << 40);
        }
        memcpy(p, data + 3, n);
        all = make(p, n, right, late);
        for (unsigned k = 0; k <= (right & TWICE ? 1u : 0u); k++) {
            const struct exh_keyed was = box;
            uint8_t *const exact = malloc(all + !all); /* its end is watched */
            int32_t r;
            memcpy(exact, p, all);
            r = exh_keyed_decode(&box, exact, all);
            MUST(counts(&box) == counts(&was) + 1);
            if (r > 0) { handed_on(&was, p, all); }
            if (r <= 0) { refused(&was, r); }
            free(exact);
        }
        data += 3 + n;
        size -= 3 + n;
    }
    exh_keyed_setup(&world, &key, EXH_WIRE_WORLD, start + (UINT64_C(1) << 40));
    say(&world, &box, 0);
    say(&box, &world, 1);
    say(&world, &box, 1);
    return 0;
}
