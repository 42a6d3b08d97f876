/* SPDX-License-Identifier: MIT */
/* The mailbox between the loop and the thread that answers Modbus requests. */
#include "slave/slave.h"

#include "base/option.h"
#include "base/params_file.h"

#include "exhand/error.h"

#include <errno.h>
#include <pthread.h>
#include <string.h>

#define IMAGE_B (16u + 4u * EXH_REGS_VALUES)

static struct {
    struct mail_cfg cfg;
    const struct exh_scene *sc;
    struct exh_regs regs;
    int32_t signal[EXH_REGS_VALUES], active[EXH_REGS_VALUES], wanted[EXH_REGS_VALUES];
    int32_t staged[EXH_REGS_VALUES];
    uint32_t touched[EXH_REGS_WORDS(EXH_REGS_VALUES)];
    struct exh_trace own, shown; /* own: the loop's, of every tick */
    struct exh_trace_frame own_frame[EXH_TRACE_FRAMES], shown_frame[EXH_TRACE_FRAMES];
    int save;       /* 1: requested; the image is made after the next tick */
    int32_t made_B; /* bytes of image to be written; 0: none, or -EXH_E… */
    uint8_t image[IMAGE_B];
} mail;

static pthread_mutex_t lock = PTHREAD_MUTEX_INITIALIZER;

void mail_open(const struct mail_cfg *cfg)
{
    memset(&mail, 0, sizeof mail);
    mail.cfg = *cfg;
}

struct exh_regs *mail_take(void)
{
    pthread_mutex_lock(&lock);
    return &mail.regs;
}

void mail_give(void) { pthread_mutex_unlock(&lock); }

/* What the registers show; the lock is held. */
static void copy_values(void)
{
    const struct exh_params *p = mail.sc->params;
    memcpy(mail.signal, exh_scene_signals(mail.sc), 4 * (size_t)mail.regs.signals_n);
    memcpy(mail.active, p->active, 4 * (size_t)mail.regs.params_n);
    memcpy(mail.wanted, p->staged, 4 * (size_t)mail.regs.params_n);
    mail.regs.locked = p->locked;
}

int mail_start(const struct exh_scene *sc, struct exh_scene_board board)
{
    struct exh_regs *r = &mail.regs;
    int err;
    mail.sc = sc;
    r->name = sc->name;
    r->signals = sc->signals;
    r->params = sc->params->table;
    r->signal = mail.signal;
    r->active = mail.active;
    r->wanted = mail.wanted;
    r->staged = mail.staged;
    r->touched = mail.touched;
    r->T = board.T;
    r->fingers = sc->fingers;
    r->may = mail.cfg.write ? EXH_REGS_MAY : 0;
    if (mail.cfg.write && mail.cfg.save) { r->may |= 1u << EXH_COIL_SAVE; }
    if (mail.cfg.remote) {
        r->may |= 1u << EXH_COIL_RUN | 1u << EXH_COIL_CLEAR | 1u << EXH_COIL_OFF;
    }
    err = exh_regs_setup(r);
    if (err == 0) {
        r->trace = &mail.shown;
        err = exh_trace_setup(&mail.shown, mail.shown_frame, EXH_TRACE_FRAMES, r->signals_n);
    }
    if (err == 0) {
        err = exh_trace_setup(&mail.own, mail.own_frame, EXH_TRACE_FRAMES, r->signals_n);
    }
    if (err == 0) { copy_values(); }
    return err;
}

/* All that is staged or nothing: a scene's rule judges the values together. */
static int apply(void)
{
    static int32_t was[EXH_REGS_VALUES];
    struct exh_params *p = mail.sc->params;
    const uint8_t pending = p->pending;
    int err;
    memcpy(was, p->staged, 4 * (size_t)mail.regs.params_n);
    mail.regs.box.state = mail.sc->safety->state; /* it may run by now */
    err = exh_regs_apply(&mail.regs, p);
    if (err == 0 && mail.sc->allowed) { err = mail.sc->allowed(); }
    if (err < 0) { exh_params_rollback(p, was, pending); }
    return err;
}

int mail_before(struct exh_scene_in *in)
{
    uint32_t asked;
    uint8_t command;
    if (pthread_mutex_trylock(&lock) != 0) { return 0; }
    asked = exh_regs_poll(&mail.regs);
    command = exh_regs_command(asked);
    if (asked & 1u << EXH_COIL_APPLY) {
        const int err = apply();
        copy_values();
        exh_regs_complete(&mail.regs, err);
    }
    if (asked & 1u << EXH_COIL_SAVE) { mail.save = 1; }
    if (command != EXH_CMD_NONE) {
        if (command == EXH_CMD_OFF || in->command == EXH_CMD_NONE) { in->command = command; }
        exh_regs_complete(&mail.regs, 0);
    }
    mail_give();
    return 1;
}

/* One at a time: a second SAVE waits until the first is written. */
static void make_image(void)
{
    if (!mail.save || mail.made_B != 0) { return; }
    mail.made_B = exh_params_save(mail.sc->params, mail.image, sizeof mail.image);
    mail.save = 0;
}

void mail_after(const struct exh_scene_in *in)
{
    if (exh_trace_reads(&mail.own)) { (void)exh_scene_signals(mail.sc); }
    exh_trace_step(&mail.own, mail.sc->safety->tick, mail.sc->values);
    (void)mail_show(in);
}

int mail_show(const struct exh_scene_in *in)
{
    if (pthread_mutex_trylock(&lock) != 0) { return 0; }
    exh_trace_copy(&mail.own, &mail.shown);
    copy_values();
    exh_regs_update(&mail.regs, mail.sc->safety, in->drive.din);
    make_image();
    mail_give();
    return 1;
}

void mail_save(void)
{
    static uint8_t image[IMAGE_B];
    int32_t len_B;
    int why;
    pthread_mutex_lock(&lock);
    len_B = mail.made_B;
    if (len_B > 0) { memcpy(image, mail.image, (size_t)len_B); }
    mail_give();
    if (len_B == 0) { return; }
    why = len_B < 0 ? EFBIG : params_write(mail.cfg.save, image, (size_t)len_B);
    pthread_mutex_lock(&lock);
    mail.made_B = 0;
    exh_regs_complete(&mail.regs, why == 0 ? 0 : len_B < 0 ? (int)len_B : -EXH_E_IO);
    mail_give();
    if (why) { cli_complain("--save: %s: can't be written: %s", mail.cfg.save, strerror(why)); }
}

void mail_end(void)
{
    struct exh_scene_in in = {0};
    mail_save();
    (void)mail_before(&in); /* an APPLY that came with it is staged first, as before any tick */
    make_image();
    mail_save();
}
