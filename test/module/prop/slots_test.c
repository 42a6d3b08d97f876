/* SPDX-License-Identifier: MIT */
/* slots.h in flash whose supply fails at any moment: erased bit by bit in any order, programmed in
 * order by units of which, when it fails, any bits are set. What counts is the image before or the
 * new one, always. */
#include "exhand/slots.h"

#include "exhand/error.h"

#include "check.h"

#define MOST_B 96u
#define SAVES  12u

static uint8_t flash[2][MOST_B], buf[MOST_B + 8];
static uint32_t slot_B, unit_B;
static int to_ones; /* what erased bits are */

static uint32_t up_to(uint32_t n) { return (uint32_t)(check_u64() % (n + 1)); }

/* Toward `goal`, any of the bits that are not there yet, or all. */
static void pull(uint8_t *p, const uint8_t *goal, uint32_t n, int all)
{
    for (uint32_t i = 0; i < n; i++) {
        const uint8_t some = all ? 0xFF : (uint8_t)(check_u64() & 0xFF);
        p[i] = (uint8_t)((p[i] & ~some) | (goal[i] & some));
    }
}

/* 1: it went to its end. */
static int erase(unsigned to, int fails)
{
    uint8_t blank[MOST_B];
    memset(blank, to_ones ? 0xFF : 0x00, sizeof blank);
    pull(flash[to], blank, slot_B, !fails);
    return !fails;
}

static int program(unsigned to, uint32_t n, uint32_t fails_at)
{
    for (uint32_t i = 0; i < n; i += unit_B) {
        const uint32_t k = unit_B < n - i ? unit_B : n - i;
        pull(flash[to] + i, buf + i, k, i / unit_B != fails_at);
        if (i / unit_B == fails_at) { return 0; }
    }
    return 1;
}

/* What counts, its bytes copied; its length, or -1. */
static int32_t image(uint8_t *to, uint32_t *sequence)
{
    struct exh_slot is;
    const int at = exh_slots_find(&is, flash[0], flash[1], slot_B);
    if (at < 0) { return -1; }
    memcpy(to, is.image, is.len_B);
    *sequence = is.sequence;
    return (int32_t)is.len_B;
}

TEST(old_or_new_whenever_the_supply_fails)
{
    uint32_t olds = 0, news = 0;
    while (check_case(20)) {
        uint8_t old[MOST_B], now[MOST_B];
        uint32_t old_s = 0, now_s = 0;
        int32_t old_B = -1;
        slot_B = EXH_SLOT_B(8) + up_to(MOST_B - EXH_SLOT_B(8));
        unit_B = 1u << up_to(3);
        to_ones = check_u64() % 4 != 0;
        for (unsigned k = 0; k < 2; k++) {
            for (uint32_t i = 0; i < slot_B; i++) { flash[k][i] = (uint8_t)(check_u64() & 0xFF); }
        }
        for (unsigned save = 0; save < SAVES; save++) {
            const uint32_t len_B = up_to(slot_B - EXH_SLOT_B(0));
            const uint32_t how = up_to(3); /* it fails in the erasure, in programming, or not */
            unsigned to = 9;
            int32_t n, now_B;
            for (uint32_t i = 0; i < len_B; i++) {
                buf[EXH_SLOT_HEAD_B + i] = (uint8_t)(check_u64() & 0xFF);
            }
            n = exh_slots_encode(&to, flash[0], flash[1], slot_B, buf, sizeof buf, len_B);
            if (n == 0) { continue; } /* the same image is there by chance */
            CHECK(n == (int32_t)EXH_SLOT_B(len_B) && to < 2, "%" PRId32 " to %u", n, to);
            if (erase(to & 1, how == 0)) {
                (void)program(
                    to & 1, (uint32_t)n, how == 1 ? up_to((uint32_t)n / unit_B) : UINT32_MAX);
            }
            now_B = image(now, &now_s);
            if (now_B == (int32_t)len_B && memcmp(now, buf + EXH_SLOT_HEAD_B, len_B) == 0 &&
                now_s == old_s + 1) {
                news++;
                old_B = now_B;
                old_s = now_s;
                memcpy(old, now, MOST_B);
            } else {
                CHECK(how < 2, "lost although nothing failed");
                CHECK(now_B == old_B && (old_B < 0 || memcmp(now, old, (size_t)old_B) == 0) &&
                          (old_B < 0 || now_s == old_s),
                    "neither old nor new: %" PRId32 " B, sequence %" PRIu32, now_B, now_s);
                olds++;
            }
        }
    }
    check_note("%" PRIu32 " saves cut off or not: the old one counts in %" PRIu32
               ", the new one in %" PRIu32,
        olds + news, olds, news);
}

/* Any change of a whole slot that is not its own next image: the other one counts. */
TEST(what_is_damaged_does_not_count)
{
    while (check_case(20)) {
        struct exh_slot is;
        unsigned to;
        uint32_t len_B, at, turned = 0;
        slot_B = MOST_B;
        memset(flash, 0xFF, sizeof flash);
        for (unsigned k = 0; k < 2; k++) {
            int32_t n;
            len_B = up_to(MOST_B - EXH_SLOT_B(0));
            memset(buf + EXH_SLOT_HEAD_B, (int)(k + up_to(100)), MOST_B - EXH_SLOT_HEAD_B);
            n = exh_slots_encode(&to, flash[0], flash[1], slot_B, buf, MOST_B, len_B);
            if (n > 0) { memcpy(flash[to], buf, (size_t)n); }
        }
        if (exh_slot_decode(&is, flash[1], slot_B) < 0) { continue; } /* twice the same */
        at = up_to(8 * EXH_SLOT_B(is.len_B) - 1);
        for (uint32_t bit = at; bit < at + 32 && bit < 8 * EXH_SLOT_B(is.len_B); bit++) {
            if (bit == at || up_to(1)) {
                flash[1][bit / 8] ^= (uint8_t)(1u << bit % 8);
                turned++;
            }
        }
        CHECK(exh_slots_find(&is, flash[0], flash[1], slot_B) == 0,
            "%" PRIu32 " bits from %" PRIu32 " on", turned, at);
    }
}

TEST_MAIN("slots", old_or_new_whenever_the_supply_fails, what_is_damaged_does_not_count);
