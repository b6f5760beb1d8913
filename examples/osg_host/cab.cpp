#include "cab.hpp"

#include <algorithm>
#include <cmath>

#include "welkin_osg.hpp"

namespace {

/* The pane: upright, in front of the eye. */
const double LEFT = -0.40, RIGHT = 0.40, BOTTOM = -0.42, TOP = 0.31, AHEAD = 0.8;
const double PIVOT_X = 0.66, PIVOT_Y = 0.03, LENGTH = 0.62, INNER = 0.1, PARKED = 172.0, FAR = 92.0; /* m and degrees */

/* Wiper position, 0 to 1: there and back in 1.4 s, slower at both ends. */
double stroke(double time_s) { return 0.5 - 0.5 * std::cos(2.0 * osg::PI * time_s / 1.4); }

} // namespace

Cab::Cab(const osg::Matrixd &seat, Colors colors) : seat_(seat), root_(new osg::MatrixTransform(seat)), blade_(new osg::MatrixTransform)
{
    const osg::Vec3 paint(0.60f, 0.33f, 0.03f), dark(0.02f, 0.02f, 0.022f);
    for (double side : {-1.0, 1.0}) root_->addChild(make_box({side * 0.47, AHEAD, -0.05}, {0.09, 0.09, 1.1}, paint, colors));
    root_->addChild(make_box({0, AHEAD, TOP + 0.1}, {1.04, 0.12, 0.13}, paint, colors));
    root_->addChild(make_box({0, AHEAD - 0.06, BOTTOM - 0.12}, {1.04, 0.3, 0.22}, dark, colors));
    root_->addChild(make_box({0.28, AHEAD - 0.2, BOTTOM + 0.04}, {0.16, 0.03, 0.12}, dark, colors));
    blade_->addChild(make_box({0.5 * (INNER + LENGTH), 0, 0}, {LENGTH - INNER, 0.012, 0.014}, dark, colors));
    blade_->addChild(make_box({0.5 * INNER, 0, 0}, {INNER, 0.02, 0.01}, dark, colors));
    blade_->setDataVariance(osg::Object::DYNAMIC); /* keeps OSG's optimizer from flattening it */
    root_->addChild(blade_);
    move_wiper(0.0);
}

void Cab::move_wiper(double time_s)
{
    const double angle = osg::DegreesToRadians(PARKED + (FAR - PARKED) * stroke(time_s));
    blade_->setMatrix(osg::Matrixd::rotate(-angle, osg::Vec3d(0, 1, 0)) *
                      osg::Matrixd::translate(LEFT + PIVOT_X, AHEAD + 0.02, BOTTOM + PIVOT_Y));
}

void Cab::set_shelter(wk_context *context) const
{
    /* One box around the driver for roof, back and sides, from the back to the glass. */
    const osg::Vec3d middle = osg::Vec3d(0, -0.1, -0.3) * seat_;
    wk_shelter box = WK_SHELTER_INIT;
    std::copy_n(middle.ptr(), 3, box.center_m);
    for (int axis = 0; axis < 3; axis++)
        for (int i = 0; i < 3; i++) box.axes[3 * axis + i] = seat_(axis, i);
    box.half_size_m[0] = 0.52, box.half_size_m[1] = AHEAD + 0.1, box.half_size_m[2] = 0.85;
    welkin_osg::check(wk_context_set_shelters(context, &box, 1, sizeof box));
}

void Cab::set_windscreen(wk_view *view, const wk_context *context, double time_s) const
{
    /* Velocity of the cab relative to the air, in the camera's axes: rain moves with the air, and the cab stands
     * still. */
    wk_wind wind = WK_WIND_INIT;
    const osg::Vec3d eye = seat_.getTrans();
    const double at[3] = {eye.x(), eye.y(), eye.z()};
    if (!welkin_osg::check(wk_context_get_wind_at(context, &at, time_s, &wind))) return;
    const osg::Vec3d air(wind.velocity_m_s[0], wind.velocity_m_s[1], wind.velocity_m_s[2]);
    const osg::Vec3d met = osg::Matrixd::transform3x3(-air, osg::Matrixd::inverse(seat_)); /* right, ahead, up */

    wk_wiper_arm arm = WK_WIPER_ARM_INIT;
    arm.pivot_m[0] = PIVOT_X, arm.pivot_m[1] = PIVOT_Y;
    arm.length_m = LENGTH, arm.inner_radius_m = INNER;
    arm.parked_deg = PARKED, arm.far_deg = FAR;
    arm.position = stroke(time_s);
    wk_windscreen pane = WK_WINDSCREEN_INIT;
    const double corners[12] = {LEFT, BOTTOM, -AHEAD, RIGHT, BOTTOM, -AHEAD, RIGHT, TOP, -AHEAD, LEFT, TOP, -AHEAD};
    std::copy_n(corners, 12, pane.corners_m); /* in the camera's axes, as this driver looks straight ahead */
    pane.velocity_m_s[0] = met.x(), pane.velocity_m_s[1] = met.z(), pane.velocity_m_s[2] = -met.y();
    pane.arms = &arm;
    pane.arm_count = 1;
    welkin_osg::check(wk_view_set_windscreen(view, &pane));
}
