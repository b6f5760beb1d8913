// Light that a place in a cloud scatters towards the eye. The f64 reference is src/clouds/light/sources.rs;
// src/clouds/light/mod.rs describes the model.
//!include "clouds/block.wgsl"

// Tables of source terms. Side by side lie the terms for a beam on the top of a box of cloud, for a beam on its side,
// and for the sky. The media lie one below the other, the leak rates along the third dimension.
@group(0) @binding(4) var cloud_tables: texture_3d<f32>;
// Linear sampler that clamps to the edge.
@group(0) @binding(6) var cloud_table_sampler: sampler;

// Number of depths in a row or column of a table.
const CLOUD_DEPTHS: f32 = 28.0;
// Number of leak rates.
const CLOUD_LEAKS: f32 = 16.0;
// Smallest scaled depth above 0 in a table.
const CLOUD_THINNEST: f32 = 0.05;
// Pi.
const CLOUD_PI: f32 = 3.1415927;
// Steepness with which the beam is divided between top and side of the box.
const PART_RATE: f32 = 1.0;

// Scaled depths of cloud around a place.
struct CloudDepths {
    // Depth straight up.
    above: f32,
    // Depth straight down.
    below: f32,
    // Depth towards the sun.
    to_sun: f32,
    // Level depth towards the side where the sun stands.
    near: f32,
    // Level depth away from the sun.
    far: f32,
    // Level depth across the sun's direction, to the nearer edge of the cloud.
    left: f32,
    // Level depth across the sun's direction, to the farther edge of the cloud.
    right: f32,
}

// Interval of a ray, and the place whose light holds for the whole interval.
struct CloudStretch {
    // Unit vector along the ray.
    direction: vec3f,
    // Distance at which the interval begins, m.
    begun: f32,
    // Length of the interval, m.
    length: f32,
    // Distance of the place, m.
    at: f32,
    // Scaled depth of cloud between the interval and the eye.
    to_eye: f32,
}

// Scattered light, per unit of the light that falls on the layer.
struct CloudScattered {
    // Sunlight, per unit of the sun's irradiance on a surface that faces it, 1/sr.
    sun: f32,
    // Share of the sunlight that is scattered for the first time. Multiplied by the phase function, it gives the light
    // that is scattered once.
    once: f32,
    // Light of the sky, per unit of its radiance.
    sky: f32,
    // Light of the ground, per unit of its radiance.
    ground: f32,
}

// Position of a scaled depth among the depths of a table. Here and in field.wgsl, divisions by constants are written as
// products with inverses, because software drivers do not make that change themselves.
fn cloud_depth_place(depth: f32) -> f32 {
    let thin = depth * (1.0 / CLOUD_THINNEST);
    return clamp(select(1.0 + 2.0 * log2(max(thin, 1.0)), thin, thin < 1.0), 0.0, CLOUD_DEPTHS - 1.0);
}

// Position of a leak rate among the leak rates of a table.
fn cloud_leak_place(leak: f32) -> f32 {
    return min(4.0 * log(1.0 + sqrt(leak) * (1.0 / 0.03)), CLOUD_LEAKS - 1.0);
}

// Leak rate through the sides of a box with these scaled widths along two axes.
fn cloud_leak(widths: vec2f, turning: f32) -> f32 {
    let b = CLOUD_PI / (widths + 1.42 / turning);
    return dot(b, b) / (3.0 * turning);
}

// Looks up the source terms of a table: 0 for the beam on the top, 1 for the beam on the side, 2 for the sky.
fn cloud_table(table: f32, medium: f32, above: f32, below: f32, leak: f32) -> vec4f {
    let first = vec3f(table * CLOUD_DEPTHS, medium * CLOUD_DEPTHS, 0.0);
    let at = first + vec3f(cloud_depth_place(above), cloud_depth_place(below), cloud_leak_place(leak)) + 0.5;
    let texel = 1.0 / vec3f(3.0 * CLOUD_DEPTHS, 2.0 * CLOUD_DEPTHS, CLOUD_LEAKS);
    return textureSampleLevel(cloud_tables, cloud_table_sampler, at * texel, 0.0);
}

// Sum of Legendre polynomials with coefficients `terms` at `x`.
fn cloud_legendre(terms: vec4f, x: f32) -> f32 {
    return dot(terms, vec4f(1.0, x, 1.5 * x * x - 0.5, (2.5 * x * x - 1.5) * x));
}

// Extent of a box for diffusing light from side to side, in scaled depth.
fn cloud_reach(near: f32, far: f32, turning: f32) -> f32 {
    return max(near + far, 1e-3) + 1.42 / turning;
}

// Profile of light between two opposite sides of a box, and its slope along that axis. The mean of the profile is 1.
// `entered` is the depth of the place behind the face that the light falls on.
fn cloud_across(near: f32, far: f32, turning: f32, height: f32, entered: f32) -> vec2f {
    let extent = cloud_reach(near, far, turning);
    let b = CLOUD_PI / extent;
    let half = 0.5 * b * max(near + far, 1e-3);
    let off = 0.5 * b * (near - far);
    let over_mean = half / sin(half);
    let sideways = height * height;
    let set_in = 1.0 - exp(-turning * entered);
    let share = min(2.0 * sideways / (extent * extent + sideways), 1.0) * set_in;
    return vec2f(1.0 + share * (cos(off) * over_mean - 1.0), -b * sin(off) * over_mean * set_in);
}

// Phase function of the two lobes, 1/sr, at the angle whose 1 - cos is `versine`.
fn cloud_phase(medium: CloudMedium, versine: f32) -> f32 {
    let g = medium.lobes.xy;
    let d = (1.0 - g) * (1.0 - g) + 2.0 * g * versine;
    let lobe = (1.0 - g * g) / (d * sqrt(d));
    let alpha = medium.lobes.z;
    let c = 1.0 - versine;
    let draine = lobe.y * (1.0 + alpha * c * c) / (1.0 + alpha * (1.0 + 2.0 * g.y * g.y) / 3.0);
    return mix(lobe.x, draine, medium.lobes.w) / (4.0 * CLOUD_PI);
}

// Phase function of the first scattering, 1/sr. `gone` is the scaled depth of cloud on the whole path from the light to
// the place and on to the eye. A part of the light that counts as going straight on was scattered in the forward peak;
// this part is added at the angle of its scattering.
fn cloud_first_phase(medium: CloudMedium, versine: f32, gone: f32) -> f32 {
    let phase = cloud_phase(medium, versine);
    let forward = medium.rest.x * gone / (1.0 - medium.rest.x);
    let share_forward = select((1.0 - exp(-forward)) / forward, 1.0 - 0.5 * forward, forward < 1e-3);
    return (min(phase, medium.rest.y) + max(phase - medium.rest.y, 0.0) * share_forward) / (1.0 - medium.rest.x);
}

// Light by the source terms of a table, with the profiles of the light along two more axes and the flux along these
// axes. `axis` is the component of the direction along the table's axis. `one` and `other` each have the profile, its
// slope, and the component of the direction along the axis.
fn cloud_through(terms: vec4f, axis: f32, one: vec3f, other: vec3f, spread: f32) -> f32 {
    let leaves = one.y * other.x * one.z + other.y * one.x * other.z;
    return cloud_legendre(terms, axis) * one.x * other.x - spread * terms.x * leaves;
}

// Computes the light that a place at these depths scatters into `direction`, the direction in which light travels.
// `to_eye` is the scaled depth of cloud between the place and the eye.
fn cloud_scattered(medium_index: f32, at: CloudDepths, direction: vec3f, to_eye: f32) -> CloudScattered {
    let medium = clouds.media[u32(medium_index)];
    let turning = medium.rest.z;
    let albedo = medium.rest.w;
    let sun = clouds.to_sun;
    let sine = length(sun.xy);
    let cosine = max(abs(sun.z), 0.01);
    let level = select(vec2f(1.0, 0.0), -sun.xy / max(sine, 1e-6), sine > 1e-6);
    let along = dot(direction.xy, level);
    let sideways = dot(direction.xy, vec2f(-level.y, level.x));
    let day = sun.z >= 0.0;
    let above = select(at.below, at.above, day);
    let below = select(at.above, at.below, day);
    let down = select(direction.z, -direction.z, day);

    let height = cloud_reach(above, below, turning);
    let depth = cloud_reach(at.near, at.far, turning);
    let a = vec3f(cloud_across(at.near, at.far, turning, height, above), along);
    let c = vec3f(cloud_across(at.left, at.right, turning, height, above), sideways);
    let u = vec3f(cloud_across(above, below, turning, depth, at.near), down);
    let across = vec3f(cloud_across(at.left, at.right, turning, depth, at.near), sideways);
    let widths = vec3f(at.near + at.far, at.left + at.right, above + below);
    let spread = (1.0 - turning) / turning;
    let leak = cloud_leak(widths.xy, turning);
    let by_top = above / cosine;
    let by_side = select(1e9, at.near / max(sine, 1e-6), sine > 1e-6);
    let top_share = 1.0 / (1.0 + exp(min(PART_RATE * turning * (by_top - by_side), 80.0)));
    // The path to the sun may be longer than in the box. Light that is scattered often falls off slowly along it.
    let aside = min((1.0 + turning * min(by_top, by_side)) / (1.0 + turning * at.to_sun), 1.0);
    let share = aside * aside * max(top_share, 1.0 - top_share);
    let top = cloud_through(cloud_table(0.0, medium_index, above, below, leak), down, a, c, spread);
    let side_terms = cloud_table(1.0, medium_index, at.near, at.far, cloud_leak(widths.zy, turning));
    let side = select(0.0, cloud_through(side_terms, along, u, across, spread), sine > 1e-6);
    let momentum = exp(-turning * at.to_sun) - exp(-at.to_sun);
    let kept = albedo * 3.0 * (1.0 - turning) / (4.0 * CLOUD_PI) * momentum;
    let level_kept = kept * (top_share * sine * along + (1.0 - top_share) * cosine * down);
    var out: CloudScattered;
    out.once = albedo * exp(-at.to_sun);
    let once = out.once * cloud_first_phase(medium, 1.0 + dot(direction, sun), at.to_sun + to_eye);
    let often = share * (max(top, 0.0) + max(side, 0.0));
    out.sun = once + often + clamp(level_kept, -often, often);
    let sky = max(cloud_through(cloud_table(2.0, medium_index, at.above, at.below, leak), -direction.z, a, c, spread), 0.0);
    let ground = max(cloud_through(cloud_table(2.0, medium_index, at.below, at.above, leak), direction.z, a, c, spread), 0.0);
    // Through the sides as much light comes in as leaves. Half of it comes from the sky, half from the ground.
    let by_sides = 0.5 * (albedo - sky - ground);
    out.sky = max(sky + by_sides, 0.0);
    out.ground = max(ground + by_sides, 0.0);
    return out;
}
