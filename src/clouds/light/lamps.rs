//! Host lamps and lightning flashes that light the clouds of a picture, as uniforms (`shaders/clouds/lit_lamps.wgsl`).

use std::f64::consts::PI;

use bytemuck::{Pod, Zeroable};

use crate::{
    clouds::field::{layer::OverheadLayer, layers::CloudLayers},
    moment::SceneMoment,
    scene::{FlashLamp, HostLight, LightUniform},
};

/// Largest number of lamps and flashes. If there are more, all flashes are kept, and the lamps that light clouds most.
const LAMPS: usize = 16;
/// Largest number of rows in the picture of the lamps' glow.
const ROWS: u32 = 96;
/// Luminance times exposure below which glow is invisible: a quarter of a step of 8 bits.
const LEAST_SHOWN: f64 = 1e-3;
/// Largest share of a lamp's light that a cloud reflects.
const REFLECTS: f64 = 0.7;
/// Least distance of a lamp from the cloud that it lights, m. A lamp inside a cloud is taken to be at this distance.
const NEAREST_M: f64 = 5.0;

/// A lamp or a flash: `CloudLamp` of `shaders/clouds/lamps.wgsl`.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
pub(crate) struct CloudLampUniform {
    /// Lamp or flash as all shaders read it.
    pub light: LightUniform,
    /// Radius of the source, m.
    pub radius: f32,
    /// Ratio of the mean intensity over all directions to that in the middle of the beam.
    pub even: f32,
    /// Above 0 for a source inside a cloud. The path from the source to a lit place is then taken as all cloud, and the
    /// cloud on it is not measured.
    pub buried: f32,
    /// Padding.
    pub pad: f32,
}

/// All lamps and flashes: `CloudLamps` of `shaders/clouds/lamps.wgsl`.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
pub(crate) struct LampsUniform {
    /// Number of lamps and flashes.
    pub count: u32,
    /// First row of the glow in its target.
    pub row: f32,
    /// Width and height of the glow's picture, texels.
    pub size: [f32; 2],
    /// Lamps and flashes, of which the first `count` are in use.
    pub lamps: [CloudLampUniform; LAMPS],
}

/// Returns the width and height of the glow's picture, texels, for a picture of `width` by `height` pixels: `glow_size`
/// of `shaders/between/glow.wgsl`.
pub(crate) fn glow_size((width, height): (u32, u32)) -> (u32, u32) {
    let rows = height.min(ROWS);
    ((width * rows).div_ceil(height), rows)
}

/// Returns the ratio of a lamp's mean intensity over all directions to that in the middle of its beam. The beam falls
/// off by a smooth step between two cosines.
fn even_share(lamp: &HostLight) -> f64 {
    let [inner, outer] = [lamp.inner_deg, lamp.outer_deg].map(|a| a.to_radians().cos());
    0.5 * (1.0 - inner + 0.5 * (inner - outer))
}

/// Returns an upper bound of the luminance of the clouds that a lamp lights, cd/m^2. `rise` is the sine of the beam's
/// elevation, and `height_m` the lamp's height above the sea. The way to a layer is measured along the ray of the beam
/// that is steepest towards the layer, because no other ray reaches the layer sooner.
fn most_on(overhead: &CloudLayers, lamp: &HostLight, rise: f64, height_m: f64) -> f64 {
    let brightest = lamp.intensity_cd.into_iter().fold(0.0, f64::max);
    let steepest = |rise: f64| {
        let angle = rise.clamp(-1.0, 1.0).asin() + lamp.outer_deg.to_radians();
        angle.min(0.5 * PI).sin()
    };
    let one = |layer: &OverheadLayer| {
        let (base_m, top_m) = (layer.shape.base_m, layer.shape.base_m + layer.shape.thickness_m);
        let (gap_m, sine) = if height_m < base_m {
            (base_m - height_m, steepest(rise))
        } else {
            ((height_m - top_m).max(0.0), steepest(-rise))
        };
        let way_m = if gap_m > 0.0 { gap_m / sine.max(0.0) } else { NEAREST_M };
        brightest * REFLECTS / (PI * way_m.max(NEAREST_M).powi(2))
    };
    overhead.layers().iter().map(one).fold(0.0, f64::max)
}

impl CloudLampUniform {
    /// Creates the lamp of a host's light, relative to the camera.
    fn host(lamp: &HostLight, now: &SceneMoment<'_>, exposure: f64) -> Self {
        let light = lamp.uniform(now.eye, now.scene.world_to_enu, exposure);
        Self { light, radius: 0.1, even: even_share(lamp) as f32, buried: 0.0, pad: 0.0 }
    }

    /// Creates the lamp of a flash. The flash sends its light equally to all sides.
    fn flash(flash: &FlashLamp, exposure: f64) -> Self {
        Self {
            // Leaves out that a flash inside a cloud shines through the cloud's base: the clouds' shaders compute what
            // the cloud does to its light.
            light: FlashLamp { down_share: None, ..*flash }.uniform(exposure),
            radius: flash.radius_m.max(10.0) as f32,
            even: 1.0,
            buried: f32::from(u8::from(flash.down_share.is_some())),
            pad: 0.0,
        }
    }
}

impl LampsUniform {
    /// Finds the lamps and flashes of a moment for a picture of this width and height, pixels. Lamps whose glow would
    /// be invisible are left out. `None` if nothing is left.
    pub fn of(overhead: &CloudLayers, now: &SceneMoment<'_>, exposure: f64, picture: (u32, u32)) -> Option<Self> {
        let (lights, flashes) = (now.lamps, now.flash_lamps());
        if lights.is_empty() && flashes.is_empty() {
            return None;
        }
        let shown = |lamp: &HostLight| {
            let to_enu = now.scene.world_to_enu;
            let up = (to_enu * lamp.direction).normalize().z;
            let height_m = now.scene.place.altitude_m + (to_enu * (lamp.position_m - now.eye)).z;
            most_on(overhead, lamp, up, height_m) * exposure
        };
        let mut host: Vec<(f64, &HostLight)> =
            lights.iter().map(|lamp| (shown(lamp), lamp)).filter(|(shown, _)| *shown > LEAST_SHOWN).collect();
        host.sort_by(|a, b| b.0.total_cmp(&a.0));
        let (width, height) = glow_size(picture);
        let mut out = Self { row: picture.1 as f32, size: [width as f32, height as f32], ..Self::zeroed() };
        let flashes = flashes.iter().map(|flash| CloudLampUniform::flash(flash, exposure));
        let host = host.iter().map(|(_, lamp)| CloudLampUniform::host(lamp, now, exposure));
        for (to, lamp) in out.lamps.iter_mut().zip(flashes.chain(host)) {
            *to = lamp;
            out.count += 1;
        }
        (out.count > 0).then_some(out)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::gpu::shader;

    #[test]
    fn offsets_agree_with_the_shader() {
        shader::assert_layout!(
            "clouds/glow_view.wgsl:lamps",
            "CloudLamp",
            CloudLampUniform,
            [light, radius, even, buried]
        );
        shader::assert_layout!("clouds/glow_view.wgsl:lamps", "CloudLamps", LampsUniform, [count, row, size, lamps]);
    }

    #[test]
    fn the_shader_has_the_same_number_of_rows() {
        let text = shader::assemble("between/sky_sample.wgsl").unwrap();
        assert!(text.contains(&format!("const GLOW_ROWS: f32 = {ROWS}.0;")));
        assert_eq!((glow_size((640, 360)), glow_size((64, 36)), glow_size((1, 50))), ((171, 96), (64, 36), (1, 50)));
    }

    /// A beam's mean over all directions is the integral of its smooth step.
    #[test]
    fn a_beams_mean_is_that_over_all_directions() {
        let lamp = |inner_deg, outer_deg| HostLight {
            position_m: glam::DVec3::ZERO,
            direction: glam::DVec3::Z,
            intensity_cd: [1.0; 3],
            inner_deg,
            outer_deg,
        };
        assert_eq!(even_share(&lamp(180.0, 180.0)), 1.0);
        for (inner, outer) in [(10.0, 20.0), (30.0, 30.0), (60.0, 150.0), (60.0, 180.0), (170.0, 180.0)] {
            let lamp = lamp(inner, outer);
            let n = 20_000;
            let at = |i: i32| {
                let z = (f64::from(i) + 0.5) / f64::from(n) * 2.0 - 1.0;
                lamp.illuminance_lux(glam::DVec3::new((1.0 - z * z).sqrt(), 0.0, z))[0]
            };
            let mean = (0..n).map(at).sum::<f64>() / f64::from(n);
            assert!((mean / even_share(&lamp) - 1.0).abs() < 1e-3, "{inner} {outer}: {mean}");
        }
    }
}
