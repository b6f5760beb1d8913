//! The tables over a planet as one simulator shows them: built at once or by parts, and followed through a change of
//! its air without a jump.

use std::path::Path;
use std::sync::Arc;

use super::Planet;
use super::kit::{Claim, Kit, SkyLibrary, Ticket};
use super::level::Detail;
use super::light::LightTable;
use super::passes::SkyTable;
use super::recipe::Name;
use super::set::TableSet;
use super::settings::{SkyModel, SkySettings};
use super::uniforms::AirUniform;
use crate::error::{Error, Result};
use crate::gpu::Device;

enum State {
    Idle,
    /// A build of the tables to show next, and in how many calls it has been led on.
    Building(Arc<Ticket>, u32),
    /// The tables to show next, and their share in what is shown; 0 in the call that lets observers draw them.
    Fading(Arc<TableSet>, f32),
    /// Built by the last call.
    Built(Arc<TableSet>),
}

/// One call in so many leaves a build alone, so that observers may follow sun and height in it.
const REST: u32 = 8;
/// A fade's share per call, whatever the time: it costs as much in a frame however long it lasts.
const FADE: f32 = 1.0 / 16.0;
/// Airs whose optical depth differs by more than this share need a draft before the whole tables: it errs by less.
const FAR: f64 = 0.03;

/// Albedos of the ground that differ by more than this need a draft before the whole tables.
const FAR_ALBEDO: f64 = 0.1;

/// Progress that [`SkyTables::update`] made.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TablesProgress {
    /// Work submitted by this call, as a share of a whole build; 0 where another has built the planet.
    pub work: f32,
    /// Share of the way to the whole tables of the last planet given: 0 while a draft of it is made, 0.5 when they are
    /// built, 1 when they are shown.
    pub done: f32,
}

/// Tables over a planet for one model: light scattered more than once, and the light at every altitude and sun angle.
/// They hold radiances per unit irradiance of the light, so sun and moon share them.
///
/// Those who show the same planet with the same settings through one [`SkyLibrary`] share its tables and the work of
/// building them. One thread at a time.
pub struct SkyTables {
    pub(crate) device: Arc<Device>,
    kit: Arc<Kit>,
    /// The light as it is shown: that of one planet, or of two while one fades into the other. Where pixels march, the
    /// sources of the shown planet lie below it.
    pub(crate) light: SkyTable,
    shown: Option<Arc<TableSet>>,
    state: State,
    revision: u64,
    /// Whether the last call worked on tables, or faded some in.
    busy: bool,
}

impl SkyTables {
    /// Makes tables that share nothing; nothing is built until [`SkyTables::update`].
    ///
    /// # Errors
    /// [`crate::Status::InvalidArgument`] for settings out of range; GPU faults.
    pub fn new(device: &Arc<Device>, settings: &SkySettings) -> Result<Self> {
        Self::of_library(&SkyLibrary::default(), device, settings)
    }

    /// As [`SkyTables::new`], sharing pipelines, tables and builds with all others of `library`, which is `device`'s.
    ///
    /// # Errors
    /// As [`SkyTables::new`].
    pub fn of_library(library: &SkyLibrary, device: &Arc<Device>, settings: &SkySettings) -> Result<Self> {
        let kit = library.kit(device, settings)?;
        let light = SkyTable::new(device, "sky light", Name::shown_size(settings));
        device.check_made()?;
        Ok(Self { device: device.clone(), kit, light, shown: None, state: State::Idle, revision: 0, busy: false })
    }

    /// The settings of these tables.
    pub fn settings(&self) -> &SkySettings {
        &self.kit.settings
    }

    /// The planet whose tables are shown; while a change fades in, the older one.
    pub fn planet(&self) -> Option<&Planet> {
        self.shown.as_ref().map(|s| &s.planet)
    }

    /// Changes whenever something shown changes, so that an observer's tables follow.
    pub fn revision(&self) -> u64 {
        self.revision
    }

    /// Planets that were built for the settings of these tables, by all who share them.
    pub fn builds(&self) -> u64 {
        self.kit.builds()
    }

    /// Values of `override` constants for every pipeline whose shader includes `sky/lookup.wgsl`.
    pub fn pipeline_constants(&self) -> [(&'static str, f64); 1] {
        [("SKY_MARCH", crate::stage::flag(self.settings().model == SkyModel::BruteForce))]
    }

    /// Follows `planet`, with at most `fraction` of the work of a whole build in this call (about: a strip of 1/1024 is
    /// not cut). At `fraction` 1 its tables are built and shown at once. Else the first planet is shown at once as a
    /// draft, and so is, faded in over sixteen calls, one whose air is another than that shown; the whole tables are
    /// built beside what is shown over 8/7 of 1/fraction calls, every eighth of which rests, and fade in like the
    /// draft. A planet that is given meanwhile comes after them, or ends their build if they were far from it.
    ///
    /// What is shown depends on the calls alone, on nothing that is timed. What is built is submitted by this call;
    /// what is shown of it is recorded into `encoder`, to be submitted after.
    ///
    /// # Errors
    /// [`crate::Status::InvalidArgument`] for a planet or fraction out of range; GPU faults.
    pub fn update(
        &mut self,
        encoder: &mut wgpu::CommandEncoder,
        planet: &Planet,
        fraction: f32,
    ) -> Result<TablesProgress> {
        if !(fraction > 0.0 && fraction <= 1.0) {
            return Err(Error::range("fraction", "in (0, 1]", fraction));
        }
        self.busy = false;
        if fraction >= 1.0 {
            let work = self.show_at_once(encoder, planet, Detail::Whole)?;
            return Ok(TablesProgress { work, done: 1.0 });
        }
        if self.shown.is_none() {
            let work = self.show_at_once(encoder, planet, Detail::Draft)?;
            return Ok(TablesProgress { work, done: self.done(planet) });
        }
        self.choose(planet)?;
        let work = self.step(encoder, fraction)?;
        Ok(TablesProgress { work, done: self.done(planet) })
    }

    /// Builds what is asked to its end and shows it. The work.
    fn show_at_once(&mut self, encoder: &mut wgpu::CommandEncoder, planet: &Planet, detail: Detail) -> Result<f32> {
        let shows = |s: &Arc<TableSet>| s.planet == *planet && s.detail == detail;
        if self.shown.as_ref().is_some_and(shows) {
            if !matches!(self.state, State::Idle) {
                self.show(encoder, self.shown.clone());
            }
            return Ok(0.0);
        }
        planet.check()?;
        let (set, work) = match self.kit.claim(planet, detail)? {
            Claim::Finished(set) => (Some(set), 0.0),
            Claim::Building(ticket) => {
                let (step, set) = self.kit.advance(&ticket, 2.0)?;
                (set, step.work as f32)
            }
        };
        self.show(encoder, set);
        Ok(work)
    }

    /// Decides what to show next, if nothing is under way that leads there.
    fn choose(&mut self, planet: &Planet) -> Result<()> {
        let Some(shown) = &self.shown else { return Ok(()) };
        let free = match &self.state {
            State::Idle => true,
            State::Building(ticket, _) => ticket.detail() == Detail::Whole && is_far(ticket.planet(), planet),
            State::Built(_) | State::Fading(..) => false,
        };
        if !free || (shown.planet == *planet && shown.detail == Detail::Whole) {
            return Ok(());
        }
        planet.check()?;
        let detail = if is_far(&shown.planet, planet) { Detail::Draft } else { Detail::Whole };
        self.state = match self.kit.claim(planet, detail)? {
            Claim::Finished(set) => State::Built(set),
            Claim::Building(ticket) => State::Building(ticket, 0),
        };
        Ok(())
    }

    /// Goes on with a build or a fade; the work.
    fn step(&mut self, encoder: &mut wgpu::CommandEncoder, share: f32) -> Result<f32> {
        match &mut self.state {
            State::Idle => Ok(0.0),
            State::Building(ticket, calls) => {
                *calls += 1;
                if calls.is_multiple_of(REST) {
                    return Ok(0.0);
                }
                let (step, set) = self.kit.advance(ticket, f64::from(share))?;
                self.busy = true;
                if let Some(set) = set {
                    self.state = State::Built(set);
                }
                Ok(step.work as f32)
            }
            State::Built(set) => {
                self.state = State::Fading(set.clone(), 0.0);
                Ok(0.0)
            }
            State::Fading(set, t) => {
                self.busy = true;
                *t += share.max(FADE);
                let (set, t) = (set.clone(), *t);
                if t >= 1.0 - 1e-4 {
                    self.show(encoder, Some(set));
                } else {
                    self.revision += 1;
                    self.draw_light(encoder);
                }
                Ok(0.0)
            }
        }
    }

    /// Share of the way to the whole tables of `planet`.
    fn done(&self, planet: &Planet) -> f32 {
        let leads = |set: &TableSet| set.detail == Detail::Whole && set.planet == *planet;
        match &self.state {
            State::Idle if self.shown.as_ref().is_some_and(|s| leads(s)) => 1.0,
            State::Building(ticket, _) if ticket.detail() == Detail::Whole && ticket.planet() == planet => {
                0.5 * self.kit.done(ticket) as f32
            }
            State::Built(set) if leads(set) => 0.5,
            State::Fading(set, t) if leads(set) => 0.5 + 0.5 * t,
            _ => 0.0,
        }
    }

    /// The light of the sky over altitudes and sun angles as it is shown. Each build is read back once, when it is
    /// first asked for, which waits for the GPU; later calls, and all look-ups in the answer, do not. Dark before the
    /// first planet is shown.
    ///
    /// # Errors
    /// GPU faults.
    pub fn read_light(&self) -> Result<LightTable> {
        let Some(shown) = &self.shown else {
            return Ok(LightTable::dark(self.settings(), AirUniform::of(&Planet::earth())));
        };
        let shown = shown.read_light(&self.device, self.settings())?;
        Ok(match &self.state {
            State::Fading(next, t) => shown.mix(&*next.read_light(&self.device, self.settings())?, *t),
            _ => LightTable::clone(&shown),
        })
    }

    /// Builds and shows the tables of `planet` now, in sixteen parts with a wait for the GPU after each, or reads them
    /// from `cache`, a directory in which the tables are kept afterwards. `progress` is told the share done after each
    /// part; when it answers false the build ends, and what was shown before stays. A cache's file that is damaged or
    /// cannot be written is logged, and the tables are built and shown nonetheless.
    ///
    /// # Errors
    /// [`crate::Status::Aborted`]; [`crate::Status::InvalidArgument`] for the planet; GPU faults.
    pub fn build(
        &mut self,
        planet: &Planet,
        cache: Option<&Path>,
        progress: &mut dyn FnMut(f32) -> bool,
    ) -> Result<()> {
        planet.check()?;
        let set = self.kit.build(planet, cache, progress)?;
        self.show_now(set)
    }

    /// The kit of these tables, which builds without them.
    pub(crate) fn kit(&self) -> &Arc<Kit> {
        &self.kit
    }

    /// Shows finished tables from now on.
    pub(crate) fn show_now(&mut self, set: Arc<TableSet>) -> Result<()> {
        let device = self.device.clone();
        let _entered = device.enter()?;
        let mut encoder = device.device.create_command_encoder(&Default::default());
        self.show(&mut encoder, Some(set));
        device.submit(encoder);
        device.check()
    }

    /// Shows nothing any more, as before the first planet.
    pub(crate) fn forget(&mut self) {
        (self.shown, self.state) = (None, State::Idle);
        self.revision += 1;
    }

    /// Shows the tables of the first planet, if they lie in a cache or another shows them.
    pub(crate) fn begin_with(&mut self, planet: &Planet, cache: &Path) -> Result<()> {
        planet.check()?;
        match self.kit.finished_or_kept(planet, cache)? {
            Some(set) => self.show_now(set),
            None => Ok(()),
        }
    }

    /// Returns the tables that are shown.
    pub(crate) fn shown(&self) -> Option<&Arc<TableSet>> {
        self.shown.as_ref()
    }

    /// The share of a build that is as much work as `share` of one with the default settings; small tables take sixteen
    /// calls all the same.
    pub(crate) fn paced(&self, share: f32) -> f32 {
        (share * self.kit.pace as f32).min(FADE)
    }

    /// Returns the tables that are shown, unless they are a draft.
    pub(crate) fn shown_whole(&self) -> Option<&Arc<TableSet>> {
        self.shown.as_ref().filter(|s| s.detail == Detail::Whole)
    }

    /// Returns the tables that fade in, with their share; 0 in the one call before the first step.
    pub(crate) fn fading(&self) -> Option<(&Arc<TableSet>, f32)> {
        match &self.state {
            State::Fading(set, t) => Some((set, *t)),
            _ => None,
        }
    }

    /// Whether this frame has work on tables to pay already.
    pub(crate) fn is_busy(&self) -> bool {
        self.busy
    }

    /// The air that look-ups use: between two while one fades into the other.
    pub(crate) fn air(&self) -> AirUniform {
        let shown = AirUniform::of(self.planet().unwrap_or(&Planet::earth()));
        self.fading().map_or(shown, |(set, t)| shown.mix(&AirUniform::of(&set.planet), t))
    }

    fn show(&mut self, encoder: &mut wgpu::CommandEncoder, set: Option<Arc<TableSet>>) {
        self.shown = set.or(self.shown.take());
        self.state = State::Idle;
        self.revision += 1;
        self.draw_light(encoder);
    }

    fn draw_light(&self, encoder: &mut wgpu::CommandEncoder) {
        if let Some(shown) = &self.shown {
            let next = self.fading().filter(|(_, t)| *t > 0.0).map(|(set, t)| (&set.light_group, t));
            self.kit.fades.show_light(encoder, &self.light.view, &shown.light_group, next);
            if self.settings().model == SkyModel::BruteForce {
                let sources = &shown.result(Name::Sources).texture;
                let mut below = self.light.texture.as_image_copy();
                below.origin.y = Name::Lights.size(self.settings()).1;
                encoder.copy_texture_to_texture(sources.as_image_copy(), below, sources.size());
            }
        }
    }
}

/// Whether tables of one planet are so wrong over the other that a draft is nearer.
fn is_far(a: &Planet, b: &Planet) -> bool {
    // Optical depth straight up of gas, haze and ozone at a wavelength.
    let depths = |p: &Planet, i: usize| {
        [
            p.rayleigh.scattering_per_m[i] * p.rayleigh.scale_height_m,
            p.mie.extinction_per_m[i] * p.mie.scale_height_m,
            p.absorption.extinction_per_m[i] * p.absorption.half_width_m,
        ]
    };
    let apart = |i: usize| {
        let (a, b) = (depths(a, i), depths(b, i));
        let change: f64 = a.iter().zip(&b).map(|(x, y)| (x - y).abs()).sum();
        change > FAR * a.iter().sum::<f64>().max(b.iter().sum())
    };
    let taller = |x: f64, y: f64| (x - y).abs() > 2.0 * FAR * x.max(y);
    let body = |p: &Planet| (p.bottom_radius_m, p.top_radius_m, p.wavelengths_nm);
    body(a) != body(b)
        || (0..3).any(|i| (a.ground_albedo[i] - b.ground_albedo[i]).abs() > FAR_ALBEDO)
        || (a.mie.asymmetry_g - b.mie.asymmetry_g).abs() > FAR
        || taller(a.mie.scale_height_m, b.mie.scale_height_m)
        || taller(a.rayleigh.scale_height_m, b.rayleigh.scale_height_m)
        || (0..3).any(apart)
}
