//! A row of the panel: a field with its switch, its value, its unit, and the header's text behind it.

use egui::Ui;
use welkin::capi::by_name::{NamedKind, StructBytes};

use crate::{
    bytes,
    table::{self, Row},
};

/// Ratio of the ends of a range from which on a slider goes by orders of magnitude.
const WIDE: f64 = 1000.0;
/// Most numbers of a field that are shown one beside the other.
const IN_A_LINE: usize = 4;

/// Shows a row of a grid.
pub fn show(ui: &mut Ui, bytes: &mut StructBytes, row: &Row) {
    let mut is_on = table::is_on(bytes, row);
    let name = row.name();
    if row.is_optional() {
        if ui.checkbox(&mut is_on, name).on_hover_text(row.help).changed() {
            table::turn(bytes, row, is_on);
        }
    } else {
        ui.label(name).on_hover_text(row.help);
    }
    ui.push_id(row.field.name, |ui| {
        if is_on && row.is_union() {
            union(ui, bytes, row);
        } else {
            ui.horizontal(|ui| {
                if is_on {
                    value(ui, bytes, row);
                }
            });
        }
    });
    ui.end_row();
}

fn value(ui: &mut Ui, bytes: &mut StructBytes, row: &Row) {
    if !row.choices.is_empty() {
        choice(ui, bytes, row);
    } else if row.field.count > IN_A_LINE {
        ui.collapsing(format!("{} numbers", row.field.count), |ui| {
            for element in 0..row.field.count {
                number(ui, bytes, row, element);
            }
        });
    } else {
        for element in 0..row.field.count {
            number(ui, bytes, row, element);
        }
    }
}

fn union(ui: &mut Ui, bytes: &mut StructBytes, row: &Row) {
    ui.vertical(|ui| {
        let mut flags = bytes::integer(bytes, &row.field, 0);
        for choice in &row.choices {
            let mut is_set = flags & choice.value == choice.value;
            if ui.checkbox(&mut is_set, &choice.name).on_hover_text(choice.help).changed() {
                flags = if is_set { flags | choice.value } else { flags & !choice.value };
                bytes::set_integer(bytes, &row.field, 0, flags);
            }
        }
    });
}

fn choice(ui: &mut Ui, bytes: &mut StructBytes, row: &Row) {
    let now = bytes::integer(bytes, &row.field, 0);
    let named = row.choices.iter().find(|c| c.value == now).map_or_else(|| now.to_string(), |c| c.name.clone());
    egui::ComboBox::from_id_salt("choice").selected_text(named).show_ui(ui, |ui| {
        for choice in &row.choices {
            if ui.selectable_label(choice.value == now, &choice.name).on_hover_text(choice.help).clicked() {
                bytes::set_integer(bytes, &row.field, 0, choice.value);
            }
        }
    });
}

fn number(ui: &mut Ui, bytes: &mut StructBytes, row: &Row, element: usize) {
    let mut value = bytes::number(bytes, &row.field, element);
    let is_whole = matches!(row.field.kind, NamedKind::Integer(_));
    let shown = |value: f64, _: std::ops::RangeInclusive<usize>| written(value);
    let answer = match row.limits {
        Some([low, high]) if row.field.count == 1 => {
            let smallest = if low > 0.0 { low } else { 1.0 };
            let is_wide = low >= 0.0 && (high / smallest >= WIDE || row.unit == "1/m");
            let mut slider = egui::Slider::new(&mut value, low..=high)
                .logarithmic(is_wide)
                .smallest_positive((1e-6 * high).max(1e-5))
                .custom_formatter(shown);
            if is_whole {
                slider = slider.integer();
            }
            ui.add(slider)
        }
        limits => {
            let [low, high] = limits.unwrap_or([f64::NEG_INFINITY, f64::INFINITY]);
            let low = if is_whole { low.max(0.0) } else { low };
            let speed = 0.01 * value.abs().max(if is_whole { 100.0 } else { 1.0 });
            ui.add(egui::DragValue::new(&mut value).range(low..=high).speed(speed).custom_formatter(shown))
        }
    };
    let default = |ui: &mut Ui| {
        ui.label(format!("default {}", written(row.default(element))));
    };
    if answer.on_hover_ui(default).changed() {
        bytes::set_number(bytes, &row.field, element, value);
    }
}

/// A number with six digits that count, without zeros at its end.
pub fn written(value: f64) -> String {
    let size = value.abs();
    if size != 0.0 && !(1e-3..1e7).contains(&size) {
        return format!("{value:.3e}");
    }
    let digits = if size == 0.0 { 0 } else { (5 - size.log10().floor() as i32).clamp(0, 6) as usize };
    let text = format!("{value:.digits$}");
    if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.').to_owned() } else { text }
}
