// Stones before a host's picture with several samples a pixel: its first stands for them.
//!include "rain/stones.wgsl"

@group(0) @binding(1) var host_depth: texture_multisampled_2d<f32>;

override HAS_DEPTH: bool = true;

fn depth_at(uv: vec2f) -> f32 {
    let size = vec2f(textureDimensions(host_depth));
    return textureLoad(host_depth, vec2i(min(uv * size, size - 1.0)), 0).r;
}

@vertex
fn falling_vertex(@builtin(vertex_index) corner: u32, @builtin(instance_index) instance: u32) -> StoneVarying {
    let stone = falling_stone(instance);
    if sheltered(stone.position, stone.velocity, true) {
        return no_stone();
    }
    return stone_corner(stone, corner);
}

@vertex
fn hopping_vertex(@builtin(vertex_index) corner: u32, @builtin(instance_index) instance: u32) -> StoneVarying {
    let touch = touch_of(instance);
    var z = stones.ground;
    var surface = vec3f(0.0);
    for (var i = 0u; i < SEARCH; i++) {
        let seen = seen_at(vec3f(touch.landing.xy, z));
        if touch.landing.fade <= 0.0 || seen.z == 0.0 {
            return no_stone();
        }
        surface = surface_of(seen.xy, depth_at(uv_of(seen.xy)));
        z = surface.z;
    }
    let fall = rain.wind - vec3f(0.0, 0.0, touch.kind.y * SPEED_UNIT);
    if !is_found(touch.landing, surface) || sheltered(above_ground(vec3f(touch.landing.xy, z)), fall, true) {
        return no_stone();
    }
    return stone_corner(hopping_stone(touch, z), corner);
}

@fragment
fn stone_fragment(in: StoneVarying) -> @location(0) vec4f {
    var range = RANGE_SKY;
    if HAS_DEPTH {
        let uv = in.position.xy / vec2f(textureDimensions(host_depth));
        let ndc = vec2f(uv.x * 2.0 - 1.0, (1.0 - uv.y * 2.0) * rain.y_sign);
        range = view_range(rain.depth, depth_at(uv), ndc);
    }
    return stone_color(in, range);
}
