/* SPDX-License-Identifier: MIT */
/* The flash interface (RM0090 chapter 3): keys, sectors, erasure and programming in their time. */
#include "stm.h"

#include <string.h>

enum { ACR = 0, KEYR = 4, OPTKEYR = 8, SR = 12, CR = 16, OPTCR = 20 };
#define KEY1 0x45670123u
#define KEY2 0xCDEF89ABu
#define EOP  0x1u
#define BSY  0x10000u
/* errors: of alignment, of parallelism, of sequence; each is cleared by writing it */
#define PGAERR 0x20u
#define PGPERR 0x40u
#define PGSERR 0x80u
#define ERRORS 0xF2u
#define PG     0x1u
#define SER    0x2u
#define STRT   0x10000u
#define LOCK   0x80000000u
/* Data sheet, x32: a word 16 us, 16 KiB 250 ms, 64 KiB 0.55 s, 128 KiB 1 s. */
#define WORD_TIME  (STM_HZ / 62500)
#define ERASE_TIME (STM_HZ / 1000)
#define WRONG_KEY  0xFF

static const struct sector {
    uint32_t at, size, ms;
} sector[12] = {{0x0, 0x4000, 250}, {0x4000, 0x4000, 250}, {0x8000, 0x4000, 250},
    {0xC000, 0x4000, 250}, {0x10000, 0x10000, 550}, {0x20000, 0x20000, 1000},
    {0x40000, 0x20000, 1000}, {0x60000, 0x20000, 1000}, {0x80000, 0x20000, 1000},
    {0xA0000, 0x20000, 1000}, {0xC0000, 0x20000, 1000}, {0xE0000, 0x20000, 1000}};

static int busy(const struct stm *s) { return s->now < s->flash.busy_until; }

/* The supply may fail in an operation: 1. What it was doing is half done. */
static int is_cut(struct stm *s)
{
    struct stm_flash *f = &s->flash;
    if (f->cut_after == 0 || f->programmed + f->erased != f->cut_after) { return 0; }
    s->wrong |= 1u << STM_FLASH_CUT;
    s->reset_flags = STM_POWER_ON;
    s->resets = 1;
    return 1;
}

static void take_key(struct stm *s, uint32_t v)
{
    struct stm_flash *f = &s->flash;
    if (f->keys == 0 && v == KEY1) {
        f->keys = 1;
    } else if (f->keys == 1 && v == KEY2) {
        f->keys = 2;
        f->cr &= ~LOCK;
    } else {
        f->keys = WRONG_KEY; /* it stays locked until a reset */
    }
}

static void erase(struct stm *s)
{
    struct stm_flash *f = &s->flash;
    const unsigned n = f->cr >> 3 & 15;
    if (!(f->cr & SER) || n >= 12) {
        f->sr |= PGSERR;
        return;
    }
    f->erased++;
    if (is_cut(s)) { /* some of it is erased, and some of that reads as it likes */
        memset(&stm_outside.flash[sector[n].at], 0xFF, sector[n].size / 2);
        stm_outside.flash[sector[n].at + sector[n].size / 2] ^= 0x5A;
        return;
    }
    memset(&stm_outside.flash[sector[n].at], 0xFF, sector[n].size);
    f->busy_until = s->now + (uint64_t)sector[n].ms * ERASE_TIME;
    f->sr |= EOP;
}

uint32_t stm_flash_read(struct stm *s, uint32_t off)
{
    const struct stm_flash *f = &s->flash;
    switch (off) {
    case ACR: return f->acr;
    case SR: return busy(s) ? (f->sr & ~EOP) | BSY : f->sr;
    case CR: return busy(s) ? f->cr : f->cr & ~STRT;
    case OPTCR: return f->optcr;
    default: return 0;
    }
}

void stm_flash_write(struct stm *s, uint32_t off, uint32_t v)
{
    struct stm_flash *f = &s->flash;
    switch (off) {
    case ACR: f->acr = v & 0x707u; break;
    case KEYR: take_key(s, v); break;
    case SR: f->sr &= ~(v & (ERRORS | EOP)); break;
    case CR:
        if (f->cr & LOCK || busy(s)) { return; }
        f->cr = v & 0x8301037Fu;
        if (v & LOCK) { f->keys = 0; }
        if (v & STRT) { erase(s); }
        break;
    default: break;
    }
    s->wake = 0;
}

void stm_flash_store(struct stm *s, uint32_t off, unsigned size, uint32_t was, uint32_t value)
{
    struct stm_flash *f = &s->flash;
    const unsigned wide = 1u << (f->cr >> 8 & 3);
    const uint32_t now = was & value;
    uint32_t wrong = 0;
    if (f->cr & LOCK || !(f->cr & PG)) { wrong = PGSERR; }
    if (size != wide) { wrong |= PGPERR; }
    if (off % size) { wrong |= PGAERR; }
    memcpy(&stm_outside.flash[off], &was, size);
    if (busy(s)) { s->now = f->busy_until; } /* the bus waits */
    if (wrong) {
        f->sr |= wrong;
        return;
    }
    f->programmed++;
    if (is_cut(s)) { /* some bits are programmed */
        const uint32_t half = now | (was & 0x33333333u);
        memcpy(&stm_outside.flash[off], &half, size);
        return;
    }
    memcpy(&stm_outside.flash[off], &now, size);
    f->busy_until = s->now + WORD_TIME;
    f->sr |= EOP;
}
