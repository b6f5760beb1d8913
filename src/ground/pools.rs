//! Water in the hollows of a terrain. Water that is poured into a pit fills it, spills into the next pit, and joins
//! with the water there (after the fill-spill-merge of Barnes, Callaghan and Wickert 2021). Evaporation and leakage
//! lower the level. All other steps conserve the water.

use super::basins::{Basins, OUT};

/// Mark in place of the volume of a hollow whose parts hold separate lakes.
const APART: f64 = -1.0;

/// Water in the hollows of a terrain.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Pools {
    /// Water in each hollow, mm times cells, including that of its parts; [`APART`] while its parts hold separate
    /// lakes.
    pub held: Vec<f64>,
    /// Scratch space of [`Pools::sink`]: for each hollow, the loss passed down from its larger hollow, which lost more
    /// water than it held above its parts.
    passed: Vec<f64>,
}

impl Pools {
    /// Creates dry pools.
    pub fn new(basins: &Basins) -> Self {
        let held = basins.list.iter().map(|b| if b.first_child == OUT { 0.0 } else { APART }).collect();
        Self { held, passed: vec![0.0; basins.list.len()] }
    }

    /// Creates the pools of a saved state; `None` if the saved water does not fit these hollows.
    pub fn from_held(basins: &Basins, held: Vec<f64>) -> Option<Self> {
        let sound = held.len() == basins.list.len()
            && held.iter().zip(&basins.list).all(|(h, b)| {
                let apart = b.first_child != OUT && *h == APART;
                apart || (b.base..=b.capacity).contains(h)
            });
        let passed = vec![0.0; held.len()];
        sound.then_some(Self { held, passed })
    }

    /// Returns whether no hollow has water.
    pub fn are_dry(&self) -> bool {
        self.held.iter().all(|h| *h <= 0.0)
    }

    /// Returns whether a hollow is full up to its rim.
    fn is_full(&self, basins: &Basins, basin: usize) -> bool {
        self.held[basin] >= basins.list[basin].capacity
    }

    /// Returns whether a hollow's water belongs to the water of its larger hollow.
    fn is_part(&self, basins: &Basins, basin: usize) -> bool {
        let parent = basins.list[basin].parent;
        parent != OUT && self.held[parent as usize] >= 0.0
    }

    /// Pours `water`, mm times cells, into a pit. Returns the part of this water that leaves the grid.
    pub fn pour(&mut self, basins: &Basins, pit: u32, water: f64) -> f64 {
        let (mut to, mut left) = (pit, water);
        while to != OUT && left > 0.0 {
            let mut basin = to as usize;
            while self.is_part(basins, basin) {
                basin = basins.list[basin].parent as usize;
            }
            let b = &basins.list[basin];
            let room = b.capacity - self.held[basin];
            if left < room {
                self.held[basin] += left;
                return 0.0;
            }
            left -= room.max(0.0);
            self.held[basin] = b.capacity;
            to = match b.parent {
                OUT => b.spills_to,
                whole if basins.parts(whole as usize).all(|part| self.is_full(basins, part)) => {
                    self.held[whole as usize] = basins.list[whole as usize].base;
                    whole
                }
                _ => b.spills_to,
            };
        }
        left
    }

    /// Lowers the level of all standing water by `depth_mm`. Returns the water lost, mm times cells.
    pub fn sink(&mut self, basins: &Basins, depth_mm: f64) -> f64 {
        let mut gone = 0.0;
        // Processes a hollow before its parts, although the parts precede it in the list: they bear the loss beyond the
        // hollow's own water.
        for basin in (0..self.held.len()).rev() {
            let passed = std::mem::take(&mut self.passed[basin]);
            if self.held[basin] <= 0.0 || self.is_part(basins, basin) {
                continue;
            }
            let b = &basins.list[basin];
            let lost = if passed > 0.0 { passed } else { depth_mm * basins.level(basin, self.held[basin]).1 };
            let left = self.held[basin] - lost;
            if passed == 0.0 {
                gone += lost;
            }
            if b.first_child == OUT {
                gone += left.min(0.0);
                self.held[basin] = left.max(0.0);
            } else if left >= b.base {
                self.held[basin] = left;
            } else {
                self.held[basin] = APART;
                gone -= self.pass(basins, basin, b.base - left);
            }
        }
        gone
    }

    /// Passes a loss of `water`, mm times cells, down to the parts of a hollow, in proportion to their surfaces when
    /// full. Returns the loss if no part can hold water, otherwise 0.
    fn pass(&mut self, basins: &Basins, basin: usize, water: f64) -> f64 {
        // Parts without a capacity of their own have no water.
        let holding = || basins.parts(basin).filter(|part| basins.list[*part].capacity > 0.0);
        let cells = |part: usize| basins.level(part, basins.list[part].capacity).1;
        let all: f64 = holding().map(cells).sum();
        holding().for_each(|part| self.passed[part] += water * cells(part) / all);
        if all > 0.0 { 0.0 } else { water }
    }

    /// Returns all water, mm times cells.
    #[cfg(test)]
    pub fn total(&self, basins: &Basins) -> f64 {
        let whole = |i: &usize| self.held[*i] > 0.0 && !self.is_part(basins, *i);
        (0..self.held.len()).filter(whole).map(|i| self.held[i]).sum()
    }

    /// Returns the larger hollow to whose water a hollow's water belongs; `None` if the hollow has separate water.
    pub fn whole_of(&self, basins: &Basins, basin: usize) -> Option<usize> {
        self.is_part(basins, basin).then(|| basins.list[basin].parent as usize)
    }

    /// Returns the water level in a hollow that is not part of another, mm; negative infinity while its parts hold
    /// separate lakes.
    pub fn level(&self, basins: &Basins, basin: usize) -> f64 {
        let held = self.held[basin];
        if held >= 0.0 { basins.level(basin, held).0 } else { f64::NEG_INFINITY }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::ground::basins::tests::rough;

    /// Returns the level of each basin's water, mm; where basins have joined, that of the joint pool.
    fn levels(pools: &Pools, basins: &Basins) -> Vec<f64> {
        let level = |mut basin: usize| {
            while let Some(whole) = pools.whole_of(basins, basin) {
                basin = whole;
            }
            pools.level(basins, basin)
        };
        (0..basins.list.len()).map(level).collect()
    }

    /// Creates basins of level ground with two pits, 0.3 m and 0.2 m deep. The saddle between the pits is 0.1 m below
    /// the ground.
    fn two_pits() -> Basins {
        let mut row = vec![0.0f32; 9];
        (row[2], row[3], row[4], row[5]) = (-0.3, -0.3, -0.1, -0.2);
        let heights: Vec<f32> = (0..5).flat_map(|y| if y == 2 { row.clone() } else { vec![0.0; 9] }).collect();
        Basins::new(&heights, 9)
    }

    #[test]
    fn a_pit_fills_spills_joins_and_runs_over() {
        let basins = two_pits();
        let deep: Vec<usize> = (0..basins.list.len()).filter(|i| basins.list[*i].capacity > 0.0).collect();
        let [a, b, whole] = deep[..] else { panic!("{basins:?}") };
        let mut pools = Pools::new(&basins);
        // Up to the saddle the deep pit holds 400; 60 spill into the other pit, which is then 0.06 m deep.
        assert_eq!(pools.pour(&basins, a as u32, 460.0), 0.0);
        let levels = self::levels(&pools, &basins);
        assert!((levels[a] + 100.0).abs() < 1e-3 && (levels[b] + 140.0).abs() < 1e-3, "{levels:?}");
        assert_eq!(levels[whole], f64::NEG_INFINITY);
        // Then both are one water, wherever it is poured in. 40 fill the second pit to the saddle; 40 more raise the 4
        // cells, with that of the saddle, by 10 mm.
        assert_eq!(pools.pour(&basins, b as u32, 40.0 + 40.0), 0.0);
        let levels = self::levels(&pools, &basins);
        assert!(deep.iter().all(|i| (levels[*i] + 90.0).abs() < 1e-3), "{levels:?}");
        // Above the saddle 400 fit in; the rest leaves.
        assert!((pools.pour(&basins, a as u32, 1000.0) - 640.0).abs() < 1e-3);
        assert!((pools.total(&basins) - 900.0).abs() < 1e-3);
        // Down by 120 mm: below the saddle the lakes part again, and each sinks on its own.
        assert!((pools.sink(&basins, 100.0) - 400.0).abs() < 1e-3);
        assert!((pools.sink(&basins, 20.0) - 80.0).abs() < 1e-3, "the saddle is dry: 4 cells give 20 each");
        assert!((pools.total(&basins) - 420.0).abs() < 1e-3);
        pools.sink(&basins, 1e9);
        assert!(pools.are_dry() && pools.total(&basins) == 0.0);
    }

    #[test]
    fn no_water_is_lost_on_a_rough_ground() {
        let (columns, rows) = (37, 31);
        let basins = Basins::new(&rough(columns, rows, 9), columns);
        let mut pools = Pools::new(&basins);
        let (mut given, mut out, mut gone) = (0.0, 0.0, 0.0);
        for round in 0..400 {
            for pit in basins.drains_to.iter().filter(|d| **d != OUT) {
                given += 0.9;
                out += pools.pour(&basins, *pit, 0.9);
            }
            if round > 200 {
                gone += pools.sink(&basins, 7.0);
            } else {
                gone += pools.sink(&basins, 1e-3);
            }
            let (sum, held) = (given - out - gone, pools.total(&basins));
            assert!((held - sum).abs() < 1e-9 * given, "round {round}: {held}, want {sum}");
            assert!(Pools::from_held(&basins, pools.held.clone()).is_some(), "round {round}");
        }
        assert!(out > 0.0 && gone > 0.0 && pools.held.contains(&APART));
        let mut broken = pools.held.clone();
        broken[0] = -0.5;
        assert!(Pools::from_held(&basins, broken).is_none());
        assert!(Pools::from_held(&basins, vec![0.0]).is_none());
        for _ in 0..200 {
            pools.sink(&basins, 7.0);
        }
        assert!(pools.are_dry());
    }

    #[test]
    fn a_ground_that_is_filled_shows_the_level_at_which_each_hollow_spills() {
        let (columns, rows) = (30, 30);
        let basins = Basins::new(&rough(columns, rows, 3), columns);
        let mut pools = Pools::new(&basins);
        let pits: Vec<u32> = basins.drains_to.iter().copied().filter(|d| *d != OUT).collect();
        for _ in 0..3 {
            pits.iter().for_each(|pit| {
                pools.pour(&basins, *pit, 1e5);
            });
        }
        let full: f64 = basins.list.iter().filter(|b| b.parent == OUT).map(|b| b.capacity).sum();
        assert!(full > 0.0 && (pools.total(&basins) - full).abs() < 1e-6 * full);
    }
}
