//! Drift of each cloud layer with the wind, and the number of lifetimes of its clouds that have passed.
//!
//! A layer moves with the mean wind at its height, or with its own wind
//! ([`CloudSlab::wind_m_s`](crate::weather::CloudSlab)). Its drift is counted in distances from cloud to cloud, and
//! time in lives, so that a weather with wider or longer-lived clouds does not shift the existing ones. Both are
//! integrals over the timeline, computed between the starts and ends of changes by the Gauss-Legendre rule of 8 points.
//! Any sequence of updates therefore gives the same bits.

use glam::{DMat2, DVec2};

use crate::{
    numerics::GAUSS_8_HALF,
    weather::{CloudSlab, Conditions, MAX_CLOUD_LAYERS, Timeline, timeline::Change},
};

/// Drift of one layer since time 0.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct LayerDrift {
    /// Integral since time 0 of the wind (east, north) divided by the distance from cloud to cloud, in the pattern
    /// before it is stretched ([`stretch`]).
    pub way: DVec2,
    /// Number of lifetimes of the layer's clouds that have passed since time 0.
    pub lives: f64,
}

/// Drifts of all layers at a time, by the slots of [`Conditions::clouds`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct LayerDrifts {
    /// Simulation time, s.
    pub time_s: f64,
    /// Drift of each slot.
    pub slots: [LayerDrift; MAX_CLOUD_LAYERS],
}

/// Slots of the weather before all changes, and the changes under way.
#[derive(Clone, Copy)]
struct LayerChanges<'a> {
    /// Weather before all changes.
    base: &'a Conditions,
    /// Changes under way.
    active: &'a [Change],
}

/// Share by which the coordinate along the wind shrinks in the pattern of fully fibrous clouds, which stretches the
/// clouds.
const DRAWN_OUT: f64 = 0.85;
/// Wind added to a layer's own to get the direction of its fibres, m/s (east, north): there is shear even in a calm.
const SHEAR_M_S: DVec2 = DVec2::new(2.0, 0.0);

/// Returns the direction along which a layer's fibres are stretched (east, north), as a vector of nearly length 1. The
/// vector is shorter where the layer's wind and the shear nearly cancel, so that the direction is hardly defined.
pub(crate) fn stretch_toward(slab: &CloudSlab) -> DVec2 {
    let along = DVec2::from_array(slab.wind_m_s) + SHEAR_M_S;
    along / (along.length_squared() + 0.1).sqrt()
}

/// Returns the matrix from positions in a layer (east, north) to positions in the pattern before it is stretched along
/// the wind.
pub(crate) fn stretch(slab: &CloudSlab) -> DMat2 {
    let along = stretch_toward(slab);
    let shorter = DMat2::from_cols(along * along.x, along * along.y);
    DMat2::IDENTITY - shorter * (DRAWN_OUT * slab.fibre)
}

/// Returns the rate of the drift of a layer, per second.
fn rate(slab: &CloudSlab) -> LayerDrift {
    let way = stretch(slab) * DVec2::from_array(slab.wind_m_s) / slab.scale_m;
    LayerDrift { way, lives: 1.0 / slab.life_s }
}

impl LayerChanges<'_> {
    /// Returns the slab of a slot at `t`.
    fn slab(&self, slot: usize, t: f64) -> CloudSlab {
        let over = |below: CloudSlab, change: &Change| below.blend(&change.to.clouds[slot], change.share(t));
        self.active.iter().fold(self.base.clouds[slot], over)
    }

    /// Returns how far the clouds of a slot drift between two times, and how many lives pass.
    fn integral(&self, slot: usize, from_s: f64, to_s: f64) -> LayerDrift {
        let (middle, half) = (0.5 * (from_s + to_s), 0.5 * (to_s - from_s));
        if self.active.is_empty() {
            return LayerDrift::default().after(&rate(&self.base.clouds[slot]), to_s - from_s);
        }
        GAUSS_8_HALF.iter().fold(LayerDrift::default(), |sum, &(x, weight)| {
            let at = |x: f64| rate(&self.slab(slot, middle + half * x));
            sum.after(&at(-x), half * weight).after(&at(x), half * weight)
        })
    }
}

impl LayerDrift {
    /// Returns the drift after a time at a constant rate.
    fn after(self, rate: &Self, time_s: f64) -> Self {
        Self { way: self.way + rate.way * time_s, lives: self.lives + rate.lives * time_s }
    }
}

impl LayerDrifts {
    /// Drifts at time 0.
    pub const ZERO: Self = Self { time_s: 0.0, slots: [LayerDrift { way: DVec2::ZERO, lives: 0.0 }; MAX_CLOUD_LAYERS] };

    /// Returns the drifts at `to_s`, under `changes`.
    fn onward(&self, changes: LayerChanges<'_>, to_s: f64) -> Self {
        let one = |slot: usize| self.slots[slot].after(&changes.integral(slot, self.time_s, to_s), 1.0);
        Self { time_s: to_s, slots: std::array::from_fn(one) }
    }

    /// Returns the drifts at `t`, at which the timeline must be known. `self` holds the drifts at the end of the last
    /// change that the timeline has forgotten.
    pub fn until(self, timeline: &Timeline, t: f64) -> Self {
        let (mut base, mut changes) = timeline.parts();
        let mut at = self;
        match changes.first() {
            // A timeline that has forgotten nothing may have changes before time 0. The integral then starts at the
            // first of them, with the drift that the steady wind before it has at that time.
            Some(first) if timeline.known_since_ever() && t < first.start_s => changes = &[],
            Some(first) if timeline.known_since_ever() && first.start_s < at.time_s => {
                at = at.onward(LayerChanges { base, active: &[] }, first.start_s);
            }
            _ => {}
        }
        loop {
            let now = at.time_s;
            if let Some(ended) = changes.iter().rposition(|c| c.start_s <= now && c.end_s() <= now) {
                (base, changes) = (&changes[ended].to, &changes[ended + 1..]);
            }
            let count = changes.iter().take_while(|c| c.start_s <= now).count();
            let active = &changes[..count];
            let end = active.iter().map(Change::end_s).fold(f64::INFINITY, f64::min);
            let next = changes.get(count).map_or(end, |c| c.start_s.min(end));
            at = at.onward(LayerChanges { base, active }, next.min(t));
            if next > t {
                return at;
            }
        }
    }

    /// Returns the drifts at the end of the last change that the timeline will have forgotten once it has advanced to
    /// `now_s`. Call it before the timeline advances.
    pub fn kept(self, timeline: &Timeline, now_s: f64) -> Self {
        timeline.ends_before(now_s).map_or(self, |end_s| self.until(timeline, end_s))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::weather::{CloudKind, CloudLayer, LayerWind, Weather, Wind, derive};

    fn of(layers: &[CloudLayer], speed_m_s: f64, from_deg: f64) -> Conditions {
        let (clouds, wind) = (layers.to_vec(), Wind::of(speed_m_s, from_deg));
        derive(&Weather { clouds, wind, ..Weather::default() }).unwrap()
    }

    fn low(wind: Option<LayerWind>, spacing_m: Option<f64>) -> CloudLayer {
        CloudLayer { wind, spacing_m, ..CloudLayer::of(CloudKind::Cumulus, 0.5, 1000.0) }
    }

    /// Changes one after another and overlapping, a cut, a calm, and layers that come and go.
    fn changes() -> Timeline {
        let own = LayerWind { speed_m_s: 20.0, from_deg: 180.0 };
        let high = CloudLayer::of(CloudKind::Cirrus, 0.3, 9000.0);
        let mut timeline = Timeline::new(of(&[low(None, None)], 4.0, 270.0));
        let changes = [
            (of(&[low(Some(own), None), high], 9.0, 200.0), -50.0, 30.0),
            (of(&[low(Some(own), Some(4000.0))], 9.0, 200.0), 60.0, 300.0),
            (of(&[], 0.0, 0.0), 200.0, 400.0),
            (of(&[low(None, None), high], 15.0, 30.0), 500.0, 0.0),
            (of(&[low(None, None)], 2.0, 90.0), 700.0, 100.0),
        ];
        for (to, start_s, transition_s) in changes {
            timeline.change(to, start_s, transition_s).unwrap();
        }
        timeline
    }

    #[test]
    fn layers_move_and_age_by_the_integrals_of_their_rates_and_no_change_makes_them_jump() {
        let timeline = changes();
        let at = |t: f64| LayerDrifts::ZERO.until(&timeline, t);
        let step_s = 0.25;
        for i in -400..4000 {
            let t = f64::from(i) * step_s;
            let (a, b, weather) = (at(t), at(t + step_s), timeline.at(t + 0.5 * step_s));
            let ends = [timeline.at(t + 1e-6), timeline.at(t + step_s - 1e-6)];
            // In a layer that has hardly begun, or is nearly gone, the wind can change within a second; the points of
            // the quadrature are too sparse for that.
            for (slot, slab) in weather.clouds.iter().enumerate().filter(|(_, s)| s.cover > 0.05) {
                let want = rate(slab);
                let way = (b.slots[slot].way - a.slots[slot].way) / step_s;
                let [first, last] = [0, 1].map(|i| rate(&ends[i].clouds[slot]).way);
                let off = (way - want.way).length() - (first - last).length();
                assert!(off < 0.1 * want.way.length() + 1e-5, "slot {slot} at {t}: {way} against {}", want.way);
                let lives = (b.slots[slot].lives - a.slots[slot].lives) / step_s;
                assert!((lives / want.lives - 1.0).abs() < 0.01, "slot {slot} at {t}");
            }
        }
    }

    #[test]
    fn forgetting_ended_changes_alters_no_bit() {
        let whole = LayerDrifts::ZERO.until(&changes(), 1500.0);
        let (mut timeline, mut kept) = (changes(), LayerDrifts::ZERO);
        for now_s in [-10.0, 5.0, 100.0, 365.0, 640.0, 650.0, 900.0] {
            kept = kept.kept(&timeline, now_s);
            timeline.advance(now_s);
            assert_eq!(kept.until(&timeline, 1500.0), whole, "after {now_s} s");
        }
    }
}
