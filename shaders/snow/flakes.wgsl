// Flakes without a state: where each is follows from (seed, id, time) alone, and one quad draws it. The f64 twin and
// the derivation are in src/snow/lattice.rs and src/snow/reference.rs. The entry points read the depth:
// flakes_view.wgsl.
//!include "common/depth.wgsl"
//!include "common/guarded.wgsl"
//!include "common/hash.wgsl"
//!include "common/phase.wgsl"
//!include "common/streak.wgsl"
//!include "surroundings/lights_binding.wgsl"
//!include "surroundings/shelter.wgsl"
//!include "snow/shape.wgsl"

// Classes of diameter; shells of the lattice.
const CLASSES: u32 = 32u;
const SHELLS: u32 = 4u;

struct FlakesUniform {
    depth: DepthUniform,
    // From camera-relative east-north-up to clip space.
    clip: mat4x4f,
    // Of the air, m/s.
    wind: vec3f,
    // Time for which the picture is exposed, s.
    exposure: f32,
    // Mean radiance above and below the horizon, display units a channel.
    above: vec3f,
    seed: u32,
    below: vec3f,
    // Angle of a pixel, rad.
    pixel_angle: f32,
    // Irradiance of the sun or moon, display units.
    sun: vec3f,
    // Extinction of what lies between the eye and a flake beside the snow, 1/m.
    extinction: f32,
    to_sun: vec3f,
    // 1 where row 0 of the target is the picture's top, -1 where it is the bottom.
    y_sign: f32,
    // Of the camera, m/s.
    camera: vec3f,
    // Share of the flakes' cover that is drawn.
    share: f32,
    // Where each shell's flakes begin among all.
    first: vec4u,
    // Flakes of all shells.
    count: u32,
    // How far a flake of one turn unit has turned, in 2^-32 of a turn.
    turn: u32,
    pad: vec2u,
    // Per shell: place of the camera in the cell of the air, in 2^-32 of its side, and how far a flake of one speed
    // unit has fallen, likewise.
    cell: array<vec4u, SHELLS>,
    // Per shell: place of the camera in the world's cell, in 2^-32 of its side. Read of flakes that are stepped.
    eye: array<vec4u, SHELLS>,
    // Per shell: side of the cell, m; distance from which it begins to take over from the smaller one, from which it
    // hands on itself, and at which it has taken over.
    shell: array<vec4f, SHELLS>,
    // Per class: diameter, m; fall speed, speed units; radius of the helix, m; turns, turn units.
    classes: array<vec4f, CLASSES>,
    // Per class and shell: flakes of the classes up to this one, and flakes that each of them stands for.
    upto: array<vec4u, CLASSES>,
    weight: array<vec4f, CLASSES>,
}

// Fall speeds and turns are whole numbers of these, m/s and 1/s: phases are products of integers, exact at any time.
const SPEED_UNIT: f32 = 0.0009765625;
const TURN_UNIT: f32 = 0.00390625;
// Flakes nearer than this fade away: they would be blobs that no eye could focus on.
const NEAREST: f32 = 0.3;
// What sets flakes apart from drops in the numbers that places are made of.
const SALT: u32 = 0x5e00000u;
// Share of a flake's disc that is ice, as seen through it.
const AREA_RATIO: f32 = 0.6;
const TAU: f32 = 6.2831853;

@group(0) @binding(0) var<uniform> flakes: FlakesUniform;

struct Flake {
    // Camera-relative, m.
    position: vec3f,
    diameter: f32,
    // m/s.
    velocity: vec3f,
    // Share of it that its shell shows.
    share: f32,
    // Of the way without its helix, m/s: what shelters it or not.
    mean_velocity: vec3f,
    // Flakes that it stands for.
    weight: f32,
    // Where on its helix it is, rad.
    angle: f32,
    // What its shape is made of.
    shape: u32,
}

// Units of a class as a flake of its own random word has them: up to an eighth more or less.
fn scattered(units: i32, random: u32) -> i32 {
    return units + ((units * (i32(random & 255u) - 128)) >> 10u);
}

// What is a flake's own at any time.
struct Own {
    shell: u32,
    size_class: u32,
    random: vec3u,
    // Fall speed in speed units.
    speed: i32,
}

// Flakes of one class in one shell.
struct Run {
    shell: u32,
    size_class: u32,
    // Of the shell's flakes, its first and the one behind its last.
    first: u32,
    end: u32,
}

// That of flake `index` of a shell.
fn run_of(s: u32, index: u32) -> Run {
    var k = 0u;
    for (var step = CLASSES / 2u; step > 0u; step /= 2u) {
        k += select(0u, step, index >= flakes.upto[k + step - 1u][s]);
    }
    return Run(s, k, select(0u, flakes.upto[max(k, 1u) - 1u][s], k > 0u), flakes.upto[k][s]);
}

// Flake `index` of its shell.
fn own_of(run: Run, index: u32) -> Own {
    let random = random3(vec3u(flakes.seed, SALT | (run.shell << 8u) | run.size_class, index - run.first));
    return Own(run.shell, run.size_class, random, scattered(i32(flakes.classes[run.size_class].y), random.x));
}

// From the camera to where the lattice has it, without its helix, in 2^-32 of the cell's side.
fn lattice_place(own: Own) -> vec3u {
    let cell = flakes.cell[own.shell];
    return own.random - vec3u(0u, 0u, bitcast<u32>(own.speed) * cell.w) - cell.xyz;
}

// Shell of flake number `place` of all, the innermost shell's first.
fn shell_of(place: u32) -> u32 {
    return u32(place >= flakes.first.y) + u32(place >= flakes.first.z) + u32(place >= flakes.first.w);
}

// Flake `index` of its shell, where the lattice has it.
fn flake_in(run: Run, index: u32) -> Flake {
    let own = own_of(run, index);
    return flake_at(own, lattice_place(own), flakes.wind - vec3f(0.0, 0.0, f32(own.speed) * SPEED_UNIT));
}

// Flake number `place` of all.
fn flake_of(place: u32) -> Flake {
    let s = shell_of(place);
    let index = place - flakes.first[s];
    return flake_in(run_of(s, index), index);
}

// A flake so far from the camera, in 2^-32 of the cell's side, that goes with a velocity; both without its helix.
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

// What a flake scatters of a beam, 4 pi on the whole: all that its ice stops and does not bend by diffraction. The
// asymmetry of aggregates, 0.77 with diffraction, which is half of it and goes straight on, leaves 0.54.
fn flake_phase(c: f32) -> f32 {
    return henyey(0.54, c);
}

// Share of what surrounds a flake above the horizon in what it sends along a ray that rises by a sine `z`: flake_phase
// over a half space, by its first three Legendre terms, 1/2 + 3/4 g z - 7/16 g^3 P3(z).
fn flake_sky_share(z: f32) -> f32 {
    return 0.5 + z * (0.50835 - 0.17222 * z * z);
}

// Radiance of a flake at `p` seen along `d`.
fn flake_light(p: vec3f, d: vec3f) -> vec3f {
    var beams = flakes.sun * flake_phase(dot(d, flakes.to_sun));
    for (var i = 0u; i < light_count(); i++) {
        let to = p - lights.lamps[i].position;
        let from_lamp = to * inverseSqrt(max(dot(to, to), 1e-6));
        beams += light_at(lights.lamps[i], to) * flake_phase(-dot(d, from_lamp));
    }
    return mix(flakes.below, flakes.above, flake_sky_share(d.z)) + beams * 0.07957747;
}

struct FlakeVarying {
    @builtin(position) position: vec4f,
    @location(0) light: vec3f,
    // Share of the flake's disc that hides what lies behind, where the streak hides most of it; and where its shape is
    // drawn.
    @location(1) cover: vec2f,
    // As depth_of has it, and the share of its light that what lies between lets through.
    @location(2) depth_clear: vec3f,
    // Place in the quad in radii, across and along its way, and how far the middle's way reaches.
    @location(3) at: vec3f,
    // Place on the flake in radii, and how much of its shape shows, 0 to 1.
    @location(4) own: vec3f,
    @location(5) @interpolate(flat) shape: u32,
}

fn no_flake() -> FlakeVarying {
    return FlakeVarying(vec4f(2.0, 2.0, 2.0, 1.0), vec3f(0.0), vec2f(0.0), vec3f(0.0), vec3f(0.0), vec3f(0.0), 0u);
}

// Whether a disc of a radius about a line between two points can be in the picture.
fn in_picture(a: vec3f, b: vec3f, radius: f32) -> bool {
    let first = flakes.clip * vec4f(a, 1.0);
    let last = flakes.clip * vec4f(b, 1.0);
    // No lens is longer than 20 times the picture's half height.
    let side = 0.01 + 20.0 * radius + 1.02 * vec2f(first.w, last.w);
    let x = vec2f(first.x, last.x);
    let y = vec2f(first.y, last.y);
    return any(x < side) && any(-x < side) && any(y < side) && any(-y < side);
}

// Half of the way that is drawn of a flake, and what its cover is multiplied by.
fn flake_part(flake: Flake) -> vec4f {
    return part_drawn((flake.velocity - flakes.camera) * (0.5 * flakes.exposure), max(length(flake.position), 1e-3));
}

// Whether a flake can be in the picture, if nothing keeps it off.
fn may_show(flake: Flake, half: vec3f) -> bool {
    return flake.share > 0.0 && in_picture(flake.position - half, flake.position + half, flake.diameter);
}

// What a flake draws.
struct Spot {
    // Its middle, camera-relative, m.
    middle: vec3f,
    // m; 0: nothing is drawn.
    diameter: f32,
    // From the middle to the end of its way, m.
    half: vec3f,
    // Where on its helix it is, rad.
    angle: f32,
    light: vec3f,
    // Flakes that it stands for, times the share of it that is drawn.
    weight: f32,
    // What its shape is made of.
    shape: u32,
}

// Of a flake, if it `shows`.
fn spot_of(flake: Flake, part: vec4f, shows: bool) -> Spot {
    if !shows || sheltered(flake.position, flake.mean_velocity, shows) {
        return Spot();
    }
    let light = flake_light(flake.position, flake.position / max(length(flake.position), 1e-3));
    let weight = flake.weight * flake.share * part.w * flakes.share;
    return Spot(flake.position, flake.diameter, part.xyz, flake.angle, light, weight, flake.shape);
}

// A corner of what it covers while the shutter is open.
fn flake_corner(spot: Spot, corner: u32) -> FlakeVarying {
    if spot.diameter <= 0.0 {
        return no_flake();
    }
    let d = max(length(spot.middle), 1e-3);
    let toward = spot.middle / d;
    let half = spot.half;
    var out = no_flake();
    let radius = 0.5 * max(spot.diameter, max(flakes.pixel_angle * d * LEAST_PIXELS, 1e-6));
    // An axis of its own for each, turning as it falls: no direction of view is one along which all lose their sides.
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
    // Below some pixels a flake is a disc as faint as its ice is thin, and one that moves by more than itself a streak.
    let pixels = spot.diameter / (flakes.pixel_angle * d);
    out.own = vec3f(dot(off, right), dot(off, up), 0.0) / radius;
    out.own.z = smoothstep(3.0, 6.0, pixels) * (1.0 - smoothstep(0.5, 1.5, reach));
    out.shape = spot.shape;
    out.light = spot.light;
    return out;
}

fn lone_corner(flake: Flake, corner: u32) -> FlakeVarying {
    let part = flake_part(flake);
    return flake_corner(spot_of(flake, part, may_show(flake, part.xyz)), corner);
}

// Every flake, the outermost shell's first, where there are no compute shaders.
@vertex
fn flake_vertex(@builtin(vertex_index) corner: u32, @builtin(instance_index) instance: u32) -> FlakeVarying {
    return lone_corner(flake_of(flakes.count - 1u - instance), corner);
}

struct ListedFlake {
    @location(0) middle_diameter: vec4f,
    @location(1) half_angle: vec4f,
    @location(2) light_weight: vec4f,
    @location(3) shape: u32,
}

// Those that were found to be in the picture (snow/cull.wgsl).
@vertex
fn listed_vertex(@builtin(vertex_index) corner: u32, listed: ListedFlake) -> FlakeVarying {
    let middle = listed.middle_diameter;
    let half = listed.half_angle;
    let light = listed.light_weight;
    return flake_corner(Spot(middle.xyz, middle.w, half.xyz, half.w, light.xyz, light.w, listed.shape), corner);
}

// One that is stepped: number `index` of its shell, with the place and velocity of its state (falling/state.wgsl).
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

// Premultiplied.
fn flake_color(in: FlakeVarying, shown: f32) -> vec4f {
    let soft = share_before(shown, in.depth_clear.xy);
    let streak = in.cover.x * passing(in.at.xy, in.at.z);
    let shape = in.cover.y * flake_shape(in.own.xy, in.shape, in.own.z > 0.0);
    let cover = min(mix(streak, shape, in.own.z), 1.0) * soft * in.depth_clear.z;
    return vec4f(in.light * cover, cover);
}
