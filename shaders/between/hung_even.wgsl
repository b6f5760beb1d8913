// In place of hung.wgsl where nothing hangs in the sky but a deck.
//!include "between/hung_bare.wgsl"
//!include "between/flash.wgsl"

const CLOUDS: bool = false;
const CLOUD_SHAFTS: bool = false;

fn hung_in(pixel: vec2i, range: f32) -> Hung {
    return hung_bare();
}

fn hung_toward(d: vec3f) -> Hung {
    return hung_bare();
}

fn deck_hides_all() -> bool {
    return DECK_CLOSED;
}

fn with_clouds(behind: Veil, hung: Hung, range: f32) -> Veil {
    return behind;
}
