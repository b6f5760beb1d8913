//! Walls of bank: which ones are higher than their soil can stand, and what falls with them.
//!
//! A wall between a crest and a toe fails if three conditions hold. First, the bank's top lies higher above the toe
//! than the highest face that the law allows over the distance between crest and toe
//! ([`super::laws::WallLaw::height_over_m`]), with the cohesion that the bank's water leaves. Second, the face is
//! steeper than the bank's friction angle and the angle of repose. Third, the crest or the toe was dug or pressed. What
//! lies above the slope of repose through the toe then counts as broken: it slides like loose soil (`src/slides.rs`),
//! swells as it moves, and comes to rest at its angle of repose.

use super::{
    field::{SoilCell, SoilField},
    patch::{CELLS, NEAR, NO_PATCH, UndugGround},
};

/// Factor by which the fall of the ground must grow at a crest.
const CREST: f64 = 1.05;
/// Distance behind a toe, in cells, that a fall does not reach any more.
const MOST_BROKEN: i32 = 512;

/// Cohesion at and above which the bank counts as cemented, kPa. It is far above the cohesion of soils, and equals that
/// of weak rock and coal.
const CEMENTED_KPA: f64 = 100.0;

/// Toe of a wall that fails, and the direction of the fall.
struct Fall {
    toe: SoilCell,
    /// Offset of a step from the crest towards the toe.
    way: [i32; 2],
    toe_height: f64,
}

/// Lets walls fall that are higher than their soil can stand, on patches with unchecked walls and on their neighbours.
/// Returns whether any wall falls.
pub(super) fn break_walls(field: &mut SoilField, ground: &dyn UndugGround) -> bool {
    if !field.patches.iter().any(|patch| patch.is_unchecked) {
        return false;
    }
    let lowest = field.patches.iter().flat_map(|patch| &patch.surface).fold(f64::INFINITY, |low, v| low.min(*v));
    let mut falls = Vec::new();
    for slot in field.slots.values() {
        let patch = field.patch(*slot);
        let near = patch.near.into_iter().filter(|other| *other != NO_PATCH);
        if !patch.is_unchecked && !near.into_iter().any(|other| field.patch(other).is_unchecked) {
            continue;
        }
        for cell in 0..CELLS {
            let crest = SoilCell { slot: *slot, cell };
            falls.extend(NEAR.iter().filter_map(|way| failing(field, crest, *way, lowest)));
        }
    }
    field.patches.iter_mut().for_each(|patch| patch.is_unchecked = false);
    let any = !falls.is_empty();
    for fall in falls {
        break_behind(field, &fall, ground);
    }
    any
}

/// Returns the fall of a wall whose crest is a cell, towards one side.
fn failing(field: &SoilField, crest: SoilCell, way: [i32; 2], lowest: f64) -> Option<Fall> {
    let patch = field.patch(crest.slot);
    let top = patch.bank_top(crest.cell);
    if top.is_nan() || patch.broken[crest.cell] {
        return None;
    }
    let material = &field.materials.kinds[field.materials.bank_kind(patch.cut[crest.cell])];
    // Water takes no strength from cemented ground.
    let hold = if material.kind.cohesion_kpa >= CEMENTED_KPA { 1.0 } else { patch.hold() };
    let surface = |cell: SoilCell| field.patch(cell.slot).surface[cell.cell];
    let diagonal = if way[0] != 0 && way[1] != 0 { std::f64::consts::SQRT_2 } else { 1.0 };
    let next = field.beside(crest, way)?;
    let first = top - surface(next);
    // A face can be highest only where the ground begins to fall more steeply than bank can lie.
    if first <= material.bank_grade * diagonal {
        return None;
    }
    let behind = field.beside(crest, way.map(|v| -v)).map_or(0.0, |cell| surface(cell) - patch.surface[crest.cell]);
    if first <= CREST * behind {
        return None;
    }
    let is_disturbed = |cell: SoilCell| field.patch(cell.slot).is_disturbed(cell.cell);
    let mut toe = crest;
    for steps in 1.. {
        // The face is upright where the toe is the next cell.
        let run = (steps as f64 - 1.0) * diagonal;
        let stands = hold * wall_height(&material.walls, run)?;
        if top - lowest <= stands {
            return None;
        }
        toe = field.beside(toe, way)?;
        let drop = top - surface(toe);
        let is_steep = drop > material.bank_grade * diagonal * f64::from(steps);
        if drop > stands && is_steep && (is_disturbed(toe) || is_disturbed(crest)) {
            return Some(Fall { toe, way, toe_height: surface(toe) });
        }
    }
    None
}

/// Height of the highest wall over a run in cells, linear between the entries of `walls`.
fn wall_height(walls: &[f64], run: f64) -> Option<f64> {
    let cell = run as usize;
    let (low, high) = (walls.get(cell)?, walls.get(cell + 1)?);
    Some(low + (high - low) * (run - cell as f64))
}

/// Marks as broken the bank above the slope of repose through a toe, in the line of the fall.
fn break_behind(field: &mut SoilField, fall: &Fall, ground: &dyn UndugGround) {
    let toe = field.place(fall.toe);
    let diagonal = if fall.way[0] != 0 && fall.way[1] != 0 { std::f64::consts::SQRT_2 } else { 1.0 };
    for steps in 1..MOST_BROKEN {
        let place = [0, 1].map(|i| toe[i] - steps * fall.way[i]);
        let Some(cell) = field.find_or_add(place, ground) else { return };
        let patch = field.patch(cell.slot);
        let grade = field.materials.kinds[field.materials.bank_kind(patch.cut[cell.cell])].grade;
        if patch.bank_top(cell.cell) <= fall.toe_height + grade * diagonal * f64::from(steps) {
            return;
        }
        field.change(cell, |patch, cell, materials| {
            patch.broken[cell] = true;
            patch.refresh(cell, materials);
        });
        field.has_broken = true;
    }
}
