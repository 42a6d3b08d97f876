/* SPDX-License-Identifier: MIT */
/* Signals: one descriptor for every input, output and parameter.
 *
 * Each module defines the rows of its own parameter struct (all fields int32_t,
 * in the order of the rows); a scene lists the rows of the modules it links, in
 * the order of its own struct. Everything that shows or takes a value is made
 * from this table: CSV headers, command-line options, --help, the parameter
 * image, the tables in docs/.
 */
#ifndef EXHAND_SIGNAL_H
#define EXHAND_SIGNAL_H

#include "exhand/bytes.h"
#include "exhand/units.h"

#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

/* When a value may be changed. */
enum exh_signal_when {
    EXH_WHEN_OUTPUT, /* not a parameter: read only */
    EXH_WHEN_SETUP,  /* before the loop starts; refused once locked */
    EXH_WHEN_ANY,    /* between any two ticks, at once */
    EXH_WHEN_SLEWED, /* likewise, but little by little: force hangs on it */
    EXH_WHEN_LIMIT,  /* likewise, a limit of force: it rises little by little and falls at once */
    EXH_WHEN_PERSON, /* before the loop starts, by the person at the box alone: by the command line
                      * or a boot option; by no register, packet or image */
    EXH_WHEN_BOUND,  /* at once: more of it may be more force */
    EXH_WHEN_WALL,   /* little by little: less of it is more force */
    EXH_WHEN_REST,   /* at once: where or when a contact is, so neither way is the safe one */
    EXH_WHEN_MATERIAL, /* as BOUND, and the world's: it acts at the next freeze */
    EXH_WHEN_WORD,     /* at any time, by the person alone: his word that a motion may begin */
    EXH_WHENS          /* how many there are; who may change which: authority.h */
};

/* Register of ids, 0xMMNN: MM is the module, NN the row. test/module/unit/rows_test.c has each.
 *
 *   02 quad   03 velocity   04 contact   05 drive     06 safety       07 filter     08 quantizer
 *   09 glove  0A hand       0B material  0C precontact
 *   0D tracking (rows 01..10), supply (rows 11..)     0E motion       0F passivity
 *   12 gains  13 tune       14 chatter   80..8F scenes; 89 calibrations of the runtime
 *   (exhand/run)
 */

/* One row: what a value is. Constant, in ROM. */
struct exh_signal {
    uint16_t id;      /* stable for ever, unique in the library */
    uint8_t frac;     /* fraction bits: value = raw * 2^-frac */
    uint8_t when;     /* enum exh_signal_when */
    int32_t min, max; /* allowed raw values, both included */
    int32_t dflt;     /* raw value after exh_params_setup */
    const char *name; /* "k", [a-z0-9_]+, unique in a scene */
    const char *unit; /* SI in ASCII as in CSV headers: "n_per_m"; "" for none */
    const char *help; /* one line */
};

/* 1: another value is taken only before the loop starts. */
static inline int exh_signal_is_fixed(const struct exh_signal *row)
{
    return row->when == EXH_WHEN_SETUP || row->when == EXH_WHEN_PERSON;
}

/* 1: while the loop runs it goes little by little to another value. */
static inline int exh_signal_is_slewed(const struct exh_signal *row)
{
    return row->when == EXH_WHEN_SLEWED || row->when == EXH_WHEN_LIMIT ||
           row->when == EXH_WHEN_WALL;
}

/* The rows of one module, once per instance (per finger). */
struct exh_signal_group {
    const struct exh_signal *row; /* rows of them, in the order of the struct's fields */
    uint16_t rows;                /* how many */
    uint16_t instances;           /* >= 1; instance-major in the value array */
};

/* A scene's values: the groups in order, one int32_t a row and instance. */
struct exh_signal_table {
    const struct exh_signal_group *group; /* groups of them */
    uint16_t groups;                      /* how many */
};

/* How many values the table describes. */
uint32_t exh_signal_count(const struct exh_signal_table *t);

/* The row of value index i and its instance (NULL: not wanted); NULL if i is
 * not below exh_signal_count(). */
const struct exh_signal *exh_signal_at(
    const struct exh_signal_table *t, uint32_t i, uint16_t *instance);

/* Index of the value with this id and instance, or -EXH_E_UNKNOWN. */
int32_t exh_signal_find(const struct exh_signal_table *t, uint16_t id, uint16_t instance);

/* CRC-32 over ids, formats, ranges and counts: two tables that agree on it
 * give the same meaning to the same value array. */
uint32_t exh_signal_crc(const struct exh_signal_table *t);

/* 1 if n values in a row, a struct of int32_t as a module's parameters are, are each within their
 * row: for parameters that have passed no other check, as those in ROM. */
int exh_rows_validate(const struct exh_signal *row, unsigned n, const void *values);

#ifdef __cplusplus
}
#endif
#endif
