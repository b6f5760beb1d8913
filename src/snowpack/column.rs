//! One column of lying snow, in whole units of mass and depth, so that its mass balance is exact to the last bit.

use super::laws;
use crate::weather::{Conditions, Falling};

/// Units per kg/m^2 of mass, and per metre of depth: 2^24.
pub(super) const UNITS: f64 = 16_777_216.0;
/// Units per albedo of 1: 2^30.
const ALBEDO_UNITS: f64 = 1_073_741_824.0;
/// Step of the densities for which settling is tabulated, kg/m^3.
const DENSITY_STEP: f64 = 4.0;
/// Number of densities for which settling is tabulated: they reach past that of ice, [`laws::ICE_KG_M3`].
const DENSITIES: usize = 232;

/// Snow over a square metre. All values of a column without mass are 0.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct Column {
    /// Ice, in units of mass.
    pub ice: i64,
    /// Liquid water, in units of mass.
    pub water: i64,
    /// Depth, in units of depth.
    pub depth: i64,
    /// Albedo of visible light, in units of [`ALBEDO_UNITS`].
    pub albedo: i64,
}

/// Snow that moves from one column to another.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct SnowParcel {
    /// Ice, in units of mass.
    pub ice: i64,
    /// Liquid water, in units of mass.
    pub water: i64,
    /// Depth, in units of depth.
    pub depth: i64,
}

impl SnowParcel {
    pub fn mass(&self) -> i64 {
        self.ice + self.water
    }
}

/// Mass that a column exchanged in a step, in units of mass.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct MassExchange {
    /// Gain by snow and rain that fell.
    pub fallen: i64,
    /// Loss by water that ran off to the ground.
    pub ran_off: i64,
    /// Loss by sublimation.
    pub sublimated: i64,
}

/// Forcing of columns during a step, before shelter: the same for a whole field, or for each block of cells where
/// precipitation varies from place to place.
#[derive(Clone, Copy, Debug)]
pub(super) struct ColumnForcing {
    /// Ice that falls, in units of mass.
    ice: i64,
    /// Depth of the ice that falls, as it lands, in units of depth.
    depth: i64,
    /// Share of the difference to the albedo of new snow that the snowfall removes, 0 to 1.
    renewed: f64,
    /// Rain that falls, in units of mass.
    rain: i64,
    /// Melt without sunlight, in units of mass.
    melt: f64,
    /// Additional melt by sunlight for an albedo of 0, in units of mass.
    melt_by_sun: f64,
    /// Largest mass of liquid water that refreezes, in units of mass.
    refreezing: i64,
    /// Largest mass of ice that sublimates, in units of mass.
    sublimation: i64,
    /// Share of the albedo's excess over that of old snow that is left after the step, 0 to 1.
    albedo_kept: f64,
}

/// Settling in a step, tabulated by density in steps of `DENSITY_STEP` from 0: [a, b] of the factor exp(-(a w + b M))
/// on the depth. a is the effect of metamorphism, with w = 1 in dry snow and 2 in wet snow. b is that of the load, with
/// M the column's mass in units; half of the column counts as load.
#[derive(Clone, Debug)]
pub(super) struct Settling(Box<[[f64; 2]; DENSITIES]>);

impl Settling {
    /// Creates an empty table.
    pub fn new() -> Self {
        Self(Box::new([[0.0; 2]; DENSITIES]))
    }

    /// Computes the table for air of this temperature and a step of this length.
    pub fn set(&mut self, temperature_c: f64, seconds: f64) {
        for (i, settling) in self.0.iter_mut().enumerate() {
            let density = DENSITY_STEP * (i as f64 + 0.5);
            let grains = laws::metamorphism_per_s(temperature_c, density, false) * seconds;
            *settling = [grains, 0.5 * seconds / laws::viscosity(temperature_c, density) / UNITS];
        }
    }
}

/// Converts kg/m^2 or m to units.
fn units(amount: f64) -> i64 {
    (amount * UNITS).round() as i64
}

/// Returns `number` x `part` / `whole`, rounded towards 0. The rounding error of the floating-point product is harmless
/// for depths and albedos, which enter no balance.
fn share(number: i64, part: i64, whole: i64) -> i64 {
    (number as f64 * (part as f64 / whole as f64)) as i64
}

impl ColumnForcing {
    /// Creates the forcing for a step of `seconds` in the weather `c`, with the precipitation `falling` instead of that
    /// of `c`, under `sunlight_w_m2` on level ground.
    pub fn new(c: &Conditions, falling: &Falling, sunlight_w_m2: f64, seconds: f64) -> Self {
        let hours = seconds / 3600.0;
        let (t, wind) = (c.air.temperature_c, c.wind.speed_m_s());
        let pellets = (falling.ice_pellets_mm_h + falling.hail_mm_h) * hours;
        let snow = falling.snow_mm_h * hours;
        let depth = snow / laws::new_density_kg_m3(t, wind) + pellets / laws::PELLETS_KG_M3;
        let rain = falling.rain_mm_h + falling.drizzle_mm_h;
        let (melt, by_sun) = laws::melt_mm_h(c, rain);
        Self {
            ice: units(snow + pellets),
            depth: units(depth),
            renewed: 1.0 - libm::exp(-(snow + pellets) / laws::RENEWING_KG_M2),
            rain: units(rain * hours),
            melt: melt * hours * UNITS,
            melt_by_sun: by_sun * sunlight_w_m2 * hours * UNITS,
            refreezing: units(laws::refreezing_mm_h(t) * hours),
            sublimation: units(laws::sublimation_mm_h(c) * hours),
            albedo_kept: laws::albedo_kept(t > 0.0, seconds),
        }
    }

    /// Returns whether any ice falls.
    pub fn snows(&self) -> bool {
        self.ice > 0
    }
}

impl Column {
    /// Creates new snow of this depth, m, and density, kg/m^3.
    pub fn of(depth_m: f64, density_kg_m3: f64) -> Self {
        let depth = units(depth_m.max(0.0));
        let ice = units(depth_m.max(0.0) * density_kg_m3);
        let albedo = (laws::NEW_ALBEDO * ALBEDO_UNITS) as i64;
        if ice == 0 { Self::default() } else { Self { ice, water: 0, depth, albedo } }
    }

    pub fn mass(&self) -> i64 {
        self.ice + self.water
    }

    /// Returns the mass of ice and liquid water, kg/m^2.
    pub fn mass_kg_m2(&self) -> f64 {
        self.mass() as f64 / UNITS
    }

    /// Returns the depth, m.
    pub fn depth_m(&self) -> f64 {
        self.depth as f64 / UNITS
    }

    /// Returns the density, kg/m^3; 0 without snow.
    pub fn density_kg_m3(&self) -> f64 {
        if self.depth > 0 { self.mass() as f64 / self.depth as f64 } else { 0.0 }
    }

    /// Returns the ratio of the liquid water to the most that the snow can hold, at most 1.
    pub fn wetness(&self) -> f64 {
        if self.ice > 0 { (self.water as f64 / (laws::HELD_SHARE * self.ice as f64)).min(1.0) } else { 0.0 }
    }

    /// Returns whether the liquid water exceeds [`laws::WET_SHARE`] of the ice.
    pub fn is_wet(&self) -> bool {
        self.water as f64 > laws::WET_SHARE * self.ice as f64
    }

    /// Returns the albedo; 0 without snow.
    pub fn albedo(&self) -> f64 {
        self.albedo as f64 / ALBEDO_UNITS
    }

    /// Advances the column by a step. `open` is the share of the precipitation that arrives on the column, 0 to 1.
    pub fn step(&mut self, f: &ColumnForcing, settling: &Settling, open: f64) -> MassExchange {
        let mut gone = MassExchange::default();
        let ice = if open == 1.0 { f.ice } else { (f.ice as f64 * open) as i64 };
        if self.ice == 0 && ice == 0 {
            // The wind may have taken all ice of wet snow and left its water.
            gone.ran_off = self.water;
            *self = Self::default();
            return gone;
        }
        let rain = if open == 1.0 { f.rain } else { (f.rain as f64 * open) as i64 };
        gone.fallen = ice + rain;
        self.settle(f, settling);
        if ice > 0 {
            self.land(ice, if open == 1.0 { f.depth } else { (f.depth as f64 * open) as i64 }, f.renewed * open);
        }
        self.water += rain;
        gone.sublimated = self.lose(f.sublimation);
        self.thaw(f);
        let held = (self.ice as f64 * laws::HELD_SHARE) as i64;
        gone.ran_off = (self.water - held).max(0);
        self.water -= gone.ran_off;
        self.tidy();
        gone
    }

    /// Lets the snow settle ([`Settling`]), and moves its albedo towards that of old snow.
    fn settle(&mut self, f: &ColumnForcing, settling: &Settling) {
        if self.depth == 0 {
            return;
        }
        let at = ((self.density_kg_m3() / DENSITY_STEP) as usize).min(DENSITIES - 1);
        let [grains, load] = settling.0[at];
        let wet = if self.is_wet() { 2.0 } else { 1.0 };
        let shrinks = libm::exp(-(grains * wet + load * self.mass() as f64));
        self.depth = (self.depth as f64 * shrinks) as i64;
        let old = (laws::OLD_ALBEDO * ALBEDO_UNITS) as i64;
        self.albedo = old + ((self.albedo - old) as f64 * f.albedo_kept) as i64;
    }

    /// Adds new snow of this mass and depth. The albedo approaches that of new snow by the share `renewed`.
    fn land(&mut self, ice: i64, depth: i64, renewed: f64) {
        let new = (laws::NEW_ALBEDO * ALBEDO_UNITS) as i64;
        let bare = self.ice == 0;
        self.albedo = if bare { new } else { self.albedo + ((new - self.albedo) as f64 * renewed) as i64 };
        self.ice += ice;
        self.depth += depth;
    }

    /// Removes up to `wanted` units of ice, and the same share of the depth. Returns the ice removed.
    fn lose(&mut self, wanted: i64) -> i64 {
        let lost = wanted.min(self.ice);
        if lost > 0 {
            self.depth -= share(self.depth, lost, self.ice);
            self.ice -= lost;
        }
        lost
    }

    /// Melts ice to water, then freezes water to ice.
    fn thaw(&mut self, f: &ColumnForcing) {
        let melt = f.melt + f.melt_by_sun * (1.0 - self.albedo());
        self.water += self.lose(melt as i64);
        let freezes = f.refreezing.min(self.water);
        self.water -= freezes;
        self.ice += freezes;
    }

    /// Keeps the density at most that of ice, and resets a column without mass.
    fn tidy(&mut self) {
        if self.mass() == 0 {
            *self = Self::default();
        } else {
            self.depth = self.depth.max((self.mass() as f64 / laws::ICE_KG_M3) as i64 + 1);
        }
    }

    /// Removes the share `part / whole` of the column, and returns it.
    pub fn take(&mut self, part: i64, whole: i64) -> SnowParcel {
        let exact = |v: i64| (i128::from(v) * i128::from(part) / i128::from(whole)) as i64;
        let taken = SnowParcel { ice: exact(self.ice), water: exact(self.water), depth: exact(self.depth) };
        self.ice -= taken.ice;
        self.water -= taken.water;
        self.depth -= taken.depth;
        self.tidy();
        taken
    }

    /// Removes ice of this mass by wind erosion, with its share of the depth but none of the water. Returns the amount
    /// removed.
    pub fn erode(&mut self, wanted: i64) -> i64 {
        let lost = self.lose(wanted);
        self.tidy();
        lost
    }

    /// Adds snow from another column. `albedo` is the albedo of the other column, in units. The albedo of this column
    /// becomes the mean by mass.
    pub fn add(&mut self, part: SnowParcel, albedo: i64) {
        let mass = self.mass() + part.mass();
        if mass > 0 && part.mass() > 0 {
            self.albedo += share(albedo - self.albedo, part.mass(), mass);
        }
        self.ice += part.ice;
        self.water += part.water;
        self.depth += part.depth;
        self.tidy();
    }

    /// Presses the share `covered` of the column's area to this density, if its snow is less dense.
    pub fn press(&mut self, density_kg_m3: f64, covered: f64) {
        let pressed = (self.mass() as f64 / density_kg_m3) as i64;
        if pressed < self.depth {
            self.depth -= ((self.depth - pressed) as f64 * covered) as i64;
            self.tidy();
        }
    }

    /// Returns whether the values of a saved column are in range.
    pub fn is_sound(&self) -> bool {
        let most = (1e5 * UNITS) as i64;
        let within = [self.ice, self.water, self.depth].iter().all(|v| (0..=most).contains(v));
        within && (0..=ALBEDO_UNITS as i64).contains(&self.albedo) && (self.mass() == 0) == (self.depth == 0)
    }

    /// Returns the albedo of dry snow that the wind lays down, in units: that of new snow, since the wind breaks its
    /// grains.
    pub fn drifted_albedo() -> i64 {
        (laws::NEW_ALBEDO * ALBEDO_UNITS) as i64
    }
}
