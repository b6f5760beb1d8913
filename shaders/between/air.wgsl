// What the air between the eye and a point does.
//!include "common/frame.wgsl"
//!include "sky/lookup.wgsl"

// Whether the air between is drawn at all.
override AIR: bool = true;

// Whether the clear sky above the horizon is drawn at all.
override CLEAR_SKY: bool = true;
// The deck hides all of the sky: no light of the clear sky is asked for above the horizon and in the air.
override DECK_CLOSED: bool = false;

// Light in the air between, over that on the mean over places.
var<private> air_lit: vec3f = vec3f(1.0);

// Light that reaches the eye beside what comes from behind, and the share of the latter that gets through.
struct Veil {
    light: vec3f,
    transmittance: vec3f,
}

// Mean luminance of an overcast sky over elevation (CIE S 011, the standard overcast sky), 1 at the zenith.
fn overcast_gradation(sin_elevation: f32) -> f32 {
    return (1.0 + 2.0 * max(sin_elevation, 0.0)) / 3.0;
}

fn air_between(d: vec3f, distance: f32) -> Veil {
    return air_on(sky_path(d, distance), d);
}

fn air_on(path: SkyPath, d: vec3f) -> Veil {
    if !AIR || drawn.x == 0.0 {
        return Veil(vec3f(0.0), vec3f(1.0));
    }
    let transmittance = exp(-path.depth);
    // No beam reaches the air below a deck: it is lit by the deck, and far things fade to the deck at the horizon.
    var light = frame.deck * overcast_gradation(0.0) * (1.0 - transmittance);
    if !DECK_CLOSED {
        light = mix(color_of(aerial_on(path, d).radiance) * frame.medium_share, light, frame.deck_cover);
    }
    light = light * air_lit + frame.night_floor * (1.0 - transmittance);
    return Veil(light * drawn.x, mix(vec3f(1.0), transmittance, drawn.x));
}
