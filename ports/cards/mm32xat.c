/* SPDX-License-Identifier: MIT */
#include "mm32xat.h"

#include "io.h"
#include "wait.h"

#include "exhand/error.h"

#include <string.h>

/* offsets, 8 bits each */
enum {
    MM_DATA = 0,
    MM_START = 0,
    MM_LOW = 2,
    MM_HIGH = 3,
    MM_FIFO = 7,
    MM_MISC = 8,
    MM_CLOCK = 9,
    MM_RANGE = 11
};
/* FIFO */
enum { MM_FIFO_RESET = 0x02, MM_SCAN = 0x04, MM_OVERFLOW = 0x10, MM_EMPTY = 0x80 };
/* MISC */
enum { MM_RESET = 0x20, MM_BUSY = 0x80, MM_SINGLE_ENDED = 0x60 };
/* RANGE: +-10 V in the low bits, the interval above */
enum { MM_10V = 0x08, MM_INTERVAL_SHIFT = 4, MM_WAIT = 0x80 };
#define MM_ALL_ONES 0xFFu /* an empty port; no register that is looked at here can have it */

/* Number of polls for the end of a scan if the clock is stopped. */
#define ASKED_MAX 1000

static uint8_t in(const struct exh_mm32xat *m, unsigned offset)
{
    return exh_io_in8((uint16_t)(m->base + offset));
}

static void out(const struct exh_mm32xat *m, unsigned offset, unsigned value)
{
    exh_io_out8((uint16_t)(m->base + offset), (uint8_t)value);
}

/* Waits at least this long. If the clock is stopped, reads of a status register take the time. */
static void pause_us(const struct exh_mm32xat *m, uint32_t us)
{
    struct exh_wait w = exh_wait_us(us);
    do {
        (void)in(m, MM_MISC);
    } while (exh_wait_more(&w));
}

static int all_ones(struct exh_card_fault *f, unsigned at)
{
    return exh_card_fault(f, EXH_CARD_EMPTY, at, MM_ALL_ONES, 0, 0);
}

/* --- detect --- */

struct reading {
    uint8_t offset, want;
};

/* After a reset and the settings below. */
static const struct reading detected[] = {
    {MM_LOW, 0x00},
    {MM_HIGH, EXH_MM32XAT_CHANNELS - 1},
    {MM_FIFO, MM_EMPTY},
    {MM_MISC, MM_SINGLE_ENDED},
    {MM_CLOCK, 0x00},
    {MM_RANGE, 0x0C},
};
#define DETECTED (sizeof detected / sizeof detected[0])

static int compare(
    const struct exh_mm32xat *m, const struct reading *list, size_t n, struct exh_card_fault *f)
{
    for (size_t i = 0; i < n; i++) {
        const uint8_t got = in(m, list[i].offset), want = list[i].want;
        if (got == MM_ALL_ONES) { return all_ones(f, list[i].offset); }
        if (got != want) {
            return exh_card_fault(f, EXH_CARD_REGISTER, list[i].offset, got, want, want);
        }
    }
    return 0;
}

/* Nothing is written to where nothing answers. */
static int empty(const struct exh_mm32xat *m)
{
    for (unsigned i = 0; i < DETECTED; i++) {
        if (in(m, detected[i].offset) != MM_ALL_ONES) { return 0; }
    }
    return 1;
}

static int detect(struct exh_mm32xat *m, struct exh_card_fault *f)
{
    f->phase = EXH_CARD_DETECT;
    if (empty(m)) { return all_ones(f, 0); }
    out(m, MM_MISC, MM_RESET);
    pause_us(m, m->par.reset_us);
    out(m, MM_FIFO, 0);
    out(m, MM_CLOCK, 0);
    out(m, MM_LOW, 0x80);  /* channels have five bits: 0 */
    out(m, MM_HIGH, 0xFF); /* and 31 */
    out(m, MM_RANGE, 0x0C);
    pause_us(m, m->par.set_us);
    return compare(m, detected, DETECTED, f);
}

/* --- scans --- */

/* FIFO empty, channels, range and interval, software start. Also in a tick, after a scan was
 * lost: then its wait for the input, 10 us, is part of that tick. */
static int set_up(struct exh_mm32xat *m, struct exh_card_fault *f)
{
    struct exh_wait w = exh_wait_us(m->par.settle_us);
    m->running = 0;
    out(m, MM_FIFO, MM_FIFO_RESET);
    out(m, MM_LOW, 0);
    out(m, MM_HIGH, m->par.channels - 1u);
    out(m, MM_RANGE, (unsigned)m->par.interval << MM_INTERVAL_SHIFT | MM_10V);
    out(m, MM_FIFO, MM_SCAN);
    out(m, MM_CLOCK, 0);
    do {
        const uint8_t got = in(m, MM_RANGE);
        if (got == MM_ALL_ONES) { return all_ones(f, MM_RANGE); }
        if (!(got & MM_WAIT)) { return 0; }
    } while (exh_wait_more(&w));
    return exh_card_fault(f, EXH_CARD_WAIT_TIMEOUT, MM_RANGE, MM_WAIT, 0, 0);
}

void exh_mm32xat_start(struct exh_mm32xat *m)
{
    out(m, MM_START, 0);
    m->running = 1;
    m->taken = 0;
    m->asked = 0;
}

/* A card that is gone reads as ones. They are checked first, because they have the busy bit, too.
 */
static int busy(const struct exh_mm32xat *m, struct exh_card_fault *f)
{
    const uint8_t got = in(m, MM_MISC);
    f->phase = EXH_CARD_SCAN;
    return got == MM_ALL_ONES ? all_ones(f, MM_MISC) : got & MM_BUSY ? 1 : 0;
}

int exh_mm32xat_done(struct exh_mm32xat *m, struct exh_card_fault *f)
{
    const int is = busy(m, f);
    uint32_t now_us;
    if (is <= 0) { return is < 0 ? is : 1; }
    now_us = exh_io_time_us();
    if (m->asked == 0) { m->since_us = now_us; }
    m->asked++;
    return now_us - m->since_us <= m->par.scan_wait_us && m->asked < ASKED_MAX
               ? 0
               : exh_card_fault(f, EXH_CARD_SCAN_TIMEOUT, 0, m->asked, 0, 0);
}

int exh_mm32xat_wait(struct exh_mm32xat *m, struct exh_card_fault *f)
{
    struct exh_wait w = exh_wait_us(m->par.scan_wait_us);
    do {
        const int is = busy(m, f);
        if (is <= 0) { return is; }
    } while (exh_wait_more(&w));
    return exh_card_fault(f, EXH_CARD_SCAN_TIMEOUT, 0, 0, 0, 0);
}

/* The low byte pops a sample and comes first. */
static int16_t sample(const struct exh_mm32xat *m)
{
    uint32_t raw;
    if (m->par.words) {
        raw = exh_io_in16(m->base);
    } else {
        raw = in(m, MM_DATA);
        raw |= (uint32_t)in(m, MM_DATA + 1) << 8;
    }
    return (int16_t)((int32_t)(raw ^ 0x8000u) - 0x8000);
}

/* The FIFO's state: 0 as wanted, 1 not, counted by its cause; < 0 no card. */
static int unlike(struct exh_mm32xat *m, unsigned want_empty, struct exh_card_fault *f)
{
    const uint8_t got = in(m, MM_FIFO);
    if (got == MM_ALL_ONES) { return all_ones(f, MM_FIFO); }
    if (got & MM_OVERFLOW) {
        m->overflows++;
        return 1;
    }
    if ((got & MM_EMPTY) == want_empty) { return 0; }
    if (want_empty) { m->longs++; }
    if (!want_empty) { m->shorts++; }
    return 1;
}

/* Reads n more samples, exactly as many as channels. Before the first there is one and no overflow;
 * before the last there is one; after it there is none. */
static int pop(struct exh_mm32xat *m, unsigned n, struct exh_card_fault *f)
{
    const unsigned last = m->par.channels - 1u, end = m->taken + n;
    unsigned k = m->taken;
    int bad = k == 0 ? unlike(m, 0, f) : 0;
    if (bad == 0) {
        for (; k < end && k < last; k++) { m->part[k] = sample(m); }
        if (k == last && k < end) {
            if (last > 0) { bad = unlike(m, 0, f); }
            if (bad == 0) { m->part[k++] = sample(m); }
        }
    }
    m->taken = (uint8_t)k;
    return bad == 0 && k > last ? unlike(m, MM_EMPTY, f) : bad;
}

/* After as many samples as channels, or none that is worth having. */
static int end_scan(struct exh_mm32xat *m, int bad, int16_t *code, struct exh_card_fault *f)
{
    m->running = m->taken = 0;
    if (bad == 0) {
        memcpy(code, m->part, m->par.channels * sizeof code[0]);
        m->lost = 0;
        return 1;
    }
    if (bad > 0) { bad = set_up(m, f); }
    if (bad < 0) { return bad; }
    m->lost++;
    return m->lost < m->par.lost_limit
               ? 0
               : exh_card_fault(f, EXH_CARD_SCAN_LOST, 0, m->lost, 0, m->par.lost_limit - 1);
}

int exh_mm32xat_read(struct exh_mm32xat *m, int16_t *code, struct exh_card_fault *f)
{
    return end_scan(m, pop(m, m->par.channels, f), code, f);
}

int exh_mm32xat_some(struct exh_mm32xat *m, int16_t *code, struct exh_card_fault *f)
{
    int got;
    if (!m->running) { return 0; }
    if (m->taken == 0) {
        got = exh_mm32xat_done(m, f);
        if (got <= 0) { return got; }
    }
    got = pop(m, m->par.slice, f);
    return got == 0 && m->taken < m->par.channels ? 0 : end_scan(m, got, code, f);
}

/* --- self-test --- */

/* Settings read back, and a scan gives as many samples as it should. */
static int self_test(struct exh_mm32xat *m, struct exh_card_fault *f)
{
    const struct reading set[] = {
        {MM_LOW, 0}, {MM_HIGH, (uint8_t)(m->par.channels - 1u)}, {MM_FIFO, MM_EMPTY | MM_SCAN}};
    int16_t code[EXH_MM32XAT_CHANNELS];
    int err;
    f->phase = EXH_CARD_SELFTEST;
    err = set_up(m, f);
    if (err < 0) { return err; }
    err = compare(m, set, sizeof set / sizeof set[0], f);
    if (err < 0) { return err; }
    for (unsigned run = 0; run < m->par.lost_limit; run++) {
        exh_mm32xat_start(m);
        err = exh_mm32xat_wait(m, f);
        f->phase = EXH_CARD_SELFTEST;
        if (err == 0) { err = exh_mm32xat_read(m, code, f); }
        if (err != 0) { break; }
    }
    return err < 0 ? err : 0;
}

int exh_mm32xat_open(struct exh_mm32xat *m, uint16_t base, const struct exh_mm32xat_par *par,
    struct exh_card_fault *f)
{
    int err;
    m->base = base;
    m->par = *par;
    m->live = m->running = m->taken = m->lost = 0;
    m->shorts = m->longs = m->overflows = 0;
    err = detect(m, f);
    if (err < 0) { return -EXH_E_ABSENT; }
    m->live = 1;
    return self_test(m, f);
}
