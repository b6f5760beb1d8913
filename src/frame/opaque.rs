//! Opaque step: the effects draw into the host's colour and depth, in one pass before the composition. There is no pass
//! if no effect has anything opaque.

use super::{opaque_step::OpaqueStep, view::View};
use crate::{
    effects::PARTS,
    error::{Error, Result},
    gpu::Layer,
    stage::{
        CostItem, DepthAccess, DrawContext, DrawTarget, Frame, FrameContext, LightLookup, OpaqueDraw, OpaqueTarget,
        PlannedShares, Recording, Stages, check_written, uniform,
    },
};

impl View {
    /// Whether an effect has anything opaque to draw in these stages.
    pub(super) fn has_opaque(&self, stages: Stages) -> bool {
        stages.has(Stages::SURFACE) && self.effects.all().iter().any(|effect| effect.has_opaque())
    }

    /// Checks that depth can be written if the host lets Welkin write it, even if there is nothing to draw now.
    pub(super) fn check_depth_access(&self, frame: &Frame<'_>, color: &wgpu::Texture) -> Result<()> {
        match (frame.depth_access, frame.depth) {
            (DepthAccess::Read, _) => Ok(()),
            (DepthAccess::ReadWrite, None) => {
                Err(Error::invalid("depth_access", "must be read only where the frame has no depth"))
            }
            (DepthAccess::ReadWrite, Some(depth)) => check_written(&self.device.attached_depth(depth).texture, color),
        }
    }

    /// Checks that shaders read the written depth itself, not a copy of it. Such a copy is refreshed between two
    /// submissions, which Welkin cannot do where the host submits.
    pub(super) fn check_depth_is_one(&self, frame: &Frame<'_>) -> Result<()> {
        let written = frame.depth.filter(|_| frame.depth_access == DepthAccess::ReadWrite);
        if written.is_some_and(|depth| self.device.attached_depth(depth).is_copied) {
            let what =
                "a renderbuffer that is written where the host submits: it is copied between submissions; use record";
            return Err(Error::unsupported(what).within("depth"));
        }
        Ok(())
    }

    /// Draws the textures that the opaque geometry of the effects reads.
    fn prepare_opaque(&mut self, context: &FrameContext<'_>, recording: &mut Recording<'_>) -> Result<()> {
        let mut drawn = self.effects.each().into_iter().filter(|effect| effect.has_opaque());
        drawn.try_for_each(|effect| effect.prepare_opaque(context, recording))
    }

    /// Draws the opaque geometry of the effects. If the host's depth is read-only or absent, draws nothing and reports
    /// the number of effects with opaque geometry.
    pub(super) fn draw_opaque<'a>(
        &mut self,
        frame_context: &FrameContext<'a>,
        target: DrawTarget<'a>,
        recording: &mut Recording<'_>,
    ) -> Result<()> {
        let (frame, color) = (frame_context.frame, target.color);
        let (DepthAccess::ReadWrite, Some(read)) = (frame.depth_access, frame.depth) else {
            self.history.report.opaque_left_out = self.effects.all().iter().filter(|e| e.has_opaque()).count() as u32;
            return Ok(());
        };
        self.prepare_opaque(frame_context, recording)?;
        let attached = self.device.attached_depth(read);
        let depth = Layer { texture: &attached.texture, index: frame.layers.depth };
        let block = uniform(frame, frame_context.now, target.rays, color.texture, target.exposure, false);
        self.cache.uniform.write(&block, None);
        let step = self.cache.opaque.get_or_insert_with(|| OpaqueStep::new(&self.device.device));
        let layout = step.layout.clone();
        let (bound, color_view) = step.bind(&self.device, &self.cache.uniform, [color, depth], frame.mask_layer());
        let keep = wgpu::Operations { load: wgpu::LoadOp::Load, store: wgpu::StoreOp::Store };
        let mut pass = recording.encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some("opaque"),
            color_attachments: &[Some(wgpu::RenderPassColorAttachment {
                view: color_view,
                depth_slice: None,
                resolve_target: None,
                ops: keep,
            })],
            depth_stencil_attachment: Some(wgpu::RenderPassDepthStencilAttachment {
                view: &bound.depth_view,
                depth_ops: Some(wgpu::Operations { load: wgpu::LoadOp::Load, store: wgpu::StoreOp::Store }),
                stencil_ops: None,
            }),
            ..Default::default()
        });
        pass.set_bind_group(0, &bound.group, &[]);
        let plan = PlannedShares::whole(PARTS);
        let context = DrawContext {
            device: frame_context.device,
            frame,
            now: frame_context.now,
            target,
            stages: Stages::SURFACE,
            plan,
        };
        let target = OpaqueTarget::of(frame, color.texture, depth.texture);
        let (tables_layout, tables_group, constants) = self.effects.light_tables();
        let tables = LightLookup { layout: &tables_layout, group: &tables_group, constants };
        let opaque = OpaqueDraw { target, layout: &layout, tables, clip: OpaqueDraw::clip_of(&context) };
        for effect in self.effects.each().into_iter().filter(|effect| effect.has_opaque()) {
            effect.draw_opaque(&context, &opaque, &mut pass)?;
        }
        drop(pass);
        recording.passes += 1;
        if attached.is_copied {
            recording.flush();
            self.device.refresh_depth(read)?;
        }
        recording.ends(CostItem::Surface, true)
    }
}
