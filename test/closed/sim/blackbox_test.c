/* SPDX-License-Identifier: MIT */
/* The black box: what it holds after a fault replays to that fault, wherever the dump begins. */
#include "logs.h"
#include "said.h"

#include "base/logfile.h"
#include "base/param.h"
#include "box/run.h"
#include "posix.h"

#include "exhand/run/blackbox.h"
#include "drop/drop.h"

#include "exhand/record.h"

/* of a dump, by reading it */
struct held {
    int64_t first, last; /* ticks of its first keyframe and its last frame */
    uint32_t frames, keyframes, gaps;
    uint64_t damaged;
    int32_t c; /* contact in the first frame */
    struct exh_event froze;
    int ended;
};

static struct held read_dump(const char *path)
{
    struct held h;
    struct logfile l;
    struct exh_record r;
    uint8_t type = 0;
    memset(&h, 0, sizeof h);
    CHECK_EQ_I64(logfile_open(&l, path), 0);
    while (logfile_next(&l, &r)) {
        if (type == 0) {
            CHECK_EQ_I64(r.type, EXH_RECORD_KEYFRAME);
            h.first = (int64_t)l.tick;
        }
        type = r.type;
        h.keyframes += r.type == EXH_RECORD_KEYFRAME;
        if (r.type == EXH_RECORD_EVENT) {
            struct exh_bytes c = exh_bytes_reader(r.payload, r.len_B);
            struct exh_event e;
            exh_event_serialize(&c, &e);
            if (e.type == EXH_EVENT_FROZE) { h.froze = e; }
        }
        if (r.type == EXH_RECORD_FRAME) {
            struct exh_bytes c = exh_bytes_reader(r.payload, r.len_B);
            struct drop_signals sig;
            struct exh_scene_in in;
            struct exh_drive_out out;
            exh_log_frame_serialize(&c, l.scene, &in, &out, (int32_t *)&sig);
            if (h.frames++ == 0) { h.c = sig.c; }
            CHECK(h.frames == 1 || (int64_t)l.tick == h.last + 1, "a frame is missing");
            h.last = (int64_t)l.tick;
        }
    }
    h.damaged = l.damaged;
    h.gaps = l.gaps;
    h.ended = l.ended;
    logfile_close(&l);
    return h;
}

/* The bench holds the mass for a second and lets it fall; it swings on the wall from 1.3 s on. */
static struct run_cfg three_falls(
    uint32_t rate_Hz, const char *dump, size_t memory_B, double let_go_s)
{
    struct run_cfg c;
    memset(&c, 0, sizeof c);
    c.rate_Hz = rate_Hz;
    c.k_Npm = 2000;
    c.b_Nspm = 2;
    c.board = posix_config_default();
    c.board.falls = 1;
    c.board.let_go_s = let_go_s;
    c.blackbox = dump;
    c.blackbox_B = memory_B;
    return c;
}

static struct held run_and_read(const struct run_cfg *c)
{
    struct run r;
    CHECK_EQ_I64(run_drop(c, &r), 0);
    CHECK(r.dumps >= 1, "%d dumps", r.dumps);
    run_free(&r);
    return read_dump(c->blackbox);
}

TEST(a_dump_ends_behind_the_fault_and_replays_to_it)
{
    static const uint32_t rate_Hz[] = {90, 500, 2000, 20000};
    const char *path = log_path();
    for (size_t i = 0; i < sizeof rate_Hz / sizeof rate_Hz[0]; i++) {
        const struct run_cfg c = three_falls(rate_Hz[i], path, 0, 1.7);
        const uint32_t after = rate_Hz[i] / 20 + 1 > 8 ? rate_Hz[i] / 20 + 1 : 8;
        const struct held h = run_and_read(&c);
        const int64_t fault = h.last - h.froze.instance;
        CHECK(h.ended && h.damaged == 0 && h.gaps == 0, "%lu Hz: %lu damaged, %lu gaps",
            (unsigned long)rate_Hz[i], (unsigned long)h.damaged, (unsigned long)h.gaps);
        CHECK_EQ_I64(h.froze.value, EXH_FAULT_DEADMAN);
        CHECK_EQ_I64(h.froze.instance, after);
        CHECK(fault >= 17 * (int64_t)rate_Hz[i] / 10 && fault <= 17 * (int64_t)rate_Hz[i] / 10 + 1,
            "fault at tick %lu of %lu Hz", (unsigned long)fault, (unsigned long)rate_Hz[i]);
        CHECK_EQ_I64(replay(path, NULL), 0);
    }
    remove(path);
}

/* Memory so small that the oldest is long gone: it begins with the mass on the wall. */
TEST(a_dump_that_begins_in_a_contact_replays_from_its_first_keyframe)
{
    const char *path = log_path();
    unsigned in_contact = 0, at_once = 0;
    for (size_t memory_B = 25024; memory_B < 53024; memory_B += 977) {
        const struct run_cfg c = three_falls(2000, path, memory_B, 2.2);
        const struct held h = run_and_read(&c);
        CHECK(h.first > 0 && h.frames == h.last - h.first + 1, "%lu frames from tick %lu to %lu",
            (unsigned long)h.frames, (unsigned long)h.first, (unsigned long)h.last);
        CHECK(h.ended && h.damaged == 0 && h.gaps == 0, "%zu B: %lu damaged, %lu gaps", memory_B,
            (unsigned long)h.damaged, (unsigned long)h.gaps);
        CHECK_EQ_I64(h.froze.value, EXH_FAULT_DEADMAN);
        CHECK_EQ_I64(replay(path, NULL), 0);
        CHECK(h.first + 100 < h.last - h.froze.instance, "it begins at tick %lu",
            (unsigned long)h.first);
        in_contact += h.c != 0;
        at_once += h.keyframes > 1;
    }
    CHECK(in_contact > 20 && at_once > 20, "%u began in a contact, %u have a second keyframe",
        in_contact, at_once);
    remove(path);
}

/* A log beside it: its bytes are those without a black box. */
TEST(the_log_is_the_same_with_a_black_box_beside_it)
{
    char log[2][64];
    const char *dump;
    struct run r;
    uint32_t crc[2];
    long size[2];
    for (int i = 0; i < 2; i++) {
        struct run_cfg c = three_falls(500, NULL, 20000, 1.7);
        strcpy(log[i], log_path());
        c.board.log = fopen(log[i], "wb");
        CHECK(c.board.log != NULL, "%s", log[i]);
        dump = log_path();
        if (i) { c.blackbox = dump; }
        CHECK_EQ_I64(run_drop(&c, &r), 0);
        CHECK_EQ_I64(fclose(c.board.log), 0);
        CHECK_EQ_I64(r.dumps, i);
        run_free(&r);
        if (i) { CHECK_EQ_I64(replay(dump, NULL), 0); }
        remove(dump);
    }
    for (int i = 0; i < 2; i++) {
        static uint8_t bytes[1 << 20];
        FILE *f = fopen(log[i], "rb");
        size[i] = (long)fread(bytes, 1, sizeof bytes, f);
        crc[i] = exh_crc32(0, bytes, (size_t)size[i]);
        fclose(f);
        remove(log[i]);
    }
    CHECK(size[0] == size[1] && size[0] > 10000 && crc[0] == crc[1], "%ld bytes and %ld", size[0],
        size[1]);
}

static size_t slurp(const char *path, uint8_t *to, size_t cap)
{
    FILE *f = fopen(path, "rb");
    size_t n;
    CHECK(f != NULL, "%s", path);
    n = fread(to, 1, cap, f);
    fclose(f);
    return n;
}

static void spill(const char *path, const uint8_t *byte, size_t n)
{
    FILE *f = fopen(path, "wb");
    CHECK(f != NULL && fwrite(byte, 1, n, f) == n, "%s", path);
    CHECK_EQ_I64(fclose(f), 0);
}

static uint8_t dump[200000], damaged[200000];

static size_t one_dump(const char *path)
{
    const struct run_cfg c = three_falls(500, path, 20000, 1.7);
    (void)run_and_read(&c);
    return slurp(path, dump, sizeof dump);
}

/* A change of any byte but the last record's is reported: exit status 1 or 2, never 0. The timeline
 * is still printed. */
TEST(a_damaged_dump_is_told)
{
    const char *path = log_path(), *dir = said_dir();
    const size_t n = one_dump(path);
    static struct said s;
    for (size_t at = 3; at < n; at += 1 + n / 40) {
        memcpy(damaged, dump, n);
        damaged[at] ^= 0x10;
        spill(path, damaged, n);
        said(&s, dir, cli_replay, WORDS("replay", "--timeline", path));
        CHECK(s.status == 1 || s.status == 2, "byte %zu: status %d: %s%s", at, s.status, s.out,
            s.err);
        CHECK(s.status == 2 || strstr(s.out, "FAULT deadman") || at > n / 2, "byte %zu: %s", at,
            s.out);
    }
    for (size_t cut = 1; cut < n; cut += 1 + n / 40) {
        spill(path, dump, n - cut);
        said(&s, dir, cli_replay, WORDS("replay", path));
        CHECK(s.status == 1 || s.status == 2, "%zu bytes cut off: status %d", cut, s.status);
    }
    remove(path);
    said_clean(dir);
}

/* Records with a valid CRC and random payloads are refused or reported, nothing worse. */
TEST(forged_records_are_harmless)
{
    const char *path = log_path(), *dir = said_dir();
    const size_t n = one_dump(path);
    static struct said s;
    uint64_t z = 1;
    for (int turn = 0; turn < 60; turn++) {
        size_t at = 0;
        memcpy(damaged, dump, n);
        while (at < n) {
            struct exh_record r;
            const int32_t len = exh_record_decode(damaged + at, (uint32_t)(n - at), &r);
            CHECK(len > 0, "record at %zu", at);
            z = z * 6364136223846793005u + 1442695040888963407u;
            if (r.len_B && (z >> 33) % 12 == 0) {
                uint8_t *p = damaged + at;
                uint32_t crc;
                for (unsigned i = 0; i < 3; i++) {
                    p[14 + (z >> (8 * i + 7)) % r.len_B] ^= (uint8_t)(z >> 20 | 1);
                }
                if (z >> 60 == 0) { p[2] = (uint8_t)(1 + (z >> 40) % 9); } /* another type, */
                if (p[2] == EXH_RECORD_END) { p[2] = r.type; } /* but a whole log may end there */
                crc = exh_crc32(0, p, (size_t)len - 4);
                for (unsigned i = 0; i < 4; i++) {
                    p[len - 4 + (int32_t)i] = (uint8_t)(crc >> 8 * i);
                }
            }
            at += (size_t)len;
        }
        spill(path, damaged, n);
        said(&s, dir, cli_replay, WORDS("replay", "--timeline", path));
        CHECK(s.status == 1 || s.status == 2, "turn %d: status %d: %s", turn, s.status, s.err);
    }
    remove(path);
    said_clean(dir);
}

/* As a serial line gives it: words, the dump, words. */
TEST(words_before_and_behind_a_dump_are_no_damage)
{
    static const char banner[] = "exhand 0.3.0, scene drop\r\nEXEXE\r\n",
                      last[] = "\r\nticks 1000\r\ndone EX\r\n";
    const char *path = log_path();
    const size_t n = one_dump(path);
    FILE *f = fopen(path, "wb");
    CHECK(f != NULL, "%s", path);
    (void)fwrite(banner, 1, sizeof banner - 1, f);
    (void)fwrite(dump, 1, n, f);
    (void)fwrite(last, 1, sizeof last - 1, f);
    CHECK_EQ_I64(fclose(f), 0);
    CHECK_EQ_I64(replay(path, NULL), 0);
    spill(path, dump, n / 2);
    CHECK_EQ_I64(replay(path, NULL), 1);
    remove(path);
}

/* The fault that froze it must come again, in that tick. A dump with another fault is reported. */
TEST(another_fault_than_told_is_told)
{
    const char *path = log_path(), *dir = said_dir();
    const size_t n = one_dump(path);
    static struct said s;
    struct exh_bytes c;
    uint8_t *event = dump + n - (EXH_RECORD_OVERHEAD + 4) - (EXH_RECORD_OVERHEAD + 12);
    struct exh_record r;
    struct exh_event e;
    CHECK_EQ_I64(exh_record_decode(event, EXH_RECORD_OVERHEAD + 12, &r), EXH_RECORD_OVERHEAD + 12);
    c = exh_bytes_reader(r.payload, r.len_B);
    exh_event_serialize(&c, &e);
    CHECK_EQ_I64(e.type, EXH_EVENT_FROZE);
    for (int what = 0; what < 3; what++) {
        struct exh_event other = e;
        other.value = what == 0 ? e.value : what == 1 ? EXH_FAULT_ESTOP : e.value;
        other.instance = (uint16_t)(e.instance + (what == 2));
        c = exh_bytes_writer(event, EXH_RECORD_OVERHEAD + 12);
        exh_record_begin(&c, EXH_RECORD_EVENT, r.seq, r.tick);
        exh_event_serialize(&c, &other);
        CHECK_EQ_I64(exh_record_end(&c), EXH_RECORD_OVERHEAD + 12);
        spill(path, dump, n);
        said(&s, dir, cli_replay, WORDS("replay", path));
        CHECK(s.status == (what != 0), "%d: status %d: %s", what, s.status, s.out);
        CHECK(!what == !strstr(s.out, "did not come"), "%d: %s", what, s.out);
    }
    remove(path);
    said_clean(dir);
}

/* --- the hooks alone, tick by tick --- */

static uint8_t memory[65536];

static void start_box(int is_alone)
{
    const struct exh_scene_board board = {{1, 500}, 24};
    exh_scene_drop.defaults();
    CHECK_EQ_I64(exh_params_stage(exh_scene_drop.params, exh_calib_set_rows[2].id, 0, 1),
        0); /* uncalibrated */
    exh_params_apply(exh_scene_drop.params);
    CHECK_EQ_I64(exh_scene_drop.setup(board), 0);
    exh_scene_drop.params->locked = 1;
    exh_blackbox_memory(memory, sizeof memory, is_alone);
    exh_blackbox_start(&exh_scene_drop, board);
    CHECK_EQ_I64(exh_blackbox_is().state, EXH_BLACKBOX_RECORDS);
}

static void one_tick(uint32_t tick, uint32_t open)
{
    struct exh_scene_in in = {
        .drive.din = ~open, .command = tick == 0 ? EXH_CMD_RUN : EXH_CMD_NONE};
    struct exh_drive_out out;
    exh_blackbox_before(tick, &in);
    exh_params_apply(exh_scene_drop.params);
    exh_scene_drop.tick(&in, &out);
    exh_blackbox_after(tick, &in, &out);
}

/* All of it, in pieces of another length each time. */
static size_t read_all(uint8_t *to, size_t cap)
{
    size_t n = 0;
    for (uint32_t piece = 1; n + piece < cap; piece = piece % 300 + 7) {
        const uint32_t k = exh_blackbox_read(to + n, piece);
        CHECK(k <= piece, "%lu of %lu", (unsigned long)k, (unsigned long)piece);
        if (k == 0) { return n; }
        n += k;
    }
    CHECK(0, "endless");
    return n;
}

TEST(later_faults_are_counted_and_record_nothing_over)
{
    const char *path = log_path();
    struct held h;
    uint32_t tick = 0;
    size_t n;
    start_box(1);
    for (; tick < 200; tick++) { one_tick(tick, 0); }
    one_tick(tick++, EXH_DIN_DEADMAN); /* tick 200 */
    for (; tick < 210; tick++) { one_tick(tick, EXH_DIN_DEADMAN); }
    one_tick(tick++, EXH_DIN_DEADMAN | EXH_DIN_ESTOP); /* while it runs on */
    for (; tick < 300; tick++) { one_tick(tick, EXH_DIN_DEADMAN); }
    CHECK_EQ_I64(exh_blackbox_is().state, EXH_BLACKBOX_FROZEN);
    one_tick(tick++, EXH_DIN_DEADMAN | EXH_DIN_CARDS); /* frozen */
    for (; tick < 5000; tick++) { one_tick(tick, EXH_DIN_DEADMAN); }
    CHECK_EQ_I64(exh_blackbox_is().later, 2);
    CHECK_EQ_I64(exh_blackbox_is().cause, EXH_FAULT_DEADMAN);
    CHECK_EQ_I64(exh_blackbox_is().tick, 200);
    n = read_all(dump, sizeof dump);
    spill(path, dump, n);
    h = read_dump(path);
    CHECK_EQ_I64(h.last, 226);
    CHECK_EQ_I64(h.froze.id, 2);
    CHECK_EQ_I64(h.froze.instance, 26);
    CHECK_EQ_I64(replay(path, NULL), 0);
    /* It was read: it begins anew, and the next fault is another dump. */
    CHECK_EQ_I64(exh_blackbox_is().state, EXH_BLACKBOX_RECORDS);
    for (; tick < 5100; tick++) { one_tick(tick, EXH_DIN_DEADMAN); }
    one_tick(tick++, EXH_DIN_DEADMAN | EXH_DIN_WATCHDOG);
    for (; tick < 5200; tick++) { one_tick(tick, EXH_DIN_DEADMAN); }
    n = read_all(dump, sizeof dump);
    spill(path, dump, n);
    h = read_dump(path);
    CHECK_EQ_I64(h.first, 5001); /* the keyframe behind the first tick */
    CHECK_EQ_I64(h.froze.value, EXH_FAULT_WATCHDOG);
    CHECK_EQ_I64(h.last - h.froze.instance, 5100);
    CHECK_EQ_I64(replay(path, NULL), 0);
    exh_blackbox_memory(NULL, 0, 0);
    exh_log_tap(NULL, 0);
    remove(path);
}

/* Not those of the start: they were changed on the way. */
TEST(the_header_has_the_parameters_of_the_fault)
{
    const char *path = log_path();
    struct exh_params *p = exh_scene_drop.params;
    uint32_t index = 0;
    struct logfile l;
    const struct exh_signal *row;
    int32_t dflt;
    start_box(1);
    row = cli_signal_find(p->table, "k", &index);
    dflt = p->active[index];
    for (uint32_t tick = 0; tick < 200; tick++) {
        if (tick == 50) { CHECK(exh_params_stage(p, row->id, 0, dflt + 4711) >= 0, "k"); }
        one_tick(tick, tick < 100 ? 0 : EXH_DIN_DEADMAN);
    }
    spill(path, dump, read_all(dump, sizeof dump));
    CHECK_EQ_I64(replay(path, NULL), 0);
    CHECK_EQ_I64(logfile_open(&l, path), 0);
    exh_scene_drop.defaults();
    CHECK_EQ_I64(p->active[index], dflt);
    CHECK_EQ_I64(exh_params_restore(p, l.params, l.params_len, NULL), 0);
    CHECK_EQ_I64(p->staged[index], dflt + 4711);
    logfile_close(&l);
    exh_blackbox_memory(NULL, 0, 0);
    exh_log_tap(NULL, 0);
    remove(path);
}

/* A box that ends for another reason still leaves its dump. A run that ends well leaves none. */
TEST(a_halted_box_can_be_read)
{
    const char *path = log_path();
    struct held h;
    start_box(1);
    for (uint32_t tick = 0; tick < 700; tick++) { one_tick(tick, 0); }
    exh_blackbox_stop(0);
    CHECK(read_all(dump, sizeof dump) == 0, "a dump of nothing");
    exh_blackbox_stop(1);
    spill(path, dump, read_all(dump, sizeof dump));
    h = read_dump(path);
    CHECK_EQ_I64(h.last, 699);
    CHECK_EQ_I64(h.froze.value, 0);
    CHECK_EQ_I64(replay(path, NULL), 0);
    exh_blackbox_memory(NULL, 0, 0);
    exh_log_tap(NULL, 0);
    remove(path);
}

/* --- the command --- */

/* Each of these behind the one before, in one text. */
static void in_order(const char *text, const char *const *word, size_t n)
{
    for (size_t i = 0; i < n; i++) {
        const char *at = strstr(text, word[i]);
        CHECK(at != NULL, "no '%s' (behind the ones before) in %s", word[i], text);
        if (at == NULL) { return; }
        text = at;
    }
}

TEST(the_timeline_tells_what_happened_in_order)
{
    static const char *const want[] = {"scene drop on posix, a tick is 1/500 s", "command: run",
        "state: arm", "arming: small_force", "arming: ramp", "contact begins",
        "dead-man switch: let go", "FAULT deadman: the dead-man switch was let go", "-> release",
        "limit release", "state: release -> fault",
        "the black box froze for deadman, 26 ticks behind it; 0 causes came later",
        "end of the log, 0 records lost", "fault deadman at tick 850, as recorded", "identical"};
    const char *path = log_path(), *dir = said_dir();
    static struct said s;
    const struct run_cfg c = three_falls(500, path, 0, 1.7);
    (void)run_and_read(&c);
    said(&s, dir, cli_replay, WORDS("replay", "--timeline", path));
    CHECK_EQ_I64(s.status, 0);
    in_order(s.out, want, sizeof want / sizeof want[0]);
    remove(path);
    said_clean(dir);
}

TEST(dumps_stand_beside_the_log_and_bad_usage_is_refused)
{
    const char *dir = said_dir();
    static struct said s;
    said(&s, dir, cli_drop,
        WORDS("drop", "--rate", "500", "--falls", "1", "--let-go", "1.7", "--out", dir));
    CHECK(s.status == 1 && strstr(s.err, "black box: fault deadman at tick 850"), "%d: %s",
        s.status, s.err);
    said(&s, dir, cli_replay, WORDS("replay", said_path(dir, "drop_500Hz_fault.exh")));
    CHECK(s.status == 0 && strstr(s.out, "fault deadman at tick 850, as recorded"), "%d: %s",
        s.status, s.err);
    said(&s, dir, cli_drop, WORDS("drop", "--rate", "500", "--falls", "1", "--out", dir));
    CHECK(said_size(said_path(dir, "drop_500Hz_fault.exh")) < 0, "an earlier run's dump stays");
    said(&s, dir, cli_drop, WORDS("drop", "--rate", "500,1000", "--blackbox", said_path(dir, "x")));
    CHECK(s.status == 2 && strstr(s.err, "--blackbox"), "%d: %s", s.status, s.err);
    said(&s, dir, cli_bilateral, WORDS("bilateral", "--blackbox", said_path(dir, "x")));
    CHECK(s.status == 2 && strstr(s.err, "--blackbox"), "%d: %s", s.status, s.err);
    said(&s, dir, cli_replay, WORDS("replay", "--help"));
    CHECK(s.status == 0 && strstr(s.out, "--timeline"), "%d: %s", s.status, s.out);
    said_clean(dir);
}

TEST_MAIN("blackbox", a_dump_ends_behind_the_fault_and_replays_to_it,
    a_dump_that_begins_in_a_contact_replays_from_its_first_keyframe,
    the_log_is_the_same_with_a_black_box_beside_it, a_damaged_dump_is_told,
    forged_records_are_harmless, words_before_and_behind_a_dump_are_no_damage,
    another_fault_than_told_is_told, later_faults_are_counted_and_record_nothing_over,
    the_header_has_the_parameters_of_the_fault, a_halted_box_can_be_read,
    the_timeline_tells_what_happened_in_order, dumps_stand_beside_the_log_and_bad_usage_is_refused);
