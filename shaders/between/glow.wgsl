// Size of the image of the glow: the light that lamps and flashes give the clouds. The second of the sky's layers
// (between/sky_sample.wgsl) has this image in the rows below the picture of the clouds. The glow is drawn anew every
// frame, and therefore apart from the clouds, which are kept from frame to frame.

// Largest number of rows of the glow's image.
const GLOW_ROWS: f32 = 96.0;

// Width and height of the glow's image, texels. `picture` is the size of the view's picture, pixels.
fn glow_size(picture: vec2f) -> vec2f {
    let rows = min(picture.y, GLOW_ROWS);
    return vec2f(ceil(picture.x * rows / picture.y), rows);
}
