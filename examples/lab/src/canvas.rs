//! A list of shapes, written both as SVG and as PNG with the same text metrics.

use std::path::Path;
use std::sync::Once;

use plotters::coord::Shift;
use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, Pos, VPos};
use welkin::{Error, Result, Status};

/// Red, green, blue.
pub type Rgb = (u8, u8, u8);
/// Text and axes.
pub const INK: Rgb = (40, 44, 52);
/// Grid lines.
pub const GRID: Rgb = (225, 228, 232);
/// Less important shapes.
pub const FAINT: Rgb = (170, 175, 182);

/// Position of a text relative to its point.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Anchor {
    /// To the right of the point.
    Left,
    /// Centred on the point.
    Center,
    /// To the left of the point.
    Right,
}

enum Item {
    Rect([f64; 4], Rgb, bool),
    Line(Vec<(f64, f64)>, Rgb, u32),
    Circle((f64, f64), f64, Rgb, bool),
    Text(String, (f64, f64), f64, Rgb, Anchor, bool),
}

/// The shapes of one figure, in pixels from the upper left corner.
pub struct Canvas {
    size: (u32, u32),
    items: Vec<Item>,
}

/// Mean width of a letter divided by its height.
const LETTER: f64 = 0.56;

/// Gives plotters the font of all text in bitmaps.
pub fn register_font() {
    static FONT: Once = Once::new();
    FONT.call_once(|| {
        let bytes = dejavu::sans::regular();
        // The bytes are a valid font. Without a font the PNG would have no text; the SVG has it.
        let _ = plotters::style::register_font("sans-serif", FontStyle::Normal, bytes);
    });
}

impl Canvas {
    /// An empty figure.
    pub fn new(width: u32, height: u32) -> Self {
        Self { size: (width, height), items: Vec::new() }
    }

    /// A filled rectangle: left, top, right, bottom.
    pub fn fill(&mut self, rect: [f64; 4], color: Rgb) {
        self.items.push(Item::Rect(rect, color, true));
    }

    /// The border of a rectangle.
    pub fn frame(&mut self, rect: [f64; 4], color: Rgb) {
        self.items.push(Item::Rect(rect, color, false));
    }

    /// A polyline through points.
    pub fn line(&mut self, points: &[(f64, f64)], color: Rgb, width: u32) {
        self.items.push(Item::Line(points.to_vec(), color, width));
    }

    /// A disc, or a ring.
    pub fn circle(&mut self, center: (f64, f64), radius: f64, color: Rgb, filled: bool) {
        self.items.push(Item::Circle(center, radius, color, filled));
    }

    /// A horizontal text, centred vertically.
    pub fn text(&mut self, text: &str, at: (f64, f64), size: f64, color: Rgb, anchor: Anchor) {
        self.items.push(Item::Text(text.to_owned(), at, size, color, anchor, false));
    }

    /// A text that runs upwards, centred.
    pub fn upright(&mut self, text: &str, at: (f64, f64), size: f64, color: Rgb) {
        self.items.push(Item::Text(text.to_owned(), at, size, color, Anchor::Center, true));
    }

    /// Approximate width of a text.
    pub fn width_of(text: &str, size: f64) -> f64 {
        text.chars().count() as f64 * size * LETTER
    }

    /// Writes `stem`.svg and `stem`.png.
    ///
    /// # Errors
    /// A file that cannot be written.
    pub fn save(&self, stem: &Path) -> Result<()> {
        register_font();
        let fault = |e: String| Error::new(Status::Io, format!("{}: {e}", stem.display()));
        let svg = stem.with_extension("svg");
        let mut text = String::new();
        self.draw(SVGBackend::with_string(&mut text, self.size).into_drawing_area()).map_err(fault)?;
        welkin_command_line::write_whole(&svg, text.as_bytes())?;
        let png = stem.with_extension("png");
        let mut bytes = vec![0; (3 * self.size.0 * self.size.1) as usize];
        self.draw(BitMapBackend::with_buffer(&mut bytes, self.size).into_drawing_area()).map_err(fault)?;
        welkin_command_line::write_png(&png, &bytes, self.size.into())
    }

    fn draw<B: DrawingBackend>(&self, area: DrawingArea<B, Shift>) -> std::result::Result<(), String> {
        let say = |e: DrawingAreaErrorKind<B::ErrorType>| e.to_string();
        area.fill(&WHITE).map_err(say)?;
        let at = |p: &(f64, f64)| (p.0.round() as i32, p.1.round() as i32);
        let rgb = |c: &Rgb| RGBColor(c.0, c.1, c.2);
        for item in &self.items {
            match item {
                Item::Rect(r, c, filled) => {
                    let style = ShapeStyle { color: rgb(c).to_rgba(), filled: *filled, stroke_width: 1 };
                    area.draw(&Rectangle::new([at(&(r[0], r[1])), at(&(r[2], r[3]))], style)).map_err(say)?;
                }
                Item::Line(points, c, width) => {
                    let style = rgb(c).stroke_width(*width);
                    let points: Vec<_> = points.iter().map(at).collect();
                    area.draw(&PathElement::new(points, style)).map_err(say)?;
                }
                Item::Circle(p, r, c, filled) => {
                    let style = ShapeStyle { color: rgb(c).to_rgba(), filled: *filled, stroke_width: 2 };
                    area.draw(&Circle::new(at(p), *r as i32, style)).map_err(say)?;
                }
                Item::Text(text, p, size, c, anchor, upright) => {
                    let h = match anchor {
                        Anchor::Left => HPos::Left,
                        Anchor::Center => HPos::Center,
                        Anchor::Right => HPos::Right,
                    };
                    let turn = if *upright { FontTransform::Rotate270 } else { FontTransform::None };
                    let font = ("sans-serif", *size).into_font().transform(turn);
                    let style = font.color(&rgb(c)).pos(Pos::new(h, VPos::Center));
                    area.draw(&Text::new(text.as_str(), at(p), style)).map_err(say)?;
                }
            }
        }
        area.present().map_err(say)
    }
}
