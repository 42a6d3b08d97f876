/* SPDX-License-Identifier: MIT */
/* The supply fails in an operation of a save: a sector's erasure, or any word. The next start finds
 * the earlier parameters or, after the last word, the new ones. */
#include "faults.h"

#include "exhand/slots.h"

#include <stdlib.h>
#include <string.h>

/* ports/stm32f405/slot.c, as an image has it; the slots are sectors 10 and 11 */
#define MAGIC   0x45584853u
#define MAIL    12u
#define SLOT_B  0x4000u
#define SECTORS 0x000C0000u
#define APART   0x00020000u
#define IMAGE_B 4096u

static struct machine *m;
static uint8_t saved[2][IMAGE_B]; /* earlier, new */
static uint32_t saved_B;

static void to_loop(struct machine *machine) { machine_stop(machine, M_DONE); }

/* What saved[i] is: u32 length of parameters, these; as a box without calibrations has it. */
static int prepare(int i)
{
    const struct exh_params *p = loop.cfg.scene->params;
    const int32_t n = exh_params_save(p, saved[i] + 4, IMAGE_B - 4);
    const uint32_t len_B = n < 0 ? 0 : (uint32_t)n;
    memcpy(saved[i], &len_B, 4);
    saved_B = 4 + len_B;
    return n < 0 ? -1 : 0;
}

/* One parameter, by the least. */
static int change(void)
{
    struct exh_params *p = loop.cfg.scene->params;
    for (uint32_t i = 0; i < exh_signal_count(p->table); i++) {
        if (exh_params_stage_at(p, i, p->staged[i] - 1) >= 0) { return 0; }
    }
    return -1;
}

static int put_mail(uint32_t at, int i)
{
    const uint32_t word[3] = {MAGIC, saved_B, exh_crc32(0, saved[i], saved_B)};
    uint8_t *to = machine_at(m, at, MAIL + EXH_SLOT_B(IMAGE_B));
    if (to == NULL) { return -1; }
    memcpy(to, word, sizeof word);
    memcpy(to + MAIL + EXH_SLOT_HEAD_B, saved[i], saved_B);
    return 0;
}

/* From a reset to the loop, or to what ends it before. */
static enum machine_end start(uint32_t flags, uint32_t cut_after)
{
    stm_reset(&m->s, flags);
    m->s.flash.cut_after = cut_after;
    da_clear(&loop.board.da, 0);
    loop.text_n = 0;
    loop.text[0] = 0;
    machine_boot(m);
    return machine_run(m);
}

/* 0: before, 1: new, -1: neither, or the image does not take it. */
static int found(void)
{
    struct exh_slot is;
    const uint8_t *a = &m->flash[SECTORS], *b = a + APART;
    if (exh_slots_find(&is, a, b, SLOT_B) < 0 || is.len_B != saved_B) { return -1; }
    if (strstr(loop.text, "slot: parameters taken") == NULL) { return -1; }
    for (int i = 0; i < 2; i++) {
        if (memcmp(is.image, saved[i], saved_B) == 0) { return i; }
    }
    return -1;
}

/* Whatever memory held is gone. */
static int after_cut(uint32_t mail, uint32_t k)
{
    if (put_mail(mail, 1) < 0 || start(STM_SOFT, k) != M_RESET) { return -1; }
    memset(m->ram, 0xA5, STM_RAM_B);
    return start(STM_POWER_ON, 0) == M_DONE && board_enables(&m->s) == 0 ? found() : -1;
}

int stm_cuts(struct machine *machine, const char *image, unsigned times)
{
    const uint32_t mail = hil_symbol(image, "mail");
    uint8_t *before = malloc(2 * APART);
    unsigned old = 0, new = 0;
    uint32_t all, bad = 0;
    m = machine;
    machine_watch(m, hil_symbol(image, "exh_loop"), to_loop);
    if (before == NULL || ref_parameters(&loop.cfg) < 0) { return 1; }
    if (prepare(0) < 0 || put_mail(mail, 0) < 0) { return 1; }
    if (start(STM_SOFT, 0) != M_DONE || found() != 0) { bad++; }
    memcpy(before, &m->flash[SECTORS], 2 * APART);
    if (change() < 0 || prepare(1) < 0 || put_mail(mail, 1) < 0) { return 1; }
    if (start(STM_SOFT, 0) != M_DONE || found() != 1) { bad++; }
    all = m->s.flash.programmed + m->s.flash.erased;
    if (times > all) { times = all; }
    for (unsigned i = 0; i < times; i++) { /* the first, the last and evenly between */
        const uint32_t k = times < 2 ? 1 : 1 + (uint32_t)((uint64_t)i * (all - 1) / (times - 1));
        int is;
        memcpy(&m->flash[SECTORS], before, 2 * APART);
        is = after_cut(mail, k);
        bad += is < 0;
        old += is == 0;
        new += is == 1;
    }
    printf("%u cuts of a save of %u operations: %u left the older parameters, %u the new ones, "
           "%u neither\n",
        times, (unsigned)all, old, new, (unsigned)bad);
    free(before);
    return bad != 0 || old == 0;
}
