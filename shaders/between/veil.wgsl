// What lies between the eye and a point: the light that the air and the fog send, and what they let through.
//!include "between/air.wgsl"
//!include "between/fog.wgsl"

// Air and fog together, for what lies `range` metres along the ray.
fn veil_between(ray: ViewRay, range: f32, plane: f32) -> Veil {
    return with_fog(ray, range, plane, air_between(ray.direction, range));
}
