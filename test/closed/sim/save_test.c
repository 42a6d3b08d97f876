/* SPDX-License-Identifier: MIT */
/* SAVE is done if it was answered, whichever tick was the last; and what it keeps is what is
 * wanted. */
#include "said.h"

#include "slave/slave.h"
#include "base/params_file.h"

#include "drop/drop.h"

#include "exhand/error.h"

static const struct exh_scene *const sc = &exh_scene_drop;
static uint32_t k; /* index of a slewed value */

static void begin(const char *path)
{
    const struct mail_cfg cfg = {path, 1, 0};
    const struct exh_scene_board board = {{1, 2000}, 24};
    const int32_t i = (sc->defaults(), exh_signal_find(sc->params->table, 0x0401, 0));
    CHECK(i >= 0, "no k");
    k = (uint32_t)i;
    sc->params->locked = 1;
    sc->params->shift = 5;
    mail_open(&cfg);
    CHECK_EQ_I64(mail_start(sc, board), 0);
}

static void end(void) { sc->params->locked = sc->params->shift = 0; }

static void ask(unsigned coils)
{
    const uint8_t bits = (uint8_t)coils;
    CHECK_EQ_I64(exh_regs_write_bits(mail_take(), 0, EXH_COILS, &bits), 0);
    mail_give();
}

static void stage(int32_t raw)
{
    const uint32_t v = (uint32_t)raw;
    const uint8_t words[4] = {
        (uint8_t)(v >> 24), (uint8_t)(v >> 16 & 255), (uint8_t)(v >> 8 & 255), (uint8_t)(v & 255)};
    CHECK_EQ_I64(exh_regs_write(mail_take(), (uint16_t)(EXH_REGS_PARAM_AT + 2 * k), 2, words), 0);
    mail_give();
}

#define APPLY (1u << EXH_COIL_APPLY)
#define SAVE  (1u << EXH_COIL_SAVE)

/* A stiffer wall, applied and kept. Returns its k. */
static int32_t ask_for_more(void)
{
    const int32_t goal = sc->params->staged[k] + 4096;
    stage(goal);
    ask(APPLY | SAVE);
    return goal;
}

static void tick(void)
{
    struct exh_scene_in in = {0};
    (void)mail_before(&in);
    (void)exh_params_apply(sc->params);
    mail_after(&in);
}

/* k of the file, by a box that starts with it; INT32_MIN: no file. */
static int32_t kept(const char *from)
{
    FILE *f = fopen(from, "rb");
    if (f == NULL) { return INT32_MIN; }
    fclose(f);
    end();
    sc->defaults();
    CHECK_EQ_I64(params_load_file(from, sc->params), 0);
    return sc->params->staged[k];
}

static char *dir;
static const char *path;

static void start(void)
{
    dir = said_dir();
    path = said_path(dir, "p.img");
    begin(path);
}

static void ends_with(int32_t want)
{
    mail_end();
    CHECK_EQ_I64(kept(path), want);
    said_clean(dir);
}

TEST(behind_the_last_tick_too)
{
    int32_t was;
    start();
    was = sc->params->staged[k];
    tick();
    ask(SAVE);
    CHECK_EQ_I64(kept(path), INT32_MIN);
    ends_with(was);
}

/* The registers are in use at the last tick's end: nothing is copied there. */
TEST(in_a_last_tick_that_found_the_registers_in_use)
{
    struct exh_scene_in in = {0};
    int32_t was;
    start();
    was = sc->params->staged[k];
    ask(SAVE);
    (void)mail_before(&in);
    (void)mail_take();
    mail_after(&in);
    mail_give();
    ends_with(was);
}

/* The second save is requested before the first is written: the second stays. */
TEST(of_two_the_later_stays)
{
    int32_t goal;
    start();
    ask(SAVE);
    tick();
    goal = ask_for_more();
    tick();
    ends_with(goal);
}

TEST(what_was_applied_with_it_is_in_it)
{
    int32_t goal;
    start();
    tick();
    goal = ask_for_more();
    ends_with(goal);
}

TEST(it_keeps_what_is_wanted)
{
    int32_t goal;
    start();
    tick();
    goal = ask_for_more();
    tick();
    CHECK(sc->params->active[k] < goal && sc->params->moving, "it is there already");
    stage(goal + 4096); /* not applied: not wanted */
    mail_save();
    ends_with(goal);
}

TEST(what_cannot_be_written_leaves_what_was)
{
    dir = said_dir();
    begin(said_path(dir, "no/p.img"));
    ask(SAVE);
    tick();
    mail_save();
    CHECK_EQ_I64(mail_take()->result, -EXH_E_IO);
    mail_give();
    end();
    said_clean(dir);
}

TEST_MAIN("save", behind_the_last_tick_too, in_a_last_tick_that_found_the_registers_in_use,
    of_two_the_later_stays, what_was_applied_with_it_is_in_it, it_keeps_what_is_wanted,
    what_cannot_be_written_leaves_what_was);
