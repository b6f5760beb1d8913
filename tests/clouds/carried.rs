//! Clouds move with the wind at their height, and a change of weather does not displace them.

use glam::DVec3;
use welkin::{
    clouds::CloudModel,
    weather::{CloudKind, CloudLayer, LayerWind, Weather, Wind},
};

use crate::drawn::{BROKEN, Sky};

fn cumulus(own: Option<LayerWind>, wind: Wind) -> Weather {
    let layer = CloudLayer { wind: own, ..CloudLayer::of(CloudKind::Cumulus, 0.5, 1000.0) };
    Weather { clouds: vec![layer], wind, ..Weather::default() }
}

/// Shares of the sun's light at places along a line of 8 km.
fn shares(sky: &Sky, offset_m: DVec3, time_s: f64) -> Vec<f64> {
    let one = |i: i32| sky.context.sun_share(DVec3::X * f64::from(i) * 40.0 + offset_m, time_s).unwrap();
    (-100..100).map(one).collect()
}

fn off(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| (a - b).abs()).sum::<f64>() / a.len() as f64
}

#[test]
fn shadows_go_with_the_wind_of_their_layer_and_a_change_of_it_moves_none_at_once() {
    let mut sky = Sky::new(BROKEN, CloudModel::Volume);
    let south = LayerWind { speed_m_s: 20.0, from_deg: 180.0 };
    sky.context.set_weather(&cumulus(Some(south), Wind::of(5.0, 270.0)), 1.0, 0.0).unwrap();
    let (here, moved) = (shares(&sky, DVec3::ZERO, 1000.0), shares(&sky, DVec3::Y * 300.0, 1015.0));
    let (stayed, apart) = (off(&here, &shares(&sky, DVec3::ZERO, 1015.0)), off(&here, &moved));
    println!("15 s later: {apart:.3} apart where the wind has carried them, {stayed:.3} where they were");
    assert!(apart < 0.04 && stayed > 0.1, "{apart} {stayed}");
    // After a quarter of an hour of drift another wind blows from one moment to the next, of the layer or of the
    // weather.
    let before = shares(&sky, DVec3::ZERO, 1999.999);
    let north = LayerWind { speed_m_s: 60.0, from_deg: 0.0 };
    for (own, start_s) in [(Some(north), 2000.0), (None, 3000.0)] {
        let before = if start_s == 2000.0 { before.clone() } else { shares(&sky, DVec3::ZERO, start_s - 0.001) };
        sky.context.set_weather(&cumulus(own, Wind::of(12.0, 30.0)), start_s, 0.0).unwrap();
        let after = shares(&sky, DVec3::ZERO, start_s + 0.001);
        println!("at {start_s} s: {:.5} apart", off(&before, &after));
        assert!(off(&before, &after) < 0.002, "{start_s}");
    }
}

#[test]
fn longer_lived_and_wider_clouds_do_not_shift_those_that_are_there() {
    let mut sky = Sky::new(BROKEN, CloudModel::Volume);
    sky.context.set_weather(&cumulus(None, Wind::of(10.0, 270.0)), 1.0, 0.0).unwrap();
    let longer = |life_s| {
        let mut weather = cumulus(None, Wind::of(10.0, 270.0));
        weather.clouds[0].life_s = life_s;
        weather
    };
    sky.context.set_weather(&longer(Some(4000.0)), 5000.0, 0.0).unwrap();
    sky.context.set_weather(&longer(None), 7000.0, 0.0).unwrap();
    for start_s in [5000.0, 7000.0] {
        let apart = off(&shares(&sky, DVec3::ZERO, start_s - 0.001), &shares(&sky, DVec3::ZERO, start_s + 0.001));
        assert!(apart < 0.002, "{start_s}: {apart}");
    }
    // Wider clouds grow about the world's origin, however far the wind has carried them.
    let mut wider = cumulus(None, Wind::of(10.0, 270.0));
    wider.clouds[0].spacing_m = Some(1100.0);
    let at = |sky: &Sky, t: f64| sky.context.sun_share(DVec3::new(-700.0, 0.0, 0.0), t).unwrap();
    let steps = |sky: &Sky| {
        let all: Vec<f64> = (0..200).map(|i| at(sky, 9000.0 + f64::from(i))).collect();
        all.windows(2).map(|w| (w[1] - w[0]).abs()).sum::<f64>() / 200.0
    };
    let even = steps(&sky);
    sky.context.set_weather(&wider, 9000.0, 200.0).unwrap();
    let growing = steps(&sky);
    println!("change of light in a second: {even:.4} while nothing changes, {growing:.4} while clouds grow wider");
    assert!(growing < 2.0 * even + 0.01, "{even} {growing}");
}
