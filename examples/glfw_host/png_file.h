/* PNG files by libpng: 16-bit heights in, 8-bit pictures out. */
#ifndef PNG_FILE_H
#define PNG_FILE_H

#include <stdbool.h>
#include <stdint.h>

/* Reads a 16-bit grey picture; *pixels is for free(). False, with a message on stderr, if it is not one. */
bool png_read_grey16(const char *path, uint16_t **pixels, int *width, int *height);

/* Writes 8-bit RGB, top row first, display-encoded. */
bool png_write_rgb8(const char *path, const uint8_t *pixels, int width, int height);

/* The same as one index a pixel into at most 256 colours. */
bool png_write_indexed(const char *path, const uint8_t *indices, int width, int height, const uint8_t (*colors)[3], int count);

#endif
