/* A terrain from a file of heights, which Welkin draws in place of the host's: an ESRI ASCII grid in metres, as
 * `gdal_translate -of AAIGrid` writes it. */
#ifndef TERRAIN_FILE_H
#define TERRAIN_FILE_H

#include <stdbool.h>

#include "vec.h"
#include "welkin.h"

typedef struct terrain_file {
    float *heights; /* m above sea level, from west to east, then from north to south */
    int columns, rows;
    double cell_m;
    float no_data; /* number of cells without a height */
} terrain_file;

/* If the file cannot be read, prints on stderr what is wrong with it, and returns false. */
bool terrain_file_read(terrain_file *t, const char *path);
void terrain_file_free(terrain_file *t);

/* Point of the ground in the host's world, m, nearest to one east and north of the middle. */
vec3 terrain_file_ground(const terrain_file *t, double x, double y);

/* Hands the heights over in tiles, and has Welkin draw them. */
wk_status terrain_file_set(const terrain_file *t, wk_context *context);

#endif
