// Surface of the sea: displacement of the mesh, and the slopes that a pixel shows. src/sea/surface.rs is the f64
// reference of the waves' sums.
//
// The mesh has the share of a wave that its cells resolve. The slopes of a pixel have the rest of the wave, as far as
// the pixel resolves it. The slopes that neither has are known by their variance. Shares depend on the place alone and
// not on the level of the mesh, so that levels meet without cracks.
//!include "sea/mesh.wgsl"
//!include "sea/regions.wgsl"
//!include "sea/wakes.wgsl"

const SEA_TAU: f32 = 6.28318531;
const SEA_HALF_TAU: f32 = 3.14159265;
// Least ratio of the distance of a cell of the mesh to the cell's length.
const SEA_CELLS_TO_DISTANCE: f32 = 11.9;
// Length of a wave, in cells, below which its height is not in the mesh at all. From twice this length on, the height
// is wholly in the mesh.
const SEA_LEAST_CELLS: f32 = 1.5;
// Length of a wave, in cells, below which its slope is not in the vertices at all. From twice this length on, the slope
// is wholly in them. Between vertices that are farther apart, slopes would be too small.
const SEA_SMOOTH_CELLS: f32 = 3.0;
// Length, in cells, of a texel of the mip level of a tile that the mesh reads. The shortest waves there, three texels
// long, are low.
const SEA_TEXELS_TO_CELL: f32 = 0.25;
// Standard deviation of a pixel's filter as a share of the pixel's width.
const SEA_PIXEL_DEVIATION: f32 = 0.4;
// Largest ratio of the sides of a pixel on the surface up to which waves along the short side are told apart.
const SEA_MOST_LENGTHENED: f32 = 2.0;
// Compression that no sea has. Without whitecaps, the threshold of foam lies above it.
const SEA_NO_FOAM: f32 = 100.0;
// Least standard deviation of the compression that is known by its variance alone.
const SEA_LEAST_DEVIATION: f32 = 0.02;
// Mip level at which a tile shows no waves.
const SEA_FLAT_MIP: f32 = 5.0;

// Filter of a pixel on the level surface.
struct Footprint {
    // Unit vector from the camera, level.
    toward: vec2f,
    // Standard deviations along this vector and across it, m.
    along: f32,
    across: f32,
}

fn footprint_at(at: vec2f) -> Footprint {
    let from_eye = at - sea.eye;
    let level = length(from_eye);
    let range = length(vec2f(level, sea.height));
    let across = SEA_PIXEL_DEVIATION * sea.pixel * range;
    // Waves turn facets towards the eye, which shortens pixels near the horizon.
    let tilted = sqrt(sea.height * sea.height / (range * range) + 0.25 * sea.slopes.w);
    let toward = select(vec2f(1.0, 0.0), from_eye / max(level, 1e-6), level > 1e-6);
    return Footprint(toward, across / min(tilted, 1.0), across);
}

// Wave number, turns per metre, above which no single wave is told apart in a pixel.
fn last_turns(footprint: Footprint) -> f32 {
    return 0.39 / max(footprint.across, footprint.along / SEA_MOST_LENGTHENED);
}

// Share of a wave's amplitude that the pixel's filter lets through: (1 - x / 3)^2, where x is half the square of wave
// number, rad/m, times deviation, m. This is near exp(-x) but reaches 0. `along` and `across` are the filter's
// deviations with their directions. `end` is the ratio of the wave number to that above which no wave is told apart.
fn seen_share(turns: vec2f, along: vec2f, across: vec2f, end: f32) -> f32 {
    let a = dot(turns, along);
    let b = dot(turns, across);
    let left = max(1.0 - max(6.57973627 * (a * a + b * b), end * end), 0.0);
    return left * left;
}

// Surface at a vertex.
struct SeaVertex {
    // Displacement and height above the level, m.
    shift: vec2f,
    height: f32,
    // Rise that makes up for the narrowing of crests, m, for waves of their full height.
    raised: f32,
    // Slopes of the single waves that are smooth on the mesh, filtered by the pixel: of the height, and of the
    // displacement (xx, xy, yy).
    slope: vec2f,
    squeeze: vec3f,
    // Share under the foam that waves of the last seconds left.
    left: f32,
}

// Share of the upper tail of the normal distribution (Page 1977).
fn upper_tail(x: f32) -> f32 {
    let y = x * (1.5976 + 0.070566 * x * x);
    return 1.0 / (1.0 + exp(clamp(y, -80.0, 80.0)));
}

// Area of the surface that is compressed beyond the threshold of foam, per area of the surface at rest. The compression
// is `compression` plus a normal distribution with the deviation `deviation`.
fn compressed_area(compression: f32, deviation: f32) -> f32 {
    let wide = max(deviation, SEA_LEAST_DEVIATION);
    let x = (sea.foam_from - compression) / wide;
    let density = exp(-min(0.5 * x * x, 80.0)) * 0.39894228;
    return max((1.0 - compression) * upper_tail(x) - wide * density, 0.0);
}

// Compression of the surface by a wave of the amplitude `size` at four ages. `turn` has the sine and the cosine of the
// wave's phase now, `step` those of the phase of a step of age. Each further cosine follows from the two before it
// (Chebyshev).
fn past_compression(size: f32, turn: vec2f, step: vec2f) -> vec4f {
    let double = 2.0 * step.y;
    let a = turn.y * step.y - turn.x * step.x;
    let b = double * a - turn.y;
    let c = double * b - a;
    return size * vec4f(a, b, c, double * c - b);
}

// Sine and cosine of a phase in turns.
fn wave_turn(turns: f32) -> vec2f {
    let angle = SEA_TAU * (turns - floor(turns + 0.5));
    return vec2f(sin(angle), cos(angle));
}

// Sine and cosine of a phase in turns within 1.1e-3, for slopes: a parabola, corrected by its own square.
fn near_turn(turns: f32) -> vec2f {
    let both = vec2f(turns, turns + 0.25);
    let part = both - floor(both + 0.5);
    let curve = part * (8.0 - 16.0 * abs(part));
    return curve * (0.775 + 0.225 * abs(curve));
}

// Sum of the single waves. `height_share` is the ratio of their heights to those on the open sea.
fn single_waves(at: vec2f, distance: f32, footprint: Footprint, height_share: f32) -> SeaVertex {
    var out: SeaVertex;
    // Compression at four ages by the waves that are summed here, and the variance of this compression.
    var before = vec4f(0.0);
    var known = 0.0;
    let along = footprint.toward * footprint.along;
    let across = vec2f(footprint.toward.y, -footprint.toward.x) * footprint.across;
    let shortest = 1.0 / last_turns(footprint);
    let per_cell = SEA_CELLS_TO_DISTANCE / distance;
    for (var i = 0u; i < min(sea.waves, MOST_SEA_WAVES); i++) {
        let wave = sea_waves[i];
        let cells = wave.length * per_cell;
        if cells <= SEA_LEAST_CELLS {
            break;
        }
        let share = clamp(cells * (1.0 / SEA_LEAST_CELLS) - 1.0, 0.0, 1.0);
        let smooth_share = clamp(cells * (1.0 / SEA_SMOOTH_CELLS) - 1.0, 0.0, 1.0);
        let seen = seen_share(wave.turns, along, across, wave.turns_per_m * shortest);
        let shown = SEA_TAU * smooth_share * seen;
        let turn = wave_turn(dot(wave.turns, at) + wave.phase);
        let square = wave.turns_per_m * wave.turns_per_m;
        let lowering = SEA_HALF_TAU * square * wave.shift * wave.height;
        out.height += share * wave.height * turn.y;
        out.raised += share * share * lowering;
        out.shift -= (share * turn.x * wave.shift) * wave.turns;
        out.slope -= (shown * turn.x * wave.height) * wave.turns;
        let squeezed = (shown * turn.y * wave.shift) * wave.turns;
        out.squeeze -= vec3f(squeezed.x * wave.turns.x, squeezed.x * wave.turns.y, squeezed.y * wave.turns.y);
        if sea.foam_from < SEA_NO_FOAM {
            let size = height_share * SEA_TAU * share * seen * square * wave.shift;
            before += past_compression(size, turn, unpack2x16snorm(wave.age_step));
            known += 0.5 * size * size;
        }
    }
    if sea.foam_from < SEA_NO_FOAM {
        let deviation = sqrt(max(height_share * height_share * sea.compression - known, 0.0));
        for (var age = 0u; age < 4u; age++) {
            out.left += sea.foam.kept[age] * compressed_area(before[age], deviation);
        }
    }
    return out;
}

// B-spline of a tile's coefficients at a mip level, by four bilinear look-ups (Sigg and Hadwiger 2005).
fn tile_spline(tile: u32, turns: vec2f, mip: f32) -> vec3f {
    let side = SEA_SIDE * exp2(-mip);
    let texels = turns * side - 0.5;
    let first = floor(texels);
    let t = texels - first;
    let u = 1.0 - t;
    let w0 = u * u * u / 6.0;
    let w1 = (3.0 * t * t * t - 6.0 * t * t + 4.0) / 6.0;
    let w3 = t * t * t / 6.0;
    let w2 = 1.0 - w0 - w1 - w3;
    let low = w0 + w1;
    let high = w2 + w3;
    let a = (first - 0.5 + w1 / low) / side;
    let b = (first + 1.5 + w3 / high) / side;
    let aa = textureSampleLevel(sea_shapes, sea_repeating, a, tile, mip).xyz;
    let ba = textureSampleLevel(sea_shapes, sea_repeating, vec2f(b.x, a.y), tile, mip).xyz;
    let ab = textureSampleLevel(sea_shapes, sea_repeating, vec2f(a.x, b.y), tile, mip).xyz;
    let bb = textureSampleLevel(sea_shapes, sea_repeating, b, tile, mip).xyz;
    return (aa * low.x + ba * high.x) * low.y + (ab * low.x + bb * high.x) * high.y;
}

// Displacement, height and rise of the tiles, as far as the mesh resolves them.
fn tile_shapes(at: vec2f, distance: f32) -> vec4f {
    let cell = max(2.0 * SEA_FINEST, distance / SEA_CELLS_TO_DISTANCE);
    var sum = vec4f(0.0);
    for (var i = 0u; i < SEA_TILES; i++) {
        let mip = max(log2(SEA_TEXELS_TO_CELL * cell * SEA_SIDE / sea.tiles[i].length), 0.0);
        if sea.tiles[i].is_there == 0.0 || mip >= SEA_FLAT_MIP {
            continue;
        }
        let share = min(SEA_FLAT_MIP - mip, 1.0);
        let turn = sea.tiles[i].turn;
        let turns = sea.tiles[i].anchor + to_tile(turn, at) / sea.tiles[i].length;
        let low = floor(mip);
        let shape = mix(tile_spline(i, turns, low), tile_spline(i, turns, low + 1.0), mip - low) * share;
        sum += vec4f(from_tile(turn, shape.yz), shape.x, sea.tiles[i].lowering * share * max(1.0 - 0.5 * mip, 0.0));
    }
    return sum;
}

// Surface at a vertex whose place at rest is `at`. `share` is the ratio of the waves' height to that on the open sea.
fn sea_vertex(at: vec2f, share: f32) -> SeaVertex {
    let distance = mesh_distance(at);
    var out = single_waves(at, distance, footprint_at(at), share);
    let tiles = tile_shapes(at, distance);
    out.shift = share * (out.shift + tiles.xy);
    // The fall of the mean level is proportional to the square of the waves' height.
    out.height = share * (out.height + tiles.z + share * (out.raised + tiles.w));
    out.slope *= share;
    out.squeeze *= share;
    return out;
}

// Height of wakes at a place that the water has moved to from `rest`, as far as the mesh resolves it.
fn wake_height(rest: vec2f, place: vec2f) -> f32 {
    if sea_band.wakes == 0u {
        return 0.0;
    }
    let per_cell = SEA_CELLS_TO_DISTANCE / mesh_distance(rest);
    return wakes_at(place, WakeFilter(per_cell, vec2f(0.0), vec2f(0.0), 0.0)).height;
}

// Slope and foam of wakes that a pixel shows.
fn wake_shown(rest: vec2f, place: vec2f) -> WakeSurface {
    if sea_band.wakes == 0u {
        return WakeSurface(0.0, vec2f(0.0), 0.0);
    }
    let footprint = footprint_at(rest);
    let along = footprint.toward * footprint.along;
    let across = vec2f(footprint.toward.y, -footprint.toward.x) * footprint.across;
    return wakes_at(place, WakeFilter(0.0, along, across, 1.0 / last_turns(footprint)));
}

// Camera-relative position of a surface point whose place on the map is `at`.
fn sea_point(at: vec2f, height: f32) -> vec3f {
    let m = at - sea.eye;
    let level = sea.foot + sea.east * m.x + sea.north * m.y
        + sea.bend_xx * (m.x * m.x) + sea.bend_xy * (m.x * m.y) + sea.bend_yy * (m.y * m.y);
    return level + vec3f(0.0, 0.0, height);
}

// Slopes that a pixel shows.
struct SeaSlopes {
    // Slope of the surface over fixed places.
    slope: vec2f,
    // Compression by all but the shortest waves (`compression`), and the share of the variance of the compression that
    // the shortest waves have (`hidden`).
    compression: f32,
    hidden: f32,
    // Covariances of the slopes that the pixel does not show: east east, east north, north north.
    left: vec3f,
    // Half the variance of the shown slopes that do not move the mesh.
    mapped: f32,
    // Binary logarithm of the pixel's width on the surface, m.
    octaves: f32,
}

// Nodes of the table of shown slopes.
const SEA_SEEN: vec2f = vec2f(32.0, 16.0);

// Row of the table of shown slopes for a direction, as a share of all rows. Opposite directions have the same row.
// src/sea/seen.rs has the directions of rows.
fn seen_row(toward: vec2f) -> f32 {
    let cosine = toward.x * toward.x - toward.y * toward.y;
    let sine = 2.0 * toward.x * toward.y;
    let quarter = 0.25 * sine / max(abs(cosine) + abs(sine), 1e-6);
    return select(0.5 - quarter, quarter, cosine >= 0.0);
}

// Place in the table of shown slopes.
fn seen_place(footprint: Footprint) -> vec2f {
    let octaves = log2(footprint.across / (SEA_PIXEL_DEVIATION * sea.pixel * sea.height));
    let column = clamp(octaves * sea.seen_per_octave, 0.0, 1.0) * (SEA_SEEN.x - 1.0);
    return vec2f((column + 0.5) / SEA_SEEN.x, seen_row(footprint.toward) + 0.5 / SEA_SEEN.y);
}

// Slopes that a pixel shows: those at its vertices, plus those of the tiles and of the single waves that the vertices
// lack. `height_share` is the ratio of the waves' height to that on the open sea.
fn sea_slopes_at(at: vec2f, vertex_slope: vec2f, vertex_squeeze: vec3f, height_share: f32) -> SeaSlopes {
    let footprint = footprint_at(at);
    let along = footprint.toward * footprint.along;
    let across = vec2f(footprint.toward.y, -footprint.toward.x) * footprint.across;
    let last = last_turns(footprint);
    let shortest = 1.0 / last;
    let per_smooth = SEA_CELLS_TO_DISTANCE / (SEA_SMOOTH_CELLS * mesh_distance(at));
    var slope = vec2f(0.0);
    var squeeze = vec3f(0.0);
    for (var i = sea_band.first; i < min(min(sea_band.last, sea.waves), MOST_SEA_WAVES); i++) {
        let wave = sea_waves[i];
        let share = clamp(2.0 - wave.length * per_smooth, 0.0, 1.0) * seen_share(wave.turns, along, across, wave.turns_per_m * shortest);
        let turn = near_turn(dot(wave.turns, at) + wave.phase);
        slope += (share * turn.x * wave.height) * wave.turns;
        let squeezed = (share * turn.y * wave.shift) * wave.turns;
        squeeze += vec3f(squeezed.x * wave.turns.x, squeezed.x * wave.turns.y, squeezed.y * wave.turns.y);
    }
    slope = vertex_slope - height_share * SEA_TAU * slope;
    squeeze = vertex_squeeze - height_share * SEA_TAU * squeeze;
    // The slope over places at rest becomes that over fixed places.
    let stretch = 1.0 + vec2f(squeeze.x, squeeze.z);
    let inverse = 1.0 / max(stretch.x * stretch.y - squeeze.y * squeeze.y, 0.1);
    slope = vec2f(stretch.y * slope.x - squeeze.y * slope.y, stretch.x * slope.y - squeeze.y * slope.x) * inverse;
    var compression = -(squeeze.x + squeeze.z);
    let octaves = log2(max(footprint.across, footprint.along / SEA_MOST_LENGTHENED) / SEA_PIXEL_DEVIATION);
    for (var i = 0u; i < SEA_TILES; i++) {
        let mip = max(octaves + sea.tiles[i].octaves, 0.0);
        if sea.tiles[i].is_there == 0.0 || mip >= SEA_FLAT_MIP + 1.0 {
            continue;
        }
        let turn = sea.tiles[i].turn;
        let turns = sea.tiles[i].anchor + to_tile(turn, at) / sea.tiles[i].length;
        let found = height_share * textureSampleLevel(sea_slopes, sea_repeating, turns, i, mip).xyz;
        slope += from_tile(turn, found.xy);
        compression += found.z;
    }
    let place = seen_place(footprint);
    let seen = textureSampleLevel(sea_seen, sea_repeating, place, 0u, 0.0);
    let squeezed = textureSampleLevel(sea_seen, sea_repeating, place, 1u, 0.0).x;
    let left = max(sea.slopes.xyz - seen.xyz, vec3f(0.0, -1.0, 0.0));
    let hidden = clamp(1.0 - squeezed * sea.squeeze / max(sea.compression, 1e-9), 0.0, 1.0);
    // Where the waves are lower, those that the pixel does not show are lower too. The ripples of the wind, which no
    // vertex or pixel has, are not lower.
    let square = height_share * height_share;
    let drawn = clamp((sea.slopes.w - seen.x - seen.z) / max(left.x + left.z, 1e-9), 0.0, 1.0);
    return SeaSlopes(slope, compression, square * hidden, left * mix(1.0, square, drawn), square * seen.w, octaves);
}
