// Light and transmittance of the air between the eye and a place.
//!include "common/frame.wgsl"
//!include "sky/lookup.wgsl"

// Whether the air is drawn at all.
override AIR: bool = true;

// Whether the clear sky above the horizon is drawn at all.
override CLEAR_SKY: bool = true;
// Whether the deck hides all of the sky. Light of the clear sky is then left out above the horizon and in the air.
override DECK_CLOSED: bool = false;

// Ratio of the air's light along the ray to its mean over all places, per channel.
var<private> air_lit: vec3f = vec3f(1.0);

// Light added on the way to the eye, and transmittance for the light from behind.
struct Veil {
    light: vec3f,
    transmittance: vec3f,
}

// Luminance of an overcast sky by elevation (CIE S 011, the standard overcast sky), 1 at the zenith.
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
    // No direct light reaches the air below a deck. The deck lights this air, and distant objects fade to the deck's
    // luminance at the horizon.
    var light = frame.deck * overcast_gradation(0.0) * (1.0 - transmittance);
    if !DECK_CLOSED {
        light = mix(color_of(aerial_on(path, d).radiance) * frame.medium_share, light, frame.deck_cover);
    }
    light = light * air_lit + frame.night_floor * (1.0 - transmittance);
    return Veil(light * drawn.x, mix(vec3f(1.0), transmittance, drawn.x));
}
