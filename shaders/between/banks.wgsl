// Fog banks between the eye and a place. banks_plain.wgsl replaces this file in pipelines without banks.
//!include "between/air.wgsl"
//!include "fog/banks.wgsl"

// Banks that a ray may meet in front of `range`.
fn banks_before(ray: ViewRay, range: f32) -> u32 {
    if !FOG_BANKS {
        return 0u;
    }
    return banks_met(ray.origin, ray.direction, range);
}

// Optical depth at 550 nm of the fog outside all banks that the banks `met` replace.
fn replaced_by_banks(met: u32, ray: ViewRay, range: f32) -> f32 {
    return fog_of_banks(met, ray.origin, ray.direction, range);
}

// Lays the banks `met` over `behind`, each with the air and the fog outside all banks in front of it.
fn with_banks(met: u32, ray: ViewRay, range: f32, behind: Veil) -> Veil {
    var veil = behind;
    var left = met;
    // Software drivers draw as many rounds as the pixel of a group that meets most banks.
    for (var i = 0u; FOG_BANKS && i < MOST_BANKS && left != 0u; i++) {
        let bank = bank_along(first_bank(left), ray.origin, ray.direction, range);
        left &= left - 1u;
        if bank.transmittance.y < 1.0 {
            var before = Veil(vec3f(0.0), vec3f(1.0));
            if bank.distance > 50.0 {
                before = air_between(ray.direction, bank.distance);
                before = with_low_air(ray, bank.distance, bank.distance, met, before);
            }
            veil = with_layer(bank, before, veil);
        }
    }
    return veil;
}
