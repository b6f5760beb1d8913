// Fog between the eye and a place. fog_clear.wgsl replaces this file in pipelines without fog.
//!include "between/air.wgsl"
//!include "between/bow.wgsl"
//!include "fog/banks.wgsl"

// Whether there is any fog.
override FOG: bool = true;

// Lays one layer of fog over `behind`, by the drawn share of the fog. `before` is the air and the other fog up to the
// distance of the layer.
fn with_layer(layer: Fog, before: Veil, behind: Veil) -> Veil {
    let through = mix(vec3f(1.0), layer.transmittance, drawn.y);
    let beyond = mix(1.0, layer.shade, drawn.y) * behind.light - before.light;
    let light = before.light + before.transmittance * (layer.radiance * drawn.y * air_lit) + through * beyond;
    return Veil(light, behind.transmittance * through);
}

// Lays the fog outside all banks over `behind`. A fog far away has air in front of it; fog around the camera is in
// front of the air (fog/lookup.wgsl).
fn with_low_air(ray: ViewRay, range: f32, plane: f32, behind: Veil) -> Veil {
    // Drops and flakes near the eye that are drawn one by one hide this optical depth themselves.
    let hidden = drawn.w * depth_of_drawn(range);
    var f = fog_beside_drops(low_air.fog, ray.origin, ray.direction, range, plane, hidden);
    if BOW {
        f.radiance = max(f.radiance + f.once * bow_phase(BOW_LOW_AIR, ray.direction, low_air.fog.to_sun), vec3f(0.0));
    }
    var before = Veil(vec3f(0.0), vec3f(1.0));
    if f.distance > 50.0 {
        before = air_between(ray.direction, f.distance);
    }
    return with_layer(f, before, behind);
}

// Lays the fog outside all banks over `behind`, then the banks `met` (banks_met) from far to near, each with the air
// and the outer fog in front of it.
fn with_banks(met: u32, ray: ViewRay, range: f32, plane: f32, behind: Veil) -> Veil {
    measure_banks(met, ray.origin, ray.direction, range, true);
    let paths = bank_paths;
    var veil = with_low_air(ray, range, plane, behind);
    var left = met;
    // On software drivers, all pixels of a group take as many rounds as the pixel that meets the most banks.
    for (var i = 0u; i < MOST_BANKS && left != 0u; i++) {
        let k = first_bank(left);
        left &= left - 1u;
        let path = bank_path(k, paths, ray.origin, ray.direction, range);
        let bank = bank_along(k, path, ray.origin, ray.direction, range);
        if bank.transmittance.y < 1.0 {
            var before = Veil(vec3f(0.0), vec3f(1.0));
            if bank.distance > 50.0 {
                before = air_between(ray.direction, bank.distance);
                measure_banks(met, ray.origin, ray.direction, bank.distance, false);
                before = with_low_air(ray, bank.distance, bank.distance, before);
            }
            veil = with_layer(bank, before, veil);
        }
    }
    return veil;
}

// Lays fog and fog banks over `behind`: the air along the whole ray, or in a pixel of the sky the sky's light with
// transmittance 0.
fn with_fog(ray: ViewRay, range: f32, plane: f32, behind: Veil) -> Veil {
    if !FOG || drawn.y == 0.0 {
        return behind;
    }
    if !BY_PLACE {
        return with_low_air(ray, range, plane, behind);
    }
    let banks = banks_met(ray.origin, ray.direction, range);
    return with_banks(banks, ray, range, plane, behind);
}
