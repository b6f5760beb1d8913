// Copies a picture texel by texel to a window's image that can only be drawn to.
//!include "common/fullscreen.wgsl"

@group(0) @binding(0) var picture: texture_2d<f32>;

// Returns the texel of the picture at the same place.
@fragment
fn copy_texels(in: FullscreenVarying) -> @location(0) vec4f {
    return textureLoad(picture, vec2i(in.position.xy), 0);
}
