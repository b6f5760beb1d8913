// Drops without a state: where each is follows from (seed, id, time) alone, and one quad draws its streak.
// The f64 twin and the derivation are in src/rain/lattice.rs.
//!include "common/depth.wgsl"
//!include "surroundings/lights_binding.wgsl"
//!include "common/hash.wgsl"
//!include "common/streak.wgsl"
//!include "surroundings/shelter.wgsl"
//!include "rain/phase.wgsl"
//!include "rain/local.wgsl"

// Whether the rim of a rain area is near.
override AREAS: bool = false;

// Classes of diameter; shells of the lattice.
const CLASSES: u32 = 32u;

struct RainUniform {
    depth: DepthUniform,
    // From camera-relative east-north-up to clip space.
    clip: mat4x4f,
    // Of the air, m/s.
    wind: vec3f,
    // Time for which the picture is exposed, s.
    exposure: f32,
    // Mean radiance above and below the horizon as a drop passes it on, display units a channel.
    above: vec3f,
    // Drops of one shell.
    per_shell: u32,
    below: vec3f,
    seed: u32,
    // Irradiance of the sun or moon, display units.
    sun: vec3f,
    // Angle of a pixel, rad.
    pixel_angle: f32,
    to_sun: vec3f,
    // Extinction of what lies between the eye and a drop beside the rain, 1/m.
    extinction: f32,
    // Drops that each drawn one of the innermost shell stands for.
    weight: f32,
    // 1 where row 0 of the target is the picture's top, -1 where it is the bottom.
    y_sign: f32,
    // Shells of drops that are drawn.
    shells: u32,
    // By how much what falls stands out more than it does in nature; 1: as it does.
    gain: f32,
    // Of the camera, m/s.
    camera: vec3f,
    pad2: f32,
    // Per shell: place of the camera in the cell of the air, in 2^-32 of its side, and how far a drop of one speed unit
    // has fallen, likewise.
    cell: array<vec4u, SHELLS>,
    // Per shell: side of the cell, m; distance from which it begins to take over from the smaller one, from which it
    // hands on itself, and at which it has taken over.
    shell: array<vec4f, SHELLS>,
    // Per class: diameter, m; fall speed, speed units; drops of the classes up to this one.
    classes: array<vec4f, CLASSES>,
}

const SHELLS: u32 = 4u;
// Fall speeds are whole numbers of this, m/s: a drop's fall phase is a product of integers, exact at any time.
const SPEED_UNIT: f32 = 0.015625;
// Drops nearer than this fade away: they would be blobs that no eye could focus on.
const NEAREST: f32 = 0.25;

@group(0) @binding(0) var<uniform> rain: RainUniform;

struct Drop {
    // Camera-relative, m.
    position: vec3f,
    diameter: f32,
    speed: f32,
    // Share of the drop that its shell shows.
    share: f32,
    // Drops that it stands for.
    weight: f32,
}

fn class_of(index: u32) -> u32 {
    var low = 0u;
    for (var step = CLASSES / 2u; step > 0u; step /= 2u) {
        low += select(0u, step, index >= u32(rain.classes[low + step - 1u].z));
    }
    return low;
}

// What the drops of one class in one shell have in common.
struct ClassInShell {
    s: u32,
    k: u32,
    // Of the shell's drops, its first and the one behind its last.
    first: u32,
    end: u32,
    diameter: f32,
    // Speed units.
    speed: u32,
    cell: vec4u,
    shell: vec4f,
}

fn class_in_shell(s: u32, k: u32) -> ClassInShell {
    let size = rain.classes[k];
    let first = select(0u, u32(rain.classes[max(k, 1u) - 1u].z), k > 0u);
    return ClassInShell(s, k, first, u32(size.z), size.x, u32(size.y), rain.cell[s], rain.shell[s]);
}

// Drop `index` of its shell.
fn drop_of(in_shell: ClassInShell, index: u32) -> Drop {
    let place = random3(vec3u(rain.seed, (in_shell.s << 8u) | in_shell.k, index - in_shell.first));
    return drop_at(in_shell, index, place - vec3u(0u, 0u, in_shell.speed * in_shell.cell.w) - in_shell.cell.xyz);
}

// The same, `away_units` from the camera in 2^-32 of the cell's side.
fn drop_at(in_shell: ClassInShell, index: u32, away_units: vec3u) -> Drop {
    let shell = in_shell.shell;
    let p = vec3f(bitcast<vec3i>(away_units)) * (shell.x / 4294967296.0);
    let d = length(p);
    let outer = 1.0 - smoothstep(shell.z, 0.5 * shell.x, d);
    let inner = select(smoothstep(shell.y, shell.w, d), smoothstep(0.5 * NEAREST, NEAREST, d), in_shell.s == 0u);
    var here = vec2f(1e9, rain.weight);
    if AREAS {
        here = local_drops(in_shell.k, p);
    }
    let share = select(0.0, inner * outer, f32(index - in_shell.first) < here.x);
    return Drop(p, in_shell.diameter, f32(in_shell.speed) * SPEED_UNIT, share, here.y * f32(1u << in_shell.s));
}

// Radiance of a drop seen along `d` without lamps: it shows, small and upside down, most of the half space behind it,
// and what the sun sends through it.
fn day_light(d: vec3f) -> vec3f {
    return mix(rain.below, rain.above, sky_share(d.z)) + rain.sun * (drop_phase(dot(d, rain.to_sun)) * 0.07957747);
}

// What lamps send through one at `p`.
fn lamp_light(p: vec3f, d: vec3f) -> vec3f {
    var beams = vec3f(0.0);
    for (var i = 0u; i < light_count(); i++) {
        let to = p - lights.lamps[i].position;
        let from_lamp = to * inverseSqrt(max(dot(to, to), 1e-6));
        beams += light_at(lights.lamps[i], to) * drop_phase(-dot(d, from_lamp));
    }
    return beams * 0.07957747;
}

fn drop_light(p: vec3f, d: vec3f) -> vec3f {
    return day_light(d) + lamp_light(p, d);
}

struct RainVarying {
    @builtin(position) position: vec4f,
    // Premultiplied.
    @location(0) light: vec4f,
    // As depth_of has it.
    @location(1) depth: vec2f,
    // Across the streak, -1 to 1, and along it from its middle, in radii of the drop as it is drawn; how far the drop's
    // middle goes to either side of that.
    @location(2) at: vec3f,
}

// Whether a line between two points, some pixels wide, can be in the picture.
fn in_picture(a: vec3f, b: vec3f) -> bool {
    let first = rain.clip * vec4f(a, 1.0);
    let last = rain.clip * vec4f(b, 1.0);
    let side = 0.05 + 1.02 * vec2f(first.w, last.w);
    let x = vec2f(first.x, last.x);
    let y = vec2f(first.y, last.y);
    return any(x < side) && any(-x < side) && any(y < side) && any(-y < side);
}

// The same of a drop of a `velocity`.
fn drop_part(drop: Drop, velocity: vec3f) -> vec4f {
    return part_drawn((velocity - rain.camera) * (0.5 * rain.exposure), max(length(drop.position), 1e-3));
}

// Whether a drop of a `velocity` can be in the picture, if nothing keeps it off.
fn may_show(drop: Drop, velocity: vec3f) -> bool {
    let half = drop_part(drop, velocity).xyz;
    return drop.share > 0.0 && in_picture(drop.position - half, drop.position + half);
}

// What a drop draws.
struct Streak {
    // Its middle, camera-relative, m.
    middle: vec3f,
    // m; 0: nothing is drawn.
    width: f32,
    // From the middle to its end, m.
    half: vec3f,
    // Where it hides most, premultiplied.
    light: vec4f,
}

// What hides a share of a pixel's exposure, with the contrast's gain on it: as much as `gain` of it one before the
// other would.
fn gained(cover: f32) -> f32 {
    let most = min(cover, 1.0);
    return select(1.0 - pow(1.0 - most, rain.gain), most, rain.gain == 1.0);
}

// The streak of a drop of a `velocity`, if it `shows`.
fn streak_of(drop: Drop, velocity: vec3f, shows: bool) -> Streak {
    let part = drop_part(drop, velocity);
    let half = part.xyz;
    if !shows || sheltered(drop.position + half, velocity, shows) {
        return Streak();
    }
    let d = max(length(drop.position), 1e-3);
    let toward = drop.position / d;
    let width = max(drop.diameter, max(rain.pixel_angle * d * LEAST_PIXELS, 1e-6));
    let stretch = max(length(half - toward * dot(half, toward)), 1e-6);
    // Where it is drawn wider than it is, it hides as much less.
    let thin = drop.diameter / width;
    let most = thin * thin * drop.weight * longest_passing(reach_of(stretch, 0.5 * width));
    let cover = gained(most) * (drop.share * part.w);
    let clear = exp(-rain.extinction * d);
    let light = vec4f(drop_light(drop.position, toward) * (cover * clear), cover * clear);
    return Streak(drop.position, width, half, light);
}

// Both ends of a streak, then its width across the picture.
fn corner_of(streak: Streak, corner: u32) -> RainVarying {
    let d = max(length(streak.middle), 1e-3);
    let toward = streak.middle / d;
    let along = select(-1.0, 1.0, (corner & 2u) != 0u);
    let side = select(-1.0, 1.0, (corner & 1u) != 0u);
    let way = streak.half - toward * dot(streak.half, toward);
    let stretch = max(length(way), 1e-6);
    let lengthwise = way / stretch;
    let end = streak.middle + along * (streak.half + lengthwise * (0.5 * streak.width))
        + cross(toward, lengthwise) * (side * 0.5 * streak.width);
    var clip = rain.clip * vec4f(end, 1.0);
    clip.y *= rain.y_sign;
    let position = select(vec4f(2.0, 2.0, 2.0, 1.0), vec4f(clip.xy, 0.0, clip.w), streak.width > 0.0);
    let reach = reach_of(stretch, 0.5 * max(streak.width, 1e-9));
    let depth = depth_of(rain.depth, (rain.clip * vec4f(streak.middle, 1.0)).w, d, 0.0);
    return RainVarying(position, streak.light, depth, vec3f(side, along * (reach + 1.0), reach));
}

// Every drop of the lattice, where there are no compute shaders.
@vertex
fn rain_vertex(@builtin(vertex_index) corner: u32, @builtin(instance_index) instance: u32) -> RainVarying {
    let index = instance % rain.per_shell;
    let drop = drop_of(class_in_shell(instance / rain.per_shell, class_of(index)), index);
    let velocity = rain.wind - vec3f(0.0, 0.0, drop.speed);
    return corner_of(streak_of(drop, velocity, may_show(drop, velocity)), corner);
}

struct Listed {
    @location(0) middle_width: vec4f,
    @location(1) half: vec3f,
    @location(2) light: vec4f,
}

// Those that were found to be in the picture (rain/cull.wgsl).
@vertex
fn listed_vertex(@builtin(vertex_index) corner: u32, listed: Listed) -> RainVarying {
    return corner_of(Streak(listed.middle_width.xyz, listed.middle_width.w, listed.half, listed.light), corner);
}

// `shown`: depth of the host's picture.
fn streak(in: RainVarying, shown: f32) -> vec4f {
    return in.light * (passing(in.at.xy, in.at.z) * share_before(shown, in.depth));
}
