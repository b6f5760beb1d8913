//! The map of the clouds' shadows that pictures read: a window about the camera in a plane at the station's height,
//! fixed to the air that carries the clouds, so that a frame makes only some rows of it anew. A new map is coarse at
//! first: all of it at once would cost as much as ten frames.

use glam::{DVec2, DVec3};

use super::{
    overhead::CloudLayers,
    rows::{self, MapRows, Turn},
    shadow::LOWEST,
    tables::CloudTables,
    uniforms::ShadowUniform,
};
use crate::{
    error::Result,
    gpu::{
        Device,
        bind::{self, Slot},
        blocks::{BlockView, Blocks, UniformBlock},
        flat_texture,
        pass::{self, FullscreenDesc},
    },
    moment::{Scene, SceneMoment},
    stage::{Frame, FrameFlags, flag},
    weather::smoothstep,
};

/// Along a side of the map.
const TEXELS: u32 = 512;
/// Metres a texel.
const TEXEL_M: f64 = 40.0;
/// Along a side of the coarse map that a new one begins as: as many texels as a frame's rows have.
const COARSE: u32 = 64;
/// Rows refreshed in a frame, once as many are old, and in every frame while some of the map is coarse: sixteen frames
/// refresh all of them.
const ROWS: u32 = 32;
/// Height above the lowest base over which, in the clouds themselves, shadows go over to the mean, m: that of the
/// shaders and snippets.
const ENDS_M: f64 = 100.0;
/// Sines of the light's elevation between which shadows begin to be told apart.
const FADE_SINES: [f64; 2] = [LOWEST, 0.07];
/// Time between two frames, s, the light's turn, and the change of a layer's threshold after which nothing of the map
/// is kept.
const LEAPS: (f64, f64, f64) = (10.0, 0.01, 0.05);

/// Way of the layer that the map is fixed to, between two frames, m, after which nothing of the map is kept: another
/// layer is the lowest.
const LEAP_OF_DRIFT_M: f64 = 1500.0;
/// Changes that make the whole map old: a time, s, in which clouds change by some thousandths of their life; a turn of
/// the light, by which the shadow of a cloud 4 km up goes by a quarter of a texel; a change of a layer's threshold of
/// the least that shows; the camera's way, m, less than from where the map repeats to where shadows begin to show, and
/// as much of places of a host's map.
const AGES: (f64, f64, f64, f64) = (4.0, 0.0025, 0.004, 600.0);

/// History that a frame may take over from those before it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum HistoryUse {
    Kept,
    /// Nothing; those after it may take over from it.
    Cut,
    /// Nothing: it is a pure function of view and time.
    None,
}

impl HistoryUse {
    pub fn of(frame: &Frame<'_>) -> Self {
        match frame.flags {
            flags if flags.has(FrameFlags::NO_HISTORY) => Self::None,
            flags if flags.has(FrameFlags::CUT) => Self::Cut,
            _ => Self::Kept,
        }
    }
}

/// Inputs of the map.
#[derive(Clone, Copy, PartialEq)]
pub(super) struct ShadowInputs {
    pub time_s: f64,
    pub to_light: DVec3,
    pub threshold_sum: f64,
    /// How far the layer to which it is fixed has come, m.
    pub drift_m: DVec2,
    pub camera_m: DVec2,
    /// Fingerprint of where clouds are other than their cover says ([`super::placed`]): the first number changes with
    /// the cells over areas, the second is other for another map.
    pub placed: (f64, usize),
}

/// How the map lies about a camera.
#[derive(Clone, Copy)]
pub(super) struct ShadowProjection {
    pub standing: ShadowInputs,
    /// Unit, never level.
    pub to_light: DVec3,
    plane_m: f64,
    /// Where the camera stands in the map, in its period, and its height over the plane, m.
    pub camera: DVec2,
    pub eye_m: f64,
    pub period_m: f64,
    mean: f64,
    /// How far shadows are told apart, and the height over the plane from which on they are not, m.
    pub told: f64,
    pub top_m: f64,
    /// Extinction of the air at the camera's height, 1/m, and the height over which it thins, m.
    haze: [f64; 2],
}

/// The map and the passes that make it.
pub(super) struct ShadowMap {
    pub view: wgpu::TextureView,
    pub block: UniformBlock,
    pipeline: wgpu::RenderPipeline,
    /// The clouds, which both maps are made of.
    clouds: wgpu::BindGroup,
    coarse: Coarse,
    standing: Option<ShadowInputs>,
    rows: MapRows,
    /// Rows that are still those of the coarse map.
    coarse_rows: u32,
}

/// The coarse map, the pass that makes it and the one that spreads it over the map.
struct Coarse {
    view: wgpu::TextureView,
    pipeline: wgpu::RenderPipeline,
    spread: wgpu::RenderPipeline,
    group: wgpu::BindGroup,
}

/// Returns the extinction of the air at a scene's height, 1/m, and the height over which it thins there, m.
fn haze(scene: &Scene) -> [f64; 2] {
    let (planet, h) = (&scene.planet, scene.place.altitude_m.max(0.0));
    let of = |extinction: f64, height_m: f64| (extinction * libm::exp(-h / height_m), height_m);
    let parts = [
        of(planet.rayleigh.scattering_per_m[1], planet.rayleigh.scale_height_m),
        of(planet.mie.extinction_per_m[1], planet.mie.scale_height_m),
    ];
    let sum = parts.iter().map(|(extinction, _)| extinction).sum::<f64>().max(1e-9);
    [sum, sum / parts.iter().map(|(extinction, height_m)| extinction / height_m).sum::<f64>().max(1e-12)]
}

impl ShadowProjection {
    /// Creates the projection of a moment's clouds.
    pub fn new(now: &SceneMoment<'_>, overhead: &CloudLayers) -> Self {
        let shapes = overhead.layers().iter().map(|layer| &layer.shape);
        let scene = &now.scene;
        let plane_m = scene.conditions.air.station_altitude_m;
        let light = scene.brighter();
        let drift_m = shapes.clone().next().map_or(DVec2::ZERO, |s| s.drift_m);
        let period_m = TEXEL_M * f64::from(TEXELS);
        let camera = (DVec2::from_array(scene.map_m) - drift_m) / period_m;
        let lowest_m = shapes.clone().map(|s| s.base_m).fold(f64::INFINITY, f64::min);
        Self {
            standing: ShadowInputs {
                time_s: now.time_s,
                to_light: light.direction,
                threshold_sum: shapes.map(|s| s.threshold + s.base_m / 1000.0).sum(),
                camera_m: DVec2::from_array(scene.map_m),
                drift_m,
                placed: overhead.fingerprint(),
            },
            to_light: light.direction.with_z(light.direction.z.max(LOWEST)),
            plane_m,
            camera: DVec2::new(camera.x.rem_euclid(1.0), camera.y.rem_euclid(1.0)),
            eye_m: scene.place.altitude_m - plane_m,
            period_m,
            mean: light.direct_share,
            told: smoothstep(FADE_SINES[0], FADE_SINES[1], light.direction.z),
            top_m: (lowest_m - plane_m).max(0.0) + ENDS_M,
            haze: haze(scene),
        }
    }

    fn uniform(&self) -> ShadowUniform {
        ShadowUniform {
            to_light: self.to_light.as_vec3().to_array(),
            plane: self.plane_m as f32,
            camera: self.camera.as_vec2().to_array(),
            period: self.period_m as f32,
            eye: self.eye_m as f32,
            mean: self.mean as f32,
            told: self.told as f32,
            top: self.top_m as f32,
            haze: self.haze[0] as f32,
            haze_height: self.haze[1] as f32,
            pad: [0.0; 3],
        }
    }
}

const FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::R8Unorm;

/// A map of so many texels along a side.
fn texture(device: &Device, side: u32) -> wgpu::Texture {
    let usage =
        wgpu::TextureUsages::TEXTURE_BINDING | wgpu::TextureUsages::RENDER_ATTACHMENT | wgpu::TextureUsages::COPY_SRC;
    flat_texture(&device.device, "shadows of clouds", (side, side), FORMAT, usage)
}

fn pipeline(
    device: &Device,
    (shader, entry): (&str, &str),
    layout: &wgpu::BindGroupLayout,
    constants: &[(&str, f64)],
) -> Result<wgpu::RenderPipeline> {
    let (layouts, targets) = ([layout], [FORMAT.into()]);
    let of = FullscreenDesc { shader, entry, layouts: &layouts, targets: &targets, constants, samples: 1 };
    pass::fullscreen(device, &of)
}

/// One that makes a map of so many texels along a side.
fn shadow_pipeline(
    device: &Device,
    layout: &wgpu::BindGroupLayout,
    (side, is_placed): (u32, bool),
) -> Result<wgpu::RenderPipeline> {
    let constants = [("SHADOW_TEXELS", f64::from(side)), ("CLOUD_PLACED", flag(is_placed))];
    pipeline(device, ("clouds/shadow.wgsl", "shadow"), layout, &constants)
}

impl Coarse {
    fn new(
        device: &Device,
        (shadow, is_placed): (&wgpu::BindGroupLayout, bool),
        repeating: &wgpu::Sampler,
    ) -> Result<Self> {
        let slots = [(2, Slot::Filtered), (5, Slot::Sampler)];
        let layout = bind::layout(&device.device, "coarse shadows", wgpu::ShaderStages::FRAGMENT, &slots);
        let view = texture(device, COARSE).create_view(&Default::default());
        let group = device.device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some("coarse shadows"),
            layout: &layout,
            entries: &[bind::view(2, &view), bind::sampler(5, repeating)],
        });
        Ok(Self {
            pipeline: shadow_pipeline(device, shadow, (COARSE, is_placed))?,
            spread: pipeline(
                device,
                ("clouds/shadow_spread.wgsl", "spread"),
                &layout,
                &[("SHADOW_TEXELS", f64::from(TEXELS))],
            )?,
            view,
            group,
        })
    }
}

impl ShadowMap {
    /// The texture of a map.
    pub fn texture(device: &Device) -> wgpu::Texture {
        texture(device, TEXELS)
    }

    /// Creates the map of clouds in these tables and this block, in a texture.
    pub fn new(
        (device, blocks): (&Device, &Blocks),
        tables: &CloudTables,
        (clouds, is_placed): (&BlockView, bool),
        of: &wgpu::Texture,
    ) -> Result<Self> {
        let slots = [
            (1, Slot::Uniform(size_of::<super::uniforms::CloudsUniform>())),
            (2, Slot::FilteredArray),
            (3, Slot::FilteredVolume),
            (5, Slot::Sampler),
            (7, Slot::Uniform(size_of::<ShadowUniform>())),
            (8, Slot::Filtered),
        ];
        let layout = bind::layout(&device.device, "shadows of clouds", wgpu::ShaderStages::FRAGMENT, &slots);
        let block = blocks.block(device, size_of::<ShadowUniform>());
        let solid = tables.solid.view();
        let group = device.device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some("shadows of clouds"),
            layout: &layout,
            entries: &[
                clouds.entry(1),
                bind::view(2, &tables.map),
                bind::view(3, &solid),
                bind::sampler(5, &tables.repeating),
                block.entry(7),
                bind::view(8, &tables.placed),
            ],
        });
        Ok(Self {
            view: of.create_view(&Default::default()),
            pipeline: shadow_pipeline(device, &layout, (TEXELS, is_placed))?,
            coarse: Coarse::new(device, (&layout, is_placed), &tables.repeating)?,
            clouds: group,
            block,
            standing: None,
            rows: MapRows::default(),
            coarse_rows: 0,
        })
    }

    /// Bytes of GPU memory.
    pub const BYTES: u64 = TEXELS as u64 * TEXELS as u64 + COARSE as u64 * COARSE as u64;

    /// Makes some rows anew where enough have grown old, and before them the whole map coarsely where nothing of it
    /// holds any more or the picture is cut; where a frame is a pure function of view and time, all rows. Answers the
    /// passes that it took.
    pub fn draw(&mut self, encoder: &mut wgpu::CommandEncoder, lie: &ShadowProjection, past: HistoryUse) -> u32 {
        let here = lie.standing;
        self.block.write(bytemuck::bytes_of(&lie.uniform()));
        let before = self.standing.replace(here);
        let begins = past == HistoryUse::Cut || past == HistoryUse::Kept && before.is_none_or(|b| here.leaps_from(&b));
        if begins {
            self.coarse_rows = TEXELS;
        }
        let turn = Turn {
            rests: past != HistoryUse::Cut && before == Some(here),
            holds: past != HistoryUse::None,
            aged: before.map_or(1.0, |b| here.aged_since(&b)),
            waits: false,
            is_coarse: self.coarse_rows > 0,
        };
        let due = self.rows.due((TEXELS, ROWS), &turn);
        let Some((first, count)) = due else { return 0 };
        self.coarse_rows = self.coarse_rows.saturating_sub(count);
        if begins {
            let coarse = &self.coarse;
            rows::draw(encoder, &coarse.view, (COARSE, 0, COARSE), &coarse.pipeline, &[&self.clouds]);
            rows::draw(encoder, &self.view, (TEXELS, 0, TEXELS), &coarse.spread, &[&coarse.group]);
        }
        rows::draw(encoder, &self.view, (TEXELS, first, count), &self.pipeline, &[&self.clouds]);
        1 + 2 * u32::from(begins)
    }
}

impl ShadowInputs {
    /// Whether nothing of a map of what stood before holds.
    pub fn leaps_from(&self, before: &Self) -> bool {
        let (time_s, turn, threshold) = LEAPS;
        (self.time_s - before.time_s).abs() > time_s
            || self.to_light.dot(before.to_light) < turn.cos()
            || (self.threshold_sum - before.threshold_sum).abs() > threshold
            || self.drift_m.distance(before.drift_m) > LEAP_OF_DRIFT_M
            || self.placed.1 != before.placed.1
            || (self.placed.0 - before.placed.0).abs() > LEAP_OF_DRIFT_M
            || self.camera_m.distance(before.camera_m) > 0.1 * TEXEL_M * f64::from(TEXELS)
    }

    /// The share of a map's rows that a change from `before` makes old.
    pub fn aged_since(&self, before: &Self) -> f64 {
        let (time_s, turn, threshold, way_m) = AGES;
        let shares = [
            (self.time_s - before.time_s).abs() / time_s,
            self.to_light.distance(before.to_light) / turn,
            (self.threshold_sum - before.threshold_sum).abs() / threshold,
            self.camera_m.distance(before.camera_m) / way_m,
            (self.placed.0 - before.placed.0).abs() / way_m,
        ];
        shares.into_iter().fold(0.0, f64::max)
    }
}
