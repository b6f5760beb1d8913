//! The tables over a planet as one simulator shows them: built at once or by parts, and followed through a change of its
//! air without a jump.

use std::path::Path;
use std::sync::Arc;

use super::Planet;
use super::kit::{Claim, Kit, SkyLibrary, Ticket};
use super::light::LightTable;
use super::passes::Table;
use super::recipe::Name;
use super::set::TableSet;
use super::settings::{SkyModel, SkySettings};
use super::uniforms::AirUniform;
use crate::error::{Error, Result};
use crate::gpu::Device;

enum State {
    Idle,
    /// A build of the planet to show next.
    Building(Arc<Ticket>),
    /// The tables to show next, and their share in what is shown.
    Fading(Arc<TableSet>, f32),
}

/// What [`SkyTables::update`] did.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TablesProgress {
    /// Work submitted by this call, as a share of a whole build; 0 where another has built the planet.
    pub work: f32,
    /// Share of the way to the last planet given: 0.5 when its tables are built, 1 when they are shown.
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
    /// The light as it is shown: that of one planet, or of two while one fades into the other.
    pub(crate) light: Table,
    shown: Option<Arc<TableSet>>,
    state: State,
    revision: u64,
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
        let light = Table::new(device, "sky light", Name::Lights.size(settings));
        device.check()?;
        Ok(Self { device: device.clone(), kit, light, shown: None, state: State::Idle, revision: 0 })
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
        [("SKY_MARCH", f64::from(u8::from(self.settings().model == SkyModel::BruteForce)))]
    }

    /// Follows `planet`, with at most `fraction` of the work of a whole build in this call (about: a strip of 1/48 is not
    /// cut). The first planet, and any at `fraction` 1, is built and shown at once. Else a changed planet is built beside
    /// what is shown over 1/fraction calls, and then fades in over as many; a planet given meanwhile comes after it.
    ///
    /// What is built is submitted by this call; what is shown of it is recorded into `encoder`, to be submitted after.
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
        let at_once = fraction >= 1.0 || self.shown.is_none();
        let next = match &self.state {
            State::Idle => self.planet(),
            State::Building(ticket) => Some(ticket.planet()),
            State::Fading(set, _) => Some(&set.planet),
        };
        if next != Some(planet) && (at_once || matches!(self.state, State::Idle)) {
            planet.check()?;
            self.state = match self.kit.claim(planet)? {
                Claim::Finished(set) => State::Fading(set, 0.0),
                Claim::Building(ticket) => State::Building(ticket),
            };
        }
        let work = self.build_some(if at_once { 2.0 } else { fraction })?;
        if at_once {
            if let State::Fading(set, _) = &self.state {
                let set = set.clone();
                self.show(encoder, set);
            }
            return Ok(TablesProgress { work: work.0, done: 1.0 });
        }
        Ok(TablesProgress { work: work.0, done: work.1.unwrap_or_else(|| self.fade_some(encoder, fraction)) })
    }

    /// Goes on with a build; work, and the share done unless it is time to fade.
    fn build_some(&mut self, share: f32) -> Result<(f32, Option<f32>)> {
        let State::Building(ticket) = &self.state else { return Ok((0.0, None)) };
        let (step, set) = self.kit.advance(ticket, f64::from(share))?;
        if let Some(set) = set {
            self.state = State::Fading(set, 0.0);
        }
        Ok((step.work as f32, Some(0.5 * step.done as f32)))
    }

    /// Goes on with a fade; the share done.
    fn fade_some(&mut self, encoder: &mut wgpu::CommandEncoder, share: f32) -> f32 {
        let State::Fading(set, t) = &mut self.state else { return 1.0 };
        *t += share;
        let (set, t) = (set.clone(), *t);
        if t >= 1.0 - 1e-4 {
            self.show(encoder, set);
            return 1.0;
        }
        self.revision += 1;
        self.draw_light(encoder);
        0.5 + 0.5 * t
    }

    /// The light of the sky over altitudes and sun angles as it is shown. Each build is read back once, when it is first
    /// asked for, which waits for the GPU; later calls, and all look-ups in the answer, do not. Dark before the first
    /// planet is shown.
    ///
    /// # Errors
    /// GPU faults.
    pub fn read_light(&self) -> Result<LightTable> {
        let Some(shown) = &self.shown else {
            return LightTable::read(&self.device, &self.light, AirUniform::of(&Planet::earth()));
        };
        let shown = shown.read_light(&self.device)?;
        Ok(match &self.state {
            State::Fading(next, t) => shown.mix(&*next.read_light(&self.device)?, *t),
            _ => LightTable::clone(&shown),
        })
    }

    /// Builds and shows the tables of `planet` now, in sixteen parts with a wait for the GPU after each, or reads them from
    /// `cache`, a directory in which the tables are kept afterwards. `progress` is told the share done after each part;
    /// when it answers false the build ends, and what was shown before stays. A cache's file that is damaged or cannot be
    /// written is logged, and the tables are built and shown nonetheless.
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
        self.show(&mut encoder, set);
        device.submit(encoder);
        device.check()
    }

    /// Reads the tables of the first planet from a cache, or builds them and writes it; later planets are not kept, since a
    /// changing weather makes one after the other.
    pub(crate) fn begin_with(&mut self, planet: &Planet, cache: &Path) -> Result<()> {
        planet.check()?;
        let ticket = match self.kit.claim_or_load(planet, Some(cache))? {
            Claim::Finished(set) => return self.show_now(set),
            Claim::Building(ticket) => ticket,
        };
        if let (_, Some(set)) = self.kit.advance(&ticket, 2.0)? {
            self.kit.keep(&set, cache);
            self.show_now(set)?;
        }
        Ok(())
    }

    /// What is shown.
    pub(crate) fn shown(&self) -> Option<&Arc<TableSet>> {
        self.shown.as_ref()
    }

    /// What fades in, with its share.
    pub(crate) fn fading(&self) -> Option<(&TableSet, f32)> {
        match &self.state {
            State::Fading(set, t) if *t > 0.0 => Some((set, *t)),
            _ => None,
        }
    }

    /// Whether what was built fades in, or is about to.
    pub(crate) fn is_fading(&self) -> bool {
        matches!(self.state, State::Fading(..))
    }

    /// The air that look-ups use: between two while one fades into the other.
    pub(crate) fn air(&self) -> AirUniform {
        let shown = AirUniform::of(self.planet().unwrap_or(&Planet::earth()));
        self.fading().map_or(shown, |(set, t)| shown.mix(&AirUniform::of(&set.planet), t))
    }

    fn show(&mut self, encoder: &mut wgpu::CommandEncoder, set: Arc<TableSet>) {
        self.shown = Some(set);
        self.state = State::Idle;
        self.revision += 1;
        self.draw_light(encoder);
    }

    fn draw_light(&self, encoder: &mut wgpu::CommandEncoder) {
        if let Some(shown) = &self.shown {
            let next = self.fading().map(|(set, t)| (&set.light_group, t));
            self.kit.fades.show(encoder, &self.light.view, &shown.light_group, next);
        }
    }
}
