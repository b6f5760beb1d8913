//! Lamps
//!
//! Head lights, work lights, search lights: the host's lamps light what Welkin draws in their beams (rain, snow, hail,
//! splashes and clouds) and are reflected in wet ground. The host lights its own world itself.

use std::{ffi::c_void, ptr::null};

use glam::DVec3;

use super::boundary::{
    guard,
    input::{self, List},
    layout::{init_struct, struct_size},
    numbers::*,
    objects::{ContextObject, wk_context},
};
use crate::{
    error::{Error, Status},
    scene::{HostLight, MAX_LIGHTS},
};

include!(concat!(env!("OUT_DIR"), "/init_light.rs"));

/// A lamp of the host.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct wk_light {
    /// sizeof(wk_light) of your header.
    pub struct_size: u32,
    /// WK_STRUCT_TYPE_LIGHT.
    pub struct_type: wk_struct_type,
    /// No extensions in this version: NULL.
    pub next: *const c_void,
    /// Position in the host's world, m, within 1e12 m of the origin. Default 0, 0, 0.
    pub position_m: [f64; 3],
    /// Direction of the beam, in the host's world; any length in [1e-6, 1e6]. Default 0, 1, 0.
    pub direction: [f64; 3],
    /// Luminous intensity in the middle of the beam, cd per channel of linear Rec. 709. Range [0, 1e9], default 1000
    /// each. A low beam has about 10 000 cd, a work light 2000 to 5000 cd.
    pub intensity_cd: [f64; 3],
    /// Angle from the middle of the beam up to which it has full intensity, degrees. Range [0, 180], default 10.
    pub inner_deg: f64,
    /// Angle from the middle of the beam at which it ends, degrees. Range [inner_deg, 180], default 30. If both angles
    /// are 180, the lamp shines to all sides.
    pub outer_deg: f64,
}

impl wk_light {
    pub(crate) const INIT: Self = Self {
        struct_size: struct_size::<Self>(),
        struct_type: WK_STRUCT_TYPE_LIGHT,
        next: null(),
        position_m: [0.0, 0.0, 0.0],
        direction: [0.0, 1.0, 0.0],
        intensity_cd: [1000.0, 1000.0, 1000.0],
        inner_deg: 10.0,
        outer_deg: 30.0,
    };
}

/// Sets the host's lamps, at most 64, and replaces all lamps set before; count 0 removes all. Set moving lamps again in
/// every frame. A failed call changes nothing.
/// Thread: exclusive.
/// Errors: WK_ERROR_INVALID_ARGUMENT naming the element, its field and range.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn wk_context_set_lights(
    context: *mut wk_context,
    lights: *const wk_light,
    count: u32,
    stride: u32,
) -> wk_status {
    guard("wk_context_set_lights", |call| {
        let object = call.get::<ContextObject>("context", context)?;
        let mut list = [None; MAX_LIGHTS];
        let mut take = |i: usize, c: wk_light| {
            let light = HostLight {
                position_m: DVec3::from_array(c.position_m),
                direction: DVec3::from_array(c.direction),
                intensity_cd: c.intensity_cd,
                inner_deg: c.inner_deg,
                outer_deg: c.outer_deg,
            };
            let named = |e: Error| e.renamed("light", &format!("lights[{i}]"));
            light.validate().map_err(named)?;
            list[i] = Some(light);
            Ok(())
        };
        // SAFETY: the caller's promise about `lights`.
        unsafe {
            input::each(&List::parameters("lights", count, stride, MAX_LIGHTS), lights, &mut take)?;
        }
        object.write().set_lights(list.iter().flatten())?;
        Ok(Status::Ok)
    })
}
