// What lies between the eye and a place: air, clouds, fog. The one order of these.
//!include "between/hung.wgsl"
//!include "between/fog.wgsl"

// `behind` is what air does over the ray's whole length, or the sky with its clouds, which lets nothing through.
fn veil_before(ray: ViewRay, range: f32, plane: f32, behind: Veil, hung: Hung) -> Veil {
    var veil = behind;
    if range < RANGE_SKY {
        veil = with_clouds(veil, hung, range);
    }
    return with_fog(ray, range, plane, veil);
}

// All of it before a place.
fn veil_between(ray: ViewRay, range: f32, plane: f32, hung: Hung) -> Veil {
    return veil_before(ray, range, plane, air_between(ray.direction, range), hung);
}
