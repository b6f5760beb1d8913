// The glow between the stars, drawn on a sphere of directions: airglow, zodiacal light, the Milky Way, and the effect
// of the air on them. The f64 reference is NightSky in src/stars/glow.rs.

struct GlowUniform {
    // Matrix from camera-relative (east, north, up) to clip space.
    clip: mat4x4f,
    // Columns of the rotation from J2000.0 to (east, north, up).
    to_world: array<vec4f, 3>,
    // Luminance of 1 S10 (one star of magnitude 10 a square degree) of zodiacal light (`zodiacal`) and of starlight
    // (`starlight`), in the target's units, times the share of night.
    zodiacal: vec3f,
    // Square of the ratio of the eye's distance from the planet's centre to that of the airglow layer, less than 1.
    layer_ratio2: f32,
    starlight: vec3f,
    // 1 where row 0 of the target is the picture's top, -1 where it is the bottom.
    y_sign: f32,
    // Airglow straight up (`airglow`), and light of infinitely deep lit air (`lit_air`), in the target's units, times
    // the share of night.
    airglow: vec3f,
    pad0: f32,
    lit_air: vec3f,
    pad1: f32,
    // Light that is seen where the air lets nothing through: the even sky times (1 - share of night), and lit air.
    base: vec3f,
    pad2: f32,
    // Transmittance of the air straight up, as a power of 2: its binary logarithm.
    zenith_power: vec3f,
    pad3: f32,
}

@group(0) @binding(0) var<uniform> glow: GlowUniform;

// Vertices pass the block's values on to the fragments: on software drivers a read of the block costs more than an
// interpolation.
struct GlowVarying {
    @builtin(position) position: vec4f,
    // Zodiacal light and starlight, less lit air, in the target's units; w: sine of the elevation.
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

// Length of a line of sight within the thin glowing layer relative to one straight up (van Rhijn 1921).
fn van_rhijn(sine_of_elevation: f32, layer_ratio2: f32) -> f32 {
    return inverseSqrt(1.0 - layer_ratio2 * (1.0 - sine_of_elevation * sine_of_elevation));
}

// Relative air mass (Young 1994, Applied Optics 33, 1108, eq. 5). This law avoids the powers of the one in
// stars/points.wgsl, and differs from that one only where almost no light from above the air is left.
fn air_mass(sine: f32) -> f32 {
    return ((1.002432 * sine + 0.148386) * sine + 0.0096467) / (((sine + 0.149864) * sine + 0.0102963) * sine + 0.000303978);
}

@fragment
fn glow_fragment(in: GlowVarying) -> @location(0) vec4f {
    // A patch interpolates the direction along a chord, so its sine is up to 1 % too small, where neither law is steep.
    let sine = max(in.above.w, 0.0);
    let above = in.above.xyz + in.airglow.xyz * van_rhijn(sine, in.airglow.w);
    return vec4f(in.base + above * exp2(in.zenith_power * air_mass(sine)), 0.0);
}
