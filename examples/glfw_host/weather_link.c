/* The link to Welkin: set up once, given weather and time, queried for light, and called after the host has drawn. */
#include "weather_link.h"

#include <stdio.h>
#include <string.h>

bool weather_check(wk_status status)
{
    if (status >= WK_OK)
        return true;
    fprintf(stderr, "%s: %s\n", wk_status_name(status), wk_last_error_message());
    return false;
}

bool weather_open(weather_link *w, const platform *p, const char *planet_toml)
{
    wk_opengl_host_desc host = WK_OPENGL_HOST_DESC_INIT;
    host.get_proc = p->get_proc;
    host.make_current = p->make_current;
    host.user = p->user;

    /* The host's frame on the planet: east, north and up of the site; up counts from sea level. */
    wk_context_desc place = WK_CONTEXT_DESC_INIT;
    place.world_kind = WK_WORLD_TANGENT;
    place.latitude_deg = SITE_LATITUDE_DEG;
    place.longitude_deg = SITE_LONGITUDE_DEG;
    place.planet_toml = planet_toml;

    /* Raise the contrast of rain so that trainees see it: with the default, as in nature, rain hardly shows by day. */
    wk_rain rain = WK_RAIN_INIT;
    rain.contrast_gain = WK_RAIN_GAIN_TRAINER;

    *w = (weather_link){.caps = WK_CAPS_INIT, .station_altitude_m = SITE_ALTITUDE_M, .diagnostic = WK_DIAGNOSTIC_NONE};
    return weather_check(wk_device_create_opengl(&host, &w->device)) &&
           weather_check(wk_context_create(w->device, &place, &w->context)) &&
           weather_check(wk_view_create(w->context, NULL, &w->view)) &&
           weather_check(wk_view_set_rain(w->view, &rain));
}

void weather_close(weather_link *w)
{
    weather_check(wk_view_destroy(w->view));
    weather_check(wk_context_destroy(w->context));
    weather_check(wk_device_destroy(w->device));
    *w = (weather_link){0};
}

bool weather_report(weather_link *w, const char *metar, double transition_s)
{
    wk_weather weather = WK_WEATHER_INIT;
    wk_cloud_layer layers[16];
    if (!weather_check(wk_weather_from_metar(metar, layers, 16, sizeof layers[0], &weather, NULL)))
        return false;
    weather.station_altitude_m = w->station_altitude_m; /* reports do not contain it */
    return weather_check(wk_context_set_weather(w->context, &weather, w->time_s, transition_s));
}

bool weather_clock(weather_link *w, double utc_s)
{
    return weather_check(wk_context_set_clock(w->context, utc_s, w->time_s));
}

/* Exposure over which a flash's light is averaged: one frame at 60 frames per second. */
#define FLASH_EXPOSURE_S (1.0 / 60.0)

bool weather_light(weather_link *w, const camera *c, double time_s, light *l)
{
    const double at[3] = {c->position.x, c->position.y, c->position.z};
    wk_celestial sun = WK_CELESTIAL_INIT, moon = WK_CELESTIAL_INIT;
    wk_ambient sky = WK_AMBIENT_INIT;
    wk_ground_light arriving;
    w->time_s = time_s;
    /* WK_PENDING is no error: a simulated ground that lags after a jump in time continues in the next frame. */
    if (!weather_check(wk_context_update(w->context, time_s)) || !weather_check(wk_context_get_sun(w->context, &at, &sun)) ||
        !weather_check(wk_context_get_moon(w->context, &at, &moon)) || !weather_check(wk_context_get_ambient(w->context, &at, &sky)) ||
        !weather_check(wk_context_get_light(w->context, &at, 1, sizeof at, &arriving, sizeof arriving)))
        return false;

    /* This host's shaders have one light: the sun or the moon, whichever is brighter. */
    bool by_day = arriving.sun_lux[1] >= arriving.moon_lux[1];
    const double *lux = by_day ? arriving.sun_lux : arriving.moon_lux, *to = by_day ? sun.apparent : moon.apparent;
    l->sun_direction = vec(to[0], to[1], to[2]);
    for (int channel = 0; channel < 3; channel++) {
        l->illuminance[channel] = (float)lux[channel];
        for (int k = 0; k < 9; k++)
            l->ambient[k][channel] = (float)sky.sh9[3 * k + channel];
    }
    /* A flash of lightning that is brighter than both replaces it for one frame. */
    wk_flash_light flash = WK_FLASH_LIGHT_INIT;
    if (!weather_check(wk_context_get_flash_light(w->context, &at, time_s, FLASH_EXPOSURE_S, &flash)))
        return false;
    if (flash.facing_lux[1] > lux[1]) {
        l->sun_direction = vec(flash.direction[0], flash.direction[1], flash.direction[2]);
        for (int channel = 0; channel < 3; channel++)
            l->illuminance[channel] = (float)flash.facing_lux[channel];
    }
    /* A white card on the ground has the picture value 1, by day and by night. */
    l->cd_m2_per_unit = fmax(fmax(arriving.total_lux, flash.level_lux), 1e-4) / PI;
    return true;
}

static bool record(weather_link *w, const picture *p, const camera *c, double cd_m2_per_unit, uint64_t frame, uint32_t flags,
                   wk_stage_flags stages)
{
    wk_opengl_target target = WK_OPENGL_TARGET_INIT;
    target.color.kind = target.depth.kind = target.surface_classes.kind = WK_OPENGL_TEXTURE;
    target.color.name = p->color;
    target.depth.name = p->depth;
    target.surface_classes.name = p->classes; /* of these classes only the paved road reflects */
    target.width = (uint32_t)p->width;
    target.height = (uint32_t)p->height;
    target.generation = w->generation;

    wk_frame f = WK_FRAME_INIT;
    mat4 view = camera_view(c), projection = camera_projection(c, (double)p->width / p->height, p->reversed);
    f.frame_id = frame;
    f.position_m[0] = c->position.x;
    f.position_m[1] = c->position.y;
    f.position_m[2] = c->position.z;
    memcpy(f.view, view.m, sizeof f.view);
    memcpy(f.projection, projection.m, sizeof f.projection);
    f.clip_space = p->reversed ? WK_CLIP_ZERO_TO_ONE : WK_CLIP_MINUS_ONE_TO_ONE;
    f.flags = (p->reversed ? WK_FRAME_DEPTH_REVERSED : 0) | flags;
    f.color_space = WK_COLOR_SCENE_LINEAR;
    f.cd_m2_per_unit = cd_m2_per_unit;
    f.diagnostic = w->diagnostic;
    f.depth_access = WK_DEPTH_ACCESS_READ_WRITE; /* Welkin may draw a sea */
    f.target = &target;
    return weather_check(wk_view_record(w->view, &f, stages));
}

bool weather_draw(weather_link *w, const picture *p, const camera *c, double cd_m2_per_unit, uint64_t frame, bool still)
{
    return record(w, p, c, cd_m2_per_unit, frame, still ? WK_FRAME_CUT | WK_FRAME_NO_HISTORY : 0, WK_STAGE_ALL);
}

bool weather_prepare(weather_link *w, const picture *p, const camera *c, double time_s, uint64_t frame)
{
    w->time_s = time_s;
    return weather_check(wk_context_update(w->context, time_s)) && record(w, p, c, 1.0, frame, 0, WK_STAGE_PREPARE);
}

bool weather_measure(weather_link *w, const picture *p, const camera *c, double cd_m2_per_unit, uint64_t frame)
{
    wk_effect_cost costs[16];
    const uint32_t room = sizeof costs / sizeof costs[0];
    const uint32_t flags = WK_FRAME_CUT | WK_FRAME_NO_HISTORY | WK_FRAME_MEASURE;
    /* The first call compiles what is used for the first time. It has a frame number of its own. */
    if (!record(w, p, c, cd_m2_per_unit, ~frame, flags, WK_STAGE_ALL) ||
        !record(w, p, c, cd_m2_per_unit, frame, flags, WK_STAGE_ALL) ||
        !weather_check(wk_view_get_costs(w->view, costs, room, sizeof costs[0], &w->cost_count)))
        return false;
    for (uint32_t i = 0; i < w->cost_count; i++) {
        costs[i].ms += w->costs[i].ms;
        w->costs[i] = costs[i];
    }
    w->measured_frames++;
    return true;
}

void weather_resized(weather_link *w)
{
    w->generation++; /* OpenGL may give the names of deleted textures to new ones */
}

const char *weather_adapter(weather_link *w)
{
    return weather_check(wk_device_get_caps(w->device, &w->caps)) ? w->caps.adapter_name : "unknown";
}

const char *weather_summary(weather_link *w)
{
    const double site[3] = {0.0, 0.0, SITE_ALTITUDE_M};
    wk_conditions now = WK_CONDITIONS_INIT;
    if (!weather_check(wk_context_get_conditions(w->context, &site, w->time_s, &now)))
        return "";
    snprintf(w->summary, sizeof w->summary, "visibility %.0f m, %.0f %% humid, %.1f hPa", now.visibility_m,
             100.0 * now.relative_humidity, now.pressure_hpa);
    return w->summary;
}

void weather_print_costs(weather_link *w)
{
    wk_report report = WK_REPORT_INIT;
    if (w->measured_frames > 0)
        printf("ms per effect, each waited for, mean of %u frames:\n", (unsigned)w->measured_frames);
    for (uint32_t i = 0; i < w->cost_count; i++)
        if (w->costs[i].ms > 0.0)
            printf("  %-12s %7.2f\n", w->costs[i].name, w->costs[i].ms / w->measured_frames);
    if (weather_check(wk_view_get_report(w->view, &report)))
        printf("last frame: %u full-screen passes, %u tables rebuilt, %.1f MiB of the view's own\n",
               (unsigned)report.passes, (unsigned)report.tables_rebuilt, (double)report.bytes / 1048576.0);
}
