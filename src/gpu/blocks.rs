//! Uniform blocks of a view, side by side in a few buffers, the pages. One write for each page uploads all blocks that
//! a call has changed.
//!
//! wgpu creates a staging buffer for every write. Five writes take as much CPU time as two empty passes.

use std::{
    ops::{Deref, Range},
    sync::{Arc, Mutex, PoisonError},
};

use super::Device;

/// Size of a page in bytes. A page holds several blocks; a larger block has a page of its own.
const PAGE: usize = 32 << 10;
/// Granularity in bytes with which changes are tracked.
const CHUNK: usize = 64;

/// Pages of a view's uniform blocks.
#[derive(Clone)]
pub(crate) struct Blocks(Arc<Mutex<Vec<Page>>>);

/// A GPU buffer, and its contents on the CPU.
struct Page {
    buffer: wgpu::Buffer,
    staged: Vec<u8>,
    /// Range of `staged` that is not yet uploaded.
    changed: Range<usize>,
    /// Ranges in use, ordered from the end of the page to its beginning.
    taken: Vec<Range<usize>>,
}

/// A uniform block in a page. Dropping the block frees its range.
pub(crate) struct UniformBlock {
    pages: Blocks,
    page: usize,
    view: BlockView,
}

/// Buffer and range of a block, for bind groups.
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

    /// Takes the last free range of this many bytes that begins at a multiple of `step`. The first block taken
    /// therefore lies at the end of the page. It is the frame's own block. Each frame writes the beginning of this
    /// block, and the tables at its end rarely change. The changed range of a page thus ends before these tables.
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

    /// Allocates a block of this many bytes (a multiple of 4), all 0.
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

    /// Uploads what was written since the last upload. Must be called before every submission that reads the blocks.
    pub fn upload(&self, device: &Device) {
        self.with(|pages| {
            for page in pages.iter_mut().filter(|page| !page.changed.is_empty()) {
                let changed = std::mem::take(&mut page.changed);
                device.write_buffer(&page.buffer, changed.start as u64, &page.staged[changed]);
            }
        });
    }

    /// Size of all pages in GPU memory, bytes.
    pub fn bytes(&self) -> u64 {
        self.with(|pages| pages.iter().map(|page| page.staged.len() as u64).sum())
    }

    fn with<T>(&self, f: impl FnOnce(&mut Vec<Page>) -> T) -> T {
        f(&mut self.0.lock().unwrap_or_else(PoisonError::into_inner))
    }
}

impl UniformBlock {
    /// Writes `bytes` to the start of the block; the rest keeps its contents. The next [`Blocks::upload`] uploads the
    /// change.
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
    /// Entry that binds the whole block.
    pub fn entry(&self, binding: u32) -> wgpu::BindGroupEntry<'_> {
        self.part(binding, 0, self.bytes())
    }

    /// Entry that binds a part of the block. `offset` counts from the block's start and is a multiple of 256.
    pub fn part(&self, binding: u32, offset: usize, bytes: usize) -> wgpu::BindGroupEntry<'_> {
        wgpu::BindGroupEntry { binding, resource: wgpu::BindingResource::Buffer(self.range(offset, bytes)) }
    }

    /// Part of the block as a buffer binding.
    pub fn range(&self, offset: usize, bytes: usize) -> wgpu::BufferBinding<'_> {
        let offset = (self.at.start + offset) as u64;
        wgpu::BufferBinding { buffer: &self.buffer, offset, size: wgpu::BufferSize::new(bytes as u64) }
    }

    /// Size of the block, bytes.
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
        // Allocates blocks until one needs a new page.
        while blocks.bytes() == bytes {
            held.push(blocks.block(&device, 4096));
        }
        assert!(is_sound(&held));
        assert!(held.len() >= 5 + (PAGE - 4096) / 4096, "{} blocks", held.len());
    }

    #[test]
    fn changed_bytes_are_uploaded_once() {
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
        blocks.upload(&device);
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
