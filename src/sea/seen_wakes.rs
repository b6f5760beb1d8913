//! Wakes as shaders look them up: the hulls and their tracks around an anchor near the camera.

use glam::DVec2;

use super::{
    held::MOST_TRACKS,
    hull::MAX_SEA_HULLS,
    mesh::{MeshBlock, MeshEye},
    track::{MOST_AGE_S, MOST_NODES},
    wake::transverse_length_m,
    wake_field::{Wake, WakeState},
};

/// A wake (`SeaWake` of `shaders/sea/uniform.wgsl`).
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, bytemuck::Pod, bytemuck::Zeroable)]
pub(super) struct WakeUniform {
    pub middle: [f32; 2],
    pub reach2: f32,
    pub states: u32,
    pub length: f32,
    pub beam: f32,
    pub draught: f32,
    pub newest: f32,
    pub oldest: f32,
    pub least_turns: f32,
    pub first: u32,
    pub pad: f32,
}

/// A state of a hull (`HullState` of `shaders/sea/uniform.wgsl`).
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, bytemuck::Pod, bytemuck::Zeroable)]
pub(super) struct StateUniform {
    pub place: [f32; 2],
    pub velocity: [f32; 2],
    pub age: f32,
    pub turn: f32,
    pub ahead: [f32; 2],
}

/// Most states of all hulls. They fill a uniform block of 16 kB, the largest that every device supports. Hulls that
/// turn all the time have up to [`MOST_NODES`] states, others few.
pub(super) const MOST_TRACK_STATES: usize = 8 * MOST_NODES;

/// Returns the indices, in rising order, of the wakes that a camera may see, and their number. Where there are too
/// many, wakes are taken from near to far, each if it still fits.
fn nearest(wakes: &[Wake], eye: &MeshEye) -> ([usize; MAX_SEA_HULLS], usize) {
    // Each with its distance from the camera, from near to far.
    let (mut near, mut count) = ([(f64::INFINITY, 0); MOST_TRACKS], 0);
    for (index, wake) in wakes.iter().enumerate().take(MOST_TRACKS) {
        let Some((middle, radius)) = wake.circle() else { continue };
        let distance = (middle - eye.place_m).length() - radius;
        if distance <= eye.reach_m {
            near[count] = (distance, index);
            count += 1;
        }
    }
    near[..count].sort_unstable_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
    let (mut chosen, mut taken, mut states) = ([0; MAX_SEA_HULLS], 0, 0);
    for (_, index) in &near[..count] {
        let more = wakes[*index].states.len();
        if taken < MAX_SEA_HULLS && states + more <= MOST_TRACK_STATES {
            chosen[taken] = *index;
            (taken, states) = (taken + 1, states + more);
        }
    }
    chosen[..taken].sort_unstable();
    (chosen, taken)
}

/// Wakes that a camera may see.
#[derive(Clone, Debug, Default)]
pub(super) struct SeenWakes {
    pub list: Vec<WakeUniform>,
    /// States of each, from new to old.
    pub states: Vec<StateUniform>,
}

impl SeenWakes {
    /// Collects the wakes within `eye.reach_m` of the camera: all of them, or the nearest [`MAX_SEA_HULLS`] with no
    /// more than [`MOST_TRACK_STATES`] states, in the order of `wakes`.
    pub fn fill(&mut self, wakes: &[Wake], eye: &MeshEye) {
        self.list.clear();
        self.states.clear();
        let anchor = eye.anchor_m();
        let (chosen, count) = nearest(wakes, eye);
        for wake in chosen[..count].iter().map(|index| &wakes[*index]) {
            let Some((middle, radius)) = wake.circle() else { continue };
            let [newest, oldest] = [0, wake.states.len() - 1].map(|i| wake.time_s - wake.states[i].node.time_s);
            let fastest = wake.states.iter().map(|state| state.node.speed_m_s).fold(0.1, f64::max);
            self.list.push(WakeUniform {
                middle: (middle - anchor).as_vec2().to_array(),
                reach2: (radius * radius) as f32,
                states: wake.states.len() as u32,
                length: wake.hull.length_m as f32,
                beam: wake.hull.beam_m as f32,
                draught: wake.hull.draught_m as f32,
                newest: newest as f32,
                oldest: oldest.min(MOST_AGE_S) as f32,
                least_turns: (1.0 / transverse_length_m(fastest)) as f32,
                first: self.states.len() as u32,
                pad: 0.0,
            });
            self.states.extend(wake.states.iter().map(|WakeState { node, turn_rad_s }| StateUniform {
                place: (node.place_m - anchor).as_vec2().to_array(),
                velocity: node.velocity().as_vec2().to_array(),
                age: (wake.time_s - node.time_s) as f32,
                turn: *turn_rad_s as f32,
                ahead: node.ahead.as_vec2().to_array(),
            }));
        }
    }

    /// Whether the water of a block of the mesh, which moves by at most `displaced_m`, may be in a wake.
    pub fn touch(&self, block: &MeshBlock, displaced_m: f64) -> bool {
        let (middle, radius_m) = block.circle();
        let around = radius_m + displaced_m;
        self.list.iter().any(|wake| {
            let off = middle - DVec2::from(wake.middle.map(f64::from));
            off.length() <= f64::from(wake.reach2).sqrt() + around
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sea::{hull::SeaHull, track::tests::track};

    /// Eight hulls that circle take all states of a block; the ninth, last in the list, passes the camera.
    #[test]
    fn the_nearest_wakes_are_seen_where_there_are_too_many() {
        let circling = SeaHull { speed_m_s: 6.0, turn_deg_s: 5.0, ..SeaHull::default() };
        let passing = SeaHull { heading_deg: 90.0, speed_m_s: 20.0, ..SeaHull::default() };
        let wakes: Vec<Wake> = std::iter::repeat_n(circling, 8)
            .chain([passing])
            .map(|hull| {
                let mut wake = Wake::default();
                wake.fill(&track(hull), 400.0);
                wake
            })
            .collect();
        assert!(wakes.iter().map(|wake| wake.states.len()).sum::<usize>() > MOST_TRACK_STATES);
        let eye = MeshEye { place_m: DVec2::new(8000.0, 0.0), height_m: 10.0, reach_m: 2e4 };
        let mut seen = SeenWakes::default();
        seen.fill(&wakes, &eye);
        assert!(seen.states.len() <= MOST_TRACK_STATES);
        let lengths: Vec<u32> = seen.list.iter().map(|wake| wake.states).collect();
        assert_eq!(lengths.last().copied(), Some(wakes[8].states.len() as u32), "{lengths:?}");
        assert_eq!(seen.list.len(), 8, "seven circles and the one that passes");
    }
}
