// Size of the picture of the clouds' glow in the light of lamps and flashes. It lies below the picture in the second
// layer of the sky (between/hung.wgsl). It is separate from the clouds, because it is not kept from frame to frame.

// Largest number of rows.
const GLOW_ROWS: f32 = 96.0;

// Size of the glow for a picture, texels.
fn glow_size(picture: vec2f) -> vec2f {
    let rows = min(picture.y, GLOW_ROWS);
    return vec2f(ceil(picture.x * rows / picture.y), rows);
}
