//! Cache of the targets that a host uses again and again. Each is built once. Its use begins when the target is first
//! requested after the host was entered, and ends when the host is left.

use std::sync::Arc;

use super::{
    build::TargetBuilder,
    check::GlInfo,
    host::{Inner, Sharing},
    image::{Ask, GlImage},
    names::*,
    target::{Entry, GlTarget, GlTargetDesc},
    window::WindowSize,
};
use crate::error::{Error, Result, Status};

/// Number of cached targets from which on a new one replaces the least recently used one that is not in use. If all are
/// in use, none is dropped.
const CACHED_TARGETS: usize = 32;

impl Inner {
    /// Finds or builds the target of `desc`, and begins its use. If the target is in use already, copies again the
    /// images of it that are only read.
    pub(super) fn target(
        &mut self,
        info: &GlInfo,
        device: &wgpu::Device,
        desc: &GlTargetDesc,
    ) -> Result<Arc<GlTarget>> {
        self.refuse_foreign_framebuffers(desc)?;
        if let Some(i) = self.targets.iter().position(|e| same_objects(&e.desc, desc)) {
            let entry = &self.targets[i];
            let known = entry.desc.generation;
            if desc.generation < known {
                let accepted = format!("at least {known}: it rises with every object made anew, and these were there");
                return Err(Error::range("target.generation", &accepted, desc.generation));
            }
            let begun = self.active.contains(&entry.target.id);
            if begun && entry.desc == *desc {
                entry.refresh(&self.api)?;
                return Ok(entry.target.clone());
            }
            let fresh = entry.desc == *desc && entry.is_current(self.ask(info))?;
            if fresh {
                if let Err(e) = self.check_window(info, desc, false) {
                    self.drop_target(i);
                    return Err(e);
                }
                self.next_id += 1;
                self.targets[i].used = self.next_id;
                return self.begin_target(i);
            }
            self.drop_target(i);
        }
        if self.targets.len() >= CACHED_TARGETS {
            let active = &self.active;
            let oldest = (0..self.targets.len())
                .filter(|i| !active.contains(&self.targets[*i].target.id))
                .min_by_key(|i| self.targets[*i].used);
            if let Some(i) = oldest {
                self.drop_target(i);
            }
        }
        self.next_id += 1;
        self.check_window(info, desc, true)?;
        let entry = TargetBuilder { ask: self.ask(info), device, tier0: self.tier0 }.build(*desc, self.next_id)?;
        self.targets.push(entry);
        self.begin_target(self.targets.len() - 1)
    }

    /// Returns the target in use whose colour texture is `color`.
    pub(super) fn entry_of(&self, color: &wgpu::Texture) -> Option<&Entry> {
        self.targets.iter().find(|e| e.target.color == *color && self.active.contains(&e.target.id))
    }

    /// Returns the target in use whose depth is read as `depth`.
    pub(super) fn entry_with_depth(&self, depth: &wgpu::Texture) -> Option<&Entry> {
        let is_it = |e: &&Entry| e.target.depth_read.as_ref() == Some(depth) && self.active.contains(&e.target.id);
        self.targets.iter().find(is_it)
    }

    /// Checks that the host's window, if it is the target, has the size that the host gives. For a `new` target the
    /// check waits for the GPU; otherwise it uses the result of an earlier frame.
    fn check_window(&mut self, info: &GlInfo, desc: &GlTargetDesc, new: bool) -> Result<()> {
        if desc.color != (GlImage::Framebuffer { name: 0 }) || desc.width == 0 || desc.height == 0 {
            return Ok(());
        }
        // Without a window there is nothing to check.
        self.api.BindFramebuffer(FRAMEBUFFER, 0);
        if self.api.CheckFramebufferStatus(DRAW_FRAMEBUFFER) != FRAMEBUFFER_COMPLETE {
            return Ok(());
        }
        let window = self.window.get_or_insert_with(|| WindowSize::new(&self.api, info));
        self.api.BindVertexArray(self.backend.vertex_array);
        // For a new target, the result of a pending query is discarded: that query may be about another size.
        let before = window.check(&self.api, new);
        if !new {
            before?;
        }
        window.ask(&self.api, (desc.width, desc.height));
        if new { window.check(&self.api, true) } else { Ok(()) }
    }

    /// Returns the inputs of queries about images, for the context in which Welkin draws.
    fn ask<'a>(&'a self, info: &'a GlInfo) -> Ask<'a> {
        let encodes = match &self.sharing {
            Sharing::HostContext { state, .. } => info.is_es() || state.was_on(FRAMEBUFFER_SRGB),
            Sharing::Shared { .. } => true,
        };
        Ask { api: &self.api, info, scratch: self.scratch, encodes }
    }

    /// Ends the use of `entry` if it is in use. An error is kept for the next call that can return it.
    pub(super) fn end_of(&mut self, entry: &Entry) {
        if let Some(at) = self.active.iter().position(|id| *id == entry.target.id) {
            self.active.swap_remove(at);
            if let Err(e) = entry.end(&self.api) {
                self.fault.get_or_insert(e);
            }
        }
    }

    /// Begins the use of target number `i`; drops it if that fails.
    fn begin_target(&mut self, i: usize) -> Result<Arc<GlTarget>> {
        let entry = &mut self.targets[i];
        if let Err(e) = entry.begin(&self.api) {
            self.drop_target(i);
            return Err(e);
        }
        self.active.push(entry.target.id);
        Ok(entry.target.clone())
    }

    /// Ends the use of target number `i`, and deletes Welkin's objects for it.
    fn drop_target(&mut self, i: usize) {
        let mut entry = self.targets.swap_remove(i);
        self.end_of(&entry);
        entry.made.delete(&self.api);
    }

    /// Checks that no framebuffer is named in shared mode: framebuffers belong to one context, so the name would mean
    /// nothing.
    fn refuse_foreign_framebuffers(&self, desc: &GlTargetDesc) -> Result<()> {
        let foreign = matches!(self.sharing, Sharing::Shared { .. })
            && [Some(desc.color), desc.depth].into_iter().flatten().any(|i| matches!(i, GlImage::Framebuffer { .. }));
        if foreign {
            let rest = "must be a texture or renderbuffer in a shared context: framebuffers, the window's included, are \
                        not shared; make the device in the host's own context for those";
            return Err(Error::about(Status::Unsupported, "target.color", rest));
        }
        Ok(())
    }
}

/// Whether two descriptions name the same images, with the same treatment of samples. Size, generation and
/// `write_depth` may differ.
fn same_objects(a: &GlTargetDesc, b: &GlTargetDesc) -> bool {
    let images = |d: &GlTargetDesc| (d.color, d.depth, d.mask, d.surface_classes, d.normals, d.multisample);
    images(a) == images(b)
}
