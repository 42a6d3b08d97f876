/* SPDX-License-Identifier: MIT */
/* A program of shaders for the graphics card, with the reason where it has none. */
#include "gl.h"

static GLuint shader(GLenum kind, const char *text, char *error, size_t error_B)
{
    const GLuint s = glCreateShader(kind);
    GLint ok;
    glShaderSource(s, 1, &text, NULL);
    glCompileShader(s);
    glGetShaderiv(s, GL_COMPILE_STATUS, &ok);
    if (!ok) {
        GLsizei n;
        glGetShaderInfoLog(s, (GLsizei)error_B, &n, error);
    }
    return ok ? s : 0;
}

GLuint gl_program(const char *vertex, const char *fragment, const char *const *attribute, int n,
    char *error, size_t error_B)
{
    const GLuint v = shader(GL_VERTEX_SHADER, vertex, error, error_B);
    const GLuint f = v ? shader(GL_FRAGMENT_SHADER, fragment, error, error_B) : 0;
    const GLuint p = f ? glCreateProgram() : 0;
    GLint ok = 0;
    if (p == 0) { return 0; }
    glAttachShader(p, v);
    glAttachShader(p, f);
    for (int i = 0; i < n; i++) { glBindAttribLocation(p, (GLuint)i, attribute[i]); }
    glLinkProgram(p);
    glGetProgramiv(p, GL_LINK_STATUS, &ok);
    if (!ok) { glGetProgramInfoLog(p, (GLsizei)error_B, NULL, error); }
    return ok ? p : 0;
}
