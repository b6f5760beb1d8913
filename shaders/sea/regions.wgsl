// Regions of the sea: places without water, and places where waves are lower. src/sea/regions.rs has the rules.
//!include "sea/uniform.wgsl"

// Kind of a region with lower waves.
const SHELTERED_REGION: u32 = 1u;

// Place in an outline.
struct OutlinePlace {
    holds: bool,
    // Square of the distance from the outline, m^2.
    distance2: f32,
}

// Looks a place up in a region's outline: a ray to the right from a place inside crosses it an odd number of times.
fn outline_place(row: u32, corners: u32, p: vec2f) -> OutlinePlace {
    var found = OutlinePlace(false, 1e30);
    let count = clamp(corners, 1u, MOST_OUTLINE_CORNERS);
    var a = textureLoad(sea_outlines, vec2i(vec2u(count - 1u, row)), 0).xy;
    for (var i = 0u; i < count; i++) {
        let b = textureLoad(sea_outlines, vec2i(vec2u(i, row)), 0).xy;
        let along = b - a;
        let offset = p - a;
        let turn = along.x * offset.y - along.y * offset.x;
        if (a.y > p.y) != (b.y > p.y) && (turn > 0.0) == (b.y > a.y) {
            found.holds = !found.holds;
        }
        let share = clamp(dot(offset, along) / max(dot(along, along), 1e-12), 0.0, 1.0);
        let off = offset - along * share;
        found.distance2 = min(found.distance2, dot(off, off));
        a = b;
    }
    return found;
}

// Water at a place.
struct SeaPlace {
    has_sea: bool,
    // Ratio of the waves' height to that on the open sea. At a place without the sea's water it is the ratio of the
    // waves around the place.
    share: f32,
}

// Looks a place up, m from the anchor.
fn sea_place(at: vec2f) -> SeaPlace {
    var place = SeaPlace(sea_band.is_open != 0u, 1.0);
    var is_dry = false;
    for (var i = 0u; i < min(sea_band.regions, MOST_SEA_REGIONS); i++) {
        let region = sea_regions[i];
        let p = region.anchor + region.turn.xy * at.x + region.turn.zw * at.y;
        if dot(p, p) > region.reach2 {
            continue;
        }
        let found = outline_place(i, region.corners, p);
        if !found.holds {
            continue;
        }
        if region.kind == SHELTERED_REGION {
            // A region without sea around it has no rim.
            let has_rim = place.has_sea && region.rim > 0.0;
            let deep = select(1.0, smoothstep(0.0, max(region.rim, 1e-3), sqrt(found.distance2)), has_rim);
            place.share *= mix(1.0, region.wave_share, deep);
            place.has_sea = true;
        } else {
            // A lake has a level of its own.
            is_dry = true;
        }
    }
    place.has_sea = place.has_sea && !is_dry;
    return place;
}
