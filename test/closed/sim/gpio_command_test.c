/* SPDX-License-Identifier: MIT */
/* --gpio on the command line: errors that are refused before any line is requested. Tests are
 * linked without libgpiod on any machine. */
#include "said.h"
#include "lab/lab.h"

#define LINES "gpiochip0:estop=4,enable=6"

static const char *dir;
static struct said s;

static void refused_by(
    int (*command)(int, char **), int status, const char *says, const char *const *word)
{
    said(&s, dir, command, word);
    CHECK(s.status == status && strstr(s.err, says) != NULL, "status %d, want %d and %s: %s",
        s.status, status, says, s.err);
    CHECK(s.out[0] == '\0', "it ran: %s", s.out);
}

static void refused(int status, const char *says, const char *const *word)
{
    refused_by(cli_drop, status, says, word);
}

TEST(refusals)
{
    dir = said_dir();
    refused(2, "--gpio: without --pace", WORDS("drop", "--rate", "200", "--gpio", LINES));
    refused(2, "--gpio: one rate and one run", WORDS("drop", "--pace", "--gpio", LINES));
    refused(2, "--gpio: one rate and one run",
        WORDS("drop", "--rate", "200", "--pace", "--runs", "2", "--gpio", LINES));
    refused_by(lab_drop, 2, "--gpio: one rate and one run",
        WORDS("drop", "--rate", "200", "--pace", "--sweep", "--gpio", LINES));
    refused(2, "--gpio: given twice",
        WORDS("drop", "--rate", "200", "--pace", "--gpio", LINES, "--gpio", LINES));
    refused(
        2, "--gpio: estopp=4: there are", WORDS("drop", "--pace", "--gpio", "gpiochip0:estopp=4"));
    refused(3, "--gpio: this program was built without libgpiod: install libgpiod-dev",
        WORDS("drop", "--rate", "200", "--pace", "--gpio", LINES));
    said_clean(dir);
}

TEST_MAIN("gpio-command", refusals);
