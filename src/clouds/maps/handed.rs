//! The map of the clouds' shadows as a texture for a host's own materials. The mapping is that of
//! `shaders/clouds/shadow_map.wgsl` and of the published snippets.

use glam::{DVec2, DVec3, DVec4};

use super::shadow_projection::ShadowProjection;
use crate::moment::SceneMoment;

/// Map of the clouds' shadows for a host's own materials. The texture is valid until the view is destroyed; ask for all
/// else after each frame.
///
/// The map is a plane at the station's height, fixed to the air that carries the clouds, and repeats: 20 km from side
/// to side.
#[derive(Clone, Debug)]
pub struct CloudShadows {
    /// Share of the direct light of sun or moon, whichever is brighter, that clouds let through: one channel of 8 bits.
    pub texture: wgpu::Texture,
    /// Multiplied by (x, y, z, 1) of a place in the host's world, m, they give its u and v. They follow the light to
    /// the plane.
    pub uv_from_world: [DVec4; 2],
    /// Vector that, multiplied by (x, y, z, 1) of a place in the host's world, m, gives its height over the plane, m.
    pub height_from_world: DVec4,
    /// u and v of the place in the plane that the camera of the last frame stood over.
    pub camera_uv: [f64; 2],
    /// Share of the direct light on the mean over places: that in
    /// [`Context::light_at`](crate::context::Context::light_at).
    pub mean_share: f64,
    /// How far shadows are told apart, 0 to 1: 0 without broken clouds, with the deck, and under a light near the
    /// horizon.
    pub told: f64,
    /// Height over the plane, m, from which on shadows are not told apart: 100 m above the base of the lowest clouds.
    pub top_m: f64,
}

/// WGSL text of the sampling function; see [`CloudShadows`].
pub const SHADOW_SNIPPET_WGSL: &str = include_str!("../../../shaders/snippets/welkin_cloud_shadow.wgsl");
/// GLSL 3.30 text of the sampling function.
pub const SHADOW_SNIPPET_GLSL: &str = include_str!("../../../shaders/snippets/welkin_cloud_shadow.glsl");

/// The texture that a host has asked for, and how it lay in the last frame.
pub(crate) struct HostShadowTexture {
    pub shadows: CloudShadows,
}

impl HostShadowTexture {
    pub fn new(texture: wgpu::Texture) -> Self {
        let none = [DVec4::ZERO; 2];
        let shadows = CloudShadows {
            texture,
            uv_from_world: none,
            height_from_world: DVec4::ZERO,
            camera_uv: [0.0; 2],
            mean_share: 1.0,
            told: 0.0,
            top_m: 0.0,
        };
        Self { shadows }
    }

    /// Takes over how the map lies in a frame; `None` where no clouds cast shadows that are told apart.
    pub fn lay(&mut self, now: &SceneMoment<'_>, lie: Option<&ShadowProjection>) {
        let shadows = &mut self.shadows;
        shadows.mean_share = now.scene.brighter().direct_share;
        let Some(lie) = lie else {
            shadows.told = 0.0;
            return;
        };
        let rows = now.scene.world_to_enu.transpose();
        let slant = lie.to_light.truncate() / lie.to_light.z;
        let row = |v: DVec3, offset: f64| v.extend(offset - v.dot(now.eye));
        shadows.height_from_world = row(rows.z_axis, lie.eye_m);
        let one = |axis: DVec3, slant: f64, camera: f64| {
            row((axis - rows.z_axis * slant) / lie.period_m, camera - slant * lie.eye_m / lie.period_m)
        };
        let camera: DVec2 = lie.camera;
        shadows.uv_from_world = [one(rows.x_axis, slant.x, camera.x), one(rows.y_axis, slant.y, camera.y)];
        shadows.camera_uv = camera.to_array();
        (shadows.told, shadows.top_m) = (lie.told, lie.top_m);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::gpu::shader;

    #[test]
    fn the_snippets_are_valid_and_have_the_numbers_of_what_is_drawn() {
        shader::validate(SHADOW_SNIPPET_WGSL).unwrap();
        let drawn = shader::assemble("clouds/shadow_map.wgsl").unwrap();
        for text in [SHADOW_SNIPPET_WGSL, SHADOW_SNIPPET_GLSL, drawn.as_str()] {
            for number in ["(0.46 - far) / 0.06", "/ 100.0, 0.0, 1.0)"] {
                assert!(text.contains(number), "{number}: {text}");
            }
        }
    }
}
