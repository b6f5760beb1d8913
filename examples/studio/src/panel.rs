//! The panel: pages of rows from the table, a line for reports and presets, the run of time, and the picture.

mod answers;
mod row;

pub use row::written;

use egui::{Align, Layout, RichText, Ui};
use welkin::weather::Weather;

use crate::{
    app::App,
    camera::PLACES,
    pages::{ANSWERS, PAGES, title},
    settings::{Part, Settings},
    table::{self, Row},
};

/// Width of the panel when it opens, points.
const WIDTH: f32 = 440.0;
/// Degrees that the camera turns while the pointer is dragged by one point.
const DRAGGED_DEG: f64 = 0.15;

/// Shows the panel and the picture. Returns the size that the picture should have, pixels.
pub fn show(ui: &mut Ui, app: &mut App, picture: egui::TextureId) -> [u32; 2] {
    ui.ctx().set_theme(if app.is_dark { egui::Theme::Dark } else { egui::Theme::Light });
    shortcuts(ui, app);
    egui::Panel::bottom("time").show(ui, |ui| time(ui, app));
    egui::Panel::left("panel").resizable(true).default_size(WIDTH).show(ui, |ui| {
        head(ui, app);
        ui.separator();
        egui::ScrollArea::vertical().auto_shrink(false).show(ui, |ui| body(ui, app));
    });
    let frame = egui::Frame::NONE;
    egui::CentralPanel::default().frame(frame).show(ui, |ui| picture_of(ui, app, picture)).inner
}

fn shortcuts(ui: &Ui, app: &mut App) {
    use egui::{Key, KeyboardShortcut, Modifiers};
    let pressed = |modifiers, key| ui.ctx().input_mut(|i| i.consume_shortcut(&KeyboardShortcut::new(modifiers, key)));
    if pressed(Modifiers::COMMAND | Modifiers::SHIFT, Key::Z) || pressed(Modifiers::COMMAND, Key::Y) {
        app.redo();
    } else if pressed(Modifiers::COMMAND, Key::Z) {
        app.undo();
    }
}

/// Search, presets and reports above the pages.
fn head(ui: &mut Ui, app: &mut App) {
    ui.add_space(4.0);
    ui.horizontal(|ui| {
        let label = ui.label("Search");
        ui.add(egui::TextEdit::singleline(&mut app.search).desired_width(120.0)).labelled_by(label.id);
        let mut chosen = None;
        egui::ComboBox::from_id_salt("presets").selected_text("Presets").show_ui(ui, |ui| {
            for name in Weather::preset_names() {
                let said = Weather::preset_description(name).unwrap_or_default();
                if ui.selectable_label(false, name).on_hover_text(said).clicked() {
                    chosen = Some(name);
                }
            }
        });
        if let Some(name) = chosen {
            app.message = app.preset(name).err().unwrap_or_default();
        }
    });
    ui.horizontal(|ui| {
        let label = ui.label("METAR");
        let line = ui.add(egui::TextEdit::singleline(&mut app.report).desired_width(f32::INFINITY));
        if line.labelled_by(label.id).lost_focus() && ui.input(|i| i.key_pressed(egui::Key::Enter)) {
            let report = app.report.clone();
            app.message = app.metar(&report).err().unwrap_or_default();
        }
    });
    if !app.message.is_empty() {
        ui.colored_label(ui.visuals().error_fg_color, &app.message);
    }
    ui.horizontal_wrapped(|ui| {
        for (i, page) in PAGES.iter().enumerate() {
            if ui.selectable_label(app.page == i && app.search.is_empty(), page.title).clicked() {
                app.page = i;
                app.search.clear();
            }
        }
    });
}

/// Rows of the open page, or those that the search finds.
fn body(ui: &mut Ui, app: &mut App) {
    let before = app.settings.clone();
    let mut settings = app.settings.clone();
    let page = &PAGES[app.page.min(PAGES.len() - 1)];
    if !app.search.trim().is_empty() {
        found(ui, app, &mut settings);
    } else if page.title == ANSWERS {
        answers::show(ui, app);
    } else {
        for part in page.parts(&settings) {
            section(ui, app, &mut settings, part, |_| true);
        }
    }
    if settings != before {
        app.history.note(&before);
        app.settings = settings;
    }
    // A drag or a typed number is one step.
    if !ui.input(|i| i.pointer.any_down()) {
        app.history.close();
    }
}

/// Rows of all pages that have all words of the search.
fn found(ui: &mut Ui, app: &App, settings: &mut Settings) {
    let words: Vec<String> = app.search.to_lowercase().split_whitespace().map(str::to_owned).collect();
    let fits = |row: &Row| {
        let text = format!("{} {} {}", row.label, row.field.name, row.help).to_lowercase();
        words.iter().all(|word| text.contains(word))
    };
    let mut none = true;
    for page in &PAGES {
        for part in page.parts(settings) {
            if table::rows(part.structure()).iter().any(fits) {
                none = false;
                section(ui, app, settings, part, fits);
            }
        }
    }
    if none {
        ui.label("Nothing has these words.");
    }
}

/// A part with its rows.
fn section(ui: &mut Ui, app: &App, settings: &mut Settings, part: Part, wanted: impl Fn(&Row) -> bool) {
    ui.add_space(6.0);
    let mut is_there = settings.bytes(part).is_some();
    ui.horizontal(|ui| {
        if part.is_fixed() {
            ui.label(RichText::new(title(part)).strong());
        } else if ui.checkbox(&mut is_there, RichText::new(title(part)).strong()).changed() {
            if is_there { settings.switch(part, true) } else { settings.remove(part) }
        }
    });
    if let Some(message) = app.refusal_of_all(part) {
        ui.colored_label(ui.visuals().error_fg_color, message);
    }
    let Some(bytes) = settings.bytes_mut(part) else { return };
    egui::Grid::new(part.key()).num_columns(2).show(ui, |ui| {
        for row in table::rows(part.structure()).iter().filter(|row| wanted(row)) {
            row::show(ui, bytes, row);
            if let Some(message) = app.refusal(part, row.field.name) {
                ui.label("");
                ui.add(egui::Label::new(RichText::new(message).color(ui.visuals().error_fg_color)).wrap());
                ui.end_row();
            }
        }
    });
}

/// Time, places and the panel's own settings.
fn time(ui: &mut Ui, app: &mut App) {
    ui.horizontal(|ui| {
        let runs = app.pace > 0.0;
        if ui.button(if runs { "Pause" } else { "Run" }).clicked() {
            app.pace = if runs { 0.0 } else { 1.0 };
        }
        ui.add(egui::Slider::new(&mut app.pace, 0.0..=600.0).logarithmic(true).smallest_positive(0.1).text("times"));
        ui.label(format!("{:.1} s", app.time_s));
        ui.separator();
        for (name, ..) in PLACES {
            if ui.button(name).clicked() {
                app.message = app.go(name).err().unwrap_or_default();
            }
        }
        ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
            if ui.button(if app.is_dark { "Light" } else { "Dark" }).clicked() {
                app.is_dark = !app.is_dark;
            }
            if ui.button("Redo").clicked() {
                app.redo();
            }
            if ui.button("Undo").clicked() {
                app.undo();
            }
        });
    });
}

/// The picture, and the camera's keys and drags. Returns the size that it should have, pixels.
fn picture_of(ui: &mut Ui, app: &mut App, picture: egui::TextureId) -> [u32; 2] {
    let size = ui.available_size();
    let shown = ui.add(egui::Image::new((picture, size)).sense(egui::Sense::click_and_drag()));
    if shown.dragged() {
        let by = shown.drag_delta();
        let by = [by.x, by.y].map(|v| f64::from(v) * DRAGGED_DEG * app.camera.fov_deg / 50.0);
        app.turn(-by[0], by[1]);
    }
    if shown.clicked() {
        shown.request_focus();
    }
    let in_text = ui.ctx().memory(|m| m.focused()).is_some_and(|id| id != shown.id);
    if !in_text {
        let (keys, seconds) = ui.input(|i| {
            let key = |plus, minus| f64::from(u8::from(i.key_down(plus))) - f64::from(u8::from(i.key_down(minus)));
            use egui::Key as K;
            (glam::DVec3::new(key(K::D, K::A), key(K::W, K::S), key(K::E, K::Q)), f64::from(i.stable_dt))
        });
        app.fly(keys, seconds.min(0.1));
        if keys != glam::DVec3::ZERO {
            ui.ctx().request_repaint();
        }
    }
    let scale = ui.ctx().pixels_per_point();
    [size.x, size.y].map(|v| ((v * scale).round() as u32).clamp(16, 8192))
}
