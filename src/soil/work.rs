//! Work of tools on the ground: an edge cuts or presses what it passes, buckets fill, blades push, and full buckets
//! spill.

use std::collections::VecDeque;

use glam::{DVec2, DVec3};

use super::{
    field::{SoilCell, SoilField},
    kind::MAX_SOIL_KINDS,
    laws::{SinkageSet, WheelLoad},
    material::{DEPTH_UNITS, SoilMaterials, SoilParcel, depth_units},
    patch::{Pressed, UndugGround},
    ribbon::{CellShare, each_share},
    tool::{SoilToolPose, SoilToolShape},
};

/// Passed share of a cell above which the whole cell counts as passed.
const PASSED: f64 = 0.999_999;
/// Distance from the edge, in cells, beyond which a tool forgets what it has passed.
const MEMORY_CELLS: f64 = 3.0;
/// Distance in front of the edge at which pushed soil lands, cells: the four cells around that point lie in front of
/// the edge.
const AHEAD_CELLS: f64 = 1.5;
/// Height, as a share of a cell's side, by which the ground ahead must rise above an edge that counts as in the ground.
const IN_GROUND_CELLS: f64 = 0.1;
/// Deepest pit below the undug surface, m.
const DEEPEST_M: f64 = 100.0;
/// Volume of compacted soil as a share of bank: 0.88 to 0.92 for sand.
const COMPACTED: f64 = 0.9;

/// Cell that an edge has passed in part during the present pass.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct PassedCell {
    pub place: [i32; 2],
    /// Share of the cell's area that the edge has passed.
    pub share: f64,
    /// Height of the passed part times its share, in units.
    pub raised: f64,
}

/// Work of a tool in a step.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct ToolWork {
    /// Volume that was cut, before it swelled, m^3.
    pub cut_m3: f64,
    /// Area that the edge passed in the ground, m^2.
    pub area_m2: f64,
    /// Kind of most of the cut soil.
    pub kind: usize,
    /// Deepest sinkage of a wheel or track, m.
    pub sinkage_m: f64,
    /// Whether a sinkage was limited, or comes from a set that fits only a small range.
    pub is_clamped: bool,
    /// Whether frozen ground stopped the edge.
    pub is_frozen: bool,
}

/// Tool at work: its pose, what it holds, and what it has passed.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct SoilTool {
    pub id: u32,
    pub shape: SoilToolShape,
    /// Pose up to which the ground was worked.
    pub pose: SoilToolPose,
    /// Later poses, up to which the ground is still to be worked.
    pub poses: VecDeque<SoilToolPose>,
    /// Whether the host has sent the last pose.
    pub is_ended: bool,
    pub content: SoilParcel,
    /// Saturation of the soil in the tool: the mean by mass of the soil that came in.
    pub saturation: f64,
    /// Cells of the present pass, in the order of their places.
    pub passed: Vec<PassedCell>,
    pub work: ToolWork,
}

/// Field of soil and undug ground on which a tool works.
pub(super) struct WorkedGround<'a> {
    pub field: &'a mut SoilField,
    pub ground: &'a dyn UndugGround,
}

impl WorkedGround<'_> {
    fn cell_m(&self) -> f64 {
        self.field.materials.cell_m
    }

    /// Point in cells east and north, and in units of depth upwards. Cells reach half a cell to each side of their
    /// places.
    fn in_cells(&self, point: DVec3) -> DVec3 {
        let cell_m = self.cell_m();
        DVec3::new(point.x / cell_m + 0.5, point.y / cell_m + 0.5, point.z * DEPTH_UNITS)
    }

    /// Height of the surface of a cell, in units; `None` without ground.
    fn surface(&self, place: [i32; 2]) -> Option<f64> {
        match self.field.find(place) {
            Some(SoilCell { slot, cell }) => Some(self.field.patch(slot).surface[cell]),
            None => self.ground.height_m(place).map(|height_m| height_m * DEPTH_UNITS),
        }
    }

    /// Puts soil onto the four cells around `point`, which is in cells; nearer cells get a larger share. Returns what
    /// no cell could take: all of the parcel, or nothing.
    fn scatter(&mut self, parcel: SoilParcel, point: DVec2) -> SoilParcel {
        let corner = point - 0.5;
        let low = corner.floor();
        let off = corner - low;
        let mut cells: [Option<SoilCell>; 4] = [None; 4];
        let mut weights = [0.0; 4];
        for (i, [x, y]) in [[0, 0], [1, 0], [0, 1], [1, 1]].into_iter().enumerate() {
            let weight = [1.0 - off.x, off.x][x] * [1.0 - off.y, off.y][y];
            let place = [low.x as i32 + x as i32, low.y as i32 + y as i32];
            cells[i] = if weight > 0.0 { self.field.find_or_add(place, self.ground) } else { None };
            weights[i] = if cells[i].is_some() { weight } else { 0.0 };
        }
        let (mut rest, mut whole) = (parcel, weights.iter().sum::<f64>());
        for (cell, weight) in cells.into_iter().zip(weights) {
            let Some(cell) = cell else { continue };
            let depth = (rest.depth as f64 * (weight / whole)) as i64;
            whole -= weight;
            // The last cell takes what is left.
            let part = if whole > 1e-12 { rest.take(depth) } else { std::mem::take(&mut rest) };
            self.field.put(cell, &part);
        }
        rest
    }
}

impl SoilTool {
    /// Volume of a unit of depth of the content, m^3.
    fn unit_m3(materials: &SoilMaterials) -> f64 {
        materials.area_m2() / DEPTH_UNITS
    }

    /// Bulk volume of the content, m^3.
    pub fn bulk_m3(&self, materials: &SoilMaterials) -> f64 {
        self.content.depth as f64 * Self::unit_m3(materials)
    }

    /// Adds soil of this saturation to what the tool holds.
    pub fn hold(&mut self, parcel: &SoilParcel, saturation: f64) {
        let [held, more] = [&self.content, parcel].map(|part| part.mass() as f64);
        if more > 0.0 {
            self.saturation = (self.saturation * held + saturation * more) / (held + more);
        }
        self.content.add(parcel);
    }

    /// Index of the passed cell with this place. A missing cell is added.
    fn passed_at(&mut self, place: [i32; 2]) -> usize {
        let key = |place: [i32; 2]| [place[1], place[0]];
        let found = self.passed.binary_search_by_key(&key(place), |passed| key(passed.place));
        found.unwrap_or_else(|index| {
            self.passed.insert(index, PassedCell { place, share: 0.0, raised: 0.0 });
            index
        })
    }

    /// Forgets cells that were passed as a whole or lie more than [`MEMORY_CELLS`] from the edge.
    fn forget(&mut self, edge: [DVec3; 2]) {
        let low = edge[0].min(edge[1]).truncate() - MEMORY_CELLS;
        let high = edge[0].max(edge[1]).truncate() + MEMORY_CELLS;
        let is_near = |place: [i32; 2]| {
            let centre = DVec2::new(f64::from(place[0]), f64::from(place[1])) + 0.5;
            centre.cmpge(low).all() && centre.cmple(high).all()
        };
        self.passed.retain(|passed| passed.share < PASSED && is_near(passed.place));
    }

    /// Works the ground from the present pose to another, in parts of at most a cell.
    pub fn work_to(&mut self, end: &SoilToolPose, place: &mut WorkedGround<'_>) {
        let start = self.pose;
        let ways = [0, 1].map(|i| (end.edge[i] - start.edge[i]).truncate().length());
        let parts = (ways[0].max(ways[1]) / place.cell_m()).ceil().clamp(1.0, 1e5) as u32;
        for part in 1..=parts {
            let t = f64::from(part) / f64::from(parts);
            let time_s = start.time_s + (end.time_s - start.time_s) * t;
            let next = if part == parts { *end } else { start.toward(end, time_s) };
            let edges = [self.pose.edge, next.edge].map(|edge| edge.map(|point| place.in_cells(point)));
            match self.shape {
                SoilToolShape::Bucket { .. } | SoilToolShape::Blade => self.cut(edges, &next, place),
                SoilToolShape::Wheel { .. } | SoilToolShape::Track { .. } => self.press(edges, &next, place),
                SoilToolShape::Bed { .. } => {}
            }
            self.pose = next;
            self.forget(edges[1]);
        }
    }

    /// Cuts what the edge passes. While a bucket moves to the side to which it opens, the cut soil goes into it up to
    /// its rated volume. All other cut soil is pushed ahead.
    fn cut(&mut self, edges: [[DVec3; 2]; 2], next: &SoilToolPose, place: &mut WorkedGround<'_>) {
        let [start, end] = edges;
        let motion = (0.5 * (end[0] + end[1] - start[0] - start[1])).truncate();
        let is_loading = next.ahead().dot(motion) > 0.0;
        let room_m3 = self.shape.hold().filter(|_| is_loading).map_or(0.0, |hold| next.rated_m3(hold));
        let capacity = (room_m3 / Self::unit_m3(&place.field.materials)) as i64;
        let ahead = motion.normalize_or_zero() * AHEAD_CELLS;
        let across = (end[1] - end[0]).truncate();
        let mut parts = [0.0; MAX_SOIL_KINDS];
        each_share(start, end, |part| {
            let Some((cell, depth)) = self.cut_depth(&part, place) else { return };
            let mut parcel = place.field.dig(cell, depth);
            self.work.cut_m3 += depth as f64 * Self::unit_m3(&place.field.materials);
            self.work.area_m2 += part.share * place.field.materials.area_m2();
            parts.iter_mut().zip(parcel.masses).for_each(|(sum, mass)| *sum += mass as f64);
            let taken = parcel.take((capacity - self.content.depth).max(0));
            self.hold(&taken, place.field.patch(cell.slot).water.saturation);
            if parcel != SoilParcel::default() {
                let along = (part.centre - end[0].truncate()).dot(across) / across.length_squared().max(1e-12);
                let rest = place.scatter(parcel, end[0].truncate() + across * along.clamp(0.0, 1.0) + ahead);
                // Without ground ahead, the soil stays where it was.
                place.field.put(cell, &rest);
            }
        });
        let most = (0..MAX_SOIL_KINDS).reduce(|a, b| if parts[b] > parts[a] { b } else { a });
        if let Some(kind) = most.filter(|kind| parts[*kind] > 0.0) {
            self.work.kind = kind;
        }
    }

    /// Returns the cell, and the depth, in units over the whole cell, that an edge takes from the part of the cell that
    /// it passes.
    fn cut_depth(&mut self, part: &CellShare, place: &mut WorkedGround<'_>) -> Option<(SoilCell, i64)> {
        let index = self.passed_at(part.place);
        let top = place.surface(part.place)?;
        let passed = &mut self.passed[index];
        // Height of the part that the edge has not passed yet, from the mean height of the cell.
        let left = 1.0 - passed.share;
        let open = if left > 1.0 - PASSED { (top - passed.raised) / left } else { top };
        let share = part.share.min(left.max(0.0));
        passed.share += share;
        passed.raised += share * open.min(part.height);
        let depth = (share * (open - part.height)).round() as i64;
        let cell = if depth > 0 { place.field.find_or_add(part.place, place.ground) } else { None };
        let SoilCell { slot, cell } = cell?;
        let patch = place.field.patch(slot);
        let is_frozen = patch.cut[cell] < place.field.frozen;
        self.work.is_frozen |= is_frozen && depth > patch.loose[cell];
        let deepest = if is_frozen { 0 } else { depth_units(DEEPEST_M) };
        let most = patch.loose[cell] + (deepest - patch.cut[cell] - patch.press(cell).packed).max(0);
        Some((SoilCell { slot, cell }, depth.min(most)))
    }

    /// Sinkage in soil with this set, m, and whether the sinkage was limited or the set fits only a small range.
    fn sinkage_m(&self, set: &SinkageSet, pose: &SoilToolPose) -> (f64, bool) {
        let width_m = (pose.edge[1] - pose.edge[0]).length();
        let (sinkage_m, most_m) = match self.shape {
            SoilToolShape::Wheel { diameter_m } => {
                let wheel = WheelLoad { load_n: pose.load_n, width_m, diameter_m };
                (set.wheel_m(&wheel), 0.25 * diameter_m)
            }
            SoilToolShape::Track { contact_m } => {
                let pressure_kpa = 1e-3 * pose.load_n / (width_m * contact_m);
                (set.plate_m(width_m.min(contact_m), pressure_kpa), 0.5 * width_m.min(contact_m))
            }
            _ => (0.0, 0.0),
        };
        (sinkage_m.min(most_m), sinkage_m > most_m || (set.is_narrow() && sinkage_m > 0.0))
    }

    /// Presses what the line of contact passes, by the sinkage of each cell's soil.
    fn press(&mut self, [start, end]: [[DVec3; 2]; 2], next: &SoilToolPose, place: &mut WorkedGround<'_>) {
        if next.load_n <= 0.0 {
            return;
        }
        let mut known = [None; MAX_SOIL_KINDS];
        each_share(start, end, |part| {
            let index = self.passed_at(part.place);
            let Some(cell) = place.field.find_or_add(part.place, place.ground) else { return };
            let materials = &place.field.materials;
            let kind = top_kind(place.field, cell);
            let Some(set) = materials.kinds[kind].kind.sinkage else { return };
            let (sinkage_m, is_clamped) = *known[kind].get_or_insert_with(|| self.sinkage_m(&set, next));
            let passed = &mut self.passed[index];
            passed.share = (passed.share + part.share).min(1.0);
            let depth = (passed.share.min(1.0) * sinkage_m * DEPTH_UNITS).round() as i64;
            self.work.sinkage_m = self.work.sinkage_m.max(sinkage_m);
            self.work.is_clamped |= is_clamped;
            place.field.change(cell, |patch, cell, materials| {
                let press = patch.press(cell);
                let down = depth - press.reached;
                if down > 0 {
                    let loose = squeeze(patch.loose[cell], down, patch.loose_masses(cell), materials);
                    patch.loose[cell] -= loose;
                    let sunk = press.sunk + down - loose;
                    let packed = press.packed.max((sunk as f64 / (1.0 - COMPACTED)).ceil() as i64);
                    patch.set_press(cell, Pressed { packed, sunk, reached: depth });
                    patch.refresh(cell, materials);
                }
            });
        });
    }

    /// Closes the edges between cells that the cutting edge crosses: the tool's face holds the soil in front of it.
    pub fn bar(&self, field: &mut SoilField) {
        if !self.shape.cuts() {
            return;
        }
        let cell_m = field.materials.cell_m;
        // Moves the barrier to half a cell behind the edge, so that a cell counts as in front until the edge has passed
        // all of it.
        let ahead = self.pose.ahead();
        let behind = ahead * (0.5 * (ahead.x.abs() + ahead.y.abs()));
        let ends = self.pose.edge.map(|point| point.truncate() / cell_m - behind);
        let heights = |along: f64| {
            [self.pose.edge, self.pose.upper].map(|edge| (edge[0].z + (edge[1].z - edge[0].z) * along) * DEPTH_UNITS)
        };
        // Each line of cell centres, from south to north or from west to east, crosses the edge once.
        for (axis, side) in [(0, 1), (1, 0)] {
            let other = 1 - axis;
            let (low, high) = (ends[0][axis].min(ends[1][axis]), ends[0][axis].max(ends[1][axis]));
            for line in low.ceil() as i32..=high.floor() as i32 {
                let along = (f64::from(line) - ends[0][axis]) / (ends[1][axis] - ends[0][axis]);
                if !along.is_finite() {
                    continue;
                }
                let mut place = [line; 2];
                place[other] = (ends[0][other] + (ends[1][other] - ends[0][other]) * along).floor() as i32;
                if let Some(cell) = field.find(place) {
                    field.close(cell, side, heights(along));
                }
            }
        }
    }

    /// Whether the ground in front of the opening is higher than the cutting edge, by more than [`IN_GROUND_CELLS`] on
    /// average.
    fn is_in_ground(&self, place: &WorkedGround<'_>) -> bool {
        let pose = &self.pose;
        let ahead = pose.ahead() * AHEAD_CELLS;
        let sum: f64 = [0.25, 0.5, 0.75]
            .map(|along| {
                let point = place.in_cells(pose.edge[0] + (pose.edge[1] - pose.edge[0]) * along);
                let cell = point.truncate() + ahead;
                place.surface([cell.x.floor() as i32, cell.y.floor() as i32]).map_or(0.0, |top| top - point.z)
            })
            .iter()
            .sum();
        sum > 3.0 * IN_GROUND_CELLS * place.cell_m() * DEPTH_UNITS
    }

    /// Takes out and returns the soil that the tool cannot hold at its tilt.
    pub fn spilled(&mut self, place: &WorkedGround<'_>) -> SoilParcel {
        let materials = &place.field.materials;
        let Some(hold) = self.shape.hold().filter(|_| self.content != SoilParcel::default()) else {
            return SoilParcel::default();
        };
        // In the ground, the soil in front holds what is in the bucket.
        let is_in_ground = self.shape.cuts() && self.is_in_ground(place);
        let grade =
            materials.mixed_grade(self.content.masses.iter().copied().enumerate().filter(|(_, mass)| *mass > 0));
        let grade = grade / (materials.cell_m * DEPTH_UNITS);
        let held_m3 = if is_in_ground { self.pose.rated_m3(hold) } else { self.pose.held_m3(&self.shape, grade) };
        let held = (held_m3 / Self::unit_m3(materials)) as i64;
        let excess = self.content.depth - held;
        if excess > 0 { self.content.take(excess) } else { SoilParcel::default() }
    }
}

/// Kind on the surface of a cell: that of most of the loose soil, or of the bank.
fn top_kind(field: &SoilField, SoilCell { slot, cell }: SoilCell) -> usize {
    let patch = field.patch(slot);
    let most = patch.loose_masses(cell).reduce(|a, b| if b.1 > a.1 { b } else { a });
    most.map_or_else(|| field.materials.bank_kind(patch.cut[cell]), |(kind, _)| kind)
}

/// Depth by which loose soil gives way to a press, in units: at most down to its compacted volume.
fn squeeze(loose: i64, pressed: i64, masses: impl Iterator<Item = (usize, i64)>, materials: &SoilMaterials) -> i64 {
    let compacted: f64 = masses
        .map(|(kind, mass)| {
            let material = &materials.kinds[kind];
            mass as f64 * material.loose_depth * COMPACTED / (1.0 + material.kind.swell)
        })
        .sum();
    pressed.min((loose - compacted.ceil() as i64).max(0))
}

/// Pours soil from the opening of a tool: into another tool below, or onto the ground. Returns what nothing below could
/// take.
pub(super) fn pour(
    parcel: SoilParcel,
    source: &SoilTool,
    catchers: &mut [SoilTool],
    place: &mut WorkedGround<'_>,
) -> SoilParcel {
    let edge = source.pose.pouring_edge();
    let points = (2.0 * (edge[1] - edge[0]).length() / place.cell_m()).ceil().clamp(1.0, 4096.0) as i64;
    let (mut rest, mut kept) = (parcel, SoilParcel::default());
    for i in 0..points {
        let part = rest.take(rest.depth / (points - i));
        let part = if i + 1 == points { with(part, std::mem::take(&mut rest)) } else { part };
        let point = edge[0] + (edge[1] - edge[0]) * ((i as f64 + 0.5) / points as f64);
        let catcher = catchers.iter_mut().find(|tool| tool.shape.hold().is_some() && tool.pose.is_under(point));
        match catcher {
            Some(tool) => tool.hold(&part, source.saturation),
            None => {
                let point = place.in_cells(point).truncate();
                kept.add(&place.scatter(part, point));
            }
        }
    }
    kept
}

fn with(mut parcel: SoilParcel, other: SoilParcel) -> SoilParcel {
    parcel.add(&other);
    parcel
}
