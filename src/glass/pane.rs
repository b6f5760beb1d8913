//! Pane of glass in the host's world: the drops that arrive at it, and the share that the host's boxes keep off.

use glam::{DMat3, DVec3};

use super::{
    geometry::Plane,
    reach::{Reach, SIZES},
    reach_pass::PaneUniform,
    windscreen::Windscreen,
};
use crate::{
    falling::sizes::{DropSizes, SMALLEST_MM, Weight},
    moment::SceneMoment,
    scene::Camera,
    surroundings::{MAX_SHELTERS, Shelter, shelter::sheltered},
};

/// Distance in front of the glass of the points for which shelter by boxes and maps is tested, m.
const BEFORE_M: f64 = 0.05;
/// Largest distance that a vehicle extends in front of its windscreen, m.
const VEHICLE_M: f64 = 3.0;

/// Pane of glass and the eye behind it, in the host's world, m.
pub(super) struct PaneAt {
    /// Position of the eye.
    eye: DVec3,
    /// Lower left corner of the pane's bounds, m.
    origin: DVec3,
    /// Vector from `origin` to the lower right corner of the pane's bounds, m.
    along: DVec3,
    /// Vector from `origin` to the upper left corner of the pane's bounds, m.
    up: DVec3,
    /// Unit vector outwards.
    out: DVec3,
    /// Velocity of the air relative to the glass, m/s.
    air_m_s: DVec3,
}

impl PaneAt {
    /// Creates the pane of a camera.
    pub fn new(camera: &Camera, plane: &Plane, screen: &Windscreen) -> Self {
        let to_world = camera.rotation().transpose();
        Self {
            eye: camera.position,
            origin: camera.position + to_world * plane.origin,
            along: to_world * (plane.u * plane.size_m.x),
            up: to_world * (plane.v * plane.size_m.y),
            out: to_world * plane.out,
            air_m_s: to_world * -screen.velocity_m_s,
        }
    }

    /// Returns whether a box is the vehicle's own: it contains the eye and ends within [`VEHICLE_M`] in front of the
    /// glass. The box of a tunnel extends farther.
    fn sits_in(&self, shelter: &Shelter) -> bool {
        let met = |p: DVec3, way: DVec3| sheltered(shelter, p, shelter.velocity_m_s - way);
        // The box is convex: a point is inside if both directions of a line through it meet the box.
        let before = self.at([0.5; 2]) + self.out * VEHICLE_M;
        met(self.eye, self.out) && met(self.eye, -self.out) && !met(before, self.out)
    }

    /// Returns a point of the pane. `x` and `y`, 0 to 1, are its distances from the lower left corner of the bounds, as
    /// shares of the width and the height.
    fn at(&self, [x, y]: [f64; 2]) -> DVec3 {
        self.origin + self.along * x + self.up * y
    }

    /// Returns drops of `sizes` that each represent an equal share of the falling water. Each has its present velocity
    /// in the host's world, and the share of the water on the pane that it brings.
    pub fn drops(&self, now: &SceneMoment<'_>, sizes: &DropSizes) -> [(DVec3, f64); SIZES] {
        let over = &now.weather;
        let to_enu = over.world.frame_at(self.origin).world_to_enu;
        let (normal, air) = (to_enu * self.out, to_enu * self.air_m_s);
        let known_s = now.time_s.max(over.timeline().known_from_s());
        let outside = || over.wind.at(known_s).velocity_m_s().extend(0.0);
        let weathers = over.carrying_at(self.origin, known_s).unwrap_or_else(|_| outside());
        let wind = now.wind_about(self.at([0.5; 2]), weathers);
        let middles = std::array::from_fn(|i| (i as f64 + 0.5) / SIZES as f64);
        let mut drops = sizes.diameters(Weight::Water, SMALLEST_MM, middles).map(|d| {
            let falls = sizes.speed_m_s(d);
            (to_enu.transpose() * (wind - DVec3::Z * falls), (falls * normal.z - air.dot(normal)).max(0.0) / falls)
        });
        let whole: f64 = drops.iter().map(|d| d.1).sum();
        drops.iter_mut().for_each(|d| d.1 = if whole > 0.0 { d.1 / whole } else { 1.0 / SIZES as f64 });
        drops
    }

    /// Returns the share of the rain, given by the results of [`Self::drops`], that boxes now let through to each part
    /// of the pane. The vehicle's own box is left out.
    pub fn reach(&self, shelters: &[Shelter], drops: &[(DVec3, f64); SIZES]) -> Reach {
        if shelters.is_empty() {
            return Reach::ALL;
        }
        let mut own = [false; MAX_SHELTERS];
        shelters.iter().zip(&mut own).for_each(|(b, own)| *own = self.sits_in(b));
        let others = || shelters.iter().zip(&own).filter(|(_, own)| !**own).map(|(b, _)| b);
        Reach::of(|place| {
            let before = self.at(place) + self.out * BEFORE_M;
            let kept = drops.iter().filter(|(velocity, _)| others().any(|b| sheltered(b, before, *velocity)));
            (1.0 - kept.map(|d| d.1).sum::<f64>()).max(0.0)
        })
    }

    /// Returns the pane and its drops as uniforms for the maps' pass. The camera is at `eye`; `to_enu` is the rotation
    /// from the host's axes to east, north, up at the camera.
    pub fn uniform(&self, drops: &[(DVec3, f64); SIZES], (eye, to_enu): (DVec3, DMat3)) -> PaneUniform {
        let row = |v: DVec3, w: f64| (to_enu * v).extend(w).as_vec4().to_array();
        PaneUniform {
            origin: row(self.origin + self.out * BEFORE_M - eye, 0.0),
            along: row(self.along, 0.0),
            up: row(self.up, 0.0),
            drops: drops.map(|(velocity, share)| row(velocity, share)),
        }
    }
}
