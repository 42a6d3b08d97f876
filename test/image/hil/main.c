/* SPDX-License-Identifier: MIT */
/* hil: runs an unmodified PC/104 image in the loop, in virtual time. `hil --help`. */
#include "run.h"
#include "where.h"

#include "base/option.h"

#include <inttypes.h>
#include <stdlib.h>
#include <string.h>

/* Exit status: 0 ok, 1 a check failed, 2 bad usage, 3 a file or tool missing. */
enum { OK, FAILED, USAGE, MISSING };

static struct run_options opt = {.options = "",
    .cpi = 2,
    .port_us = 1,
    .hpet_MHz = 14.31818,
    .baud = 115200,
    .seed = 1,
    .where = -1,
    .ticks = 1000,
    .spoil = -1};
static int64_t late, status = 0x10, spread_ppm = -1, most = -1;

static int take_setting(void *ctx, const char *text)
{
    static char name[REF_SETTINGS][32];
    struct ref_setting *s = opt.set + opt.sets;
    const char *equals = strchr(text, '=');
    char *end;
    (void)ctx;
    if (equals == NULL || opt.sets == REF_SETTINGS || equals - text >= (long)sizeof name[0]) {
        cli_complain("--set: %s: give it as NAME=VALUE", text);
        return USAGE;
    }
    snprintf(name[opt.sets], sizeof name[0], "%.*s", (int)(equals - text), text);
    s->name = name[opt.sets++];
    s->value = strtod(equals + 1, &end);
    if (*end != 0 || end == equals + 1) {
        cli_complain("--set: %s: not a number", text);
        return USAGE;
    }
    return OK;
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
    case HIL_RUNS: break;
    }
    return check(
        h->end == HIL_EXIT && h->status == (uint32_t)status, "the image ended as it should");
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

/* An image that calls the board itself ends with current on: none may be left. */
static int judge_board(void)
{
    struct exh_drive_out out;
    int zero = 1;
    box_get(&run.box, &out);
    for (unsigned i = 0; i < EXH_FINGERS; i++) { zero &= out.dac_raw[i] == 32768; }
    return how_it_ended(&run.h) |
           check(zero && out.enable == 0, "outputs at the end: zero, drives off");
}

static int judge(void)
{
    struct hil *h = &run.h;
    const double period_s = chips_period_s(&h->chips);
    int bad = how_it_ended(h);
    const uint64_t missed = run.instants - run.ticks;
    if (run.scene == 0) { return bad; } /* a separate test: it prints its own result */
    printf("  period %.9f us: %" PRIu64 " instants, %" PRIu64 " ticks, %" PRIu64 " missed; %" PRIu64
           " instants found the image at work\n",
        period_s * 1e6, run.instants, run.ticks, missed, run.late);
    const uint32_t ppm = count_print(&run.count, h, period_s);
    bad |= check(
        run.late == (uint64_t)late, "instants that found the image at work: as many as expected");
    bad |= check(
        run.said_missed == missed && run.said_run == run.ticks, "the image counted the same ticks");
    if (opt.loop && !opt.wild) { bad |= judge_loop(); }
    if (spread_ppm >= 0) {
        bad |= check(ppm <= (uint64_t)spread_ppm, "spread of the scene's part");
    }
    if (most >= 0) {
        bad |= check(count_range(&run.count.insns).max <= (uint64_t)most,
            "instructions of the dearest tick");
    }
    if (run.count.no_memory) { bad |= check(0, "memory for the figures"); }
    return bad;
}

int main(int argc, char **argv)
{
    struct cli_call setting = {take_setting, NULL};
    /* an option's place to write to is not const; this one is only called */
    const struct cli_option option[] = {
        {"ticks", CLI_INT, &opt.ticks, 1, 1e9, "N", "to be run (1000)"},
        {"rate", CLI_INT, &opt.rate_Hz, 0, 20000, "HZ", "of the loop; 0: the scene's (0)"},
        {"loop", CLI_FLAG, &opt.loop, 0, 0, NULL,
            "closed: cards wired to the simulated device, POSIX port beside it"},
        {"set", CLI_CALL, &setting, 0, 0, "NAME=VALUE",
            "a parameter of the scene, with --loop, on both sides"},
        {"absent", CLI_FLAG, &opt.absent, 0, 0, NULL, "no cards"},
        {"board", CLI_FLAG, &opt.board, 0, 0, NULL,
            "the image calls the board itself (test/port): monitors follow the outputs"},
        {"glove-age", CLI_INT, &opt.glove_age, 0, 1000, "TICKS",
            "of a glove frame as the cards hand it over (0)"},
        {"monitor-age", CLI_INT, &opt.monitor_age, 0, 1, "TICKS",
            "of current monitors, likewise (0)"},
        {"turns", CLI_FLAG, &opt.turns, 0, 0, NULL,
            "monitors of the tick before, one a board, in turn"},
        {"glove-last", CLI_FLAG, &opt.glove_last, 0, 0, NULL,
            "a glove scan is begun when the one before is handed over"},
        {"wild", CLI_FLAG, &opt.wild, 0, 0, NULL,
            "random and extreme inputs in place of the board's"},
        {"seed", CLI_INT, &opt.seed, 0, 1e15, "N", "of what is random (1)"},
        {"cpi", CLI_REAL, &opt.cpi, 0.1, 1000, "N", "cycles an instruction, of 1.6 GHz (2)"},
        {"port-us", CLI_REAL, &opt.port_us, 0, 1000, "US", "an access to a port (1)"},
        {"hpet", CLI_REAL, &opt.hpet_MHz, 0, 1000, "MHZ",
            "counter of the HPET; 0: there is none (14.31818)"},
        {"baud", CLI_REAL, &opt.baud, 0, 1e9, "N",
            "of COM1; 0: it takes characters at once (115200)"},
        {"late", CLI_INT, &late, 0, 1e9, "N", "ticks that must be missed (0)"},
        {"spread", CLI_INT, &spread_ppm, 0, 1e6, "PPM",
            "most that a class of ticks may vary in the scene"},
        {"status", CLI_INT, &status, 0, 255, "N",
            "what the image must write to its exit port (16)"},
        {"singly", CLI_FLAG, &opt.singly, 0, 0, NULL,
            "count instructions one by one too, and compare: slow"},
        {"where", CLI_INT, &opt.where, 0, COUNT_KEYS - 1, "CLASS",
            "of ticks: blocks in which the cheapest and the dearest tick differ"},
        {"whole", CLI_FLAG, &opt.whole, 0, 0, NULL,
            "blocks of the image's cheapest and dearest tick, all of them"},
        {"most", CLI_INT, &most, 0, 1e9, "N", "most instructions of a tick (any)"},
        {"records", CLI_TEXT, &opt.records, 0, 0, "FILE", "what the image puts out with log=debug"},
        {"spoil", CLI_INT, &opt.spoil, -1, 1e9, "TICK",
            "one encoder reads a count more in it: must be found"},
        {"quiet", CLI_FLAG, &opt.quiet, 0, 0, NULL, "without what the image says"},
        {"options", CLI_TEXT, &opt.options, 0, 0, "TEXT", "the image's command line"},
    };
    const struct cli_command c = {"", "[options] IMAGE",
        "Runs a PC/104 image in the loop, in virtual time.", option,
        sizeof option / sizeof option[0], 1};
    cli_program = "hil";
    int err = cli_parse(&c, argc, argv, &opt.image);
    if (err) { return err == 1 ? cli_finish(OK) : USAGE; }
    if (run_open(&opt) < 0) {
        run_close();
        return MISSING;
    }
    hil_run(&run.h);
    world_close(&run.world);
    err = opt.board ? judge_board() : judge();
    if (opt.where >= 0 || opt.whole) { where_print(opt.whole); }
    run_close();
    return cli_finish(err);
}
