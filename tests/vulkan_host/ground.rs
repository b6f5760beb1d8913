//! The terrain's water in a Vulkan host's own image: the same cells as in the CPU's copy, in the layout that the header
//! promises.

use ash::vk::{self, Handle};
use welkin::capi::{device::*, frame::*, ground_grid::*, ground_texture::*, view::*, vulkan::*};
use welkin::gpu::vulkan::HostImage;
use welkin_support::c_scene::{Scene, ground::*, init, ok};

use crate::capi::{device, image};
use crate::host::{Host, Setup};
use crate::{Picture, frame};

/// Texels of the texture, which is read from the layout in which the host gets it and returned in the same layout.
fn texels(host: &Host, from: &wk_ground_texture) -> Vec<[f32; 4]> {
    use vk::ImageLayout as L;
    let size = (from.width, from.height);
    let out = host.image(vk::Format::R16G16B16A16_SFLOAT, size, 1, vk::ImageUsageFlags::TRANSFER_DST);
    let image = HostImage { image: vk::Image::from_raw(from.texture), ..out.image };
    host.run(&[], &[], false, |c| host.transition(c, &image, L::SHADER_READ_ONLY_OPTIMAL, L::TRANSFER_SRC_OPTIMAL));
    let halves: Vec<[u16; 4]> = host.read_texels(&image, &[]);
    host.run(&[], &[], true, |c| host.transition(c, &image, L::TRANSFER_SRC_OPTIMAL, L::SHADER_READ_ONLY_OPTIMAL));
    host.destroy_image(out);
    halves.iter().map(|t| t.map(|h| half::f16::from_bits(h).to_f32())).collect()
}

fn assert_shown(host: &Host, scene: &Scene, from: &wk_ground_texture) {
    let (cells, revision) = cells(scene, (from.width * from.height) as usize);
    assert_eq!(from.revision, revision);
    assert_cells(&texels(host, from), &cells);
}

#[test]
fn a_hosts_image_has_the_cells_water() {
    use vk::ImageLayout as L;
    let host = Host::new(Setup::modern());
    let picture = Picture::new(&host, vk::Format::D32_SFLOAT);
    let device = device(&host);
    let scene = scene(device);
    assert_none(&scene);
    set_grid(&scene, [9, 6]);
    rain(&scene, 12.0, 0.0, 1800.0);
    let first = texture(&scene);
    assert_shown(&host, &scene, &first);
    rain(&scene, 0.0, 1800.0, 3600.0);
    let second = texture(&scene);
    assert_shown(&host, &scene, &second);
    assert!((first.texture, first.generation) == (second.texture, second.generation), "it stays the same");
    assert!(first.revision != second.revision);
    // A frame that draws the ground uploads it for the host too.
    rain(&scene, 12.0, 3600.0, 4200.0);
    picture.clear(&host, 0.001, [L::GENERAL, L::GENERAL], &[]);
    let color = image(&picture.colour, L::GENERAL, L::GENERAL);
    let depth = image(&picture.depth, L::GENERAL, L::GENERAL);
    let target = wk_vulkan_target { color: &color, depth: &depth, ..init("wk_vulkan_target") };
    let frame = wk_frame { target: (&raw const target).cast(), ..frame(1) };
    // SAFETY: live handles, truly described.
    ok(unsafe { wk_view_record(scene.view, &frame, WK_STAGE_ALL) });
    let (wet, _) = cells(&scene, 54);
    assert_cells(&texels(&host, &second), &wet);
    assert_shown(&host, &scene, &texture(&scene));
    set_grid(&scene, [4, 11]);
    let other = texture(&scene);
    assert!(other.generation != first.generation && (other.width, other.height) == (4, 11));
    assert_shown(&host, &scene, &other);
    // SAFETY: live handles.
    unsafe {
        ok(wk_context_set_ground_grid(scene.context, std::ptr::null()));
        assert_none(&scene);
        scene.destroy();
        ok(wk_device_destroy(device));
    }
    host.assert_valid();
    picture.destroy(&host);
    host.finish();
}
