// Noise of the ground's materials: octaves with the mean 0, each of which fades out before it is finer than the pixels
// (fractional Brownian motion, filtered by the footprint of a pixel).
//!include "land/uniform.wgsl"

// Multipliers that spread the numbers of a cell's three axes over the bits.
const AXES: vec3u = vec3u(0x8da6b343u, 0xd8163841u, 0xcb1ab31fu);

// Mixes the bits of a cell's key to a number from -1 to 1 (after lowbias32, Wellons 2018).
fn key_number(key: u32) -> f32 {
    var h = (key ^ (key >> 16u)) * 0x7feb352du;
    h = (h ^ (h >> 15u)) * 0x846ca68bu;
    return f32(h >> 8u) / 8388608.0 - 1.0;
}

// Value noise of four cells of a level lattice. `low` and `high` are the keys of the lower and the upper cells along
// two axes. `rest` is the key along the third axis, combined with the seed.
fn level_noise(low: vec2u, high: vec2u, rest: u32, share: vec2f) -> f32 {
    return mix(
        mix(key_number(low.x ^ low.y ^ rest), key_number(high.x ^ low.y ^ rest), share.x),
        mix(key_number(low.x ^ high.y ^ rest), key_number(high.x ^ high.y ^ rest), share.x),
        share.y,
    );
}

// Converts a place, m from the eye, to cells of an octave's lattice.
fn octave_place(octave: Octave, place: vec3f) -> vec3f {
    let turned = vec3f(
        octave.turn.x * place.x - octave.turn.y * place.y,
        octave.turn.y * place.x + octave.turn.x * place.y,
        place.z,
    );
    return octave.place.xyz + turned * octave.place.w;
}

// Share of an octave that a pixel of this footprint, m, can show.
fn octave_share(octave: Octave, footprint: f32) -> f32 {
    return 1.0 - smoothstep(octave.turn.z, octave.turn.w, footprint);
}

// Cell of an octave's lattice with a place in it.
struct OctaveCell {
    // Keys of the cell, and of the next cell along each axis.
    key: vec3u,
    next: vec3u,
    seed: u32,
    // Place in the cell, 0 to 1, and the weight of the next cell there, along each axis.
    part: vec3f,
    share: vec3f,
}

fn octave_cell(octave: Octave, place: vec3f) -> OctaveCell {
    let at = octave_place(octave, place);
    let low = floor(at);
    let part = at - low;
    let key = vec3u(octave.cell.xyz + vec3i(low)) * AXES;
    return OctaveCell(key, key + AXES, u32(octave.cell.w), part, part * part * (3.0 - 2.0 * part));
}

// Number of octaves of clods: all those of the fine noise but the longest.
const CLOD_OCTAVES: u32 = 3u;
// Ratio of the height of clods to their length. The heights then have a standard deviation of 2.3 cm, a random
// roughness between that of harrowed and of ploughed soil (Renard et al. 1997, chapter 5).
const CLOD_HEIGHT: f32 = 0.085;

// Value noise of four cells of a level lattice, and its change across the square in both directions. Arguments are
// those of level_noise.
fn level_slopes(low: vec2u, high: vec2u, rest: u32, share: vec2f) -> vec3f {
    let south = vec2f(key_number(low.x ^ low.y ^ rest), key_number(high.x ^ low.y ^ rest));
    let north = vec2f(key_number(low.x ^ high.y ^ rest), key_number(high.x ^ high.y ^ rest));
    let west_east = mix(south, north, share.y);
    return vec3f(
        mix(west_east.x, west_east.y, share.x),
        west_east.y - west_east.x,
        mix(north.x, north.y, share.x) - mix(south.x, south.y, share.x),
    );
}

// Gradient of the height of clods, rise over run along the three axes, filtered.
fn clod_slope(place: vec3f, footprint: f32) -> vec3f {
    var sum = vec3f(0.0);
    for (var i = 0u; i < CLOD_OCTAVES; i++) {
        let octave = land.octaves[i];
        let kept = octave_share(octave, footprint);
        if kept > 0.0 {
            let cell = octave_cell(octave, place);
            let rise = 6.0 * cell.part * (1.0 - cell.part);
            let bottom = level_slopes(cell.key.xy, cell.next.xy, cell.key.z ^ cell.seed, cell.share.xy);
            let top = level_slopes(cell.key.xy, cell.next.xy, cell.next.z ^ cell.seed, cell.share.xy);
            let turned = rise * vec3f(mix(bottom.yz, top.yz, cell.share.z), top.x - bottom.x);
            let c = octave.turn.x;
            let s = octave.turn.y;
            sum += kept * vec3f(c * turned.x + s * turned.y, c * turned.y - s * turned.x, turned.z);
        }
    }
    return CLOD_HEIGHT * sum;
}

// Noise of grains and tufts, in space: it does not stretch on steep ground.
fn fine_noise(place: vec3f, footprint: f32) -> f32 {
    var sum = 0.0;
    for (var i = 0u; i < OCTAVES / 2u; i++) {
        let octave = land.octaves[i];
        let kept = octave_share(octave, footprint);
        if kept > 0.0 {
            let cell = octave_cell(octave, place);
            let bottom = level_noise(cell.key.xy, cell.next.xy, cell.key.z ^ cell.seed, cell.share.xy);
            let top = level_noise(cell.key.xy, cell.next.xy, cell.next.z ^ cell.seed, cell.share.xy);
            sum += kept * mix(bottom, top, cell.share.z);
        }
    }
    return sum;
}

// Noise of patches: a function of the place east and north alone.
fn broad_noise(place: vec3f, footprint: f32) -> f32 {
    var sum = 0.0;
    for (var i = OCTAVES / 2u; i < OCTAVES; i++) {
        let octave = land.octaves[i];
        let kept = octave_share(octave, footprint);
        if kept > 0.0 {
            let cell = octave_cell(octave, place);
            sum += kept * level_noise(cell.key.xy, cell.next.xy, cell.seed, cell.share.xy);
        }
    }
    return sum;
}
