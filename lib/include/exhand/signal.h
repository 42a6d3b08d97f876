/* Signals: one descriptor for every input, output and parameter.
 *
 * Each module defines the rows of its own parameter struct (all fields int32_t,
 * in the order of the rows); a scene lists the rows of the modules it links, in
 * the order of its own struct. Everything that shows or takes a value is made
 * from this table: CSV headers, command-line options, --help, the parameter
 * image, the tables in docs/.
 *
 * Parameters are changed in one way only: stage (checked against range and time),
 * then apply, which the loop calls between two ticks.
 */
#ifndef EXHAND_SIGNAL_H
#define EXHAND_SIGNAL_H

#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

enum exh_signal_when {
    EXH_WHEN_OUTPUT, /* not a parameter: read only                            */
    EXH_WHEN_SETUP,  /* before the loop starts; refused once locked           */
    EXH_WHEN_ANY     /* between any two ticks                                 */
};

struct exh_signal {
    uint16_t id;      /* stable for ever, unique in the library; 0xMMNN: module, row */
    uint8_t frac;     /* fraction bits: value = raw * 2^-frac                  */
    uint8_t when;     /* enum exh_signal_when                                  */
    int32_t min, max; /* allowed raw values, both included                     */
    int32_t dflt;     /* raw value after exh_params_init                       */
    const char *name; /* "k", [a-z0-9_]+, unique in a scene                    */
    const char *unit; /* SI in ASCII as in CSV headers: "n_per_m"; "" for none */
    const char *help; /* one line                                              */
};

/* The rows of one module, once per instance (per finger). */
struct exh_signal_group {
    const struct exh_signal *row;
    uint16_t rows;
    uint16_t instances; /* >= 1; instance-major in the value array            */
};

/* A scene's values: the groups in order, one int32_t a row and instance. */
struct exh_signal_table {
    const struct exh_signal_group *group;
    uint16_t groups;
};

/* How many values the table describes. */
uint32_t exh_signal_count(const struct exh_signal_table *t);

/* The row of value index i and its instance (NULL: not wanted); NULL if i is
 * not below exh_signal_count(). */
const struct exh_signal *exh_signal_at(const struct exh_signal_table *t, uint32_t i,
                                       uint16_t *instance);

/* Index of the value with this id and instance, or -EXH_E_UNKNOWN. */
int32_t exh_signal_find(const struct exh_signal_table *t, uint16_t id, uint16_t instance);

/* CRC-32 over ids, formats, ranges and counts: two tables that agree on it
 * give the same meaning to the same value array. */
uint32_t exh_signal_crc(const struct exh_signal_table *t);

/* A scene's parameters. The caller owns both arrays, exh_signal_count() long;
 * the active one is the scene's parameter struct. */
struct exh_params {
    const struct exh_signal_table *table;
    int32_t *active;
    int32_t *staged;
    uint8_t locked;  /* set-up values are refused from now on                 */
    uint8_t pending; /* something is staged and not yet applied               */
};

#define EXH_PARAMS_VERSION 1

/* Defaults into both arrays, unlocked. */
void exh_params_init(struct exh_params *p, const struct exh_signal_table *table,
                     int32_t *active, int32_t *staged);

/* Stages one raw value. -EXH_E_UNKNOWN, -EXH_E_RANGE (outside min..max), or
 * -EXH_E_STATE (an output; another set-up value while locked, the same is
 * accepted); nothing is staged then. */
int exh_params_stage(struct exh_params *p, uint16_t id, uint16_t instance, int32_t raw);

/* The same by index of the value, for whoever walks the table; and whether it would be staged. */
int exh_params_stage_at(struct exh_params *p, uint32_t i, int32_t raw);
int exh_params_may(const struct exh_params *p, uint32_t i, int32_t raw);

/* Copies what is staged; call between ticks only. 1 if anything was pending. */
int exh_params_apply(struct exh_params *p);

/* Image: "EXHP", version u16, count u16, table CRC u32, values i32…, CRC u32,
 * little-endian. Saves the active values. Bytes written, or -EXH_E_SHORT. */
int32_t exh_params_save(const struct exh_params *p, void *buf, size_t cap_B);

/* Stages a whole image or nothing. -EXH_E_SHORT, -EXH_E_VERSION (other version or
 * table), -EXH_E_CRC, -EXH_E_RANGE or -EXH_E_STATE; for the last two *bad (may be
 * NULL) is the index of the offending value. */
int exh_params_load(struct exh_params *p, const void *buf, size_t len_B, uint32_t *bad);

#ifdef __cplusplus
}
#endif
#endif
