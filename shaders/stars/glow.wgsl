// The glow between the stars, on a ball of directions: airglow, zodiacal light, the Milky Way, and what the air does to
// them. The f64 twin is NightSky in src/stars/glow.rs.

struct GlowUniform {
    // Camera-relative east-north-up to clip.
    clip: mat4x4f,
    // Columns of the rotation from J2000.0 to east-north-up.
    to_world: array<vec4f, 3>,
    // The target's units of 1 S10 of zodiacal light and of starlight, times the night's share.
    zodiacal: vec3f,
    // Square of the distance of the eye from the planet's centre over that of the layer of airglow, less than 1.
    layer_ratio2: f32,
    starlight: vec3f,
    // 1 where row 0 of the target is the picture's top, -1 where it is the bottom.
    y_sign: f32,
    // Airglow straight up, and light of lit air without end, in the target's units, times the night's share.
    airglow: vec3f,
    pad0: f32,
    lit_air: vec3f,
    pad1: f32,
    // The rest of the sky where night has not come yet, and lit air: where no light comes through the air.
    base: vec3f,
    pad2: f32,
    // Powers of 2 that the air leaves straight up.
    zenith_power: vec3f,
    pad3: f32,
}

@group(0) @binding(0) var<uniform> glow: GlowUniform;

// What fragments read of the block is handed on by corners: software drivers take longer to read a block than to
// interpolate.
struct GlowVarying {
    @builtin(position) position: vec4f,
    // Zodiacal light and starlight less lit air, the target's units; the sine of the elevation.
    @location(0) above: vec4f,
    @location(1) @interpolate(flat) airglow: vec4f,
    @location(2) @interpolate(flat) base: vec3f,
    @location(3) @interpolate(flat) zenith_power: vec3f,
}

@vertex
fn glow_vertex(@location(0) direction: vec3f, @location(1) s10: vec2f) -> GlowVarying {
    let d = glow.to_world[0].xyz * direction.x + glow.to_world[1].xyz * direction.y + glow.to_world[2].xyz * direction.z;
    let clip = glow.clip * vec4f(d, 0.0);
    let above = glow.zodiacal * s10.x + glow.starlight * s10.y - glow.lit_air;
    return GlowVarying(
        vec4f(clip.x, clip.y * glow.y_sign, 0.0, clip.w),
        vec4f(above, d.z),
        vec4f(glow.airglow, glow.layer_ratio2),
        glow.base,
        glow.zenith_power,
    );
}

// How much more of the thin glowing layer a line of sight crosses than one straight up (van Rhijn 1921).
fn van_rhijn(sine_of_elevation: f32, layer_ratio2: f32) -> f32 {
    return inverseSqrt(1.0 - layer_ratio2 * (1.0 - sine_of_elevation * sine_of_elevation));
}

// Relative air mass (Young 1994, Applied Optics 33, 1108, eq. 5): without the powers of the points' law, from which it
// differs where nearly nothing of the light above the air is left.
fn air_mass(sine: f32) -> f32 {
    return ((1.002432 * sine + 0.148386) * sine + 0.0096467) / (((sine + 0.149864) * sine + 0.0102963) * sine + 0.000303978);
}

@fragment
fn glow_fragment(in: GlowVarying) -> @location(0) vec4f {
    // Within a patch the direction is a chord's: its sine is at most 1 % small, where neither law is steep.
    let sine = max(in.above.w, 0.0);
    let above = in.above.xyz + in.airglow.xyz * van_rhijn(sine, in.airglow.w);
    return vec4f(in.base + above * exp2(in.zenith_power * air_mass(sine)), 0.0);
}
