/* SPDX-License-Identifier: MIT */
/* The impaired link against its own numbers, two-sided, and recorded networks through it. */
#include "check.h"
#include "file_of.h"

#include "sim/link.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#define N     100000
#define GAP_S 0.0025

static struct sim_link_way way;

/* What became of each packet: when its copies arrived, in what order. */
static struct {
    double due_s[N]; /* of the first copy, < 0: never */
    int copies[N];
    int order[2 * N]; /* numbers as they arrived */
    int arrived;
} seen;

static double root_of(double v)
{
    double r = v > 1 ? v : 1;
    for (int i = 0; i < 200; i++) { r = 0.5 * (r + v / r); }
    return r;
}

/* Takes the packets that arrived by t_s, and checks that they had not a moment before. */
static void take(struct sim_link_way *w, double t_s)
{
    for (double next_s; (next_s = sim_link_next_s(w)) <= t_s;) {
        int number, n;
        CHECK_EQ_I64(sim_link_recv(w, next_s * (1 - 1e-15) - 1e-300, &number, sizeof number), 0);
        n = sim_link_recv(w, next_s, &number, sizeof number);
        CHECK(n == sizeof number && number >= 0 && number < N, "%d bytes", n);
        if (seen.copies[number]++ == 0) { seen.due_s[number] = next_s; }
        seen.order[seen.arrived++] = number;
    }
}

/* N packets, a gap between. */
static void run(const struct sim_link_par *p, const struct sim_trace *trace, uint64_t seed)
{
    memset(&seen, 0, sizeof seen);
    for (int n = 0; n < N; n++) { seen.due_s[n] = -1; }
    sim_link_start(&way, p, trace, seed);
    for (int n = 0; n < N; n++) {
        take(&way, n * GAP_S);
        CHECK_EQ_I64(sim_link_send(&way, n * GAP_S, &n, sizeof n), sizeof n);
    }
    take(&way, 1e9);
    CHECK(way.counts.sent + way.counts.doubled ==
              way.counts.arrived + way.counts.lost + way.counts.in_hole + way.counts.overflow,
        "counts do not add up");
    CHECK_EQ_I64((int64_t)way.counts.arrived, seen.arrived);
}

static double delay_of(int n) { return seen.due_s[n] - n * GAP_S; }

/* ---- Delay ----------------------------------------------------------------------------------- */

TEST(a_perfect_link_is_not_there)
{
    const struct sim_link_par p = sim_link_default();
    run(&p, NULL, 1);
    for (int n = 0; n < N; n++) {
        CHECK(seen.order[n] == n && delay_of(n) == 0, "packet %d: %.9g s, place of %d", n,
            delay_of(n), seen.order[n]);
    }
}

TEST(a_constant_delay_is_exact)
{
    static const double delay_s[] = {0.0001, 0.05, 0.5, 2.4};
    for (size_t i = 0; i < LEN(delay_s); i++) {
        struct sim_link_par p = sim_link_default();
        p.delay_s = delay_s[i];
        run(&p, NULL, 1);
        for (int n = 0; n < N; n++) {
            CHECK(seen.due_s[n] == n * GAP_S + delay_s[i] && seen.order[n] == n, "packet %d", n);
        }
    }
}

/* The share of delays in each tenth of the range +- jitter, and moments. */
struct shape {
    double bin[10], mean, deviation, lo, hi, next; /* next: correlation with the next */
};

static struct shape shape_of(double delay_s, double jitter_s)
{
    struct shape s = {{0}, 0, 0, 1, -1, 0};
    double product = 0;
    for (int n = 0; n < N; n++) {
        const double u = (delay_of(n) - delay_s) / jitter_s;
        int bin = (int)((u + 1) * 5);
        s.lo = u < s.lo ? u : s.lo;
        s.hi = u > s.hi ? u : s.hi;
        bin = bin < 0 ? 0 : bin > 9 ? 9 : bin;
        s.bin[bin] += 1.0 / N;
        s.mean += u / N;
        s.deviation += u * u / N;
        if (n > 0) { product += u * ((delay_of(n - 1) - delay_s) / jitter_s) / N; }
    }
    s.next = (product - s.mean * s.mean) / (s.deviation - s.mean * s.mean);
    s.deviation = root_of(s.deviation - s.mean * s.mean);
    return s;
}

/* Of a normal of deviation 1/3 clipped at +-1: in tenths of the range, from the outside. */
static const double bell[5] = {0.0082, 0.0277, 0.0792, 0.1592, 0.2257};

TEST(jitter_has_the_shape_that_was_asked)
{
    static const double memory[] = {0, 0.5, 0.9, 0.99};
    for (int kind = SIM_LINK_UNIFORM; kind <= SIM_LINK_CORRELATED; kind++) {
        for (size_t m = 0; m < LEN(memory); m++) {
            struct sim_link_par p = sim_link_default();
            struct shape s;
            const double r = kind == SIM_LINK_CORRELATED ? memory[m] : 0;
            const double rare = 1 / (1 - r); /* so many times fewer independent ones */
            p.jitter = kind;
            p.delay_s = 0.05;
            p.jitter_s = 0.02;
            p.memory = memory[m];
            run(&p, NULL, 3);
            s = shape_of(p.delay_s, p.jitter_s);
            for (int b = 0; b < 10; b++) {
                const double want = kind == SIM_LINK_UNIFORM ? 0.1 : bell[b < 5 ? b : 9 - b];
                const double tol = 5 * root_of(want / N * 2 * rare) + 5e-4;
                CHECK(fabs(s.bin[b] - want) < tol, "kind %d, memory %g, bin %d: %.5f, want %.5f",
                    kind, memory[m], b, s.bin[b], want);
            }
            CHECK(
                fabs(s.mean) < 5 * root_of(2 * rare / N) / 1.7, "kind %d: mean %.5f", kind, s.mean);
            CHECK(fabs(s.deviation - (kind == SIM_LINK_UNIFORM ? 0.57735 : 0.3315)) <
                      0.003 * root_of(rare),
                "kind %d, memory %g: deviation %.5f", kind, memory[m], s.deviation);
            CHECK(fabs(s.next - r) < 0.016, "kind %d: memory %.4f, want %g", kind, s.next, r);
            CHECK(s.lo >= -1 - 1e-9 && s.hi <= 1 + 1e-9 && s.lo < -0.97 && s.hi > 0.97,
                "kind %d: %.4f..%.4f", kind, s.lo, s.hi);
        }
    }
}

TEST(no_delay_is_negative)
{
    struct sim_link_par p = sim_link_default();
    int none = 0;
    p.jitter = SIM_LINK_UNIFORM;
    p.jitter_s = 0.02;
    run(&p, NULL, 4);
    for (int n = 0; n < N; n++) {
        CHECK(delay_of(n) >= 0, "packet %d: %.9f s", n, delay_of(n));
        none += delay_of(n) == 0;
    }
    CHECK(fabs(none - 0.5 * N) < 5 * 0.5 * root_of(N), "%d without delay", none);
}

/* ---- Order
 * --------------------------------------------------------------------------------------- */

/* Arrivals are in the order of their instants; overtaken by brute force: some later number
 * arrived before. */
TEST(packets_arrive_in_the_order_of_time)
{
    for (int k = 0; k < 6; k++) {
        struct sim_link_par p = sim_link_default();
        int newest = -1;
        uint64_t overtaken = 0;
        p.delay_s = 0.05;
        p.jitter = k < 3 ? SIM_LINK_UNIFORM : SIM_LINK_CORRELATED;
        p.jitter_s = k % 3 == 0 ? 0.001 : 0.02; /* less than the gap between: no packet overtakes */
        p.in_order = k % 3 == 2;
        run(&p, NULL, 5);
        for (int n = 0; n < seen.arrived; n++) {
            CHECK(n == 0 || seen.due_s[seen.order[n]] > seen.due_s[seen.order[n - 1]] ||
                      (seen.due_s[seen.order[n]] == seen.due_s[seen.order[n - 1]] &&
                          seen.order[n] > seen.order[n - 1]),
                "arrival %d", n);
            overtaken += seen.order[n] < newest;
            newest = seen.order[n] > newest ? seen.order[n] : newest;
        }
        CHECK(overtaken == way.counts.overtaken, "%d counted", (int)way.counts.overtaken);
        CHECK(
            k % 3 == 1 ? overtaken > 1000 : overtaken == 0, "%d: %d overtaken", k, (int)overtaken);
    }
}

TEST(shares_of_what_happens_to_packets)
{
    static const double share[] = {0, 0.001, 0.05, 0.5, 1};
    for (size_t i = 0; i < LEN(share); i++) {
        struct sim_link_par p = sim_link_default();
        const double tol = 5 * root_of(share[i] * (1 - share[i]) * N);
        int back = 0, twice = 0;
        p.delay_s = 0.01;
        p.loss = share[i];
        run(&p, NULL, 6);
        CHECK(fabs((double)way.counts.lost - share[i] * N) <= tol, "loss %g: %d", share[i],
            (int)way.counts.lost);
        p.loss = 0;
        p.duplicate = share[i];
        p.duplicate_s = 0.004;
        run(&p, NULL, 6);
        for (int n = 0; n < N; n++) { twice += seen.copies[n] == 2; }
        CHECK(fabs(twice - share[i] * N) <= tol && seen.arrived == N + twice, "twice %g: %d",
            share[i], twice);
        p.duplicate_s = 0.001; /* before the next packet */
        run(&p, NULL, 6);
        CHECK(way.counts.overtaken == 0, "a double is not overtaken by its original");
        p.duplicate = 0;
        p.reorder = share[i];
        p.reorder_s = 0.006; /* two that follow overtake */
        run(&p, NULL, 6);
        for (int n = 0; n < N; n++) {
            CHECK(fabs(delay_of(n) - 0.01) < 1e-9 || fabs(delay_of(n) - 0.016) < 1e-9, "%.9f",
                delay_of(n));
            back += delay_of(n) > 0.013;
        }
        CHECK(fabs(back - share[i] * N) <= tol, "held back %g: %d", share[i], back);
        CHECK((way.counts.overtaken > 0) == (share[i] > 0 && share[i] < 1), "overtaken: %d",
            (int)way.counts.overtaken);
    }
}

/* More of one does not change the other. */
TEST(chance_is_drawn_apart)
{
    static double alone_s[N];
    struct sim_link_par p = sim_link_default();
    p.delay_s = 0.05;
    p.jitter = SIM_LINK_NORMAL;
    p.jitter_s = 0.03;
    run(&p, NULL, 7);
    memcpy(alone_s, seen.due_s, sizeof alone_s);
    p.loss = 0.3;
    p.duplicate = 0.2;
    p.duplicate_s = 1;
    run(&p, NULL, 7);
    for (int n = 0; n < N; n++) {
        CHECK(seen.due_s[n] < 0 || seen.due_s[n] == alone_s[n], "packet %d", n);
    }
    run(&p, NULL, 8);
    CHECK(seen.due_s[0] != alone_s[0] || seen.due_s[1] != alone_s[1], "another seed");
}

/* ---- Holes, room
 * ------------------------------------------------------------------------------------ */

TEST(nothing_arrives_in_a_hole_and_all_outside)
{
    static const struct {
        double at, hole, every;
    } row[] = {{10, 1, 0}, {0.5, 1, 5}, {3, 0.2, 0.3}, {0, 0, 1}};
    for (size_t i = 0; i < LEN(row); i++) {
        struct sim_link_par p = sim_link_default();
        uint64_t gone = 0;
        p.delay_s = 0.0431;
        p.jitter = SIM_LINK_UNIFORM;
        p.jitter_s = 0.01;
        run(&p, NULL, 9);
        {
            static double whole_s[N];
            memcpy(whole_s, seen.due_s, sizeof whole_s);
            p.hole_at_s = row[i].at;
            p.hole_s = row[i].hole;
            p.hole_every_s = row[i].every;
            run(&p, NULL, 9);
            for (int n = 0; n < N; n++) {
                double since = whole_s[n] - row[i].at;
                int hole;
                while (row[i].every > 0 && since >= row[i].every) { since -= row[i].every; }
                if (since > -1e-6 && row[i].every > 0 && since > row[i].every - 1e-6) { continue; }
                if (fabs(since) < 1e-6 || fabs(since - row[i].hole) < 1e-6) { continue; }
                hole = since >= 0 && since < row[i].hole;
                gone += (uint64_t)hole;
                CHECK(
                    (seen.due_s[n] < 0) == hole, "row %zu, packet %d at %.6f s", i, n, whole_s[n]);
            }
        }
        CHECK(way.counts.in_hole >= gone && way.counts.in_hole <= gone + 3, "%d in holes, want %d",
            (int)way.counts.in_hole, (int)gone);
        CHECK(i == 3 ? gone == 0 : gone > 300, "%d", (int)gone);
    }
}

TEST(the_queue_is_bounded_and_says_what_it_drops)
{
    static const double room[] = {1, 10, SIM_LINK_QUEUE};
    for (size_t i = 0; i < LEN(room); i++) {
        struct sim_link_par p = sim_link_default();
        int number = 0;
        p.delay_s = 5; /* 2000 packets on their way */
        p.queue = room[i];
        sim_link_start(&way, &p, NULL, 1);
        for (int n = 0; n < 1500; n++) { (void)sim_link_send(&way, n * GAP_S, &n, sizeof n); }
        CHECK_EQ_I64((int64_t)way.counts.overflow, 1500 - (int64_t)room[i]);
        for (int n = 0; n < room[i]; n++) {
            CHECK_EQ_I64(sim_link_recv(&way, 100, &number, sizeof number), sizeof number);
            CHECK_EQ_I64(number, n);
        }
        CHECK_EQ_I64(sim_link_recv(&way, 100, &number, sizeof number), 0);
    }
}

TEST(packets_are_whole_or_not_at_all)
{
    static uint8_t out[SIM_LINK_PACKET_B + 1], in[SIM_LINK_PACKET_B + 1];
    const struct sim_link_par p = sim_link_default();
    for (size_t n = 0; n < sizeof out; n++) { out[n] = (uint8_t)(n * 7); }
    sim_link_start(&way, &p, NULL, 1);
    CHECK_EQ_I64(sim_link_send(&way, 0, out, SIM_LINK_PACKET_B), SIM_LINK_PACKET_B);
    CHECK_EQ_I64(sim_link_recv(&way, 0, in, sizeof in), SIM_LINK_PACKET_B);
    CHECK(memcmp(in, out, SIM_LINK_PACKET_B) == 0, "changed on the way");
    CHECK_EQ_I64(sim_link_send(&way, 0, out, SIM_LINK_PACKET_B + 1), -1);
    CHECK_EQ_I64((int64_t)way.counts.too_long, 1);
    CHECK_EQ_I64(sim_link_send(&way, 0, out, 100), 100);
    CHECK_EQ_I64(sim_link_send(&way, 0, out + 1, 10), 10);
    CHECK_EQ_I64(sim_link_recv(&way, 0, in, 99), 10); /* the long one is gone */
    CHECK(memcmp(in, out + 1, 10) == 0 && way.counts.too_long == 2, "the wrong one");
}

TEST(parameters_by_name)
{
    struct sim_link_par p = sim_link_default();
    const struct sim_device_row *row;
    CHECK_EQ_I64(sim_link_set(&p, "loss", 0.25, &row), 0);
    CHECK(p.loss == 0.25, "loss");
    CHECK(sim_link_set(&p, "loss", 1.25, &row) == -1 && row != NULL && p.loss == 0.25, "range");
    CHECK(sim_link_set(&p, "los", 0.25, &row) == -1 && row == NULL, "name");
    CHECK_EQ_I64(sim_link_set(&p, "trace_scale", 0.5, &row), 0);
    CHECK(p.trace_scale == 0.5, "the last");
}

/* ---- Traces
 * --------------------------------------------------------------------------------------------- */

TEST(a_trace_replays_exactly)
{
    struct sim_trace t;
    char why[256];
    const char *name = file_of("# ms\n12.5\n\n  0.125 # the quick one\nlost\n 250\t\n0\n");
    static const double want_s[] = {0.0125, 0.000125, -1, 0.25, 0};
    CHECK(sim_trace_read(&t, name, SIM_TRACE_MS, why, sizeof why) == 0, "%s", why);
    (void)remove(name);
    CHECK_EQ_I64(t.n, 5);
    for (int i = 0; i < 5; i++) { CHECK(t.delay_s[i] == want_s[i], "%d: %.9g", i, t.delay_s[i]); }
    for (int k = 0; k < 3; k++) {
        struct sim_link_par p = sim_link_default();
        p.delay_s = k == 1 ? 0.003 : 0;
        p.trace_scale = k == 2 ? 0.5 : 1;
        run(&p, &t, 1);
        for (int n = 0; n < N; n++) {
            const double d = want_s[n % 5];
            const double due = n * GAP_S + (p.delay_s + p.trace_scale * d);
            CHECK(d < 0 ? seen.due_s[n] < 0 : seen.due_s[n] == due, "packet %d: %.9f, want %.9f", n,
                seen.due_s[n], due);
        }
        CHECK_EQ_I64((int64_t)way.counts.lost, N / 5);
    }
    sim_trace_free(&t);
}

TEST(bad_traces_are_refused_with_the_line)
{
    static const struct {
        const char *text;
        enum sim_trace_kind kind;
        const char *why;
    } row[] = {{"1\n2\nx\n", SIM_TRACE_MS, "line 3: no number"},
        {"1 2\n", SIM_TRACE_MS, "line 1: no number"}, {"-1\n", SIM_TRACE_MS, "line 1: a delay is"},
        {"nan\n", SIM_TRACE_MS, "line 1: a delay is"},
        {"losts\n", SIM_TRACE_MS, "line 1: no number"},
        {"# nothing\n\n", SIM_TRACE_MS, "holds no packet"},
        {"r,1,2\n", SIM_TRACE_ARRIVAL, "holds no packet"},
        {"d,1\nr,1\n", SIM_TRACE_ROUND, "line 2: two numbers"},
        {"r,1,-5\n", SIM_TRACE_ROUND, "line 1: no round trip"}};
    struct sim_trace t;
    char why[256];
    for (size_t i = 0; i < LEN(row); i++) {
        const char *name = file_of(row[i].text);
        const int err = sim_trace_read(&t, name, row[i].kind, why, sizeof why);
        (void)remove(name);
        CHECK(err == -1 && strstr(why, row[i].why) != NULL && t.n == 0, "row %zu: %d, %s", i, err,
            why);
    }
    CHECK(sim_trace_read(&t, "no/such.xz", SIM_TRACE_MS, why, sizeof why) == -1, "read");
    CHECK(strstr(why, "no/such.xz: No such file") != NULL, "%s", why);
}

TEST(arrivals_are_delays_above_the_quickest)
{
    struct sim_trace t;
    char why[256];
    const char *name =
        file_of("m,1000000000,0,7\nx\nm,1012000000,441,7\nm,1019000000,882,7\nm,1031000000,1323\n");
    static const double want_s[] = {0.001, 0.003, 0, 0.002};
    CHECK(sim_trace_read(&t, name, SIM_TRACE_ARRIVAL, why, sizeof why) == 0, "%s", why);
    CHECK_EQ_I64(t.n, 4);
    for (int i = 0; i < 4; i++) {
        CHECK(fabs(t.delay_s[i] - want_s[i]) < 1e-12, "%d: %.9g", i, t.delay_s[i]);
    }
    CHECK_EQ_I64(sim_trace_write(&t, name), 0);
    sim_trace_free(&t);
    CHECK(sim_trace_read(&t, name, SIM_TRACE_MS, why, sizeof why) == 0, "%s", why);
    for (int i = 0; i < 4; i++) {
        CHECK(fabs(t.delay_s[i] - want_s[i]) < 1e-12, "%d: %.9g", i, t.delay_s[i]);
    }
    sim_trace_free(&t);
    (void)remove(name);
}

static int by_size(const void *a, const void *b)
{
    const double x = *(const double *)a, y = *(const double *)b;
    return x < y ? -1 : x > y;
}

/* Median, 99 %, highest, ms; what SOURCE.md of the data says, or was found in it. */
static void recorded(const char *file, enum sim_trace_kind kind, long n, const double want_ms[4])
{
    const char *dir = getenv("EXH_DATA");
    struct sim_link_par p = sim_link_default();
    static const double at[] = {0, 0.5, 0.99, 1};
    struct sim_trace t;
    char path[512], why[600];
    double *sorted;
    FILE *f;
    snprintf(path, sizeof path, "%s/%s", dir ? dir : "$EXH_DATA", file);
    f = fopen(path, "rb");
    if (f == NULL) {
        check_note("%s: not here, nothing recorded was tried", path);
        return;
    }
    fclose(f);
    CHECK(sim_trace_read(&t, path, kind, why, sizeof why) == 0, "%s", why);
    CHECK_EQ_I64(t.n, n);
    run(&p, &t, 1);
    for (int k = 0; k < N; k++) {
        CHECK(seen.due_s[k] == k * GAP_S + t.delay_s[k % t.n], "%s, packet %d", file, k);
    }
    sorted = t.delay_s;
    qsort(sorted, (size_t)t.n, sizeof *sorted, by_size);
    for (int k = 0; k < 4; k++) {
        const double ms = 1e3 * sorted[(long)(at[k] * (double)(t.n - 1))];
        CHECK(fabs(ms - want_ms[k]) <= 0.051 + 0.0005 * want_ms[k],
            "%s: %g of it %.4f ms, want %.4f", file, at[k], ms, want_ms[k]);
    }
    sim_trace_free(&t);
}

TEST(recorded_networks_replay)
{
    static const double internet[] = {172.7, 186.2, 220.9, 499.4};
    static const double round[] = {0.356, 0.463, 0.522, 2.461};
    static const double arrival[] = {0, 2.834, 14.083, 19.564};
    recorded("net-internet-ping/experimental.dat", SIM_TRACE_MS, 13448, internet);
    recorded("net-ethernet-direct/ethernet-no_load.csv.xz", SIM_TRACE_ROUND, 1521, round);
    recorded("net-ethernet-direct/ethernet-no_load.csv.xz", SIM_TRACE_ARRIVAL, 30141, arrival);
}

TEST_MAIN("link", a_perfect_link_is_not_there, a_constant_delay_is_exact,
    jitter_has_the_shape_that_was_asked, no_delay_is_negative, packets_arrive_in_the_order_of_time,
    shares_of_what_happens_to_packets, chance_is_drawn_apart,
    nothing_arrives_in_a_hole_and_all_outside, the_queue_is_bounded_and_says_what_it_drops,
    packets_are_whole_or_not_at_all, parameters_by_name, a_trace_replays_exactly,
    bad_traces_are_refused_with_the_line, arrivals_are_delays_above_the_quickest,
    recorded_networks_replay);
