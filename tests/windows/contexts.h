/* Two contexts of an OpenGL host, which share objects: by WGL (contexts_wgl.c) or GLX (contexts_glx.c). */
#ifndef WINDOWS_CONTEXTS_H
#define WINDOWS_CONTEXTS_H

#include <stdint.h>

/* Opens a window of so many pixels, without a frame, and two contexts, of which the host's is current. `core` asks for
 * a core profile of OpenGL 3.3 or later; else the driver's oldest way to make a context serves, which gives a
 * compatibility profile. */
void contexts_open(int width, int height, int core);
void contexts_close(void);

/* The function by which Welkin gets OpenGL's functions. */
const void *contexts_get_proc(void *user, const char *name);
int32_t contexts_make_current(void *user, uint32_t which);

#endif
