/* SPDX-License-Identifier: MIT */
#include "identify/data.h"

#include "identify/identify.h"
#include "identify/model.h"

#include "base/logfile.h"
#include "base/option.h"

#include "exhand/run/log.h"

#include "exhand/error.h"

#include <stdlib.h>
#include <string.h>

static double si(int32_t raw, int frac) { return (double)raw / (double)(INT64_C(1) << frac); }

void identify_data_free(struct identify_data *d)
{
    free(d->sample);
    memset(d, 0, sizeof *d);
}

void identify_data_begin(struct identify_data *d, struct exh_period T)
{
    const struct identify_par *par = identify_config()->par;
    memset(d, 0, sizeof *d);
    d->T_s = (double)T.num / T.den;
    d->par = *par;
    d->mass_kg = si(par->own.mass_kg_q20, EXH_Q_FORCE);
    d->step_m = si(par->quad.step_m_q42, EXH_Q_STEP);
    d->servo_Hz = MODEL_SERVO_HZ;
}

static int grow(struct identify_data *d)
{
    struct identify_sample *s;
    if (d->n < d->cap) { return 1; }
    s = realloc(d->sample, (d->cap + 65536) * sizeof *s);
    if (s == NULL) {
        d->no_memory = 1;
        return 0;
    }
    d->sample = s;
    d->cap += 65536;
    return 1;
}

void identify_data_tick(struct identify_data *d)
{
    const struct identify *s = identify_state();
    struct identify_signals sig;
    if (!grow(d)) { return; }
    memcpy(&sig, exh_scene_signals(&exh_scene_identify), sizeof sig);
    if (d->n == 0) { d->first_cnt = s->quad.cnt; }
    d->sample[d->n++] = (struct identify_sample){.cnt = s->quad.cnt - d->first_cnt,
        .coded_A = (float)si(sig.i_des_A_q26, EXH_Q_CUR),
        .mon_A = (float)si(sig.i_mon_A_q26, EXH_Q_CUR),
        .part = s->run.part,
        .stage = s->run.stage,
        .busy = s->busy,
        .repeat = s->run.repeat};
    d->result = s->result;
}

/* --- from a log: the scene sees again what it saw --- */

static int start_scene(const struct logfile *l)
{
    uint32_t bad = 0;
    int err;
    exh_scene_identify.defaults();
    err = exh_params_restore(exh_scene_identify.params, l->params, l->params_len, &bad);
    if (err == 0) {
        (void)exh_params_apply(exh_scene_identify.params);
        err = exh_scene_identify.setup(
            (struct exh_scene_board){l->header.T, (uint8_t)l->header.enc_bits});
    }
    if (err < 0) { cli_complain("%s: parameters: %s", l->path, exh_error_text(err)); }
    return err < 0 ? 2 : 0;
}

struct again {
    struct exh_scene_in in;
    uint64_t tick; /* expected */
};

static int on_event(struct again *a, const struct exh_record *r)
{
    struct exh_bytes c = exh_bytes_reader(r->payload, r->len_B);
    struct exh_event e;
    exh_event_serialize(&c, &e);
    if (!exh_bytes_ok(&c)) { return 0; }
    if (e.type == EXH_EVENT_COMMAND) { a->in.command = (uint8_t)e.value; }
    if (e.type == EXH_EVENT_MISSED) { a->in.missed = (uint32_t)e.value; }
    return e.type == EXH_EVENT_PARAM
               ? exh_params_stage(exh_scene_identify.params, e.id, e.instance, e.value)
               : 0;
}

static int on_frame(
    struct identify_data *d, struct again *a, struct logfile *l, const struct exh_record *r)
{
    struct exh_bytes c = exh_bytes_reader(r->payload, r->len_B);
    struct exh_drive_out was, is;
    int32_t signal[sizeof(struct identify_signals) / sizeof(int32_t)];
    exh_log_frame_serialize(&c, &exh_scene_identify, &a->in, &was, signal);
    if (!exh_bytes_ok(&c) || l->tick != a->tick) {
        cli_complain("%s: tick %llu: frames are missing: give a log that is whole", l->path,
            (unsigned long long)a->tick);
        return 2;
    }
    (void)exh_params_apply(exh_scene_identify.params);
    exh_scene_identify.tick(&a->in, &is);
    if (memcmp(signal, exh_scene_signals(&exh_scene_identify), sizeof signal) != 0) {
        cli_complain("%s: tick %llu: another scene: exhand replay says what differs", l->path,
            (unsigned long long)a->tick);
        return 2;
    }
    a->tick++;
    memset(&a->in, 0, sizeof a->in);
    identify_data_tick(d);
    return 0;
}

int identify_data_log(struct identify_data *d, const char *path)
{
    struct logfile l;
    struct exh_record r;
    struct again a;
    int err;
    memset(d, 0, sizeof *d);
    memset(&a, 0, sizeof a);
    memset(&l, 0, sizeof l);
    err = logfile_open(&l, path);
    if (err) { return err; }
    if (l.scene != &exh_scene_identify) {
        cli_complain("%s: a log of %s: give one of identify", path, l.scene->name);
        err = 2;
    }
    if (err == 0) { err = start_scene(&l); }
    if (err == 0) { identify_data_begin(d, l.header.T); }
    while (err == 0 && logfile_next(&l, &r)) {
        if (r.type == EXH_RECORD_EVENT && on_event(&a, &r) < 0) { err = 2; }
        if (r.type == EXH_RECORD_FRAME) { err = on_frame(d, &a, &l, &r); }
    }
    logfile_close(&l);
    return err;
}
