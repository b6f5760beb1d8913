/* The target of a view's camera: its window, or textures that are then shown in the window. */
#ifndef WINDOW_HPP
#define WINDOW_HPP

#include <osgViewer/View>

#include "options.hpp"
#include "scene.hpp"
#include "welkin_osg.hpp"

osg::ref_ptr<osg::GraphicsContext> open_window(const Options &options, int number);

/* Sets up the view's camera, and the formats in `weather` to match. Call it after setSceneData, which removes the
 * camera's children. */
void set_target(osgViewer::View &view, const Options &options, welkin_osg::View &weather);

/* Works around two faults of OpenSceneGraph 3.6.5 that prevent multisampled targets. Call it with the context current,
 * before the first frame. */
void mend_multisampling(osg::GraphicsContext &window);

#endif
