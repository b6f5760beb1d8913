#include "light.hpp"

#include <algorithm>

WeatherLight::WeatherLight(welkin_osg::View *weather, osg::View *view) : weather_(weather), light_(new osg::Light(0))
{
    view->setLight(light_);
    view->setLightingMode(osg::View::SKY_LIGHT);
}

void WeatherLight::operator()(osg::RenderInfo &info) const
{
    if (!weather_->get()) return;
    const osg::Vec3d eye = osg::Matrixd::inverse(info.getState()->getInitialViewMatrix()).getTrans();
    wk_frame frame = weather_->frame; /* takes its colour space and exposure; the camera position is this frame's */
    std::copy_n(eye.ptr(), 3, frame.position_m);
    frame.cd_m2_per_unit = 1.0;
    wk_frame_light light = WK_FRAME_LIGHT_INIT;
    if (!welkin_osg::check(wk_context_get_frame_light(weather_->weather->context(), &frame, &light))) return;

    /* Display values are final. For luminance, the unit is chosen so that white level ground has the value 1 by day and
     * by night, because OpenGL clamps lit colours to 1. */
    double unit = 1.0;
    if (frame.color_space == WK_COLOR_SCENE_LINEAR) {
        unit = std::max(light.ambient[1] + light.direct[1] * std::max(light.direction[2], 0.0), 1e-4);
        weather_->frame.cd_m2_per_unit = unit;
    }
    light_->setPosition(osg::Vec4(light.direction[0], light.direction[1], light.direction[2], 0));
    light_->setDiffuse(osg::Vec4(light.direct[0] / unit, light.direct[1] / unit, light.direct[2] / unit, 1));
    light_->setAmbient(osg::Vec4(light.ambient[0] / unit, light.ambient[1] / unit, light.ambient[2] / unit, 1));
    light_->setSpecular(osg::Vec4(0, 0, 0, 1));
}
