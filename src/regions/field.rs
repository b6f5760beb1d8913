//! Regions at one time, for queries at many places: their axes are computed once.

use glam::DVec3;

use super::{
    merge::RegionsHere,
    region::{HeldRegion, PlanAxes, PlanPoint},
};
use crate::{scene::WorldFrame, weather::Conditions};

/// Weather regions at a time.
pub(crate) struct RegionsOver<'a> {
    /// Mapping from the host's coordinates to places.
    pub(super) world: &'a WorldFrame,
    /// Regions whose strength is above 0.
    pub(super) list: Vec<RegionOnPlan<'a>>,
}

/// Region with its axes at a time.
pub(super) struct RegionOnPlan<'a> {
    pub region: &'a HeldRegion,
    pub axes: PlanAxes,
}

impl<'a> RegionsOver<'a> {
    /// Computes the axes, at a time, of the regions whose strength is above 0.
    pub fn new(regions: &'a [HeldRegion], world: &'a WorldFrame, time_s: f64) -> Self {
        let acting = regions.iter().filter(|region| region.plan.strength > 0.0);
        let list = acting.map(|region| RegionOnPlan { region, axes: region.plan.at(world, time_s) }).collect();
        Self { world, list }
    }

    /// Whether no region acts.
    pub fn is_empty(&self) -> bool {
        self.list.is_empty()
    }

    /// Returns the weather at a position: the world's weather `c` at this time, merged with the weathers of the regions
    /// there.
    pub fn weather_at(&self, position: DVec3, c: &Conditions) -> Conditions {
        let point = PlanPoint::new(self.world, position);
        let mut here = RegionsHere::NONE;
        for (index, on) in self.list.iter().enumerate() {
            let plan = &on.region.plan;
            here.add(index, on.region, plan.weight(plan.distance_m(on.axes.plan(&point))));
        }
        if here.is_empty() { *c } else { here.merged(c) }
    }
}
