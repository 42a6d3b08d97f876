/* SPDX-License-Identifier: MIT */
/* PROVES: loop and switch
 * The loop and the dead-man switch. The board answers anything, with any timer and missed ticks,
 * and its calls may fail at any time without filling their results. One scene has glove, link,
 * parameters and words; another has none and asserts its inputs. The place of an assertion, with a
 * name of any length.
 *
 * EVA: -kernel-warn-key annot:missing-spec=abort
 * PLANT: lib/src/run/loop.c: while (in->packets < EXH_SCENE_PACKETS) { -> while (in->packets <= EXH_SCENE_PACKETS) {
 * PLANT: lib/src/run/loop.c: if (n <= 0 || n > EXH_SCENE_PACKET_B) { return; } -> if (n <= 0) { return; }
 * PLANT: lib/src/run/loop.c: if (err == 0) { err = sc->setup(*board); } -> err = sc->setup(*board);
 * PLANT: lib/src/run/loop.c: if (err < 0) { return err; } -> (void)0;
 * PLANT: lib/src/run/loop.c: if (sc->end) { sc->end(); } -> sc->end();
 * PLANT: lib/src/run/loop.c: if (sc->tell) { sc->tell(); } -> sc->tell();
 * PLANT: lib/src/run/loop.c: file[n] != '\0' && n < 48 -> file[n] != '\0'
 * PLANT: lib/src/run/deadman.c: safety ? safety->state : (uint8_t)EXH_STATE_OFF; -> safety->state;
 * PLANT: lib/src/run/loop.c: if (err == 0 && !exh_period_ok(board->T)) { err = -EXH_E_RATE; } -> (void)0;
 */
#define exh_assert_failed loop_assert_failed
#include "run/loop.c"
#undef exh_assert_failed
#define exh_udiv64 udiv64_by_steps
#include "num/fix.c"
#undef exh_udiv64
#include "quotient.h"
#include "run/deadman.c"

#include "any.h"

/* --- the board --- */

static int stands; /* its timer says so: 0 a second */

static uint32_t any_num(void) { return stands ? 0 : Frama_C_unsigned_int_interval(1, UINT32_MAX); }

int exh_board_init(uint32_t rate_Hz, struct exh_period *achieved)
{
    (void)rate_Hz;
    if (any8() & 1) { return -EXH_E_RATE; }
    achieved->num = any_num();
    achieved->den = any_u32();
    return 0;
}

int exh_board_wait(void) { return any32(); }

int exh_board_read_drive(struct exh_drive_in *in)
{
    if (any8() & 1) { return -EXH_E_STATE; }
    ANY(*in);
    return 0;
}

int exh_board_write_drive(const struct exh_drive_out *out)
{
    /*@ assert write_drive: \initialized(out); */
    return any8() & 1 ? -EXH_E_STATE : 0;
}

void exh_board_safe(void) {}

void exh_board_halt(const char *why)
{
    /*@ assert words: \valid_read(why); */
    (void)why;
}

static int read_glove_board(struct exh_glove_in *in)
{
    if (any8() & 1) { return -EXH_E_STATE; }
    ANY(*in);
    return 0;
}

/* --- the scene --- */

static struct exh_scene_mail mail_in, mail_out;

static int recv_any(void *buf, size_t cap_B)
{
    /*@ assert recv: \valid((char *)buf + (0 .. cap_B - 1)); */
    Frama_C_make_unknown(buf, cap_B);
    return any32();
}

static int send_any(const void *buf, size_t len_B)
{
    /*@ assert send: \valid_read((char *)buf + (0 .. len_B - 1)); */
    return any32();
}

static void write_any(void)
{
    ANY(mail_out);
    mail_out.packets = (uint8_t)Frama_C_unsigned_int_interval(0, EXH_SCENE_PACKETS);
    for (unsigned i = 0; i < EXH_SCENE_PACKETS; i++) {
        mail_out.len_B[i] = (uint16_t)Frama_C_unsigned_int_interval(1, EXH_SCENE_PACKET_B);
    }
}

static int setup_any(struct exh_scene_board board)
{
    /*@ assert setup: \initialized(&board.T) && \initialized(&board.enc_bits); */
    return any8() & 1 ? -EXH_E_RANGE : 0;
}

static void tick_any(const struct exh_scene_in *in, struct exh_drive_out *out)
{
    /*@ assert given: \initialized(&in->drive) && \initialized(&in->missed) && \initialized(&in->command) && \initialized(&in->glove); */
    for (unsigned i = 0; i < mail_in.packets; i++) {
        const uint16_t len_B = mail_in.len_B[i];
        /*@ assert mail: 1 <= len_B <= 256; */
    }
    ANY(*out);
}

int exh_params_apply(struct exh_params *p)
{
    /*@ assert apply: \valid(p); */
    return any32();
}

static void tell_any(void) {}
static void end_any(void) {}

static void after_any(uint32_t tick, const struct exh_scene_in *in, const struct exh_drive_out *out)
{
    (void)tick;
    /*@ assert after: \initialized(&in->drive) && \initialized(out); */
}

static void run(const struct exh_scene *sc, const struct exh_loop_hooks *hooks)
{
    (void)exh_loop(sc, any_u32(), hooks);
    END();
}

static void place_of(void)
{
    static char file[100];
    for (unsigned i = 0; i < sizeof file - 1; i++) { file[i] = (char)Frama_C_interval(0, 127); }
    loop_assert_failed(file, any32());
}

int main(void)
{
    static const struct exh_scene_link link = {recv_any, send_any, &mail_in, &mail_out, write_any};
    static const struct exh_loop_hooks all = {exh_deadman_start, exh_deadman_before, after_any};
    static struct exh_params params;
    static struct exh_safety state;
    static int32_t every;
    static const struct exh_scene rich = {.rate_Hz = 2000,
        .fingers = 1,
        .params = &params,
        .apply = exh_params_apply,
        .safety = &state,
        .link = &link,
        .read_glove = read_glove_board,
        .glove_every = &every,
        .setup = setup_any,
        .tick = tick_any,
        .tell = tell_any,
        .end = end_any};
    static const struct exh_scene bare = {
        .rate_Hz = 2000, .fingers = 5, .setup = setup_any, .tick = tick_any};
    ANY(state);
    every = any32();
    for (unsigned i = 0; i < EXH_SCENE_PACKETS; i++) {
        mail_in.len_B[i] = 1;
    } /* those that are written join it */
    run(&rich, &all);
    run(&bare, &all);
    run(&bare, NULL);
    stands = 1;
    run(&rich, &all);
    place_of();
    return 0;
}
