// Noise on a lattice of cells that repeats after `period` cells. The f64 twin is src/noise/reference.rs.
//
// A place is given as its cell and the fraction within it, so that both are exact in f32.

// Scrambles 32 bits, one to one (Wellons 2018, Prospecting for Hash Functions, lowbias32).
fn scramble(bits: u32) -> u32 {
    var v = bits;
    v = (v ^ (v >> 16u)) * 0x7feb352du;
    v = (v ^ (v >> 15u)) * 0x846ca68bu;
    return v ^ (v >> 16u);
}

// Weight of the far corner: first and second derivatives are 0 at both ends (Perlin 2002, Improving Noise, section 3).
fn fade2(t: vec2f) -> vec2f {
    return t * t * t * (t * (t * 6.0 - 15.0) + 10.0);
}

fn fade3(t: vec3f) -> vec3f {
    return t * t * t * (t * (t * 6.0 - 15.0) + 10.0);
}

// The plane's vectors: their greater and their lesser coordinate. They point 22.5 degrees off the axes and the
// diagonals, along which noise would show streaks. They are 1.25 long, with which noise deviates as much from its mean
// as it does in space.
const RAMP: vec2f = vec2f(1.1548494, 0.4783543);

// Product of `from_corner` with one of eight vectors.
fn ramp2(bits: u32, from_corner: vec2f) -> f32 {
    let along = RAMP * select(from_corner, from_corner.yx, (bits & 0x80000000u) != 0u);
    return select(along.x, -along.x, (bits & 0x40000000u) != 0u) + select(along.y, -along.y, (bits & 0x20000000u) != 0u);
}

// Product of `from_corner` with a vector to one of the twelve edges of a cube (Perlin 2002, section 4).
fn ramp3(bits: u32, from_corner: vec3f) -> f32 {
    let plane = ((bits >> 16u) * 3u) >> 16u;
    let u = select(from_corner.x, from_corner.y, plane == 2u);
    let v = select(from_corner.z, from_corner.y, plane == 0u);
    return select(u, -u, (bits & 1u) != 0u) + select(v, -v, (bits & 2u) != 0u);
}

// The cell after a cell on a ring of `period` cells. One by one: old GLSL chooses no integers by components.
fn after(cell: u32, period: u32) -> u32 {
    return select(cell + 1u, 0u, cell + 1u == period);
}

// Gradient noise in the plane, -0.85 to 0.85, 0 at the corners of cells (Perlin 2002).
fn gradient2(cell: vec2u, at: vec2f, period: vec2u, key: u32) -> f32 {
    let far = vec2u(after(cell.x, period.x), after(cell.y, period.y));
    let left = scramble(key + cell.x);
    let right = scramble(key + far.x);
    let t = fade2(at);
    let low = mix(
        ramp2(scramble(left + cell.y), at),
        ramp2(scramble(right + cell.y), at - vec2f(1.0, 0.0)),
        t.x,
    );
    let high = mix(
        ramp2(scramble(left + far.y), at - vec2f(0.0, 1.0)),
        ramp2(scramble(right + far.y), at - vec2f(1.0, 1.0)),
        t.x,
    );
    return mix(low, high, t.y);
}

// The four corners of a cell's face: `left` and `right` are the scrambled columns.
fn gradient_face(left: u32, right: u32, y: u32, far_y: u32, z: u32, at: vec3f, t: vec3f) -> f32 {
    let low = mix(
        ramp3(scramble(scramble(left + y) + z), at),
        ramp3(scramble(scramble(right + y) + z), at - vec3f(1.0, 0.0, 0.0)),
        t.x,
    );
    let high = mix(
        ramp3(scramble(scramble(left + far_y) + z), at - vec3f(0.0, 1.0, 0.0)),
        ramp3(scramble(scramble(right + far_y) + z), at - vec3f(1.0, 1.0, 0.0)),
        t.x,
    );
    return mix(low, high, t.y);
}

// Gradient noise in space, about -1 to 1, 0 at the corners of cells (Perlin 2002).
fn gradient3(cell: vec3u, at: vec3f, period: vec3u, key: u32) -> f32 {
    let far = vec3u(after(cell.x, period.x), after(cell.y, period.y), after(cell.z, period.z));
    let left = scramble(key + cell.x);
    let right = scramble(key + far.x);
    let t = fade3(at);
    let near_face = gradient_face(left, right, cell.y, far.y, cell.z, at, t);
    let far_face = gradient_face(left, right, cell.y, far.y, far.z, at - vec3f(0.0, 0.0, 1.0), t);
    return mix(near_face, far_face, t.z);
}

// The cells before, at and after a cell on a ring of `period` cells.
fn about(cell: u32, period: u32) -> vec3u {
    let last = period - 1u;
    return vec3u(select(cell - 1u, last, cell == 0u), cell, select(cell + 1u, 0u, cell == last));
}

// Coordinates of a cell's point are whole numbers of 10 bits: so many steps to its side.
const STEPS: f32 = 1024.0;

// The point of a cell, in steps. Numbers without a sign cost a software driver more to convert.
fn point_of(bits: u32) -> vec3f {
    return vec3f(vec3i(vec3u(bits & 1023u, (bits >> 10u) & 1023u, bits >> 22u)));
}

// The lesser of a squared distance and that to the point of a cell that begins `to_cell` away; in steps.
fn nearer2(nearest: f32, bits: u32, to_cell: vec2f) -> f32 {
    let to_point = point_of(bits).xy + to_cell;
    return min(nearest, dot(to_point, to_point));
}

fn nearer3(nearest: f32, bits: u32, to_cell: vec3f) -> f32 {
    let to_point = point_of(bits) + to_cell;
    return min(nearest, dot(to_point, to_point));
}

// The same of the three cells of a column of the plane, of which the middle one begins `to_cell` away. Here and below
// no loops: a software driver takes twice as long for them.
fn nearer_in_line(nearest: f32, column: u32, y: vec3u, to_cell: vec2f) -> f32 {
    let step = vec2f(0.0, STEPS);
    let before = nearer2(nearest, scramble(column + y.x), to_cell - step);
    return nearer2(nearer2(before, scramble(column + y.y), to_cell), scramble(column + y.z), to_cell + step);
}

// The same of three cells in a row along z.
fn nearer_in_row(nearest: f32, row: u32, z: vec3u, to_cell: vec3f) -> f32 {
    let step = vec3f(0.0, 0.0, STEPS);
    let before = nearer3(nearest, scramble(row + z.x), to_cell - step);
    return nearer3(nearer3(before, scramble(row + z.y), to_cell), scramble(row + z.z), to_cell + step);
}

// The same of three such rows along y.
fn nearer_in_column(nearest: f32, column: u32, y: vec3u, z: vec3u, to_cell: vec3f) -> f32 {
    let step = vec3f(0.0, STEPS, 0.0);
    let before = nearer_in_row(nearest, scramble(column + y.x), z, to_cell - step);
    let middle = nearer_in_row(before, scramble(column + y.y), z, to_cell);
    return nearer_in_row(middle, scramble(column + y.z), z, to_cell + step);
}

// 1 minus the distance to the nearest point, one point a cell, at least 0 (Worley 1996, F1). Points two cells away are
// farther than 1, so that the cells about this one are enough.
fn cellular2(cell: vec2u, at: vec2f, period: vec2u, key: u32) -> f32 {
    let x = about(cell.x, period.x);
    let y = about(cell.y, period.y);
    // A point lies in the middle of its step.
    let to_cell = 0.5 - STEPS * at;
    let step = vec2f(STEPS, 0.0);
    let before = nearer_in_line(STEPS * STEPS, scramble(key + x.x), y, to_cell - step);
    let middle = nearer_in_line(before, scramble(key + x.y), y, to_cell);
    let nearest = nearer_in_line(middle, scramble(key + x.z), y, to_cell + step);
    return 1.0 - sqrt(nearest) / STEPS;
}

// As `cellular2`, in space.
fn cellular3(cell: vec3u, at: vec3f, period: vec3u, key: u32) -> f32 {
    let x = about(cell.x, period.x);
    let y = about(cell.y, period.y);
    let z = about(cell.z, period.z);
    let to_cell = 0.5 - STEPS * at;
    let step = vec3f(STEPS, 0.0, 0.0);
    let before = nearer_in_column(STEPS * STEPS, scramble(key + x.x), y, z, to_cell - step);
    let middle = nearer_in_column(before, scramble(key + x.y), y, z, to_cell);
    let nearest = nearer_in_column(middle, scramble(key + x.z), y, z, to_cell + step);
    return 1.0 - sqrt(nearest) / STEPS;
}
