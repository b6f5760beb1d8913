// Which drops of the lattice can be in the picture: a few in a hundred, but each must be asked. Then their number, for the draw.
//!include "rain/cull_list.wgsl"

struct Found {
    // Vertices, instances, first of either: of the draw.
    draw: vec4u,
    // Workgroups of rain/cull_streaks.wgsl.
    groups: vec3u,
}

@group(1) @binding(2) var<storage, read_write> found: Found;

// A word of bits a thread.
@compute @workgroup_size(64)
fn mark(@builtin(global_invocation_id) id: vec3u) {
    let s = id.y;
    if id.x >= WORDS * shell_blocks() {
        return;
    }
    let first = 32u * id.x;
    let last = min(first + 32u, shell_drops());
    var seen = 0u;
    // Drops lie in the order of their classes.
    for (var index = first; index < last;) {
        let in_shell = class_in_shell(s, class_of(index));
        let end = clamp(in_shell.end, index + 1u, last);
        for (; index < end; index++) {
            let m = moving(in_shell, index);
            seen |= select(0u, 1u << (index - first), may_show(m.drop, m.velocity));
        }
    }
    blocks[s * shell_blocks() + id.x / WORDS].seen[id.x % WORDS] = seen;
}

const SUMS: u32 = 128u;
var<workgroup> sums: array<u32, SUMS>;

// Where each block's drops begin in the list, by one workgroup.
@compute @workgroup_size(SUMS)
fn order(@builtin(local_invocation_index) thread: u32) {
    let all = rain.shells * shell_blocks();
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
        // A full list has no room for what is last in it: the outermost shells.
        let count = min(before, arrayLength(&streaks));
        found = Found(vec4u(4u, count, 0u, 0u), vec3u((count + 63u) / 64u, 1u, 1u));
    }
}
