//! `probe cloud-shape`: statistics of the shape of the drawn clouds, seen from straight above.

use glam::DVec2;
use welkin::clouds::cover::{field, threshold, typical};
use welkin::clouds::field::{Field, Map, Solid};
use welkin::weather::CloudKind;
use welkin::{Error, Result, Status, error::check_range};
use welkin_support::cloud_shape::{CloudMask, CloudShape, measure};

use crate::clouds::kind_of;

/// Number of pixels along a side of a picture.
pub const SIDE: usize = 1024;
/// Side of a pixel without `--pixel`, m.
pub const PIXEL_M: f64 = 20.0;
/// Vertical optical depth above which a pixel is cloud.
const CLOUDY: f64 = 1.0;
/// Number of heights at which a column's extinction is summed up, twice as many as in the clouds' shadow map.
const HEIGHTS: usize = 24;

/// Returns whether the vertical optical depth of a layer at a place, m east and north, exceeds [`CLOUDY`].
fn is_cloudy(field: &Field<'_>, place_m: DVec2) -> bool {
    let step_m = field.shape.thickness_m / HEIGHTS as f64;
    let mut depth = 0.0;
    (0..HEIGHTS).any(|k| {
        let altitude_m = field.shape.base_m + (k as f64 + 0.5) * step_m;
        depth += field.extinction_per_m(place_m.extend(altitude_m)) * step_m;
        depth > CLOUDY
    })
}

/// Returns the masks of a kind of cloud at a cover, one for each seed from 0 on. Pixels have sides of `pixel_m`.
///
/// # Errors
/// [`Status::OutOfMemory`] if there is no memory for the noise.
pub fn masks(kind: CloudKind, cover: f64, seeds: u64, pixel_m: f64) -> Result<Vec<CloudMask>> {
    let slab = typical(kind, cover)?;
    (0..seeds)
        .map(|seed| {
            let grown = (Map::new(seed), Solid::new(seed)?);
            let field = field(&slab, &grown, threshold(&slab));
            let place_m = |x: usize, y: usize| DVec2::new(x as f64 + 0.5, y as f64 + 0.5) * pixel_m;
            Ok(CloudMask::new(SIDE, |x, y| is_cloudy(&field, place_m(x, y))))
        })
        .collect()
}

/// Answers with the statistics of a genus over seeds, an empty line, and the number of clouds by diameter. Statistics
/// for which there are too few clouds are `nan`.
///
/// # Errors
/// [`Status::Parse`] for an unknown genus; [`Status::InvalidArgument`] for pixels outside 1 to 1000 m.
pub fn answer(genus: &str, cover: f64, seeds: u64, pixel_m: f64) -> Result<String> {
    check_range("--pixel", pixel_m, 1.0, 1000.0, "m")?;
    let kind = kind_of(genus)?;
    if cover <= 0.0 {
        return Err(Error::new(Status::Parse, "--okta must be above 0: a clear sky has no clouds"));
    }
    Ok(lines(&measure(&masks(kind, cover, seeds, pixel_m)?, pixel_m)))
}

/// Returns the statistics as two tables.
fn lines(shape: &CloudShape) -> String {
    let number = |value: Option<f64>| value.map_or("nan".into(), |v| format!("{v:.4}"));
    let law = shape.law;
    let mut out = String::from(
        "cover,clouds,fractal_dimension,perimeter_exponent,area_exponent,area_exponent_from_3_km2,strongest_edge,\
         edge_axis_deg,diameter_exponent_below,break_m,diameter_exponent_above\n",
    );
    out.push_str(&format!(
        "{:.4},{},{},{},{},{},{:.4},{:.1},{},{},{}\n\ndiameter_m,clouds,per_km2_km\n",
        shape.cover,
        shape.count,
        number(shape.dimension),
        number(shape.perimeter_exponent),
        number(shape.area_exponent),
        number(shape.large_area_exponent),
        shape.edges.strongest(),
        shape.edges.axis_deg,
        number(law.map(|law| law.below)),
        number(law.map(|law| law.break_m)),
        number(law.map(|law| law.above)),
    ));
    for size in &shape.numbers {
        out.push_str(&format!("{:.1},{},{:.6}\n", size.diameter_m, size.count, size.per_km2_km));
    }
    out
}
