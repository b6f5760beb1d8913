//! How the sky is drawn
//!
//! There are four models of the sky. They share the functions by which a pixel looks up the tables, and differ in the
//! tables. Use the default model: 95 % of its pixels are within 2.4 % of converged multiple scattering in clear air and
//! haze. The other models are for comparison and for slow machines. Put a wk_sky_settings into wk_context_desc.next, or
//! pass it to wk_context_set_sky_settings later.

use std::{ffi::c_void, ptr::null};

use super::boundary::{
    guard,
    layout::{self, init_struct, struct_size},
    numbers::*,
    objects::{ContextObject, wk_context},
};
use crate::{
    error::Status,
    sky::{SkyModel, SkySettings},
};

include!(concat!(env!("OUT_DIR"), "/init_sky.rs"));

/// Model of the sky.
pub type wk_sky_model = u32;
/// Multiple scattering keeps its dependence on direction, order by order. The default.
pub const WK_SKY_DIRECTIONAL: wk_sky_model = 0;
/// Multiple scattering is the same in all directions (Hillaire 2020); less accurate and quicker to build. docs/lab
/// charts both.
pub const WK_SKY_ISOTROPIC: wk_sky_model = 1;
/// Single scattering alone, from a table over altitude, view angle and sun angle (Elek 2008), as in older systems;
/// multiple scattering is missing.
pub const WK_SKY_TABLE_3D: wk_sky_model = 2;
/// As the default, but single scattering is ray-marched in every pixel: a reference for the tables.
pub const WK_SKY_BRUTE_FORCE: wk_sky_model = 3;

/// Model of the sky and sizes of its tables. An extension: put it into wk_context_desc.next. Or set it later by
/// wk_context_set_sky_settings, with `next` NULL.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct wk_sky_settings {
    /// sizeof(wk_sky_settings) of your header.
    pub struct_size: u32,
    /// WK_STRUCT_TYPE_SKY_SETTINGS.
    pub struct_type: wk_struct_type,
    /// The next extension. Default NULL.
    pub next: *const c_void,
    /// Model of the sky. Default WK_SKY_DIRECTIONAL.
    pub model: wk_sky_model,
    /// Orders of scattering that are computed one by one; a geometric series replaces the higher ones. Range [3, 16],
    /// default 5.
    pub orders: u32,
    /// Number of sun angles in the planet's tables. Range [16, 128], default 64.
    pub suns: u32,
    /// Number of altitudes in the planet's tables. Range [8, 64], default 22.
    pub altitudes: u32,
    /// Number of azimuths over [0, pi] in an observer's sky table. Range [8, 256], default 40.
    pub sky_azimuths: u32,
    /// Rows above the horizon in an observer's sky table. Range [8, 256], default 80.
    pub sky_above: u32,
    /// Rows below the horizon in an observer's sky table. Range [8, 256], default 40.
    pub sky_below: u32,
    /// Number of distances in the table of the air in front of objects. Range [4, 64], default 16.
    pub air_slices: u32,
    /// Steps of the ray march in each pixel (WK_SKY_BRUTE_FORCE), rounded up to a multiple of 4. Range [1, 4096],
    /// default 64.
    pub march_cells: u32,
    /// Number of wavelengths that the sky is computed for, a multiple of 3. Range [3, 15]; 3 (the default) and 0 mean
    /// the planet's own three. More wavelengths give truer colours at a low sun: the error of the worst channel,
    /// relative to the luminance, is 6 % with 3 wavelengths and 2.4 % with 9; with 15 it is within 1 % of the result
    /// with 40. The time to build tables grows in proportion, both for a change of air and for a moving sun: with 15
    /// wavelengths it is five times as long. The cost of a pixel stays the same. WK_SKY_DIRECTIONAL and
    /// WK_SKY_ISOTROPIC only.
    pub wavelengths: u32,
}

impl wk_sky_settings {
    pub(crate) const INIT: Self = Self {
        struct_size: struct_size::<Self>(),
        struct_type: WK_STRUCT_TYPE_SKY_SETTINGS,
        next: null(),
        model: WK_SKY_DIRECTIONAL,
        orders: 5,
        suns: 64,
        altitudes: 22,
        sky_azimuths: 40,
        sky_above: 80,
        sky_below: 40,
        air_slices: 16,
        march_cells: 64,
        wavelengths: 3,
    };

    /// Converts to the Rust API's settings.
    pub(super) fn to_rust(self) -> SkySettings {
        SkySettings {
            model: match self.model {
                WK_SKY_ISOTROPIC => SkyModel::IsotropicTables,
                WK_SKY_TABLE_3D => SkyModel::Table3d,
                WK_SKY_BRUTE_FORCE => SkyModel::BruteForce,
                _ => SkyModel::Directional,
            },
            wavelengths: if self.wavelengths == 0 { 3 } else { self.wavelengths },
            orders: self.orders,
            suns: self.suns,
            altitudes: self.altitudes,
            sky_azimuths: self.sky_azimuths,
            sky_above: self.sky_above,
            sky_below: self.sky_below,
            air_slices: self.air_slices,
            march_cells: self.march_cells,
            // The remaining settings are internal to the sky and may change with its method.
            ..SkySettings::default()
        }
    }
}

/// Changes how the sky is drawn, as a wk_sky_settings in wk_context_desc.next does for a new context. `settings` NULL
/// means WK_SKY_SETTINGS_INIT. Views use the new tables from their next frame on. That frame shows a draft of the sky,
/// as a first frame does, unless wk_context_build_sky has prepared the final picture after this call. Pipelines of
/// another model are compiled in that frame. Setting the same values again changes nothing.
/// Thread: exclusive.
/// Errors: WK_ERROR_INVALID_ARGUMENT naming the field; WK_ERROR_DEVICE_LOST. After an error the settings stay as they
/// were.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn wk_context_set_sky_settings(
    context: *mut wk_context,
    settings: *const wk_sky_settings,
) -> wk_status {
    guard("wk_context_set_sky_settings", |call| {
        let object = call.get::<ContextObject>("context", context)?;
        // SAFETY: the caller's promise.
        let c = unsafe { layout::read_or_default(&"settings", settings)? };
        // SAFETY: as above.
        unsafe { layout::check_chain(&"settings", c.next, &[])? };
        let settings = c.to_rust();
        settings.check().map_err(|e| e.within("settings"))?;
        object.cell.drain();
        object.write().set_sky_settings(&settings)?;
        Ok(Status::Ok)
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn defaults_are_those_of_the_sky() {
        assert_eq!(wk_sky_settings::INIT.to_rust(), SkySettings::default());
        let older = wk_sky_settings { wavelengths: 0, ..wk_sky_settings::INIT };
        assert_eq!(older.to_rust(), SkySettings::default());
    }
}
