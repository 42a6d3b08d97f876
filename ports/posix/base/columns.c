/* SPDX-License-Identifier: MIT */
#include "base/columns.h"

#include "base/names.h"
#include "base/none.h"
#include "base/option.h"
#include "base/param.h"

#include "exhand/bytes.h"

#define IMAGE_HEAD_B 12u /* before the values, exhand/params.h */

/* --- which fingers --- */

/* Bits of the fingers in use; 0: this scene's instances are no fingers. */
static uint32_t in_use(const struct exh_scene *sc, const uint8_t *params, size_t len_B)
{
    uint32_t index, mask = 0;
    struct exh_bytes c;
    if (sc->params == NULL) { return 0; }
    if (sc->params->table == NULL) { sc->defaults(); } /* nothing of this scene has run yet */
    if (!cli_signal_find(sc->params->table, "fingers", &index) ||
        IMAGE_HEAD_B + 4u * index > len_B) {
        return 0;
    }
    c = exh_bytes_reader(
        params + IMAGE_HEAD_B + 4u * index, (uint32_t)(len_B - IMAGE_HEAD_B - 4u * index));
    exh_bytes_u32(&c, &mask);
    return exh_bytes_ok(&c) ? mask : 0;
}

static int refuse(const char *path, const char *scene, uint32_t used, int finger)
{
    char those[NAMES_B];
    if (used == 0) {
        cli_complain("%s: --finger: the scene %s has no fingers to choose from", path, scene);
        return 2;
    }
    names_bits(those, sizeof those, &names_finger, used);
    cli_complain("%s: --finger: %s is not in use: give one of %s", path,
        names_word(&names_finger, (unsigned)finger), those);
    return 2;
}

/* --- which columns --- */

static int several(const struct exh_signal_table *t, const struct exh_signal *row)
{
    return exh_signal_find(t, row->id, 1) >= 0;
}

static int only_one(uint32_t mask) { return mask != 0 && (mask & (mask - 1)) == 0; }

int columns_choose(struct columns *c, const struct exh_scene *sc, const uint8_t *params,
    size_t len_B, int all, int finger, const char *path)
{
    const struct exh_signal_table *t = sc->signals;
    const struct exh_signal_group *paper = &t->group[0]; /* it is the first */
    const uint32_t n = all ? exh_signal_count(t) : (uint32_t)paper->rows * paper->instances;
    const uint32_t used = in_use(sc, params, len_B);
    uint32_t wanted = all || used == 0 ? UINT32_MAX : used;
    if (finger >= 0) {
        if (!(used >> finger & 1u)) { return refuse(path, sc->name, used, finger); }
        wanted = UINT32_C(1) << finger;
    }
    c->table = t;
    c->n = 0;
    c->alone = only_one(wanted);
    c->fingers = used != 0;
    for (uint32_t i = 0; i < n && c->n < COLUMNS_MAX; i++) {
        uint16_t k;
        const struct exh_signal *row = exh_signal_at(t, i, &k);
        if (!several(t, row) || (wanted >> (k & 31u) & 1u)) { c->at[c->n++] = (uint16_t)i; }
    }
    return 0;
}

/* --- as text --- */

void columns_names(FILE *to, const struct columns *c)
{
    for (uint32_t i = 0; i < c->n; i++) {
        uint16_t k;
        const struct exh_signal *row = exh_signal_at(c->table, c->at[i], &k);
        fprintf(to, ",%s%s%s", row->name, row->unit[0] ? "_" : "", row->unit);
        if (c->alone || !several(c->table, row)) { continue; }
        if (c->fingers) {
            fprintf(to, "_%s", names_word(&names_finger, k));
        } else {
            fprintf(to, "_%u", (unsigned)k);
        }
    }
}

void columns_values(FILE *to, const struct columns *c, const int32_t *v)
{
    for (uint32_t i = 0; i < c->n; i++) {
        none_or_cell(to, exh_signal_at(c->table, c->at[i], NULL), v[c->at[i]]);
    }
}
