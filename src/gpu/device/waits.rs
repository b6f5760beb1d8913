//! Waiting for the GPU, and giving up on one that does not finish.

use std::{
    sync::atomic::Ordering,
    time::{Duration, Instant},
};

use super::Device;
use crate::error::{Error, Result, Status};

/// After so long without an answer a GPU counts as lost. A software driver on a busy machine takes seconds for a pass.
const LONGEST_WAIT: Duration = Duration::from_secs(60);

impl Device {
    /// Submits, and waits until the GPU has finished. For queries, tests and measurements, not for frames.
    ///
    /// # Errors
    /// [`Status::DeviceLost`], or the first GPU fault.
    pub fn submit_and_wait(&self, encoder: wgpu::CommandEncoder) -> Result<()> {
        self.submit(encoder);
        self.wait()
    }

    /// Waits until the GPU has finished what was submitted.
    ///
    /// # Errors
    /// [`Status::DeviceLost`], or the first GPU fault.
    pub fn wait(&self) -> Result<()> {
        self.wait_within(LONGEST_WAIT)
    }

    /// As [`Device::wait`], no longer than so; a GPU that needs longer is given up.
    ///
    /// # Errors
    /// As [`Device::wait`].
    pub(crate) fn wait_within(&self, limit: Duration) -> Result<()> {
        let begun = Instant::now();
        loop {
            let rest = limit.saturating_sub(begun.elapsed());
            match self.device.poll(wgpu::PollType::Wait { submission_index: None, timeout: Some(rest) }) {
                Ok(_) => return self.check(),
                // wgpu's OpenGL backend waits for i32::MAX ns at most: after 2.1 s it answers with a timeout, though
                // the GPU still works.
                Err(wgpu::PollError::Timeout) if begun.elapsed() < limit => self.check()?,
                Err(e) => {
                    if matches!(e, wgpu::PollError::Timeout) {
                        self.give_up();
                    }
                    return Err(Error::new(Status::DeviceLost, format!("waiting for the GPU failed: {e}")));
                }
            }
        }
    }

    /// Counts the device as lost, and keeps wgpu's objects for ever: to release them wgpu waits for the GPU without a
    /// limit.
    pub(crate) fn give_up(&self) {
        self.faults.lost.store(true, Ordering::Release);
        self.faults.hung.store(true, Ordering::Release);
    }

    /// Whether the GPU did not finish within a limit.
    pub(crate) fn is_hung(&self) -> bool {
        self.faults.hung.load(Ordering::Acquire)
    }
}

impl Drop for Device {
    fn drop(&mut self) {
        if self.is_hung() {
            let kept = (self.instance.clone(), self.adapter.clone(), self.device.clone(), self.queue.clone());
            std::mem::forget(kept); // counts that never fall to 0
        }
    }
}
