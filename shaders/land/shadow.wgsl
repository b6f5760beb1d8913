// Draws the terrain into a shadow map: depths alone, as seen from the light.
//!include "land/vertex.wgsl"

@vertex
fn shadow_vertex(
    @builtin(vertex_index) index: u32,
    @location(0) low: vec2i,
    @location(1) page: vec2u,
) -> @builtin(position) vec4f {
    return patch_vertex(index, low, page).position;
}
