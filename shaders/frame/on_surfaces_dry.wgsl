// Version of on_surfaces.wgsl for pipelines that draw nothing on surfaces.
//!include "between/air.wgsl"
//!include "frame/host_picture.wgsl"

// Share of the surface under water, as in ground/water.wgsl.
var<private> water_cover: f32;

fn on_surface(veil: Veil, host: vec3f, ray: ViewRay, seen: Seen) -> Veil {
    return veil;
}
