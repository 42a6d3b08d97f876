/* SPDX-License-Identifier: MIT */
/* Every parameter of the library as logs, saved images and host programs know it: number, format,
 * range and default in raw values, name and unit. They are written here a second time, as numbers,
 * because no other source needs each of them. A change of one changes what others read, and must be
 * made here too. Their meaning: docs/NUMERICS.md. */
#include "exhand/contact.h"
#include "exhand/drive.h"
#include "exhand/filter.h"
#include "exhand/gains.h"
#include "exhand/glove.h"
#include "exhand/hand.h"
#include "exhand/params.h"
#include "exhand/passivity.h"
#include "exhand/polarity.h"
#include "exhand/precontact.h"
#include "exhand/quad.h"
#include "exhand/quantizer.h"
#include "exhand/safety.h"
#include "exhand/signal.h"
#include "exhand/supply.h"
#include "exhand/chatter.h"
#include "exhand/tracking.h"
#include "exhand/velocity.h"
#include "exhand/motion.h"

#include "check.h"

static const struct exh_signal_group groups[] = {
    {exh_quad_rows, EXH_QUAD_ROWS, 1},
    {exh_velocity_rows, EXH_VELOCITY_ROWS, 1},
    {exh_contact_rows, EXH_CONTACT_ROWS, 1},
    {exh_drive_rows, EXH_DRIVE_ROWS, 1},
    {exh_safety_rows, EXH_SAFETY_ROWS, 1},
    {exh_filter_rows, EXH_FILTER_ROWS, 1},
    {exh_quantizer_rows, EXH_QUANTIZER_ROWS, 1},
    {exh_glove_rows, EXH_GLOVE_ROWS, 1},
    {exh_hand_rows, EXH_HAND_ROWS, 1},
    {exh_material_rows, EXH_MATERIAL_ROWS, 1},
    {exh_precontact_rows, EXH_PRECONTACT_ROWS, 1},
    {exh_tracking_rows, EXH_TRACKING_ROWS, 1},
    {exh_supply_rows, EXH_SUPPLY_ROWS, 1},
    {exh_motion_rows, EXH_MOTION_ROWS, 1},
    {exh_passivity_rows, EXH_PASSIVITY_ROWS, 1},
    {exh_gains_rows, EXH_GAINS_ROWS, 1},
    {exh_tune_rows, EXH_TUNE_ROWS, 1},
    {exh_chatter_rows, EXH_CHATTER_ROWS, 1},
    {exh_polarity_rows, EXH_POLARITY_ROWS, 1},
};
static const struct exh_signal_table table = {groups, sizeof groups / sizeof groups[0]};

static const struct exh_signal want[] = {
    {0x0201, 42, EXH_WHEN_SETUP, 4398046, INT32_MAX, 291678444, "step", "m", ""},
    {0x0202, 27, EXH_WHEN_SETUP, 13421772, INT32_MAX, 1342177280, "speed_max", "m_per_s", ""},
    {0x0301, 0, EXH_WHEN_SETUP, 0, 4, 1, "vel_p", "", ""},
    {0x0401, 10, EXH_WHEN_SLEWED, 0, 1024000000, 1536000, "k", "n_per_m", ""},
    {0x0402, 20, EXH_WHEN_SLEWED, 0, 1048576000, 0, "b", "ns_per_m", ""},
    {0x0403, 20, EXH_WHEN_SLEWED, 0, 20971520, 112197, "f0", "n", ""},
    {0x0404, 30, EXH_WHEN_REST, 0, 10737418, 214748, "f0_band", "m", ""},
    {0x0405, 30, EXH_WHEN_REST, 0, 10737418, 0, "hyst", "m", ""},
    {0x0501, 20, EXH_WHEN_LIMIT, 0, 104857600, 41943040, "f_max", "n", ""},
    {0x0502, 0, EXH_WHEN_BOUND, 1, 10000000, 200000, "slew_up", "n_per_s", ""},
    {0x0503, 0, EXH_WHEN_BOUND, 1000, 10000000, 200000, "slew_down", "n_per_s", ""},
    {0x0504, 26, EXH_WHEN_SETUP, 6710886, 442918502, 442918502, "i_peak", "a", ""},
    {0x0505, 26, EXH_WHEN_SETUP, 0, 221459251, 221459251, "i_cont", "a", ""},
    {0x0506, 0, EXH_WHEN_SETUP, 1, 2700, 2700, "peak_time", "ms", ""},
    {0x0507, 0, EXH_WHEN_PERSON, 0, 65535, 32768, "dac_zero", "", ""},
    {0x0508, 0, EXH_WHEN_PERSON, 0, 32767, 12184, "dac_span", "", ""},
    {0x0509, 16, EXH_WHEN_PERSON, 65536, INT32_MAX, 120980945, "dac_scale", "per_a", ""},
    {0x050A, 0, EXH_WHEN_SETUP, -32768, 32767, 0, "mon_zero", "", ""},
    {0x050B, 40, EXH_WHEN_SETUP, 1, INT32_MAX, 567787804, "mon_scale", "a", ""},
    {0x050C, 20, EXH_WHEN_PERSON, 131072, 104857600, 41943040, "person_f", "n", ""},
    {0x050D, 26, EXH_WHEN_PERSON, 0, 442918502, 442918502, "person_i", "a", ""},
    {0x0601, 0, EXH_WHEN_SETUP, 0, 1, 1, "missed_max", "", ""},
    {0x0602, 20, EXH_WHEN_SETUP, 104857, 10485760, 1048576, "arm_force", "n", ""},
    {0x0603, 0, EXH_WHEN_SETUP, 1, 1000, 50, "arm_time", "ms", ""},
    {0x0604, 0, EXH_WHEN_SETUP, 1, 5000, 500, "ramp_time", "ms", ""},
    {0x0605, 0, EXH_WHEN_SETUP, 5, 18, 15, "release_time", "ms", ""},
    {0x0701, 0, EXH_WHEN_SETUP, 1, 2, 2, "order", "", ""},
    {0x0702, 16, EXH_WHEN_SETUP, 655, 655360000, 1310720, "fc", "hz", ""},
    {0x0801, 0, EXH_WHEN_SETUP, 1, 24, 14, "bits", "", ""},
    {0x0802, 16, EXH_WHEN_SETUP, 0, INT32_MAX, 262144, "hyst", "raw", ""},
    {0x0901, 0, EXH_WHEN_SETUP, 0, 2, 2, "glove_order", "", ""},
    {0x0902, 16, EXH_WHEN_SETUP, 6553, 655360000, 1966080, "glove_fc", "hz", ""},
    {0x0903, 0, EXH_WHEN_SETUP, 1, 24, 11, "glove_bits", "", ""},
    {0x0904, 16, EXH_WHEN_SETUP, 0, 268435456, 1310720, "glove_hyst", "", ""},
    {0x0905, 0, EXH_WHEN_SETUP, -32768, 32767, -32000, "glove_low", "", ""},
    {0x0906, 0, EXH_WHEN_SETUP, -32768, 32767, 32000, "glove_high", "", ""},
    {0x0907, 0, EXH_WHEN_SETUP, 0, 1, 1, "glove_open_high", "", ""},
    {0x0908, 0, EXH_WHEN_SETUP, 1, 255, 3, "glove_debounce", "", ""},
    {0x0909, 16, EXH_WHEN_SETUP, 0, 524288, 32768, "glove_margin", "", ""},
    {0x0A01, 30, EXH_WHEN_SETUP, 0, 53687091, 21474836, "arm1", "m", ""},
    {0x0A02, 30, EXH_WHEN_SETUP, 0, 53687091, 17179869, "arm2", "m", ""},
    {0x0A03, 30, EXH_WHEN_SETUP, 0, 53687091, 12884901, "arm3", "m", ""},
    {0x0A04, 30, EXH_WHEN_SETUP, 0, 26843545, 11274289, "pad", "m", ""},
    {0x0B01, 10, EXH_WHEN_MATERIAL, 0, 1024000000, 20480000, "mat_k", "n_per_m", ""},
    {0x0B02, 20, EXH_WHEN_MATERIAL, 0, 1048576000, 62914560, "mat_b", "ns_per_m", ""},
    {0x0B03, 20, EXH_WHEN_MATERIAL, 0, 104857600, 12582912, "mat_f_max", "n", ""},
    {0x0C01, 30, EXH_WHEN_REST, -214748364, -107374, -4831838, "d_lim", "m", ""},
    {0x0C02, 30, EXH_WHEN_REST, 0, 53687091, 1073741, "d_hyst", "m", ""},
    {0x0C03, 24, EXH_WHEN_REST, 2097152, 134217728, 16777216, "string_per_tip", "", ""},
    {0x0C04, 0, EXH_WHEN_REST, 0, 1, 0, "string_from_slope", "", ""},
    {0x0C05, 0, EXH_WHEN_SETUP, 0, 1, 0, "d_printed", "", ""},
    {0x0C06, 0, EXH_WHEN_SETUP, 1, 60000, 2000, "age_max", "ms", ""},
    {0x0C07, 30, EXH_WHEN_REST, 0, 53687091, 5368709, "d_doubt", "m", ""},
    {0x0C08, 0, EXH_WHEN_SETUP, 1, 60000, 100, "doubt_max", "ms", ""},
    {0x0C09, 0, EXH_WHEN_SETUP, 1, 60000, 50, "tip_age_max", "ms", ""},
    {0x0C0A, 0, EXH_WHEN_BOUND, 1, 10000000, 100, "late_slew", "n_per_s", ""},
    {0x0D01, 26, EXH_WHEN_SETUP, 6710886, 67108864, 16777216, "track_tol", "a", ""},
    {0x0D02, 0, EXH_WHEN_SETUP, 1, 100, 20, "track_time", "ms", ""},
    {0x0D11, 20, EXH_WHEN_SETUP, 0, 104857600, 0, "supply_min", "v", ""},
    {0x0D12, 20, EXH_WHEN_SETUP, 0, 104857600, 31457280, "supply_max", "v", ""},
    {0x0D13, 30, EXH_WHEN_SETUP, 1, INT32_MAX, 1310720, "supply_scale", "v", ""},
    {0x0D14, 0, EXH_WHEN_SETUP, 1, 1000, 10, "supply_time", "ms", ""},
    {0x0E01, 27, EXH_WHEN_SETUP, 13421772, 1342177280, 402653184, "speed_limit", "m_per_s", ""},
    {0x0E02, 0, EXH_WHEN_SETUP, 1, 1000, 20, "speed_time", "ms", ""},
    {0x0E03, 0, EXH_WHEN_SETUP, 0, 60000, 0, "stuck_time", "ms", ""},
    {0x0E04, 26, EXH_WHEN_SETUP, 3355443, 442918502, 16777216, "stuck_cur", "a", ""},
    {0x0F01, 0, EXH_WHEN_REST, 0, 2, 2, "passivity", "", ""},
    {0x1201, 8, EXH_WHEN_SETUP, 256, 5120000, 512000, "rule_rate", "hz", ""},
    {0x1202, 0, EXH_WHEN_SETUP, 2, 8, 2, "rule_n", "", ""},
    {0x1203, 10, EXH_WHEN_SETUP, 0, 1024000000, 0, "rule_k_min", "n_per_m", ""},
    {0x1210, 20, EXH_WHEN_SETUP, 0, 1048576000, 0, "rule_b0", "ns_per_m", ""},
    {0x1211, 20, EXH_WHEN_SETUP, 0, 1048576000, 0, "rule_b1", "ns_per_m", ""},
    {0x1212, 20, EXH_WHEN_SETUP, 0, 1048576000, 0, "rule_b2", "ns_per_m", ""},
    {0x1213, 20, EXH_WHEN_SETUP, 0, 1048576000, 0, "rule_b3", "ns_per_m", ""},
    {0x1214, 20, EXH_WHEN_SETUP, 0, 1048576000, 0, "rule_b4", "ns_per_m", ""},
    {0x1215, 20, EXH_WHEN_SETUP, 0, 1048576000, 0, "rule_b5", "ns_per_m", ""},
    {0x1216, 20, EXH_WHEN_SETUP, 0, 1048576000, 0, "rule_b6", "ns_per_m", ""},
    {0x1217, 20, EXH_WHEN_SETUP, 0, 1048576000, 0, "rule_b7", "ns_per_m", ""},
    {0x1220, 10, EXH_WHEN_SETUP, 0, 1024000000, 0, "rule_k0", "n_per_m", ""},
    {0x1221, 10, EXH_WHEN_SETUP, 0, 1024000000, 0, "rule_k1", "n_per_m", ""},
    {0x1222, 10, EXH_WHEN_SETUP, 0, 1024000000, 0, "rule_k2", "n_per_m", ""},
    {0x1223, 10, EXH_WHEN_SETUP, 0, 1024000000, 0, "rule_k3", "n_per_m", ""},
    {0x1224, 10, EXH_WHEN_SETUP, 0, 1024000000, 0, "rule_k4", "n_per_m", ""},
    {0x1225, 10, EXH_WHEN_SETUP, 0, 1024000000, 0, "rule_k5", "n_per_m", ""},
    {0x1226, 10, EXH_WHEN_SETUP, 0, 1024000000, 0, "rule_k6", "n_per_m", ""},
    {0x1227, 10, EXH_WHEN_SETUP, 0, 1024000000, 0, "rule_k7", "n_per_m", ""},
    {0x1301, 0, EXH_WHEN_SETUP, 0, 1000, 20, "tune_time", "ms", ""},
    {0x1401, 20, EXH_WHEN_SETUP, 10485, 10485760, 157286, "chatter_power", "w", ""},
    {0x1402, 24, EXH_WHEN_SETUP, 0, 16777216, 0, "chatter_energy", "j", ""},
    {0x0606, 20, EXH_WHEN_SETUP, 0, 1048576, 0, "arm_pull", "n", ""},
    {0x0607, 0, EXH_WHEN_SETUP, 50, 5000, 400, "arm_pull_time", "ms", ""},
    {0x0608, 30, EXH_WHEN_SETUP, 53687, 21474836, 322122, "arm_pull_move", "m", ""},
};

TEST(rows_are_what_others_know)
{
    CHECK_EQ_I64(exh_signal_count(&table), sizeof want / sizeof want[0]);
    for (uint32_t i = 0; i < sizeof want / sizeof want[0]; i++) {
        const struct exh_signal *got = exh_signal_at(&table, i, NULL);
        const struct exh_signal *w = &want[i];
        CHECK(got->id == w->id, "%s: number %04x", w->name, (unsigned)got->id);
        CHECK(got->frac == w->frac && got->when == w->when, "%s: format, or when", w->name);
        CHECK(got->min == w->min, "%s: at least %" PRId32, w->name, got->min);
        CHECK(got->max == w->max, "%s: at most %" PRId32, w->name, got->max);
        CHECK(got->dflt == w->dflt, "%s: default %" PRId32, w->name, got->dflt);
        CHECK(check_same_text(got->name, w->name), "%s: is %s", w->name, got->name);
        CHECK(check_same_text(got->unit, w->unit), "%s: in %s", w->name, got->unit);
    }
}

TEST_MAIN("unit/rows", rows_are_what_others_know);
