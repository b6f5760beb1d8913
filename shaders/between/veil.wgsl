// What lies between the eye and a point: the light that the air and the fog send, and what they let through.
//!include "common/frame.wgsl"
//!include "between/fog_binding.wgsl"
//!include "sky/lookup.wgsl"

// Whether there is any fog.
override FOG: bool = true;
// Whether the air between is drawn at all.
override AIR: bool = true;

// The deck hides all of the sky: no light of the clear sky is asked for above the horizon and in the air.
override DECK_CLOSED: bool = false;

// Light that reaches the eye beside what comes from behind, and the share of the latter that gets through.
struct Veil {
    light: vec3f,
    transmittance: vec3f,
}

// Mean luminance of an overcast sky over elevation (CIE S 011, the standard overcast sky), 1 at the zenith.
fn overcast_gradation(sin_elevation: f32) -> f32 {
    return (1.0 + 2.0 * max(sin_elevation, 0.0)) / 3.0;
}

fn air_between(d: vec3f, distance: f32) -> Veil {
    return air_on(sky_path(d, distance), d);
}

fn air_on(path: SkyPath, d: vec3f) -> Veil {
    if !AIR || drawn.x == 0.0 {
        return Veil(vec3f(0.0), vec3f(1.0));
    }
    let transmittance = exp(-path.depth);
    // No beam reaches the air below a deck: it is lit by the deck, and far things fade to the deck at the horizon.
    var light = frame.deck * overcast_gradation(0.0) * (1.0 - transmittance);
    if !DECK_CLOSED {
        light = mix(color_of(aerial_on(path, d).radiance) * frame.medium_share, light, frame.deck_cover);
    }
    light += frame.night_floor * (1.0 - transmittance);
    return Veil(light * drawn.x, mix(vec3f(1.0), transmittance, drawn.x));
}

// `behind` is what air does over the ray's whole length (sky: its light, transmittance 0). A fog bank far away has air
// before it, the fog round the camera lies before the air (fog/lookup.wgsl).
fn with_fog(ray: ViewRay, range: f32, plane: f32, behind: Veil) -> Veil {
    if !FOG || drawn.y == 0.0 {
        return behind;
    }
    var f = fog_along(fog, ray.origin, ray.direction, range, plane);
    f.radiance *= drawn.y;
    f.transmittance = mix(vec3f(1.0), f.transmittance, drawn.y);
    // What drops near the eye hide is drawn as drops.
    let thinner = min(f.transmittance * exp(drawn.w * frame.drops.x * min(range, frame.drops.y)), vec3f(1.0));
    f.radiance *= (1.0 - thinner) / max(1.0 - f.transmittance, vec3f(1e-6));
    f.transmittance = thinner;
    var before = Veil(vec3f(0.0), vec3f(1.0));
    if f.distance > 50.0 {
        before = air_between(ray.direction, f.distance);
    }
    let beyond = mix(1.0, f.shade, drawn.y) * behind.light - before.light;
    let light = before.light + before.transmittance * f.radiance + f.transmittance * beyond;
    return Veil(light, behind.transmittance * f.transmittance);
}

// Air and fog together, for what lies `range` metres along the ray.
fn veil_between(ray: ViewRay, range: f32, plane: f32) -> Veil {
    return with_fog(ray, range, plane, air_between(ray.direction, range));
}
