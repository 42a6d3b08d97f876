/* SPDX-License-Identifier: MIT */
/* The independent watchdog (RM0090 chapter 21), by a separate clock: 32 kHz, 17 to 47 (data sheet).
 * Once it runs, only a reset ends that. */
#include "stm.h"

enum { KR = 0, PR = 4, RLR = 8, SR = 12 };
#define FEED   0xAAAAu
#define ACCESS 0x5555u
#define START  0xCCCCu

uint64_t stm_iwdg_period(const struct stm *s)
{
    const unsigned shift = s->iwdg.pr < 6 ? s->iwdg.pr + 2 : 8;
    const uint32_t Hz = s->wrong & 1u << STM_LSI_FAST   ? 47000
                        : s->wrong & 1u << STM_LSI_SLOW ? 17000
                                                        : 32000;
    return ((uint64_t)(s->iwdg.rlr + 1) << shift) * STM_HZ / Hz;
}

static uint64_t bites_at(const struct stm *s)
{
    return s->iwdg.runs ? s->iwdg.fed + stm_iwdg_period(s) : STM_NEVER;
}

uint32_t stm_iwdg_read(struct stm *s, uint32_t off)
{
    return off == PR ? s->iwdg.pr : off == RLR ? s->iwdg.rlr : 0;
}

void stm_iwdg_write(struct stm *s, uint32_t off, uint32_t v)
{
    struct stm_iwdg *w = &s->iwdg;
    s->wake = 0;
    if (off == KR) {
        w->unlocked = v == ACCESS;
        if (v == START) { w->runs = 1; }
        if (v == START || v == FEED) {
            w->fed = s->now;
            w->feeds++;
        }
    } else if (w->unlocked && off == PR) {
        w->pr = v & 7;
    } else if (w->unlocked && off == RLR) {
        w->rlr = v & 0xFFF;
    }
}

void stm_iwdg_go_on(struct stm *s)
{
    if (bites_at(s) > s->now) { return; }
    s->iwdg.runs = 0;
    s->resets = 1;
    s->reset_flags = STM_WATCHDOG;
}

uint64_t stm_iwdg_next(const struct stm *s) { return bites_at(s); }
