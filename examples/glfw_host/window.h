/* A window with keyboard control, by GLFW. */
#ifndef WINDOW_H
#define WINDOW_H

#include <stdbool.h>

#include "platform.h"

/* Checks whether there is a display for a window. */
bool window_possible(void);

/* Creates the two contexts with a window, visible or not, and makes the host's current; window_end closes them. On
 * failure, returns false and prints a message on stderr. */
bool window_contexts(platform *p, int width, int height, bool visible);
void window_end(void);

/*
 * Runs until the window is closed, or for `frames` frames if that is not 0, starting with report `first` (counted from
 * 1), on the open sea if `at_sea`. Returns the process's exit code.
 */
int window_run(const char *data, const char *planet, int width, int height, int frames, int first, bool at_sea);

#endif
