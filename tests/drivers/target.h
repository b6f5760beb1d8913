/* The host's side: a device by a named way, and the images that Welkin draws into. */
#ifndef TARGET_H
#define TARGET_H

#include <stdbool.h>
#include <welkin.h>

enum { WIDTH = 320, HEIGHT = 180, PIXELS = WIDTH * HEIGHT };

typedef struct target target;

/*
 * Opens a device: "vulkan" and "gl" are Welkin's own, "es31" and "es30" wrap a context of OpenGL ES that is made here by
 * EGL, "core45" and "core33" one of OpenGL. NULL, with a line on standard error, where that is not to be had.
 */
target *target_open(const char *way);
void target_close(target *t);

wk_device *target_device(target *t);
/* Whether the first row of the pixels is the picture's lowest. */
bool target_upside_down(const target *t);

/* Fills the images; colour has four floats a pixel. */
bool target_write(target *t, const float *color, const float *depth, const unsigned char *classes);
/* The frame's images, valid until the next call. */
const void *target_images(target *t);
bool target_read(target *t, float *color);

#endif
