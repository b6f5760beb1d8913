//! Physics of drops on glass, in f64 with `libm`, so that its tables have the same bits everywhere.

use std::f64::consts::PI;

use crate::falling::sizes::{DropSizes, LARGEST_MM, SMALLEST_MM};

/// Surface tension of water against air at 20 C, N/m (IAPWS 2014).
pub const SURFACE_TENSION: f64 = 0.0728;
/// Density of water, kg/m^3.
pub const WATER: f64 = 998.0;
/// Density of air, kg/m^3.
const AIR: f64 = 1.2;
/// Viscosity of water at 20 C, Pa s.
const VISCOSITY: f64 = 1.0e-3;
/// Acceleration of gravity, m/s^2.
pub const GRAVITY: f64 = 9.81;
/// Contact angle for the shape and volume of beads, degrees. It lies between the receding and the advancing angle.
pub const CONTACT_DEG: f64 = 50.0;
/// Advancing contact angle of water on glass in use, degrees. Clean glass has less than 20, waxed glass more than 80;
/// road film lies between.
const ADVANCING_DEG: f64 = 62.0;
/// Receding contact angle, degrees.
const RECEDING_DEG: f64 = 32.0;
/// Share of the retention that remains under a running bead or on wet glass.
const MOVING_RETENTION: f64 = 0.5;
/// Increase of the capillary number per increase of the Bond number in [`speed_m_s`]. With it beads run some
/// centimetres a second on upright glass.
const MOBILITY: f64 = 0.003;
/// Drag coefficient of a sessile drop for the air's speed at its height. With it a drop of 10 uL on level glass starts
/// to move near 13 m/s, about as Milne & Amirfazli (2009) measured.
const DRAG: f64 = 0.35;
/// Number of diameter classes between the smallest and largest raindrop.
const CLASSES: usize = 295;
/// Width of a class, mm.
const STEP_MM: f64 = (LARGEST_MM - SMALLEST_MM) / CLASSES as f64;

/// Returns the ratio of the volume of a spherical cap to the cube of its contact radius: pi (2 - 3 c + c^3) / (3 s^3),
/// with the cosine c and the sine s of the contact angle.
pub fn volume_factor() -> f64 {
    let (s, c) = libm::sincos(CONTACT_DEG.to_radians());
    PI * (2.0 - 3.0 * c + c * c * c) / (3.0 * s * s * s)
}

/// Returns the contact radius of a bead, m, for its volume, m^3.
pub fn radius_m(volume_m3: f64) -> f64 {
    libm::cbrt(volume_m3 / volume_factor())
}

/// Returns the force along the glass that holds a bead at rest, N: gamma w (cos receding - cos advancing) with the
/// width w = 2 r (Furmidge 1962, eq. 1).
pub fn retention_n(radius_m: f64) -> f64 {
    let difference = libm::cos(RECEDING_DEG.to_radians()) - libm::cos(ADVANCING_DEG.to_radians());
    SURFACE_TENSION * 2.0 * radius_m * difference
}

/// Returns the force of the air along the glass on a bead, N: 1/2 rho C A u |u|, with the air's density rho and speed
/// u, the drag coefficient C (`DRAG`) and the cap's frontal area A.
pub fn drag_n(radius_m: f64, airflow_m_s: f64) -> f64 {
    let theta = CONTACT_DEG.to_radians();
    let (s, c) = libm::sincos(theta);
    let area = radius_m * radius_m * (theta - s * c) / (s * s);
    0.5 * AIR * DRAG * area * airflow_m_s * airflow_m_s.abs()
}

/// Returns the speed of a bead that runs or lies on wet glass, m/s, under the driving force `drive_n`. Above the Bond
/// number at which the bead stops, the capillary number rises linearly with the Bond number (Le Grand, Daerr and Limat
/// 2005). The capillary number is viscosity x speed / gamma. A Bond number here is a force divided by gamma V^(1/3),
/// with the surface tension gamma and the volume V.
pub fn speed_m_s(volume_m3: f64, drive_n: f64) -> f64 {
    let excess = drive_n - MOVING_RETENTION * retention_n(radius_m(volume_m3));
    if excess <= 0.0 {
        return 0.0;
    }
    SURFACE_TENSION / VISCOSITY * MOBILITY * excess / (SURFACE_TENSION * libm::cbrt(volume_m3))
}

/// Returns the volume that evaporates from a bead, m^3/s, by diffusion from a sessile cap: `V' = pi r D c (1 - H) (0.27
/// theta^2 + 1.30) / rho` (Hu & Larson 2002, eq. 19), times the factor of Ranz and Marshall (1952) for moving air. D is
/// the diffusivity of vapour in air, m^2/s; c the density of saturated vapour and rho that of water, kg/m^3; H the
/// relative humidity; theta the contact angle, rad.
pub fn evaporation_m3_s(radius_m: f64, relative_humidity: f64, temperature_c: f64, airflow_m_s: f64) -> f64 {
    // Diffusivity of vapour in air, m^2/s.
    const DIFFUSIVITY: f64 = 2.5e-5;
    // Kinematic viscosity of air, m^2/s.
    const AIR_VISCOSITY: f64 = 1.5e-5;
    // Saturation vapour density, Magnus formula (WMO 2008) over R_v T.
    let kelvin = temperature_c + 273.15;
    let saturation = 611.2 * libm::exp(17.62 * temperature_c / (243.12 + temperature_c)) / (461.5 * kelvin);
    let theta = CONTACT_DEG.to_radians();
    let still = PI * radius_m * DIFFUSIVITY * saturation * (1.0 - relative_humidity).max(0.0);
    let reynolds = 2.0 * radius_m * airflow_m_s.abs() / AIR_VISCOSITY;
    let passed = 1.0 + 0.3 * libm::sqrt(reynolds) * 0.85;
    still * (0.27 * theta * theta + 1.30) * passed / WATER
}

/// Returns the volume of a drop, m^3, for its diameter, mm.
pub fn drop_volume_m3(d: f64) -> f64 {
    PI / 6.0 * d * d * d * 1e-9
}

/// Drops that hit a surface, by diameter.
#[derive(Clone, Debug, PartialEq)]
pub struct Arrivals {
    /// Diameter, mm, and number of drops per m^2 and second of each class, from the largest diameter down.
    pub classes: [(f64, f64); CLASSES],
    /// Number of drops, 1/(m^2 s).
    pub number_m2_s: f64,
    /// Volume of water, m^3/(m^2 s).
    pub water_m_s: f64,
}

impl Arrivals {
    /// Creates the arrivals on a surface from a share of the rain. `normal_up` is the upward component of the surface's
    /// outward normal, and `approach_m_s` its speed outwards against the air. Each size arrives with the speed fall x
    /// normal_up + approach.
    pub fn of(rain: &DropSizes, share: f64, normal_up: f64, approach_m_s: f64) -> Self {
        let mut arrivals = Self { classes: [(0.0, 0.0); CLASSES], number_m2_s: 0.0, water_m_s: 0.0 };
        for (i, class) in arrivals.classes.iter_mut().enumerate() {
            let to = LARGEST_MM - i as f64 * STEP_MM;
            let d = to - 0.5 * STEP_MM;
            let number = share * rain.number_between(to - STEP_MM, to);
            let flux = number * (rain.speed_m_s(d) * normal_up + approach_m_s).max(0.0);
            *class = (d, flux);
            arrivals.number_m2_s += flux;
            arrivals.water_m_s += flux * drop_volume_m3(d);
        }
        arrivals
    }
}

#[cfg(test)]
mod tests {
    use glam::DVec3;

    use super::*;

    /// Returns the contact radius above which gravity alone moves a bead on glass at this slope, m.
    fn critical_radius_m(slope_deg: f64) -> f64 {
        let pull = WATER * GRAVITY * volume_factor() * slope_deg.to_radians().sin();
        (retention_n(1.0) / pull).sqrt()
    }

    #[test]
    fn the_critical_bead_is_some_millimetres_wide() {
        // Drops of some tens of microlitres begin to slide on upright glass (ElSherbini & Jacobi 2006).
        let r = critical_radius_m(90.0);
        let microlitres = volume_factor() * r * r * r * 1e9;
        assert!((10.0..40.0).contains(&microlitres), "{r} m, {microlitres} uL");
        assert!(critical_radius_m(30.0) > 1.4 * r);
        let ten = radius_m(1e-8);
        let lets_go = (retention_n(ten) / drag_n(ten, 1.0)).sqrt();
        assert!((8.0..16.0).contains(&lets_go), "{lets_go} m/s");
    }

    #[test]
    fn glass_gets_the_drops_and_the_water_of_any_surface() {
        for rate in [0.1, 1.0, 10.0, 150.0, 500.0] {
            let rain = DropSizes::of_rain(rate, 1.0);
            for (up, approach) in [(1.0, 0.0), (0.0, 20.0), (0.5, 12.0), (0.5, -3.0), (-0.3, 5.0)] {
                let arrivals = Arrivals::of(&rain, 1.0, up, approach);
                let normal = DVec3::new(0.0, f64::sqrt(1.0 - up * up), up);
                let truth = rain.on_surface(normal, normal * -approach);
                let near = |a: f64, b: f64| (a - b).abs() <= 3e-3 * b;
                assert!(near(arrivals.number_m2_s, truth.drops_per_m2_s), "{rate} {up} {approach}");
                assert!(near(arrivals.water_m_s * 3.6e6, truth.rate_mm_h), "{rate} {up} {approach}");
            }
            assert_eq!(Arrivals::of(&rain, 1.0, 0.0, -5.0).number_m2_s, 0.0, "the lee side stays dry");
            assert_eq!(Arrivals::of(&rain, 0.0, 1.0, 5.0).number_m2_s, 0.0, "and a tunnel");
        }
        assert_eq!(Arrivals::of(&DropSizes::of_rain(0.0, 1.0), 1.0, 1.0, 30.0).number_m2_s, 0.0);
    }

    #[test]
    fn beads_run_centimetres_a_second_and_dry_in_minutes() {
        let volume = 3e-8;
        let speed = speed_m_s(volume, WATER * GRAVITY * volume);
        assert!((0.02..0.3).contains(&speed), "{speed}");
        assert_eq!(speed_m_s(1e-10, WATER * GRAVITY * 1e-10), 0.0);
        let r = 1e-3;
        let minutes = volume_factor() * r * r * r / evaporation_m3_s(r, 0.5, 20.0, 0.0) / 60.0;
        assert!((3.0..30.0).contains(&minutes), "{minutes}");
        assert_eq!(evaporation_m3_s(r, 1.0, 20.0, 9.0), 0.0);
    }
}
