//! The uniform blocks of a view, side by side in a buffer: however many of them a call changes, one write brings them
//! to the GPU.
//!
//! wgpu makes a staging buffer for every write; five of them cost as much of the CPU as two empty passes.

use std::{
    ops::{Deref, Range},
    sync::{Arc, Mutex, PoisonError},
};

use super::Device;

/// Bytes of a page, in which blocks lie side by side; a larger block has a page to itself.
const PAGE: usize = 32 << 10;
/// Bytes by which changes are told.
const CHUNK: usize = 64;

/// The pages of a view.
#[derive(Clone)]
pub(crate) struct Blocks(Arc<Mutex<Vec<Page>>>);

/// A buffer, and what it is to hold.
struct Page {
    buffer: wgpu::Buffer,
    staged: Vec<u8>,
    /// Bytes of it that have not been uploaded.
    changed: Range<usize>,
    /// The last first.
    taken: Vec<Range<usize>>,
}

/// One of them; its place is free again when it is dropped.
pub(crate) struct UniformBlock {
    pages: Blocks,
    page: usize,
    view: BlockView,
}

/// Where one lies, for bind groups.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct BlockView {
    buffer: wgpu::Buffer,
    at: Range<usize>,
}

impl Page {
    fn new(device: &wgpu::Device, bytes: usize) -> Self {
        let buffer = super::bind::block(device, "blocks", bytes);
        Self { buffer, staged: vec![0; bytes], changed: 0..0, taken: Vec::new() }
    }

    /// The last place of so many bytes at a multiple of `step`, taken. So the first block, which every frame writes,
    /// lies at the end, and no write spans the tables at its end that do not change.
    fn take(&mut self, bytes: usize, step: usize) -> Option<Range<usize>> {
        let ends = std::iter::once(self.staged.len()).chain(self.taken.iter().map(|taken| taken.start));
        let starts = ends.map(|end| end.checked_sub(bytes).map(|start| start - start % step));
        let is_free = |i: usize, start: usize| self.taken.get(i).is_none_or(|next| next.end <= start);
        let (i, start) = starts.enumerate().find_map(|(i, start)| Some((i, start.filter(|s| is_free(i, *s))?)))?;
        self.taken.insert(i, start..start + bytes);
        Some(start..start + bytes)
    }

    fn write(&mut self, offset: usize, bytes: &[u8]) {
        let staged = &mut self.staged[offset..offset + bytes.len()];
        let chunks = || staged.chunks(CHUNK).zip(bytes.chunks(CHUNK));
        let differs = |(old, new): (&[u8], &[u8])| old != new;
        let (Some(first), Some(last)) = (chunks().position(differs), chunks().rposition(differs)) else { return };
        let range = offset + first * CHUNK..offset + ((last + 1) * CHUNK).min(bytes.len());
        staged.copy_from_slice(bytes);
        let changed = &mut self.changed;
        *changed = if changed.start == changed.end {
            range
        } else {
            changed.start.min(range.start)..changed.end.max(range.end)
        };
    }
}

impl Blocks {
    pub fn new() -> Self {
        Self(Arc::new(Mutex::new(Vec::new())))
    }

    /// Room for a block of so many bytes, a multiple of 4, all 0.
    pub fn block(&self, device: &Device, bytes: usize) -> UniformBlock {
        let step = device.device.limits().min_uniform_buffer_offset_alignment as usize;
        let (page, at, buffer) = self.with(|pages| {
            let found = pages.iter_mut().enumerate().find_map(|(i, page)| Some((i, page.take(bytes, step)?)));
            let (i, at) = found.unwrap_or_else(|| {
                let mut page = Page::new(&device.device, bytes.max(PAGE));
                let at = page.take(bytes, step).unwrap_or(0..bytes);
                pages.push(page);
                (pages.len() - 1, at)
            });
            pages[i].write(at.start, &vec![0; bytes]);
            (i, at, pages[i].buffer.clone())
        });
        UniformBlock { pages: self.clone(), page, view: BlockView { buffer, at } }
    }

    /// Brings up what was written since the last time: before every submission of what reads it.
    pub fn upload(&self, queue: &wgpu::Queue) {
        self.with(|pages| {
            for page in pages.iter_mut().filter(|page| !page.changed.is_empty()) {
                let changed = std::mem::take(&mut page.changed);
                queue.write_buffer(&page.buffer, changed.start as u64, &page.staged[changed]);
            }
        });
    }

    /// Bytes of GPU memory.
    pub fn bytes(&self) -> u64 {
        self.with(|pages| pages.iter().map(|page| page.staged.len() as u64).sum())
    }

    fn with<T>(&self, f: impl FnOnce(&mut Vec<Page>) -> T) -> T {
        f(&mut self.0.lock().unwrap_or_else(PoisonError::into_inner))
    }
}

impl UniformBlock {
    /// Sets its contents from the next [`Blocks::upload`] on; what lies behind `bytes` stays.
    pub fn write(&self, bytes: &[u8]) {
        self.write_at(0, bytes);
    }

    /// Writes as [`Self::write`] does, from byte `offset`.
    pub fn write_at(&self, offset: usize, bytes: &[u8]) {
        debug_assert!(offset + bytes.len() <= self.bytes(), "{} bytes at {offset} of {}", bytes.len(), self.bytes());
        self.pages.with(|pages| pages[self.page].write(self.at.start + offset, bytes));
    }
}

impl Deref for UniformBlock {
    type Target = BlockView;

    fn deref(&self) -> &BlockView {
        &self.view
    }
}

impl Drop for UniformBlock {
    fn drop(&mut self) {
        self.pages.with(|pages| pages[self.page].taken.retain(|taken| *taken != self.view.at));
    }
}

impl BlockView {
    /// All of it at a binding.
    pub fn entry(&self, binding: u32) -> wgpu::BindGroupEntry<'_> {
        self.part(binding, 0, self.bytes())
    }

    /// A part of it at a binding, from a multiple of 256 on.
    pub fn part(&self, binding: u32, offset: usize, bytes: usize) -> wgpu::BindGroupEntry<'_> {
        wgpu::BindGroupEntry { binding, resource: wgpu::BindingResource::Buffer(self.range(offset, bytes)) }
    }

    /// A part of it.
    pub fn range(&self, offset: usize, bytes: usize) -> wgpu::BufferBinding<'_> {
        let offset = (self.at.start + offset) as u64;
        wgpu::BufferBinding { buffer: &self.buffer, offset, size: wgpu::BufferSize::new(bytes as u64) }
    }

    /// Its size.
    pub fn bytes(&self) -> usize {
        self.at.len()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::gpu::DeviceOptions;

    fn noop() -> Arc<Device> {
        Device::headless(&DeviceOptions { backends: wgpu::Backends::NOOP, ..Default::default() }).unwrap()
    }

    #[test]
    fn blocks_do_not_overlap_and_give_their_place_back() {
        let (device, blocks) = (noop(), Blocks::new());
        let step = device.device.limits().min_uniform_buffer_offset_alignment as usize;
        let sizes = [64, 1024, 300, 2 * PAGE, 16];
        let mut held: Vec<_> = sizes.iter().map(|bytes| blocks.block(&device, *bytes)).collect();
        let is_sound = |held: &[UniformBlock]| {
            held.iter().enumerate().all(|(i, a)| {
                let is_apart =
                    |b: &UniformBlock| a.buffer != b.buffer || a.at.end <= b.at.start || b.at.end <= a.at.start;
                a.at.start % step == 0 && a.at.end as u64 <= a.buffer.size() && held[..i].iter().all(is_apart)
            })
        };
        assert!(is_sound(&held));
        let (bytes, free) = (blocks.bytes(), held.remove(1).at.end);
        held.push(blocks.block(&device, 1000));
        assert!(free - held[4].at.end < step, "the place that is free");
        assert!(is_sound(&held));
        assert_eq!(blocks.bytes(), bytes);
        // Until there is no more room.
        while blocks.bytes() == bytes {
            held.push(blocks.block(&device, 4096));
        }
        assert!(is_sound(&held));
        assert!(held.len() >= 5 + (PAGE - 4096) / 4096, "{} blocks", held.len());
    }

    #[test]
    fn what_changes_comes_up_once() {
        let (device, blocks) = (noop(), Blocks::new());
        let [a, b] = [8 * CHUNK, 12].map(|bytes| blocks.block(&device, bytes));
        let changed = || blocks.with(|pages| pages[0].changed.clone());
        let held = |block: &UniformBlock| blocks.with(|pages| pages[0].staged[block.at.clone()].to_vec());
        let mut bytes = vec![0; 8 * CHUNK];
        bytes[3 * CHUNK + 5] = 1;
        a.write(&bytes);
        assert_eq!(changed(), a.at.start + 3 * CHUNK..a.at.start + 4 * CHUNK);
        b.write_at(4, &[2; 4]);
        assert_eq!(changed(), b.at.start + 4..a.at.start + 4 * CHUNK);
        blocks.upload(&device.queue);
        a.write(&bytes);
        b.write_at(4, &[2; 4]);
        assert_eq!(changed(), 0..0, "nothing has changed");
        assert_eq!((held(&a), held(&b)), (bytes, vec![0, 0, 0, 0, 2, 2, 2, 2, 0, 0, 0, 0]));
        let at = b.at.clone();
        drop(b);
        let c = blocks.block(&device, 12);
        assert_eq!((&c.at, held(&c)), (&at, vec![0; 12]), "nothing is left of who had the place before");
        assert_eq!(changed(), at);
    }
}
