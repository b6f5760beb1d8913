//! Tables over a planet as one context shows them. They are built at once or in steps, and follow a change of the
//! planet's air without a jump.

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
use super::way::{LightWay, is_far, place_on_way};
use crate::error::{Error, Result};
use crate::gpu::Device;

/// Present and coming air of a change that the tables follow.
#[derive(Clone, Copy)]
pub(crate) struct AirChange<'a> {
    /// Planet with the air of the present weather.
    pub now: &'a Planet,
    /// Planet with the air of the weather to which the present one is changing; equal to `now` if no change is known.
    pub ahead: &'a Planet,
}

impl AirChange<'_> {
    /// Whether the air is changing to a known air.
    fn goes_on(&self) -> bool {
        self.now != self.ahead
    }

    /// Whether the change, on its way from the air of `shown`, passes near the air of `set` or ends there. True if no
    /// change is known.
    fn leads_past(&self, shown: &TableSet, set: &TableSet) -> bool {
        !self.goes_on() || place_on_way(&shown.planet, self.ahead, &set.planet).is_near
    }
}

/// Fade to other tables.
#[derive(Clone)]
struct TablesFade {
    set: Arc<TableSet>,
    /// Weight of `set` in what is shown.
    weight: f32,
    to: FadeTo,
}

/// Weight at which a fade ends.
#[derive(Clone, Copy)]
enum FadeTo {
    /// Weight 1: only the tables to show next are then shown.
    End,
    /// Weight that follows from the place of the present air between the airs of both tables.
    Air,
}

/// Progress towards the tables to show next.
enum State {
    /// No other tables are wanted.
    Idle,
    /// Build of the tables to show next, and the number of calls since it began.
    Building(Arc<Ticket>, u32),
    /// Fade to the tables to show next. Their weight is 0 in the call in which observers draw them for the first time,
    /// and while the present air is still that of the shown tables.
    Fading(TablesFade),
    /// Tables that the last call has finished.
    Built(Arc<TableSet>),
}

/// One call in this many does not continue the build. In that call observers draw their own tables for the present sun
/// and altitude.
const REST: u32 = 8;
/// Step of a fade's weight per call while the air does not change, unless the call's share of a build is larger. A fade
/// costs the same in each frame, however long it lasts.
const FADE: f32 = 1.0 / 16.0;
/// Largest step of the weight per call while the air changes. A change that took place during a build is thereby spread
/// over several calls.
const ALONG: f32 = 1.0 / 64.0;
/// Smallest finished share at which a build is no longer abandoned for another planet.
const KEPT_FROM: f64 = 0.5;
/// Change of the weight that is too small to draw.
const UNSEEN_SHARE: f32 = 1e-4;

/// Progress made by [`SkyTables::update`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TablesProgress {
    /// Work submitted by this call, as a share of a whole build; 0 if another user of the library has built the planet.
    pub work: f32,
    /// Progress towards the whole tables of the planet given last: 0 while a draft is built or fades in, 0.5 when the
    /// whole tables are built, 1 when they are shown.
    pub done: f32,
}

/// Tables over a planet for one model: light scattered more than once, and the light at every altitude and sun angle.
/// They hold radiances per unit irradiance of a lamp, so that sun and moon share them.
///
/// All `SkyTables` that show the same planet with the same settings through one [`SkyLibrary`] share the planet's
/// tables and the work of building them. One thread at a time.
pub struct SkyTables {
    pub(crate) device: Arc<Device>,
    kit: Arc<Kit>,
    /// Light that is shown: that of one planet, or a mix of two during a fade. With [`SkyModel::BruteForce`] the
    /// texture also holds the sources of the shown planet, below the light.
    pub(crate) light: SkyTable,
    shown: Option<Arc<TableSet>>,
    state: State,
    revision: u64,
    /// Whether the last call worked on tables or on a fade.
    busy: bool,
}

impl SkyTables {
    /// Creates tables that share nothing with others. Nothing is built until [`SkyTables::update`].
    ///
    /// # Errors
    /// [`crate::Status::InvalidArgument`] for settings out of range; GPU faults.
    pub fn new(device: &Arc<Device>, settings: &SkySettings) -> Result<Self> {
        Self::of_library(&SkyLibrary::default(), device, settings)
    }

    /// Creates tables as [`SkyTables::new`] does, but shares pipelines, tables and builds with all others of `library`,
    /// which must belong to `device`.
    ///
    /// # Errors
    /// As [`SkyTables::new`].
    pub fn of_library(library: &SkyLibrary, device: &Arc<Device>, settings: &SkySettings) -> Result<Self> {
        let kit = library.kit(device, settings)?;
        let light = SkyTable::new(device, "sky light", Name::shown_size(settings));
        device.check_made()?;
        Ok(Self { device: device.clone(), kit, light, shown: None, state: State::Idle, revision: 0, busy: false })
    }

    /// Settings of these tables.
    pub fn settings(&self) -> &SkySettings {
        &self.kit.settings
    }

    /// Planet whose tables are shown; during a fade, the planet of the tables that fade out.
    pub fn planet(&self) -> Option<&Planet> {
        self.shown.as_ref().map(|s| &s.planet)
    }

    /// Number that changes whenever the shown tables change, so that an observer's tables can follow.
    pub fn revision(&self) -> u64 {
        self.revision
    }

    /// Number of whole builds finished so far with these settings, by all [`SkyTables`] of the library.
    pub fn builds(&self) -> u64 {
        self.kit.builds()
    }

    /// Values of the `override` constants for every pipeline whose shader includes `sky/lookup.wgsl`.
    pub fn pipeline_constants(&self) -> [(&'static str, f64); 1] {
        [("SKY_MARCH", crate::stage::flag(self.settings().model == SkyModel::BruteForce))]
    }

    /// Follows `planet`: builds its tables, fades to them and shows them. One call does at most about `fraction`, in
    /// (0, 1], of the work of a whole build (strips of 1/1024 of the work are not divided).
    ///
    /// With a `fraction` of 1 the tables of `planet` are built and shown at once. Otherwise the first planet is shown
    /// at once as a draft. A later planet whose air differs much from the shown one's also gets a draft, which fades in
    /// over sixteen calls. The whole tables are built after the draft is shown, over 8/7 of 1/`fraction` calls, because
    /// every eighth call rests, and then fade in like a draft. If another planet is given during that build, its tables
    /// are built afterwards; if it differs much, a build that is less than half done is abandoned for it.
    ///
    /// The result depends only on the sequence of calls, not on time. This call submits what it builds. It records what
    /// it shows into `encoder`, which must be submitted afterwards.
    ///
    /// # Errors
    /// [`crate::Status::InvalidArgument`] for a planet or fraction out of range; GPU faults.
    pub fn update(
        &mut self,
        encoder: &mut wgpu::CommandEncoder,
        planet: &Planet,
        fraction: f32,
    ) -> Result<TablesProgress> {
        self.update_along(encoder, AirChange { now: planet, ahead: planet }, fraction)
    }

    /// Follows a change whose end is known, as [`SkyTables::update`] follows a planet. Tables of the end (a draft, if
    /// its air differs much) are built once and mixed with the shown tables by the place of the present air between
    /// both. After a draft the whole tables follow when the change has ended.
    ///
    /// # Errors
    /// As [`SkyTables::update`].
    pub(crate) fn update_along(
        &mut self,
        encoder: &mut wgpu::CommandEncoder,
        change: AirChange<'_>,
        fraction: f32,
    ) -> Result<TablesProgress> {
        let planet = change.now;
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
        self.choose(change)?;
        let work = self.step(encoder, change, fraction)?;
        Ok(TablesProgress { work, done: self.done(planet) })
    }

    /// Builds the requested tables to the end and shows them. Returns the work.
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

    /// Chooses the tables to show next. A fade in progress keeps the earlier choice, and so does a build in progress
    /// that may not be abandoned.
    fn choose(&mut self, change: AirChange<'_>) -> Result<()> {
        let Some(shown) = &self.shown else { return Ok(()) };
        let serves = |to: &Planet| place_on_way(&shown.planet, to, change.now).is_near;
        let target = if serves(change.ahead) { change.ahead } else { change.now };
        let free = match &self.state {
            State::Idle => true,
            State::Building(ticket, _) => {
                ticket.detail() == Detail::Whole
                    && !serves(ticket.planet())
                    && is_far(ticket.planet(), target)
                    && self.kit.done(ticket) < KEPT_FROM
            }
            State::Built(_) | State::Fading(..) => false,
        };
        if !free || (shown.planet == *target && shown.detail == Detail::Whole) {
            return Ok(());
        }
        target.check()?;
        let detail = if is_far(&shown.planet, target) { Detail::Draft } else { Detail::Whole };
        self.state = match self.kit.claim(target, detail)? {
            Claim::Finished(set) => State::Built(set),
            Claim::Building(ticket) => State::Building(ticket, 0),
        };
        Ok(())
    }

    /// Continues a build or a fade. Returns the work.
    fn step(&mut self, encoder: &mut wgpu::CommandEncoder, change: AirChange<'_>, share: f32) -> Result<f32> {
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
                let set = set.clone();
                self.begin_fade(set, change);
                Ok(0.0)
            }
            State::Fading(fade) => {
                let fade = fade.clone();
                self.fade(encoder, fade, change, share)?;
                Ok(0.0)
            }
        }
    }

    /// Begins the fade to finished tables. Drops them if the air changes in another direction and is nearer to the air
    /// of the shown tables.
    fn begin_fade(&mut self, set: Arc<TableSet>, change: AirChange<'_>) {
        let Some(shown) = &self.shown else { return };
        let place = place_on_way(&shown.planet, &set.planet, change.now);
        let to = if change.goes_on() && place.is_near && change.leads_past(shown, &set) {
            Some(FadeTo::Air)
        } else {
            (!change.goes_on() || place.share >= 0.5).then_some(FadeTo::End)
        };
        self.state = to.map_or(State::Idle, |to| State::Fading(TablesFade { set, weight: 0.0, to }));
    }

    /// Continues a fade. A fade that follows the air ends when the air rests or changes in another direction. From then
    /// on the mix reached so far is shown. A mix of draft and whole tables instead fades on until the tables to show
    /// next are shown alone.
    fn fade(
        &mut self,
        encoder: &mut wgpu::CommandEncoder,
        fade: TablesFade,
        change: AirChange<'_>,
        share: f32,
    ) -> Result<()> {
        let Some(shown) = self.shown.clone() else { return Ok(()) };
        let TablesFade { set, weight: before, to } = &fade;
        let before = *before;
        let place = place_on_way(&shown.planet, &set.planet, change.now);
        let follows = matches!(to, FadeTo::Air);
        let wanted = if follows { LightWay::new(&shown.planet, &set.planet).weight(place.share) as f32 } else { 1.0 };
        let most = if change.goes_on() { ALONG } else { share.max(FADE) };
        let rests = (wanted - before).abs() <= UNSEEN_SHARE && wanted < 1.0 && !change.goes_on();
        if follows && (rests || !place.is_near || !change.leads_past(&shown, set)) {
            if before <= UNSEEN_SHARE {
                self.show(encoder, None);
            } else if shown.detail == set.detail {
                let mixed = self.kit.mixed(encoder, [&shown, set], before)?;
                self.show(encoder, Some(mixed));
            } else {
                self.state = State::Fading(TablesFade { to: FadeTo::End, ..fade });
            }
            return Ok(());
        }
        let t = before + (wanted - before).clamp(-most, most);
        if t >= 1.0 - UNSEEN_SHARE {
            self.busy = true;
            self.show(encoder, Some(fade.set));
        } else if (t - before).abs() > UNSEEN_SHARE {
            self.busy = true;
            self.state = State::Fading(TablesFade { weight: t, ..fade });
            self.revision += 1;
            self.draw_light(encoder);
        }
        Ok(())
    }

    /// Progress towards the whole tables of `planet`, 0 to 1.
    fn done(&self, planet: &Planet) -> f32 {
        let leads = |set: &TableSet| set.detail == Detail::Whole && set.planet == *planet;
        match &self.state {
            State::Idle if self.shown.as_ref().is_some_and(|s| leads(s)) => 1.0,
            State::Building(ticket, _) if ticket.detail() == Detail::Whole && ticket.planet() == planet => {
                0.5 * self.kit.done(ticket) as f32
            }
            State::Built(set) if leads(set) => 0.5,
            State::Fading(fade) if leads(&fade.set) => 0.5 + 0.5 * fade.weight,
            _ => 0.0,
        }
    }

    /// Light of the sky as it is shown, over altitudes and sun angles. The first call after a build reads it back,
    /// which waits for the GPU; later calls, and all look-ups in the result, do not wait. The light is dark before the
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
            State::Fading(fade) => shown.mix(&*fade.set.read_light(&self.device, self.settings())?, fade.weight),
            _ => LightTable::clone(&shown),
        })
    }

    /// Builds and shows the tables of `planet` now, in sixteen steps with a wait for the GPU after each. If the
    /// directory `cache` holds the tables, reads them from there instead; new tables are written to it afterwards.
    /// After each step `progress` gets the share of the build that is done. If it returns false the build ends, and
    /// what was shown before stays. If a file of the cache is damaged or cannot be written, this is logged, and the
    /// tables are built and shown all the same.
    ///
    /// # Errors
    /// [`crate::Status::Aborted`] if `progress` returned false; [`crate::Status::InvalidArgument`] for the planet; GPU
    /// faults.
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

    /// Kit of these tables, which does the building.
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

    /// Shows no tables any more, as before the first planet.
    pub(crate) fn forget(&mut self) {
        (self.shown, self.state) = (None, State::Idle);
        self.revision += 1;
    }

    /// Shows the tables of `planet`, if they are in the cache or other users of the library show them. Used for the
    /// first planet.
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

    /// Share of a build that is as much work as `share` of a build with the default settings. At most 1/16, so that
    /// even small tables take at least sixteen calls.
    pub(crate) fn paced(&self, share: f32) -> f32 {
        (share * self.kit.pace as f32).min(FADE)
    }

    /// Returns the tables that are shown, unless they are a draft.
    pub(crate) fn shown_whole(&self) -> Option<&Arc<TableSet>> {
        self.shown.as_ref().filter(|s| s.detail == Detail::Whole)
    }

    /// Returns the tables that fade in, with their share. The share is 0 in the call before the first step.
    pub(crate) fn fading(&self) -> Option<(&Arc<TableSet>, f32)> {
        match &self.state {
            State::Fading(fade) => Some((&fade.set, fade.weight)),
            _ => None,
        }
    }

    /// Whether this frame already works on tables or on a fade.
    pub(crate) fn is_busy(&self) -> bool {
        self.busy
    }

    /// Air that look-ups use; during a fade, the mix of two.
    pub(crate) fn air(&self) -> AirUniform {
        let shown = AirUniform::of(self.planet().unwrap_or(&Planet::earth()));
        let (Some(from), Some((set, weight))) = (&self.shown, self.fading()) else { return shown };
        let share = LightWay::new(&from.planet, &set.planet).share(f64::from(weight));
        shown.mix(&AirUniform::of(&set.planet), share as f32)
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
