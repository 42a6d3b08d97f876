/* SPDX-License-Identifier: MIT */
/* Parts of the OpenGL picture. */
#ifndef WORLD_GL_H
#define WORLD_GL_H

#include "picture.h"

#define GL_GLEXT_PROTOTYPES
#include <SDL.h>
#include <SDL_opengl.h>

/* --- gl_form.c: what all bodies are put together from --- */

/* FINE to TUBE are round: the half of a ball or capsule that the eye can see. */
enum {
    GL_FORM_FINE,
    GL_FORM_BALL,
    GL_FORM_TUBE,
    GL_FORM_DOT,
    GL_FORM_SHADE,
    GL_FORM_DIM,
    GL_FORM_FLOOR,
    GL_FORM_BOX,
    GL_FORM_DISC,
    GL_FORMS
};

#define GL_FLOOR_MIDDLE 6   /* indices of the floor's middle, which come first */
#define GL_FLOOR_OPAQUE 0.7 /* half its edge; from there on the floor fades */

struct gl_corner {
    struct v3 place, normal;
    double carried; /* ends of a capsule: -1, 1; discs: 0 middle, 1 edge */
};
struct gl_forms {
    struct gl_corner corner[2048];
    unsigned short index[8192];
    int corners, indices;
    struct gl_form {
        int corner, corners, index, indices;
        int steps, strips; /* round */
    } form[GL_FORMS];
};
void gl_forms_make(struct gl_forms *m);

/* Gives a round form the half that is seen from `angle` above the x axis, towards z. */
void gl_form_face(struct gl_forms *m, int form, double angle);

/* --- gl_batch.c: a picture's bodies as one array --- */

struct gl_vertex {
    float place[3], colour[4], on[2]; /* on the floor, whose edges are at -1 and 1 */
};
struct gl_batch {
    struct gl_vertex *vertex;
    GLuint *index, buffer[2];
    int vertices, indices, vertex_room, index_room;
};

extern const struct v3 gl_light; /* towards the lamp */

/* One thing as one form; its shadow on `floor` if that is not NULL. */
void gl_batch_add(struct gl_batch *g, struct gl_forms *f, const struct draw_item *i, int form,
    struct v3 eye, const struct draw_item *floor);
void gl_batch_send(struct gl_batch *g);
void gl_batch_bind(const struct gl_batch *g);
void gl_batch_paint(struct gl_batch *g, GLenum kind, int from, int to); /* indices */
void gl_batch_close(struct gl_batch *g);

/* --- gl_solid.c: batch and meshes in the right order --- */

#define GL_MESHES_MAX 256

/* What of a list is painted. */
enum { GL_PART_STILL = 1, GL_PART_MOVING = 2, GL_PART_ALL = 3 };

/* On the screen, from the left lower corner. */
struct gl_patch {
    int x0, y0, x1, y1;
};

enum { GL_PLAIN, GL_FLOOR, GL_SHADE, GL_PROGRAMS };

/* Sections of the batch, in the order they are painted. */
enum { GL_BODIES, GL_MIDDLES, GL_EDGES, GL_SHADOWS, GL_GLASSES, GL_END, GL_SECTIONS };

struct gl_solid {
    struct gl_forms forms;
    struct gl_batch batch;
    GLuint program[GL_PROGRAMS], mesh_program;
    GLint program_eye[GL_PROGRAMS], eye, at, turn, colour, flat, flat_x, flat_y, look;
    const struct mesh *mesh[GL_MESHES_MAX];
    GLuint mesh_buffer[GL_MESHES_MAX];
    int meshes, fine, mark[GL_SECTIONS]; /* indices where the sections begin */
    int part, has_meshes;
    float view[16];
    const struct draw_item **order; /* what can be seen through, farthest first */
    double *depth;
    int room;
};

/* 0, or 1 with the reason. */
int gl_solid_open(struct gl_solid *g, char *error, size_t error_B);
void gl_solid_close(struct gl_solid *g);
/* Puts a part together; returns where on the screen it will be. */
struct gl_patch gl_solid_fill(
    struct gl_solid *g, const struct draw_list *list, int part, int width, int height);
/* Paints it: first what hides, then what can be seen through. */
void gl_solid_paint(struct gl_solid *g, const struct draw_list *list);

/* --- gl_layer.c: pixels kept from picture to picture --- */

enum { GL_STILL, GL_NUMBERS, GL_WHOLE, GL_LAYERS };

struct gl_layers {
    struct gl_layer {
        GLuint frame, buffer[2];
    } layer[GL_LAYERS];
    int never; /* this driver has none */
    int width, height;
    struct draw_item *seen; /* what the still layer shows, from where */
    int items, room;
    struct v3 eye, look;
    int panels;
    Uint32 numbers_ms;
    struct gl_patch moving; /* where WHOLE is not as STILL */
};

/* 0, or 1 where there can be no layers. */
int gl_layers_fit(struct gl_layers *g, int width, int height);
void gl_layers_close(struct gl_layers *g);
void gl_layer_on(const struct gl_layers *g, int layer); /* -1: the window */
void gl_layer_copy(
    const struct gl_layers *g, int from, int to, GLbitfield what, const struct gl_patch *p);
int gl_layers_moved(struct gl_layers *g, const struct draw_list *list);
int gl_layers_old(struct gl_layers *g, const struct draw_list *list);
void gl_layers_panels(const struct gl_layers *g, int from, int to, const struct draw_list *list);

/* --- gl_text.c: letters and rectangles on the screen --- */

struct gl_glyph {
    float u0, v0, u1, v1;
    int w, h, step;
};

struct gl_text {
    GLuint plain, lettered, buffer, texture;
    GLint plain_size, lettered_size;
    struct gl_glyph glyph[2][96];
    int line[2];
    float *vertex;
    int vertices, room;
};

int gl_text_open(struct gl_text *g, char *error, size_t error_B);
void gl_text_close(struct gl_text *g);
/* The sky, where nothing is yet. */
void gl_text_back(struct gl_text *g, int width, int height);
void gl_text_paint(struct gl_text *g, const struct draw_list *list, int width, int height);

/* Compiles and links; attributes are numbered as listed. 0 with the reason if it fails. */
GLuint gl_program(const char *vertex, const char *fragment, const char *const *attribute, int n,
    char *error, size_t error_B);

#endif
