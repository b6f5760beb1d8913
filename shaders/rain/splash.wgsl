// Splashes on the surfaces in the host's picture. They are in slots of a grid that is fixed to the world. Drops land in
// each slot one after another, as many as the flux brings. Slot and time of each splash follow from (seed, cell, slot,
// time). The entry points read the depth: drops_view.wgsl.
//!include "common/facing.wgsl"
//!include "common/guarded.wgsl"
//!include "rain/drops.wgsl"

// Number of groups of splashing drops; all groups have the same number of drops, and each group is drawn with its mean
// size.
const SIZES: u32 = 8u;

// Block of the splashes.
struct SplashUniform {
    // Cell of the grid under the camera, and the camera's place in it, m.
    cell: vec2i,
    place: vec2f,
    // Side of a cell, m; lifetime of a splash, s.
    side: f32,
    life: f32,
    // Number of slots in a cell; number of cells along one side of the square around the camera.
    slots: u32,
    cells: u32,
    // Time since time 0 in units of `life`: its whole part (`tick`) and its fraction (`part`).
    tick: u32,
    part: f32,
    // Chance that a slot is taken on level ground.
    share: f32,
    // Height at which the search for the ground starts, relative to the camera, m.
    ground: f32,
    // Distance at which splashes have faded out, m.
    reach: f32,
    // Rounding error of the host's depth: absolute, and relative to the value.
    depth_grain: vec2f,
    // Per group: diameter, m, and fall speed, m/s.
    sizes: array<vec4f, SIZES>,
}

@group(0) @binding(3) var<uniform> splash: SplashUniform;

// Largest number of reads of the depth in a search for the visible surface below a point.
const LOOKS: u32 = 8u;
// Steepest surface on which a splash is drawn, as the upward component of its normal.
const STEEPEST: f32 = 0.3;

// Place and age of a splash.
struct Landing {
    // Camera-relative east and north, m.
    xy: vec2f,
    // Age, from 0 to 1 over the splash's lifetime.
    age: f32,
    // Share of the splash that is drawn at its distance, 0 to 1; 0 if there is no splash.
    fade: f32,
}

// Drop that lands.
struct Arrival {
    landing: Landing,
    // Acceptance threshold: the drop lands if the ground gets at least this multiple of the flux on level ground.
    chance: f32,
    // Diameter of the drop, m.
    diameter: f32,
    // Fall speed of the drop, m/s.
    speed: f32,
    // Index of the slot among all around the camera.
    slot: u32,
}

// Returns the drop that lands in a slot at this time, before the height of the ground is known.
fn arrival_of(instance: u32) -> Arrival {
    let slot = instance % splash.slots;
    let index = instance / splash.slots;
    let cell = splash.cell + vec2i(i32(index % splash.cells), i32(index / splash.cells)) - i32(splash.cells / 2u);
    let key = bitcast<vec2u>(cell);
    // Each slot has its own phase.
    let phase = random3(vec3u(key.x, key.y, rain.seed ^ slot)).x;
    let time = splash.part + f32(phase >> 8u) / 16777216.0;
    let turn = splash.tick + select(0u, 1u, time >= 1.0);
    let chance = random3(vec3u(key.x ^ (turn * 0x9e3779b9u), key.y, rain.seed + 77u * slot));
    let value = vec3f(chance >> vec3u(8u)) / 16777216.0;
    let xy = (vec2f(cell - splash.cell) + value.xy) * splash.side - splash.place;
    let size = splash.sizes[chance.x % SIZES];
    let fade = 1.0 - smoothstep(0.6 * splash.reach, splash.reach, length(xy));
    var share = splash.share;
    if AREAS {
        share *= local_splashes(vec3f(xy, splash.ground));
    }
    // Slopes that face the wind get more drops than level ground. The bound `most` is that of a slope of 45 degrees.
    let most = 1.0 + length(rain.wind.xy) / size.y;
    let landing = Landing(xy, fract(time), select(0.0, fade, value.z < share * most));
    return Arrival(landing, value.z / max(share, 1e-9), size.x, size.y, instance);
}

// Returns the position of a camera-relative point in the picture, ndc, and 1 if it is inside the picture.
fn seen_at(p: vec3f) -> vec3f {
    let clip = rain.clip * vec4f(p, 1.0);
    let ndc = clip.xy / clip.w;
    return vec3f(ndc, select(0.0, 1.0, clip.w > 0.0 && max(abs(ndc.x), abs(ndc.y)) < 1.0));
}

// Returns the texture coordinates of a place in the picture given in ndc.
fn uv_of(ndc: vec2f) -> vec2f {
    return vec2f(ndc.x * 0.5 + 0.5, 0.5 - 0.5 * ndc.y * rain.y_sign);
}

// Returns the point of the visible surface at `ndc`, camera-relative.
fn surface_of(ndc: vec2f, depth: f32) -> vec3f {
    return view_point(rain.depth, min(view_depth(rain.depth, depth, ndc), 1e5), ndc);
}

// Returns whether the visible surface is at the landing's own place. The search then ends: the picture shows the ground
// there.
fn is_found(landing: Landing, surface: vec3f) -> bool {
    return length(surface.xy - landing.xy) < 0.03 + 0.01 * length(surface);
}

// Search for the height at which the vertical line through a landing meets the visible surface.
struct Search {
    // Height of the next read, m.
    z: f32,
    // Bounds of the height, m.
    low: f32,
    high: f32,
    // Height of the previous read, m, and the gap there (`gap_of`).
    before: vec2f,
    // Gaps at `low` and `high`; 0 where none has been computed.
    ends: vec2f,
}

// Starts a search at the height `z`, bounded to the part of the vertical line inside the picture. If `low` is above
// `high`, there is nothing to search.
fn search_from(landing: Landing, z: f32) -> Search {
    let foot = rain.clip * vec4f(landing.xy, 0.0, 1.0);
    let up = rain.clip * vec4f(0.0, 0.0, 1.0, 0.0);
    // A point at the height z on the line is in the picture if at + rise z is above 0 for all four edges.
    let at = vec4f(foot.w - foot.x, foot.w + foot.x, foot.w - foot.y, foot.w + foot.y);
    let rise = vec4f(up.w - up.x, up.w + up.x, up.w - up.y, up.w + up.y);
    let some = select(rise, vec4f(1e-7), abs(rise) < vec4f(1e-7));
    let edge = -at / some;
    let lows = select(vec4f(-1e4), edge, some > vec4f(0.0));
    let highs = select(vec4f(1e4), edge, some < vec4f(0.0));
    let low = max(max(lows.x, lows.y), max(lows.z, lows.w)) + 1e-3;
    let high = min(min(highs.x, highs.y), min(highs.z, highs.w)) - 1e-3;
    let begin = clamp(z, low, max(low, high));
    // The first step assumes a level plane at the depth `eye` below the camera. Its gap is -1 at the camera's height
    // and 0 at the plane.
    let eye = clamp(-splash.ground, 0.5, 10.0);
    return Search(begin, low, select(-1e9, high, landing.fade > 0.0), vec2f(begin + eye, 1e9), vec2f(0.0));
}

// Returns the gap of a point: how far it lies beyond the visible surface on its ray, relative to the range of the
// surface. Along a vertical line in front of a plane, the gap is linear in the point's height, whatever the plane's
// slope.
fn gap_of(p: vec3f, ndc: vec2f, surface: vec3f) -> f32 {
    let ray = view_ray(rain.depth, ndc);
    return dot(p - ray.origin, ray.direction) / max(dot(surface - ray.origin, ray.direction), 1e-3) - 1.0;
}

// Returns the search after the gap at its height is known. While the surface lies to one side of all reads, the search
// steps by secants, or by halving where a secant leaves the picture. Once two reads enclose the surface, the search
// uses false position between them, as in Dowell and Jarratt 1971 (Illinois), who halve the gap of an end that stays.
// In front of a wall, where the gap does not change, the search halves the interval.
fn closer(search: Search, gap: f32) -> Search {
    let under = gap > 0.0;
    let low = select(search.low, search.z, under);
    let high = select(search.z, search.high, under);
    let stays = select(1.0, 0.5, under == (search.before.y > 0.0));
    let ends = select(vec2f(search.ends.x * stays, gap), vec2f(gap, search.ends.y * stays), under);
    let first = search.before.y > 1e8;
    let fall = select(search.before.y, gap - 1.0, first) - gap;
    let beyond = search.z - gap * (search.before.x - search.z) / select(fall, -1e-9, abs(fall) < 1e-9);
    let between = (low * ends.y - high * ends.x) / min(ends.y - ends.x, -1e-9);
    let z = select(beyond, between, ends.x * ends.y < 0.0);
    let flat = under && abs(gap - search.ends.x) < 0.1 * gap;
    return Search(select(0.5 * (low + high), z, z > low && z < high && !flat), low, high, vec2f(search.z, gap), ends);
}

// Search for the ground below a landing.
struct Look {
    search: Search,
    // Visible surface at the last read, camera-relative, m; w is 1 if it is at the landing's own place.
    surface: vec4f,
}

// Returns whether another read is needed.
fn is_wanted(look: Look) -> bool {
    return look.surface.w == 0.0 && look.search.low < look.search.high;
}

// Returns the place in the picture of the next read, ndc.
fn next_look(look: Look, landing: Landing) -> vec2f {
    return seen_at(vec3f(landing.xy, look.search.z)).xy;
}

// Returns the search for the ground after the depth at `ndc` has been read.
fn looked(look: Look, landing: Landing, ndc: vec2f, depth: f32) -> Look {
    let seen = surface_of(ndc, depth);
    let gap = gap_of(vec3f(landing.xy, look.search.z), ndc, seen);
    return Look(closer(look.search, gap), vec4f(seen, select(0.0, 1.0, is_found(landing, seen))));
}

// Returns the centre of the pixel that shows a point.
fn pixel_of(p: vec3f, size: vec2f) -> vec2f {
    return (floor(uv_of(seen_at(p).xy) * size) + 0.5) / size;
}

// Returns the ndc of texture coordinates.
fn ndc_of(uv: vec2f) -> vec2f {
    return vec2f(uv.x * 2.0 - 1.0, (1.0 - uv.y * 2.0) * rain.y_sign);
}

// Returns the normal of the surface in a pixel, and the height of its plane at the place of a landing. `around` has the
// depths to the left, right, above and below.
fn plane_of(landing: Landing, uv: vec2f, size: vec2f, depth: f32, around: vec4f) -> vec4f {
    let ndc = ndc_of(uv);
    let facing = facing_of(rain.depth, depth, around, ndc, vec2f(2.0, -2.0 * rain.y_sign) / size, splash.depth_grain);
    let normal = unit_or(mix(vec3f(0.0, 0.0, 1.0), facing.normal, facing.sure) + vec3f(0.0, 0.0, 1e-6), vec3f(0.0, 0.0, 1.0));
    let middle = surface_of(ndc, depth);
    let rise = dot(normal.xy, middle.xy - landing.xy) / max(normal.z, STEEPEST);
    return vec4f(normal, middle.z + rise);
}

// Raises a point above a surface by the possible error of the surface's depth.
fn above_ground(at: vec3f) -> vec3f {
    return at + vec3f(0.0, 0.0, 0.02 + 0.004 * length(at));
}

// Crown that a splash draws.
struct Crown {
    // Foot of the crown, camera-relative, m.
    at: vec3f,
    // Half of its width, m; 0 if nothing is drawn.
    width: f32,
    // Premultiplied light.
    light: vec4f,
    // East and north components of the normal along which the crown stands.
    lean: vec2f,
    // Drawn height, m.
    height: f32,
    // Age, 0 to 1.
    age: f32,
    // Index of the slot among all around the camera.
    slot: u32,
}

// Returns the number of drops of a `velocity` that land on a surface with a `normal`, relative to level ground of the
// same horizontal extent.
fn landing_share(normal: vec3f, velocity: vec3f) -> f32 {
    return max(-dot(velocity, normal), 0.0) / max(-velocity.z * normal.z, 1e-6);
}

// Returns the crown on a surface with a `normal` at the height `z`: it rises, opens and falls. Its size in drop
// diameters is that of Yarin (2006, Drop Impact Dynamics).
fn crown_of(arrival: Arrival, z: f32, normal: vec3f) -> Crown {
    let landing = arrival.landing;
    let at = vec3f(landing.xy, z);
    let velocity = rain.wind - vec3f(0.0, 0.0, arrival.speed);
    let lands = normal.z > STEEPEST && arrival.chance < landing_share(normal, velocity);
    if !lands || sheltered(above_ground(at), velocity, lands) {
        return Crown();
    }
    let age = landing.age;
    let d = max(length(at), 1e-3);
    let along = abs(dot(at, normal)) / d;
    let full = vec2f(2.0 + 5.0 * age, 20.0 * age * (1.0 - age) + 0.5) * arrival.diameter;
    // Computes the drawn size: seen from the side the crown is a wall, from above a ring.
    let shown = vec2f(full.x, full.y * sqrt(max(1.0 - along * along, 0.0)) + full.x * along);
    let size = max(shown, vec2f(rain.pixel_angle * d * LEAST_PIXELS));
    // The water of the crown is a thin sheet with droplets: it covers a third of the quad.
    let thin = (shown.x * shown.y) / (size.x * size.y) * exp(-rain.extinction * d);
    let cover = gained(0.35 * thin) * (landing.fade * (1.0 - age * age));
    return Crown(at, size.x, vec4f(drop_light(at, at / d) * cover, cover), normal.xy, size.y, age, arrival.slot);
}

// Corner of a crown's quad.
struct CrownVarying {
    @builtin(position) position: vec4f,
    // Premultiplied light.
    @location(0) light: vec4f,
    // Depth from depth_of, and age.
    @location(1) depth_age: vec3f,
    // Position across, -1 to 1, and from the foot to the top, 0 to 1.
    @location(2) at: vec2f,
    // Random numbers of the crown, 0 to 1.
    @location(3) @interpolate(flat) chance: vec2f,
}

// Returns a corner of a crown's quad: bit 1 of `corner` selects the top, bit 0 the side.
fn crown_corner(crown: Crown, corner: u32) -> CrownVarying {
    let d = max(length(crown.at), 1e-3);
    let toward = crown.at / d;
    let side = select(-1.0, 1.0, (corner & 1u) != 0u);
    let top = select(0.0, 1.0, (corner & 2u) != 0u);
    let normal = vec3f(crown.lean, sqrt(max(1.0 - dot(crown.lean, crown.lean), 0.0)));
    let across = unit_or(cross(toward, normal) + vec3f(1e-6, 0.0, 0.0), vec3f(1.0, 0.0, 0.0));
    // The quad extends upwards in the picture from the foot, because the ground below it may be dry.
    let tall = cross(across, toward);
    let place = crown.at + across * (side * crown.width) + tall * (top * crown.height);
    var clip = rain.clip * vec4f(place, 1.0);
    clip.y *= rain.y_sign;
    let position = select(vec4f(2.0, 2.0, 2.0, 1.0), vec4f(clip.xy, 0.0, clip.w), crown.width > 0.0);
    let chance = vec2f(random3(vec3u(crown.slot, rain.seed, 5u)).xy >> vec2u(8u)) / 16777216.0;
    // Takes a depth slightly nearer than that of the crown's foot, which stands on the visible surface.
    let depth = depth_of(rain.depth, (rain.clip * vec4f(crown.at, 1.0)).w, d, 0.2);
    return CrownVarying(position, crown.light, vec3f(depth, crown.age), vec2f(side, top), chance);
}

// Number of droplets of a crown.
const DROPLETS: u32 = 3u;

// Returns the opacity of a crown relative to the mean of its quad: a sheet that opens upwards and looks thicker at its
// sides, and droplets that leave its rim on parabolas.
fn crown_profile(at: vec2f, age: f32, chance: vec2f) -> f32 {
    let y = at.y / 0.6;
    let x = at.x / (0.5 + 0.4 * min(y, 1.0));
    let sheet = (0.7 + 0.9 * x * x) * (1.0 - smoothstep(0.7, 1.0, abs(x))) * (1.0 - smoothstep(0.75, 1.0, y));
    var drops = 0.0;
    for (var i = 0u; i < DROPLETS; i++) {
        // Droplets leave the rim one after another, in all directions.
        let turn = 6.2831853 * (chance.x + f32(i) * 0.381966);
        let t = max(age - 0.1 - 0.15 * fract(chance.y + f32(i) * 0.618034), 0.0);
        let foot = vec2f(cos(turn) * (0.6 + 0.35 * t), 0.55 + 1.5 * t - 2.4 * t * t);
        let off = (at - foot) / vec2f(0.16, 0.12);
        drops += max(1.0 - dot(off, off), 0.0) * select(0.0, 1.0, t > 0.0);
    }
    return 1.85 * (sheet + 2.0 * drops);
}

// Returns the premultiplied light of a pixel of a crown. `shown` is the depth of the host's picture; `pixel` is the
// height of a pixel relative to that of the quad. A crown of only a few pixels has no shape, only its mean.
fn crown_color(in: CrownVarying, shown: f32, pixel: f32) -> vec4f {
    let soft = share_before(shown, in.depth_age.xy);
    let shape = min(crown_profile(in.at, in.depth_age.z, in.chance), 3.0);
    let profile = mix(shape, 1.0 - in.at.x * in.at.x, smoothstep(0.15, 0.4, pixel));
    // The opacity is at most 1 where the crown is thick.
    return in.light * min(profile * soft, 1.0 / max(in.light.a, 1e-6));
}

// Crown from the list, as vertex attributes.
struct ListedCrown {
    @location(0) at_width: vec4f,
    @location(1) light: vec4f,
    @location(2) lean_height_age: vec4f,
    @location(3) slot: u32,
}

// Draws the crowns that may be in the picture (rain/crowns.wgsl, crowns_view.wgsl).
@vertex
fn crown_vertex(@builtin(vertex_index) corner: u32, listed: ListedCrown) -> CrownVarying {
    let more = listed.lean_height_age;
    let at = listed.at_width;
    return crown_corner(Crown(at.xyz, at.w, listed.light, more.xy, more.z, more.w, listed.slot), corner);
}
