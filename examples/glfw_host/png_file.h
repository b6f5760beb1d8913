/* PNG files by libpng: 16-bit heights in, 8-bit pictures out. */
#ifndef PNG_FILE_H
#define PNG_FILE_H

#include <stdbool.h>
#include <stdint.h>

/* Reads a 16-bit grey picture; *pixels is for free(). False, with a message on stderr, if it is not one. */
bool png_read_grey16(const char *path, uint16_t **pixels, int *width, int *height);

/* Writes 8-bit RGB, top row first, display-encoded. */
bool png_write_rgb8(const char *path, const uint8_t *pixels, int width, int height);

/* The same in 256 colours that are chosen for the picture: a third of the size. */
bool png_write_palette(const char *path, const uint8_t *pixels, int width, int height);

#endif
