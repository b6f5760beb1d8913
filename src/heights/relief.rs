//! Heights of noise: fractional Brownian motion and ridges, functions of place and seed.

use glam::{DVec2, UVec2};

use super::map::{HeightMap, check_size, room_for};
use crate::{
    chance::mixed,
    error::{Result, check_range},
    noise::gradient_2d,
};

/// Largest distance of a place from the origin, m.
const FARTHEST_M: f64 = 1e7;
/// Number of cells after which an octave repeats; no place is as far away.
const PERIOD: UVec2 = UVec2::splat(1 << 31);
/// Largest number of octaves.
const MOST_OCTAVES: i32 = 24;
/// Largest absolute value of one octave of gradient noise. Scaled by this value, ridges have sharp crests and no
/// negative height.
const MOST_NOISE: f64 = 0.85;

/// Kind of relief.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ReliefKind {
    /// Fractional Brownian motion (Mandelbrot and Van Ness 1968) as a sum of octaves of gradient noise (Musgrave, Kolb
    /// and Mace 1989): hills and valleys alike, 0 on average.
    Fractal,
    /// Ridged multifractal (Musgrave in Ebert et al. 2003, *Texturing and Modeling*, chapter 16, with offset 1 and gain
    /// 2): sharp crests, smooth valleys, 0 and above.
    Ridged,
}

/// Terrain made of noise. The same settings give the same bits on every machine, and maps of neighbouring places fit
/// together.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct NoiseTerrain {
    /// Kind of relief. Default: fractal.
    pub kind: ReliefKind,
    /// Seed: each number gives another terrain. Default 0.
    pub seed: u64,
    /// Size of the largest forms, m, \[0.1, 1e6\]; default 2000. Each octave is half as large as the one before.
    pub wavelength_m: f64,
    /// Amplitude of the largest forms, m, \[0, 4000\]; default 300. The root mean square of a single octave of the
    /// fractal kind is 0.27 of its amplitude.
    pub amplitude_m: f64,
    /// Hurst exponent, \[0, 1\]; default 0.8. An octave's amplitude is 2^-H times that of the one before, with H this
    /// exponent, so differences of height grow as distance^H: 0.5 is jagged, 1 smooth.
    pub hurst: f64,
}

impl Default for NoiseTerrain {
    fn default() -> Self {
        Self { kind: ReliefKind::Fractal, seed: 0, wavelength_m: 2000.0, amplitude_m: 300.0, hurst: 0.8 }
    }
}

impl NoiseTerrain {
    /// Checks every field.
    ///
    /// # Errors
    /// [`crate::Status::InvalidArgument`] naming the field.
    pub fn check(&self) -> Result<()> {
        check_range("wavelength_m", self.wavelength_m, 0.1, 1e6, "m")?;
        check_range("amplitude_m", self.amplitude_m, 0.0, 4e3, "m")?;
        check_range("hurst", self.hurst, 0.0, 1.0, "")
    }

    /// Returns the height at a place, m: the sum of the first octave and of those, at most 24 in all, whose forms are
    /// at least two `cell_m` wide. Finer octaves would alias. For settings that [`NoiseTerrain::check`] refuses, the
    /// result is meaningless.
    pub fn height_m(&self, east_m: f64, north_m: f64, cell_m: f64) -> f64 {
        let place = DVec2::new(east_m, north_m);
        let ratio = libm::exp2(-self.hurst);
        let (mut height, mut amplitude, mut wavelength, mut weight) = (0.0, self.amplitude_m, self.wavelength_m, 1.0);
        for octave in 0..MOST_OCTAVES {
            if octave > 0 && wavelength < 2.0 * cell_m {
                break;
            }
            // Each octave is shifted by an offset of its own: it is 0 at its cells' corners, so unshifted octaves would
            // all be 0 at the origin.
            let key = mixed(mixed(self.seed).wrapping_add(octave as u64));
            let part = |shift: u32| f64::from((key >> shift) as u16) / 65_536.0;
            let noise = gradient_2d(place / wavelength + DVec2::new(part(0), part(16)), PERIOD, (key >> 32) as u32);
            match self.kind {
                ReliefKind::Fractal => height += amplitude * noise,
                ReliefKind::Ridged => {
                    let crest = 1.0 - noise.abs() / MOST_NOISE;
                    let signal = weight * crest * crest;
                    height += amplitude * signal;
                    weight = (2.0 * signal).clamp(0.0, 1.0);
                }
            }
            (amplitude, wavelength) = (amplitude * ratio, 0.5 * wavelength);
        }
        height
    }
}

impl HeightMap {
    /// Computes terrain of noise on square cells of `cell_m`, whose south-western sample is at `south_west_m` (east,
    /// north). Maps whose places and distances of samples agree have the same heights where they overlap.
    ///
    /// # Errors
    /// [`crate::Status::InvalidArgument`] for a size that [`HeightMap::new`] refuses, a distance outside
    /// \[0.01, 10 000\] m, a `south_west_m` farther than 1e7 m from 0 in either direction, and fields of `terrain`;
    /// [`crate::Status::OutOfMemory`].
    pub fn generate(
        columns: u32,
        rows: u32,
        cell_m: f64,
        south_west_m: [f64; 2],
        terrain: &NoiseTerrain,
    ) -> Result<Self> {
        check_size(columns, rows)?;
        check_range("cell_m", cell_m, 0.01, 1e4, "m")?;
        terrain.check().map_err(|e| e.within("terrain"))?;
        for (i, place) in south_west_m.into_iter().enumerate() {
            check_range(&format!("south_west_m[{i}]"), place, -FARTHEST_M, FARTHEST_M, "m")?;
        }
        let mut heights_m = room_for(u64::from(columns) * u64::from(rows))?;
        for row in 0..rows {
            let place = |axis: usize, i: u32| south_west_m[axis] + cell_m * f64::from(i);
            let height = |column| terrain.height_m(place(0, column), place(1, row), cell_m) as f32;
            heights_m.extend((0..columns).map(height));
        }
        Ok(Self::of_checked(columns, rows, heights_m).placed(Some([cell_m; 2]), Some(south_west_m)))
    }
}
