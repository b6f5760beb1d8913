/* Converts a picture to 256 colours chosen for it. The file takes a third of the bytes, and the grain of the dither
 * hides 8-bit banding. */
#ifndef PALETTE_H
#define PALETTE_H

#include <stdbool.h>
#include <stdint.h>

typedef struct palette {
    uint8_t rgb[256][3];
    int count;
} palette;

/* Chooses the colours (median cut, Heckbert 1982) and writes one index per pixel with error diffusion (Floyd and
 * Steinberg 1976). */
bool palette_choose(palette *p, const uint8_t *rgb, int width, int height, uint8_t *indices);

#endif
