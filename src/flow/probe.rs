//! Test flows with published solutions.

use std::f64::consts::TAU;

use glam::DVec3;

use super::{FlowField, FlowObstacles, FlowSettings, Scheme, Side};
use crate::error::{Error, Result, Status, check_range};

/// Limit below which the cavity's flow counts as steady: the largest change of a velocity while the lid moves by the
/// cavity's width, as a share of the lid's speed.
const REST: f64 = 2e-4;
/// Largest number of spans of time before giving up. In each span the lid moves by the cavity's width.
const MOST_TIMES: u32 = 500;

/// Returns the steady flow in a square box, 1 m wide, of `n` by `n` cells, whose lid moves at 1 m/s, at Reynolds number
/// `re`.
///
/// # Errors
/// [`Status::InvalidArgument`] for `re` not in \[1, 10,000\] and `n` not in \[8, 1024\]; [`Status::Unsupported`] if the
/// flow does not become steady.
pub fn cavity(re: f64, n: u32) -> Result<FlowField> {
    check_range("re", re, 1.0, 1e4, "")?;
    check_range("n", f64::from(n), 8.0, 1024.0, "")?;
    let wall = Side::NoSlip([0.0; 3]);
    let settings = FlowSettings {
        cells: [n, n, 1],
        cell_m: DVec3::splat(1.0 / f64::from(n)),
        sides: [[wall, wall], [wall, Side::NoSlip([1.0, 0.0, 0.0])], [Side::Periodic; 2]],
        viscosity_m2_s: 1.0 / re,
        tolerance: 1e-5,
        ..FlowSettings::default()
    };
    let mut field = FlowField::new(&settings, &FlowObstacles::default(), |_| DVec3::ZERO)?;
    // At the beginning only the lid moves: in the first step it moves by one cell.
    field.step(1.0 / f64::from(n))?;
    if field.settle(1.0, REST, MOST_TIMES)? {
        return Ok(field);
    }
    Err(Error::new(Status::Unsupported, format!("the flow in the cavity does not rest at a Reynolds number of {re}")))
}

/// Returns the share of kinetic energy that Taylor-Green vortices (Taylor and Green 1937) keep after 2 pi seconds.
/// Without viscosity they should stay unchanged for ever. The grid has `n` by `n` cells; in a step the fastest air
/// passes `cfl` cells.
///
/// # Errors
/// [`Status::InvalidArgument`] for `n` not in \[8, 1024\] and `cfl` not in \[0.01, 64\].
pub fn taylor_green(n: u32, cfl: f64, scheme: Scheme) -> Result<f64> {
    check_range("n", f64::from(n), 8.0, 1024.0, "")?;
    check_range("cfl", cfl, 0.01, 64.0, "")?;
    let h = TAU / f64::from(n);
    let settings = FlowSettings {
        cells: [n, n, 1],
        cell_m: DVec3::splat(h),
        sides: [[Side::Periodic; 2]; 3],
        scheme,
        ..FlowSettings::default()
    };
    let whirls = |p: DVec3| DVec3::new(libm::sin(p.x) * libm::cos(p.y), -libm::cos(p.x) * libm::sin(p.y), 0.0);
    let mut field = FlowField::new(&settings, &FlowObstacles::default(), whirls)?;
    let before = field.kinetic_energy();
    let steps = (TAU / (cfl * h)).round().max(1.0);
    for _ in 0..steps as u32 {
        field.step(TAU / steps)?;
    }
    Ok(field.kinetic_energy() / before)
}
