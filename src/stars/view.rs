//! The night sky of a view: a layer behind the sky's own light, made of the glow and of the points in front of it.

use std::f64::consts::PI;

use super::{
    Heavens, HeldStars, NightSky, StarPass, StarSettings, StarView,
    candidates::{STARS, stars_work},
    glow_pass::{Dusk, GlowPass},
    light::illuminance_lux,
    limits::{display_threshold_lux, threshold_lux},
    uniforms::MOST_ZENITH_DEPTH,
};
use crate::{
    almanac::Utc,
    error::Result,
    gpu::{Device, Layer, bind},
    light::luminance,
    moment::Scene,
    numerics::smoothstep,
    stage::{
        Contribution, DrawContext, DrawnEffect, Exchange, FrameBlock, FrameContext, MergedFrame, Output, Outputs,
        PutPart, Recording, Stages, Texture, Traits, flag,
    },
    world::{night_share, zenith_depth},
};

const FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Rgba16Float;
/// Elevations of the sun at which points begin to fade in and at which they are complete, degrees. By day there are no
/// points.
pub(super) const POINTS_BEGIN_DEG: (f64, f64) = (0.0, -3.0);
/// Smallest share of the night's light that clouds and fog must let through for the layer to be drawn.
pub(super) const LEAST_THROUGH: f64 = 1e-3;
/// Smallest brightness of a drawn star's brightest pixel, as a share of a display step.
const SHARE_OF_STEP: f64 = 0.25;

/// The night sky over a camera.
struct NightOverCamera {
    heavens: Heavens,
    sky: NightSky,
    zenith_depth: [f64; 3],
    /// Share of a point's light that clouds let through, times the points' fade-in.
    through: f64,
    dusk: Dusk,
    air_density: f64,
    horizon_deg: f64,
    /// Smallest illuminance of a star that an eye can see against the sky, lux.
    threshold_lux: f64,
}

/// The night sky of a view.
#[derive(Default)]
pub(crate) struct StarsView {
    settings: StarSettings,
    night: Option<NightOverCamera>,
    passes: Option<Box<(StarPass, GlowPass)>>,
    layer: Option<(wgpu::Texture, wgpu::TextureView, wgpu::TextureView)>,
    /// Whether the layer contains the night sky that was prepared last.
    is_layer_drawn: bool,
}

impl StarsView {
    fn is_there(&self, stages: Stages) -> bool {
        self.night.is_some() && stages.has(Stages::BACKGROUND)
    }

    fn layer(&mut self, device: &Device, color: &wgpu::Texture) -> &wgpu::TextureView {
        // OpenGL treats a texture as an array only if it has more than one layer, and the shader reads an array.
        let layers = if device.caps().backend == wgpu::Backend::Gl { 2 } else { 1 };
        let size = wgpu::Extent3d { depth_or_array_layers: layers, ..color.size() };
        if self.layer.as_ref().is_some_and(|(texture, ..)| texture.size() != size) {
            self.layer = None;
        }
        self.is_layer_drawn &= self.layer.is_some();
        let made = self.layer.get_or_insert_with(|| {
            let texture = device.device.create_texture(&wgpu::TextureDescriptor {
                label: Some("night sky"),
                size,
                mip_level_count: 1,
                sample_count: 1,
                dimension: wgpu::TextureDimension::D2,
                format: FORMAT,
                usage: wgpu::TextureUsages::RENDER_ATTACHMENT
                    | wgpu::TextureUsages::TEXTURE_BINDING
                    | wgpu::TextureUsages::COPY_SRC,
                view_formats: &[],
            });
            let view = Layer { texture: &texture, index: 0 }.attached_view();
            let layers = bind::as_layers(&texture);
            (texture, view, layers)
        });
        &made.2
    }
}

impl NightOverCamera {
    fn new(scene: &Scene, utc: Utc, settings: &StarSettings, sun_deg: f64) -> Result<Self> {
        let (place, air) = (&scene.place, &scene.conditions.air);
        let altitude_m = place.altitude_m.max(0.0);
        let heavens = Heavens::at(utc, place, settings)?;
        let zenith_depth = zenith_depth(&scene.planet, altitude_m).map(|depth| depth.min(MOST_ZENITH_DEPTH));
        let clouds = scene.conditions.zenith_light_over_land(altitude_m);
        let radius = scene.planet.bottom_radius_m;
        let thinner = (-altitude_m / air.rayleigh_scale_height_m).exp();
        Ok(Self {
            sky: NightSky::new(&heavens, altitude_m, zenith_depth, settings.airglow),
            heavens,
            zenith_depth,
            through: clouds.direct.clamp(0.0, 1.0) * smoothstep(-POINTS_BEGIN_DEG.0, -POINTS_BEGIN_DEG.1, -sun_deg),
            dusk: Dusk { cd_m2: scene.night_floor_cd_m2, share: night_share(&scene.sun) },
            air_density: (air.pressure_hpa / 1010.0 * 283.0 / (273.0 + air.temperature_c) * thinner).clamp(0.0, 10.0),
            horizon_deg: -(radius / (radius + altitude_m)).clamp(0.0, 1.0).acos().to_degrees(),
            threshold_lux: threshold_lux(luminance(&scene.above_fog.sky_lux) / PI),
        })
    }

    /// Upper bound of the illuminance of the brightest point at the eye, lux.
    fn brightest_lux(&self, held: &HeldStars) -> f64 {
        let planets = self.heavens.planets.iter().filter(|_| held.settings.planets).map(|p| p.magnitude);
        self.through * illuminance_lux(planets.fold(held.brightest_magnitude(), f64::min))
    }

    /// Inputs for the picture on a display whose smallest step in the dark is `step`, a share of white. With a step of
    /// 0 no star is too faint for the display.
    fn seen<'a>(&'a self, context: &'a DrawContext<'_>, step: f64) -> StarView<'a> {
        let texture = context.picture();
        let mut view = StarView {
            heavens: &self.heavens,
            clip: context.clip(),
            rays: context.target.rays,
            size: [texture.width(), texture.height()],
            y_sign: if context.frame.origin_bottom_left { -1.0 } else { 1.0 },
            zenith_depth: self.zenith_depth,
            transmittance: self.through,
            air_density: self.air_density,
            horizon_deg: self.horizon_deg,
            scale: 1.0,
            faintest_lux: self.threshold_lux,
        };
        let pixel_sr = view.pixel_sr();
        view.scale = scale(pixel_sr);
        let display = display_threshold_lux(SHARE_OF_STEP, step, context.target.exposure, pixel_sr);
        view.faintest_lux = view.faintest_lux.max(display).min(1e6);
        view
    }
}

/// Scale of the layer, units per cd/m^2, for a pixel's solid angle, sr. `shaders/stars/points.wgsl` cuts a star off at
/// 3e4, about half the largest half float. For pixels of 5e-10 sr or more, only Venus among the planets and the
/// catalogue's stars can reach this limit. Below 6e-5, half floats lose precision.
fn scale(pixel_sr: f64) -> f64 {
    256.0 * (pixel_sr / 5e-7).clamp(1e-3, 1.0)
}

impl DrawnEffect for StarsView {
    fn gathers(&self) -> Exchange {
        Exchange { needs: &[Output::FogDepth], ..Exchange::NONE }
    }

    fn composes(&self) -> Exchange {
        Exchange { gives: &[Output::Stars], ..Exchange::NONE }
    }

    fn gather(&mut self, context: &FrameContext<'_>, given: &mut Outputs) -> Result<()> {
        self.night = None;
        let scene = &context.now.scene;
        let open = (1.0 - scene.deck_cover) * (-given.fog_depth).exp();
        let elevation = scene.sun.direction.z.clamp(-1.0, 1.0).asin().to_degrees();
        if elevation >= POINTS_BEGIN_DEG.0 || open < LEAST_THROUGH || context.frame.camera.is_orthographic() {
            return Ok(());
        }
        let (held, utc) = (context.held.of::<HeldStars>()?, context.world.utc_at(context.now.time_s));
        let night = NightOverCamera::new(scene, utc, &held.settings, elevation)?;
        if night.dusk.share > 0.0 || night.brightest_lux(held) > night.threshold_lux {
            self.settings = held.settings.clone();
            self.night = Some(night);
        }
        Ok(())
    }

    fn stages(&self) -> Stages {
        if self.night.is_some() { Stages::BACKGROUND } else { Stages(0) }
    }

    fn hold(&mut self, device: &Device, color: &wgpu::Texture, stages: Stages) {
        if self.is_there(stages) {
            let _ = self.layer(device, color);
        }
    }

    fn parts(&mut self, context: &DrawContext<'_>, stages: Stages, put: &mut PutPart<'_>) {
        put(&STARS, self.is_there(stages), &[stars_work(context.pixels())]);
    }

    fn compose(&mut self, context: &DrawContext<'_>, _given: &Outputs, added: &mut Contribution) -> Result<()> {
        let (is_there, share) = (self.is_there(context.stages), context.share(&STARS, 0));
        added.constant("STARS", flag(is_there), flag(is_there && share > 0.0));
        if let Some(night) = self.night.as_ref().filter(|_| is_there) {
            let traits = Traits { is_fine: true, ..Traits::default() };
            added.set_traits(traits, traits);
            let behind = [(1.0 / night.seen(context, 0.0).scale) as f32, share];
            added.set_frame_block(FrameBlock::Stars { behind });
            let layer = self.layer(context.device, context.picture()).clone();
            added.set_texture(Texture::Behind, Some(layer));
        }
        Ok(())
    }

    /// Draws the layer behind the sky's own light: the glow, then the points. Does nothing while camera, heavens and
    /// air stay the same.
    fn draw(
        &mut self,
        context: &DrawContext<'_>,
        merged: &MergedFrame<'_>,
        recording: &mut Recording<'_>,
    ) -> Result<()> {
        let block = merged.composition.block();
        if !self.is_there(merged.composition.stages()) || block.behind[1] == 0.0 {
            return Ok(());
        }
        let (Some(night), Some((_, target, _))) = (&self.night, &self.layer) else { return Ok(()) };
        let passes = match &mut self.passes {
            Some(passes) => passes,
            none => none.insert(Box::new((StarPass::new(recording.device), GlowPass::new(recording.device, FORMAT)?))),
        };
        let (points, glow) = &mut **passes;
        // The dark end of the sRGB curve is linear with a slope of 12.92.
        let view = night.seen(context, f64::from(block.dither_step) / 12.92);
        points.prepare(recording.device, &self.settings, &view, FORMAT, None)?;
        let has_changed = glow.prepare(recording.device, &night.sky, &view, &night.dusk) || points.has_changed();
        if self.is_layer_drawn && !has_changed {
            return Ok(());
        }
        self.is_layer_drawn = true;
        let mut pass = recording.encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some("night sky"),
            color_attachments: &[Some(wgpu::RenderPassColorAttachment {
                view: target,
                depth_slice: None,
                resolve_target: None,
                ops: wgpu::Operations {
                    // The glow's sphere covers every pixel. A clear would cost as much again on a software driver.
                    load: wgpu::LoadOp::Load,
                    store: wgpu::StoreOp::Store,
                },
            })],
            ..Default::default()
        });
        glow.draw(&mut pass);
        points.draw(&mut pass);
        drop(pass);
        recording.passes += 1;
        Ok(())
    }

    fn bytes(&self) -> u64 {
        let layer = self.layer.as_ref().map_or(0, |(t, ..)| {
            8 * u64::from(t.depth_or_array_layers()) * u64::from(t.width()) * u64::from(t.height())
        });
        layer + self.passes.as_ref().map_or(0, |passes| passes.0.bytes() + passes.1.bytes())
    }

    fn forget_picture(&mut self) {
        self.layer = None;
        self.is_layer_drawn = false;
    }
}
