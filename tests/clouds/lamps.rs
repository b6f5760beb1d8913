//! Clouds in the light of the host's lamps and of flashes.

use glam::DVec3;
use welkin::{
    clouds::{CloudModel, CloudSettings},
    context::GivenDirection,
    frame::FrameFlags,
    light::luminance,
    lightning::{FlashKind, FlashTrigger, LightningSettings},
    rain::{AreaRain, AreaShape, RainArea},
    scene::HostLight,
    weather::{CloudKind, CloudLayer, Weather},
};

use crate::drawn::{BROKEN, Sky};

/// A sky at night, without a moon.
fn night(clouds: Vec<CloudLayer>) -> Sky {
    let mut sky = Sky::new(BROKEN, CloudModel::Volume);
    let below = Some(GivenDirection { azimuth_deg: 120.0, elevation_deg: -40.0 });
    sky.context.set_sun(below).unwrap();
    sky.context.set_moon(below).unwrap();
    sky.context.set_weather(&Weather { clouds, ..Weather::default() }, 0.0, 0.0).unwrap();
    sky.context.set_lightning(LightningSettings { flashes_per_minute: Some(0.0), ..Default::default() }).unwrap();
    sky
}

fn stratus() -> Vec<CloudLayer> {
    vec![CloudLayer::of(CloudKind::Stratus, 1.0, 150.0)]
}

fn lamp(position_m: DVec3, direction: DVec3, [inner_deg, outer_deg]: [f64; 2]) -> HostLight {
    HostLight { position_m, direction, intensity_cd: [1e6; 3], inner_deg, outer_deg }
}

const BULB: [f64; 2] = [180.0; 2];

/// Returns the luminance that a lamp adds to a picture, cd/m^2.
fn added(sky: &mut Sky, lamp: &HostLight, forward: DVec3, height_m: f64) -> Vec<f64> {
    let mut look = |lamps: &[HostLight]| {
        sky.context.set_lights(lamps).unwrap();
        sky.look(forward, height_m, None, FrameFlags::NO_HISTORY)
    };
    let [dark, lit] = [look(&[]), look(std::slice::from_ref(lamp))];
    lit.iter().zip(&dark).map(|(a, b)| luminance(a) - luminance(b)).collect()
}

#[test]
fn a_bulb_under_a_low_ceiling_lights_it_above_itself_most() {
    let mut sky = night(stratus());
    let place = DVec3::new(0.0, 100.0, 3.0);
    let seen = added(&mut sky, &lamp(place, DVec3::Z, BULB), DVec3::new(0.0, 1.0, 0.8), 2.0);
    let most = seen.iter().fold(0.0, |most: f64, v| most.max(*v));
    // A Lambert surface at the base would send I rho / (pi h^2); in cloud light comes back from further up, spread out.
    let sends = |albedo: f64| 1e6 * albedo / (std::f64::consts::PI * 147.0 * 147.0);
    println!("{most:.2} cd/m^2 at most, {:.2} to {:.2} off a surface", sends(0.08), sends(0.5));
    assert!((sends(0.08)..sends(0.5)).contains(&most), "{most}");
    let far = added(&mut sky, &lamp(place - DVec3::Y * 2000.0, DVec3::Z, BULB), DVec3::new(0.0, 1.0, 0.8), 2.0);
    assert!(far.iter().all(|v| *v < 0.02 * most), "two kilometres off");
}

/// Steps of a ray are longer than a beam is wide; their positions must not be visible.
#[test]
fn a_beam_in_cloud_does_not_show_the_steps_of_rays() {
    let mut sky = night(stratus());
    let lamp = lamp(DVec3::new(3.0, 1.0, 349.0), DVec3::new(0.1, 1.0, 0.0), [5.0, 9.0]);
    let [coarse, fine] = [1.0, 16.0].map(|fineness| {
        sky.view.set_clouds(CloudSettings { fineness, ..CloudSettings::default() }).unwrap();
        added(&mut sky, &lamp, DVec3::Y, 350.0)
    });
    let most = fine.iter().fold(0.0, |most: f64, v| most.max(*v));
    let lit = fine.iter().filter(|v| **v > 0.2 * most).count();
    let in_beam = coarse.iter().zip(&fine).filter(|(_, b)| **b > 0.1 * most);
    let mut off: Vec<f64> = in_beam.map(|(a, b)| (a / b - 1.0).abs()).collect();
    off.sort_by(f64::total_cmp);
    let off = off[off.len() * 95 / 100];
    println!("{lit} of {} pixels in the beam, off by {off:.3} at 95 % in sixteen times as long steps", fine.len());
    assert!((20..fine.len() / 4).contains(&lit), "{lit}");
    assert!(off < 0.15, "{off}");
}

#[test]
fn lamps_that_clouds_would_not_show_cost_nothing() {
    let mut sky = night(stratus());
    let passes = |sky: &mut Sky, lamps: &[HostLight]| {
        sky.context.set_lights(lamps).unwrap();
        sky.look(DVec3::new(0.0, 1.0, 0.5), 2.0, None, FrameFlags::NO_HISTORY);
        sky.view.report().passes
    };
    let none = passes(&mut sky, &[]);
    let down = lamp(DVec3::new(0.0, 50.0, 10.0), DVec3::NEG_Z, [30.0, 60.0]);
    let up = lamp(DVec3::new(0.0, 50.0, 10.0), DVec3::Z, [30.0, 60.0]);
    let faint = HostLight { intensity_cd: [1e-3; 3], ..up };
    assert_eq!([passes(&mut sky, &[down]), passes(&mut sky, &[faint])], [none; 2]);
    assert_eq!(passes(&mut sky, &[up]), none + 1);
    // By day.
    sky.context.set_sun(Some(GivenDirection { azimuth_deg: 120.0, elevation_deg: 40.0 })).unwrap();
    let day = passes(&mut sky, &[]);
    assert_eq!(passes(&mut sky, &[HostLight { intensity_cd: [1e4; 3], ..up }]), day);
}

/// A cell of cumulonimbus over a rain area glows where a flash is in it, and hides the channel.
#[test]
fn a_flash_inside_a_storms_cell_makes_it_glow() {
    let mut sky = night(vec![]);
    let middle = DVec3::new(0.0, 16e3, 0.0);
    let area = RainArea {
        center_m: middle.to_array(),
        shape: AreaShape::Ellipse([5500.0, 4500.0]),
        rim_m: 1500.0,
        rate_mm_h: 40.0,
        top_m: 1500.0,
        kind: AreaRain::Showers,
        ..RainArea::default()
    };
    sky.context.set_rain_areas(&[area]).unwrap();
    let trigger =
        FlashTrigger { time_s: 1.0, position: middle, kind: FlashKind::InCloud, peak_ka: Some(30.0), strokes: Some(3) };
    sky.context.trigger_flash(&trigger).unwrap();
    let mut at = |time_s: f64| {
        sky.context.update(time_s).unwrap();
        let seen = sky.look(DVec3::new(0.0, 1.0, 0.3), 2.0, None, FrameFlags::NO_HISTORY);
        seen.iter().map(luminance).collect::<Vec<f64>>()
    };
    let (before, during) = (at(0.5), at(1.004));
    let mut glow: Vec<f64> = during.iter().zip(&before).map(|(a, b)| a - b).collect();
    glow.sort_by(f64::total_cmp);
    let [dark, half, most] = [10, 50, 99].map(|percent| glow[glow.len() * percent / 100]);
    println!("glow {dark:.1e} cd/m^2 beside the cell, {half:.2} in the median, {most:.1} at 99 %");
    assert!(most > 5.0 && half < 0.2 * most && dark < 1e-3 * most, "{dark} {half} {most}");
    // A channel in the open would outshine its cloud by far.
    let brightest = glow[glow.len() - 1];
    assert!(brightest < 8.0 * most, "{brightest}");
}
