// Boxes that rain does not pass; the f64 twin is in src/rain/shelter.rs.

const MAX_SHELTERS: u32 = 32u;

struct Shelter {
    // From camera-relative east-north-up into the box's own space, where it reaches from -1 to 1.
    rows: array<vec4f, 3>,
    // m/s.
    velocity: vec4f,
}

struct Shelters {
    count: u32,
    boxes: array<Shelter, MAX_SHELTERS>,
}

@group(0) @binding(2) var<uniform> shelters: Shelters;

// Whether what came to `p` with `velocity` met a box.
fn sheltered(p: vec3f, velocity: vec3f) -> bool {
    for (var i = 0u; i < shelters.count; i++) {
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
        if far >= near {
            return true;
        }
    }
    return false;
}
