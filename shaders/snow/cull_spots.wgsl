// Computes the quads of the flakes that snow/cull.wgsl has found, the farthest first. The costly tests, for shelter and
// for light, run once a flake here.
//!include "snow/flakes.wgsl"
//!include "falling/list.wgsl"

@group(1) @binding(1) var<storage, read_write> spots: array<Spot>;

// Writes spot `id.x` of the list.
@compute @workgroup_size(64)
fn make_spots(@builtin(global_invocation_id) id: vec3u) {
    let all = blocks_of(flakes.count);
    let count = listed(all, arrayLength(&spots));
    if id.x >= count {
        return;
    }
    let flake = flake_of(thing_at(id.x, all));
    spots[count - 1u - id.x] = spot_of(flake, flake_part(flake), true);
}
