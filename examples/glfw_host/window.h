/* A window with keyboard control, by GLFW. */
#ifndef WINDOW_H
#define WINDOW_H

#include <stdbool.h>

#include "demo.h"

/* Checks whether there is a display for a window. */
bool window_possible(void);

/* Creates the two contexts with a window, visible or not, and makes the host's current; window_end closes them. On
 * failure, returns false and prints a message on stderr. */
bool window_contexts(platform *p, int width, int height, bool visible);
void window_end(void);

/*
 * Runs until the window is closed, or for `frames` frames if that is not 0, starting with report `first` (counted from
 * 1). Returns the process's exit code.
 */
int window_run(const char *data, const demo_world *world, int width, int height, int frames, int first);

#endif
