//! One raindrop: its fall speed, its shape, and how it follows the wind. Diameters are those of a sphere with the same
//! volume, mm.

use glam::DVec3;

/// Terminal speed of drops at sea level (1013 hPa, 20 C): diameter mm, speed m/s (Gunn and Kinzer 1949, table 2).
#[rustfmt::skip]
pub const GUNN_KINZER: [(f64, f64); 35] = [
    (0.078, 0.18), (0.1, 0.27), (0.2, 0.72), (0.3, 1.17), (0.4, 1.62), (0.5, 2.06), (0.6, 2.47), (0.7, 2.87), (0.8, 3.27),
    (0.9, 3.67), (1.0, 4.03), (1.2, 4.64), (1.4, 5.17), (1.6, 5.65), (1.8, 6.09), (2.0, 6.49), (2.2, 6.90), (2.4, 7.27),
    (2.6, 7.57), (2.8, 7.82), (3.0, 8.06), (3.2, 8.26), (3.4, 8.44), (3.6, 8.60), (3.8, 8.72), (4.0, 8.83), (4.2, 8.92),
    (4.4, 8.98), (4.6, 9.03), (4.8, 9.07), (5.0, 9.09), (5.2, 9.12), (5.4, 9.14), (5.6, 9.16), (5.8, 9.17),
];

/// Standard gravity, m/s^2.
pub const GRAVITY_M_S2: f64 = 9.806_65;
/// Density of the standard atmosphere at sea level, kg/m^3.
const SEA_LEVEL_DENSITY_KG_M3: f64 = 1.225;
/// Gas constant of dry air, J/(kg K).
const AIR_GAS_CONSTANT: f64 = 287.053;

/// Returns the terminal speed at sea level, m/s, of a drop of `diameter_mm`: Gunn and Kinzer's table with monotone
/// cubic interpolation (Fritsch and Butland 1984). Below the table the speed is proportional to the square of the
/// diameter (Stokes); above it the speed is constant.
pub fn terminal_speed_m_s(diameter_mm: f64) -> f64 {
    let table = &GUNN_KINZER;
    let (first, last) = (table[0], table[table.len() - 1]);
    if diameter_mm <= first.0 {
        let part = diameter_mm.max(0.0) / first.0;
        return first.1 * part * part;
    }
    if diameter_mm >= last.0 {
        return last.1;
    }
    let i = table.partition_point(|e| e.0 <= diameter_mm) - 1;
    let ((a, va), (b, vb)) = (table[i], table[i + 1]);
    let h = b - a;
    let t = (diameter_mm - a) / h;
    let (ma, mb) = (slope(i), slope(i + 1));
    let (t2, t3) = (t * t, t * t * t);
    va * (1.0 - 3.0 * t2 + 2.0 * t3) + vb * (3.0 * t2 - 2.0 * t3) + h * (ma * (t - 2.0 * t2 + t3) + mb * (t3 - t2))
}

/// Returns the slope of the interpolant at entry `i` of the table, m/s per mm: the weighted harmonic mean of the slopes
/// of the two neighbouring intervals (Fritsch and Butland 1984). With it the interpolant never overshoots. At the ends
/// of the table it is the slope of the only neighbouring interval.
fn slope(i: usize) -> f64 {
    let secant = |i: usize| {
        let ((a, va), (b, vb)) = (GUNN_KINZER[i], GUNN_KINZER[i + 1]);
        (b - a, (vb - va) / (b - a))
    };
    if i == 0 {
        return secant(0).1;
    }
    if i == GUNN_KINZER.len() - 1 {
        return secant(i - 1).1;
    }
    let ((h0, s0), (h1, s1)) = (secant(i - 1), secant(i));
    let share = (h0 + 2.0 * h1) / (3.0 * (h0 + h1));
    // All secants of the table are positive.
    s0 * s1 / (share * s1 + (1.0 - share) * s0)
}

/// Coefficients of [`closed_form_speed_m_s`]: least squares on Gunn and Kinzer's table.
pub const CLOSED_FORM: [f64; 5] = [9.198_902, 0.053_827_5, 0.572_275_3, 0.008_907_134, 0.012_283_48];

/// Returns the terminal speed at sea level, m/s, in a closed form for shaders: c0 (1 - exp(-(D - c1) (c2 + c3 D + c4
/// D^2))), never negative, with D = `diameter_mm` and c = [`CLOSED_FORM`]. Over the table its RMS error is 0.031 m/s,
/// and its largest error is below 0.078 m/s; at 0.6 mm and more the error is within 2 % (tested). It is monotone and at
/// most 9.2 m/s for any size.
pub fn closed_form_speed_m_s(diameter_mm: f64) -> f64 {
    let [c0, c1, c2, c3, c4] = CLOSED_FORM;
    let d = (diameter_mm - c1).max(0.0);
    -c0 * libm::expm1(-d * (c2 + diameter_mm * (c3 + diameter_mm * c4)))
}

/// Returns the ratio of the fall speed of drops in air of the density rho, kg/m^3, to that at sea level: (rho0 /
/// rho)^0.4, rho0 = 1.225 kg/m^3 (Foote and du Toit 1969).
pub fn density_factor(density_kg_m3: f64) -> f64 {
    libm::pow(SEA_LEVEL_DENSITY_KG_M3 / density_kg_m3, 0.4)
}

/// Returns the [`density_factor`] in the standard atmosphere at an altitude in m above the sea. Below -1000 m and above
/// 11 000 m it is constant.
pub fn altitude_factor(altitude_m: f64) -> f64 {
    libm::pow(standard_density_ratio(altitude_m), -0.4)
}

/// Returns the density relative to sea level in the troposphere of the standard atmosphere (ISO 2533): (1 - 2.25577e-5
/// h)^4.25588, h in m.
fn standard_density_ratio(altitude_m: f64) -> f64 {
    libm::pow(1.0 - 2.255_77e-5 * altitude_m.clamp(-1000.0, 11_000.0), 4.255_88)
}

/// Returns the [`density_factor`] at an altitude above the sea, m, over a station whose air is known. The density at
/// the station is computed from the station's pressure and temperature. It changes with height as in the standard
/// atmosphere.
pub fn factor_in(air: &crate::weather::Air, altitude_m: f64) -> f64 {
    let at_station = 100.0 * air.station_pressure_hpa / (AIR_GAS_CONSTANT * (air.temperature_c + 273.15));
    let ratio = standard_density_ratio(altitude_m) / standard_density_ratio(air.station_altitude_m);
    density_factor(at_station * ratio)
}

/// Returns the ratio of the vertical to the horizontal axis of a falling drop, a polynomial of the diameter (Brandes,
/// Zhang and Vivekanandan 2002, eq. 16), at most 1; constant above 8 mm.
pub fn axis_ratio(diameter_mm: f64) -> f64 {
    let d = diameter_mm.clamp(0.0, 8.0);
    (0.9951 + d * (0.0251 + d * (-0.03644 + d * (0.005_303 - d * 0.000_249_2)))).min(1.0)
}

/// Returns the length, m, of the streak that a drop makes in an exposure (s) at a velocity relative to the camera
/// (m/s).
pub fn streak_length_m(relative_velocity_m_s: DVec3, exposure_s: f64) -> f64 {
    relative_velocity_m_s.length() * exposure_s
}

/// Returns the velocity (m/s) and the displacement (m) of a drop after `dt_s`. The drop has `velocity_m_s` at first,
/// the air has the velocity `air_m_s`, and the terminal speed in still air is `terminal_m_s`. Vectors are (east, north,
/// up).
///
/// The drag is linear in the velocity difference, which decays with the time constant `terminal_m_s` / g. The solution
/// is exact for any step. (Quadratic drag leads to the same velocity, at most twice as fast.)
pub fn relax(velocity_m_s: DVec3, air_m_s: DVec3, terminal_m_s: f64, dt_s: f64) -> (DVec3, DVec3) {
    let settled = air_m_s - DVec3::Z * terminal_m_s;
    let time = terminal_m_s / GRAVITY_M_S2;
    if time <= 0.0 {
        return (settled, settled * dt_s);
    }
    let gone = -libm::expm1(-dt_s / time);
    let difference = velocity_m_s - settled;
    (velocity_m_s - difference * gone, settled * dt_s + difference * (time * gone))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Returns the errors of a fall speed at Gunn and Kinzer's sizes: their root mean square and the largest, m/s; and
    /// the largest relative error from 0.6 mm on.
    fn rms(speed: impl Fn(f64) -> f64) -> (f64, f64, f64) {
        let errors = GUNN_KINZER.map(|(d, v)| (d, v, speed(d) - v));
        let rms = (errors.iter().map(|e| e.2 * e.2).sum::<f64>() / errors.len() as f64).sqrt();
        let most = errors.iter().map(|e| e.2.abs()).fold(0.0, f64::max);
        let part = errors.iter().filter(|e| e.0 >= 0.6).map(|e| (e.2 / e.1).abs()).fold(0.0, f64::max);
        (rms, most, part)
    }

    #[test]
    fn speeds_are_gunn_and_kinzers_and_the_closed_form_errs_as_it_says() {
        assert!(rms(terminal_speed_m_s).1 < 1e-12);
        let (rms, most, part) = rms(closed_form_speed_m_s);
        assert!((0.02..0.031).contains(&rms) && most < 0.078 && part < 0.02, "{rms} {most} {part}");
        let steps = || (0..=8000).map(|i| f64::from(i) * 1e-3);
        for speed in [terminal_speed_m_s, closed_form_speed_m_s] {
            assert!(steps().zip(steps().skip(1)).all(|(a, b)| speed(b) >= speed(a) && speed(b) - speed(a) < 6e-3));
            assert!(speed(0.0) == 0.0 && speed(100.0) < 9.2);
        }
        // The published fits agree within the errors that their authors state, so the table was copied correctly.
        let atlas = |d: f64| (9.65 - 10.3 * (-0.6 * d).exp()).max(0.0);
        let brandes = |d: f64| -0.1021 + d * (4.932 + d * (-0.9551 + d * (0.079_34 - d * 0.002_362)));
        assert!((0.09..0.104).contains(&self::tests::rms(atlas).0), "{:?}", self::tests::rms(atlas));
        assert!((self::tests::rms(brandes).0 - 0.053).abs() < 1e-3);
    }

    #[test]
    fn thin_air_lets_drops_fall_faster() {
        assert_eq!(altitude_factor(0.0), 1.0);
        assert!((altitude_factor(2000.0) - 1.082).abs() < 1e-3 && (altitude_factor(5000.0) - 1.226).abs() < 1e-3);
        let air = crate::weather::derive(&Default::default()).unwrap().air;
        for h in [0.0, 2000.0, 5000.0] {
            // The air at the station is that of the standard atmosphere.
            assert!((factor_in(&air, h) / altitude_factor(h) - 1.0).abs() < 1e-3, "{h}");
        }
        let hot = crate::weather::Air { temperature_c: 40.0, ..air };
        assert!((factor_in(&hot, 0.0) - (313.15f64 / 288.15).powf(0.4)).abs() < 1e-4);
    }

    #[test]
    fn large_drops_are_flat() {
        assert_eq!(axis_ratio(0.0), 0.9951);
        for (d, ratio) in [(1.0, 0.9886), (2.0, 0.9380), (3.0, 0.8655), (4.0, 0.7880), (6.0, 0.6565)] {
            assert!((axis_ratio(d) - ratio).abs() < 2e-3, "{d}: {}", axis_ratio(d));
        }
        assert!(axis_ratio(50.0) > 0.4);
    }

    #[test]
    fn streaks_are_speed_times_exposure() {
        let v = terminal_speed_m_s(1.0);
        assert!((streak_length_m(DVec3::Z * v, 1.0 / 60.0) - 0.067).abs() < 2e-4);
        let from_a_car = streak_length_m(DVec3::new(25.0, 0.0, v), 1.0 / 60.0);
        assert!((from_a_car - (25.0f64 * 25.0 + v * v).sqrt() / 60.0).abs() < 1e-12);
    }

    /// Compares with a fine fourth-order integration. An explicit step of the same length oscillates and then diverges.
    #[test]
    fn any_step_relaxes_exactly() {
        let (start, air) = (DVec3::new(3.0, -8.0, 5.0), DVec3::new(20.0, 4.0, -1.0));
        for terminal in [0.27, 0.72, 4.03, 9.17] {
            let settled = air - DVec3::Z * terminal;
            for dt in [1e-4, 1e-3, 1e-2, 0.1, 0.25, 1.0, 10.0] {
                let (velocity, moved) = relax(start, air, terminal, dt);
                let steps = (dt / terminal * GRAVITY_M_S2 * 200.0).ceil().max(20.0) as usize;
                let h = dt / steps as f64;
                let pull = |v: DVec3| (settled - v) * (GRAVITY_M_S2 / terminal);
                let (mut v, mut x) = (start, DVec3::ZERO);
                for _ in 0..steps {
                    let k1 = pull(v);
                    let k2 = pull(v + k1 * (h / 2.0));
                    let k3 = pull(v + k2 * (h / 2.0));
                    let k4 = pull(v + k3 * h);
                    x += (v + (k1 + k2 + k3) * (h / 6.0)) * h;
                    v += (k1 + (k2 + k3) * 2.0 + k4) * (h / 6.0);
                }
                assert!((velocity - v).length() < 1e-6, "{terminal} m/s, {dt} s: {velocity} against {v}");
                assert!((moved - x).length() < 1e-6 * (1.0 + x.length()), "{terminal} m/s, {dt} s: {moved} {x}");
                // Ten small steps give the result of one large step.
                let (mut v, mut x) = (start, DVec3::ZERO);
                for _ in 0..10 {
                    let (next, step) = relax(v, air, terminal, dt / 10.0);
                    (v, x) = (next, x + step);
                }
                assert!((v - velocity).length() < 1e-12 && (x - moved).length() < 1e-11 * (1.0 + x.length()));
            }
            let (fall, _) = relax(DVec3::ZERO, DVec3::ZERO, terminal, 10.0);
            assert!((fall.z / -terminal - 1.0).abs() < 1e-4);
            assert_eq!(relax(start, air, terminal, 0.0), (start, DVec3::ZERO));
        }
        assert_eq!(relax(start, air, 0.0, 0.5), (air, air * 0.5));
    }
}
