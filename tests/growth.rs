//! Growth of the cost of frames with the size of the picture and the number of views, in processor time on a software
//! driver. The test is alone in its binary.

use std::sync::Arc;

use glam::{DMat4, DVec3};
use welkin::{
    context::{Context, ContextDesc, GivenDirection},
    frame::{Frame, Shared, Stages, View},
    gpu::{Device, DeviceOptions},
    scene::Camera,
    weather::Weather,
};
use welkin_support::{
    accept,
    coarse_sky::coarse_sky,
    level_ground::level_ground,
    processor::{holds, median, processor_ns},
    textures::texture,
};

/// Returns the number of frames before the measurement, in which tables and pipelines are built, and of measured ones.
fn frames() -> (usize, usize) {
    if accept() { (30, 20) } else { (24, 12) }
}

fn world(device: &Arc<Device>, weather: &str) -> Context {
    let shared = Arc::new(Shared::new(device).unwrap());
    let desc = ContextDesc { sky: coarse_sky(), ..ContextDesc::default() };
    let mut context = Context::new(device.clone(), shared, desc).unwrap();
    context.set_weather(&Weather::preset(weather).unwrap(), 0.0, 0.0).unwrap();
    context.update(0.0).unwrap();
    context
}

/// A view and its picture: level ground below the middle row, sky above.
struct Channel {
    view: View,
    color: wgpu::Texture,
    depth: wgpu::Texture,
    yaw_rad: f64,
}

impl Channel {
    fn new(device: &Device, context: &Context, (width, height): (u32, u32), yaw_rad: f64) -> Self {
        let color = texture(device, (width, height), wgpu::TextureFormat::Rgba16Float, 1);
        let depth = texture(device, (width, height), wgpu::TextureFormat::R32Float, 1);
        level_ground(device, &depth, 0.0);
        Self { view: View::new(context).unwrap(), color, depth, yaw_rad }
    }

    /// Draws frame `id` of a camera that turns, and waits for it.
    fn draw(&mut self, device: &Device, context: &Context, id: u64) {
        let mut camera = Camera::look_to(DVec3::Z * 2.0, DVec3::Y, DVec3::Z, 0.9, 16.0 / 9.0, 0.1);
        camera.view *= DMat4::from_rotation_z(self.yaw_rad + 0.01 * id as f64);
        let frame = Frame::new(id, camera, &self.color, Some(&self.depth));
        self.view.record(context, &frame, Stages::ALL).unwrap();
        device.wait().unwrap();
    }
}

/// Returns the median time of a frame of each group of channels, ns. The groups are drawn in turn, and the sun moves
/// before each turn.
fn nanoseconds(device: &Device, context: &mut Context, groups: &mut [Vec<Channel>], sun_step_deg: f64) -> Vec<f64> {
    let mut spent = vec![Vec::new(); groups.len()];
    let mut sun = GivenDirection { azimuth_deg: 180.0, elevation_deg: 50.0 };
    let (first, measured) = frames();
    for id in 0..first + measured {
        for (group, spent) in groups.iter_mut().zip(&mut spent) {
            sun.elevation_deg -= sun_step_deg;
            let before = processor_ns();
            context.set_sun(Some(sun)).unwrap();
            group.iter_mut().for_each(|channel| channel.draw(device, context, id as u64 + 1));
            if id >= first {
                spent.push((processor_ns() - before) as f64);
            }
        }
    }
    spent.iter_mut().map(|spent| median(spent)).collect()
}

#[test]
fn a_pixel_costs_no_more_in_a_larger_picture() {
    let device = Device::headless(&DeviceOptions::default()).expect("a software driver is installed");
    let all = [(320, 180), (640, 360), (1280, 720), (1920, 1080)];
    let sizes = if accept() { &all[..] } else { &all[..2] };
    let weathers = ["rain", "broken", "clear"];
    for weather in if accept() { &weathers[..] } else { &weathers[..2] } {
        let mut context = world(&device, weather);
        let mut groups: Vec<_> = sizes.iter().map(|size| vec![Channel::new(&device, &context, *size, 0.0)]).collect();
        let most = vec![if accept() { 1.04 } else { 1.15 }; sizes.len() - 1];
        holds(&format!("{weather}, a pixel over one of the next smaller picture"), &most, || {
            let times = nanoseconds(&device, &mut context, &mut groups, 0.0);
            let a_pixel: Vec<f64> =
                times.iter().zip(sizes).map(|(ns, (width, height))| ns / f64::from(width * height)).collect();
            println!("{weather}: {a_pixel:.1?} ns a pixel at {sizes:?}");
            a_pixel.windows(2).map(|pair| pair[1] / pair[0]).collect()
        });
    }
}

#[test]
fn several_views_of_a_world_cost_no_more_than_as_often_one() {
    let device = Device::headless(&DeviceOptions::default()).expect("a software driver is installed");
    for (weather, sun_step_deg) in [("clear", 0.0), ("clear", 0.02), ("rain", 0.0), ("broken", 0.0)] {
        let mut context = world(&device, weather);
        let channel = |i: u32| Channel::new(&device, &context, (320, 180), 0.7 * f64::from(i));
        let mut groups: Vec<Vec<Channel>> = (0..4).map(|i| vec![channel(i)]).collect();
        groups.push((0..4).map(channel).collect());
        // Three runs took 0.98 to 1.00.
        let name = format!("{weather}, the sun by {sun_step_deg}: four views over four alone");
        holds(&name, &[if accept() { 1.05 } else { 1.15 }], || {
            let times = nanoseconds(&device, &mut context, &mut groups, sun_step_deg);
            vec![times[4] / times[..4].iter().sum::<f64>()]
        });
    }
}
