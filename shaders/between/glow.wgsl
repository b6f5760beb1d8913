// The glow of clouds in the light of lamps and flashes, below the picture of the second layer of the sky
// (between/hung.wgsl): a small picture of its own, since it does not stay from frame to frame as the clouds do.

// Rows of it, at most.
const GLOW_ROWS: f32 = 96.0;

// Texels of the glow of a picture.
fn glow_size(picture: vec2f) -> vec2f {
    let rows = min(picture.y, GLOW_ROWS);
    return vec2f(ceil(picture.x * rows / picture.y), rows);
}
