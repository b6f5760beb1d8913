// Encodes a picture of linear light by the sRGB curve, which the panel's renderer expects of its images.

@group(0) @binding(0) var picture: texture_2d<f32>;

@vertex
fn corner(@builtin(vertex_index) index: u32) -> @builtin(position) vec4f {
    return vec4f(f32((index << 1u) & 2u) * 2.0 - 1.0, 1.0 - f32(index & 2u) * 2.0, 0.0, 1.0);
}

@fragment
fn encode(@builtin(position) at: vec4f) -> @location(0) vec4f {
    let light = clamp(textureLoad(picture, vec2i(at.xy), 0).rgb, vec3f(0.0), vec3f(1.0));
    let curve = 1.055 * pow(light, vec3f(1.0 / 2.4)) - 0.055;
    return vec4f(select(12.92 * light, curve, light > vec3f(0.0031308)), 1.0);
}
