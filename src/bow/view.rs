//! The bows of a view.

use glam::DVec2;

use super::{
    drops::{areas, in_rain, is_lit, is_within, low_air},
    table::{CLASSES, ENTRIES, STEP_RAD, mixed},
};
use crate::{
    error::Result,
    gpu::recent::LruCache,
    moment::Moment,
    stage::{BOW_ENTRIES, Composition, DrawnEffect, Shot, Stages, flag},
    weather::Falling,
};

const _: () = assert!(ENTRIES == BOW_ENTRIES);

/// What a view has of bows.
#[derive(Default)]
pub(crate) struct BowView {
    /// What classes of drops take of the light in the low air and in rain areas, where there are any.
    drops: [Option<[f64; CLASSES]>; 2],
    is_lit: bool,
    /// Of rates that fell in the last frames, and the tables of shares: both are sums that most frames have in common.
    rains: LruCache<(Falling, f64), [f64; CLASSES], RAINS>,
    tables: LruCache<[f64; CLASSES], [[f32; 4]; ENTRIES], 2>,
}

/// Rates that are remembered: of the low air and of some areas.
const RAINS: usize = 8;

impl BowView {
    /// Finds the drops of a moment.
    pub fn gather(&mut self, now: &Moment<'_>) {
        self.is_lit = is_lit(&now.scene);
        let mut rain =
            |falling: &Falling, factor| self.rains.get_or_put(&(*falling, factor), || in_rain(falling, factor));
        self.drops = [low_air(&now.scene.conditions, &mut rain), areas(now, &mut rain)];
    }

    fn has_drops(&self) -> bool {
        self.drops.iter().any(Option::is_some)
    }
}

/// Whether a picture looks at any place of a table.
fn shows(shot: &Shot<'_>) -> bool {
    let ray = |x: f64, y: f64| shot.rays.view_ray(DVec2::new(x, y)).direction;
    let middle = ray(0.0, 0.0);
    let corners = [ray(-1.0, -1.0), ray(1.0, -1.0), ray(-1.0, 1.0), ray(1.0, 1.0)];
    let half_angle = corners.map(|c| c.angle_between(middle)).into_iter().fold(0.0, f64::max);
    is_within(middle, half_angle, shot.now.scene.brighter().direction, STEP_RAD * ENTRIES as f64)
}

impl DrawnEffect for BowView {
    fn stages(&self) -> Stages {
        if self.has_drops() && self.is_lit { Stages::MEDIUM } else { Stages(0) }
    }

    fn compose(&mut self, shot: &Shot<'_>, to: &mut Composition) -> Result<()> {
        // Not by where the picture looks: a pipeline of its own would be made when the camera turns to a bow, and that frame be late.
        let is_lit = self.has_drops() && self.is_lit;
        to.between_and_veil("BOW", flag(self.has_drops()), flag(is_lit));
        if is_lit && shows(shot) {
            for (to, shares) in to.block.bows.iter_mut().zip(&self.drops) {
                let Some(shares) = shares else { continue };
                let padded = || mixed(shares).map(|[r, g, b]| [r, g, b, 0.0].map(|v| v as f32));
                *to = self.tables.get_or_put(shares, padded);
            }
        }
        Ok(())
    }
}
