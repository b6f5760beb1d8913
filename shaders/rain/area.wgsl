// Columns of rain under rain areas: where their rain is. The f64 twin and the derivation are in src/rain/shaft.rs.

const MAX_AREAS: u32 = 16u;
const MAX_CORNERS: u32 = 8u;

// Some columns may have places in common.
override OVERLAPS: bool = true;
// Some have polygons for a plan.
override POLYGONS: bool = true;

// Axes: camera-relative east, north, up, m.
struct Column {
    center: vec2f,
    // How far the column moves aside a metre of height.
    lean: vec2f,
    // The way to the right on the plan, whose axes are right and ahead.
    right: vec2f,
    // Of an ellipse: half its extent.
    semi: vec2f,
    // Width over which the rain fades inside the border.
    rim: f32,
    // Heights at which the plan holds, and of the cloud.
    ground: f32,
    top: f32,
    // 1/m.
    extinction: f32,
    // How far the pattern has fallen, what turns its waves, and how much finer than others it is.
    fallen: f32,
    turn: f32,
    fine: f32,
    // What drops of it hide near the camera, 1/m.
    near: f32,
    // Of a polygon; 0 for an ellipse.
    corners: u32,
    // Later columns that may lie over it, a bit each.
    later: u32,
    radius: f32,
    // Depth below the cloud within which the rain sets in.
    soft: f32,
    // Sides: inward normal, offset; depth inside is normal . p + offset.
    edges: array<vec4f, MAX_CORNERS>,
}

struct Columns {
    count: u32,
    list: array<Column, MAX_AREAS>,
}

@group(0) @binding(7) var<uniform> columns: Columns;

// How many there are, cut as lights_binding.wgsl cuts a count.
fn column_count() -> u32 {
    return columns.count & 31u;
}

// From east and north to right and ahead.
fn column_turned(i: u32, v: vec2f) -> vec2f {
    let right = columns.list[i].right;
    return vec2f(dot(v, right), dot(v, vec2f(-right.y, right.x)));
}

// A camera-relative place on the plan.
fn column_plan(i: u32, p: vec3f) -> vec2f {
    let away = p.xy - columns.list[i].center - columns.list[i].lean * (p.z - columns.list[i].ground);
    return column_turned(i, away);
}

// How deep inside the border a place of the plan is, m.
fn column_depth(i: u32, q: vec2f) -> f32 {
    let semi = columns.list[i].semi;
    let k = q / semi;
    let k1 = length(k);
    let slope = k1 / max(length(k / semi), 1e-12);
    var depth = (1.0 - k1) * select(slope, min(semi.x, semi.y), k1 < 1e-4);
    if POLYGONS && columns.list[i].corners > 0u {
        depth = 1e9;
        for (var e = 0u; e < (columns.list[i].corners & 15u); e++) {
            let edge = columns.list[i].edges[e];
            depth = min(depth, dot(edge.xy, q) + edge.z);
        }
    }
    return depth;
}

// Share of the rain at a place that is the column's.
fn column_share(i: u32, p: vec3f) -> f32 {
    return smoothstep(0.0, columns.list[i].rim, column_depth(i, column_plan(i, p)));
}

// That with what lies over it taken off.
fn column_left(i: u32, p: vec3f) -> f32 {
    var share = column_share(i, p);
    if OVERLAPS {
        for (var j = i + 1u; j < column_count(); j++) {
            if (columns.list[i].later & (1u << j)) != 0u {
                share *= 1.0 - column_share(j, p);
            }
        }
    }
    return share;
}
