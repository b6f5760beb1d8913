// Computes the position in the list at which each block's things begin, and the total number of things. Runs in one
// workgroup.
//!include "falling/list.wgsl"

// Arguments of the draw and of the pass that prepares it.
struct Found {
    // Arguments of the draw: vertices, instances, first vertex, first instance.
    draw: vec4u,
    // Number of workgroups of the pass that prepares the things to be drawn.
    groups: vec3u,
}

@group(1) @binding(2) var<storage, read_write> found: Found;

// Number of threads of the workgroup.
const SUMS: u32 = 128u;
var<workgroup> sums: array<u32, SUMS>;

// Orders `blocks_seen` blocks into a list with room for `room` things. A full list leaves out the last things.
fn order_blocks(thread: u32, blocks_seen: u32, room: u32) {
    let all = min(blocks_seen, arrayLength(&blocks));
    let part = (all + SUMS - 1u) / SUMS;
    let first = min(thread * part, all);
    let end = min(first + part, all);
    var sum = 0u;
    for (var i = first; i < end; i++) {
        sum += seen_in(i);
    }
    sums[thread] = sum;
    workgroupBarrier();
    var before = 0u;
    for (var i = 0u; i < thread; i++) {
        before += sums[i];
    }
    for (var i = first; i < end; i++) {
        blocks[i].before = before;
        before += seen_in(i);
    }
    if thread == SUMS - 1u {
        let count = min(before, room);
        found = Found(vec4u(4u, count, 0u, 0u), vec3u((count + 63u) / 64u, 1u, 1u));
    }
}
