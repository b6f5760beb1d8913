//! Light of the weather in the host's own units: values for the host's directional and ambient light, so that its scene
//! is lit like Welkin's sky.
//!
//! A surface of albedo a in sun and sky reflects the luminance L = a / pi (E_sun max(n.l, 0) + E_sky) (Lambert 1760). A
//! scene-linear host computes this in its own unit. A display host has no luminance: its values are T(e L), where T is
//! Welkin's tone curve and e the exposure. T is not linear, so no pair of lights is right for every albedo. The pair
//! below is right for a grey card of albedo 0.18, in shade and where it faces the sun:
//!
//! ambient = T(e a E_sky / pi) / a, direct = (T(e a (E_sun + E_sky) / pi) - T(e a E_sky / pi)) / a
//!
//! A host that multiplies sRGB-encoded values (fixed-function OpenGL without an sRGB framebuffer) needs both numerator
//! and denominator encoded: enc(T) / enc(a).

use std::f64::consts::PI;

use glam::DVec3;

use super::{ColorSpace, Frame, ToneCurve};
use crate::{context::Context, error::Result, light::tone::srgb_encode};

/// Albedo of a photographer's grey card.
const GREY: f64 = 0.18;

/// Light for the host's own shading of one frame. A surface of albedo c and normal n shows c * (ambient + direct *
/// max(n . direction, 0)). For [`ColorSpace::DisplaySrgb`], c is encoded in sRGB.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FrameLight {
    /// Unit vector in the host's world towards the brighter one of sun and moon.
    pub direction: DVec3,
    /// Direct light of the sun or moon on a surface that faces it, after air, clouds and fog.
    pub direct: [f64; 3],
    /// Light of sky, clouds and fog, and of the fainter one of sun and moon, on level ground.
    pub ambient: [f64; 3],
    /// Light from the ground on a surface that faces down, for hosts with one ambient light from above and one from
    /// below.
    pub ambient_below: [f64; 3],
    /// Exposure with which Welkin draws the frame, display units per cd/m^2.
    pub exposure: f64,
}

impl Frame<'_> {
    /// Returns the light of sun, moon and sky at the camera, in the units of the frame's [`ColorSpace`] at its
    /// exposure. The images are not used.
    ///
    /// # Errors
    /// [`crate::Status::InvalidArgument`], which names the field that is out of range.
    pub fn light(&self, context: &Context) -> Result<FrameLight> {
        self.validate()?;
        let scene = context.scene_at(self.camera.position, context.time_s())?;
        let exposure = self.exposure.unwrap_or(context.exposure()).factor(scene.ground.adaptation_cd_m2);
        let ground = &scene.ground;
        let (main, facing, other, rest) = if scene.moon_is_brighter {
            (&scene.moon, ground.moon_lux, &scene.sun, ground.sun_lux)
        } else {
            (&scene.sun, ground.sun_lux, &scene.moon, ground.moon_lux)
        };
        let level = |light: &crate::moment::Light| light.direction.z.max(0.0);
        let diffuse = [0, 1, 2].map(|i| ground.sky_lux[i] + rest[i] * level(other));
        let albedo = scene.ground_albedo;
        let up = [0, 1, 2].map(|i| albedo[i] * (diffuse[i] + facing[i] * level(main)));
        let numbers =
            HostUnits { space: self.color_space, unit: self.cd_m2_per_unit, exposure, curve: context.tone_curve() };
        let zip = |a: [f64; 3], b: [f64; 3], f: &dyn Fn(f64, f64) -> f64| [0, 1, 2].map(|i| f(a[i], b[i]));
        Ok(FrameLight {
            direction: scene.world_to_enu.transpose() * main.direction,
            direct: zip(diffuse, facing, &|diffuse, facing| numbers.of(diffuse + facing) - numbers.of(diffuse)),
            ambient: diffuse.map(|e| numbers.of(e)),
            ambient_below: up.map(|e| numbers.of(e)),
            exposure,
        })
    }
}

/// Settings that convert illuminance to the host's values.
struct HostUnits {
    space: ColorSpace,
    /// Luminance of the value 1 in a scene-linear picture, cd/m^2.
    unit: f64,
    /// Display units per cd/m^2.
    exposure: f64,
    curve: ToneCurve,
}

impl HostUnits {
    /// Returns the host's value for white under `lux`, computed with the grey card.
    fn of(&self, lux: f64) -> f64 {
        let shown = || self.curve.apply(self.exposure * GREY * lux / PI);
        match self.space {
            ColorSpace::SceneLinear => lux / (PI * self.unit),
            ColorSpace::DisplayLinear => shown() / GREY,
            ColorSpace::DisplaySrgb => srgb_encode(shown()) / srgb_encode(GREY),
        }
    }
}
