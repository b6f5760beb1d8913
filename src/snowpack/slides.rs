//! Sliding of steep snow, until no slope exceeds the angle of repose. Snow slides to the lower neighbour with the
//! largest excess height: the difference in height less the largest stable one, distance x tan(angle of repose). Half
//! of the excess slides. Cells are visited in the order of the lattice's rows, across patches.

use super::{column::UNITS, field::SnowField, laws::REPOSE_DEG, patch::NONE};

/// Largest excess height at which snow stays, m.
const SLACK_M: f64 = 5e-4;
/// Largest number of moves in a call, per cell of the field; the rest slides in the next call.
const MOST_MOVES: usize = 40;

/// Offsets of the eight neighbours, and their distances in cells.
const AROUND: [([i32; 2], f64); 8] = [
    ([1, 0], 1.0),
    ([0, 1], 1.0),
    ([-1, 0], 1.0),
    ([0, -1], 1.0),
    ([1, 1], std::f64::consts::SQRT_2),
    ([-1, 1], std::f64::consts::SQRT_2),
    ([-1, -1], std::f64::consts::SQRT_2),
    ([1, -1], std::f64::consts::SQRT_2),
];

/// Returns the cell at an offset (cells east, cells north) from another cell, as the index of the patch and the cell's
/// index in the patch. `None` without a patch there.
fn beside(field: &SnowField, (patch, cell): (u32, u32), [dx, dy]: [i32; 2]) -> Option<(u32, u32)> {
    let size = field.size.map(|n| n as i32);
    let (x, y) = (cell as i32 % size[0] + dx, cell as i32 / size[0] + dy);
    let out = [(x, 0), (y, 1)].map(|(v, i): (i32, usize)| v.div_euclid(size[i]));
    let own = &field.patches[patch as usize];
    let at = match out {
        [0, 0] => patch,
        [1, 0] => own.near[1],
        [_, 0] => own.near[0],
        [0, 1] => own.near[3],
        [0, _] => own.near[2],
        [east, north] => field.find([own.key[0] + east, own.key[1] + north]).map_or(NONE, |at| at as u32),
    };
    (at != NONE).then(|| (at, (y.rem_euclid(size[1]) * size[0] + x.rem_euclid(size[0])) as u32))
}

/// Returns those neighbours of a cell on which snow can lie, and their distances, m.
fn around(field: &SnowField, cell: (u32, u32)) -> impl Iterator<Item = ((u32, u32), f64)> + '_ {
    AROUND.iter().filter_map(move |(way, cells)| {
        let to = beside(field, cell, *way)?;
        (!field.patches[to.0 as usize].is_blocked(to.1 as usize)).then_some((to, cells * field.cell_m))
    })
}

/// Returns the height of ground and snow, m, at a cell given by its patch and its index there.
fn surface_m(field: &SnowField, (patch, cell): (u32, u32)) -> f64 {
    field.patches[patch as usize].surface_m(cell as usize)
}

/// Returns the neighbour to which the snow of a cell slides, and the excess height, m; `None` if the snow rests. `rise`
/// is the tangent of the angle of repose.
fn steepest(field: &SnowField, cell: (u32, u32), rise: f64) -> Option<((u32, u32), f64)> {
    let here = surface_m(field, cell);
    let over = |(to, way): ((u32, u32), f64)| (to, here - surface_m(field, to) - rise * way);
    let found = around(field, cell).map(over).filter(|(_, over)| *over > SLACK_M);
    found.reduce(|a, b| if b.1 > a.1 { b } else { a })
}

/// Lets the snow of the cells in `moving` slide, and then the snow that this makes too steep. Returns whether all of it
/// has come to rest before `left` moves are used up.
fn settle(field: &mut SnowField, moving: &mut Vec<(u32, u32)>, rise: f64, left: &mut usize, revision: u64) -> bool {
    while let Some(cell) = moving.pop() {
        let column = field.patches[cell.0 as usize].column(cell.1 as usize);
        if column.depth == 0 {
            continue;
        }
        let Some((to, over)) = steepest(field, cell, rise) else { continue };
        if *left == 0 {
            return false;
        }
        *left -= 1;
        let (mut column, mut below) = (column, field.patches[to.0 as usize].column(to.1 as usize));
        let (depth, albedo) = (column.depth, column.albedo);
        let down = ((0.5 * over * UNITS) as i64 + 1).min(depth);
        below.add(column.take(down, depth), albedo);
        for (at, column) in [(cell, column), (to, below)] {
            let patch = &mut field.patches[at.0 as usize];
            patch.put(at.1 as usize, column);
            patch.changed(revision);
        }
        // Tests both cells and the neighbours of the upper one again: the move has changed their slopes.
        moving.push(to);
        moving.push(cell);
        moving.extend(around(field, cell).map(|(above, _)| above));
    }
    true
}

/// Lets all snow slide that lies too steep. `moving` is scratch space. Returns whether all of it has come to rest.
pub(super) fn relax(field: &mut SnowField, moving: &mut Vec<(u32, u32)>, revision: u64) -> bool {
    let rise = libm::tan(REPOSE_DEG.to_radians());
    let mut left = MOST_MOVES * field.len();
    let [columns, rows] = field.size;
    let mut first = 0;
    while first < field.patches.len() {
        // Neighbouring patches of one row, from west to east.
        let north = field.patches[first].key[1];
        let end = first + field.patches[first..].iter().take_while(|p| p.key[1] == north).count();
        if field.patches[first..end].iter().all(|p| p.is_bare()) {
            first = end;
            continue;
        }
        for row in 0..rows {
            for patch in first..end {
                for cell in row * columns..(row + 1) * columns {
                    // A cell that is bare now may receive snow from above.
                    if field.patches[patch].columns.get(cell).is_some_and(|c| c.depth > 0) {
                        moving.clear();
                        moving.push((patch as u32, cell as u32));
                        if !settle(field, moving, rise, &mut left, revision) {
                            return false;
                        }
                    }
                }
            }
        }
        first = end;
    }
    true
}
