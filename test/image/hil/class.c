/* SPDX-License-Identifier: MIT */
#include "class.h"

#include "base/param.h"
#include "exhand/precontact.h"
#include "exhand/wire.h"

#include <string.h>

/* Offsets in struct exh_scene and struct exh_scene_link of a 32-bit image; of a packet's type. */
enum { SCENE_SIGNAL = 20, SCENE_LINK = 32, LINK_IN = 8, WIRE_TYPE = 3 };

static unsigned kind(uint8_t type)
{
    switch (type) {
    case EXH_WIRE_HELLO: return COUNT_HELLO;
    case EXH_WIRE_PLANES: return COUNT_PLANES;
    case EXH_WIRE_PARAM: return COUNT_PARAM;
    default: return 0;
    }
}

unsigned class_in(struct class_of *c, const struct hil *h, const struct exh_scene_in *in)
{
    const uint32_t link = hil_word(h, c->scene + SCENE_LINK);
    const uint32_t at = link ? hil_word(h, link + LINK_IN) : 0;
    unsigned key = in->glove_new ? COUNT_GLOVE : 0;
    struct exh_scene_mail mail;
    if (at == 0 || at > HIL_RAM_B - sizeof mail) { return key; }
    memcpy(&mail, &h->ram[at], sizeof mail);
    if (mail.packets > COUNT_MASK) { mail.packets = COUNT_MASK; }
    for (unsigned i = 0; i < mail.packets; i++) { key += kind(mail.byte[i][WIRE_TYPE]); }
    return key + mail.packets * COUNT_REFUSED;
}

/* Value `at` of the image's signals. */
static uint32_t signal(const struct class_of *c, const struct hil *h, uint32_t at)
{
    return hil_word(h, hil_word(h, c->scene + SCENE_SIGNAL) + 4 * at);
}

unsigned class_out(
    struct class_of *c, const struct hil *h, const struct exh_drive_out *out, unsigned key)
{
    const struct exh_signal_table *t = c->twin ? c->twin->signals : NULL;
    key |= out->enable ? COUNT_RUNS : 0;
    for (uint32_t i = 0; t && i < exh_signal_count(t); i++) {
        uint16_t instance;
        const struct exh_signal *row = exh_signal_at(t, i, &instance);
        if (strcmp(row->name, "frozen") == 0) {
            key += signal(c, h, i) & EXH_PRECONTACT_TRACKS ? COUNT_TRACKS : 0;
        } else if (strcmp(row->name, "accepted") == 0) {
            const uint32_t taken = signal(c, h, i) - c->accepted;
            c->accepted += taken;
            key -= taken <= (key / COUNT_REFUSED & COUNT_MASK) ? taken * COUNT_REFUSED : 0;
        }
    }
    return key;
}
