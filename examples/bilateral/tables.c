/* SPDX-License-Identifier: MIT */
#include "bilateral.h"

#define MASK ((1 << BILATERAL_FINGERS) - 1)

static const struct exh_signal kf_rows[] = {
    {0x8601, EXH_Q_FORCE, EXH_WHEN_PERSON, EXH_Q(1, 10, EXH_Q_FORCE), EXH_Q(100, 1, EXH_Q_FORCE),
        EXH_Q(3339, 1000, EXH_Q_FORCE), "kf", "n_per_a",
        "string force per motor current, without a calibration"},
};

static const struct exh_signal own_rows[] = {
    {0x8610, 0, EXH_WHEN_SETUP, 1, MASK, 1 << EXH_INDEX, "fingers", "",
        "in use, bits: 1 thumb .. 16 little"},
    {0x8611, 0, EXH_WHEN_ANY, 1, 10000, 5, "state_every", "",
        "ticks from one state packet to the next"},
    {0x8612, 0, EXH_WHEN_SETUP, 0, INT32_MAX, 0, "session", "",
        "of the link, another at every start; 0: of the board's cycle counter"},
    {0x8613, 0, EXH_WHEN_ANY, 100, 60000, EXH_WIRE_QUIET_MS, "quiet", "ms",
        "nothing heard for so long: any hello begins anew"},
    {0x8614, 0, EXH_WHEN_SETUP, 1, 60000, 20, "f0_rest", "ms",
        "a string that runs out no farther for so long is wound in"},
    {0x8615, 0, EXH_WHEN_SETUP, 0, 60000, 1000, "glove_time", "ms",
        "nothing known of a finger in use for so long: a fault; 0: never"},
    {0x8616, 0, EXH_WHEN_SETUP, 0, 60000, 0, "link_time", "ms",
        "no planes for so long: a fault; 0: never, contacts are local"},
    {0x8617, 0, EXH_WHEN_SETUP, BILATERAL_RULE_OFF, BILATERAL_RULE_SCALED, BILATERAL_RULE_OFF,
        "rule_on", "",
        "materials outside the rule of gains are refused; 2: scaled to the rate; 0: none"},
};

#define OUT(id, frac, min, max, name, unit, help) \
    { \
        (id), (frac), EXH_WHEN_OUTPUT, (min), (max), 0, (name), (unit), (help) \
    }
#define ANY(id, frac, name, unit, help) OUT(id, frac, INT32_MIN, INT32_MAX, name, unit, help)
#define POS(id, frac, name, unit, help) OUT(id, frac, 0, INT32_MAX, name, unit, help)

/* Instances: the fingers. */
static const struct exh_signal paper_rows[] = {
    ANY(0x8701, EXH_Q_POS, "q", "m", "position"),
    ANY(0x8702, EXH_Q_VEL, "qd", "m_per_s", "velocity"),
    POS(0x8703, EXH_Q_FORCE, "f_des", "n", "force commanded"),
    POS(0x8704, EXH_Q_CUR, "i_des", "a", "current coded"),
    OUT(0x8705, 0, 0, 1, "c", "", "contact condition applies"),
    ANY(0x8706, EXH_Q_FORCE, "f_mon", "n", "force by the current monitor"),
    ANY(0x8707, EXH_Q_POS, "d", "m", "distance to the collision plane, < 0 before; -2: no plane"),
    ANY(0x8708, EXH_Q_POS, "q_lim", "m", "virtual contact; 2: none can be"),
};

static const struct exh_signal more_rows[] = {
    POS(0x8710, 0, "frozen", "",
        "1 q_lim stands, 2 moves, 4 inside, 8 stale, 16 bent, 32 freeze, 64 release, 128 blind, "
        "256 doubt, 512 let go, 1024 late"),
    POS(0x8711, 0, "limits", "", "limits acting, bits"),
    ANY(0x8712, 32, "q0", "turn", "robot: sideways"),
    ANY(0x8713, 32, "q1", "turn", "knuckle"),
    ANY(0x8714, 32, "q2", "turn", "middle joint, the last follows it"),
    OUT(0x8715, 0, 0, 7, "clamped", "", "joints at a limit, bits"),
    ANY(0x8716, EXH_Q_POS, "x", "m", "fingertip P_F in the palm's frame"),
    ANY(0x8717, EXH_Q_POS, "y", "m", ""),
    ANY(0x8718, EXH_Q_POS, "z", "m", ""),
    ANY(0x8719, 0, "freezes", "", "contacts prepared"),
    ANY(0x871A, 0, "born", "", "planes born around the finger"),
    ANY(0x871B, 0, "refused", "", "planes refused"),
    ANY(0x871C, 0, "ignored", "", "planes that moved while frozen"),
    ANY(0x871D, 0, "stale", "", "planes that became too old"),
    ANY(0x871E, 0, "let_go", "", "contacts that the glove denied, or could not confirm"),
    ANY(0x871F, 0, "late", "", "contacts whose plane came when the finger was inside"),
    ANY(0x8736, EXH_Q_POS, "late_d", "m", "so far inside, the last time"),
};

static const struct exh_signal box_rows[] = {
    OUT(0x8720, 0, 0, 5, "state", "", "0 off, 1 arm, 2 run, 3 limit, 4 release, 5 fault"),
    POS(0x8721, 0, "faults", "", "fault causes latched, bits"),
    POS(0x8722, 0, "present", "", "fault causes now, bits"),
    POS(0x8723, 0, "glove_faults", "", "sensors not believed, bits"),
    POS(0x8724, 0, "glove_age", "", "ticks since the frame was converted"),
    POS(0x8725, 0, "age", "", "ticks since the newest planes came"),
    POS(0x8726, 0, "trip", "us", "from the state they answer to them"),
    ANY(0x8727, 0, "set", "", "parameters set over the link"),
    ANY(0x8728, 0, "accepted", "", "packets"),
    ANY(0x8729, 0, "missing", "", "packets that never came"),
    ANY(0x872A, 0, "duplicate", "", "came twice"),
    ANY(0x872B, 0, "reordered", "", "came behind a newer one"),
    ANY(0x872C, 0, "old", "", "came much too late"),
    ANY(0x872D, 0, "stranger", "", "of nobody who said hello"),
    ANY(0x872E, 0, "corrupt", "", "damaged"),
    ANY(0x872F, 0, "version", "", "of another version"),
    ANY(0x8730, 0, "unknown", "", "of no known type"),
    ANY(0x8731, 0, "far", "", "numbered too far ahead"),
    ANY(0x8732, 0, "silences", "", "nothing heard for too long"),
    OUT(0x8733, 0, 0, 7, "differs", "", "of the world: 1 its role, 2 its version, 4 its table"),
    ANY(0x8734, 0, "odd", "", "hellos that differed"),
    POS(0x8735, 0, "arm_step", "", "arming is at, or was refused by"),
};

#define LEN(a) (sizeof(a) / sizeof((a)[0]))
#define EACH(r, n) \
    { \
        (r), (n), BILATERAL_FINGERS \
    }

static const struct exh_signal_group param_groups[] = {
    EACH(exh_quad_rows, EXH_QUAD_ROWS),
    EACH(exh_velocity_rows, EXH_VELOCITY_ROWS),
    EACH(exh_contact_rows, EXH_CONTACT_ROWS),
    EACH(exh_drive_rows, EXH_DRIVE_ROWS),
    EACH(exh_tracking_rows, EXH_TRACKING_ROWS),
    EACH(exh_motion_rows, EXH_MOTION_ROWS),
    EACH(kf_rows, LEN(kf_rows)),
    EACH(exh_hand_rows, EXH_HAND_ROWS),
    EACH(exh_precontact_rows, EXH_PRECONTACT_ROWS),
    {exh_material_rows, EXH_MATERIAL_ROWS, BILATERAL_MATERIALS},
    {exh_safety_rows, EXH_SAFETY_ROWS, 1},
    {exh_polarity_rows, EXH_POLARITY_ROWS, 1},
    {exh_supply_rows, EXH_SUPPLY_ROWS, 1},
    {exh_glove_rows, EXH_GLOVE_ROWS, 1},
    {own_rows, LEN(own_rows), 1},
    {exh_calib_set_rows, EXH_CALIB_SET_ROWS, 1},
    {glove_own_rows, GLOVE_OWN_ROWS, 1},
    {glove_cal_rows, GLOVE_CAL_ROWS, EXH_GLOVE_SENSORS},
    {exh_tune_rows, EXH_TUNE_ROWS, 1},
    EACH(exh_chatter_rows, EXH_CHATTER_ROWS),
    {exh_gains_rows, EXH_GAINS_ROWS, 1},
};
const struct exh_signal_table bilateral_params = {param_groups, LEN(param_groups)};

/* The first group is the paper's, in its order, for the CSV. */
static const struct exh_signal_group output_groups[] = {
    EACH(paper_rows, LEN(paper_rows)),
    EACH(more_rows, LEN(more_rows)),
    {box_rows, LEN(box_rows), 1},
};
const struct exh_signal_table bilateral_outputs = {output_groups, LEN(output_groups)};

EXH_STATIC_ASSERT(bilateral_par_matches_rows,
    sizeof(struct bilateral_par) ==
        sizeof(int32_t) *
            (BILATERAL_FINGERS *
                    (EXH_QUAD_ROWS + EXH_VELOCITY_ROWS + EXH_CONTACT_ROWS + EXH_DRIVE_ROWS +
                        EXH_TRACKING_ROWS + EXH_MOTION_ROWS + EXH_CHATTER_ROWS + LEN(kf_rows) +
                        EXH_HAND_ROWS + EXH_PRECONTACT_ROWS) +
                BILATERAL_MATERIALS * EXH_MATERIAL_ROWS + EXH_SAFETY_ROWS + EXH_POLARITY_ROWS +
                EXH_SUPPLY_ROWS + EXH_GLOVE_ROWS + LEN(own_rows) + EXH_CALIB_SET_ROWS +
                GLOVE_OWN_ROWS + GLOVE_CAL_ROWS * EXH_GLOVE_SENSORS + EXH_TUNE_ROWS +
                EXH_GAINS_ROWS));
EXH_STATIC_ASSERT(bilateral_signals_match_rows,
    sizeof(struct bilateral_signals) ==
        sizeof(int32_t) * (BILATERAL_FINGERS * (LEN(paper_rows) + LEN(more_rows)) + LEN(box_rows)));
