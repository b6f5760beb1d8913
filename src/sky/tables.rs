//! The tables over a planet: built at once or by parts, and followed through a change of its air without a jump.

use std::path::Path;
use std::sync::{Arc, OnceLock};

use bytemuck::bytes_of;

use super::Planet;
use super::cache;
use super::light::LightTable;
use super::passes::{Builder, Fader, Table, uniform_buffer};
use super::recipe::{Name, Pass, passes};
use super::settings::{SkyModel, SkySettings};
use super::uniforms::AirUniform;
use super::volume::ObserverPasses;
use crate::error::{Error, Result, Status};
use crate::gpu::{Device, readback};

/// One planet's finished or growing tables.
pub(crate) struct TableSet {
    planet: Option<Planet>,
    pub air: wgpu::Buffer,
    shared: wgpu::BindGroup,
    results: Vec<(Name, Table)>,
    /// Tables that each pass reads.
    reads: Vec<wgpu::BindGroup>,
    /// Its light on the CPU, once it was asked for.
    light: OnceLock<LightTable>,
}

impl TableSet {
    /// The view of one of [`Name::RESULTS`].
    pub fn result(&self, name: Name) -> &Table {
        // Made of exactly these names; the first stands in for one that cannot be asked for.
        &self.results.iter().find(|(n, _)| *n == name).unwrap_or(&self.results[0]).1
    }
}

/// A part of a pass: rows of its target.
#[derive(Clone, Copy, Debug)]
struct Strip {
    pass: usize,
    first_row: u32,
    rows: u32,
    cost: f64,
}

#[derive(Clone, Copy, Debug, PartialEq)]
enum State {
    Idle,
    /// Strips done of a build into the set that is not shown.
    Building(usize),
    /// Share of the new set in what is shown.
    Fading(f32),
}

/// What [`SkyTables::update`] did.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TablesProgress {
    /// Work recorded by this call, as a share of a whole build.
    pub work: f32,
    /// Share of the tables for the last planet given that is done, 1 when they are shown.
    pub done: f32,
}

/// Tables over a planet for one model: light scattered more than once, and the light at every altitude and sun angle.
/// They hold radiances per unit irradiance of the light, so sun and moon share them.
///
/// Two sets are kept: the one that is shown, and the one that a changed planet is built into. One thread at a time.
pub struct SkyTables {
    pub(crate) device: Arc<Device>,
    settings: SkySettings,
    pub(crate) builder: Builder,
    passes: Vec<Pass>,
    strips: Vec<Strip>,
    total_cost: f64,
    scratch: Vec<(Name, Table)>,
    sets: [TableSet; 2],
    pub(crate) lights: Fader,
    observers: OnceLock<Arc<ObserverPasses>>,
    shown: usize,
    state: State,
    revision: u64,
}

/// A pass is cut into strips of at most this share of a whole build.
const STRIP_SHARE: f64 = 1.0 / 48.0;

impl SkyTables {
    /// Makes the textures and pipelines; nothing is built until [`SkyTables::update`].
    ///
    /// # Errors
    /// [`crate::Status::InvalidArgument`] for settings out of range; GPU faults.
    pub fn new(device: &Arc<Device>, settings: &SkySettings) -> Result<Self> {
        settings.check()?;
        let passes = passes(settings);
        let builder = Builder::new(device, settings, &passes)?;
        let make = |names: &[Name]| -> Vec<(Name, Table)> {
            names.iter().map(|n| (*n, Table::new(device, &format!("sky {n:?}"), n.size(settings)))).collect()
        };
        let scratch = make(&Name::SCRATCH);
        let set = || {
            let results = make(&Name::RESULTS);
            let air = uniform_buffer(device, "sky air", bytes_of(&AirUniform::of(&Planet::earth())));
            let find = |name: Name| {
                let known = results.iter().chain(&scratch).find(|(n, _)| *n == name);
                &known.unwrap_or(&scratch[0]).1.view
            };
            let reads = passes.iter().map(|p| builder.tables_group(device, p.reads.map(find))).collect();
            TableSet {
                planet: None,
                shared: builder.shared_group(device, &air),
                air,
                results,
                reads,
                light: OnceLock::new(),
            }
        };
        let sets = [set(), set()];
        let (strips, total_cost) = strips(settings, &passes);
        let from = sets.each_ref().map(|s| s.result(Name::Lights));
        let lights = Fader::new(device, "sky light", Name::Lights.size(settings), from)?;
        device.check()?;
        Ok(Self {
            device: device.clone(),
            settings: *settings,
            builder,
            passes,
            strips,
            total_cost,
            scratch,
            sets,
            lights,
            observers: OnceLock::new(),
            shown: 0,
            state: State::Idle,
            revision: 0,
        })
    }

    /// The settings of these tables.
    pub fn settings(&self) -> &SkySettings {
        &self.settings
    }

    /// The planet whose tables are shown; while a change fades in, the older one.
    pub fn planet(&self) -> Option<&Planet> {
        self.sets[self.shown].planet.as_ref()
    }

    /// Changes whenever something shown changes, so that an observer's tables follow.
    pub fn revision(&self) -> u64 {
        self.revision
    }

    /// Values of `override` constants for every pipeline whose shader includes `sky/lookup.wgsl`.
    pub fn pipeline_constants(&self) -> [(&'static str, f64); 1] {
        [("SKY_MARCH", f64::from(u8::from(self.settings.model == SkyModel::BruteForce)))]
    }

    /// Follows `planet`, with at most `fraction` of the work of a whole build in this call (about: a strip of 1/48 is not
    /// cut). The first planet, and any at `fraction` 1, is built and shown at once. Else a changed planet is built beside
    /// what is shown over 1/fraction calls, and then fades in over as many; a planet given meanwhile comes after it.
    ///
    /// # Errors
    /// [`crate::Status::InvalidArgument`] for a planet or fraction out of range.
    pub fn update(
        &mut self,
        encoder: &mut wgpu::CommandEncoder,
        planet: &Planet,
        fraction: f32,
    ) -> Result<TablesProgress> {
        if !(fraction > 0.0 && fraction <= 1.0) {
            return Err(Error::range("fraction", "in (0, 1]", fraction));
        }
        let target = match self.state {
            State::Idle => self.shown,
            _ => 1 - self.shown,
        };
        let at_once = fraction >= 1.0 || self.planet().is_none();
        if self.sets[target].planet.as_ref() != Some(planet) && (at_once || self.state == State::Idle) {
            planet.check()?;
            self.begin(planet);
        }
        if at_once {
            return Ok(self.finish(encoder));
        }
        match self.state {
            State::Idle => Ok(TablesProgress { work: 0.0, done: 1.0 }),
            State::Building(_) => Ok(self.build_some(encoder, f64::from(fraction))),
            State::Fading(t) => {
                let t = t + fraction;
                self.revision += 1;
                self.state = State::Fading(t);
                if t >= 1.0 - 1e-4 {
                    self.show_other(encoder);
                } else {
                    self.lights.show(encoder, self.shown, t);
                }
                Ok(TablesProgress { work: 0.0, done: t.min(1.0) })
            }
        }
    }

    /// The light of the sky over altitudes and sun angles as it is shown. Each build is read back once, when it is first
    /// asked for, which waits for the GPU; later calls, and all look-ups in the answer, do not.
    ///
    /// # Errors
    /// GPU faults.
    pub fn read_light(&self) -> Result<LightTable> {
        let of = |i: usize| -> Result<&LightTable> {
            let set = &self.sets[i];
            if let Some(known) = set.light.get() {
                return Ok(known);
            }
            let air = AirUniform::of(set.planet.as_ref().unwrap_or(&Planet::earth()));
            let read = LightTable::read(&self.device, set.result(Name::Lights), air)?;
            Ok(set.light.get_or_init(|| read))
        };
        let shown = of(self.shown)?;
        Ok(match self.fade() {
            Some(t) => shown.mix(of(1 - self.shown)?, t),
            None => shown.clone(),
        })
    }

    /// Builds and shows the tables of `planet` now, in sixteen parts with a wait for the GPU after each, or reads them from
    /// `cache`, a directory in which the tables are kept afterwards. `progress` is told the share done after each part;
    /// when it answers false the build ends, and what was shown before stays.
    ///
    /// # Errors
    /// [`Status::Aborted`]; [`Status::InvalidArgument`] for the planet; [`Status::Io`] if the cache cannot be written (the
    /// tables are shown nonetheless); GPU faults.
    pub fn build(
        &mut self,
        planet: &Planet,
        cache: Option<&Path>,
        progress: &mut dyn FnMut(f32) -> bool,
    ) -> Result<()> {
        planet.check()?;
        let device = self.device.clone();
        let key = cache::key(planet, &self.settings)?;
        let known = cache.and_then(|directory| cache::read(directory, key, &self.settings));
        let from_cache = known.is_some();
        self.begin(planet);
        if let Some(tables) = known {
            self.fill(&tables);
        } else {
            while let State::Building(_) = self.state {
                let mut encoder = device.device.create_command_encoder(&Default::default());
                let done = self.build_some(&mut encoder, 1.0 / 16.0).done;
                device.submit_and_wait(encoder)?;
                if !progress((2.0 * done).min(1.0)) {
                    self.sets[1 - self.shown].planet = None;
                    self.state = State::Idle;
                    return Err(Error::new(Status::Aborted, "building the sky's tables was aborted by the host"));
                }
            }
        }
        let mut encoder = device.device.create_command_encoder(&Default::default());
        self.show_other(&mut encoder);
        device.submit_and_wait(encoder)?;
        match cache {
            Some(directory) if !from_cache => self.keep(directory, key),
            _ => Ok(()),
        }
    }

    /// Fills the set that is not shown.
    fn fill(&mut self, tables: &[Vec<u8>]) {
        let set = &self.sets[1 - self.shown];
        for (name, bytes) in Name::RESULTS.iter().zip(tables) {
            let texture = &set.result(*name).texture;
            let layout = wgpu::TexelCopyBufferLayout {
                offset: 0,
                bytes_per_row: Some(texture.width() * 8),
                rows_per_image: None,
            };
            self.device.queue.write_texture(texture.as_image_copy(), bytes, layout, texture.size());
        }
    }

    /// Writes what is shown to a cache.
    fn keep(&self, directory: &Path, key: u64) -> Result<()> {
        let set = &self.sets[self.shown];
        let read = |name: &Name| readback::bytes(&self.device, &set.result(*name).texture, 0);
        let tables = Name::RESULTS.iter().map(read).collect::<Result<Vec<_>>>()?;
        cache::write(directory, key, &tables).map(|_| ())
    }

    /// Pipelines of the observers' tables, made for the first of them.
    pub(crate) fn observer_passes(&self) -> Result<Arc<ObserverPasses>> {
        if let Some(known) = self.observers.get() {
            return Ok(known.clone());
        }
        let made = Arc::new(ObserverPasses::new(&self.device, &self.settings)?);
        Ok(self.observers.get_or_init(|| made).clone())
    }

    /// Both sets.
    pub(crate) fn sets(&self) -> [&TableSet; 2] {
        self.sets.each_ref()
    }

    /// Which set is shown.
    pub(crate) fn shown_index(&self) -> usize {
        self.shown
    }

    /// Share of the other set while it fades in.
    pub(crate) fn fade(&self) -> Option<f32> {
        match self.state {
            State::Fading(t) => Some(t),
            _ => None,
        }
    }

    /// The air that look-ups use: between two while one fades into the other.
    pub(crate) fn air(&self) -> AirUniform {
        let of = |set: &TableSet| AirUniform::of(set.planet.as_ref().unwrap_or(&Planet::earth()));
        let shown = of(&self.sets[self.shown]);
        self.fade().map_or(shown, |t| shown.mix(&of(&self.sets[1 - self.shown]), t))
    }

    /// Starts a build into the set that is not shown.
    fn begin(&mut self, planet: &Planet) {
        let set = &mut self.sets[1 - self.shown];
        set.planet = Some(*planet);
        set.light = OnceLock::new();
        self.device.queue.write_buffer(&set.air, 0, bytes_of(&AirUniform::of(planet)));
        self.state = State::Building(0);
    }

    /// Builds the rest and shows it without a fade.
    fn finish(&mut self, encoder: &mut wgpu::CommandEncoder) -> TablesProgress {
        let mut work = 0.0;
        if let State::Building(_) = self.state {
            work = self.build_some(encoder, 2.0).work;
        }
        if self.state != State::Idle {
            self.show_other(encoder);
        }
        TablesProgress { work, done: 1.0 }
    }

    fn show_other(&mut self, encoder: &mut wgpu::CommandEncoder) {
        self.shown = 1 - self.shown;
        self.lights.show(encoder, self.shown, 0.0);
        self.state = State::Idle;
        self.revision += 1;
    }

    /// Records strips up to `share` of a whole build.
    fn build_some(&mut self, encoder: &mut wgpu::CommandEncoder, share: f64) -> TablesProgress {
        let State::Building(first) = self.state else { return TablesProgress { work: 0.0, done: 1.0 } };
        let budget = share * self.total_cost * (1.0 + 1e-6);
        let mut cost = 0.0;
        let mut next = first;
        while let Some(strip) = self.strips.get(next) {
            if next > first && cost + strip.cost > budget {
                break;
            }
            cost += strip.cost;
            next += 1;
        }
        self.record(encoder, first, next);
        self.state = if next == self.strips.len() { State::Fading(0.0) } else { State::Building(next) };
        let before: f64 = self.strips[..next].iter().map(|s| s.cost).sum();
        TablesProgress { work: (cost / self.total_cost) as f32, done: (0.5 * before / self.total_cost) as f32 }
    }

    /// Records strips `first..end`, those of one pass in one render pass.
    fn record(&self, encoder: &mut wgpu::CommandEncoder, first: usize, end: usize) {
        let set = &self.sets[1 - self.shown];
        for strips in self.strips[first..end].chunk_by(|a, b| a.pass == b.pass) {
            let index = strips[0].pass;
            let pass = &self.passes[index];
            let Some(pipeline) = self.builder.pipeline(pass.kind) else { continue };
            let view = |name: &Name| {
                let known = set.results.iter().chain(&self.scratch).find(|(n, _)| n == name);
                known.map(|(_, t)| wgpu::RenderPassColorAttachment {
                    view: &t.view,
                    depth_slice: None,
                    resolve_target: None,
                    ops: wgpu::Operations { load: wgpu::LoadOp::Load, store: wgpu::StoreOp::Store },
                })
            };
            let targets: Vec<_> = pass.draws.iter().map(view).collect();
            let mut recorded = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
                label: Some("sky build"),
                color_attachments: &targets,
                ..Default::default()
            });
            recorded.set_pipeline(pipeline);
            recorded.set_bind_group(0, &set.shared, &[self.builder.job_offset(index)]);
            recorded.set_bind_group(1, &set.reads[index], &[]);
            let rows: u32 = strips.iter().map(|s| s.rows).sum();
            recorded.set_scissor_rect(0, strips[0].first_row, pass.draws[0].size(&self.settings).0, rows);
            recorded.draw(0..3, 0..1);
        }
    }
}

/// Cuts the passes into strips; also the cost of all.
fn strips(settings: &SkySettings, passes: &[Pass]) -> (Vec<Strip>, f64) {
    let row_cost = |p: &Pass| f64::from(p.draws[0].size(settings).0) * p.texel_cost(settings);
    let total: f64 = passes.iter().map(|p| row_cost(p) * f64::from(p.draws[0].size(settings).1)).sum();
    let mut out = Vec::new();
    for (pass, p) in passes.iter().enumerate() {
        let height = p.draws[0].size(settings).1;
        let each = ((STRIP_SHARE * total / row_cost(p)) as u32).clamp(1, height);
        for first_row in (0..height).step_by(each as usize) {
            let rows = each.min(height - first_row);
            out.push(Strip { pass, first_row, rows, cost: row_cost(p) * f64::from(rows) });
        }
    }
    (out, total)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn strips_cover_every_pass_and_are_small() {
        for (_, model) in SkyModel::NAMES {
            let s = SkySettings::with_model(model);
            let list = passes(&s);
            let (strips, total) = strips(&s, &list);
            assert!(strips.iter().all(|x| x.cost <= total / 32.0), "{model:?}");
            assert!((strips.iter().map(|x| x.cost).sum::<f64>() / total - 1.0).abs() < 1e-9);
            for (i, p) in list.iter().enumerate() {
                let rows: u32 = strips.iter().filter(|x| x.pass == i).map(|x| x.rows).sum();
                assert_eq!(rows, p.draws[0].size(&s).1);
            }
        }
    }
}
