//! Errors, all of one form: a stable status code, the path of the wrong field, if the error is about one, and a
//! sentence that begins with the field and says what is accepted.

use std::{borrow::Cow, fmt};

/// Status of a call. The numbers are ABI: they never change and are never reused.
#[repr(i32)]
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Status {
    /// The call did what it says.
    Ok = 0,
    /// Not a fault: more steps are due than one call may take, or a window shows nothing now. Call again.
    Pending = 1,
    /// A parameter is missing, not finite or outside its range; the message names it.
    InvalidArgument = -1,
    /// A handle is dead, foreign or of another kind.
    BadHandle = -2,
    /// The call would destroy a parent that has live children.
    InUse = -3,
    /// This device, tier or build does not support the request; the message names the feature.
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
    /// A text or file (METAR report, planet, plan, saved state) does not parse; the message gives the line and column,
    /// or the field.
    Parse = -10,
    /// A file could not be read or written.
    Io = -11,
    /// The surface must be configured again (resized or lost).
    SurfaceOutdated = -12,
    /// Calls came in an order that the API forbids (such as stages of a frame, or a time before the last update).
    WrongOrder = -13,
    /// The host aborted a long operation through its callback.
    Aborted = -14,
    /// A fault inside Welkin; the message says where.
    Internal = -15,
}

/// A failed call: the status, the parameter or field that is wrong, and a sentence for the reader of the log.
///
/// `to_string()` gives the whole sentence: where the fault was found, the field, what is accepted, what was given.
#[derive(Clone, Debug, PartialEq)]
pub struct Error {
    /// Stable code.
    pub status: Status,
    /// Place where the field was found, if not in a parameter (`saved state: `); mostly empty.
    place: String,
    /// Path of the field; empty if the error is about no single field.
    field: String,
    /// Text that follows the field, with its own leading space or colon; the whole sentence if there is no field.
    rest: String,
}

/// Result of every fallible call of the crate.
pub type Result<T> = std::result::Result<T, Error>;

impl Error {
    /// Creates an error about no single field, from its whole sentence. For [`Status::InvalidArgument`], which is
    /// always about a field, use [`Error::invalid`].
    pub fn new(status: Status, sentence: impl Into<String>) -> Self {
        debug_assert!(status != Status::InvalidArgument, "an invalid argument has a name");
        Self { status, place: String::new(), field: String::new(), rest: sentence.into() }
    }

    /// Creates an error about a field. The sentence is the field, followed by `rest`.
    pub fn about(status: Status, field: impl Into<String>, rest: impl fmt::Display) -> Self {
        Self { status, place: String::new(), field: field.into(), rest: short_numerals(format!(" {rest}")) }
    }

    /// Creates a [`Status::InvalidArgument`] about a field: `get_proc must not be NULL`.
    pub fn invalid(field: impl Into<String>, rest: impl fmt::Display) -> Self {
        Self::about(Status::InvalidArgument, field, rest)
    }

    /// Creates the error of a field outside its range: `visibility_m must be in [1, 1e6] m, got -3`. Of a long value,
    /// only the beginning is shown.
    pub fn range(field: &str, accepted: &str, got: impl fmt::Display) -> Self {
        let got = short_numerals(got.to_string());
        Self::invalid(field, format_args!("must be {accepted}, got {}", shown(&got)))
    }

    /// Creates the error for a feature that this device, tier or build does not have.
    pub fn unsupported(what: impl Into<String>) -> Self {
        Self::new(Status::Unsupported, what)
    }

    /// Returns the path of the parameter or field that the error is about, such as `camera.view`,
    /// `shelters[2].half_size_m` or `time_s`; `None` if it is about none. Every [`Status::InvalidArgument`] has one.
    pub fn field(&self) -> Option<&str> {
        (!self.field.is_empty()).then_some(self.field.as_str())
    }

    /// Returns the error with its field inside `outer`: `wishes[0].rung` within `budget` is `budget.wishes[0].rung`. An
    /// error about no field becomes one about `outer`.
    #[must_use]
    pub fn within(mut self, outer: &str) -> Self {
        if self.field.is_empty() {
            return self.in_text(outer);
        }
        let dot = if self.field.starts_with('[') { "" } else { "." };
        self.field = format!("{outer}{dot}{}", self.field);
        self
    }

    /// Returns the error with `old`, the first segments of the field's path, replaced by `new`. A path that does not
    /// begin with `old` stays as it is.
    #[must_use]
    pub fn renamed(mut self, old: &str, new: &str) -> Self {
        if let Some(rest) = self.field.strip_prefix(old)
            && (rest.is_empty() || rest.starts_with(['.', '[']))
        {
            self.field = format!("{new}{rest}");
        }
        self
    }

    /// Returns the error with its field renamed by `name`.
    #[must_use]
    pub(crate) fn map_field(mut self, name: impl FnOnce(&str) -> String) -> Self {
        if !self.field.is_empty() {
            self.field = name(&self.field);
        }
        self
    }

    /// Returns the error as one about `parameter`, the text or bytes in which the error was found. The field inside the
    /// text stays in the sentence only.
    #[must_use]
    pub fn in_text(self, parameter: &str) -> Self {
        let inner = self
            .field
            .strip_prefix(parameter)
            .filter(|f| self.place.is_empty() && (f.is_empty() || f.starts_with('.')));
        let rest = inner.map_or_else(|| format!(": {self}"), |inner| format!("{inner}{}", self.rest));
        Self { status: self.status, place: String::new(), field: parameter.into(), rest }
    }

    /// Returns the error as found at `place`: its sentence begins `place: `.
    #[must_use]
    pub fn found_in(mut self, place: impl fmt::Display) -> Self {
        self.place = format!("{place}: {}", self.place);
        self
    }

    /// Returns the error with another status.
    #[must_use]
    pub fn with_status(self, status: Status) -> Self {
        Self { status, ..self }
    }

    /// Joins a list of errors into one error about the first one's field; returns `Ok` for an empty list.
    ///
    /// # Errors
    /// The first error. Its sentence is followed by those of the other errors. A sentence that would become too long
    /// ends with the number of errors left out.
    pub fn all(errors: impl IntoIterator<Item = Self>) -> Result<()> {
        let mut errors = errors.into_iter();
        let Some(mut all) = errors.next() else { return Ok(()) };
        let mut left_out = 0;
        for e in errors {
            let next = format!("; {e}");
            if left_out == 0 && all.to_string().len() + next.len() <= MOST_JOINED {
                all.rest += &next;
            } else {
                left_out += 1;
            }
        }
        if left_out > 0 {
            all.rest += &format!("; and {left_out} more");
        }
        Err(all)
    }
}

impl fmt::Display for Error {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}{}{}", self.place, self.field, self.rest)
    }
}

impl std::error::Error for Error {}

/// Largest number of characters of a host's text that an error repeats.
const MOST_SHOWN: usize = 120;
/// Largest size of a sentence that several errors are joined into, bytes. It is that large because one error names
/// everything that a host's device or image lacks.
const MOST_JOINED: usize = 1500;
/// Largest number of characters of a numeral; [`short_numerals`] rewrites longer ones.
const MOST_NUMERAL: usize = 24;

/// Rewrites the long numerals of a sentence in exponent form: written out, the smallest number has 326 characters and
/// the largest 309.
fn short_numerals(sentence: String) -> String {
    let is_numeral = |c: char| c.is_ascii_digit() || c == '.';
    if !sentence.split(|c| !is_numeral(c)).any(|run| run.len() > MOST_NUMERAL) {
        return sentence;
    }
    let mut short = String::new();
    for piece in sentence.split_inclusive(|c| !is_numeral(c)) {
        let run = piece.trim_end_matches(|c| !is_numeral(c));
        match run.parse::<f64>() {
            Ok(v) if run.len() > MOST_NUMERAL && v.is_finite() => short += &format!("{v:e}{}", &piece[run.len()..]),
            _ => short += piece,
        }
    }
    short
}

/// Largest size of the accepted names that an error lists, bytes.
const MOST_LISTED: usize = 110;

/// Returns a list of accepted names for an error: all names, or the first ones and the last one if they are many.
pub(crate) fn listed(names: &[&str]) -> String {
    let all = names.join(", ");
    let [first @ .., last] = names else { return all };
    if all.len() <= MOST_LISTED {
        return all;
    }
    let more = |shown: usize| format!(", {} more to {last}", first.len() - shown);
    let mut text = String::new();
    for (shown, name) in first.iter().enumerate() {
        if shown > 0 && text.len() + 2 + name.len() + more(shown + 1).len() > MOST_LISTED {
            return text + &more(shown);
        }
        text += if shown > 0 { ", " } else { "" };
        text += name;
    }
    format!("{text}, {last}")
}

/// Returns a number as an error shows it.
pub(crate) fn number(v: f64) -> String {
    short_numerals(v.to_string())
}

/// Returns a host's text as an error repeats it: only its beginning if it is long.
pub(crate) fn shown(text: &str) -> Cow<'_, str> {
    beginning(text, MOST_SHOWN)
}

/// Returns the first `most` characters of a text, with dots if there are more.
pub(crate) fn beginning(text: &str, most: usize) -> Cow<'_, str> {
    match text.char_indices().nth(most) {
        Some((end, _)) => format!("{}...", &text[..end]).into(),
        None => text.into(),
    }
}

/// Describes an error that the TOML parser found in a text: line and column, if the error has them, and fault. The line
/// itself is left out because it may hold a whole state.
pub fn toml_fault(text: &str, e: &toml::de::Error) -> String {
    let Some(before) = e.span().and_then(|span| text.get(..span.start)) else {
        return format!("TOML parse error: {}", toml_message(e));
    };
    let line = before.matches('\n').count() + 1;
    let column = before.chars().rev().take_while(|c| *c != '\n').count() + 1;
    format!("TOML parse error at line {line}, column {column}: {}", toml_message(e))
}

/// Returns the parser's message, or one that gives the range of a number that is too large: the parser's message does
/// not name that range.
pub fn toml_message(e: &toml::de::Error) -> Cow<'_, str> {
    let says = |words: &str| e.message().contains(words);
    shown(if ["` as i128", "` as u128", "integer number overflowed"].into_iter().any(says) {
        "an integer must lie in [-2^63, 2^63 - 1]"
    } else if says("floating-point number overflowed") {
        "a number must be at most 1.79e308 in amount"
    } else {
        e.message()
    })
}

/// Checks that a parameter is finite and lies in `[lo, hi]`.
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
    fn numbers_beyond_toml_get_their_range() {
        for digits in [20, 30, 60] {
            let text = format!("a = {}", "9".repeat(digits));
            let fault = toml_fault(&text, &toml::from_str::<toml::Table>(&text).unwrap_err());
            assert!(fault.ends_with("an integer must lie in [-2^63, 2^63 - 1]"), "{fault}");
        }
        let text = "a = 1e999";
        let fault = toml_fault(text, &toml::from_str::<toml::Table>(text).unwrap_err());
        assert!(fault.ends_with("a number must be at most 1.79e308 in amount"), "{fault}");
    }

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
    fn many_accepted_names_are_counted() {
        assert_eq!(listed(&["air", "fog", "rain"]), "air, fog, rain");
        let names: Vec<String> = (0..28).map(|i| format!("WK_NAME_{i}")).collect();
        let names: Vec<&str> = names.iter().map(String::as_str).collect();
        let text = listed(&names);
        assert!(text.len() <= MOST_LISTED && text.starts_with("WK_NAME_0, WK_NAME_1, "), "{text}");
        assert!(text.ends_with(" more to WK_NAME_27"), "{text}");
        let shown = text.matches("WK_NAME_").count();
        assert!(text.contains(&format!(", {} more", 28 - shown)), "{text}");
    }

    #[test]
    fn messages_stay_short_whatever_is_given() {
        let hostile = [
            f64::NAN,
            f64::INFINITY,
            f64::NEG_INFINITY,
            f64::MAX,
            f64::MIN,
            f64::MIN_POSITIVE,
            5e-324,
            -4.9e-310,
            1.7e-300,
            -0.0,
            1.0 / 3.0,
            -123_456.789_012_345_67,
            1e21,
            f64::from(f32::MIN_POSITIVE),
        ];
        for v in hostile {
            let matrix = glam::DMat4::from_cols_array(&[v; 16]);
            let made = [
                Error::range("camera.view", "a rigid world-to-eye matrix (rotation, no scale)", matrix),
                Error::range(
                    "shelter.axes",
                    "three unit vectors at right angles",
                    glam::DMat3::from_cols_array(&[v; 9]),
                ),
                Error::range("ray.direction", "finite", format!("{:?}", [v; 16])),
                Error::range("position", "finite and within 1e12 m", glam::DVec3::splat(v)),
                Error::range(
                    "position",
                    &format!("in [{v}, {v}] m"),
                    format_args!("{v} m at {}", glam::DVec3::splat(v)),
                ),
                Error::about(Status::WrongOrder, "flash.time_s", format_args!("must be at least {v} s, got {v}")),
                Error::invalid("value", format_args!("{}", v as f32)),
                Error::range("name", "a name", "x".repeat(5000)),
                Error::new(Status::WrongOrder, format!("time_s must be at least {} s, got {}", number(v), number(-v))),
            ];
            let checked = check_range("visibility_m", v, 5e-324, 5e-324, "m").err();
            for e in made.iter().chain(&checked) {
                let text = e.to_string();
                assert!(text.len() < 300, "{} bytes: {text}", text.len());
                let longest = text.split(|c: char| !(c.is_ascii_digit() || c == '.')).map(str::len).max();
                assert!(longest <= Some(MOST_NUMERAL), "{text}");
            }
        }
        let text = |v: f64| Error::range("a", "b", v).to_string();
        assert_eq!(text(5e-324), "a must be b, got 5e-324");
        assert_eq!(text(-f64::MAX), "a must be b, got -1.7976931348623157e308");
        assert_eq!(text(0.1), "a must be b, got 0.1");
        let two = Error::range("a", "b", glam::DVec2::new(-1e-310, 2.5)).to_string();
        assert_eq!(two, "a must be b, got [-1e-310, 2.5]");
        assert!(Error::range("name", "a name", "7".repeat(5000)).to_string().len() < 300);
        let all = |count| Error::all(vec![Error::range("a", "b", "c".repeat(100)); count]).unwrap_err().to_string();
        assert!(!all(9).contains("more") && all(9).matches("a must be b").count() == 9, "{}", all(9));
        assert!(all(40).ends_with(" more") && all(40).len() < MOST_JOINED + 20, "{}", all(40));
    }

    #[test]
    fn range_check_names_parameter_range_and_unit() {
        assert!(check_range("visibility_m", 5.0, 1.0, 1e6, "m").is_ok());
        for bad in [f64::NAN, f64::INFINITY, 0.5, 2e6] {
            let e = check_range("visibility_m", bad, 1.0, 1e6, "m").unwrap_err();
            assert_eq!(e.status, Status::InvalidArgument);
            assert_eq!(e.field(), Some("visibility_m"));
            assert!(e.to_string().starts_with("visibility_m must be in [1, 1000000] m, got "), "{e}");
        }
    }

    #[test]
    fn fields_are_placed_and_renamed_as_values() {
        let e = Error::range("view", "rigid", "depth.view");
        let text = |e: &Error| (e.field().map(str::to_owned), e.to_string());
        let is = |e: &Error, field: &str, sentence: &str| assert_eq!(text(e), (Some(field.into()), sentence.into()));
        is(&e.clone().within("camera"), "camera.view", "camera.view must be rigid, got depth.view");
        is(&e.clone().within("maps[1]").renamed("maps", "m"), "m[1].view", "m[1].view must be rigid, got depth.view");
        is(&e.clone().renamed("vie", "x"), "view", "view must be rigid, got depth.view");
        is(
            &e.clone().found_in("line 2").found_in("state"),
            "view",
            "state: line 2: view must be rigid, got depth.view",
        );
        is(&e.clone().found_in("state").in_text("bytes"), "bytes", "bytes: state: view must be rigid, got depth.view");
        is(&e.clone().in_text("view"), "view", "view must be rigid, got depth.view");
        is(&e.clone().within("plan").in_text("plan"), "plan", "plan.view must be rigid, got depth.view");
        assert_eq!(Error::all([]), Ok(()));
        is(
            &Error::all([e.clone(), e.clone()]).unwrap_err(),
            "view",
            "view must be rigid, got depth.view; view must be rigid, got depth.view",
        );
        let none = Error::new(Status::Parse, "line 3: expected a number");
        assert_eq!(text(&none), (None, "line 3: expected a number".into()));
        is(&none.within("planet_toml"), "planet_toml", "planet_toml: line 3: expected a number");
    }
}
