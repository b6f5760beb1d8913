// Shrinks a picture to means over squares of texels, in linear light. Drops on the glass show the scene many times
// smaller, so lens.wgsl samples these means in them.
//!include "common/fullscreen.wgsl"
//!include "common/tone.wgsl"

@group(0) @binding(0) var picture: texture_2d<f32>;

// Side of the square that becomes one texel of the result, texels of the picture.
override FACTOR: i32 = 8;
// Whether the texels of the picture are sRGB-encoded.
override ENCODED: bool = false;

// Returns a texel of the smaller picture: the mean of FACTOR x FACTOR texels.
@fragment
fn shrink(in: FullscreenVarying) -> @location(0) vec4f {
    let corner = vec2i(in.position.xy) * FACTOR;
    let last = vec2i(textureDimensions(picture)) - 1;
    var sum = vec3f(0.0);
    for (var y = 0; y < FACTOR; y++) {
        for (var x = 0; x < FACTOR; x++) {
            let texel = textureLoad(picture, min(corner + vec2i(x, y), last), 0).rgb;
            sum += select(texel, srgb_decode(texel), ENCODED);
        }
    }
    // 65504 is the largest number of rgba16float; the sun's disc may be brighter.
    return vec4f(clamp(sum / f32(FACTOR * FACTOR), vec3f(0.0), vec3f(65504.0)), 1.0);
}
