// How many drops of each class fall at a place near the rims of rain areas: a mixture of the counts of the weather and
// of each area near (src/rain/local.rs).
//!include "rain/area.wgsl"

// Numbers for the weather and 16 areas, in fours.
const LOCAL_ROWS: u32 = 5u;
const LOCAL_COUNTS: u32 = 160u;

struct Local {
    // Of each class: drops of the weather, then of each column.
    counts: array<vec4f, LOCAL_COUNTS>,
    // How many fall for each that is drawn.
    weights: array<vec4f, LOCAL_ROWS>,
    // Share of the splashes' slots that are taken.
    splashes: array<vec4f, LOCAL_ROWS>,
    // Of the rain that the cones' block is made for, how much falls in each.
    cones: array<vec4f, LOCAL_ROWS>,
}

@group(0) @binding(8) var<uniform> local: Local;

// Drops of a class that a camera-relative place keeps, and how many each of them stands for.
fn local_drops(k: u32, p: vec3f) -> vec2f {
    var kept = local.counts[k * LOCAL_ROWS].x;
    var standing = kept * local.weights[0].x;
    for (var i = 0u; i < column_count(); i++) {
        let share = column_share(i, p);
        let state = i + 1u;
        let count = local.counts[k * LOCAL_ROWS + state / 4u][state % 4u];
        kept = mix(kept, count, share);
        standing = mix(standing, count * local.weights[state / 4u][state % 4u], share);
    }
    return vec2f(kept, standing / max(kept, 1e-6));
}

// Share of the splashes' slots that are taken at a place.
fn local_splashes(p: vec3f) -> f32 {
    var taken = local.splashes[0].x;
    for (var i = 0u; i < column_count(); i++) {
        let state = i + 1u;
        taken = mix(taken, local.splashes[state / 4u][state % 4u], column_share(i, p));
    }
    return taken;
}

// Drops at a place over those that the cones' block is made for.
fn local_cones(p: vec3f) -> f32 {
    var fall = local.cones[0].x;
    for (var i = 0u; i < column_count(); i++) {
        let state = i + 1u;
        fall = mix(fall, local.cones[state / 4u][state % 4u], column_share(i, p));
    }
    return fall;
}
