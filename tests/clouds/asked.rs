//! Queries about clouds: the sky's light, and the visual range.

use glam::DVec3;
use welkin::{
    clouds::CloudModel,
    frame::FrameFlags,
    light::luminance,
    scene::Camera,
    weather::{CloudKind, CloudLayer, LayerWind, Weather},
};

use crate::drawn::{BROKEN, CLOSED, SIZE, Sky};

/// (east, north, up) through pixels of a camera that stands in the world's axes.
fn directions(camera: &Camera, pixels: &[usize]) -> Vec<DVec3> {
    let inverse = camera.projection.inverse();
    let one = |i: &usize| {
        let uv = [(*i as u32 % SIZE.0, SIZE.0), (*i as u32 / SIZE.0, SIZE.1)];
        let [x, y] = uv.map(|(p, of)| (f64::from(p) + 0.5) / f64::from(of));
        let eye = inverse.project_point3(DVec3::new(2.0 * x - 1.0, 1.0 - 2.0 * y, 0.5)).normalize();
        camera.rotation().transpose() * eye
    };
    pixels.iter().map(one).collect()
}

/// Returns the ratio of the drawn to the queried radiance of the sky, by pixels.
pub fn drawn_over_asked(sky: &mut Sky, forward: DVec3, height_m: f64) -> Vec<f64> {
    let camera = Camera::look_to(DVec3::Z * height_m, forward, DVec3::new(0.1, 0.0, 1.0), 1.0, 16.0 / 9.0, 0.1);
    let picture = sky.look(forward, height_m, None, FrameFlags::NO_HISTORY);
    let sun = sky.context.light_at(camera.position, 0.0).unwrap().sun.apparent;
    let all: Vec<usize> = (0..picture.len()).step_by(23).collect();
    let toward = directions(&camera, &all);
    let asked = sky.context.sky_radiance(camera.position, &toward, 0.0).unwrap();
    let pairs = all.iter().zip(&toward).zip(&asked).filter(|((_, d), _)| d.angle_between(sun) > 0.05);
    pairs.map(|((i, _), asked)| luminance(&picture[*i]) / luminance(asked)).collect()
}

#[test]
fn radiance_toward_clouds_is_that_of_the_picture() {
    let mut off = Vec::new();
    for (report, looks) in [
        (
            BROKEN,
            &[
                (DVec3::new(0.0, 1.0, 0.35), 2.0),
                (DVec3::new(0.8, -0.6, 0.6), 2.0),
                (DVec3::new(0.0, 1.0, -0.2), 6000.0),
            ][..],
        ),
        (CLOSED, &[(DVec3::new(0.0, 1.0, 0.35), 2.0), (DVec3::new(0.0, 1.0, -0.2), 6000.0)]),
    ] {
        let mut sky = Sky::new(report, CloudModel::Volume);
        for (forward, height_m) in looks {
            let ratios = drawn_over_asked(&mut sky, *forward, *height_m);
            let mut each: Vec<f64> = ratios.iter().map(|r| (r - 1.0).abs()).collect();
            each.sort_by(f64::total_cmp);
            let at = |share: f64| each[(each.len() as f64 * share) as usize];
            println!("{report} from {height_m} m: off by {:.3} in the median, {:.3} at 90 %", at(0.5), at(0.9));
            off.extend(each);
        }
    }
    off.sort_by(f64::total_cmp);
    let at = |share: f64| off[(off.len() as f64 * share) as usize];
    println!("all: {:.3} in the median, {:.3} at 90 %, {:.3} at 95 %", at(0.5), at(0.9), at(0.95));
    // A picture takes coarser steps, which the edges of clouds show.
    assert!(at(0.5) < 0.01 && at(0.9) < 0.15, "{} {}", at(0.5), at(0.9));
}

#[test]
fn one_sees_eight_metres_inside_a_towering_cloud() {
    let mut sky = Sky::new(BROKEN, CloudModel::Volume);
    let clouds = vec![CloudLayer::of(CloudKind::ToweringCumulus, 0.4, 1000.0)];
    sky.context.set_weather(&Weather { clouds, ..Weather::default() }, 0.0, 0.0).unwrap();
    let place = |i: i32| DVec3::new(f64::from(i % 20), f64::from(i / 20), 0.0) * 700.0 + DVec3::Z * 1600.0;
    let seen = |i: i32| sky.context.visibility_toward(place(i), DVec3::X, 0.0).unwrap();
    let inside: Vec<f64> = (0..400).map(seen).filter(|m| *m < 20.0).collect();
    let mean = inside.iter().sum::<f64>() / inside.len() as f64;
    println!("visibility inside congestus: {mean:.1} m in {} places of 400", inside.len());
    assert!(inside.len() > 20);
    assert!((mean / 8.0 - 1.0).abs() < 0.2, "{mean}");
}

#[test]
fn a_cloud_between_two_places_takes_the_light() {
    let [volume, deck] = [CloudModel::Volume, CloudModel::Deck].map(|model| Sky::new(CLOSED, model));
    let (below, above) = (DVec3::Z * 800.0, DVec3::Z * 2500.0);
    let through = |sky: &Sky, from, to| sky.context.between(from, to, 0.0).unwrap().transmittance[1];
    assert!(through(&volume, below, above) < 1e-6);
    let back = through(&volume, above, below) / through(&volume, below, above);
    assert!((back - 1.0).abs() < 1e-9, "{back}: the same steps, summed from the other end");
    // A deck is drawn in the sky only, and queries between places ignore it.
    assert!(through(&deck, below, above) > 0.5);
    assert_eq!(through(&volume, DVec3::Z, below), through(&deck, DVec3::Z, below), "below all clouds");
}

/// Pictures and queries have the same fibres and anvils.
#[test]
fn queries_have_the_fibres_and_anvils_of_pictures() {
    for (kind, base_m, height_m) in [(CloudKind::Cirrus, 9000.0, 2.0), (CloudKind::Cumulonimbus, 1000.0, 5000.0)] {
        let mut sky = Sky::new(BROKEN, CloudModel::Volume);
        let wind = Some(LayerWind { speed_m_s: 25.0, from_deg: 240.0 });
        let layer = CloudLayer { wind, ..CloudLayer::of(kind, 0.5, base_m) };
        sky.context.set_weather(&Weather { clouds: vec![layer], ..Weather::default() }, 0.0, 0.0).unwrap();
        let mut off: Vec<f64> = (0..2)
            .flat_map(|i| drawn_over_asked(&mut sky, DVec3::new(1.0, f64::from(i) * 2.0 - 1.0, 0.4), height_m))
            .map(|ratio| (ratio - 1.0).abs())
            .collect();
        off.sort_by(f64::total_cmp);
        let [half, most] = [50, 75].map(|percent| off[off.len() * percent / 100]);
        println!("{kind:?}: pictures off by {half:.4} in the median, {most:.3} at 75 %");
        assert!(half < 0.02 && most < 0.08, "{kind:?}: {half} {most}");
    }
}
