#include <osgParticle/PrecipitationEffect>

#include "scene.hpp"

/* As in OSG's own example: one intensity for particles and fog, and the fog's colour as the background. */
osg::Vec4 add_osg_rain(osg::Group &scene)
{
    osg::ref_ptr<osgParticle::PrecipitationEffect> rain = new osgParticle::PrecipitationEffect;
    rain->rain(0.5f);
    scene.getOrCreateStateSet()->setAttributeAndModes(rain->getFog());
    scene.addChild(rain);
    return rain->getFog()->getColor();
}
