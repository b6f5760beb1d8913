//! Light in clouds by tracing photons: the reference for the tables and shaders.
//!
//! Free paths through a cloud of any shape are sampled by null collisions (Woodcock et al. 1965). Step lengths are
//! drawn for the largest extinction, and the end of a step counts as a collision with a probability equal to the ratio
//! of the extinction there to the largest. Nothing is scaled or cut off. The standard error of a share p of n photons
//! is sqrt(p (1 - p) / n).

use std::f64::consts::PI;

use glam::{DMat3, DVec3};

use crate::{chance::RandomStream, light::phase::PhaseLobes};

/// Draws the cosine of a scattering angle from the phase function of Henyey and Greenstein with asymmetry `g`.
fn lobe_cosine(g: f64, chance: &mut RandomStream) -> f64 {
    let u = chance.even();
    if g.abs() < 1e-6 {
        return 2.0 * u - 1.0;
    }
    let s = (1.0 - g * g) / (1.0 - g + 2.0 * g * u);
    ((1.0 + g * g - s * s) / (2.0 * g)).clamp(-1.0, 1.0)
}

/// Draws a photon's direction after a droplet with this phase function has scattered it from `direction`.
pub fn scattered(lobes: &PhaseLobes, direction: DVec3, chance: &mut RandomStream) -> DVec3 {
    turned(lobes, direction, chance).0
}

/// Draws the direction after scattering, and returns whether the Draine lobe was used. The cosine c in that lobe is
/// drawn from the lobe of Henyey and Greenstein with the same g, and accepted with probability (1 + alpha c^2) / (1 +
/// alpha).
pub(super) fn turned(lobes: &PhaseLobes, direction: DVec3, chance: &mut RandomStream) -> (DVec3, bool) {
    let by_draine = chance.even() < lobes.w_draine;
    let cosine = if by_draine {
        loop {
            let c = lobe_cosine(lobes.g_draine, chance);
            if chance.even() * (1.0 + lobes.alpha) < 1.0 + lobes.alpha * c * c {
                break c;
            }
        }
    } else {
        lobe_cosine(lobes.g_hg, chance)
    };
    let (sine, azimuth) = ((1.0 - cosine * cosine).max(0.0).sqrt(), 2.0 * PI * chance.even());
    let (a, b) = direction.any_orthonormal_pair();
    let way = DMat3::from_cols(a, b, direction) * DVec3::new(sine * azimuth.cos(), sine * azimuth.sin(), cosine);
    (way.normalize(), by_draine)
}

/// Cloud within a box from the origin to `sides`, in any unit of length.
pub struct Box<'a> {
    /// Far corner; a side may be infinite.
    pub sides: DVec3,
    /// Extinction at a place, per unit of length.
    pub extinction: &'a dyn Fn(DVec3) -> f64,
    /// Largest extinction in the box, per unit of length.
    pub most: f64,
    /// Phase function of the droplets.
    pub lobes: PhaseLobes,
    /// Single-scattering albedo.
    pub albedo: f64,
}

impl Box<'_> {
    /// Traces a photon from a place along `direction`. Returns the index of the face through which it leaves (0 low x,
    /// 1 high x, 2 low y, 3 high y, 4 base, 5 top), or `None` if it is absorbed.
    pub fn leaves_by(&self, mut position: DVec3, mut direction: DVec3, chance: &mut RandomStream) -> Option<usize> {
        loop {
            let mut exit = (f64::INFINITY, 0);
            for axis in 0..3 {
                let d = direction[axis];
                let to = if d > 0.0 { (self.sides[axis] - position[axis]) / d } else { -position[axis] / d };
                if d != 0.0 && to < exit.0 {
                    exit = (to, 2 * axis + usize::from(d > 0.0));
                }
            }
            let free = -chance.even().ln() / self.most;
            if free >= exit.0 {
                return Some(exit.1);
            }
            position += direction * free;
            if chance.even() * self.most >= (self.extinction)(position) {
                continue;
            }
            if chance.even() >= self.albedo {
                return None;
            }
            direction = scattered(&self.lobes, direction, chance);
        }
    }

    /// Returns the shares of the sunlight on the box that leave through each face, in the order of [`Self::leaves_by`].
    /// The sun stands on the side of low x; `cosine` is the cosine of its zenith angle. High z is the top.
    pub fn fluxes(&self, cosine: f64, photons: u32, seed: u64) -> [f64; 6] {
        let sine = (1.0 - cosine * cosine).sqrt();
        let is_slab = self.sides.x.is_infinite();
        let top = if is_slab { 1.0 } else { cosine * self.sides.x / (cosine * self.sides.x + sine * self.sides.z) };
        let (mut chance, mut out) = (RandomStream::new(seed, 0), [0.0; 6]);
        for _ in 0..photons {
            let wide = |side: f64, c: &mut RandomStream| if side.is_infinite() { 0.0 } else { side * c.even() };
            let y = wide(self.sides.y, &mut chance);
            let at = if chance.even() < top {
                DVec3::new(wide(self.sides.x, &mut chance), y, self.sides.z)
            } else {
                DVec3::new(0.0, y, self.sides.z * chance.even())
            };
            let way = DVec3::new(sine, 0.0, -cosine);
            // Photons start so far inside an infinite slab that none leaves through a side.
            let at = if is_slab { at.with_x(1e150).with_y(1e150) } else { at };
            if let Some(face) = self.leaves_by(at, way, &mut chance) {
                out[face] += 1.0 / f64::from(photons);
            }
        }
        out
    }
}

#[cfg(test)]
pub(super) mod tests {
    use super::*;
    use crate::light::{Phase, phase::lobes_phase};

    pub fn even(sides: DVec3, g: f64, albedo: f64, cosine: f64, photons: u32) -> [f64; 6] {
        let lobes = PhaseLobes::new(&Phase::HenyeyGreenstein { g });
        Box { sides, extinction: &|_| 1.0, most: 1.0, lobes, albedo }.fluxes(cosine, photons, 7)
    }

    /// Reflectance and transmittance of slabs from discrete ordinates (PythonicDISORT), Henyey-Greenstein g = 0.85.
    #[test]
    fn photons_meet_the_published_slabs() {
        let slab =
            |tau, albedo, cosine| even(DVec3::new(f64::INFINITY, f64::INFINITY, tau), 0.85, albedo, cosine, 200_000);
        for (tau, overhead, low) in [(1.0, 0.04232, 0.16488), (4.0, 0.19092, 0.41602), (16.0, 0.55721, 0.69740)] {
            for (cosine, want) in [(1.0, overhead), (0.5, low)] {
                let flux = slab(tau, 1.0, cosine);
                let spread = (want * (1.0 - want) / 200_000.0f64).sqrt();
                assert!((flux[5] - want).abs() < 4.0 * spread, "{tau} {cosine}: {} not {want}", flux[5]);
                assert!((flux[4] + flux[5] - 1.0).abs() < 1e-9);
            }
        }
        for (tau, reflected, diffuse) in [(1.0, 0.04079, 0.57960), (16.0, 0.41773, 0.30610)] {
            let flux = slab(tau, 0.99, 1.0);
            let through = diffuse + f64::exp(-tau);
            assert!((flux[5] - reflected).abs() < 0.004 && (flux[4] - through).abs() < 0.004, "{tau}: {flux:?}");
        }
    }

    #[test]
    fn photons_turn_as_the_phase_function_says() {
        let lobes = PhaseLobes::new(&Phase::Droplets { diameter_um: 12.0 });
        let mut chance = RandomStream::new(3, 0);
        let (mut mean, mut back) = (0.0, 0.0);
        let n = 200_000;
        for _ in 0..n {
            let c = scattered(&lobes, DVec3::Z, &mut chance).z;
            mean += c / f64::from(n);
            back += if c < -0.5 { 1.0 / f64::from(n) } else { 0.0 };
        }
        let want: f64 = (0..1000)
            .map(|i| 1.5 + 0.5 * (f64::from(i) + 0.5) / 1000.0)
            .map(|versine| lobes_phase(&lobes, 1.0, versine) * 2.0 * PI * 0.0005)
            .sum();
        assert!((mean - lobes.moments()[0]).abs() < 2e-3, "{mean}");
        assert!((back - want).abs() < 0.002, "{back} {want}");
    }
}
