//! Water on the windscreen
//!
//! A view may look through a window. Rain lands on it at the rate and speed with which the window meets the drops.
//! Beads merge, run down by gravity or up with the air, are wiped, and refract the picture behind them. Mist on the
//! inside blurs the picture. Snow lies on the window until wipers remove it or heat melts it. The stage LENS draws
//! water, mist and snow over everything drawn so far, inside the window only. Masked pixels stay the host's. In a call
//! with TONE, the glass is drawn before the tone curve if the target is a float one, else after it.
//!
//! The water is part of the view. It moves in steps of 1/60 s, counted from simulation time 0. Each frame computes its
//! steps when it records WK_STAGE_PREPARE or, without that, its first later stage. The water does not depend on the
//! frame rate, and views of one seed and history agree bit for bit. At the first frame, after WK_FRAME_CUT, and when a
//! frame comes more than half a second after the one before, the water takes the default state of that time: a function
//! of seed, time and rain. With WK_FRAME_NO_HISTORY it always has that state. LENS costs nothing without a windscreen,
//! or while the whole of it is dry and clear.

use std::{ffi::c_void, ptr::null};

use glam::DVec3;

use super::boundary::{
    guard,
    input::{self, List, Named},
    layout::{self, init_struct, struct_size},
    numbers::*,
    objects::{ViewObject, wk_view},
};
use crate::{
    error::{Result, Status},
    glass::{MAX_ARMS, Pane, Windscreen, WiperArm},
};

include!(concat!(env!("OUT_DIR"), "/init_windscreen.rs"));

/// Shape of the glass.
pub type wk_windscreen_pane = u32;
/// A flat window of four corners.
pub const WK_WINDSCREEN_PANE_QUAD: wk_windscreen_pane = 0;
/// Glass across the whole view.
pub const WK_WINDSCREEN_PANE_WHOLE_VIEW: wk_windscreen_pane = 1;

/// A wiper: a blade on an arm that turns about a pivot in the glass's plane.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct wk_wiper_arm {
    /// sizeof(wk_wiper_arm) of your header.
    pub struct_size: u32,
    /// WK_STRUCT_TYPE_WIPER_ARM.
    pub struct_type: wk_struct_type,
    /// No extensions in this version: NULL.
    pub next: *const c_void,
    /// Position of the pivot along the glass, m to the right of and above the lower left corner of the pane's bounding
    /// rectangle. Range [-4, 12] each. Default 0, 0.
    pub pivot_m: [f64; 2],
    /// Distance from the pivot to the blade's outer end, m. Range [0.01, 3], default 0.6.
    pub length_m: f64,
    /// Distance from the pivot to the blade's inner end, m. Range [0, length_m), default 0.1.
    pub inner_radius_m: f64,
    /// Angle of the parked blade, degrees anticlockwise from the glass's right as seen from the camera. Range
    /// [-360, 360], default 0.
    pub parked_deg: f64,
    /// Angle at the far end of the stroke, degrees, within 350 of parked_deg. Default 90.
    pub far_deg: f64,
    /// Position of the blade in this frame: 0 parked, 1 at the far end. Range [0, 1], default 0. The blade moves at
    /// constant speed from one frame to the next.
    pub position: f64,
    /// Width of the rubber on the glass, m. Range [0, 0.1], default 0.006.
    pub blade_width_m: f64,
}

impl wk_wiper_arm {
    pub(crate) const INIT: Self = Self {
        struct_size: struct_size::<Self>(),
        struct_type: WK_STRUCT_TYPE_WIPER_ARM,
        next: null(),
        pivot_m: [0.0, 0.0],
        length_m: 0.6,
        inner_radius_m: 0.1,
        parked_deg: 0.0,
        far_deg: 90.0,
        position: 0.0,
        blade_width_m: 0.006,
    };
}

/// The window that a view looks through.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct wk_windscreen {
    /// sizeof(wk_windscreen) of your header.
    pub struct_size: u32,
    /// WK_STRUCT_TYPE_WINDSCREEN.
    pub struct_type: wk_struct_type,
    /// No extensions in this version: NULL.
    pub next: *const c_void,
    /// Shape of the glass. Default WK_WINDSCREEN_PANE_QUAD.
    pub pane: wk_windscreen_pane,
    /// Number of wipers in `arms`, at most 2. Default 0.
    pub arm_count: u32,
    /// Corners of a QUAD: lower left, lower right, upper right and upper left as seen from the camera. Each is three
    /// numbers in the camera's axes (x right, y up, z backwards), m from the camera. The window is flat within 2 % of
    /// its diagonal, and convex. Its edges are 0.05 to 8 m long, and no coordinate of a corner exceeds 20 m. Its slope
    /// relative to gravity follows from the frame's view matrix. Default 1 m x 0.6 m across the view, 0.7 m away.
    pub corners_m: [f64; 12],
    /// Distance of the glass of a WHOLE_VIEW, m. Range [0.1, 3], default 0.6.
    pub distance_m: f64,
    /// Velocity of the glass relative to the air (the vehicle's minus the wind's) in the camera's axes, m/s; it decides
    /// how many drops the glass meets. Range [-400, 400] each, default 0, 0, 0.
    pub velocity_m_s: [f64; 3],
    /// Speed of the air along the glass, upwards, as close to the glass as a bead is high, m/s. It drives the beads.
    /// About 0.7 of the vehicle's speed on a car's windscreen, 0 on upright glass. Range [-100, 100], default 0.
    pub airflow_m_s: f64,
    /// Share of the weather's rain that reaches the glass, such as 0 in a tunnel that you have not described as a
    /// shelter. Shelters and occluder maps keep rain off each part of the pane separately. A box that contains the
    /// camera and ends within 3 m in front of the glass is the vehicle's own, and keeps no rain off. Range [0, 1],
    /// default 1.
    pub exposed: f64,
    /// Amount of mist on the inside. Range [0, 1], default 0.
    pub fogging: f64,
    /// Share of the pane that the blower has cleared of mist, from the lower edge upwards. Range [0, 1], default 0.
    pub demist: f64,
    /// The wipers; may be NULL if there are none. Read during the call only.
    pub arms: *const wk_wiper_arm,
    /// Bytes from one wiper to the next: sizeof(wk_wiper_arm) of your header, which is the default.
    pub arm_stride: u32,
    /// Must be 0.
    pub reserved0: u32,
    /// Heat that wires in the glass or a blower give to the glass, W/m^2. It melts snow once it exceeds the loss to
    /// cold air. A heated windscreen has about 600. Range [0, 3000], default 0.
    pub heat_w_m2: f64,
}

impl wk_windscreen {
    pub(crate) const INIT: Self = Self {
        struct_size: struct_size::<Self>(),
        struct_type: WK_STRUCT_TYPE_WINDSCREEN,
        next: null(),
        pane: WK_WINDSCREEN_PANE_QUAD,
        arm_count: 0,
        corners_m: [-0.5, -0.3, -0.7, 0.5, -0.3, -0.7, 0.5, 0.3, -0.7, -0.5, 0.3, -0.7],
        distance_m: 0.6,
        velocity_m_s: [0.0, 0.0, 0.0],
        airflow_m_s: 0.0,
        exposed: 1.0,
        fogging: 0.0,
        demist: 0.0,
        arms: null(),
        arm_stride: struct_size::<wk_wiper_arm>(),
        reserved0: 0,
        heat_w_m2: 0.0,
    };
}

/// Water on a windscreen.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct wk_windscreen_report {
    /// sizeof(wk_windscreen_report) of your header.
    pub struct_size: u32,
    /// WK_STRUCT_TYPE_WINDSCREEN_REPORT.
    pub struct_type: wk_struct_type,
    /// No extensions in this version: NULL.
    pub next: *const c_void,
    /// Number of drops that hit the pane in a second (rain drops from 0.1 mm in diameter).
    pub drops_per_s: f64,
    /// Rate of the water that hits the pane, mm/h on its area.
    pub water_mm_h: f64,
    /// Share of the pane under water, 0 to 1.
    pub covered: f64,
    /// Mass of the water on the pane, kg.
    pub water_kg: f64,
    /// Simulation time of the state, s.
    pub state_time_s: f64,
    /// Mass of the water in the snow on the pane, kg.
    pub snow_kg: f64,
}

impl wk_windscreen_report {
    pub(crate) const INIT: Self = Self {
        struct_size: struct_size::<Self>(),
        struct_type: WK_STRUCT_TYPE_WINDSCREEN_REPORT,
        next: null(),
        drops_per_s: 0.0,
        water_mm_h: 0.0,
        covered: 0.0,
        water_kg: 0.0,
        state_time_s: 0.0,
        snow_kg: 0.0,
    };
}

/// # Safety
/// `p` is NULL or points to a `wk_windscreen` whose list of arms has `arm_count` elements.
unsafe fn windscreen(p: *const wk_windscreen) -> Result<Windscreen> {
    // SAFETY: the caller's promise.
    let c = unsafe { layout::read(&"windscreen", p)? };
    // SAFETY: as above.
    unsafe { layout::check_chain(&"windscreen", c.next, &[])? };
    let mut arms = [None; MAX_ARMS];
    let list = List {
        name: "windscreen.arms",
        count: Named("windscreen.arm_count", c.arm_count as usize),
        stride: Named("windscreen.arm_stride", c.arm_stride as usize),
        limit: MAX_ARMS,
    };
    // SAFETY: the caller's promise.
    unsafe {
        input::each(&list, c.arms, &mut |i, a: wk_wiper_arm| {
            arms[i] = Some(WiperArm {
                pivot_m: a.pivot_m,
                length_m: a.length_m,
                inner_radius_m: a.inner_radius_m,
                parked_deg: a.parked_deg,
                far_deg: a.far_deg,
                position: a.position,
                blade_width_m: a.blade_width_m,
            });
            Ok(())
        })?;
    }
    let corner = |i: usize| DVec3::from_slice(&c.corners_m[3 * i..3 * i + 3]);
    let screen = Windscreen {
        pane: match c.pane {
            WK_WINDSCREEN_PANE_WHOLE_VIEW => Pane::WholeView(c.distance_m),
            _ => Pane::Quad(std::array::from_fn(corner)),
        },
        velocity_m_s: DVec3::from_array(c.velocity_m_s),
        airflow_m_s: c.airflow_m_s,
        exposed: c.exposed,
        fogging: c.fogging,
        demist: c.demist,
        arms,
        heat_w_m2: c.heat_w_m2,
    };
    screen.validate()?;
    Ok(screen)
}

/// Sets the window that the view looks through; NULL removes it. While the vehicle drives, the wipers move or the
/// camera turns, set it again before each frame: the water stays on the glass as long as the glass keeps its size.
/// Unchanged after an error. With a window, recording the stage LENS gives WK_ERROR_UNSUPPORTED for multisampled colour
/// and for parallel projections.
/// Thread: exclusive on the view.
/// Errors: WK_ERROR_INVALID_ARGUMENT naming the field and its range.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn wk_view_set_windscreen(view: *mut wk_view, windscreen: *const wk_windscreen) -> wk_status {
    guard("wk_view_set_windscreen", |call| {
        let object = call.get::<ViewObject>("view", view)?;
        // SAFETY: the caller's promise about `windscreen`.
        let screen = if windscreen.is_null() { None } else { Some(unsafe { self::windscreen(windscreen)? }) };
        object.cell.drain();
        object.lock().set_windscreen(screen.as_ref())?;
        Ok(Status::Ok)
    })
}

/// Gets the amount of water on the view's windscreen as of its last frame, and the rate at which it lands. The call
/// reads the state back and waits for the GPU: use it now and then, not in every frame. All fields are 0 without a
/// windscreen or before the view's first frame.
/// Thread: exclusive on the view.
/// Errors: WK_ERROR_DEVICE_LOST.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn wk_view_get_windscreen_report(
    view: *mut wk_view,
    out_report: *mut wk_windscreen_report,
) -> wk_status {
    guard("wk_view_get_windscreen_report", |call| {
        let object = call.get::<ViewObject>("view", view)?;
        // SAFETY: the caller's promise about `out_report`.
        let place = unsafe { layout::out_struct(&"out_report", out_report)? };
        object.cell.drain();
        let report = object.lock().windscreen_report()?.filter(|r| r.state_time_s.is_finite()).unwrap_or_default();
        place.set(&wk_windscreen_report {
            drops_per_s: report.drops_per_s,
            water_mm_h: report.water_mm_h,
            covered: report.covered,
            water_kg: report.water_m3 * crate::glass::laws::WATER,
            state_time_s: report.state_time_s,
            snow_kg: report.snow_m3 * crate::glass::laws::WATER,
            ..wk_windscreen_report::INIT
        });
        Ok(Status::Ok)
    })
}
