//! The two eyes of one head, each a view of one context with an asymmetric projection: both see far things in the same
//! direction, near drops with the right parallax, and the same drops.

use glam::{DVec2, DVec3};
use welkin::{
    context::GivenDirection,
    frame::{Stages, View},
    rain::{Classes, RainModel, RainSettings, lattice},
    scene::Camera,
    weather::{CloudKind, CloudLayer, Fog, FogKind, Weather, derive},
};
use welkin_support::rain_scene::{Host, NEAR_M, rain, upright};

use crate::shelter::{check, through, white};

const SIZE: (u32, u32) = (320, 180);
/// Distance between the eyes.
const APART_M: f64 = 0.065;
/// Pixels by which an infinitely far thing lies farther left in the left eye's picture than in the right eye's.
const SHIFT: u32 = 6;

/// Left and right eye of a head that looks level to the north. Things about 2 m away have the same place in both
/// pictures.
fn eyes(head: DVec3) -> [Camera; 2] {
    let (width, height) = (f64::from(SIZE.0), f64::from(SIZE.1));
    [-1.0, 1.0].map(|side| {
        let eye = head + DVec3::X * (0.5 * side * APART_M);
        let mut camera = Camera::look_to(eye, DVec3::Y, DVec3::Z, 0.9, width / height, NEAR_M);
        camera.projection.z_axis.x = -side * f64::from(SHIFT) / width;
        camera
    })
}

/// Parallax of a thing at a distance, pixels: how much farther right it lies in the left eye's picture, against the
/// right eye's, than an infinitely far thing does.
fn parallax(distance_m: f64) -> f64 {
    let focal = eyes(DVec3::ZERO)[0].projection.x_axis.x * 0.5 * f64::from(SIZE.0);
    focal * APART_M / distance_m
}

/// Few drops and a shutter so short that they appear as discs.
fn drop_by_drop() -> RainSettings {
    RainSettings { model: RainModel::Drops, shutter_s: 1e-3, most_drops: Some(4000), ..RainSettings::default() }
}

/// Runs `work` for each eye with its own view, which draws rain drop by drop.
fn each<T>(host: &mut Host, head: DVec3, mut work: impl FnMut(&mut Host, bool) -> T) -> [T; 2] {
    let mut other = View::new(&host.context).unwrap();
    host.view.set_rain(drop_by_drop()).unwrap();
    other.set_rain(drop_by_drop()).unwrap();
    let [left, right] = eyes(head);
    host.camera = left;
    let first = work(host, true);
    std::mem::swap(&mut host.view, &mut other);
    host.camera = right;
    let second = work(host, false);
    std::mem::swap(&mut host.view, &mut other);
    [first, second]
}

#[test]
fn far_sky_clouds_and_fog_are_the_same_in_both_eyes() {
    let mut host = Host::new(SIZE);
    host.context.set_sun(Some(GivenDirection { azimuth_deg: 20.0, elevation_deg: 15.0 })).unwrap();
    let clear = Weather { clouds: vec![CloudLayer::of(CloudKind::Cumulus, 0.5, 900.0)], ..Weather::default() };
    let fog = Weather { visibility_m: 400.0, fog: Fog::of(FogKind::Fog), ..Weather::default() };
    for (weather, name) in [(clear, "clouds"), (fog, "fog")] {
        host.context.set_weather(&weather, host.context.time_s(), 0.0).unwrap();
        let mut far = Vec::new();
        let [left, right] = each(&mut host, DVec3::new(3.0, 5.0, 1.7), |host, first| {
            let stages = Stages::ALL.without(Stages::PARTICLES.with(Stages::TONE));
            // A volume of clouds is complete after sixteen frames.
            for _ in 0..if name == "clouds" { 20 } else { 1 } {
                host.draw(|_, _| [900.0; 3]);
                host.record(stages).unwrap();
            }
            if first {
                let ndc = |i: u32| 1.0 - (f64::from(i) + 0.5) / f64::from(SIZE.1) * 2.0;
                far = (0..SIZE.1)
                    .map(|y| host.cast(DVec2::new(0.0, ndc(y))).is_none_or(|(p, _)| p.length() > 60.0))
                    .collect();
            }
            host.pixels()
        });
        let (mut off, mut seen) = (Vec::new(), [f32::MAX, 0.0]);
        for (y, _) in far.iter().enumerate().filter(|(_, far)| **far) {
            for x in 0..(SIZE.0 - SHIFT) as usize {
                let at = |x: usize| y * SIZE.0 as usize + x;
                let (l, r) = (left[at(x)], right[at(x + SHIFT as usize)]);
                off.push((0..3).map(|c| (l[c] / r[c] - 1.0).abs()).fold(0.0, f32::max));
                seen = [seen[0].min(l[1]), seen[1].max(l[1])];
            }
        }
        assert!(far.iter().filter(|f| **f).count() > 90 && seen[1] > 1.2 * seen[0], "{name}: {seen:?}");
        // Each of sixteen neighbouring pixels has its own march steps, so that single pixels at the edges of clouds
        // differ.
        off.sort_by(f32::total_cmp);
        let most = off[(off.len() - 1) * if name == "clouds" { 95 } else { 100 } / 100];
        println!("{name}: {most:.4}, at most {:.4}", off[off.len() - 1]);
        assert!(most < 0.02, "{name}: {most}");
    }
}

#[test]
fn both_eyes_see_the_same_drops_displaced_as_near_things_are() {
    let mut host = white(SIZE);
    let weather = rain(10.0, 0.0);
    host.context.set_weather(&weather, 0.0, 0.0).unwrap();
    host.context.update(7.0).unwrap();
    let head = DVec3::new(1.5, -2.0, 1.7);
    let classes = Classes::new(&derive(&weather).unwrap().precipitation, 1.0, 4000);
    let t = host.context.time_s();
    let moved = host.context.wind_displacement(t).unwrap();
    // The same drops at the same places of the world, wherever the eye is.
    let mut near = eyes(head).map(|camera| {
        let all = lattice::drops(&classes, 11, camera.position, moved, t);
        let world = all.into_iter().filter(|d| d.share > 0.0).map(|d| (d.id, camera.position + d.position_m));
        world.filter(|(_, p)| (*p - head).length() < 2.5).collect::<Vec<_>>()
    });
    near.iter_mut().for_each(|drops| drops.sort_by_key(|d| d.0));
    let [left, right] = &near;
    let both: Vec<_> = left
        .iter()
        .filter_map(|(id, p)| right.binary_search_by_key(id, |d| d.0).ok().map(|i| (*p - right[i].1).length()))
        .collect();
    // A few drops fade in or out with the distance from an eye.
    let most = left.len().max(right.len());
    assert!(both.len() > 300 && both.len() as f64 > 0.95 * most as f64, "{} of {most}", both.len());
    assert!(both.iter().all(|off| *off < 1e-3), "{both:?}");
    // The pictures against the drops: each drop is drawn where it lies for that eye, and nothing else is drawn.
    let wall = [upright([1.5, 0.6, 0.0], [20.0, 0.1, 50.0])];
    let counts = each(&mut host, head, |host, _| check(host, (&wall, &wall), &classes, 0.02, "an eye"));
    assert!(counts.iter().all(|(_, drawn)| *drawn > 50), "{counts:?}");
    // From the pictures alone: things nearer than the wall lie farther right in the left eye's picture.
    let dark = each(&mut host, head, |host, _| {
        through(host, &wall).into_iter().map(|v| (1.0 - v).max(0.0)).collect::<Vec<_>>()
    });
    let alike = |by: i32| -> f64 {
        let shift = by - SHIFT as i32;
        let row = |y: u32| (40..SIZE.0 as i32 - 40).map(move |x| (y * SIZE.0) as i32 + x);
        (0..SIZE.1).flat_map(row).map(|i| dark[0][i as usize] * dark[1][(i - shift) as usize]).sum()
    };
    let wall_m = 0.5 - head.y;
    let (least, most) = (parallax(wall_m).floor() as i32, parallax(0.4).ceil() as i32);
    let best = (-most..=most).max_by(|a, b| alike(*a).total_cmp(&alike(*b))).unwrap();
    let mean = |range: std::ops::RangeInclusive<i32>| {
        let n = range.clone().count() as f64;
        range.map(alike).sum::<f64>() / n
    };
    let (right_way, wrong_way) = (mean(least..=most), mean(-most..=-least));
    assert!((least..=most).contains(&best), "{best} is not in {least}..={most}");
    assert!(right_way > 10.0 * wrong_way, "{right_way} {wrong_way}");
}
