// A drop or flake that is stepped (falling/step.wgsl).

struct State {
    // Place in the cell, in 2^-32 of its side.
    place: vec3u,
    // How often it came in, times 2^16; shell.
    word: u32,
    // m/s.
    velocity: vec3f,
    pad: f32,
}
