//! What can go wrong, said in one way everywhere: a stable status code and a sentence that names the parameter
//! and the accepted range.

use std::fmt;

/// Status of a call. The numbers are ABI: they never change and are never reused.
#[repr(i32)]
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Status {
    /// The call did what it says.
    Ok = 0,
    /// More steps are due than one update may take; call again. Not an error.
    Pending = 1,
    /// A parameter is missing, not finite or outside its range; the message names it.
    InvalidArgument = -1,
    /// A handle is dead, foreign or of another kind.
    BadHandle = -2,
    /// A parent was destroyed while it has live children.
    InUse = -3,
    /// This device, tier or build cannot do what was asked; the message names the feature.
    Unsupported = -4,
    /// No adapter or driver serves the request.
    NoAdapter = -5,
    /// The GPU device is lost; create a new device and context.
    DeviceLost = -6,
    /// Memory on the host or the GPU ran out.
    OutOfMemory = -7,
    /// A panic was caught inside an earlier call; only destroy works on this device.
    Poisoned = -8,
    /// The native queue or GL context already belongs to another device.
    AlreadyWrapped = -9,
    /// A text (METAR report, planet file, plan) does not parse; the message gives line and column.
    Parse = -10,
    /// A file could not be read or written.
    Io = -11,
    /// The surface must be configured again (resized or lost).
    SurfaceOutdated = -12,
    /// Calls came in an order that the API forbids (stages of a frame, dates before the last update).
    WrongOrder = -13,
    /// The host aborted a long operation through its callback.
    Aborted = -14,
    /// A fault inside Welkin; the message says where.
    Internal = -15,
}

/// A failed call: the status and a sentence for the person who reads the log.
#[derive(Clone, Debug, PartialEq)]
pub struct Error {
    /// Stable code.
    pub status: Status,
    /// Names the parameter and the accepted range.
    pub message: String,
}

/// Result of every fallible call of the crate.
pub type Result<T> = std::result::Result<T, Error>;

impl Error {
    /// An error of `status` with a ready sentence.
    pub fn new(status: Status, message: impl Into<String>) -> Self {
        Self { status, message: message.into() }
    }

    /// A parameter outside its range: `visibility_m must be in [1, 1e6] m, got -3`.
    pub fn range(name: &str, accepted: &str, got: impl fmt::Display) -> Self {
        Self::new(Status::InvalidArgument, format!("{name} must be {accepted}, got {got}"))
    }

    /// The same error with `prefix` before its sentence.
    #[must_use]
    pub fn within(self, prefix: &str) -> Self {
        Self { status: self.status, message: format!("{prefix}{}", self.message) }
    }

    /// A feature that this device, tier or build does not have.
    pub fn unsupported(what: impl Into<String>) -> Self {
        Self::new(Status::Unsupported, what)
    }
}

impl fmt::Display for Error {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.message)
    }
}

impl std::error::Error for Error {}

/// Most characters of a host's text that an error repeats.
const MOST_SHOWN: usize = 120;

/// A host's text as an error repeats it: its beginning, if it is long.
pub(crate) fn shown(text: &str) -> std::borrow::Cow<'_, str> {
    match text.char_indices().nth(MOST_SHOWN) {
        Some((end, _)) => format!("{}...", &text[..end]).into(),
        None => text.into(),
    }
}

/// What is wrong with a text that should be TOML: line, column and fault, without the line itself, which may be a whole state.
pub(crate) fn toml_fault(text: &str, e: &toml::de::Error) -> String {
    let Some(before) = e.span().and_then(|span| text.get(..span.start)) else {
        return format!("TOML parse error: {}", shown(e.message()));
    };
    let line = before.matches('\n').count() + 1;
    let column = before.chars().rev().take_while(|c| *c != '\n').count() + 1;
    format!("TOML parse error at line {line}, column {column}: {}", shown(e.message()))
}

/// Checks that a parameter is finite and lies in `[lo, hi]`, or says so by name.
///
/// # Errors
/// [`Status::InvalidArgument`] with the name, the range and the unit.
pub fn check_range(name: &str, value: f64, lo: f64, hi: f64, unit: &str) -> Result<()> {
    if value.is_finite() && (lo..=hi).contains(&value) {
        return Ok(());
    }
    let unit = if unit.is_empty() { String::new() } else { format!(" {unit}") };
    Err(Error::range(name, &format!("in [{lo}, {hi}]{unit}"), value))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn texts_of_hosts_are_repeated_in_part() {
        assert_eq!(shown("short"), "short");
        assert_eq!(shown(&"\u{e9}".repeat(5000)).chars().count(), MOST_SHOWN + 3);
        let text = format!("a = 1\n{} = = 2", "k".repeat(5000));
        let e = toml::from_str::<toml::Table>(&text).unwrap_err();
        let fault = toml_fault(&text, &e);
        assert!(fault.starts_with("TOML parse error at line 2, column 50") && fault.len() < 300, "{fault}");
    }

    #[test]
    fn range_check_names_parameter_range_and_unit() {
        assert!(check_range("visibility_m", 5.0, 1.0, 1e6, "m").is_ok());
        for bad in [f64::NAN, f64::INFINITY, 0.5, 2e6] {
            let e = check_range("visibility_m", bad, 1.0, 1e6, "m").unwrap_err();
            assert_eq!(e.status, Status::InvalidArgument);
            assert!(e.message.contains("visibility_m") && e.message.contains("[1, 1000000] m"), "{}", e.message);
        }
    }
}
