//! Tracks of hulls: where each was, and where it will be if the host does not set it again.
//!
//! The leg is the last section of a track. It begins where the host last set the hull and goes on at a constant speed
//! and rate of turn, along a line or an arc. The track before the leg is kept as nodes at whole multiples of a step of
//! time, and only where course or speed have changed, so that hosts may set their hulls in every frame. A straight
//! track has a node each [`MOST_STRAIGHT_S`].

use std::f64::consts::PI;

use glam::DVec2;
use serde::{Deserialize, Serialize};

use super::hull::SeaHull;
use crate::{
    error::{Result, Status},
    numerics::smoothstep,
    world::{World, parse_error},
};

/// Age of the oldest waves that are kept, s.
pub(super) const MOST_AGE_S: f64 = 240.0;
/// Most nodes of a track.
pub(super) const MOST_NODES: usize = 64;
/// Step of time between nodes, s.
const STEP_S: f64 = 1.5;
/// Longest time between two nodes, s.
const MOST_STRAIGHT_S: f64 = 24.0;
/// Smallest change of course between two nodes, rad, unless the speed changes or [`MOST_STRAIGHT_S`] passes.
const NODE_TURN: f64 = 7.0 * PI / 180.0;
/// Smallest change of speed between two nodes: a share of the speed, plus an amount in m/s.
const NODE_SPEED: [f64; 2] = [0.08, 0.1];
/// Largest distance at which a hull may be set from where its track has it at that time, in lengths of the hull.
/// Farther away a new track begins.
const JUMP_LENGTHS: f64 = 2.0;

/// State of a hull at a time.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub(super) struct TrackNode {
    pub time_s: f64,
    /// Middle of the hull on the map, m.
    #[serde(with = "pair")]
    pub place_m: DVec2,
    /// Unit vector of the heading.
    #[serde(with = "pair")]
    pub ahead: DVec2,
    pub speed_m_s: f64,
}

/// Track of a hull.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct HullTrack {
    /// Hull as the host last set it.
    pub hull: SeaHull,
    /// State of the hull at the time for which the host set it: the beginning of the leg.
    leg: TrackNode,
    /// Time from which on the hull raises no waves; `None` for a hull that the host still lists.
    pub ended_s: Option<f64>,
    /// States before the leg, from old to new. The first is the beginning of the track.
    nodes: Vec<TrackNode>,
}

/// Saved form of a vector.
mod pair {
    use glam::DVec2;
    use serde::{Deserialize, Deserializer, Serialize, Serializer};

    pub fn serialize<S: Serializer>(v: &DVec2, serializer: S) -> Result<S::Ok, S::Error> {
        v.to_array().serialize(serializer)
    }

    pub fn deserialize<'de, D: Deserializer<'de>>(deserializer: D) -> Result<DVec2, D::Error> {
        <[f64; 2]>::deserialize(deserializer).map(DVec2::from_array)
    }
}

impl TrackNode {
    /// Returns the velocity, m/s.
    pub fn velocity(&self) -> DVec2 {
        self.ahead * self.speed_m_s
    }

    /// Returns the state `past_s` seconds later, at a rate of turn of `turn` rad/s clockwise.
    fn later(&self, turn: f64, past_s: f64) -> Self {
        let angle = turn * past_s;
        let (sin, cos) = libm::sincos(angle);
        let right = DVec2::new(self.ahead.y, -self.ahead.x);
        // sin(x) / x and (1 - cos(x)) / x, without a division by small angles.
        let [along, beside] = if angle.abs() < 1e-4 { [1.0, 0.5 * angle] } else { [sin / angle, (1.0 - cos) / angle] };
        Self {
            time_s: self.time_s + past_s,
            place_m: self.place_m + (self.ahead * along + right * beside) * (self.speed_m_s * past_s),
            ahead: self.ahead * cos + right * sin,
            speed_m_s: self.speed_m_s,
        }
    }

    /// Whether a later state differs so much that it is kept as the next node.
    fn differs(&self, other: &Self) -> bool {
        let [share, least] = NODE_SPEED;
        let turned = libm::atan2(self.ahead.perp_dot(other.ahead).abs(), self.ahead.dot(other.ahead));
        other.time_s - self.time_s >= MOST_STRAIGHT_S
            || turned > NODE_TURN
            || (other.speed_m_s - self.speed_m_s).abs() > share * self.speed_m_s + least
    }

    fn is_finite(&self) -> bool {
        self.time_s.is_finite() && self.place_m.is_finite() && self.ahead.is_finite() && self.speed_m_s.is_finite()
    }
}

/// Adds states of the leg up to a time to `nodes`, which hold the track before the leg. A state is added if it differs
/// from the last node ([`TrackNode::differs`]). Where there are [`MOST_NODES`], the oldest is dropped. The first node
/// of a track is the beginning of its first leg.
fn add_nodes(leg: &TrackNode, turn: f64, until_s: f64, nodes: &mut Vec<TrackNode>) {
    let is_first = nodes.is_empty();
    let mut add = |state: TrackNode| {
        if nodes.last().is_none_or(|last| last.differs(&state)) {
            if nodes.len() == MOST_NODES {
                nodes.remove(0);
            }
            nodes.push(state);
        }
    };
    if leg.time_s < until_s && is_first {
        add(*leg);
    }
    // States that are older than all waves need no nodes.
    let since_s = leg.time_s.max(until_s - MOST_AGE_S - MOST_STRAIGHT_S);
    let first = (since_s / STEP_S).ceil();
    for i in 0..(((MOST_AGE_S + MOST_STRAIGHT_S) / STEP_S) as u32 + 2) {
        let time_s = (first + f64::from(i)) * STEP_S;
        if time_s >= until_s {
            break;
        }
        add(leg.later(turn, time_s - leg.time_s));
    }
}

impl HullTrack {
    /// Begins a track.
    ///
    /// # Errors
    /// [`Status::InvalidArgument`] naming the hull's field.
    pub fn new(hull: SeaHull, world: &World) -> Result<Self> {
        hull.validate()?;
        Ok(Self::begin(hull, leg_of(&hull, world)?))
    }

    fn begin(hull: SeaHull, leg: TrackNode) -> Self {
        Self { hull, leg, ended_s: None, nodes: Vec::new() }
    }

    /// Checks a track of a saved state.
    ///
    /// # Errors
    /// [`Status::InvalidArgument`] for a field of the hull; [`Status::Parse`] for the rest.
    pub fn check(&self) -> Result<()> {
        self.hull.validate()?;
        let states = || self.nodes.iter().chain([&self.leg]);
        let in_order = self.nodes.windows(2).all(|pair| pair[0].time_s < pair[1].time_s);
        let is_sound = states().all(|node| node.is_finite() && (node.ahead.length() - 1.0).abs() < 1e-6)
            && self.nodes.len() <= MOST_NODES
            && in_order
            && self.ended_s.is_none_or(f64::is_finite);
        if is_sound { Ok(()) } else { Err(parse_error("sea_hulls: nodes must be finite and in the order of time")) }
    }

    fn turn(&self) -> f64 {
        self.hull.turn_deg_s.to_radians()
    }

    /// Begins the next leg, where the host sets the same hull again. A leg that begins before the present one replaces
    /// the track from its own time on. A new track begins if the leg begins before the track or after the track's end.
    /// It also begins if the leg, not earlier than the present one, begins more than [`JUMP_LENGTHS`] from where the
    /// track has the hull then.
    ///
    /// # Errors
    /// As [`HullTrack::new`]; nothing changes then.
    pub fn set(&mut self, hull: SeaHull, world: &World) -> Result<()> {
        self.go_on(Self::new(hull, world)?);
        Ok(())
    }

    /// Continues the track by the leg of `next`, a track that has no nodes yet.
    fn go_on(&mut self, next: Self) {
        let time_s = next.leg.time_s;
        let began_s = self.nodes.first().map_or(self.leg.time_s, |node| node.time_s);
        if time_s < began_s || self.ended_s.is_some_and(|ended_s| ended_s < time_s) {
            *self = next;
            return;
        }
        if time_s < self.leg.time_s {
            self.nodes.retain(|node| node.time_s < time_s);
        } else {
            let expected = self.leg.later(self.turn(), time_s - self.leg.time_s);
            if (expected.place_m - next.leg.place_m).length() > JUMP_LENGTHS * next.hull.length_m {
                *self = next;
                return;
            }
            let (leg, turn) = (self.leg, self.turn());
            add_nodes(&leg, turn, time_s, &mut self.nodes);
        }
        (self.hull, self.leg, self.ended_s) = (next.hull, next.leg, None);
    }

    /// Sets the time from which on the hull raises no waves, unless one was set before.
    pub fn end(&mut self, time_s: f64) {
        self.ended_s.get_or_insert(time_s);
    }

    /// Whether waves of the hull are left at a time.
    pub fn has_waves(&self, time_s: f64) -> bool {
        self.ended_s.is_none_or(|ended_s| time_s - ended_s < MOST_AGE_S)
    }

    /// Writes the states of the hull up to a time to `states`, from new to old, as far back as the waves that these
    /// states raised are still there.
    pub fn states(&self, time_s: f64, states: &mut Vec<TrackNode>) {
        states.clear();
        let last_s = self.ended_s.map_or(time_s, |ended_s| ended_s.min(time_s));
        states.extend(self.nodes.iter().filter(|node| node.time_s < last_s));
        if last_s >= self.leg.time_s {
            add_nodes(&self.leg, self.turn(), last_s, states);
            states.push(self.leg.later(self.turn(), last_s - self.leg.time_s));
        } else if let Some(next) = self.nodes.iter().find(|node| node.time_s >= last_s).or(Some(&self.leg))
            && let Some(before) = states.last()
        {
            states.push(between(before, next, last_s));
        }
        // One state beyond the oldest waves is kept.
        let old = states.iter().take_while(|state| time_s - state.time_s > MOST_AGE_S).count();
        states.drain(..old.saturating_sub(1));
        states.reverse();
        states.truncate(MOST_NODES);
    }
}

/// Returns the state between two others at a time.
fn between(a: &TrackNode, b: &TrackNode, time_s: f64) -> TrackNode {
    let share = ((time_s - a.time_s) / (b.time_s - a.time_s).max(1e-9)).clamp(0.0, 1.0);
    let ahead = a.ahead.lerp(b.ahead, share);
    TrackNode {
        time_s,
        place_m: a.place_m.lerp(b.place_m, share),
        ahead: ahead.try_normalize().unwrap_or(a.ahead),
        speed_m_s: a.speed_m_s + (b.speed_m_s - a.speed_m_s) * share,
    }
}

/// Distance over which a heading is found on the map, m.
const HEADING_STEP_M: f64 = 10.0;

/// Returns the state in which the host sets a hull.
fn leg_of(hull: &SeaHull, world: &World) -> Result<TrackNode> {
    let position = glam::DVec3::from(hull.position_m);
    let local = world.frame.place_at("position_m", position)?;
    let (sin, cos) = libm::sincos(hull.heading_deg.to_radians());
    let ahead = local.world_to_enu.transpose() * glam::DVec3::new(sin, cos, 0.0);
    let on_map = |position: glam::DVec3| -> Result<DVec2> {
        let local = world.frame.place_at("position_m", position)?;
        Ok(DVec2::from_array(world.map_place(position, &local)))
    };
    let place_m = DVec2::from_array(world.map_place(position, &local));
    let way = on_map(position + ahead * HEADING_STEP_M)? - place_m;
    let ahead = way.try_normalize().ok_or_else(|| {
        crate::error::Error::new(Status::InvalidArgument, "position_m must not be at a pole of the planet")
    })?;
    Ok(TrackNode { time_s: hull.at_s, place_m, ahead, speed_m_s: hull.speed_m_s })
}

/// Returns the share of the height with which waves of an age are drawn: the oldest waves of a track fade, and if the
/// track has ended, the newest too. The newest and the oldest waves have the ages `newest_s` and `oldest_s`.
pub(super) fn age_share(age_s: f64, newest_s: f64, oldest_s: f64) -> f64 {
    let oldest_s = oldest_s.min(MOST_AGE_S);
    let fading = 0.2 * (oldest_s - newest_s).max(1e-6);
    let old = smoothstep(0.0, fading, oldest_s - age_s);
    if newest_s > 0.0 { old * smoothstep(0.0, fading.min(3.0), age_s - newest_s) } else { old }
}

#[cfg(test)]
pub(super) mod tests {
    use super::*;

    const HULL: SeaHull = SeaHull {
        id: 7,
        length_m: 32.0,
        beam_m: 8.4,
        draught_m: 2.4,
        position_m: [0.0; 3],
        heading_deg: 90.0,
        speed_m_s: 6.0,
        turn_deg_s: 0.0,
        at_s: 0.0,
    };

    fn leg(hull: &SeaHull, place_m: DVec2) -> TrackNode {
        let (sin, cos) = libm::sincos(hull.heading_deg.to_radians());
        TrackNode { time_s: hull.at_s, place_m, ahead: DVec2::new(sin, cos), speed_m_s: hull.speed_m_s }
    }

    /// Track of a hull that begins at the map's origin.
    pub fn track(hull: SeaHull) -> HullTrack {
        HullTrack::begin(hull, leg(&hull, DVec2::ZERO))
    }

    fn states(track: &HullTrack, time_s: f64) -> Vec<TrackNode> {
        let mut states = Vec::new();
        track.states(time_s, &mut states);
        states
    }

    #[test]
    fn legs_are_lines_and_arcs() {
        let straight = track(HULL).leg.later(0.0, 10.0);
        assert!((straight.place_m - DVec2::new(60.0, 0.0)).length() < 1e-12);
        // A quarter of a circle to the right, southwards, of radius speed over rate.
        let turn = 3f64.to_radians();
        let quarter = track(HULL).leg.later(turn, 30.0);
        let radius = 6.0 / turn;
        assert!((quarter.place_m - DVec2::new(radius, -radius)).length() < 1e-9, "{quarter:?}");
        assert!((quarter.ahead - DVec2::new(0.0, -1.0)).length() < 1e-12);
    }

    #[test]
    fn a_hull_that_is_set_in_every_frame_has_the_track_of_its_legs() {
        let turning = SeaHull { turn_deg_s: 2.5, ..HULL };
        let once = track(turning);
        let mut often = track(turning);
        for i in 1..6000 {
            let time_s = f64::from(i) / 60.0;
            let at = once.leg.later(once.turn(), time_s);
            let heading_deg = libm::atan2(at.ahead.x, at.ahead.y).to_degrees();
            let hull = SeaHull { at_s: time_s, heading_deg, ..turning };
            often.go_on(HullTrack::begin(hull, leg(&hull, at.place_m)));
        }
        let (a, b) = (states(&once, 100.0), states(&often, 100.0));
        assert!(a.len() == b.len() && (30..40).contains(&a.len()), "{} {}", a.len(), b.len());
        let off = a.iter().zip(&b).map(|(a, b)| (a.place_m - b.place_m).length()).fold(0.0, f64::max);
        assert!(off < 1e-6, "{off}");
        // A straight way needs few nodes, whatever the time.
        assert!(states(&track(HULL), 90.0).len() < 7 && states(&track(HULL), 1e7).len() < 14);
        assert!(once.check().is_ok() && often.check().is_ok());
    }

    #[test]
    fn tracks_end_begin_anew_and_can_be_corrected() {
        let at = |at_s: f64, place_m: DVec2| {
            let hull = SeaHull { at_s, ..HULL };
            HullTrack::begin(hull, leg(&hull, place_m))
        };
        let mut jumped = track(HULL);
        jumped.go_on(at(50.0, DVec2::new(300.0, 70.0)));
        assert!(jumped.nodes.is_empty(), "70 m beside the track");
        let mut moved = track(HULL);
        moved.go_on(at(50.0, DVec2::new(300.0, 20.0)));
        assert!(moved.nodes.len() > 1);
        // Corrected from 30 s on.
        moved.go_on(at(30.0, DVec2::new(180.0, 0.0)));
        assert!(moved.nodes.iter().all(|node| node.time_s < 30.0) && moved.leg.time_s == 30.0);
        // At an earlier time the hull was where it was.
        let past = states(&moved, 20.0);
        assert!((past[0].place_m - DVec2::new(120.0, 0.0)).length() < 1e-9 && past[0].time_s == 20.0);
        assert!(states(&moved, -1.0).is_empty());
        moved.end(100.0);
        assert_eq!(states(&moved, 150.0)[0].time_s, 100.0);
        assert!(moved.has_waves(100.0 + MOST_AGE_S - 1.0) && !moved.has_waves(100.0 + MOST_AGE_S));
        moved.go_on(at(400.0, DVec2::new(2400.0, 0.0)));
        assert!(moved.nodes.is_empty() && moved.ended_s.is_none(), "it had ended");
    }
}
