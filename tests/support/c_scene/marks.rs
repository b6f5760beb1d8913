//! Optional data of a host about each pixel: its surface class and its normal.

use welkin::capi::{device::*, frame::*, ground::*, texture::*, view::*};

use super::own::{Own, Size, different, wet_scene};

/// All stages but that of falling rain, which uses neither classes nor normals.
pub const STAGES: wk_stage_flags = WK_STAGE_ALL & !WK_STAGE_PARTICLES;

/// Classes from the left: soil, paving, a building, none.
pub fn classes(size: Size) -> Vec<u8> {
    let class = |x: u32| match 4 * x / size.0 {
        0 => WK_SURFACE_CLASS_SOIL,
        1 => WK_SURFACE_CLASS_PAVED,
        2 => WK_SURFACE_CLASS_BUILDING,
        _ => WK_SURFACE_CLASS_UNSPECIFIED,
    };
    (0..size.0 * size.1).map(|i| class(i % size.0) as u8).collect()
}

/// Normals of waves along both axes of the host's world; none in the lowest rows.
pub fn normals(size: Size) -> Vec<[f32; 4]> {
    let normal = |i: u32| {
        let (x, y) = (i % size.0, i / size.0);
        if 8 * y > 7 * size.1 {
            return [0.0; 4];
        }
        let n = [0.4 * (0.5 * x as f32).sin(), 0.3 * (0.7 * y as f32).cos(), 1.0];
        let length = n.iter().map(|v| v * v).sum::<f32>().sqrt();
        [n[0] / length, n[1] / length, n[2] / length, 0.0]
    };
    (0..size.0 * size.1).map(normal).collect()
}

pub fn half_normals(size: Size) -> Vec<[u16; 4]> {
    normals(size).iter().map(|n| n.map(|v| half::f16::from_f32(v).to_bits())).collect()
}

/// (n + 1) / 2 in 10 bits per channel, red in the lowest bits.
pub fn packed_normals(size: Size) -> Vec<u32> {
    let ten = |v: f32| (511.5 * (v + 1.0)).round() as u32;
    normals(size).iter().map(|n| ten(n[0]) | ten(n[1]) << 10 | ten(n[2]) << 20).collect()
}

/// The wet scene on Welkin's own device: plain, with classes, with normals, with both. All four differ.
pub fn own_pictures(size: Size) -> [Vec<[u8; 4]>; 4] {
    let mut own = Own::new(WK_BACKEND_VULKAN);
    let scene = wet_scene(own.device);
    let mut id = 0;
    let pictures = [[false, false], [true, false], [false, true], [true, true]].map(|[with_classes, with_normals]| {
        id += 1;
        own.wet_picture(scene.view, id, size, STAGES, |own, target: &mut wk_own_target| {
            if with_classes {
                target.surface_classes = own.image(WK_FORMAT_R8_UNORM, size, &classes(size));
            }
            if with_normals {
                target.normals = own.image(WK_FORMAT_RGBA16_FLOAT, size, &half_normals(size));
            }
        })
    });
    for (i, a) in pictures.iter().enumerate() {
        for b in &pictures[..i] {
            assert!(different(a, b, 8) > a.len() / 40, "what is said must show: {i}, {}", different(a, b, 8));
        }
    }
    scene.destroy();
    own.destroy();
    pictures
}
