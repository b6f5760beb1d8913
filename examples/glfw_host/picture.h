/* The host's picture: scene-linear colour and depth, and the 8-bit copy for display. */
#ifndef PICTURE_H
#define PICTURE_H

#include "gl.h"

typedef struct picture {
    int width, height;             /* size of the drawn picture */
    int shown_width, shown_height; /* size of the displayed picture; smaller if the drawn one is supersampled */
    GLuint color;   /* RGBA16F texture */
    GLuint depth;   /* DEPTH_COMPONENT32F texture */
    GLuint classes; /* R8 texture: surface class of each pixel, a wk_surface_class over 255 */
    GLuint frame;   /* framebuffer with colour, depth and classes */
    GLuint shown;   /* RGBA8 texture, display-encoded */
    GLuint shown_frame;
    GLuint program, array;
    bool plain;    /* without the grain that hides 8-bit banding, which would make a PNG three times as large */
    bool reversed; /* depth 1 is near, 0 is infinitely far away */
} picture;

/* `finer` is the number of samples along each side of a displayed pixel: 1, or 2 for smooth edges. */
bool picture_create(picture *p, int width, int height, int finer);
void picture_destroy(picture *p);

/*
 * Averages the samples of each displayed pixel and encodes them for the display into `shown`. With `exposure` > 0 the
 * colour is scene-linear and is mapped by 1 - exp(-exposure x); with 0 it is tone-mapped already.
 */
void picture_present(const picture *p, float exposure);

/* Reads `shown`: shown_width * shown_height * 3 bytes, top row first. */
void picture_read(const picture *p, uint8_t *rgb);

#endif
