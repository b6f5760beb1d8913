//! Wind field of a context, advanced in steps of time: its place, its obstacles, its inflow, and its start. A start is
//! the search for the steady field of the mean wind, from which the steps begin.

use std::sync::Arc;

use glam::{DMat3, DVec2, DVec3};

use super::{
    FlowBox, FlowField, FlowObstacles, FlowSettings, WindFieldDesc, WindFieldMode, WindFieldReport, WindWalls,
    moving::SolidBodies, turbulence::Whirls,
};
use crate::{
    error::Result,
    scene::WorldKind,
    surroundings::{Shelter, TerrainHeights},
    terrain::Terrain,
    weather::WindProfile,
    wind::{Blowing, Drift, WindVolume},
    world::World,
};

/// Length of a step with gusts ([`WindFieldMode::Running`]), s. Steps end at multiples of their length from time 0.
const RUNNING_STEP_S: f64 = 0.5;
/// Length of a step of the mean wind ([`WindFieldMode::Steady`]), s.
const STEADY_STEP_S: f64 = 2.0;
/// Largest number of cells that the fastest air passes in a part of a step.
const CFL: f64 = 4.0;
/// Largest number of parts of a step.
const MOST_PARTS: f64 = 64.0;
/// Limit of the ratio `a T / v` below which a steady field rests. a is the largest change of a velocity per time,
/// m/s^2, v the largest speed, m/s, and T the crossing time: the time in which air of speed v crosses the field, s.
const REST: f64 = 0.01;
/// Number of crossing times after which a steady field rests in any case.
const MOST_CROSSINGS: f64 = 6.0;
/// Change of the mean wind above which a resting field is stepped again, as a share of the mean wind's speed. A speed
/// below 1 m/s counts as 1 m/s.
const WAKES: f64 = 0.02;
/// Largest number of parts (single solver steps) of a start at each level after the first, coarsest one.
const FINER_PARTS: u32 = 6;
/// Longest duration of a start at the first, coarsest level, in crossing times.
const FIRST_CROSSINGS: f64 = 4.0;
/// Least number of cells along each axis of the coarsest grid of a start.
const FEWEST_CELLS: u32 = 8;
/// Distance of a place from the field's anchor, m, beyond which the anchor is renewed in a curved world.
const ANCHORED_M: f64 = 10_000.0;
/// Width of the zone at the sides and the top, in cells, over which the field fades into the weather's wind.
const RIM_CELLS: f32 = 4.0;
/// Longest mixing length of eddies over the ground, m.
const MIXING_M: f64 = 10.0;
/// Longest mixing length in a steady field, cells. With gusts it is one cell: the field itself shows longer eddies.
const STEADY_CELLS: f64 = 2.5;
/// Von Karman's constant.
const KAPPA: f64 = 0.4;
/// Largest wind that is solved for, m/s; stronger wind is clamped.
const MOST_WIND_M_S: f64 = 0.9 * super::MAX_SPEED_M_S;
/// Largest difference from the field's time at which its wind is used, s. A longer leap of time restarts the field.
pub(super) const LEAP_S: f64 = 60.0;

/// Origin and axes from which the cells of a field are counted.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Anchor {
    /// Origin in the host's world, m.
    pub origin: DVec3,
    /// Rotation from the host's axes to (east, north, up) at the origin.
    pub to_enu: DMat3,
    /// Altitude of the origin, m.
    pub altitude_m: f64,
}

impl Anchor {
    /// Creates the anchor of a field around a place. In a flat world every field counts from the world's origin.
    pub fn new(world: &World, center: DVec3) -> Self {
        let origin = if world.frame.kind == WorldKind::Flat { DVec3::ZERO } else { center };
        let local = world.frame.frame_at(origin);
        Self { origin, to_enu: local.world_to_enu, altitude_m: local.place.altitude_m }
    }

    /// Returns the lowest corner of a field, cells east, north and up of the origin.
    pub fn corner(&self, desc: &WindFieldDesc) -> [i64; 3] {
        let half = DVec3::new(f64::from(desc.cells[0]) / 2.0, f64::from(desc.cells[1]) / 2.0, 0.0);
        let cells = self.to_enu * (desc.floor_center - self.origin) / desc.cell_m - half;
        [cells.x.round() as i64, cells.y.round() as i64, cells.z.floor() as i64]
    }

    /// Whether the anchor must be renewed for a field around `center`.
    fn is_far(&self, world: &World, center: DVec3) -> bool {
        world.frame.kind != WorldKind::Flat && (center - self.origin).length() > ANCHORED_M
    }
}

/// Wind that flows into a field over the field's sides, and the profile of this wind with height.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Inflow {
    /// Wind at 10 m: mean, wander and gusts, and the displacement of the air by them.
    pub blowing: Blowing,
    /// Profile of the weather's mean wind with height.
    pub profile: WindProfile,
    /// Whether only the mean wind flows in, without gusts and eddies.
    pub is_steady: bool,
}

impl Inflow {
    pub fn new(world: &World, time_s: f64, mode: WindFieldMode) -> Self {
        let blowing = world.over().wind.at(time_s);
        let profile = world.timeline.at(time_s).wind;
        Self { blowing, profile, is_steady: mode == WindFieldMode::Steady }
    }

    /// Creates the inflow of the mean wind of a profile.
    fn of_mean(profile: WindProfile) -> Self {
        let mean_m_s = DVec2::new(profile.east_m_s, profile.north_m_s);
        let blowing = Blowing { drift: Drift::ZERO, mean_m_s, turned_m_s: DVec2::ZERO, gust_m_s: DVec2::ZERO };
        Self { blowing, profile, is_steady: true }
    }

    /// Returns the wind at a height above the ground, m/s (east, north, up).
    fn at(&self, height_m: f64) -> DVec3 {
        let wind = self.blowing.at_height(&self.profile, height_m);
        let v = if self.is_steady { wind.mean_m_s } else { wind.velocity_m_s };
        v.clamp_length_max(MOST_WIND_M_S)
    }

    /// Returns the eddies of the inflow: none for the mean wind of a steady field.
    fn whirls(&self, seed: u64, desc: &WindFieldDesc) -> Whirls {
        let speed = if self.is_steady { 0.0 } else { self.profile.friction_velocity_m_s() };
        Whirls::new(seed, desc, self.blowing.mean_m_s, speed)
    }

    /// Sets the mixing by the eddies that are too small for the field's cells.
    fn mix(&self, field: &mut FlowField, cell_m: DVec3, ground_m: impl Fn(DVec2) -> f64) {
        let cells = if self.is_steady { STEADY_CELLS } else { 1.0 };
        let speed = KAPPA * self.profile.friction_velocity_m_s();
        field.set_mixing(speed, MIXING_M.min(cells * cell_m.min_element()), ground_m);
    }
}

/// Ground and boxes around a field. Their positions are measured from the field's lowest corner, m (east, north, up).
struct Scenery<'a> {
    /// World with the host's terrain and boxes.
    world: &'a World,
    /// Anchor of the field.
    anchor: Anchor,
    /// Lowest corner of the field, cells from the anchor.
    corner: [i64; 3],
    /// Lowest corner of the field, m from the anchor (east, north, up).
    corner_m: DVec3,
    /// Size of the field, m.
    size_m: DVec3,
    /// Time of the scenery minus the world's present time, s. The positions of the host's boxes are those at the
    /// present time.
    since_s: f64,
    /// Heights of the host's terrain grid.
    terrain: Option<&'a Arc<TerrainHeights>>,
    /// Tiles of the host's terrain, used if there is no grid.
    tiles: Option<&'a Arc<Terrain>>,
    /// Vector from the terrain's origin to the field's corner, m (east, north, up).
    from_terrain: DVec3,
    /// Height of the ground where there is no terrain, m.
    level_m: f64,
}

impl<'a> Scenery<'a> {
    fn new(world: &'a World, live: &Live, time_s: f64) -> Self {
        let (anchor, corner_m) = (live.anchor, live.corner_m());
        let station_m = world.timeline.at(time_s).air.station_altitude_m;
        let (terrain, tiles) = (world.set.terrain.as_ref(), world.set.tiles.as_ref());
        let origin = terrain.map(|t| t.origin).or(tiles.map(|t| t.desc.origin));
        Self {
            world,
            anchor,
            corner: live.corner,
            corner_m,
            size_m: DVec3::from(live.desc.cells.map(f64::from)) * live.desc.cell_m,
            since_s: time_s - world.time_s,
            terrain,
            tiles,
            from_terrain: origin.map_or(DVec3::ZERO, |o| corner_m - anchor.to_enu * (o - anchor.origin)),
            level_m: station_m - anchor.altitude_m - corner_m.z,
        }
    }

    /// Returns the host's boxes that reach into the field.
    fn boxes(&self) -> impl Iterator<Item = FlowBox<'a>> {
        let to_enu = self.anchor.to_enu;
        let flow_box = move |s: &'a Shelter| FlowBox {
            center_m: to_enu * (s.center_m + s.velocity_m_s * self.since_s - self.anchor.origin) - self.corner_m,
            half_size_m: s.half_size_m,
            axes: to_enu * s.axes,
            velocity_m_s: if s.stands() {
                DVec3::ZERO
            } else {
                (to_enu * s.velocity_m_s).clamp_length_max(MOST_WIND_M_S)
            },
            planes: s.planes.as_slice(),
        };
        let is_in = |b: &FlowBox| {
            let reach = b.reach_m();
            (b.center_m + reach).cmpgt(DVec3::ZERO).all() && (b.center_m - reach).cmplt(self.size_m).all()
        };
        self.world.set.shelters.iter().map(flow_box).filter(is_in)
    }

    /// Returns the height of the ground at a place, m above the field's lowest corner.
    fn ground_m(&self, place: DVec2) -> f64 {
        let at = place + self.from_terrain.truncate();
        let height_m = match (self.terrain, self.tiles) {
            (Some(t), _) => Some(t.height_m(at)),
            (None, tiles) => tiles.and_then(|t| t.height_near(at)),
        };
        height_m.map_or(self.level_m, |height| height - self.from_terrain.z)
    }

    /// Returns two hashes, equal for equal scenery: of everything that stands still, and of everything that moves.
    fn hash(&self) -> [u64; 2] {
        let mut hash = [0xcbf2_9ce4_8422_2325_u64; 2];
        let mut add = |which: usize, bits: u64| {
            for byte in bits.to_le_bytes() {
                hash[which] = (hash[which] ^ u64::from(byte)).wrapping_mul(0x0000_0100_0000_01b3);
            }
        };
        self.corner.iter().for_each(|c| add(0, *c as u64));
        let low = self.from_terrain.truncate();
        let tiles = self.tiles.map(|t| t.hash_within(low, low + self.size_m.truncate()));
        match self.terrain.map(|t| t.hash).or(tiles) {
            Some(heights) => {
                add(0, heights);
                self.from_terrain.to_array().iter().for_each(|v| add(0, v.to_bits()));
                // In holes of the tiles the station's height is the ground.
                self.tiles.iter().for_each(|_| add(0, self.level_m.to_bits()));
            }
            None => add(0, self.level_m.to_bits()),
        }
        for b in self.boxes() {
            let which = usize::from(b.velocity_m_s != DVec3::ZERO);
            let parts = [b.center_m, b.half_size_m, b.axes.x_axis, b.axes.y_axis, b.velocity_m_s];
            parts.iter().flat_map(|v| v.to_array()).for_each(|v| add(which, v.to_bits()));
            b.planes.iter().flatten().for_each(|v| add(which, v.to_bits()));
        }
        hash
    }
}

/// Progress of a start, which finds the steady field of the mean wind at one time, on coarser grids first.
#[derive(Clone, Copy, Debug)]
pub(super) struct Start {
    /// Level of the present grid: the number of times that the cell size is doubled; 0 for the field's own grid.
    level: u32,
    /// Time left at this level, s.
    left_s: f64,
    /// Number of parts left at this level.
    left_parts: u32,
}

/// Field of a context, with the state of its steps.
pub(super) struct Live {
    /// Description of the field.
    pub desc: WindFieldDesc,
    /// Origin and axes from which the field's cells are counted.
    pub anchor: Anchor,
    /// Lowest corner, cells from the anchor.
    pub corner: [i64; 3],
    /// Velocity of the air, its obstacles and its solver.
    pub field: FlowField,
    /// Simulation time of the velocities, s.
    pub time_s: f64,
    /// Simulation time at which the field last started, s.
    pub begun_s: f64,
    /// Progress of the start; `None` once the field has started.
    pub start: Option<Start>,
    /// Number of parts of the step that are left, and the length of each, s.
    pub parts: (u32, f64),
    /// Hashes of the terrain and boxes in the field at its last step, as [`Scenery::hash`] returns them.
    pub stood: [u64; 2],
    /// Obstacles as last evaluated. The next step evaluates only those that have changed; with `None` it evaluates all.
    bodies: Option<SolidBodies>,
    /// Wind for which a steady field was solved: east and north components of the mean at 10 m, m/s, and roughness
    /// length, m.
    pub solved_for: [f64; 3],
    /// Time for which a steady field has not rested, s.
    pub awake_s: f64,
    /// Whether a steady field rests.
    pub rests: bool,
    /// Profile of the weather's mean wind at the last change of a steady field. [`Live::publish`] compares the field
    /// with it. While the field rests, the present wind may differ slightly from it.
    pub shown_over: Option<WindProfile>,
}

/// Returns the length of the steps of a mode, s.
pub(super) fn step_s(mode: WindFieldMode) -> f64 {
    match mode {
        WindFieldMode::Steady => STEADY_STEP_S,
        WindFieldMode::Running => RUNNING_STEP_S,
    }
}

/// Returns the settings of a field's grid whose cell size is doubled `level` times.
fn settings(desc: &WindFieldDesc, roughness_m: f64, level: u32) -> FlowSettings {
    FlowSettings {
        cells: desc.cells.map(|n| n >> level),
        cell_m: desc.cell_m * f64::from(1 << level),
        scheme: desc.scheme,
        pressure: desc.pressure,
        tolerance: 1e-3,
        roughness_m: if desc.walls == WindWalls::Rough { roughness_m } else { 0.0 },
        has_eddies: true,
        ..FlowSettings::default()
    }
}

impl Live {
    /// Creates a field at the beginning of its start, at a time that is a multiple of its step's length.
    pub fn new(world: &World, desc: WindFieldDesc, time_s: f64) -> Result<Self> {
        let anchor = Anchor::new(world, desc.floor_center);
        // The smallest possible field: the start replaces it.
        let none = FlowSettings { cells: [2, 2, 1], ..FlowSettings::default() };
        let field = FlowField::new(&none, &FlowObstacles::default(), |_| DVec3::ZERO)?;
        let corner = anchor.corner(&desc);
        let mut live = Self::standing_still(desc, anchor, corner, field, time_s);
        live.restart(world, time_s)?;
        Ok(live)
    }

    /// Creates a field that continues from saved numbers, which the caller has still to put into `field`.
    pub fn saved(world: &World, desc: WindFieldDesc, anchor: Anchor, corner: [i64; 3], time_s: f64) -> Result<Self> {
        let roughness_m = Inflow::new(world, time_s, desc.mode).profile.roughness_length_m;
        let settings = settings(&desc, roughness_m, 0);
        let field = FlowField::new(&settings, &FlowObstacles::default(), |_| DVec3::ZERO)?;
        Ok(Self::standing_still(desc, anchor, corner, field, time_s))
    }

    /// Creates a field without a step or a start in progress, and without known obstacles.
    fn standing_still(desc: WindFieldDesc, anchor: Anchor, corner: [i64; 3], field: FlowField, time_s: f64) -> Self {
        Self {
            desc,
            anchor,
            corner,
            field,
            time_s,
            begun_s: time_s,
            start: None,
            parts: (0, 0.0),
            stood: [0; 2],
            bodies: None,
            solved_for: [f64::INFINITY; 3],
            awake_s: 0.0,
            rests: false,
            shown_over: None,
        }
    }

    /// Begins a new start at a time: the steady field of the mean wind at that time replaces the present field.
    pub fn restart(&mut self, world: &World, time_s: f64) -> Result<()> {
        (self.time_s, self.begun_s) = (time_s, time_s);
        let mut level = 0;
        while self.desc.cells.iter().all(|n| n >> level >= 2 * FEWEST_CELLS && (n >> level).is_multiple_of(2)) {
            level += 1;
        }
        self.parts = (0, 0.0);
        self.start_at(world, level, false)
    }

    /// Starts at a level, from the result of the previous level if `goes_on` is set.
    fn start_at(&mut self, world: &World, level: u32, goes_on: bool) -> Result<()> {
        let inflow = Inflow::new(world, self.time_s, WindFieldMode::Steady);
        let scenery = Scenery::new(world, self, self.time_s);
        let ground = |p: DVec2| scenery.ground_m(p);
        // The steady field leaves out boxes that move.
        let boxes: Vec<FlowBox> = scenery.boxes().filter(|b| b.velocity_m_s == DVec3::ZERO).collect();
        let obstacles = FlowObstacles { terrain: Some(&ground), boxes: &boxes };
        let set = settings(&self.desc, inflow.profile.roughness_length_m, level);
        let mut field = FlowField::new(&set, &obstacles, |p| inflow.at(p.z - ground(p.truncate())))?;
        inflow.mix(&mut field, set.cell_m, ground);
        let (left_s, left_parts) = if goes_on {
            field.take_coarse(&self.field);
            (f64::INFINITY, FINER_PARTS)
        } else {
            (FIRST_CROSSINGS * self.crossing_s(field.fastest_m_s()), u32::MAX)
        };
        self.field = field;
        self.start = Some(Start { level, left_s, left_parts });
        Ok(())
    }

    /// Returns the time in which air of a speed crosses the field's longest side, s.
    fn crossing_s(&self, speed_m_s: f64) -> f64 {
        let size = DVec3::from(self.desc.cells.map(f64::from)) * self.desc.cell_m;
        size.max_element() / speed_m_s.max(0.05)
    }

    /// Continues the start by one part. Returns whether the start is complete.
    pub fn go_on_with_start(&mut self, world: &World) -> Result<bool> {
        let Some(mut start) = self.start.take() else { return Ok(true) };
        let speed = self.field.fastest_m_s();
        let is_calm = speed < 0.01;
        if !is_calm {
            let h = self.desc.cell_m.min_element() * f64::from(1 << start.level);
            let dt = (CFL * h / speed).min(start.left_s).min(1e3);
            self.field.step(dt)?;
            start.left_s -= dt;
            start.left_parts -= 1;
        }
        let rests = self.field.last_change_m_s2() * self.crossing_s(speed) <= REST * speed;
        if !(is_calm || rests || start.left_s <= 0.0 || start.left_parts == 0) {
            self.start = Some(start);
            return Ok(false);
        }
        if start.level > 0 {
            self.start_at(world, start.level - 1, true)?;
            return Ok(false);
        }
        (self.bodies, self.stood, self.rests, self.awake_s) = (None, [0; 2], false, 0.0);
        self.solved_for = [f64::INFINITY; 3];
        Ok(true)
    }

    /// Returns the field's lowest corner relative to its anchor, m.
    pub fn corner_m(&self) -> DVec3 {
        DVec3::from(self.corner.map(|c| c as f64)) * self.desc.cell_m
    }

    /// Returns the length of the field's steps, s.
    pub fn step_s(&self) -> f64 {
        step_s(self.desc.mode)
    }

    /// Returns the end of the next step, s.
    pub fn next_s(&self) -> f64 {
        ((self.time_s / self.step_s()).floor() + 1.0) * self.step_s()
    }

    /// Moves the field to the place that the host gives. Returns whether it must restart there.
    pub fn follow(&mut self, world: &World, desc: &WindFieldDesc) -> Result<bool> {
        if self.anchor.is_far(world, desc.floor_center) {
            self.anchor = Anchor::new(world, desc.floor_center);
            (self.desc, self.corner) = (*desc, self.anchor.corner(desc));
            return Ok(true);
        }
        let corner = self.anchor.corner(desc);
        self.desc = *desc;
        let by: [i64; 3] = std::array::from_fn(|a| corner[a].saturating_sub(self.corner[a]));
        if by == [0; 3] {
            return Ok(false);
        }
        self.corner = corner;
        if by.iter().zip(desc.cells).any(|(by, n)| by.unsigned_abs() * 2 >= u64::from(n)) {
            return Ok(true);
        }
        let inflow = Inflow::new(world, self.time_s, desc.mode);
        let scenery = Scenery::new(world, self, self.time_s);
        self.field.shift(by, |p| inflow.at(p.z - scenery.ground_m(p.truncate())))?;
        self.bodies = None;
        Ok(false)
    }

    /// Prepares the field for its next step. Returns `false` if the field rests: the step is then already over.
    pub fn begin_step(&mut self, world: &World) -> Result<bool> {
        let end_s = self.next_s();
        let inflow = Inflow::new(world, end_s, self.desc.mode);
        let scenery = Scenery::new(world, self, end_s);
        let stands = scenery.hash();
        let is_steady = self.desc.mode == WindFieldMode::Steady;
        if is_steady {
            self.wake(&inflow, stands);
            if self.rests {
                self.time_s = end_s;
                return Ok(false);
            }
        }
        let ground = |p: DVec2| scenery.ground_m(p);
        if stands != self.stood || self.bodies.is_none() {
            let boxes: Vec<FlowBox> = scenery.boxes().collect();
            let moving: Vec<FlowBox> = boxes.iter().filter(|b| b.velocity_m_s != DVec3::ZERO).copied().collect();
            let before = self.bodies.take().filter(|_| stands[0] == self.stood[0]);
            let obstacles = FlowObstacles { terrain: Some(&ground), boxes: &boxes };
            self.bodies = Some(self.field.follow_obstacles(&obstacles, &moving, before)?);
            self.stood = stands;
        }
        if self.desc.walls == WindWalls::Rough {
            self.field.set_roughness(inflow.profile.roughness_length_m)?;
        }
        inflow.mix(&mut self.field, self.desc.cell_m, ground);
        let whirls = inflow.whirls(world.seed, &self.desc);
        let (from, top_m) = (self.corner_m() - inflow.blowing.drift.displacement_m.extend(0.0), scenery.size_m.z);
        self.field.set_wind(|p| {
            let height_m = p.z - ground(p.truncate());
            let whirling = if p.z < top_m { whirls.at(from + p, height_m) } else { DVec3::ZERO };
            (inflow.at(height_m) + whirling).clamp_length_max(MOST_WIND_M_S)
        })?;
        self.field.fill_ghosts();
        let seconds = end_s - self.time_s;
        let passed = self.field.fastest_m_s().max(inflow.at(1e3).length()) * seconds / self.desc.cell_m.min_element();
        let parts = (passed / CFL).ceil().clamp(1.0, MOST_PARTS);
        self.parts = (parts as u32, seconds / parts);
        Ok(true)
    }

    /// Advances the field by one part of the present step. Returns whether the step is complete.
    pub fn step_part(&mut self) -> Result<bool> {
        self.field.step(self.parts.1)?;
        self.parts.0 -= 1;
        if self.parts.0 > 0 {
            return Ok(false);
        }
        let end_s = self.next_s();
        let seconds = end_s - self.time_s;
        self.time_s = end_s;
        if self.desc.mode == WindFieldMode::Steady {
            self.awake_s += seconds;
            let speed = self.field.fastest_m_s();
            let crossing_s = self.crossing_s(speed);
            let is_still = self.field.last_change_m_s2() * crossing_s <= REST * speed;
            self.rests = speed < 0.01 || is_still || self.awake_s > MOST_CROSSINGS * crossing_s;
        }
        Ok(true)
    }

    /// Wakes a steady field whose wind or obstacles have changed.
    fn wake(&mut self, inflow: &Inflow, stands: [u64; 2]) {
        let mean = inflow.blowing.mean_m_s;
        let [east, north, roughness_m] = self.solved_for;
        let off = (mean - DVec2::new(east, north)).length();
        let enough = WAKES * mean.length().max(1.0);
        if off <= enough && roughness_m == inflow.profile.roughness_length_m && stands == self.stood {
            return;
        }
        self.solved_for = [mean.x, mean.y, inflow.profile.roughness_length_m];
        (self.awake_s, self.rests) = (0.0, false);
    }

    /// Whether time has leapt so far that the field must restart: present - end of the field's next step > [`LEAP_S`].
    /// The end of the next step lies after the time of the last update. Updates that are at most [`LEAP_S`] apart
    /// therefore never restart the field.
    pub fn is_left_behind(&self, present_s: f64) -> bool {
        present_s - self.next_s() > LEAP_S
    }

    /// Returns the first and last time for which the field's wind is used, s.
    pub fn holds_s(&self) -> [f64; 2] {
        [self.time_s - LEAP_S, self.time_s + LEAP_S]
    }

    /// Returns the profile of the weather's wind at the field's time, to be kept as `shown_over` when a step has
    /// changed the field; `None` for a field with gusts.
    pub fn wind_over(&self, world: &World) -> Option<WindProfile> {
        (self.desc.mode == WindFieldMode::Steady).then(|| world.timeline.at(self.time_s).wind)
    }

    /// Fills the volume that queries and shaders read. Each node gets an own velocity and a share, and the wind there
    /// is own + (1 - share) x the weather's wind.
    pub fn publish(&self, world: &World, volume: &mut WindVolume) {
        let is_steady = self.desc.mode == WindFieldMode::Steady;
        let inflow = Inflow::of_mean(self.shown_over.unwrap_or_else(|| world.timeline.at(self.time_s).wind));
        let scenery = Scenery::new(world, self, self.time_s);
        let cells = self.desc.cells;
        volume.origin = self.anchor.origin + self.anchor.to_enu.transpose() * self.corner_m();
        (volume.to_enu, volume.cell_m) = (self.anchor.to_enu, self.desc.cell_m);
        volume.nodes = cells.map(|n| n + 1);
        volume.holds_s = Some(self.holds_s());
        volume.values.clear();
        // 0 at a side, 1 at the inner edge of the zone in which the field fades.
        let rim = |cells: f32| {
            let x = (cells / RIM_CELLS).clamp(0.0, 1.0);
            x * x * (3.0 - 2.0 * x)
        };
        let h = self.desc.cell_m;
        self.field.each_corner(|[i, j, k], v| {
            let [east, north] =
                [(i, cells[0]), (j, cells[1])].map(|(i, n)| rim((i as f32).min((n as usize - i) as f32)));
            let share = east * north * rim((cells[2] as usize - k) as f32);
            if !is_steady || share == 0.0 {
                let v = v * share;
                volume.values.push([v.x, v.y, v.z, share]);
                return;
            }
            // Gusts of the weather are weakened as the mean wind is: by `kept` = speed in the field / speed outside.
            let place = DVec3::new(i as f64, j as f64, k as f64) * h;
            let outer = inflow.at(place.z - scenery.ground_m(place.truncate())).as_vec3();
            let kept = (v.length() / outer.length().max(0.1)).min(1.0);
            let own = (v - outer * kept) * share;
            volume.values.push([own.x, own.y, own.z, share * (1.0 - kept)]);
        });
        volume.changed();
    }

    /// Returns the state of the field.
    pub fn report(&self) -> WindFieldReport {
        WindFieldReport {
            time_s: self.time_s,
            begun_s: self.begun_s,
            step_s: self.step_s(),
            rests: self.rests,
            corner: self.anchor.origin + self.anchor.to_enu.transpose() * self.corner_m(),
            cell_m: self.desc.cell_m,
            cells: self.desc.cells,
            fastest_m_s: self.field.fastest_m_s(),
            bytes: self.desc.bytes(),
        }
    }
}
