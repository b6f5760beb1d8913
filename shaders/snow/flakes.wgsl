// Flakes without a state: the place of each flake is a function of (seed, id, time), and one quad draws it. The f64
// references, with the derivations, are src/snow/lattice.rs (places) and src/snow/reference.rs (light). The entry
// points that read the depth are in flakes_view.wgsl.
//!include "common/depth.wgsl"
//!include "common/guarded.wgsl"
//!include "common/hash.wgsl"
//!include "common/phase.wgsl"
//!include "common/streak.wgsl"
//!include "surroundings/lights_binding.wgsl"
//!include "surroundings/shelter.wgsl"
//!include "snow/shape.wgsl"

// Number of classes of diameter.
const CLASSES: u32 = 32u;
// Number of shells of the lattice.
const SHELLS: u32 = 4u;

// Block of the flakes.
struct FlakesUniform {
    // View rays of the camera, and its depth mapping.
    depth: DepthUniform,
    // Matrix from camera-relative east, north, up to clip space.
    clip: mat4x4f,
    // Velocity of the air, (east, north, up), m/s.
    wind: vec3f,
    // Exposure time of the picture, s.
    exposure: f32,
    // Mean radiance of the surroundings above the horizon (`above`) and below it (`below`), display units per channel.
    above: vec3f,
    seed: u32,
    below: vec3f,
    // Angle of a pixel, rad.
    pixel_angle: f32,
    // Irradiance of the sun or moon (`sun`), display units, and the unit vector towards it (`to_sun`).
    sun: vec3f,
    // Extinction between the eye and a flake by everything except snow, 1/m.
    extinction: f32,
    to_sun: vec3f,
    // 1 where row 0 of the target is the picture's top, -1 where it is the bottom.
    y_sign: f32,
    // Velocity of the camera, (east, north, up), m/s.
    camera: vec3f,
    // Share of the flakes' opacity that is drawn.
    share: f32,
    // Index of the first flake of each shell.
    first: vec4u,
    // Number of flakes in all shells.
    count: u32,
    // Angle since time 0 of a flake that turns at a rate of one TURN_UNIT, in 2^-32 of a turn.
    turn: u32,
    pad: vec2u,
    // Per shell, in 2^-32 of the cell's side. x, y, z: place of the camera in the cell that moves with the air. w:
    // distance that a flake with a speed of one unit has fallen.
    cell: array<vec4u, SHELLS>,
    // Per shell: place of the camera in the cell fixed to the world, in 2^-32 of its side. Used for stepped flakes.
    eye: array<vec4u, SHELLS>,
    // Per shell, m. x: side of the cell. y and w: distances at which the shell begins to fade in and is drawn in full,
    // while the next smaller shell fades out. z: distance at which the shell begins to fade out.
    shell: array<vec4f, SHELLS>,
    // Per class. x: diameter, m. y: fall speed, SPEED_UNIT. z: radius of the helix, m. w: turns, TURN_UNIT.
    classes: array<vec4f, CLASSES>,
    // Per class, for each shell: number of flakes of the classes up to this one.
    upto: array<vec4u, CLASSES>,
    // Per class, for each shell: number of flakes that each drawn flake stands for.
    weight: array<vec4f, CLASSES>,
}

// Unit of fall speeds, m/s. Speeds and turns are integer multiples of their units, so phases are products of integers
// and exact at any time.
const SPEED_UNIT: f32 = 0.0009765625;
// Unit of turns, 1/s.
const TURN_UNIT: f32 = 0.00390625;
// Flakes nearer than this, m, fade out: they would be blobs on which no eye could focus.
const NEAREST: f32 = 0.3;
// Offset that gives flakes other random numbers than drops.
const SALT: u32 = 0x5e00000u;
// Share of a flake's disc that is covered by ice.
const AREA_RATIO: f32 = 0.6;
// Full turn, rad.
const TAU: f32 = 6.2831853;

@group(0) @binding(0) var<uniform> flakes: FlakesUniform;

// Flake of the lattice, or a stepped one.
struct Flake {
    // Position relative to the camera, m.
    position: vec3f,
    // Diameter, m.
    diameter: f32,
    // Velocity, m/s.
    velocity: vec3f,
    // Share of the flake that its shell shows at its distance, 0 to 1.
    share: f32,
    // Velocity without the helix, m/s, with which shelter is tested.
    mean_velocity: vec3f,
    // Number of flakes that it stands for.
    weight: f32,
    // Angle on its helix, rad.
    angle: f32,
    // Seed of its shape.
    shape: u32,
}

// Returns the fall speed or turns of a flake, in units: those of its class, varied at random by up to an eighth.
fn scattered(units: i32, random: u32) -> i32 {
    return units + ((units * (i32(random & 255u) - 128)) >> 10u);
}

// Properties of a flake that do not change with time.
struct Own {
    shell: u32,
    size_class: u32,
    // Three random words, from which its place, speed, turns and shape follow.
    random: vec3u,
    // Fall speed, speed units.
    speed: i32,
}

// Run of flakes: those of one class in one shell.
struct Run {
    shell: u32,
    size_class: u32,
    // Index of its first flake in the shell, and of the flake after its last.
    first: u32,
    end: u32,
}

// Returns the run that contains flake `index` of a shell.
fn run_of(s: u32, index: u32) -> Run {
    var k = 0u;
    for (var step = CLASSES / 2u; step > 0u; step /= 2u) {
        k += select(0u, step, index >= flakes.upto[k + step - 1u][s]);
    }
    return Run(s, k, select(0u, flakes.upto[max(k, 1u) - 1u][s], k > 0u), flakes.upto[k][s]);
}

// Returns the constant properties of flake `index` of its shell.
fn own_of(run: Run, index: u32) -> Own {
    let random = random3(vec3u(flakes.seed, SALT | (run.shell << 8u) | run.size_class, index - run.first));
    return Own(run.shell, run.size_class, random, scattered(i32(flakes.classes[run.size_class].y), random.x));
}

// Returns the place of a flake of the lattice relative to the camera, without its helix, in 2^-32 of the cell's side.
fn lattice_place(own: Own) -> vec3u {
    let cell = flakes.cell[own.shell];
    return own.random - vec3u(0u, 0u, bitcast<u32>(own.speed) * cell.w) - cell.xyz;
}

// Returns the shell of flake number `place` among the flakes of all shells; those of the innermost shell come first.
fn shell_of(place: u32) -> u32 {
    return u32(place >= flakes.first.y) + u32(place >= flakes.first.z) + u32(place >= flakes.first.w);
}

// Returns flake `index` of its shell at its place in the lattice.
fn flake_in(run: Run, index: u32) -> Flake {
    let own = own_of(run, index);
    return flake_at(own, lattice_place(own), flakes.wind - vec3f(0.0, 0.0, f32(own.speed) * SPEED_UNIT));
}

// Returns flake number `place` among the flakes of all shells.
fn flake_of(place: u32) -> Flake {
    let s = shell_of(place);
    let index = place - flakes.first[s];
    return flake_in(run_of(s, index), index);
}

// Returns a flake at `away` from the camera, in 2^-32 of the cell's side, with the velocity `mean`; both without its
// helix.
fn flake_at(own: Own, away: vec3u, mean: vec3f) -> Flake {
    let s = own.shell;
    let row = flakes.classes[own.size_class];
    let random = own.random;
    let turned = scattered(i32(row.w), random.y);
    let turns = select(turned, -turned, (random.z & 1u) != 0u);
    let angle = f32((random.z << 16u) + bitcast<u32>(turns) * flakes.turn) * (TAU / 4294967296.0);
    let shell = flakes.shell[s];
    let p = vec3f(bitcast<vec3i>(away)) * (shell.x / 4294967296.0);
    let d = length(p);
    let outer = 1.0 - smoothstep(shell.z, 0.5 * shell.x, d);
    let inner = select(smoothstep(shell.y, shell.w, d), smoothstep(0.5 * NEAREST, NEAREST, d), s == 0u);
    let around = vec3f(cos(angle), sin(angle), 0.0);
    let aside = vec3f(-around.y, around.x, 0.0) * (f32(turns) * (TURN_UNIT * TAU) * row.z);
    let shape = (random.x & 0xffffu) | (random.y << 16u);
    return Flake(p + around * row.z, row.x, mean + aside, inner * outer, mean, flakes.weight[own.size_class][s], angle, shape);
}

// Returns the phase function of a flake, whose integral over all directions is 4 pi: the scattering by its ice, without
// diffraction. `c` is the cosine of the scattering angle: 1 is straight on. Aggregates have an asymmetry of 0.77 with
// diffraction. Diffraction is half of the scattering and goes straight on, so the rest has an asymmetry of 0.54.
fn flake_phase(c: f32) -> f32 {
    return henyey(0.54, c);
}

// Returns the share of light from above the horizon in the light that a flake scatters along a ray whose sine of
// elevation is `z`: the integral of flake_phase over the upper hemisphere, by its first three Legendre terms, 1/2 + 3/4
// g z - 7/16 g^3 P3(z).
fn flake_sky_share(z: f32) -> f32 {
    return 0.5 + z * (0.50835 - 0.17222 * z * z);
}

// Returns the radiance of a flake at `p` seen along `d`.
fn flake_light(p: vec3f, d: vec3f) -> vec3f {
    var beams = flakes.sun * flake_phase(dot(d, flakes.to_sun));
    for (var i = 0u; i < light_count(); i++) {
        let to = p - lights.lamps[i].position;
        let from_lamp = to * inverseSqrt(max(dot(to, to), 1e-6));
        beams += light_at(lights.lamps[i], to) * flake_phase(-dot(d, from_lamp));
    }
    return mix(flakes.below, flakes.above, flake_sky_share(d.z)) + beams * 0.07957747;
}

// Corner of a flake's quad.
struct FlakeVarying {
    @builtin(position) position: vec4f,
    @location(0) light: vec3f,
    // Opacity of the flake where its streak covers most (x), and the factor on the opacity of its shape (y).
    @location(1) cover: vec2f,
    // Depth from depth_of, and transmittance between the flake and the eye.
    @location(2) depth_clear: vec3f,
    // Position in the quad, across (x) and along (y) the motion, and distance that the flake's middle moves to either
    // side (z), in radii of the drawn flake.
    @location(3) at: vec3f,
    // Position on the flake, in radii (x, y), and weight of its shape against a streak, 0 to 1 (z).
    @location(4) own: vec3f,
    @location(5) @interpolate(flat) shape: u32,
}

// Returns a corner outside the picture, for flakes that are not drawn.
fn no_flake() -> FlakeVarying {
    return FlakeVarying(vec4f(2.0, 2.0, 2.0, 1.0), vec3f(0.0), vec2f(0.0), vec3f(0.0), vec3f(0.0), vec3f(0.0), 0u);
}

// Returns whether a disc of this radius that moves from `a` to `b` can be in the picture.
fn in_picture(a: vec3f, b: vec3f, radius: f32) -> bool {
    let first = flakes.clip * vec4f(a, 1.0);
    let last = flakes.clip * vec4f(b, 1.0);
    // The focal length of a lens is at most 20 times the picture's half height.
    let side = 0.01 + 20.0 * radius + 1.02 * vec2f(first.w, last.w);
    let x = vec2f(first.x, last.x);
    let y = vec2f(first.y, last.y);
    return any(x < side) && any(-x < side) && any(y < side) && any(-y < side);
}

// Returns the result of `part_drawn` (common/streak.wgsl) for a flake: half of its drawn path during the exposure, m,
// and the factor for its opacity.
fn flake_part(flake: Flake) -> vec4f {
    return part_drawn((flake.velocity - flakes.camera) * (0.5 * flakes.exposure), max(length(flake.position), 1e-3));
}

// Returns whether a flake can be in the picture if it is not sheltered. `half` is half of its drawn path, m.
fn may_show(flake: Flake, half: vec3f) -> bool {
    return flake.share > 0.0 && in_picture(flake.position - half, flake.position + half, flake.diameter);
}

// Quad that a flake draws.
struct Spot {
    // Middle of the flake, camera-relative, m.
    middle: vec3f,
    // Diameter, m; 0 if nothing is drawn.
    diameter: f32,
    // Vector from the middle to the end of its motion, m.
    half: vec3f,
    // Angle on its helix, rad.
    angle: f32,
    // Radiance of the flake, display units per channel.
    light: vec3f,
    // Number of flakes that it stands for, times the share of it that is drawn.
    weight: f32,
    // Seed of its shape.
    shape: u32,
}

// Returns the quad of a flake; an empty one unless the flake `shows` and no shelter keeps it off.
fn spot_of(flake: Flake, part: vec4f, shows: bool) -> Spot {
    if !shows || sheltered(flake.position, flake.mean_velocity, shows) {
        return Spot();
    }
    let light = flake_light(flake.position, flake.position / max(length(flake.position), 1e-3));
    let weight = flake.weight * flake.share * part.w * flakes.share;
    return Spot(flake.position, flake.diameter, part.xyz, flake.angle, light, weight, flake.shape);
}

// Returns a corner of the quad that the flake covers during the exposure.
fn flake_corner(spot: Spot, corner: u32) -> FlakeVarying {
    if spot.diameter <= 0.0 {
        return no_flake();
    }
    let d = max(length(spot.middle), 1e-3);
    let toward = spot.middle / d;
    let half = spot.half;
    var out = no_flake();
    let radius = 0.5 * max(spot.diameter, max(flakes.pixel_angle * d * LEAST_PIXELS, 1e-6));
    // Each flake has its own axis, which turns as it falls. So there is no view direction in which all flakes look
    // alike.
    let high = f32(spot.shape >> 16u) * (2.0 / 65535.0) - 1.0;
    let level = sqrt(max(1.0 - high * high, 0.0));
    let axis = vec3f(level * cos(spot.angle), level * sin(spot.angle), high);
    let right = unit_or(cross(toward, axis) + vec3f(1e-6, 0.0, 1e-6), vec3f(1.0, 0.0, 0.0));
    let up = cross(right, toward);
    let across_view = half - toward * dot(half, toward);
    let stretch = length(across_view);
    let lengthwise = select(up, across_view / max(stretch, 1e-9), stretch > 1e-6);
    let side = select(-1.0, 1.0, (corner & 1u) != 0u);
    let end = select(-1.0, 1.0, (corner & 2u) != 0u);
    let off = across_view * end + lengthwise * (end * radius) + cross(toward, lengthwise) * (side * radius);
    var clip = flakes.clip * vec4f(spot.middle + off + (half - across_view) * end, 1.0);
    clip.y *= flakes.y_sign;
    out.position = vec4f(clip.xy, 0.0, clip.w);
    let depth = depth_of(flakes.depth, (flakes.clip * vec4f(spot.middle, 1.0)).w, d, spot.diameter);
    out.depth_clear = vec3f(depth, exp(-flakes.extinction * d));
    let reach = reach_of(stretch, radius);
    out.at = vec3f(side, end * (reach + 1.0), reach);
    let thin = 0.5 * spot.diameter / radius;
    out.cover = vec2f(thin * thin * AREA_RATIO * longest_passing(reach), 1.0) * spot.weight;
    // A flake of less than some pixels is a disc whose opacity is its share of ice. One that moves by more than its
    // size is a streak.
    let pixels = spot.diameter / (flakes.pixel_angle * d);
    out.own = vec3f(dot(off, right), dot(off, up), 0.0) / radius;
    out.own.z = smoothstep(3.0, 6.0, pixels) * (1.0 - smoothstep(0.5, 1.5, reach));
    out.shape = spot.shape;
    out.light = spot.light;
    return out;
}

// Returns a corner of the quad of a flake that no list has prepared.
fn lone_corner(flake: Flake, corner: u32) -> FlakeVarying {
    let part = flake_part(flake);
    return flake_corner(spot_of(flake, part, may_show(flake, part.xyz)), corner);
}

// Draws every flake, those of the outermost shell first, on devices without compute shaders.
@vertex
fn flake_vertex(@builtin(vertex_index) corner: u32, @builtin(instance_index) instance: u32) -> FlakeVarying {
    return lone_corner(flake_of(flakes.count - 1u - instance), corner);
}

// Flake from the list, as vertex attributes.
struct ListedFlake {
    @location(0) middle_diameter: vec4f,
    @location(1) half_angle: vec4f,
    @location(2) light_weight: vec4f,
    @location(3) shape: u32,
}

// Draws the flakes that were found to be in the picture (snow/cull.wgsl).
@vertex
fn listed_vertex(@builtin(vertex_index) corner: u32, listed: ListedFlake) -> FlakeVarying {
    let middle = listed.middle_diameter;
    let half = listed.half_angle;
    let light = listed.light_weight;
    return flake_corner(Spot(middle.xyz, middle.w, half.xyz, half.w, light.xyz, light.w, listed.shape), corner);
}

// Draws a stepped flake: number `index` of its shell, with the place and velocity of its state (falling/state.wgsl).
@vertex
fn stepped_vertex(
    @builtin(vertex_index) corner: u32,
    @builtin(instance_index) index: u32,
    @location(0) place: vec3u,
    @location(1) word: u32,
    @location(2) velocity: vec3f,
) -> FlakeVarying {
    let s = word & 0xffffu;
    return lone_corner(flake_at(own_of(run_of(s, index), index), place - flakes.eye[s].xyz, velocity), corner);
}

// Returns the premultiplied light of a pixel of a flake. `shown` is the depth of the host's picture.
fn flake_color(in: FlakeVarying, shown: f32) -> vec4f {
    let soft = share_before(shown, in.depth_clear.xy);
    let streak = in.cover.x * passing(in.at.xy, in.at.z);
    let shape = in.cover.y * flake_shape(in.own.xy, in.shape, in.own.z > 0.0);
    let cover = min(mix(streak, shape, in.own.z), 1.0) * soft * in.depth_clear.z;
    return vec4f(in.light * cover, cover);
}
