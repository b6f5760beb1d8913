//! Code that effects share to draw precipitation near the camera: the camera with its exposure, the layer in front of
//! the picture, and the contrast.

use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use glam::{DMat4, DVec2, DVec3};

use crate::{
    gpu::{Device, Layer},
    light::luminance,
    scene::ViewRays,
    stage::{DrawContext, Tone},
};

/// Format of the layer: premultiplied light times the picture's exposure, and opacity.
pub(crate) const LAYER_FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Rgba16Float;

/// Smallest drawn width of a streak or a flake, pixels: `LEAST_PIXELS` of `shaders/common/streak.wgsl`.
pub(crate) const LEAST_PIXELS: f64 = 1.2;

/// Camera with an exposure time, during which falling things become streaks.
pub(crate) struct StreakCamera<'a> {
    /// Matrix from camera-relative east, north, up to clip space.
    pub clip: DMat4,
    /// View rays of the camera.
    pub rays: &'a ViewRays,
    /// Height of the picture, pixels.
    pub height: u32,
    /// 1 if row 0 of the target is the picture's top, -1 if it is the bottom.
    pub y_sign: f32,
    /// Position of the camera, m, east, north and up from a point fixed to the world.
    pub position_m: DVec3,
    /// Velocity of the camera, m/s (east, north, up).
    pub velocity_m_s: DVec3,
    /// Exposure time of the picture, s.
    pub exposure_s: f64,
    /// Factor by which precipitation stands out more than in nature, 1 or more.
    pub gain: f64,
}

impl<'a> StreakCamera<'a> {
    /// Creates the camera of a draw, with the exposure time `exposure_s`.
    pub fn new(context: &DrawContext<'a>, exposure_s: f64, gain: f64) -> Self {
        let scene = &context.now.scene;
        Self {
            clip: context.clip(),
            rays: context.target.rays,
            height: context.picture().height(),
            y_sign: if context.frame.origin_bottom_left { -1.0 } else { 1.0 },
            position_m: DVec3::new(scene.map_m[0], scene.map_m[1], scene.place.altitude_m),
            velocity_m_s: scene.world_to_enu * context.frame.camera_velocity_m_s,
            exposure_s,
            gain,
        }
    }
}

/// Variant of the fragment shaders of rain and snow by how they read the host's depth.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct DepthRead {
    /// Whether the depth is multisampled.
    pub multi: bool,
    /// Whether there is a depth.
    pub any: bool,
    /// Kinds of depth that the shader must read, one bit each: the value of `DEPTH_KINDS` of `common/depth.wgsl`.
    pub kinds: u32,
}

impl DepthRead {
    /// Returns how shaders read the host's depth; `depth` is `None` if the host gives none.
    pub fn of(depth: Option<Layer<'_>>, rays: &ViewRays) -> Self {
        Self { multi: depth.is_some_and(Layer::is_multisampled), any: depth.is_some(), kinds: rays.depth_kinds() }
    }

    /// Returns the variant of a shader file that reads this depth. The file must include `common/host.wgsl`.
    pub fn shader(self, name: &str) -> String {
        format!("{name}{}", if self.multi { ":multi" } else { "" })
    }

    /// Returns the constants of the fragment shaders.
    pub fn constants(self) -> [(&'static str, f64); 2] {
        [("HAS_DEPTH", f64::from(u8::from(self.any))), ("DEPTH_KINDS", self.kinds.into())]
    }
}

/// Layer of precipitation near the camera, composited in front of the picture: premultiplied light and opacity, one
/// sample per pixel. All effects of a view that draw into the layer share it: clones are the same layer.
#[derive(Clone, Default)]
pub(crate) struct FallingTexture(Arc<Mutex<Option<(wgpu::Texture, wgpu::TextureView)>>>);

impl FallingTexture {
    /// Locks the layer.
    fn locked(&self) -> MutexGuard<'_, Option<(wgpu::Texture, wgpu::TextureView)>> {
        // After a panic elsewhere there is a complete layer or none; both are valid.
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Returns the layer for a picture of this size, recreated if the size has changed. A layer that is not recreated
    /// keeps the content of its last draw.
    pub fn view(&self, device: &Device, size: wgpu::Extent3d) -> wgpu::TextureView {
        let mut held = self.locked();
        if held.as_ref().is_none_or(|(t, _)| (t.width(), t.height()) != (size.width, size.height)) {
            *held = None;
        }
        let make = || {
            let texture = device.device.create_texture(&wgpu::TextureDescriptor {
                label: Some("what falls"),
                size: wgpu::Extent3d { depth_or_array_layers: 1, ..size },
                mip_level_count: 1,
                sample_count: 1,
                dimension: wgpu::TextureDimension::D2,
                format: LAYER_FORMAT,
                usage: wgpu::TextureUsages::RENDER_ATTACHMENT | wgpu::TextureUsages::TEXTURE_BINDING,
                view_formats: &[],
            });
            let view = texture.create_view(&Default::default());
            (texture, view)
        };
        held.get_or_insert_with(make).1.clone()
    }

    /// Returns the existing layer, if there is one.
    pub fn held(&self) -> Option<wgpu::TextureView> {
        self.locked().as_ref().map(|(_, view)| view.clone())
    }

    /// Returns the bytes of GPU memory held.
    pub fn bytes(&self) -> u64 {
        self.locked().as_ref().map_or(0, |(t, _)| 8 * u64::from(t.width()) * u64::from(t.height()))
    }

    /// Drops the layer, for example because the driver did not have enough memory for it.
    pub fn forget(&self) {
        *self.locked() = None;
    }
}

/// Begins a pass that draws into the layer. The layer is cleared first, unless `keeps` is set.
pub(crate) fn layer_pass<'a>(
    encoder: &'a mut wgpu::CommandEncoder,
    label: &str,
    layer: &wgpu::TextureView,
    keeps: bool,
) -> wgpu::RenderPass<'a> {
    let load = if keeps { wgpu::LoadOp::Load } else { wgpu::LoadOp::Clear(wgpu::Color::TRANSPARENT) };
    encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
        label: Some(label),
        color_attachments: &[Some(wgpu::RenderPassColorAttachment {
            view: layer,
            depth_slice: None,
            resolve_target: None,
            ops: wgpu::Operations { load, store: wgpu::StoreOp::Store },
        })],
        ..Default::default()
    })
}

/// Number of deviations that a [`StreakContrast`] tabulates, at equal steps of the sine of the angle between line of
/// sight and streaks.
const ANGLES: usize = 9;

/// Contrast of streaks in a picture, for the plan.
#[derive(Clone, Copy, Debug)]
pub(crate) struct StreakContrast {
    rays: ViewRays,
    /// 1 where row 0 of the target is the picture's top, -1 where it is the bottom.
    y_sign: f64,
    /// Unit vector of the drops' or flakes' motion relative to the camera, (east, north, up).
    axis: DVec3,
    /// Standard deviation, from pixel to pixel, of the share of a pixel that drops or flakes cover, tabulated over the
    /// sine of the angle between line of sight and axis, from 0 to 1.
    deviations: [f64; ANGLES],
    /// Function from a luminance to the picture's exposed luminance.
    tone: Tone,
    /// Whether there are lamps, which may make drops and flakes arbitrarily bright.
    lamps: bool,
}

impl StreakContrast {
    /// Creates the contrast of drops or flakes that move with `velocity_m_s` in front of a camera. `variance` takes the
    /// distance that they move across the line of sight during the exposure, m, and returns the variance from pixel to
    /// pixel of the share of a pixel that they cover.
    pub fn new(
        shot: &StreakCamera<'_>,
        velocity_m_s: DVec3,
        variance: impl Fn(f64) -> f64,
        (tone, lamps): (Tone, bool),
    ) -> Self {
        let relative = velocity_m_s - shot.velocity_m_s;
        let travel = relative.length() * shot.exposure_s;
        let deviations = std::array::from_fn(|i| variance(i as f64 / (ANGLES - 1) as f64 * travel).sqrt());
        let axis = relative.normalize_or(DVec3::NEG_Z);
        Self { rays: *shot.rays, y_sign: shot.y_sign.into(), axis, deviations, tone, lamps }
    }

    /// Returns two numbers for pixel `i` with the exposed luminance Y = `picture` (1 is white). The first is the
    /// pixel's relative change dY / (Y + 0.01) by drops or flakes of the exposed luminance L, the second their contrast
    /// (L - Y) / (Y + 0.01). L follows from `radiance`(direction); with lamps the contrast is set to 1000. The change
    /// is a sample from the distribution over the pixels of a picture, so only the statistics of many pixels are
    /// meaningful.
    pub fn at(&self, i: usize, ndc: DVec2, picture: f64, radiance: impl Fn(DVec3) -> DVec3) -> [f64; 2] {
        let d = self.rays.view_ray(DVec2::new(ndc.x, ndc.y * self.y_sign)).direction;
        let at = d.cross(self.axis).length().min(1.0) * (ANGLES - 1) as f64;
        let low = (at as usize).min(ANGLES - 2);
        let part = at - low as f64;
        let deviation = self.deviations[low] * (1.0 - part) + self.deviations[low + 1] * part;
        let bright = (self.tone)(luminance(&radiance(d).to_array()));
        let contrast = if self.lamps { 1e3 } else { (bright - picture) / (picture + 0.01) };
        // Low-discrepancy points in two dimensions (Roberts 2018), mapped to a normal distribution (Box and Muller
        // 1958).
        let spread = |step: f64| ((i as f64 + 0.5) * step).fract();
        let (u, v) = (spread(0.754_877_666_246_692_8), spread(0.569_840_290_998_053_3));
        let normal = (-2.0 * libm::log(1.0 - u)).sqrt() * libm::cos(std::f64::consts::TAU * v);
        [normal * deviation * contrast, contrast]
    }
}
