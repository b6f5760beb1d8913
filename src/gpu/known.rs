//! Known answers: a test of an OpenGL driver with uniform blocks and loops whose results are known, made before any
//! other work.
//!
//! With NVIDIA's driver 580.159 on OpenGL the first tables of the sky never finish, and the GPU hangs. Tables are built
//! by loops whose bounds come from uniform blocks: if a block reads as zeros, the loop ends at once; if it reads as the
//! bits of a float, the loop never ends in practice. So the test first draws the contents of each kind of block without
//! a loop, and then one texel by two nested loops. A driver that fails gets no device. Shader:
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

/// Time limit of the test. A driver that needs longer for a few texels is taken to hang. The limit is shorter than the
/// 10 s in which a device must open or fail.
pub(super) const LIMIT: Duration = Duration::from_secs(6);

/// Fault that the test found in a driver.
#[derive(Debug)]
pub(super) enum Fault {
    /// Shaders read wrong bytes from a block.
    Blocks(String),
    /// The loops give a wrong sum.
    Loop(String),
    /// Hang: the GPU does not finish. None of its objects may be waited for or released.
    Hang,
    /// Any other error of the device.
    Other(Error),
}

impl Fault {
    /// Returns the error for the refused driver, with its name and what to use instead. An error of the device is
    /// returned as it is.
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

/// Sizes of the blocks in vectors of 16 bytes, in drawing order: rows, counts, rule, job, written.
const SIZES: [usize; 5] = [9, 5, 24, 1, 5];
const NAMES: [&str; 5] = ["rows", "counts", "rule", "job", "written"];
const TEXELS: usize = 44;
/// Bounds in the block of counts: the outer loop makes twice the first number of turns, the inner loop the second
/// number.
const TURNS: (u32, u32) = (5, 7);

/// Returns the contents of every vector. Rows and rule are floats, whose bits are large as integers, like the blocks of
/// the air; counts are small.
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

/// Returns the sum that the loops must have.
fn sum_of_turns(all: &[[u32; 4]]) -> u32 {
    let rule = |i: u32, k: usize| f32::from_bits(all[14 + i as usize][k]);
    let mut sum = 0.0;
    for m in 0..2 * TURNS.0 {
        let row = if m < TURNS.0 { m } else { m - TURNS.0 };
        sum += (0..TURNS.1).map(|p| rule(row, 1) * rule(p, 2).max(rule(row, 0))).sum::<f32>();
    }
    sum as u32
}

/// Draws the test and compares the result.
///
/// # Errors
/// The fault that the driver showed.
pub(super) fn ask(device: &Arc<Device>) -> std::result::Result<(), Fault> {
    let begun = Instant::now();
    // Opening a device leaves error flags, because wgpu asks for limits that an older driver does not know.
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

/// Blocks of the test and their bind group.
struct BoundBlocks {
    layout: wgpu::BindGroupLayout,
    group: wgpu::BindGroup,
    job: u32,
}

impl BoundBlocks {
    /// Creates four blocks in the same way as the tables' blocks, and one that is written like a view's block.
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

    /// Draws `width` texels with the entry point `entry`, and reads them back. [`LIMIT`] counts from `begun`.
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
        // Must come before the read-back, which would wait for longer than `LIMIT`.
        let waited = device.wait_within(LIMIT.saturating_sub(begun.elapsed()));
        if device.is_hung() {
            return Err(Fault::Hang);
        }
        waited?;
        Ok(bytemuck::pod_collect_to_vec(&readback::bytes(device, &target, 0)?))
    }
}
