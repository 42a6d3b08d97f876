/* SPDX-License-Identifier: MIT */
#include "gl.h"

#include "mesh.h"

#include <stdlib.h>
#include <string.h>

static const char batch_text[] =
    "#version 120\n"
    "attribute vec3 place; attribute vec4 ink; attribute vec2 where; uniform mat4 eye;\n"
    "varying vec4 c; varying vec2 on;\n"
    "void main() { c = ink; on = where; gl_Position = eye * vec4(place, 1.0); }\n";
static const char plain_text[] = "#version 120\n"
                                 "varying vec4 c;\n"
                                 "void main() { gl_FragColor = c; }\n";

/* A floor fades towards its edges; so does what is on it. */
#define FADED "c.a * clamp((1.0 - max(abs(on.x), abs(on.y))) * (1.0 / 0.3), 0.0, 1.0)"

/* Lines at each 1/12 of the way from the middle to the edge. */
static const char floor_text[] = "#version 120\n"
                                 "varying vec4 c; varying vec2 on;\n"
                                 "void main() {\n"
                                 "  vec2 q = 12.0 * on, d = abs(q - floor(q + 0.5)) / fwidth(q);\n"
                                 "  float line = 0.28 * clamp(1.0 - min(d.x, d.y), 0.0, 1.0);\n"
                                 "  gl_FragColor = vec4(mix(c.rgb, vec3(1.0), line), " FADED ");\n"
                                 "}\n";
static const char shade_text[] = "#version 120\n"
                                 "varying vec4 c; varying vec2 on;\n"
                                 "void main() { gl_FragColor = vec4(c.rgb, " FADED "); }\n";

/* A mesh stays on the card and is lit there, by the rule of gl_batch.c. */
static const char mesh_text[] =
    "#version 120\n"
    "attribute vec3 place; attribute vec3 normal;\n"
    "uniform mat4 eye; uniform vec3 at; uniform mat3 turn; uniform vec4 flat_on;\n"
    "uniform vec4 colour; uniform vec3 look;\n"
    "uniform vec4 flat_x; uniform vec4 flat_y; varying vec4 c; varying vec2 on;\n"
    "const vec3 light = vec3(-0.40, -0.25, 0.88);\n"
    "void main() {\n"
    "  vec3 p = turn * place + at;\n"
    "  c = colour;\n"
    "  on = vec2(0.0);\n"
    "  if (flat_on.x != 0.0 || flat_on.y != 0.0 || flat_on.z != 0.0) {\n"
    "    p -= light * ((dot(flat_on.xyz, p) - flat_on.w) / dot(flat_on.xyz, light));\n"
    "    on = vec2(dot(flat_x.xyz, p) - flat_x.w, dot(flat_y.xyz, p) - flat_y.w);\n"
    "  } else {\n"
    "    vec3 u = normalize(turn * normal), v = normalize(look - p);\n"
    "    float up = 0.5 + 0.5 * u.z, lamp = max(dot(u, light), 0.0), face = max(dot(u, v), 0.0);\n"
    "    float side = 1.0 - face;\n"
    "    c.rgb *= (1.0 - 0.35 * side * side * side) *\n"
    "             (vec3(0.24, 0.23, 0.25) + vec3(0.22, 0.26, 0.29) * up + 0.50 * lamp + 0.22 * "
    "face);\n"
    "    c.rgb += 0.14 * pow(max(dot(u, normalize(light + v)), 0.0), 24.0);\n"
    "  }\n"
    "  gl_Position = eye * vec4(p, 1.0);\n"
    "}\n";
int gl_solid_open(struct gl_solid *g, char *error, size_t error_B)
{
    static const char *const batch[] = {"place", "ink", "where"}, *const mesh[] = {
                                                                      "place", "normal"};
    static const char *const text[GL_PROGRAMS] = {plain_text, floor_text, shade_text};
    gl_forms_make(&g->forms);
    for (int i = 0; i < GL_PROGRAMS; i++) {
        g->program[i] = gl_program(batch_text, text[i], batch, 3, error, error_B);
        if (g->program[i] == 0) { return 1; }
        g->program_eye[i] = glGetUniformLocation(g->program[i], "eye");
    }
    g->mesh_program = gl_program(mesh_text, shade_text, mesh, 2, error, error_B);
    if (g->mesh_program == 0) { return 1; }
    glGenBuffers(2, g->batch.buffer);
    g->eye = glGetUniformLocation(g->mesh_program, "eye");
    g->at = glGetUniformLocation(g->mesh_program, "at");
    g->turn = glGetUniformLocation(g->mesh_program, "turn");
    g->colour = glGetUniformLocation(g->mesh_program, "colour");
    g->flat = glGetUniformLocation(g->mesh_program, "flat_on");
    g->flat_x = glGetUniformLocation(g->mesh_program, "flat_x");
    g->flat_y = glGetUniformLocation(g->mesh_program, "flat_y");
    g->look = glGetUniformLocation(g->mesh_program, "look");
    return 0;
}

void gl_solid_close(struct gl_solid *g)
{
    gl_batch_close(&g->batch);
    free(g->order);
    free(g->depth);
}

/* --- meshes, each brought to the card once --- */

struct mesh_vertex {
    float place[3], normal[3];
};

static void to_float(float to[3], struct v3 v)
{
    to[0] = (float)v.x;
    to[1] = (float)v.y;
    to[2] = (float)v.z;
}

static GLuint mesh_buffer(struct gl_solid *g, const struct mesh *mesh)
{
    struct mesh_vertex *v;
    const size_t n = 3 * (size_t)mesh->triangles;
    for (int i = 0; i < g->meshes; i++) {
        if (g->mesh[i] == mesh) { return g->mesh_buffer[i]; }
    }
    v = g->meshes < GL_MESHES_MAX ? malloc(n * sizeof *v) : NULL;
    if (v == NULL) { return 0; }
    for (size_t i = 0; i < n; i++) {
        struct v3 on;
        const struct triangle *t = &mesh->triangle[i / 3];
        to_float(v[i].normal, mesh_normal(mesh, (int)(i / 3), &on));
        to_float(v[i].place, mesh->point[t->corner[i % 3]]);
    }
    g->mesh[g->meshes] = mesh;
    glGenBuffers(1, &g->mesh_buffer[g->meshes]);
    glBindBuffer(GL_ARRAY_BUFFER, g->mesh_buffer[g->meshes]);
    glBufferData(GL_ARRAY_BUFFER, (GLsizeiptr)(n * sizeof *v), v, GL_STATIC_DRAW);
    free(v);
    return g->mesh_buffer[g->meshes++];
}

static void mesh(struct gl_solid *g, const struct draw_item *i)
{
    const GLuint buffer = mesh_buffer(g, i->mesh);
    float f[9];
    if (buffer == 0) { return; }
    to_float(f, i->at.turn.x);
    to_float(f + 3, i->at.turn.y);
    to_float(f + 6, i->at.turn.z);
    glUniformMatrix3fv(g->turn, 1, GL_FALSE, f);
    to_float(f, i->at.at);
    glUniform3fv(g->at, 1, f);
    glBindBuffer(GL_ARRAY_BUFFER, buffer);
    for (GLuint k = 0; k < 3; k++) {
        (k < 2 ? glEnableVertexAttribArray : glDisableVertexAttribArray)(k);
    }
    glVertexAttribPointer(0, 3, GL_FLOAT, GL_FALSE, sizeof(struct mesh_vertex), (const void *)0);
    glVertexAttribPointer(
        1, 3, GL_FLOAT, GL_FALSE, sizeof(struct mesh_vertex), (const void *)(3 * sizeof(float)));
    glDrawArrays(GL_TRIANGLES, 0, 3 * i->mesh->triangles);
}

/* How far points are along n from `at`. */
static void set_plane(GLint to, struct v3 n, struct v3 at)
{
    glUniform4f(to, (float)n.x, (float)n.y, (float)n.z, (float)v3_dot(n, at));
}

static int mine(const struct gl_solid *g, const struct draw_item *i)
{
    return g->part & (i->still ? GL_PART_STILL : GL_PART_MOVING);
}

/* All meshes, or their shadows on a floor. */
static void meshes(struct gl_solid *g, const struct draw_list *l, const struct draw_item *floor)
{
    float eye[3];
    to_float(eye, l->eye);
    glUseProgram(g->mesh_program);
    glUniform3fv(g->look, 1, eye);
    if (floor) {
        const struct m3 *t = &floor->at.turn;
        const double edge = 1 / floor->size.x;
        set_plane(g->flat, t->z, v3_along(floor->at.at, 0.0003, t->z));
        set_plane(g->flat_x, v3_times(t->x, edge), floor->at.at);
        set_plane(g->flat_y, v3_times(t->y, edge), floor->at.at);
        glUniform4f(g->colour, 0.05F, 0.07F, 0.10F, 0.30F);
    } else {
        glUniform4f(g->flat, 0, 0, 0, 0);
    }
    for (int k = 0; k < l->items; k++) {
        const struct draw_item *i = &l->item[k];
        if (i->kind != DRAW_MESH || !mine(g, i)) { continue; }
        if (floor == NULL) { glUniform4fv(g->colour, 1, i->colour); }
        mesh(g, i);
    }
}

/* --- parts of the batch, in the order of painting --- */

/* How round is round: corners cost, too. Finest when pixels are sampled many times, for pictures
 * that stay; of the rest large objects; the palm least: outlines are the same. */
static int form_of(const struct gl_solid *g, const struct draw_item *i, int shade)
{
    switch (i->kind) {
    case DRAW_SQUARE: return GL_FORM_FLOOR;
    case DRAW_SPHERE:
    case DRAW_CAPSULE: break;
    case DRAW_BOX: return GL_FORM_BOX;
    case DRAW_DISC: return GL_FORM_DISC;
    case DRAW_MESH: return -1;
    }
    if (shade) { return g->fine || i->what == DRAW_OBJECT ? GL_FORM_SHADE : GL_FORM_DIM; }
    if (i->what == DRAW_WAY) { return GL_FORM_DOT; }
    if (g->fine || (i->what == DRAW_OBJECT && i->size.x > 0.018)) { return GL_FORM_FINE; }
    return i->hidden == 2 || (i->what == DRAW_HAND && i->which < 0) ? GL_FORM_TUBE : GL_FORM_BALL;
}

/* Not a finger's joint: those of the links beside it cover all but its rim. */
static int has_shadow(const struct draw_item *i)
{
    return i->what == DRAW_OBJECT || (i->what == DRAW_HAND && (i->which < 0 || i->size.z > 0));
}

static void add_bodies(struct gl_solid *g, const struct draw_list *l, const struct draw_item *floor)
{
    for (int k = 0; k < l->items; k++) {
        const struct draw_item *i = &l->item[k];
        const int form = form_of(g, i, floor != NULL);
        if (i->kind == DRAW_SQUARE || form < 0 || i->colour[3] < 1 || !mine(g, i)) { continue; }
        if (floor && !has_shadow(i)) { continue; }
        gl_batch_add(&g->batch, &g->forms, i, form, l->eye, floor);
    }
}

/* The floor that gets the shadows: the first that looks up. */
static const struct draw_item *floor_of(const struct draw_list *l)
{
    for (int k = 0; k < l->items; k++) {
        if (l->item[k].kind == DRAW_SQUARE && l->item[k].at.turn.z.z > 0.5) { return &l->item[k]; }
    }
    return NULL;
}

/* The middles of all floors, or all but the middles. */
static void add_floors(struct gl_solid *g, const struct draw_list *l, int middle)
{
    struct gl_form *f = &g->forms.form[GL_FORM_FLOOR];
    const struct gl_form all = *f;
    f->indices = middle ? GL_FLOOR_MIDDLE : all.indices - GL_FLOOR_MIDDLE;
    f->index += middle ? 0 : GL_FLOOR_MIDDLE;
    for (int k = 0; k < l->items; k++) {
        if (l->item[k].kind != DRAW_SQUARE || !mine(g, &l->item[k])) { continue; }
        gl_batch_add(&g->batch, &g->forms, &l->item[k], GL_FORM_FLOOR, l->eye, NULL);
    }
    *f = all;
}

static int more(struct gl_solid *g, int n)
{
    if (n <= g->room) { return 0; }
    free(g->order);
    free(g->depth);
    g->room = 2 * n;
    g->order = malloc((size_t)g->room * sizeof *g->order);
    g->depth = malloc((size_t)g->room * sizeof *g->depth);
    if (g->order && g->depth) { return 0; }
    g->room = 0;
    return 1;
}

/* What can be seen through, the farthest first. */
static void add_glasses(struct gl_solid *g, const struct draw_list *l)
{
    int n = 0;
    if (more(g, l->items)) { return; }
    for (int k = 0; k < l->items; k++) {
        const struct draw_item *i = &l->item[k];
        const double far = v3_len(v3_sub(i->at.at, l->eye));
        int j = n;
        if (i->kind == DRAW_SQUARE || form_of(g, i, 0) < 0 || i->colour[3] >= 1 || !mine(g, i)) {
            continue;
        }
        for (; j > 0 && g->depth[j - 1] < far; j--) {
            g->depth[j] = g->depth[j - 1];
            g->order[j] = g->order[j - 1];
        }
        g->depth[j] = far;
        g->order[j] = i;
        n++;
    }
    for (int k = 0; k < n; k++) {
        gl_batch_add(&g->batch, &g->forms, g->order[k], form_of(g, g->order[k], 0), l->eye, NULL);
    }
}

/* --- painting --- */

static void set_view(float e[16], const struct draw_list *l, double width, double height)
{
    const double f = 1 / tan(0.5 * 38 * 0.017453292519943295), lo = 0.02, hi = 20;
    const struct v3 z = v3_unit(v3_sub(l->eye, l->look)), x = v3_unit(v3_cross(v3(0, 0, 1), z));
    const struct v3 y = v3_cross(z, x);
    const double sx = f * height / width, a = (lo + hi) / (lo - hi), b = 2 * lo * hi / (lo - hi);
    const double ex = -v3_dot(x, l->eye), ey = -v3_dot(y, l->eye), ez = -v3_dot(z, l->eye);
    const double m[16] = {sx * x.x, f * y.x, a * z.x, -z.x, sx * x.y, f * y.y, a * z.y, -z.y,
        sx * x.z, f * y.z, a * z.z, -z.z, sx * ex, f * ey, a * ez + b, -ez};
    for (int i = 0; i < 16; i++) { e[i] = (float)m[i]; }
}

/* Where the batch will be seen, in pixels; all of the screen if some of it is beside the eye. */
static struct gl_patch reach(const struct gl_solid *g, int width, int height)
{
    const struct gl_patch all = {0, 0, width, height};
    const float *e = g->view;
    float x0 = 1, y0 = 1, x1 = -1, y1 = -1;
    for (int k = 0; k < g->batch.vertices; k++) {
        const float *p = g->batch.vertex[k].place;
        const float w = e[3] * p[0] + e[7] * p[1] + e[11] * p[2] + e[15];
        const float x = (e[0] * p[0] + e[4] * p[1] + e[8] * p[2] + e[12]) / w;
        const float y = (e[1] * p[0] + e[5] * p[1] + e[9] * p[2] + e[13]) / w;
        if (!(w > 0.001F)) { return all; }
        x0 = x < x0 ? x : x0;
        y0 = y < y0 ? y : y0;
        x1 = x > x1 ? x : x1;
        y1 = y > y1 ? y : y1;
    }
    if (x1 < x0 || y1 < y0) { return (struct gl_patch){0, 0, 0, 0}; }
    x0 = x0 < -1 ? -1 : x0;
    y0 = y0 < -1 ? -1 : y0;
    x1 = x1 > 1 ? 1 : x1;
    y1 = y1 > 1 ? 1 : y1;
    return (struct gl_patch){(int)((x0 + 1) * 0.5F * (float)width) - 2,
        (int)((y0 + 1) * 0.5F * (float)height) - 2, (int)((x1 + 1) * 0.5F * (float)width) + 3,
        (int)((y1 + 1) * 0.5F * (float)height) + 3};
}

static void fill(
    struct gl_solid *g, const struct draw_list *l, const struct draw_item *floor, int mark[])
{
    struct gl_batch *b = &g->batch;
    b->vertices = b->indices = 0;
    mark[GL_BODIES] = 0;
    add_bodies(g, l, NULL);
    mark[GL_MIDDLES] = b->indices;
    add_floors(g, l, 1);
    mark[GL_EDGES] = b->indices;
    add_floors(g, l, 0);
    mark[GL_SHADOWS] = b->indices;
    if (floor) { add_bodies(g, l, floor); }
    mark[GL_GLASSES] = b->indices;
    add_glasses(g, l);
    mark[GL_END] = b->indices;
}

static void section(struct gl_solid *g, int program, int which)
{
    if (g->mark[which] == g->mark[which + 1]) { return; }
    glUseProgram(g->program[program]);
    gl_batch_paint(&g->batch, GL_TRIANGLES, g->mark[which], g->mark[which + 1]);
}

/* Once a pixel, where the floor is seen. */
static void paint_shadows(
    struct gl_solid *g, const struct draw_list *l, const struct draw_item *floor)
{
    glEnable(GL_STENCIL_TEST);
    glStencilFunc(GL_EQUAL, 0, 0xFF);
    glStencilOp(GL_KEEP, GL_KEEP, GL_INCR);
    glEnable(GL_CULL_FACE);
    section(g, GL_SHADE, GL_SHADOWS);
    if (g->has_meshes) {
        meshes(g, l, floor);
        gl_batch_bind(&g->batch);
    }
    glDisable(GL_CULL_FACE);
    glDisable(GL_STENCIL_TEST);
}

static int has_meshes(const struct gl_solid *g, const struct draw_list *l)
{
    for (int k = 0; k < l->items; k++) {
        if (l->item[k].kind == DRAW_MESH && mine(g, &l->item[k])) { return 1; }
    }
    return 0;
}

struct gl_patch gl_solid_fill(
    struct gl_solid *g, const struct draw_list *l, int part, int width, int height)
{
    const struct draw_item *floor = floor_of(l);
    const struct gl_patch all = {0, 0, width, height};
    const int moves = floor && !floor->still; /* and on it all shadows */
    g->part = !moves ? part : part & GL_PART_MOVING ? GL_PART_ALL : 0;
    set_view(g->view, l, width, height);
    fill(g, l, floor, g->mark);
    g->has_meshes = has_meshes(g, l);
    return g->has_meshes ? all : reach(g, width, height);
}

/* What hides most comes first: pixels cost. */
static void paint_bodies(struct gl_solid *g, const struct draw_list *l)
{
    glEnable(GL_DEPTH_TEST);
    glEnable(GL_CULL_FACE);
    if (g->has_meshes) {
        glUseProgram(g->mesh_program);
        glUniformMatrix4fv(g->eye, 1, GL_FALSE, g->view);
        meshes(g, l, NULL);
    }
    gl_batch_send(&g->batch);
    gl_batch_bind(&g->batch);
    section(g, GL_PLAIN, GL_BODIES);
    glDisable(GL_CULL_FACE);
    section(g, GL_FLOOR, GL_MIDDLES);
}

static void paint_clear(struct gl_solid *g, const struct draw_list *l)
{
    const struct draw_item *floor = floor_of(l);
    glEnable(GL_BLEND);
    glBlendFunc(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA);
    section(g, GL_FLOOR, GL_EDGES);
    glDepthMask(GL_FALSE);
    if (floor) { paint_shadows(g, l, floor); }
    section(g, GL_PLAIN, GL_GLASSES);
    glDepthMask(GL_TRUE);
    glDisable(GL_BLEND);
    glDisable(GL_DEPTH_TEST);
}

void gl_solid_paint(struct gl_solid *g, const struct draw_list *l)
{
    for (int i = 0; i < GL_PROGRAMS; i++) {
        glUseProgram(g->program[i]);
        glUniformMatrix4fv(g->program_eye[i], 1, GL_FALSE, g->view);
    }
    paint_bodies(g, l);
    paint_clear(g, l);
}
