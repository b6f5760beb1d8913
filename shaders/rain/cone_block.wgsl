// Uniform block of rain on cones; src/rain/cones.rs explains the model.

// Number of cones.
const CONES: u32 = 3u;
// Number of stretches of a ray that are tested for shelter.
const STRETCHES: u32 = 4u;

// Block of the cones.
struct ConeUniform {
    // Unit vector of the drops' mean motion relative to the camera; `east` and `north` are two unit vectors at right
    // angles to it.
    axis: vec3f,
    // Fall speed for the tests of shelter, m/s: the harmonic mean, because wind carries drops over a distance
    // proportional to the time of their fall.
    fall: f32,
    east: vec3f,
    // Index of the innermost cone that shows anything.
    first: u32,
    north: vec3f,
    // Index of the cone in which one set replaces another; CONES if there is none.
    growing: u32,
    // Per cone: near end, far end and middle of its band, m; optical depth of its drops.
    bands: array<vec4f, CONES>,
    // Per cone, for directions at right angles to the axis. x: number of tiles of the texture in a turn about the axis.
    // y: tiles in a radian of Mercator's latitude. z: drops per steradian. w: upper bound of y; above it streaks would
    // be shorter than a pixel.
    shapes: array<vec4f, CONES>,
    // Per cone. x: transmittance between the camera and the middle of the band. y: level of detail at right angles to
    // the axis. z: number of times that the tiles in a turn can be halved.
    looks: array<vec4f, CONES>,
    // Stretches of a ray that are tested for shelter: near end and far end, m. One per band, and two halves of the
    // outermost.
    stretches: array<vec4f, STRETCHES>,
    // Set of streaks of each cone, then the set that is growing. x: motion in Mercator's latitude since its birth. y:
    // share of the drops that it shows. z, w: offset in the texture, tiles.
    sets: array<vec4f, 4>,
}

@group(1) @binding(0) var<uniform> cones: ConeUniform;
