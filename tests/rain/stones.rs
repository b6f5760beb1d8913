//! Hail and ice pellets: how much they hide, where they hop, where none fall.

use glam::DVec3;
use welkin::{
    rain::Stones,
    weather::{Precipitation, PrecipitationKind, Weather, derive},
};
use welkin_support::rain_scene::{Host, upright};

use crate::{
    drops::{mean, through, white},
    pictures::{paint, save},
};

fn ice(kind: PrecipitationKind, rate: f64, wind: f64) -> Weather {
    let mut weather =
        Weather { precipitation: Precipitation::of(kind, rate), visibility_m: 20_000.0, ..Weather::default() };
    weather.wind.speed_m_s = wind;
    weather.wind.from_deg = 270.0;
    weather
}

#[test]
fn stones_hide_as_much_as_their_extinction_says() {
    let mut host = white((320, 180));
    for (i, (kind, rate, wind, speed)) in [
        (PrecipitationKind::IcePellets, 3.0, 0.0, 0.0),
        (PrecipitationKind::Hail, 100.0, 8.0, 0.0),
        (PrecipitationKind::SmallHail, 40.0, 15.0, 0.0),
        (PrecipitationKind::SmallHail, 40.0, 0.0, 300.0),
    ]
    .into_iter()
    .enumerate()
    {
        let (t, weather) = (10.0 + 50.0 * i as f64, ice(kind, rate, wind));
        host.context.set_weather(&weather, t, 0.0).unwrap();
        let wanted = Stones::new(&derive(&weather).unwrap().precipitation, 1.0, 100_000).hidden_depth();
        host.velocity_m_s = DVec3::Y * speed;
        let mut seen = Vec::new();
        for k in 0..12 {
            host.context.update(t + f64::from(k)).unwrap();
            seen.push(mean(&through(&mut host)));
        }
        let got = -mean(&seen).ln();
        println!("{kind:?} at {speed} m/s: {got:.5} of {wanted:.5}");
        assert!((got / wanted - 1.0).abs() < 0.12, "{kind:?} at {speed} m/s: {got} of {wanted}");
    }
}

#[test]
fn hail_hops_where_it_lands_and_nowhere_under_a_roof() {
    let mut host = Host::new((320, 180));
    let weather = ice(PrecipitationKind::Hail, 30.0, 0.0);
    host.context.set_weather(&weather, 5.0, 0.0).unwrap();
    host.context.set_sun(Some(welkin::context::GivenDirection { azimuth_deg: 0.0, elevation_deg: -40.0 })).unwrap();
    host.look(DVec3::new(0.0, 0.0, 2.5), DVec3::new(0.0, 1.0, -0.6));
    // Under a wide roof no stone falls and none hops: a stone would hide part of the white ground.
    host.context.set_shelters(&[upright([0.0, 0.0, 9.0], [400.0, 400.0, 0.1])]).unwrap();
    host.context.update(7.0).unwrap();
    assert!(through(&mut host).iter().all(|v| *v == 1.0), "under the roof");
    // A falling stone passes too fast to hide half of a pixel; one that does has landed.
    host.context.set_shelters(&[]).unwrap();
    let mut marks = Vec::new();
    for k in 0..30 {
        host.context.update(8.0 + 0.05 * f64::from(k)).unwrap();
        let seen = through(&mut host);
        marks.push(seen.iter().filter(|v| **v < 0.5).count());
    }
    assert!(marks.iter().all(|m| (1..100).contains(m)) && marks.iter().sum::<usize>() > 120, "{marks:?}");
}

#[test]
fn pictures_of_hail_and_pellets() {
    let mut host = Host::new((640, 360));
    host.boxes = vec![upright([3.5, 7.0, 1.0], [1.0, 2.0, 1.0])];
    host.look(DVec3::new(0.5, 0.0, 1.7), DVec3::new(0.1, 1.0, -0.18));
    for (i, (kind, rate, wind, name)) in [
        (PrecipitationKind::Hail, 30.0, 4.0, "hail"),
        (PrecipitationKind::IcePellets, 3.0, 3.0, "pellets"),
        (PrecipitationKind::SmallHail, 20.0, 6.0, "small_hail"),
    ]
    .into_iter()
    .enumerate()
    {
        let t = 100.0 * (i + 1) as f64;
        host.context.set_weather(&ice(kind, rate, wind), t, 0.0).unwrap();
        host.context.update(t + 3.0).unwrap();
        host.context.set_shelters(&host.boxes).unwrap();
        paint(&host);
        host.record(welkin::frame::Stages::ALL).unwrap();
        let pixels = save(&host, &format!("stones_{name}.png"));
        println!("{name}: {} stones", host.view.report().rain.drops);
        assert!(pixels.iter().flatten().all(|v| v.is_finite() && *v >= 0.0));
    }
}
