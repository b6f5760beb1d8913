//! Snow that is too steep slides down until no slope is above the angle of repose: to the neighbour below that is steepest, by half of
//! what is too much.

use super::{
    column::{Column, UNITS},
    field::Land,
    laws::REPOSE_DEG,
};

/// Heights too great by less than this stay, m.
const SLACK_M: f64 = 5e-4;
/// Most moves a cell of the field; what is left slides in the next call.
const MOST_MOVES: usize = 40;

/// Places of the eight neighbours and how far away they are, in cells.
const AROUND: [([isize; 2], f64); 8] = [
    ([1, 0], 1.0),
    ([0, 1], 1.0),
    ([-1, 0], 1.0),
    ([0, -1], 1.0),
    ([1, 1], std::f64::consts::SQRT_2),
    ([-1, 1], std::f64::consts::SQRT_2),
    ([-1, -1], std::f64::consts::SQRT_2),
    ([1, -1], std::f64::consts::SQRT_2),
];

/// The neighbours of a cell on which snow can lie.
fn around(land: &Land, cell: usize) -> impl Iterator<Item = (usize, f64)> + '_ {
    let [nx, ny] = land.nodes;
    let place = [(cell % nx) as isize, (cell / nx) as isize];
    AROUND.iter().filter_map(move |([dx, dy], cells)| {
        let (x, y) = (place[0] + dx, place[1] + dy);
        let inside = x >= 0 && y >= 0 && x < nx as isize && y < ny as isize;
        let to = if inside { y as usize * nx + x as usize } else { return None };
        (!land.is_blocked(to)).then_some((to, cells * land.cell_m))
    })
}

fn surface_m(columns: &[Column], land: &Land, cell: usize) -> f64 {
    land.heights_m[cell] + columns[cell].depth_m()
}

/// The neighbour to which the snow of a cell slides, and how much higher it is than it may be, m.
fn steepest(columns: &[Column], land: &Land, cell: usize, rise: f64) -> Option<(usize, f64)> {
    let here = surface_m(columns, land, cell);
    let over = |(to, way): (usize, f64)| (to, here - surface_m(columns, land, to) - rise * way);
    let found = around(land, cell).map(over).filter(|(_, over)| *over > SLACK_M);
    found.reduce(|a, b| if b.1 > a.1 { b } else { a })
}

/// Lets all snow slide that lies too steep. Answers whether all of it has come to rest.
pub(super) fn relax(columns: &mut [Column], land: &Land) -> bool {
    let rise = libm::tan(REPOSE_DEG.to_radians());
    let mut left = MOST_MOVES * land.len();
    let mut moving: Vec<u32> = Vec::new();
    for first in 0..land.len() {
        moving.push(first as u32);
        while let Some(cell) = moving.pop() {
            let cell = cell as usize;
            if columns[cell].depth == 0 {
                continue;
            }
            let Some((to, over)) = steepest(columns, land, cell, rise) else { continue };
            if left == 0 {
                return false;
            }
            left -= 1;
            let depth = columns[cell].depth;
            let down = ((0.5 * over * UNITS) as i64 + 1).min(depth);
            let albedo = columns[cell].albedo;
            let part = columns[cell].take(down, depth);
            columns[to].add(part, albedo);
            // Both may slide on, and what lies above the cell has lost its hold.
            moving.push(to as u32);
            moving.push(cell as u32);
            moving.extend(around(land, cell).map(|(above, _)| above as u32));
        }
    }
    true
}
