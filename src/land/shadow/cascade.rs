//! Geometry of shadow maps, and when a map is drawn anew. The maps are squares around the eye, perpendicular to the
//! light, one inside the other.
//!
//! Maps are centred at the eye and not fitted to its frustum: a camera that turns needs no new map, and a map around a
//! slice of a wide frustum would have to be about as large. Half sides grow by one ratio, so that a texel covers about
//! the same number of pixels where each map begins (Zhang et al. 2006, logarithmic splits).

use glam::{DMat3, DMat4, DVec3, DVec4};

use crate::land::uniforms::{CASCADES, CascadeUniform};

/// Least distance at which the finest map begins, m.
const NEAREST_M: f64 = 1.0;
/// Least ratio of a map's half side to that of the next finer map.
const LEAST_RATIO: f64 = 2.0;
/// Share by which a map's half side is larger than needed, and share of the half side by which the eye may move before
/// the map is drawn anew.
const MARGIN: f64 = 0.125;
/// Angle that the light may turn before a map is drawn anew, rad: a tenth of the light's disc, and so of any penumbra.
const TURN: f64 = 9.3e-4;
/// Distances along the light's direction from a map's centre, in half sides: how far the map reaches away from the
/// light, and up to what distance, on both sides of the centre, the map is used.
const BEHIND: f64 = 1.25;
const BESIDE: f64 = 1.2;
/// Tangent of the radius of the discs of sun and moon: 0.267 degrees.
pub(crate) const DISC: f64 = 0.00465;

/// Map as it was drawn. Places are in metres along the lattice's axes from its origin.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Cascade {
    /// Directions of the map's columns and rows, and towards the light.
    axes: DMat3,
    /// Eye for which the map was drawn, and the centre of the map: the place on the grid of texels that is nearest to
    /// this eye.
    eye: DVec3,
    centre: DVec3,
    half_m: f64,
    /// Distance along the light's direction from the centre to the ground that is nearest to the light, at least
    /// `half_m`.
    top_m: f64,
    /// Texels along a side.
    side: u32,
}

/// Returns the distance, m, at which the finest map begins, for an eye at a height above the ground around it: the
/// largest power of two up to the height. A height below 1 m is taken as 1 m. The distance so far, `kept_m`, remains if
/// it is between 0.4 and 1.25 times the height, so that an eye which bobs needs no new maps.
pub(super) fn nearest_m(above_m: f64, kept_m: f64) -> f64 {
    let above = above_m.max(NEAREST_M);
    if kept_m <= 1.25 * above && 2.5 * kept_m > above { kept_m } else { libm::exp2(libm::log2(above).floor()) }
}

/// Half sides that maps should have, m, if the finest begins at the distance `nearest_m` and the coarsest reaches at
/// least `reach_m`. `reach_m` is rounded up in steps of a factor of sqrt 2, because a map is drawn anew when its half
/// side changes.
pub(super) fn half_sides_m(nearest_m: f64, reach_m: f64) -> [f64; CASCADES] {
    let reach = libm::exp2(0.5 * (2.0 * libm::log2(reach_m.max(1.0))).ceil());
    let ratio = libm::pow(reach / nearest_m, 1.0 / CASCADES as f64).max(LEAST_RATIO);
    std::array::from_fn(|i| (1.0 + MARGIN) * nearest_m * libm::pow(ratio, i as f64 + 1.0))
}

impl Cascade {
    /// Returns the map around an eye with a half side, for light from the direction `light`.
    pub fn new(light: DVec3, eye: DVec3, half_m: f64, side: u32) -> Self {
        let level = DVec3::new(-light.y, light.x, 0.0);
        let column = if level.length() > 1e-6 { level.normalize() } else { DVec3::X };
        let axes = DMat3::from_cols(column, light.cross(column), light);
        // Maps around different eyes differ by whole texels, so that shadows of resting objects keep their edges while
        // the eye moves.
        let texel = 2.0 * half_m / f64::from(side);
        let place = axes.transpose() * eye;
        let snapped = DVec3::new((place.x / texel).round() * texel, (place.y / texel).round() * texel, place.z);
        Self { axes, eye, centre: axes * snapped, half_m, top_m: half_m, side }
    }

    /// Direction towards the light.
    pub fn light(&self) -> DVec3 {
        self.axes.z_axis
    }

    /// Extends the map towards the light, so that it holds a box with these corners, m.
    pub fn hold(&mut self, low: DVec3, high: DVec3) {
        let towards = self.light();
        let far = DVec3::select(towards.cmpgt(DVec3::ZERO), high, low);
        self.top_m = self.top_m.max(towards.dot(far - self.centre));
    }

    /// Distance between depth 0 and 1, m.
    fn range_m(&self) -> f64 {
        self.top_m + BEHIND * self.half_m
    }

    /// Matrix from metres about an eye, along the lattice's axes, to the map's clip space. Depth 1 is nearest to the
    /// light.
    pub fn clip(&self, eye: DVec3) -> DMat4 {
        let off = eye - self.centre;
        let row = |axis: DVec3, scale: f64, add: f64| (axis * scale).extend(axis.dot(off) * scale + add);
        DMat4::from_cols(
            row(self.axes.x_axis, 1.0 / self.half_m, 0.0),
            row(self.axes.y_axis, 1.0 / self.half_m, 0.0),
            row(self.axes.z_axis, 1.0 / self.range_m(), BEHIND * self.half_m / self.range_m()),
            DVec4::W,
        )
        .transpose()
    }

    /// Constants with which the shader finds the texels of places about an eye.
    pub fn uniform(&self, eye: DVec3) -> CascadeUniform {
        let rows = self.clip(eye).transpose();
        let texture = |row: DVec4, turn: f64| (row * (0.5 * turn) + DVec4::W * 0.5).as_vec4().to_array();
        let (range, side, texel) = (self.range_m(), 2.0 * self.half_m, 1.0 / f64::from(self.side));
        let size = [range, side * side / range, 1.0 / (BESIDE * self.half_m), -BEHIND * self.half_m];
        CascadeUniform {
            u: texture(rows.x_axis, 1.0),
            v: texture(rows.y_axis, -1.0),
            depth: rows.z_axis.as_vec4().to_array(),
            size: size.map(|v| v as f32),
            texel: [texel, side * texel / range, DISC * range / (side * texel), 1.0 / range].map(|v| v as f32),
        }
    }

    /// Lateness of the map for an eye, a light and a half side: the largest of their changes since the map was drawn,
    /// each as a share of the change that is allowed. From 1 on the map is due to be drawn anew.
    pub fn lateness(&self, light: DVec3, eye: DVec3, half_m: f64) -> f64 {
        let moved = (eye - self.eye).length() / (MARGIN * self.half_m);
        let turned = light.cross(self.light()).length() / TURN;
        let turned = if light.dot(self.light()) < 0.0 { f64::INFINITY } else { turned };
        let resized = if half_m == self.half_m { 0.0 } else { 1.0 };
        moved.max(turned).max(resized)
    }

    /// Side of a texel, m.
    #[cfg(test)]
    pub fn texel_m(&self) -> f64 {
        2.0 * self.half_m / f64::from(self.side)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn places_and_texels_agree_with_the_matrix() {
        let light = DVec3::new(0.6, -0.3, 0.4).normalize();
        let eye = DVec3::new(1234.5, -777.25, 88.0);
        let mut map = Cascade::new(light, eye, 40.0, 480);
        map.hold(eye - 10.0, eye + DVec3::new(900.0, 10.0, 300.0));
        let from = eye + DVec3::new(3.0, 2.0, -1.0);
        let place = DVec3::new(5.0, -7.0, 2.5);
        let clip = map.clip(from).project_point3(place);
        let block = map.uniform(from);
        let at = |row: [f32; 4]| (0..3).map(|i| f64::from(row[i]) * place[i]).sum::<f64>() + f64::from(row[3]);
        assert!((at(block.u) - (0.5 + 0.5 * clip.x)).abs() < 1e-5 && (at(block.v) - (0.5 - 0.5 * clip.y)).abs() < 1e-5);
        assert!((at(block.depth) - clip.z).abs() < 1e-5 && (0.0..1.0).contains(&clip.z));
        // Nearer to the light by 1 m, the depth grows by 1 m.
        let nearer = map.clip(from).project_point3(place + light);
        assert!(((nearer.z - clip.z) * f64::from(block.size[0]) - 1.0).abs() < 1e-4);
        assert!((nearer - clip).truncate().length() < 1e-9);
        // The highest corner of the box that the map holds lies at depth 1.
        let top = map.clip(DVec3::ZERO).project_point3(eye + DVec3::new(900.0, -10.0, 300.0));
        assert!((top.z - 1.0).abs() < 1e-9, "{top}");
    }

    #[test]
    fn maps_around_eyes_that_are_near_each_other_differ_by_whole_texels() {
        let light = DVec3::new(0.2, 0.7, 0.5).normalize();
        let a = Cascade::new(light, DVec3::new(10.0, 20.0, 3.0), 40.0, 480);
        let b = Cascade::new(light, DVec3::new(11.7, 19.1, 3.4), 40.0, 480);
        let off = a.axes.transpose() * (a.centre - b.centre) / a.texel_m();
        assert!((off - off.round()).truncate().length() < 1e-6 && off.truncate().length() > 1.0, "{off}");
    }

    #[test]
    fn a_map_is_due_when_the_eye_the_light_or_its_size_has_changed() {
        let (light, eye) = (DVec3::new(0.2, 0.7, 0.5).normalize(), DVec3::new(10.0, 20.0, 3.0));
        let map = Cascade::new(light, eye, 40.0, 480);
        assert_eq!(map.lateness(light, eye, 40.0), 0.0);
        assert!(map.lateness(light, eye + DVec3::X * 4.9, 40.0) < 1.0);
        assert!(map.lateness(light, eye + DVec3::X * 5.1, 40.0) > 1.0);
        assert!(map.lateness(light, eye, 41.0) >= 1.0);
        let turned = |angle: f64| glam::DQuat::from_axis_angle(DVec3::X, angle) * light;
        assert!(map.lateness(turned(5e-4), eye, 40.0) < 1.0 && map.lateness(turned(2e-3), eye, 40.0) > 1.0);
        assert!(map.lateness(-light, eye, 40.0) > 1.0);
    }

    #[test]
    fn an_eye_that_bobs_keeps_its_maps() {
        assert_eq!([1.0, 1.9, 2.4, 1.7].map(|above| nearest_m(above, 2.0)), [1.0, 2.0, 2.0, 2.0]);
        assert_eq!([4.9, 5.1].map(|above| nearest_m(above, 2.0)), [2.0, 4.0]);
    }

    /// Side of a texel where the finest map begins and where the next map takes over, in pixels of a picture that is
    /// 1080 rows and 60 degrees high, for an eye 2 m above the ground and shadows up to a distance.
    fn texel_px(reach_m: f64) -> [f64; 2] {
        let nearest = nearest_m(2.0, 0.0);
        let half_m = half_sides_m(nearest, reach_m)[0];
        let pixel = 2.0 * libm::tan(std::f64::consts::FRAC_PI_6) / 1080.0;
        [nearest, 0.85 * half_m].map(|distance| 2.0 * half_m / 1440.0 / (distance * pixel))
    }

    #[test]
    fn texels_are_a_few_pixels_large() {
        let (far, near) = (texel_px(1e4), texel_px(500.0));
        println!("10 km: {far:.1?} px, 500 m: {near:.1?} px");
        assert!((far[0] - 13.0).abs() < 0.5 && (far[1] - 1.5).abs() < 0.05 && near[0] < 6.5);
    }

    #[test]
    fn half_sides_grow_by_one_ratio_from_the_height_of_the_eye_to_the_farthest_ground() {
        for (above, reach) in [(1.7f64, 26_000.0f64), (0.0, 300.0), (900.0, 26_000.0), (1e5, 2e6)] {
            let nearest = nearest_m(above, 0.0);
            assert!(nearest <= above.max(1.0) && 2.0 * nearest > above);
            let sides = half_sides_m(nearest, reach);
            let ratio = sides[1] / sides[0];
            assert!(sides.windows(2).all(|pair| (pair[1] / pair[0] - ratio).abs() < 1e-9) && ratio >= 2.0);
            assert!(sides[0] > nearest && sides[3] >= reach, "{sides:?}");
        }
    }
}
