// Measures the light that leaves a box of even cloud through its sides, with the march of the picture (about_box.wgsl
// replaces about.wgsl). Six tiles lie side by side, one for each face (x low, x high, y low, y high, base, top), with
// one ray a pixel. Directions are distributed as the cosine of their angle with the face's normal.
//!include "common/fullscreen.wgsl"
//!include "clouds/march.wgsl"
//!include "clouds/box.wgsl"

// Number of rays along each side of a face's tile.
const PROBE_SIDE: u32 = 64u;

// Quasirandom points in the unit cube (Roberts 2018, "The unreasonable effectiveness of quasirandom sequences").
fn spread(i: u32) -> vec4f {
    return fract(vec4f(0.5) + f32(i) * vec4f(0.8566749, 0.7338919, 0.6287067, 0.5385973));
}

// Marches one ray of the probe.
@fragment
fn box_probe(in: FullscreenVarying) -> @location(0) vec4f {
    let layer = clouds.layers[0];
    let pixel = vec2u(in.position.xy);
    let face = pixel.x / PROBE_SIDE;
    let p = spread(pixel.y * PROBE_SIDE + pixel.x % PROBE_SIDE);
    let sides = box_sides(layer);
    let axis = face / 2u;
    let sine = sqrt(p.z);
    let azimuth = 2.0 * CLOUD_PI * p.w;
    // Direction out of the face, and position on it.
    let out = vec3f(sine * cos(azimuth), sine * sin(azimuth), sqrt(1.0 - p.z) * select(-1.0, 1.0, face % 2u == 1u));
    let on = vec3f(p.xy, f32(face % 2u));
    var away = out;
    var at = on;
    if axis == 0u {
        away = out.zxy;
        at = on.zxy;
    } else if axis == 1u {
        away = out.yzx;
        at = on.yzx;
    }
    box_origin = at * sides;
    cloud_origin = box_origin;
    let length = box_exit(clamp(box_origin, 1e-4 * sides, (1.0 - 1e-4) * sides), sides, -away);
    let none = CloudMarch(vec3f(0.0), 1.0, vec2f(0.0));
    let seen = cloud_layer_along(layer, -away, 0.0, length, none, 0.5);
    return vec4f(seen.light.rgb, seen.transmittance);
}
