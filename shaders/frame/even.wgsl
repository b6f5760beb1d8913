// Coarse grid: sky, air and fog at every fourth pixel, for draws of pixels that are interpolated from it
// (src/frame/pixels/even.rs).

// Spacing of the grid's texels, pixels. The first texel lies one spacing before the picture's first pixel, the last
// texels beyond the picture's last pixel.
const EVEN_PIXELS: i32 = 4;
// Factor for light in the grid, besides frame.even_scale. With both factors, white lies in the middle of a half float's
// range.
const EVEN_WHITE: f32 = 64.0;
// Limit for light in the grid: greater values are too large for half floats.
const EVEN_MOST: f32 = 60000.0;

// Last texel at or before a pixel.
fn even_texel(pixel: vec2i) -> vec2i {
    return pixel / EVEN_PIXELS + 1;
}
