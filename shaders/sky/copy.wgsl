//!include "common/fullscreen.wgsl"
// Copies a table. With a blending target it fades one table into another.

@group(0) @binding(0) var copied: texture_2d<f32>;

// Copies texel by texel.
@fragment
fn copy(in: FullscreenVarying) -> @location(0) vec4f {
    return textureLoad(copied, vec2i(in.position.xy), 0);
}

// Numbers of sun angles and altitudes in the target. Those of the table that is read follow from its size.
override SUNS: u32 = 64u;
override ALTITUDES: u32 = 22u;
const LIGHT_TILES: u32 = 7u;

// Copies the table of light, tile by tile, from a table of another size. Values between its texels are interpolated as
// in look-ups. A table of the same size is copied exactly.
@fragment
fn light(in: FullscreenVarying) -> @location(0) vec4f {
    let px = vec2u(in.position.xy);
    let size = textureDimensions(copied) / vec2u(LIGHT_TILES, 1u);
    let tile = px.x / SUNS;
    let at = vec2u(px.x - tile * SUNS, px.y);
    let steps = vec2u(SUNS, ALTITUDES) - 1u;
    // Integer arithmetic, so that a position on a texel takes nothing of its neighbours.
    let scaled = at * (size - 1u);
    let first = min(scaled / steps, size - 2u);
    let part = vec2f(scaled - first * steps) / vec2f(steps);
    let corner = vec2u(tile * size.x, 0u) + first;
    let low = mix(textureLoad(copied, vec2i(corner), 0), textureLoad(copied, vec2i(corner + vec2u(1u, 0u)), 0), part.x);
    let high =
        mix(textureLoad(copied, vec2i(corner + vec2u(0u, 1u)), 0), textureLoad(copied, vec2i(corner + vec2u(1u, 1u)), 0), part.x);
    return mix(low, high, part.y);
}
