/* SPDX-License-Identifier: MIT */
/* exhand run --modbus: no torn reads, and the same bits of force with any readers. */
#define _XOPEN_SOURCE 700

#include "modbus_rig.h"

#ifdef EXH_MODBUS

#include "base/logfile.h"

#define SIGNALS 62 /* of bilateral: what one request can have */

/* Reads as fast as possible, until it is killed. */
static pid_t hammer(int port)
{
    const pid_t pid = fork();
    uint16_t word[2 * SIGNALS];
    modbus_t *c;
    if (pid != 0) { return pid; }
    c = modbus_new_tcp("127.0.0.1", port);
    if (modbus_connect(c) != 0) { _exit(1); }
    while (modbus_read_input_registers(c, (int)RIG_OUT, 2 * SIGNALS, word) > 0 &&
           modbus_read_input_registers(c, (int)RIG_RAW, 40, word) > 0) {}
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
static long torn_of(
    const struct seen *s, long n, int32_t (*frame)[SIGNALS], uint32_t frames, long *moved)
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
    rig_start(&r, WORDS("run", "--scene", "bilateral", "--fingers", "all", "--pace", "--rate",
                      n > 100000 ? "2000" : "10000", "--log", log, "--modbus", "tcp:127.0.0.1:0"));
    while (rig_input(&r, RIG_HEAD(EXH_HEAD_TICK)) == 0) {
    } /* before the first tick there is no tick to show */
    for (int i = 0; i < 2; i++) { other[i] = hammer(r.port); }
    for (long i = 0; i < n; i++) {
        uint16_t word[2 * SIGNALS];
        seen[i].first = i ? seen[i - 1].last : (uint32_t)rig_input(&r, RIG_HEAD(EXH_HEAD_TICK));
        CHECK(modbus_read_input_registers(r.c, (int)RIG_OUT, 2 * SIGNALS, word) == 2 * SIGNALS,
            "read %ld", i);
        for (unsigned k = 0; k < SIGNALS; k++) { seen[i].value[k] = rig_value(word, k); }
        seen[i].last = (uint32_t)rig_input(&r, RIG_HEAD(EXH_HEAD_TICK));
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

TEST_MAIN("modbus_reads", no_read_is_torn, whoever_reads_the_box_does_the_same);
#else
RIG_NONE("modbus_reads");
#endif
