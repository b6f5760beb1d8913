// Lying snow on the surface that a pixel shows: the share of the pixel that it covers, and its light. The depth of snow
// is simulated on the CPU (src/snowpack). `snow_level` has the formula of `snow_cover` in src/weather/surface.rs.
//!include "common/guarded.wgsl"
//!include "ground/spot.wgsl"

// Albedo of snow relative to that in green: ice absorbs a little red (Warren 1982).
const SNOW_COLOR: vec3f = vec3f(0.985, 1.0, 1.012);
// Share of the albedo that snow loses if it holds all the liquid water that it can.
const WET_SNOW: f32 = 0.15;
// Extent of light beyond the shadow's edge by scattering within the snow, as a cosine.
const SNOW_WRAP: f32 = 0.12;
// Width of the edges of patches of snow, in units of the hollows' root mean square depth.
const SNOW_EDGE: f32 = 0.35;
// Limits of the albedo that the host's colour would have in full light. Below x, which is less than the albedo of any
// outdoor ground, the ground counts as in the lamp's shadow. Above y it counts as lit.
const SHADOWED: vec2f = vec2f(0.015, 0.05);
// Number of halvings from a cell of the rings' grid to the finest cells of glints.
const FINEST_GLINT: f32 = 6.0;
// Share of the cells that glint.
const GLINT_SHARE: f32 = 0.02;

// Returns the level in the hollows up to which snow of this depth covers level ground. The first patches lie in the
// deepest hollows, where puddles do.
fn snow_level(depth: f32) -> f32 {
    return select(level_of(tanh(min(depth / 0.025, 10.0))), NO_LEVEL, depth <= 0.0);
}

// Returns the share of a pixel under snow that fills all hollows deeper than `level`. `pattern` is a result of
// `hollow_depth`, `cosine` the cosine of the slope.
fn snow_share(level: f32, pattern: vec2f, cosine: f32) -> f32 {
    // Snow lies up to its angle of repose, and thinly on somewhat steeper slopes.
    return covered_share(pattern, level, SNOW_EDGE) * smoothstep(0.6, 0.82, cosine);
}

// Returns the brightness of glints in cells of the size RING_CELL / 2^level. Each cell of the ground has one grain, and
// few grains reflect the lamp to the eye.
fn glints_of(at: vec2f, level: f32, half_way: vec2f) -> f32 {
    let cells = exp2(level);
    let place = (at + vec2f(ground.place_u, ground.place_v)) / RING_CELL * cells;
    let low = floor(place);
    let cell = vec2u(vec2i(low)) + ground.cell * u32(cells);
    let chance = ring_chances(cell, u32(level) + 77u);
    // The facet of a grain has a random orientation; as the eye moves, other grains glint.
    let turned = fract(chance.x + 11.0 * dot(half_way, 2.0 * chance.yz - 1.0));
    let from_middle = length(place - low - 0.5);
    return select(0.0, 1.0, turned < GLINT_SHARE) * smoothstep(0.45, 0.1, from_middle) * chance.y;
}

// Returns the brightness of single grains, relative to the light of the snow. Cells are about as large as pixels, so
// glints neither crawl nor flicker. They fade where a pixel holds many grains.
fn snow_glints(at: vec2f, side: f32, to_eye: vec3f) -> f32 {
    let wanted = clamp(log2(RING_CELL / max(2.0 * side, 1e-4)), 0.0, FINEST_GLINT);
    let low = floor(wanted);
    let middle = unit_or(to_eye + ground.to_lamp, to_eye).xy;
    let both = mix(glints_of(at, low, middle), glints_of(at, min(low + 1.0, FINEST_GLINT), middle), wanted - low);
    return both * (1.0 - smoothstep(0.005, 0.06, side));
}

// Returns the light of snow towards the eye, cd/m^2. `snow.y` is the wetness, `snow.z` the albedo. `seen` is the albedo
// that the host's colour would have in full light; `lamps` is the illuminance from the host's lamps.
fn snow_light(snow: vec3f, normal: vec3f, up: vec3f, seen: vec3f, lamps: vec3f, glints: f32) -> vec3f {
    let cosine = dot(normal, ground.to_lamp);
    let lit = smoothstep(SHADOWED.x, SHADOWED.y, dot(seen, vec3f(0.2126, 0.7152, 0.0722)));
    let lamp = ground.lamp_lux * (max((cosine + SNOW_WRAP) / (1.0 + SNOW_WRAP), 0.0) * lit);
    let sky = ground.sky_lux * (0.5 + 0.5 * dot(normal, up));
    let albedo = SNOW_COLOR * (snow.z * (1.0 - WET_SNOW * snow.y));
    return albedo * (lamp * (1.0 + glints) + sky + lamps) / SKY_PI;
}

// Snow that a pixel shows.
struct SnowSeen {
    // Light of the snow towards the eye, cd/m^2.
    light: vec3f,
    // Share of the pixel's surface under snow.
    share: f32,
}

// Returns the snow of a spot. `normal_given` says whether the host's image has the surface's normal.
fn snow_on(spot: Spot, normal_given: bool) -> SnowSeen {
    let here = spot.terrain;
    var snow = ground.snow.xyz;
    if TERRAIN && ground.snow.w >= 0.0 {
        let depth = ground.snow.w;
        // If only the terrain or only the open country has snow, its properties are used.
        let known = select(select(here.share, 1.0, depth <= 0.0), 0.0, here.snow.x <= 0.0);
        snow = vec3f(snow_level(mix(depth, here.snow.x, here.share)), mix(snow.yz, here.snow.zw, known));
    }
    // Far away the slope of a pixel's footprint is too uncertain for patches: the snow is averaged there.
    let patches = mix(spot.pattern, vec2f(0.0, 1.0), smoothstep(150.0, 800.0, spot.range));
    let lies = snow_share(snow.x, patches, spot.level) * spot.ground.look.snow * spot.gets;
    let soft = normalize(mix(spot.ground.facing.normal, spot.up, select(0.35, 0.0, here.share > 0.5 || normal_given)));
    // Drifts and tracks are not in the host's geometry: the gradient of their depth tilts the normal.
    var heaped = soft;
    if TERRAIN {
        heaped = unit_or(soft - here.drift * (here.share * lies), soft);
    }
    let glints = snow_glints(spot.place, spot.side, spot.to_eye) * (1.0 - snow.y);
    let white = snow_light(snow, heaped, spot.up, spot.ground.albedo, host_lamps(spot.at, heaped), glints);
    return SnowSeen(capped(white, ground.most), lies);
}
