// Field of clouds: where there is cloud in a layer. The f64 reference is src/clouds/field/extinction.rs;
// src/clouds/field/mod.rs describes the model.
//!include "clouds/block.wgsl"
//!include "clouds/placed.wgsl"

// Map of how strongly cloud grows at each place, the map's number: two sheets (array layers), each with even (x),
// cellular (y) and ragged (z) noise.
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
// Shortfall of the excess at and beyond which the solid noise adds no cloud.
const FRAYS_ADDED: f32 = 0.4;
// Change of the map's number over one distance from cloud to cloud.
const MAP_SLOPE: f32 = 2.0;
// Increase of that change per unit of the ragged noise's deviation.
const RAGGED_SLOPE: f32 = 2.0;

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
// Heights between which a tower spreads into its anvil.
const SPREADS: vec2f = vec2f(0.66, 0.86);
// Heights between which the anvil gives way to the tops of the towers that shoot through it.
const OVERSHOOTS: vec2f = vec2f(0.93, 0.97);
// Mip level of the map from which an anvil follows.
const ANVIL_LEVEL: f32 = 4.0;
// Share by which an anvil's edges fray less than its towers'.
const ANVIL_SMOOTHER: f32 = 0.65;

// Blur of clouds in a pixel that spans several clouds. All members are 0 near the eye.
struct CloudBlur {
    // Mip level of the map.
    map: f32,
    // Mip level of the solid noise.
    solid: f32,
    // Variance of the excess within the pixel without that of the ragged noise, and the variance of the ragged noise at
    // the base.
    spread: vec2f,
}

// Blur at the place that is looked up for a ray.
var<private> cloud_blur: CloudBlur;

// Texels of the map in one distance from cloud to cloud.
const MAP_TEXELS: f32 = 32.0;
// Texels across the solid noise.
const SOLID_TEXELS: f32 = 64.0;
// Number of mip levels by which the second sheet is read finer, because its cells are larger.
const SECOND_LEVEL: f32 = 0.694;
// A mean over a width w removes the share 1 - exp(-(w / x)^y) of the variance. These constants hold (x, y): for the
// even, the cellular and the ragged noise with w in distances from cloud to cloud, and for the solid noise with w in
// sides of its cube. A test in src/clouds/field/map.rs checks these constants.
const EVEN_BLUR: vec2f = vec2f(9.4, 1.14);
const CELLULAR_BLUR: vec2f = vec2f(0.84, 1.9);
const RAGGED_BLUR: vec2f = vec2f(0.48, 1.1);
const SOLID_BLUR: vec2f = vec2f(0.14, 1.7);
// Share of the cellular noise's variance that belongs to its cells. The rest belongs to long waves, which no mean
// removes.
const CELLS_SHARE: f32 = 0.61;
// Standard deviation of the solid noise.
const SOLID_DEVIATION: f32 = 0.107;

// Width of a pixel up to which clouds are not blurred, in distances from cloud to cloud.
const BLUR_FROM: f32 = 0.15;

// Share of the variance that a mean over `width` removes. `law` is EVEN_BLUR or one of the three constants after it.
fn cloud_lost(width: f32, law: vec2f) -> f32 {
    return 1.0 - exp(-pow(width / law.x, law.y));
}

// Returns the blur for places that are averaged over a width, m.
fn cloud_blur_over(layer: CloudLayer, width: f32) -> CloudBlur {
    var blur = CloudBlur(0.0, 0.0, vec2f(0.0));
    let cells = width * layer.size.z - BLUR_FROM;
    if cells > 0.0 {
        let sides = cells * layer.medium.w / layer.size.z;
        let c = layer.solid.w;
        let kinds = vec2f((1.0 - c) * (1.0 - c), c * c);
        let each = vec2f(cloud_lost(cells, EVEN_BLUR), CELLS_SHARE * cloud_lost(cells, CELLULAR_BLUR));
        let lost = dot(kinds, each) / (kinds.x + kinds.y);
        let fray = layer.shape.z * SOLID_GAIN * SOLID_DEVIATION;
        let ragged = layer.form.w * layer.form.w * cloud_lost(cells, RAGGED_BLUR);
        blur.spread = vec2f(lost + fray * fray * cloud_lost(sides, SOLID_BLUR), ragged);
        blur.map = max(log2(cells * MAP_TEXELS), 0.0);
        blur.solid = max(log2(sides * SOLID_TEXELS), 0.0);
    }
    return blur;
}

// Degree to which a layer has anvils, 0 to 1.
fn cloud_anvil_share(layer: CloudLayer) -> f32 {
    return clamp(-layer.lean.z * 5.0, 0.0, 1.0);
}

// Degree to which the clouds of a height are anvils, 0 to 1: towers spread below an anvil, and the tops of some shoot
// through it.
fn cloud_spreading(layer: CloudLayer, height: f32) -> f32 {
    return cloud_anvil_share(layer) * smoothstep(SPREADS.x, SPREADS.y, height) * (1.0 - smoothstep(OVERSHOOTS.x, OVERSHOOTS.y, height));
}

// Horizontal position of a place, without the cloud's lean, m. Fibres lean as a parabola; anvils stand downwind of
// upright towers.
fn cloud_unleaned(layer: CloudLayer, at: CloudPlace) -> vec2f {
    let fibres = at.height * at.height * (1.0 - cloud_anvil_share(layer));
    return at.level - layer.lean.xy * (fibres + cloud_spreading(layer, at.height));
}

// Position in the map's pattern that belongs to a place, without lean and without stretch along the wind, m.
fn cloud_upright(layer: CloudLayer, at: CloudPlace) -> vec2f {
    let level = cloud_unleaned(layer, at);
    return vec2f(dot(layer.stretch.xy, level), dot(layer.stretch.yz, level));
}

// Excess of the map's number over the threshold (x), and the ragged noise at the base as an excess (y).
fn cloud_over(layer: CloudLayer, at: CloudPlace) -> vec2f {
    let found = cloud_strength(layer, cloud_upright(layer, at), ANVIL_LEVEL * cloud_spreading(layer, at.height));
    return vec2f(found.x - layer.shape.x, found.y * layer.form.w);
}

// Share of the ragged noise that is left at a height: 1 at the base, 0 at the top.
fn cloud_raggedness(layer: CloudLayer, height: f32) -> f32 {
    let low = clamp(1.0 - height, 0.0, 1.0);
    return low * (low * low + layer.form.z * (1.0 - low * low));
}

// Excess at a height, before dome and fraying. `over` is the answer of cloud_over.
fn cloud_excess(layer: CloudLayer, over: vec2f, height: f32) -> f32 {
    return over.x + over.y * cloud_raggedness(layer, height);
}

// Excess needed for cloud at a height as a share of the excess needed at the top.
fn cloud_rise(layer: CloudLayer, height: f32) -> f32 {
    return height * (layer.form.x + (1.0 - layer.form.x) * height);
}

// Excess needed for cloud at the layer's top over a place of this excess.
fn cloud_dome_over(layer: CloudLayer, excess: f32) -> f32 {
    let e = max(excess, 0.0);
    return layer.shape.y * sqrt(1.0 + layer.stretch.w * e * e);
}

// The map's number (x) and the ragged noise (y) at a place in the pattern, both with deviation 1, and less at a mip level
// above 0.
fn cloud_strength(layer: CloudLayer, level: vec2f, mip: f32) -> vec2f {
    let blur = max(cloud_blur.map, mip);
    let cell = level * (layer.size.z / MAP_CELLS);
    let turned = vec2f(SECOND_TURN.x * cell.x - SECOND_TURN.y * cell.y, SECOND_TURN.y * cell.x + SECOND_TURN.x * cell.y);
    let first = textureSampleLevel(cloud_map, cloud_sampler, layer.sheets.xy + cell, 0, blur);
    let second_at = layer.sheets.zw + turned * (1.0 / SECOND_PERIOD);
    let second = textureSampleLevel(cloud_map, cloud_sampler, second_at, 1, max(blur - SECOND_LEVEL, 0.0));
    let c = layer.solid.w;
    let scale = inverseSqrt(2.0 * (c * c + (1.0 - c) * (1.0 - c)));
    let both = first.xyz + second.xyz;
    return vec2f((both.x * (1.0 - c) + both.y * c) * scale, both.z * 0.70710678);
}

// Excess needed for cloud at a height over a place of this excess. This gives clouds a flat base with round edges, and
// a dome or an anvil above it.
fn cloud_dome(layer: CloudLayer, excess: f32, height: f32) -> f32 {
    let share = min(EDGE_M * layer.size.y, EDGE_SHARE);
    let edge = max(1.0 - height / share, 0.0);
    let off = max(vec2f(ANVIL.x - height, height - ANVIL.y), vec2f(0.0)) * (1.0 / ANVIL_FACES);
    return min(cloud_dome_over(layer, excess) * cloud_rise(layer, height) + 0.25 * edge * edge * share * (1.0 / EDGE_SHARE), layer.lean.z + 3.0 * dot(off, off));
}

// Amount that the solid noise adds to the excess within cloud.
fn cloud_frays(layer: CloudLayer, at: CloudPlace) -> f32 {
    let solid = vec3f(cloud_upright(layer, at), at.height / layer.size.y) * layer.medium.w + layer.solid.xyz;
    let within = clamp((at.height - ANVIL.x) * (1.0 / 0.14) + 1.0, 0.0, 1.0);
    let smooth_share = 1.0 - ANVIL_SMOOTHER * within * cloud_anvil_share(layer);
    return layer.shape.z * smooth_share * SOLID_GAIN * (textureSampleLevel(cloud_solid, cloud_sampler, solid, cloud_blur.solid).r - SOLID_MEAN);
}

// Largest amount by which the solid noise raises the excess where there is no cloud without it.
fn cloud_most_frayed(layer: CloudLayer) -> f32 {
    let most = MOST_FRAYED * layer.shape.z;
    return select(min(most, FRAYS_ADDED), most, layer.form.y > 0.0);
}

// Amount that the solid noise adds to an excess `inside` over the one that cloud needs, if it is `frays` within cloud.
// Outlines are not frayed far into clear air, where they would be specks.
fn cloud_frayed(layer: CloudLayer, inside: f32, frays: f32) -> f32 {
    let share = clamp(1.0 + inside * (1.0 / FRAYS_ADDED), 0.0, 1.0);
    return select(frays, frays * mix(layer.form.y, 1.0, share), frays > 0.0);
}

// Extinction, 1/m, for an excess over threshold and dome, with fraying.
fn cloud_extinction(layer: CloudLayer, excess: f32) -> f32 {
    return layer.size.w * clamp(excess * layer.shape.w, 0.0, 1.0);
}

// Amount of cloud below a height over a place of this excess, in layer thicknesses: the integral over height of the
// ratio of the extinction to full extinction.
fn cloud_filled(layer: CloudLayer, excess: f32, height: f32) -> f32 {
    let d = max(cloud_dome_over(layer, excess), 1e-3);
    let a = layer.form.x;
    let risen = max(vec2f(excess - 1.0 / layer.shape.w, excess), vec2f(0.0)) / d;
    // Heights at which the cloud of an excess ends: the solution of cloud_rise.
    let ends = min(2.0 * risen / max(a + sqrt(a * a + 4.0 * (1.0 - a) * risen), vec2f(1e-6)), vec2f(1.0));
    let x = vec2f(clamp(height, ends.x, ends.y), ends.x);
    let ramp = (excess - d * x * (0.5 * a + (1.0 - a) * (1.0 / 3.0) * x)) * x * layer.shape.w;
    // Part of an anvil that lies above the dome.
    let lowest = clamp(ends.y, ANVIL.x, ANVIL.y);
    let anvil = clamp((excess - layer.lean.z) * layer.shape.w, 0.0, 1.0) * (clamp(height, lowest, ANVIL.y) - lowest);
    return min(height, ends.x) + max(ramp.x - ramp.y, 0.0) + anvil;
}

// Lengths of cloud at full extinction above and below a place of this excess over the threshold, and horizontal
// distance from the place to the edge of its cloud, m.
fn cloud_about(layer: CloudLayer, excess: f32, height: f32) -> vec3f {
    let filled = cloud_filled(layer, excess, height);
    let above = cloud_filled(layer, excess, 1.0) - filled;
    // An anvil reaches farther out than its tower, and has clear air below it.
    let hangs = min(filled, max(height - ANVIL.x + ANVIL_FACES.x, 0.0));
    let below = mix(filled, hangs, cloud_spreading(layer, height));
    let beyond = select(0.0, min(layer.lean.z, 0.0), height > ANVIL.x - 0.5 * ANVIL_FACES.x);
    return vec3f(vec2f(above, below) / layer.size.y, max(excess - beyond, 0.0) / ((MAP_SLOPE + RAGGED_SLOPE * layer.form.w) * layer.size.z));
}
