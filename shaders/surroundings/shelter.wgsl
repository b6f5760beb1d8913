// What rain does not pass: boxes (the f64 twin is in src/surroundings/shelter.rs) and what the host has taken maps of.
//!include "surroundings/occluders.wgsl"

// Whether anything keeps rain off. Read by what is drawn in every pixel.
override SHELTER: bool = false;

const MAX_SHELTERS: u32 = 32u;
const MAX_CUTS: u32 = 512u;

struct Shelter {
    // From camera-relative east-north-up into the box's own space, where it reaches from -1 to 1.
    rows: array<vec4f, 3>,
    // m/s; not 0 in the last: it moves.
    velocity: vec4f,
    // Of the planes that cut it, the first and the one behind its last.
    cuts: vec4u,
}

struct Shelters {
    // Those that matter to drops near the camera, which come first, and all of them.
    near: u32,
    count: u32,
    boxes: array<Shelter, MAX_SHELTERS>,
    // In the own space of their boxes: outward normal, distance.
    cuts: array<vec4f, MAX_CUTS>,
}

@group(2) @binding(0) var<uniform> shelters: Shelters;

// For how long what came to `p` with `velocity` was in box `i`, or in what planes leave of it, s; below 0: it has not
// been, and how far it was from it.
fn time_within(i: u32, p: vec3f, velocity: vec3f) -> f32 {
    return time_nearby(i, p, velocity, 0.0);
}

// Likewise of a box with all its sides, and planes, so many metres further out.
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

// Whether what came to `p`, near the camera, with `velocity` met anything. Not looked for where it is not `wanted`: by
// loops that are not begun, which is what a software driver leaves out.
fn sheltered(p: vec3f, velocity: vec3f, wanted: bool) -> bool {
    return sheltered_nearby(p, velocity, 0.0, wanted);
}

// Likewise with boxes so many metres wider to all sides.
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

// Likewise for ground, which remembers: what only passes by does not keep it dry.
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

// Longest time that what came to `p` was in a box that stands, as `time_within` has it.
fn time_in_standing(p: vec3f, velocity: vec3f, wanted: bool) -> f32 {
    var time = -1e9;
    for (var i = select(MAX_SHELTERS, 0u, wanted); i < (shelters.count & 63u); i++) {
        if shelters.boxes[i].velocity.w == 0.0 {
            time = max(time, time_within(i, p, velocity));
        }
    }
    return time;
}
