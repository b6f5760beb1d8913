//! Places of flakes without a state: a lattice of cells that moves with the air. Each flake has a random place in its
//! cell and falls through it at its own speed, on its own helix.
//!
//! A shell is a cube of side L full of flakes, repeated in all directions; each flake is drawn at the copy nearest to
//! the camera. Places, falls and turns are fractions in 32 bits and wrap as the lattice does
//! (`src/falling/lattice.rs`): place = random(seed, shell, class, index) + displacement of the air - speed x fall
//! phase. The fall phase is the distance fallen at a speed of one unit; the last term of the sum applies to the height
//! only. The helix adds a horizontal offset at the angle random + turns x turn phase. The turn phase is the angle
//! turned at a rate of one unit. Speeds and turns are integer multiples of [`SPEED_UNIT`] and [`TURN_UNIT`], and
//! therefore exact at any time. Within a class each flake has its own speed and turns, up to an eighth faster or
//! slower: the measured speeds of flakes of one size scatter by as much about the laws of Locatelli and Hobbs.
//!
//! Each shell is twice as wide as the one before. If a shell has no room for all its flakes, it draws some flakes that
//! represent others. The numbers per class are chosen so that every drawn flake, together with the flakes that it
//! represents, covers the same area. Of all choices, this keeps the contrast closest to that of all flakes (importance
//! sampling by area). Shells whose contrast would be too high by more than a factor of the square root of 3 are not
//! drawn, except the innermost one. The flakes of shells that are not drawn are extinction, drawn with the fog.

use glam::DVec3;

use crate::falling::{
    flakes::{FlakeSizes, PARTS, Swirl, seen_area_m2},
    lattice::{fraction, nearest, short_seed},
    random3,
};
use crate::numerics::smoothstep;

/// Number of shells of the lattice.
pub const SHELLS: usize = 4;
/// Number of classes of size, of all kinds together.
pub const CLASSES: usize = 32;
/// Number of classes of aggregates, of grains and of crystals.
const CLASSES_OF: [usize; PARTS] = [20, 6, 6];
/// Side of the innermost shell's cell, m.
pub const SIDE_M: f64 = 4.0;
/// Unit of fall speeds, m/s. Fall speeds are integer multiples of it.
pub const SPEED_UNIT: f64 = 1.0 / 1024.0;
/// Unit of turns, 1/s. Turns are integer multiples of it.
pub const TURN_UNIT: f64 = 1.0 / 256.0;
/// Distance at which a shell begins to fade out and the next larger one to fade in, as a share of the shell's reach
/// (half its side). Both fades end at the full reach.
pub const FADE: f64 = 0.85;
/// Distance below which flakes fade out towards the camera, m: `NEAREST` of `shaders/snow/flakes.wgsl`.
pub const NEAREST_M: f64 = 0.3;
/// Largest ratio of the variance of the drawn flakes' cover to that of all flakes, at which a shell is still drawn.
const MOST_NOISE: f64 = 3.0;
/// Offset that gives flakes other random numbers than drops: `SALT` of `shaders/snow/flakes.wgsl`.
pub(super) const SALT: u32 = 0x5e0_0000;

/// Returns the side of a shell's cell, m.
pub fn side_m(shell: usize) -> f64 {
    SIDE_M * f64::from(1u32 << shell)
}

/// Flakes of each class in each shell.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Flakes {
    /// Per class: diameter (m), fall speed (speed units), radius of the helix (m), turns (turn units).
    pub table: [[f32; 4]; CLASSES],
    /// Per class and shell: number of drawn flakes of the classes up to this one.
    pub upto: [[u32; SHELLS]; CLASSES],
    /// Per class and shell: number of flakes that each drawn flake represents.
    pub weight: [[f32; SHELLS]; CLASSES],
    /// Number of flakes of each class in a cubic metre of air.
    pub number_per_m3: [f64; CLASSES],
    /// Number of drawn shells; 0 if there are no flakes.
    pub shells: usize,
    /// Number of drawn flakes in all shells.
    pub drawn: u32,
    /// Extinction by the flakes' ice, which hides the background, 1/m. It is half of the flakes' extinction. The other
    /// half is diffraction.
    pub hidden_per_m: f64,
}

/// Returns the number of flakes that a drawn flake of each class represents, so that `room` drawn flakes represent all
/// flakes of a volume. Also returns the ratio of the variance of the drawn flakes' cover to that of all flakes.
/// `numbers` is per cubic metre, `areas` the area of a flake, m^2.
fn thinned(numbers: &[f64; CLASSES], areas: &[f64; CLASSES], volume_m3: f64, room: f64) -> ([f64; CLASSES], f64) {
    let weights = |level: f64| areas.map(|a| (level / a.max(1e-12)).max(1.0));
    let count = |w: &[f64; CLASSES]| numbers.iter().zip(w).map(|(n, w)| n * volume_m3 / w).sum::<f64>();
    let (mut low, mut high) = (1e-12, 1e3);
    if count(&weights(low)) > room {
        for _ in 0..80 {
            let middle = f64::sqrt(low * high);
            if count(&weights(middle)) > room { low = middle } else { high = middle }
        }
    } else {
        high = low;
    }
    let w = weights(high);
    let squares = |w: &[f64; CLASSES]| (0..CLASSES).map(|k| numbers[k] * areas[k] * areas[k] * w[k]).sum::<f64>();
    (w, squares(&w) / squares(&[1.0; CLASSES]).max(1e-300))
}

impl Flakes {
    /// Creates the flakes of these sizes. At most `most` are drawn. `begun` is the share of the flakes that has begun
    /// to fall at the camera's altitude.
    pub fn new(sizes: &FlakeSizes, begun: f64, most: u32) -> Self {
        let mut this = Self {
            table: [[0.0; 4]; CLASSES],
            upto: [[0; SHELLS]; CLASSES],
            weight: [[1.0; SHELLS]; CLASSES],
            number_per_m3: [0.0; CLASSES],
            shells: 0,
            drawn: 0,
            hidden_per_m: 0.0,
        };
        let mut areas = [1e-9; CLASSES];
        let mut first = 0;
        for (part, count) in CLASSES_OF.into_iter().enumerate() {
            let (low, high) = sizes.range_mm(part);
            let edge = |i: usize| low * libm::pow(high / low, i as f64 / count as f64);
            for i in 0..count {
                let k = first + i;
                let d = (edge(i) * edge(i + 1)).sqrt();
                let area = begun * sizes.area_between(part, edge(i), edge(i + 1));
                let speed = sizes.speed_m_s(part, d);
                let swirl = Swirl::new(d, speed);
                areas[k] = seen_area_m2(d);
                this.number_per_m3[k] = area / areas[k];
                this.hidden_per_m += area;
                this.table[k] =
                    [1e-3 * d, (speed / SPEED_UNIT).round(), swirl.radius_m, (swirl.turns_per_s / TURN_UNIT).round()]
                        .map(|v| v as f32);
            }
            first += count;
        }
        if this.hidden_per_m > 0.0 {
            this.fill(&areas, f64::from(most));
        }
        this
    }

    /// Chooses the largest number of shells for which there is room, and fills them from the innermost.
    fn fill(&mut self, areas: &[f64; CLASSES], most: f64) {
        let all: f64 = self.number_per_m3.iter().sum();
        for shells in (1..=SHELLS).rev() {
            let (mut left, mut noise) = (most, 0.0);
            let mut weights = [[1.0; CLASSES]; SHELLS];
            for (shell, weights) in weights.iter_mut().enumerate().take(shells) {
                let volume = side_m(shell).powi(3);
                let room = (left / (shells - shell) as f64).min(all * volume);
                (*weights, noise) = thinned(&self.number_per_m3, areas, volume, room);
                left -= room;
            }
            if noise > MOST_NOISE && shells > 1 {
                continue;
            }
            self.shells = shells;
            for (shell, weights) in weights.iter().enumerate().take(shells) {
                let mut sum = 0.0f64;
                for (k, weight) in weights.iter().enumerate() {
                    sum += self.number_per_m3[k] * side_m(shell).powi(3) / weight;
                    self.upto[k][shell] = (sum + 1e-6) as u32;
                    self.weight[k][shell] = *weight as f32;
                }
                self.drawn += self.upto[CLASSES - 1][shell];
            }
            return;
        }
    }

    /// Returns the number of flakes in each shell.
    pub fn counts(&self) -> [u32; SHELLS] {
        std::array::from_fn(|s| if s < self.shells { self.upto[CLASSES - 1][s] } else { 0 })
    }

    /// Returns the distance beyond which no flake is drawn, m.
    pub fn reach_m(&self) -> f64 {
        self.shells.checked_sub(1).map_or(0.0, |last| 0.5 * side_m(last))
    }

    /// Returns the distance within which the drawn flakes replace the extinction of the snow, m: the middle of the
    /// outermost shell's fade.
    pub fn hidden_m(&self) -> f64 {
        0.5 * (1.0 + FADE) * self.reach_m()
    }

    /// Returns the lowest fall speed, m/s, including the scatter within a class.
    pub fn slowest_m_s(&self) -> f64 {
        let there = (0..CLASSES).filter(|k| self.number_per_m3[*k] > 0.0);
        there.map(|k| f64::from(self.table[k][1]) * SPEED_UNIT * 0.87).fold(f64::INFINITY, f64::min)
    }
}

/// Displacement of a shell's lattice at a time, in 2^-32 of the cell's side, and the turn of its flakes, in 2^-32 of a
/// turn.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Moment {
    /// Displacement of the air, (east, north, up).
    pub air: [u32; 3],
    /// Distance fallen at a speed of one unit.
    pub fall: u32,
    /// Turn at a rate of one turn unit.
    pub turn: u32,
}

impl Moment {
    /// Creates the displacement and the turn for `shell` after the air has moved by `displacement_m`, (east, north,
    /// up), and flakes have fallen for `time_s`.
    pub fn new(shell: usize, displacement_m: DVec3, time_s: f64) -> Self {
        let side = side_m(shell);
        Self {
            air: displacement_m.to_array().map(|d| fraction(d, side)),
            fall: fraction((time_s * SPEED_UNIT) % side, side),
            turn: fraction((time_s * TURN_UNIT) % 1.0, 1.0),
        }
    }
}

/// One flake of the lattice.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Flake {
    /// Identity of the flake: shell, class and index.
    pub id: (u32, u32, u32),
    /// Place in the cell, without the helix.
    pub place: [u32; 3],
    /// Angle on the helix, in 2^-32 of a turn.
    pub angle: u32,
    /// Position of the nearest copy relative to the camera, with the helix, m.
    pub position_m: DVec3,
    /// Velocity relative to the air, m/s.
    pub velocity_m_s: DVec3,
    /// Diameter, m.
    pub diameter_m: f64,
    /// Share of the flake that its shell shows at this distance, 0 to 1.
    pub share: f64,
    /// Number of flakes that the drawn flake represents.
    pub weight: f64,
}

/// Returns the fall speed (speed units), the turns (turn units; two's complement if negative) and the first angle
/// (2^-32 of a turn) of a flake of a class, from its three random words.
fn own(random: [u32; 3], class: &[f32; 4]) -> (u32, u32, u32) {
    let scattered = |units: u32, random: u32| {
        let scatter = (random & 255) as i32 - 128;
        (units as i32 + ((units as i32 * scatter) >> 10)) as u32
    };
    let turns = scattered(class[3] as u32, random[1]);
    let turns = if random[2] & 1 == 0 { turns } else { turns.wrapping_neg() };
    (scattered(class[1] as u32, random[0]), turns, random[2] << 16)
}

/// Returns the share of each flake of `shell` that is shown at `distance_m`, 0 to 1.
pub fn shell_share(shell: usize, distance_m: f64) -> f64 {
    let reach = 0.5 * side_m(shell);
    let outer = 1.0 - smoothstep(FADE * reach, reach, distance_m);
    let inner = if shell == 0 {
        smoothstep(0.5 * NEAREST_M, NEAREST_M, distance_m)
    } else {
        smoothstep(FADE * 0.5 * reach, 0.5 * reach, distance_m)
    };
    inner * outer
}

/// Returns all flakes as seen by a camera at `position_m` (east, north and up from a point fixed to the world), after
/// the air has moved by `displacement_m` in `time_s`. Two cameras see the same flake under the same id. Reference in
/// f64 of `flake_of` in `shaders/snow/flakes.wgsl`; places and angles have the same bits there.
pub fn flakes(
    flakes: &Flakes,
    seed: u64,
    position_m: DVec3,
    displacement_m: DVec3,
    time_s: f64,
) -> impl Iterator<Item = Flake> {
    let seed = short_seed(seed);
    (0..flakes.shells).flat_map(move |shell| {
        let side = side_m(shell);
        let moment = Moment::new(shell, displacement_m, time_s);
        let eye = position_m.to_array().map(|x| fraction(x, side));
        (0..CLASSES).flat_map(move |class| {
            let row = flakes.table[class];
            let before = if class > 0 { flakes.upto[class - 1][shell] } else { 0 };
            (0..flakes.upto[class][shell] - before).map(move |index| {
                let id = (shell as u32, class as u32, index);
                let random = random3([seed, SALT | id.0 << 8 | id.1, index]);
                let (speed, turns, start) = own(random, &row);
                let mut place = [0, 1, 2].map(|i| random[i].wrapping_add(moment.air[i]));
                place[2] = place[2].wrapping_sub(speed.wrapping_mul(moment.fall));
                let angle = start.wrapping_add(turns.wrapping_mul(moment.turn));
                let middle = nearest(place, eye, side);
                let (sin, cos) = libm::sincos(f64::from(angle) / 4_294_967_296.0 * std::f64::consts::TAU);
                let radius = f64::from(row[2]);
                let around = f64::from(turns as i32) * TURN_UNIT * std::f64::consts::TAU * radius;
                Flake {
                    id,
                    place,
                    angle,
                    position_m: middle + DVec3::new(cos, sin, 0.0) * radius,
                    velocity_m_s: DVec3::new(-sin * around, cos * around, -f64::from(speed) * SPEED_UNIT),
                    diameter_m: f64::from(row[0]),
                    share: shell_share(shell, middle.length()),
                    weight: f64::from(flakes.weight[class][shell]),
                }
            })
        })
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::weather::{Precipitation, PrecipitationKind, Weather, derive};

    /// Returns the sizes of flakes in precipitation of `rate` mm/h at `t` C, at sea level.
    fn sizes(kind: PrecipitationKind, rate: f64, t: f64) -> FlakeSizes {
        let weather = Weather { precipitation: Precipitation::of(kind, rate), ..Weather::default() };
        FlakeSizes::new(&derive(&weather).unwrap().precipitation, t, 1.0)
    }

    #[test]
    fn thinning_keeps_what_flakes_hide_and_their_contrast_within_bounds() {
        for (kind, rate, t) in [
            (PrecipitationKind::Snow, 0.2, -10.0),
            (PrecipitationKind::Snow, 1.0, -2.0),
            (PrecipitationKind::Snow, 6.0, 0.0),
            (PrecipitationKind::SnowGrains, 0.2, -4.0),
            (PrecipitationKind::IceCrystals, 0.05, -20.0),
        ] {
            let sizes = sizes(kind, rate, t);
            for most in [20_000, 200_000, 2_000_000] {
                let f = Flakes::new(&sizes, 1.0, most);
                assert!(f.drawn <= most && f.shells > 0, "{kind:?} {rate}: {} of {most}", f.drawn);
                assert!((f.hidden_per_m / (0.49 * sizes.extinction_per_m()) - 1.0).abs() < 1e-6, "{}", f.hidden_per_m);
                for shell in 0..f.shells {
                    let hidden: f64 = (0..CLASSES)
                        .map(|k| {
                            let before = if k > 0 { f.upto[k - 1][shell] } else { 0 };
                            let n = f64::from(f.upto[k][shell] - before) * f64::from(f.weight[k][shell]);
                            n * seen_area_m2(1e3 * f64::from(f.table[k][0]))
                        })
                        .sum::<f64>()
                        / side_m(shell).powi(3);
                    assert!((hidden / f.hidden_per_m - 1.0).abs() < 0.02, "{kind:?} {rate} {most} {shell}: {hidden}");
                }
            }
            let reach = |most| Flakes::new(&sizes, 1.0, most).reach_m();
            assert!(reach(20_000) <= reach(200_000) && reach(200_000) <= reach(4_000_000));
        }
        let none = Flakes::new(&sizes(PrecipitationKind::Rain, 5.0, 2.0), 1.0, 1000);
        assert_eq!((none.drawn, none.shells, none.hidden_per_m), (0, 0, 0.0));
    }

    #[test]
    fn a_flake_moves_with_the_air_at_its_own_speed_and_no_change_of_wind_throws_it() {
        let f = Flakes::new(&sizes(PrecipitationKind::Snow, 1.0, 0.0), 1.0, 3000);
        let eye = DVec3::new(3.0, -2.0, 40.0);
        for t in [0.0, 17.3, 86_400.0, 1e7] {
            for (wind, dt) in
                [(DVec3::new(12.0, -5.0, 0.0), 1e-3), (DVec3::ZERO, 2e-3), (DVec3::new(-20.0, 3.0, 0.0), 1e-3)]
            {
                let far = DVec3::new(123.4, 7.0, 0.0) * t;
                let a: Vec<Flake> = flakes(&f, 9, eye, far, t).collect();
                let b: Vec<Flake> = flakes(&f, 9, eye, far + wind * dt, t + dt).collect();
                for (a, b) in a.iter().zip(&b) {
                    assert_eq!(a.id, b.id);
                    let want = (wind + 0.5 * (a.velocity_m_s + b.velocity_m_s)) * dt;
                    let side = side_m(a.id.0 as usize);
                    let off = (b.position_m - a.position_m - want) / side;
                    let off = (off - off.round()) * side;
                    assert!(off.length() < 5e-6, "{:?} at {t}: {off}", a.id);
                }
            }
        }
    }

    #[test]
    fn two_channels_see_the_same_flakes_bit_for_bit() {
        let f = Flakes::new(&sizes(PrecipitationKind::Snow, 2.0, -3.0), 1.0, 5000);
        let (air, t) = (DVec3::new(1e5, 3e4, 0.0), 12_345.678);
        let at = DVec3::new(1e4, -2e4, 120.0);
        let left: Vec<Flake> = flakes(&f, 77, at, air, t).collect();
        let right: Vec<Flake> = flakes(&f, 77, at + DVec3::new(0.8, 0.3, -0.1), air, t).collect();
        assert!(left.len() > 1000);
        for (a, b) in left.iter().zip(&right) {
            assert_eq!((a.id, a.place, a.angle), (b.id, b.place, b.angle));
        }
        let other = flakes(&f, 78, at, air, t).next().unwrap();
        assert_ne!(other.place, left[0].place);
    }

    #[test]
    fn the_shares_of_all_shells_add_up_to_one() {
        for i in 0..1000 {
            let d = NEAREST_M + f64::from(i) * 0.0135;
            let sum: f64 = (0..SHELLS).map(|s| shell_share(s, d)).sum();
            assert!((sum - 1.0).abs() < 1e-12 || d > FADE * 16.0, "{d}: {sum}");
        }
    }
}
