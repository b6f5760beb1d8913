//! Build plan for tables of one detail: passes, cut into strips of about equal work.

use super::passes::BuildBuffers;
use super::recipe::{Pass, passes};
use super::settings::SkySettings;
use crate::gpu::Device;

/// Some rows of a pass's target, which are drawn together.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Strip {
    /// Index of the pass.
    pub pass: usize,
    pub first_row: u32,
    /// Number of rows.
    pub rows: u32,
    /// Cost, in units of the time that one node of a march takes.
    pub cost: f64,
}

/// Largest share of the work for one triple of wavelengths in one strip, unless one row costs more.
pub(crate) const STRIP_SHARE: f64 = 1.0 / 1024.0;
/// Detail of a planet's tables.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Detail {
    /// Coarse tables by [`SkySettings::draft`]: built quickly, and shown until the whole ones are finished.
    Draft,
    /// Tables with the sizes of the settings.
    Whole,
}

/// Build plan for tables of one detail.
pub(crate) struct Level {
    pub settings: SkySettings,
    pub blocks: BuildBuffers,
    pub passes: Vec<Pass>,
    /// Strips of one triple of wavelengths.
    pub strips: Vec<Strip>,
    /// Cost of the strips of all triples.
    pub total_cost: f64,
}

impl Level {
    /// Creates the plan with strips that cost at most `strip_cost`, or with `None` at most [`STRIP_SHARE`] of the work
    /// for one triple. A strip has at least one row.
    pub fn new(device: &Device, settings: &SkySettings, strip_cost: Option<f64>) -> Self {
        let passes = passes(settings);
        let (strips, cost) = strips(settings, &passes, strip_cost);
        Self {
            settings: *settings,
            blocks: BuildBuffers::new(device, settings, &passes),
            passes,
            strips,
            total_cost: cost * f64::from(settings.layers()),
        }
    }

    /// Number of strips of all triples.
    pub fn strip_count(&self) -> usize {
        self.strips.len() * self.settings.layers() as usize
    }

    /// Cost of the first `count` strips.
    pub fn cost_of(&self, count: usize) -> f64 {
        let (whole, rest) = (count / self.strips.len(), count % self.strips.len());
        let triple = self.total_cost / f64::from(self.settings.layers());
        whole as f64 * triple + self.strips[..rest].iter().map(|s| s.cost).sum::<f64>()
    }
}

/// Cuts the passes for one triple into strips that cost at most `most`, or with `None` at most [`STRIP_SHARE`] of their
/// total. A strip has at least one row, whatever it costs. Also returns the total cost of the triple.
pub(crate) fn strips(settings: &SkySettings, passes: &[Pass], most: Option<f64>) -> (Vec<Strip>, f64) {
    let row_cost = |p: &Pass| f64::from(p.draws[0].size(settings).0) * p.texel_time(settings);
    let total: f64 = passes.iter().map(|p| row_cost(p) * f64::from(p.draws[0].size(settings).1)).sum();
    let most = most.unwrap_or(STRIP_SHARE * total);
    let mut out = Vec::new();
    for (pass, p) in passes.iter().enumerate() {
        let height = p.draws[0].size(settings).1;
        let each = ((most / row_cost(p)) as u32).clamp(1, height);
        for first_row in (0..height).step_by(each as usize) {
            let rows = each.min(height - first_row);
            out.push(Strip { pass, first_row, rows, cost: row_cost(p) * f64::from(rows) });
        }
    }
    (out, total)
}

#[cfg(test)]
mod tests {
    use super::super::settings::SkyModel;
    use super::*;

    #[test]
    fn strips_cover_every_pass_and_are_small() {
        for (_, model) in SkyModel::NAMES {
            let s = SkySettings::with_model(model);
            let list = passes(&s);
            let (strips, total) = strips(&s, &list, None);
            assert!(strips.iter().all(|x| x.cost <= total / 32.0), "{model:?}");
            assert!((strips.iter().map(|x| x.cost).sum::<f64>() / total - 1.0).abs() < 1e-9);
            for (i, p) in list.iter().enumerate() {
                let rows: u32 = strips.iter().filter(|x| x.pass == i).map(|x| x.rows).sum();
                assert_eq!(rows, p.draws[0].size(&s).1);
            }
        }
    }
}
