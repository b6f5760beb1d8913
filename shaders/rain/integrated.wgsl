// Streaks of drops that are stepped (rain/step.wgsl), from their states.
//!include "rain/drops.wgsl"

struct Stepped {
    @location(0) place: vec4u,
    @location(1) velocity: vec4f,
}

@group(1) @binding(0) var<uniform> eyes: array<vec4u, 4>;

@vertex
fn integrated_vertex(
    @builtin(vertex_index) corner: u32,
    @builtin(instance_index) index: u32,
    stepped: Stepped,
) -> RainVarying {
    let s = stepped.place.w & 0xffffu;
    let k = class_of(index);
    let first = select(0u, u32(rain.classes[max(k, 1u) - 1u].z), k > 0u);
    let drop = drop_at(s, k, index - first, stepped.place.xyz - eyes[s].xyz);
    return streak_of(drop, stepped.velocity.xyz, corner);
}
