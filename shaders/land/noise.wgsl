// Noise of the ground's materials: octaves with the mean 0, each of which fades out before it is finer than the pixels
// (N-41: fBm, filtered by the footprint of a pixel).
//!include "land/uniform.wgsl"

// Mixes the bits of a cell to a number from -1 to 1 (lowbias32 of Wellons 2018).
fn cell_number(cell: vec3i, seed: i32) -> f32 {
    var h = u32(seed) ^ (u32(cell.x) * 0x8da6b343u) ^ (u32(cell.y) * 0xd8163841u) ^ (u32(cell.z) * 0xcb1ab31fu);
    h = (h ^ (h >> 16u)) * 0x7feb352du;
    h = (h ^ (h >> 15u)) * 0x846ca68bu;
    h = h ^ (h >> 16u);
    return f32(h >> 8u) / 8388608.0 - 1.0;
}

// Value noise of one octave at a place from the eye, m.
fn octave_noise(octave: Octave, place: vec3f) -> f32 {
    let turned = vec3f(
        octave.turn.x * place.x - octave.turn.y * place.y,
        octave.turn.y * place.x + octave.turn.x * place.y,
        place.z,
    );
    let at = octave.place.xyz + turned * octave.place.w;
    let low = floor(at);
    let part = at - low;
    let share = part * part * part * (part * (part * 6.0 - 15.0) + 10.0);
    let cell = octave.cell.xyz + vec3i(low);
    let seed = octave.cell.w;
    let bottom = mix(
        mix(cell_number(cell, seed), cell_number(cell + vec3i(1, 0, 0), seed), share.x),
        mix(cell_number(cell + vec3i(0, 1, 0), seed), cell_number(cell + vec3i(1, 1, 0), seed), share.x),
        share.y,
    );
    let top = mix(
        mix(cell_number(cell + vec3i(0, 0, 1), seed), cell_number(cell + vec3i(1, 0, 1), seed), share.x),
        mix(cell_number(cell + vec3i(0, 1, 1), seed), cell_number(cell + vec3i(1, 1, 1), seed), share.x),
        share.y,
    );
    return mix(bottom, top, share.z);
}

// Fine and broad noise at a place from the eye, for a pixel with this footprint, m.
fn ground_noise(place: vec3f, footprint: f32) -> vec2f {
    var sums = vec2f(0.0);
    for (var i = 0u; i < OCTAVES; i++) {
        let octave = land.octaves[i];
        let kept = 1.0 - smoothstep(octave.turn.z, octave.turn.w, footprint);
        if kept > 0.0 {
            let value = kept * octave_noise(octave, place);
            sums += select(vec2f(0.0, value), vec2f(value, 0.0), i < OCTAVES / 2u);
        }
    }
    return sums;
}
