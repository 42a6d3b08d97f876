/* SPDX-License-Identifier: MIT */
/* exhand glove --record: logs that are as long as they should be and replay bit for bit. */
#include "glove_said.h"

#include "base/logfile.h"

#include "glove/glove.h"
#include "exhand/run/log.h"
#include "sim/operator.h"

#include "exhand/record.h"

static struct said s;

/* Column i of the last line of a CSV file. */
static double last_value(const char *path, int column)
{
    static char text[4096];
    FILE *f = fopen(path, "r");
    char *at;
    double v = -1e9;
    size_t n;
    CHECK(f != NULL && fseek(f, -4000, SEEK_END) == 0, "%s", path);
    n = fread(text, 1, sizeof text - 1, f);
    fclose(f);
    text[n] = '\0';
    if (n > 0) { text[n - 1] = '\0'; }
    at = strrchr(text, '\n');
    CHECK(at != NULL, "%s: one line", path);
    for (int i = 0; at && i <= column; i++) { v = strtod(at + 1, &at); }
    return v;
}

/* ---- Logs ----------------------------------------------------------------------------------- */

static void replay_from(const char *dir, const char *log, const char *from, int status)
{
    said(&s, dir, cli_replay, WORDS("replay", log, "--from", from));
    CHECK(s.status == status, "from %s: %d: %s%s", from, s.status, s.out, s.err);
}

/* Also where the glove runs at a fraction of the loop's rate, and with a scan that does not
 * fit into a tick. */
TEST(a_log_replays_bit_for_bit_from_any_keyframe)
{
    static const struct {
        const char *rate, *every, *does, *device;
    } row[] = {{"2000", "every=1", "poses", "seed=1"}, {"2000", "every=7", "grasp", "noise=0.02"},
        {"90", "every=1", "wave", "couple=0.2"}, {"20000", "every=3", "grasp", "interval=0.00002"}};
    char *dir = said_dir();
    for (size_t i = 0; i < LEN(row); i++) {
        const char *log = said_path(dir, "glove.exh");
        const char *device = i ? row[i].device : "noise=0.0061";
        said(&s, dir, cli_glove,
            WORDS("glove", "--record", log, "--rate", row[i].rate, "--set", row[i].every, "--does",
                row[i].does, "--device", device, "--seconds",
                i == 2   ? "30"
                : i == 3 ? "0.3"
                         : "3",
                i == 2 ? "--set" : "--seed", i == 2 ? "glove_fc=20" : "5"));
        CHECK(s.status == 0, "row %zu: %d: %s", i, s.status, s.err);
        replay_from(dir, log, "0", 0);
        CHECK(strstr(s.out, " identical") != NULL, "%s", s.out);
        replay_from(dir, log, "1", 0);
        replay_from(dir, log, "1024", 0);
        CHECK(strstr(s.out, "from tick 1024") != NULL, "%s", s.out);
        replay_from(dir, log, "2600", 0);
        CHECK(strstr(s.out, "from tick 2048") != NULL, "%s", s.out);
    }
    said_clean(dir);
}

static long size_of_file(const char *path)
{
    struct stat st;
    return stat(path, &st) == 0 ? (long)st.st_size : -1;
}

/* What is refused leaves the log that is there; less than a tick is one, not without end; and
 * what is played is played to its end. */
TEST(a_record_is_as_long_as_it_should_be)
{
    static char text[SAID_B];
    char *dir = said_dir();
    const char *log = said_path(dir, "glove.exh"), *csv = said_path(dir, "in.csv");
    long size;
    said(
        &s, dir, cli_glove, WORDS("glove", "--record", log, "--rate", "100", "--seconds", "0.001"));
    CHECK(s.status == 0, "%d: %s", s.status, s.err);
    said(&s, dir, cli_replay, WORDS("replay", log));
    CHECK(s.status == 0 && strstr(s.out, ": 1 ticks "), "%s%s", s.out, s.err);
    size = size_of_file(log);
    said(&s, dir, cli_glove, WORDS("glove", "--record", log, "--set", "glove_fc=5000"));
    CHECK(
        s.status == 2 &&
            strstr(s.err, "glove_fc: 5000 Hz (below half the rate of 2000 Hz): --set glove_fc=500"),
        "%d: %s", s.status, s.err);
    CHECK_EQ_I64(size_of_file(log), size);
    for (int n = 0; n < 150; n++) { strcat(text, ROW_A "\n"); }
    write_text(csv, text);
    said(&s, dir, cli_glove,
        WORDS("glove", "--record", log, "--play", csv, "--rate", "70", "--set", "glove_fc=9"));
    CHECK(s.status == 0 && s.err[0] == '\0', "%d: %s", s.status, s.err);
    said(&s, dir, cli_replay, WORDS("replay", log));
    CHECK(s.status == 0 && strstr(s.out, ": 150 ticks "), "%s%s", s.out, s.err);
    said(
        &s, dir, cli_glove, WORDS("glove", "--record", log, "--rate", "20000", "--seconds", "0.1"));
    CHECK(s.status == 0 && strstr(s.err, "1000 frames in 2000 ticks: a scan takes longer"), "%s",
        s.err);
    said_clean(dir);
}

/* One code of one frame changed, its CRC made good: the replay names the signal, and the tick
 * at which the filter has come out of the hysteresis with it. */
TEST(a_changed_code_is_found)
{
    char *dir = said_dir();
    const char *log = said_path(dir, "glove.exh");
    struct logfile l;
    struct exh_record r;
    FILE *f;
    said(&s, dir, cli_glove, WORDS("glove", "--record", log, "--seconds", "0.3"));
    CHECK_EQ_I64(s.status, 0);
    CHECK_EQ_I64(logfile_open(&l, log), 0);
    while (logfile_next(&l, &r) && !(r.type == EXH_RECORD_FRAME && r.tick == 77)) {}
    {
        uint8_t *record = l.bytes + (r.payload - l.bytes) - 14;
        struct exh_bytes c = exh_bytes_writer(record + 14 + r.len_B, 4);
        uint32_t crc;
        record[14 + 6 + 3 + 2 * 5 + 1] ^= 0x20; /* supply, din; new, age; code 5, high byte */
        crc = exh_crc32(0, record, 14u + r.len_B);
        exh_bytes_u32(&c, &crc);
    }
    f = fopen(log, "r+b");
    CHECK(f != NULL && fseek(f, (long)l.at - 18 - r.len_B, SEEK_SET) == 0, "write");
    CHECK(fwrite(r.payload - 14, 1, 18u + r.len_B, f) == 18u + r.len_B, "write");
    fclose(f);
    logfile_close(&l);
    replay_from(dir, log, "0", 1);
    CHECK(strstr(s.out, "tick 78: index_pij: recorded") != NULL, "%s", s.out);
    said_clean(dir);
}

/* The scene's angles are the operator's, within the quantizer's (Q + H)/2 = 26 codes. */
TEST(angles_are_those_of_the_hand)
{
    char *dir = said_dir();
    const char *log = said_path(dir, "glove.exh"), *csv = said_path(dir, "glove.csv");
    for (int pose = 0; pose < sim_poses; pose++) {
        said(&s, dir, cli_glove,
            WORDS("glove", "--record", log, "--seconds", "0.05", "--pose", sim_pose[pose].name,
                "--device", "couple=0"));
        CHECK(s.status == 0, "%d: %s", s.status, s.err);
        said(&s, dir, cli_csv, WORDS("csv", log, "--all", "--out", csv));
        CHECK(s.status == 0, "%d: %s", s.status, s.err);
        for (int i = 0; i < SENSORS; i++) {
            const struct sim_glove_sensor *n = &sim_glove_sensor[i];
            const double deg_per_code = (n->hi_deg - n->lo_deg) / ((n->hi - n->lo) * 18 * 3276.8);
            const double off = last_value(csv, i + 1) * 360 - sim_pose[pose].deg[i];
            const double codes = off / deg_per_code;
            CHECK(codes < 27 && codes > -27, "%s, %s: %.3f deg off, %.1f codes",
                sim_pose[pose].name, n->name, off, codes);
        }
        CHECK(last_value(csv, SENSORS + 1) == 0, "faults: %s", sim_pose[pose].name);
    }
    said_read(s.out, csv);
    CHECK(strstr(s.out, ",age,raw0,") && strstr(s.out, ",raw21\n"), "the codes are in it");
    said_clean(dir);
}

/* Rows of angles through the analog chain: each is reached where it is held. */
TEST(a_recording_moves_the_simulated_hand)
{
    char *dir = said_dir();
    char text[30000] = "";
    const char *csv = said_path(dir, "in.csv"), *log = said_path(dir, "glove.exh");
    for (int k = 0; k < 100; k++) { /* half a second flat, half with the index bent by 1 rad */
        for (int i = 0; i < SENSORS; i++) {
            strcat(text, i == 5 && k >= 50 ? "1.0" : "0.0");
            strcat(text, i < 21 ? "," : "\r\n");
        }
    }
    write_text(csv, text);
    said(&s, dir, cli_glove,
        WORDS("glove", "--record", log, "--play", csv, "--rate", "100", "--seconds", "1", "--set",
            "glove_fc=20"));
    CHECK(s.status == 0, "%d: %s", s.status, s.err);
    said(&s, dir, cli_csv, WORDS("csv", log, "--out", csv));
    CHECK(s.status == 0, "%d: %s", s.status, s.err);
    for (int i = 0; i < SENSORS; i++) {
        const double rad = last_value(csv, i + 1) * 6.283185307;
        CHECK(rad > (i == 5) - 0.03 && rad < (i == 5) + 0.03, "column %d: %g", i, rad);
    }
    replay_from(dir, log, "0", 0);
    write_text(csv, text); /* and not before its time */
    said(&s, dir, cli_glove,
        WORDS("glove", "--record", log, "--play", csv, "--rate", "100", "--seconds", "0.49",
            "--set", "glove_fc=20"));
    said(&s, dir, cli_csv, WORDS("csv", log, "--out", csv));
    CHECK(s.status == 0 && last_value(csv, 6) < 0.005, "%g turn", last_value(csv, 6));
    said_clean(dir);
}

TEST_MAIN("glove_log", a_log_replays_bit_for_bit_from_any_keyframe,
    a_record_is_as_long_as_it_should_be, a_changed_code_is_found, angles_are_those_of_the_hand,
    a_recording_moves_the_simulated_hand);
