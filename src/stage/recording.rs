//! A frame's report, and what each effect of it costs where the host asks for that
//! ([`FrameFlags::MEASURE`](super::FrameFlags::MEASURE)).
//!
//! Wall time round a submission that is waited for, one an effect: true on every driver (timestamps of software drivers
//! are not), at the price of a wait. It holds the CPU's part and the driver's own hand-over, some tens of microseconds
//! an effect on a GPU. Frames that are not measured submit once and wait for nothing.

use std::{
    sync::Arc,
    time::{Duration, Instant},
};

use super::stages::Stages;
use crate::{
    error::Result,
    gpu::{Device, blocks::Blocks},
    plan::Prediction,
};

/// Item that a frame spends time on.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(u32)]
pub enum CostItem {
    /// Tables over the planet: built when the air changes.
    SkyTables = 0,
    /// The sky and the air as seen from the camera's height: built when height, sun or air change.
    SkyView = 1,
    /// Sky behind everything.
    Background = 2,
    /// Fog and aerial perspective.
    Medium = 3,
    /// Exposure, tone curve, encoding.
    Tone = 4,
    /// Stages in one draw that this target's format does not let be drawn one by one.
    Composition = 5,
    /// Textures for the host's own transparent shaders.
    Veil = 6,
    /// Taking over the host's context and images, and giving them back.
    HandOver = 7,
    /// Rain.
    Particles = 8,
    /// Water on surfaces.
    Surface = 9,
    /// Water on the windscreen: its steps and the lens.
    Windscreen = 10,
}

impl CostItem {
    /// Whose a draw of these stages is.
    pub(crate) fn of(stages: Stages) -> Self {
        match stages {
            Stages::SURFACE => Self::Surface,
            Stages::BACKGROUND => Self::Background,
            Stages::MEDIUM => Self::Medium,
            Stages::PARTICLES => Self::Particles,
            Stages::TONE => Self::Tone,
            _ => Self::Composition,
        }
    }

    /// All of them, in order.
    pub const ALL: [Self; 11] = [
        Self::SkyTables,
        Self::SkyView,
        Self::Background,
        Self::Medium,
        Self::Tone,
        Self::Composition,
        Self::Veil,
        Self::HandOver,
        Self::Particles,
        Self::Surface,
        Self::Windscreen,
    ];

    /// Its name, for people.
    pub const fn name(self) -> &'static std::ffi::CStr {
        match self {
            Self::SkyTables => c"sky tables",
            Self::SkyView => c"sky view",
            Self::Background => c"background",
            Self::Medium => c"air and fog",
            Self::Tone => c"tone",
            Self::Composition => c"composition",
            Self::Veil => c"veil",
            Self::HandOver => c"hand-over",
            Self::Particles => c"particles",
            Self::Surface => c"surfaces",
            Self::Windscreen => c"windscreen",
        }
    }
}

/// Milliseconds of one measured frame so far.
#[derive(Clone, Copy, Debug, PartialEq, Default)]
pub struct Costs {
    /// From the first call's beginning to the last one's end, less what lay between the calls.
    pub whole_ms: f64,
    ms: [f64; CostItem::ALL.len()],
}

impl Costs {
    /// Returns the cost of `item`, ms; 0 if it did not run.
    pub fn ms(&self, item: CostItem) -> f64 {
        self.ms[item as usize]
    }

    pub(crate) fn add(&mut self, item: CostItem, ms: f64) {
        self.ms[item as usize] += ms;
    }
}

/// Report on what the last frame of a view took and showed.
#[derive(Clone, Copy, Debug, PartialEq, Default)]
pub struct Report {
    /// The host's frame_id.
    pub frame_id: u64,
    /// Full-screen draws recorded for this frame_id so far.
    pub passes: u32,
    /// Tables built, refined or faded for this frame_id so far; 0 when only the camera turned and the sky has its final
    /// quality.
    pub tables_rebuilt: u32,
    /// Display units per cd/m^2 that were applied.
    pub exposure: f64,
    /// Bytes of GPU memory the view holds for itself.
    pub bytes: u64,
    /// Rain around the camera that was drawn.
    pub rain: RainReport,
    /// Snow around the camera that was drawn.
    pub snow: SnowReport,
    /// Cost of each effect, if the frame was measured ([`FrameFlags::MEASURE`](super::FrameFlags::MEASURE)).
    pub costs: Option<Costs>,
    /// Effects with something opaque that was not drawn, because the host's depth may only be read
    /// ([`DepthAccess::Read`](crate::frame::DepthAccess::Read)). 0 in this version, which has none.
    pub opaque_left_out: u32,
    /// Prediction of the frame by the plan.
    pub prediction: Prediction,
    /// Time that the weather took in it as the host reported it, ms
    /// ([`View::report_time`](crate::frame::View::report_time)).
    pub reported_ms: Option<f64>,
}

/// Drops and stones around the camera that were drawn, and those for which there was no room.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct RainReport {
    /// Drops and stones round the camera, of which those in the picture were drawn.
    pub drops: u32,
    /// Drops that each drop stood for: 1 unless more fell than [`crate::rain::RainSettings::most_drops`]; 0 without
    /// any.
    pub drop_weight: f64,
    /// The contrast gain ([`crate::rain::RainSettings::contrast_gain`]) of what was drawn; 0 where nothing fell.
    pub contrast_gain: f64,
    /// Splashes of the smallest drops that a second and m^2 of level ground had no room for.
    pub splashes_left_out_per_m2_s: f64,
    /// Smallest stones that did not hop, a second and m^2 of level ground, for want of room.
    pub stones_left_out_per_m2_s: f64,
}

/// Flakes around the camera that were drawn.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct SnowReport {
    /// Flakes round the camera, of which those in the picture were drawn; 0 where none were.
    pub flakes: u32,
    /// Distance up to which flakes were drawn, m; what is farther is extinction alone.
    pub flakes_to_m: f64,
}

fn ms_since(start: Instant) -> f64 {
    start.elapsed().as_secs_f64() * 1e3
}

/// When a measured call came, when its own work began, when its last effect ended, and what the frame cost before.
struct Watch {
    came: Instant,
    start: Instant,
    last: Instant,
    costs: Costs,
}

/// The encoder of one call, with a stopwatch if it is measured.
pub(crate) struct Recording<'a> {
    pub device: &'a Arc<Device>,
    pub encoder: &'a mut wgpu::CommandEncoder,
    /// The view's blocks, which are brought up before every submission.
    pub blocks: &'a Blocks,
    /// Full-screen draws recorded by this call so far.
    pub passes: u32,
    /// Tables built, refined or faded by this call.
    pub tables_rebuilt: u32,
    watch: Option<Watch>,
}

impl<'a> Recording<'a> {
    pub fn new(device: &'a Arc<Device>, encoder: &'a mut wgpu::CommandEncoder, blocks: &'a Blocks) -> Self {
        Self { device, encoder, blocks, passes: 0, tables_rebuilt: 0, watch: None }
    }

    /// Starts the stopwatch, once all earlier work of the queue is done.
    pub fn measure(&mut self, so_far: Costs) -> Result<()> {
        let came = Instant::now();
        self.device.queue.submit([]);
        self.device.wait()?;
        let start = Instant::now();
        self.watch = Some(Watch { came, start, last: start, costs: so_far });
        Ok(())
    }

    /// Whether this call is measured.
    pub fn is_measured(&self) -> bool {
        self.watch.is_some()
    }

    /// Brings up what blocks hold now, for what was recorded so far.
    pub fn upload(&mut self) {
        self.blocks.upload(&self.device.queue);
    }

    /// Submits what was recorded so far.
    pub fn flush(&mut self) {
        self.upload();
        let next = self.device.device.create_command_encoder(&Default::default());
        self.device.submit(std::mem::replace(self.encoder, next));
    }

    /// Charges what was recorded since the last item to `item`: where it is measured, it is submitted and waited for.
    /// If it did not run, the time is charged to no item.
    pub fn ends(&mut self, item: CostItem, ran: bool) -> Result<()> {
        let Some(watch) = &mut self.watch else { return Ok(()) };
        if ran {
            let next = self.device.device.create_command_encoder(&Default::default());
            let encoder = std::mem::replace(self.encoder, next);
            self.blocks.upload(&self.device.queue);
            self.device.submit_and_wait(encoder)?;
            watch.costs.add(item, ms_since(watch.last));
        }
        watch.last = Instant::now();
        Ok(())
    }

    /// Returns the costs of the frame up to here, and how long this call has lasted, if it is measured.
    pub fn costs(&self) -> Option<(Costs, Duration)> {
        let watch = self.watch.as_ref()?;
        let costs = Costs { whole_ms: watch.costs.whole_ms + ms_since(watch.start), ..watch.costs };
        Some((costs, watch.came.elapsed()))
    }
}
