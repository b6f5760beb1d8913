// Entry points of stones in front of a host's picture.
//!include "rain/drops_view.wgsl"
//!include "rain/stones.wgsl"

// Returns a corner of the quad of a stone that bounces.
@vertex
fn hopping_vertex(@builtin(vertex_index) corner: u32, @builtin(instance_index) instance: u32) -> StoneVarying {
    let touch = touch_of(instance);
    return hopping_corner(touch, ground_below(touch.landing, stones.ground), corner);
}

// Returns the premultiplied light of a pixel of a stone.
@fragment
fn stone_fragment(in: StoneVarying) -> @location(0) vec4f {
    return stone_color(in, shown_at(in.position));
}
