/* SPDX-License-Identifier: MIT */
#include "box/recording_ask.h"

#include "base/option.h"

#include <stdlib.h>
#include <string.h>

#define SENSORS EXH_GLOVE_SENSORS
#define COLUMNS 1000 /* of a line that may be asked for */

static int bad_columns(const char *text)
{
    cli_complain(
        "--columns: %.60s: give the columns of %d sensors, from 1 or by the header's names: "
        "3-24, or 8-14,16-30",
        text, SENSORS);
    return 2;
}

/* One item of the list: N, N-M or a name. How many sensors now; -1: it is none. */
static int take_item(struct recording_sensors *to, int n, const char *item, size_t len)
{
    char text[RECORDING_NAME_B], *end;
    long first, last;
    if (len == 0 || len >= RECORDING_NAME_B || n >= SENSORS) { return -1; }
    memcpy(text, item, len);
    text[len] = '\0';
    first = last = strtol(text, &end, 10);
    if (end != text && *end == '-') { last = strtol(end + 1, &end, 10); }
    if (end == text || *end != '\0') {
        strcpy(to->name[n], text);
        to->column[n] = 0;
        return n + 1;
    }
    if (first < 1 || last < first || last > COLUMNS || last - first >= SENSORS - n) { return -1; }
    for (long k = first; k <= last; k++) { to->column[n++] = (int)k; }
    return n;
}

static int take_columns(struct recording_sensors *to, const char *text)
{
    int n = 0;
    if (text == NULL) { return 0; }
    to->given = 1;
    for (const char *at = text; n >= 0;) {
        const size_t len = strcspn(at, ",");
        n = take_item(to, n, at, len);
        if (at[len] == '\0') { break; }
        at += len + 1;
    }
    return n == SENSORS ? 0 : bad_columns(text);
}

static int take_scale(struct recording_sensors *to, const char *text)
{
    char *end;
    to->gain = 1;
    to->scaled = text != NULL;
    if (text == NULL) { return 0; }
    to->gain = strtod(text, &end);
    if (end != text && *end == ',') { to->offset = strtod(end + 1, &end); }
    if (end == text || *end != '\0' || !(to->gain >= -1e6 && to->gain <= 1e6) || to->gain == 0 ||
        !(to->offset >= -1e6 && to->offset <= 1e6)) {
        cli_complain("--scale: %.60s: give A or A,B: a code is A times the number and B", text);
        return 2;
    }
    return 0;
}

int recording_sensors_of(struct recording_sensors *to, const struct recording_ask *ask)
{
    int err;
    memset(to, 0, sizeof *to);
    err = take_columns(to, ask->columns);
    return err ? err : take_scale(to, ask->scale);
}

int recording_check(const struct recording_ask *ask)
{
    struct recording_sensors ignored;
    return recording_sensors_of(&ignored, ask);
}
