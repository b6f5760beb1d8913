// Computes the range (least, largest) of the distances in a cell of an occluder map, m, from the ranges of the 8 x 8
// texels or finer cells that it covers.
//!include "common/fullscreen.wgsl"

// Ranges of the texels or of the finer cells: the bits of two floats each.
@group(0) @binding(0) var finer: texture_2d<u32>;

// Returns the range of 8 x 8 texels or finer cells.
@fragment
fn occluder_cells(in: FullscreenVarying) -> @location(0) vec2u {
    let first = vec2i(in.position.xy) * 8;
    var range = vec2f(1e12, -1e12);
    for (var y = 0; y < 8; y++) {
        for (var x = 0; x < 8; x++) {
            let one = bitcast<vec2f>(textureLoad(finer, first + vec2i(x, y), 0).xy);
            range = vec2f(min(range.x, one.x), max(range.y, one.y));
        }
    }
    return bitcast<vec2u>(range);
}
