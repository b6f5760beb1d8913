// What may hang in the sky in a direction, and how it is where nothing does but a deck.
//!include "between/air.wgsl"

// How much of what hangs behind the sky's own light stands in the night floor's place.
var<private> behind_share: f32;

struct Hung {
    // Of clouds: their light, with the exposure on it, and what they let through.
    clouds: vec4f,
    // log2 of the distances between which they stand, m, or 0; the share of direct light at what the host drew.
    reach: vec3f,
    // By how much the share of direct light in the air before it differs from the mean over places.
    shafts: f32,
    // Their light of lamps and flashes over their cover, with the exposure on it; whether that is known.
    glow: vec3f,
    has_glow: bool,
    // cd/m^2, behind the sky's own light.
    behind: vec3f,
    // How far the sky is a deck, and what it leaves of the discs of sun and moon.
    deck: f32,
    disc: f32,
}

// Without clouds but a deck.
fn hung_bare() -> Hung {
    var hung: Hung;
    hung.clouds = vec4f(0.0, 0.0, 0.0, 1.0);
    hung.reach = vec3f(0.0, 0.0, 1.0);
    hung.behind = frame.night_floor;
    hung.deck = frame.deck_cover;
    hung.disc = frame.direct_share;
    return hung;
}
