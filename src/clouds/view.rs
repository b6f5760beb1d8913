//! What a view draws of the clouds: a layer of what they send and let through, which the composition lays between sky and fog.

use std::f64::consts::PI;

use glam::{DMat4, DVec2, DVec3};

use super::{
    CloudModel,
    field::Shape,
    passes::{CloudFrame, CloudPasses, Shaded},
    shadow::LOWEST,
    shadow_map,
    uniforms::{CloudsUniform, LAYERS, LayerLight, LayerUniform, MediumUniform, PictureUniform},
};
use crate::{
    error::Result,
    moment::{Moment, Scene},
    stage::{Composition, Drawing, DrawnEffect, Frame, Recording, Sampling, Shot, Stages, Texture, yes},
    weather::{CloudSlab, smoothstep},
    world::light_above_clouds,
};

/// Side of the squares of pixels of which one is marched a frame.
const SIDE: u32 = 4;
/// Their order: each is far from those before it.
const ORDER: [u32; 16] = [0, 10, 2, 8, 5, 15, 7, 13, 1, 11, 3, 9, 4, 14, 6, 12];
/// Diameters of droplets for which tables are made, um.
const LIQUID_UM: [f64; 5] = [8.0, 12.0, 16.0, 20.0, 30.0];

/// Heights of a closed layer's base over the camera between which the volume takes the deck's place, m.
const DECK_FROM_M: [f64; 2] = [200.0, 400.0];
/// Slant depths of a closed layer between which the sun's disc in it pales to a tenth of what is around it: a deck shows none.
const DISC_PALES: [f64; 2] = [12.0, 14.0];

/// A layer of cloud, and how much of it is drawn as a volume: the rest is drawn as a deck.
#[derive(Clone, Copy)]
struct Layer {
    shape: Shape,
    slab: CloudSlab,
    share: f64,
}

/// What there is of clouds over a camera.
struct Overhead {
    layers: [Layer; LAYERS],
    /// Some of what is above the camera is drawn as a deck.
    has_deck: bool,
    count: usize,
    place_m: DVec2,
    liquid_um: f64,
}

/// How the last frame was seen.
#[derive(Clone, Copy)]
struct Before {
    frame_id: u64,
    clip: DMat4,
    eye: DVec3,
    drift_m: DVec2,
    exposure: f64,
}

/// The clouds of a view.
#[derive(Default)]
pub(crate) struct CloudsView {
    overhead: Option<Overhead>,
    passes: Option<Box<CloudPasses>>,
    before: Option<Before>,
    /// The picture before this call holds the last frame's clouds.
    kept: bool,
    /// The layer of stars that shine between them.
    behind: Option<wgpu::Texture>,
}

impl CloudsView {
    /// Takes the clouds of a moment.
    ///
    /// # Errors
    /// As [`Moment::carrying`].
    pub fn gather(&mut self, now: &Moment<'_>, model: CloudModel) -> Result<()> {
        let scene = &now.scene;
        self.overhead = None;
        let slabs = || scene.conditions.cloud_slabs().filter(|s| s.cover > 0.0).take(LAYERS);
        if model == CloudModel::Deck || slabs().next().is_none() {
            self.before = None;
            return Ok(());
        }
        let drift = now.carrying()?.displacement_m().truncate();
        let (station_m, above_m) = (scene.conditions.air.station_altitude_m, scene.place.altitude_m);
        let is_above = |s: &CloudSlab| station_m + s.base_m > above_m;
        // What is above a deck is hidden by it.
        let share = slabs().find(|s| is_above(s)).map_or(1.0, |lowest| volume_share(scene, lowest));
        let layer = |slab: &CloudSlab| Layer {
            shape: Shape::new(&scene.conditions, slab, drift, now.time_s),
            slab: *slab,
            share: if is_above(slab) { share } else { 1.0 },
        };
        let mut overhead = Overhead {
            layers: [layer(&CloudSlab::NONE); LAYERS],
            has_deck: share < 1.0,
            count: 0,
            place_m: DVec2::from_array(scene.map_m),
            liquid_um: nearest_diameter(slabs()),
        };
        for layer in slabs().map(layer).filter(|l| l.share > 0.0) {
            overhead.layers[overhead.count] = layer;
            overhead.count += 1;
        }
        self.overhead = (overhead.count > 0).then_some(overhead);
        if self.overhead.is_none() {
            self.before = None;
        }
        Ok(())
    }

    /// Whether some clouds leave places in the light and others not, and the host drew what shadows may fall on.
    fn casts_shadows(&self, shot: &Shot<'_>, stages: Stages) -> bool {
        let told = shot.now.scene.brighter().direction.z > LOWEST;
        told && stages.has(Stages::SURFACE)
            && shot.frame.depth.is_some()
            && self.overhead.as_ref().is_some_and(Overhead::is_broken)
    }

    fn is_there(&self, stages: Stages) -> bool {
        self.overhead.is_some() && stages.has(Stages::BACKGROUND.with(Stages::MEDIUM))
    }
}

/// How much of the lowest layer above the camera is drawn as a volume. A closed one that hides the sky, seen from further below, is a deck
/// in the same light: nothing else is seen of it.
fn volume_share(scene: &Scene, lowest: &CloudSlab) -> f64 {
    if lowest.cover < 1.0 || scene.deck_cover < 1.0 {
        return 1.0;
    }
    let over_m = scene.conditions.air.station_altitude_m + lowest.base_m - scene.place.altitude_m;
    let near = 1.0 - smoothstep(DECK_FROM_M[0], DECK_FROM_M[1], over_m);
    let depth = lowest.optical_depth / scene.brighter().direction.z.max(0.01);
    near.max(1.0 - smoothstep(DISC_PALES[0], DISC_PALES[1], depth))
}

/// Direct light over all light on level ground, a channel, over its share that clouds let through on the mean; that share.
fn shadow_strength(scene: &Scene) -> [f32; 4] {
    let light = scene.brighter();
    let (ground, share) = (&scene.ground, light.direct_share.max(1e-3));
    let level = |lux: [f64; 3], direction: DVec3| lux.map(|v| v * direction.z.max(0.0));
    let (sun, moon) = (level(ground.sun_lux, scene.sun.direction), level(ground.moon_lux, scene.moon.direction));
    let direct = if std::ptr::eq(light, &scene.sun) { sun } else { moon };
    let one = |i: usize| (direct[i] / share / (sun[i] + moon[i] + ground.sky_lux[i]).max(1e-12)) as f32;
    [one(0), one(1), one(2), light.direct_share as f32]
}

/// Of the diameters that there are tables for, the one nearest to the droplets of these layers.
fn nearest_diameter<'a>(slabs: impl Iterator<Item = &'a CloudSlab>) -> f64 {
    let add = |(water, sum): (f64, f64), s: &CloudSlab| {
        let liquid = s.cover * (1.0 - s.ice_fraction);
        (water + liquid, sum + liquid * s.droplet_radius_um)
    };
    let (water, sum) = slabs.fold((0.0, 0.0), add);
    let diameter = (2.0 * sum / water.max(1e-6)).max(1.0);
    let off = |um: &f64| (um / diameter).ln().abs();
    LIQUID_UM.into_iter().min_by(|a, b| off(a).total_cmp(&off(b))).unwrap_or(diameter)
}

/// Light on a layer from sun, sky and the layers above it, and from the ground.
fn light_on(scene: &Scene, shape: &Shape, exposure: f64) -> LayerLight {
    let light = scene.brighter();
    let albedo = scene.planet.ground_albedo;
    let top_m = shape.base_m + shape.thickness_m;
    let over = scene.conditions.cloud_light_at(light.direction.z, albedo[1], top_m);
    let (direct, sky) = light_above_clouds(scene, top_m);
    let level = light.direction.z.max(0.0);
    let ground = &scene.ground;
    let total = |i: usize| {
        let direct =
            ground.sun_lux[i] * scene.sun.direction.z.max(0.0) + ground.moon_lux[i] * scene.moon.direction.z.max(0.0);
        (direct + ground.sky_lux[i]) * albedo[i] / PI * exposure
    };
    LayerLight {
        sun: direct.map(|v| v * over.direct * exposure),
        above: [0, 1, 2].map(|i| (sky[i] * over.sky + direct[i] * level * over.diffuse) / PI * exposure),
        below: [0, 1, 2].map(total),
    }
}

impl Overhead {
    /// Whether some of it leaves gaps.
    fn is_broken(&self) -> bool {
        self.layers[..self.count].iter().any(|layer| layer.slab.cover < 1.0)
    }

    fn uniform(&self, shot: &Shot<'_>, passes: &CloudPasses) -> CloudsUniform {
        let scene = &shot.now.scene;
        let light = scene.brighter();
        let mut layers = [bytemuck::Zeroable::zeroed(); LAYERS];
        for (to, Layer { shape, slab, share }) in layers.iter_mut().zip(&self.layers[..self.count]) {
            let medium = usize::from(slab.ice_fraction > 0.5);
            let of = (medium, &passes.tables.light.media[medium].scattering);
            *to = LayerUniform::new(shape, *share, self.place_m, &light_on(scene, shape, shot.exposure), of);
        }
        CloudsUniform {
            to_sun: light.direction.as_vec3().to_array(),
            layer_count: self.count as u32,
            altitude: scene.place.altitude_m as f32,
            radius: shot.now.planet_radius_m.min(1e9) as f32,
            jitter: 0.5,
            unused: 0.0,
            media: [0, 1].map(|i| MediumUniform::new(&passes.tables.light.media[i].scattering)),
            layers,
        }
    }
}

impl CloudsView {
    /// How a picture's clouds follow from the last frame's.
    fn picture(&self, shot: &Shot<'_>) -> (PictureUniform, Before) {
        let (frame, now) = (shot.frame, shot.now);
        let drift_m = self.overhead.as_ref().map_or(DVec2::ZERO, |o| o.layers[0].shape.drift_m);
        let here =
            Before { frame_id: frame.frame_id, clip: shot.clip(), eye: now.eye, drift_m, exposure: shot.exposure };
        let last = self.before.filter(|_| self.kept && !frame.is_pure());
        let size = shot.color.texture.size();
        let side = side(frame);
        let moved = last.map_or(DVec3::ZERO, |b| {
            (here.drift_m - b.drift_m).extend(0.0) - now.scene.world_to_enu * (here.eye - b.eye)
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

/// Side of the squares of a frame: a pure function of view and time has no history to wait for.
fn side(frame: &Frame<'_>) -> u32 {
    if frame.flags.has(crate::stage::FrameFlags::NO_HISTORY) { 1 } else { SIDE }
}

impl DrawnEffect for CloudsView {
    fn stages(&self) -> Stages {
        let shown = Stages::BACKGROUND.with(Stages::MEDIUM);
        match &self.overhead {
            Some(overhead) if overhead.is_broken() => shown.with(Stages::SURFACE),
            Some(_) => shown,
            None => Stages(0),
        }
    }

    fn prepare(&mut self, at: &crate::stage::Prepare<'_>, to: &mut Recording<'_>) -> Result<()> {
        let Some(overhead) = &self.overhead else { return Ok(()) };
        let passes = match &mut self.passes {
            Some(passes) => passes,
            none => none.insert(Box::new(CloudPasses::new(to.device, at.now.seed)?)),
        };
        let cosine = at.now.scene.brighter().direction.z;
        passes.tables.update(to.device, to.encoder, cosine, overhead.liquid_um);
        Ok(())
    }

    fn compose(&mut self, shot: &Shot<'_>, to: &mut Composition) -> Result<()> {
        let is_there = self.is_there(to.stages) && self.passes.is_some();
        to.constant("CLOUDS", yes(is_there), yes(is_there));
        let deck = yes(is_there && self.overhead.as_ref().is_some_and(|o| o.has_deck));
        to.constant("DECK_BEHIND", deck, deck);
        let shadows = is_there && self.casts_shadows(shot, to.asked);
        to.constant("CLOUD_SHADOWS", yes(shadows), yes(shadows));
        if shadows {
            to.block.cloud_shadow = shadow_strength(&shot.now.scene);
        }
        if let Some(passes) = self.passes.as_mut().filter(|_| is_there) {
            let texture = shot.color.texture;
            let size = (texture.width(), texture.height());
            // A second draw of the same frame finds the picture as the first one left it.
            let drawn = self.before.is_some_and(|b| b.frame_id == shot.frame.frame_id);
            if !drawn {
                self.kept = passes.hold(shot.device, size, side(shot.frame)) && self.before.is_some();
            }
            let stars = to.textures[Texture::Behind as usize].take();
            self.behind = stars.filter(|_| to.block.behind[1] > 0.0).map(|view| view.texture().clone());
            to.set_texture(Texture::Behind, passes.next());
        }
        Ok(())
    }

    fn draw(&mut self, shot: &Shot<'_>, with: &Drawing<'_>, to: &mut Recording<'_>) -> Result<()> {
        if !self.is_there(with.composition.stages) {
            return Ok(());
        }
        let (picture, here) = self.picture(shot);
        let casts_shadows = self.casts_shadows(shot, with.composition.asked);
        let (Some(overhead), Some(passes), Some((layout, group))) =
            (&self.overhead, &mut self.passes, &with.composition.tables)
        else {
            return Ok(());
        };
        let shapes = overhead.layers.map(|l| l.shape);
        let shaded = shot.frame.depth_layer().filter(|_| casts_shadows).map(|depth| Shaded {
            lie: shadow_map::lie(shot.now, &shapes[..overhead.count]),
            depth,
            is_pure: shot.frame.is_pure(),
        });
        let sampling = Sampling::of(shot.color.texture, shot.frame.depth);
        let of = CloudFrame {
            clouds: overhead.uniform(shot, passes),
            picture,
            frame: with.block,
            sky: (layout, group),
            behind: self.behind.as_ref(),
            shaded,
            is_multisampled: sampling.multisampled()[1],
            depth_kinds: f64::from(shot.rays.depth_kinds()),
        };
        to.passes += passes.draw(to.device, to.encoder, &of)?;
        self.before = Some(here);
        Ok(())
    }

    fn bytes(&self) -> u64 {
        self.passes.as_ref().map_or(0, |p| p.bytes())
    }

    fn forget_picture(&mut self) {
        self.before = None;
        if let Some(passes) = &mut self.passes {
            passes.forget();
        }
    }
}
