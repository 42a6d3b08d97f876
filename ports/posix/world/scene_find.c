/* SPDX-License-Identifier: MIT */
/* Names in a scene: looks up objects by name, and adds one. */
#include "scene_part.h"

#include <stdlib.h>
#include <string.h>

void *scene_room(void *array, int n, size_t size_B)
{
    if (n & (n - 1)) { return array; }
    return realloc(array, (size_t)(n ? 2 * n : 1) * size_B);
}

int scene_named(struct reading *r, char to[SCENE_NAME_B])
{
    struct tokens *w = &r->w;
    if (w->n < 2) {
        return tokens_complain(w, "%s: its name is missing: add one word", w->word[0]);
    }
    if (strlen(w->word[1]) >= SCENE_NAME_B) {
        return tokens_complain(w, "%s %.40s: a name has at most %d characters: shorten it",
            w->word[0], w->word[1], SCENE_NAME_B - 1);
    }
    strcpy(to, w->word[1]);
    return 0;
}

struct scene_object *scene_object_of(const struct scene *s, const char *name)
{
    for (int i = s->objects - 1; i >= 0; i--) { /* the newest is the likeliest */
        if (strcmp(s->object[i].name, name) == 0) { return &s->object[i]; }
    }
    return NULL;
}

int scene_material_of(const struct scene *s, const char *name)
{
    for (int i = 0; i < s->materials; i++) {
        if (strcmp(s->material[i].name, name) == 0) { return i; }
    }
    return -1;
}
