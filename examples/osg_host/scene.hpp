/* The host's own world: what any OpenSceneGraph program has before it knows of weather. */
#ifndef SCENE_HPP
#define SCENE_HPP

#include <osg/Group>

#include "options.hpp"
#include "world.h"

/* What the numbers in the picture are: light (linear, tone-mapped at the end), or the display's, as legacy programs have. */
enum class Colors { Linear, Display };

/* Ground, objects and glass; null if the terrain cannot be read. The world stays loaded: see world_free. */
osg::ref_ptr<osg::Group> make_scene(const Options &options, Colors colors, world_site &site);

/* A box of uniform colour (linear albedo), its middle at `middle`. */
osg::ref_ptr<osg::Node> make_box(const osg::Vec3d &middle, const osg::Vec3d &size, const osg::Vec3 &albedo, Colors colors);

/* Panes of glass along the road, drawn after Welkin's MEDIUM: their shader looks up the veil. */
osg::ref_ptr<osg::Node> make_glass(const world_site &site, Colors colors);

/* osgParticle's rain with its fog, in place of Welkin's. Answers the fog's colour, which the background should have. */
osg::Vec4 add_osg_rain(osg::Group &scene);

#endif
