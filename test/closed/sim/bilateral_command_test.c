/* SPDX-License-Identifier: MIT */
/* exhand bilateral as people use and misuse it: logs that replay, tables, files, scenes, recorded
 * hands. */
#include "said.h"
#include "lab/lab.h"

#include "exhand/record.h"

/* ---- Logs ---------------------------------------------------------------------------------- */

/* What the world asks for and what it gets of it, over a link that loses: the log sends the same
 * again, from its keyframes, too. */
TEST(a_log_with_a_trace_over_the_link_replays)
{
    const char *dir = said_dir();
    static struct said s;
    char log[512];
    unsigned long frames = 0, every = 0, missed = 0;
    const char *line;
    snprintf(log, sizeof log, "%s/bilateral_natural.exh", dir);
    said(&s, dir, cli_bilateral,
        WORDS("bilateral", "--speed", "natural", "--approaches", "2", "--trace", "3", "--link",
            "delay=0.02,jitter=0.02,loss=0.2,duplicate=0.1", "--out", dir));
    CHECK(s.status == 0, "%d: %s", s.status, s.err);
    line = strstr(s.out, "  trace: ");
    CHECK(line && sscanf(line, "  trace: %lu frames of every %lu", &frames, &every) == 2, "%s",
        s.out);
    CHECK(
        line && sscanf(strstr(line, "; ") ? strstr(line, "; ") : "", "; %lu missed", &missed) == 1,
        "%s", s.out);
    CHECK(every == 3 && frames > 500 && missed > 50, "%lu frames of every %lu, %lu missed", frames,
        every, missed);
    said(&s, dir, cli_replay, WORDS("replay", log));
    CHECK(s.status == 0 && strstr(s.out, "identical"), "%d: %s%s", s.status, s.out, s.err);
    said(&s, dir, cli_replay, WORDS("replay", log, "--from", "2000"));
    CHECK(s.status == 0 && strstr(s.out, "from tick 1024"), "%d: %s%s", s.status, s.out, s.err);
    said_clean(dir);
}

TEST(a_log_replays_bit_for_bit_without_a_world)
{
    const char *dir = said_dir();
    static struct said s;
    char log[512];
    snprintf(log, sizeof log, "%s/bilateral_natural.exh", dir);
    said(&s, dir, cli_bilateral,
        WORDS("bilateral", "--speed", "natural", "--approaches", "2", "--fingers", "index,ring",
            "--scene", "ports/posix/world/scenes/collision.world", "--link",
            "delay=0.02,jitter=0.02,loss=0.2,duplicate=0.1", "--out", dir));
    CHECK(s.status == 0, "%d: %s", s.status, s.err);
    said(&s, dir, cli_replay, WORDS("replay", log));
    CHECK(s.status == 0 && strstr(s.out, "identical"), "%d: %s%s", s.status, s.out, s.err);
    said(&s, dir, cli_replay, WORDS("replay", log, "--from", "2000"));
    CHECK(s.status == 0 && strstr(s.out, "from tick 1024"), "%d: %s%s", s.status, s.out, s.err);
    said_clean(dir);
}

/* Without an option the session comes from the clock. A replay has another clock, so the log has
 * it. */
TEST(a_log_of_a_session_that_was_made_up_replays)
{
    const char *dir = said_dir();
    static struct said s;
    char log[512];
    snprintf(log, sizeof log, "%s/bilateral_natural.exh", dir);
    said(&s, dir, cli_bilateral,
        WORDS("bilateral", "--speed", "natural", "--approaches", "1", "--set", "session=0", "--out",
            dir));
    CHECK(s.status == 0, "%d: %s", s.status, s.err);
    said(&s, dir, cli_replay, WORDS("replay", log));
    CHECK(s.status == 0 && strstr(s.out, "identical"), "%d: %s%s", s.status, s.out, s.err);
    said_clean(dir);
}

/* A packet taken out of a log is missed: it is what the planes came from. */
TEST(a_log_without_a_packet_does_not_replay)
{
    const char *dir = said_dir();
    static struct said s;
    char log[512];
    FILE *f;
    long len;
    uint8_t *bytes, *to;
    uint32_t kept = 0, removed = 0, seen = 0;
    snprintf(log, sizeof log, "%s/bilateral_natural.exh", dir);
    said(&s, dir, cli_bilateral,
        WORDS("bilateral", "--speed", "natural", "--approaches", "1", "--out", dir));
    CHECK(s.status == 0, "%d: %s", s.status, s.err);
    f = fopen(log, "rb");
    CHECK(f && fseek(f, 0, SEEK_END) == 0, "%s", log);
    len = ftell(f);
    rewind(f);
    bytes = malloc((size_t)len);
    to = malloc((size_t)len);
    CHECK(bytes && to && fread(bytes, 1, (size_t)len, f) == (size_t)len, "%s", log);
    fclose(f);
    for (uint32_t at = 0; at < (uint32_t)len;) {
        struct exh_record r;
        const int32_t n = exh_record_decode(bytes + at, (uint32_t)len - at, &r);
        CHECK(n > 0, "at %u", at);
        if (n <= 0) { break; }
        seen += r.type == EXH_RECORD_PACKET;
        if (r.type == EXH_RECORD_PACKET && seen == 40) {
            removed++;
        } else {
            memcpy(to + kept, bytes + at, (size_t)n);
            kept += (uint32_t)n;
        }
        at += (uint32_t)n;
    }
    CHECK(seen > 100 && removed == 1, "%u packets", seen);
    f = fopen(log, "wb");
    CHECK(f && fwrite(to, 1, kept, f) == kept && fclose(f) == 0, "%s", log);
    free(bytes);
    free(to);
    said(&s, dir, cli_replay, WORDS("replay", log));
    CHECK(s.status == 1, "%d: %s%s", s.status, s.out, s.err);
    said_clean(dir);
}

/* ---- The command ----------------------------------------------------------------------------- */

TEST(no_random_approach_is_felt_before_its_freeze)
{
    const char *dir = said_dir();
    static struct said s;
    said(&s, dir, lab_bilateral, WORDS("bilateral", "--check", "50"));
    CHECK(s.status == 0 && strstr(s.out, "50 random approaches") &&
              strstr(s.out, " 0 before the freeze"),
        "%d: %s%s", s.status, s.out, s.err);
    CHECK(strstr(s.out, "foretold by the advice") && strstr(s.out, ", 0 without;"), "%s", s.out);
    said_clean(dir);
}

/* Lines of a file; the first into head, of LINE_B. */
#define LINE_B 512
static long lines_of(const char *path, char *head)
{
    char line[LINE_B];
    long n = 0;
    FILE *f = fopen(path, "r");
    head[0] = '\0';
    if (f == NULL) { return -1; }
    while (fgets(line, sizeof line, f) != NULL) {
        if (n++ == 0) { strcpy(head, line); }
    }
    fclose(f);
    return n;
}

TEST(the_papers_nine_signals_are_logged_tick_by_tick)
{
    const char *dir = said_dir();
    static struct said s;
    char head[LINE_B];
    long n;
    said(&s, dir, cli_bilateral,
        WORDS("bilateral", "--speed", "natural", "--approaches", "1", "--rate", "1000", "--out",
            dir));
    CHECK(s.status == 0, "%d: %s", s.status, s.err);
    n = lines_of(said_path(dir, "bilateral_natural_index.csv"), head);
    CHECK(strcmp(head, "t_s,q_m,qd_m_per_s,f_des_n,i_des_a,c,f_mon_n,d_m,q_lim_m\n") == 0, "%s",
        head);
    CHECK(n > 2000 && n < 4000, "%ld lines", n); /* rest, approach, hold, withdrawal: 2 to 4 s */
    said_clean(dir);
}

TEST(over_hands_there_is_a_row_each)
{
    const char *dir = said_dir();
    static struct said s;
    char head[LINE_B];
    said(&s, dir, lab_bilateral, WORDS("bilateral", "--hands", "--approaches", "1", "--out", dir));
    CHECK(s.status == 0 && strstr(s.out, "paper 25 ms"), "%d: %s%s", s.status, s.out, s.err);
    CHECK_EQ_I64(lines_of(said_path(dir, "hands.csv"), head), 81);
    said_clean(dir);
}

/* After the freeze nothing depends on the world. Without a world in time nothing is felt. */
TEST(a_world_that_dies_or_never_comes_is_told_beside_a_perfect_link)
{
    const char *dir = said_dir();
    static struct said s;
    said(&s, dir, cli_bilateral,
        WORDS("bilateral", "--speed", "natural", "--approaches", "1", "--world-until", "0.76"));
    CHECK(s.status == 0 && strstr(s.out, "index the same bits from the first freeze on"),
        "%d: %s%s", s.status, s.out, s.err);
    said(&s, dir, cli_bilateral,
        WORDS("bilateral", "--speed", "natural", "--approaches", "1", "--world-from", "9"));
    CHECK(s.status == 0 && strstr(s.out, "index felt nothing"), "%d: %s%s", s.status, s.out, s.err);
    said_clean(dir);
}

TEST(a_d_lim_that_is_too_small_is_told_with_the_one_wanted)
{
    const char *dir = said_dir();
    static struct said s;
    said(&s, dir, cli_bilateral,
        WORDS("bilateral", "--speed", "fast", "--approaches", "1", "--set", "d_lim=-0.003"));
    CHECK(s.status == 0 && strstr(s.out, "TOO SMALL: make it -7."), "%d: %s%s", s.status, s.out,
        s.err);
    said_clean(dir);
}

TEST(files_and_tables_are_left_behind)
{
    static const char *const left[] = {"bilateral_natural.exh", "bilateral_natural_index.csv",
        "contacts.csv", "bilateral.gp", "bilateral_natural_index_raw.csv"};
    const char *dir = said_dir();
    static struct said s;
    said(&s, dir, cli_bilateral,
        WORDS("bilateral", "--speed", "natural", "--approaches", "2", "--out", dir));
    CHECK(s.status == 0, "%d: %s", s.status, s.err);
    CHECK(strstr(s.out, "; paper 41250\n") && strstr(s.out, "; paper 25.0\n") &&
              strstr(s.out, "; paper 0.825\n") && strstr(s.out, ": 16 approaches of 8 seeds, "),
        "%s", s.out);
    for (size_t i = 0; i < LEN(left); i++) {
        struct stat st;
        CHECK(stat(said_path(dir, left[i]), &st) == 0 && st.st_size > 0, "%s", left[i]);
    }
    said_clean(dir);
}

/* The numbers of a finger's line in the session's table: contacts, s, N. */
static void session_of(const char *text, const char *finger, double v[3])
{
    char word[32];
    const char *at = strstr(text, "finger      string");
    double skip[6];
    snprintf(word, sizeof word, "\n  %s ", finger);
    at = at ? strstr(at, word) : NULL;
    CHECK(at != NULL, "no %s in %s", finger, text);
    if (at == NULL ||
        sscanf(at + strlen(word), "%lf ..%lf %lf ..%lf %lf ..%lf %lf %lf %lf", &skip[0], &skip[1],
            &skip[2], &skip[3], &skip[4], &skip[5], &v[0], &v[1], &v[2]) != 9) {
        CHECK(0, "%s: not nine numbers", finger);
        v[0] = v[1] = v[2] = -1;
    }
}

TEST(a_rehabilitation_session_keeps_each_fingers_force_cap)
{
    static const struct {
        const char *finger;
        double cap_N;
    } row[] = {{"index", 5}, {"middle", 5}, {"ring", 4}, {"little", 3}};
    const char *dir = said_dir();
    static struct said s;
    said(&s, dir, cli_bilateral,
        WORDS("bilateral", "--scene", "ports/posix/world/scenes/rehabilitation.world", "--fingers",
            "all", "--speed", "natural", "--approaches", "2"));
    CHECK(s.status == 0, "%d: %s", s.status, s.err);
    for (size_t i = 0; i < LEN(row); i++) {
        double v[3];
        session_of(s.out, row[i].finger, v);
        CHECK(v[0] >= 2 && v[1] > 1, "%s: %g contacts of %g s", row[i].finger, v[0], v[1]);
        CHECK(v[2] > 0.5 * row[i].cap_N && v[2] <= row[i].cap_N + 0.005, "%s: %g N", row[i].finger,
            v[2]);
    }
    said_clean(dir);
}

TEST(every_scene_of_simple_bodies_runs)
{
    static const char *const scene[] = {"collision", "explore", "grasp", "rehabilitation"};
    const char *dir = said_dir();
    static struct said s;
    for (size_t i = 0; i < LEN(scene); i++) {
        char path[128];
        snprintf(path, sizeof path, "ports/posix/world/scenes/%s.world", scene[i]);
        said(&s, dir, cli_bilateral,
            WORDS("bilateral", "--scene", path, "--fingers", "all", "--speed", "0.3",
                "--approaches", "1", "--link", "delay=0.01,jitter=0.005"));
        CHECK(s.status == 0 && strstr(s.out, "largest force"), "%s: %d: %s", scene[i], s.status,
            s.err);
    }
    said_clean(dir);
}

/* Four fingers glide over it for a second and more of an approach; the thumb lies beside it. */
TEST(a_shape_is_felt_by_the_fingers_that_glide_over_it)
{
    static const char *const finger[] = {"index", "middle", "ring", "little"};
    const char *dir = said_dir();
    static struct said s;
    said(&s, dir, cli_bilateral,
        WORDS("bilateral", "--scene", "ports/posix/world/scenes/explore.world", "--fingers", "all",
            "--speed", "0.3", "--approaches", "1"));
    CHECK(s.status == 0, "%d: %s", s.status, s.err);
    for (size_t i = 0; i < LEN(finger); i++) {
        double v[3];
        session_of(s.out, finger[i], v);
        CHECK(v[0] >= 1 && v[1] > 1 && v[2] > 2 && v[2] <= 8.005, "%s: %g contacts of %g s, %g N",
            finger[i], v[0], v[1], v[2]);
    }
    said_clean(dir);
}

/* A flat side comes into a finger's view when its pad is inside already: there is no way before the
 * touch to find s by. */
TEST(what_comes_into_view_around_a_finger_ends_no_run)
{
    const char *dir = said_dir(), *path = said_path(dir, "near.world");
    static struct said s;
    FILE *f = fopen(path, "w");
    CHECK(f != NULL, "%s", path);
    fputs("look ahead 0.08\nhand at -0.03 -0.145 0.072 palm 0 0 -1 point 0 1 0\nmaterial m\n"
          "capsule ridge at -0.045 0.01 0.004 rpy 90 0 15 radius 0.014 length 0.09 material m\n",
        f);
    CHECK_EQ_I64(fclose(f), 0);
    said(&s, dir, cli_bilateral,
        WORDS("bilateral", "--scene", path, "--fingers", "all", "--speed", "0.3", "--approaches",
            "1"));
    CHECK(s.status == 0, "%d: %s", s.status, s.err);
    said_clean(dir);
}

TEST(a_recorded_hand_moves_the_fingers)
{
    const char *dir = said_dir(), *path = said_path(dir, "rows.csv");
    static struct said s;
    double v[3];
    FILE *f = fopen(path, "w");
    CHECK(f != NULL, "%s", path);
    for (int n = 0; n < 300;
         n++) { /* opens and closes twice, knuckle and middle joint of the index */
        const double bent = n % 150 < 75 ? n % 150 / 75.0 : 2 - n % 150 / 75.0;
        for (int i = 0; i < 22; i++) {
            fprintf(f, "%s%.4f", i ? "," : "", i == 4 || i == 5 ? bent : i == 6 ? 0.5 * bent : 0);
        }
        fputc('\n', f);
    }
    CHECK_EQ_I64(fclose(f), 0);
    said(&s, dir, cli_bilateral,
        WORDS("bilateral", "--record", path, "--record-rate", "100", "--at", "0.02"));
    CHECK(s.status == 0, "%d: %s", s.status, s.err);
    session_of(s.out, "index", v);
    CHECK(v[0] >= 2 && v[1] > 0.5 && v[2] > 1, "%g contacts, %g s, %g N", v[0], v[1], v[2]);
    said(&s, dir, cli_bilateral, WORDS("bilateral", "--record", "/none"));
    CHECK(s.status == 3 && strstr(s.err, "/none"), "%d: %s", s.status, s.err);
    said_clean(dir);
}

TEST(bad_usage_is_refused_by_name)
{
    static const struct {
        const char *option, *value, *says;
    } bad[] = {
        {"--speed", "quick", "quick"},
        {"--speed", "", "--speed"},
        {"--fingers", "toe", "toe"},
        {"--link", "delay", "delay"},
        {"--link", "colour=3", "colour"},
        {"--link", "delay=.1,loss=0,delay=.2", "delay: it comes twice"},
        {"--link", "loss=2", "0..1"},
        {"--link", "trace=/none", "--link: trace: /none"},
        {"--set", "d_lim=1", "d_lim"},
        {"--set", "fingers=3", "--fingers"},
        {"--device", "speed=1", "--speed"},
        {"--device", "tail=1", "tail"},
        {"--scene", "/none.world", "/none.world"},
        {"--at", "1", "--at"},
        {"--rate", "0", "--rate"},
        {"--rate", "90",
            "glove_fc: 200 Hz (below half the rate of 90 Hz): --set glove_fc=22.5 would do"},
        {"--nonsense", "1", "--nonsense"},
    };
    const char *dir = said_dir();
    static struct said s;
    for (size_t i = 0; i < LEN(bad); i++) {
        said(&s, dir, cli_bilateral, WORDS("bilateral", bad[i].option, bad[i].value));
        CHECK(s.status == 2 && strstr(s.err, bad[i].says), "%s %s: %d: %s", bad[i].option,
            bad[i].value, s.status, s.err);
    }
    said(&s, dir, cli_bilateral,
        WORDS("bilateral", "--device", "rotor=0.0001", "--device", "substep=0.0001"));
    CHECK(s.status == 2 && strstr(s.err, "give --device substep=1e-05"), "%d: %s", s.status, s.err);
    said(&s, dir, lab_bilateral, WORDS("bilateral", "--help"));
    CHECK(s.status == 0 && strstr(s.out, "--sweep") && strstr(s.out, "--udp"), "%d: %s", s.status,
        s.err);
    said(&s, dir, cli_bilateral, WORDS("bilateral", "--params"));
    CHECK(s.status == 0 && strstr(s.out, "mat_k") && strstr(s.out, "hand_k"), "%d: %s", s.status,
        s.err);
    said_clean(dir);
}

TEST_MAIN("bilateral_command", a_log_with_a_trace_over_the_link_replays,
    a_log_replays_bit_for_bit_without_a_world, a_log_of_a_session_that_was_made_up_replays,
    a_log_without_a_packet_does_not_replay, no_random_approach_is_felt_before_its_freeze,
    a_d_lim_that_is_too_small_is_told_with_the_one_wanted, files_and_tables_are_left_behind,
    the_papers_nine_signals_are_logged_tick_by_tick, over_hands_there_is_a_row_each,
    a_world_that_dies_or_never_comes_is_told_beside_a_perfect_link,
    a_rehabilitation_session_keeps_each_fingers_force_cap, every_scene_of_simple_bodies_runs,
    a_shape_is_felt_by_the_fingers_that_glide_over_it,
    what_comes_into_view_around_a_finger_ends_no_run, a_recorded_hand_moves_the_fingers,
    bad_usage_is_refused_by_name);
