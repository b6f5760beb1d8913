/* What a view's camera draws into: its window, or textures that are shown in the window afterwards. */
#ifndef WINDOW_HPP
#define WINDOW_HPP

#include <osgViewer/View>

#include "options.hpp"
#include "scene.hpp"
#include "welkin_osg.hpp"

osg::ref_ptr<osg::GraphicsContext> open_window(const Options &options, int number);

/* Sets the view's camera up, and the formats in `weather` with it. After setSceneData, which removes the camera's children. */
void set_target(osgViewer::View &view, const Options &options, welkin_osg::View &weather);

/* Two faults of OpenSceneGraph 3.6.5 that keep multisampled targets from being made; with the context current, before the first frame. */
void mend_multisampling(osg::GraphicsContext &window);

#endif
