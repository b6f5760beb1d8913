//! Work of a device, counted for the benchmarks: pipelines, uploads, gauges, readbacks, tables.

use std::{
    sync::atomic::{AtomicU64, Ordering},
    time::Instant,
};

/// Kind of work that is counted.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum DeviceWork {
    /// Pipelines created.
    Pipelines,
    /// Time that the calling threads took to create pipelines, µs. A driver may compile more at the first draw with a
    /// pipeline.
    PipelineTime,
    /// Bytes written to buffers and textures.
    UploadBytes,
    /// Gauges drawn, plus gauge results read back.
    Gauges,
    /// Waits for the GPU to read something back.
    Readbacks,
    /// Updates in which tables of the sky were built, refined or faded.
    SkyTables,
    /// Updates of the tables of the sky as an observer sees it.
    ObserverTables,
    /// Creations and updates of the tables of clouds: the light in clouds, and the noise that clouds are cut out of.
    CloudTables,
    /// Time that the calling threads took to compute the tables of clouds, µs.
    CloudTableTime,
}

/// Totals since a device was created. Any thread may add and read them.
#[derive(Default)]
pub(crate) struct WorkTotals([AtomicU64; WorkTotals::NAMES.len()]);

impl WorkTotals {
    /// Names of the totals, in the order of [`DeviceWork`].
    pub const NAMES: [&'static str; 9] = [
        "pipelines",
        "pipelines, us",
        "uploaded bytes",
        "gauges",
        "readbacks",
        "sky tables",
        "observer's tables",
        "cloud tables",
        "cloud tables, us",
    ];

    /// Adds to a total.
    pub fn add(&self, what: DeviceWork, amount: u64) {
        self.0[what as usize].fetch_add(amount, Ordering::Relaxed);
    }

    /// Adds 1 to the total `what`, and the time since `begun`, µs, to the total `time`.
    pub fn add_timed(&self, [what, time]: [DeviceWork; 2], begun: Instant) {
        self.add(what, 1);
        self.add(time, begun.elapsed().as_micros() as u64);
    }

    /// Returns one total.
    pub fn total(&self, what: DeviceWork) -> u64 {
        self.0[what as usize].load(Ordering::Relaxed)
    }

    /// Returns the totals with their names.
    #[cfg(any(test, feature = "lab"))]
    pub fn totals(&self) -> Vec<(&'static str, u64)> {
        Self::NAMES.iter().zip(&self.0).map(|(name, total)| (*name, total.load(Ordering::Relaxed))).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::gpu::{Device, DeviceOptions, bind, flat_texture, pass, readback};

    #[test]
    fn each_total_is_counted_under_its_name() {
        let counts = WorkTotals::default();
        counts.add(DeviceWork::UploadBytes, 7);
        counts.add_timed([DeviceWork::CloudTables, DeviceWork::CloudTableTime], Instant::now());
        let total = |name| counts.totals().into_iter().find(|(known, _)| *known == name).expect("a name").1;
        assert_eq!((total("uploaded bytes"), total("cloud tables"), total("pipelines")), (7, 1, 0));
    }

    #[test]
    fn a_device_counts_pipelines_uploads_and_readbacks() {
        let options = DeviceOptions { backends: wgpu::Backends::NOOP, ..DeviceOptions::default() };
        let device = Device::headless(&options).expect("the noop backend");
        let before = device.work();
        let buffer = bind::block(&device.device, "counted", 64);
        device.write_buffer(&buffer, 0, &[0; 48]);
        let usage = wgpu::TextureUsages::COPY_DST | wgpu::TextureUsages::COPY_SRC;
        let texture = flat_texture(&device.device, "counted", (4, 2), wgpu::TextureFormat::R32Float, usage);
        let rows = wgpu::TexelCopyBufferLayout { offset: 0, bytes_per_row: Some(16), rows_per_image: None };
        device.write_texture(texture.as_image_copy(), &[0; 32], rows, texture.size());
        readback::bytes(&device, &texture, 0).expect("a readable format");
        let layout = bind::layout(&device.device, "copy", wgpu::ShaderStages::FRAGMENT, &[(0, bind::Slot::Texels)]);
        let desc = pass::FullscreenDesc {
            shader: "surface/copy.wgsl",
            entry: "copy_texels",
            layouts: &[&layout],
            targets: &[wgpu::TextureFormat::Rgba16Float.into()],
            constants: &[],
            samples: 1,
        };
        pass::fullscreen(&device, &desc).expect("a shader of this crate");
        let more = |name| {
            let total = |work: &[(&str, u64)]| work.iter().find(|(known, _)| *known == name).expect("a name").1;
            total(&device.work()) - total(&before)
        };
        assert_eq!(["uploaded bytes", "readbacks", "pipelines"].map(more), [80, 1, 1]);
    }
}
