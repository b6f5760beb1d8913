//! Blending of two `Conditions`: the weather during a change.
//!
//! Extinctions are blended so that visibility changes by equal factors in equal steps; most other quantities are
//! blended linearly. Each layer's geometry is weighted by the amount of the layer, so that a layer that fades in has
//! its final geometry as soon as it is visible. Every field is continuous in time, even in layers that come and go.

use super::conditions::{
    AerosolLayer, Air, CloudLightOverride, CloudSlab, Conditions, GroundLayer, SeaState, SurfaceCover, WindProfile,
    clear_between,
};
use super::mix::mix;
use super::precipitation::Falling;

/// Factor on the larger of two amounts. [`share`] adds the product to both, so that the geometry of an absent layer
/// keeps a small weight. While a layer fades in, its geometry changes mostly at about this share of its full amount,
/// too little to be seen. With 0 the geometry would jump when the layer begins.
const LEAST_SHARE: f64 = 1e-3;

/// Returns the weight of the second layer's geometry in a blend of two layers with the amounts `qa` and `qb`: (t qb) /
/// ((1 - t) qa + t qb). Before that, [`LEAST_SHARE`] of the larger amount is added to both.
fn share(qa: f64, qb: f64, t: f64) -> f64 {
    let least = LEAST_SHARE * qa.max(qb);
    let (a, b) = ((1.0 - t) * (qa + least), t * (qb + least));
    if a + b > 0.0 { b / (a + b) } else { t }
}

/// Lower limit of an extinction in [`geometric_weight`], 1/m. At any height that has weather the extinction of the air
/// is above this limit. A geometric mean needs values above 0.
const CLEAREST_PER_M: f64 = 1e-9;

/// Returns the weight w for which mix(a, b, w) = a^(1-t) b^t. Visibility then changes by equal factors in equal steps
/// of t, which is how differences of visibility are perceived (Weber and Fechner). `a` and `b` are raised to at least
/// [`CLEAREST_PER_M`].
pub(super) fn geometric_weight(a: f64, b: f64, t: f64) -> f64 {
    let log_ratio = libm::log(b.max(CLEAREST_PER_M) / a.max(CLEAREST_PER_M));
    let whole = libm::expm1(log_ratio);
    // At a ratio of 1 the quotient would be 0 / 0. Below a logarithm of 1e-9 it differs from t by less than 1e-9.
    if log_ratio.abs() < 1e-9 || !whole.is_finite() { t } else { libm::expm1(t * log_ratio) / whole }
}

/// Returns the sum of the extinctions of air, aerosol, fog and precipitation. The extinction inside the fog's layer
/// counts in full, even if the layer is shallow, patchy or above the station.
fn burden_per_m(c: &Conditions) -> f64 {
    c.air.rayleigh_extinction_per_m
        + c.aerosol.extinction_per_m
        + c.fog.extinction_per_m
        + c.precipitation.extinction_per_m()
}

impl Conditions {
    /// Returns the weather between `self` (at `t` = 0) and `other` (at `t` = 1). Outside 0 to 1 `t` is clamped, and NaN
    /// counts as 0.
    ///
    /// All extinctions share one weight, chosen so that the visibility changes by equal factors in equal steps of `t`.
    /// Cloud layers blend slot by slot: covers linearly, optical depth as tau / (tau + 10), which is nearly the share
    /// of the light that a cloud stops. While one overcast replaces another, the share of clear sky never exceeds that
    /// at the clearer end. Wind blends as a vector, so a turn by more than 90 degrees passes through a lull. The
    /// geometry and optics of a layer are weighted by its amount at each end. In the same way the kinds of snow are
    /// weighted by its rate, the swell's period and direction by its height, and the host's cloud light by its weight.
    /// Everything else is linear.
    pub fn lerp(&self, other: &Self, t: f64) -> Self {
        if t >= 1.0 {
            return *other;
        }
        if t.is_nan() || t <= 0.0 {
            return *self;
        }
        let w = geometric_weight(burden_per_m(self), burden_per_m(other), t);
        let clouds = std::array::from_fn(|i| self.clouds[i].blend(&other.clouds[i], t));
        Self {
            extinction_per_m: mix(self.extinction_per_m, other.extinction_per_m, w),
            air: self.air.blend(&other.air, t, w),
            aerosol: self.aerosol.blend(&other.aerosol, w),
            fog: self.fog.blend(&other.fog, w),
            precipitation: self.precipitation.blend(&other.precipitation, t, w),
            clear_sky: clear_between_ends([self, other], clear_between(&clouds), t),
            clouds,
            cloud_light: self.cloud_light.blend(&other.cloud_light, t),
            wind: self.wind.blend(&other.wind, t),
            sea: self.sea.blend(&other.sea, t),
            surface: self.surface.blend(&other.surface, t),
            ozone_du: mix(self.ozone_du, other.ozone_du, t),
        }
    }
}

/// Returns the share of clear sky at `t` between two weathers: `independent` minus an excess. `independent` is the
/// share that the blended layers would leave clear if they were placed independently. The excess of a weather is the
/// share that its layers would leave clear if placed independently, minus the actual share. The excess is interpolated
/// between the two weathers. The result is clamped to the range between their actual shares.
pub(super) fn clear_between_ends([a, b]: [&Conditions; 2], independent: f64, t: f64) -> f64 {
    let less = |c: &Conditions| clear_between(&c.clouds) - c.clear_sky();
    let ends = [a.clear_sky(), b.clear_sky()];
    (independent - mix(less(a), less(b), t)).clamp(ends[0].min(ends[1]), ends[0].max(ends[1]))
}

impl Air {
    fn blend(&self, other: &Self, t: f64, w: f64) -> Self {
        Self {
            temperature_c: mix(self.temperature_c, other.temperature_c, t),
            relative_humidity: mix(self.relative_humidity, other.relative_humidity, t),
            pressure_hpa: mix(self.pressure_hpa, other.pressure_hpa, t),
            station_pressure_hpa: mix(self.station_pressure_hpa, other.station_pressure_hpa, t),
            station_altitude_m: mix(self.station_altitude_m, other.station_altitude_m, t),
            rayleigh_density_ratio: mix(self.rayleigh_density_ratio, other.rayleigh_density_ratio, t),
            rayleigh_scale_height_m: mix(self.rayleigh_scale_height_m, other.rayleigh_scale_height_m, t),
            rayleigh_extinction_per_m: mix(self.rayleigh_extinction_per_m, other.rayleigh_extinction_per_m, w),
        }
    }
}

impl AerosolLayer {
    pub(super) fn blend(&self, other: &Self, w: f64) -> Self {
        let q = share(self.extinction_per_m, other.extinction_per_m, w);
        Self {
            extinction_per_m: mix(self.extinction_per_m, other.extinction_per_m, w),
            angstrom_exponent: mix(self.angstrom_exponent, other.angstrom_exponent, q),
            absorption_angstrom_exponent: mix(self.absorption_angstrom_exponent, other.absorption_angstrom_exponent, q),
            single_scattering_albedo: mix(self.single_scattering_albedo, other.single_scattering_albedo, q),
            asymmetry: mix(self.asymmetry, other.asymmetry, q),
            scale_height_m: mix(self.scale_height_m, other.scale_height_m, q),
            reference_altitude_m: mix(self.reference_altitude_m, other.reference_altitude_m, q),
        }
    }
}

impl GroundLayer {
    pub(super) fn blend(&self, other: &Self, w: f64) -> Self {
        let q = share(self.extinction_per_m, other.extinction_per_m, w);
        Self {
            extinction_per_m: mix(self.extinction_per_m, other.extinction_per_m, w),
            angstrom_exponent: mix(self.angstrom_exponent, other.angstrom_exponent, q),
            single_scattering_albedo: mix(self.single_scattering_albedo, other.single_scattering_albedo, q),
            asymmetry: mix(self.asymmetry, other.asymmetry, q),
            base_m: mix(self.base_m, other.base_m, q),
            top_m: mix(self.top_m, other.top_m, q),
            softness_m: mix(self.softness_m, other.softness_m, q),
            coverage: mix(self.coverage, other.coverage, q),
            patch_size_m: mix(self.patch_size_m, other.patch_size_m, q),
            lifted: mix(self.lifted, other.lifted, q),
        }
    }
}

impl Falling {
    pub(super) fn blend(&self, other: &Self, t: f64, w: f64) -> Self {
        let snow_mm_h = mix(self.snow_mm_h, other.snow_mm_h, t);
        // The shares of grains and crystals are weighted by the amount of snow at each end.
        let kind = |share: fn(&Self) -> f64| {
            let amount = mix(self.snow_mm_h * share(self), other.snow_mm_h * share(other), t);
            if snow_mm_h > 0.0 { (amount / snow_mm_h).clamp(0.0, 1.0) } else { share(other) }
        };
        Self {
            rain_mm_h: mix(self.rain_mm_h, other.rain_mm_h, t),
            drizzle_mm_h: mix(self.drizzle_mm_h, other.drizzle_mm_h, t),
            snow_mm_h,
            grain_share: kind(|f| f.grain_share),
            crystal_share: kind(|f| f.crystal_share),
            ice_pellets_mm_h: mix(self.ice_pellets_mm_h, other.ice_pellets_mm_h, t),
            hail_mm_h: mix(self.hail_mm_h, other.hail_mm_h, t),
            freezing: mix(self.freezing, other.freezing, t),
            showers: mix(self.showers, other.showers, t),
            thunder: mix(self.thunder, other.thunder, t),
            liquid_extinction_per_m: mix(self.liquid_extinction_per_m, other.liquid_extinction_per_m, w),
            solid_extinction_per_m: mix(self.solid_extinction_per_m, other.solid_extinction_per_m, w),
        }
    }
}

impl CloudSlab {
    /// Blends two slabs; see [`Conditions::lerp`].
    pub(crate) fn blend(&self, other: &Self, t: f64) -> Self {
        let q = share(self.cover, other.cover, t);
        let stopped = |tau: f64| tau / (tau + 10.0);
        let y = mix(stopped(self.optical_depth), stopped(other.optical_depth), q);
        Self {
            cover: mix(self.cover, other.cover, t),
            base_m: mix(self.base_m, other.base_m, q),
            thickness_m: mix(self.thickness_m, other.thickness_m, q),
            optical_depth: 10.0 * y / (1.0 - y),
            droplet_radius_um: mix(self.droplet_radius_um, other.droplet_radius_um, q),
            asymmetry: mix(self.asymmetry, other.asymmetry, q),
            convection: mix(self.convection, other.convection, q),
            ice_fraction: mix(self.ice_fraction, other.ice_fraction, q),
            scale_m: mix(self.scale_m, other.scale_m, q),
            cellular: mix(self.cellular, other.cellular, q),
            fibre: mix(self.fibre, other.fibre, q),
            wind_m_s: [0, 1].map(|i| mix(self.wind_m_s[i], other.wind_m_s[i], q)),
            life_s: mix(self.life_s, other.life_s, q),
        }
    }
}

impl CloudLightOverride {
    pub(super) fn blend(&self, other: &Self, t: f64) -> Self {
        let q = share(self.weight, other.weight, t);
        Self {
            weight: mix(self.weight, other.weight, t),
            direct: mix(self.direct, other.direct, q),
            diffuse: mix(self.diffuse, other.diffuse, q),
        }
    }
}

impl WindProfile {
    /// Blends two profiles; see [`Conditions::lerp`].
    pub(crate) fn blend(&self, other: &Self, t: f64) -> Self {
        Self {
            east_m_s: mix(self.east_m_s, other.east_m_s, t),
            north_m_s: mix(self.north_m_s, other.north_m_s, t),
            gust_m_s: mix(self.gust_m_s, other.gust_m_s, t),
            turbulence_intensity: mix(self.turbulence_intensity, other.turbulence_intensity, t),
            wander_deg: mix(self.wander_deg, other.wander_deg, t),
            roughness_length_m: mix(self.roughness_length_m, other.roughness_length_m, t),
            sea_roughness_length_m: mix(self.sea_roughness_length_m, other.sea_roughness_length_m, t),
            up_m_s: mix(self.up_m_s, other.up_m_s, t),
        }
    }
}

impl SeaState {
    pub(super) fn blend(&self, other: &Self, t: f64) -> Self {
        let q = share(self.swell_height_m, other.swell_height_m, t);
        Self {
            significant_wave_height_m: mix(self.significant_wave_height_m, other.significant_wave_height_m, t),
            given_share: mix(self.given_share, other.given_share, t),
            swell_height_m: mix(self.swell_height_m, other.swell_height_m, t),
            swell_period_s: mix(self.swell_period_s, other.swell_period_s, q),
            swell_east: mix(self.swell_east, other.swell_east, q),
            swell_north: mix(self.swell_north, other.swell_north, q),
            temperature_c: mix(self.temperature_c, other.temperature_c, t),
        }
    }
}

impl SurfaceCover {
    pub(super) fn blend(&self, other: &Self, t: f64) -> Self {
        Self {
            wetness: mix(self.wetness, other.wetness, t),
            puddles: mix(self.puddles, other.puddles, t),
            ice: mix(self.ice, other.ice, t),
            snow_depth_m: mix(self.snow_depth_m, other.snow_depth_m, t),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::{CloudKind, CloudLayer, Fog, FogKind, Weather, derive};
    use super::*;

    fn clear() -> Conditions {
        derive(&Weather { visibility_m: 10_000.0, ..Weather::default() }).unwrap()
    }

    fn fog() -> Conditions {
        derive(&Weather { visibility_m: 150.0, fog: Fog::of(FogKind::Fog), ..Weather::default() }).unwrap()
    }

    #[test]
    fn blending_is_exact_at_its_ends_and_constant_beyond_them() {
        let (a, b) = (clear(), fog());
        assert_eq!((a.lerp(&b, 0.0), a.lerp(&b, 1.0)), (a, b));
        assert_eq!((a.lerp(&b, -3.0), a.lerp(&b, f64::NAN), a.lerp(&b, 7.0)), (a, a, b));
        assert_eq!(a.lerp(&a, 0.37), a, "nothing changes between equals");
    }

    #[test]
    fn visibility_falls_by_equal_factors_and_its_parts_stay_its_parts() {
        let (a, b) = (clear(), fog());
        for i in 0..=10 {
            let t = f64::from(i) / 10.0;
            let c = a.lerp(&b, t);
            let expected = 10_000.0 * (150.0f64 / 10_000.0).powf(t);
            assert!((c.visibility_m() / expected - 1.0).abs() < 1e-9, "{t}: {} against {expected}", c.visibility_m());
            let parts = c.air.rayleigh_extinction_per_m + c.aerosol.extinction_per_m + c.fog.extinction_per_m;
            assert!((parts / c.extinction_per_m - 1.0).abs() < 1e-12);
        }
    }

    #[test]
    fn the_weight_is_geometric_and_survives_equal_ends() {
        for (a, b) in [(1e-5, 0.05), (0.05, 1e-5), (1.0, 1.0 + 1e-7), (2.0, 2.0), (1.0, 1.0 + 1e-12)] {
            for t in [0.0, 0.1, 0.5, 0.9, 1.0] {
                let w = geometric_weight(a, b, t);
                let expected = a * f64::powf(b / a, t);
                assert!((mix(a, b, w) / expected - 1.0).abs() < 1e-9 && (0.0..=1.0).contains(&w), "{a} {b} {t}: {w}");
            }
        }
    }

    #[test]
    fn a_layer_that_fades_in_stands_where_it_will_stay() {
        let (a, b) = (clear(), fog());
        let early = a.lerp(&b, 0.01).fog;
        assert!(early.extinction_per_m > 0.0 && early.coverage == 1.0);
        assert!(early.top_m > 0.3 * b.fog.top_m, "a thousandth of the fog: {}", early.top_m);
        let top_m = a.lerp(&b, 0.3).fog.top_m;
        assert!((top_m / b.fog.top_m - 1.0).abs() < 0.03, "{top_m}");
        let cloudy = Weather { clouds: vec![CloudLayer::of(CloudKind::Stratus, 1.0, 250.0)], ..Weather::default() };
        let c = derive(&cloudy).unwrap();
        let half = a.lerp(&c, 0.5).clouds[0];
        assert!(half.cover == 0.5 && (half.base_m - 250.0).abs() < 1.0, "{half:?}");
        assert!((half.optical_depth / c.clouds[0].optical_depth - 1.0).abs() < 5e-3, "{half:?}");
    }

    #[test]
    fn low_cloud_and_high_cloud_do_not_turn_into_each_other() {
        let of = |kind, base| {
            derive(&Weather { clouds: vec![CloudLayer::of(kind, 1.0, base)], ..Weather::default() }).unwrap()
        };
        let (low, high) = (of(CloudKind::Stratus, 300.0), of(CloudKind::Cirrus, 9000.0));
        let half = low.lerp(&high, 0.5);
        let seen: Vec<(f64, f64)> = half.cloud_slabs().map(|s| (s.cover, (s.base_m / 100.0).round())).collect();
        assert_eq!(seen, [(0.5, 3.0), (0.5, 90.0)]);
        assert_eq!((half.cloud_cover(), half.clear_sky), (1.0, 0.0), "one overcast comes for another");
        let under = half.cloud_light(0.7, 0.2);
        let [low, high] = [low, high].map(|c| c.cloud_light(0.7, 0.2));
        assert!(under.direct < high.direct && under.direct + under.diffuse > low.direct + low.diffuse, "{under:?}");
    }

    #[test]
    fn a_turn_of_the_wind_passes_through_a_lull() {
        let of = |from| derive(&Weather { wind: super::super::Wind::of(8.0, from), ..Weather::default() }).unwrap();
        let half = of(90.0).lerp(&of(270.0), 0.5).wind;
        assert!(half.speed_m_s() < 1e-9);
        let quarter = of(0.0).lerp(&of(90.0), 0.5).wind;
        assert!((quarter.from_deg() - 45.0).abs() < 1e-9);
    }

    #[test]
    fn the_share_between_two_zeros_is_that_of_the_time() {
        assert_eq!(share(0.0, 0.0, 0.3), 0.3);
        assert!(share(0.0, 2.0, 0.3) > 0.995 && share(2.0, 0.0, 0.3) < 0.005);
        assert_eq!((share(0.0, 2.0, 0.0), share(2.0, 0.0, 1.0)), (0.0, 1.0), "and begin as nothing");
    }
}
