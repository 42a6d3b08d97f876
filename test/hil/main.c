/* hil: runs an unmodified PC/104 image in the loop, in virtual time. `hil --help`. */
#include "count.h"
#include "inputs.h"
#include "world.h"

#include "cli/option.h"

#include "exhand/units.h"

#include <inttypes.h>
#include <string.h>

/* Exit status: 0 ok, 1 a check failed, 2 bad usage, 3 a file or tool missing. */
enum { OK, FAILED, USAGE, MISSING };

/* Offsets in struct exh_scene (examples/scene.h) of a 32-bit image. */
enum { SCENE_LINK = 32, SCENE_TICK = 44 };
enum { LINK_IN = 8 };

static struct {
    const char *image, *options;
    int wild, quiet, singly;
    double cpi, port_us, hpet_MHz, baud;
    int64_t seed, late, spread_ppm, status;
} opt = {.options = "",
         .cpi = 2,
         .port_us = 1,
         .hpet_MHz = 14.31818,
         .baud = 115200,
         .seed = 1,
         .spread_ppm = -1,
         .status = 0x10};

static struct run {
    struct hil h;
    struct count count;
    struct inputs inputs;
    uint32_t scene, tick,
        back; /* addresses: descriptor, its tick function, where that returns to */
    uint32_t period_num, period_den;
    uint64_t passed; /* instants of the timer since the first wait, */
    uint64_t instants, ticks; /* those up to the last tick of the scene; these ticks */
    uint32_t said_run, said_missed; /* ticks, as the image says at its end */
} run;

static void on_back(struct hil *h, uint32_t address)
{
    (void)address;
    if (run.count.ticking) { count_scene_end(&run.count, h); }
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
    if (in_at > HIL_RAM_B - sizeof in) {
        hil_broke(h, "the scene's input is at 0x%lx", (unsigned long)in_at);
        return;
    }
    memcpy(&in, &h->ram[in_at], sizeof in);
    if (opt.wild) {
        inputs_next(&run.inputs, &in);
        memcpy(&h->ram[in_at], &in, sizeof in);
    }
    if (run.back == 0) {
        run.back = hil_word(h, sp);
        hil_watch_at(h, run.back, on_back);
    }
    count_scene(&run.count, h, class_of(h, &in));
}

static void on_wait(struct hil *h)
{
    if (h->count_singly && h->singly != h->insns) {
        hil_broke(h, "%" PRIu64 " instructions by blocks, %" PRIu64 " one by one", h->insns,
                  h->singly);
    }
    count_wait(&run.count, h);
}

static void on_irq(struct hil *h)
{
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
        run.period_num = (uint32_t)a;
        run.period_den = (uint32_t)b;
    }
    if (sscanf(text, "ticks %lu run, %lu missed", &a, &b) == 2) {
        run.said_run = (uint32_t)a;
        run.said_missed = (uint32_t)b;
    }
}

static int open_run(void)
{
    struct hil *h = &run.h;
    h->cost = hil_cost_default;
    h->cost.insn_ps = (uint32_t)(opt.cpi / 1.6e9 * 1e12 + 0.5);
    h->cost.port_ps = (uint32_t)(opt.port_us * 1e6 + 0.5);
    chips_open(&h->chips, opt.hpet_MHz > 0 ? (uint32_t)(1e9 / opt.hpet_MHz) : 0);
    h->chips.char_ps = opt.baud > 0 ? (uint64_t)(10e12 / opt.baud) : 0;
    h->line = on_line;
    h->wait = on_wait;
    h->tick = on_irq;
    h->count_singly = opt.singly;
    h->max_insns = UINT64_C(1) << 40;
    run.inputs.state = (uint64_t)opt.seed;
    if (hil_open(h, opt.image, opt.options) < 0) { return -1; }
    run.scene = hil_symbol(opt.image, "exh_scene_*");
    run.tick = run.scene ? hil_word(h, run.scene + SCENE_TICK) : 0;
    if (run.tick == 0) {
        fprintf(stderr, "hil: %s: no exh_scene_... in its symbol table\n", opt.image);
        return -1;
    }
    hil_watch_at(h, run.tick, on_tick);
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
    if (opt.spread_ppm >= 0) {
        status |= check(ppm <= (uint64_t)opt.spread_ppm, "spread of the scene's part");
    }
    if (run.count.no_memory) { status |= check(0, "memory for the figures"); }
    return status;
}

int main(int argc, char **argv)
{
    const struct cli_option option[] = {
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
    err = judge();
    hil_close(&run.h);
    count_free(&run.count);
    return cli_finish(err);
}
