/*
 * The source of the OpenGL contexts: GLFW with a display, EGL without one. Both create two contexts: the host's own,
 * and a second one that shares its objects. Welkin draws in the second one, so it cannot change any of the host's
 * OpenGL state.
 */
#ifndef PLATFORM_H
#define PLATFORM_H

#include <stdbool.h>
#include <stdint.h>

#define CONTEXT_HOST 0
#define CONTEXT_WELKIN 1

typedef struct platform {
    /* Address of an OpenGL function, or NULL. */
    const void *(*get_proc)(void *user, const char *name);
    /* Makes one of the two contexts current on the calling thread; returns 0 on success. */
    int (*make_current)(void *user, uint32_t which);
    void *user;
} platform;

/* Creates contexts without a display. If this machine has no usable EGL, returns false and prints a message on
 * stderr. */
bool headless_open(platform *p);
void headless_close(platform *p);

#endif
