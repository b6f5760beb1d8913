// Pixels that each frame marches, one in a square, and reprojection from the last frame.

// Offset, pixels, of a square whose cloud was outside the last picture (FollowedSquare of follow.wgsl).
const LOST: f32 = 30000.0;

// Pixels that a frame marches, and its reprojection from the last frame.
struct CloudsPicture {
    // Size of the picture, pixels.
    size: vec2u,
    // Side of a square of pixels, of which each frame marches one.
    side: u32,
    // Index of the pixel in the square that this frame marches.
    place: u32,
    // Matrix from a place relative to the last frame's camera (east, north, up), m, to that frame's clip space. A place
    // relative to this frame's camera becomes such a place if `moved` is subtracted.
    before: mat4x4f,
    // Movement of a cloud relative to the camera since the last frame (east, north, up), m.
    moved: vec3f,
    // Ratio of this frame's exposure to the last one's, 0 without history.
    exposed: f32,
}

// Binary logarithm of the side, which is 1, 2 or 4. A shift by this logarithm replaces a division, because software
// drivers divide integers one by one.
fn side_power(picture: CloudsPicture) -> u32 {
    return picture.side >> 1u;
}

// Position within its square, across and down, of the pixel that a frame marches.
fn marched_within(picture: CloudsPicture) -> vec2u {
    return vec2u(picture.place & (picture.side - 1u), picture.place >> side_power(picture));
}

// Pixel of the picture that a frame marches in a square, limited to the picture's last row and column.
fn marched_pixel(picture: CloudsPicture, square: vec2u) -> vec2u {
    return min(square * picture.side + marched_within(picture), picture.size - 1u);
}

// Position of a pixel's middle in normalized device coordinates.
fn pixel_ndc(picture: CloudsPicture, pixel: vec2u, y_sign: f32) -> vec2f {
    let uv = (vec2f(pixel) + 0.5) / vec2f(picture.size);
    return vec2f(uv.x * 2.0 - 1.0, (1.0 - uv.y * 2.0) * y_sign);
}

// Position of a pixel in the texture of the marched pixels, which has one texel for each square; in texels.
fn among_marched(picture: CloudsPicture, pixel: vec2u) -> vec2f {
    return (vec2f(pixel) - vec2f(marched_within(picture))) / f32(picture.side) + 0.5;
}
