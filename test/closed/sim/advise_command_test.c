/* SPDX-License-Identifier: MIT */
/* exhand advise freeze: the figures of the formulas, and what is too small is said with the
 * number that is wanted. */
#include "said.h"
#include "lab/lab.h"

/* A fingertip as fast as the string, whose position is known exactly and without delay. */
#define PLAIN "--scale", "1", "--lag", "0", "--noise", "0", "--fps", "100"

static struct said s;

TEST(figures_and_judgements)
{
    static const struct {
        const char *word[16];
        int status;
        const char *says;
    } row[] = {
        /* One sample at the paper's speed, 0.87 m/s: 0.435 mm; a frame of 10 ms and one: 9.135. */
        {{"freeze", PLAIN}, 0,
            "d_lim_mm=-0.436 ray_mm=9.571 age_ms=10.000 error_mm=0.000 speed_mps=0.8700"},
        {{"freeze", "--rate", "90", PLAIN}, 0, "d_lim_mm=-9.667 "},
        {{"freeze", "--lag", "4", "--noise", "1", "--scale", "1"}, 0, "d_lim_mm=-4.916 "},
        {{"freeze", "--scale", "0.5", "--lag", "0", "--noise", "0"}, 0, "d_lim_mm=-0.871 "},
        {{"freeze", "--link", "1", "--jitter", "5"}, 0, "age_ms=8.500 "},
        {{"freeze", "--object-speed", "0.5", "--slide", "10", "--radius", "20", "--fps", "100"}, 0,
            "error_mm=7.500 "},
        {{"freeze", "--d-lim", "-0.3", PLAIN}, 1, "d_lim -0.300 mm: too little: make it -0.436 mm"},
        {{"freeze", "--d-lim", "-0.436", PLAIN}, 0, "d_lim -0.436 mm: enough"},
        {{"freeze", "--d-lim", "-1", PLAIN}, 0, "speed_mps=2.0000"},
        {{"freeze", "--ray", "9.57", PLAIN}, 1, "ray 9.570 mm: too little: make it 9.571 mm"},
        {{"freeze", "--ray", "9.571", PLAIN}, 0, "ray 9.571 mm: enough"},
        {{"freeze", "--d-lim", "-5", "--ray", "14", PLAIN}, 1,
            "ray 14.000 mm: too little: make it 14.136"},
    };
    char *dir = said_dir();
    for (size_t i = 0; i < LEN(row); i++) {
        const char *word[18] = {"advise"};
        for (size_t k = 0; k < LEN(row[i].word) && row[i].word[k]; k++) {
            word[k + 1] = row[i].word[k];
        }
        said(&s, dir, lab_advise, word);
        CHECK(s.status == row[i].status && strstr(s.out, row[i].says) && s.err[0] == '\0',
            "row %d: %d\n%s%s", (int)i, s.status, s.out, s.err);
    }
    said_clean(dir);
}

/* Both say what is wanted of the same hand at the same speed, to the rounding of one of them. */
TEST(the_experiment_gives_the_same_advice)
{
    static const char *const speed[][2] = {{"0.5", "0.55"}, {"0.87", "0.957"}, {"1.2", "1.32"}};
    char *dir = said_dir();
    for (size_t i = 0; i < LEN(speed); i++) {
        double experiment_mm = 0, advice_mm = 1;
        const char *at;
        said(&s, dir, lab_bilateral,
            WORDS("bilateral", "--speed", speed[i][0], "--approaches", "1", "--seeds", "1"));
        CHECK(s.status == 0, "%s", s.err);
        at = strstr(s.out, "m/s: enough; wanted ");
        CHECK(at && sscanf(at, "m/s: enough; wanted %lf mm", &experiment_mm) == 1,
            "its default is not enough: %s", s.out);
        said(&s, dir, lab_advise, WORDS("advise", "freeze", "--speed", speed[i][1]));
        CHECK(sscanf(s.out, "d_lim_mm=%lf ", &advice_mm) == 1, "%s", s.out);
        CHECK(experiment_mm < 0 && experiment_mm - advice_mm < 0.02 &&
                  advice_mm - experiment_mm < 0.02,
            "%s m/s: %g and %g mm", speed[i][0], experiment_mm, advice_mm);
    }
    said_clean(dir);
}

TEST(what_cannot_be_answered)
{
    char *dir = said_dir();
    said(&s, dir, lab_advise, WORDS("advise", "freeze", "--speed", "8", "--lag", "2000"));
    CHECK(s.status == 1 && strstr(s.err, "beyond 2 m"), "%s", s.err);
    said(&s, dir, lab_advise, WORDS("advise", "gain"));
    CHECK(s.status == 2 && strstr(s.err, "gain: nothing is known"), "%s", s.err);
    said(&s, dir, lab_advise, WORDS("advise"));
    CHECK(s.status == 2 && strstr(s.err, "freeze|gains: this word is missing"), "%s", s.err);
    said(&s, dir, lab_advise, WORDS("advise", "freeze", "--d-lim", "1"));
    CHECK(s.status == 2 && strstr(s.err, "--d-lim: 1 (allowed -200..-0.1)"), "%s", s.err);
    said(&s, dir, lab_advise, WORDS("advise", "gains", "--judge", "/nowhere/at/all"));
    CHECK(s.status == 3 && strstr(s.err, "--judge: /nowhere/at/all: No such file"), "%d %s",
        s.status, s.err);
    said(&s, dir, lab_advise, WORDS("advise", "gains", "--judge", "/dev/null"));
    CHECK(s.status == 2 && strstr(s.err, "--judge: /dev/null: no cell in it"), "%d %s", s.status,
        s.err);
    said_clean(dir);
}

TEST_MAIN("sim/advise_command", figures_and_judgements, the_experiment_gives_the_same_advice,
    what_cannot_be_answered);
