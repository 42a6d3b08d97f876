/* SPDX-License-Identifier: MIT */
/* A box with flash, as slots.h has it in its example: tuned, saved, its supply cut at every byte,
 * started again. */
#include "exhand/slots.h"

#include "drop/drop.h"
#include "guarded/guarded.h"

#include "exhand/error.h"

#include "check.h"

#define PAGE_B 1024u

/* --- flash: a page is erased to ones, programming clears bits; no supply, nothing happens --- */

static uint8_t page[2][PAGE_B];
static uint32_t supply; /* bytes it can still erase or program */

static void board_erase(unsigned to)
{
    for (uint32_t i = 0; i < PAGE_B && supply > 0; i++, supply--) { page[to][i] = 0xFF; }
}

static void board_program(unsigned to, const uint8_t *from, uint32_t n)
{
    for (uint32_t i = 0; i < n && supply > 0; i++, supply--) { page[to][i] &= from[i]; }
}

/* --- the box --- */

/* 0; -EXH_E_IO: what was programmed does not count. */
static int save(const struct exh_scene *sc)
{
    static uint8_t buf[PAGE_B];
    struct exh_slot is;
    unsigned to = 0;
    int32_t n = exh_params_save(sc->params, buf + EXH_SLOT_HEAD_B, sizeof buf - EXH_SLOT_B(0));
    if (n > 0) { n = exh_slots_encode(&to, page[0], page[1], PAGE_B, buf, sizeof buf, (size_t)n); }
    if (n <= 0) { return (int)n; }
    board_erase(to);
    board_program(to, buf, (uint32_t)n);
    return exh_slots_find(&is, page[0], page[1], PAGE_B) == (int)to ? 0 : -EXH_E_IO;
}

/* Its parameters as they were saved last, or as they are by default. */
static void start(const struct exh_scene *sc)
{
    struct exh_slot is;
    sc->defaults();
    if (exh_slots_find(&is, page[0], page[1], PAGE_B) >= 0) {
        CHECK_EQ_I64(exh_params_load(sc->params, is.image, is.len_B, NULL), 0);
    }
    (void)exh_params_apply(sc->params);
}

static void tune(const struct exh_scene *sc, int32_t k)
{
    CHECK_EQ_I64(exh_params_stage(sc->params, 0x0401, 0, k), 0);
    (void)exh_params_apply(sc->params);
}

static int32_t k_of(const struct exh_scene *sc)
{
    const int32_t i = exh_signal_find(sc->params->table, 0x0401, 0);
    CHECK(i >= 0, "no k");
    return sc->params->active[i];
}

static void cut_everywhere(const struct exh_scene *sc)
{
    static uint8_t kept[2][PAGE_B];
    uint32_t olds = 0, news = 0;
    int32_t image_B;
    memset(page, 0xFF, sizeof page);
    supply = UINT32_MAX;
    start(sc);
    for (int32_t k = 1000; k < 1003; k++) {
        tune(sc, k << EXH_Q_K);
        CHECK_EQ_I64(save(sc), 0);
    }
    image_B = exh_params_save(sc->params, kept, sizeof kept);
    CHECK(image_B > 0, "no image");
    memcpy(kept, page, sizeof page);
    for (uint32_t cut = 0; cut <= PAGE_B + EXH_SLOT_B((uint32_t)image_B); cut++) {
        int told;
        memcpy(page, kept, sizeof page);
        supply = UINT32_MAX;
        start(sc);
        CHECK_EQ_I64(k_of(sc), 1002 << EXH_Q_K);
        tune(sc, 2000 << EXH_Q_K);
        supply = cut;
        told = save(sc);
        supply = UINT32_MAX;
        start(sc);
        CHECK_EQ_I64(told, k_of(sc) == 2000 << EXH_Q_K ? 0 : -EXH_E_IO);
        olds += k_of(sc) == 1002 << EXH_Q_K;
        news += k_of(sc) == 2000 << EXH_Q_K;
        tune(sc, 3000 << EXH_Q_K);
        CHECK_EQ_I64(save(sc), 0);
        start(sc);
        CHECK_EQ_I64(k_of(sc), 3000 << EXH_Q_K);
    }
    CHECK(olds + news == PAGE_B + EXH_SLOT_B((uint32_t)image_B) + 1 && news >= 1 && news <= 4,
        "old %lu, new %lu", (unsigned long)olds, (unsigned long)news);
    check_note("%s: an image of %ld B: after a cut the old one %lu times, the new one %lu",
        sc->name, (long)image_B, (unsigned long)olds, (unsigned long)news);
}

TEST(parameters_of_drop) { cut_everywhere(&exh_scene_drop); }

TEST(parameters_of_guarded) { cut_everywhere(&exh_scene_guarded); }

TEST_MAIN("sim/slots", parameters_of_drop, parameters_of_guarded);
