//! Splashes and stones on surfaces that are not level: planes of any tilt, kerbs, roofs in wind.

use glam::{DMat4, DVec2, DVec3};
use welkin::rain::{
    RainModel, RainSettings,
    splash::{LEAST_MM, LIFE_S, Splashes},
};
use welkin_support::rain_scene::{Host, rain, upright};

use crate::{
    pictures::{paint, save},
    shelter::{few, through, white},
};

const SIZE: (u32, u32) = (480, 270);
/// Number of pictures that each count sums over.
const TIMES: u32 = 4;

/// Numbers of landings over moments far apart: expected, drawn where expected, and drawn where not expected.
#[derive(Default, Debug)]
struct Count {
    standing: f64,
    wanted: u32,
    drawn: u32,
    unwanted: u32,
    drawn_all_the_same: u32,
}

/// Counts landings within five metres on a surface: `surface` returns its height above the world's origin and its
/// normal, or `None` beyond and near its edges.
fn count(host: &mut Host, splashes: &Splashes, from: f64, surface: impl Fn(DVec2) -> Option<(f64, DVec3)>) -> Count {
    let clip = host.camera.projection * DMat4::from_mat3(host.camera.rotation());
    let eye = host.camera.position;
    let boxes = host.boxes.clone();
    let mut count = Count::default();
    for k in 0..TIMES {
        let t = from + 0.31 * f64::from(k);
        host.context.update(t).unwrap();
        let wind = host.context.carrying_wind(t).unwrap();
        let pixels = through(host, &boxes);
        for l in splashes.landings(11, eye, t).filter(|l| l.xy_m.length() < 5.0) {
            count.standing += if l.chance < 1.0 { 1.0 } else { 0.0 };
            let Some((z, normal)) = surface(l.xy_m + eye.truncate()) else { continue };
            let at = l.xy_m.extend(z - eye.z);
            let p = clip * at.extend(1.0);
            let ndc = DVec2::new(p.x, p.y) / p.w;
            let hidden = host.cast(ndc).is_none_or(|(first, _)| first.length() < at.length() - 0.05);
            if l.age > 0.6 || p.w < 0.1 || ndc.abs().max_element() > 0.97 || hidden {
                continue;
            }
            let pixel = DVec2::new((ndc.x * 0.5 + 0.5) * f64::from(SIZE.0), (0.5 - ndc.y * 0.5) * f64::from(SIZE.1));
            let near = (-2..=2).flat_map(|y| (-2..=2).map(move |x| (pixel.x as i32 + x, pixel.y as i32 + y)));
            let least = near.map(|(x, y)| pixels[(y * SIZE.0 as i32 + x) as usize]).fold(1.0, f64::min);
            let velocity = wind - DVec3::Z * l.speed_m_s;
            let lands = l.chance < (-velocity.dot(normal)).max(0.0) / (l.speed_m_s * normal.z);
            let seen = u32::from(least < 0.999);
            if lands {
                (count.wanted, count.drawn) = (count.wanted + 1, count.drawn + seen);
            } else {
                (count.unwanted, count.drawn_all_the_same) = (count.unwanted + 1, count.drawn_all_the_same + seen);
            }
        }
    }
    count
}

/// Sets rain of few drops, whose splashes can be distinguished.
fn splashing(host: &mut Host, wind: f64, t: f64) -> (Splashes, f64) {
    let classes = few(host, 1.0, wind, t);
    host.view
        .set_rain(RainSettings {
            model: RainModel::Drops,
            shutter_s: 1e-4,
            most_drops: Some(1000),
            ..RainSettings::default()
        })
        .unwrap();
    let flux = classes.flux.iter().filter(|f| f.0 >= LEAST_MM).map(|f| f.2).sum();
    (Splashes::new(&classes), flux)
}

fn look_over(host: &mut Host, normal: DVec3, foot: DVec2) {
    host.normal = normal;
    let z = -normal.truncate().dot(foot) / normal.z;
    let ahead = DVec3::new(0.0, normal.z, -normal.y).normalize();
    host.look(foot.extend(z + 1.8), ahead - normal * 0.4);
}

#[test]
fn splashes_on_slopes_are_as_many_as_the_flux_brings() {
    let mut host = white(SIZE);
    let (splashes, flux) = splashing(&mut host, 0.0, 10.0);
    let mut t = 20.0;
    // The ground at the height where the search begins, and far above and below it.
    for foot in [DVec2::ZERO, DVec2::new(3.0, 20.0), DVec2::new(3.0, -20.0)] {
        for tilt in [-44.0f64, -35.0, -20.0, -10.0, 10.0, 20.0, 35.0, 44.0] {
            let a = tilt.to_radians();
            let normal = DVec3::new(0.0, -a.sin(), a.cos());
            look_over(&mut host, normal, foot);
            t += 10.0;
            let c = count(&mut host, &splashes, t, |xy| Some((-normal.truncate().dot(xy) / normal.z, normal)));
            let want = flux * LIFE_S * 25.0 * std::f64::consts::PI * f64::from(TIMES);
            println!("{tilt} degrees from {foot}: {c:?}, flux x area says {want:.0}");
            assert!((c.standing - want).abs() < 4.0 * want.sqrt(), "{tilt}: {c:?} {want}");
            assert!(c.wanted > 40 && f64::from(c.drawn) > 0.95 * f64::from(c.wanted), "{tilt} from {foot}: {c:?}");
        }
    }
}

#[test]
fn slopes_to_windward_get_more_and_those_to_leeward_less() {
    let mut host = white(SIZE);
    let (splashes, _) = splashing(&mut host, 9.0, 10.0);
    for (i, tilt) in [-25.0f64, 25.0].into_iter().enumerate() {
        let a = tilt.to_radians();
        let normal = DVec3::new(a.sin(), 0.0, a.cos());
        look_over(&mut host, normal, DVec2::ZERO);
        let t = 20.0 + 10.0 * i as f64;
        let c = count(&mut host, &splashes, t, |xy| Some((-normal.truncate().dot(xy) / normal.z, normal)));
        println!("{tilt} degrees: {c:?}");
        assert!(c.wanted > 10 && f64::from(c.drawn) > 0.95 * f64::from(c.wanted), "{tilt}: {c:?}");
        assert!(c.drawn_all_the_same * 8 <= c.unwanted, "{tilt}: {c:?}");
        assert!(if tilt < 0.0 { c.unwanted == 0 } else { c.unwanted > c.wanted }, "{tilt}: {c:?}");
    }
}

#[test]
fn splashes_stand_above_and_below_kerbs() {
    let mut host = white(SIZE);
    let (splashes, _) = splashing(&mut host, 0.0, 10.0);
    // A kerb, and a wall half a metre high: beyond its edge the distance to the ground jumps.
    host.boxes = vec![upright([0.0, 2.5, 0.0], [30.0, 0.5, 0.15]), upright([0.0, 4.2, 0.0], [30.0, 0.4, 0.5])];
    let tops = [(2.0, 3.0, 0.15), (3.8, 4.6, 0.5)];
    host.look(DVec3::new(0.1, 0.0, 1.8), DVec3::new(0.0, 1.0, -0.5));
    let c = count(&mut host, &splashes, 20.0, |xy| {
        let edge = tops.iter().any(|t| (xy.y - t.0).abs() < 0.08 || (xy.y - t.1).abs() < 0.08);
        let top = tops.iter().find(|t| (t.0..t.1).contains(&xy.y)).map_or(0.0, |t| t.2);
        (!edge).then_some((top, DVec3::Z))
    });
    println!("{c:?}");
    assert!(c.wanted > 40 && f64::from(c.drawn) > 0.95 * f64::from(c.wanted), "{c:?}");
}

#[test]
fn pictures_of_a_tilted_road_in_a_cloudburst() {
    let mut host = Host::new((640, 360));
    host.view.set_rain(RainSettings { model: RainModel::Drops, ..RainSettings::default() }).unwrap();
    for (i, tilt) in [-12.0f64, 12.0, 30.0].into_iter().enumerate() {
        let a = tilt.to_radians();
        look_over(&mut host, DVec3::new(0.0, -a.sin(), a.cos()), DVec2::ZERO);
        let t = 100.0 * (i + 1) as f64;
        host.context.set_weather(&rain(60.0, 6.0), t, 0.0).unwrap();
        host.context.update(t + 1.0).unwrap();
        paint(&host);
        host.record(welkin::frame::Stages::ALL).unwrap();
        let pixels = save(&host, &format!("splashes_{tilt}.png"));
        assert!(pixels.iter().flatten().all(|v| v.is_finite() && *v >= 0.0));
    }
}
