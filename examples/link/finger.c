/* SPDX-License-Identifier: MIT */
/* A firmware-style program that uses only the library: one finger, one wall, its own loop and
 * board.
 *
 * The board is simulated. A finger moves 25 mm out and back in a second, a motor follows its code
 * without delay, and a hand holds the dead-man switch. On a real board, the functions of "board"
 * access registers and pins. The program confirms what it has tested: the self-test of the library.
 * It names what it has not: calibration and polarity.
 *
 * It prints the force at the deepest point and a CRC-32 of all D/A codes. Both are equal on every
 * CPU, with every compiler and way of linking (test/walk/link compares them). */
#include "exhand/exhand.h"

#include <stdio.h>

/* --- board: 5 um per count, D/A and monitor of the paper's device --- */

enum { RATE_Hz = 1000, REST = 1200, TICKS = REST + 1000 };

static uint16_t dac_raw = 32768;

static uint32_t board_count(int tick) /* rests for 1.2 s, then 5000 counts out and back */
{
    const int t = tick < REST ? 0 : tick - REST;
    return (uint32_t)(t < 500 ? 10 * t : 10 * (1000 - t));
}

static int16_t board_monitor(void) /* 1.76 A/V at 3249 codes/V; 1936.5 codes/A */
{
    return (int16_t)(((int32_t)dac_raw - 32768) * 1049 / 1000);
}

/* Every contact is normally closed: 1 is healthy. A real board reads five pins here. Wire a missing
 * line closed, so that the builder of the device decides it, not the program. */
static uint32_t board_inputs(void)
{
    const int estop_closed = 1, deadman_held = 1, watchdog_quiet = 1, cards_answer = 1, ready = 1;
    uint32_t din = 0;
    if (estop_closed) { din |= EXH_DIN_ESTOP; }
    if (deadman_held) { din |= EXH_DIN_DEADMAN; }
    if (watchdog_quiet) { din |= EXH_DIN_WATCHDOG; }
    if (cards_answer) { din |= EXH_DIN_CARDS; }
    if (ready) { din |= EXH_DIN_DRIVE0; }
    return din;
}

static void board_read(int tick, struct exh_drive_in *in)
{
    in->enc_raw[0] = board_count(tick);
    in->mon_raw[0] = board_monitor();
    in->din = board_inputs();
}

static void board_write(const struct exh_drive_out *out) { dac_raw = out->dac_raw[0]; }

void exh_assert_failed(
    const char *file, int line) /* the library's one hook: outputs safe, then stop */
{
    dac_raw = 32768;
    printf("%s:%d: stopped\n", file, line);
    for (;;) {}
}

/* --- controller --- */

static const struct exh_quad_par quad_par = {
    EXH_Q(5, 1000000, EXH_Q_STEP), EXH_Q(10, 1, EXH_Q_VEL)};
static const struct exh_velocity_par vel_par = {4};
static const struct exh_contact_par wall = {EXH_Q(800, 1, EXH_Q_K), EXH_Q(2, 1, EXH_Q_B), 0, 0, 0};
static const int32_t wall_m_q30 = EXH_Q(2, 100, EXH_Q_POS);
static const struct exh_drive_par drive_par = {EXH_Q(10, 1, EXH_Q_FORCE), 1000, 1000, /* N, N/s */
    EXH_Q(33, 10, EXH_Q_CUR), EXH_Q(33, 10, EXH_Q_CUR), 2700,                         /* A, ms */
    32768, 12184, EXH_Q(324900, 176, EXH_Q_DAC),          /* zero, span, codes/A */
    0, EXH_Q(5164, 10000000, EXH_Q_MON),                  /* zero, A/code */
    EXH_Q(10, 1, EXH_Q_FORCE), EXH_Q(33, 10, EXH_Q_CUR)}; /* the person's limits: N, A */
static const struct exh_tracking_par track_par = {EXH_Q(1, 4, EXH_Q_CUR), 20};
static const struct exh_safety_par safety_par = {1, EXH_Q(1, 1, EXH_Q_FORCE), 50, 500, 15};
static struct exh_knot knot[2] = {
    {0, 0, {0, 0}}, {EXH_Q(22, 1, EXH_Q_FORCE), EXH_Q(66, 10, EXH_Q_CUR), {0, 0}}};

static struct exh_quad_cfg quad_cfg;
static struct exh_velocity_window_cfg vel_cfg;
static struct exh_drive_cfg drive_cfg;
static struct exh_tracking_cfg track_cfg;
static struct exh_safety_cfg safety_cfg;

static struct exh_quad quad;
static struct exh_velocity_window vel;
static struct exh_drive drive;
static struct exh_tracking track;
static struct exh_safety safety;
static uint8_t vouched = EXH_UNCALIBRATED | EXH_UNPOLARISED;

/* Encoder, velocity, no motion monitor, tracking, drive. */
static const struct exh_axis axis = {&quad, &quad_cfg, &vel, &vel_cfg, NULL, NULL, &track,
    &track_cfg, &drive, &drive_cfg, NULL, NULL};

static int setup(void)
{
    static const struct exh_axis_setup parts = {&quad_cfg, &quad_par, &vel_cfg, &vel_par, NULL,
        NULL, &track_cfg, &track_par, &drive_cfg, &drive_par, NULL, NULL};
    const struct exh_period T = {1, RATE_Hz};
    const struct exh_table force_to_cur = {knot, 2}, no_table = {0, 0};
    int err = exh_table_setup(knot, 2);
    if (err == 0) { err = exh_axis_setup(&parts, T, 24, force_to_cur, no_table); }
    if (err == 0) { err = exh_safety_setup(&safety_cfg, &safety_par, T); }
    if (exh_selftest() == EXH_SELFTEST_OK) { vouched = (uint8_t)(vouched | EXH_ARM_SELFTEST); }
    return err;
}

static void tick(const struct exh_drive_in *in, uint8_t command, struct exh_drive_out *out)
{
    const struct exh_axis_now now = exh_axis_sense(&axis, in, 0);
    const struct exh_safety_in box = {in->din, 0, 0, command, 1, vouched};
    const struct exh_permit permit = exh_axis_permit(&safety, &safety_cfg, &now, 1, box);
    const struct exh_contact_in q = {now.pos_m_q30, now.vel_mps_q27, wall_m_q30};
    struct exh_force_ledger force;
    struct exh_current_ledger current;
    uint32_t limits;

    (void)exh_contact_law(&wall, q, &force);
    limits = now.limits | exh_axis_force(&axis, &permit, &force, &current);
    exh_axis_out(&axis, &safety, now.cnt, &current, &limits, out);
}

int main(void)
{
    int32_t most_N_q20 = 0;
    uint32_t crc = 0;
    const int err = setup();
    if (err != 0) {
        printf("%s\n", exh_error_text(err));
        return 1;
    }
    for (int t = 0; t < TICKS; t++) {
        struct exh_drive_in in = {{0}, {0}, 0, 0};
        struct exh_drive_out out;
        uint8_t code[2];
        board_read(t, &in);
        tick(&in, t == 0 ? EXH_CMD_RUN : EXH_CMD_NONE, &out);
        board_write(&out);
        code[0] = (uint8_t)(out.dac_raw[0] & 0xFFu);
        code[1] = (uint8_t)(out.dac_raw[0] >> 8);
        most_N_q20 = drive.force_N_q20 > most_N_q20 ? drive.force_N_q20 : most_N_q20;
        crc = exh_crc32(crc, code, sizeof code);
    }
    printf("exhand %d.%d.%d: state %d, %ld mN at most, codes %08lx\n", EXH_VERSION_MAJOR,
        EXH_VERSION_MINOR, EXH_VERSION_PATCH, (int)safety.state,
        (long)(((int64_t)most_N_q20 * 1000) >> 20), (unsigned long)crc);
    return 0;
}
