// Uniform block of the drawn terrain. Axes of the lattice are east, north and up at the terrain's origin; cells are
// counted from the cell below the eye.

const MATERIALS: u32 = 7u;
const OCTAVES: u32 = 8u;

// Colours of a material, linear Rec. 709 albedo.
struct Material {
    albedo: vec4f,
    // Change of the colour by the fine and by the broad noise of amplitude 1.
    fine: vec4f,
    broad: vec4f,
}

// Place of one octave of the noise relative to the eye.
struct Octave {
    // Cell that holds the eye, and the seed.
    cell: vec4i,
    // Place of the eye in this cell, and cells per metre.
    place: vec4f,
    // Cosine and sine of the octave's angle; footprints of a pixel between which the octave fades out, m.
    turn: vec4f,
}

// Shadow maps, finest first.
const CASCADES: u32 = 4u;

// Square shadow map perpendicular to the light, around a centre near the eye. Places are in metres from the eye along
// the lattice's axes; depth 0 is farthest from the light.
struct Cascade {
    // Rows of the matrix from a place to texture coordinates and depth.
    u: vec4f,
    v: vec4f,
    depth: vec4f,
    // x: distance between depth 0 and 1, m. y: square of the map's side, divided by this distance, m. z: 1 / (1.2 x
    // half of the side), 1/m. w: distance from the centre, along the light, at depth 0, m.
    size: vec4f,
    // x: side of a texel in texture coordinates. y: side of a texel in units of depth. z: radius of the light's disc,
    // texels, for each unit of depth between a place and what hides the disc there. w: depth per metre.
    texel: vec4f,
}

// Constants of the shadows.
struct LandShadow {
    cascades: array<Cascade, 4>,
    // xy: light for which the maps are drawn: (1, 0) for the sun, (0, 1) for the moon, (0, 0) without maps. z: number
    // of maps.
    shaded: vec4f,
}

struct LandUniform {
    // Matrix from metres about the eye, along the lattice's axes, to clip space.
    clip: mat4x4f,
    // Columns of the rotation from the lattice's axes to east, north, up at the camera.
    to_local: array<vec4f, 3>,
    // x, y: place of the eye in its cell, cells. z, w: height of the eye above the terrain's origin, m, as a sum of two
    // floats.
    eye: vec4f,
    cell_m: f32,
    // Vertical distance in all distances: height of the eye above one reference height, cells.
    above: f32,
    // Weight of the horizontal distance in distances; 0 for parallel rays.
    spread: f32,
    // Altitude of the terrain's origin, m.
    altitude: f32,
    // Curvature of the planet, 1/m.
    curvature: f32,
    // 1 where the pages have colours of dug soil.
    has_dug: u32,
    // For each level: the distance at which its vertices begin to move, cells, and 1 over the distance over which they
    // move.
    levels: array<vec4f, 27>,
    // Directions to sun and moon in east, north, up at the camera; lux on a surface that faces them.
    sun: vec4f,
    sun_lux: vec4f,
    moon: vec4f,
    moon_lux: vec4f,
    // Light of the sky on level ground, and light that the ground reflects onto a surface that faces downwards, lux.
    sky_lux: vec4f,
    bounce_lux: vec4f,
    // Materials by class number.
    materials: array<Material, 7>,
    octaves: array<Octave, 8>,
    shadow: LandShadow,
}

@group(1) @binding(0) var<uniform> land: LandUniform;
// Heights of the vertices of each page.
@group(1) @binding(1) var page_heights: texture_2d<f32>;
// Slopes to the east and the north, on the page's level and on the next coarser one.
@group(1) @binding(2) var page_slopes: texture_2d<f32>;
// Shares of the classes: 0 to 3 in `page_classes`, 4 to 6 in `page_ground`, whose last channel is 1 where there is
// ground.
@group(1) @binding(3) var page_classes: texture_2d<f32>;
@group(1) @binding(4) var page_ground: texture_2d<f32>;
@group(1) @binding(5) var page_sampler: sampler;
// Albedo of dug soil times the share that it covers, and this share.
@group(1) @binding(6) var page_dug: texture_2d<f32>;
// Depths of the ground in the shadow maps, as seen from the light, to compare with and to read.
@group(1) @binding(7) var shadow_compared: texture_depth_2d_array;
@group(1) @binding(8) var shadow_depths: texture_2d_array<f32>;
// Depth nearest to the light in each block of SHADOW_BLOCK x SHADOW_BLOCK texels.
@group(1) @binding(9) var shadow_tops: texture_2d_array<f32>;
@group(1) @binding(10) var shadow_sampler: sampler_comparison;
