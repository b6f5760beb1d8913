//! Pours a heap onto level ground with the slides of simulated ground, and measures how round the heap is.

use super::{
    field::{SoilCell, SoilField},
    kind::{BUILT_IN, SoilHorizon, SoilKind, SoilKindId},
    laws::cone_radius_m,
    material::{MASS_UNITS, SoilMaterials},
    patch::UndugGround,
};
use crate::error::{Error, Result, check_range};

/// Number of equal masses in which a heap is poured.
const PARTS: i64 = 200;
/// Numbers of sweeps between two pourings and after the last one, divided by the square of the radius in cells. Slides
/// spread like heat, in a time that grows with the square of the distance. After the last sweep, less than a thousandth
/// of the excess is left.
const SWEEPS_BETWEEN: f64 = 0.02;
const SWEEPS_AFTER: f64 = 3.0;
/// Azimuths at which the heap is measured, degrees.
pub const HEAP_AZIMUTHS_DEG: [f64; 5] = [0.0, 11.25, 22.5, 33.75, 45.0];
/// Least and largest radius of a heap, cells.
const RADIUS_CELLS: [f64; 2] = [3.0, 160.0];

struct LevelGround;

impl UndugGround for LevelGround {
    fn height_m(&self, _cell: [i32; 2]) -> Option<f64> {
        Some(0.0)
    }
}

/// Pours a loose volume, m^3, of soil with this angle of repose, degrees, onto level ground in cells of `cell_m`, and
/// returns the radius of the heap, m, at each of [`HEAP_AZIMUTHS_DEG`]: the distance at which a line through the side,
/// between 20 and 80 % of the apex's height, meets the ground.
///
/// # Errors
/// [`crate::error::Status::InvalidArgument`] naming the field: `volume_m3` in \[1e-6, 1e6\], `repose_deg` in \[5, 60\],
/// and `cell_m` such that the heap's radius is 3 to 160 cells.
pub fn heap_radii_m(volume_m3: f64, repose_deg: f64, cell_m: f64) -> Result<[f64; 5]> {
    check_range("volume_m3", volume_m3, 1e-6, 1e6, "m^3")?;
    check_range("repose_deg", repose_deg, 5.0, 60.0, "deg")?;
    let radius_m = cone_radius_m(volume_m3, repose_deg.to_radians());
    let [least, most] = RADIUS_CELLS.map(|cells| radius_m / cells);
    if !(most..=least).contains(&cell_m) {
        let accepted = format!("in [{most:.4}, {least:.4}] m for a heap of 3 to 160 cells");
        return Err(Error::range("cell_m", &accepted, cell_m));
    }
    let kind = SoilKind { repose_deg, swell: 0.0, ..BUILT_IN[0] };
    let horizon = SoilHorizon { top_m: 0.0, kind: SoilKindId(0) };
    let mut field = SoilField::new(SoilMaterials::new(cell_m, &[kind], vec![horizon]));
    let cells = radius_m / cell_m;
    let [between, last] = [SWEEPS_BETWEEN, SWEEPS_AFTER].map(|sweeps| (sweeps * cells * cells).ceil() as usize);
    let mass = (volume_m3 * kind.density_kg_m3 * MASS_UNITS).round() as i64;
    for part in 0..PARTS {
        let poured = mass * (part + 1) / PARTS - mass * part / PARTS;
        let parcel = field.materials.loose(0, poured);
        if let Some(cell) = field.find_or_add([0, 0], &LevelGround) {
            field.put(cell, &parcel);
        }
        field.settle(between, &LevelGround);
    }
    field.settle(last, &LevelGround);
    Ok(HEAP_AZIMUTHS_DEG.map(|azimuth| radius_at(&field, azimuth.to_radians())))
}

/// Height at a place in cells, linear between the cells, in units.
fn height(field: &SoilField, place: [f64; 2]) -> f64 {
    let low = place.map(|v| v.floor());
    let at_corner = |x: i32, y: i32| {
        let cell = field.find([low[0] as i32 + x, low[1] as i32 + y]);
        cell.map_or(0.0, |SoilCell { slot, cell }| field.patch(slot).surface[cell])
    };
    let [x, y] = [place[0] - low[0], place[1] - low[1]];
    let south = at_corner(0, 0) * (1.0 - x) + at_corner(1, 0) * x;
    south * (1.0 - y) + (at_corner(0, 1) * (1.0 - x) + at_corner(1, 1) * x) * y
}

/// Distance at which a line through the heap's side meets the ground, m.
fn radius_at(field: &SoilField, azimuth: f64) -> f64 {
    let apex = height(field, [0.0, 0.0]);
    let way = [libm::cos(azimuth), libm::sin(azimuth)];
    // A straight line by least squares through samples every tenth of a cell.
    let mut sums = [0.0; 5];
    for i in 0.. {
        let distance = 0.1 * f64::from(i);
        let height = height(field, way.map(|v| v * distance));
        if height < 0.2 * apex {
            break;
        }
        if height <= 0.8 * apex {
            let terms = [1.0, distance, height, distance * distance, distance * height];
            sums.iter_mut().zip(terms).for_each(|(sum, term)| *sum += term);
        }
    }
    let [count, distance, height, squared, product] = sums;
    let slope = (count * product - distance * height) / (count * squared - distance * distance);
    let rise = (height - slope * distance) / count;
    -rise / slope * field.materials.cell_m
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn heaps_are_round() {
        for (volume_m3, repose_deg, cell_m, percent) in
            [(1.0, 35.0f64, 0.1, 1.0), (1.0, 35.0, 0.05, 0.5), (40.0, 28.0, 0.3, 0.8), (1.0, 35.0, 0.185, 2.0)]
        {
            let radii = heap_radii_m(volume_m3, repose_deg, cell_m).unwrap();
            let cone_m = cone_radius_m(volume_m3, repose_deg.to_radians());
            let off = radii.map(|radius_m| 100.0 * (radius_m / cone_m - 1.0));
            println!("{volume_m3} m^3, {repose_deg} degrees, {cell_m} m: {off:.2?} % off {cone_m:.4} m");
            assert!(off.iter().all(|off| off.abs() < percent), "{off:?}");
        }
    }

    #[test]
    fn impossible_heaps_are_named() {
        let fault = |volume, repose, cell| heap_radii_m(volume, repose, cell).unwrap_err().to_string();
        assert!(fault(f64::NAN, 35.0, 0.1).starts_with("volume_m3 must be in [0.000001, 1000000] m^3"));
        assert!(fault(1.0, 90.0, 0.1).starts_with("repose_deg must be in [5, 60] deg"));
        assert!(fault(1.0, 35.0, 1.0).starts_with("cell_m must be in [0.0069, 0.3697] m for a heap of 3 to 160 cells"));
    }
}
