// Quantity in which errors are measured.
//!include "frame/color_space.wgsl"
//!include "between/air.wgsl"

// Exposed luminance, 1 = white. For a scene-linear host it is the luminance before the tone curve.
fn exposed(host: vec3f, veil: Veil) -> f32 {
    var light = veil.light * frame.exposure;
    var behind = linear_host(host);
    if is_space(SCENE_LINEAR) {
        behind *= frame.exposure;
    } else {
        light = tone_curve(frame.tone, light);
    }
    return dot(behind * veil.transmittance + light, vec3f(0.2126, 0.7152, 0.0722));
}
