/* SPDX-License-Identifier: MIT */
/* Signals: one descriptor for every input, output and parameter.
 *
 * A module defines the rows of its parameter struct. All fields of that struct are int32_t, in the
 * order of the rows. A scene lists the rows of its modules, in the order of the scene's struct.
 * CSV headers, command-line options, --help, the parameter image and tables in docs/ come from it.
 *
 *   uint16_t finger;
 *   int32_t i = exh_signal_find(table, EXH_CONTACT_K_ID, EXH_INDEX);
 *   const struct exh_signal *row = exh_signal_at(table, (uint32_t)i, &finger); */
#ifndef EXHAND_SIGNAL_H
#define EXHAND_SIGNAL_H

#include "exhand/bytes.h"
#include "exhand/units.h"

#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

/* When a value may change, and in which direction it may add force. authority.h says who may change
 * it. */
enum exh_signal_when {
    EXH_WHEN_OUTPUT, /* not a parameter: read only */
    EXH_WHEN_SETUP,  /* before the loop starts; refused once locked */
    EXH_WHEN_ANY,    /* between any two ticks, in one step */
    EXH_WHEN_SLEWED, /* between any two ticks, but gradually: the value affects the force */
    EXH_WHEN_LIMIT,  /* a limit of force: rises gradually, falls in one step */
    EXH_WHEN_PERSON, /* before the loop starts, and only by the person at the box: by command line
                      * or boot option. No register, packet or image may set it */
    EXH_WHEN_BOUND,  /* in one step; a larger value may mean more force */
    EXH_WHEN_WALL,   /* gradually; a smaller value means more force */
    EXH_WHEN_REST,   /* in one step; of the place or time of contact: neither direction is safer */
    EXH_WHEN_MATERIAL, /* as BOUND, but of the virtual world; takes effect at the next freeze */
    EXH_WHEN_WORD,     /* any time, only by the person: permission for a motion to begin */
    EXH_WHENS          /* number of entries */
};

/* The register of ids, 0xMMNN: MM is the module, NN the row. test/module/unit/rows_test.c has them
 * all.
 *
 *   02 quad   03 velocity   04 contact   05 drive     06 safety       07 filter     08 quantizer
 *   09 glove  0A hand       0B material  0C precontact
 *   0D tracking (rows 01..10), supply (rows 11..)     0E motion       0F passivity
 *   12 gains  13 tune       14 chatter   80..8F scenes; 89 calibrations of the runtime
 *   (exhand/run) */

/* One row: the description of one value. Constant, in ROM. */
struct exh_signal {
    uint16_t id;      /* permanent, unique in the library */
    uint8_t frac;     /* fraction bits: value = raw * 2^-frac */
    uint8_t when;     /* enum exh_signal_when */
    int32_t min, max; /* allowed raw values, both included */
    int32_t dflt;     /* raw value after exh_params_setup */
    const char *name; /* "k", [a-z0-9_]+, unique in a scene */
    const char *unit; /* SI in ASCII as in CSV headers: "n_per_m"; "" for none */
    const char *help; /* description, one line */
};

/* 1 if the value can change only before the loop starts. */
static inline int exh_signal_is_fixed(const struct exh_signal *row)
{
    return row->when == EXH_WHEN_SETUP || row->when == EXH_WHEN_PERSON;
}

/* 1 if the value changes gradually while the loop runs. */
static inline int exh_signal_is_slewed(const struct exh_signal *row)
{
    return row->when == EXH_WHEN_SLEWED || row->when == EXH_WHEN_LIMIT ||
           row->when == EXH_WHEN_WALL;
}

/* The rows of one module, repeated once per instance (finger). */
struct exh_signal_group {
    const struct exh_signal *row; /* array of length rows, in the order of the struct's fields */
    uint16_t rows;                /* number of rows */
    uint16_t instances;           /* >= 1; the value array holds all rows of instance 0 first */
};

/* The values of a scene: the groups in order, one int32_t per row and instance. */
struct exh_signal_table {
    const struct exh_signal_group *group; /* array of length groups */
    uint16_t groups;                      /* number of groups */
};

/* The number of values that the table describes. */
uint32_t exh_signal_count(const struct exh_signal_table *t);

/* The row of value i. Stores the instance in *instance unless it is NULL. NULL: no such i. */
const struct exh_signal *exh_signal_at(
    const struct exh_signal_table *t, uint32_t i, uint16_t *instance);

/* The index of the value with this id and instance, or -EXH_E_UNKNOWN. */
int32_t exh_signal_find(const struct exh_signal_table *t, uint16_t id, uint16_t instance);

/* CRC-32 over ids, formats, ranges and counts. Tables with the same CRC have the same meaning. */
uint32_t exh_signal_crc(const struct exh_signal_table *t);

/* 1 if each of n values lies within its row. The values form a struct of int32_t, as module
 * parameters do. Use it for unchecked parameters, such as constants in ROM. */
int exh_rows_validate(const struct exh_signal *row, unsigned n, const void *values);

#ifdef __cplusplus
}
#endif
#endif
