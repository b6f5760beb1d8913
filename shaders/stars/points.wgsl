// Stars and planets as points of light. The f64 reference is src/stars/reference.rs, with the same names.
//!include "common/guarded.wgsl"
//!include "common/depth.wgsl"
//!include "common/host.wgsl"

struct StarUniform {
    depth: DepthUniform,
    // Matrix from camera-relative (east, north, up) to clip space.
    clip: mat4x4f,
    // Columns of the rotation from J2000.0 to (east, north, up).
    to_world: array<vec4f, 3>,
    // The Earth's velocity divided by the speed of light, in J2000.0.
    velocity: vec3f,
    // Units of the target per cd/m^2.
    scale: f32,
    // Optical depths of the air straight up.
    zenith_depth: vec3f,
    // Share of light that clouds and fog let through.
    transmittance: f32,
    // Size of the target, pixels.
    size: vec2f,
    // Solid angle of a pixel divided by the cube of clip w of a unit direction, sr.
    pixel_sr: f32,
    // 1 where row 0 of the target is the picture's top, -1 where it is the bottom.
    y_sign: f32,
    // Illuminance at the eye of the faintest star to draw, lux.
    faintest: f32,
    // Density of the air relative to that at 1010 hPa and 10 C, for refraction.
    air_density: f32,
    // Sine of the lowest elevation that the planet does not hide.
    horizon: f32,
    pad: f32,
}

@group(0) @binding(0) var<uniform> stars: StarUniform;
@group(0) @binding(1) var host_depth: HostDepth;

override HAS_DEPTH: bool = true;

// Half the width of a star's footprint, pixels.
const REACH: f32 = 2.0;
// Ratio of illuminance over which stars fade in, from the faintest drawn upwards: half a magnitude.
const FADE: f32 = 1.585;

// Cubic B-spline; its values at unit steps from any offset add up to 1.
fn spline(x: f32) -> f32 {
    let a = abs(x);
    let far = max(2.0 - a, 0.0);
    return select(far * far * far / 6.0, 2.0 / 3.0 - a * a * (1.0 - 0.5 * a), a < 1.0);
}

// Share of a star's light that falls on a pixel whose centre is `offset` pixels from the star.
fn weight(offset: vec2f) -> f32 {
    return spline(offset.x) * spline(offset.y);
}

// Refraction's lift, rad, at a true elevation, rad (Saemundsson 1986); equal to refraction_deg of
// src/almanac/celestial.rs.
fn refraction(elevation: f32) -> f32 {
    let degrees = elevation * 57.29578;
    let h = max(degrees, -1.0);
    let arc_minutes = 1.02 / tan((h + 10.3 / (h + 5.11)) * 0.017453293);
    return max(arc_minutes * smoothstep(0.0, 1.0, (degrees + 4.0) / 3.0) * stars.air_density, 0.0) * 2.9088821e-4;
}

// Direction (east, north, up) after refraction.
fn lifted(direction: vec3f) -> vec3f {
    let level = length(direction.xy);
    let elevation = atan2(direction.z, level);
    let apparent = elevation + refraction(elevation);
    let up = vec3f(direction.xy * (cos(apparent) / max(level, 1e-6)), sin(apparent));
    return select(up, direction, level < 1e-4);
}

// Relative air mass for the sine of an apparent elevation (Kasten and Young 1989).
fn air_mass(sine: f32) -> f32 {
    let s = max(sine, 0.0);
    return 1.0 / (s + 0.50572 * pow(asin(min(s, 1.0)) * 57.29578 + 6.07995, -1.6364));
}

struct StarVarying {
    @builtin(position) position: vec4f,
    // Radiance of a pixel that receives all of the star's light, in the target's units.
    @location(0) @interpolate(flat) light: vec3f,
    // Position of the star, pixels from the target's first corner.
    @location(1) @interpolate(flat) pixel: vec2f,
}

// One corner of the square of pixels that a star lights. `direction` is in J2000.0; `lux` is the illuminance above the
// air, lux a channel. A star that is not drawn gets a corner outside the picture.
@vertex
fn star_vertex(
    @builtin(vertex_index) corner: u32,
    @location(0) direction: vec3f,
    @location(1) lux: vec3f,
) -> StarVarying {
    let moved = normalize(direction + stars.velocity);
    let world = stars.to_world[0].xyz * moved.x + stars.to_world[1].xyz * moved.y + stars.to_world[2].xyz * moved.z;
    let seen = lifted(world);
    let clip = stars.clip * vec4f(seen, 0.0);
    let arriving = lux * exp(-stars.zenith_depth * air_mass(seen.z)) * stars.transmittance;
    let amount = dot(arriving, vec3f(0.212639, 0.7151687, 0.0721923));
    let fade = clamp((amount / max(stars.faintest, 1e-20) - 1.0) / (FADE - 1.0), 0.0, 1.0);
    let ndc = clip.xy / max(clip.w, 1e-9) * vec2f(1.0, stars.y_sign);
    let outside = any(abs(ndc) > 1.0 + 4.0 / stars.size);
    var out = StarVarying(vec4f(2.0, 2.0, 0.0, 1.0), vec3f(0.0), vec2f(0.0));
    if clip.w <= 1e-9 || outside || fade <= 0.0 || seen.z < stars.horizon {
        return out;
    }
    out.pixel = (0.5 + 0.5 * ndc * vec2f(1.0, -1.0)) * stars.size;
    out.light = arriving * (fade * stars.scale / (stars.pixel_sr * clip.w * clip.w * clip.w));
    let side = vec2f(select(-1.0, 1.0, (corner & 1u) != 0u), select(-1.0, 1.0, (corner & 2u) != 0u));
    out.position = vec4f(ndc + side * (2.0 * REACH / stars.size), 0.0, 1.0);
    return out;
}

// Whether the host has drawn nothing in front of the sky. In a multisampled depth the first sample counts.
fn is_open(position: vec2f) -> bool {
    if !HAS_DEPTH {
        return true;
    }
    let uv = position / stars.size;
    let texels = vec2f(textureDimensions(host_depth));
    let depth = textureLoad(host_depth, vec2i(clamp(uv * texels, vec2f(0.0), texels - 1.0)), 0).r;
    let ndc = vec2f(2.0 * uv.x - 1.0, stars.y_sign * (1.0 - 2.0 * uv.y));
    return view_range(stars.depth, depth, ndc) >= RANGE_SKY;
}

// Premultiplied colour with alpha 0: it is added to the target.
@fragment
fn star_fragment(in: StarVarying) -> @location(0) vec4f {
    let share = select(0.0, weight(in.position.xy - in.pixel), is_open(in.position.xy));
    // Limited to half the range of a half float, because two stars may fall on one pixel.
    return vec4f(capped(in.light * share, 3e4), 0.0);
}
