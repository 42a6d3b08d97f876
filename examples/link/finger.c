/* SPDX-License-Identifier: MIT */
/* A firmware-style program over the library alone: its own loop, its own board, one finger and one
 * wall. Nothing of exhand but lib/ is needed. The board here is played: a finger that goes 25 mm
 * out and back in a second, and a motor that follows its code at once. On a real one the three
 * functions of "board" touch registers.
 *
 * Prints the force at the deepest point and a CRC-32 over all codes that went to the D/A: the same
 * on every CPU, by every compiler and however the library was linked (test/link checks all of them
 * against each other). */
#include "exhand/exhand.h"

#include <stdio.h>

/* --- board: 5 um a count, D/A and monitor of the paper's box --- */

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

static void board_write(const struct exh_drive_out *out)
{
    dac_raw = out->dac_raw[0];
}

void exh_assert_failed(const char *file,
                       int line) /* the library's one hook: outputs safe, then stop */
{
    dac_raw = 32768;
    printf("%s:%d: stopped\n", file, line);
    for (;;) {}
}

/* --- controller --- */

static const struct exh_quad_par quad_par = {EXH_Q(5, 1000000, EXH_Q_STEP),
                                             EXH_Q(10, 1, EXH_Q_VEL)};
static const struct exh_velocity_par vel_par = {4};
static const struct exh_contact_par wall = {EXH_Q(800, 1, EXH_Q_K), EXH_Q(2, 1, EXH_Q_B), 0, 0, 0};
static const int32_t wall_m_q30 = EXH_Q(2, 100, EXH_Q_POS);
static const struct exh_drive_par drive_par = {
    EXH_Q(10, 1, EXH_Q_FORCE),
    1000,
    1000, /* N, N/s */
    EXH_Q(33, 10, EXH_Q_CUR),
    EXH_Q(33, 10, EXH_Q_CUR),
    2700, /* A, ms */
    32768,
    12184,
    EXH_Q(324900, 176, EXH_Q_DAC), /* zero, span, codes/A */
    0,
    EXH_Q(5164, 10000000, EXH_Q_MON)}; /* zero, A/code */
static const struct exh_track_par track_par = {EXH_Q(1, 4, EXH_Q_CUR), 20};
static const struct exh_safety_par safety_par = {1, EXH_Q(1, 1, EXH_Q_FORCE), 50, 500, 15};
static struct exh_knot knot[2] = {{0, 0, {0, 0}},
                                  {EXH_Q(22, 1, EXH_Q_FORCE), EXH_Q(66, 10, EXH_Q_CUR), {0, 0}}};

static struct exh_quad_cfg quad_cfg;
static struct exh_velocity_window_cfg vel_cfg;
static struct exh_drive_cfg drive_cfg;
static struct exh_track_cfg track_cfg;
static struct exh_safety_cfg safety_cfg;

static struct exh_quad quad;
static struct exh_velocity_window vel;
static struct exh_contact contact;
static struct exh_drive drive;
static struct exh_track track;
static struct exh_safety safety;

static int setup(void)
{
    const struct exh_period T = {1, RATE_Hz};
    const struct exh_velocity_scale scale = {quad_par.step_m_q42, T};
    const struct exh_table force_to_cur = {knot, 2}, no_table = {0, 0};
    int err = exh_table_set(knot, 2);
    if (err == 0) { err = exh_quad_setup(&quad_cfg, &quad_par, T, 24); }
    if (err == 0) { err = exh_velocity_window_setup(&vel_cfg, scale, &vel_par); }
    if (err == 0) { err = exh_drive_setup(&drive_cfg, &drive_par, T, force_to_cur, no_table); }
    if (err == 0) { err = exh_track_setup(&track_cfg, &track_par, T); }
    if (err == 0) { err = exh_safety_setup(&safety_cfg, &safety_par, T); }
    return err;
}

static int32_t tick(uint32_t enc_raw, int16_t mon_raw, uint8_t command, struct exh_drive_out *out)
{
    struct exh_force_ledger force;
    struct exh_current_ledger current;
    uint32_t limits;
    const int32_t cnt = exh_quad_extend(&quad, &quad_cfg, enc_raw);
    const struct exh_contact_in q = {exh_quad_pos_m_q30(&quad_par, cnt),
                                     exh_velocity_window_mps_q27(&vel, &vel_cfg, cnt), wall_m_q30};
    const int astray =
        exh_track_step(&track, &track_cfg, exh_drive_monitor_A_q26(&drive_cfg, mon_raw));
    /* A real box has its switches here, and vouches only for what it has tried: exhand/safety.h. */
    struct exh_safety_in box = {EXH_DIN_ESTOP | EXH_DIN_DEADMAN | EXH_DIN_WATCHDOG | EXH_DIN_CARDS |
                                    EXH_DIN_DRIVE0,
                                0,
                                0,
                                0,
                                1,
                                EXH_ARM_ALL};
    struct exh_permit permit;

    if (quad.lost) { box.raised |= EXH_FAULT_ENCODER; }
    if (astray) { box.raised |= EXH_FAULT_TRACKING; }
    box.command = command;
    permit = exh_safety_step(&safety, &safety_cfg, box);
    exh_contact_law(&contact, &wall, q, &force);
    limits = exh_drive_force(&drive, &drive_cfg, &permit, &force);
    limits |= exh_drive_current(&drive, &drive_cfg, &force, &current);
    exh_gate(&safety, &drive_cfg, 1, &current, &limits, out);
    exh_track_coded(&track, current.coded_A_q26);
    return drive.force_N_q20;
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
        struct exh_drive_out out;
        const int32_t force_N_q20 =
            tick(board_count(t), board_monitor(), t == 0 ? EXH_CMD_RUN : EXH_CMD_NONE, &out);
        const uint8_t code[2] = {(uint8_t)(out.dac_raw[0] & 0xFFu), (uint8_t)(out.dac_raw[0] >> 8)};
        board_write(&out);
        most_N_q20 = force_N_q20 > most_N_q20 ? force_N_q20 : most_N_q20;
        crc = exh_crc32(crc, code, sizeof code);
    }
    printf("exhand %d.%d.%d: state %d, %ld mN at most, codes %08lx\n", EXH_VERSION_MAJOR,
           EXH_VERSION_MINOR, EXH_VERSION_PATCH, (int)safety.state,
           (long)(((int64_t)most_N_q20 * 1000) >> 20), (unsigned long)crc);
    return 0;
}
