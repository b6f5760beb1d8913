//! Clouds of a view: a layer of radiance and transmittance, which the composition lays between sky and fog.

use glam::{DMat4, DVec2, DVec3};

use super::{
    candidates::{CLOUDS, clouds_work},
    drawn::{picture::BEGUN_SIDE, uniforms::PictureUniform},
    field::{layer_map::LayerMaps, layers::CloudLayers, overhead::LayersQuery, shape::Shape},
    held::HeldClouds,
    light::{lamps::LampsUniform, shadow::LOWEST},
    maps::{
        handed::{CloudShadows, HostShadowTexture},
        panorama::PanoramaInputs,
        shadow_map::ShadowMap,
        shadow_projection::{HistoryUse, ShadowProjection},
    },
    passes::{CloudFrame, CloudPasses, Shaded, Wanted},
    settings::CloudSettings,
};
use crate::{
    error::Result,
    gpu::{Device, recent::LruCache},
    moment::{Scene, SceneMoment},
    stage::{
        Contribution, DrawContext, DrawnEffect, Exchange, Frame, FrameBlock, FrameContext, MergedFrame, Output,
        Outputs, PutPart, Recording, Sampling, Stages, Texture, Traits, flag,
    },
    weather::{CloudSlab, MAX_CLOUD_LAYERS},
    wind::LayerDrifts,
};

/// Pixels of a square of 4 x 4 in the order in which they are marched, each far from the pixels marched before it. A
/// pixel's index counts from 0, row by row. Smaller squares use each index modulo their number of pixels.
const ORDER: [u32; 16] = [0, 10, 2, 8, 5, 15, 7, 13, 1, 11, 3, 9, 4, 14, 6, 12];
/// Stages whose draws show clouds directly.
const SHOWN: Stages = Stages::BACKGROUND.with(Stages::MEDIUM);

/// Camera and clouds of the last frame whose clouds were marched.
#[derive(Clone, Copy)]
struct Before {
    /// Matrix from a place relative to the camera (east, north, up), m, to clip space.
    clip: DMat4,
    /// Position of the camera in the host's world, m.
    eye: DVec3,
    /// Displacements of the layers by the wind.
    drifts: LayerDrifts,
    /// Exposure, display units per cd/m^2.
    exposure: f64,
}

/// Progress of a frame: the parts that its calls have drawn so far.
#[derive(Clone, Copy)]
struct FrameProgress {
    /// Number of the frame.
    frame_id: u64,
    /// Whether rays have been marched.
    is_marched: bool,
    /// Whether shadows have been applied to the picture.
    is_shaded: bool,
    /// Whether the panorama has been refreshed.
    is_round: bool,
    /// Reprojection from the last frame to this frame's picture.
    picture: PictureUniform,
}

/// Clouds of a view.
#[derive(Default)]
pub(crate) struct CloudsView {
    /// Settings of the clouds in this view.
    pub settings: CloudSettings,
    /// Layers above and below the camera in this frame; `None` without clouds or volumes.
    overhead: Option<CloudLayers>,
    /// Shapes of the layers; most frames have the same ones as the last.
    shapes: LruCache<CloudSlab, Shape, MAX_CLOUD_LAYERS>,
    /// Cache of the layers that follow a host's cover map.
    maps: LayerMaps,
    /// Passes, created when clouds are first drawn.
    passes: Option<Box<CloudPasses>>,
    /// Camera and clouds of the last frame whose clouds were marched; `None` if there is none, or if a later frame drew
    /// no clouds.
    before: Option<Before>,
    /// Progress of the last frame that drew clouds.
    made: Option<FrameProgress>,
    /// Passes of the draw that is being composed.
    wanted: Option<Wanted>,
    /// Lamps and flashes that light the clouds in the draw that is being composed.
    lamps: Option<LampsUniform>,
    /// Whether the picture's textures hold the last frame's clouds.
    kept: bool,
    /// Shadow map that a host's own materials read, from the host's first request on.
    handed: Option<HostShadowTexture>,
    /// Layer of stars, which stands behind the clouds.
    behind: Option<wgpu::Texture>,
}

impl CloudsView {
    /// Whether Welkin applies cloud shadows in a draw of these stages. The sun or moon must be high enough, the clouds
    /// broken, and the host must have drawn surfaces and not read the shadow map itself.
    fn casts_shadows(&self, context: &DrawContext<'_>, stages: Stages) -> bool {
        let light_is_up = context.now.scene.brighter().direction.z > LOWEST;
        // A host that reads the shadow map applies it itself.
        light_is_up
            && self.handed.is_none()
            && stages.has(Stages::SURFACE)
            && context.frame.depth.is_some()
            && self.overhead.as_ref().is_some_and(CloudLayers::is_broken)
    }

    /// Returns the share of a picture's rays that lead towards clouds, from 8 x 8 rays spread over it.
    fn share_of_rays(&self, context: &DrawContext<'_>) -> f64 {
        const SIDE: u32 = 8;
        let Some(overhead) = &self.overhead else { return 0.0 };
        let ndc = |i: u32| (f64::from(i) + 0.5) / f64::from(SIDE) * 2.0 - 1.0;
        let count = (0..SIDE * SIDE).filter(|i| {
            let ray = context.target.rays.view_ray(DVec2::new(ndc(i % SIDE), ndc(i / SIDE)));
            overhead.lies_toward(&context.now.scene, context.now.scene.world_to_enu * ray.direction)
        });
        count.count() as f64 / f64::from(SIDE * SIDE)
    }

    /// Returns the progress of this frame; `None` if no call has drawn a part yet.
    fn made_of(&self, frame: &Frame<'_>) -> Option<FrameProgress> {
        self.made.filter(|made| made.frame_id == frame.frame_id)
    }

    /// Whether a draw of these stages shows clouds: their light, their shadows or their mirror images.
    fn is_there(&self, frame: &Frame<'_>, stages: Stages) -> bool {
        let shown = SHOWN.with(Stages::SURFACE).0 & stages.0 != 0;
        self.overhead.is_some() && (shown || self.made_of(frame).is_some_and(|made| made.is_marched))
    }

    /// Returns the passes of a frame that a draw of these stages still needs.
    fn wanted(&self, context: &DrawContext<'_>) -> Wanted {
        let made = self.made_of(context.frame);
        let march = SHOWN.0 & context.stages.0 != 0 && !made.is_some_and(|m| m.is_marched);
        let shade = self.casts_shadows(context, context.stages) && !made.is_some_and(|m| m.is_shaded);
        Wanted {
            is_begun: made.is_some_and(|m| m.is_marched || m.is_shaded),
            march,
            resolve: march || shade,
            ..Wanted::default()
        }
    }
}

/// Returns for red, green and blue the ratio of the direct light without clouds to the mean of all light, both on level
/// ground. The fourth number is the mean share of the direct light that clouds let through.
fn shadow_strength(scene: &Scene) -> [f32; 4] {
    let light = scene.brighter();
    let (ground, share) = (&scene.ground, light.direct_share.max(1e-3));
    let level = |lux: [f64; 3], direction: DVec3| lux.map(|v| v * direction.z.max(0.0));
    let (sun, moon) = (level(ground.sun_lux, scene.sun.direction), level(ground.moon_lux, scene.moon.direction));
    let direct = if std::ptr::eq(light, &scene.sun) { sun } else { moon };
    let one = |i: usize| (direct[i] / share / (sun[i] + moon[i] + ground.sky_lux[i]).max(1e-12)) as f32;
    [one(0), one(1), one(2), light.direct_share as f32]
}

impl CloudsView {
    /// Returns the shadow map for a host's own materials. After the first request, the first draw of each frame
    /// updates the map.
    pub fn shadows(&mut self, device: &Device) -> CloudShadows {
        let made = self.passes.as_ref().and_then(|passes| passes.shadow_texture().cloned());
        let handed = self
            .handed
            .get_or_insert_with(|| HostShadowTexture::new(made.unwrap_or_else(|| ShadowMap::texture(device))));
        handed.shadows.clone()
    }

    /// Places the host's shadow map for this frame. `projection` is `None` if no clouds cast shadows.
    fn lay(&mut self, now: &SceneMoment<'_>, projection: Option<&ShadowProjection>) {
        if let Some(handed) = &mut self.handed {
            handed.lay(now, projection);
        }
    }

    /// Returns the side of the squares in each of which a frame marches one pixel. It is 1 for a frame without history,
    /// which must not use earlier frames.
    fn side(&self, frame: &Frame<'_>) -> u32 {
        if frame.flags.has(crate::stage::FrameFlags::NO_HISTORY) { 1 } else { self.settings.square_side }
    }

    /// Returns the reprojection from the last frame's clouds to this picture, and this frame's camera.
    fn picture(&self, context: &DrawContext<'_>) -> (PictureUniform, Before) {
        let (frame, now) = (context.frame, context.now);
        let drifts = self.overhead.as_ref().map_or(LayerDrifts::ZERO, |o| o.drifts);
        let here = Before { clip: context.clip(), eye: now.eye, drifts, exposure: context.target.exposure };
        let last = self.before.filter(|_| self.kept && !frame.is_pure());
        let size = context.picture().size();
        let side = self.side(frame);
        // A picture without history begins with smaller squares.
        let side = if last.is_none() { side.min(BEGUN_SIDE) } else { side };
        let moved = last.map_or(DVec3::ZERO, |b| {
            let carried = self.overhead.as_ref().map_or(DVec2::ZERO, |o| o.carried_since(&b.drifts));
            carried.extend(0.0) - now.scene.world_to_enu * (here.eye - b.eye)
        });
        let uniform = PictureUniform {
            size: [size.width, size.height],
            side,
            place: ORDER[(frame.frame_id % 16) as usize] % (side * side),
            before: last.map_or(DMat4::IDENTITY, |b| b.clip).as_mat4().to_cols_array_2d(),
            moved: moved.as_vec3().to_array(),
            exposed: last.map_or(0.0, |b| (here.exposure / b.exposure) as f32),
        };
        (uniform, here)
    }
}

impl DrawnEffect for CloudsView {
    fn composes(&self) -> Exchange {
        Exchange { needs: &[Output::Stars], gives: &[Output::Sky] }
    }

    fn gather(&mut self, context: &FrameContext<'_>, _given: &mut Outputs) -> Result<()> {
        let (now, model) = (context.now, context.held.of::<HeldClouds>()?.model);
        let query = LayersQuery { scene: &now.scene, eye: now.eye, weather: &now.weather, time_s: now.time_s };
        let still = |slab: &CloudSlab| self.shapes.get_or_put(slab, || Shape::of(slab));
        if query.is_clear() {
            self.overhead = None;
        } else {
            self.overhead = query.layers(model, &mut self.maps, still)?.filter(|o| !o.layers().is_empty());
        }
        if self.overhead.is_none() {
            self.before = None;
        }
        Ok(())
    }

    fn stages(&self) -> Stages {
        match &self.overhead {
            Some(overhead) if overhead.is_broken() => SHOWN.with(Stages::SURFACE),
            Some(_) => SHOWN,
            None => Stages(0),
        }
    }

    fn prepare(&mut self, context: &FrameContext<'_>, recording: &mut Recording<'_>) -> Result<()> {
        let Some(overhead) = &self.overhead else {
            self.lay(context.now, None);
            return Ok(());
        };
        let passes = match &mut self.passes {
            Some(passes) => passes,
            none => none.insert(Box::new(CloudPasses::new((recording.device, recording.blocks), context.now.seed)?)),
        };
        let cosine = context.now.scene.brighter().direction.z;
        passes.tables.update(recording.device, recording.encoder, cosine, overhead.liquid_um);
        passes.place(recording.device, overhead)?;
        let has_shadows = cosine > LOWEST && overhead.is_broken();
        let projection = has_shadows.then(|| ShadowProjection::new(context.now, overhead));
        if let (Some(projection), Some(handed)) = (&projection, &self.handed) {
            // Shadows do not depend on the exposure.
            let clouds = overhead.uniform(context.now, 1.0, &passes.tables.light.media);
            let (past, texture) = (HistoryUse::of(context.frame), &handed.shadows.texture);
            passes.draw_shadows(recording.device, recording.encoder, &clouds, projection, past, texture)?;
        }
        self.lay(context.now, projection.as_ref());
        Ok(())
    }

    fn parts(&mut self, context: &DrawContext<'_>, stages: Stages, put: &mut PutPart<'_>) {
        put(
            &CLOUDS,
            self.is_there(context.frame, stages),
            &[clouds_work(context.pixels(), self.share_of_rays(context))],
        );
    }

    fn compose(&mut self, context: &DrawContext<'_>, given: &Outputs, added: &mut Contribution) -> Result<()> {
        let (drawn, scene) = (context.share(&CLOUDS, 0), &context.now.scene);
        let mean = self.overhead.as_ref().filter(|_| context.plan.is_gauged).map(|o| o.mean_radiance_and_cover(scene));
        if drawn <= 0.0 {
            self.before = None;
        }
        let is_there = self.is_there(context.frame, context.stages) && self.passes.is_some() && drawn > 0.0;
        added.between_and_veil("CLOUDS", flag(is_there), flag(is_there));
        added.between("DECK_CLOSED", 0.0, flag(scene.deck_cover as f32 >= 1.0));
        let deck = flag(is_there && self.overhead.as_ref().is_some_and(|o| o.has_deck));
        added.between("DECK_BEHIND", deck, deck);
        let shadows = is_there && self.casts_shadows(context, context.stages);
        added.constant("CLOUD_SHADOWS", flag(shadows), flag(shadows));
        let size = (context.picture().width(), context.picture().height());
        let overhead = self.overhead.as_ref().filter(|_| is_there);
        self.lamps = overhead.and_then(|o| LampsUniform::of(o, context.now, context.target.exposure, size));
        let glow = flag(self.lamps.is_some());
        added.between_and_veil("CLOUD_GLOW", glow, glow);
        let shafts = shadows && self.settings.shafts;
        added.constant("CLOUD_SHAFTS", flag(shafts), flag(shafts));
        let traits = Traits { is_fine: shafts, is_overlaid: is_there && !shafts, ..Traits::default() };
        added.set_traits(traits, traits);
        let shadow = shadows.then(|| shadow_strength(scene));
        added.set_frame_block(FrameBlock::Clouds { drawn, mean, shadow });
        let (wanted, side) = (self.wanted(context), self.side(context.frame));
        self.wanted = is_there.then_some(wanted);
        if let Some(passes) = self.passes.as_mut().filter(|_| is_there) {
            let holds = passes.hold(context.device, size, side);
            if !wanted.is_begun {
                self.kept = holds && self.before.is_some();
            }
            self.behind = given.stars.as_ref().map(|view| view.texture().clone());
            added.set_texture(Texture::Behind, passes.layers(&wanted));
        }
        Ok(())
    }

    fn draw(
        &mut self,
        context: &DrawContext<'_>,
        merged: &MergedFrame<'_>,
        recording: &mut Recording<'_>,
    ) -> Result<()> {
        let Some(mut wanted) = self.wanted.take() else { return Ok(()) };
        let casts_shadows = self.casts_shadows(context, context.stages);
        let earlier = self.made_of(context.frame);
        wanted.shows_round = merged.composition.needs_panorama();
        wanted.round = wanted.shows_round && !earlier.is_some_and(|m| m.is_round);
        let (picture, here) = match earlier.filter(|_| !wanted.march) {
            Some(made) => (made.picture, None),
            None => {
                let (picture, here) = self.picture(context);
                (picture, wanted.march.then_some(here))
            }
        };
        let (Some(overhead), Some(passes), Some((layout, group))) =
            (&self.overhead, &mut self.passes, &merged.composition.tables())
        else {
            return Ok(());
        };
        let projection = ShadowProjection::new(context.now, overhead);
        let pixel = context.target.rays.pixel_angle(context.picture().height());
        let around = PanoramaInputs {
            inputs: projection.inputs,
            altitude_m: context.now.scene.place.altitude_m,
            exposure: context.target.exposure,
        };
        let shaded = context.frame.depth_layer().filter(|_| casts_shadows).map(|depth| Shaded { projection, depth });
        let sampling = Sampling::of(context.picture(), context.frame.depth);
        let inputs = CloudFrame {
            wanted,
            clouds: overhead.uniform(context.now, context.target.exposure, &passes.tables.light.media),
            picture,
            frame: merged.block,
            sky: (layout, group),
            behind: self.behind.as_ref(),
            shaded,
            has_shafts: self.settings.shafts,
            lamps: self.lamps,
            around,
            fineness: self.settings.fineness,
            is_coarse: overhead.is_coarse(&context.now.scene, context.now.planet_radius_m, pixel),
            past: HistoryUse::of(context.frame),
            is_multisampled: sampling.multisampled()[1],
            depth_kinds: f64::from(context.target.rays.depth_kinds()),
        };
        recording.passes += passes.draw(recording.device, recording.encoder, &inputs)?;
        self.before = here.or(self.before);
        self.made = Some(FrameProgress {
            frame_id: context.frame.frame_id,
            is_marched: wanted.march || earlier.is_some_and(|m| m.is_marched),
            is_shaded: casts_shadows || earlier.is_some_and(|m| m.is_shaded),
            is_round: merged.composition.needs_panorama() || earlier.is_some_and(|m| m.is_round),
            picture,
        });
        Ok(())
    }

    fn bytes(&self) -> u64 {
        self.passes.as_ref().map_or(0, |p| p.bytes())
    }

    fn forget_picture(&mut self) {
        (self.before, self.made) = (None, None);
        if let Some(passes) = &mut self.passes {
            passes.forget();
        }
    }
}
