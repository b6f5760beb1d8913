//! Reference of the cells on the CPU: a twin of `shaders/glass/{cells,decide,gather,declare,settle}.wgsl` that gives
//! the same bits for glass without occluder maps. Its functions have the same names; the comments of the shaders
//! describe them.

use glam::DVec2;

use super::{
    geometry::Plane,
    laws,
    reach::NODES,
    step::{StepUniform, VOLUME_UNIT_M3, pcg},
};

/// Largest number of counted hits of a cell.
const MOST_HITS: u32 = 4095;
/// Value of the film where a bead has run or a blade has wiped.
const FULL_FILM: u32 = 65_535;
/// Film above which a bead glides as if it ran.
const WET_FILM: u32 = 2048;
/// Flag of a move: a blade has wiped the bead.
const WIPED: u32 = 16;
/// Flag of a move: the bead has run.
const RAN: u32 = 32;
/// Number of steps in which a cell collects the water of its declared state.
const LIFE_STEPS: u32 = 2048;

/// Cell, as four words. The first is the volume, units of [`VOLUME_UNIT_M3`]. The second is the place of the bead in
/// the cell, x + 65536 y, each in 1/65536 of the edge. The third is the speed (0 at rest) + 65536 x shape (seed of the
/// outline). The fourth is hits since the last clearing + 4096 x clearings (modulo 16) + 65536 x film.
pub type Cell = [u32; 4];

/// Lattice of cells.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Cells {
    /// Columns and rows.
    pub size: [u32; 2],
    /// Cells, row by row from the lower left.
    pub cells: Vec<Cell>,
}

/// Returns a random word for a cell and a key.
fn cell_hash(cell: [i32; 2], key: u32) -> u32 {
    pcg((cell[0] as u32).wrapping_add(pcg((cell[1] as u32).wrapping_add(key))))
}

/// Returns the position of the highest set bit; 0 for 0 and 1.
fn octave(v: u32) -> u32 {
    31 - (v | 1).leading_zeros()
}

/// Returns the row of `beads` for a volume.
fn bead(step: &StepUniform, volume: u32) -> [i32; 4] {
    let k = octave(volume);
    step.beads[(4 * k + (((volume << 2) >> k) & 3)).min(95) as usize]
}

/// Returns the volume of a random drop, units.
fn drop_volume(step: &StepUniform, random: u32) -> u32 {
    let k = 31 - octave(random | 1);
    let part = 15 - ((random >> (27 - k.min(27))) & 15);
    let i = if k > 15 { 255 } else { 16 * k + part } as usize;
    step.drops[i / 4][i % 4]
}

/// Unpacks x + 65536 y.
fn place(packed: u32) -> [i32; 2] {
    [(packed & 0xffff) as i32, (packed >> 16) as i32]
}

/// Returns the cross product a.x b.y - a.y b.x.
fn perp_dot(a: [i32; 2], b: [i32; 2]) -> i32 {
    a[0] * b[1] - a[1] * b[0]
}

/// Returns whether a blade passes over a point during the step, or lies on the point at the beginning or the end.
/// `point` is in 1/16 cell.
fn swept(step: &StepUniform, point: [i32; 2]) -> bool {
    step.arms.chunks(3).any(|arm| {
        let [reach, before, now] = [arm[0], arm[1], arm[2]];
        let d = [point[0] - reach[0], point[1] - reach[1]];
        if now[3] == 0 || d[0].abs() > reach[3] || d[1].abs() > reach[3] {
            return false;
        }
        let far = d[0] * d[0] + d[1] * d[1];
        if far < reach[2] * reach[2] || far > reach[3] * reach[3] {
            return false;
        }
        let ahead = d[0] * before[2] + d[1] * before[3] > 0;
        let (from, to) = ([before[0], before[1]], [now[0], now[1]]);
        let between = perp_dot(from, d) >= 0 && perp_dot(d, to) >= 0;
        let beside = perp_dot(to, d).abs().min(perp_dot(from, d).abs()) <= now[2] * 4096;
        ahead && (between || beside)
    })
}

/// Returns the share of the rain that reaches a node, in 1/128.
fn node(step: &StepUniform, index: [u32; 2]) -> u32 {
    let i = index[1] * NODES[0] as u32 + index[0];
    (step.reach[i as usize / 16][(i as usize / 4) % 4] >> (8 * (i % 4))) & 255
}

/// Returns the share of the rain that reaches a cell, in 1/65536, interpolated between the nodes around it.
fn reached(step: &StepUniform, cell: [i32; 2]) -> u32 {
    let at: [u32; 2] =
        std::array::from_fn(|k| (cell[k] as u32 * 2 + 1) * (NODES[k] as u32 - 1) * 128 / step.key[2 + k]);
    let ([x, y], part) = (at.map(|v| v >> 8), at.map(|v| v & 255));
    let below = node(step, [x, y]) * (256 - part[0]) + node(step, [x + 1, y]) * part[0];
    let above = node(step, [x, y + 1]) * (256 - part[0]) + node(step, [x + 1, y + 1]) * part[0];
    (below * (256 - part[1]) + above * part[1]) >> 7
}

/// Returns number x share / 65536.
fn part_of(number: u32, share: u32) -> u32 {
    if share > 65_535 { number } else { (number >> 16) * share + (((number & 0xffff) * share) >> 16) }
}

impl Cells {
    /// Creates dry glass.
    pub fn dry(size: [u32; 2]) -> Self {
        Self { size, cells: vec![[0; 4]; (size[0] * size[1]) as usize] }
    }

    /// Creates the declared state of a step.
    #[doc(hidden)]
    pub fn declared(step: &StepUniform) -> Self {
        let size = [step.key[2], step.key[3]];
        let cells = (0..size[0] * size[1]).map(|i| declare(step, [(i % size[0]) as i32, (i / size[0]) as i32]));
        Self { size, cells: cells.collect() }
    }

    /// Returns the water on the glass, units of volume.
    pub fn water(&self) -> u64 {
        self.cells.iter().map(|c| u64::from(c[0])).sum()
    }

    /// Returns the share of a pane under beads, and the water on it, m^3.
    pub fn covered(&self, plane: &Plane, cell_m: f64) -> (f64, f64) {
        let inside = |p: DVec2| {
            let c = &plane.corners;
            (0..4).all(|i| (c[(i + 1) % 4] - c[i]).perp_dot(p - c[i]) >= 0.0)
        };
        let (mut area, mut water) = (0.0, 0.0);
        for (i, cell) in self.cells.iter().enumerate().filter(|(_, c)| c[0] > 0) {
            let (x, y) = (i as u32 % self.size[0], i as u32 / self.size[0]);
            let at = |n: u32, part: u32| (f64::from(n) + f64::from(part) / 65_536.0) * cell_m;
            if inside(DVec2::new(at(x, cell[1] & 0xffff), at(y, cell[1] >> 16))) {
                let volume = f64::from(cell[0]) * VOLUME_UNIT_M3;
                water += volume;
                area += std::f64::consts::PI * laws::radius_m(volume).powi(2);
            }
        }
        // Takes beads as overlapping at random: the covered share is 1 - exp(-sum of areas / area of the pane).
        (1.0 - libm::exp(-area / plane.area_m2()), water)
    }

    /// Returns the state of a cell; `None` outside the lattice.
    fn at(&self, cell: [i32; 2]) -> Option<Cell> {
        let [w, h] = self.size.map(|v| v as i32);
        let inside = (0..w).contains(&cell[0]) && (0..h).contains(&cell[1]);
        inside.then(|| self.cells[(cell[1] * w + cell[0]) as usize])
    }

    /// Returns cells computed by `f` for each cell, (column, row).
    fn each(&self, f: impl Fn([i32; 2]) -> Cell) -> Self {
        let columns = self.size[0] as usize;
        let cells = (0..self.cells.len()).map(|i| f([(i % columns) as i32, (i / columns) as i32]));
        Self { size: self.size, cells: cells.collect() }
    }

    /// Returns the state a step later, without snow.
    #[doc(hidden)]
    pub fn stepped(&self, step: &StepUniform) -> Self {
        self.stepped_under(step, None)
    }

    /// Returns the state a step later, with the snow that lay on the glass before the step.
    #[doc(hidden)]
    pub fn stepped_under(&self, step: &StepUniform, snow: Option<&Snow>) -> Self {
        let moves = self.each(|cell| self.decide(step, cell));
        self.each(|cell| self.gather(step, (&moves, snow), cell))
    }

    /// Returns the move of a cell's bead.
    fn decide(&self, step: &StepUniform, cell: [i32; 2]) -> Cell {
        let here = self.at(cell).unwrap_or_default();
        let sixteenths = cell.map(|v| v * 16);
        let flags = if swept(step, sixteenths.map(|v| v + 8)) { WIPED } else { 0 };
        let at = place(here[1]);
        if here[0] == 0 || swept(step, [sixteenths[0] + (at[0] >> 12), sixteenths[1] + (at[1] >> 12)]) {
            return [0, 0, 0, flags];
        }
        let law = bead(step, here[0]);
        let (mut taker, mut to) = (here, [0, 0]);
        for (y, x) in (-1..=1).flat_map(|y| (-1..=1).map(move |x| (y, x))) {
            if x == 0 && y == 0 {
                continue;
            }
            let Some(other) = self.at([cell[0] + x, cell[1] + y]) else { continue };
            let after = y > 0 || (y == 0 && x > 0);
            let larger = other[0] > taker[0] || (other[0] == here[0] && taker[0] == here[0] && after);
            let there = place(other[1]);
            let offset = [x * 256 + (there[0] >> 8) - (at[0] >> 8), y * 256 + (there[1] >> 8) - (at[1] >> 8)];
            if larger && takes(step, other, offset, law[0] & 1023) {
                (taker, to) = (other, [x, y]);
            }
        }
        if to != [0, 0] {
            return [here[0], taker[1], here[2] & 0xffff_0000, flags | ((to[1] + 1) * 3 + to[0] + 1) as u32];
        }
        self.run(step, cell, here, law, flags)
    }

    /// Returns the film of a cell; 0 outside the lattice.
    fn film_at(&self, cell: [i32; 2]) -> i32 {
        self.at(cell).map_or(0, |c| (c[3] >> 16) as i32)
    }

    /// Returns the sideways share of a running bead's motion, in 1/256. The glass is uneven, and wet glass attracts the
    /// bead.
    fn steer(&self, step: &StepUniform, cell: [i32; 2], motion: [i32; 2]) -> i32 {
        let size = motion.map(i32::abs);
        let along = |i: usize| if 2 * size[i] > size[1 - i] { motion[i].signum() } else { 0 };
        let ahead = [along(0), along(1)];
        let left = [-ahead[1], ahead[0]];
        let uneven = (cell_hash(cell, step.key[1]) & 255) as i32 - 128;
        let side = |s: i32| self.film_at([cell[0] + ahead[0] + s * left[0], cell[1] + ahead[1] + s * left[1]]);
        (uneven >> 1) + ((side(1) - side(-1)) >> 9).clamp(-64, 64)
    }

    /// Returns the move of a bead that no other bead takes in.
    fn run(&self, step: &StepUniform, cell: [i32; 2], here: Cell, law: [i32; 4], flags: u32) -> Cell {
        let pinned = 180 + ((cell_hash(cell, step.key[1]) >> 8) % 154) as i32;
        let glides = here[2] & 0xffff != 0 || here[3] >> 16 > WET_FILM || law[3] > pinned;
        let motion = [law[1], law[2]];
        if !glides || motion == [0, 0] {
            return [here[0], here[1], here[2] & 0xffff_0000, flags | 4];
        }
        let aside = self.steer(step, cell, motion);
        let way = [motion[0] + ((-motion[1] * aside) >> 8), motion[1] + ((motion[0] * aside) >> 8)];
        let held = way.map(|v| v.clamp(-65_000, 65_000));
        let at = place(here[1]);
        let reached = [at[0] + held[0], at[1] + held[1]];
        let to = reached.map(|v| v >> 16);
        let random = cell_hash(cell, step.key[0]);
        let leaves = to != [0, 0] && random & 15 < 10;
        let left = if leaves { here[0] >> (5 + ((random >> 4) & 3)) } else { 0 };
        let speed = ((held[0].abs() + held[1].abs()) >> 1).max(1) as u32;
        let where_to = ((to[1] + 1) * 3 + to[0] + 1) as u32;
        let there = (reached[0] & 0xffff) as u32 | (((reached[1] & 0xffff) as u32) << 16);
        [here[0] - left, there, (here[2] & 0xffff_0000) | speed, flags | RAN | where_to | (left << 8)]
    }

    /// Returns the state of a cell after the step, from the moves of all beads.
    fn gather(&self, step: &StepUniform, (moves, snow): (&Self, Option<&Snow>), cell: [i32; 2]) -> Cell {
        let before = self.at(cell).unwrap_or_default();
        let own = moves.at(cell).unwrap_or_default();
        let mut ran = own[3] & RAN != 0;
        let mut c = Joined::default();
        if own[3] >> 8 > 0 {
            c.join(own[3] >> 8, before[1], pcg(before[2]) & 0xffff_0000);
        }
        for (y, x) in (-1..=1).flat_map(|y| (-1..=1).map(move |x| (y, x))) {
            let Some(m) = moves.at([cell[0] + x, cell[1] + y]) else { continue };
            if m[0] > 0 && m[3] & 15 == ((1 - y) * 3 + 1 - x) as u32 {
                c.join(m[0], m[1], m[2]);
                ran = ran || m[3] & RAN != 0;
            }
        }
        c.dry(step, cell);
        if let Some(snow) = snow.filter(|_| step.snow[2] > 0 && own[3] & WIPED == 0) {
            let melt = melted(step, cell, snow.at(cell));
            if melt > 0 {
                let at = cell_hash(cell, step.key[1].wrapping_add(13));
                c.join(melt, at, at << 16);
            }
        }
        let state = cleared(step, cell, before[3], ran, own[3] & WIPED != 0);
        let mut random = cell_hash(cell, step.key[0].wrapping_add(3));
        let share = reached(step, cell);
        let one = part_of(step.arrive[0], share);
        let two = part_of(part_of(step.arrive[1], share), share);
        let three = part_of(part_of(part_of(step.arrive[2], share), share), share);
        let count = [one, two, three].iter().filter(|chance| random < **chance).count() as u32;
        for _ in 0..count {
            random = pcg(random.wrapping_add(1));
            let at = pcg(random.wrapping_add(2));
            c.join(drop_volume(step, random), at, at << 16);
        }
        let hits = ((state & MOST_HITS) + count).min(MOST_HITS);
        [c.volume.min(step.limits[0]), c.place, c.motion, (state & 0xffff_f000) | hits]
    }
}

/// Snow on glass, in units of its water for each cell, row by row from the lower left.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Snow {
    /// Columns and rows.
    pub size: [u32; 2],
    /// Snow of each cell.
    pub cells: Vec<u32>,
}

impl Snow {
    /// Creates the snow of all cells from that of each, units of water.
    fn of(step: &StepUniform, one: impl Fn([i32; 2]) -> u32) -> Self {
        let size = [step.key[2], step.key[3]];
        let cells = (0..size[0] * size[1]).map(|i| one([(i % size[0]) as i32, (i / size[0]) as i32]));
        Self { size, cells: cells.collect() }
    }

    /// Returns the snow on a cell, units of water.
    fn at(&self, cell: [i32; 2]) -> u32 {
        self.cells[(cell[1] * self.size[0] as i32 + cell[0]) as usize]
    }

    /// Creates the declared state of a step.
    #[doc(hidden)]
    pub fn declared(step: &StepUniform) -> Self {
        let [_, flake, melt, most] = step.snow;
        Self::of(step, |cell| {
            let random = cell_hash(cell, step.key[1].wrapping_add(11));
            let age = step.declared[2].wrapping_add(random & (LIFE_STEPS - 1)) % LIFE_STEPS;
            let flakes =
                ((part_of(step.snow[0], reached(step, cell)) >> 12) * age).wrapping_add(pcg(random) >> 12) >> 20;
            let there = flakes.wrapping_mul(flake).min(most);
            there - there.min(((melt >> 4).min(1_048_575) * age) >> 8)
        })
    }

    /// Returns the state a step later.
    #[doc(hidden)]
    pub fn settled(&self, step: &StepUniform) -> Self {
        Self::of(step, |cell| {
            if swept(step, cell.map(|v| v * 16 + 8)) {
                return 0;
            }
            let before = self.at(cell);
            let lands = cell_hash(cell, step.key[0].wrapping_add(5)) < part_of(step.snow[0], reached(step, cell));
            (before - melted(step, cell, before) + if lands { step.snow[1] } else { 0 }).min(step.snow[3])
        })
    }

    /// Returns the water in the snow, m^3.
    pub fn water_m3(&self) -> f64 {
        self.cells.iter().map(|c| f64::from(*c)).sum::<f64>() * VOLUME_UNIT_M3
    }
}

/// Returns the amount of a cell's snow `there` that melts in a step, units.
fn melted(step: &StepUniform, cell: [i32; 2], there: u32) -> u32 {
    let random = cell_hash(cell, step.key[0].wrapping_add(4)) & 4095;
    there.min((step.snow[2] >> 12) + u32::from(random < step.snow[2] & 4095))
}

/// Cell while its parts are joined: volume and largest part, units; place and motion of the largest part.
#[derive(Default)]
struct Joined {
    volume: u32,
    largest: u32,
    place: u32,
    motion: u32,
}

impl Joined {
    /// Adds water. The largest part keeps its place, speed and shape.
    fn join(&mut self, volume: u32, place: u32, motion: u32) {
        self.volume += volume;
        if volume > self.largest {
            (self.largest, self.place, self.motion) = (volume, place, motion);
        }
    }

    /// Takes away the water that evaporates in a step.
    fn dry(&mut self, step: &StepUniform, cell: [i32; 2]) {
        if self.volume > 0 {
            let loss = bead(step, self.volume)[0] as u32 >> 10;
            let random = cell_hash(cell, step.key[0].wrapping_add(1)) & 4095;
            let taken = (loss >> 12) + u32::from(random < loss & 4095);
            self.volume -= self.volume.min(taken);
            self.largest = self.volume;
        }
    }
}

/// Returns whether the bead `larger`, `offset` away, takes in the bead of `radius` (both in 1/256 cell): the two touch,
/// and `larger` does not run away.
fn takes(step: &StepUniform, larger: Cell, offset: [i32; 2], radius: i32) -> bool {
    let other = bead(step, larger[0]);
    let reach = ((radius + (other[0] & 1023)) * 3) >> 2;
    if offset[0] * offset[0] + offset[1] * offset[1] > reach * reach {
        return false;
    }
    larger[2] & 0xffff == 0 || offset[0] * (other[1] >> 4) + offset[1] * (other[2] >> 4) <= 0
}

/// Returns hits, clearings and film, packed, after running and wiping, and after evaporation.
fn cleared(step: &StepUniform, cell: [i32; 2], state: u32, ran: bool, wiped: bool) -> u32 {
    let (mut hits, mut clearings, mut film) = (state & MOST_HITS, (state >> 12) & 15, state >> 16);
    film -= film.min((film >> 4) + 64);
    if hits > 0 && cell_hash(cell, step.key[0].wrapping_add(2)) >> 16 < step.arrive[3] {
        hits -= 1;
    }
    if ran || wiped {
        clearings = (clearings + u32::from(hits > 0)) & 15;
        (hits, film) = (0, FULL_FILM);
    }
    hits | (clearings << 12) | (film << 16)
}

/// Returns the declared state of a cell.
fn declare(step: &StepUniform, cell: [i32; 2]) -> Cell {
    let random = cell_hash(cell, step.key[1].wrapping_add(7));
    let now = step.declared[2].wrapping_add(random & (LIFE_STEPS - 1));
    let age = now % LIFE_STEPS;
    let life = pcg(random.wrapping_add(now / LIFE_STEPS));
    let chance = life & 255;
    let share = (chance * chance) >> 6;
    let gets = reached(step, cell);
    let water = (part_of(step.declared[0], gets).wrapping_mul(age) >> 8).min(1_048_576);
    let rests = step.declared[3].wrapping_mul(64 + ((life >> 8) & 127)) >> 8;
    let volume = (water.wrapping_mul(share) >> 8).min(rests);
    let hits = (part_of(step.declared[1], gets).wrapping_mul(age) >> 16).min(MOST_HITS);
    [volume, pcg(life.wrapping_add(1)), life << 16, hits | (((now / LIFE_STEPS) & 15) << 12)]
}
