// Advances the flakes by one frame. Their helix is left out; it is added around the stepped place when they are drawn.
//!include "snow/flakes.wgsl"
//!include "falling/step.wgsl"

// Steps flake `id.x` of shell `id.y`.
@compute @workgroup_size(128)
fn step_flakes(@builtin(global_invocation_id) id: vec3u) {
    let index = id.x;
    let s = id.y;
    if index >= stepping.counts[s] {
        return;
    }
    let slot = stepping.begins[s] + index;
    let own = own_of(run_of(s, index), index);
    let terminal = f32(own.speed) * SPEED_UNIT;
    if index < stepping.known[s] {
        states[slot] = stepped(states[slot], s, index, terminal);
    } else {
        states[slot] = begun(s, lattice_place(own), terminal);
    }
}
