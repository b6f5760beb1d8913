// Halo of 22 degrees that ice crystals make around the sun or moon. The f64 reference is src/clouds/light/halo.rs,
// which describes the model.
//!include "clouds/light.wgsl"

// Smallest deflection by a prism of 60 degrees for red, green and blue, rad. The halo begins there with a step.
const HALO_FROM: vec3f = vec3f(0.37984, 0.38249, 0.38779);
// Phase function of the halo's light alone, just beyond the step at HALO_FROM and without the step's blur, for red,
// green and blue, 1/sr.
const HALO_MOST: vec3f = vec3f(5.1095, 5.0817, 5.0272);
// Angle over which the halo falls to 1/e, rad.
const HALO_FALL: f32 = 0.0716;
// Radius of the disc that blurs the halo's step, rad.
const HALO_DISC: f32 = 0.0047;
// Share of the light scattered by ice that goes into the halo.
const HALO_SHARE: f32 = 0.039;

// Amount that the halo adds to the phase function of a medium without its forward peak, 1/sr, along a ray of this
// direction from the eye. The amount is negative away from the halo, and 0 for droplets.
fn cloud_halo(medium_index: f32, direction: vec3f) -> vec3f {
    let cosine = dot(direction, clouds.to_sun);
    // Droplets make no halo.
    if medium_index < 1.0 {
        return vec3f(0.0);
    }
    let angle = acos(clamp(cosine, -1.0, 1.0));
    let begun = smoothstep(HALO_FROM - HALO_DISC, HALO_FROM + HALO_DISC, vec3f(angle));
    let halo = HALO_MOST * begun * exp(-max(angle - HALO_FROM, vec3f(0.0)) / HALO_FALL);
    let rest = clouds.media[1].rest;
    return HALO_SHARE * (halo - min(cloud_phase(clouds.media[1], 1.0 - cosine), rest.y)) / (1.0 - rest.x);
}
