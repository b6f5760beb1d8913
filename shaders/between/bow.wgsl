// Rainbow and fogbow in the light that drops scatter once. src/bow/mod.rs describes the model; the f64 reference of
// `bow_phase` is `phase_in` in src/bow/table.rs.
//!include "common/frame.wgsl"

// Whether any bow may be visible.
override BOW: bool = false;

// Number of entries in a table.
const BOW_ENTRIES: u32 = 160u;
// Angle between two entries, rad.
const BOW_STEP: f32 = 0.0069813170;
// Indices of the two tables: for drops in the low air, and for drops in the columns of rain areas.
const BOW_LOW_AIR: u32 = 0u;
const BOW_COLUMNS: u32 = 1u;

// Amount that bows add to the phase function, 1/sr, in a direction from the eye. The angle from the point opposite the
// light is computed from the chord, since the cosine has too few digits there.
fn bow_phase(table: u32, direction: vec3f, to_light: vec3f) -> vec3f {
    let place = 2.0 * asin(min(0.5 * length(direction + to_light), 1.0)) / BOW_STEP;
    if !BOW || place >= f32(BOW_ENTRIES - 1u) {
        return vec3f(0.0);
    }
    let i = u32(place);
    let first = table * BOW_ENTRIES + i;
    return mix(frame.bows[first].rgb, frame.bows[first + 1u].rgb, place - f32(i));
}
