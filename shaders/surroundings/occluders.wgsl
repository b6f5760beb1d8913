// Surfaces that a host has taken pictures of, from any direction: whether a path crosses one of them. Each texel holds
// the range of distances that the surface in it spans, each cell of 8 and of 64 texels the range of all in it
// (surroundings/occluder_map.wgsl). A path is led from cell to cell and only looks into those whose range it meets:
// what lies before or behind all of a cell's surfaces crosses none of them. What a surface hides from the picture is
// not known, so a path may pass behind an edge; the drops' own direction, along which nothing is hidden that matters,
// is the best to take it from.

// Whether there are any.
override MAPS: bool = false;

const MAX_MAPS: u32 = 4u;
// Most looks at cells: a path through more is taken for free.
const MAP_STEPS: u32 = 192u;

struct Occluder {
    // Rows from camera-relative east-north-up to w times the place in the table of ranges, to w, and to the distance
    // from the map's camera, m.
    x: vec4f,
    y: vec4f,
    w: vec4f,
    distance: vec4f,
    // m/s; not 0 in the last: it moves.
    velocity: vec4f,
    // The map's part of the table: its lowest and its highest corner.
    part: vec4f,
}

struct Occluders {
    count: u32,
    pad: u32,
    // Where the cells of 64 and of 8 texels begin in the table.
    cells: vec2u,
    maps: array<Occluder, MAX_MAPS>,
}

@group(2) @binding(1) var<uniform> occluders: Occluders;
// The bits of floats: not all drivers draw into floats of 32 bits.
@group(2) @binding(2) var map_ranges: texture_2d<u32>;

// `level` 0: a texel; 1: a cell of 8; 2: of 64.
fn range_of(level: u32, cell: vec2f) -> vec2f {
    let row = select(0u, occluders.cells.y, level > 0u);
    let column = select(0u, occluders.cells.x, level > 1u);
    return bitcast<vec2f>(textureLoad(map_ranges, vec2i(vec2u(cell) + vec2u(column, row)), 0).xy);
}

// Whether the way that led to `p` with `velocity` crosses a surface of map `i`.
fn crosses(i: u32, p: vec3f, velocity: vec3f) -> bool {
    let map = occluders.maps[i];
    let back = map.velocity.xyz - velocity;
    let at = vec4f(p, 1.0);
    // Along the way all four are a + s b.
    let a = vec4f(dot(map.x, at), dot(map.y, at), dot(map.w, at), dot(map.distance, at));
    let b = vec4f(dot(map.x.xyz, back), dot(map.y.xyz, back), dot(map.w.xyz, back), dot(map.distance.xyz, back));
    let sides = vec4f(a.xy - map.part.xy * a.z, map.part.zw * a.z - a.xy);
    let change = vec4f(b.xy - map.part.xy * b.z, map.part.zw * b.z - b.xy);
    let rate = select(change, vec4f(1e-9), abs(change) < vec4f(1e-9));
    let meet = -sides / rate;
    let enter = select(vec4f(0.0), meet, rate > vec4f(0.0));
    let leave = select(vec4f(1e9), meet, rate < vec4f(0.0));
    // Nothing is known behind the map's camera.
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
        // A little further than the edge that it has come to.
        let place = (a.xy + s * b.xy) / (a.z + s * b.z) + sign(onward) * 0.004;
        let cell = floor(clamp(place, map.part.xy, map.part.zw - 0.004) / size);
        let edge = (cell + ahead) * size;
        let slope = edge * b.z - b.xy;
        let until = select(vec2f(1e9), (a.xy - edge * a.z) / slope, abs(slope) > vec2f(1e-9));
        let next = max(s, min(min(until.x, until.y), end));
        let distance = a.w + vec2f(s, next) * b.w;
        let range = range_of(level, cell);
        if level == 0u && s == 0.0 && a.w <= range.y {
            // What lies on a surface must first get away from it: by the depth of the range of its own texel.
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
            // Larger cells again where one of them ends.
            let beside = cell + select(vec2f(sign(onward.x), 0.0), vec2f(0.0, sign(onward.y)), until.y < until.x);
            level = select(level, min(level + 1u, 2u), any(floor(beside / 8.0) != floor(cell / 8.0)));
            s = next;
        }
    }
    return crossed;
}
