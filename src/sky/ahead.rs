//! Tables for places ahead of an observer whose altitude, sun or moon moves steadily (`course.rs`). They are drawn in
//! slices. The tables at the observer's own place are a mix of the tables of two such places.

use bytemuck::{Zeroable as _, bytes_of};

use super::course::ObserverCourse;
use super::kit::Kit;
use super::observer_tables::{Apart, LAMPS};
use super::passes::{bind, uniform_buffer};
use super::uniforms::ObserverUniform;
use crate::gpu::Device;

/// Tables for three places on the way of an observer: the two places between which the observer is (the pair), and the
/// next place.
pub(super) struct WayTables {
    tables: [Apart; 3],
    /// Bind groups that read the layers of `tables`, for each place.
    groups: [Vec<wgpu::BindGroup>; 3],
    /// Bind groups for the passes that draw the next place's tables, for each lamp: of the sky, and of the air.
    pub observer_groups: [[wgpu::BindGroup; 2]; LAMPS],
    /// Uniform buffers of these bind groups.
    pub observers: [[wgpu::Buffer; 2]; LAMPS],
    /// Index of the pair's first place.
    first: usize,
}

impl WayTables {
    pub fn new(device: &Device, kit: &Kit) -> Self {
        let tables = [(); 3].map(|()| Apart::new(device, &kit.settings));
        let read = |t: &Apart| t.layers.iter().map(|l| kit.fades.group(device, l)).collect();
        let groups = tables.each_ref().map(read);
        let zero = bytes_of(&ObserverUniform::zeroed()).to_vec();
        let observers = [(); LAMPS].map(|()| [(); 2].map(|()| uniform_buffer(device, "sky observer ahead", &zero)));
        let group = |b: &wgpu::Buffer| bind(device, &kit.observer_layouts.observer, &[b.as_entire_binding()]);
        let observer_groups = observers.each_ref().map(|of_lamp| of_lamp.each_ref().map(group));
        Self { tables, groups, observer_groups, observers, first: 0 }
    }

    /// Tables of the pair's first place.
    pub fn first(&self) -> &Apart {
        &self.tables[self.first]
    }

    /// Tables of the place that comes next.
    pub fn coming(&self) -> &Apart {
        &self.tables[(self.first + 2) % 3]
    }

    /// Bind groups that read a layer of the tables of the pair's first and second place.
    pub fn pair(&self, layer: usize) -> [&wgpu::BindGroup; 2] {
        [&self.groups[self.first][layer], &self.groups[(self.first + 1) % 3][layer]]
    }

    /// Shifts the pair by one place. The tables of the coming place become those of the pair's second place.
    pub fn turn(&mut self) {
        self.first = (self.first + 1) % 3;
    }
}

/// Course of an observer, and the tables on its way.
#[derive(Default)]
pub(super) struct Ahead {
    pub course: ObserverCourse,
    /// Id of the planet's tables from which the tables on the way are drawn.
    pub set: Option<u64>,
    /// Created when the first slice of tables ahead is drawn.
    pub tables: Option<Box<WayTables>>,
}

impl Ahead {
    /// Forgets the course. The textures stay for the next course.
    pub fn stop(&mut self) {
        (self.course, self.set) = (ObserverCourse::default(), None);
    }
}
