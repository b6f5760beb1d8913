//! Waiting for the GPU, and giving up on a GPU that does not finish.

use std::{
    sync::atomic::Ordering,
    time::{Duration, Instant},
};

use super::Device;
use crate::error::{Error, Result, Status};

/// Time without an answer after which a GPU counts as lost. A software driver on a busy machine takes seconds for a
/// pass.
const LONGEST_WAIT: Duration = Duration::from_secs(60);

impl Device {
    /// Submits `encoder` and waits until the GPU has finished. For queries, tests and measurements, not for frames.
    ///
    /// # Errors
    /// The errors of [`Device::wait`].
    pub fn submit_and_wait(&self, encoder: wgpu::CommandEncoder) -> Result<()> {
        self.submit(encoder);
        self.wait()
    }

    /// Waits until the GPU has finished everything submitted, and gives up on a GPU that needs longer than 60 s.
    ///
    /// # Errors
    /// [`Status::DeviceLost`], also if it gives up on the GPU; the first GPU fault since the last check.
    pub fn wait(&self) -> Result<()> {
        self.wait_within(LONGEST_WAIT)
    }

    /// Waits as [`Device::wait`] does, and gives up on a GPU that needs longer than `limit`.
    ///
    /// # Errors
    /// The errors of [`Device::wait`].
    pub(crate) fn wait_within(&self, limit: Duration) -> Result<()> {
        let begun = Instant::now();
        loop {
            let rest = limit.saturating_sub(begun.elapsed());
            match self.device.poll(wgpu::PollType::Wait { submission_index: None, timeout: Some(rest) }) {
                Ok(_) => return self.check(),
                // wgpu's OpenGL backend waits for at most i32::MAX ns: after 2.1 s it returns a timeout although the
                // GPU is still working.
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

    /// Marks the device as lost, and makes [`Drop`] leak wgpu's objects: wgpu would wait without a limit for the GPU
    /// before it releases them.
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
            std::mem::forget(kept); // keeps the reference counts above 0
        }
    }
}
