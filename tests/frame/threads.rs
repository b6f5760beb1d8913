//! Several contexts and views in one process and from several threads: the pictures are those of one thread.

use std::sync::Arc;

use glam::DVec3;
use welkin::{
    context::{Context, GivenDirection},
    frame::{Exposure, Frame, Shared, Stages, View},
    gpu::{Device, DeviceOptions, readback},
};
use welkin_support::frame_host::{camera, coarse, texture};

const FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Rgba16Float;
const FRAMES: u64 = 8;

fn context(device: &Arc<Device>, shared: &Arc<Shared>, elevation_deg: f64) -> Context {
    let mut context = Context::new(device.clone(), shared.clone(), coarse()).unwrap();
    context.set_sun(Some(GivenDirection { azimuth_deg: 30.0, elevation_deg })).unwrap();
    context
}

/// Draws some frames of one view, each a little turned, and gives back the last picture.
fn film(context: &Context, turn: f64) -> Vec<[f32; 4]> {
    let device = context.device();
    let color = texture(device, FORMAT, 1);
    let mut view = View::new(context).unwrap();
    for id in 0..FRAMES {
        let mut camera = camera();
        camera.view *= glam::DMat4::from_rotation_z(turn + 0.01 * id as f64);
        let mut frame = Frame::new(id, camera, &color, None);
        frame.exposure = Some(Exposure::Factor(1e-4));
        view.record(context, &frame, Stages::ALL).unwrap();
    }
    device.wait().unwrap();
    readback::rgba(device, &color).unwrap()
}

#[test]
fn pictures_do_not_depend_on_threads() {
    let device = Device::headless(&DeviceOptions::default()).unwrap();
    let shared = Arc::new(Shared::new(&device).unwrap());
    let contexts = [context(&device, &shared, 40.0), context(&device, &shared, 4.0)];
    let jobs: Vec<(usize, f64)> = (0..6).map(|i| (i % 2, i as f64)).collect();
    let alone: Vec<_> = jobs.iter().map(|(c, turn)| film(&contexts[*c], *turn)).collect();
    let together: Vec<_> = std::thread::scope(|scope| {
        let running: Vec<_> = jobs.iter().map(|(c, turn)| scope.spawn(|| film(&contexts[*c], *turn))).collect();
        running.into_iter().map(|r| r.join().unwrap()).collect()
    });
    for (i, (a, b)) in alone.iter().zip(&together).enumerate() {
        assert!(a == b, "view {i} drew another picture beside others");
    }
}

#[test]
fn a_lost_device_answers_so_and_a_new_one_works() {
    let device = Device::headless(&DeviceOptions::default()).unwrap();
    let shared = Arc::new(Shared::new(&device).unwrap());
    let lost = context(&device, &shared, 40.0);
    let mut view = View::new(&lost).unwrap();
    let color = texture(&device, FORMAT, 1);
    device.simulate_loss();
    let frame = Frame::new(1, camera(), &color, None);
    assert_eq!(view.record(&lost, &frame, Stages::ALL).unwrap_err().status, welkin::Status::DeviceLost);
    for error in [view.frame_textures().err(), View::new(&lost).err(), lost.ambient_at(DVec3::ZERO, 0.0).err()] {
        assert_eq!(error.unwrap().status, welkin::Status::DeviceLost);
    }
    // Queries that need no device still work.
    assert!(lost.light_at(DVec3::ZERO, 0.0).unwrap().arriving.total_lux > 1e3);
    let fresh = Device::headless(&DeviceOptions::default()).unwrap();
    let shared = Arc::new(Shared::new(&fresh).unwrap());
    assert!(film(&context(&fresh, &shared, 40.0), 0.0)[0][2] > 0.01);
}
