/* A picture in 256 colours of its own: a third of the bytes, and its grain hides the steps of eight bits. */
#ifndef PALETTE_H
#define PALETTE_H

#include <stdbool.h>
#include <stdint.h>

typedef struct palette {
    uint8_t rgb[256][3];
    int count;
} palette;

/* Chooses the colours (median cut, Heckbert 1982) and writes one index a pixel, errors carried on (Floyd and Steinberg 1976). */
bool palette_choose(palette *p, const uint8_t *rgb, int width, int height, uint8_t *indices);

#endif
