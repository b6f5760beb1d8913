//! Plans of weather regions as a camera sees them.

use glam::{DMat3, DVec2, DVec3};

use super::region::{FARTHEST_M, HeldRegion, PlanPoint};
use crate::scene::{WorldFrame, WorldKind};

/// Mean radius of the Earth, m.
const RADIUS_M: f64 = 6.371e6;

/// Region as a camera sees it on the region's plan.
#[derive(Clone, Copy, Debug)]
pub(crate) struct SeenRegion<'a> {
    pub region: &'a HeldRegion,
    /// Position of the camera on the plan, m to the right of the centre and ahead of it.
    pub camera_m: DVec2,
    /// Vector to the right on the plan, (east, north) at the camera. Its length is the length, measured on the plan, of
    /// a metre at the camera.
    pub right: DVec2,
    /// Vector ahead on the plan, (east, north) at the camera, as long as `right`.
    pub ahead: DVec2,
    /// Distance of the camera from the border, m, negative inside. Beyond the perimeter it may be less than the true
    /// distance, but not less than the perimeter.
    pub distance_m: f64,
}

impl SeenRegion<'_> {
    /// Returns the weight of the region at the camera.
    pub fn weight(&self) -> f64 {
        self.region.plan.weight(self.distance_m)
    }

    /// Returns the radius, m, of the circle about the centre beyond which the region does not act.
    pub fn reach_m(&self) -> f64 {
        self.region.plan.shape.radius_m() + self.region.plan.perimeter_m
    }

    /// Returns the position of the centre, m (east, north) from the camera.
    pub fn center_m(&self) -> DVec2 {
        -(self.right * self.camera_m.x + self.ahead * self.camera_m.y)
    }
}

impl HeldRegion {
    /// Returns the region as a camera at `eye`, with the axes `world_to_enu`, sees it at a time; `None` if the region
    /// does not act or is too far away to be seen.
    pub fn seen_at(&self, world: &WorldFrame, eye: DVec3, world_to_enu: &DMat3, time_s: f64) -> Option<SeenRegion<'_>> {
        if self.plan.strength == 0.0 {
            return None;
        }
        let axes = self.plan.at(world, time_s);
        if !axes.is_within(eye, self.plan.reach_m()) {
            return None;
        }
        let level = |axis: DVec3| (*world_to_enu * axis).truncate().normalize_or(DVec2::X);
        let point = PlanPoint::new(world, eye);
        let camera_m = axes.plan(&point);
        let distance_m = self.plan.distance_m(camera_m);
        // On a round planet verticals come together downwards.
        let shrink = if world.kind == WorldKind::Flat { 1.0 } else { RADIUS_M / (RADIUS_M + point.altitude_m()) };
        let ahead = level(axes.ahead()) * shrink;
        let right = DVec2::new(ahead.y, -ahead.x);
        let is_seen = distance_m - self.plan.perimeter_m < FARTHEST_M;
        is_seen.then_some(SeenRegion { region: self, camera_m, right, ahead, distance_m })
    }
}
