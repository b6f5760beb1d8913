//! Neither Welkin nor what it loads writes to the host's standard output or standard error when a device is made, not
//! even where no variable of the environment is set, as in services and containers.

use std::process::Command;

use welkin::gpu::{Device, DeviceOptions};

/// Environment variable that gives a child process the way to make a device.
const WAY: &str = "WELKIN_TEST_WAY";

const ANY: wgpu::Backends =
    wgpu::Backends::VULKAN.union(wgpu::Backends::METAL).union(wgpu::Backends::DX12).union(wgpu::Backends::GL);

/// Ways by name: interfaces, whether to omit compute shaders, and whether to use the software driver.
const WAYS: [(&str, wgpu::Backends, [bool; 2]); 6] = [
    ("any", ANY, [false, false]),
    ("any by software without compute", ANY, [true, true]),
    ("vulkan", wgpu::Backends::VULKAN, [false, false]),
    ("vulkan or noop", wgpu::Backends::VULKAN.union(wgpu::Backends::NOOP), [false, false]),
    ("opengl", wgpu::Backends::GL, [false, false]),
    ("noop", wgpu::Backends::NOOP, [false, false]),
];

#[test]
fn a_child_makes_a_device() {
    let Ok(way) = std::env::var(WAY) else { return };
    let (_, backends, [force_tier0, force_software]) = WAYS.into_iter().find(|w| w.0 == way).unwrap();
    // Twice, because the second time everything is already loaded. Without such a driver the refusal must be silent
    // too.
    for _ in 0..2 {
        let _ = Device::headless(&DeviceOptions { backends, force_tier0, force_software });
    }
}

#[test]
fn making_a_device_writes_to_neither_descriptor_in_a_bare_environment() {
    for (way, ..) in WAYS {
        let mut child = Command::new(std::env::current_exe().unwrap());
        child.args(["--exact", "quiet::a_child_makes_a_device", "--nocapture", "--test-threads=1"]);
        let output = child.env_clear().env(WAY, way).output().unwrap();
        let [out, err] = [output.stdout, output.stderr].map(|bytes| String::from_utf8_lossy(&bytes).into_owned());
        assert!(output.status.success() && err.is_empty(), "{way}: standard error has {err:?}");
        // The lines of the test harness, with nothing between them.
        let own = ["", "running 1 test", "test quiet::a_child_makes_a_device ... ok"];
        let others = out.lines().filter(|l| !own.contains(l) && !l.starts_with("test result: ok. 1 passed;"));
        assert_eq!(others.collect::<Vec<_>>(), [""; 0], "{way}: standard output");
    }
}
