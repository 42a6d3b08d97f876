/* SPDX-License-Identifier: MIT */
#include "box/recording_ask.h"

#include "base/option.h"

#include <stdlib.h>
#include <string.h>

enum recording_unit recording_unit_of(const char *name)
{
    static const char *const text[] = {"codes", "rad", "deg", "turn"};
    for (int i = 0; i < 4; i++) {
        if (strcmp(name, text[i]) == 0) { return (enum recording_unit)(i + 1); }
    }
    return RECORDING_GUESS;
}

int recording_scale_of(struct recording_scale *to, const char *text)
{
    char *end;
    *to = (struct recording_scale){text != NULL, 1, 0};
    if (text == NULL) { return 0; }
    to->gain = strtod(text, &end);
    if (end != text && *end == ',') { to->offset = strtod(end + 1, &end); }
    if (end == text || *end != '\0' || !(to->gain >= -1e6 && to->gain <= 1e6) || to->gain == 0 ||
        !(to->offset >= -1e6 && to->offset <= 1e6) || strpbrk(text, " xX")) {
        cli_complain("--scale: %.60s: give A or A,B: a code is A times the number and B", text);
        return 2;
    }
    return 0;
}
