/* SPDX-License-Identifier: MIT */
/* Which box is watched, and which of its signals. */
#include "live/watch.h"

#include "base/names.h"
#include "base/near.h"
#include "base/option.h"
#include "base/param.h"
#include "base/scenes.h"
#include "base/until.h"

#include <stdlib.h>
#include <string.h>

double watch_age_s(const struct watch_box *b)
{
    return until_now_s() - (b->heard ? b->heard_s : b->since_s);
}

int watch_scene(struct watch_box *b, const char *name, uint32_t crc, uint32_t count)
{
    const struct exh_scene *sc = cli_scene_find(name);
    if (sc == NULL) {
        cli_complain("the box runs the scene %s, which this program does not have", name);
        return 1;
    }
    if (exh_signal_crc(sc->signals) != crc || exh_signal_count(sc->signals) != count) {
        cli_complain(
            "scene %s: the box's table of signals (%lu, CRC %08lx) is another than this program's "
            "(%lu, CRC %08lx): watch it with the program of its version",
            name, (unsigned long)count, (unsigned long)crc,
            (unsigned long)exh_signal_count(sc->signals),
            (unsigned long)exh_signal_crc(sc->signals));
        return 1;
    }
    b->scene = sc;
    return 0;
}

static int unknown(const struct exh_signal_table *t, const char *name)
{
    const char *last = "";
    char mean[NEAR_B];
    struct near n = near_to(name, strlen(name));
    for (uint32_t i = 0; i < exh_signal_count(t); i++) {
        near_try(&n, exh_signal_at(t, i, NULL)->name);
    }
    fprintf(stderr, "exhand watch: --signals: %s: no such signal%s: one of", name,
        near_text(mean, &n, ""));
    for (uint32_t i = 0; i < exh_signal_count(t); i++) {
        const char *is = exh_signal_at(t, i, NULL)->name;
        uint32_t first;
        (void)cli_signal_find(t, is, &first);
        if (first == i && strcmp(is, last) != 0) { fprintf(stderr, " %s", is); }
        last = is;
    }
    fputc('\n', stderr);
    return 2;
}

static int add(struct watch_pick *p, int32_t i, const char *name, const struct exh_signal_table *t)
{
    if (i < 0) { return unknown(t, name); }
    if (p->n == WATCH_SIGNALS) {
        cli_complain("--signals: at most %d", WATCH_SIGNALS);
        return 2;
    }
    p->index[p->n++] = (uint32_t)i;
    return 0;
}

/* "q" or "q[1]". */
static int add_named(
    struct watch_pick *p, const struct exh_signal_table *t, char *name, unsigned finger)
{
    char *bracket = strchr(name, '['), *end = NULL;
    const struct exh_signal *row;
    unsigned long k = finger;
    if (bracket) {
        *bracket = '\0';
        k = strtoul(bracket + 1, &end, 10);
        if (end == bracket + 1 || strcmp(end, "]") != 0 || k > UINT16_MAX) {
            return unknown(t, name);
        }
    }
    row = cli_signal_find(t, name, NULL);
    if (row == NULL) { return unknown(t, name); }
    if (!bracket && exh_signal_find(t, row->id, 1) < 0) { k = 0; } /* there is one of it */
    return add(p, exh_signal_find(t, row->id, (uint16_t)k), name, t);
}

int watch_pick(
    struct watch_pick *p, const struct exh_signal_table *t, const char *names, unsigned finger)
{
    const struct exh_signal_group *paper = &t->group[0];
    int err = 0;
    p->n = 0;
    for (uint16_t i = 0; names == NULL && err == 0 && i < paper->rows && i < WATCH_SIGNALS; i++) {
        const uint16_t k = (uint16_t)(finger < paper->instances ? finger : 0);
        err = add(p, exh_signal_find(t, paper->row[i].id, k), paper->row[i].name, t);
    }
    while (names && *names && err == 0) {
        const size_t len = strcspn(names, ",");
        char name[WATCH_NAME_B];
        snprintf(
            name, sizeof name, "%.*s", (int)(len < sizeof name ? len : sizeof name - 1), names);
        err = add_named(p, t, name, finger);
        names += len + (names[len] == ',');
    }
    return err;
}

const struct exh_signal *watch_name(
    char to[WATCH_NAME_B], const struct exh_signal_table *t, uint32_t i)
{
    uint16_t k = 0;
    const struct exh_signal *row = exh_signal_at(t, i, &k);
    if (exh_signal_find(t, row->id, 1) >= 0) {
        snprintf(to, WATCH_NAME_B, "%s[%u]", row->name, (unsigned)k);
    } else {
        snprintf(to, WATCH_NAME_B, "%s", row->name);
    }
    return row;
}
