//! Clouds smaller than a pixel, seen from so far away that a pixel contains many.

use glam::DVec3;
use welkin::{
    clouds::{CloudModel, CloudSettings},
    frame::FrameFlags,
    light::luminance,
};

use super::drawn::{SIZE, Sky};

/// Side of the squares of finer pixels whose mean is the truth of one.
const FINER: u32 = 5;

/// Luminance of each pixel, and of the means over the pixels of a finer picture marched in eight times as many steps.
fn far(sky: &mut Sky, (height_m, down): (f64, f64)) -> [Vec<f64>; 2] {
    let forward = DVec3::new(0.0, 1.0, -down);
    let lit = |texels: Vec<[f64; 3]>| texels.iter().map(luminance).collect::<Vec<f64>>();
    let got = lit(sky.look(forward, height_m, None, FrameFlags::NO_HISTORY));
    let format = sky.color.format();
    let [width, height] = [SIZE.0 * FINER, SIZE.1 * FINER];
    let color =
        std::mem::replace(&mut sky.color, welkin_support::textures::texture(&sky.device, (width, height), format, 1));
    let settings = CloudSettings::default();
    sky.view.set_clouds(CloudSettings { fineness: 8.0, square_side: 1, ..settings }).unwrap();
    let fine = lit(sky.look(forward, height_m, None, FrameFlags::NO_HISTORY));
    sky.view.set_clouds(settings).unwrap();
    sky.color = color;
    let mean = |i: u32| {
        let first = i / SIZE.0 * FINER * width + i % SIZE.0 * FINER;
        let one = |k: u32| fine[(first + k / FINER * width + k % FINER) as usize];
        (0..FINER * FINER).map(one).sum::<f64>() / f64::from(FINER * FINER)
    };
    [got, (0..SIZE.0 * SIZE.1).map(mean).collect()]
}

/// With one ray for each pixel, a ray meets a cloud or misses it. From space such a picture would consist of black and
/// white grains, which flicker as the camera moves.
#[test]
fn clouds_smaller_than_a_pixel_are_seen_as_their_mean() {
    // Few, broken and closed; nearly half or more of the picture is clouds.
    for (report, at, most) in [
        ("BKN033", (200e3, 0.4), [0.08, 0.15]),
        ("SCT033", (60e3, 0.3), [0.1, 0.22]),
        ("SCT033CB", (400e3, 0.6), [0.15, 0.4]),
        ("OVC020", (200e3, 0.4), [0.08, 0.11]),
    ] {
        let mut sky = Sky::new(&format!("LOWI 121150Z 00000KT 9999 {report} 18/12 Q1015"), CloudModel::Volume);
        let [got, want] = far(&mut sky, at);
        let all = want.iter().sum::<f64>();
        let mean = got.iter().sum::<f64>() / all - 1.0;
        let squares = got.iter().zip(&want).map(|(g, w)| (g - w) * (g - w)).sum::<f64>();
        let grain = (squares * want.len() as f64).sqrt() / all;
        println!("{report} from {:.0} km: {:+.1} % in the mean, grain {grain:.3} of it", at.0 / 1e3, 100.0 * mean);
        assert!(mean.abs() < most[0] && grain < most[1], "{report}: {mean:.3}, {grain:.3}");
    }
}
