//! The scene of a frame is computed once for all calls of the frame, and again when any of its inputs changes.

use std::sync::Arc;

use glam::DVec3;

use crate::{
    almanac::sun::Utc,
    context::{Context, ContextDesc, GivenDirection},
    fog::Law,
    frame::{Frame, Stages, View},
    gpu::{Device, DeviceOptions, Shared, flat_texture},
    planet::Planet,
    rain::RainArea,
    scene::Camera,
    weather::Weather,
};

struct Host {
    device: Arc<Device>,
    context: Context,
    view: View,
    camera: Camera,
    frame_id: u64,
}

const EACH: [Stages; 7] = [
    Stages::PREPARE,
    Stages::BACKGROUND,
    Stages::SURFACE,
    Stages::MEDIUM,
    Stages::PARTICLES,
    Stages::LENS,
    Stages::TONE,
];

impl Host {
    fn new() -> Self {
        let options = DeviceOptions { backends: wgpu::Backends::NOOP, ..DeviceOptions::default() };
        let device = Device::headless(&options).unwrap();
        let mut context =
            Context::new(device.clone(), Arc::new(Shared::new(&device).unwrap()), ContextDesc::default()).unwrap();
        context.set_weather(&Weather::preset("rain").unwrap(), 0.0, 0.0).unwrap();
        let view = View::new(&context).unwrap();
        let camera = Camera::look_to(DVec3::Z * 2.0, DVec3::Y, DVec3::Z, 0.9, 2.0, 0.1);
        Self { device, context, view, camera, frame_id: 0 }
    }

    /// Number of scenes computed so far.
    fn scenes(&self) -> u64 {
        self.view.scene_count()
    }

    fn call(&mut self, stages: Stages) -> crate::Result<()> {
        let texture = |format, usage| flat_texture(&self.device.device, "host", (8, 4), format, usage);
        use wgpu::TextureUsages as U;
        let seen = U::TEXTURE_BINDING | U::RENDER_ATTACHMENT;
        let color = texture(wgpu::TextureFormat::Rgba16Float, seen | U::COPY_SRC | U::COPY_DST);
        let depth = texture(wgpu::TextureFormat::Depth32Float, seen);
        let frame = Frame::new(self.frame_id, self.camera, &color, Some(&depth));
        self.view.record(&self.context, &frame, stages)
    }

    /// Draws a frame with one call for each stage; returns the number of scenes computed for it.
    fn frame(&mut self) -> u64 {
        let before = self.scenes();
        self.frame_id += 1;
        for stages in EACH {
            self.call(stages).unwrap();
        }
        self.scenes() - before
    }
}

#[test]
fn calls_of_one_frame_share_one_scene() {
    let mut host = Host::new();
    assert_eq!(host.frame(), 1);
    for step in 1..4 {
        host.context.update(f64::from(step)).unwrap();
        assert_eq!(host.frame(), 1, "step {step}");
        host.camera.position.x += 0.5;
        host.camera = Camera::look_to(host.camera.position, DVec3::Y, DVec3::Z, 0.9, 2.0, 0.1);
        assert_eq!(host.frame(), 1, "camera of step {step}");
    }
}

/// Name of a change that a host makes, and its call.
type Change = (&'static str, fn(&mut Context));

/// Changes by the host between two calls of a frame show in the later one.
#[test]
fn a_change_between_two_calls_computes_another_scene() {
    let changes: [Change; 8] = [
        ("time", |c| c.update(1.0).unwrap()),
        ("weather", |c| c.set_weather(&Weather::preset("snow").unwrap(), 1.0, 0.0).unwrap()),
        ("sun", |c| c.set_sun(Some(GivenDirection { azimuth_deg: 90.0, elevation_deg: 20.0 })).unwrap()),
        ("moon", |c| c.set_moon(Some(GivenDirection { azimuth_deg: 10.0, elevation_deg: 5.0 })).unwrap()),
        ("clock", |c| c.set_clock(Utc(1.79e9), 1.0).unwrap()),
        ("planet", |c| c.set_planet(&Planet { ground_albedo: [0.5; 3], ..c.world.set.planet }).unwrap()),
        ("areas", |c| c.set_rain_areas(&[RainArea { rate_mm_h: 30.0, ..RainArea::default() }]).unwrap()),
        ("law", |c| c.set_fog_law(Some(Law::Clear)).unwrap()),
    ];
    let mut host = Host::new();
    for (name, change) in changes {
        host.frame_id += 1;
        let before = host.scenes();
        host.call(EACH[0]).unwrap();
        host.call(EACH[1]).unwrap();
        let between = host.scenes();
        change(&mut host.context);
        host.call(EACH[3]).unwrap();
        host.call(EACH[4]).unwrap();
        assert_eq!((between - before <= 1, host.scenes() - between), (true, 1), "{name}");
    }
}

#[test]
fn a_refused_call_changes_nothing() {
    let mut host = Host::new();
    host.frame_id = 1;
    host.call(EACH[0]).unwrap();
    let before = host.scenes();
    let place = host.camera;
    host.camera.position = DVec3::splat(f64::NAN);
    assert!(host.call(EACH[1]).is_err());
    host.camera = place;
    assert!(host.call(EACH[0]).is_err(), "PREPARE comes twice");
    for stages in &EACH[1..] {
        host.call(*stages).unwrap();
    }
    assert_eq!(host.scenes(), before);
}
