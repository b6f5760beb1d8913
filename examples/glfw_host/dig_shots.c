/* A trench that a bucket digs in seven passes, on fine tiles around the pad. */
#include "dig_shots.h"

#include <stdlib.h>

#include "shots.h"

#define CELL_M 0.125
#define TILE_CELLS 512
#define TILES 4
#define WIDTH_M 1.25
#define MOUTH_M 1.1
#define PASSES 7
#define CUT_M 0.15
/* Of the arm; the excavator faces this way. */
#define ARM_AZIMUTH_DEG (SITE_VIEW_AZIMUTH_DEG + 58.0)

/* The bucket at a time: middle of its edge, direction in which it is drawn, and how far it is curled: 0 with its
 * opening ahead, 90 with its opening up, -90 down. */
typedef struct stroke {
    double seconds;
    vec3 edge, ahead;
    double curl_deg;
} stroke;

static void copy(double to[3], vec3 from) { to[0] = from.x, to[1] = from.y, to[2] = from.z; }

static wk_soil_pose pose_of(const stroke *s, double time_s)
{
    double c = cos(RAD(s->curl_deg)), n = sin(RAD(s->curl_deg));
    vec3 left = scale(vec(-s->ahead.y, s->ahead.x, 0.0), 0.5 * WIDTH_M);
    vec3 upper = add(s->edge, scale(add(scale(s->ahead, -n), vec(0, 0, c)), MOUTH_M));
    wk_soil_pose p = WK_SOIL_POSE_INIT;
    p.time_s = time_s;
    copy(p.edge_left_m, add(s->edge, left)), copy(p.edge_right_m, sub(s->edge, left));
    copy(p.upper_left_m, add(upper, left)), copy(p.upper_right_m, sub(upper, left));
    copy(p.facing, add(scale(s->ahead, c), vec(0, 0, n)));
    return p;
}

static bool set_tiles(demo *d, vec3 pad)
{
    wk_terrain terrain = WK_TERRAIN_INIT;
    wk_terrain_cells cells = WK_TERRAIN_CELLS_INIT;
    const double half_m = 0.5 * TILES * TILE_CELLS * CELL_M;
    copy(terrain.origin_m, sub(pad, vec(half_m, half_m, 0.0)));
    terrain.cell_m = CELL_M, terrain.tile_cells = TILE_CELLS;
    float *heights = malloc(sizeof *heights * TILE_CELLS * TILE_CELLS);
    bool ok = heights && weather_check(wk_context_set_terrain(d->weather.context, &terrain));
    for (int tile = 0; ok && tile < TILES * TILES; tile++) {
        cells.tile[0] = tile % TILES, cells.tile[1] = tile / TILES;
        for (int i = 0; i < TILE_CELLS * TILE_CELLS; i++) {
            double x = CELL_M * (cells.tile[0] * TILE_CELLS + i % TILE_CELLS);
            double y = CELL_M * (cells.tile[1] * TILE_CELLS + i / TILE_CELLS);
            double z = ground_z(&d->scene.ground, terrain.origin_m[0] + x, terrain.origin_m[1] + y);
            heights[i] = (float)(z - pad.z);
        }
        cells.heights_m = heights, cells.height_count = TILE_CELLS * TILE_CELLS;
        ok = weather_check(wk_context_set_terrain_tile(d->weather.context, &cells));
    }
    free(heights);
    return ok;
}

/* Topsoil on clay, whose walls stand as deep as the trench. */
static bool set_soil(demo *d)
{
    const double tops_m[2] = {0.0, 0.3};
    const wk_soil_kind_id kinds[2] = {WK_SOIL_TOPSOIL, WK_SOIL_CLAY};
    wk_soil soil = WK_SOIL_INIT;
    soil.horizon_tops_m = tops_m, soil.horizon_kinds = kinds, soil.horizon_count = 2;
    return weather_check(wk_context_set_soil(d->weather.context, &soil));
}

/* Advances the soil to the present time; a call does as many steps as fit into its time. */
static bool settle(demo *d)
{
    wk_status status;
    do
        status = wk_context_update(d->weather.context, d->time_s);
    while (status == WK_PENDING);
    return weather_check(status);
}

/* Sends the strokes of a pass, and lets the soil follow them. */
static bool work(demo *d, uint32_t tool, const stroke *strokes, int count)
{
    for (int i = 0; i < count; i++) {
        d->time_s += strokes[i].seconds;
        wk_soil_pose pose = pose_of(&strokes[i], d->time_s);
        if (!weather_check(wk_context_move_soil_tool(d->weather.context, tool, &pose)) ||
            !settle(d))
            return false;
    }
    return true;
}

static bool dig(demo *d, vec3 pad)
{
    vec3 out = direction(ARM_AZIMUTH_DEG, 0.0), back = scale(out, -1.0), aside = direction(ARM_AZIMUTH_DEG + 90.0, 0.0);
    vec3 heap = add(scale(out, 2.0), scale(aside, 6.0)), away = scale(heap, -1.0 / sqrt(dot(heap, heap)));
    wk_soil_tool bucket = WK_SOIL_TOOL_INIT;
    bucket.struck_m3 = 1.2;
    stroke ready = {0.0, add(pad, add(scale(out, 9.6), vec(0, 0, 0.5))), back, 15.0};
    wk_soil_pose first = pose_of(&ready, d->time_s);
    uint32_t tool;
    if (!weather_check(wk_context_add_soil_tool(d->weather.context, &bucket, &first, &tool)))
        return false;
    for (int pass = 0; pass < PASSES; pass++) {
        double depth = -CUT_M * (pass + 1);
        vec3 over = add(pad, add(heap, scale(aside, 0.4 * (pass % 3 - 1))));
        const stroke strokes[] = {
            {1.0, add(pad, add(scale(out, 9.4), vec(0, 0, depth))), back, 15.0},
            {3.0, add(pad, add(scale(out, 4.8), vec(0, 0, depth))), back, 15.0},
            {1.0, add(pad, add(scale(out, 4.6), vec(0, 0, 0.6))), back, 85.0},
            {2.0, add(over, vec(0, 0, 2.6)), away, 90.0},
            {1.5, add(over, vec(0, 0, 2.4)), away, -60.0},
            {1.0, add(over, vec(0, 0, 2.4)), away, -75.0},
            {2.0, ready.edge, back, 15.0},
        };
        if (!work(d, tool, strokes, sizeof strokes / sizeof strokes[0]))
            return false;
    }
    d->time_s += 5.0;
    return weather_check(wk_context_end_soil_tool(d->weather.context, tool)) && settle(d);
}

bool dug_soil(demo *d)
{
    wk_terrain_drawing drawing = WK_TERRAIN_DRAWING_INIT;
    wk_weather w = WK_WEATHER_INIT;
    double x, y;
    ground_pad(&x, &y);
    vec3 pad = vec(x, y, ground_z(&d->scene.ground, x, y));
    w.visibility_m = 25e3;
    w.relative_humidity = 0.5;
    w.station_altitude_m = SITE_ALTITUDE_M;
    return weather_clock(&d->weather, HOURS[0].utc_s) && sun_at(d, ARM_AZIMUTH_DEG - 20.0, 26) &&
           weather_check(wk_context_set_weather(d->weather.context, &w, 0.0, 0.0)) && set_tiles(d, pad) &&
           set_soil(d) && settle(d) && dig(d, pad) &&
           weather_check(wk_context_set_terrain_drawing(d->weather.context, &drawing));
}
