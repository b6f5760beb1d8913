// Tests, for the cones, which places along rays rain reaches past shelters. The rays form a coarse grid over the
// picture. Whether rain reaches a place on a ray depends only on the ray and the distance, not on the host's picture.
// The cones can therefore interpolate between the grid's rays up to any depth (rain/cones.wgsl).
//!include "common/fullscreen.wgsl"
//!include "rain/drops.wgsl"
//!include "rain/cone_block.wgsl"

// Per stretch: the open shares of its four quarters, near to far. A share is 1 if the mean drop arrives, and 0 if a box
// or an occluder map shelters the place.
struct OpenParts {
    @location(0) first: vec4f,
    @location(1) second: vec4f,
    @location(2) third: vec4f,
    @location(3) fourth: vec4f,
}

// Returns the open shares of stretch `j` along `d`. `between` is the angle from one ray of the grid to the next.
fn open_quarters(j: u32, d: vec3f, between: f32) -> vec4f {
    let stretch = cones.stretches[j];
    let velocity = rain.wind - vec3f(0.0, 0.0, cones.fall);
    var open = vec4f(1.0);
    for (var i = select(0u, 4u, j < cones.first); i < 4u; i++) {
        // The first quarter is tested at its near end, because it stands for the places behind that end. The other
        // quarters are tested in their middles.
        let at = select((f32(i) + 0.5) * 0.25, 0.0, i == 0u);
        let range = mix(stretch.x, stretch.y, at);
        // Boxes are widened by the distance between rays. The rain that a pixel interpolates from the rays around it is
        // then never more than arrives on its own ray.
        let shut = sheltered_nearby(d * range, velocity, range * between, true);
        open = select(open, vec4f(0.0), vec4u(select(4u, i, shut)) == vec4u(0u, 1u, 2u, 3u));
    }
    return open;
}

// Returns the open shares of all stretches along a ray of the grid.
@fragment
fn open_fragment(in: FullscreenVarying) -> OpenParts {
    let ndc = vec2f(in.uv.x * 2.0 - 1.0, (1.0 - in.uv.y * 2.0) * rain.y_sign);
    let d = view_ray(rain.depth, ndc).direction;
    let between = length(vec2f(length(dpdx(d)), length(dpdy(d))));
    return OpenParts(
        open_quarters(0u, d, between),
        open_quarters(1u, d, between),
        open_quarters(2u, d, between),
        open_quarters(3u, d, between),
    );
}
