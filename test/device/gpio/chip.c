/* SPDX-License-Identifier: MIT */
#include "chip.h"

#include <errno.h>
#include <string.h>
#include <unistd.h>

struct chip chip;

void chip_reset(void)
{
    memset(&chip, 0, sizeof chip);
    chip.flips = chip.first_low = chip.put_fd = -1;
}

static int fails(int error)
{
    errno = error;
    return error ? -1 : 0;
}

int chip_open(const char *path)
{
    if (strcmp(path, CHIP_PATH) != 0) { return fails(ENOENT); }
    if (chip.open_error) { return fails(chip.open_error); }
    chip.opened++;
    return 0;
}

void chip_close(void) { chip.opened--; }

int chip_request(
    const unsigned *line, unsigned n, int output, int bias, int low, const char *consumer)
{
    if (chip.request_error) { return fails(chip.request_error); }
    if (bias && chip.no_bias) { return fails(EINVAL); }
    for (unsigned i = 0; i < n; i++) {
        if (line[i] >= CHIP_LINES) { return fails(EINVAL); }
        if (chip.line[line[i]].holder || chip.line[line[i]].held) { return fails(EBUSY); }
    }
    for (unsigned i = 0; i < n; i++) {
        struct chip_line *l = &chip.line[line[i]];
        l->held = 1;
        l->output = output;
        l->pulled_down = bias;
        l->consumer = consumer;
        if (output) { l->level = !low; }
    }
    return 0;
}

void chip_release(const unsigned *line, unsigned n)
{
    for (unsigned i = 0; i < n; i++) { chip.line[line[i]].held = 0; }
}

int chip_get(const unsigned *line, unsigned n, int *level)
{
    const int second = (int)(chip.gets++ % 2);
    if (chip.get_error) { return fails(chip.get_error); }
    for (unsigned i = 0; i < n; i++) {
        level[i] = chip.line[line[i]].level;
        if ((int)line[i] == chip.flips) { level[i] = !second; }
        if ((int)line[i] == chip.first_low) { level[i] = second; }
    }
    return 0;
}

int chip_put(const unsigned *line, unsigned n, const int *level)
{
    chip.puts++;
    if (chip.put_error) { return fails(chip.put_error); }
    if (chip.puts_fail > 0) {
        chip.puts_fail--;
        return fails(EIO);
    }
    for (unsigned i = 0; i < n; i++) {
        const char told = (char)('0' + level[i]);
        chip.line[line[i]].level = level[i];
        if (chip.put_fd >= 0 && write(chip.put_fd, &told, 1) != 1) { return fails(EIO); }
    }
    return 0;
}
