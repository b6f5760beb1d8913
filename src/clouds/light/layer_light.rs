//! Light that falls on a layer of cloud from above and below it, and the mean radiance of the layers seen from a place.

use std::f64::consts::PI;

use crate::{
    clouds::field::{layers::CloudLayers, shape::Shape},
    moment::Scene,
    world::light_above_clouds,
};

/// Light that falls on a layer from above and below it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct LayerLight {
    /// Illuminance by the sun or moon on a surface that faces it, lux times exposure, for red, green and blue.
    pub sun: [f64; 3],
    /// Mean radiance from above, cd/m^2 times exposure, for red, green and blue.
    pub above: [f64; 3],
    /// Mean radiance from below, cd/m^2 times exposure, for red, green and blue.
    pub below: [f64; 3],
}

/// Returns the light on a layer from sun, sky and the layers above it, and from the ground and the layers below it,
/// times `exposure`. The light depends on the layer's height, not on the eye's. Where a map or rain areas place the
/// clouds, the light of the ground below them is not known; the ground at the eye is used instead.
pub(crate) fn light_on(scene: &Scene, (shape, is_placed): (&Shape, bool), exposure: f64) -> LayerLight {
    let (c, light) = (&scene.conditions, scene.brighter());
    let albedo = scene.ground_albedo;
    let top_m = shape.base_m + shape.thickness_m;
    let over = c.cloud_light_at(light.direction.z, albedo[1], top_m);
    let (direct, sky) = light_above_clouds(scene, top_m);
    let level = light.direction.z.max(0.0);
    let ground = &scene.ground;
    let at_eye = |i: usize| {
        let direct =
            ground.sun_lux[i] * scene.sun.direction.z.max(0.0) + ground.moon_lux[i] * scene.moon.direction.z.max(0.0);
        (direct + ground.sky_lux[i]) * albedo[i]
    };
    let under = |i: usize| {
        let [beam, even] = c.light_up_at(light.direction.z, albedo[i], shape.base_m);
        direct[i] * level * beam + sky[i] * even
    };
    LayerLight {
        sun: direct.map(|v| v * over.direct * exposure),
        above: [0, 1, 2].map(|i| (sky[i] * over.sky + direct[i] * level * over.diffuse) / PI * exposure),
        below: [0, 1, 2].map(|i| if is_placed { at_eye(i) } else { under(i) } / PI * exposure),
    }
}

impl CloudLayers {
    /// Returns the mean radiance of the drawn clouds seen from the place, cd/m^2, with their cover, and a height
    /// relative to the place, m: the lowest of the bases of layers that begin above the place and of the tops of the
    /// other layers. With a transmittance T, the lit side reflects 1 - T and the shaded side passes T. From above only
    /// the lit side is seen. From below half of what is seen is lit and the other half is shaded: ((1 - T) + T) / 2.
    pub fn mean_radiance_and_cover(&self, scene: &Scene) -> ([f32; 4], f32) {
        let (mut light, mut clear, mut over) = ([0.0; 3], 1.0, f64::INFINITY);
        for layer in self.layers() {
            let (shape, cover) = (&layer.shape, layer.slab.cover);
            let of = light_on(scene, (shape, self.is_placed()), 1.0);
            // Transmittance of uniform cloud with g = 0.85 (Bohren 1987, American Journal of Physics 55, 524).
            let through = 2.0 / (2.0 + 0.15 * layer.slab.optical_depth);
            let is_over = shape.base_m > scene.place.altitude_m;
            let seen = if is_over { 0.5 } else { 1.0 - through };
            let level = scene.brighter().direction.z.max(0.0);
            for (i, light) in light.iter_mut().enumerate() {
                *light += cover * clear * seen * (of.sun[i] * level / PI + of.above[i]);
            }
            over = over
                .min(if is_over { shape.base_m } else { shape.base_m + shape.thickness_m } - scene.place.altitude_m);
            clear *= 1.0 - cover;
        }
        let cover = 1.0 - clear;
        let [r, g, b] = light.map(|v| (v / cover.max(1e-6)) as f32);
        ([r, g, b, cover as f32], over as f32)
    }
}
