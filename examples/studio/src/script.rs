//! Scripts: one command a line, for a run without hands.

use std::path::Path;

use glam::DVec3;

use crate::{headless::Headless, settings::Part};

/// What each command does, for the help.
pub const COMMANDS: &str = "\
set PART.FIELD VALUE   a field by its name in the header: set weather.visibility_m 3000
on PART, off PART      a struct of the library's own choice or of yours: on sea
preset NAME            a weather by name
metar REPORT           a weather from a report
place NAME             a place to look from
eye EAST NORTH UP      the camera's place, m
look HEADING PITCH     the camera's direction, degrees
fov DEGREES            the camera's angle of view
page TITLE             a page of the panel
search WORDS           rows of all pages
theme light|dark       the panel's colours
pass SECONDS           simulation time
picture FILE.png       the picture
window FILE.png        the panel and the picture
save FILE, load FILE   settings
undo, redo             a step";

/// A sentence about a wrong number of words.
fn words<const N: usize>(command: &str, rest: &str) -> Result<[f64; N], String> {
    let numbers: Vec<f64> = rest.split_whitespace().filter_map(|word| word.parse().ok()).collect();
    let finite = numbers.iter().all(|n: &f64| n.is_finite());
    let right = <[f64; N]>::try_from(numbers).ok().filter(|_| finite && rest.split_whitespace().count() == N);
    right.ok_or_else(|| format!("{command} takes {N} number{}; got `{rest}`", if N == 1 { "" } else { "s" }))
}

/// A number between ends.
fn within(name: &str, value: f64, [low, high]: [f64; 2]) -> Result<f64, String> {
    if (low..=high).contains(&value) {
        return Ok(value);
    }
    Err(format!("{name} is in [{low}, {high}]; got {value}"))
}

/// Carries out one command.
///
/// # Errors
/// A sentence that names what is accepted; nothing has changed then.
pub fn run(studio: &mut Headless, line: &str) -> Result<(), String> {
    let line = line.trim();
    if line.is_empty() || line.starts_with('#') {
        return Ok(());
    }
    let (command, rest) = line.split_once(char::is_whitespace).unwrap_or((line, ""));
    let rest = rest.trim();
    let app = &mut studio.app;
    match command {
        "set" => set(studio, rest),
        "on" | "off" => {
            let part = Part::of_key(rest)?;
            app.change(|settings| settings.switch(part, command == "on"));
            Ok(())
        }
        "preset" => app.preset(rest),
        "metar" => app.metar(rest),
        "place" => app.go(rest),
        "eye" => {
            let [east, north, up] = words("eye", rest)?;
            app.camera.place = DVec3::new(east, north, within("up", up, [-1e3, 1e7])?);
            app.turn(0.0, 0.0);
            Ok(())
        }
        "look" => {
            let [heading, pitch] = words("look", rest)?;
            (app.camera.heading_deg, app.camera.pitch_deg) = (heading, within("the pitch", pitch, [-89.0, 89.0])?);
            app.turn(0.0, 0.0);
            Ok(())
        }
        "fov" => {
            let [degrees] = words("fov", rest)?;
            app.camera.fov_deg = within("the angle of view", degrees, [1.0, 150.0])?;
            app.turn(0.0, 0.0);
            Ok(())
        }
        "page" => app.open(rest),
        "search" => {
            rest.clone_into(&mut app.search);
            Ok(())
        }
        "theme" if matches!(rest, "light" | "dark") => {
            app.is_dark = rest == "dark";
            Ok(())
        }
        "theme" => Err(format!("a theme is light or dark; got `{rest}`")),
        "pass" => {
            let [seconds] = words("pass", rest)?;
            studio.pass(within("the time", seconds, [0.0, 86_400.0])?)
        }
        "picture" | "window" => {
            studio.frame(0.0)?;
            let path = Path::new(rest);
            if command == "picture" { studio.write_picture(path) } else { studio.write_window(path) }
        }
        "save" => app.save(Path::new(rest)),
        "load" => app.load(Path::new(rest)),
        "undo" => {
            if app.undo() {
                Ok(())
            } else {
                Err("there is nothing to undo".into())
            }
        }
        "redo" => {
            if app.redo() {
                Ok(())
            } else {
                Err("there is nothing to do again".into())
            }
        }
        other => Err(format!("`{other}` is no command; the commands are\n{COMMANDS}")),
    }
}

fn set(studio: &mut Headless, rest: &str) -> Result<(), String> {
    let usage = || format!("set takes PART.FIELD and a value, as in `set weather.visibility_m 3000`; got `{rest}`");
    let (name, value) = rest.split_once(char::is_whitespace).ok_or_else(usage)?;
    let (part, field) = name.split_once('.').ok_or_else(usage)?;
    let part = Part::of_key(part)?;
    // What is no number and no list is a name.
    let read = |text: &str| format!("v = {text}").parse::<toml::Table>().ok().and_then(|mut t| t.remove("v"));
    let value = read(value.trim()).unwrap_or_else(|| toml::Value::String(value.trim().to_owned()));
    let mut done = Ok(());
    studio.app.change(|settings| done = settings.set(part, field, &value));
    done
}

/// Carries out a script. What the library refuses ends it too.
///
/// # Errors
/// The number of the line, and a sentence.
pub fn run_all(studio: &mut Headless, text: &str) -> Result<(), String> {
    for (i, line) in text.lines().enumerate() {
        let at = |e: String| format!("line {}: {e}", i + 1);
        run(studio, line).map_err(at)?;
        studio.app.tell();
        if let Some((part, refusal)) = studio.app.refused.first() {
            return Err(at(format!("{}: {}", part.key(), refusal.message)));
        }
    }
    Ok(())
}
