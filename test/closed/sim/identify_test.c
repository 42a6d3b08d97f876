/* SPDX-License-Identifier: MIT */
/* exhand identify finds the device and reports data that does not fit. Its file is read back, and
 * damaged ones are refused by line. The advisor takes it. */
#include "advise/gains.h"
#include "base/assign.h"
#include "file_of.h"
#include "identify/estimate.h"
#include "identify_rig.h"
#include "said.h"

#include "identify/identify.h"

#include "sim/random.h"

#include <math.h>
#include <stdlib.h>

static struct said s;

/* --- the estimate --- */

TEST(what_is_found_is_the_device)
{
    static const double off[MODEL_PARS] = {
        0.03, 0.3, 0.03, 0.02, 0.01, 0.01, 0.02, 0.03, 0.03, 0.06, 0.05};
    struct identify_session c = session(3);
    const struct model truth = model_of(&c.board.device, 1.0 / c.rate_Hz);
    struct estimate_of e;
    c.repeats = 4;
    run(&c);
    CHECK_EQ_I64(identify_estimate(&e, &data), 0);
    CHECK(e.fit.cost < 0.6, "residual %g", e.fit.cost);
    for (int i = 0; i < MODEL_PARS; i++) {
        CHECK(fabs(e.fit.at.value[i] / truth.value[i] - 1) < off[i], "%s: %g, want %g",
            model_row[i].name, e.fit.at.value[i], truth.value[i]);
    }
}

static const char *const row_name[] = {
    "rotor", "coulomb", "viscous", "kf", "step", "cable_k", "cable_b", "mu_motor", "mu_mass"};
static const int firm[] = {MODEL_ROTOR, MODEL_KF, MODEL_STEP, MODEL_CABLE_K};

static struct model device(struct identify_session *c, const double value[LEN(row_name)])
{
    for (size_t i = 0; i < LEN(row_name); i++) {
        const struct sim_device_row *row;
        CHECK_EQ_I64(sim_device_set(&c->board.device, row_name[i], value[i], &row), 0);
    }
    CHECK_EQ_I64(assign_step(&c->board.device, 0, 0), 0);
    return model_of(&c->board.device, 1.0 / c->rate_Hz);
}

static void is_found(const struct estimate_of *e, const struct model *truth)
{
    CHECK(e->fit.cost < 1, "residual %g", e->fit.cost);
    for (size_t i = 0; i < LEN(firm); i++) {
        const double is = e->fit.at.value[firm[i]], want = truth->value[firm[i]];
        CHECK(fabs(is / want - 1) < 0.03, "%s: %g, want %g", model_row[firm[i]].name, is, want);
    }
}

/* A light rotor on a stiff string fits with a third of the stiffness, too, and no step leads from
 * one to the other: the starts have to be dense. */
TEST(a_stiff_string_on_a_light_rotor_is_told_apart)
{
    static const double value[] = {
        0.0365, 0.133, 0.208, 2.49, 39.2e-6, 31570, 2.58, 0.3365, 0.2109};
    struct identify_session c = session(7);
    struct estimate_of e;
    const struct model truth = device(&c, value);
    c.mass_kg = 0.25;
    run(&c);
    CHECK_EQ_I64(data.result, EXH_PROBE_DONE);
    CHECK_EQ_I64(identify_estimate(&e, &data), 0);
    is_found(&e, &truth);
}

/* A square wave through the resonance of a string that hardly brakes: it slackens and strikes. Then
 * its motion depends on the instant at which the drive took each command. The stiff string also
 * fits with another number of whole cycles. */
TEST(a_string_that_slackens_is_told_apart)
{
    static const double value[2][LEN(row_name)] = {
        {0.1, 0.237, 0.142, 2.55, 44.3e-6, 1191, 4.35, 0.041, 0.1715},
        {0.056, 0.517, 0.144, 6.33, 35.4e-6, 55480, 1.28, 0.0314, 0.2457}};
    CHECK(strcmp(identify_part_text(IDENTIFY_PART_WAVE), "square wave") == 0, "%s",
        identify_part_text(IDENTIFY_PART_WAVE));
    for (int n = 0; n < 2; n++) {
        struct identify_session c = session(7);
        struct estimate_of e;
        struct observations o;
        const struct model truth = device(&c, value[n]);
        double cost;
        run(&c);
        CHECK_EQ_I64(observe(&o, &data, 3, 0, 0.05), 0);
        fit_costs(&truth, 1, &data, &o, 0, &cost);
        CHECK(cost > RESULT_RESIDUAL_MAX, "device %d: the truth has %g", n, cost);
        CHECK_EQ_I64(fit_weigh(&truth, &data, &o), 0);
        fit_costs(&truth, 1, &data, &o, 0, &cost);
        CHECK(cost < 1, "device %d: of what it can foretell the truth has %g", n, cost);
        observe_free(&o);
        CHECK_EQ_I64(identify_estimate(&e, &data), 0);
        CHECK(e.counted < 0.9 * (double)e.counts, "device %d: %g of %zu", n, e.counted, e.counts);
        is_found(&e, &truth);
    }
}

/* Newton and kilogram come from the known mass. If the true mass is less, all values with one of
 * these units come out larger. Metre and second do not change, and no residual shows it. */
TEST(a_wrong_mass_scales_what_has_a_newton_in_it)
{
    static const int newton[MODEL_PARS] = {1, 1, 1, 0, 1, 0, 1, 1, 0, 0, 0};
    struct identify_session c = session(5);
    const struct model truth = model_of(&c.board.device, 1.0 / c.rate_Hz);
    struct estimate_of e;
    c.hung_kg = 0.4;
    c.repeats = 3;
    run(&c);
    CHECK_EQ_I64(identify_estimate(&e, &data), 0);
    CHECK(e.fit.cost < 0.6, "residual %g", e.fit.cost);
    for (int i = 0; i < MODEL_LAG; i++) {
        const double want = truth.value[i] * (newton[i] ? 1.25 : 1);
        if (i == MODEL_COULOMB) { continue; } /* of 27 mN a tenth is nothing */
        CHECK(fabs(e.fit.at.value[i] / want - 1) < 0.08, "%s: %g, want %g", model_row[i].name,
            e.fit.at.value[i], want);
    }
}

/* A pulley with play: the count stays where it is for 40 counts behind each turn. */
static void play(struct exh_drive_in *in)
{
    static int32_t shown;
    const int32_t is = (int32_t)(in->enc_raw[0] << 8) >> 8;
    if (is > shown + 20) { shown = is - 20; }
    if (is < shown - 20) { shown = is + 20; }
    in->enc_raw[0] = (uint32_t)shown & 0xFFFFFF;
}

TEST(what_does_not_fit_is_told)
{
    struct identify_session c = session(2);
    struct estimate_of e;
    c.board.wires_in = play;
    run(&c);
    CHECK(data.result == EXH_PROBE_DONE, "%s", identify_result_text(data.result));
    CHECK_EQ_I64(identify_estimate(&e, &data), 0);
    CHECK(e.fit.cost > RESULT_RESIDUAL_MAX, "residual %g", e.fit.cost);
}

/* --- the file --- */

static const char good[] = "exhand identify 2\n"
                           "# a remark\n"
                           "rate = 2000 hz\n"
                           "known_mass = 0.5 kg\n"
                           "residual = 0.33\n"
                           "rotor = 0.0464 0.0461 0.0467 kg\n"
                           "coulomb = 0.027 0.025 0.028 n\n"
                           "viscous = 3.41 3.39 3.43 ns_per_m\n"
                           "delay = 0.00063 0.0006 0.00065 s\n"
                           "kf = 3.34 3.33 3.35 n_per_a\n"
                           "step = 6.63e-05 6.62e-05 6.64e-05 m\n"
                           "cable_k = 2969 2960 2980 n_per_m\n"
                           "cable_b = 6.2 6.1 6.3 ns_per_m\n"
                           "mu_motor = 0.1835 0.183 0.184\n"
                           "mu_mass = 0.088 0.087 0.089\n"
                           "lag = 0.00016 0.00014 0.00018 s\n"
                           "monitor_lag = 0.0003 s\n"
                           "mu_both = 0.2715 0.271 0.272\n";

/* The good file with one text in it replaced. */
static void put(const char *path, const char *old, const char *with)
{
    FILE *f = fopen(path, "w");
    const char *at = strstr(good, old);
    CHECK(f != NULL && at != NULL, "%s, \"%s\"", path, old);
    if (f == NULL || at == NULL) { return; }
    fprintf(f, "%.*s%s%s", (int)(at - good), good, with, at + strlen(old));
    fclose(f);
}

TEST(a_file_is_read_back)
{
    char *dir = said_dir(), path[300];
    struct result_file r, again;
    FILE *f;
    snprintf(path, sizeof path, "%s/device.txt", dir);
    put(path, "# a remark", "");
    CHECK(result_read(&r, path) == 0, "%s", path);
    CHECK(r.rate_Hz == 2000 && r.mass_kg == 0.5 && r.low.value[MODEL_KF] == 3.33 &&
              r.high.value[MODEL_LAG] == 0.00018,
        "%g Hz", r.rate_Hz);
    f = fopen(path, "w");
    CHECK(f != NULL, "%s", path);
    result_write(f, &r);
    fclose(f);
    CHECK(result_read(&again, path) == 0, "%s", path);
    CHECK(again.monitor_lag_s == 0.0003, "%g s", again.monitor_lag_s);
    for (int i = 0; i < MODEL_PARS; i++) {
        CHECK(fabs(again.value.value[i] - r.value.value[i]) < 1e-6 * r.value.value[i], "%s",
            model_row[i].name);
    }
    said_clean(dir);
}

TEST(a_damaged_file_is_refused_by_line)
{
    static const struct {
        const char *old, *with, *says;
    } row[] = {
        {"identify 2", "identify 1", ":1: "},
        {"rate = 2000 hz", "rate = 2000 khz", ":3: "},
        {"rate = 2000 hz\n", "", "has no rate"},
        {"rate = 2000", "rate = nan", ":3: "},
        {"known_mass = 0.5 kg", "known_mass = -0.5 kg", ":4: "},
        {"# a remark", "remark", ":2: "},
        {"# a remark", "weight = 3 kg", "unknown name"},
        {"# a remark", "rate = 2000 hz", ":3: "},
        {"rotor = 0.0464 0.0461", "rotor = 0.0464 0.0465", "outside its interval"},
        {"rotor = 0.0464 0.0461 0.0467 kg", "rotor = 0.0464 0.0461 kg", ":6: "},
        {"rotor = 0.0464 0.0461 0.0467 kg", "rotor = 0.0464 0.0461 0.0467 kg kg", ":6: "},
        {"kf = 3.34 3.33 3.35", "kf = 3.34 3.33 inf", ":10: "},
        {"residual = 0.33", "residual = 0.33 0.33", ":5: "},
        {"rate = 2000 hz", "rate = 0 hz", ":3: "},
        {"coulomb = 0.027 0.025", "coulomb = -0.03 -0.04", ":7: "},
        {"rotor = 0.0464 0.0461 0.0467 kg", "rotor : 0.0464 0.0461 0.0467 kg", ":6: "},
        {"viscous = 3.41 3.39 3.43 ns_per_m\n", "", "has no viscous"},
        {"mu_mass = ", "mu_motor = ", ":15: "},
        {"monitor_lag = 0.0003", "monitor_lag = -0.0003", ":17: "},
        {"monitor_lag = 0.0003 s\n", "", "has no monitor_lag"},
        {"0.271 0.272\n", "0.271 0.272", "without an end"},
        {"mu_both = 0.2715 0.271 0.272\n", "", "has no mu_both"},
        {"mu_both = 0.2715", "mu_both = 0.2719", "mu_both is not mu_motor + mu_mass"},
        {"mu_both = 0.2715", "mu_both = 0.28", "outside its interval"},
    };
    char *dir = said_dir(), path[300];
    snprintf(path, sizeof path, "%s/device.txt", dir);
    for (size_t i = 0; i < LEN(row); i++) {
        put(path, row[i].old, row[i].with);
        said(&s, dir, cli_advise, WORDS("advise", "gains", "--device", path));
        CHECK(s.status == 2 && strstr(s.err, row[i].says) && strstr(s.err, "device.txt"),
            "row %zu: %d %s", i, s.status, s.err);
        CHECK(s.out[0] == '\0', "row %zu: %s", i, s.out);
    }
    said(&s, dir, cli_advise, WORDS("advise", "gains", "--device", "no/file"));
    CHECK(s.status == 2 && strstr(s.err, "no/file"), "%d %s", s.status, s.err);
    put(path, "# a remark", "");
    said(&s, dir, cli_advise, WORDS("advise", "gains", "--device", path, "--off", "20"));
    CHECK(s.status == 2 && strstr(s.err, "--off"), "%d %s", s.status, s.err);
    said_clean(dir);
}

static int parsed(struct result_file *r, const char *text)
{
    const char *name = file_of(text);
    const int err = result_read(r, name);
    remove(name);
    return err;
}

/* Bytes by chance in a good file: it is read or refused, and what is read is in its ranges. */
TEST(any_bytes_are_read_or_refused)
{
    struct sim_random chance = {1};
    for (int i = 0; i < 300; i++) {
        char text[sizeof good];
        struct result_file r;
        memcpy(text, good, sizeof good);
        for (int k = 0; k < 3; k++) {
            text[sim_random_u64(&chance) % (sizeof text - 1)] =
                (char)(1 + sim_random_u64(&chance) % 126);
        }
        if (parsed(&r, text) != 0) { continue; }
        CHECK(r.mu_low <= model_mu(&r.value) + 1e-5 && model_mu(&r.value) <= r.mu_high + 1e-5, "%s",
            text);
        for (int p = 0; p < MODEL_PARS; p++) {
            CHECK(r.low.value[p] <= r.value.value[p] && r.value.value[p] <= r.high.value[p] &&
                      r.low.value[p] >= model_row[p].min && r.high.value[p] <= model_row[p].max,
                "%s", text);
        }
    }
}

/* The advisor's devices stay inside the interval of both frictions' sum, though those of its parts
 * reach far beyond it. */
TEST(the_sum_of_both_frictions_is_kept)
{
    static struct region_opt o;
    struct result_file r;
    int low = 0, high = 0;
    CHECK(parsed(&r, good) == 0, "%s", good);
    r.low.value[MODEL_MU_MOTOR] = 0.15;
    r.high.value[MODEL_MU_MOTOR] = 0.22;
    r.low.value[MODEL_MU_MASS] = 0.05;
    r.high.value[MODEL_MU_MASS] = 0.12;
    CHECK_EQ_I64(gains_told(&o, &r, r.rate_Hz), 0);
    CHECK(o.devices > 4, "%d devices", o.devices);
    for (int i = 0; i < o.devices; i++) {
        const double a = o.device[i].mu_motor, b = o.device[i].mu_mass;
        CHECK(a >= 0.15 && a <= 0.22 && b >= 0.05 && b <= 0.12, "device %d: %g, %g", i, a, b);
        CHECK(a + b > 0.271 - 1e-9 && a + b < 0.272 + 1e-9, "device %d: %g + %g", i, a, b);
        low += a + b < 0.2711;
        high += a + b > 0.2719;
    }
    CHECK(low > 0 && high > 0, "%d at the lower end, %d at the upper", low, high);
}

/* --- the command, and what is made of its file --- */

/* A fall oscillates by what the monitor shows. Here it is by one count, 4 N of force or less, so a
 * slow monitor hides it: what drop calls no rest, the advisor has to call that, too. */
TEST(a_rest_is_judged_by_the_devices_own_monitor)
{
    static const struct model m = {
        {0.0629, 0.0272, 2.387, 0.482e-3, 3.317, 44.02e-6, 10833, 1.376, 0.0856, 0.1675, 0.151e-3}};
    static const double lag_s[] = {0, 115e-6, 321e-6, 1e-3};
    static struct gains_options a;
    struct result_file f;
    int rest[LEN(lag_s)];
    memset(&f, 0, sizeof f);
    f.rate_Hz = 2000;
    f.value = f.low = f.high = m;
    f.mu_low = f.mu_high = model_mu(&m);
    gains_defaults(&a);
    a.has_file = 1;
    CHECK_EQ_I64(gains_refuse(&a), 0);
    a.o.cases = 256;
    a.o.wall.T_s = 1 / f.rate_Hz;
    for (size_t i = 0; i < LEN(lag_s); i++) {
        f.monitor_lag_s = lag_s[i];
        CHECK_EQ_I64(gains_told(&a.o, &f, f.rate_Hz), 0);
        rest[i] = region_try(&a.o, 21594, 35.85).rest;
    }
    CHECK(rest[0] <= rest[1] && rest[1] < 250 && rest[2] == 256 && rest[3] == 256,
        "%d, %d, %d, %d of 256 at rest", rest[0], rest[1], rest[2], rest[3]);
}

TEST(the_device_is_told_apart)
{
    char *dir = said_dir(), path[300], log[300];
    const struct sim_device d = sim_device_default();
    struct result_file r;
    said(&s, dir, cli_identify, WORDS("identify", "--seed", "77", "--repeats", "4", "--out", dir));
    CHECK(s.status == 0 && strstr(s.out, "the model fits"), "%d\n%s%s", s.status, s.out, s.err);
    snprintf(path, sizeof path, "%s/device.txt", dir);
    CHECK(result_read(&r, path) == 0, "%s", path);
    const struct model truth = model_of(&d, 1 / r.rate_Hz);
    for (int i = 0; i < MODEL_PARS; i++) {
        const double half = (r.high.value[i] - r.low.value[i]) / 2;
        CHECK(fabs(r.value.value[i] - truth.value[i]) <= 3 * half,
            "%s: %g, %g either side; it is %g", model_row[i].name, r.value.value[i], half,
            truth.value[i]);
        CHECK(i == MODEL_LAG || half < (i == MODEL_COULOMB ? 0.6 : 0.2) * truth.value[i],
            "%s: %g either side of %g", model_row[i].name, half, truth.value[i]);
    }
    CHECK(r.high.value[MODEL_LAG] < r.value.value[MODEL_DELAY], "a lag of %g s in a delay of %g s",
        r.high.value[MODEL_LAG], r.value.value[MODEL_DELAY]);
    said(&s, dir, cli_advise,
        WORDS("advise", "gains", "--device", path, "--rate", "500", "--cases", "4", "--k", "3000",
            "--b", "10"));
    CHECK(s.status == 0 && strstr(s.out, ": allowed ("), "%d\n%s%s", s.status, s.out, s.err);
    CHECK(fabs(model_mu(&r.value) - model_mu(&truth)) <= 1.5 * (r.mu_high - r.mu_low) &&
              r.mu_high - r.mu_low < 0.2 * model_mu(&truth),
        "mu_both: %g, %g .. %g; it is %g", model_mu(&r.value), r.mu_low, r.mu_high,
        model_mu(&truth));
    snprintf(log, sizeof log, "%s/identify.exh", dir);
    said(&s, dir, cli_replay, WORDS("replay", log));
    CHECK(s.status == 0, "%d\n%s%s", s.status, s.out, s.err);
    said(&s, dir, cli_identify, WORDS("identify", "--from-log", log));
    CHECK(s.status == 0 && strstr(s.out, "the model fits"), "%d\n%s%s", s.status, s.out, s.err);
    said_clean(dir);
}

TEST(what_cannot_be_lifted_asks_for_a_lighter_mass)
{
    char *dir = said_dir();
    said(&s, dir, cli_identify, WORDS("identify", "--repeats", "2", "--mass", "2"));
    CHECK(s.status == 1 && strstr(s.err, "lighter mass"), "%d\n%s%s", s.status, s.out, s.err);
    said_clean(dir);
}

TEST_MAIN("identify", what_is_found_is_the_device, a_stiff_string_on_a_light_rotor_is_told_apart,
    a_string_that_slackens_is_told_apart, a_wrong_mass_scales_what_has_a_newton_in_it,
    what_does_not_fit_is_told, a_file_is_read_back, a_damaged_file_is_refused_by_line,
    any_bytes_are_read_or_refused, the_sum_of_both_frictions_is_kept, the_device_is_told_apart,
    a_rest_is_judged_by_the_devices_own_monitor, what_cannot_be_lifted_asks_for_a_lighter_mass);
