// Light of the sea's surface towards the eye: sky, sun and moon mirrored by facets, light out of the water, foam. The
// f64 laws are in src/sea/water.rs and src/sea/slopes.rs.
//!include "common/opaque.wgsl"
//!include "between/air.wgsl"
//!include "sea/foam.wgsl"

// Largest root mean square slope of the table of reflectances.
const SEA_MOST_SLOPE: f32 = 0.4;
// Least cosine between the eye and a normal.
const LEAST_COSINE: f32 = 0.02;
// Share of the sky's light that another wave reflects where a mirrored ray meets it.
const OTHER_WAVES: f32 = 0.4;

// Variance of slopes along a direction.
fn variance_along(covariances: vec3f, toward: vec2f) -> f32 {
    let square = toward * toward;
    return max(covariances.x * square.x + 2.0 * covariances.y * toward.x * toward.y + covariances.z * square.y, 0.0);
}

// Mean slope, towards the eye, of the facets that the eye sees, for a root mean square slope along the view and the
// tangent of the eye's zenith angle: slope^2 tangent for steep views; for grazing views sqrt(pi / 2) slope, since
// facets are seen in proportion to how far they turn to the eye.
fn facing_slope(slope: f32, tangent: f32) -> f32 {
    let t = slope * tangent * 0.797884561;
    return slope * slope * tangent / sqrt(1.0 + t * t);
}

// Area that a unit of level surface shows in a direction: the mean of the positive part of a normal distribution.
fn shown_area(middle: f32, deviation: f32) -> f32 {
    return 0.5 * (middle + sqrt(middle * middle + 0.63661977 * deviation * deviation));
}

// Reflectance for unpolarised light of a flat surface (Fresnel 1823).
fn sea_fresnel(cosine: f32) -> f32 {
    let c = clamp(cosine, 0.0, 1.0);
    let g = sqrt(sea.index * sea.index - 1.0 + c * c);
    let a = (g - c) / (g + c);
    let b = (c * (g + c) - 1.0) / (c * (g - c) + 1.0);
    return 0.5 * a * a * (1.0 + b * b);
}

// Mean reflectance of a rough surface, seen at a cosine from its normal, with a root mean square slope along one axis.
fn mean_reflectance(cosine: f32, slope: f32) -> f32 {
    let size = vec2f(textureDimensions(sea_reflectance));
    let at = vec2f(sqrt(clamp(cosine, 0.0, 1.0)), min(slope / SEA_MOST_SLOPE, 1.0));
    return textureSampleLevel(sea_reflectance, sea_clamped, (0.5 + at * (size - 1.0)) / size, 0.0).r;
}

// Light of the sky above the horizon, through the fog over the sea. Clouds count as a deck with their mean cover.
fn mirrored_sky(d: vec3f) -> vec3f {
    let up = normalize(vec3f(d.xy, max(d.z, 2e-3)));
    let clear = color_of(sky_radiance_above(up)) + frame.night_floor;
    let sky = mix(clear, frame.deck * overcast_gradation(up.z), frame.deck_cover);
    let through = exp(-sea.fog_depth / max(up.z, 0.02));
    return sky * through + sea.sky_lux * ((1.0 - through) / SKY_PI);
}

// Light of sun or moon mirrored by facets (Cox and Munk 1954, equation 5): slopes are normally distributed about the
// mean `slope` with these covariances. Facets are lit as far as others do not hide the lamp from them.
fn sea_glitter(slope: vec2f, covariances: vec3f, to_eye: vec3f, area: f32) -> vec3f {
    let lamp = sea.to_lamp;
    let middle = to_eye + lamp;
    if lamp.z < -0.05 || middle.z < 1e-3 {
        return vec3f(0.0);
    }
    let facet = normalize(middle);
    let disc = sea.disc2;
    let xx = covariances.x + disc;
    let yy = covariances.z + disc;
    let both = clamp(covariances.y, -0.98 * sqrt(xx * yy), 0.98 * sqrt(xx * yy));
    let determinant = xx * yy - both * both;
    let off = -facet.xy / facet.z - slope;
    let far = (yy * off.x * off.x - 2.0 * both * off.x * off.y + xx * off.y * off.y) / determinant;
    let density = exp(-min(0.5 * far, 80.0)) * inverseSqrt(determinant) / 6.28318531;
    let lit = lamp.z - dot(slope, lamp.xy);
    let deviation = sqrt(max(xx * lamp.x * lamp.x + 2.0 * both * lamp.x * lamp.y + yy * lamp.y * lamp.y, 0.0));
    let open = clamp(lit / max(shown_area(lit, deviation), 1e-4), 0.0, 1.0);
    let h2 = facet.z * facet.z;
    return sea.lamp_lux * (density * open * sea_fresnel(dot(facet, to_eye)) / (4.0 * h2 * h2 * area));
}

// Surface in a pixel, seen from the eye.
struct SeaFacing {
    to_eye: vec3f,
    // Mean slope of the facets that the eye sees, without the slopes that the pixel does not show.
    slope: vec2f,
    // Mean reflectance, and the direction of the light that the middle facet mirrors.
    reflected: f32,
    mirrored: vec3f,
    // Area that a unit of level surface shows.
    area: f32,
}

fn sea_facing(point: vec3f, shown: SeaSlopes) -> SeaFacing {
    let to_eye = -normalize(point);
    let away = length(to_eye.xy);
    let level = to_eye.xy / max(away, 1e-5);
    // The eye sees more of the facets that face it, which shifts the mean of the slopes that do not move the mesh. The
    // slopes that the pixel shows take a share of this shift, by their variance.
    let along = variance_along(shown.left, level);
    let all = max(shown.mapped + along, 1e-9);
    let slope = shown.slope - level * (facing_slope(sqrt(all), away / max(to_eye.z, 1e-3)) * shown.mapped / all);
    // A normal that turns away from the eye, as at a crest's edge, is turned back.
    let unit = normalize(vec3f(-slope, 1.0));
    let normal = normalize(unit + to_eye * max(LEAST_COSINE - dot(unit, to_eye), 0.0));
    let cosine = max(dot(normal, to_eye), 0.0);
    let tangent = sqrt(max(1.0 - cosine * cosine, 0.0)) / max(cosine, 1e-3);
    let toward = to_eye - normal * cosine;
    let facet = normalize(normal + toward * (facing_slope(sqrt(along), tangent) / max(length(toward), 1e-5)));
    let reflected = mean_reflectance(cosine, sqrt(0.5 * (shown.left.x + shown.left.z)));
    let area = max(shown_area(to_eye.z - dot(slope, to_eye.xy), sqrt(along) * away), 1e-3);
    return SeaFacing(to_eye, slope, reflected, reflect(-to_eye, facet), area);
}

// Light of the surface at a camera-relative point, whose place at rest is `at`, towards the eye, cd/m^2; `left` and
// `wake` are the shares under foam that earlier waves and hulls left.
fn sea_light(point: vec3f, at: vec2f, shown: SeaSlopes, left: f32, wake: f32) -> vec3f {
    let facing = sea_facing(point, shown);
    // A mirrored ray that points down meets other waves, which mirror part of the sky beside it.
    let around = mirrored_sky(vec3f(facing.mirrored.xy, abs(facing.mirrored.z)));
    let sky = around * mix(OTHER_WAVES, 1.0, smoothstep(-0.1, 0.05, facing.mirrored.z));
    let glitter = sea_glitter(facing.slope, shown.left, facing.to_eye, facing.area);
    let light = mix(sea.body, sky, facing.reflected) + glitter;
    if sea.foam_from >= SEA_NO_FOAM && wake <= 0.0 {
        return light;
    }
    return mix(light, sea.white * FOAM_WHITE, foam_cover(at, shown, left, wake).white);
}
