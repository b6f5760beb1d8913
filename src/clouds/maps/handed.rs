//! Shadow map of the clouds as a texture for a host's own materials. `shaders/clouds/shadow_map.wgsl` and the published
//! snippets have the same mapping.

use glam::{DVec2, DVec3, DVec4};

use super::shadow_projection::ShadowProjection;
use crate::moment::SceneMoment;

/// Shadow map of the clouds for a host's own materials. The texture is valid until the view is destroyed. The other
/// fields change with each frame; get them again after it.
///
/// The map lies in a level plane at the altitude of the weather's station and moves with the air that carries the
/// clouds. It repeats every 20.48 km.
#[derive(Clone, Debug)]
pub struct CloudShadows {
    /// Share of the direct light that clouds let through. The light is that of the sun or the moon, whichever is
    /// brighter. The texture has one channel of 8 bits.
    pub texture: wgpu::Texture,
    /// Vectors whose dot products with (x, y, z, 1) of a place in the host's world, m, are the texture coordinates u
    /// and v of the place. The mapping projects the place along the light onto the plane.
    pub uv_from_world: [DVec4; 2],
    /// Vector whose dot product with (x, y, z, 1) of a place in the host's world, m, is the place's height above the
    /// plane, m.
    pub height_from_world: DVec4,
    /// Texture coordinates u and v of the last frame's camera, projected vertically onto the plane.
    pub camera_uv: [f64; 2],
    /// Mean share of the direct light over all places, as in [`Context::light_at`](crate::context::Context::light_at).
    pub mean_share: f64,
    /// Weight of the map against `mean_share`, 0 to 1. It is 0 without broken clouds, with the deck, and under a light
    /// near the horizon.
    pub map_weight: f64,
    /// Height above the plane, m: 100 m above the base of the lowest clouds. At and above it `mean_share` holds instead
    /// of the map.
    pub top_m: f64,
}

/// WGSL text of the function that samples [`CloudShadows`].
pub const SHADOW_SNIPPET_WGSL: &str = include_str!("../../../shaders/snippets/welkin_cloud_shadow.wgsl");
/// GLSL 3.30 text of the function that samples [`CloudShadows`].
pub const SHADOW_SNIPPET_GLSL: &str = include_str!("../../../shaders/snippets/welkin_cloud_shadow.glsl");

/// Texture that a host has asked for, with the mapping of the last frame.
pub(crate) struct HostShadowTexture {
    /// Texture and mapping as the host gets them.
    pub shadows: CloudShadows,
}

impl HostShadowTexture {
    /// Creates the mapping of a texture, without weight until the first frame.
    pub fn new(texture: wgpu::Texture) -> Self {
        let none = [DVec4::ZERO; 2];
        let shadows = CloudShadows {
            texture,
            uv_from_world: none,
            height_from_world: DVec4::ZERO,
            camera_uv: [0.0; 2],
            mean_share: 1.0,
            map_weight: 0.0,
            top_m: 0.0,
        };
        Self { shadows }
    }

    /// Stores the mapping of a frame. `projection` is `None` if no clouds cast shadows that the map shows.
    pub fn lay(&mut self, now: &SceneMoment<'_>, projection: Option<&ShadowProjection>) {
        let shadows = &mut self.shadows;
        shadows.mean_share = now.scene.brighter().direct_share;
        let Some(projection) = projection else {
            shadows.map_weight = 0.0;
            return;
        };
        let rows = now.scene.world_to_enu.transpose();
        let slant = projection.to_light.truncate() / projection.to_light.z;
        let row = |v: DVec3, offset: f64| v.extend(offset - v.dot(now.eye));
        shadows.height_from_world = row(rows.z_axis, projection.eye_m);
        let one = |axis: DVec3, slant: f64, camera: f64| {
            row(
                (axis - rows.z_axis * slant) / projection.period_m,
                camera - slant * projection.eye_m / projection.period_m,
            )
        };
        let camera: DVec2 = projection.camera;
        shadows.uv_from_world = [one(rows.x_axis, slant.x, camera.x), one(rows.y_axis, slant.y, camera.y)];
        shadows.camera_uv = camera.to_array();
        (shadows.map_weight, shadows.top_m) = (projection.map_weight, projection.top_m);
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
