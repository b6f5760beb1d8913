// What keeps rain off, asked for the cones on a coarse grid over the picture: what comes to a place along a ray hangs
// on the ray and the distance alone, not on what the host drew there, so the cones look between the grid's rays
// (rain/cones.wgsl) and to any depth.
//!include "common/fullscreen.wgsl"
//!include "rain/drops.wgsl"
//!include "rain/cone_block.wgsl"

// Of each stretch the shares of its four quarters, near to far, that the mean drop comes to.
struct OpenParts {
    @location(0) first: vec4f,
    @location(1) second: vec4f,
    @location(2) third: vec4f,
    @location(3) fourth: vec4f,
}

// `between` is the angle from one ray of the grid to the next.
fn open_quarters(j: u32, d: vec3f, between: f32) -> vec4f {
    let stretch = cones.stretches[j];
    let velocity = rain.wind - vec3f(0.0, 0.0, cones.fall);
    var open = vec4f(1.0);
    for (var i = select(0u, 4u, j < cones.first); i < 4u; i++) {
        // The first at its near end: what it is asked for lies behind that.
        let at = select((f32(i) + 0.5) * 0.25, 0.0, i == 0u);
        let range = mix(stretch.x, stretch.y, at);
        // Boxes are as much wider as rays lie apart: what pixels take from the rays round them is never more than comes
        // to their own.
        let shut = sheltered_nearby(d * range, velocity, range * between, true);
        open = select(open, vec4f(0.0), vec4u(select(4u, i, shut)) == vec4u(0u, 1u, 2u, 3u));
    }
    return open;
}

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
