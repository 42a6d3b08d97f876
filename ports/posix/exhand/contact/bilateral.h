/* SPDX-License-Identifier: MIT */
/* exhand bilateral: what its parts share. */
#ifndef CLI_BILATERAL_H
#define CLI_BILATERAL_H

#include "contact/judge.h"
#include "contact/hand_record.h"
#include "base/jobs.h"
#include "base/option.h"
#include "base/params_file.h"

#include <stdio.h>

#define BILATERAL_SPEEDS_MAX   8
#define BILATERAL_SETTINGS_MAX 64
#define BILATERAL_NAME_B       32

struct bilateral_speed {
    char name[BILATERAL_NAME_B];
    double mps;
};

struct bilateral_options {
    struct bilateral_run_cfg run; /* all but the speed */
    struct bilateral_speed speed[BILATERAL_SPEEDS_MAX];
    int speeds;
    int64_t approaches, seed, jobs;
    int study, cards, own_scale; /* own_scale: s was set, it is not fitted; study: the lab
                                  * runs many */
    const char *scene, *out, *udp, *link, *record;
    double record_Hz;
    struct run_setting setting[BILATERAL_SETTINGS_MAX];
    int settings;
    struct sim_trace trace;
    struct hand_record hand;
    struct images images;
    struct params_file params;
};

extern const char *const bilateral_finger_name[BILATERAL_FINGERS];

/* bilateral.c: what holds without options. */
void bilateral_defaults(struct bilateral_options *o);

/* bilateral_take.c, bilateral_link.c: options by cli_call, ctx the struct above. 0, or 2 after a
 * line on stderr. */
int bilateral_take_speeds(void *ctx, const char *text);
int bilateral_take_fingers(void *ctx, const char *text);
int bilateral_take_pose(void *ctx, const char *text);
int bilateral_take_link(void *ctx, const char *text); /* into both ways */
int bilateral_take_setting(void *ctx, const char *text);
int bilateral_take_device(void *ctx, const char *text);
void bilateral_print_params(void);

/* bilateral_experiment.c: exit status. */
int bilateral_experiment(const struct bilateral_options *o);

/* The run of one speed. */
struct bilateral_run_cfg bilateral_at_speed(const struct bilateral_options *o, double mps);

/* bilateral_report.c. What a speed gave, of one finger. */
#define BILATERAL_CONTACTS_MAX 1000
struct bilateral_result {
    const struct bilateral_speed *speed;
    unsigned finger;
    struct bilateral_contact *contact;
    int contacts;
    double stiffness_Npm, settle_s; /* pooled; median of those that settled */
    int settled, missed, early;
    double scale, touch_m;
};
void bilateral_print_head(FILE *f);
void bilateral_print(FILE *f, const struct bilateral_result *r);
void bilateral_print_paper(FILE *f, const struct bilateral_result *r, int n, double local_Npm);
/* What each finger did in all: its range of motion, its contacts, its largest force. */
void bilateral_print_session(FILE *f, const struct bilateral_run *r, unsigned fingers);
void bilateral_csv_head(FILE *f);
void bilateral_csv(FILE *f, const struct bilateral_result *r);
/* Whether d_lim is far enough off for these speeds; and what it should be. */
void bilateral_print_advice(FILE *f, const struct bilateral_options *o,
                            const struct bilateral_result *r, int n);

/* After a run: what the advice for d_lim and the ray goes by, over a perfect link. */
struct exh_precontact_need bilateral_need(const struct bilateral_options *o, double scale,
                                          double mps);

/* bilateral_out.c: DIR. 0, or 1 or 2 after a line on stderr. */
int bilateral_out_open(const char *dir);
FILE *bilateral_out_file(const char *dir, const char *name);
void bilateral_out_name(char *to, size_t cap_B, const char *dir, const char *speed, int finger,
                        const char *suffix);
int bilateral_out_csv(const char *dir, const struct bilateral_run *r, unsigned f,
                      const char *speed);
int bilateral_out_pictures(const char *dir, const struct bilateral_result *r, int n, double k_Npm,
                           double b_Nspm, const char *link);

/* What the lab does with the options besides. */
struct bilateral_study {
    struct cli_more more;
    int (*refuse)(struct bilateral_options *o, double rate_Hz); /* 0 or 2; NULL: nothing */
    int (*run)(const struct bilateral_options *o);              /* NULL: the experiment */
};

/* The command: exit status. */
int bilateral_command(int argc, char **argv, struct bilateral_options *o,
                      const struct bilateral_study *study);

#endif
