// Fog of a frame in the layout of shaders: FogUniform of src/fog/uniforms.rs.

// Fog of a frame: the light in the layer, its shape, and its patterns.
struct FogUniform {
    // Unit vector towards the sun, or the moon if it is brighter (east, north, up).
    to_sun: vec3f,
    // Altitude of the camera, m.
    altitude: f32,
    // Slab: altitudes where the flanks begin and end, m. Exponential layer: reference altitude, scale height, m.
    knots: vec4f,
    // Ratio of each channel's extinction to that at 550 nm.
    ratio: vec3f,
    // Extinction at 550 nm, 1/m; density of the compatibility laws.
    extinction: f32,
    // Ratio of each channel's delta-scaled optical depth to the depth at 550 nm.
    scaling: vec3f,
    // Optical depth from the layer's top to the ground, at 550 nm.
    depth_total: f32,
    // Slab: 1/height of the lower and the upper flank, 1/m. Linear law: start and end, m.
    pair: vec2f,
    // Height of the band of sky that the compatibility laws cover, rad.
    sky_band: f32,
    // 1 if the compatibility laws measure from the camera's plane, otherwise 0.
    plane_distance: u32,
    // Phase function: ln of Henyey-Greenstein |g|, ln of Draine |g|, Draine alpha, weight of Draine.
    lobes: vec4f,
    // Distance of the camera from the planet's centre, m; 1e30 for a flat world.
    radius: f32,
    // 1/(planet radius + altitude), 1/m; 0 for a flat world.
    curvature: f32,
    // Altitude at which rays without an object end, m.
    ground: f32,
    // 1/cosine of the sun's zenith angle.
    inverse_mu0: f32,
    // Diffusion exponent per channel of absorbing layers.
    k: vec3f,
    // 1 if the exponential terms `rise` and `fall` are used, otherwise 0.
    absorbing: u32,
    // First scattering, to be multiplied by the phase function and e^(-depth/mu0); colour of the compatibility laws.
    first: vec3f,
    // Strength of the patches, 0 to 1.
    patch_amount: f32,
    // Mean radiance of the sky above the layer.
    sky_radiance: vec3f,
    // Kind of the fog (FogKind of src/fog/model.rs).
    kind: u32,
    // Radiance of the ground below the layer.
    ground_radiance: vec3f,
    // Spread of the forward lobe in elevation, rad.
    spread: f32,
    // ln(1 - weight of Draine); sign of the Henyey-Greenstein g; share of scattering that counts as forward; asymmetry
    // of the rest.
    scattering: vec4f,
    // Constant source term c(mu) = [0] + mu [1] of scattered light, where mu is the cosine between the view direction
    // and up.
    constant: array<vec4f, 2>,
    // Source term per unit of scaled depth below the top.
    slope: array<vec4f, 2>,
    // Source term times e^(-depth/mu0).
    beam: array<vec4f, 2>,
    // Source term times e^(-k depth).
    rise: array<vec4f, 2>,
    // Source term times e^(-k (total - depth)).
    fall: array<vec4f, 2>,
    // Waves of the patches: wave vector, rad/m, and phase at the camera, rad.
    patch_waves: array<vec4f, 6>,
    // Waves of the curtains of rain: wave vector, rad/m, and phase at the camera, rad.
    curtain_waves: array<vec4f, 8>,
    // Precipitation: extinction at 550 nm, 1/m; altitudes between which it decreases to 0, m; 1/their difference, 1/m.
    falling: vec4f,
    // Light at the camera as a share of the light above the layer. Inside the layer, the light that clear air
    // scatters is reduced to this share.
    lit: f32,
    // Amplitude of each wave of the curtains, relative to the extinction of all that falls.
    curtain_amount: f32,
    // Numbers of waves of the patches and of the curtains; 0 if there are none.
    waves: vec2u,
}

// Nodes along a side of the map of detours.
const DETOUR_SIDE: u32 = 24u;

// Largest number of fog banks in a picture.
const MOST_BANKS: u32 = 8u;

// Fog bank: the low layer of a weather region, and the region's plan.
struct FogBank {
    // Layer, and its light.
    fog: FogUniform,
    // Unit vectors to the right and ahead on the plan, each (east, north).
    axes: vec4f,
    // Position of the camera on the plan, m (right, ahead).
    camera: vec2f,
    // Half extents of the shape, m.
    half: vec2f,
    // Radius of a rectangle's corners, m.
    corner: f32,
    // Width of the band outside the shape in which the bank fades, m.
    perimeter: f32,
    // Weight of the region inside its shape.
    strength: f32,
    // Distance of the shape's farthest point from its centre, m.
    radius: f32,
    // Kind of the shape: 0 a rectangle, 1 an ellipse, 2 a convex polygon, 3 another polygon.
    kind: u32,
    // Number of a polygon's corners.
    count: u32,
    // Banks whose regions may overlap that of this bank: bit j for bank j.
    overlaps: u32,
    // 1 if the region is averaged with earlier regions, 0 if it covers them.
    merges: u32,
    // Corners of a polygon, two to a vector, counter-clockwise if the polygon is convex.
    corners: array<vec4f, 8>,
}

// Fog, its banks and the detours of its patches round obstacles (src/wind/detour.rs): LowAirUniform of
// src/fog/uniforms.rs.
struct LowAir {
    // Fog of the frame outside all banks.
    fog: FogUniform,
    // Nodes of the map of detours per metre, east and north, 1/m.
    detour_scale: vec2f,
    // Position of the camera in the map, in nodes from its south-west corner, east and north.
    detour_camera: vec2f,
    // Altitude of the map's floor relative to the camera, m.
    detour_floor: f32,
    // 1/height above the floor at which detours end, 1/m.
    detour_fade: f32,
    // Numbers of all banks, and of those that the camera may see.
    bank_count: vec2u,
    // Lags at the nodes, m east and north: how much less far the wind has carried the air than free air. Each vector
    // has two nodes; nodes are in order from west to east, then south to north.
    lags: array<vec4f, 288>,
    // Indices of the banks that the camera may see, from far to near: four bits each, with the farthest bank in the
    // lowest bits.
    bank_order: u32,
    // Banks in the order of the world's regions.
    banks: array<FogBank, MOST_BANKS>,
}
