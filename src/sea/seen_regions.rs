//! Regions of water as shaders look them up: their outlines around an anchor near the camera.

use glam::{DMat2, DVec2, DVec3};

use super::{
    mesh::{MeshBlock, MeshEye},
    outline::MAX_OUTLINE_CORNERS,
    regions::{MAX_SEA_REGIONS, PlacedRegion, SeaRegionKind},
    uniform::SeaChart,
};
use crate::moment::Scene;

/// A region (`SeaRegion` of `shaders/sea/uniform.wgsl`).
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, bytemuck::Pod, bytemuck::Zeroable)]
pub(super) struct RegionUniform {
    pub anchor: [f32; 2],
    pub reach2: f32,
    pub kind: u32,
    pub turn: [f32; 4],
    pub corners: u32,
    pub wave_share: f32,
    pub rim: f32,
    pub pad: f32,
}

/// Kinds of regions in the shaders.
pub(super) const DRY_REGION: u32 = 0;
pub(super) const SHELTERED_REGION: u32 = 1;
pub(super) const LAKE_REGION: u32 = 2;

/// A camera over the water, in the host's world.
#[derive(Clone, Copy)]
pub(super) struct RegionsEye<'a> {
    pub scene: &'a Scene,
    /// Position of the camera.
    pub position: DVec3,
    pub chart: &'a SeaChart,
    pub eye: &'a MeshEye,
    pub time_s: f64,
}

/// Regions that a camera may see, in the order in which they are applied.
#[derive(Clone, Debug, Default)]
pub(super) struct SeenRegions {
    pub list: Vec<RegionUniform>,
    /// Corners of each, in rows of [`MAX_OUTLINE_CORNERS`].
    pub corners: Vec<[f32; 2]>,
}

impl SeenRegions {
    /// Finds the regions within the camera's reach.
    pub fn fill(&mut self, regions: &[PlacedRegion], camera: &RegionsEye<'_>) {
        self.list.clear();
        self.corners.clear();
        let off_anchor = camera.eye.place_m - camera.eye.anchor_m();
        let to_world = camera.scene.world_to_enu.transpose();
        for placed in regions.iter().take(MAX_SEA_REGIONS) {
            let below = placed.offset_m(camera.position + to_world * camera.chart.foot, camera.time_s);
            let Some(below) = below.filter(|place| place.length() <= placed.radius_m() + camera.eye.reach_m) else {
                continue;
            };
            let turn = |on_map: DVec3| placed.turned(to_world * on_map, camera.time_s);
            let turn = DMat2::from_cols(turn(camera.chart.east), turn(camera.chart.north));
            let region = &placed.region;
            let kind = match region.kind {
                SeaRegionKind::Dry => DRY_REGION,
                SeaRegionKind::Sheltered => SHELTERED_REGION,
                SeaRegionKind::Lake { .. } => LAKE_REGION,
            };
            self.list.push(RegionUniform {
                anchor: (below - turn * off_anchor).as_vec2().to_array(),
                reach2: (placed.radius_m() * placed.radius_m()) as f32,
                kind,
                turn: turn.to_cols_array().map(|v| v as f32),
                corners: region.corners_m.len() as u32,
                wave_share: region.wave_share as f32,
                rim: region.rim_m as f32,
                pad: 0.0,
            });
            self.corners.extend(region.corners_m.iter().map(|corner| DVec2::from(*corner).as_vec2().to_array()));
            self.corners.resize(self.list.len() * MAX_OUTLINE_CORNERS, [0.0; 2]);
        }
    }

    /// Whether the water of a block of the mesh, which moves by at most `displaced_m`, may reach a region.
    pub fn touch(&self, block: &MeshBlock, displaced_m: f64) -> bool {
        let (middle, radius_m) = block.circle();
        let around = radius_m + displaced_m;
        self.list.iter().any(|region| {
            let turn = DMat2::from_cols_array(&region.turn.map(f64::from));
            let place = DVec2::from(region.anchor.map(f64::from)) + turn * middle;
            place.length() <= f64::from(region.reach2).sqrt() + around
        })
    }
}
