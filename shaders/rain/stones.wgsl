// Stones of ice (hail and ice pellets), falling in a lattice like the drops' and hopping where they land. The place of
// each stone is a function of (seed, id, time). src/rain/stones.rs has their numbers. The entry points read the depth:
// stones_view.wgsl.
//!include "common/guarded.wgsl"
//!include "rain/splash.wgsl"

// Number of classes of pellets and of hail together.
const STONE_CLASSES: u32 = 16u;

// Number of shells of the stones' lattice.
const STONE_SHELLS: u32 = 4u;

// Block of the stones.
struct StoneUniform {
    // Lattice of the stones, per shell, in 2^-32 of the cell's side. x, y, z: place of the camera in the cell that
    // moves with the air. w: distance that a stone with a speed of one unit has fallen.
    air: array<vec4u, STONE_SHELLS>,
    // Per shell, m. x: side of the cell. y: distance at which the shell begins to fade in. z: distance at which the
    // shell begins to fade out.
    shells: array<vec4f, STONE_SHELLS>,
    // Index of the first stone of each shell.
    first: vec4u,
    // Per class and shell: number of stones of the classes up to this one.
    upto: array<vec4u, STONE_CLASSES>,
    // Per class. x: diameter, m. y: fall speed, SPEED_UNIT. z: share of the landings of the classes up to this one. w:
    // 1 for clear ice, else 0.
    classes: array<vec4f, STONE_CLASSES>,
    // Per class and shell: number of stones that each drawn stone stands for.
    weight: array<vec4f, STONE_CLASSES>,
    // Grid of landings: the cell under the camera (`cell`), and the camera's place in it, m (`place`).
    cell: vec2i,
    place: vec2f,
    // Side of a cell, m; time for which a landed stone is drawn, s (`life`).
    side: f32,
    life: f32,
    // Number of slots in a cell; number of cells along one side of the square around the camera (`cells`).
    slots: u32,
    cells: u32,
    // Time since time 0 in units of `life`: its whole part (`tick`) and its fraction (`part`).
    tick: u32,
    part: f32,
    // Chance that a slot is taken.
    share: f32,
    // Height at which the search for the ground starts, relative to the camera, m.
    ground: f32,
    // Distance at which landed stones have faded out, m.
    reach: f32,
    // Gravity, m/s^2.
    gravity: f32,
}

@group(1) @binding(0) var<uniform> stones: StoneUniform;

// Albedo of milky ice.
const ICE_ALBEDO: f32 = 0.75;
// Smallest and largest share of its speed that a stone keeps at its first bounce. The shares are low because ice cracks
// when it hits the ground at its fall speed.
const FIRST_REBOUND: vec2f = vec2f(0.1, 0.32);
// Share of its speed that a stone keeps at each further bounce.
const REBOUND: f32 = 0.45;
// Number of bounces that are drawn.
const HOPS: u32 = 3u;

// Stone in the air or on the ground.
struct Stone {
    // Position relative to the camera, m.
    position: vec3f,
    // Velocity, (east, north, up), m/s.
    velocity: vec3f,
    // Diameter, m.
    diameter: f32,
    // 1 for clear ice, 0 for milky ice.
    clear: f32,
    // Share of the stone that is drawn, and number of stones that it stands for.
    share: f32,
    weight: f32,
}

// Returns stone `instance` of the lattice.
fn falling_stone(instance: u32) -> Stone {
    let f = stones.first;
    let s = u32(instance >= f.y) + u32(instance >= f.z) + u32(instance >= f.w);
    let index = instance - f[s];
    var k = 0u;
    for (var i = 0u; i + 1u < STONE_CLASSES; i++) {
        k += select(0u, 1u, index >= stones.upto[i][s]);
    }
    let before = select(0u, stones.upto[max(k, 1u) - 1u][s], k > 0u);
    let class_row = stones.classes[k];
    // Numbers the classes of stones after those of drops.
    let place = random3(vec3u(rain.seed, (s << 8u) | (CLASSES + k), index - before));
    let fallen = u32(class_row.y) * stones.air[s].w;
    let away = bitcast<vec3i>(place - vec3u(0u, 0u, fallen) - stones.air[s].xyz);
    let shell = stones.shells[s];
    let p = vec3f(away) * (shell.x / 4294967296.0);
    let d = length(p);
    let outer = 1.0 - smoothstep(shell.z, 0.5 * shell.x, d);
    let inner = select(smoothstep(shell.y, 0.25 * shell.x, d), smoothstep(0.5 * NEAREST, NEAREST, d), s == 0u);
    let velocity = rain.wind - vec3f(0.0, 0.0, class_row.y * SPEED_UNIT);
    return Stone(p, velocity, class_row.x, class_row.w, inner * outer, stones.weight[k][s]);
}

// Stone that lands.
struct Touch {
    // Place and age of the landing.
    landing: Landing,
    // Three random numbers of the landing, 0 to 1.
    chance: vec3f,
    // Row of `classes` for the stone.
    kind: vec4f,
}

// Returns the stone that landed in a slot, before the height of the ground is known.
fn touch_of(instance: u32) -> Touch {
    let slot = instance % stones.slots;
    let index = instance / stones.slots;
    let cell = stones.cell + vec2i(i32(index % stones.cells), i32(index / stones.cells)) - i32(stones.cells / 2u);
    let key = bitcast<vec2u>(cell);
    // Each slot has its own phase.
    let phase = random3(vec3u(key.x, key.y, rain.seed + 0x51ed270bu + slot)).x;
    let time = stones.part + f32(phase >> 8u) / 16777216.0;
    let turn = stones.tick + select(0u, 1u, time >= 1.0);
    let turned = vec3u(key.x ^ (turn * 0x9e3779b9u), key.y, rain.seed + 0x51ed270bu + 77u * slot);
    let value = vec3f(random3(turned) >> vec3u(8u)) / 16777216.0;
    let more = random3(turned + 1u);
    let size = f32(random3(turned + 2u).x >> 8u) / 16777216.0;
    var k = 0u;
    for (var i = 0u; i + 1u < STONE_CLASSES; i++) {
        k += select(0u, 1u, size >= stones.classes[i].z);
    }
    let xy = (vec2f(cell - stones.cell) + value.xy) * stones.side - stones.place;
    let fade = 1.0 - smoothstep(0.6 * stones.reach, stones.reach, length(xy));
    let landing = Landing(xy, fract(time), select(0.0, fade, value.z < stones.share));
    return Touch(landing, vec3f(more >> vec3u(8u)) / 16777216.0, stones.classes[k]);
}

// Returns the stone of a landing at its present place, on ground at the height `z`: it hops in parabolas, each lower
// than the one before, and then lies still.
fn hopping_stone(touch: Touch, z: f32) -> Stone {
    let kind = touch.kind;
    let fall = kind.y * SPEED_UNIT;
    let angle = 6.2831853 * touch.chance.y;
    var up = fall * mix(FIRST_REBOUND.x, FIRST_REBOUND.y, touch.chance.x);
    var level = 0.25 * rain.wind.xy + vec2f(cos(angle), sin(angle)) * (up * touch.chance.z);
    var t = touch.landing.age * stones.life;
    var at = touch.landing.xy;
    var flight = vec4f(0.0);
    for (var i = 0u; i < HOPS; i++) {
        let lasts = 2.0 * up / stones.gravity;
        let now = clamp(t, 0.0, lasts);
        at += level * now;
        flight = select(flight, vec4f(level, up - stones.gravity * now, now * (up - 0.5 * stones.gravity * now)), t >= 0.0);
        flight = select(flight, vec4f(0.0), t > lasts);
        t -= lasts;
        up *= REBOUND;
        level *= 0.6;
    }
    let p = vec3f(at, z + flight.w + 0.5 * kind.x);
    let fade = touch.landing.fade * (1.0 - smoothstep(0.85, 1.0, touch.landing.age));
    return Stone(p, flight.xyz, kind.x, kind.w, fade, 1.0);
}

// Returns the mean radiance over the disc of a matt sphere, relative to a matt plane that faces the light. `c` is the
// cosine of the angle between the light and the eye, seen from the sphere (Russell 1916).
fn sphere_phase(c: f32) -> f32 {
    let angle = acos(clamp(c, -1.0, 1.0));
    return (sin(angle) + (3.14159265 - angle) * c) * 0.21220659;
}

// Returns the radiance of a stone at `p` seen along `d`. Milky ice is matt and lit from the viewer's side; clear ice
// shows the scene behind it.
fn stone_light(p: vec3f, d: vec3f, clear: f32) -> vec3f {
    var beams = rain.sun * sphere_phase(-dot(d, rain.to_sun));
    for (var i = 0u; i < light_count(); i++) {
        let to = p - lights.lamps[i].position;
        let from_lamp = to * inverseSqrt(max(dot(to, to), 1e-6));
        beams += light_at(lights.lamps[i], to) * sphere_phase(dot(d, from_lamp));
    }
    let around = mix(rain.above, rain.below, 0.5 + 0.5 * d.z);
    let matt = ICE_ALBEDO * (around + beams * 0.31830989);
    return mix(matt, drop_light(p, d), 0.5 * clear);
}

// Corner of a stone's quad.
struct StoneVarying {
    @builtin(position) position: vec4f,
    @location(0) light: vec3f,
    // Opacity where the stone covers most.
    @location(1) cover: f32,
    // Depth from depth_of, and transmittance between the stone and the eye.
    @location(2) depth_clear: vec3f,
    // Position in the quad, across and along, in radii of the drawn stone.
    @location(3) at: vec2f,
    // Distance that the stone's middle moves to either side during the exposure, in radii.
    @location(4) reach: f32,
}

// Returns a corner outside the picture, for stones that are not drawn.
fn no_stone() -> StoneVarying {
    return StoneVarying(vec4f(2.0, 2.0, 2.0, 1.0), vec3f(0.0), 0.0, vec3f(0.0), vec2f(0.0), 0.0);
}

// Returns a corner of the quad that the stone covers during the exposure.
fn stone_corner(stone: Stone, corner: u32) -> StoneVarying {
    let d = max(length(stone.position), 1e-3);
    let toward = stone.position / d;
    let part = part_drawn((stone.velocity - rain.camera) * (0.5 * rain.exposure), d);
    let half = part.xyz;
    var out = no_stone();
    if stone.share <= 0.0 {
        return out;
    }
    let pixel = max(rain.pixel_angle * d * LEAST_PIXELS, 1e-6);
    let level = unit_or(cross(toward, vec3f(0.0, 0.0, 1.0)) + vec3f(1e-6, 0.0, 0.0), vec3f(1.0, 0.0, 0.0));
    let across_view = half - toward * dot(half, toward);
    let stretch = length(across_view);
    let lengthwise = select(cross(level, toward), across_view / max(stretch, 1e-9), stretch > 1e-6);
    let radius = 0.5 * max(stone.diameter, pixel);
    let side = select(-1.0, 1.0, (corner & 1u) != 0u);
    let end = select(-1.0, 1.0, (corner & 2u) != 0u);
    let p = stone.position + half * end + lengthwise * (end * radius) + cross(toward, lengthwise) * (side * radius);
    var clip = rain.clip * vec4f(p, 1.0);
    clip.y *= rain.y_sign;
    out.position = vec4f(clip.xy, 0.0, clip.w);
    let depth = depth_of(rain.depth, (rain.clip * vec4f(stone.position, 1.0)).w, d, stone.diameter);
    out.depth_clear = vec3f(depth, exp(-rain.extinction * d));
    out.reach = reach_of(stretch, radius);
    out.at = vec2f(side, end * (out.reach + 1.0));
    let thin = 0.5 * stone.diameter / radius;
    out.cover = gained(thin * thin * stone.weight * longest_passing(out.reach)) * (stone.share * part.w);
    out.light = stone_light(stone.position, toward, stone.clear);
    return out;
}

// Returns a corner of a falling stone's quad.
@vertex
fn falling_vertex(@builtin(vertex_index) corner: u32, @builtin(instance_index) instance: u32) -> StoneVarying {
    let stone = falling_stone(instance);
    if sheltered(stone.position, stone.velocity, true) {
        return no_stone();
    }
    return stone_corner(stone, corner);
}

// Returns a corner of the quad of a stone that hops on `surface`, whose w is 1 if the surface was found.
fn hopping_corner(touch: Touch, surface: vec4f, corner: u32) -> StoneVarying {
    let fall = rain.wind - vec3f(0.0, 0.0, touch.kind.y * SPEED_UNIT);
    if surface.w == 0.0 || sheltered(above_ground(vec3f(touch.landing.xy, surface.z)), fall, true) {
        return no_stone();
    }
    return stone_corner(hopping_stone(touch, surface.z), corner);
}

// Returns the premultiplied light of a pixel of a stone.
fn stone_color(in: StoneVarying, shown: f32) -> vec4f {
    let soft = share_before(shown, in.depth_clear.xy);
    let cover = min(in.cover * passing(in.at, in.reach), 1.0) * soft * in.depth_clear.z;
    return vec4f(in.light * cover, cover);
}
