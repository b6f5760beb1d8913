//!include "common/fullscreen.wgsl"
// Known answers: the test that an OpenGL driver must pass before any other work. CPU side: src/gpu/known.rs.
//
// The blocks have the sizes and kinds of those that the shaders of the sky's first tables read. If a driver delivered
// wrong bytes to those shaders, their loops, whose bounds come from the blocks, might never end.

// 144 bytes, like `SkyAir`.
struct KnownRow {
    vector: vec3f,
    number: f32,
}
struct KnownRows {
    rows: array<KnownRow, 9>,
}

// 80 bytes, like `SkyDims`.
struct KnownCounts {
    a: u32, b: u32, c: u32, d: u32,
    e: u32, f: u32, g: u32, h: u32,
    i: u32, j: u32, k: u32, l: u32,
    m: u32, n: u32, o: u32, p: u32,
    q: u32, r: u32, s: u32, t: u32,
}

// 16 bytes, like `SkyJob`.
struct KnownJob {
    order: u32,
    last: u32,
    unused_a: u32,
    unused_b: u32,
}

@group(0) @binding(0) var<uniform> rows: KnownRows;
@group(0) @binding(1) var<uniform> counts: KnownCounts;
// 384 bytes, like the quadrature.
@group(0) @binding(2) var<uniform> rule: array<vec4f, 24>;
@group(0) @binding(3) var<uniform> job: KnownJob;
// Block that the queue writes into a part of a buffer, like the blocks of a view.
@group(0) @binding(4) var<uniform> written: array<vec4u, 5>;

// Index of the first texel for each block.
const COUNTS_FROM: u32 = 9u;
const RULE_FROM: u32 = 14u;
const JOB_FROM: u32 = 38u;
const WRITTEN_FROM: u32 = 39u;

// Returns vector `i` of the counts.
fn known_counts(i: u32) -> vec4u {
    switch i {
        case 0u: { return vec4u(counts.a, counts.b, counts.c, counts.d); }
        case 1u: { return vec4u(counts.e, counts.f, counts.g, counts.h); }
        case 2u: { return vec4u(counts.i, counts.j, counts.k, counts.l); }
        case 3u: { return vec4u(counts.m, counts.n, counts.o, counts.p); }
        default: { return vec4u(counts.q, counts.r, counts.s, counts.t); }
    }
}

// Draws all blocks one after the other, 16 bytes per texel, without a loop.
@fragment
fn blocks(in: FullscreenVarying) -> @location(0) vec4u {
    let x = u32(in.position.x);
    if (x < COUNTS_FROM) {
        return vec4u(bitcast<vec3u>(rows.rows[x].vector), bitcast<u32>(rows.rows[x].number));
    }
    if (x < RULE_FROM) {
        return known_counts(x - COUNTS_FROM);
    }
    if (x < JOB_FROM) {
        return bitcast<vec4u>(rule[x - RULE_FROM]);
    }
    if (x < WRITTEN_FROM) {
        return vec4u(job.order, job.last, job.unused_a, job.unused_b);
    }
    return written[min(x - WRITTEN_FROM, 4u)];
}

// Limit for the loops here, whatever a block contains.
const MOST_TURNS: u32 = 24u;

// Draws one texel by two loops like those in `norm` of sky/build.wgsl, whose bounds come from a block. All numbers are
// whole, so the sum is exact.
@fragment
fn turns(in: FullscreenVarying) -> @location(0) vec4u {
    var sum = 0.0;
    for (var m = 0u; m < min(2u * counts.e, MOST_TURNS); m++) {
        let d = rule[select(m - counts.e, m, m < counts.e)].xy;
        for (var p = 0u; p < min(counts.f, MOST_TURNS); p++) {
            sum += d.y * max(rule[p].z, d.x);
        }
    }
    return vec4u(u32(sum), job.order, 0u, 0u);
}
