//! Queries of visibility, answered in f64 without a device.

use glam::DVec3;

use super::{
    layer::{FogLayer, Law},
    model::FogModel,
    of_weather::LowAir,
    path::layer_depth_above,
    reference::fog_along,
    viewpoint::{NO_LIGHT, Viewpoint},
    visibility::{CONTRAST_THRESHOLD, koschmieder_extinction_per_m, koschmieder_visibility_m},
};
use crate::{
    error::{Error, Result, check_range},
    moment::MAX_EXTINCTION_PER_M,
};

/// Transmittance and visibility between two points.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Between {
    /// Share of light transmitted, per channel (620, 550, 450 nm of the default planet).
    pub transmittance: [f64; 3],
    /// Meteorological optical range of the air along the path, m: the distance at which light of 550 nm would fall to 5
    /// % in air with the path's mean extinction. Infinite without extinction.
    pub visibility_m: f64,
}

/// Returns the transmittance of the layer per channel (620, 550, 450 nm) from the viewpoint to a point. `offset` is the
/// vector to this point, m (east, north, up). The whole transmittance is this one times the transmittances of air, haze
/// and precipitation.
///
/// # Errors
/// [`crate::Status::InvalidArgument`] naming the parameter.
pub fn transmittance_between(layer: &FogLayer, eye: &Viewpoint, offset: DVec3) -> Result<[f64; 3]> {
    check_offset(offset)?;
    Ok(FogModel::new(&Law::Layer(*layer), &NO_LIGHT, eye)?.transmittance_over(offset))
}

/// Checks that an offset is finite.
fn check_offset(offset: DVec3) -> Result<()> {
    if offset.is_finite() { Ok(()) } else { Err(Error::range("offset", "finite, in metres", offset)) }
}

impl FogModel {
    /// Returns the share of light that is left over the way from the viewpoint to the point `offset`, m, per channel.
    fn transmittance_over(&self, offset: DVec3) -> [f64; 3] {
        let range = offset.length();
        if range == 0.0 {
            return [1.0; 3];
        }
        fog_along(self, DVec3::ZERO, offset / range, range, range).transmittance.to_array()
    }
}

impl LowAir {
    /// Returns the transmittance of fog and precipitation, as [`transmittance_between`] does for a layer, averaged over
    /// the curtains of rain.
    ///
    /// # Errors
    /// [`crate::Status::InvalidArgument`] naming the parameter.
    pub fn transmittance(&self, eye: &Viewpoint, offset: DVec3) -> Result<[f64; 3]> {
        check_offset(offset)?;
        Ok(self.model(&NO_LIGHT, eye)?.transmittance_over(offset))
    }
}

/// Returns the visibility along the line from the viewpoint to the point `offset`, m (east, north, up): the
/// meteorological optical range of a homogeneous medium with the same mean extinction. `background_per_m` is the
/// extinction of air, haze and precipitation along the line at 550 nm. Infinite without extinction.
///
/// # Errors
/// [`crate::Status::InvalidArgument`] naming the parameter.
pub fn visibility_between_m(layer: &FogLayer, eye: &Viewpoint, offset: DVec3, background_per_m: f64) -> Result<f64> {
    check_range("background_per_m", background_per_m, 0.0, MAX_EXTINCTION_PER_M, "1/m")?;
    let range = offset.length();
    if range.is_nan() || range <= 0.0 {
        return Err(Error::range("offset", "longer than 0 m", range));
    }
    let depth = -transmittance_between(layer, eye, offset)?[1].max(f64::MIN_POSITIVE).ln();
    Ok(koschmieder_visibility_m(depth / range + background_per_m))
}

/// Returns the vertical visibility from altitude `altitude_m`, m (METAR VV): the height above this altitude at which a
/// black target, seen from below, keeps 5 % of its contrast. The air has the extinction of the layer plus
/// `background_per_m`. Infinite if the target keeps more than 5 % through the whole layer and `background_per_m` is 0.
///
/// # Errors
/// [`crate::Status::InvalidArgument`] naming the parameter.
pub fn vertical_visibility_m(layer: &FogLayer, altitude_m: f64, background_per_m: f64) -> Result<f64> {
    check_range("background_per_m", background_per_m, 0.0, MAX_EXTINCTION_PER_M, "1/m")?;
    let m = FogModel::new(&Law::Layer(*layer), &NO_LIGHT, &Viewpoint::flat(altitude_m))?;
    let wanted = -CONTRAST_THRESHOLD.ln();
    let here = layer_depth_above(&m, altitude_m);
    let depth = |z: f64| here - layer_depth_above(&m, altitude_m + z) + background_per_m * z;
    let (mut lo, mut hi) = (0.0, 1.0);
    while depth(hi) < wanted {
        if hi > 1e9 {
            return Ok(f64::INFINITY);
        }
        (lo, hi) = (hi, hi * 2.0);
    }
    for _ in 0..60 {
        let mid = 0.5 * (lo + hi);
        if depth(mid) < wanted { lo = mid } else { hi = mid }
    }
    Ok(0.5 * (lo + hi))
}

/// Returns the smallest illuminance at which a pilot sees a light, lx, against a background of `background_cd_m2`:
/// log10 E = 0.05 (log10 B)^2 + 0.573 log10 B - 6.667. It is at least 8e-7 lx, the value by night. The curve runs
/// midway through the steps of ICAO's table: 8e-7 lx by night, 1e-5 lx from 50 cd/m2, 1e-4 lx from 1000 cd/m2, 1e-3 lx
/// from 12000 cd/m2 (ICAO Doc 9328; WMO-No. 8).
pub fn light_threshold_lx(background_cd_m2: f64) -> f64 {
    let b = background_cd_m2.max(1.0).log10();
    10f64.powf(0.05 * b * b + 0.573 * b - 6.667).max(8e-7)
}

/// Returns the distance, m, at which a light of `intensity_cd` is just visible in air of extinction `extinction_per_m`:
/// Allard's law (Allard 1876), E = I exp(-sigma R)/R^2 at the threshold of [`light_threshold_lx`].
///
/// # Errors
/// [`crate::Status::InvalidArgument`] naming the parameter.
pub fn lights_range_m(intensity_cd: f64, extinction_per_m: f64, background_cd_m2: f64) -> Result<f64> {
    check_range("intensity_cd", intensity_cd, 0.0, 1e9, "cd")?;
    check_range("extinction_per_m", extinction_per_m, 0.0, MAX_EXTINCTION_PER_M, "1/m")?;
    check_range("background_cd_m2", background_cd_m2, 0.0, 1e6, "cd/m2")?;
    let threshold = light_threshold_lx(background_cd_m2);
    // ln(I/E) = sigma R + 2 ln R. The right side grows with R, so it is bisected.
    let wanted = (intensity_cd / threshold).ln();
    let (mut lo, mut hi) = (1e-6f64, (intensity_cd / threshold).sqrt().max(1e-6));
    for _ in 0..200 {
        let mid = 0.5 * (lo + hi);
        if extinction_per_m * mid + 2.0 * mid.ln() < wanted { lo = mid } else { hi = mid }
    }
    Ok(0.5 * (lo + hi))
}

/// Returns the runway visual range, m: the larger of the range of its lights (by night and in thick fog) and the
/// meteorological optical range (by day), as in ICAO Doc 9328.
///
/// # Errors
/// Errors of [`lights_range_m`].
pub fn runway_visual_range_m(intensity_cd: f64, extinction_per_m: f64, background_cd_m2: f64) -> Result<f64> {
    let lights = lights_range_m(intensity_cd, extinction_per_m, background_cd_m2)?;
    Ok(lights.max(koschmieder_visibility_m(extinction_per_m)))
}

/// Returns the extinction, 1/m, for a reported runway visual range, \[1, 1e6\] m: the inverse of
/// [`runway_visual_range_m`].
///
/// # Errors
/// [`crate::Status::InvalidArgument`] naming the parameter.
pub fn extinction_of_rvr_per_m(rvr_m: f64, intensity_cd: f64, background_cd_m2: f64) -> Result<f64> {
    check_range("rvr_m", rvr_m, 1.0, 1e6, "m")?;
    check_range("intensity_cd", intensity_cd, 0.0, 1e9, "cd")?;
    check_range("background_cd_m2", background_cd_m2, 0.0, 1e6, "cd/m2")?;
    let lights = ((intensity_cd / light_threshold_lx(background_cd_m2)).ln() - 2.0 * rvr_m.ln()) / rvr_m;
    Ok(lights.max(koschmieder_extinction_per_m(rvr_m)))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The steps of the table, tested at the geometric means of neighbouring values.
    #[test]
    fn the_threshold_of_lights_passes_through_the_steps_of_the_table() {
        for (b, e) in [(50.0, 8e-7 * 1e-5), (1000.0, 1e-5 * 1e-4), (12_000.0, 1e-4 * 1e-3)] {
            let middle = f64::sqrt(e);
            assert!((light_threshold_lx(b) / middle - 1.0).abs() < 0.02, "{b}: {}", light_threshold_lx(b));
        }
        assert_eq!(light_threshold_lx(0.0), 8e-7);
    }

    #[test]
    fn lights_obey_allards_law_and_rvr_inverts() {
        for (intensity, background, visibility) in [(1e4, 0.1, 200.0), (1e3, 500.0, 600.0), (200.0, 2e4, 3000.0)] {
            let sigma = koschmieder_extinction_per_m(visibility);
            let r = lights_range_m(intensity, sigma, background).unwrap();
            let e = intensity * (-sigma * r).exp() / (r * r);
            assert!((e / light_threshold_lx(background) - 1.0).abs() < 1e-9, "{e}");
            let rvr = runway_visual_range_m(intensity, sigma, background).unwrap();
            assert!(rvr >= visibility * (1.0 - 1e-12) && rvr >= r);
            let back = extinction_of_rvr_per_m(rvr, intensity, background).unwrap();
            assert!((back / sigma - 1.0).abs() < 1e-9, "{back} {sigma}");
        }
        // By night a strong light is visible far beyond the optical range, by bright day it is not.
        let sigma = koschmieder_extinction_per_m(350.0);
        assert!(lights_range_m(1e4, sigma, 0.1).unwrap() > 700.0);
        assert!((runway_visual_range_m(10.0, sigma, 2e4).unwrap() - 350.0).abs() < 1e-9);
        assert!((koschmieder_visibility_m(sigma) - 350.0).abs() < 1e-9);
    }

    #[test]
    fn visibility_along_a_line_and_straight_up() {
        let sigma = koschmieder_extinction_per_m(150.0);
        let fog = FogLayer::ground_fog(sigma, 40.0, 10.0);
        let eye = Viewpoint::flat(2.0);
        let level = visibility_between_m(&fog, &eye, DVec3::new(300.0, 0.0, 0.0), 0.0).unwrap();
        assert!((level - 150.0).abs() < 1e-9, "{level}");
        let out = visibility_between_m(&fog, &eye, DVec3::new(0.0, 0.0, 300.0), 0.0).unwrap();
        assert!((out - 150.0 * 300.0 / 38.0).abs() < 1e-6, "38 of 300 m lie in fog: {out}");
        let t = transmittance_between(&fog, &eye, DVec3::new(150.0, 0.0, 0.0)).unwrap();
        assert!((t[1] - 0.05).abs() < 1e-12);
        assert!(vertical_visibility_m(&fog, 2.0, 0.0).unwrap().is_infinite());
        let deep = FogLayer::ground_fog(sigma, 400.0, 10.0);
        assert!((vertical_visibility_m(&deep, 2.0, 0.0).unwrap() - 150.0).abs() < 1e-6);
        let hazy = vertical_visibility_m(&fog, 2.0, 1e-4).unwrap();
        assert!((sigma * 38.0 + 1e-4 * hazy + CONTRAST_THRESHOLD.ln()).abs() < 1e-9, "{hazy}");
        let bad = FogLayer { extinction_per_m: f64::NAN, ..fog };
        assert!(
            visibility_between_m(&bad, &eye, DVec3::X, 0.0).unwrap_err().to_string().contains("fog.extinction_per_m")
        );
        assert!(transmittance_between(&bad, &eye, DVec3::X).unwrap_err().to_string().contains("fog.extinction_per_m"));
        assert!(transmittance_between(&fog, &eye, DVec3::NAN).unwrap_err().to_string().contains("offset"));
    }
}
