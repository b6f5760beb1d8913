//! Soil
//!
//! Soil is ground that tools dig, carry, heap and press, on the host's tiles (wk_context_set_terrain). The tiles are
//! the undug ground. Soil adds the change by digging and heaping, and wk_context_get_terrain_at, water, snow and wind
//! use the sum. Mass is counted in whole micrograms and never lost. Walls up to their critical height stand, and higher
//! ones fall. Heaps rest at their angle of repose. Rain and frost change the ground. The state is advanced by
//! wk_context_update, saved and hashed with the context. It depends on the timed poses of the tools, not on the frame
//! rate: send each pose before the update that reaches its time.
//!
//! A host with physics or a network of its own gets the changes of the ground from wk_context_get_soil_changes. The
//! steps of the soil are 1/64 s long. docs/soil.md shows how to dig.

use glam::DVec3;

use super::boundary::{
    guard,
    input::{self, List, MAX_BATCH, Named, position},
    layout::{self, init_struct},
    numbers::*,
    objects::{ContextObject, wk_context},
};
use crate::{
    error::{Error, Result, Status},
    soil::{
        MAX_HORIZONS, MAX_SOIL_KINDS, SoilBlade, SoilHorizon, SoilKind, SoilKindId, SoilSettings, SoilToolId,
        SoilToolPose, SoilToolShape, laws::SinkageSet,
    },
    terrain::TileKey,
};

pub use super::soil_structs::*;

include!(concat!(env!("OUT_DIR"), "/init_soil.rs"));

fn kind_id(name: &str, number: u32) -> Result<SoilKindId> {
    let known = u8::try_from(number).ok().filter(|number| usize::from(*number) < MAX_SOIL_KINDS);
    let accepted = format!("a known kind of soil, below {MAX_SOIL_KINDS}");
    known.map(SoilKindId).ok_or_else(|| Error::range(name, &accepted, number))
}

fn kind_of(c: &wk_soil_kind) -> SoilKind {
    let set = SinkageSet { kc: c.sinkage_kc, kphi: c.sinkage_kphi, n: c.sinkage_n };
    SoilKind {
        density_kg_m3: c.density_kg_m3,
        swell: c.swell,
        repose_deg: c.repose_deg,
        cohesion_kpa: c.cohesion_kpa,
        friction_deg: c.friction_deg,
        sinkage: (c.sinks != 0).then_some(set),
        albedo: c.albedo,
    }
}

/// # Safety
/// `p` is NULL or points to a struct whose lists are as long as it says.
unsafe fn settings_of(p: *const wk_soil) -> Result<SoilSettings> {
    // SAFETY: the caller's promise.
    let c = unsafe { layout::read(&"soil", p)? };
    // SAFETY: as above.
    unsafe { layout::check_chain(&"soil", c.next, &[])? };
    let list = List {
        name: "soil.own_kinds",
        count: Named("soil.own_kind_count", c.own_kind_count as usize),
        stride: Named("soil.own_kind_stride", c.own_kind_stride as usize),
        limit: MAX_SOIL_KINDS - WK_SOIL_BUILT_IN_KINDS as usize,
    };
    let mut settings = SoilSettings { saturation: c.saturation, ..SoilSettings::default() };
    // SAFETY: as above.
    unsafe {
        input::each(&list, c.own_kinds, &mut |_, kind: wk_soil_kind| {
            settings.own_kinds.push(kind_of(&kind));
            Ok(())
        })?;
    }
    let count = || Named("soil.horizon_count", c.horizon_count as usize);
    // SAFETY: as above.
    let (tops, kinds) = unsafe {
        let tops = input::slice("soil.horizon_tops_m", c.horizon_tops_m, count(), MAX_HORIZONS)?;
        (tops, input::slice("soil.horizon_kinds", c.horizon_kinds, count(), MAX_HORIZONS)?)
    };
    let horizon = |(i, (top_m, kind)): (usize, (&f64, &u32))| {
        Ok(SoilHorizon { top_m: *top_m, kind: kind_id(&format!("soil.horizon_kinds[{i}]"), *kind)? })
    };
    if !tops.is_empty() {
        settings.horizons = tops.iter().zip(kinds).enumerate().map(horizon).collect::<Result<_>>()?;
    }
    Ok(settings)
}

/// Renames the fields of settings in an error to the header's.
fn settings_named(e: Error) -> Error {
    e.map_field(|field| match field.strip_prefix("horizons[").and_then(|rest| rest.split_once("].")) {
        Some((i, "top_m")) => format!("soil.horizon_tops_m[{i}]"),
        Some((i, _)) => format!("soil.horizon_kinds[{i}]"),
        None if field == "terrain.cell_m" => field.into(),
        None => format!("soil.{}", field.replace("sinkage.", "sinkage_")),
    })
}

/// # Safety
/// `p` is NULL or points to a struct of its size.
unsafe fn pose_of(p: *const wk_soil_pose) -> Result<SoilToolPose> {
    // SAFETY: the caller's promise.
    let c = unsafe { layout::read(&"pose", p)? };
    // SAFETY: as above.
    unsafe { layout::check_chain(&"pose", c.next, &[])? };
    let [edge, upper] = [[c.edge_left_m, c.edge_right_m], [c.upper_left_m, c.upper_right_m]];
    Ok(SoilToolPose {
        time_s: c.time_s,
        edge: edge.map(DVec3::from_array),
        upper: upper.map(DVec3::from_array),
        facing: DVec3::from_array(c.facing),
        load_n: c.load_n,
    })
}

/// Renames the fields of a tool and its pose in an error to the header's.
fn tool_named(e: Error) -> Error {
    e.map_field(|field| match field {
        "pose.edge[0]" => "pose.edge_left_m".into(),
        "pose.edge[1]" => "pose.edge_right_m".into(),
        "pose.upper[0]" => "pose.upper_left_m".into(),
        "pose.upper[1]" => "pose.upper_right_m".into(),
        "tools.len" => "shape".into(),
        "poses.len" => "pose".into(),
        other => other.into(),
    })
}

/// Sets the soil of the terrain's tiles. The ground is undug at first; NULL removes the soil with all changes by
/// digging. Setting equal settings again changes nothing. Setting another lattice (wk_context_set_terrain) removes the
/// soil. Part of the saved state. Unchanged after an error.
/// Thread: exclusive.
/// Errors: WK_ERROR_WRONG_ORDER before wk_context_set_terrain, and while steps of an update remain;
/// WK_ERROR_INVALID_ARGUMENT naming the field, also for a terrain with cells of more than 4 m.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn wk_context_set_soil(context: *mut wk_context, soil: *const wk_soil) -> wk_status {
    guard("wk_context_set_soil", |call| {
        let object = call.get::<ContextObject>("context", context)?;
        // SAFETY: the caller's promise about `soil`.
        let settings = if soil.is_null() { None } else { Some(unsafe { settings_of(soil)? }) };
        object.write().set_soil(settings).map_err(settings_named)?;
        Ok(Status::Ok)
    })
}

/// Adds a tool at its first pose; there may be 64 tools at a time. `out_tool` gets its number, which no other tool of
/// the same soil gets. Unchanged after an error.
/// Thread: exclusive.
/// Errors: WK_ERROR_INVALID_ARGUMENT naming the field; WK_ERROR_WRONG_ORDER without soil, while steps of an update
/// remain, and for a pose before the last update.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn wk_context_add_soil_tool(
    context: *mut wk_context,
    shape: *const wk_soil_tool,
    pose: *const wk_soil_pose,
    out_tool: *mut u32,
) -> wk_status {
    guard("wk_context_add_soil_tool", |call| {
        let object = call.get::<ContextObject>("context", context)?;
        let out = input::out("out_tool", out_tool)?;
        // SAFETY: the caller's promises.
        let (c, pose) = unsafe {
            let c = layout::read(&"shape", shape)?;
            layout::check_chain(&"shape", c.next, &[])?;
            (c, pose_of(pose)?)
        };
        let (struck_m3, heap_rise) = (c.struck_m3, c.heap_rise);
        let shape = match c.shape {
            WK_SOIL_TOOL_BLADE => SoilToolShape::Blade,
            WK_SOIL_TOOL_BED => SoilToolShape::Bed { struck_m3, heap_rise },
            WK_SOIL_TOOL_WHEEL => SoilToolShape::Wheel { diameter_m: c.diameter_m },
            WK_SOIL_TOOL_TRACK => SoilToolShape::Track { contact_m: c.contact_m },
            _ => SoilToolShape::Bucket { struck_m3, heap_rise },
        };
        let tool = object.write().add_soil_tool(shape, &pose).map_err(tool_named)?;
        // SAFETY: checked, and the caller's promise.
        unsafe { out.write(tool.0) };
        Ok(Status::Ok)
    })
}

/// Adds the next pose of a tool: later than the last pose and the last update, at most 600 s after the last pose, and
/// with each point at most 20 m from its place in the last pose. The tool moves at constant speed between its poses,
/// and stands still after the last one. Its edge must stay over tiles. Unchanged after an error.
/// Thread: exclusive.
/// Errors: WK_ERROR_INVALID_ARGUMENT naming the field or an unknown tool; WK_ERROR_WRONG_ORDER for a pose that is not
/// later than the last pose and the last update, for a tool that has ended, without soil, and while steps of an update
/// remain.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn wk_context_move_soil_tool(
    context: *mut wk_context,
    tool: u32,
    pose: *const wk_soil_pose,
) -> wk_status {
    guard("wk_context_move_soil_tool", |call| {
        let object = call.get::<ContextObject>("context", context)?;
        // SAFETY: the caller's promise about `pose`.
        let pose = unsafe { pose_of(pose)? };
        object.write().move_soil_tool(SoilToolId(tool), &pose).map_err(tool_named)?;
        Ok(Status::Ok)
    })
}

/// Ends a tool at its last pose. The soil that the tool still holds then leaves with it, and is added to
/// wk_soil_balance.taken_ug.
/// Thread: exclusive.
/// Errors: WK_ERROR_INVALID_ARGUMENT for an unknown tool; WK_ERROR_WRONG_ORDER for one that has ended, without soil,
/// and while steps of an update remain.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn wk_context_end_soil_tool(context: *mut wk_context, tool: u32) -> wk_status {
    guard("wk_context_end_soil_tool", |call| {
        let object = call.get::<ContextObject>("context", context)?;
        object.write().end_soil_tool(SoilToolId(tool))?;
        Ok(Status::Ok)
    })
}

/// Gets the content of a tool, and the soil that it met in the last step, as of wk_context_get_state_time.
/// Thread: concurrent.
/// Errors: WK_ERROR_INVALID_ARGUMENT for an unknown tool; WK_ERROR_WRONG_ORDER without soil.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn wk_context_get_soil_tool(
    context: *const wk_context,
    tool: u32,
    out_report: *mut wk_soil_tool_report,
) -> wk_status {
    guard("wk_context_get_soil_tool", |call| {
        let object = call.get::<ContextObject>("context", context)?;
        // SAFETY: the caller's promise about `out_report`.
        let out = unsafe { layout::out_struct(&"out_report", out_report)? };
        out.set(&wk_soil_tool_report::of(&object.read().soil_tool(SoilToolId(tool))?));
        Ok(Status::Ok)
    })
}

/// Gets the force of the soil on the edge of a tool, for the depth of the cut and the soil of the last step: P = w
/// (gamma d^2 Ng + c d Nc + q d Nq + ca d Na) (Reece 1965; McKyes 1985), with width w, unit weight of the soil gamma,
/// depth d, cohesion c, surcharge q, adhesion ca and the factors Ng, Nc, Nq and Na. The answer is in closed form, for
/// the physics of your machine. It is 0 where the tool does not cut.
/// Thread: concurrent.
/// Errors: WK_ERROR_INVALID_ARGUMENT naming the field or an unknown tool; WK_ERROR_WRONG_ORDER without soil.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn wk_context_get_soil_resistance(
    context: *const wk_context,
    tool: u32,
    blade: *const wk_soil_blade,
    out_force: *mut wk_cutting_force,
) -> wk_status {
    guard("wk_context_get_soil_resistance", |call| {
        let object = call.get::<ContextObject>("context", context)?;
        // SAFETY: the caller's promises.
        let (c, out) = unsafe {
            let c = layout::read(&"blade", blade)?;
            layout::check_chain(&"blade", c.next, &[])?;
            (c, layout::out_struct(&"out_force", out_force)?)
        };
        let blade = SoilBlade {
            rake: c.rake_deg.to_radians(),
            soil_metal: c.soil_metal_deg.to_radians(),
            adhesion_kpa: c.adhesion_kpa,
            surcharge_kpa: c.surcharge_kpa,
        };
        let named =
            |e: Error| e.renamed("blade.rake", "blade.rake_deg").renamed("blade.soil_metal", "blade.soil_metal_deg");
        out.set(&wk_cutting_force::of(&object.read().soil_resistance(SoilToolId(tool), &blade).map_err(named)?));
        Ok(Status::Ok)
    })
}

/// Drops loose soil of a kind, which the host brings, onto a place of the host's world, at once. `mass_kg` is the mass
/// of the soil, in [0, 1e6] kg. The height of the position does not matter. `out_lands`, which may be NULL, gets 1 if
/// there is ground to land on, else 0.
/// Thread: exclusive.
/// Errors: WK_ERROR_INVALID_ARGUMENT naming the parameter, also where loose soil would lie more than 1000 m deep;
/// WK_ERROR_WRONG_ORDER without soil, and while steps of an update remain.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn wk_context_bring_soil(
    context: *mut wk_context,
    position_m: *const [f64; 3],
    kind: wk_soil_kind_id,
    mass_kg: f64,
    out_lands: *mut u32,
) -> wk_status {
    guard("wk_context_bring_soil", |call| {
        let object = call.get::<ContextObject>("context", context)?;
        let out = layout::optional_out(&"out_lands", out_lands)?;
        // SAFETY: the caller's promise about `position_m`.
        let place = DVec3::from_array(unsafe { position("position_m", position_m)? });
        let kind = kind_id("kind", kind)?;
        let lands = object.write().bring_soil(place, kind, mass_kg).map_err(|e| e.renamed("place", "position_m"))?;
        if let Some(out) = out {
            // SAFETY: checked, and the caller's promise.
            unsafe { out.write(lands.into()) };
        }
        Ok(Status::Ok)
    })
}

/// Gets the ground of the cells nearest to places of the host's world, at most wk_caps.max_batch of them.
/// `position_size` and `point_size` are the distances from one element to the next, bytes: 24 or more for positions,
/// sizeof(wk_soil_point) of your header for points.
/// Thread: concurrent.
/// Errors: WK_ERROR_INVALID_ARGUMENT for an invalid position; WK_ERROR_WRONG_ORDER without soil.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn wk_context_get_soil_points(
    context: *const wk_context,
    positions_m: *const [f64; 3],
    count: u32,
    position_size: u32,
    points: *mut wk_soil_point,
    point_size: u32,
) -> wk_status {
    guard("wk_context_get_soil_points", |call| {
        let object = call.get::<ContextObject>("context", context)?;
        let places = input::Places::new("positions_m", "position_size", positions_m, count, position_size, MAX_BATCH)?;
        let room = input::Room::new("points", "point_size", points, count, point_size)?;
        let context = object.read();
        let answer = |i: usize| {
            let name = format!("positions_m[{i}]");
            // SAFETY: `i` is below the count that the caller promises.
            let at = unsafe { position(&name, places.at(i))? };
            let point = context.soil_at(DVec3::from_array(at)).map_err(|e| e.renamed("place", &name))?;
            Ok(wk_soil_point::of(point))
        };
        let answers = (0..count as usize).map(answer).collect::<Result<Vec<_>>>()?;
        for (i, point) in answers.iter().enumerate() {
            // SAFETY: as above.
            unsafe { room.write(i, point) };
        }
        Ok(Status::Ok)
    })
}

/// Gets the rectangles in which soil has changed heights since a revision of the terrain
/// (wk_context_get_terrain_revision), ordered by rows from the south. A revision of 0 gets all. `*out_count` always
/// gets the number of rectangles. If `capacity` is too small, nothing else is written and the call fails; with capacity
/// 0 it succeeds. `change_size` is sizeof(wk_soil_change) of your header. wk_context_get_soil_cells returns the heights
/// and kinds of a rectangle's cells. Do not pass these heights to wk_context_update_terrain: the tiles are the undug
/// ground.
/// Thread: concurrent.
/// Errors: WK_ERROR_INVALID_ARGUMENT naming the parameter.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn wk_context_get_soil_changes(
    context: *const wk_context,
    since_revision: u64,
    changes: *mut wk_soil_change,
    capacity: u32,
    change_size: u32,
    out_count: *mut u32,
) -> wk_status {
    guard("wk_context_get_soil_changes", |call| {
        let object = call.get::<ContextObject>("context", context)?;
        let count = input::out("out_count", out_count)?;
        let room = input::Room::new("changes", "change_size", changes, capacity, change_size)?;
        let context = object.read();
        let found = context.soil_changes(since_revision).count();
        // SAFETY: `count` was checked and is the caller's.
        unsafe { count.write(found as u32) };
        if capacity > 0 {
            room.check_capacity("capacity", found)?;
            for (i, change) in context.soil_changes(since_revision).enumerate() {
                let change = wk_soil_change {
                    revision: change.revision,
                    tile: [change.tile.east, change.tile.north],
                    first_cell: change.first,
                    cells: change.size,
                };
                // SAFETY: the capacity was checked, and is what the caller promises.
                unsafe { room.write(i, &change) };
            }
        }
        Ok(Status::Ok)
    })
}

/// Gets the ground of a rectangle of a tile's cells, by rows from the south-west: `cells[0]` cells east and `cells[1]`
/// north from `first_cell` on, at most 2^20 in all. `points` must have room for all of them. `point_size` is
/// sizeof(wk_soil_point) of your header.
/// Thread: concurrent.
/// Errors: WK_ERROR_INVALID_ARGUMENT for a key that no tile has, a rectangle that is empty, too large or leaves the
/// tile, or a capacity that is too small; WK_ERROR_WRONG_ORDER without soil.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn wk_context_get_soil_cells(
    context: *const wk_context,
    tile: *const [i32; 2],
    first_cell: *const [u32; 2],
    cells: *const [u32; 2],
    points: *mut wk_soil_point,
    capacity: u32,
    point_size: u32,
) -> wk_status {
    guard("wk_context_get_soil_cells", |call| {
        let object = call.get::<ContextObject>("context", context)?;
        layout::check_pointer(&"tile", tile)?;
        layout::check_pointer(&"first_cell", first_cell)?;
        layout::check_pointer(&"cells", cells)?;
        // SAFETY: checked, and the caller's promises.
        let ([east, north], first, size) = unsafe { (tile.read(), first_cell.read(), cells.read()) };
        let room = input::Room::new("points", "point_size", points, capacity, point_size)?;
        let context = object.read();
        let named = |e: Error| e.map_field(|field| field.replace("size", "cells"));
        let found = context.soil_cells(TileKey::new(east, north), first, size).map_err(named)?;
        room.check_capacity("capacity", found.len())?;
        for (i, point) in found.enumerate() {
            // SAFETY: the capacity was checked, and is what the caller promises.
            unsafe { room.write(i, &wk_soil_point::of(point)) };
        }
        Ok(Status::Ok)
    })
}

/// Gets the balance of the soil's mass.
/// Thread: concurrent.
/// Errors: WK_ERROR_WRONG_ORDER without soil.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn wk_context_get_soil_balance(
    context: *const wk_context,
    out_balance: *mut wk_soil_balance,
) -> wk_status {
    guard("wk_context_get_soil_balance", |call| {
        let object = call.get::<ContextObject>("context", context)?;
        // SAFETY: the caller's promise about `out_balance`.
        let out = unsafe { layout::out_struct(&"out_balance", out_balance)? };
        let books = object.read().soil_books();
        let wanted = "this comes after wk_context_set_soil: there is no soil";
        let books = books.ok_or_else(|| Error::new(Status::WrongOrder, wanted))?;
        out.set(&wk_soil_balance::of(&books));
        Ok(Status::Ok)
    })
}
