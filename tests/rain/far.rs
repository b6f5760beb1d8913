//! The weather's own rain beyond the drops: curtains in its veil, and no seam between drops, cones and veil.

use glam::DVec3;
use welkin::{
    frame::Stages,
    rain::{RainModel, RainSettings},
    weather::{CloudKind, CloudLayer, Weather},
};
use welkin_support::rain_scene::{Host, rain, upright};

use crate::pictures::save;

/// Rain under a closed deck.
fn overcast(rate_mm_h: f64, wind_m_s: f64, visibility_m: f64) -> Weather {
    let clouds = vec![CloudLayer::of(CloudKind::Nimbostratus, 1.0, 600.0)];
    Weather { clouds, visibility_m, ..rain(rate_mm_h, wind_m_s) }
}

/// Dark walls from 100 m to 5 km, one behind the other.
fn walls() -> Vec<welkin::rain::Shelter> {
    let at = [
        (-70.0, 100.0, 30.0),
        (110.0, 300.0, 90.0),
        (-250.0, 800.0, 300.0),
        (420.0, 2000.0, 560.0),
        (-600.0, 5000.0, 590.0),
    ];
    at.into_iter().map(|(x, y, h)| upright([x, y, 0.5 * h], [0.35 * y, 0.05 * y, 0.5 * h])).collect()
}

#[test]
fn pictures_of_curtains_from_100_m_to_5_km() {
    let mut host = Host::new((640, 360));
    host.boxes = walls();
    host.look(DVec3::new(0.0, 0.0, 8.0), DVec3::new(0.0, 1.0, 0.14));
    let mut t = 0.0;
    for (name, rate, wind, visibility_m) in
        [("steady", 5.0, 7.0, 3000.0), ("showers", 12.0, 9.0, 3000.0), ("cloudburst", 60.0, 12.0, 900.0)]
    {
        t += 100.0;
        let mut weather = overcast(rate, wind, visibility_m);
        weather.precipitation.showers = name != "steady";
        host.context.set_weather(&weather, t, 0.0).unwrap();
        for i in 0..3 {
            host.context.update(t + 1.0 + 4.0 * f64::from(i)).unwrap();
            let lit = host.context.light_at(host.camera.position, host.context.time_s()).unwrap().arriving.sky_lux;
            host.draw(|_, n| lit.map(|e| e / std::f64::consts::PI * if n.z > 0.9 { 0.11 } else { 0.04 }));
            host.record(Stages::ALL).unwrap();
            save(&host, &format!("far_{name}_{i}.png"));
        }
    }
}

/// Brightness of a white board less that of a black one at places of the picture, both `distance` m away.
fn contrasts(host: &mut Host, distance: f64) -> Vec<f64> {
    host.boxes = vec![upright([0.0, distance + 1.0, 0.0], [4.0 * distance, 1.0, 4.0 * distance])];
    let mut shown = |wall: f64| {
        host.draw(|_, _| [wall; 3]);
        host.record(Stages::PREPARE.with(Stages::MEDIUM)).unwrap();
        host.pixels()
    };
    let (white, black) = (shown(10_000.0), shown(0.0));
    white.iter().zip(&black).map(|(w, b)| f64::from(w[1] - b[1])).collect()
}

/// The drawn rain has a pattern, and its mean contrast over some minutes is the one that the query returns.
#[test]
fn contrasts_are_on_the_mean_what_the_query_says() {
    let mut host = Host::new((64, 36));
    let eye = DVec3::new(0.0, 0.0, 8.0);
    host.look(eye, DVec3::Y);
    // The veil alone, without drops in front of the boards.
    host.view.set_rain(RainSettings { model: RainModel::Veil, ..RainSettings::default() }).unwrap();
    let mut clear = Vec::new();
    let mut weather = Weather { visibility_m: 1e5, ..overcast(0.0, 9.0, 1e5) };
    host.context.set_weather(&weather, 0.0, 0.0).unwrap();
    host.context.update(0.1).unwrap();
    let distances = [20.0, 300.0, 1500.0, 3000.0];
    for d in distances {
        clear.push((
            contrasts(&mut host, d),
            host.context.between(eye, eye + DVec3::Y * d, 0.1).unwrap().transmittance[1],
        ));
    }
    weather = overcast(12.0, 9.0, 3000.0);
    weather.precipitation.showers = true;
    host.context.set_weather(&weather, 1.0, 0.0).unwrap();
    for (d, (clear, through_clear)) in distances.into_iter().zip(clear) {
        let (mut sum, mut spread, mut count) = (0.0, 0.0f64, 0.0);
        for i in 0..24 {
            host.context.update(2.0 + 2000.0 * d + 41.0 * f64::from(i)).unwrap();
            let rainy = contrasts(&mut host, d);
            // In the middle of the picture the distance to the board is that to its plane; just above the horizon no
            // ground hides it.
            let at = |x: usize| rainy[17 * 64 + x] / clear[17 * 64 + x];
            for x in 20..44 {
                sum += at(x);
                count += 1.0;
            }
            spread = spread.max((20..44).map(at).fold(0.0, f64::max) / (20..44).map(at).fold(1.0, f64::min));
        }
        let time = host.context.time_s();
        let want = host.context.between(eye, eye + DVec3::Y * d, time).unwrap().transmittance[1] / through_clear;
        let got = sum / count;
        println!("{d} m: {got} of {want}, within a picture up to {spread}");
        assert!((got / want - 1.0).abs() < 0.08, "{d} m: {got}, want {want}");
        assert!(d > 100.0 || (got / want - 1.0).abs() < 3e-3, "{d} m: {got}, want {want}");
        assert!(if d < 100.0 { spread < 1.01 } else { spread > 1.04 }, "{d} m: {spread}");
    }
}

/// Finds the shift in pixels at which two rows of the same rain, two seconds apart, agree best. It is the displacement
/// by the wind, at an early and at a late time.
#[test]
fn curtains_go_with_the_wind() {
    let mut host = Host::new((256, 144));
    host.look(DVec3::new(0.0, 0.0, 8.0), DVec3::Y);
    let mut weather = overcast(12.0, 10.0, 6000.0);
    weather.precipitation.showers = true;
    weather.wind.gust_m_s = None;
    host.context.set_weather(&weather, 0.0, 0.0).unwrap();
    let d = 600.0;
    for start in [20.0, 1e6] {
        host.context.update(start).unwrap();
        let before = contrasts(&mut host, d);
        let from = host.context.wind_displacement(start).unwrap();
        host.context.update(start + 2.0).unwrap();
        let after = contrasts(&mut host, d);
        let moved = host.context.wind_displacement(start + 2.0).unwrap() - from;
        let row = |p: &[f64]| -> Vec<f64> {
            let row = &p[70 * 256..71 * 256];
            let mean = row.iter().sum::<f64>() / 256.0;
            row.iter().map(|v| v / mean - 1.0).collect()
        };
        let (before, after) = (row(&before), row(&after));
        let alike = |shift: i32| {
            let at = |i: i32| before[(i - shift) as usize] * after[i as usize];
            (40..216).map(at).sum::<f64>() / (40..216).map(|i| before[(i - shift) as usize].powi(2)).sum::<f64>().sqrt()
        };
        let best = (-30..=30).max_by(|a, b| alike(*a).total_cmp(&alike(*b))).unwrap();
        // A pixel is 4 m wide at the board, less in front of it.
        println!("{start}: moved {moved}, most alike {best} pixels aside");
        assert!((moved.x - 20.0).abs() < 5.0 && (4..=16).contains(&best), "{start}: {moved} m, {best} pixels");
    }
}

/// Measures light and contrast at growing distances, through shell 0, cones and veil to where curtains begin, by boards
/// that fill the picture.
#[test]
fn no_ring_shows_where_drops_give_way_to_cones_and_those_to_the_veil() {
    for (rate, visibility_m) in [(5.0, 3000.0), (40.0, 1200.0)] {
        let mut host = Host::new((160, 90));
        host.look(DVec3::new(0.0, 0.0, 400.0), DVec3::Y);
        // The wall emits no light, so that the picture shows the rain alone.
        host.context.set_weather(&overcast(rate, 4.0, visibility_m), 0.0, 0.0).unwrap();
        let from = 10.0;
        host.context.update(from).unwrap();
        let start = host.context.save().unwrap();
        let mut rings = Vec::new();
        let steps = 56;
        for i in 0..=steps {
            let d = 300f64.powf(f64::from(i) / f64::from(steps));
            host.boxes = vec![upright([0.0, d + 0.5, 400.0], [4.0 * d, 0.5, 4.0 * d])];
            let (mut sum, mut square, mut count) = (0.0, 0.0, 0.0);
            host.context.load(&start).unwrap();
            for k in 0..5 {
                // The same drops and curtains at each distance.
                host.context.update(from + f64::from(k)).unwrap();
                host.draw(|_, _| [0.0; 3]);
                host.record(Stages::PREPARE.with(Stages::MEDIUM).with(Stages::PARTICLES)).unwrap();
                let p = host.pixels();
                for y in 20..70usize {
                    for x in 40..120usize {
                        let v = f64::from(p[y * 160 + x][1]);
                        let right = f64::from(p[y * 160 + x + 1][1]);
                        (sum, square, count) = (sum + v, square + 0.5 * (v - right).powi(2), count + 1.0);
                    }
                }
            }
            rings.push((d, sum / count, (square / count).sqrt()));
        }
        for (d, mean, contrast) in &rings {
            println!("{rate} mm/h {d:.2} m: {mean:.2} cd/m2, {:.3} a metre, contrast {contrast:.3}", mean / d);
        }
        // Between neighbouring distances neither light per metre nor contrast jumps, whichever model draws it.
        let [mut light, mut contrast] = [(0.0f64, 0.0); 2];
        for w in rings.windows(2) {
            let [(d0, m0, c0), (d1, m1, c1)] = [w[0], w[1]];
            let of = |most: &mut (f64, f64), change: f64| {
                if change > most.0 {
                    *most = (change, d1);
                }
            };
            if d1 > 1.5 {
                of(&mut light, ((m1 / d1) / (m0 / d0)).ln().abs());
                of(&mut contrast, (c1 / c0).ln().abs());
            }
        }
        // Light that one more metre adds, in the range of drops, of cones and of the veil.
        let first_from = |d: f64| *rings.iter().find(|r| r.0 >= d).unwrap();
        let slope = |a: f64, b: f64| {
            let [(a, before, _), (b, after, _)] = [first_from(a), first_from(b)];
            (after - before) / (b - a)
        };
        let parts = [slope(1.0, 1.8), slope(2.0, 6.0), slope(6.0, 13.5), slope(16.0, 28.0)];
        let jump = parts.windows(2).map(|w| (w[1] / w[0]).ln().abs()).fold(0.0, f64::max);
        let at = |d: f64| first_from(d).2;
        let beyond = at(60.0) / at(12.0);
        println!(
            "{rate} mm/h: light a metre changes by at most {light:?}, contrast by {contrast:?} from ring to ring; \
             a metre of drops, cones and veil adds {parts:?}; contrast at 60 m {beyond} of that at 12 m"
        );
        assert!(light.0 < 0.04 && contrast.0 < 0.08, "{rate} mm/h: light {light:?}, contrast {contrast:?}");
        assert!(jump < 0.16 && (0.75..1.1).contains(&beyond), "{rate} mm/h: {parts:?}, {beyond}");
    }
}
