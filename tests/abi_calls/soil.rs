//! Soil through the C interface: a bucket that digs, what it reports, what has changed, and refusals by name.

use std::ptr::{null, null_mut};

use super::world::{World, init, message, update};
use welkin::capi::{context::*, soil::*, status::*, terrain::*, timeline::*};

const SIDE: usize = 32;
const POINT: u32 = size_of::<wk_soil_point>() as u32;

/// A context with a level tile of cells of 0.25 m, and soil on it.
fn dug(world: &World) -> *mut wk_context {
    let mut context = null_mut();
    let heights = [2.0f32; SIDE * SIDE];
    let terrain = wk_terrain { tile_cells: SIDE as u32, cell_m: 0.25, ..init("wk_terrain") };
    let cells = wk_terrain_cells {
        heights_m: heights.as_ptr(),
        height_count: heights.len() as u32,
        ..init("wk_terrain_cells")
    };
    // SAFETY: live pointers.
    unsafe {
        assert_eq!(wk_context_create(world.device, null(), &mut context), WK_OK, "{}", message());
        assert_eq!(wk_context_set_soil(context, &init("wk_soil")), WK_ERROR_WRONG_ORDER);
        assert!(message().contains("wk_context_set_terrain"), "{}", message());
        assert_eq!(wk_context_set_terrain(context, &terrain), WK_OK, "{}", message());
        assert_eq!(wk_context_set_terrain_tile(context, &cells), WK_OK, "{}", message());
        assert_eq!(wk_context_set_soil(context, &init("wk_soil")), WK_OK, "{}", message());
    }
    context
}

/// Pose of a bucket whose edge is 0.3 m deep, looking along x.
fn pose(time_s: f64, x: f64) -> wk_soil_pose {
    wk_soil_pose {
        time_s,
        edge_left_m: [x, 4.75, 1.7],
        edge_right_m: [x, 3.25, 1.7],
        upper_left_m: [x - 0.2, 4.75, 2.9],
        upper_right_m: [x - 0.2, 3.25, 2.9],
        facing: [1.0, 0.0, 0.2],
        ..init("wk_soil_pose")
    }
}

#[test]
fn a_bucket_digs_and_reports_through_c() {
    let world = World::new();
    let context = dug(&world);
    let (mut tool, mut revision, mut count, mut lands) = (0, 0, 0, 9);
    let mut report: wk_soil_tool_report = init("wk_soil_tool_report");
    let mut force: wk_cutting_force = init("wk_cutting_force");
    let mut balance: wk_soil_balance = init("wk_soil_balance");
    let mut changes = [wk_soil_change { revision: 0, tile: [0, 0], first_cell: [0, 0], cells: [0, 0] }; 8];
    let shape = wk_soil_tool { struck_m3: 3.0, ..init("wk_soil_tool") };
    // SAFETY, for all: live pointers with the sizes given.
    unsafe {
        assert_eq!(wk_context_get_terrain_revision(context, &mut revision), WK_OK);
        assert_eq!(wk_context_add_soil_tool(context, &shape, &pose(0.0, 2.0), &mut tool), WK_OK, "{}", message());
        assert_eq!(wk_context_move_soil_tool(context, tool, &pose(2.0, 5.0)), WK_OK, "{}", message());
        update(context, 1.9);
        assert_eq!(wk_context_get_soil_tool(context, tool, &mut report), WK_OK, "{}", message());
        let volume = 1.5 * 0.3 * 3.0 * 0.95;
        assert!((report.mass_kg / (1561.0 * volume) - 1.0).abs() < 0.1, "{} kg", report.mass_kg);
        assert!(report.kinds_kg[WK_SOIL_TOPSOIL as usize] > 0.8 * report.mass_kg && report.fill > 0.2);
        assert!((report.cut_depth_m - 0.3).abs() < 0.02 && report.is_stopped_by_frost == 0, "{}", report.cut_depth_m);
        assert_eq!(wk_context_get_soil_resistance(context, tool, &init("wk_soil_blade"), &mut force), WK_OK);
        assert!(force.force_n > 1e3 && force.failure_deg > 10.0, "{} N", force.force_n);
        assert_eq!(
            wk_context_get_soil_changes(context, revision, null_mut(), 0, 0, &mut count),
            WK_OK,
            "{}",
            message()
        );
        let size = size_of::<wk_soil_change>() as u32;
        assert!((2..=4).contains(&count), "{count}");
        assert_eq!(wk_context_get_soil_changes(context, revision, changes.as_mut_ptr(), 8, size, &mut count), WK_OK);
        let mut lowest: f64 = 0.0;
        for change in &changes[..count as usize] {
            let mut points = [std::mem::zeroed::<wk_soil_point>(); 256];
            let (tile, first, cells) = (&change.tile, &change.first_cell, &change.cells);
            let got = wk_context_get_soil_cells(context, tile, first, cells, points.as_mut_ptr(), 256, POINT);
            assert_eq!(got, WK_OK, "{}", message());
            lowest = points.iter().fold(lowest, |low, point| low.min(point.change_m));
        }
        assert!((lowest + 0.3).abs() < 0.02, "{lowest}");
        let mut point = std::mem::zeroed::<wk_terrain_point>();
        let size = size_of::<wk_terrain_point>() as u32;
        assert_eq!(wk_context_get_terrain_at(context, &[3.0, 4.0, 9.0], 1, 24, &mut point, size), WK_OK);
        assert!((point.height_m - 1.7).abs() < 0.02, "the dug height: {}", point.height_m);
        let at = [4.0, 6.5, 0.0];
        assert_eq!(wk_context_bring_soil(context, &at, WK_SOIL_SAND, 200.0, &mut lands), WK_OK, "{}", message());
        assert_eq!(lands, 1);
        assert_eq!(wk_context_bring_soil(context, &[-40.0, 0.0, 0.0], WK_SOIL_SAND, 1.0, &mut lands), WK_OK);
        assert_eq!(lands, 0, "there is no ground");
        let mut sand = std::mem::zeroed::<wk_soil_point>();
        assert_eq!(wk_context_get_soil_points(context, &at, 1, 24, &mut sand, POINT), WK_OK);
        assert!(sand.kind == WK_SOIL_SAND && sand.loose_m > 1.0 && sand.has_ground == 1, "{}", sand.loose_m);
        assert_eq!(wk_context_end_soil_tool(context, tool), WK_OK, "{}", message());
        update(context, 30.0);
        assert_eq!(wk_context_get_soil_balance(context, &mut balance), WK_OK);
        let wk_soil_balance { dug_ug, brought_ug, lying_ug, held_ug, taken_ug, .. } = balance;
        assert_eq!(dug_ug + brought_ug, lying_ug + held_ug + taken_ug);
        assert!(held_ug == 0 && taken_ug > 1_000_000_000_000 && brought_ug == 200_000_000_000);
        wk_context_destroy(context);
    }
}

#[track_caller]
fn refused(status: wk_status, wanted: wk_status, text: &str) {
    assert!(status == wanted && message().contains(text), "{status}, {text}: {}", message());
}

#[test]
fn wrong_soil_is_named_as_in_the_header() {
    let world = World::new();
    let context = dug(&world);
    let (mut tool, mut hashes) = (0, [0u64; 2]);
    let mut report: wk_soil_tool_report = init("wk_soil_tool_report");
    // SAFETY, for all: live pointers with the sizes given.
    unsafe {
        assert_eq!(wk_context_add_soil_tool(context, &init("wk_soil_tool"), &pose(0.0, 2.0), &mut tool), WK_OK);
        assert_eq!(wk_context_state_hash(context, &mut hashes[0]), WK_OK);
        let invalid = |status: wk_status, text: &str| refused(status, WK_ERROR_INVALID_ARGUMENT, text);
        let (tops, layers) = ([0.0, 0.0], [0u32, 200]);
        let soil = wk_soil {
            horizon_count: 2,
            horizon_tops_m: tops.as_ptr(),
            horizon_kinds: layers.as_ptr(),
            ..init("wk_soil")
        };
        invalid(wk_context_set_soil(context, &soil), "soil.horizon_kinds[1] must be a known kind of soil");
        let soil = wk_soil { horizon_kinds: [0u32, 1].as_ptr(), ..soil };
        invalid(wk_context_set_soil(context, &soil), "soil.horizon_tops_m[1] must be more than 0 m");
        let kind = wk_soil_kind { swell: 2.0, ..init("wk_soil_kind") };
        let soil = wk_soil { own_kind_count: 1, own_kinds: &kind, ..init("wk_soil") };
        invalid(wk_context_set_soil(context, &soil), "soil.own_kinds[0].swell must be in [0, 1.5]");
        let good = pose(1.0, 2.5);
        let moved = |pose: &wk_soil_pose| wk_context_move_soil_tool(context, tool, pose);
        invalid(moved(&wk_soil_pose { facing: [-1.0, 0.0, 0.0], ..good }), "pose.facing must be out of the opening");
        invalid(moved(&wk_soil_pose { edge_left_m: [f64::NAN; 3], ..good }), "pose.edge_left_m[0] must be finite");
        invalid(
            moved(&wk_soil_pose { edge_right_m: [2.5, 90.0, 1.7], ..good }),
            "pose.edge_right_m must be over a tile",
        );
        invalid(moved(&wk_soil_pose { load_n: -1.0, ..good }), "pose.load_n must be in [0, 10000000] N");
        refused(moved(&pose(0.0, 2.5)), WK_ERROR_WRONG_ORDER, "pose.time_s must be more than 0 s");
        invalid(wk_context_get_soil_tool(context, 77, &mut report), "tool must be a tool of this site");
        invalid(wk_context_bring_soil(context, &[1.0; 3], 200, 1.0, null_mut()), "kind must be a known kind of soil");
        let shape = wk_soil_tool { struck_m3: 0.0, ..init("wk_soil_tool") };
        invalid(
            wk_context_add_soil_tool(context, &shape, &good, &mut tool),
            "shape.struck_m3 must be in [0.001, 1000]",
        );
        let got = wk_context_get_soil_cells(context, &[0, 0], &[20, 0], &[20, 1], null_mut(), 0, 0);
        invalid(got, "cells[0] must be at least 1");
        assert_eq!(wk_context_state_hash(context, &mut hashes[1]), WK_OK);
        assert_eq!(hashes[0], hashes[1], "nothing has changed");
        assert_eq!(wk_context_set_soil(context, null()), WK_OK, "{}", message());
        refused(wk_context_get_soil_tool(context, 1, &mut report), WK_ERROR_WRONG_ORDER, "wk_context_set_soil");
        wk_context_destroy(context);
    }
}
