// Clouds, stars and deck in a direction of the sky, and their values where there is only a deck.
//!include "between/air.wgsl"

// Share, 0 to 1, by which the light behind the sky's own (stars) replaces the night floor.
var<private> behind_share: f32;

struct SkySample {
    // Clouds: radiance times exposure, and transmittance.
    clouds: vec4f,
    // log2 of the distances between which the clouds stand, m, or 0; share of direct light at the surface that the host
    // drew.
    reach: vec3f,
    // Share of direct light in the air in front, less its mean over all places.
    shafts: f32,
    // Light of lamps and flashes in the clouds divided by their cover, times exposure.
    glow: vec3f,
    // Whether `glow` is known.
    has_glow: bool,
    // Light behind the sky's own, cd/m^2.
    behind: vec3f,
    // Share by which the sky is a deck, and transmittance for the discs of sun and moon.
    deck: f32,
    disc: f32,
}

// Sky without clouds other than a deck.
fn bare_sky_sample() -> SkySample {
    var sky: SkySample;
    sky.clouds = vec4f(0.0, 0.0, 0.0, 1.0);
    sky.reach = vec3f(0.0, 0.0, 1.0);
    sky.behind = frame.night_floor;
    sky.deck = frame.deck_cover;
    sky.disc = frame.direct_share;
    return sky;
}
