// Sky, air and fog at every fourth pixel, for draws of pixels that are interpolated between them
// (src/frame/pixels/even.rs).

// Pixels between texels of the grid. The first texel lies as much before the picture's first pixel, the last ones
// beyond its last.
const EVEN_PIXELS: i32 = 4;
// Light in the grid is multiplied by this and by frame.even_scale: white then lies in the middle of a half float's
// range.
const EVEN_WHITE: f32 = 64.0;
// What is lighter is too light for halves.
const EVEN_MOST: f32 = 60000.0;

// The texel whose place is at a pixel or before it.
fn even_texel(pixel: vec2i) -> vec2i {
    return pixel / EVEN_PIXELS + 1;
}
