/* SPDX-License-Identifier: MIT */
/* exhand-lab bilateral --preset original: a hand in the system before, and in this box. */
#include "lab/contact/studies.h"

#include "base/option.h"
#include "lab/drop/preset.h"
#include "falls/quantile.h"
#include "box/table2.h"

#include <stdlib.h>
#include <string.h>

enum row {
    RATE,
    K,
    B,
    APPROACHES,
    EARLY,
    MISSED,
    PLACE,
    PLACE_LEAST,
    PLACE_MOST,
    PEAK,
    DEEPEST,
    HELD,
    SETTLED,
    SETTLE,
    STIFFNESS,
    ERROR,
    SHARE,
    ROWS
};

static const struct original_row row[ROWS] = {
    [RATE] = {"loop", "Hz", 0},
    [K] = {"k", "N/m", 0},
    [B] = {"b", "Ns/m", 0},
    [APPROACHES] = {"approaches", "", 0},
    [EARLY] = {"  felt 1 mm or more before the object", "", 0},
    [MISSED] = {"  not felt at all", "", 0},
    [PLACE] = {"contact less surface, string, mean", "mm", 2},
    [PLACE_LEAST] = {"  from", "mm", 2},
    [PLACE_MOST] = {"  to", "mm", 2},
    [PEAK] = {"largest force, monitored", "N", 2},
    [DEEPEST] = {"deepest past the contact", "mm", 2},
    [HELD] = {"force held, mean", "N", 2},
    [SETTLED] = {"approaches that settle within 5 %", "", 0},
    [SETTLE] = {"  in, median", "ms", 1},
    [STIFFNESS] = {"stiffness, all approaches", "N/m", 0},
    [ERROR] = {"force less what it should be, rms", "N", 2},
    [SHARE] = {"  of what it should be, rms", "%", 0},
};

struct column {
    double *v;
    int columns;
};

static double *at(const struct column *c, enum row r) { return &c->v[(int)r * c->columns]; }

/* All of one kind: none is 0 approaches. */
static void fill_contacts(const struct column *to, const struct bilateral_contact *k, int n)
{
    static double settle_s[BILATERAL_CONTACTS_MAX];
    double place_m = 0, held_N = 0, least_m = 1, most_m = -1;
    int there = 0, settled = 0;
    for (int i = 0; i < n; i++) {
        *at(to, EARLY) += k[i].early;
        *at(to, MISSED) += k[i].missed;
        if (k[i].settle_s >= 0) { settle_s[settled++] = k[i].settle_s; }
        if (k[i].t_s <= 0) { continue; }
        there++;
        place_m += k[i].off_m;
        held_N += k[i].held_N;
        least_m = k[i].off_m < least_m ? k[i].off_m : least_m;
        most_m = k[i].off_m > most_m ? k[i].off_m : most_m;
    }
    *at(to, APPROACHES) = n;
    *at(to, SETTLED) = settled;
    *at(to, SETTLE) = settled ? 1e3 * quantile(settle_s, settled, settled, 0.5) : 2 * ORIGINAL_NONE;
    *at(to, PLACE) = there ? 1e3 * place_m / there : 2 * ORIGINAL_NONE;
    *at(to, PLACE_LEAST) = there ? 1e3 * least_m : 2 * ORIGINAL_NONE;
    *at(to, PLACE_MOST) = there ? 1e3 * most_m : 2 * ORIGINAL_NONE;
    *at(to, HELD) = there ? held_N / there : 2 * ORIGINAL_NONE;
}

static void fill_samples(const struct column *to, const struct bilateral_run *r, unsigned f)
{
    const struct bilateral_track *t = &r->finger[f];
    struct original_contact c = {0, 0, 0, 0, 0};
    for (size_t i = 0; i < t->n; i++) {
        const struct fall_sample s = bilateral_si(&t->at[i], i, r->T);
        original_add(&c, &s, (double)t->at[i].raw.q_lim_m_q30 / (1 << EXH_Q_POS));
    }
    original_end(&c);
    *at(to, PEAK) = c.peak_N;
    *at(to, DEEPEST) = 1e3 * c.deepest_m;
    *at(to, ERROR) = c.err_N;
    *at(to, SHARE) = c.rms_N > 0 ? 100 * c.err_N / c.rms_N : 2 * ORIGINAL_NONE;
}

static int trace(const char *dir, int n, const struct bilateral_run *r, unsigned f,
    const struct bilateral_contact *k)
{
    const struct bilateral_track *t = &r->finger[f];
    struct fall_sample *s = calloc(t->n + 1, sizeof *s);
    int err;
    if (s == NULL) { return 1; }
    for (size_t i = 0; i < t->n; i++) { s[i] = bilateral_si(&t->at[i], i, r->T); }
    err = original_trace(dir, n, s, t->n, k->first, k->lim_m);
    free(s);
    return err;
}

static int column(
    const struct column *to, const struct bilateral_run_cfg *c, const char *dir, int n)
{
    static struct bilateral_contact contact[BILATERAL_CONTACTS_MAX];
    struct bilateral_run r;
    unsigned f = 0;
    int err = bilateral_run(c, &r) < 0 ? 2 : r.faults ? 1 : 0;
    while (!(c->board.exo.fingers >> f & 1)) { f++; }
    if (err == 0) {
        const int found = bilateral_judge(&r, f, contact, BILATERAL_CONTACTS_MAX);
        const double k_Npm = bilateral_stiffness(&r, f, 0, NULL).k_Npm;
        *at(to, RATE) = c->rate_Hz;
        *at(to, K) = c->k_Npm;
        *at(to, B) = c->b_Nspm;
        *at(to, STIFFNESS) = k_Npm > 0 ? k_Npm : 2 * ORIGINAL_NONE;
        fill_contacts(to, contact, found < BILATERAL_CONTACTS_MAX ? found : BILATERAL_CONTACTS_MAX);
        fill_samples(to, &r, f);
        if (dir && found > 0 && contact[0].t_s > 0) { err = trace(dir, n, &r, f, &contact[0]); }
    }
    bilateral_run_free(&r);
    return err;
}

/* Of 90 Hz and a glove of 8 bits, a frame late, with nothing that smooths it. */
static struct bilateral_run_cfg original_of(
    const struct bilateral_run_cfg *box, struct run_setting setting[BILATERAL_SETTINGS_MAX + 3])
{
    static const struct run_setting plain[3] = {
        {"glove_order", 0}, {"glove_bits", 16}, {"glove_hyst", 0}};
    const struct table2_row *g = table2_gains(ORIGINAL_RATE_HZ);
    struct bilateral_run_cfg c = *box;
    memcpy(setting, plain, sizeof plain);
    memcpy(setting + 3, box->setting, (size_t)box->settings * sizeof *setting);
    c.setting = setting;
    c.settings = box->settings + 3;
    c.rate_Hz = ORIGINAL_RATE_HZ;
    c.trial = 1; /* as it was, which no rule of gains has at 90 Hz */
    c.k_Npm = g->k_Npm;
    c.b_Nspm = g->b_Nspm;
    c.board.stock = 1;
    return c;
}

int bilateral_original(const struct bilateral_options *o)
{
    static const char *const drawn[2] = {"original", "this box"};
    static struct run_setting setting[BILATERAL_SETTINGS_MAX + 3];
    static double value[ROWS * ORIGINAL_COLUMNS];
    static char name[ORIGINAL_COLUMNS][BILATERAL_NAME_B + 16];
    const char *names[ORIGINAL_COLUMNS];
    const struct original_table t = {row, ROWS, 2 * o->speeds, names, value};
    int err = 0;
    for (int n = 0; err == 0 && n < 2 * o->speeds; n++) {
        const struct bilateral_speed *speed = &o->speed[n / 2];
        struct bilateral_run_cfg c = bilateral_at_speed(o, speed->mps);
        const struct column to = {value + n, 2 * o->speeds};
        const int draw = n / 2 == o->speeds / 2;
        c.keep = 1;
        if (n % 2 == 0) { c = original_of(&c, setting); }
        (void)snprintf(
            name[n], sizeof name[n], "%s %s", speed->name, n % 2 ? "this box" : "original");
        names[n] = name[n];
        err = column(&to, &c, draw ? o->out : NULL, n % 2);
        if (posix_interrupted()) { return 130; }
    }
    if (err) { return err; }
    original_print(&t);
    printf(
        "\n\"Original\" is a loop at 90 Hz with the paper's gains for that rate. Its glove has 8 "
        "bits (1..255 at -9..9 V),\n"
        "is one frame late and is not filtered. The same law freezes contacts in both columns.\n"
        "\"Force less what it should be\" is monitored less demanded force of the same tick, over "
        "all ticks in contact.\n");
    return o->out ? original_out(o->out, &t, drawn, 2) : 0;
}
