// How the clouds of a picture are spread over frames: each frame marches one pixel of a square of them.

// Of a square that was not in the last picture.
const LOST: f32 = 30000.0;

struct CloudsPicture {
    // Pixels of the picture; side of a square; which pixel of it is marched in this frame.
    size: vec2u,
    side: u32,
    place: u32,
    // From a place relative to the camera (east, north, up), m, to clip space as the last frame had it, before clouds
    // and camera moved.
    before: mat4x4f,
    // How far a cloud has come relative to the camera since the last frame, m; exposure now over that of the last
    // frame, 0 without history.
    moved: vec3f,
    exposed: f32,
}

// Of 1, 2 and 4 the power of 2: software drivers divide whole numbers one by one.
fn side_power(picture: CloudsPicture) -> u32 {
    return picture.side >> 1u;
}

// Which pixel of its square a frame marches, across and down.
fn marched_within(picture: CloudsPicture) -> vec2u {
    return vec2u(picture.place & (picture.side - 1u), picture.place >> side_power(picture));
}

// The pixel that a square shows.
fn marched_pixel(picture: CloudsPicture, square: vec2u) -> vec2u {
    return min(square * picture.side + marched_within(picture), picture.size - 1u);
}

fn pixel_ndc(picture: CloudsPicture, pixel: vec2u, y_sign: f32) -> vec2f {
    let uv = (vec2f(pixel) + 0.5) / vec2f(picture.size);
    return vec2f(uv.x * 2.0 - 1.0, (1.0 - uv.y * 2.0) * y_sign);
}

// Where a pixel stands among the marched ones, in texels.
fn among_marched(picture: CloudsPicture, pixel: vec2u) -> vec2f {
    return (vec2f(pixel) - vec2f(marched_within(picture))) / f32(picture.side) + 0.5;
}
