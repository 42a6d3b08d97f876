/* SPDX-License-Identifier: MIT */
/* safety.h: the gate. */
#include "exhand/safety.h"

#include "check.h"

struct box {
    struct exh_drive_par par[EXH_FINGERS];
    struct exh_knot knot[2];
    struct exh_drive_cfg cfg[EXH_FINGERS];
    struct exh_current_ledger i[EXH_FINGERS];
    uint32_t limits[EXH_FINGERS];
    struct exh_drive_out out;
    struct exh_safety s;
};

static void box_setup(struct box *b)
{
    static const struct box zero;
    const struct exh_table none = {NULL, 0};
    *b = zero;
    b->s.fingers = EXH_FINGERS; /* all drives seen ready */
    b->knot[1].x = b->knot[1].y = 1 << 20;
    CHECK_EQ_I64(exh_table_setup(b->knot, 2), 0);
    for (unsigned k = 0; k < EXH_FINGERS; k++) {
        const struct exh_table t = {b->knot, 2};
        int32_t *field = &b->par[k].f_max_N_q20;
        for (size_t r = 0; r < EXH_DRIVE_ROWS; r++) { field[r] = exh_drive_rows[r].dflt; }
        CHECK_EQ_I64(
            exh_drive_setup(&b->cfg[k], &b->par[k], (struct exh_period){1, 2000}, t, none), 0);
        b->i[k].table_A_q26 = EXH_Q(3, 1, EXH_Q_CUR) * ((int)k % 3 - 1);
    }
}

/* Any state with the share of arming at 0 and above; 6 and more: one that no one has heard of. */
TEST(gate_in_every_state)
{
    for (unsigned c = 0; c < 20; c++) {
        const int share = c >= 10;
        const uint8_t state = (uint8_t)(c % 10);
        const int open = (state == EXH_STATE_ARM && share) || state == EXH_STATE_RUN ||
                         state == EXH_STATE_LIMIT || state == EXH_STATE_RELEASE;
        uint32_t all = 0;
        struct box b;
        box_setup(&b);
        b.s.state = state;
        b.s.share_q30 = share;
        b.s.limits = 0xFFFF; /* of the tick before */
        b.limits[2] = EXH_LIMIT_SPEED;
        for (unsigned k = 0; k < 5; k++) { b.s.off_raw[k] = 5538; } /* and its code */
        CHECK_EQ_I64(exh_safety_is_open(&b.s), open);
        exh_gate_step(&b.s, b.cfg, 5, b.i, b.limits, &b.out);
        CHECK_EQ_I64(b.out.enable, open ? 0x1F : 0);
        for (unsigned k = 0; k < 5; k++) {
            const int64_t codes = 5538 * ((int64_t)k % 3 - 1); /* 3 A, 1846.02 codes/A */
            CHECK_EQ_I64(b.out.dac_raw[k], open ? 32768 + codes : 32768);
            CHECK_EQ_I64(b.i[k].gate_A_q26, open ? 0 : -b.i[k].table_A_q26);
            CHECK((b.limits[k] & EXH_LIMIT_GATE) != 0 || open || b.i[k].table_A_q26 == 0,
                "the gate acts unreported, finger %u", k);
            CHECK_EQ_I64(b.i[k].coded_A_q26, b.i[k].table_A_q26 + b.i[k].peak_A_q26 +
                                                 b.i[k].i2t_A_q26 + b.i[k].gate_A_q26 +
                                                 b.i[k].dac_A_q26);
            if (!open) { CHECK_EQ_I64(b.i[k].coded_A_q26, 0); }
            all |= b.limits[k];
        }
        CHECK_EQ_I64(b.s.limits, all);
        CHECK(all & EXH_LIMIT_SPEED, "told by the scene");
    }
}

TEST(a_shut_gate_makes_a_frame_that_drives_nothing)
{
    struct box b;
    box_setup(&b);
    b.s.state = EXH_STATE_RUN; /* it asks no state */
    b.s.alive = 255;
    b.out.enable = 0x1F;
    exh_gate_shut(&b.s, 1234, &b.out);
    CHECK_EQ_I64(b.out.enable, 0);
    CHECK_EQ_I64(b.out.alive, 0);
    CHECK_EQ_I64(b.s.alive, 0);
    for (unsigned k = 0; k < EXH_FINGERS; k++) { CHECK_EQ_I64(b.out.dac_raw[k], 1234); }
}

/* A table, a scale or a limit is damaged while a force is released. The code stays where it was.
 * Once it was nearer to zero, it does not go back. */
TEST(a_release_never_rises)
{
    static const int32_t amp[] = {2, 3, -3, 1, 2, -6, 0, 1};
    static const int32_t most[] = {2, 2, -2, 1, 1, -1, 0, 0};
    struct box b;
    box_setup(&b);
    b.s.state = EXH_STATE_RUN;
    for (size_t t = 0; t < LEN(amp); t++) {
        b.i[0].table_A_q26 = amp[t] * (1 << 26);
        b.limits[0] = 0;
        exh_gate_step(&b.s, b.cfg, 1, b.i, b.limits, &b.out);
        CHECK_EQ_I64(b.out.dac_raw[0], 32768 + most[t] * 1846);
        CHECK((b.limits[0] != 0) == (amp[t] != most[t]), "%zu: told", t);
        CHECK_EQ_I64(b.i[0].coded_A_q26, b.i[0].table_A_q26 + b.i[0].gate_A_q26 + b.i[0].dac_A_q26);
        b.s.state = EXH_STATE_RELEASE;
    }
    b.par[0].dac_rawpA_q16 *= 2; /* nor by the scale */
    b.s.off_raw[0] = 100;
    exh_gate_step(&b.s, b.cfg, 1, b.i, b.limits, &b.out);
    CHECK_EQ_I64(b.out.dac_raw[0], 32868);
    b.s.state = EXH_STATE_FAULT; /* and from the shut gate on there is nothing to fall */
    exh_gate_step(&b.s, b.cfg, 1, b.i, b.limits, &b.out);
    b.s.state = EXH_STATE_RELEASE;
    exh_gate_step(&b.s, b.cfg, 1, b.i, b.limits, &b.out);
    CHECK_EQ_I64(b.out.dac_raw[0], 32768);
}

TEST(span_is_never_exceeded)
{
    static const int64_t amp[] = {0, 6, 7, 31, -6, -7, -32};
    for (size_t a = 0; a < LEN(amp); a++) {
        struct box b;
        box_setup(&b);
        b.s.state = EXH_STATE_RUN;
        b.par[0].dac_zero_raw = 32000;
        b.par[0].dac_span_raw = 12184; /* 6.6 A */
        b.i[0].table_A_q26 = amp[a] * (1 << 26);
        exh_gate_step(&b.s, b.cfg, 1, b.i, b.limits, &b.out);
        CHECK(b.out.dac_raw[0] >= 32000 - 12184 && b.out.dac_raw[0] <= 32000 + 12184,
            "%" PRId64 " A: code %d", amp[a], b.out.dac_raw[0]);
        CHECK(((b.limits[0] & EXH_LIMIT_DAC) != 0) == (amp[a] > 6 || amp[a] < -6), "%" PRId64 " A",
            amp[a]);
    }
}

/* A ledger beyond the person's ceiling, whose i_peak is 6.6 A; 0 A is a ceiling, too. */
TEST(no_code_is_beyond_the_persons_ceiling)
{
    static const int32_t dA[] = {0, 1, 3, 12, 65, 66};
    static const int32_t amp[] = {1, 6, 31, -1, -32};
    for (size_t k = 0; k < LEN(dA) * LEN(amp); k++) {
        const int32_t A = amp[k / LEN(dA)], most = dA[k % LEN(dA)] * 4 / 10;
        const int32_t codes = exh_clamp(4 * A, -most, most);
        struct box b;
        box_setup(&b);
        b.s.state = EXH_STATE_RUN;
        b.par[0].person_A_q26 = EXH_Q(dA[k % LEN(dA)], 10, EXH_Q_CUR);
        b.par[0].dac_rawpA_q16 = EXH_Q(4, 1, EXH_Q_DAC);
        b.i[0].table_A_q26 = A * (INT64_C(1) << 26);
        exh_gate_step(&b.s, b.cfg, 1, b.i, b.limits, &b.out);
        CHECK_EQ_I64(b.out.dac_raw[0], 32768 + codes);
        CHECK(((b.limits[0] & EXH_LIMIT_DAC) != 0) == (4 * A != codes), "%d A", (int)A);
    }
}

/* A ledger beyond the peak: with four codes an ampere 1.2 A are four codes, not five, and 0.1 A
 * none. */
TEST(no_code_is_beyond_the_peak)
{
    static const struct {
        int32_t dA, codes;
    } peak[] = {{12, 4}, {1, 0}};
    static const int32_t amp[] = {1, 2, 6, 31, -1, -2, -32};
    for (size_t k = 0; k < LEN(peak) * LEN(amp); k++) {
        const int32_t A = amp[k / LEN(peak)], sign = A > 0 ? 1 : -1;
        const int32_t codes = sign * peak[k % LEN(peak)].codes;
        struct box b;
        box_setup(&b);
        b.s.state = EXH_STATE_RUN;
        b.par[0].i_peak_A_q26 = EXH_Q(peak[k % LEN(peak)].dA, 10, EXH_Q_CUR);
        b.par[0].dac_rawpA_q16 = EXH_Q(4, 1, EXH_Q_DAC);
        b.i[0].table_A_q26 = A * (INT64_C(1) << 26);
        exh_gate_step(&b.s, b.cfg, 1, b.i, b.limits, &b.out);
        CHECK_EQ_I64(b.out.dac_raw[0], 32768 + codes);
        CHECK(((b.limits[0] & EXH_LIMIT_DAC) != 0) == (4 * A != codes), "%d A", (int)A);
    }
}

/* Zero near an end of the D/A: the converter itself clips, and that is a limit. */
TEST(converter_end_is_reported)
{
    struct box b;
    box_setup(&b);
    b.s.state = EXH_STATE_RUN;
    b.par[0].dac_zero_raw = 65000;
    b.i[0].table_A_q26 = EXH_Q(6, 1, EXH_Q_CUR);
    exh_gate_step(&b.s, b.cfg, 1, b.i, b.limits, &b.out);
    CHECK_EQ_I64(b.out.dac_raw[0], 65535);
    CHECK((b.limits[0] & EXH_LIMIT_DAC) != 0, "5.7 A taken away without a limit bit");
}

TEST(fingers_not_in_use_get_zero)
{
    for (unsigned n = 1; n <= EXH_FINGERS; n++) {
        struct box b;
        box_setup(&b);
        b.s.state = EXH_STATE_RUN;
        for (unsigned k = 0; k < EXH_FINGERS; k++) {
            b.out.dac_raw[k] = 60000;
            b.i[k].table_A_q26 = EXH_Q(3, 1, EXH_Q_CUR);
        }
        exh_gate_step(&b.s, b.cfg, n, b.i, b.limits, &b.out);
        CHECK_EQ_I64(b.out.enable, (1u << n) - 1u);
        for (unsigned k = 0; k < EXH_FINGERS; k++) {
            CHECK((b.out.dac_raw[k] == 32768) == (k >= n), "n %u finger %u: %d", n, k,
                b.out.dac_raw[k]);
        }
    }
}

TEST(alive_changes_at_every_tick_in_every_state)
{
    struct box b;
    box_setup(&b);
    for (int k = 0; k < 600; k++) {
        const uint8_t before = b.out.alive;
        b.s.state = (uint8_t)(k % 7);
        exh_gate_step(&b.s, b.cfg, 5, b.i, b.limits, &b.out);
        CHECK(b.out.alive != before, "tick %d", k);
    }
}

TEST_MAIN("unit/gate", gate_in_every_state, a_shut_gate_makes_a_frame_that_drives_nothing,
    a_release_never_rises, span_is_never_exceeded, no_code_is_beyond_the_persons_ceiling,
    no_code_is_beyond_the_peak, converter_end_is_reported, fingers_not_in_use_get_zero,
    alive_changes_at_every_tick_in_every_state);
