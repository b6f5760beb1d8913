// List of the drops in the picture, out of all in the shells around the camera, near shells first.
//!include "rain/drops.wgsl"
//!include "falling/state.wgsl"
//!include "falling/list.wgsl"

// Whether drops are stepped.
override STEPPED: bool = false;

@group(1) @binding(1) var<storage, read_write> streaks: array<Streak>;
// For stepped drops, per shell: place of the camera in its cell, in 2^-32 of the cell's side (x, y, z), and index of
// the shell's first drop in `states` (w).
@group(3) @binding(0) var<uniform> eyes: array<vec4u, SHELLS>;
@group(3) @binding(1) var<storage, read> states: array<State>;

// Drop and its velocity, m/s.
struct Moving {
    drop: Drop,
    velocity: vec3f,
}

// Returns the number of drops in each shell.
fn shell_drops() -> u32 {
    if STEPPED {
        return min(rain.per_shell, arrayLength(&states));
    }
    return rain.per_shell;
}

// Returns the number of blocks of the list in each shell.
fn shell_blocks() -> u32 {
    return blocks_of(rain.per_shell);
}

// Returns drop `index` of its shell, and its velocity.
fn moving(in_shell: ClassInShell, index: u32) -> Moving {
    if STEPPED {
        let state = states[min(eyes[in_shell.s].w + index, arrayLength(&states) - 1u)];
        return Moving(drop_at(in_shell, index, state.place - eyes[in_shell.s].xyz), state.velocity);
    }
    let drop = drop_of(in_shell, index);
    return Moving(drop, rain.wind - vec3f(0.0, 0.0, drop.speed));
}
