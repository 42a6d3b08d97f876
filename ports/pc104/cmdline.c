/* SPDX-License-Identifier: MIT */
#include "pc104.h"

#include <stddef.h>

#define MB_LOADED      0x2BADB002u /* a multiboot loader was here */
#define MB_HAS_CMDLINE (1u << 2)
#define CMDLINE_MAX    1024u /* whoever wrote it: look no further */

/* Head of the structure that the loader left; the rest does not concern us. */
struct multiboot_info {
    uint32_t flags, mem_lower, mem_upper, boot_device, cmdline;
};

static char line[CMDLINE_MAX];

void pc104_cmdline_open(void)
{
    const struct multiboot_info *info = (const struct multiboot_info *)pc104_boot_info;
    const char *text;
    if (pc104_boot_magic != MB_LOADED || !(info->flags & MB_HAS_CMDLINE)) { return; }
    text = (const char *)info->cmdline;
    for (unsigned i = 0; text[i]; i++) {
        if (i == CMDLINE_MAX - 1) { /* half a value is another value */
            pc104_say("options longer than 1023 characters\n");
            pc104_halt(PC104_EXIT_OPTION, "option refused: nothing was started");
        }
        line[i] = text[i];
    }
}

/* Loaders may put the image's own name in front. */
static int is_path(const char *word)
{
    for (; *word && *word != '='; word++) {
        if (*word == '/') { return 1; }
    }
    return 0;
}

int pc104_cmdline_next(unsigned *at, const char **name, const char **value)
{
    char *word;
    for (;;) {
        unsigned end;
        const unsigned begin = *at;
        while (line[*at] == ' ') { ++*at; }
        if (line[*at] == '\0') { return 0; }
        word = &line[*at];
        end = *at;
        while (line[end] != ' ' && line[end] != '\0') { end++; }
        *at = end + (line[end] != '\0');
        line[end] = '\0';
        if (begin != 0 || !is_path(word)) { break; }
    }
    *name = word;
    *value = NULL;
    for (; *word; word++) {
        if (*word == '=') {
            *word = '\0';
            *value = word + 1;
            break;
        }
    }
    return 1;
}
