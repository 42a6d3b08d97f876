/* SPDX-License-Identifier: MIT */
/* Images of parameters on disk: there and back, whole or not at all, and what is said of bad ones.
 */
#include "said.h"
#include "lab/lab.h"

#include "base/cli.h"
#include "base/params_file.h"

#include "bilateral/bilateral.h"
#include "drop/drop.h"
#include "guarded/guarded.h"

#include "exhand/error.h"

#include <dirent.h>

#define ID_K 0x0401

static char dir[64], file[128];

static void make_dir(void)
{
    strcpy(dir, "/tmp/exhand-params-XXXXXX");
    CHECK(mkdtemp(dir) != NULL, "no directory");
    snprintf(file, sizeof file, "%s/image", dir);
}

static int files_in_dir(void)
{
    DIR *d = opendir(dir);
    int n = 0;
    while (d && readdir(d) != NULL) { n++; }
    if (d) { closedir(d); }
    return n - 2;
}

static void remove_dir(void)
{
    static const char *const name[] = {"image", "said.out", "said.err"};
    for (size_t i = 0; i < LEN(name); i++) {
        char path[160];
        snprintf(path, sizeof path, "%s/%s", dir, name[i]);
        (void)remove(path);
    }
    CHECK(rmdir(dir) == 0, "%s: not empty", dir);
}

static struct exh_params *fresh(const struct exh_scene *sc)
{
    sc->defaults();
    return sc->params;
}

/* In mid-way too: what is wanted is saved. */
TEST(there_and_back)
{
    struct exh_params *p = fresh(&exh_scene_drop);
    int32_t at;
    make_dir();
    p->locked = 1;
    p->shift = 6;
    at = exh_signal_find(p->table, ID_K, 0);
    CHECK_EQ_I64(exh_params_stage(p, ID_K, 0, EXH_Q(777, 1, EXH_Q_K)), 0);
    (void)exh_params_apply(p);
    CHECK_EQ_I64(params_save_file(file, p), 0);
    CHECK_EQ_I64(files_in_dir(), 1);
    p = fresh(&exh_scene_drop);
    CHECK_EQ_I64(params_load_file(file, p), 0);
    CHECK_EQ_I64(p->staged[at], EXH_Q(777, 1, EXH_Q_K));
    CHECK_EQ_I64(p->pending, 1);
    remove_dir();
}

/* What was there stays, and nothing is left beside it. */
TEST(what_cannot_be_written)
{
    const struct exh_params *p = fresh(&exh_scene_drop);
    char path[192];
    make_dir();
    CHECK_EQ_I64(mkdir(file, 0700), 0);
    CHECK_EQ_I64(params_save_file(file, p), 1); /* a directory is in its place */
    CHECK_EQ_I64(files_in_dir(), 1);
    CHECK_EQ_I64(rmdir(file), 0);
    snprintf(path, sizeof path, "%s/none/image", dir);
    CHECK_EQ_I64(params_save_file(path, p), 1);
    CHECK_EQ_I64(files_in_dir(), 0);
    remove_dir();
}

static uint8_t image[8192];
static size_t image_B;

static void put_image(void)
{
    FILE *f = fopen(file, "wb");
    CHECK(f != NULL && fwrite(image, 1, image_B, f) == image_B && fclose(f) == 0, "%s", file);
}

static void seal(void)
{
    struct exh_bytes c = exh_bytes_writer(image + image_B - 4, 4);
    uint32_t crc = exh_crc32(0, image, image_B - 4);
    exh_bytes_u32(&c, &crc);
}

static int loads(int argc, char **argv)
{
    (void)argc;
    (void)argv;
    return params_load_file(file, exh_scene_drop.params);
}

/* Refused whole, with these words. */
static void refused(int status, const char *first, const char *second)
{
    static struct said s;
    struct exh_params *p = fresh(&exh_scene_drop);
    put_image();
    said(&s, dir, loads, WORDS("load"));
    CHECK(s.status == status, "status %d: %s", s.status, s.err);
    CHECK(strstr(s.err, first) && strstr(s.err, second), "%s or %s: %s", first, second, s.err);
    CHECK(params_load_file(file, p) == status && !p->pending, "something of it is staged");
    for (uint32_t i = 0; i < p->count; i++) {
        CHECK(p->staged[i] == exh_signal_at(p->table, i, NULL)->dflt, "value %u", (unsigned)i);
    }
}

TEST(what_is_said_of_bad_ones)
{
    static uint8_t good[sizeof image];
    struct exh_params *p = fresh(&exh_scene_drop);
    const uint32_t k_at = (uint32_t)exh_signal_find(p->table, ID_K, 0);
    const size_t B = (size_t)exh_params_save(p, good, sizeof good);
    make_dir();
    for (size_t n = 0; n < B; n += n < 20 || n + 20 > B ? 1 : 13) {
        memcpy(image, good, B);
        image_B = n;
        refused(2, "cut off", "nothing of it");
    }
    image_B = B;
    for (size_t byte = 12; byte < B; byte += 7) {
        memcpy(image, good, B);
        image[byte] ^= (uint8_t)(1u << byte % 8);
        refused(2, "damaged", "nothing of it");
    }
    memcpy(image, good, B);
    image[0] ^= 1;
    refused(2, "no image", file);
    image[0] ^= 1;
    image[4] = 9;
    seal();
    refused(2, "version 9", "program's is 1");
    memcpy(image, good, B);
    image[12 + 4 * k_at + 3] = 0x7F;
    seal();
    refused(2, "k (instance 0): 2082268", "allowed 0..1000000 N/m");
    p = fresh(&exh_scene_guarded);
    image_B = (size_t)exh_params_save(p, image, sizeof image);
    {
        char theirs[32], ours[32];
        snprintf(theirs, sizeof theirs, "%u values of table", (unsigned)p->count);
        snprintf(ours, sizeof ours, "%08lx",
            (unsigned long)exh_signal_crc(exh_scene_drop.params->table));
        refused(2, theirs, ours);
    }
    remove_dir();
}

/* An experiment with other values, saved, is the same when they are loaded. */
TEST(experiments_take_and_leave_them)
{
    static struct said a, b;
    make_dir();
    said(&a, dir, cli_drop,
        WORDS("drop", "--rate", "500", "--falls", "1", "--k", "3000", "--b", "12", "--set",
            "f_max=15", "--save-params", file));
    CHECK(a.status < 2 && a.err[0] == '\0', "%d: %s", a.status, a.err);
    said(&b, dir, cli_drop, WORDS("drop", "--rate", "500", "--falls", "1", "--load-params", file));
    CHECK(b.status == a.status && strcmp(a.out, b.out) == 0, "%s\nbut\n%s", a.out, b.out);
    said(&b, dir, cli_drop,
        WORDS("drop", "--rate", "500", "--falls", "1", "--load-params", file, "--set", "f_max=3"));
    CHECK(b.status < 2 && strcmp(a.out, b.out) != 0, "--set does not come behind it");
    said(&b, dir, cli_drop,
        WORDS("drop", "--rate", "500", "--falls", "1", "--k", "500", "--load-params", file));
    CHECK(b.status < 2 && strcmp(a.out, b.out) != 0, "--k does not come behind it: %s", b.err);
    said(&b, dir, lab_drop, WORDS("drop", "--sweep", "--load-params", file));
    CHECK(b.status == 2 && strstr(b.err, "no plane"), "%d: %s", b.status, b.err);
    said(&b, dir, cli_drop, WORDS("drop", "--save-params", file));
    CHECK(b.status == 2 && strstr(b.err, "one rate"), "%d: %s", b.status, b.err);
    said(&b, dir, cli_bilateral, WORDS("bilateral", "--load-params", file));
    CHECK(b.status == 2 && strstr(b.err, "of table"), "%d: %s", b.status, b.err);
    said(&b, dir, cli_drop, WORDS("drop", "--rate", "500", "--load-params", "/nowhere/at/all"));
    CHECK(b.status == 3 && strstr(b.err, "/nowhere/at/all"), "%d: %s", b.status, b.err);
    said(&a, dir, cli_bilateral,
        WORDS("bilateral", "--rate", "500", "--speed", "fast", "--approaches", "1", "--k", "3000",
            "--b", "12", "--save-params", file));
    CHECK(a.status < 2 && a.err[0] == '\0', "%d: %s", a.status, a.err);
    said(&b, dir, cli_bilateral,
        WORDS("bilateral", "--rate", "500", "--speed", "fast", "--approaches", "1", "--load-params",
            file));
    /* But for what is said of d_lim: that takes the string per fingertip for as it was fitted. */
    CHECK(strstr(a.out, "d_lim") != NULL, "%s", a.out);
    CHECK(b.status == a.status &&
              strncmp(a.out, b.out, (size_t)(strstr(a.out, "d_lim") - a.out)) == 0,
        "%s\nbut\n%s", a.out, b.out);
    remove_dir();
}

/* What only the person sets is no image's: one line says what it has of that, and what stays. */
static void check_left(const char *want, const struct said *s)
{
    CHECK(s->status == 0 || s->status == 1, "%d: %s", s->status, s->err);
    CHECK(want ? strstr(s->err, file) && strstr(s->err, want) &&
                     strchr(s->err, '\n') == strrchr(s->err, '\n')
               : s->err[0] == '\0',
        "%s", s->err);
}

#define DROP      "drop", "--rate", "500", "--falls", "1"
#define BILATERAL "bilateral", "--rate", "2000", "--speed", "fast", "--approaches", "1"
#define RUN       "run", "--rate", "500", "--seconds", "0.1"

TEST(what_is_left_alone_is_said)
{
    static const char one[] =
        ": left alone, since only --set sets them: person_f 30 (stays 40 N)\n";
    static const char two[] =
        ": left alone, since only --set sets them: person_i 5 (stays 6.6 A), day 7 (stays 0)\n";
    static struct said s;
    make_dir();
    said(&s, dir, cli_drop, WORDS(DROP, "--set", "person_f=30", "--save-params", file));
    check_left(NULL, &s);
    said(&s, dir, cli_drop, WORDS(DROP, "--runs", "3", "--load-params", file));
    check_left(one, &s);
    said(&s, dir, cli_drop, WORDS(DROP, "--load-params", file, "--set", "person_f=30"));
    check_left(NULL, &s);
    said(&s, dir, cli_run, WORDS(RUN, "--load-params", file));
    check_left(one, &s);
    said(&s, dir, cli_bilateral,
        WORDS(BILATERAL, "--set", "person_i=5", "--set", "day=7", "--save-params", file));
    check_left(NULL, &s);
    said(&s, dir, cli_bilateral, WORDS(BILATERAL, "--load-params", file));
    check_left(two, &s);
    remove_dir();
}

TEST_MAIN("sim/params_file", there_and_back, what_cannot_be_written, what_is_said_of_bad_ones,
    experiments_take_and_leave_them, what_is_left_alone_is_said);
