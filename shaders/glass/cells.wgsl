// Beads on glass, at most one for each cell, in integers: the same bits on every driver. The twin is
// src/glass/reference.rs; the uniforms of a step come from src/glass/step.rs.
//!include "common/fullscreen.wgsl"

// Block of a step.
struct Step {
    // Hash of (seed, step), hash of the seed, columns, rows.
    key: vec4u,
    // Limits of 32 random bits below which a cell gets at least 1, 2 or 3 drops; probability per step, in 1/65536, that
    // a fine bead dries.
    arrive: vec4u,
    // Declared state: water per cell and step, in 1/256 unit; drops per cell and step, in 1/65536; index of the step;
    // volume of the largest bead that rests, units.
    declared: vec4u,
    // Largest volume of a cell, units; 1 if some cells get less than all of the rain.
    limits: vec4u,
    // For each arm, three rows: (pivot x, y, inner radius, outer radius), in 1/16 cell; (direction of the blade at its
    // lower angle in the step x, y, direction half way x, y), in 1/4096; (direction at its higher angle x, y, in
    // 1/4096, half width, in 1/16 cell, 1 if there is an arm).
    arms: array<vec4i, 6>,
    // Volumes of drops, units, from common to rare.
    drops: array<vec4u, 64>,
    // Beads by class of volume: radius, in 1/256 cell, + 1024 x evaporation, in 1/4096 unit per step; motion x, y, in
    // 1/65536 cell per step; 256 x driving force / retention.
    beads: array<vec4i, 96>,
    // Snow: limit of 32 random bits below which a flake lands on a cell; then, in units of water, a flake, the melt per
    // step (in 1/4096), and the largest amount in a cell.
    snow: vec4u,
    // Shares of the rain that reach the nodes over the pane, in 1/128, four in a word, in rows from the lower edge up.
    reach: array<vec4u, 8>,
}

// Whether the host's maps keep rain off the pane.
override MAPPED: bool = false;

@group(0) @binding(0) var<uniform> step: Step;
// State of each cell: (volume, units; place of the bead in the cell, x + 65536 y, in 1/65536 of the edge; speed, 0 at
// rest, + 65536 x shape; hits since the last clearing + 4096 x clearings + 65536 x film).
@group(0) @binding(1) var cells: texture_2d<u32>;
// Move of each cell's bead: (volume that moves, units; its new place; speed + 65536 x shape; 256 x volume left behind +
// RAN + WIPED + target cell). Target cells are numbered 0 to 8 by rows from the lower left of the nine around the bead;
// 4 is the bead's own cell.
@group(0) @binding(2) var moves: texture_2d<u32>;
// Share of the rain that occluder maps let through to each node, in 1/128.
@group(0) @binding(3) var mapped: texture_2d<u32>;

// Snow on the cells, units of water.
@group(0) @binding(4) var snow: texture_2d<u32>;

// Largest number of counted hits of a cell.
const MOST_HITS: u32 = 4095u;
// Value of the film where a bead has run or a blade has wiped.
const FULL_FILM: u32 = 65535u;
// Film above which a bead glides as if it ran.
const WET_FILM: u32 = 2048u;
// Flag of a move: a blade has wiped the bead.
const WIPED: u32 = 16u;
// Flag of a move: the bead has run.
const RAN: u32 = 32u;
// Number of steps in which a cell collects the water of its declared state.
const LIFE_STEPS: u32 = 2048u;

// 32-bit PCG hash (Jarzynski & Olano 2020).
fn pcg(v: u32) -> u32 {
    let state = v * 747796405u + 2891336453u;
    let word = ((state >> ((state >> 28u) + 4u)) ^ state) * 277803737u;
    return (word >> 22u) ^ word;
}

// Returns a random word for a cell and a key.
fn cell_hash(cell: vec2i, key: u32) -> u32 {
    return pcg(u32(cell.x) + pcg(u32(cell.y) + key));
}

// Returns the position of the highest set bit; 0 for 0 and 1.
fn octave(v: u32) -> u32 {
    var x = v;
    var n = 0u;
    if x >= 65536u { x >>= 16u; n += 16u; }
    if x >= 256u { x >>= 8u; n += 8u; }
    if x >= 16u { x >>= 4u; n += 4u; }
    if x >= 4u { x >>= 2u; n += 2u; }
    if x >= 2u { n += 1u; }
    return n;
}

// Returns the row of `beads` for a volume.
fn bead(volume: u32) -> vec4i {
    let k = octave(volume);
    return step.beads[min(4u * k + (((volume << 2u) >> k) & 3u), 95u)];
}

// Returns the volume of a random drop, units.
fn drop_volume(random: u32) -> u32 {
    let k = 31u - octave(random | 1u);
    let part = 15u - ((random >> (27u - min(k, 27u))) & 15u);
    let i = select(16u * k + part, 255u, k > 15u);
    return step.drops[i / 4u][i % 4u];
}

// Returns whether a cell is on the lattice.
fn inside(cell: vec2i) -> bool {
    return cell.x >= 0 && cell.y >= 0 && cell.x < i32(step.key.z) && cell.y < i32(step.key.w);
}

// Unpacks x + 65536 y.
fn place(packed: u32) -> vec2i {
    return vec2i(i32(packed & 0xffffu), i32(packed >> 16u));
}

// Packs x + 65536 y.
fn packed(at: vec2i) -> u32 {
    return u32(at.x) | (u32(at.y) << 16u);
}

// Returns the cross product a.x b.y - a.y b.x.
fn perp_dot(a: vec2i, b: vec2i) -> i32 {
    return a.x * b.y - a.y * b.x;
}

// Returns whether a blade passes over a point during the step, or lies on the point at the beginning or the end.
// `point` is in 1/16 cell.
fn swept(point: vec2i) -> bool {
    for (var i = 0u; i < 6u; i += 3u) {
        let reach = step.arms[i];
        let before = step.arms[i + 1u];
        let now = step.arms[i + 2u];
        let d = point - reach.xy;
        if now.w == 0 || abs(d.x) > reach.w || abs(d.y) > reach.w {
            continue;
        }
        let far = d.x * d.x + d.y * d.y;
        if far < reach.z * reach.z || far > reach.w * reach.w {
            continue;
        }
        let ahead = d.x * before.z + d.y * before.w > 0;
        let between = perp_dot(before.xy, d) >= 0 && perp_dot(d, now.xy) >= 0;
        let beside = min(abs(perp_dot(now.xy, d)), abs(perp_dot(before.xy, d))) <= now.z * 4096;
        if ahead && (between || beside) {
            return true;
        }
    }
    return false;
}

// Number of nodes along the pane's lower edge, and up the glass.
const NODES: vec2u = vec2u(16u, 8u);

// Returns the share of the rain that reaches a node, in 1/128.
fn node(index: vec2u) -> u32 {
    let i = index.y * NODES.x + index.x;
    let share = (step.reach[i / 16u][(i / 4u) % 4u] >> (8u * (i % 4u))) & 255u;
    if MAPPED {
        return (share * textureLoad(mapped, vec2i(index), 0).x) >> 7u;
    }
    return share;
}

// Returns the share of the rain that reaches a cell, in 1/65536, interpolated between the nodes around it. Where all
// rain reaches all cells the loop has no iterations, and a software driver skips its body.
fn reached(cell: vec2i) -> u32 {
    var share = 65536u;
    for (var i = select(0u, 1u, step.limits.y == 0u && !MAPPED); i < 1u; i++) {
        let at = ((vec2u(cell) * 2u + 1u) * (NODES - 1u) * 128u) / step.key.zw;
        let low = at >> vec2u(8u);
        let part = at & vec2u(255u);
        let below = node(low) * (256u - part.x) + node(low + vec2u(1u, 0u)) * part.x;
        let above = node(low + vec2u(0u, 1u)) * (256u - part.x) + node(low + vec2u(1u, 1u)) * part.x;
        share = (below * (256u - part.y) + above * part.y) >> 7u;
    }
    return share;
}

// Returns number x share / 65536.
fn part_of(number: u32, share: u32) -> u32 {
    return select((number >> 16u) * share + (((number & 0xffffu) * share) >> 16u), number, share > 65535u);
}

// Returns the amount of a cell's snow `there` that melts in a step, units. The fraction of a unit is rounded at random.
fn melted(cell: vec2i, there: u32) -> u32 {
    let random = cell_hash(cell, step.key.x + 4u) & 4095u;
    return min(there, (step.snow.z >> 12u) + select(0u, 1u, random < (step.snow.z & 4095u)));
}
