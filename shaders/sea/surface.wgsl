// Surface of the sea: displacement of the mesh, and the slopes that a pixel shows. src/sea/surface.rs is the f64
// reference of the waves' sums.
//
// A wave is in the mesh as far as the cells there resolve it; the rest of it is in the slopes of the pixels, as far as
// the pixel resolves it. The slopes that are left have a known variance. Shares depend on the place alone and not on
// the level of the mesh, so that levels meet without cracks.
//!include "sea/mesh.wgsl"

const SEA_TAU: f32 = 6.28318531;
// Cells of the mesh are at most this many times shorter than their distance.
const SEA_CELLS_TO_DISTANCE: f32 = 23.8;
// A wave is wholly in the mesh if its length is at least six cells, and not at all below three.
const SEA_LEAST_CELLS: f32 = 3.0;
// Length, in cells, of a texel of the mip level that the mesh has of a tile. The shortest waves there, three texels
// long, are low.
const SEA_TEXELS_TO_CELL: f32 = 0.5;
// Standard deviation of a pixel's filter as a share of the pixel's width.
const SEA_PIXEL_DEVIATION: f32 = 0.4;
// Largest ratio of the sides of a pixel on the surface up to which waves along the short side are told apart.
const SEA_MOST_LENGTHENED: f32 = 2.0;
// Compression that no sea has: without whitecaps foam begins beyond it.
const SEA_NO_FOAM: f32 = 100.0;
// Mip levels by which the compression of tiles is smoother than their slopes: foam is made by waves that are some times
// longer than the shortest ripples.
const SEA_FOAM_MIPS: f32 = 0.8;
// Mip level at which a tile shows no waves.
const SEA_FLAT_MIP: f32 = 5.0;

// Filter of a pixel on the level surface.
struct Footprint {
    // Unit vector from the camera, level.
    toward: vec2f,
    // Standard deviations along it and across, m.
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

// Wave number, turns per metre, from which on no single wave is told apart in a pixel.
fn last_turns(footprint: Footprint) -> f32 {
    return 0.39 / max(footprint.across, footprint.along / SEA_MOST_LENGTHENED);
}

// Share of a wave's amplitude that the pixel's filter lets through: (1 - x / 3)^2 with x half the square of wave number
// times deviation, which is near exp(-x) and ends.
fn seen_share(wave: SeaWave, footprint: Footprint, last: f32) -> f32 {
    let along = dot(wave.turns, footprint.toward) * footprint.along;
    let across = (wave.turns.x * footprint.toward.y - wave.turns.y * footprint.toward.x) * footprint.across;
    let end = wave.turns_per_m / last;
    let x = max(19.7392088 * (along * along + across * across), 3.0 * end * end);
    let left = clamp(1.0 - x * 0.33333333, 0.0, 1.0);
    return left * left;
}

// Share of a wave's amplitude that is in the mesh at a distance.
fn mesh_share(turns_per_m: f32, distance: f32) -> f32 {
    return clamp(SEA_CELLS_TO_DISTANCE / (SEA_LEAST_CELLS * turns_per_m * distance) - 1.0, 0.0, 1.0);
}

// Surface at a vertex.
struct SeaVertex {
    // Displacement and height above the level, m.
    shift: vec2f,
    height: f32,
    // Slopes of the single waves, filtered by the pixel: of the height, and of the displacement (xx, xy, yy).
    slope: vec2f,
    squeeze: vec3f,
    // Covariances of the slopes of all single waves that a pixel shows, and half the variance of those that are not in
    // the mesh.
    seen: vec4f,
    // First and last wave that a pixel has to add.
    band: vec2u,
}

// Sine and cosine of a phase in turns.
fn wave_turn(turns: f32) -> vec2f {
    let angle = SEA_TAU * (turns - floor(turns + 0.5));
    return vec2f(sin(angle), cos(angle));
}

fn single_waves(at: vec2f, distance: f32, footprint: Footprint) -> SeaVertex {
    var out: SeaVertex;
    let last = last_turns(footprint);
    let ends = max(SEA_CELLS_TO_DISTANCE / (SEA_LEAST_CELLS * distance), last);
    var first = sea.waves;
    var i = 0u;
    for (; i < min(sea.waves, MOST_SEA_WAVES); i++) {
        let wave = sea_waves[i];
        if wave.turns_per_m >= ends {
            break;
        }
        let share = mesh_share(wave.turns_per_m, distance);
        let passed = seen_share(wave, footprint, last);
        let rise = wave.turns * (SEA_TAU * wave.height);
        let shown = rise * passed;
        out.seen += 0.5 * vec4f(shown.x * shown.x, shown.x * shown.y, shown.y * shown.y, 0.5 * dot(shown, shown) * (1.0 - share));
        if share < 1.0 {
            first = min(first, i);
        }
        if share > 0.0 {
            let turn = wave_turn(dot(wave.turns, at) + wave.phase);
            out.height += share * (wave.height * turn.y + share * wave.lowering);
            out.shift -= share * turn.x * wave.shift;
            out.slope -= share * turn.x * shown;
            out.squeeze -= (share * passed * SEA_TAU * turn.y) * vec3f(wave.shift.x * wave.turns.x, wave.shift.x * wave.turns.y, wave.shift.y * wave.turns.y);
        }
    }
    out.band = vec2u(first, i);
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

// Displacement and height of the tiles, as far as the mesh resolves them.
fn tile_shapes(at: vec2f, distance: f32) -> vec3f {
    let cell = max(SEA_FINEST, distance / SEA_CELLS_TO_DISTANCE);
    var sum = vec3f(0.0);
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
        sum += vec3f(from_tile(turn, shape.yz), shape.x + sea.tiles[i].lowering * share * max(1.0 - 0.5 * mip, 0.0));
    }
    return sum;
}

// Surface at a vertex whose place at rest is `at`.
fn sea_vertex(at: vec2f) -> SeaVertex {
    let distance = mesh_distance(at);
    var out = single_waves(at, distance, footprint_at(at));
    let tiles = tile_shapes(at, distance);
    out.shift += tiles.xy;
    out.height += tiles.z;
    return out;
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
    // Compression without the shortest waves, and the share of its variance that these have.
    compression: f32,
    hidden: f32,
    // Covariances of the slopes that the pixel does not show: east east, east north, north north.
    left: vec3f,
    // Variance of the shown slopes that do not move the mesh.
    mapped: f32,
}

// Covariances of a tile's slopes that are shown at a mip level: two levels are mixed, and the coarser one has what both
// have.
fn shown_slopes(tile: u32, mip: f32) -> vec3f {
    let low = u32(mip);
    let fine = sea.tiles[tile].slopes[min(low, SEA_MIPS - 1u)].xyz;
    let coarse = sea.tiles[tile].slopes[min(low + 1u, SEA_MIPS - 1u)].xyz;
    let part = 1.0 - fract(mip);
    return coarse + (fine - coarse) * (part * part);
}

// Adds the single waves that the mesh has not, and the tiles, to what the vertices have of a pixel.
fn sea_slopes_at(at: vec2f, vertex: SeaVertex) -> SeaSlopes {
    let distance = mesh_distance(at);
    let footprint = footprint_at(at);
    let last = last_turns(footprint);
    var slope = vertex.slope;
    var squeeze = vertex.squeeze;
    var seen = vertex.seen.xyz;
    var mapped = vertex.seen.w;
    for (var i = vertex.band.x; i < min(vertex.band.y, MOST_SEA_WAVES); i++) {
        let wave = sea_waves[i];
        let share = (1.0 - mesh_share(wave.turns_per_m, distance)) * seen_share(wave, footprint, last);
        if share > 0.0 {
            let turn = wave_turn(dot(wave.turns, at) + wave.phase);
            slope -= (share * turn.x * SEA_TAU * wave.height) * wave.turns;
            squeeze -= (share * turn.y * SEA_TAU) * vec3f(wave.shift.x * wave.turns.x, wave.shift.x * wave.turns.y, wave.shift.y * wave.turns.y);
        }
    }
    // The slope over places at rest becomes that over fixed places.
    let stretch = 1.0 + vec2f(squeeze.x, squeeze.z);
    let inverse = 1.0 / max(stretch.x * stretch.y - squeeze.y * squeeze.y, 0.1);
    slope = vec2f(stretch.y * slope.x - squeeze.y * slope.y, stretch.x * slope.y - squeeze.y * slope.x) * inverse;
    var compression = -(squeeze.x + squeeze.z);
    var squeezed = seen.x + seen.z;
    let has_foam = sea.foam_from < SEA_NO_FOAM;
    let width = max(footprint.across, footprint.along / SEA_MOST_LENGTHENED) / SEA_PIXEL_DEVIATION;
    for (var i = 0u; i < SEA_TILES; i++) {
        let mip = max(log2(width * SEA_SIDE / sea.tiles[i].length), 0.0);
        if sea.tiles[i].is_there == 0.0 || mip >= SEA_FLAT_MIP + 1.0 {
            continue;
        }
        let turn = sea.tiles[i].turn;
        let turns = sea.tiles[i].anchor + to_tile(turn, at) / sea.tiles[i].length;
        slope += from_tile(turn, textureSampleLevel(sea_slopes, sea_repeating, turns, i, mip).xy);
        let shown = shown_slopes(i, mip);
        seen += shown;
        mapped += 0.5 * (shown.x + shown.z);
        if has_foam {
            compression += textureSampleLevel(sea_slopes, sea_repeating, turns, i, mip + SEA_FOAM_MIPS).z;
            let smooth_slopes = shown_slopes(i, mip + SEA_FOAM_MIPS);
            squeezed += smooth_slopes.x + smooth_slopes.z;
        }
    }
    let left = max(sea.slopes.xyz - seen, vec3f(0.0, -1.0, 0.0));
    let hidden = clamp(1.0 - squeezed / max(sea.slopes.w, 1e-9), 0.0, 1.0);
    return SeaSlopes(slope, compression, hidden, left, mapped);
}
