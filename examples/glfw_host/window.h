/* A window with keys, by GLFW. */
#ifndef WINDOW_H
#define WINDOW_H

#include <stdbool.h>

#include "platform.h"

/* Whether there is a display to open a window on. */
bool window_possible(void);

/* The two contexts of a window, visible or not, of which the host's is current; window_end closes them. False, with a
 * message on stderr, if there are none. */
bool window_contexts(platform *p, int width, int height, bool visible);
void window_end(void);

/*
 * Runs until the window is closed, or for `frames` frames if that is not 0, beginning with report `first` (from 1).
 * Answers the process's exit code.
 */
int window_run(const char *data, const char *planet, int width, int height, int frames, int first);

#endif
