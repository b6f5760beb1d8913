//! Command line of the probe: questions and their options. Everything else is refused.

use std::io::Read as _;
use std::sync::Arc;

use welkin::flow::Scheme;
use welkin::gpu::{Device, DeviceOptions};
use welkin::sky::probe::{Probe, Question};
use welkin::sky::{Planet, SkyModel, SkySettings};
use welkin::{Error, Result, Status};

use crate::{cloud_shape, clouds, flow, fog, lightning, rain, sea, sky, snow, soil};

/// Usage text with every question and option.
pub const USAGE: &str = "usage: probe sky|aerial|irradiance --planet FILE [--model NAME] < rays.csv\n       \
                     probe fog --visibility METRES < distances.csv\n       \
                     probe rain-speed < diameters.csv\n       \
                     probe snow-speed < flakes.csv\n       \
                     probe rain < rates.csv\n       \
                     probe ice < rates.csv\n       \
                     probe slab < slabs.csv\n       \
                     probe cover --genus NAME --okta 0..8 --seeds N\n       \
                     probe cloud-shape --genus NAME --okta 0..8 --seeds N [--pixel METRES]\n       \
                     probe soil-force < cuts.csv\n       \
                     probe soil-wall < walls.csv\n       \
                     probe soil-sinkage < plates.csv\n       \
                     probe soil-heap < heaps.csv\n       \
                     probe lightning --rate FLASHES_A_MINUTE --hours H\n       \
                     probe cavity --re R --n N\n       \
                     probe taylor-green --n N --cfl C [--scheme NAME]\n       \
                     probe wind --scene FILE < places.csv\n       \
                     probe sea --hs METRES --tp SECONDS --depth METRES [--seed S]\n       \
                     probe sea-at --hs METRES --tp SECONDS --depth METRES [--seed S] < places.csv\n       \
                     probe --help | --version";

/// Options by name, each with its value.
struct Options(Vec<(String, String)>);

impl Options {
    fn parse(known: &[&str], mut rest: impl Iterator<Item = String>) -> Result<Self> {
        let mut out = Vec::new();
        while let Some(name) = rest.next() {
            if !known.contains(&name.as_str()) {
                return Err(usage(&format!("unknown option `{name}` of this question")));
            }
            let value = rest.next().ok_or_else(|| usage(&format!("{name} has no value")))?;
            out.push((name, value));
        }
        Ok(Self(out))
    }

    fn get(&self, name: &str) -> Option<&str> {
        self.0.iter().rev().find(|(n, _)| n == name).map(|(_, v)| v.as_str())
    }
}

fn usage(what: &str) -> Error {
    Error::new(Status::Parse, format!("{what}\n{USAGE}"))
}

fn read_input() -> Result<String> {
    let mut bytes = Vec::new();
    let failed = |e: std::io::Error| Error::new(Status::Io, format!("reading standard input: {e}"));
    std::io::stdin().read_to_end(&mut bytes).map_err(failed)?;
    String::from_utf8(bytes).map_err(|e| {
        let before = &e.as_bytes()[..e.utf8_error().valid_up_to()];
        let line = before.iter().filter(|b| **b == b'\n').count() + 1;
        let start = before.iter().rposition(|b| *b == b'\n').map_or(0, |i| i + 1);
        let column = String::from_utf8_lossy(&before[start..]).chars().count() + 1;
        Error::new(Status::Parse, format!("line {line}, column {column}: not UTF-8"))
    })
}

fn device() -> Result<Arc<Device>> {
    Device::headless(&DeviceOptions::default())
}

fn sky(question: Question, rest: impl Iterator<Item = String>) -> Result<String> {
    let options = Options::parse(&["--planet", "--model"], rest)?;
    let path = options.get("--planet").ok_or_else(|| usage("--planet is missing"))?;
    let text = std::fs::read_to_string(path).map_err(|e| Error::new(Status::Io, format!("{path}: {e}")))?;
    let planet = Planet::from_toml(&text).map_err(|e| Error::new(e.status, format!("{path}: {e}")))?;
    let model = options.get("--model").map_or(Ok(SkyModel::default()), SkyModel::from_name)?;
    let input = read_input()?;
    let mut probe = Probe::new(&device()?, &SkySettings::with_model(model), &planet)?;
    sky::rays(&mut probe, question, &input)
}

fn fog(rest: impl Iterator<Item = String>) -> Result<String> {
    let options = Options::parse(&["--visibility"], rest)?;
    let text = options.get("--visibility").ok_or_else(|| usage("--visibility is missing"))?;
    let visibility = text.parse().map_err(|_| usage(&format!("--visibility is no number: {text:?}")))?;
    let input = read_input()?;
    fog::distances(&*device()?, visibility, &input)
}

impl Options {
    fn given(&self, name: &str) -> Result<&str> {
        self.get(name).ok_or_else(|| usage(&format!("{name} is missing")))
    }

    fn number(&self, name: &str, most: f64) -> Result<f64> {
        let text = self.given(name)?;
        let value = text.parse::<f64>().ok().filter(|v| (0.0..=most).contains(v));
        value.ok_or_else(|| usage(&format!("{name} must be a number from 0 to {most}, not {text:?}")))
    }
}

fn cover(rest: impl Iterator<Item = String>) -> Result<String> {
    let options = Options::parse(&["--genus", "--okta", "--seeds"], rest)?;
    let (okta, seeds) = (options.number("--okta", 8.0)?, options.number("--seeds", 1e4)?);
    clouds::cover(options.given("--genus")?, okta / 8.0, seeds.max(1.0) as u64)
}

fn shape(rest: impl Iterator<Item = String>) -> Result<String> {
    let options = Options::parse(&["--genus", "--okta", "--seeds", "--pixel"], rest)?;
    let (okta, seeds) = (options.number("--okta", 8.0)?, options.number("--seeds", 1e3)?);
    let pixel_m = options.get("--pixel").map_or(Ok(cloud_shape::PIXEL_M), |_| options.any_number("--pixel"))?;
    cloud_shape::answer(options.given("--genus")?, okta / 8.0, seeds.max(1.0) as u64, pixel_m)
}

fn lightning(rest: impl Iterator<Item = String>) -> Result<String> {
    let options = Options::parse(&["--rate", "--hours"], rest)?;
    lightning::flashes(options.number("--rate", 60.0)?, options.number("--hours", 1000.0)?)
}

impl Options {
    /// A number. The question checks its range.
    fn any_number(&self, name: &str) -> Result<f64> {
        let text = self.given(name)?;
        text.parse().map_err(|_| usage(&format!("{name} must be a number, not {text:?}")))
    }

    fn count(&self, name: &str) -> Result<u32> {
        let text = self.given(name)?;
        text.parse().map_err(|_| usage(&format!("{name} must be a whole number, not {text:?}")))
    }
}

fn cavity(rest: impl Iterator<Item = String>) -> Result<String> {
    let options = Options::parse(&["--re", "--n"], rest)?;
    flow::centre_line(options.any_number("--re")?, options.count("--n")?)
}

fn taylor_green(rest: impl Iterator<Item = String>) -> Result<String> {
    let options = Options::parse(&["--n", "--cfl", "--scheme"], rest)?;
    let scheme = options.get("--scheme").map_or(Ok(Scheme::default()), Scheme::from_name)?;
    flow::taylor_green(options.count("--n")?, options.any_number("--cfl")?, scheme)
}

fn wind(rest: impl Iterator<Item = String>) -> Result<String> {
    let options = Options::parse(&["--scene"], rest)?;
    let path = options.given("--scene")?;
    let text = std::fs::read_to_string(path).map_err(|e| Error::new(Status::Io, format!("{path}: {e}")))?;
    flow::wind(&text, &read_input()?)
}

/// Answers `sea`, or `sea-at` with the places of the standard input.
fn sea(is_at: bool, rest: impl Iterator<Item = String>) -> Result<String> {
    let options = Options::parse(&["--hs", "--tp", "--depth", "--seed"], rest)?;
    let [hs_m, tp_s] = [options.any_number("--hs")?, options.any_number("--tp")?];
    let depth_m = options.any_number("--depth")?;
    let seed = options.get("--seed").map_or(Ok(0), |_| options.count("--seed"))?.into();
    if is_at { sea::surface(hs_m, tp_s, depth_m, seed, &read_input()?) } else { sea::modes(hs_m, tp_s, depth_m, seed) }
}

/// Answers `soil-sinkage`; its warnings go to standard error.
fn sinkages(input: &str) -> Result<String> {
    let (answers, warnings) = soil::sinkages(input)?;
    for warning in warnings {
        eprintln!("probe: {warning}");
    }
    Ok(answers)
}

/// Runs the question of a command line, without its first word, on the text from standard input.
///
/// # Errors
/// Unknown questions and options; errors in the input, by line and column; files; the GPU.
pub fn run(mut arguments: impl Iterator<Item = String>) -> Result<String> {
    let what = arguments.next().ok_or_else(|| usage("no question"))?;
    match what.as_str() {
        "sky" => sky(Question::Sky, arguments),
        "aerial" => sky(Question::Aerial, arguments),
        "irradiance" => sky(Question::Irradiance, arguments),
        "fog" => fog(arguments),
        "rain-speed" => Options::parse(&[], arguments).and_then(|_| rain::speeds(&read_input()?)),
        "snow-speed" => Options::parse(&[], arguments).and_then(|_| snow::speeds(&read_input()?)),
        "rain" => Options::parse(&[], arguments).and_then(|_| rain::rates(&read_input()?)),
        "ice" => Options::parse(&[], arguments).and_then(|_| rain::ice(&read_input()?)),
        "slab" => Options::parse(&[], arguments).and_then(|_| clouds::slabs(&*device()?, &read_input()?)),
        "cover" => cover(arguments),
        "cloud-shape" => shape(arguments),
        "soil-force" => Options::parse(&[], arguments).and_then(|_| soil::forces(&read_input()?)),
        "soil-wall" => Options::parse(&[], arguments).and_then(|_| soil::walls(&read_input()?)),
        "soil-sinkage" => Options::parse(&[], arguments).and_then(|_| sinkages(&read_input()?)),
        "soil-heap" => Options::parse(&[], arguments).and_then(|_| soil::heaps(&read_input()?)),
        "lightning" => lightning(arguments),
        "cavity" => cavity(arguments),
        "wind" => wind(arguments),
        "sea" => sea(false, arguments),
        "sea-at" => sea(true, arguments),
        "taylor-green" => taylor_green(arguments),
        other if other.starts_with('-') => Err(usage(&format!("unknown option `{other}`"))),
        other => Err(usage(&format!("unknown question `{other}`"))),
    }
}
