/* The host's window: created, resized and read through the window system's own functions. This file does not depend on
 * how Welkin draws. */
#ifndef WINDOW_HOST_WINDOW_H
#define WINDOW_HOST_WINDOW_H

#include "welkin.h"

#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>

#define EXPECT(condition, ...)                                              \
    do {                                                                    \
        if (!(condition)) {                                                 \
            fprintf(stderr, "%s:%d: %s: ", __FILE__, __LINE__, #condition); \
            fprintf(stderr, __VA_ARGS__);                                   \
            fputc('\n', stderr);                                            \
            exit(1);                                                        \
        }                                                                   \
    } while (0)

typedef struct host_window {
    wk_window named; /* its handles, as given to Welkin */
    uint32_t width, height;
    bool open, resized;     /* resized: since the host last checked */
    bool dragged;           /* with the left button, since the host last checked: */
    double drag_x, drag_y;  /* to this point, as fractions of the window's width and height */
} host_window;

/* Opens a window. Without a display, ends the program with a message. */
void window_open(host_window *w, uint32_t width, uint32_t height);
/* Handles the events since the last call. */
void window_take_events(host_window *w);
void window_resize(host_window *w, uint32_t width, uint32_t height);
void window_show(host_window *w, bool shown);
void window_close(host_window *w);

/* Pixels of the window as the screen shows them: width * height * 3 bytes, top row first. The caller frees them. */
unsigned char *window_pixels(host_window *w);

void window_sleep_ms(unsigned ms);

#endif
