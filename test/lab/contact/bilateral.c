/* SPDX-License-Identifier: MIT */
/* exhand-lab bilateral: the paper's second experiment as it is studied. */
#include "lab/contact/studies.h"
#include "lab/drop/preset.h"
#include "lab/lab.h"

#include <string.h>

static struct {
    int64_t check, contacts, remedies, jobs;
    int sweep, hands, crisp;
    const char *preset, *networks;
} is;

static int studies(void)
{
    return is.sweep + (is.check > 0) + is.hands + is.crisp + (is.remedies >= 0) + (is.contacts > 0);
}

/* What says otherwise how the two are to be. */
static int take_preset(const struct bilateral_options *o, double rate_Hz)
{
    int err = is.preset ? original_take(is.preset) : 0;
    if (is.preset == NULL || err) { return err; }
    if (rate_Hz != ORIGINAL_BOX_HZ || o->run.k_Npm >= 0 || o->run.b_Nspm >= 0 || o->scene ||
        o->record || o->udp || o->params.load || o->params.save || o->run.trace_every ||
        o->run.blackbox || studies() > 0 || 2 * o->speeds > ORIGINAL_COLUMNS) {
        cli_complain("--preset: goes with up to three --speed, --fingers, --approaches, --at, "
                     "--pose, --link, --fps, --set, --device, "
                     "--calibration, --cards, --seed and --out alone");
        err = 2;
    }
    return err;
}

static int refuse(struct bilateral_options *o, double rate_Hz)
{
    const int err = take_preset(o, rate_Hz);
    o->study = studies() > 0;
    o->jobs = is.jobs;
    if (err == 0 && studies() > 1) {
        cli_complain("--sweep, --check, --hands, --crisp, --remedies, --contacts: one at a "
                     "time");
        return 2;
    }
    if (err == 0 && is.networks && (!is.contacts || !*is.networks)) {
        cli_complain(
            "--networks: %s: give --contacts SEEDS and one recorded network at least", is.networks);
        return 2;
    }
    return err;
}

static int run(const struct bilateral_options *o)
{
    return is.contacts        ? bilateral_contacts(o, is.contacts, is.networks)
           : is.sweep         ? bilateral_sweep(o)
           : is.check         ? bilateral_check(o, is.check)
           : is.hands         ? bilateral_hands(o)
           : is.crisp         ? bilateral_crisp(o)
           : is.remedies >= 0 ? bilateral_remedies(o, is.remedies)
           : is.preset        ? bilateral_original(o)
                              : bilateral_experiment(o);
}

int lab_bilateral(int argc, char **argv)
{
    const struct cli_option option[] = {
        {"preset", CLI_TEXT, &is.preset, 0, 0, "NAME",
            "original: the commercial system at 90 Hz, beside this box at 2 kHz"},
        {"sweep", CLI_FLAG, &is.sweep, 0, 0, NULL,
            "stiffness and missed contacts over delay, jitter and loss"},
        {"check", CLI_INT, &is.check, 1, 1e6, "N",
            "random approaches: none may be felt before its freeze"},
        {"hands", CLI_FLAG, &is.hands, 0, 0, NULL,
            "80 fingers and hands: settling and stiffness of each"},
        {"crisp", CLI_FLAG, &is.crisp, 0, 0, NULL, "how fast force rises, over a grid of k and b"},
        {"remedies", CLI_INT, &is.remedies, 0, 100, "N",
            "what makes a contact settle and be silent: 0 all, over the 80 hands; the Nth by one"},
        {"contacts", CLI_INT, &is.contacts, 1, 1000, "SEEDS",
            "every scene, finger, speed and link: none may be missed"},
        {"networks", CLI_TEXT, &is.networks, 0, 0, "FILE[,FILE...]",
            "of --contacts: recorded ones besides"},
        {"jobs", CLI_INT, &is.jobs, 1, 1024, "N",
            "processes at a time, of all but the experiment (one a core)"},
    };
    const struct bilateral_study study = {
        {option, (int)(sizeof option / sizeof option[0]), NULL}, refuse, run};
    memset(&is, 0, sizeof is);
    is.jobs = jobs_cores();
    is.remedies = -1;
    return bilateral_command(argc, argv, &study);
}
