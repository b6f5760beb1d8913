//! Light of the sky for hosts, on the CPU: irradiance and nine spherical harmonics at any altitude and sun angle.
//!
//! The GPU builds this table together with the sky's other tables, from the radiances of every order. The table is read
//! back once a build; look-ups then need no GPU. Everything is per unit irradiance of the lamp.

use half::f16;

use super::settings::{LIGHT_TILES, SkySettings};
use super::uniforms::{AirUniform, LIGHT_SCALE};
use crate::gpu::{Device, readback};
use crate::{Result, sky::passes::SkyTable};

/// Nine coefficients of the sky's radiance in real spherical harmonics, per wavelength, in the order 00; 1y, 1z, 1x;
/// 2xy, 2yz, 2zz, 2xz, 2xx-yy (Ramamoorthi and Hanrahan 2001). The lower hemisphere is the planet's lit ground.
pub type Sh9 = [[f32; 3]; 9];

/// Light of one planet's sky as a function of altitude and sun angle.
#[derive(Clone, Debug)]
pub struct LightTable {
    air: AirUniform,
    suns: usize,
    altitudes: usize,
    /// Values in the order [altitude][tile][sun angle].
    values: Vec<[f32; 3]>,
}

/// Constants `SUN_SPREAD` and `SUN_BELOW` of `sky/maps.wgsl`.
const SUN_SPREAD: f32 = 0.3;
const SUN_BELOW: f32 = 0.22;

impl LightTable {
    /// Creates a table without light.
    pub(crate) fn dark(settings: &SkySettings, air: AirUniform) -> Self {
        let (suns, altitudes) = (settings.suns as usize, settings.altitudes as usize);
        Self { air, suns, altitudes, values: vec![[0.0; 3]; suns * LIGHT_TILES as usize * altitudes] }
    }

    /// Reads a finished table; waits for the GPU.
    pub(crate) fn read(device: &Device, table: &SkyTable, air: AirUniform) -> Result<Self> {
        let (width, height) = (table.texture.width() as usize, table.texture.height() as usize);
        let raw = readback::bytes(device, &table.texture, 0)?;
        let number = |b: &[u8], i: usize| f16::from_le_bytes([b[2 * i], b[2 * i + 1]]).to_f32() / LIGHT_SCALE;
        let values = raw.chunks_exact(8).map(|b| [number(b, 0), number(b, 1), number(b, 2)]).collect();
        Ok(Self { air, suns: width / LIGHT_TILES as usize, altitudes: height, values })
    }

    /// Returns the table resampled to other sizes.
    pub(crate) fn resized(self, suns: usize, altitudes: usize) -> Self {
        if (self.suns, self.altitudes) == (suns, altitudes) {
            return self;
        }
        let place = |i: usize, n: usize, of: usize| {
            let x = (i * (of - 1)) as f32 / (n - 1) as f32;
            let first = (x as usize).min(of - 2);
            (first, x - first as f32)
        };
        let tiles = LIGHT_TILES as usize;
        let mut values = Vec::with_capacity(suns * tiles * altitudes);
        for (row, k) in (0..altitudes).flat_map(|j| (0..tiles * suns).map(move |k| (j, k))) {
            let (x, y) = (place(k % suns, suns, self.suns), place(row, altitudes, self.altitudes));
            values.push(self.between(k / suns, x, y));
        }
        Self { suns, altitudes, values, ..self }
    }

    /// Interpolates between this table and another of the same sizes; `t` is the weight of the other.
    pub(crate) fn mix(&self, other: &Self, t: f32) -> Self {
        let between = |(a, b): (&[f32; 3], &[f32; 3])| std::array::from_fn(|c| a[c] + (b[c] - a[c]) * t);
        let values = self.values.iter().zip(&other.values).map(between).collect();
        Self { air: self.air.mix(&other.air, t), values, ..*self }
    }

    /// Irradiance of the sky on a level surface facing up, per unit irradiance of the lamp. `mu_s` is the cosine of the
    /// lamp's geometric zenith angle. Thread-safe.
    pub fn irradiance(&self, altitude_m: f64, mu_s: f64) -> [f32; 3] {
        self.tile(0, altitude_m, mu_s).map(|v| v.max(0.0))
    }

    /// Radiance of the sky in spherical harmonics, per unit irradiance of the lamp, in the frame in which `direction`
    /// (unit, z up) points at the lamp. Thread-safe.
    pub fn sh9(&self, altitude_m: f64, direction: [f64; 3]) -> Sh9 {
        let m: [[f32; 3]; 6] = std::array::from_fn(|i| self.tile(i + 1, altitude_m, direction[2]));
        let level = direction[0].hypot(direction[1]);
        let (c, s) = if level > 1e-9 { (direction[0] / level, direction[1] / level) } else { (1.0, 0.0) };
        let (c, s) = (c as f32, s as f32);
        let times = |v: [f32; 3], k: f32| v.map(|x| x * k);
        let [l0, z, x, zz, xz, xx] = m;
        let (c2, s2) = (c * c - s * s, 2.0 * c * s);
        [l0, times(x, s), z, times(x, c), times(xx, s2), times(xz, s), zz, times(xz, c), times(xx, c2)]
    }

    /// Bilinear interpolation, as on the GPU.
    fn tile(&self, tile: usize, altitude_m: f64, mu_s: f64) -> [f32; 3] {
        let x = self.sun_coordinate(mu_s as f32) * (self.suns - 1) as f32;
        let share = (altitude_m as f32 / self.air.thickness_m).clamp(0.0, 1.0);
        let y = share.sqrt() * (self.altitudes - 1) as f32;
        let (i, j) = ((x as usize).min(self.suns - 2), (y as usize).min(self.altitudes - 2));
        self.between(tile, (i, x - i as f32), (j, y - j as f32))
    }

    /// Interpolates between four values of a tile; each axis has the index of the lower value and the share of the
    /// upper one.
    fn between(&self, tile: usize, (i, fx): (usize, f32), (j, fy): (usize, f32)) -> [f32; 3] {
        let at = |i: usize, j: usize| self.values[(j * LIGHT_TILES as usize + tile) * self.suns + i];
        let (a, b, c, d) = (at(i, j), at(i + 1, j), at(i, j + 1), at(i + 1, j + 1));
        std::array::from_fn(|k| (a[k] * (1.0 - fx) + b[k] * fx) * (1.0 - fy) + (c[k] * (1.0 - fx) + d[k] * fx) * fy)
    }

    /// Coordinate of a sun angle in the table: `sun_coordinate` of `sky/maps.wgsl`.
    fn sun_coordinate(&self, mu_s: f32) -> f32 {
        let dip = self.air.top_dip;
        let center = -0.5 * dip;
        let u = (mu_s - center) / SUN_SPREAD;
        let x = if u > 0.0 { u / (1.0 + u) } else { u };
        let lo = -(0.5 * dip + SUN_BELOW) / SUN_SPREAD;
        let hi = (1.0 - center) / (SUN_SPREAD + 1.0 - center);
        ((x - lo) / (hi - lo)).clamp(0.0, 1.0)
    }
}
