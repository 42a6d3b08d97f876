/* SPDX-License-Identifier: MIT */
/* The boot command line: name=value, by the rows of option.c, the box's (box.c) and the scene's. A
 * word that is none of them stops the image before anything moves. */
#include "pc104.h"

#include "exhand/exhand.h"

#include <stddef.h>

#define MB_LOADED      0x2BADB002u /* a multiboot loader was here */
#define MB_HAS_CMDLINE (1u << 2)
#define CMDLINE_MAX    1024u /* limits the search, whatever the loader wrote */

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

/* The next "name=value"; 0 at the end. Both point into the copy. A word without '=' comes with
 * value NULL. *at starts as 0. */
static int next(unsigned *at, const char **name, const char **value)
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

static int table_option(
    const struct exh_signal_table *t, int32_t *to, const char *name, const char *value)
{
    for (uint32_t i = 0; i < exh_signal_count(t); i++) {
        const struct exh_signal *row = exh_signal_at(t, i, NULL);
        if (pc104_same_text(row->name, name)) {
            to[i] = pc104_value_of(row, value);
            return 1;
        }
    }
    return 0;
}

static void defaults(const struct exh_signal_table *t, int32_t *to)
{
    for (uint32_t i = 0; i < exh_signal_count(t); i++) { to[i] = exh_signal_at(t, i, NULL)->dflt; }
}

void pc104_options(const struct exh_scene *sc)
{
    const char *name, *value;
    unsigned at = 0;

    defaults(&pc104_option_table, (int32_t *)&pc104_par);
    defaults(&pc104_box_table, (int32_t *)&pc104_box_par);
    while (next(&at, &name, &value)) {
        if (value && (table_option(&pc104_option_table, (int32_t *)&pc104_par, name, value) ||
                         table_option(&pc104_box_table, (int32_t *)&pc104_box_par, name, value) ||
                         pc104_link_option(name, value) || pc104_scene_option(sc, name, value))) {
            pc104_say("set ");
            pc104_say(name);
            pc104_say(" ");
            pc104_say(value);
            pc104_say("\n");
            continue;
        }
        pc104_refuse(name, value);
        pc104_say(value ? "no such parameter of image, box or scene\n" : "not name=value\n");
        pc104_halt(PC104_EXIT_OPTION, "option refused: nothing was started");
    }
    if (sc) { pc104_scene_check(sc); }
}
