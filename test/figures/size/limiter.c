/* SPDX-License-Identifier: MIT */
/* The smallest caller of a limiter, for its size. Its set-up and its inputs are data of the
 * caller. */
#include "exhand_limiter.h"

extern struct exh_limiter_par drive_par;
extern struct exh_limiter_in drive_in;
extern struct exh_limiter_out drive_out;
struct exh_limiter_par drive_par;
struct exh_limiter_in drive_in;
struct exh_limiter_out drive_out;

void exh_assert_failed(const char *file, int line)
{
    (void)file;
    (void)line;
    for (;;) {}
}

int main(void)
{
    static struct exh_limiter_cfg cfg;
    static struct exh_limiter s;
    if (exh_limiter_setup(&cfg, &drive_par) != 0) { return 1; }
    for (;;) { exh_limiter_step(&s, &cfg, &drive_in, &drive_out); }
}
