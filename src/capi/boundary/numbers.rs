//! Numbers that all calls and structs use: statuses, struct types, log levels. They are the first part of the header's
//! section `status`.

use std::ffi::{c_char, c_void};

/// Result of a call. The numbers never change and are never reused.
pub type wk_status = i32;
/// The call succeeded.
pub const WK_OK: wk_status = 0;
/// Not a failure: the call has more to do. Call it again (wk_context_update, wk_view_prepare), or skip this frame
/// (wk_surface_acquire).
pub const WK_PENDING: wk_status = 1;
/// A parameter is missing, not finite or outside its range; the message names it.
pub const WK_ERROR_INVALID_ARGUMENT: wk_status = -1;
/// A handle is NULL, destroyed, foreign or of another kind.
pub const WK_ERROR_BAD_HANDLE: wk_status = -2;
/// The object still has live children, or the program has a logger of its own (wk_set_log_callback).
pub const WK_ERROR_IN_USE: wk_status = -3;
/// This device, tier or build does not support the request; the message names the feature.
pub const WK_ERROR_UNSUPPORTED: wk_status = -4;
/// No adapter or driver serves the request.
pub const WK_ERROR_NO_ADAPTER: wk_status = -5;
/// The GPU device is lost: destroy it with its children, and create a new one.
pub const WK_ERROR_DEVICE_LOST: wk_status = -6;
/// Memory ran out, on the host or on the GPU.
pub const WK_ERROR_OUT_OF_MEMORY: wk_status = -7;
/// An earlier call on this device ended in a fault inside Welkin. Only the calls that destroy the device and its
/// children still work.
pub const WK_ERROR_POISONED: wk_status = -8;
/// The native queue or OpenGL context already belongs to another wk_device.
pub const WK_ERROR_ALREADY_WRAPPED: wk_status = -9;
/// A text (METAR report, planet file, saved state) does not parse; the message gives line and column.
pub const WK_ERROR_PARSE: wk_status = -10;
/// A file could not be read or written.
pub const WK_ERROR_IO: wk_status = -11;
/// The surface must be configured again: it was resized, minimised or lost.
pub const WK_ERROR_SURFACE_OUTDATED: wk_status = -12;
/// A call comes too early or too late: a stage out of order, a time before the last update, a query without the
/// settings that it needs, or a call inside a callback.
pub const WK_ERROR_WRONG_ORDER: wk_status = -13;
/// The host aborted a long operation through its callback.
pub const WK_ERROR_ABORTED: wk_status = -14;
/// A fault inside Welkin; the message says where.
pub const WK_ERROR_INTERNAL: wk_status = -15;

/// Type of a struct that begins with struct_size, struct_type and next: the value of its struct_type, which WK_X_INIT
/// sets.
pub type wk_struct_type = u32;
/// wk_device_desc
pub const WK_STRUCT_TYPE_DEVICE_DESC: wk_struct_type = 1;
/// wk_caps
pub const WK_STRUCT_TYPE_CAPS: wk_struct_type = 2;
/// wk_weather
pub const WK_STRUCT_TYPE_WEATHER: wk_struct_type = 3;
/// wk_cloud_layer
pub const WK_STRUCT_TYPE_CLOUD_LAYER: wk_struct_type = 4;
/// wk_texture_desc
pub const WK_STRUCT_TYPE_TEXTURE_DESC: wk_struct_type = 5;
/// wk_context_desc
pub const WK_STRUCT_TYPE_CONTEXT_DESC: wk_struct_type = 6;
/// wk_given_direction
pub const WK_STRUCT_TYPE_GIVEN_DIRECTION: wk_struct_type = 7;
/// wk_view_desc
pub const WK_STRUCT_TYPE_VIEW_DESC: wk_struct_type = 8;
/// wk_report
pub const WK_STRUCT_TYPE_REPORT: wk_struct_type = 9;
/// wk_frame
pub const WK_STRUCT_TYPE_FRAME: wk_struct_type = 10;
/// wk_own_target
pub const WK_STRUCT_TYPE_OWN_TARGET: wk_struct_type = 11;
/// wk_window
pub const WK_STRUCT_TYPE_WINDOW: wk_struct_type = 12;
/// wk_surface_config
pub const WK_STRUCT_TYPE_SURFACE_CONFIG: wk_struct_type = 13;
/// wk_vulkan_host_desc
pub const WK_STRUCT_TYPE_VULKAN_HOST_DESC: wk_struct_type = 14;
/// wk_vulkan_image
pub const WK_STRUCT_TYPE_VULKAN_IMAGE: wk_struct_type = 15;
/// wk_vulkan_semaphore
pub const WK_STRUCT_TYPE_VULKAN_SEMAPHORE: wk_struct_type = 16;
/// wk_vulkan_target
pub const WK_STRUCT_TYPE_VULKAN_TARGET: wk_struct_type = 17;
/// wk_frame_textures
pub const WK_STRUCT_TYPE_FRAME_TEXTURES: wk_struct_type = 18;
/// wk_weather_overrides
pub const WK_STRUCT_TYPE_WEATHER_OVERRIDES: wk_struct_type = 19;
/// wk_opengl_host_desc
pub const WK_STRUCT_TYPE_OPENGL_HOST_DESC: wk_struct_type = 20;
/// wk_opengl_target
pub const WK_STRUCT_TYPE_OPENGL_TARGET: wk_struct_type = 21;
/// wk_sky_settings
pub const WK_STRUCT_TYPE_SKY_SETTINGS: wk_struct_type = 22;
/// wk_fog_law
pub const WK_STRUCT_TYPE_FOG_LAW: wk_struct_type = 23;
/// wk_conditions
pub const WK_STRUCT_TYPE_CONDITIONS: wk_struct_type = 24;
/// wk_celestial
pub const WK_STRUCT_TYPE_CELESTIAL: wk_struct_type = 25;
/// wk_ambient
pub const WK_STRUCT_TYPE_AMBIENT: wk_struct_type = 26;
/// wk_metar
pub const WK_STRUCT_TYPE_METAR: wk_struct_type = 27;
/// wk_budget
pub const WK_STRUCT_TYPE_BUDGET: wk_struct_type = 28;
/// wk_plan
pub const WK_STRUCT_TYPE_PLAN: wk_struct_type = 29;
/// wk_part_plan
pub const WK_STRUCT_TYPE_PART_PLAN: wk_struct_type = 30;
/// wk_rain
pub const WK_STRUCT_TYPE_RAIN: wk_struct_type = 31;
/// wk_shelter
pub const WK_STRUCT_TYPE_SHELTER: wk_struct_type = 32;
/// wk_windscreen
pub const WK_STRUCT_TYPE_WINDSCREEN: wk_struct_type = 33;
/// wk_wiper_arm
pub const WK_STRUCT_TYPE_WIPER_ARM: wk_struct_type = 34;
/// wk_windscreen_report
pub const WK_STRUCT_TYPE_WINDSCREEN_REPORT: wk_struct_type = 35;
/// wk_light
pub const WK_STRUCT_TYPE_LIGHT: wk_struct_type = 36;
/// wk_simulation_desc
pub const WK_STRUCT_TYPE_SIMULATION_DESC: wk_struct_type = 37;
/// wk_ground
pub const WK_STRUCT_TYPE_GROUND: wk_struct_type = 38;
/// wk_wind
pub const WK_STRUCT_TYPE_WIND: wk_struct_type = 40;
/// wk_rainfall
pub const WK_STRUCT_TYPE_RAINFALL: wk_struct_type = 41;
/// wk_rain_area
pub const WK_STRUCT_TYPE_RAIN_AREA: wk_struct_type = 42;
/// wk_wind_grid
pub const WK_STRUCT_TYPE_WIND_GRID: wk_struct_type = 43;
/// wk_occluder_map
pub const WK_STRUCT_TYPE_OCCLUDER_MAP: wk_struct_type = 44;
/// wk_shelter_shape
pub const WK_STRUCT_TYPE_SHELTER_SHAPE: wk_struct_type = 45;
/// wk_ground_grid
pub const WK_STRUCT_TYPE_GROUND_GRID: wk_struct_type = 46;
/// wk_ground_texture
pub const WK_STRUCT_TYPE_GROUND_TEXTURE: wk_struct_type = 47;
/// wk_terrain
pub const WK_STRUCT_TYPE_TERRAIN: wk_struct_type = 52;
/// wk_terrain_cells
pub const WK_STRUCT_TYPE_TERRAIN_CELLS: wk_struct_type = 53;
/// wk_terrain_drawing
pub const WK_STRUCT_TYPE_TERRAIN_DRAWING: wk_struct_type = 98;
/// wk_frame_light
pub const WK_STRUCT_TYPE_FRAME_LIGHT: wk_struct_type = 60;
/// wk_part_wish
pub const WK_STRUCT_TYPE_PART_WISH: wk_struct_type = 61;
/// wk_wind_field
pub const WK_STRUCT_TYPE_WIND_FIELD: wk_struct_type = 48;
/// wk_wind_field_report
pub const WK_STRUCT_TYPE_WIND_FIELD_REPORT: wk_struct_type = 49;
/// wk_stars
pub const WK_STRUCT_TYPE_STARS: wk_struct_type = 62;
/// wk_lightning
pub const WK_STRUCT_TYPE_LIGHTNING: wk_struct_type = 65;
/// wk_flash_trigger
pub const WK_STRUCT_TYPE_FLASH_TRIGGER: wk_struct_type = 66;
/// wk_flash_light
pub const WK_STRUCT_TYPE_FLASH_LIGHT: wk_struct_type = 67;
/// wk_snow
pub const WK_STRUCT_TYPE_SNOW: wk_struct_type = 70;
/// wk_clouds
pub const WK_STRUCT_TYPE_CLOUDS: wk_struct_type = 71;
/// wk_snow_strip
pub const WK_STRUCT_TYPE_SNOW_STRIP: wk_struct_type = 80;
/// wk_environment
pub const WK_STRUCT_TYPE_ENVIRONMENT: wk_struct_type = 64;
/// wk_cloud_shadows
pub const WK_STRUCT_TYPE_CLOUD_SHADOWS: wk_struct_type = 85;
/// wk_cloud_map
pub const WK_STRUCT_TYPE_CLOUD_MAP: wk_struct_type = 86;
/// wk_metar_options
pub const WK_STRUCT_TYPE_METAR_OPTIONS: wk_struct_type = 90;
/// wk_sea
pub const WK_STRUCT_TYPE_SEA: wk_struct_type = 110;
/// wk_sea_swell
pub const WK_STRUCT_TYPE_SEA_SWELL: wk_struct_type = 111;
/// wk_sea_wave
pub const WK_STRUCT_TYPE_SEA_WAVE: wk_struct_type = 112;
/// wk_sea_region
pub const WK_STRUCT_TYPE_SEA_REGION: wk_struct_type = 113;
/// wk_sea_state
pub const WK_STRUCT_TYPE_SEA_STATE: wk_struct_type = 114;
/// wk_sea_hull
pub const WK_STRUCT_TYPE_SEA_HULL: wk_struct_type = 115;
/// wk_weather_region
pub const WK_STRUCT_TYPE_WEATHER_REGION: wk_struct_type = 95;
/// wk_air
pub const WK_STRUCT_TYPE_AIR: wk_struct_type = 96;
/// wk_soil
pub const WK_STRUCT_TYPE_SOIL: wk_struct_type = 120;
/// wk_soil_kind
pub const WK_STRUCT_TYPE_SOIL_KIND: wk_struct_type = 121;
/// wk_soil_tool
pub const WK_STRUCT_TYPE_SOIL_TOOL: wk_struct_type = 122;
/// wk_soil_pose
pub const WK_STRUCT_TYPE_SOIL_POSE: wk_struct_type = 123;
/// wk_soil_tool_report
pub const WK_STRUCT_TYPE_SOIL_TOOL_REPORT: wk_struct_type = 124;
/// wk_soil_blade
pub const WK_STRUCT_TYPE_SOIL_BLADE: wk_struct_type = 125;
/// wk_cutting_force
pub const WK_STRUCT_TYPE_CUTTING_FORCE: wk_struct_type = 126;
/// wk_soil_balance
pub const WK_STRUCT_TYPE_SOIL_BALANCE: wk_struct_type = 127;

/// Severity of a message.
pub type wk_log_level = u32;
/// Something failed. The call in progress, or a later call on the device, returns the failure as its status too.
pub const WK_LOG_LEVEL_ERROR: wk_log_level = 1;
/// Something works less well than it could: a fallback, a slow path.
pub const WK_LOG_LEVEL_WARNING: wk_log_level = 2;
/// Occasional information: which adapter, which plan.
pub const WK_LOG_LEVEL_INFO: wk_log_level = 3;
/// For developers of Welkin.
pub const WK_LOG_LEVEL_DEBUG: wk_log_level = 4;

/// Receives a message: NUL-terminated UTF-8, valid during the call. Welkin calls the function from any thread that is
/// in a Welkin call. The function must not call Welkin and must not unwind.
pub type wk_log_fn = Option<unsafe extern "C" fn(user: *mut c_void, level: wk_log_level, message: *const c_char)>;
