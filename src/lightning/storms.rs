//! Flashes near a place in an interval of time: those of the weather's cells, those of the host's cells, and those that
//! the host triggered.

use glam::{DVec2, DVec3};

use super::{flash::Flash, held::HeldLightning, light::LONGEST_S, schedule::Storm, trigger::FlashTrigger};
use crate::world::World;

/// Side of the map's squares that each have one storm cell in a thunderstorm, m: a common size of single cells (Byers
/// and Braham 1949).
pub(crate) const SQUARE_M: f64 = 20_000.0;
/// Radius of a storm cell of the weather, m: distance from its middle within which two thirds of its flashes start.
const RADIUS_M: f64 = 2500.0;
/// Flashes a minute of a cell where the weather has thunder and no rate is set: 1 to 5 are common (Rakov and Uman 2003,
/// chapter 2).
const PER_MINUTE: f64 = 3.0;

/// Flashes of a context.
#[derive(Clone, Copy)]
pub(crate) struct Storms<'a> {
    /// World of the context.
    pub world: &'a World,
    /// Settings and triggered flashes of the host.
    pub held: &'a HeldLightning,
}

impl Storms<'_> {
    /// Whether it is certain that no flash begins between two times.
    pub fn is_quiet(&self, from_s: f64, until_s: f64) -> bool {
        let set = &self.held.settings;
        let by_host = set.cells.iter().any(|c| c.flashes_per_minute > 0.0)
            || (set.cells.is_empty() && set.flashes_per_minute.is_some_and(|r| r > 0.0))
            || self.held.triggered.iter().any(|t| (from_s..until_s).contains(&t.time_s));
        let by_weather = set.cells.is_empty() && set.flashes_per_minute.is_none();
        let thunders = || self.world.timeline.is_ever_between(from_s, until_s, |c| c.precipitation.thunder > 0.0);
        !(by_host || by_weather && thunders())
    }

    /// Calls `see` with each flash that begins from `from_s` until `until_s` within `reach_m` of a place of the map,
    /// and with its trigger if it has one. The order is arbitrary.
    pub fn visit(
        &self,
        (near_m, reach_m): (DVec2, f64),
        (from_s, until_s): (f64, f64),
        mut see: impl FnMut(&Flash, Option<&FlashTrigger>),
    ) {
        if self.is_quiet(from_s, until_s) {
            return;
        }
        let is_near = |place: DVec2| (place - near_m).length() <= reach_m;
        for trigger in self.held.triggered.iter().filter(|t| (from_s..until_s).contains(&t.time_s)) {
            let flash = Storm::triggered(self.world.seed, trigger, self.world.map_at(trigger.position));
            if is_near(flash.place_m) {
                see(&flash, Some(trigger));
            }
        }
        let mut show = |flash: &Flash| {
            if is_near(flash.place_m) {
                see(flash, None);
            }
        };
        let set = &self.held.settings;
        for (i, cell) in set.cells.iter().enumerate() {
            let middle_m = self.world.map_at(cell.position);
            let per_minute = cell.flashes_per_minute;
            let storm = Storm { seed: self.seed(i as i64, i64::MIN), per_minute, middle_m, radius_m: cell.radius_m };
            storm.visit(from_s, until_s, |_| per_minute, &mut show);
        }
        if set.cells.is_empty() {
            self.visit_squares((near_m, reach_m), (from_s, until_s), &mut show);
        }
    }

    /// Calls `show` with the flashes of the weather's storm cells, one cell in each square of the map.
    fn visit_squares(
        &self,
        (near_m, reach_m): (DVec2, f64),
        (from_s, until_s): (f64, f64),
        show: &mut impl FnMut(&Flash),
    ) {
        let timeline = &self.world.timeline;
        let steady = (!timeline.changes_between(from_s, until_s)).then(|| timeline.at(until_s).precipitation.thunder);
        let rate = |time_s: f64| match (self.held.settings.flashes_per_minute, steady) {
            (Some(rate), _) => rate,
            (None, Some(thunder)) => PER_MINUTE * thunder,
            (None, None) => PER_MINUTE * timeline.at(time_s).precipitation.thunder,
        };
        // Fewer than one flash in 10 000 starts farther than four radii from a cell's middle.
        let reach = DVec2::splat(reach_m + 4.0 * RADIUS_M);
        let (low, high) = (((near_m - reach) / SQUARE_M).floor(), ((near_m + reach) / SQUARE_M).floor());
        for j in low.y as i64..=high.y as i64 {
            for i in low.x as i64..=high.x as i64 {
                let middle_m = (DVec2::new(i as f64, j as f64) + 0.5) * SQUARE_M;
                let storm = Storm { seed: self.seed(i, j), per_minute: PER_MINUTE, middle_m, radius_m: RADIUS_M };
                storm.visit(from_s, until_s, rate, &mut *show);
            }
        }
    }

    /// Returns the seed of the storm cell with the indices (i, j).
    fn seed(&self, i: i64, j: i64) -> u64 {
        // A sum, because the xor of two products would often be the same for (i, j) and (-i, -j).
        let (i, j) = (i as u64, j as u64);
        let mixed = i.wrapping_mul(0xa076_1d64_78bd_642f).wrapping_add(j.wrapping_mul(0xe703_7ed1_a0b4_28db));
        self.world.seed ^ (mixed ^ (mixed >> 32)).wrapping_mul(0x8ebc_6af0_9c88_c6e3)
    }

    /// Returns the place on the map of a position in the host's world.
    pub fn on_map(&self, position: DVec3) -> DVec2 {
        self.world.map_at(position)
    }

    /// Returns the range of times at which those flashes begin that may give light between two times.
    pub fn begin_within(from_s: f64, until_s: f64) -> (f64, f64) {
        (from_s - LONGEST_S, until_s + super::light::BEFORE_S)
    }
}
