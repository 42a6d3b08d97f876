/* SPDX-License-Identifier: MIT */
/* Layers of a picture: static bodies keep their pixels and depths between pictures, and so do the
 * numbers, which need no rate of four hundred per second. A new picture starts as a copy of the
 * first layer, where something moved, and ends with a copy of the second. */
#include "gl.h"

#include <stdlib.h>
#include <string.h>

#define NUMBERS_MS 50 /* how old those on the screen may be */

static int make(struct gl_layer *l, int width, int height)
{
    glGenFramebuffers(1, &l->frame);
    glGenRenderbuffers(2, l->buffer);
    glBindFramebuffer(GL_FRAMEBUFFER, l->frame);
    glBindRenderbuffer(GL_RENDERBUFFER, l->buffer[0]);
    glRenderbufferStorage(GL_RENDERBUFFER, GL_RGBA8, width, height);
    glFramebufferRenderbuffer(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_RENDERBUFFER, l->buffer[0]);
    glBindRenderbuffer(GL_RENDERBUFFER, l->buffer[1]);
    glRenderbufferStorage(GL_RENDERBUFFER, GL_DEPTH24_STENCIL8, width, height);
    glFramebufferRenderbuffer(
        GL_FRAMEBUFFER, GL_DEPTH_STENCIL_ATTACHMENT, GL_RENDERBUFFER, l->buffer[1]);
    return glCheckFramebufferStatus(GL_FRAMEBUFFER) != GL_FRAMEBUFFER_COMPLETE;
}

static void unmake(struct gl_layer *l)
{
    if (l->frame == 0) { return; }
    glDeleteFramebuffers(1, &l->frame);
    glDeleteRenderbuffers(2, l->buffer);
    memset(l, 0, sizeof *l);
}

int gl_layers_fit(struct gl_layers *g, int width, int height)
{
    if (g->never) { return 1; }
    if (width == g->width && height == g->height) { return 0; }
    gl_layers_close(g);
    if (SDL_GL_ExtensionSupported("GL_ARB_framebuffer_object")) {
        g->never = make(&g->layer[GL_STILL], width, height) ||
                   make(&g->layer[GL_NUMBERS], width, height) ||
                   make(&g->layer[GL_WHOLE], width, height);
    } else {
        g->never = 1;
    }
    if (g->never) {
        gl_layers_close(g);
        glBindFramebuffer(GL_FRAMEBUFFER, 0);
        g->never = 1;
        return 1;
    }
    g->width = width;
    g->height = height;
    return 0;
}

void gl_layers_close(struct gl_layers *g)
{
    for (int i = 0; i < GL_LAYERS; i++) { unmake(&g->layer[i]); }
    free(g->seen);
    memset(g, 0, sizeof *g);
}

void gl_layer_on(const struct gl_layers *g, int layer)
{
    glBindFramebuffer(GL_FRAMEBUFFER, layer < 0 ? 0 : g->layer[layer].frame);
}

void gl_layer_copy(
    const struct gl_layers *g, int from, int to, GLbitfield what, const struct gl_patch *p)
{
    const int x0 = p->x0 < 0 ? 0 : p->x0, x1 = p->x1 > g->width ? g->width : p->x1;
    const int y0 = p->y0 < 0 ? 0 : p->y0, y1 = p->y1 > g->height ? g->height : p->y1;
    if (x1 <= x0 || y1 <= y0) { return; }
    glBindFramebuffer(GL_READ_FRAMEBUFFER, g->layer[from].frame);
    glBindFramebuffer(GL_DRAW_FRAMEBUFFER, to < 0 ? 0 : g->layer[to].frame);
    glBlitFramebuffer(x0, y0, x1, y1, x0, y0, x1, y1, what, GL_NEAREST);
}

/* 1 if static bodies, the eye or the size have changed since the last call. */
int gl_layers_moved(struct gl_layers *g, const struct draw_list *l)
{
    int n = 0, other = 0;
    if (g->room < l->items) {
        struct draw_item *more = realloc(g->seen, (size_t)l->room * sizeof *more);
        if (more == NULL) { return 1; }
        g->seen = more;
        g->room = l->room;
    }
    for (int k = 0; k < l->items; k++) {
        if (!l->item[k].still) { continue; }
        if (n >= g->items || memcmp(&g->seen[n], &l->item[k], sizeof *g->seen) != 0) {
            memcpy(&g->seen[n], &l->item[k], sizeof *g->seen);
            other = 1;
        }
        n++;
    }
    other |= n != g->items || memcmp(&g->eye, &l->eye, sizeof g->eye) != 0 ||
             memcmp(&g->look, &l->look, sizeof g->look) != 0;
    g->items = n;
    g->eye = l->eye;
    g->look = l->look;
    return other;
}

int gl_layers_old(struct gl_layers *g, const struct draw_list *l)
{
    const Uint32 now = SDL_GetTicks();
    int panels = 0;
    for (int i = 0; i < l->rects; i++) { panels += l->rect[i].panel; }
    if (g->panels == panels && now - g->numbers_ms < NUMBERS_MS) { return 0; }
    g->panels = panels;
    g->numbers_ms = now;
    return 1;
}

void gl_layers_panels(const struct gl_layers *g, int from, int to, const struct draw_list *l)
{
    for (int i = 0; i < l->rects; i++) {
        const struct draw_rect *r = &l->rect[i];
        const int x = r->x < 0 ? g->width + r->x : r->x, y = r->y < 0 ? g->height + r->y : r->y;
        const struct gl_patch p = {x, g->height - y - r->h, x + r->w, g->height - y};
        if (r->panel) { gl_layer_copy(g, from, to, GL_COLOR_BUFFER_BIT, &p); }
    }
}
