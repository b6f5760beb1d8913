// A map of the shadows that clouds cast on a level plane: the share of the direct light that they let through. Twin of
// src/clouds/light/shadow.rs. Its texels are fixed to the air that carries the clouds and repeat: each stands for the
// place nearest to the camera.
//!include "common/fullscreen.wgsl"
//!include "clouds/about.wgsl"
//!include "clouds/shadow_map.wgsl"

@group(0) @binding(7) var<uniform> shadows: CloudShadows;

// Along a side of the map.
override SHADOW_TEXELS: f32 = 512.0;

const SHADOW_STEPS: u32 = 12u;

// Optical depth of a layer on the way of light to a place in the plane.
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

@fragment
fn shadow(in: FullscreenVarying) -> @location(0) vec4f {
    let away = fract(in.position.xy / SHADOW_TEXELS - shadows.camera + 0.5) - 0.5;
    var depth = 0.0;
    for (var k = 0u; k < cloud_layers(); k++) {
        depth += shadow_depth(clouds.layers[k], away * shadows.period);
    }
    return vec4f(exp(-depth));
}
