/* safety.h: every state with every command and every cause; the gate lets nothing
 * through that it should not. */
#include "exhand/safety.h"

#include "check.h"

#define LEN(a) (sizeof(a) / sizeof((a)[0]))
#define ALL_DRIVES (31u * EXH_DIN_DRIVE0)
#define HEALTHY (EXH_DIN_ESTOP | EXH_DIN_DEADMAN | ALL_DRIVES)

/* A bit that another module raises, whatever it will be called. */
#define EXH_FAULT_LATER (1u << 30)

static const struct exh_safety_par par = {1};
static const uint32_t fault_bits[] = {EXH_FAULT_ESTOP,   EXH_FAULT_DRIVE, EXH_FAULT_OVERRUN,
                                      EXH_FAULT_ENCODER, EXH_FAULT_DEADMAN, EXH_FAULT_TRACKING,
                                      EXH_FAULT_LATER};

static struct exh_safety_in healthy(uint8_t command)
{
    const struct exh_safety_in in = {HEALTHY, 0, 0, command, 5};
    return in;
}

/* Makes exactly one cause present, by the way it comes in life. */
static struct exh_safety_in with_cause(uint32_t fault, uint8_t command)
{
    struct exh_safety_in in = healthy(command);
    if (fault == EXH_FAULT_ESTOP) { in.din &= ~(uint32_t)EXH_DIN_ESTOP; }
    if (fault == EXH_FAULT_DRIVE) { in.din &= ~((uint32_t)EXH_DIN_DRIVE0 << 3); }
    if (fault == EXH_FAULT_OVERRUN) { in.missed = 3; }
    if (fault == EXH_FAULT_DEADMAN) { in.din &= ~(uint32_t)EXH_DIN_DEADMAN; }
    if (fault == EXH_FAULT_ENCODER || fault == EXH_FAULT_TRACKING || fault == EXH_FAULT_LATER) {
        in.raised = fault;
    }
    return in;
}

TEST(every_state_with_every_command)
{
    static const struct {
        uint8_t from, command, healthy_to, cause_to;
    } row[] = {
        {EXH_STATE_OFF, EXH_CMD_NONE, EXH_STATE_OFF, EXH_STATE_OFF},
        {EXH_STATE_OFF, EXH_CMD_RUN, EXH_STATE_RUN, EXH_STATE_OFF},
        {EXH_STATE_OFF, EXH_CMD_OFF, EXH_STATE_OFF, EXH_STATE_OFF},
        {EXH_STATE_OFF, EXH_CMD_CLEAR, EXH_STATE_OFF, EXH_STATE_OFF},
        {EXH_STATE_OFF, 99, EXH_STATE_OFF, EXH_STATE_OFF},
        {EXH_STATE_RUN, EXH_CMD_NONE, EXH_STATE_RUN, EXH_STATE_FAULT},
        {EXH_STATE_RUN, EXH_CMD_RUN, EXH_STATE_RUN, EXH_STATE_FAULT},
        {EXH_STATE_RUN, EXH_CMD_CLEAR, EXH_STATE_RUN, EXH_STATE_FAULT},
        {EXH_STATE_RUN, EXH_CMD_OFF, EXH_STATE_OFF, EXH_STATE_FAULT},
        {EXH_STATE_RUN, 99, EXH_STATE_RUN, EXH_STATE_FAULT},
        {EXH_STATE_FAULT, EXH_CMD_NONE, EXH_STATE_FAULT, EXH_STATE_FAULT},
        {EXH_STATE_FAULT, EXH_CMD_RUN, EXH_STATE_FAULT, EXH_STATE_FAULT},
        {EXH_STATE_FAULT, EXH_CMD_OFF, EXH_STATE_FAULT, EXH_STATE_FAULT},
        {EXH_STATE_FAULT, EXH_CMD_CLEAR, EXH_STATE_OFF, EXH_STATE_FAULT},
        {EXH_STATE_FAULT, 99, EXH_STATE_FAULT, EXH_STATE_FAULT},
    };
    for (size_t i = 0; i < LEN(row); i++) {
        struct exh_safety s = {0};
        s.state = row[i].from;
        CHECK_EQ_I64(exh_safety_step(&s, &par, healthy(row[i].command)), row[i].healthy_to);
        CHECK(s.state == row[i].healthy_to, "row %zu: state", i);
        for (size_t f = 0; f < LEN(fault_bits); f++) {
            struct exh_safety t = {0};
            t.state = row[i].from;
            CHECK(exh_safety_step(&t, &par, with_cause(fault_bits[f], row[i].command)) ==
                      row[i].cause_to,
                  "row %zu with cause %zu", i, f);
            CHECK(t.present == fault_bits[f], "row %zu: a refusal must tell its cause", i);
        }
    }
}

TEST(power_on_is_off)
{
    struct exh_safety s = {0};
    CHECK_EQ_I64(s.state, EXH_STATE_OFF);
    CHECK_EQ_I64(exh_safety_step(&s, &par, healthy(EXH_CMD_NONE)), EXH_STATE_OFF);
}

TEST(each_fault_latches_with_cause_and_tick)
{
    for (size_t f = 0; f < LEN(fault_bits); f++) {
        struct exh_safety s = {0};
        for (int k = 0; k < 10; k++) { (void)exh_safety_step(&s, &par, healthy(EXH_CMD_RUN)); }
        (void)exh_safety_step(&s, &par, with_cause(fault_bits[f], EXH_CMD_NONE));
        CHECK_EQ_I64(s.faults, fault_bits[f]);
        CHECK_EQ_I64(s.first, fault_bits[f]);
        CHECK_EQ_I64(s.first_tick, 10);
        /* a second cause joins, the first stays the first; going away clears nothing */
        (void)exh_safety_step(&s, &par, with_cause(fault_bits[(f + 1) % 6], EXH_CMD_NONE));
        (void)exh_safety_step(&s, &par, healthy(EXH_CMD_RUN));
        CHECK_EQ_I64(s.faults, fault_bits[f] | fault_bits[(f + 1) % 6]);
        CHECK_EQ_I64(s.first, fault_bits[f]);
        CHECK_EQ_I64(s.first_tick, 10);
        CHECK_EQ_I64(s.tick, 13);
        for (int k = 0; k < 200; k++) { (void)exh_safety_step(&s, &par, healthy(EXH_CMD_NONE)); }
        CHECK_EQ_I64(s.state, EXH_STATE_FAULT);
        CHECK_EQ_I64(exh_safety_step(&s, &par, healthy(EXH_CMD_CLEAR)), EXH_STATE_OFF);
        CHECK_EQ_I64(s.faults, 0);
        /* the next fault is a new one, with its own first cause and tick */
        (void)exh_safety_step(&s, &par, healthy(EXH_CMD_RUN));
        (void)exh_safety_step(&s, &par, with_cause(fault_bits[(f + 2) % 6], EXH_CMD_NONE));
        CHECK_EQ_I64(s.first, fault_bits[(f + 2) % 6]);
        CHECK_EQ_I64(s.first_tick, 215);
    }
}

TEST(missed_ticks_are_tolerated_up_to_the_limit)
{
    static const struct {
        int32_t max;
        uint32_t missed;
        uint8_t want;
    } row[] = {{0, 0, EXH_STATE_RUN},       {0, 1, EXH_STATE_FAULT},
               {1, 1, EXH_STATE_RUN},       {1, 2, EXH_STATE_FAULT},
               {1, UINT32_MAX, EXH_STATE_FAULT},
               /* in ROM a value may be anything: out of range is none */
               {2, 1, EXH_STATE_FAULT},     {-1, 1, EXH_STATE_FAULT},
               {-1, 0, EXH_STATE_RUN},      {INT32_MIN, 1, EXH_STATE_FAULT}};
    for (size_t i = 0; i < LEN(row); i++) {
        const struct exh_safety_par p = {row[i].max};
        struct exh_safety_in in = healthy(EXH_CMD_NONE);
        struct exh_safety s = {0};
        s.state = EXH_STATE_RUN;
        in.missed = row[i].missed;
        CHECK(exh_safety_step(&s, &p, in) == row[i].want, "row %zu", i);
        CHECK_EQ_I64(s.missed, row[i].missed);
        in.missed = 3;
        (void)exh_safety_step(&s, &p, in);
        CHECK_EQ_I64(s.missed, row[i].missed > UINT32_MAX - 3 ? UINT32_MAX : row[i].missed + 3);
    }
}

/* A timer that has already ticked says "in time", so a tick that takes too long misses
 * only some: one in 64 is tolerated, more is an overrun, whatever the pattern. */
TEST(late_too_often_is_an_overrun)
{
    static const struct {
        uint32_t every; /* one missed in so many ticks                          */
        int fault;
    } row[] = {{1, 1}, {2, 1}, {3, 1}, {5, 1}, {20, 1}, {63, 1}, {65, 0}, {1000, 0}};
    for (size_t i = 0; i < LEN(row); i++) {
        struct exh_safety s = {0};
        uint8_t state = s.state = EXH_STATE_RUN;
        for (uint32_t n = 0; n < 10000; n++) {
            struct exh_safety_in in = healthy(EXH_CMD_NONE);
            in.missed = n % row[i].every == 0;
            state = exh_safety_step(&s, &par, in);
        }
        CHECK((state == EXH_STATE_FAULT) == row[i].fault, "one in %" PRIu32, row[i].every);
        CHECK((s.first == EXH_FAULT_OVERRUN) == row[i].fault, "one in %" PRIu32, row[i].every);
    }
}

/* Nothing damaged may pass for OFF or RUN: RUN could then be commanded past a fault. */
TEST(a_state_that_is_none_is_a_fault)
{
    for (unsigned v = 3; v < 256; v++) {
        struct exh_safety s = {0};
        s.state = (uint8_t)v;
        CHECK_EQ_I64(exh_safety_step(&s, &par, healthy(EXH_CMD_RUN)), EXH_STATE_FAULT);
    }
    for (int k = 0; k < 2; k++) {
        struct exh_safety s = {0};
        uint8_t buf[64] = {0};
        struct exh_bytes c = exh_bytes_reader(buf, sizeof buf);
        buf[k ? 4 : 28] = 0xFF; /* faults; state */
        exh_safety_bytes(&c, &s);
        CHECK_EQ_I64(s.state, EXH_STATE_FAULT);
        CHECK_EQ_I64(exh_safety_step(&s, &par, healthy(EXH_CMD_RUN)), EXH_STATE_FAULT);
    }
}

TEST(only_drives_in_use_count)
{
    for (uint8_t n = 1; n <= 5; n++) {
        for (unsigned d = 0; d < 5; d++) {
            struct exh_safety s = {0};
            struct exh_safety_in in = healthy(EXH_CMD_NONE);
            s.state = EXH_STATE_RUN;
            in.fingers = n;
            in.din &= ~((uint32_t)EXH_DIN_DRIVE0 << d);
            CHECK(exh_safety_step(&s, &par, in) == (d < n ? EXH_STATE_FAULT : EXH_STATE_RUN),
                  "%u fingers, drive %u", n, d);
        }
    }
}

/* --- the gate --- */

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
    CHECK_EQ_I64(exh_table_set(b->knot, 2), 0);
    for (unsigned k = 0; k < EXH_FINGERS; k++) {
        const struct exh_table t = {b->knot, 2};
        int32_t *field = &b->par[k].f_max_N_q20;
        for (size_t r = 0; r < EXH_DRIVE_ROWS; r++) { field[r] = exh_drive_rows[r].dflt; }
        CHECK_EQ_I64(exh_drive_setup(&b->cfg[k], &b->par[k], (struct exh_period){1, 2000}, t, none),
                     0);
        b->i[k].table_A_q26 = EXH_Q(3, 1, EXH_Q_CUR) * ((int)k % 3 - 1);
    }
}

TEST(gate_in_every_state)
{
    for (uint8_t state = 0; state < 5; state++) {
        const int open = state == EXH_STATE_RUN;
        struct box b;
        box_setup(&b);
        b.s.state = state; /* 3 and 4: a state no one has heard of is not RUN */
        exh_gate(&b.s, b.cfg, 5, b.i, b.limits, &b.out);
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
        }
    }
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
        exh_gate(&b.s, b.cfg, 1, b.i, b.limits, &b.out);
        CHECK(b.out.dac_raw[0] >= 32000 - 12184 && b.out.dac_raw[0] <= 32000 + 12184,
              "%" PRId64 " A: code %d", amp[a], b.out.dac_raw[0]);
        CHECK(((b.limits[0] & EXH_LIMIT_DAC) != 0) == (amp[a] > 6 || amp[a] < -6), "%" PRId64 " A",
              amp[a]);
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
    exh_gate(&b.s, b.cfg, 1, b.i, b.limits, &b.out);
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
        exh_gate(&b.s, b.cfg, n, b.i, b.limits, &b.out);
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
        b.s.state = (uint8_t)(k % 3);
        exh_gate(&b.s, b.cfg, 5, b.i, b.limits, &b.out);
        CHECK(b.out.alive != before, "tick %d", k);
    }
}

TEST(state_round_trip)
{
    struct exh_safety s = {6, 1, 2, 0xFFFFFFFF, 4, 5, 7, 2, 255, 0}, back = {0};
    uint8_t buf[32];
    struct exh_bytes c = exh_bytes_writer(buf, sizeof buf);
    exh_safety_bytes(&c, &s);
    CHECK_EQ_I64(c.at, 30);
    c = exh_bytes_reader(buf, c.at);
    exh_safety_bytes(&c, &back);
    CHECK(exh_bytes_ok(&c), "reader");
    CHECK(back.present == 6 && back.late == 7, "causes now");
    CHECK(back.faults == 1 && back.first == 2 && back.first_tick == 0xFFFFFFFF, "causes");
    CHECK(back.tick == 4 && back.missed == 5 && back.state == 2 && back.alive == 255, "rest");
}

TEST_MAIN("unit/safety", every_state_with_every_command, power_on_is_off,
          each_fault_latches_with_cause_and_tick, missed_ticks_are_tolerated_up_to_the_limit,
          late_too_often_is_an_overrun, a_state_that_is_none_is_a_fault, only_drives_in_use_count, gate_in_every_state, span_is_never_exceeded,
          converter_end_is_reported, fingers_not_in_use_get_zero,
          alive_changes_at_every_tick_in_every_state, state_round_trip);
