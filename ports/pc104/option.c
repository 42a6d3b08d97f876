#include "pc104.h"

#include <stddef.h>

#define MB_LOADED      0x2BADB002u /* a multiboot loader was here             */
#define MB_HAS_CMDLINE (1u << 2)
#define CMDLINE_MAX    512u /* whoever wrote it: look no further       */

/* Head of the structure that the loader left; the rest does not concern us. */
struct multiboot_info {
    uint32_t flags, mem_lower, mem_upper, boot_device, cmdline;
};

static const char *cmdline(void)
{
    const struct multiboot_info *info;

    if (pc104_boot_magic != MB_LOADED) { return NULL; }
    info = (const struct multiboot_info *)pc104_boot_info;
    return info->flags & MB_HAS_CMDLINE ? (const char *)info->cmdline : NULL;
}

/* The value behind "name=" when text starts with it, else NULL. */
static const char *value_of(const char *text, const char *name)
{
    while (*name && *text == *name) {
        text++;
        name++;
    }
    return *name == 0 && *text == '=' ? text + 1 : NULL;
}

/* Decimal digits up to a blank or the end; anything else is not a number. */
static int parse_u32(const char *text, uint32_t *value)
{
    uint32_t v = 0;
    int digits = 0;

    for (; *text >= '0' && *text <= '9' && digits < 9; text++, digits++) {
        v = v * 10 + (uint32_t)(*text - '0');
    }
    if (digits == 0 || (*text != 0 && *text != ' ')) { return 0; }
    *value = v;
    return 1;
}

uint32_t pc104_option_u32(const char *name, uint32_t otherwise)
{
    const char *text = cmdline();
    uint32_t value = otherwise;
    char before = ' ';

    for (unsigned i = 0; text && text[i] && i < CMDLINE_MAX; i++) {
        const char *digits = before == ' ' ? value_of(&text[i], name) : NULL;
        if (digits && !parse_u32(digits, &value)) {
            pc104_say(name);
            pc104_say(": not a number of 1 to 9 digits, default taken\n");
        }
        before = text[i];
    }
    return value;
}
