// Computes the crown of each slot that rain/crowns.wgsl has found, once, in front of a host's picture.
//!include "rain/drops_view.wgsl"
//!include "falling/list.wgsl"

@group(1) @binding(1) var<storage, read_write> crowns: array<Crown>;

// Writes crown `id.x` of the list.
@compute @workgroup_size(64)
fn make_crowns(@builtin(global_invocation_id) id: vec3u) {
    let all = blocks_of(splash.slots * splash.cells * splash.cells);
    if id.x < listed(all, arrayLength(&crowns)) {
        crowns[id.x] = splashed(thing_at(id.x, all));
    }
}
