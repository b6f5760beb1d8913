//! Force on a blade that cuts soil: the fundamental equation of earth moving, with a plane of failure.

use std::f64::consts::PI;

use super::gravity::GRAVITY_M_S2;
use crate::error::{Result, check_range};

/// Soil and blade of a cut.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CuttingInputs {
    /// Angle of the blade to the horizontal in the direction of motion, radians, in \[0.05, 2.6\]; pi/2 is upright.
    pub rake: f64,
    /// Friction angle between soil and blade, radians, in \[0, 1.2\].
    pub soil_metal: f64,
    /// Friction angle of the soil, radians, in \[0, 1.2\].
    pub friction: f64,
    /// Density of the undisturbed soil, kg/m^3, in \[1, 10 000\].
    pub density_kg_m3: f64,
    /// Cohesion of the soil, kPa, in \[0, 10 000\].
    pub cohesion_kpa: f64,
    /// Adhesion of the soil to the blade, kPa, in \[0, 10 000\].
    pub adhesion_kpa: f64,
    /// Load on the surface, kPa, in \[0, 10 000\].
    pub surcharge_kpa: f64,
    /// Width of the blade, m, in \[0, 100\].
    pub width_m: f64,
    /// Depth of the cut, m, in \[0, 100\].
    pub depth_m: f64,
}

/// Force on the blade.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct CuttingForce {
    /// Force across the plane of the blade, at the soil-metal friction angle from its normal, N: the equation's P.
    pub force_n: f64,
    /// Component, against the motion, of the whole force on the blade, N.
    pub horizontal_n: f64,
    /// Component of the whole force that pulls the blade down, N; negative where soil lifts it.
    pub vertical_n: f64,
    /// Angle of the plane of failure to the horizontal, radians.
    pub failure: f64,
    /// Factors of weight, cohesion, surcharge and adhesion.
    pub factors: [f64; 4],
}

impl CuttingInputs {
    fn validate(&self) -> Result<()> {
        check_range("rake", self.rake, 0.05, 2.6, "rad")?;
        check_range("soil_metal", self.soil_metal, 0.0, 1.2, "rad")?;
        check_range("friction", self.friction, 0.0, 1.2, "rad")?;
        check_range("density_kg_m3", self.density_kg_m3, 1.0, 1e4, "kg/m^3")?;
        check_range("cohesion_kpa", self.cohesion_kpa, 0.0, 1e4, "kPa")?;
        check_range("adhesion_kpa", self.adhesion_kpa, 0.0, 1e4, "kPa")?;
        check_range("surcharge_kpa", self.surcharge_kpa, 0.0, 1e4, "kPa")?;
        check_range("width_m", self.width_m, 0.0, 100.0, "m")?;
        check_range("depth_m", self.depth_m, 0.0, 100.0, "m")?;
        // Above this angle the wedge of soil is wedged in, and no plane of failure exists.
        let most = PI - self.soil_metal - self.friction - 0.05;
        check_range("rake", self.rake, 0.05, most, "rad with these friction angles")?;
        // Without inner friction, a rough blade has no plane of least weight.
        let least = if self.soil_metal > 0.0 { 0.01 } else { 0.0 };
        check_range("friction", self.friction, least, 1.2, "rad with this soil_metal")
    }

    /// Factor of weight for a plane of failure at `failure` radians: (cot a + cot b) / (2 D), with the symbols of
    /// [`Self::resistance`].
    fn weight_factor(&self, failure: f64) -> f64 {
        0.5 * (cot(self.rake) + cot(failure)) / self.resistance(failure)
    }

    /// Denominator D = cos(a + d') + sin(a + d') cot(b + phi) of all factors. a is the rake, d' the friction angle
    /// between soil and blade, phi that of the soil, and b the angle of the plane of failure.
    fn resistance(&self, failure: f64) -> f64 {
        let blade = self.rake + self.soil_metal;
        libm::cos(blade) + libm::sin(blade) * cot(failure + self.friction)
    }

    /// Angle of the plane of failure with the least factor of weight, radians. The symbols are those of
    /// [`Self::resistance`]. With x = cot b, A = a + d' and y = x + cot(A + phi), the factor is proportional to
    /// y + k1 + k2 + k1 k2 / y, so it is least at y = sqrt(k1 k2);
    /// k1 k2 = sin(d' + phi) sin(A) / (sin(a) sin(phi) sin^2(A + phi)).
    fn failure(&self) -> f64 {
        let (blade, friction) = (self.rake + self.soil_metal, self.friction);
        let across = libm::sin(blade + friction);
        let rough =
            if self.soil_metal > 0.0 { libm::sin(self.soil_metal + friction) / libm::sin(friction) } else { 1.0 };
        let least = (rough * libm::sin(blade) / libm::sin(self.rake)).sqrt();
        libm::atan2(across, least - libm::cos(blade + friction))
    }
}

fn cot(angle: f64) -> f64 {
    libm::cos(angle) / libm::sin(angle)
}

/// Returns the force on a blade: P = w (gamma d^2 Ng + c d Nc + q d Nq + ca d Na) (Reece 1965, the fundamental equation
/// of earth moving; factors for a plane wedge by McKyes 1985, eq. 4.11 ff.), with the plane of failure at which Ng is
/// least. w is the width, d the depth, gamma the weight of the soil per volume, c the cohesion, q the load on the
/// surface and ca the adhesion; Ng, Nc, Nq and Na are their factors.
///
/// # Errors
/// [`crate::error::Status::InvalidArgument`] naming a field of `inputs` outside its range. `rake`, `soil_metal` and
/// `friction` together must be at most pi - 0.05, and `friction` at least 0.01 if `soil_metal` is not 0.
pub fn cutting_force(inputs: &CuttingInputs) -> Result<CuttingForce> {
    inputs.validate()?;
    let failure = inputs.failure();
    let resistance = inputs.resistance(failure);
    let weight = inputs.weight_factor(failure);
    let beyond = cot(failure + inputs.friction);
    let cohesion = (1.0 + cot(failure) * beyond) / resistance;
    let adhesion = (1.0 - cot(inputs.rake) * beyond) / resistance;
    let factors = [weight, cohesion, 2.0 * weight, adhesion];
    let depth = inputs.depth_m;
    let gamma = inputs.density_kg_m3 * GRAVITY_M_S2;
    let line_load = gamma * depth * weight
        + 1e3 * (inputs.cohesion_kpa * cohesion + inputs.surcharge_kpa * factors[2] + inputs.adhesion_kpa * adhesion);
    let force_n = inputs.width_m * depth * line_load;
    let sticking_n = 1e3 * inputs.adhesion_kpa * inputs.width_m * depth;
    let blade = inputs.rake + inputs.soil_metal;
    Ok(CuttingForce {
        force_n,
        horizontal_n: force_n * libm::sin(blade) + sticking_n * cot(inputs.rake),
        vertical_n: force_n * libm::cos(blade) - sticking_n,
        failure,
        factors,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn inputs(rake_deg: f64, soil_metal_deg: f64, friction_deg: f64) -> CuttingInputs {
        CuttingInputs {
            rake: rake_deg.to_radians(),
            soil_metal: soil_metal_deg.to_radians(),
            friction: friction_deg.to_radians(),
            density_kg_m3: 1700.0,
            cohesion_kpa: 3.0,
            adhesion_kpa: 1.0,
            surcharge_kpa: 0.0,
            width_m: 1.5,
            depth_m: 0.3,
        }
    }

    #[test]
    fn factors_are_those_of_the_table() {
        for (case, failure, [weight, cohesion, adhesion]) in [
            ([90.0, 0.0, 30.0], 30.00, [1.5000, 3.4641, 1.7321]),
            ([60.0, 20.0, 30.0], 29.48, [1.5555, 2.7084, 0.8748]),
            ([60.0, 23.0, 35.0], 26.50, [1.9545, 3.1616, 1.0388]),
            ([45.0, 24.0, 36.0], 30.29, [1.7647, 2.2799, 0.7299]),
        ] {
            let found = cutting_force(&inputs(case[0], case[1], case[2])).unwrap();
            assert!((found.failure.to_degrees() - failure).abs() < 0.006, "{case:?}: {found:?}");
            for (found, wanted) in [0, 1, 3].map(|i| found.factors[i]).iter().zip([weight, cohesion, adhesion]) {
                assert!((found - wanted).abs() < 6e-5, "{case:?}: {found} for {wanted}");
            }
        }
        let found = cutting_force(&inputs(60.0, 20.0, 30.0)).unwrap();
        assert!((found.force_n - 7552.0).abs() < 1.0, "{found:?}");
    }

    #[test]
    fn an_upright_smooth_blade_meets_passive_pressure() {
        // Rankine: Kp = tan^2(45 + phi/2), and the plane of failure at 45 - phi/2.
        for friction in [0.0f64, 10.0, 25.0, 40.0] {
            let found = cutting_force(&inputs(90.0, 0.0, friction)).unwrap();
            // Any other plane meets as much or more.
            let at_plane = |failure: f64| inputs(90.0, 0.0, friction).weight_factor(failure);
            assert!([-0.02, 0.02].iter().all(|off| at_plane(found.failure + off) > found.factors[0] - 1e-12));
            let passive = (45.0 + 0.5 * friction).to_radians().tan().powi(2);
            assert!((found.factors[0] / (0.5 * passive) - 1.0).abs() < 1e-9, "{friction}: {found:?}");
            assert!((found.failure.to_degrees() - 45.0 + 0.5 * friction).abs() < 1e-4, "{friction}: {found:?}");
            assert!((found.horizontal_n - found.force_n).abs() < 1e-6 * found.force_n);
        }
    }

    #[test]
    fn forces_add_up_and_faults_are_named() {
        let base = CuttingInputs { cohesion_kpa: 0.0, adhesion_kpa: 0.0, ..inputs(50.0, 22.0, 33.0) };
        let force = |c: CuttingInputs| cutting_force(&c).unwrap().force_n;
        let double = CuttingInputs { depth_m: 2.0 * base.depth_m, ..base };
        assert!((force(double) / force(base) - 4.0).abs() < 1e-12, "weight grows with the square of the depth");
        let loaded = CuttingInputs { surcharge_kpa: 10.0, ..base };
        let factor = cutting_force(&base).unwrap().factors[2];
        assert!((force(loaded) - force(base) - 1.5 * 0.3 * 1e4 * factor).abs() < 1e-6);
        assert_eq!(force(CuttingInputs { depth_m: 0.0, ..base }), 0.0);
        let fault = |c: CuttingInputs| cutting_force(&c).unwrap_err().to_string();
        assert!(fault(CuttingInputs { rake: f64::NAN, ..base }).starts_with("rake must be in [0.05, 2.6] rad"));
        assert!(fault(CuttingInputs { width_m: -1.0, ..base }).starts_with("width_m must be in [0, 100] m"));
        assert!(fault(CuttingInputs { friction: 0.0, ..base }).starts_with("friction must be in [0.01, 1.2] rad"));
        assert!(fault(CuttingInputs { rake: 2.3, friction: 1.0, ..base }).starts_with("rake must be in [0.05, "));
    }
}
