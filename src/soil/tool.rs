//! Tools that work the soil: shapes, poses with their times, and what a bucket holds by its tilt.

use glam::{DVec2, DVec3};

use super::laws::heap_volume_m3;
use crate::error::{Error, Result, Status, check_range};

/// Largest number of tools of a site.
pub const MAX_SOIL_TOOLS: usize = 64;
/// Longest time between two poses, s.
const LONGEST_TIME_S: f64 = 600.0;
/// Longest way of a point of a tool between two poses, m.
const LONGEST_WAY_M: f64 = 20.0;

/// Number of a tool of a site.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct SoilToolId(pub u32);

/// Shape of a tool, and what it does to the soil.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum SoilToolShape {
    /// Bucket or shovel: cuts with its edge, fills, carries and pours.
    Bucket {
        /// Volume when struck level with its opening, m^3, \[0.001, 1000\].
        struck_m3: f64,
        /// Rise of the rated heap per unit of length: 1 for excavators by SAE J296, 0.5 by CECE and for loaders, \[0,
        /// 1\].
        heap_rise: f64,
    },
    /// Blade of a dozer or grader: cuts with its edge, and pushes the soil ahead.
    Blade,
    /// Bed of a truck: catches what falls into it, carries and pours, but does not cut.
    Bed {
        /// Volume when struck level with its sides, m^3, \[0.001, 1000\].
        struck_m3: f64,
        /// Rise of the rated heap per unit of length, \[0, 1\].
        heap_rise: f64,
    },
    /// Wheel: its edge is the line of contact, across the direction of travel.
    Wheel {
        /// Diameter, m, \[0.1, 10\].
        diameter_m: f64,
    },
    /// Crawler track: its edge is the line under its middle, across the direction of travel.
    Track {
        /// Length of contact with the ground, m, \[0.1, 20\].
        contact_m: f64,
    },
}

/// Pose of a tool at a time. Places are in metres east, north and up from the lattice's origin; in calls of a context
/// they are places in the host's world. They lie within 1e7 m of the origin.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SoilToolPose {
    /// Simulation time, s, \[-1e10, 1e10\].
    pub time_s: f64,
    /// Cutting edge, or the line of contact of a wheel or track: its left and its right end for a viewer inside the
    /// tool who looks out of the opening, 0.05 to 20 m apart.
    pub edge: [DVec3; 2],
    /// Edge of the opening opposite to the cutting edge, left and right, 0.05 to 20 m apart and 0.02 to 20 m from the
    /// cutting edge; not used for wheels and tracks.
    pub upper: [DVec3; 2],
    /// Direction out of the opening, of a length in \[1e-6, 1e6\]. Not used for wheels and tracks.
    pub facing: DVec3,
    /// Load of a wheel or track on the ground, N, \[0, 1e7\]; 0 for other tools.
    pub load_n: f64,
}

impl SoilToolShape {
    /// Struck volume and rise of the heap; `None` for tools that hold nothing.
    pub(super) fn hold(&self) -> Option<[f64; 2]> {
        match *self {
            Self::Bucket { struck_m3, heap_rise } | Self::Bed { struck_m3, heap_rise } => Some([struck_m3, heap_rise]),
            _ => None,
        }
    }

    pub(super) fn cuts(&self) -> bool {
        matches!(self, Self::Bucket { .. } | Self::Blade)
    }

    fn presses(&self) -> bool {
        matches!(self, Self::Wheel { .. } | Self::Track { .. })
    }

    /// Checks the values of a shape.
    ///
    /// # Errors
    /// [`Status::InvalidArgument`] naming the field.
    pub fn validate(&self) -> Result<()> {
        if let Some([struck_m3, heap_rise]) = self.hold() {
            check_range("shape.struck_m3", struck_m3, 1e-3, 1e3, "m^3")?;
            check_range("shape.heap_rise", heap_rise, 0.0, 1.0, "")?;
        }
        match *self {
            Self::Wheel { diameter_m } => check_range("shape.diameter_m", diameter_m, 0.1, 10.0, "m"),
            Self::Track { contact_m } => check_range("shape.contact_m", contact_m, 0.1, 20.0, "m"),
            _ => Ok(()),
        }
    }
}

impl SoilToolPose {
    /// Corners of the opening: the ends of the edge, then those of the upper edge.
    pub(super) fn corners(&self) -> [DVec3; 4] {
        [self.edge[0], self.edge[1], self.upper[0], self.upper[1]]
    }

    /// Middle of the opening.
    pub(super) fn middle(&self) -> DVec3 {
        0.25 * self.corners().iter().sum::<DVec3>()
    }

    /// Direction ahead of the tool in plan, of length 1 or 0: where the opening looks, or, in a level bucket, where the
    /// edge leads.
    pub(super) fn ahead(&self) -> DVec2 {
        let lead = (self.edge[0] + self.edge[1] - self.upper[0] - self.upper[1]).normalize_or_zero();
        (self.facing.normalize_or_zero() + lead).truncate().normalize_or_zero()
    }

    /// Lengths of the opening, m: across the tool, and between the edges.
    pub(super) fn sides_m(&self) -> [f64; 2] {
        let across = 0.5 * ((self.edge[1] - self.edge[0]).length() + (self.upper[1] - self.upper[0]).length());
        let between = 0.5 * (self.edge[0] + self.edge[1] - self.upper[0] - self.upper[1]).length();
        [across, between]
    }

    /// Checks the pose of a tool of this shape.
    ///
    /// # Errors
    /// [`Status::InvalidArgument`] naming the field.
    pub fn validate(&self, shape: &SoilToolShape) -> Result<()> {
        check_range("pose.time_s", self.time_s, -1e10, 1e10, "s")?;
        check_range("pose.load_n", self.load_n, 0.0, 1e7, "N")?;
        let is_wheel = shape.presses();
        for (name, edge) in
            [("pose.edge", &self.edge), ("pose.upper", &self.upper)].into_iter().take(2 - is_wheel as usize)
        {
            for (i, point) in edge.iter().enumerate() {
                if !(point.is_finite() && point.length() <= 1e7) {
                    return Err(Error::range(&format!("{name}[{i}]"), "finite and within 1e7 m of the origin", point));
                }
            }
            let length_m = (edge[1] - edge[0]).length();
            check_range(&format!("{name}[1]"), length_m, 0.05, 20.0, "m from the left end")?;
        }
        if is_wheel {
            return Ok(());
        }
        if !(self.facing.is_finite() && self.facing.length() > 1e-6 && self.facing.length() < 1e6) {
            return Err(Error::range("pose.facing", "finite, and of a length in [1e-6, 1e6]", self.facing));
        }
        check_range("pose.upper[0]", self.sides_m()[1], 0.02, 20.0, "m from the edge")?;
        let (across, up) = (self.edge[1] - self.edge[0], self.upper[0] - self.edge[0]);
        let turns_over = across.dot(self.upper[1] - self.upper[0]) <= 0.0;
        let outward = up.cross(across).normalize_or_zero().dot(self.facing.normalize_or_zero());
        if turns_over || outward < 0.1 {
            let accepted =
                "out of the opening, which has the edge below, the upper edge above, and left and right in order";
            return Err(Error::range("pose.facing", accepted, self.facing));
        }
        Ok(())
    }

    /// Checks the pose as the one that follows the pose `last`.
    pub(super) fn validate_after(&self, last: &Self) -> Result<()> {
        if self.time_s <= last.time_s {
            let rest =
                format!("must be more than {} s, up to which the tool has its way, got {}", last.time_s, self.time_s);
            return Err(Error::about(Status::WrongOrder, "pose.time_s", rest));
        }
        if self.time_s > last.time_s + LONGEST_TIME_S {
            let accepted = format!("at most {LONGEST_TIME_S} s after the pose before");
            return Err(Error::range("pose.time_s", &accepted, self.time_s));
        }
        for (name, new, old) in [("pose.edge", &self.edge, &last.edge), ("pose.upper", &self.upper, &last.upper)] {
            for i in [0, 1] {
                let way_m = (new[i] - old[i]).length();
                if way_m.is_finite() && way_m > LONGEST_WAY_M {
                    let accepted = format!("within {LONGEST_WAY_M} m of the pose before");
                    return Err(Error::range(&format!("{name}[{i}]"), &accepted, format!("{way_m} m")));
                }
            }
        }
        Ok(())
    }

    /// Pose at a time between this one and a later one.
    pub(super) fn toward(&self, later: &Self, time_s: f64) -> Self {
        let t = ((time_s - self.time_s) / (later.time_s - self.time_s)).clamp(0.0, 1.0);
        let point = |a: DVec3, b: DVec3| a + (b - a) * t;
        Self {
            time_s,
            edge: [point(self.edge[0], later.edge[0]), point(self.edge[1], later.edge[1])],
            upper: [point(self.upper[0], later.upper[0]), point(self.upper[1], later.upper[1])],
            facing: point(self.facing.normalize_or_zero(), later.facing.normalize_or_zero()),
            load_n: self.load_n + (later.load_n - self.load_n) * t,
        }
    }

    /// Rated volume of a level bucket with its heap, m^3.
    pub(super) fn rated_m3(&self, [struck_m3, heap_rise]: [f64; 2]) -> f64 {
        struck_m3 + heap_volume_m3(self.sides_m(), heap_rise)
    }

    /// Returns the volume that the tool holds at its tilt, m^3; 0 for one that holds nothing. Soil lies up to the slope
    /// `grade` from the lower edge. While the opening is flatter than this slope, a heap lies on it, at most the rated
    /// one. If the opening is steeper, a bed is empty, because its tail is open, and a bucket keeps what lies behind
    /// its lip. The bucket's section below the opening is taken as a rectangle.
    pub(super) fn held_m3(&self, shape: &SoilToolShape, grade: f64) -> f64 {
        let Some(hold) = shape.hold() else { return 0.0 };
        let [across, between] = self.sides_m();
        let upright = (self.facing.normalize_or_zero().z).clamp(-1.0, 1.0);
        let tilt = libm::acos(upright);
        let slope = libm::atan(grade) - tilt;
        if slope >= 0.0 {
            let rise = libm::tan(slope).min(hold[1]);
            return hold[0] + heap_volume_m3([across, between], rise);
        }
        if slope <= -std::f64::consts::FRAC_PI_2 || !shape.cuts() {
            return 0.0;
        }
        let (fall, depth) = (libm::tan(-slope), hold[0] / (across * between));
        let section = if fall * between <= depth {
            between * depth - 0.5 * between * between * fall
        } else {
            0.5 * depth * depth / fall
        };
        across * section
    }

    /// Edge of the opening from which soil pours: the lowest of the four.
    pub(super) fn pouring_edge(&self) -> [DVec3; 2] {
        let [a, b, c, d] = self.corners();
        let edges = [[a, b], [c, d], [a, c], [b, d]];
        let height = |edge: &[DVec3; 2]| edge[0].z + edge[1].z;
        edges.into_iter().reduce(|low, edge| if height(&edge) < height(&low) { edge } else { low }).unwrap_or([a, b])
    }

    /// Whether the opening lies under a point: the point is within the opening in plan, and above the opening's middle.
    pub(super) fn is_under(&self, point: DVec3) -> bool {
        let [a, b, c, d] = self.corners();
        let ring = [a, b, d, c];
        let sides = [0, 1, 2, 3].map(|i| {
            let (p, q) = (ring[i].truncate(), ring[(i + 1) % 4].truncate());
            (q - p).perp_dot(point.truncate() - p)
        });
        let is_inside = sides.iter().all(|side| *side >= 0.0) || sides.iter().all(|side| *side <= 0.0);
        is_inside && self.middle().z < point.z && sides.iter().any(|side| *side != 0.0)
    }
}
