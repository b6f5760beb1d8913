// Number of drops of each class at a place near the rims of rain areas: a mixture of the numbers of the weather and of
// each nearby area (src/rain/local.rs).
//!include "rain/area.wgsl"

// Number of vectors of four for the weather and 16 areas.
const LOCAL_ROWS: u32 = 5u;
// Number of these vectors for all 32 classes.
const LOCAL_COUNTS: u32 = 160u;

// Block of the mixture.
struct Local {
    // Per class: number of drops in a shell of the weather, then of each column.
    counts: array<vec4f, LOCAL_COUNTS>,
    // Number of drops that each drawn drop of the innermost shell stands for: of the weather, then of each column.
    weights: array<vec4f, LOCAL_ROWS>,
    // Share of the splashes' slots that are taken: by the weather, then by each column.
    splashes: array<vec4f, LOCAL_ROWS>,
    // Extinction of the weather, then of each column, relative to that of the rain for which the cones' block is made.
    cones: array<vec4f, LOCAL_ROWS>,
}

@group(0) @binding(8) var<uniform> local: Local;

// Returns the number of drops of a class that are kept at a camera-relative place, and the number that each of them
// stands for.
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

// Returns the share of the splashes' slots that are taken at a place.
fn local_splashes(p: vec3f) -> f32 {
    var taken = local.splashes[0].x;
    for (var i = 0u; i < column_count(); i++) {
        let state = i + 1u;
        taken = mix(taken, local.splashes[state / 4u][state % 4u], column_share(i, p));
    }
    return taken;
}

// Returns the extinction of the rain at a place, relative to that of the rain for which the cones' block is made.
fn local_cones(p: vec3f) -> f32 {
    var fall = local.cones[0].x;
    for (var i = 0u; i < column_count(); i++) {
        let state = i + 1u;
        fall = mix(fall, local.cones[state / 4u][state % 4u], column_share(i, p));
    }
    return fall;
}
