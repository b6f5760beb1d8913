// Lying snow on the surface that a pixel shows: where it covers the ground, and the light that it sends. How deep it
// lies is led on the CPU (src/snowpack); snow_cover of src/weather/surface.rs is `snow_level`'s twin.
//!include "common/guarded.wgsl"
//!include "ground/spot.wgsl"

// Colour of snow's albedo over that of its green: ice takes up a little red (Warren 1982).
const SNOW_COLOR: vec3f = vec3f(0.985, 1.0, 1.012);
// What water between its grains takes of the albedo.
const WET_SNOW: f32 = 0.15;
// How far light comes round the edge of a shadow within the snow, as a cosine.
const SNOW_WRAP: f32 = 0.12;
// Width of the edges of patches in units of the hollows' depth.
const SNOW_EDGE: f32 = 0.35;
// Albedo of the host's ground below which it is taken to lie in the lamp's shadow, for certain and not at all: nothing
// outdoors is so dark.
const SHADOWED: vec2f = vec2f(0.015, 0.05);
// Halvings of a cell of the rings' grid to the finest cells of glints, and the share of the cells that glint.
const FINEST_GLINT: f32 = 6.0;
const GLINT_SHARE: f32 = 0.02;

// Level in the hollows up to which snow of this depth covers level ground. The first patches lie in the deepest ones,
// where puddles do.
fn snow_level(depth: f32) -> f32 {
    return select(level_of(tanh(min(depth / 0.025, 10.0))), NO_LEVEL, depth <= 0.0);
}

// Share of a pixel under snow that fills the hollows from `level` down. `cosine`: of the slope.
fn snow_share(level: f32, pattern: vec2f, cosine: f32) -> f32 {
    // Snow lies up to its angle of repose, and thinly some way beyond.
    return covered_share(pattern, level, SNOW_EDGE) * smoothstep(0.6, 0.82, cosine);
}

// One size of glints: cells of the ground with a grain each, of which few mirror the lamp towards the eye.
fn glints_of(at: vec2f, level: f32, half_way: vec2f) -> f32 {
    let cells = exp2(level);
    let place = (at + vec2f(ground.place_u, ground.place_v)) / RING_CELL * cells;
    let low = floor(place);
    let cell = vec2u(vec2i(low)) + ground.cell * u32(cells);
    let chance = ring_chances(cell, u32(level) + 77u);
    // A grain's facet lies anyhow; as the eye moves on, others glint.
    let turned = fract(chance.x + 11.0 * dot(half_way, 2.0 * chance.yz - 1.0));
    let from_middle = length(place - low - 0.5);
    return select(0.0, 1.0, turned < GLINT_SHARE) * smoothstep(0.45, 0.1, from_middle) * chance.y;
}

// Glints of single grains, over the light of the whole: cells are as large as pixels are, so that they neither crawl
// nor flicker, and fade where a pixel holds many.
fn snow_glints(at: vec2f, side: f32, to_eye: vec3f) -> f32 {
    let wanted = clamp(log2(RING_CELL / max(2.0 * side, 1e-4)), 0.0, FINEST_GLINT);
    let low = floor(wanted);
    let middle = unit_or(to_eye + ground.to_lamp, to_eye).xy;
    let both = mix(glints_of(at, low, middle), glints_of(at, min(low + 1.0, FINEST_GLINT), middle), wanted - low);
    return both * (1.0 - smoothstep(0.005, 0.06, side));
}

// Light of snow towards the eye, cd/m^2. `seen`: the albedo that the host's colour would have in full light; `lamps`:
// illuminance by the host's lamps.
fn snow_light(snow: vec3f, normal: vec3f, up: vec3f, seen: vec3f, lamps: vec3f, glints: f32) -> vec3f {
    let cosine = dot(normal, ground.to_lamp);
    let lit = smoothstep(SHADOWED.x, SHADOWED.y, dot(seen, vec3f(0.2126, 0.7152, 0.0722)));
    let lamp = ground.lamp_lux * (max((cosine + SNOW_WRAP) / (1.0 + SNOW_WRAP), 0.0) * lit);
    let sky = ground.sky_lux * (0.5 + 0.5 * dot(normal, up));
    let albedo = SNOW_COLOR * (snow.z * (1.0 - WET_SNOW * snow.y));
    return albedo * (lamp * (1.0 + glints) + sky + lamps) / SKY_PI;
}

struct SnowSeen {
    light: vec3f,
    // Share of the pixel's surface that it covers.
    share: f32,
}

// `normal_given`: the host's image has the surface's normal.
fn snow_on(spot: Spot, normal_given: bool) -> SnowSeen {
    let here = spot.terrain;
    var snow = ground.snow.xyz;
    if TERRAIN && ground.snow.w >= 0.0 {
        let depth = ground.snow.w;
        // Where only one has snow, its properties count.
        let known = select(select(here.share, 1.0, depth <= 0.0), 0.0, here.snow.x <= 0.0);
        snow = vec3f(snow_level(mix(depth, here.snow.x, here.share)), mix(snow.yz, here.snow.zw, known));
    }
    // Far off a pixel's side along the ground is known too badly for patches: there they mix.
    let patches = mix(spot.pattern, vec2f(0.0, 1.0), smoothstep(150.0, 800.0, spot.range));
    let lies = snow_share(snow.x, patches, spot.level) * spot.ground.look.snow * spot.gets;
    let soft = normalize(mix(spot.ground.facing.normal, spot.up, select(0.35, 0.0, here.share > 0.5 || normal_given)));
    // Drifts and tracks lie over the ground that the host drew: what they rise by leans their light.
    var heaped = soft;
    if TERRAIN {
        heaped = unit_or(soft - here.drift * (here.share * lies), soft);
    }
    let glints = snow_glints(spot.place, spot.side, spot.to_eye) * (1.0 - snow.y);
    let white = snow_light(snow, heaped, spot.up, spot.ground.albedo, host_lamps(spot.at, heaped), glints);
    return SnowSeen(capped(white, ground.most), lies);
}
