// Blocks of the drawn sea. Places are on the map (east, north), m, from an anchor near the camera. src/sea/uniform.rs
// writes them.

const SEA_TILES: u32 = 3u;
// Texels along a tile's side.
const SEA_SIDE: f32 = 128.0;
const MOST_SEA_WAVES: u32 = 512u;
const MOST_SEA_REGIONS: u32 = 64u;
const MOST_OUTLINE_CORNERS: u32 = 64u;
const MOST_SEA_HULLS: u32 = 64u;
const MOST_WAKE_STATES: u32 = 64u;
const MOST_TRACK_STATES: u32 = 512u;

struct SeaTile {
    // Texture coordinates of the anchor.
    anchor: vec2f,
    // Cosine and sine of the tile's turn.
    turn: vec2f,
    // Length, m.
    length: f32,
    // Fall of the mean level because crests are narrow, m. The surface is raised by as much.
    lowering: f32,
    // 1 for a tile with waves, 0 for one without.
    is_there: f32,
    // Binary logarithm of the texels per metre.
    octaves: f32,
}

struct SeaFoam {
    // Weight of foam at each age: the share of the foam's first area that is left, times one factor for all ages.
    kept: vec4f,
    // Texture coordinates of the anchor in the fine pattern, and in the coarse one.
    lace: vec4f,
    // Streaks in two directions: texture coordinates of the anchor, and cosine and sine of the turn.
    streaks: array<vec4f, 2>,
    // Share of the second direction, and how far the wind gathers foam in streaks: 0 to 1.
    second: f32,
    gathered: f32,
    pad: vec2f,
}

struct SeaUniform {
    // Matrix from camera-relative (east, north, up) to clip space.
    clip: mat4x4f,
    // Place of the sea's level below the camera, camera-relative, m.
    foot: vec3f,
    // Height of the camera above the sea's level, m.
    height: f32,
    // Coefficients of a series for the camera-relative place of the sea's level by the place on the map, m from the
    // camera: linear to the east (`east`) and to the north (`north`), and quadratic for east east (`bend_xx`), east
    // north (`bend_xy`) and north north (`bend_yy`).
    east: vec3f,
    // Number of single waves.
    waves: u32,
    north: vec3f,
    // Angle of a pixel, rad.
    pixel: f32,
    bend_xx: vec3f,
    // Compression from which on the surface is under foam.
    foam_from: f32,
    bend_xy: vec3f,
    // Variance of the compression of all waves.
    compression: f32,
    bend_yy: vec3f,
    // Optical depth of the fog straight up.
    fog_depth: f32,
    // Place of the camera.
    eye: vec2f,
    // Largest luminance, cd/m^2.
    most: f32,
    // Variance of slopes that stands for the disc of sun or moon.
    disc2: f32,
    // Unit vector towards the sun or the moon (`to_lamp`), and the light of this lamp on a surface that faces it
    // (`lamp_lux`), lux.
    to_lamp: vec3f,
    // Refractive index of the water.
    index: f32,
    lamp_lux: vec3f,
    // Reciprocal of the number of octaves from the camera's height to the distance up to which the sea is drawn.
    seen_per_octave: f32,
    // Light of the sky on level ground, lux.
    sky_lux: vec3f,
    // Ratio of the variance of the drawn waves' compression to the variance of their slopes.
    squeeze: f32,
    // Luminance of the light that leaves the water when seen from above, cd/m^2.
    body: vec3f,
    pad_c: f32,
    // Luminance of a white surface, cd/m^2.
    white: vec3f,
    pad_d: f32,
    // x, y, z: covariances of all slopes, with those of ripples too short to be drawn: east east, east north, north
    // north. w: sum of the two variances of the slopes that are drawn.
    slopes: vec4f,
    tiles: array<SeaTile, 3>,
    foam: SeaFoam,
}

// A single wave.
struct SeaWave {
    // Wave vector, turns per metre.
    turns: vec2f,
    // Phase at the anchor, turns.
    phase: f32,
    // Amplitude of the height, m.
    height: f32,
    // Length of the wave vector, turns per metre, and length of the wave, m.
    turns_per_m: f32,
    length: f32,
    // Factor by which the wave vector gives the amplitude of the displacement, m^2.
    shift: f32,
    // Sine and cosine of the change of phase from one age of foam to the next, signed numbers of 16 bits each.
    age_step: u32,
}

@group(2) @binding(0) var<uniform> sea: SeaUniform;
// Single waves, from long to short.
@group(2) @binding(1) var<uniform> sea_waves: array<SeaWave, 512>;
// B-spline coefficients of height and displacement along a tile's axes, m.
@group(2) @binding(2) var sea_shapes: texture_2d_array<f32>;
// Slopes along a tile's axes, and compression, which is smoother.
@group(2) @binding(3) var sea_slopes: texture_2d_array<f32>;
// Mean reflectance. Columns: square root of the cosine of the view's zenith angle. Rows: root mean square slope.
@group(2) @binding(4) var sea_reflectance: texture_2d<f32>;
@group(2) @binding(5) var sea_repeating: sampler;
@group(2) @binding(6) var sea_clamped: sampler;
// Table of shown slopes, by distance from the eye (columns) and direction (rows). First layer: covariances of the
// slopes that a pixel shows (east east, east north, north north), and half the variance of those that are not in the
// mesh. Second layer: variance of the slopes that make foam.
@group(2) @binding(7) var sea_seen: texture_2d_array<f32>;
// Ranks of the pattern of foam.
@group(2) @binding(8) var sea_lace: texture_2d<f32>;

// A region of the sea.
struct SeaRegion {
    // Place of the anchor, m to the right and ahead of the centre.
    anchor: vec2f,
    // Square of the distance of the farthest corner from the centre, m^2.
    reach2: f32,
    // 0 for a region without water, 1 for one with lower waves, 2 for a lake.
    kind: u32,
    // Ways to the right and ahead, m, for a metre to the east on the map (x, y), and for a metre to the north (z, w).
    turn: vec4f,
    // Number of corners.
    corners: u32,
    // Ratio of the height of waves to that around the region.
    wave_share: f32,
    // Width of the band over which waves become lower, m.
    rim: f32,
    pad: f32,
}

// Regions that the camera may see.
@group(2) @binding(9) var<uniform> sea_regions: array<SeaRegion, 64>;
// Corners of a region in each row, m to the right and ahead of its centre.
@group(2) @binding(10) var sea_outlines: texture_2d<f32>;

// A wake of a hull.
struct SeaWake {
    // Middle of a circle around the whole wake, and the square of its radius, m^2.
    middle: vec2f,
    reach2: f32,
    // Number of states of the wake's hull.
    states: u32,
    // Hull: length and beam of the waterline and draught, m.
    length: f32,
    beam: f32,
    draught: f32,
    // Ages of the wake's newest and oldest waves, s.
    newest: f32,
    oldest: f32,
    // Wave number of the longest waves, turns per metre.
    least_turns: f32,
    // Index of the hull's newest state in `sea_tracks`.
    first: u32,
    pad: f32,
}

// State of a hull.
struct HullState {
    place: vec2f,
    velocity: vec2f,
    age: f32,
    // Rate of turn, rad/s anticlockwise.
    turn: f32,
    ahead: vec2f,
}

// Wakes that the camera may see.
@group(2) @binding(11) var<uniform> sea_wakes: array<SeaWake, 64>;
// States of the hulls, each from new to old.
@group(2) @binding(12) var<uniform> sea_tracks: array<HullState, 512>;

// Blocks of the mesh that are drawn together.
struct SeaBand {
    // Single waves that the pixels of the blocks sum: index of the first, and of the one after the last.
    first: u32,
    last: u32,
    // Number of regions that may lie in the blocks.
    regions: u32,
    // 1 if there is sea outside regions, 0 if not.
    is_open: u32,
    // Number of wakes that may lie in the blocks.
    wakes: u32,
    pad_a: u32,
    pad_b: u32,
    pad_c: u32,
}

@group(3) @binding(0) var<uniform> sea_band: SeaBand;

// Turns a vector (east, north) into a tile's axes.
fn to_tile(turn: vec2f, v: vec2f) -> vec2f {
    return vec2f(turn.x * v.x + turn.y * v.y, turn.x * v.y - turn.y * v.x);
}

// Turns a vector in a tile's axes into (east, north).
fn from_tile(turn: vec2f, v: vec2f) -> vec2f {
    return vec2f(turn.x * v.x - turn.y * v.y, turn.y * v.x + turn.x * v.y);
}
