//! State of a view's glass: the steps that are due, the conditions during them, and whether there is anything to do.

use std::sync::Arc;

use glam::{DVec2, DVec3};

use super::{
    frost::Snowing,
    geometry::Plane,
    lens::{LensFrame, LensLattice, LensUniform},
    passes::{GlassKit, LatticeWork, LensDraw, LensPass, LensVariant, PaneLattice},
    reach::Reach,
    reach_pass::{MapReach, Mapped},
    reference::{Cells, Snow},
    step::{MAX_STEPS, STEPS_PER_S, StepConditions, Tables, seed_key},
    windscreen::{MAX_ARMS, Windscreen},
};
use crate::{
    error::Result,
    falling::{drops::factor_in, sizes::DropSizes},
    gpu::{Device, readback},
    scene::Camera,
    weather::Conditions,
};

/// Share of the rain that boxes let through to each part of the glass, and the host's occluder maps, if there are any.
pub(super) type Reached<'a> = (Reach, Option<Mapped<'a>>);

/// Weather, camera and time of a frame, for its glass.
pub(super) struct AtGlass<'a> {
    /// Time of the frame, s.
    pub time_s: f64,
    /// Seed of the world.
    pub seed: u64,
    /// Camera of the picture.
    pub camera: &'a Camera,
    /// Unit vector up, in the world's axes.
    pub up: DVec3,
    /// Altitude of the camera above sea level, m.
    pub altitude_m: f64,
    /// Function that returns the weather at a time, s.
    pub weather: &'a dyn Fn(f64) -> Conditions,
    /// Function that returns the share of the rain that boxes now let through to the glass, and the occluder maps.
    pub reach: &'a dyn Fn(&Plane, &Windscreen) -> Result<Reached<'a>>,
    /// Whether the frame must not depend on earlier frames.
    pub cut: bool,
}

/// Water on a windscreen.
#[derive(Clone, Copy, Debug, PartialEq, Default)]
pub struct GlassReport {
    /// Drops that hit the pane per second.
    pub drops_per_s: f64,
    /// Water that hits the pane, mm/h over its area.
    pub water_mm_h: f64,
    /// Share of the pane under beads of water, 0 to 1.
    pub covered: f64,
    /// Water on the pane, m^3.
    pub water_m3: f64,
    /// Water in the snow on the pane, m^3.
    pub snow_m3: f64,
    /// Simulation time of the state, s; NaN before the first frame.
    pub state_time_s: f64,
}

/// A view's windscreen, and its state between frames.
pub(crate) struct Glass {
    /// Windscreen that the host has set.
    screen: Windscreen,
    /// Simulation time of the last frame, s, and the windscreen then.
    last: Option<(f64, Windscreen)>,
    /// Plane of the glass in the last frame.
    plane: Option<Plane>,
    /// Conditions on the glass in the last frame.
    acting: Option<StepConditions>,
    /// Share of the rain that boxes let through in the last frame, and whether there were maps.
    reach: (Reach, bool),
    /// Cells on the GPU; `None` on glass that has been dry so far.
    lattice: Option<PaneLattice>,
    /// Bindings of the occluder maps, once there are any.
    below: Option<Box<MapReach>>,
    lens: Option<LensPass>,
    /// Cache of the steps' uniforms.
    tables: Box<Tables>,
    /// Index of the last step that was done: its time in 1/60 s.
    step: Option<i64>,
    /// Upper bound of the wetness: 1 in rain and meltwater, then falling linearly to 0 in the time in which the largest
    /// bead dries.
    moisture: f64,
    /// Upper bound of the snow in a cell, units; 0 without snow.
    frost: f64,
    /// Hash of the seed, for patterns that stay in place on the glass.
    key: u32,
}

/// Returns the index of the last step at or before a time. A host's rounding of the time n / 60 s still gives step n.
fn step_at(time_s: f64) -> i64 {
    (time_s * STEPS_PER_S + 1e-6).floor() as i64
}

/// Returns the conditions on the glass in a weather.
fn acting(screen: &Windscreen, plane: &Plane, moment: &AtGlass<'_>, weather: &Conditions) -> StepConditions {
    let up = moment.camera.rotation() * moment.up;
    // Rounds the altitude to 50 m, so that a hilly road does not need new tables all the time.
    let level = (moment.altitude_m / 50.0).round() * 50.0;
    StepConditions {
        cell_m: plane.lattice().0,
        rain: DropSizes::new(&weather.precipitation, factor_in(&weather.air, level)),
        exposed: screen.exposed,
        up: plane.out.dot(up),
        approach_m_s: plane.out.dot(screen.velocity_m_s),
        airflow_m_s: screen.airflow_m_s,
        down: DVec2::new(-plane.u.dot(up), -plane.v.dot(up)),
        relative_humidity: weather.air.relative_humidity,
        temperature_c: weather.air.temperature_c,
        snow: Snowing::new(&weather.precipitation, weather.air.temperature_c, factor_in(&weather.air, level)),
        heat_w_m2: screen.heat_w_m2,
    }
}

impl Glass {
    /// Creates the state of a windscreen before the first frame.
    pub fn new(screen: Windscreen) -> Self {
        Self {
            screen,
            last: None,
            plane: None,
            acting: None,
            reach: (Reach::ALL, false),
            lattice: None,
            below: None,
            lens: None,
            tables: Box::default(),
            step: None,
            moisture: 0.0,
            frost: 0.0,
            key: 0,
        }
    }

    /// Replaces the windscreen; the water stays on it.
    pub fn set(&mut self, screen: Windscreen) {
        self.screen = screen;
    }

    /// Returns whether the lens has anything to draw.
    pub fn shows(&self) -> bool {
        self.moisture > 0.0 || self.frost > 0.0 || self.screen.fogging * (1.0 - self.screen.demist) > 0.0
    }

    /// Returns the bytes of GPU memory in use.
    pub fn bytes(&self) -> u64 {
        self.lattice.as_ref().map_or(0, PaneLattice::bytes) + self.lens.as_ref().map_or(0, LensPass::bytes)
    }

    /// Advances the glass to the time of a frame. Returns the number of passes.
    ///
    /// # Errors
    /// [`Status::Unsupported`] for a projection of parallel rays.
    pub fn advance(
        &mut self,
        device: &Device,
        kit: &mut GlassKit,
        encoder: &mut wgpu::CommandEncoder,
        moment: &AtGlass<'_>,
    ) -> Result<u32> {
        let plane = Plane::of_pane(&self.screen.pane, &moment.camera.projection)?;
        let (cell_m, size) = plane.lattice();
        // Tolerates small changes of the pane's size, which rounding causes when the head moves: the water stays.
        let same = |old: [u32; 2]| (0..2).all(|i| old[i].abs_diff(size[i]) <= 1 + size[i] / 50);
        let fits = self.lattice.as_ref().is_some_and(|l| same(l.size));
        if self.lattice.is_some() && !fits {
            (self.lattice, self.lens, self.step) = (None, None, None);
        }
        self.plane = Some(plane);
        self.key = seed_key(moment.seed);
        let now = step_at(moment.time_s);
        let before = self.last.filter(|_| !moment.cut);
        let from = self.step.filter(|s| !moment.cut && *s <= now && now - s <= MAX_STEPS);
        let (reach, mapped) = (moment.reach)(&plane, &self.screen)?;
        self.reach = (reach, mapped.is_some());
        let present = acting(&self.screen, &plane, moment, &(moment.weather)(moment.time_s));
        self.acting = Some(present);
        let Some(from) = from else {
            self.begin(device, kit, moment, &present, (now, size));
            return self.record(device, kit, encoder, moment, mapped.as_ref());
        };
        for step in from + 1..=now {
            let time_s = step as f64 / STEPS_PER_S;
            let screen = self.between(before, moment.time_s, time_s);
            let mut acts = acting(&screen, &plane, moment, &(moment.weather)(time_s));
            acts.cell_m = cell_m;
            self.take_step(device, kit, (&acts, &screen), moment.seed, (step, size), before, moment.time_s);
        }
        self.step = Some(now);
        self.record(device, kit, encoder, moment, mapped.as_ref())
    }

    /// Records the due work, and remembers this frame.
    fn record(
        &mut self,
        device: &Device,
        kit: &mut GlassKit,
        encoder: &mut wgpu::CommandEncoder,
        moment: &AtGlass<'_>,
        mapped: Option<&Mapped<'_>>,
    ) -> Result<u32> {
        self.last = Some((moment.time_s, self.screen));
        let Some(lattice) = &mut self.lattice else { return Ok(0) };
        lattice.record(device, kit, encoder, mapped.map(|m| (&mut self.below, m)))
    }

    /// Takes the declared state of the present time.
    fn begin(
        &mut self,
        device: &Device,
        kit: &GlassKit,
        moment: &AtGlass<'_>,
        acts: &StepConditions,
        (now, size): (i64, [u32; 2]),
    ) {
        self.step = Some(now);
        let reached = self.reach.0.any();
        self.moisture = if reached && self.tables.arrive(acts) { 1.0 } else { 0.0 };
        let had_snow = self.frost > 0.0;
        self.frost = if reached && self.tables.snows(acts).0 { self.tables.most_snow() } else { 0.0 };
        if self.moisture > 0.0 || self.frost > 0.0 {
            let lattice =
                self.lattice.get_or_insert_with(|| PaneLattice::new(device, kit, size, MAX_STEPS as usize + 1));
            let numbers = self.tables.at((acts, &self.reach.0), moment.seed, now, lattice.size, &[None; 2]);
            lattice.add(&numbers, (LatticeWork::Declare, had_snow || self.frost > 0.0));
        }
    }

    /// Adds the work of one step of water and snow, if there are any.
    #[allow(clippy::too_many_arguments, reason = "the step's inputs, which only this call brings together")]
    fn take_step(
        &mut self,
        device: &Device,
        kit: &GlassKit,
        (acts, screen): (&StepConditions, &Windscreen),
        seed: u64,
        (step, size): (i64, [u32; 2]),
        last_frame: Option<(f64, Windscreen)>,
        until_s: f64,
    ) {
        let reached = self.reach.0.any();
        let rains = reached && self.tables.arrive(acts);
        let (snows, melts) = self.tables.snows(acts);
        let snows = snows && reached;
        if !rains && self.moisture <= 0.0 && !snows && self.frost <= 0.0 {
            return;
        }
        let earlier = match last_frame {
            Some((from_s, old)) => blend(&old, &self.screen, share(from_s, until_s, (step - 1) as f64 / STEPS_PER_S)),
            None => *screen,
        };
        let is_wiped = (0..MAX_ARMS).any(|i| screen.arms[i] != earlier.arms[i]);
        // Skips the step if nothing changes: no rain, no water, no wiping, and snow that neither falls nor melts.
        if !rains && self.moisture <= 0.0 && !snows && melts <= 0.0 && !is_wiped {
            return;
        }
        let was_dry = self.moisture <= 0.0 && self.frost <= 0.0;
        let has_snow = snows || self.frost > 0.0;
        let wets = rains || (self.frost > 0.0 && melts > 0.0);
        self.moisture = if wets { 1.0 } else { (self.moisture - 1.0 / (STEPS_PER_S * acts.drying_s())).max(0.0) };
        // Lowers the bound by less than the mean melt, because cells melt by random amounts around the mean.
        self.frost = if snows { self.tables.most_snow() } else { (self.frost - 0.99 * melts).max(0.0) };
        let lattice = self.lattice.get_or_insert_with(|| PaneLattice::new(device, kit, size, MAX_STEPS as usize + 1));
        if was_dry {
            let dry = StepConditions { exposed: 0.0, ..*acts };
            let numbers = self.tables.at((&dry, &self.reach.0), seed, step, lattice.size, &[None; 2]);
            lattice.add(&numbers, (LatticeWork::Declare, has_snow));
        }
        let arms = std::array::from_fn(|i| {
            let arm = screen.arms[i]?;
            let start = earlier.arms[i].map_or(arm.position, |a| a.position);
            Some((arm, [arm.angle(start), arm.angle(arm.position)]))
        });
        let mut numbers = self.tables.at((acts, &self.reach.0), seed, step, lattice.size, &arms);
        if !has_snow {
            // Switches melting off without snow.
            numbers.snow = [0; 4];
        }
        lattice.add(&numbers, (LatticeWork::Move, has_snow));
    }

    /// Returns the windscreen at a time since the last frame.
    fn between(&self, last_frame: Option<(f64, Windscreen)>, until_s: f64, time_s: f64) -> Windscreen {
        last_frame.map_or(self.screen, |(from_s, old)| blend(&old, &self.screen, share(from_s, until_s, time_s)))
    }

    /// Draws the lens over the finished picture. Returns the number of passes.
    ///
    /// # Errors
    /// [`Status::Unsupported`] for a projection of parallel rays, or a missing shader file.
    pub fn draw(
        &mut self,
        device: &Arc<Device>,
        kit: &mut GlassKit,
        encoder: &mut wgpu::CommandEncoder,
        frame: &LensFrame<'_>,
    ) -> Result<u32> {
        let (Some(plane), Some(acts)) = (self.plane, self.acting) else { return Ok(0) };
        let (wet, snowy) = (self.moisture > 0.0, self.frost > 0.0);
        let lattice = self.lattice.as_ref().filter(|_| wet || snowy);
        let serves = |l: &LensPass| l.serves(frame, lattice);
        if !self.lens.as_ref().is_some_and(serves) {
            self.lens = Some(LensPass::new(device, kit, frame, lattice));
        }
        let Some(lens) = &self.lens else { return Ok(0) };
        // Direction in which the largest beads of a cell run.
        let large = self.tables.flow();
        let size = lattice.map_or(plane.lattice().1, |l| l.size);
        let shown = LensLattice { cell_m: acts.cell_m, size, wet, snowy, flow: large, key: self.key };
        let uniform = LensUniform::of(&self.screen, &plane, frame, &shown)?;
        let variant =
            LensVariant { format: frame.picture.format(), encoded: frame.encoded, has_mask: frame.mask.is_some() };
        lens.draw(device, kit, encoder, &LensDraw { uniform: &uniform, variant, target: frame.target }, lattice)
    }

    /// Returns the water on the pane. Reads the cells back, which waits for the GPU.
    ///
    /// # Errors
    /// [`Status::DeviceLost`], or a GPU fault.
    pub fn report(&self, device: &Device) -> Result<GlassReport> {
        let (Some(plane), Some(acts)) = (self.plane, self.acting) else {
            return Ok(GlassReport { state_time_s: f64::NAN, ..Default::default() });
        };
        let (arrivals, share) = (acts.arrivals(), self.reached(device)?.mean());
        let mut report = GlassReport {
            drops_per_s: arrivals.number_m2_s * plane.area_m2() * share,
            water_mm_h: arrivals.water_m_s * 3.6e6 * share,
            state_time_s: self.step.map_or(f64::NAN, |s| s as f64 / STEPS_PER_S),
            ..Default::default()
        };
        if let Some(cells) = self.cells(device)? {
            (report.covered, report.water_m3) = cells.covered(&plane, acts.cell_m);
        }
        if let Some(snow) = self.snow(device)? {
            report.snow_m3 = snow.water_m3();
        }
        Ok(report)
    }

    /// Returns the share of the rain that reaches each part of the pane past boxes and maps. Waits for the GPU if there
    /// are maps.
    fn reached(&self, device: &Device) -> Result<Reach> {
        let (boxes, mapped) = self.reach;
        let Some(lattice) = self.lattice.as_ref().filter(|_| mapped) else { return Ok(boxes) };
        let nodes: Vec<u8> = readback::bytes(device, lattice.mapped(), 0)?.into_iter().step_by(4).collect();
        Ok(boxes.and(&Reach::from_nodes(&nodes)))
    }

    /// Returns the snow, if there may be any. Waits for the GPU.
    ///
    /// # Errors
    /// [`Status::DeviceLost`], or a GPU fault.
    pub fn snow(&self, device: &Device) -> Result<Option<Snow>> {
        let Some(lattice) = self.lattice.as_ref().filter(|_| self.frost > 0.0) else { return Ok(None) };
        let bytes = readback::bytes(device, lattice.snow(), 0)?;
        let cells = bytes.chunks_exact(4).map(|b| u32::from_le_bytes([b[0], b[1], b[2], b[3]]));
        Ok(Some(Snow { size: lattice.size, cells: cells.collect() }))
    }

    /// Returns the cells, if there is water. Waits for the GPU.
    ///
    /// # Errors
    /// [`Status::DeviceLost`], or a GPU fault.
    pub fn cells(&self, device: &Device) -> Result<Option<Cells>> {
        let Some(lattice) = self.lattice.as_ref().filter(|_| self.moisture > 0.0) else { return Ok(None) };
        let bytes = readback::bytes(device, lattice.texture(), 0)?;
        let word = |b: &[u8], i: usize| u32::from_le_bytes([b[i], b[i + 1], b[i + 2], b[i + 3]]);
        let cells = bytes.chunks_exact(16).map(|b| [0, 4, 8, 12].map(|i| word(b, i)));
        Ok(Some(Cells { size: lattice.size, cells: cells.collect() }))
    }
}

/// Returns the position of a time between two times, 0 to 1.
fn share(from_s: f64, until_s: f64, time_s: f64) -> f64 {
    if until_s <= from_s { 1.0 } else { ((time_s - from_s) / (until_s - from_s)).clamp(0.0, 1.0) }
}

/// Interpolates the air speeds and the wipers between two frames. All other fields are those of the later frame.
fn blend(a: &Windscreen, b: &Windscreen, share: f64) -> Windscreen {
    let lerp = |a: f64, b: f64| if a == b { b } else { a + (b - a) * share };
    let mut s = *b;
    s.airflow_m_s = lerp(a.airflow_m_s, b.airflow_m_s);
    s.velocity_m_s = DVec3::from_array(std::array::from_fn(|i| lerp(a.velocity_m_s[i], b.velocity_m_s[i])));
    for (arm, old) in s.arms.iter_mut().zip(&a.arms) {
        if let (Some(arm), Some(old)) = (arm, old) {
            arm.position = lerp(old.position, arm.position);
        }
    }
    s
}
