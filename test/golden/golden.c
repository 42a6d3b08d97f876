/* SPDX-License-Identifier: MIT */
/* The stimuli of README.md and the digest of a run. */
#include "golden.h"

#include "exhand/fix.h"

void golden_put(struct golden *g, int64_t v)
{
    if (g->columns == GOLDEN_COLUMNS) { CHECK(0, "more than %u columns", GOLDEN_COLUMNS); }
    g->v[g->columns++] = v;
}

struct exh_bytes golden_state(struct golden *g)
{
    return exh_bytes_writer(g->state + g->state_B, GOLDEN_STATE_B - g->state_B);
}

void golden_state_end(struct golden *g, const struct exh_bytes *c)
{
    if (!exh_bytes_ok(c)) { CHECK(0, "state of more than %u B", GOLDEN_STATE_B); }
    g->state_B += c->at;
}

/* CRC-32 by a separate table: the library's is under test. */
static uint32_t crc_add(uint32_t crc, const uint8_t *p, uint32_t n)
{
    static uint32_t table[256];
    if (table[1] == 0) {
        for (uint32_t i = 0; i < 256; i++) {
            uint32_t c = i;
            for (unsigned b = 0; b < 8; b++) { c = c >> 1 ^ (c & 1 ? 0xEDB88320u : 0); }
            table[i] = c;
        }
    }
    crc = ~crc;
    for (uint32_t i = 0; i < n; i++) { crc = crc >> 8 ^ table[(crc ^ p[i]) & 0xFF]; }
    return ~crc;
}

uint32_t golden_crc_u32(uint32_t crc, uint32_t v)
{
    uint8_t byte[4];
    for (unsigned b = 0; b < 4; b++) { byte[b] = (uint8_t)(v >> 8 * b); }
    return crc_add(crc, byte, 4);
}

void golden_tick(struct golden *g)
{
    for (uint32_t i = 0; i < g->columns; i++) {
        uint8_t byte[8];
        for (unsigned b = 0; b < 8; b++) { byte[b] = (uint8_t)((uint64_t)g->v[i] >> 8 * b); }
        g->crc = crc_add(g->crc, byte, 8);
    }
    g->crc = crc_add(g->crc, g->state, g->state_B);
    if (g->see != NULL) { g->see(g); }
    g->tick++;
    g->columns = 0;
    g->state_B = 0;
}

/* --- stimuli --- */

struct golden_rng golden_rng(const char *module, uint32_t rate_Hz, uint32_t stream)
{
    struct golden_rng r;
    uint32_t n = 0;
    while (module[n] != '\0') { n++; }
    r.state =
        (uint64_t)crc_add(0, (const uint8_t *)module, n) << 32 | (uint64_t)stream << 16 | rate_Hz;
    return r;
}

uint64_t golden_u64(struct golden_rng *r)
{
    uint64_t z = r->state += UINT64_C(0x9E3779B97F4A7C15);
    z = (z ^ z >> 30) * UINT64_C(0xBF58476D1CE4E5B9);
    z = (z ^ z >> 27) * UINT64_C(0x94D049BB133111EB);
    return z ^ z >> 31;
}

int64_t golden_draw(struct golden_rng *r, int64_t lo, int64_t hi)
{
    return lo + (int64_t)((golden_u64(r) >> 32) * (uint64_t)(hi - lo + 1) >> 32);
}

static int64_t signed_of(uint64_t u)
{
    return u <= INT64_MAX ? (int64_t)u : -(int64_t)(UINT64_MAX - u) - 1;
}

int64_t golden_corner(struct golden_rng *r)
{
    static const int64_t corner[] = {INT64_MIN, INT32_MIN, 0, INT32_MAX, INT64_MAX};
    const uint64_t how = golden_u64(r);
    const uint64_t u = golden_u64(r);
    if (how % 3 == 0) { return signed_of(u); }
    if (how % 3 == 1) { return signed_of(u) >> (how >> 8) % 64; }
    return signed_of((uint64_t)corner[(how >> 8) % 5] + (u & 3) - 2);
}

static int64_t wave_next(uint32_t k, int64_t x, int64_t *slope, struct golden_rng *r, int64_t lo,
    int64_t hi, int64_t small)
{
    const int64_t mid = (lo + hi) >> 1;
    if (k < 8) { return mid; } /* rest */
    if (k < 32) { return hi; } /* steps to both rails */
    if (k < 56) { return lo; }
    if (k < 120) { /* ramp and reversal */
        if (k == 56) {
            *slope = golden_draw(r, 1, small);
            x = mid;
        }
        return x + (k < 88 ? *slope : -*slope);
    }
    if (k < 144) { /* dwell, +-1 of noise */
        if (k == 120) { *slope = golden_draw(r, -small, small); }
        return mid + *slope + golden_draw(r, -1, 1);
    }
    if (k < 176) { return x + golden_draw(r, -small, small); }
    if (k < 192) { return golden_draw(r, lo, hi); } /* all over the range */
    if (k < 200) { return mid; }                    /* after the second set-up */
    if (k < 216) { return x + golden_draw(r, -small, small); }
    if (k < 232) { return x + (k < 224 ? small : -small); }
    if (k < 248) { return k & 4 ? hi : lo; }
    return golden_draw(r, lo, hi);
}

void golden_wave(struct golden_wave *w, const char *module, uint32_t rate_Hz, uint32_t stream,
    int32_t lo, int32_t hi, int32_t small)
{
    struct golden_rng r = golden_rng(module, rate_Hz, stream);
    int64_t x = 0;
    int64_t slope = 0;
    for (uint32_t k = 0; k < GOLDEN_TICKS; k++) {
        x = exh_clamp(wave_next(k, x, &slope, &r, lo, hi, small), lo, hi);
        w->at[k] = (int32_t)x;
    }
}

struct exh_period golden_period(uint32_t rate_Hz, uint32_t k)
{
    const uint32_t other =
        1 + rate_Hz * 797 % (rate_Hz <= GOLDEN_RATES ? GOLDEN_RATES : GOLDEN_BEYOND);
    const struct exh_period first = {1, rate_Hz};
    const struct exh_period again = {(1193182 + other / 2) / other, 1193182};
    return k < GOLDEN_AGAIN ? first : again;
}

struct golden_turn golden_any_turn(struct golden_rng *r)
{
    const int64_t p = golden_draw(r, 1, 50);
    const int64_t q = golden_draw(r, 1, 50);
    return (struct golden_turn){p * p - q * q, 2 * p * q, p * p + q * q};
}

int32_t golden_q30(int64_t n, int64_t d)
{
    const int64_t twice = n * (INT64_C(1) << 31) + d; /* floor, where C truncates */
    return (int32_t)(twice / (2 * d) - (twice % (2 * d) < 0));
}

int32_t golden_step(struct golden_rng *r)
{
    const int32_t um = 4398047;
    const int64_t any = golden_draw(r, um, INT32_MAX);
    const int32_t step = (int32_t)(any >> golden_draw(r, 0, 8));
    return step < um ? um : step;
}
