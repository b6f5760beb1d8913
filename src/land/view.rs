//! Drawn terrain in a view: which patches a picture shows, their pages, the shadow maps, and the draw.

use glam::{DMat4, DVec3};

use super::{
    eye::LandEye,
    held::HeldLand,
    light::LandLight,
    pages::Pages,
    passes::LandPass,
    relief::Relief,
    selection::{LandFrustum, LandPatch, LevelDistances, select},
    shadow::Shadows,
    uniforms::{LandPicture, LandUniform, PatchInstance},
};
use crate::{
    error::Result,
    gpu::blocks::Blocks,
    scene::WorldKind,
    stage::{DepthAccess, DrawContext, DrawnEffect, FrameContext, OpaqueDraw, Outputs, Recording, Stages},
    terrain::Terrain,
};

/// Largest coordinate of the eye on the lattice, cells, at which terrain is drawn: instances count cells from the eye
/// in 32-bit whole numbers.
const FARTHEST_CELL: f64 = 1e9;

/// Drawn terrain of a view.
pub(crate) struct LandView {
    blocks: Blocks,
    relief: Relief,
    pages: Pages,
    shadows: Shadows,
    patches: Vec<LandPatch>,
    instances: Vec<PatchInstance>,
    /// Whether the host has asked for drawn terrain and has set tiles.
    is_there: bool,
    /// Picture of this frame, if terrain is drawn into it.
    picture: Option<LandPicture>,
    pass: Option<LandPass>,
    /// Whether sun and moon do not shine on the ground.
    #[cfg(test)]
    pub is_dark: bool,
}

impl LandView {
    pub fn new(blocks: &Blocks) -> Self {
        Self {
            blocks: blocks.clone(),
            relief: Relief::default(),
            pages: Pages::default(),
            shadows: Shadows::new(blocks),
            patches: Vec::new(),
            instances: Vec::new(),
            is_there: false,
            picture: None,
            pass: None,
            #[cfg(test)]
            is_dark: false,
        }
    }

    /// Texels of slopes and classes that were written to pages so far.
    #[cfg(test)]
    pub fn texels_written(&self) -> u64 {
        self.pages.texels_written
    }

    /// Shadow maps drawn so far.
    #[cfg(test)]
    pub fn maps_drawn(&self) -> u64 {
        self.shadows.maps_drawn
    }

    /// Side of the texels, m, of the finest shadow map that contains `place` in the last picture, and of the next
    /// coarser map. `place` is relative to the eye, m along the lattice's axes.
    #[cfg(test)]
    pub fn shadow_texels_m(&self, place: DVec3) -> Option<[f64; 2]> {
        self.shadows.texels_m(&self.shadows.uniform(self.picture.as_ref()?), place)
    }

    /// Number of pages that have a texel without ground, and number of pages that have a vertex without ground.
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
        let Self { relief, pages, shadows, .. } = self;
        pages.begin(terrain, held.surface_class as u8);
        relief.update(terrain, |changed| {
            match changed {
                Some(rect) => pages.update(context.device, terrain, rect),
                None => pages.forget(),
            }
            shadows.change(context.device, terrain, changed);
        });
        let (cell_m, height_px) = (terrain.desc.cell_m, f64::from(color.height()));
        let sizes = (height_px, drawing.error_px);
        let mut detail = LevelDistances::new(relief, &frame.camera, (cells, height_m), cell_m, sizes);
        let to_eye = DMat4::from_mat3(frame.camera.rotation() * terrain.to_enu.transpose());
        let eye = LandEye::new(DVec3::new(cells.x, cells.y, height_m));
        let frustum = LandFrustum::new(frame.camera.projection * to_eye, eye.place, cell_m);
        select(&self.relief, &mut detail, &frustum, &mut self.patches);
        self.pages.place(context.device, (terrain, eye), &self.patches, &mut self.instances);
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
            shadows_to_m: drawing.shadows_to_m,
        });
        Ok(())
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

    fn prepare_opaque(&mut self, context: &FrameContext<'_>, recording: &mut Recording<'_>) -> Result<()> {
        let (Some(picture), Some(color)) = (&self.picture, context.frame.color) else { return Ok(()) };
        let Some(terrain) = context.world.set.tiles.as_deref() else { return Ok(()) };
        if picture.shadows_to_m == 0.0 {
            self.shadows.forget();
            return Ok(());
        }
        self.shadows.draw(picture, (terrain, &self.relief), color.height(), recording)
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
        let block =
            LandUniform { shadow: self.shadows.uniform(picture), ..picture.uniform(opaque.clip, self.relief.top()) };
        #[cfg(test)]
        let block = if self.is_dark { LandUniform { sun_lux: [0.0; 4], moon_lux: [0.0; 4], ..block } } else { block };
        let own = self.pass.get_or_insert_with(|| LandPass::new(context.device, &self.blocks));
        own.draw(context.device, opaque, (pages, self.shadows.maps()), (&block, &self.instances), pass)
    }

    fn bytes(&self) -> u64 {
        self.pages.bytes() + self.shadows.bytes() + self.pass.as_ref().map_or(0, LandPass::bytes)
    }
}
