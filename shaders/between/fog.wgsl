// Fog between the eye and a place. fog_clear.wgsl replaces this file in pipelines without fog.
//!include "between/air.wgsl"
//!include "between/bow.wgsl"
//!include "fog/lookup.wgsl"

// Whether there is any fog.
override FOG: bool = true;

// Lays the fog over `behind`, which is the air along the whole ray (sky: its light, transmittance 0). A fog bank far
// away has air in front of it; fog around the camera is in front of the air (fog/lookup.wgsl).
fn with_fog(ray: ViewRay, range: f32, plane: f32, behind: Veil) -> Veil {
    if !FOG || drawn.y == 0.0 {
        return behind;
    }
    // Drops and flakes near the eye that are drawn one by one hide this share themselves.
    let hidden = drawn.w * depth_of_drawn(range);
    var f = fog_beside_drops(low_air.fog, ray.origin, ray.direction, range, plane, hidden);
    if BOW {
        f.radiance = max(f.radiance + f.once * bow_phase(BOW_LOW_AIR, ray.direction, low_air.fog.to_sun), vec3f(0.0));
    }
    f.radiance *= drawn.y * air_lit;
    f.transmittance = mix(vec3f(1.0), f.transmittance, drawn.y);
    var before = Veil(vec3f(0.0), vec3f(1.0));
    if f.distance > 50.0 {
        before = air_between(ray.direction, f.distance);
    }
    let beyond = mix(1.0, f.shade, drawn.y) * behind.light - before.light;
    let light = before.light + before.transmittance * f.radiance + f.transmittance * beyond;
    return Veil(light, behind.transmittance * f.transmittance);
}
