/* A context of OpenGL or OpenGL ES without a window, by EGL, with three textures. */
#ifndef GL_TARGET_H
#define GL_TARGET_H

#include <stdbool.h>

typedef struct gl_target gl_target;

/* `way` is core or es with the digits of a version, as "core45". NULL where EGL has no such context. */
gl_target *gl_target_open(const char *way, int width, int height);
void gl_target_close(gl_target *t);
const void *gl_target_proc(void *user, const char *name);

unsigned gl_target_color(const gl_target *t);
unsigned gl_target_depth(const gl_target *t);
unsigned gl_target_classes(const gl_target *t);
bool gl_target_write(gl_target *t, const float *color, const float *depth, const unsigned char *classes);
bool gl_target_read(gl_target *t, float *color);

#endif
