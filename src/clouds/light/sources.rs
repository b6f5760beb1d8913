//! Light that a place in a cloud scatters towards an eye. Twin of `shaders/clouds/light.wgsl`; the model is told in the
//! folder's `mod.rs`.

use std::sync::Arc;

use glam::DVec3;

use super::transport::{Scattering, Table, Transport, leak_rate, table_at};

/// How fast the faces' shares of the beam part, over the rate at which light turns: photons through the field ask for
/// half as much (`lab photons`), photons through cubes for one and a half times as much.
const PART_RATE: f64 = 1.0;

/// Scaled depths of cloud about a place.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Depths {
    /// Straight up.
    pub above: f64,
    /// Straight down.
    pub below: f64,
    /// Along the way to the sun.
    pub to_sun: f64,
    /// Level, to the side where the sun stands.
    pub near: f64,
    /// Level, the other way.
    pub far: f64,
    /// Level, across the sun's direction, to the nearer side.
    pub left: f64,
    /// Level, across the sun's direction, to the other side.
    pub right: f64,
}

/// Source terms of one medium under one sun.
pub struct Sources {
    /// The medium.
    pub scattering: Scattering,
    /// Unit, towards the sun; (east, north, up).
    pub to_sun: DVec3,
    /// Under the beam on the top; on the underside where the sun is below the horizon.
    pub top: Table,
    /// Under the beam on the side.
    pub side: Table,
    /// Under a sky of radiance 1.
    pub sky: Arc<Table>,
}

/// Light that a place scatters: of the sun's irradiance, 1/sr; of the radiance of sky and ground, 1.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Scattered {
    /// Scattered part of the sun's irradiance on what faces it.
    pub sun: f64,
    /// Part of that irradiance that is scattered for the first time, to be multiplied by the phase function.
    pub once: f64,
    /// Scattered part of the sky's radiance.
    pub sky: f64,
    /// Scattered part of the ground's radiance.
    pub ground: f64,
}

fn legendre_sum(terms: [f64; 4], x: f64) -> f64 {
    terms[0] + x * terms[1] + (1.5 * x * x - 0.5) * terms[2] + (2.5 * x * x - 1.5) * x * terms[3]
}

/// Extent of a box from side to side as diffusing light has it: to where it would be dark.
fn reach(near_depth: f64, far_depth: f64, turning: f64) -> f64 {
    (near_depth + far_depth).max(1e-3) + 1.42 / turning
}

/// Returns the profile of light from side to side of a box, of mean 1, and its slope along the axis. In a box no wider
/// than it is high, a cosine; the wider the box, the more of its light leaves through top and base before it comes to a
/// side, and the more even it is between them. At the face that the light falls on it is even too, however narrow the
/// box: `entered` is the depth behind that.
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
    /// Creates the source terms of a medium under a sun.
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

    /// Returns the light that a place at these depths scatters into `direction` (the way light goes; (east, north,
    /// up)), through the scaled depth `to_eye` of more cloud.
    pub fn scattered(&self, depths: &Depths, direction: DVec3, to_eye: f64) -> Scattered {
        let of = &self.scattering;
        let turning = of.turning();
        let (sun, up) = (self.to_sun, direction.z);
        let (sine, cosine) = (sun.truncate().length(), sun.z.abs().max(0.01));
        // Light goes away from the sun.
        let level = if sine > 1e-6 { -sun.truncate() / sine } else { glam::DVec2::X };
        let along = direction.truncate().dot(level);
        let sideways = direction.truncate().dot(glam::DVec2::new(-level.y, level.x));
        let straight = -direction.dot(sun);
        let (above, below) = if sun.z >= 0.0 { (depths.above, depths.below) } else { (depths.below, depths.above) };
        let down = if sun.z >= 0.0 { -up } else { up };

        // A box of which one axis is upright, one along the sun's level direction, one across.
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
            // The first term is the mean radiance times what of it is scattered.
            let mean = terms[0] / of.scaled_albedo() * 4.0 * std::f64::consts::PI;
            legendre_sum(terms, axis) * s1 * s2 - spread * mean * (d1 * s2 * x1 + d2 * s1 * x2)
        };

        let by_top = above / cosine;
        let by_side = if sine > 1e-6 { depths.near / sine } else { f64::INFINITY };
        let top_share = 1.0 / (1.0 + (PART_RATE * turning * (by_top - by_side)).min(80.0).exp());
        // A way to the sun that is longer than the box's: light that has been scattered often falls off slowly along
        // it.
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
        // As much as leaves through the sides comes in there, half of it from above.
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

    /// The light in the middle of a box as wide as `width` heights.
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
