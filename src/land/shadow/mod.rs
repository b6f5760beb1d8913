//! Shadows of the sun, or of the moon, on the drawn terrain: four shadow maps around the eye, each of which serves many
//! frames.
//!
//! A frame draws at most one map anew, the one that is most overdue, unless maps are missing or far too late. All maps
//! are due after a change of the ground; `cascade.rs` says when else a map is due. The ground is drawn into a map with
//! the levels of detail of the picture, out to the farthest ground towards the light.
//! `shaders/land/shadow_share.wgsl` reads the maps.

mod cascade;
mod maps;

use std::ops::Range;

use glam::DVec3;

#[cfg(test)]
pub(crate) use self::cascade::DISC;
use self::cascade::{Cascade, half_sides_m, nearest_m};
pub(super) use self::maps::{ShadowMaps, no_maps};
use super::{
    pages::Pages,
    relief::Relief,
    selection::{LandFrustum, LandPatch, LevelDistances, select},
    uniforms::{CASCADES, CascadeUniform, LandPicture, LandShadowUniform, PatchInstance},
};
use crate::{
    error::Result,
    gpu::{Device, blocks::Blocks},
    stage::Recording,
    terrain::{CellRect, Terrain},
};

/// Texels along a side of a map for each row of the picture, and the fewest and the most: four maps of 32-bit depths
/// then take at most 34 MB.
const SIDE_PER_ROW: f64 = 4.0 / 3.0;
const SIDES: [f64; 2] = [256.0, 1440.0];
/// Lateness above which a map is drawn anew whatever else is due.
const FAR_TOO_LATE: f64 = 3.0;

/// Shadow maps of a view.
pub(super) struct Shadows {
    blocks: Blocks,
    pages: Pages,
    maps: Option<ShadowMaps>,
    drawn: [Option<Cascade>; CASCADES],
    /// Number of frames for which each map has lacked a change of the ground.
    stale: [u32; CASCADES],
    /// Distance at which the finest map begins, m.
    nearest_m: f64,
    /// Patches of the maps that a frame draws, and scratch space for those of one map.
    patches: Vec<LandPatch>,
    chosen: Vec<LandPatch>,
    instances: Vec<PatchInstance>,
    /// Maps drawn since the view was created.
    #[cfg(test)]
    pub maps_drawn: u64,
}

impl Shadows {
    pub fn new(blocks: &Blocks) -> Self {
        Self {
            blocks: blocks.clone(),
            pages: Pages::of_vertices(),
            maps: None,
            drawn: [None; CASCADES],
            stale: [0; CASCADES],
            nearest_m: 0.0,
            patches: Vec::new(),
            chosen: Vec::new(),
            instances: Vec::new(),
            #[cfg(test)]
            maps_drawn: 0,
        }
    }

    /// Updates the pages after a change of the ground in a rectangle of cells, and notes that the maps lack this
    /// change. `rect` is `None` if everything may have changed.
    pub fn change(&mut self, device: &Device, terrain: &Terrain, rect: Option<CellRect>) {
        match rect {
            Some(rect) => self.pages.update(device, terrain, rect),
            None => self.pages.forget(),
        }
        self.stale = self.stale.map(|frames| frames.max(1));
    }

    /// Frees the maps and their pages, if there are maps.
    pub fn forget(&mut self) {
        if self.maps.is_some() {
            *self = Self::new(&self.blocks);
        }
    }

    /// Maps that the ground's shader reads; `None` until the first map is drawn.
    pub fn maps(&self) -> Option<&ShadowMaps> {
        self.maps.as_ref().filter(|_| self.drawn.iter().any(Option::is_some))
    }

    /// GPU memory, bytes.
    pub fn bytes(&self) -> u64 {
        self.pages.bytes() + self.maps.as_ref().map_or(0, ShadowMaps::bytes)
    }

    /// Constants for a picture; all 0 without maps or without light of sun and moon.
    pub fn uniform(&self, picture: &LandPicture) -> LandShadowUniform {
        if self.maps().is_none() || picture.light.shaded().is_none() {
            return LandShadowUniform::default();
        }
        let (eye, is_sun) = (picture.eye_m(), picture.light.is_sunny());
        let [sun, moon] = [is_sun, !is_sun].map(|is| f32::from(u8::from(is)));
        LandShadowUniform {
            cascades: self.drawn.map(|map| map.map_or(CascadeUniform::default(), |map| map.uniform(eye))),
            shaded: [sun, moon, CASCADES as f32, 0.0],
        }
    }

    /// Draws the maps that are due for a picture of `rows` rows.
    ///
    /// # Errors
    /// [`crate::Status::Internal`] if a shader file is missing.
    pub fn draw(
        &mut self,
        picture: &LandPicture,
        (terrain, relief): (&Terrain, &Relief),
        rows: u32,
        recording: &mut Recording<'_>,
    ) -> Result<()> {
        let (Some(light), Some(bounds)) = (picture.light.shaded(), terrain.bounds) else { return Ok(()) };
        let light = picture.to_local.transpose() * light;
        let side = side_for(rows);
        if self.maps.as_ref().is_none_or(|maps| maps.side != side) {
            self.maps = Some(ShadowMaps::new(recording.device, &self.blocks, side)?);
            self.drawn = [None; CASCADES];
        }
        let (eye, cell_m) = (picture.eye_m(), picture.cell_m);
        self.nearest_m = nearest_m(picture.detail.above * cell_m, self.nearest_m);
        let reach_m = farthest_m(bounds, eye, cell_m).min(picture.shadows_to_m);
        let sides_m = half_sides_m(self.nearest_m, reach_m);
        let due = self.due(light, eye, &sides_m);
        if due == [false; CASCADES] {
            return Ok(());
        }
        self.patches.clear();
        let mut ranges = [0..0, 0..0, 0..0, 0..0];
        let mut above = [picture.detail.above; CASCADES];
        for i in (0..CASCADES).filter(|i| due[*i]) {
            let first = self.patches.len() as u32;
            let (map, own) = self.add_patches(Cascade::new(light, eye, sides_m[i], side), picture, relief);
            (self.drawn[i], above[i]) = (Some(map), own.above);
            self.stale[i] = 0;
            ranges[i] = first..self.patches.len() as u32;
        }
        self.pages.begin(terrain, 0);
        self.pages.place(recording.device, (terrain, picture.eye), &self.patches, &mut self.instances);
        self.leave_out(&mut ranges);
        self.record(picture, (relief.top(), &above), &ranges, recording);
        Ok(())
    }

    /// Drops the maps of this frame whose patches did not all get a page: a later frame draws these maps. The first map
    /// is kept with the patches that got a page.
    fn leave_out(&mut self, ranges: &mut [Range<u32>; CASCADES]) {
        let placed = self.instances.len() as u32;
        for (range, drawn) in ranges.iter_mut().zip(&mut self.drawn) {
            if range.end > placed && range.start > 0 {
                (*range, *drawn) = (0..0, None);
            }
            range.end = range.end.min(placed);
        }
    }

    /// Side of the texels, m, of the finest map that holds a place relative to the eye, and of the next coarser one.
    #[cfg(test)]
    pub fn texels_m(&self, block: &LandShadowUniform, place: DVec3) -> Option<[f64; 2]> {
        let holds = |map: &CascadeUniform| {
            let at = |row: [f32; 4]| row[3] + (0..3).map(|i| row[i] * place[i] as f32).sum::<f32>();
            let [range, _, scale, bottom] = map.size;
            let along = (at(map.depth) * range + bottom) * scale;
            [2.0 * at(map.u) - 1.0, 2.0 * at(map.v) - 1.0, along].iter().all(|v| v.abs() < 0.97)
        };
        let first = (0..CASCADES).find(|i| self.drawn[*i].is_some() && holds(&block.cascades[*i]))?;
        let texel = |i: usize| self.drawn[i.min(CASCADES - 1)].map_or(f64::INFINITY, |map| map.texel_m());
        Some([texel(first), texel(first + 1)])
    }

    /// Returns which maps a frame draws anew.
    fn due(&mut self, light: DVec3, eye: DVec3, sides_m: &[f64; CASCADES]) -> [bool; CASCADES] {
        let stale = |frames: u32| if frames == 0 { 0.0 } else { (1.0 + 0.1 * f64::from(frames)).min(FAR_TOO_LATE) };
        let lateness: [f64; CASCADES] = std::array::from_fn(|i| match &self.drawn[i] {
            None => f64::INFINITY,
            Some(map) => map.lateness(light, eye, sides_m[i]).max(stale(self.stale[i])),
        });
        self.stale.iter_mut().filter(|frames| **frames > 0).for_each(|frames| *frames += 1);
        // Of maps that are equally late, the finest is taken.
        let latest = (0..CASCADES).rev().max_by(|a, b| lateness[*a].total_cmp(&lateness[*b])).unwrap_or(0);
        std::array::from_fn(|i| lateness[i] > FAR_TOO_LATE || (i == latest && lateness[i] >= 1.0))
    }

    /// Adds the patches of a map. Returns the map with the depth that they need, and the distances by which their
    /// levels were chosen: coarser than the picture's where the map would have too many patches.
    fn add_patches(&mut self, mut map: Cascade, picture: &LandPicture, relief: &Relief) -> (Cascade, LevelDistances) {
        let frustum = LandFrustum::of_light(map.clip(picture.eye_m()), picture.eye.place, picture.cell_m);
        let mut detail = picture.detail;
        select(relief, &mut detail, &frustum, &mut self.chosen);
        for patch in &self.chosen {
            let [low, high] = patch.corners_m(relief, picture.cell_m);
            map.hold(low, high);
        }
        self.patches.extend_from_slice(&self.chosen);
        (map, detail)
    }

    /// Records the passes of the maps that have a range of patches. `top` is the level of the largest nodes, `above`
    /// the height by which the levels of each map were chosen.
    fn record(
        &mut self,
        picture: &LandPicture,
        (top, above): (u8, &[f64; CASCADES]),
        ranges: &[Range<u32>; CASCADES],
        recording: &mut Recording<'_>,
    ) {
        let (Some(maps), Some(pages)) = (&mut self.maps, &self.pages.textures) else { return };
        let device = recording.device;
        maps.write_patches(device, &self.instances);
        for (i, range) in ranges.iter().enumerate().filter(|(_, range)| !range.is_empty()) {
            let Some(map) = &self.drawn[i] else { continue };
            let mut block = picture.uniform(glam::DMat4::IDENTITY, top);
            block.above = above[i] as f32;
            block.clip = map.clip(picture.eye_m()).as_mat4().to_cols_array();
            maps.draw(device, recording.encoder, (i, &block), pages, range.clone());
            #[cfg(test)]
            {
                self.maps_drawn += 1;
            }
        }
    }
}

/// Texels along a side of a map, for a picture of `rows` rows: a multiple of the blocks' sides.
fn side_for(rows: u32) -> u32 {
    let wanted = (SIDE_PER_ROW * f64::from(rows)).clamp(SIDES[0], SIDES[1]) as u32;
    wanted.next_multiple_of(maps::BLOCK)
}

/// Horizontal distance from an eye to the farthest corner of the terrain, m.
fn farthest_m(bounds: CellRect, eye: DVec3, cell_m: f64) -> f64 {
    let far = [0, 1].map(|i| {
        let ends = [bounds.low[i], bounds.high[i]].map(|v| (f64::from(v) * cell_m - eye[i]).abs());
        ends[0].max(ends[1])
    });
    far[0].hypot(far[1])
}
