//! What a frame draws of weather on surfaces: nothing while it is dry.

use glam::DMat3;

use super::{Frame, FrameFlags, rain::has_maps};
use crate::{
    context::{Context, Scene},
    error::Result,
    fog::{FogKind, FogModel, reference::layer_depth_above},
    ground::{GroundUniform, Seen},
    scene::WorldKind,
    surroundings::Told,
};

/// Largest number of a half float, with room for what follows.
const MOST_UNITS: f64 = 6e4;

/// Whether there is any water to draw on surfaces.
pub(super) fn is_wet(frame: &Frame<'_>, context: &Context, scene: &Scene) -> bool {
    let cover = context.ground_cover_at(frame.camera.position, scene.conditions.surface);
    let terrain = context.has_wet_terrain();
    let glaze = glaze(context, frame, scene);
    frame.depth.is_some() && (terrain || cover.wetness > 0.0 || cover.puddles > 0.0 || glaze > 0.0)
}

/// Share of level ground under clear ice: as the freezing rain of the moment keeps it.
fn glaze(context: &Context, frame: &Frame<'_>, scene: &Scene) -> f64 {
    let c = context.with_areas(frame.camera.position, context.time_s(), scene.conditions);
    let falls = (c.precipitation.rain_mm_h + c.precipitation.drizzle_mm_h) * c.precipitation.freezing > 0.0;
    if falls { c.surface.ice } else { 0.0 }
}

/// Rounding of a depth format: absolute, and over the value. The rasteriser's own counts as two steps of a float.
pub(super) fn rounding(depth: &wgpu::Texture) -> [f64; 2] {
    use wgpu::TextureFormat as F;
    let float = 2f64.powi(-22);
    match depth.format() {
        F::Depth16Unorm => [1.0 / 65_535.0, float],
        F::Depth24Plus | F::Depth24PlusStencil8 => [1.0 / 16_777_215.0, float],
        _ => [0.0, float],
    }
}

/// From the axes of the host's normals to east, north, up, and how its numbers are read: in normalised formats they are half the
/// normal and a half.
fn normals(frame: &Frame<'_>, scene: &Scene) -> (DMat3, [f32; 2]) {
    let from_eye = scene.world_to_enu * frame.camera.rotation().transpose();
    let turned = if frame.flags.has(FrameFlags::NORMALS_IN_EYE_SPACE) { from_eye } else { scene.world_to_enu };
    let signed = frame.normals.is_some_and(|n| super::uniform::is_float(n.format()));
    (turned, if signed { [1.0, 0.0] } else { [2.0, -1.0] })
}

/// The block of `shaders/ground/uniform.wgsl`.
pub(super) fn uniform(
    frame: &Frame<'_>,
    color: &wgpu::Texture,
    context: &Context,
    scene: &Scene,
    fog: &FogModel,
) -> Result<GroundUniform> {
    let sheltered = !context.shelters().is_empty() || has_maps(context);
    let (width, height) = (f64::from(color.width()), f64::from(color.height()));
    let down = if frame.origin_bottom_left { 2.0 } else { -2.0 };
    let seen = Seen {
        scene,
        cover: &context.ground_cover_at(frame.camera.position, scene.conditions.surface),
        falling: context.with_areas(frame.camera.position, context.time_s(), scene.conditions).precipitation,
        glaze: glaze(context, frame, scene),
        hollows: context.hollows(),
        position: frame.camera.position,
        time_s: context.time_s(),
        curvature: match context.world().kind {
            WorldKind::Flat => 0.0,
            WorldKind::Tangent | WorldKind::Ecef => 1.0 / (context.planet_radius_m() + scene.place.altitude_m),
        },
        // The older laws have no height: what they say of the light above the ground is nothing.
        fog_depth: match fog.kind {
            FogKind::Slab | FogKind::Exponential => layer_depth_above(fog, scene.place.altitude_m),
            _ => 0.0,
        },
        pixel: [2.0 / width, down / height],
        depth_rounding: frame.depth.map_or([0.0; 2], rounding),
        most_cd_m2: MOST_UNITS * frame.cd_m2_per_unit,
        terrain: context.drawn_terrain(),
        surface_class: context.default_surface_class(),
        normals: normals(frame, scene),
        wind_m_s: sheltered.then(|| context.carrying_wind(context.time_s())).transpose()?,
    };
    Ok(seen.uniform())
}

/// What the host has told of the world round the camera. `near`: fall speed of the slowest of what is drawn, m/s, and how
/// far off any of it is, m; `exposure`: what it is exposed by.
pub(super) fn around<'a>(
    context: &'a Context,
    scene: &Scene,
    frame: &Frame<'_>,
    near: (f64, f64),
    exposure: f64,
) -> Result<Told<'a>> {
    Ok(Told {
        shelters: context.shelters(),
        maps: context.occluder_maps(),
        lights: context.lights(),
        eye: frame.camera.position,
        to_enu: scene.world_to_enu,
        time_s: context.time_s(),
        wind_m_s: context.carrying_wind(context.time_s())?,
        slowest_m_s: near.0,
        reach_m: near.1,
        exposure,
    })
}
