//! Settings of a context, except its weather and time, in a saved state.

use std::sync::Arc;

use glam::{DMat3, DVec3};
use serde::{Deserialize, Serialize};

use crate::{
    error::{Error, Result},
    light::{Exposure, ToneCurve},
    planet::Planet,
    scene::{HostLight, MAX_LIGHTS},
    surroundings::{MAX_SHELTERS, Planes, Shelter},
    weather::{CloudMap, MAX_CLOUD_MAP_CELLS},
    wind::{MAX_NODES, WindGrid, WindGridKind},
};

/// Exposure, tone curve, planet, shelters, lamps, wind grid and cloud map as text.
#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct SavedSettings {
    exposure: Exposure,
    /// Absent in states saved before tone curves could be set. Such a state loads only into a context with the same
    /// tone curve.
    #[serde(default)]
    pub tone_curve: Option<ToneCurve>,
    /// Absent in states saved before planets could be set.
    #[serde(default)]
    pub planet: Option<Planet>,
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    shelters: Vec<SavedShelter>,
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    lights: Vec<SavedLight>,
    wind_grid: Option<SavedWindGrid>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    cloud_map: Option<SavedCloudMap>,
}

/// Settings of a context, except its weather and time, read from a saved state and checked.
pub(super) struct SetBeside {
    pub exposure: Exposure,
    pub tone: Option<ToneCurve>,
    pub planet: Option<Planet>,
    pub shelters: Vec<Shelter>,
    pub lights: Vec<HostLight>,
    pub wind_grid: Option<Arc<WindGrid>>,
    pub cloud_map: Option<Arc<CloudMap>>,
}

#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct SavedShelter {
    center_m: [f64; 3],
    axes: [f64; 9],
    half_size_m: [f64; 3],
    velocity_m_s: [f64; 3],
    planes: Vec<[f64; 4]>,
}

#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct SavedLight {
    position_m: [f64; 3],
    direction: [f64; 3],
    intensity_cd: [f64; 3],
    inner_deg: f64,
    outer_deg: f64,
}

#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct SavedWindGrid {
    origin_m: [f64; 3],
    cell_m: [f64; 3],
    nodes: [u32; 3],
    added: bool,
    /// Bits of each node's velocity, east, north and up ([`words`]).
    velocities_m_s: String,
}

#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct SavedCloudMap {
    first_m: [f64; 2],
    cell_m: f64,
    cells: [u32; 2],
    base_m: [f64; 2],
    /// Bits of each cell's value ([`words`]).
    cover: String,
}

impl SavedSettings {
    /// Stores the map of cloud cover.
    pub fn set_cloud_map(&mut self, map: Option<&CloudMap>) {
        self.cloud_map = map.map(SavedCloudMap::of);
    }

    pub fn of(exposure: Exposure, shelters: &[Shelter], lights: &[HostLight], wind_grid: Option<&WindGrid>) -> Self {
        Self {
            exposure,
            tone_curve: None,
            planet: None,
            shelters: shelters.iter().map(SavedShelter::of).collect(),
            lights: lights.iter().map(SavedLight::of).collect(),
            wind_grid: wind_grid.map(SavedWindGrid::of),
            cloud_map: None,
        }
    }

    /// Checks that the settings are valid, and returns them.
    ///
    /// # Errors
    /// As the setters of a context.
    pub fn checked(&self) -> Result<SetBeside> {
        self.exposure.validate()?;
        self.planet.map_or(Ok(()), |p| p.check().map_err(|e| e.within("planet")))?;
        let most = |name: &str, count: usize, most: usize| match count {
            count if count > most => Err(Error::range(name, &format!("at most {most}"), count)),
            _ => Ok(()),
        };
        most("shelters", self.shelters.len(), MAX_SHELTERS)?;
        most("lights", self.lights.len(), MAX_LIGHTS)?;
        let shelters = self.shelters.iter().map(SavedShelter::shelter).collect::<Result<_>>()?;
        let lights = self.lights.iter().map(SavedLight::light).collect::<Result<_>>()?;
        let wind_grid = self.wind_grid.as_ref().map(SavedWindGrid::grid).transpose()?.map(Arc::new);
        let cloud_map = self.cloud_map.as_ref().map(SavedCloudMap::map).transpose()?.map(Arc::new);
        let Self { exposure, tone_curve: tone, planet, .. } = *self;
        Ok(SetBeside { exposure, tone, planet, shelters, lights, wind_grid, cloud_map })
    }
}

impl SavedShelter {
    fn of(s: &Shelter) -> Self {
        let Shelter { center_m, axes, half_size_m, velocity_m_s, planes } = s;
        Self {
            center_m: center_m.to_array(),
            axes: axes.to_cols_array(),
            half_size_m: half_size_m.to_array(),
            velocity_m_s: velocity_m_s.to_array(),
            planes: planes.as_slice().to_vec(),
        }
    }

    fn shelter(&self) -> Result<Shelter> {
        let shelter = Shelter {
            center_m: DVec3::from(self.center_m),
            axes: DMat3::from_cols_array(&self.axes),
            half_size_m: DVec3::from(self.half_size_m),
            velocity_m_s: DVec3::from(self.velocity_m_s),
            planes: Planes::new(&self.planes)?,
        };
        shelter.validate()?;
        Ok(shelter)
    }
}

impl SavedLight {
    fn of(l: &HostLight) -> Self {
        let HostLight { position_m, direction, intensity_cd, inner_deg, outer_deg } = *l;
        let (position_m, direction) = (position_m.to_array(), direction.to_array());
        Self { position_m, direction, intensity_cd, inner_deg, outer_deg }
    }

    fn light(&self) -> Result<HostLight> {
        let light = HostLight {
            position_m: DVec3::from(self.position_m),
            direction: DVec3::from(self.direction),
            intensity_cd: self.intensity_cd,
            inner_deg: self.inner_deg,
            outer_deg: self.outer_deg,
        };
        light.validate()?;
        Ok(light)
    }
}

impl SavedWindGrid {
    fn of(g: &WindGrid) -> Self {
        let WindGrid { origin, cell_m, nodes, kind, velocities_m_s } = g;
        Self {
            origin_m: origin.to_array(),
            cell_m: cell_m.to_array(),
            nodes: *nodes,
            added: *kind == WindGridKind::Added,
            velocities_m_s: words(velocities_m_s.as_flattened().iter().map(|v| u64::from(v.to_bits()))),
        }
    }

    fn grid(&self) -> Result<WindGrid> {
        let unfit = || Error::range("wind_grid", "nodes within the limits and three numbers for each", "others");
        if self.nodes.iter().zip(MAX_NODES).any(|(n, most)| *n > most) {
            return Err(unfit());
        }
        let count = self.nodes.iter().map(|n| *n as usize).product::<usize>();
        let bits = values(&self.velocities_m_s, 3 * count).ok_or_else(unfit)?;
        let numbers = bits.into_iter().map(|b| Some(f32::from_bits(b.try_into().ok()?)));
        let numbers: Vec<f32> = numbers.collect::<Option<_>>().ok_or_else(unfit)?;
        let grid = WindGrid {
            origin: DVec3::from(self.origin_m),
            cell_m: DVec3::from(self.cell_m),
            nodes: self.nodes,
            kind: if self.added { WindGridKind::Added } else { WindGridKind::Whole },
            velocities_m_s: numbers.as_chunks::<3>().0.to_vec(),
        };
        grid.validate()?;
        Ok(grid)
    }
}

impl SavedCloudMap {
    fn of(m: &CloudMap) -> Self {
        let CloudMap { first_m, cell_m, cells, base_m, cover } = m;
        let cover = words(cover.iter().map(|v| u64::from(v.to_bits())));
        Self { first_m: *first_m, cell_m: *cell_m, cells: *cells, base_m: *base_m, cover }
    }

    fn map(&self) -> Result<CloudMap> {
        let unfit = || Error::range("cloud_map", "cells within the limits and a number for each", "others");
        if self.cells.iter().any(|n| *n > MAX_CLOUD_MAP_CELLS) {
            return Err(unfit());
        }
        let count = self.cells.iter().map(|n| *n as usize).product::<usize>();
        let bits = values(&self.cover, count).ok_or_else(unfit)?;
        let numbers = bits.into_iter().map(|b| Some(f32::from_bits(b.try_into().ok()?)));
        let cover = numbers.collect::<Option<_>>().ok_or_else(unfit)?;
        let Self { first_m, cell_m, cells, base_m, .. } = *self;
        let map = CloudMap { first_m, cell_m, cells, base_m, cover };
        map.validate()?;
        Ok(map)
    }
}

/// Returns values as words of hexadecimal text; equal ones in a row become "value*times".
pub(crate) fn words(values: impl Iterator<Item = u64>) -> String {
    use std::fmt::Write;
    let mut text = String::new();
    let mut values = values.peekable();
    while let Some(value) = values.next() {
        let mut times = 1;
        while values.next_if_eq(&value).is_some() {
            times += 1;
        }
        let gap = if text.is_empty() { "" } else { " " };
        // Writing to a string cannot fail.
        let _ = if times > 1 { write!(text, "{gap}{value:x}*{times}") } else { write!(text, "{gap}{value:x}") };
    }
    text
}

/// Returns the values that [`words`] wrote, if there are `count`.
pub(crate) fn values(text: &str, count: usize) -> Option<Vec<u64>> {
    let mut values = Vec::new();
    for word in text.split_whitespace() {
        let (value, times) = word.split_once('*').unwrap_or((word, "1"));
        let times: usize = times.parse().ok().filter(|n| *n <= count - values.len())?;
        values.resize(values.len() + times, u64::from_str_radix(value, 16).ok()?);
    }
    (values.len() == count).then_some(values)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn words_are_read_as_written_and_damaged_ones_are_refused() {
        let list = [7, 7, 7, 0, u64::MAX, 12, 12];
        let text = words(list.into_iter());
        assert_eq!(text, "7*3 0 ffffffffffffffff c*2");
        assert_eq!(values(&text, 7).unwrap(), list);
        assert_eq!(values("", 0).unwrap(), []);
        for (bad, count) in [("7*3", 2), ("7*3", 4), ("7*99999999999999999999", 3), ("x", 1), ("7*-1", 1), ("7*", 1)] {
            assert_eq!(values(bad, count), None, "{bad}");
        }
    }
}
