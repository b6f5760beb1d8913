/* The host's window: made, moved and looked at by the window system's own functions. Nothing here knows how Welkin
 * draws. */
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
    wk_window named; /* its handles, as Welkin is told them */
    uint32_t width, height;
    bool open, resized;     /* resized: since the host last looked */
    bool dragged;           /* with the left button, since the host last looked: */
    double drag_x, drag_y;  /* to here, as shares of the window's width and height */
} host_window;

/* Ends the program with a sentence where there is no display. */
void window_open(host_window *w, uint32_t width, uint32_t height);
/* Takes what happened since the last call. */
void window_take_events(host_window *w);
void window_resize(host_window *w, uint32_t width, uint32_t height);
void window_show(host_window *w, bool shown);
void window_close(host_window *w);

/* What the screen shows of the window: width * height * 3 bytes from the top row on, to be freed. */
unsigned char *window_pixels(host_window *w);

void window_sleep_ms(unsigned ms);

#endif
