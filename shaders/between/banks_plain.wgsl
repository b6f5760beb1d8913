// Replaces banks.wgsl in pipelines that draw no fog banks.
//!include "between/air.wgsl"

fn banks_before(ray: ViewRay, range: f32) -> u32 {
    return 0u;
}

fn replaced_by_banks(met: u32, ray: ViewRay, range: f32) -> f32 {
    return 0.0;
}

fn with_banks(met: u32, ray: ViewRay, range: f32, behind: Veil) -> Veil {
    return behind;
}
