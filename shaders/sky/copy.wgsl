//!include "common/fullscreen.wgsl"
// Copies a table; with a blending target, fades one into another.

@group(0) @binding(0) var copied: texture_2d<f32>;

// Texel by texel.
@fragment
fn copy(in: FullscreenVarying) -> @location(0) vec4f {
    return textureLoad(copied, vec2i(in.position.xy), 0);
}

// Sun angles and altitudes of the light that is drawn; those of the one that is read follow from its size.
override SUNS: u32 = 64u;
override ALTITUDES: u32 = 22u;
const LIGHT_TILES: u32 = 7u;

// The table of light, tile by tile, from one of another size: between its texels as look-ups would read it. Of one of
// the same size it is every texel itself.
@fragment
fn light(in: FullscreenVarying) -> @location(0) vec4f {
    let px = vec2u(in.position.xy);
    let size = textureDimensions(copied) / vec2u(LIGHT_TILES, 1u);
    let tile = px.x / SUNS;
    let at = vec2u(px.x - tile * SUNS, px.y);
    let steps = vec2u(SUNS, ALTITUDES) - 1u;
    // In whole numbers, so that a place on a texel has no part of its neighbours.
    let scaled = at * (size - 1u);
    let first = min(scaled / steps, size - 2u);
    let part = vec2f(scaled - first * steps) / vec2f(steps);
    let corner = vec2u(tile * size.x, 0u) + first;
    let low = mix(textureLoad(copied, vec2i(corner), 0), textureLoad(copied, vec2i(corner + vec2u(1u, 0u)), 0), part.x);
    let high =
        mix(textureLoad(copied, vec2i(corner + vec2u(0u, 1u)), 0), textureLoad(copied, vec2i(corner + vec2u(1u, 1u)), 0), part.x);
    return mix(low, high, part.y);
}
