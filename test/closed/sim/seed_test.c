/* SPDX-License-Identifier: MIT */
/* The log of a run of the simulated device depends on its seed, to the last byte. It does not
 * depend on the value of the encoder's counter. */
#include "check.h"

#include "box/run.h"
#include "posix.h"

#include "drop/drop.h"
#include "exhand/run/log.h"

#include "exhand/exhand.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define COUNTS (1 << 24)

struct bytes {
    char *p;
    size_t len;
};

/* A run of the drop scene, its log in memory. */
static struct bytes logged_run(const struct sim_device *d, uint64_t seed, int falls)
{
    struct run_cfg c;
    struct bytes b = {NULL, 0};
    struct run r;
    memset(&c, 0, sizeof c);
    c.rate_Hz = 500;
    c.k_Npm = 6000;
    c.b_Nspm = 20;
    c.board = posix_config_default();
    c.board.device = *d;
    c.board.seed = seed;
    c.board.falls = falls;
    c.board.log = open_memstream(&b.p, &b.len);
    CHECK(c.board.log != NULL, "no memory stream");
    CHECK_EQ_I64(run_drop(&c, &r), 0);
    CHECK_EQ_I64(fclose(c.board.log), 0);
    CHECK(r.faults == 0 && r.lost == 0, "faults %#x, %lu lost", (unsigned)r.faults,
        (unsigned long)r.lost);
    run_free(&r);
    return b;
}

static int same(const struct bytes *a, const struct bytes *b)
{
    return a->len == b->len && memcmp(a->p, b->p, a->len) == 0;
}

TEST(the_seed_decides_every_byte)
{
    const struct sim_device d = sim_device_default();
    struct bytes b[3];
    for (int i = 0; i < 3; i++) { b[i] = logged_run(&d, i == 2 ? 6 : 5, 2); }
    CHECK(b[0].len > 100000, "%zu bytes", b[0].len);
    CHECK(same(&b[0], &b[1]), "seed 5 twice: %zu and %zu bytes", b[0].len, b[1].len);
    CHECK(!same(&b[0], &b[2]), "seeds 5 and 6 give the same log");
    for (int i = 0; i < 3; i++) { free(b[i].p); }
}

/* The next frame of a log in memory: its signals, outputs and inputs. */
static int next_frame(const struct bytes *b, uint32_t *at, struct exh_scene_in *in,
    struct exh_drive_out *out, struct drop_signals *s)
{
    struct exh_record r;
    while (*at < b->len) {
        const int32_t n = exh_record_decode(b->p + *at, (uint32_t)b->len - *at, &r);
        struct exh_bytes c;
        CHECK(n > 0, "record at %lu: %ld", (unsigned long)*at, (long)n);
        *at += (uint32_t)n;
        if (r.type != EXH_RECORD_FRAME) { continue; }
        c = exh_bytes_reader(r.payload, r.len_B);
        exh_log_frame_serialize(&c, &exh_scene_drop, in, out, (int32_t *)s);
        CHECK(exh_bytes_ok(&c) && c.at == r.len_B, "frame of %u bytes", (unsigned)r.len_B);
        return 1;
    }
    return 0;
}

/* what two runs that differ in enc_start have in common */
struct wrap {
    int frames, wraps;
};

static struct wrap compare_runs(const struct bytes *a, const struct bytes *b, uint32_t shift)
{
    struct exh_scene_in in[2];
    struct exh_drive_out out[2];
    struct drop_signals s[2];
    struct wrap w = {0, 0};
    uint32_t at[2] = {0, 0}, last = 0;
    memset(in, 0, sizeof in);
    memset(out, 0, sizeof out);
    while (next_frame(a, &at[0], &in[0], &out[0], &s[0])) {
        const uint32_t want = (in[0].drive.enc_raw[0] + shift) % COUNTS;
        CHECK(next_frame(b, &at[1], &in[1], &out[1], &s[1]), "the second log is shorter");
        CHECK(in[1].drive.enc_raw[0] == want, "frame %d: raw %#x, want %#x", w.frames,
            (unsigned)in[1].drive.enc_raw[0], (unsigned)want);
        CHECK(memcmp(&s[0], &s[1], sizeof s[0]) == 0, "frame %d: q %ld and %ld", w.frames,
            (long)s[0].q_m_q30, (long)s[1].q_m_q30);
        CHECK(out[0].dac_raw[0] == out[1].dac_raw[0], "frame %d: code %u and %u", w.frames,
            (unsigned)out[0].dac_raw[0], (unsigned)out[1].dac_raw[0]);
        if (w.frames++ > 0) { w.wraps += (last > want ? last - want : want - last) > COUNTS / 2; }
        last = want;
    }
    CHECK(!next_frame(b, &at[1], &in[1], &out[1], &s[1]), "the second log is longer");
    return w;
}

TEST(the_counters_wrap_is_nowhere_seen)
{
    static const struct {
        uint32_t start;
        int wraps; /* at least; -1 none at all */
    } row[] = {{0, 2}, {5, 2}, {0xFFFFFF, 2}, {0xFFFFFF - 10, 2}, {1000, 2}, {0x800000, -1},
        {0x400000, -1}};
    struct sim_device d = sim_device_default();
    const struct bytes at_0 = logged_run(&d, 3, 2);
    for (size_t i = 0; i < LEN(row); i++) {
        struct bytes b;
        struct wrap w;
        d.enc_start = row[i].start;
        b = logged_run(&d, 3, 2);
        w = compare_runs(&at_0, &b, row[i].start);
        CHECK(w.frames > 4000, "%d frames", w.frames);
        CHECK(row[i].wraps < 0 ? w.wraps == 0 : w.wraps >= row[i].wraps, "start %#x: %d wraps",
            (unsigned)row[i].start, w.wraps);
        free(b.p);
    }
    free(at_0.p);
}

TEST_MAIN("seed", the_seed_decides_every_byte, the_counters_wrap_is_nowhere_seen);
