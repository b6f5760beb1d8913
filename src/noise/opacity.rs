//! Conversion of noise to opacity: cover by a threshold, density by an exponential (Tarantilis 2004, sections III.C.1
//! and III.B.4.d).

use crate::error::{Error, Result, check_range};

/// Conversion of noise n to the opacity of a cloud, b (1 - exp(-k max(0, n - c))). Up to the cutoff c the sky is clear.
/// Above it the law of Beer and Lambert applies, with the excess of the noise as the cloud's thickness. An excess of 1
/// has the optical thickness k. The bias b is the greatest opacity.
///
/// The source prints two forms, in which the density has different meanings. In 1 - d^(alpha - c) the exponent is in
/// levels of 8 bits, so that k = -255 ln d. In b (1 - E^(n - c)) it is from 0 to 1, so that k = -ln E. The two agree
/// for E = d^255.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CloudFunction {
    cutoff: f64,
    thickness: f64,
    bias: f64,
}

impl CloudFunction {
    /// Creates the function from the density d of the source's two-dimensional clouds, 0 to 1: 0.99 gives thin and soft
    /// clouds, 0.95 firm ones, 0 completely hard edges, 1 no cloud. `cutoff` is in \[0, 1\]; a greater one gives less
    /// cloud.
    ///
    /// # Errors
    /// [`crate::Status::InvalidArgument`] for a cutoff or density outside \[0, 1\].
    pub fn from_density(cutoff: f64, density: f64) -> Result<Self> {
        check_range("density", density, 0.0, 1.0, "")?;
        check_range("cutoff", cutoff, 0.0, 1.0, "")?;
        Ok(Self::of_density(cutoff, density))
    }

    /// Creates the function of a density, without checking cutoff and density.
    pub(super) fn of_density(cutoff: f64, density: f64) -> Self {
        Self { cutoff, thickness: 255.0 * optical_thickness(density), bias: 1.0 }
    }

    /// Creates the function from the exponent E and the bias b of the source's cloud dome, both in \[0, 1\]. An
    /// exponent of 0 gives completely hard edges; the clear sky stays clear even then.
    ///
    /// # Errors
    /// [`crate::Status::InvalidArgument`] for a value outside \[0, 1\].
    pub fn from_exponent(cutoff: f64, exponent: f64, bias: f64) -> Result<Self> {
        check_range("exponent", exponent, 0.0, 1.0, "")?;
        Self::new(cutoff, optical_thickness(exponent), bias)
    }

    /// Creates the function from the optical thickness k of noise that exceeds the cutoff by 1. The thickness is at
    /// least 0; infinity gives completely hard edges.
    ///
    /// # Errors
    /// [`crate::Status::InvalidArgument`] for a cutoff or bias outside \[0, 1\] or a thickness below 0.
    pub fn new(cutoff: f64, thickness: f64, bias: f64) -> Result<Self> {
        check_range("cutoff", cutoff, 0.0, 1.0, "")?;
        check_range("bias", bias, 0.0, 1.0, "")?;
        if thickness.is_nan() || thickness < 0.0 {
            return Err(Error::range("thickness", "at least 0", thickness));
        }
        Ok(Self { cutoff, thickness, bias })
    }

    /// Returns the cutoff: noise up to this value is clear sky.
    pub fn cutoff(&self) -> f64 {
        self.cutoff
    }

    /// Returns the optical thickness of noise that exceeds the cutoff by 1.
    pub fn thickness(&self) -> f64 {
        self.thickness
    }

    /// Returns the bias: the greatest opacity.
    pub fn bias(&self) -> f64 {
        self.bias
    }

    /// Returns the opacity of noise in \[0, 1\]: 0 up to the cutoff, then rising, never above the bias.
    pub fn opacity(&self, noise: f64) -> f64 {
        let excess = noise - self.cutoff;
        // Avoids infinity times 0 at the cutoff.
        if excess > 0.0 { self.bias * -libm::expm1(-self.thickness * excess) } else { 0.0 }
    }
}

/// Returns -ln x for x in [0, 1], without a negative zero.
fn optical_thickness(x: f64) -> f64 {
    if x == 1.0 { 0.0 } else { -libm::log(x) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn opacities_are_those_of_the_source_in_levels_of_eight_bits() {
        let hard = CloudFunction::from_density(0.7, 0.95).unwrap();
        for (noise, expected) in [(0.75, 0.48), (0.8, 0.73), (0.9, 0.93), (1.0, 0.98)] {
            assert!((hard.opacity(noise) - expected).abs() < 0.006, "{noise}: {}", hard.opacity(noise));
        }
        let soft = CloudFunction::from_density(0.3, 0.99).unwrap();
        for (noise, expected) in [(0.4, 0.23), (0.5, 0.40), (0.6, 0.54), (0.8, 0.72), (1.0, 0.83)] {
            assert!((soft.opacity(noise) - expected).abs() < 0.006, "{noise}: {}", soft.opacity(noise));
        }
    }

    #[test]
    fn both_forms_of_the_source_agree_where_the_exponent_is_the_density_to_the_255() {
        for d in [0.95, 0.96, 0.99] {
            let plane = CloudFunction::from_density(0.6, d).unwrap();
            let dome = CloudFunction::from_exponent(0.6, libm::pow(d, 255.0), 1.0).unwrap();
            for level in 0..=255 {
                let n = f64::from(level) / 255.0;
                assert!((plane.opacity(n) - dome.opacity(n)).abs() < 1e-9, "{d} {level}");
            }
        }
    }

    #[test]
    fn opacity_rises_from_nothing_at_the_cutoff_and_is_a_number_at_all_edges() {
        let edges = [0.0, 1e-300, 0.5, 1.0];
        for cutoff in [0.0, 0.3, 1.0] {
            for exponent in edges {
                for bias in edges {
                    let f = CloudFunction::from_exponent(cutoff, exponent, bias).unwrap();
                    let mut before = 0.0;
                    for level in 0..=255 {
                        let n = f64::from(level) / 255.0;
                        let a = f.opacity(n);
                        assert!((before..=bias).contains(&a), "{f:?} {n}: {a}");
                        assert!(n > cutoff || a == 0.0, "{f:?} {n}: {a}");
                        before = a;
                    }
                }
            }
        }
        let hard = CloudFunction::from_exponent(0.5, 0.0, 0.8).unwrap();
        assert_eq!((hard.opacity(0.5), hard.opacity(0.501)), (0.0, 0.8));
    }

    #[test]
    fn bad_densities_are_refused_by_name() {
        for (answer, field) in [
            (CloudFunction::from_density(0.5, 1.01), "density"),
            (CloudFunction::from_density(-0.1, 0.9), "cutoff"),
            (CloudFunction::from_exponent(0.5, -0.1, 1.0), "exponent"),
            (CloudFunction::from_exponent(0.5, f64::NAN, 1.0), "exponent"),
            (CloudFunction::from_exponent(0.5, 0.5, 1.5), "bias"),
            (CloudFunction::new(0.5, -1.0, 1.0), "thickness"),
            (CloudFunction::new(0.5, f64::NAN, 1.0), "thickness"),
        ] {
            assert_eq!(answer.unwrap_err().field(), Some(field));
        }
    }
}
