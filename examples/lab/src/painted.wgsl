// Clouds painted on a plane, a shell or a dome. Noise above a cutoff is cloud; its opacity grows exponentially with the
// excess of the noise over the cutoff.
struct Painted {
    // Unit vectors to the camera's right, up and ahead (east, north, up). w of `right` and `up`: half width and half
    // height of the picture at distance 1.
    right: vec4f,
    up: vec4f,
    ahead: vec4f,
    // Unit vector towards the sun; w: height of the layer above the eye, m.
    to_sun: vec4f,
    // Illuminance by the sun on a surface facing it, lux; w: side of the texture, m.
    sun: vec4f,
    // Illuminance by the sky on level ground, lux; w: radius of the planet at the eye, m.
    sky: vec4f,
    // x: cutoff. y: optical depth per excess of the noise, as painted. z: the same as in Welkin's own layer. w: share
    // of the second texture.
    cloud: vec4f,
    // Offsets of the two textures at this moment, in sides of a texture.
    offset: vec4f,
}

@group(0) @binding(0) var<uniform> u: Painted;
@group(0) @binding(1) var plane_noise: texture_2d<f32>;
@group(0) @binding(2) var second_noise: texture_2d<f32>;
@group(0) @binding(3) var solid_noise: texture_3d<f32>;
@group(0) @binding(4) var repeating: sampler;

const PLANE: u32 = 0u;
const SHELL: u32 = 1u;
const DOME: u32 = 2u;
const SOLID_SHELL: u32 = 3u;
override FORM: u32 = 0u;

const FLAT: u32 = 0u;
const TRACED: u32 = 1u;
const BY_NORMAL: u32 = 2u;
const AVERAGED: u32 = 3u;
const SLAB: u32 = 4u;
override SHADING: u32 = 0u;

override CROSS_FADES: bool = false;
override CURLS: bool = false;

const PI: f32 = 3.1415927;
// Albedo of a white cloud.
const WHITE: f32 = 0.8;
// Number of steps of the path to the sun (`TRACED_STEPS`), and its length, in sides of the texture (`TRACED_WAY`).
const TRACED_STEPS: u32 = 8u;
const TRACED_WAY: f32 = 0.06;
// Share of the noise on that path that darkens.
const TRACED_SHARE: f32 = 0.3;
// Strength with which the slope of the noise tilts the normal (`BUMPS`), and distance over which the slope is measured,
// in sides of the texture (`BUMP_STEP`).
const BUMPS: f32 = 0.1;
const BUMP_STEP: f32 = 0.004;
// Multiplier of the light in the average of two textures.
const LIGHT_MULTIPLIER: f32 = 2.0;
// Displacement by swirls (`CURLED`), and distance over which the slope of their noise is measured (`CURL_STEP`), both
// in sides of the texture.
const CURLED: f32 = 0.02;
const CURL_STEP: f32 = 0.01;
// 1 - g of a slab, g = 0.85.
const TURNING: f32 = 0.15;

// Returns the factor with which clouds fade towards the horizon: 1 from 14 degrees on, below in the steps of the
// source's dome.
fn horizon_fade(sine: f32) -> f32 {
    let degrees = asin(clamp(abs(sine), 0.0, 1.0)) * 180.0 / PI;
    if degrees < 4.0 {
        return 0.075 * degrees;
    }
    if degrees < 9.0 {
        return 0.3 + 0.08 * (degrees - 4.0);
    }
    return min(0.7 + 0.06 * (degrees - 9.0), 1.0);
}

// Returns the distance at which a ray meets the layer, m; below 0 if it does not.
fn met(d: vec3f) -> f32 {
    let height = u.to_sun.w;
    if FORM == PLANE {
        return height / select(d.z, 1e-4, abs(d.z) < 1e-4);
    }
    // t^2 + 2 r mu t = h (2 r + h).
    let b = u.sky.w * d.z;
    let c = height * (2.0 * u.sky.w + height);
    let root = b * b + c;
    if root < 0.0 {
        return -1.0;
    }
    // From below, the far crossing counts; from above, the near one.
    return select(-c / max(sqrt(root) - b, 1.0), c / max(sqrt(root) + b, 1.0), height > 0.0);
}

fn noise_at(place: vec3f, dx: vec3f, dy: vec3f) -> f32 {
    if FORM == DOME || FORM == SOLID_SHELL {
        return textureSampleGrad(solid_noise, repeating, place + vec3f(u.offset.xy, u.offset.z), dx, dy).r;
    }
    var at = place.xy;
    if CURLS {
        // Moves along the contour lines of another noise, which does not compress the pattern.
        let h = vec2f(CURL_STEP, 0.0);
        let gx = textureSampleLevel(second_noise, repeating, at + h.xy, 3.0).r - textureSampleLevel(second_noise, repeating, at - h.xy, 3.0).r;
        let gy = textureSampleLevel(second_noise, repeating, at + h.yx, 3.0).r - textureSampleLevel(second_noise, repeating, at - h.yx, 3.0).r;
        at += CURLED * vec2f(gy, -gx) / (2.0 * CURL_STEP) * 0.1;
    }
    let first = textureSampleGrad(plane_noise, repeating, at + u.offset.xy, dx.xy, dy.xy).r;
    if !CROSS_FADES {
        return first;
    }
    return mix(first, textureSampleGrad(second_noise, repeating, at + u.offset.zw, dx.xy, dy.xy).r, u.cloud.w);
}

fn thickness(noise: f32) -> f32 {
    return max(noise - u.cloud.x, 0.0);
}

// Returns the luminous exitance divided by pi, per channel, of an even slab of this optical depth: the light that it
// lets through to an eye below, or reflects to an eye above.
fn of_slab(depth: f32) -> vec3f {
    let mu = max(u.to_sun.z, 0.05);
    let turned = TURNING * depth;
    let through = (2.0 / 3.0 + mu + (2.0 / 3.0 - mu) * exp(-min(turned / mu, 60.0))) / (4.0 / 3.0 + turned);
    let of_sky = 1.0 / (1.0 + 0.75 * turned);
    let straight = exp(-min(depth / mu, 60.0));
    if u.to_sun.w > 0.0 {
        return (u.sun.rgb * mu * max(through - straight, 0.0) + u.sky.rgb * of_sky) / PI;
    }
    return (u.sun.rgb * mu * (1.0 - through) + u.sky.rgb * (1.0 - of_sky)) / PI;
}

@fragment
fn painted(in: FullscreenVarying) -> @location(0) vec4f {
    let ndc = vec2f(2.0 * in.uv.x - 1.0, 1.0 - 2.0 * in.uv.y);
    let d = normalize(u.ahead.xyz + ndc.x * u.right.w * u.right.xyz + ndc.y * u.up.w * u.up.xyz);
    let t = met(d);
    let side = u.sun.w;
    var place = d * t / side;
    if FORM == DOME {
        // A sphere around the eye: a cloud appears as large at the horizon as overhead.
        place = d * abs(u.to_sun.w) / side;
    }
    let dx = dpdx(place);
    let dy = dpdy(place);
    // Beyond the horizon the ray counts as a miss, although its line meets the layer again on the other side of the
    // planet.
    if t <= 0.0 || d.z * u.to_sun.w <= 0.0 {
        return vec4f(0.0);
    }
    let noise = noise_at(place, dx, dy);
    let over = thickness(noise);
    let fade = horizon_fade(d.z);
    var opacity = 1.0 - exp(-u.cloud.y * over);
    let level = u.sun.rgb * max(u.to_sun.z, 0.0);
    var light = WHITE * (level + u.sky.rgb) / PI;
    if SHADING == TRACED {
        var gone = 0.0;
        let way = normalize(u.to_sun.xyz) * TRACED_WAY / f32(TRACED_STEPS);
        for (var i = 1u; i <= TRACED_STEPS; i++) {
            gone += thickness(noise_at(place + way * f32(i), dx, dy));
        }
        let reaches = exp(-TRACED_SHARE * u.cloud.y * gone / f32(TRACED_STEPS));
        light = WHITE * (level * reaches + u.sky.rgb) / PI;
    }
    if SHADING == BY_NORMAL {
        let h = BUMP_STEP;
        let slope = vec2f(
            noise_at(place + vec3f(h, 0.0, 0.0), dx, dy) - noise,
            noise_at(place + vec3f(0.0, h, 0.0), dx, dy) - noise,
        ) / h;
        let normal = normalize(vec3f(-slope * BUMPS, 1.0));
        light = WHITE * (u.sun.rgb * max(dot(normal, u.to_sun.xyz), 0.0) + u.sky.rgb) / PI;
    }
    if SHADING == AVERAGED {
        let one = textureSampleGrad(second_noise, repeating, place.xy + u.offset.xy, dx.xy, dy.xy).r;
        let other = textureSampleGrad(second_noise, repeating, place.xy * 1.3 + u.offset.zw, dx.xy, dy.xy).r;
        let shaded = 0.5 * (0.5 * (one + other) + opacity);
        light = (level + u.sky.rgb) / PI * clamp(0.5 * (1.0 + LIGHT_MULTIPLIER) * shaded - opacity * fade, 0.0, 1.0);
    }
    if SHADING == SLAB {
        // Limited, because deeper clouds look the same, and exponentials that are nearly 0 are slow.
        let depth = min(u.cloud.z * over, 60.0);
        // The path through the layer is longer at a slant, but limited by the layer's curvature.
        let slant = max(abs(normalize(d * t + vec3f(0.0, 0.0, u.sky.w)).z * d.z), 0.05);
        opacity = 1.0 - exp(-min(depth / slant, 60.0));
        light = of_slab(depth);
    }
    opacity *= fade;
    return vec4f(light * opacity, opacity) * vec4f(vec3f(1.0 / UNIT), 1.0);
}
