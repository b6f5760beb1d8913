// State of a drop or flake that is integrated step by step (falling/step.wgsl).

// State of one particle.
struct State {
    // Position in the cell, in units of 2^-32 of the cell's side.
    place: vec3u,
    // Upper 16 bits: number of times that the particle has re-entered the cell; lower 16 bits: shell.
    word: u32,
    // Velocity, m/s.
    velocity: vec3f,
    pad: f32,
}
