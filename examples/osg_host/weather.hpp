/* The host's weather: opened together with a window, given the report and the time, closed before the window. */
#ifndef WEATHER_HPP
#define WEATHER_HPP

#include <map>

#include "options.hpp"
#include "welkin_osg.hpp"
#include "world.h"

/* One welkin_osg::Weather for each graphics context. Set it as the viewer's realize operation. */
class WeatherOfWindows : public osg::Operation {
public:
    /* Call while the world's heights are loaded. */
    WeatherOfWindows(const Options &options, const world_site &site);
    /* Returns the weather of a window, created before the window is realized so that views can be attached. */
    welkin_osg::Weather *of(osg::GraphicsContext *window);
    void operator()(osg::Object *window) override;
    /* Call with all threads stopped. */
    void close();
    bool ok = true;

private:
    bool open(welkin_osg::Weather &weather, osg::GraphicsContext *window);
    bool simulate_ground(wk_context *context) const;
    Options options_;
    world_site site_;
    std::vector<float> heights_; /* around the pad, for the simulated ground */
    std::map<osg::ref_ptr<osg::GraphicsContext>, osg::ref_ptr<welkin_osg::Weather>> weathers_;
};

#endif
