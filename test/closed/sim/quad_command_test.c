/* SPDX-License-Identifier: MIT */
/* exhand quad: recorded and synthetic captures decode to the counts, illegal steps and shortest
 * gaps of their descriptions, as bytes and as CSV. Bad options and bad input are refused by name.
 */
#include "said.h"

static struct said s;

/* The command with FROM as its standard input. */
static void quad(const char *dir, const char *from, const char *const *word)
{
    const int fd = open(from, O_RDONLY);
    CHECK(fd >= 0 && dup2(fd, STDIN_FILENO) == STDIN_FILENO, "%s", from);
    close(fd);
    said(&s, dir, cli_quad, word);
}

static const char *make_file(const char *dir, const char *name, const void *what, size_t len)
{
    const char *path = said_path(dir, name);
    FILE *f = fopen(path, "wb");
    CHECK(f != NULL && fwrite(what, 1, len, f) == len && fclose(f) == 0, "%s", path);
    return path;
}

/* --- captures --------------------------------------------------------------------- */

/* The samples of a sigrok session in DIR/raw; 0 when they can't be had. */
static int session(const char *dir, const char *name)
{
    static const char *const how[][2] = {{"unzip -p", "'logic-1*'"},
        {"python3 -c 'import sys, zipfile\n"
         "z = zipfile.ZipFile(sys.argv[1])\n"
         "for n in z.namelist():\n"
         "    if n.startswith(\"logic-1\"): sys.stdout.buffer.write(z.read(n))'",
            ""}};
    const char *data = getenv("EXH_DATA") ? getenv("EXH_DATA") : "$EXH_DATA";
    char path[512], command[1024];
    static int told;
    snprintf(path, sizeof path, "%s/%s.sr", data, name);
    if (access(path, R_OK) != 0) {
        if (told++ == 0) {
            check_note("%s: not there: no capture is tested; EXH_DATA names their place", data);
        }
        return 0;
    }
    for (size_t i = 0; i < LEN(how); i++) {
        snprintf(command, sizeof command, "%s '%s' %s >'%s/raw' 2>/dev/null", how[i][0], path,
            how[i][1], dir);
        if (system(command) == 0 && said_size(said_path(dir, "raw")) > 0) { return 1; }
    }
    if (told++ == 0) {
        check_note("%s: neither unzip nor python3 opens it: no capture is tested", path);
    }
    return 0;
}

#define ADNS   "quad-adns2051/adns2051_"
#define ROTARY "quad-synthetic-rotary/rotary-"

/* At 1 MHz and full rate, edges and gap are known too. */
TEST(captures_decode_to_their_descriptions)
{
    static const struct {
        const char *file, *a, *b, *says;
    } row[] = {
        {ADNS "move_mouse_left_right", "1", "2", "net=-29 edges=1041 illegal=0 min_gap_us=947\n"},
        {ADNS "move_mouse_left_right", "4", "3", "net=-22 edges=48 illegal=0 min_gap_us=10249\n"},
        {ADNS "move_mouse_up_down", "1", "2", "net=-21 edges=43 illegal=0 min_gap_us=12776\n"},
        {ADNS "move_mouse_up_down", "4", "3", "net=37 edges=629 illegal=0 min_gap_us=1359\n"},
        {ADNS "move_mouse_fast", "1", "2", "net=128 edges=560 illegal=0 min_gap_us=1363\n"},
        {ADNS "move_mouse_fast", "4", "3", "net=88 edges=4154 illegal=0 min_gap_us=134\n"},
        {ADNS "sleep_then_move", "1", "2", "net=7 edges=13 illegal=0 min_gap_us=5854\n"},
        {ADNS "sleep_then_move", "4", "3", "net=23 edges=99 illegal=0 min_gap_us=945\n"},
        {ROTARY "ramp", "0", "1", "net=-12732 edges=12732 illegal=0 min_gap_us=23\n"},
        {ROTARY "sin", "0", "1", "net=0 edges=1016 illegal=0 min_gap_us="},
    };
    char *dir = said_dir();
    int there = 0;
    for (size_t i = 0; i < LEN(row); i++) {
        if (i == 0 || strcmp(row[i].file, row[i - 1].file) != 0) {
            there = session(dir, row[i].file);
        }
        if (!there) { continue; }
        quad(dir, said_path(dir, "raw"),
            WORDS("quad", "--raw", "--rate", "1e6", "--a", row[i].a, "--b", row[i].b));
        CHECK(s.status == 0 && strncmp(s.out, row[i].says, strlen(row[i].says)) == 0,
            "%s: %d: %s%s", row[i].file, s.status, s.out, s.err);
        CHECK(s.err[0] == '\0', "%s: %s", row[i].file, s.err);
        /* What counts up with A and B counts down with B and A. */
        quad(dir, said_path(dir, "raw"),
            WORDS("quad", "--raw", "--rate", "1e6", "--a", row[i].b, "--b", row[i].a));
        CHECK(strtol(s.out + 4, NULL, 10) == -strtol(row[i].says + 4, NULL, 10), "%s", s.out);
    }
    said_clean(dir);
}

static void split(int64_t v[4])
{
    CHECK(sscanf(s.out, "net=%" SCNd64 " edges=%" SCNd64 " illegal=%" SCNd64 " min_gap_us=%" SCNd64,
              &v[0], &v[1], &v[2], &v[3]) == 4,
        "%s%s", s.out, s.err);
}

/* Polled too slowly: what is lost is said to be lost. */
TEST(captures_fed_too_slowly_show_their_illegal_steps)
{
    static const struct {
        const char *file, *a, *b, *every;
        int64_t net, illegal;
    } row[] = {
        {ADNS "move_mouse_fast", "4", "3", "200", 96, 22},
        {ADNS "move_mouse_fast", "4", "3", "500", 138, 217},
        {ADNS "move_mouse_fast", "4", "3", "1000", 56, 916},
        {ROTARY "ramp", "0", "1", "25", -12648, 42},
    };
    char *dir = said_dir();
    for (size_t i = 0; i < LEN(row); i++) {
        int64_t v[4];
        if (!session(dir, row[i].file)) { continue; }
        quad(dir, said_path(dir, "raw"),
            WORDS("quad", "--raw", "--rate", "1e6", "--a", row[i].a, "--b", row[i].b, "--every",
                row[i].every));
        CHECK(s.status == 1 && strstr(s.err, "sampled too slowly"), "%d: %s", s.status, s.err);
        split(v);
        CHECK(v[0] == row[i].net && v[2] == row[i].illegal, "%s in %s us: %s", row[i].file,
            row[i].every, s.out);
        CHECK(v[3] == strtol(row[i].every, NULL, 10), "%s", s.out); /* a change in every sample */
    }
    said_clean(dir);
}

TEST(a_capture_as_csv)
{
    char *dir = said_dir();
    if (session(dir, ROTARY "ramp")) {
        FILE *from = fopen(said_path(dir, "raw"), "rb"), *to = fopen(said_path(dir, "csv"), "w");
        int64_t v[4];
        CHECK(from != NULL && to != NULL, "no files");
        fprintf(to, "t_s,a,b\n");
        for (int i = 0, c = fgetc(from); c != EOF; c = fgetc(from), i++) {
            fprintf(to, "%d.%06d,%d,%d\n", i / 1000000, i % 1000000, c & 1, c >> 1 & 1);
        }
        fclose(from);
        fclose(to);
        quad(dir, "/dev/null", WORDS("quad", "--csv", said_path(dir, "csv")));
        CHECK(strcmp(s.out, "net=-12732 edges=12732 illegal=0 min_gap_us=23\n") == 0, "%s%s", s.out,
            s.err);
        quad(dir, "/dev/null",
            WORDS("quad", "--csv", said_path(dir, "csv"), "--x1", "--every", "25"));
        split(v);
        CHECK(v[2] == 42, "%s", s.out);
        quad(dir, "/dev/null", WORDS("quad", "--csv", said_path(dir, "csv"), "--x1"));
        split(v);
        CHECK(v[0] == -12732 / 4 && v[1] == 12732, "%s", s.out);
    }
    said_clean(dir);
}

/* Four reversals: of 2 s, the count's ends lie at odd eighths. */
TEST(a_sine_goes_from_end_to_end)
{
    char *dir = said_dir();
    if (session(dir, ROTARY "sin")) {
        int64_t lo = 0, hi = 0;
        for (int eighth = 1; eighth < 8; eighth += 2) {
            int64_t v[4];
            CHECK_EQ_I64(truncate(said_path(dir, "raw"), 2000000 / 8 * (8 - eighth)), 0);
            quad(dir, said_path(dir, "raw"),
                WORDS("quad", "--raw", "--rate", "1e6", "--a", "0", "--b", "1"));
            split(v);
            lo = v[0] < lo ? v[0] : lo;
            hi = v[0] > hi ? v[0] : hi;
        }
        CHECK(lo == -127 && hi == 127, "%" PRId64 "..%" PRId64, lo, hi);
    }
    said_clean(dir);
}

/* --- the same by other ways ------------------------------------------------------------- */

#define WALK 20000

/* A walk of our own on bits 5 and 3 of noise, index on bit 0 once in 1000 samples: DIR/walk. */
static void walk(const char *dir, uint8_t byte[WALK], int64_t *net, int64_t *index_cnt)
{
    static const uint8_t gray[4] = {0, 1, 3, 2};
    unsigned at = 0, way = 1;
    *net = *index_cnt = 0;
    for (int i = 0; i < WALK; i++) {
        const uint64_t r = check_u64();
        const unsigned ab = gray[at & 3];
        const int index = i % 1000 == 500;
        byte[i] = (uint8_t)((r & 0xD6) | (ab >> 1) << 5 | (ab & 1) << 3 | (unsigned)index);
        *net = (int)at;
        if (index) { *index_cnt = (int)at; }
        if (r >> 32 & 1) { at += way; }
        if ((r >> 40 & 0xFF) == 0) { way = 0u - way; }
    }
    make_file(dir, "walk", byte, WALK);
}

/* Rows of every kind that is allowed. */
static const char *as_csv(const char *dir, const uint8_t byte[WALK], int with_time, const char *end)
{
    const char *path = said_path(dir, "walk.csv");
    FILE *f = fopen(path, "wb");
    CHECK(f != NULL, "%s", path);
    fprintf(f, "\xEF\xBB\xBF# a walk%s; by ourselves%s%s%s%s", end, end, with_time ? "time_s," : "",
        "A,B", end);
    for (int i = 0; i < WALK; i++) {
        if (with_time) { fprintf(f, i % 2 ? "%.6f," : "%.9e ,", (i - 10000) * 4e-6); }
        fprintf(f, i % 3 ? "%d,%d%s" : " %d , %d %s", byte[i] >> 5 & 1, byte[i] >> 3 & 1,
            i == WALK - 1 ? "" : end);
    }
    fclose(f);
    return path;
}

/* The exit status that is due. */
static int finds_illegal(void) { return strstr(s.out, " illegal=0 ") == NULL; }

TEST(csv_bytes_and_truth_agree)
{
    static const char *const every[] = {"1", "7", "5000", "1000000"};
    static const char *const end[] = {"\n", "\r\n", "\r"};
    char *dir = said_dir();
    uint8_t byte[WALK];
    char want[200];
    int64_t net, index_cnt;
    walk(dir, byte, &net, &index_cnt);
    for (size_t i = 0; i < LEN(every) * LEN(end); i++) {
        const char *const n = every[i / LEN(end)];
        int64_t v[4];
        quad(dir, said_path(dir, "walk"),
            WORDS("quad", "--raw", "--rate", "250000", "--a", "5", "--b", "3", "--every", n));
        CHECK(s.status == finds_illegal(), "%d: %s", s.status, s.err);
        strcpy(want, s.out);
        if (i == 0) {
            split(v);
            CHECK(v[0] == net && v[2] == 0 && v[3] == 4, "%s, not %" PRId64, s.out, net);
        }
        quad(dir, "/dev/null",
            WORDS("quad", "--csv", as_csv(dir, byte, 1, end[i % LEN(end)]), "--every", n));
        CHECK(s.status == finds_illegal() && strcmp(s.out, want) == 0, "time, %s: %snot %s%s", n,
            s.out, want, s.err);
        quad(dir, as_csv(dir, byte, 0, end[i % LEN(end)]),
            WORDS("quad", "--csv", "-", "--rate=250000", "--every", n));
        CHECK(s.status == finds_illegal() && strcmp(s.out, want) == 0, "rate, %s: %snot %s%s", n,
            s.out, want, s.err);
    }
    CHECK(strcmp(want, "net=0 edges=0 illegal=0 min_gap_us=-\n") == 0, "one sample: %s", want);
    said_clean(dir);
}

TEST(index_is_printed_when_asked_for)
{
    char *dir = said_dir();
    uint8_t byte[WALK];
    char want[200];
    int64_t net, index_cnt;
    walk(dir, byte, &net, &index_cnt);
    quad(dir, said_path(dir, "walk"),
        WORDS("quad", "--raw", "--rate", "1", "--a", "5", "--b", "3", "--index", "0"));
    snprintf(
        want, sizeof want, " min_gap_us=1000000 index_cnt=%" PRId64 " indices=20\n", index_cnt);
    CHECK(s.status == 0 && strstr(s.out, want) && strtol(s.out + 4, NULL, 10) == net, "%s, not%s",
        s.out, want);
    quad(dir, make_file(dir, "none", "\1\1\3\2", 4),
        WORDS("quad", "--raw", "--rate", "1", "--a", "1", "--b", "0", "--index", "7"));
    CHECK(strcmp(s.out, "net=2 edges=2 illegal=0 min_gap_us=1000000 index_cnt=- indices=0\n") == 0,
        "%s", s.out);
    said_clean(dir);
}

/* Up 00 01 11 10 00, then one step back. */
TEST(modes_and_small_inputs)
{
    static const struct {
        const char *byte;
        size_t n;
        const char *mode, *rate, *says;
        const char *warns;
    } row[] = {
        {"\0\1\3\2\0\2", 6, "--x4", "1e6", "net=3 edges=5 illegal=0 min_gap_us=1\n", ""},
        {"\0\1\3\2\0\2", 6, "--x2", "1e6", "net=1 edges=5 illegal=0 min_gap_us=1\n", ""},
        {"\0\1\3\2\0\2", 6, "--x1", "1e6", "net=1 edges=5 illegal=0 min_gap_us=1\n", ""},
        {"\0\1\3\2\0\2", 6, "--x4", "3", "net=3 edges=5 illegal=0 min_gap_us=333333.333\n", ""},
        {"\0\1\3\2\0\2", 6, "--x4", "1e9", "net=3 edges=5 illegal=0 min_gap_us=0.001\n", ""},
        {"\0\1\1\1\3\3\2", 7, "--x4", "8e5", "net=3 edges=3 illegal=0 min_gap_us=2.5\n", ""},
        {"\2", 1, "--x4", "1e6", "net=0 edges=0 illegal=0 min_gap_us=-\n", ""},
        {"\2\2\2", 3, "--x4", "1e6", "net=0 edges=0 illegal=0 min_gap_us=-\n", ""},
        {"\2\3\3", 3, "--x4", "1e6", "net=-1 edges=1 illegal=0 min_gap_us=-\n", ""},
        {"\2\1\1\3", 4, "--x4", "1e6", "net=1 edges=1 illegal=1 min_gap_us=2\n", "1 of 2 changes"},
        {"\2\1\2\1", 4, "--x1", "1e6", "net=0 edges=0 illegal=3 min_gap_us=1\n", "3 of 3 changes"},
    };
    char *dir = said_dir();
    for (size_t i = 0; i < LEN(row); i++) {
        quad(dir, make_file(dir, "in", row[i].byte, row[i].n),
            WORDS("quad", "--raw", "--rate", row[i].rate, "--a", "1", "--b", "0", row[i].mode));
        CHECK(s.status == finds_illegal() && strcmp(s.out, row[i].says) == 0, "row %zu: %d: %s%s",
            i, s.status, s.out, s.err);
        CHECK(row[i].warns[0] ? strstr(s.err, row[i].warns) != NULL : s.err[0] == '\0',
            "row %zu: %s", i, s.err);
    }
    said_clean(dir);
}

/* --- what is refused --------------------------------------------------------------------- */

#define RAW "quad", "--raw", "--rate", "1e6"

TEST(options_that_make_no_sense)
{
    static const struct {
        const char *word[12];
        const char *says;
    } row[] = {
        {{"quad"}, "no input"},
        {{RAW, "--csv", "x", "--a", "0", "--b", "1"}, "--raw, --csv"},
        {{"quad", "--raw", "--a", "0", "--b", "1"}, "--rate HZ"},
        {{RAW, "--b", "1"}, "--a BIT"},
        {{RAW, "--a", "1"}, "--b BIT"},
        {{RAW, "--a", "1", "--b", "1"}, "the same bit"},
        {{RAW, "--a", "8", "--b", "1"}, "--a: 8 (allowed 0..7)"},
        {{RAW, "--a", "0", "--b", "-1"}, "--b: -1 (allowed 0..7)"},
        {{RAW, "--a", "0", "--b", "B"}, "--b: B"},
        {{RAW, "--a", "0", "--b", "1", "--index", "8"}, "--index: 8"},
        {{RAW, "--a", "0", "--b", "1", "--index", "1"}, "--index"},
        {{RAW, "--a", "0", "--b", "1", "--index", "0"}, "--index"},
        {{RAW, "--a", "0", "--b", "1", "--every", "0"}, "--every: 0"},
        {{RAW, "--a", "0", "--b", "1", "--x1", "--x4"}, "--x1, --x2, --x4"},
        {{RAW, "--a", "0", "--b", "1", "--x2", "--x1"}, "--x1, --x2, --x4"},
        {{RAW, "--a", "0", "--b", "1", "file"}, "one word too many"},
        {{"quad", "--raw", "--rate", "0", "--a", "0", "--b", "1"},
            "--rate: 0 (allowed 1..1000000000)"},
        {{"quad", "--raw", "--rate", "1e10", "--a", "0", "--b", "1"}, "--rate: 1e10"},
        {{"quad", "--raw", "--rate", "nan", "--a", "0", "--b", "1"}, "--rate: nan"},
        {{"quad", "--csv", "x", "--a", "0"}, "for --raw alone"},
        {{"quad", "--csv", "x", "--index", "0"}, "for --raw alone"},
    };
    char *dir = said_dir();
    make_file(dir, "in", "\0\1\3\2", 4);
    for (size_t i = 0; i < LEN(row); i++) {
        quad(dir, said_path(dir, "in"), row[i].word);
        CHECK(s.status == 2 && strstr(s.err, row[i].says) && s.out[0] == '\0', "row %zu: %d: %s%s",
            i, s.status, s.out, s.err);
        CHECK(
            strncmp(s.err, "exhand quad: ", 13) == 0 && strchr(s.err, '\n') == strrchr(s.err, '\n'),
            "row %zu: %s", i, s.err);
    }
    said_clean(dir);
}

TEST(input_that_is_none)
{
    static const struct {
        const char *csv, *says;
    } row[] = {
        {"", "holds no sample"},
        {"time,a,b\r\n", "holds no sample"},
        {"0,1,0\n1,1", "line 2: a is not"},
        {"0,1,0\n1,1,\n", "line 2: b is not"},
        {"0,1,0\n0.", "line 2: no time"},
        {"t,a,b\n0,1,0\n0,1,1\n", "line 3: time does not rise"},
        {"0,1,0\n-1,1,1\n", "line 2: time does not rise"},
        {"0,1,0\n1e-10,1,1\n", "line 2: time does not rise by 1 ns"},
        {"0,2,0\n", "line 1: a is not"},
        {"0,1,10\n", "line 1: b is not"},
        {"0,1,0,1\n", "line 1: b is not"},
        {"0;1;0\n", "line 1: no time"},
        {"0,1,0\nt,a,b\n", "line 2: no time"},
        {"t,a,b\nt,a,b\n", "line 2: no time"},
        {"1.7e9,1,0\n", "line 1: time beyond"},
        {"0,1,0\nnan,1,0\n", "line 2: time beyond"},
        {"nan,1,0\n1,1,1\n", "line 1: time beyond"},
        {"0,1,0\r\n1,1,1\r2,1,x\r", "line 3: b is not"},
        {"PK\3\4xx", "unzip -p"},
    };
    char *dir = said_dir();
    char wide[400];
    for (size_t i = 0; i < LEN(row); i++) {
        quad(dir, "/dev/null",
            WORDS("quad", "--csv", make_file(dir, "in.csv", row[i].csv, strlen(row[i].csv))));
        CHECK(s.status == 2 && strstr(s.err, row[i].says) && s.out[0] == '\0', "row %zu: %d: %s%s",
            i, s.status, s.out, s.err);
    }
    quad(dir, "/dev/null", WORDS("quad", "--csv", make_file(dir, "in.csv", "0,1,1\0,9\n", 9)));
    CHECK(s.status == 2 && strstr(s.err, "line 1: b is not"), "what a NUL hides: %d: %s", s.status,
        s.err);
    memset(wide, ' ', sizeof wide);
    quad(dir, "/dev/null", WORDS("quad", "--csv", make_file(dir, "in.csv", wide, sizeof wide)));
    CHECK(s.status == 2 && strstr(s.err, "line 1: far too long"), "%d: %s", s.status, s.err);
    quad(dir, "/dev/null",
        WORDS("quad", "--csv", make_file(dir, "in.csv", "0,1,1\n", 6), "--rate", "5"));
    CHECK(s.status == 2 && strstr(s.err, "line 1: b is not"), "%d: %s", s.status, s.err);
    quad(dir, "/dev/null", WORDS("quad", "--csv", said_path(dir, "gone.csv")));
    CHECK(s.status == 3 && strstr(s.err, "gone.csv: No such file"), "%d: %s", s.status, s.err);
    quad(dir, "/dev/null", WORDS("quad", "--csv", dir));
    CHECK(s.status == 3 && strstr(s.err, "directory"), "%d: %s", s.status, s.err);
    quad(dir, dir, WORDS(RAW, "--a", "0", "--b", "1"));
    CHECK(s.status == 3 && strstr(s.err, "standard input: "), "%d: %s", s.status, s.err);
    quad(dir, "/dev/null", WORDS(RAW, "--a", "0", "--b", "1"));
    CHECK(s.status == 2 && strstr(s.err, "standard input: holds no sample"), "%d: %s", s.status,
        s.err);
    quad(dir, make_file(dir, "in", "PK\3\4xx", 6), WORDS(RAW, "--a", "0", "--b", "1"));
    CHECK(s.status == 2 && strstr(s.err, "unzip -p FILE.sr"), "%d: %s", s.status, s.err);
    said_clean(dir);
}

/* --- positions -------------------------------------------------------------------- */

TEST(recorded_positions_are_counts_again)
{
    static const char rows[] = "t, other, theta\n0, 9, 0\n1, 9, -0.25\n2, 9, -0.25\n"
                               "3, 9, 0.50\n4, 9, 1.75\n";
    static const struct {
        const char *column, *step;
        int status;
        const char *says;
    } row[] = {
        {"theta", "0.25", 0, "rows=5 net=7 low=-1 high=7 most=5 still=25.0% off=0\n"},
        {"3", "0.25", 0, "rows=5 net=7 low=-1 high=7 most=5 still=25.0% off=0\n"},
        {"theta", "0.245", 0, "off=0.14\n"},
        {"theta", "1", 2, "line 5: not a whole count: give --step"},
        {"alpha", "1", 2, "its first line has no alpha"},
        {"4", "1", 2, "line 2: no number in the column of --position"},
    };
    char *dir = said_dir();
    const char *csv = make_file(dir, "rows.csv", rows, sizeof rows - 1);
    for (size_t i = 0; i < LEN(row); i++) {
        said(&s, dir, cli_quad,
            WORDS("quad", "--csv", csv, "--position", row[i].column, "--step", row[i].step));
        CHECK(s.status == row[i].status && strstr(i < 3 ? s.out : s.err, row[i].says),
            "%zu: %d %s%s", i, s.status, s.out, s.err);
    }
    said(&s, dir, cli_quad, WORDS("quad", "--position", "theta", "--raw"));
    CHECK(s.status == 2 && strstr(s.err, "--position: goes with --csv FILE"), "%s", s.err);
    said_clean(dir);
}

/* Recorded 512 lines x 4, as its description has it: at most 4 counts a sample, 54 % without one.
 */
TEST(a_recorded_motor_is_whole_counts)
{
    const char *data = getenv("EXH_DATA") ? getenv("EXH_DATA") : "$EXH_DATA";
    char *dir = said_dir(), path[512];
    (void)snprintf(path, sizeof path, "%s/motor-encoder-qube/qube_150615.csv", data);
    if (access(path, R_OK) != 0) {
        check_note("%s: not there: not tested", path);
    } else {
        said(&s, dir, cli_quad,
            WORDS("quad", "--csv", path, "--position", "theta", "--step", "0.00306796157577"));
        CHECK(s.status == 0 && strstr(s.out, "rows=10000 ") && strstr(s.out, " most=4 still=53.9%"),
            "%d %s%s", s.status, s.out, s.err);
    }
    said_clean(dir);
}

TEST_MAIN("quad_command", recorded_positions_are_counts_again, a_recorded_motor_is_whole_counts,
    captures_decode_to_their_descriptions, captures_fed_too_slowly_show_their_illegal_steps,
    a_capture_as_csv, a_sine_goes_from_end_to_end, csv_bytes_and_truth_agree,
    index_is_printed_when_asked_for, modes_and_small_inputs, options_that_make_no_sense,
    input_that_is_none);
