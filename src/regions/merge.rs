//! Shares of regions in the weather of a place, and the merged weather.

use glam::DVec3;

use super::region::{HeldRegion, MAX_WEATHER_REGIONS, PlanPoint};
use crate::{
    scene::WorldFrame,
    weather::{Conditions, WeatherParts},
};

/// Region that acts at a place.
#[derive(Clone, Copy)]
struct ActingRegion<'a> {
    /// Index of the region in the list that it was taken from.
    index: usize,
    region: &'a HeldRegion,
    /// Weight, above 0.
    weight: f64,
}

/// Regions that act at a place, in the order of the world's list.
#[derive(Clone)]
pub(crate) struct RegionsHere<'a> {
    list: [Option<ActingRegion<'a>>; MAX_WEATHER_REGIONS],
    count: usize,
}

/// Shares of the world's weather and of acting regions in one part of the weather. Their sum is 1.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct PartShares {
    /// Share of the world's weather.
    pub base: f64,
    /// Share of each acting region, in the order of [`RegionsHere`].
    each: [f64; MAX_WEATHER_REGIONS],
}

impl<'a> RegionsHere<'a> {
    /// No regions.
    pub const NONE: Self = Self { list: [None; MAX_WEATHER_REGIONS], count: 0 };

    /// Finds the regions that act at a position and time.
    pub fn new(regions: &'a [HeldRegion], world: &WorldFrame, position: DVec3, time_s: f64) -> Self {
        let point = PlanPoint::new(world, position);
        let mut here = Self::NONE;
        for (index, region) in regions.iter().enumerate() {
            here.add(index, region, region.plan.weight_at(world, &point, time_s));
        }
        here
    }

    /// Adds a region, if its weight is above 0.
    pub(super) fn add(&mut self, index: usize, region: &'a HeldRegion, weight: f64) {
        if weight > 0.0 {
            self.list[self.count] = Some(ActingRegion { index, region, weight });
            self.count += 1;
        }
    }

    /// Whether no region acts here.
    pub fn is_empty(&self) -> bool {
        self.count == 0
    }

    /// Returns the shares in one part of the weather; see [`crate::regions`].
    pub fn shares(&self, part: WeatherParts) -> PartShares {
        let mut shares = PartShares { base: 1.0, each: [0.0; MAX_WEATHER_REGIONS] };
        let mut weights = [0.0; MAX_WEATHER_REGIONS];
        for (k, acting) in self.list.iter().flatten().enumerate().filter(|(_, acting)| acting.region.has.has(part)) {
            let (w, left) = (acting.weight, 1.0 - acting.weight);
            shares.base *= left;
            if !acting.region.merges.has(part) {
                shares.each[..k].iter_mut().chain(&mut weights[..k]).for_each(|share| *share *= left);
                shares.each[k] = w;
                continue;
            }
            weights[k] = w;
            let merging: f64 = (0..k).filter(|j| weights[*j] > 0.0).map(|j| shares.each[j]).sum();
            let together = 1.0 - (1.0 - merging) * left;
            let whole: f64 = weights[..=k].iter().sum();
            for (share, weight) in shares.each[..=k].iter_mut().zip(&weights) {
                *share = if *weight > 0.0 { together * (weight / whole) } else { *share * left };
            }
        }
        shares
    }

    /// Iterates over the acting regions with a share above 0. Each item is the region's index in the list that it was
    /// taken from, the region, and its share.
    pub fn with_shares(&self, shares: PartShares) -> impl Iterator<Item = (usize, &'a HeldRegion, f64)> {
        let shared = self.list.iter().flatten().zip(shares.each);
        shared.filter(|(_, share)| *share > 0.0).map(|(acting, share)| (acting.index, acting.region, share))
    }

    /// Returns the world's weather `c` merged with the weathers of the regions here, part by part.
    pub fn merged(&self, c: &Conditions) -> Conditions {
        let parts: [Option<(WeatherParts, PartShares)>; 32] = {
            let mut singles = WeatherParts::ALL.singles().map(|part| (part, self.shares(part)));
            std::array::from_fn(|_| singles.next())
        };
        // The weighted mean of several weathers is computed by blends of two: the mean so far, and the next region's
        // weather. The weight of the latter is its share divided by the sum of the shares so far, its own included.
        let mut before = parts.map(|part| part.map_or(0.0, |(_, shares)| shares.base));
        let mut merged = *c;
        for (k, acting) in self.list.iter().flatten().enumerate() {
            let blends = parts.iter().zip(&mut before).filter_map(|(part, before)| {
                let (part, shares) = part.as_ref()?;
                let share = shares.each[k];
                *before += share;
                (share > 0.0).then(|| (*part, share / *before))
            });
            merged.blend_parts(&acting.region.conditions, blends);
        }
        merged
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{
        regions::{RegionPlan, WeatherRegion},
        weather::{Weather, Wind},
    };

    /// Returns regions around the origin. Each entry of `list` says whether the region merges its parts or covers
    /// others, its weight and its temperature.
    fn held(list: &[(bool, f64, f64)]) -> Vec<HeldRegion> {
        let one = |(merges, strength, temperature_c): &(bool, f64, f64)| WeatherRegion {
            plan: RegionPlan { strength: *strength, ..RegionPlan::default() },
            has: WeatherParts::TEMPERATURE | WeatherParts::WIND,
            merges: if *merges { WeatherParts::ALL } else { WeatherParts::NONE },
            weather: Weather {
                temperature_c: *temperature_c,
                wind: Wind::of(10.0, *temperature_c),
                ..Weather::default()
            },
            ..WeatherRegion::default()
        };
        list.iter().map(|r| HeldRegion::new(&one(r), 0.0).unwrap()).collect()
    }

    fn temperature_c(list: &[(bool, f64, f64)]) -> f64 {
        let regions = held(list);
        let here = RegionsHere::new(&regions, &WorldFrame::default(), DVec3::ZERO, 0.0);
        let shares = here.shares(WeatherParts::TEMPERATURE);
        let sum = shares.base + shares.each.iter().sum::<f64>();
        assert!((sum - 1.0).abs() < 1e-15, "{list:?}: {sum}");
        let base = crate::weather::derive(&Weather { temperature_c: 0.0, ..Weather::default() }).unwrap();
        here.merged(&base).air.temperature_c
    }

    #[test]
    fn the_last_wins_where_regions_cover_and_the_mean_holds_where_they_merge() {
        let close = |got: f64, want: f64| assert!((got - want).abs() < 1e-12, "{got} against {want}");
        close(temperature_c(&[(false, 1.0, 10.0), (false, 1.0, 20.0)]), 20.0);
        close(temperature_c(&[(false, 1.0, 10.0), (false, 0.5, 20.0)]), 15.0);
        close(temperature_c(&[(false, 0.5, 10.0)]), 5.0);
        close(temperature_c(&[(true, 1.0, 10.0), (true, 1.0, 20.0)]), 15.0);
        close(temperature_c(&[(true, 1.0, 10.0), (true, 0.5, 20.0)]), (10.0 + 0.5 * 20.0) / 1.5);
        close(temperature_c(&[(true, 0.5, 10.0), (true, 0.5, 20.0)]), 0.75 * 15.0);
        close(temperature_c(&[(true, 1.0, 10.0), (false, 1.0, 40.0), (true, 1.0, 20.0)]), 20.0);
        close(temperature_c(&[(true, 1.0, 10.0), (false, 0.5, 40.0), (true, 1.0, 20.0)]), (0.5 * 10.0 + 20.0) / 1.5);
        close(temperature_c(&[(false, 1.0, 40.0), (true, 0.5, 20.0)]), 30.0);
    }

    #[test]
    fn a_weight_that_vanishes_leaves_what_is_without_the_region() {
        for merges in [[true, true, true], [true, false, true], [false, true, false], [true, true, false]] {
            let with = |w: f64| temperature_c(&[(merges[0], 0.8, 10.0), (merges[1], w, 40.0), (merges[2], 0.7, 20.0)]);
            let without = temperature_c(&[(merges[0], 0.8, 10.0), (merges[2], 0.7, 20.0)]);
            assert!((with(1e-9) - without).abs() < 1e-6, "{merges:?}");
            assert!((with(0.3) - without).abs() > 0.1, "{merges:?}");
        }
    }

    #[test]
    fn wind_merges_as_a_vector() {
        let regions = held(&[(true, 1.0, 0.0), (true, 1.0, 60.0)]);
        let here = RegionsHere::new(&regions, &WorldFrame::default(), DVec3::ZERO, 0.0);
        let wind = here.merged(&crate::weather::derive(&Weather::default()).unwrap()).wind;
        assert!((wind.speed_m_s() - 10.0 * 30f64.to_radians().cos()).abs() < 1e-9, "{wind:?}");
        assert!((wind.from_deg() - 30.0).abs() < 1e-9, "{wind:?}");
    }
}
