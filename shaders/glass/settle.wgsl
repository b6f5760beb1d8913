// Snow on glass, in units of its water for each cell: flakes land, blades remove snow, and heat melts it. The twin is
// src/glass/reference.rs.
//!include "glass/cells.wgsl"

// Returns the snow of a cell after a step.
fn settled(cell: vec2i) -> u32 {
    if swept(cell * 16 + 8) {
        return 0u;
    }
    let before = textureLoad(snow, cell, 0).x;
    var there = before - melted(cell, before);
    if cell_hash(cell, step.key.x + 5u) < part_of(step.snow.x, reached(cell)) {
        there += step.snow.y;
    }
    return min(there, step.snow.w);
}

// Returns the snow on a cell after the step, units of water.
@fragment
fn settle(in: FullscreenVarying) -> @location(0) u32 {
    return settled(vec2i(in.position.xy));
}

// Returns the declared state of a cell: the snow that falls in about half a minute, less the snow that melts meanwhile.
@fragment
fn declare_snow(in: FullscreenVarying) -> @location(0) u32 {
    let cell = vec2i(in.position.xy);
    let random = cell_hash(cell, step.key.y + 11u);
    let age = (step.declared.z + (random & (LIFE_STEPS - 1u))) % LIFE_STEPS;
    let flakes = ((part_of(step.snow.x, reached(cell)) >> 12u) * age + (pcg(random) >> 12u)) >> 20u;
    let there = min(flakes * step.snow.y, step.snow.w);
    return there - min(there, (min(step.snow.z >> 4u, 1048575u) * age) >> 8u);
}
