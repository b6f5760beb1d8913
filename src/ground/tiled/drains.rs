//! Sink of each cell of a tile: the end of the cell's run-off within its block of cells. A sink is a pit, a cell of a
//! neighbouring block, or a hole or edge of the terrain.
//!
//! Run-off takes the steepest of the eight directions down, as on the host's grid. Paths are resolved within blocks of
//! 32 x 32 cells. A change of the ground therefore updates only the blocks that it touches, however far their water
//! runs.

use crate::terrain::{AROUND, CellId, CellRect, Terrain, TileKey};

/// Side of a block, cells; the side of a tile is a multiple of it.
const BLOCK: usize = 32;
/// Mark of a cell whose path has not been traced yet.
const UNKNOWN: u16 = u16::MAX;

/// End of the run-off of a cell within its block.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Sink {
    /// Cell that has no lower neighbour.
    Pit(CellId),
    /// Cell of another block, from which the water flows on.
    On(CellId),
    /// Hole or edge of the terrain beside the cell: the water leaves.
    Out,
}

/// Block of cells: their sinks, and the water that has reached each sink in this step.
#[derive(Clone, Debug, Default)]
pub(super) struct DrainBlock {
    /// Sinks, in the order in which they were found.
    pub sinks: Vec<Sink>,
    /// Water that has reached each sink in this step, mm times cells.
    pub inflow: Vec<f64>,
    /// Whether any `inflow` is above 0.
    pub gets: bool,
}

/// Sinks of a tile's cells.
#[derive(Clone, Debug)]
pub(super) struct Drains {
    /// Binary logarithm of the tile's side in cells.
    bits: u32,
    /// Index of each cell's sink in its block's list.
    of_cell: Vec<u16>,
    /// Blocks of the tile, by rows from the south-west.
    pub blocks: Vec<DrainBlock>,
}

/// Returns whether cell `a` is lower than `b`. Cells of equal height are ordered by place from the south-west, so one
/// of two cells is always the lower one.
pub(super) fn is_lower(terrain: &Terrain, a: CellId, b: CellId) -> bool {
    let (low, high) = (terrain.height(a), terrain.height(b));
    if low != high {
        return low < high;
    }
    let ([ax, ay], [bx, by]) = (terrain.place(a), terrain.place(b));
    (ay, ax) < (by, bx)
}

/// Returns where a cell's run-off goes first: out of the terrain if the cell lies beside a hole or the edge, else to
/// the steepest lower neighbour, or to the cell itself if it is a pit.
fn below(terrain: &Terrain, cell: CellId) -> Sink {
    let height = f64::from(terrain.height(cell));
    let (mut steepest, mut down) = (f64::NEG_INFINITY, Sink::Pit(cell));
    for (near, [dx, dy]) in terrain.around(cell).into_iter().zip(AROUND) {
        let Some(near) = near else { return Sink::Out };
        if is_lower(terrain, near, cell) {
            let way = if dx != 0 && dy != 0 { std::f64::consts::SQRT_2 } else { 1.0 };
            let slope = (height - f64::from(terrain.height(near))) / way;
            if slope > steepest {
                (steepest, down) = (slope, Sink::On(near));
            }
        }
    }
    down
}

impl Drains {
    /// Creates the drains of a tile, with all sinks unknown.
    pub fn new(terrain: &Terrain) -> Self {
        let side = terrain.side();
        let blocks = (side / BLOCK) * (side / BLOCK);
        Self {
            bits: side.trailing_zeros(),
            of_cell: vec![UNKNOWN; side * side],
            blocks: vec![DrainBlock::default(); blocks],
        }
    }

    /// Returns the index of a cell's block in `blocks`.
    fn block_of(&self, cell: usize) -> usize {
        let side = 1 << self.bits;
        let (x, y) = (cell % side, cell / side);
        (y / BLOCK) * (side / BLOCK) + x / BLOCK
    }

    /// Finds the sinks of all cells in those blocks of a tile that a rectangle touches.
    pub fn find(&mut self, terrain: &Terrain, (slot, key): (u32, TileKey), rect: CellRect) {
        let own = terrain.rect(key);
        let Some(part) = own.meets(rect) else { return };
        let blocks = |i: usize| {
            let at = |v: i32| (v - own.low[i]) as usize / BLOCK;
            at(part.low[i])..=at(part.high[i] - 1)
        };
        for (x, y) in blocks(1).flat_map(|y| blocks(0).map(move |x| (x, y))) {
            self.find_block(terrain, slot, [x, y]);
        }
    }

    /// Finds the sinks of all cells in block (x, y) of a tile.
    fn find_block(&mut self, terrain: &Terrain, slot: u32, [x, y]: [usize; 2]) {
        let side = 1 << self.bits;
        let first = y * BLOCK * side + x * BLOCK;
        let cells = (0..BLOCK * BLOCK).map(|i| first + (i / BLOCK) * side + i % BLOCK);
        let number = self.block_of(first);
        let mut sinks: Vec<Sink> = Vec::new();
        cells.clone().for_each(|cell| self.of_cell[cell] = UNKNOWN);
        let mut way = Vec::new();
        for cell in cells {
            way.clear();
            let mut at = cell;
            let found = loop {
                if self.of_cell[at] != UNKNOWN {
                    break self.of_cell[at];
                }
                way.push(at);
                let sink = below(terrain, terrain.joined(slot, at));
                if let Sink::On(next) = sink
                    && let (tile, next) = terrain.split(next)
                    && tile == slot as usize
                    && self.block_of(next) == number
                {
                    at = next;
                    continue;
                }
                let known = sinks.iter().position(|s| *s == sink);
                break known.unwrap_or_else(|| {
                    sinks.push(sink);
                    sinks.len() - 1
                }) as u16;
            };
            way.iter().for_each(|cell| self.of_cell[*cell] = found);
        }
        let inflow = vec![0.0; sinks.len()];
        self.blocks[number] = DrainBlock { sinks, inflow, gets: false };
    }

    /// Returns the sink of a cell.
    pub fn sink(&self, cell: usize) -> Sink {
        self.blocks[self.block_of(cell)].sinks[usize::from(self.of_cell[cell])]
    }

    /// Adds run-off of a cell in this step, mm, to its sink.
    pub fn add(&mut self, cell: usize, water: f64) {
        let block = self.block_of(cell);
        let block = &mut self.blocks[block];
        block.inflow[usize::from(self.of_cell[cell])] += water;
        block.gets = true;
    }
}
