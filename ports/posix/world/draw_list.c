/* SPDX-License-Identifier: MIT */
/* The list of what a picture draws: room for one more. */
#include "draw.h"

#include <stdlib.h>
#include <string.h>

struct draw_item *draw_add(
    struct draw_list *list, enum draw_kind kind, enum draw_what what, int which)
{
    static struct draw_item nowhere;
    struct draw_item *i;
    if (list->items == list->room) {
        const int room = list->room ? 2 * list->room : 128;
        struct draw_item *more = realloc(list->item, (size_t)room * sizeof *more);
        if (more == NULL) {
            list->lost++;
            return &nowhere;
        }
        list->item = more;
        list->room = room;
    }
    i = &list->item[list->items++];
    memset(i, 0, sizeof *i);
    i->kind = kind;
    i->what = what;
    i->which = which;
    i->at.turn.x.x = i->at.turn.y.y = i->at.turn.z.z = 1;
    return i;
}
