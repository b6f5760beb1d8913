// Draws the terrain of the host's tiles into its colour and depth: materials by class, slope and height, in the light
// of sun, moon and sky. Water, snow, cloud shadows, air and fog follow in the composition, which reads the depth.
//!include "common/opaque.wgsl"
//!include "land/vertex.wgsl"
//!include "land/noise.wgsl"
//!include "land/shadow_share.wgsl"

const PI: f32 = 3.14159265;
// Cosines of the slopes between which soil and grass give way to rock: 46 and 36 degrees.
const STEEP: f32 = 0.69;
const GENTLE: f32 = 0.81;
// Altitudes between which natural ground loses its grass, m.
const GRASS_ENDS: vec2f = vec2f(1900.0, 2700.0);
// Cosine of the least slope at which dug soil counts as a wall; `WALL` of src/land/cells.rs is the tangent of this
// slope.
const WALL: f32 = 0.78;
// Change of the albedo of dug soil by the fine and by the broad noise of amplitude 1, as shares of this albedo.
const DUG_VARIES: vec2f = vec2f(0.14, 0.09);
// Index of the class of soil, of rock, and of grass.
const SOIL: u32 = 1u;
const ROCK: u32 = 2u;
const GRASS: u32 = 4u;

// Returns the shares of the classes at a place in a page, filtered.
fn class_shares(uv: vec2f) -> array<f32, 7> {
    let first = textureSampleLevel(page_classes, page_sampler, uv, 0.0);
    let last = textureSampleLevel(page_ground, page_sampler, uv, 0.0);
    let sum = max(first.x + first.y + first.z + first.w + last.x + last.y + last.z, 1e-3);
    return array<f32, 7>(
        first.x / sum, first.y / sum, first.z / sum, first.w / sum, last.x / sum, last.y / sum, last.z / sum,
    );
}

// Whether a triangle of texels has ground at all of its corners. The squares are split from south-west to north-east.
fn has_ground(slot: vec2i, texel: vec2f) -> bool {
    let low = vec2i(floor(texel));
    let part = texel - floor(texel);
    let third = select(vec2i(0, 1), vec2i(1, 0), part.x >= part.y);
    let first = textureLoad(page_ground, slot + low, 0).a;
    let second = textureLoad(page_ground, slot + low + third, 0).a;
    let last = textureLoad(page_ground, slot + low + vec2i(1), 0).a;
    return min(min(first, second), last) > 0.5;
}

// Returns the albedo of the ground. `cosine` is that of its slope.
fn ground_albedo(shares: array<f32, 7>, cosine: f32, altitude: f32, noise: vec2f) -> vec3f {
    var mixed = shares;
    // Rock shows where soil does not hold. Broad noise makes the border irregular.
    let rock = 1.0 - smoothstep(STEEP, GENTLE, cosine + 0.03 * noise.y);
    let bare = smoothstep(GRASS_ENDS.x, GRASS_ENDS.y, altitude + 150.0 * noise.y);
    let natural = mixed[0];
    mixed[0] = 0.0;
    mixed[GRASS] += natural * (1.0 - bare);
    mixed[SOIL] += natural * bare;
    let loose = mixed[GRASS] + mixed[SOIL];
    mixed[GRASS] *= 1.0 - rock;
    mixed[SOIL] *= 1.0 - rock;
    mixed[ROCK] += loose * rock;
    var albedo = vec3f(0.0);
    for (var i = 0u; i < MATERIALS; i++) {
        let material = land.materials[i];
        albedo += mixed[i] * (material.albedo.rgb + noise.x * material.fine.rgb + noise.y * material.broad.rgb);
    }
    return clamp(albedo, vec3f(0.005), vec3f(0.9));
}

// Returns the albedo of dug soil times the share that it covers, and this share. Soil is varied like rock.
fn dug_soil(uv: vec2f, noise: vec2f) -> vec4f {
    if land.has_dug == 0u {
        return vec4f(0.0);
    }
    let soil = textureSampleLevel(page_dug, page_sampler, uv, 0.0);
    return vec4f(soil.rgb * max(1.0 + DUG_VARIES.x * noise.x + DUG_VARIES.y * noise.y, 0.3), soil.a);
}

// Returns the normal of a surface on which clods lie. `share` is that of the clods.
fn cloddy(normal: vec3f, share: f32, place: vec3f, footprint: f32) -> vec3f {
    if share <= 0.0 {
        return normal;
    }
    let slope = share * clod_slope(place, footprint);
    return normalize(normal - (slope - dot(slope, normal) * normal));
}

// Returns the luminance of the ground at a fragment. `facet` is the normal of the fragment's triangle.
fn ground_luminance(in: LandVarying, footprint: f32, facet: vec3f) -> vec3f {
    let size = vec2f(textureDimensions(page_slopes));
    let uv = (vec2f(in.slot) + in.texel + 0.5) / size;
    let slopes = textureSampleLevel(page_slopes, page_sampler, uv, 0.0);
    let slope = mix(slopes.xy, slopes.zw, in.morph);
    let noise = vec2f(fine_noise(in.place, footprint), broad_noise(in.place, footprint));
    let soil = dug_soil(uv, noise);
    let tilted = cloddy(normalize(vec3f(-slope, 1.0)), soil.a, in.place, footprint);
    let normal = land.to_local[0].xyz * tilted.x + land.to_local[1].xyz * tilted.y + land.to_local[2].xyz * tilted.z;
    let here = land.to_local[0].xyz * in.place.x + land.to_local[1].xyz * in.place.y + land.to_local[2].xyz * in.place.z;
    let up = normalize(vec3f(here.xy * land.curvature, max(1.0 + here.z * land.curvature, 0.1)));
    let cosine = dot(normal, up);
    let altitude = land.altitude + in.place.z + land.eye.z;
    // Walls of soil are steep, and yet no rock.
    let firm = mix(cosine, 1.0, min(4.0 * soil.a, 1.0));
    let albedo = (1.0 - soil.a) * ground_albedo(class_shares(uv), firm, altitude, noise) + soil.rgb;
    let lit = max(vec2f(dot(normal, land.sun.xyz), dot(normal, land.moon.xyz)), vec2f(0.0));
    // A dug wall at an angle to the lattice is a stair of cells. The shadows of its steps on each other are left out.
    let is_wall = soil.a > 0.0 && facet.z < WALL;
    let share = shadow_share(in.place, facet, select(0.0, land.cell_m, is_wall));
    let seen = lit * mix(vec2f(1.0), vec2f(share), land.shadow.shaded.xy);
    let direct = land.sun_lux.rgb * seen.x + land.moon_lux.rgb * seen.y;
    let open = 0.5 + 0.5 * cosine;
    return albedo * (direct + land.sky_lux.rgb * open + land.bounce_lux.rgb * (1.0 - open)) / PI;
}

// Returns the host's colour of a fragment. Discards the fragment where the host's mask keeps the host's pixel, and
// where there is no ground.
fn shown(in: LandVarying) -> vec4f {
    // Side of the square that a pixel covers on the ground.
    let area = cross(dpdx(in.place), dpdy(in.place));
    let size = sqrt(max(dot(area, area), 0.0));
    let footprint = sqrt(size);
    // Rows of the picture may run upwards or downwards; the ground faces up.
    let facet = area * (sign(area.z) / max(size, 1e-30));
    if is_kept(in.position.xy) || (in.has_holes == 1u && !has_ground(in.slot, in.texel)) {
        discard;
    }
    return vec4f(host_number(ground_luminance(in, footprint, facet)), 1.0);
}

@vertex
fn land_vertex(
    @builtin(vertex_index) index: u32,
    @location(0) low: vec2i,
    @location(1) page: vec2u,
) -> LandVarying {
    return patch_vertex(index, low, page);
}

@fragment
fn plain(in: LandVarying) -> @location(0) vec4f {
    return shown(in);
}

struct WithDepth {
    @location(0) color: vec4f,
    @builtin(frag_depth) depth: f32,
}

// Draws with logarithmic depth, which the fragment stage writes.
@fragment
fn logarithmic(in: LandVarying) -> WithDepth {
    return WithDepth(shown(in), written_depth(frame.depth, 1.0 / max(in.position.w, 1e-20)));
}
