/* The gallery's pictures of terrain that Welkin draws: the site's heights and the road's class, in tiles. */
#include "land_shots.h"

#include <stdlib.h>

#include "shots.h"

#define CELL_M 8.0
#define TILE_CELLS 512
/* Tiles west and south of the site, and all of them along a side: the site is near the corner that the camera turns
 * its back to. */
#define FIRST_TILE_EAST (-7)
#define FIRST_TILE_NORTH (-6)
#define TILES 8
#define ROAD_HALF_WIDTH_M 6.0

static bool set_tile(demo *d, int east, int north, float *heights, uint8_t *classes)
{
    wk_terrain_cells cells = WK_TERRAIN_CELLS_INIT;
    cells.tile[0] = east, cells.tile[1] = north;
    for (int i = 0; i < TILE_CELLS * TILE_CELLS; i++) {
        double x = CELL_M * (east * TILE_CELLS + i % TILE_CELLS), y = CELL_M * (north * TILE_CELLS + i / TILE_CELLS);
        heights[i] = (float)ground_z(&d->scene.ground, x, y);
        classes[i] = fabs(ground_road_offset(x, y)) < ROAD_HALF_WIDTH_M ? WK_SURFACE_CLASS_PAVED : 0;
    }
    cells.heights_m = heights, cells.height_count = TILE_CELLS * TILE_CELLS;
    cells.surface_classes = classes, cells.surface_class_count = TILE_CELLS * TILE_CELLS;
    return weather_check(wk_context_set_terrain_tile(d->weather.context, &cells));
}

static bool set_land(demo *d)
{
    float *heights = malloc(sizeof *heights * TILE_CELLS * TILE_CELLS);
    uint8_t *classes = malloc(TILE_CELLS * TILE_CELLS);
    bool ok = heights && classes;
    for (int i = 0; ok && i < TILES * TILES; i++)
        ok = set_tile(d, FIRST_TILE_EAST + i % TILES, FIRST_TILE_NORTH + i / TILES, heights, classes);
    free(heights);
    free(classes);
    return ok;
}

static bool land_in_sun(demo *d, double azimuth_deg, double elevation_deg, double visibility_m)
{
    wk_terrain terrain = WK_TERRAIN_INIT;
    wk_terrain_drawing drawing = WK_TERRAIN_DRAWING_INIT;
    wk_weather w = WK_WEATHER_INIT;
    terrain.cell_m = CELL_M;
    terrain.tile_cells = TILE_CELLS;
    w.visibility_m = visibility_m;
    w.relative_humidity = 0.5;
    w.station_altitude_m = SITE_ALTITUDE_M;
    return weather_clock(&d->weather, HOURS[0].utc_s) && sun_at(d, azimuth_deg, elevation_deg) &&
           weather_check(wk_context_set_weather(d->weather.context, &w, 0.0, 0.0)) &&
           weather_check(wk_context_set_terrain(d->weather.context, &terrain)) && set_land(d) &&
           weather_check(wk_context_set_terrain_drawing(d->weather.context, &drawing));
}

bool drawn_land(demo *d)
{
    return land_in_sun(d, 150, 24, 30e3);
}

bool land_shadows(demo *d)
{
    return land_in_sun(d, SITE_VIEW_AZIMUTH_DEG - 235, 8, 90e3);
}
