/* The weather of the host: opened when a window is, told the report and the time, closed before the window. */
#ifndef WEATHER_HPP
#define WEATHER_HPP

#include <map>

#include "options.hpp"
#include "welkin_osg.hpp"
#include "world.h"

/* One welkin_osg::Weather for each graphics context; to be set as the viewer's realize operation. */
class WeatherOfWindows : public osg::Operation {
public:
    WeatherOfWindows(const Options &options, const world_site &site) : osg::Operation("weather", false), options_(options), site_(site) {}
    /* Made ahead of the window's realization, so that views can be attached. */
    welkin_osg::Weather *of(osg::GraphicsContext *window);
    void operator()(osg::Object *window) override;
    /* With all threads stopped. */
    void close();
    bool ok = true;

private:
    bool open(welkin_osg::Weather &weather, osg::GraphicsContext *window);
    Options options_;
    world_site site_;
    std::map<osg::ref_ptr<osg::GraphicsContext>, osg::ref_ptr<welkin_osg::Weather>> weathers_;
};

#endif
