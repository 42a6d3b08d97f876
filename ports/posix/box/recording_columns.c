/* SPDX-License-Identifier: MIT */
#include "box/recording_columns.h"

#include "base/option.h"

#include <stdlib.h>
#include <string.h>

#define SENSORS EXH_GLOVE_SENSORS

/* What a list may say, the sensors first: they have no key. */
static const struct kind {
    const char *key;
    enum recording_use first;
    int columns;
    double time_s;
} kind[] = {
    {"", RECORDING_SENSOR, SENSORS, 0},
    {"time=", RECORDING_TIME, 1, 1},
    {"time_ms=", RECORDING_TIME, 1, 1e-3},
    {"time_us=", RECORDING_TIME, 1, 1e-6},
    {"clock=", RECORDING_TIME, 3, 0},
    {"label=", RECORDING_LABEL, 1, 0},
};
#define KINDS ((int)(sizeof kind / sizeof kind[0]))

/* A list while it is read. */
struct list {
    struct recording_columns *to;
    const struct recording_line *head;
    const char *path;
    int taken[RECORDING_USES]; /* by the first use of a kind: how many columns it has */
};

void recording_columns_plain(struct recording_columns *c, int first)
{
    memset(c, 0, sizeof *c);
    for (int i = 0; i < SENSORS; i++) {
        c->use[first - 1 + i] = (unsigned char)(RECORDING_SENSOR + i);
    }
    c->last = first + SENSORS - 1;
}

int recording_columns_has(const struct recording_columns *c, enum recording_use use)
{
    return memchr(c->use, (int)use, sizeof c->use) != NULL;
}

static int refuse(const struct list *l, const char *item, size_t len, const char *why)
{
    cli_complain("%s: columns: %.*s: %s", l->path, (int)len, item, why);
    return 2;
}

/* The column of a number or a name; 0: neither. */
static int column_of(struct list *l, const char *text, size_t len)
{
    char word[RECORDING_FIELD_B], *end;
    long n;
    if (len == 0 || len >= sizeof word) { return 0; }
    memcpy(word, text, len);
    word[len] = '\0';
    n = strtol(word, &end, 10);
    if (*end == '\0') { return n >= 1 && n <= RECORDING_COLUMNS ? (int)n : 0; }
    for (int i = 0; i < l->head->n && i < RECORDING_COLUMNS; i++) {
        if (strcmp(l->head->field[i], word) == 0) {
            l->to->named = 1;
            return i + 1;
        }
    }
    return 0;
}

/* One column, or two with '-' between, which may also be part of a name. 0: no such columns. */
static int range_of(struct list *l, const char *text, size_t len, int *from, int *to)
{
    *from = *to = column_of(l, text, len);
    for (size_t i = 1; *from == 0 && i + 1 < len; i++) {
        if (text[i] != '-') { continue; }
        *from = column_of(l, text, i);
        *to = column_of(l, text + i + 1, len - i - 1);
        if (*to == 0) { *from = 0; }
    }
    return *from > 0;
}

static int take_item(struct list *l, const char *item, size_t len)
{
    const struct kind *k = &kind[0];
    size_t key;
    int from, to;
    for (int i = 1; i < KINDS; i++) {
        if (strncmp(item, kind[i].key, strlen(kind[i].key)) == 0) { k = &kind[i]; }
    }
    key = strlen(k->key);
    if (!range_of(l, item + key, len - key, &from, &to)) {
        return refuse(l, item, len, "no such column: numbers from 1 and names of its header are");
    }
    if (from > to) { return refuse(l, item, len, "a range rises"); }
    for (int column = from; column <= to; column++) {
        unsigned char *use = &l->to->use[column - 1];
        const int n = l->taken[k->first]++;
        if (n >= k->columns) { return refuse(l, item, len, "too many columns for that"); }
        if (*use != RECORDING_NOTHING) { return refuse(l, item, len, "a column in use already"); }
        *use = (unsigned char)((int)k->first + n);
        if (column > l->to->last) { l->to->last = column; }
    }
    if (k->first == RECORDING_TIME) { l->to->time_s = k->time_s; }
    return k == &kind[0] || to - from + 1 == k->columns
               ? 0
               : refuse(l, item, len, "give its three columns as a range");
}

int recording_columns_read(struct recording_columns *c, const char *text,
    const struct recording_line *head, const char *path)
{
    struct list l = {c, head, path, {0}};
    memset(c, 0, sizeof *c);
    for (const char *item = text;; item++) {
        const size_t len = strcspn(item, ",");
        if (take_item(&l, item, len)) { return 2; }
        item += len;
        if (*item == '\0') { break; }
    }
    if (l.taken[RECORDING_SENSOR] != SENSORS) {
        cli_complain(
            "%s: columns: %s: %d sensors: give %d", path, text, l.taken[RECORDING_SENSOR], SENSORS);
        return 2;
    }
    return 0;
}
