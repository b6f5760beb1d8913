/*
 * Who made the OpenGL contexts: GLFW where there is a display, EGL where there is none. Both make two, the host's own
 * and a second one that shares its objects, in which Welkin draws: so none of the host's OpenGL state can change.
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
    /* Makes one of the two contexts current on the calling thread; 0 if that went well. */
    int (*make_current)(void *user, uint32_t which);
    void *user;
} platform;

/* Contexts without any display. False, with a message on stderr, if this machine has no EGL that serves. */
bool headless_open(platform *p);
void headless_close(platform *p);

#endif
