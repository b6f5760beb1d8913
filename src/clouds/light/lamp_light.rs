//! Light of a lamp or a flash, scattered by a place in a cloud; the source shines inside that cloud or outside it.
//! `shaders/clouds/lit_lamps.wgsl` has the same model.
//!
//! # Model
//! A place stands in a box of cloud, as it does for the sun ([`super::Sources`]). Distances are scaled optical depths,
//! and g' is the asymmetry of the phase function after this scaling ([`super::transport`]).
//! * A source inside the cloud gives light that is scattered once, with the true phase function, and diffuse light. In
//!   a cloud without bounds, the diffuse light's mean radiance at a distance d from a source of intensity I would be
//!   3 (1 - g') I / (4 pi d) (diffusion; Ishimaru 1978, chapter 9). At a face of the box, diffuse light falls off as if
//!   it reached 0 on a plane 0.71 / (1 - g') outside; an image source of opposite sign beyond this plane makes it 0
//!   there. Let p and s be the depths of place and source behind this plane, and r = d / sqrt(d^2 + 4 p s) the ratio of
//!   the distances to source and image. The mean radiance is multiplied by 1 - r for the face nearest to the place, by
//!   1 - r^2 for the face opposite that one, and by 1 - r^3 for each of the other four. Flux follows the gradient of
//!   the diffuse light, and the place scatters more light along the flux than against it.
//! * A source outside lights the face towards it as a sky of the same irradiance would ([`super::transport`]).
//!
//! The share of the path that lies in cloud decides between the two. A flash in a cloud always counts as inside, even
//! where the drawn cloud has a gap.
//!
//! # Error
//! The model is compared with photons, for a source in a slab and a cube and outside a cube: `cargo test --lib
//! clouds::light::lamp_light -- --nocapture`.

use std::f64::consts::PI;

use glam::DVec3;

use super::{
    sources::Depths,
    transport::{Scattering, Table, table_at},
};

use crate::numerics::smooth;

/// Extrapolation length of the diffusion approximation, in units of 1 / (1 - g') (Milne's problem): distance outside a
/// face at which diffuse light would be 0.
const DARK_AT: f64 = 0.71;
/// Powers of r (see the model) for the face opposite the nearest one, and for the other four. With them, the product of
/// the factors 1 - r^n of all faces has about the gradient that the sum of all images has at the nearest face.
const FARTHER: [i32; 2] = [2, 3];
/// Depth from which light returns through the face that it fell on, in units of 1 / (1 - g').
const RETURNS_FROM: f64 = 0.5;
/// Shares of the path to a source that lie in cloud: up to the first the source counts as outside, from the second on
/// as inside, and between them the two are mixed.
const INSIDE: [f64; 2] = [0.5, 1.0];

/// A source as seen from a place. A distance is given as the scaled depth that it would have if all of it lay in cloud
/// as dense as that around the place.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Shine {
    /// Unit vector to the source.
    pub toward: DVec3,
    /// Distance of the source.
    pub distance: f64,
    /// Scaled depth of cloud on the path.
    pub between: f64,
    /// Scaled depths of the layer's cloud above and below the source.
    pub within: [f64; 2],
    /// Whether the source counts as inside the cloud without regard to the share of the path that lies in cloud.
    pub is_buried: bool,
}

/// Returns the ratio of a place's distance from a source to its distance from the source's image beyond a face, and the
/// derivative of this ratio along `direction`. `place` and `source` are the depths of place and source behind the plane
/// where the light is 0. `grows` is the derivative of `place` along the direction.
fn mirrored(shine: &Shine, direction: DVec3, [place, grows]: [f64; 2], source: f64) -> (f64, f64) {
    let d = shine.distance;
    let square = d * d + 4.0 * place * source;
    let image = square.sqrt();
    let toward = (d * d / square - 1.0) * shine.toward.dot(direction);
    (d / image, (toward - 2.0 * d * source * grows / square) / image)
}

/// Returns the light that a place at these depths scatters into `direction` (the way the light travels), per steradian
/// and unit of scaled depth. The source has intensity 1 with distances in scaled depths: at a distance d its irradiance
/// is 1 / d^2. `to_eye` is the scaled depth of cloud between place and eye, and `sky` is
/// [`super::transport::Transport::under_sky`].
pub fn scattered(
    scattering: &Scattering,
    sky: &Table,
    depths: &Depths,
    shine: &Shine,
    direction: DVec3,
    to_eye: f64,
) -> f64 {
    let shine = &Shine { distance: shine.distance.max(1e-3), ..*shine };
    let d = shine.distance;
    let share = ((shine.between / d - INSIDE[0]) / (INSIDE[1] - INSIDE[0])).clamp(0.0, 1.0);
    let share = if shine.is_buried { 1.0 } else { smooth(share) };
    let inside = if share > 0.0 { from_inside(scattering, depths, shine, direction, to_eye) } else { 0.0 };
    let outside = if share < 1.0 { from_outside(scattering, sky, depths, shine, direction) } else { 0.0 };
    share * inside + (1.0 - share) * outside
}

/// Returns the light that a place scatters into `direction` from a source inside the cloud, in the unit of
/// [`scattered`].
fn from_inside(scattering: &Scattering, depths: &Depths, shine: &Shine, direction: DVec3, to_eye: f64) -> f64 {
    let d = shine.distance;
    let (turning, albedo) = (scattering.turning(), scattering.scaled_albedo());
    let versine = 1.0 + direction.dot(shine.toward);
    let phase = scattering.smooth_phase(versine) + scattering.peak(versine, shine.between + to_eye);
    let once = albedo * phase * (-shine.between).exp() / (d * d);
    let dark = DARK_AT / turning;
    let level = shine.toward.truncate().length() * d;
    // `depths` does not say on which side eye and source are. Assumed: the eye looks at the nearer side (left), and the
    // source lies beyond the place, deeper in the same cloud.
    let out = direction.truncate().length();
    let half = 0.5 * (depths.left + depths.right).max(d);
    // Depths of place and source at each face, and the growth of the place's depth along the direction.
    let faces = [
        (depths.above, shine.within[0], -direction.z),
        (depths.below, shine.within[1], direction.z),
        (depths.left, depths.left + level, -out),
        (depths.right.max(level + half), half, out),
        (half, half, 0.0),
        (half, half, 0.0),
    ];
    let mut mean = 1.0 / d;
    let mut grows = shine.toward.dot(direction) / d;
    let nearest = (0..3).min_by(|i, j| faces[*i].0.total_cmp(&faces[*j].0)).unwrap_or(0);
    for (i, (place, source, grows_by)) in faces.into_iter().enumerate() {
        let power = if i == nearest { 1 } else { FARTHER[usize::from(i != nearest ^ 1)] };
        // A cloud is round: where one face is near, the others are farther away. So the place counts as at least as
        // deep behind the others as the source.
        let place = if i == nearest { place } else { place.max(source) };
        let (ratio, falling) = mirrored(shine, direction, [place + dark, grows_by], source.max(0.0) + dark);
        let left = 1.0 - ratio.powi(power);
        mean *= left;
        grows -= f64::from(power) * ratio.powi(power - 1) * falling / left;
    }
    once + albedo * 3.0 / (4.0 * PI) * mean * (turning - (1.0 - turning) * grows).max(0.0)
}

/// Returns the light that a place scatters into `direction` from a source outside the cloud, in the unit of
/// [`scattered`].
fn from_outside(scattering: &Scattering, sky: &Table, depths: &Depths, shine: &Shine, direction: DVec3) -> f64 {
    let d = shine.distance;
    let turning = scattering.turning();
    // Depth from the place to where the light leaves the box.
    let (sine, rise) = (shine.toward.truncate().length(), shine.toward.z);
    let upright = if rise > 0.0 { depths.below } else { depths.above };
    let behind = (upright / rise.abs().max(1e-6)).min(depths.right / sine.max(1e-6));
    // Leak rate across the path.
    let rate = |width: f64, across: f64| across * (PI / (width + 2.0 * DARK_AT / turning)).powi(2);
    let squares = shine.toward * shine.toward;
    let level = depths.left + depths.right;
    let leak = (rate(level, 1.0 - squares.x)
        + rate(level, 1.0 - squares.y)
        + rate(depths.above + depths.below, 1.0 - squares.z))
        / (3.0 * turning);
    let terms = table_at(sky, shine.between, behind, leak);
    let x = -direction.dot(shine.toward);
    let sum = terms[0] + x * terms[1] + (1.5 * x * x - 0.5) * terms[2] + (2.5 * x * x - 1.5) * x * terms[3];
    let often = sum.max(0.0) / PI;
    let momentum = (-turning * shine.between).exp() - (-shine.between).exp();
    let kept = scattering.scaled_albedo() * 3.0 * scattering.moments[1] / (4.0 * PI) * momentum * x;
    // Light that returns through the face has first gone some depth into the cloud.
    let d = d - shine.between + shine.between.max(RETURNS_FROM / turning);
    (often + kept.clamp(-often, often)) / (d * d)
}

#[cfg(test)]
pub(crate) mod tests {
    use super::*;
    use crate::{
        chance::RandomStream,
        clouds::{
            light::transport::{Scattering, Transport},
            reference,
        },
        light::{Phase, PhaseLobes},
    };

    const G: f64 = 0.85;

    /// A box with optical depth 1 per unit of length, and a source of 1 cd.
    struct Case {
        sides: DVec3,
        source: DVec3,
    }

    fn spread(i: u32) -> [f64; 4] {
        [0.856_674_883_854_502_9, 0.733_891_856_627_126, 0.628_706_721_281_458_4, 0.538_597_256_572_023_3]
            .map(|a| (0.5 + f64::from(i) * a).fract())
    }

    impl Case {
        fn is_in(&self) -> bool {
            (0..3).all(|i| (0.0..self.sides[i]).contains(&self.source[i]))
        }

        /// Returns the distance to where a ray leaves the box.
        fn exit(&self, position: DVec3, d: DVec3) -> f64 {
            (0..3)
                .map(
                    |i| if d[i] > 0.0 { (self.sides[i] - position[i]) / d[i] } else { -position[i] / d[i].min(-1e-12) },
                )
                .fold(f64::INFINITY, f64::min)
        }

        fn depths(&self, position: DVec3, scale: f64) -> Depths {
            let (low, high) = (position * scale, (self.sides - position) * scale);
            let edge = low.x.min(high.x).min(low.y).min(high.y);
            let other = (self.sides.x.min(self.sides.y) * scale - edge).max(edge);
            Depths { above: high.z, below: low.z, to_sun: 0.0, near: edge, far: other, left: edge, right: other }
        }

        fn shine(&self, position: DVec3, scale: f64) -> Shine {
            let to = self.source - position;
            let distance = to.length();
            let toward = to / distance;
            let between = distance.min(self.exit(position, toward));
            let within = [(self.sides.z - self.source.z) * scale, self.source.z * scale];
            Shine { toward, distance: distance * scale, between: between * scale, within, is_buried: false }
        }

        /// Computes the model's light that leaves a part of a face, lm per unit of area, without the light that comes
        /// straight from the source. `face_place` maps two numbers from 0 to 1 evenly to the places of the part.
        fn modelled(
            &self,
            transport: &Transport,
            (axis, high): (usize, bool),
            face_place: impl Fn([f64; 2]) -> DVec3,
        ) -> f64 {
            let (of, sky) = (&transport.scattering, transport.under_sky());
            let scale = of.scale();
            let rays = 2000;
            let mut sum = 0.0;
            for i in 0..rays {
                let p = spread(i);
                let (sine, azimuth) = (p[2].sqrt(), 2.0 * PI * p[3]);
                let sign = if high { 1.0 } else { -1.0 };
                let mut out = DVec3::ZERO;
                out[axis] = sign * (1.0 - p[2]).sqrt();
                out[(axis + 1) % 3] = sine * azimuth.cos();
                out[(axis + 2) % 3] = sine * azimuth.sin();
                let at = face_place([p[0], p[1]]) - out * 1e-6;
                let length = self.exit(at, -out).min(40.0);
                let (step, mut gone, mut light) = (0.2, 0.0, 0.0);
                while gone < length {
                    let here = at - out * (gone + 0.5 * step);
                    let to_eye = gone * scale;
                    let s = scattered(of, &sky, &self.depths(here, scale), &self.shine(here, scale), out, to_eye);
                    light += s * scale * scale * (-to_eye).exp() * -(-step * scale).exp_m1();
                    gone += step;
                }
                sum += light / f64::from(rays);
            }
            PI * sum
        }

        /// Computes the light that leaves a whole face, by [`Self::modelled`].
        fn modelled_face(&self, transport: &Transport, face: usize) -> f64 {
            let (axis, high) = (face / 2, face % 2 == 1);
            let on = |[u, v]: [f64; 2]| {
                let mut at = DVec3::ZERO;
                at[axis] = if high { self.sides[axis] } else { 0.0 };
                at[(axis + 1) % 3] = self.sides[(axis + 1) % 3] * u;
                at[(axis + 2) % 3] = self.sides[(axis + 2) % 3] * v;
                at
            };
            self.modelled(transport, (axis, high), on)
        }

        /// Traces photons; `each` gets the place and the face where one leaves.
        fn photons(&self, count: u32, mut each: impl FnMut(DVec3, usize)) {
            let mut chance = RandomStream::new(5, 0);
            let lobes = PhaseLobes::new(&Phase::HenyeyGreenstein { g: G });
            for _ in 0..count {
                let z = 2.0 * chance.even() - 1.0;
                let a = 2.0 * PI * chance.even();
                let s = (1.0 - z * z).sqrt();
                let (mut at, mut d) = (self.source, DVec3::new(s * a.cos(), s * a.sin(), z));
                if !self.is_in() {
                    let Some(t) = self.enters(at, d) else { continue };
                    at += d * (t + 1e-9);
                }
                let mut turns = 0;
                loop {
                    let mut exit = (f64::INFINITY, 0);
                    for axis in 0..3 {
                        let to =
                            if d[axis] > 0.0 { (self.sides[axis] - at[axis]) / d[axis] } else { -at[axis] / d[axis] };
                        if d[axis] != 0.0 && to < exit.0 {
                            exit = (to, 2 * axis + usize::from(d[axis] > 0.0));
                        }
                    }
                    let free = -chance.even().ln();
                    if free >= exit.0 {
                        // Photons that were not scattered count as light straight from the source.
                        if turns > 0 {
                            each(at + d * exit.0, exit.1);
                        }
                        break;
                    }
                    at += d * free;
                    d = reference::scattered(&lobes, d, &mut chance);
                    turns += 1;
                }
            }
        }

        fn enters(&self, position: DVec3, d: DVec3) -> Option<f64> {
            let (mut first, mut last) = (0.0f64, f64::INFINITY);
            for i in 0..3 {
                let (a, b) = (-position[i] / d[i], (self.sides[i] - position[i]) / d[i]);
                (first, last) = (first.max(a.min(b)), last.min(a.max(b)));
            }
            (first < last).then_some(first)
        }
    }

    /// Returns the light that leaves each face of a cube, per unit of area.
    pub fn modelled_faces(side: f64, source: DVec3) -> [f64; 6] {
        let (case, transport) = (Case { sides: DVec3::splat(side), source }, transport());
        std::array::from_fn(|face| case.modelled_face(&transport, face))
    }

    fn transport() -> Transport {
        Transport::new(Scattering::new(PhaseLobes::new(&Phase::HenyeyGreenstein { g: G }), 1.0))
    }

    #[test]
    fn a_source_in_a_slab_glows_through_its_face_as_photons_do() {
        let transport = transport();
        for (depth, at) in
            [(16.0, 0.5), (16.0, 0.25), (32.0, 0.5), (64.0, 0.75), (16.0, 2.0), (32.0, 1.25), (16.0, 5.0)]
        {
            let wide = 4000.0;
            let case =
                Case { sides: DVec3::new(wide, wide, depth), source: DVec3::new(0.5 * wide, 0.5 * wide, at * depth) };
            let rings: Vec<f64> = [0.0, 0.5, 1.0, 1.5, 2.0].map(|k| k * depth).to_vec();
            let count = 60_000;
            let mut out = vec![0.0; rings.len() - 1];
            case.photons(count, |at, face| {
                let r = (at - case.source).truncate().length();
                if face == 5
                    && let Some(i) = (0..out.len()).find(|i| r < rings[i + 1])
                {
                    let area = PI * (rings[i + 1].powi(2) - rings[i].powi(2));
                    out[i] += 4.0 * PI / f64::from(count) / area;
                }
            });
            for (i, out) in out.iter().enumerate() {
                let on = |[u, v]: [f64; 2]| {
                    let r = (rings[i].powi(2) + u * (rings[i + 1].powi(2) - rings[i].powi(2))).sqrt();
                    let a = 2.0 * PI * v;
                    DVec3::new(case.source.x + r * a.cos(), case.source.y + r * a.sin(), depth)
                };
                let ratio = case.modelled(&transport, (2, true), on) / out;
                println!("slab of {depth}, source at {at} of it, ring {i}: {ratio:.2} of the photons' {out:.6}");
                let bounds = if at < 1.0 { 0.9..1.35 } else { 0.75..1.45 };
                assert!(i > 2 || bounds.contains(&ratio), "slab of {depth}, source at {at}, ring {i}: {ratio}");
            }
        }
    }

    #[test]
    fn a_source_by_a_cube_lights_its_faces_as_photons_do() {
        let transport = transport();
        let side = 16.0;
        for (name, source) in [
            ("in its middle", DVec3::splat(8.0)),
            ("in it, low", DVec3::new(8.0, 8.0, 4.0)),
            ("by a side", DVec3::new(3.0, 8.0, 8.0)),
            ("below", DVec3::new(8.0, 8.0, -8.0)),
            ("far below", DVec3::new(8.0, 8.0, -64.0)),
            ("beside", DVec3::new(-16.0, 8.0, 8.0)),
        ] {
            let case = Case { sides: DVec3::splat(side), source };
            let count = 60_000;
            let mut out = [0.0; 6];
            case.photons(count, |_, face| out[face] += 4.0 * PI / f64::from(count) / (side * side));
            let all: f64 = out.iter().sum();
            for (face, out) in out.iter().enumerate() {
                let model = case.modelled_face(&transport, face);
                println!("{name}, face {face}: {model:.6}, photons {out:.6}, of all faces {all:.6}");
                let most = if case.is_in() { 0.3 * out } else { 0.08 * all };
                assert!((model - out).abs() < most, "{name}, face {face}: {model} not {out}");
            }
        }
    }
}
