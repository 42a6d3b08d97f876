/* exhand run --modbus: every register there and back by a libmodbus client, the standard exceptions,
 * no torn reads, and the same bits of force whoever reads. */
#define _XOPEN_SOURCE 700

#ifndef EXH_MODBUS
#include "said.h"

TEST(without_the_package_it_says_so)
{
    char *dir = said_dir();
    struct said s;
    said(&s, dir, cli_run, WORDS("run", "--modbus", "tcp:127.0.0.1:0"));
    CHECK_EQ_I64(s.status, 3);
    CHECK(strstr(s.err, "install libmodbus-dev") != NULL, "%s", s.err);
    check_note("libmodbus is not here: nothing else was tested");
    said_clean(dir);
}

TEST_MAIN("modbus", without_the_package_it_says_so);
#else

#include "modbus_rig.h"

#include "cli/logfile.h"
#include "cli/param.h"

#include "bilateral/bilateral.h"
#include "guarded/guarded.h"

#include "exhand/error.h"

#include <dirent.h>
#include <fcntl.h>
#include <math.h>
#include <sys/socket.h>

#define RAW     0x5000u
#define FLOAT   0x7000u
#define OUT     0x1000u
#define OUT_F   0x3000u
#define VALUES  4096
#define HEAD(h) (2 * (unsigned)(h))

static uint32_t float_bits(double v)
{
    const float f = (float)v;
    uint32_t bits;
    memcpy(&bits, &f, sizeof bits);
    return bits;
}

/* --- every register --- */

/* Tables are there when a scene has had its defaults. */
static void prepare(void)
{
    exh_scene_drop.defaults();
    exh_scene_guarded.defaults();
    exh_scene_bilateral.defaults();
}

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
    CHECK(read(r->c, (int)(at + 2 * values), 1, word) == -1 && errno == EMBXILADD, "%#x goes on",
          at);
    CHECK(read(r->c, (int)(at + 2 * values) - 1, 2, word) == -1 && errno == EMBXILADD,
          "%#x goes on", at);
}

/* The float block is the raw one in the row's unit. */
static void check_floats(const struct exh_signal_table *t, const int32_t *raw,
                         const int32_t *as_float, const int32_t *raw_again)
{
    for (uint32_t i = 0; i < exh_signal_count(t); i++) {
        const struct exh_signal *row = exh_signal_at(t, i, NULL);
        if (raw[i] != raw_again[i]) { continue; } /* it has moved in between */
        CHECK((uint32_t)as_float[i] == float_bits(cli_signal_value(row, raw[i])), "%s", row->name);
    }
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
    CHECK_EQ_I64(head[EXH_HEAD_TEST_FLOAT], (int32_t)float_bits(1));
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
    const unsigned at = RAW + 2 * i, at_f = FLOAT + 2 * i;
    const int fixed = row->when == EXH_WHEN_SETUP;
    const int32_t end[2] = {row->min, row->max};
    uint16_t word[2];
    for (int e = 0; e < 2; e++) {
        CHECK(rig_write(r, at, (uint32_t)end[e]) == (fixed && end[e] != now ? EMBXILVAL : 0), "%s",
              row->name);
        if (fixed) { continue; }
        CHECK(modbus_read_registers(r->c, (int)at, 2, word) == 2, "%s", row->name);
        CHECK_EQ_I64(rig_value(word, 0), end[e]);
        CHECK(modbus_read_registers(r->c, (int)at_f, 2, word) == 2, "%s", row->name);
        CHECK((uint32_t)rig_value(word, 0) == float_bits(cli_signal_value(row, end[e])), "%s",
              row->name);
        CHECK(rig_write(r, at_f, float_bits(cli_signal_value(row, now))) == 0, "%s", row->name);
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
    read_block(r, modbus_read_registers, RAW, n, held);
    for (uint32_t i = 0; i < n; i++) {
        CHECK(held[i] == now[i], "%s is not as it was", exh_signal_at(t, i, NULL)->name);
    }
    CHECK_EQ_I64(rig_input(r, HEAD(EXH_HEAD_STAGED)), 0);
}

/* In one request what may change goes to its lower end; discarded; again, and applied. */
static void apply_all(struct rig *r, const struct exh_signal_table *t, const int32_t *was)
{
    static int32_t now[VALUES];
    const uint32_t n = exh_signal_count(t);
    const int32_t done = rig_input(r, HEAD(EXH_HEAD_DONE));
    for (int apply = 0; apply < 2; apply++) {
        for (uint32_t i = 0; i < n; i++) {
            const struct exh_signal *row = exh_signal_at(t, i, NULL);
            if (row->when == EXH_WHEN_SETUP) { continue; }
            CHECK_EQ_I64(rig_write(r, RAW + 2 * i, (uint32_t)row->max), 0);
        }
        CHECK_EQ_I64(rig_coil(r, apply ? EXH_COIL_APPLY : EXH_COIL_DISCARD), 0);
        CHECK(rig_wait(r, HEAD(EXH_HEAD_DONE), done + 1 + apply) == 0, "not done");
        CHECK_EQ_I64(rig_input(r, HEAD(EXH_HEAD_RESULT)), 0);
        read_block(r, modbus_read_registers, RAW, n, now);
        for (uint32_t i = 0; i < n; i++) {
            const struct exh_signal *row = exh_signal_at(t, i, NULL);
            const int changed = apply && row->when != EXH_WHEN_SETUP;
            CHECK(now[i] == (changed ? row->max : was[i]), "%s", row->name);
        }
    }
}

/* Parameters as the log says that they were, which knows no registers. */
static void check_against_log(const char *log, const int32_t *now, uint32_t n)
{
    struct logfile l;
    CHECK_EQ_I64(logfile_open(&l, log), 0);
    l.scene->defaults();
    CHECK_EQ_I64(exh_params_load(l.scene->params, l.params, l.params_len, NULL), 0);
    CHECK_EQ_I64(exh_signal_count(l.scene->params->table), n);
    CHECK(memcmp(l.scene->params->staged, now, 4 * n) == 0, "other parameters than in the log");
    logfile_close(&l);
}

TEST(every_register_there_and_back)
{
    static const struct exh_scene *const scene[] = {&exh_scene_drop, &exh_scene_guarded,
                                                    &exh_scene_bilateral};
    static int32_t out[VALUES], out_f[VALUES], again[VALUES], par[VALUES], par_f[VALUES],
        held[VALUES];
    prepare();
    for (size_t i = 0; i < sizeof scene / sizeof scene[0]; i++) {
        const struct exh_scene *sc = scene[i];
        const uint32_t outs = exh_signal_count(sc->signals),
                       pars = exh_signal_count(sc->params->table);
        char log[64] = "/tmp/exhand-modbus-XXXXXX";
        uint8_t bit[192];
        struct rig r;
        close(mkstemp(log));
        /* let go as soon as it was gripped: it stays OFF, and values stand */
        rig_start(&r, WORDS("run", "--scene", sc->name, "--pace", "--rate", "500", "--let-go",
                            "0.001", "--log", log, "--modbus", "tcp:127.0.0.1:0"));
        rig_sleep(0.2);
        check_head(&r, sc, 500);
        read_block(&r, modbus_read_input_registers, OUT, outs, out);
        read_block(&r, modbus_read_input_registers, OUT_F, outs, out_f);
        read_block(&r, modbus_read_input_registers, OUT, outs, again);
        check_floats(sc->signals, out, out_f, again);
        read_block(&r, modbus_read_input_registers, RAW, pars, par);
        read_block(&r, modbus_read_input_registers, FLOAT, pars, par_f);
        read_block(&r, modbus_read_registers, RAW, pars, held);
        CHECK(memcmp(par, held, 4 * pars) == 0, "something is staged");
        check_floats(sc->params->table, par, par_f, held);
        read_block(&r, modbus_read_registers, FLOAT, pars, held);
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

/* --- exceptions --- */

/* The exception that this request gets; 0: none. */
static int exception_of(struct rig *r, const uint8_t *pdu, int len)
{
    uint8_t raw[MODBUS_MAX_ADU_LENGTH] = {1}, answer[MODBUS_MAX_ADU_LENGTH];
    memcpy(raw + 1, pdu, (size_t)len);
    CHECK(modbus_send_raw_request(r->c, raw, len + 1) > 0, "not sent");
    return modbus_receive_confirmation(r->c, answer) >= 9 && answer[7] == (pdu[0] | 0x80)
               ? answer[8]
               : 0;
}

TEST(bad_requests_get_the_standard_exceptions)
{
    static const struct {
        uint8_t pdu[12];
        int len, exception;
    } row[] = {
        {{7}, 1, 1}, /* functions that are not here */
        {{8, 0, 0, 0, 0}, 5, 1},
        {{17}, 1, 1},
        {{20, 7, 6, 0, 4, 0, 1, 0, 2}, 9, 1},
        {{100, 1, 2, 3}, 4, 1},
        {{1, 0, 6, 0, 1}, 5, 2}, /* addresses that are not */
        {{1, 0, 0, 0, 7}, 5, 2},
        {{2, 0, 192, 0, 1}, 5, 2},
        {{3, 0, 0, 0, 1}, 5, 2},
        {{3, 0x10, 0, 0, 1}, 5, 2},
        {{4, 0x0F, 0xFF, 0, 2}, 5, 2},
        {{4, 0x04, 0x30, 0, 1}, 5, 2},
        {{4, 0xFF, 0xFF, 0, 2}, 5, 2},
        {{5, 0, 6, 0xFF, 0}, 5, 2},
        {{6, 0x10, 0, 0, 0}, 5, 2},
        {{22, 0, 0, 0, 0, 0, 0}, 7, 2},
        {{1, 0, 0, 0, 0}, 5, 3}, /* counts and values */
        {{3, 0x50, 0, 0, 126}, 5, 3},
        {{4, 0, 0, 0xFF, 0xFF}, 5, 3},
        {{5, 0, 0, 0x12, 0x34}, 5, 3},
        {{16, 0x50, 0, 0, 1, 4, 0, 0, 0, 0}, 10, 3},
        {{5, 0, 2, 0xFF, 0}, 5, 3}, /* SAVE: no place */
        {{5, 0, 4, 0xFF, 0}, 5, 3}, /* RUN: not allowed */
        {{5, 0, 5, 0xFF, 0}, 5, 3},
        {{15, 0, 0, 0, 2, 1, 3}, 7, 3}, /* APPLY with DISCARD */
        {{3, 0x50, 0}, 3, 3}, /* cut short; and longer than it says */
        {{3, 0x50, 0, 0, 1, 0}, 6, 3},
        {{4, 0, 0, 0, 2}, 5, 0}, /* and behind all these a good one */
    };
    struct rig r;
    rig_start(&r, WORDS("run", "--pace", "--modbus", "tcp:127.0.0.1:0"));
    for (size_t i = 0; i < sizeof row / sizeof row[0]; i++) {
        const int got = exception_of(&r, row[i].pdu, row[i].len);
        CHECK(got == row[i].exception, "row %zu, function %u: %d", i, row[i].pdu[0], got);
    }
    rig_end(&r, 130);
    said_clean(r.dir);
}

/* --- reads while it runs --- */

#define SIGNALS 62 /* of bilateral: what one request can have */

/* Reads as fast as it goes, until it is killed. */
static pid_t hammer(int port)
{
    const pid_t pid = fork();
    uint16_t word[2 * SIGNALS];
    modbus_t *c;
    if (pid != 0) { return pid; }
    c = modbus_new_tcp("127.0.0.1", port);
    if (modbus_connect(c) != 0) { _exit(1); }
    while (modbus_read_input_registers(c, (int)OUT, 2 * SIGNALS, word) > 0 &&
           modbus_read_input_registers(c, (int)RAW, 40, word) > 0) {}
    _exit(0);
}

static void stop_hammer(pid_t pid)
{
    kill(pid, SIGKILL);
    waitpid(pid, NULL, 0);
}

static long reads_asked(void)
{
    const char *text = getenv("EXH_READS");
    return text ? atol(text) : 10000;
}

struct seen {
    uint32_t first, last; /* tick of the head before and after */
    int32_t value[SIGNALS];
};

/* The signals of each tick, from its frame in the log. */
static int32_t (*frames_of(const char *log, uint32_t *n))[SIGNALS]
{
    int32_t(*frame)[SIGNALS] = NULL;
    struct exh_record rec;
    struct logfile l;
    size_t cap = 0, behind_B;
    *n = 0;
    CHECK_EQ_I64(logfile_open(&l, log), 0);
    behind_B = 4 * exh_signal_count(l.scene->signals);
    CHECK(behind_B >= 4 * SIGNALS, "not bilateral's");
    while (logfile_next(&l, &rec)) {
        if (rec.type != EXH_RECORD_FRAME) { continue; }
        if (*n == cap) {
            cap = cap ? 2 * cap : 65536;
            frame = realloc(frame, cap * sizeof *frame);
            CHECK(frame != NULL, "out of memory");
        }
        for (unsigned i = 0; i < SIGNALS; i++) { /* last in a frame, little-endian */
            const uint8_t *p = rec.payload + rec.len_B - behind_B + 4 * i;
            frame[*n][i] = (int32_t)((uint32_t)p[0] | (uint32_t)p[1] << 8 | (uint32_t)p[2] << 16 |
                                     (uint32_t)p[3] << 24);
        }
        ++*n;
    }
    logfile_close(&l);
    return frame;
}

/* What was read is what one tick had: one between the heads read before and behind it. The copy
 * counts ticks from 1, as the box does after its first. */
static long torn_of(const struct seen *s, long n, int32_t (*frame)[SIGNALS], uint32_t frames,
                    long *moved)
{
    long torn = 0;
    for (long i = 0; i < n; i++) {
        int found = 0;
        uint32_t from = s[i].first > 2 ? s[i].first - 2 : 0;
        for (uint32_t t = from; !found && t <= s[i].last + 1 && t < frames; t++) {
            found = memcmp(frame[t], s[i].value, sizeof frame[t]) == 0;
        }
        torn += !found;
        *moved += i > 0 && memcmp(s[i].value, s[i - 1].value, sizeof s[i].value) != 0;
    }
    return torn;
}

TEST(no_read_is_torn)
{
    const long n = reads_asked();
    char log[64] = "/tmp/exhand-modbus-XXXXXX";
    struct seen *seen = calloc((size_t)n, sizeof *seen);
    int32_t(*frame)[SIGNALS];
    uint32_t frames;
    long torn, moved = 0;
    pid_t other[2];
    struct rig r;
    close(mkstemp(log));
    rig_start(&r,
              WORDS("run", "--scene", "bilateral", "--fingers", "all", "--pace", "--rate",
                    n > 100000 ? "2000" : "10000", "--log", log, "--modbus", "tcp:127.0.0.1:0"));
    while (rig_input(&r, HEAD(EXH_HEAD_TICK)) == 0) {
    } /* before the first tick there is no tick to show */
    for (int i = 0; i < 2; i++) { other[i] = hammer(r.port); }
    for (long i = 0; i < n; i++) {
        uint16_t word[2 * SIGNALS];
        seen[i].first = i ? seen[i - 1].last : (uint32_t)rig_input(&r, HEAD(EXH_HEAD_TICK));
        CHECK(modbus_read_input_registers(r.c, (int)OUT, 2 * SIGNALS, word) == 2 * SIGNALS,
              "read %ld", i);
        for (unsigned k = 0; k < SIGNALS; k++) { seen[i].value[k] = rig_value(word, k); }
        seen[i].last = (uint32_t)rig_input(&r, HEAD(EXH_HEAD_TICK));
    }
    for (int i = 0; i < 2; i++) { stop_hammer(other[i]); }
    rig_end(&r, 130);
    frame = frames_of(log, &frames);
    torn = torn_of(seen, n, frame, frames, &moved);
    CHECK(torn == 0, "%ld of %ld reads are no tick's", torn, n);
    CHECK(moved > n / 100, "only %ld reads differ from the one before", moved);
    check_note("%ld reads of %d values over %lu ticks, %ld other than the one before, none torn", n,
               SIGNALS, (unsigned long)frames, moved);
    free(frame);
    free(seen);
    (void)remove(log);
    said_clean(r.dir);
}

static int same_bytes(const char *a, const char *b)
{
    FILE *f = fopen(a, "rb"), *g = fopen(b, "rb");
    int x = 0, y = 0;
    CHECK(f != NULL && g != NULL, "no log");
    while (x != EOF && x == y) {
        x = getc(f);
        y = getc(g);
    }
    fclose(f);
    fclose(g);
    return x == y;
}

/* In virtual time the whole log, force and all, has the same bytes. */
TEST(whoever_reads_the_box_does_the_same)
{
    char *dir = said_dir();
    char a[512], b[512];
    struct said s;
    struct rig r;
    pid_t other[2];
    int32_t reads = 0;
    snprintf(a, sizeof a, "%s/a.exh", dir);
    snprintf(b, sizeof b, "%s/b.exh", dir);
    said(&s, dir, cli_run, WORDS("run", "--seconds", "150", "--log", a));
    CHECK_EQ_I64(s.status, 0);
    rig_start(&r, WORDS("run", "--seconds", "150", "--log", b, "--modbus", "tcp:127.0.0.1:0"));
    for (int i = 0; i < 2; i++) { other[i] = hammer(r.port); }
    for (uint16_t word[60]; modbus_read_input_registers(r.c, 0, 60, word) == 60;) { reads++; }
    for (int i = 0; i < 2; i++) { stop_hammer(other[i]); }
    rig_end(&r, 0);
    CHECK(reads > 100, "%d reads", reads);
    CHECK(same_bytes(a, b), "another log");
    check_note("300000 ticks, with %d reads of one of three clients: the same %ld bytes of log",
               reads, said_size(a));
    said_clean(r.dir);
    said_clean(dir);
}

/* --- writes --- */

static int times(const char *text, const char *part)
{
    int n = 0;
    for (const char *at = strstr(text, part); at; at = strstr(at + 1, part)) { n++; }
    return n;
}

/* What clients changed is in the log, and the log replays. */
TEST(a_run_with_a_writing_client_replays)
{
    char *dir = said_dir();
    const char *log = said_path(dir, "a.exh");
    struct said s;
    struct rig r;
    prepare();
    rig_start(&r, WORDS("run", "--scene", "bilateral", "--pace", "--log", log, "--modbus",
                        "tcp:127.0.0.1:0"));
    for (int i = 0; i < 60; i++) {
        const int32_t done = rig_input(&r, HEAD(EXH_HEAD_DONE));
        uint32_t k;
        CHECK(cli_signal_find(exh_scene_bilateral.params->table, "mat_k", &k) != NULL, "no mat_k");
        CHECK_EQ_I64(rig_write(&r, FLOAT + 2 * k, float_bits(5000 + 100 * i)), 0);
        CHECK_EQ_I64(rig_coil(&r, EXH_COIL_APPLY), 0);
        CHECK(rig_wait(&r, HEAD(EXH_HEAD_DONE), done + 1) == 0, "not applied");
    }
    CHECK_EQ_I64(rig_coil(&r, EXH_COIL_OFF), 0);
    CHECK(rig_wait(&r, HEAD(EXH_HEAD_STATE), EXH_STATE_OFF) == 0, "not off");
    rig_end(&r, 130);
    said(&s, dir, cli_replay, WORDS("replay", log));
    CHECK(s.status == 0, "%s", s.err);
    said(&s, dir, cli_replay, WORDS("replay", log, "--timeline"));
    CHECK(times(s.out, "mat_k") >= 60, "%d changes of mat_k", times(s.out, "mat_k"));
    CHECK(times(s.out, "command: off") == 1, "no OFF");
    said_clean(r.dir);
    said_clean(dir);
}

/* The other half of SAVE: a box that starts where the last one was left. */
TEST(saved_parameters_come_back)
{
    char *dir = said_dir();
    const char *image = said_path(dir, "p.img");
    uint32_t k;
    struct rig r;
    prepare();
    CHECK(cli_signal_find(exh_scene_drop.params->table, "k", &k) != NULL, "no k");
    rig_start(&r, WORDS("run", "--pace", "--save", image, "--modbus", "tcp:127.0.0.1:0"));
    CHECK_EQ_I64(rig_write(&r, FLOAT + 2 * k, float_bits(4321.5)), 0);
    CHECK_EQ_I64(rig_coil(&r, EXH_COIL_APPLY), 0);
    CHECK(rig_wait(&r, HEAD(EXH_HEAD_DONE), 1) == 0, "not applied");
    CHECK_EQ_I64(rig_coil(&r, EXH_COIL_SAVE), 0);
    CHECK(rig_wait(&r, HEAD(EXH_HEAD_DONE), 2) == 0, "not saved");
    CHECK_EQ_I64(rig_input(&r, HEAD(EXH_HEAD_RESULT)), 0);
    rig_end(&r, 130);
    said_clean(r.dir);
    rig_start(&r, WORDS("run", "--pace", "--load-params", image, "--modbus", "tcp:127.0.0.1:0"));
    CHECK_EQ_I64((uint32_t)rig_input(&r, FLOAT + 2 * k), float_bits(4321.5));
    rig_end(&r, 130);
    said_clean(r.dir);
    said_clean(dir);
}

TEST(a_place_that_cannot_be_written_is_a_result)
{
    struct rig r;
    rig_start(&r,
              WORDS("run", "--pace", "--save", "/nowhere/at.all", "--modbus", "tcp:127.0.0.1:0"));
    CHECK_EQ_I64(rig_coil(&r, EXH_COIL_SAVE), 0);
    CHECK(rig_wait(&r, HEAD(EXH_HEAD_DONE), 1) == 0, "nothing came of it");
    CHECK_EQ_I64(rig_input(&r, HEAD(EXH_HEAD_RESULT)), -EXH_E_IO);
    rig_end(&r, 130);
    CHECK(strstr(r.said.err, "--save: /nowhere/at.all") != NULL, "%s", r.said.err);
    said_clean(r.dir);
}

/* RUN over the wire, where that was allowed, and the dead-man is held. */
TEST(commands_run_and_stop_the_box)
{
    struct rig r;
    rig_start(&r, WORDS("run", "--scene", "bilateral", "--pace", "--rate", "500", "--remote",
                        "--modbus", "tcp:127.0.0.1:0"));
    rig_sleep(0.3);
    CHECK(rig_coil(&r, EXH_COIL_OFF) == 0 && rig_wait(&r, HEAD(EXH_HEAD_STATE), EXH_STATE_OFF) == 0,
          "not off");
    for (int i = 0; i < 20 && rig_input(&r, HEAD(EXH_HEAD_STATE)) == EXH_STATE_OFF; i++) {
        CHECK_EQ_I64(rig_coil(&r, EXH_COIL_RUN), 0); /* refused while a finger presses */
        rig_sleep(0.1);
    }
    CHECK(rig_input(&r, HEAD(EXH_HEAD_STATE)) != EXH_STATE_OFF, "it does not run");
    rig_end(&r, 130);
    said_clean(r.dir);
}

/* With the rule of gains on, a pair outside it is refused, and neither value is taken. */
TEST(the_rule_of_gains_holds_here_too)
{
    uint32_t k;
    int32_t was;
    struct rig r;
    prepare();
    rig_start(&r, WORDS("run", "--scene", "guarded", "--pace", "--rate", "500", "--set",
                        "rule_on=1", "--set", "rule_rate=500", "--set", "rule_b1=30", "--set",
                        "rule_k0=9000", "--set", "rule_k1=2000", "--set", "k=5000", "--set", "b=15",
                        "--modbus", "tcp:127.0.0.1:0"));
    CHECK(cli_signal_find(exh_scene_guarded.params->table, "k", &k) != NULL, "no k");
    was = rig_input(&r, RAW + 2 * k);
    CHECK_EQ_I64(rig_write(&r, FLOAT + 2 * k, float_bits(1e6)), 0);
    CHECK_EQ_I64(rig_coil(&r, EXH_COIL_APPLY), 0);
    CHECK(rig_wait(&r, HEAD(EXH_HEAD_DONE), 1) == 0, "nothing came of it");
    CHECK_EQ_I64(rig_input(&r, HEAD(EXH_HEAD_RESULT)), -EXH_E_GAINS);
    CHECK_EQ_I64(rig_input(&r, RAW + 2 * k), was);
    rig_sleep(1); /* a round of the guard and more: a refusal is no damage */
    CHECK_EQ_I64(rig_input(&r, HEAD(EXH_HEAD_PRESENT)) & EXH_FAULT_CONFIG, 0);
    rig_end(&r, 130);
    said_clean(r.dir);
}

/* --- clients that do harm --- */

/* Asks for all there is and fetches nothing, until its connection ends or nobody takes more. */
static void ask_and_never_read(modbus_t *bad)
{
    static const uint8_t ask[12] = {0, 1, 0, 0, 0, 6, 1, 4, 0x04, 0x40, 0, 125};
    uint8_t many[100 * sizeof ask];
    for (size_t i = 0; i < sizeof many; i++) { many[i] = ask[i % sizeof ask]; }
    for (int idle = 0; idle < 100;) {
        const ssize_t n =
            send(modbus_get_socket(bad), many, sizeof many, MSG_DONTWAIT | MSG_NOSIGNAL);
        if (n < 0 && errno != EAGAIN) { return; }
        idle = n < 0 ? idle + 1 : 0;
        if (n < 0) { rig_sleep(0.01); }
    }
}

/* Others are answered on, and the program ends when told. */
TEST(a_client_that_fetches_no_answer)
{
    struct rig r;
    modbus_t *bad;
    rig_start(&r, WORDS("run", "--pace", "--modbus", "tcp:127.0.0.1:0"));
    bad = rig_client(r.port);
    ask_and_never_read(bad);
    CHECK_EQ_I64(rig_input(&r, HEAD(EXH_HEAD_TEST_INT)), 0x12345678);
    CHECK(rig_coil(&r, EXH_COIL_OFF) == 0 && rig_wait(&r, HEAD(EXH_HEAD_STATE), EXH_STATE_OFF) == 0,
          "not off");
    rig_end(&r, 130);
    modbus_close(bad);
    modbus_free(bad);
    said_clean(r.dir);
}

/* Sixteen who say nothing more keep nobody out: who is silent longest goes. */
TEST(silent_clients_keep_nobody_out)
{
    struct rig r;
    modbus_t *silent[20];
    uint16_t word[2];
    rig_start(&r, WORDS("run", "--pace", "--modbus", "tcp:127.0.0.1:0"));
    for (int i = 0; i < 20; i++) {
        silent[i] = rig_client(r.port);
        rig_sleep(0.05);
        CHECK_EQ_I64(rig_input(&r, HEAD(EXH_HEAD_TEST_INT)), 0x12345678);
    }
    CHECK(modbus_read_input_registers(silent[19], 4, 2, word) == 2, "%s", modbus_strerror(errno));
    CHECK(modbus_read_input_registers(silent[0], 4, 2, word) == -1, "more than 16");
    rig_end(&r, 130);
    for (int i = 0; i < 20; i++) {
        modbus_close(silent[i]);
        modbus_free(silent[i]);
    }
    said_clean(r.dir);
}

/* Signals that a thread of pid blocks, by the kernel. */
static unsigned long long blocked_by(pid_t pid, const char *task)
{
    char path[300], line[200];
    unsigned long long mask = 0;
    FILE *f;
    snprintf(path, sizeof path, "/proc/%d/task/%s/status", (int)pid, task);
    f = fopen(path, "r");
    while (f && fgets(line, sizeof line, f)) { (void)sscanf(line, "SigBlk: %llx", &mask); }
    if (f) { fclose(f); }
    return mask;
}

/* A crash in the thread that answers takes its handler's way, as any other: outputs low. */
TEST(no_thread_blocks_the_signals_of_a_crash)
{
    static const int crash[] = {SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGABRT};
    struct rig r;
    char path[64];
    DIR *d;
    int threads = 0, block = 0;
    rig_start(&r, WORDS("run", "--pace", "--modbus", "tcp:127.0.0.1:0"));
    (void)rig_input(&r, HEAD(EXH_HEAD_TICK));
    snprintf(path, sizeof path, "/proc/%d/task", (int)r.pid);
    d = opendir(path);
    for (struct dirent *e; d && (e = readdir(d)) != NULL;) {
        if (e->d_name[0] == '.') { continue; }
        threads++;
        block += (int)(blocked_by(r.pid, e->d_name) >> (SIGINT - 1) & 1);
        for (size_t i = 0; i < sizeof crash / sizeof crash[0]; i++) {
            CHECK(!(blocked_by(r.pid, e->d_name) >> (crash[i] - 1) & 1), "signal %d", crash[i]);
        }
    }
    if (d) { closedir(d); }
    CHECK(threads == 0 || (threads >= 2 && block >= 1), "%d threads, %d answer", threads, block);
    rig_end(&r, 130);
    said_clean(r.dir);
}

/* --- the line, and what cannot be opened --- */

/* A serial line is a pseudo-terminal: the box has one end, a libmodbus client the other. */
TEST(over_a_serial_line)
{
    char *dir = said_dir();
    char where[128];
    const int fd = posix_openpt(O_RDWR | O_NOCTTY);
    modbus_t *c = modbus_new_rtu("/dev/null", 115200, 'E', 8, 1);
    uint16_t word[6] = {0};
    struct said s;
    pid_t pid;
    if (fd < 0 || grantpt(fd) != 0 || unlockpt(fd) != 0) {
        check_note("no pseudo-terminal here (%s): not tried over a serial line", strerror(errno));
        if (fd >= 0) { close(fd); }
        modbus_free(c);
        said_clean(dir);
        return;
    }
    snprintf(where, sizeof where, "rtu:%s:115200", ptsname(fd));
    pid = said_start(dir, cli_run, WORDS("run", "--pace", "--modbus", where));
    for (int i = 0; i < 200 && said_size(said_path(dir, "said.out")) <= 0; i++) { rig_sleep(0.01); }
    modbus_set_slave(c, 1);
    modbus_set_socket(c, fd);
    modbus_set_response_timeout(c, 2, 0);
    for (int i = 0; i < 50; i++) {
        CHECK(modbus_read_input_registers(c, 0, 6, word) == 6, "%s", modbus_strerror(errno));
        CHECK_EQ_I64(rig_value(word, 2), 0x12345678);
    }
    CHECK(modbus_read_input_registers(c, 0x0FFF, 2, word) == -1 && errno == EMBXILADD,
          "no exception 2");
    CHECK(modbus_write_register(c, 0x5001, 1) == -1 && errno == EMBXILVAL,
          "no exception 3: step is of the set-up");
    for (int i = 0; i < 2; i++) { /* functions without data: the shortest requests there are */
        const uint8_t shortest[2] = {1, i == 0 ? 7 : 17};
        uint8_t answer[MODBUS_RTU_MAX_ADU_LENGTH] = {0};
        CHECK(modbus_send_raw_request(c, shortest, 2) == 4, "%s", modbus_strerror(errno));
        CHECK(modbus_receive_confirmation(c, answer) == 5 && answer[1] == (shortest[1] | 0x80) &&
                  answer[2] == EXH_MODBUS_FUNCTION,
              "function %d: %d %d %s", shortest[1], answer[1], answer[2], modbus_strerror(errno));
    }
    modbus_set_slave(c, 2); /* somebody else */
    modbus_set_response_timeout(c, 0, 100000);
    CHECK(modbus_read_input_registers(c, 0, 6, word) == -1 && errno == ETIMEDOUT,
          "answered for another");
    rig_sleep(
        0.6); /* libmodbus waits so long for the other's answer, and takes what comes for that */
    modbus_set_slave(c, 0); /* all: done, not answered */
    CHECK(modbus_write_bit(c, EXH_COIL_OFF, 1) == -1 && errno == ETIMEDOUT, "answered to all");
    modbus_set_slave(c, 1);
    modbus_set_response_timeout(c, 2, 0);
    CHECK(modbus_read_input_registers(c, (int)HEAD(EXH_HEAD_DONE), 2, word) == 2, "%s",
          modbus_strerror(errno));
    CHECK_EQ_I64(rig_value(word, 0), 1);
    kill(pid, SIGINT);
    said_end(&s, dir, pid);
    CHECK(s.status == 130, "%d %s", s.status, s.err);
    modbus_free(c);
    close(fd);
    said_clean(dir);
}

TEST(what_cannot_be_served_is_named)
{
    static const struct {
        const char *where, *said;
        int status;
    } row[] = {{"udp:1.2.3.4:5", "give tcp:ADDRESS:PORT", 2},
               {"tcp:here:1502", "give tcp:ADDRESS:PORT", 2},
               {"tcp:127.0.0.1:65536", "give tcp:ADDRESS:PORT", 2},
               {"tcp:192.0.2.1:1502", "an address of this machine", 3},
               {"rtu:/dev/nowhere:115200", "a serial line that is here", 3},
               {"rtu:/dev/null:12", "give tcp:ADDRESS:PORT", 2}};
    char *dir = said_dir();
    char where[64];
    struct said s;
    struct rig r;
    for (size_t i = 0; i < sizeof row / sizeof row[0]; i++) {
        said(&s, dir, cli_run, WORDS("run", "--seconds", "1", "--modbus", row[i].where));
        CHECK(s.status == row[i].status && strstr(s.err, row[i].said), "%s: %d %s", row[i].where,
              s.status, s.err);
    }
    rig_start(&r, WORDS("run", "--pace", "--modbus", "tcp:127.0.0.1:0"));
    snprintf(where, sizeof where, "tcp:127.0.0.1:%d", r.port);
    said(&s, dir, cli_run, WORDS("run", "--seconds", "1", "--modbus", where));
    CHECK(s.status == 3 && strstr(s.err, "another program serves there"), "%d %s", s.status, s.err);
    said(&s, dir, cli_run, WORDS("run", "--seconds", "1", "--save", "x"));
    CHECK_EQ_I64(s.status, 2);
    rig_end(&r, 130);
    said_clean(r.dir);
    said_clean(dir);
}

TEST_MAIN("modbus", every_register_there_and_back, bad_requests_get_the_standard_exceptions,
          no_read_is_torn, whoever_reads_the_box_does_the_same, a_run_with_a_writing_client_replays,
          saved_parameters_come_back, a_place_that_cannot_be_written_is_a_result,
          commands_run_and_stop_the_box, the_rule_of_gains_holds_here_too,
          a_client_that_fetches_no_answer, silent_clients_keep_nobody_out,
          no_thread_blocks_the_signals_of_a_crash, over_a_serial_line, what_cannot_be_served_is_named);
#endif
