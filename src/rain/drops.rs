//! The physics of falling drops in f64: sizes, numbers, speeds, and what follows from them. The truth that the picture, the
//! queries and the tests call.

use std::f64::consts::PI;

use crate::weather::Falling;

/// Smallest and largest drop, mm: drizzle's and the size at which drops break up.
pub const DIAMETERS_MM: (f64, f64) = (0.1, 6.0);

/// Terminal speed in still air at sea level, diameter (mm) and speed (m/s): Gunn and Kinzer 1949.
#[rustfmt::skip]
const GUNN_KINZER: [(f64, f64); 36] = [
    (0.0, 0.0), (0.078, 0.18), (0.1, 0.27), (0.2, 0.72), (0.3, 1.17), (0.4, 1.62), (0.5, 2.06), (0.6, 2.47), (0.7, 2.87),
    (0.8, 3.27), (0.9, 3.67), (1.0, 4.03), (1.2, 4.64), (1.4, 5.17), (1.6, 5.65), (1.8, 6.09), (2.0, 6.49), (2.2, 6.90),
    (2.4, 7.27), (2.6, 7.57), (2.8, 7.82), (3.0, 8.06), (3.2, 8.26), (3.4, 8.44), (3.6, 8.60), (3.8, 8.72), (4.0, 8.83),
    (4.2, 8.92), (4.4, 8.98), (4.6, 9.03), (4.8, 9.07), (5.0, 9.09), (5.2, 9.12), (5.4, 9.14), (5.6, 9.16), (5.8, 9.17),
];

/// Terminal speed of a drop at sea level, m/s: Gunn and Kinzer's table, straight between its entries and level beyond them.
pub fn terminal_speed_m_s(diameter_mm: f64) -> f64 {
    let i = GUNN_KINZER.partition_point(|e| e.0 < diameter_mm).clamp(1, GUNN_KINZER.len() - 1);
    let ((a, va), (b, vb)) = (GUNN_KINZER[i - 1], GUNN_KINZER[i]);
    va + (vb - va) * ((diameter_mm - a) / (b - a)).clamp(0.0, 1.0)
}

/// How much faster drops fall at an altitude than at sea level: (rho0 / rho)^0.4 (Foote and du Toit 1969), the density that of
/// the standard atmosphere up to 11 km and held above.
pub fn altitude_factor(altitude_m: f64) -> f64 {
    let h = altitude_m.clamp(-500.0, 11_000.0);
    let density = libm::pow(1.0 - 0.0065 * h / 288.15, 4.255_88);
    libm::pow(density, -0.4)
}

/// Height over width of a falling drop: Brandes, Zhang and Vivekanandan 2002, held to 1 for small ones.
pub fn axis_ratio(diameter_mm: f64) -> f64 {
    let d = diameter_mm;
    (0.9951 + d * (0.0251 + d * (-0.036_44 + d * (0.005_303 - d * 0.000_249_2)))).clamp(0.5, 1.0)
}

/// An exponential distribution of drops over diameter, N0 exp(-lambda D) per m^3 and mm, cut at [`DIAMETERS_MM`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Spectrum {
    /// Per m^3 and mm.
    pub n0: f64,
    /// Per mm.
    pub lambda: f64,
}

impl Spectrum {
    /// Of rain at a rate, mm/h: Marshall and Palmer's (1948) slope, 4.1 R^-0.21 per mm, with as many drops as make that rate
    /// at Gunn and Kinzer's speeds (their own N0 makes 5 to 18 % more). None falls at rate 0.
    pub fn rain(rate_mm_h: f64) -> Option<Self> {
        Self::of_rate(rate_mm_h, 4.1 * libm::pow(rate_mm_h, -0.21))
    }

    /// Of drizzle: Joss, Thams and Waldvogel 1968, 5.7 R^-0.21 per mm, likewise.
    pub fn drizzle(rate_mm_h: f64) -> Option<Self> {
        Self::of_rate(rate_mm_h, 5.7 * libm::pow(rate_mm_h, -0.21))
    }

    fn of_rate(rate_mm_h: f64, lambda: f64) -> Option<Self> {
        // Below a thousandth of a millimetre an hour lambda runs away and not one drop falls in a minute.
        (rate_mm_h >= 1e-3).then(|| {
            let raw = Self { n0: 1.0, lambda };
            Self { n0: rate_mm_h / raw.rate_mm_h(), lambda }
        })
    }

    /// Drops with diameters (mm) in between, per m^3.
    pub fn number_between(&self, from_mm: f64, to_mm: f64) -> f64 {
        let (low, high) = (from_mm.max(DIAMETERS_MM.0), to_mm.min(DIAMETERS_MM.1));
        if high <= low {
            return 0.0;
        }
        let at = |d: f64| libm::exp(-self.lambda * d);
        self.n0 / self.lambda * (at(low) - at(high))
    }

    /// Integral of `weight(D)` over the drops of 1 m^3, D in mm: the midpoint rule, 0.01 % off for powers up to 6.
    pub fn integral(&self, weight: impl Fn(f64) -> f64) -> f64 {
        const N: usize = 1200;
        let (low, high) = DIAMETERS_MM;
        let h = (high - low) / N as f64;
        (0..N).map(|i| low + (i as f64 + 0.5) * h).map(|d| self.n0 * libm::exp(-self.lambda * d) * h * weight(d)).sum()
    }

    /// Rate at sea level, mm/h: the water that falls through level ground.
    pub fn rate_mm_h(&self) -> f64 {
        self.integral(|d| PI / 6.0 * d * d * d * terminal_speed_m_s(d)) * 3.6e-3
    }

    /// Water in the air, g/m^3.
    pub fn water_g_m3(&self) -> f64 {
        self.integral(|d| PI / 6.0 * d * d * d) * 1e-3
    }

    /// Extinction, 1/m: twice the drops' discs (geometric optics and diffraction, Q = 2).
    pub fn extinction_per_m(&self) -> f64 {
        self.integral(|d| PI / 2.0 * d * d) * 1e-6
    }

    /// Drops that land on level ground, per m^2 and s, with diameters from `from_mm` on.
    pub fn flux_above(&self, from_mm: f64) -> f64 {
        self.integral(|d| if d >= from_mm { terminal_speed_m_s(d) } else { 0.0 })
    }
}

/// The spectra that fall: rain's and drizzle's. Air that is thinner than at sea level holds fewer and faster drops for the same
/// rate ([`altitude_factor`]).
pub fn spectra(falling: &Falling) -> [Option<Spectrum>; 2] {
    [Spectrum::rain(falling.rain_mm_h), Spectrum::drizzle(falling.drizzle_mm_h)]
}

/// Velocity and way of a drop that starts with velocity `v` against the air and approaches its terminal speed `terminal`
/// downwards: linear drag, exact for any step `dt >= 0`. Answers (velocity, displacement), up positive.
pub fn relax(v: f64, terminal: f64, dt: f64) -> (f64, f64) {
    let tau = terminal / GRAVITY;
    let gone = -libm::expm1(-dt / tau);
    let off = v + terminal;
    (v - off * gone, -terminal * dt + off * tau * gone)
}

/// m/s^2.
const GRAVITY: f64 = 9.806_65;

#[cfg(test)]
mod tests {
    use super::*;
    use crate::weather::hydrometeors::rain_extinction_per_m;

    #[test]
    fn terminal_speeds_are_gunn_and_kinzers_and_rise() {
        for (d, v) in [(0.1, 0.27), (1.0, 4.03), (2.0, 6.49), (3.0, 8.06), (5.8, 9.17)] {
            assert!((terminal_speed_m_s(d) - v).abs() < 1e-9, "{d}");
        }
        let all: Vec<f64> = (0..700).map(|i| terminal_speed_m_s(f64::from(i) * 0.01)).collect();
        assert!(all.windows(2).all(|w| w[1] >= w[0]) && all[0] == 0.0);
        // Atlas, Srivastava and Sekhon 1973 fit the same measurements.
        for i in 6..=58 {
            let d = f64::from(i) * 0.1;
            let fit = 9.65 - 10.3 * (-0.6 * d).exp();
            assert!((terminal_speed_m_s(d) / fit - 1.0).abs() < 0.02, "{d}");
        }
    }

    #[test]
    fn drops_fall_faster_in_thin_air() {
        for (h, want) in [(0.0, 1.0), (2000.0, 1.082), (5000.0, 1.226)] {
            assert!((altitude_factor(h) - want).abs() < 0.003, "{h}: {}", altitude_factor(h));
        }
    }

    #[test]
    fn the_rate_closes_at_any_rate() {
        for rate in [0.02, 0.3, 1.0, 7.0, 25.0, 100.0, 400.0] {
            for s in [Spectrum::rain(rate).unwrap(), Spectrum::drizzle(rate).unwrap()] {
                assert!((s.rate_mm_h() / rate - 1.0).abs() < 1e-9);
                // The sum of what classes hold is the whole, and the rule is fine enough.
                let classes: f64 =
                    (0..59).map(|i| s.number_between(0.1 + 0.1 * f64::from(i), 0.2 + 0.1 * f64::from(i))).sum();
                assert!((classes / s.number_between(0.0, 9.0) - 1.0).abs() < 1e-9);
                assert!((s.integral(|_| 1.0) / s.number_between(0.0, 9.0) - 1.0).abs() < 1e-3, "{rate}");
            }
        }
        // The published N0 makes this much more than the rate it is for.
        for (rate, factor) in [(1.0f64, 1.183), (10.0, 1.164), (25.0, 1.131)] {
            let n0 = Spectrum::rain(rate).unwrap().n0;
            assert!((8000.0 / n0 / factor - 1.0).abs() < 0.01, "{rate}: {n0}");
        }
        assert!(Spectrum::rain(0.0).is_none());
    }

    #[test]
    fn extinction_is_the_weathers() {
        for rate in [0.1, 1.0, 5.0, 20.0, 100.0] {
            let ours = Spectrum::rain(rate).unwrap().extinction_per_m();
            assert!((ours / rain_extinction_per_m(rate) - 1.0).abs() < 0.01, "{rate}: {ours}");
        }
        // Heavier rain has larger drops: its water grows faster than its extinction.
        let (a, b) = (Spectrum::rain(1.0).unwrap(), Spectrum::rain(50.0).unwrap());
        assert!(b.water_g_m3() / a.water_g_m3() > b.extinction_per_m() / a.extinction_per_m());
        assert!((0.05..0.08).contains(&a.water_g_m3()), "{} g/m^3 at 1 mm/h", a.water_g_m3());
    }

    #[test]
    fn drag_is_exact_for_any_step() {
        for terminal in [0.3, 2.0, 9.0] {
            for total in [1e-4, 0.1, 1.0, 10.0] {
                let once = relax(0.0, terminal, total);
                let (mut v, mut x) = (0.0, 0.0);
                for _ in 0..1000 {
                    let (next, way) = relax(v, terminal, total / 1000.0);
                    (v, x) = (next, x + way);
                }
                assert!((once.0 - v).abs() < 1e-9 * terminal && (once.1 - x).abs() < 1e-9 * (1.0 + x.abs()));
                assert!(once.0 <= 0.0 && once.0 >= -terminal, "no step makes it overshoot");
            }
            assert!((relax(-terminal, terminal, 3.0).0 + terminal).abs() < 1e-12);
        }
    }

    #[test]
    fn drops_flatten_as_they_grow() {
        assert!((axis_ratio(0.5) - 1.0).abs() < 0.01 && (axis_ratio(5.0) - 0.7).abs() < 0.04, "{}", axis_ratio(5.0));
    }
}
