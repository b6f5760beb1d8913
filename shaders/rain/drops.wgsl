// Drops without a state: the place of each drop is a function of (seed, id, time), and one quad draws its streak. The
// f64 reference is src/rain/lattice.rs, which has the derivation.
//!include "common/depth.wgsl"
//!include "surroundings/lights_binding.wgsl"
//!include "common/hash.wgsl"
//!include "common/streak.wgsl"
//!include "surroundings/shelter.wgsl"
//!include "rain/phase.wgsl"
//!include "rain/local.wgsl"

// Whether the rim of a rain area is near.
override AREAS: bool = false;

// Number of classes of diameter.
const CLASSES: u32 = 32u;

// Block of the drops.
struct RainUniform {
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
    // Number of drops in one shell.
    per_shell: u32,
    below: vec3f,
    seed: u32,
    // Irradiance of the sun or moon (`sun`), display units, and the unit vector towards it (`to_sun`).
    sun: vec3f,
    // Angle of a pixel, rad.
    pixel_angle: f32,
    to_sun: vec3f,
    // Extinction between the eye and a drop by everything except rain, 1/m.
    extinction: f32,
    // Number of drops that each drawn drop of the innermost shell stands for.
    weight: f32,
    // 1 where row 0 of the target is the picture's top, -1 where it is the bottom.
    y_sign: f32,
    // Number of drawn shells.
    shells: u32,
    // Contrast gain: factor by which rain stands out more than in nature; 1 is as in nature.
    gain: f32,
    // Velocity of the camera, (east, north, up), m/s.
    camera: vec3f,
    pad2: f32,
    // Per shell, in 2^-32 of the cell's side. x, y, z: place of the camera in the cell that moves with the air. w:
    // distance that a drop with a speed of one unit has fallen.
    cell: array<vec4u, SHELLS>,
    // Per shell, m. x: side of the cell. y and w: distances at which the shell begins to fade in and is drawn in full,
    // while the next smaller shell fades out. z: distance at which the shell begins to fade out.
    shell: array<vec4f, SHELLS>,
    // Per class. x: diameter, m. y: fall speed, SPEED_UNIT. z: number of drops in a shell of the classes up to this
    // one.
    classes: array<vec4f, CLASSES>,
}

// Number of shells of the lattice.
const SHELLS: u32 = 4u;
// Unit of fall speeds, m/s. Speeds are integer multiples of it, so a drop's fall phase is a product of integers and
// exact at any time.
const SPEED_UNIT: f32 = 0.015625;
// Drops nearer than this, m, fade out: they would be blobs on which no eye could focus.
const NEAREST: f32 = 0.25;

@group(0) @binding(0) var<uniform> rain: RainUniform;

// Drop of the lattice.
struct Drop {
    // Position relative to the camera, m.
    position: vec3f,
    // Diameter, m.
    diameter: f32,
    // Fall speed, m/s.
    speed: f32,
    // Share of the drop that its shell shows at its distance, 0 to 1.
    share: f32,
    // Number of drops that it stands for.
    weight: f32,
}

// Returns the class of drop `index` of a shell.
fn class_of(index: u32) -> u32 {
    var low = 0u;
    for (var step = CLASSES / 2u; step > 0u; step /= 2u) {
        low += select(0u, step, index >= u32(rain.classes[low + step - 1u].z));
    }
    return low;
}

// Properties shared by the drops of one class in one shell.
struct ClassInShell {
    // Shell.
    s: u32,
    // Class.
    k: u32,
    // Index of its first drop in the shell, and of the drop after its last.
    first: u32,
    end: u32,
    // Diameter, m.
    diameter: f32,
    // Fall speed, speed units.
    speed: u32,
    // Rows of `cell` and `shell` in `RainUniform` for the shell.
    cell: vec4u,
    shell: vec4f,
}

// Returns the properties of class `k` in shell `s`.
fn class_in_shell(s: u32, k: u32) -> ClassInShell {
    let size = rain.classes[k];
    let first = select(0u, u32(rain.classes[max(k, 1u) - 1u].z), k > 0u);
    return ClassInShell(s, k, first, u32(size.z), size.x, u32(size.y), rain.cell[s], rain.shell[s]);
}

// Returns drop `index` of its shell.
fn drop_of(in_shell: ClassInShell, index: u32) -> Drop {
    let place = random3(vec3u(rain.seed, (in_shell.s << 8u) | in_shell.k, index - in_shell.first));
    return drop_at(in_shell, index, place - vec3u(0u, 0u, in_shell.speed * in_shell.cell.w) - in_shell.cell.xyz);
}

// Returns drop `index` of its shell, whose position relative to the camera is `away_units`, in 2^-32 of the cell's
// side.
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

// Returns the radiance of a drop seen along `d`, without lamps: the image of most of the half space behind it, small
// and upside down, and the sunlight that passes through it.
fn day_light(d: vec3f) -> vec3f {
    return mix(rain.below, rain.above, sky_share(d.z)) + rain.sun * (drop_phase(dot(d, rain.to_sun)) * 0.07957747);
}

// Returns the radiance that lamps send through a drop at `p`.
fn lamp_light(p: vec3f, d: vec3f) -> vec3f {
    var beams = vec3f(0.0);
    for (var i = 0u; i < light_count(); i++) {
        let to = p - lights.lamps[i].position;
        let from_lamp = to * inverseSqrt(max(dot(to, to), 1e-6));
        beams += light_at(lights.lamps[i], to) * drop_phase(-dot(d, from_lamp));
    }
    return beams * 0.07957747;
}

// Returns the radiance of a drop at `p` seen along `d`.
fn drop_light(p: vec3f, d: vec3f) -> vec3f {
    return day_light(d) + lamp_light(p, d);
}

// Corner of a streak's quad.
struct RainVarying {
    @builtin(position) position: vec4f,
    // Premultiplied light.
    @location(0) light: vec4f,
    // Depth from depth_of.
    @location(1) depth: vec2f,
    // Position across the streak, -1 to 1, and along it from its middle, in radii of the drawn drop; distance that the
    // drop's middle moves to either side, in the same radii.
    @location(2) at: vec3f,
}

// Returns whether a line between two points, some pixels wide, can be in the picture.
fn in_picture(a: vec3f, b: vec3f) -> bool {
    let first = rain.clip * vec4f(a, 1.0);
    let last = rain.clip * vec4f(b, 1.0);
    let side = 0.05 + 1.02 * vec2f(first.w, last.w);
    let x = vec2f(first.x, last.x);
    let y = vec2f(first.y, last.y);
    return any(x < side) && any(-x < side) && any(y < side) && any(-y < side);
}

// Returns the result of `part_drawn` (common/streak.wgsl) for a drop with a `velocity`: half of its drawn path during
// the exposure, m, and the factor for its cover.
fn drop_part(drop: Drop, velocity: vec3f) -> vec4f {
    return part_drawn((velocity - rain.camera) * (0.5 * rain.exposure), max(length(drop.position), 1e-3));
}

// Returns whether a drop with a `velocity` can be in the picture if it is not sheltered.
fn may_show(drop: Drop, velocity: vec3f) -> bool {
    let half = drop_part(drop, velocity).xyz;
    return drop.share > 0.0 && in_picture(drop.position - half, drop.position + half);
}

// Streak that a drop draws.
struct Streak {
    // Middle of the streak, camera-relative, m.
    middle: vec3f,
    // Width, m; 0 if nothing is drawn.
    width: f32,
    // Vector from the middle to an end, m.
    half: vec3f,
    // Premultiplied light where the streak covers most.
    light: vec4f,
}

// Returns the cover c raised by the contrast gain g: 1 - (1 - c)^g.
fn gained(cover: f32) -> f32 {
    let most = min(cover, 1.0);
    return select(1.0 - pow(1.0 - most, rain.gain), most, rain.gain == 1.0);
}

// Returns the streak of a drop with a `velocity`; an empty one unless the drop `shows` and no shelter keeps it off.
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
    // Lowers the opacity of a drop that is drawn wider than it is, in proportion.
    let thin = drop.diameter / width;
    let most = thin * thin * drop.weight * longest_passing(reach_of(stretch, 0.5 * width));
    let cover = gained(most) * (drop.share * part.w);
    let clear = exp(-rain.extinction * d);
    let light = vec4f(drop_light(drop.position, toward) * (cover * clear), cover * clear);
    return Streak(drop.position, width, half, light);
}

// Returns a corner of a streak's quad: bit 1 of `corner` selects the end, bit 0 the side.
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

// Draws every drop of the lattice, on devices without compute shaders.
@vertex
fn rain_vertex(@builtin(vertex_index) corner: u32, @builtin(instance_index) instance: u32) -> RainVarying {
    let index = instance % rain.per_shell;
    let drop = drop_of(class_in_shell(instance / rain.per_shell, class_of(index)), index);
    let velocity = rain.wind - vec3f(0.0, 0.0, drop.speed);
    return corner_of(streak_of(drop, velocity, may_show(drop, velocity)), corner);
}

// Streak from the list, as vertex attributes.
struct Listed {
    @location(0) middle_width: vec4f,
    @location(1) half: vec3f,
    @location(2) light: vec4f,
}

// Draws the drops that were found to be in the picture (rain/cull.wgsl).
@vertex
fn listed_vertex(@builtin(vertex_index) corner: u32, listed: Listed) -> RainVarying {
    return corner_of(Streak(listed.middle_width.xyz, listed.middle_width.w, listed.half, listed.light), corner);
}

// Returns the premultiplied light of a pixel of a streak. `shown` is the depth of the host's picture.
fn streak(in: RainVarying, shown: f32) -> vec4f {
    return in.light * (passing(in.at.xy, in.at.z) * share_before(shown, in.depth));
}
