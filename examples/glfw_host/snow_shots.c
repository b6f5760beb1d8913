/* Lying snow, simulated through the hours of a night and a morning on the site's own terrain. */
#include "snow_shots.h"

#include <stdlib.h>

#include "shots.h"

#define NODES 512
#define CELL_M 0.5
#define ROAD_HALF_WIDTH_M 4.0

/* Replaces the demo's context by one for the site that simulates snow. */
static bool begin(demo *d)
{
    wk_simulation_desc simulation = WK_SIMULATION_DESC_INIT;
    wk_context_desc place = WK_CONTEXT_DESC_INIT;
    simulation.lying_snow_model = WK_LYING_SNOW_SIMULATED;
    simulation.ground_model = WK_GROUND_SIMULATED;
    place.next = &simulation;
    place.world_kind = WK_WORLD_TANGENT;
    place.latitude_deg = SITE_LATITUDE_DEG;
    place.longitude_deg = SITE_LONGITUDE_DEG;
    return weather_check(wk_view_destroy(d->weather.view)) && weather_check(wk_context_destroy(d->weather.context)) &&
           weather_check(wk_context_create(d->weather.device, &place, &d->weather.context)) &&
           weather_check(wk_view_create(d->weather.context, NULL, &d->weather.view));
}

/* Heights and surface classes of the ground around the pad. */
static bool tell_ground(demo *d)
{
    const ground *g = &d->scene.ground;
    wk_ground_grid grid = WK_GROUND_GRID_INIT;
    float *heights = malloc(sizeof *heights * NODES * NODES);
    uint8_t *classes = malloc(NODES * NODES);
    double x, y;
    ground_pad(&x, &y);
    grid.origin_m[0] = x - 0.5 * CELL_M * NODES, grid.origin_m[1] = y - 0.5 * CELL_M * NODES;
    grid.origin_m[2] = ground_z(g, x, y);
    for (int i = 0; heights && classes && i < NODES * NODES; i++) {
        double east = grid.origin_m[0] + CELL_M * (i % NODES), north = grid.origin_m[1] + CELL_M * (i / NODES);
        heights[i] = (float)(ground_z(g, east, north) - grid.origin_m[2]);
        bool paved = fabs(ground_road_offset(east, north)) < ROAD_HALF_WIDTH_M;
        classes[i] = paved ? WK_SURFACE_CLASS_PAVED : 0;
    }
    grid.cell_m = CELL_M;
    grid.nodes[0] = grid.nodes[1] = NODES;
    grid.heights_m = heights, grid.height_count = NODES * NODES;
    grid.surface_classes = classes, grid.surface_class_count = NODES * NODES;
    bool ok = heights && classes && weather_check(wk_context_set_ground_grid(d->weather.context, &grid));
    free(heights);
    free(classes);
    return ok;
}

/* Sets the weather from now on. */
static bool weather_from(demo *d, double from_deg, double temperature_c, double snow_mm_h, double wind_m_s, double cover)
{
    wk_weather w = WK_WEATHER_INIT;
    wk_cloud_layer cloud = WK_CLOUD_LAYER_INIT;
    w.station_altitude_m = SITE_ALTITUDE_M;
    w.visibility_m = snow_mm_h > 0.0 ? 1200.0 : 40e3;
    w.relative_humidity = 0.8;
    w.temperature_c = temperature_c;
    w.wind_speed_m_s = wind_m_s;
    w.wind_from_deg = from_deg;
    w.precipitation_kind = snow_mm_h > 0.0 ? WK_PRECIPITATION_SNOW : WK_PRECIPITATION_NONE;
    w.precipitation_rate_mm_h = snow_mm_h;
    cloud.kind = snow_mm_h > 0.0 ? WK_CLOUD_NIMBOSTRATUS : WK_CLOUD_CIRRUS;
    cloud.cover = cover;
    cloud.base_m = snow_mm_h > 0.0 ? 600.0 : 8000.0;
    w.clouds = &cloud;
    w.cloud_count = cover > 0.0 ? 1 : 0;
    return weather_check(wk_context_set_weather(d->weather.context, &w, d->time_s, 0.0));
}

/* As weather_from, with wind from the right as seen from the hillside. */
static bool weather(demo *d, double temperature_c, double snow_mm_h, double wind_m_s, double cover)
{
    return weather_from(d, SITE_VIEW_AZIMUTH_DEG + 80.0, temperature_c, snow_mm_h, wind_m_s, cover);
}

static bool hours(demo *d, double count)
{
    d->time_s += 3600.0 * count;
    return weather_check(wk_context_accumulate(d->weather.context, count));
}

/* Two tracks from the excavator back to the road. */
static bool drive(demo *d)
{
    const ground *g = &d->scene.ground;
    double x, y;
    ground_pad(&x, &y);
    vec3 back = direction(SITE_VIEW_AZIMUTH_DEG + 70.0 + 180.0, 0.0), side = vec(back.y, -back.x, 0.0);
    for (int i = -1; i <= 1; i += 2) {
        double points[12][3];
        for (int k = 0; k < 12; k++) {
            double away = 2.5 * k - 3.0, aside = 1.2 * i + 0.035 * k * k;
            points[k][0] = x + away * back.x + aside * side.x;
            points[k][1] = y + away * back.y + aside * side.y;
            points[k][2] = ground_z(g, points[k][0], points[k][1]);
        }
        wk_snow_strip strip = WK_SNOW_STRIP_INIT;
        strip.points_m = (const double(*)[3])points;
        strip.point_count = 12;
        strip.width_m = 0.9;
        if (!weather_check(wk_context_press_snow(d->weather.context, &strip)))
            return false;
    }
    return true;
}

static bool night(demo *d)
{
    return begin(d) && tell_ground(d) && sun_at(d, 60, -20) && weather(d, -5.0, 3.0, 9.0, 1.0) && hours(d, 6.0) &&
           drive(d);
}

bool after_a_night(demo *d) { return night(d) && weather(d, -6.0, 0.0, 1.0, 0.3) && sun_at(d, 160, 16); }

bool thaw(demo *d)
{
    return night(d) && weather(d, 7.0, 0.0, 3.0, 0.0) && sun_at(d, 170, 30) && hours(d, 5.0) &&
           weather(d, 7.0, 0.0, 3.0, 0.3);
}

/* The barn, with the wind flowing around it. */
static bool storm_at_the_barn(demo *d)
{
    solid boxes[BARN_BOXES];
    wk_wind_field field = WK_WIND_FIELD_INIT;
    objects_barn(&d->scene.ground, boxes);
    for (int axis = 0; axis < 3; axis++)
        field.floor_center_m[axis] = boxes[0].place.m[12 + axis];
    field.floor_center_m[2] -= 6.0; /* the lowest ground around it */
    for (int axis = 0; axis < 3; axis++)
        field.cell_m[axis] = 1.0, field.cells[axis] = axis < 2 ? 96 : 32;
    return begin(d) && tell_ground(d) && shelter(d, boxes, BARN_BOXES) && sun_at(d, 200, 20) &&
           weather_from(d, BARN_AZIMUTH_DEG, -6.0, 3.0, 13.0, 1.0) &&
           weather_check(wk_context_set_wind_field(d->weather.context, &field, d->time_s));
}

bool lee_of_a_barn(demo *d) { return storm_at_the_barn(d) && hours(d, 3.0); }

bool wind_in_numbers(demo *d)
{
    d->weather.diagnostic = WK_DIAGNOSTIC_WIND;
    return storm_at_the_barn(d) && hours(d, 0.02);
}

bool blowing_snow(demo *d) { return night(d) && sun_at(d, 160, 16) && weather(d, -8.0, 0.0, 14.0, 0.3); }
