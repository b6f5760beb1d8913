// Field of clouds: where there is cloud in a layer. The f64 reference is src/clouds/field/extinction.rs;
// src/clouds/field/mod.rs describes the model.
//!include "clouds/block.wgsl"
//!include "clouds/placed.wgsl"

// Map of how strongly cloud grows at each place, the map's number: two sheets (array layers), each with even (x) and
// cellular (y) noise.
@group(0) @binding(2) var cloud_map: texture_2d_array<f32>;
// Solid noise that frays the clouds' edges.
@group(0) @binding(3) var cloud_solid: texture_3d<f32>;

// Period of the map, in distances from cloud to cloud.
const MAP_CELLS: f32 = 16.0;
// Ratio of the second sheet's period to the first's.
const SECOND_PERIOD: f32 = 1.618034;
// Cosine and sine of the angle by which the second sheet is turned.
const SECOND_TURN: vec2f = vec2f(0.62160997, 0.7833269);
// Mean of the solid noise.
const SOLID_MEAN: f32 = 0.47;
// Reciprocal of the range that contains nearly all of the solid noise.
const SOLID_GAIN: f32 = 2.2;
// Largest amount that the solid noise adds to the excess, in units of the fraying's amplitude.
const MOST_FRAYED: f32 = 0.8;
// Change of the map's number over one distance from cloud to cloud.
const MAP_SLOPE: f32 = 4.0;

// A place in a layer.
struct CloudPlace {
    // Position east and north of the camera, m.
    level: vec2f,
    // Height, 0 at the layer's base to 1 at its top.
    height: f32,
}

// Height over which the edges of a base are round, as a share of the layer's thickness.
const EDGE_SHARE: f32 = 0.08;
// Limit of the height of EDGE_SHARE, m: bases of deep layers are flatter.
const EDGE_M: f32 = 40.0;
// Heights between which an anvil is whole, 0 at the layer's base to 1 at its top.
const ANVIL: vec2f = vec2f(0.84, 0.95);
// Heights over which an anvil fades out below the range ANVIL and above it.
const ANVIL_FACES: vec2f = vec2f(0.2, 0.05);
// Share by which an anvil's edges fray less than its towers'.
const ANVIL_SMOOTHER: f32 = 0.65;

// Blur of clouds in a pixel that spans several clouds. All members are 0 near the eye.
struct CloudBlur {
    // Mip level of the map.
    map: f32,
    // Mip level of the solid noise.
    solid: f32,
    // Standard deviation of the excess within the pixel.
    spread: f32,
}

// Blur at the place that is looked up for a ray.
var<private> cloud_blur: CloudBlur;

// Texels of the map in one distance from cloud to cloud.
const MAP_TEXELS: f32 = 16.0;
// Texels across the solid noise.
const SOLID_TEXELS: f32 = 64.0;
// Number of mip levels by which the second sheet is read finer, because its cells are larger.
const SECOND_LEVEL: f32 = 0.694;
// A mean over a width w removes the share 1 - exp(-(w / x)^y) of the variance. These constants hold (x, y): for the
// even and the cellular sheets with w in distances from cloud to cloud, and for the solid noise with w in sides of its
// cube. A test in src/clouds/field/map.rs checks these constants.
const EVEN_BLUR: vec2f = vec2f(2.12, 1.25);
const CELLULAR_BLUR: vec2f = vec2f(0.84, 1.9);
const SOLID_BLUR: vec2f = vec2f(0.14, 1.7);
// Standard deviation of the solid noise.
const SOLID_DEVIATION: f32 = 0.107;

// Width of a pixel up to which clouds are not blurred, in distances from cloud to cloud.
const BLUR_FROM: f32 = 0.15;

// Share of the variance that a mean over `width` removes. `law` is EVEN_BLUR or one of the two constants after it.
fn cloud_lost(width: f32, law: vec2f) -> f32 {
    return 1.0 - exp(-pow(width / law.x, law.y));
}

// Returns the blur for places that are averaged over a width, m.
fn cloud_blur_over(layer: CloudLayer, width: f32) -> CloudBlur {
    var blur = CloudBlur(0.0, 0.0, 0.0);
    let cells = width * layer.size.z - BLUR_FROM;
    if cells > 0.0 {
        let sides = cells * layer.medium.w / layer.size.z;
        let c = layer.solid.w;
        let kinds = vec2f((1.0 - c) * (1.0 - c), c * c);
        let lost = dot(kinds, vec2f(cloud_lost(cells, EVEN_BLUR), cloud_lost(cells, CELLULAR_BLUR))) / (kinds.x + kinds.y);
        let fray = layer.shape.z * SOLID_GAIN * SOLID_DEVIATION;
        blur.spread = sqrt(lost + fray * fray * cloud_lost(sides, SOLID_BLUR));
        blur.map = max(log2(cells * MAP_TEXELS), 0.0);
        blur.solid = max(log2(sides * SOLID_TEXELS), 0.0);
    }
    return blur;
}

// Horizontal position of a place, without the cloud's lean, m.
fn cloud_unleaned(layer: CloudLayer, at: CloudPlace) -> vec2f {
    return at.level - layer.lean.xy * (at.height * at.height);
}

// Position in the map's pattern that belongs to a place, without lean and without stretch along the wind, m.
fn cloud_upright(layer: CloudLayer, at: CloudPlace) -> vec2f {
    let level = cloud_unleaned(layer, at);
    return vec2f(dot(layer.stretch.xy, level), dot(layer.stretch.yz, level));
}

// Excess over the threshold, before dome and fraying.
fn cloud_over(layer: CloudLayer, at: CloudPlace) -> f32 {
    return cloud_strength(layer, cloud_upright(layer, at)) - layer.shape.x;
}

// Excess needed for cloud at the layer's top over a place of this excess.
fn cloud_dome_over(layer: CloudLayer, excess: f32) -> f32 {
    let e = max(excess, 0.0);
    return layer.shape.y * sqrt(1.0 + layer.stretch.w * e * e);
}

// The map's number at a place in the pattern.
fn cloud_strength(layer: CloudLayer, level: vec2f) -> f32 {
    let cell = level * (layer.size.z / MAP_CELLS);
    let turned = vec2f(SECOND_TURN.x * cell.x - SECOND_TURN.y * cell.y, SECOND_TURN.y * cell.x + SECOND_TURN.x * cell.y);
    let first = textureSampleLevel(cloud_map, cloud_sampler, layer.sheets.xy + cell, 0, cloud_blur.map);
    let second_at = layer.sheets.zw + turned * (1.0 / SECOND_PERIOD);
    let second = textureSampleLevel(cloud_map, cloud_sampler, second_at, 1, max(cloud_blur.map - SECOND_LEVEL, 0.0));
    let c = layer.solid.w;
    let scale = inverseSqrt(2.0 * (c * c + (1.0 - c) * (1.0 - c)));
    return ((first.x + second.x) * (1.0 - c) + (first.y + second.y) * c) * scale;
}

// Excess needed for cloud at a height over a place of this excess. This gives clouds a flat base with round edges, and
// a dome or an anvil above it.
fn cloud_dome(layer: CloudLayer, excess: f32, height: f32) -> f32 {
    let share = min(EDGE_M * layer.size.y, EDGE_SHARE);
    let edge = max(1.0 - height / share, 0.0);
    let off = max(vec2f(ANVIL.x - height, height - ANVIL.y), vec2f(0.0)) * (1.0 / ANVIL_FACES);
    return min(cloud_dome_over(layer, excess) * height * height + 0.25 * edge * edge * share * (1.0 / EDGE_SHARE), layer.lean.z + 3.0 * dot(off, off));
}

// Amount that the solid noise adds to the excess.
fn cloud_frays(layer: CloudLayer, at: CloudPlace) -> f32 {
    let solid = vec3f(cloud_upright(layer, at), at.height / layer.size.y) * layer.medium.w + layer.solid.xyz;
    let within = clamp((at.height - ANVIL.x) * (1.0 / 0.14) + 1.0, 0.0, 1.0);
    let smooth_share = 1.0 - ANVIL_SMOOTHER * within * clamp(-layer.lean.z / 0.2, 0.0, 1.0);
    return layer.shape.z * smooth_share * SOLID_GAIN * (textureSampleLevel(cloud_solid, cloud_sampler, solid, cloud_blur.solid).r - SOLID_MEAN);
}

// Extinction, 1/m, for an excess over threshold and dome, with fraying.
fn cloud_extinction(layer: CloudLayer, excess: f32) -> f32 {
    return layer.size.w * clamp(excess * layer.shape.w, 0.0, 1.0);
}

// Amount of cloud below a height over a place of this excess, in layer thicknesses: the integral over height of the
// ratio of the extinction to full extinction.
fn cloud_filled(layer: CloudLayer, excess: f32, height: f32) -> f32 {
    let d = max(cloud_dome_over(layer, excess), 1e-3);
    let ends = min(sqrt(max(vec2f(excess - 1.0 / layer.shape.w, excess), vec2f(0.0)) / d), vec2f(1.0));
    let x = clamp(height, ends.x, ends.y);
    let ramp = (excess - d * vec2f(x * x, ends.x * ends.x) * (1.0 / 3.0)) * vec2f(x, ends.x) * layer.shape.w;
    // Part of an anvil that lies above the dome.
    let lowest = clamp(ends.y, ANVIL.x, ANVIL.y);
    let anvil = clamp((excess - layer.lean.z) * layer.shape.w, 0.0, 1.0) * (clamp(height, lowest, ANVIL.y) - lowest);
    return min(height, ends.x) + max(ramp.x - ramp.y, 0.0) + anvil;
}

// Lengths of cloud at full extinction above and below a place of this excess over the threshold, and horizontal
// distance from the place to the edge of its cloud, m.
fn cloud_about(layer: CloudLayer, excess: f32, height: f32) -> vec3f {
    let below = cloud_filled(layer, excess, height);
    let above = cloud_filled(layer, excess, 1.0) - below;
    // An anvil reaches farther out than its tower.
    let beyond = select(0.0, min(layer.lean.z, 0.0), height > ANVIL.x - 0.5 * ANVIL_FACES.x);
    return vec3f(vec2f(above, below) / layer.size.y, max(excess - beyond, 0.0) / (MAP_SLOPE * layer.size.z));
}
