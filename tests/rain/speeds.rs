//! Fall speeds against a law of drag that is independent of the table they are read from: Beard (1976), from Davies and
//! Bond numbers. The library interpolates the measurements of Gunn and Kinzer.

use welkin::rain::drops::{density_factor, terminal_speed_m_s};

/// Air and water at a temperature (C) and pressure (Pa).
struct AirState {
    density: f64,
    viscosity: f64,
    free_path_m: f64,
}

impl AirState {
    fn at(temperature_c: f64, pressure_pa: f64) -> Self {
        let kelvin = temperature_c + 273.15;
        let viscosity = (1.718 + 0.0049 * temperature_c) * 1e-5;
        let free_path_m = 6.62e-8 * (viscosity / 1.818e-5) * (101_325.0 / pressure_pa) * (kelvin / 293.15).sqrt();
        Self { density: pressure_pa / (287.05 * kelvin), viscosity, free_path_m }
    }
}

/// Terminal speed, m/s, of a water drop of `d` metres (Beard 1976, regimes 2 and 3: 19 micrometres to 7 mm).
fn beard(air: &AirState, d: f64) -> f64 {
    let (gravity, surface_tension, excess) = (9.806_65, 0.0728, 998.2 - air.density);
    let series = |x: f64, b: &[f64]| b.iter().rev().fold(0.0, |sum, c| sum * x + c);
    let reynolds = if d < 1.07e-3 {
        let davies = 4.0 * air.density * excess * gravity * d.powi(3) / (3.0 * air.viscosity.powi(2));
        let b = [-3.18657, 0.992696, -1.53193e-3, -9.87059e-4, -5.78878e-4, 8.55176e-5, -3.27815e-6];
        (1.0 + 2.51 * air.free_path_m / d) * series(davies.ln(), &b).exp()
    } else {
        let bond = 4.0 * excess * gravity * d * d / (3.0 * surface_tension);
        let physical = surface_tension.powi(3) * air.density.powi(2) / (air.viscosity.powi(4) * excess * gravity);
        let sixth = physical.powf(1.0 / 6.0);
        let b = [-5.00015, 5.23778, -2.04914, 0.475294, -0.0542819, 0.00238449];
        sixth * series((bond * sixth).ln(), &b).exp()
    };
    air.viscosity * reynolds / (air.density * d)
}

/// Sizes from 0.3 to 5.8 mm, between the table's entries too.
fn sizes() -> impl Iterator<Item = f64> {
    (0..=110).map(|i| 0.3 + 0.05 * f64::from(i))
}

#[test]
fn speeds_follow_the_drag_of_falling_spheres_and_flattened_drops() {
    let laboratory = AirState::at(20.0, 101_325.0);
    for mm in sizes() {
        let off = terminal_speed_m_s(mm) / beard(&laboratory, mm * 1e-3) - 1.0;
        let allowed = if mm < 0.7 { 0.025 } else { 0.01 };
        assert!(off.abs() < allowed, "{mm} mm: {off:+.4}");
    }
}

/// The library uses the exponent 0.4 for all sizes (Foote and du Toit 1969); the law of drag gives the increase for
/// each size.
#[test]
fn thin_air_lets_drops_fall_faster_by_the_law_of_drag() {
    let level = AirState::at(15.0, 101_325.0);
    for (altitude, air) in [(2000.0, AirState::at(2.0, 79_495.0)), (5000.0, AirState::at(-17.5, 54_020.0))] {
        for mm in sizes().filter(|mm| *mm >= 0.5) {
            let want = beard(&air, mm * 1e-3) / beard(&level, mm * 1e-3);
            let off = density_factor(air.density) / want - 1.0;
            assert!(off.abs() < 0.05, "{mm} mm at {altitude} m: {off:+.4}");
        }
    }
}
