//! The sea's surface at a time: waves and tiles with their phases, and the solution for a fixed place.
//!
//! Waves carry the water around: the particle whose place at rest is X is at the place X + D(X), at the height h(X)
//! (Gerstner 1809; Tessendorf 2001). A query at a place x solves X + D(X) = x by Newton's method and reads height,
//! slope, velocity and acceleration of that particle. Because crests are narrower than troughs, the mean level over
//! fixed places would fall. The fall is the sum over the waves of k coth(k d) times variance, with the depth d. The
//! surface is raised by as much.

use glam::{DVec2, DVec3};

use super::{
    fft::SIDE,
    foam::FoamLaw,
    lanes::{Displacement, IncludedLanes, ParticleMotion, Phases, SurfaceWave, WaveLanes},
    lattice::SeaWave,
    regions::WaterBody,
    tiles::{TILES, TileWork, VALUES, WaveTiles, sample},
    wake_field::{Wake, WakePoint},
};

/// Largest distance, m, between the place asked for and the one solved for, and largest number of steps of the
/// solution.
const SOLVED_M: f64 = 5e-4;
const MOST_STEPS: usize = 12;
/// Standard deviations that a stated bound allows for: at 1 place in 16,000 the error is larger.
const BOUND_DEVIATIONS: f64 = 4.0;

/// The sea at a place and time. Where there is no water all numbers are 0, and the normal is up. In a dry region the
/// numbers are those of the water around, by which a hull floats.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct SeaPoint {
    /// Whether there is water. `false` also in a dry region.
    pub has_water: bool,
    /// Point of the surface above or below the place that was asked about, in the host's world, m; without water that
    /// place itself.
    pub surface: DVec3,
    /// Height of the surface above mean sea level, m.
    pub height_m: f64,
    /// Largest error of the height, m: 4 standard deviations of the waves left out and of the interpolation in tiles,
    /// the tolerance of the solution, and the amplitudes of the waves of wakes that were left out.
    pub height_error_m: f64,
    /// Unit normal of the surface (east, north, up).
    pub normal: DVec3,
    /// Velocity of the water at the surface by waves alone, without any drift, m/s (east, north, up).
    pub velocity_m_s: DVec3,
    /// Acceleration of the water at the surface, m/s^2 (east, north, up).
    pub acceleration_m_s2: DVec3,
    /// Depth of the water under the surface, m.
    pub depth_m: f64,
    /// Share of the place under foam, 0 to 1: foam of waves that break now, foam that waves of the last 3.6 s have
    /// left, and the wash of hulls.
    pub foam: f64,
}

/// A tile's fields at the surface's time.
#[derive(Clone, Debug)]
pub(super) struct TileFields {
    /// B-spline coefficients.
    pub fields: Vec<[f64; VALUES]>,
    pub length_m: f64,
    /// Cosine and sine of the tile's turn.
    pub turn: DVec2,
    /// Variance of heights, m^2. If it is 0, the tile's fields are those of an earlier time.
    pub variance_m2: f64,
    /// Lowering of the mean level, m.
    pub lowering_m: f64,
    image_m2: f64,
    shortest_m: f64,
    longest_m: f64,
}

/// Values of the surface that hold everywhere.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct StillSea {
    /// Level without waves, m.
    pub level_m: f64,
    /// Depth below the level, m.
    pub depth_m: f64,
    /// Foam.
    pub foam: FoamLaw,
}

/// The surface at a time.
#[derive(Clone, Debug)]
pub(crate) struct SeaSurface {
    lanes: WaveLanes,
    tiles: Vec<TileFields>,
    still: StillSea,
    /// Variance of the heights of all waves, m^2.
    variance_m2: f64,
}

/// The particle that is at a place.
struct SolvedParticle {
    /// Its place at rest.
    rest: DVec2,
    moved: Displacement,
    /// The place asked for minus that of the particle, m.
    off: DVec2,
}

/// Waves of a query.
#[derive(Clone, Copy)]
struct IncludedWaves {
    lanes: IncludedLanes,
    tiles: [bool; TILES],
    raised_m: f64,
    error_m: f64,
    /// Factor on the amplitudes of all waves.
    share: f64,
}

impl SeaPoint {
    /// Returns the answer for a place without water.
    pub(crate) fn dry(position: DVec3) -> Self {
        Self { surface: position, normal: DVec3::Z, ..Self::default() }
    }

    /// Adds wakes at a place on the map, without waves shorter than `shortest_m`. Inside a dry region the wake of a
    /// hull that lies over the place is left out: a hull does not float by its own waves.
    pub(crate) fn add_wakes(&mut self, wakes: &[Wake], place_m: DVec2, shortest_m: f64) {
        let counts = |wake: &&Wake| wake.reaches(place_m) && (self.has_water || !wake.holds(place_m));
        if !wakes.iter().any(|wake| counts(&wake)) {
            return;
        }
        let mut sum = WakePoint::default();
        wakes.iter().filter(counts).for_each(|wake| wake.add_at(place_m, shortest_m, &mut sum));
        let slope = DVec2::new(-self.normal.x, -self.normal.y) / self.normal.z + sum.slope;
        self.height_m += sum.height_m;
        self.height_error_m += sum.left_out_m;
        self.normal = DVec3::new(-slope.x, -slope.y, 1.0).normalize();
        self.velocity_m_s += sum.velocity_m_s;
        self.acceleration_m_s2 += sum.acceleration_m_s2;
        self.depth_m = (self.depth_m + sum.height_m).max(0.0);
        self.foam = (self.foam + sum.foam).min(1.0);
    }
}

impl SeaSurface {
    pub fn new() -> Self {
        let none = || TileFields {
            fields: vec![[0.0; VALUES]; SIDE * SIDE],
            length_m: 1.0,
            turn: DVec2::X,
            variance_m2: 0.0,
            lowering_m: 0.0,
            image_m2: 0.0,
            shortest_m: 1.0,
            longest_m: 1.0,
        };
        let tiles = (0..TILES).map(|_| none()).collect();
        let still = StillSea { level_m: 0.0, depth_m: 0.0, foam: FoamLaw::NONE };
        Self { lanes: WaveLanes::default(), tiles, still, variance_m2: 0.0 }
    }

    /// Fills the surface with waves, which must be sorted from long to short, and with tiles, at a time.
    pub(super) fn fill(
        &mut self,
        waves: &[SeaWave],
        tiles: &WaveTiles,
        work: &mut TileWork,
        (still, time_s): (StillSea, f64),
    ) {
        self.still = still;
        self.lanes.fill(waves, time_s);
        self.variance_m2 = self.lanes.variance_m2();
        for (to, tile) in self.tiles.iter_mut().zip(&tiles.tiles) {
            (to.length_m, to.turn, to.shortest_m) = (tile.length_m, tile.turn, tile.shortest_m);
            (to.variance_m2, to.lowering_m, to.image_m2) =
                (tile.variance_m2, tile.narrowing_m[0] + tile.narrowing_m[1], tile.image_m2);
            to.longest_m = tile.length_m / super::tiles::LEAST_PERIODS;
            self.variance_m2 += tile.variance_m2;
            if tile.variance_m2 > 0.0 {
                tile.sum(time_s, work, &mut to.fields);
            }
        }
    }

    /// Returns the open sea at a place, as [`SeaSurface::within`].
    #[cfg(test)]
    pub fn at(&self, place_m: DVec2, shortest_m: f64) -> SeaPoint {
        self.within(&WaterBody::OPEN, place_m, shortest_m)
    }

    /// Returns the water at a place (east and north of the world's origin, m), with the single waves of at least the
    /// length `shortest_m` and the tiles that have such waves. The amplitudes of all waves are multiplied by the
    /// water's `wave_share`. The caller fills in the point's `surface`.
    pub fn within(&self, water: &WaterBody, place_m: DVec2, shortest_m: f64) -> SeaPoint {
        let share = water.wave_share;
        let included = IncludedWaves { share, ..self.included(shortest_m) };
        let mut phases = Phases::new();
        let SolvedParticle { rest, moved, off } = self.solve(place_m, &included, &mut phases, MOST_STEPS);
        let motion = self.motion(rest, &included, &phases);
        let slope = transposed_inverse_times(&moved.slopes, motion.slope);
        // The fall of the level is proportional to the square of the amplitudes.
        let height = motion.height + share * share * included.raised_m + slope.dot(off);
        let [level_m, depth_m] = water.lake.unwrap_or([self.still.level_m, self.still.depth_m]);
        let compression = -(moved.slopes[0] + moved.slopes[3]);
        let foam = if self.still.foam.from.is_finite() {
            let before = self.lanes.past_compression(&included.lanes, &phases);
            self.still.foam.share(compression, before.map(|compression| compression * share), share)
        } else {
            0.0
        };
        SeaPoint {
            has_water: !water.is_dry,
            surface: DVec3::ZERO,
            height_m: level_m + height,
            height_error_m: share * included.error_m + off.length() * slope.length() + SOLVED_M,
            normal: DVec3::new(-slope.x, -slope.y, 1.0).normalize(),
            velocity_m_s: motion.velocity,
            acceleration_m_s2: motion.acceleration,
            depth_m: (depth_m + height).max(0.0),
            foam,
        }
    }

    /// Returns the distance, m, between a place and the solution for it after `steps` steps.
    #[cfg(test)]
    pub(super) fn solved_off_m(&self, place_m: DVec2, steps: usize) -> f64 {
        let mut phases = Phases::new();
        self.solve(place_m, &self.included(0.0), &mut phases, steps).off.length()
    }

    /// Solves for the particle that is at a place, in at most `most_steps` steps. Writes the waves' phases at the
    /// particle to `phases`.
    fn solve(
        &self,
        place_m: DVec2,
        included: &IncludedWaves,
        phases: &mut Phases,
        most_steps: usize,
    ) -> SolvedParticle {
        let mut rest = place_m;
        let mut moved = self.displacement(rest, included, phases);
        let mut off = -moved.shift;
        for _ in 0..most_steps {
            if off.length_squared() <= SOLVED_M * SOLVED_M {
                break;
            }
            rest += inverse_times(&moved.slopes, off);
            moved = self.displacement(rest, included, phases);
            off = place_m - rest - moved.shift;
        }
        SolvedParticle { rest, moved, off }
    }

    /// Returns the waves that a query sums if its shortest wave length is `shortest_m`, and a bound of the error by
    /// those left out.
    fn included(&self, shortest_m: f64) -> IncludedWaves {
        let lanes = self.lanes.included(shortest_m);
        let (mut raised_m, mut variance, mut images) = (lanes.lowering_m, lanes.variance_m2, 0.0);
        let mut tiles = [false; TILES];
        for (is_in, tile) in tiles.iter_mut().zip(&self.tiles) {
            *is_in = tile.variance_m2 > 0.0 && tile.longest_m >= shortest_m;
            if *is_in {
                raised_m += tile.lowering_m;
                variance += tile.variance_m2;
                images += tile.image_m2;
            }
        }
        let left_out = (self.variance_m2 - variance).max(0.0);
        // Rounding leaves some 1e-16 of the variance.
        let left_out = if left_out < 1e-12 * self.variance_m2 { 0.0 } else { left_out };
        IncludedWaves { lanes, tiles, raised_m, error_m: BOUND_DEVIATIONS * (left_out + images).sqrt(), share: 1.0 }
    }

    fn displacement(&self, rest: DVec2, included: &IncludedWaves, phases: &mut Phases) -> Displacement {
        let mut out = self.lanes.displacement(rest, &included.lanes, phases);
        for (tile, _) in self.tiles.iter().zip(included.tiles).filter(|(_, is_in)| *is_in) {
            let found = sample::<3>(&tile.fields, tile.length_m, to_tile(tile.turn, rest));
            out.shift += from_tile(tile.turn, DVec2::new(found.values[1], found.values[2]));
            let [dx, dy] = [found.along_x, found.along_y].map(|d| from_tile(tile.turn, DVec2::new(d[1], d[2])));
            // Derivatives along the tile's axes, turned into those along east and north.
            let (c, s) = (tile.turn.x, tile.turn.y);
            let east = dx * c - dy * s;
            let north = dx * s + dy * c;
            let turned = [east.x, north.x, east.y, north.y];
            out.slopes.iter_mut().zip(turned).for_each(|(sum, slope)| *sum += slope);
        }
        Displacement { shift: out.shift * included.share, slopes: out.slopes.map(|slope| slope * included.share) }
    }

    /// Returns height and motion of the particle at rest at a place whose phases are known.
    fn motion(&self, rest: DVec2, included: &IncludedWaves, phases: &Phases) -> ParticleMotion {
        let mut out = self.lanes.motion(&included.lanes, phases);
        for (tile, _) in self.tiles.iter().zip(included.tiles).filter(|(_, is_in)| *is_in) {
            let found = sample::<VALUES>(&tile.fields, tile.length_m, to_tile(tile.turn, rest));
            let v = found.values;
            out.height += v[0];
            out.slope += from_tile(tile.turn, DVec2::new(found.along_x[0], found.along_y[0]));
            out.velocity += from_tile(tile.turn, DVec2::new(v[4], v[5])).extend(v[3]);
            out.acceleration += from_tile(tile.turn, DVec2::new(v[7], v[8])).extend(v[6]);
        }
        let share = included.share;
        ParticleMotion {
            height: out.height * share,
            slope: out.slope * share,
            velocity: out.velocity * share,
            acceleration: out.acceleration * share,
        }
    }
}

/// Turns a vector (east, north) into a tile's axes.
pub(super) fn to_tile(turn: DVec2, v: DVec2) -> DVec2 {
    DVec2::new(turn.x * v.x + turn.y * v.y, turn.x * v.y - turn.y * v.x)
}

/// Turns a vector in a tile's axes into (east, north).
pub(super) fn from_tile(turn: DVec2, v: DVec2) -> DVec2 {
    DVec2::new(turn.x * v.x - turn.y * v.y, turn.y * v.x + turn.x * v.y)
}

impl SeaSurface {
    /// Returns the single waves, from long to short.
    pub(super) fn waves(&self) -> impl Iterator<Item = SurfaceWave> + '_ {
        self.lanes.each()
    }

    /// Returns the tiles.
    pub(super) fn tiles(&self) -> &[TileFields] {
        &self.tiles
    }

    /// Returns the values that hold everywhere.
    pub(super) fn still(&self) -> &StillSea {
        &self.still
    }
}

/// Returns the determinant of 1 + `slopes`, at least 0.1, so that Newton's steps stay short where waves fold.
fn determinant(slopes: &[f64; 4]) -> f64 {
    ((1.0 + slopes[0]) * (1.0 + slopes[3]) - slopes[1] * slopes[2]).max(0.1)
}

/// Returns the inverse of 1 + `slopes` (rows x, y) times a vector.
fn inverse_times(slopes: &[f64; 4], v: DVec2) -> DVec2 {
    let d = determinant(slopes);
    let [xx, xy, yx, yy] = *slopes;
    DVec2::new((1.0 + yy) * v.x - xy * v.y, (1.0 + xx) * v.y - yx * v.x) / d
}

/// Returns the transposed inverse of 1 + `slopes` times a vector. This turns a gradient over places at rest into one
/// over fixed places.
fn transposed_inverse_times(slopes: &[f64; 4], v: DVec2) -> DVec2 {
    let d = determinant(slopes);
    let [xx, xy, yx, yy] = *slopes;
    DVec2::new((1.0 + yy) * v.x - yx * v.y, (1.0 + xx) * v.y - xy * v.x) / d
}
