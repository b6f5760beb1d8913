//! Tables of one observer, for each lamp: the sky by direction, and the air in front of objects.

use std::{ops::Range, sync::Arc};

use bytemuck::{Zeroable as _, bytes_of};

use super::ahead::{Ahead, WayTables};
use super::course::{Bounds, ObserverPlace};
use super::disc::DiscDepth;
use super::kit::Kit;
use super::observer::Observer;
use super::observer_passes::view_layout;
use super::observer_tables::{Apart, LAMPS, LAYERS, Layered};
use super::passes::{bind, tex, uniform_buffer};
use super::set::TableSet;
use super::settings::{SkyModel, SkySettings};
use super::tables::SkyTables;
use super::uniforms::{AirUniform, DimsUniform, EdgesUniform, LampUniform, ObserverUniform, ViewUniform};
use crate::error::Result;
use crate::gpu::Device;

/// Inputs for which a lamp's tables were drawn.
#[derive(Clone, Copy, PartialEq)]
struct DrawnFor {
    /// Id of the planet's tables.
    set: u64,
    /// Id of the tables that fade in over those of `set`, and their share.
    over: Option<(u64, f32)>,
    altitude_m: f64,
    mu_s: f64,
}

/// Fade between two tables. Each is drawn once; every step then mixes them.
struct Fade {
    /// Layers that fade out (`first`), and layers that fade in (`next`).
    first: Apart,
    next: Apart,
    drawn: [Option<DrawnFor>; LAMPS],
    /// Bind groups that read each layer of both.
    groups: [Vec<wgpu::BindGroup>; 2],
}

impl Fade {
    fn new(device: &Device, kit: &Kit) -> Self {
        let [first, next] = [(); 2].map(|()| Apart::new(device, &kit.settings));
        let read = |t: &Apart| t.layers.iter().map(|l| kit.fades.group(device, l)).collect();
        let groups = [&first, &next].map(read);
        Self { first, next, drawn: [None; LAMPS], groups }
    }
}

/// Change of the sine of a lamp's elevation after which the tables are drawn again. The first number is the usual one.
/// The second applies in frames that already work on the planet's tables.
const SUN_STEP: (f64, f64) = (2e-5, 2e-4);

/// Smaller of the scale heights of gas and haze, m. A medium that the air does not have is left out; 0 without both.
fn least_scale_height_m(air: &AirUniform) -> f64 {
    let media = [(air.rayleigh_scattering, air.rayleigh_scale_height_m), (air.mie_extinction, air.mie_scale_height_m)];
    let there = media.iter().filter(|(per_m, _)| per_m.iter().any(|v| *v > 0.0));
    let least_m = there.map(|(_, height_m)| f64::from(*height_m)).fold(f64::INFINITY, f64::min);
    if least_m.is_finite() { least_m } else { 0.0 }
}

/// Change of altitude after which the tables are drawn again, m. It is the larger of two lengths. The first is 0.2 % of
/// the altitude plus 1 cm. The second is a thousandth of the smallest scale height of the air, over which the light
/// changes by about a thousandth. The second is limited to 30 % of the altitude plus 5 cm, because the horizon moves
/// fastest near the ground. Until the tables are drawn again, look-ups use the observer's own altitude for directions,
/// so the horizon follows at once.
fn altitude_step_m(air: &AirUniform, altitude_m: f64) -> f64 {
    (2e-3 * altitude_m.abs() + 1e-2).max((1e-3 * least_scale_height_m(air)).min(0.05 + 0.3 * altitude_m.abs()))
}

/// Bounds for following an observer. The tables of two places may be mixed if their altitudes differ by at most a
/// twentieth of the smaller scale height plus 2 % of the altitude. For a lamp whose elevation has the sine s, the sines
/// at the two places may differ by at most 6e-4 + 0.15 max(s, 0)^2. This bound is small where the light changes fast:
/// near the horizon and below it.
fn bounds(air: &AirUniform, place: &ObserverPlace) -> Bounds {
    let of_lamp = |mu_s: Option<f64>| 6e-4 + 0.15 * mu_s.unwrap_or(0.0).max(0.0).powi(2);
    let [sun, moon] = place.mu_s.map(of_lamp);
    let altitude_m = 0.05 * least_scale_height_m(air) + 0.02 * place.altitude_m.abs();
    Bounds {
        near: [altitude_step_m(air, place.altitude_m), SUN_STEP.0, SUN_STEP.0],
        far: [altitude_m.max(1e-2), sun, moon],
    }
}

/// Tables of an observer, and the bind group with which shaders look them up (`shaders/sky/lookup.wgsl`, group 1).
///
/// One thread at a time. Call [`SkyVolume::prepare`] once a submission, because it writes uniforms through the queue.
pub struct SkyVolume {
    device: Arc<Device>,
    kit: Arc<Kit>,
    tables: Layered,
    /// Bind groups for each lamp: of the sky, and of the air.
    observer_groups: [[wgpu::BindGroup; 2]; LAMPS],
    observers: [[wgpu::Buffer; 2]; LAMPS],
    view: wgpu::Buffer,
    view_group: wgpu::BindGroup,
    /// Light of the tables, which is bound in `view_group`.
    light: wgpu::TextureView,
    drawn: [Option<DrawnFor>; LAMPS],
    /// Fade, created when tables fade in for the first time.
    fade: Option<Box<Fade>>,
    ahead: Ahead,
    written: ViewUniform,
    discs: u32,
    disc_depths: [Option<DiscDepth>; LAMPS],
}

impl SkyVolume {
    /// Creates an observer's textures for `tables`; nothing is drawn yet.
    ///
    /// # Errors
    /// GPU faults.
    pub fn new(tables: &SkyTables) -> Result<Self> {
        let (device, kit) = (tables.device.clone(), tables.kit().clone());
        let observed = Layered::new(&device, &kit.settings);
        let zero = bytes_of(&ObserverUniform::zeroed()).to_vec();
        let observers = [(); LAMPS].map(|_| [(); 2].map(|_| uniform_buffer(&device, "sky observer", &zero)));
        let group = |b: &wgpu::Buffer| bind(&device, &kit.observer_layouts.observer, &[b.as_entire_binding()]);
        let observer_groups = observers.each_ref().map(|of_lamp| of_lamp.each_ref().map(group));
        let written = ViewUniform::zeroed();
        let view = uniform_buffer(&device, "sky view", bytes_of(&written));
        let view_group = view_group(&kit, &view, [&observed.whole, &tables.light.view]);
        device.check_made()?;
        let light = tables.light.view.clone();
        Ok(Self {
            device,
            kit,
            tables: observed,
            observer_groups,
            observers,
            view,
            view_group,
            light,
            drawn: [None; LAMPS],
            fade: None,
            ahead: Ahead::default(),
            written,
            discs: 0,
            disc_depths: [None; LAMPS],
        })
    }

    /// Whether this volume was created for `tables`.
    pub(super) fn is_of(&self, tables: &SkyTables) -> bool {
        self.light == tables.light.view
    }

    /// Returns the settings of the tables for which this volume was created.
    pub fn settings(&self) -> &SkySettings {
        &self.kit.settings
    }

    /// Number of lamps that light the air, as of the last [`SkyVolume::prepare`].
    pub(crate) fn lamp_count(&self) -> u32 {
        self.written.lamp_count
    }

    /// Number of lamps with a drawn disc: those that light the air, then those of which only the disc is drawn.
    pub(crate) fn disc_count(&self) -> u32 {
        self.discs
    }

    /// Layout of group 1 of every shader that includes `sky/lookup.wgsl`; equal for all volumes of a device.
    pub fn view_layout(device: &Device) -> wgpu::BindGroupLayout {
        view_layout(device)
    }

    /// Layout with which this volume's bind group was created.
    pub fn layout(&self) -> &wgpu::BindGroupLayout {
        &self.kit.observer_layouts.view
    }

    /// Bind group 1 of every shader that includes `sky/lookup.wgsl`.
    pub fn bind_group(&self) -> &wgpu::BindGroup {
        &self.view_group
    }

    /// Updates the tables and returns whether anything had to be drawn. Nothing is drawn if altitude, sun and air are
    /// unchanged: turning the camera is free.
    ///
    /// # Errors
    /// [`crate::Status::InvalidArgument`] for an observer out of range; GPU faults.
    pub fn prepare(
        &mut self,
        encoder: &mut wgpu::CommandEncoder,
        tables: &SkyTables,
        observer: &Observer,
    ) -> Result<bool> {
        observer.check()?;
        let air = tables.air();
        let planet = tables.planet().copied().unwrap_or_else(super::Planet::earth);
        // Lamps that light the air come first, and only they have tables. All tables have the same altitude.
        let lit = |in_air: bool| observer.lamps.iter().flatten().filter(move |l| l.is_lit() && l.lights_air == in_air);
        let lamps = || lit(true);
        let discs = || lit(true).chain(lit(false));
        let mu_s: [Option<f64>; LAMPS] = std::array::from_fn(|i| lamps().nth(i).map(|l| l.toward[2]));
        let drawn = match tables.shown().cloned() {
            Some(shown) => self.update_lamps(encoder, tables, &shown, observer, mu_s)?,
            None => false,
        };
        let altitude_m = observer.altitude_m.max(0.0);
        let dims = DimsUniform::of(&self.kit.settings);
        let mut view = ViewUniform {
            air,
            dims,
            edges: EdgesUniform::of(&air, altitude_m),
            sky_above: dims.sky_above(),
            altitude: altitude_m as f32,
            lamp_count: lamps().count() as u32,
            refraction: observer.refraction as f32,
            march_panels: self.kit.settings.march_cells.div_ceil(4),
            lamps: [LampUniform::zeroed(); LAMPS],
        };
        for (i, lamp) in discs().enumerate() {
            view.lamps[i] = lamp.uniform(&planet, LAYERS * i as u32);
            let (sine, radius) = (lamp.toward[2], lamp.angular_radius);
            let kept = self.disc_depths[i].filter(|d| !observer.exact && d.serves(&air, altitude_m, sine, radius));
            let depth = match kept {
                Some(depth) => depth,
                None => *self.disc_depths[i].insert(DiscDepth::new(&air, altitude_m, sine, radius)),
            };
            depth.write(&mut view.lamps[i]);
        }
        self.discs = discs().count() as u32;
        if view != self.written {
            self.device.write_buffer(&self.view, 0, bytes_of(&view));
            self.written = view;
        }
        Ok(drawn)
    }

    /// Draws the lamps' tables, except those that are up to date. Returns whether any was drawn.
    fn update_lamps(
        &mut self,
        encoder: &mut wgpu::CommandEncoder,
        tables: &SkyTables,
        shown: &TableSet,
        observer: &Observer,
        mu_s: [Option<f64>; LAMPS],
    ) -> Result<bool> {
        let altitude_m = observer.altitude_m;
        let altitude_step_m = altitude_step_m(&tables.air(), altitude_m);
        let serves = |drawn: &Option<DrawnFor>, mu_s: f64| {
            let step = if tables.is_busy() { SUN_STEP.1 } else { SUN_STEP.0 };
            drawn.filter(|d| match observer.exact {
                true => d.altitude_m == altitude_m && d.mu_s == mu_s,
                false => (d.altitude_m - altitude_m).abs() <= altitude_step_m && (d.mu_s - mu_s).abs() <= step,
            })
        };
        let lamps = || mu_s.iter().enumerate().filter_map(|(i, mu_s)| mu_s.map(|mu_s| (i, mu_s)));
        let fading = tables.fading();
        let mut drawn = false;
        if observer.exact || fading.is_some() || tables.is_busy() || self.kit.settings.model == SkyModel::BruteForce {
            self.ahead.stop();
        } else {
            drawn = self.follow(encoder, tables, shown, &ObserverPlace { altitude_m, mu_s })?;
        }
        for drawn in &mut self.drawn {
            // A lamp's tables are up to date if they already contain the mix of two sets that is now shown.
            *drawn = drawn.map(|d| match d.over.is_some() && shown.mixes == d.over.map(|over| (d.set, over)) {
                true => DrawnFor { set: shown.id, over: None, ..d },
                false => d,
            });
        }
        // If one lamp's tables are out of date all are drawn, because they share the altitude.
        let moved = lamps().any(|(i, mu_s)| serves(&self.drawn[i], mu_s).is_none());
        for (i, mu_s) in lamps() {
            let now = DrawnFor { set: shown.id, over: None, altitude_m, mu_s };
            let kept = self.drawn[i].filter(|_| !moved);
            let over = fading.map(|(next, share)| (next.id, share));
            match kept {
                Some(d) if (d.set, d.over) == (shown.id, over.filter(|(_, share)| *share > 0.0)) => {}
                // A fade is complete: the tables that faded in become the shown ones.
                Some(d)
                    if over.is_none()
                        && d.over.is_some_and(|(id, _)| id == shown.id)
                        && self.is_ready(i, &d, shown) =>
                {
                    self.mix_in(encoder, i, 1.0);
                    self.drawn[i] = Some(DrawnFor { set: shown.id, over: None, ..d });
                    drawn = true;
                }
                Some(d) if d.set == shown.id && (d.over.is_none() || d.over.map(|o| o.0) == over.map(|o| o.0)) => {}
                _ => {
                    write_observer(tables, &self.observers[i], &now);
                    self.march(encoder, shown, i, false)?;
                    self.drawn[i] = Some(now);
                    drawn = true;
                }
            }
            let (Some((next, share)), Some(d)) = (fading, self.drawn[i]) else { continue };
            if !self.is_ready(i, &d, next) {
                write_observer(tables, &self.observers[i], &d);
                self.march(encoder, next, i, true)?;
                drawn = true;
            }
            if share > 0.0 && d.over != Some((next.id, share)) {
                if let (None, Some(fade)) = (d.over, &self.fade) {
                    self.tables.copy(encoder, i, &fade.first);
                }
                self.mix_in(encoder, i, share);
                drawn = true;
                self.drawn[i] = Some(DrawnFor { over: Some((next.id, share)), ..d });
            }
        }
        Ok(drawn)
    }

    /// Whether the tables that fade in for lamp `i` are those of `set`, drawn for the altitude and sun of `d`.
    fn is_ready(&self, i: usize, d: &DrawnFor, set: &TableSet) -> bool {
        let wanted = DrawnFor { set: set.id, over: None, ..*d };
        self.fade.as_ref().is_some_and(|f| f.drawn[i] == Some(wanted))
    }

    /// Mixes the tables that fade in, with their share, into lamp `i`'s tables.
    fn mix_in(&self, encoder: &mut wgpu::CommandEncoder, i: usize, share: f32) {
        let Some(fade) = &self.fade else { return };
        let [first, next] = &fade.groups;
        for k in layers_of(i) {
            self.kit.fades.between(encoder, &self.tables.layers[k], [&first[k], &next[k]], share);
        }
    }

    /// Follows an observer that moves: draws a slice of the tables ahead of it. If the present tables are too far from
    /// the observer's place, mixes new ones from the tables of two places (`course.rs`), one behind and one ahead of
    /// the observer. Returns whether anything was drawn.
    fn follow(
        &mut self,
        encoder: &mut wgpu::CommandEncoder,
        tables: &SkyTables,
        shown: &TableSet,
        place: &ObserverPlace,
    ) -> Result<bool> {
        if self.ahead.set != Some(shown.id) {
            self.ahead.stop();
            self.ahead.set = Some(shown.id);
        }
        let bounds = bounds(&tables.air(), place);
        let now = self.drawn_at(place, shown);
        let step = self.ahead.course.follow(*place, now, &bounds, self.kit.settings.observer_size().1);
        if let Some((coming, rows)) = &step.slice {
            self.draw_slice(encoder, tables, shown, (coming, rows))?;
        }
        let drawn = step.slice.is_some();
        let Some(way) = &mut self.ahead.tables else { return Ok(drawn) };
        if step.turns {
            way.turn();
        }
        let lamps = || place.mu_s.iter().enumerate().filter_map(|(i, mu_s)| mu_s.map(|mu_s| (i, mu_s)));
        if step.copies {
            lamps().for_each(|(i, _)| self.tables.copy(encoder, i, way.first()));
        }
        let Some(share) = step.share.filter(|_| !now.is_some_and(|now| now.is_near(place, &bounds))) else {
            return Ok(drawn);
        };
        for (i, mu_s) in lamps() {
            for k in layers_of(i) {
                self.kit.fades.between(encoder, &self.tables.layers[k], way.pair(k), share);
            }
            self.drawn[i] = Some(DrawnFor { set: shown.id, over: None, altitude_m: place.altitude_m, mu_s });
        }
        Ok(true)
    }

    /// Place of the present tables, if there are tables for all lamps of `place` and none of them is fading.
    fn drawn_at(&self, place: &ObserverPlace, shown: &TableSet) -> Option<ObserverPlace> {
        let mut found = None::<ObserverPlace>;
        for (i, _) in place.mu_s.iter().enumerate().filter(|(_, mu_s)| mu_s.is_some()) {
            let d = self.drawn[i].filter(|d| d.set == shown.id && d.over.is_none())?;
            let there = found.get_or_insert(ObserverPlace { altitude_m: d.altitude_m, mu_s: [None; LAMPS] });
            there.mu_s[i] = Some(d.mu_s);
        }
        found
    }

    /// Draws rows of the tables of a place ahead.
    fn draw_slice(
        &mut self,
        encoder: &mut wgpu::CommandEncoder,
        tables: &SkyTables,
        shown: &TableSet,
        (place, rows): (&ObserverPlace, &Range<u32>),
    ) -> Result<()> {
        let way = self.ahead.tables.get_or_insert_with(|| Box::new(WayTables::new(&self.device, &self.kit)));
        for (i, mu_s) in place.mu_s.iter().enumerate().filter_map(|(i, mu_s)| mu_s.map(|mu_s| (i, mu_s))) {
            let drawn_for = DrawnFor { set: shown.id, over: None, altitude_m: place.altitude_m, mu_s };
            write_observer(tables, &way.observers[i], &drawn_for);
            let layers = &way.coming().layers[layers_of(i)];
            draw_observer(&self.kit, encoder, shown, layers, &way.observer_groups[i], Some(rows))?;
        }
        Ok(())
    }

    /// Draws lamp `i`'s tables from a planet's tables: for look-ups, or with `is_next` for a fade.
    fn march(&mut self, encoder: &mut wgpu::CommandEncoder, set: &TableSet, i: usize, is_next: bool) -> Result<()> {
        if self.kit.settings.model == SkyModel::BruteForce {
            return Ok(());
        }
        let layers = if is_next {
            let fade = self.fade.get_or_insert_with(|| Box::new(Fade::new(&self.device, &self.kit)));
            fade.drawn[i] = self.drawn[i].map(|d| DrawnFor { set: set.id, over: None, ..d });
            &fade.next.layers
        } else {
            &self.tables.layers
        };
        draw_observer(&self.kit, encoder, set, &layers[layers_of(i)], &self.observer_groups[i], None)
    }
}

/// Indices of the layers of lamp `i`.
fn layers_of(i: usize) -> Range<usize> {
    LAYERS as usize * i..LAYERS as usize * (i + 1)
}

/// Writes the blocks of the passes that draw a lamp's tables, of the sky and of the air.
fn write_observer(tables: &SkyTables, blocks: &[wgpu::Buffer; 2], drawn_for: &DrawnFor) {
    let edges = EdgesUniform::of(&tables.air(), drawn_for.altitude_m);
    let (altitude, mu_s) = (drawn_for.altitude_m.max(0.0) as f32, drawn_for.mu_s as f32);
    for (is_air, buffer) in (0..).zip(blocks) {
        let uniform = ObserverUniform { altitude, mu_s, is_air, unused: 0, edges };
        tables.device.write_buffer(buffer, 0, bytes_of(&uniform));
    }
}

/// Draws a lamp's tables into two layers: whole, or only `rows`. Slices must be drawn in order, and the one that begins
/// at row 0 clears the layers.
fn draw_observer(
    kit: &Kit,
    encoder: &mut wgpu::CommandEncoder,
    set: &TableSet,
    layers: &[wgpu::TextureView],
    groups: &[wgpu::BindGroup; 2],
    rows: Option<&Range<u32>>,
) -> Result<()> {
    let (passes, s) = (kit.observer_passes()?, &kit.settings);
    let load = match rows {
        Some(rows) if rows.start > 0 => wgpu::LoadOp::Load,
        _ => wgpu::LoadOp::Clear(wgpu::Color::BLACK),
    };
    let ops = wgpu::Operations { load, store: wgpu::StoreOp::Store };
    let layer = |k: usize| {
        Some(wgpu::RenderPassColorAttachment { view: &layers[k], depth_slice: None, resolve_target: None, ops })
    };
    let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
        label: Some("sky of an observer"),
        color_attachments: &[layer(0), layer(1)],
        ..Default::default()
    });
    if let Some(rows) = rows {
        pass.set_scissor_rect(0, rows.start, s.observer_size().0, rows.len() as u32);
    }
    let places = [(s.sky_corner(), s.sky_size()), ((0, 0), s.air_size())];
    for ((pipeline, group), (corner, size)) in [&passes.sky, &passes.air].into_iter().zip(groups).zip(places) {
        let [x, y, width, height] = [corner.0, corner.1, size.0, size.1].map(|v| v as f32);
        pass.set_pipeline(pipeline);
        pass.set_bind_group(0, &set.observer_group, &[]);
        pass.set_bind_group(1, group, &[]);
        pass.set_viewport(x, y, width, height, 0.0, 1.0);
        pass.draw(0..3, 0..1);
    }
    Ok(())
}

/// Creates the bind group for look-ups: the observer's sky and air, and the planet's light.
fn view_group(kit: &Kit, view: &wgpu::Buffer, [tables, light]: [&wgpu::TextureView; 2]) -> wgpu::BindGroup {
    let sampler = wgpu::BindingResource::Sampler(&kit.builder.sampler);
    bind(&kit.device, &kit.observer_layouts.view, &[view.as_entire_binding(), tex(tables), tex(light), sampler])
}
