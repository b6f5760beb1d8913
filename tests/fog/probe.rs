//! The probe: what it draws and what it refuses.

use welkin::Status;
use welkin::fog::{probe, probe_csv};
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

/// Tier 0 on OpenGL draws the same, to the half floats it may have to draw into.
#[test]
fn opengl_draws_the_same() {
    let options = DeviceOptions { backends: wgpu::Backends::GL, force_tier0: true, ..Default::default() };
    let Ok(gl) = Device::headless(&options) else {
        eprintln!("no OpenGL here");
        return;
    };
    for v in [50.0, 50_000.0] {
        for (i, [contrast, transmittance]) in probe(&gl, v, &[0.0, v / 2.0, v]).unwrap().into_iter().enumerate() {
            let want = 0.05f64.powf(i as f64 / 2.0);
            assert!((transmittance - want).abs() < 1e-3 && (contrast - want).abs() < 1e-3, "{v} {i}: {contrast}");
        }
    }
}

#[test]
fn csv_goes_through_and_faults_are_placed() {
    let out = probe_csv(device(), 1000.0, "name,distance_m\r\nnear, 0\r\n\r\nfar,1000\r\n").unwrap();
    let lines: Vec<&str> = out.lines().collect();
    assert_eq!(lines[0], "name,distance_m,contrast,transmittance");
    assert!(lines[1].starts_with("near, 0,1.00000") || lines[1].starts_with("near, 0,0.99999"), "{}", lines[1]);
    let last: f64 = lines[2].rsplit(',').next().unwrap().parse().unwrap();
    assert!((last - 0.05).abs() < 1e-4 && lines.len() == 3, "{out}");
    let says = |text: &str| {
        let e = probe_csv(device(), 1000.0, text).unwrap_err();
        assert_eq!(e.status, Status::Parse);
        e.to_string()
    };
    assert!(says("").contains("line 1"));
    assert!(says("distance\n5\n").contains("distance_m"));
    assert!(says("a,distance_m\n1,5\n22,x\n").starts_with("line 3, column 4"));
    assert!(says("a,distance_m\n1\n").starts_with("line 2, column 2"));
    for bad in ["nan", "-1", "inf", "1e10", "5m"] {
        assert!(says(&format!("distance_m\n{bad}\n")).starts_with("line 2, column 1"));
    }
    assert!(probe(device(), f64::NAN, &[1.0]).unwrap_err().to_string().contains("visibility_m"));
    assert!(probe(device(), 0.5, &[1.0]).unwrap_err().to_string().contains("visibility_m"));
    assert!(probe(device(), 50.0, &[]).unwrap().is_empty());
}
