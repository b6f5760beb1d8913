//! Playing the day frame by frame, and each of its weathers at rest.

use std::{
    io::BufRead as _,
    sync::Arc,
    time::{Duration, Instant},
};

use welkin::{
    Status,
    context::{Context, ContextDesc},
    frame::{Frame, Shared, Stages, View},
    gpu::{Device, DeviceOptions},
    ground::SurfaceClass,
    plan::Budget,
    weather::Weather,
};
use welkin_support::{level_ground::level_ground, processor::processor_ns, textures::texture};

use super::{
    causes::{CountsBefore, FrameWork},
    day::{Pace, Rig, SEGMENTS, TICKS_PER_S},
};
use crate::copying::Copying;

type Fallible<T> = Result<T, Box<dyn std::error::Error>>;

pub const SIZE: (u32, u32) = (640, 360);
/// Frames from one measurement of a copy to the next.
const FRAMES_PER_COPY: usize = 40;
/// Frames without work on tables after which the tables are complete, and most frames to wait for that.
const SETTLED: u32 = 12;
const MOST_SETTLING: u32 = 1000;
/// Time of one call that prepares a view.
const PREPARING: Duration = Duration::from_millis(500);
/// Frames between two turns of a run that is played by turns with another.
const FRAMES_PER_TURN: u32 = 20;

/// Wall time of the calling thread and processor time of the process, ms.
#[derive(Clone, Copy, Default)]
pub struct Times {
    pub wall_ms: f64,
    pub processor_ms: f64,
}

/// A frame of the day.
pub struct PlayedFrame {
    pub tick: u32,
    pub times: Times,
    /// Wall time until the frame was submitted, ms. The rest is a wait for the driver.
    pub submitted_ms: f64,
    /// Times of a copy at about that time.
    pub copy: Times,
    pub work: FrameWork,
}

/// Turns of two runs: each waits for a line on standard input before it goes on, so that another can play meanwhile.
struct Turns {
    are_taken: bool,
    left: u32,
}

impl Turns {
    fn wait(&mut self) -> Fallible<()> {
        if self.are_taken && self.left == 0 {
            println!("turn");
            std::io::stdin().lock().read_line(&mut String::new())?;
            self.left = FRAMES_PER_TURN;
        }
        self.left = self.left.saturating_sub(1);
        Ok(())
    }
}

/// The device and the pictures of a host.
pub struct Host {
    pub device: Arc<Device>,
    shared: Arc<Shared>,
    color: wgpu::Texture,
    depth: wgpu::Texture,
    turns: Turns,
}

impl Host {
    pub fn new() -> Fallible<Self> {
        let backends = match std::env::var("RUN_BACKEND").as_deref() {
            Ok("gl") => wgpu::Backends::GL,
            _ => DeviceOptions::default().backends,
        };
        let device = Device::headless(&DeviceOptions { backends, ..DeviceOptions::default() })?;
        let shared = Arc::new(Shared::new(&device)?);
        let color = texture(&device, SIZE, wgpu::TextureFormat::Rgba16Float, 1);
        let depth = texture(&device, SIZE, wgpu::TextureFormat::R32Float, 1);
        level_ground(&device, &depth, 0.0);
        let turns = Turns { are_taken: std::env::var_os("RUN_TURNS").is_some(), left: 0 };
        Ok(Self { device, shared, color, depth, turns })
    }
}

/// A context with a view, at one tick of the day.
pub struct Player<'a> {
    host: &'a mut Host,
    pace: Pace,
    context: Context,
    view: View,
    rig: Rig,
    frame_id: u64,
    time_s: f64,
}

impl<'a> Player<'a> {
    /// Creates a player in the weather of a segment, with camera and sun as they are at `tick`.
    pub fn new(host: &'a mut Host, pace: Pace, segment: usize, tick: u32) -> Fallible<Self> {
        let mut context = Context::new(host.device.clone(), host.shared.clone(), ContextDesc::default())?;
        let mut rig = Rig::new();
        rig.advance(&pace, tick);
        context.set_default_surface_class(SurfaceClass::Paved);
        context.set_sun(Some(rig.sun()))?;
        context.set_moon(Some(Rig::moon()))?;
        context.set_weather(&Weather::from_metar(SEGMENTS[segment].report)?.weather, 0.0, 0.0)?;
        let mut view = View::new(&context)?;
        if let Ok(tolerance) = std::env::var("RUN_TOLERANCE") {
            view.set_budget(Budget { tolerance: Some(tolerance.parse()?), ..Budget::default() })?;
        }
        Ok(Self { host, pace, context, view, rig, frame_id: 0, time_s: 0.0 })
    }

    /// Prepares the view for weathers to come.
    fn prepare(&mut self, weathers: &[Weather]) -> Fallible<()> {
        let frame = Frame::new(0, self.rig.camera(), &self.host.color, Some(&self.host.depth));
        let calls = [Stages::ALL.without(Stages::TONE)];
        while self.view.prepare(&mut self.context, &frame, &calls, weathers, PREPARING)? == Status::Pending {
            self.host.turns.wait()?;
        }
        Ok(())
    }

    /// Draws a frame at the player's time.
    pub fn draw(&mut self) -> Fallible<(Times, f64, FrameWork)> {
        let (counts, wall, processor) = (CountsBefore::new(&self.host.device), Instant::now(), processor_ns());
        self.context.update(self.time_s)?;
        let submitted_ms = self.record(wall)?;
        self.finish(counts, (wall, processor), submitted_ms)
    }

    /// Records a frame; returns the wall time since `begun`, ms.
    fn record(&mut self, begun: Instant) -> Fallible<f64> {
        self.frame_id += 1;
        let frame = Frame {
            camera_velocity_m_s: self.rig.velocity_m_s(&self.pace),
            ..Frame::new(self.frame_id, self.rig.camera(), &self.host.color, Some(&self.host.depth))
        };
        self.view.record(&self.context, &frame, Stages::ALL.without(Stages::TONE))?;
        Ok(begun.elapsed().as_secs_f64() * 1e3)
    }

    /// Waits until a frame is drawn.
    fn finish(
        &mut self,
        counts: CountsBefore,
        (wall, processor): (Instant, u64),
        submitted_ms: f64,
    ) -> Fallible<(Times, f64, FrameWork)> {
        self.host.device.wait()?;
        let processor_ms = (processor_ns() - processor) as f64 * 1e-6;
        let times = Times { wall_ms: wall.elapsed().as_secs_f64() * 1e3, processor_ms };
        Ok((times, submitted_ms, counts.until_now(&self.host.device, self.view.report().tables_rebuilt)))
    }

    /// Draws frames until the sky's tables, which are built in parts, are complete. Returns their number.
    fn settle(&mut self) -> Fallible<u32> {
        let (mut quiet, mut frames) = (0, 0);
        while quiet < SETTLED && frames < MOST_SETTLING {
            self.host.turns.wait()?;
            self.draw()?;
            quiet = if self.view.report().tables_rebuilt > 0 { 0 } else { quiet + 1 };
            frames += 1;
        }
        Ok(frames)
    }

    /// Draws the next frame of the day. At the start of a segment its weather arrives.
    fn play(&mut self, weathers: &[Weather], (tick, last): (u32, Option<u32>)) -> Fallible<(Times, f64, FrameWork)> {
        let segment = tick / self.pace.segment;
        let arrives = last.is_some_and(|last| last / self.pace.segment != segment);
        let seconds = |ticks: u32| f64::from(ticks) / f64::from(TICKS_PER_S);
        self.time_s = seconds(tick);
        self.rig.advance(&self.pace, tick);
        let (counts, wall, processor) = (CountsBefore::new(&self.host.device), Instant::now(), processor_ns());
        if arrives {
            self.context.set_weather(&weathers[segment as usize], self.time_s, seconds(self.pace.transition))?;
        }
        self.context.set_sun(Some(self.rig.sun()))?;
        self.context.update(self.time_s)?;
        let submitted_ms = self.record(wall)?;
        self.finish(counts, (wall, processor), submitted_ms)
    }
}

/// Stands in for [`View::prepare`] in a build that lacks it, so that this benchmark runs with it too.
#[allow(dead_code)]
trait PreparesNothing {
    fn prepare(
        &mut self,
        _context: &mut Context,
        _frame: &Frame<'_>,
        _calls: &[Stages],
        _weathers: &[Weather],
        _most: Duration,
    ) -> welkin::Result<Status> {
        Ok(Status::Ok)
    }
}

impl PreparesNothing for View {}

/// A day that was played.
pub struct PlayedDay {
    pub frames: Vec<PlayedFrame>,
    /// Time in which the view prepared the day's weathers, s.
    pub prepared_s: f64,
    /// Number of frames in which the first weather settled.
    pub settled: u32,
}

/// Plays the day. Its weathers are prepared as behind a loading screen, unless `RUN_UNPREPARED=1`.
pub fn day(host: &mut Host, pace: Pace) -> Fallible<PlayedDay> {
    let weathers: Result<Vec<Weather>, _> =
        SEGMENTS.iter().map(|segment| Weather::from_metar(segment.report).map(|read| read.weather)).collect();
    let (weathers, copying) = (weathers?, Copying::new(&host.device, SIZE)?);
    let mut player = Player::new(host, pace, 0, 0)?;
    let begun = Instant::now();
    if std::env::var_os("RUN_UNPREPARED").is_none() {
        player.prepare(&weathers)?;
    }
    let prepared_s = begun.elapsed().as_secs_f64();
    let settled = player.settle()?;
    let (mut frames, mut copy, mut last) = (Vec::new(), Times::default(), None);
    for (i, tick) in pace.ticks().into_iter().enumerate() {
        player.host.turns.wait()?;
        if i % FRAMES_PER_COPY == 0 {
            // The first is not counted: a software driver drops the code of shaders that have not run for long.
            copying.times_ns(&player.host.device)?;
            let [wall, processor] = copying.times_ns(&player.host.device)?.map(|ns| ns * 1e-6);
            copy = Times { wall_ms: wall, processor_ms: processor };
        }
        let (times, submitted_ms, work) = player.play(&weathers, (tick, last))?;
        frames.push(PlayedFrame { tick, times, submitted_ms, copy, work });
        last = Some(tick);
    }
    Ok(PlayedDay { frames, prepared_s, settled })
}

/// Draws the weather of a segment at rest: camera and sun stand as they do at the segment's end, and time runs. Returns
/// the medians.
pub fn at_rest(host: &mut Host, pace: Pace, segment: usize) -> Fallible<Times> {
    let mut player = Player::new(host, pace, segment, (segment as u32 + 1) * pace.segment - 1)?;
    player.settle()?;
    let (mut wall, mut processor) = (Vec::new(), Vec::new());
    for _ in 0..pace.rest_frames {
        player.host.turns.wait()?;
        player.time_s += 1.0 / f64::from(TICKS_PER_S);
        let (times, ..) = player.draw()?;
        wall.push(times.wall_ms);
        processor.push(times.processor_ms);
    }
    let median = |mut all: Vec<f64>| welkin_support::processor::median(&mut all);
    Ok(Times { wall_ms: median(wall), processor_ms: median(processor) })
}

/// Draws the first picture of this process. Returns the time since `begun`, s.
pub fn first_picture(report: &str, begun: Instant) -> Fallible<f64> {
    let mut host = Host::new()?;
    let mut context = Context::new(host.device.clone(), host.shared.clone(), ContextDesc::default())?;
    context.set_sun(Some(Rig::new().sun()))?;
    context.set_weather(&Weather::from_metar(report)?.weather, 0.0, 0.0)?;
    let view = View::new(&context)?;
    let mut player =
        Player { host: &mut host, pace: Pace::asked(), context, view, rig: Rig::new(), frame_id: 0, time_s: 0.0 };
    player.draw()?;
    Ok(begun.elapsed().as_secs_f64())
}
