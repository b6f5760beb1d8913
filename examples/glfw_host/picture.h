/* The host's picture: scene-linear colour and depth, and the 8-bit copy that people see. */
#ifndef PICTURE_H
#define PICTURE_H

#include "gl.h"

typedef struct picture {
    int width, height;
    GLuint color;   /* RGBA16F texture */
    GLuint depth;   /* DEPTH_COMPONENT32F texture */
    GLuint classes; /* R8 texture: what each pixel is made of, a wk_surface_class over 255 */
    GLuint frame;   /* framebuffer with all three */
    GLuint shown;   /* RGBA8 texture, display-encoded */
    GLuint shown_frame;
    GLuint program, array;
    bool reversed; /* depth 1 is near, 0 is infinitely far */
} picture;

bool picture_create(picture *p, int width, int height);
void picture_destroy(picture *p);

/*
 * Encodes the colour for the display into `shown`. `exposure` > 0: the colour is scene-linear, 1 - exp(-exposure x) maps
 * it; 0: it is tone-mapped already.
 */
void picture_present(const picture *p, float exposure);

/* Reads `shown`: width * height * 3 bytes, top row first. */
void picture_read(const picture *p, uint8_t *rgb);

#endif
