// The crowns of all slots, once each, before a host's picture.
//!include "rain/drops_view.wgsl"

@group(1) @binding(0) var<storage, read_write> crowns: array<Crown>;

@compute @workgroup_size(64)
fn make_crowns(@builtin(global_invocation_id) id: vec3u) {
    if id.x < splash.slots * splash.cells * splash.cells {
        crowns[id.x] = splashed(id.x);
    }
}
