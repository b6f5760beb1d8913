//! Known answers: what an OpenGL driver draws of blocks and loops whose results are known, before anything else is
//! asked of it.
//!
//! NVIDIA's 580.159 does not finish the sky's first tables by OpenGL, and the GPU hangs with them. Tables are built by
//! loops whose bounds come from uniform blocks; zeros in a block end them at once, and the bits of a float never. So
//! each kind of block is drawn out without a loop first, then one texel by a loop; whoever fails gives no device. Twin:
//! `shaders/common/known.wgsl`.

use std::{
    sync::Arc,
    time::{Duration, Instant},
};

use wgpu::util::DeviceExt as _;

use super::{
    bind::{self, Slot},
    device::Device,
    pass, readback,
};
use crate::error::{Error, Status};

/// A driver that has not finished a few texels after so long never will. A device must be there or refused within 10 s.
pub(super) const LIMIT: Duration = Duration::from_secs(6);

/// Fault that a driver showed with the known answers.
#[derive(Debug)]
pub(super) enum Fault {
    /// Shaders find other bytes in a block.
    Blocks(String),
    /// A loop comes to another sum.
    Loop(String),
    /// The GPU does not finish. Nothing that belongs to it may be waited for or released.
    Hang,
    /// Whatever else a device answers.
    Other(Error),
}

impl Fault {
    /// The refusal, with the driver's name and what to use instead.
    pub fn refuse(self, driver: &str) -> Error {
        let what = match self {
            Self::Blocks(what) => format!("gives shaders other bytes than were written: {what}"),
            Self::Loop(what) => format!("does not run loops as they are written: {what}"),
            Self::Hang => format!("did not finish a few texels within {} s", LIMIT.as_secs()),
            Self::Other(e) => return e,
        };
        let name: String = driver.chars().take(100).collect();
        Error::new(
            Status::NoAdapter,
            format!("the OpenGL driver {name} {what}; use Vulkan (WK_BACKEND_VULKAN, wk_device_create_vulkan)"),
        )
    }
}

impl From<Error> for Fault {
    fn from(e: Error) -> Self {
        Self::Other(e)
    }
}

/// Sizes of the blocks in vectors of 16 bytes, in the order in which they are drawn: rows, counts, rule, job, written.
const SIZES: [usize; 5] = [9, 5, 24, 1, 5];
const NAMES: [&str; 5] = ["rows", "counts", "rule", "job", "written"];
const TEXELS: usize = 44;
/// Bounds of the two loops.
const TURNS: (u32, u32) = (5, 7);

/// Returns the contents of every vector. Rows and rule are floats, whose bits are large numbers, as those of the air;
/// counts are small.
fn contents() -> Vec<[u32; 4]> {
    let floats = |i: usize| std::array::from_fn(|k| ((1 + i * 4 + k) as f32 * 1.25).to_bits());
    let whole = |i: usize| std::array::from_fn(|k| ((1 + (i * (k + 3)) % 11) as f32).to_bits());
    let counts = |i: usize| std::array::from_fn(|k| (3 + 4 * i + k) as u32);
    let mut all = Vec::with_capacity(TEXELS);
    all.extend((0..9).map(floats));
    all.extend((0..5).map(counts));
    all[10][..2].copy_from_slice(&[TURNS.0, TURNS.1]);
    all.extend((0..24).map(whole));
    all.push([2, 1, 77, 78]);
    all.extend((5..10).map(counts));
    all
}

/// The sum that the loops come to.
fn sum_of_turns(all: &[[u32; 4]]) -> u32 {
    let rule = |i: u32, k: usize| f32::from_bits(all[14 + i as usize][k]);
    let mut sum = 0.0;
    for m in 0..2 * TURNS.0 {
        let row = if m < TURNS.0 { m } else { m - TURNS.0 };
        sum += (0..TURNS.1).map(|p| rule(row, 1) * rule(p, 2).max(rule(row, 0))).sum::<f32>();
    }
    sum as u32
}

/// Draws and compares.
///
/// # Errors
/// What the driver did instead.
pub(super) fn ask(device: &Arc<Device>) -> std::result::Result<(), Fault> {
    let begun = Instant::now();
    // Opening leaves error flags: wgpu asks for limits that an older driver does not know.
    for _ in 0..8 {
        if device.check_made().is_ok() {
            break;
        }
    }
    let all = contents();
    let parts = BoundBlocks::new(device, &all);
    let blocks = parts.draw(device, "blocks", TEXELS, begun)?;
    let is_wrong = |i: &usize| blocks[*i] != all[*i];
    if let Some(i) = (0..TEXELS).find(is_wrong) {
        let (mut block, mut at) = (0, i);
        while at >= SIZES[block] {
            at -= SIZES[block];
            block += 1;
        }
        let k = (0..4).find(|k| blocks[i][*k] != all[i][*k]).unwrap_or(0);
        let (name, bytes, word) = (NAMES[block], 16 * SIZES[block], 4 * at + k);
        let (wanted, got) = (all[i][k], blocks[i][k]);
        return Err(Fault::Blocks(format!("word {word} of {bytes} ({name}) is 0x{got:08x}, not 0x{wanted:08x}")));
    }
    let (wanted, got) = (sum_of_turns(&all), parts.draw(device, "turns", 1, begun)?[0][0]);
    if got != wanted {
        return Err(Fault::Loop(format!("a sum of {wanted} comes to {got}")));
    }
    log::debug!("known answers drawn in {:.1} ms", 1e3 * begun.elapsed().as_secs_f64());
    Ok(())
}

/// The blocks, bound.
struct BoundBlocks {
    layout: wgpu::BindGroupLayout,
    group: wgpu::BindGroup,
    job: u32,
}

impl BoundBlocks {
    /// Makes the blocks as the tables' are made, with contents, and one as a view's is written.
    fn new(device: &Device, all: &[[u32; 4]]) -> Self {
        let step = device.device.limits().min_uniform_buffer_offset_alignment.max(16) as usize;
        let usage = wgpu::BufferUsages::UNIFORM | wgpu::BufferUsages::COPY_DST;
        let with = |contents: &[u8]| {
            let desc = wgpu::util::BufferInitDescriptor { label: Some("known"), contents, usage };
            device.device.create_buffer_init(&desc)
        };
        let bytes = |from: usize, size: usize| bytemuck::cast_slice::<_, u8>(&all[from..from + size]);
        let mut jobs = vec![0xFF; 2 * step];
        jobs[step..step + 16].copy_from_slice(bytes(38, 1));
        let [rows, counts, rule] = [(0, 9), (9, 5), (14, 24)].map(|(from, size)| with(bytes(from, size)));
        let jobs = with(&jobs);
        let written = bind::block(&device.device, "known", 4 * step.max(80));
        let place = step.max(80).next_multiple_of(step);
        device.queue.write_buffer(&written, place as u64, bytes(39, 5));
        let block = Slot::Uniform(0);
        let slots = [(0, block), (1, block), (2, block), (3, Slot::DynamicUniform(16)), (4, block)];
        let layout = bind::layout(&device.device, "known", wgpu::ShaderStages::FRAGMENT, &slots);
        let group = device.device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some("known"),
            layout: &layout,
            entries: &[
                bind::buffer(0, &rows),
                bind::buffer(1, &counts),
                bind::buffer(2, &rule),
                bind::part(3, &jobs, 0..16),
                bind::part(4, &written, place..place + 80),
            ],
        });
        Self { layout, group, job: step as u32 }
    }

    /// Draws so many texels by an entry point, and reads them.
    fn draw(
        &self,
        device: &Arc<Device>,
        entry: &str,
        width: usize,
        begun: Instant,
    ) -> std::result::Result<Vec<[u32; 4]>, Fault> {
        let format = wgpu::TextureFormat::Rgba32Uint;
        let usage = wgpu::TextureUsages::RENDER_ATTACHMENT | wgpu::TextureUsages::COPY_SRC;
        let target = super::flat_texture(&device.device, "known", (width as u32, 1), format, usage);
        let desc = pass::FullscreenDesc {
            shader: "common/known.wgsl",
            entry,
            layouts: &[&self.layout],
            targets: &[format.into()],
            constants: &[],
            samples: 1,
        };
        let pipeline = pass::fullscreen(device, &desc)?;
        let view = target.create_view(&Default::default());
        let mut encoder = device.device.create_command_encoder(&Default::default());
        let mut drawn = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some("known"),
            color_attachments: &[Some(wgpu::RenderPassColorAttachment {
                view: &view,
                depth_slice: None,
                resolve_target: None,
                ops: wgpu::Operations { load: wgpu::LoadOp::Clear(wgpu::Color::BLACK), store: wgpu::StoreOp::Store },
            })],
            ..Default::default()
        });
        drawn.set_pipeline(&pipeline);
        drawn.set_bind_group(0, &self.group, &[self.job]);
        drawn.draw(0..3, 0..1);
        drop(drawn);
        device.submit(encoder);
        device.check()?;
        // Before anything is read: reading waits as long as the driver likes.
        let waited = device.wait_within(LIMIT.saturating_sub(begun.elapsed()));
        if device.is_hung() {
            return Err(Fault::Hang);
        }
        waited?;
        Ok(bytemuck::pod_collect_to_vec(&readback::bytes(device, &target, 0)?))
    }
}
