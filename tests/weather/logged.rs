//! wgpu logs no error while OpenGL draws weathers. The log is checked because the software driver accepts calls that
//! other drivers may refuse.

use std::sync::Mutex;

use glam::DVec3;
use welkin::{
    almanac::Utc,
    frame::{Frame, Stages},
    gpu::{Device, DeviceOptions},
    lightning::{FlashKind, FlashTrigger},
    rain::RainArea,
    scene::Camera,
    weather::Weather,
};
use welkin_support::frame_host::{Host, coarse};

/// A night without a moon, and noon of the same day.
const TIMES: [Utc; 2] = [Utc(1_768_773_600.0), Utc(1_768_773_600.0 + 43_200.0)];

static ERRORS: Mutex<Vec<String>> = Mutex::new(Vec::new());

struct Listener;

impl log::Log for Listener {
    fn enabled(&self, _: &log::Metadata<'_>) -> bool {
        true
    }
    fn log(&self, record: &log::Record<'_>) {
        // Without a window system wgpu logs an error for the first EGL display and tries the next.
        if record.level() == log::Level::Error && !record.target().ends_with("egl") {
            ERRORS.lock().unwrap().push(format!("{}: {}", record.target(), record.args()));
        }
    }
    fn flush(&self) {}
}

#[test]
fn opengl_logs_no_error() {
    log::set_logger(&Listener).unwrap();
    log::set_max_level(log::LevelFilter::Error);
    for force_tier0 in [false, true] {
        let options = DeviceOptions { backends: wgpu::Backends::GL, force_tier0, ..DeviceOptions::default() };
        let device = Device::headless(&options).expect("a software driver is installed");
        let mut host = Host::of(device, wgpu::TextureFormat::Rgba16Float, coarse());
        host.context.set_sun(None).unwrap();
        let camera = Camera::look_to(DVec3::Z * 2.0, DVec3::new(0.0, 1.0, 0.2), DVec3::Z, 1.0, 160.0 / 90.0, 0.1);
        let (mut id, mut time_s) = (0, 0.0);
        for utc in TIMES {
            host.context.set_clock(utc, time_s).unwrap();
            for name in ["clear", "scattered", "fog", "rain", "thunderstorm", "snow"] {
                time_s += 1.0;
                host.context.set_weather(&Weather::preset(name).expect("a preset"), time_s, 0.0).unwrap();
                let areas = [RainArea { center_m: [0.0, 9000.0, 0.0], ..RainArea::default() }];
                host.context.set_rain_areas(&areas[usize::from(name != "scattered")..]).unwrap();
                if name == "thunderstorm" {
                    let (position, kind) = (DVec3::Y * 3000.0, FlashKind::ToGround);
                    let flash = FlashTrigger { time_s, position, kind, peak_ka: None, strokes: None };
                    host.context.trigger_flash(&flash).unwrap();
                }
                host.context.update(time_s).unwrap();
                for far in [0.0, 2e-4] {
                    host.clear([0.2, 0.3, 0.4, 1.0], far);
                    id += 1;
                    let frame = Frame::new(id, camera, &host.color, Some(&host.depth));
                    host.view.record(&host.context, &frame, Stages::ALL).unwrap();
                    host.device.wait().unwrap();
                    let errors = std::mem::take(&mut *ERRORS.lock().unwrap());
                    assert!(errors.is_empty(), "{name} at {utc:?}, tier 0 {force_tier0}: {errors:?}");
                }
            }
        }
    }
}
