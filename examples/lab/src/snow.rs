//! Draws and times every way to draw snow, and computes the truth: each flake in front of the camera by itself, in f64.
//!
//! As in rain ([`crate::rain`]), different methods put flakes in different places, so pictures are compared as
//! textures, block by block.

use std::f64::consts::{FRAC_PI_4, PI};

use glam::{DMat3, DVec2, DVec3};
use welkin::Result;
use welkin::light::luminance;
use welkin::rain::{DropLight, Planes, Shelter};
use welkin::snow::{
    SnowModel, SnowSettings,
    flakes::{AREA_RATIO, FlakeSizes},
    lattice::{Flakes, NEAREST_M, SPEED_UNIT},
    reference::flake_radiance,
};
use welkin_support::brute_rain::RandomStream;

use crate::rain::{Blocks, EYE, Host, focal, layer};

/// Distance up to which the truth has flakes, m: where the most numerous flakes are half faded.
const FAR_M: f64 = 0.925 * 16.0;

/// All flakes in front of a camera.
struct Air {
    flakes: Flakes,
    wind_m_s: DVec3,
    camera_m_s: DVec3,
    light: DropLight,
    extinction_per_m: f64,
}

impl Air {
    fn new(host: &Host, most: u32) -> Result<Self> {
        let scene = host.scene()?;
        let c = &scene.conditions;
        let factor = welkin::rain::drops::factor_in(&c.air, c.air.station_altitude_m);
        let sizes = FlakeSizes::new(&c.precipitation, c.air.temperature_c, factor);
        Ok(Self {
            flakes: Flakes::new(&sizes, 1.0, most),
            wind_m_s: host.wind_m_s(),
            camera_m_s: host.camera_m_s(),
            light: DropLight::of(&scene),
            extinction_per_m: c.fog.extinction_per_m + c.aerosol.extinction_per_m,
        })
    }

    /// Light and cover at every pixel. Flakes are discs as thin as their ice, moved along their path while the shutter
    /// is open.
    fn all(&self, size: (u32, u32), exposure_s: f64, seed: u64) -> Vec<[f64; 2]> {
        let mut chance = RandomStream(seed);
        let mut sums = vec![[0.0f64; 2]; (size.0 * size.1) as usize];
        let f = focal(size);
        // A pyramid of air, slightly wider than the picture.
        let half = [size.0, size.1].map(|n| 0.5 * f64::from(n) / f * 1.1);
        let volume = 4.0 * half[0] * half[1] * FAR_M.powi(3) / 3.0;
        for (row, number) in self.flakes.table.iter().zip(self.flakes.number_per_m3) {
            let (diameter, speed) = (f64::from(row[0]), f64::from(row[1]) * SPEED_UNIT);
            let way = (self.wind_m_s - DVec3::Z * speed - self.camera_m_s) * (0.5 * exposure_s);
            for _ in 0..(number * volume + chance.even()) as u64 {
                let y = FAR_M * chance.even().cbrt();
                let p =
                    DVec3::new((2.0 * chance.even() - 1.0) * half[0], 1.0, (2.0 * chance.even() - 1.0) * half[1]) * y;
                let d = p.length();
                let t = ((d - 0.5 * NEAREST_M) / (0.5 * NEAREST_M)).clamp(0.0, 1.0);
                if d < FAR_M && t > 0.0 && way.y.abs() < 0.6 * y {
                    let share = t * t * (3.0 - 2.0 * t) * (-self.extinction_per_m * d).exp();
                    self.deposit(&mut sums, size, (p, way, diameter), share);
                }
            }
        }
        layer(&sums)
    }

    fn deposit(&self, sums: &mut [[f64; 2]], size: (u32, u32), (p, half, diameter): (DVec3, DVec3, f64), share: f64) {
        let f = focal(size);
        let to_pixel =
            |p: DVec3| DVec2::new(0.5 * f64::from(size.0) + f * p.x / p.y, 0.5 * f64::from(size.1) - f * p.z / p.y);
        let (a, b) = (to_pixel(p - half), to_pixel(p + half));
        let radius = 0.5 * diameter * f / p.y;
        let along = (2.0 * (b - a).length()).ceil().clamp(1.0, 500.0) as u32;
        let rings = (2.0 * radius).ceil().clamp(1.0, 24.0) as u32;
        let area = AREA_RATIO * FRAC_PI_4 * 4.0 * radius * radius * (p.length() / p.y) * share;
        let part = area / f64::from(along * rings * rings);
        let light = luminance(&flake_radiance(&self.light, p.normalize()).to_array());
        for i in 0..along {
            let middle = a + (b - a) * ((f64::from(i) + 0.5) / f64::from(along));
            for j in 0..rings * rings {
                // Spread evenly over the disc (Vogel 1979).
                let s = (f64::from(j) + 0.5) / f64::from(rings * rings);
                let angle = f64::from(j) * PI * (3.0 - 5f64.sqrt());
                let at = middle + DVec2::from_angle(angle) * (radius * s.sqrt());
                if at.x >= 0.0 && at.y >= 0.0 && at.x < f64::from(size.0) && at.y < f64::from(size.1) {
                    let sum = &mut sums[at.y as usize * size.0 as usize + at.x as usize];
                    sum[0] += part * light;
                    sum[1] += part;
                }
            }
        }
    }
}

/// Blocks of the scene drawn with these settings.
pub fn drawn_by(host: &mut Host, settings: SnowSettings) -> Result<Blocks> {
    host.set_snow(settings)?;
    host.pictures()
}

/// Luminances of the background of all flakes, without the haze that stands for these flakes.
fn behind(host: &mut Host) -> Result<Vec<f64>> {
    const FEW: u32 = 20_000;
    // A tent keeps the flakes off, and Welkin still leaves out their haze. The wall beyond the tent gets as wet as
    // without it.
    let tent = Shelter {
        center_m: EYE,
        axes: DMat3::IDENTITY,
        half_size_m: DVec3::splat(30.0),
        velocity_m_s: DVec3::ZERO,
        planes: Planes::NONE,
    };
    host.set_shelters(&[tent])?;
    host.set_snow(SnowSettings { model: SnowModel::Flakes, most_flakes: Some(FEW), ..SnowSettings::default() })?;
    host.frame()?;
    let near = host.luminances()?;
    host.set_shelters(&[])?;
    host.set_snow(SnowSettings { model: SnowModel::Veil, ..SnowSettings::default() })?;
    host.frame()?;
    // Luminance is linear in the exponential of the optical depth left out.
    let few = Air::new(host, FEW)?.flakes;
    let grown = |reach: f64| (few.hidden_per_m * reach).exp_m1();
    let more = grown(FAR_M) / grown(few.hidden_m());
    Ok(host.luminances()?.iter().zip(&near).map(|(v, n)| v + (n - v) * more).collect())
}

/// Blocks of the truth, and the luminance shown as white; another `seed` puts the flakes elsewhere.
pub fn truth(host: &mut Host, seed: u64) -> Result<(Blocks, f64)> {
    let (size, exposure_s) = (host.size(), SnowSettings::default().shutter_s);
    let air = Air::new(host, u32::MAX)?;
    let mut blocks = Blocks::new(size);
    let mut logs = Vec::new();
    host.moments(|host, i| {
        let flakes = air.all(size, exposure_s, seed.wrapping_mul(1000) + i);
        let over = |(b, [light, cover]): (&f64, &[f64; 2])| b * (1.0 - cover) + light;
        let picture: Vec<f64> = behind(host)?.iter().zip(&flakes).map(over).collect();
        blocks.add(&picture);
        logs.extend(picture.iter().map(|y| y.max(1e-9).ln()));
        Ok(())
    })?;
    Ok((blocks, (logs.iter().sum::<f64>() / logs.len() as f64).exp() / 0.18))
}
