/* hil: runs an unmodified PC/104 image in the loop, in virtual time. `hil --help`. */
#include "count.h"
#include "inputs.h"
#include "setup.h"
#include "where.h"
#include "world.h"

#include "cli/option.h"

#include "exhand/units.h"

#include <inttypes.h>
#include <stdlib.h>
#include <string.h>

/* Exit status: 0 ok, 1 a check failed, 2 bad usage, 3 a file or tool missing. */
enum { OK, FAILED, USAGE, MISSING };

/* Offsets in struct exh_scene (examples/scene.h) of a 32-bit image. */
enum { SCENE_FINGERS = 8, SCENE_LINK = 32, SCENE_TICK = 44 };
enum { LINK_IN = 8 };

static struct {
    const char *image, *options;
    int wild, quiet, singly, loop, absent;
    double cpi, port_us, hpet_MHz, baud;
    int64_t seed, where, ticks, rate_Hz, glove_age, monitor_age, late, spread_ppm, status;
} opt = {.options = "",
         .cpi = 2,
         .port_us = 1,
         .hpet_MHz = 14.31818,
         .baud = 115200,
         .seed = 1,
         .where = -1,
         .ticks = 1000,
         .spread_ppm = -1,
         .status = 0x10};

static struct run {
    struct hil h;
    struct box box;
    struct world world;
    struct count count;
    struct inputs inputs;
    struct ref_setting set[REF_SETTINGS];
    int sets;
    uint32_t scene, tick,
        back; /* addresses: descriptor, its tick function, where that returns to */
    uint32_t out; /* where its outputs go */
    uint64_t passed; /* instants of the timer since the first wait, */
    uint64_t instants, ticks; /* those up to the last tick of the scene; these ticks */
    uint32_t said_run, said_missed; /* ticks, as the image says at its end */
} run;

static void on_back(struct hil *h, uint32_t address)
{
    struct exh_drive_out out;
    (void)address;
    if (!run.count.ticking) { return; }
    if (run.out <= HIL_RAM_B - sizeof out) {
        memcpy(&out, &h->ram[run.out], sizeof out);
        run.count.key |= out.enable ? COUNT_RUNS : 0;
    }
    const uint32_t n = count_scene_end(&run.count, h);
    if (opt.where >= 0 && run.count.key == (unsigned)opt.where) { where_end(n); }
}

static unsigned class_of(const struct hil *h, const struct exh_scene_in *in)
{
    const uint32_t link = hil_word(h, run.scene + SCENE_LINK);
    const uint32_t mail = link ? hil_word(h, link + LINK_IN) : 0;
    return (in->glove_new ? COUNT_GLOVE : 0) |
           (mail && hil_word(h, mail) & 0xFF ? COUNT_PACKETS : 0);
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
    if (opt.wild) {
        inputs_next(&run.inputs, run.count.key & COUNT_RUNS, &in);
        memcpy(&h->ram[in_at], &in, sizeof in);
    }
    if (run.back == 0) {
        run.back = hil_word(h, sp);
        hil_watch_at(h, run.back, on_back);
    }
    count_scene(&run.count, h, class_of(h, &in));
    if (opt.where >= 0) { where_begin(); }
}

static void on_wait(struct hil *h)
{
    if (h->count_singly && h->singly != h->insns) {
        hil_broke(h, "%" PRIu64 " instructions by blocks, %" PRIu64 " one by one", h->insns,
                  h->singly);
    }
    count_wait(&run.count, h);
}

static void on_loop(struct hil *h, uint32_t address)
{
    (void)h;
    (void)address;
    world_waits(&run.world);
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

static void on_irq(struct hil *h)
{
    world_instant(&run.world);
    run.passed += h->waited != 0;
    if (h->idle) { count_tick(&run.count, h); }
}

static void on_line(struct hil *h, const char *text)
{
    unsigned long a, b;
    const char *period = strstr(text, "period ");
    (void)h;
    if (!opt.quiet) { printf("| %s\n", text); }
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
    static const struct exh_drive_in healthy = {.din = EXH_DIN_ESTOP | EXH_DIN_DEADMAN |
                                                       31u * EXH_DIN_DRIVE0};
    const struct emu_config cards = emu_box_config();
    const uint32_t fingers = hil_word(&run.h, run.scene + SCENE_FINGERS) & 0xFF;
    if (!opt.absent) {
        box_open(&run.box, fingers == 1, &cards);
        run.h.box = &run.box;
        if (!opt.loop) { box_put(&run.box, &healthy); }
    }
    if (!opt.loop) { return 0; }
    if (opt.absent ||
        setup_for(&run.world.ref_cfg, symbol, (uint64_t)opt.seed, (uint32_t)opt.ticks) < 0) {
        fprintf(stderr, "hil: --loop: not with %s\n", opt.absent ? "--absent" : symbol);
        return -1;
    }
    for (int i = 0; i < run.sets && run.world.ref_cfg.settings < REF_SETTINGS; i++) {
        run.world.ref_cfg.setting[run.world.ref_cfg.settings++] = run.set[i];
    }
    run.world.ref_cfg.monitor_age = (int)opt.monitor_age;
    run.world.ref_cfg.glove_age = (uint16_t)opt.glove_age;
    world_open(&run.world, &run.h, &run.box, run.scene);
    return 0;
}

static void open_chips(struct hil *h)
{
    h->cost = hil_cost_default;
    h->cost.insn_ps = (uint32_t)(opt.cpi / 1.6e9 * 1e12 + 0.5);
    h->cost.port_ps = (uint32_t)(opt.port_us * 1e6 + 0.5);
    h->count_singly = opt.singly;
    chips_open(&h->chips, opt.hpet_MHz > 0 ? (uint32_t)(1e9 / opt.hpet_MHz) : 0);
    h->chips.char_ps = opt.baud > 0 ? (uint64_t)(10e12 / opt.baud) : 0;
}

static void watch(struct hil *h, const char *symbol, hil_watch_fn *fn)
{
    const uint32_t address = hil_symbol(opt.image, symbol);
    if (address) { hil_watch_at(h, address, fn); }
}

static void open_hooks(struct hil *h)
{
    h->line = on_line;
    h->wait = on_wait;
    h->set = on_set;
    h->tick = on_irq;
    h->block_fn = opt.where >= 0 ? where_block : NULL;
    h->max_insns = UINT64_C(1) << 40;
    hil_watch_at(h, run.tick, on_tick);
    if (!opt.loop) { return; }
    watch(h, "exh_board_wait", on_loop);
    watch(h, "exh_loop", on_start);
    watch(h, "exh_board_link_recv", on_recv);
    watch(h, "exh_board_link_send", on_send);
}

static int take_setting(void *ctx, const char *text)
{
    static char name[REF_SETTINGS][32];
    struct ref_setting *s = run.set + run.sets;
    const char *equals = strchr(text, '=');
    char *end;
    (void)ctx;
    if (equals == NULL || run.sets == REF_SETTINGS || equals - text >= (long)sizeof name[0]) {
        cli_complain("--set: %s: give it as NAME=VALUE", text);
        return USAGE;
    }
    snprintf(name[run.sets], sizeof name[0], "%.*s", (int)(equals - text), text);
    s->name = name[run.sets++];
    s->value = strtod(equals + 1, &end);
    if (*end != 0 || end == equals + 1) {
        cli_complain("--set: %s: not a number", text);
        return USAGE;
    }
    return OK;
}

static int open_run(void)
{
    static char options[HIL_COMMAND_B];
    char symbol[64] = "exh_scene_*";
    struct hil *h = &run.h;
    open_chips(h);
    run.inputs.state = (uint64_t)opt.seed;
    if (hil_open(h, opt.image) < 0) { return -1; }
    run.scene = hil_symbol_name(opt.image, symbol, sizeof symbol);
    run.tick = run.scene ? hil_word(h, run.scene + SCENE_TICK) : 0;
    if (run.tick == 0) {
        fprintf(stderr, "hil: %s: no exh_scene_... in its symbol table\n", opt.image);
        return -1;
    }
    if (open_box(symbol) < 0) { return -1; }
    snprintf(options, sizeof options, "ticks=%u %s", (unsigned)opt.ticks, opt.options);
    if (opt.rate_Hz) {
        snprintf(options + strlen(options), sizeof options - strlen(options), " rate=%u",
                 (unsigned)opt.rate_Hz);
    }
    if (opt.loop) { ref_options(&run.world.ref_cfg, options, sizeof options); }
    hil_command(h, opt.image, options);
    open_hooks(h);
    return 0;
}

static int check(int good, const char *what)
{
    printf("  %-6s %s\n", good ? "ok" : "FAILED", what);
    return good ? OK : FAILED;
}

static int how_it_ended(const struct hil *h)
{
    switch (h->end) {
    case HIL_EXIT: printf("  it ended with status 0x%" PRIx32 "\n", h->status); break;
    case HIL_HUNG: printf("  it hangs\n"); break;
    case HIL_BROKEN: printf("  it broke: %s\n", h->why); break;
    case HIL_STOPPED:
    case HIL_RUNS: break;
    }
    return check(h->end == HIL_EXIT && h->status == (uint32_t)opt.status,
                 "the image ended as it should");
}

static int judge_loop(void)
{
    const struct world_result *r = &run.world.result;
    printf("  closed loop: %" PRIu64 " ticks compared, %" PRIu64 " with a drive on, %" PRIu64
           " pulling, %" PRIu64 " packets; digest pc104 %08" PRIx32 ", posix %08" PRIx32 "\n",
           r->ticks, r->running, r->pulling, r->packets, r->digest[0], r->digest[1]);
    if (r->differ) {
        printf("  %" PRIu64 " ticks differ; the first is %" PRIu64 ": %s\n", r->differ, r->first,
               r->what);
    }
    return check(r->ticks == run.ticks && r->ticks == (uint64_t)opt.ticks && r->differ == 0 &&
                     r->running > 0,
                 "every tick's outputs and signals are the POSIX port's");
}

static int judge(void)
{
    struct hil *h = &run.h;
    const double period_s = chips_period_s(&h->chips);
    int status = how_it_ended(h);
    const uint64_t missed = run.instants - run.ticks;
    printf("  period %.9f us: %" PRIu64 " instants, %" PRIu64 " ticks, %" PRIu64 " missed; %" PRIu64
           " instants found the image at work\n",
           period_s * 1e6, run.instants, run.ticks, missed, h->late);
    const uint32_t ppm = count_print(&run.count, h, period_s);
    status |= check(h->late == (uint64_t)opt.late,
                    "instants that found the image at work: as many as expected");
    status |= check(run.said_missed == missed && run.said_run == run.ticks,
                    "the image counted the same ticks");
    if (opt.loop && !opt.wild) { status |= judge_loop(); }
    if (opt.spread_ppm >= 0) {
        status |= check(ppm <= (uint64_t)opt.spread_ppm, "spread of the scene's part");
    }
    if (run.count.no_memory) { status |= check(0, "memory for the figures"); }
    return status;
}

int main(int argc, char **argv)
{
    const struct cli_call setting = {take_setting, NULL};
    union { /* an option's place to write to is not const; this one is only called */
        const struct cli_call *call;
        void *to;
    } set = {&setting};
    const struct cli_option option[] = {
        {"ticks", CLI_INT, &opt.ticks, 1, 1e9, "N", "to be run (1000)"},
        {"rate", CLI_INT, &opt.rate_Hz, 0, 20000, "HZ", "of the loop; 0: the scene's (0)"},
        {"loop", CLI_FLAG, &opt.loop, 0, 0, NULL,
         "closed: cards wired to the simulated device, POSIX port beside it"},
        {"set", CLI_CALL, set.to, 0, 0, "NAME=VALUE",
         "a parameter of the scene, with --loop, on both sides"},
        {"absent", CLI_FLAG, &opt.absent, 0, 0, NULL, "no cards"},
        {"glove-age", CLI_INT, &opt.glove_age, 0, 1000, "TICKS",
         "of a glove frame as the cards hand it over (0)"},
        {"monitor-age", CLI_INT, &opt.monitor_age, 0, 1, "TICKS",
         "of current monitors, likewise (0)"},
        {"wild", CLI_FLAG, &opt.wild, 0, 0, NULL,
         "random and extreme inputs in place of the board's"},
        {"seed", CLI_INT, &opt.seed, 0, 1e15, "N", "of what is random (1)"},
        {"cpi", CLI_REAL, &opt.cpi, 0.1, 1000, "N", "cycles an instruction, of 1.6 GHz (2)"},
        {"port-us", CLI_REAL, &opt.port_us, 0, 1000, "US", "an access to a port (1)"},
        {"hpet", CLI_REAL, &opt.hpet_MHz, 0, 1000, "MHZ",
         "counter of the HPET; 0: there is none (14.31818)"},
        {"baud", CLI_REAL, &opt.baud, 0, 1e9, "N",
         "of COM1; 0: it takes characters at once (115200)"},
        {"late", CLI_INT, &opt.late, 0, 1e9, "N", "ticks that must be missed (0)"},
        {"spread", CLI_INT, &opt.spread_ppm, 0, 1e6, "PPM",
         "most that a class of ticks may vary in the scene"},
        {"status", CLI_INT, &opt.status, 0, 255, "N",
         "what the image must write to its exit port (16)"},
        {"singly", CLI_FLAG, &opt.singly, 0, 0, NULL,
         "count instructions one by one too, and compare: slow"},
        {"where", CLI_INT, &opt.where, 0, COUNT_KEYS - 1, "CLASS",
         "of ticks: blocks in which the cheapest and the dearest tick differ"},
        {"quiet", CLI_FLAG, &opt.quiet, 0, 0, NULL, "without what the image says"},
        {"options", CLI_TEXT, &opt.options, 0, 0, "TEXT", "the image's command line"},
    };
    const struct cli_command c = {"",
                                  "[options] IMAGE",
                                  "Runs a PC/104 image in the loop, in virtual time.",
                                  option,
                                  sizeof option / sizeof option[0],
                                  1};
    cli_program = "hil";
    int err = cli_parse(&c, argc, argv, &opt.image);
    if (err) { return err == 1 ? cli_finish(OK) : USAGE; }
    if (open_run() < 0) {
        hil_close(&run.h);
        return MISSING;
    }
    hil_run(&run.h);
    world_close(&run.world);
    err = judge();
    if (opt.where >= 0) { where_print(); }
    hil_close(&run.h);
    count_free(&run.count);
    return cli_finish(err);
}
