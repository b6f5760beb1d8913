//! Straight paths through regions, divided into pieces on which the shares of regions are constant or nearly so.

use glam::DVec3;

use super::{
    field::{RegionOnPlan, RegionsOver},
    merge::RegionsHere,
    region::{HeldRegion, PlanPoint},
};
use crate::{error::Result, scene::WorldFrame};

/// Largest half length of a piece in a perimeter, as a share of the perimeter, unless the weight hardly changes
/// ([`EVEN`]).
const PIECE_SHARE: f64 = 1.0 / 64.0;
/// Largest half length of a piece at a border without perimeter, m.
const STEP_M: f64 = 5e-4;
/// Change of a weight, from the middle of a piece to either end, below which the weight counts as constant. Such a
/// piece has a half length of at most the perimeter.
const EVEN: f64 = 1e-3;
/// Factor by which a point of a piece may lie farther from the middle than the ends of the piece do: on the plan a
/// straight path is slightly bent.
const BENT: f64 = 1.05;

/// Straight path through regions.
pub(crate) struct RegionWay<'a> {
    /// Regions that the path may meet.
    over: RegionsOver<'a>,
    start: DVec3,
    /// Unit vector along the path, in the host's world.
    direction: DVec3,
    length_m: f64,
}

/// Stretch of a path on the plan of a region.
struct PlanStretch {
    /// Distances of the stretch's start, middle and end from the border, m, negative inside.
    distances_m: [f64; 3],
    /// Half length on the plan times [`BENT`], m.
    reach_m: f64,
}

impl RegionOnPlan<'_> {
    fn stretch(&self, points: &[PlanPoint; 3]) -> PlanStretch {
        let [a, b, c] = points.each_ref().map(|point| self.axes.plan(point));
        let reach_m = BENT * (b - a).length().max((c - b).length());
        PlanStretch { distances_m: [a, b, c].map(|p| self.region.plan.distance_m(p)), reach_m }
    }

    /// Whether the weight is the same on all of a stretch.
    fn is_constant(&self, stretch: &PlanStretch) -> bool {
        let middle = stretch.distances_m[1];
        middle <= -stretch.reach_m || middle >= self.region.plan.perimeter_m + stretch.reach_m
    }

    /// Whether the weight at the middle of a stretch may be used for the whole stretch.
    fn is_fine(&self, stretch: &PlanStretch) -> bool {
        let perimeter_m = self.region.plan.perimeter_m;
        if self.is_constant(stretch) || stretch.reach_m <= (PIECE_SHARE * perimeter_m).max(STEP_M) {
            return true;
        }
        let [a, b, c] = stretch.distances_m.map(|d| self.region.plan.weight(d));
        stretch.reach_m <= perimeter_m && (a - b).abs().max((c - b).abs()) < EVEN
    }
}

impl<'a> RegionWay<'a> {
    /// Finds the regions that a path may meet. `direction` is a unit vector in the host's world.
    pub fn new(
        regions: &'a [HeldRegion],
        world: &'a WorldFrame,
        start: DVec3,
        direction: DVec3,
        length_m: f64,
        time_s: f64,
    ) -> Self {
        let mut way = Self { over: RegionsOver::new(regions, world, time_s), start, direction, length_m };
        let whole = way.points(0.0, length_m);
        way.over.list.retain(|on| {
            let stretch = on.stretch(&whole);
            stretch.distances_m[1] < on.region.plan.perimeter_m + stretch.reach_m
        });
        way
    }

    /// Whether the path can meet no region.
    pub fn is_empty(&self) -> bool {
        self.over.is_empty()
    }

    /// Returns the regions that the path may meet. The indices in the [`RegionsHere`] of a piece refer to this order.
    pub fn regions(&self) -> impl Iterator<Item = &'a HeldRegion> {
        self.over.list.iter().map(|on| on.region)
    }

    /// Returns start, middle and end of a stretch of the path.
    fn points(&self, from_m: f64, to_m: f64) -> [PlanPoint; 3] {
        [from_m, 0.5 * (from_m + to_m), to_m].map(|s| PlanPoint::new(self.over.world, self.start + self.direction * s))
    }

    /// Calls `visit` for each piece in order, with its ends, m, and the regions that act on it.
    ///
    /// # Errors
    /// The first error of `visit`.
    pub fn pieces(&self, mut visit: impl FnMut([f64; 2], &RegionsHere<'a>) -> Result<()>) -> Result<()> {
        let mut rest = vec![[0.0, self.length_m]];
        while let Some([from_m, to_m]) = rest.pop() {
            let points = self.points(from_m, to_m);
            let stretches = self.over.list.iter().map(|on| (on, on.stretch(&points)));
            let is_short = to_m - from_m <= 1e-10 * self.length_m;
            if !is_short && stretches.clone().any(|(on, stretch)| !on.is_fine(&stretch)) {
                let middle = 0.5 * (from_m + to_m);
                rest.extend([[middle, to_m], [from_m, middle]]);
                continue;
            }
            let mut here = RegionsHere::NONE;
            for (index, (on, stretch)) in stretches.enumerate() {
                here.add(index, on.region, on.region.plan.weight(stretch.distances_m[1]));
            }
            visit([from_m, to_m], &here)?;
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{
        regions::{RegionPlan, RegionShape, WeatherRegion},
        weather::WeatherParts,
    };

    /// Returns the integral of the weight of a region along a way, by pieces, and the number of pieces.
    fn by_pieces(plan: RegionPlan, start: DVec3, end: DVec3) -> (f64, usize) {
        let region = WeatherRegion { plan, has: WeatherParts::FOG, ..WeatherRegion::default() };
        let held = [HeldRegion::new(&region, 0.0).unwrap()];
        let (world, way) = (WorldFrame::default(), end - start);
        let way = RegionWay::new(&held, &world, start, way.normalize(), way.length(), 0.0);
        let (mut sum, mut last, mut count) = (0.0, 0.0, 0);
        way.pieces(|[from_m, to_m], here| {
            assert_eq!(from_m, last, "pieces follow each other");
            last = to_m;
            count += 1;
            sum += (1.0 - here.shares(WeatherParts::FOG).base) * (to_m - from_m);
            Ok(())
        })
        .unwrap();
        (sum, count)
    }

    #[test]
    fn the_pieces_integrate_a_weight_as_a_dense_sum_does() {
        let shapes = [
            RegionShape::Ellipse { half_m: [3000.0, 800.0] },
            RegionShape::Rectangle { half_m: [900.0, 2000.0], corner_radius_m: 300.0 },
        ];
        let ways = [
            [DVec3::new(-9000.0, -7000.0, 2.0), DVec3::new(8000.0, 9000.0, 400.0)],
            [DVec3::new(-9000.0, 1100.0, 2.0), DVec3::new(9000.0, 1100.0, 2.0)],
            [DVec3::new(0.0, 0.0, 2.0), DVec3::new(0.0, 20_000.0, 5000.0)],
            [DVec3::new(3200.0, 0.0, 0.0), DVec3::new(3200.0, 0.0, 9000.0)],
        ];
        for shape in shapes {
            for perimeter_m in [0.0, 20.0, 600.0] {
                let plan = RegionPlan { shape, perimeter_m, heading_deg: 33.0, ..RegionPlan::default() };
                for [a, b] in ways {
                    let axes = plan.at(&WorldFrame::default(), 0.0);
                    let steps = 400_000;
                    let at = |i: i32| {
                        let p = a.lerp(b, (f64::from(i) + 0.5) / f64::from(steps));
                        plan.weight(plan.distance_m(axes.plan(&PlanPoint::new(&WorldFrame::default(), p))))
                    };
                    let dense = (0..steps).map(at).sum::<f64>() * (b - a).length() / f64::from(steps);
                    let (sum, count) = by_pieces(plan, a, b);
                    assert!(
                        (sum - dense).abs() < 2e-5 * dense + 0.06,
                        "{shape:?} {perimeter_m}: {sum} against {dense}"
                    );
                    assert!(count < 700, "{shape:?} {perimeter_m}: {count} pieces");
                }
            }
        }
    }

    #[test]
    fn a_way_that_no_region_meets_has_few_pieces_and_a_grazing_one_is_found() {
        let thin = RegionShape::Rectangle { half_m: [2.0, 5000.0], corner_radius_m: 0.0 };
        let plan = RegionPlan { shape: thin, perimeter_m: 0.0, ..RegionPlan::default() };
        let (sum, count) = by_pieces(plan, DVec3::new(-80_000.0, 10.0, 1.0), DVec3::new(90_000.0, 10.0, 1.0));
        assert!((sum - 4.0).abs() < 2e-3 && count < 200, "{sum} in {count} pieces");
        let (sum, count) = by_pieces(plan, DVec3::new(-80_000.0, 9000.0, 1.0), DVec3::new(90_000.0, 9000.0, 1.0));
        assert!(sum == 0.0 && count < 10, "{sum} in {count} pieces");
    }
}
