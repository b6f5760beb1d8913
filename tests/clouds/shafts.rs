//! Shafts of light between the shadows of clouds.

use std::f64::consts::PI;

use glam::DVec3;
use welkin::{
    clouds::{CloudModel, CloudSettings},
    context::GivenDirection,
    frame::FrameFlags,
    scene::Camera,
};

use crate::{
    drawn::{SIZE, Sky},
    shadows::over_host,
};

const HAZY: &str = "LOWI 121150Z 00000KT 6000 HZ SCT070 18/12 Q1015";
const EYE: DVec3 = DVec3::new(0.0, 0.0, 30.0);
/// Vertical field of view, rad.
const FOV: f64 = 0.3;

fn sky(report: &str) -> Sky {
    let mut sky = Sky::new(report, CloudModel::Volume);
    sky.context.set_sun(Some(GivenDirection { azimuth_deg: 300.0, elevation_deg: 25.0 })).unwrap();
    sky
}

/// Green of a picture towards the north-west before a black wall, or before nothing.
fn take(sky: &mut Sky, shafts: bool, wall_m: Option<f64>) -> Vec<f64> {
    sky.view.set_clouds(CloudSettings { shafts, ..CloudSettings::default() }).unwrap();
    over_host(sky, camera(), (wall_m.unwrap_or(f64::INFINITY), 0.0), FrameFlags::NO_HISTORY)
}

fn forward() -> DVec3 {
    DVec3::new(-1.0, 1.0, 0.1).normalize()
}

fn camera() -> Camera {
    Camera::look_to(EYE, forward(), DVec3::Z, FOV, 16.0 / 9.0, 0.1)
}

/// Returns the ray through a pixel, of length 1 along the camera's axis.
fn way(i: usize) -> DVec3 {
    let (x, y) = (i as u32 % SIZE.0, i as u32 / SIZE.0);
    let at = |p: u32, of: u32| (f64::from(p) + 0.5) / f64::from(of) * 2.0 - 1.0;
    let (half, right) = ((0.5 * FOV).tan(), forward().cross(DVec3::Z).normalize());
    forward() + right * (at(x, SIZE.0) * half * 16.0 / 9.0) - right.cross(forward()) * (at(y, SIZE.1) * half)
}

/// Phase function of air, 1/sr, at `nu`, the cosine of the scattering angle: of gas (Rayleigh) and of haze (Cornette
/// and Shanks 1992, asymmetry 0.76), which together have this extinction, 1/m.
fn phase(nu: f64, extinction: f64) -> f64 {
    const G: f64 = 0.76;
    let gas = 1.3e-5;
    let haze = 0.95 * (extinction - gas);
    let even = 1.0 + nu * nu;
    let of_haze = 3.0 / (8.0 * PI) * (1.0 - G * G) / (2.0 + G * G) * even / (1.0 + G * G - 2.0 * G * nu).powf(1.5);
    (gas * 3.0 / (16.0 * PI) * even + haze * of_haze) / (gas + haze)
}

#[test]
fn the_air_before_a_wall_is_lit_as_the_places_along_the_way() {
    let mut sky = sky(HAZY);
    const WALL_M: f64 = 4000.0;
    let (with, without) = (take(&mut sky, true, Some(WALL_M)), take(&mut sky, false, Some(WALL_M)));
    let light = sky.context.light_at(EYE, 0.0).unwrap();
    let mean = light.sun.direct_share;
    // Light that a unit of air scatters: of the sun's light between clouds, and of the sky's light from all around.
    let facing = light.arriving.sun_lux[1] / mean;
    let around = 1.15 / (2.0 * PI) * light.arriving.sky_lux[1];
    let extinction = -sky.context.between(EYE, EYE + DVec3::X * 1e3, 0.0).unwrap().transmittance[1].ln() / 1e3;
    let strength = |i: usize| {
        let lit = facing * phase(way(i).normalize().dot(light.sun.direction), extinction);
        lit / (mean * lit + around)
    };
    let (mut off, mut wanted) = (Vec::new(), Vec::new());
    for i in (0..with.len()).step_by(23) {
        let place = |k: u32| EYE + way(i) * (WALL_M * f64::from(k) / 60.0);
        let through =
            |k: u32| if k == 0 { 1.0 } else { sky.context.between(EYE, place(k), 0.0).unwrap().transmittance[1] };
        let shares = (0..20).map(|k| {
            let share = [1, 2].map(|j| sky.context.sun_share(place(3 * k + j), 0.0).unwrap());
            (through(3 * k) - through(3 * k + 3)) * (0.5 * (share[0] + share[1]) - light.sun.direct_share)
        });
        let want = shares.sum::<f64>() / (1.0 - through(60));
        let got = (with[i] / without[i] - 1.0) / strength(i);
        off.push((got - want).abs());
        wanted.push(want);
    }
    off.sort_by(f64::total_cmp);
    wanted.sort_by(f64::total_cmp);
    let (half, most) = (off[off.len() / 2], off[off.len() * 95 / 100]);
    let [low, high] = [5, 95].map(|percent| wanted[wanted.len() * percent / 100]);
    println!(
        "shares of direct light between {low:+.2} and {high:+.2} of the mean: off by {half:.3} in the median, {most:.3} at 95 %"
    );
    assert!(high - low > 0.2, "there are shafts: {low} {high}");
    assert!(half < 0.02 && most < 0.06, "{half} {most}");
}

/// Without gaps between clouds there are no shafts.
#[test]
fn shafts_stand_before_the_sky_where_clouds_leave_gaps() {
    let mut broken = sky(HAZY);
    let (with, without) = (take(&mut broken, true, None), take(&mut broken, false, None));
    let off = |row: u32| {
        let row = (row * SIZE.0) as usize..((row + 1) * SIZE.0) as usize;
        row.clone().map(|i| (with[i] / without[i] - 1.0).abs()).sum::<f64>() / row.len() as f64
    };
    let [high, low] = [0, SIZE.1 * 3 / 5].map(off);
    println!("light of the sky changes by {high:.3} high up and by {low:.3} near the horizon");
    assert!(low > 0.05 && high > 0.05 && with.iter().all(|light| *light > 0.0), "{high} {low}");
    for report in ["LOWI 121150Z 00000KT 6000 HZ 18/12 Q1015", "LOWI 121150Z 00000KT 6000 HZ OVC045 18/12 Q1015"] {
        let mut even = sky(report);
        assert!(take(&mut even, true, Some(4000.0)) == take(&mut even, false, Some(4000.0)), "{report}");
    }
}
