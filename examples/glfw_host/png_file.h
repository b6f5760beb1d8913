/* PNG files by libpng: reads 16-bit heights, writes 8-bit pictures. */
#ifndef PNG_FILE_H
#define PNG_FILE_H

#include <stdbool.h>
#include <stdint.h>

/* Reads a 16-bit grey picture; the caller frees *pixels. For any other file, returns false and prints a message on
 * stderr. */
bool png_read_grey16(const char *path, uint16_t **pixels, int *width, int *height);

/* Writes 8-bit RGB, top row first, display-encoded. */
bool png_write_rgb8(const char *path, const uint8_t *pixels, int width, int height);

/* Writes a picture of one index per pixel into a palette of at most 256 colours. */
bool png_write_indexed(const char *path, const uint8_t *indices, int width, int height, const uint8_t (*colors)[3], int count);

#endif
