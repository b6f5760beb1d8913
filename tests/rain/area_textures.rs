//! Rain areas in the textures for the host's own transparent shaders: these veil what lies behind a shaft of rain as
//! the picture does.

use glam::{DVec2, DVec3};
use welkin::{
    frame::Stages,
    gpu::readback,
    rain::{RainArea, RainModel, RainSettings},
};
use welkin_support::rain_scene::upright;

use crate::areas::{fair, host, shower, square};

/// The published snippet's lookup, written again: bilinear within a tile, linear between slices.
fn sample(texels: &[[f32; 4]], uv: DVec2, distance: f64) -> f64 {
    let s = ((distance / 20.0 + 1.0).ln() * 3.639_611_2).clamp(0.0, 31.0);
    let near = s.floor().min(30.0);
    let at = |slice: f64| {
        let (x, y) = ((slice % 8.0) * 32.0 + uv.x * 31.0, (slice / 8.0).floor() * 18.0 + uv.y * 17.0);
        let row = |j: f64| {
            let [a, b] = [x.floor(), x.ceil()].map(|i| f64::from(texels[j as usize * 256 + i as usize][1]));
            a + x.fract() * (b - a)
        };
        row(y.floor()) + y.fract() * (row(y.ceil()) - row(y.floor()))
    };
    at(near) + (s - near) * (at(near + 1.0) - at(near))
}

#[test]
fn what_is_behind_a_shaft_is_veiled_in_the_textures_as_in_the_picture() {
    let beside =
        RainArea { center_m: [2600.0, 7500.0, 0.0], shape: square(1300.0), heading_deg: 20.0, ..shower(0.0, 6.0) };
    let mut host = host(&fair(6.0), &[]);
    host.view.set_rain(RainSettings { model: RainModel::Veil, ..RainSettings::default() }).unwrap();
    host.view.frame_textures().unwrap();
    let stages = Stages::PREPARE.with(Stages::MEDIUM).with(Stages::PARTICLES);
    for (place, areas) in [("outside", vec![shower(6000.0, 10.0), beside]), ("inside", vec![shower(0.0, 10.0)])] {
        host.look(DVec3::new(0.0, 0.0, 1.7), DVec3::new(0.1, 1.0, 0.1));
        let (mut least, mut off) = (1.0f64, [0.0f64; 2]);
        for distance in [300.0, 3000.0, 6000.0, 12_000.0] {
            host.boxes = vec![upright([0.0, distance + 5.0, 0.0], [3.0 * distance, 5.0, 3.0 * distance])];
            let mut shown = |areas: &[RainArea], wall: f64| {
                host.context.set_rain_areas(areas).unwrap();
                host.draw(|_, _| [wall; 3]);
                host.record(stages).unwrap();
                host.pixels()
            };
            let clear = shown(&[], 0.0);
            let (white, black) = (shown(&areas, 10_000.0), shown(&areas, 0.0));
            let textures = host.view.frame_textures().unwrap();
            let [light, through] =
                [&textures.light, &textures.through].map(|t| readback::rgba(&host.device, t).unwrap());
            let exposure = 1.0 / f64::from(textures.light_scale);
            for (x, y) in (5..155).step_by(11).flat_map(|x| (5..85).step_by(9).map(move |y| (x, y))) {
                let uv = DVec2::new((f64::from(x) + 0.5) / 160.0, (f64::from(y) + 0.5) / 90.0);
                let Some((p, _)) = host.cast(DVec2::new(2.0 * uv.x - 1.0, 1.0 - 2.0 * uv.y)) else { continue };
                if p.y < 0.9 * distance {
                    continue;
                }
                let at = (y * 160 + x) as usize;
                let want_through = f64::from(white[at][1] - black[at][1]) / 10_000.0;
                let want_light = f64::from(black[at][1]);
                let (t, l) = (sample(&through, uv, p.length()), sample(&light, uv, p.length()) / exposure);
                least = least.min(want_through);
                let of = [(t - want_through).abs(), (l - want_light).abs() / f64::from(clear[at][1]).max(1000.0)];
                off = [off[0].max(of[0]), off[1].max(of[1])];
                // Halfway between two slices in the middle of a shaft, linear interpolation is not exact.
                let slice = (p.length() / 20.0 + 1.0).ln() * 3.639_611_2;
                let limit = if (slice - slice.round()).abs() < 0.06 { 0.035 } else { 0.13 };
                assert!(
                    of[0] < limit,
                    "{place} {distance} m, {x} {y}: {t} gets through, {want_through} in the picture"
                );
                assert!(of[1] < 2.0 * limit, "{place} {distance} m, {x} {y}: {l} cd/m2, {want_light} in the picture");
            }
        }
        println!("{place}: at most {off:?} off, {least} at the least gets through");
        assert!(least < 0.3, "{place}: {least}");
    }
}
