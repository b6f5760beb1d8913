/* The host's picture: scene-linear colour and depth, and the 8-bit copy that people see. */
#ifndef PICTURE_H
#define PICTURE_H

#include "gl.h"

typedef struct picture {
    int width, height;             /* of what is drawn */
    int shown_width, shown_height; /* of what people see: smaller where the picture is drawn finer */
    GLuint color;   /* RGBA16F texture */
    GLuint depth;   /* DEPTH_COMPONENT32F texture */
    GLuint classes; /* R8 texture: what each pixel is made of, a wk_surface_class over 255 */
    GLuint frame;   /* framebuffer with all three */
    GLuint shown;   /* RGBA8 texture, display-encoded */
    GLuint shown_frame;
    GLuint program, array;
    bool plain;    /* without the grain that hides the steps of eight bits: as a PNG it would be three times as large */
    bool reversed; /* depth 1 is near, 0 is infinitely far */
} picture;

/* `finer` samples along each side of a shown pixel: 1, or 2 for a picture whose edges are smooth. */
bool picture_create(picture *p, int width, int height, int finer);
void picture_destroy(picture *p);

/*
 * Averages the samples of each shown pixel and encodes them for the display into `shown`. `exposure` > 0: the colour is scene-linear, 1 - exp(-exposure x) maps
 * it; 0: it is tone-mapped already.
 */
void picture_present(const picture *p, float exposure);

/* Reads `shown`: shown_width * shown_height * 3 bytes, top row first. */
void picture_read(const picture *p, uint8_t *rgb);

#endif
