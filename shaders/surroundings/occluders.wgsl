// Surfaces in the host's occluder maps, taken from any direction, and the test whether a path crosses one of them. Each
// texel holds the range of distances that its surface spans, each cell of 8 x 8 and of 64 x 64 texels the range of all
// texels in it (surroundings/occluder_map.wgsl). The path is traced from cell to cell and descends only into cells
// whose range it meets: a path before or behind all surfaces of a cell crosses none of them. A map does not contain
// surfaces that lie behind others, so a path may pass behind an edge. If a map is taken along the drops' direction of
// fall, drops meet none of the hidden surfaces.

// Whether there are any maps.
override MAPS: bool = false;

// Largest number of maps.
const MAX_MAPS: u32 = 4u;
// Largest number of cells tested per path. A path that needs more counts as free.
const MAP_STEPS: u32 = 192u;

// One map.
struct Occluder {
    // Rows of a transform of (east, north, up, 1), relative to the camera, m. `w` gives the clip w. `x` and `y` give w
    // times the column and w times the row in the table of ranges, texels. `distance` gives the distance along the axis
    // of the map's camera, m: from the middle of its near plane for parallel rays, from its position in perspective.
    x: vec4f,
    y: vec4f,
    w: vec4f,
    distance: vec4f,
    // Velocity of the map's content, (east, north, up), m/s; w is 1 if the content moves, else 0.
    velocity: vec4f,
    // Rectangle of the table that the map fills: its lowest corner (x, y) and its highest corner (z, w), texels.
    part: vec4f,
}

// All maps.
struct Occluders {
    // Number of maps.
    count: u32,
    pad: u32,
    // y: row of the table at which the cells of both sizes begin, below the texels; x: column at which the cells of
    // 64 x 64 texels begin.
    cells: vec2u,
    maps: array<Occluder, MAX_MAPS>,
}

@group(2) @binding(1) var<uniform> occluders: Occluders;
// Table of ranges (least, largest), m, as the bits of floats, because not all drivers can render to 32-bit floats.
@group(2) @binding(2) var map_ranges: texture_2d<u32>;

// Returns the range of distances of a cell. `level` 0: a texel; 1: a cell of 8 x 8 texels; 2: of 64 x 64.
fn range_of(level: u32, cell: vec2f) -> vec2f {
    let row = select(0u, occluders.cells.y, level > 0u);
    let column = select(0u, occluders.cells.x, level > 1u);
    return bitcast<vec2f>(textureLoad(map_ranges, vec2i(vec2u(cell) + vec2u(column, row)), 0).xy);
}

// Returns whether the path that led to `p` with `velocity` crosses a surface of map `i`.
fn crosses(i: u32, p: vec3f, velocity: vec3f) -> bool {
    let map = occluders.maps[i];
    let back = map.velocity.xyz - velocity;
    let at = vec4f(p, 1.0);
    // The values of the map's four rows s seconds before the path reaches `p` are a + s b.
    let a = vec4f(dot(map.x, at), dot(map.y, at), dot(map.w, at), dot(map.distance, at));
    let b = vec4f(dot(map.x.xyz, back), dot(map.y.xyz, back), dot(map.w.xyz, back), dot(map.distance.xyz, back));
    let sides = vec4f(a.xy - map.part.xy * a.z, map.part.zw * a.z - a.xy);
    let change = vec4f(b.xy - map.part.xy * b.z, map.part.zw * b.z - b.xy);
    let rate = select(change, vec4f(1e-9), abs(change) < vec4f(1e-9));
    let meet = -sides / rate;
    let enter = select(vec4f(0.0), meet, rate > vec4f(0.0));
    let leave = select(vec4f(1e9), meet, rate < vec4f(0.0));
    // The map contains nothing behind its camera.
    let near = (0.01 - a.w) / select(b.w, 1e-9, abs(b.w) < 1e-9);
    let begin = max(max(max(enter.x, enter.y), max(enter.z, enter.w)), select(0.0, near, b.w >= 0.0));
    let end = min(min(min(leave.x, leave.y), min(leave.z, leave.w)), select(1e9, near, b.w < 0.0));
    let inside = end > begin && begin < 1e8;

    let apart = 1.0 / max(-b.w, 0.2 * length(back));
    var s = begin;
    let onward = b.xy * a.z - a.xy * b.z;
    let ahead = select(vec2f(0.0), vec2f(1.0), onward > vec2f(0.0));
    var level = 2u;
    var crossed = false;
    for (var k = select(MAP_STEPS, 0u, inside); k < MAP_STEPS; k++) {
        let size = f32(1u << (3u * level));
        // A point slightly beyond the edge that the path has reached.
        let place = (a.xy + s * b.xy) / (a.z + s * b.z) + sign(onward) * 0.004;
        let cell = floor(clamp(place, map.part.xy, map.part.zw - 0.004) / size);
        let edge = (cell + ahead) * size;
        let slope = edge * b.z - b.xy;
        let until = select(vec2f(1e9), (a.xy - edge * a.z) / slope, abs(slope) > vec2f(1e-9));
        let next = max(s, min(min(until.x, until.y), end));
        let distance = a.w + vec2f(s, next) * b.w;
        let range = range_of(level, cell);
        if level == 0u && s == 0.0 && a.w <= range.y {
            // A path that starts on a surface must first get clear of it: the test begins before the near end of the
            // texel's range, by the length of this range.
            s = max((a.w - 2.0 * range.x + range.y) * apart, 1e-6);
        } else if min(distance.x, distance.y) <= range.y && max(distance.x, distance.y) >= range.x {
            if level == 0u {
                crossed = true;
                break;
            }
            level -= 1u;
        } else {
            if next >= end {
                break;
            }
            // Goes up one level where the path enters another cell of the upper level.
            let beside = cell + select(vec2f(sign(onward.x), 0.0), vec2f(0.0, sign(onward.y)), until.y < until.x);
            level = select(level, min(level + 1u, 2u), any(floor(beside / 8.0) != floor(cell / 8.0)));
            s = next;
        }
    }
    return crossed;
}
