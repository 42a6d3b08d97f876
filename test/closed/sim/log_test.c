/* SPDX-License-Identifier: MIT */
/* A log of whole runs: reads, replays bit for bit, and shows damage, loss and forgery. */
#include "logs.h"

#include "base/logfile.h"
#include "box/run.h"
#include "posix.h"

#include "drop/drop.h"
#include "exhand/run/log_later.h"

#include "exhand/bytes.h"
#include "exhand/record.h"

/* of a log read to its end */
struct counted {
    uint32_t frames, events, keyframes, last_tick, gaps;
    uint64_t damaged;
    int ended, complained;
};

static struct counted count_log(const char *path)
{
    struct counted n;
    struct logfile l;
    struct exh_record r;
    memset(&n, 0, sizeof n);
    CHECK_EQ_I64(logfile_open(&l, path), 0);
    while (logfile_next(&l, &r)) {
        n.frames += r.type == EXH_RECORD_FRAME;
        n.events += r.type == EXH_RECORD_EVENT;
        n.keyframes += r.type == EXH_RECORD_KEYFRAME;
        if (r.type == EXH_RECORD_FRAME) { n.last_tick = r.tick; }
    }
    n.damaged = l.damaged;
    n.gaps = l.gaps;
    n.ended = l.ended;
    n.complained = logfile_complain(&l);
    logfile_close(&l);
    return n;
}

struct text {
    char *p;
    size_t len;
};

static struct text slurp(const char *path)
{
    struct text t = {NULL, 0};
    FILE *f = fopen(path, "rb");
    CHECK(f != NULL, "%s", path);
    CHECK_EQ_I64(fseek(f, 0, SEEK_END), 0);
    t.len = (size_t)ftell(f);
    rewind(f);
    t.p = malloc(t.len);
    CHECK(t.p != NULL && fread(t.p, 1, t.len, f) == t.len, "%s", path);
    fclose(f);
    return t;
}

static void spill(const char *path, const struct text *t, size_t len)
{
    FILE *f = fopen(path, "wb");
    CHECK(f != NULL && fwrite(t->p, 1, len, f) == len, "%s", path);
    CHECK_EQ_I64(fclose(f), 0);
}

/* Three falls as the host program runs them; put NULL: into a file. */
static void run_three_falls_by(const char *path, int (*put)(const void *rec, size_t len_B))
{
    struct run_cfg c;
    struct run r;
    memset(&c, 0, sizeof c);
    c.rate_Hz = 500;
    c.k_Npm = 6000;
    c.b_Nspm = 20;
    c.board = posix_config_default();
    c.board.falls = 3;
    c.board.log = fopen(path, "wb");
    c.board.log_put = put;
    CHECK(c.board.log != NULL, "%s", path);
    CHECK_EQ_I64(run_drop(&c, &r), 0);
    CHECK_EQ_I64(fclose(c.board.log), 0);
    CHECK(r.log.falls == 3, "%zu falls", r.log.falls);
    run_free(&r);
}

static void run_three_falls(const char *path) { run_three_falls_by(path, NULL); }

TEST(a_whole_log_reads_and_replays)
{
    const char *path = log_path();
    struct counted n;
    run_three_falls(path);
    n = count_log(path);
    CHECK_EQ_I64(n.frames, n.last_tick + 1);
    CHECK_EQ_I64(n.keyframes, (n.last_tick + 1) / EXH_LOG_KEYFRAME_TICKS + 1);
    /* RUN, and a mark at the start of each fall and at the end of two of them */
    CHECK(n.frames > 7500 && n.events == 6, "%lu frames, %lu events", (unsigned long)n.frames,
        (unsigned long)n.events);
    CHECK(n.ended && n.damaged == 0 && n.gaps == 0 && !n.complained, "%lu damaged, %lu gaps",
        (unsigned long)n.damaged, (unsigned long)n.gaps);
    CHECK_EQ_I64(replay(path, NULL), 0);
    CHECK_EQ_I64(replay(path, "3000"), 0);
    CHECK_EQ_I64(replay(path, "4000000"), 2); /* it ends before */
    remove(path);
}

/* With room for all. With so little room that the rest of a keyframe is written immediately. With
 * no room for the copy. */
TEST(a_log_that_is_spread_over_ticks_has_the_same_bytes)
{
    static uint8_t record[EXH_LOG_RECORD_B], held[8192];
    static uint64_t copy[1024];
    static const uint32_t room[][2] = {
        {sizeof copy, sizeof held}, {sizeof copy, 100}, {0, sizeof held}};
    const char *path = log_path();
    struct text once, spread;
    run_three_falls(path);
    once = slurp(path);
    for (unsigned i = 0; i < LEN(room); i++) {
        const struct exh_log_later memory = {record, (uint8_t *)copy, held, room[i][0], room[i][1]};
        memset(held, 0, sizeof held);
        exh_log_later(&memory);
        run_three_falls(path);
        exh_log_later(NULL);
        spread = slurp(path);
        CHECK(held[0] != 0, "nothing has waited, %u", i);
        CHECK(spread.len == once.len && memcmp(spread.p, once.p, once.len) == 0, "%u", i);
        free(spread.p);
    }
    CHECK_EQ_I64(replay(path, NULL), 0);
    free(once.p);
    remove(path);
}

/* A board that refuses `refuse` records from the first keyframe in the run on. */
static struct {
    uint32_t refuse, left, next, gaps, reported, ended;
} full;

static int full_put(const void *rec, size_t len_B)
{
    struct exh_record r;
    struct exh_bytes c;
    uint32_t n = 0;
    CHECK(exh_record_decode(rec, (uint32_t)len_B, &r) > 0, "no record");
    if (r.type == EXH_RECORD_KEYFRAME && r.tick > 0 && full.refuse > 0) {
        full.left = full.refuse;
        full.refuse = 0;
    }
    if (full.left > 0) {
        full.left--;
        return 0;
    }
    full.gaps += r.seq - full.next;
    full.next = r.seq + 1;
    c = exh_bytes_reader(r.payload, r.len_B);
    if (r.type == EXH_RECORD_DROPPED || r.type == EXH_RECORD_END) { exh_bytes_u32(&c, &n); }
    full.reported += r.type == EXH_RECORD_DROPPED ? n : 0;
    full.ended += r.type == EXH_RECORD_END ? n : 0;
    return 1;
}

TEST(each_record_that_a_full_board_refuses_is_reported)
{
    static uint8_t record[EXH_LOG_RECORD_B], held[8192];
    static uint64_t copy[1024];
    const struct exh_log_later memory = {record, (uint8_t *)copy, held, sizeof copy, sizeof held};
    const char *path = log_path();
    for (uint32_t n = 1; n < 30; n += 4) {
        for (unsigned spread = 0; spread < 2; spread++) {
            memset(&full, 0, sizeof full);
            full.refuse = n;
            exh_log_later(spread ? &memory : NULL);
            run_three_falls_by(path, full_put);
            exh_log_later(NULL);
            CHECK(full.gaps > 0 && full.reported == full.gaps && full.ended == full.gaps,
                "%" PRIu32 " refused, spread %u: %" PRIu32 " gaps, %" PRIu32 " reported", n, spread,
                full.gaps, full.reported);
        }
    }
    remove(path);
}

/* Where the record at or behind `at` starts and how long it is. */
static uint32_t record_from(const struct text *t, uint32_t at, uint32_t *len_B)
{
    struct exh_record r;
    int32_t n = 0;
    for (; at < t->len; at++) {
        n = exh_record_decode(t->p + at, (uint32_t)t->len - at, &r);
        if (n > 0 && r.type == EXH_RECORD_FRAME) { break; }
    }
    *len_B = (uint32_t)n;
    return at;
}

TEST(a_damaged_record_is_skipped_and_counted)
{
    static const struct {
        int32_t byte; /* of the record, from its end if negative */
        uint8_t flip;
    } row[] = {{0, 1}, {2, 4}, {4, 0xFF}, {5, 0xFF}, {10, 0x80}, {14, 1}, {-1, 1}, {-5, 0x10}};
    const char *path = log_path();
    struct text t;
    uint32_t at, len_B, frames;
    run_three_falls(path);
    frames = count_log(path).frames;
    t = slurp(path);
    at = record_from(&t, (uint32_t)t.len / 2, &len_B);
    for (size_t i = 0; i < LEN(row); i++) {
        const uint32_t byte =
            at + (uint32_t)(row[i].byte < 0 ? (int32_t)len_B + row[i].byte : row[i].byte);
        struct counted n;
        t.p[byte] = (char)(t.p[byte] ^ row[i].flip);
        spill(path, &t, t.len);
        n = count_log(path);
        CHECK(n.frames == frames - 1, "row %zu: %lu frames of %lu", i, (unsigned long)n.frames,
            (unsigned long)frames);
        CHECK(n.damaged == len_B && n.gaps == 1, "row %zu: %lu damaged, %lu gaps", i,
            (unsigned long)n.damaged, (unsigned long)n.gaps);
        CHECK(n.ended && n.complained, "row %zu: not reported", i);
        CHECK(replay(path, NULL) == 1, "row %zu: replayed over a hole", i);
        t.p[byte] = (char)(t.p[byte] ^ row[i].flip);
    }
    free(t.p);
    remove(path);
}

TEST(a_cut_log_is_reported)
{
    const char *path = log_path();
    struct text t;
    run_three_falls(path);
    t = slurp(path);
    for (uint32_t i = 1; i <= 60; i++) { /* the end record, and into the last frame */
        struct counted n;
        spill(path, &t, t.len - i);
        n = count_log(path);
        CHECK(!n.ended && n.complained, "%lu bytes cut off: not reported", (unsigned long)i);
        CHECK(replay(path, NULL) == 1, "%lu bytes cut off: replay is content", (unsigned long)i);
    }
    spill(path, &t, 100);
    CHECK_EQ_I64(replay(path, NULL), 2); /* no header */
    free(t.p);
    remove(path);
}

/* A keyframe with a valid CRC and wrong content. Wrong parameters are refused. A wrong state is
 * brought into its ranges, and the outputs show it. */
static void forge_keyframe(size_t sound_B)
{
    const char *path = log_path();
    struct text t;
    struct exh_record r;
    struct exh_bytes c;
    uint8_t forged[EXH_LOG_RECORD_B];
    uint32_t at = 0, len = 0;
    run_three_falls(path);
    t = slurp(path);
    for (; at < t.len; at++) {
        const int32_t n = exh_record_decode(t.p + at, (uint32_t)t.len - at, &r);
        if (n > 0 && r.type == EXH_RECORD_KEYFRAME && r.tick == 1024) { break; }
    }
    CHECK(at < t.len, "no keyframe at tick 1024");
    c = exh_bytes_writer(forged, sizeof forged);
    exh_record_begin(&c, r.type, r.seq, r.tick);
    for (uint32_t i = 0; i < r.len_B; i++) {
        uint8_t b = i < sound_B ? r.payload[i] : 0xFF; /* every index, flag and sum at its worst */
        exh_bytes_u8(&c, &b);
    }
    len = exh_record_end(&c);
    memcpy(t.p + at, forged, len);
    spill(path, &t, t.len);
    CHECK_EQ_I64(replay(path, "1024"), 1);
    CHECK_EQ_I64(replay(path, NULL), 1);
    free(t.p);
    remove(path);
}
TEST(a_keyframe_with_forged_parameters_is_refused) { forge_keyframe(0); }

TEST(a_keyframe_with_a_forged_state_is_harmless)
{
    forge_keyframe(exh_signal_count(exh_scene_drop.params->table) * sizeof(int32_t));
}

/* What was refused has changed nothing. */
TEST(a_refused_keyframe_changes_nothing)
{
    const struct exh_scene *sc = &exh_scene_drop;
    uint8_t forged[EXH_LOG_RECORD_B], before[EXH_LOG_RECORD_B], after[EXH_LOG_RECORD_B];
    struct exh_bytes c;
    sc->defaults();
    CHECK_EQ_I64(sc->setup((struct exh_scene_board){{1, 1000}, 24}), 0);
    c = exh_bytes_writer(before, sizeof before);
    exh_log_keyframe_serialize(&c, sc);
    memcpy(forged, before, sizeof forged);
    forged[4 * (exh_signal_count(sc->params->table) - 1)] ^= 1; /* kf: sound, and another */
    forged[3] = 0x80;                                           /* step: out of its range */
    c = exh_bytes_reader(forged, c.at);
    exh_log_keyframe_serialize(&c, sc);
    CHECK(!exh_bytes_ok(&c), "accepted");
    c = exh_bytes_writer(after, sizeof after);
    exh_log_keyframe_serialize(&c, sc);
    CHECK(memcmp(before, after, c.at) == 0, "a refused keyframe acted");
    CHECK(!sc->params->pending, "something is staged");
}

TEST_MAIN("log", a_whole_log_reads_and_replays, a_log_that_is_spread_over_ticks_has_the_same_bytes,
    each_record_that_a_full_board_refuses_is_reported, a_damaged_record_is_skipped_and_counted,
    a_cut_log_is_reported, a_keyframe_with_forged_parameters_is_refused,
    a_keyframe_with_a_forged_state_is_harmless, a_refused_keyframe_changes_nothing);
