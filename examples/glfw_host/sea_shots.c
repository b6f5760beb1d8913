/* The gallery's pictures of the open sea. Welkin draws the sea into the host's depth, which the frame must allow. */
#include "sea_shots.h"

#include "shots.h"
#include "vessel.h"

/* Sets air, wind and a sea that the wind raises; `crossing`, which may be NULL, is a swell. */
static bool sea_in(demo *d, double visibility_m, double wind_m_s, const wk_cloud_layer *cloud, const wk_sea_swell *crossing)
{
    wk_weather w = WK_WEATHER_INIT;
    w.visibility_m = visibility_m;
    w.relative_humidity = 0.7;
    w.wind_speed_m_s = wind_m_s;
    w.wind_from_deg = 250.0;
    w.clouds = cloud;
    w.cloud_count = cloud ? 1 : 0;
    wk_sea sea = WK_SEA_INIT;
    sea.swells = crossing;
    sea.swell_count = crossing ? 1 : 0;
    if (crossing)
        sea.has |= WK_SEA_HAS_SWELLS;
    return weather_clock(&d->weather, HOURS[0].utc_s) &&
           weather_check(wk_context_set_weather(d->weather.context, &w, 0.0, 0.0)) &&
           weather_check(wk_context_set_sea(d->weather.context, &sea));
}

bool sea_breeze(demo *d) { return sea_in(d, 40e3, 5.0, NULL, NULL) && sun_at(d, 60, 45); }

bool sea_storm(demo *d)
{
    wk_cloud_layer deck = WK_CLOUD_LAYER_INIT;
    deck.kind = WK_CLOUD_STRATOCUMULUS;
    deck.cover = 1.0;
    deck.base_m = 600.0;
    return sea_in(d, 8e3, 20.0, &deck, NULL) && sun_at(d, 60, 30);
}

bool sea_glitter(demo *d) { return sea_in(d, 30e3, 6.0, NULL, NULL) && sun_at(d, SITE_VIEW_AZIMUTH_DEG, 12); }

bool sea_swell(demo *d)
{
    wk_sea_swell across = WK_SEA_SWELL_INIT;
    across.height_m = 3.0;
    across.period_s = 13.0;
    across.from_deg = 300.0;
    return sea_in(d, 40e3, 4.0, NULL, &across) && sun_at(d, 160, 9);
}

bool moonlit_sea(demo *d)
{
    wk_given_direction moon = WK_GIVEN_DIRECTION_INIT;
    moon.azimuth_deg = SITE_VIEW_AZIMUTH_DEG + 5.0;
    moon.elevation_deg = 22.0;
    return sea_in(d, 40e3, 5.0, NULL, NULL) && sun_at(d, 0, -30) &&
           weather_check(wk_context_set_moon(d->weather.context, &moon));
}

bool sea_vessel(demo *d)
{
    mat4 pose;
    vec3 at = add(d->still->position, scale(direction(SITE_VIEW_AZIMUTH_DEG + 1.0, 0.0), 58.0));
    vessel v = {at.x, at.y, fmod(SITE_VIEW_AZIMUTH_DEG + 125.0, 360.0), 5.0, 0.0, d->time_s};
    vessel before = vessel_at(&v, d->time_s - 240.0);
    wk_cloud_layer heaps = WK_CLOUD_LAYER_INIT;
    heaps.kind = WK_CLOUD_CUMULUS;
    heaps.cover = 0.3;
    heaps.base_m = 900.0;
    if (!sea_in(d, 30e3, 12.0, &heaps, NULL) || !sun_at(d, SITE_VIEW_AZIMUTH_DEG - 75.0, 32) ||
        !weather_check(wk_context_set_cloud_model(d->weather.context, WK_CLOUD_MODEL_VOLUME)) ||
        !weather_check(vessel_raise_wake(&before, d->weather.context)) ||
        !weather_check(vessel_keep_dry(&v, d->weather.context)) ||
        !weather_check(vessel_float(&v, d->weather.context, d->time_s, &pose)))
        return false;
    scene_place_vessel(&d->scene, pose);
    return true;
}

bool sea_wake(demo *d)
{
    mat4 pose;
    vec3 at = add(d->still->position, scale(direction(SITE_VIEW_AZIMUTH_DEG + 8.0, 0.0), 150.0));
    /* The vessel turns for the last 50 s; before that it went straight on. */
    vessel now = {at.x, at.y, fmod(SITE_VIEW_AZIMUTH_DEG + 40.0, 360.0), 6.0, 1.2, d->time_s};
    vessel turning = vessel_at(&now, d->time_s - 50.0), straight = turning;
    straight.turn_deg_s = 0.0;
    straight = vessel_at(&straight, d->time_s - 250.0);
    if (!sea_in(d, 40e3, 2.0, NULL, NULL) || !sun_at(d, SITE_VIEW_AZIMUTH_DEG - 60.0, 18) ||
        !weather_check(vessel_raise_wake(&straight, d->weather.context)) ||
        !weather_check(vessel_raise_wake(&turning, d->weather.context)) ||
        !weather_check(vessel_keep_dry(&now, d->weather.context)) ||
        !weather_check(vessel_float(&now, d->weather.context, d->time_s, &pose)))
        return false;
    scene_place_vessel(&d->scene, pose);
    return true;
}

bool sea_fog(demo *d) { return sea_in(d, 400.0, 4.0, NULL, NULL) && sun_at(d, 60, 25); }
