// How the clouds of a picture are spread over frames: each frame marches one pixel of a square of them.

// Of a square that was not in the last picture.
const LOST: f32 = 30000.0;

struct CloudsPicture {
    // Pixels of the picture; side of a square; which pixel of it is marched in this frame.
    size: vec2u,
    side: u32,
    place: u32,
    // From a place relative to the camera (east, north, up), m, to clip space as the last frame had it, before clouds and camera moved.
    before: mat4x4f,
    // How far a cloud has come relative to the camera since the last frame, m; exposure now over that of the last frame, 0 without history.
    moved: vec3f,
    exposed: f32,
}

// The pixel that a square shows.
fn marched_pixel(picture: CloudsPicture, square: vec2u) -> vec2u {
    let within = vec2u(picture.place % picture.side, picture.place / picture.side);
    return min(square * picture.side + within, picture.size - 1u);
}

fn pixel_ndc(picture: CloudsPicture, pixel: vec2u, y_sign: f32) -> vec2f {
    let uv = (vec2f(pixel) + 0.5) / vec2f(picture.size);
    return vec2f(uv.x * 2.0 - 1.0, (1.0 - uv.y * 2.0) * y_sign);
}

// Where a pixel stands among the marched ones, in texels.
fn among_marched(picture: CloudsPicture, pixel: vec2u) -> vec2f {
    let within = vec2f(f32(picture.place % picture.side), f32(picture.place / picture.side));
    return (vec2f(pixel) - within) / f32(picture.side) + 0.5;
}
