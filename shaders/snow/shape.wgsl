// The shape of a flake: a clump of crystals, of which no two are alike. A disc whose edge and inside are eaten by
// noise, as older systems draw it (1 - exp(-5 W), W = noise - radius^2); src/snow/shape.rs has the same in f64, and
// holds its mean over the disc to the share of it that is ice.
//!include "common/hash.wgsl"

// Octaves of the noise; each is twice as fine and half as strong as the last.
const SHAPE_OCTAVES: u32 = 4u;
// Of the noise, in cells a radius; what is added to it and what it counts for, which make the mean.
const SHAPE_CELLS: f32 = 2.2;
const SHAPE_OFFSET: f32 = 0.8563;
const SHAPE_NOISE: f32 = 2.0;

// A number from -1 to 1 at a corner of the noise's cells.
fn shape_corner(cell: vec2i, seed: u32) -> f32 {
    let key = bitcast<vec2u>(cell);
    return f32(random3(vec3u(key.x, key.y, seed)).x >> 8u) * (2.0 / 16777215.0) - 1.0;
}

// Value noise (Lattice of numbers, between them cubics).
fn shape_noise(p: vec2f, seed: u32) -> f32 {
    let cell = vec2i(floor(p));
    let t = fract(p);
    let w = t * t * (3.0 - 2.0 * t);
    let low = mix(shape_corner(cell, seed), shape_corner(cell + vec2i(1, 0), seed), w.x);
    let high = mix(shape_corner(cell + vec2i(0, 1), seed), shape_corner(cell + vec2i(1, 1), seed), w.x);
    return mix(low, high, w.y);
}

// How much a flake hides at a place in radii; not looked for where it is not `wanted`, by a loop that is not begun.
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
