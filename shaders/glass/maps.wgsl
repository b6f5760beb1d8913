// Share of the rain that the host's maps let through to each node over the pane (src/glass/reach.rs).
//!include "common/fullscreen.wgsl"
//!include "surroundings/occluders.wgsl"

// Number of drop sizes tested at each node.
const SIZES: u32 = 6u;
// Value of a node that all of the rain reaches.
const ALL_OF_IT: f32 = 128.0;

// Block of the pane and its drops.
struct PaneUniform {
    // Position in front of the first node, and the vectors from there to the last node along the lower edge and up the
    // glass; relative to the camera, m.
    origin: vec4f,
    along: vec4f,
    up: vec4f,
    // Drops, each of which represents a share of the water. xyz: velocity, (east, north, up), m/s. w: share of the
    // water on the pane that the drop represents.
    drops: array<vec4f, SIZES>,
}

@group(0) @binding(0) var<uniform> pane: PaneUniform;

// Returns the share of the rain that the maps let through to a node, in 1/128.
@fragment
fn reach_by_maps(in: FullscreenVarying) -> @location(0) vec4u {
    let place = floor(in.position.xy) / vec2f(15.0, 7.0);
    let p = (pane.origin + pane.along * place.x + pane.up * place.y).xyz;
    var kept = 0.0;
    for (var k = 0u; k < SIZES; k++) {
        for (var i = 0u; i < (occluders.count & 7u); i++) {
            if crosses(i, p, pane.drops[k].xyz) {
                kept += pane.drops[k].w;
                break;
            }
        }
    }
    return vec4u(u32(max(1.0 - kept, 0.0) * ALL_OF_IT + 0.5), 0u, 0u, 0u);
}
