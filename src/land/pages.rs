//! Pages on the GPU: textures with a slot for each page. A new page takes the slot of the page whose last use is
//! oldest.

use std::collections::HashMap;

use super::{
    cells::{CellReader, FARTHEST_RING},
    eye::LandEye,
    page::{PageRect, PageWriter, TEXELS, VERTICES, has_holes, shows_soil},
    relief::NodeKey,
    selection::LandPatch,
    uniforms::PatchInstance,
};
use crate::{
    gpu::{Device, flat_texture},
    terrain::{CellRect, Terrain},
};

/// Slots in a row of the textures.
pub(super) const SLOTS_IN_ROW: u32 = 32;
/// Number of slots that a view begins with.
const FIRST_SLOTS: u32 = 256;
/// Largest number of slots of a view.
const MOST_SLOTS: u32 = 2048;

/// Textures of the pages.
pub(super) struct PageTextures {
    /// Heights of the vertices, m.
    pub vertices: wgpu::Texture,
    /// Slopes to the east and the north, on the page's level and on the next coarser one.
    pub slopes: wgpu::Texture,
    /// Shares of the first four classes, and of the other three with the presence of ground.
    pub classes: [wgpu::Texture; 2],
    /// Colours of dug soil; a placeholder of one texel if the terrain has no dug soil.
    pub dug: wgpu::Texture,
}

impl PageTextures {
    fn new(device: &wgpu::Device, slots: u32, (has_texels, has_dug): (bool, bool)) -> Self {
        use wgpu::{TextureFormat as F, TextureUsages as U};
        let usage = U::TEXTURE_BINDING | U::COPY_DST;
        let size = |side: i32| (SLOTS_IN_ROW * side as u32, slots / SLOTS_IN_ROW * side as u32);
        let texels = |is_there, format| {
            let size = if is_there { size(TEXELS) } else { (1, 1) };
            flat_texture(device, "land pages", size, format, usage)
        };
        Self {
            vertices: flat_texture(device, "land pages", size(VERTICES), F::R32Float, usage),
            slopes: texels(has_texels, F::Rgba16Float),
            classes: [texels(has_texels, F::Rgba8Unorm), texels(has_texels, F::Rgba8Unorm)],
            dug: texels(has_dug, F::Rgba8UnormSrgb),
        }
    }
}

#[derive(Clone, Copy)]
struct PageSlot {
    page: Option<NodeKey>,
    /// Number of the last picture that used the page.
    used: u64,
    /// Whether any texel of the page has no ground.
    has_holes: bool,
    /// Whether any vertex of the page has no ground.
    is_torn: bool,
}

const EMPTY: PageSlot = PageSlot { page: None, used: 0, has_holes: false, is_torn: false };

/// Pages of a view.
#[derive(Default)]
pub(super) struct Pages {
    slots: Vec<PageSlot>,
    by_key: HashMap<NodeKey, u32>,
    pub textures: Option<PageTextures>,
    /// Number of the present picture.
    picture: u64,
    writer: PageWriter,
    /// Scratch space: class texels of one texture.
    half: Vec<[u8; 4]>,
    /// Whether the pages have only vertices: shadow maps need no more.
    is_bare: bool,
    /// Class that the pages have for cells for which the host gives none.
    default_class: u8,
    /// Whether the pages have colours of dug soil.
    pub has_dug: bool,
    /// Texels written since these pages were created, or since [`Self::begin`] began them anew.
    #[cfg(test)]
    pub texels_written: u64,
}

impl Pages {
    /// Returns pages that have only vertices.
    pub fn of_vertices() -> Self {
        Self { is_bare: true, ..Self::default() }
    }

    /// Begins a picture of a terrain in which cells without a class have the class `default`. Forgets all pages if this
    /// class has changed, or if the terrain has got its first dug soil or lost it.
    pub fn begin(&mut self, terrain: &Terrain, default: u8) {
        self.picture += 1;
        if !self.is_bare && self.has_dug != shows_soil(terrain) {
            *self = Self { has_dug: !self.has_dug, picture: self.picture, ..Self::default() };
        }
        if self.default_class != default {
            self.default_class = default;
            self.forget();
        }
    }

    /// Forgets all pages.
    pub fn forget(&mut self) {
        self.by_key.clear();
        self.slots.iter_mut().for_each(|slot| slot.page = None);
    }

    /// Writes the parts of the pages that depend on changed cells.
    pub fn update(&mut self, device: &Device, terrain: &Terrain, rect: CellRect) {
        for slot in 0..self.slots.len() {
            let Some(page) = self.slots[slot].page else { continue };
            if let Some(part) = PageRect::changed_texels(page, rect) {
                self.write_texels(device, terrain, (slot as u32, page), part);
            }
            // A vertex without ground takes its height from ground up to 2^`FARTHEST_RING` cells away.
            let is_near = self.slots[slot].is_torn && page.rect().meets(rect.grown(1 << FARTHEST_RING)).is_some();
            let vertices = if is_near { Some(PageRect::vertices()) } else { PageRect::changed_vertices(page, rect) };
            if let Some(part) = vertices {
                self.write_vertices(device, terrain, (slot as u32, page), part);
            }
        }
    }

    /// Returns the slot of a page. A page without a slot gets one, and its data are written. `None` if this picture
    /// already uses all slots for other pages.
    fn slot_of(&mut self, device: &Device, terrain: &Terrain, page: NodeKey) -> Option<u32> {
        if let Some(slot) = self.by_key.get(&page) {
            self.slots[*slot as usize].used = self.picture;
            return Some(*slot);
        }
        let oldest = (0..self.slots.len()).min_by_key(|i| (self.slots[*i].page.is_some(), self.slots[*i].used));
        let slot = oldest.filter(|i| self.slots[*i].page.is_none() || self.slots[*i].used < self.picture)?;
        if let Some(before) = self.slots[slot].page {
            self.by_key.remove(&before);
        }
        self.slots[slot] = PageSlot { page: Some(page), used: self.picture, ..EMPTY };
        self.by_key.insert(page, slot as u32);
        self.write_texels(device, terrain, (slot as u32, page), PageRect::texels(page.level));
        self.write_vertices(device, terrain, (slot as u32, page), PageRect::vertices());
        Some(slot as u32)
    }

    /// Writes an instance for each patch, with the slot of its page, and fills pages that have no slot yet. If there
    /// are too few slots, their number is doubled and all pages are written anew. At [`MOST_SLOTS`] the first patch
    /// whose page gets no slot is left out, and with it all later patches.
    pub fn place(
        &mut self,
        device: &Device,
        (terrain, eye): (&Terrain, LandEye),
        patches: &[LandPatch],
        instances: &mut Vec<PatchInstance>,
    ) {
        loop {
            instances.clear();
            let is_complete = patches.iter().all(|patch| {
                let Some(slot) = self.slot_of(device, terrain, patch.page) else { return false };
                let low = patch.low();
                let quarter = (patch.quarter[0] | patch.quarter[1] << 1) as u32;
                let kind = u32::from(patch.page.level) | quarter << 8 | u32::from(self.has_holes(slot)) << 10;
                instances.push(PatchInstance { low: [0, 1].map(|i| low[i] - eye.cell[i]), slot, kind });
                true
            });
            if is_complete || !self.grow(device) {
                return;
            }
        }
    }

    /// Makes room for more pages, and forgets all pages so far. Returns false, and changes nothing, at the largest
    /// number of slots.
    fn grow(&mut self, device: &Device) -> bool {
        let count = (2 * self.slots.len() as u32).clamp(FIRST_SLOTS, MOST_SLOTS);
        if count as usize == self.slots.len() {
            return false;
        }
        self.textures = Some(PageTextures::new(&device.device, count, (!self.is_bare, self.has_dug)));
        self.slots = vec![EMPTY; count as usize];
        self.by_key = HashMap::with_capacity(2 * count as usize);
        true
    }

    /// Whether any texel of a slot has no ground.
    fn has_holes(&self, slot: u32) -> bool {
        self.slots[slot as usize].has_holes
    }

    /// Number of pages that have a texel without ground, and number of pages that have a vertex without ground.
    #[cfg(test)]
    pub fn pages_with_holes(&self) -> [usize; 2] {
        let count = |is: fn(&PageSlot) -> bool| self.slots.iter().filter(|s| s.page.is_some() && is(s)).count();
        [count(|slot| slot.has_holes), count(|slot| slot.is_torn)]
    }

    /// GPU memory, bytes.
    pub fn bytes(&self) -> u64 {
        let [vertices, texels] = [VERTICES, TEXELS].map(|side| u64::from(side.unsigned_abs().pow(2)));
        let bytes_of_texel = match (self.is_bare, self.has_dug) {
            (true, _) => 0,
            (false, false) => 16,
            (false, true) => 20,
        };
        self.slots.len() as u64 * (4 * vertices + bytes_of_texel * texels)
    }

    fn write_vertices(&mut self, device: &Device, terrain: &Terrain, (slot, page): (u32, NodeKey), part: PageRect) {
        let Some(textures) = &self.textures else { return };
        let is_torn = self.writer.write_vertices(&mut CellReader::new(terrain), page, part);
        // An update of a torn page writes all of its vertices, and so finds out whether its holes are filled.
        let was_torn = self.slots[slot as usize].is_torn && part != PageRect::vertices();
        self.slots[slot as usize].is_torn = is_torn || was_torn;
        write(device, &textures.vertices, (slot, VERTICES), part, bytemuck::cast_slice(&self.writer.vertices));
    }

    fn write_texels(&mut self, device: &Device, terrain: &Terrain, (slot, page): (u32, NodeKey), part: PageRect) {
        let Some(textures) = self.textures.as_ref().filter(|_| !self.is_bare) else { return };
        let mut cells = CellReader::new(terrain);
        self.writer.write_texels(&mut cells, page, part, self.default_class);
        let is_holed = self.writer.classes.iter().any(|texel| texel[7] == 0);
        // A page that had holes may still have some outside the part.
        let was_holed = self.slots[slot as usize].has_holes;
        self.slots[slot as usize].has_holes = is_holed || (was_holed && has_holes(&mut cells, page));
        #[cfg(test)]
        {
            self.texels_written += self.writer.slopes.len() as u64;
        }
        write(device, &textures.slopes, (slot, TEXELS), part, bytemuck::cast_slice(&self.writer.slopes));
        for (i, texture) in textures.classes.iter().enumerate() {
            self.half.clear();
            self.half.extend(self.writer.classes.iter().map(|c| [c[4 * i], c[4 * i + 1], c[4 * i + 2], c[4 * i + 3]]));
            write(device, texture, (slot, TEXELS), part, bytemuck::cast_slice(&self.half));
        }
        if self.has_dug {
            write(device, &textures.dug, (slot, TEXELS), part, bytemuck::cast_slice(&self.writer.dug));
        }
    }
}

/// Writes `bytes` to the rectangle `part` of a slot. `side` is the side of the slot, texels.
fn write(device: &Device, texture: &wgpu::Texture, (slot, side): (u32, i32), part: PageRect, bytes: &[u8]) {
    let [width, height] = part.size();
    let corner = [slot % SLOTS_IN_ROW, slot / SLOTS_IN_ROW].map(|v| v * side as u32);
    let origin = wgpu::Origin3d { x: corner[0] + part.low[0] as u32, y: corner[1] + part.low[1] as u32, z: 0 };
    let to = wgpu::TexelCopyTextureInfo { origin, ..texture.as_image_copy() };
    let bytes_per_row = Some((bytes.len() / height as usize) as u32);
    let rows = wgpu::TexelCopyBufferLayout { offset: 0, bytes_per_row, rows_per_image: None };
    device.write_texture(to, bytes, rows, wgpu::Extent3d { width, height, depth_or_array_layers: 1 });
}
