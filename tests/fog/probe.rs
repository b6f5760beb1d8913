//! The probe of fog: its results, and the inputs that it refuses.

use welkin::fog::probe;
use welkin::gpu::{Device, DeviceOptions};

use super::gpu::device;

#[test]
fn the_probe_draws_koschmieder() {
    for v in [1.0, 50.0, 150.0, 1000.0, 20_000.0, 50_000.0, 1e6] {
        let distances: Vec<f64> = (0..600).map(|i| v * f64::from(i) / 200.0).collect();
        for (d, [contrast, transmittance]) in distances.iter().zip(probe(device(), v, &distances).unwrap()) {
            let want = 0.05f64.powf(d / v);
            assert!((transmittance - want).abs() < 1e-4, "V {v} at {d}: {transmittance} of {want}");
            assert!((contrast - want).abs() < 1e-4, "V {v} at {d}: contrast {contrast} of {want}");
        }
    }
}

/// Tier 0 on OpenGL draws the same, within the rounding of half floats, into which it may have to draw.
#[test]
fn opengl_draws_the_same() {
    let options = DeviceOptions { backends: wgpu::Backends::GL, force_tier0: true, ..Default::default() };
    let gl = Device::headless(&options).expect("an OpenGL driver: make setup installs one");
    for v in [50.0, 50_000.0] {
        for (i, [contrast, transmittance]) in probe(&gl, v, &[0.0, v / 2.0, v]).unwrap().into_iter().enumerate() {
            let want = 0.05f64.powf(i as f64 / 2.0);
            assert!((transmittance - want).abs() < 1e-3 && (contrast - want).abs() < 1e-3, "{v} {i}: {contrast}");
        }
    }
}

#[test]
fn visibilities_out_of_range_are_refused() {
    for bad in [f64::NAN, 0.5] {
        assert!(probe(device(), bad, &[1.0]).unwrap_err().to_string().contains("visibility_m"));
    }
    assert!(probe(device(), 50.0, &[]).unwrap().is_empty());
}
