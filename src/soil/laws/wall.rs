//! Walls of undisturbed soil: how high a face of a given slope stands.

use std::f64::consts::{FRAC_PI_2, PI};

use super::gravity::GRAVITY_M_S2;

/// Strength of a soil, by which its faces stand.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WallLaw {
    /// Cohesion, kPa.
    pub cohesion_kpa: f64,
    /// Friction angle, radians.
    pub friction: f64,
    /// Density, kg/m^3.
    pub density_kg_m3: f64,
}

impl WallLaw {
    /// Height 4 c / gamma that scales all heights, m. c is the cohesion, and gamma the weight of the soil per volume.
    fn scale_m(&self) -> f64 {
        4e3 * self.cohesion_kpa / (self.density_kg_m3 * GRAVITY_M_S2)
    }

    /// Returns the height at which an upright face fails, m: 4 c / gamma tan(45 + phi/2), on a plane of failure through
    /// its toe (Culmann 1875). phi is the friction angle, c the cohesion, and gamma the weight of the soil per volume.
    pub fn critical_height_m(&self) -> f64 {
        self.scale_m() * libm::tan(0.25 * PI + 0.5 * self.friction)
    }

    /// Returns the height, m, at which a face of the slope beta, radians, fails: 4 c / gamma sin(beta) cos(phi) / (1 -
    /// cos(beta - phi)) (Culmann 1875), with c and gamma as in [`Self::critical_height_m`]. The height is infinite for
    /// slopes up to the friction angle phi.
    pub fn face_height_m(&self, slope: f64) -> f64 {
        if slope <= self.friction {
            return f64::INFINITY;
        }
        let half = libm::sin(0.5 * (slope - self.friction));
        self.scale_m() * libm::sin(slope) * libm::cos(self.friction) / (2.0 * half * half)
    }

    /// Returns the steepest slope at which a face of this height stands, radians.
    pub fn steepest_slope(&self, height_m: f64) -> f64 {
        if height_m <= self.critical_height_m() {
            return FRAC_PI_2;
        }
        self.bisected(|slope| self.face_height_m(slope) > height_m)
    }

    /// Returns the height, m, of the highest face whose toe lies `toe_m` in front of its crest.
    pub fn height_over_m(&self, toe_m: f64) -> f64 {
        if toe_m <= 0.0 {
            return self.critical_height_m();
        }
        let run_m = |slope: f64| self.face_height_m(slope) * libm::cos(slope) / libm::sin(slope);
        let slope = self.bisected(|slope| run_m(slope) > toe_m);
        toe_m * libm::tan(slope)
    }

    /// Slope between the friction angle and upright up to which `is_flat` holds.
    fn bisected(&self, is_flat: impl Fn(f64) -> bool) -> f64 {
        let (mut low, mut high) = (self.friction, FRAC_PI_2);
        for _ in 0..60 {
            let middle = 0.5 * (low + high);
            if is_flat(middle) { low = middle } else { high = middle }
        }
        0.5 * (low + high)
    }
}

/// Highest faces of a soil by the distance of the toe in cells.
#[derive(Clone, Debug, PartialEq)]
pub struct WallTable {
    /// Heights for toes 0, 1, 2, .. cells in front of the crest, m.
    pub heights_m: Vec<f64>,
}

impl WallTable {
    /// Creates the table for toes up to `most_cells` cells away.
    pub fn new(law: &WallLaw, cell_m: f64, most_cells: usize) -> Self {
        Self { heights_m: (0..=most_cells).map(|cells| law.height_over_m(cells as f64 * cell_m)).collect() }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn law(cohesion_kpa: f64, friction_deg: f64, weight_kn_m3: f64) -> WallLaw {
        WallLaw { cohesion_kpa, friction: friction_deg.to_radians(), density_kg_m3: 1e3 * weight_kn_m3 / GRAVITY_M_S2 }
    }

    #[test]
    fn walls_stand_as_high_as_published() {
        let soil = law(5.0, 30.0, 17.0);
        assert!((soil.critical_height_m() - 2.038).abs() < 5e-4);
        assert!((soil.steepest_slope(3.0).to_degrees() - 78.11).abs() < 5e-3);
        for (toe, height) in [(0.0, 2.04), (0.5, 2.82), (1.0, 3.49), (2.0, 4.68), (4.0, 6.78), (8.0, 10.49)] {
            assert!((soil.height_over_m(toe) - height).abs() < 6e-3, "{toe}: {}", soil.height_over_m(toe));
        }
        let soil = law(10.0, 25.0, 18.0);
        for (slope, height) in [(90.0f64, 3.488), (75.0, 5.446), (60.0, 9.645), (45.0, 23.61)] {
            assert!((soil.face_height_m(slope.to_radians()) / height - 1.0).abs() < 4e-4, "{slope}");
        }
    }

    #[test]
    fn soil_without_cohesion_stands_at_its_friction_angle() {
        let sand = law(0.0, 33.0, 16.0);
        assert_eq!(sand.critical_height_m(), 0.0);
        assert!((sand.height_over_m(2.0) - 2.0 * 33f64.to_radians().tan()).abs() < 1e-9);
        assert!(law(5.0, 30.0, 17.0).face_height_m(0.5).is_infinite());
        let table = WallTable::new(&law(5.0, 30.0, 17.0), 0.5, 4);
        assert_eq!(table.heights_m.len(), 5);
        assert!((table.heights_m[4] - 4.68).abs() < 6e-3 && table.heights_m.is_sorted());
    }
}
