/* SPDX-License-Identifier: MIT */
/* exhand-lab faults --states: the state machine as the library has it. */
#include "lab/faults/part.h"
#include "base/names.h"

#include "exhand/safety.h"

#include <string.h>

#define RATE_HZ 1000u

/* All that a tick may find, a value of each kind. */
struct found {
    unsigned state, faults, limits, share, late, raised, command, ready;
};

static unsigned dealt(unsigned *code, unsigned n)
{
    const unsigned k = *code % n;
    *code /= n;
    return k;
}

#define FOUND (EXH_STATES * 2 * 4 * 3 * 2 * 3 * 4 * 2)

static struct found found_of(unsigned code)
{
    struct found f;
    f.state = dealt(&code, EXH_STATES);
    f.faults = dealt(&code, 2);
    f.limits = dealt(&code, 4);
    f.share = dealt(&code, 3);
    f.late = dealt(&code, 2);
    f.raised = dealt(&code, 3);
    f.command = dealt(&code, 4);
    f.ready = dealt(&code, 2);
    return f;
}

/* Which trigger it is; -1: no state that can be. */
static int trigger_of(const struct found *f, const struct exh_safety_cfg *cfg)
{
    static const uint32_t limits[4] = {0, EXH_LIMIT_PULL, EXH_LIMIT_FORCE, EXH_LIMIT_SLEW};
    static const uint32_t raised[3] = {0, EXH_FAULT_LINK, EXH_FAULT_CONFIG};
    static const int32_t share[3] = {0, 1, INT32_C(1) << 30};
    struct exh_safety_in in = {UINT32_MAX, raised[f->raised], 0, (uint8_t)f->command, 1,
        (uint8_t)(f->ready ? EXH_ARM_ALL : 0u)};
    struct exh_safety s;
    memset(&s, 0, sizeof s);
    s.state = (uint8_t)f->state;
    s.faults = f->faults ? EXH_FAULT_LINK : 0u;
    s.opened = 1;
    s.limits = limits[f->limits];
    s.share_q30 = f->state == EXH_STATE_ARM ? share[f->share] : 0;
    s.steps = f->late ? UINT32_MAX / 2 : 0;
    (void)exh_safety_step(&s, cfg, in);
    return s.present & EXH_FAULT_LOGIC ? -1 : s.trigger;
}

static int reached(uint8_t seen[EXH_STATES][EXH_TRIGGERS])
{
    static const struct exh_safety_par par = {1, 1 << 20, 50, 500, 15};
    struct exh_safety_cfg cfg;
    const int err = exh_safety_setup(&cfg, &par, (struct exh_period){1, RATE_HZ});
    memset(seen, 0, EXH_STATES * EXH_TRIGGERS);
    for (unsigned code = 0; code < FOUND && err == 0; code++) {
        const struct found f = found_of(code);
        const int t = trigger_of(&f, &cfg);
        if (t >= 0) { seen[f.state][t] = 1; }
    }
    return err;
}

static void print_upper(FILE *f, const char *word)
{
    for (; *word; word++) { fputc(*word >= 'a' && *word <= 'z' ? *word - 'a' + 'A' : *word, f); }
}

static void print_table(FILE *f, const uint8_t seen[EXH_STATES][EXH_TRIGGERS])
{
    fprintf(f, "| in |");
    for (unsigned t = 0; t < EXH_TRIGGERS; t++) { fprintf(f, " %s |", exh_trigger_name(t)); }
    fprintf(f, "\n|--|");
    for (unsigned t = 0; t < EXH_TRIGGERS; t++) { fprintf(f, "--|"); }
    for (unsigned s = 0; s < EXH_STATES; s++) {
        fprintf(f, "\n| ");
        print_upper(f, exh_state_name(s));
        for (unsigned t = 0; t < EXH_TRIGGERS; t++) {
            fprintf(f, " | %s", seen[s][t] ? exh_state_name(exh_safety_next[s][t]) : "F");
        }
        fprintf(f, " |");
    }
    fputc('\n', f);
}

static void print_names(FILE *f, const struct names *t)
{
    fprintf(f, "\n| %s | means |\n|--|--|\n", t->what);
    for (unsigned k = 0; k < t->n; k++) {
        fprintf(f, "| %s | %s |\n", names_word(t, k), names_says(t, k));
    }
}

int faults_states(FILE *f)
{
    uint8_t seen[EXH_STATES][EXH_TRIGGERS];
    if (reached(seen)) { return 1; }
    print_table(f, (const uint8_t(*)[EXH_TRIGGERS])seen);
    fprintf(f, "\nIn a tick the first that applies decides, from left to right; F: cannot be, and "
               "leads to FAULT.\n");
    print_names(f, &names_state);
    fprintf(f, "\n| fault | ends by | means |\n|--|--|--|\n");
    for (unsigned k = 0; k < EXH_FAULTS; k++) {
        fprintf(f, "| %s | %s | %s |\n", exh_fault_name(k),
            EXH_FAULT_CUT >> k & 1u ? "cut" : "release", names_says(&names_fault, k));
    }
    print_names(f, &names_limit);
    print_names(f, &names_arm);
    return 0;
}
