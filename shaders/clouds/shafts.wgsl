// Shafts of light between the shadows of clouds: the direct light in the air along a ray, less its mean over all
// places.
//
// Model: the air thins exponentially with height. Sample places along a ray divide it into intervals whose air scatters
// equal light to the eye. The shadow map gives the share of direct light at each place, and the ray has the mean of
// these shares.
//!include "clouds/shadow_map.wgsl"

// Number of sample places on a ray. The error of the share, as the median and the 95th percentile over rays, is 0.025
// and 0.079 with 12 places, 0.019 and 0.049 with 16, 0.014 and 0.039 with 24.
const SHAFT_STEPS: u32 = 24u;

// Optical depth of the air over a distance `along`, m. The extinction of the air is `extinction` at the start and falls
// by the rate `thins` per metre.
fn shaft_depth(extinction: f32, thins: f32, along: f32) -> f32 {
    let t = thins * along;
    return extinction * select((1.0 - exp(-clamp(t, -60.0, 60.0))) / thins, along, abs(t) < 1e-3);
}

// Distance at which the air has this optical depth; the inverse of `shaft_depth`.
fn shaft_way(extinction: f32, thins: f32, depth: f32) -> f32 {
    let t = thins * depth / extinction;
    return select(-log(max(1.0 - t, 1e-6)) / thins, depth / extinction, abs(t) < 1e-3);
}

// Offset of a pixel's sample places against its neighbours': interleaved gradient noise (Jimenez 2014).
fn shaft_between(pixel: vec2f) -> f32 {
    return fract(52.9829189 * fract(dot(pixel, vec2f(0.06711056, 0.00583715))));
}

// Share of direct light in the air before a place, less the mean of that share over all places. `origin` and
// `direction` are those of the ray to the place. `between`, 0 to 1, is the position of each sample in its interval.
fn cloud_shafts(
    shadows: CloudShadows,
    map: texture_2d<f32>,
    repeating: sampler,
    origin: vec3f,
    direction: vec3f,
    range: f32,
    between: f32,
) -> f32 {
    let thins = direction.z / shadows.haze_height;
    let whole = 1.0 - exp(-shaft_depth(shadows.haze, thins, range));
    // Beyond half the map's side the mean is used.
    let told = 1.0 - exp(-shaft_depth(shadows.haze, thins, min(range, 0.5 * shadows.period)));
    var sum = 0.0;
    for (var i = 0u; i < SHAFT_STEPS; i++) {
        let scattered = told * (f32(i) + between) / f32(SHAFT_STEPS);
        let way = shaft_way(shadows.haze, thins, -log(1.0 - scattered));
        sum += cloud_shadow(shadows, map, repeating, origin + direction * way) - shadows.mean;
    }
    return sum / f32(SHAFT_STEPS) * told / max(whole, 1e-6);
}
