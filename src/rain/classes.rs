//! Classes of drop diameter, and the number of drops of each class in one shell of the lattice.

use super::{
    shells::{CLASSES, SHELLS, SIDE_M, SPEED_UNIT},
    sizes::DropSizes,
};
use crate::weather::Falling;

/// Smallest and largest diameter drawn as drops, mm. Smaller drops only add to the extinction that is drawn with the
/// fog.
const DRAWN_MM: (f64, f64) = (0.5, 6.0);

/// Drops of each class in one shell.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Classes {
    /// Table of the shader, per class: diameter, m; fall speed, [`SPEED_UNIT`]; number of drops, in a shell, of this
    /// class and all smaller ones; 0.
    pub table: [[f32; 4]; CLASSES],
    /// Number of drops in a shell.
    pub per_shell: u32,
    /// Number of drops that each drawn drop of the innermost shell represents.
    pub weight: f64,
    /// Extinction of all drops in the drawn classes, 1/m.
    pub extinction_per_m: f64,
    /// Diameter (mm), fall speed (m/s) and flux on level ground (1/(m^2 s)) of each class.
    pub flux: [(f64, f64, f64); CLASSES],
}

impl Classes {
    /// Creates the classes of the precipitation at an altitude where drops fall `density_factor` times as fast as at
    /// sea level ([`super::drops::factor_in`]), with at most `most` drops in all shells together.
    pub fn new(falling: &Falling, density_factor: f64, most: u32) -> Self {
        let (low, high) = DRAWN_MM;
        let step = (high / low).powf(1.0 / CLASSES as f64);
        let edges = |k: usize| low * step.powi(k as i32);
        let volume = SIDE_M.powi(3);
        let sizes = DropSizes::new(falling, density_factor);
        let number: [f64; CLASSES] = std::array::from_fn(|k| volume * sizes.number_between(edges(k), edges(k + 1)));
        let all: f64 = number.iter().sum();
        let share = (f64::from(most) / SHELLS as f64 / all.max(1.0)).min(1.0);
        let mut upto = 0.0f64;
        let mut extinction = 0.0;
        let mut flux = [(0.0, 0.0, 0.0); CLASSES];
        let table: [[f32; 4]; CLASSES] = std::array::from_fn(|k| {
            upto += number[k] * share;
            let d = (edges(k) * edges(k + 1)).sqrt();
            let speed = sizes.speed_m_s(d);
            flux[k] = (d, speed, number[k] / volume * speed);
            extinction += number[k] / volume * std::f64::consts::FRAC_PI_2 * d * d * 1e-6;
            [(d * 1e-3) as f32, (speed / SPEED_UNIT).round() as f32, upto.floor() as f32, 0.0]
        });
        Self { table, per_shell: upto as u32, weight: 1.0 / share, extinction_per_m: extinction, flux }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::weather::{Precipitation, PrecipitationKind, Weather, derive};

    #[test]
    fn classes_hold_the_water_that_falls_and_thinning_keeps_what_they_cover() {
        let weather = Weather { precipitation: Precipitation::of(PrecipitationKind::Rain, 20.0), ..Weather::default() };
        let falling = derive(&weather).unwrap().precipitation;
        let (all, few) = (Classes::new(&falling, 1.0, u32::MAX), Classes::new(&falling, 1.0, 20_000));
        assert!(few.per_shell <= 5000 && all.per_shell > 20_000);
        let cover = |c: &Classes| {
            let mut before = 0.0;
            c.table.iter().fold(0.0, |sum, row| {
                let n = f64::from(row[2]) - before;
                before = f64::from(row[2]);
                sum + n * f64::from(row[0]).powi(2)
            }) * c.weight
        };
        assert!((cover(&few) / cover(&all) - 1.0).abs() < 0.02, "{} {}", cover(&few), cover(&all));
        let falls: f64 = {
            let mut before = 0.0;
            all.table.iter().fold(0.0, |sum, row| {
                let n = f64::from(row[2]) - before;
                before = f64::from(row[2]);
                let d = f64::from(row[0]);
                sum + n * d * d * d * std::f64::consts::PI / 6.0 * f64::from(row[1]) * SPEED_UNIT
            }) / SIDE_M.powi(3)
                * 3.6e6
        };
        // Drops below 0.5 mm carry the rest.
        assert!((18.0..20.2).contains(&falls), "{falls} mm/h");
    }
}
