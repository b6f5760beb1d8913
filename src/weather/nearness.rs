//! Nearness of two weathers: whether their pictures differ by little.

use super::{
    conditions::{AerosolLayer, CloudSlab, Conditions, GroundLayer, SeaState, SurfaceCover, WindProfile},
    precipitation::Falling,
};

/// Value that a picture shows, and the lower limit of the reference value in [`Conditions::is_near`], in the same unit.
type SeenValue = [f64; 2];

/// Lower limit of the reference value of quantities between 0 and 1: if other quantities may change by 5 %, these may
/// change by at least 0.02.
const SHARE: f64 = 0.4;

impl Conditions {
    /// Whether every quantity that a picture shows differs from that of `other` by at most `share` of a reference
    /// value. This is the larger of both quantities, but at least the lower limit in [`SeenValue`].
    pub(crate) fn is_near(&self, other: &Self, share: f64) -> bool {
        let near =
            |([a, least], [b, _]): (SeenValue, SeenValue)| (a - b).abs() <= share * a.abs().max(b.abs()).max(least);
        let slabs = self.clouds.iter().zip(&other.clouds).filter(|(a, b)| a.cover > 0.0 || b.cover > 0.0);
        self.shown().zip(other.shown()).all(near)
            && slabs.flat_map(|(a, b)| a.shown().into_iter().zip(b.shown())).all(near)
    }

    /// Returns what a picture shows of everything but the cloud slots.
    fn shown(&self) -> impl Iterator<Item = SeenValue> {
        let light = &self.cloud_light;
        let rest = [
            [self.extinction_per_m, 1e-5],
            [self.air.rayleigh_extinction_per_m, 1e-5],
            [self.air.rayleigh_scale_height_m, 1.0],
            [self.clear_sky, SHARE],
            [light.weight, SHARE],
            [light.weight * light.direct, SHARE],
            [light.weight * light.diffuse, SHARE],
            [self.ozone_du, 100.0],
        ];
        let media = self.aerosol.shown().into_iter().chain(self.fog.shown()).chain(self.precipitation.shown());
        let below = self.wind.shown().into_iter().chain(self.sea.shown()).chain(self.surface.shown());
        rest.into_iter().chain(media).chain(below)
    }
}

impl AerosolLayer {
    fn shown(&self) -> [SeenValue; 6] {
        [
            [self.extinction_per_m, 1e-6],
            [self.angstrom_exponent, 2.0],
            [self.absorption_angstrom_exponent, 2.0],
            [self.single_scattering_albedo, SHARE],
            [self.asymmetry, SHARE],
            [self.scale_height_m, 100.0],
        ]
    }
}

impl GroundLayer {
    /// Returns what a picture shows of the layer. Without extinction its shape is not seen.
    fn shown(&self) -> [SeenValue; 10] {
        let share = if self.extinction_per_m > 0.0 { 1.0 } else { 0.0 };
        [
            [self.extinction_per_m, 1e-6],
            [self.angstrom_exponent * share, 2.0],
            [self.single_scattering_albedo * share, SHARE],
            [self.asymmetry * share, SHARE],
            [self.base_m * share, 1.0],
            [self.top_m * share, 1.0],
            [self.softness_m * share, 1.0],
            [self.coverage * share, SHARE],
            [self.patch_size_m * share, 5.0],
            [self.lifted * share, SHARE],
        ]
    }
}

impl Falling {
    fn shown(&self) -> [SeenValue; 11] {
        [
            [self.liquid_extinction_per_m, 1e-6],
            [self.solid_extinction_per_m, 1e-6],
            [self.rain_mm_h, 0.1],
            [self.drizzle_mm_h, 0.02],
            [self.snow_mm_h, 0.1],
            [self.ice_pellets_mm_h, 0.1],
            [self.hail_mm_h, 0.1],
            [self.grain_share, SHARE],
            [self.crystal_share, SHARE],
            [self.showers, SHARE],
            [self.thunder, SHARE],
        ]
    }
}

impl CloudSlab {
    /// Returns what a picture shows of the slab. Without cover its shape is not seen.
    fn shown(&self) -> [SeenValue; 10] {
        let share = if self.cover > 0.0 { 1.0 } else { 0.0 };
        [
            [self.cover, SHARE],
            [self.base_m * share, 50.0],
            [self.thickness_m * share, 50.0],
            [self.optical_depth * share, 1.0],
            [self.droplet_radius_um * share, 5.0],
            [self.convection * share, SHARE],
            [self.ice_fraction * share, SHARE],
            [self.scale_m * share, 100.0],
            [self.cellular * share, SHARE],
            [self.fibre * share, SHARE],
        ]
    }
}

impl WindProfile {
    fn shown(&self) -> [SeenValue; 4] {
        [[self.east_m_s, 10.0], [self.north_m_s, 10.0], [self.gust_m_s, 10.0], [self.up_m_s, 10.0]]
    }
}

impl SeaState {
    fn shown(&self) -> [SeenValue; 5] {
        let swell = self.swell_height_m;
        [
            [self.significant_wave_height_m, 0.5],
            [swell, 0.5],
            [swell * self.swell_east, 0.5],
            [swell * self.swell_north, 0.5],
            [self.swell_period_s, 5.0],
        ]
    }
}

impl SurfaceCover {
    fn shown(&self) -> [SeenValue; 4] {
        [[self.wetness, SHARE], [self.puddles, SHARE], [self.ice, SHARE], [self.snow_depth_m, 0.05]]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::weather::{Weather, derive};

    /// Conditions of two presets.
    fn two() -> [Conditions; 2] {
        ["clear", "thunderstorm"].map(|name| derive(&Weather::preset(name).expect("a preset")).expect("valid"))
    }

    #[test]
    fn a_weather_is_near_itself_and_far_from_another() {
        let [clear, storm] = two();
        assert!(clear.is_near(&clear, 0.0) && storm.is_near(&storm, 0.0));
        assert!(!clear.is_near(&storm, 0.05) && !storm.is_near(&clear, 0.05));
    }

    /// In a change of ten seconds, weathers a sixth of a second apart are near each other once the change is under way,
    /// and weathers a second apart are not.
    #[test]
    fn a_change_is_near_for_some_frames_and_not_for_long() {
        let [clear, hazy] = ["clear", "hazy"].map(|name| derive(&Weather::preset(name).unwrap()).unwrap());
        for share in [0.4, 0.6, 0.9] {
            let at = |later: f64| clear.lerp(&hazy, share + later);
            assert!(at(0.0).is_near(&at(0.016), 0.05), "{share}: ten frames later");
            assert!(!at(0.0).is_near(&at(0.1), 0.05), "{share}: a second later");
        }
    }

    #[test]
    fn every_part_of_a_weather_counts() {
        let [_, storm] = two();
        let mut changed: Vec<Conditions> = vec![storm; 7];
        changed[0].precipitation.rain_mm_h *= 1.1;
        changed[1].clouds.iter_mut().for_each(|slab| slab.base_m *= 1.1);
        changed[2].wind.east_m_s += 2.0;
        changed[3].surface.wetness -= 0.1;
        changed[4].aerosol.extinction_per_m *= 1.1;
        changed[5].fog.extinction_per_m += 1e-4;
        changed[6].sea.swell_height_m += 0.5;
        for (i, other) in changed.iter().enumerate() {
            assert!(!storm.is_near(other, 0.05), "change {i}");
        }
    }
}
