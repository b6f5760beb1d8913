//! Resources of a view for the host's picture: the copy that shaders read, and the bind group of the host's textures.

use super::{
    bound::Bound,
    environment_map::EnvironmentMap,
    froxels::Froxels,
    pixels::{even::CoarseWeather, kinds::KindAttachment},
    view::View,
};
use crate::{
    error::Result,
    gpu::{Layer, is_kept},
    stage::{Composition, DrawContext, Recording, can_copy, color_copy, is_copy_of},
};

impl View {
    /// Returns the size of the view's own GPU memory, bytes.
    pub(super) fn bytes(&self) -> u64 {
        let copy = self.cache.copy.as_ref().map_or(0, |c| {
            let texel = u64::from(c.format().block_copy_size(None).unwrap_or(4));
            texel * u64::from(c.width()) * u64::from(c.height()) * u64::from(c.sample_count())
        });
        let effects: u64 = self.effects.all().iter().map(|effect| effect.bytes()).sum();
        let kinds = self.cache.kinds.as_ref().map_or(0, KindAttachment::bytes)
            + self.cache.even.as_ref().map_or(0, CoarseWeather::bytes);
        let environment = self.cache.environment.as_deref().map_or(0, EnvironmentMap::bytes);
        copy + kinds
            + environment
            + self.cache.blocks.bytes()
            + self.cache.froxels.as_ref().map_or(0, Froxels::bytes)
            + effects
    }

    /// Replaces the colour copy if it does not fit the host's colour: by a new one, or, for a colour that wgpu cannot
    /// copy, by the texture from which the device reads that colour. Returns whether the copy was replaced.
    pub(super) fn hold_copy(&mut self, color: &wgpu::Texture) -> Result<bool> {
        let reading = if can_copy(color) { None } else { Some(self.reading(color)?) };
        let fits = self.cache.copy.as_ref().is_some_and(|c| match &reading {
            Some(reading) => c == reading,
            None => is_copy_of(c, color),
        });
        if !fits {
            // The bind group refers to the old copy.
            self.cache.bound = None;
            self.cache.copy = Some(reading.unwrap_or_else(|| color_copy(&self.device.device, color)));
            self.history.report.bytes = self.bytes();
        }
        Ok(!fits)
    }

    /// Makes the attachment for kinds of pixels (`kinds`) and the coarse grid (`even`) fit the picture. If they have
    /// another size, both are dropped and created again together. A picture with a side below 64 pixels has no grid.
    /// For a multisampled picture both are dropped, and none is created.
    pub(super) fn hold_kinds(&mut self, color: &wgpu::Texture) -> Result<()> {
        let apart = color.sample_count() == 1;
        if self.cache.kinds.as_ref().is_some_and(|kinds| !apart || !kinds.fits(color)) {
            self.cache.kinds = None;
        }
        if self.cache.even.as_ref().is_some_and(|even| !apart || !even.fits(color)) {
            self.cache.even = None;
        }
        if apart && self.cache.kinds.is_none() {
            self.cache.kinds = Some(KindAttachment::new(&self.device.device, color.size()));
            self.cache.even = CoarseWeather::new(&self.device, &self.cache.composite.lock()?.even, color);
        }
        Ok(())
    }

    /// Copies the picture, with everything recorded so far, to the colour copy.
    pub(super) fn take_picture(&mut self, color: Layer<'_>, recording: &mut Recording<'_>) -> Result<()> {
        self.hold_copy(color.texture)?;
        if !can_copy(color.texture) {
            recording.flush();
            return self.device.refresh(color.texture);
        }
        if let Some(copy) = &self.cache.copy {
            color.copy(recording.encoder, copy);
        }
        Ok(())
    }

    /// Brings the bind group up to date. If a texture of the host has changed, creates the group anew. If only textures
    /// of the effects have changed, swaps the group with the previous one if that one has the new textures, because
    /// effects may draw into two textures alternately. Otherwise creates a group, and keeps the last one for such a
    /// swap.
    pub(super) fn bind(&mut self, context: &DrawContext<'_>, composition: &Composition) -> Result<()> {
        let (frame, own) = (context.frame, composition.textures());
        let of_host = |b: &Bound| {
            is_kept(frame.depth_layer(), b.depth.as_ref())
                && is_kept(frame.mask_layer(), b.mask.as_ref())
                && is_kept(frame.classes_layer(), b.surface_classes.as_ref())
                && is_kept(frame.normals_layer(), b.normals.as_ref())
        };
        let mut before = None;
        if let Some((bound, group)) = self.cache.bound.as_mut().filter(|(b, _)| of_host(b)) {
            if bound.own == *own {
                return Ok(());
            }
            let last = (std::mem::replace(&mut bound.own, own.clone()), group.clone());
            match bound.before.replace(last) {
                Some((known, made)) if known == *own => {
                    *group = made;
                    return Ok(());
                }
                _ => before = bound.before.take(),
            }
        }
        self.cache.bound = None;
        let Some(copy) = &self.cache.copy else { return Ok(()) };
        let made = self.cache.composite.lock()?.bind(&self.device, &self.cache.uniform, copy, frame, composition);
        let Some(group) = made else { return Ok(()) };
        let kept = |layer: Option<Layer<'_>>| layer.map(Layer::kept);
        let bound = Bound {
            depth: kept(frame.depth_layer()),
            mask: kept(frame.mask_layer()),
            surface_classes: kept(frame.classes_layer()),
            normals: kept(frame.normals_layer()),
            own: own.clone(),
            before,
        };
        self.cache.bound = Some((bound, group));
        Ok(())
    }
}
