// Finds and counts the drops of the lattice that can be in the picture. Only a few in a hundred are, but each must be
// tested.
//!include "rain/cull_list.wgsl"
//!include "falling/order.wgsl"

// Each thread writes one word: a bit for each of 32 drops.
@compute @workgroup_size(64)
fn mark(@builtin(global_invocation_id) id: vec3u) {
    let s = id.y;
    if id.x >= WORDS * shell_blocks() {
        return;
    }
    let first = 32u * id.x;
    let last = min(first + 32u, shell_drops());
    var seen = 0u;
    // Drops are numbered by class.
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

// Gives each block the index of its first streak in the list, and writes the arguments of the draw.
@compute @workgroup_size(SUMS)
fn order(@builtin(local_invocation_index) thread: u32) {
    order_blocks(thread, rain.shells * shell_blocks(), arrayLength(&streaks));
}
