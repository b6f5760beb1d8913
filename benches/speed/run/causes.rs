//! Causes of slow frames: what a device did beyond drawing, counted and logged.

use std::sync::{Mutex, PoisonError};

use welkin::gpu::Device;

/// Uploads from which they count as a cause, bytes. A frame at rest uploads a few kB.
const MUCH_UPLOADED: u64 = 64 << 10;

/// Totals of a device, by name.
type Totals = Vec<(&'static str, u64)>;

/// Empty totals for older versions of the library, whose devices have no `work`. Rust prefers a device's own `work` if
/// there is one.
#[allow(dead_code)]
trait CountsNothing {
    fn work(&self) -> Totals;
}

impl CountsNothing for Device {
    fn work(&self) -> Totals {
        Totals::new()
    }
}

/// Collects what the library logs about its pipelines.
struct PipelineLog(Mutex<Vec<String>>);

static PIPELINES: PipelineLog = PipelineLog(Mutex::new(Vec::new()));

impl log::Log for PipelineLog {
    fn enabled(&self, metadata: &log::Metadata<'_>) -> bool {
        metadata.target().starts_with("welkin")
    }

    fn log(&self, record: &log::Record<'_>) {
        if self.enabled(record.metadata())
            && let Some(pipeline) = record.args().to_string().strip_prefix("pipeline ")
        {
            self.0.lock().unwrap_or_else(PoisonError::into_inner).push(pipeline.to_owned());
        }
    }

    fn flush(&self) {}
}

/// Begins to collect the names of pipelines.
pub fn listen() {
    if log::set_logger(&PIPELINES).is_ok() {
        log::set_max_level(log::LevelFilter::Debug);
    }
}

/// Work beyond drawing during one frame.
#[derive(Clone, Default)]
pub struct FrameWork {
    /// Amounts above 0, by name.
    amounts: Totals,
    /// Pipelines: entry point, shader, and time of the calling thread.
    pub pipelines: Vec<String>,
    /// Tables that the view's report counts.
    tables: u32,
}

/// Counts of a device when a frame begins.
pub struct CountsBefore(Totals);

impl CountsBefore {
    pub fn new(device: &Device) -> Self {
        PIPELINES.0.lock().unwrap_or_else(PoisonError::into_inner).clear();
        Self(device.work())
    }

    /// Returns the work since then. `tables` is the number in the view's report.
    pub fn until_now(self, device: &Device, tables: u32) -> FrameWork {
        let grown = device.work().into_iter().zip(self.0);
        let amounts = grown.map(|((name, now), (_, then))| (name, now - then)).filter(|(_, more)| *more > 0).collect();
        let pipelines = std::mem::take(&mut *PIPELINES.0.lock().unwrap_or_else(PoisonError::into_inner));
        FrameWork { amounts, pipelines, tables }
    }
}

impl FrameWork {
    fn amount(&self, wanted: &str) -> u64 {
        self.amounts.iter().find(|(name, _)| *name == wanted).map_or(0, |(_, amount)| *amount)
    }

    /// Returns the causes for which a frame may be slow, or what is left if none is counted.
    pub fn causes(&self) -> String {
        let (sky, observer) = (self.amount("sky tables") > 0, self.amount("observer's tables") > 0);
        let found = [
            ("pipeline", self.amount("pipelines") > 0),
            ("sky table", sky),
            ("observer's table", observer),
            ("table", self.tables > 0 && !sky && !observer),
            ("cloud table", self.amount("cloud tables") > 0),
            ("upload", self.amount("uploaded bytes") >= MUCH_UPLOADED),
            ("gauge", self.amount("gauges") > 0),
            ("readback", self.amount("readbacks") > 0),
        ];
        let names: Vec<&str> = found.into_iter().filter(|(_, is_there)| *is_there).map(|(name, _)| name).collect();
        if names.is_empty() { "nothing counted".to_owned() } else { names.join(" + ") }
    }

    /// Returns all amounts in words.
    pub fn details(&self) -> String {
        let mut all: Vec<String> = self.amounts.iter().map(|(name, amount)| format!("{name} {amount}")).collect();
        if self.tables > 0 {
            all.push(format!("tables in the report {}", self.tables));
        }
        all.extend(self.pipelines.iter().map(|pipeline| format!("[{pipeline}]")));
        all.join("; ")
    }
}
