//! Shells of the drops' lattice: nested cubes of air around the camera. Their sizes, their motion up to a time, and the
//! share of their drops that is shown at a distance.

use glam::DVec3;

use crate::{
    falling::{lattice::fraction, random3},
    numerics::smoothstep,
};

/// Number of shells of the lattice.
pub const SHELLS: usize = 4;
/// Number of classes of diameter.
pub const CLASSES: usize = 32;
/// Side of the innermost shell's cell, m.
pub const SIDE_M: f64 = 4.0;
/// Unit of fall speeds, m/s. Fall speeds are integer multiples of it.
pub const SPEED_UNIT: f64 = 1.0 / 64.0;
/// Ratios of the sides of the shells' cells to that of the innermost: each is 2^(1/3) times the one before.
const WIDER: [f64; SHELLS] = [1.0, 1.259_921_049_894_873_2, 1.587_401_051_968_199_4, 2.0];
/// Distance from the camera beyond which no drop of the lattice is drawn, m.
pub const REACH_M: f64 = 0.5 * SIDE_M * WIDER[SHELLS - 1];

/// Distance at which a shell begins to fade out and the next larger one to fade in, as a share of the shell's reach
/// (half its side). Both fades end at the full reach.
pub(crate) const FADE: f64 = 0.85;
/// Distance from the camera within which rain is drawn as drops instead of as extinction, m: the middle of the
/// outermost shell's fade.
pub const HIDDEN_M: f64 = 0.5 * (1.0 + FADE) * REACH_M;
/// Distance below which drops fade out towards the camera, m: `NEAREST` of `shaders/rain/drops.wgsl`.
const NEAREST_M: f64 = 0.25;

/// Returns [`HIDDEN_M`] for the first `shells` shells alone, m.
pub fn hidden_m(shells: usize) -> f64 {
    shells.checked_sub(1).map_or(0.0, |last| 0.25 * (1.0 + FADE) * side_m(last))
}

/// Returns the side of a shell's cell, m.
pub fn side_m(shell: usize) -> f64 {
    SIDE_M * WIDER[shell]
}

/// Displacement of a shell's lattice at a time, in 2^-32 of the cell's side.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Moment {
    /// Displacement of the air, (east, north, up).
    pub air: [u32; 3],
    /// Distance fallen at a speed of one unit.
    pub fall: u32,
}

impl Moment {
    /// Creates the displacement of the lattice of `shell` after the air has moved by `displacement_m` and drops have
    /// fallen for `time_s`.
    pub fn new(shell: usize, displacement_m: DVec3, time_s: f64) -> Self {
        let side = side_m(shell);
        Self {
            air: displacement_m.to_array().map(|d| fraction(d, side)),
            fall: fraction((time_s * SPEED_UNIT) % side, side),
        }
    }

    /// Returns the place of a drop in its cell.
    pub fn place(&self, seed: u32, shell: usize, class: usize, index: u32, speed_units: u32) -> [u32; 3] {
        let start = random3([seed, (shell as u32) << 8 | class as u32, index]);
        let mut place = [0, 1, 2].map(|i| start[i].wrapping_add(self.air[i]));
        place[2] = place[2].wrapping_sub(speed_units.wrapping_mul(self.fall));
        place
    }

    /// Returns the place of a camera at `position_m` (east, north and up from a point fixed to the world) in the cell
    /// that moves with the air. A drop's position relative to the camera is its start minus its fall minus this place.
    pub fn camera(&self, shell: usize, position_m: DVec3) -> [u32; 3] {
        let p = position_m.to_array().map(|x| fraction(x, side_m(shell)));
        [0, 1, 2].map(|i| p[i].wrapping_sub(self.air[i]))
    }
}

/// Returns the share of each drop of `shell` that is shown at `distance_m`, 0 to 1. The shell fades in where the next
/// smaller shell fades out, and fades out where the next larger shell fades in. The innermost shell fades in from 0.125
/// to 0.25 m.
pub fn shell_share(shell: usize, distance_m: f64) -> f64 {
    let reach = 0.5 * side_m(shell);
    let outer = 1.0 - smoothstep(FADE * reach, reach, distance_m);
    let inner = if shell == 0 {
        smoothstep(0.5 * NEAREST_M, NEAREST_M, distance_m)
    } else {
        let last = 0.5 * side_m(shell - 1);
        smoothstep(FADE * last, last, distance_m)
    };
    inner * outer
}
