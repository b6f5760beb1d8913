//! A scene-linear host whose unit cannot be right is warned, once; one whose unit can be is not.

use std::cell::RefCell;

use welkin::frame::{ColorSpace, Frame, Stages, View};
use welkin_support::frame_host::{Host, camera};

thread_local! {
    /// Warnings of this test's thread; other tests record at the same time.
    static WARNINGS: RefCell<Vec<String>> = const { RefCell::new(Vec::new()) };
}

struct Listener;

impl log::Log for Listener {
    fn enabled(&self, _: &log::Metadata<'_>) -> bool {
        true
    }
    fn log(&self, record: &log::Record<'_>) {
        if record.level() == log::Level::Warn && record.target().starts_with("welkin") {
            WARNINGS.with_borrow_mut(|w| w.push(record.args().to_string()));
        }
    }
    fn flush(&self) {}
}

/// Returns the warnings of six frames of a new view whose host draws ground of `value` at `unit`.
fn heard(host: &mut Host, space: ColorSpace, value: f64, unit: f64, sky_first: bool) -> Vec<String> {
    WARNINGS.take();
    host.view = View::new(&host.context).unwrap();
    for id in 1..7 {
        host.clear([value, value, value, 1.0], 1e-4);
        let mut frame = Frame::new(id, camera(), &host.color, Some(&host.depth));
        frame.color_space = space;
        frame.cd_m2_per_unit = unit;
        let calls = if sky_first { [Stages::BACKGROUND, Stages::MEDIUM] } else { [Stages::PREPARE, Stages::MEDIUM] };
        for stages in calls {
            host.view.record(&host.context, &frame, stages).unwrap();
        }
        host.device.wait().unwrap();
    }
    WARNINGS.take()
}

#[test]
fn a_unit_that_cannot_be_right_is_warned_of_once() {
    log::set_logger(&Listener).unwrap();
    log::set_max_level(log::LevelFilter::Warn);
    let scene = ColorSpace::SceneLinear;
    let floats = Host::new(wgpu::TextureFormat::Rgba16Float);
    let bytes = Host::on(floats.device.clone(), wgpu::TextureFormat::Rgba8Unorm);
    let mut hosts = [floats, bytes];
    const FLOATS: usize = 0;
    const BYTES: usize = 1;
    for (host, sky_first) in [(BYTES, false), (FLOATS, false), (FLOATS, true)] {
        let texts = heard(&mut hosts[host], scene, 0.5, 1.0, sky_first);
        assert_eq!(texts.len(), 1, "{sky_first}: {texts:?}");
        for part in ["black", "cd_m2_per_unit 1 ", "wk_context_get_frame_light"] {
            assert!(texts[0].contains(part), "{part}: {texts:?}");
        }
    }
    for (host, space, value, unit) in [
        (FLOATS, scene, 5000.0, 1.0),
        (FLOATS, scene, 0.5, 1e4),
        (BYTES, scene, 0.5, 1e4),
        // A dim room in daylight, and a picture in which nothing is drawn.
        (FLOATS, scene, 50.0, 1.0),
        (FLOATS, scene, 0.0, 1.0),
        (BYTES, ColorSpace::DisplaySrgb, 0.5, 1.0),
        (FLOATS, ColorSpace::DisplayLinear, 0.5, 1.0),
    ] {
        let texts = heard(&mut hosts[host], space, value, unit, false);
        assert!(texts.is_empty(), "{space:?} {value} {unit}: {texts:?}");
    }
    let bright = heard(&mut hosts[FLOATS], scene, 5000.0, 1e6, false);
    assert!(bright.len() == 1 && bright[0].contains("white"), "{bright:?}");
}
