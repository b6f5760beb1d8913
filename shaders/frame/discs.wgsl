// The sun's and the moon's discs: limb darkening, phase, flattening near the horizon.
//!include "frame/uniform.wgsl"

// Radiance of the disc per unit irradiance on a surface facing it, 0 outside. Reddening is the caller's.
fn disc_radiance(light: FrameLight, d: vec3f) -> vec3f {
    if light.radius <= 0.0 {
        return vec3f(0.0);
    }
    // Angles across the disc in units of its radius; refraction squeezes the vertical one.
    let side = normalize(cross(light.apparent, vec3f(0.0, 0.0, 1.0)) + vec3f(1e-9, 0.0, 0.0));
    let above = cross(side, light.apparent);
    let offset = d - light.apparent;
    if dot(offset, offset) > 9.0 * light.radius * light.radius {
        return vec3f(0.0);
    }
    let x = dot(offset, side) / light.radius;
    let y = dot(offset, above) / (light.radius * light.flattening);
    let r2 = x * x + y * y;
    if r2 >= 1.0 {
        return vec3f(0.0);
    }
    let mean = 1.0 / (3.14159265 * light.radius * light.radius);
    let mu = sqrt(1.0 - r2);
    if light.lit >= 1.0 {
        return mean * limb_darkening(mu);
    }
    // The terminator is half an ellipse; the moon's face is near uniform (Lommel-Seeliger near full).
    let along = x * dot(light.bright_limb, side) + y * dot(light.bright_limb, above);
    let across = sqrt(max(1e-6, 1.0 - r2 + along * along));
    let edge = across * (1.0 - 2.0 * light.lit);
    let lit = smoothstep(-0.04, 0.04, along - edge);
    return vec3f(mean * mix(0.0004, 1.0 / max(light.lit, 0.01), lit));
}

// Share of the mean radiance at cosine mu from the disc's centre, per channel (R, G, B near 680, 550, 440 nm):
// power law of Hestroffer & Magnan 1998, I/I0 = mu^a, divided by its mean over the disc 2/(a + 2).
fn limb_darkening(mu: f32) -> vec3f {
    let a = vec3f(0.397, 0.503, 0.652);
    return pow(vec3f(max(mu, 1e-4)), a) * (a + 2.0) * 0.5;
}
