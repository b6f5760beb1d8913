//! Regions of water, and regions without it: lakes, harbours, hulls and docks. They stand, or move at a constant
//! velocity and rate of turn.

use glam::{DMat3, DVec2, DVec3};
use serde::{Deserialize, Serialize};

use super::outline;
use crate::{
    error::{Error, Result, check_range},
    numerics::smoothstep,
    scene::WorldFrame,
};

/// Maximum number of regions.
pub const MAX_SEA_REGIONS: usize = 64;
/// Vertical distance from a region's centre from which on a position is taken to be on the planet's other side, m.
const OTHER_SIDE_M: f64 = 3e6;
/// Largest speed of a region, m/s.
const MOST_SPEED_M_S: f64 = 60.0;

/// Kind of water inside a region.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub enum SeaRegionKind {
    /// No water: inside a hull or an empty dock. A dry region takes precedence over all other kinds. Queries inside it
    /// return the surface of the water around, by which a hull floats.
    Dry,
    /// Water at the level of the sea, with lower waves: a harbour.
    Sheltered,
    /// Water with a level of its own: a lake, a lock.
    Lake {
        /// Level without waves, m above mean sea level. Range [-500, 9000].
        level_m: f64,
        /// Depth below the level, m. Range [0.1, 12 000]. The waves keep the lengths that they have over the sea's
        /// depth.
        depth_m: f64,
    },
}

/// A region of the ground plan.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SeaRegion {
    /// Kind of water inside.
    pub kind: SeaRegionKind,
    /// Corners of the outline, m to the right and ahead of the centre, in order, either way around. 3 to 64 corners,
    /// each coordinate within 1e6 m. The outline must not cross or touch itself, and must hold at least 0.01 m^2.
    pub corners_m: Vec<[f64; 2]>,
    /// Position of the centre in the host's world at the time `at_s`, m, within 1e12 of the origin. Its height does not
    /// matter.
    pub center_m: [f64; 3],
    /// Heading of the direction ahead at `at_s`, degrees clockwise from true north. Range [-360, 360], default 0.
    pub heading_deg: f64,
    /// Velocity east and north, m/s. Its magnitude is at most 60 m/s. Default 0: the region stands.
    pub velocity_m_s: [f64; 2],
    /// Rate of turn, degrees clockwise a second. Range [-90, 90], default 0.
    pub turn_deg_s: f64,
    /// Simulation time at which the centre is at `center_m`, s. Range [-1e10, 1e10], default 0.
    pub at_s: f64,
    /// Ratio of the height of waves inside to that on the open sea; for a sheltered region that lies in earlier ones of
    /// the list, to the height there. Range [0, 1], default 1. Not used by dry regions.
    pub wave_share: f64,
    /// Width of the band inside the outline over which the waves of a sheltered region become lower, m. Range [0, 1e4],
    /// default 0: at once.
    pub rim_m: f64,
}

impl Default for SeaRegion {
    /// A dry region without an outline yet.
    fn default() -> Self {
        Self {
            kind: SeaRegionKind::Dry,
            corners_m: Vec::new(),
            center_m: [0.0; 3],
            heading_deg: 0.0,
            velocity_m_s: [0.0; 2],
            turn_deg_s: 0.0,
            at_s: 0.0,
            wave_share: 1.0,
            rim_m: 0.0,
        }
    }
}

impl SeaRegion {
    /// Checks all fields but the centre.
    ///
    /// # Errors
    /// [`crate::Status::InvalidArgument`] naming the field.
    pub fn validate(&self) -> Result<()> {
        if let SeaRegionKind::Lake { level_m, depth_m } = self.kind {
            check_range("level_m", level_m, -500.0, 9000.0, "m")?;
            check_range("depth_m", depth_m, 0.1, 12_000.0, "m")?;
        }
        check_range("heading_deg", self.heading_deg, -360.0, 360.0, "degrees")?;
        let speed_m_s = DVec2::from(self.velocity_m_s).length();
        if !(0.0..=MOST_SPEED_M_S).contains(&speed_m_s) {
            let accepted = format!("a velocity of at most {MOST_SPEED_M_S} m/s");
            return Err(Error::range("velocity_m_s", &accepted, format!("{speed_m_s} m/s")));
        }
        check_range("turn_deg_s", self.turn_deg_s, -90.0, 90.0, "degrees/s")?;
        check_range("at_s", self.at_s, -1e10, 1e10, "s")?;
        check_range("wave_share", self.wave_share, 0.0, 1.0, "")?;
        check_range("rim_m", self.rim_m, 0.0, 1e4, "m")?;
        outline::validate(&self.corners_m)
    }
}

/// Water at a place.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct WaterBody {
    /// Level and depth without waves, m; `None` where they are the sea's.
    pub lake: Option<[f64; 2]>,
    /// Ratio of the height of waves to that on the open sea.
    pub wave_share: f64,
    /// Whether a dry region keeps the water off the place.
    pub is_dry: bool,
}

impl WaterBody {
    /// The open sea.
    pub const OPEN: Self = Self { lake: None, wave_share: 1.0, is_dry: false };
}

/// A valid region in the form in which places are looked up.
#[derive(Clone, Debug)]
pub(super) struct PlacedRegion {
    pub region: SeaRegion,
    center: DVec3,
    to_enu: DMat3,
    /// Distance of the farthest corner from the centre, m.
    radius_m: f64,
}

impl PlacedRegion {
    /// Checks a region and places it in the host's world.
    ///
    /// # Errors
    /// [`crate::Status::InvalidArgument`] naming the field.
    pub fn new(region: SeaRegion, frame: &WorldFrame) -> Result<Self> {
        region.validate()?;
        let center = DVec3::from(region.center_m);
        let local = frame.place_at("center_m", center)?;
        let radius_m = region.corners_m.iter().map(|c| DVec2::from(*c).length()).fold(0.0, f64::max);
        Ok(Self { region, center, to_enu: local.world_to_enu, radius_m })
    }

    /// Returns the distance of the farthest corner from the centre, m.
    pub fn radius_m(&self) -> f64 {
        self.radius_m
    }

    /// Returns the components of a vector (east, north) to the right and ahead at a time.
    fn headed(&self, v: DVec2, time_s: f64) -> DVec2 {
        let past_s = time_s - self.region.at_s;
        let turns = (self.region.heading_deg + self.region.turn_deg_s * past_s) / 360.0;
        let (sin, cos) = libm::sincos(std::f64::consts::TAU * (turns - turns.floor()));
        DVec2::new(cos * v.x - sin * v.y, sin * v.x + cos * v.y)
    }

    /// Returns a position in metres east and north of the centre at a time; `None` on the planet's other side.
    fn offset_from_center(&self, position: DVec3, time_s: f64) -> Option<DVec2> {
        let moved = DVec2::from(self.region.velocity_m_s) * (time_s - self.region.at_s);
        let offset = self.to_enu * (position - self.center);
        (offset.z.abs() < OTHER_SIDE_M).then(|| offset.truncate() - moved)
    }

    /// Returns a position in metres to the right and ahead of the centre at a time; `None` on the planet's other side.
    pub fn offset_m(&self, position: DVec3, time_s: f64) -> Option<DVec2> {
        Some(self.headed(self.offset_from_center(position, time_s)?, time_s))
    }

    /// Returns the components of a vector of the host's world to the right and ahead at a time.
    pub fn turned(&self, v: DVec3, time_s: f64) -> DVec2 {
        self.headed((self.to_enu * v).truncate(), time_s)
    }

    /// Returns a position in metres to the right and ahead of the centre at a time; `None` if the position is farther
    /// from the centre than all corners.
    fn within(&self, position: DVec3, time_s: f64) -> Option<DVec2> {
        let offset = self.offset_from_center(position, time_s)?;
        let is_near = offset.length_squared() <= self.radius_m * self.radius_m;
        is_near.then(|| self.headed(offset, time_s))
    }
}

/// Returns the water at a position and time; in a dry region, the water that would be there without the region. `None`
/// if there is no such water. `is_sea` says whether there is sea outside all regions. Later regions are applied to the
/// water of earlier ones, and dry ones after all others.
pub(super) fn water_at(regions: &[PlacedRegion], is_sea: bool, position: DVec3, time_s: f64) -> Option<WaterBody> {
    let mut water = is_sea.then_some(WaterBody::OPEN);
    let mut is_dry = false;
    for placed in regions {
        let region = &placed.region;
        let Some(p) = placed.within(position, time_s).filter(|p| outline::holds(&region.corners_m, *p)) else {
            continue;
        };
        let wave_share = region.wave_share;
        water = match (region.kind, water) {
            (SeaRegionKind::Dry, around) => {
                is_dry = true;
                around
            }
            (SeaRegionKind::Lake { level_m, depth_m }, _) => {
                Some(WaterBody { lake: Some([level_m, depth_m]), wave_share, is_dry: false })
            }
            (SeaRegionKind::Sheltered, None) => Some(WaterBody { wave_share, ..WaterBody::OPEN }),
            (SeaRegionKind::Sheltered, Some(around)) => {
                let deep = if region.rim_m > 0.0 {
                    smoothstep(0.0, region.rim_m, outline::distance_m(&region.corners_m, p))
                } else {
                    1.0
                };
                let left = wave_share + (1.0 - deep) * (1.0 - wave_share);
                Some(WaterBody { wave_share: around.wave_share * left, ..around })
            }
        };
    }
    water.map(|water| WaterBody { is_dry, ..water })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::{Place, WorldKind};

    const SQUARE: [[f64; 2]; 4] = [[-50.0, -100.0], [50.0, -100.0], [50.0, 100.0], [-50.0, 100.0]];

    fn square(kind: SeaRegionKind) -> SeaRegion {
        SeaRegion { kind, corners_m: SQUARE.to_vec(), ..SeaRegion::default() }
    }

    fn placed(regions: &[SeaRegion]) -> Vec<PlacedRegion> {
        let frame = WorldFrame::default();
        regions.iter().map(|r| PlacedRegion::new(r.clone(), &frame).expect("a region")).collect()
    }

    const OPEN: Option<WaterBody> = Some(WaterBody::OPEN);
    const DRY: Option<WaterBody> = Some(WaterBody { is_dry: true, ..WaterBody::OPEN });

    #[test]
    fn hulls_move_and_turn() {
        let hull = SeaRegion {
            center_m: [1000.0, 0.0, 3.0],
            heading_deg: 90.0,
            velocity_m_s: [5.0, 0.0],
            at_s: 10.0,
            ..square(SeaRegionKind::Dry)
        };
        let placed = placed(&[hull.clone(), SeaRegion { turn_deg_s: 4.5, center_m: [0.0, 1e4, 0.0], ..hull }]);
        let at = |x: f64, y: f64, t: f64| water_at(&placed, true, DVec3::new(x, y, 0.0), t);
        // Heading east: long to the east, narrow to the north.
        assert_eq!((at(1095.0, 45.0, 10.0), at(1000.0, 60.0, 10.0), at(1105.0, 0.0, 10.0)), (DRY, OPEN, OPEN));
        assert_eq!((at(1145.0, 0.0, 20.0), at(1045.0, 0.0, 20.0), at(940.0, 0.0, 20.0)), (DRY, DRY, OPEN));
        // Ten seconds later the other one heads south-east.
        assert_eq!((at(110.0, 1e4 - 60.0, 20.0), at(110.0, 1e4 + 60.0, 20.0)), (DRY, OPEN));
    }

    #[test]
    fn harbours_shelter_and_lakes_have_their_level() {
        let harbour = SeaRegion { wave_share: 0.2, rim_m: 40.0, ..square(SeaRegionKind::Sheltered) };
        let lake = SeaRegion {
            wave_share: 0.5,
            center_m: [0.0, 500.0, 0.0],
            ..square(SeaRegionKind::Lake { level_m: 12.0, depth_m: 3.0 })
        };
        let ship = SeaRegion {
            corners_m: vec![[-5.0, -5.0], [5.0, -5.0], [0.0, 5.0]],
            center_m: [0.0, 50.0, 0.0],
            ..SeaRegion::default()
        };
        // The ship stands first in the list and still counts.
        let placed = placed(&[ship, harbour, lake]);
        let at = |x: f64, y: f64| water_at(&placed, true, DVec3::new(x, y, 0.0), 0.0);
        let calm = WaterBody { wave_share: 0.2, ..WaterBody::OPEN };
        // Inside the ship the query answers the harbour's water.
        let dry = Some(WaterBody { is_dry: true, ..calm });
        assert_eq!((at(0.0, 0.0), at(0.0, 50.0)), (Some(calm), dry));
        let rim = at(30.0, 0.0).expect("water").wave_share;
        assert!((rim - 0.6).abs() < 1e-12, "{rim}");
        assert!(at(49.999, 0.0).expect("water").wave_share > 0.9999 && at(60.0, 0.0) == OPEN);
        assert_eq!(at(0.0, 500.0), Some(WaterBody { lake: Some([12.0, 3.0]), wave_share: 0.5, is_dry: false }));
        // Without a sea around them there is water only inside.
        let inside = |x: f64, y: f64| water_at(&placed, false, DVec3::new(x, y, 0.0), 0.0);
        assert_eq!((inside(400.0, 0.0), inside(0.0, 50.0)), (None, dry));
        assert_eq!((inside(30.0, 0.0).expect("water").wave_share, inside(0.0, 500.0)), (0.2, at(0.0, 500.0)));
    }

    #[test]
    fn regions_lie_where_their_centre_is_in_any_world() {
        let frame = WorldFrame {
            kind: WorldKind::Ecef,
            origin: Place { latitude_deg: 54.0, longitude_deg: 8.0, altitude_m: 0.0 },
            ..WorldFrame::default()
        };
        let center = frame.position_of(&Place { latitude_deg: 54.1, longitude_deg: 8.2, altitude_m: 0.0 });
        let up = frame.frame_at(center).world_to_enu.transpose();
        let hull = SeaRegion { center_m: center.to_array(), ..square(SeaRegionKind::Dry) };
        let placed = [PlacedRegion::new(hull, &frame).expect("a region")];
        let at = |x: f64, y: f64| water_at(&placed, true, center + up * DVec3::new(x, y, 7.0), 0.0);
        assert_eq!((at(45.0, -95.0), at(55.0, 0.0), at(0.0, 105.0)), (DRY, OPEN, OPEN));
        assert_eq!(water_at(&placed, true, -center, 0.0), OPEN, "the other side of the planet");
    }

    #[test]
    fn faults_are_named_with_their_range() {
        let base = || square(SeaRegionKind::Dry);
        let lake = |level_m, depth_m| square(SeaRegionKind::Lake { level_m, depth_m });
        for (field, region) in [
            ("level_m", lake(f64::NAN, 3.0)),
            ("depth_m", lake(3.0, 0.0)),
            ("heading_deg", SeaRegion { heading_deg: 361.0, ..base() }),
            ("velocity_m_s", SeaRegion { velocity_m_s: [50.0, 50.0], ..base() }),
            ("velocity_m_s", SeaRegion { velocity_m_s: [f64::NAN, 0.0], ..base() }),
            ("turn_deg_s", SeaRegion { turn_deg_s: 91.0, ..base() }),
            ("at_s", SeaRegion { at_s: 1e11, ..base() }),
            ("wave_share", SeaRegion { wave_share: 1.5, ..base() }),
            ("rim_m", SeaRegion { rim_m: -1.0, ..base() }),
            ("corner_count", SeaRegion::default()),
            ("corners_m", SeaRegion { corners_m: vec![[0.0, 0.0], [9.0, 9.0], [9.0, 0.0], [0.0, 9.0]], ..base() }),
            ("center_m", SeaRegion { center_m: [1e13, 0.0, 0.0], ..base() }),
        ] {
            let e = PlacedRegion::new(region, &WorldFrame::default()).expect_err(field);
            assert_eq!(e.field(), Some(field), "{e}");
        }
    }
}
