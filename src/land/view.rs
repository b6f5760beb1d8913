//! Drawn terrain in a view: which patches a picture shows, their pages, and the draw.

use glam::{DMat4, DVec3};

use super::{
    eye::LandEye,
    held::HeldLand,
    light::LandLight,
    pages::Pages,
    passes::LandPass,
    relief::Relief,
    selection::{LandFrustum, LandPatch, LevelDistances, select},
    uniforms::{LandPicture, PatchInstance},
};
use crate::{
    error::Result,
    gpu::blocks::Blocks,
    scene::WorldKind,
    stage::{DepthAccess, DrawContext, DrawnEffect, FrameContext, OpaqueDraw, Outputs, Stages},
    terrain::Terrain,
};

/// Farthest place of an eye on the lattice, cells: instances count their cells in whole numbers from the eye.
const FARTHEST_CELL: f64 = 1e9;

/// Drawn terrain of a view.
pub(crate) struct LandView {
    blocks: Blocks,
    relief: Relief,
    pages: Pages,
    patches: Vec<LandPatch>,
    instances: Vec<PatchInstance>,
    /// Whether the host has asked for terrain, and there is some.
    is_there: bool,
    /// Picture of this frame, if terrain is drawn into it.
    picture: Option<LandPicture>,
    pass: Option<LandPass>,
}

impl LandView {
    pub fn new(blocks: &Blocks) -> Self {
        Self {
            blocks: blocks.clone(),
            relief: Relief::default(),
            pages: Pages::default(),
            patches: Vec::new(),
            instances: Vec::new(),
            is_there: false,
            picture: None,
            pass: None,
        }
    }

    /// Texels of slopes and classes that were written to pages so far.
    #[cfg(test)]
    pub fn texels_written(&self) -> u64 {
        self.pages.texels_written
    }

    /// Number of pages that have a texel without ground, and of those that have a vertex without.
    #[cfg(test)]
    pub fn pages_with_holes(&self) -> [usize; 2] {
        self.pages.pages_with_holes()
    }

    /// Selects the patches of a picture and fills their pages.
    fn prepare_picture(&mut self, context: &FrameContext<'_>, terrain: &Terrain, held: &HeldLand) -> Result<()> {
        let (frame, now) = (context.frame, context.now);
        let (Some(drawing), Some(color), Some(bounds)) = (&held.drawing, frame.color, terrain.bounds) else {
            return Ok(());
        };
        let (cells, height_m) = terrain.cells_at(now.eye);
        if !cells.is_finite() || cells.abs().max_element() > FARTHEST_CELL {
            return Ok(());
        }
        let Self { relief, pages, .. } = self;
        pages.begin(terrain, held.surface_class as u8);
        relief.update(terrain, |changed| match changed {
            Some(rect) => pages.update(context.device, terrain, rect),
            None => pages.forget(),
        });
        let (cell_m, height_px) = (terrain.desc.cell_m, f64::from(color.height()));
        let sizes = (height_px, drawing.error_px);
        let mut detail = LevelDistances::new(relief, &frame.camera, (cells, height_m), cell_m, sizes);
        let to_eye = DMat4::from_mat3(frame.camera.rotation() * terrain.to_enu.transpose());
        let eye = LandEye::new(DVec3::new(cells.x, cells.y, height_m));
        let frustum = LandFrustum::new(frame.camera.projection * to_eye, eye.place, cell_m);
        select(&self.relief, &mut detail, &frustum, &mut self.patches);
        self.fill_pages(context, terrain, eye);
        let curvature = match now.weather.world.kind {
            WorldKind::Flat => 0.0,
            WorldKind::Tangent | WorldKind::Ecef => 1.0 / (now.planet_radius_m + now.scene.place.altitude_m),
        };
        self.picture = Some(LandPicture {
            eye,
            detail,
            cell_m,
            to_local: now.scene.world_to_enu * terrain.to_enu.transpose(),
            curvature,
            altitude_m: terrain.altitude_m,
            has_dug: self.pages.has_dug,
            light: LandLight::below(context, terrain, bounds, eye)?,
        });
        Ok(())
    }

    /// Finds the slot of each patch's page, and fills pages that are not there yet.
    fn fill_pages(&mut self, context: &FrameContext<'_>, terrain: &Terrain, eye: LandEye) {
        loop {
            self.instances.clear();
            let is_complete = self.patches.iter().all(|patch| {
                let Some(slot) = self.pages.slot_of(context.device, terrain, patch.page) else { return false };
                let low = patch.low();
                let quarter = (patch.quarter[0] | patch.quarter[1] << 1) as u32;
                let kind = u32::from(patch.page.level) | quarter << 8 | u32::from(self.pages.has_holes(slot)) << 10;
                self.instances.push(PatchInstance { low: [0, 1].map(|i| low[i] - eye.cell[i]), slot, kind });
                true
            });
            if is_complete || !self.pages.grow(context.device) {
                return;
            }
        }
    }
}

impl DrawnEffect for LandView {
    fn gather(&mut self, context: &FrameContext<'_>, _given: &mut Outputs) -> Result<()> {
        self.picture = None;
        let held = context.held.of::<HeldLand>()?;
        let terrain = context.world.set.tiles.as_deref().filter(|_| held.drawing.is_some());
        self.is_there = terrain.is_some_and(|terrain| terrain.bounds.is_some());
        let Some(terrain) = terrain else { return Ok(()) };
        let is_drawn = context.asked.has(Stages::SURFACE) && context.frame.depth_access == DepthAccess::ReadWrite;
        if is_drawn { self.prepare_picture(context, terrain, held) } else { Ok(()) }
    }

    fn stages(&self) -> Stages {
        Stages(0)
    }

    fn has_opaque(&self) -> bool {
        self.is_there
    }

    fn draw_opaque(
        &mut self,
        context: &DrawContext<'_>,
        opaque: &OpaqueDraw<'_>,
        pass: &mut wgpu::RenderPass<'_>,
    ) -> Result<()> {
        let (Some(picture), Some(pages)) = (&self.picture, &self.pages.textures) else { return Ok(()) };
        if self.instances.is_empty() {
            return Ok(());
        }
        let block = picture.uniform(opaque.clip, self.relief.top());
        let own = self.pass.get_or_insert_with(|| LandPass::new(context.device, &self.blocks));
        own.draw(context.device, opaque, pages, (&block, &self.instances), pass)
    }

    fn bytes(&self) -> u64 {
        self.pages.bytes() + self.pass.as_ref().map_or(0, LandPass::bytes)
    }
}
