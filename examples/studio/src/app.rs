//! The studio without a window: what is set, what is shown, and the commands that change both.

use std::{fs, path::Path, sync::Arc};

use glam::DVec3;
use welkin::{capi::by_name::NamedWeather, gpu::Device};

use crate::{
    camera::FlyCamera,
    history::History,
    pages::PAGES,
    settings::{Part, Settings},
    table,
    world::{Refused, World},
};

/// Time over which a changed weather fades in, s: long enough to be seen, short enough to wait for.
const TRANSITION_S: f64 = 1.0;
/// Longest step of simulation time in one frame, s.
const LONGEST_STEP_S: f64 = 0.5;

/// The studio.
pub struct App {
    gpu: Arc<Device>,
    world: World,
    /// Settings of the panel, which the library is told at the next step.
    pub settings: Settings,
    /// Settings that the library has been told.
    told: Settings,
    /// Steps to undo.
    pub history: History,
    /// Refusals of the present settings by the library.
    pub refused: Vec<Refused>,
    /// The camera.
    pub camera: FlyCamera,
    /// Simulation time, s.
    pub time_s: f64,
    /// Seconds of simulation in one second; 0 while it stands.
    pub pace: f64,
    /// Page that is open, an index of [`PAGES`].
    pub page: usize,
    /// Words that rows are searched for; empty to see a page.
    pub search: String,
    /// Report in the report's line.
    pub report: String,
    /// Sentence about the last command.
    pub message: String,
    /// Whether the panel is dark.
    pub is_dark: bool,
    /// Whether the picture no longer shows what is set.
    is_stale: bool,
}

impl App {
    /// Opens the studio.
    ///
    /// # Errors
    /// A sentence, if there can be no world.
    pub fn new(gpu: &Arc<Device>, size: [u32; 2]) -> Result<Self, String> {
        let mut settings = Settings::default();
        settings.switch(Part::Call("wk_context_set_sun"), true);
        settings.set(Part::Call("wk_context_set_sun"), "elevation_deg", &toml::Value::Float(30.0))?;
        settings.set(Part::Call("wk_context_set_sun"), "azimuth_deg", &toml::Value::Float(120.0))?;
        let (world, refused) = World::new(gpu, &settings, size)?;
        let camera = FlyCamera::at("valley", |place| world.ground_m(place))?;
        let mut app = Self {
            gpu: gpu.clone(),
            world,
            told: settings.clone(),
            settings,
            history: History::default(),
            refused,
            camera,
            time_s: 0.0,
            pace: 1.0,
            page: 0,
            search: String::new(),
            report: String::new(),
            message: String::new(),
            is_dark: true,
            is_stale: true,
        };
        app.preset("scattered")?;
        app.tell_within(0.0);
        app.history = History::default();
        Ok(app)
    }

    /// The world.
    pub fn world(&self) -> &World {
        &self.world
    }

    /// Changes the settings as one step that can be undone.
    pub fn change(&mut self, change: impl FnOnce(&mut Settings)) {
        let before = self.settings.clone();
        change(&mut self.settings);
        if self.settings != before {
            self.history.note(&before);
            self.history.close();
        }
    }

    /// Flies for `seconds` by keys: to the right, forward and up.
    pub fn fly(&mut self, keys: DVec3, seconds: f64) {
        if keys != DVec3::ZERO {
            let ground_m = self.world.ground_m(self.camera.place);
            self.camera.fly(keys, seconds, ground_m);
            self.is_stale = true;
        }
    }

    /// Turns the camera, degrees.
    pub fn turn(&mut self, right_deg: f64, up_deg: f64) {
        self.camera.turn(right_deg, up_deg);
        self.is_stale = true;
    }

    /// Tells the library what has changed, passes `seconds`, and draws the picture of this size if it would show
    /// something else than the last. Returns whether it was drawn.
    ///
    /// # Errors
    /// A sentence.
    pub fn step(&mut self, seconds: f64, size: [u32; 2]) -> Result<bool, String> {
        self.tell();
        let step_s = (self.pace * seconds).clamp(0.0, LONGEST_STEP_S * self.pace.max(1.0));
        if step_s > 0.0 {
            self.time_s += step_s;
            self.is_stale = true;
        }
        if self.world.size() != size {
            self.world.resize(size);
            self.is_stale = true;
        }
        if !self.is_stale {
            return Ok(false);
        }
        self.world.update(self.time_s)?;
        self.world.draw(&self.camera)?;
        self.is_stale = false;
        Ok(true)
    }

    /// Whether the picture no longer shows what is set.
    pub fn is_stale(&self) -> bool {
        self.is_stale
    }

    /// Tells the library what has changed. [`Self::refused`] has what it refuses.
    pub fn tell(&mut self) {
        // A world that stands still shows what is set at once.
        self.tell_within(if self.pace > 0.0 { TRANSITION_S * self.pace } else { 0.0 });
    }

    /// Tells it; a changed weather fades in over this time.
    fn tell_within(&mut self, transition_s: f64) {
        if self.settings == self.told {
            return;
        }
        self.is_stale = true;
        if self.settings.needs_new_context(&self.told) {
            match World::new(&self.gpu, &self.settings, self.world.size()) {
                Ok((world, refused)) => (self.world, self.refused, self.time_s) = (world, refused, 0.0),
                // The running world stays, and the panel says what was refused.
                Err(message) => {
                    let field = String::new();
                    self.refused = vec![(Part::World, welkin::capi::by_name::Refusal { message, field })];
                }
            }
        } else {
            let now = self.world.apply(&self.settings, &self.told, transition_s);
            // What was refused before stays refused unless its part has changed.
            let same = |part: Part| self.settings.bytes(part) == self.told.bytes(part);
            self.refused.retain(|(part, _)| same(*part) && now.iter().all(|(other, _)| other != part));
            self.refused.extend(now);
        }
        self.told = self.settings.clone();
    }

    /// Refusal about a field of a part.
    pub fn refusal(&self, part: Part, field: &str) -> Option<&str> {
        self.refusals(part).find(|(named, _)| *named == field).map(|(_, message)| message)
    }

    /// Refusal of a part that is about none of its rows.
    pub fn refusal_of_all(&self, part: Part) -> Option<&str> {
        let rows = table::rows(part.structure());
        let is_row = |named: &str| rows.iter().any(|row| row.field.name == named);
        self.refusals(part).find(|(named, _)| !is_row(named)).map(|(_, message)| message)
    }

    /// Refusals of a part: the field, without the struct before it and an index behind it, and the sentence.
    fn refusals(&self, part: Part) -> impl Iterator<Item = (&str, &str)> {
        self.refused.iter().filter(move |(of, _)| *of == part).map(|(_, refusal)| {
            let field = refusal.field.rsplit('.').next().unwrap_or_default();
            (field.split('[').next().unwrap_or_default(), refusal.message.as_str())
        })
    }

    /// Replaces the weather by a preset's.
    ///
    /// # Errors
    /// The name is none.
    pub fn preset(&mut self, name: &str) -> Result<(), String> {
        let weather = NamedWeather::of_preset(name).map_err(|refusal| refusal.message)?;
        self.take_weather(weather)
    }

    /// Replaces the weather by a report's.
    ///
    /// # Errors
    /// The report cannot be read.
    pub fn metar(&mut self, report: &str) -> Result<(), String> {
        let weather = NamedWeather::of_metar(report).map_err(|refusal| refusal.message)?;
        report.clone_into(&mut self.report);
        self.take_weather(weather)
    }

    /// Replaces the weather by one whose station stands at the site.
    fn take_weather(&mut self, weather: NamedWeather) -> Result<(), String> {
        let altitude_m = toml::Value::Float(self.world.site_m().round());
        let mut done = Ok(());
        self.change(|settings| {
            settings.set_weather(weather);
            done = settings.set(Part::Weather, "station_altitude_m", &altitude_m);
        });
        done
    }

    /// Jumps to a place.
    ///
    /// # Errors
    /// The name is none.
    pub fn go(&mut self, place: &str) -> Result<(), String> {
        self.camera = FlyCamera::at(place, |place| self.world.ground_m(place))?;
        self.is_stale = true;
        Ok(())
    }

    /// Opens a page by its title.
    ///
    /// # Errors
    /// The title is none.
    pub fn open(&mut self, title: &str) -> Result<(), String> {
        let titles = || PAGES.iter().map(|page| page.title).collect::<Vec<_>>().join(", ");
        let found = PAGES.iter().position(|page| page.title.eq_ignore_ascii_case(title));
        self.page = found.ok_or_else(|| format!("a page is one of {}; got `{title}`", titles()))?;
        self.search.clear();
        Ok(())
    }

    /// Writes the settings.
    ///
    /// # Errors
    /// A sentence with the file's name.
    pub fn save(&self, path: &Path) -> Result<(), String> {
        welkin_command_line::write_whole(path, self.settings.to_toml().as_bytes()).map_err(|e| e.to_string())
    }

    /// Reads settings; the present ones stay if the file is wrong.
    ///
    /// # Errors
    /// A sentence with the file's name.
    pub fn load(&mut self, path: &Path) -> Result<(), String> {
        let named = |e: String| format!("{}: {e}", path.display());
        let text = fs::read_to_string(path).map_err(|e| named(e.to_string()))?;
        let loaded = Settings::from_toml(&text).map_err(named)?;
        self.change(|settings| *settings = loaded);
        Ok(())
    }

    /// Takes a step back.
    pub fn undo(&mut self) -> bool {
        self.history.undo(&mut self.settings)
    }

    /// Takes a step back again.
    pub fn redo(&mut self) -> bool {
        self.history.redo(&mut self.settings)
    }
}
