// Drops without a state: where each is follows from (seed, id, time) alone, and one quad draws its streak.
// The f64 twin and the derivation are in src/rain/lattice.rs and src/rain/reference.rs.
//!include "common/depth.wgsl"
//!include "rain/lights_binding.wgsl"
//!include "rain/hash.wgsl"
//!include "rain/shelter.wgsl"
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
    pad0: f32,
    pad1: f32,
    // Of the camera, m/s.
    camera: vec3f,
    pad2: f32,
    // Per shell: place of the camera in the cell of the air, in 2^-32 of its side, and how far a drop of one speed unit has
    // fallen, likewise.
    cell: array<vec4u, SHELLS>,
    // Per shell: side of the cell, m; distance from which it begins to take over from the smaller one, from which it hands on
    // itself, and at which it has taken over.
    shell: array<vec4f, SHELLS>,
    // Per class: diameter, m; fall speed, speed units; drops of the classes up to this one.
    classes: array<vec4f, CLASSES>,
}

const SHELLS: u32 = 4u;
// Fall speeds are whole numbers of this, m/s: a drop's fall phase is a product of integers, exact at any time.
const SPEED_UNIT: f32 = 0.015625;
// A streak is not drawn narrower than this many pixels; it gets fainter instead.
const LEAST_PIXELS: f32 = 1.2;
// Drops nearer than this fade away: they would be blobs that no eye could focus on.
const NEAREST: f32 = 0.25;
// A streak is drawn up to this share of its distance to either side.
const LONGEST: f32 = 0.8;

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

fn drop_of(instance: u32) -> Drop {
    let s = instance / rain.per_shell;
    let index = instance % rain.per_shell;
    let k = class_of(index);
    let first = select(0u, u32(rain.classes[max(k, 1u) - 1u].z), k > 0u);
    let size = rain.classes[k];
    let place = random3(vec3u(rain.seed, (s << 8u) | k, index - first));
    let fallen = u32(size.y) * rain.cell[s].w;
    return drop_at(s, k, index - first, place - vec3u(0u, 0u, fallen) - rain.cell[s].xyz);
}

// The drop `number` of shell `s` and class `k`, `away_units` from the camera in 2^-32 of the cell's side.
fn drop_at(s: u32, k: u32, number: u32, away_units: vec3u) -> Drop {
    let size = rain.classes[k];
    let away = bitcast<vec3i>(away_units);
    let shell = rain.shell[s];
    let p = vec3f(away) * (shell.x / 4294967296.0);
    let d = length(p);
    let last = s + 1u == SHELLS;
    let outer = 1.0 - smoothstep(shell.z, 0.5 * shell.x, d);
    let inner = select(smoothstep(shell.y, shell.w, d), smoothstep(0.5 * NEAREST, NEAREST, d), s == 0u);
    var here = vec2f(1e9, rain.weight);
    if AREAS {
        here = local_drops(k, p);
    }
    let share = select(0.0, inner * outer, f32(number) < here.x);
    return Drop(p, size.x, size.y * SPEED_UNIT, share, here.y * f32(1u << s));
}

// Radiance of a drop at `p` seen along `d`: it shows, small and upside down, most of the half space behind it, and what
// sun and lamps send through it.
fn drop_light(p: vec3f, d: vec3f) -> vec3f {
    let around = mix(rain.below, rain.above, 0.5 + 0.5 * d.z);
    var beams = rain.sun * drop_phase(dot(d, rain.to_sun));
    for (var i = 0u; i < lights.count; i++) {
        let to = p - lights.lamps[i].position;
        let from_lamp = to * inverseSqrt(max(dot(to, to), 1e-6));
        beams += light_at(lights.lamps[i], to) * drop_phase(-dot(d, from_lamp));
    }
    return around + beams * 0.07957747;
}

struct RainVarying {
    @builtin(position) position: vec4f,
    // Premultiplied.
    @location(0) light: vec4f,
    @location(1) range: f32,
    // Across the streak, -1 to 1.
    @location(2) across: f32,
}

// Whether a line between two points, some pixels wide, can be in the picture.
fn in_picture(a: vec3f, b: vec3f) -> bool {
    let ends = array<vec4f, 2>(rain.clip * vec4f(a, 1.0), rain.clip * vec4f(b, 1.0));
    let side = 0.05 + 1.02 * vec2f(ends[0].w, ends[1].w);
    let x = vec2f(ends[0].x, ends[1].x);
    let y = vec2f(ends[0].y, ends[1].y);
    return any(x < side) && any(-x < side) && any(y < side) && any(-y < side);
}

@vertex
fn rain_vertex(@builtin(vertex_index) corner: u32, @builtin(instance_index) instance: u32) -> RainVarying {
    let drop = drop_of(instance);
    return streak_of(drop, rain.wind - vec3f(0.0, 0.0, drop.speed), corner);
}

// Half of the way that is drawn of what moves by `half` to either side of a place at distance `d`, and what its cover is
// multiplied by. A streak that nears the eye is cut there, to the part of the exposure in which it goes `LONGEST` of `d` to
// either side, and hides as much in that part as in all of it. So places d (1 - c) to d (1 + c) along a ray are darkened, by
// what is at d, where c is that part: atanh(c) / c times what is there, whatever way the camera looks. The factor is its inverse.
fn part_drawn(half: vec3f, d: f32) -> vec4f {
    let whole = length(half) / d;
    let c = min(whole, LONGEST);
    let c2 = c * c;
    // To .2 % of c / atanh(c).
    return vec4f(half * (c / max(whole, 1e-9)), 1.0 - c2 * (0.33333333 + c2 * (0.08888889 + 0.085 * c2)));
}

// A corner of the streak that a drop of a `velocity` draws.
fn streak_of(drop: Drop, velocity: vec3f, corner: u32) -> RainVarying {
    let d = max(length(drop.position), 1e-3);
    let part = part_drawn((velocity - rain.camera) * (0.5 * rain.exposure), d);
    let half = part.xyz;
    // Both ends of the streak, then its width across the picture.
    let along = select(-1.0, 1.0, (corner & 2u) != 0u);
    let side = select(-1.0, 1.0, (corner & 1u) != 0u);
    let toward = drop.position / d;
    var out: RainVarying;
    out.position = vec4f(2.0, 2.0, 2.0, 1.0);
    out.range = d;
    out.across = side;
    let shows = drop.share > 0.0 && in_picture(drop.position - half, drop.position + half);
    if !shows || sheltered(drop.position + half, velocity, shows) {
        return out;
    }
    let pixel = max(rain.pixel_angle * d * LEAST_PIXELS, 1e-6);
    let streak = half - toward * dot(half, toward);
    let stretch = max(length(streak), 1e-6);
    let lengthwise = streak / stretch;
    let width = max(drop.diameter, pixel);
    let reach = stretch + 0.5 * max(drop.diameter, pixel);
    let end = drop.position + along * (half + lengthwise * (reach - stretch))
        + cross(toward, lengthwise) * (side * 0.5 * width);
    var clip = rain.clip * vec4f(end, 1.0);
    clip.y *= rain.y_sign;
    out.position = vec4f(clip.xy, 0.0, clip.w);
    // As much of the picture as the drop covers on the mean over the exposure: its disc, spread over the quad. The profile
    // across has the mean 2/3.
    let disc = 0.78539816 * drop.diameter * drop.diameter * drop.weight;
    let cover = min(1.5 * disc / (2.0 * reach * width), 1.0) * (drop.share * part.w);
    let clear = exp(-rain.extinction * d);
    out.light = vec4f(drop_light(drop.position, toward) * (cover * clear), cover * clear);
    return out;
}

fn streak(in: RainVarying, range: f32) -> vec4f {
    let soft = clamp((range - in.range) * 4.0 + 0.5, 0.0, 1.0);
    return in.light * ((1.0 - in.across * in.across) * soft);
}
