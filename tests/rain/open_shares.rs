//! Shelter of the cones is evaluated on a coarse grid, which each pixel looks up: checked against rays through each
//! pixel and those round it.

use glam::{DVec2, DVec3};
use welkin::{
    gpu::{Device, DeviceOptions},
    rain::{
        OccluderMap, RainModel, RainSettings, Shelter, Taken,
        cones::{BANDS_M, CONES},
        shelter::sheltered,
    },
};
use welkin_support::rain_scene::{Host, rain};

use crate::{
    drops::{classes, night},
    shelter::{map, standing, surely, through},
};

/// Cells along the picture's sides, which are 400 and 200 pixels long.
const CELLS: f64 = 40.0;
const SIZE: (u32, u32) = (400, 200);

/// Cones alone, with so many streaks that each pixel shows some.
fn cones(device: &std::sync::Arc<Device>) -> Host {
    let mut host = night(Host::on(device.clone(), SIZE));
    let many = RainSettings { model: RainModel::Cones, most_drops: Some(8_000_000), ..RainSettings::default() };
    host.view.set_rain(many).unwrap();
    host
}

/// Velocity of the mean drop, weighted by the drops' cover.
fn mean_fall(host: &Host, rate: f64, wind: f64) -> DVec3 {
    let (mut sum, mut discs) = (0.0, 0.0);
    for (d, v, flux) in classes(&rain(rate, wind), u32::MAX).flux.into_iter().filter(|c| c.1 > 0.0) {
        (sum, discs) = (sum + flux * d * d, discs + flux / v * d * d);
    }
    host.context.carrying_wind(host.context.time_s()).unwrap() - DVec3::Z * (sum / discs)
}

/// Whether all places are dry (`true`) or all in the rain (`false`), from the camera to an eighth of a band behind the
/// surface in a pixel, on all rays up to three cells from the pixel's. `None` where places differ, or points within
/// `slack_m` of one.
fn agreed(host: &Host, boxes: &[Shelter], fall: DVec3, ndc: DVec2, slack_m: f64) -> Option<bool> {
    let far = (host.cast(ndc).unwrap().0.length() * 1.125 + 0.21).min(BANDS_M[CONES]);
    let mut first = None;
    for i in 0..49 {
        let off = DVec2::new(f64::from(i % 7) - 3.0, f64::from(i / 7) - 3.0) * (2.0 / CELLS);
        let d = host.rays().view_ray(ndc + off).direction;
        for k in 0..48 {
            let p = host.camera.position + d * (BANDS_M[0] * (far / BANDS_M[0]).powf(f64::from(k) / 47.0));
            let dry = if slack_m > 0.0 {
                surely(boxes, p, fall, slack_m)?
            } else {
                boxes.iter().any(|b| sheltered(b, p, fall))
            };
            if *first.get_or_insert(dry) != dry {
                return None;
            }
        }
    }
    first
}

#[test]
fn away_from_edges_the_grid_says_what_rays_say_of_each_pixel() {
    let boxes = &standing()[..7];
    for (backends, mapped) in [(DeviceOptions::default().backends, false), (wgpu::Backends::GL, true)] {
        let device = Device::headless(&DeviceOptions { backends, ..DeviceOptions::default() }).unwrap();
        let mut host = cones(&device);
        let slack = if mapped { 2.0 * (40.0 / 512.0) } else { 0.0 };
        let (mut dry, mut open, mut between) = (0, 0, 0);
        for (i, wind) in [0.0, 6.0, 15.0].into_iter().enumerate() {
            let t = 10.0 * (i + 1) as f64;
            host.context.set_weather(&rain(300.0, wind), t, 0.0).unwrap();
            host.context.update(t + 3.0).unwrap();
            let fall = mean_fall(&host, 300.0, wind);
            let f = fall.normalize();
            let taken = Taken::parallel(DVec3::new(0.0, 4.0, 0.0) - f * 60.0, f, [20.0; 2], 120.0);
            let texture = map(&host, boxes, &taken, (512, 512));
            for (eye, to) in [
                (DVec3::new(0.5, -4.0, 1.7), DVec3::new(0.0, 13.0, 1.0)),
                (DVec3::new(0.0, 8.0, 2.0), DVec3::new(1.0, 2.0, 0.3)),
                (DVec3::new(6.0, 1.0, 2.0), DVec3::new(0.1, -1.0, 0.2)),
            ] {
                host.look(eye, to);
                // The projection is off its axis.
                host.camera.projection.z_axis.x += 0.2;
                host.context.set_shelters(&[]).unwrap();
                host.context.set_occluder_maps(&[]).unwrap();
                let bare = through(&mut host, boxes);
                if mapped {
                    host.context.set_occluder_maps(&[OccluderMap { depth: &texture, taken }]).unwrap();
                } else {
                    host.context.set_shelters(boxes).unwrap();
                }
                let seen = through(&mut host, boxes);
                for k in (0..seen.len()).step_by(83) {
                    let at = DVec2::new((k as u32 % SIZE.0) as f64 + 0.5, (k as u32 / SIZE.0) as f64 + 0.5);
                    let ndc = DVec2::new(at.x / 200.0 - 1.0, 1.0 - at.y / 100.0);
                    let what = format!("{backends:?}, maps {mapped}, wind {wind}, from {eye}, pixel {at}");
                    let rains = bare[k] < 0.99;
                    match agreed(&host, boxes, fall, ndc, slack) {
                        Some(true) => {
                            assert_eq!(seen[k], 1.0, "{what}");
                            dry += u32::from(rains);
                        }
                        Some(false) => {
                            // Maps contain the ground too, and places below it count as dry.
                            let below = if mapped { 0.15 * (1.0 - bare[k]) } else { 0.0 };
                            let lost = seen[k] - bare[k];
                            assert!(lost > -1e-3 && lost < 1e-3 + below, "{what}: {} of {}", seen[k], bare[k]);
                            open += u32::from(rains);
                        }
                        None => {
                            assert!(seen[k] > bare[k] - 1e-3 && seen[k] <= 1.0, "{what}: {} of {}", seen[k], bare[k]);
                            between += 1;
                        }
                    }
                }
            }
        }
        println!("{backends:?}, maps {mapped}: {dry} pixels are dry, {open} open, {between} between");
        assert!(dry > 100 && open > 100, "{backends:?}: {dry} {open} {between}");
    }
}
