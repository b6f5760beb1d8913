//! Wind that varies in space, in the one form that queries and shaders read, whether from a host's [`WindGrid`] or from
//! a solved field.
//!
//! Each node has the share of the weather's wind that it replaces, and a velocity of its own. The wind at a place is
//! own + (1 - share) x the weather's wind. With share 1 the own velocity is the whole wind; with share 0 it is added to
//! the weather's wind; shares between 0 and 1 blend the two. The own velocity already contains its weight in the blend.

use std::sync::atomic::{AtomicU64, Ordering};

use glam::{DMat3, DVec3, DVec4};

use super::{WindGrid, WindGridKind, grid::about};

/// Velocities at the nodes of a grid that is level and aligned to north at its origin. Between nodes the velocity is
/// linear along each axis.
#[derive(Debug)]
pub(crate) struct WindVolume {
    /// Position of the lowest, south-western node in the host's world.
    pub origin: DVec3,
    /// Rotation from the host's axes at the origin to east, north, up.
    pub to_enu: DMat3,
    /// Distance between nodes, m.
    pub cell_m: DVec3,
    /// Numbers of nodes east, north and up.
    pub nodes: [u32; 3],
    /// Own velocity (east, north, up), m/s, and the share. East varies fastest, then north, then up.
    pub values: Vec<[f32; 4]>,
    /// First and last time for which the wind holds, s; `None` for all times.
    pub holds_s: Option<[f64; 2]>,
    /// Number that differs whenever the values have changed.
    revision: u64,
}

/// Returns a number that no values have had.
fn next_revision() -> u64 {
    static NEXT: AtomicU64 = AtomicU64::new(1);
    NEXT.fetch_add(1, Ordering::Relaxed)
}

impl WindVolume {
    /// Creates an empty volume, to be filled with its geometry and values.
    pub fn empty() -> Self {
        Self {
            origin: DVec3::ZERO,
            to_enu: DMat3::IDENTITY,
            cell_m: DVec3::ONE,
            nodes: [0; 3],
            values: Vec::new(),
            holds_s: None,
            revision: next_revision(),
        }
    }

    /// Creates a volume from a host's grid; `to_enu` rotates the host's axes at its origin to east, north, up.
    pub fn of_grid(grid: &WindGrid, to_enu: DMat3) -> Self {
        let share = match grid.kind {
            WindGridKind::Whole => 1.0,
            WindGridKind::Added => 0.0,
        };
        Self {
            origin: grid.origin,
            to_enu,
            cell_m: grid.cell_m,
            nodes: grid.nodes,
            values: grid.velocities_m_s.iter().map(|v| [v[0], v[1], v[2], share]).collect(),
            holds_s: None,
            revision: next_revision(),
        }
    }

    /// Marks the values as changed.
    pub fn changed(&mut self) {
        self.revision = next_revision();
    }

    /// Returns a number that differs whenever the values have changed; no two volumes share one.
    pub fn revision(&self) -> u64 {
        self.revision
    }

    /// Whether the wind holds at a time.
    pub fn holds_at(&self, time_s: f64) -> bool {
        self.holds_s.is_none_or(|[first, last]| (first..=last).contains(&time_s))
    }

    /// Returns a position of the host's world in cells from the origin.
    pub fn cells_at(&self, position: DVec3) -> DVec3 {
        (self.to_enu * (position - self.origin)) / self.cell_m
    }

    /// Returns the distance of a position of the host's world from the box of nodes, m; 0 inside.
    pub fn distance_m(&self, position: DVec3) -> f64 {
        let last = DVec3::from(self.nodes.map(|n| f64::from(n.max(1) - 1)));
        let cells = self.cells_at(position);
        ((cells - cells.clamp(DVec3::ZERO, last)) * self.cell_m).length()
    }

    /// Returns the own velocity, m/s, and the share at a position in cells from the origin; `None` outside.
    pub fn at(&self, cells: DVec3) -> Option<DVec4> {
        let value = |i: usize| DVec4::from(self.values[i].map(f64::from));
        Some(about(self.nodes, cells)?.into_iter().map(|(i, weight)| value(i) * weight).sum())
    }

    /// Returns the wind at a position of the host's world, m/s (east, north, up), where `weathers` is the weather's
    /// wind; `None` outside the volume.
    pub fn wind(&self, position: DVec3, weathers: DVec3) -> Option<DVec3> {
        let found = self.at(self.cells_at(position))?;
        Some(found.truncate() + weathers * (1.0 - found.w))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn grid(kind: WindGridKind) -> WindGrid {
        let velocities_m_s = (0..12).map(|i| [i as f32, 1.0, -0.5 * (i % 2) as f32]).collect();
        WindGrid {
            origin: DVec3::new(5.0, 6.0, 7.0),
            cell_m: DVec3::splat(2.0),
            nodes: [2, 3, 2],
            kind,
            velocities_m_s,
        }
    }

    #[test]
    fn a_hosts_grid_replaces_the_wind_or_is_added_to_it() {
        let weathers = DVec3::new(3.0, -4.0, 0.25);
        for (kind, share) in [(WindGridKind::Whole, 0.0), (WindGridKind::Added, 1.0)] {
            let grid = grid(kind);
            let volume = WindVolume::of_grid(&grid, DMat3::IDENTITY);
            for p in [DVec3::new(5.0, 6.0, 7.0), DVec3::new(6.3, 9.1, 8.9), DVec3::new(7.0, 10.0, 9.0)] {
                let own = grid.at(volume.cells_at(p)).expect("inside");
                let wind = volume.wind(p, weathers).expect("inside");
                assert!((wind - (own + weathers * share)).length() < 1e-6, "{kind:?} at {p}: {wind}");
            }
            assert_eq!(volume.wind(DVec3::new(4.9, 6.0, 7.0), weathers), None);
        }
        assert_eq!(WindVolume::empty().wind(DVec3::ZERO, weathers), None);
    }

    #[test]
    fn each_change_has_another_revision() {
        let mut a = WindVolume::empty();
        let b = WindVolume::empty();
        let before = a.revision();
        assert_ne!(before, b.revision());
        a.changed();
        assert!(a.revision() != before && a.revision() != b.revision());
    }
}
