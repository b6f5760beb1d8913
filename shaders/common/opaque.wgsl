// Functions for opaque objects: the frame's block, the host's mask, and the conversion of light to the host's values.
//!include "common/frame.wgsl"
//!include "common/tone.wgsl"

// Mask in the red channel: 1 keeps the host's pixel.
@group(0) @binding(1) var opaque_mask: texture_2d<f32>;

// Whether the mask (cab, HUD) keeps the host's pixel. Depth cannot be blended, so a mask value between 0 and 1 is
// rounded.
fn is_kept(position: vec2f) -> bool {
    let pixel = min(vec2i(position), vec2i(textureDimensions(opaque_mask)) - 1);
    return textureLoad(opaque_mask, pixel, 0).r > 0.5;
}

// Value of the host's colour for a luminance, before weather is composed over it.
fn host_number(luminance: vec3f) -> vec3f {
    if frame.color_space == 0u {
        return luminance / frame.cd_m2_per_unit;
    }
    let shown = tone_curve(frame.tone, luminance * frame.exposure);
    if frame.color_space == 1u {
        return shown;
    }
    return srgb_encode(shown);
}
