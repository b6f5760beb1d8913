// The glow between the stars, on a ball of directions: airglow, zodiacal light, the Milky Way, and what the air does to them. The f64
// twin is NightSky in src/stars/glow.rs.

struct GlowUniform {
    // Camera-relative east-north-up to clip.
    clip: mat4x4f,
    // Columns of the rotation from J2000.0 to east-north-up.
    to_world: array<vec4f, 3>,
    // The target's units of 1 S10 of airglow, zodiacal light and starlight.
    colors: array<vec4f, 3>,
    // Optical depths of the air straight up.
    zenith_depth: vec3f,
    // Airglow straight up, S10.
    airglow: f32,
    // Light of lit air without end, the target's units.
    lit_air: vec3f,
    // Square of the distance of the eye from the planet's centre over that of the layer of airglow.
    layer_ratio2: f32,
    // The sky where night has not come yet, the target's units, and how far it has.
    dusk: vec3f,
    share: f32,
    // 1 where row 0 of the target is the picture's top, -1 where it is the bottom.
    y_sign: f32,
    pad0: f32,
    pad1: f32,
    pad2: f32,
}

@group(0) @binding(0) var<uniform> glow: GlowUniform;

struct GlowVarying {
    @builtin(position) position: vec4f,
    // East, north, up.
    @location(0) direction: vec3f,
    // Zodiacal light and starlight, S10.
    @location(1) s10: vec2f,
}

@vertex
fn glow_vertex(@location(0) direction: vec3f, @location(1) s10: vec2f) -> GlowVarying {
    let d = glow.to_world[0].xyz * direction.x + glow.to_world[1].xyz * direction.y + glow.to_world[2].xyz * direction.z;
    let clip = glow.clip * vec4f(d, 0.0);
    return GlowVarying(vec4f(clip.x, clip.y * glow.y_sign, 0.0, clip.w), d, s10);
}

// How much more of the thin glowing layer a line of sight crosses than one straight up (van Rhijn 1921).
fn van_rhijn(sine_of_elevation: f32) -> f32 {
    return inverseSqrt(max(1.0 - glow.layer_ratio2 * (1.0 - sine_of_elevation * sine_of_elevation), 1e-3));
}

// Relative air mass (Young 1994, Applied Optics 33, 1108, eq. 5): without the powers of the points' law, from which it differs where
// nearly nothing of the light above the air is left.
fn air_mass(sine: f32) -> f32 {
    return ((1.002432 * sine + 0.148386) * sine + 0.0096467) / (((sine + 0.149864) * sine + 0.0102963) * sine + 0.000303978);
}

@fragment
fn glow_fragment(in: GlowVarying) -> @location(0) vec4f {
    let sine = max(normalize(in.direction).z, 0.0);
    let airglow = glow.airglow * van_rhijn(sine);
    let above = glow.colors[0].xyz * airglow + glow.colors[1].xyz * in.s10.x + glow.colors[2].xyz * in.s10.y;
    let left = exp(-glow.zenith_depth * air_mass(sine));
    let night = mix(glow.lit_air, above, left);
    return vec4f(mix(glow.dusk, night, glow.share), 0.0);
}
