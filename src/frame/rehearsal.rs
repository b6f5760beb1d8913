//! Rehearsal of a view: the view draws coming weathers into images of its own. The pipelines of these weathers are then
//! compiled, and their first tables built, before a frame needs them.

use std::time::{Duration, Instant};

use glam::DVec3;

use super::{history::FrameHistory, rehearsed::RehearsedView, view::View};
use crate::{
    context::{Context, Rehearsal},
    error::{Error, Result, Status, check_range},
    gpu::counts::DeviceWork,
    stage::{Frame, ImageLayers, Stages},
    weather::{Conditions, Weather, derive},
};

/// Largest number of frames drawn for one moment of a weather.
pub(crate) const MOST_FRAMES: u32 = 12;
/// Longest time of one call, s.
const MOST_S: f64 = 3600.0;
/// Largest number of calls of one frame: one for each stage.
pub(crate) const MOST_CALLS: usize = 7;

impl View {
    /// Whether the view draws a rehearsal.
    pub(crate) fn rehearses(&self) -> bool {
        self.rehearsal.is_on
    }

    /// Calls `record` with the images of the rehearsal in place of the host's.
    pub(super) fn record_rehearsed(
        &mut self,
        frame: &Frame<'_>,
        record: impl FnOnce(&mut Self, &Frame<'_>) -> Result<()>,
    ) -> Result<()> {
        self.rehearsal.hold(&self.device.device, frame);
        let ([color, depth, mask, classes, normals], frame_id) = self.rehearsal.images();
        let own = Frame {
            frame_id,
            color: color.as_ref(),
            depth: depth.as_ref(),
            mask: mask.as_ref(),
            surface_classes: classes.as_ref(),
            normals: normals.as_ref(),
            layers: ImageLayers::default(),
            ..*frame
        };
        record(self, &own)
    }

    /// Draws weathers that may come, into small images of the view's own. The pipelines of these weathers are then
    /// compiled and their first tables made, so that hardly any frame waits for them when the weather comes. Each
    /// weather is drawn at several moments: while the previous weather changes to it, after the change, and with the
    /// sun at several heights. Where the context has weather regions, each weather is also drawn with them around the
    /// camera: set them before. `frame` has the settings of the coming frames, and images with the same formats,
    /// samples and usages as in these frames. The images of `frame` are not drawn into. `calls` are the stages of the
    /// calls of one frame, in order, at most seven. Call this function before the first frame or behind a loading
    /// screen: the next frame begins as a view's first one does. On return the context is as it was before the call.
    ///
    /// One call draws for about `most`, and at least one moment of a weather. [`Status::Pending`] says that moments
    /// remain: call this function again with the same weathers. Other weathers begin a new rehearsal.
    ///
    /// # Errors
    /// [`Status::InvalidArgument`] naming `weathers[i]` and the field, `calls` or the field of `frame`;
    /// [`Status::WrongOrder`] while [`Context::update_within`] has steps to do; the errors of [`View::record`].
    pub fn prepare(
        &mut self,
        context: &mut Context,
        frame: &Frame<'_>,
        calls: &[Stages],
        weathers: &[Weather],
        most: Duration,
    ) -> Result<Status> {
        let begun = Instant::now();
        let one = |(i, weather): (usize, &Weather)| derive(weather).map_err(|e| e.within(&format!("weathers[{i}]")));
        let weathers = weathers.iter().enumerate().map(one).collect::<Result<_>>()?;
        let rehearsal = self.begin_rehearsal(context, calls, weathers, frame.camera.position)?;
        while let Some(moment) = self.next_moment(&rehearsal) {
            let entered = rehearsal.enter(context, moment);
            let drawn = entered.and_then(|()| {
                for _ in 0..MOST_FRAMES {
                    let before = self.begin_rehearsed_frame();
                    let drawn = calls.iter().try_for_each(|stages| self.record(context, frame, *stages));
                    if !self.end_rehearsed_frame(before) || drawn.is_err() {
                        return drawn;
                    }
                }
                Ok(())
            });
            self.end_moment(&drawn);
            rehearsal.leave(context)?;
            drawn?;
            if begun.elapsed() >= most {
                return Ok(if self.next_moment(&rehearsal).is_some() { Status::Pending } else { Status::Ok });
            }
        }
        Ok(Status::Ok)
    }

    /// Checks the calls of a rehearsal's frames. Begins the rehearsal anew if the weathers differ from those of the
    /// last call.
    pub(crate) fn begin_rehearsal(
        &mut self,
        context: &Context,
        calls: &[Stages],
        weathers: Vec<Conditions>,
        eye: DVec3,
    ) -> Result<Rehearsal> {
        if calls.is_empty() || calls.len() > MOST_CALLS {
            return Err(Error::range("calls", &format!("1 to {MOST_CALLS}"), calls.len()));
        }
        calls.iter().try_for_each(|stages| Stages::from_bits(stages.0).map(|_| ())).map_err(|e| e.within("calls"))?;
        let rehearsal = Rehearsal::new(context, weathers, eye)?;
        if self.rehearsal.weathers != rehearsal.weathers() {
            (self.rehearsal.weathers, self.rehearsal.done) = (rehearsal.weathers().to_vec(), 0);
        }
        Ok(rehearsal)
    }

    /// Returns the next moment to draw. After the last moment it returns `None`, and the next rehearsal begins anew.
    pub(crate) fn next_moment(&mut self, rehearsal: &Rehearsal) -> Option<usize> {
        let done = self.rehearsal.done;
        if done < rehearsal.moments() {
            return Some(done);
        }
        let frames = self.rehearsal.frames;
        self.rehearsal = RehearsedView::default();
        self.rehearsal.frames = frames;
        None
    }

    /// Begins a frame of a rehearsal: the calls that follow draw into the view's own images. Returns the number of
    /// pipelines that the device has created.
    pub(crate) fn begin_rehearsed_frame(&mut self) -> u64 {
        self.rehearsal.is_on = true;
        self.device.counts.total(DeviceWork::Pipelines)
    }

    /// Ends a frame of a rehearsal. Returns whether the frame created pipelines. Another frame is then due, because on
    /// a GPU each frame creates only one large pipeline.
    pub(crate) fn end_rehearsed_frame(&mut self, pipelines_before: u64) -> bool {
        self.rehearsal.is_on = false;
        self.rehearsal.frames += 1;
        self.device.counts.total(DeviceWork::Pipelines) > pipelines_before
    }

    /// Ends a moment of a rehearsal. The view then has neither history nor images, as before its first frame. If
    /// `drawn` is an error, the moment is due again.
    pub(crate) fn end_moment(&mut self, drawn: &Result<()>) {
        self.history = FrameHistory::default();
        self.cache.forget_images();
        self.effects.each().into_iter().for_each(|effect| effect.forget_picture());
        self.rehearsal.done += usize::from(drawn.is_ok());
    }
}

/// Converts the time limit of a call, s, [0, 3600].
///
/// # Errors
/// [`Status::InvalidArgument`] naming `most_s`.
pub(crate) fn time_limit(most_s: f64) -> Result<Duration> {
    check_range("most_s", most_s, 0.0, MOST_S, "s")?;
    Ok(Duration::from_secs_f64(most_s))
}
