// What rain does not pass: boxes (the f64 twin is in src/rain/shelter.rs) and what the host has taken maps of.
//!include "rain/occluders.wgsl"

const MAX_SHELTERS: u32 = 32u;

struct Shelter {
    // From camera-relative east-north-up into the box's own space, where it reaches from -1 to 1.
    rows: array<vec4f, 3>,
    // m/s; not 0 in the last: it moves.
    velocity: vec4f,
}

struct Shelters {
    // Those that matter to drops near the camera, which come first, and all of them.
    near: u32,
    count: u32,
    boxes: array<Shelter, MAX_SHELTERS>,
}

@group(2) @binding(0) var<uniform> shelters: Shelters;

// Whether what came to `p` with `velocity` met box `i`.
fn meets(i: u32, p: vec3f, velocity: vec3f) -> bool {
    let back = shelters.boxes[i].velocity.xyz - velocity;
    var near = 0.0;
    var far = 1e30;
    for (var j = 0u; j < 3u; j++) {
        let row = shelters.boxes[i].rows[j];
        let o = dot(row.xyz, p) + row.w;
        let d = dot(row.xyz, back);
        let inverse = 1.0 / select(d, 1e-9, abs(d) < 1e-9);
        let a = (-1.0 - o) * inverse;
        let c = (1.0 - o) * inverse;
        near = max(near, min(a, c));
        far = min(far, max(a, c));
    }
    return far >= near;
}

// Whether what came to `p`, near the camera, with `velocity` met anything. Not looked for where it is not `wanted`: by loops that
// are not begun, which is what a software driver leaves out.
fn sheltered(p: vec3f, velocity: vec3f, wanted: bool) -> bool {
    for (var i = select(MAX_SHELTERS, 0u, wanted); i < shelters.near; i++) {
        if meets(i, p, velocity) {
            return true;
        }
    }
    if MAPS {
        for (var i = select(MAX_MAPS, 0u, wanted); i < occluders.count; i++) {
            if crosses(i, p, velocity) {
                return true;
            }
        }
    }
    return false;
}

// Likewise for ground, which remembers: what only passes by does not keep it dry.
fn sheltered_ground(p: vec3f, velocity: vec3f) -> bool {
    for (var i = 0u; i < shelters.count; i++) {
        if shelters.boxes[i].velocity.w == 0.0 && meets(i, p, velocity) {
            return true;
        }
    }
    if MAPS {
        for (var i = 0u; i < occluders.count; i++) {
            if occluders.maps[i].velocity.w == 0.0 && crosses(i, p, velocity) {
                return true;
            }
        }
    }
    return false;
}
