/* The host's own world: the part that any OpenSceneGraph program has before it has weather. */
#ifndef SCENE_HPP
#define SCENE_HPP

#include <osg/Group>

#include "options.hpp"
#include "world.h"

/* Meaning of the picture's values: light (linear, tone-mapped at the end), or display values, as in legacy programs. */
enum class Colors { Linear, Display };

/* Creates ground, objects and glass; null if the terrain cannot be read. The world stays loaded until world_free. */
osg::ref_ptr<osg::Group> make_scene(const Options &options, Colors colors, world_site &site);

/* Creates a box of uniform colour (linear albedo), centred at `middle`. */
osg::ref_ptr<osg::Node> make_box(const osg::Vec3d &middle, const osg::Vec3d &size, const osg::Vec3 &albedo, Colors colors);

/* Creates panes of glass along the road, drawn after Welkin's MEDIUM stage. Their shader looks up the veil. */
osg::ref_ptr<osg::Node> make_glass(const world_site &site, Colors colors);

/* Adds osgParticle's rain with its fog, in place of Welkin's. Returns the fog's colour, to be used as the
 * background. */
osg::Vec4 add_osg_rain(osg::Group &scene);

#endif
