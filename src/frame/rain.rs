//! The rain of a view: what it draws of what falls, from scene and camera.

use std::{f64::consts::PI, sync::Arc};

use glam::{DMat4, DVec3};

use super::Frame;
use crate::{
    context::{Context, Scene},
    error::Result,
    gpu::Device,
    rain::{
        Air, Classes, ConeUniform, Drawn, DropLight, RainLayer, RainModel, RainSettings, RainUniform, Shelter, Shot,
        Splashes, drops,
        lattice::{FADE, REACH_M, SHELLS},
    },
    scene::{LightUniform, ViewRays},
    weather::Falling,
};

/// What a view holds for its drops.
pub(super) struct Rain {
    layer: RainLayer,
    pub settings: RainSettings,
    /// Drops a class, and what they were counted for.
    counted: Option<(Falling, f64, u32, Classes)>,
    boxes: Vec<[[f32; 4]; 4]>,
    lights: Vec<LightUniform>,
}

impl Rain {
    pub fn new(device: &Device, settings: RainSettings) -> Self {
        Self { layer: RainLayer::new(device), settings, counted: None, boxes: Vec::new(), lights: Vec::new() }
    }

    /// Whether anything falls that is drawn before the picture.
    pub fn shows(&self, scene: &Scene) -> bool {
        let f = &scene.conditions.precipitation;
        f.rain_mm_h + f.drizzle_mm_h > 0.0 && self.settings.model != RainModel::Veil
    }

    /// Bytes of GPU memory held.
    pub fn bytes(&self) -> u64 {
        self.layer.bytes()
    }

    /// The layer for a picture like `color`.
    pub fn layer(&mut self, device: &Device, color: &wgpu::Texture) -> &wgpu::TextureView {
        self.layer.view(device, color.size())
    }

    /// What drops or cones hide, as an extinction (their discs: half of theirs, the rest is diffraction), and the distance up
    /// to which they do.
    pub fn hidden(&mut self, device: &Device, scene: &Scene) -> [f32; 2] {
        [0.5 * self.classes(device, scene).extinction_per_m, 0.5 * (1.0 + FADE) * REACH_M].map(|v| v as f32)
    }

    fn classes(&mut self, device: &Device, scene: &Scene) -> Classes {
        let most = self.settings.most_drops.unwrap_or(if device.caps().software { 100_000 } else { 400_000 });
        let station = &scene.conditions.air;
        let factor = drops::factor_in(station, station.station_altitude_m);
        let falling = &scene.conditions.precipitation;
        match &self.counted {
            Some((f, x, m, classes)) if f == falling && *x == factor && *m == most => *classes,
            _ => {
                let classes = Classes::new(falling, factor, most);
                self.counted = Some((*falling, factor, most, classes));
                classes
            }
        }
    }

    /// Draws the drops round the camera into the layer; answers how many.
    pub fn draw(
        &mut self,
        device: &Arc<Device>,
        encoder: &mut wgpu::CommandEncoder,
        (context, scene, rays): (&Context, &Scene, &ViewRays),
        frame: &Frame<'_>,
        color: &wgpu::Texture,
        exposure: f64,
    ) -> Result<u32> {
        let classes = self.classes(device, scene);
        let view = DMat4::from_mat3(frame.camera.rotation() * scene.world_to_enu.transpose());
        let enu = |v: DVec3| scene.world_to_enu * v;
        let shot = Shot {
            clip: frame.camera.projection * view,
            rays,
            height: color.height(),
            y_sign: if frame.origin_bottom_left { -1.0 } else { 1.0 },
            position_m: DVec3::new(scene.map_m[0], scene.map_m[1], scene.place.altitude_m),
            velocity_m_s: enu(frame.camera_velocity_m_s),
            exposure_s: self.settings.shutter_s,
        };
        let c = &scene.conditions;
        let air = Air {
            displacement_m: context.wind_displacement(context.time_s())?,
            velocity_m_s: context.carrying_wind(context.time_s())?,
            time_s: context.time_s(),
            extinction_per_m: c.fog.extinction_per_m + c.aerosol.extinction_per_m,
        };
        let block = RainUniform::new(context.seed(), &classes, &light(scene, exposure), &shot, &air);
        let splashes = Splashes::new(&classes);
        let height_m = scene.place.altitude_m - c.air.station_altitude_m;
        let eye = frame.camera.position;
        self.boxes.clear();
        let slowest = classes.flux[0].1;
        let matters = |s: &&Shelter| s.matters(eye, scene.world_to_enu, air.velocity_m_s, slowest, REACH_M);
        let near = context.shelters().iter().filter(matters);
        self.boxes.extend(near.map(|s| s.rows(eye, scene.world_to_enu)));
        self.lights.clear();
        self.lights.extend(context.lights().iter().map(|l| l.uniform(eye, scene.world_to_enu, exposure)));
        let on_cones = self.settings.model == RainModel::Cones;
        let cones = on_cones
            .then(|| ConeUniform::new(block.seed, &classes, &shot, &air, &|from, to| context.carried(from, to)));
        let drawn = Drawn {
            rain: &block,
            cones: cones.as_ref(),
            shelters: &self.boxes,
            lights: &self.lights,
            splash: &splashes.uniform(shot.position_m, height_m, air.time_s),
            splashes: splashes.instances(),
        };
        self.layer.draw(device, encoder, &drawn, color, frame.depth)?;
        Ok(if on_cones { 0 } else { classes.per_shell * SHELLS as u32 })
    }
}

/// What a drop passes on: the mean of the sky and of the ground it hangs over, and sun or moon.
fn light(scene: &Scene, exposure: f64) -> DropLight {
    let light = scene.brighter();
    let g = &scene.ground;
    let lux = if light == &scene.sun { g.sun_lux } else { g.moon_lux };
    let level = light.direction.z.max(0.0);
    let albedo = scene.planet.ground_albedo;
    let below = [0, 1, 2].map(|i| albedo[i] * (g.sky_lux[i] + lux[i] * level) / PI);
    DropLight {
        above: DVec3::from(g.sky_lux) * (exposure / PI),
        below: DVec3::from(below) * exposure,
        sun: DVec3::from(lux) * exposure,
        to_sun: light.direction,
    }
}
