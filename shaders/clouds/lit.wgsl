// Light of sun or moon, sky and ground that a place in a cloud scatters to the eye. lit_lamps.wgsl replaces this file
// for the light of lamps and flashes.
//!include "clouds/about.wgsl"

// Light that a place scatters to the eye, cd/m^2 times exposure, per unit of scaled depth. `halo` is the amount that
// ice crystals add to the phase function, 1/sr.
fn cloud_lit(layer: CloudLayer, at: CloudPlace, here: CloudHere, stretch: CloudStretch, halo: vec3f) -> vec3f {
    let depths = cloud_depths(layer, at, here.excess);
    let s = cloud_scattered(layer.medium.x, depths, -stretch.direction, stretch.to_eye);
    return layer.sun.rgb * (s.sun + s.once * halo) * cloud_sunlit(layer, at, here) + layer.above.rgb * s.sky + layer.below.rgb * s.ground;
}
