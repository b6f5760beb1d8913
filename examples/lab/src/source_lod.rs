//! Level of detail of an older system, for comparison: drops get fewer and larger with distance, and a few copies stand
//! around each.
//!
//! The number falls linearly with distance (per metre of distance, to 0 at the container's end), and the size grows
//! with the square of the distance. Copies stand at random positions around their seed. Neither law accounts for the
//! light hidden by the omitted drops. The system's description leaves the growth open. Here it is set so that all drops
//! together hide as much as the rain does, which is the best the law can do.

use glam::DVec3;

use welkin::rain::{
    Classes,
    lattice::{Drop, random3},
};

/// Drops nearer than this are not drawn, m.
const NEAREST_M: f64 = 0.25;
/// Distance of copies from their seed, m.
const SPREAD_M: f64 = 0.5;

/// Drops in a ball around the camera.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SourceLod {
    /// Number of simulated drops.
    pub seeds: u32,
    /// Copies of each drop, 0 to 6.
    pub copies: u32,
    /// Radius of the ball, m.
    pub reach_m: f64,
}

impl Default for SourceLod {
    fn default() -> Self {
        Self { seeds: 20_000, copies: 0, reach_m: 16.0 }
    }
}

impl SourceLod {
    /// Number of drops drawn.
    pub fn drop_count(&self) -> u32 {
        self.seeds * (1 + self.copies)
    }

    /// Relative increase in diameter from a drop at the camera to one at the ball's end. It is chosen so that all drops
    /// together hide as much as rain of `classes` hides over the same distance.
    pub fn growth(&self, classes: &Classes) -> f64 {
        // Mean over the linear law of (1 + k d^2)^2 / (4 pi (R d)^2), times the discs.
        let (discs, all) = classes.flux.iter().filter(|c| c.1 > 0.0).fold((0.0, 0.0), |(discs, all), c| {
            let number = c.2 / c.1;
            (discs + number * std::f64::consts::FRAC_PI_4 * c.0 * c.0 * 1e-6, all + number)
        });
        if all <= 0.0 {
            return 0.0;
        }
        let scale = f64::from(self.drop_count()) * discs / all / (4.0 * std::f64::consts::PI * self.reach_m.powi(2));
        let wanted = 0.5 * classes.extinction_per_m * (self.reach_m - NEAREST_M);
        let steps = 4000;
        let first = NEAREST_M / self.reach_m;
        let moments = (0..steps).fold([0.0; 3], |m, i| {
            let h = (1.0 - first) / f64::from(steps);
            let d = first + (f64::from(i) + 0.5) * h;
            let w = 2.0 * (1.0 - d) * h / (d * d);
            [m[0] + w, m[1] + 2.0 * w * d * d, m[2] + w * d.powi(4)]
        });
        // moments[0] + k moments[1] + k^2 moments[2] = wanted / scale.
        let c = moments[0] - wanted / scale;
        if c >= 0.0 {
            return 0.0;
        }
        (-moments[1] + (moments[1] * moments[1] - 4.0 * moments[2] * c).sqrt()) / (2.0 * moments[2])
    }

    /// Drops around a camera at an arbitrary moment, because only their statistics are compared. Each hides its own,
    /// larger disc; `share` is 1.
    pub fn drops(&self, classes: &Classes, seed: u64) -> Vec<Drop> {
        let seed = (seed ^ (seed >> 32)) as u32;
        let growth = self.growth(classes);
        let all = classes.table.last().map_or(0.0, |row| f64::from(row[2]));
        let part = |r: u32| (f64::from(r) + 0.5) / 4_294_967_296.0;
        let mut list = Vec::with_capacity(self.drop_count() as usize);
        for index in 0..self.seeds {
            let [a, b, c] = random3([seed, 0xcafe, index]).map(part);
            let [kind, ..] = random3([seed, 0xcaff, index]).map(part);
            let class = classes.table.partition_point(|row| f64::from(row[2]) <= kind * all);
            let diameter_m = f64::from(classes.table[class.min(classes.table.len() - 1)][0]);
            // Number per metre of distance: 2 (1 - d).
            let distance = self.reach_m * (1.0 - (1.0 - a).sqrt());
            let (z, turn) = (2.0 * b - 1.0, std::f64::consts::TAU * c);
            let across = (1.0 - z * z).sqrt();
            let seed_m = DVec3::new(across * turn.cos(), across * turn.sin(), z) * distance;
            for copy in 0..=self.copies {
                let jitter = DVec3::from(random3([seed, 0xc0b0 + copy, index]).map(part)) * 2.0 - 1.0;
                let position_m = seed_m + if copy > 0 { jitter * SPREAD_M } else { DVec3::ZERO };
                let d = position_m.length() / self.reach_m;
                if (NEAREST_M / self.reach_m..=1.0).contains(&d) {
                    let diameter_m = diameter_m * (1.0 + growth * d * d);
                    let id = (copy, class as u32, index);
                    list.push(Drop { id, place: [0; 3], position_m, diameter_m, share: 1.0 });
                }
            }
        }
        list
    }
}

#[cfg(test)]
mod tests {
    use welkin::weather::{Precipitation, PrecipitationKind, Weather, derive};

    use super::*;

    fn classes(rate: f64) -> Classes {
        let weather = Weather { precipitation: Precipitation::of(PrecipitationKind::Rain, rate), ..Weather::default() };
        Classes::new(&derive(&weather).unwrap().precipitation, 1.0, u32::MAX)
    }

    #[test]
    fn drops_thin_out_linearly_with_distance_and_together_hide_what_the_rain_hides() {
        let (lod, classes) = (SourceLod::default(), classes(20.0));
        let drops = lod.drops(&classes, 3);
        let mut rings = [0.0; 8];
        for d in &drops {
            rings[(d.position_m.length() / lod.reach_m * 8.0) as usize] += 1.0;
        }
        for (i, n) in rings.iter().enumerate().skip(1) {
            let want = f64::from(lod.seeds) * (15.0 - 2.0 * i as f64) / 64.0;
            assert!((n - want).abs() < 5.0 * f64::sqrt(want), "ring {i}: {n} of {want}");
        }
        for lod in [lod, SourceLod { copies: 6, ..lod }] {
            let drops = lod.drops(&classes, 3);
            let hidden: f64 = drops.iter().map(|d| (0.25 * d.diameter_m / d.position_m.length()).powi(2)).sum();
            let want = 0.5 * classes.extinction_per_m * (lod.reach_m - NEAREST_M);
            assert!((hidden / want - 1.0).abs() < 0.1, "{} copies: {hidden} of {want}", lod.copies);
        }
    }

    #[test]
    fn more_drops_need_to_grow_less() {
        let classes = classes(20.0);
        let growth = |seeds| SourceLod { seeds, ..SourceLod::default() }.growth(&classes);
        assert!(growth(20_000) > growth(140_000) && growth(140_000) > growth(1_000_000));
        assert_eq!(growth(u32::MAX / 8), 0.0);
    }
}
