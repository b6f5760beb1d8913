// Finds and counts the flakes of the lattice that can be in the picture: only these are drawn. `mark` sets a bit for
// each such flake, and `order` sums the bits. The list keeps the order of the flakes' numbers, in which near shells
// come first.
//!include "snow/flakes.wgsl"
//!include "falling/order.wgsl"

@group(1) @binding(1) var<storage, read_write> spots: array<Spot>;

// Each thread writes one word: a bit for each of 32 flakes.
@compute @workgroup_size(64)
fn mark(@builtin(global_invocation_id) id: vec3u) {
    if id.x >= WORDS * blocks_of(flakes.count) {
        return;
    }
    let first = 32u * id.x;
    let last = min(first + 32u, flakes.count);
    var seen = 0u;
    // Flakes are numbered by shell, then by class. A run has the flakes of one class in one shell.
    for (var place = first; place < last;) {
        let s = shell_of(place);
        let begin = flakes.first[s];
        let run = run_of(s, place - begin);
        let end = clamp(begin + run.end, place + 1u, last);
        for (; place < end; place++) {
            let flake = flake_in(run, place - begin);
            seen |= select(0u, 1u << (place - first), may_show(flake, flake_part(flake).xyz));
        }
    }
    blocks[id.x / WORDS].seen[id.x % WORDS] = seen;
}

// Gives each block the index of its first flake in the list, and writes the arguments of the draw.
@compute @workgroup_size(SUMS)
fn order(@builtin(local_invocation_index) thread: u32) {
    order_blocks(thread, blocks_of(flakes.count), arrayLength(&spots));
}
