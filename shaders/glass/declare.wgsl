// Declared state of a step: a pure function of (seed, step, rain). Each cell collects water for about half a minute,
// starting at a random time, and never enough to run.
//!include "glass/cells.wgsl"

// Returns the declared state of a cell.
@fragment
fn declare(in: FullscreenVarying) -> @location(0) vec4u {
    let cell = vec2i(in.position.xy);
    let random = cell_hash(cell, step.key.y + 7u);
    let now = step.declared.z + (random & (LIFE_STEPS - 1u));
    let age = now % LIFE_STEPS;
    let life = pcg(random + now / LIFE_STEPS);
    // Few cells get much water and many get little, as few drops are large.
    let chance = life & 255u;
    let share = (chance * chance) >> 6u;
    let gets = reached(cell);
    let water = min((part_of(step.declared.x, gets) * age) >> 8u, 1048576u);
    let rests = (step.declared.w * (64u + ((life >> 8u) & 127u))) >> 8u;
    let volume = min((water * share) >> 8u, rests);
    let hits = min((part_of(step.declared.y, gets) * age) >> 16u, MOST_HITS);
    return vec4u(volume, pcg(life + 1u), (life << 16u), hits | (((now / LIFE_STEPS) & 15u) << 12u));
}
