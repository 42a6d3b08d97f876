/* SPDX-License-Identifier: MIT */
/* Which box the image drives: cards, where they are, what of them is not certain. */
#ifndef PC104_BOX_H
#define PC104_BOX_H

#include "pc104.h"

#include "cards/box.h"

/* What the scene needs, as the options say. */
void pc104_box_config(const struct exh_scene *sc, struct exh_box_config *c);
void pc104_box_say(const struct exh_box_report *r);
void pc104_box_report(void); /* what failed since, and what was dealt with */

/* Halts where a card that sc uses has one of the ports first .. last, which are the option's. */
void pc104_box_leave(const struct exh_scene *sc, const char *option, uint32_t first, uint32_t last);

#endif
