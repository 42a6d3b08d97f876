/* A scene with parameters and records: options by the names of its table, log to a serial line or
 * to the port that emulators listen to. */
#include "pc104.h"

#include "io.h"
#include "log.h"

#include "exhand/error.h"
#include "exhand/exhand.h"

#define DEBUG_PORT  0xE9u
#define RING_B      32768u /* a power of two: seven of the largest records, 200 ms of frames */
#define STUCK_READS 100000u /* 0.07 s and more on ISA; 16 characters take 1.4 ms */
#define BURST_B     16u /* what the UART's FIFO takes at once                             */

static uint8_t ring[RING_B];
static uint32_t put, got; /* bytes in all, modulo 2^32 */
static uint32_t unsent; /* bytes given up at the end */
static uint32_t last_tick;
static uint8_t started, dry;

int pc104_log_take(const void *rec, size_t len_B)
{
    const uint8_t *byte = rec;
    if (dry) { put = got; }
    if (pc104_par.log == PC104_LOG_DEBUG && !dry) {
        for (size_t i = 0; i < len_B; i++) { pc104_out8(DEBUG_PORT, byte[i]); }
        return (int)len_B;
    }
    if (len_B > RING_B - (put - got)) { return 0; }
    for (size_t i = 0; i < len_B; i++) { ring[put++ % RING_B] = byte[i]; }
    return (int)len_B;
}

/* What is cut at the end of the ring waits for nothing more. 1: there is more to do at once. */
static int idle_udp(int now)
{
    const uint32_t at = got % RING_B;
    uint32_t n = put - got, taken;
    if (n == 0) { return 0; }
    if (n > RING_B - at) {
        n = RING_B - at;
        now = 1;
    }
    taken = pc104_link_log(&ring[at], n, now);
    got += taken;
    return taken > 0 && got != put;
}

int pc104_idle(void)
{
    const uint32_t at = got % RING_B;
    uint32_t n = put - got;
    if (pc104_par.log == PC104_LOG_UDP) { return idle_udp(0); }
    n = n < BURST_B ? n : BURST_B;
    n = n < RING_B - at ? n : RING_B - at;
    got += pc104_uart_offer(&ring[at], n);
    return got != put;
}

int pc104_scene_option(const struct exh_scene *sc, const char *name, const char *value)
{
    const struct exh_signal_table *t = sc->params->table;
    int found = 0;
    for (uint32_t i = 0; i < exh_signal_count(t); i++) {
        uint16_t instance;
        const struct exh_signal *row = exh_signal_at(t, i, &instance);
        if (!pc104_same_text(row->name, name)) { continue; }
        if (exh_params_stage(sc->params, row->id, instance, pc104_value_of(row, value)) < 0) {
            pc104_refuse_range(row, value);
        }
        found = 1; /* of every finger, material or whatever there are several of */
    }
    return found;
}

/* Before anything is timed: the parameters are part of what a tick costs. */
void pc104_scene_ready(const struct exh_scene *sc)
{
    exh_params_apply(sc->params);
}

/* Records of a dry tick, which come to nothing but time; every 64th with a keyframe. */
void pc104_scene_dry(const struct exh_scene *sc, uint32_t tick, const struct exh_scene_in *in,
                     const struct exh_drive_out *out)
{
    const uint32_t every = EXH_LOG_KEYFRAME_TICKS / 64u;
    if (pc104_par.log == PC104_LOG_OFF) { return; }
    dry = 1;
    if (tick == 0) {
        exh_log_start(sc, (struct exh_scene_board){{1, 1000}, exh_board_info.enc_bits});
    }
    exh_log_after(tick * every + every - 1, in, out);
    put = got = 0;
    dry = 0;
}

void pc104_scene_start(const struct exh_scene *sc, struct exh_scene_board board)
{
    started = pc104_par.log != PC104_LOG_OFF;
    if (started) { exh_log_start(sc, board); }
}

void pc104_scene_before(uint32_t tick, struct exh_scene_in *in)
{
    if (started) { exh_log_before(tick, in); }
}

void pc104_scene_after(uint32_t tick, const struct exh_scene_in *in,
                       const struct exh_drive_out *out)
{
    last_tick = tick;
    if (started) { exh_log_after(tick, in, out); }
}

void pc104_log_flush(void)
{
    uint32_t stuck = 0;
    while (put != got && stuck < STUCK_READS) {
        const uint32_t before = got;
        (void)(pc104_par.log == PC104_LOG_UDP ? idle_udp(1) : pc104_idle());
        stuck = before == got ? stuck + 1 : 0;
    }
    unsent += put - got;
    put = got;
}

void pc104_scene_end(void)
{
    uint32_t lost;
    if (!started) { return; }
    pc104_log_flush();
    lost = exh_log_end(last_tick + 1);
    pc104_log_flush();
    if (pc104_par.log == PC104_LOG_UDP) {
        for (unsigned i = 0; i < 3; i++) { (void)pc104_link_log(ring, 0, 2); } /* may be lost, too */
    }
    pc104_say("\nrecords lost ");
    pc104_say_u32(lost);
    if (unsent) {
        pc104_say(", bytes given up ");
        pc104_say_u32(unsent);
    }
    pc104_say("\n");
}
