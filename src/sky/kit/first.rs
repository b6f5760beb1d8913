//! Check on OpenGL, before the rest of a build is submitted, that the driver draws the first texel of the sky's tables.

use std::sync::atomic::Ordering;
use std::time::Duration;

use super::{Build, Kit, Name, table_named};
use crate::error::{Error, Result, Status};
use crate::gpu::readback;

/// Time after which a GPU that has not drawn one texel counts as hung. Only the host's own work can be before the texel
/// in the queue.
const LIMIT: Duration = Duration::from_secs(20);

impl Kit {
    /// Draws one texel of the first strip and waits for it. This is done on OpenGL only, until it has succeeded once.
    /// The strip draws over the texel later. NVIDIA's driver 580.159 never finishes this texel, and a wait for any
    /// frame after it would never end. Inside a host's conditional render nothing is drawn. Without this check the
    /// tables would then be taken as built although they are empty.
    ///
    /// # Errors
    /// [`Status::DeviceLost`] if the GPU does not finish. [`Status::WrongOrder`] if nothing was drawn; the next call
    /// tries again. GPU faults.
    pub(super) fn begin(&self, build: &Build) -> Result<()> {
        let caps = self.device.caps();
        if caps.backend != wgpu::Backend::Gl || self.begun.load(Ordering::Acquire) {
            return Ok(());
        }
        let level = self.level(build.set.detail);
        let mut encoder = self.device.device.create_command_encoder(&Default::default());
        self.record_strips(&mut encoder, build, 0, &level.strips[..1], Some((1, 1)));
        self.device.submit(encoder);
        let name = || caps.adapter_name.chars().take(100).collect::<String>();
        self.device.wait_within(LIMIT).map_err(|e| {
            if !self.device.is_hung() {
                return e;
            }
            let text = format!(
                "the OpenGL driver {} did not finish the first texel of the sky's tables within {} s; use Vulkan \
                 (WK_BACKEND_VULKAN, wk_device_create_vulkan)",
                name(),
                LIMIT.as_secs()
            );
            Error::new(Status::DeviceLost, text)
        })?;
        // The texel belongs to the table of norms. Its value, the sum of the haze's phase function over all directions,
        // is near 1.
        let Some(norms) = table_named(&build.set, &build.scratch, Name::Norms) else { return Ok(()) };
        let texels = readback::bytes(&self.device, &norms.texture, 0)?;
        let first = half::f16::from_le_bytes([texels[0], texels[1]]).to_f32();
        if first > 0.0 && first.is_finite() {
            self.begun.store(true, Ordering::Release);
            return Ok(());
        }
        let text = format!(
            "the OpenGL driver {} drew nothing where the sky's first table begins ({first}): end conditional rendering \
             (glEndConditionalRender) before this call",
            name()
        );
        Err(Error::new(Status::WrongOrder, text))
    }
}
