/* SPDX-License-Identifier: MIT */
#include "run.h"

#include "setup.h"
#include "where.h"

#include <inttypes.h>
#include <string.h>

/* Offsets in struct exh_scene (lib/include/exhand/run/scene.h) of a 32-bit image. */
enum { SCENE_FINGERS = 8, SCENE_TICK = 44, SCENE_SHOW = 48 };

struct run run;

/* --- callbacks of the machine --- */

static void on_back(struct hil *h, uint32_t address)
{
    struct exh_drive_out out;
    (void)address;
    if (!run.count.ticking) { return; }
    /* A tick does not fill in signals: the function at `show` does. */
    run.shown = !run.shown;
    if (run.shown && run.show) {
        hil_call(h, run.show);
        return;
    }
    run.shown = 0;
    if (run.out > HIL_RAM_B - sizeof out) {
        hil_broke(h, "the scene's output is at 0x%lx", (unsigned long)run.out);
        return;
    }
    memcpy(&out, &h->ram[run.out], sizeof out);
    run.runs = out.enable != 0;
    run.key = class_out(&run.class_of, h, &out, run.key);
    const uint32_t n = count_scene_end(&run.count, h, run.key);
    if (!run.opt->whole && run.key == (unsigned)run.opt->where) { where_end(n); }
}

/* The scene's tick is called: tick(in, out). */
static void on_tick(struct hil *h, uint32_t address)
{
    const uint32_t sp = hil_reg(h, UC_X86_REG_ESP);
    const uint32_t in_at = hil_word(h, sp + 4);
    struct exh_scene_in in;
    (void)address;
    if (!run.count.ticking) { return; } /* a rehearsal */
    run.ticks++;
    run.instants = run.passed;
    run.out = hil_word(h, sp + 8);
    if (in_at > HIL_RAM_B - sizeof in) {
        hil_broke(h, "the scene's input is at 0x%lx", (unsigned long)in_at);
        return;
    }
    memcpy(&in, &h->ram[in_at], sizeof in);
    if (run.opt->wild) {
        run.inputs.torn = run.ticks > (uint64_t)run.opt->ticks / 4 * 3;
        inputs_next(&run.inputs, run.runs, &in);
        memcpy(&h->ram[in_at], &in, sizeof in);
    }
    if (run.back == 0) {
        run.back = hil_word(h, sp);
        hil_watch_at(h, run.back, on_back);
    }
    run.key = class_in(&run.class_of, h, &in) | (run.ticks == 1 ? COUNT_FIRST : 0);
    count_scene(&run.count, h);
    if (run.opt->where >= 0 && !run.opt->whole) { where_begin(); }
}

static void on_wait(struct hil *h)
{
    if (h->count_singly && h->singly != h->insns) {
        hil_broke(
            h, "%" PRIu64 " instructions by blocks, %" PRIu64 " one by one", h->insns, h->singly);
    }
    if (run.opt->whole) { where_end((uint32_t)(h->insns - run.count.at_insns)); }
    count_wait(&run.count, h);
}

/* What a tick had to do is done. What finds the image at work from here on, if it was the last, is
 * no tick's. */
static void on_loop(struct hil *h, uint32_t address)
{
    (void)address;
    run.late = h->late;
    if (run.opt->loop) { world_waits(&run.world); }
}

static void on_start(struct hil *h, uint32_t address)
{
    (void)h;
    (void)address;
    world_parameters(&run.world);
}

static void on_recv(struct hil *h, uint32_t address)
{
    (void)h;
    (void)address;
    world_recv(&run.world);
}

static void on_send(struct hil *h, uint32_t address)
{
    (void)h;
    (void)address;
    world_send(&run.world);
}

static void on_set(struct hil *h)
{
    (void)h;
    world_rewind(&run.world);
}

static const struct exh_drive_in healthy = {.din = EXH_DIN_ESTOP | EXH_DIN_DEADMAN |
                                                   EXH_DIN_WATCHDOG | EXH_DIN_CARDS |
                                                   31u * EXH_DIN_DRIVE0};

/* Monitors show what the outputs ask for: 1.76 A/V over 3249 codes/V, 0.591 V/A over 305 uV. */
static void loop_back(void)
{
    struct exh_drive_in in = healthy;
    struct exh_drive_out out;
    box_get(&run.box, &out);
    for (unsigned i = 0; i < EXH_FINGERS; i++) {
        in.mon_raw[i] = (int16_t)(out.enable >> i & 1 ? (out.dac_raw[i] - 32768) * 67 / 64 : 0);
    }
    box_put(&run.box, &in);
}

static void on_irq(struct hil *h)
{
    if (run.opt->board) { loop_back(); }
    world_instant(&run.world);
    run.passed += h->waited != 0;
    if (!h->idle) { return; }
    count_tick(&run.count, h);
    if (run.opt->whole) { where_begin(); }
}

static void on_line(struct hil *h, const char *text)
{
    unsigned long a, b;
    const char *period = strstr(text, "period ");
    (void)h;
    if (!run.opt->quiet) { printf("| %s\n", text); }
    if (period && sscanf(period, "period %lu/%lu s", &a, &b) == 2) {
        run.world.ref_cfg.board.T = (struct exh_period){(uint32_t)a, (uint32_t)b};
    }
    if (sscanf(text, "ticks %lu run, %lu missed", &a, &b) == 2) {
        run.said_run = (uint32_t)a;
        run.said_missed = (uint32_t)b;
    }
}

/* The cards, and what is around them: a device, or constants that let a scene run. */
static int open_box(const char *symbol)
{
    struct emu_config cards = emu_box_config();
    const uint32_t fingers = run.scene ? hil_word(&run.h, run.scene + SCENE_FINGERS) & 0xFF : 0;
    cards.s526[1].present = fingers != 1; /* a box of one finger has A alone */
    if (!run.opt->absent) {
        box_open(&run.box, fingers == 1, &cards);
        run.h.box = &run.box;
        if (!run.opt->loop) { box_put(&run.box, &healthy); }
    }
    if (!run.opt->loop) { return 0; }
    if (run.opt->absent || setup_for(&run.world.ref_cfg, symbol, (uint64_t)run.opt->seed,
                               (uint32_t)run.opt->ticks) < 0) {
        fprintf(stderr, "hil: --loop: not with %s\n", run.opt->absent ? "--absent" : symbol);
        return -1;
    }
    for (int i = 0; i < run.opt->sets && run.world.ref_cfg.settings < REF_SETTINGS; i++) {
        run.world.ref_cfg.setting[run.world.ref_cfg.settings++] = run.opt->set[i];
    }
    run.world.ref_cfg.monitor_age = (int)run.opt->monitor_age;
    run.world.spoil = run.opt->spoil;
    run.world.ref_cfg.turns = run.opt->turns;
    run.world.ref_cfg.glove_last = run.opt->glove_last;
    run.box.glove_starts = run.opt->glove_last;
    run.world.ref_cfg.glove_age = (uint16_t)run.opt->glove_age;
    world_open(&run.world, &run.h, &run.box, run.scene);
    return 0;
}

static void open_chips(struct hil *h)
{
    h->cost = hil_cost_default;
    h->cost.insn_ps = (uint32_t)(run.opt->cpi / 1.6e9 * 1e12 + 0.5);
    h->cost.port_ps = (uint32_t)(run.opt->port_us * 1e6 + 0.5);
    h->count_singly = run.opt->singly;
    chips_open(&h->chips, run.opt->hpet_MHz > 0 ? (uint32_t)(1e9 / run.opt->hpet_MHz) : 0);
    h->chips.char_ps = run.opt->baud > 0 ? (uint64_t)(10e12 / run.opt->baud) : 0;
}

static void watch(struct hil *h, const char *symbol, hil_watch_fn *fn)
{
    const uint32_t address = hil_symbol(run.opt->image, symbol);
    if (address) { hil_watch_at(h, address, fn); }
}

static void open_hooks(struct hil *h)
{
    h->line = on_line;
    h->wait = on_wait;
    h->set = on_set;
    h->tick = on_irq;
    h->block_fn = run.opt->where >= 0 || run.opt->whole ? where_block : NULL;
    h->max_insns = UINT64_C(1) << 40;
    if (run.tick) { hil_watch_at(h, run.tick, on_tick); }
    watch(h, "exh_board_wait", on_loop);
    if (!run.opt->loop) { return; }
    watch(h, "exh_loop", on_start);
    watch(h, "exh_board_link_recv", on_recv);
    watch(h, "exh_board_link_send", on_send);
}

/* An image without a scene, a test, gets what it was given alone. */
static void command_line(char *text, size_t cap_B)
{
    char ticks[32] = "", rate[32] = "";
    if (run.scene) { snprintf(ticks, sizeof ticks, " ticks=%u", (unsigned)run.opt->ticks); }
    if (run.opt->rate_Hz) { snprintf(rate, sizeof rate, " rate=%u", (unsigned)run.opt->rate_Hz); }
    snprintf(text, cap_B, "%s%s%s", run.opt->options, ticks, rate);
    if (run.opt->loop) { ref_options(&run.world.ref_cfg, text, cap_B); }
}

int run_open(const struct run_options *opt)
{
    static char options[HIL_COMMAND_B];
    char symbol[64] = "exh_scene_*";
    struct hil *h = &run.h;
    run.opt = opt;
    open_chips(h);
    run.inputs.state = (uint64_t)run.opt->seed;
    if (hil_open(h, run.opt->image) < 0) { return -1; }
    run.scene = hil_symbol_name(run.opt->image, symbol, sizeof symbol);
    run.tick = run.scene ? hil_word(h, run.scene + SCENE_TICK) : 0;
    run.show = run.scene ? hil_word(h, run.scene + SCENE_SHOW) : 0;
    if (run.scene == 0 && (run.opt->loop || run.opt->wild)) {
        fprintf(stderr, "hil: %s: no exh_scene_... in its symbol table\n", run.opt->image);
        return -1;
    }
    if (open_box(symbol) < 0) { return -1; }
    run.class_of.scene = run.scene;
    run.class_of.twin = run.world.ref_cfg.scene;
    command_line(options, sizeof options);
    hil_command(h, run.opt->image, options);
    open_hooks(h);
    if (run.opt->records) { h->records = fopen(run.opt->records, "wb"); }
    if (run.opt->records && h->records == NULL) {
        fprintf(stderr, "hil: %s: cannot be written\n", run.opt->records);
        return -1;
    }
    return 0;
}

void run_close(void)
{
    if (run.h.records) { fclose(run.h.records); }
    hil_close(&run.h);
    count_free(&run.count);
}
