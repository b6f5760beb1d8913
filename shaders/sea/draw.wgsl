// The sea, drawn into the host's colour and depth.
//!include "sea/light.wgsl"

struct Varying {
    @builtin(position) position: vec4f,
    // Place at rest, and displaced, m from the anchor.
    @location(0) places: vec4f,
    // Camera-relative position, m.
    @location(1) point: vec3f,
    @location(2) slope: vec2f,
    @location(3) squeeze: vec3f,
    // Share under foam that earlier waves left.
    @location(4) left: f32,
}

@vertex fn vertex(@location(0) block: vec4i, @builtin(vertex_index) index: u32) -> Varying {
    let at = rest_of(block, index);
    let here = sea_vertex(at, sea_place(at).share);
    let place = at + here.shift;
    let point = sea_point(place, here.height + wake_height(at, place));
    return Varying(sea.clip * vec4f(point, 1.0), vec4f(at, place), point, here.slope, here.squeeze, here.left);
}

fn shown(in: Varying) -> vec4f {
    let place = sea_place(in.places.zw);
    if is_kept(in.position.xy) || !place.has_sea {
        discard;
    }
    drawn = vec4f(1.0);
    let at = in.places.xy;
    let wake = wake_shown(at, in.places.zw);
    var slopes = sea_slopes_at(at, in.slope, in.squeeze, place.share);
    slopes.slope += wake.slope;
    let light = sea_light(in.point, at, slopes, in.left, wake.foam);
    return vec4f(host_number(min(light, vec3f(sea.most))), 1.0);
}

@fragment fn plain(in: Varying) -> @location(0) vec4f {
    return shown(in);
}

struct WithDepth {
    @location(0) color: vec4f,
    @builtin(frag_depth) depth: f32,
}

@fragment fn logarithmic(in: Varying) -> WithDepth {
    return WithDepth(shown(in), written_depth(frame.depth, 1.0 / in.position.w));
}
