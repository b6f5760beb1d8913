//! The textures for the host's transparent shaders agree with the composition.

use welkin::{
    frame::{Exposure, Frame, Stages},
    gpu::readback,
};
use welkin_support::frame_host::{Host, SIZE, camera};

use crate::spaces::{EXPOSURE, veil};

/// The published snippet's look-up on the CPU: bilinear within a tile, linear between slices.
pub fn sample(texels: &[[f32; 4]], uv: [f64; 2], distance: f64) -> [f64; 3] {
    let s = ((distance / 20.0 + 1.0).ln() * 3.639_611_2).clamp(0.0, 31.0);
    let near = s.floor().min(30.0);
    let at = |slice: f64| {
        let (x, y) = ((slice % 8.0) * 32.0 + uv[0] * 31.0, (slice / 8.0).floor() * 18.0 + uv[1] * 17.0);
        let texel = |i: f64, j: f64| texels[j as usize * 256 + i as usize];
        [0, 1, 2].map(|c| {
            let row = |j: f64| {
                let (a, b) = (texel(x.floor(), j)[c], texel(x.ceil(), j)[c]);
                f64::from(a) + x.fract() * f64::from(b - a)
            };
            row(y.floor()) + y.fract() * (row(y.ceil()) - row(y.floor()))
        })
    };
    let (a, b) = (at(near), at(near + 1.0));
    [0, 1, 2].map(|c| a[c] + (s - near) * (b[c] - a[c]))
}

#[test]
fn froxels_agree_with_the_composition() {
    let mut host = Host::new(wgpu::TextureFormat::Rgba16Float);
    host.view.frame_textures().unwrap();
    let mut frame = Frame::new(1, camera(), &host.color, Some(&host.depth));
    frame.exposure = Some(Exposure::Factor(EXPOSURE));
    host.view.record(&host.context, &frame, Stages::BACKGROUND.with(Stages::MEDIUM)).unwrap();
    let textures = host.view.frame_textures().unwrap();
    let light = readback::rgba(&host.device, &textures.light).unwrap();
    let through = readback::rgba(&host.device, &textures.through).unwrap();
    // The wall of `veil` stands 2 km before the camera's plane, so farther along the rays at the picture's edge.
    let (half_height, half_width) = (0.5f64.tan(), 0.5f64.tan() * 16.0 / 9.0);
    for (i, (want_light, want_through)) in veil().iter().enumerate().step_by(97) {
        let (x, y) = (i as u32 % SIZE.0, i as u32 / SIZE.0);
        let uv = [(f64::from(x) + 0.5) / f64::from(SIZE.0), (f64::from(y) + 0.5) / f64::from(SIZE.1)];
        let slant =
            (1.0 + (half_width * (2.0 * uv[0] - 1.0)).powi(2) + (half_height * (2.0 * uv[1] - 1.0)).powi(2)).sqrt();
        let (l, t) = (sample(&light, uv, 2000.0 * slant), sample(&through, uv, 2000.0 * slant));
        for c in 0..3 {
            let l = l[c] * f64::from(textures.light_scale);
            assert!((l - want_light[c]).abs() < 0.06 * want_light[c] + 1.0, "{x} {y}: {l} {want_light:?}");
            assert!((t[c] - want_through[c]).abs() < 0.02, "{x} {y}: {t:?} {want_through:?}");
        }
    }
}

#[test]
fn the_snippets_are_valid_and_share_their_constants() {
    let (wgsl, glsl) = (welkin::frame::SNIPPET_WGSL, welkin::frame::SNIPPET_GLSL);
    welkin::gpu::shader::validate(wgsl).unwrap();
    for constant in ["3.6396112", "20.0", "256.0, 72.0", "31.0, 17.0"] {
        assert!(wgsl.contains(constant) && glsl.contains(constant), "{constant}");
    }
}
