//! Site: ground that is dug, tools that dig it, and the steps in which both are advanced.

use std::collections::VecDeque;

use glam::DVec3;

use super::{
    field::{SoilCell, SoilField},
    kind::{MAX_SOIL_KINDS, SoilKind, SoilKindId, SoilSettings, check_kind},
    material::{DEPTH_UNITS, MASS_UNITS, SoilMaterials, SoilParcel, depth_units},
    patch::UndugGround,
    shown::ShownSoil,
    tool::{MAX_SOIL_TOOLS, SoilToolId, SoilToolPose, SoilToolShape},
    walls::break_walls,
    work::{SoilTool, ToolWork, WorkedGround, pour},
};
use crate::error::{Error, Result, Status, check_range};

/// Length of a step, s: exact in binary, so that steps end at whole multiples of it.
pub const SOIL_STEP_S: f64 = 1.0 / 64.0;
/// Sweeps of sliding soil in a step.
const SWEEPS: usize = 8;
/// Steps between two checks of the walls.
const WALL_STEPS: i64 = 8;
/// Steps without a change after which a site is quiet.
const QUIET_STEPS: u32 = 2 * WALL_STEPS as u32;
/// Deepest loose soil that a host can bring, m.
const DEEPEST_LOOSE_M: f64 = 1000.0;
/// Largest number of poses of a tool that wait for their steps.
const MOST_POSES: usize = 65_536;

/// Settings of a site.
#[derive(Clone, Debug, PartialEq)]
pub struct SoilSiteDesc {
    /// Distance between neighbouring cells, m, \[0.01, 4\]. Default 0.1.
    pub cell_m: f64,
    /// Kinds and layers of the ground.
    pub settings: SoilSettings,
}

impl Default for SoilSiteDesc {
    fn default() -> Self {
        Self { cell_m: 0.1, settings: SoilSettings::default() }
    }
}

/// Balance of mass of a site in whole micrograms. [`SoilBooks::is_balanced`] holds after every call.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct SoilBooks {
    /// Bank that was loosened.
    pub dug: i128,
    /// Soil that the host brought.
    pub brought: i128,
    /// Loose soil on the ground.
    pub lying: i128,
    /// Soil in buckets and beds.
    pub held: i128,
    /// Soil that left the site in tools that still held it when they ended.
    pub taken: i128,
}

impl SoilBooks {
    /// Whether no mass was gained or lost.
    pub fn is_balanced(&self) -> bool {
        self.dug + self.brought == self.lying + self.held + self.taken
    }
}

/// Ground at a place.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SoilPoint {
    /// Height of the nearest cell's surface above the lattice's origin, m.
    pub surface_m: f64,
    /// Difference to the undug height, m; negative in a pit.
    pub change_m: f64,
    /// Depth of loose soil, m.
    pub loose_m: f64,
    /// Density of the loose soil, kg/m^3; 0 without any.
    pub loose_kg_m3: f64,
    /// Kind on the surface: that of most of the loose soil, or that of the bank without loose soil.
    pub kind: SoilKindId,
    /// Revision of the site (in a context: of the terrain) at the last change near this place; 0 where nothing was dug.
    pub revision: u64,
    /// Colour of the soil that shows, linear Rec. 709 albedo.
    pub albedo: [f64; 3],
    /// Share of the cell that this soil covers, 0 to 1; the undug surface shows in the rest.
    pub covered: f64,
}

/// Content of a tool, and what it met in the last step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SoilToolReport {
    /// Simulation time that the report is for, s.
    pub time_s: f64,
    /// Mass held, kg.
    pub mass_kg: f64,
    /// Bulk volume held, m^3.
    pub bulk_m3: f64,
    /// Filled share of the rated volume, which includes the heap.
    pub fill: f64,
    /// Centre of what is held, m from the lattice's origin.
    pub centre: DVec3,
    /// Mass of each kind held, kg, by the kind's number.
    pub kinds_kg: [f64; MAX_SOIL_KINDS],
    /// Mean depth of the cut in the last step, m.
    pub cut_depth_m: f64,
    /// Kind of most of the soil that was cut in the last step.
    pub cut_kind: SoilKindId,
    /// Deepest sinkage of a wheel or track in the last step, m.
    pub sinkage_m: f64,
    /// Whether the sinkage was limited to half the radius (or half the shorter side of a track's contact), or comes
    /// from a set that fits a small range only.
    pub is_sinkage_beyond_range: bool,
    /// Whether the edge met frozen bank in the last step. The edge cannot cut frozen bank, and takes only the loose
    /// soil above the bank.
    pub is_stopped_by_frost: bool,
    /// Saturation of the soil in the tool: the share of its pores that water fills, as the mean of the bank from which
    /// the soil came; 0 when empty.
    pub saturation: f64,
}

/// Ground that is dug.
#[derive(Clone, Debug)]
pub struct SoilSite {
    pub(super) desc: SoilSiteDesc,
    pub(super) field: SoilField,
    pub(super) tools: Vec<SoilTool>,
    pub(super) next_id: u32,
    /// Number of steps since time 0.
    pub(super) steps: i64,
    /// Steps since the last change.
    pub(super) idle: u32,
    pub(super) taken: i128,
    pub(super) brought: i128,
    /// Freezing index, K s: the sum of the degrees below 0 over time, from which degrees above 0 are subtracted; at
    /// least 0.
    pub(super) freezing_k_s: f64,
}

impl SoilSite {
    /// Creates undug ground at time 0.
    ///
    /// # Errors
    /// [`Status::InvalidArgument`] naming the field of `desc`.
    pub fn new(desc: SoilSiteDesc) -> Result<Self> {
        check_range("cell_m", desc.cell_m, 0.01, 4.0, "m")?;
        let kinds = desc.settings.checked_kinds()?;
        let mut materials = SoilMaterials::new(desc.cell_m, &kinds, desc.settings.horizons.clone());
        materials.saturation = desc.settings.saturation;
        let field = SoilField::new(materials);
        let (tools, next_id) = (Vec::new(), 1);
        Ok(Self { desc, field, tools, next_id, steps: 0, idle: 0, taken: 0, brought: 0, freezing_k_s: 0.0 })
    }

    /// Returns the settings.
    pub fn desc(&self) -> &SoilSiteDesc {
        &self.desc
    }

    /// Sets the time of ground that no tool has worked yet to the last whole step at or before `time_s`.
    pub(super) fn begin_at(&mut self, time_s: f64) {
        self.steps = steps_until(time_s);
    }

    /// Adapts the site to changes of the undug ground.
    pub(super) fn follow_ground(&mut self, ground: &dyn UndugGround) {
        if self.field.set_ground(ground) {
            self.field.revision += 1;
            self.idle = 0;
        }
    }

    /// Returns a kind of soil; `None` for an unknown number.
    pub fn kind(&self, kind: SoilKindId) -> Option<&SoilKind> {
        self.field.materials.kinds.get(kind.index()).map(|material| &material.kind)
    }

    /// Returns the simulation time of the ground, s.
    pub fn time_s(&self) -> f64 {
        self.steps as f64 * SOIL_STEP_S
    }

    /// Returns the revision, which grows whenever the ground changes.
    pub fn revision(&self) -> u64 {
        self.field.revision
    }

    /// Adds a tool at its first pose, whose time must not lie before that of the ground.
    ///
    /// # Errors
    /// [`Status::InvalidArgument`] naming the field, also for more than [`MAX_SOIL_TOOLS`] tools;
    /// [`Status::WrongOrder`] for a time before that of the ground.
    pub fn add_tool(&mut self, shape: SoilToolShape, pose: &SoilToolPose) -> Result<SoilToolId> {
        shape.validate()?;
        pose.validate(&shape)?;
        if self.tools.len() >= MAX_SOIL_TOOLS {
            return Err(Error::range("tools.len", &format!("at most {MAX_SOIL_TOOLS}"), self.tools.len() + 1));
        }
        if pose.time_s < self.time_s() {
            let rest = format!("must be at least {} s, the time of the ground, got {}", self.time_s(), pose.time_s);
            return Err(Error::about(Status::WrongOrder, "pose.time_s", rest));
        }
        let id = self.next_id;
        self.next_id += 1;
        self.tools.push(SoilTool {
            id,
            shape,
            pose: known_pose(&shape, pose),
            poses: VecDeque::new(),
            is_ended: false,
            content: SoilParcel::default(),
            saturation: 0.0,
            passed: Vec::new(),
            work: ToolWork::default(),
        });
        self.idle = 0;
        Ok(SoilToolId(id))
    }

    /// Adds the next pose of a tool. The tool moves evenly between its poses, so the ground depends on the poses alone
    /// and not on the calls of [`SoilSite::advance`] between them.
    ///
    /// # Errors
    /// [`Status::InvalidArgument`] naming the field; [`Status::WrongOrder`] for a time that is not after the last pose.
    pub fn move_tool(&mut self, tool: SoilToolId, pose: &SoilToolPose) -> Result<()> {
        self.move_standing_tool(tool, pose, f64::NEG_INFINITY)
    }

    /// Adds the next pose as [`SoilSite::move_tool`] does, for a tool that stands at its last pose until
    /// `stands_until_s`, s.
    pub(crate) fn move_standing_tool(
        &mut self,
        tool: SoilToolId,
        pose: &SoilToolPose,
        stands_until_s: f64,
    ) -> Result<()> {
        let tool = self.live_tool(tool)?;
        pose.validate(&tool.shape)?;
        let pose = known_pose(&tool.shape, pose);
        let last = tool.poses.back().unwrap_or(&tool.pose);
        let last = SoilToolPose { time_s: last.time_s.max(stands_until_s), ..*last };
        pose.validate_after(&last)?;
        if tool.poses.len() >= MOST_POSES {
            return Err(Error::range("poses.len", &format!("at most {MOST_POSES} that wait"), tool.poses.len() + 1));
        }
        if tool.poses.is_empty() {
            tool.pose = last;
        }
        tool.poses.push_back(pose);
        self.idle = 0;
        Ok(())
    }

    /// Ends a tool at its last pose. The soil that it still holds then leaves the site with it.
    ///
    /// # Errors
    /// [`Status::InvalidArgument`] for an unknown tool; [`Status::WrongOrder`] for one that has ended.
    pub fn end_tool(&mut self, tool: SoilToolId) -> Result<()> {
        self.live_tool(tool)?.is_ended = true;
        self.idle = 0;
        Ok(())
    }

    fn live_tool(&mut self, id: SoilToolId) -> Result<&mut SoilTool> {
        let tool = self.tools.iter_mut().find(|tool| tool.id == id.0);
        let tool = tool.ok_or_else(|| Error::range("tool", "a tool of this site", id.0))?;
        if tool.is_ended {
            return Err(Error::about(Status::WrongOrder, "tool", format!("must not have ended, got {}", id.0)));
        }
        Ok(tool)
    }

    /// Drops loose soil that the host brings onto a place, at once. Returns whether there is ground to take it.
    ///
    /// # Errors
    /// [`Status::InvalidArgument`] naming the parameter. Accepted are a place within 1e7 m of the origin, a known kind,
    /// and a mass in \[0, 1e6\] kg with which the loose soil is at most 1000 m deep.
    pub fn bring(&mut self, place: DVec3, kind: SoilKindId, mass_kg: f64, ground: &dyn UndugGround) -> Result<bool> {
        check_place("place", place)?;
        check_kind("kind", kind, self.field.materials.kinds.len())?;
        check_range("mass_kg", mass_kg, 0.0, 1e6, "kg")?;
        let parcel = self.field.materials.loose(kind.index(), (mass_kg * MASS_UNITS).round() as i64);
        let Some(cell) = self.field.find_or_add(self.nearest(place), ground) else { return Ok(false) };
        if self.field.patch(cell.slot).loose[cell.cell] + parcel.depth > depth_units(DEEPEST_LOOSE_M) {
            let accepted = format!("such that loose soil is at most {DEEPEST_LOOSE_M} m deep");
            return Err(Error::range("mass_kg", &accepted, mass_kg));
        }
        self.field.put(cell, &parcel);
        self.brought += parcel.mass();
        self.field.revision += 1;
        self.idle = 0;
        Ok(true)
    }

    fn nearest(&self, place: DVec3) -> [i32; 2] {
        [place.x, place.y].map(|v| (v / self.desc.cell_m).round() as i32)
    }

    /// Advances the ground by whole steps, up to `until_s` and not beyond the last pose of any tool that has not ended:
    /// a tool that stands still needs poses too. Returns the time that was reached, s.
    ///
    /// # Errors
    /// [`Status::InvalidArgument`] for a time outside \[-1e10, 1e10\] s.
    pub fn advance(&mut self, until_s: f64, ground: &dyn UndugGround) -> Result<f64> {
        check_range("until_s", until_s, -1e10, 1e10, "s")?;
        let last_s = |tool: &SoilTool| tool.poses.back().unwrap_or(&tool.pose).time_s;
        let posed_s = self.tools.iter().filter(|tool| !tool.is_ended).map(last_s).fold(until_s, f64::min);
        let due = steps_until(posed_s);
        while self.steps < due {
            self.run(due, ground);
        }
        Ok(self.time_s())
    }

    /// Runs one step. A quiet site skips to the step `due` at once. A tool without a later pose stands still.
    pub(super) fn run(&mut self, due: i64, ground: &dyn UndugGround) {
        if self.is_quiet() {
            self.steps = due;
        } else {
            self.step(ground);
        }
    }

    /// Whether nothing changes until the host or the weather changes something.
    pub fn is_quiet(&self) -> bool {
        self.idle >= QUIET_STEPS && self.tools.iter().all(|tool| tool.poses.is_empty())
    }

    fn step(&mut self, ground: &dyn UndugGround) {
        self.steps += 1;
        let (end_s, revision) = (self.time_s(), self.field.revision);
        let mut works = false;
        for index in 0..self.tools.len() {
            works |= self.step_tool(index, end_s, ground);
        }
        for tool in
            self.tools.extract_if(.., |tool| tool.is_ended && tool.poses.is_empty() && tool.pose.time_s <= end_s)
        {
            self.taken += tool.content.mass();
            works = true;
        }
        self.field.clear_barriers(works);
        self.bar();
        let was_at_rest = self.field.is_at_rest();
        let is_at_rest = self.field.settle(SWEEPS, ground);
        if self.steps % WALL_STEPS == 0 {
            break_walls(&mut self.field, ground);
        }
        if is_at_rest && self.field.is_at_rest() {
            self.field.rest();
        }
        let changes = works || !was_at_rest || !self.field.is_at_rest();
        self.field.revision = revision + u64::from(changes);
        self.idle = if changes { 0 } else { self.idle.saturating_add(1) };
    }

    /// Lets the faces of the tools at work hold the soil in front of them.
    pub(super) fn bar(&mut self) {
        let time_s = self.time_s();
        for tool in self.tools.iter().filter(|tool| tool.pose.time_s <= time_s) {
            tool.bar(&mut self.field);
        }
    }

    /// Lets a tool work until the end of a step. Returns whether it moved or spilled.
    fn step_tool(&mut self, index: usize, end_s: f64, ground: &dyn UndugGround) -> bool {
        if self.tools[index].pose.time_s >= end_s {
            return false;
        }
        // The other tools stay where they are: what is poured may land in them.
        let mut tool = self.tools.remove(index);
        let mut place = WorkedGround { field: &mut self.field, ground };
        tool.work = ToolWork::default();
        let moves = !tool.poses.is_empty();
        while let Some(next) = tool.poses.front().copied() {
            if next.time_s > end_s {
                let part = tool.pose.toward(&next, end_s);
                tool.work_to(&part, &mut place);
                break;
            }
            tool.work_to(&next, &mut place);
            tool.poses.pop_front();
        }
        let spilled = tool.spilled(&place);
        let spills = spilled != SoilParcel::default();
        if spills {
            let kept = pour(spilled, &tool, &mut self.tools, &mut place);
            tool.content.add(&kept);
        }
        self.tools.insert(index, tool);
        moves || spills
    }

    /// Returns the balance of mass.
    pub fn books(&self) -> SoilBooks {
        SoilBooks {
            dug: self.field.dug(),
            brought: self.brought,
            lying: self.field.lying(),
            held: self.tools.iter().map(|tool| tool.content.mass()).sum(),
            taken: self.taken,
        }
    }

    /// Returns the ground at a place; `None` where there is none.
    ///
    /// # Errors
    /// [`Status::InvalidArgument`] for a place that is not finite or farther than 1e7 m.
    pub fn point(&self, place: DVec3, ground: &dyn UndugGround) -> Result<Option<SoilPoint>> {
        check_place("place", place)?;
        Ok(self.cell(self.nearest(place), ground))
    }

    /// Returns the ground of a cell of the lattice; `None` where there is none.
    pub(super) fn cell(&self, nearest: [i32; 2], ground: &dyn UndugGround) -> Option<SoilPoint> {
        let undug_m = ground.height_m(nearest)?;
        let materials = &self.field.materials;
        let Some(SoilCell { slot, cell }) = self.field.find(nearest) else {
            let kind = SoilKindId(materials.bank_kind(0) as u8);
            return Some(SoilPoint {
                surface_m: undug_m,
                change_m: 0.0,
                loose_m: 0.0,
                loose_kg_m3: 0.0,
                kind,
                revision: 0,
                albedo: materials.kinds[kind.index()].kind.albedo,
                covered: 0.0,
            });
        };
        let patch = self.field.patch(slot);
        let (surface_m, loose_m) = (patch.surface[cell] / DEPTH_UNITS, patch.loose[cell] as f64 / DEPTH_UNITS);
        let mass: i64 = patch.loose_masses(cell).map(|(_, mass)| mass).sum();
        let most = patch.loose_masses(cell).reduce(|a, b| if b.1 > a.1 { b } else { a });
        let kind = most.map_or_else(|| materials.bank_kind(patch.cut[cell]), |(kind, _)| kind);
        let loose_kg_m3 = if loose_m > 0.0 { mass as f64 / MASS_UNITS / (loose_m * materials.area_m2()) } else { 0.0 };
        let change_m = surface_m - undug_m;
        let (revision, kind) = (patch.revision, SoilKindId(kind as u8));
        let ShownSoil { albedo, share: covered } = ShownSoil::of(patch, cell, materials);
        Some(SoilPoint { surface_m, change_m, loose_m, loose_kg_m3, kind, revision, albedo, covered })
    }

    /// Returns the pose up to which a tool has worked.
    pub(super) fn tool_pose(&self, tool: SoilToolId) -> Option<&SoilToolPose> {
        self.tools.iter().find(|live| live.id == tool.0).map(|live| &live.pose)
    }

    /// Returns what a tool holds and meets.
    ///
    /// # Errors
    /// [`Status::InvalidArgument`] for an unknown tool.
    pub fn report(&self, tool: SoilToolId) -> Result<SoilToolReport> {
        let found = self.tools.iter().find(|live| live.id == tool.0);
        let tool = found.ok_or_else(|| Error::range("tool", "a tool of this site", tool.0))?;
        let materials = &self.field.materials;
        let bulk_m3 = tool.bulk_m3(materials);
        let rated_m3 = tool.shape.hold().map_or(0.0, |hold| tool.pose.rated_m3(hold));
        let [across, between] = tool.pose.sides_m();
        let depth_m = tool.shape.hold().map_or(0.0, |[struck_m3, _]| struck_m3 / (across * between));
        let fill = if rated_m3 > 0.0 { bulk_m3 / rated_m3 } else { 0.0 };
        let inward = -tool.pose.facing.normalize_or_zero();
        let work = tool.work;
        let cut_depth_m = if work.area_m2 > 0.0 { work.cut_m3 / work.area_m2 } else { 0.0 };
        Ok(SoilToolReport {
            time_s: tool.pose.time_s.min(self.time_s()),
            mass_kg: tool.content.mass() as f64 / MASS_UNITS,
            bulk_m3,
            fill,
            centre: tool.pose.middle() + inward * (depth_m * (1.0 - 0.5 * fill.min(1.0))),
            kinds_kg: tool.content.masses.map(|mass| mass as f64 / MASS_UNITS),
            cut_depth_m,
            cut_kind: SoilKindId(work.kind as u8),
            sinkage_m: work.sinkage_m,
            is_sinkage_beyond_range: work.is_clamped,
            is_stopped_by_frost: work.is_frozen,
            saturation: if bulk_m3 > 0.0 { tool.saturation } else { 0.0 },
        })
    }
}

/// Returns the number of whole steps from time 0 until a time.
pub(super) fn steps_until(time_s: f64) -> i64 {
    (time_s / SOIL_STEP_S).floor() as i64
}

/// Pose without the values that a tool of this shape does not use.
fn known_pose(shape: &SoilToolShape, pose: &SoilToolPose) -> SoilToolPose {
    if shape.cuts() || shape.hold().is_some() {
        return *pose;
    }
    SoilToolPose { upper: pose.edge, facing: DVec3::Z, ..*pose }
}

fn check_place(name: &str, place: DVec3) -> Result<()> {
    if place.is_finite() && place.length() <= 1e7 {
        return Ok(());
    }
    Err(Error::range(name, "finite and within 1e7 m of the origin", place))
}
