//! Measure of error: the difference in luminance of two pictures. Every error of a picture that the crate states is
//! such a difference.

use crate::error::{Error, Result};

/// Difference of a picture from another, relative to the other's luminance plus a hundredth of white.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Difference {
    /// Median over the pixels.
    pub median: f64,
    /// 95th percentile over the pixels: the error as Welkin states it.
    pub p95: f64,
    /// Largest difference of a pixel.
    pub worst: f64,
}

/// Computes |a - b| / (b + 0.01 white) over all pixels. `a` and `b` are luminances, cd/m^2, and `white` is the
/// luminance that the exposure shows as white. A value that is not finite counts as an infinite error.
///
/// # Errors
/// [`crate::Status::InvalidArgument`] for empty pictures or pictures of different size, or if `white` is not above 0.
pub fn difference(a: &[f64], b: &[f64], white: f64) -> Result<Difference> {
    if a.len() != b.len() || a.is_empty() {
        return Err(Error::range(
            "pixels",
            "as many in both pictures, at least one",
            format!("{} and {}", a.len(), b.len()),
        ));
    }
    if !(white > 0.0 && white.is_finite()) {
        return Err(Error::range("white", "above 0", white));
    }
    let one = |(a, b): (&f64, &f64)| {
        let e = (a - b).abs() / (b.max(0.0) + 0.01 * white);
        if e.is_finite() { e } else { f64::INFINITY }
    };
    let mut errors: Vec<f64> = a.iter().zip(b).map(one).collect();
    errors.sort_by(f64::total_cmp);
    Ok(Difference { median: percentile(&errors, 0.5), p95: percentile(&errors, 0.95), worst: errors[errors.len() - 1] })
}

/// Returns the percentile of numbers in ascending order: the smallest number that is at least as large as the share
/// `share` of the numbers. 0 for an empty list.
pub fn percentile(sorted: &[f64], share: f64) -> f64 {
    let rank = (sorted.len() as f64 * share).ceil() as usize;
    sorted.get(rank.clamp(1, sorted.len().max(1)) - 1).copied().unwrap_or(0.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn percentiles_are_of_pixels_and_dark_ones_have_a_floor() {
        let b = vec![1.0; 100];
        let a: Vec<f64> = (1..=100).map(|i| 1.0 + f64::from(i) * 0.0101).collect();
        let d = difference(&a, &b, 1.0).unwrap();
        assert!((d.median - 0.5).abs() < 1e-9 && (d.p95 - 0.95).abs() < 1e-9 && (d.worst - 1.0).abs() < 1e-9, "{d:?}");
        // 0.001 of white against black is an error of a tenth, not infinite.
        assert!((difference(&[0.1], &[0.0], 100.0).unwrap().p95 - 0.1).abs() < 1e-12);
    }

    #[test]
    fn faults_do_not_pass_as_small_errors() {
        let d = difference(&[f64::NAN, 1.0], &[1.0, 1.0], 1.0).unwrap();
        assert!(d.worst.is_infinite() && d.median == 0.0);
        assert!(difference(&[], &[], 1.0).unwrap_err().to_string().contains("pixels"));
        assert!(difference(&[1.0], &[1.0], 0.0).unwrap_err().to_string().contains("white"));
    }
}
