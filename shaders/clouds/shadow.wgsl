// Draws the clouds' shadow map: the share of the direct light that clouds let through to a level plane. The f64
// reference is src/clouds/light/shadow.rs. The texels move with the air that carries the clouds, and the map repeats. A
// texel covers one place in each period of the map, and is drawn for the place nearest to the camera.
//!include "common/fullscreen.wgsl"
//!include "clouds/about.wgsl"
//!include "clouds/shadow_map.wgsl"

// Placement of the shadow map.
@group(0) @binding(7) var<uniform> shadows: CloudShadows;

// Side of the map, texels.
override SHADOW_TEXELS: f32 = 512.0;

// Number of steps along the path through a layer.
const SHADOW_STEPS: u32 = 12u;

// Optical depth of a layer on the path of light to a place in the plane.
fn shadow_depth(layer: CloudLayer, level: vec2f) -> f32 {
    let slant = shadows.to_light.xy / shadows.to_light.z;
    let below = layer.size.x - shadows.plane;
    let step = 1.0 / (layer.size.y * f32(SHADOW_STEPS));
    var depth = 0.0;
    for (var i = 0u; i < SHADOW_STEPS; i++) {
        let rise = (f32(i) + 0.5) * step;
        let at = CloudPlace(level + slant * (below + rise), rise * layer.size.y);
        depth += cloud_here(layer, at).extinction;
    }
    return depth * step / shadows.to_light.z;
}

// Computes one texel of the shadow map.
@fragment
fn shadow(in: FullscreenVarying) -> @location(0) vec4f {
    let away = fract(in.position.xy / SHADOW_TEXELS - shadows.camera + 0.5) - 0.5;
    var depth = 0.0;
    for (var k = 0u; k < cloud_layers(); k++) {
        depth += shadow_depth(clouds.layers[k], away * shadows.period);
    }
    return vec4f(exp(-depth));
}
