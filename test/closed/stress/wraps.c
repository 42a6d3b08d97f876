/* SPDX-License-Identifier: MIT */
/* Counters that wrap: ticks, records, encoder counts. */
#include "stress.h"

#include "exhand/run/log.h"
#include "posix.h"

#include <stdlib.h>

/* A run with the tick counter set; the CRC of everything it gave. */
static uint32_t run_from_tick(uint32_t first, uint32_t fault_at)
{
    struct exh_drive_out out;
    fresh();
    set(ID_K, EXH_Q(20000, 1, EXH_Q_K));
    start((struct exh_period){1, 2000});
    rig.state.safety.tick = rig.shadow.safety.tick = first;
    for (uint32_t n = 0; n < 4000; n++) {
        struct exh_scene_in in = idle_in(n, (n / 3) & 0xFFFFFF);
        if (n == fault_at) { in.drive.din = 0; }
        tick(&in, &out);
    }
    must(rig.state.safety.tick == first + 4000u, "tick", "%lu",
        (unsigned long)rig.state.safety.tick);
    must(rig.state.safety.first_tick == first + fault_at, "first_tick", "%lu",
        (unsigned long)rig.state.safety.first_tick);
    return rig.w.crc;
}

static void tick_counter_wraps(void)
{
    static const uint32_t fault_at[] = {1999, 2000, 2001};
    for (size_t i = 0; i < LEN(fault_at); i++) {
        const uint32_t crc = run_from_tick(0, fault_at[i]);
        const uint32_t wrapped = run_from_tick(UINT32_MAX - 1999, fault_at[i]);
        must(crc == wrapped, "outputs", "CRC %08lx, from tick 0 %08lx", (unsigned long)wrapped,
            (unsigned long)crc);
        if (rig.w.broken) { break; }
    }
    report("tick counter wraps, fault at it", "same bits as from tick 0; its tick is kept");
}

/* The log of the scene's instance over ticks that pass 2^32. Ticks go on, a keyframe is at tick 0,
 * and from it the rest replays bit for bit. */
static char *write_wrapping_log(uint32_t first, uint32_t ticks, size_t *len_B)
{
    const struct exh_scene *sc = &exh_scene_drop;
    const struct exh_scene_board board = {{1, 2000}, 24};
    struct posix_config p = posix_config_default();
    char *log = NULL;
    p.log = open_memstream(&log, len_B);
    posix_configure(&p);
    sc->defaults();
    must(exh_params_stage(sc->params, exh_calib_set_rows[2].id, 0, 1) == 0 &&
             exh_params_apply(sc->params),
        "set-up", "uncalibrated");
    must(p.log != NULL && sc->setup(board) == 0, "set-up", "refused");
    exh_log_start(sc, board);
    for (uint32_t n = 0; n < ticks; n++) {
        struct exh_scene_in in;
        struct exh_drive_out out;
        memcpy(&rig.sig, exh_scene_signals(sc), sizeof rig.sig); /* for the monitor */
        in = idle_in(n, n * 7 % 6000 < 3000 ? n * 7 % 6000 : 6000 - n * 7 % 6000);
        exh_log_before(first + n, &in);
        sc->tick(&in, &out);
        exh_log_after(first + n, &in, &out);
    }
    exh_log_end(first + ticks);
    fclose(p.log);
    return log;
}

/* One record back in; the frames behind tick 0's keyframe must come out again. */
static void read_back(const struct exh_record *r, uint32_t *next, int *running)
{
    const struct exh_scene *sc = &exh_scene_drop;
    struct exh_bytes c = exh_bytes_reader(r->payload, r->len_B);
    struct exh_scene_in in = idle_in(1, 0);
    struct exh_drive_out rec, out;
    struct drop_signals sig;
    if (r->type == EXH_RECORD_KEYFRAME && r->tick == 0 && *next == 0) {
        exh_log_keyframe_serialize(&c, sc);
        *running = 1;
    }
    if (r->type != EXH_RECORD_FRAME) { return; }
    must(r->tick == *next, "tick", "%lu, want %lu", (unsigned long)r->tick, (unsigned long)*next);
    *next = r->tick + 1;
    if (!*running) { return; }
    memset(&rec, 0, sizeof rec);
    exh_log_frame_serialize(&c, sc, &in, &rec, (int32_t *)&sig);
    sc->tick(&in, &out);
    must(out.dac_raw[0] == rec.dac_raw[0] && memcmp(&sig, exh_scene_signals(sc), sizeof sig) == 0,
        "replay", "tick %lu differs", (unsigned long)r->tick);
    rig.w.ticks++;
}

static void log_wraps(void)
{
    const uint32_t first = UINT32_MAX - 2499;
    uint32_t next = first, seq = 0;
    size_t len_B = 0, at = 0;
    int running = 0;
    char *log;
    fresh();
    log = write_wrapping_log(first, 5000, &len_B);
    while (at < len_B && rig.w.broken == 0) {
        struct exh_record r;
        const int32_t n = exh_record_decode(log + at, (uint32_t)(len_B - at), &r);
        must(n > 0, "record", "%ld at %zu", (long)n, at);
        if (n <= 0) { break; }
        must(r.seq == seq++, "sequence", "%lu", (unsigned long)r.seq);
        read_back(&r, &next, &running);
        at += (size_t)n;
    }
    free(log);
    must(next == first + 5000u && running && rig.w.ticks == 2500, "log", "%lu ticks replayed",
        (unsigned long)rig.w.ticks);
    rig.w.q_min = rig.w.q_max = 0;
    report("record ticks wrap", "in order, keyframe at tick 0, rest replays");
}

/* The extended count over all its 32 bits, both ways, at the fastest legal speed. */
static void count_wraps(int32_t step)
{
    struct exh_drive_out out;
    uint32_t raw = 0;
    int32_t cnt = 0;
    fresh();
    rig.blind = 1;
    start((struct exh_period){1, 2000});
    arm();
    for (uint32_t n = 0; n < 2000; n++) {
        const struct exh_scene_in in = idle_in(1, raw & 0xFFFFFF);
        tick(&in, &out);
        must(rig.state.quad.cnt == cnt, "count", "%ld, want %ld", (long)rig.state.quad.cnt,
            (long)cnt);
        must(n < 2 || (rig.sig.qd_mps_q27 > 0) == (step > 0), "velocity", "%ld",
            (long)rig.sig.qd_mps_q27);
        raw += (uint32_t)step;
        cnt = exh_wrap_add(cnt, step);
    }
    report(
        step > 0 ? "count wraps upward" : "count wraps downward", "exact, velocity keeps its sign");
}

void wraps(void)
{
    tick_counter_wraps();
    log_wraps();
    count_wraps(0x7FFFFF);
    count_wraps(-0x7FFFFF);
}
