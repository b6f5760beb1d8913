// Advances drops and flakes by one frame; src/particles/stepping.rs explains the model.
//!include "common/hash.wgsl"
//!include "falling/state.wgsl"
//!include "surroundings/wind.wgsl"

// Number of shells of the lattice.
const STEPPED_SHELLS: u32 = 4u;

// Block of a frame's steps.
struct StepUniform {
    // Velocity of the air by the weather's wind, (east, north, up), m/s.
    air: vec3f,
    // Length of a step, s.
    dt: f32,
    // Mapping to the texture of the wind that varies in space.
    wind: WindMap,
    // Displacement of the camera since the last frame, (east, north, up), m.
    moved: vec3f,
    // Number of steps in the frame.
    steps: u32,
    // For each shell: number of things that fall in it, number of those that have a state already, index of its first
    // state, and side of its cell, m.
    counts: vec4u,
    known: vec4u,
    begins: vec4u,
    sides: vec4f,
    // Position of the camera in each shell's cell, in units of 2^-32 of its side: now (w: index of the shell's first
    // state), and before the frame.
    eye: array<vec4u, STEPPED_SHELLS>,
    before: array<vec4u, STEPPED_SHELLS>,
    // Seed of the positions at which things re-enter.
    seed: u32,
}

@group(1) @binding(0) var<uniform> stepping: StepUniform;
@group(1) @binding(1) var<storage, read_write> states: array<State>;
@group(1) @binding(2) var wind_values: texture_3d<f32>;
@group(1) @binding(3) var wind_sampler: sampler;

// Whether the wind varies in space.
override WIND: bool = false;

// Standard gravity, m/s^2.
const GRAVITY: f32 = 9.80665;

// Returns the velocity of the air, m/s, at the position `p` relative to the camera.
fn air_at(p: vec3f) -> vec3f {
    if !WIND {
        return stepping.air;
    }
    let place = wind_place(stepping.wind, p);
    let found = textureSampleLevel(wind_values, wind_sampler, place, 0.0);
    return wind_at(stepping.wind, place, found, stepping.air);
}

// Returns an offset, given in sides of the cell, wrapped to at most half a side and converted to units of 2^-32 of the
// side.
fn wrapped(cells: vec3f) -> vec3u {
    let part = clamp(cells - floor(cells + 0.5), vec3f(-0.5), vec3f(0.4999999));
    return bitcast<vec3u>(vec3i(part * 4294967296.0));
}

// Returns the first state of a thing, at its place in the lattice: `away` from the camera, in units of 2^-32 of the
// side. The thing falls at `terminal` m/s in still air.
fn begun(s: u32, away: vec3u, terminal: f32) -> State {
    let p = vec3f(bitcast<vec3i>(away)) * (stepping.sides[s] / 4294967296.0);
    return State(away + stepping.eye[s].xyz, s, air_at(p) - vec3f(0.0, 0.0, terminal), 0.0);
}

// Returns the state of thing `index` of shell `s` after the frame's steps. The thing falls at `terminal` m/s in still
// air.
fn stepped(from_state: State, s: u32, index: u32, terminal: f32) -> State {
    var state = from_state;
    let side = stepping.sides[s];
    let eye = stepping.eye[s].xyz;
    let away = vec3f(bitcast<vec3i>(state.place - stepping.before[s].xyz)) * (side / 4294967296.0) - stepping.moved;
    var velocity = state.velocity;
    var way = vec3f(0.0);
    let at_rest = GRAVITY / terminal;
    for (var i = 0u; i < (stepping.steps & 63u); i++) {
        let air = air_at(away + way);
        let pull = clamp(length(velocity - air) / terminal, 0.25, 8.0);
        let rate = at_rest * select(pull, 1.0, stepping.dt * at_rest > 0.5);
        let settled = air - vec3f(0.0, 0.0, GRAVITY / rate);
        let gone = 1.0 - exp(-rate * stepping.dt);
        let difference = velocity - settled;
        way += settled * stepping.dt + difference * (gone / rate);
        velocity -= difference * gone;
    }
    state.place += wrapped(way / side);
    // A thing that leaves the cell through the sides of an axis re-enters through the opposite side, as far inside as
    // it had gone outside. Its coordinates on the later axes are random. Its coordinates on the earlier axes are random
    // too, but only among the positions from which a thing with this motion does not leave along those axes. An even
    // distribution thus stays even.
    let course = (way - stepping.moved) / side;
    let left = floor((away + way) / side + 0.5) != vec3f(0.0);
    if any(left) {
        let times = ((state.word >> 16u) + 1u) & 0xffffu;
        let chance = random3(vec3u(stepping.seed, (s << 16u) | times, index));
        let part = vec3f(chance >> vec3u(8u)) / 16777216.0;
        let inside = eye + wrapped(mix(max(course, vec3f(0.0)) - 0.5, min(course, vec3f(0.0)) + 0.5, part));
        if left.x {
            state.place = vec3u(state.place.x, chance.yz);
        } else if left.y {
            state.place = vec3u(inside.x, state.place.y, chance.z);
        } else {
            state.place = vec3u(inside.xy, state.place.z);
        }
        let p = vec3f(bitcast<vec3i>(state.place - eye)) * (side / 4294967296.0);
        velocity = air_at(p) - vec3f(0.0, 0.0, terminal);
        state.word = (times << 16u) | s;
    }
    state.velocity = velocity;
    return state;
}
