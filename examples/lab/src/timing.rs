//! Times as ratios to a fixed baseline. Both are measured in turn, so that other load on the machine affects both.

use std::sync::Arc;
use std::time::Instant;

use welkin::Result;
use welkin::gpu::{Device, flat_texture};
use welkin::plan::difference::percentile;
use welkin_support::fullscreen;

/// A fixed load: 64 exponentials in every pixel of 320x180.
pub struct Baseline {
    device: Arc<Device>,
    pipeline: wgpu::RenderPipeline,
    target: wgpu::TextureView,
}

const BASELINE: &str = "
@vertex fn vertex(@builtin(vertex_index) i: u32) -> @builtin(position) vec4f {
    return vec4f(f32(i & 1u) * 4.0 - 1.0, f32(i >> 1u) * 4.0 - 1.0, 0.0, 1.0);
}
@fragment fn fragment(@builtin(position) p: vec4f) -> @location(0) vec4f {
    var sum = vec3f(0.0);
    for (var i = 0; i < 64; i++) {
        sum += exp(-vec3f(0.01, 0.02, 0.03) * (f32(i) + p.xyx * 0.01));
    }
    return vec4f(sum / 64.0, 1.0);
}";

impl Baseline {
    /// Creates it; its first run is not counted.
    pub fn new(device: &Arc<Device>) -> Result<Self> {
        let gpu = &device.device;
        let source = wgpu::ShaderSource::Wgsl(BASELINE.into());
        let module = gpu.create_shader_module(wgpu::ShaderModuleDescriptor { label: Some("baseline"), source });
        let format = wgpu::TextureFormat::Rgba16Float;
        let pipeline = fullscreen::pipeline(gpu, &module, ("vertex", "fragment", &[]), &[], &[format.into()]);
        let target = target(device, (320, 180), format);
        let this = Self { device: device.clone(), pipeline, target: target.create_view(&Default::default()) };
        this.run()?;
        Ok(this)
    }

    /// Runs it once and returns the time, ms.
    pub fn run(&self) -> Result<f64> {
        let mut encoder = self.device.device.create_command_encoder(&Default::default());
        welkin::gpu::pass::draw(&mut encoder, "baseline", &self.pipeline, &[], &self.target);
        timed(&self.device, encoder)
    }
}

/// Submits, waits, and returns the time, ms.
pub fn timed(device: &Device, encoder: wgpu::CommandEncoder) -> Result<f64> {
    let start = Instant::now();
    device.submit_and_wait(encoder)?;
    Ok(start.elapsed().as_secs_f64() * 1e3)
}

/// A texture to draw into and to read.
pub fn target(device: &Device, (width, height): (u32, u32), format: wgpu::TextureFormat) -> wgpu::Texture {
    flat_texture(
        &device.device,
        "lab",
        (width, height),
        format,
        wgpu::TextureUsages::RENDER_ATTACHMENT
            | wgpu::TextureUsages::TEXTURE_BINDING
            | wgpu::TextureUsages::COPY_SRC
            | wgpu::TextureUsages::COPY_DST,
    )
}

/// A time relative to the baseline.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Ratio {
    /// Median of the ratios.
    pub median: f64,
    /// Lower quartile of the ratios.
    pub low: f64,
    /// Upper quartile of the ratios.
    pub high: f64,
    /// Median of the times themselves, ms.
    pub ms: f64,
}

impl Ratio {
    /// From times and the baseline's times measured beside them.
    pub fn of(pairs: &[(f64, f64)]) -> Self {
        let sorted = |of: &dyn Fn(&(f64, f64)) -> f64| {
            let mut v: Vec<f64> = pairs.iter().map(of).collect();
            v.sort_by(f64::total_cmp);
            v
        };
        let ratios = sorted(&|p| p.0 / p.1);
        let ms = percentile(&sorted(&|p| p.0), 0.5);
        let at = |share| percentile(&ratios, share);
        Self { median: at(0.5), low: at(0.25), high: at(0.75), ms }
    }

    /// The sum of this and a multiple of another.
    pub fn plus(&self, other: &Self, share: f64) -> Self {
        Self {
            median: self.median + share * other.median,
            low: self.low + share * other.low,
            high: self.high + share * other.high,
            ms: self.ms + share * other.ms,
        }
    }

    /// Whether two measurements differ by more than their spreads.
    pub fn moved(&self, other: &Self) -> bool {
        self.low > other.high || self.high < other.low
    }
}

/// Work that takes longer than this is repeated fewer times, ms.
const LONG_MS: f64 = 6000.0;

/// Runs `work` in turn with the baseline: `rounds` times (at least 5, fewer if they are long), after one run that is
/// not counted. `work` returns its time in ms.
pub fn interleaved(baseline: &Baseline, rounds: usize, mut work: impl FnMut(usize) -> Result<f64>) -> Result<Ratio> {
    let first = work(0)?;
    let rounds = rounds.min(((LONG_MS / first.max(1e-3)) as usize).max(5));
    let mut pairs = Vec::with_capacity(rounds);
    for i in 0..rounds {
        // Baseline before and after, because the machine may become busy in between.
        let before = baseline.run()?;
        let time = work(i + 1)?;
        pairs.push((time, 0.5 * (before + baseline.run()?)));
    }
    Ok(Ratio::of(&pairs))
}
