//! Bows of a view: the tables that its pictures need.

use std::sync::Arc;

use glam::DVec2;

use super::{
    drops::{areas, in_rain, is_lit, is_within, low_air},
    table::{CLASSES, ENTRIES, STEP_RAD, mixed},
};
use crate::{
    error::Result,
    gpu::recent::LruCache,
    stage::{BOW_ENTRIES, BowTable, Contribution, DrawContext, DrawnEffect, FrameContext, Outputs, Stages, flag},
    weather::Falling,
};

const _: () = assert!(ENTRIES == BOW_ENTRIES);

/// Bows of a view.
pub(crate) struct BowView {
    /// Shares of each class of drops in the extinction of the low air and of rain areas; `None` without drops.
    drops: [Option<[f64; CLASSES]>; 2],
    is_lit: bool,
    /// Cache of each class's extinction, by rain and factor of fall speed ([`in_rain`]). Most frames need the same
    /// entries.
    rains: LruCache<(Falling, f64), [f64; CLASSES], RAINS>,
    /// Tables of the last draw whose picture may show a bow: for the low air and for rain areas.
    shown: Arc<[BowTable; 2]>,
    /// Shares of the classes of drops for which `shown` was made. The cube map composes while the draw around it still
    /// holds the tables, so only new ones are written: others would be copied in every frame.
    shown_for: [Option<[f64; CLASSES]>; 2],
}

impl Default for BowView {
    fn default() -> Self {
        Self {
            drops: [None; 2],
            is_lit: false,
            rains: LruCache::new(),
            shown: Arc::new([[[0.0; 4]; BOW_ENTRIES]; 2]),
            shown_for: [None; 2],
        }
    }
}

/// Number of cached rains: that of the low air and those of some areas.
const RAINS: usize = 8;

impl BowView {
    fn has_drops(&self) -> bool {
        self.drops.iter().any(Option::is_some)
    }

    /// Returns the tables of the frame's drops, and writes them first if the drops have changed.
    fn tables(&mut self) -> &Arc<[BowTable; 2]> {
        if self.shown_for == self.drops {
            return &self.shown;
        }
        let shown = Arc::make_mut(&mut self.shown);
        for ((table, shares), was) in shown.iter_mut().zip(&self.drops).zip(&mut self.shown_for) {
            if was == shares {
                continue;
            }
            *table = shares.as_ref().map_or([[0.0; 4]; BOW_ENTRIES], |shares| {
                mixed(shares).map(|[r, g, b]| [r, g, b, 0.0].map(|v| v as f32))
            });
            *was = *shares;
        }
        &self.shown
    }
}

/// Whether a picture's field of view may reach the angles of a table.
fn shows(context: &DrawContext<'_>) -> bool {
    let ray = |x: f64, y: f64| context.target.rays.view_ray(DVec2::new(x, y)).direction;
    let middle = ray(0.0, 0.0);
    let corners = [ray(-1.0, -1.0), ray(1.0, -1.0), ray(-1.0, 1.0), ray(1.0, 1.0)];
    let half_angle = corners.map(|c| c.angle_between(middle)).into_iter().fold(0.0, f64::max);
    is_within(middle, half_angle, context.now.scene.brighter().direction, STEP_RAD * ENTRIES as f64)
}

impl DrawnEffect for BowView {
    fn gather(&mut self, context: &FrameContext<'_>, _given: &mut Outputs) -> Result<()> {
        let now = context.now;
        self.is_lit = is_lit(&now.scene);
        let mut rain =
            |falling: &Falling, factor| self.rains.get_or_put(&(*falling, factor), || in_rain(falling, factor));
        self.drops = [low_air(&now.scene.conditions, &mut rain), areas(now, &mut rain)];
        Ok(())
    }

    fn stages(&self) -> Stages {
        if self.has_drops() && self.is_lit { Stages::MEDIUM } else { Stages(0) }
    }

    fn compose(&mut self, context: &DrawContext<'_>, _given: &Outputs, added: &mut Contribution) -> Result<()> {
        // The constants do not depend on where the picture looks. Otherwise a pipeline would be compiled when the
        // camera turns to a bow, and that frame would be late.
        let is_lit = self.has_drops() && self.is_lit;
        added.between_and_veil("BOW", flag(self.has_drops()), flag(is_lit));
        if is_lit && shows(context) {
            added.set_bows(self.tables());
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_draw_that_holds_the_tables_keeps_them_and_costs_a_copy_only_when_the_drops_change() {
        let one = |class: usize| Some(std::array::from_fn(|i| f64::from(u8::from(i == class))));
        let mut view = BowView { drops: [one(0), None], ..BowView::default() };
        let held = view.tables().clone();
        let was = *held;
        assert!(was[0] != [[0.0; 4]; BOW_ENTRIES] && was[1] == [[0.0; 4]; BOW_ENTRIES]);
        assert!(Arc::ptr_eq(&held, view.tables()), "the same drops");
        view.drops = [one(CLASSES - 1), one(0)];
        let next = view.tables().clone();
        assert!(!Arc::ptr_eq(&held, &next) && *held == was, "other drops");
        assert!(next[1] == was[0] && next[0] != was[0]);
    }
}
