//! The cover that the source's presets and its series of cutoffs have (Tarantilis 2004, sections IV.A.1 and IV.A.3).

use std::sync::Arc;

use welkin::gpu::{Device, DeviceOptions};
use welkin::noise::{CloudPreset, NoiseImage, NoiseSettings, NoiseTexture};

fn drawn(device: &Arc<Device>, size: [u32; 3], settings: &NoiseSettings) -> NoiseImage {
    NoiseTexture::generate(device, size, &[*settings]).unwrap().read(device, 0).unwrap()
}

#[test]
fn presets_have_the_cover_of_their_names() {
    let device = Device::headless(&DeviceOptions::default()).unwrap();
    // In hundredths, by three other implementations of this noise: mean cover of 8 seeds, cover of each seed, and mean
    // opacity, with a margin of one hundredth for the chance of 8 seeds.
    for (preset, cover, each, opacity) in [
        (CloudPreset::Overcast, 98..=99, 0.95..=1.0, 84..=89),
        (CloudPreset::Broken, 80..=83, 0.72..=0.89, 59..=63),
        (CloudPreset::Few, 12..=16, 0.11..=0.17, 3..=8),
    ] {
        let mut means = [0.0; 2];
        for seed in 0..8 {
            let image = drawn(&device, CloudPreset::SIZE, &preset.noise(seed));
            let covered = image.cover(preset.cloud().cutoff());
            let opacities = image.opacities(&preset.cloud()).unwrap();
            let opacity = opacities.levels()[0].iter().map(|a| f64::from(*a) / 255.0).sum::<f64>() / 1024.0 / 1024.0;
            println!("{preset:?}, seed {seed}: cover {covered:.3}, opacity {opacity:.3}");
            assert!(each.contains(&covered), "{preset:?}, seed {seed}: {covered}");
            means[0] += covered / 8.0;
            means[1] += opacity / 8.0;
            // The smallest mip level has the same density as the largest one.
            let far = f64::from(opacities.levels().last().unwrap()[0]) / 255.0;
            assert!((far - opacity).abs() < 0.02, "{preset:?}, seed {seed}: {far} of {opacity}");
        }
        println!("{preset:?}: {means:.3?}");
        let hundredths = means.map(|m: f64| (100.0 * m).round() as u32);
        assert!(cover.contains(&hundredths[0]) && opacity.contains(&hundredths[1]), "{preset:?}: {means:?}");
    }
}

#[test]
fn a_falling_cutoff_closes_the_dome_as_in_the_source_s_pictures() {
    let device = Device::headless(&DeviceOptions::default()).unwrap();
    let cutoffs = [0.85, 0.78, 0.72, 0.61];
    let mut means = [0.0; 4];
    for seed in 0..4 {
        let image = drawn(&device, [128; 3], &NoiseSettings { seed, ..Default::default() });
        let covers = cutoffs.map(|c| image.cover(c));
        assert!(covers.is_sorted(), "{covers:?}");
        means.iter_mut().zip(covers).for_each(|(mean, cover)| *mean += cover / 4.0);
    }
    println!("{means:.3?}");
    for (mean, expected) in means.into_iter().zip([0.07, 0.21, 0.39, 0.76]) {
        assert!((mean - expected).abs() < 0.03, "{means:?}");
    }
}
