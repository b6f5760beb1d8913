// Advances the drops by one frame.
//!include "rain/drops.wgsl"
//!include "falling/step.wgsl"

// Steps drop `id.x` of shell `id.y`.
@compute @workgroup_size(64)
fn step_drops(@builtin(global_invocation_id) id: vec3u) {
    let index = id.x;
    let s = id.y;
    if index >= stepping.counts[s] {
        return;
    }
    let slot = stepping.begins[s] + index;
    let k = class_of(index);
    let terminal = rain.classes[k].y * SPEED_UNIT;
    if index < stepping.known[s] {
        states[slot] = stepped(states[slot], s, index, terminal);
        return;
    }
    // Starts new drops at their places in the lattice.
    let first = select(0u, u32(rain.classes[max(k, 1u) - 1u].z), k > 0u);
    let start = random3(vec3u(rain.seed, (s << 8u) | k, index - first));
    let away = start - vec3u(0u, 0u, u32(rain.classes[k].y) * rain.cell[s].w) - rain.cell[s].xyz;
    states[slot] = begun(s, away, terminal);
}
