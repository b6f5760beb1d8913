// In place of on_surfaces.wgsl where a pipeline draws nothing on surfaces.
//!include "between/air.wgsl"
//!include "frame/host_picture.wgsl"

// As ground/surface.wgsl has it.
var<private> water_cover: f32;

fn on_surface(veil: Veil, host: vec3f, ray: ViewRay, seen: Seen) -> Veil {
    return veil;
}
