// Noise on a lattice of cells that repeats after `period` cells. The f64 reference is src/noise/reference.rs.
//
// A position is given as its cell and the fraction within the cell, so that both are exact in f32.

// Hashes 32 bits, one to one (Wellons 2018, Prospecting for Hash Functions, lowbias32).
fn scramble(bits: u32) -> u32 {
    var v = bits;
    v = (v ^ (v >> 16u)) * 0x7feb352du;
    v = (v ^ (v >> 15u)) * 0x846ca68bu;
    return v ^ (v >> 16u);
}

// Weight of the far corner. First and second derivatives are 0 at both ends (Perlin 2002, Improving Noise, section 3).
fn fade2(t: vec2f) -> vec2f {
    return t * t * t * (t * (t * 6.0 - 15.0) + 10.0);
}

fn fade3(t: vec3f) -> vec3f {
    return t * t * t * (t * (t * 6.0 - 15.0) + 10.0);
}

// Greater and lesser coordinate of the gradient vectors in two dimensions. They point 22.5 degrees off the axes and the
// diagonals, along which the noise would show streaks. Their length is 1.25: the noise then deviates from its mean as
// much as in three dimensions.
const RAMP: vec2f = vec2f(1.1548494, 0.4783543);

// Dot product of `from_corner` with one of eight gradient vectors.
fn ramp2(bits: u32, from_corner: vec2f) -> f32 {
    let along = RAMP * select(from_corner, from_corner.yx, (bits & 0x80000000u) != 0u);
    return select(along.x, -along.x, (bits & 0x40000000u) != 0u) + select(along.y, -along.y, (bits & 0x20000000u) != 0u);
}

// Dot product of `from_corner` with a vector to one of the twelve edges of a cube (Perlin 2002, section 4).
fn ramp3(bits: u32, from_corner: vec3f) -> f32 {
    let plane = ((bits >> 16u) * 3u) >> 16u;
    let u = select(from_corner.x, from_corner.y, plane == 2u);
    let v = select(from_corner.z, from_corner.y, plane == 0u);
    return select(u, -u, (bits & 1u) != 0u) + select(v, -v, (bits & 2u) != 0u);
}

// Next cell on a ring of `period` cells. One component at a time, because old GLSL has no component-wise select of
// integers.
fn after(cell: u32, period: u32) -> u32 {
    return select(cell + 1u, 0u, cell + 1u == period);
}

// Gradient noise in two dimensions, -0.85 to 0.85, 0 at the corners of cells (Perlin 2002).
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

// Interpolates the four corners of a cell's face; `left` and `right` are the hashes of the face's two coordinates along
// x.
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

// Gradient noise in three dimensions, about -1 to 1, 0 at the corners of cells (Perlin 2002).
fn gradient3(cell: vec3u, at: vec3f, period: vec3u, key: u32) -> f32 {
    let far = vec3u(after(cell.x, period.x), after(cell.y, period.y), after(cell.z, period.z));
    let left = scramble(key + cell.x);
    let right = scramble(key + far.x);
    let t = fade3(at);
    let near_face = gradient_face(left, right, cell.y, far.y, cell.z, at, t);
    let far_face = gradient_face(left, right, cell.y, far.y, far.z, at - vec3f(0.0, 0.0, 1.0), t);
    return mix(near_face, far_face, t.z);
}

// Previous, same and next cell on a ring of `period` cells.
fn about(cell: u32, period: u32) -> vec3u {
    let last = period - 1u;
    return vec3u(select(cell - 1u, last, cell == 0u), cell, select(cell + 1u, 0u, cell == last));
}

// Steps along a cell's side: a point's coordinates in its cell are whole numbers of 10 bits.
const STEPS: f32 = 1024.0;

// Point of a cell, in steps. Signed integers, because a software driver takes longer to convert unsigned ones.
fn point_of(bits: u32) -> vec3f {
    return vec3f(vec3i(vec3u(bits & 1023u, (bits >> 10u) & 1023u, bits >> 22u)));
}

// Lesser one of `nearest` and the squared distance to the point of the cell that begins at `to_cell`, in steps.
fn nearer2(nearest: f32, bits: u32, to_cell: vec2f) -> f32 {
    let to_point = point_of(bits).xy + to_cell;
    return min(nearest, dot(to_point, to_point));
}

fn nearer3(nearest: f32, bits: u32, to_cell: vec3f) -> f32 {
    let to_point = point_of(bits) + to_cell;
    return min(nearest, dot(to_point, to_point));
}

// `nearer2` for the three cells of a column in two dimensions; the middle cell begins at `to_cell`. There are no loops
// here and below, because with them a software driver takes twice as long.
fn nearer_in_line(nearest: f32, column: u32, y: vec3u, to_cell: vec2f) -> f32 {
    let step = vec2f(0.0, STEPS);
    let before = nearer2(nearest, scramble(column + y.x), to_cell - step);
    return nearer2(nearer2(before, scramble(column + y.y), to_cell), scramble(column + y.z), to_cell + step);
}

// `nearer3` for three cells in a row along z.
fn nearer_in_row(nearest: f32, row: u32, z: vec3u, to_cell: vec3f) -> f32 {
    let step = vec3f(0.0, 0.0, STEPS);
    let before = nearer3(nearest, scramble(row + z.x), to_cell - step);
    return nearer3(nearer3(before, scramble(row + z.y), to_cell), scramble(row + z.z), to_cell + step);
}

// `nearer_in_row` for three such rows along y.
fn nearer_in_column(nearest: f32, column: u32, y: vec3u, z: vec3u, to_cell: vec3f) -> f32 {
    let step = vec3f(0.0, STEPS, 0.0);
    let before = nearer_in_row(nearest, scramble(column + y.x), z, to_cell - step);
    let middle = nearer_in_row(before, scramble(column + y.y), z, to_cell);
    return nearer_in_row(middle, scramble(column + y.z), z, to_cell + step);
}

// Cellular noise in two dimensions: 1 minus the distance to the nearest point, at least 0, with one point per cell
// (Worley 1996, F1). Points two cells away are farther than 1, so only this cell and its neighbours are searched.
fn cellular2(cell: vec2u, at: vec2f, period: vec2u, key: u32) -> f32 {
    let x = about(cell.x, period.x);
    let y = about(cell.y, period.y);
    // A point is in the middle of its step.
    let to_cell = 0.5 - STEPS * at;
    let step = vec2f(STEPS, 0.0);
    let before = nearer_in_line(STEPS * STEPS, scramble(key + x.x), y, to_cell - step);
    let middle = nearer_in_line(before, scramble(key + x.y), y, to_cell);
    let nearest = nearer_in_line(middle, scramble(key + x.z), y, to_cell + step);
    return 1.0 - sqrt(nearest) / STEPS;
}

// Cellular noise in three dimensions, as `cellular2`.
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
