/* SPDX-License-Identifier: MIT */
/* exhand run --modbus: every register of every scene, there and back by a libmodbus client, as
 * integer and as float. */
#define _XOPEN_SOURCE 700

#include "modbus_rig.h"

#ifdef EXH_MODBUS

#include "base/logfile.h"
#include "base/param.h"

#include <fcntl.h>
#include <math.h>

#define VALUES 4096

typedef int read_fn(modbus_t *c, int at, int n, uint16_t *to);

static void read_block(struct rig *r, read_fn *read, unsigned at, uint32_t values, int32_t *to)
{
    uint16_t word[124];
    for (uint32_t i = 0; i < values; i += 62) {
        const int n = values - i < 62 ? (int)(values - i) : 62;
        CHECK(read(r->c, (int)(at + 2 * i), 2 * n, word) == 2 * n, "%#x: %s", at,
            modbus_strerror(errno));
        for (int k = 0; k < n; k++) { to[i + (uint32_t)k] = rig_value(word, (unsigned)k); }
    }
    /* behind the last value nothing is */
    CHECK(
        read(r->c, (int)(at + 2 * values), 1, word) == -1 && errno == EMBXILADD, "%#x goes on", at);
    CHECK(read(r->c, (int)(at + 2 * values) - 1, 2, word) == -1 && errno == EMBXILADD,
        "%#x goes on", at);
}

/* The first row whose float is not the raw value in the row's unit, or NULL. A row that moves
 * between the two readings of its raw value is not judged. */
static const char *float_differs(const struct exh_signal_table *t, const int32_t *raw,
    const int32_t *as_float, const int32_t *raw_again)
{
    for (uint32_t i = 0; i < exh_signal_count(t); i++) {
        const struct exh_signal *row = exh_signal_at(t, i, NULL);
        if (raw[i] == raw_again[i] &&
            (uint32_t)as_float[i] != rig_float(cli_signal_value(row, raw[i]))) {
            return row->name;
        }
    }
    return NULL;
}

/* On a busy machine a noisy output may move and be back between the readings. A wrong float is
 * wrong each time. */
static void check_outputs(struct rig *r, const struct exh_signal_table *t)
{
    static int32_t raw[VALUES], as_float[VALUES], again[VALUES];
    const uint32_t n = exh_signal_count(t);
    const char *wrong = "";
    for (int tries = 0; wrong && tries < 20; tries++) {
        read_block(r, modbus_read_input_registers, RIG_OUT, n, raw);
        read_block(r, modbus_read_input_registers, RIG_OUT_F, n, as_float);
        read_block(r, modbus_read_input_registers, RIG_OUT, n, again);
        wrong = float_differs(t, raw, as_float, again);
    }
    CHECK(wrong == NULL, "%s", wrong);
}

static void check_head(struct rig *r, const struct exh_scene *sc, int32_t period)
{
    int32_t head[EXH_HEADS];
    char name[17] = "";
    read_block(r, modbus_read_input_registers, 0, EXH_HEADS, head);
    for (int i = 0; i < 16; i++) {
        name[i] = (char)(head[EXH_HEAD_NAME_0 + i / 4] >> (24 - 8 * (i % 4)) & 127);
    }
    CHECK_EQ_I64(head[EXH_HEAD_MAGIC], 0x45584831);
    CHECK_EQ_I64(head[EXH_HEAD_TEST_INT], 0x12345678);
    CHECK_EQ_I64(head[EXH_HEAD_TEST_FLOAT], (int32_t)rig_float(1));
    CHECK_EQ_I64(head[EXH_HEAD_SIGNALS], exh_signal_count(sc->signals));
    CHECK_EQ_I64(head[EXH_HEAD_PARAMS], exh_signal_count(sc->params->table));
    CHECK_EQ_I64((uint32_t)head[EXH_HEAD_SIGNALS_CRC], exh_signal_crc(sc->signals));
    CHECK_EQ_I64((uint32_t)head[EXH_HEAD_PARAMS_CRC], exh_signal_crc(sc->params->table));
    CHECK_EQ_I64(head[EXH_HEAD_PERIOD_NUM], 1);
    CHECK_EQ_I64(head[EXH_HEAD_PERIOD_DEN], period);
    CHECK_EQ_I64(head[EXH_HEAD_STATE], EXH_STATE_OFF);
    CHECK(head[EXH_HEAD_TICK] > 0, "it stands still");
    CHECK(strcmp(name, sc->name) == 0, "%s", name);
}

/* One parameter: its ends, beyond them, as float, by halves. */
static void write_one(struct rig *r, const struct exh_signal *row, unsigned i, int32_t now)
{
    const unsigned at = RIG_RAW + 2 * i, at_f = RIG_FLOAT + 2 * i;
    const int fixed = exh_signal_is_fixed(row);
    const int32_t end[2] = {row->min, row->max};
    uint16_t word[2];
    for (int e = 0; e < 2; e++) {
        CHECK(rig_write(r, at, (uint32_t)end[e]) == (fixed && end[e] != now ? EMBXILVAL : 0), "%s",
            row->name);
        if (fixed) { continue; }
        CHECK(modbus_read_registers(r->c, (int)at, 2, word) == 2, "%s", row->name);
        CHECK_EQ_I64(rig_value(word, 0), end[e]);
        CHECK(modbus_read_registers(r->c, (int)at_f, 2, word) == 2, "%s", row->name);
        CHECK((uint32_t)rig_value(word, 0) == rig_float(cli_signal_value(row, end[e])), "%s",
            row->name);
        CHECK(rig_write(r, at_f, rig_float(cli_signal_value(row, now))) == 0, "%s", row->name);
        CHECK(modbus_read_registers(r->c, (int)at, 2, word) == 2, "%s", row->name);
        CHECK(fabs(rig_value(word, 0) - (double)now) <= fabs((double)now) * ldexp(1, -24), "%s",
            row->name);
    }
    if (row->max < INT32_MAX) { CHECK_EQ_I64(rig_write(r, at, (uint32_t)row->max + 1), EMBXILVAL); }
    if (row->min > INT32_MIN) { CHECK_EQ_I64(rig_write(r, at, (uint32_t)row->min - 1), EMBXILVAL); }
    CHECK_EQ_I64(rig_write(r, at_f, 0x7FC00000u), EMBXILVAL); /* no number */
    CHECK_EQ_I64(rig_write(r, at_f, 0xFF800000u), EMBXILVAL); /* infinite */
    CHECK(modbus_write_register(r->c, (int)at_f, 0) == -1 && errno == EMBXILVAL, "half a float");
    CHECK_EQ_I64(rig_write(r, at, (uint32_t)now), 0); /* by function 6 its low half, as it is */
    CHECK(modbus_write_register(r->c, (int)at + 1, (uint16_t)((uint32_t)now & 0xFFFF)) == 1, "%s",
        row->name);
}

static void write_all(struct rig *r, const struct exh_signal_table *t, const int32_t *now)
{
    static int32_t held[VALUES];
    const uint32_t n = exh_signal_count(t);
    for (uint32_t i = 0; i < n; i++) { write_one(r, exh_signal_at(t, i, NULL), i, now[i]); }
    read_block(r, modbus_read_registers, RIG_RAW, n, held);
    for (uint32_t i = 0; i < n; i++) {
        CHECK(held[i] == now[i], "%s is not as it was", exh_signal_at(t, i, NULL)->name);
    }
    CHECK_EQ_I64(rig_input(r, RIG_HEAD(EXH_HEAD_STAGED)), 0);
}

/* The upper end, but of a material: all at their upper ends are outside the rule of gains, no wall
 * never is. */
static int32_t far_end(const struct exh_signal *row)
{
    return row->when == EXH_WHEN_MATERIAL ? row->min : row->max;
}

/* In one request what may change goes to an end; discarded; again, and applied. */
static void apply_all(struct rig *r, const struct exh_signal_table *t, const int32_t *was)
{
    static int32_t now[VALUES];
    const uint32_t n = exh_signal_count(t);
    const int32_t done = rig_input(r, RIG_HEAD(EXH_HEAD_DONE));
    for (int apply = 0; apply < 2; apply++) {
        for (uint32_t i = 0; i < n; i++) {
            const struct exh_signal *row = exh_signal_at(t, i, NULL);
            if (exh_signal_is_fixed(row)) { continue; }
            CHECK_EQ_I64(rig_write(r, RIG_RAW + 2 * i, (uint32_t)far_end(row)), 0);
        }
        CHECK_EQ_I64(rig_coil(r, apply ? EXH_COIL_APPLY : EXH_COIL_DISCARD), 0);
        CHECK(rig_wait(r, RIG_HEAD(EXH_HEAD_DONE), done + 1 + apply) == 0, "not done");
        CHECK_EQ_I64(rig_input(r, RIG_HEAD(EXH_HEAD_RESULT)), 0);
        read_block(r, modbus_read_registers, RIG_RAW, n, now);
        for (uint32_t i = 0; i < n; i++) {
            const struct exh_signal *row = exh_signal_at(t, i, NULL);
            const int changed = apply && !exh_signal_is_fixed(row);
            CHECK(now[i] == (changed ? far_end(row) : was[i]), "%s", row->name);
        }
    }
}

/* Parameters as the log says that they were, which knows no registers. */
static void check_against_log(const char *log, const int32_t *now, uint32_t n)
{
    struct logfile l;
    CHECK_EQ_I64(logfile_open(&l, log), 0);
    l.scene->defaults();
    CHECK_EQ_I64(exh_params_restore(l.scene->params, l.params, l.params_len, NULL), 0);
    CHECK_EQ_I64(exh_signal_count(l.scene->params->table), n);
    CHECK(memcmp(l.scene->params->staged, now, 4 * n) == 0, "other parameters than in the log");
    logfile_close(&l);
}

TEST(every_register_there_and_back)
{
    static const struct exh_scene *const scene[] = {
        &exh_scene_drop, &exh_scene_guarded, &exh_scene_bilateral};
    static int32_t par[VALUES], par_f[VALUES], held[VALUES];
    const char *wrong;
    rig_tables();
    for (size_t i = 0; i < sizeof scene / sizeof scene[0]; i++) {
        const struct exh_scene *sc = scene[i];
        const uint32_t pars = exh_signal_count(sc->params->table);
        char log[64] = "/tmp/exhand-modbus-XXXXXX";
        uint8_t bit[192];
        struct rig r;
        close(mkstemp(log));
        /* let go as soon as it was gripped: it stays OFF, and values are constant */
        rig_start(&r, WORDS("run", "--scene", sc->name, "--pace", "--rate", "500", "--let-go",
                          "0.001", "--log", log, "--modbus", "tcp:127.0.0.1:0", "--modbus-write"));
        rig_sleep(0.2);
        check_head(&r, sc, 500);
        check_outputs(&r, sc->signals);
        read_block(&r, modbus_read_input_registers, RIG_RAW, pars, par);
        read_block(&r, modbus_read_input_registers, RIG_FLOAT, pars, par_f);
        read_block(&r, modbus_read_registers, RIG_RAW, pars, held);
        CHECK(memcmp(par, held, 4 * pars) == 0, "something is staged");
        wrong = float_differs(sc->params->table, par, par_f, held);
        CHECK(wrong == NULL, "%s", wrong);
        read_block(&r, modbus_read_registers, RIG_FLOAT, pars, held);
        CHECK(memcmp(par_f, held, 4 * pars) == 0, "something is staged");
        CHECK_EQ_I64(modbus_read_bits(r.c, 0, EXH_COILS, bit), EXH_COILS);
        CHECK_EQ_I64(modbus_read_input_bits(r.c, 0, 192, bit), 192);
        CHECK(bit[96 + EXH_STATE_OFF] == 1 && bit[64] == 1 && bit[65] == 0, "state or contacts");
        write_all(&r, sc->params->table, par);
        apply_all(&r, sc->params->table, par);
        rig_end(&r, 130);
        check_against_log(log, par, pars);
        (void)remove(log);
        said_clean(r.dir);
    }
}

TEST_MAIN("modbus_registers", every_register_there_and_back);
#else
RIG_NONE("modbus_registers");
#endif
