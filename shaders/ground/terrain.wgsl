// Terrain of the host at a point of a surface: its water, its normal and its classes.
//!include "ground/binding.wgsl"
//!include "snippets/welkin_ground.wgsl"

// Whether the host has given its terrain.
override TERRAIN: bool = false;
// Whether snow lies anywhere.
override SNOW: bool = false;

// Terrain of the host at a point of a surface.
struct TerrainPoint {
    // 1 on the terrain; 0 beyond it and on objects that stand on it.
    share: f32,
    // Water on the terrain (snippets/welkin_ground.wgsl).
    water: WelkinGround,
    // Unit normal of the terrain, (east, north, up).
    normal: vec3f,
    // Classes of the four nodes around the point.
    classes: vec4f,
    // Place of the point between the nodes, 0 to 1 east and north.
    part: vec2f,
    // x: depth of the snow, m. y: 1 where there is snow, else 0, or a value between near the edge of the snow. z:
    // wetness. w: albedo.
    snow: vec4f,
    // Gradient of the snow's depth, m per m, (east, north, up).
    drift: vec3f,
}

// Returns the values of a point that is not on the terrain.
fn no_terrain() -> TerrainPoint {
    return TerrainPoint(0.0, WelkinGround(0.0, 0.0, 0.0, 0.0, 0.0), vec3f(0.0, 0.0, 1.0), vec4f(0.0), vec2f(0.0), vec4f(0.0), vec3f(0.0));
}

// Returns (depth in m, 1, wetness, albedo) of the snow at a node; all 0 without snow.
fn snow_of(node: vec2i) -> vec4f {
    let snow = textureLoad(terrain_surface, node, 0);
    return vec4f(snow.x, vec3f(1.0, snow.zw) * select(0.0, 1.0, snow.x > 0.0));
}

// Returns the terrain at a point; `at` is camera-relative, (east, north, up).
fn terrain_at(at: vec3f) -> TerrainPoint {
    let p = vec4f(at, 1.0);
    let cells = vec2f(dot(ground.terrain_x, p), dot(ground.terrain_y, p));
    let inside = min(cells, ground.terrain_last - cells);
    let low = clamp(floor(cells), vec2f(0.0), ground.terrain_last - 1.0);
    let part = clamp(cells - low, vec2f(0.0), vec2f(1.0));
    let first = vec2i(low);
    let a = textureLoad(terrain_surface, first, 0);
    let b = textureLoad(terrain_surface, first + vec2i(1, 0), 0);
    let c = textureLoad(terrain_surface, first + vec2i(0, 1), 0);
    let d = textureLoad(terrain_surface, first + vec2i(1, 1), 0);
    let lies = mix(mix(a, b, part.x), mix(c, d, part.x), part.y);
    let off = abs(dot(ground.terrain_z, p) - lies.z);
    let on = 1.0 - smoothstep(ground.terrain_near, 2.0 * ground.terrain_near, off);
    let share = smoothstep(0.0, ground.terrain_rim, min(inside.x, inside.y)) * on;
    // Horizontal axes of the grid in the camera's east, north, up.
    let east = normalize(ground.terrain_x.xyz);
    let north = normalize(ground.terrain_y.xyz);
    var snow = vec4f(0.0);
    var drift = vec3f(0.0);
    if SNOW {
        // The rows of the snow follow those of the terrain's own values.
        let under = first + vec2i(0, i32(ground.terrain_last.y) + 1);
        let above = under + vec2i(0, 1);
        let corners = array(snow_of(under), snow_of(under + vec2i(1, 0)), snow_of(above), snow_of(above + vec2i(1, 0)));
        snow = mix(mix(corners[0], corners[1], part.x), mix(corners[2], corners[3], part.x), part.y);
        let eastward = mix(corners[1].x - corners[0].x, corners[3].x - corners[2].x, part.y);
        let northward = mix(corners[2].x - corners[0].x, corners[3].x - corners[1].x, part.x);
        // From rise per cell to rise per metre.
        drift = east * (eastward * length(ground.terrain_x.xyz)) + north * (northward * length(ground.terrain_y.xyz));
        // Nodes without snow do not count in the means of the snow's wetness and albedo.
        snow = vec4f(snow.x, snow.yzw / max(snow.y, 1e-3));
    }
    let normal = normalize(ground.terrain_z.xyz - east * lies.x - north * lies.y);
    return TerrainPoint(share, welkin_ground_at(terrain_cells, cells), normal, vec4f(a.w, b.w, c.w, d.w), part, snow, drift);
}
