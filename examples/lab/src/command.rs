//! Command line of the lab: commands and options. Everything else is refused.

use std::path::PathBuf;

use welkin::{Error, Result, Status};

use crate::candidates::{Candidate, Effect, candidate};
use crate::{
    chart, clouds, compare, day, genera, growth, heights, page, painted_chart, peers, regression, report, stability,
};

/// Every command and option.
pub const USAGE: &str =
    "usage: lab chart [sky|fog|rain|snow|stars|clouds|painted-clouds|quadrature]   cost against error, with plots
       lab growth                         how cost and bytes grow
       lab stability [MAP ..]             where methods fail
       lab run FILE                       the frames of a scripted day, which a benchmark writes to FILE
       lab peers                          the recorded figures of others and of before, beside Welkin's
       lab compare A B [--scene NAME]     two candidates' pictures side by side
       lab report                         everything on one HTML page
       lab scenes DIR [--scene PART]      a PNG of every scene; of those whose names contain PART
       lab scenes OLD NEW                 what differs between two such folders
       lab genera DIR [--scene PART]      a PNG of every kind of cloud, to be looked at
       lab painted DIR [--scene PART]     a PNG of every way to paint clouds, to be looked at
       lab heights                        mistakes with height maps, as a sheet of pictures
       lab thresholds                     of the clouds' map, as src/clouds/field/thresholds.in has them
       lab photons                        how far the clouds' light is from photons
options: --out DIR (docs/lab)   --quick (coarse truth, few rounds)   --fresh (forget what an earlier run kept)
         --help   --version";

/// The options of a command line.
pub struct Options {
    /// Folder for results.
    pub out: PathBuf,
    /// Uses a coarser truth and fewer rounds.
    pub quick: bool,
    /// Discards the results of a stopped run.
    pub fresh: bool,
    /// Name of a scene.
    pub scene: Option<String>,
}

fn usage(what: &str) -> Error {
    Error::new(Status::Parse, format!("{what}\n{USAGE}"))
}

/// Splits the arguments into words and options.
fn parse(arguments: &[String]) -> Result<(Vec<String>, Options)> {
    let mut options = Options { out: "docs/lab".into(), quick: false, fresh: false, scene: None };
    let mut words = Vec::new();
    let mut rest = arguments.iter();
    while let Some(a) = rest.next() {
        match a.as_str() {
            "--quick" => options.quick = true,
            "--fresh" => options.fresh = true,
            "--out" => options.out = rest.next().ok_or_else(|| usage("--out needs a directory"))?.into(),
            "--scene" => options.scene = Some(rest.next().ok_or_else(|| usage("--scene needs a name"))?.clone()),
            other if other.starts_with('-') => return Err(usage(&format!("unknown option `{other}`"))),
            word => words.push(word.to_owned()),
        }
    }
    Ok((words, options))
}

/// Finds the candidate with that name in any effect.
fn find_candidate(name: &str) -> Result<Candidate> {
    let faults: Vec<String> =
        Effect::NAMES.iter().filter_map(|(_, e)| candidate(*e, name).err().map(|fault| fault.to_string())).collect();
    let found = Effect::NAMES.iter().find_map(|(_, e)| candidate(*e, name).ok());
    found.ok_or_else(|| usage(&faults.join("\n")))
}

/// Runs the command of the arguments. Returns false if compared pictures differ.
///
/// # Errors
/// Unknown commands, effects, candidates, maps, scenes and options; files; the GPU.
pub fn run(arguments: &[String]) -> Result<bool> {
    let (words, options) = parse(arguments)?;
    let words: Vec<&str> = words.iter().map(String::as_str).collect();
    if let ["scenes", old, new] = words.as_slice() {
        return regression::compare(old.as_ref(), new.as_ref());
    }
    match words.as_slice() {
        ["chart"] => ["quadrature", "fog", "rain", "snow", "stars", "clouds", "painted-clouds", "sky"]
            .iter()
            .try_for_each(|c| chart::run(c, &options)),
        ["chart", what] if chart::CHARTS.contains(what) => chart::run(what, &options),
        ["chart", other] => Err(usage(&format!("unknown effect `{other}`, one of {}", chart::CHARTS.join(", ")))),
        ["growth"] => growth::run(&options),
        ["peers"] => peers::chart(&options.out).and_then(|()| page::write(&options.out)),
        ["run", file] => day::run(file.as_ref(), &options),
        ["run", ..] => Err(usage("run needs the file of a run's frames")),
        ["stability", maps @ ..] => stability::run(maps, &options),
        ["compare", a, b] => compare::run(&find_candidate(a)?, &find_candidate(b)?, &options),
        ["compare", ..] => Err(usage("compare needs two candidates")),
        ["report"] => report::run(&options),
        ["scenes", dir] => regression::draw(dir.as_ref(), options.scene.as_deref()),
        ["scenes", ..] => Err(usage("scenes needs one folder to draw into, or two to compare")),
        ["genera", dir] => genera::draw(dir.as_ref(), options.scene.as_deref()),
        ["painted", dir] => painted_chart::draw(dir.as_ref(), options.scene.as_deref()),
        ["heights"] => heights::draw(&options.out),
        ["thresholds"] => clouds::print_thresholds(),
        ["photons"] => clouds::print_photons(options.quick),
        [] => Err(usage("no command")),
        other => Err(usage(&format!("unknown command `{}`", other.join(" ")))),
    }
    .map(|()| true)
}
