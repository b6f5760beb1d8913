// Stones before a host's picture with several samples a pixel: its first stands for them.
//!include "rain/drops_multi.wgsl"
//!include "rain/stones.wgsl"

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
    let surface = ground_below(touch.landing, stones.ground);
    let fall = rain.wind - vec3f(0.0, 0.0, touch.kind.y * SPEED_UNIT);
    if surface.w == 0.0 || sheltered(above_ground(vec3f(touch.landing.xy, surface.z)), fall, true) {
        return no_stone();
    }
    return stone_corner(hopping_stone(touch, surface.z), corner);
}

@fragment
fn stone_fragment(in: StoneVarying) -> @location(0) vec4f {
    return stone_color(in, range_at(in.position));
}
