/* Reads an ESRI ASCII grid, and cuts it into Welkin's tiles. */
#include "terrain_file.h"

#include <ctype.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "ground.h"

#define TILE_CELLS 256
#define MOST_CELLS (16 * 1024 * 1024)
/* Where a file names no number for cells without a height; no height of the Earth. */
#define OWN_NO_DATA (-99999.0f)

typedef struct header {
    double columns, rows, cell_m, no_data;
} header;

static bool same_word(const char *a, const char *b)
{
    while (*a && tolower((unsigned char)*a) == tolower((unsigned char)*b))
        a++, b++;
    return *a == *b;
}

/* Reads the lines of a word and a number before the heights. Its corner may be anywhere: the terrain is put round the
 * origin. */
static bool read_header(FILE *file, const char *path, header *h)
{
    static const char *const IGNORED[] = {"xllcorner", "yllcorner", "xllcenter", "yllcenter"};
    char word[32];
    double value;
    *h = (header){0.0, 0.0, 0.0, OWN_NO_DATA};
    for (;;) {
        int first = fgetc(file);
        while (first != EOF && isspace(first))
            first = fgetc(file);
        ungetc(first, file);
        if (first == EOF || !isalpha(first))
            break;
        if (fscanf(file, "%31s %lf", word, &value) != 2) {
            fprintf(stderr, "%s: no number after a word of its header\n", path);
            return false;
        }
        bool ignored = false;
        for (size_t i = 0; i < sizeof IGNORED / sizeof *IGNORED; i++)
            ignored = ignored || same_word(word, IGNORED[i]);
        if (same_word(word, "ncols"))
            h->columns = value;
        else if (same_word(word, "nrows"))
            h->rows = value;
        else if (same_word(word, "cellsize"))
            h->cell_m = value;
        else if (same_word(word, "nodata_value"))
            h->no_data = value;
        else if (!ignored) {
            fprintf(stderr, "%s: \"%s\" is no word of an ESRI ASCII grid\n", path, word);
            return false;
        }
    }
    const bool whole = floor(h->columns) == h->columns && floor(h->rows) == h->rows;
    if (whole && h->columns >= 2.0 && h->rows >= 2.0 && h->columns * h->rows <= MOST_CELLS && h->cell_m > 0.0)
        return true;
    fprintf(stderr, "%s: ncols and nrows must be whole numbers from 2, with %d cells at most, and cellsize above 0, in metres\n",
            path, MOST_CELLS);
    return false;
}

bool terrain_file_read(terrain_file *t, const char *path)
{
    header h;
    *t = (terrain_file){0};
    FILE *file = fopen(path, "r");
    if (!file) {
        fprintf(stderr, "%s: cannot be read\n", path);
        return false;
    }
    bool ok = read_header(file, path, &h);
    if (ok) {
        *t = (terrain_file){NULL, (int)h.columns, (int)h.rows, h.cell_m, (float)h.no_data};
        const size_t count = (size_t)t->columns * (size_t)t->rows;
        size_t read = 0, known = 0;
        t->heights = malloc(count * sizeof *t->heights);
        while (t->heights && read < count && fscanf(file, "%f", &t->heights[read]) == 1) {
            if (isnan(t->heights[read]))
                t->heights[read] = t->no_data;
            known += t->heights[read++] != t->no_data;
        }
        ok = read == count && known > 0;
        if (!ok)
            fprintf(stderr, "%s: %zu of %zu heights, of which %zu are known\n", path, read, count, known);
    }
    fclose(file);
    return ok;
}

void terrain_file_free(terrain_file *t)
{
    free(t->heights);
    t->heights = NULL;
}

/* Height in the host's world, m, at a place of the grid. Its middle is the world's origin, because both Welkin's lattice
 * and this world are level there, and the Earth falls away below them. */
static double level_height(const terrain_file *t, int column, int row, double *x, double *y)
{
    *x = t->cell_m * (column - t->columns / 2);
    *y = t->cell_m * (t->rows / 2 - row);
    return t->heights[row * t->columns + column] - (*x * *x + *y * *y) / (2.0 * EARTH_RADIUS_M);
}

vec3 terrain_file_ground(const terrain_file *t, double x, double y)
{
    vec3 nearest = vec(0, 0, 0);
    double least = INFINITY;
    for (int row = 0; row < t->rows; row++)
        for (int column = 0; column < t->columns; column++) {
            double east, north, z = level_height(t, column, row, &east, &north);
            double away = hypot(east - x, north - y);
            if (t->heights[row * t->columns + column] != t->no_data && away < least)
                least = away, nearest = vec(east, north, z);
        }
    return nearest;
}

/* Tile whose south-western cell is `east` and `north` cells from the middle. What lies outside the grid has no height. */
static wk_status set_tile(const terrain_file *t, wk_context *context, int east, int north, float *heights)
{
    wk_terrain_cells cells = WK_TERRAIN_CELLS_INIT;
    bool any = false;
    for (int i = 0; i < TILE_CELLS * TILE_CELLS; i++) {
        int column = t->columns / 2 + east + i % TILE_CELLS, row = t->rows / 2 - (north + i / TILE_CELLS);
        bool inside = column >= 0 && column < t->columns && row >= 0 && row < t->rows;
        bool known = inside && t->heights[row * t->columns + column] != t->no_data;
        double x, y;
        heights[i] = known ? (float)level_height(t, column, row, &x, &y) : OWN_NO_DATA;
        any = any || known;
    }
    cells.tile[0] = east / TILE_CELLS, cells.tile[1] = north / TILE_CELLS;
    cells.heights_m = heights, cells.height_count = TILE_CELLS * TILE_CELLS;
    cells.has_no_data = 1, cells.no_data_m = OWN_NO_DATA;
    return any ? wk_context_set_terrain_tile(context, &cells) : WK_OK;
}

wk_status terrain_file_set(const terrain_file *t, wk_context *context)
{
    wk_terrain terrain = WK_TERRAIN_INIT;
    wk_terrain_drawing drawing = WK_TERRAIN_DRAWING_INIT;
    terrain.cell_m = t->cell_m, terrain.tile_cells = TILE_CELLS;
    /* Whole tiles on both sides of the middle. */
    const int west = (t->columns / 2 + TILE_CELLS - 1) / TILE_CELLS * TILE_CELLS;
    const int south = (t->rows / 2 + TILE_CELLS - 1) / TILE_CELLS * TILE_CELLS;
    float *heights = malloc(sizeof *heights * TILE_CELLS * TILE_CELLS);
    wk_status status = heights ? wk_context_set_terrain(context, &terrain) : WK_ERROR_OUT_OF_MEMORY;
    for (int north = -south; status == WK_OK && north <= south; north += TILE_CELLS)
        for (int east = -west; status == WK_OK && east <= west; east += TILE_CELLS)
            status = set_tile(t, context, east, north, heights);
    free(heights);
    return status == WK_OK ? wk_context_set_terrain_drawing(context, &drawing) : status;
}
