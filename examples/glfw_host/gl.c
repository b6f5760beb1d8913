/* OpenGL function pointers and shader compilation. */
#include "gl.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define GL_DEFINE(name, type) type name;
GL_FUNCTIONS(GL_DEFINE)
#undef GL_DEFINE
PFNGLCLIPCONTROLPROC glClipControl;

/* ISO C has no cast from an object pointer to a function pointer. Copying the bytes works on every system with
 * OpenGL. */
static void get(const platform *p, const char *name, void *function, size_t size)
{
    const void *address = p->get_proc(p->user, name);
    memcpy(function, &address, size);
}

bool gl_load(const platform *p)
{
#define GL_LOAD(name, type)                                        \
    get(p, #name, &name, sizeof name);                             \
    if (!name) {                                                   \
        fprintf(stderr, "this OpenGL context has no " #name "\n"); \
        return false;                                              \
    }
    GL_FUNCTIONS(GL_LOAD)
#undef GL_LOAD
    get(p, "glClipControl", &glClipControl, sizeof glClipControl);
    return true;
}

static GLuint compile(GLenum kind, const char *const *parts, GLsizei count)
{
    GLuint shader = glCreateShader(kind);
    glShaderSource(shader, count, parts, NULL);
    glCompileShader(shader);
    GLint ok = 0;
    glGetShaderiv(shader, GL_COMPILE_STATUS, &ok);
    if (!ok) {
        char log[2048];
        glGetShaderInfoLog(shader, sizeof log, NULL, log);
        fprintf(stderr, "shader: %s\n", log);
        exit(1);
    }
    return shader;
}

GLuint gl_program(const char *vertex, const char *fragment, const char *fragment_end)
{
    const char *const parts[] = {fragment, fragment_end};
    GLuint v = compile(GL_VERTEX_SHADER, &vertex, 1), f = compile(GL_FRAGMENT_SHADER, parts, fragment_end ? 2 : 1);
    GLuint program = glCreateProgram();
    glAttachShader(program, v);
    glAttachShader(program, f);
    glLinkProgram(program);
    glDeleteShader(v);
    glDeleteShader(f);
    GLint ok = 0;
    glGetProgramiv(program, GL_LINK_STATUS, &ok);
    if (!ok) {
        char log[2048];
        glGetProgramInfoLog(program, sizeof log, NULL, log);
        fprintf(stderr, "program: %s\n", log);
        exit(1);
    }
    return program;
}
