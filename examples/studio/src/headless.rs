//! The studio without a display: the same panel, painted into an image.

use std::{path::Path, sync::Arc};

use welkin::gpu::Device;

use crate::{
    app::App,
    paint::{self, Painter},
    panel,
};

/// Time of a frame, s.
const FRAME_S: f64 = 1.0 / 60.0;

/// A studio that paints into an image.
pub struct Headless {
    gpu: Arc<Device>,
    /// The studio.
    pub app: App,
    painter: Painter,
    context: egui::Context,
    window: wgpu::Texture,
    /// Pixels in a point of the panel.
    scale: f32,
    /// Size of the picture in the panel, pixels.
    picture: [u32; 2],
    frames: u64,
}

impl Headless {
    /// Opens a studio of this size, pixels, and this number of pixels in a point.
    ///
    /// # Errors
    /// A sentence.
    pub fn new(gpu: &Arc<Device>, size: [u32; 2], scale: f32) -> Result<Self, String> {
        let mut studio = Self {
            gpu: gpu.clone(),
            app: App::new(gpu, [16, 16])?,
            painter: Painter::new(gpu, paint::FORMAT),
            context: egui::Context::default(),
            window: paint::target(&gpu.device, size),
            scale,
            picture: [16, 16],
            frames: 0,
        };
        // The first pass finds the sizes, from which the second draws.
        studio.paint(Vec::new());
        Ok(studio)
    }

    /// Passes `seconds` and draws a frame.
    ///
    /// # Errors
    /// The library's sentence.
    pub fn frame(&mut self, seconds: f64) -> Result<(), String> {
        self.frame_with(seconds, Vec::new())
    }

    /// As [`Self::frame`], after events of keyboard and pointer.
    ///
    /// # Errors
    /// The library's sentence.
    pub fn frame_with(&mut self, seconds: f64, events: Vec<egui::Event>) -> Result<(), String> {
        self.paint(events);
        self.app.step(seconds, self.picture)?;
        self.paint(Vec::new());
        self.gpu.wait().map_err(|e| e.to_string())
    }

    /// Paints panel and picture.
    fn paint(&mut self, events: Vec<egui::Event>) {
        self.frames += 1;
        let [width, height] = [self.window.width(), self.window.height()].map(|v| v as f32 / self.scale);
        let mut input = egui::RawInput {
            screen_rect: Some(egui::Rect::from_min_size(egui::Pos2::ZERO, egui::vec2(width, height))),
            time: Some(FRAME_S * self.frames as f64),
            focused: true,
            events,
            ..Default::default()
        };
        input.viewports.entry(egui::ViewportId::ROOT).or_default().native_pixels_per_point = Some(self.scale);
        let texture = self.painter.show(self.app.world().picture());
        let (app, mut picture) = (&mut self.app, self.picture);
        let output = self.context.run_ui(input, |ui| picture = panel::show(ui, app, texture));
        self.picture = picture;
        self.painter.paint(&self.context, output, &self.window);
    }

    /// Passes simulation time, s, in steps of frames, and draws the last.
    ///
    /// # Errors
    /// The library's sentence.
    pub fn pass(&mut self, seconds: f64) -> Result<(), String> {
        let (pace, frames) = (self.app.pace, (10.0 * seconds).ceil().clamp(1.0, 600.0));
        self.app.pace = 1.0;
        let passed = (0..frames as u32).try_for_each(|_| self.app.step(seconds / frames, self.picture).map(|_| ()));
        self.app.pace = pace;
        passed?;
        self.frame(0.0)
    }

    /// Writes the picture without the panel.
    ///
    /// # Errors
    /// A sentence with the file's name.
    pub fn write_picture(&self, path: &Path) -> Result<(), String> {
        self.painter.write_shown(path)
    }

    /// Writes the whole window.
    ///
    /// # Errors
    /// A sentence with the file's name.
    pub fn write_window(&self, path: &Path) -> Result<(), String> {
        paint::write(&self.gpu, &self.window, path)
    }
}
