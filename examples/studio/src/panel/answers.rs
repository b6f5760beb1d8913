//! What the library answers: the conditions of the weather, and the report of the last frame.

use egui::{RichText, Ui};
use welkin::capi::by_name::GETTERS;

use crate::{app::App, bytes, panel::row::written, table};

/// Shows the answers.
pub fn show(ui: &mut Ui, app: &App) {
    for (call, _) in GETTERS {
        match app.world().calls().get(call, app.camera.place.to_array()) {
            Ok((structure, answer)) => {
                ui.add_space(6.0);
                ui.label(RichText::new(structure).strong());
                egui::Grid::new(structure).striped(true).show(ui, |ui| {
                    for row in table::rows(structure).iter().filter(|row| table::is_on(&answer, row)) {
                        ui.label(row.name()).on_hover_text(row.help);
                        ui.label(said(&answer, row));
                        ui.end_row();
                    }
                });
            }
            Err(refusal) => {
                ui.colored_label(ui.visuals().error_fg_color, refusal.message);
            }
        }
    }
}

fn said(answer: &[u64], row: &table::Row) -> String {
    let one = |element| {
        let word = bytes::integer(answer, &row.field, element);
        if row.is_union() {
            let set = row.choices.iter().filter(|c| word & c.value != 0).map(|c| c.name.as_str());
            return set.collect::<Vec<_>>().join(", ");
        }
        let named = row.choices.iter().find(|c| c.value == word);
        named.map_or_else(|| written(bytes::number(answer, &row.field, element)), |c| c.name.clone())
    };
    (0..row.field.count).map(one).collect::<Vec<_>>().join(", ")
}
