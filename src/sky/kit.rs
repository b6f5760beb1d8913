//! The kit: resources that all tables of one device with the same settings share. These are pipelines, builds in
//! progress, and the finished tables of every planet that is still shown.
//!
//! The tables of a planet are built once for all who request them: a later request joins the build or takes the
//! finished tables. A build takes several submissions. Each is made under the kit's lock, so that the submissions reach
//! the queue in order, whichever frames they belong to. The kit does not keep tables alive; they are freed when nobody
//! shows them any more.

mod empty_set;
mod first;

use std::path::Path;
use std::sync::atomic::AtomicBool;
use std::sync::{Arc, Mutex, MutexGuard, OnceLock, PoisonError, Weak};

use super::Planet;
use super::cache;
use super::level::{Detail, Level, STRIP_SHARE, Strip, strips};
use super::observer_passes::{ObserverLayouts, ObserverPasses};
use super::passes::{Builder, FadePasses, PartPass, SkyTable};
use super::recipe::{Name, passes};
use super::set::TableSet;
use super::settings::{SkyModel, SkySettings};
use crate::error::{Error, Result, Status};
use crate::gpu::{Device, readback};

/// Pipelines, builds and finished tables of a device, kept apart for each [`SkySettings`] in use. Any thread.
#[derive(Default)]
pub struct SkyLibrary {
    kits: Mutex<Vec<Weak<Kit>>>,
}

impl SkyLibrary {
    /// Kit of these settings; it is created if none exists.
    pub(crate) fn kit(&self, device: &Arc<Device>, settings: &SkySettings) -> Result<Arc<Kit>> {
        settings.check()?;
        let mut kits = self.kits.lock().unwrap_or_else(PoisonError::into_inner);
        kits.retain(|k| k.strong_count() > 0);
        if let Some(kit) = kits.iter().filter_map(Weak::upgrade).find(|k| k.settings == *settings) {
            return Ok(kit);
        }
        let kit = Arc::new(Kit::new(device, settings)?);
        kits.push(Arc::downgrade(&kit));
        Ok(kit)
    }
}

/// Largest share of a whole build in one submission, so that no submission keeps the GPU from the host's own work for
/// long.
const SUBMISSION_SHARE: f64 = 1.0 / 8.0;

/// Work, in nodes of a march, below which a build needs no draft: 0.2 s on the software driver.
const DRAFT_FROM: f64 = 4e6;
/// Limits of [`Kit::pace`], the factor on the share of a build's work that one frame does. Within them a frame costs
/// the same with all settings. Below the lower limit, with very large tables, it costs more.
const PACE: (f64, f64) = (0.5, 5.0);

/// Tables that are needed only during a build.
struct Scratch(Vec<(Name, SkyTable)>);

/// Claim on a build. The build continues as long as anyone holds a claim.
pub(crate) struct Ticket {
    set: Arc<TableSet>,
}

impl Ticket {
    /// Planet whose tables are being built.
    pub fn planet(&self) -> &Planet {
        &self.set.planet
    }

    /// Detail of the build.
    pub fn detail(&self) -> Detail {
        self.set.detail
    }
}

/// Answer to a request for a planet's tables.
pub(crate) enum Claim {
    Finished(Arc<TableSet>),
    Building(Arc<Ticket>),
}

/// Build under way.
struct Build {
    /// Claim on the build; it is dangling once nobody needs the build.
    ticket: Weak<Ticket>,
    set: Arc<TableSet>,
    scratch: Scratch,
    /// For each triple of wavelengths: the bind group that its passes share, and the bind group of the pass that adds
    /// the triple's light to the light of the other triples. The second is `None` with a single triple.
    triples: Vec<(wgpu::BindGroup, Option<wgpu::BindGroup>)>,
    /// Bind group of the tables that each pass reads.
    reads: Vec<wgpu::BindGroup>,
    /// Number of strips submitted, over all triples.
    next: usize,
}

/// Builds under way and finished tables.
#[derive(Default)]
struct BuildQueue {
    builds: Vec<Build>,
    /// Finished tables that somebody shows.
    finished: Vec<Weak<TableSet>>,
    /// Scratch tables of earlier builds, by detail.
    spare: [Option<Scratch>; 2],
    /// Number of finished builds of whole tables; drafts are not counted.
    count: u64,
}

/// Table that passes draw and read under a name. If there are several triples of wavelengths, the table holds one
/// triple.
fn table_named<'a>(set: &'a TableSet, scratch: &'a Scratch, name: Name) -> Option<&'a SkyTable> {
    scratch.0.iter().chain(set.tables()).find(|(n, _)| *n == name).map(|(_, t)| t)
}

/// Result of one step of a build: the step's work as a share of a whole build, and the share of this build that is
/// done.
#[derive(Clone, Copy, Debug)]
pub(crate) struct BuildStep {
    pub work: f64,
    pub done: f64,
}

/// Pipelines and builds for one [`SkySettings`] on one device. Any thread. Its lock is taken after all others except
/// that for submitting.
pub(crate) struct Kit {
    pub device: Arc<Device>,
    pub settings: SkySettings,
    pub builder: Builder,
    pub fades: FadePasses,
    pub observer_layouts: ObserverLayouts,
    /// Placeholder for tables that a model does not have.
    pub nothing: SkyTable,
    observers: OnceLock<ObserverPasses>,
    /// Work of a whole build with the default settings relative to one with these settings, within the limits of
    /// [`PACE`].
    pub pace: f64,
    /// Build plan of whole tables.
    whole: Level,
    /// Build plan of drafts; `None` if no drafts are built with these settings.
    draft: Option<Level>,
    /// Pass that adds up triples, where there are several.
    parts: Option<PartPass>,
    /// Whether the test of the first texel has passed (`first.rs`).
    begun: AtomicBool,
    work: Mutex<BuildQueue>,
}

impl Kit {
    fn new(device: &Arc<Device>, settings: &SkySettings) -> Result<Self> {
        let whole = Level::new(device, settings, None);
        let draft = settings.draft();
        // A model that marches in the pixels reads the tables at the sizes of the settings, so it has no draft.
        let drafts = whole.total_cost >= DRAFT_FROM && settings.model != SkyModel::BruteForce;
        let strip_cost = STRIP_SHARE * whole.total_cost / f64::from(settings.layers());
        let parts = if settings.layers() > 1 { Some(PartPass::new(device)?) } else { None };
        let default = SkySettings::default();
        let usual_cost = strips(&default, &passes(&default), None).1;
        let kit = Self {
            pace: (usual_cost / whole.total_cost).clamp(PACE.0, PACE.1),
            device: device.clone(),
            settings: *settings,
            builder: Builder::new(device, settings, &whole.passes)?,
            fades: FadePasses::new(device, settings)?,
            observer_layouts: ObserverLayouts::new(device),
            nothing: SkyTable::new(device, "sky nothing", (1, 1)),
            observers: OnceLock::new(),
            draft: drafts.then(|| Level::new(device, &draft, Some(strip_cost))),
            whole,
            parts,
            begun: AtomicBool::new(false),
            work: Mutex::default(),
        };
        device.check_made()?;
        Ok(kit)
    }

    /// Passes and sizes with which tables of this detail are built.
    pub fn level(&self, detail: Detail) -> &Level {
        match detail {
            Detail::Draft => self.draft.as_ref().unwrap_or(&self.whole),
            Detail::Whole => &self.whole,
        }
    }

    /// Whether drafts are built with these settings.
    pub fn drafts(&self) -> bool {
        self.draft.is_some()
    }

    fn lock(&self) -> MutexGuard<'_, BuildQueue> {
        self.work.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Pipelines of the observers' tables, created for the first observer.
    pub fn observer_passes(&self) -> Result<&ObserverPasses> {
        if let Some(known) = self.observers.get() {
            return Ok(known);
        }
        let made = ObserverPasses::new(&self.device, &self.settings, &self.observer_layouts)?;
        Ok(self.observers.get_or_init(|| made))
    }

    /// Number of builds of whole tables finished so far. Drafts, and tables loaded from the cache, are not counted.
    pub fn builds(&self) -> u64 {
        self.lock().count
    }

    /// Returns the finished tables of `planet`, which must have been checked, or a claim on their build. The build may
    /// be under way already. A request for a draft gets the whole tables if these are finished.
    ///
    /// # Errors
    /// GPU faults.
    pub fn claim(&self, planet: &Planet, detail: Detail) -> Result<Claim> {
        let detail = if self.drafts() { detail } else { Detail::Whole };
        let mut work = self.lock();
        self.sweep(&mut work);
        let finished =
            |d| work.finished.iter().filter_map(Weak::upgrade).find(|s| s.planet == *planet && s.detail == d);
        if let Some(set) = finished(Detail::Whole).or_else(|| finished(detail)) {
            return Ok(Claim::Finished(set));
        }
        let is_it = |b: &&Build| b.set.planet == *planet && b.set.detail == detail;
        let known = work.builds.iter().find(is_it).and_then(|b| b.ticket.upgrade());
        if let Some(ticket) = known {
            return Ok(Claim::Building(ticket));
        }
        let set = Arc::new(self.empty_set(planet, detail)?);
        let ticket = Arc::new(Ticket { set: set.clone() });
        let scratch = work.spare[detail as usize].take().unwrap_or_else(|| self.scratch(detail));
        let build = self.build_of(Arc::downgrade(&ticket), set, scratch);
        work.builds.push(build);
        Ok(Claim::Building(ticket))
    }

    /// Ends builds that nobody claims any more, and keeps their scratch tables for the next build.
    fn sweep(&self, work: &mut BuildQueue) {
        while let Some(i) = work.builds.iter().position(|b| b.ticket.strong_count() == 0) {
            let build = work.builds.swap_remove(i);
            work.spare[build.set.detail as usize] = Some(build.scratch);
        }
    }

    fn scratch(&self, detail: Detail) -> Scratch {
        let settings = &self.level(detail).settings;
        let make = |n: &Name| (*n, SkyTable::new(&self.device, &format!("sky {n:?}"), n.size(settings)));
        let of_a_triple = if self.parts.is_some() { &Name::OF_A_TRIPLE[..] } else { &[] };
        Scratch(Name::SCRATCH.iter().chain(of_a_triple).map(make).collect())
    }

    fn build_of(&self, ticket: Weak<Ticket>, set: Arc<TableSet>, scratch: Scratch) -> Build {
        let view = |name: Name| table_named(&set, &scratch, name).map_or(&self.nothing.view, |t| &t.view);
        let level = self.level(set.detail);
        let reads = level.passes.iter().map(|p| self.builder.tables_group(&self.device, p.reads.map(view))).collect();
        let triple = |air: &wgpu::Buffer| {
            let added = self.parts.as_ref().map(|p| p.group(&self.device, view(Name::Lights), air));
            (self.builder.shared_group(&self.device, &level.blocks, air), added)
        };
        let triples = set.airs.iter().map(triple).collect();
        Build { ticket, set, scratch, triples, reads, next: 0 }
    }

    /// Submits strips with up to `share` of the work of a whole build, and at least one strip. Returns the tables once
    /// the last strip is submitted.
    pub fn advance(&self, ticket: &Arc<Ticket>, share: f64) -> Result<(BuildStep, Option<Arc<TableSet>>)> {
        let mut guard = self.lock();
        let work = &mut *guard;
        let Some(i) = work.builds.iter().position(|b| Arc::ptr_eq(&b.set, &ticket.set)) else {
            // Another holder of a claim has finished these tables.
            return Ok((BuildStep { work: 0.0, done: 1.0 }, Some(ticket.set.clone())));
        };
        self.begin(&work.builds[i])?;
        let level = self.level(ticket.set.detail);
        let first = work.builds[i].next;
        let mut rest = share * self.whole.total_cost * (1.0 + 1e-6);
        while rest > 0.0 && work.builds[i].next < level.strip_count() {
            let part = rest.min(SUBMISSION_SHARE * self.whole.total_cost);
            let at_least_one = work.builds[i].next == first;
            let cost = self.submit_some(&mut work.builds[i], part, at_least_one)?;
            if cost == 0.0 {
                break;
            }
            rest -= cost;
        }
        let next = work.builds[i].next;
        let (before, now) = (level.cost_of(first), level.cost_of(next));
        let step = BuildStep { work: (now - before) / self.whole.total_cost, done: now / level.total_cost };
        if next < level.strip_count() {
            return Ok((step, None));
        }
        let build = work.builds.swap_remove(i);
        work.spare[build.set.detail as usize] = Some(build.scratch);
        work.count += u64::from(build.set.detail == Detail::Whole);
        work.finished.retain(|s| s.strong_count() > 0);
        work.finished.push(Arc::downgrade(&build.set));
        Ok((BuildStep { done: 1.0, ..step }, Some(build.set)))
    }

    /// Share of a build that is done.
    pub fn done(&self, ticket: &Ticket) -> f64 {
        let level = self.level(ticket.detail());
        let work = self.lock();
        let build = work.builds.iter().find(|b| Arc::ptr_eq(&b.set, &ticket.set));
        build.map_or(1.0, |b| level.cost_of(b.next) / level.total_cost)
    }

    /// Submits strips with a cost of at most `budget`, or with `at_least_one` the next strip whatever its cost. Returns
    /// their cost.
    fn submit_some(&self, build: &mut Build, budget: f64, at_least_one: bool) -> Result<f64> {
        let level = self.level(build.set.detail);
        let (mut cost, mut end) = (0.0, build.next);
        while end < level.strip_count() {
            let strip = &level.strips[end % level.strips.len()];
            if cost + strip.cost > budget && !(at_least_one && end == build.next) {
                break;
            }
            cost += strip.cost;
            end += 1;
        }
        if end > build.next {
            let mut encoder = self.device.device.create_command_encoder(&Default::default());
            self.record(&mut encoder, build, end);
            self.device.submit(encoder);
            self.device.check()?;
            build.next = end;
        }
        Ok(cost)
    }

    /// Records the strips up to `end`, those of one pass in one render pass. A finished triple is added to the others.
    fn record(&self, encoder: &mut wgpu::CommandEncoder, build: &Build, end: usize) {
        let level = self.level(build.set.detail);
        let count = level.strips.len();
        let mut next = build.next;
        while next < end {
            let triple = next / count;
            let last = end.min((triple + 1) * count);
            self.record_strips(encoder, build, triple, &level.strips[next % count..=(last - 1) % count], None);
            if last.is_multiple_of(count) {
                self.record_part(encoder, build, triple);
            }
            next = last;
        }
    }

    /// Records strips. With `part`, draws only this width and height from the first texel of the strips on.
    fn record_strips(
        &self,
        encoder: &mut wgpu::CommandEncoder,
        build: &Build,
        triple: usize,
        strips: &[Strip],
        part: Option<(u32, u32)>,
    ) {
        let level = self.level(build.set.detail);
        for strips in strips.chunk_by(|a, b| a.pass == b.pass) {
            let index = strips[0].pass;
            let pass = &level.passes[index];
            let Some(pipeline) = self.builder.pipeline(pass.kind) else { continue };
            let view = |name: &Name| {
                table_named(&build.set, &build.scratch, *name).map(|t| wgpu::RenderPassColorAttachment {
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
            recorded.set_bind_group(0, &build.triples[triple].0, &[level.blocks.job_offset(index)]);
            recorded.set_bind_group(1, &build.reads[index], &[]);
            let rows: u32 = strips.iter().map(|s| s.rows).sum();
            let (width, height) = part.unwrap_or((pass.draws[0].size(&level.settings).0, rows));
            recorded.set_scissor_rect(0, strips[0].first_row, width, height);
            recorded.draw(0..3, 0..1);
        }
    }

    /// Copies a triple's sources below the sources of the earlier triples, and adds its light to their light. With a
    /// single triple both are already in place.
    fn record_part(&self, encoder: &mut wgpu::CommandEncoder, build: &Build, triple: usize) {
        let (Some(parts), Some(light)) = (&self.parts, &build.triples[triple].1) else { return };
        let Some(from) = table_named(&build.set, &build.scratch, Name::Sources) else { return };
        let mut to = build.set.result(Name::Sources).texture.as_image_copy();
        to.origin.y = triple as u32 * from.texture.height();
        encoder.copy_texture_to_texture(from.texture.as_image_copy(), to, from.texture.size());
        parts.add(encoder, build.set.result(Name::Lights), light, triple == 0);
    }

    /// Returns the tables of `planet`, which must have been checked: those that someone shows, those from the cache's
    /// file, or new ones. New ones are built in sixteen steps, with a wait for the GPU after each, and then written to
    /// the cache. The host's OpenGL context is entered for each step and left during each call of `progress`, which
    /// gets the share done. The build ends with [`Status::Aborted`] if `progress` returns false.
    pub fn build(
        &self,
        planet: &Planet,
        cache: Option<&Path>,
        progress: &mut dyn FnMut(f32) -> bool,
    ) -> Result<Arc<TableSet>> {
        let mut tell = |share: f64| match progress(share.min(1.0) as f32) {
            true => Ok(()),
            false => Err(Error::new(Status::Aborted, "building the sky's tables was aborted by the host")),
        };
        let claim = {
            let _entered = self.device.enter()?;
            self.claim_or_load(planet, cache)?
        };
        let ticket = match claim {
            Claim::Finished(set) => return tell(1.0).map(|()| set),
            Claim::Building(ticket) => ticket,
        };
        loop {
            let entered = self.device.enter()?;
            let (step, set) = self.advance(&ticket, 1.0 / 16.0)?;
            self.device.wait()?;
            drop(entered);
            match (tell(step.done), set) {
                (Ok(()), None) => {}
                (Ok(()), Some(set)) => {
                    if let Some(directory) = cache {
                        let _entered = self.device.enter()?;
                        self.keep(&set, directory);
                    }
                    return Ok(set);
                }
                (Err(e), set) => {
                    // The abandoned tables are freed in the host's context.
                    let _entered = self.device.enter()?;
                    drop((set, ticket));
                    return Err(e);
                }
            }
        }
    }

    /// Whether this device computes tables that can be cached; the `noop` backend computes nothing.
    fn is_real(&self) -> bool {
        self.device.caps().backend != wgpu::Backend::Noop
    }

    /// Claims tables as [`Kit::claim`] does, but looks into the cache first if they are not finished.
    ///
    /// # Errors
    /// As [`Kit::claim`].
    pub fn claim_or_load(&self, planet: &Planet, cache: Option<&Path>) -> Result<Claim> {
        Ok(match (self.claim(planet, Detail::Whole)?, cache) {
            (Claim::Building(ticket), Some(directory)) => {
                self.load(planet, directory)?.map_or(Claim::Building(ticket), Claim::Finished)
            }
            (claim, _) => claim,
        })
    }

    /// Returns the whole tables of `planet` if they are finished or in the cache's file.
    ///
    /// # Errors
    /// GPU faults.
    pub fn finished_or_kept(&self, planet: &Planet, cache: &Path) -> Result<Option<Arc<TableSet>>> {
        let finished = self.lock().finished.iter().filter_map(Weak::upgrade).find(|s| s.planet == *planet);
        match finished.filter(|s| s.detail == Detail::Whole) {
            Some(set) => Ok(Some(set)),
            None => self.load(planet, cache),
        }
    }

    /// Tables from the cache's file; an error in the file is logged.
    fn load(&self, planet: &Planet, directory: &Path) -> Result<Option<Arc<TableSet>>> {
        if !self.is_real() {
            return Ok(None);
        }
        let read = cache::key(planet, &self.settings).and_then(|key| cache::read(directory, key, &self.settings));
        match read {
            Ok(Some(tables)) => {
                let set = Arc::new(self.empty_set(planet, Detail::Whole)?);
                set.fill(&self.device, &tables);
                self.lock().finished.push(Arc::downgrade(&set));
                Ok(Some(set))
            }
            Ok(None) => Ok(None),
            Err(e) => {
                log::warn!("the sky's tables are built anew: {}", e);
                Ok(None)
            }
        }
    }

    /// Writes finished tables to the cache; an error is logged. Waits for the GPU.
    pub fn keep(&self, set: &TableSet, directory: &Path) {
        if !self.is_real() {
            return;
        }
        let read = |name: &Name| readback::bytes(&self.device, &set.result(*name).texture, 0);
        let written = Name::RESULTS
            .iter()
            .map(read)
            .collect::<Result<Vec<_>>>()
            .and_then(|tables| cache::write(directory, cache::key(&set.planet, &self.settings)?, &tables));
        if let Err(e) = written {
            log::warn!("the sky's tables are not kept: {}", e);
        }
    }
}
