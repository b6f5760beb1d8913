// In place of about.wgsl: a box of even cloud, for the probe. Its sides, in metres, are (width along x, width along y, thickness of the
// layer); the ray starts at `box_origin` in it, from its corner at the base.
//!include "clouds/box.wgsl"
//!include "clouds/light.wgsl"

struct CloudPlace {
    level: vec2f,
    height: f32,
}

struct CloudHere {
    excess: f32,
    extinction: f32,
}

fn cloud_here(layer: CloudLayer, at: CloudPlace) -> CloudHere {
    return CloudHere(0.0, layer.size.w);
}

// All of a box is cloud.
fn cloud_inside(here: CloudHere) -> f32 {
    return 1.0;
}

fn cloud_skip(layer: CloudLayer, here: CloudHere, height: f32, direction: vec3f) -> f32 {
    return 0.0;
}

const CLOUD_FARTHEST: f32 = 1.0e9;

fn cloud_fades(within: f32) -> f32 {
    return 1.0;
}

fn cloud_place(layer: CloudLayer, direction: vec3f, t: f32) -> CloudPlace {
    let at = box_origin + direction * t;
    return CloudPlace(at.xy, at.z * layer.size.y);
}

// The sun stands over the box's side x = 0.
fn cloud_depths(layer: CloudLayer, at: CloudPlace, excess: f32) -> CloudDepths {
    let sides = box_sides(layer);
    let place = clamp(vec3f(at.level, at.height * sides.z), vec3f(0.0), sides);
    let scaled = layer.size.w * layer.medium.y;
    let low = place * scaled;
    let high = (sides - place) * scaled;
    let to_sun = box_exit(place, sides, clouds.to_sun) * scaled;
    return CloudDepths(high.z, low.z, to_sun, low.x, high.x, low.y, high.y);
}
