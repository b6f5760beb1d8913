/* A contact sheet: small copies of pictures in rows and columns, with captions. */
#ifndef SHEET_H
#define SHEET_H

#include <stdbool.h>
#include <stdint.h>

typedef struct sheet {
    uint8_t *rgb;
    int width, height;
    int cell_width, cell_height; /* size of the small copies */
} sheet;

bool sheet_create(sheet *s, int columns, int rows, int cell_width, int cell_height);
void sheet_destroy(sheet *s);

/* Write a caption above a column or a row of pictures. The font has upper case only; characters that it lacks become
 * spaces. */
void sheet_title(sheet *s, int column, const char *text);
void sheet_caption(sheet *s, int row, const char *text);

/* Adds a picture, averaged down. Its size must be a whole multiple of the cell's. */
void sheet_put(sheet *s, int column, int row, const uint8_t *rgb, int width, int height);

/* Writes text onto any 8-bit picture, from its upper left corner, with `zoom` pixels per dot. */
void draw_text(uint8_t *rgb, int width, int height, int x, int y, int zoom, const char *text);

#endif
