// Box of even cloud that replaces about.wgsl in the probe. The sides of the box, m, are (width along x, width along y,
// thickness of the layer). The ray starts at `box_origin`, measured from the corner at the base.
//!include "clouds/box.wgsl"
//!include "clouds/light.wgsl"

// A place in the box.
struct CloudPlace {
    // Position along x and y from the box's low corner, m.
    level: vec2f,
    // Height, 0 at the base to 1 at the top.
    height: f32,
}

// Cloud at a place; the names are those of about.wgsl.
struct CloudHere {
    // Excess over the threshold, always 0.
    excess: f32,
    // Extinction, 1/m.
    extinction: f32,
    // Share of the place that is cloud, always 1.
    share: f32,
}

// Blur of clouds, of which the box has none.
struct CloudBlur {
    // Standard deviation of the excess, always 0.
    spread: f32,
}

// Blur at the place that is looked up for a ray.
var<private> cloud_blur: CloudBlur;

// Returns no blur.
fn cloud_blur_over(layer: CloudLayer, width: f32) -> CloudBlur {
    return CloudBlur(0.0);
}

// Returns the cloud at a place: the same everywhere in the box.
fn cloud_here(layer: CloudLayer, at: CloudPlace) -> CloudHere {
    return CloudHere(0.0, layer.size.w, 1.0);
}

// Returns 1: the whole box is cloud.
fn cloud_inside(here: CloudHere) -> f32 {
    return 1.0;
}

// Returns the distance without cloud, m: none.
fn cloud_skip(layer: CloudLayer, here: CloudHere, height: f32, direction: vec3f) -> f32 {
    return 0.0;
}

// Longest path that a ray is followed, m: longer than any box.
const CLOUD_FARTHEST: f32 = 1.0e9;

// Returns the share of clouds left at a distance: all.
fn cloud_fades(within: f32) -> f32 {
    return 1.0;
}

// Returns the place on the ray at the distance `t`, m.
fn cloud_place(layer: CloudLayer, direction: vec3f, t: f32) -> CloudPlace {
    let at = box_origin + direction * t;
    return CloudPlace(at.xy, at.z * layer.size.y);
}

// Position in the box, m from its low corner.
fn box_place(layer: CloudLayer, at: CloudPlace) -> vec3f {
    let sides = box_sides(layer);
    return clamp(vec3f(at.level, at.height * sides.z), vec3f(0.0), sides);
}

// Length of cloud from a place along a direction, up to `most`, m.
fn cloud_way(layer: CloudLayer, at: CloudPlace, toward: vec3f, most: f32) -> f32 {
    return min(box_exit(box_place(layer, at), box_sides(layer), toward), most);
}

// Layer at a place: the same everywhere in the box.
struct CloudLocal {
    layer: CloudLayer,
}

// Returns the layer at a place.
fn cloud_local(layer: CloudLayer, level: vec2f) -> CloudLocal {
    return CloudLocal(layer);
}

// Returns the level position of a place; the box does not lean.
fn cloud_unleaned(layer: CloudLayer, at: CloudPlace) -> vec2f {
    return at.level;
}

// Scaled depths of cloud around a place: above, below, horizontally to the nearest side and to the one opposite.
fn cloud_box(layer: CloudLayer, at: CloudPlace, excess: f32) -> vec4f {
    let scaled = layer.size.w * layer.medium.y;
    let sides = box_sides(layer);
    let low = box_place(layer, at);
    let high = sides - low;
    let edge = min(min(low.x, high.x), min(low.y, high.y));
    return vec4f(high.z, low.z, edge, max(min(sides.x, sides.y) - edge, edge)) * scaled;
}

// Returns the scaled depths of cloud around a place. The sun stands on the side x = 0.
fn cloud_depths(layer: CloudLayer, at: CloudPlace, excess: f32) -> CloudDepths {
    let scaled = layer.size.w * layer.medium.y;
    let low = box_place(layer, at) * scaled;
    let high = box_sides(layer) * scaled - low;
    let to_sun = cloud_way(layer, at, clouds.to_sun, 1e9) * scaled;
    return CloudDepths(high.z, low.z, to_sun, low.x, high.x, low.y, high.y);
}

// Distance after which a ray meets other clouds; without blur it has no effect.
const CLOUD_CELL: f32 = 1.0;

// Returns the share of sunlight that other clouds leave: all.
fn cloud_sunlit(layer: CloudLayer, at: CloudPlace, here: CloudHere) -> f32 {
    return 1.0;
}
