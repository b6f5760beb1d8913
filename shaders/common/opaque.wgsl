// What opaque things are drawn with: the frame, the pixels that the host keeps, and light in the host's numbers.
//!include "common/frame.wgsl"
//!include "common/tone.wgsl"

@group(0) @binding(1) var opaque_mask: texture_2d<f32>;

// Whether the host keeps the pixel (cab, HUD). Depth is written or not, so a mask between the two counts as the nearer.
fn is_kept(position: vec2f) -> bool {
    let pixel = min(vec2i(position), vec2i(textureDimensions(opaque_mask)) - 1);
    return textureLoad(opaque_mask, pixel, 0).r > 0.5;
}

// The number that the host's colour holds for a luminance, before weather is composed over it.
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
