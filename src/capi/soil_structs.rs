//! Structs of the soil: kinds and layers, tools and their poses, answers.

use std::{ffi::c_void, ptr::null};

use super::boundary::{layout::struct_size, numbers::*};
use crate::soil::{MAX_SOIL_KINDS, SoilBooks, SoilPoint, SoilToolReport, laws::CuttingForce};

/// Number of a kind of soil: a constant below for a built-in kind, or 7 and more for the kinds in wk_soil.own_kinds, in
/// their order.
pub type wk_soil_kind_id = u32;
/// Moist sand: density of the bank (undisturbed soil) 1794 kg/m^3, swell 12 %, repose 34 degrees, cohesion 1.04 kPa,
/// friction 28 degrees.
pub const WK_SOIL_SAND: wk_soil_kind_id = 0;
/// Dry gravel, with its values in the same order: 1750 kg/m^3, 15 %, 37 degrees, no cohesion, 37 degrees.
pub const WK_SOIL_GRAVEL: wk_soil_kind_id = 1;
/// Dry clay: 1449 kg/m^3, 35 %, 32 degrees, 4.14 kPa, 13 degrees.
pub const WK_SOIL_CLAY: wk_soil_kind_id = 2;
/// Moist sandy loam: 1803 kg/m^3, 25 %, 37 degrees, 1.72 kPa, 29 degrees.
pub const WK_SOIL_LOAM: wk_soil_kind_id = 3;
/// Topsoil: 1561 kg/m^3, 25 %, 37 degrees, 3.3 kPa, 33.7 degrees.
pub const WK_SOIL_TOPSOIL: wk_soil_kind_id = 4;
/// Limestone: 2533 kg/m^3, 63 %, 38 degrees, 1000 kPa, 40 degrees.
pub const WK_SOIL_ROCK: wk_soil_kind_id = 5;
/// Hard coal: 1202 kg/m^3, 35 %, 37 degrees, 100 kPa, 35 degrees.
pub const WK_SOIL_COAL: wk_soil_kind_id = 6;
/// Number of the built-in kinds, and thus the number of the first kind in wk_soil.own_kinds.
pub const WK_SOIL_BUILT_IN_KINDS: u32 = 7;
/// Largest number of kinds, the built-in ones among them.
pub const WK_SOIL_KINDS: u32 = 16;

/// Shape of a tool, which decides how it moves the soil.
pub type wk_soil_tool_shape = u32;
/// Bucket or shovel: cuts with its edge, fills, carries and pours.
pub const WK_SOIL_TOOL_BUCKET: wk_soil_tool_shape = 0;
/// Blade of a dozer or grader: cuts with its edge, and pushes the soil ahead.
pub const WK_SOIL_TOOL_BLADE: wk_soil_tool_shape = 1;
/// Bed of a truck: catches what falls into it, carries and pours, but does not cut.
pub const WK_SOIL_TOOL_BED: wk_soil_tool_shape = 2;
/// Wheel: its edge is the line of contact with the ground, across the wheel's width.
pub const WK_SOIL_TOOL_WHEEL: wk_soil_tool_shape = 3;
/// Crawler track: its edge is the line under the track's middle, across its width.
pub const WK_SOIL_TOOL_TRACK: wk_soil_tool_shape = 4;

/// A kind of soil of the host's own. Element of a list in wk_soil.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct wk_soil_kind {
    /// sizeof(wk_soil_kind) of your header.
    pub struct_size: u32,
    /// WK_STRUCT_TYPE_SOIL_KIND.
    pub struct_type: wk_struct_type,
    /// No extensions in this version: NULL.
    pub next: *const c_void,
    /// Density of the undisturbed soil (bank), kg/m^3. Range [50, 10 000], default 1800.
    pub density_kg_m3: f64,
    /// Growth of volume when the soil is dug, as a share of its bank volume. Range [0, 1.5], default 0.25.
    pub swell: f64,
    /// Angle at which the loose soil rests, degrees. Range [5, 60], default 37.
    pub repose_deg: f64,
    /// Cohesion of moist bank, kPa. Range [0, 10 000], default 2. Soil with 100 kPa or more counts as cemented: water
    /// does not weaken it.
    pub cohesion_kpa: f64,
    /// Friction angle of the bank, degrees. Range [0, 60], default 30.
    pub friction_deg: f64,
    /// 1 if wheels and tracks sink into the soil, by the three numbers below (Bekker 1969); 0, the default, if it
    /// carries them without sinking.
    pub sinks: u32,
    /// Must be 0.
    pub reserved0: u32,
    /// Cohesive modulus kc, kN/m^(n + 1). Range [0, 1e6], default 0.
    pub sinkage_kc: f64,
    /// Frictional modulus kphi, kN/m^(n + 2). Range [0.1, 1e8], default 1500.
    pub sinkage_kphi: f64,
    /// Exponent n of the sinkage in Bekker's law. Range [0.1, 3], default 1.
    pub sinkage_n: f64,
    /// Mean colour of the drawn surface when moist, linear Rec. 709 albedo. Range [0, 1], default that of loam.
    pub albedo: [f64; 3],
}

impl wk_soil_kind {
    pub(crate) const INIT: Self = Self {
        struct_size: struct_size::<Self>(),
        struct_type: WK_STRUCT_TYPE_SOIL_KIND,
        next: null(),
        density_kg_m3: 1800.0,
        swell: 0.25,
        repose_deg: 37.0,
        cohesion_kpa: 2.0,
        friction_deg: 30.0,
        sinks: 0,
        reserved0: 0,
        sinkage_kc: 0.0,
        sinkage_kphi: 1500.0,
        sinkage_n: 1.0,
        albedo: [0.18, 0.106, 0.045],
    };
}

/// Kinds and layers of the ground.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct wk_soil {
    /// sizeof(wk_soil) of your header.
    pub struct_size: u32,
    /// WK_STRUCT_TYPE_SOIL.
    pub struct_type: wk_struct_type,
    /// No extensions in this version: NULL.
    pub next: *const c_void,
    /// Number of kinds in `own_kinds`, at most 9. Default 0.
    pub own_kind_count: u32,
    /// Bytes from one kind to the next: sizeof(wk_soil_kind) of your header, which is the default.
    pub own_kind_stride: u32,
    /// Your own kinds; their numbers follow those of the built-in ones. Copied by the call. Default NULL.
    pub own_kinds: *const wk_soil_kind,
    /// Number of layers, at most 8. Default 0: 0.3 m of topsoil on loam.
    pub horizon_count: u32,
    /// Must be 0.
    pub reserved0: u32,
    /// Depth of each layer's upper side below the undug surface, m: 0 for the first layer, then increasing, up to
    /// 1000. Copied by the call. Default NULL.
    pub horizon_tops_m: *const f64,
    /// Kind of each layer, a wk_soil_kind_id. Copied by the call. Default NULL.
    pub horizon_kinds: *const wk_soil_kind_id,
    /// Share of the pores of the bank that water fills before rain and sun change it. Range [0, 1], default 0.3, moist.
    /// Bank at 0 (dry sand) and at 1 (below the water table) has no cohesion.
    pub saturation: f64,
}

impl wk_soil {
    pub(crate) const INIT: Self = Self {
        struct_size: struct_size::<Self>(),
        struct_type: WK_STRUCT_TYPE_SOIL,
        next: null(),
        own_kind_count: 0,
        own_kind_stride: struct_size::<wk_soil_kind>(),
        own_kinds: null(),
        horizon_count: 0,
        reserved0: 0,
        horizon_tops_m: null(),
        horizon_kinds: null(),
        saturation: 0.3,
    };
}

/// A tool that works the soil.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct wk_soil_tool {
    /// sizeof(wk_soil_tool) of your header.
    pub struct_size: u32,
    /// WK_STRUCT_TYPE_SOIL_TOOL.
    pub struct_type: wk_struct_type,
    /// No extensions in this version: NULL.
    pub next: *const c_void,
    /// Shape of the tool. Default WK_SOIL_TOOL_BUCKET.
    pub shape: wk_soil_tool_shape,
    /// Must be 0.
    pub reserved0: u32,
    /// Volume of a bucket or bed when struck level, m^3. Range [0.001, 1000], default 1. Not used by other tools.
    pub struck_m3: f64,
    /// Slope of the rated heap of a bucket or bed, rise per unit of length: 1, the default, for excavators by SAE J296;
    /// 0.5 by CECE and for loaders (SAE J742). Range [0, 1]. Not used by other tools.
    pub heap_rise: f64,
    /// Diameter of a wheel, m. Range [0.1, 10], default 1. Not used by other tools.
    pub diameter_m: f64,
    /// Length of a track's contact with the ground, m. Range [0.1, 20], default 3. Not used by other tools.
    pub contact_m: f64,
}

impl wk_soil_tool {
    pub(crate) const INIT: Self = Self {
        struct_size: struct_size::<Self>(),
        struct_type: WK_STRUCT_TYPE_SOIL_TOOL,
        next: null(),
        shape: WK_SOIL_TOOL_BUCKET,
        reserved0: 0,
        struck_m3: 1.0,
        heap_rise: 1.0,
        diameter_m: 1.0,
        contact_m: 3.0,
    };
}

/// Pose of a tool at a time. Left and right are as seen by a viewer inside the tool who looks out of its opening. All
/// points lie within 1e7 m of wk_terrain.origin_m.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct wk_soil_pose {
    /// sizeof(wk_soil_pose) of your header.
    pub struct_size: u32,
    /// WK_STRUCT_TYPE_SOIL_POSE.
    pub struct_type: wk_struct_type,
    /// No extensions in this version: NULL.
    pub next: *const c_void,
    /// Simulation time, s. Range [-1e10, 1e10], default 0.
    pub time_s: f64,
    /// Left end of the cutting edge, or of the line of contact of a wheel or track, in the host's world, m. Default 0,
    /// 0, 0.
    pub edge_left_m: [f64; 3],
    /// Right end of the cutting edge or line of contact, 0.05 to 20 m from its left end. Default 0, 0, 0.
    pub edge_right_m: [f64; 3],
    /// Left end of the upper edge of the opening, opposite to the cutting edge and 0.02 to 20 m from it. Not used for
    /// wheels and tracks. Default 0, 0, 0.
    pub upper_left_m: [f64; 3],
    /// Right end of the opening's upper edge, 0.05 to 20 m from its left end. Default 0, 0, 0.
    pub upper_right_m: [f64; 3],
    /// Direction out of the opening in the host's world; any length in [1e-6, 1e6]. Not used for wheels and tracks.
    /// Default 0, 0, 0; must be given for other tools.
    pub facing: [f64; 3],
    /// Load of a wheel or track on the ground, N. Range [0, 1e7], default 0. Not used by other tools.
    pub load_n: f64,
}

impl wk_soil_pose {
    pub(crate) const INIT: Self = Self {
        struct_size: struct_size::<Self>(),
        struct_type: WK_STRUCT_TYPE_SOIL_POSE,
        next: null(),
        time_s: 0.0,
        edge_left_m: [0.0, 0.0, 0.0],
        edge_right_m: [0.0, 0.0, 0.0],
        upper_left_m: [0.0, 0.0, 0.0],
        upper_right_m: [0.0, 0.0, 0.0],
        facing: [0.0, 0.0, 0.0],
        load_n: 0.0,
    };
}

/// Content of a tool, and the soil that it met in the last step of the soil (1/64 s).
#[repr(C)]
#[derive(Clone, Copy)]
pub struct wk_soil_tool_report {
    /// sizeof(wk_soil_tool_report) of your header.
    pub struct_size: u32,
    /// WK_STRUCT_TYPE_SOIL_TOOL_REPORT.
    pub struct_type: wk_struct_type,
    /// No extensions in this version: NULL.
    pub next: *const c_void,
    /// Simulation time of the tool's pose, s.
    pub time_s: f64,
    /// Mass of the soil in the tool, kg.
    pub mass_kg: f64,
    /// Bulk volume of the soil in the tool, m^3.
    pub bulk_m3: f64,
    /// Ratio of bulk_m3 to the rated volume of the tool with its heap.
    pub fill: f64,
    /// Centre of the soil in the tool, in the host's world, m.
    pub centre_m: [f64; 3],
    /// Mass of each kind of soil in the tool, kg, by the kind's number.
    pub kinds_kg: [f64; 16],
    /// Share of the pores of the soil in the tool that water fills, 0 to 1; 0 if the tool is empty.
    pub saturation: f64,
    /// Mean depth of the cut, m.
    pub cut_depth_m: f64,
    /// Deepest sinkage of a wheel or track, m.
    pub sinkage_m: f64,
    /// Kind that makes up most of the soil that was cut.
    pub cut_kind: wk_soil_kind_id,
    /// 1 if the sinkage was limited to half a wheel's radius or half the shorter side of a track's contact, or if it
    /// comes from sinkage numbers that hold for a small range only; else 0.
    pub sinkage_is_beyond_range: u32,
    /// 1 if the edge met ground frozen deeper than 5 cm, which it cannot cut; else 0.
    pub is_stopped_by_frost: u32,
    /// Always 0.
    pub reserved0: u32,
}

const _: () = assert!(MAX_SOIL_KINDS == WK_SOIL_KINDS as usize);

impl wk_soil_tool_report {
    pub(crate) const INIT: Self = Self {
        struct_size: struct_size::<Self>(),
        struct_type: WK_STRUCT_TYPE_SOIL_TOOL_REPORT,
        next: null(),
        time_s: 0.0,
        mass_kg: 0.0,
        bulk_m3: 0.0,
        fill: 0.0,
        centre_m: [0.0, 0.0, 0.0],
        kinds_kg: [0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0],
        saturation: 0.0,
        cut_depth_m: 0.0,
        sinkage_m: 0.0,
        cut_kind: 0,
        sinkage_is_beyond_range: 0,
        is_stopped_by_frost: 0,
        reserved0: 0,
    };

    pub(super) fn of(r: &SoilToolReport) -> Self {
        Self {
            time_s: r.time_s,
            mass_kg: r.mass_kg,
            bulk_m3: r.bulk_m3,
            fill: r.fill,
            centre_m: r.centre.to_array(),
            kinds_kg: r.kinds_kg,
            saturation: r.saturation,
            cut_depth_m: r.cut_depth_m,
            sinkage_m: r.sinkage_m,
            cut_kind: r.cut_kind.0.into(),
            sinkage_is_beyond_range: r.is_sinkage_beyond_range.into(),
            is_stopped_by_frost: r.is_stopped_by_frost.into(),
            ..Self::INIT
        }
    }
}

/// Blade of a tool, for the force of the soil on it.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct wk_soil_blade {
    /// sizeof(wk_soil_blade) of your header.
    pub struct_size: u32,
    /// WK_STRUCT_TYPE_SOIL_BLADE.
    pub struct_type: wk_struct_type,
    /// No extensions in this version: NULL.
    pub next: *const c_void,
    /// Angle of the blade to the horizontal in the direction of motion, degrees; 90 is upright. Range [3, 148], default
    /// 60.
    pub rake_deg: f64,
    /// Friction angle between soil and blade, degrees. Range [0, 68], default 23, steel.
    pub soil_metal_deg: f64,
    /// Adhesion of the soil to the blade, kPa. Range [0, 10 000], default 0.
    pub adhesion_kpa: f64,
    /// Load on the surface in front of the blade, kPa. Range [0, 10 000], default 0.
    pub surcharge_kpa: f64,
}

impl wk_soil_blade {
    pub(crate) const INIT: Self = Self {
        struct_size: struct_size::<Self>(),
        struct_type: WK_STRUCT_TYPE_SOIL_BLADE,
        next: null(),
        rake_deg: 60.0,
        soil_metal_deg: 23.0,
        adhesion_kpa: 0.0,
        surcharge_kpa: 0.0,
    };
}

/// Force of the soil on a blade.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct wk_cutting_force {
    /// sizeof(wk_cutting_force) of your header.
    pub struct_size: u32,
    /// WK_STRUCT_TYPE_CUTTING_FORCE.
    pub struct_type: wk_struct_type,
    /// No extensions in this version: NULL.
    pub next: *const c_void,
    /// Force at the angle soil_metal_deg from the normal of the blade, N: P of the equation at
    /// wk_context_get_soil_resistance.
    pub force_n: f64,
    /// Component of the total force against the motion, N.
    pub horizontal_n: f64,
    /// Component of the total force that pulls the blade down, N; negative where the soil lifts the blade.
    pub vertical_n: f64,
    /// Angle of the plane of failure to the horizontal, degrees.
    pub failure_deg: f64,
}

impl wk_cutting_force {
    pub(crate) const INIT: Self = Self {
        struct_size: struct_size::<Self>(),
        struct_type: WK_STRUCT_TYPE_CUTTING_FORCE,
        next: null(),
        force_n: 0.0,
        horizontal_n: 0.0,
        vertical_n: 0.0,
        failure_deg: 0.0,
    };

    pub(super) fn of(f: &CuttingForce) -> Self {
        Self {
            force_n: f.force_n,
            horizontal_n: f.horizontal_n,
            vertical_n: f.vertical_n,
            failure_deg: f.failure.to_degrees(),
            ..Self::INIT
        }
    }
}

/// Balance of the soil's mass, in whole micrograms. After every call, dug + brought equals lying + held + taken
/// exactly.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct wk_soil_balance {
    /// sizeof(wk_soil_balance) of your header.
    pub struct_size: u32,
    /// WK_STRUCT_TYPE_SOIL_BALANCE.
    pub struct_type: wk_struct_type,
    /// No extensions in this version: NULL.
    pub next: *const c_void,
    /// Bank that was loosened, micrograms. Each number of this struct is limited to the range of its type, 9.2 million
    /// tonnes.
    pub dug_ug: i64,
    /// Soil that the host brought, micrograms.
    pub brought_ug: i64,
    /// Loose soil on the ground, micrograms.
    pub lying_ug: i64,
    /// Soil in buckets and beds, micrograms.
    pub held_ug: i64,
    /// Soil that left with tools that ended, micrograms.
    pub taken_ug: i64,
}

impl wk_soil_balance {
    pub(crate) const INIT: Self = Self {
        struct_size: struct_size::<Self>(),
        struct_type: WK_STRUCT_TYPE_SOIL_BALANCE,
        next: null(),
        dug_ug: 0,
        brought_ug: 0,
        lying_ug: 0,
        held_ug: 0,
        taken_ug: 0,
    };

    pub(super) fn of(books: &SoilBooks) -> Self {
        let [dug_ug, brought_ug, lying_ug, held_ug, taken_ug] =
            [books.dug, books.brought, books.lying, books.held, books.taken]
                .map(|mass| i64::try_from(mass).unwrap_or(i64::MAX));
        Self { dug_ug, brought_ug, lying_ug, held_ug, taken_ug, ..Self::INIT }
    }
}

/// Ground of a cell. Element of an array, without struct_size; calls take its sizeof instead.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct wk_soil_point {
    /// Height of the surface above the terrain's origin, m: the host's height plus change_m.
    pub surface_m: f64,
    /// Change of the height by soil, m: the surface minus the undug height; negative in a pit.
    pub change_m: f64,
    /// Depth of loose soil, m.
    pub loose_m: f64,
    /// Density of the loose soil, kg/m^3; 0 without any.
    pub loose_kg_m3: f64,
    /// Revision of the terrain at the last change by soil in the cell's rectangle of wk_context_get_soil_changes; 0
    /// where nothing was dug.
    pub revision: u64,
    /// Kind of soil on the surface: that of most of the loose soil, or of the bank where no loose soil lies.
    pub kind: wk_soil_kind_id,
    /// 1 if the cell has ground; all other fields are 0 otherwise.
    pub has_ground: u32,
    /// Colour of the dug, loose or pressed soil that shows, linear Rec. 709 albedo.
    pub albedo: [f32; 3],
    /// Share of the cell in which that soil shows, 0 to 1; the undug surface shows in the rest.
    pub covered: f32,
}

impl wk_soil_point {
    pub(super) fn of(point: Option<SoilPoint>) -> Self {
        let none = Self {
            surface_m: 0.0,
            change_m: 0.0,
            loose_m: 0.0,
            loose_kg_m3: 0.0,
            revision: 0,
            kind: 0,
            has_ground: 0,
            albedo: [0.0; 3],
            covered: 0.0,
        };
        point.map_or(none, |p| Self {
            surface_m: p.surface_m,
            change_m: p.change_m,
            loose_m: p.loose_m,
            loose_kg_m3: p.loose_kg_m3,
            revision: p.revision,
            kind: p.kind.0.into(),
            has_ground: 1,
            albedo: p.albedo.map(|v| v as f32),
            covered: p.covered as f32,
        })
    }
}

/// Rectangle of a tile in which soil has changed heights. Element of an array, without struct_size; calls take its
/// sizeof instead.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct wk_soil_change {
    /// Revision of the terrain at the last change.
    pub revision: u64,
    /// Key of the tile.
    pub tile: [i32; 2],
    /// South-western cell of the rectangle in the tile, cells east and north.
    pub first_cell: [u32; 2],
    /// Size of the rectangle, cells east and north.
    pub cells: [u32; 2],
}
