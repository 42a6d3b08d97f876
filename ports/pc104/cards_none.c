/* SPDX-License-Identifier: MIT */
/* CARDS=none: constants instead of cards, for a smoke image that runs on any emulator. Encoders
 * and monitors 0, glove codes 0, every input healthy; a hand takes hold of the dead-man switch
 * after a while. */
#include "pc104.h"

#include "cards/box.h"

#include "exhand/error.h"

#define DEADMAN_TICK 200u

const struct exh_box_config exh_box_default = {.fingers = EXH_FINGERS};

static uint8_t glove, live;
static uint32_t reads; /* one a tick */

int exh_box_open(const struct exh_box_config *config, struct exh_box_report *report)
{
    glove = config->glove != EXH_BOX_NEVER;
    live = 0;
    reads = 0;
    if (report) { *report = (struct exh_box_report){.used = {0}}; }
    return 0;
}

int exh_box_read_drive(struct exh_drive_in *in)
{
    *in = (struct exh_drive_in){.din = EXH_DIN_ESTOP | EXH_DIN_WATCHDOG | EXH_DIN_CARDS |
                                       (++reads > DEADMAN_TICK ? EXH_DIN_DEADMAN : 0)};
    for (unsigned i = 0; i < EXH_FINGERS; i++) { in->din |= (uint32_t)EXH_DIN_DRIVE0 << i; }
    return 0;
}

int exh_box_write_drive(const struct exh_drive_out *out)
{
    (void)out;
    live = 1;
    return 0;
}

int exh_box_read_glove(struct exh_glove_in *in)
{
    *in = (struct exh_glove_in){.age_ticks = 0};
    return glove ? 0 : -EXH_E_ABSENT;
}

/* Says so: a test sees that nothing else was said before. */
void exh_box_safe(void)
{
    static uint8_t once;
    if (live && pc104_par.provoke == PC104_PROVOKE_TWICE && !once) {
        once = 1;
        __asm__ volatile("int $2"); /* does not return: its handler must make the outputs safe */
    }
    if (live) { pc104_say("outputs safe\n"); }
    live = 0;
}

const struct exh_box_error *exh_box_error(void)
{
    static const struct exh_box_error none;
    return &none;
}

void exh_box_counts(struct exh_box_counts *counts)
{
    *counts = (struct exh_box_counts){.reads = 0};
}

const char *exh_box_card_text(unsigned card)
{
    (void)card;
    return "no card";
}

size_t exh_box_error_text(char *text, size_t cap_B, const struct exh_box_error *e)
{
    (void)e;
    if (cap_B) { text[0] = '\0'; }
    return 0;
}
