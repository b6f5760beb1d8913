// Conversion of the host's colour to linear light by the host's colour space.
//!include "common/frame.wgsl"
//!include "common/tone.wgsl"

const SCENE_LINEAR: u32 = 0u;
const DISPLAY_SRGB: u32 = 2u;

// Colour spaces that a pipeline can draw, one bit each. A software driver computes every branch, so its pipelines have
// only one bit.
override COLOR_SPACES: u32 = 7u;
// Whether the pipeline may encode by the sRGB curve, and whether it may dither.
override ENCODES: bool = true;
override DITHERS: bool = true;

// Whether the host's colour has this space.
fn is_space(space: u32) -> bool {
    let bit = 1u << space;
    return COLOR_SPACES == bit || ((COLOR_SPACES & bit) != 0u && frame.color_space == space);
}

// Luminance from the colour of a scene-linear host, cd/m^2; for other hosts display-linear colour.
fn linear_host(host: vec3f) -> vec3f {
    if is_space(SCENE_LINEAR) {
        return host * frame.cd_m2_per_unit;
    }
    if is_space(DISPLAY_SRGB) {
        return srgb_decode(host);
    }
    return host;
}
