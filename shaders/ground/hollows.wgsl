// Hollows of a ground whose heights are unknown, and rings of drops on the water in them. Both are functions of the
// place in the host's world that repeat every 10 km. The f64 reference of the hollows is src/ground/hollows.rs.
//!include "ground/binding.wgsl"

// Side of a cell of the rings' grid, m.
const RING_CELL: f32 = 0.2;
// Number of cells along an axis in a period of the pattern, 10 km.
const RING_CELLS: u32 = 50000u;
// Length of a time slot, s.
const RING_SLOT: f32 = 0.6;
// Number of layers of rings.
const RING_LAYERS: u32 = 4u;
// Lifetime of a ring, as a share of a slot.
const RING_LIFE: f32 = 0.6;
// Speed of a ring, m/s.
const RING_SPEED: f32 = 0.22;
// Wavelength of a ring, m.
const RING_WAVE: f32 = 0.02;
// Slope of a ring's steepest wave at its start, for the largest drop.
const RING_SLOPE: f32 = 0.35;

// Returns the sines of angles in turns, within 2e-4, by an odd polynomial over a quarter turn.
fn sines(turns: vec4f) -> vec4f {
    let quarter = 2.0 * abs(2.0 * fract(turns + 0.75) - 1.0) - 1.0;
    let square = quarter * quarter;
    return quarter * (1.5706268 + square * (0.0727102 * square - 0.6432292));
}

// East parts of the wave vectors of the hollows, turns per metre.
const WAVES_EAST: array<vec4f, 4> = array<vec4f, 4>(
    vec4f(0.0513, -0.0684, 0.0569, -0.0043),
    vec4f(-0.0706, 0.1295, -0.1672, 0.0531),
    vec4f(0.1352, -0.2875, 0.3489, -0.1736),
    vec4f(-0.2345, 0.6797, -0.9348, 0.6685),
);
// North parts of the wave vectors, turns per metre.
const WAVES_NORTH: array<vec4f, 4> = array<vec4f, 4>(
    vec4f(0.0432, 0.0028, -0.0567, 0.0940),
    vec4f(-0.0846, 0.0174, 0.1164, -0.2365),
    vec4f(0.2357, -0.0916, -0.1613, 0.4151),
    vec4f(-0.6515, 0.3570, 0.2467, -1.0404),
);
// Amplitudes of the waves.
const WAVES_AMPLITUDE: array<vec4f, 4> = array<vec4f, 4>(
    vec4f(0.3872983, 0.3872983, 0.3872983, 0.3872983),
    vec4f(0.3872983, 0.3872983, 0.3415650, 0.3415650),
    vec4f(0.3415650, 0.3415650, 0.3415650, 0.3415650),
    vec4f(0.3162278, 0.3162278, 0.3162278, 0.3162278),
);

// Returns the depth of four waves at the place `at`, averaged over a pixel whose sides on the ground are the vectors
// `across` and `along`, m, and the variance that this averaging leaves.
fn four_waves(east: vec4f, north: vec4f, amplitude: vec4f, phases: vec4f, at: vec2f, across: vec2f, along: vec2f) -> vec2f {
    let x = east * across.x + north * across.y;
    let y = east * along.x + north * along.y;
    // Averages as a Gaussian with the variance of a box, 1/12: the factor exp(-q) for q = (2 pi)^2 (x^2 + y^2) / 24,
    // approximated by 1 / (1 + q + q^2 / 2).
    let q = (x * x + y * y) * 1.6449341;
    let keep = amplitude / (1.0 + q * (1.0 + 0.5 * q));
    return vec2f(dot(keep, sines(phases + east * at.x + north * at.y)), 0.5 * dot(keep, keep));
}

// Returns the depth of the hollows below the mean ground, in units of its root mean square, and the share of its
// variance that is too small for the pixel; (0, 1) if not `wanted`. There is no loop: on a software driver its masks
// cost more than some of the waves.
fn hollow_depth(at: vec2f, across: vec2f, along: vec2f, wanted: bool) -> vec2f {
    if !wanted {
        return vec2f(0.0, 1.0);
    }
    // Uses constant indices: a variable index would copy the tables.
    let sum = four_waves(WAVES_EAST[0], WAVES_NORTH[0], WAVES_AMPLITUDE[0], ground.phases[0], at, across, along)
        + four_waves(WAVES_EAST[1], WAVES_NORTH[1], WAVES_AMPLITUDE[1], ground.phases[1], at, across, along)
        + four_waves(WAVES_EAST[2], WAVES_NORTH[2], WAVES_AMPLITUDE[2], ground.phases[2], at, across, along)
        + four_waves(WAVES_EAST[3], WAVES_NORTH[3], WAVES_AMPLITUDE[3], ground.phases[3], at, across, along);
    return vec2f(sum.x, max(1.0 - sum.y, 0.0));
}

// Returns the cumulative normal distribution within 3e-4 (Page 1977).
fn normal_share(x: f32) -> f32 {
    let y = clamp(x, -6.0, 6.0);
    return 1.0 / (1.0 + exp(-1.5957691 * y * (1.0 + 0.044715 * y * y)));
}

// Largest depth of the hollows, in units of their root mean square.
const FARTHEST_LEVEL: f32 = 6.0;
// Level that is deeper than any hollow: no water or snow lies there.
const NO_LEVEL: f32 = 1000.0;

// Returns the level of water that covers the share `covered` of the ground: the depth that the hollows exceed on this
// share, in units of their root mean square depth. This is the inverse of `normal_share` with the opposite sign. The
// function solves the cubic y + 0.044715 y^3 = log(odds) / 1.5957691, which has one real root, by the hyperbolic sine
// of a third of an angle.
fn level_of(covered: f32) -> f32 {
    let share = clamp(covered, 1e-6, 1.0 - 1e-6);
    let odds = log(share / (1.0 - share)) / 1.5957691;
    let y = 5.46063 * sinh(asinh(0.54938716 * odds) / 3.0);
    return select(-y, -sign(covered - 0.5) * FARTHEST_LEVEL, share != covered);
}

// Width of the edge of a puddle, in units of the hollows' depth.
const PUDDLE_EDGE: f32 = 0.06;
// Width of the edge of a film, in units of the hollows' depth.
const FILM_EDGE: f32 = 0.5;

// Returns the share of a pixel in which the hollows are deeper than `level` and thus filled. `hollow` is a result of
// `hollow_depth`, `edge` the width of the edge.
fn covered_share(hollow: vec2f, level: f32, edge: f32) -> f32 {
    return normal_share((hollow.x - level) * inverseSqrt(edge * edge + hollow.y));
}

// Returns three uniform random numbers, 0 to 1, for a cell and a slot (PCG, Jarzynski & Olano 2020).
fn ring_chances(cell: vec2u, slot: u32) -> vec3f {
    var v = vec3u(cell, slot) * 1664525u + 1013904223u;
    v.x += v.y * v.z;
    v.y += v.z * v.x;
    v.z += v.x * v.y;
    v = v ^ (v >> vec3u(16u));
    v.x += v.y * v.z;
    v.y += v.z * v.x;
    v.z += v.x * v.y;
    return vec3f(v >> vec3u(8u)) / 16777216.0;
}

// Returns the slope of the water by one layer of rings, along the two axes of the pattern. In each time slot at most
// one drop falls in a cell.
fn ring_slope(at: vec2f, layer: u32) -> vec2f {
    let t = ground.slot_share + f32(layer) / f32(RING_LAYERS);
    let slot = (ground.slot + u32(t)) * RING_LAYERS + layer;
    // The grid is shifted in each slot, so drops fall everywhere.
    let shift = ring_chances(vec2u(0x9e37u, 0x79b9u), slot).xy;
    let place = (at + vec2f(ground.place_u, ground.place_v)) / RING_CELL + shift;
    let low = floor(place);
    let cell = (ground.cell + vec2u(vec2i(low) + i32(RING_CELLS))) % RING_CELLS;
    let chance = ring_chances(cell, slot);
    let other = ring_chances(cell.yx, slot + 0x85ebu);
    let life = RING_LIFE * RING_SLOT;
    let age = (fract(t) - (1.0 - RING_LIFE) * other.y) * RING_SLOT;
    if other.x >= ground.ring_chance || age <= 0.0 || age >= life {
        return vec2f(0.0);
    }
    // Rings stay within their cell.
    let room = 0.5 * RING_CELL - RING_SPEED * life;
    let from_middle = (place - low - 0.5) * RING_CELL - (chance.xy * 2.0 - 1.0) * room;
    let r = length(from_middle);
    let x = (r - RING_SPEED * age) / RING_WAVE;
    let fade = 1.0 - age / life;
    let height = (0.4 + 0.6 * chance.z) * RING_SLOPE * fade * fade * exp(-x * x) * min(r / (0.5 * RING_WAVE), 1.0);
    return from_middle / max(r, 1e-4) * (height * sin(x * 6.28318531));
}

// Returns the slope of standing water by rings, along the two axes of the pattern. `layers` is RING_LAYERS, or 0 for no
// rings.
fn ring_slopes(at: vec2f, layers: u32) -> vec2f {
    var slope = vec2f(0.0);
    for (var layer = 0u; layer < layers; layer++) {
        slope += ring_slope(at, layer);
    }
    return slope;
}
