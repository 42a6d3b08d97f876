/* SPDX-License-Identifier: MIT */
/* exhand glove: what its modes share. */
#include "glove/modes.h"

#include "box/glove_image.h"

#include <signal.h>

int glove_load_calibration(const char *path)
{
    static struct exh_glove_cal cal;
    const int err = glove_image_read(&cal, "calibration", path);
    return err ? err : glove_stage_cal(&cal, NULL) < 0 ? 2 : 0; /* one that was read is taken */
}

static void interrupted(int sig)
{
    (void)sig;
    posix_interrupt();
}

void glove_catch(void)
{
    signal(SIGINT, interrupted);
    signal(SIGTERM, interrupted);
}
