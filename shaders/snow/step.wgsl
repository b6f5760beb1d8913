// One frame of the flakes that are stepped. Their helix is none of it: it is drawn about the place where a flake is.
//!include "snow/flakes.wgsl"
//!include "falling/step.wgsl"

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
