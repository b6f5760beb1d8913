//! `studio`: sets, shows and writes out the weather.

use std::{fs, process::ExitCode};

use welkin::gpu::{Device, DeviceOptions};
use welkin_studio::{headless::Headless, manual, script, window};

const USAGE: &str = "\
usage: studio                                        a window
       studio --headless --script FILE [options]     a script without a display
       studio --settings-page                        everything that can be set, as a page
       studio --commands                             the commands of a script
       studio --help | --version
options: --size WxH    size of the window, pixels (1280x760; 320x200 to 4096x4096)
         --scale S     pixels in a point of the panel (1; 0.5 to 4)";

/// Request of the command line.
#[derive(Default)]
struct Asked {
    headless: bool,
    script: Option<String>,
    size: Option<[u32; 2]>,
    scale: Option<f32>,
}

fn size(text: &str) -> Result<[u32; 2], String> {
    let sides = text.split_once('x').and_then(|(w, h)| Some([w.parse::<u32>().ok()?, h.parse::<u32>().ok()?]));
    let accepted = sides.filter(|[w, h]| (320..=4096).contains(w) && (200..=4096).contains(h));
    accepted.ok_or_else(|| format!("--size takes WxH from 320x200 to 4096x4096; got `{text}`"))
}

fn read(arguments: &[String]) -> Result<Asked, String> {
    let (mut asked, mut words) = (Asked::default(), arguments.iter());
    while let Some(word) = words.next() {
        let mut value = || words.next().ok_or_else(|| format!("{word} takes a value"));
        match word.as_str() {
            "--headless" => asked.headless = true,
            "--script" => asked.script = Some(value()?.clone()),
            "--size" => asked.size = Some(size(value()?)?),
            "--scale" => {
                let text = value()?;
                let scale = text.parse().ok().filter(|s| (0.5..=4.0).contains(s));
                asked.scale = Some(scale.ok_or_else(|| format!("--scale takes 0.5 to 4; got `{text}`"))?);
            }
            other if other.starts_with('-') => return Err(format!("unknown option `{other}`")),
            other => return Err(format!("unexpected argument `{other}`")),
        }
    }
    let of_headless = asked.script.is_some() || asked.size.is_some() || asked.scale.is_some();
    match (asked.headless, asked.script.is_some(), of_headless) {
        (true, false, _) => Err("--headless needs a --script".into()),
        (false, _, true) => Err("--script, --size and --scale go with --headless".into()),
        _ => Ok(asked),
    }
}

fn without_display(asked: &Asked) -> Result<(), String> {
    let file = asked.script.as_deref().unwrap_or_default();
    let text = fs::read_to_string(file).map_err(|e| format!("{file}: {e}"))?;
    let gpu = Device::headless(&DeviceOptions::default()).map_err(|e| e.to_string())?;
    let mut studio = Headless::new(&gpu, asked.size.unwrap_or([1280, 760]), asked.scale.unwrap_or(1.0))?;
    script::run_all(&mut studio, &text).map_err(|e| format!("{file}: {e}"))
}

fn main() -> ExitCode {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    if let Some(text) = welkin_command_line::answered("studio", USAGE, arguments.iter().cloned()) {
        print!("{text}");
        return ExitCode::SUCCESS;
    }
    match arguments.first().map(String::as_str) {
        Some("--settings-page") => {
            print!("{}", manual::page());
            return ExitCode::SUCCESS;
        }
        Some("--commands") => {
            println!("{}", script::COMMANDS);
            return ExitCode::SUCCESS;
        }
        _ => {}
    }
    let asked = match read(&arguments) {
        Ok(asked) => asked,
        Err(message) => {
            eprintln!("studio: {message}\n{USAGE}");
            return ExitCode::from(2);
        }
    };
    let done = if asked.headless {
        welkin_command_line::at_work("studio", "drawing", || without_display(&asked))
    } else {
        window::run()
    };
    match done {
        Ok(()) => ExitCode::SUCCESS,
        Err(message) => {
            eprintln!("studio: {message}");
            ExitCode::FAILURE
        }
    }
}
