//! Terrain in tiles
//!
//! The host can describe its terrain as a lattice of equal cells, cut into square tiles with keys. The lattice is
//! horizontal and aligned to true north at its origin. Each cell has a height and a class of surface, or is a hole.
//! Tiles can be added and removed, and rectangles of their cells changed. The cost of a change grows with the
//! rectangle, so an excavator's bucket may dig in every frame. Water, the wind field and queries read the tiles. With
//! WK_GROUND_SIMULATED each cell has its own water, and hollows join across the borders of tiles; with
//! WK_GROUND_REPORTED tiles are as wet as level ground. A context has either tiles or one wk_ground_grid.
//!
//! The host's heights are the undug ground. With wk_context_set_soil the library adds what the soil's tools dig and
//! heap, and queries, water, snow and wind see the sum. wk_context_save saves the water and the change by soil, not the
//! host's heights, and wk_context_load requires that the same tiles have been set before. wk_context_set_terrain and
//! the functions of tiles may be called between updates at any time; while an update has steps left (WK_PENDING), a
//! change takes effect after the last of them.

use std::{ffi::c_void, ptr::null};

use glam::DVec3;

use super::{
    boundary::{
        guard,
        input::{self, MAX_BATCH, Named, position},
        layout::{self, init_struct, struct_size},
        numbers::*,
        objects::{ContextObject, wk_context},
    },
    ground::wk_surface_class,
    ground_grid::wk_ground_cell,
};
use crate::{
    error::{Error, Result, Status},
    land::TerrainDrawing,
    terrain::{MAX_TERRAIN_CELLS, Rows, SurfaceClass, TerrainCells, TerrainDesc, TerrainPoint, TileKey},
};

include!(concat!(env!("OUT_DIR"), "/init_terrain.rs"));

/// Value in surface_classes of wk_terrain_cells for a cell without ground. Water beside it runs off.
pub const WK_TERRAIN_HOLE: u32 = 255;

/// The lattice of a terrain in tiles.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct wk_terrain {
    /// sizeof(wk_terrain) of your header.
    pub struct_size: u32,
    /// WK_STRUCT_TYPE_TERRAIN.
    pub struct_type: wk_struct_type,
    /// No extensions in this version: NULL.
    pub next: *const c_void,
    /// Position of the south-western cell of tile (0, 0), in the host's world, m, within 1e12 m of the origin. Heights
    /// of cells are relative to the height of this position. Default 0, 0, 0.
    pub origin_m: [f64; 3],
    /// Distance between cells, m. Range [0.01, 10 000], default 1. A puddle must be several cells wide to appear.
    pub cell_m: f64,
    /// Number of cells along each side of a tile: a power of two from 32 to 1024. Default 256. The tiles of a terrain
    /// may have 16 777 216 cells together.
    pub tile_cells: u32,
    /// Must be 0.
    pub reserved0: u32,
}

impl wk_terrain {
    pub(crate) const INIT: Self = Self {
        struct_size: struct_size::<Self>(),
        struct_type: WK_STRUCT_TYPE_TERRAIN,
        next: null(),
        origin_m: [0.0, 0.0, 0.0],
        cell_m: 1.0,
        tile_cells: 256,
        reserved0: 0,
    };
}

/// Settings with which Welkin draws the tiles of a terrain.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct wk_terrain_drawing {
    /// sizeof(wk_terrain_drawing) of your header.
    pub struct_size: u32,
    /// WK_STRUCT_TYPE_TERRAIN_DRAWING.
    pub struct_type: wk_struct_type,
    /// No extensions in this version: NULL.
    pub next: *const c_void,
    /// Largest vertical error of the drawn triangles on 99.7 % of the ground, pixels. Range [0.25, 16], default 1. It
    /// sets the distance up to which each level of detail is drawn: 40 to 160 times the side of the level's squares.
    /// Ground so rough that it would need a longer distance is drawn with a larger error.
    pub error_px: f64,
    /// Distance from the camera up to which the ground has shadows of the sun and the moon, m. 0 for none, or range
    /// [100, 1e5], default 1e4. A shorter distance makes near shadows sharper. A view with shadows holds up to about 36
    /// MB more: the shadow maps, and the heights of the ground that is drawn into them.
    pub shadows_to_m: f64,
}

impl wk_terrain_drawing {
    pub(crate) const INIT: Self = Self {
        struct_size: struct_size::<Self>(),
        struct_type: WK_STRUCT_TYPE_TERRAIN_DRAWING,
        next: null(),
        error_px: 1.0,
        shadows_to_m: 1e4,
    };
}

/// Heights and classes of a tile, or of a rectangle of its cells. Cells run from west to east, rows from south to
/// north.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct wk_terrain_cells {
    /// sizeof(wk_terrain_cells) of your header.
    pub struct_size: u32,
    /// WK_STRUCT_TYPE_TERRAIN_CELLS.
    pub struct_type: wk_struct_type,
    /// No extensions in this version: NULL.
    pub next: *const c_void,
    /// Key of the tile: its position east and north of the origin in tiles, each within 1 000 000; negative to the west
    /// and south. Default 0, 0.
    pub tile: [i32; 2],
    /// Position of the rectangle's south-western cell in the tile, cells east and north. Default 0, 0.
    pub first_cell: [u32; 2],
    /// Size of the rectangle, cells east and north. Default 0, 0: the whole tile.
    pub cells: [u32; 2],
    /// Heights above the terrain's origin, m, within 1e5. Copied by the call. NULL with a count of 0 leaves the heights
    /// unchanged; a new tile needs them. The height of a hole is not read and may be anything, also NaN.
    pub heights_m: *const f32,
    /// Length of heights_m: at least (rows - 1) x stride + columns of the rectangle.
    pub height_count: u32,
    /// Number of elements of heights_m from the beginning of a row to that of the next. Default 0: the columns of the
    /// rectangle, so that rows follow without a gap.
    pub height_stride: u32,
    /// Class of each cell: a wk_surface_class, 0 to use the context's default, or WK_TERRAIN_HOLE. Copied by the call.
    /// NULL with a count of 0 leaves the classes unchanged; in a new tile they are then 0.
    pub surface_classes: *const u8,
    /// Length of surface_classes: at least (rows - 1) x stride + columns of the rectangle.
    pub surface_class_count: u32,
    /// Number of elements of surface_classes from the beginning of a row to that of the next. Default 0: the columns of
    /// the rectangle, so that rows follow without a gap.
    pub surface_class_stride: u32,
    /// 1 if no_data_m is used; 0, the default, if every number in heights_m is a height.
    pub has_no_data: u32,
    /// Number in heights_m for cells without data, such as -9999, -32768, or your source's own; NaN then also means no
    /// data. These cells become holes. A hole becomes ground again when surface_classes gives it a class. The call
    /// fails if the number is also a real height: in a cell to which surface_classes gives a class other than 0, or in
    /// a cell with ground in the same tile outside the rectangle. Default 0.
    pub no_data_m: f32,
}

impl wk_terrain_cells {
    pub(crate) const INIT: Self = Self {
        struct_size: struct_size::<Self>(),
        struct_type: WK_STRUCT_TYPE_TERRAIN_CELLS,
        next: null(),
        tile: [0, 0],
        first_cell: [0, 0],
        cells: [0, 0],
        heights_m: null(),
        height_count: 0,
        height_stride: 0,
        surface_classes: null(),
        surface_class_count: 0,
        surface_class_stride: 0,
        has_no_data: 0,
        no_data_m: 0.0,
    };
}

/// Terrain at a queried place. Element of an array, without struct_size; calls take its sizeof instead.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct wk_terrain_point {
    /// Height of the ground above the terrain's origin, m, on the triangle of three neighbouring cells: each square of
    /// four cells is split from its south-western to its north-eastern cell. 0 where there is no ground.
    pub height_m: f64,
    /// Unit normal of the ground's triangle in the host's axes, upwards; 0, 0, 0 where there is no ground.
    pub normal: [f64; 3],
    /// Revision of the terrain at the last change of the nearest cell's tile. 0 where there is no ground.
    pub revision: u64,
    /// Key of the nearest cell's tile.
    pub tile: [i32; 2],
    /// Material of the nearest cell; WK_SURFACE_CLASS_UNSPECIFIED if it has none.
    pub surface_class: wk_surface_class,
    /// 1 on the ground of a tile; 0 off all tiles, and on a triangle with a corner that is a hole or lies off all
    /// tiles.
    pub has_ground: u32,
}

impl wk_terrain_point {
    fn of(point: Option<TerrainPoint>) -> Self {
        let none = Self { height_m: 0.0, normal: [0.0; 3], revision: 0, tile: [0, 0], surface_class: 0, has_ground: 0 };
        point.map_or(none, |p| Self {
            height_m: p.height_m,
            normal: p.normal.to_array(),
            revision: p.revision,
            tile: [p.tile.east, p.tile.north],
            surface_class: p.surface_class as wk_surface_class,
            has_ground: 1,
        })
    }
}

/// Sets the lattice of a terrain in tiles, which has no tiles at first. The lattice replaces all tiles or the
/// wk_ground_grid set before; NULL removes a lattice with its tiles. Setting the present lattice again keeps its tiles.
/// Unchanged after an error.
/// Thread: exclusive.
/// Errors: WK_ERROR_INVALID_ARGUMENT naming the field and its range.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn wk_context_set_terrain(context: *mut wk_context, terrain: *const wk_terrain) -> wk_status {
    guard("wk_context_set_terrain", |call| {
        let object = call.get::<ContextObject>("context", context)?;
        if terrain.is_null() {
            object.write().set_terrain(None)?;
            return Ok(Status::Ok);
        }
        // SAFETY: the caller's promise about `terrain`.
        let c = unsafe {
            let c = layout::read(&"terrain", terrain)?;
            layout::check_chain(&"terrain", c.next, &[])?;
            c
        };
        let origin = DVec3::from_array(c.origin_m);
        let desc = TerrainDesc { origin, cell_m: c.cell_m, tile_cells: c.tile_cells };
        object.write().set_terrain(Some(desc))?;
        Ok(Status::Ok)
    })
}

/// Lists of heights and classes of a rectangle of cells.
struct CellLists<'a> {
    cells: wk_terrain_cells,
    heights_m: &'a [f32],
    classes: Vec<Option<SurfaceClass>>,
}

impl CellLists<'_> {
    /// # Safety
    /// `cells` is NULL or points to a struct whose lists are as long as it says.
    unsafe fn read(cells: *const wk_terrain_cells) -> Result<Self> {
        // SAFETY: the caller's promise.
        let (c, heights_m, numbers) = unsafe {
            let c = layout::read(&"terrain_cells", cells)?;
            layout::check_chain(&"terrain_cells", c.next, &[])?;
            let heights = Named("terrain_cells.height_count", c.height_count as usize);
            let classes = Named("terrain_cells.surface_class_count", c.surface_class_count as usize);
            let heights = input::slice("terrain_cells.heights_m", c.heights_m, heights, MAX_TERRAIN_CELLS)?;
            (c, heights, input::slice("terrain_cells.surface_classes", c.surface_classes, classes, MAX_TERRAIN_CELLS)?)
        };
        let class = |(i, number): (usize, &u8)| match u32::from(*number) {
            WK_TERRAIN_HOLE => Ok(None),
            _ => {
                let name = format!("terrain_cells.surface_classes[{i}]");
                let known = SurfaceClass::from_number(&name, *number).map(Some);
                let wanted = "a WK_SURFACE_CLASS_ value, 0 to 6, or WK_TERRAIN_HOLE";
                known.map_err(|_| Error::range(&name, wanted, *number))
            }
        };
        let classes = numbers.iter().enumerate().map(class).collect::<Result<_>>()?;
        Ok(Self { cells: c, heights_m, classes })
    }

    fn terrain_cells(&self) -> TerrainCells<'_> {
        let c = &self.cells;
        TerrainCells {
            key: TileKey::new(c.tile[0], c.tile[1]),
            first: c.first_cell,
            size: c.cells,
            heights_m: Rows { values: self.heights_m, stride: c.height_stride },
            classes: Rows { values: &self.classes, stride: c.surface_class_stride },
            no_data_m: (c.has_no_data != 0).then_some(c.no_data_m),
        }
    }
}

/// Renames the lists in an error to the header's fields.
fn named(e: Error) -> Error {
    e.renamed("terrain_cells.heights_m.len", "terrain_cells.height_count")
        .renamed("terrain_cells.heights_m_stride", "terrain_cells.height_stride")
        .renamed("terrain_cells.surface_classes.len", "terrain_cells.surface_class_count")
        .renamed("terrain_cells.surface_classes_stride", "terrain_cells.surface_class_stride")
}

/// Adds a tile, or replaces the values of all cells of an existing tile. A new tile begins as wet as level ground; an
/// existing one keeps its water. The call takes some tens of milliseconds for 256 x 256 cells. Unchanged after an
/// error.
/// Thread: exclusive.
/// Errors: WK_ERROR_WRONG_ORDER before wk_context_set_terrain; WK_ERROR_INVALID_ARGUMENT naming the field, or for more
/// cells than a terrain may have.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn wk_context_set_terrain_tile(
    context: *mut wk_context,
    terrain_cells: *const wk_terrain_cells,
) -> wk_status {
    guard("wk_context_set_terrain_tile", |call| {
        let object = call.get::<ContextObject>("context", context)?;
        // SAFETY: the caller's promise about `terrain_cells`.
        let lists = unsafe { CellLists::read(terrain_cells)? };
        object.write().set_terrain_tile(&lists.terrain_cells()).map_err(named)?;
        Ok(Status::Ok)
    })
}

/// Changes the heights, the classes, or both, of a rectangle of a tile's cells. Water that stands there flows as the
/// new ground allows: off a raised floor, into a new pit. The cost grows with the rectangle and with the standing water
/// that it touches, not with the tile or the terrain. Unchanged after an error.
/// Thread: exclusive.
/// Errors: as wk_context_set_terrain_tile; WK_ERROR_INVALID_ARGUMENT for a key that no tile has.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn wk_context_update_terrain(
    context: *mut wk_context,
    terrain_cells: *const wk_terrain_cells,
) -> wk_status {
    guard("wk_context_update_terrain", |call| {
        let object = call.get::<ContextObject>("context", context)?;
        // SAFETY: the caller's promise about `terrain_cells`.
        let lists = unsafe { CellLists::read(terrain_cells)? };
        object.write().update_terrain(&lists.terrain_cells()).map_err(named)?;
        Ok(Status::Ok)
    })
}

/// Removes a tile and the water on it. Water of the other tiles runs off where the tile was.
/// Thread: exclusive.
/// Errors: WK_ERROR_WRONG_ORDER before wk_context_set_terrain; WK_ERROR_INVALID_ARGUMENT for a key that no tile has.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn wk_context_remove_terrain_tile(
    context: *mut wk_context,
    tile_east: i32,
    tile_north: i32,
) -> wk_status {
    guard("wk_context_remove_terrain_tile", |call| {
        let object = call.get::<ContextObject>("context", context)?;
        let key = TileKey::new(tile_east, tile_north);
        object.write().remove_terrain_tile(key).map_err(|e| e.renamed("tile", "tile_east"))?;
        Ok(Status::Ok)
    })
}

/// Sets whether and how Welkin draws the tiles into frames whose depth it may write, in WK_STAGE_SURFACE. NULL, the
/// default, leaves them to the host. Settings are not saved. Unchanged after an error.
/// Thread: exclusive.
/// Errors: WK_ERROR_INVALID_ARGUMENT naming the field and its range.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn wk_context_set_terrain_drawing(
    context: *mut wk_context,
    terrain_drawing: *const wk_terrain_drawing,
) -> wk_status {
    guard("wk_context_set_terrain_drawing", |call| {
        let object = call.get::<ContextObject>("context", context)?;
        if terrain_drawing.is_null() {
            object.write().set_terrain_drawing(None)?;
            return Ok(Status::Ok);
        }
        // SAFETY: the caller's promise about `terrain_drawing`.
        let c = unsafe {
            let c = layout::read(&"terrain_drawing", terrain_drawing)?;
            layout::check_chain(&"terrain_drawing", c.next, &[])?;
            c
        };
        object
            .write()
            .set_terrain_drawing(Some(TerrainDrawing { error_px: c.error_px, shadows_to_m: c.shadows_to_m }))?;
        Ok(Status::Ok)
    })
}

/// Gets a number that grows whenever the host changes the tiles or soil changes their heights; 0 without a terrain.
/// Thread: concurrent.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn wk_context_get_terrain_revision(
    context: *const wk_context,
    out_revision: *mut u64,
) -> wk_status {
    guard("wk_context_get_terrain_revision", |call| {
        let object = call.get::<ContextObject>("context", context)?;
        let revision = input::out("out_revision", out_revision)?;
        // SAFETY: `revision` was checked and is the caller's.
        unsafe { revision.write(object.read().terrain_revision()) };
        Ok(Status::Ok)
    })
}

/// Gets the terrain straight below or above places of the host's world, at most wk_caps.max_batch of them.
/// `position_size` and `point_size` are the distances from one element to the next, bytes: 24 or more for positions,
/// sizeof(wk_terrain_point) of your header for points.
/// Thread: concurrent.
/// Errors: WK_ERROR_INVALID_ARGUMENT for an invalid position.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn wk_context_get_terrain_at(
    context: *const wk_context,
    positions_m: *const [f64; 3],
    count: u32,
    position_size: u32,
    points: *mut wk_terrain_point,
    point_size: u32,
) -> wk_status {
    guard("wk_context_get_terrain_at", |call| {
        let object = call.get::<ContextObject>("context", context)?;
        let places = input::Places::new("positions_m", "position_size", positions_m, count, position_size, MAX_BATCH)?;
        let room = input::Room::new("points", "point_size", points, count, point_size)?;
        let context = object.read();
        let answer = |i: usize| {
            let name = format!("positions_m[{i}]");
            // SAFETY: `i` is below the count that the caller promises.
            let at = unsafe { position(&name, places.at(i))? };
            let point = context.terrain_at(DVec3::from_array(at)).map_err(|e| e.renamed("position", &name))?;
            Ok(wk_terrain_point::of(point))
        };
        let answers = (0..count as usize).map(answer).collect::<Result<Vec<_>>>()?;
        for (i, point) in answers.iter().enumerate() {
            // SAFETY: as above.
            unsafe { room.write(i, point) };
        }
        Ok(Status::Ok)
    })
}

/// Copies the water of a tile's cells as of wk_context_get_state_time, by rows from the south-west; `cell_size` is
/// sizeof(wk_ground_cell) of your header. Holes are dry. `out_revision` gets a number that changes whenever water on
/// the terrain changes; with capacity 0 the call returns only this number.
/// Thread: concurrent.
/// Errors: WK_ERROR_INVALID_ARGUMENT for a key that no tile has, or a capacity other than 0 that is too small.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn wk_context_get_terrain_water(
    context: *const wk_context,
    tile_east: i32,
    tile_north: i32,
    cells: *mut wk_ground_cell,
    capacity: u32,
    cell_size: u32,
    out_revision: *mut u64,
) -> wk_status {
    guard("wk_context_get_terrain_water", |call| {
        let object = call.get::<ContextObject>("context", context)?;
        let room = input::Room::new("cells", "cell_size", cells, capacity, cell_size)?;
        let revision = input::out("out_revision", out_revision)?;
        let context = object.read();
        let water = context.terrain_water(TileKey::new(tile_east, tile_north)).ok_or_else(|| {
            let got = format!("({tile_east}, {tile_north})");
            Error::range("tile_east", "with tile_north the key of a tile that was set", got)
        })?;
        if capacity > 0 {
            room.check_capacity("capacity", water.len())?;
            for (i, cell) in water.enumerate() {
                // SAFETY: the capacity was checked, and is what the caller promises.
                unsafe { room.write(i, &wk_ground_cell::of(&cell)) };
            }
        }
        // SAFETY: `revision` was checked and is the caller's.
        unsafe { revision.write(context.ground_revision()) };
        Ok(Status::Ok)
    })
}
