// What a place in a cloud sends to the eye of the light of sun or moon, sky and ground. In its place lit_lamps.wgsl has
// that of lamps and flashes.
//!include "clouds/about.wgsl"

// cd/m^2 over exposure, for each unit of scaled depth. `halo`: what ice adds to the phase function, 1/sr.
fn cloud_lit(layer: CloudLayer, at: CloudPlace, here: CloudHere, stretch: CloudStretch, halo: vec3f) -> vec3f {
    let depths = cloud_depths(layer, at, here.excess);
    let s = cloud_scattered(layer.medium.x, depths, -stretch.direction, stretch.to_eye);
    return layer.sun.rgb * (s.sun + s.once * halo) * cloud_sunlit(layer, at, here) + layer.above.rgb * s.sky + layer.below.rgb * s.ground;
}
