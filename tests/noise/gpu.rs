//! Noise that the GPU draws against the CPU's, texel by texel and level by level.

use std::sync::Arc;

use welkin::gpu::{Device, DeviceOptions};
use welkin::noise::{NoiseImage, NoiseKind, NoiseSettings, NoiseTexture};

use NoiseKind::{Cellular, Gradient, GradientOverCellular};

/// Welkin's own devices: the best one, one without compute, and one on OpenGL.
fn devices() -> [(&'static str, Arc<Device>); 3] {
    let open = |options| Device::headless(&options).unwrap();
    let gl = DeviceOptions { backends: wgpu::Backends::GL, ..Default::default() };
    [
        ("default", open(DeviceOptions::default())),
        ("tier 0", open(DeviceOptions { force_tier0: true, ..Default::default() })),
        ("OpenGL", open(gl)),
    ]
}

fn settings(kind: NoiseKind, frequency: [u32; 3], octaves: u32, seed: u64) -> NoiseSettings {
    NoiseSettings { kind, frequency, octaves, seed, ..Default::default() }
}

/// Asserts that no texel of any level differs by more than one level of 255, and returns the share that differs at all.
fn assert_alike(drawn: &NoiseImage, expected: &NoiseImage, what: &str) -> f64 {
    assert_eq!(drawn.size(), expected.size());
    assert_eq!(drawn.levels().len(), expected.levels().len());
    let mut differing = 0;
    for (level, (a, b)) in drawn.levels().iter().zip(expected.levels()).enumerate() {
        assert_eq!(a.len(), b.len(), "{what}, level {level}");
        let largest = a.iter().zip(b).map(|(a, b)| a.abs_diff(*b)).max();
        assert!(largest <= Some(1), "{what}, level {level}: {largest:?} of 255");
        differing += a.iter().zip(b).filter(|(a, b)| a != b).count();
    }
    differing as f64 / expected.levels().iter().map(Vec::len).sum::<usize>() as f64
}

#[test]
fn each_texel_is_the_reference_s_within_one_of_255() {
    let cases = [
        ([128, 128, 1], settings(Gradient, [6, 6, 1], 6, 0)),
        ([256, 64, 1], NoiseSettings { amplitude: 1.0, persistence: 0.4, ..settings(Gradient, [16, 3, 1], 10, 77) }),
        ([64, 64, 1], settings(Cellular, [4, 7, 1], 3, 1)),
        ([64, 64, 1], settings(GradientOverCellular, [5, 5, 1], 3, u64::MAX)),
        ([32, 32, 32], settings(Gradient, [6; 3], 6, 0)),
        ([64, 32, 16], NoiseSettings { persistence: 0.9, ..settings(Gradient, [3, 5, 1], 4, 1 << 40) }),
        ([32, 32, 32], settings(Cellular, [4, 1, 2], 3, 5)),
        ([16, 32, 8], settings(GradientOverCellular, [4, 3, 2], 2, 123_456_789)),
    ];
    for (name, device) in devices() {
        for (size, settings) in &cases {
            let what = format!("{name}, {size:?}, {settings:?}");
            let drawn = NoiseTexture::generate(&device, *size, &[*settings]).unwrap();
            let drawn = drawn.read(&device, 0).unwrap();
            let expected = NoiseImage::generate(*size, settings).unwrap();
            let differing = assert_alike(&drawn, &expected, &what);
            assert!(differing < 0.002, "{what}: {differing} of the texels differ");
            // Mip levels are the means of what was drawn, to the bit.
            assert_eq!(drawn, NoiseImage::from_texels(*size, drawn.levels()[0].clone()).unwrap(), "{what}");
        }
    }
}

#[test]
fn channels_hold_each_their_own_noise() {
    let all = [
        settings(GradientOverCellular, [4; 3], 3, 1),
        settings(Cellular, [4; 3], 2, 2),
        settings(Cellular, [8; 3], 1, 3),
        settings(Gradient, [2; 3], 3, 4),
    ];
    for (name, device) in devices() {
        for (size, count) in [([32, 16, 16], 2), ([16, 16, 16], 4), ([64, 32, 1], 4)] {
            let texture = NoiseTexture::generate(&device, size, &all[..count]).unwrap();
            for (channel, settings) in all[..count].iter().enumerate() {
                let expected = NoiseImage::generate(size, settings).unwrap();
                let drawn = texture.read(&device, channel).unwrap();
                assert_alike(&drawn, &expected, &format!("{name}, {size:?}, channel {channel}"));
            }
            assert_eq!(texture.read(&device, count).unwrap_err().field(), Some("channel"));
        }
    }
}

#[test]
fn a_texture_drawn_in_small_steps_is_the_same() {
    let channels = [settings(Gradient, [4; 3], 3, 8), settings(Cellular, [4; 3], 2, 9)];
    for (name, device) in devices() {
        for size in [[64, 32, 16], [128, 64, 1]] {
            let whole = NoiseTexture::generate(&device, size, &channels).unwrap();
            let mut parts = NoiseTexture::new(&device, size, &channels).unwrap();
            assert!(parts.read(&device, 0).unwrap_err().to_string().contains("step"));
            let mut steps = 0;
            while !parts.is_drawn() {
                let mut encoder = device.device.create_command_encoder(&Default::default());
                // A step that is not a multiple of the width or of a slice.
                parts.step(&mut encoder, 1777);
                device.submit(encoder);
                steps += 1;
            }
            let texels = 2 * size.iter().product::<u32>();
            assert!((texels / 1777..texels / 500).contains(&steps), "{name} {size:?}: {steps} steps");
            for channel in 0..2 {
                assert_eq!(
                    parts.read(&device, channel).unwrap(),
                    whole.read(&device, channel).unwrap(),
                    "{name} {size:?}"
                );
            }
            device.check().unwrap();
        }
    }
}

#[test]
fn bytes_given_to_the_gpu_come_back() {
    for (_, device) in devices() {
        for size in [[32, 16, 8], [128, 32, 1]] {
            let image = NoiseImage::generate(size, &settings(Gradient, [3; 3], 3, 2)).unwrap();
            let texture = NoiseTexture::from_image(&device, &image).unwrap();
            assert!(texture.is_drawn());
            assert_eq!(texture.read(&device, 0).unwrap(), image);
        }
        // An image as files may contain it: no power of two, no mip levels.
        let odd = NoiseImage::from_bytes(&without_levels([9, 5, 3])).unwrap();
        let texture = NoiseTexture::from_image(&device, &odd).unwrap();
        assert_eq!(texture.read(&device, 0).unwrap(), odd);
    }
}

/// A DDS file of this size with its first level alone.
fn without_levels(size: [u32; 3]) -> Vec<u8> {
    let bytes = (0..size.iter().product::<u32>()).map(|i| (7 * i % 256) as u8).collect::<Vec<_>>();
    let image = NoiseImage::from_texels(size, bytes.clone()).unwrap();
    let mut file = image.to_dds();
    file[28..32].copy_from_slice(&1_u32.to_le_bytes());
    file.truncate(128 + bytes.len());
    file
}

#[test]
fn what_a_device_cannot_make_is_refused_by_name() {
    let (_, device) = &devices()[0];
    let good = NoiseSettings::default();
    let refused = |size, channels: &[NoiseSettings], field: &str| {
        let e = NoiseTexture::new(device, size, channels).err().unwrap();
        assert_eq!(e.field(), Some(field), "{e}");
    };
    refused([64; 3], &[], "channels");
    refused([64; 3], &[good; 3], "channels");
    refused([63; 3], &[good], "size[0]");
    refused([64; 3], &[good, NoiseSettings { octaves: 0, ..good }], "channels[1].octaves");
    refused([64; 3], &[NoiseSettings { frequency: [33; 3], ..good }], "channels[0].frequency[0]");
    let long = NoiseImage::from_texels([1 << 20, 1, 1], vec![0; 1 << 20]).unwrap();
    let e = NoiseTexture::from_image(device, &long).err().unwrap();
    assert_eq!(e.status, welkin::Status::Unsupported, "{e}");
    device.check().unwrap();
}
