// Box of even cloud for the probe (probe.wgsl), and the origin of the probe's ray in the box. The probe's block has one
// layer, the box: `sheets.xy` are its two level sides, m, and `size.y` is 1/thickness, 1/m.
//!include "clouds/block.wgsl"

// Origin of the ray, m from the corner of the box where x, y and height are least.
var<private> box_origin: vec3f;

// Sides of the box along x, along y and upwards, m.
fn box_sides(layer: CloudLayer) -> vec3f {
    return vec3f(layer.sheets.xy, 1.0 / layer.size.y);
}

// Distance from a place in a box along a direction to where the ray leaves the box, m.
fn box_exit(at: vec3f, sides: vec3f, direction: vec3f) -> f32 {
    let to = select(at, sides - at, direction > vec3f(0.0)) / max(abs(direction), vec3f(1e-9));
    return max(min(min(to.x, to.y), to.z), 0.0);
}
