//! Refused frames: by name, before any work, and nothing is changed.

use std::time::Instant;

use glam::{DMat4, DVec3};
use welkin::{
    Status,
    frame::{Exposure, Frame, Stages},
};
use welkin_support::frame_host::{Host, camera, texture};

const FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Rgba16Float;

#[test]
fn refused_frames_are_named_and_neither_submit_nor_change_anything() {
    let mut host = Host::new(FORMAT);
    let mut fresh = Host::new(FORMAT);
    let device = host.device.clone();
    let (color, depth) = (host.color.clone(), host.depth.clone());
    let red = texture(&device, wgpu::TextureFormat::R8Unorm, 1);
    let many = texture(&device, wgpu::TextureFormat::Rgba16Float, 4);
    // In 8 bits, so that it can be a mask.
    let plain = texture(&device, wgpu::TextureFormat::Rgba8Unorm, 1);
    let half = texture(&device, wgpu::TextureFormat::Rgba16Float, 1);
    let masks = "mask.format: Rgba16Float; supported: R8Unorm, Rgba8Unorm (with or without Srgb), Bgra8Unorm";
    let good = || Frame::new(5, camera(), &color, Some(&depth));
    let mut flat = camera();
    flat.projection = DMat4::ZERO;
    let all = Stages::ALL;
    let cases = [
        ("color must be given", Frame { color: None, ..good() }, all),
        // Refused even while there is nothing to draw; otherwise it would fail with the first rain.
        ("color must be given", Frame { color: None, ..good() }, Stages::PARTICLES),
        ("color.format: R8Unorm", Frame { color: Some(&red), ..good() }, all),
        ("color.format: Depth32Float", Frame { color: Some(&depth), ..good() }, all),
        ("depth.format", Frame { depth: Some(&color), ..good() }, all),
        ("mask must be another texture than color", Frame { color: Some(&plain), mask: Some(&plain), ..good() }, all),
        (masks, Frame { mask: Some(&half), ..good() }, all),
        ("depth.samples", Frame { color: Some(&many), ..good() }, all),
        ("cd_m2_per_unit", Frame { cd_m2_per_unit: 0.0, ..good() }, all),
        ("exposure.factor", Frame { exposure: Some(Exposure::Factor(-1.0)), ..good() }, all),
        ("camera_velocity_m_s", Frame { camera_velocity_m_s: DVec3::splat(1e9), ..good() }, all),
        ("projection", Frame { camera: flat, ..good() }, all),
        ("stages", good(), Stages(128)),
    ];
    let before = (device.submissions(), *host.view.report());
    for (name, frame, stages) in &cases {
        let e = host.view.record(&host.context, frame, *stages).unwrap_err();
        assert!(matches!(e.status, Status::InvalidArgument | Status::Unsupported), "{name}: {e}");
        assert!(e.to_string().contains(name) && e.field().is_some(), "{name}: {e:?}");
        assert!(!e.to_string().contains("TextureUsages"), "{e}");
        assert_eq!((device.submissions(), *host.view.report()), before, "{name}");
    }
    // The next frame is the view's first one, and equals that of a view without refused frames.
    for host in [&mut host, &mut fresh] {
        host.clear([100.0, 2000.0, 300.0, 1.0], 1e-4);
        host.record(5, Stages::ALL).unwrap();
    }
    assert!(host.view.report().tables_rebuilt > 0 && host.pixels() == fresh.pixels());
    // And a refusal in between costs next to nothing of what a frame costs.
    let wrong = Frame { cd_m2_per_unit: 0.0, frame_id: 6, ..good() };
    let mut seconds = |refused: bool| {
        let mut all: Vec<_> = (0..9)
            .map(|i| {
                let start = Instant::now();
                if refused {
                    assert!(host.view.record(&host.context, &wrong, Stages::ALL).is_err());
                } else {
                    host.record(10 + i, Stages::ALL).unwrap();
                    host.device.wait().unwrap();
                }
                start.elapsed().as_secs_f64()
            })
            .collect();
        all.sort_by(f64::total_cmp);
        all[4]
    };
    let (drawn, refused) = (seconds(false), seconds(true));
    assert!(refused < 0.2 * drawn, "{refused} s of {drawn} s");
}
