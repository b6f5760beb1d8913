//! The gauge: one small pass that measures what each part of the weather contributes to a picture. Its result is read
//! back without waiting.
//!
//! A few frames lie between the pass and its result, so a plan follows the picture with a delay. The pass composes 2304
//! pixels four or five times (eight times with clouds): 1 to 2 % of the pixels of a picture of 1280 x 720, in every
//! [`EVERY`]th frame.

use std::sync::{
    Arc,
    atomic::{AtomicU32, Ordering},
};

use crate::{
    error::Result,
    gpu::{
        Device,
        counts::DeviceWork,
        flat_texture,
        pass::{self, FullscreenDesc},
    },
};

/// Gauged pixels across and down.
pub const GRID: (u32, u32) = (64, 36);
/// Frames from one gauge to the next.
pub const EVERY: u32 = 8;

/// Format of the target: each channel packs two numbers, each as the upper half of its 32-bit float.
const FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Rgba32Uint;
/// Size of a row in the staging buffer, bytes.
const BYTES_PER_ROW: u32 = GRID.0 * 16;

/// State of a readback: none is under way. A readback passes through the next three states in this order.
const IDLE: u32 = 0;
/// State of a readback: the pass is recorded.
const RECORDED: u32 = 1;
/// State of a readback: the buffer is being mapped.
const MAPPING: u32 = 2;
/// State of a readback: the buffer is ready.
const READY: u32 = 3;
/// State of a readback: the mapping failed.
const FAILED: u32 = 4;

/// Names and values of `override` constants.
type OverrideValues = Vec<(&'static str, f64)>;

/// Largest number of channels. Each holds the change due to one part, or to several parts that share it.
pub const CHANNELS: usize = 5;

/// Result of the gauge at one pixel.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct GaugeSample {
    /// Relative change of luminance, (Y' - Y) / (Y + 0.01 white), for each channel: Y' is without the parts of the
    /// channel, or with a coarser form of them (`shaders/plan/gauge.wgsl`).
    pub composed: [f32; CHANNELS],
    /// Kind of the pixel: 1 where the host drew something, -1 where it did not, 0 where the host keeps the pixel for
    /// itself.
    pub kind: f32,
    /// Luminance with everything but drops, 1 = white.
    pub luminance: f32,
    /// Optical depth of the drops and flakes that are drawn one by one, up to the pixel's surface.
    pub hidden: f32,
}

/// Target, staging buffer and pipeline of a view's gauge.
pub(crate) struct Gauge {
    /// Texture with one texel for each gauged pixel.
    target: wgpu::Texture,
    /// View of the texture, into which the pass draws.
    view: wgpu::TextureView,
    /// Staging buffer that the CPU reads.
    buffer: wgpu::Buffer,
    /// State of the readback: [`IDLE`] and the constants after it.
    state: Arc<AtomicU32>,
    /// Pipeline, with the shader (for one sample a pixel or for several) and the `override` constants that it was
    /// created for.
    pipeline: Option<(&'static str, OverrideValues, wgpu::RenderPipeline)>,
    /// Samples of the last readback.
    samples: Vec<GaugeSample>,
}

impl Gauge {
    /// Creates the target and the staging buffer.
    pub fn new(device: &Device) -> Self {
        let target = flat_texture(
            &device.device,
            "gauge",
            GRID,
            FORMAT,
            wgpu::TextureUsages::RENDER_ATTACHMENT | wgpu::TextureUsages::COPY_SRC,
        );
        let view = target.create_view(&Default::default());
        let buffer = device.device.create_buffer(&wgpu::BufferDescriptor {
            label: Some("gauge"),
            size: u64::from(BYTES_PER_ROW * GRID.1),
            usage: wgpu::BufferUsages::COPY_DST | wgpu::BufferUsages::MAP_READ,
            mapped_at_creation: false,
        });
        let count = (GRID.0 * GRID.1) as usize;
        Self {
            target,
            view,
            buffer,
            state: Arc::new(AtomicU32::new(IDLE)),
            pipeline: None,
            samples: Vec::with_capacity(count),
        }
    }

    /// Whether a new gauge can be recorded.
    pub fn is_idle(&self) -> bool {
        self.state.load(Ordering::Acquire) == IDLE
    }

    /// Records the pass. `groups`, `layouts` and `constants` are those of the composition. `shader` is the variant for
    /// the number of samples of the host's colour and depth.
    ///
    /// # Errors
    /// The errors of [`pass::fullscreen`].
    pub fn record(
        &mut self,
        device: &Arc<Device>,
        encoder: &mut wgpu::CommandEncoder,
        (shader, constants): (&'static str, &[(&'static str, f64)]),
        layouts: &[&wgpu::BindGroupLayout],
        groups: &[&wgpu::BindGroup],
    ) -> Result<()> {
        if self.pipeline.as_ref().is_none_or(|(s, made, _)| *s != shader || made != constants) {
            let target = wgpu::ColorTargetState { format: FORMAT, blend: None, write_mask: wgpu::ColorWrites::ALL };
            let desc = FullscreenDesc { shader, entry: "gauge", layouts, targets: &[target], constants, samples: 1 };
            self.pipeline = Some((shader, constants.to_vec(), pass::fullscreen(device, &desc)?));
        }
        let Some((.., pipeline)) = &self.pipeline else { return Ok(()) };
        pass::draw(encoder, "gauge", pipeline, groups, &self.view);
        encoder.copy_texture_to_buffer(
            self.target.as_image_copy(),
            wgpu::TexelCopyBufferInfo {
                buffer: &self.buffer,
                layout: wgpu::TexelCopyBufferLayout {
                    offset: 0,
                    bytes_per_row: Some(BYTES_PER_ROW),
                    rows_per_image: None,
                },
            },
            self.target.size(),
        );
        device.counts.add(DeviceWork::Gauges, 1);
        self.state.store(RECORDED, Ordering::Release);
        Ok(())
    }

    /// Advances a readback under way, without waiting, and returns the samples once they have arrived. Call it once a
    /// frame, after the host has submitted the commands of the last frame.
    pub fn advance(&mut self, device: &Device) -> Option<&[GaugeSample]> {
        if self.state.load(Ordering::Acquire) == RECORDED {
            self.state.store(MAPPING, Ordering::Release);
            let state = self.state.clone();
            self.buffer.map_async(wgpu::MapMode::Read, .., move |done| {
                state.store(if done.is_ok() { READY } else { FAILED }, Ordering::Release);
            });
        }
        if self.is_idle() {
            return None;
        }
        let _ = device.device.poll(wgpu::PollType::Poll);
        match self.state.load(Ordering::Acquire) {
            READY => device.counts.add(DeviceWork::Gauges, 1),
            FAILED => {
                self.state.store(IDLE, Ordering::Release);
                return None;
            }
            _ => return None,
        }
        self.samples.clear();
        if let Ok(bytes) = self.buffer.get_mapped_range(..) {
            let half = |b: &[u8], i: usize| half::bf16::from_le_bytes([b[2 * i], b[2 * i + 1]]).to_f32();
            self.samples.extend(bytes.chunks_exact(16).map(|b| {
                let composed = [0, 1, 2, 3, 7].map(|i| half(b, i));
                GaugeSample { composed, kind: half(b, 4), luminance: half(b, 5), hidden: half(b, 6) }
            }));
        }
        self.buffer.unmap();
        self.state.store(IDLE, Ordering::Release);
        Some(&self.samples)
    }
}
