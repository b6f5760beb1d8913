//! Welkin on a host's own Vulkan device: Welkin reads what the host drew, the host reads what Welkin drew, layouts and
//! semaphores are as agreed, and the validation layer reports nothing.
#![cfg(not(any(target_os = "macos", target_os = "ios")))]

mod capi;
mod cloud_shadows;
mod draw;
mod ground;
mod host;
mod images;
mod loss;
mod marks;
#[cfg(target_os = "linux")]
mod memory;
mod refusals;
mod reuse;
mod sharing;
mod veil;
mod weather;
mod written;

use ash::vk;
use host::{Host, Owned, Setup};
use welkin::capi::frame::wk_frame;
use welkin::gpu::vulkan::{HandOver, HostImage, ImageRole, VulkanHost, adopt};
use welkin_support::c_scene;

/// The size of every test image: small, not square, not a power of two.
const SIZE: (u32, u32) = (37, 20);

/// Frame of the scene at the size of the test images.
fn frame(frame_id: u64) -> wk_frame {
    c_scene::frame_of(frame_id, SIZE)
}

fn adopted(host: &Host) -> VulkanHost {
    // SAFETY: the description is true and the host outlives the device.
    unsafe { adopt(&host.desc()).unwrap_or_else(|e| panic!("{e}")) }
}

/// Colour and depth images that the host clears, to blue 0.5 and to `depth`.
struct Picture {
    colour: Owned,
    depth: Owned,
}

impl Picture {
    fn new(host: &Host, depth_format: vk::Format) -> Self {
        use vk::ImageUsageFlags as U;
        let transfer = U::TRANSFER_SRC | U::TRANSFER_DST;
        let colour = U::COLOR_ATTACHMENT | U::SAMPLED | transfer;
        let depth = U::DEPTH_STENCIL_ATTACHMENT | U::SAMPLED | transfer;
        Self {
            colour: host.image(vk::Format::R8G8B8A8_UNORM, SIZE, 1, colour),
            depth: host.image(depth_format, SIZE, 1, depth),
        }
    }

    /// Draws as the host: clears both images and leaves them in the given layouts.
    fn clear(&self, host: &Host, depth: f32, layouts: [vk::ImageLayout; 2], signal: &[vk::Semaphore]) {
        host.run(&[], signal, false, |c| {
            host.clear_colour(c, &self.colour.image, [0.0, 0.0, 0.5, 1.0], layouts[0]);
            host.clear_depth(c, &self.depth.image, depth, layouts[1]);
        });
    }

    /// Draws as Welkin: red from the depth, green 1, blue unchanged.
    fn draw(&self, welkin: &VulkanHost, layouts: [vk::ImageLayout; 2], over: &HandOver<'_>) {
        let back = vk::ImageLayout::TRANSFER_SRC_OPTIMAL;
        let colour = HostImage { layout: layouts[0], final_layout: back, ..self.colour.image };
        let depth = HostImage { layout: layouts[1], final_layout: layouts[1], ..self.depth.image };
        draw::red_from_depth(welkin, &colour, &depth, over).unwrap_or_else(|e| panic!("{e}"));
    }

    fn destroy(self, host: &Host) {
        host.destroy_image(self.colour);
        host.destroy_image(self.depth);
    }
}

fn assert_all(pixels: &[[u8; 4]], expected: [u8; 4]) {
    for (i, p) in pixels.iter().enumerate() {
        let close = p.iter().zip(expected).all(|(a, b)| a.abs_diff(b) <= 1);
        assert!(close, "pixel {i}: {p:?}, expected {expected:?}");
    }
}

#[test]
fn draws_over_the_hosts_picture_from_any_layout() {
    use vk::ImageLayout as L;
    let host = Host::new(Setup::modern());
    let welkin = adopted(&host);
    for format in
        [vk::Format::D32_SFLOAT, vk::Format::D24_UNORM_S8_UINT, vk::Format::D32_SFLOAT_S8_UINT, vk::Format::D16_UNORM]
    {
        let picture = Picture::new(&host, format);
        let layouts = [
            [L::COLOR_ATTACHMENT_OPTIMAL, L::DEPTH_STENCIL_ATTACHMENT_OPTIMAL],
            [L::GENERAL, L::DEPTH_STENCIL_READ_ONLY_OPTIMAL],
            [L::TRANSFER_DST_OPTIMAL, L::TRANSFER_DST_OPTIMAL],
            [L::SHADER_READ_ONLY_OPTIMAL, L::SHADER_READ_ONLY_OPTIMAL],
        ];
        // The layouts are tried twice, so that each also follows another one on the cached import.
        for (i, layouts) in layouts.iter().chain(&layouts).enumerate() {
            let depth = [0.25, 0.75][i % 2];
            picture.clear(&host, depth, *layouts, &[]);
            picture.draw(&welkin, *layouts, &HandOver::default());
            let red = (depth * 255.0).round() as u8;
            assert_all(&host.read(&picture.colour.image, &[]), [red, 255, 128, 255]);
        }
        welkin.forget_image(picture.colour.image.image).unwrap();
        welkin.forget_image(picture.depth.image.image).unwrap();
        picture.destroy(&host);
        host.assert_valid();
    }
    welkin.close().unwrap();
    host.finish();
}

#[test]
fn a_multisampled_target_is_drawn_sample_by_sample() {
    use vk::ImageUsageFlags as U;
    let host = Host::new(Setup::sampling());
    let welkin = adopted(&host);
    let usage = U::COLOR_ATTACHMENT | U::TRANSFER_SRC | U::TRANSFER_DST;
    let many = host.image(vk::Format::R8G8B8A8_UNORM, SIZE, 4, usage);
    let one = host.image(vk::Format::R8G8B8A8_UNORM, SIZE, 1, usage);
    let layout = vk::ImageLayout::COLOR_ATTACHMENT_OPTIMAL;
    host.run(&[], &[], false, |c| host.clear_colour(c, &many.image, [0.0, 0.0, 0.5, 1.0], layout));
    let back = vk::ImageLayout::TRANSFER_SRC_OPTIMAL;
    let image = HostImage { layout, final_layout: back, ..many.image };
    draw::green(&welkin, &image).unwrap_or_else(|e| panic!("{e}"));
    host.run(&[], &[], true, |c| {
        host.clear_colour(c, &one.image, [0.0; 4], vk::ImageLayout::TRANSFER_DST_OPTIMAL);
        host.resolve(c, &many.image, &one.image);
        host.transition(c, &one.image, vk::ImageLayout::TRANSFER_DST_OPTIMAL, back);
    });
    assert_all(&host.read(&one.image, &[]), [0, 255, 128, 255]);
    welkin.close().unwrap();
    host.destroy_image(many);
    host.destroy_image(one);
    host.finish();
}

#[test]
fn older_hosts_without_timeline_semaphores_draw_too() {
    use vk::ImageLayout as L;
    let below_1_1 = vec![ash::khr::maintenance1::NAME, ash::khr::storage_buffer_storage_class::NAME];
    let setups = [
        Setup { extensions: below_1_1, ..Setup::bare(vk::API_VERSION_1_0) },
        Setup::bare(vk::API_VERSION_1_1),
        Setup {
            extensions: vec![ash::khr::timeline_semaphore::NAME],
            timeline: true,
            ..Setup::bare(vk::API_VERSION_1_1)
        },
        Setup::bare(vk::API_VERSION_1_2),
        Setup::bare(vk::API_VERSION_1_3),
    ];
    for setup in setups {
        let host = Host::new(setup);
        let welkin = adopted(&host);
        let picture = Picture::new(&host, vk::Format::D32_SFLOAT);
        let layouts = [L::COLOR_ATTACHMENT_OPTIMAL, L::DEPTH_STENCIL_ATTACHMENT_OPTIMAL];
        for _ in 0..3 {
            picture.clear(&host, 0.25, layouts, &[]);
            picture.draw(&welkin, layouts, &HandOver::default());
            assert_all(&host.read(&picture.colour.image, &[]), [64, 255, 128, 255]);
        }
        host.assert_valid();
        welkin.close().unwrap();
        picture.destroy(&host);
        host.finish();
    }
}

#[test]
fn the_hosts_objects_live_on_when_welkin_goes() {
    use vk::ImageLayout as L;
    let host = Host::new(Setup::modern());
    let picture = Picture::new(&host, vk::Format::D32_SFLOAT);
    let layouts = [L::COLOR_ATTACHMENT_OPTIMAL, L::DEPTH_STENCIL_ATTACHMENT_OPTIMAL];
    for depth in [0.25, 0.75] {
        let welkin = adopted(&host);
        picture.clear(&host, depth, layouts, &[]);
        picture.draw(&welkin, layouts, &HandOver::default());
        // Dropped with work in flight: the work is finished first, and no object of the host is destroyed.
        drop(welkin);
        let red = (depth * 255.0).round() as u8;
        assert_all(&host.read(&picture.colour.image, &[]), [red, 255, 128, 255]);
    }
    let welkin = adopted(&host);
    let kept = welkin.device.clone();
    let e = welkin.close().unwrap_err();
    assert_eq!(e.status, welkin::Status::InUse, "{e}");
    drop(kept);
    picture.destroy(&host);
    host.finish();
}

#[test]
fn images_come_back_in_the_final_layout_whatever_the_last_use_was() {
    let host = Host::new(Setup::modern());
    let welkin = adopted(&host);
    let picture = Picture::new(&host, vk::Format::D32_SFLOAT);
    let (general, back) = (vk::ImageLayout::GENERAL, vk::ImageLayout::TRANSFER_SRC_OPTIMAL);
    picture.clear(&host, 0.25, [general, general], &[]);
    draw::copy(&welkin, &HostImage { layout: general, final_layout: general, ..picture.colour.image }).unwrap();
    picture.draw(&welkin, [general, general], &HandOver::default());
    draw::copy(&welkin, &HostImage { layout: back, final_layout: back, ..picture.colour.image }).unwrap();
    assert_all(&host.read(&picture.colour.image, &[]), [64, 255, 128, 255]);
    welkin.close().unwrap();
    picture.destroy(&host);
    host.finish();
}

#[test]
fn more_images_than_are_kept_pass_through() {
    use vk::ImageUsageFlags as U;
    let host = Host::new(Setup::modern());
    let welkin = adopted(&host);
    let usage = U::COLOR_ATTACHMENT | U::TRANSFER_SRC | U::TRANSFER_DST;
    let images: Vec<_> = (0..70).map(|_| host.image(vk::Format::R8G8B8A8_UNORM, SIZE, 1, usage)).collect();
    let layout = vk::ImageLayout::COLOR_ATTACHMENT_OPTIMAL;
    let back = vk::ImageLayout::TRANSFER_SRC_OPTIMAL;
    for _ in 0..2 {
        for owned in &images {
            host.run(&[], &[], false, |c| host.clear_colour(c, &owned.image, [0.0, 0.0, 0.5, 1.0], layout));
            draw::green(&welkin, &HostImage { layout, final_layout: back, ..owned.image }).unwrap();
        }
        for owned in &images {
            assert_all(&host.read(&owned.image, &[]), [0, 255, 128, 255]);
        }
    }
    host.assert_valid();
    welkin.close().unwrap();
    images.into_iter().for_each(|i| host.destroy_image(i));
    host.finish();
}

#[test]
fn an_image_handed_over_as_sampled_keeps_its_role() {
    let host = Host::new(Setup::modern());
    let welkin = adopted(&host);
    let picture = Picture::new(&host, vk::Format::D32_SFLOAT);
    let general = vk::ImageLayout::GENERAL;
    let image = HostImage { layout: general, final_layout: general, ..picture.colour.image };
    // SAFETY: the image is described truly.
    let (a, b, c) = unsafe {
        let a = welkin.import("colour", &image, ImageRole::Colour).unwrap();
        let b = welkin.import("colour", &image, ImageRole::Colour).unwrap();
        let c = welkin.import("mask", &image, ImageRole::Sampled).unwrap();
        (a, b, c)
    };
    assert!(a == b, "the second import must come from the cache");
    assert!(a != c, "another role is another import");
    drop((a, b, c));
    welkin.close().unwrap();
    picture.destroy(&host);
    host.finish();
}

#[test]
fn the_validation_layer_is_listening() {
    let host = Host::new(Setup::modern());
    if !host.is_validated() {
        assert!(std::env::var_os(host::UNVALIDATED).is_some());
        return;
    }
    let picture = Picture::new(&host, vk::Format::D32_SFLOAT);
    host.run(&[], &[], true, |c| {
        // A layout that the image has never been in, and that its usage does not allow.
        let (wrong, back) = (vk::ImageLayout::DEPTH_STENCIL_ATTACHMENT_OPTIMAL, vk::ImageLayout::GENERAL);
        host.transition(c, &picture.colour.image, wrong, back);
    });
    assert!(!host.take_complaints().is_empty(), "a wrong layout must be complained of");
    host.run(&[], &[], true, |c| {
        // Two writes without a barrier between them: only the synchronisation checks find that.
        let general = vk::ImageLayout::GENERAL;
        host.clear_colour(c, &picture.colour.image, [0.0; 4], general);
        host.fill(c, &picture.colour.image, general, [0.0; 4]);
        host.fill(c, &picture.colour.image, general, [0.0; 4]);
    });
    let said = host.take_complaints().concat();
    assert!(said.contains("SYNC-HAZARD-WRITE-AFTER-WRITE"), "{said}");
    picture.destroy(&host);
    host.finish();
}
