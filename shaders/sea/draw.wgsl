// The sea, drawn into the host's colour and depth.
//!include "sea/light.wgsl"

struct Varying {
    @builtin(position) position: vec4f,
    // Place at rest, m from the anchor.
    @location(0) at: vec2f,
    // Camera-relative position, m.
    @location(1) point: vec3f,
    @location(2) slope: vec2f,
    @location(3) squeeze: vec3f,
}

@vertex fn vertex(@location(0) block: vec4i, @builtin(vertex_index) index: u32) -> Varying {
    let at = rest_of(block, index);
    let here = sea_vertex(at);
    let point = sea_point(at + here.shift, here.height);
    return Varying(sea.clip * vec4f(point, 1.0), at, point, here.slope, here.squeeze);
}

fn shown(in: Varying) -> vec4f {
    if is_kept(in.position.xy) {
        discard;
    }
    drawn = vec4f(1.0);
    let light = sea_light(in.point, sea_slopes_at(in.at, in.slope, in.squeeze));
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
