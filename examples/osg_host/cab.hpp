/* The excavator's cab, seen from its seat: posts and roof, the shelter from rain, and the windscreen with its wiper. */
#ifndef CAB_HPP
#define CAB_HPP

#include <osg/MatrixTransform>

#include <welkin.h>

#include "scene.hpp"

class Cab {
public:
    /* `seat` is the driver's frame in the world: x right, y ahead, z up, the eye at its origin. */
    Cab(const osg::Matrixd &seat, Colors colors);
    osg::ref_ptr<osg::Node> node() const { return root_; }

    void set_shelter(wk_context *context) const;
    /* Call in every frame before the view records; the blade moves with simulation time. */
    void set_windscreen(wk_view *view, const wk_context *context, double time_s) const;
    void move_wiper(double time_s);

private:
    osg::Matrixd seat_;
    osg::ref_ptr<osg::MatrixTransform> root_, blade_;
};

#endif
