//! Light sources of a flash: the few points that represent the open channel, which lies outside clouds, and the glow in
//! the cloud.

use std::f64::consts::PI;

use glam::DVec3;

use super::{
    light::{Course, Span},
    strike::Strike,
};

/// Number of sources for the open channel, by height.
const OPEN_PARTS: usize = 3;
/// Number of sources in the cloud, along the path.
const HIDDEN_PARTS: usize = 2;

/// A point from which light comes.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct LightSource {
    /// Position in the host's world, m.
    pub position: DVec3,
    /// Luminous flux, lm. For an open channel it is the flux in all directions, for a channel in a cloud the flux that
    /// leaves through the cloud's base and top.
    pub flux_lm: f64,
    /// Extent of the light around the position, m.
    pub radius_m: f64,
    /// Height above the cloud's base, m; 0 for an open channel.
    pub depth_m: f64,
    /// Share of the cloud's light that leaves through its base. The rest leaves through its top.
    pub down_share: f64,
}

impl LightSource {
    /// Whether the source is in a cloud.
    pub fn is_hidden(&self) -> bool {
        self.depth_m > 0.0
    }

    /// Returns the luminous intensity along a direction (east, north, up), cd. A cloud's base sends light by Lambert's
    /// law, downwards only.
    pub fn intensity_cd(&self, way: DVec3) -> f64 {
        if self.is_hidden() {
            return self.flux_lm * self.down_share / PI * (-way.normalize_or(DVec3::Z).z).max(0.0);
        }
        self.flux_lm / (4.0 * PI)
    }
}

/// Light sources of a flash.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct FlashSources {
    /// Sources of the open channel from its lower end up, then those in the cloud along the path.
    all: [LightSource; OPEN_PARTS + HIDDEN_PARTS],
}

impl FlashSources {
    /// Returns the sources that give light.
    pub fn iter(&self) -> impl Iterator<Item = &LightSource> {
        self.all.iter().filter(|s| s.flux_lm > 0.0)
    }
}

impl Strike {
    /// Returns the sources of its light, averaged over a span. If a source lies at the height d above the base of a
    /// cloud of thickness H, the share 1 - d/H of its light (at least 0.05) leaves through the base, and the rest
    /// through the top. Droplets absorb hardly any light, so the light wanders until it leaves the cloud (gambler's
    /// ruin).
    pub fn sources(&self, span: &Span, course: Course) -> FlashSources {
        let mut sources = FlashSources::default();
        let ends = [self.channel.points_m[0], self.channel.end_m()];
        let way = ends[1] - ends[0];
        let clouds = self.clouds;
        let base_m = clouds.map_or(f64::INFINITY, |c| c.base_m);
        let (low_m, high_m) = self.open_altitudes(base_m);
        self.each_part(span, course, |part| {
            let middle = 0.5 * (part.ends[0] + part.ends[1]);
            let mut add = |i: usize, flux: f64| {
                let to = &mut sources.all[i];
                to.flux_lm += flux;
                to.position += middle * flux;
                to.depth_m += (part.altitude_m - base_m).max(0.0) * flux;
            };
            if part.open > 0.0 {
                let height = (part.altitude_m - low_m) / (high_m - low_m).max(1.0);
                add(
                    (height * OPEN_PARTS as f64).clamp(0.0, OPEN_PARTS as f64 - 1.0) as usize,
                    part.flux_lm * part.open,
                );
            }
            if part.open < 1.0 {
                let along = (middle - ends[0]).dot(way) / way.length_squared().max(1.0);
                let i = (along * HIDDEN_PARTS as f64).clamp(0.0, HIDDEN_PARTS as f64 - 1.0) as usize;
                add(OPEN_PARTS + i, part.flux_lm * (1.0 - part.open));
            }
        });
        let radius_m = 0.5 * (high_m - low_m).max(0.0) / OPEN_PARTS as f64;
        for (i, s) in sources.all.iter_mut().enumerate().filter(|(_, s)| s.flux_lm > 0.0) {
            s.position /= s.flux_lm;
            s.depth_m /= s.flux_lm;
            s.radius_m = radius_m;
            if let (true, Some(c)) = (i >= OPEN_PARTS, clouds) {
                s.depth_m = s.depth_m.max(1.0);
                s.down_share = (1.0 - s.depth_m / (c.top_m - c.base_m).max(1.0)).clamp(0.05, 1.0);
            } else {
                s.depth_m = 0.0;
            }
        }
        sources
    }

    /// Returns the range of altitudes of the open channel, m.
    fn open_altitudes(&self, base_m: f64) -> (f64, f64) {
        let ends = self.channel.ways().flatten().map(|p| self.altitude_m(*p));
        let (low, high) = ends.fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), z| (l.min(z), h.max(z)));
        (low, high.min(base_m))
    }
}
