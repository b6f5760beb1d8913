#include "weather.hpp"

#include <iostream>

#include "window.hpp"

using welkin_osg::check;

namespace {

const int NODES = 192;
const double CELL_M = 0.5;

} // namespace

WeatherOfWindows::WeatherOfWindows(const Options &options, const world_site &site)
    : osg::Operation("weather", false), options_(options), site_(site)
{
    if (options.leap_h <= 0.0) return;
    for (int north = 0; north < NODES; north++)
        for (int east = 0; east < NODES; east++)
            heights_.push_back(float(world_height(site.pad[0] + (east - 0.5 * NODES) * CELL_M, site.pad[1] + (north - 0.5 * NODES) * CELL_M)));
}

/* The ground around the pad, on which rain fills hollows and dries. */
bool WeatherOfWindows::simulate_ground(wk_context *context) const
{
    wk_ground_grid grid = WK_GROUND_GRID_INIT;
    grid.origin_m[0] = site_.pad[0] - 0.5 * NODES * CELL_M;
    grid.origin_m[1] = site_.pad[1] - 0.5 * NODES * CELL_M;
    grid.cell_m = CELL_M;
    grid.nodes[0] = grid.nodes[1] = NODES;
    grid.heights_m = heights_.data();
    grid.height_count = uint32_t(heights_.size());
    return check(wk_context_set_ground_grid(context, &grid));
}

welkin_osg::Weather *WeatherOfWindows::of(osg::GraphicsContext *window)
{
    osg::ref_ptr<welkin_osg::Weather> &weather = weathers_[window];
    if (!weather) weather = new welkin_osg::Weather;
    return weather;
}

void WeatherOfWindows::operator()(osg::Object *object)
{
    auto *window = dynamic_cast<osg::GraphicsContext *>(object);
    if (window) mend_multisampling(*window);
    if (window && !of(window)->context()) ok = open(*of(window), window) && ok;
}

bool WeatherOfWindows::open(welkin_osg::Weather &weather, osg::GraphicsContext *window)
{
    wk_context_desc place = WK_CONTEXT_DESC_INIT;
    place.world_kind = WK_WORLD_TANGENT; /* OSG's z up is Welkin's default */
    place.latitude_deg = site_.latitude_deg;
    place.longitude_deg = site_.longitude_deg;
    place.cache_dir = options_.cache.empty() ? nullptr : options_.cache.c_str();
    wk_simulation_desc simulation = WK_SIMULATION_DESC_INIT;
    simulation.ground_model = WK_GROUND_SIMULATED;
    if (!heights_.empty()) place.next = &simulation;
    if (!weather.open(window, options_.shared ? WK_OPENGL_SHARED : WK_OPENGL_HOST_CONTEXT, place)) return false;

    wk_weather report = WK_WEATHER_INIT;
    wk_cloud_layer layers[16];
    double utc = 0.0;
    if (!check(wk_weather_from_metar(options_.metar.c_str(), layers, 16, sizeof layers[0], &report, nullptr)) ||
        !check(wk_utc_from_calendar(2026, 6, 21, 0, 0, 0.0, &utc)))
        return false;
    report.station_altitude_m = site_.pad[2]; /* reports do not contain it; wind heights count from it */
    wk_context *context = weather.context();
    if (!check(wk_context_set_clock(context, utc + 3600.0 * options_.hour_utc, 3600.0 * options_.leap_h)) ||
        !check(wk_context_set_weather(context, &report, 0.0, 0.0)) || !(heights_.empty() || simulate_ground(context)))
        return false;

    /* Build the sky now with a progress display, not in the first frame; with --cache it is fast from the second start
     * on. */
    const auto progress = [](void *, double share) -> int32_t {
        std::cerr << "\rsky " << int(100.0 * share) << " %" << (share < 1.0 ? "" : "\n");
        return 0;
    };
    return check(wk_context_build_sky(context, progress, nullptr));
}

void WeatherOfWindows::close()
{
    for (auto &of_window : weathers_) {
        osg::GraphicsContext *window = of_window.first.get();
        const bool alive = window->valid() && window->isRealized() && window->makeCurrent();
        of_window.second->close(); /* if the window is gone, Welkin abandons its OpenGL objects */
        if (alive) window->releaseContext();
    }
    weathers_.clear();
}
