#include "scenes.h"

#include <stdio.h>

bool passed(wk_status status)
{
    if (status >= WK_OK)
        return true;
    fprintf(stderr, "%s: %s\n", wk_status_name(status), wk_last_error_message());
    return false;
}

static bool sun(wk_context *context, double azimuth_deg, double elevation_deg)
{
    wk_given_direction at = WK_GIVEN_DIRECTION_INIT;
    at.azimuth_deg = azimuth_deg;
    at.elevation_deg = elevation_deg;
    return passed(wk_context_set_sun(context, &at));
}

static bool expose(wk_context *context, wk_exposure_mode mode, double value)
{
    return passed(wk_context_set_exposure(context, mode, value));
}

/* The weather of a report, with `surface` as the state of the ground. */
static bool report(wk_context *context, const char *metar, wk_surface_state surface)
{
    wk_weather weather = WK_WEATHER_INIT;
    wk_cloud_layer layers[16];
    if (!passed(wk_weather_from_metar(metar, layers, 16, sizeof layers[0], &weather, NULL)))
        return false;
    if (surface != WK_SURFACE_DRY) {
        weather.has |= WK_WEATHER_HAS_SURFACE_STATE;
        weather.surface_state = surface;
        weather.surface_snow_depth_m = surface == WK_SURFACE_SNOW ? 0.1 : 0.0;
    }
    return passed(wk_context_set_weather(context, &weather, 0.0, 0.0));
}

/* Clouds as a volume, in clear air. */
static bool cloud(wk_context *context, wk_cloud_kind kind, double cover, double base_m, wk_surface_state surface)
{
    wk_weather weather = WK_WEATHER_INIT;
    wk_cloud_layer layer = WK_CLOUD_LAYER_INIT;
    layer.kind = kind;
    layer.cover = cover;
    layer.base_m = base_m;
    weather.visibility_m = 40e3;
    weather.relative_humidity = 0.5;
    weather.wind_speed_m_s = 2.0;
    weather.wind_from_deg = 250.0;
    weather.clouds = &layer;
    weather.cloud_count = 1;
    if (surface != WK_SURFACE_DRY)
        weather.has |= WK_WEATHER_HAS_SURFACE_STATE, weather.surface_state = surface;
    return passed(wk_context_set_weather(context, &weather, 0.0, 0.0)) &&
           passed(wk_context_set_cloud_model(context, WK_CLOUD_MODEL_VOLUME));
}

static bool noon(wk_context *c, wk_view *v)
{
    (void)v;
    return report(c, "METAR LSZH 211120Z 24004KT CAVOK 20/08 Q1018", WK_SURFACE_DRY) && sun(c, 170.0, 62.0);
}

static bool low_sun(wk_context *c, wk_view *v)
{
    (void)v;
    return report(c, "METAR LSZH 211820Z 24002KT 5000 HZ NSC 22/14 Q1018", WK_SURFACE_DRY) && sun(c, 8.0, 4.0);
}

/* Moon and stars where the almanac has them: 23 September 2026, 22:00 UTC. */
static bool night(wk_context *c, wk_view *v)
{
    (void)v;
    return report(c, "METAR LSZH 232200Z VRB01KT CAVOK 12/08 Q1020", WK_SURFACE_DRY) &&
           passed(wk_context_set_clock(c, 1790200800.0, 0.0));
}

static bool fair_cumulus(wk_context *c, wk_view *v)
{
    (void)v;
    return cloud(c, WK_CLOUD_CUMULUS, 0.4, 1200.0, WK_SURFACE_DRY) && sun(c, 150.0, 50.0);
}

static bool above_clouds(wk_context *c, wk_view *v)
{
    (void)v;
    return cloud(c, WK_CLOUD_STRATOCUMULUS, 0.85, 900.0, WK_SURFACE_DRY) && sun(c, 310.0, 14.0);
}

static bool fog_and_lamp(wk_context *c, wk_view *v)
{
    wk_light lamp = WK_LIGHT_INIT;
    int i;
    (void)v;
    lamp.position_m[0] = 3.0, lamp.position_m[1] = 12.0, lamp.position_m[2] = 4.0;
    lamp.direction[0] = 0.0, lamp.direction[1] = 0.0, lamp.direction[2] = -1.0;
    for (i = 0; i < 3; i++)
        lamp.intensity_cd[i] = 400e3f;
    return report(c, "METAR LSZH 210530Z 00000KT 0300 FG VV003 06/06 Q1022", WK_SURFACE_DRY) && sun(c, 40.0, -6.0) &&
           expose(c, WK_EXPOSURE_EV100, 2.5) && passed(wk_context_set_lights(c, &lamp, 1, sizeof lamp));
}

static bool steady_rain(wk_context *c, wk_view *v)
{
    wk_rain rain = WK_RAIN_INIT;
    rain.contrast_gain = WK_RAIN_GAIN_TRAINER;
    return report(c, "METAR LSZH 211120Z 20008KT 3000 +RA BKN012 OVC020 12/11 Q1005", WK_SURFACE_WET) &&
           sun(c, 200.0, 35.0) && passed(wk_view_set_rain(v, &rain));
}

/* A cab's upright window without wipers, 0.6 m away. The rain meets it at 12 m/s. */
static bool windscreen(wk_context *c, wk_view *v)
{
    wk_windscreen pane = WK_WINDSCREEN_INIT;
    pane.pane = WK_WINDSCREEN_PANE_WHOLE_VIEW;
    pane.distance_m = 0.6;
    pane.velocity_m_s[2] = -12.0;
    return report(c, "METAR LSZH 211120Z 20008KT 3000 +RA OVC010 12/11 Q1005", WK_SURFACE_WET) &&
           sun(c, 200.0, 35.0) && passed(wk_view_set_windscreen(v, &pane));
}

static bool snow(wk_context *c, wk_view *v)
{
    wk_snow as_on_a_gpu = WK_SNOW_INIT;
    as_on_a_gpu.most_flakes = 200000;
    return passed(wk_view_set_snow(v, &as_on_a_gpu)) &&
           report(c, "METAR LSZH 211120Z 16004KT 0800 SN OVC008 M01/M02 Q1001", WK_SURFACE_SNOW) && sun(c, 200.0, 20.0);
}

/* Some milliseconds after a stroke 2.4 km away. */
static bool lightning(wk_context *c, wk_view *v)
{
    wk_flash_trigger flash = WK_FLASH_TRIGGER_INIT;
    (void)v;
    flash.position_m[1] = 2400.0;
    flash.peak_ka = 30.0;
    flash.strokes = 3;
    return report(c, "METAR LSZH 212220Z 22008KT 9000 TSRA OVC040CB 16/14 Q1002", WK_SURFACE_WET) && sun(c, 0.0, -40.0) &&
           expose(c, WK_EXPOSURE_EV100, 9.0) && passed(wk_context_trigger_flash(c, &flash));
}

/* Against the sun, exposed one stop less, as a photographer would. */
static bool wet_road(wk_context *c, wk_view *v)
{
    (void)v;
    return cloud(c, WK_CLOUD_CUMULUS, 0.4, 1200.0, WK_SURFACE_STANDING_WATER) && sun(c, 5.0, 9.0) &&
           expose(c, WK_EXPOSURE_AUTO, -1.0);
}

/* A shower 6.5 km ahead, the sun behind the viewer and below 42 degrees. */
static bool rainbow(wk_context *c, wk_view *v)
{
    wk_rain_area area = WK_RAIN_AREA_INIT;
    (void)v;
    area.center_m[1] = 6500.0;
    area.semi_axes_m[0] = 8000.0, area.semi_axes_m[1] = 3000.0;
    area.rim_m = 1500.0;
    area.rate_mm_h = 12.0;
    area.rain = WK_AREA_RAIN_SHOWERS;
    area.top_m = 3000.0;
    return cloud(c, WK_CLOUD_CUMULUS, 0.2, 2500.0, WK_SURFACE_DRY) && sun(c, 184.0, 22.0) &&
           passed(wk_context_set_rain_areas(c, &area, 1, sizeof area));
}

const scene SCENES[] = {
    {"noon", 2.0, 6.0, 50.0, WK_SURFACE_CLASS_VEGETATION, 0.0, noon},
    {"low_sun", 2.0, 5.0, 50.0, WK_SURFACE_CLASS_VEGETATION, 0.0, low_sun},
    {"night", 2.0, 12.0, 60.0, WK_SURFACE_CLASS_SOIL, 0.0, night},
    {"fair_cumulus", 60.0, 4.0, 60.0, WK_SURFACE_CLASS_VEGETATION, 0.0, fair_cumulus},
    {"above_clouds", 2300.0, -6.0, 50.0, WK_SURFACE_CLASS_VEGETATION, 0.0, above_clouds},
    {"fog_and_lamp", 3.0, -2.0, 50.0, WK_SURFACE_CLASS_VEGETATION, 0.0, fog_and_lamp},
    {"steady_rain", 2.0, 0.0, 30.0, WK_SURFACE_CLASS_SOIL, 30.0, steady_rain},
    {"windscreen", 2.0, 1.0, 50.0, WK_SURFACE_CLASS_VEGETATION, 20.0, windscreen},
    {"snow", 2.0, -1.0, 30.0, WK_SURFACE_CLASS_ROCK, 10.0, snow},
    {"lightning", 2.0, 8.0, 50.0, WK_SURFACE_CLASS_VEGETATION, 0.014, lightning},
    {"wet_road", 2.0, -3.0, 50.0, WK_SURFACE_CLASS_SOIL, 0.0, wet_road},
    {"rainbow", 9.0, 12.0, 60.0, WK_SURFACE_CLASS_VEGETATION, 0.0, rainbow},
};
const int SCENE_COUNT = sizeof SCENES / sizeof SCENES[0];
