/* SPDX-License-Identifier: MIT */
/* A model made for one rate, whose ports are named otherwise; init, step and terminate are called
 * when they should be. */
#include "rig.h"
#include "closed/sim/said.h"

#include "custom/slot_real.h"

#include "exhand/error.h"

#include <sys/wait.h>

static uint32_t ticks;
static int64_t off;

static void start(const struct exh_scene *sc, struct exh_scene_board board)
{
    (void)sc;
    (void)board;
    ticks = 0;
    off = 0;
}

static void before(uint32_t tick, struct exh_scene_in *in)
{
    (void)tick;
    (void)in;
}

/* It begins at 7 and counts a step a tick, in every state of the box: rounded to 2^-20 N. */
static void after(uint32_t tick, const struct exh_scene_in *in, const struct exh_drive_out *out)
{
    const double want = 0.001 * (7.0 + ticks++) * 1048576.0;
    (void)tick;
    (void)in;
    (void)out;
    if (want <= 2147483646.0) { off += rig_signals()->ask_N_q20 != (int32_t)(want + 0.5); }
}

TEST(a_step_a_tick)
{
    static const struct exh_loop_hooks hooks = {start, before, after};
    struct run_cfg c = rig(500, -1, -1);
    struct run r;
    c.more = &hooks;
    c.board.max_ticks = 3000;
    for (int i = 0; i < 2; i++) {
        (void)run_drop(&c, &r);
        run_free(&r);
        CHECK(ticks >= 2000 && off == 0, "run %d: %lu ticks, %lld off", i, (unsigned long)ticks,
            (long long)off);
    }
}

TEST(another_rate_is_refused)
{
    static struct said s;
    char *dir = said_dir();
    exh_scene_custom.defaults();
    exh_params_apply(exh_scene_custom.params);
    CHECK_EQ_I64(exh_scene_custom.setup((struct exh_scene_board){{1, 500}, 24}), 0);
    CHECK_EQ_I64(exh_scene_custom.setup((struct exh_scene_board){{2, 1000}, 24}), 0);
    CHECK_EQ_I64(exh_scene_custom.setup((struct exh_scene_board){{1, 501}, 24}), -EXH_E_RATE);
    CHECK_EQ_I64(exh_scene_custom.setup((struct exh_scene_board){{1, 1000}, 24}), -EXH_E_RATE);
    for (int i = 0; i < 2; i++) {
        said(&s, dir, i ? cli_run : cli_drop,
            i ? WORDS("run", "--scene", "custom", "--seconds", "1")
              : WORDS("drop", "--custom", "--rate", "1000"));
        CHECK(s.status == 2 && strstr(s.err, "this controller was made for 500 Hz"), "%d: %s",
            s.status, s.err);
    }
    said_clean(dir);
}

/* A step without an answer is one, too. */
TEST(time_goes_on_without_an_answer)
{
    const volatile double zero = 0;
    real_wire(NULL, 0, (struct exh_period){1, 500});
    CHECK_EQ_I64(real_out(-1), -EXH_Q(1, 1, EXH_Q_FORCE));
    CHECK_EQ_I64(real_none(), SLOT_NONE);
    CHECK_EQ_I64(real_out(zero / zero), SLOT_NONE);
    CHECK(real_t_s() == 3 / 500.0, "%.17g s", real_t_s());
}

/* --- headers that the adapter does not understand: a line on stderr, status 2, and no adapter ---
 */

static int adapt(const char *header, const char *options, char *said, size_t cap)
{
    const char *path = log_path();
    char command[512];
    FILE *f = fopen(path, "wb");
    size_t n;
    int status;
    CHECK(f != NULL, "%s", path);
    fputs(header, f);
    CHECK_EQ_I64(fclose(f), 0);
    snprintf(command, sizeof command, "awk -v model=m %s -f examples/custom/adapter.awk %s 2>&1",
        options, path);
    f = popen(command, "r");
    CHECK(f != NULL, "%s", command);
    n = fread(said, 1, cap - 1, f);
    said[n] = '\0';
    status = pclose(f);
    CHECK_EQ_I64(remove(path), 0);
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

#define INPUTS  "typedef struct { real_T q; } ExtU_m_T;\nextern ExtU_m_T m_U;\n"
#define OUTPUTS "typedef struct { real_T f; } ExtY_m_T;\nextern ExtY_m_T m_Y;\n"
#define ENTRIES "extern void m_initialize(void);\nextern void m_step(void);\n"
#define STATES  "typedef struct { real_T x; } DW_m_T;\nextern DW_m_T m_DW;\n"
#define TIMED   "struct tag_RTM_m_T { struct { uint32_T clockTick0; } Timing; };\n"
#define TYPES \
    "typedef struct { real_T x; } DW_m_T;\ntypedef struct { real_T q; } ExtU_m_T;\ntypedef " \
    "struct { real_T f; } ExtY_m_T;\n"
#define REUSABLE(keeps, more) \
    "struct tag_RTM_m_T { const char_T *errorStatus; " keeps \
    " };\nextern void m_initialize(RT_MODEL_m_T *const m_M);\n" \
    "extern void m_step(RT_MODEL_m_T *const m_M" more ", ExtU_m_T *m_U, ExtY_m_T *m_Y);\n"

TEST(what_is_not_understood_is_named)
{
    static const struct {
        const char *header, *options, *told;
    } bad[] = {
        {"extern void other_step(void);", "", "m.h: no m_step(): "},
        {"extern void m_step(void);", "", "m.h: no m_initialize()"},
        {"extern void m_initialize(void);\nextern void m_step(int_T tid);", "",
            "m.h: m_step(int_T tid): not understood"},
        {INPUTS ENTRIES, "", "m.h: no m_Y: "},
        {INPUTS "typedef struct { real_T g; } ExtY_m_T;\nextern ExtY_m_T m_Y;\n" ENTRIES, "",
            "m.h: no outport f, "},
        {"typedef struct { real_T q[5]; } ExtU_m_T;\nextern ExtU_m_T m_U;\n" OUTPUTS ENTRIES, "",
            "ExtU_m_T: \"real_T q[5]\": only scalars"},
        {INPUTS OUTPUTS STATES ENTRIES, "", "m.h: it remembers, so it was made for one rate"},
        {INPUTS OUTPUTS TIMED ENTRIES, "", "m.h: it remembers, so it was made for one rate"},
        {TYPES REUSABLE("real_T x; DW_m_T dwork;", ""), "",
            "m.h: it remembers, so it was made for one rate"},
        {TYPES REUSABLE("", ", DW_m_T *m_DW"), "",
            "m.h: it remembers, so it was made for one rate"},
        {INPUTS OUTPUTS STATES ENTRIES, "-v rate=1kHz",
            "m.h: MODEL_RATE=1kHz: give a whole number of Hz"},
        {INPUTS OUTPUTS STATES ENTRIES, "-v rate=0",
            "m.h: MODEL_RATE=0: give a whole number of Hz"},
        {INPUTS "typedef struct { int16_T f; } ExtY_m_T;\nextern ExtY_m_T m_Y;\n" ENTRIES, "",
            "m.h: f: int16_T: wanted is real_T"},
        {"typedef struct { int32_T q; } ExtU_m_T;\nextern ExtU_m_T m_U;\n" OUTPUTS ENTRIES, "",
            "m.h: q: int32_T: wanted is real_T"},
        {INPUTS "typedef struct { real_T f[5]; } ExtY_m_T;\nextern ExtY_m_T m_Y;\n" ENTRIES, "",
            "ExtY_m_T: \"real_T f[5]\": only scalars"},
        {INPUTS "typedef struct { real_T f; real_T g; } ExtY_m_T;\nextern ExtY_m_T m_Y;\n" ENTRIES,
            "-v map=g=f", "m.h: g: a second outport for f"},
    };
    static const struct {
        const char *header, *options, *told;
    } good[] = {
        {INPUTS OUTPUTS ENTRIES, "", "slot = {\"m\", 0u, 1, "},
        {INPUTS OUTPUTS STATES ENTRIES, "-v rate=250", "slot = {\"m\", 250u, 1, "},
        {"typedef struct { real_T T; } ExtU_m_T;\nextern ExtU_m_T m_U;\n" OUTPUTS STATES ENTRIES,
            "", "slot = {\"m\", 0u, 0, "},
        {INPUTS "typedef struct { real_T g; /* a \"comment\" ; } */ } ExtY_m_T;\nextern ExtY_m_T "
                "m_Y;\n" ENTRIES,
            "-v map=g=f", "m_Y.g"},
        {"#ifdef __cplusplus\nextern \"C\" {\n#endif\n" INPUTS OUTPUTS ENTRIES
         "#ifdef __cplusplus\n}\n#endif\n",
            "", "m_U.q = (real_T)real_in(0);"},
        {INPUTS
            "typedef struct { real_T v[5]; real_T f; } ExtY_m_T;\nextern ExtY_m_T m_Y;\n" ENTRIES,
            "", "real_out((double)m_Y.f)"},
        {"#define M(a) \\\n  ((a)->b; { \\\n  )\n" INPUTS OUTPUTS ENTRIES, "",
            "real_out((double)m_Y.f)"},
        {TYPES REUSABLE("", ""), "", "rtm.errorStatus ? real_none() : real_out((double)its_m_Y.f)"},
    };
    char said[8192];
    for (size_t i = 0; i < sizeof bad / sizeof bad[0]; i++) {
        CHECK_EQ_I64(adapt(bad[i].header, bad[i].options, said, sizeof said), 2);
        CHECK(strstr(said, bad[i].told) != NULL && strstr(said, "slot = ") == NULL,
            "wanted \"%s\", said: %s", bad[i].told, said);
    }
    for (size_t i = 0; i < sizeof good / sizeof good[0]; i++) {
        CHECK_EQ_I64(adapt(good[i].header, good[i].options, said, sizeof said), 0);
        CHECK(strstr(said, good[i].told) != NULL, "wanted \"%s\", said: %s", good[i].told, said);
    }
}

TEST_MAIN("slot/count", a_step_a_tick, another_rate_is_refused, time_goes_on_without_an_answer,
    what_is_not_understood_is_named);
