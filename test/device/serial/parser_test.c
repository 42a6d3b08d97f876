/* SPDX-License-Identifier: MIT */
/* The bytes of a stock glove's serial line: whole frames come out, nothing else does, and each
 * thing that goes wrong is counted. The emulated glove knows nothing of the parser. */
#include "check.h"

#include "cyberglove.h"
#include "emu/cyber.h"

#include <string.h>

#define SENSORS CYBERGLOVE_SENSORS

static struct emu_cyber glove;
static struct cyberglove in;
static uint64_t now_ns;
static uint32_t wrong; /* frames that came and were none that the glove has sent */

static void tell(const char *command)
{
    for (; *command; command++) { emu_cyber_put(&glove, (uint8_t)*command); }
}

/* Headers, errors' and answers' letters, and bits of a status are samples, too. */
static void any_samples(void)
{
    static const uint8_t odd[] = {'S', 'G', 'e', 's', 'g', 'u', '?', 1, 3, 7, 255};
    for (int i = 0; i < SENSORS; i++) {
        const uint64_t r = check_u64();
        glove.sample[i] = r & 3 ? (uint8_t)(1 + (r >> 8) % 255) : odd[(r >> 8) % LEN(odd)];
    }
}

/* What the line has brought until then. */
static void drain(uint64_t until_ns)
{
    int byte;
    while ((byte = emu_cyber_get(&glove, until_ns)) >= 0) {
        if (cyberglove_take(&in, (uint8_t)byte)) {
            wrong += memcmp(in.sample, glove.sample, SENSORS) != 0;
        }
    }
}

/* Each frame has other samples: it is sampled, and sent before the next one is. */
static void frames(int n)
{
    for (; n > 0; n--) {
        any_samples();
        now_ns += glove.period_ns;
        drain(now_ns);
        drain(now_ns + glove.period_ns * 3 / 4);
    }
}

static void begin(int status)
{
    emu_cyber_open(&glove);
    memset(&in, 0, sizeof in);
    now_ns = 0;
    wrong = 0;
    tell(status ? "u 1\rS" : "S");
    frames(CYBERGLOVE_SURE + 4);
}

static uint32_t lost(void)
{
    uint32_t n = 0;
    for (unsigned i = 0; i < CYBERGLOVE_CAUSES; i++) { n += in.lost[i]; }
    return n;
}

/* ---- Well ------------------------------------------------------------------------------ */

TEST(each_frame_comes_as_it_was_sent)
{
    for (int status = 0; status < 2; status++) {
        begin(status);
        CHECK_EQ_I64(in.replies, status);
        in.frames = 0;
        memset(in.lost, 0, sizeof in.lost);
        frames(1000);
        CHECK_EQ_I64(in.frames, 1000);
        CHECK_EQ_I64(lost() + in.strays + in.errors + wrong, 0);
        CHECK(status ? (in.status & 1) == 1 : in.status == 0, "%d", in.status);
    }
}

TEST(a_frame_that_is_asked_for_is_one)
{
    begin(0);
    tell("^c");
    in.frames = 0;
    for (int k = 0; k < 20; k++) {
        tell("G");
        now_ns += 10000000;
        for (int byte; (byte = emu_cyber_get(&glove, now_ns)) >= 0;) {
            (void)cyberglove_take(&in, (uint8_t)byte);
        }
        CHECK(memcmp(in.sample, glove.sample, SENSORS) == 0, "frame %d", k);
    }
    CHECK_EQ_I64(in.frames, 20);
}

/* The first ones are refused until their form is sure. If the unit says its form, none is. */
TEST(the_form_is_learned_or_told)
{
    for (int told = 0; told < 2; told++) {
        emu_cyber_open(&glove);
        memset(&in, 0, sizeof in);
        now_ns = 0;
        in.told = (uint8_t)told;
        tell("u 1\rS");
        frames(20);
        CHECK_EQ_I64(in.lost[CYBERGLOVE_FORM], told ? 0 : CYBERGLOVE_SURE - 1);
        CHECK_EQ_I64(in.frames, told ? 20 : 20 - (CYBERGLOVE_SURE - 1));
    }
}

TEST(a_form_that_changes_is_taken_when_it_is_sure_unless_told)
{
    for (int told = 0; told < 2; told++) {
        begin(1);
        in.told = (uint8_t)told;
        glove.forced = 2;
        in.frames = 0;
        frames(100);
        CHECK(told ? in.frames == 0 : in.frames >= 100 - CYBERGLOVE_SURE && wrong == 0,
            "%d: %lu, wrong %lu", told, (unsigned long)in.frames, (unsigned long)wrong);
        glove.forced = 0;
        in.frames = 0;
        frames(100);
        CHECK(in.frames >= 100 - CYBERGLOVE_SURE, "%lu", (unsigned long)in.frames);
    }
}

/* ---- Errors ------------------------------------------------------------------------------ */

#define FRAMES 4000
#define EVERY  4
#define BAD    (FRAMES / EVERY)

/* Of FRAMES frames every EVERY-th is bad. How many frames come, and the count of this cause. ANY:
 * another cause may have some of them, but the sum is right. */
#define ANY -1
static const struct {
    enum emu_cyber_kind kind;
    int status, come, cause, count;
} row[] = {
    {EMU_CYBER_CUT, 0, FRAMES - 2 * BAD, CYBERGLOVE_LENGTH, BAD},
    {EMU_CYBER_CUT, 1, FRAMES - 2 * BAD, CYBERGLOVE_LENGTH, BAD},
    {EMU_CYBER_ZERO, 0, FRAMES - BAD, CYBERGLOVE_ZERO, ANY},
    {EMU_CYBER_ZERO, 1, FRAMES - BAD, CYBERGLOVE_ZERO, ANY},
    {EMU_CYBER_DROPPED, 0, FRAMES - BAD, CYBERGLOVE_ZERO, BAD},
    {EMU_CYBER_DROPPED, 1, FRAMES - BAD, CYBERGLOVE_FORM, BAD},
    {EMU_CYBER_INSERTED, 0, FRAMES - BAD, CYBERGLOVE_LENGTH, ANY},
    {EMU_CYBER_INSERTED, 1, FRAMES - BAD, CYBERGLOVE_LENGTH, BAD},
    {EMU_CYBER_ENDLESS, 0, FRAMES - 2 * BAD, CYBERGLOVE_LENGTH, BAD},
    {EMU_CYBER_ENDLESS, 1, FRAMES - 2 * BAD, CYBERGLOVE_LENGTH, BAD},
    {EMU_CYBER_TWICE, 0, FRAMES + BAD, CYBERGLOVE_LENGTH, 0},
    {EMU_CYBER_TWICE, 1, FRAMES + BAD, CYBERGLOVE_LENGTH, 0},
    {EMU_CYBER_SILENT, 1, FRAMES - BAD, CYBERGLOVE_LENGTH, 0},
    {EMU_CYBER_OFF, 0, FRAMES - BAD, CYBERGLOVE_UNPLUGGED, BAD},
    {EMU_CYBER_OFF, 1, FRAMES - BAD, CYBERGLOVE_UNPLUGGED, BAD},
    {EMU_CYBER_FAST, 0, FRAMES - BAD, CYBERGLOVE_FAST, BAD},
    {EMU_CYBER_FAST, 1, FRAMES - BAD, CYBERGLOVE_FAST, BAD},
    {EMU_CYBER_ERROR, 0, FRAMES, CYBERGLOVE_LENGTH, 0},
    {EMU_CYBER_ERROR, 1, FRAMES, CYBERGLOVE_LENGTH, 0},
    {EMU_CYBER_EIGHTEEN, 0, FRAMES - BAD, CYBERGLOVE_EIGHTEEN, BAD},
    {EMU_CYBER_EIGHTEEN, 1, FRAMES - BAD, CYBERGLOVE_EIGHTEEN, BAD},
};

static void go_wrong(enum emu_cyber_kind kind, int status)
{
    begin(status);
    in.frames = in.strays = in.errors = 0;
    memset(in.lost, 0, sizeof in.lost);
    glove.frames = 0;
    glove.wrong = 0;
    glove.kind = (uint8_t)kind;
    glove.every = EVERY;
    frames(FRAMES);
    CHECK_EQ_I64(glove.wrong, BAD);
}

TEST(what_goes_wrong_is_counted_and_does_not_get_in)
{
    for (size_t i = 0; i < LEN(row); i++) {
        go_wrong(row[i].kind, row[i].status);
        CHECK(wrong == 0, "%zu: %lu wrong frames came", i, (unsigned long)wrong);
        CHECK((int)in.frames == row[i].come, "%zu: %lu frames of %d", i, (unsigned long)in.frames,
            row[i].come);
        if (row[i].count == ANY) {
            CHECK(in.lost[row[i].cause] > BAD * 9 / 10 && lost() >= BAD && lost() < BAD + BAD / 10,
                "%zu: %lu, in all %lu", i, (unsigned long)in.lost[row[i].cause],
                (unsigned long)lost());
        } else {
            CHECK((int)in.lost[row[i].cause] == row[i].count && (int)lost() == row[i].count,
                "%zu: %lu, in all %lu", i, (unsigned long)in.lost[row[i].cause],
                (unsigned long)lost());
        }
        CHECK_EQ_I64(in.errors, row[i].kind == EMU_CYBER_ERROR ? BAD : 0);
    }
}

/* No header: bytes from nowhere. Noise: the frame behind it goes with it. */
TEST(noise_between_frames_is_counted)
{
    for (int status = 0; status < 2; status++) {
        go_wrong(EMU_CYBER_HEADLESS, status);
        CHECK(wrong == 0 && in.frames == FRAMES - BAD, "%lu, wrong %lu", (unsigned long)in.frames,
            (unsigned long)wrong);
        CHECK(in.strays > 20 * (BAD - lost()), "%lu", (unsigned long)in.strays);
        go_wrong(EMU_CYBER_GARBAGE, status);
        CHECK(wrong == 0 && in.frames == FRAMES - BAD, "%lu, wrong %lu", (unsigned long)in.frames,
            (unsigned long)wrong);
        CHECK_EQ_I64(in.strays, BAD * (EMU_CYBER_NOISE_B + 24 + status));
    }
}

/* All of them, for long: nothing comes but what was sent, and the first good ones behind it do. */
TEST(all_frames_wrong_and_then_well_again)
{
    for (int kind = EMU_CYBER_CUT; kind < EMU_CYBER_KINDS; kind++) {
        begin(1);
        in.told = 1;
        glove.kind = (uint8_t)kind;
        frames(200);
        glove.kind = EMU_CYBER_WELL;
        frames(1); /* what is held of the last may go with this one */
        in.frames = 0;
        frames(50);
        CHECK_EQ_I64(in.frames, 50);
        CHECK(wrong == 0, "kind %d: %lu", kind, (unsigned long)wrong);
    }
}

/* ---- Any bytes ------------------------------------------------------------------------------ */

/* Each output was in the input, from a 0 to a 0. */
TEST(any_bytes_give_only_what_has_the_form_of_a_frame)
{
    static const uint8_t odd[] = {0, 0, 0, 'S', 'G', 'e', 's', 'g', '?', 'u', 1, 3};
    while (check_case(20000)) {
        uint8_t last[CYBERGLOVE_FRAME_B + 1] = {0};
        uint32_t bytes = 0;
        memset(&in, 0, sizeof in);
        in.told = (uint8_t)(check_u64() & 1);
        for (int k = 0; k < 40000; k++) {
            const uint64_t r = check_u64();
            /* mostly in the place where a frame would have it */
            const uint8_t byte = r % 40 == 0  ? odd[(r >> 8) % LEN(odd)]
                                 : in.n == 0  ? 'S'
                                 : in.n == 23 ? 1
                                 : in.n == 24 ? 0
                                              : (uint8_t)(1 + (r >> 8) % 255);
            const uint32_t frames_before = in.frames;
            const int came = cyberglove_take(&in, byte);
            memmove(last, last + 1, sizeof last - 1);
            last[sizeof last - 1] = byte;
            bytes++;
            CHECK_EQ_I64(in.frames - frames_before, came);
            if (came) {
                const uint8_t *h = last + sizeof last - CYBERGLOVE_FRAME_B + (in.status == 0);
                CHECK(byte == 0 && (h[0] == 'S' || h[0] == 'G') &&
                          memcmp(h + 1, in.sample, SENSORS) == 0 &&
                          (h[-1] == 0 || bytes < sizeof last) && !memchr(in.sample, 0, SENSORS),
                    "byte %lu", (unsigned long)bytes);
                CHECK(!in.told || in.status & 1, "status %d", in.status);
            }
        }
        CHECK(in.frames > 300 && 24 * in.frames + in.strays <= bytes, "%lu frames, %lu strays",
            (unsigned long)in.frames, (unsigned long)in.strays);
    }
}

TEST(each_cause_has_its_word)
{
    for (unsigned i = 0; i < CYBERGLOVE_CAUSES; i++) {
        CHECK(strcmp(cyberglove_cause_text(i), "unknown") != 0, "cause %u", i);
    }
    CHECK(strcmp(cyberglove_cause_text(CYBERGLOVE_CAUSES), "unknown") == 0, "beyond");
}

TEST(a_sample_is_a_code_of_the_card)
{
    CHECK_EQ_I64(cyberglove_raw(1), -29491);
    CHECK_EQ_I64(cyberglove_raw(128), 0);
    CHECK_EQ_I64(cyberglove_raw(255), 29491);
    for (int i = 1; i <= 255; i++) { /* 18 V of 20 V over 254 steps, to half a code */
        const double off = cyberglove_raw((uint8_t)i) - (i - 128) * 58982.4 / 254;
        CHECK(off >= -0.5 && off <= 0.5, "%d: %g", i, off);
    }
}

TEST_MAIN("serial/parser", each_frame_comes_as_it_was_sent, a_frame_that_is_asked_for_is_one,
    the_form_is_learned_or_told, a_form_that_changes_is_taken_when_it_is_sure_unless_told,
    what_goes_wrong_is_counted_and_does_not_get_in, noise_between_frames_is_counted,
    all_frames_wrong_and_then_well_again, any_bytes_give_only_what_has_the_form_of_a_frame,
    each_cause_has_its_word, a_sample_is_a_code_of_the_card);
