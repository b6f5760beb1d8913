//! The whole weather on a host's Vulkan device: the same picture as on a device of Welkin's own.

use std::sync::Arc;

use ash::vk;
use glam::DVec3;
use welkin::context::{Context, ContextDesc, GivenDirection};
use welkin::frame::{ColorSpace, Frame, Shared, Stages, View};
use welkin::gpu::vulkan::{HandOver, HostImage, ImageRole, VulkanHost};
use welkin::gpu::{Device, DeviceOptions, readback};
use welkin::scene::Camera;
use welkin_support::textures::texture;

use crate::host::{Host, Setup};
use crate::{Picture, SIZE, adopted};

/// A context and a view on `device`, with the sun in the picture.
fn weather(device: &Arc<Device>) -> (Context, View) {
    let shared = Arc::new(Shared::new(device).unwrap());
    let mut context = Context::new(device.clone(), shared, ContextDesc::default()).unwrap();
    context.set_sun(Some(GivenDirection { azimuth_deg: 10.0, elevation_deg: 12.0 })).unwrap();
    let view = View::new(&context).unwrap();
    (context, view)
}

fn frame<'a>(color: &'a wgpu::Texture, depth: &'a wgpu::Texture) -> Frame<'a> {
    let aspect = f64::from(SIZE.0) / f64::from(SIZE.1);
    let camera = Camera::look_to(DVec3::new(0.0, 0.0, 2.0), DVec3::Y, DVec3::Z, 1.0, aspect, 0.1);
    Frame { color_space: ColorSpace::DisplaySrgb, ..Frame::new(7, camera, color, Some(depth)) }
}

/// Clears to blue 0.5 and a depth, as the Vulkan host does, then draws the weather, all on a device of Welkin's own.
fn on_own_device(depth: f32) -> Vec<u8> {
    let options = DeviceOptions { backends: wgpu::Backends::VULKAN, ..Default::default() };
    let device = Device::headless(&options).unwrap();
    let color = texture(&device, SIZE, wgpu::TextureFormat::Rgba8Unorm, 1);
    let depths = texture(&device, SIZE, wgpu::TextureFormat::Depth32Float, 1);
    let mut encoder = device.device.create_command_encoder(&Default::default());
    let (color_view, depth_view) = (color.create_view(&Default::default()), depths.create_view(&Default::default()));
    drop(encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
        color_attachments: &[Some(wgpu::RenderPassColorAttachment {
            view: &color_view,
            depth_slice: None,
            resolve_target: None,
            ops: wgpu::Operations {
                load: wgpu::LoadOp::Clear(wgpu::Color { r: 0.0, g: 0.0, b: 0.5, a: 1.0 }),
                store: wgpu::StoreOp::Store,
            },
        })],
        depth_stencil_attachment: Some(wgpu::RenderPassDepthStencilAttachment {
            view: &depth_view,
            depth_ops: Some(wgpu::Operations { load: wgpu::LoadOp::Clear(depth), store: wgpu::StoreOp::Store }),
            stencil_ops: None,
        }),
        ..Default::default()
    }));
    device.submit_and_wait(encoder).unwrap();
    let (context, mut view) = weather(&device);
    view.record(&context, &frame(&color, &depths), Stages::ALL).unwrap();
    readback::bytes(&device, &color, 0).unwrap()
}

/// Draws the weather on the host's images, left in `layouts`, and brings the colour back to be read.
fn on_hosts_device(welkin: &VulkanHost, picture: &Picture, layouts: [vk::ImageLayout; 2]) {
    let (context, mut view) = weather(&welkin.device);
    let back = vk::ImageLayout::TRANSFER_SRC_OPTIMAL;
    let color = HostImage { layout: layouts[0], final_layout: back, ..picture.colour.image };
    let depth = HostImage { layout: layouts[1], final_layout: layouts[1], ..picture.depth.image };
    // SAFETY: the images are described truly, and the tests keep to the queue contract.
    unsafe {
        let color_texture = welkin.import("color", &color, ImageRole::Colour).unwrap();
        let depth_texture = welkin.import("depth", &depth, ImageRole::Depth).unwrap();
        let mut encoder = welkin.device.device.create_command_encoder(&Default::default());
        view.record_into(&context, &frame(&color_texture, &depth_texture), Stages::ALL, &mut encoder).unwrap();
        let images = [(color, ImageRole::Colour, &color_texture), (depth, ImageRole::Depth, &depth_texture)];
        welkin.submit(encoder, &HandOver { images: &images, ..Default::default() }).unwrap();
    }
}

#[test]
fn the_weather_is_that_of_an_own_device() {
    use vk::ImageLayout as L;
    let layouts = [L::COLOR_ATTACHMENT_OPTIMAL, L::DEPTH_STENCIL_ATTACHMENT_OPTIMAL];
    let below_1_1 = vec![ash::khr::maintenance1::NAME, ash::khr::storage_buffer_storage_class::NAME];
    let setups = [
        Setup::modern(),
        Setup::bare(vk::API_VERSION_1_1),
        Setup { extensions: below_1_1, ..Setup::bare(vk::API_VERSION_1_0) },
    ];
    // Reversed infinite depth: 0 is the sky, 0.00005 is 2 km away with the near plane at 0.1 m.
    for depth in [0.0, 0.00005] {
        let expected = on_own_device(depth);
        let first = &expected[0..4];
        assert!(expected.chunks(4).any(|p| p != first) || depth > 0.0, "the sky has a gradient");
        assert!(expected.chunks(4).all(|p| p != [0, 0, 128, 255]), "every pixel has some weather in it");
        for setup in setups.clone() {
            let host = Host::new(setup);
            let welkin = adopted(&host);
            let picture = Picture::new(&host, vk::Format::D32_SFLOAT);
            picture.clear(&host, depth, layouts, &[]);
            on_hosts_device(&welkin, &picture, layouts);
            let got = host.read(&picture.colour.image, &[]).concat();
            let worst = got.iter().zip(&expected).map(|(a, b)| a.abs_diff(*b)).max();
            assert_eq!(worst, Some(0), "Vulkan {:#x}, depth {depth}", host.setup.api_version);
            host.assert_valid();
            welkin.close().unwrap();
            picture.destroy(&host);
            host.finish();
        }
    }
}
