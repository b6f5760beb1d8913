// Veil for the host's own transparent shaders: air, clouds and fog.
//!include "frame/froxel.wgsl"

@fragment
fn froxels(in: FullscreenVarying) -> Froxel {
    return froxel_of(froxel_veil(froxel_place(in.position.xy)));
}
