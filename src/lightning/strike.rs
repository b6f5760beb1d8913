//! A flash in the host's world: its channel, the part of it that clouds hide, and its light.

use glam::{DMat3, DVec3};

use super::{
    channel::{Channel, Mast, struck},
    flash::{Flash, FlashKind},
    light::{Course, Span, Stretch, flux_lm_m},
};
use crate::{
    surroundings::{Shelter, met_at},
    weather::Conditions,
    world::World,
};

/// Temperature of the cloud's charge from which a flash starts, degrees Celsius (Krehbiel 1986: -10 to -25).
const CHARGE_C: f64 = -12.0;
/// Lapse rate of the air, K/m.
const COOLS_K_M: f64 = 6.5e-3;
/// Least height of the charge above the station, m, before the charge is moved to within the clouds.
const LEAST_M: f64 = 2500.0;
/// Least distance of the charge from the cloud's base and top, m. In a cloud thinner than twice this distance the
/// charge lies half way up.
const WITHIN_M: f64 = 800.0;
/// Least cover with which a layer of cloud hides a channel inside it, if its optical depth is above 5.
const HIDES_FROM: f64 = 0.2;
/// Depth in cloud over which a channel fades to 1/e, m.
const FADES_M: f64 = 60.0;

/// Clouds that hide flashes: altitudes of their lowest base and highest top, m.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct CloudSpan {
    /// Altitude of the lowest base, m.
    pub base_m: f64,
    /// Altitude of the highest top, m.
    pub top_m: f64,
}

impl CloudSpan {
    /// Returns the clouds of a weather that hide flashes, if there are any.
    pub fn of(c: &Conditions) -> Option<Self> {
        let station = c.air.station_altitude_m;
        let slabs = c.cloud_slabs().filter(|s| s.cover >= HIDES_FROM && s.optical_depth > 5.0);
        slabs.fold(None, |span: Option<Self>, s| {
            let (base_m, top_m) = (station + s.base_m, station + s.base_m + s.thickness_m);
            Some(
                span.map_or(Self { base_m, top_m }, |o| Self {
                    base_m: o.base_m.min(base_m),
                    top_m: o.top_m.max(top_m),
                }),
            )
        })
    }
}

/// A part of a channel and its light.
#[derive(Clone, Copy, Debug)]
pub(crate) struct ChannelPart {
    /// Ends in the host's world, m.
    pub ends: [DVec3; 2],
    /// Altitude of its middle, m.
    pub altitude_m: f64,
    /// Luminous flux, lm.
    pub flux_lm: f64,
    /// Share of the flux that the channel sends outside clouds; the rest makes the cloud glow.
    pub open: f64,
}

/// A flash in the host's world.
#[derive(Clone, Debug)]
pub(crate) struct Strike {
    /// Flash on the map, with its strokes.
    pub flash: Flash,
    /// Path in the host's world, m.
    pub channel: Channel,
    /// Clouds that hide the flash, if there are any.
    pub clouds: Option<CloudSpan>,
    /// Temperature of the air at the ground, degrees Celsius.
    pub temperature_c: f64,
    /// Length of the main path, m.
    length_m: f64,
    /// Position on the ground in the host's world, m, from which altitudes are measured.
    anchor: DVec3,
    /// Altitude of `anchor`, m.
    anchor_m: f64,
    /// Unit vector up at `anchor` in the host's world.
    up: DVec3,
}

impl Strike {
    /// Places a flash in the world. `wanted` is the position that a host asks for.
    pub fn new(world: &World, masts: &[DVec3], flash: Flash, wanted: Option<DVec3>) -> Self {
        let conditions = world.timeline.at(flash.time_s);
        let air = &conditions.air;
        let ground_m = match wanted {
            Some(position) => world.frame.frame_at(position).place.altitude_m,
            None => air.station_altitude_m,
        };
        let anchor = world.position_on_map(flash.place_m, ground_m);
        let local = world.frame.frame_at(anchor);
        // For a time that the timeline has forgotten, only the weather's own clouds are known.
        let over = world.clouds_over(&conditions, &local, anchor, flash.place_m, flash.time_s).unwrap_or_default();
        let clouds = CloudSpan::of(over.iter().flatten().last().unwrap_or(&conditions));
        let charge_m = air.station_altitude_m + ((air.temperature_c - CHARGE_C) / COOLS_K_M).max(LEAST_M);
        let top_m = clouds.map_or(charge_m, |c| {
            let inside_m = WITHIN_M.min(0.5 * (c.top_m - c.base_m));
            charge_m.clamp(c.base_m + inside_m, c.top_m - inside_m)
        });
        let end = match wanted {
            Some(_) => flash.place_m.extend(ground_m),
            None => {
                let tall = tall_near(world, masts, &flash, &local.world_to_enu);
                struck(&flash, &tall, ground_m)
            }
        };
        let mut channel = Channel::new(&flash, top_m.max(end.z + 100.0), end);
        let from = flash.place_m.extend(ground_m);
        let to_world = local.world_to_enu.transpose();
        let ways = channel.branches.iter_mut().map(|b| &mut b.points_m);
        for p in std::iter::once(&mut channel.points_m).chain(ways).flatten() {
            *p = anchor + to_world * (*p - from);
        }
        let shelters = &world.set.shelters;
        let met = |a: DVec3, b: DVec3| shelters.iter().filter_map(|s| met_at(s, a, b)).min_by(f64::total_cmp);
        if !shelters.is_empty() {
            channel.cut(met);
        }
        let length_m = channel.length_m();
        let up = to_world * DVec3::Z;
        let temperature_c = air.temperature_c;
        Self { flash, channel, clouds, temperature_c, length_m, anchor, anchor_m: ground_m, up }
    }

    /// Returns the flash's position in the host's world: that of the ground or object that it struck, or the middle of
    /// its path in the cloud.
    pub fn position(&self) -> DVec3 {
        match self.flash.kind {
            FlashKind::ToGround => self.channel.end_m(),
            FlashKind::InCloud => self.channel.points_m[self.channel.points_m.len() / 2],
        }
    }

    /// Returns the altitude of a position in the host's world, m.
    pub(super) fn altitude_m(&self, p: DVec3) -> f64 {
        self.anchor_m + (p - self.anchor).dot(self.up)
    }

    /// Calls `see` with each part that shines, and with its light averaged over a span.
    pub fn each_part(&self, span: &Span, course: Course, mut see: impl FnMut(&ChannelPart)) {
        let main = self.channel.points_m.as_slice();
        self.each_of(main, (0.0, 1.0), (1.0, false), (span, course), &mut see);
        for branch in &self.channel.branches {
            let long_m: f64 = branch.points_m.windows(2).map(|p| (p[1] - p[0]).length()).sum();
            let reaches = branch.leaves_at + long_m / self.length_m.max(1.0);
            self.each_of(
                &branch.points_m,
                (branch.leaves_at, reaches),
                (branch.strength, true),
                (span, course),
                &mut see,
            );
        }
    }

    /// Calls `see` with each part of one path that shines. `from` and `until` are the values of [`Stretch::down`] at
    /// the path's ends, and `strength` is the ratio of its light to that of the main path.
    fn each_of(
        &self,
        points: &[DVec3],
        (from, until): (f64, f64),
        (strength, is_branch): (f64, bool),
        (span, course): (&Span, Course),
        see: &mut impl FnMut(&ChannelPart),
    ) {
        let count = (points.len() - 1) as f64;
        for (i, ends) in points.windows(2).enumerate() {
            let along = (i as f64 + 0.5) / count;
            // Branches fade towards their ends.
            let strength = if is_branch { strength * (1.0 - 0.8 * along) } else { strength };
            let down = (from + (until - from) * along).min(1.0);
            let stretch = Stretch { down, length_m: self.length_m, strength, is_branch };
            let lm_m = flux_lm_m(&self.flash, &stretch, span, course);
            if lm_m > 0.0 {
                let altitude_m = self.altitude_m(0.5 * (ends[0] + ends[1]));
                let depth_m = |c: CloudSpan| (altitude_m - c.base_m).min(c.top_m - altitude_m).max(0.0);
                let open = self.clouds.map_or(1.0, |c| libm::exp(-depth_m(c) / FADES_M));
                let flux_lm = lm_m * (ends[1] - ends[0]).length();
                see(&ChannelPart { ends: [ends[0], ends[1]], altitude_m, flux_lm, open });
            }
        }
    }
}

/// Returns the tips of tall objects that are less than 2 km from a flash along east and along north: the host's masts,
/// and the tops of its shelters.
fn tall_near(world: &World, masts: &[DVec3], flash: &Flash, to_enu: &DMat3) -> Vec<Mast> {
    let up = to_enu.transpose() * DVec3::Z;
    let top = |s: &Shelter| {
        let own = s.axes.transpose() * up;
        s.center_m + up * (own.abs() * s.half_size_m).element_sum()
    };
    let tips = masts.iter().copied().chain(world.set.shelters.iter().map(top));
    let on_map = |tip: DVec3| Mast { tip_m: world.map_at(tip).extend(world.frame.frame_at(tip).place.altitude_m) };
    let near = |m: &Mast| (m.tip_m.truncate() - flash.place_m).abs().max_element() < 2000.0;
    tips.map(on_map).filter(near).collect()
}
