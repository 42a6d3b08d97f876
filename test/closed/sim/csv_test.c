/* SPDX-License-Identifier: MIT */
/* Logs through csv and replay: a wrong command loses nothing, damage is always reported, and Table
 * II can be made again from the CSVs alone. */
#include "said.h"

#include "falls/analysis.h"
#include "base/logfile.h"
#include "box/table2.h"

#include "exhand/run/log.h"

#include "exhand/error.h"

/* ---- Table II from the CSVs ----------------------------------------------------- */

#define SAMPLES_MAX 200000
#define FALLS_MAX   64

static struct {
    struct fall_sample at[SAMPLES_MAX];
    size_t n;
    size_t start[FALLS_MAX];
    size_t falls;
} csv;

/* Only a gap in time separates two falls. */
static void read_csv(const char *path, double T_s)
{
    char line[256];
    FILE *f = fopen(path, "r");
    CHECK(f != NULL && fgets(line, sizeof line, f) != NULL, "%s", path);
    CHECK(strcmp(line, "t_s,q_m,qd_m_per_s,f_des_n,i_des_a,c,f_mon_n\n") == 0, "%s", line);
    csv.n = csv.falls = 0;
    while (fgets(line, sizeof line, f)) {
        struct fall_sample *s = &csv.at[csv.n];
        CHECK(csv.n < SAMPLES_MAX && csv.falls < FALLS_MAX, "%s: too long", path);
        CHECK(sscanf(line, "%lf,%lf,%lf,%lf,%lf,%d,%lf", &s->t_s, &s->q_m, &s->qd_mps, &s->f_des_N,
                  &s->i_des_A, &s->c, &s->f_mon_N) == 7,
            "%s", line);
        CHECK(csv.n == 0 || s->t_s > s[-1].t_s, "time does not rise: %s", line);
        if (csv.n == 0 || s->t_s > s[-1].t_s + 1.5 * T_s) { csv.start[csv.falls++] = csv.n; }
        csv.n++;
    }
    fclose(f);
}

static size_t count_lines(const char *path)
{
    size_t n = 0;
    FILE *f = fopen(path, "r");
    CHECK(f != NULL, "%s", path);
    for (int c = fgetc(f); c != EOF; c = fgetc(f)) { n += c == '\n'; }
    fclose(f);
    return n;
}

/* Ten positions to a nanometre: B agrees to what table2.csv prints, six digits. */
TEST(table_2_is_made_again_from_the_csvs)
{
    char *dir = said_dir();
    static struct said s;
    static char table[SAID_B];
    const char *line = table;
    said(&s, dir, cli_drop, WORDS("drop", "--runs", "1", "--out", dir));
    CHECK(s.status == 0, "%s", s.err);
    said_read(table, said_path(dir, "table2.csv"));
    for (int i = 0; i < TABLE2_ROWS; i++) {
        const struct fall_log log = {csv.at, 0, csv.start, 0};
        struct fall_opt opt = fall_opt_default;
        struct fall_stiffness again;
        struct fall_log l = log;
        char name[64];
        double rate_Hz, b_Npm = 0;
        line = strchr(line, '\n') + 1;
        CHECK(sscanf(line, "%lf,%*f,%*f,%*f,%*f,%lf", &rate_Hz, &b_Npm) == 2, "%s", line);
        snprintf(name, sizeof name, "drop_%gHz.csv", rate_Hz);
        read_csv(said_path(dir, name), 1 / rate_Hz);
        CHECK(csv.falls == 10, "%s: %zu falls", name, csv.falls);
        l.samples = csv.n;
        l.falls = csv.falls;
        CHECK(fall_stiffness(&l, &opt, &again) == FALL_OK, "%s", name);
        CHECK(again.fit.b_Npm > b_Npm * (1 - 2e-5) && again.fit.b_Npm < b_Npm * (1 + 2e-5),
            "%s: B %.6g, table %.6g", name, again.fit.b_Npm, b_Npm);
        snprintf(name, sizeof name, "drop_%gHz_raw.csv", rate_Hz);
        CHECK_EQ_I64((int64_t)count_lines(said_path(dir, name)), (int64_t)again.raw.n + 1);
        fall_stiffness_free(&again);
    }
    said_clean(dir);
}

/* Also where a tick is longer than the hand takes to lift the mass. */
TEST(falls_are_apart_at_every_rate)
{
    static const double rate_Hz[] = {1, 2, 3, 7, 20000};
    for (size_t i = 0; i < LEN(rate_Hz); i++) {
        char *dir = said_dir();
        char text[32];
        static struct said s;
        snprintf(text, sizeof text, "%g", rate_Hz[i]);
        said(&s, dir, cli_drop,
            WORDS("drop", "--rate", text, "--falls", "7", "--device", "observe=0.6", "--out", dir));
        snprintf(text, sizeof text, "drop_%gHz.csv", rate_Hz[i]);
        read_csv(said_path(dir, text), 1 / rate_Hz[i]);
        CHECK(csv.falls == 7, "%g Hz: %zu falls", rate_Hz[i], csv.falls);
        said_clean(dir);
    }
}

/* ---- A log to play with -------------------------------------------------------------- */

/* One fall at 500 Hz in DIR/a.exh: 2500 frames and more, three keyframes. */
static void make_log(const char *dir)
{
    static struct said s;
    said(&s, dir, cli_drop, WORDS("drop", "--rate", "500", "--falls", "1", "--out", dir));
    CHECK(s.status == 0, "%s", s.err);
    CHECK_EQ_I64(rename(said_path(dir, "drop_500Hz.exh"), said_path(dir, "a.exh")), 0);
}

/* Every record of a log through change(), and with good checksums into another. */
typedef void (*change_fn)(struct exh_record *r, uint8_t *payload, int64_t by);

static void rewrite(const char *from, const char *to, change_fn change, int64_t by)
{
    static uint8_t in[2000000], payload[8192], out[8192];
    FILE *f = fopen(from, "rb"), *g = fopen(to, "wb");
    CHECK(f != NULL && g != NULL, "%s, %s", from, to);
    const uint32_t len = (uint32_t)fread(in, 1, sizeof in, f);
    for (uint32_t at = 0; at < len;) {
        struct exh_record r;
        struct exh_bytes c = exh_bytes_writer(out, sizeof out);
        const int32_t n = exh_record_decode(in + at, len - at, &r);
        CHECK(n > 0, "record at %lu", (unsigned long)at);
        at += (uint32_t)n;
        memset(payload, 0, sizeof payload);
        memcpy(payload, r.payload, r.len_B);
        change(&r, payload, by);
        exh_record_begin(&c, r.type, r.seq, r.tick);
        for (uint32_t i = 0; i < r.len_B; i++) { exh_bytes_u8(&c, &payload[i]); }
        fwrite(out, 1, exh_record_end(&c), g);
    }
    fclose(f);
    CHECK_EQ_I64(fclose(g), 0);
}

/* ---- What a slip of the hand may not do ------------------------------------------------ */

TEST(csv_destroys_nothing)
{
    char *dir = said_dir();
    static struct said s;
    long log_B;
    make_log(dir);
    log_B = said_size(said_path(dir, "a.exh"));
    CHECK_EQ_I64(symlink("a.exh", said_path(dir, "alias")), 0);
    CHECK_EQ_I64(link(said_path(dir, "a.exh"), said_path(dir, "twin")), 0);
    said(&s, dir, cli_csv, WORDS("csv", said_path(dir, "a.exh"), "--out", said_path(dir, "a.csv")));
    CHECK(s.status == 0 && s.err[0] == '\0', "%d: %s", s.status, s.err);
    const long csv_B = said_size(said_path(dir, "a.csv"));
    static const struct {
        const char *log, *out, *says;
        int status;
    } row[] = {
        {"a.exh", "a.exh", "is the log itself", 2},
        {"a.exh", "alias", "is the log itself", 2},
        {"twin", "a.exh", "is the log itself", 2},
        {"b.exh", "a.csv", "No such file", 3},
        {"a.csv", "a.exh", "not a log", 2},
        {"said.out", "a.csv", "not a log", 2},
        {".", "a.csv", "read", 2},
    };
    for (size_t i = 0; i < LEN(row); i++) {
        said(&s, dir, cli_csv,
            WORDS("csv", said_path(dir, row[i].log), "--out", said_path(dir, row[i].out)));
        CHECK(s.status == row[i].status && strstr(s.err, row[i].says), "row %zu: %d: %s", i,
            s.status, s.err);
        CHECK(strncmp(s.err, "exhand csv: ", 12) == 0, "%s", s.err);
        CHECK_EQ_I64(said_size(said_path(dir, "a.exh")), log_B);
        CHECK_EQ_I64(said_size(said_path(dir, "a.csv")), csv_B);
    }
    said(&s, dir, cli_csv, WORDS("csv", said_path(dir, "a.exh"), "--out", "/dev/full"));
    CHECK(s.status == 1 && strstr(s.err, "/dev/full"), "%d: %s", s.status, s.err);
    said_clean(dir);
}

/* ---- What is damaged ---------------------------------------------------------------------- */

static void longer(struct exh_record *r, uint8_t *payload, int64_t by)
{
    (void)payload;
    if (r->type == EXH_RECORD_FRAME && r->tick == 100) { r->len_B = (uint16_t)(r->len_B + by); }
}

static void repeated(struct exh_record *r, uint8_t *payload, int64_t by)
{
    (void)payload;
    if (r->type == EXH_RECORD_FRAME && r->tick == 100) { r->tick = (uint32_t)(100 - by); }
}

static void longer_event(struct exh_record *r, uint8_t *payload, int64_t by)
{
    (void)payload;
    if (r->type == EXH_RECORD_EVENT) { r->len_B = (uint16_t)(r->len_B + by); }
}

static void longer_keyframe(struct exh_record *r, uint8_t *payload, int64_t by)
{
    (void)payload;
    if (r->type == EXH_RECORD_KEYFRAME) { r->len_B = (uint16_t)(r->len_B + by); }
}

/* The header's period: two u32 after both names, the version and the CRC. */
static void other_period(struct exh_record *r, uint8_t *payload, int64_t by)
{
    const uint32_t value[] = {(uint32_t)(by >> 32), (uint32_t)by};
    if (r->type != EXH_RECORD_HEADER) { return; }
    for (int i = 0; i < 8; i++) { payload[40 + i] = (uint8_t)(value[i / 4] >> 8 * (i % 4)); }
}

#define PERIOD(num, den) ((int64_t)(num) << 32 | (den))

TEST(damage_is_said)
{
    static const struct {
        change_fn change;
        int64_t by;
        int csv, replay; /* exit status */
        const char *csv_says;
        long fewer; /* lines */
    } row[] = {
        {longer, 0, 0, 0, "", 0},
        {longer, 1, 1, 1, "1 records of a wrong length", 1},
        {longer, -4, 1, 1, "1 records of a wrong length", 1},
        {longer_event, 2, 1, 1, "records of a wrong length", 0},
        {longer_keyframe, 2, 0, 1, "", 0},
        {repeated, 1, 1, 1, "1 frames whose tick does not rise", 1},
        {repeated, 60, 1, 1, "1 frames whose tick does not rise", 1},
        {other_period, PERIOD(1, 500), 0, 0, "", 0},
        {other_period, PERIOD(2, 1), 2, 2, "period", 0},
        {other_period, PERIOD(0, 1), 2, 2, "period", 0},
        {other_period, PERIOD(1, 0), 2, 2, "period", 0},
        {other_period, PERIOD(1, 1000000), 2, 2, "period", 0},
    };
    char *dir = said_dir();
    static struct said s;
    size_t lines;
    make_log(dir);
    said(&s, dir, cli_csv, WORDS("csv", said_path(dir, "a.exh"), "--out", said_path(dir, "a.csv")));
    lines = count_lines(said_path(dir, "a.csv"));
    for (size_t i = 0; i < LEN(row); i++) {
        rewrite(said_path(dir, "a.exh"), said_path(dir, "b.exh"), row[i].change, row[i].by);
        remove(said_path(dir, "b.csv"));
        said(&s, dir, cli_csv,
            WORDS("csv", said_path(dir, "b.exh"), "--out", said_path(dir, "b.csv")));
        CHECK(s.status == row[i].csv && strstr(s.err, row[i].csv_says), "row %zu: csv %d: %s", i,
            s.status, s.err);
        CHECK(row[i].csv == 2
                  ? said_size(said_path(dir, "b.csv")) < 0
                  : count_lines(said_path(dir, "b.csv")) == lines - (size_t)row[i].fewer,
            "row %zu: lines", i);
        said(&s, dir, cli_replay, WORDS("replay", said_path(dir, "b.exh")));
        CHECK(s.status == row[i].replay, "row %zu: replay %d: %s%s", i, s.status, s.out, s.err);
    }
    said_clean(dir);
}

/* ---- Ticks past 2^32 ----------------------------------------------------------------------- */

static void later(struct exh_record *r, uint8_t *payload, int64_t by)
{
    (void)payload;
    if (r->type != EXH_RECORD_HEADER) { r->tick += (uint32_t)by; }
}

TEST(ticks_go_on_past_the_wrap)
{
    /* The keyframe at tick 1024 becomes the last before the wrap, that at 2048 the next. */
    static const struct {
        const char *from, *says;
    } row[] = {{"4294966796", "from tick 4294966796 "}, {"4294967295", "from tick 4294966796 "},
        {"4294967296", "from tick 4294966796 "}, {"4294967820", "from tick 4294967820 "},
        {"4294967900", "from tick 4294967820 "}};
    char *dir = said_dir();
    static struct said s;
    make_log(dir);
    rewrite(said_path(dir, "a.exh"), said_path(dir, "b.exh"), later, INT64_C(4294967296) - 1524);
    said(&s, dir, cli_csv,
        WORDS("csv", said_path(dir, "b.exh"), "--falls", "--out", said_path(dir, "b.csv")));
    CHECK(s.status == 0, "%s", s.err);
    read_csv(said_path(dir, "b.csv"), 1 / 500.0);
    CHECK(csv.falls == 1 && csv.n > 2500, "%zu falls, %zu samples", csv.falls, csv.n);
    CHECK(csv.at[csv.n - 1].t_s > 4294967296.0 / 500, "%.3f s", csv.at[csv.n - 1].t_s);
    for (size_t i = 0; i < LEN(row); i++) {
        said(&s, dir, cli_replay, WORDS("replay", said_path(dir, "b.exh"), "--from", row[i].from));
        CHECK(s.status == 0 && strstr(s.out, row[i].says), "from %s: %d: %s%s", row[i].from,
            s.status, s.out, s.err);
    }
    said(&s, dir, cli_replay, WORDS("replay", said_path(dir, "b.exh"), "--from", "999999999999"));
    CHECK(s.status == 2 && strstr(s.err, "--from: 999999999999: ") && strstr(s.err, "ends at tick"),
        "%d: %s", s.status, s.err);
    said(&s, dir, cli_replay, WORDS("replay", said_path(dir, "b.exh"), "--from", "100"));
    CHECK(s.status == 2 && strstr(s.err, "no keyframe"), "%d: %s", s.status, s.err);
    said_clean(dir);
}

TEST_MAIN("csv", table_2_is_made_again_from_the_csvs, falls_are_apart_at_every_rate,
    csv_destroys_nothing, damage_is_said, ticks_go_on_past_the_wrap);
