//! Candidate methods of drawing the sky, which the lab compares by cost and error.

use super::recipe::{Name, PassKind, passes};
use super::settings::{SkyModel, SkySettings};
use crate::plan::parts::{Part, Worth};
use crate::plan::{Listed, StepWork, Units, Work};

/// Air and haze between the camera and what the host drew. The importance, 0.9, is that of "atmosphere on objects" in a
/// thesis's experiment on a simulator for machine operators.
pub const AIR: Part = Part { name: "air", rungs: &["all", "none"], importance: 0.9, worth: Worth::Composed(0) };
/// Clear sky above the horizon, behind clouds. A closed deck hides it.
pub const SKY: Part = Part { name: "sky", rungs: &["all", "none"], importance: 0.2, worth: Worth::Composed(2) };

/// Work of the air in a pixel: with one lamp, and for each further lamp. Measured on a software driver (`cargo bench --
/// parts`). The unit is the work of a pixel in which no part is drawn.
const AIR_WORK: (f64, f64) = (0.4, 0.2);
/// Work of the clear sky in a pixel, as [`AIR_WORK`].
const SKY_WORK: (f64, f64) = (0.07, 0.05);
/// Share of the air's work that a pixel costs where the host drew nothing.
const AIR_UNDRAWN: f64 = 0.6;
/// Extra work of a pixel that has both air and fog, with one lamp. It grows with the number of lamps as the air's work
/// does.
const AIR_BEFORE_FOG: f64 = 0.3;

/// Work of the air in a picture with `lamps` lamps.
pub(crate) fn air_work(lamps: u32) -> StepWork {
    let pixel = AIR_WORK.0 + AIR_WORK.1 * f64::from(lamps.saturating_sub(1));
    StepWork { object: pixel, sky: AIR_UNDRAWN * pixel, fixed: 0.0 }
}

/// Extra work of the air in front of the fog, in addition to the work of the air and the work of the fog.
pub(crate) fn air_before_fog_work(lamps: u32) -> StepWork {
    let pixel = AIR_BEFORE_FOG / AIR_WORK.0 * air_work(lamps).object;
    StepWork { object: pixel, sky: pixel, fixed: 0.0 }
}

/// Work of the clear sky in a picture with `lamps` lamps.
pub(crate) fn sky_work(lamps: u32) -> StepWork {
    let sky = SKY_WORK.0 + SKY_WORK.1 * f64::from(lamps.saturating_sub(1));
    StepWork { sky, ..StepWork::default() }
}

/// All candidates, each model from coarse to fine.
pub fn candidates() -> Vec<Listed<SkySettings>> {
    let mut out = Vec::new();
    let mut add = |name, method| out.push(Listed { name, method, work: work(&method) });
    use SkyModel::{BruteForce, Directional, IsotropicTables, Table3d};
    add("directional-eighth", coarsest(Directional));
    add("directional-quarter", coarse(Directional));
    add("directional-half", half(Directional));
    add("directional", SkySettings::default());
    add("directional-double", double(Directional));
    // The next two candidates have larger sizes in some of the tables only: the first in the planet's, the second in
    // the observer's. They show which of the tables improve the picture.
    add("directional-fine-planet", SkySettings { orders: 6, ..planet_sizes(double(Directional)) });
    add("directional-fine-view", SkySettings { orders: 5, ..view_sizes(double(Directional)) });
    add("isotropic-eighth", coarsest(IsotropicTables));
    add("isotropic-quarter", coarse(IsotropicTables));
    add("isotropic-half", half(IsotropicTables));
    add("isotropic", SkySettings::with_model(IsotropicTables));
    add("isotropic-double", double(IsotropicTables));
    add("table3d-quarter", coarse(Table3d));
    add("table3d-half", half(Table3d));
    add("table3d", SkySettings::with_model(Table3d));
    add("table3d-double", double(Table3d));
    for (name, march_cells) in [("march-16", 16), ("march-32", 32), ("march-64", 64), ("march-128", 128)] {
        add(name, SkySettings { march_cells, ..SkySettings::with_model(BruteForce) });
    }
    out
}

fn coarsest(model: SkyModel) -> SkySettings {
    SkySettings {
        orders: 3,
        suns: 24,
        altitudes: 10,
        zeniths: 6,
        azimuths: 4,
        rule_zeniths: 3,
        rule_azimuths: 4,
        build_panels: 1,
        sky_azimuths: 14,
        sky_above: 24,
        sky_below: 12,
        sky_panels: 2,
        air_azimuths: 8,
        air_above: 8,
        air_below: 8,
        air_slices: 6,
        air_panels: 1,
        ..SkySettings::with_model(model)
    }
}

fn coarse(model: SkyModel) -> SkySettings {
    SkySettings {
        orders: 3,
        suns: 32,
        altitudes: 14,
        zeniths: 9,
        azimuths: 6,
        rule_zeniths: 4,
        rule_azimuths: 6,
        build_panels: 2,
        sky_azimuths: 20,
        sky_above: 40,
        sky_below: 20,
        sky_panels: 3,
        air_azimuths: 12,
        air_above: 12,
        air_below: 12,
        air_slices: 8,
        air_panels: 1,
        ..SkySettings::with_model(model)
    }
}

fn half(model: SkyModel) -> SkySettings {
    SkySettings {
        orders: 4,
        suns: 48,
        altitudes: 18,
        zeniths: 13,
        azimuths: 8,
        rule_zeniths: 6,
        rule_azimuths: 8,
        build_panels: 2,
        sky_azimuths: 28,
        sky_above: 56,
        sky_below: 28,
        sky_panels: 4,
        air_azimuths: 16,
        air_above: 16,
        air_below: 16,
        air_slices: 12,
        air_panels: 1,
        ..SkySettings::with_model(model)
    }
}

fn double(model: SkyModel) -> SkySettings {
    SkySettings {
        orders: 6,
        suns: 96,
        altitudes: 32,
        zeniths: 21,
        azimuths: 14,
        rule_zeniths: 10,
        rule_azimuths: 16,
        build_panels: 4,
        sky_azimuths: 64,
        sky_above: 120,
        sky_below: 60,
        sky_panels: 8,
        air_azimuths: 32,
        air_above: 32,
        air_below: 32,
        air_slices: 24,
        air_panels: 3,
        ..SkySettings::with_model(model)
    }
}

/// The default settings with the sizes of the planet's tables from `s`.
fn planet_sizes(s: SkySettings) -> SkySettings {
    SkySettings {
        suns: s.suns,
        altitudes: s.altitudes,
        zeniths: s.zeniths,
        azimuths: s.azimuths,
        rule_zeniths: s.rule_zeniths,
        rule_azimuths: s.rule_azimuths,
        build_panels: s.build_panels,
        ..SkySettings::default()
    }
}

/// The default settings with the sizes of the observer's tables from `s`.
fn view_sizes(s: SkySettings) -> SkySettings {
    SkySettings {
        sky_azimuths: s.sky_azimuths,
        sky_above: s.sky_above,
        sky_below: s.sky_below,
        sky_panels: s.sky_panels,
        air_azimuths: s.air_azimuths,
        air_above: s.air_above,
        air_below: s.air_below,
        air_slices: s.air_slices,
        air_panels: s.air_panels,
        ..SkySettings::default()
    }
}

/// Size of a texel of every table, bytes.
const TEXEL_BYTES: f64 = 8.0;
/// Number of look-ups of the source of multiple scattering in one sample: 4 if it depends on direction, 1 if it does
/// not, 0 for the model without multiple scattering.
fn source_texels(s: &SkySettings) -> f64 {
    match s.model {
        SkyModel::Table3d => 0.0,
        SkyModel::IsotropicTables => 1.0,
        _ => 4.0,
    }
}

/// Returns the work with these settings: for the planet's tables, for the observer's tables, and for a pixel.
pub fn work(s: &SkySettings) -> Work {
    let area = |(width, height): (u32, u32)| f64::from(width) * f64::from(height);
    let texels = |name: Name| area(name.size(s));
    let mut rebuild = Units::default();
    for pass in passes(s) {
        let count = texels(pass.draws[0]) * f64::from(s.layers());
        let per_texel = pass.texel_cost(s);
        let marches = matches!(pass.kind, PassKind::Gather | PassKind::IsotropicGather | PassKind::Once);
        let lookups = match pass.kind {
            PassKind::Gather if s.model.is_directional() && pass.order > 1 => 4.0 * per_texel,
            PassKind::Gather if pass.order > 1 => per_texel,
            PassKind::Scatter | PassKind::Light => f64::from(2 * s.rule_zeniths * s.rule_azimuths),
            _ => 0.0,
        };
        let samples = if marches { per_texel } else { 0.0 };
        let bytes = TEXEL_BYTES * pass.draws.len() as f64;
        rebuild = rebuild.plus(Units { samples, texels: lookups, bytes }, count);
    }
    // Scratch of a build, two sets of tables (the one that is shown and the one being built), and the light as it is
    // shown.
    let kept = |name: &Name| area(name.result_size(s));
    let shared: f64 = Name::SCRATCH.iter().map(|n| texels(*n)).sum::<f64>()
        + 2.0 * Name::RESULTS.iter().map(kept).sum::<f64>()
        + area(Name::shown_size(s));
    let (sky, air) = (area(s.sky_size()), area(s.air_size()));
    let nodes = match s.model {
        SkyModel::BruteForce => 0.0,
        SkyModel::Table3d => sky + air,
        _ => 4.0 * f64::from(s.layers()) * (sky * f64::from(s.sky_panels) + air * f64::from(s.air_panels)),
    };
    let drawn = if s.model == SkyModel::BruteForce { 0.0 } else { sky + air };
    let view = Units { samples: nodes, texels: nodes * source_texels(s).max(1.0), bytes: 2.0 * TEXEL_BYTES * drawn };
    let pixel = if s.model == SkyModel::BruteForce {
        let nodes = f64::from(s.march_cells.next_multiple_of(4));
        Units { samples: nodes, texels: nodes * source_texels(s), bytes: TEXEL_BYTES }
    } else {
        // The sky takes 2 look-ups. The air takes 4, and the columns along the ray. Half of the pixels show sky, half
        // air.
        Units { samples: 1.0, texels: 3.0, bytes: TEXEL_BYTES }
    };
    Work {
        rebuild,
        view,
        pixel,
        shared_bytes: (TEXEL_BYTES * shared) as u64,
        // Two layers for each of the two lamps.
        view_bytes: (4.0 * TEXEL_BYTES * area(s.observer_size())) as u64,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_model_has_its_ladder_and_each_step_costs_more() {
        let all = candidates();
        for (model, least) in [
            (SkyModel::Directional, 4),
            (SkyModel::IsotropicTables, 4),
            (SkyModel::BruteForce, 4),
            (SkyModel::Table3d, 4),
        ] {
            let of = |c: &&Listed<SkySettings>| c.method.model == model;
            let ladder: Vec<_> = all.iter().filter(of).filter(|c| !c.name.contains("fine")).collect();
            assert!(ladder.len() >= least, "{model:?}");
            for pair in ladder.windows(2) {
                let cost = |c: &Listed<SkySettings>| c.work.frame(640 * 360, true).at(&Default::default());
                assert!(cost(pair[1]) > cost(pair[0]), "{} {}", pair[0].name, pair[1].name);
            }
        }
    }

    #[test]
    fn bytes_are_those_of_the_textures() {
        let s = SkySettings::default();
        // Sky of 40 x 120, air of 24 x 16 x 40, two layers a lamp, two lamps, 8 bytes.
        assert_eq!(work(&s).view_bytes, (40 * 120 + 24 * 16 * 40) * 4 * 8);
        assert!(work(&s).shared_bytes > 2 * 64 * 22 * 17 * 10 * 8);
    }
}
