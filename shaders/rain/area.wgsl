// Columns of rain under rain areas: the share of each column in the rain at a place. The f64 reference is
// src/rain/shaft.rs, which has the derivation.

// Largest number of rain areas.
const MAX_AREAS: u32 = 16u;
// Largest number of corners of a polygon.
const MAX_CORNERS: u32 = 8u;

// Whether columns may overlap.
override OVERLAPS: bool = true;
// Whether some areas are polygons.
override POLYGONS: bool = true;

// Column of an area: its plan carried up to the cloud along the slant of the falling drops.
struct Column {
    // Centre of the plan, east and north of the camera, m.
    center: vec2f,
    // Horizontal displacement of the column per metre of height.
    lean: vec2f,
    // Unit vector (east, north) along the plan's first axis, right; its second axis is ahead.
    right: vec2f,
    // Semi-axes of an ellipse, right and ahead, m.
    semi: vec2f,
    // Width, inside the border, over which the rain fades out, m.
    rim: f32,
    // Height at which the plan is given, and height of the cloud's base, relative to the camera, m.
    ground: f32,
    top: f32,
    // Extinction, 1/m.
    extinction: f32,
    // Distance that the pattern has fallen, m; phase offset of the pattern's waves, rad; factor by which the pattern of
    // a small area is finer, 1 to 10.
    fallen: f32,
    turn: f32,
    fine: f32,
    // Extinction of the drops that are drawn near the camera, 1/m.
    near: f32,
    // Number of corners of a polygon; 0 for an ellipse.
    corners: u32,
    // Later columns that may overlap this one: bit `j` is set for column `j`.
    later: u32,
    // Radius of a circle around the plan, m.
    radius: f32,
    // Depth below the cloud over which the rain sets in, m.
    soft: f32,
    // Sides of a polygon. x, y: inward unit normal. z: offset, m. A point p of the plan lies dot(normal, p) + offset
    // inside a side, m.
    edges: array<vec4f, MAX_CORNERS>,
}

// Block of columns, in the order of the host's list.
struct Columns {
    count: u32,
    list: array<Column, MAX_AREAS>,
}

@group(0) @binding(7) var<uniform> columns: Columns;

// Returns the number of columns, masked to the bits that its maximum needs, so that each loop ends whatever the block
// holds.
fn column_count() -> u32 {
    return columns.count & 31u;
}

// Turns (east, north) to (right, ahead).
fn column_turned(i: u32, v: vec2f) -> vec2f {
    let right = columns.list[i].right;
    return vec2f(dot(v, right), dot(v, vec2f(-right.y, right.x)));
}

// Returns the position (right, ahead) of a camera-relative place in the plan, m from its centre.
fn column_plan(i: u32, p: vec3f) -> vec2f {
    let away = p.xy - columns.list[i].center - columns.list[i].lean * (p.z - columns.list[i].ground);
    return column_turned(i, away);
}

// Returns how far inside the border a position in the plan lies, m; negative outside.
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

// Returns the share of the rain at a place that belongs to the column, regardless of other columns.
fn column_share(i: u32, p: vec3f) -> f32 {
    return smoothstep(0.0, columns.list[i].rim, column_depth(i, column_plan(i, p)));
}

// Returns the column's share of the rain at a place, less the shares of later columns that overlap it.
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
