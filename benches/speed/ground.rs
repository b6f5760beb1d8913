//! Cost of wet ground per picture: the stage SURFACE over a picture that is half ground, against the same picture when
//! dry.

use std::time::Instant;

use glam::DVec3;
use welkin::{
    context::{Context, ContextDesc, GivenDirection},
    frame::{Frame, Shared, Stages, View},
    gpu::{Device, DeviceOptions},
    ground::SurfaceClass,
    scene::Camera,
    weather::{Precipitation, PrecipitationKind, Surface, SurfaceState, Weather},
};
use welkin_support::textures;

type Fallible<T> = Result<T, Box<dyn std::error::Error>>;

const SIZE: wgpu::Extent3d = wgpu::Extent3d { width: 640, height: 360, depth_or_array_layers: 1 };

pub fn run() -> Fallible<()> {
    let device = Device::headless(&DeviceOptions::default())?;
    let shared = std::sync::Arc::new(Shared::new(&device)?);
    let texture = |format| textures::texture(&device, (SIZE.width, SIZE.height), format, 1);
    let (color, depth) = (texture(wgpu::TextureFormat::Rgba16Float), texture(wgpu::TextureFormat::R32Float));
    // Level ground 2 m below the camera, from the middle of the picture down.
    let row = |y: u32| 0.1 * (y as f32 - 179.5).max(0.0) / 180.0 * 0.45f32.tan() / 2.0;
    let texels: Vec<f32> = (0..SIZE.width * SIZE.height).map(|i| row(i / SIZE.width)).collect();
    let layout = wgpu::TexelCopyBufferLayout { offset: 0, bytes_per_row: Some(SIZE.width * 4), rows_per_image: None };
    device.queue.write_texture(depth.as_image_copy(), bytemuck::cast_slice(&texels), layout, SIZE);
    let camera = Camera::look_to(DVec3::new(0.0, 0.0, 2.0), DVec3::Y, DVec3::Z, 0.9, 16.0 / 9.0, 0.1);
    let whole = Stages::ALL.without(Stages::TONE.with(Stages::PARTICLES));
    let sets = [whole.without(Stages::SURFACE), whole, Stages::SURFACE];
    let grounds = [
        ("dry", SurfaceState::Dry, 0.0),
        ("damp", SurfaceState::Damp, 0.0),
        ("puddles", SurfaceState::StandingWater, 0.0),
        ("puddles in rain", SurfaceState::StandingWater, 5.0),
    ];
    let mut scenes = Vec::new();
    for (name, state, rate) in grounds {
        let mut context = Context::new(device.clone(), shared.clone(), ContextDesc::default())?;
        context.set_sun(Some(GivenDirection { azimuth_deg: 60.0, elevation_deg: 35.0 }))?;
        // Every effect of water: film, puddles and rings.
        context.set_default_surface_class(SurfaceClass::Paved);
        let surface = Surface { state: Some(state), ..Surface::default() };
        let kind = if rate > 0.0 { PrecipitationKind::Rain } else { PrecipitationKind::None };
        let precipitation = Precipitation::of(kind, rate);
        context.set_weather(&Weather { surface, precipitation, ..Weather::default() }, 0.0, 0.0)?;
        let view = View::new(&context)?;
        scenes.push((name, context, view, [f64::INFINITY; 3]));
    }
    // Measured in turn, so that other load on the machine affects all of them; the minimum is the time of the work
    // itself.
    for id in 0..25 {
        for (_, context, view, least) in &mut scenes {
            for (k, (stages, least)) in sets.iter().zip(least).enumerate() {
                let frame = Frame::new(3 * id + k as u64, camera, &color, Some(&depth));
                device.wait()?;
                let start = Instant::now();
                view.record(context, &frame, *stages)?;
                device.wait()?;
                *least = least.min(start.elapsed().as_secs_f64() * 1e3);
            }
        }
    }
    println!("wet ground in half of a picture of {} x {}, without PARTICLES and TONE:", SIZE.width, SIZE.height);
    for (name, _, _, [without, with, alone]) in scenes {
        println!(
            "  {name}: ratio {:.2} ({with:.1} ms with the stage, {without:.1} ms without; alone {alone:.2} ms)",
            with / without
        );
    }
    Ok(())
}
