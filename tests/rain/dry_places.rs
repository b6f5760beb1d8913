//! Dry places that move, and dry places in the default model, whose cones have no distance for each streak: rain drawn
//! where rays show that none falls.

use glam::{DVec2, DVec3};
use welkin::{
    context::GivenDirection,
    frame::Stages,
    rain::{
        OccluderMap, RainModel, RainSettings, Shelter, Taken,
        cones::{BANDS_M, CONES},
        shelter::sheltered,
        splash,
    },
    scene::Camera,
};
use welkin_support::rain_scene::{Host, NEAR_M, rain, upright};

use crate::{
    drops::classes,
    shelter::{check, few, map, through, white},
};

fn automatic(host: &mut Host) {
    host.view.set_rain(RainSettings { model: RainModel::Automatic, ..RainSettings::default() }).unwrap();
}

#[test]
fn a_map_of_a_truck_goes_on_with_it() {
    let mut host = white((480, 270));
    let speed = DVec3::Y * 10.0;
    // How old the map is, s.
    let age = 0.2;
    let (mut dry, mut drawn) = (0, 0);
    for (i, wind) in [0.0, 5.0, 12.0, 25.0].into_iter().enumerate() {
        let classes = few(&mut host, 10.0, wind, 10.0 * (i + 1) as f64);
        let t = host.context.time_s();
        let eye = DVec3::new(-0.5, -4.0, 1.7);
        let fall = host.context.rain_at(eye, t).unwrap().fall_velocity_m_s;
        let truck = Shelter { velocity_m_s: speed, ..upright([0.5, 1.5, 2.9], [1.3, 3.5, 0.9]) };
        let then = Shelter { center_m: truck.center_m - speed * age, ..truck };
        // Half the side of the maps, across the drops' way.
        let half = 6.0;
        let taken = [fall.z, -3.4, -2.1].map(|z| {
            let f = (DVec3::new(fall.x, fall.y, z) - speed).normalize();
            Taken {
                time_s: t - age,
                velocity_m_s: speed,
                ..Taken::parallel(then.center_m - f * 60.0, f, [half; 2], 120.0)
            }
        });
        let textures = taken.map(|t| map(&host, &[then], &t, (256, 256)));
        let maps = [0, 1, 2].map(|i| OccluderMap { depth: &textures[i], taken: taken[i] });
        host.context.set_occluder_maps(&maps).unwrap();
        for to in [DVec3::new(0.5, 1.5, 1.0), DVec3::new(-1.5, 3.0, 1.2)] {
            host.look(eye, to - eye);
            let slack = 2.0 * (2.0 * half / 256.0);
            let (a, b) = check(&mut host, (&[truck], &[truck]), &classes, slack, &format!("truck, wind {wind}"));
            (dry, drawn) = (dry + a, drawn + b);
        }
    }
    println!("{dry} drops kept off, {drawn} drawn");
    assert!(dry > 60 && drawn > 120, "{dry} {drawn}");
}

/// Checks a cab, and a bus that is longer than the range of the default model's drops.
#[test]
fn no_streak_of_the_default_model_is_inside_a_cab() {
    let mut host = white((160, 90));
    automatic(&mut host);
    for (i, (long, wind, v)) in [(1.6, 8.0, 25.0), (1.6, 25.0, 0.0), (12.0, 3.0, 15.0)].into_iter().enumerate() {
        let t = 10.0 * (i + 1) as f64;
        host.context.set_weather(&rain(60.0, wind), t, 0.0).unwrap();
        host.context.update(t + 1.0).unwrap();
        host.velocity_m_s = DVec3::Y * v;
        let eye = DVec3::new(0.0, 0.0, 2.0);
        host.look(eye, DVec3::new(0.05, 1.0, -0.1));
        // The vehicle is open to the front; the camera sits at its back end.
        let place = |c: [f64; 3], h: [f64; 3]| upright((eye + DVec3::from(c)).to_array(), h);
        let cab = place([0.0, 0.5 * long, 0.0], [1.5, 0.5 * long + 0.5, 1.5]);
        host.context.set_shelters(&[Shelter { velocity_m_s: host.velocity_m_s, ..cab }]).unwrap();
        let walls = [
            place([0.0, 0.5 * long, -1.35], [1.4, 0.5 * long, 0.05]),
            place([-1.35, 0.5 * long, 0.0], [0.05, 0.5 * long, 1.4]),
            place([1.35, 0.5 * long, 0.0], [0.05, 0.5 * long, 1.4]),
        ];
        let pixels = through(&mut host, &walls);
        let (mut inside, mut seen) = (0, 0);
        for (i, v) in pixels.iter().enumerate() {
            let at = DVec2::new((i % 160) as f64 + 0.5, (i / 160) as f64 + 0.5);
            let ndc = DVec2::new(at.x / 80.0 - 1.0, 1.0 - at.y / 45.0);
            let (p, _) = host.cast(ndc).unwrap();
            if p.y < long && p.x.abs() < 1.45 && p.z.abs() < 1.45 {
                inside += 1;
                assert_eq!(*v, 1.0, "wind {wind}, {long} m: {at}");
            } else {
                seen += u32::from(*v < 0.99);
            }
        }
        assert!(inside > 1000 && seen > 20, "wind {wind}, {long} m: {inside} pixels inside, it rains in {seen}");
    }
}

/// Light of the rain in each pixel against black, mean over some moments.
fn lit(host: &mut Host, from_s: f64) -> Vec<f64> {
    let mut sum = vec![0.0; 160 * 90];
    for k in 0..12 {
        host.context.update(from_s + 0.83 * f64::from(k)).unwrap();
        host.draw(|_, _| [0.0; 3]);
        host.record(Stages::PREPARE.with(Stages::PARTICLES)).unwrap();
        sum.iter_mut().zip(host.pixels()).for_each(|(s, p)| *s += f64::from(p[1]) / 12.0);
    }
    sum
}

/// Returns the share of the rain along the ray of pixel `i` that the deck does not keep off, by rays along the fall.
/// `falls` has for each drop size how much its drops hide, and their velocity. Also returns whether the pixel shows no
/// splashes: these depend on the surface alone, not on the rain along the ray.
fn share(host: &Host, deck: &Shelter, falls: &[(f64, DVec3)], i: usize) -> (f64, bool) {
    let at = DVec2::new((i % 160) as f64 + 0.5, (i / 160) as f64 + 0.5);
    let (p, _) = host.cast(DVec2::new(at.x / 80.0 - 1.0, 1.0 - at.y / 45.0)).unwrap();
    let eye = host.camera.position;
    let plain = (p.z + eye.z).abs() > 0.01 || p.truncate().length() > splash::REACH_M;
    let (d, far) = (p.normalize(), p.length().min(BANDS_M[CONES]));
    let places = (0..48).map(|k| BANDS_M[0] + (far - BANDS_M[0]) * (f64::from(k) + 0.5) / 48.0);
    let discs: f64 = falls.iter().map(|f| f.0).sum();
    let free = |p: DVec3| falls.iter().filter(|f| !sheltered(deck, eye + p, f.1)).map(|f| f.0).sum::<f64>() / discs;
    (places.map(|s| free(d * s)).sum::<f64>() / 48.0, plain)
}

#[test]
fn the_default_model_shows_the_share_of_the_rain_that_rays_leave_round_a_deck() {
    let mut host = Host::new((160, 90));
    host.context.set_sun(Some(GivenDirection { azimuth_deg: 180.0, elevation_deg: 50.0 })).unwrap();
    automatic(&mut host);
    let deck = upright([0.0, 9.0, 5.2], [12.0, 8.0, 0.4]);
    host.boxes = vec![deck, upright([0.0, 400.0, 0.0], [400.0, 1.0, 2000.0])];
    for (i, wind) in [0.0, 4.0, 12.0].into_iter().enumerate() {
        let t = 100.0 * (i + 1) as f64;
        let mut weather = rain(30.0, wind);
        // Without turbulence rays of one moment hold for all moments.
        weather.wind.turbulence_intensity = Some(0.0);
        host.context.set_weather(&weather, t, 0.0).unwrap();
        host.context.update(t).unwrap();
        let air = host.context.carrying_wind(t).unwrap();
        // Share of the cover that drops of each size have, and their velocity.
        let falls = classes(&weather, u32::MAX).flux.into_iter().filter(|c| c.1 > 0.0);
        let falls: Vec<_> = falls.map(|(d, v, flux)| (flux / v * d * d, air - DVec3::Z * v)).collect();
        // Maps along drops of three sizes.
        let over = DVec3::new(0.0, 6.0, 0.0);
        let taken = [6.0, 3.4, 2.1].map(|v| {
            let f = (air - DVec3::Z * v).normalize();
            Taken::parallel(over - f * 60.0, f, [20.0; 2], 120.0)
        });
        let textures = taken.map(|t| map(&host, &[deck], &t, (512, 512)));
        let maps = [0, 1, 2].map(|i| OccluderMap { depth: &textures[i], taken: taken[i] });
        // From under the deck looking out, and from outside looking under it.
        for (k, (what, y)) in [("out", 13.0), ("under", -3.0)].into_iter().enumerate() {
            let t = t + 30.0 * k as f64;
            let eye = DVec3::new(0.0, y, 1.7);
            host.camera = Camera::look_to(eye, DVec3::Y, DVec3::Z, 0.9, 16.0 / 9.0, NEAR_M);
            let start = host.context.save().unwrap();
            let open = lit(&mut host, t);
            // The share of each pixel's rain by rays.
            let shares: Vec<_> = (0..open.len()).map(|i| share(&host, &deck, &falls, i)).collect();
            for (by, boxes, maps) in [("a box", &[deck][..], &[][..]), ("maps", &[], &maps[..])] {
                // The saved state brings the same drops again.
                host.context.load(&start).unwrap();
                host.context.set_shelters(boxes).unwrap();
                host.context.set_occluder_maps(maps).unwrap();
                let seen = lit(&mut host, t);
                host.context.set_shelters(&[]).unwrap();
                host.context.set_occluder_maps(&[]).unwrap();
                let [mut all, mut got, mut truth, mut inside, mut kept] = [0.0; 5];
                for ((seen, open), (share, plain)) in seen.iter().zip(&open).zip(&shares) {
                    if *plain {
                        (all, got, truth) = (all + open, got + seen, truth + open * share);
                    }
                    if *share == 0.0 {
                        (inside, kept) = (inside + seen, kept + open);
                    }
                }
                println!(
                    "wind {wind}, looking {what}, by {by}: {:.3} of the open rain's light, {:.3} by rays; where all is dry {:.4}",
                    got / all,
                    truth / all,
                    inside / f64::max(kept, 1e-9)
                );
                let what = format!("wind {wind}, {what}, by {by}");
                assert!(((got - truth) / all).abs() < 0.06, "{what}: {got} of {all}, {truth} by rays");
                // Seen from outside, no ray lies under the deck over its whole length; and wind blows small drops under
                // the deck as far as the camera.
                assert!((kept > 0.0) == (what.contains("out") && wind < 10.0), "{what}: {kept}");
                assert!(inside <= 0.01 * kept, "{what}: {inside} of {kept}");
            }
        }
    }
}
