/* A contact sheet: small copies of pictures in rows and columns, with captions. */
#ifndef SHEET_H
#define SHEET_H

#include <stdbool.h>
#include <stdint.h>

typedef struct sheet {
    uint8_t *rgb;
    int width, height;
    int cell_width, cell_height; /* of the small copies */
} sheet;

bool sheet_create(sheet *s, int columns, int rows, int cell_width, int cell_height);
void sheet_destroy(sheet *s);

/* Captions: above a column, and above a row of pictures. Upper case is all there is; the rest is left out. */
void sheet_title(sheet *s, int column, const char *text);
void sheet_caption(sheet *s, int row, const char *text);

/* A picture of any size that is a whole multiple of the cell's, averaged down. */
void sheet_put(sheet *s, int column, int row, const uint8_t *rgb, int width, int height);

/* Writes text onto any 8-bit picture: its upper left corner, `zoom` pixels a dot. */
void draw_text(uint8_t *rgb, int width, int height, int x, int y, int zoom, const char *text);

#endif
