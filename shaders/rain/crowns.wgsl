// Finds and counts the slots of splashes whose vertical line (through the landing's east and north) may be in the
// picture. Only these are drawn.
//!include "rain/splash.wgsl"
//!include "falling/order.wgsl"

@group(1) @binding(1) var<storage, read_write> crowns: array<Crown>;

// Returns the number of slots around the camera.
fn all_slots() -> u32 {
    return splash.slots * splash.cells * splash.cells;
}

// Each thread writes one word: a bit for each of 32 slots.
@compute @workgroup_size(64)
fn mark(@builtin(global_invocation_id) id: vec3u) {
    if id.x >= WORDS * blocks_of(all_slots()) {
        return;
    }
    let first = 32u * id.x;
    var seen = 0u;
    for (var slot = first; slot < min(first + 32u, all_slots()); slot++) {
        let landing = arrival_of(slot).landing;
        let search = search_from(landing, splash.ground);
        seen |= select(0u, 1u << (slot - first), landing.fade > 0.0 && search.low < search.high);
    }
    blocks[id.x / WORDS].seen[id.x % WORDS] = seen;
}

// Gives each block the index of its first crown in the list, and writes the arguments of the draw.
@compute @workgroup_size(SUMS)
fn order(@builtin(local_invocation_index) thread: u32) {
    order_blocks(thread, blocks_of(all_slots()), arrayLength(&crowns));
}
