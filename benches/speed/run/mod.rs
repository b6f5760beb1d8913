//! A scripted day of a trainer, the unit of speed: reports with changes of weather, rain and snow that begin and end,
//! a camera that drives, turns and climbs, a sun at its pace and at 60 times its pace, day and night. Prints for every
//! segment how long frames take in the median and at worst, against the same weathers at rest, and the causes of slow
//! frames.
//!
//! `cargo bench --bench speed -- run`, in at most 8 minutes on two cores. Environment:
//!
//! | variable | meaning |
//! |---|---|
//! | `RUN_QUICK=1` | the same day five times as fast |
//! | `RUN_CSV=FILE` | writes every frame to a file, which `lab run FILE` charts |
//! | `RUN_SLOW=1` | prints every slow frame with all that was counted in it |
//! | `RUN_BACKEND=gl` | OpenGL instead of Vulkan |
//! | `RUN_UNPREPARED=1` | does not prepare the view for the day's weathers |
//! | `RUN_TOLERANCE=0.01` | plans by this tolerance, with the gauge |
//! | `RUN_PART=..` | plays one part in this process: `clear` or `rain`, a first picture, or `day` |
//! | `RUN_TURNS=1` | waits for a line on standard input before every 20 frames; `scripts/compare-speed` sends them |
//!
//! Each part has a process of its own without the drivers' caches, in memory or on disk. This folder and `copying.rs`
//! use little of the library, all of it old: `scripts/compare-speed` builds them with older versions too.

mod causes;
mod day;
mod played;
mod report;

use std::{process::Command, time::Instant};

use day::{Pace, SEGMENTS};

type Fallible<T> = Result<T, Box<dyn std::error::Error>>;

/// Name of a part, and the segment whose weather its first picture shows; the day has none.
const PARTS: [(&str, Option<&str>); 3] = [("clear", Some("clear")), ("rain", Some("rain")), ("day", None)];

/// Plays all parts, each in a process of its own, or the one that is asked for in this process.
pub fn run() -> Fallible<()> {
    if let Ok(name) = std::env::var("RUN_PART") {
        return part(&name);
    }
    let empty = std::env::temp_dir().join(format!("welkin-run-{}", std::process::id()));
    for (name, _) in PARTS {
        let mut child = Command::new(std::env::current_exe()?);
        child.args(["run"]).env("RUN_PART", name).env("XDG_CACHE_HOME", &empty);
        child.env("MESA_SHADER_CACHE_DISABLE", "true").env("MESA_SHADER_CACHE_DIR", &empty);
        child.env("__GL_SHADER_DISK_CACHE", "0");
        if !child.status()?.success() {
            return Err(format!("the process for part {name} failed").into());
        }
    }
    if empty.exists() {
        std::fs::remove_dir_all(&empty)?;
    }
    Ok(())
}

fn part(name: &str) -> Fallible<()> {
    let begun = Instant::now();
    let known = PARTS.iter().find(|(part, _)| *part == name);
    let (_, segment) = known.ok_or_else(|| format!("RUN_PART: {name} is none of clear, rain, day"))?;
    if let Some(weather) = segment {
        let shown = SEGMENTS.iter().find(|segment| segment.name == *weather).ok_or("a segment of that name")?;
        let seconds = played::first_picture(shown.report, begun)?;
        println!("run: first picture in {name}, in a new process without caches: {seconds:.2} s");
        return Ok(());
    }
    causes::listen();
    let (pace, mut host) = (Pace::asked(), played::Host::new()?);
    let played = played::day(&mut host, pace)?;
    let rest = (0..SEGMENTS.len()).map(|segment| played::at_rest(&mut host, pace, segment));
    let rest = rest.collect::<Fallible<Vec<_>>>()?;
    let day = report::Day { pace, played, rest };
    let caps = host.device.caps();
    println!(
        "run: a day of {} frames of {} x {}, {}",
        day.played.frames.len(),
        played::SIZE.0,
        played::SIZE.1,
        caps.adapter_name
    );
    day.print();
    match std::env::var_os("RUN_CSV") {
        Some(path) => day.write(path.as_ref(), caps),
        None => Ok(()),
    }
}
