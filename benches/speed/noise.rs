//! Cost of building noise textures, at once and in steps small enough for a frame.

use std::time::{Duration, Instant};

use welkin::gpu::{Device, DeviceOptions};
use welkin::noise::{NoiseImage, NoiseKind, NoiseSettings, NoiseTexture};

/// Texels per step, summed over all channels.
const STEP: u32 = 1 << 16;

fn ms(time: Duration) -> f64 {
    1e3 * time.as_secs_f64()
}

pub fn run() -> welkin::Result<()> {
    let device = Device::headless(&DeviceOptions::default())?;
    println!("noise, {}, in steps of {STEP} texels", device.caps().adapter_name);
    for (name, kind, octaves, frequency, size) in [
        ("a plane of gradient noise", NoiseKind::Gradient, 8, 3, [1024, 1024, 1]),
        ("a volume of gradient noise", NoiseKind::Gradient, 4, 6, [128; 3]),
        ("a volume of the shape of clouds", NoiseKind::GradientOverCellular, 3, 4, [128; 3]),
        ("a volume of their edges", NoiseKind::Cellular, 3, 4, [32; 3]),
    ] {
        let settings = NoiseSettings { kind, octaves, frequency: [frequency; 3], ..Default::default() };
        // The driver compiles in the first round, which does not count.
        let mut best = [Duration::MAX; 3];
        for _ in 0..3 {
            let start = Instant::now();
            let mut texture = NoiseTexture::new(&device, size, &[settings])?;
            let mut longest = Duration::ZERO;
            while !texture.is_drawn() {
                let start = Instant::now();
                let mut encoder = device.device.create_command_encoder(&Default::default());
                texture.step(&mut encoder, STEP);
                device.submit_and_wait(encoder)?;
                longest = longest.max(start.elapsed());
            }
            let stepped = start.elapsed();
            let start = Instant::now();
            NoiseTexture::generate(&device, size, &[settings])?;
            device.wait()?;
            let times = [start.elapsed(), stepped, longest];
            best = std::array::from_fn(|i| best[i].min(times[i]));
        }
        let start = Instant::now();
        NoiseImage::generate(size, &settings)?;
        let [whole, stepped, longest] = best.map(ms);
        println!(
            "  {name}, {octaves} octaves, {size:?}: {whole:.0} ms at once, {stepped:.0} ms in steps of {longest:.1} ms at most; \
             {:.1} times as long in f64 on one core of the CPU",
            ms(start.elapsed()) / whole
        );
    }
    Ok(())
}
