//! The sea in a view: an opaque surface in the host's colour and depth.

use glam::{DMat4, DVec2, DVec3, DVec4};

use super::{
    drawn::{DrawnTiles, MOST_WAVES, TileSlopes, WaveUniform, fill_waves},
    far::horizon_distance_m,
    held::HeldSea,
    mesh::{MOST_BLOCKS, MeshBlock, MeshEye, REGION_MARK, WAKE_MARK},
    model::SeaStatistics,
    passes::{SeaDraw, SeaPasses},
    regions::WaterBody,
    seen_regions::{RegionsEye, SeenRegions},
    seen_wakes::SeenWakes,
    tiles::TILES,
    uniform::{DrawnSea, SeaChart, SeaUniform},
};
use crate::{
    error::Result,
    stage::{DepthAccess, DrawContext, DrawnEffect, Exchange, FrameContext, OpaqueDraw, Output, Outputs, Stages},
};

/// Greatest height above the sea from which it is drawn, m. From higher up the planet's ground is drawn instead.
const MOST_HEIGHT_M: f64 = 1e5;
/// Least height of the camera above the sea's level that drawing uses, m. It keeps distances above 0 for a camera at
/// the surface.
const LEAST_HEIGHT_M: f64 = 0.1;
/// Greatest depth below the level from which the sea is drawn, m: that of a camera in a trough.
const DEEPEST_TROUGH_M: f64 = 30.0;
/// Ratio of the largest displacement of the water to the height of the highest crest. Water moves sideways as much as
/// up and down in deep water, and more in shallow water.
const DISPLACED_TO_CREST: f64 = 3.0;
/// Ratio of the height of the highest crest above the level to that of the highest wave: crests of steep seas are
/// somewhat higher than troughs are deep.
const CREST_SHARE: f64 = 0.6;
/// Limit for light in units of the host's target: the largest half float, 65 504, less a margin for later passes.
const MOST_UNITS: f64 = 6e4;

/// Key of the waves for which the tiles of a view were made: the bits of the time, and the revisions of the timeline
/// and of the settings.
type TilesKey = (u64, u64, u64);

/// The sea of a view.
#[derive(Default)]
pub(crate) struct SeaView {
    /// Blocks of the mesh that this frame shows; none where no sea is seen.
    pub(super) blocks: Vec<MeshBlock>,
    regions: SeenRegions,
    wakes: SeenWakes,
    /// Whether there is sea outside all regions.
    is_open: bool,
    waves: Vec<WaveUniform>,
    tile_slopes: [TileSlopes; TILES],
    pub(super) block: SeaUniform,
    /// Refractive index of the water.
    index: f64,
    /// Height of the highest crests above the level, m.
    crest_m: f64,
    tiles: Option<Box<DrawnTiles>>,
    tiles_key: Option<TilesKey>,
    /// Whether the tiles have to be uploaded.
    is_new: bool,
    pub(super) passes: Option<Box<SeaPasses>>,
}

/// Planes of a picture's sides: a camera-relative point is inside if its products with all of them are positive.
struct SidePlanes([DVec4; 4]);

impl SidePlanes {
    fn new(clip: &DMat4) -> Self {
        let rows = clip.transpose();
        let (x, y, w) = (rows.x_axis, rows.y_axis, rows.w_axis);
        Self([w + x, w - x, w + y, w - y].map(|plane| plane / plane.truncate().length()))
    }

    /// Whether all lines of sight rise from the camera; never in a parallel projection, whose lines start elsewhere.
    fn look_up(&self) -> bool {
        let normals = self.0.map(|plane| plane.truncate());
        let rises = |[a, b, opposite]: [usize; 3]| {
            let along = normals[a].cross(normals[b]);
            along.z * along.dot(normals[opposite]).signum() > 0.0
        };
        let corners = [[0, 2, 1], [0, 3, 1], [1, 2, 0], [1, 3, 0]];
        self.0.iter().all(|plane| plane.w.abs() < 1e-9) && corners.into_iter().all(rises)
    }

    /// Whether any of a sphere may be in the picture.
    fn shows(&self, middle: DVec3, radius_m: f64) -> bool {
        self.0.iter().all(|plane| plane.dot(middle.extend(1.0)) > -radius_m)
    }
}

impl SeaView {
    /// Finds the blocks of the mesh that a camera sees.
    fn find_blocks(&mut self, context: &FrameContext<'_>, eye: &MeshEye, chart: &SeaChart) {
        let camera = &context.frame.camera;
        let turned = camera.rotation() * context.now.scene.world_to_enu.transpose();
        let planes = SidePlanes::new(&(camera.projection * DMat4::from_mat3(turned)));
        if planes.look_up() && eye.height_m > self.crest_m {
            return;
        }
        self.blocks.reserve_exact(MOST_BLOCKS);
        let displaced_m = DISPLACED_TO_CREST * self.crest_m;
        let shows = |middle: DVec2, half: f64| planes.shows(chart.at(middle), 1.5 * half + displaced_m);
        eye.blocks(shows, &mut self.blocks);
    }

    /// Marks the blocks that regions or wakes may reach, and removes those without water.
    fn mark_blocks(&mut self) {
        if self.regions.list.is_empty() && self.wakes.list.is_empty() && self.is_open {
            return;
        }
        let displaced_m = DISPLACED_TO_CREST * self.crest_m;
        for block in &mut self.blocks {
            let mark = |is_touched: bool, mark: i32| if is_touched { mark } else { 0 };
            block.marks = mark(self.regions.touch(block, displaced_m), REGION_MARK)
                + mark(self.wakes.touch(block, displaced_m), WAKE_MARK);
        }
        if !self.is_open {
            self.blocks.retain(|block| block.marks & REGION_MARK != 0);
        }
        self.blocks.sort_unstable_by_key(|block| (block.level, block.marks));
    }

    /// Works out the surface of the frame's time.
    fn fill(
        &mut self,
        context: &FrameContext<'_>,
        held: &HeldSea,
        (eye, chart): (MeshEye, SeaChart),
        statistics: SeaStatistics,
        fog_depth: f64,
    ) -> Result<()> {
        let (now, world) = (context.now, context.world);
        let surface = held.surface(world, now.time_s)?;
        // The surface is not drawn from below. In a harbour its waves are lower than on the open sea.
        let water = held.water_at(now.eye, now.time_s).unwrap_or(WaterBody::OPEN);
        let water = WaterBody { lake: None, ..water };
        if surface.within(&water, eye.place_m, 0.0).height_m > now.scene.place.altitude_m {
            self.blocks.clear();
            return Ok(());
        }
        let key = (now.time_s.to_bits(), world.timeline_revision(), held.revision());
        let tiles = self.tiles.get_or_insert_with(|| Box::new(DrawnTiles::new()));
        if self.tiles_key != Some(key) {
            tiles.fill(&surface);
            (self.tiles_key, self.is_new) = (Some(key), true);
        }
        let anchor = eye.anchor_m();
        let list = surface.tiles();
        self.tile_slopes = std::array::from_fn(|t| tiles.slopes(t, &list[t]));
        self.waves.reserve_exact(MOST_WAVES);
        let sums = fill_waves(&surface, &self.tile_slopes, anchor, &mut self.waves);
        let drawn = DrawnSea {
            scene: &now.scene,
            chart,
            eye,
            statistics,
            tiles: std::array::from_fn(|t| tiles.uniform(&list[t], anchor)),
            sums,
            waves: self.waves.len(),
            foam: surface.still().foam,
            fog_depth,
        };
        (self.block, self.index) = (drawn.uniform(), statistics.refractive_index);
        Ok(())
    }
}

impl DrawnEffect for SeaView {
    fn gathers(&self) -> Exchange {
        Exchange { needs: &[Output::FogDepth], gives: &[Output::Sea] }
    }

    fn gather(&mut self, context: &FrameContext<'_>, given: &mut Outputs) -> Result<()> {
        self.blocks.clear();
        let (now, world) = (context.now, context.world);
        let held = context.held.of::<HeldSea>()?;
        let Some(settings) = held.settings().filter(|_| context.asked.has(Stages::SURFACE)) else { return Ok(()) };
        let level_m = settings.level_at_m(now.time_s);
        let height_m = now.scene.place.altitude_m - level_m;
        if !(-DEEPEST_TROUGH_M..=MOST_HEIGHT_M).contains(&height_m) {
            return Ok(());
        }
        let height_m = height_m.max(LEAST_HEIGHT_M);
        let place_m = DVec2::from_array(now.scene.map_m);
        let chart = SeaChart::new(world, &now.scene, now.eye, (place_m, level_m));
        let reach_m = 1.02 * horizon_distance_m(height_m, now.planet_radius_m) + 1000.0;
        let eye = MeshEye { place_m, height_m, reach_m };
        let statistics = held.statistics(world, now.time_s)?;
        self.crest_m = CREST_SHARE * statistics.highest_in_hour_m;
        self.find_blocks(context, &eye, &chart);
        if self.blocks.is_empty() {
            return Ok(());
        }
        let above = RegionsEye { scene: &now.scene, position: now.eye, chart: &chart, eye: &eye, time_s: now.time_s };
        self.regions.fill(held.placed_regions(), &above);
        self.wakes.fill(&held.wakes(now.time_s), &eye);
        self.is_open = !settings.only_in_regions;
        self.mark_blocks();
        if self.blocks.is_empty() || context.frame.depth_access != DepthAccess::ReadWrite {
            return Ok(());
        }
        self.fill(context, held, (eye, chart), statistics, given.fog_depth)?;
        given.sea_top_m = self.has_opaque().then_some(chart.foot.z + self.crest_m);
        Ok(())
    }

    fn stages(&self) -> Stages {
        Stages(0)
    }

    fn has_opaque(&self) -> bool {
        !self.blocks.is_empty()
    }

    fn draw_opaque(
        &mut self,
        context: &DrawContext<'_>,
        opaque: &OpaqueDraw<'_>,
        pass: &mut wgpu::RenderPass<'_>,
    ) -> Result<()> {
        let Some(tiles) = &self.tiles else { return Ok(()) };
        let pixel = context.target.rays.pixel_angle(context.picture().height());
        self.block.set_picture(&opaque.clip, pixel, MOST_UNITS * context.frame.cd_m2_per_unit);
        let passes = self.passes.get_or_insert_with(|| {
            self.is_new = true;
            Box::new(SeaPasses::new(context.device))
        });
        if std::mem::take(&mut self.is_new) {
            passes.upload(context.device, tiles);
        }
        let draw = SeaDraw {
            block: &self.block,
            waves: &self.waves,
            tiles: &self.tile_slopes,
            blocks: &self.blocks,
            regions: &self.regions,
            wakes: &self.wakes,
            is_open: self.is_open,
            index: self.index,
        };
        passes.draw(context.device, &draw, opaque, pass)
    }

    fn bytes(&self) -> u64 {
        self.passes.as_ref().map_or(0, |passes| passes.bytes())
    }
}
