// Tests for shelter, which rain does not pass: the host's boxes (f64 reference: src/surroundings/shelter.rs) and the
// surfaces in its occluder maps. Each test follows a drop's path back from where the drop is now.
//!include "surroundings/occluders.wgsl"

// Whether there is any shelter. Shaders that run in every pixel read it to leave the tests out.
override SHELTER: bool = false;

// Largest number of boxes.
const MAX_SHELTERS: u32 = 32u;
// Largest number of planes that cut boxes, all boxes together.
const MAX_CUTS: u32 = 512u;

// One box.
struct Shelter {
    // Rows of the matrix from camera-relative east, north, up (m) to the box's own space, where the box spans -1 to 1.
    rows: array<vec4f, 3>,
    // Velocity, (east, north, up), m/s; w is 1 for a box that moves, 0 for one that stands still.
    velocity: vec4f,
    // x: index of the first plane that cuts the box; y: index after the last one.
    cuts: vec4u,
}

// All boxes.
struct Shelters {
    // Number of boxes that may shelter drops near the camera. These come first in the list.
    near: u32,
    // Number of all boxes.
    count: u32,
    boxes: array<Shelter, MAX_SHELTERS>,
    // Planes in their boxes' own space: outward normal, distance from the middle.
    cuts: array<vec4f, MAX_CUTS>,
}

@group(2) @binding(0) var<uniform> shelters: Shelters;

// Returns the time, s, that a drop which came to `p` with `velocity` has spent inside the shape of box `i`, cut by its
// planes. The time is negative if the drop has not been inside: the farther away the drop passed, the lower the time.
fn time_within(i: u32, p: vec3f, velocity: vec3f) -> f32 {
    return time_nearby(i, p, velocity, 0.0);
}

// Returns the time of `time_within` for a box whose sides and planes lie `margin` m farther out.
fn time_nearby(i: u32, p: vec3f, velocity: vec3f, margin: f32) -> f32 {
    let back = shelters.boxes[i].velocity.xyz - velocity;
    let rows = shelters.boxes[i].rows;
    let o = vec3f(dot(rows[0].xyz, p), dot(rows[1].xyz, p), dot(rows[2].xyz, p)) + vec3f(rows[0].w, rows[1].w, rows[2].w);
    let d = vec3f(dot(rows[0].xyz, back), dot(rows[1].xyz, back), dot(rows[2].xyz, back));
    let inverse = 1.0 / select(d, vec3f(1e-9), abs(d) < vec3f(1e-9));
    let side = 1.0 + margin * vec3f(length(rows[0].xyz), length(rows[1].xyz), length(rows[2].xyz));
    let low = min((-side - o) * inverse, (side - o) * inverse);
    let high = max((-side - o) * inverse, (side - o) * inverse);
    var near = max(max(low.x, low.y), max(low.z, 0.0));
    var far = min(high.x, min(high.y, high.z));
    for (var j = shelters.boxes[i].cuts.x; j < (shelters.boxes[i].cuts.y & 1023u); j++) {
        let plane = shelters.cuts[j];
        let rate = dot(plane.xyz, d);
        let out = margin * length(plane.x * rows[0].xyz + plane.y * rows[1].xyz + plane.z * rows[2].xyz);
        let at = (plane.w + out - dot(plane.xyz, o)) / select(rate, 1e-9, abs(rate) < 1e-9);
        near = select(near, max(near, at), rate <= -1e-9);
        far = select(min(far, at), far, rate <= -1e-9);
    }
    return far - near;
}

// Returns whether a drop near the camera that came to `p` with `velocity` met a box or a mapped surface on its way.
// Returns false if the answer is not `wanted`: the loops then start at their end, and a software driver skips such
// loops.
fn sheltered(p: vec3f, velocity: vec3f, wanted: bool) -> bool {
    return sheltered_nearby(p, velocity, 0.0, wanted);
}

// Returns the answer of `sheltered` for boxes whose sides lie `margin` m farther out.
fn sheltered_nearby(p: vec3f, velocity: vec3f, margin: f32, wanted: bool) -> bool {
    for (var i = select(MAX_SHELTERS, 0u, wanted); i < (shelters.near & 63u); i++) {
        if time_nearby(i, p, velocity, margin) >= 0.0 {
            return true;
        }
    }
    if MAPS {
        for (var i = select(MAX_MAPS, 0u, wanted); i < (occluders.count & 7u); i++) {
            if crosses(i, p, velocity) {
                return true;
            }
        }
    }
    return false;
}

// Returns whether a mapped surface that stands still keeps rain off the ground at `p`. Moving surfaces do not count:
// ground stays wet when an object only passes over it.
fn mapped_ground(p: vec3f, velocity: vec3f, wanted: bool) -> bool {
    if MAPS {
        for (var i = select(MAX_MAPS, 0u, wanted); i < (occluders.count & 7u); i++) {
            if occluders.maps[i].velocity.w == 0.0 && crosses(i, p, velocity) {
                return true;
            }
        }
    }
    return false;
}

// Returns the longest `time_within` among the boxes that stand still; negative if the drop met none of them.
fn time_in_standing(p: vec3f, velocity: vec3f, wanted: bool) -> f32 {
    var time = -1e9;
    for (var i = select(MAX_SHELTERS, 0u, wanted); i < (shelters.count & 63u); i++) {
        if shelters.boxes[i].velocity.w == 0.0 {
            time = max(time, time_within(i, p, velocity));
        }
    }
    return time;
}
