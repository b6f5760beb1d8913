// The block of rain on cones; src/rain/cones.rs explains the model.

const CONES: u32 = 3u;
const STRETCHES: u32 = 4u;

struct ConeUniform {
    // Where the drops go as seen from the camera, and two directions across.
    axis: vec3f,
    // Fall speed with which shelters are asked, m/s: the harmonic mean, since wind drives drops as far as they take
    // time to fall.
    fall: f32,
    east: vec3f,
    // Nearest cone that shows anything.
    first: u32,
    north: vec3f,
    // The cone that has two sets, if any has.
    growing: u32,
    // Per cone: near end, far end and middle of its band, m; optical depth of its drops.
    bands: array<vec4f, CONES>,
    // Per cone, at right angles to the axis. x: tiles in a turn about the axis. y: tiles in a radian of Mercator's
    // latitude. z: drops per steradian. w: upper bound of y; above it streaks would be shorter than a pixel.
    shapes: array<vec4f, CONES>,
    // Per cone: share of the light of its middle that what lies between lets through; level of detail at right angles
    // to the axis; how often its tiles can be halved.
    looks: array<vec4f, CONES>,
    // Ends of the stretches along a ray of which it is asked what keeps rain off: a band each, the outermost in two
    // halves, m.
    stretches: array<vec4f, STRETCHES>,
    // Per cone a set of streaks, and the one that grows in the place of one of them: how far it has come, in latitude;
    // share of the drops; offset.
    sets: array<vec4f, 4>,
}

@group(1) @binding(0) var<uniform> cones: ConeUniform;
