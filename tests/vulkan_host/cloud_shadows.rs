//! The clouds' shadows in a Vulkan host's own image, in the layout that the header promises.

use ash::vk::{self, Handle};
use welkin::capi::{cloud_shadow::*, device::*};
use welkin::gpu::vulkan::HostImage;
use welkin_support::c_scene::{Scene, cloud_shadows::*, ok};

use crate::{
    SIZE,
    capi::device,
    host::{Host, Setup},
};

/// Texels of the image, which is read from the layout in which the host gets it and returned in the same layout.
fn texels(host: &Host, from: &wk_cloud_shadows) -> Vec<u8> {
    use vk::ImageLayout as L;
    let out = host.image(vk::Format::R8_UNORM, (from.width, from.height), 1, vk::ImageUsageFlags::TRANSFER_DST);
    let image = HostImage { image: vk::Image::from_raw(from.texture), ..out.image };
    host.run(&[], &[], false, |c| host.transition(c, &image, L::SHADER_READ_ONLY_OPTIMAL, L::TRANSFER_SRC_OPTIMAL));
    let texels = host.read_texels(&image, &[]);
    host.run(&[], &[], true, |c| host.transition(c, &image, L::TRANSFER_SRC_OPTIMAL, L::SHADER_READ_ONLY_OPTIMAL));
    host.destroy_image(out);
    texels
}

#[test]
fn a_hosts_image_has_the_shadow_of_each_place() {
    let host = Host::new(Setup::modern());
    let device = device(&host);
    let scene = Scene::new(device);
    scatter(&scene);
    let map = whole(&scene, SIZE);
    let texels = texels(&host, &map);
    let size = i64::from(map.width);
    let at = |x: i64, y: i64| f64::from(texels[(y.rem_euclid(size) * size + x.rem_euclid(size)) as usize]) / 255.0;
    let filtered = |i: u32| {
        let [x, y, z] = place(i);
        let [u, v] = map.uv_from_world.map(|r| (r[0] * x + r[1] * y + r[2] * z + r[3]) * size as f64 - 0.5);
        let (x, y) = (u.floor(), v.floor());
        let row = |j: i64| at(x as i64, j) + (at(x as i64 + 1, j) - at(x as i64, j)) * (u - x);
        row(y as i64) + (row(y as i64 + 1) - row(y as i64)) * (v - y)
    };
    assert_shares(&scene, &(0..SIDE * SIDE).map(filtered).collect::<Vec<_>>());
    scene.destroy();
    // SAFETY: a live handle.
    ok(unsafe { wk_device_destroy(device) });
    host.assert_valid();
    host.finish();
}
