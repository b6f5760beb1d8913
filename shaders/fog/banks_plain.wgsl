// Replaces banks.wgsl in pipelines that draw no fog banks.
//!include "fog/lookup.wgsl"

// Constants of banks.wgsl. Only BY_PLACE is read in these pipelines, and it is false.
override BY_PLACE: bool = false;
override BANKS_OVERLAP: bool = true;
override BANK_SHAPES: u32 = 15u;

fn banks_met(origin: vec3f, direction: vec3f, range: f32) -> u32 {
    return 0u;
}

fn first_bank(met: u32) -> u32 {
    return 0u;
}

var<private> bank_paths: array<LayerPath, 8>;

fn measure_banks(met: u32, origin: vec3f, direction: vec3f, range: f32, paths: bool) {}

fn bank_path(k: u32, paths: array<LayerPath, 8>, origin: vec3f, direction: vec3f, range: f32) -> LayerPath {
    return LayerPath(0.0, 0.0, 0.0);
}

fn bank_along(k: u32, path: LayerPath, origin: vec3f, direction: vec3f, range: f32) -> Fog {
    return Fog(vec3f(0.0), 0.0, vec3f(1.0), 1.0, vec3f(0.0));
}
