//! No one may hold a window's image after it was presented: DXGI resizes a window only when no one holds its images.

use std::sync::Arc;

use glam::DVec3;
use welkin::{
    context::{Context, ContextDesc},
    frame::{ColorSpace, Frame, Shared, Stages, View},
    glass::Windscreen,
    gpu::Device,
    scene::Camera,
    weather::{CloudLayer, Precipitation, PrecipitationKind, Weather},
};

use crate::{
    BACKENDS, open, size,
    x11::{Server, Window},
};

/// Number of textures that Welkin and its host hold on the device, counted by wgpu for every interface.
fn held(device: &Device) -> usize {
    device.instance.generate_report().expect("wgpu of this process").hub_report().textures.num_allocated
}

/// A view with rain on a windscreen, so that the composition and the lens draw into the window.
fn rainy_view(device: &Arc<Device>) -> (Context, View) {
    let shared = Arc::new(Shared::new(device).unwrap());
    let mut context = Context::new(device.clone(), shared, ContextDesc::default()).unwrap();
    let precipitation = Precipitation { kind: PrecipitationKind::Rain, rate_mm_h: 20.0, ..Default::default() };
    let clouds = vec![CloudLayer::new(1.0, 900.0)];
    context.set_weather(&Weather { clouds, precipitation, ..Weather::default() }, 0.0, 0.0).unwrap();
    let mut view = View::new(&context).unwrap();
    view.set_windscreen(Some(&Windscreen { fogging: 0.5, ..Windscreen::default() })).unwrap();
    (context, view)
}

#[test]
fn no_view_holds_a_window_s_image_that_was_presented() {
    let server = Server::start();
    for backends in BACKENDS {
        let window = Window::open(&server, 96, 64);
        let (device, mut surface) = open(&window.xlib(), backends);
        let (mut context, mut view) = rainy_view(&device);
        surface.configure(&size(96, 64)).unwrap();
        let camera = Camera::look_to(DVec3::Z * 2.0, DVec3::Y, DVec3::Z, 1.0, 1.5, 0.1);
        // Frames recorded in one call, and frames whose lens and tone curve are recorded in separate calls.
        let last = Stages::LENS.with(Stages::TONE);
        let calls = [&[Stages::ALL][..], &[Stages::ALL.without(last), last]];
        for id in 0..12_u64 {
            context.update(0.1 * id as f64).unwrap();
            let image = surface.acquire().unwrap();
            let mut frame = Frame::new(id, camera, &image, None);
            frame.color_space = ColorSpace::DisplayLinear;
            for stages in calls[usize::from(id % 2 == 1)] {
                view.record(&context, &frame, *stages).unwrap();
            }
            assert!(view.report().passes > 0);
            let kept = held(&device);
            drop(image);
            surface.present().unwrap();
            device.wait().unwrap();
            let after = held(&device);
            // Presenting releases the image: there is one texture fewer than while it was acquired. OpenGL draws to a
            // picture that stays.
            assert_eq!(after + 1, kept, "{backends:?}, frame {id}: textures after it was presented, and before");
        }
    }
}
