//! Pipelines that a view creates while weathers come and go, with and without a rehearsal of them.

use std::{sync::Arc, time::Duration};

use glam::{DMat4, DVec3};

use crate::{
    context::{Context, ContextDesc, GivenDirection},
    error::Status,
    frame::{Frame, Shared, Stages, View},
    gpu::{Device, DeviceOptions, counts::DeviceWork, flat_texture},
    regions::{RegionPlan, RegionShape, WeatherRegion},
    scene::Camera,
    weather::{Fog, FogKind, Precipitation, Weather, WeatherParts},
};

const SIZE: (u32, u32) = (160, 90);

/// A simulator on a device that draws nothing, treated as a software driver or as a GPU.
struct Simulator {
    device: Arc<Device>,
    context: Context,
    view: View,
    color: wgpu::Texture,
    depth: wgpu::Texture,
    camera: Camera,
    frames: u64,
}

impl Simulator {
    fn new(is_gpu: bool) -> Self {
        let options = DeviceOptions { backends: wgpu::Backends::NOOP, ..DeviceOptions::default() };
        let mut device = Device::headless(&options).expect("a device that draws nothing");
        if is_gpu {
            Arc::get_mut(&mut device).expect("its only owner").take_for_gpu();
        }
        let shared = Arc::new(Shared::new(&device).expect("shared"));
        let mut context = Context::new(device.clone(), shared, ContextDesc::default()).expect("a context");
        context.set_sun(Some(GivenDirection { azimuth_deg: 180.0, elevation_deg: 35.0 })).expect("a sun");
        context.set_weather(&preset("clear"), 0.0, 0.0).expect("weather");
        let view = View::new(&context).expect("a view");
        use wgpu::TextureUsages as U;
        let seen = U::TEXTURE_BINDING | U::RENDER_ATTACHMENT;
        let color = flat_texture(
            &device.device,
            "host",
            SIZE,
            wgpu::TextureFormat::Rgba16Float,
            seen | U::COPY_SRC | U::COPY_DST,
        );
        let depth = flat_texture(&device.device, "host", SIZE, wgpu::TextureFormat::Depth32Float, seen);
        let camera = Camera::look_to(DVec3::Z * 2.0, DVec3::Y, DVec3::Z, 0.9, 16.0 / 9.0, 0.1);
        Self { device, context, view, color, depth, camera, frames: 0 }
    }

    fn prepare(&mut self, weathers: &[Weather], most: Duration) -> crate::error::Result<Status> {
        let frame = Frame::new(0, self.camera, &self.color, Some(&self.depth));
        self.view.prepare(&mut self.context, &frame, &[Stages::ALL], weathers, most)
    }

    /// Draws a frame each tenth of a second for `seconds`.
    fn play(&mut self, seconds: f64) {
        let from_s = self.context.time_s();
        for i in 1..=(10.0 * seconds) as u32 {
            self.context.update(from_s + 0.1 * f64::from(i)).expect("a later time");
            self.camera.view *= DMat4::from_rotation_z(0.01);
            self.frames += 1;
            let frame = Frame::new(self.frames, self.camera, &self.color, Some(&self.depth));
            self.view.record(&self.context, &frame, Stages::ALL).expect("a frame");
        }
    }

    fn pipelines(&self) -> u64 {
        self.device.counts.total(DeviceWork::Pipelines)
    }

    /// Numbers of pipelines that are created in each weather, while the weathers follow each other.
    fn created(&mut self, weathers: &[Weather]) -> Vec<u64> {
        self.play(2.0);
        let mut created = Vec::new();
        for weather in weathers {
            let before = self.pipelines();
            self.context.set_weather(weather, self.context.time_s(), 10.0).expect("weather");
            self.play(12.0);
            created.push(self.pipelines() - before);
        }
        created
    }
}

fn preset(name: &str) -> Weather {
    Weather::preset(name).expect("a preset")
}

fn day() -> Vec<Weather> {
    ["clear", "broken", "rain", "fog", "snow", "clear"].map(preset).to_vec()
}

#[test]
fn prepared_weathers_come_with_hardly_a_new_pipeline() {
    for is_gpu in [false, true] {
        let without = Simulator::new(is_gpu).created(&day());
        assert!(without.iter().sum::<u64>() >= 5, "{without:?} are created by weathers that nobody prepared");
        let mut simulator = Simulator::new(is_gpu);
        let mut calls = 1;
        while simulator.prepare(&day(), Duration::ZERO).expect("a rehearsal") == Status::Pending {
            calls += 1;
        }
        let prepared = simulator.pipelines();
        let with = simulator.created(&day());
        println!("as a GPU: {is_gpu}: {without:?} without, {with:?} after {calls} calls and {prepared} pipelines");
        assert!(calls > 50, "a call of no time draws one moment: {calls}");
        // Three of 84 are not rehearsed: those of a bow that fades in fog before snow.
        assert!(20 * with.iter().sum::<u64>() <= without.iter().sum::<u64>(), "{with:?} of {without:?}");
    }
}

/// A fog bank with a radius of 500 m, this far to the north.
fn bank(north_m: f64) -> WeatherRegion {
    let fog = Weather { visibility_m: 300.0, fog: Fog::of(FogKind::Fog), ..Weather::default() };
    let shape = RegionShape::Ellipse { half_m: [500.0; 2] };
    let plan = RegionPlan { shape, center_m: [0.0, north_m, 0.0], ..RegionPlan::default() };
    WeatherRegion { plan, has: WeatherParts::FOG, weather: fog, ..WeatherRegion::default() }
}

#[test]
fn regions_far_away_are_rehearsed_too() {
    for is_gpu in [false, true] {
        let created = |prepares: bool| {
            let mut simulator = Simulator::new(is_gpu);
            simulator.context.set_weather_regions(&[bank(90e3), bank(93e3)]).expect("regions");
            while prepares
                && simulator.prepare(&[preset("clear")], Duration::from_secs(60)).expect("a rehearsal")
                    == Status::Pending
            {}
            simulator.play(2.0);
            let before = simulator.pipelines();
            for near in [vec![bank(4000.0)], vec![bank(300.0)], vec![bank(300.0), bank(900.0)]] {
                simulator.context.set_weather_regions(&near).expect("regions");
                simulator.play(2.0);
            }
            simulator.pipelines() - before
        };
        let [without, with] = [false, true].map(created);
        println!("as a GPU: {is_gpu}: {without} without, {with} after a rehearsal");
        assert!(without >= 3 && with == 0, "{with} of {without}");
    }
}

#[test]
fn a_rehearsal_leaves_context_and_frames_as_they_were() {
    let mut simulator = Simulator::new(false);
    simulator.context.update(7.5).unwrap();
    let before = simulator.context.state_hash().unwrap();
    assert_eq!(simulator.prepare(&[preset("rain")], Duration::from_secs(60)).unwrap(), Status::Ok);
    assert_eq!((simulator.context.state_hash().unwrap(), simulator.context.time_s()), (before, 7.5));
    assert_eq!(simulator.view.report().frame_id, u64::MAX, "the view is as before its first frame");
    simulator.play(0.3);
    assert_eq!(simulator.view.report().frame_id, 3);
}

#[test]
fn a_bad_weather_is_named_and_nothing_changes() {
    let mut simulator = Simulator::new(false);
    let before = simulator.context.state_hash().unwrap();
    let precipitation = Precipitation { rate_mm_h: f64::NAN, ..preset("rain").precipitation };
    let bad = Weather { precipitation, ..preset("rain") };
    let error = simulator.prepare(&[preset("clear"), bad], Duration::ZERO).unwrap_err();
    assert!(error.to_string().contains("weathers[1]") && error.to_string().contains("rate"), "{error}");
    let frame = Frame::new(0, simulator.camera, &simulator.color, Some(&simulator.depth));
    let error = simulator.view.prepare(&mut simulator.context, &frame, &[], &[], Duration::ZERO).unwrap_err();
    assert!(error.to_string().contains("calls"), "{error}");
    assert_eq!(simulator.prepare(&[], Duration::ZERO).unwrap(), Status::Ok, "no weather, no work");
    assert_eq!(simulator.context.state_hash().unwrap(), before);
}
