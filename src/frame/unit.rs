//! Warning for a scene-linear host whose `cd_m2_per_unit` is implausible. Example: in a scene that is lit without
//! units, white is 1. With 1 cd/m^2 per unit that white is black in daylight, and only this warning says why.
//!
//! The check is due in a view's third frame and in every 1024th frame after it. In formats whose values end at 1 the
//! largest value is known. From RGBA formats with half or single floats a few rows of the host's picture are read back
//! without waiting. Multisampled float pictures and `Rg11b10Ufloat` are not checked. An implausible unit is logged as
//! a warning, and again only after it was plausible in between.

use std::sync::{
    Arc,
    atomic::{AtomicU32, Ordering},
};

use crate::{
    gpu::Device,
    stage::{ColorSpace, Frame, can_copy},
};

/// Number of rows that are read back, evenly spaced over the picture.
const ROWS: u32 = 8;
/// First frame of a view that is checked, and number of frames between two checks.
const FIRST: u64 = 3;
const EVERY: u64 = 1024;
/// Largest plausible ratio of the luminance of white in the weather's light to that of the picture's brightest pixels.
/// With a larger ratio the unit counts as wrong. A room with its lamps off has a smaller ratio.
const DARKER: f64 = 2000.0;
/// Largest plausible ratio, by day, of the luminance of the picture's brightest pixels to that of white in the
/// weather's light. With a larger ratio the unit counts as wrong. It is day if that white has more than `DAY_CD_M2`.
const BRIGHTER: f64 = 2000.0;
const DAY_CD_M2: f64 = 100.0;

const IDLE: u32 = 0;
const RECORDED: u32 = 1;
const MAPPING: u32 = 2;
const READY: u32 = 3;

/// Picture whose readback is pending.
#[derive(Clone, Copy)]
struct WatchedPicture {
    format: wgpu::TextureFormat,
    width: u32,
    /// Bytes from one row of the readback to the next.
    pitch: u32,
    rows: u32,
    /// The host's `cd_m2_per_unit`.
    unit: f64,
    /// Luminance of white on level ground, cd/m^2.
    white: f64,
    /// Whether the sky may already be in the picture.
    with_background: bool,
}

/// Check of one view's luminance unit.
#[derive(Default)]
pub(super) struct LuminanceUnitCheck {
    /// Number of frames of a scene-linear host so far.
    frames: u64,
    has_warned: bool,
    buffer: Option<wgpu::Buffer>,
    state: Arc<AtomicU32>,
    /// Picture whose readback is pending.
    looked: Option<WatchedPicture>,
}

impl LuminanceUnitCheck {
    /// Continues a pending readback. If a check is due, starts a readback of this frame's picture, or judges at once by
    /// the largest value of the picture's format. `white_cd_m2` is the luminance of white on level ground;
    /// `with_background` says whether BACKGROUND may already be in the picture.
    pub fn watch(
        &mut self,
        device: &Device,
        encoder: &mut wgpu::CommandEncoder,
        frame: &Frame<'_>,
        (white_cd_m2, with_background): (f64, bool),
    ) {
        self.advance(device);
        let Some(color) = frame.color else { return };
        if frame.color_space != ColorSpace::SceneLinear {
            return;
        }
        self.frames += 1;
        if self.frames % EVERY != FIRST {
            return;
        }
        use wgpu::TextureFormat as F;
        let bytes = match color.format() {
            F::Rgba16Float => 8,
            F::Rgba32Float => 16,
            F::Rg11b10Ufloat => return,
            _ => return self.judge(frame.cd_m2_per_unit, white_cd_m2, frame.cd_m2_per_unit),
        };
        if color.sample_count() > 1 || !can_copy(color) || self.state.load(Ordering::Acquire) != IDLE {
            return;
        }
        let rows = ROWS.min(color.height());
        let pitch = (color.width() * bytes).next_multiple_of(wgpu::COPY_BYTES_PER_ROW_ALIGNMENT);
        let size = u64::from(pitch * rows);
        if self.buffer.as_ref().is_none_or(|b| b.size() != size) {
            self.buffer = Some(device.device.create_buffer(&wgpu::BufferDescriptor {
                label: Some("unit watch"),
                size,
                usage: wgpu::BufferUsages::COPY_DST | wgpu::BufferUsages::MAP_READ,
                mapped_at_creation: false,
            }));
        }
        let Some(buffer) = &self.buffer else { return };
        for i in 0..rows {
            let origin = wgpu::Origin3d { x: 0, y: (2 * i + 1) * color.height() / (2 * rows), z: frame.layers.color };
            let offset = u64::from(i * pitch);
            encoder.copy_texture_to_buffer(
                wgpu::TexelCopyTextureInfo { origin, ..color.as_image_copy() },
                wgpu::TexelCopyBufferInfo {
                    buffer,
                    layout: wgpu::TexelCopyBufferLayout { offset, bytes_per_row: Some(pitch), rows_per_image: None },
                },
                wgpu::Extent3d { width: color.width(), height: 1, depth_or_array_layers: 1 },
            );
        }
        let (unit, white) = (frame.cd_m2_per_unit, white_cd_m2);
        self.looked = Some(WatchedPicture {
            format: color.format(),
            width: color.width(),
            pitch,
            rows,
            unit,
            white,
            with_background,
        });
        self.state.store(RECORDED, Ordering::Release);
    }

    /// Advances the pending readback without waiting.
    fn advance(&mut self, device: &Device) {
        let Some(buffer) = &self.buffer else { return };
        match self.state.load(Ordering::Acquire) {
            RECORDED => {
                self.state.store(MAPPING, Ordering::Release);
                let state = self.state.clone();
                buffer.map_async(wgpu::MapMode::Read, .., move |done| {
                    state.store(if done.is_ok() { READY } else { IDLE }, Ordering::Release);
                });
            }
            MAPPING => {
                let _ = device.device.poll(wgpu::PollType::Poll);
            }
            READY => {
                let found = buffer.get_mapped_range(..).ok().zip(self.looked).and_then(|(b, l)| brightest(&b, &l));
                buffer.unmap();
                self.state.store(IDLE, Ordering::Release);
                if let (Some(found), Some(looked)) = (found, self.looked) {
                    self.judge(found, looked.white, looked.unit);
                }
            }
            _ => {}
        }
    }

    /// Warns if a picture whose brightest pixels have `found` cd/m^2 cannot be lit by the weather's light, in which
    /// white has `white` cd/m^2.
    fn judge(&mut self, found: f64, white: f64, unit: f64) {
        let wrong = found * DARKER < white || (white > DAY_CD_M2 && found > white * BRIGHTER);
        if wrong && !self.has_warned {
            log::warn!(
                "the host's picture reaches {found:.3} cd/m2 where the weather's light makes white {white:.0} cd/m2: with color_space \
                 SCENE_LINEAR and cd_m2_per_unit {unit} its objects will show {}. A host whose white is 1 sets DISPLAY_SRGB or \
                 DISPLAY_LINEAR and asks wk_context_get_frame_light how to light its scene; another gives the luminance of its 1 in \
                 cd_m2_per_unit",
                if found < white { "black" } else { "white" }
            );
        }
        self.has_warned = wrong;
    }
}

/// Returns the luminance of the brightest pixels, cd/m^2; `None` if all pixels are black. If the sky is in the picture,
/// returns the 20th percentile of the pixels that are not black, because pixels as dark as that are not sky. The green
/// channel is taken as the luminance.
fn brightest(bytes: &[u8], looked: &WatchedPicture) -> Option<f64> {
    let half = |b: &[u8], i: usize| f64::from(half::f16::from_le_bytes([b[2 * i], b[2 * i + 1]]).to_f32());
    let float =
        |b: &[u8], i: usize| f64::from(f32::from_le_bytes([b[4 * i], b[4 * i + 1], b[4 * i + 2], b[4 * i + 3]]));
    let wide = looked.format == wgpu::TextureFormat::Rgba32Float;
    let texel = if wide { 16 } else { 8 };
    let mut all: Vec<f64> = Vec::new();
    for row in bytes.chunks_exact(looked.pitch as usize).take(looked.rows as usize) {
        let texels = row.chunks_exact(texel).take(looked.width as usize);
        let green = texels.map(|b| if wide { float(b, 1) } else { half(b, 1) } * looked.unit);
        all.extend(green.filter(|l| l.is_finite() && *l > 0.0));
    }
    all.sort_unstable_by(f64::total_cmp);
    let last = if looked.with_background { all.len() / 5 } else { all.len().saturating_sub(1) };
    all.get(last).copied()
}
