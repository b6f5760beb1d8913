// The host's terrain at a point of a surface: the water on it, how it lies and what it is made of.
//!include "ground/binding.wgsl"
//!include "snippets/welkin_ground.wgsl"

// Whether the host has given its terrain, and whether snow lies anywhere.
override TERRAIN: bool = false;
override SNOW: bool = false;

struct TerrainPoint {
    // 1 on the terrain, 0 beyond it and on what stands above it.
    share: f32,
    water: WelkinGround,
    normal: vec3f,
    // Classes of the four nodes about the point, and where it lies between them.
    classes: vec4f,
    part: vec2f,
    // Depth of the snow in m, whether there is any, its wetness and albedo.
    snow: vec4f,
    // How its surface rises over the ground along east and north, and up.
    drift: vec3f,
}

fn no_terrain() -> TerrainPoint {
    return TerrainPoint(0.0, WelkinGround(0.0, 0.0, 0.0, 0.0, 0.0), vec3f(0.0, 0.0, 1.0), vec4f(0.0), vec2f(0.0), vec4f(0.0), vec3f(0.0));
}

// Depth of the snow of a node; 1, wetness and albedo where there is any.
fn snow_of(node: vec2i) -> vec4f {
    let snow = textureLoad(terrain_surface, node, 0);
    return vec4f(snow.x, vec3f(1.0, snow.zw) * select(0.0, 1.0, snow.x > 0.0));
}

// `at`: camera-relative east, north, up.
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
    // The grid's own axes, as seen from the camera.
    let east = normalize(ground.terrain_x.xyz);
    let north = normalize(ground.terrain_y.xyz);
    var snow = vec4f(0.0);
    var drift = vec3f(0.0);
    if SNOW {
        // Below the terrain's own rows.
        let under = first + vec2i(0, i32(ground.terrain_last.y) + 1);
        let above = under + vec2i(0, 1);
        let corners = array(snow_of(under), snow_of(under + vec2i(1, 0)), snow_of(above), snow_of(above + vec2i(1, 0)));
        snow = mix(mix(corners[0], corners[1], part.x), mix(corners[2], corners[3], part.x), part.y);
        let eastward = mix(corners[1].x - corners[0].x, corners[3].x - corners[2].x, part.y);
        let northward = mix(corners[2].x - corners[0].x, corners[3].x - corners[1].x, part.x);
        // From a rise a cell to a rise a metre.
        drift = east * (eastward * length(ground.terrain_x.xyz)) + north * (northward * length(ground.terrain_y.xyz));
        // What has no snow has none of its properties.
        snow = vec4f(snow.x, snow.yzw / max(snow.y, 1e-3));
    }
    let normal = normalize(ground.terrain_z.xyz - east * lies.x - north * lies.y);
    return TerrainPoint(share, welkin_ground_at(terrain_cells, cells), normal, vec4f(a.w, b.w, c.w, d.w), part, snow, drift);
}
