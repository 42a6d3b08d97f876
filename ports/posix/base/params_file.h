/* SPDX-License-Identifier: MIT */
/* Images of parameters on disk (exh_params_save). What is saved is what is wanted, not what a
 * slewed value passes on its way. */
#ifndef CLI_PARAMS_FILE_H
#define CLI_PARAMS_FILE_H

#include "exhand/params.h"

#define PARAMS_FILE_B 65536 /* the largest image that is taken */

/* Options of an experiment: read before --set and behind the device's own values; written before it
 * runs. */
struct params_file {
    const char *load, *save;
    unsigned char image[PARAMS_FILE_B];
    size_t len_B;
};
#define PARAMS_FILE_OPTIONS(f) \
    {"load-params", CLI_TEXT, &(f).load, 0, 0, "FILE", \
        "an image of parameters, taken before --set"}, \
    { \
        "save-params", CLI_TEXT, &(f).save, 0, 0, "FILE", \
            "all parameters as an image, before it runs" \
    }

/* Whole or not at all: a file beside it, on disk, then by that name. 0, or 1 after a line on
 * stderr: what was there before is there still. */
int params_write(
    const char *path, const void *image, size_t len_B); /* 0 or an errno, and no line */
int params_save_file(const char *path, const struct exh_params *p);

/* Stages a whole image or nothing. 0, or -EXH_E_... after a line on stderr that begins with `name`.
 * The line gives the refused value and its range, or both versions and tables, or the place of the
 * damage. */
int params_take(const char *name, struct exh_params *p, const void *image, size_t len_B);

/* Reports once per process, in one line on stderr, which values of EXH_WHEN_PERSON in an image were
 * ignored: those that differ in *p after staging. */
void params_tell_left(
    const char *name, const struct exh_params *p, const void *image, size_t len_B);

/* A file's bytes to f->image, if one is to be loaded; the same and params_take(). 0, or the status
 * to end with, after a line on stderr. */
int params_file_read(struct params_file *f);
int params_load_file(const char *path, struct exh_params *p);

#endif
