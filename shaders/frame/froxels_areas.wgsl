// Veil for the host's own transparent shaders if there are rain areas: air, clouds and fog, with the rain columns in
// front.
//!include "frame/froxel.wgsl"
//!include "rain/shaft.wgsl"

@fragment
fn froxels(in: FullscreenVarying) -> Froxel {
    let at = froxel_place(in.position.xy);
    var veil = froxel_veil(at);
    // The columns are laid over the veil from far to near. The pass that draws the layer in front of the picture blends
    // them in the same order.
    for (var k = 0u; k < column_count(); k++) {
        if shaft.rects[k].z <= shaft.rects[k].x {
            // The other columns are not in the picture.
            break;
        }
        let column = shaft_veil(shaft.order[k / 4u][k % 4u], picture_pixel(at.ndc), at.ndc, at.distance);
        let clear = max(1.0 - column.a, 0.0);
        veil = Veil(veil.light * clear + column.rgb / frame.exposure, veil.transmittance * clear);
    }
    return froxel_of(veil);
}
