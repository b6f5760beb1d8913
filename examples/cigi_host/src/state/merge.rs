//! What holds at a place: layers over the atmosphere, regions over the world, overlapping regions by their flags.
//!
//! A region counts with the weight 1 inside its rectangle, which falls linearly to 0 across the perimeter outside of
//! it. A layer counts with the weight 1 from its base to its top, which falls linearly to 0 across its transition below
//! and above. Where layers overlap in one scope, temperature, humidity, pressure and wind (as a vector) are the means
//! by weight, and the extinctions that the layers add to that of the atmosphere sum up: a fog in rain is denser than
//! either.
//!
//! Inside a region its own layers stand in for layers of the world with the same number; the world's other layers go
//! on. Regions that overlap are taken in the order in which their packets came. A region without the merge flag reduces
//! the weights of those before it by its own weight, so inside of it they have none and it wins; a merged one leaves
//! them. The value is the mean by weight, over what holds without regions, and all of it is continuous in the place.
//! The rule by quantity in the standard's own table is not known to us: this one is our own.

use super::{Air, Layer, MergeFlags, Region, Scope, Sea, Shape, State};
use crate::geodesy::{Place, north_east_m};

/// Lowest visibility that counts, m: its extinction is finite.
const MIN_VISIBILITY_M: f64 = 0.01;

/// Returns 1 inside, and what is left of it at a distance from the edge of something that fades over a width.
fn faded(distance_m: f64, width_m: f64) -> f64 {
    if distance_m <= 0.0 {
        1.0
    } else if distance_m < width_m {
        1.0 - distance_m / width_m
    } else {
        0.0
    }
}

impl Shape {
    /// Returns the distance of a place from the rectangle with round corners, m; 0 inside.
    pub fn distance_m(&self, place: Place) -> f64 {
        let [north, east] = north_east_m(self.centre, place);
        let rotation = self.rotation_deg.to_radians();
        let (sine, cosine) = (libm::sin(rotation), libm::cos(rotation));
        let along = [north * cosine + east * sine, east * cosine - north * sine];
        let beyond = [0, 1].map(|i| (along[i].abs() - self.size_m[i] / 2.0 + self.corner_radius_m).max(0.0));
        (libm::hypot(beyond[0], beyond[1]) - self.corner_radius_m).max(0.0)
    }

    /// Returns the weight of the region at a place, from 1 inside to 0 at the perimeter's edge.
    pub fn weight(&self, place: Place) -> f64 {
        faded(self.distance_m(place), self.perimeter_m)
    }
}

impl Layer {
    /// Returns the weight of the layer at an altitude above mean sea level, from 1 inside to 0 at the transition's
    /// edge.
    pub fn weight(&self, altitude_m: f64) -> f64 {
        let [below, above] = [self.base_m - altitude_m, altitude_m - self.base_m - self.thickness_m];
        let (distance, band) = if below > 0.0 { (below, self.transition_m[0]) } else { (above, self.transition_m[1]) };
        faded(distance, band)
    }
}

/// Quantities of air that can be averaged: temperature, humidity, pressure, wind to north, east and up, extinction.
type Quantities = [f64; 7];
/// Index of the extinction.
const EXTINCTION: usize = 6;

impl Air {
    fn quantities(&self) -> Quantities {
        let from = self.wind_from_deg.to_radians();
        let wind = [libm::cos(from), libm::sin(from)].map(|c| -self.wind_mps * c);
        let extinction = 1.0 / self.visibility_m.max(MIN_VISIBILITY_M);
        let [temperature, humidity, pressure] = [self.temperature_c, self.humidity_percent, self.pressure_hpa];
        [temperature, humidity, pressure, wind[0], wind[1], self.vertical_wind_mps, extinction]
    }

    fn of_quantities(quantities: Quantities) -> Self {
        let [temperature_c, humidity_percent, pressure_hpa, north, east, vertical_wind_mps, extinction] = quantities;
        let wind_mps = libm::hypot(north, east);
        let from = libm::atan2(-east, -north).to_degrees();
        let wind_from_deg = if wind_mps < 1e-9 { 0.0 } else { from.rem_euclid(360.0) % 360.0 };
        let visibility_m = 1.0 / extinction;
        Self { humidity_percent, temperature_c, visibility_m, wind_mps, vertical_wind_mps, wind_from_deg, pressure_hpa }
    }
}

/// Share of one region at a place.
struct Part<const N: usize> {
    weight: f64,
    is_merged: bool,
    arrival: u64,
    value: [f64; N],
}

/// Returns the value at a place of regions over what holds below them.
fn over<const N: usize>(below: [f64; N], mut parts: Vec<Part<N>>) -> [f64; N] {
    parts.retain(|part| part.weight > 0.0);
    parts.sort_by_key(|part| part.arrival);
    let mut shares: Vec<f64> = Vec::with_capacity(parts.len());
    let mut bare = 1.0;
    for part in &parts {
        if !part.is_merged {
            shares.iter_mut().for_each(|share| *share *= 1.0 - part.weight);
        }
        shares.push(part.weight);
        bare *= 1.0 - part.weight;
    }
    let total: f64 = shares.iter().sum();
    if total <= 0.0 {
        return below;
    }
    let mean = |i: usize| parts.iter().zip(&shares).map(|(part, share)| share * part.value[i]).sum::<f64>() / total;
    std::array::from_fn(|i| bare * below[i] + (1.0 - bare) * mean(i))
}

/// Returns layers with their weights over an atmosphere.
fn layered(atmosphere: Quantities, layers: &[(f64, Quantities)]) -> Quantities {
    let total: f64 = layers.iter().map(|(weight, _)| weight).sum();
    if total <= 0.0 {
        return atmosphere;
    }
    let most = layers.iter().map(|(weight, _)| *weight).fold(0.0, f64::max);
    let mut out = std::array::from_fn(|i| {
        let mean = layers.iter().map(|(weight, layer)| weight * layer[i]).sum::<f64>() / total;
        (1.0 - most) * atmosphere[i] + most * mean
    });
    let added = layers.iter().map(|(weight, layer)| weight * (layer[EXTINCTION] - atmosphere[EXTINCTION]).max(0.0));
    out[EXTINCTION] = atmosphere[EXTINCTION] + added.sum::<f64>();
    out
}

/// Concentration of the particles of one layer at a place.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Aerosol {
    /// Layer.
    pub layer_id: u8,
    /// Concentration, g/m^3.
    pub g_m3: f64,
}

impl State {
    /// Returns the active regions with a weight at a place, with it.
    fn regions_at(&self, place: Place) -> impl Iterator<Item = (&Region, f64)> {
        let active = self.regions.values().filter(|region| region.is_active);
        let weighed = active.filter_map(move |region| Some((region, region.shape?.weight(place))));
        weighed.filter(|(_, weight)| *weight > 0.0)
    }

    /// Returns the air in the layers of one scope over the atmosphere, at an altitude above mean sea level; `None` if
    /// no layer holds it.
    pub fn air_in(&self, scope: &Scope, altitude_m: f64) -> Option<Air> {
        let enabled = scope.layers.values().filter(|layer| layer.is_enabled);
        let weighed: Vec<_> = enabled.map(|layer| (layer.weight(altitude_m), layer.air.quantities())).collect();
        let is_held = weighed.iter().any(|(weight, _)| *weight > 0.0);
        is_held.then(|| Air::of_quantities(layered(self.atmosphere.quantities(), &weighed)))
    }

    /// Returns the air at a place. The altitude is above mean sea level.
    pub fn air_at(&self, place: Place) -> Air {
        let atmosphere = self.atmosphere.quantities();
        let weight = |layer: &Layer| if layer.is_enabled { layer.weight(place.altitude_m) } else { 0.0 };
        let weighed = |layer: &Layer, share: f64| (share * weight(layer), layer.air.quantities());
        let global: Vec<_> = self.global.layers.values().map(|layer| weighed(layer, 1.0)).collect();
        let below = layered(atmosphere, &global);
        let mut parts = Vec::new();
        let mut holding = 0;
        for (region, share) in self.regions_at(place) {
            let own = || region.scope.layers.iter().filter(|(_, layer)| weight(layer) > 0.0);
            let most = own().map(|(_, layer)| weight(layer)).fold(0.0, f64::max);
            if most <= 0.0 {
                continue;
            }
            let is_hidden = |id: &u8| region.scope.layers.get(id).is_some_and(|layer| layer.is_enabled);
            let others = self.global.layers.iter().filter(|(id, _)| !is_hidden(id));
            let mut layers: Vec<_> = own().map(|(_, layer)| weighed(layer, 1.0 / most)).collect();
            layers.extend(others.map(|(_, layer)| weighed(layer, 1.0)));
            parts.push(Part {
                weight: share * most,
                is_merged: region.merge.weather,
                arrival: own().map(|(_, layer)| layer.arrival).max().unwrap_or(0),
                value: layered(atmosphere, &layers),
            });
            holding += 1;
        }
        let is_alone = holding == 0 && global.iter().all(|(weight, _)| *weight <= 0.0);
        // Nothing to average: the host's own numbers, without a rounding.
        if is_alone { self.atmosphere } else { Air::of_quantities(over(below, parts)) }
    }

    /// Returns the particles at a place of each layer that holds it, in the order of the layers' numbers. The altitude
    /// is above mean sea level.
    pub fn aerosols_at(&self, place: Place) -> Vec<Aerosol> {
        let weight = |layer: &Layer| if layer.is_enabled { layer.weight(place.altitude_m) } else { 0.0 };
        let regions: Vec<_> = self.regions_at(place).collect();
        let mut ids: Vec<u8> = regions
            .iter()
            .flat_map(|(region, _)| &region.scope.layers)
            .chain(&self.global.layers)
            .filter(|(_, layer)| weight(layer) > 0.0)
            .map(|(id, _)| *id)
            .collect();
        ids.sort_unstable();
        ids.dedup();
        let concentration = |layer: &Layer| weight(layer) * layer.aerosol_g_m3;
        let of_layer = |layer_id: u8| {
            let below = self.global.layers.get(&layer_id).map_or(0.0, concentration);
            let own = regions.iter().filter_map(|(region, share)| {
                let layer = region.scope.layers.get(&layer_id).filter(|layer| layer.is_enabled)?;
                let (is_merged, arrival) = (region.merge.aerosol, layer.arrival);
                Some(Part { weight: *share, is_merged, arrival, value: [concentration(layer)] })
            });
            let [g_m3] = over([below], own.collect());
            Aerosol { layer_id, g_m3 }
        };
        ids.into_iter().map(of_layer).collect()
    }

    /// Returns the sea at a place, without whitecaps; `None` if the host has said nothing of it.
    pub fn sea_at(&self, place: Place) -> Option<Sea> {
        let own = |region: &Region| region.scope.sea.filter(|sea| sea.is_enabled);
        let regional: Vec<_> =
            self.regions_at(place).filter_map(|(region, weight)| Some((own(region)?, weight, region.merge))).collect();
        let global = self.global.sea;
        if regional.is_empty() {
            return global;
        }
        let value = |sea: &Sea| [sea.surface_height_m, sea.temperature_c, sea.clarity_percent];
        // Without a sea of the world the regions' own goes on to the edge of their perimeters.
        let part = |(sea, weight, merge): &(Sea, f64, MergeFlags)| Part {
            weight: if global.is_some() { *weight } else { 1.0 },
            is_merged: merge.maritime,
            arrival: sea.arrival,
            value: value(sea),
        };
        let parts = regional.iter().map(part).collect();
        let below = global.as_ref().map_or([0.0; 3], value);
        let [surface_height_m, temperature_c, clarity_percent] = over(below, parts);
        Some(Sea { surface_height_m, temperature_c, clarity_percent, is_enabled: true, ..Sea::default() })
    }

    /// Returns the conditions of the ground at a place, by their numbers; empty if it is dry. The conditions of a
    /// region hold up to half of its perimeter.
    pub fn ground_at(&self, place: Place) -> Vec<u16> {
        let mut stated: Vec<&Region> = self
            .regions_at(place)
            .filter(|(region, weight)| *weight >= 0.5 && region.scope.ground.is_stated())
            .map(|(region, _)| region)
            .collect();
        stated.sort_by_key(|region| region.scope.ground.arrival);
        // The last region without the flag hides all before it.
        let first = stated.iter().rposition(|region| !region.merge.terrestrial).unwrap_or(0);
        let grounds = stated[first.min(stated.len())..].iter().map(|region| &region.scope.ground);
        let grounds: Vec<_> = if stated.is_empty() { vec![&self.global.ground] } else { grounds.collect() };
        let mut ids: Vec<u16> = grounds.iter().flat_map(|ground| ground.conditions.keys().copied()).collect();
        ids.sort_unstable();
        ids.dedup();
        ids
    }
}
