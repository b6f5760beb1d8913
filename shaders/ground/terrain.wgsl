// Water on the host's terrain at a point of a surface.
//!include "frame/ground_binding.wgsl"
//!include "snippets/welkin_ground.wgsl"

struct TerrainPoint {
    // 1 on the terrain, 0 beyond it and on what stands above it.
    share: f32,
    water: WelkinGround,
}

// `at`: camera-relative east, north, up.
fn terrain_at(at: vec3f) -> TerrainPoint {
    let p = vec4f(at, 1.0);
    let cells = vec2f(dot(ground.terrain_x, p), dot(ground.terrain_y, p));
    let inside = min(cells, ground.terrain_last - cells);
    let low = clamp(floor(cells), vec2f(0.0), ground.terrain_last - 1.0);
    let part = clamp(cells - low, vec2f(0.0), vec2f(1.0));
    let first = vec2i(low);
    let south = mix(textureLoad(terrain_heights, first, 0).x, textureLoad(terrain_heights, first + vec2i(1, 0), 0).x, part.x);
    let north = mix(textureLoad(terrain_heights, first + vec2i(0, 1), 0).x, textureLoad(terrain_heights, first + vec2i(1, 1), 0).x, part.x);
    let off = abs(dot(ground.terrain_z, p) - mix(south, north, part.y));
    let on = 1.0 - smoothstep(ground.terrain_near, 2.0 * ground.terrain_near, off);
    let share = smoothstep(0.0, ground.terrain_rim, min(inside.x, inside.y)) * on;
    return TerrainPoint(share, welkin_ground_at(terrain_cells, cells));
}
