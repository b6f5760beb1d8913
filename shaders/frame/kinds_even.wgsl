// Version of kinds.wgsl in which the pixels interpolated from the coarse grid are kinds of their own.
//!include "frame/even.wgsl"
//!include "frame/kinds.wgsl"

@group(3) @binding(2) var even_cells: texture_2d<f32>;

// Whether interpolated pixels on which the host drew have a draw of their own.
override APART: bool = false;

// Whether the other pixels have a draw for each kind, or one draw for all.
override SPLITS: bool = true;

// Depths of the kinds: pixels that are not interpolated, interpolated pixels, and interpolated pixels on which the host
// drew if APART is true.
const KIND_UNEVEN: f32 = 1.0;
const KIND_EVEN: f32 = 0.25;
const KIND_EVEN_DRAWN: f32 = 0.75;
// Tolerance for a pixel's range beyond those of its cell's texels, octaves: half floats are no more precise.
const REACH_SLACK: f32 = 0.02;

@fragment
fn kinds_even(in: FullscreenVarying) -> @builtin(frag_depth) f32 {
    let seen = kind_of(in);
    let reach = textureLoad(even_cells, even_texel(vec2i(in.position.xy)), 0).rg;
    let range = log2(max(seen.range, 1e-3));
    if range < reach.x - REACH_SLACK || range > reach.y + REACH_SLACK {
        return select(KIND_UNEVEN, seen.kind, SPLITS);
    }
    return select(KIND_EVEN, KIND_EVEN_DRAWN, APART && seen.kind == KIND_DRAWN);
}
