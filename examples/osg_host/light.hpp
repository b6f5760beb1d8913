/* Sets OpenGL's light 0 from Welkin's sun, moon and sky, for fixed-function lighting and shaders that read
 * gl_LightSource. */
#ifndef LIGHT_HPP
#define LIGHT_HPP

#include <osg/View>

#include "welkin_osg.hpp"

/* A pre-draw callback, to be added after View::attach. It runs on the thread that draws, so it needs no lock. */
class WeatherLight : public osg::Camera::DrawCallback {
public:
    /* Replaces the view's light, and fixes it in the world. */
    WeatherLight(welkin_osg::View *weather, osg::View *view);
    void operator()(osg::RenderInfo &info) const override;

private:
    osg::ref_ptr<welkin_osg::View> weather_;
    osg::ref_ptr<osg::Light> light_;
};

#endif
