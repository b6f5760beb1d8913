//! All that a host has said so far and that still holds.
//!
//! CIGI keeps state: a packet overrides what the last packet for the same object said, and holds until the next.
//! Numbers that are not finite leave the former value, numbers out of range are clamped; [`Notes`]
//! counts both. Each kind of object has a limit, so that no peer makes the state grow without end.

mod environment;
mod merge;
mod objects;

use std::collections::BTreeMap;

pub use environment::{Air, Clock, Condition, Ground, Layer, MergeFlags, Region, Scope, Sea, Shape, Sky, Wave};
pub use merge::Aerosol;
pub use objects::{Component, ComponentKey, Entity, Frustum, Part, Rates, View};

use crate::notes::Notes;
use crate::wire::{Family, Packet};

/// Most regions.
pub const MAX_REGIONS: usize = 256;
/// Most entities.
pub const MAX_ENTITIES: usize = 4096;
/// Most views.
pub const MAX_VIEWS: usize = 256;
/// Most components.
pub const MAX_COMPONENTS: usize = 4096;
/// Most layers of weather, waves, or conditions of the ground in one scope, and most parts of an entity.
pub const MAX_ITEMS: usize = 64;

/// All that a host has said.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct State {
    /// Date and time, and what shines.
    pub sky: Sky,
    /// The air outside of all layers.
    pub atmosphere: Air,
    /// The environment of the whole world.
    pub global: Scope,
    /// Regions by their number. A region of which only weather was said has no shape yet, and does not show.
    pub regions: BTreeMap<u16, Region>,
    /// Entities by their number.
    pub entities: BTreeMap<u16, Entity>,
    /// Views by their number.
    pub views: BTreeMap<u16, View>,
    /// Components by class, object and component.
    pub components: BTreeMap<ComponentKey, Component>,
    /// Whether motion may be smoothed.
    pub has_smoothing: bool,
    /// Count of the packets so far, by which the last one wins.
    arrivals: u64,
}

impl State {
    /// Takes one packet of a version of this family. Requests change nothing here.
    pub fn apply(&mut self, packet: &Packet, family: Family, notes: &mut Notes) {
        self.arrivals += 1;
        match packet {
            Packet::IgControl(first) => self.has_smoothing = first.smoothing_enable,
            Packet::EntityControl(entity) => self.control_entity(entity, family, notes),
            Packet::EntityPosition(position) => self.place_entity(position, notes),
            Packet::ViewControl(view) => self.place_view(view, notes),
            Packet::ViewDefinition(view) => self.define_view(view, notes),
            Packet::CelestialSphereControl(sky) => self.sky.apply(sky, notes),
            Packet::AtmosphereControl(air) => self.atmosphere.apply(air, notes),
            Packet::EnvironmentalRegionControl(region) => self.control_region(region, notes),
            Packet::WeatherControl(layer) => self.control_layer(layer, notes),
            Packet::MaritimeSurfaceConditionsControl(sea) => self.control_sea(sea, notes),
            Packet::WaveControl(wave) => self.control_wave(wave, notes),
            Packet::TerrestrialSurfaceConditionsControl(ground) => self.control_ground(ground, notes),
            Packet::ComponentControl(component) => self.control_component(component, notes),
            Packet::ShortComponentControl(component) => self.control_short_component(component, notes),
            Packet::ArticulatedPartControl(part) => self.control_part(part, notes),
            Packet::ShortArticulatedPartControl(parts) => self.control_parts(parts, notes),
            Packet::RateControl(rates) => self.control_rates(rates, notes),
            Packet::StartOfFrame(_)
            | Packet::EnvironmentalConditionsRequest(_)
            | Packet::HatHotRequest(_)
            | Packet::WeatherConditionsResponse(_)
            | Packet::AerosolConcentrationResponse(_)
            | Packet::MaritimeSurfaceConditionsResponse(_)
            | Packet::TerrestrialSurfaceConditionsResponse(_)
            | Packet::HatHotResponse(_)
            | Packet::HatHotExtendedResponse(_) => {}
        }
    }
}

/// Returns the entry of a key, made if there is none and fewer than `most`.
fn entry<'a, K: Ord, V: Default>(
    map: &'a mut BTreeMap<K, V>,
    key: K,
    most: usize,
    packet: &'static str,
    notes: &mut Notes,
) -> Option<&'a mut V> {
    if map.len() >= most && !map.contains_key(&key) {
        notes.add(packet, "", "ignored, there are as many objects of this kind as there may be");
        return None;
    }
    Some(map.entry(key).or_default())
}
