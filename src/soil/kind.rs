//! Kinds of soil and their properties, and the layers of undisturbed ground.

use super::laws::{GRAVITY_M_S2, SinkageSet, WallLaw};
use crate::error::{Error, Result, check_range};

/// Largest number of kinds of a site, the built-in ones among them.
pub const MAX_SOIL_KINDS: usize = 16;
/// Largest number of layers of undisturbed ground.
pub const MAX_HORIZONS: usize = 8;

/// Saturation of moist bank, which has its full cohesion.
pub(super) const MOIST: f64 = 0.3;

/// Number of a kind of soil: an index into the kinds of a site. The built-in kinds come first.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Default)]
pub struct SoilKindId(pub u8);

impl SoilKindId {
    /// Moist sand.
    pub const SAND: Self = Self(0);
    /// Dry gravel.
    pub const GRAVEL: Self = Self(1);
    /// Dry clay.
    pub const CLAY: Self = Self(2);
    /// Moist sandy loam; by default it lies below 0.3 m of topsoil.
    pub const LOAM: Self = Self(3);
    /// Topsoil.
    pub const TOPSOIL: Self = Self(4);
    /// Limestone.
    pub const ROCK: Self = Self(5);
    /// Hard coal.
    pub const COAL: Self = Self(6);

    pub(super) fn index(self) -> usize {
        usize::from(self.0)
    }
}

/// Properties of a kind of soil.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SoilKind {
    /// Density of the undisturbed soil (bank), kg/m^3, \[50, 10 000\].
    pub density_kg_m3: f64,
    /// Growth of volume when the soil is dug, as a share of its bank volume, \[0, 1.5\].
    pub swell: f64,
    /// Angle at which the loose soil rests, degrees, \[5, 60\].
    pub repose_deg: f64,
    /// Cohesion of the bank, kPa, \[0, 10 000\].
    pub cohesion_kpa: f64,
    /// Friction angle of the bank, degrees, \[0, 60\].
    pub friction_deg: f64,
    /// Law by which the soil yields to wheels and tracks; `None` for soil that carries them without sinking.
    pub sinkage: Option<SinkageSet>,
    /// Mean colour of the drawn surface when moist, linear Rec. 709 albedo, each \[0, 1\].
    pub albedo: [f64; 3],
}

/// Built-in kinds in the order of their numbers. The densities are those of dug soil in the engineers' tables (sand dry
/// 1602, gravel dry 1522, clay dry 1073, earth moist 1442 and dry 1249, broken limestone 1554, coal 890 kg/m^3),
/// multiplied by 1 + swell so that the dug soil has the densities of the tables. Angles of repose lie in the middle of
/// the published ranges. Cohesion and friction of sand, loam, clay and topsoil belong to the sets of their sinkage
/// (Wong 2008, table 2.3). Colours have the hues and luminances of common Munsell colours of such soils: 10YR 5/4, 2.5Y
/// 5/1, 7.5YR 5/6, 10YR 4/4, 10YR 3/2, 10YR 7/1 and N 2.
pub(super) const BUILT_IN: [SoilKind; 7] = [
    kind([1794.0, 0.12, 34.0], [1.04, 28.0], Some(SinkageSet::DRY_SAND), [0.281, 0.177, 0.087]),
    kind([1750.0, 0.15, 37.0], [0.0, 37.0], None, [0.203, 0.193, 0.166]),
    kind([1449.0, 0.35, 32.0], [4.14, 13.0], Some(SinkageSet::CLAYEY_38), [0.337, 0.163, 0.063]),
    kind([1803.0, 0.25, 37.0], [1.72, 29.0], Some(SinkageSet::SANDY_LOAM_15), [0.180, 0.106, 0.045]),
    kind([1561.0, 0.25, 37.0], [3.3, 33.7], Some(SinkageSet::UPLAND_LOAM), [0.086, 0.060, 0.039]),
    kind([2533.0, 0.63, 38.0], [1000.0, 40.0], None, [0.453, 0.415, 0.373]),
    kind([1202.0, 0.35, 37.0], [100.0, 35.0], None, [0.0305, 0.0305, 0.031]),
];

const fn kind(bulk: [f64; 3], strength: [f64; 2], sinkage: Option<SinkageSet>, albedo: [f64; 3]) -> SoilKind {
    let [density_kg_m3, swell, repose_deg] = bulk;
    let [cohesion_kpa, friction_deg] = strength;
    SoilKind { density_kg_m3, swell, repose_deg, cohesion_kpa, friction_deg, sinkage, albedo }
}

impl SoilKind {
    /// Checks that every property is within its range.
    ///
    /// # Errors
    /// [`crate::error::Status::InvalidArgument`] naming the field.
    pub fn validate(&self) -> Result<()> {
        check_range("soil_kind.density_kg_m3", self.density_kg_m3, 50.0, 1e4, "kg/m^3")?;
        check_range("soil_kind.swell", self.swell, 0.0, 1.5, "")?;
        check_range("soil_kind.repose_deg", self.repose_deg, 5.0, 60.0, "deg")?;
        check_range("soil_kind.cohesion_kpa", self.cohesion_kpa, 0.0, 1e4, "kPa")?;
        check_range("soil_kind.friction_deg", self.friction_deg, 0.0, 60.0, "deg")?;
        for (i, albedo) in self.albedo.into_iter().enumerate() {
            check_range(&format!("soil_kind.albedo[{i}]"), albedo, 0.0, 1.0, "")?;
        }
        if let Some(set) = self.sinkage {
            check_range("soil_kind.sinkage.kc", set.kc, 0.0, 1e6, "kN/m^(n+1)")?;
            check_range("soil_kind.sinkage.kphi", set.kphi, 0.1, 1e8, "kN/m^(n+2)")?;
            check_range("soil_kind.sinkage.n", set.n, 0.1, 3.0, "")?;
        }
        Ok(())
    }

    /// Density of the dug soil, kg/m^3.
    pub fn loose_density_kg_m3(&self) -> f64 {
        self.density_kg_m3 / (1.0 + self.swell)
    }

    /// Strength of the bank, by which its walls stand.
    pub fn wall_law(&self) -> WallLaw {
        WallLaw {
            cohesion_kpa: self.cohesion_kpa,
            friction: self.friction_deg.to_radians(),
            density_kg_m3: self.density_kg_m3,
        }
    }

    /// Weight of the bank, kN/m^3.
    pub fn weight_kn_m3(&self) -> f64 {
        1e-3 * GRAVITY_M_S2 * self.density_kg_m3
    }
}

/// Layer of undisturbed ground.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SoilHorizon {
    /// Depth of the layer's upper side below the undug surface, m, \[0, 1000\].
    pub top_m: f64,
    /// Kind of soil.
    pub kind: SoilKindId,
}

/// Kinds and layers of the ground of a site.
#[derive(Clone, Debug, PartialEq)]
pub struct SoilSettings {
    /// The host's own kinds of soil; their numbers follow those of the seven built-in kinds. At most 9.
    pub own_kinds: Vec<SoilKind>,
    /// Layers of undisturbed ground, 1 to 8, from the top down: the first begins at depth 0, and each further one below
    /// the top of the one before. Default 0.3 m of topsoil on loam.
    pub horizons: Vec<SoilHorizon>,
    /// Share of the pores of the bank that water fills without rain and sun, \[0, 1\]. Default 0.3, moist. Bank at 0
    /// (dry sand) and at 1 (below the water table) has no cohesion ([`super::laws::cohesion_share`]).
    pub saturation: f64,
}

impl Default for SoilSettings {
    fn default() -> Self {
        let layer = |top_m, kind| SoilHorizon { top_m, kind };
        Self {
            own_kinds: Vec::new(),
            horizons: vec![layer(0.0, SoilKindId::TOPSOIL), layer(0.3, SoilKindId::LOAM)],
            saturation: MOIST,
        }
    }
}

impl SoilSettings {
    /// Checks the settings, and returns all kinds.
    pub(super) fn checked_kinds(&self) -> Result<Vec<SoilKind>> {
        let most_own = MAX_SOIL_KINDS - BUILT_IN.len();
        if self.own_kinds.len() > most_own {
            return Err(Error::range("own_kinds.len", &format!("at most {most_own}"), self.own_kinds.len()));
        }
        for (i, kind) in self.own_kinds.iter().enumerate() {
            kind.validate().map_err(|e| e.renamed("soil_kind", &format!("own_kinds[{i}]")))?;
        }
        let kinds: Vec<SoilKind> = BUILT_IN.iter().chain(&self.own_kinds).copied().collect();
        check_horizons(&self.horizons, kinds.len())?;
        check_range("saturation", self.saturation, 0.0, 1.0, "")?;
        Ok(kinds)
    }
}

/// Checks the layers: the first must begin at the surface, and each further one below the top of the one before.
fn check_horizons(horizons: &[SoilHorizon], kinds: usize) -> Result<()> {
    if !(1..=MAX_HORIZONS).contains(&horizons.len()) {
        return Err(Error::range("horizons.len", &format!("in [1, {MAX_HORIZONS}]"), horizons.len()));
    }
    for (i, horizon) in horizons.iter().enumerate() {
        let name = format!("horizons[{i}].top_m");
        check_range(&name, horizon.top_m, 0.0, 1000.0, "m")?;
        let before_m = i.checked_sub(1).map(|before| horizons[before].top_m);
        match before_m {
            None if horizon.top_m != 0.0 => return Err(Error::range(&name, "0, the surface", horizon.top_m)),
            Some(before_m) if horizon.top_m <= before_m => {
                return Err(Error::range(
                    &name,
                    &format!("more than {before_m} m, that of the layer above"),
                    horizon.top_m,
                ));
            }
            _ => check_kind(&format!("horizons[{i}].kind"), horizon.kind, kinds)?,
        }
    }
    Ok(())
}

/// Checks that a kind is known.
pub(super) fn check_kind(name: &str, kind: SoilKindId, kinds: usize) -> Result<()> {
    let accepted = || format!("a known kind of soil, in [0, {}]", kinds - 1);
    if kind.index() < kinds { Ok(()) } else { Err(Error::range(name, &accepted(), kind.0)) }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::light::luminance;

    /// Luminance of a Munsell value as a share of a white diffuser's (ASTM D1535, 2008).
    fn munsell_luminance(value: f64) -> f64 {
        let terms = [1.1914, -0.22533, 0.23352, -0.020484, 0.000_819_39];
        terms.iter().rev().fold(0.0, |sum, term| (sum + term) * value) / 100.0
    }

    #[test]
    fn built_in_kinds_have_the_luminance_of_their_munsell_values() {
        assert!((munsell_luminance(10.0) - 1.0).abs() < 1e-3);
        for (kind, value) in BUILT_IN.iter().zip([5.0, 5.0, 5.0, 4.0, 3.0, 7.0, 2.0]) {
            let (own, stated) = (luminance(&kind.albedo), munsell_luminance(value));
            assert!((own / stated - 1.0).abs() < 0.02, "{:?}: {own}, {stated} by Munsell", kind.albedo);
        }
    }
}
