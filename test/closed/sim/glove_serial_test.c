/* SPDX-License-Identifier: MIT */
/* A stock glove on a serial line as the board's glove: a pseudo-terminal with an emulated glove at
 * its other end. The board gets the frames that were sent and no others, their ages, a silence, and
 * a device that goes and returns. The command is tested, too. */
#define _XOPEN_SOURCE 700 /* pseudo-terminals */

#include "glove_said.h"
#include "terminal.h"

#include "glove/modes.h"
#include "glove/poses.h"
#include "emu/cyber.h"
#include "posix.h"

#include "bilateral/bilateral.h"
#include "exhand/run/loop.h"

#include "exhand/board.h"

#include <poll.h>
#include <sys/ioctl.h>
#include <termios.h>
#include <time.h>

#define RATE_HZ 1000
#define NS      1000000u /* a tick */
#define WAIT_MS 5000     /* longer than any byte takes through the machine's own buffers */

/* ---- The glove at the other end ------------------------------------------------------ */

static struct {
    struct terminal tty;
    char link[64]; /* the device's name: goes on when the terminal behind it does not */
    struct emu_cyber glove;
    int open;
    unsigned told, rounds; /* bytes of commands it has had; what the other end had read before it */
    void (*at)(uint64_t tick); /* what happens; NULL: nothing */
    int fixed;                 /* its samples stay as they are */
    uint64_t from_ns;          /* its clock's 0, where it has this machine's */
} far;

static struct glove_tty tty;

/* Samples of a frame are all known from the first. */
static void sample(void)
{
    for (unsigned i = 0; i < SENSORS && !far.fixed; i++) {
        far.glove.sample[i] = (uint8_t)(1 + (7 * far.glove.frames + 11 * i) % 255);
    }
}

static int is_one(const int16_t *raw)
{
    unsigned first = 1;
    while (first < 255 && cyberglove_raw((uint8_t)first) != raw[0]) { first++; }
    for (unsigned i = 0; i < SENSORS; i++) {
        if (raw[i] != cyberglove_raw((uint8_t)(1 + (first - 1 + 11 * i) % 255))) { return 0; }
    }
    return 1;
}

static uint64_t clock_ns(void)
{
    struct timespec t;
    (void)clock_gettime(CLOCK_MONOTONIC, &t);
    return (uint64_t)t.tv_sec * 1000000000u + (uint64_t)t.tv_nsec;
}

static int plug_in(void)
{
    if (terminal_open(&far.tty) < 0) { return -1; }
    (void)unlink(far.link);
    CHECK(symlink(ptsname(far.tty.master), far.link) == 0, "%s", far.link);
    far.open = 1;
    far.told = 0;
    far.rounds = tty.told;
    return 0;
}

static void pull_out(void)
{
    terminal_close(&far.tty);
    far.open = 0;
}

static int begin(void)
{
    memset(&far, 0, sizeof far);
    memset(&tty, 0, sizeof tty);
    snprintf(far.link, sizeof far.link, "/tmp/exhand-glove-%ld", (long)getpid());
    emu_cyber_open(&far.glove);
    far.from_ns = clock_ns();
    return plug_in();
}

static void end(void)
{
    if (far.open) { pull_out(); }
    (void)unlink(far.link);
}

/* Bytes of the commands that were sent since the device was opened. */
static unsigned sent(void)
{
    static const unsigned length[] = {3, 4, 4, 9, 1};
    unsigned n = 21 * (tty.told - far.rounds);
    for (unsigned i = 0; i < tty.step && tty.step < 5; i++) { n += length[i]; }
    return tty.fd < 0 ? 0 : n;
}

static void hear(int wait_ms)
{
    struct pollfd p = {far.tty.master, POLLIN, 0};
    uint8_t byte[64];
    ssize_t n;
    while (poll(&p, 1, wait_ms) > 0 && (n = read(far.tty.master, byte, sizeof byte)) > 0) {
        for (ssize_t i = 0; i < n; i++) { emu_cyber_put(&far.glove, byte[i]); }
        far.told += (unsigned)n;
        wait_ms = 0;
    }
}

/* The bytes of this tick are through when this returns. */
static void say(uint64_t now_ns)
{
    uint8_t byte[256];
    int n = 0, got = 0, b;
    sample();
    while (n < (int)sizeof byte && (b = emu_cyber_get(&far.glove, now_ns)) >= 0) {
        byte[n++] = (uint8_t)b;
        sample();
    }
    if (n == 0) { return; }
    CHECK(write(far.tty.master, byte, (size_t)n) == n, "%s", strerror(errno));
    for (int ms = 0; ms < WAIT_MS && ioctl(far.tty.slave, FIONREAD, &got) == 0 && got < n; ms++) {
        (void)poll(NULL, 0, 1);
    }
    CHECK_EQ_I64(got, n);
}

/* Once a tick, before the board looks: virtual time at both ends. */
static uint32_t tick(uint64_t n)
{
    if (far.at) { far.at(n); }
    if (!far.open) { return 0; }
    for (int k = 0; k < 100 && far.told < sent(); k++) { hear(WAIT_MS / 100); }
    say(n * NS);
    return 0;
}

/* ---- A scene that judges what it is given --------------------------------------------------- */

static struct {
    uint32_t frames, wrong, ticks;
    uint16_t newest, oldest; /* age of a frame when it comes; of any after the first */
    uint16_t age[16000];
} seen;

static int seen_setup(struct exh_scene_board board)
{
    (void)board;
    memset(&seen, 0, sizeof seen);
    return 0;
}

static void seen_tick(const struct exh_scene_in *in, struct exh_drive_out *out)
{
    memset(out, 0, sizeof *out);
    seen.frames += in->glove_new;
    seen.wrong += in->glove_new && !is_one(in->glove.raw);
    if (in->glove_new) { seen.newest = in->glove.age_ticks; }
    if (seen.frames && in->glove.age_ticks > seen.oldest) { seen.oldest = in->glove.age_ticks; }
    if (seen.ticks < sizeof seen.age / sizeof seen.age[0]) {
        seen.age[seen.ticks] = in->glove.age_ticks;
    }
    seen.ticks++;
}

static const struct exh_scene scene = {.name = "seen",
    .rate_Hz = RATE_HZ,
    .read_glove = exh_board_read_glove,
    .setup = seen_setup,
    .tick = seen_tick};

static struct posix_config on_the_line(unsigned seconds)
{
    struct posix_config c = posix_config_default();
    c.glove = c.bench = 1;
    c.glove_tty = &tty;
    c.max_ticks = seconds * RATE_HZ;
    c.late = tick;
    return c;
}

static void run(unsigned seconds, void (*at)(uint64_t))
{
    const struct posix_config c = on_the_line(seconds);
    far.at = at;
    CHECK_EQ_I64(glove_tty_open(&tty, far.link, 90), 0);
    posix_configure(&c);
    CHECK_EQ_I64(exh_loop(&scene, 0, NULL), 0);
    CHECK_EQ_I64(seen.ticks, seconds * RATE_HZ);
    CHECK(seen.wrong == 0, "kind %d of each %lu: %lu", far.glove.kind,
        (unsigned long)far.glove.every, (unsigned long)seen.wrong);
}

/* ---- Frames ------------------------------------------------------------------------------ */

/* 90 a second and no other, each as sent, each older than its way along the line. */
TEST(frames_come_at_the_rate_that_was_asked_for)
{
    if (begin() < 0) { return; }
    run(10, NULL);
    CHECK_EQ_I64(far.glove.period_ns, 11111111);
    CHECK(far.glove.status == 1 && far.glove.refused == 0 && tty.in.told,
        "its status was not asked for");
    CHECK(seen.frames >= 870 && seen.frames <= 880, "%lu frames", (unsigned long)seen.frames);
    CHECK_EQ_I64(tty.in.frames, seen.frames);
    CHECK_EQ_I64(tty.told, 1);
    CHECK_EQ_I64(seen.newest, 3); /* 25 bytes are 2.17 ms */
    CHECK(seen.oldest <= 3 + 12, "%d", seen.oldest);
    CHECK_EQ_I64(seen.age[0], UINT16_MAX); /* none yet is older than any */
    glove_tty_close(&tty);
    hear(WAIT_MS);
    CHECK_EQ_I64(far.glove.streams, 0);
    end();
}

/* A unit that ignores all commands and streams at a lower rate, without a status. */
TEST(a_glove_that_takes_no_command_is_heard_all_the_same)
{
    if (begin() < 0) { return; }
    far.glove.period_ns = 100000000;
    far.glove.streams = 1;
    far.glove.deaf = 1;
    run(10, NULL);
    CHECK(!tty.in.told && tty.in.status == 0, "status %d", tty.in.status);
    CHECK(seen.frames >= 99 - CYBERGLOVE_SURE && seen.frames <= 100, "%lu",
        (unsigned long)seen.frames);
    CHECK(seen.oldest >= 100 && seen.oldest <= 3 + 101, "%d", seen.oldest);
    glove_tty_close(&tty);
    end();
}

/* Two readers would each have parts of frames, and parts of two can look like one. */
TEST(the_line_is_its_own_while_it_is_open)
{
    if (begin() < 0) { return; }
    for (int k = 0; k < 2; k++) {
        int own = -1;
        CHECK_EQ_I64(glove_tty_open(&tty, far.link, 90), 0);
        CHECK(ioctl(far.tty.slave, TIOCGEXCL, &own) == 0 && own == 1, "%d", own);
        glove_tty_close(&tty);
        CHECK(ioctl(far.tty.slave, TIOCGEXCL, &own) == 0 && own == 0, "%d", own);
    }
    end();
}

/* ---- Misbehaviour -------------------------------------------------------------------------- */

static uint8_t kind;
static uint32_t every;

/* From 1 s to 3 s. */
static void misbehave(uint64_t n)
{
    if (n == RATE_HZ) {
        far.glove.kind = kind;
        far.glove.every = every;
    }
    if (n == 3 * RATE_HZ) { far.glove.every = UINT32_MAX; }
}

TEST(whatever_it_does_no_wrong_frame_comes_and_the_next_good_ones_do)
{
    for (kind = EMU_CYBER_WELL; kind < EMU_CYBER_KINDS; kind++) {
        for (every = 1; every <= 4; every += 3) {
            const int harmless =
                kind == EMU_CYBER_WELL || kind == EMU_CYBER_TWICE || kind == EMU_CYBER_ERROR;
            if (begin() < 0) { return; }
            run(5, misbehave);
            /* silent for so long it ages; with three good ones of four it does not, and in the end
             * it is well */
            CHECK(harmless || every > 1 ? seen.oldest < 60 : seen.oldest > 1900, "kind %d: %d",
                kind, seen.oldest);
            for (unsigned k = 4 * RATE_HZ + RATE_HZ / 2; k < 5 * RATE_HZ; k++) {
                CHECK(seen.age[k] <= 3 + 12, "kind %d: tick %u: %d", kind, k, seen.age[k]);
            }
            CHECK(harmless || every > 1 ? tty.told == 1 : tty.told >= 2, "kind %d: told %lu", kind,
                (unsigned long)tty.told);
            glove_tty_close(&tty);
            end();
        }
    }
}

/* Gone at 2 s, another terminal behind the same name at 5 s. */
static void gone_and_back(uint64_t n)
{
    if (n == 2 * RATE_HZ) { pull_out(); }
    if (n == 5 * RATE_HZ) {
        emu_cyber_open(&far.glove);
        far.glove.now_ns = n * NS;
        (void)plug_in();
    }
}

TEST(a_device_that_is_pulled_out_ages_and_comes_back)
{
    if (begin() < 0) { return; }
    run(8, gone_and_back);
    CHECK_EQ_I64(tty.gone, 1);
    CHECK(seen.oldest > 2900, "%d", seen.oldest);
    CHECK(seen.age[8 * RATE_HZ - 1] <= 3 + 12, "%d", seen.age[8 * RATE_HZ - 1]);
    glove_tty_close(&tty);
    end();
}

/* ---- The full box on it ------------------------------------------------------------------------
 */

static struct {
    uint32_t before, silent, after; /* ticks with the fault present */
    int16_t newest[SENSORS];
} box;

static void silent_for_a_while(uint64_t n)
{
    if (n == 2 * RATE_HZ) { far.glove.kind = EMU_CYBER_SILENT; }
    if (n == 4 * RATE_HZ) { far.glove.kind = EMU_CYBER_WELL; }
}

static void look(uint32_t n, const struct exh_scene_in *in, const struct exh_drive_out *out)
{
    const struct bilateral_signals *s = (const void *)exh_scene_signals(&exh_scene_bilateral);
    const uint32_t here = (uint32_t)s->box.present & EXH_FAULT_GLOVE ? 1 : 0;
    (void)out;
    if (n >= RATE_HZ && n < 2 * RATE_HZ) { box.before += here; }
    if (n >= 3 * RATE_HZ && n < 4 * RATE_HZ) { box.silent += here; }
    if (n >= 5 * RATE_HZ) { box.after += here; }
    memcpy(box.newest, in->glove.raw, sizeof box.newest);
}

TEST(the_box_takes_its_silence_for_a_lost_glove)
{
    static const struct exh_loop_hooks hooks = {.after = look};
    struct posix_config c = on_the_line(6);
    if (begin() < 0) { return; }
    memset(&box, 0, sizeof box);
    far.at = silent_for_a_while;
    c.T = (struct exh_period){1, RATE_HZ};
    c.drives = 31;
    exh_scene_bilateral.defaults();
    CHECK_EQ_I64(glove_serial_stage(&exh_scene_bilateral, NULL, RATE_HZ, 90), 0);
    CHECK_EQ_I64(glove_tty_open(&tty, far.link, 90), 0);
    posix_configure(&c);
    CHECK_EQ_I64(exh_loop(&exh_scene_bilateral, 0, &hooks), 0);
    CHECK_EQ_I64(box.before, 0);
    CHECK_EQ_I64(box.silent, RATE_HZ);
    CHECK_EQ_I64(box.after, 0);
    CHECK(is_one(box.newest), "%d", box.newest[0]);
    glove_tty_close(&tty);
    end();
}

/* ---- The command --------------------------------------------------------------------------------
 */

/* In a separate process. This one is the glove until it ends. */
static void command_of(
    struct said *s, const char *dir, int (*run_it)(int, char **), const char *const *word)
{
    pid_t pid;
    siginfo_t info = {.si_pid = 0};
    far.glove.streams = far.glove.out_n = 0; /* what it had to say to the command before is gone */
    pid = said_start(dir, run_it, word);
    while (waitid(P_PID, (id_t)pid, &info, WEXITED | WNOHANG | WNOWAIT) == 0 && info.si_pid == 0) {
        uint8_t byte[256];
        int n = 0, b;
        hear(1);
        sample();
        while (n < (int)sizeof byte &&
               (b = emu_cyber_get(&far.glove, clock_ns() - far.from_ns)) >= 0) {
            byte[n++] = (uint8_t)b;
            sample();
        }
        if (n > 0 && write(far.tty.master, byte, (size_t)n) != n) {
            break;
        } /* no reader any more */
    }
    said_end(s, dir, pid);
}

static void command(struct said *s, const char *dir, const char *const *word)
{
    command_of(s, dir, cli_glove, word);
}

static int lines(const char *text)
{
    int n = 0;
    for (; *text; text++) { n += *text == '\n'; }
    return n;
}

TEST(the_command_writes_rows_or_a_log)
{
    static struct said s;
    char *dir = said_dir();
    const char *log = said_path(dir, "a.exh");
    if (begin() < 0) { return; }
    command(&s, dir, WORDS("glove", "--serial", far.link, "--seconds", "2", "--deg", "--tips"));
    CHECK(s.status == 0, "%d: %s", s.status, s.err);
    CHECK(strncmp(s.out, "t_s,thumb_rotate_deg,", 21) == 0 && strstr(s.out, "little_z_m") &&
              lines(s.out) > 3,
        "%s", s.out);
    CHECK(strstr(s.err, " frames at 90 Hz, discarded: zero sample 0,") && !strstr(s.err, "silent"),
        "%s", s.err);
    command(&s, dir, WORDS("glove", "--serial", far.link, "--seconds", "2", "--record", log));
    CHECK(s.status == 0 && strstr(s.out, " frames at 90 Hz") && !strstr(s.out, ": 0 frames") &&
              s.err[0] == '\0',
        "%d: %s", s.status, s.err);
    said(&s, dir, cli_replay, WORDS("replay", log));
    CHECK(s.status == 0, "%s", s.err);
    said(&s, dir, cli_csv, WORDS("csv", log, "--all"));
    CHECK(s.status == 0 && strstr(s.out, ",raw21\n"), "%s", s.err);
    end();
    said_clean(dir);
}

/* The box has the glove. If no frame comes, that is the box's fault, and is reported. */
TEST(a_box_that_goes_on_has_it_for_its_glove)
{
    static struct said s;
    char *dir = said_dir();
    for (int silent = 0; silent < 2; silent++) {
        const char *log = said_path(dir, "a.exh");
        if (begin() < 0) { return; }
        far.glove.kind = silent ? EMU_CYBER_SILENT : EMU_CYBER_WELL;
        command_of(&s, dir, cli_run,
            WORDS("run", "--scene", "bilateral", "--pace", "--slack", "60", "--rate", "200",
                "--seconds", "3", "--glove-serial", far.link, "--log", log));
        CHECK(s.status == 0 && strstr(s.out, silent ? "glove" : "faults none"), "%d: %s%s",
            s.status, s.out, s.err);
        said(&s, dir, cli_replay, WORDS("replay", log));
        CHECK(s.status == 0, "%s", s.err);
        end();
    }
    said(&s, dir, cli_run, WORDS("run", "--glove-serial", "/dev/null", "--seconds", "1"));
    CHECK(s.status == 2 && strstr(s.err, "--glove-serial: goes with --scene bilateral and --pace"),
        "%d: %s", s.status, s.err);
    said(&s, dir, cli_run,
        WORDS("run", "--scene", "bilateral", "--pace", "--glove-serial", "/dev/null", "--seconds",
            "1"));
    CHECK(s.status == 3 && strstr(s.err, "--glove-serial: /dev/null: is no serial line"), "%d: %s",
        s.status, s.err);
    said_clean(dir);
}

/* A hand holds this pose (where it leaves a joint free, as in the flat hand), in a glove of which
 * 90 degrees are 90 samples. */
static void hand_in(const char *pose)
{
    const int p = glove_pose_find(pose);
    for (unsigned i = 0; i < SENSORS; i++) {
        int deg = 0;
        (void)glove_pose_says((unsigned)p, i, &deg);
        far.glove.sample[i] = (uint8_t)(100 + (int)i + deg);
    }
}

/* Column `at` of the last row, its time being column -1. */
static int last_is_near(const char *text, unsigned at, double deg, double by)
{
    const char *row = strrchr(text, ',');
    double got;
    while (row && row > text && row[-1] != '\n') { row--; }
    for (unsigned i = 0; row && i <= at; i++) { row = strchr(row + 1, ','); }
    if (row == NULL) { return 0; }
    got = strtod(row + 1, NULL);
    return got > deg - by && got < deg + by;
}

/* What an angle must be, by the published file, to half a sample. */
TEST(its_nominal_calibration_is_the_published_one)
{
    static const struct {
        int at, sample;
        double deg;
    } row[] = {{4, 1 + 109 /* .429 */, 0}, {4, 1 + 166 /* .654 */, 90}, {3, 1 + 201 /* .791 */, 0},
        {3, 1 + 89 /* .350 */, 50}, {9, 1, 0}, {21, 1 + 235 /* .925 */, -30},
        {21, 1 + 60 /* .236 */, 10}, {20, 1 + 39, -30}, {20, 1 + 158, 40}};
    for (size_t i = 0; i < LEN(row); i++) {
        const struct exh_glove_sensor *c = &exh_glove_cal_default.sensor[row[i].at];
        const double step_deg = 58982.4 / 254 * 360.0 * c->gain_turnpraw_q38 / 274877906944.0;
        const double deg = (cyberglove_raw((uint8_t)row[i].sample) - c->zero_raw_q15 / 32768.0) *
                           360.0 * c->gain_turnpraw_q38 / 274877906944.0;
        const double off = deg < row[i].deg ? row[i].deg - deg : deg - row[i].deg;
        CHECK(off <= (step_deg < 0 ? -step_deg : step_deg) / 2 + 0.01, "%zu: %g deg", i, deg);
    }
}

/* A hand in each of the poses, as this glove samples them: the calibration of it says them again.
 */
TEST(a_user_calibrates_it_by_poses)
{
    static const char *const pose[] = {"flat", "spread", "knuckles", "hook", "index", "middle",
        "ring", "little", "thumb", "across", "opposed", "cup", "up", "down", "side"};
    static struct said s;
    char *dir = said_dir();
    const char *csv = said_path(dir, "poses.csv"), *image = said_path(dir, "glove.bin"),
               *none = said_path(dir, "none.bin");
    FILE *f;
    if (begin() < 0) { return; }
    far.fixed = 1;
    for (size_t p = 0; p < LEN(pose); p++) {
        int16_t raw[SENSORS];
        hand_in(pose[p]);
        for (unsigned i = 0; i < SENSORS; i++) { raw[i] = cyberglove_raw(far.glove.sample[i]); }
        if (p < 2) { /* the others would be as these, two seconds each */
            command(&s, dir,
                WORDS("glove", "--serial", far.link, "--pose", pose[p], "--glove-rate", "20",
                    "--seconds", "2"));
            CHECK(
                s.status == 0 && strncmp(s.out, pose[p], strlen(pose[p])) == 0 && lines(s.out) > 3,
                "%d: %s%s", s.status, s.out, s.err);
        }
        f = fopen(
            csv, "ab"); /* not open while a process is made, which would write its buffer, too */
        p < 2 ? (void)fputs(s.out, f) : glove_poses_row(f, pose[p], raw);
        fclose(f);
    }
    said(&s, dir, cli_calibrate_glove, WORDS("calibrate", "--glove", "--poses", csv, "--out", dir));
    CHECK(s.status == 0, "%d: %s", s.status, s.err);
    hand_in("knuckles");
    command(&s, dir,
        WORDS("glove", "--serial", far.link, "--calibration", image, "--deg", "--glove-rate", "20",
            "--seconds", "2"));
    CHECK(s.status == 0 && last_is_near(s.out, EXH_GLOVE_INDEX_MPJ, 80, 1.5) &&
              last_is_near(s.out, EXH_GLOVE_LITTLE_PIJ, 0, 1.5),
        "%d: %s%s", s.status, s.out, s.err);
    command(
        &s, dir, WORDS("glove", "--serial", far.link, "--calibration", csv, "--seconds", "0.5"));
    CHECK(
        s.status == 2 && strstr(s.err, "--calibration: ") && strstr(s.err, ": give the glove.bin"),
        "%d: %s", s.status, s.err);
    command(&s, dir, WORDS("glove", "--serial", far.link, "--pose", "fist"));
    CHECK(s.status == 2 && strstr(s.err, "--pose: fist: no such pose"), "%d: %s", s.status, s.err);
    command_of(&s, dir, cli_run,
        WORDS("run", "--scene", "bilateral", "--pace", "--slack", "60", "--rate", "200",
            "--seconds", "1", "--glove-serial", far.link, "--glove-calibration", image));
    CHECK(s.status == 0 && strstr(s.out, "faults none"), "%d: %s%s", s.status, s.out, s.err);
    said(&s, dir, cli_run,
        WORDS("run", "--scene", "bilateral", "--pace", "--glove-serial", far.link,
            "--glove-calibration", none, "--seconds", "1"));
    CHECK(s.status == 3 && strstr(s.err, "--glove-calibration: "), "%d: %s", s.status, s.err);
    said(&s, dir, cli_run,
        WORDS("run", "--scene", "bilateral", "--glove-calibration", image, "--seconds", "1"));
    CHECK(s.status == 2 && strstr(s.err, "--glove-calibration: the simulated glove is calibrated"),
        "%d: %s", s.status, s.err);
    far.fixed = 0;
    end();
    said_clean(dir);
}

TEST(what_it_cannot_use_it_names)
{
    static struct said s;
    char *dir = said_dir();
    static const struct {
        const char *path, *says;
    } row[] = {
        {"/tmp/no/such/line",
            "--serial: /tmp/no/such/line: No such file or directory: is it plugged in?"},
        {"/dev/null", "--serial: /dev/null: is no serial line: give a serial line"},
    };
    for (size_t i = 0; i < LEN(row); i++) {
        said(&s, dir, cli_glove, WORDS("glove", "--serial", row[i].path, "--seconds", "1"));
        CHECK(s.status == 3 && strstr(s.err, row[i].says), "%d: %s", s.status, s.err);
    }
    static const struct {
        uint8_t kind, deaf;
        const char *says;
    } far_end[] = {
        {EMU_CYBER_WELL, 1, "silent for 3 s: is the glove's unit on"},
        {EMU_CYBER_EIGHTEEN, 0, "this is the glove of 18 sensors (22 wanted)"},
        {EMU_CYBER_OFF, 0, "no glove is plugged into it"},
        {EMU_CYBER_GARBAGE, 0, "bytes and no whole frame: is it a glove of 22 sensors"},
    };
    for (size_t i = 0; i < LEN(far_end); i++) {
        if (begin() < 0) { return; }
        far.glove.kind = far_end[i].kind;
        far.glove.deaf = far_end[i].deaf;
        command(&s, dir, WORDS("glove", "--serial", far.link));
        CHECK(s.status == 3 && strstr(s.err, far_end[i].says), "%zu: %d: %s", i, s.status, s.err);
        end();
    }
    said_clean(dir);
}

TEST(a_name_that_is_no_serial_line_is_refused)
{
    CHECK(glove_tty_open(&tty, "/tmp/no/such/line", 90) < 0 && errno == ENOENT, "%s",
        strerror(errno));
    CHECK(glove_tty_open(&tty, "/dev/null", 90) < 0 && errno == ENOTTY, "%s", strerror(errno));
}

TEST_MAIN("sim/glove_serial", frames_come_at_the_rate_that_was_asked_for,
    the_line_is_its_own_while_it_is_open, a_glove_that_takes_no_command_is_heard_all_the_same,
    whatever_it_does_no_wrong_frame_comes_and_the_next_good_ones_do,
    a_device_that_is_pulled_out_ages_and_comes_back, a_name_that_is_no_serial_line_is_refused,
    the_box_takes_its_silence_for_a_lost_glove, the_command_writes_rows_or_a_log,
    a_box_that_goes_on_has_it_for_its_glove, its_nominal_calibration_is_the_published_one,
    a_user_calibrates_it_by_poses, what_it_cannot_use_it_names);
