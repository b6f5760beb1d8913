/* The demonstration's state and its frame: first the host's world, then the weather, then the copy for the display. */
#include "demo.h"

#include <stdio.h>
#ifndef _WIN32 /* on Windows the clock is in windows.h, which the OpenGL header includes */
#include <time.h>
#endif

#include "objects.h"

/* Light for frames without weather, which have no sky to light the scene: fixed values for an afternoon. */
static light bare_light(void)
{
    light l = {.sun_direction = direction(200.0, 40.0), .illuminance = {92e3f, 86e3f, 78e3f}, .cd_m2_per_unit = 3e4};
    const float sky[3] = {4500.0f, 5500.0f, 7500.0f};
    for (int c = 0; c < 3; c++) {
        l.ambient[0][c] = sky[c] / 0.282095f;
        l.ambient[2][c] = 0.4f * sky[c] / 0.488603f;
    }
    return l;
}

static const char *const CAMERA_NAMES[CAMERA_COUNT] = {"hillside", "beside the excavator", "towards the north", "from 3 km up"};

static const char *const SEA_CAMERA_NAMES[CAMERA_COUNT] = {"off the bow", "from the bridge", "astern", "from 120 m up"};

/* The cameras of the vessel. All but the one on the bridge stay level. */
static camera view_at_sea(const demo *d, double time_s)
{
    static const vec3 EYES[CAMERA_COUNT] = {{38, 46, 7}, {0, 0, 0}, {-14, -60, 12}, {-60, -170, 120}};
    mat4 level = vessel_level(&d->boat, time_s);
    if (d->camera == 1)
        return (camera){transform_point(d->pose, VESSEL_HELM), transform_direction(d->pose, direction(0.0, -2.0)), RAD(60.0)};
    vec3 eye = transform_point(level, EYES[d->camera]);
    return (camera){eye, normalize(sub(transform_point(level, vec(0, 0, 3)), eye)), RAD(45.0)};
}

static const char *const TERRAIN_CAMERA_NAMES[CAMERA_COUNT] = {"from eye height", "from 30 m", "from 300 m", "from 3 km"};

/* The cameras over the terrain of a file. */
static camera view_over_terrain(const demo *d)
{
    static const double ABOVE_M[CAMERA_COUNT] = {1.7, 30.0, 300.0, 3000.0}, PITCH_DEG[CAMERA_COUNT] = {0.0, -2.0, -8.0, -20.0};
    return (camera){add(d->standing, vec(0, 0, ABOVE_M[d->camera])), direction(0.0, PITCH_DEG[d->camera]), RAD(50.0)};
}

static camera view_from(const demo *d)
{
    const ground *g = &d->scene.ground;
    camera c = {objects_survey_eye(g), direction(SITE_VIEW_AZIMUTH_DEG + 4.0, 1.5), RAD(50.0)};
    double x, y;
    if (d->camera == 1) {
        ground_pad(&x, &y);
        vec3 off = direction(SITE_VIEW_AZIMUTH_DEG + 205.0, 0.0);
        x += 14.0 * off.x, y += 14.0 * off.y;
        c.position = vec(x, y, ground_z(g, x, y) + 2.0);
        c.ahead = direction(SITE_VIEW_AZIMUTH_DEG + 22.0, 4.0);
    } else if (d->camera == 2) {
        c.ahead = direction(10.0, 3.0);
    } else if (d->camera == 3) {
        c.position.z = 3000.0;
        c.ahead = direction(SITE_VIEW_AZIMUTH_DEG + 10.0, -8.0);
    }
    return c;
}

double demo_clock_ms(void)
{
#ifdef _WIN32 /* MinGW's C library has no timespec_get */
    LARGE_INTEGER now, per_s;
    QueryPerformanceCounter(&now);
    QueryPerformanceFrequency(&per_s);
    return (double)now.QuadPart * 1e3 / (double)per_s.QuadPart;
#else
    struct timespec t;
    timespec_get(&t, TIME_UTC);
    return (double)t.tv_sec * 1e3 + (double)t.tv_nsec * 1e-6;
#endif
}

/* Puts a vessel on the open sea in place of the land, before the first frame. */
static bool sail(demo *d)
{
    wk_sea sea = WK_SEA_INIT;
    d->at_sea = d->scene.at_sea = true;
    d->scene.extra = VESSEL;
    d->weather.station_altitude_m = 0.0;
    /* It has sailed for a while, and turns slowly. */
    d->boat = (vessel){0.0, 0.0, 210.0, 5.5, 0.5, 0.0};
    vessel before = vessel_at(&d->boat, -240.0);
    return weather_check(wk_context_set_sea(d->weather.context, &sea)) &&
           weather_check(vessel_raise_wake(&before, d->weather.context));
}

/* Has Welkin draw the terrain of a file in place of the land. The cameras look north over most of it. */
static bool settle_on(demo *d, const char *path)
{
    if (!terrain_file_read(&d->terrain, path))
        return false;
    d->on_terrain = d->scene.empty = true;
    d->standing = terrain_file_ground(&d->terrain, 0.0, -0.3 * d->terrain.cell_m * d->terrain.rows);
    d->weather.station_altitude_m = d->standing.z;
    return weather_check(terrain_file_set(&d->terrain, d->weather.context));
}

bool demo_open(demo *d, const platform *p, const char *data, const demo_world *world, int width, int height, int finer)
{
    char path[1024];
    *d = (demo){.platform = p, .cut = true, .started_ms = demo_clock_ms()};
    snprintf(path, sizeof path, "%s/jacksboro_dem.png", data);
    if (!scene_create(&d->scene, path))
        return false;
    snprintf(path, sizeof path, "%s/metar.txt", data);
    if (!reports_read(&d->reports, path) || !picture_create(&d->picture, width, height, finer) ||
        !weather_open(&d->weather, p, world->planet))
        return false;
    bool ok = !world->at_sea || sail(d);
    ok = ok && (!world->terrain || settle_on(d, world->terrain));
    return ok && demo_next_report(d, 0) && demo_next_hour(d, 0);
}

void demo_close(demo *d)
{
    terrain_file_free(&d->terrain);
    weather_close(&d->weather);
    picture_destroy(&d->picture);
    scene_destroy(&d->scene);
}

bool demo_next_report(demo *d, int step)
{
    d->report = (d->report + step + d->reports.count) % d->reports.count;
    return weather_report(&d->weather, d->reports.items[d->report].metar, d->moving ? 5.0 : 0.0);
}

bool demo_next_hour(demo *d, int step)
{
    d->hour = (d->hour + step + HOUR_COUNT) % HOUR_COUNT;
    return weather_clock(&d->weather, HOURS[d->hour].utc_s);
}

void demo_next_camera(demo *d, int step)
{
    d->camera = (d->camera + step + CAMERA_COUNT) % CAMERA_COUNT;
    d->cut = true;
}

const char *demo_camera_name(const demo *d)
{
    return (d->at_sea ? SEA_CAMERA_NAMES : d->on_terrain ? TERRAIN_CAMERA_NAMES : CAMERA_NAMES)[d->camera];
}

bool demo_resize(demo *d, int width, int height)
{
    int finer = d->picture.width / d->picture.shown_width;
    if (width == d->picture.shown_width && height == d->picture.shown_height)
        return true;
    picture_destroy(&d->picture);
    weather_resized(&d->weather);
    return picture_create(&d->picture, width, height, finer);
}

bool demo_draw(demo *d)
{
    light l = bare_light();
    bool weather = !d->bare;
    double start = demo_clock_ms();
    double time_s = d->moving ? (start - d->started_ms) * 1e-3 : d->time_s;
    if (d->at_sea) {
        vessel now = vessel_at(&d->boat, time_s);
        if (!weather_check(vessel_keep_dry(&now, d->weather.context)) ||
            !weather_check(vessel_float(&d->boat, d->weather.context, time_s, &d->pose)))
            return false;
        scene_place_vessel(&d->scene, d->pose);
    }
    camera c = d->still ? *d->still : d->at_sea ? view_at_sea(d, time_s) : d->on_terrain ? view_over_terrain(d) : view_from(d);
    if (weather && !weather_light(&d->weather, &c, time_s, &l))
        return false;
    l.lamps = d->lamps;
    if (l.lamps.intensity_cd[1] > 0.0f)
        l.cd_m2_per_unit = fmax(l.cd_m2_per_unit, 1.0); /* a lamp's light must stay within the range of half floats */
    picture *p = &d->picture;
    scene_draw(&d->scene, &c, &l, p->width, p->height, p->reversed, p->frame);
    glFinish(); /* only to measure the time: a simulator would not wait here */
    double drawn = demo_clock_ms();
    if (weather && d->measure && !weather_measure(&d->weather, p, &c, l.cd_m2_per_unit, d->frame))
        return false;
    if (weather && !d->measure && !weather_draw(&d->weather, p, &c, l.cd_m2_per_unit, d->frame, d->cut || !(d->moving || d->history)))
        return false;
    glFinish();
    double end = demo_clock_ms();
    /* With weather, Welkin's TONE stage has tone-mapped the picture; without it, the host tone-maps it itself. */
    picture_present(p, weather ? 0.0f : 1.6f);
    d->weather_ms = end - drawn;
    d->ms = end - start;
    d->frame++;
    d->cut = false;
    return true;
}
