//! Light that a place in a cloud scatters towards the eye, in f64. `shaders/clouds/light.wgsl` has the same formulas;
//! `mod.rs` of this folder describes the model.

use std::sync::Arc;

use glam::DVec3;

use super::transport::{Scattering, Table, Transport, leak_rate, table_at};

/// Steepness of the logistic function that divides the beam between top and side, in units of [`Scattering::turning`].
/// Photons traced through the cloud field (`lab photons`) fit best with 0.5, photons through cubes with 1.5.
const PART_RATE: f64 = 1.0;

/// Scaled optical depths of cloud around a place; [`super::transport`] defines the scale.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Depths {
    /// Depth straight up.
    pub above: f64,
    /// Depth straight down.
    pub below: f64,
    /// Depth towards the sun.
    pub to_sun: f64,
    /// Level depth towards the side where the sun stands.
    pub near: f64,
    /// Level depth away from the sun.
    pub far: f64,
    /// Level depth across the sun's direction, to the nearer edge of the cloud.
    pub left: f64,
    /// Level depth across the sun's direction, to the farther edge of the cloud.
    pub right: f64,
}

/// Tables of source terms (the light that a place scatters) for one medium under one sun. The cloud around a place is
/// taken as a box.
pub struct Sources {
    /// Scattering of the medium.
    pub scattering: Scattering,
    /// Unit vector towards the sun, (east, north, up).
    pub to_sun: DVec3,
    /// Source terms under the beam on the top of the box, or on its underside if the sun is below the horizon.
    pub top: Table,
    /// Source terms under the beam on the side of the box.
    pub side: Table,
    /// Source terms under a sky of radiance 1.
    pub sky: Arc<Table>,
}

/// Light that a place scatters into a direction per unit of scaled depth, as shares of the light that arrives at the
/// cloud.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Scattered {
    /// Share of the sun's irradiance on a surface facing it, 1/sr, with all orders of scattering.
    pub sun: f64,
    /// Share of the sun's irradiance that is scattered for the first time. Times a phase function, 1/sr, it is light
    /// that is scattered once.
    pub once: f64,
    /// Share of the sky's radiance.
    pub sky: f64,
    /// Share of the ground's radiance.
    pub ground: f64,
}

/// Returns the sum of Legendre polynomials with coefficients `terms` at `x`.
fn legendre_sum(terms: [f64; 4], x: f64) -> f64 {
    terms[0] + x * terms[1] + (1.5 * x * x - 0.5) * terms[2] + (2.5 * x * x - 1.5) * x * terms[3]
}

/// Returns the extent of a box for diffusing light, in scaled depth: its width, and beyond each side the distance 0.71
/// / `turning` at which the extrapolated light would be 0.
fn reach(near_depth: f64, far_depth: f64, turning: f64) -> f64 {
    (near_depth + far_depth).max(1e-3) + 1.42 / turning
}

/// Returns the profile of light between two opposite sides of a box, and its slope along that axis. `near` and `far`
/// are the depths from the place to the sides. The mean of the profile is 1.
///
/// `height` is the extent of the box along the axis on which the light comes. The profile is a cosine in a box no wider
/// than this. In a wider box more of the light leaves through the ends of that axis before it reaches a side, so the
/// profile is more even. It is also even near the face that the light falls on, in a box of any width; `entered` is the
/// depth of the place behind this face.
fn across([near, far]: [f64; 2], turning: f64, height: f64, entered: f64) -> (f64, f64) {
    let extent = reach(near, far, turning);
    let b = std::f64::consts::PI / extent;
    let (half, off) = (0.5 * b * (near + far).max(1e-3), 0.5 * b * (near - far));
    let mean = half.sin() / half;
    let sideways = (height / extent).powi(2);
    let set_in = 1.0 - (-turning * entered).exp();
    let share = (2.0 * sideways / (1.0 + sideways)).min(1.0) * set_in;
    (1.0 + share * (off.cos() / mean - 1.0), -b * off.sin() / mean * set_in)
}

impl Sources {
    /// Creates the tables for a medium under a sun.
    pub fn new(medium: &Transport, to_sun: DVec3) -> Self {
        let (cosine, sine) = (to_sun.z.clamp(-1.0, 1.0).abs(), to_sun.truncate().length());
        Self {
            top: medium.under_beam(cosine),
            side: medium.under_beam(sine),
            sky: medium.under_sky(),
            scattering: medium.scattering,
            to_sun,
        }
    }

    /// Returns the light that a place at these depths scatters into `direction`: the direction in which light travels,
    /// (east, north, up). `to_eye` is the scaled depth of cloud between the place and the eye. It only lowers the
    /// forward peak of the first scattering; the caller applies the extinction on that path.
    pub fn scattered(&self, depths: &Depths, direction: DVec3, to_eye: f64) -> Scattered {
        let of = &self.scattering;
        let turning = of.turning();
        let (sun, up) = (self.to_sun, direction.z);
        let (sine, cosine) = (sun.truncate().length(), sun.z.abs().max(0.01));
        // Horizontal direction in which sunlight travels.
        let level = if sine > 1e-6 { -sun.truncate() / sine } else { glam::DVec2::X };
        let along = direction.truncate().dot(level);
        let sideways = direction.truncate().dot(glam::DVec2::new(-level.y, level.x));
        let straight = -direction.dot(sun);
        let (above, below) = if sun.z >= 0.0 { (depths.above, depths.below) } else { (depths.below, depths.above) };
        let down = if sun.z >= 0.0 { -up } else { up };

        // The box has a vertical axis, a horizontal axis along the sun's direction, and one across it.
        let (height, depth) = (reach(above, below, turning), reach(depths.near, depths.far, turning));
        let [sides_a, sides_c] = [(depths.near, depths.far, along), (depths.left, depths.right, sideways)]
            .map(|(near, far, x)| (across([near, far], turning, height, above), x));
        let sides_u = (across([above, below], turning, depth, depths.near), down);
        let sides_across = (across([depths.left, depths.right], turning, depth, depths.near), sideways);
        let (a, c, u) = (depths.near + depths.far, depths.left + depths.right, above + below);
        let leak = leak_rate([a, c], turning);
        let spread = 1.0 / turning * of.scaled_albedo() * of.moments[1] / (4.0 * std::f64::consts::PI);
        let through = |terms: [f64; 4], axis: f64, sides: [((f64, f64), f64); 2]| {
            let [((s1, d1), x1), ((s2, d2), x2)] = sides;
            // terms[0] is the mean radiance times the scaled albedo. `mean` is the radiance summed over all directions.
            let mean = terms[0] / of.scaled_albedo() * 4.0 * std::f64::consts::PI;
            legendre_sum(terms, axis) * s1 * s2 - spread * mean * (d1 * s2 * x1 + d2 * s1 * x2)
        };

        let by_top = above / cosine;
        let by_side = if sine > 1e-6 { depths.near / sine } else { f64::INFINITY };
        let top_share = 1.0 / (1.0 + (PART_RATE * turning * (by_top - by_side)).min(80.0).exp());
        // The path to the sun may be longer than in the box. Light that is scattered often falls off slowly along it.
        let aside = ((1.0 + turning * by_top.min(by_side)) / (1.0 + turning * depths.to_sun)).min(1.0).powi(2);
        let share = aside * top_share.max(1.0 - top_share);
        let top = through(table_at(&self.top, above, below, leak), down, [sides_a, sides_c]);
        let side_leak = leak_rate([u, c], turning);
        let side = through(table_at(&self.side, depths.near, depths.far, side_leak), along, [sides_u, sides_across]);
        let side = if sine > 1e-6 { side } else { 0.0 };
        let momentum = (-turning * depths.to_sun).exp() - (-depths.to_sun).exp();
        let kept = of.scaled_albedo() * 3.0 * of.moments[1] / (4.0 * std::f64::consts::PI) * momentum;
        let level_kept = kept * (top_share * sine * along + (1.0 - top_share) * cosine * down);
        let first = of.scaled_albedo() * (-depths.to_sun).exp();
        let once = first * (of.smooth_phase(1.0 - straight) + of.peak(1.0 - straight, depths.to_sun + to_eye));
        let often = share * (top.max(0.0) + side.max(0.0));

        let from = |one: f64, other: f64, axis: f64| {
            through(table_at(&self.sky, one, other, leak), axis, [sides_a, sides_c]).max(0.0)
        };
        let (sky, ground) = (from(depths.above, depths.below, -up), from(depths.below, depths.above, up));
        // Through the sides as much light comes in as leaves. Half of it comes from the sky, half from the ground.
        let by_sides = 0.5 * (of.scaled_albedo() - sky - ground);
        Scattered {
            sun: once + often + level_kept.clamp(-often, often),
            once: first,
            sky: (sky + by_sides).max(0.0),
            ground: (ground + by_sides).max(0.0),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::light::{Phase, PhaseLobes};

    /// Light in the middle of a box whose width is `width` times its height.
    fn in_the_middle(width: f64) -> Scattered {
        let transport = Transport::new(Scattering::new(PhaseLobes::new(&Phase::HenyeyGreenstein { g: 0.85 }), 1.0));
        let (sine, cosine) = (0.5, 0.75f64.sqrt());
        let sources = Sources {
            scattering: transport.scattering,
            to_sun: DVec3::new(-sine, 0.0, cosine),
            top: transport.under_beam(cosine),
            side: transport.under_beam(sine),
            sky: transport.under_sky(),
        };
        let (half, side) = (4.0, 4.0 * width);
        let at =
            Depths { above: half, below: half, to_sun: half / cosine, near: side, far: side, left: side, right: side };
        sources.scattered(&at, DVec3::NEG_Z, 2.0)
    }

    #[test]
    fn a_cloud_between_sky_and_ground_of_one_light_is_as_bright() {
        for width in [0.25, 1.0, 4.0] {
            let s = in_the_middle(width);
            assert!((s.sky + s.ground - 1.0).abs() < 1e-9 && s.sky > 0.3, "{width}: {} and {}", s.sky, s.ground);
        }
    }

    #[test]
    fn a_wide_box_is_lit_as_a_layer_without_sides() {
        let (wide, endless) = (in_the_middle(16.0), in_the_middle(1e5));
        for (name, one, other) in
            [("sun", wide.sun, endless.sun), ("sky", wide.sky, endless.sky), ("ground", wide.ground, endless.ground)]
        {
            println!("{name}: {one:.4} and {other:.4}");
            assert!((one / other - 1.0).abs() < 0.03, "{name}: {one} in a wide box, {other} without sides");
        }
    }
}
