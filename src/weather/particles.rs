//! Suspended matter: particles in the mixed layer, droplets in a layer at the ground, and how a reported visibility is
//! shared among them.

use super::conditions::{AerosolLayer, Air, GroundLayer, LN_20};
use super::kinds::{AerosolKind, FogKind, LoftedKind};
use super::model::Weather;
use super::overrides::Overrides;

/// Optical properties of one kind of aerosol at a relative humidity of 0.8.
struct Properties {
    single_scattering_albedo: f64,
    asymmetry: f64,
    angstrom_exponent: f64,
    absorption_angstrom_exponent: f64,
    scale_height_m: f64,
    /// Exponent of the swelling law; 0 for particles that take up no water.
    growth_exponent: f64,
}

/// Returns the properties of a kind: OPAC's aerosol types (Hess, Koepke and Schult 1998, table 4: humidity 80 %, 550
/// nm; exponents 500 to 800 nm). Smoke after Dubovik et al. (2002), ash after Ball et al. (2015). Absorption exponents
/// after Russell et al. (2010): soot 1, smoke 1.8, dust 2.7. Growth exponents after Haenel (1976) and Titos et al.
/// (2016). Scale heights are typical of a mixed layer.
fn properties(kind: AerosolKind) -> Properties {
    let p = |ssa, g, angstrom, absorption, height, growth| Properties {
        single_scattering_albedo: ssa,
        asymmetry: g,
        angstrom_exponent: angstrom,
        absorption_angstrom_exponent: absorption,
        scale_height_m: height,
        growth_exponent: growth,
    };
    match kind {
        AerosolKind::Continental => p(0.925, 0.703, 1.42, 1.0, 1200.0, 0.35),
        AerosolKind::Clean => p(0.972, 0.709, 1.42, 1.0, 1200.0, 0.40),
        AerosolKind::Maritime => p(0.997, 0.772, 0.08, 1.0, 1000.0, 0.55),
        AerosolKind::Urban => p(0.817, 0.689, 1.43, 1.0, 1200.0, 0.25),
        AerosolKind::Haze => p(0.892, 0.698, 1.45, 1.0, 1200.0, 0.35),
        AerosolKind::Dust => p(0.888, 0.729, 0.17, 2.7, 1500.0, 0.05),
        AerosolKind::Sand => p(0.88, 0.77, 0.0, 2.7, 600.0, 0.0),
        AerosolKind::Smoke => p(0.88, 0.65, 1.8, 1.8, 1500.0, 0.15),
        AerosolKind::VolcanicAsh => p(0.92, 0.70, 0.3, 1.0, 2000.0, 0.0),
        AerosolKind::Arctic => p(0.887, 0.721, 0.89, 1.0, 1500.0, 0.40),
    }
}

/// Humidity for which the table of properties holds.
const TABLE_HUMIDITY: f64 = 0.8;
/// Humidity above which particles do not grow further: they become mist.
const MAX_HUMIDITY: f64 = 0.97;

/// Returns the extinction at a humidity relative to that at 0.8: ((1 - RH) / 0.2)^-gamma (Kasten 1969, Haenel 1976),
/// with RH at most 0.97.
pub fn humidity_growth(kind: AerosolKind, relative_humidity: f64) -> f64 {
    let dryness = (1.0 - relative_humidity.min(MAX_HUMIDITY)) / (1.0 - TABLE_HUMIDITY);
    libm::pow(dryness, -properties(kind).growth_exponent)
}

/// Returns the visibility, m, for a report that gives only a lower bound. The air holds a continental aerosol that
/// swells with humidity ([`humidity_growth`]) and gives a visibility of 40 km at humidity 0.5.
/// `falling_extinction_per_m` is added to the extinction of air and aerosol.
pub fn unlimited_visibility_m(relative_humidity: f64, falling_extinction_per_m: f64) -> f64 {
    let kind = AerosolKind::Continental;
    let growth = humidity_growth(kind, relative_humidity) / humidity_growth(kind, 0.5);
    let background = (LN_20 / 40_000.0 - super::air::RAYLEIGH_550_PER_M) * growth;
    LN_20 / (super::air::RAYLEIGH_550_PER_M + background + falling_extinction_per_m)
}

/// Returns the kind of aerosol: blowing dust or sand replaces a kind that is no dry obscuration.
fn effective_kind(w: &Weather) -> AerosolKind {
    let background = !is_dry_obscuration(w.aerosol.kind);
    match w.lofted.kind {
        LoftedKind::BlowingDust if background => AerosolKind::Dust,
        LoftedKind::BlowingSand if background => AerosolKind::Sand,
        _ => w.aerosol.kind,
    }
}

/// Maximum altitude of a station, in scale heights of its particles. The sky's tables start from the density of the
/// particles at sea level, which can be at most e^4.6, a hundred times that at the station. The haze of a high plateau
/// is a layer on the plateau, and does not continue down to sea level.
const DEEPEST_SCALES: f64 = 4.6;

/// Returns the scale height of the particles, m: as given or by kind, but at least the station's altitude divided by
/// [`DEEPEST_SCALES`].
fn scale_height_m(w: &Weather) -> f64 {
    let own = w.aerosol.scale_height_m.unwrap_or(properties(effective_kind(w)).scale_height_m);
    own.max(w.station_altitude_m / DEEPEST_SCALES)
}

/// Whether a kind can reduce the visibility to any value without fog.
fn is_dry_obscuration(kind: AerosolKind) -> bool {
    use AerosolKind as A;
    matches!(kind, A::Haze | A::Dust | A::Sand | A::Smoke | A::VolcanicAsh)
}

/// Whether dry particles, rather than droplets or snow, limit the visibility.
fn is_dry(w: &Weather) -> bool {
    let foggy = !matches!(w.fog.kind, FogKind::None | FogKind::Shallow) || w.lofted.kind == LoftedKind::BlowingSnow;
    is_dry_obscuration(effective_kind(w)) && !foggy
}

/// Returns the aerosol of the weather with a known `extinction_per_m` at station height. Swelling lowers the share of
/// absorption (water does not absorb) and moves asymmetry and spectrum towards a droplet's, by the volume of water
/// taken up. `swelling` replaces [`humidity_growth`] if it is given.
pub(super) fn aerosol_layer(w: &Weather, extinction_per_m: f64, swelling: Option<f64>) -> AerosolLayer {
    let kind = effective_kind(w);
    let p = properties(kind);
    let growth = swelling.unwrap_or_else(|| humidity_growth(kind, w.relative_humidity));
    let water = (1.0 - 1.0 / growth).clamp(0.0, 1.0);
    let toward = |dry: f64, droplet: f64| dry + (droplet - dry) * water;
    let albedo = (1.0 - (1.0 - p.single_scattering_albedo) / growth).clamp(0.0, 1.0);
    AerosolLayer {
        extinction_per_m,
        angstrom_exponent: w.aerosol.angstrom_exponent.unwrap_or(toward(p.angstrom_exponent, 0.0)),
        absorption_angstrom_exponent: p.absorption_angstrom_exponent,
        single_scattering_albedo: w.aerosol.single_scattering_albedo.unwrap_or(albedo),
        asymmetry: w.aerosol.asymmetry.unwrap_or(toward(p.asymmetry, 0.82)),
        scale_height_m: scale_height_m(w),
        reference_altitude_m: w.station_altitude_m,
    }
}

/// Extinction that the reported visibility leaves for particles, divided between two layers.
pub(super) struct ExtinctionShares {
    /// Extinction of the mixed layer, 1/m.
    pub aerosol_per_m: f64,
    /// Extinction inside the layer at the ground, 1/m.
    pub ground_per_m: f64,
    /// Whether the ground layer is part of the reported visibility.
    pub ground_counts: bool,
}

/// Returns the visibility of the air above a fog, m. Extinction beyond that of this visibility belongs to the ground
/// layer.
fn visibility_above_m(w: &Weather, o: &Overrides) -> f64 {
    let fog = matches!(w.fog.kind, FogKind::Fog | FogKind::Freezing) || w.lofted.kind == LoftedKind::BlowingSnow;
    o.visibility_above_fog_m.unwrap_or(if fog { 10_000.0 } else { 5_000.0 })
}

/// Returns the visibility inside a layer that the reported visibility leaves out, m; `None` if it includes the layer.
fn visibility_inside_m(w: &Weather) -> Option<f64> {
    let beside = match (w.fog.kind, w.lofted.kind) {
        (FogKind::Shallow, _) => true,
        (FogKind::Patches | FogKind::Partial, _) => w.visibility_m >= 1000.0,
        (FogKind::None, LoftedKind::DriftingSnow | LoftedKind::DriftingDust) => true,
        _ => false,
    };
    let usual = if w.fog.kind == FogKind::None { 500.0 } else { 200.0 };
    beside.then(|| w.fog.visibility_inside_m.unwrap_or(usual))
}

/// Largest vertical optical depth of particles for the sky's tables. The tables sum orders of scattering as a series,
/// whose error is 11 % at this depth (95th percentile). The remainder of a greater depth goes to the ground layer,
/// whose two-stream solution holds at any depth.
const SKY_DEPTH: f64 = 1.0;

/// Returns the optical depth of particles in the sky's tables if their total is `depth`: all of it up to [`SKY_DEPTH`],
/// and beyond that a depth that decreases as 1 / `depth`. If it did not decrease, the sky's tables would light the air
/// below thick dust as if there were no dust above it.
fn sky_depth(depth: f64) -> f64 {
    if depth <= SKY_DEPTH { depth } else { SKY_DEPTH * SKY_DEPTH / depth }
}

/// Shares the extinction of aerosol and fog between the mixed layer and the ground layer. This extinction is
/// max(0, ln 20 / V - air - precipitation), with the reported visibility V.
///
/// Haze, dust, sand, smoke and ash take all of this extinction into the mixed layer, as far as [`sky_depth`] allows;
/// blowing dust and sand take at most half. Other aerosols take at most the extinction that belongs to
/// [`visibility_above_m`], because dry background air never gets hazier than that; the remainder is mist or fog,
/// whether the report names it or not. If the visibility leaves out the ground layer, the mixed layer takes all.
pub(super) fn share_extinction(w: &Weather, air: &Air, falling_per_m: f64, o: &Overrides) -> ExtinctionShares {
    let rayleigh = air.rayleigh_extinction_per_m;
    let rest = (LN_20 / w.visibility_m - rayleigh - falling_per_m).max(0.0);
    let beside = visibility_inside_m(w);
    let tall = if beside.is_some() {
        rest
    } else if is_dry(w) {
        let height = scale_height_m(w);
        // Blowing sand and dust stay low: at most half of their extinction goes to the mixed layer.
        let low = if matches!(w.lofted.kind, LoftedKind::BlowingSand | LoftedKind::BlowingDust) { 0.5 } else { 1.0 };
        (sky_depth(rest * height) / height).min(low * rest)
    } else {
        rest.min((LN_20 / visibility_above_m(w, o) - rayleigh).max(0.0))
    };
    let aerosol = o.aerosol_extinction_per_m.unwrap_or(tall);
    let ground = match beside {
        Some(inside) => (LN_20 / inside - rayleigh - aerosol - falling_per_m).max(0.0),
        None => rest - tall,
    };
    ExtinctionShares {
        aerosol_per_m: aerosol,
        ground_per_m: o.fog_extinction_per_m.unwrap_or(ground),
        ground_counts: beside.is_none(),
    }
}

/// Returns the height of the lowest cloud base above the station, m, to which a mist can reach up.
fn lowest_base_m(w: &Weather) -> Option<f64> {
    w.clouds.iter().filter(|c| c.cover > 0.0).map(|c| c.base_m).fold(None, |a, b| Some(a.map_or(b, |a: f64| a.min(b))))
}

/// Returns the top of the ground layer above the station, m, if the host does not give it.
///
/// Shallow fog ends at 2 m by definition (WMO-No. 306, MI); patches and partial fog end at 20 m. In an obscured sky,
/// fog is deeper than the vertical visibility: its depth is taken as twice that, 150 to 600 m. Otherwise the sky shows
/// through, and the fog is about one visibility deep, 20 to 150 m. Mist with a visibility of 1 km or more ends at the
/// base of the lowest cloud, but not below 60 m; if no base is at 600 m or lower, it ends at 300 m. Mist with less
/// visibility is as deep as fog. Blowing snow reaches 50 m (some tens of metres: Budd, Dingle and Radok 1966), drifting
/// snow and dust stay below eye height at 1.5 m, and spray reaches 10 m.
fn default_top_m(w: &Weather, ground_per_m: f64) -> f64 {
    let through = (LN_20 / ground_per_m.max(1e-9)).clamp(20.0, 150.0);
    match (w.fog.kind, w.lofted.kind) {
        (FogKind::Shallow, _) => 2.0,
        (FogKind::Patches | FogKind::Partial, _) => 20.0,
        (FogKind::Fog | FogKind::Freezing, _) => {
            w.vertical_visibility_m.map_or(through, |vv| (2.0 * vv).clamp(150.0, 600.0))
        }
        (_, LoftedKind::BlowingSnow) => 50.0,
        (_, LoftedKind::DriftingSnow | LoftedKind::DriftingDust) => 1.5,
        (_, LoftedKind::BlowingSpray) => 10.0,
        _ if w.visibility_m < 1000.0 => w.vertical_visibility_m.map_or(through, |vv| (2.0 * vv).clamp(150.0, 600.0)),
        _ => lowest_base_m(w).filter(|b| *b <= 600.0).map_or(300.0, |b| b.max(60.0)),
    }
}

/// Returns the layer at the ground. Droplets of 10 um scatter without colour or absorption (albedo 1, asymmetry 0.85:
/// Hess et al. 1998, fog). Lifted snow has an asymmetry of 0.89, and dust its own properties. If the optical depth of
/// dry particles is too great for the sky's tables, the layer contains the remainder. Such a layer thins out up to
/// twice the scale height of `aerosol`, so that its vertical optical depth is that of an exponential layer with this
/// scale height.
pub(super) fn ground_layer(w: &Weather, extinction_per_m: f64, aerosol: &AerosolLayer) -> GroundLayer {
    if extinction_per_m <= 0.0 {
        return GroundLayer::NONE;
    }
    if is_dry(w) && visibility_inside_m(w).is_none() {
        let top = w.fog.top_m.or(w.lofted.top_m).unwrap_or(2.0 * aerosol.scale_height_m);
        return GroundLayer {
            extinction_per_m,
            angstrom_exponent: aerosol.angstrom_exponent,
            single_scattering_albedo: aerosol.single_scattering_albedo,
            asymmetry: aerosol.asymmetry,
            base_m: 0.0,
            top_m: top,
            softness_m: top,
            coverage: 1.0,
            patch_size_m: 120.0,
            lifted: lifted(w),
        };
    }
    let top = w.fog.top_m.or(w.lofted.top_m).unwrap_or_else(|| default_top_m(w, extinction_per_m));
    let (albedo, asymmetry, angstrom) = match (w.fog.kind, w.lofted.kind) {
        (FogKind::None, LoftedKind::BlowingSnow | LoftedKind::DriftingSnow) => (1.0, 0.89, 0.0),
        (FogKind::None, LoftedKind::DriftingDust) => {
            let p = properties(AerosolKind::Dust);
            (p.single_scattering_albedo, p.asymmetry, p.angstrom_exponent)
        }
        _ => (1.0, 0.85, 0.0),
    };
    let (coverage, patch) = match w.fog.kind {
        FogKind::Patches => (0.4, 150.0),
        FogKind::Partial => (0.6, 800.0),
        // Matter that drifts along the ground moves in streaks of some metres.
        FogKind::None if matches!(w.lofted.kind, LoftedKind::DriftingSnow | LoftedKind::DriftingDust) => (1.0, 12.0),
        FogKind::None if w.lofted.kind != LoftedKind::None => (1.0, 120.0),
        _ => (1.0, 200.0),
    };
    let sheet = matches!(w.fog.kind, FogKind::Fog | FogKind::Freezing);
    GroundLayer {
        extinction_per_m,
        angstrom_exponent: angstrom,
        single_scattering_albedo: albedo,
        asymmetry,
        base_m: 0.0,
        top_m: top,
        softness_m: top * if sheet { 0.3 } else { 0.5 },
        coverage: w.fog.coverage.unwrap_or(coverage),
        patch_size_m: patch,
        lifted: if w.fog.kind == FogKind::None { lifted(w) } else { 0.0 },
    }
}

/// Returns the share of the ground layer that the wind has lifted: 1 for lofted matter of any kind, else 0.
fn lifted(w: &Weather) -> f64 {
    if w.lofted.kind == LoftedKind::None { 0.0 } else { 1.0 }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn growth_is_one_at_the_tables_humidity_and_rises() {
        for &kind in AerosolKind::ALL {
            assert!((humidity_growth(kind, 0.8) - 1.0).abs() < 1e-12);
            let steps: Vec<f64> = (0..=20).map(|i| humidity_growth(kind, f64::from(i) / 20.0)).collect();
            assert!(steps.windows(2).all(|s| s[1] >= s[0]), "{kind:?}: {steps:?}");
            assert!(steps[20].is_finite());
        }
    }

    #[test]
    fn swelling_whitens_and_washes_out_absorption() {
        let at = |rh: f64| aerosol_layer(&Weather { relative_humidity: rh, ..Weather::default() }, 1e-4, None);
        let (dry, table, wet) = (at(0.2), at(0.8), at(0.97));
        assert!((table.single_scattering_albedo - 0.925).abs() < 1e-12, "OPAC continental average");
        assert!(dry.single_scattering_albedo < table.single_scattering_albedo);
        assert!(wet.single_scattering_albedo > table.single_scattering_albedo);
        assert!(wet.angstrom_exponent < table.angstrom_exponent && wet.asymmetry > table.asymmetry);
    }

    #[test]
    fn dust_takes_blue_and_continental_air_scatters_it() {
        let of = |kind| {
            aerosol_layer(&Weather { aerosol: super::super::Aerosol::of(kind), ..Weather::default() }, 1e-4, None)
        };
        let blue_to_red = |kind| {
            let s = of(kind).scattering_at([680.0, 550.0, 440.0]);
            s[2] / s[0]
        };
        assert!(blue_to_red(AerosolKind::Dust) < 1.0, "{}", blue_to_red(AerosolKind::Dust));
        assert!(blue_to_red(AerosolKind::Continental) > 1.5);
        for &kind in AerosolKind::ALL {
            let layer = of(kind);
            let (e, s) = (layer.extinction_at([400.0, 550.0, 900.0]), layer.scattering_at([400.0, 550.0, 900.0]));
            assert!((0..3).all(|i| s[i] >= 0.0 && s[i] <= e[i]), "{kind:?}");
        }
    }

    #[test]
    fn unlimited_means_far_in_dry_air_and_less_in_damp_air() {
        assert!((unlimited_visibility_m(0.5, 0.0) - 40_000.0).abs() < 1e-6);
        assert!(unlimited_visibility_m(0.95, 0.0) < 25_000.0 && unlimited_visibility_m(1.0, 0.0) > 10_000.0);
    }
}
