// Shape of a flake: a clump of crystals, each different. The clump is a disc whose edge and inside are eroded by noise.
// Its opacity at the distance r from the middle, in radii, is max(1 - exp(-5 W), 0) with W = offset + weight * noise -
// r^2. The f64 reference is src/snow/shape.rs, which has the source of the formula; a test there checks that the mean
// opacity, over the disc and over many flakes, is the share of a disc that ice covers.
//!include "common/hash.wgsl"

// Number of octaves of the noise; each is twice as fine and half as strong as the one before.
const SHAPE_OCTAVES: u32 = 4u;
// Cells of the coarsest octave of the noise in a flake's radius.
const SHAPE_CELLS: f32 = 2.2;
// Constant added to the noise. This constant and SHAPE_NOISE set the mean opacity of a flake.
const SHAPE_OFFSET: f32 = 0.8563;
// Weight of the noise.
const SHAPE_NOISE: f32 = 2.0;

// Returns a random number from -1 to 1 at a corner of the noise's cells.
fn shape_corner(cell: vec2i, seed: u32) -> f32 {
    let key = bitcast<vec2u>(cell);
    return f32(random3(vec3u(key.x, key.y, seed)).x >> 8u) * (2.0 / 16777215.0) - 1.0;
}

// Returns value noise: random numbers on a grid, with cubic interpolation between them.
fn shape_noise(p: vec2f, seed: u32) -> f32 {
    let cell = vec2i(floor(p));
    let t = fract(p);
    let w = t * t * (3.0 - 2.0 * t);
    let low = mix(shape_corner(cell, seed), shape_corner(cell + vec2i(1, 0), seed), w.x);
    let high = mix(shape_corner(cell + vec2i(0, 1), seed), shape_corner(cell + vec2i(1, 1), seed), w.x);
    return mix(low, high, w.y);
}

// Returns the opacity of a flake at the place `at`, in radii from its middle. Returns 0 if it is not `wanted`; the loop
// then has no iterations.
fn flake_shape(at: vec2f, seed: u32, wanted: bool) -> f32 {
    var noise = 0.0;
    var strength = 0.5;
    var scale = SHAPE_CELLS;
    for (var i = select(SHAPE_OCTAVES, 0u, wanted); i < SHAPE_OCTAVES; i++) {
        noise += strength * shape_noise(at * scale, seed + i);
        strength *= 0.5;
        scale *= 2.0;
    }
    let square = dot(at, at);
    let within = SHAPE_OFFSET + SHAPE_NOISE * noise - square;
    return select(0.0, max(1.0 - exp(-5.0 * within), 0.0), wanted && square < 1.0);
}
