/* SPDX-License-Identifier: MIT */
/* Appends and checks number, echo and tag of packets on a link with a key. */
#include "exhand/keyed.h"

#include "exhand/error.h"

#include "../num/word.h"

#define LEN_AT  4u
#define ECHO_AT 8u /* after the packet */
#define TAG_AT  16u
#define WHO     (UINT64_C(1) << 63) /* bit of a number: the sender's role */
#define WINDOW  64u
#define RUN     (UINT64_C(1) << 32) /* numbers so near are of one run */

static uint64_t get(const uint8_t *p) { return (uint64_t)word_at(p + 4) << 32 | word_at(p); }

static void put(uint8_t *p, uint64_t v)
{
    put_word(p, (uint32_t)(v & UINT32_MAX));
    put_word(p + 4, (uint32_t)(v >> 32));
}

void exh_keyed_setup(
    struct exh_keyed *s, const struct exh_mac_key *key, enum exh_wire_role ours, uint64_t start)
{
    static const struct exh_keyed none = {0};
    *s = none;
    s->key = *key;
    s->next = (start & (WHO / 2 - 1)) | 1u; /* 0 is no number, and none reaches WHO */
    if (ours == EXH_WIRE_WORLD) { s->next |= WHO; }
    s->since = s->next;
}

int32_t exh_keyed_encode(struct exh_keyed *s, void *buf, size_t len_B, size_t cap_B)
{
    uint8_t *const behind = (uint8_t *)buf + len_B;
    if (cap_B < EXH_KEYED_B || len_B > cap_B - EXH_KEYED_B) { return -EXH_E_SHORT; }
    put(behind, s->next++);
    put(behind + ECHO_AT, s->heard);
    put(behind + TAG_AT, exh_mac(&s->key, buf, len_B + TAG_AT));
    return (int32_t)(len_B + EXH_KEYED_B);
}

/* --- receiving --- */

static int32_t refuse(uint32_t *count, int error)
{
    ++*count;
    return -error;
}

/* 1 for an undamaged packet of the stated length. */
static int is_packet(const uint8_t *p, size_t whole_B)
{
    return word_at(p + whole_B - 4) == exh_crc32(0, p, whole_B - 4);
}

/* A number of the accepted run. 1: pass on. */
static int in_run(struct exh_keyed *s, uint64_t number)
{
    const uint64_t ahead = number - s->newest, late = s->newest - number;
    if (ahead - 1 < RUN) {
        s->seen = ahead < WINDOW ? s->seen << ahead | 1u : 1u;
        s->newest = s->heard = number;
        return 1;
    }
    if (late >= WINDOW || s->seen >> late & 1u) { return 0; }
    s->seen |= UINT64_C(1) << late;
    return 1;
}

/* A packet with a correct tag. 1: pass on, 0: unproved, < 0: again. */
static int judge(struct exh_keyed *s, uint64_t number, uint64_t echo)
{
    const int fresh = s->next - echo - 1 < EXH_WIRE_AHEAD;
    if (((number ^ s->next) & WHO) == 0) { return -1; } /* our own packet returned */
    if (s->newest != 0 && number - s->newest + RUN < 2 * RUN) {
        return fresh && in_run(s, number) ? 1 : -1;
    }
    s->heard = number;
    if (!fresh || echo - s->since >= s->next - s->since) { return 0; }
    s->newest = number;
    s->seen = UINT64_MAX; /* its packets before the proof are not accepted */
    s->since = s->next;   /* recordings made so far prove nothing any more */
    return 1;
}

int32_t exh_keyed_decode(struct exh_keyed *s, const void *buf, size_t len_B)
{
    const uint8_t *const p = (const uint8_t *)buf;
    uint32_t whole_B;
    int is;
    if (len_B < EXH_WIRE_OVERHEAD) { return refuse(&s->damaged, EXH_E_SHORT); }
    whole_B = EXH_WIRE_OVERHEAD + (p[LEN_AT] | (uint32_t)p[LEN_AT + 1] << 8);
    if (len_B == whole_B && is_packet(p, whole_B)) { return refuse(&s->no_key, EXH_E_VERSION); }
    if (len_B != whole_B + EXH_KEYED_B) { return refuse(&s->damaged, EXH_E_SHORT); }
    if (exh_mac(&s->key, p, whole_B + TAG_AT) != get(p + whole_B + TAG_AT)) {
        return is_packet(p, whole_B) ? refuse(&s->other_key, EXH_E_CRC)
                                     : refuse(&s->damaged, EXH_E_SHORT);
    }
    is = judge(s, get(p + whole_B), get(p + whole_B + ECHO_AT));
    if (is < 0) { return refuse(&s->again, EXH_E_STALE); }
    if (is == 0) { return refuse(&s->unproved, 0); }
    s->taken++;
    return (int32_t)whole_B;
}
