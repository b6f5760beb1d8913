// Water on the host's terrain at a point of a surface.
//!include "frame/ground_binding.wgsl"

struct TerrainPoint {
    // 1 on the terrain, 0 beyond it and on what stands above it.
    share: f32,
    // As GroundUniform has them of all the ground.
    soaked: f32,
    film_level: f32,
    // Of standing water, mm; negative where there is none.
    depth: f32,
}

// `at`: camera-relative east, north, up.
fn terrain_at(at: vec3f) -> TerrainPoint {
    let p = vec4f(at, 1.0);
    let cells = vec2f(dot(ground.terrain_x, p), dot(ground.terrain_y, p));
    let inside = min(cells, ground.terrain_last - cells);
    let low = clamp(floor(cells), vec2f(0.0), ground.terrain_last - 1.0);
    let part = clamp(cells - low, vec2f(0.0), vec2f(1.0));
    let first = vec2i(low);
    let south = mix(textureLoad(terrain_cells, first, 0), textureLoad(terrain_cells, first + vec2i(1, 0), 0), part.x);
    let north = mix(textureLoad(terrain_cells, first + vec2i(0, 1), 0), textureLoad(terrain_cells, first + vec2i(1, 1), 0), part.x);
    let water = mix(south, north, part.y);
    let off = abs(dot(ground.terrain_z, p) - water.w);
    let on = 1.0 - smoothstep(ground.terrain_near, 2.0 * ground.terrain_near, off);
    return TerrainPoint(smoothstep(0.0, ground.terrain_rim, min(inside.x, inside.y)) * on, water.x, water.y, water.z);
}

// Share of a pixel under water this deep, mm: a puddle's edge is as thin as what grains of asphalt reach through.
fn pooled(depth: f32) -> f32 {
    return smoothstep(0.2, 2.0, depth);
}
