//! Report of a frame, and the cost of each [`CostItem`] where the host asks for it
//! ([`FrameFlags::MEASURE`](super::FrameFlags::MEASURE)).
//!
//! A cost is a wall time: the CPU submits the work of one item and waits until this work is done. Such a time is right
//! on every driver (timestamps of software drivers are not), at the price of the wait. It includes the CPU's work and
//! the driver's own hand-over, some tens of microseconds per item on a GPU. Calls that are not measured wait for
//! nothing. Each is submitted once, and in pieces only where an image of an OpenGL host is copied between them.

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
    /// Sky tables that depend on the planet: built when the air changes.
    SkyTables = 0,
    /// Sky and air as seen from the camera's altitude: built when altitude, sun or air change.
    SkyView = 1,
    /// Sky behind everything.
    Background = 2,
    /// Fog and aerial perspective.
    Medium = 3,
    /// Exposure, tone curve, encoding.
    Tone = 4,
    /// Several stages in one draw, if the format of the target does not let them be drawn one by one; or a diagnostic
    /// picture.
    Composition = 5,
    /// Textures for the host's own transparent shaders, and the cube map.
    Veil = 6,
    /// Import of the host's context and images, and their return to the host.
    HandOver = 7,
    /// Rain, hail, snow and lightning channels, if their stage is drawn alone.
    Particles = 8,
    /// Water and snow on surfaces; the opaque sea and terrain.
    Surface = 9,
    /// Water on the windscreen: its simulation steps and the lens.
    Windscreen = 10,
}

impl CostItem {
    /// Item to which a draw of these stages is charged.
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

    /// All items, in order.
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

    /// Name of the item, for people to read.
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

/// Costs of one measured frame so far.
#[derive(Clone, Copy, Debug, PartialEq, Default)]
pub struct Costs {
    /// Wall time of all calls of the frame, ms, without the time between the calls and without each call's wait for
    /// earlier work on the queue.
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

/// Report on the cost and the content of a view's last frame.
#[derive(Clone, Copy, Debug, PartialEq, Default)]
pub struct Report {
    /// The host's frame number ([`Frame::frame_id`](crate::frame::Frame::frame_id)); `u64::MAX` before the first frame.
    pub frame_id: u64,
    /// Render passes recorded for this frame_id so far, without those that build tables.
    pub passes: u32,
    /// Number of tables built, refined or faded for this frame_id so far: 0 when only the camera turned and the sky has
    /// its final quality.
    pub tables_rebuilt: u32,
    /// Exposure that was applied, display units per cd/m^2.
    pub exposure: f64,
    /// GPU memory that the view holds for itself, bytes.
    pub bytes: u64,
    /// Rain drawn around the camera.
    pub rain: RainReport,
    /// Snow drawn around the camera.
    pub snow: SnowReport,
    /// Cost of each [`CostItem`], if the frame was measured ([`FrameFlags::MEASURE`](super::FrameFlags::MEASURE)).
    pub costs: Option<Costs>,
    /// Number of effects whose opaque geometry was not drawn because the host's depth may only be read
    /// ([`DepthAccess::Read`](crate::frame::DepthAccess::Read)): the sea if it is in view, and the terrain if the
    /// context draws it.
    pub opaque_left_out: u32,
    /// The plan's prediction for the frame.
    pub prediction: Prediction,
    /// Time that the frame's weather took, as the host reported it, ms
    /// ([`View::report_time`](crate::frame::View::report_time)).
    pub reported_ms: Option<f64>,
}

/// Drops and hailstones drawn around the camera, and splashes and bounces left out for lack of room.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct RainReport {
    /// Number of drops and hailstones around the camera, of which those in the picture were drawn.
    pub drops: u32,
    /// Number of real drops that each drawn drop represents: 1 unless more real drops fell than
    /// [`crate::rain::RainSettings::most_drops`]; 0 without drops.
    pub drop_weight: f64,
    /// Contrast gain ([`crate::rain::RainSettings::contrast_gain`]) of the rain that was drawn; 0 where nothing fell.
    pub contrast_gain: f64,
    /// Number of the smallest drops whose splash was left out for lack of room, per second and m^2 of level ground.
    pub splashes_left_out_per_m2_s: f64,
    /// Number of the smallest hailstones whose bounce was left out for lack of room, per second and m^2 of level
    /// ground.
    pub stones_left_out_per_m2_s: f64,
}

/// Flakes drawn around the camera.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct SnowReport {
    /// Number of flakes around the camera, of which those in the picture were drawn. 0 if no flakes were drawn.
    pub flakes: u32,
    /// Distance up to which flakes were drawn, m. Beyond it snow only adds to the extinction.
    pub flakes_to_m: f64,
}

fn ms_since(start: Instant) -> f64 {
    start.elapsed().as_secs_f64() * 1e3
}

/// Times of a measured call: its arrival, the start of its own work, and the end of its last item; and the costs of the
/// frame so far.
struct Watch {
    /// Arrival of the call.
    came: Instant,
    /// Start of the call's own work.
    start: Instant,
    /// End of the last item.
    last: Instant,
    costs: Costs,
}

/// Command encoder of one call, with a stopwatch if the call is measured.
pub(crate) struct Recording<'a> {
    pub device: &'a Arc<Device>,
    pub encoder: &'a mut wgpu::CommandEncoder,
    /// The view's blocks, which are uploaded before every submission.
    pub blocks: &'a Blocks,
    /// Render passes recorded by this call so far, without those that build tables.
    pub passes: u32,
    /// Tables built, refined or faded by this call.
    pub tables_rebuilt: u32,
    watch: Option<Watch>,
}

impl<'a> Recording<'a> {
    pub fn new(device: &'a Arc<Device>, encoder: &'a mut wgpu::CommandEncoder, blocks: &'a Blocks) -> Self {
        Self { device, encoder, blocks, passes: 0, tables_rebuilt: 0, watch: None }
    }

    /// Starts the stopwatch once the queue has finished all earlier work.
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

    /// Uploads the present content of the blocks, for what has been recorded so far.
    pub fn upload(&mut self) {
        self.blocks.upload(self.device);
    }

    /// Uploads the blocks and submits what has been recorded so far.
    pub fn flush(&mut self) {
        self.upload();
        let next = self.device.device.create_command_encoder(&Default::default());
        self.device.submit(std::mem::replace(self.encoder, next));
    }

    /// Ends the work for `item`: its cost is the time since the end of the item before. A measured call submits the
    /// work and waits for it. If the item did not run (`ran` is false), its time is charged to no item.
    pub fn ends(&mut self, item: CostItem, ran: bool) -> Result<()> {
        let Some(watch) = &mut self.watch else { return Ok(()) };
        if ran {
            let next = self.device.device.create_command_encoder(&Default::default());
            let encoder = std::mem::replace(self.encoder, next);
            self.blocks.upload(self.device);
            self.device.submit_and_wait(encoder)?;
            watch.costs.add(item, ms_since(watch.last));
        }
        watch.last = Instant::now();
        Ok(())
    }

    /// Returns the costs of the frame so far and the time that this call has taken, if it is measured.
    pub fn costs(&self) -> Option<(Costs, Duration)> {
        let watch = self.watch.as_ref()?;
        let costs = Costs { whole_ms: watch.costs.whole_ms + ms_since(watch.start), ..watch.costs };
        Some((costs, watch.came.elapsed()))
    }
}
