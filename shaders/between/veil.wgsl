// Veil of air, clouds and fog between the eye and a place. The order in which the three are combined is set here.
//!include "between/sky_sample.wgsl"
//!include "between/fog.wgsl"

// Lays the clouds, then the fog, in front of `behind`. `behind` is the air along the whole ray or, where the host drew
// nothing, the sky with its clouds, with transmittance 0. `range` is the distance along the ray, `plane` that from the
// camera's plane, m; `sky` has the clouds in this pixel.
fn veil_before(ray: ViewRay, range: f32, plane: f32, behind: Veil, sky: SkySample) -> Veil {
    var veil = behind;
    if range < RANGE_SKY {
        veil = with_clouds(veil, sky, range);
    }
    return with_fog(ray, range, plane, veil);
}

// Air, clouds and fog in front of a place.
fn veil_between(ray: ViewRay, range: f32, plane: f32, sky: SkySample) -> Veil {
    return veil_before(ray, range, plane, air_between(ray.direction, range), sky);
}
