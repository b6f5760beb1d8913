//! Flashes of a view: lines of light in the layer in front of the picture, and their glow in the composition.

use std::f64::consts::PI;

use glam::{DVec2, DVec3};

use super::{
    glow::from_clouds_cd,
    held::HeldLightning,
    light::{COLOR, Course, Span},
    limit,
    passes::{ChannelPass, FORMAT, MOST_PARTS},
    query::{LIGHT_REACH_M, TAKES},
    sources::LightSource,
    storms::{SQUARE_M, Storms},
    strike::{CloudSpan, Strike},
    uniforms::{ChannelUniform, PartInstance},
};
use crate::{
    error::Result,
    gpu::Device,
    moment::{FlashLight, SceneMoment},
    scene::{FlashLamp, MAX_FLASH_LAMPS},
    stage::{
        Contribution, DrawContext, DrawnEffect, Exchange, FlashBlock, FlashUniform, FrameContext, MergedFrame, Output,
        Outputs, Recording, Stages, Texture, Traits, flag,
    },
    weather::Conditions,
};

/// Exposure of a frame without a predecessor, s.
const FRAME_S: f64 = 1.0 / 60.0;
/// Longest interval between two frames over which the second one averages the light, s. A longer interval counts as a
/// jump of the host's time.
const LONGEST_FRAME_S: f64 = 0.5;
/// Illuminance at the eye below which a light source of a flash is left out, lux. Without any source no flash is drawn.
const FAINTEST_LUX: f64 = 1e-7;
/// Illuminance at the eye, as a share of all other light on the ground, below which a light source of a flash is left
/// out. The larger of this limit and [`FAINTEST_LUX`] applies.
const FAINTEST_SHARE: f64 = 1e-5;

/// Interval of time over which a frame averages the light of flashes.
#[derive(Clone, Copy)]
struct FrameTime {
    /// Number of the frame.
    frame_id: u64,
    /// Interval, s of simulation time.
    span: Span,
}

/// A flash that shines, placed in the world under the host's settings.
struct Shining {
    /// Number of the flash.
    id: u64,
    /// Revisions of the lightning and of the surroundings for which `strike` was placed.
    revisions: [u64; 2],
    /// Flash in the host's world.
    strike: Strike,
    /// Whether the flash shines in the present frame.
    is_used: bool,
}

/// Light of the flashes in a frame.
struct Lit {
    /// Interval over which the light is averaged.
    span: Span,
    /// Course of each flash's light over time.
    course: Course,
    /// Sources, the brightest first, each with its position relative to the camera, m (east, north, up).
    sources: [(LightSource, DVec3); MAX_FLASH_LAMPS],
    /// Number of sources.
    count: usize,
    /// Position of the camera in the host's world, m.
    eye: DVec3,
    /// Altitude of the camera, m.
    eye_m: f64,
    /// Whether a part of an open channel shines.
    has_line: bool,
}

/// Flashes of a view.
#[derive(Default)]
pub(crate) struct LightningView {
    /// Whether flashes are possible.
    storms: bool,
    /// Interval of the last frame.
    frame: Option<FrameTime>,
    /// Flashes that shine in the present frame.
    shining: Vec<Shining>,
    /// Sources found in the present frame with their illuminance at the eye, lux; scratch memory.
    found: Vec<(f64, LightSource)>,
    /// Light of the present frame; `None` without a flash.
    lit: Option<Lit>,
    /// Pass that draws channels, created at first use.
    passes: Option<Box<ChannelPass>>,
    /// Parts to draw; scratch memory.
    parts: Vec<PartInstance>,
    /// Own layer in front of the picture, for draws in which precipitation has none.
    layer: Option<(wgpu::Texture, wgpu::TextureView)>,
    /// Layer to draw into, and whether it has content already.
    target: Option<(wgpu::TextureView, bool)>,
}

/// Returns the interval over which a frame averages light: since the previous frame, or a sixtieth of a second if there
/// is none, if time has jumped, or if nothing of earlier frames may show (`is_pure`). While time stands still, frames
/// keep the same interval.
fn frame_time(last_frame: Option<FrameTime>, frame_id: u64, now_s: f64, is_pure: bool) -> FrameTime {
    let alone = Span { from_s: now_s - FRAME_S, until_s: now_s };
    let span = match last_frame {
        Some(b) if b.span.until_s == now_s && (b.frame_id == frame_id || !is_pure) => b.span,
        Some(b) if !is_pure && (0.0..=LONGEST_FRAME_S).contains(&(now_s - b.span.until_s)) => {
            Span { from_s: b.span.until_s, until_s: now_s }
        }
        _ => alone,
    };
    FrameTime { frame_id, span }
}

impl LightningView {
    /// Finds the flashes that shine in a span, and drops the others.
    fn find(&mut self, storms: &Storms<'_>, now: &SceneMoment<'_>, span: &Span, course: Course) {
        let near = DVec2::from_array(now.scene.map_m);
        let revisions = [storms.held.revision, storms.world.surroundings_revision];
        self.shining.iter_mut().for_each(|s| s.is_used = false);
        let shining = &mut self.shining;
        storms.visit((near, LIGHT_REACH_M), Storms::begin_within(span.from_s, span.until_s), |flash, by| {
            if !course.shines(flash, span) || (course == Course::Smooth && !kept(storms, near, flash.time_s)) {
                return;
            }
            let same = shining.iter_mut().find(|s| s.id == flash.id && s.revisions == revisions);
            match same {
                Some(s) => s.is_used = true,
                None => {
                    let masts = &storms.held.settings.masts;
                    let strike = Strike::new(storms.world, masts, *flash, by.map(|t| t.position));
                    shining.push(Shining { id: flash.id, revisions, strike, is_used: true });
                }
            }
        });
        self.shining.retain(|s| s.is_used);
    }

    /// Finds the sources of light, the brightest first, and makes them the moment's lamps.
    fn light(&mut self, now: &SceneMoment<'_>, span: Span, course: Course) {
        self.found.clear();
        let taken_per_m = TAKES * now.scene.conditions.extinction_per_m;
        let faintest_lux = FAINTEST_LUX.max(FAINTEST_SHARE * now.scene.ground.total_lux);
        for shining in &self.shining {
            for source in shining.strike.sources(&span, course).iter() {
                let way_m = (now.eye - source.position).length().max(1.0);
                let lux = source.flux_lm / (4.0 * PI * way_m * way_m) * (-taken_per_m * way_m).exp();
                if lux > faintest_lux {
                    self.found.push((lux, *source));
                }
            }
        }
        if self.found.is_empty() {
            return;
        }
        self.found.sort_by(|a, b| b.0.total_cmp(&a.0));
        let mut lit = Lit {
            span,
            course,
            sources: [(LightSource::default(), DVec3::ZERO); MAX_FLASH_LAMPS],
            count: self.found.len().min(MAX_FLASH_LAMPS),
            eye: now.eye,
            eye_m: now.scene.place.altitude_m,
            has_line: self.found.iter().any(|(_, s)| !s.is_hidden()),
        };
        let mut light = FlashLight { count: lit.count, ..FlashLight::default() };
        for (i, (_, source)) in self.found.iter().enumerate().take(MAX_FLASH_LAMPS) {
            let position = now.scene.world_to_enu * (source.position - now.eye);
            lit.sources[i] = (*source, position);
            let flux_lm = COLOR.map(|c| c * source.flux_lm);
            light.lamps[i] = FlashLamp {
                position,
                flux_lm,
                radius_m: source.radius_m,
                down_share: source.is_hidden().then_some(source.down_share),
            };
        }
        self.lit = Some(lit);
        // Each call has a new moment, so its flash light is not set yet.
        let _ = now.flash.set(light);
    }

    /// Returns the view's own layer, created anew if the size of `color` has changed.
    fn layer(&mut self, device: &Device, color: &wgpu::Texture) -> wgpu::TextureView {
        let size = wgpu::Extent3d { depth_or_array_layers: 1, ..color.size() };
        if self.layer.as_ref().is_some_and(|(texture, _)| texture.size() != size) {
            self.layer = None;
        }
        let made = self.layer.get_or_insert_with(|| {
            let texture = device.device.create_texture(&wgpu::TextureDescriptor {
                label: Some("flashes"),
                size,
                mip_level_count: 1,
                sample_count: 1,
                dimension: wgpu::TextureDimension::D2,
                format: FORMAT,
                usage: wgpu::TextureUsages::RENDER_ATTACHMENT | wgpu::TextureUsages::TEXTURE_BINDING,
                view_formats: &[],
            });
            let view = texture.create_view(&Default::default());
            (texture, view)
        });
        made.1.clone()
    }

    /// Gathers the parts of all open channels, relative to the camera.
    fn gather_parts(&mut self, context: &DrawContext<'_>) {
        self.parts.clear();
        let Some(lit) = &self.lit else { return };
        let to_enu = context.now.scene.world_to_enu;
        let relative = |p: DVec3| (to_enu * (p - lit.eye)).as_vec3().to_array();
        for shining in &self.shining {
            shining.strike.each_part(&lit.span, lit.course, |part| {
                let intensity = part.flux_lm * part.open / (4.0 * PI) * context.target.exposure;
                if part.open > 1e-3 && self.parts.len() < MOST_PARTS {
                    let [from, to] = part.ends.map(relative);
                    self.parts.push(PartInstance { from, intensity: intensity as f32, to, pad: 0.0 });
                }
            });
        }
    }
}

/// Whether a flash is drawn under the limit on flicker. The choice is among all flashes near the map's square below the
/// camera.
fn kept(storms: &Storms<'_>, near_m: DVec2, time_s: f64) -> bool {
    let middle = ((near_m / SQUARE_M).floor() + 0.5) * SQUARE_M;
    let mut times = Vec::new();
    let from_s = limit::epoch_s(time_s);
    let reach_m = LIGHT_REACH_M + SQUARE_M;
    storms.visit((middle, reach_m), (from_s, from_s + limit::EPOCH_S), |flash, _| times.push(flash.time_s));
    times.sort_by(f64::total_cmp);
    limit::is_drawn(time_s, &times)
}

/// Returns the scattering coefficient of the air around a camera, 1/m: air, haze, fog at its height, and precipitation
/// below the clouds.
fn scattering_per_m(c: &Conditions, altitude_m: f64) -> f64 {
    let height = altitude_m - c.air.station_altitude_m;
    let thin = |scale: f64| (-height.max(0.0) / scale.max(1.0)).exp();
    let air = c.air.rayleigh_extinction_per_m * thin(c.air.rayleigh_scale_height_m);
    let haze = c.aerosol.extinction_per_m * thin(c.aerosol.scale_height_m);
    let thinned = ((c.fog.top_m - height.max(0.0)) / c.fog.softness_m.max(1.0)).clamp(0.0, 1.0);
    let fog = if height.max(0.0) >= c.fog.base_m { c.fog.extinction_per_m * c.fog.coverage * thinned } else { 0.0 };
    air + haze + fog + c.precipitation.extinction_per_m() * c.below_cloud(altitude_m)
}

impl Lit {
    /// Creates the uniforms of the composition's glow.
    fn block(&self, c: &Conditions) -> FlashBlock {
        let clouds = CloudSpan::of(c);
        // An eye below the clouds sees the base, one above them the top. Inside a cloud the nearer of the two is taken.
        let from_below = clouds.is_none_or(|s| self.eye_m < 0.5 * (s.base_m + s.top_m));
        let face_m = clouds.map_or(0.0, |s| if from_below { s.base_m } else { s.top_m });
        let cover = c.cloud_slabs().fold(1.0, |clear, s| clear * (1.0 - s.cover));
        let mut block = FlashBlock {
            color: COLOR.map(|v| v as f32),
            count: self.count as u32,
            plane: (face_m - self.eye_m) as f32,
            cover: if clouds.is_some() { (1.0 - cover) as f32 } else { 0.0 },
            haze: (TAKES * (c.air.rayleigh_extinction_per_m + c.aerosol.extinction_per_m)) as f32,
            scattering: scattering_per_m(c, self.eye_m) as f32,
            sources: Default::default(),
        };
        for (uniform, (source, position)) in block.sources.iter_mut().zip(&self.sources[..self.count]) {
            let height = (position.z - (face_m - self.eye_m)).abs().max(30.0);
            *uniform = FlashUniform {
                position: position.as_vec3().to_array(),
                clouds: from_clouds_cd(source, from_below) as f32,
                air: if source.is_hidden() { 0.0 } else { source.intensity_cd(DVec3::ZERO) as f32 },
                radius: source.radius_m.max(10.0) as f32,
                height: height as f32,
                pad: 0.0,
            };
        }
        block
    }
}

impl DrawnEffect for LightningView {
    fn gathers(&self) -> Exchange {
        Exchange { gives: &[Output::Flashes], ..Exchange::NONE }
    }

    fn composes(&self) -> Exchange {
        Exchange { needs: &[Output::Rain, Output::Snow], ..Exchange::NONE }
    }

    /// Finds the flashes that shine in a frame, and makes them known to the surfaces that they light
    /// ([`SceneMoment::flash_lamps`]).
    fn gather(&mut self, context: &FrameContext<'_>, _given: &mut Outputs) -> Result<()> {
        let (now, held) = (context.now, context.held.of::<HeldLightning>()?);
        let time = frame_time(self.frame, context.frame.frame_id, now.time_s, context.frame.is_pure());
        self.frame = Some(time);
        (self.lit, self.target) = (None, None);
        let storms = Storms { world: context.world, held };
        let (from_s, until_s) = Storms::begin_within(time.span.from_s, time.span.until_s);
        self.storms = !storms.is_quiet(from_s, until_s);
        if !self.storms {
            self.shining.clear();
            return Ok(());
        }
        let course = if held.settings.limits_flicker { Course::Smooth } else { Course::Natural };
        self.find(&storms, now, &time.span, course);
        self.light(now, time.span, course);
        Ok(())
    }

    fn stages(&self) -> Stages {
        match &self.lit {
            Some(lit) if lit.has_line => Stages::BACKGROUND.with(Stages::MEDIUM).with(Stages::PARTICLES),
            Some(_) => Stages::BACKGROUND.with(Stages::MEDIUM),
            None => Stages(0),
        }
    }

    fn compose(&mut self, context: &DrawContext<'_>, given: &Outputs, added: &mut Contribution) -> Result<()> {
        added.constant("FLASH", flag(self.storms), flag(self.lit.is_some()));
        let Some(lit) = &self.lit else { return Ok(()) };
        let traits = Traits { is_fine: true, ..Traits::default() };
        added.set_traits(traits, traits);
        let has_line = lit.has_line && context.stages.has(Stages::PARTICLES);
        added.set_flashes(lit.block(&context.now.scene.conditions));
        if has_line {
            // If precipitation has a layer already, the lines are drawn into that layer after the precipitation.
            let over = given.before.is_some();
            let view = given.before.clone().unwrap_or_else(|| self.layer(context.device, context.picture()));
            added.set_texture(Texture::Before, Some(view.clone()));
            self.target = Some((view, over));
        }
        Ok(())
    }

    /// Draws the open channels into the layer in front of the picture.
    fn draw(
        &mut self,
        context: &DrawContext<'_>,
        merged: &MergedFrame<'_>,
        recording: &mut Recording<'_>,
    ) -> Result<()> {
        let Some((target, over)) = self.target.take() else { return Ok(()) };
        self.gather_parts(context);
        let size = context.picture().size();
        let block = ChannelUniform::new(&context.clip(), [size.width, size.height]);
        let passes = self.passes.get_or_insert_with(|| Box::new(ChannelPass::new(recording.device, recording.blocks)));
        passes.draw(recording, (&block, &self.parts), merged, context.frame.depth_layer(), (&target, over))?;
        recording.passes += 1;
        Ok(())
    }

    fn bytes(&self) -> u64 {
        let layer = self.layer.as_ref().map_or(0, |(t, _)| 8 * u64::from(t.width()) * u64::from(t.height()));
        layer + self.passes.as_ref().map_or(0, |passes| passes.bytes())
    }

    fn forget_picture(&mut self) {
        self.layer = None;
        self.target = None;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn frames_follow_each_other_without_a_gap_and_stand_while_time_stands() {
        let span = |before, id, now, pure| frame_time(before, id, now, pure);
        let first = span(None, 1, 10.0, false);
        assert!((first.span.until_s - first.span.from_s - FRAME_S).abs() < 1e-12);
        let second = span(Some(first), 2, 10.033, false);
        assert_eq!((second.span.from_s, second.span.until_s), (10.0, 10.033));
        // Another call of the same frame, and a frame at the same time.
        assert_eq!(span(Some(second), 2, 10.033, false).span, second.span);
        assert_eq!(span(Some(second), 3, 10.033, false).span, second.span);
        // A jump, a cut, and time that goes back start a new span.
        for (now, pure) in [(11.0, false), (10.05, true), (9.0, false)] {
            let s = span(Some(second), 3, now, pure).span;
            assert!((s.from_s - (now - FRAME_S)).abs() < 1e-12 && s.until_s == now, "{now} {s:?}");
        }
    }
}
