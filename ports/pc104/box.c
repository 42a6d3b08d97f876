/* SPDX-License-Identifier: MIT */
#include "box.h"

#include "exhand/error.h"

static const struct exh_signal rows[] = {
    {0xA201, 0, EXH_WHEN_SETUP, 0x100, 0xFFC0, 0x2C0, "s526_a", "", "base address, fingers 0..3"},
    {0xA202, 0, EXH_WHEN_SETUP, 0x100, 0xFFC0, 0x280, "s526_b", "", "base address, finger 4"},
    {0xA203, 0, EXH_WHEN_SETUP, 0x100, 0xFFF0, 0x300, "mm32xat", "", "base address, glove"},
    {0xA204, 0, EXH_WHEN_SETUP, 0, 2, 1, "monitor", "",
        "monitors converted: 0 never, 1 in the tick, 2 the one before"},
    {0xA205, 0, EXH_WHEN_SETUP, 0, 1, 1, "supply", "", "1: the supply is converted with them"},
    {0xA206, 0, EXH_WHEN_SETUP, 1, 2, 2, "scan", "",
        "glove converted: 1 in the tick, 2 the one before"},
    {0xA207, 0, EXH_WHEN_SETUP, 0, 15, 0, "din_invert_a", "",
        "inputs whose healthy level is 0, bits"},
    {0xA208, 0, EXH_WHEN_SETUP, 0, 15, 0, "din_invert_b", "",
        "inputs whose healthy level is 0, bits"},
    {0xA209, 0, EXH_WHEN_SETUP, 0, 240, 0, "out_invert_a", "",
        "outputs whose active level is 0, bits 4..7"},
    {0xA20A, 0, EXH_WHEN_SETUP, 0, 240, 0, "out_invert_b", "",
        "outputs whose active level is 0, bits 4..7"},
    {0xA20B, 0, EXH_WHEN_SETUP, 0, 1, 1, "ad_settle", "",
        "1: the A/D waits for its input before a scan"},
    {0xA20C, 0, EXH_WHEN_SETUP, 0, 1, 0, "ee_nominal", "",
        "1: nominal values where the EEPROM's are garbage"},
    {0xA20D, 0, EXH_WHEN_SETUP, 0, 3, 2, "interval", "",
        "of a glove scan: 0 20 us, 1 15, 2 10, 3 4 or 5"},
    {0xA20E, 0, EXH_WHEN_SETUP, 0, 1, 0, "scan_words", "", "1: glove samples by 16-bit reads"},
    {0xA20F, 0, EXH_WHEN_SETUP, 0, 1, 0, "full", "",
        "1: wired for five fingers, whatever the scene uses"},
    {0xA210, 0, EXH_WHEN_SETUP, 0, 32, 0, "scan_slice", "",
        "glove samples read a tick, with scan=2; 0: all in one"},
    {0xA211, 0, EXH_WHEN_SETUP, 0, 1, 0, "turns", "",
        "1: monitors and checks of the motor cards take turns"},
    {0xA212, 0, EXH_WHEN_SETUP, 0, 1, 1, "watchdog", "",
        "1: the watchdog's contact is wired to pin 3"},
};
static const struct exh_signal_group groups[] = {{rows, sizeof rows / sizeof rows[0], 1}};
const struct exh_signal_table pc104_box_table = {groups, 1};
EXH_STATIC_ASSERT(pc104_box_par_matches_rows,
    sizeof(struct pc104_box_par) == sizeof(int32_t) * (sizeof rows / sizeof rows[0]));
struct pc104_box_par pc104_box_par;

void pc104_box_config(const struct exh_scene *sc, struct exh_box_config *c)
{
    const struct pc104_box_par *p = &pc104_box_par;
    *c = exh_box_default;
    c->s526_base[0] = (uint16_t)p->s526_a;
    c->s526_base[1] = (uint16_t)p->s526_b;
    c->mm32xat_base = (uint16_t)p->mm32xat;
    c->fingers = sc ? sc->fingers : EXH_FINGERS; /* NULL: all there is */
    c->full = (uint8_t)p->full;
    c->monitor = (uint8_t)p->monitor;
    c->supply = (uint8_t)p->supply;
    c->watchdog = (uint8_t)p->watchdog;
    c->glove = (uint8_t)(sc == NULL || sc->read_glove ? p->scan : EXH_BOX_NEVER);
    c->din_invert[0] = (uint8_t)p->din_invert_a;
    c->din_invert[1] = (uint8_t)p->din_invert_b;
    c->out_invert[0] = (uint8_t)p->out_invert_a;
    c->out_invert[1] = (uint8_t)p->out_invert_b;
    c->s526.settle = (uint8_t)p->ad_settle;
    c->s526.nominal = (uint8_t)p->ee_nominal;
    c->mm32xat.interval = (uint8_t)p->interval;
    c->mm32xat.words = (uint8_t)p->scan_words;
    c->mm32xat.slice = (uint8_t)p->scan_slice;
    c->s526.turns = (uint8_t)p->turns;
}

static void say_ports(uint32_t first, uint32_t last)
{
    pc104_say_hex(first);
    pc104_say("..");
    pc104_say_hex(last);
}

void pc104_box_leave(const struct exh_scene *sc, const char *option, uint32_t first, uint32_t last)
{
    struct exh_box_config c;
    pc104_box_config(sc, &c);
    const struct {
        const char *name;
        uint32_t base, size;
    } card[] = {{"s526_a", c.s526_base[0], 0x40},
        {"s526_b", c.s526_base[1], c.fingers > 1 || c.full ? 0x40 : 0},
        {"mm32xat", c.mm32xat_base, c.glove != EXH_BOX_NEVER ? 0x10 : 0}};
    for (unsigned i = 0; i < sizeof card / sizeof card[0]; i++) {
        if (card[i].base > last || first >= card[i].base + card[i].size) { continue; }
        pc104_refuse(option, NULL);
        pc104_say("its ports ");
        say_ports(first, last);
        pc104_say(" are also those of ");
        pc104_say(card[i].name);
        pc104_say(", ");
        say_ports(card[i].base, card[i].base + card[i].size - 1);
        pc104_say(": give that card another base, by its jumpers and by ");
        pc104_say(card[i].name);
        pc104_say("= (576 is 0x240), or leave ");
        pc104_say(option);
        pc104_say("= out\n");
        pc104_halt(PC104_EXIT_OPTION, "option refused: nothing was started");
    }
}

static void say_signature(const struct exh_box_report *r, unsigned card)
{
    if (card < EXH_BOX_GLOVE) {
        pc104_say(", board ");
        pc104_say_hex(r->s526[card].signature);
        if (r->s526[card].nominal) { pc104_say(", EEPROM garbage, nominal values"); }
    }
    pc104_say("\n");
}

static void say_error(const struct exh_box_error *e)
{
    char text[160];
    (void)exh_box_error_text(text, sizeof text, e);
    pc104_say("card ");
    pc104_say(text);
    pc104_say("\n");
}

void pc104_box_say(const struct exh_box_report *r)
{
    if (exh_box_error()->code != 0 && exh_box_error()->card == EXH_BOX_CARDS) {
        say_error(exh_box_error());
    } /* the configuration */
    for (unsigned k = 0; k < EXH_BOX_CARDS; k++) {
        if (!r->used[k]) { continue; }
        if (r->error[k].code != 0) {
            say_error(&r->error[k]);
        } else {
            pc104_say("card ");
            pc104_say(exh_box_card_text(k));
            pc104_say(" at ");
            pc104_say_hex(r->base[k]);
            pc104_say(": self-test passed");
            say_signature(r, k);
        }
    }
}

static void say_count(const char *what, uint32_t n)
{
    if (n == 0) { return; }
    pc104_say("box ");
    pc104_say(what);
    pc104_say(" ");
    pc104_say_u32(n);
    pc104_say("\n");
}

void pc104_box_report(void)
{
    struct exh_box_counts n;
    exh_box_counts(&n);
    if (exh_box_error()->code != 0) { say_error(exh_box_error()); }
    say_count("codes clamped", n.clamped);
    say_count("writes overtaken by safe", n.overtaken);
    for (unsigned i = 0; i < EXH_FINGERS; i++) {
        say_count("illegal encoder transitions", n.quad[i]);
    }
    say_count("glove frames", n.glove_frames);
    say_count("glove scans not yet done", n.glove_waits);
    say_count("glove scans too short", n.glove_short);
    say_count("glove scans too long", n.glove_long);
    say_count("glove FIFO overflows", n.glove_overflow);
}
