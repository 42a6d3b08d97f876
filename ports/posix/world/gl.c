/* SPDX-License-Identifier: MIT */
#include "gl.h"

#include "base/option.h"
#include "base/outfile.h"

#include <png.h>

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

struct picture {
    SDL_Window *window;
    SDL_GLContext context;
    struct gl_solid solid;
    struct gl_text text;
    struct gl_layers layers;
    int width, height, headless, layered; /* layered: so is the picture last painted */
};

static int open_window(struct picture *p, const struct picture_want *want, int samples)
{
    const Uint32 how =
        SDL_WINDOW_OPENGL | (want->headless ? SDL_WINDOW_HIDDEN : SDL_WINDOW_RESIZABLE);
    SDL_GL_SetAttribute(SDL_GL_CONTEXT_MAJOR_VERSION, 2);
    SDL_GL_SetAttribute(SDL_GL_CONTEXT_MINOR_VERSION, 1);
    SDL_GL_SetAttribute(SDL_GL_DEPTH_SIZE, 24);
    SDL_GL_SetAttribute(SDL_GL_STENCIL_SIZE, 8);
    SDL_GL_SetAttribute(SDL_GL_MULTISAMPLEBUFFERS, samples > 1);
    SDL_GL_SetAttribute(SDL_GL_MULTISAMPLESAMPLES, samples > 1 ? samples : 0);
    p->window = SDL_CreateWindow(want->title, SDL_WINDOWPOS_UNDEFINED, SDL_WINDOWPOS_UNDEFINED,
        want->width, want->height, how);
    if (p->window) { p->context = SDL_GL_CreateContext(p->window); }
    if (p->context) { return 0; }
    if (p->window) { SDL_DestroyWindow(p->window); }
    p->window = NULL;
    return 1;
}

static int open_all(struct picture *p, const struct picture_want *want, char *error, size_t error_B)
{
    if (want->headless) {
        SDL_SetHint(SDL_HINT_VIDEODRIVER, "offscreen");
        SDL_setenv("LP_NUM_THREADS", "0", 0); /* Mesa without a card: no threads to wait for */
    }
    if (SDL_Init(SDL_INIT_VIDEO) != 0) {
        snprintf(error, error_B, "no display: %s: use --headless", SDL_GetError());
        return 1;
    }
    if (open_window(p, want, want->samples) && open_window(p, want, 0)) {
        snprintf(error, error_B,
            "no OpenGL 2.1: %s: install libgl1-mesa-dri and libegl1, or use "
            "--headless without --png and --video",
            SDL_GetError());
        return 1;
    }
    p->headless = want->headless;
    p->solid.fine = want->samples > 1;
    p->layers.never = want->samples > 1;
    SDL_GL_SetSwapInterval(want->headless ? 0 : 1);
    return gl_solid_open(&p->solid, error, error_B) || gl_text_open(&p->text, error, error_B);
}

struct picture *picture_open(const struct picture_want *want, char *error, size_t error_B)
{
    struct picture *p = calloc(1, sizeof *p);
    if (p == NULL || open_all(p, want, error, error_B)) {
        if (p == NULL) { snprintf(error, error_B, "no memory"); }
        picture_close(p);
        return NULL;
    }
    return p;
}

void picture_close(struct picture *p)
{
    if (p == NULL) { return; }
    if (p->context) {
        gl_layers_close(&p->layers);
        gl_solid_close(&p->solid);
        gl_text_close(&p->text);
        SDL_GL_DeleteContext(p->context);
    }
    if (p->window) { SDL_DestroyWindow(p->window); }
    SDL_Quit();
    free(p);
}

static void paint_all(struct picture *p, const struct draw_list *list)
{
    gl_text_back(&p->text, p->width, p->height);
    gl_solid_fill(&p->solid, list, GL_PART_ALL, p->width, p->height);
    gl_solid_paint(&p->solid, list);
    gl_text_paint(&p->text, list, p->width, p->height);
}

static struct gl_patch both(const struct gl_patch *a, const struct gl_patch *b)
{
    if (a->x1 <= a->x0) { return *b; }
    if (b->x1 <= b->x0) { return *a; }
    return (struct gl_patch){a->x0 < b->x0 ? a->x0 : b->x0, a->y0 < b->y0 ? a->y0 : b->y0,
        a->x1 > b->x1 ? a->x1 : b->x1, a->y1 > b->y1 ? a->y1 : b->y1};
}

/* Numbers not older than they may be; fresh: all of now. */
static void paint_layers(struct picture *p, const struct draw_list *list, int fresh)
{
    const GLbitfield all = GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT | GL_STENCIL_BUFFER_BIT;
    const int anew = gl_layers_moved(&p->layers, list), old = gl_layers_old(&p->layers, list);
    const struct gl_patch before = p->layers.moving, full = {0, 0, p->width, p->height};
    struct gl_patch patch;
    if (anew) {
        gl_layer_on(&p->layers, GL_STILL);
        gl_text_back(&p->text, p->width, p->height);
        gl_solid_fill(&p->solid, list, GL_PART_STILL, p->width, p->height);
        gl_solid_paint(&p->solid, list);
    }
    if (anew || old || fresh) {
        gl_layers_panels(&p->layers, GL_STILL, GL_NUMBERS, list);
        gl_layer_on(&p->layers, GL_NUMBERS);
        gl_text_paint(&p->text, list, p->width, p->height);
    }
    p->layers.moving = gl_solid_fill(&p->solid, list, GL_PART_MOVING, p->width, p->height);
    patch = anew || old || fresh ? full : both(&before, &p->layers.moving);
    gl_layer_copy(&p->layers, GL_STILL, GL_WHOLE, all, &patch);
    gl_layer_on(&p->layers, GL_WHOLE);
    gl_solid_paint(&p->solid, list);
    gl_layers_panels(&p->layers, GL_NUMBERS, GL_WHOLE, list);
    gl_layer_on(&p->layers, GL_WHOLE);
}

static void paint(struct picture *p, const struct draw_list *list, int fresh)
{
    SDL_GL_GetDrawableSize(p->window, &p->width, &p->height);
    p->layered = gl_layers_fit(&p->layers, p->width, p->height) == 0;
    glViewport(0, 0, p->width, p->height);
    if (p->layered) {
        paint_layers(p, list, fresh);
    } else {
        paint_all(p, list);
    }
}

void picture_paint(struct picture *p, const struct draw_list *list) { paint(p, list, 0); }

void picture_show(struct picture *p)
{
    const struct gl_patch all = {0, 0, p->width, p->height};
    if (p->layered && p->headless) { return; } /* not displayed; picture_save() reads the layer */
    if (p->layered) {
        gl_layer_copy(&p->layers, GL_WHOLE, -1, GL_COLOR_BUFFER_BIT, &all);
        gl_layer_on(&p->layers, -1);
    }
    SDL_GL_SwapWindow(p->window);
}

void picture_wait(struct picture *p)
{
    (void)p;
    glFinish();
}

static int write_png(FILE *f, const unsigned char *pixel, int width, int height)
{
    png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, NULL, NULL, NULL);
    png_infop info = png ? png_create_info_struct(png) : NULL;
    if (info == NULL || setjmp(png_jmpbuf(png))) {
        png_destroy_write_struct(&png, &info);
        return 1;
    }
    png_init_io(png, f);
    png_set_IHDR(png, info, (png_uint_32)width, (png_uint_32)height, 8, PNG_COLOR_TYPE_RGB,
        PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
    png_write_info(png, info);
    for (int y = height - 1; y >= 0; y--) { /* OpenGL counts from below */
        png_write_row(png, pixel + (size_t)y * (size_t)width * 3);
    }
    png_write_end(png, info);
    png_destroy_write_struct(&png, &info);
    return 0;
}

int picture_save(
    struct picture *p, const struct draw_list *list, const char *option, const char *path)
{
    FILE *f = outfile_open(option, path);
    unsigned char *pixel;
    int bad;
    if (f == NULL) { return 1; }
    paint(p, list, 1);
    pixel = malloc((size_t)p->width * (size_t)p->height * 3);
    bad = pixel == NULL;
    if (bad) { cli_complain("--%s: out of memory: give a smaller --width", option); }
    if (!bad) {
        glPixelStorei(GL_PACK_ALIGNMENT, 1);
        glReadPixels(0, 0, p->width, p->height, GL_RGB, GL_UNSIGNED_BYTE, pixel);
        bad = write_png(f, pixel, p->width, p->height) && !ferror(f);
        if (bad) { cli_complain("--%s: %s: libpng can't write this picture", option, path); }
    }
    free(pixel);
    return outfile_end(f, !bad) || bad;
}

static int key_of(const SDL_KeyboardEvent *e)
{
    const SDL_Keycode k = e->keysym.sym;
    const int shift = e->keysym.mod & KMOD_SHIFT ? KEY_SHIFT : 0;
    switch (k) {
    case SDLK_LEFT: return KEY_LEFT;
    case SDLK_RIGHT: return KEY_RIGHT;
    case SDLK_UP: return KEY_UP;
    case SDLK_DOWN: return KEY_DOWN;
    case SDLK_ESCAPE: return KEY_QUIT;
    case SDLK_KP_PLUS: return '+';
    case SDLK_KP_MINUS: return '-';
    default: break;
    }
    return k > 0 && k < 128 ? k | shift : -1;
}

int picture_key(struct picture *p, struct picture_drag *drag)
{
    SDL_Event e;
    (void)p;
    while (SDL_PollEvent(&e)) {
        int key = -1;
        if (e.type == SDL_QUIT) { return KEY_QUIT; }
        if (e.type == SDL_KEYDOWN) { key = key_of(&e.key); }
        if (e.type == SDL_MOUSEWHEEL) { drag->nearer += e.wheel.y; }
        if (e.type == SDL_MOUSEMOTION && e.motion.state) {
            drag->turn += e.motion.xrel;
            drag->tilt += e.motion.yrel;
        }
        if (key >= 0) { return key; }
    }
    return 0;
}
