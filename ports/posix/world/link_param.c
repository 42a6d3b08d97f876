/* SPDX-License-Identifier: MIT */
/* The world's parameter requests to the controller: repeated until answered, and again after a
 * restart of the controller. */
#include "link_part.h"

#include "exhand/exhand.h"

#include <stdio.h>
#include <string.h>

#define AGAIN_US   100000  /* without an answer for so long, the request is repeated */
#define A_FRAME    2       /* requests in one frame: a tick of the controller takes few packets */
#define PATIENT_US 1000000 /* without an answer for so long it goes on without */

static void say(const struct link *l, const struct link_want *w, double value, const char *what)
{
    char text[400];
    if (l->say == NULL) { return; }
    snprintf(text, sizeof text, "material %s: %s %.9g %s: %s", w->name, w->row->name, value,
        w->row->unit, what);
    l->say(text);
}

static double value_of(const struct link_want *w)
{
    return (double)w->param.value / (double)(INT64_C(1) << w->row->frac);
}

int link_want(
    struct link *l, const char *name, const struct exh_signal *row, unsigned instance, double value)
{
    const double one = (double)(INT64_C(1) << row->frac), raw = value * one;
    struct link_want w = {{row->id, (uint16_t)instance, 0}, row, "", 0, 0};
    if (l->wants == LINK_WANTS) { return 1; }
    snprintf(w.name, sizeof w.name, "%s", name);
    if (!(raw >= row->min && raw <= row->max)) {
        char why[120];
        snprintf(why, sizeof why, "not between %.9g and %.9g: not sent, the controller's own holds",
            row->min / one, row->max / one);
        say(l, &w, value, why);
        l->refused++;
        return 1;
    }
    w.param.value = (int32_t)(raw < 0 ? raw - 0.5 : raw + 0.5);
    l->want[l->wants++] = w;
    return 0;
}

void link_materials(struct link *l, const struct scene *s)
{
    for (int i = 0; i < s->materials; i++) {
        const struct scene_material *m = &s->material[i];
        const double value[EXH_MATERIAL_ROWS] = {m->k, m->b, m->f_max};
        for (int r = 0; r < EXH_MATERIAL_ROWS; r++) {
            (void)link_want(l, m->name, &exh_material_rows[r], (unsigned)i, value[r]);
        }
    }
    l->waiting = l->wants;
}

void link_params_anew(struct link *l, int64_t now_us)
{
    for (int i = 0; i < l->wants; i++) {
        l->want[i].answered = 0;
        l->want[i].asked_us = now_us - AGAIN_US;
    }
    l->waiting = l->wants;
    l->anew_us = now_us;
    l->impatient = 0;
}

void link_params_answered(struct link *l, const struct exh_wire_ack *a)
{
    for (int i = 0; i < l->wants; i++) {
        struct link_want *w = &l->want[i];
        const struct exh_wire_param *p = &w->param;
        char why[200];
        if (p->id != a->param.id || p->instance != a->param.instance) { continue; }
        if (p->value != a->param.value) { /* an old one came late and holds now: ask again */
            l->waiting += w->answered;
            w->answered = 0;
        }
        if (w->answered || p->value != a->param.value) { continue; }
        w->answered = 1;
        l->waiting--;
        if (a->result == 0) { continue; }
        l->refused++;
        snprintf(why, sizeof why, "refused by the controller: %s", exh_error_text(a->result));
        say(l, w, value_of(w), why);
    }
}

void link_params_ask(struct link *l, int64_t now_us)
{
    int asked = 0;
    for (int i = 0; i < l->wants && asked < A_FRAME; i++) {
        struct link_want *w = &l->want[i];
        struct exh_wire_packet p;
        if (w->answered || now_us - w->asked_us < AGAIN_US) { continue; }
        memset(&p, 0, sizeof p);
        p.type = EXH_WIRE_PARAM;
        p.u.param = w->param;
        link_put(l, &p, now_us);
        w->asked_us = now_us;
        asked++;
    }
}

static void lose_patience(struct link *l)
{
    l->impatient = 1;
    for (int i = 0; i < l->wants; i++) {
        if (!l->want[i].answered) {
            char why[120];
            snprintf(why, sizeof why,
                "no answer (%d of %d are without): the controller's own holds till then",
                l->waiting, l->wants);
            say(l, &l->want[i], value_of(&l->want[i]), why);
            break;
        }
    }
}

void link_params_hide(struct link *l, struct exh_wire_planes *planes, int64_t now_us)
{
    if (l->waiting == 0 || l->impatient) { return; }
    if (now_us - l->anew_us >= PATIENT_US) {
        lose_patience(l);
        return;
    }
    for (int i = 0; i < l->wants; i++) {
        for (unsigned f = 0; f < EXH_FINGERS && !l->want[i].answered; f++) {
            if (planes->plane[f].material == l->want[i].param.instance) {
                planes->plane[f].kind = EXH_PLANE_UNTOLD;
            }
        }
    }
}
