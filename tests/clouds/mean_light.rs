//! The mean light that queries return, against the mean of queries at many places: below, in and above layers.

use glam::DVec3;
use welkin::{
    clouds::CloudModel,
    context::GivenDirection,
    light::luminance,
    weather::{CloudKind, CloudLayer, Weather},
};
use welkin_support::seen_lux::seen_lux;

use crate::drawn::Sky;

/// Real reports of broken or overcast cloud below 1000 ft: those for which the queried sunlight was farthest from the
/// mean over places, and some of each kind.
const REPORTS: [&str; 16] = [
    "YTRE 092059Z AUTO 21003KT //// // BKN007 22/20 Q1016",
    "YPTN 092130Z AUTO 00000KT 9999 // BKN005 24/23 Q1008",
    "KFAT 111505Z 00000KT 1/4SM R29R/2200V3500FT FG BKN001 07/07 A3032",
    "KJVW 092235Z AUTO 00000KT 7SM BKN008 13/11 A3010",
    "KSCK 092240Z 15012KT 1 1/4SM -RA BR BKN008 OVC019 13/13 A2971",
    "KORS 111515Z AUTO 05007KT 020V080 5SM -RA BKN007 OVC017 04/03 A2985",
    "KNOW 111455Z AUTO 00000KT 10SM -RA BKN007 OVC011 05/05 A2982",
    "KPWT 111456Z AUTO 18005KT 6SM RA BR BKN004 OVC026 07/07 A2985",
    "KPAE 111440Z AUTO 13007KT 7SM -RA BKN008 BKN015 OVC041 07/07 A2987",
    "KGPI 092243Z 00000KT 1SM -RA BR BKN004 BKN029 OVC033 01/01 A2949",
    "KBLV 092246Z AUTO 13007KT 1 1/2SM BR OVC002 02/01 A3014",
    "KPOF 092245Z AUTO 35005KT 1/4SM FG OVC003 04/04 A3017",
    "KHKS 092243Z 05003KT 4SM BR OVC004 12/12 A3011",
    "KNSI 111436Z 28007KT 9SM BKN003 12/11 A3018",
    "KSMP 111456Z AUTO 00000KT 1/2SM SN FZFG VV002 M01/M02 A2982",
    "KPUC 092239Z AUTO 00000KT 1/4SM -SN FG OVC002 00/00 A2989",
];

/// One of many places at a height, each some clouds from the others.
fn place(i: usize, height_m: f64) -> DVec3 {
    DVec3::new(8087.0 * (i % 24) as f64, 6283.0 * (i / 24) as f64 + 331.0 * (i % 24) as f64, height_m)
}

/// Returns the share of direct light by the query at a height, and its mean over this many places.
fn queried_and_mean(sky: &Sky, height_m: f64, places: usize) -> (f64, f64) {
    let queried = sky.context.light_at(place(0, height_m), 0.0).unwrap().sun.direct_share;
    let share = |i: usize| sky.context.sun_share(place(i, height_m), 0.0).unwrap();
    (queried, (0..places).map(share).sum::<f64>() / places as f64)
}

fn set_sun(sky: &mut Sky, elevation_deg: f64) {
    sky.context.set_sun(Some(GivenDirection { azimuth_deg: 120.0, elevation_deg })).unwrap();
    sky.context.set_moon(Some(GivenDirection { azimuth_deg: 300.0, elevation_deg: -60.0 })).unwrap();
}

/// The report with which the fault was found: the query returned 31,550 lux of sunlight under eight oktas.
#[test]
fn queries_return_no_sunlight_under_a_low_overcast() {
    let mut sky = Sky::new("EGLL 121150Z 00000KT 9999 OVC001 10/09 Q1015", CloudModel::Volume);
    for elevation_deg in [0.5, 10.0, 40.0, 90.0] {
        set_sun(&mut sky, elevation_deg);
        let light = sky.context.light_at(DVec3::Z * 2.0, 0.0).unwrap();
        let lux = light.arriving.sun_lux[1];
        println!("sun at {elevation_deg} degrees: {lux:.2e} lux of sun, {:.0} in all", light.arriving.total_lux);
        assert!(lux < 1.0 && light.arriving.total_lux > 1.0, "{elevation_deg}: {lux}");
        assert!(sky.context.sun_share(DVec3::Z * 2.0, 0.0).unwrap() < 1e-4);
    }
}

#[test]
fn the_queried_sunlight_is_the_mean_over_places_at_all_heights() {
    let layer = CloudLayer::of;
    let skies = [
        vec![layer(CloudKind::Stratus, 1.0, 30.0)],
        vec![layer(CloudKind::Stratus, 0.75, 91.0)],
        vec![layer(CloudKind::Stratus, 0.9, 0.0)],
        vec![CloudLayer { thickness_m: Some(60.0), ..layer(CloudKind::Stratus, 1.0, 150.0) }],
        vec![layer(CloudKind::Cumulus, 0.4, 600.0), layer(CloudKind::Altocumulus, 0.6, 3000.0)],
        vec![layer(CloudKind::Stratus, 0.75, 30.0), layer(CloudKind::Stratocumulus, 1.0, 600.0)],
    ];
    let mut sky = Sky::new("EGLL 121150Z 00000KT 9999 OVC001 10/09 Q1015", CloudModel::Volume);
    let (mut squares, mut count) = (0.0, 0);
    for clouds in skies {
        sky.context.set_weather(&Weather { clouds: clouds.clone(), ..Weather::default() }, 0.0, 0.0).unwrap();
        let c = sky.context.conditions_at(DVec3::ZERO, 0.0).unwrap();
        let slabs: Vec<_> = c.clouds.iter().filter(|slab| slab.cover > 0.0).collect();
        let (base_m, top_m) = (slabs[0].base_m, slabs[slabs.len() - 1].top_m());
        let within = [0.3, 0.7].map(|share| base_m + share * slabs[0].thickness_m);
        for elevation_deg in [-2.0, 0.5, 4.0, 12.0, 40.0, 90.0] {
            set_sun(&mut sky, elevation_deg);
            for height_m in [0.0, base_m, within[0], within[1], slabs[0].top_m(), top_m + 1.0] {
                let (queried, mean) = queried_and_mean(&sky, height_m, 192);
                let at =
                    format!("{clouds:?}: sun at {elevation_deg}, {height_m} m: queried {queried:.3}, mean {mean:.3}");
                assert!((queried - mean).abs() < 0.2, "{at}");
                (squares, count) = (squares + (queried - mean) * (queried - mean), count + 1);
            }
            assert_eq!(queried_and_mean(&sky, top_m + 1.0, 8), (1.0, 1.0));
        }
    }
    let rms = (squares / f64::from(count)).sqrt();
    println!("the queried share of the sun is off by {rms:.3} (rms)");
    assert!(rms < 0.05, "{rms}");
}

#[test]
fn the_queried_sunlight_is_the_mean_under_real_reports_of_low_cloud() {
    let mut sky = Sky::new(REPORTS[0], CloudModel::Volume);
    let mut most = (0.0, String::new());
    for report in REPORTS {
        sky.context.set_weather(&Weather::from_metar(report).unwrap().weather, 0.0, 0.0).unwrap();
        let c = sky.context.conditions_at(DVec3::ZERO, 0.0).unwrap();
        let slab = c.clouds.iter().find(|slab| slab.cover > 0.0).unwrap();
        for elevation_deg in [3.0, 12.0, 30.0, 90.0] {
            set_sun(&mut sky, elevation_deg);
            for height_m in [2.0, slab.base_m + 0.3 * slab.thickness_m, slab.base_m + 0.7 * slab.thickness_m] {
                let (queried, mean) = queried_and_mean(&sky, height_m, 144);
                if (queried - mean).abs() > most.0 {
                    most = (
                        (queried - mean).abs(),
                        format!("{report}: {elevation_deg}, {height_m} m: {queried:.3} {mean:.3}"),
                    );
                }
            }
        }
    }
    println!("most off: {:.3}, {}", most.0, most.1);
    assert!(most.0 < 0.2, "{most:?}");
}

/// Compares the queried light on level ground with the sum of two means over places: the light of the queried radiance
/// of the sky, and the sunlight.
#[test]
fn the_queried_light_is_that_of_sky_and_sun_together() {
    let mut sky = Sky::new("EGLL 121150Z 00000KT 9999 OVC001 10/09 Q1015", CloudModel::Volume);
    for (cover, base_m, heights_m) in
        [(1.0, 30.0, [2.0, 100.0, 200.0, 400.0]), (0.75, 91.0, [2.0, 160.0, 250.0, 500.0])]
    {
        let clouds = vec![CloudLayer::of(CloudKind::Stratus, cover, base_m)];
        sky.context.set_weather(&Weather { clouds, ..Weather::default() }, 0.0, 0.0).unwrap();
        for elevation_deg in [15.0, 45.0] {
            set_sun(&mut sky, elevation_deg);
            for height_m in heights_m {
                let light = sky.context.light_at(place(0, height_m), 0.0).unwrap();
                let whole =
                    luminance(&light.arriving.sun_lux) / light.sun.direct_share.max(1e-300) * light.sun.direction.z;
                // The sun's light changes from place to place more than the sky's does, and costs less to query.
                let (_, share) = queried_and_mean(&sky, height_m, 192);
                let places = if height_m > base_m + 300.0 { 1 } else { 10 };
                let seen = (0..places).map(|i| seen_lux(&sky.context, place(17 * i, height_m), (4, 8))).sum::<f64>();
                let mean = seen / places as f64 + share * whole;
                let off = light.arriving.total_lux / mean - 1.0;
                println!(
                    "cover {cover}, sun at {elevation_deg}, {height_m} m: queried {:.0} lux, seen {mean:.0}, off by {off:+.2}",
                    light.arriving.total_lux
                );
                assert!(off.abs() < 0.2, "{cover}, {elevation_deg}, {height_m} m: {off}");
            }
        }
    }
}

/// A camera that climbs through a deck sees no step: neither in the queried light nor in the exposure.
#[test]
fn a_climb_through_a_deck_changes_light_and_exposure_steadily() {
    let mut sky = Sky::new("EGLL 121150Z 00000KT 9999 OVC001 10/09 Q1015", CloudModel::Volume);
    for (cover, elevation_deg) in [(1.0, 40.0), (1.0, 3.0), (0.75, 40.0), (0.75, -3.0)] {
        let clouds =
            vec![CloudLayer::of(CloudKind::Stratus, cover, 30.0), CloudLayer::of(CloudKind::Stratus, 0.6, 900.0)];
        sky.context.set_weather(&Weather { clouds, ..Weather::default() }, 0.0, 0.0).unwrap();
        set_sun(&mut sky, elevation_deg);
        let (mut last, mut most) = (None::<[f64; 4]>, 0.0f64);
        for i in 0..2800 {
            let scene = sky.context.scene_at(DVec3::Z * (0.5 * f64::from(i)), 0.0).unwrap();
            let light = &scene.ground;
            let now = [light.total_lux, light.adaptation_cd_m2, luminance(&light.sky_lux), 1.0 + scene.deck_cover];
            if let Some(last) = last {
                most = now.iter().zip(last).map(|(now, last)| (now / last).ln().abs()).fold(most, f64::max);
            }
            last = Some(now);
        }
        println!("cover {cover}, sun at {elevation_deg}: half a metre changes light by {most:.3} at most");
        assert!(most < 0.05, "{cover}, {elevation_deg}: {most}");
    }
}

/// Where the sun lights the clouds above a place, the sun lights the place, however much of its light the clouds
/// absorb. A high moon by day does not replace the sun, even if a few lux of moonlight pass where no light of the low
/// sun does.
#[test]
fn by_day_clouds_are_not_lit_by_the_moon() {
    let mut sky = Sky::new("EGLL 121150Z 00000KT 9999 OVC001 10/09 Q1015", CloudModel::Volume);
    sky.context.set_sun(Some(GivenDirection { azimuth_deg: 120.0, elevation_deg: 8.0 })).unwrap();
    let mut seen = |moon_deg: f64| {
        sky.context.set_moon(Some(GivenDirection { azimuth_deg: 200.0, elevation_deg: moon_deg })).unwrap();
        let up = sky.context.sky_radiance(DVec3::Z * 2.0, &[DVec3::Z], 0.0).unwrap();
        luminance(&up[0])
    };
    let (without, with) = (seen(-60.0), seen(80.0));
    println!("the deck straight up: {without:.0} cd/m^2, with the moon overhead {with:.0}");
    assert!((with / without - 1.0).abs() < 0.02, "{without} {with}");
}
