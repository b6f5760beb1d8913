//! Sinkage of plates and wheels in soil.

/// Least exponent of a set that is trusted beyond the range in which it was measured.
const LEAST_EXPONENT: f64 = 0.3;

/// Bekker's description of how a soil yields under a plate: p = (kc / b + kphi) z^n (Bekker 1956, 1969). p is the
/// pressure, kPa, b the shorter side of the plate, m, and z the sinkage, m.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SinkageSet {
    /// Cohesive modulus kc, kN/m^(n + 1). As part of a kind of soil it must lie in \[0, 1e6\].
    pub kc: f64,
    /// Frictional modulus kphi, kN/m^(n + 2). As part of a kind of soil it must lie in \[0.1, 1e8\].
    pub kphi: f64,
    /// Exponent n. As part of a kind of soil it must lie in \[0.1, 3\].
    pub n: f64,
}

/// Rigid wheel on soil.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WheelLoad {
    /// Load on the wheel, N.
    pub load_n: f64,
    /// Width, m.
    pub width_m: f64,
    /// Diameter, m.
    pub diameter_m: f64,
}

impl SinkageSet {
    /// Dry sand (Wong 2008, table 2.3, Land Locomotion Laboratory).
    pub const DRY_SAND: Self = Self { kc: 0.99, kphi: 1528.43, n: 1.1 };
    /// Sandy loam at 15 % moisture (Wong 2008, table 2.3).
    pub const SANDY_LOAM_15: Self = Self { kc: 5.27, kphi: 1515.04, n: 0.7 };
    /// Sandy loam at 22 % moisture (Wong 2008, table 2.3): a fit over a small range.
    pub const SANDY_LOAM_22: Self = Self { kc: 2.56, kphi: 43.12, n: 0.2 };
    /// Clayey soil at 38 % moisture (Wong 2008, table 2.3).
    pub const CLAYEY_38: Self = Self { kc: 13.19, kphi: 692.15, n: 0.5 };
    /// Sand of the Land Engineering Test Establishment (Wong 2008, table 2.3).
    pub const LETE_SAND: Self = Self { kc: 102.0, kphi: 5301.0, n: 0.79 };
    /// Upland sandy loam (Wong 2008, table 2.3).
    pub const UPLAND_LOAM: Self = Self { kc: 74.6, kphi: 2080.0, n: 1.1 };
    /// Snow, USA (Wong 2008, table 2.3).
    pub const SNOW_US: Self = Self { kc: 4.37, kphi: 196.72, n: 1.6 };
    /// Snow, Sweden (Wong 2008, table 2.3).
    pub const SNOW_SWEDEN: Self = Self { kc: 10.55, kphi: 66.08, n: 1.44 };

    /// Modulus for a plate whose shorter side is `width_m`, kN/m^(n + 2).
    fn modulus(&self, width_m: f64) -> f64 {
        self.kc / width_m + self.kphi
    }

    /// Returns the sinkage, m, of a plate whose shorter side is `width_m` under a pressure. The sinkage has no upper
    /// limit.
    pub fn plate_m(&self, width_m: f64, pressure_kpa: f64) -> f64 {
        libm::pow(pressure_kpa / self.modulus(width_m), 1.0 / self.n)
    }

    /// Returns the sinkage of a rigid wheel, m: z = (3 W / (b (3 - n) k sqrt(D)))^(2 / (2 n + 1)) (Bekker 1956; Wong
    /// 2008, eq. 2.41). W is the load, kN, b the width, m, D the diameter, m, and k = kc / b + kphi. The formula
    /// neglects terms of the second order in z / D, and is for moderate sinkage and n up to 1.3.
    pub fn wheel_m(&self, wheel: &WheelLoad) -> f64 {
        let resisted = wheel.width_m * (3.0 - self.n) * self.modulus(wheel.width_m) * wheel.diameter_m.sqrt();
        libm::pow(3e-3 * wheel.load_n / resisted, 2.0 / (2.0 * self.n + 1.0))
    }

    /// Returns the sinkage of a rigid wheel, m, at most half the wheel's radius, from the integral of the pressure over
    /// the wheel's arc: W = b int (k z^n dx) (Wong 2008, eq. 2.38), with the symbols of [`Self::wheel_m`].
    pub fn wheel_integral_m(&self, wheel: &WheelLoad) -> f64 {
        let (mut low, mut high) = (0.0, 0.25 * wheel.diameter_m);
        if self.wheel_load_n(wheel, high) <= wheel.load_n {
            return high;
        }
        for _ in 0..60 {
            let middle = 0.5 * (low + high);
            if self.wheel_load_n(wheel, middle) < wheel.load_n { low = middle } else { high = middle }
        }
        0.5 * (low + high)
    }

    /// Load that a wheel carries at a sinkage, N.
    fn wheel_load_n(&self, wheel: &WheelLoad, sinkage_m: f64) -> f64 {
        // Substitutes u = z0 sin^2(t) for the height above the lowest point, where z0 is the sinkage. Then z = z0
        // cos^2(t) and dx = (D - 2 u) / sqrt(D - u) sqrt(z0) cos(t) dt. The integrand is even and smooth, so the
        // midpoint rule converges fast.
        const PARTS: usize = 64;
        let diameter = wheel.diameter_m;
        let part = std::f64::consts::FRAC_PI_2 / PARTS as f64;
        let term = |i: usize| {
            let angle = (i as f64 + 0.5) * part;
            let (sine, cosine) = (libm::sin(angle), libm::cos(angle));
            let above = sinkage_m * sine * sine;
            libm::pow(sinkage_m * cosine * cosine, self.n) * (diameter - 2.0 * above) / (diameter - above).sqrt()
                * cosine
        };
        let sum: f64 = (0..PARTS).map(term).sum();
        1e3 * wheel.width_m * self.modulus(wheel.width_m) * sinkage_m.sqrt() * part * sum
    }

    /// Whether the set is a fit over a small range of sinkages, beyond which its results mean little.
    pub fn is_narrow(&self) -> bool {
        self.n < LEAST_EXPONENT
    }
}

/// Reece's description, with moduli without dimension: p = (c kc' + gamma b kphi') (z / b)^n (Reece 1964; Wong and
/// Reece 1967). p is the pressure, kPa, c the cohesion, kPa, gamma the weight of the soil, kN/m^3, b the shorter side
/// of the plate, m, and z the sinkage, m.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ReeceSet {
    /// Cohesive modulus kc'.
    pub kc: f64,
    /// Frictional modulus kphi'.
    pub kphi: f64,
    /// Exponent n.
    pub n: f64,
}

impl ReeceSet {
    /// Returns the sinkage, m, of a plate whose shorter side is `width_m` in soil of this cohesion, kPa, and density,
    /// kg/m^3.
    pub fn plate_m(&self, width_m: f64, pressure_kpa: f64, cohesion_kpa: f64, density_kg_m3: f64) -> f64 {
        let weight_kn_m3 = 1e-3 * density_kg_m3 * super::gravity::GRAVITY_M_S2;
        let modulus = cohesion_kpa * self.kc + weight_kn_m3 * width_m * self.kphi;
        width_m * libm::pow(pressure_kpa / modulus, 1.0 / self.n)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn plates_sink_as_in_the_tables() {
        for (set, sinkage) in [
            (SinkageSet::DRY_SAND, 0.0446),
            (SinkageSet::SANDY_LOAM_15, 0.0076),
            (SinkageSet::SANDY_LOAM_22, 1.31),
            (SinkageSet::CLAYEY_38, 0.0049),
            (SinkageSet::LETE_SAND, 0.0026),
            (SinkageSet::UPLAND_LOAM, 0.0320),
            (SinkageSet::SNOW_US, 0.415),
            (SinkageSet::SNOW_SWEDEN, 0.699),
        ] {
            let found = set.plate_m(0.6, 50.0);
            let digit = if sinkage > 1.0 {
                0.005
            } else if sinkage > 0.1 {
                0.0005
            } else {
                0.00005
            };
            assert!((found - sinkage).abs() <= digit, "{set:?}: {found}");
        }
        assert!((SinkageSet::SANDY_LOAM_22.plate_m(0.3, 100.0) - 27.0).abs() < 0.5);
        assert!(SinkageSet::SANDY_LOAM_22.is_narrow() && !SinkageSet::CLAYEY_38.is_narrow());
    }

    #[test]
    fn the_closed_form_of_a_wheel_is_near_its_integral() {
        let wheel = |load_n| WheelLoad { load_n, width_m: 0.4, diameter_m: 1.3 };
        let ratio = |set: SinkageSet, load_n: f64| set.wheel_m(&wheel(load_n)) / set.wheel_integral_m(&wheel(load_n));
        let ratios =
            [ratio(SinkageSet::DRY_SAND, 5e3), ratio(SinkageSet::CLAYEY_38, 5e3), ratio(SinkageSet::SNOW_US, 5e3)];
        assert!((ratios[0] - 1.0).abs() < 0.05 && (0.88..0.98).contains(&ratios[1]), "{ratios:?}");
        assert!((1.05..1.3).contains(&ratios[2]), "{ratios:?}");
        // For n = 1 and small sinkage, the load is 2/3 b k z sqrt(D z).
        let even = SinkageSet { kc: 0.0, kphi: 1e5, n: 1.0 };
        let wanted_n = 1e3 * 0.4 * 1e5 * 1e-4 * (1.3e-4f64).sqrt() * 2.0 / 3.0;
        assert!((even.wheel_load_n(&wheel(0.0), 1e-4) / wanted_n - 1.0).abs() < 1e-3);
    }

    #[test]
    fn reece_s_moduli_scale_with_the_plate() {
        let set = ReeceSet { kc: 20.0, kphi: 500.0, n: 1.0 };
        // Without cohesion and for n = 1 the width cancels.
        let sinkage = |width| set.plate_m(width, 40.0, 0.0, 1600.0);
        assert!((sinkage(0.1) / sinkage(0.5) - 1.0).abs() < 1e-12);
        assert!((sinkage(0.2) - 40.0 / (1.6 * 9.81 * 500.0)).abs() < 1e-12);
    }
}
