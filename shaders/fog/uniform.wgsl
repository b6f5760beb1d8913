// A frame's fog as shaders read it: FogUniform of src/fog/uniforms.rs.

struct FogUniform {
    to_sun: vec3f,
    // Of the camera, m.
    altitude: f32,
    // Slab: altitudes where the flanks begin and end; exponential: reference altitude, scale height.
    knots: vec4f,
    // Extinction of each channel over that at 550 nm.
    ratio: vec3f,
    // At 550 nm, 1/m; density of the compatibility laws.
    extinction: f32,
    // Scaled optical depth over depth at 550 nm.
    scaling: vec3f,
    // From the layer's top to the ground, at 550 nm.
    depth_total: f32,
    // Slab: 1/height of the lower and the upper flank, 1/m; linear law: start and end, m.
    pair: vec2f,
    // Band of sky that the compatibility laws cover, rad.
    sky_band: f32,
    // 1 if they measure from the camera's plane.
    plane_distance: u32,
    // Phase function: ln of Henyey-Greenstein g, ln of Draine g, Draine alpha, weight of Draine.
    lobes: vec4f,
    // Distance of the camera from the planet's centre, m; 1e30 for a flat world.
    radius: f32,
    // 1/(planet radius + altitude), 1/m.
    curvature: f32,
    // Altitude at which rays without an object end, m.
    ground: f32,
    inverse_mu0: f32,
    // Diffusion exponent of absorbing layers.
    k: vec3f,
    absorbing: u32,
    // First scattering; colour of the compatibility laws.
    first: vec3f,
    patch_amount: f32,
    sky_radiance: vec3f,
    kind: u32,
    ground_radiance: vec3f,
    // Of the forward lobe in elevation, rad.
    spread: f32,
    // ln(1 - weight of Draine), sign of the Henyey-Greenstein g, share of scattering counted as forward, asymmetry of
    // the rest.
    scattering: vec4f,
    // Source terms c(mu) = [0] + mu [1].
    constant: array<vec4f, 2>,
    slope: array<vec4f, 2>,
    beam: array<vec4f, 2>,
    rise: array<vec4f, 2>,
    fall: array<vec4f, 2>,
    // Wave vector and phase at the camera.
    patch_waves: array<vec4f, 6>,
    // Of the curtains of rain (src/fog/patterns.rs), likewise.
    curtain_waves: array<vec4f, 8>,
    // What falls: extinction at 550 nm, 1/m; altitudes between which it falls off to nothing, m; 1/their distance, 1/m.
    falling: vec4f,
    // Share of the light above the layer that reaches the camera: that of the air inside it.
    lit: f32,
    // Amplitude of each wave of the curtains over the extinction of what falls.
    curtain_amount: f32,
    // Waves of the patches and of the curtains, 0 where there are none.
    waves: vec2u,
}

const DETOUR_SIDE: u32 = 24u;

// With how obstacles lead its patches (src/wind/detour.rs): LowAirUniform of src/fog/uniforms.rs.
struct LowAir {
    fog: FogUniform,
    // Cells a metre, and the cell of the camera: east, north.
    detour_scale: vec2f,
    detour_camera: vec2f,
    // Height of the map's floor over the camera, m; 1/height over it at which nothing is left of a detour, 1/m.
    detour_floor: f32,
    detour_fade: f32,
    // How far the air is behind at two nodes, m east and north: eastern neighbours beside each other, then northern.
    lags: array<vec4f, 288>,
}
