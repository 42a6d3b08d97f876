/* SPDX-License-Identifier: MIT */
/* A run for a person: what the image says, and how it did. */
#include "show.h"

#include "loop.h"

#include <ctype.h>

#define CORE_HZ 168000000u

/* Up to the log's first record: it comes over the same line. */
void show_words(const char *image)
{
    const char *at = loop.text, *end = at;
    printf("%s, unmodified, in emulation. Never run on hardware.\n\nIt says:\n", image);
    while (isprint((unsigned char)*end)) { end++; }
    while (*end == '\n') {
        printf("  %.*s\n", (int)(end - at), at);
        at = ++end;
        while (isprint((unsigned char)*end)) { end++; }
    }
    fflush(stdout);
}

static const char *hand(void)
{
    return loop.cfg.board.exo.fingers ? "five fingers of a simulated hand press against walls"
                                      : "a simulated mass falls against a wall, again and again";
}

void show_run(int bad, uint32_t most_of_99)
{
    const struct loop_result *r = &loop.r;
    const double n = r->ticks > 1 ? (double)(r->ticks - 1) : 1, mean = (double)r->cycles / n;
    const double Hz = (double)loop.T.den / (double)loop.T.num, period = CORE_HZ / Hz;
    printf("\nClosed loop: %s.\n", hand());
    printf("  ticks          %lu at %.0f Hz, %lu missed\n", (unsigned long)r->ticks, Hz,
        (unsigned long)r->missed);
    printf("  drives on      in %lu ticks, with a current in %lu\n", (unsigned long)r->running,
        (unsigned long)r->pulling);
    if (loop.cfg.scene->link) {
        printf("  link           %lu packets, both ways\n", (unsigned long)r->packets);
    }
    printf("  a tick takes   %.0f cycles of %.0f (%.1f %%); 99 of 100 at most %u, the dearest %u\n",
        mean, period, 100 * mean / period, most_of_99, r->most_cycles);
    printf("  bus accesses   %.0f a tick, %u in the dearest\n", (double)r->accesses / n,
        r->most_accesses);
    printf("  outputs        %s\n",
        bad ? "NOT those of this host:" : "in each tick bit for bit those of this host");
}
