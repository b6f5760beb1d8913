//! Projection of a star onto the picture, in f64: the reference of `shaders/stars/points.wgsl`, with the same names.

use glam::{DVec2, DVec3};

use super::{light::transmittance, places::lifted, uniforms::StarView};
use crate::light::luminance;

/// Half the width of a star's footprint, pixels.
pub const REACH: f64 = 2.0;
/// Largest weight of a pixel, reached when the star is at its centre.
pub const PEAK_WEIGHT: f64 = 4.0 / 9.0;
/// Ratio of illuminance over which stars fade in, from the faintest drawn upwards: half a magnitude.
pub const FADE: f64 = 1.585;

/// Cubic B-spline (Schoenberg 1946; Unser 1999): `2/3 - a^2 + a^3 / 2` for `a = |x| < 1`, `(2 - a)^3 / 6` up to 2.
///
/// Its values at unit steps from any offset add up to exactly 1, and so do their products on a grid of pixels. A star's
/// light is therefore the same wherever it stands between pixels. The spline's standard deviation is 0.577 pixels.
pub fn spline(x: f64) -> f64 {
    let a = x.abs();
    if a < 1.0 { 2.0 / 3.0 - a * a * (1.0 - 0.5 * a) } else { (2.0 - a).max(0.0).powi(3) / 6.0 }
}

/// Share of a star's light that falls on a pixel whose centre is `offset` pixels from the star.
pub fn weight(offset: DVec2) -> f64 {
    spline(offset.x) * spline(offset.y)
}

/// A star as projected onto the picture.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Point {
    /// Position from the outer corner of the target's first pixel (row 0, column 0), pixels.
    pub pixel: DVec2,
    /// Radiance of a pixel that receives all of the star's light, in the target's units, a channel: illuminance divided
    /// by the pixel's solid angle.
    pub light: [f64; 3],
    /// Solid angle of a pixel at the star, sr.
    pub pixel_sr: f64,
}

/// Projects a star, given by its direction in J2000.0 and its illuminance above the air, lux a channel. `None` if it is
/// outside the picture, below the horizon, or too faint.
pub fn point(view: &StarView<'_>, direction: DVec3, lux: [f64; 3]) -> Option<Point> {
    let seen = lifted(view.heavens.seen(direction), view.air_density);
    let clip = view.clip * seen.extend(0.0);
    let elevation = seen.z.clamp(-1.0, 1.0).asin();
    let air = transmittance(view.zenith_depth, elevation.to_degrees());
    let arriving: [f64; 3] = std::array::from_fn(|k| lux[k] * air[k] * view.transmittance);
    let fade = ((luminance(&arriving) / view.faintest_lux.max(1e-20) - 1.0) / (FADE - 1.0)).clamp(0.0, 1.0);
    let size = DVec2::new(f64::from(view.size[0]), f64::from(view.size[1]));
    let ndc = clip.truncate().truncate() / clip.w.max(1e-9) * DVec2::new(1.0, f64::from(view.y_sign));
    let outside = ndc.abs().cmpgt(1.0 + 4.0 / size).any();
    if clip.w <= 1e-9 || outside || fade <= 0.0 || elevation < view.horizon_deg.to_radians() {
        return None;
    }
    let pixel_sr = view.pixel_sr() * clip.w.powi(3);
    Some(Point {
        pixel: (0.5 + 0.5 * ndc * DVec2::new(1.0, -1.0)) * size,
        light: arriving.map(|lux| lux * fade * view.scale / pixel_sr),
        pixel_sr,
    })
}

/// Adds a star to a picture of `size` pixels, whose rows begin with the target's row 0.
pub fn add(picture: &mut [[f64; 3]], size: [u32; 2], point: &Point) {
    let first = (point.pixel - 0.5 - REACH).ceil().max(DVec2::ZERO).as_uvec2();
    let last = (point.pixel - 0.5 + REACH).floor();
    if last.min_element() < 0.0 {
        return;
    }
    let last = last.as_uvec2().min(glam::uvec2(size[0] - 1, size[1] - 1));
    for y in first.y..=last.y {
        for x in first.x..=last.x {
            let share = weight(DVec2::new(f64::from(x), f64::from(y)) + 0.5 - point.pixel);
            let texel = &mut picture[(y * size[0] + x) as usize];
            (0..3).for_each(|k| texel[k] += point.light[k] * share);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_footprint_adds_up_to_one_wherever_the_star_stands() {
        let size = [12, 12];
        for i in 0..37 {
            for j in 0..37 {
                let pixel = DVec2::new(5.0 + f64::from(i) / 37.0, 6.0 + f64::from(j) / 37.0);
                let mut picture = vec![[0.0; 3]; 144];
                add(&mut picture, size, &Point { pixel, light: [1.0, 2.0, 4.0], pixel_sr: 1.0 });
                let sum = |k: usize| picture.iter().map(|p| p[k]).sum::<f64>();
                assert!((sum(0) - 1.0).abs() < 1e-12 && (sum(2) - 4.0).abs() < 1e-12, "{pixel}");
                let most = picture.iter().map(|p| p[0]).fold(0.0, f64::max);
                // At worst it falls equally on four pixels. The brightest of them then gets a little over half of the
                // light of a pixel whose centre the star hits.
                assert!((0.229..=PEAK_WEIGHT + 1e-12).contains(&most), "{most}");
            }
        }
        assert_eq!(weight(DVec2::ZERO), PEAK_WEIGHT);
        assert_eq!(spline(2.0), 0.0);
    }

    #[test]
    fn the_footprint_moves_with_the_star() {
        // The centroid of the footprint is the star's position, so the star moves smoothly between pixels.
        for i in 0..50 {
            let x = f64::from(i) / 50.0;
            let mean: f64 = (-3..=3).map(|p| f64::from(p) * spline(f64::from(p) - x)).sum();
            assert!((mean - x).abs() < 1e-12, "{x} {mean}");
        }
    }
}
