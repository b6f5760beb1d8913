// Splashes on what the host's picture shows: slots of a world-fixed grid in which drops land one after the other, as many
// as the flux brings. Which slot splashes when follows from (seed, cell, slot, time).
// The entry points read the depth: drops_single.wgsl and drops_multi.wgsl.
//!include "rain/drops.wgsl"

struct SplashUniform {
    // Cell of the grid under the camera, and the camera's place in it, m.
    cell: vec2i,
    place: vec2f,
    // Side of a cell, m; time that a splash lasts, s.
    side: f32,
    life: f32,
    // Slots of a cell; cells along one side of the square round the camera.
    slots: u32,
    cells: u32,
    // How many times `life` has passed, and the part since.
    tick: u32,
    part: f32,
    // Chance that a slot is taken.
    share: f32,
    // Diameter of the drops that splash, m, and their fall speed, m/s.
    diameter: f32,
    speed: f32,
    // Ground to start the search at, camera-relative, m.
    ground: f32,
    // Distance at which splashes have faded, m.
    reach: f32,
}

@group(0) @binding(3) var<uniform> splash: SplashUniform;

// Steps by which the place on the visible surface below a point is sought.
const SEARCH: u32 = 6u;

struct Landing {
    // Camera-relative east and north.
    xy: vec2f,
    // 0 to 1 while the splash stands.
    age: f32,
    // Share of it that is drawn at its distance; 0: there is none.
    fade: f32,
}

// What lands in a slot at this moment, before it is known where its ground is.
fn landing_of(instance: u32) -> Landing {
    let slot = instance % splash.slots;
    let index = instance / splash.slots;
    let cell = splash.cell + vec2i(i32(index % splash.cells), i32(index / splash.cells)) - i32(splash.cells / 2u);
    let key = bitcast<vec2u>(cell);
    // Each slot begins at a moment of its own.
    let phase = random3(vec3u(key.x, key.y, rain.seed ^ slot)).x;
    let time = splash.part + f32(phase >> 8u) / 16777216.0;
    let turn = splash.tick + select(0u, 1u, time >= 1.0);
    let chance = random3(vec3u(key.x ^ (turn * 0x9e3779b9u), key.y, rain.seed + 77u * slot));
    let value = vec3f(chance >> vec3u(8u)) / 16777216.0;
    let xy = (vec2f(cell - splash.cell) + value.xy) * splash.side - splash.place;
    let fade = 1.0 - smoothstep(0.6 * splash.reach, splash.reach, length(xy));
    var share = splash.share;
    if AREAS {
        share *= local_splashes(vec3f(xy, splash.ground));
    }
    return Landing(xy, fract(time), select(0.0, fade, value.z < share));
}

// Where in the picture a camera-relative point is: ndc, and 1 if it is in it.
fn seen_at(p: vec3f) -> vec3f {
    let clip = rain.clip * vec4f(p, 1.0);
    let ndc = clip.xy / clip.w;
    return vec3f(ndc, select(0.0, 1.0, clip.w > 0.0 && max(abs(ndc.x), abs(ndc.y)) < 1.0));
}

fn uv_of(ndc: vec2f) -> vec2f {
    return vec2f(ndc.x * 0.5 + 0.5, 0.5 - 0.5 * ndc.y * rain.y_sign);
}

// The point of the visible surface at `ndc`, camera-relative.
fn surface_of(ndc: vec2f, depth: f32) -> vec3f {
    let ray = view_ray(rain.depth, ndc);
    return ray.origin + ray.direction * min(view_range(rain.depth, depth, ndc), 1e5);
}

// Whether the search ended above the landing's own place: it does where the picture shows the ground there.
fn is_found(landing: Landing, surface: vec3f) -> bool {
    return length(surface.xy - landing.xy) < 0.03 + 0.01 * length(surface);
}

// As far above a surface as its depth may be wrong.
fn above_ground(at: vec3f) -> vec3f {
    return at + vec3f(0.0, 0.0, 0.02 + 0.004 * length(at));
}

// What a splash draws.
struct Crown {
    // Its foot, camera-relative, m.
    at: vec3f,
    // Half of its width, m; 0: nothing is drawn.
    width: f32,
    // Premultiplied.
    light: vec4f,
    // m.
    height: f32,
}

// The crown that stands at a landing, at height `z`: it rises, opens and falls (sizes in drop diameters after Yarin 2006, Drop
// Impact Dynamics).
fn crown_of(landing: Landing, z: f32) -> Crown {
    let at = vec3f(landing.xy, z);
    if sheltered(above_ground(at), rain.wind - vec3f(0.0, 0.0, splash.speed), true) {
        return Crown();
    }
    let age = landing.age;
    let d = length(at);
    let full = vec2f(2.0 + 5.0 * age, 20.0 * age * (1.0 - age) + 0.5) * splash.diameter;
    let size = max(full, vec2f(rain.pixel_angle * d * LEAST_PIXELS));
    // The water of the crown is a thin sheet and droplets: a third of what the quad covers.
    let cover = 0.35 * landing.fade * (1.0 - age * age) * (full.x * full.y) / (size.x * size.y) * exp(-rain.extinction * d);
    return Crown(at, size.x, vec4f(drop_light(at, at / d) * cover, cover), size.y);
}

fn crown_corner(crown: Crown, corner: u32) -> RainVarying {
    let d = max(length(crown.at), 1e-3);
    let side = select(-1.0, 1.0, (corner & 1u) != 0u);
    let top = select(0.0, 1.0, (corner & 2u) != 0u);
    let across = normalize(cross(crown.at / d, vec3f(0.0, 0.0, 1.0)) + vec3f(1e-6, 0.0, 0.0));
    let place = crown.at + across * (side * crown.width) + vec3f(0.0, 0.0, top * crown.height);
    var clip = rain.clip * vec4f(place, 1.0);
    clip.y *= rain.y_sign;
    let position = select(vec4f(2.0, 2.0, 2.0, 1.0), vec4f(clip.xy, 0.0, clip.w), crown.width > 0.0);
    return RainVarying(position, crown.light, d - 0.2, side);
}

struct ListedCrown {
    @location(0) at_width: vec4f,
    @location(1) light: vec4f,
    @location(2) height: f32,
}

// Crowns that were made before (rain/crowns_single.wgsl and crowns_multi.wgsl).
@vertex
fn crown_vertex(@builtin(vertex_index) corner: u32, listed: ListedCrown) -> RainVarying {
    return crown_corner(Crown(listed.at_width.xyz, listed.at_width.w, listed.light, listed.height), corner);
}
