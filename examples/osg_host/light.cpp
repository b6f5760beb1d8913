#include "light.hpp"

#include <cmath>

WeatherLight::WeatherLight(welkin_osg::View *weather, osg::View *view) : weather_(weather), light_(new osg::Light(0))
{
    view->setLight(light_);
    view->setLightingMode(osg::View::SKY_LIGHT);
}

void WeatherLight::operator()(osg::RenderInfo &info) const
{
    wk_view *view = weather_->get();
    if (!view) return;
    wk_context *context = weather_->weather->context();
    const osg::Vec3d eye = osg::Matrixd::inverse(info.getState()->getInitialViewMatrix()).getTrans();
    const double at[1][3] = {{eye.x(), eye.y(), eye.z()}};
    wk_celestial sun = WK_CELESTIAL_INIT, moon = WK_CELESTIAL_INIT;
    wk_ground_light light;
    if (!welkin_osg::check(wk_context_get_sun(context, at, &sun)) || !welkin_osg::check(wk_context_get_moon(context, at, &moon)) ||
        !welkin_osg::check(wk_context_get_light(context, at, 1, sizeof at[0], &light, sizeof light)))
        return;
    /* Fixed-function lighting has one sun here: whichever of the two gives more. */
    const bool by_day = light.sun_lux[1] >= light.moon_lux[1];
    const double *to = by_day ? sun.apparent : moon.apparent, *lux = by_day ? light.sun_lux : light.moon_lux;
    light_->setPosition(osg::Vec4(to[0], to[1], to[2], 0));

    /* A white card on level ground has the value 1, by day and by night: OpenGL clamps lit colours to 1. */
    const double unit = std::max(light.total_lux, 1e-4);
    weather_->frame.cd_m2_per_unit = unit / osg::PI;
    light_->setDiffuse(osg::Vec4(lux[0] / unit, lux[1] / unit, lux[2] / unit, 1));
    light_->setAmbient(osg::Vec4(light.sky_lux[0] / unit, light.sky_lux[1] / unit, light.sky_lux[2] / unit, 1));
    light_->setSpecular(osg::Vec4(0, 0, 0, 1));
}
