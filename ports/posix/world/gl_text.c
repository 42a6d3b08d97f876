/* SPDX-License-Identifier: MIT */
#include "gl.h"

#include <SDL_ttf.h>

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define ATLAS  512
#define VERTEX 8 /* floats: place, place in the atlas, colour */
#define FIRST  32

#ifndef WORLD_FONT
#define WORLD_FONT "/usr/share/fonts/truetype/dejavu/DejaVuSans.ttf"
#endif

static const int size_px[2] = {14, 20};

static const char vertex_text[] = "#version 120\n"
                                  "attribute vec2 place; attribute vec2 from; attribute vec4 ink;\n"
                                  "uniform vec2 size; varying vec2 t; varying vec4 c;\n"
                                  "void main() { t = from; c = ink;\n"
                                  "  gl_Position = vec4(2.0 * place.x / size.x - 1.0, 1.0 - 2.0 * "
                                  "place.y / size.y, 0.0, 1.0); }\n";
static const char plain_text[] = "#version 120\n"
                                 "varying vec2 t; varying vec4 c;\n"
                                 "void main() { gl_FragColor = c; }\n";
static const char lettered_text[] = "#version 120\n"
                                    "uniform sampler2D atlas; varying vec2 t; varying vec4 c;\n"
                                    "void main() { gl_FragColor = c * texture2D(atlas, t).a; }\n";

/* Letters of one size into the atlas, from *x, *y on. */
static int letters(
    struct gl_text *g, unsigned char *atlas, int size, int *x, int *y, char *error, size_t error_B)
{
    const SDL_Color white = {255, 255, 255, 255};
    TTF_Font *font = TTF_OpenFont(WORLD_FONT, size_px[size]);
    if (font == NULL) {
        snprintf(error, error_B, WORLD_FONT ": %s: install fonts-dejavu-core", TTF_GetError());
        return 1;
    }
    g->line[size] = TTF_FontLineSkip(font);
    for (int k = 0; k < 95; k++) {
        struct gl_glyph *l = &g->glyph[size][k];
        SDL_Surface *s = TTF_RenderGlyph_Blended(font, (Uint16)(FIRST + k), white);
        int step = 0;
        TTF_GlyphMetrics(font, (Uint16)(FIRST + k), NULL, NULL, NULL, NULL, &step);
        l->step = step;
        if (s == NULL) { continue; }
        if (*x + s->w + 1 > ATLAS) {
            *x = 0;
            *y += g->line[size] + 2;
        }
        for (int j = 0; j < s->h && *y + j < ATLAS; j++) {
            const Uint8 *row = (const Uint8 *)s->pixels + (ptrdiff_t)j * s->pitch;
            for (int i = 0; i < s->w; i++) { atlas[(*y + j) * ATLAS + *x + i] = row[4 * i + 3]; }
        }
        l->w = s->w;
        l->h = s->h;
        l->u0 = (float)*x / ATLAS;
        l->v0 = (float)*y / ATLAS;
        l->u1 = (float)(*x + s->w) / ATLAS;
        l->v1 = (float)(*y + s->h) / ATLAS;
        *x += s->w + 1;
        SDL_FreeSurface(s);
    }
    *x = 0;
    *y += g->line[size] + 2;
    TTF_CloseFont(font);
    return 0;
}

static int make_atlas(struct gl_text *g, char *error, size_t error_B)
{
    unsigned char *atlas = calloc(ATLAS, ATLAS);
    int x = 0, y = 0, bad = atlas == NULL || TTF_Init() != 0;
    for (int i = 0; i < 2 && !bad; i++) { bad = letters(g, atlas, i, &x, &y, error, error_B); }
    if (!bad) {
        glGenTextures(1, &g->texture);
        glBindTexture(GL_TEXTURE_2D, g->texture);
        glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
        glTexImage2D(
            GL_TEXTURE_2D, 0, GL_ALPHA, ATLAS, ATLAS, 0, GL_ALPHA, GL_UNSIGNED_BYTE, atlas);
        glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
        glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
    }
    free(atlas);
    return bad;
}

int gl_text_open(struct gl_text *g, char *error, size_t error_B)
{
    static const char *const attribute[] = {"place", "from", "ink"};
    if (make_atlas(g, error, error_B)) { return 1; }
    g->plain = gl_program(vertex_text, plain_text, attribute, 3, error, error_B);
    g->lettered =
        g->plain ? gl_program(vertex_text, lettered_text, attribute, 3, error, error_B) : 0;
    if (g->lettered == 0) { return 1; }
    g->plain_size = glGetUniformLocation(g->plain, "size");
    g->lettered_size = glGetUniformLocation(g->lettered, "size");
    glGenBuffers(1, &g->buffer);
    return 0;
}

void gl_text_close(struct gl_text *g)
{
    free(g->vertex);
    TTF_Quit();
}

/* --- a batch of rectangles with a gradient from top to bottom --- */

static void corner(struct gl_text *g, float x, float y, float u, float v, const float c[4])
{
    float *to;
    if (g->vertices == g->room) {
        const int room = g->room ? 2 * g->room : 4096;
        float *more = realloc(g->vertex, (size_t)room * VERTEX * sizeof *more);
        if (more == NULL) { return; }
        g->vertex = more;
        g->room = room;
    }
    to = g->vertex + (size_t)g->vertices++ * VERTEX;
    to[0] = x, to[1] = y, to[2] = u, to[3] = v;
    for (int i = 0; i < 4; i++) { to[4 + i] = i < 3 ? c[i] * c[3] : c[3]; }
}

static void patch(struct gl_text *g, int x, int y, int w, int h, const struct gl_glyph *l,
    const float top[4], const float low[4])
{
    const float x0 = (float)x, y0 = (float)y, x1 = (float)(x + w), y1 = (float)(y + h);
    const float u0 = l ? l->u0 : 0, v0 = l ? l->v0 : 0, u1 = l ? l->u1 : 0, v1 = l ? l->v1 : 0;
    corner(g, x0, y0, u0, v0, top), corner(g, x1, y0, u1, v0, top), corner(g, x1, y1, u1, v1, low);
    corner(g, x0, y0, u0, v0, top), corner(g, x1, y1, u1, v1, low), corner(g, x0, y1, u0, v1, low);
}

static void flush(struct gl_text *g, int letters, int width, int height)
{
    const GLsizei stride = VERTEX * sizeof(float);
    glUseProgram(letters ? g->lettered : g->plain);
    glUniform2f(letters ? g->lettered_size : g->plain_size, (float)width, (float)height);
    glBindTexture(GL_TEXTURE_2D, g->texture);
    glBindBuffer(GL_ARRAY_BUFFER, g->buffer);
    glBufferData(GL_ARRAY_BUFFER, (GLsizeiptr)g->vertices * stride, g->vertex, GL_STREAM_DRAW);
    glEnableVertexAttribArray(0);
    glEnableVertexAttribArray(1);
    glEnableVertexAttribArray(2);
    glVertexAttribPointer(0, 2, GL_FLOAT, GL_FALSE, stride, (const void *)0);
    glVertexAttribPointer(1, 2, GL_FLOAT, GL_FALSE, stride, (const void *)(2 * sizeof(float)));
    glVertexAttribPointer(2, 4, GL_FLOAT, GL_FALSE, stride, (const void *)(4 * sizeof(float)));
    glDrawArrays(GL_TRIANGLES, 0, g->vertices);
    g->vertices = 0;
}

void gl_text_back(struct gl_text *g, int width, int height)
{
    static const float top[4] = {0.62F, 0.69F, 0.77F, 1}, low[4] = {0.90F, 0.91F, 0.92F, 1};
    glClearColor(low[0], low[1], low[2], 1);
    glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT | GL_STENCIL_BUFFER_BIT);
    patch(g, 0, 0, width, height * 6 / 10, NULL, top, low);
    flush(g, 0, width, height);
}

static int length(const struct gl_text *g, const struct draw_text *t)
{
    int n = 0;
    for (const char *s = t->text; *s; s++) {
        const unsigned k = (unsigned)*s - FIRST;
        n += k < 95 ? g->glyph[t->large][k].step : 0;
    }
    return n;
}

static void line(struct gl_text *g, const struct draw_text *t, int width, int height)
{
    int x = t->x < 0 ? width + t->x : t->x;
    const int y = t->y < 0 ? height + t->y : t->y;
    if (t->right) { x -= length(g, t); }
    for (const char *s = t->text; *s; s++) {
        const unsigned k = (unsigned)*s - FIRST;
        const struct gl_glyph *l = &g->glyph[t->large][k < 95 ? k : 0];
        patch(g, x, y, l->w, l->h, l, t->colour, t->colour);
        x += l->step;
    }
}

void gl_text_paint(struct gl_text *g, const struct draw_list *list, int width, int height)
{
    glDisable(GL_DEPTH_TEST);
    glEnable(GL_BLEND);
    glBlendFunc(GL_ONE, GL_ONE_MINUS_SRC_ALPHA);
    for (int i = 0; i < list->rects; i++) {
        const struct draw_rect *r = &list->rect[i];
        patch(g, r->x < 0 ? width + r->x : r->x, r->y < 0 ? height + r->y : r->y, r->w, r->h, NULL,
            r->colour, r->colour);
    }
    flush(g, 0, width, height);
    for (int i = 0; i < list->texts; i++) { line(g, &list->text[i], width, height); }
    flush(g, 1, width, height);
    glDisable(GL_BLEND);
}
