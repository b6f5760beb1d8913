/* The weather of each picture, set in the fields of wk_weather and by other calls where a report cannot state it. */
#include "shots.h"

#include "objects.h"
#include "dig_shots.h"
#include "land_shots.h"
#include "sea_shots.h"
#include "snow_shots.h"

static wk_weather weather_here(double visibility_m, double humidity)
{
    wk_weather w = WK_WEATHER_INIT;
    w.visibility_m = visibility_m;
    w.relative_humidity = humidity;
    w.station_altitude_m = SITE_ALTITUDE_M;
    return w;
}

static wk_cloud_layer overcast(wk_cloud_kind kind, double base_m)
{
    wk_cloud_layer l = WK_CLOUD_LAYER_INIT;
    l.kind = kind;
    l.cover = 1.0;
    l.base_m = base_m;
    return l;
}

static void fall(wk_weather *w, wk_precipitation_kind kind, double rate_mm_h, double wind_m_s, double wind_from_deg)
{
    w->precipitation_kind = kind;
    w->precipitation_rate_mm_h = rate_mm_h;
    w->wind_speed_m_s = wind_m_s;
    w->wind_from_deg = wind_from_deg;
}

/* Sets the weather; `cloud` may be NULL. */
static bool set(demo *d, wk_weather *w, const wk_cloud_layer *cloud)
{
    w->clouds = cloud;
    w->cloud_count = cloud ? 1 : 0;
    return weather_check(wk_context_set_weather(d->weather.context, w, 0.0, 0.0));
}

bool sun_at(demo *d, double azimuth_deg, double elevation_deg)
{
    wk_given_direction sun = WK_GIVEN_DIRECTION_INIT;
    sun.azimuth_deg = azimuth_deg;
    sun.elevation_deg = elevation_deg;
    return weather_check(wk_context_set_sun(d->weather.context, &sun));
}

/* Clear air at one of the host's hours, with sun and moon where the almanac puts them. */
static bool clear(demo *d, int hour)
{
    wk_weather w = weather_here(40e3, 0.5);
    return weather_clock(&d->weather, HOURS[hour].utc_s) && set(d, &w, NULL);
}

static bool noon(demo *d) { return clear(d, 0); }

/* Five minutes before the time at which the sun's disc touches the hills. */
static bool sunset(demo *d)
{
    return clear(d, 2) && weather_clock(&d->weather, HOURS[2].utc_s - 300.0);
}

static bool twilight(demo *d) { return clear(d, 3); }
static bool night(demo *d) { return clear(d, 4); }

/* Clear air with the sun in another place, for the pictures from high up. */
static bool clear_with_sun(demo *d, double azimuth_deg, double elevation_deg)
{
    return clear(d, 0) && sun_at(d, azimuth_deg, elevation_deg);
}

static bool twelve_km(demo *d) { return clear_with_sun(d, 60, 25); }
static bool space(demo *d) { return clear_with_sun(d, 30, 5); }
static bool shadow(demo *d) { return clear_with_sun(d, 10, -9); }

/* Draws cloud layers as volumes, ordered from the lowest up. */
static bool cloudy(demo *d, const wk_cloud_layer *layers, uint32_t count)
{
    wk_weather w = weather_here(40e3, 0.5);
    w.clouds = layers;
    w.cloud_count = count;
    w.wind_speed_m_s = 4.0;
    w.wind_from_deg = 250.0;
    return weather_clock(&d->weather, HOURS[0].utc_s) &&
           weather_check(wk_context_set_weather(d->weather.context, &w, 0.0, 0.0)) &&
           weather_check(wk_context_set_cloud_model(d->weather.context, WK_CLOUD_MODEL_VOLUME));
}

static wk_cloud_layer layer(wk_cloud_kind kind, double cover, double base_m)
{
    wk_cloud_layer l = overcast(kind, base_m);
    l.cover = cover;
    return l;
}

static bool fair_cumulus(demo *d)
{
    wk_cloud_layer l = layer(WK_CLOUD_CUMULUS, 0.4, 1200.0);
    return cloudy(d, &l, 1);
}

static bool evening_clouds(demo *d)
{
    const wk_cloud_layer l[] = {layer(WK_CLOUD_CUMULUS, 0.3, 1100.0), layer(WK_CLOUD_ALTOCUMULUS, 0.4, 3800.0)};
    return cloudy(d, l, 2) && sun_at(d, 300, 7);
}

static bool altocumulus(demo *d)
{
    wk_cloud_layer l = layer(WK_CLOUD_ALTOCUMULUS, 0.6, 3600.0);
    return cloudy(d, &l, 1) && sun_at(d, 170, 40);
}

/* The sun is in the picture, above its middle. */
static bool halo(demo *d)
{
    wk_cloud_layer l = layer(WK_CLOUD_CIRROSTRATUS, 1.0, 8500.0);
    return cloudy(d, &l, 1) && sun_at(d, SITE_VIEW_AZIMUTH_DEG + 4.0, 27) &&
           weather_check(wk_context_set_exposure(d->weather.context, WK_EXPOSURE_AUTO, -2.0));
}

static bool limb_with_clouds(demo *d)
{
    wk_cloud_layer l[] = {layer(WK_CLOUD_STRATUS, 0.5, 1000.0), layer(WK_CLOUD_CIRRUS, 0.3, 9000.0)};
    l[0].spacing_m = 20e3; /* whole cloud fields: single clouds are smaller than a pixel */
    return cloudy(d, l, 2) && sun_at(d, 60, 30);
}

/* Haze under gaps in the cloud, with the sun ahead, to the left. */
static bool shafts(demo *d)
{
    wk_weather w = weather_here(8000, 0.7);
    wk_cloud_layer l = layer(WK_CLOUD_STRATOCUMULUS, 0.9, 1800.0);
    wk_clouds with_shafts = WK_CLOUDS_INIT;
    with_shafts.flags = WK_CLOUDS_SHAFTS;
    return weather_clock(&d->weather, HOURS[0].utc_s) && set(d, &w, &l) && sun_at(d, SITE_VIEW_AZIMUTH_DEG - 4.0, 33) &&
           weather_check(wk_context_set_exposure(d->weather.context, WK_EXPOSURE_AUTO, -0.7)) &&
           weather_check(wk_view_set_clouds(d->weather.view, &with_shafts));
}

static bool above_clouds(demo *d)
{
    wk_cloud_layer l = layer(WK_CLOUD_STRATOCUMULUS, 0.85, 900.0);
    return cloudy(d, &l, 1) && sun_at(d, 310, 14);
}

static bool cloud_shadows(demo *d)
{
    wk_cloud_layer l = layer(WK_CLOUD_CUMULUS, 0.4, 1500.0);
    return cloudy(d, &l, 1) && sun_at(d, 150, 50);
}

/* A thunderstorm at night, some milliseconds after a stroke 2.4 km away. */
static bool lightning(demo *d)
{
    wk_weather w = weather_here(9000, 0.9);
    wk_cloud_layer thundercloud = overcast(WK_CLOUD_CUMULONIMBUS, 1300.0);
    wk_flash_trigger flash = WK_FLASH_TRIGGER_INIT;
    vec3 at = add(d->still->position, scale(d->still->ahead, 2400.0));
    fall(&w, WK_PRECIPITATION_RAIN, 6.0, 4.0, 220.0);
    w.precipitation_flags |= WK_PRECIPITATION_THUNDERSTORM;
    flash.position_m[0] = at.x, flash.position_m[1] = at.y, flash.position_m[2] = 0.0;
    flash.peak_ka = 30.0;
    flash.strokes = 3;
    d->time_s = 0.014;
    return weather_clock(&d->weather, HOURS[4].utc_s) && set(d, &w, &thundercloud) &&
           weather_check(wk_context_set_exposure(d->weather.context, WK_EXPOSURE_EV100, 9.0)) &&
           weather_check(wk_context_trigger_flash(d->weather.context, &flash));
}

static bool haze(demo *d)
{
    wk_weather w = weather_here(5000, 0.5);
    w.aerosol_kind = WK_AEROSOL_HAZE;
    return sun_at(d, 190, 35) && set(d, &w, NULL);
}

static bool fog(demo *d)
{
    wk_weather w = weather_here(150, 1.0);
    w.fog_kind = WK_FOG_FOG;
    return sun_at(d, 200, 30) && set(d, &w, NULL);
}

static bool shallow_fog(demo *d)
{
    wk_weather w = weather_here(30e3, 0.95);
    w.fog_kind = WK_FOG_SHALLOW;
    w.has = WK_WEATHER_HAS_FOG_TOP | WK_WEATHER_HAS_FOG_VISIBILITY_INSIDE;
    w.station_altitude_m = SITE_ALTITUDE_M - 45.0; /* the valley's floor */
    w.fog_top_m = 30.0;
    w.fog_visibility_inside_m = 150.0;
    return sun_at(d, 298, 12) && set(d, &w, NULL);
}

/* Clear air, and a region of fog over the valley ahead. */
static bool fog_bank(demo *d)
{
    wk_weather w = weather_here(40e3, 0.7), fog = weather_here(250, 1.0);
    wk_weather_region bank = WK_WEATHER_REGION_INIT;
    fog.fog_kind = WK_FOG_FOG;
    fog.has = WK_WEATHER_HAS_FOG_TOP;
    fog.fog_top_m = 45.0;
    bank.has = WK_WEATHER_PART_FOG;
    bank.weather = &fog;
    bank.center_m[0] = 3200.0 * sin(RAD(SITE_VIEW_AZIMUTH_DEG));
    bank.center_m[1] = 3200.0 * cos(RAD(SITE_VIEW_AZIMUTH_DEG));
    bank.heading_deg = SITE_VIEW_AZIMUTH_DEG + 20.0;
    bank.half_size_m[0] = 2600.0;
    bank.half_size_m[1] = 1300.0;
    bank.perimeter_m = 700.0;
    return sun_at(d, 298, 12) && set(d, &w, NULL) &&
           weather_check(wk_context_set_weather_regions(d->weather.context, &bank, 1, sizeof bank));
}

static bool fog_in_numbers(demo *d)
{
    d->weather.diagnostic = WK_DIAGNOSTIC_OPTICAL_DEPTH;
    return shallow_fog(d);
}

static bool rain(demo *d, double rate_mm_h)
{
    wk_weather w = weather_here(4000, 0.95);
    wk_cloud_layer cloud = overcast(WK_CLOUD_NIMBOSTRATUS, 600);
    fall(&w, WK_PRECIPITATION_RAIN, rate_mm_h, 4.0, 200.0);
    return sun_at(d, 200, 35) && set(d, &w, &cloud);
}

static bool overcast_rain(demo *d) { return rain(d, 2.0); }
static bool steady_rain(demo *d) { return rain(d, 6.0); }
static bool heavy_rain(demo *d) { return rain(d, 25.0); }

static bool drizzle(demo *d)
{
    wk_weather w = weather_here(3000, 0.98);
    wk_cloud_layer cloud = overcast(WK_CLOUD_STRATUS, 300);
    w.fog_kind = WK_FOG_MIST;
    fall(&w, WK_PRECIPITATION_DRIZZLE, 0.5, 2.0, 260.0);
    return sun_at(d, 200, 35) && set(d, &w, &cloud);
}

static bool cloudburst(demo *d)
{
    wk_weather w = weather_here(500, 0.97);
    wk_cloud_layer cloud = overcast(WK_CLOUD_CUMULONIMBUS, 600);
    fall(&w, WK_PRECIPITATION_RAIN, 60.0, 9.0, 155.0);
    w.precipitation_flags = WK_PRECIPITATION_SHOWERS;
    return sun_at(d, 200, 35) && set(d, &w, &cloud);
}

static bool hail(demo *d)
{
    wk_weather w = weather_here(9000, 0.9);
    wk_cloud_layer cloud = overcast(WK_CLOUD_CUMULONIMBUS, 900);
    fall(&w, WK_PRECIPITATION_HAIL, 40.0, 5.0, 200.0);
    return sun_at(d, 200, 40) && set(d, &w, &cloud);
}

static bool snow(demo *d, double rate_mm_h, double temperature_c, double visibility_m, double wind_m_s)
{
    wk_weather w = weather_here(visibility_m, 0.97);
    wk_cloud_layer cloud = overcast(WK_CLOUD_NIMBOSTRATUS, 500);
    wk_snow as_on_a_gpu = WK_SNOW_INIT;
    w.temperature_c = temperature_c;
    as_on_a_gpu.most_flakes = 1000000;
    fall(&w, WK_PRECIPITATION_SNOW, rate_mm_h, wind_m_s, 155.0);
    return set(d, &w, &cloud) && weather_check(wk_view_set_snow(d->weather.view, &as_on_a_gpu));
}

static bool quiet_snow(demo *d) { return sun_at(d, 300, -1) && snow(d, 1.5, 0.3, 650, 0.6); }

static bool snowstorm(demo *d) { return sun_at(d, 200, 20) && snow(d, 4.0, -6.0, 250, 16.0); }

static bool heavy_snow(demo *d) { return sun_at(d, 200, 20) && snow(d, 12.0, -3.0, 250, 2.0); }

static bool wet_road(demo *d)
{
    wk_weather w = weather_here(40e3, 0.6);
    wk_cloud_layer heaps = layer(WK_CLOUD_CUMULUS, 0.4, 1200.0);
    w.has = WK_WEATHER_HAS_SURFACE_STATE;
    w.surface_state = WK_SURFACE_STANDING_WATER;
    w.wind_speed_m_s = 2.0;
    w.wind_from_deg = 250.0;
    /* Against the sun, exposed one stop less, as a photographer would. */
    return sun_at(d, 255, 9) && set(d, &w, &heaps) &&
           weather_check(wk_context_set_cloud_model(d->weather.context, WK_CLOUD_MODEL_VOLUME)) &&
           weather_check(wk_context_set_exposure(d->weather.context, WK_EXPOSURE_AUTO, -1.0));
}

static bool blowing_sand(demo *d)
{
    wk_weather w = weather_here(500, 0.15);
    w.temperature_c = 36.0;
    w.lofted_kind = WK_LOFTED_BLOWING_SAND;
    w.wind_speed_m_s = 19.0;
    w.wind_from_deg = 170.0;
    return sun_at(d, 150, 40) && set(d, &w, NULL);
}

/* A rain area whose centre lies `ahead_m` along the site's view axis and `right_m` to the right of it. */
static wk_rain_area shower(double ahead_m, double right_m, double semi_right_m, double semi_ahead_m, double rate_mm_h)
{
    wk_rain_area a = WK_RAIN_AREA_INIT;
    vec3 ahead = direction(SITE_VIEW_AZIMUTH_DEG, 0.0);
    a.center_m[0] = ahead_m * ahead.x + right_m * ahead.y;
    a.center_m[1] = ahead_m * ahead.y - right_m * ahead.x;
    a.center_m[2] = SITE_ALTITUDE_M;
    a.semi_axes_m[0] = semi_right_m;
    a.semi_axes_m[1] = semi_ahead_m;
    a.heading_deg = SITE_VIEW_AZIMUTH_DEG;
    a.rim_m = 0.5 * fmin(semi_right_m, semi_ahead_m);
    a.rate_mm_h = rate_mm_h;
    a.rain = WK_AREA_RAIN_SHOWERS;
    a.top_m = SITE_ALTITUDE_M + 3000.0;
    return a;
}

static bool rain_shaft(demo *d)
{
    wk_weather w = weather_here(35e3, 0.6);
    wk_cloud_layer cloud = overcast(WK_CLOUD_STRATOCUMULUS, 3000);
    cloud.cover = 0.88;
    w.wind_speed_m_s = 13.0;
    w.wind_from_deg = 170.0;
    const wk_rain_area areas[] = {
        shower(7400, -1200, 500, 500, 12), shower(6300, 1000, 1500, 1200, 3), shower(5900, 800, 800, 700, 20)};
    return sun_at(d, 150, 35) && set(d, &w, &cloud) &&
           weather_check(wk_context_set_rain_areas(d->weather.context, areas, 3, sizeof areas[0]));
}

/* A single cumulonimbus with its anvil stands over the rain. */
static bool thunderstorm(demo *d)
{
    wk_weather w = weather_here(70e3, 0.5);
    wk_cloud_layer heaps = layer(WK_CLOUD_CUMULUS, 0.08, 1500.0);
    const wk_rain_area area = shower(27000, 500, 5500, 4500, 40);
    w.wind_speed_m_s = 9.0;
    w.wind_from_deg = 200.0;
    /* A cloud in full sun is brighter than the ground, to which cameras are exposed. */
    return sun_at(d, SITE_VIEW_AZIMUTH_DEG - 70.0, 24) && set(d, &w, &heaps) &&
           weather_check(wk_context_set_exposure(d->weather.context, WK_EXPOSURE_AUTO, -0.8)) &&
           weather_check(wk_context_set_rain_areas(d->weather.context, &area, 1, sizeof area));
}

/* The sun stands behind the viewer, lower than 42 degrees. */
static bool rainbow(demo *d)
{
    wk_weather w = weather_here(35e3, 0.6);
    wk_cloud_layer heaps = layer(WK_CLOUD_CUMULUS, 0.2, 2500.0);
    const wk_rain_area area = shower(6500, 0, 8000, 3000, 12);
    return sun_at(d, SITE_VIEW_AZIMUTH_DEG - 176.0, 22) && set(d, &w, &heaps) &&
           weather_check(wk_context_set_rain_areas(d->weather.context, &area, 1, sizeof area));
}

bool shelter(demo *d, const solid *boxes, int count)
{
    wk_shelter shelters[MOST_SHELTERS];
    for (int i = 0; i < count; i++) {
        const mat4 *place = &boxes[i].place;
        const double half[3] = {0.5 * boxes[i].size.x, 0.5 * boxes[i].size.y, 0.5 * boxes[i].size.z};
        shelters[i] = (wk_shelter)WK_SHELTER_INIT;
        for (int axis = 0; axis < 3; axis++) {
            shelters[i].center_m[axis] = place->m[12 + axis];
            shelters[i].half_size_m[axis] = half[axis];
            for (int k = 0; k < 3; k++)
                shelters[i].axes[3 * axis + k] = place->m[4 * axis + k];
        }
    }
    return weather_check(wk_context_set_shelters(d->weather.context, shelters, (uint32_t)count, sizeof shelters[0]));
}

static bool under_the_bridge(demo *d)
{
    wk_weather w = weather_here(4000, 0.95);
    wk_cloud_layer cloud = overcast(WK_CLOUD_NIMBOSTRATUS, 600);
    fall(&w, WK_PRECIPITATION_RAIN, 20.0, 5.0, 85.0); /* wind from behind the camera */
    solid boxes[BRIDGE_BOXES];
    objects_bridge(&d->scene.ground, boxes);
    return sun_at(d, 200, 35) && set(d, &w, &cloud) && shelter(d, boxes, BRIDGE_BOXES);
}

/* Two lamps on a roof behind the camera, one on each side. */
static bool work_lights(demo *d)
{
    wk_weather w = weather_here(4000, 0.95);
    wk_light lights[2];
    const camera *c = d->still;
    vec3 right = normalize(cross(c->ahead, vec(0, 0, 1)));
    fall(&w, WK_PRECIPITATION_RAIN, 8.0, 3.0, 200.0);
    d->lamps = (lamp_pair){.intensity_cd = {40e3f, 37e3f, 30e3f}, .inner_deg = 10.0, .outer_deg = 50.0};
    for (int i = 0; i < 2; i++) {
        double side = i ? 1.0 : -1.0;
        vec3 at = add(add(c->position, scale(right, 1.3 * side)), vec(0, 0, 1.4));
        vec3 to = normalize(add(add(c->ahead, scale(right, 0.22 * side)), vec(0, 0, -0.14)));
        d->lamps.position[i] = at, d->lamps.direction[i] = to;
        lights[i] = (wk_light)WK_LIGHT_INIT;
        lights[i].position_m[0] = at.x, lights[i].position_m[1] = at.y, lights[i].position_m[2] = at.z;
        lights[i].direction[0] = to.x, lights[i].direction[1] = to.y, lights[i].direction[2] = to.z;
        for (int k = 0; k < 3; k++)
            lights[i].intensity_cd[k] = d->lamps.intensity_cd[k];
        lights[i].inner_deg = d->lamps.inner_deg, lights[i].outer_deg = d->lamps.outer_deg;
    }
    return sun_at(d, 60, -35) && set(d, &w, NULL) &&
           weather_check(wk_context_set_exposure(d->weather.context, WK_EXPOSURE_EV100, 4.5)) &&
           weather_check(wk_context_set_lights(d->weather.context, lights, 2, sizeof lights[0]));
}

/* A cab's upright window at 0.6 m, 1 m wide and 0.56 m high. The rain hits it at 12 m/s. */
static bool cab(demo *d, const wk_wiper_arm *arms, uint32_t arm_count)
{
    wk_windscreen w = WK_WINDSCREEN_INIT;
    w.pane = WK_WINDSCREEN_PANE_WHOLE_VIEW;
    w.distance_m = 0.6;
    w.velocity_m_s[2] = -12.0;
    w.arms = arms;
    w.arm_count = arm_count;
    return weather_check(wk_view_set_windscreen(d->weather.view, &w));
}

static bool without_wipers(demo *d, double time_s)
{
    (void)time_s;
    return cab(d, NULL, 0);
}

/* The wiper moves there and back in 1.5 s. */
static bool with_wipers(demo *d, double time_s)
{
    const double pivots_m[2] = {0.22, 0.68};
    wk_wiper_arm arms[2];
    for (int i = 0; i < 2; i++) {
        arms[i] = (wk_wiper_arm)WK_WIPER_ARM_INIT;
        arms[i].pivot_m[0] = pivots_m[i], arms[i].pivot_m[1] = -0.04;
        arms[i].length_m = 0.46, arms[i].inner_radius_m = 0.1;
        arms[i].parked_deg = 170.0, arms[i].far_deg = 50.0;
        arms[i].position = 0.5 - 0.5 * cos(time_s * 2.0 * PI / 1.5);
    }
    return cab(d, arms, 2);
}

/* The eye on the hillside from which the posts' distances are measured, and a driver's eye on the road. */
#define HILLSIDE 0.0, -4.8, 9.0, SITE_VIEW_AZIMUTH_DEG + 4.0, 1.5, 50.0
#define ROADSIDE(elevation) 12.0, 1.6, 1.9, SITE_VIEW_AZIMUTH_DEG + 3.0, elevation, 50.0
/* Beside the excavator's track to its pad. */
#define YARD 20.0, -50.0, 5.0, SITE_VIEW_AZIMUTH_DEG + 48.0, -8.0, 50.0
/* In the lee of the barn. */
#define LEE 42.0, -8.0, 2.4, SITE_VIEW_AZIMUTH_DEG - 78.0, -3.0, 50.0
#define SKYWARD(elevation, fov_y) 0.0, -4.8, 9.0, SITE_VIEW_AZIMUTH_DEG + 4.0, elevation, fov_y
/* Over the open sea. */
#define AFLOAT(up, azimuth, elevation, fov_y) 0.0, 0.0, up, azimuth, elevation, fov_y
#define HIGH(up, azimuth, elevation, fov_y) 0.0, -4.8, up, azimuth, elevation, fov_y

const shot SHOTS[] = {
    {"noon", "Noon", HILLSIDE, noon, WORLD, NULL, false},
    {"sunset", "Sunset", HILLSIDE, sunset, WORLD, NULL, false},
    {"twilight", "Civil twilight", HILLSIDE, twilight, WORLD, NULL, false},
    {"night", "Night with a half moon", HILLSIDE, night, WORLD, NULL, false},
    {"fair_cumulus", "Fair-weather cumulus", 0.0, -4.8, 9.0, SITE_VIEW_AZIMUTH_DEG + 4.0, 11.0, 50.0, fair_cumulus, WORLD, NULL, false},
    {"evening_clouds", "Cumulus and altocumulus, low sun", 0.0, -4.8, 9.0, SITE_VIEW_AZIMUTH_DEG + 4.0, 11.0, 50.0, evening_clouds, WORLD, NULL, true},
    {"altocumulus", "Altocumulus", SKYWARD(26.0, 60.0), altocumulus, WORLD, NULL, true},
    {"halo", "Cirrostratus with its halo", SKYWARD(22.0, 70.0), halo, WORLD, NULL, true},
    {"cloud_shadows", "Shadows of cumulus", 0.0, -4.8, 500.0, SITE_VIEW_AZIMUTH_DEG + 4.0, -6.0, 60.0, cloud_shadows, WORLD, NULL, true},
    {"shafts", "Shafts of light under broken clouds", 0.0, -4.8, 60.0, SITE_VIEW_AZIMUTH_DEG + 4.0, 7.0, 50.0, shafts, WORLD, NULL, true},
    {"above_clouds", "Stratocumulus from above, low sun", HIGH(2300.0, SITE_VIEW_AZIMUTH_DEG, -6.0, 50.0), above_clouds, NO_WORLD, NULL, false},
    {"lightning", "Lightning at night, rain 6 mm/h", 0.0, -4.8, 9.0, SITE_VIEW_AZIMUTH_DEG + 4.0, 8.0, 50.0, lightning, WORLD, NULL, true},
    {"haze", "Haze, visibility 5 km", HILLSIDE, haze, WORLD, NULL, false},
    {"overcast", "Overcast, light rain, visibility 4 km", HILLSIDE, overcast_rain, WORLD, NULL, false},
    {"fog", "Fog, visibility 150 m", HILLSIDE, fog, WORLD, NULL, false},
    {"drizzle", "Drizzle, 0.5 mm/h", ROADSIDE(-1.0), drizzle, WORLD, NULL, false},
    {"steady_rain", "Steady rain, 6 mm/h", ROADSIDE(-2.0), steady_rain, WORLD, NULL, false},
    {"cloudburst", "Cloudburst, 60 mm/h, wind 9 m/s", ROADSIDE(-4.0), cloudburst, WORLD, NULL, false},
    {"work_lights", "Rain at night in work lights, 8 mm/h", 36.0, -9.0, 2.4, SITE_VIEW_AZIMUTH_DEG - 50.0, 0.0, 50.0, work_lights, WORLD, NULL, true},
    {"windscreen", "Through the windscreen, 25 mm/h", ROADSIDE(1.0), heavy_rain, WORLD, without_wipers, true},
    {"wiped", "The same with two wipers going", ROADSIDE(1.0), heavy_rain, WORLD, with_wipers, true},
    {"shallow_fog", "Shallow fog in a valley", HILLSIDE, shallow_fog, WORLD, NULL, false},
    {"fog_bank", "A fog bank over the valley, a weather region in clear air", HILLSIDE, fog_bank, WORLD, NULL, true},
    {"optical_depth", "Optical depth of that fog: black 0, blue 1, green 2, yellow 3, red 4, white 5", HILLSIDE, fog_in_numbers, WORLD, NULL, false},
    {"wet_road", "Wet road after a shower, low sun", ROADSIDE(-3.0), wet_road, WORLD, NULL, false},
    {"rain_shaft", "Showers 6 km away", 0.0, -4.8, 60.0, SITE_VIEW_AZIMUTH_DEG + 4.0, 3.0, 30.0, rain_shaft, WORLD, NULL, false},
    {"thunderstorm", "Thunderstorm 27 km away: towers, anvil, rain 40 mm/h", 0.0, -4.8, 60.0, SITE_VIEW_AZIMUTH_DEG + 4.0, 13.0, 55.0, thunderstorm, WORLD, NULL, false},
    {"rainbow", "Rainbow", 0.0, -4.8, 9.0, SITE_VIEW_AZIMUTH_DEG + 4.0, 12.0, 60.0, rainbow, WORLD, NULL, true},
    {"hail", "Hail, 40 mm/h", ROADSIDE(-3.0), hail, WORLD, NULL, false},
    {"quiet_snow", "Large flakes at dusk, 1.5 mm/h, hardly any wind", ROADSIDE(-1.0), quiet_snow, WORLD, NULL, false},
    {"after_a_night", "After six hours of snow in wind", YARD, after_a_night, WORLD, NULL, false},
    {"thaw", "Five warm hours later", YARD, thaw, WORLD, NULL, false},
    {"blowing_snow", "Blowing snow, wind 14 m/s", ROADSIDE(-1.0), blowing_snow, WORLD, NULL, false},
    {"snowstorm", "Snowstorm, 4 mm/h, wind 16 m/s", ROADSIDE(-2.0), snowstorm, WORLD, NULL, true},
    {"snowy_windscreen", "Heavy snow on the windscreen, wipers going", ROADSIDE(1.0), heavy_snow, WORLD, with_wipers, true},
    {"lee_of_a_barn", "Snowstorm in the lee of a barn, 3 mm/h, wind 13 m/s, after three hours of it", LEE, lee_of_a_barn, WITH_BARN, NULL, true},
    {"wind", "The wind of that storm 2 m over the ground: blue 4 m/s, green 8, yellow 12, red 16", LEE, wind_in_numbers, WITH_BARN, NULL, true},
    {"blowing_sand", "Blowing sand, visibility 500 m", ROADSIDE(1.0), blowing_sand, WORLD, NULL, false},
    {"under_the_bridge", "Dry under the bridge, its windward edge wet", 67.5, 1.6, 1.9, SITE_VIEW_AZIMUTH_DEG + 10.0, -3.0, 50.0, under_the_bridge, WITH_BRIDGE, NULL, true},
    {"twelve_km", "12 km up", HIGH(12e3, 8.0, -2.0, 50.0), twelve_km, NO_WORLD, NULL, false},
    {"space", "200 km up: the limb", HIGH(200e3, 8.0, -14.0, 50.0), space, NO_WORLD, NULL, false},
    {"limb_with_clouds", "Clouds before the limb, 200 km up", HIGH(200e3, 8.0, -14.0, 30.0), limb_with_clouds, NO_WORLD, NULL, true},
    {"shadow", "200 km up at the terminator: the Earth's shadow", HIGH(200e3, 60.0, -16.0, 60.0), shadow, NO_WORLD, NULL, false},
    {"drawn_land", "Terrain that Welkin draws", HILLSIDE, drawn_land, LANDLESS, NULL, true},
    {"land_shadows", "Shadows of hills under a low sun", 0, 0, 420, SITE_VIEW_AZIMUTH_DEG + 14, -9, 55, land_shadows, LANDLESS, NULL, true},
    {"dug_soil", "A trench and its spoil", 52.5, -24.4, 3.6, SITE_VIEW_AZIMUTH_DEG + 160.0, -22.0, 38.0, dug_soil, LANDLESS, NULL, true},
    {"sea_breeze", "The open sea, wind 5 m/s", AFLOAT(6.0, SITE_VIEW_AZIMUTH_DEG, -4.0, 50.0), sea_breeze, OPEN_SEA, NULL, true},
    {"sea_storm", "A storm from 15 m up, wind 20 m/s", AFLOAT(15.0, SITE_VIEW_AZIMUTH_DEG, -5.0, 50.0), sea_storm, OPEN_SEA, NULL, false},
    {"sea_glitter", "The glitter of a low sun", AFLOAT(20.0, SITE_VIEW_AZIMUTH_DEG, -4.0, 50.0), sea_glitter, OPEN_SEA, NULL, true},
    {"sea_swell", "A swell of 3 m across the waves of the wind", AFLOAT(40.0, SITE_VIEW_AZIMUTH_DEG, -9.0, 50.0), sea_swell, OPEN_SEA, NULL, true},
    {"moonlit_sea", "The glitter of the moon", AFLOAT(10.0, SITE_VIEW_AZIMUTH_DEG, 3.0, 50.0), moonlit_sea, OPEN_SEA, NULL, true},
    {"sea_fog", "Fog over the water, visibility 400 m, with its fogbow", AFLOAT(5.0, SITE_VIEW_AZIMUTH_DEG, -3.0, 50.0), sea_fog, OPEN_SEA, NULL, true},
    {"sea_vessel", "A vessel on waves of 12 m/s, afloat by the queries", AFLOAT(7.0, SITE_VIEW_AZIMUTH_DEG, -5.0, 40.0), sea_vessel, WITH_VESSEL, NULL, true},
    {"sea_wake", "The wake of a vessel that turns", AFLOAT(60.0, SITE_VIEW_AZIMUTH_DEG, -21.0, 50.0), sea_wake, WITH_VESSEL, NULL, true},
};
const int SHOT_COUNT = sizeof SHOTS / sizeof SHOTS[0];

camera shot_camera(const shot *s, const ground *g)
{
    double x, y;
    ground_road_point(s->along_m, s->right_m, &x, &y);
    double level_m = s->world == OPEN_SEA || s->world == WITH_VESSEL ? 0.0 : ground_z(g, x, y);
    return (camera){vec(x, y, level_m + s->up_m), direction(s->azimuth_deg, s->elevation_deg), RAD(s->fov_y_deg)};
}
