/*
 * Welkin: weather for simulators, drawn into the host's own picture.
 *
 * This header is the whole C API, in reading order; CONTENTS below names its sections. It compiles as C99 or C++11,
 * and as later versions of both. welkin.hpp wraps it for C++.
 *
 * IN SHORT
 *
 *     wk_device *device = NULL; wk_context *context = NULL; wk_view *view = NULL;
 *     wk_device_create(NULL, &device);                       or ..._create_opengl, ..._create_vulkan
 *     wk_context_create(device, NULL, &context);             weather, time and place
 *     wk_view_create(context, NULL, &view);                  one camera
 *     wk_context_set_weather(context, &weather, 0.0, 0.0);   from a METAR report, a preset or your own figures
 *     each frame:
 *         wk_context_update(context, time_s);
 *         ... the host draws its world ...
 *         wk_view_record(view, &frame, WK_STAGE_ALL);        sky behind it, fog and air in front of it
 *
 * OWNERSHIP
 *
 * wk_x_create writes a new handle to its out-parameter, on success only. wk_x_destroy(handle) destroys the object;
 * NULL does nothing. Destroy children before parents: a device has contexts, surfaces and textures, a context has
 * views. Destroying a parent with live children gives WK_ERROR_IN_USE. A handle looks like a pointer but is a number,
 * and Welkin never dereferences it: a handle that is dead, foreign or of another kind gives WK_ERROR_BAD_HANDLE.
 * Structs, texts and lists that you pass in stay yours; Welkin reads them during the call only. How long a returned
 * text stays valid is stated at its function. Native objects (windows, OpenGL names, Vulkan handles) stay the host's.
 *
 * ERRORS
 *
 * Every call that can fail returns a wk_status: 0 and positive values mean success, negative ones failure. A failed
 * call writes no output, changes nothing and draws nothing. Only a list that does not fit into its buffer is an
 * exception: the call fails, but still writes the number of elements or bytes needed. wk_last_error_message() has the
 * calling thread's message, which names the parameter and what is accepted, as in `wk_view_record: frame.projection[5]
 * must be finite, got NaN`; wk_last_error_field() has `frame.projection[5]` alone. Welkin never aborts, prints or
 * throws. If a fault in Welkin itself is caught, the call returns WK_ERROR_INTERNAL. After that, every call on the
 * device returns WK_ERROR_POISONED, except those that destroy.
 *
 * STRUCTS
 *
 * Structs begin with struct_size, struct_type and next. Some structs are elements of arrays that calls read or fill in
 * bulk, such as wk_flash. They have no such head: the call takes their sizeof. Start from WK_X_INIT (or wk_x_init,
 * which writes the same bytes) and change fields. Later versions append fields for which zero means "as before". A
 * library therefore accepts structs of older headers, whose missing fields get their defaults, and structs of newer
 * headers if the fields that it does not know are zero. `next` points to extension structs, of the types that a call
 * names; an extension of another type is refused. Reserved fields must be 0. Zero is a value (0 degrees, north, calm),
 * never "default". An optional field has a bit in `has`, which you set together with the field. Lists are (pointer,
 * count, stride): stride is the size of an element in your header. Reals are doubles, or floats in some fields and
 * lists, and must be finite. Texts are NUL-terminated UTF-8. Sizes are in bytes.
 *
 * THREADS
 *
 * You may call functions from any thread. The line "Thread:" of a function says which calls may run at the same time.
 * "any": no rule. "concurrent": the handle is a `const T *`, and any number of such calls may use it at the same time.
 * "exclusive": the handle is a `T *`; make one call at a time with it, and no concurrent call with it at the same
 * time. "exclusive on the view" names the handle. Calls that break this rule wait for each other. Welkin starts no
 * threads. With an OpenGL host, make all calls that draw, create or destroy on the thread where its context is (or can
 * be made) current; what you destroy on another thread is released at the device's next call. Call no Welkin function
 * inside a callback: it would return WK_ERROR_WRONG_ORDER.
 *
 * UNITS AND COORDINATES
 *
 * Units are SI. A field's name ends in its unit (_m, _s, _mm_h). Angles that people usually state in degrees are in
 * degrees (_deg); angles without a unit in their names are in radians. Azimuths are clockwise from true north; wind
 * direction is where the wind comes from. Positions are in the host's world, in double precision, however far from its
 * origin. See Contexts for world frames and Frames for matrices, depth and clip space. Colours are linear Rec. 709
 * unless they say otherwise.
 *
 * DETERMINISM
 *
 * On every machine, the same description, timeline, seed and time give the same world. Channels of one simulator with
 * the same input agree; wk_context_state_hash lets them check that. Changes of weather have absolute times. Pictures
 * are bit-identical from run to run on one driver; between drivers the last bits differ.
 *
 * WHAT COMES LATER, AND HOW
 *
 * Before 1.0 a minor version may change this header; from 1.0 on, numbers, names and layouts never change within a
 * major version, and later versions add new ones. These points are settled for planned features, so that a host can
 * prepare:
 * - Snow in rain areas will be wk_rain_area.snow.
 * - Images of base colour and motion will be appended to the target structs.
 * - Callbacks for memory and files will be extensions of wk_device_desc through `next`.
 *
 * A field, a bit or a value that this version does not draw yet is refused by name where it is set.
 *
 * CONTENTS
 *
 * Each section begins with its name in brackets. The name stays the same from version to version: search for it.
 *
 * What every call answers
 *   [status]          Status, versions, messages
 *
 * Devices and hosts
 *   [device]          Devices
 *   [texture]         Textures of an own device
 *   [surface]         Windows
 *   [opengl]          OpenGL hosts
 *   [vulkan]          Vulkan hosts
 *
 * Weather, place and time
 *   [weather_kinds]   Kinds of weather
 *   [weather]         Weather
 *   [report]          Weather reports and presets
 *   [context]         Contexts
 *   [sky]             How the sky is drawn
 *   [timeline]        Weather over time
 *   [fog_law]         Fog laws of older simulators
 *
 * Questions
 *   [conditions]      Queries: conditions
 *   [query]           Queries: light and visibility
 *   [radiance]        Queries: the sky's light by direction
 *   [wind]            Queries: wind and rain
 *
 * Pictures
 *   [frame]           Frames and targets
 *   [view]            Views
 *   [veil]            Textures for the host's transparent things
 *   [environment]     A cube map of what stands around the camera
 *   [plan]            Plan and budget of a view
 *
 * What falls
 *   [rain]            Rain
 *   [snow]            Snow
 *   [area]            Rain areas
 *   [region]          Weather regions
 *   [air]             Air at a height
 *
 * Wind, shelter and lamps
 *   [wind_grid]       Wind that varies in space
 *   [wind_field]      Wind round terrain and buildings
 *   [occluder]        Maps of objects that keep rain off
 *   [light]           Lamps
 *
 * Stars, clouds and lightning
 *   [stars]           Stars
 *   [cloud_map]       Cloud map
 *   [clouds]          Clouds
 *   [cloud_shadow]    Shadows of clouds as a texture
 *   [lightning]       Lightning
 *
 * Glass and ground
 *   [windscreen]      Water on the windscreen
 *   [ground]          Wet ground
 *   [ground_grid]     Water on the host's terrain
 *   [ground_texture]  Water on the host's terrain as a texture
 *   [snowpack]        Lying snow
 *   [terrain]         Terrain in tiles
 *
 * The sea
 *   [sea]             The sea: settings and queries
 *   [soil]            Soil
 */
#ifndef WELKIN_H
#define WELKIN_H

#include <stddef.h>
#include <stdint.h>

/** Version of this header; `wk_version` gives the library's. */
#define WK_VERSION_MAJOR 0
#define WK_VERSION_MINOR 2
#define WK_VERSION_PATCH 0

/** Define WK_SHARED when linking the shared library on Windows. Elsewhere it is not needed. */
#ifndef WK_API
#if defined(_WIN32) && defined(WK_SHARED)
#define WK_API __declspec(dllimport)
#else
#define WK_API
#endif
#endif

#ifdef __cplusplus
extern "C" {
#endif

/*
 * ====================================================================================================
 * [status] Status, versions, messages
 *
 * Every call that can fail returns a wk_status: 0 and positive values mean success, negative ones failure.
 * wk_last_error_message() then says which parameter was wrong and what is accepted, and wk_last_error_field() gives
 * that parameter or field alone.
 * ====================================================================================================
 */

/** Result of a call. The numbers never change and are never reused. */
typedef int32_t wk_status;

/** The call succeeded. */
#define WK_OK 0
/**
 * Not a failure: the call has more to do. Call it again (wk_context_update, wk_view_prepare), or skip this frame
 * (wk_surface_acquire).
 */
#define WK_PENDING 1
/** A parameter is missing, not finite or outside its range; the message names it. */
#define WK_ERROR_INVALID_ARGUMENT (-1)
/** A handle is NULL, destroyed, foreign or of another kind. */
#define WK_ERROR_BAD_HANDLE (-2)
/** The object still has live children, or the program has a logger of its own (wk_set_log_callback). */
#define WK_ERROR_IN_USE (-3)
/** This device, tier or build does not support the request; the message names the feature. */
#define WK_ERROR_UNSUPPORTED (-4)
/** No adapter or driver serves the request. */
#define WK_ERROR_NO_ADAPTER (-5)
/** The GPU device is lost: destroy it with its children, and create a new one. */
#define WK_ERROR_DEVICE_LOST (-6)
/** Memory ran out, on the host or on the GPU. */
#define WK_ERROR_OUT_OF_MEMORY (-7)
/**
 * An earlier call on this device ended in a fault inside Welkin. Only the calls that destroy the device and its
 * children still work.
 */
#define WK_ERROR_POISONED (-8)
/** The native queue or OpenGL context already belongs to another wk_device. */
#define WK_ERROR_ALREADY_WRAPPED (-9)
/** A text (METAR report, planet file, saved state) does not parse; the message gives line and column. */
#define WK_ERROR_PARSE (-10)
/** A file could not be read or written. */
#define WK_ERROR_IO (-11)
/** The surface must be configured again: it was resized, minimised or lost. */
#define WK_ERROR_SURFACE_OUTDATED (-12)
/**
 * A call comes too early or too late: a stage out of order, a time before the last update, a query without the
 * settings that it needs, or a call inside a callback.
 */
#define WK_ERROR_WRONG_ORDER (-13)
/** The host aborted a long operation through its callback. */
#define WK_ERROR_ABORTED (-14)
/** A fault inside Welkin; the message says where. */
#define WK_ERROR_INTERNAL (-15)

/** Severity of a message. */
typedef uint32_t wk_log_level;

/** Something failed. The call in progress, or a later call on the device, returns the failure as its status too. */
#define WK_LOG_LEVEL_ERROR 1
/** Something works less well than it could: a fallback, a slow path. */
#define WK_LOG_LEVEL_WARNING 2
/** Occasional information: which adapter, which plan. */
#define WK_LOG_LEVEL_INFO 3
/** For developers of Welkin. */
#define WK_LOG_LEVEL_DEBUG 4

/**
 * Receives a message: NUL-terminated UTF-8, valid during the call. Welkin calls the function from any thread that is
 * in a Welkin call. The function must not call Welkin and must not unwind.
 */
typedef void (*wk_log_fn)(void *user, wk_log_level level, const char *message);

/**
 * Type of a struct that begins with struct_size, struct_type and next: the value of its struct_type, which WK_X_INIT
 * sets.
 */
typedef uint32_t wk_struct_type;

/** wk_device_desc */
#define WK_STRUCT_TYPE_DEVICE_DESC 1
/** wk_caps */
#define WK_STRUCT_TYPE_CAPS 2
/** wk_weather */
#define WK_STRUCT_TYPE_WEATHER 3
/** wk_cloud_layer */
#define WK_STRUCT_TYPE_CLOUD_LAYER 4
/** wk_texture_desc */
#define WK_STRUCT_TYPE_TEXTURE_DESC 5
/** wk_context_desc */
#define WK_STRUCT_TYPE_CONTEXT_DESC 6
/** wk_given_direction */
#define WK_STRUCT_TYPE_GIVEN_DIRECTION 7
/** wk_view_desc */
#define WK_STRUCT_TYPE_VIEW_DESC 8
/** wk_report */
#define WK_STRUCT_TYPE_REPORT 9
/** wk_frame */
#define WK_STRUCT_TYPE_FRAME 10
/** wk_own_target */
#define WK_STRUCT_TYPE_OWN_TARGET 11
/** wk_window */
#define WK_STRUCT_TYPE_WINDOW 12
/** wk_surface_config */
#define WK_STRUCT_TYPE_SURFACE_CONFIG 13
/** wk_vulkan_host_desc */
#define WK_STRUCT_TYPE_VULKAN_HOST_DESC 14
/** wk_vulkan_image */
#define WK_STRUCT_TYPE_VULKAN_IMAGE 15
/** wk_vulkan_semaphore */
#define WK_STRUCT_TYPE_VULKAN_SEMAPHORE 16
/** wk_vulkan_target */
#define WK_STRUCT_TYPE_VULKAN_TARGET 17
/** wk_frame_textures */
#define WK_STRUCT_TYPE_FRAME_TEXTURES 18
/** wk_weather_overrides */
#define WK_STRUCT_TYPE_WEATHER_OVERRIDES 19
/** wk_opengl_host_desc */
#define WK_STRUCT_TYPE_OPENGL_HOST_DESC 20
/** wk_opengl_target */
#define WK_STRUCT_TYPE_OPENGL_TARGET 21
/** wk_sky_settings */
#define WK_STRUCT_TYPE_SKY_SETTINGS 22
/** wk_fog_law */
#define WK_STRUCT_TYPE_FOG_LAW 23
/** wk_conditions */
#define WK_STRUCT_TYPE_CONDITIONS 24
/** wk_celestial */
#define WK_STRUCT_TYPE_CELESTIAL 25
/** wk_ambient */
#define WK_STRUCT_TYPE_AMBIENT 26
/** wk_metar */
#define WK_STRUCT_TYPE_METAR 27
/** wk_budget */
#define WK_STRUCT_TYPE_BUDGET 28
/** wk_plan */
#define WK_STRUCT_TYPE_PLAN 29
/** wk_part_plan */
#define WK_STRUCT_TYPE_PART_PLAN 30
/** wk_rain */
#define WK_STRUCT_TYPE_RAIN 31
/** wk_shelter */
#define WK_STRUCT_TYPE_SHELTER 32
/** wk_windscreen */
#define WK_STRUCT_TYPE_WINDSCREEN 33
/** wk_wiper_arm */
#define WK_STRUCT_TYPE_WIPER_ARM 34
/** wk_windscreen_report */
#define WK_STRUCT_TYPE_WINDSCREEN_REPORT 35
/** wk_light */
#define WK_STRUCT_TYPE_LIGHT 36
/** wk_simulation_desc */
#define WK_STRUCT_TYPE_SIMULATION_DESC 37
/** wk_ground */
#define WK_STRUCT_TYPE_GROUND 38
/** wk_wind */
#define WK_STRUCT_TYPE_WIND 40
/** wk_rainfall */
#define WK_STRUCT_TYPE_RAINFALL 41
/** wk_rain_area */
#define WK_STRUCT_TYPE_RAIN_AREA 42
/** wk_wind_grid */
#define WK_STRUCT_TYPE_WIND_GRID 43
/** wk_occluder_map */
#define WK_STRUCT_TYPE_OCCLUDER_MAP 44
/** wk_shelter_shape */
#define WK_STRUCT_TYPE_SHELTER_SHAPE 45
/** wk_ground_grid */
#define WK_STRUCT_TYPE_GROUND_GRID 46
/** wk_ground_texture */
#define WK_STRUCT_TYPE_GROUND_TEXTURE 47
/** wk_terrain */
#define WK_STRUCT_TYPE_TERRAIN 52
/** wk_terrain_cells */
#define WK_STRUCT_TYPE_TERRAIN_CELLS 53
/** wk_terrain_drawing */
#define WK_STRUCT_TYPE_TERRAIN_DRAWING 98
/** wk_frame_light */
#define WK_STRUCT_TYPE_FRAME_LIGHT 60
/** wk_part_wish */
#define WK_STRUCT_TYPE_PART_WISH 61
/** wk_wind_field */
#define WK_STRUCT_TYPE_WIND_FIELD 48
/** wk_wind_field_report */
#define WK_STRUCT_TYPE_WIND_FIELD_REPORT 49
/** wk_stars */
#define WK_STRUCT_TYPE_STARS 62
/** wk_lightning */
#define WK_STRUCT_TYPE_LIGHTNING 65
/** wk_flash_trigger */
#define WK_STRUCT_TYPE_FLASH_TRIGGER 66
/** wk_flash_light */
#define WK_STRUCT_TYPE_FLASH_LIGHT 67
/** wk_snow */
#define WK_STRUCT_TYPE_SNOW 70
/** wk_clouds */
#define WK_STRUCT_TYPE_CLOUDS 71
/** wk_snow_strip */
#define WK_STRUCT_TYPE_SNOW_STRIP 80
/** wk_environment */
#define WK_STRUCT_TYPE_ENVIRONMENT 64
/** wk_cloud_shadows */
#define WK_STRUCT_TYPE_CLOUD_SHADOWS 85
/** wk_cloud_map */
#define WK_STRUCT_TYPE_CLOUD_MAP 86
/** wk_metar_options */
#define WK_STRUCT_TYPE_METAR_OPTIONS 90
/** wk_sea */
#define WK_STRUCT_TYPE_SEA 110
/** wk_sea_swell */
#define WK_STRUCT_TYPE_SEA_SWELL 111
/** wk_sea_wave */
#define WK_STRUCT_TYPE_SEA_WAVE 112
/** wk_sea_region */
#define WK_STRUCT_TYPE_SEA_REGION 113
/** wk_sea_state */
#define WK_STRUCT_TYPE_SEA_STATE 114
/** wk_sea_hull */
#define WK_STRUCT_TYPE_SEA_HULL 115
/** wk_weather_region */
#define WK_STRUCT_TYPE_WEATHER_REGION 95
/** wk_air */
#define WK_STRUCT_TYPE_AIR 96
/** wk_soil */
#define WK_STRUCT_TYPE_SOIL 120
/** wk_soil_kind */
#define WK_STRUCT_TYPE_SOIL_KIND 121
/** wk_soil_tool */
#define WK_STRUCT_TYPE_SOIL_TOOL 122
/** wk_soil_pose */
#define WK_STRUCT_TYPE_SOIL_POSE 123
/** wk_soil_tool_report */
#define WK_STRUCT_TYPE_SOIL_TOOL_REPORT 124
/** wk_soil_blade */
#define WK_STRUCT_TYPE_SOIL_BLADE 125
/** wk_cutting_force */
#define WK_STRUCT_TYPE_CUTTING_FORCE 126
/** wk_soil_balance */
#define WK_STRUCT_TYPE_SOIL_BALANCE 127

/**
 * Returns the name of a status, such as "WK_ERROR_BAD_HANDLE"; "unknown status" for other numbers. Never NULL; lives
 * as long as the library, and you must not free it.
 * Thread: any.
 */
WK_API const char *wk_status_name(wk_status status);

/**
 * Returns the message of the calling thread's last failed call: one sentence that begins with the function's name and
 * names the parameter and the accepted range. Empty before the first failure; successful calls do not change it. Never
 * NULL; valid until the next failing call of this thread.
 * Thread: any; each thread has its own message.
 */
WK_API
const char *wk_last_error_message(void);

/**
 * Returns the parameter or field that the calling thread's last failed call was about, as a path of names in this
 * header that begins at the function's parameter or at a struct's name: `frame.projection`, `shelters[2].half_size_m`,
 * `wk_sky_settings.suns`, `time_s`. A host's editor can use it to mark a control. A failure with
 * WK_ERROR_INVALID_ARGUMENT always has a field. Empty where a failure is about no field, and before the first failure.
 * Never NULL; valid until the next failing call of this thread.
 * Thread: any; each thread has its own field.
 */
WK_API
const char *wk_last_error_field(void);

/**
 * Gets the library's version. WK_VERSION_MAJOR, _MINOR and _PATCH are the header's. A library fits a header if the
 * major versions are equal and the library's minor version is at least the header's. Each of the three pointers may be
 * NULL.
 * Thread: any.
 */
WK_API
wk_status wk_version(uint32_t *major,
                     uint32_t *minor,
                     uint32_t *patch);

/**
 * Sends Welkin's messages, and its graphics layer's warnings and errors, to `callback` from now on; NULL stops them.
 * They are off by default, and Welkin never prints. There is one callback in a process. `max_level` is the least
 * severe level that is sent. `callback` must return normally and must not unwind, even if it could not handle the
 * message.
 * Thread: any. When the call returns, the previous callback is no longer called.
 * Errors: WK_ERROR_INVALID_ARGUMENT for an unknown level; WK_ERROR_IN_USE in a Rust program that has its own logger.
 */
WK_API wk_status wk_set_log_callback(wk_log_fn callback, void *user, wk_log_level max_level);

/*
 * ====================================================================================================
 * [device] Devices
 *
 * A wk_device is one native queue or OpenGL context, with everything that the wk_contexts on it share: pipelines,
 * tables, caches. Create one here (an own device, which Welkin makes itself), from the host's OpenGL context, from the
 * host's Vulkan device, or, in Rust, from the host's wgpu device. All later calls are the same for these four kinds of
 * device.
 *
 * Create one device per native queue or OpenGL context: a call that would create a second one returns
 * WK_ERROR_ALREADY_WRAPPED. When the GPU is lost (driver reset, unplugged), every call that needs the GPU returns
 * WK_ERROR_DEVICE_LOST: calls that create, build or draw, calls that read or write GPU resources, and
 * wk_context_get_ambient. A wk_context's weather, time, settings, state and other queries need no GPU and go on
 * working. To recover, save the state with wk_context_save, destroy the views, the contexts and the device, create
 * them again, and load the state.
 * ====================================================================================================
 */

/** A native queue or OpenGL context. Parent of wk_contexts, surfaces and textures. */
typedef struct wk_device wk_device;

/** Native graphics interfaces, as flags. */
typedef uint32_t wk_backend_flags;

/** No graphics: draws nothing and needs no GPU, for tests of your own code. */
#define WK_BACKEND_NOOP 1
/** Vulkan. */
#define WK_BACKEND_VULKAN 2
/** Metal. */
#define WK_BACKEND_METAL 4
/** Direct3D 12. */
#define WK_BACKEND_DX12 8
/** OpenGL or OpenGL ES. */
#define WK_BACKEND_GL 16
/** Any of Vulkan, Metal, Direct3D 12 and OpenGL; Welkin takes the best one that works. */
#define WK_BACKEND_ANY 30

/** Flags of an own device. */
typedef uint32_t wk_device_flags;

/** Use no compute shaders, even where the device has them. Welkin then draws as on a device with OpenGL 3.3. */
#define WK_DEVICE_FORCE_TIER0 1
/** Use a software driver, which draws on the CPU. */
#define WK_DEVICE_FORCE_SOFTWARE 2

/** Settings for an own device. */
typedef struct wk_device_desc {
    /** sizeof(wk_device_desc) of your header. */
    uint32_t struct_size;
    /** WK_STRUCT_TYPE_DEVICE_DESC. */
    wk_struct_type struct_type;
    /** No extensions in this version: NULL. */
    const void *next;
    /** Native interfaces that may be used. Default WK_BACKEND_ANY. */
    wk_backend_flags backends;
    /** Flags of the device. Default 0. */
    wk_device_flags flags;
} wk_device_desc;

/** Every field of `wk_device_desc` at its default. */
#define WK_DEVICE_DESC_INIT { \
    /* struct_size */ (uint32_t)sizeof(wk_device_desc), \
    /* struct_type */ WK_STRUCT_TYPE_DEVICE_DESC, \
    /* next */ NULL, \
    /* backends */ WK_BACKEND_ANY, \
    /* flags */ 0 \
}

/** Capabilities of a device. */
typedef struct wk_caps {
    /** sizeof(wk_caps) of your header. */
    uint32_t struct_size;
    /** WK_STRUCT_TYPE_CAPS. */
    wk_struct_type struct_type;
    /** No extensions in this version: NULL. */
    const void *next;
    /** Native interface that the device uses. */
    wk_backend_flags backend;
    /**
     * Tier of features: 0 without compute shaders (OpenGL 3.3 to 4.2, OpenGL on macOS), 1 with them. On tier 0 a call
     * for a feature that needs tier 1 returns WK_ERROR_UNSUPPORTED, with a message that names the feature.
     */
    uint32_t tier;
    /** 1 for a software driver, which draws on the CPU, else 0. */
    uint32_t software;
    /** Largest edge of a 2-D texture, pixels. */
    uint32_t max_texture_size;
    /** Most cloud layers in a wk_weather. */
    uint32_t max_cloud_layers;
    /** Most positions or rays in one batch query. */
    uint32_t max_batch;
    /** Name that the adapter reports, UTF-8; lives as long as the device. */
    const char *adapter_name;
    /** Name and version that the driver reports, UTF-8; lives as long as the device. */
    const char *driver;
} wk_caps;

/** Every field of `wk_caps` at its default. */
#define WK_CAPS_INIT { \
    /* struct_size */ (uint32_t)sizeof(wk_caps), \
    /* struct_type */ WK_STRUCT_TYPE_CAPS, \
    /* next */ NULL, \
    /* backend */ 0, \
    /* tier */ 0, \
    /* software */ 0, \
    /* max_texture_size */ 0, \
    /* max_cloud_layers */ 0, \
    /* max_batch */ 0, \
    /* adapter_name */ NULL, \
    /* driver */ NULL \
}

/**
 * Creates an own device, without a window. `desc` NULL means WK_DEVICE_DESC_INIT. On success `*out_device` is a new
 * handle, which you destroy with `wk_device_destroy`; on failure `*out_device` stays untouched.
 * Thread: any.
 * Errors: WK_ERROR_NO_ADAPTER if no driver fits the request, or if an OpenGL driver draws a few known test texels
 * wrong or does not finish them within 6 s; WK_ERROR_INVALID_ARGUMENT naming the field.
 */
WK_API wk_status wk_device_create(const wk_device_desc *desc, wk_device **out_device);

/**
 * Destroys a device. NULL does nothing.
 * Thread: any, except for a device on an OpenGL context. Destroy such a device on a thread where the context is (or
 * can be made) current. Elsewhere, or when the OpenGL context is already gone, Welkin abandons the device's GPU
 * objects.
 * Errors: WK_ERROR_IN_USE while it has contexts, surfaces or textures; WK_ERROR_DEVICE_LOST if a host's Vulkan device
 * is lost: the wk_device is then destroyed all the same.
 */
WK_API wk_status wk_device_destroy(wk_device *device);

/**
 * Returns WK_OK while the device works, WK_ERROR_DEVICE_LOST or WK_ERROR_POISONED when it no longer does.
 * Thread: any, at any time.
 */
WK_API wk_status wk_device_get_status(const wk_device *device);

/**
 * Gets the capabilities of a device. The two texts in the answer live as long as the device.
 * Thread: any, at any time.
 */
WK_API wk_status wk_device_get_caps(const wk_device *device, wk_caps *out_caps);

/**
 * Writes the default of every field: the same bytes as `WK_DEVICE_DESC_INIT`. `struct_size` is `sizeof(wk_device_desc)`
 * as the caller was compiled, and is stored in the struct.
 */
WK_API
wk_status wk_device_desc_init(wk_device_desc *out,
                              uint32_t struct_size);

/**
 * Writes the default of every field: the same bytes as `WK_CAPS_INIT`. `struct_size` is `sizeof(wk_caps)`
 * as the caller was compiled, and is stored in the struct.
 */
WK_API wk_status wk_caps_init(wk_caps *out, uint32_t struct_size);

/*
 * ====================================================================================================
 * [texture] Textures of an own device
 *
 * These textures are for hosts without graphics of their own: programs that want pictures in memory, or that draw with
 * Welkin only. Hosts with OpenGL, Vulkan or wgpu pass their own images instead and do not need these textures.
 * ====================================================================================================
 */

/** A 2-D texture of an own device. Child of a wk_device. */
typedef struct wk_texture wk_texture;

/** Texel formats, little-endian, channels in the order of the name. */
typedef uint32_t wk_format;

/** 8-bit normalised, 4 bytes: colour that is display-encoded or display-linear. */
#define WK_FORMAT_RGBA8_UNORM 1
/** 8-bit normalised with the sRGB curve, 4 bytes. */
#define WK_FORMAT_RGBA8_SRGB 2
/** 8-bit normalised, 4 bytes. */
#define WK_FORMAT_BGRA8_UNORM 3
/** 8-bit normalised with the sRGB curve, 4 bytes. */
#define WK_FORMAT_BGRA8_SRGB 4
/** Half floats, 8 bytes: scene-linear colour. */
#define WK_FORMAT_RGBA16_FLOAT 5
/** Floats, 16 bytes: scene-linear colour. Some drivers do not support it as a target. */
#define WK_FORMAT_RGBA32_FLOAT 6
/** One float, 4 bytes: depth as the host's projection gives it. */
#define WK_FORMAT_R32_FLOAT 7
/** 8-bit normalised, 1 byte: a mask. */
#define WK_FORMAT_R8_UNORM 8

/** Settings for a new texture. */
typedef struct wk_texture_desc {
    /** sizeof(wk_texture_desc) of your header. */
    uint32_t struct_size;
    /** WK_STRUCT_TYPE_TEXTURE_DESC. */
    wk_struct_type struct_type;
    /** No extensions in this version: NULL. */
    const void *next;
    /** Width, pixels. Range [1, wk_caps.max_texture_size], default 1. */
    uint32_t width;
    /** Height, pixels. Range [1, wk_caps.max_texture_size], default 1. */
    uint32_t height;
    /** Texel format. Default WK_FORMAT_RGBA8_UNORM. */
    wk_format format;
    /** Must be 0. */
    uint32_t reserved0;
} wk_texture_desc;

/** Every field of `wk_texture_desc` at its default. */
#define WK_TEXTURE_DESC_INIT { \
    /* struct_size */ (uint32_t)sizeof(wk_texture_desc), \
    /* struct_type */ WK_STRUCT_TYPE_TEXTURE_DESC, \
    /* next */ NULL, \
    /* width */ 1, \
    /* height */ 1, \
    /* format */ WK_FORMAT_RGBA8_UNORM, \
    /* reserved0 */ 0 \
}

/**
 * Creates a texture, filled with zeros. On success `*out_texture` is a new handle for `wk_texture_destroy`.
 * Thread: any.
 * Errors: WK_ERROR_INVALID_ARGUMENT naming the field and its range; WK_ERROR_UNSUPPORTED if the device cannot make the
 * format, or cannot draw into a format of colour; WK_ERROR_OUT_OF_MEMORY.
 */
WK_API
wk_status wk_texture_create(wk_device *device,
                            const wk_texture_desc *desc,
                            wk_texture **out_texture);

/**
 * Destroys a texture. NULL does nothing. Views that use the texture keep it alive for as long as they need it.
 * Thread: any.
 */
WK_API wk_status wk_texture_destroy(wk_texture *texture);

/**
 * Fills a texture from memory: all rows of the texture, `bytes_per_row` bytes each, from the top of the picture down.
 * `data_size` is the number of bytes at `data`: at least `bytes_per_row` times the texture's height. Copied during the
 * call.
 * Thread: exclusive.
 * Errors: WK_ERROR_INVALID_ARGUMENT for a `bytes_per_row` or a `data_size` that is too small; WK_ERROR_DEVICE_LOST.
 */
WK_API
wk_status wk_texture_write(wk_texture *texture,
                           const void *data,
                           size_t data_size,
                           uint32_t bytes_per_row);

/**
 * Waits for the GPU and copies a texture to memory: all rows of the texture, `bytes_per_row` bytes each, from the top
 * of the picture down. `data_size` is the number of bytes available at `data`: at least `bytes_per_row` times the
 * texture's height. Slow: do not call it in every frame.
 * Thread: exclusive.
 * Errors: WK_ERROR_INVALID_ARGUMENT for a `bytes_per_row` or a `data_size` that is too small; WK_ERROR_DEVICE_LOST.
 */
WK_API wk_status wk_texture_read(wk_texture *texture, void *data, size_t data_size, uint32_t bytes_per_row);

/**
 * Writes the default of every field: the same bytes as `WK_TEXTURE_DESC_INIT`. `struct_size` is `sizeof(wk_texture_desc)`
 * as the caller was compiled, and is stored in the struct.
 */
WK_API
wk_status wk_texture_desc_init(wk_texture_desc *out,
                               uint32_t struct_size);

/*
 * ====================================================================================================
 * [surface] Windows
 *
 * For hosts without graphics of their own: Welkin presents to a window that the host identifies by its native handle.
 * The host makes the window, runs its event loop, and tells Welkin when its size changes. Resized, hidden, minimised
 * and lost windows give a status and never a fault.
 *
 *   wk_device_create_for_window, wk_surface_create, wk_surface_configure
 *   each frame: wk_surface_acquire, wk_view_record (wk_own_target.surface), wk_surface_present
 *   on WK_ERROR_SURFACE_OUTDATED: wk_surface_configure with the window's current size, then the next frame
 *   on WK_PENDING: the window shows nothing now; skip the frame
 * ====================================================================================================
 */

/** A window to present to. Child of a wk_device. */
typedef struct wk_surface wk_surface;

/** Window systems. */
typedef uint32_t wk_window_kind;

/** X11 by Xlib: `display` is the Display*, `id` the Window, `screen` the screen's number. */
#define WK_WINDOW_XLIB 1
/** X11 by XCB: `display` is the xcb_connection_t*, `id` the xcb_window_t, `screen` the screen's number. */
#define WK_WINDOW_XCB 2
/** Wayland: `display` is the wl_display*, `handle` the wl_surface*. */
#define WK_WINDOW_WAYLAND 3
/** Windows: `handle` is the HWND, `display` the HINSTANCE of the module that made the window. */
#define WK_WINDOW_WIN32 4
/** macOS: `handle` is the NSView*. Make all calls on the main thread. */
#define WK_WINDOW_APPKIT 5

/**
 * A native window. Welkin ignores fields that its kind does not use. The window must outlive the surface, and its
 * display connection must outlive the device.
 */
typedef struct wk_window {
    /** sizeof(wk_window) of your header. */
    uint32_t struct_size;
    /** WK_STRUCT_TYPE_WINDOW. */
    wk_struct_type struct_type;
    /** No extensions in this version: NULL. */
    const void *next;
    /** Window system. Default WK_WINDOW_XLIB. */
    wk_window_kind kind;
    /** Number of the screen, for X11. Default 0. */
    int32_t screen;
    /** Display, connection or module; see wk_window_kind. Default NULL. */
    void *display;
    /** Handle of the window; see wk_window_kind. Default NULL. */
    void *handle;
    /** Number of the window, for X11; see wk_window_kind. Default 0. */
    uint64_t id;
} wk_window;

/** Every field of `wk_window` at its default. */
#define WK_WINDOW_INIT { \
    /* struct_size */ (uint32_t)sizeof(wk_window), \
    /* struct_type */ WK_STRUCT_TYPE_WINDOW, \
    /* next */ NULL, \
    /* kind */ WK_WINDOW_XLIB, \
    /* screen */ 0, \
    /* display */ NULL, \
    /* handle */ NULL, \
    /* id */ UINT64_C(0) \
}

/** Encoding of the values drawn to a surface; give the frame a color_space that fits it. */
typedef uint32_t wk_surface_encoding;

/**
 * Display-linear values, which the hardware encodes to sRGB. WK_COLOR_DISPLAY_LINEAR fits, and WK_COLOR_SCENE_LINEAR
 * with WK_STAGE_TONE.
 */
#define WK_SURFACE_DISPLAY_LINEAR 0
/** Values encoded to sRGB already. WK_COLOR_DISPLAY_SRGB fits, and WK_COLOR_SCENE_LINEAR with WK_STAGE_TONE. */
#define WK_SURFACE_DISPLAY_SRGB 1

/** Time at which images reach the screen. */
typedef uint32_t wk_pacing;

/** With the screen's refresh; wk_surface_acquire waits for the refresh. */
#define WK_PACING_REFRESH 0
/** As soon as possible; may tear. */
#define WK_PACING_IMMEDIATE 1

/** Settings of a surface. */
typedef struct wk_surface_config {
    /** sizeof(wk_surface_config) of your header. */
    uint32_t struct_size;
    /** WK_STRUCT_TYPE_SURFACE_CONFIG. */
    wk_struct_type struct_type;
    /** No extensions in this version: NULL. */
    const void *next;
    /**
     * Width of the window's drawable area, pixels, at most wk_caps.max_texture_size; 0 (the default) while the window
     * is minimised.
     */
    uint32_t width;
    /**
     * Height of the window's drawable area, pixels, at most wk_caps.max_texture_size; 0 (the default) while the window
     * is minimised.
     */
    uint32_t height;
    /** Encoding of the values drawn. Default WK_SURFACE_DISPLAY_LINEAR. */
    wk_surface_encoding encoding;
    /** Time at which images reach the screen. Default WK_PACING_REFRESH. */
    wk_pacing pacing;
} wk_surface_config;

/** Every field of `wk_surface_config` at its default. */
#define WK_SURFACE_CONFIG_INIT { \
    /* struct_size */ (uint32_t)sizeof(wk_surface_config), \
    /* struct_type */ WK_STRUCT_TYPE_SURFACE_CONFIG, \
    /* next */ NULL, \
    /* width */ 0, \
    /* height */ 0, \
    /* encoding */ WK_SURFACE_DISPLAY_LINEAR, \
    /* pacing */ WK_PACING_REFRESH \
}

/**
 * Creates an own device that can present to `window` and to other windows of the same connection. `desc` NULL means
 * WK_DEVICE_DESC_INIT. On success `*out_device` is a new handle for `wk_device_destroy`.
 * Thread: any; on macOS the main one. With X11, call XInitThreads first if you use Xlib from several threads.
 * Errors: WK_ERROR_INVALID_ARGUMENT naming a missing handle; WK_ERROR_SURFACE_OUTDATED if the window does not exist;
 * WK_ERROR_NO_ADAPTER or WK_ERROR_UNSUPPORTED if no driver can present to the window; else as wk_device_create.
 */
WK_API
wk_status wk_device_create_for_window(const wk_device_desc *desc,
                                      const wk_window *window,
                                      wk_device **out_device);

/**
 * Creates a surface on a window. Configure it before use. On success `*out_surface` is a new handle for
 * `wk_surface_destroy`.
 * Thread: exclusive on the device; on macOS the main one.
 * Errors: WK_ERROR_INVALID_ARGUMENT naming a missing handle; WK_ERROR_SURFACE_OUTDATED if the window does not exist;
 * WK_ERROR_UNSUPPORTED if the device cannot present to this window.
 */
WK_API
wk_status wk_surface_create(wk_device *device,
                            const wk_window *window,
                            wk_surface **out_surface);

/**
 * Destroys a surface; the window stays the host's. NULL does nothing.
 * Thread: any; on macOS the main one.
 */
WK_API wk_status wk_surface_destroy(wk_surface *surface);

/**
 * Configures a surface, the first time or after its window changed. An image that was acquired and not yet presented
 * is discarded. With a width or height of 0 the call succeeds, and wk_surface_acquire returns
 * WK_ERROR_SURFACE_OUTDATED until the surface is configured with an area.
 * Thread: exclusive.
 * Errors: WK_ERROR_INVALID_ARGUMENT naming the field and its range; WK_ERROR_UNSUPPORTED if the window has no format
 * for the encoding; WK_ERROR_SURFACE_OUTDATED if the window is gone or refuses the configuration.
 */
WK_API wk_status wk_surface_configure(wk_surface *surface, const wk_surface_config *config);

/**
 * Acquires the next image to draw into. Called again before `wk_surface_present`, it returns the same image.
 * Thread: exclusive.
 * Returns WK_PENDING if the window shows nothing now, because it is hidden or the screen is busy: skip this frame.
 * Errors: WK_ERROR_SURFACE_OUTDATED if the surface must be configured again, and while the window is minimised;
 * WK_ERROR_WRONG_ORDER before the first wk_surface_configure.
 */
WK_API wk_status wk_surface_acquire(wk_surface *surface);

/**
 * Presents the acquired image, after the work that was recorded for it.
 * Thread: exclusive.
 * Errors: WK_ERROR_WRONG_ORDER if no image was acquired; WK_ERROR_SURFACE_OUTDATED.
 */
WK_API wk_status wk_surface_present(wk_surface *surface);

/**
 * Writes the default of every field: the same bytes as `WK_WINDOW_INIT`. `struct_size` is `sizeof(wk_window)`
 * as the caller was compiled, and is stored in the struct.
 */
WK_API wk_status wk_window_init(wk_window *out, uint32_t struct_size);

/**
 * Writes the default of every field: the same bytes as `WK_SURFACE_CONFIG_INIT`. `struct_size` is `sizeof(wk_surface_config)`
 * as the caller was compiled, and is stored in the struct.
 */
WK_API
wk_status wk_surface_config_init(wk_surface_config *out,
                                 uint32_t struct_size);

/*
 * ====================================================================================================
 * [opengl] OpenGL hosts
 *
 * Welkin draws into the host's own textures, renderbuffers or framebuffers, in one of two ways.
 *
 * SHARED (the default): the host makes a second context that shares objects with its own, and a callback that makes
 * either context current. Welkin draws in the second one, so none of the host's state can change. Fences order the
 * two. Contexts do not share framebuffers, so targets are textures and renderbuffers. Bind a texture again before you
 * sample what Welkin drew into it, as OpenGL requires between contexts.
 *
 * HOST_CONTEXT: Welkin draws in the host's own context. It saves every piece of state that it touches, sets it, and
 * restores it. Any framebuffer can be a target, even that of the window (0); Welkin copies its images in and out.
 *
 * In SHARED mode one device serves all windows whose contexts share objects, with one view for each. In HOST_CONTEXT
 * mode a device belongs to one context.
 *
 * When a call begins, the host's context must be current on the calling thread; it is current again when the call
 * returns. Needed: OpenGL 3.3 or OpenGL ES 3.0, core or compatibility. From 4.3 (ES 3.1) on Welkin uses compute
 * shaders.
 * ====================================================================================================
 */

/**
 * Returns the address of an OpenGL function, or NULL, as glfwGetProcAddress, SDL_GL_GetProcAddress, eglGetProcAddress
 * or glXGetProcAddress do. With WGL, call wglGetProcAddress, then GetProcAddress of opengl32.dll, which exports the
 * functions of OpenGL 1.1. Welkin treats 1, 2, 3 and -1 as NULL: some drivers' wglGetProcAddress returns them. Welkin
 * calls this function while the host's or its own context is current.
 */
typedef const void *(*wk_opengl_get_proc_fn)(void *user, const char *name);

/**
 * Makes a context current on the calling thread: `which` is WK_OPENGL_CONTEXT_HOST or WK_OPENGL_CONTEXT_WELKIN.
 * Returns 0 on success, anything else on failure.
 */
typedef int32_t (*wk_opengl_make_current_fn)(void *user, uint32_t which);

/** The context that Welkin draws in. */
typedef uint32_t wk_opengl_mode;

/** Welkin's own context, which shares objects with the host's. */
#define WK_OPENGL_SHARED 0
/** The host's context, whose state Welkin restores. */
#define WK_OPENGL_HOST_CONTEXT 1

/** Order of the two contexts' commands in shared mode. */
typedef uint32_t wk_opengl_handover;

/** By fences, as the standard requires. */
#define WK_OPENGL_FENCE 0
/**
 * By a flush alone: enough, and cheaper, where one queue serves both contexts. Check the pictures and the gain on your
 * driver.
 */
#define WK_OPENGL_FLUSH 1

/** Access to a host's OpenGL: its functions, contexts and options. */
typedef struct wk_opengl_host_desc {
    /** sizeof(wk_opengl_host_desc) of your header. */
    uint32_t struct_size;
    /** WK_STRUCT_TYPE_OPENGL_HOST_DESC. */
    wk_struct_type struct_type;
    /** No extensions in this version: NULL. */
    const void *next;
    /** Finds functions. Default NULL; must be given. */
    wk_opengl_get_proc_fn get_proc;
    /**
     * Makes contexts current. Required in WK_OPENGL_SHARED. In WK_OPENGL_HOST_CONTEXT it may be NULL (the default);
     * Welkin then uses the current context as it is.
     */
    wk_opengl_make_current_fn make_current;
    /**
     * Pointer that is passed to both callbacks. Welkin calls them on the thread that calls Welkin, one at a time.
     * Default NULL.
     */
    void *user;
    /** Context that Welkin draws in. Default WK_OPENGL_SHARED. */
    wk_opengl_mode mode;
    /** Order of the two contexts' commands. Default WK_OPENGL_FENCE. */
    wk_opengl_handover handover;
    /** WK_DEVICE_FORCE_TIER0 or 0, the default; WK_DEVICE_FORCE_SOFTWARE has no meaning here. */
    wk_device_flags flags;
    /** Must be 0. */
    uint32_t reserved0;
} wk_opengl_host_desc;

/** Every field of `wk_opengl_host_desc` at its default. */
#define WK_OPENGL_HOST_DESC_INIT { \
    /* struct_size */ (uint32_t)sizeof(wk_opengl_host_desc), \
    /* struct_type */ WK_STRUCT_TYPE_OPENGL_HOST_DESC, \
    /* next */ NULL, \
    /* get_proc */ NULL, \
    /* make_current */ NULL, \
    /* user */ NULL, \
    /* mode */ WK_OPENGL_SHARED, \
    /* handover */ WK_OPENGL_FENCE, \
    /* flags */ 0, \
    /* reserved0 */ 0 \
}

/** Type of the object that an OpenGL name stands for. */
typedef uint32_t wk_opengl_image_kind;

/** No image. */
#define WK_OPENGL_NONE 0
/** A texture; its level 0 is used. */
#define WK_OPENGL_TEXTURE 1
/** A renderbuffer. */
#define WK_OPENGL_RENDERBUFFER 2
/** The attachments of a framebuffer; 0 is the window's. Only in WK_OPENGL_HOST_CONTEXT. */
#define WK_OPENGL_FRAMEBUFFER 3

/** A host's image, embedded in wk_opengl_target and wk_occluder_map. */
typedef struct wk_opengl_image {
    /** Type of the object. Default WK_OPENGL_NONE. */
    wk_opengl_image_kind kind;
    /** OpenGL name of the object. Default 0. */
    uint32_t name;
    /** Target of a texture: GL_TEXTURE_2D (0x0DE1, the default) or GL_TEXTURE_2D_MULTISAMPLE (0x9100). */
    uint32_t target;
    /** Must be 0. */
    uint32_t reserved0;
} wk_opengl_image;

/** Every field of `wk_opengl_image` at its default. */
#define WK_OPENGL_IMAGE_INIT { \
    /* kind */ WK_OPENGL_NONE, \
    /* name */ 0, \
    /* target */ 3553, \
    /* reserved0 */ 0 \
}

/** Handling of multisampled images. */
typedef uint32_t wk_opengl_multisample;

/** Reads depth and draws weather for each sample. From OpenGL 4.0 on; not on OpenGL ES nor on a forced tier 0. */
#define WK_OPENGL_MULTISAMPLE_EACH 0
/**
 * Averages colour, draws, and writes the result to every sample alike; uses the depth of one sample. Not on OpenGL ES.
 */
#define WK_OPENGL_MULTISAMPLE_RESOLVE 1

/** The images of a frame of an OpenGL host. */
typedef struct wk_opengl_target {
    /** sizeof(wk_opengl_target) of your header. */
    uint32_t struct_size;
    /** WK_STRUCT_TYPE_OPENGL_TARGET. */
    wk_struct_type struct_type;
    /** No extensions in this version: NULL. */
    const void *next;
    /** The image to draw into. Default none. */
    wk_opengl_image color;
    /**
     * The host's depth; none (the default) shows the sky in every pixel. If `color` is a framebuffer, use the same
     * one, else another image. The depth has as many samples as `color`, with one exception: where `color` has one
     * sample (a resolved picture), the depth may have more, except on OpenGL ES. One sample of each pixel is then
     * used.
     */
    wk_opengl_image depth;
    /**
     * A mask of one sample: where red is 1, the host's pixel stays; where it is 0, Welkin draws weather. Default none.
     */
    wk_opengl_image mask;
    /** Width, pixels; must equal the images' width, and a window's present width. Default 0; must be given. */
    uint32_t width;
    /** Height, pixels; must equal the images' height, and a window's present height. Default 0; must be given. */
    uint32_t height;
    /** Increase this number when you create an object again under an old name. It must never fall. Default 0. */
    uint64_t generation;
    /** Handling of multisampled images. Default WK_OPENGL_MULTISAMPLE_EACH. */
    wk_opengl_multisample multisample;
    /** Must be 0. */
    uint32_t reserved0;
    /**
     * A texture of one sample with each pixel's surface class: the byte of red is a wk_surface_class, or 0 to use the
     * class of the host's terrain or the context's default. GL_R8, GL_RGB8 or GL_RGBA8. Default none.
     */
    wk_opengl_image surface_classes;
    /**
     * A texture of one sample with unit normals, in the host's world or in eye space (WK_FRAME_NORMALS_IN_EYE_SPACE):
     * (n + 1) / 2 in GL_RGB8, GL_RGBA8 and GL_RGB10_A2, n in GL_RGB16F, GL_RGBA16F and GL_RGBA32F. Where a pixel holds
     * no unit vector (a cleared pixel), Welkin uses the normal of the host's terrain or depth. Default none.
     */
    wk_opengl_image normals;
} wk_opengl_target;

/** Every field of `wk_opengl_target` at its default. */
#define WK_OPENGL_TARGET_INIT { \
    /* struct_size */ (uint32_t)sizeof(wk_opengl_target), \
    /* struct_type */ WK_STRUCT_TYPE_OPENGL_TARGET, \
    /* next */ NULL, \
    /* color */ WK_OPENGL_IMAGE_INIT, \
    /* depth */ WK_OPENGL_IMAGE_INIT, \
    /* mask */ WK_OPENGL_IMAGE_INIT, \
    /* width */ 0, \
    /* height */ 0, \
    /* generation */ UINT64_C(0), \
    /* multisample */ WK_OPENGL_MULTISAMPLE_EACH, \
    /* reserved0 */ 0, \
    /* surface_classes */ WK_OPENGL_IMAGE_INIT, \
    /* normals */ WK_OPENGL_IMAGE_INIT \
}

/** A context that Welkin asks for. */
typedef uint32_t wk_opengl_context;

/**
 * The context that the host draws in. With several windows, this is the context that was current when the host called
 * Welkin: the host must remember it for each thread.
 */
#define WK_OPENGL_CONTEXT_HOST 0
/** The context that the host made for Welkin, sharing objects with its own. */
#define WK_OPENGL_CONTEXT_WELKIN 1

/**
 * Wraps the host's OpenGL context, which must be current on this thread. On success `*out_device` is a new handle for
 * `wk_device_destroy`; call that function while the contexts live. Welkin never deletes the host's objects.
 * Thread: the one on which the host's context is current.
 * Errors: WK_ERROR_INVALID_ARGUMENT for callbacks that are missing or return NULL; WK_ERROR_WRONG_ORDER if no context
 * or the wrong one is current, if make_current fails, if the context cannot draw now (a display list is being
 * compiled, the render mode is not GL_RENDER, or the current program is marked for deletion), or, in
 * WK_OPENGL_HOST_CONTEXT, if conditional rendering or a query that counts samples or primitives is active;
 * WK_ERROR_UNSUPPORTED if the context's version is too old; WK_ERROR_ALREADY_WRAPPED if the context already has a
 * wk_device; WK_ERROR_NO_ADAPTER, with the driver's name, if the context's driver draws a few known texels wrong or
 * does not finish them within 6 s.
 */
WK_API wk_status wk_device_create_opengl(const wk_opengl_host_desc *desc, wk_device **out_device);

/**
 * Writes the default of every field: the same bytes as `WK_OPENGL_HOST_DESC_INIT`. `struct_size` is `sizeof(wk_opengl_host_desc)`
 * as the caller was compiled, and is stored in the struct.
 */
WK_API
wk_status wk_opengl_host_desc_init(wk_opengl_host_desc *out,
                                   uint32_t struct_size);

/**
 * Writes the default of every field: the same bytes as `WK_OPENGL_TARGET_INIT`. `struct_size` is `sizeof(wk_opengl_target)`
 * as the caller was compiled, and is stored in the struct.
 */
WK_API
wk_status wk_opengl_target_init(wk_opengl_target *out,
                                uint32_t struct_size);

/*
 * ====================================================================================================
 * [vulkan] Vulkan hosts
 *
 * Welkin draws on the host's VkDevice and VkQueue, into the host's VkImages, and submits its own work: when
 * wk_view_record returns, the work is on the queue. Only one thread at a time may use a VkQueue. Either keep other
 * threads away from the queue during calls on its wk_device, or pass lock_queue and unlock_queue, which Welkin calls
 * around every submission. Call no Welkin function inside these two.
 *
 * Welkin takes an image in the layout in which the host left it and returns it in the layout that the host asks for.
 * On one queue no semaphores are needed: Welkin's work waits for what the host submitted before, and what the host
 * submits afterwards waits for Welkin's. Semaphores order work with other queues.
 *
 * Pass handles as Vulkan has them: dispatchable ones as pointers, others as 64-bit numbers.
 *
 * Needed: Vulkan 1.1, or 1.0 with VK_KHR_maintenance1 and VK_KHR_storage_buffer_storage_class; a queue that draws and
 * computes. For each use on the left, enable the extension or feature on the right for the VkDevice, and list it in
 * the wk_vulkan_host_desc:
 *
 *     images in PRESENT_SRC_KHR                     VK_KHR_swapchain in enabled_device_extensions
 *     colour of several samples                     VkPhysicalDeviceFeatures::sampleRateShading in enabled_features
 *     timeline semaphores                           timelineSemaphore in enabled_features
 *     DEPTH_ATTACHMENT and DEPTH_READ_ONLY layouts  separateDepthStencilLayouts in enabled_features
 *     ATTACHMENT and READ_ONLY layouts              synchronization2 in enabled_features
 *
 * Welkin uses other extensions and features only if the host lists them.
 *
 * Destroy views, contexts and textures first, then the wk_device, then the VkDevice, then the VkInstance. While a
 * wk_device has children, wk_device_destroy answers WK_ERROR_IN_USE, and the VkDevice must stay too. Vulkan cannot
 * tell whether a VkDevice still lives, so destroying it earlier crashes, as with objects of your own.
 * ====================================================================================================
 */

/** The host's vkGetInstanceProcAddr, cast to this type: it returns a function pointer, or NULL. */
typedef void *(*wk_vulkan_get_proc_fn)(void *instance, const char *name);

/** Takes or releases the host's lock on its queue. */
typedef void (*wk_vulkan_queue_fn)(void *user);

/** The host's Vulkan device. All handles stay the host's and must outlive the wk_device. */
typedef struct wk_vulkan_host_desc {
    /** sizeof(wk_vulkan_host_desc) of your header. */
    uint32_t struct_size;
    /** WK_STRUCT_TYPE_VULKAN_HOST_DESC. */
    wk_struct_type struct_type;
    /** No extensions in this version: NULL. */
    const void *next;
    /** vkGetInstanceProcAddr. Default NULL; must be given. */
    wk_vulkan_get_proc_fn get_instance_proc_addr;
    /** VkInstance. Default NULL; must be given. */
    void *instance;
    /** VkPhysicalDevice. Default NULL; must be given. */
    void *physical_device;
    /** VkDevice. Default NULL; must be given. */
    void *device;
    /** VkApplicationInfo::apiVersion of the instance; 0 (the default) means 1.0, as in Vulkan. */
    uint32_t instance_api_version;
    /** Family of the queue; it must draw and compute. Default 0. */
    uint32_t queue_family_index;
    /** Index of the queue in the family. Default 0. */
    uint32_t queue_index;
    /** Number of enabled_instance_extensions. Default 0. */
    uint32_t instance_extension_count;
    /** Names of the instance extensions that the host enabled. Default NULL. */
    const char *const *enabled_instance_extensions;
    /**
     * Names of the device extensions that the host enabled, VK_KHR_swapchain among them if it presents. Default NULL.
     */
    const char *const *enabled_device_extensions;
    /** Number of enabled_device_extensions. Default 0. */
    uint32_t device_extension_count;
    /** Must be 0. */
    uint32_t reserved0;
    /**
     * The features that the host enabled: the VkDeviceCreateInfo that it gave to vkCreateDevice, or a chain of
     * VkPhysicalDevice..Features structs. Read during the call. NULL (the default): no feature is enabled.
     */
    const void *enabled_features;
    /**
     * Function that takes the host's queue lock. Set it together with unlock_queue, or leave both NULL (the default).
     */
    wk_vulkan_queue_fn lock_queue;
    /** Function that releases the lock. */
    wk_vulkan_queue_fn unlock_queue;
    /** Pointer that is passed to both functions. Default NULL. */
    void *user;
} wk_vulkan_host_desc;

/** Every field of `wk_vulkan_host_desc` at its default. */
#define WK_VULKAN_HOST_DESC_INIT { \
    /* struct_size */ (uint32_t)sizeof(wk_vulkan_host_desc), \
    /* struct_type */ WK_STRUCT_TYPE_VULKAN_HOST_DESC, \
    /* next */ NULL, \
    /* get_instance_proc_addr */ NULL, \
    /* instance */ NULL, \
    /* physical_device */ NULL, \
    /* device */ NULL, \
    /* instance_api_version */ 0, \
    /* queue_family_index */ 0, \
    /* queue_index */ 0, \
    /* instance_extension_count */ 0, \
    /* enabled_instance_extensions */ NULL, \
    /* enabled_device_extensions */ NULL, \
    /* device_extension_count */ 0, \
    /* reserved0 */ 0, \
    /* enabled_features */ NULL, \
    /* lock_queue */ NULL, \
    /* unlock_queue */ NULL, \
    /* user */ NULL \
}

/** A host's image, handed over for one wk_view_record. It has one mip level and 1, 2, 4 or 8 samples. */
typedef struct wk_vulkan_image {
    /** sizeof(wk_vulkan_image) of your header. */
    uint32_t struct_size;
    /** WK_STRUCT_TYPE_VULKAN_IMAGE. */
    wk_struct_type struct_type;
    /** No extensions in this version: NULL. */
    const void *next;
    /** VkImage. Default 0; must be given. */
    uint64_t image;
    /** VkFormat that the image was created with. Default 0; must be given. */
    uint32_t format;
    /** Width, pixels. Default 0; must be given. */
    uint32_t width;
    /** Height, pixels. Default 0; must be given. */
    uint32_t height;
    /**
     * Samples of a pixel. Default 1. Colour with several samples needs sampleRateShading in enabled_features of the
     * wk_vulkan_host_desc.
     */
    uint32_t samples;
    /**
     * VkImageUsageFlags that the image was created with: COLOR_ATTACHMENT and TRANSFER_SRC for colour, SAMPLED for
     * images that are read, and also DEPTH_STENCIL_ATTACHMENT for depth with WK_DEPTH_ACCESS_READ_WRITE.
     */
    uint32_t usage;
    /** Array layers that the image was created with. Default 1. For an occluder map it must be 1. */
    uint32_t array_layers;
    /**
     * Array layer that is handed over, such as one eye of a stereo or multiview host; the others stay untouched.
     * Default 0.
     */
    uint32_t layer;
    /**
     * VkImageLayout in which the host left the image's handed-over layer. Default 0 (UNDEFINED: its content may be
     * discarded; colour only).
     */
    uint32_t layout;
    /**
     * VkImageLayout in which Welkin returns the layer. Default 0; must be given. PRESENT_SRC_KHR, here and in
     * `layout`, needs VK_KHR_swapchain in enabled_device_extensions of the wk_vulkan_host_desc.
     */
    uint32_t final_layout;
    /** Must be 0. */
    uint32_t reserved0;
} wk_vulkan_image;

/** Every field of `wk_vulkan_image` at its default. */
#define WK_VULKAN_IMAGE_INIT { \
    /* struct_size */ (uint32_t)sizeof(wk_vulkan_image), \
    /* struct_type */ WK_STRUCT_TYPE_VULKAN_IMAGE, \
    /* next */ NULL, \
    /* image */ UINT64_C(0), \
    /* format */ 0, \
    /* width */ 0, \
    /* height */ 0, \
    /* samples */ 1, \
    /* usage */ 0, \
    /* array_layers */ 1, \
    /* layer */ 0, \
    /* layout */ 0, \
    /* final_layout */ 0, \
    /* reserved0 */ 0 \
}

/** Kinds of semaphore. */
typedef uint32_t wk_vulkan_semaphore_kind;

/** Binary. */
#define WK_VULKAN_SEMAPHORE_BINARY 0
/** Timeline; needs timelineSemaphore enabled and listed. */
#define WK_VULKAN_SEMAPHORE_TIMELINE 1

/** A host's semaphore. */
typedef struct wk_vulkan_semaphore {
    /** sizeof(wk_vulkan_semaphore) of your header. */
    uint32_t struct_size;
    /** WK_STRUCT_TYPE_VULKAN_SEMAPHORE. */
    wk_struct_type struct_type;
    /** No extensions in this version: NULL. */
    const void *next;
    /** VkSemaphore. Default 0; must be given. */
    uint64_t semaphore;
    /** Value of a timeline semaphore to wait for or to signal. Default 0. */
    uint64_t value;
    /** Kind of semaphore. Default WK_VULKAN_SEMAPHORE_BINARY. */
    wk_vulkan_semaphore_kind kind;
    /** Must be 0. */
    uint32_t reserved0;
} wk_vulkan_semaphore;

/** Every field of `wk_vulkan_semaphore` at its default. */
#define WK_VULKAN_SEMAPHORE_INIT { \
    /* struct_size */ (uint32_t)sizeof(wk_vulkan_semaphore), \
    /* struct_type */ WK_STRUCT_TYPE_VULKAN_SEMAPHORE, \
    /* next */ NULL, \
    /* semaphore */ UINT64_C(0), \
    /* value */ UINT64_C(0), \
    /* kind */ WK_VULKAN_SEMAPHORE_BINARY, \
    /* reserved0 */ 0 \
}

/** The images of a frame on a host's Vulkan device. */
typedef struct wk_vulkan_target {
    /** sizeof(wk_vulkan_target) of your header. */
    uint32_t struct_size;
    /** WK_STRUCT_TYPE_VULKAN_TARGET. */
    wk_struct_type struct_type;
    /** No extensions in this version: NULL. */
    const void *next;
    /** The image to draw into. Default NULL. */
    const wk_vulkan_image *color;
    /**
     * The host's depth, as large as `color` and with as many samples. If `color` has one sample (a resolved picture),
     * depth may have more; the first sample of each pixel is then used. With NULL (the default) every pixel shows the
     * sky.
     */
    const wk_vulkan_image *depth;
    /**
     * A mask: where it is 1, the host's pixel stays; where it is 0, Welkin draws weather. It is another image, as
     * large as `color`, with one sample. Default NULL.
     */
    const wk_vulkan_image *mask;
    /**
     * Semaphores to wait for before drawing, at most 16. The submission that signals a binary one must come before
     * this call.
     */
    const wk_vulkan_semaphore *wait_semaphores;
    /** Semaphores to signal when all is drawn and the images are in their final layouts. At most 16. */
    const wk_vulkan_semaphore *signal_semaphores;
    /** Number of wait_semaphores. Default 0. */
    uint32_t wait_count;
    /**
     * Bytes from one wait semaphore to the next: sizeof(wk_vulkan_semaphore) of your header, which is the default.
     */
    uint32_t wait_stride;
    /** Number of signal_semaphores. Default 0. */
    uint32_t signal_count;
    /**
     * Bytes from one signal semaphore to the next: sizeof(wk_vulkan_semaphore) of your header, which is the default.
     */
    uint32_t signal_stride;
    /**
     * Each pixel's surface class: the byte of red is a wk_surface_class, or 0 to use the class of the host's terrain
     * or the context's default. VK_FORMAT_R8_UNORM or the like, as large as `color`, one sample. Default NULL.
     */
    const wk_vulkan_image *surface_classes;
    /**
     * Unit normals, in the host's world or in eye space (WK_FRAME_NORMALS_IN_EYE_SPACE): (n + 1) / 2 in normalised
     * formats, n in float formats. Where a pixel holds no unit vector (a cleared pixel), Welkin uses the normal of the
     * host's terrain or depth. As large as `color`, one sample. Default NULL.
     */
    const wk_vulkan_image *normals;
} wk_vulkan_target;

/** Every field of `wk_vulkan_target` at its default. */
#define WK_VULKAN_TARGET_INIT { \
    /* struct_size */ (uint32_t)sizeof(wk_vulkan_target), \
    /* struct_type */ WK_STRUCT_TYPE_VULKAN_TARGET, \
    /* next */ NULL, \
    /* color */ NULL, \
    /* depth */ NULL, \
    /* mask */ NULL, \
    /* wait_semaphores */ NULL, \
    /* signal_semaphores */ NULL, \
    /* wait_count */ 0, \
    /* wait_stride */ (uint32_t)sizeof(wk_vulkan_semaphore), \
    /* signal_count */ 0, \
    /* signal_stride */ (uint32_t)sizeof(wk_vulkan_semaphore), \
    /* surface_classes */ NULL, \
    /* normals */ NULL \
}

/**
 * Wraps the host's Vulkan device. On success `*out_device` is a new handle for `wk_device_destroy`; call that before
 * you destroy your device. Welkin never destroys the host's objects.
 * Thread: any that may use the queue.
 * Errors: WK_ERROR_INVALID_ARGUMENT names a NULL or foreign handle, or all missing extensions, features and fields;
 * WK_ERROR_UNSUPPORTED names what the driver cannot do; WK_ERROR_ALREADY_WRAPPED if the queue has a wk_device;
 * WK_ERROR_NO_ADAPTER if the instance cannot list its physical devices.
 */
WK_API wk_status wk_device_create_vulkan(const wk_vulkan_host_desc *desc, wk_device **out_device);

/**
 * Waits until the GPU no longer uses a VkImage, and forgets it. Call this function for each image that you handed
 * over, before or after you destroy it (an engine may rebuild its swapchain inside a call), but before you hand over a
 * new one: Vulkan may give the new image the old handle, and Welkin would draw into the dead image. As always, destroy
 * an image only when the GPU has finished with it: after the semaphores that its last wk_view_record signals, or after
 * vkDeviceWaitIdle. An unknown image is no error. Slow: do not call it in every frame.
 * Thread: exclusive on the device.
 * Errors: WK_ERROR_UNSUPPORTED on a device that is not on a Vulkan host.
 */
WK_API
wk_status wk_device_forget_vulkan_image(wk_device *device,
                                        uint64_t image);

/**
 * Writes the default of every field: the same bytes as `WK_VULKAN_HOST_DESC_INIT`. `struct_size` is `sizeof(wk_vulkan_host_desc)`
 * as the caller was compiled, and is stored in the struct.
 */
WK_API
wk_status wk_vulkan_host_desc_init(wk_vulkan_host_desc *out,
                                   uint32_t struct_size);

/**
 * Writes the default of every field: the same bytes as `WK_VULKAN_IMAGE_INIT`. `struct_size` is `sizeof(wk_vulkan_image)`
 * as the caller was compiled, and is stored in the struct.
 */
WK_API
wk_status wk_vulkan_image_init(wk_vulkan_image *out,
                               uint32_t struct_size);

/**
 * Writes the default of every field: the same bytes as `WK_VULKAN_SEMAPHORE_INIT`. `struct_size` is `sizeof(wk_vulkan_semaphore)`
 * as the caller was compiled, and is stored in the struct.
 */
WK_API
wk_status wk_vulkan_semaphore_init(wk_vulkan_semaphore *out,
                                   uint32_t struct_size);

/**
 * Writes the default of every field: the same bytes as `WK_VULKAN_TARGET_INIT`. `struct_size` is `sizeof(wk_vulkan_target)`
 * as the caller was compiled, and is stored in the struct.
 */
WK_API
wk_status wk_vulkan_target_init(wk_vulkan_target *out,
                                uint32_t struct_size);

/*
 * ====================================================================================================
 * [weather_kinds] Kinds of weather
 *
 * These constants are the kinds of weather that a report names with words. Their numbers never change.
 * ====================================================================================================
 */

/** Kind of the air's dry particles. */
typedef uint32_t wk_aerosol_kind;

/** Average continental air: soil, soot-poor industry, sulphates. */
#define WK_AEROSOL_CONTINENTAL 0
/** Clean continental or rural air. */
#define WK_AEROSOL_CLEAN 1
/** Open-sea air: sea salt. */
#define WK_AEROSOL_MARITIME 2
/** Urban air with soot. */
#define WK_AEROSOL_URBAN 3
/** Haze (METAR HZ): polluted continental air. */
#define WK_AEROSOL_HAZE 4
/** Lifted mineral dust (METAR DU, DS). */
#define WK_AEROSOL_DUST 5
/** Lifted sand (METAR SA, SS): coarser than dust. */
#define WK_AEROSOL_SAND 6
/** Smoke of burning biomass (METAR FU). */
#define WK_AEROSOL_SMOKE 7
/** Volcanic ash (METAR VA). */
#define WK_AEROSOL_VOLCANIC_ASH 8
/** Arctic air. */
#define WK_AEROSOL_ARCTIC 9

/** Fog and mist: suspended droplets at the ground. */
typedef uint32_t wk_fog_kind;

/**
 * No fog is reported. The extinction that visibility_m requires beyond that of clean air and precipitation is aerosol.
 * Haze, dust, sand, smoke and ash may take all of it. Other aerosols take at most that of a visibility of 5 km
 * (wk_weather_overrides.visibility_above_fog_m), and the rest is mist or fog all the same.
 */
#define WK_FOG_NONE 0
/** Mist (METAR BR): droplets, visibility 1 to 5 km. */
#define WK_FOG_MIST 1
/** Shallow fog (METAR MIFG): fog up to 2 m high, clear above. */
#define WK_FOG_SHALLOW 2
/** Patches of fog (METAR BCFG). */
#define WK_FOG_PATCHES 3
/** Part of the aerodrome in fog (METAR PRFG). */
#define WK_FOG_PARTIAL 4
/** Fog (METAR FG): visibility below 1 km. */
#define WK_FOG_FOG 5
/** Freezing fog (METAR FZFG): supercooled droplets. */
#define WK_FOG_FREEZING 6

/** Cloud genera, and the two kinds that METAR names. */
typedef uint32_t wk_cloud_kind;

/** Not known: Welkin chooses by height, cover and precipitation. */
#define WK_CLOUD_UNKNOWN 0
/** Low grey sheet. */
#define WK_CLOUD_STRATUS 1
/** Low lumpy sheet. */
#define WK_CLOUD_STRATOCUMULUS 2
/** Fair-weather heaps. */
#define WK_CLOUD_CUMULUS 3
/** Towering cumulus (METAR TCU). */
#define WK_CLOUD_TOWERING_CUMULUS 4
/** Cumulonimbus (METAR CB). */
#define WK_CLOUD_CUMULONIMBUS 5
/** Thick sheet that rains or snows. */
#define WK_CLOUD_NIMBOSTRATUS 6
/** Middle lumpy sheet. */
#define WK_CLOUD_ALTOCUMULUS 7
/** Middle grey sheet. */
#define WK_CLOUD_ALTOSTRATUS 8
/** High fibres of ice. */
#define WK_CLOUD_CIRRUS 9
/** High veil of ice. */
#define WK_CLOUD_CIRROSTRATUS 10
/** High ripples of ice. */
#define WK_CLOUD_CIRROCUMULUS 11

/**
 * Kind of precipitation. Choose RAIN for frontal (stratiform) rain, usually 1 to 10 mm/h, and RAIN with
 * WK_PRECIPITATION_SHOWERS for convective rain, 10 to 100 mm/h. Choose DRIZZLE for relief (orographic) rain, which has
 * many small drops, 0.5 to 3 mm/h, and for drizzle, 0.1 to 1 mm/h. docs/rain.md has the drop sizes of each type.
 */
typedef uint32_t wk_precipitation_kind;

/** Nothing falls; the rate must be 0. */
#define WK_PRECIPITATION_NONE 0
/** Drizzle (DZ), and relief rain: small drops. */
#define WK_PRECIPITATION_DRIZZLE 1
/** Rain (RA): frontal, or convective with WK_PRECIPITATION_SHOWERS. */
#define WK_PRECIPITATION_RAIN 2
/** Snow (SN). */
#define WK_PRECIPITATION_SNOW 3
/** Rain and snow together (RASN). */
#define WK_PRECIPITATION_SLEET 4
/** Frozen raindrops (PL). */
#define WK_PRECIPITATION_ICE_PELLETS 5
/** Hail of 5 mm and more (GR). */
#define WK_PRECIPITATION_HAIL 6
/** Small hail or snow pellets (GS). */
#define WK_PRECIPITATION_SMALL_HAIL 7
/** Snow grains (SG): frozen drizzle. */
#define WK_PRECIPITATION_SNOW_GRAINS 8
/** Ice crystals, diamond dust (IC). */
#define WK_PRECIPITATION_ICE_CRYSTALS 9
/** Freezing drizzle (FZDZ). */
#define WK_PRECIPITATION_FREEZING_DRIZZLE 10
/** Freezing rain (FZRA). */
#define WK_PRECIPITATION_FREEZING_RAIN 11

/** Kind of matter that the wind lifts from the ground. */
typedef uint32_t wk_lofted_kind;

/** Nothing. */
#define WK_LOFTED_NONE 0
/** Drifting snow below eye height (DRSN). */
#define WK_LOFTED_DRIFTING_SNOW 1
/** Blowing snow at and above eye height (BLSN). */
#define WK_LOFTED_BLOWING_SNOW 2
/** Drifting dust or sand below eye height (DRDU, DRSA). */
#define WK_LOFTED_DRIFTING_DUST 3
/** Blowing dust (BLDU) or a dust storm (DS). */
#define WK_LOFTED_BLOWING_DUST 4
/** Blowing sand (BLSA) or a sand storm (SS). */
#define WK_LOFTED_BLOWING_SAND 5
/** Blowing spray (BLPY). */
#define WK_LOFTED_BLOWING_SPRAY 6

/** State of the ground as an observer names it. */
typedef uint32_t wk_surface_state;

/** Dry. */
#define WK_SURFACE_DRY 0
/** Damp: darker, no film. */
#define WK_SURFACE_DAMP 1
/** Wet: a film that shines. */
#define WK_SURFACE_WET 2
/** Standing water, puddles. */
#define WK_SURFACE_STANDING_WATER 3
/** Frost. */
#define WK_SURFACE_FROST 4
/** Ice. */
#define WK_SURFACE_ICE 5
/** Lying snow; see surface_snow_depth_m. */
#define WK_SURFACE_SNOW 6

/*
 * ====================================================================================================
 * [weather] Weather
 *
 * A wk_weather describes the weather: plain data in SI units, which every call copies. Start from WK_WEATHER_INIT (a
 * clear standard day), a METAR report or a preset, and change the fields that you know better. In a wk_weather zero is
 * a value (0 degrees, north, calm, 0 %) and never means unknown. A field that may be unknown has a bit in `has`: where
 * the bit is clear, Welkin ignores the field and derives the value by a named physical law. All reals are doubles.
 * ====================================================================================================
 */

/** Flags that say which optional fields of a wk_cloud_layer are set. */
typedef uint32_t wk_cloud_layer_has_flags;

/** thickness_m */
#define WK_CLOUD_LAYER_HAS_THICKNESS 1
/** water_g_m3 */
#define WK_CLOUD_LAYER_HAS_WATER 2
/** droplet_radius_um */
#define WK_CLOUD_LAYER_HAS_DROPLET_RADIUS 4
/** wind_m_s and wind_from_deg */
#define WK_CLOUD_LAYER_HAS_WIND 8

/** One layer of cloud. */
typedef struct wk_cloud_layer {
    /** sizeof(wk_cloud_layer) of your header. */
    uint32_t struct_size;
    /** WK_STRUCT_TYPE_CLOUD_LAYER. */
    wk_struct_type struct_type;
    /** No extensions in this version: NULL. */
    const void *next;
    /** Flags of the optional fields that are set. Default 0. */
    wk_cloud_layer_has_flags has;
    /** Kind of cloud. Default WK_CLOUD_UNKNOWN. */
    wk_cloud_kind kind;
    /** Fraction of the sky that the layer covers (eighths / 8). Range [0, 1], default 0. */
    double cover;
    /** Base above the station, m. Range [0, 20000], default 0. */
    double base_m;
    /** Optional: thickness, m. Range [1, 20000]; else by kind. */
    double thickness_m;
    /** Optional: water, liquid or ice, g/m^3. Range [0, 10]; else by kind. */
    double water_g_m3;
    /** Optional: effective radius of droplets or crystals, um. Range [1, 500]; else by kind. */
    double droplet_radius_um;
    /**
     * Optional: speed of the wind that carries the layer, m/s. Range [0, 150]; else that of the weather's wind at the
     * middle of the layer, which grows and veers with height (docs/clouds.md). Changing this speed does not displace
     * any cloud.
     */
    double wind_m_s;
    /**
     * Optional, with wind_m_s: direction that the wind of wind_m_s comes from, degrees clockwise from true north.
     * Range [0, 360].
     */
    double wind_from_deg;
    /** Typical distance between clouds, m. Range [50, 200000]; 0, the default, lets kind and thickness decide. */
    double spacing_m;
    /** Lifetime of the layer's clouds, s. Range [60, 1e6]; 0, the default, means 1200. */
    double life_s;
} wk_cloud_layer;

/** Every field of `wk_cloud_layer` at its default. */
#define WK_CLOUD_LAYER_INIT { \
    /* struct_size */ (uint32_t)sizeof(wk_cloud_layer), \
    /* struct_type */ WK_STRUCT_TYPE_CLOUD_LAYER, \
    /* next */ NULL, \
    /* has */ 0, \
    /* kind */ WK_CLOUD_UNKNOWN, \
    /* cover */ 0.0, \
    /* base_m */ 0.0, \
    /* thickness_m */ 0.0, \
    /* water_g_m3 */ 0.0, \
    /* droplet_radius_um */ 0.0, \
    /* wind_m_s */ 0.0, \
    /* wind_from_deg */ 0.0, \
    /* spacing_m */ 0.0, \
    /* life_s */ 0.0 \
}

/** Flags that say which optional fields of a wk_weather are set. */
typedef uint64_t wk_weather_has_flags;

/** vertical_visibility_m */
#define WK_WEATHER_HAS_VERTICAL_VISIBILITY 1
/** runway_visual_range_m */
#define WK_WEATHER_HAS_RUNWAY_VISUAL_RANGE 2
/** aerosol_angstrom_exponent */
#define WK_WEATHER_HAS_AEROSOL_ANGSTROM_EXPONENT 4
/** aerosol_single_scattering_albedo */
#define WK_WEATHER_HAS_AEROSOL_SINGLE_SCATTERING_ALBEDO 8
/** aerosol_asymmetry */
#define WK_WEATHER_HAS_AEROSOL_ASYMMETRY 16
/** aerosol_scale_height_m */
#define WK_WEATHER_HAS_AEROSOL_SCALE_HEIGHT 32
/** fog_top_m */
#define WK_WEATHER_HAS_FOG_TOP 64
/** fog_coverage */
#define WK_WEATHER_HAS_FOG_COVERAGE 128
/** fog_visibility_inside_m */
#define WK_WEATHER_HAS_FOG_VISIBILITY_INSIDE 256
/** precipitation_liquid_fraction */
#define WK_WEATHER_HAS_PRECIPITATION_LIQUID_FRACTION 512
/** wind_gust_m_s */
#define WK_WEATHER_HAS_WIND_GUST 1024
/** wind_variable_from_deg and wind_variable_to_deg */
#define WK_WEATHER_HAS_WIND_VARIABLE 2048
/** wind_turbulence_intensity */
#define WK_WEATHER_HAS_WIND_TURBULENCE_INTENSITY 4096
/** sea_significant_wave_height_m */
#define WK_WEATHER_HAS_SEA_WAVE_HEIGHT 8192
/** sea_state */
#define WK_WEATHER_HAS_SEA_STATE 16384
/** sea_temperature_c */
#define WK_WEATHER_HAS_SEA_TEMPERATURE 32768
/** swell_height_m, swell_period_s and swell_from_deg */
#define WK_WEATHER_HAS_SWELL 65536
/** surface_state */
#define WK_WEATHER_HAS_SURFACE_STATE 131072
/** surface_roughness_length_m */
#define WK_WEATHER_HAS_SURFACE_ROUGHNESS_LENGTH 262144
/** lofted_top_m */
#define WK_WEATHER_HAS_LOFTED_TOP 524288

/** Properties of precipitation. */
typedef uint32_t wk_precipitation_flags;

/** Precipitation from convective cloud (SH): fewer and larger drops, sharp onset and end. */
#define WK_PRECIPITATION_SHOWERS 1
/** Precipitation with thunder (TS). */
#define WK_PRECIPITATION_THUNDERSTORM 2
/** Precipitation with hail in addition to its kind (GR, GS). */
#define WK_PRECIPITATION_WITH_HAIL 4

/** The weather at a station and a time. Heights are above the station unless stated otherwise. */
typedef struct wk_weather {
    /** sizeof(wk_weather) of your header. */
    uint32_t struct_size;
    /** WK_STRUCT_TYPE_WEATHER. */
    wk_struct_type struct_type;
    /** NULL (the default), or a wk_weather_overrides. */
    const void *next;
    /** Flags of the optional fields that are set. Default 0. */
    wk_weather_has_flags has;
    /**
     * Meteorological optical range at the station, m: the distance at which 550 nm light falls to 5 % (the reported
     * visibility). It includes air, haze, fog, rain and snow. Range [1, 1e6], default 40000.
     */
    double visibility_m;
    /**
     * Optional: vertical visibility into an obscured sky, m. Range [0, 10000]; else the sky is not obscured. With fog
     * it sets the fog's depth.
     */
    double vertical_visibility_m;
    /** Optional: runway visual range, m. Range [1, 10000]. Information only; extinction follows visibility_m. */
    double runway_visual_range_m;
    /** Air temperature at 2 m, degrees Celsius. Range [-90, 60], default 15. */
    double temperature_c;
    /** Relative humidity over water, fraction. Range [0, 1], default 0.5. */
    double relative_humidity;
    /** Pressure reduced to mean sea level (QNH), hPa. Range [800, 1100], default 1013.25. */
    double pressure_hpa;
    /** Height of the station above mean sea level, m. Range [-500, 9000], default 0. */
    double station_altitude_m;
    /** Ozone column, Dobson units. Range [0, 700], default 300. */
    double ozone_du;
    /** Kind of dry particles. Default WK_AEROSOL_CONTINENTAL. */
    wk_aerosol_kind aerosol_kind;
    /** Fog or mist. Default WK_FOG_NONE. */
    wk_fog_kind fog_kind;
    /** Optional: Angstrom exponent: extinction falls as wavelength^-exponent. Range [-1, 4]; else by kind. */
    double aerosol_angstrom_exponent;
    /** Optional: single scattering albedo at 550 nm. Range [0, 1]; else by kind and humidity. */
    double aerosol_single_scattering_albedo;
    /** Optional: mean cosine of the phase function. Range [-0.99, 0.99]; else by kind and humidity. */
    double aerosol_asymmetry;
    /**
     * Optional: scale height of the particles, over which their density falls to 1/e, m. Range [10, 20000]; else by
     * kind. The value used is at least the station's altitude divided by 4.6 (435 m for a station at 2000 m), because
     * the sky is computed from the density at sea level, which is limited to 100 times that at the station.
     */
    double aerosol_scale_height_m;
    /** Optional: top of the fog, m. Range [0.1, 2000]; else by kind or vertical visibility. */
    double fog_top_m;
    /** Optional: fraction of the ground under fog. Range [0, 1]; else by kind. */
    double fog_coverage;
    /**
     * Optional: visibility inside the fog, m. Range [1, 10000]; else 200 m in shallow fog, and in patches of fog and
     * partial fog if visibility_m is 1000 or more, because an observer reports the visibility over or past such fog;
     * 500 m in drifting snow or dust without fog. Other layers ignore the field: visibility_m holds inside them.
     */
    double fog_visibility_inside_m;
    /** Kind of precipitation. Default WK_PRECIPITATION_NONE. */
    wk_precipitation_kind precipitation_kind;
    /** Properties of the precipitation. Default 0. */
    wk_precipitation_flags precipitation_flags;
    /** Precipitation rate, mm/h of liquid water. Range [0, 500], default 0; must be 0 if nothing falls. */
    double precipitation_rate_mm_h;
    /** Optional: liquid fraction of the precipitation. Range [0, 1]; else by kind. */
    double precipitation_liquid_fraction;
    /** Mean wind at 10 m above ground, m/s. Range [0, 120], default 0. */
    double wind_speed_m_s;
    /** Direction that the wind comes from, degrees clockwise from true north. Range [0, 360], default 0. */
    double wind_from_deg;
    /** Optional: highest 3-second gust, m/s. Range [wind_speed_m_s, 150]; else from the turbulence. */
    double wind_gust_m_s;
    /**
     * Optional, together with wind_variable_to_deg: start of the range within which the direction varies, degrees; the
     * range runs clockwise. Range [0, 360].
     */
    double wind_variable_from_deg;
    /**
     * End of the range within which the direction varies, degrees. Range [0, 360]. 0 to 360 means all directions
     * (VRB).
     */
    double wind_variable_to_deg;
    /**
     * Optional: turbulence intensity, the ratio of the speed's standard deviation to its mean. Range [0, 1]; else from
     * the roughness.
     */
    double wind_turbulence_intensity;
    /** Optional: significant height of the wind sea, m. Range [0, 30]; else from sea_state or the wind. */
    double sea_significant_wave_height_m;
    /** Optional: water temperature, degrees Celsius. Range [-3, 45]; else the air's, not below -1.8. */
    double sea_temperature_c;
    /**
     * Optional, together with swell_period_s and swell_from_deg: significant height of the swell, m. Range [0, 20].
     */
    double swell_height_m;
    /** Peak period of the swell, s. Range [1, 30] if the swell is set. */
    double swell_period_s;
    /** Direction that the swell comes from, degrees clockwise from true north. Range [0, 360]. */
    double swell_from_deg;
    /** Optional: WMO sea state, code table 3700. Range 0 to 9. */
    uint32_t sea_state;
    /** Optional: observed state of the ground; else from precipitation, temperature and snow depth. */
    wk_surface_state surface_state;
    /** Depth of lying snow, m. Range [0, 20], default 0. */
    double surface_snow_depth_m;
    /** Optional: roughness length of the land, m. Range [1e-5, 5]; else 0.03. */
    double surface_roughness_length_m;
    /** Optional: depth of the layer of matter that the wind lifts, m. Range [0.1, 5000]; else by kind. */
    double lofted_top_m;
    /** Kind of matter that the wind lifts. Default WK_LOFTED_NONE. */
    wk_lofted_kind lofted_kind;
    /** Number of cloud layers, at most wk_caps.max_cloud_layers (16). Default 0. */
    uint32_t cloud_count;
    /** The cloud layers in any order; may be NULL if there are none. Read during the call only. */
    const wk_cloud_layer *clouds;
    /** Bytes from one layer to the next: sizeof(wk_cloud_layer) of your header, which is the default. */
    uint32_t cloud_stride;
    /** Must be 0. */
    uint32_t reserved0;
} wk_weather;

/** Every field of `wk_weather` at its default. */
#define WK_WEATHER_INIT { \
    /* struct_size */ (uint32_t)sizeof(wk_weather), \
    /* struct_type */ WK_STRUCT_TYPE_WEATHER, \
    /* next */ NULL, \
    /* has */ 0, \
    /* visibility_m */ 40000.0, \
    /* vertical_visibility_m */ 0.0, \
    /* runway_visual_range_m */ 0.0, \
    /* temperature_c */ 15.0, \
    /* relative_humidity */ 0.5, \
    /* pressure_hpa */ 1013.25, \
    /* station_altitude_m */ 0.0, \
    /* ozone_du */ 300.0, \
    /* aerosol_kind */ WK_AEROSOL_CONTINENTAL, \
    /* fog_kind */ WK_FOG_NONE, \
    /* aerosol_angstrom_exponent */ 0.0, \
    /* aerosol_single_scattering_albedo */ 0.0, \
    /* aerosol_asymmetry */ 0.0, \
    /* aerosol_scale_height_m */ 0.0, \
    /* fog_top_m */ 0.0, \
    /* fog_coverage */ 0.0, \
    /* fog_visibility_inside_m */ 0.0, \
    /* precipitation_kind */ WK_PRECIPITATION_NONE, \
    /* precipitation_flags */ 0, \
    /* precipitation_rate_mm_h */ 0.0, \
    /* precipitation_liquid_fraction */ 0.0, \
    /* wind_speed_m_s */ 0.0, \
    /* wind_from_deg */ 0.0, \
    /* wind_gust_m_s */ 0.0, \
    /* wind_variable_from_deg */ 0.0, \
    /* wind_variable_to_deg */ 0.0, \
    /* wind_turbulence_intensity */ 0.0, \
    /* sea_significant_wave_height_m */ 0.0, \
    /* sea_temperature_c */ 0.0, \
    /* swell_height_m */ 0.0, \
    /* swell_period_s */ 0.0, \
    /* swell_from_deg */ 0.0, \
    /* sea_state */ 0, \
    /* surface_state */ WK_SURFACE_DRY, \
    /* surface_snow_depth_m */ 0.0, \
    /* surface_roughness_length_m */ 0.0, \
    /* lofted_top_m */ 0.0, \
    /* lofted_kind */ WK_LOFTED_NONE, \
    /* cloud_count */ 0, \
    /* clouds */ NULL, \
    /* cloud_stride */ (uint32_t)sizeof(wk_cloud_layer), \
    /* reserved0 */ 0 \
}

/** Flags that say which fields of a wk_weather_overrides are set. */
typedef uint32_t wk_override_flags;

/** aerosol_extinction_per_m */
#define WK_OVERRIDE_AEROSOL_EXTINCTION 1
/** fog_extinction_per_m */
#define WK_OVERRIDE_FOG_EXTINCTION 2
/** precipitation_extinction_per_m */
#define WK_OVERRIDE_PRECIPITATION_EXTINCTION 4
/** visibility_above_fog_m */
#define WK_OVERRIDE_VISIBILITY_ABOVE_FOG 8
/** humidity_growth */
#define WK_OVERRIDE_HUMIDITY_GROWTH 16
/** rayleigh_density_ratio */
#define WK_OVERRIDE_RAYLEIGH_DENSITY 32
/** rayleigh_scale_height_m */
#define WK_OVERRIDE_RAYLEIGH_SCALE_HEIGHT 64
/**
 * A flag without a field: rain adds no cloud to a weather without clouds, and no water to the clouds that it falls
 * from.
 */
#define WK_OVERRIDE_RAIN_WITHOUT_CLOUD 128
/** cloud_direct and cloud_diffuse */
#define WK_OVERRIDE_CLOUD_LIGHT 256
/** wave_height_m */
#define WK_OVERRIDE_WAVE_HEIGHT 512
/** wetness */
#define WK_OVERRIDE_WETNESS 1024

/**
 * Your own values in place of the laws that derive one part of the weather from another. An extension: put it into
 * wk_weather.next.
 */
typedef struct wk_weather_overrides {
    /** sizeof(wk_weather_overrides) of your header. */
    uint32_t struct_size;
    /** WK_STRUCT_TYPE_WEATHER_OVERRIDES. */
    wk_struct_type struct_type;
    /** The next extension. Default NULL. */
    const void *next;
    /** Flags of the fields that are set; the laws give the others. Default 0. */
    wk_override_flags set;
    /** Must be 0. */
    uint32_t reserved0;
    /**
     * Aerosol extinction at 550 nm and station height, 1/m, in place of the value that follows from the visibility.
     * Range [0, 10].
     */
    double aerosol_extinction_per_m;
    /**
     * Extinction inside the layer of fog, mist or lifted matter at the ground, 1/m, in place of the value that follows
     * from the visibility. Range [0, 10].
     */
    double fog_extinction_per_m;
    /** Extinction of precipitation, 1/m, in place of that from the spectra of drops and flakes. Range [0, 10]. */
    double precipitation_extinction_per_m;
    /** Visibility in the air above a mist or fog, m. Range [100, 1e6]; law: 5 km over mist, 10 km over fog. */
    double visibility_above_fog_m;
    /**
     * Growth of the particles' extinction with humidity, relative to that at 80 %. Range [0.1, 20]; law: Haenel
     * (1976); 1 switches growth off.
     */
    double humidity_growth;
    /** Ratio of the air density at sea level to that of the standard atmosphere. Range [0, 10]. */
    double rayleigh_density_ratio;
    /** Scale height of the air, m. Range [100, 50000]. */
    double rayleigh_scale_height_m;
    /** Fraction of the sun's direct beam that passes the clouds. Range [0, 1]. */
    double cloud_direct;
    /** Diffuse light below the clouds as a fraction of the light above them. Range [0, 1]. */
    double cloud_diffuse;
    /** Significant wave height, m, in place of that from the wind or the sea state. Range [0, 30]. */
    double wave_height_m;
    /** Wetness of the ground, in place of that from the precipitation. Range [0, 1]. */
    double wetness;
} wk_weather_overrides;

/** Every field of `wk_weather_overrides` at its default. */
#define WK_WEATHER_OVERRIDES_INIT { \
    /* struct_size */ (uint32_t)sizeof(wk_weather_overrides), \
    /* struct_type */ WK_STRUCT_TYPE_WEATHER_OVERRIDES, \
    /* next */ NULL, \
    /* set */ 0, \
    /* reserved0 */ 0, \
    /* aerosol_extinction_per_m */ 0.0, \
    /* fog_extinction_per_m */ 0.0, \
    /* precipitation_extinction_per_m */ 0.0, \
    /* visibility_above_fog_m */ 0.0, \
    /* humidity_growth */ 0.0, \
    /* rayleigh_density_ratio */ 0.0, \
    /* rayleigh_scale_height_m */ 0.0, \
    /* cloud_direct */ 0.0, \
    /* cloud_diffuse */ 0.0, \
    /* wave_height_m */ 0.0, \
    /* wetness */ 0.0 \
}

/**
 * Writes the default of every field: the same bytes as `WK_CLOUD_LAYER_INIT`. `struct_size` is `sizeof(wk_cloud_layer)`
 * as the caller was compiled, and is stored in the struct.
 */
WK_API
wk_status wk_cloud_layer_init(wk_cloud_layer *out,
                              uint32_t struct_size);

/**
 * Writes the default of every field: the same bytes as `WK_WEATHER_INIT`. `struct_size` is `sizeof(wk_weather)`
 * as the caller was compiled, and is stored in the struct.
 */
WK_API wk_status wk_weather_init(wk_weather *out, uint32_t struct_size);

/**
 * Writes the default of every field: the same bytes as `WK_WEATHER_OVERRIDES_INIT`. `struct_size` is `sizeof(wk_weather_overrides)`
 * as the caller was compiled, and is stored in the struct.
 */
WK_API
wk_status wk_weather_overrides_init(wk_weather_overrides *out,
                                    uint32_t struct_size);

/*
 * ====================================================================================================
 * [report] Weather reports and presets
 *
 * These functions turn a METAR or SPECI report, as airports send it, into a wk_weather. Welkin reads the groups that
 * are present, in any order up to the pressure. Fields that the report leaves out or marks as missing keep their
 * defaults, or get values that the rest of the report makes likely; each has a bit in wk_metar.assumed. A calm wind
 * (00000KT) and one that nobody measured (/////KT) thus differ by WK_METAR_ASSUMED_WIND. Words that are no group of
 * the code change nothing and are counted.
 *
 * No report contains the altitude of its station: weather.station_altitude_m is 0 afterwards. Look wk_metar.station up
 * in your list of airports and set the altitude, because cloud bases, visibility and temperature refer to that height.
 * ====================================================================================================
 */

/** Properties of a report. */
typedef uint32_t wk_metar_flags;

/** A special report (SPECI). */
#define WK_METAR_SPECIAL 1
/** Made without an observer (AUTO). */
#define WK_METAR_AUTOMATIC 2
/** A correction (COR). */
#define WK_METAR_CORRECTED 4
/** The report gives only a lower limit of the visibility (CAVOK, 9999, 10SM), or no visibility. */
#define WK_METAR_VISIBILITY_IS_MINIMUM 8

/** Fields that a report leaves out or marks as missing. */
typedef uint32_t wk_metar_assumed_flags;

/** wind_speed_m_s and the rest of the wind: calm is assumed. */
#define WK_METAR_ASSUMED_WIND 1
/** wind_from_deg: 0 is assumed. */
#define WK_METAR_ASSUMED_WIND_DIRECTION 2
/**
 * visibility_m: the visibility that humidity and precipitation allow is assumed. It is at most 1 km in fog, dust
 * storms and sandstorms, and at most 5 km in mist, haze, smoke, volcanic ash, dust and sand.
 */
#define WK_METAR_ASSUMED_VISIBILITY 4
/** Present weather (`//`, or PWINO in the remarks): neither precipitation nor fog nor haze is assumed. */
#define WK_METAR_ASSUMED_PRECIPITATION 8
/** Clouds (`//////`, or no group at all): none are assumed besides those that are reported. */
#define WK_METAR_ASSUMED_CLOUDS 16
/** base_m of a layer (`BKN///`): 600 m is assumed. */
#define WK_METAR_ASSUMED_CLOUD_BASE 32
/**
 * cover of a layer (`///015`, `//////CB`): 3.5 eighths are assumed. With WK_CLOUD_AMOUNT_SUMS the group takes the
 * largest class of the groups below it instead (FEW if there are none), except above an overcast layer.
 */
#define WK_METAR_ASSUMED_CLOUD_COVER 64
/** vertical_visibility_m (`VV///`): 60 m is assumed. */
#define WK_METAR_ASSUMED_VERTICAL_VISIBILITY 128
/**
 * temperature_c: 15 is assumed, or, if the dew point is reported, the temperature for a relative humidity of 0.7. The
 * assumed temperature is at most -1 in snow, ice pellets, snow grains, ice crystals and freezing precipitation or fog,
 * and at most 1 where rain and snow fall together or the precipitation is unknown. It is never below the reported dew
 * point.
 */
#define WK_METAR_ASSUMED_TEMPERATURE 256
/** relative_humidity: 0.7 is assumed, or the humidity that a reported dew point gives at the assumed temperature. */
#define WK_METAR_ASSUMED_HUMIDITY 512
/** pressure_hpa: 1013.25 is assumed. */
#define WK_METAR_ASSUMED_PRESSURE 1024
/** wk_metar.day, hour and minute: 0 is assumed. */
#define WK_METAR_ASSUMED_TIME 2048

/** Meaning of the amounts in cloud groups. Nations differ, and a report does not say which practice it follows. */
typedef uint32_t wk_cloud_amount_rule;

/**
 * By the first letters of the station: sums in the United States with its territories and in Canada (K, C; P except PC
 * and PL; TI, TJ, NSTU, MUGM), layers elsewhere. American bases abroad report sums under the host country's letters:
 * set the rule for them.
 */
#define WK_CLOUD_AMOUNT_BY_STATION 0
/**
 * The amount of a group is the cover of its layer and all lower ones together (Federal Meteorological Handbook No. 1,
 * 9.4.2 b and 9.5.2).
 */
#define WK_CLOUD_AMOUNT_SUMS 1
/**
 * The amount of a group is the cover of its layer as if there were no other cloud (WMO-No. 306, FM 15, 15.9.1.2).
 */
#define WK_CLOUD_AMOUNT_LAYERS 2

/**
 * Place and time of a report, and the parts of it that wk_weather has no fields for. Offsets and lengths are bytes in
 * the text that you passed; 0 and 0 where the report has no such part.
 */
typedef struct wk_metar {
    /** sizeof(wk_metar) of your header. */
    uint32_t struct_size;
    /** WK_STRUCT_TYPE_METAR. */
    wk_struct_type struct_type;
    /** No extensions in this version: NULL. */
    const void *next;
    /** ICAO location indicator, NUL-terminated. */
    char station[8];
    /** Day of the month, UTC. */
    uint32_t day;
    /** Hour, UTC. */
    uint32_t hour;
    /** Minute, UTC. */
    uint32_t minute;
    /** Properties of the report: a union of WK_METAR_SPECIAL and the flags that follow it. */
    wk_metar_flags flags;
    /** Fields that the report leaves out or marks as missing. */
    wk_metar_assumed_flags assumed;
    /** Rule by which the amounts of clouds were read: WK_CLOUD_AMOUNT_SUMS or WK_CLOUD_AMOUNT_LAYERS. */
    wk_cloud_amount_rule cloud_amounts;
    /**
     * Lowest visibility in some direction, m, where the report states one besides the prevailing visibility
     * (`4000 1500NE`, `9999 3100`), else 0. For information: the weather has the prevailing visibility.
     */
    double lowest_visibility_m;
    /** Offset of the first runway visual range. */
    uint32_t runways_offset;
    /** Length of the runway visual ranges, from the first to the last, bytes. */
    uint32_t runways_length;
    /** Offset of the trend forecast, whose first word (NOSIG, BECMG, TEMPO) is included. */
    uint32_t trend_offset;
    /** Length of the trend forecast, bytes. */
    uint32_t trend_length;
    /** Offset of the remarks, after RMK. */
    uint32_t remarks_offset;
    /** Length of the remarks, bytes. */
    uint32_t remarks_length;
    /** Offset of the first word that is no group of the code. */
    uint32_t unread_offset;
    /** Length of this first word, bytes. */
    uint32_t unread_length;
    /** Number of words that are no group of the code. */
    uint32_t unread_count;
    /** Always 0. */
    uint32_t reserved0;
} wk_metar;

/** Every field of `wk_metar` at its default. */
#define WK_METAR_INIT { \
    /* struct_size */ (uint32_t)sizeof(wk_metar), \
    /* struct_type */ WK_STRUCT_TYPE_METAR, \
    /* next */ NULL, \
    /* station */ { 0, 0, 0, 0, 0, 0, 0, 0 }, \
    /* day */ 0, \
    /* hour */ 0, \
    /* minute */ 0, \
    /* flags */ 0, \
    /* assumed */ 0, \
    /* cloud_amounts */ WK_CLOUD_AMOUNT_BY_STATION, \
    /* lowest_visibility_m */ 0.0, \
    /* runways_offset */ 0, \
    /* runways_length */ 0, \
    /* trend_offset */ 0, \
    /* trend_length */ 0, \
    /* remarks_offset */ 0, \
    /* remarks_length */ 0, \
    /* unread_offset */ 0, \
    /* unread_length */ 0, \
    /* unread_count */ 0, \
    /* reserved0 */ 0 \
}

/** Options for reading a report. */
typedef struct wk_metar_options {
    /** sizeof(wk_metar_options) of your header. */
    uint32_t struct_size;
    /** WK_STRUCT_TYPE_METAR_OPTIONS. */
    wk_struct_type struct_type;
    /** No extensions in this version: NULL. */
    const void *next;
    /** Meaning of the amounts in cloud groups. Default WK_CLOUD_AMOUNT_BY_STATION. */
    wk_cloud_amount_rule cloud_amounts;
    /** Must be 0. */
    uint32_t reserved0;
} wk_metar_options;

/** Every field of `wk_metar_options` at its default. */
#define WK_METAR_OPTIONS_INIT { \
    /* struct_size */ (uint32_t)sizeof(wk_metar_options), \
    /* struct_type */ WK_STRUCT_TYPE_METAR_OPTIONS, \
    /* next */ NULL, \
    /* cloud_amounts */ WK_CLOUD_AMOUNT_BY_STATION, \
    /* reserved0 */ 0 \
}

/**
 * Reads a METAR or SPECI report (NUL-terminated text of at most 4096 bytes) into `*out_weather`, with cloud amounts by
 * the station's rule. The weather's cloud layers are written to `layers`, which has room for `layer_capacity` elements
 * of `layer_size` bytes (sizeof(wk_cloud_layer) of your header; 16 elements always suffice). out_weather->clouds
 * points there: keep `layers` as long as the weather. `out_metar` may be NULL. out_weather->station_altitude_m is 0:
 * set it from a list of airports.
 * Thread: any.
 * Errors: WK_ERROR_PARSE for a text without a station, without an observation (NIL) or without any group of the
 * weather: the message has line and column, what was expected there and what was found. WK_ERROR_PARSE for a text that
 * is too long; WK_ERROR_INVALID_ARGUMENT if the layers do not fit.
 */
WK_API
wk_status wk_weather_from_metar(const char *report,
                                wk_cloud_layer *layers,
                                uint32_t layer_capacity,
                                uint32_t layer_size,
                                wk_weather *out_weather,
                                wk_metar *out_metar);

/**
 * Reads a report as wk_weather_from_metar does, with `options`. NULL means all defaults.
 * Thread: any.
 * Errors: as wk_weather_from_metar; WK_ERROR_INVALID_ARGUMENT for an unknown rule.
 */
WK_API
wk_status wk_weather_from_metar_with(const char *report,
                                     const wk_metar_options *options,
                                     wk_cloud_layer *layers,
                                     uint32_t layer_capacity,
                                     uint32_t layer_size,
                                     wk_weather *out_weather,
                                     wk_metar *out_metar);

/**
 * Writes the weather of a named preset to `*out_weather`, and its cloud layers as wk_weather_from_metar does.
 * wk_get_preset gives the names.
 * Thread: any.
 * Errors: WK_ERROR_INVALID_ARGUMENT for an unknown name; the message lists the known ones.
 */
WK_API
wk_status wk_weather_from_preset(const char *name,
                                 wk_cloud_layer *layers,
                                 uint32_t layer_capacity,
                                 uint32_t layer_size,
                                 wk_weather *out_weather);

/**
 * Gets the name and the one-line description of the preset `index`. Indices begin at 0 and are in an order that suits
 * a menu. Both texts live as long as the process. Either pointer may be NULL.
 * Thread: any.
 * Errors: WK_ERROR_INVALID_ARGUMENT for an index beyond the last preset.
 */
WK_API wk_status wk_get_preset(uint32_t index, const char **out_name, const char **out_description);

/**
 * Writes the default of every field: the same bytes as `WK_METAR_OPTIONS_INIT`. `struct_size` is `sizeof(wk_metar_options)`
 * as the caller was compiled, and is stored in the struct.
 */
WK_API
wk_status wk_metar_options_init(wk_metar_options *out,
                                uint32_t struct_size);

/**
 * Writes the default of every field: the same bytes as `WK_METAR_INIT`. `struct_size` is `sizeof(wk_metar)`
 * as the caller was compiled, and is stored in the struct.
 */
WK_API wk_status wk_metar_init(wk_metar *out, uint32_t struct_size);

/*
 * ====================================================================================================
 * [context] Contexts
 *
 * A wk_context has the weather, the time and the place that all views of a simulator share. Its answers depend only on
 * its description (wk_context_desc), its changes of weather (the timeline), its other settings and its time. Two
 * contexts with the same input therefore give the same answers on every machine.
 *
 * There are three kinds of world. FLAT: the ground is a plane, and altitude is the up coordinate. TANGENT:
 * east-north-up at the origin's place, with the curved planet below. ECEF: Earth-centred, Earth-fixed (WGS 84)
 * coordinates, or those of another planet (wk_context_set_planet). Axes of flat and tangent worlds are x east, y
 * north, z up (Z_UP) or x east, y up, z south (Y_UP, the usual OpenGL world). Directions in answers are unit vectors
 * (east, north, up) at the queried place; azimuths are degrees clockwise from true north.
 *
 * Altitudes are above mean sea level everywhere in this header. In an ECEF world mean sea level lies geoid_height_m of
 * wk_context_desc above the ellipsoid; with the default of 0, heights above the ellipsoid serve as altitudes.
 * ====================================================================================================
 */

/** Weather, time and place. Child of a wk_device, parent of views. */
typedef struct wk_context wk_context;

/** Placement of the host's world on the planet. */
typedef uint32_t wk_world_kind;

/** A plane: up is the same everywhere. Altitude is the up coordinate plus the origin's altitude. */
#define WK_WORLD_FLAT 0
/** East-north-up at the origin's place, with the curved planet below. */
#define WK_WORLD_TANGENT 1
/**
 * Earth-centred, Earth-fixed (WGS 84). Axes and grid bearing have no effect. The origin (latitude_deg, longitude_deg
 * and altitude_m of wk_context_desc) is not the host's (0, 0, 0): it is the zero point of maps (of local cloud cover,
 * fog patches, waves and lightning), and the place whose sunlight dries a simulated ground (WK_GROUND_SIMULATED).
 * Altitudes are heights above the ellipsoid less geoid_height_m.
 */
#define WK_WORLD_ECEF 2

/** Directions of the host's axes in flat and tangent worlds. */
typedef uint32_t wk_axes;

/** x east, y north, z up. */
#define WK_AXES_Z_UP 0
/** x east, y up, z south. */
#define WK_AXES_Y_UP 1

/** Source of the exposure: one value for all channels of a simulator, never measured from a view. */
typedef uint32_t wk_exposure_mode;

/** Automatic, from the light that falls on level ground; exposure_value is a compensation in stops, [-20, 20]. */
#define WK_EXPOSURE_AUTO 0
/** Exposure value at ISO 100: exposure_value, [-20, 30], is 15 for a sunny day, -4 for a moonlit night. */
#define WK_EXPOSURE_EV100 1
/** Factor: exposure_value is display units per cd/m^2, (0, 1e6]. */
#define WK_EXPOSURE_FACTOR 2
/** The exposure of the context. For a wk_frame only; exposure_value is not used. */
#define WK_EXPOSURE_OF_CONTEXT 3

/** Curve from exposed luminance to display values. */
typedef uint32_t wk_tone_curve;

/** Identity, clamped to the display's range. */
#define WK_TONE_LINEAR 0
/** 1 - exp(-x) in each channel, with the exposed luminance x: bright skies never clip to white. */
#define WK_TONE_EXPONENTIAL 1
/**
 * Hable's filmic curve with his exposure bias of 2 and white at 11.2: an exposed luminance of 5.6 is shown as white.
 */
#define WK_TONE_FILMIC 2

/** Settings for a new context. */
typedef struct wk_context_desc {
    /** sizeof(wk_context_desc) of your header. */
    uint32_t struct_size;
    /** WK_STRUCT_TYPE_CONTEXT_DESC. */
    wk_struct_type struct_type;
    /** NULL (the default), or a chain of wk_sky_settings and wk_simulation_desc. */
    const void *next;
    /** Placement of the host's world on the planet. Default WK_WORLD_FLAT. */
    wk_world_kind world_kind;
    /** Directions of the host's axes. Default WK_AXES_Z_UP. */
    wk_axes axes;
    /**
     * Latitude of the host's (0, 0, 0), or of the origin of WK_WORLD_ECEF, degrees north. Range [-90, 90], default 50.
     */
    double latitude_deg;
    /**
     * Longitude of the host's (0, 0, 0), or of the origin of WK_WORLD_ECEF, degrees east. Range [-360, 360], default
     * 10.
     */
    double longitude_deg;
    /**
     * Altitude above mean sea level of the host's (0, 0, 0), or of the origin of WK_WORLD_ECEF, m. Range [-1e4, 1e9],
     * default 0.
     */
    double altitude_m;
    /** Bearing of the world's north axis, degrees clockwise from true north. Range [-360, 360], default 0. */
    double grid_bearing_deg;
    /** Seed of everything random. Default 0. */
    uint64_t seed;
    /** Text of a planet file (TOML, UTF-8; docs/planets.md), read during the call. Default NULL: the Earth. */
    const char *planet_toml;
    /**
     * Source of the exposure for frames that set none of their own. Default WK_EXPOSURE_AUTO; WK_EXPOSURE_OF_CONTEXT
     * is refused here.
     */
    wk_exposure_mode exposure_mode;
    /** Curve from exposed luminance to display values. Default WK_TONE_EXPONENTIAL. */
    wk_tone_curve tone_curve;
    /** Value of the exposure, as wk_exposure_mode says. Default 0. */
    double exposure_value;
    /**
     * Universal time at simulation time 0, seconds since 1970-01-01T00:00:00Z without leap seconds (Unix time).
     * Range: the years -2000 to 6000. Default 2026-06-21 10:00.
     */
    double utc_at_zero_s;
    /**
     * Path of a directory, UTF-8, for finished sky tables; Welkin creates it if needed. A later start with the same
     * planet, sky settings and weather reads the tables instead of building them. Welkin writes a file of 2 MB for the
     * tables of the first drawn weather, and one for each weather that wk_context_build_sky built. The newest 32 files
     * stay in the directory, whichever program wrote them. If a file is damaged or cannot be written, Welkin logs that
     * and builds the tables. Read during the call. Default NULL: no files.
     */
    const char *cache_dir;
    /**
     * Height of mean sea level above the WGS 84 ellipsoid where the simulation takes place (the geoid's undulation),
     * m: 47.8 at Frankfurt, -30 at New York. One number holds for the whole context; in nature the height varies by
     * some metres over 100 km. Only WK_WORLD_ECEF uses the number: the coordinates of that world refer to the
     * ellipsoid, but altitudes refer to mean sea level. Heights of fog and clouds are above the station, whose
     * altitude refers to mean sea level too. Range [-120, 120], default 0.
     */
    double geoid_height_m;
} wk_context_desc;

/** Every field of `wk_context_desc` at its default. */
#define WK_CONTEXT_DESC_INIT { \
    /* struct_size */ (uint32_t)sizeof(wk_context_desc), \
    /* struct_type */ WK_STRUCT_TYPE_CONTEXT_DESC, \
    /* next */ NULL, \
    /* world_kind */ WK_WORLD_FLAT, \
    /* axes */ WK_AXES_Z_UP, \
    /* latitude_deg */ 50.0, \
    /* longitude_deg */ 10.0, \
    /* altitude_m */ 0.0, \
    /* grid_bearing_deg */ 0.0, \
    /* seed */ UINT64_C(0), \
    /* planet_toml */ NULL, \
    /* exposure_mode */ WK_EXPOSURE_AUTO, \
    /* tone_curve */ WK_TONE_EXPONENTIAL, \
    /* exposure_value */ 0.0, \
    /* utc_at_zero_s */ 1782036000.0, \
    /* cache_dir */ NULL, \
    /* geoid_height_m */ 0.0 \
}

/**
 * Receives the completed share of a long operation, from 0 to 1, never less than before. Return 0 to go on; anything
 * else ends the operation with WK_ERROR_ABORTED. The function must not call Welkin and must not unwind. It may draw by
 * the host's own means, even with the OpenGL context that Welkin uses.
 */
typedef int32_t (*wk_progress_fn)(void *user, double share);

/**
 * Creates a context on a device. `desc` NULL means WK_CONTEXT_DESC_INIT. On success `*out_context` is a new handle for
 * `wk_context_destroy`. The weather is a clear standard day (WK_WEATHER_INIT) until you set another.
 * Thread: exclusive on the device.
 * Errors: WK_ERROR_PARSE for the planet file, with line and column; WK_ERROR_INVALID_ARGUMENT naming the field.
 */
WK_API
wk_status wk_context_create(wk_device *device,
                            const wk_context_desc *desc,
                            wk_context **out_context);

/**
 * Replaces the planet: its air, ground and sun. `planet_toml` is a planet file's text (TOML, UTF-8), read during the
 * call; NULL means the Earth. Tangent and ECEF worlds lie on WGS 84 if the planet's radius is between the Earth's
 * polar and equatorial radius, otherwise on a sphere of that radius. Set a planet of another radius before terrain,
 * simulated ground and regions of the sea: they keep the directions of the planet on which they were set. Light and
 * queries use the new planet at once, without blending. The sky's tables follow as after a change of weather: a draft
 * fades in over sixteen frames, and later frames refine it. If the radius, the top of the air or the wavelengths
 * differ, the next frame shows a draft of the new planet at once (docs/planets.md).
 * Thread: exclusive.
 * Errors: WK_ERROR_PARSE for the text, with line and column; WK_ERROR_INVALID_ARGUMENT naming the field. After an
 * error the planet stays as it was.
 */
WK_API wk_status wk_context_set_planet(wk_context *context, const char *planet_toml);

/**
 * Sets the curve from luminance to display values for the next frames, in place of tone_curve of wk_context_desc.
 * Thread: exclusive.
 * Errors: WK_ERROR_INVALID_ARGUMENT for an unknown curve.
 */
WK_API wk_status wk_context_set_tone_curve(wk_context *context, wk_tone_curve curve);

/**
 * Builds the sky's tables completely for the context's planet and present weather, so that no frame has to build them.
 * Call this function at load time, behind a progress bar. The call reuses tables that another context of the device
 * already shows or that lie in the context's cache_dir, and writes new tables to cache_dir. Without this call the
 * first frame shows a draft of the sky, which differs from the finished sky by at most 3 of 255 display steps, and 120
 * frames refine it without a visible step; a frame with WK_FRAME_NO_HISTORY then builds all tables itself
 * (docs/first-frames.md). `progress` may be NULL; else it is called about sixteen times, the last time with 1. An
 * aborted build leaves the context as it was and writes no file.
 * Thread: exclusive on the context; with an OpenGL host, the thread where its OpenGL context is (or can be made)
 * current. While `progress` runs, the host may use that OpenGL context.
 * Errors: WK_ERROR_ABORTED; WK_ERROR_DEVICE_LOST.
 */
WK_API
wk_status wk_context_build_sky(wk_context *context,
                               wk_progress_fn progress,
                               void *user);

/**
 * Destroys a context. NULL does nothing.
 * Thread: any. Where the host's OpenGL context is not (and cannot be made) current, GPU objects are released at a
 * later call on the device.
 * Errors: WK_ERROR_IN_USE while it has views.
 */
WK_API wk_status wk_context_destroy(wk_context *context);

/**
 * Writes the default of every field: the same bytes as `WK_CONTEXT_DESC_INIT`. `struct_size` is `sizeof(wk_context_desc)`
 * as the caller was compiled, and is stored in the struct.
 */
WK_API
wk_status wk_context_desc_init(wk_context_desc *out,
                               uint32_t struct_size);

/*
 * ====================================================================================================
 * [sky] How the sky is drawn
 *
 * There are four models of the sky. They share the functions by which a pixel looks up the tables, and differ in the
 * tables. Use the default model: 95 % of its pixels are within 2.4 % of converged multiple scattering in clear air and
 * haze. The other models are for comparison and for slow machines. Put a wk_sky_settings into wk_context_desc.next, or
 * pass it to wk_context_set_sky_settings later.
 * ====================================================================================================
 */

/** Model of the sky. */
typedef uint32_t wk_sky_model;

/** Multiple scattering keeps its dependence on direction, order by order. The default. */
#define WK_SKY_DIRECTIONAL 0
/**
 * Multiple scattering is the same in all directions (Hillaire 2020); less accurate and quicker to build. docs/lab
 * charts both.
 */
#define WK_SKY_ISOTROPIC 1
/**
 * Single scattering alone, from a table over altitude, view angle and sun angle (Elek 2008), as in older systems;
 * multiple scattering is missing.
 */
#define WK_SKY_TABLE_3D 2
/** As the default, but single scattering is ray-marched in every pixel: a reference for the tables. */
#define WK_SKY_BRUTE_FORCE 3

/**
 * Model of the sky and sizes of its tables. An extension: put it into wk_context_desc.next. Or set it later by
 * wk_context_set_sky_settings, with `next` NULL.
 */
typedef struct wk_sky_settings {
    /** sizeof(wk_sky_settings) of your header. */
    uint32_t struct_size;
    /** WK_STRUCT_TYPE_SKY_SETTINGS. */
    wk_struct_type struct_type;
    /** The next extension. Default NULL. */
    const void *next;
    /** Model of the sky. Default WK_SKY_DIRECTIONAL. */
    wk_sky_model model;
    /**
     * Orders of scattering that are computed one by one; a geometric series replaces the higher ones. Range [3, 16],
     * default 5.
     */
    uint32_t orders;
    /** Number of sun angles in the planet's tables. Range [16, 128], default 64. */
    uint32_t suns;
    /** Number of altitudes in the planet's tables. Range [8, 64], default 22. */
    uint32_t altitudes;
    /** Number of azimuths over [0, pi] in an observer's sky table. Range [8, 256], default 40. */
    uint32_t sky_azimuths;
    /** Rows above the horizon in an observer's sky table. Range [8, 256], default 80. */
    uint32_t sky_above;
    /** Rows below the horizon in an observer's sky table. Range [8, 256], default 40. */
    uint32_t sky_below;
    /** Number of distances in the table of the air in front of objects. Range [4, 64], default 16. */
    uint32_t air_slices;
    /**
     * Steps of the ray march in each pixel (WK_SKY_BRUTE_FORCE), rounded up to a multiple of 4. Range [1, 4096],
     * default 64.
     */
    uint32_t march_cells;
    /**
     * Number of wavelengths that the sky is computed for, a multiple of 3. Range [3, 15]; 3 (the default) and 0 mean
     * the planet's own three. More wavelengths give truer colours at a low sun: the error of the worst channel,
     * relative to the luminance, is 6 % with 3 wavelengths and 2.4 % with 9; with 15 it is within 1 % of the result
     * with 40. The time to build tables grows in proportion, both for a change of air and for a moving sun: with 15
     * wavelengths it is five times as long. The cost of a pixel stays the same. WK_SKY_DIRECTIONAL and
     * WK_SKY_ISOTROPIC only.
     */
    uint32_t wavelengths;
} wk_sky_settings;

/** Every field of `wk_sky_settings` at its default. */
#define WK_SKY_SETTINGS_INIT { \
    /* struct_size */ (uint32_t)sizeof(wk_sky_settings), \
    /* struct_type */ WK_STRUCT_TYPE_SKY_SETTINGS, \
    /* next */ NULL, \
    /* model */ WK_SKY_DIRECTIONAL, \
    /* orders */ 5, \
    /* suns */ 64, \
    /* altitudes */ 22, \
    /* sky_azimuths */ 40, \
    /* sky_above */ 80, \
    /* sky_below */ 40, \
    /* air_slices */ 16, \
    /* march_cells */ 64, \
    /* wavelengths */ 3 \
}

/**
 * Changes how the sky is drawn, as a wk_sky_settings in wk_context_desc.next does for a new context. `settings` NULL
 * means WK_SKY_SETTINGS_INIT. Views use the new tables from their next frame on. That frame shows a draft of the sky,
 * as a first frame does, unless wk_context_build_sky has prepared the final picture after this call. Pipelines of
 * another model are compiled in that frame. Setting the same values again changes nothing.
 * Thread: exclusive.
 * Errors: WK_ERROR_INVALID_ARGUMENT naming the field; WK_ERROR_DEVICE_LOST. After an error the settings stay as they
 * were.
 */
WK_API wk_status wk_context_set_sky_settings(wk_context *context, const wk_sky_settings *settings);

/**
 * Writes the default of every field: the same bytes as `WK_SKY_SETTINGS_INIT`. `struct_size` is `sizeof(wk_sky_settings)`
 * as the caller was compiled, and is stored in the struct.
 */
WK_API
wk_status wk_sky_settings_init(wk_sky_settings *out,
                               uint32_t struct_size);

/*
 * ====================================================================================================
 * [timeline] Weather over time
 *
 * The host owns simulation time: seconds in double precision, advanced by wk_context_update. Weather is a timeline of
 * changes, each with an absolute start and a duration; between changes it is constant. A change that begins during
 * another one is superimposed on it, so neither the weather nor its rate of change jumps. The same calls in the same
 * order give the same weather on every machine.
 *
 * The positions of sun and moon follow from place and universal time, which is tied to simulation time, unless the
 * host sets them.
 * ====================================================================================================
 */

/** Direction to the sun or moon that the host sets in place of the almanac's. */
typedef struct wk_given_direction {
    /** sizeof(wk_given_direction) of your header. */
    uint32_t struct_size;
    /** WK_STRUCT_TYPE_GIVEN_DIRECTION. */
    wk_struct_type struct_type;
    /** No extensions in this version: NULL. */
    const void *next;
    /** Azimuth, degrees clockwise from true north. Range [-360, 360], default 180. */
    double azimuth_deg;
    /** Elevation above the horizon, degrees, without refraction. Range [-90, 90], default 45. */
    double elevation_deg;
} wk_given_direction;

/** Every field of `wk_given_direction` at its default. */
#define WK_GIVEN_DIRECTION_INIT { \
    /* struct_size */ (uint32_t)sizeof(wk_given_direction), \
    /* struct_type */ WK_STRUCT_TYPE_GIVEN_DIRECTION, \
    /* next */ NULL, \
    /* azimuth_deg */ 180.0, \
    /* elevation_deg */ 45.0 \
}

/**
 * Changes the weather, beginning at `start_time_s` ([-1e10, 1e10] s) and lasting `transition_s` ([0, 3.2e7] s; 0
 * changes at once). `weather` may have a wk_weather_overrides in its chain. Copied during the call.
 * Thread: exclusive.
 * Errors: WK_ERROR_INVALID_ARGUMENT naming the field; WK_ERROR_WRONG_ORDER if the change begins before the last update
 * or before the start of a change that was given earlier. After an error the weather stays as it was.
 */
WK_API
wk_status wk_context_set_weather(wk_context *context,
                                 const wk_weather *weather,
                                 double start_time_s,
                                 double transition_s);

/**
 * Advances simulation time to `time_s`, [-1e10, 1e10]; the same time again changes nothing. Call it once a frame
 * before the views record. Weather and light are functions of time and change at once. Simulated states take steps:
 * water (WK_GROUND_SIMULATED) every 10 s, snow (WK_LYING_SNOW_SIMULATED) every 60 s, soil every 1/64 s; a wind field
 * has steps of its own. One call computes steps for at most 50 ms, and at least one step. If steps remain, as after a
 * leap of hours, the call returns WK_PENDING: call it again with the same time, in a loop or once a frame, until it
 * returns WK_OK. Until then, simulated states are drawn and queried as of wk_context_get_state_time, and settings and
 * later times take effect only after the remaining steps. The state therefore does not depend on the number of calls.
 * After a leap of more than a day, the water is simulated for the last day only. The ground starts that day as wet as
 * the weather of that time reports. Snow then takes steps of ten minutes, for the last 30 days at most.
 * Thread: exclusive.
 * Returns WK_PENDING, which is no error, while steps remain.
 * Errors: WK_ERROR_INVALID_ARGUMENT for a time out of range; WK_ERROR_WRONG_ORDER if `time_s` is before the present.
 */
WK_API wk_status wk_context_update(wk_context *context, double time_s);

/**
 * Gets the simulation time of the state, s: the time of the last wk_context_update, or an earlier one while
 * wk_context_update returns WK_PENDING. The difference from the time of the last wk_context_update is the lag of the
 * state. The state's time never decreases, except by wk_context_load.
 * Thread: concurrent.
 */
WK_API wk_status wk_context_get_state_time(const wk_context *context, double *out_state_time_s);

/**
 * Ties universal time to simulation time: universal time is `utc_s` (Unix time, seconds without leap seconds) at
 * simulation time `time_s`. Before the first call, universal time is wk_context_desc.utc_at_zero_s at simulation
 * time 0.
 * Thread: exclusive.
 */
WK_API wk_status wk_context_set_clock(wk_context *context, double utc_s, double time_s);

/**
 * Gets the Unix time of a calendar date (proleptic Gregorian) and a time of day in UTC. `year` lies in [-2000, 6000].
 * `second` lies in [0, 60), or in [0, 61) in the last minute of a day: the leap second 23:59:60 is the first second of
 * the next day, as in Unix time.
 * Thread: any.
 */
WK_API
wk_status wk_utc_from_calendar(int32_t year,
                               uint32_t month,
                               uint32_t day,
                               uint32_t hour,
                               uint32_t minute,
                               double second,
                               double *out_utc_s);

/**
 * Sets the direction of the sun; NULL returns to the almanac.
 * Thread: exclusive.
 */
WK_API wk_status wk_context_set_sun(wk_context *context, const wk_given_direction *direction);

/**
 * Sets the direction of the moon (its phase follows from the sun's direction); NULL returns to the almanac.
 * Thread: exclusive.
 */
WK_API wk_status wk_context_set_moon(wk_context *context, const wk_given_direction *direction);

/**
 * Sets the exposure of frames that do not set their own. `value` has the meaning and range that wk_exposure_mode
 * states for `mode`; WK_EXPOSURE_OF_CONTEXT is refused here.
 * Thread: exclusive.
 * Errors: WK_ERROR_INVALID_ARGUMENT naming the parameter and its range.
 */
WK_API wk_status wk_context_set_exposure(wk_context *context, wk_exposure_mode mode, double value);

/**
 * Writes everything that decides what the context shows from now on, as UTF-8 text, the same on every machine:
 * weather, weather regions, time, clock, directions of sun and moon that the host set, planet, exposure, tone curve,
 * fog law, cloud map and model, lightning, night sky, shelters, lamps, rain areas, wind grid and wind field, the
 * terrain with its water, snow and soil, the default surface class, the sea with its regions and hulls, and the world,
 * place, seed and models of ground and snow that the state belongs to. For the tiles of a wk_terrain the text has the
 * water, snow and soil, not the host's heights. Not included: how the state is drawn (sky settings, views, plans,
 * wk_terrain_drawing), the host's own list of stars, and the images of wk_context_set_occluder_maps, because each
 * channel may have its own.
 * `*out_size` always gets the number of bytes needed. If `capacity` is too small, nothing else is written and the call
 * fails; with `buffer` NULL and `capacity` 0 it succeeds.
 * Thread: concurrent.
 * Errors: WK_ERROR_WRONG_ORDER while wk_context_update returns WK_PENDING.
 */
WK_API
wk_status wk_context_save(const wk_context *context,
                          void *buffer,
                          size_t capacity,
                          size_t *out_size);

/**
 * Loads a state that wk_context_save wrote and replaces the context's own. The context must have been created with the
 * same world_kind, latitude_deg, longitude_deg, altitude_m, axes and grid_bearing_deg (for WK_WORLD_ECEF
 * geoid_height_m in place of the last two), seed, ground_model and lying_snow_model. If a state of an earlier version
 * lacks the planet and the tone curve, the context must also have the planet and the tone curve with which that state
 * was saved. Occluder maps stay as they are. Tiles of a wk_terrain stay too: before the call, set them as they were
 * when the state was saved.
 * Thread: exclusive.
 * Errors: WK_ERROR_PARSE for bytes that are no saved state, for a truncated or changed state, and for a state of
 * another format, which the message names (this version reads format 2; save states of format 1 again, because they
 * did not record their place); WK_ERROR_INVALID_ARGUMENT naming all settings that differ. After an error the context
 * stays as it was.
 */
WK_API
wk_status wk_context_load(wk_context *context,
                          const void *state,
                          size_t size);

/**
 * Gets a hash of the state that wk_context_save writes. It is equal on two channels whose contexts show the same world
 * from now on.
 * Thread: concurrent.
 * Errors: WK_ERROR_WRONG_ORDER while wk_context_update returns WK_PENDING.
 */
WK_API
wk_status wk_context_state_hash(const wk_context *context,
                                uint64_t *out_hash);

/**
 * Writes the default of every field: the same bytes as `WK_GIVEN_DIRECTION_INIT`. `struct_size` is `sizeof(wk_given_direction)`
 * as the caller was compiled, and is stored in the struct.
 */
WK_API
wk_status wk_given_direction_init(wk_given_direction *out,
                                  uint32_t struct_size);

/*
 * ====================================================================================================
 * [fog_law] Fog laws of older simulators
 *
 * Normally fog follows from the weather and is lit by sun and sky. For pictures that must look as in an older
 * simulator, Welkin can draw the older laws instead: linear, exponential or exponential squared, by range or by plane
 * distance.
 * ====================================================================================================
 */

/**
 * Curve of the fog: V is the share of an object's colour that is left at distance d. V = 1 is clear, V = 0 is all fog.
 */
typedef uint32_t wk_fog_curve;

/** No fog at all, whatever the weather. */
#define WK_FOG_CURVE_CLEAR 0
/** V = (end - d) / (end - start), clamped. */
#define WK_FOG_CURVE_LINEAR 1
/** V = exp(-density d). */
#define WK_FOG_CURVE_EXPONENTIAL 2
/** V = exp(-(density d)^2). */
#define WK_FOG_CURVE_EXPONENTIAL_SQUARED 3

/** Measure of distance. */
typedef uint32_t wk_fog_distance;

/** Distance from the camera's centre: turning the camera changes nothing. */
#define WK_FOG_DISTANCE_RANGE 0
/** Distance from the plane through the camera at right angles to its viewing direction, as in the oldest systems. */
#define WK_FOG_DISTANCE_PLANE 1

/** Flags that name the optional fields of a wk_fog_law that the host has set. */
typedef uint32_t wk_fog_law_has_flags;

/** color */
#define WK_FOG_LAW_HAS_COLOR 1

/** A fog law in place of the weather's fog. */
typedef struct wk_fog_law {
    /** sizeof(wk_fog_law) of your header. */
    uint32_t struct_size;
    /** WK_STRUCT_TYPE_FOG_LAW. */
    wk_struct_type struct_type;
    /** No extensions in this version: NULL. */
    const void *next;
    /** Curve of the fog. Default WK_FOG_CURVE_CLEAR. */
    wk_fog_curve curve;
    /** Measure of distance. Default WK_FOG_DISTANCE_RANGE. */
    wk_fog_distance distance;
    /** WK_FOG_LAW_HAS_* flags: the optional fields that the host has set. Default 0. */
    wk_fog_law_has_flags has;
    /** Must be 0. */
    uint32_t reserved0;
    /** Distance where linear fog begins, m. Range [0, 1e9], default 0. */
    double start_m;
    /** Distance where linear fog is complete, m. Above start_m, at most 1e9; default 1000. */
    double end_m;
    /** Density of exponential and exponential squared fog, 1/m. Range [0, 10], default 0.003. */
    double density_per_m;
    /**
     * Optional: radiance into which the picture fades, cd/m^2 per channel. Range [0, 1e12]. Without it Welkin uses the
     * radiance of deep fog under the present light.
     */
    double color[3];
    /**
     * Elevation above the horizon up to which sky pixels fade, rad. The fade is full at the horizon and ends at this
     * elevation. Range [0, pi], default 0.2. 0 leaves the sky as it is, pi covers all of it.
     */
    double sky_band;
} wk_fog_law;

/** Every field of `wk_fog_law` at its default. */
#define WK_FOG_LAW_INIT { \
    /* struct_size */ (uint32_t)sizeof(wk_fog_law), \
    /* struct_type */ WK_STRUCT_TYPE_FOG_LAW, \
    /* next */ NULL, \
    /* curve */ WK_FOG_CURVE_CLEAR, \
    /* distance */ WK_FOG_DISTANCE_RANGE, \
    /* has */ 0, \
    /* reserved0 */ 0, \
    /* start_m */ 0.0, \
    /* end_m */ 1000.0, \
    /* density_per_m */ 0.003, \
    /* color */ { 0.0, 0.0, 0.0 }, \
    /* sky_band */ 0.2 \
}

/**
 * Draws a fog law in place of the weather's fog; NULL returns to the weather's fog.
 * Thread: exclusive.
 * Errors: WK_ERROR_INVALID_ARGUMENT naming the field and its range.
 */
WK_API wk_status wk_context_set_fog_law(wk_context *context, const wk_fog_law *fog_law);

/**
 * Gets the distance beyond which a fog law leaves less than 1/255 of an object's colour, m: you need not draw anything
 * farther away. The distance is measured as the law says (wk_fog_distance). It is infinite if the law always leaves
 * more.
 * Thread: any.
 * Errors: WK_ERROR_INVALID_ARGUMENT naming the field and its range.
 */
WK_API
wk_status wk_fog_law_cull_distance(const wk_fog_law *fog_law,
                                   double *out_distance_m);

/**
 * Gets the distance beyond which air of a given visibility leaves less than 1/255 of an object's contrast, m: about
 * 1.85 times the visibility. visibility_m is the meteorological optical range, m, [1, 1e6].
 * Thread: any.
 * Errors: WK_ERROR_INVALID_ARGUMENT naming the parameter and its range.
 */
WK_API wk_status wk_visibility_cull_distance(double visibility_m, double *out_distance_m);

/**
 * Writes the default of every field: the same bytes as `WK_FOG_LAW_INIT`. `struct_size` is `sizeof(wk_fog_law)`
 * as the caller was compiled, and is stored in the struct.
 */
WK_API wk_status wk_fog_law_init(wk_fog_law *out, uint32_t struct_size);

/*
 * ====================================================================================================
 * [conditions] Queries: conditions
 *
 * The weather as physical quantities, at any place, at any future time, and at any past time whose weather the
 * timeline (see Weather over time) still knows. The answers are in closed form and need no device. Heights are above
 * the station unless stated otherwise. Every number is continuous in time while the weather changes, even the heights
 * of a layer that appears or dissolves.
 *
 * Here and in every other function a position must lie within 1e12 m of the world's origin and at an altitude in
 * [-1e4, 1e9] m above mean sea level (in WK_WORLD_ECEF: above the ellipsoid, less geoid_height_m of wk_context_desc).
 * Other positions are refused.
 * ====================================================================================================
 */

/** The weather as physical quantities, each continuous in time. */
typedef struct wk_conditions {
    /** sizeof(wk_conditions) of your header. */
    uint32_t struct_size;
    /** WK_STRUCT_TYPE_CONDITIONS. */
    wk_struct_type struct_type;
    /** No extensions in this version: NULL. */
    const void *next;
    /**
     * Total extinction at 550 nm, 1/m: air, particles and fog at station height, and precipitation at the position.
     * Shallow or patchy fog, which a reported visibility leaves out, is not included.
     */
    double extinction_per_m;
    /** Meteorological optical range for extinction_per_m, m; at most 1e9, the value without any air. */
    double visibility_m;
    /** Air temperature at 2 m, degrees Celsius. */
    double temperature_c;
    /** Relative humidity, a fraction. */
    double relative_humidity;
    /** Pressure reduced to sea level, hPa. */
    double pressure_hpa;
    /** Pressure at the station, hPa. */
    double station_pressure_hpa;
    /** Station above mean sea level, m. */
    double station_altitude_m;
    /** Air density at sea level, divided by that at 15 C and 1013.25 hPa. */
    double rayleigh_density_ratio;
    /** Scale height of the air, m: the rise in height over which the air's density falls to 1/e. */
    double rayleigh_scale_height_m;
    /** Extinction by air, at 550 nm and station height, 1/m. */
    double rayleigh_extinction_per_m;
    /** Extinction by particles, at 550 nm and station height, 1/m. */
    double aerosol_extinction_per_m;
    /** Exponent of the particles' extinction, which is proportional to (wavelength / 550 nm)^-exponent. */
    double aerosol_angstrom_exponent;
    /** Single-scattering albedo of the particles at 550 nm. */
    double aerosol_single_scattering_albedo;
    /** Mean cosine of the particles' phase function. */
    double aerosol_asymmetry;
    /** Scale height of the particles, m: the rise in height over which their density falls to 1/e. */
    double aerosol_scale_height_m;
    /** Extinction inside the layer at the ground (fog, mist, lifted matter), at 550 nm, 1/m; 0 if there is none. */
    double fog_extinction_per_m;
    /** Base of the layer at the ground, m above the station. */
    double fog_base_m;
    /** Top of the layer at the ground, m above the station. */
    double fog_top_m;
    /** Depth of the layer's soft upper edge, m. */
    double fog_softness_m;
    /** Fraction of the ground that the layer covers. */
    double fog_coverage;
    /**
     * Fraction of the sky that all layers together hide. While the weather changes, it stays between the values before
     * and after.
     */
    double cloud_cover;
    /** Rain, mm/h. */
    double rain_mm_h;
    /** Drizzle, mm/h. */
    double drizzle_mm_h;
    /** Snow, snow grains and ice crystals together, mm/h of melted water. */
    double snow_mm_h;
    /** Ice pellets and small hail, mm/h of melted water. */
    double ice_pellets_mm_h;
    /** Hail, mm/h of melted water. */
    double hail_mm_h;
    /** Fraction of rain and drizzle that freezes where it lands. */
    double freezing;
    /** Degree to which the precipitation is convective: 0 steady, 1 showers. */
    double showers;
    /** Presence of thunder, 0 to 1. */
    double thunder;
    /** Extinction by all precipitation, at 550 nm, 1/m. */
    double precipitation_extinction_per_m;
    /** Velocity at 10 m towards the east, m/s. */
    double wind_east_m_s;
    /** Velocity at 10 m towards the north, m/s. */
    double wind_north_m_s;
    /** Highest 3-second gust at 10 m, m/s. */
    double wind_gust_m_s;
    /** Standard deviation of the wind's speed divided by the mean speed, at 10 m. */
    double wind_turbulence_intensity;
    /** Half the range over which the wind's direction wanders, degrees: 0 steady, 180 all round. */
    double wind_wander_deg;
    /** Roughness length of the land, m. */
    double roughness_length_m;
    /** Roughness length of the sea, m. */
    double sea_roughness_length_m;
    /** Significant wave height of the wind sea, m. */
    double significant_wave_height_m;
    /** Height of the swell, m; 0 without swell. */
    double swell_height_m;
    /** Peak period of the swell, s. */
    double swell_period_s;
    /** Direction in which the swell travels: east component of the unit vector. */
    double swell_east;
    /** Direction in which the swell travels: north component of the unit vector. */
    double swell_north;
    /** Sea temperature, degrees Celsius. */
    double sea_temperature_c;
    /** Wetness of the ground: 0 dry, 0.3 damp, 1 under a closed film. */
    double wetness;
    /** Fraction of the ground under standing water. */
    double puddles;
    /** Fraction of the ground under ice or frost. */
    double ice;
    /** Depth of lying snow, m. */
    double snow_depth_m;
    /** Ozone column, Dobson units. */
    double ozone_du;
    /** Flakes alone, which snow_mm_h includes, mm/h of melted water; 0 where none fall. */
    double snow_flakes_mm_h;
    /** Snow grains alone, which snow_mm_h includes, mm/h of melted water; 0 where none fall. */
    double snow_grains_mm_h;
    /** Ice crystals alone, which snow_mm_h includes, mm/h of melted water; 0 where none fall. */
    double ice_crystals_mm_h;
} wk_conditions;

/** Every field of `wk_conditions` at its default. */
#define WK_CONDITIONS_INIT { \
    /* struct_size */ (uint32_t)sizeof(wk_conditions), \
    /* struct_type */ WK_STRUCT_TYPE_CONDITIONS, \
    /* next */ NULL, \
    /* extinction_per_m */ 0.0, \
    /* visibility_m */ 0.0, \
    /* temperature_c */ 0.0, \
    /* relative_humidity */ 0.0, \
    /* pressure_hpa */ 0.0, \
    /* station_pressure_hpa */ 0.0, \
    /* station_altitude_m */ 0.0, \
    /* rayleigh_density_ratio */ 0.0, \
    /* rayleigh_scale_height_m */ 0.0, \
    /* rayleigh_extinction_per_m */ 0.0, \
    /* aerosol_extinction_per_m */ 0.0, \
    /* aerosol_angstrom_exponent */ 0.0, \
    /* aerosol_single_scattering_albedo */ 0.0, \
    /* aerosol_asymmetry */ 0.0, \
    /* aerosol_scale_height_m */ 0.0, \
    /* fog_extinction_per_m */ 0.0, \
    /* fog_base_m */ 0.0, \
    /* fog_top_m */ 0.0, \
    /* fog_softness_m */ 0.0, \
    /* fog_coverage */ 0.0, \
    /* cloud_cover */ 0.0, \
    /* rain_mm_h */ 0.0, \
    /* drizzle_mm_h */ 0.0, \
    /* snow_mm_h */ 0.0, \
    /* ice_pellets_mm_h */ 0.0, \
    /* hail_mm_h */ 0.0, \
    /* freezing */ 0.0, \
    /* showers */ 0.0, \
    /* thunder */ 0.0, \
    /* precipitation_extinction_per_m */ 0.0, \
    /* wind_east_m_s */ 0.0, \
    /* wind_north_m_s */ 0.0, \
    /* wind_gust_m_s */ 0.0, \
    /* wind_turbulence_intensity */ 0.0, \
    /* wind_wander_deg */ 0.0, \
    /* roughness_length_m */ 0.0, \
    /* sea_roughness_length_m */ 0.0, \
    /* significant_wave_height_m */ 0.0, \
    /* swell_height_m */ 0.0, \
    /* swell_period_s */ 0.0, \
    /* swell_east */ 0.0, \
    /* swell_north */ 0.0, \
    /* sea_temperature_c */ 0.0, \
    /* wetness */ 0.0, \
    /* puddles */ 0.0, \
    /* ice */ 0.0, \
    /* snow_depth_m */ 0.0, \
    /* ozone_du */ 0.0, \
    /* snow_flakes_mm_h */ 0.0, \
    /* snow_grains_mm_h */ 0.0, \
    /* ice_crystals_mm_h */ 0.0 \
}

/** Horizontally uniform layer of cloud. Element of an array, without struct_size; calls take its sizeof instead. */
typedef struct wk_cloud_slab {
    /** Fraction of the sky covered. */
    double cover;
    /** Base above the station, m. */
    double base_m;
    /** Thickness, m. */
    double thickness_m;
    /** Optical depth straight up, where there is cloud. */
    double optical_depth;
    /** Effective radius of droplets or crystals, um. */
    double droplet_radius_um;
    /** Mean cosine of the phase function. */
    double asymmetry;
    /** Shape: 0 a sheet, 0.5 fair-weather heaps, 1 cumulonimbus. */
    double convection;
    /** Fraction of the water that is ice. */
    double ice_fraction;
} wk_cloud_slab;

/**
 * Gets the conditions at a position and a past or future simulation time, with the weather regions there
 * (wk_context_set_weather_regions). Precipitation is that at the position itself: it includes the rain areas there
 * (wk_context_set_rain_areas), weighted by their rims, and is zero above the cloud that it falls from. rain_mm_h and
 * drizzle_mm_h add up to rate_mm_h of wk_context_get_rainfall_at. precipitation_extinction_per_m, extinction_per_m and
 * visibility_m include that precipitation. All other fields are for the station's height unless their descriptions say
 * otherwise.
 * Thread: concurrent.
 * Errors: WK_ERROR_INVALID_ARGUMENT for an invalid position, and for a time that the timeline has forgotten. The last
 * wk_context_update forgot all times before the end of the latest change of weather that was over by then.
 */
WK_API
wk_status wk_context_get_conditions(const wk_context *context,
                                    const double (*position_m)[3],
                                    double time_s,
                                    wk_conditions *out_conditions);

/**
 * Gets the cloud layers at a position and time, low ones first; position and time are as in wk_context_get_conditions.
 * The map of wk_context_set_cloud_map has no effect on the answer. `*out_count` gets the number of layers, at most 16.
 * With capacity 0 nothing else is written, and the call succeeds. If `capacity` is too small, the call writes only the
 * number and fails. `slab_size` is sizeof(wk_cloud_slab) of your header.
 * Thread: concurrent.
 * Errors: as wk_context_get_conditions; WK_ERROR_INVALID_ARGUMENT for a capacity other than 0 that is too small.
 */
WK_API
wk_status wk_context_get_cloud_slabs(const wk_context *context,
                                     const double (*position_m)[3],
                                     double time_s,
                                     wk_cloud_slab *slabs,
                                     uint32_t capacity,
                                     uint32_t slab_size,
                                     uint32_t *out_count);

/**
 * Writes the default of every field: the same bytes as `WK_CONDITIONS_INIT`. `struct_size` is `sizeof(wk_conditions)`
 * as the caller was compiled, and is stored in the struct.
 */
WK_API wk_status wk_conditions_init(wk_conditions *out, uint32_t struct_size);

/*
 * ====================================================================================================
 * [query] Queries: light and visibility
 *
 * These functions answer for any place of the host's world. Functions that end in _at take a past or future simulation
 * time that the timeline of the weather still knows (see wk_context_get_conditions); the others answer for the
 * present. The answers are in closed form and need no work of the GPU, except those of wk_context_get_ambient and
 * wk_context_get_ambient_at, which read the sky's tables. If the host has set the direction of the sun or the moon,
 * that direction holds at all times. Directions are unit vectors (east, north, up) at the queried place. Light is in
 * lux and cd/m^2, in three channels of linear Rec. 709. The sum of the channels with the weights 0.2126, 0.7152 and
 * 0.0722 is the photometric value.
 *
 * Lists are (pointer, count, size of an element in your header). Welkin checks everything before it writes anything.
 * ====================================================================================================
 */

/** The sun or the moon over a place. */
typedef struct wk_celestial {
    /** sizeof(wk_celestial) of your header. */
    uint32_t struct_size;
    /** WK_STRUCT_TYPE_CELESTIAL. */
    wk_struct_type struct_type;
    /** No extensions in this version: NULL. */
    const void *next;
    /** Direction to the body, without refraction, as scattering uses it. */
    double direction[3];
    /** Direction to the body as it appears, lifted by refraction. */
    double apparent[3];
    /**
     * For the moon: direction in the plane of the disc towards the middle of the lit limb. For the sun: (0, 0, 1).
     */
    double bright_limb[3];
    /** Illuminance that a surface facing the body would receive above the air, lux per channel. */
    double illuminance_lux[3];
    /** Azimuth, degrees clockwise from true north, [0, 360). */
    double azimuth_deg;
    /** Elevation above the horizon, degrees, without refraction. */
    double elevation_deg;
    /** Elevation above the horizon as it appears, degrees. */
    double apparent_elevation_deg;
    /** Angular radius of the disc, rad. */
    double angular_radius;
    /** Lit fraction of the disc. */
    double lit;
    /** Ratio of the disc's vertical to its horizontal diameter. */
    double flattening;
    /**
     * Share of the body's direct light that passes the clouds above the place, averaged over all places at the same
     * height.
     */
    double direct_share;
} wk_celestial;

/** Every field of `wk_celestial` at its default. */
#define WK_CELESTIAL_INIT { \
    /* struct_size */ (uint32_t)sizeof(wk_celestial), \
    /* struct_type */ WK_STRUCT_TYPE_CELESTIAL, \
    /* next */ NULL, \
    /* direction */ { 0.0, 0.0, 0.0 }, \
    /* apparent */ { 0.0, 0.0, 0.0 }, \
    /* bright_limb */ { 0.0, 0.0, 0.0 }, \
    /* illuminance_lux */ { 0.0, 0.0, 0.0 }, \
    /* azimuth_deg */ 0.0, \
    /* elevation_deg */ 0.0, \
    /* apparent_elevation_deg */ 0.0, \
    /* angular_radius */ 0.0, \
    /* lit */ 0.0, \
    /* flattening */ 0.0, \
    /* direct_share */ 0.0 \
}

/**
 * Light that arrives at a place, after air, clouds and fog. Light that fog has scattered almost straight on is
 * included in the direct light of the sun or the moon. Element of an array, without struct_size; calls take its sizeof
 * instead.
 */
typedef struct wk_ground_light {
    /** Direct sunlight on a surface facing the sun, lux per channel. */
    double sun_lux[3];
    /** Direct moonlight on a surface facing the moon, lux per channel. */
    double moon_lux[3];
    /** Light of sky, clouds and fog on level ground, lux per channel. */
    double sky_lux[3];
    /** All light on level ground, luminance-weighted, lux. */
    double total_lux;
} wk_ground_light;

/** Two points of the host's world, m. Element of an array, without struct_size; calls take its sizeof instead. */
typedef struct wk_segment {
    /** Position of the observer. */
    double from_m[3];
    /** Position of the object, at least a millimetre away. */
    double to_m[3];
} wk_segment;

/**
 * Transmittance and visibility between two points. Element of an array, without struct_size; calls take its sizeof
 * instead.
 */
typedef struct wk_between {
    /** Transmittance, per channel (wavelengths of the planet; 620, 550 and 450 nm for the Earth). */
    double transmittance[3];
    /**
     * Meteorological optical range along the segment, m: the distance at which 550 nm light would fall to 5 % if the
     * air were everywhere as on this segment. Infinite if nothing attenuates light.
     */
    double visibility_m;
} wk_between;

/** Light of the sky on surfaces of any orientation. */
typedef struct wk_ambient {
    /** sizeof(wk_ambient) of your header. */
    uint32_t struct_size;
    /** WK_STRUCT_TYPE_AMBIENT. */
    wk_struct_type struct_type;
    /** No extensions in this version: NULL. */
    const void *next;
    /**
     * Radiance of sky (upper half) and lit ground (lower half) in nine real spherical harmonics, cd/m^2:
     * sh9[3 * coefficient + channel], coefficients in the order 00; 1y, 1z, 1x; 2xy, 2yz, 2zz, 2xz, 2xx-yy
     * (Ramamoorthi and Hanrahan 2001), x east, y north, z up.
     */
    double sh9[27];
} wk_ambient;

/** Every field of `wk_ambient` at its default. */
#define WK_AMBIENT_INIT { \
    /* struct_size */ (uint32_t)sizeof(wk_ambient), \
    /* struct_type */ WK_STRUCT_TYPE_AMBIENT, \
    /* next */ NULL, \
    /* sh9 */ { 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0 } \
}

/**
 * Gets the sun over a place of the host's world, now.
 * Thread: concurrent.
 */
WK_API
wk_status wk_context_get_sun(const wk_context *context,
                             const double (*position_m)[3],
                             wk_celestial *out_sun);

/**
 * Gets the sun over a place of the host's world at a simulation time.
 * Thread: concurrent.
 * Errors: as wk_context_get_conditions.
 */
WK_API
wk_status wk_context_get_sun_at(const wk_context *context,
                                const double (*position_m)[3],
                                double time_s,
                                wk_celestial *out_sun);

/**
 * Gets the moon over a place of the host's world, now.
 * Thread: concurrent.
 */
WK_API
wk_status wk_context_get_moon(const wk_context *context,
                              const double (*position_m)[3],
                              wk_celestial *out_moon);

/**
 * Gets the moon over a place of the host's world at a simulation time.
 * Thread: concurrent.
 * Errors: as wk_context_get_conditions.
 */
WK_API
wk_status wk_context_get_moon_at(const wk_context *context,
                                 const double (*position_m)[3],
                                 double time_s,
                                 wk_celestial *out_moon);

/**
 * Gets the light that arrives at places of the host's world now, at most wk_caps.max_batch of them. Only clouds above
 * the height of a place dim its light, by their mean effect on all places at that height. `position_size` and
 * `light_size` are the distances from one element to the next, bytes: 24 or more for positions,
 * sizeof(wk_ground_light) of your header for lights.
 * Thread: concurrent.
 */
WK_API
wk_status wk_context_get_light(const wk_context *context,
                               const double (*positions_m)[3],
                               uint32_t count,
                               uint32_t position_size,
                               wk_ground_light *lights,
                               uint32_t light_size);

/**
 * Gets the light as wk_context_get_light does, at a simulation time.
 * Thread: concurrent.
 * Errors: as wk_context_get_conditions.
 */
WK_API
wk_status wk_context_get_light_at(const wk_context *context,
                                  const double (*positions_m)[3],
                                  uint32_t count,
                                  uint32_t position_size,
                                  double time_s,
                                  wk_ground_light *lights,
                                  uint32_t light_size);

/**
 * Gets transmittance and visibility between pairs of points now, at most wk_caps.max_batch of them. The answers
 * include air, haze, fog, precipitation and clouds drawn as a volume. They exclude clouds drawn as a deck and the
 * host's objects. `segment_size` and `between_size` are sizeof(wk_segment) and sizeof(wk_between) of your header.
 * Thread: concurrent.
 */
WK_API
wk_status wk_context_get_between(const wk_context *context,
                                 const wk_segment *segments,
                                 uint32_t count,
                                 uint32_t segment_size,
                                 wk_between *between,
                                 uint32_t between_size);

/**
 * Gets transmittance and visibility as wk_context_get_between does, at a simulation time.
 * Thread: concurrent.
 * Errors: as wk_context_get_conditions.
 */
WK_API
wk_status wk_context_get_between_at(const wk_context *context,
                                    const wk_segment *segments,
                                    uint32_t count,
                                    uint32_t segment_size,
                                    double time_s,
                                    wk_between *between,
                                    uint32_t between_size);

/**
 * Gets the slant visual range from a place at a simulation time, m: the distance up to which a black object is seen
 * along `direction`, a vector (east, north, up) at the place, of length 1 within 0.001. At that distance 5 % of the
 * object's contrast is left, because air, fog, rain, snow and clouds drawn as a volume let 5 % of the light at 550 nm
 * pass. The range is infinite if more than 5 % is left where the ray leaves the air or meets the planet's ground.
 * Thread: concurrent.
 * Errors: as wk_context_get_conditions; WK_ERROR_INVALID_ARGUMENT naming the direction.
 */
WK_API
wk_status wk_context_get_visibility_at(const wk_context *context,
                                       const double (*position_m)[3],
                                       const double (*direction)[3],
                                       double time_s,
                                       double *out_visibility_m);

/**
 * Gets the sky's light on surfaces of any orientation at a place. The call reads the sky's tables. It builds them if
 * no frame has done so yet. The first call after each change of the tables waits for the GPU.
 * Thread: exclusive; with an OpenGL host, the thread where its context is (or can be made) current.
 * Errors: WK_ERROR_INVALID_ARGUMENT naming the position; WK_ERROR_DEVICE_LOST.
 */
WK_API
wk_status wk_context_get_ambient(wk_context *context,
                                 const double (*position_m)[3],
                                 wk_ambient *out_ambient);

/**
 * Gets the sky's light as wk_context_get_ambient does, at a simulation time. The distribution of the clear sky's light
 * over directions is that of the present tables. The sky's brightness, clouds and fog are those at `time_s`.
 * Thread: as wk_context_get_ambient.
 * Errors: as wk_context_get_ambient and wk_context_get_conditions.
 */
WK_API
wk_status wk_context_get_ambient_at(wk_context *context,
                                    const double (*position_m)[3],
                                    double time_s,
                                    wk_ambient *out_ambient);

/**
 * Writes the default of every field: the same bytes as `WK_CELESTIAL_INIT`. `struct_size` is `sizeof(wk_celestial)`
 * as the caller was compiled, and is stored in the struct.
 */
WK_API wk_status wk_celestial_init(wk_celestial *out, uint32_t struct_size);

/**
 * Writes the default of every field: the same bytes as `WK_AMBIENT_INIT`. `struct_size` is `sizeof(wk_ambient)`
 * as the caller was compiled, and is stored in the struct.
 */
WK_API wk_status wk_ambient_init(wk_ambient *out, uint32_t struct_size);

/*
 * ====================================================================================================
 * [radiance] Queries: the sky's light by direction
 *
 * These functions serve sensors, reflections and lighting that the host computes itself. They give the radiance of the
 * sky in a direction, as a picture shows it in pixels that the host did not draw. The radiance includes the clear air,
 * clouds as the context's cloud model draws them (wk_context_set_cloud_model), fog with precipitation, the glow of the
 * night sky, and below the horizon the planet's own ground. It excludes the discs of sun and moon
 * (wk_context_get_light has their light), stars and planets, rain areas, and everything that the host drew.
 *
 * The double-precision reference of the sky computes the answers on the calling thread, without work of the GPU. The
 * first query in a new state of the air solves the reference, which takes a second or two. Other threads that ask for
 * radiances wait meanwhile. While the weather changes, the air has a new state at every time. The solutions of the
 * last four states are kept for all contexts of a device. docs/reflections.md has the cost for each direction and the
 * difference from pictures.
 * ====================================================================================================
 */

/** The sky's light from one direction. Element of an array, without struct_size; calls take its sizeof instead. */
typedef struct wk_sky_radiance {
    /** Radiance, cd/m^2, three channels of linear Rec. 709, never negative. */
    double radiance_cd_m2[3];
} wk_sky_radiance;

/**
 * Gets the sky's radiance at a place in several directions now, at most wk_caps.max_batch of them. A direction is a
 * vector (east, north, up) at the place, of length 1 within 0.001. `direction_size` and `radiance_size` are the
 * distances from one element to the next, bytes: 24 or more for directions, sizeof(wk_sky_radiance) of your header for
 * radiances.
 * Thread: concurrent.
 * Errors: WK_ERROR_INVALID_ARGUMENT naming the position or the first wrong direction; nothing is written then.
 */
WK_API
wk_status wk_context_get_sky_radiance(const wk_context *context,
                                      const double (*position_m)[3],
                                      const double (*directions)[3],
                                      uint32_t count,
                                      uint32_t direction_size,
                                      wk_sky_radiance *radiances,
                                      uint32_t radiance_size);

/**
 * Gets the sky's radiance as wk_context_get_sky_radiance does, at a simulation time.
 * Thread: concurrent.
 * Errors: as wk_context_get_sky_radiance and wk_context_get_conditions.
 */
WK_API
wk_status wk_context_get_sky_radiance_at(const wk_context *context,
                                         const double (*position_m)[3],
                                         const double (*directions)[3],
                                         uint32_t count,
                                         uint32_t direction_size,
                                         double time_s,
                                         wk_sky_radiance *radiances,
                                         uint32_t radiance_size);

/*
 * ====================================================================================================
 * [wind] Queries: wind and rain
 *
 * These functions give the velocity and the displacement of the air, the precipitation, and the rain on surfaces. They
 * answer for any place and for any past or future simulation time that the timeline of the weather still knows (see
 * wk_context_get_conditions). The answers are in closed form and need no work of the GPU. Vectors are (east, north,
 * up) at the place. Only wk_context_get_rain_on_at takes shelters into account.
 * ====================================================================================================
 */

/** Wind at a place and time. */
typedef struct wk_wind {
    /** sizeof(wk_wind) of your header. */
    uint32_t struct_size;
    /** WK_STRUCT_TYPE_WIND. */
    wk_struct_type struct_type;
    /** No extensions in this version: NULL. */
    const void *next;
    /** Velocity of the air at the queried time, gusts included, m/s. */
    double velocity_m_s[3];
    /** Mean velocity, without gusts, m/s. */
    double mean_m_s[3];
    /**
     * Displacement of the air at 10 m since simulation time 0, gusts included, m. It is the same at every place,
     * continuous through all changes of the weather, and equal bit for bit on all channels of a simulator. Move
     * objects that the air carries by differences of this displacement, never by velocity times time.
     */
    double displacement_m[3];
    /** Standard deviation of the wind speed along the mean wind, due to gusts, m/s. */
    double gust_deviation_m_s;
} wk_wind;

/** Every field of `wk_wind` at its default. */
#define WK_WIND_INIT { \
    /* struct_size */ (uint32_t)sizeof(wk_wind), \
    /* struct_type */ WK_STRUCT_TYPE_WIND, \
    /* next */ NULL, \
    /* velocity_m_s */ { 0.0, 0.0, 0.0 }, \
    /* mean_m_s */ { 0.0, 0.0, 0.0 }, \
    /* displacement_m */ { 0.0, 0.0, 0.0 }, \
    /* gust_deviation_m_s */ 0.0 \
}

/**
 * Precipitation at a place and time: rain and drizzle, hail and ice pellets, but no snow. All fields are 0 if none
 * falls.
 */
typedef struct wk_rainfall {
    /** sizeof(wk_rainfall) of your header. */
    uint32_t struct_size;
    /** WK_STRUCT_TYPE_RAINFALL. */
    wk_struct_type struct_type;
    /** No extensions in this version: NULL. */
    const void *next;
    /** Rate of rain and drizzle on level ground, mm/h. */
    double rate_mm_h;
    /**
     * Number of drops of 0.1 to 6 mm in the air, 1/m^3. The size distributions are those of Marshall and Palmer
     * (1948), and for showers and drizzle those of Joss et al. (1968). Each is scaled so that its drops give the rate.
     */
    double number_per_m3;
    /** Liquid water in the air, g/m^3. */
    double liquid_g_m3;
    /** Extinction by the drops, 1/m. */
    double extinction_per_m;
    /** Mean diameter of the drops in the air, mm. */
    double mean_diameter_mm;
    /** Median volume diameter, mm: half of the water in the air is in smaller drops. */
    double median_volume_diameter_mm;
    /** Number of drops that land on level ground, 1/(m^2 s). */
    double drops_per_m2_s;
    /**
     * Velocity of the median drop of the falling water, m/s: half of the water falls more steeply, the other half
     * less. Render occluder maps along this velocity. The drop falls at the speed of Gunn and Kinzer (1949). It moves
     * with the wind at 10 m, gusts included, or with the wind grid or wind field there (wk_context_set_wind_grid,
     * wk_context_set_wind_field). 0 if neither rain nor drizzle falls.
     */
    double fall_velocity_m_s[3];
    /** Hail, small hail and ice pellets on level ground, mm/h of melted water. */
    double ice_mm_h;
    /**
     * Number of stones in the air, 1/m^3: hail of 5 to 60 mm (Cheng and English 1983), or pellets of 0.5 to 5 mm,
     * which are frozen raindrops.
     */
    double stones_per_m3;
    /** Extinction by the stones, 1/m. */
    double stone_extinction_per_m;
    /** Mean diameter of the stones in the air, mm. */
    double stone_diameter_mm;
    /** Number of stones that land on level ground, 1/(m^2 s). */
    double stones_per_m2_s;
} wk_rainfall;

/** Every field of `wk_rainfall` at its default. */
#define WK_RAINFALL_INIT { \
    /* struct_size */ (uint32_t)sizeof(wk_rainfall), \
    /* struct_type */ WK_STRUCT_TYPE_RAINFALL, \
    /* next */ NULL, \
    /* rate_mm_h */ 0.0, \
    /* number_per_m3 */ 0.0, \
    /* liquid_g_m3 */ 0.0, \
    /* extinction_per_m */ 0.0, \
    /* mean_diameter_mm */ 0.0, \
    /* median_volume_diameter_mm */ 0.0, \
    /* drops_per_m2_s */ 0.0, \
    /* fall_velocity_m_s */ { 0.0, 0.0, 0.0 }, \
    /* ice_mm_h */ 0.0, \
    /* stones_per_m3 */ 0.0, \
    /* stone_extinction_per_m */ 0.0, \
    /* stone_diameter_mm */ 0.0, \
    /* stones_per_m2_s */ 0.0 \
}

/**
 * A surface that rain lands on, or an opening that it falls through. Element of an array, without struct_size; calls
 * take its sizeof instead.
 */
typedef struct wk_rain_surface {
    /** Position in the host's world, m. */
    double position_m[3];
    /** Normal of the surface's wet side, (east, north, up) at the place; of any length but 0. */
    double normal[3];
    /** Velocity of the surface, m/s (east, north, up). Range [-1000, 1000] each. */
    double velocity_m_s[3];
    /** Area of the surface, m^2. Range [0, 1e6]. */
    double area_m2;
} wk_rain_surface;

/** Rain on a surface. Element of an array, without struct_size; calls take its sizeof instead. */
typedef struct wk_rain_on {
    /** Rate of rain and drizzle, mm/h: litres per square metre and hour. */
    double rate_mm_h;
    /** Number of drops of 0.1 to 6 mm that land on the whole surface, 1/s. */
    double drops_per_s;
} wk_rain_on;

/**
 * Gets the wind at a place of the host's world and a simulation time. The mean follows the logarithmic profile over
 * the ground's roughness up to 100 m; above that it grows and veers to the geostrophic wind (docs/clouds.md). Gusts
 * have Kaimal's spectrum (1972, as in IEC 61400-1) and are the same all over the world. Height above ground means the
 * position's altitude minus the altitude of the weather's station; the reported wind is the wind 10 m above the
 * station. A host with terrain should therefore query the place at the station's altitude plus the height above the
 * host's own ground. At and below the roughness length there is no wind.
 * Thread: concurrent.
 * Errors: as wk_context_get_conditions.
 */
WK_API
wk_status wk_context_get_wind_at(const wk_context *context,
                                 const double (*position_m)[3],
                                 double time_s,
                                 wk_wind *out_wind);

/**
 * Gets the precipitation at a place of the host's world and a simulation time. The precipitation of a cloud layer
 * begins halfway up the layer, but at most 500 m above its base. Where the sky has several layers, precipitation
 * begins at the mean of these heights, weighted by the share of the sky in which each layer is the lowest; without
 * clouds, at 2000 m above the station. Above this height the weather's precipitation is 0. Rain areas
 * (wk_context_set_rain_areas) have tops of their own.
 * Thread: concurrent.
 * Errors: as wk_context_get_conditions.
 */
WK_API
wk_status wk_context_get_rainfall_at(const wk_context *context,
                                     const double (*position_m)[3],
                                     double time_s,
                                     wk_rainfall *out_rainfall);

/**
 * Gets the rain on at most wk_caps.max_batch surfaces at a simulation time. Drops of each size arrive in their own
 * direction: it follows from their fall speed, the wind with its gusts, and the velocity of the surface. A windscreen
 * at 25 m/s meets far more drops than the ground does. Boxes (wk_context_set_shelters) keep rain off where they
 * shelter a point 5 cm in front of the surface, each box at the place to which its velocity has carried it by that
 * time. Occluder maps have no effect here. `surface_size` and `on_size` are sizeof(wk_rain_surface) and
 * sizeof(wk_rain_on) of your header. If one surface is wrong, nothing is written.
 * Thread: concurrent.
 * Errors: as wk_context_get_conditions; WK_ERROR_INVALID_ARGUMENT naming the wrong field of a surface and its range.
 */
WK_API
wk_status wk_context_get_rain_on_at(const wk_context *context,
                                    const wk_rain_surface *surfaces,
                                    uint32_t count,
                                    uint32_t surface_size,
                                    double time_s,
                                    wk_rain_on *on,
                                    uint32_t on_size);

/**
 * Writes the default of every field: the same bytes as `WK_WIND_INIT`. `struct_size` is `sizeof(wk_wind)`
 * as the caller was compiled, and is stored in the struct.
 */
WK_API wk_status wk_wind_init(wk_wind *out, uint32_t struct_size);

/**
 * Writes the default of every field: the same bytes as `WK_RAINFALL_INIT`. `struct_size` is `sizeof(wk_rainfall)`
 * as the caller was compiled, and is stored in the struct.
 */
WK_API wk_status wk_rainfall_init(wk_rainfall *out, uint32_t struct_size);

/*
 * ====================================================================================================
 * [frame] Frames and targets
 *
 * A wk_frame describes what the host has drawn: the camera, the meaning of the numbers in its depth and colour, and
 * the images. All matrices are column-major with column vectors (OpenGL, Vulkan, glm): m[4 * column + row].
 *
 * position_m gives the camera's position in double precision; Welkin ignores the translation of `view`. Any projection
 * works: perspective, off-axis, one eye of a stereo pair, orthographic, infinite far plane, reversed depth.
 *
 * Welkin reads depth as the projection gives it: z / w, mapped to the depth buffer's range of 0 to 1. With
 * WK_DEPTH_LOGARITHMIC the host's shaders must have written ln(C w + 1) / ln(C far + 1) instead, with w of clip space,
 * C = logarithmic_c and far = logarithmic_far_m. Pixels at the far depth show the sky.
 *
 * `target` points to the images, in the struct for the kind of device: wk_own_target, wk_opengl_target or
 * wk_vulkan_target.
 * ====================================================================================================
 */

/** Relation of depth to distance. */
typedef uint32_t wk_depth_kind;

/** Depth as the projection matrix gives it: perspective (with a finite or infinite far plane) or orthographic. */
#define WK_DEPTH_PROJECTION 0
/**
 * ln(C w + 1) / ln(C far + 1), written by the host's shaders, with w of clip space, C = logarithmic_c and far =
 * logarithmic_far_m.
 */
#define WK_DEPTH_LOGARITHMIC 1

/** Range of clip-space z. */
typedef uint32_t wk_clip_space;

/** 0 to 1: Vulkan, Direct3D, Metal, OpenGL with GL_ZERO_TO_ONE. */
#define WK_CLIP_ZERO_TO_ONE 0
/** -1 to 1: OpenGL's default. */
#define WK_CLIP_MINUS_ONE_TO_ONE 1

/** Flags of a frame. */
typedef uint32_t wk_frame_flags;

/**
 * The camera jumped: nothing of earlier frames may show. If the sky's tables do not fit the weather yet, this frame
 * builds them, as with WK_FRAME_NO_HISTORY.
 */
#define WK_FRAME_CUT 1
/**
 * Draw a picture that depends on seed, time and view alone, without any history. If the sky's tables are not complete
 * yet, this frame builds them, and takes as long as many ordinary frames. Use it for stills and comparisons, not for
 * every frame of a changing weather.
 */
#define WK_FRAME_NO_HISTORY 2
/** Depth is reversed: 1 is near, 0 is far. */
#define WK_FRAME_DEPTH_REVERSED 4
/**
 * The first row of the images lies at clip y = -1. This is always so in OpenGL, where the flag need not be set. In
 * Vulkan it is so with a viewport of positive height, where the flag must be set. Without the flag the first row lies
 * at clip y = +1.
 */
#define WK_FRAME_FIRST_ROW_AT_MINUS_Y 8
/**
 * Measure the cost of each effect: wk_report.ms, wk_view_get_costs. Welkin draws stages one by one and waits for the
 * GPU after each, so the frame is slower and its picture may differ by rounding. Use the flag now and then, not in
 * every frame. On a Vulkan host the call returns WK_ERROR_UNSUPPORTED, because the host lends its images for one
 * submission only.
 */
#define WK_FRAME_MEASURE 16
/**
 * The target's normals are in the axes of the camera (x right, y up, z towards the viewer: gl_NormalMatrix *
 * gl_Normal), not in those of the host's world.
 */
#define WK_FRAME_NORMALS_IN_EYE_SPACE 32

/** Meaning of the numbers in the host's colour. */
typedef uint32_t wk_color_space;

/** Linear Rec. 709, proportional to luminance (cd_m2_per_unit). WK_STAGE_TONE has an effect only in this space. */
#define WK_COLOR_SCENE_LINEAR 0
/** Already tone-mapped, linear Rec. 709 in [0, 1]. Welkin tone-maps its own light and composites linearly. */
#define WK_COLOR_DISPLAY_LINEAR 1
/** Already tone-mapped, and encoded by the sRGB curve: by the host, or by the hardware in an sRGB format. */
#define WK_COLOR_DISPLAY_SRGB 2

/**
 * Welkin's access to the target's depth. The sea and the terrain (wk_context_set_terrain_drawing) are drawn only into
 * depth that may be written. Without sea and terrain, both values give the same picture.
 */
typedef uint32_t wk_depth_access;

/** Welkin reads the depth, leaves every bit of it as it is, and draws nothing opaque of its own. */
#define WK_DEPTH_ACCESS_READ 0
/**
 * Welkin tests and writes the depth where it draws opaque things: the sea, and terrain (stage SURFACE, before the
 * water on surfaces). The stencil stays as it is. The depth must have a depth format, as many samples as the colour,
 * and in Vulkan the usage DEPTH_STENCIL_ATTACHMENT. This access is not possible with WK_OPENGL_MULTISAMPLE_RESOLVE of
 * several samples, nor on an own device, whose depth is WK_FORMAT_R32_FLOAT.
 */
#define WK_DEPTH_ACCESS_READ_WRITE 1

/**
 * A false-colour picture that replaces a frame's picture, for developers. It shows one quantity per pixel on a scale
 * from black over blue, green, yellow and red to white. In the descriptions of the quantities, "a step" leads from one
 * of these colours to the next. Each quantity names a stage: the wk_view_record with this stage draws the picture.
 * Other calls of the frame draw nothing, except that a call with the stage SURFACE still draws the sea and the terrain
 * if the depth may be written (wk_depth_access). Masked pixels stay the host's. If the frame contains nothing of the
 * quantity, all is black.
 */
typedef uint32_t wk_diagnostic;

/** The picture itself, not in false colours. */
#define WK_DIAGNOSTIC_NONE 0
/**
 * Distance along the ray, on a logarithmic scale: black for 1 m or less, white for 100 km or more and for the sky.
 * Stage MEDIUM.
 */
#define WK_DIAGNOSTIC_DISTANCE 1
/**
 * Optical depth of air, fog, precipitation and clouds between the eye and the visible surface, in the sky without the
 * clouds: black 0, 1 a step, white 5 or more. The columns of rain areas are left out. Stage MEDIUM.
 */
#define WK_DIAGNOSTIC_OPTICAL_DEPTH 2
/** Share of a surface under a film, standing water or clear ice: black 0, 0.2 a step, white 1. Stage SURFACE. */
#define WK_DIAGNOSTIC_WETNESS 3
/**
 * Error due to the air, fog and clear sky that the plan leaves out, |Y' - Y| / (Y + 0.01 white) (see Plan and budget
 * of a view), on a logarithmic scale: black 1e-4 or less, white 10 or more. Drops and stars are not counted. Stage
 * MEDIUM.
 */
#define WK_DIAGNOSTIC_PLAN_ERROR 4
/**
 * Number of times that precipitation was drawn over a pixel: black 0, 4 a step, white 20 or more. Stage PARTICLES.
 */
#define WK_DIAGNOSTIC_OVERDRAW 5
/**
 * Speed of the wind that carries the precipitation, 2 m above the host's surfaces: black a calm, 4 m/s a step, white
 * 20 m/s or more. The ground is divided into squares. Each square has an arrow along the wind, or a dot where the wind
 * is slower than 0.3 m/s. The sky is black. Stage MEDIUM.
 */
#define WK_DIAGNOSTIC_WIND 6

/** One frame of one view. */
typedef struct wk_frame {
    /** sizeof(wk_frame) of your header. */
    uint32_t struct_size;
    /** WK_STRUCT_TYPE_FRAME. */
    wk_struct_type struct_type;
    /** No extensions in this version: NULL. */
    const void *next;
    /** The host's frame number: the same in all calls of a frame and on all channels of a simulator. Default 0. */
    uint64_t frame_id;
    /** Position of the camera in the host's world, m. Default 0, 0, 0. */
    double position_m[3];
    /** Matrix from world to eye, of which only the rotation is used. Default identity. */
    double view[16];
    /** Matrix from eye to clip space; it must be invertible. Default identity. */
    double projection[16];
    /** Relation of depth to distance. Default WK_DEPTH_PROJECTION. */
    wk_depth_kind depth_kind;
    /** Range of clip-space z. Default WK_CLIP_ZERO_TO_ONE. */
    wk_clip_space clip_space;
    /**
     * Constant C of logarithmic depth, 1/m. Range [1e-9, 1e6] where depth_kind is WK_DEPTH_LOGARITHMIC. Default 1.
     */
    double logarithmic_c;
    /**
     * Distance at depth 1 of logarithmic depth, m. Range [1e-3, 1e12] where depth_kind is WK_DEPTH_LOGARITHMIC.
     * Default 1e7.
     */
    double logarithmic_far_m;
    /** Flags of the frame. Default 0. */
    wk_frame_flags flags;
    /** Colour space of the host's colour. Default WK_COLOR_SCENE_LINEAR. */
    wk_color_space color_space;
    /** Luminance of the value 1 in a scene-linear colour image, cd/m^2. Range [1e-9, 1e9], default 1. */
    double cd_m2_per_unit;
    /** Source of the exposure. Default WK_EXPOSURE_OF_CONTEXT. */
    wk_exposure_mode exposure_mode;
    /** Must be 0. */
    uint32_t reserved0;
    /** Value of the exposure, as wk_exposure_mode says. Default 0. */
    double exposure_value;
    /**
     * The images: a wk_own_target, wk_opengl_target or wk_vulkan_target, by the kind of device. May be NULL if the
     * call's only stage is WK_STAGE_PREPARE.
     */
    const void *target;
    /**
     * Velocity of the camera in the host's world, m/s; its length is at most 2000. Rain streaks lie along the drops'
     * velocity relative to the camera. Default 0, 0, 0.
     */
    double velocity_m_s[3];
    /** Welkin's access to the target's depth. Default WK_DEPTH_ACCESS_READ. */
    wk_depth_access depth_access;
    /** False-colour picture to draw in place of the frame's. Default WK_DIAGNOSTIC_NONE. */
    wk_diagnostic diagnostic;
} wk_frame;

/** Every field of `wk_frame` at its default. */
#define WK_FRAME_INIT { \
    /* struct_size */ (uint32_t)sizeof(wk_frame), \
    /* struct_type */ WK_STRUCT_TYPE_FRAME, \
    /* next */ NULL, \
    /* frame_id */ UINT64_C(0), \
    /* position_m */ { 0.0, 0.0, 0.0 }, \
    /* view */ { 1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0 }, \
    /* projection */ { 1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0 }, \
    /* depth_kind */ WK_DEPTH_PROJECTION, \
    /* clip_space */ WK_CLIP_ZERO_TO_ONE, \
    /* logarithmic_c */ 1.0, \
    /* logarithmic_far_m */ 1e7, \
    /* flags */ 0, \
    /* color_space */ WK_COLOR_SCENE_LINEAR, \
    /* cd_m2_per_unit */ 1.0, \
    /* exposure_mode */ WK_EXPOSURE_OF_CONTEXT, \
    /* reserved0 */ 0, \
    /* exposure_value */ 0.0, \
    /* target */ NULL, \
    /* velocity_m_s */ { 0.0, 0.0, 0.0 }, \
    /* depth_access */ WK_DEPTH_ACCESS_READ, \
    /* diagnostic */ WK_DIAGNOSTIC_NONE \
}

/**
 * Light for the host's own shading of a frame, in the units of the frame's color_space. The host shows a surface of
 * colour c with normal n as c * (ambient + direct * max(dot(n, direction), 0)).
 *
 * In scene-linear space this is exact for matt surfaces. In display spaces the light includes the tone curve at the
 * frame's exposure, so `ambient` and `direct` cannot be right for every surface. They are right for an 18 % grey card,
 * both in shade and facing the sun. With WK_COLOR_DISPLAY_LINEAR c is linear, and the host (or its sRGB framebuffer)
 * encodes the result. With WK_COLOR_DISPLAY_SRGB c and the light are both encoded numbers, as fixed-function OpenGL
 * multiplies them.
 */
typedef struct wk_frame_light {
    /** sizeof(wk_frame_light) of your header. */
    uint32_t struct_size;
    /** WK_STRUCT_TYPE_FRAME_LIGHT. */
    wk_struct_type struct_type;
    /** No extensions in this version: NULL. */
    const void *next;
    /** Unit vector in the host's world towards the sun, or towards the moon when the moon is brighter. */
    double direction[3];
    /**
     * Direct light from `direction` on a surface that faces it, after air, clouds and fog; 0 when that light is below
     * the horizon.
     */
    double direct[3];
    /** Light from sky, clouds and fog on level ground, and direct light from the fainter of sun and moon. */
    double ambient[3];
    /** Light from the ground on a surface that faces down, for hosts with one ambient light above and one below. */
    double ambient_below[3];
    /** Display units per cd/m^2 with which Welkin draws the frame. */
    double exposure;
} wk_frame_light;

/** Every field of `wk_frame_light` at its default. */
#define WK_FRAME_LIGHT_INIT { \
    /* struct_size */ (uint32_t)sizeof(wk_frame_light), \
    /* struct_type */ WK_STRUCT_TYPE_FRAME_LIGHT, \
    /* next */ NULL, \
    /* direction */ { 0.0, 0.0, 0.0 }, \
    /* direct */ { 0.0, 0.0, 0.0 }, \
    /* ambient */ { 0.0, 0.0, 0.0 }, \
    /* ambient_below */ { 0.0, 0.0, 0.0 }, \
    /* exposure */ 0.0 \
}

/** The images of a frame on an own device. */
typedef struct wk_own_target {
    /** sizeof(wk_own_target) of your header. */
    uint32_t struct_size;
    /** WK_STRUCT_TYPE_OWN_TARGET. */
    wk_struct_type struct_type;
    /** No extensions in this version: NULL. */
    const void *next;
    /** The image to draw into, of any wk_format with four channels. Default NULL. */
    const wk_texture *color;
    /** Surface to draw into if `color` is NULL: Welkin draws into its acquired image. Default NULL. */
    const wk_surface *surface;
    /**
     * Depth of the host's picture, WK_FORMAT_R32_FLOAT, as large as `color`. With NULL (the default) every pixel shows
     * the sky.
     */
    const wk_texture *depth;
    /**
     * Mask: where its red is 1, the host's pixel stays (cab, HUD); where its red is 0, Welkin draws weather.
     * WK_FORMAT_R8_UNORM, WK_FORMAT_RGBA8_UNORM, WK_FORMAT_RGBA8_SRGB or WK_FORMAT_BGRA8_UNORM, as large as `color`.
     * Default NULL.
     */
    const wk_texture *mask;
    /**
     * Surface class of each pixel: the byte of red is a wk_surface_class, or 0 to use the class of the host's terrain
     * or the context's default. WK_FORMAT_R8_UNORM, WK_FORMAT_RGBA8_UNORM or WK_FORMAT_BGRA8_UNORM, as large as
     * `color`. Default NULL.
     */
    const wk_texture *surface_classes;
    /**
     * Unit normals, in the host's world or in eye space (WK_FRAME_NORMALS_IN_EYE_SPACE): (n + 1) / 2 in normalised
     * formats, n in float formats. Where a pixel holds no unit vector (a cleared pixel), Welkin uses the normal of the
     * host's terrain or depth. As large as `color`. Default NULL.
     */
    const wk_texture *normals;
} wk_own_target;

/** Every field of `wk_own_target` at its default. */
#define WK_OWN_TARGET_INIT { \
    /* struct_size */ (uint32_t)sizeof(wk_own_target), \
    /* struct_type */ WK_STRUCT_TYPE_OWN_TARGET, \
    /* next */ NULL, \
    /* color */ NULL, \
    /* surface */ NULL, \
    /* depth */ NULL, \
    /* mask */ NULL, \
    /* surface_classes */ NULL, \
    /* normals */ NULL \
}

/**
 * Gets the light with which the host should light its own objects in a frame. Call this function before you draw the
 * objects. Of `frame`, the call uses the camera's position, color_space, cd_m2_per_unit and the exposure, and ignores
 * the target.
 * Thread: concurrent.
 * Errors: WK_ERROR_INVALID_ARGUMENT naming the field.
 */
WK_API
wk_status wk_context_get_frame_light(const wk_context *context,
                                     const wk_frame *frame,
                                     wk_frame_light *out_light);

/**
 * Writes the default of every field: the same bytes as `WK_FRAME_INIT`. `struct_size` is `sizeof(wk_frame)`
 * as the caller was compiled, and is stored in the struct.
 */
WK_API wk_status wk_frame_init(wk_frame *out, uint32_t struct_size);

/**
 * Writes the default of every field: the same bytes as `WK_OWN_TARGET_INIT`. `struct_size` is `sizeof(wk_own_target)`
 * as the caller was compiled, and is stored in the struct.
 */
WK_API wk_status wk_own_target_init(wk_own_target *out, uint32_t struct_size);

/**
 * Writes the default of every field: the same bytes as `WK_FRAME_LIGHT_INIT`. `struct_size` is `sizeof(wk_frame_light)`
 * as the caller was compiled, and is stored in the struct.
 */
WK_API
wk_status wk_frame_light_init(wk_frame_light *out,
                              uint32_t struct_size);

/*
 * ====================================================================================================
 * [view] Views
 *
 * A wk_view is one camera or projector channel, with the data that it keeps between frames. A host draws opaque
 * things, then glass and lamps, then the cab, then the HUD. wk_view_record draws Welkin's stages between them:
 *
 *   PREPARE     tables and simulation textures; needs no target
 *   BACKGROUND  the sky behind everything; before or after the opaque things
 *   SURFACE     water and snow on surfaces, shadows of clouds, the sea, terrain; after the opaque things; needs depth
 *   MEDIUM      fog and aerial perspective on all that was drawn so far
 *   PARTICLES   rain, hail and snow near the camera, channels of lightning
 *   LENS        water and snow on the windscreen
 *   TONE        exposure, tone curve, encoding and dither of a scene-linear picture; nothing in display colour spaces
 *
 * The calls of one frame share frame_id and record stages in this order, each at most once. WK_STAGE_ALL does
 * everything in one call and lets neighbouring stages share one pass. Stages with nothing to draw cost nothing. When
 * the call returns, the work is submitted to the device's queue but not finished.
 * ====================================================================================================
 */

/** One camera or projector channel. Child of a wk_context. */
typedef struct wk_view wk_view;

/** Settings for a new view. */
typedef struct wk_view_desc {
    /** sizeof(wk_view_desc) of your header. */
    uint32_t struct_size;
    /** WK_STRUCT_TYPE_VIEW_DESC. */
    wk_struct_type struct_type;
    /** No extensions in this version: NULL. */
    const void *next;
} wk_view_desc;

/** Every field of `wk_view_desc` at its default. */
#define WK_VIEW_DESC_INIT { \
    /* struct_size */ (uint32_t)sizeof(wk_view_desc), \
    /* struct_type */ WK_STRUCT_TYPE_VIEW_DESC, \
    /* next */ NULL \
}

/** Stages that a call records. */
typedef uint32_t wk_stage_flags;

/** Tables and simulation textures; needs no target. */
#define WK_STAGE_PREPARE 1
/** Sky behind everything: on the pixels at the far depth, or on all pixels if the target has no depth. */
#define WK_STAGE_BACKGROUND 2
/**
 * Water and snow on surfaces, shadows of clouds, and the sea and terrain that Welkin draws; after the host's opaque
 * objects.
 */
#define WK_STAGE_SURFACE 4
/** Fog and aerial perspective on everything that the host has drawn. */
#define WK_STAGE_MEDIUM 8
/** Rain, hail and snow near the camera, and the channels of lightning. */
#define WK_STAGE_PARTICLES 16
/** Water and snow on the windscreen. */
#define WK_STAGE_LENS 32
/**
 * Exposure, tone curve, encoding and dither of a scene-linear picture: float targets and sRGB formats get
 * display-linear values, other formats get sRGB-encoded ones. With WK_COLOR_DISPLAY_LINEAR and WK_COLOR_DISPLAY_SRGB
 * the host has done these steps, and TONE does nothing, alone or with other stages.
 */
#define WK_STAGE_TONE 64
/** Everything in one call. */
#define WK_STAGE_ALL 127

/** Flags that say which optional fields of a wk_report are set. */
typedef uint32_t wk_report_flags;

/** wk_report.ms. */
#define WK_REPORT_HAS_MS 1
/** wk_report.predicted_ms: the view has a budget, its picture was gauged and a time was reported. */
#define WK_REPORT_HAS_PREDICTED_MS 2
/** wk_report.reported_ms: wk_view_report_time was called after the frame. */
#define WK_REPORT_HAS_REPORTED_MS 4
/** wk_report.predicted_error and predicted_error_bound: the view has a budget and its picture was gauged. */
#define WK_REPORT_HAS_PREDICTED_ERROR 8
/** wk_report.checked_error_bound and checked_error: the gauge has measured a picture whose error was predicted. */
#define WK_REPORT_HAS_CHECKED_ERROR 16

/** Costs and contents of a view's last frame. */
typedef struct wk_report {
    /** sizeof(wk_report) of your header. */
    uint32_t struct_size;
    /** WK_STRUCT_TYPE_REPORT. */
    wk_struct_type struct_type;
    /** No extensions in this version: NULL. */
    const void *next;
    /** The host's frame number; UINT64_MAX before the first frame. */
    uint64_t frame_id;
    /** Number of render passes recorded for this frame so far, without those that build tables. */
    uint32_t passes;
    /**
     * Number of tables built, refined or blended for this frame so far; 0 when only the camera turned and the sky has
     * its final quality.
     */
    uint32_t tables_rebuilt;
    /** Exposure that was applied, display units per cd/m^2; 0 if nothing was drawn. */
    double exposure;
    /** GPU memory that the view uses for itself, bytes. */
    uint64_t bytes;
    /** Flags that say which of the optional fields are set. */
    wk_report_flags has;
    /** Always 0. */
    uint32_t reserved0;
    /**
     * Time of the frame's calls so far, including the wait for the GPU, ms. Set if the frame was measured
     * (WK_FRAME_MEASURE).
     */
    double ms;
    /**
     * Time that the weather in this frame was predicted to take, ms, from the times that the host had reported before.
     */
    double predicted_ms;
    /** Time that the host reported for this frame, ms. */
    double reported_ms;
    /**
     * Estimated error due to the parts that this frame left out, except those that were still fading: 95th percentile
     * over the gauged pixels. All errors of this struct are in the measure of wk_budget.tolerance.
     */
    double predicted_error;
    /** Upper bound, with 95 % confidence, of the error's 95th percentile over all pixels. */
    double predicted_error_bound;
    /** Error bound that was predicted for the last gauged picture. */
    double checked_error_bound;
    /** Error that the gauge measured in the picture for which checked_error_bound was predicted. */
    double checked_error;
    /** Number of drops and hailstones around the camera; those inside the picture were drawn. */
    uint32_t drops;
    /** Number of flakes around the camera; those inside the picture were drawn. 0 if no flakes were drawn. */
    uint32_t flakes;
    /**
     * Number of drops that each drawn drop represented: 1 unless more fell than wk_rain.most_drops; 0 without drops.
     */
    double drop_weight;
    /**
     * Rate of the splashes left out on level ground because the largest number of splashes was reached, 1/(m^2 s). The
     * splashes of the smallest drops are left out first.
     */
    double splashes_left_out_per_m2_s;
    /**
     * Rate of the stones that did not bounce on level ground because the largest number of bouncing stones was
     * reached, 1/(m^2 s). The smallest stones are left out first.
     */
    double stones_left_out_per_m2_s;
    /** Contrast gain that rain was drawn with (wk_rain.contrast_gain): 1 is as in nature; 0 if no rain was drawn. */
    double contrast_gain;
    /**
     * Distance up to which flakes were drawn, m; farther away snow is extinction alone. 0 if no flakes were drawn.
     */
    double flakes_to_m;
} wk_report;

/** Every field of `wk_report` at its default. */
#define WK_REPORT_INIT { \
    /* struct_size */ (uint32_t)sizeof(wk_report), \
    /* struct_type */ WK_STRUCT_TYPE_REPORT, \
    /* next */ NULL, \
    /* frame_id */ UINT64_C(0), \
    /* passes */ 0, \
    /* tables_rebuilt */ 0, \
    /* exposure */ 0.0, \
    /* bytes */ UINT64_C(0), \
    /* has */ 0, \
    /* reserved0 */ 0, \
    /* ms */ 0.0, \
    /* predicted_ms */ 0.0, \
    /* reported_ms */ 0.0, \
    /* predicted_error */ 0.0, \
    /* predicted_error_bound */ 0.0, \
    /* checked_error_bound */ 0.0, \
    /* checked_error */ 0.0, \
    /* drops */ 0, \
    /* flakes */ 0, \
    /* drop_weight */ 0.0, \
    /* splashes_left_out_per_m2_s */ 0.0, \
    /* stones_left_out_per_m2_s */ 0.0, \
    /* contrast_gain */ 0.0, \
    /* flakes_to_m */ 0.0 \
}

/** Effect whose cost is measured. */
typedef uint32_t wk_effect;

/** Tables of the sky for the whole planet: built when the air changes. */
#define WK_EFFECT_SKY_TABLES 0
/** Tables of the sky and the air as seen from the camera's height: built when height, sun or air change. */
#define WK_EFFECT_SKY_VIEW 1
/** Sky behind everything. */
#define WK_EFFECT_BACKGROUND 2
/** Fog and aerial perspective. */
#define WK_EFFECT_MEDIUM 3
/** Exposure, tone curve, encoding. */
#define WK_EFFECT_TONE 4
/** Several stages in one draw, where the target's format does not allow separate draws. */
#define WK_EFFECT_COMPOSITION 5
/** Textures for the host's own shaders. */
#define WK_EFFECT_VEIL 6
/** Acquiring the host's context and images, and returning them. */
#define WK_EFFECT_HAND_OVER 7
/** Rain, hail and snow near the camera, and the channels of lightning. */
#define WK_EFFECT_PARTICLES 8
/** Water and snow on surfaces, and the sea and terrain that Welkin draws. */
#define WK_EFFECT_SURFACE 9
/** Water on the windscreen: its simulation steps, which run after the sky's tables are built, and the stage LENS. */
#define WK_EFFECT_WINDSCREEN 10

/** Cost of one effect in a frame. Element of an array, without struct_size; calls take its sizeof instead. */
typedef struct wk_effect_cost {
    /** Effect whose cost this is. */
    wk_effect effect;
    /** Always 0. */
    uint32_t reserved0;
    /** Name of the effect in English; lives as long as the library. */
    const char *name;
    /**
     * Wall time around a submission that is waited for, including the CPU's share, ms. 0 if the effect did not run.
     */
    double ms;
} wk_effect_cost;

/**
 * Creates a view of a context. `desc` NULL means WK_VIEW_DESC_INIT. On success `*out_view` is a new handle for
 * `wk_view_destroy`.
 * Thread: exclusive on the context.
 */
WK_API wk_status wk_view_create(wk_context *context, const wk_view_desc *desc, wk_view **out_view);

/**
 * Destroys a view. NULL does nothing.
 * Thread: any. GPU objects that need the host's OpenGL context are released at once if that context can be made
 * current on this thread, else at the next call that uses the GPU of this device.
 */
WK_API wk_status wk_view_destroy(wk_view *view);

/**
 * Records the stages of a frame and submits them. `stages` is a union of WK_STAGE_ constants, not empty. Welkin checks
 * the frame before any work: after an error nothing is drawn, built or changed.
 * Thread: exclusive on the view; views of one context may record from several threads while none updates the context.
 * Errors: WK_ERROR_WRONG_ORDER if a stage is repeated or out of order; WK_ERROR_UNSUPPORTED and
 * WK_ERROR_INVALID_ARGUMENT naming the field; WK_ERROR_DEVICE_LOST; with wk_own_target.surface also the statuses of
 * wk_surface_acquire.
 */
WK_API
wk_status wk_view_record(wk_view *view,
                         const wk_frame *frame,
                         wk_stage_flags stages);

/**
 * Draws weathers that the host may set later, into small images of Welkin's own. Shaders are then compiled in advance,
 * and hardly any later frame waits for one. Each weather is drawn during the change from the previous weather of the
 * list (for the first, from the context's own), after the change, and with the sun at several heights. Where the
 * context has weather regions, each weather is also drawn with them around the camera: set them before. Call this
 * function behind a loading screen, before the view's first frame: the next frame begins as a view's first one does.
 * Afterwards the context is as before.
 *
 * `frame` describes the later frames: give it their settings, and images of the same formats, samples and usages.
 * Welkin neither draws into these images nor waits for them. `calls` has the stages of each wk_view_record of one
 * frame, in order: 1 to 7 elements; NULL with `call_count` 0 means one call with WK_STAGE_ALL. `weathers` has 0 to 64
 * elements, `weather_stride` bytes apart; each may have a wk_weather_overrides in its chain. One call draws for about
 * `most_s`, in [0, 3600] s, but at least one case: one weather at one time of its change and one height of the sun.
 * The call returns WK_PENDING, which is no error, while cases remain: call it again with the same weathers. With other
 * weathers the drawing starts from the beginning.
 * Thread: exclusive on the view and on its context.
 * Errors: WK_ERROR_INVALID_ARGUMENT and WK_ERROR_UNSUPPORTED naming `weathers[i]`, `calls[i]` or the field of `frame`;
 * WK_ERROR_WRONG_ORDER while wk_context_update returns WK_PENDING; WK_ERROR_DEVICE_LOST. After an error the context is
 * as before, and the same call continues with the case that failed.
 */
WK_API
wk_status wk_view_prepare(wk_view *view,
                          const wk_frame *frame,
                          const wk_stage_flags *calls,
                          uint32_t call_count,
                          const wk_weather *weathers,
                          uint32_t weather_count,
                          uint32_t weather_stride,
                          double most_s);

/**
 * Gets costs and contents of the view's last frame.
 * Thread: exclusive on the view.
 */
WK_API wk_status wk_view_get_report(wk_view *view, wk_report *out_report);

/**
 * Gets the cost of each effect of the view's last frame, in the order of the WK_EFFECT_ constants. `*out_count` always
 * gets the number of effects, which is 0 if the frame was not measured (WK_FRAME_MEASURE). If `capacity` is too small,
 * nothing else is written and the call fails; with capacity 0 it succeeds. `cost_size` is sizeof(wk_effect_cost) of
 * your header. Later versions may have more effects.
 * Thread: exclusive on the view.
 */
WK_API
wk_status wk_view_get_costs(wk_view *view,
                            wk_effect_cost *costs,
                            uint32_t capacity,
                            uint32_t cost_size,
                            uint32_t *out_count);

/**
 * Writes the default of every field: the same bytes as `WK_VIEW_DESC_INIT`. `struct_size` is `sizeof(wk_view_desc)`
 * as the caller was compiled, and is stored in the struct.
 */
WK_API wk_status wk_view_desc_init(wk_view_desc *out, uint32_t struct_size);

/**
 * Writes the default of every field: the same bytes as `WK_REPORT_INIT`. `struct_size` is `sizeof(wk_report)`
 * as the caller was compiled, and is stored in the struct.
 */
WK_API wk_status wk_report_init(wk_report *out, uint32_t struct_size);

/*
 * ====================================================================================================
 * [veil] Textures for the host's transparent things
 *
 * Glass, lamps and smoke that the host draws after the stage MEDIUM need the same air in front of them as the objects
 * that the stage has covered. Their shaders sample the frame's veil: the light that air, fog and rain add on the way
 * to a point, and the transmittance up to it. The published sampling functions, GLSL and WGSL, map clip coordinates
 * and distance to texels.
 * ====================================================================================================
 */

/**
 * The veil of the view's last frame. It includes air, clouds drawn as a volume, fog, the rain of the weather, and rain
 * areas.
 */
typedef struct wk_frame_textures {
    /** sizeof(wk_frame_textures) of your header. */
    uint32_t struct_size;
    /** WK_STRUCT_TYPE_FRAME_TEXTURES. */
    wk_struct_type struct_type;
    /** No extensions in this version: NULL. */
    const void *next;
    /**
     * Light that air, fog and precipitation add, RGB half floats: an OpenGL texture name (GL_TEXTURE_2D) or a VkImage.
     */
    uint64_t light;
    /** Transmittance: share of the light from behind that passes. A texture of the same kind as `light`. */
    uint64_t through;
    /** Width of both textures, pixels. */
    uint32_t width;
    /** Height of both textures, pixels. */
    uint32_t height;
    /** Factor that converts `light` to units of the host's colour. */
    double light_scale;
} wk_frame_textures;

/** Every field of `wk_frame_textures` at its default. */
#define WK_FRAME_TEXTURES_INIT { \
    /* struct_size */ (uint32_t)sizeof(wk_frame_textures), \
    /* struct_type */ WK_STRUCT_TYPE_FRAME_TEXTURES, \
    /* next */ NULL, \
    /* light */ UINT64_C(0), \
    /* through */ UINT64_C(0), \
    /* width */ 0, \
    /* height */ 0, \
    /* light_scale */ 0.0 \
}

/** Shading languages of the sampling functions. */
typedef uint32_t wk_shading_language;

/** GLSL 3.30. */
#define WK_SHADING_GLSL 0
/** WGSL. */
#define WK_SHADING_WGSL 1

/**
 * Gets the native textures of the veil. From the first call on, each frame's MEDIUM stage fills them. They belong to
 * the view and stay the same until it is destroyed. In Vulkan they are in VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL
 * between wk_view_record calls with MEDIUM. Call this function after each frame to get that frame's light_scale.
 * Thread: exclusive on the view.
 * Errors: WK_ERROR_UNSUPPORTED on an own device, where the host has no shaders.
 */
WK_API wk_status wk_view_get_frame_textures(wk_view *view, wk_frame_textures *out_textures);

/**
 * Gets the text of the sampling functions: NUL-terminated UTF-8 that lives as long as the process.
 * Thread: any.
 * Errors: WK_ERROR_INVALID_ARGUMENT for an unknown language.
 */
WK_API wk_status wk_get_veil_snippet(wk_shading_language language, const char **out_text);

/**
 * Writes the default of every field: the same bytes as `WK_FRAME_TEXTURES_INIT`. `struct_size` is `sizeof(wk_frame_textures)`
 * as the caller was compiled, and is stored in the struct.
 */
WK_API
wk_status wk_frame_textures_init(wk_frame_textures *out,
                                 uint32_t struct_size);

/*
 * ====================================================================================================
 * [environment] A cube map of what stands around the camera
 *
 * For reflections in the host's own objects: paint, water, windows. Six faces of 64 x 64 texels show the sky with its
 * clouds, fog and rain as far as the horizon, and the planet's ground below. They leave out the discs of the sun and
 * the moon (the host itself lights its objects by the sun and the moon), the stars and the host's objects. The glow of
 * the night sky is uniform. The axes are those of the host's world: a shader samples with the reflected direction as
 * it is. Level m of the 7 levels is prefiltered for a mirror of roughness m/6 (the distribution of Trowbridge and
 * Reitz, alpha = roughness^2; Karis 2013, Real Shading in Unreal Engine 4), so textureLod(cube, reflected, 6 *
 * roughness) is the specular light before the surface's reflectance. OpenGL hosts enable GL_TEXTURE_CUBE_MAP_SEAMLESS
 * and set their filters by a sampler object. Welkin draws one face a frame, in turn. It draws all six in the first
 * frame, in frames with WK_FRAME_CUT or WK_FRAME_NO_HISTORY, and when light, weather or place jump. A view draws the
 * cube map only after the first wk_view_get_environment.
 * ====================================================================================================
 */

/** The cube map of a view. */
typedef struct wk_environment {
    /** sizeof(wk_environment) of your header. */
    uint32_t struct_size;
    /** WK_STRUCT_TYPE_ENVIRONMENT. */
    wk_struct_type struct_type;
    /** No extensions in this version: NULL. */
    const void *next;
    /**
     * RGBA half floats: an OpenGL texture name (GL_TEXTURE_CUBE_MAP), or a VkImage of six layers with
     * VK_IMAGE_CREATE_CUBE_COMPATIBLE_BIT (VK_FORMAT_R16G16B16A16_SFLOAT).
     */
    uint64_t texture;
    /** Edge of a face, texels. */
    uint32_t size;
    /** Number of mip levels, down to one texel. */
    uint32_t level_count;
    /** Factor from texels to cd/m^2; 0 before the first frame. It changes only in frames that draw all faces. */
    double cd_m2_per_unit;
    /**
     * Factor from texels to the values of the last frame's colour. With WK_COLOR_SCENE_LINEAR these values are in the
     * host's units. In the display spaces they are exposed luminances, to which the tone curve still has to be
     * applied.
     */
    double light_scale;
} wk_environment;

/** Every field of `wk_environment` at its default. */
#define WK_ENVIRONMENT_INIT { \
    /* struct_size */ (uint32_t)sizeof(wk_environment), \
    /* struct_type */ WK_STRUCT_TYPE_ENVIRONMENT, \
    /* next */ NULL, \
    /* texture */ UINT64_C(0), \
    /* size */ 0, \
    /* level_count */ 0, \
    /* cd_m2_per_unit */ 0.0, \
    /* light_scale */ 0.0 \
}

/**
 * Gets the native texture of the cube map. Once you have called this function, the faces that are due are drawn in
 * each frame by its first wk_view_record with WK_STAGE_BACKGROUND or WK_STAGE_MEDIUM. The texture belongs to the view
 * and stays the same until the view is destroyed. In Vulkan it is in VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL after
 * each such wk_view_record. Call this function after each frame to get the frame's scales.
 * Thread: exclusive on the view.
 * Errors: WK_ERROR_UNSUPPORTED on an own device, where the host has no shaders.
 */
WK_API wk_status wk_view_get_environment(wk_view *view, wk_environment *out_environment);

/**
 * Writes the default of every field: the same bytes as `WK_ENVIRONMENT_INIT`. `struct_size` is `sizeof(wk_environment)`
 * as the caller was compiled, and is stored in the struct.
 */
WK_API
wk_status wk_environment_init(wk_environment *out,
                              uint32_t struct_size);

/*
 * ====================================================================================================
 * [plan] Plan and budget of a view
 *
 * With a tolerance, a view gauges its own pictures. In every eighth frame it draws a grid of 64 x 36 of its pixels
 * with everything, and again without each part of the weather. It reads the differences back some frames later,
 * without waiting for the GPU. Parts that change the picture by less than the tolerance fade out, and fade in again
 * when they matter. Under a budget of time, further parts fade out until the reported times fit the budget, starting
 * with the parts that save the most time for the least visible loss. These parts come back when there is time again.
 * After a jump of camera, sun or weather, and in frames with WK_FRAME_CUT or WK_FRAME_NO_HISTORY, everything is drawn.
 *
 * A part has a number (WK_PART_), a name and rungs, which are its levels of detail. Rung 0 draws all of it; the last
 * rung draws nothing, or the cheapest substitute. Later versions append parts: wk_plan.part_count has their number,
 * wk_view_get_part_plan their names.
 *
 * Error means the same everywhere in Welkin: |Y' - Y| / (Y + 0.01 white). Y is the luminance of a pixel in the
 * complete picture, Y' its luminance where parts are left out, and white the luminance that the exposure shows as
 * white. The error of a picture is the 95th percentile over its pixels. A tolerance also limits the error of the worst
 * pixel, to ten times the tolerance.
 *
 * Leaving parts out changes no simulation: time, weather and state stay the same on all channels of a simulator.
 * Channels that must also leave out the same parts pin their plan: by hand (WK_PART_WISH_HAS_RUNG), or with a plan
 * that another view found (wk_view_save_plan, wk_view_load_plan).
 * ====================================================================================================
 */

/** Flags that say which optional fields of a wk_budget are set. */
typedef uint32_t wk_budget_has_flags;

/** tolerance */
#define WK_BUDGET_HAS_TOLERANCE 1
/** milliseconds */
#define WK_BUDGET_HAS_MILLISECONDS 2

/** Flags that say which optional fields of a wk_part_wish are set. */
typedef uint32_t wk_part_wish_has_flags;

/** importance */
#define WK_PART_WISH_HAS_IMPORTANCE 1
/** rung */
#define WK_PART_WISH_HAS_RUNG 2

/** A part of the weather that a picture can reduce or leave out, by its number. */
typedef uint32_t wk_part;

/** Air and haze between the camera and what the host drew. Rungs: all, none. */
#define WK_PART_AIR 0
/** Fog, mist, dust and precipitation, as a layer. Rungs: all, none. */
#define WK_PART_FOG 1
/** The clear sky above the horizon, behind clouds. Rungs: all, none. */
#define WK_PART_SKY 2
/**
 * Streaks and splashes of rain, unless the host chose the view's rain model. Rungs: drops (single ones near the
 * camera), cones (in place of drops), none (all rain is extinction in the air; without WK_PART_FOG no rain is drawn at
 * all).
 */
#define WK_PART_RAIN 3
/** Stars, planets and the glow of the night sky between them. Rungs: all, none (a uniform sky of the same light). */
#define WK_PART_STARS 4
/** Clouds, where the context draws them as a volume. Rungs: volume, deck (as WK_CLOUD_MODEL_DECK). */
#define WK_PART_CLOUDS 5
/**
 * Flakes of falling snow, unless the host chose the view's snow model. Rungs: flakes, none (all snow is extinction in
 * the air; without WK_PART_FOG no snow is drawn at all).
 */
#define WK_PART_SNOW 6

/** A host's wish for one part. */
typedef struct wk_part_wish {
    /** sizeof(wk_part_wish) of your header. */
    uint32_t struct_size;
    /** WK_STRUCT_TYPE_PART_WISH. */
    wk_struct_type struct_type;
    /** No extensions in this version: NULL. */
    const void *next;
    /** Flags of the optional fields that are set. Default 0. */
    wk_part_wish_has_flags has;
    /** Part that the wish is about. Default WK_PART_AIR. */
    wk_part part;
    /**
     * Optional: draw the part at exactly this rung, whatever the tolerance and the time, so that all channels draw the
     * same. Range: below the part's wk_part_plan.rung_count. wk_plan.gave_way still says whether the tolerance or the
     * time is exceeded.
     */
    uint32_t rung;
    /** Must be 0. */
    uint32_t reserved;
    /**
     * Optional: importance of the part to viewers. A budget of time leaves out the less important parts first. Range
     * [0, 1], default wk_part_plan.importance.
     */
    double importance;
} wk_part_wish;

/** Every field of `wk_part_wish` at its default. */
#define WK_PART_WISH_INIT { \
    /* struct_size */ (uint32_t)sizeof(wk_part_wish), \
    /* struct_type */ WK_STRUCT_TYPE_PART_WISH, \
    /* next */ NULL, \
    /* has */ 0, \
    /* part */ 0, \
    /* rung */ 0, \
    /* reserved */ 0, \
    /* importance */ 0.0 \
}

/** Limits for a view's pictures: how wrong they may be, and how long they may take. */
typedef struct wk_budget {
    /** sizeof(wk_budget) of your header. */
    uint32_t struct_size;
    /** WK_STRUCT_TYPE_BUDGET. */
    wk_struct_type struct_type;
    /** No extensions in this version: NULL. */
    const void *next;
    /** Flags of the optional fields that are set. Default 0: everything is drawn. */
    wk_budget_has_flags has;
    /** Number of wishes. Default 0. Parts without a wish are planned with their default importance. */
    uint32_t wish_count;
    /** Bytes from one wish to the next: sizeof(wk_part_wish) of your header, which is the default. */
    uint32_t wish_stride;
    /** Must be 0. */
    uint32_t reserved;
    /** Wishes for single parts, at most one for each part; read during the call only. Default NULL. */
    const wk_part_wish *wishes;
    /** Optional: largest error that leaving parts out may cause. Range (0, 1]; an error of 0.01 is not visible. */
    double tolerance;
    /**
     * Optional: longest time that the weather may take in a frame, ms; wins over the tolerance. Range (0, 1000]. The
     * plan knows times only from wk_view_report_time.
     */
    double milliseconds;
} wk_budget;

/** Every field of `wk_budget` at its default. */
#define WK_BUDGET_INIT { \
    /* struct_size */ (uint32_t)sizeof(wk_budget), \
    /* struct_type */ WK_STRUCT_TYPE_BUDGET, \
    /* next */ NULL, \
    /* has */ 0, \
    /* wish_count */ 0, \
    /* wish_stride */ (uint32_t)sizeof(wk_part_wish), \
    /* reserved */ 0, \
    /* wishes */ NULL, \
    /* tolerance */ 0.0, \
    /* milliseconds */ 0.0 \
}

/** A budget's limit that the picture exceeds, according to the estimates. */
typedef uint32_t wk_gave_way;

/** Nothing had to give way. */
#define WK_GAVE_WAY_NOTHING 0
/** The tolerance: a better picture would take longer than the budget allows. */
#define WK_GAVE_WAY_TOLERANCE 1
/**
 * Time and the tolerance: the picture takes longer than the budget allows, even if all parts that are not pinned are
 * left out.
 */
#define WK_GAVE_WAY_TIME 2

/**
 * Plan of a view's last frame: the errors due to the parts that the frame left out, and the frame's cost. Errors are
 * estimates from the gauged pixels.
 */
typedef struct wk_plan {
    /** sizeof(wk_plan) of your header. */
    uint32_t struct_size;
    /** WK_STRUCT_TYPE_PLAN. */
    wk_struct_type struct_type;
    /** No extensions in this version: NULL. */
    const void *next;
    /** Number of parts. Parts are numbered from 0. */
    uint32_t part_count;
    /** The budget's limit that could not be kept. */
    wk_gave_way gave_way;
    /** Error of everything left out together: 95th percentile over the gauged pixels. */
    double error;
    /** Upper bound, with 95 % confidence, of the 95th percentile over all pixels. */
    double error_bound;
    /** Error of the worst gauged pixel. */
    double worst;
    /**
     * Work of the picture as planned, in units of the work of one pixel without any part; 0 before the first gauge.
     */
    double work;
    /** Work of the picture with everything, in the same units. */
    double work_of_everything;
    /** Time of the picture predicted from the times reported so far, ms; 0 before the first report. */
    double milliseconds;
} wk_plan;

/** Every field of `wk_plan` at its default. */
#define WK_PLAN_INIT { \
    /* struct_size */ (uint32_t)sizeof(wk_plan), \
    /* struct_type */ WK_STRUCT_TYPE_PLAN, \
    /* next */ NULL, \
    /* part_count */ 0, \
    /* gave_way */ 0, \
    /* error */ 0.0, \
    /* error_bound */ 0.0, \
    /* worst */ 0.0, \
    /* work */ 0.0, \
    /* work_of_everything */ 0.0, \
    /* milliseconds */ 0.0 \
}

/** Reason for the rung at which a part is drawn. */
typedef uint32_t wk_plan_reason;

/** No tolerance was given: everything is drawn. */
#define WK_PLAN_REASON_EVERYTHING_ASKED 0
/** This picture has not been gauged yet, or must not depend on earlier ones: everything is drawn. */
#define WK_PLAN_REASON_NOT_GAUGED 1
/** The weather does not have this part, or the recorded stages do not draw it. */
#define WK_PLAN_REASON_ABSENT 2
/** The error would exceed the tolerance with less of the part. */
#define WK_PLAN_REASON_NEEDED 3
/** The error with less of the part is within the tolerance. */
#define WK_PLAN_REASON_WITHIN_TOLERANCE 4
/** The host pinned the part. */
#define WK_PLAN_REASON_PINNED 5
/** The budget of time allows no more of the part. */
#define WK_PLAN_REASON_OUT_OF_TIME 6

/** One part of a plan. */
typedef struct wk_part_plan {
    /** sizeof(wk_part_plan) of your header. */
    uint32_t struct_size;
    /** WK_STRUCT_TYPE_PART_PLAN. */
    wk_struct_type struct_type;
    /** No extensions in this version: NULL. */
    const void *next;
    /** Reason for the rung. */
    wk_plan_reason reason;
    /** Rung at which the part is drawn once fading is over; 0, all of it, if the weather does not have the part. */
    uint32_t rung;
    /** Number of the part's rungs. */
    uint32_t rung_count;
    /** Always 0. */
    uint32_t reserved;
    /**
     * Name of the part in saved plans and messages, UTF-8. This text, rung_name and reason_text live as long as the
     * process.
     */
    const char *name;
    /** Name of the rung. */
    const char *rung_name;
    /** Reason in a few words of English. */
    const char *reason_text;
    /** Importance that the part has unless a budget sets another. */
    double importance;
    /**
     * Share of the part that is drawn: 1 all of it, 0 its last rung; between 0 and 1 while the part fades, or on a
     * rung between the first and the last.
     */
    double share;
    /** Error that the picture would have if this part alone were drawn at its last rung, as of the last gauge. */
    double error;
    /**
     * Error that the worst gauged pixel would have if this part alone were drawn at its last rung, as of the last
     * gauge.
     */
    double worst;
    /**
     * Work that the whole part adds, or would add, to this picture with everything, in the units of wk_plan.work.
     */
    double work;
} wk_part_plan;

/** Every field of `wk_part_plan` at its default. */
#define WK_PART_PLAN_INIT { \
    /* struct_size */ (uint32_t)sizeof(wk_part_plan), \
    /* struct_type */ WK_STRUCT_TYPE_PART_PLAN, \
    /* next */ NULL, \
    /* reason */ 0, \
    /* rung */ 0, \
    /* rung_count */ 0, \
    /* reserved */ 0, \
    /* name */ NULL, \
    /* rung_name */ NULL, \
    /* reason_text */ NULL, \
    /* importance */ 0.0, \
    /* share */ 0.0, \
    /* error */ 0.0, \
    /* worst */ 0.0, \
    /* work */ 0.0 \
}

/**
 * Sets the limits for the view's pictures: tolerance and time. NULL removes them, and everything is drawn again. After
 * an error the previous limits stay.
 * Thread: exclusive on the view.
 * Errors: WK_ERROR_INVALID_ARGUMENT naming the field and its range.
 */
WK_API
wk_status wk_view_set_budget(wk_view *view,
                             const wk_budget *budget);

/**
 * Reports the time that the weather took in the last frame, ms, in (0, 1e5]. Measure the time in the same way as you
 * chose the budget: with a GPU timer, or around a call whose end you wait for. Under a budget of time the plan uses
 * the median of the last five reports.
 * Thread: exclusive on the view.
 * Errors: WK_ERROR_INVALID_ARGUMENT outside of (0, 1e5] ms; nothing changes then.
 */
WK_API wk_status wk_view_report_time(wk_view *view, double milliseconds);

/**
 * Gets the plan of the view's last frame.
 * Thread: exclusive on the view.
 */
WK_API wk_status wk_view_get_plan(wk_view *view, wk_plan *out_plan);

/**
 * Gets how much of one part the view's last frame drew, and why. The part's name can be read before any frame too.
 * Thread: exclusive on the view.
 * Errors: WK_ERROR_INVALID_ARGUMENT for a number that no part has.
 */
WK_API wk_status wk_view_get_part_plan(wk_view *view, wk_part part, wk_part_plan *out_part);

/**
 * Writes the view's plan as UTF-8 text: the rung of each part, and the settings of the sky. wk_view_load_plan reads
 * the text, also in other views or on another day. `*out_size` always gets the number of bytes needed. If `capacity`
 * is too small, nothing else is written and the call fails; with `buffer` NULL and `capacity` 0 it succeeds.
 * Thread: exclusive on the view.
 * Errors: WK_ERROR_WRONG_ORDER while the view has a budget but has not gauged its picture yet: for some frames after
 * each jump of camera, sun or weather.
 */
WK_API wk_status wk_view_save_plan(wk_view *view, void *buffer, size_t capacity, size_t *out_size);

/**
 * Pins every part at its rung in a plan that wk_view_save_plan wrote, as wishes with WK_PART_WISH_HAS_RUNG do. The
 * rest of the view's budget stays; wk_view_set_budget removes the pins.
 * Thread: exclusive on the view.
 * Errors: WK_ERROR_PARSE for bytes that are no saved plan, or that are a plan of another version, naming line and
 * column or the field; WK_ERROR_INVALID_ARGUMENT naming the setting of the sky that differs between the plan and the
 * view's context. After an error the view's plan stays as it was.
 */
WK_API wk_status wk_view_load_plan(wk_view *view, const void *plan, size_t size);

/**
 * Writes the default of every field: the same bytes as `WK_PART_WISH_INIT`. `struct_size` is `sizeof(wk_part_wish)`
 * as the caller was compiled, and is stored in the struct.
 */
WK_API wk_status wk_part_wish_init(wk_part_wish *out, uint32_t struct_size);

/**
 * Writes the default of every field: the same bytes as `WK_BUDGET_INIT`. `struct_size` is `sizeof(wk_budget)`
 * as the caller was compiled, and is stored in the struct.
 */
WK_API wk_status wk_budget_init(wk_budget *out, uint32_t struct_size);

/**
 * Writes the default of every field: the same bytes as `WK_PLAN_INIT`. `struct_size` is `sizeof(wk_plan)`
 * as the caller was compiled, and is stored in the struct.
 */
WK_API wk_status wk_plan_init(wk_plan *out, uint32_t struct_size);

/**
 * Writes the default of every field: the same bytes as `WK_PART_PLAN_INIT`. `struct_size` is `sizeof(wk_part_plan)`
 * as the caller was compiled, and is stored in the struct.
 */
WK_API wk_status wk_part_plan_init(wk_part_plan *out, uint32_t struct_size);

/*
 * ====================================================================================================
 * [rain] Rain
 *
 * WK_STAGE_PARTICLES draws rain wherever the weather has it. The rate decides how many drops fall and how fast. Near
 * drops are drawn one by one, farther ones as streaks on cones around the camera. Both depend only on seed and time,
 * so all channels of a simulator draw the same rain and any time can be shown again. Only drops that follow a wind
 * varying in space depend on the frames drawn before. The wind carries the drops; the host's depth hides them; sky,
 * ground, sun and lamps light them. Drops splash on the surfaces that the picture shows within ten metres of the
 * camera.
 *
 * Give boxes that keep rain off: a roof, a bridge deck, a cab, a truck. A drop whose own path crossed a box is not
 * drawn, whatever the wind. The windward side of a box is therefore wet; its lee side and its inside are dry. Planes
 * cut a box to any convex shape (wk_shelter_shape): a gable roof, a cab with a slanted front.
 * ====================================================================================================
 */

/**
 * Value of wk_rain.shutter_s for the eye, which integrates light over about this time by day. Streaks are long and
 * faint.
 */
#define WK_RAIN_SHUTTER_EYE_S 0.05

/**
 * Value of wk_rain.shutter_s for a video camera at 60 frames a second with its shutter open for a whole frame: the
 * default.
 */
#define WK_RAIN_SHUTTER_CAMERA_60_S 0.016666666666666666

/** Value of wk_rain.shutter_s for a camera in good light. Streaks are short. */
#define WK_RAIN_SHUTTER_CAMERA_500_S 0.002

/** Value of wk_rain.contrast_gain for trainers: on an 8-bit display rain by day is then as visible as in a film. */
#define WK_RAIN_GAIN_TRAINER 4.0

/** Way in which a view draws rain. The rain that falls does not depend on it. */
typedef uint32_t wk_rain_model;

/**
 * Welkin chooses: single drops to 1.9 m and cones to 14.8 m. With a wk_budget, Welkin draws less rain where the
 * picture does not need more or the time does not allow more (WK_PART_RAIN). Near a wind that varies in space
 * (wk_context_set_wind_grid, wk_context_set_wind_field) the drops follow that wind, on devices with compute shaders.
 */
#define WK_RAIN_MODEL_AUTOMATIC 0
/** No drops: all rain is extinction in the air. */
#define WK_RAIN_MODEL_VEIL 1
/**
 * Streaks on three nested cones around the camera, without splashes. This is the cheapest moving rain without compute
 * shaders (wk_caps.tier 0). Its cost depends only on the picture's size.
 */
#define WK_RAIN_MODEL_CONES 2
/**
 * Single drops to 4 m, each at a place that seed and time give; cones beyond 4 m only where lamps light the rain.
 */
#define WK_RAIN_MODEL_DROPS 3
/** Drops to 4 m that follow a wind varying in space, step by step. Needs compute shaders (wk_caps.tier 1). */
#define WK_RAIN_MODEL_INTEGRATED 4

/** Settings for drawing rain, hail and splashes in a view. The precipitation itself does not depend on them. */
typedef struct wk_rain {
    /** sizeof(wk_rain) of your header. */
    uint32_t struct_size;
    /** WK_STRUCT_TYPE_RAIN. */
    wk_struct_type struct_type;
    /** No extensions in this version: NULL. */
    const void *next;
    /**
     * Exposure time of a picture, s. Longer exposure makes streaks longer and fainter (WK_RAIN_SHUTTER_ constants).
     * Range [1e-4, 0.1], default 1/60.
     */
    double shutter_s;
    /**
     * Largest number of drops to draw; if more fall, each drawn drop represents several. Range [1000, 8 000 000], or
     * 0, the default: 400 000, and 100 000 on a software driver.
     */
    uint32_t most_drops;
    /** A WK_RAIN_MODEL_ constant; 0, the default, lets Welkin choose. */
    wk_rain_model model;
    /**
     * Contrast of rain relative to nature. Range [1, 16], or 0, the default: 1, as in nature. With a gain of g, one
     * streak, stone or splash hides as much of the background as g of them one behind another would. This departs from
     * physics, for displays on which rain by day cannot be seen otherwise (WK_RAIN_GAIN_TRAINER). Light, visibility,
     * water and queries do not depend on the gain. Set the same value on all channels of a simulator.
     */
    double contrast_gain;
} wk_rain;

/** Every field of `wk_rain` at its default. */
#define WK_RAIN_INIT { \
    /* struct_size */ (uint32_t)sizeof(wk_rain), \
    /* struct_type */ WK_STRUCT_TYPE_RAIN, \
    /* next */ NULL, \
    /* shutter_s */ 0.016666666666666666, \
    /* most_drops */ 0, \
    /* model */ WK_RAIN_MODEL_AUTOMATIC, \
    /* contrast_gain */ 0.0 \
}

/** A box that keeps rain off, in the host's world. */
typedef struct wk_shelter {
    /** sizeof(wk_shelter) of your header. */
    uint32_t struct_size;
    /** WK_STRUCT_TYPE_SHELTER. */
    wk_struct_type struct_type;
    /** NULL (the default), or a wk_shelter_shape. */
    const void *next;
    /** Centre, m, within 1e12 m of the origin. Default 0, 0, 0. */
    double center_m[3];
    /** Three axes, one after the other: unit vectors at right angles. Default: the world's axes. */
    double axes[9];
    /** Half the size along each axis, m. Range [1e-3, 1e5], default 1, 1, 1. */
    double half_size_m[3];
    /**
     * Velocity, m/s; its length is at most 2000. Default 0, 0, 0. A box faster than 0.1 m/s keeps neither rain nor
     * snow off the ground below it.
     */
    double velocity_m_s[3];
} wk_shelter;

/** Every field of `wk_shelter` at its default. */
#define WK_SHELTER_INIT { \
    /* struct_size */ (uint32_t)sizeof(wk_shelter), \
    /* struct_type */ WK_STRUCT_TYPE_SHELTER, \
    /* next */ NULL, \
    /* center_m */ { 0.0, 0.0, 0.0 }, \
    /* axes */ { 1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0 }, \
    /* half_size_m */ { 1.0, 1.0, 1.0 }, \
    /* velocity_m_s */ { 0.0, 0.0, 0.0 } \
}

/**
 * Planes that cut a wk_shelter to another convex shape. An extension: put it into wk_shelter.next. The part of the box
 * beyond any plane does not keep rain off. Describe a convex shape by the box around it and the planes of its faces.
 */
typedef struct wk_shelter_shape {
    /** sizeof(wk_shelter_shape) of your header. */
    uint32_t struct_size;
    /** WK_STRUCT_TYPE_SHELTER_SHAPE. */
    wk_struct_type struct_type;
    /** No extensions in this version: NULL. */
    const void *next;
    /** Number of planes. Range [0, 16], default 0: the box stays whole. */
    uint32_t plane_count;
    /** Must be 0. */
    uint32_t reserved0;
    /**
     * Four numbers for each plane: a unit normal in the box's axes that points out of the shape, and the plane's
     * distance from the box's centre along this normal, m, within 1e6. The planes must leave some of the box. Default
     * 0.
     */
    double planes[64];
} wk_shelter_shape;

/** Every field of `wk_shelter_shape` at its default. */
#define WK_SHELTER_SHAPE_INIT { \
    /* struct_size */ (uint32_t)sizeof(wk_shelter_shape), \
    /* struct_type */ WK_STRUCT_TYPE_SHELTER_SHAPE, \
    /* next */ NULL, \
    /* plane_count */ 0, \
    /* reserved0 */ 0, \
    /* planes */ { 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0 } \
}

/**
 * Sets how the view draws rain; NULL returns to the default. Unchanged after an error.
 * Thread: exclusive on the view.
 * Errors: WK_ERROR_INVALID_ARGUMENT naming the field and its range; WK_ERROR_UNSUPPORTED for a model that the device
 * cannot draw, or for more drops than it can draw with the model.
 */
WK_API wk_status wk_view_set_rain(wk_view *view, const wk_rain *rain);

/**
 * Sets the boxes that keep rain off, at most 32, and replaces those set before; count 0 removes all. Set moving boxes
 * again in every frame. Unchanged after an error.
 * Thread: exclusive.
 * Errors: WK_ERROR_INVALID_ARGUMENT naming the element, its field and range.
 */
WK_API
wk_status wk_context_set_shelters(wk_context *context,
                                  const wk_shelter *shelters,
                                  uint32_t count,
                                  uint32_t stride);

/**
 * Writes the default of every field: the same bytes as `WK_RAIN_INIT`. `struct_size` is `sizeof(wk_rain)`
 * as the caller was compiled, and is stored in the struct.
 */
WK_API wk_status wk_rain_init(wk_rain *out, uint32_t struct_size);

/**
 * Writes the default of every field: the same bytes as `WK_SHELTER_INIT`. `struct_size` is `sizeof(wk_shelter)`
 * as the caller was compiled, and is stored in the struct.
 */
WK_API wk_status wk_shelter_init(wk_shelter *out, uint32_t struct_size);

/**
 * Writes the default of every field: the same bytes as `WK_SHELTER_SHAPE_INIT`. `struct_size` is `sizeof(wk_shelter_shape)`
 * as the caller was compiled, and is stored in the struct.
 */
WK_API
wk_status wk_shelter_shape_init(wk_shelter_shape *out,
                                uint32_t struct_size);

/*
 * ====================================================================================================
 * [snow] Snow
 *
 * WK_STAGE_PARTICLES draws falling snow wherever the weather has it. Rate, kind and temperature give the sizes and
 * speeds of the flakes; seed and time alone give their places, so all channels of a simulator draw the same flakes.
 * Only flakes near a wind that varies in space depend on the frames drawn before. The wind carries the flakes; the
 * host's depth hides them; none fall under shelters and occluder maps; sky, ground, sun and lamps light them. Farther
 * away than flakes reach (wk_snow.most_flakes), snow is extinction in the air.
 * ====================================================================================================
 */

/** Way in which a view draws falling snow. The snow that falls does not depend on it. */
typedef uint32_t wk_snow_model;

/**
 * Flakes near the camera. With a wk_budget there are none where the picture does not need them or the time does not
 * allow them (WK_PART_SNOW).
 */
#define WK_SNOW_MODEL_AUTOMATIC 0
/** No flakes: all snow is extinction in the air. */
#define WK_SNOW_MODEL_VEIL 1
/** Flakes, whatever a budget says. */
#define WK_SNOW_MODEL_FLAKES 2

/** Settings for drawing falling snow in a view. The snow that falls does not depend on them. */
typedef struct wk_snow {
    /** sizeof(wk_snow) of your header. */
    uint32_t struct_size;
    /** WK_STRUCT_TYPE_SNOW. */
    wk_struct_type struct_type;
    /** No extensions in this version: NULL. */
    const void *next;
    /**
     * Exposure time of a picture, s: flakes that move farther than their own size in this time become streaks. Range
     * [1e-4, 0.1], default 1/250, at which flakes in a light wind show their shapes.
     */
    double shutter_s;
    /**
     * Largest number of flakes to draw. A larger number lets flakes reach farther from the camera, up to 16 m. If more
     * flakes fall than may be drawn, each drawn flake represents several. Range [1000, 8 000 000], or 0, the default:
     * 1 000 000, and 60 000 on a software driver.
     */
    uint32_t most_flakes;
    /** A WK_SNOW_MODEL_ constant; 0, the default, lets Welkin choose. */
    wk_snow_model model;
} wk_snow;

/** Every field of `wk_snow` at its default. */
#define WK_SNOW_INIT { \
    /* struct_size */ (uint32_t)sizeof(wk_snow), \
    /* struct_type */ WK_STRUCT_TYPE_SNOW, \
    /* next */ NULL, \
    /* shutter_s */ 0.004, \
    /* most_flakes */ 0, \
    /* model */ WK_SNOW_MODEL_AUTOMATIC \
}

/**
 * Sets how the view draws falling snow; NULL returns to the default. Unchanged after an error.
 * Thread: exclusive on the view.
 * Errors: WK_ERROR_INVALID_ARGUMENT naming the field and its range.
 */
WK_API wk_status wk_view_set_snow(wk_view *view, const wk_snow *snow);

/**
 * Writes the default of every field: the same bytes as `WK_SNOW_INIT`. `struct_size` is `sizeof(wk_snow)`
 * as the caller was compiled, and is stored in the struct.
 */
WK_API wk_status wk_snow_init(wk_snow *out, uint32_t struct_size);

/*
 * ====================================================================================================
 * [area] Rain areas
 *
 * Rain areas have rain of their own: a passing shower, a squall line, a dry hole in steady rain. Inside an area its
 * rain replaces the weather's rain and drizzle. The change is smooth over the rim, a band inside the area's border.
 * Where areas overlap, a later one in the list covers the earlier ones. Around a camera in or near a rim, the number
 * of drops varies from place to place with the rain rate. Seen from outside, an area is a shaft with falling curtains.
 * The shaft leans because the drops lag behind the moving cloud. All queries of rain and visibility include the areas,
 * and so does the ground's wetness (with WK_GROUND_REPORTED too). Where clouds are a volume (WK_CLOUD_MODEL_VOLUME),
 * an area with at least 0.05 mm/h of rain has cloud above it, unless a closed layer hides the sky. wk_context_save
 * keeps the areas.
 * ====================================================================================================
 */

/** Kind of rain in a rain area. */
typedef uint32_t wk_area_rain;

/** Steady rain. */
#define WK_AREA_RAIN_STEADY 0
/** Showers: fewer and larger drops. */
#define WK_AREA_RAIN_SHOWERS 1
/** Drizzle. */
#define WK_AREA_RAIN_DRIZZLE 2

/** Motion of a rain area. */
typedef uint32_t wk_area_motion;

/** Motion by the displacement of the wind at 10 m, gusts included. */
#define WK_AREA_MOTION_WITH_WIND 0
/** Motion at the area's own velocity. */
#define WK_AREA_MOTION_OWN 1

/** Kind of snow in a rain area. */
typedef uint32_t wk_area_snow;

/** No snow. */
#define WK_AREA_SNOW_NONE 0
/** Flakes. Not in this version. */
#define WK_AREA_SNOW_FLAKES 1
/** Snow grains. Not in this version. */
#define WK_AREA_SNOW_GRAINS 2
/** Snow pellets. Not in this version. */
#define WK_AREA_SNOW_PELLETS 3

/** An area with rain of its own. */
typedef struct wk_rain_area {
    /** sizeof(wk_rain_area) of your header. */
    uint32_t struct_size;
    /** WK_STRUCT_TYPE_RAIN_AREA. */
    wk_struct_type struct_type;
    /** No extensions in this version: NULL. */
    const void *next;
    /**
     * Centre in the host's world at the time at_s, m, within 1e12 m of the origin; the height has no effect. Default
     * 0, 0, 0.
     */
    double center_m[3];
    /**
     * Half extents of the ellipse to the right of the heading and along the heading, m. Range [10, 1e6], default 2000,
     * 2000.
     */
    double semi_axes_m[2];
    /**
     * Corners of a polygon that replaces the ellipse, in clockwise or counter-clockwise order. Each corner is two
     * numbers: its distances from the centre to the right of the heading and along the heading, m, within 1e6. The
     * polygon must be convex and larger than 1 m^2. Default 0.
     */
    double corners_m[16];
    /** Number of corners of the polygon, [3, 8], or 0, the default, for the ellipse. */
    uint32_t corner_count;
    /** Kind of rain. Default WK_AREA_RAIN_STEADY. */
    wk_area_rain rain;
    /** Heading of the shape, degrees clockwise from true north. Range [-360, 360], default 0. */
    double heading_deg;
    /**
     * Width of the band inside the border over which the rain fades, m. Range [1, 1e6]; at most the smaller half
     * extent of an ellipse, or the radius of the largest circle in a polygon. Default 500.
     */
    double rim_m;
    /** Rain rate at the ground, mm/h; 0 makes a dry hole. Range [0, 500], default 10. */
    double rate_mm_h;
    /**
     * Altitude of the cloud base above mean sea level (not above the ground), m. Above it no rain falls inside the
     * area: neither the area's nor, except in the rim, the weather's. Range [-1000, 20 000], default 1500.
     */
    double top_m;
    /**
     * Velocity of the area towards the east and towards the north, m/s, each within [-200, 200]. It is used with
     * WK_AREA_MOTION_OWN. Default 0, 0.
     */
    double velocity_m_s[2];
    /**
     * Simulation time at which the centre is at center_m, s. Range [-1e10, 1e10], default 0. With
     * WK_AREA_MOTION_WITH_WIND it must be 0 or a time that the timeline still knows.
     */
    double at_s;
    /** Motion of the area. Default WK_AREA_MOTION_WITH_WIND. */
    wk_area_motion motion;
    /** Snow that falls in place of the rain. Default WK_AREA_SNOW_NONE, the only value that this version accepts. */
    wk_area_snow snow;
} wk_rain_area;

/** Every field of `wk_rain_area` at its default. */
#define WK_RAIN_AREA_INIT { \
    /* struct_size */ (uint32_t)sizeof(wk_rain_area), \
    /* struct_type */ WK_STRUCT_TYPE_RAIN_AREA, \
    /* next */ NULL, \
    /* center_m */ { 0.0, 0.0, 0.0 }, \
    /* semi_axes_m */ { 2000.0, 2000.0 }, \
    /* corners_m */ { 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0 }, \
    /* corner_count */ 0, \
    /* rain */ WK_AREA_RAIN_STEADY, \
    /* heading_deg */ 0.0, \
    /* rim_m */ 500.0, \
    /* rate_mm_h */ 10.0, \
    /* top_m */ 1500.0, \
    /* velocity_m_s */ { 0.0, 0.0 }, \
    /* at_s */ 0.0, \
    /* motion */ WK_AREA_MOTION_WITH_WIND, \
    /* snow */ WK_AREA_SNOW_NONE \
}

/**
 * Replaces the list of rain areas, at most 16; count 0 removes all. Areas move by themselves: set them again only to
 * change them. A failed call changes nothing.
 * Thread: exclusive.
 * Errors: WK_ERROR_INVALID_ARGUMENT naming the element, its field and range; WK_ERROR_UNSUPPORTED for snow.
 */
WK_API
wk_status wk_context_set_rain_areas(wk_context *context,
                                    const wk_rain_area *areas,
                                    uint32_t count,
                                    uint32_t stride);

/**
 * Writes the default of every field: the same bytes as `WK_RAIN_AREA_INIT`. `struct_size` is `sizeof(wk_rain_area)`
 * as the caller was compiled, and is stored in the struct.
 */
WK_API wk_status wk_rain_area_init(wk_rain_area *out, uint32_t struct_size);

/*
 * ====================================================================================================
 * [region] Weather regions
 *
 * Weather regions have a weather of their own: a fog bank, a shower of snow, a sandstorm, a front. A region has a
 * shape on the ground plan, a wk_weather, and a perimeter outside the shape, over which the region's weather fades
 * into the weather around it. The region's field `has` lists the parts of that weather that hold in the region. At
 * each place, queries and the picture of a camera there use the weather that all regions there give together. Queries
 * between two points integrate the extinction of all regions on the way. Regions move at their own velocity, never
 * with the wind; a host may also set them again in every frame. wk_context_save keeps them. Channels of a simulator
 * that set the same regions have the same weather.
 *
 * Where regions overlap, a later one in the list replaces the earlier ones in the parts that it has. Parts that
 * several regions list in `merges` are averaged by these regions' weights. The averages are those of extinction (not
 * visibility), rates, temperatures and wind vectors. A camera's picture shows the fog of all regions; the rest of its
 * weather is that at the camera. docs/regions.md has the rules, a table of what differs by place, and the quantities
 * that do not differ yet.
 * ====================================================================================================
 */

/** Parts of the weather. */
typedef uint32_t wk_weather_part_flags;

/** Haze: visibility_m without fog and precipitation, and the aerosol fields. */
#define WK_WEATHER_PART_HAZE 1
/**
 * Low layer: fog or mist with its top, or matter that the wind lifts. In a region without WK_WEATHER_PART_HAZE, this
 * layer lies in the haze of the weather around the region.
 */
#define WK_WEATHER_PART_FOG 2
/** Precipitation of all kinds. */
#define WK_WEATHER_PART_PRECIPITATION 4
/** Thunder, as queries report it. Flashes follow the weather outside all regions. */
#define WK_WEATHER_PART_LIGHTNING 8
/** Temperature. */
#define WK_WEATHER_PART_TEMPERATURE 16
/** Humidity. */
#define WK_WEATHER_PART_HUMIDITY 32
/** Pressure. */
#define WK_WEATHER_PART_PRESSURE 64
/** Wind, its gusts, and vertical_wind_m_s. */
#define WK_WEATHER_PART_WIND 128
/** Cloud layers, and the overrides of the cloud light. */
#define WK_WEATHER_PART_CLOUDS 256
/** Water, ice and snow on the ground. */
#define WK_WEATHER_PART_SURFACE 512
/** Sea. */
#define WK_WEATHER_PART_SEA 1024

/** Shape of a weather region. */
typedef uint32_t wk_region_shape;

/** Ellipse of the half extents half_size_m. */
#define WK_REGION_SHAPE_ELLIPSE 0
/** Rectangle of the half extents half_size_m with round corners of corner_radius_m. */
#define WK_REGION_SHAPE_RECTANGLE 1
/** Polygon of corner_count corners. */
#define WK_REGION_SHAPE_POLYGON 2

/** Region with a weather of its own. */
typedef struct wk_weather_region {
    /** sizeof(wk_weather_region) of your header. */
    uint32_t struct_size;
    /** WK_STRUCT_TYPE_WEATHER_REGION. */
    wk_struct_type struct_type;
    /** No extensions in this version: NULL. */
    const void *next;
    /** Parts of `weather` that the region has. Default 0. */
    wk_weather_part_flags has;
    /**
     * Parts that are averaged with those of earlier regions that merge them too. In all other parts that it has, the
     * region replaces the earlier regions of the list. Default 0.
     */
    wk_weather_part_flags merges;
    /**
     * Weather inside the region, with its overrides in its chain; NULL, the default, is that of WK_WEATHER_INIT. Its
     * heights are above the station of the weather outside; station_altitude_m, the runway visual range and the ozone
     * column have no effect. Read during the call only.
     */
    const wk_weather *weather;
    /**
     * Centre in the host's world at the time at_s, m, within 1e12 m of the origin; its height has no effect. Default
     * 0, 0, 0.
     */
    double center_m[3];
    /**
     * Half extents of an ellipse or a rectangle to the right of the heading and along the heading, m. Range [1, 1e6],
     * default 2000, 2000.
     */
    double half_size_m[2];
    /** Radius of a rectangle's corners, m. Range [0, 1e6], at most the smaller half extent. Default 0. */
    double corner_radius_m;
    /**
     * Corners of a polygon, in clockwise or counter-clockwise order, convex or not. Each corner is two numbers: its
     * distances from the centre to the right of the heading and along the heading, m, within 1e6. A side must not
     * cross or touch any other, except its neighbours at their common corners. The area must be larger than 1 m^2.
     * Default 0.
     */
    double corners_m[32];
    /** Number of corners of a polygon, [3, 16]; ignored for other shapes. Default 0. */
    uint32_t corner_count;
    /** Shape. Default WK_REGION_SHAPE_ELLIPSE. */
    wk_region_shape shape;
    /** Heading of the shape, degrees clockwise from true north. Range [-360, 360], default 0. */
    double heading_deg;
    /**
     * Width of the band outside the shape over which the region's weather fades, m. Range [0, 1e6]; 0 is a step at the
     * border. Default 500.
     */
    double perimeter_m;
    /** Velocity to the east and north, m/s. Range [-400, 400] each, default 0, 0. */
    double velocity_m_s[2];
    /** Simulation time at which the centre is at center_m, s. Range [-1e10, 1e10], default 0. */
    double at_s;
    /** Share by which the region acts, to fade it in and out. Range [0, 1], default 1. */
    double strength;
    /**
     * Upward velocity of the wind 100 m or more above the station, m/s. Lower down it decreases linearly to 0 at the
     * station's height. Without WK_WEATHER_PART_WIND in `has` it has no effect. Range [-50, 50], default 0.
     */
    double vertical_wind_m_s;
} wk_weather_region;

/** Every field of `wk_weather_region` at its default. */
#define WK_WEATHER_REGION_INIT { \
    /* struct_size */ (uint32_t)sizeof(wk_weather_region), \
    /* struct_type */ WK_STRUCT_TYPE_WEATHER_REGION, \
    /* next */ NULL, \
    /* has */ 0, \
    /* merges */ 0, \
    /* weather */ NULL, \
    /* center_m */ { 0.0, 0.0, 0.0 }, \
    /* half_size_m */ { 2000.0, 2000.0 }, \
    /* corner_radius_m */ 0.0, \
    /* corners_m */ { 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0 }, \
    /* corner_count */ 0, \
    /* shape */ WK_REGION_SHAPE_ELLIPSE, \
    /* heading_deg */ 0.0, \
    /* perimeter_m */ 500.0, \
    /* velocity_m_s */ { 0.0, 0.0 }, \
    /* at_s */ 0.0, \
    /* strength */ 1.0, \
    /* vertical_wind_m_s */ 0.0 \
}

/**
 * Replaces the list of weather regions, at most 64; count 0 removes all. Regions move at their velocity by themselves.
 * Set them again to change them; you may also do so in every frame, at their new places. Unchanged after an error.
 * Copied during the call.
 * Thread: exclusive.
 * Errors: WK_ERROR_INVALID_ARGUMENT naming the element, its field and range, also for a polygon whose sides cross or a
 * corner radius larger than the smaller half extent.
 */
WK_API
wk_status wk_context_set_weather_regions(wk_context *context,
                                         const wk_weather_region *regions,
                                         uint32_t count,
                                         uint32_t stride);

/**
 * Writes the default of every field: the same bytes as `WK_WEATHER_REGION_INIT`. `struct_size` is `sizeof(wk_weather_region)`
 * as the caller was compiled, and is stored in the struct.
 */
WK_API
wk_status wk_weather_region_init(wk_weather_region *out,
                                 uint32_t struct_size);

/*
 * ====================================================================================================
 * [air] Air at a height
 *
 * Welkin computes temperature, humidity and pressure at any place and altitude from the weather's values at the
 * station, by the laws of the standard atmosphere.
 * ====================================================================================================
 */

/** Air at a place and altitude. */
typedef struct wk_air {
    /** sizeof(wk_air) of your header. */
    uint32_t struct_size;
    /** WK_STRUCT_TYPE_AIR. */
    wk_struct_type struct_type;
    /** No extensions in this version: NULL. */
    const void *next;
    /**
     * Temperature, degrees Celsius. It equals the station's temperature at the station's altitude, falls by 6.5 K/km
     * from there up to 11 km above sea level, and is constant above 11 km.
     */
    double temperature_c;
    /**
     * Relative humidity over water, 0 to 1. The density of water vapour falls by a factor e every 2 km (ITU-R P.835).
     */
    double relative_humidity;
    /** Pressure, hPa, in hydrostatic equilibrium (ICAO Doc 7488). */
    double pressure_hpa;
    /** Density of the air, taken as dry, kg/m^3. */
    double density_kg_m3;
} wk_air;

/** Every field of `wk_air` at its default. */
#define WK_AIR_INIT { \
    /* struct_size */ (uint32_t)sizeof(wk_air), \
    /* struct_type */ WK_STRUCT_TYPE_AIR, \
    /* next */ NULL, \
    /* temperature_c */ 0.0, \
    /* relative_humidity */ 0.0, \
    /* pressure_hpa */ 0.0, \
    /* density_kg_m3 */ 0.0 \
}

/**
 * Gets temperature, humidity and pressure at a position and a past or future simulation time, with the weather regions
 * there. The answer is for the altitude of the position. The laws hold down to 1 km below the station; lower positions
 * have the air at 1 km below the station.
 * Thread: concurrent.
 * Errors: as wk_context_get_conditions.
 */
WK_API
wk_status wk_context_get_air(const wk_context *context,
                             const double (*position_m)[3],
                             double time_s,
                             wk_air *out_air);

/**
 * Writes the default of every field: the same bytes as `WK_AIR_INIT`. `struct_size` is `sizeof(wk_air)`
 * as the caller was compiled, and is stored in the struct.
 */
WK_API wk_status wk_air_init(wk_air *out, uint32_t struct_size);

/*
 * ====================================================================================================
 * [wind_grid] Wind that varies in space
 *
 * If you know how air flows around your buildings, over your deck or under your rotor, give the velocities on a grid.
 * The grid acts in wk_context_get_wind_at, in the rain on surfaces and windscreens, on drifting snow, on patches of
 * fog and dust, and on drops and flakes near a camera. It takes the place of a wind field (wk_context_set_wind_field).
 * Everything else follows the weather's wind.
 * ====================================================================================================
 */

/** Meaning of a grid's velocities. */
typedef uint32_t wk_wind_grid_kind;

/** The whole wind: replaces the weather's wind inside the grid. */
#define WK_WIND_GRID_WHOLE 0
/** A difference: added to the weather's wind. */
#define WK_WIND_GRID_ADDED 1

/**
 * Velocities of the air at the nodes of a grid that is level and aligned to true north, interpolated linearly between
 * nodes along each axis. Outside the grid the weather's wind blows: make the grid so large that the flow equals that
 * wind at its border.
 */
typedef struct wk_wind_grid {
    /** sizeof(wk_wind_grid) of your header. */
    uint32_t struct_size;
    /** WK_STRUCT_TYPE_WIND_GRID. */
    wk_struct_type struct_type;
    /** No extensions in this version: NULL. */
    const void *next;
    /**
     * Position of the lowest, south-western node, in the host's world, m, within 1e12 m of the origin. Default 0,
     * 0, 0.
     */
    double origin_m[3];
    /** Distance between nodes east, north and up, m. Range [0.01, 10 000], default 1, 1, 1. */
    double cell_m[3];
    /** Number of nodes east, north and up. Range 2 to 64 east and north, 2 to 32 up; default 2, 2, 2. */
    uint32_t nodes[3];
    /** A WK_WIND_GRID_ constant, default WK_WIND_GRID_WHOLE. */
    wk_wind_grid_kind kind;
    /**
     * Three numbers for each node (east, north, up), m/s, each vector of at most 300 m/s. Nodes run from west to east,
     * rows from south to north, levels upwards. Copied by the call.
     */
    const float *velocities_m_s;
    /** Number of nodes in velocities_m_s: the product of `nodes`. */
    uint32_t velocity_count;
    /** Must be 0. */
    uint32_t reserved0;
} wk_wind_grid;

/** Every field of `wk_wind_grid` at its default. */
#define WK_WIND_GRID_INIT { \
    /* struct_size */ (uint32_t)sizeof(wk_wind_grid), \
    /* struct_type */ WK_STRUCT_TYPE_WIND_GRID, \
    /* next */ NULL, \
    /* origin_m */ { 0.0, 0.0, 0.0 }, \
    /* cell_m */ { 1.0, 1.0, 1.0 }, \
    /* nodes */ { 2, 2, 2 }, \
    /* kind */ WK_WIND_GRID_WHOLE, \
    /* velocities_m_s */ NULL, \
    /* velocity_count */ 0, \
    /* reserved0 */ 0 \
}

/**
 * Sets the grid of a wind that varies in space, in place of the grid set before; NULL removes the grid. Unchanged
 * after an error.
 * Thread: exclusive.
 * Errors: WK_ERROR_INVALID_ARGUMENT naming the field and its range.
 */
WK_API wk_status wk_context_set_wind_grid(wk_context *context, const wk_wind_grid *wind_grid);

/**
 * Writes the default of every field: the same bytes as `WK_WIND_GRID_INIT`. `struct_size` is `sizeof(wk_wind_grid)`
 * as the caller was compiled, and is stored in the struct.
 */
WK_API wk_status wk_wind_grid_init(wk_wind_grid *out, uint32_t struct_size);

/*
 * ====================================================================================================
 * [wind_field] Wind round terrain and buildings
 *
 * A context can solve for the wind in a box of air about a place. The weather's wind enters the box, flows round the
 * terrain of wk_context_set_ground_grid or wk_context_set_terrain and round the boxes of wk_context_set_shelters,
 * including moving ones, and leaves on the downwind side. As a wind grid of your own does (wk_context_set_wind_grid),
 * the field acts in wk_context_get_wind_at, in the rain on surfaces and windscreens, on drifting snow, on patches of
 * fog and dust, and on drops and flakes near a camera. Without wk_context_set_wind_field nothing is solved.
 * ====================================================================================================
 */

/** Time dependence of a wind field. */
typedef uint32_t wk_wind_field_mode;

/**
 * The mean wind. The field is solved for in the first seconds of simulation time after the wind or an obstacle has
 * changed. Afterwards it rests at no cost. The weather's gusts are scaled in proportion to the local mean wind.
 */
#define WK_WIND_FIELD_STEADY 0
/**
 * The wind with its gusts and eddies, and with the eddies that obstacles shed, stepped all the time.
 * docs/wind-field.md says how much time a step takes on one CPU core.
 */
#define WK_WIND_FIELD_RUNNING 1

/** Friction of terrain and boxes on air that flows along them. */
typedef uint32_t wk_wind_walls;

/** Terrain and boxes slow the air, by the weather's roughness length. */
#define WK_WIND_WALLS_ROUGH 0
/** Air slides along terrain and boxes without friction. */
#define WK_WIND_WALLS_SMOOTH 1

/** Scheme by which the air of a wind field carries its own velocity. src/flow/mod.rs has the errors of each. */
typedef uint32_t wk_wind_scheme;

/**
 * Half a step of advection, a projection, a reflection about the projected field, another half step and a projection
 * (Zehnder et al. 2018). The interpolation is cubic and limited. Eddies keep their energy.
 */
#define WK_WIND_SCHEME_REFLECTION 0
/**
 * Linear interpolation along curved paths, corrected by the error that appears when the result is carried back (Selle
 * et al. 2008).
 */
#define WK_WIND_SCHEME_MACCORMACK 1
/** Linear interpolation along straight paths (Stam 1999): the cheapest; it smears eddies within seconds. */
#define WK_WIND_SCHEME_SEMI_LAGRANGIAN 2

/** Method that solves for the pressure of a wind field. */
typedef uint32_t wk_wind_pressure;

/** Conjugate gradients preconditioned by multigrid V-cycles, until the remaining divergence is small. */
#define WK_WIND_PRESSURE_MULTIGRID 0
/**
 * Red-black successive over-relaxation, until the remaining divergence is small or most_iterations is reached. With
 * few iterations air is made and lost behind obstacles.
 */
#define WK_WIND_PRESSURE_RELAXATION 1

/**
 * A box of air in which the wind is solved for: level and aligned to true north. Within four cells of the box's sides
 * and top, the solved wind blends into the weather's wind.
 */
typedef struct wk_wind_field {
    /** sizeof(wk_wind_field) of your header. */
    uint32_t struct_size;
    /** WK_STRUCT_TYPE_WIND_FIELD. */
    wk_struct_type struct_type;
    /** No extensions in this version: NULL. */
    const void *next;
    /**
     * Middle of the field's floor, in the host's world, m, within 1e12 m of the origin; no higher than the lowest
     * ground that matters. If you set the field again with another point, the field moves by whole cells. Default 0,
     * 0, 0.
     */
    double floor_center_m[3];
    /**
     * Size of a cell east, north and up, m, the longest at most 8 times the shortest. Range [0.05, 1000], default 4,
     * 4, 4.
     */
    double cell_m[3];
    /** Number of cells east, north and up. Range [8, 4096] each, default 128, 128, 32. */
    uint32_t cells[3];
    /** A WK_WIND_FIELD_ constant, default WK_WIND_FIELD_STEADY. */
    wk_wind_field_mode mode;
    /** A WK_WIND_WALLS_ constant, default WK_WIND_WALLS_ROUGH. */
    wk_wind_walls walls;
    /** Must be 0. */
    uint32_t reserved0;
    /**
     * Largest memory for the field, bytes. A field that needs more is refused, and the message says how much it needs.
     * Range [1048576, 17179869184], default 1073741824.
     */
    uint64_t most_bytes;
    /** A WK_WIND_SCHEME_ constant, default WK_WIND_SCHEME_REFLECTION. Part of the saved state. */
    wk_wind_scheme scheme;
    /** A WK_WIND_PRESSURE_ constant, default WK_WIND_PRESSURE_MULTIGRID. Part of the saved state. */
    wk_wind_pressure pressure;
    /**
     * Largest number of V-cycles in one projection, [0, 1000]; with WK_WIND_PRESSURE_RELAXATION, largest number of
     * iterations, [0, 1000000]. 0, the default, means 50 V-cycles or 5 iterations.
     */
    uint32_t most_iterations;
    /** Must be 0. */
    uint32_t reserved1;
    /**
     * Relaxation factors of the first and of the last possible iteration, both in (0, 2); between them the factor
     * changes linearly. V-cycles ignore them. Default 0, 0, which means 1.7, 1.1.
     */
    float relaxation[2];
} wk_wind_field;

/** Every field of `wk_wind_field` at its default. */
#define WK_WIND_FIELD_INIT { \
    /* struct_size */ (uint32_t)sizeof(wk_wind_field), \
    /* struct_type */ WK_STRUCT_TYPE_WIND_FIELD, \
    /* next */ NULL, \
    /* floor_center_m */ { 0.0, 0.0, 0.0 }, \
    /* cell_m */ { 4.0, 4.0, 4.0 }, \
    /* cells */ { 128, 128, 32 }, \
    /* mode */ WK_WIND_FIELD_STEADY, \
    /* walls */ WK_WIND_WALLS_ROUGH, \
    /* reserved0 */ 0, \
    /* most_bytes */ UINT64_C(1073741824), \
    /* scheme */ WK_WIND_SCHEME_REFLECTION, \
    /* pressure */ WK_WIND_PRESSURE_MULTIGRID, \
    /* most_iterations */ 0, \
    /* reserved1 */ 0, \
    /* relaxation */ { 0.0f, 0.0f } \
}

/** State of a wind field. */
typedef struct wk_wind_field_report {
    /** sizeof(wk_wind_field_report) of your header. */
    uint32_t struct_size;
    /** WK_STRUCT_TYPE_WIND_FIELD_REPORT. */
    wk_struct_type struct_type;
    /** No extensions in this version: NULL. */
    const void *next;
    /**
     * 1: there is a field. 0: none is set, its start time has not come, or its first steady state is still being
     * solved for. While this field is 0, all others are 0 too.
     */
    uint32_t present;
    /** 1: the field is steady and rests; nothing is stepped. */
    uint32_t rests;
    /** Simulation time of the field, s: the present, or up to one step before it. */
    double time_s;
    /**
     * Simulation time at which the field last began from a steady state, s: when it was first set, after a leap of
     * more than 60 s, or after a move too far for its cells to follow.
     */
    double begun_s;
    /** Length of the field's steps, s. */
    double step_s;
    /** Lowest, south-western corner of the field, in the host's world, m. */
    double corner_m[3];
    /** Largest component of the wind anywhere in the field, m/s. */
    double fastest_m_s;
    /** Memory that the field may use, bytes. */
    uint64_t bytes;
} wk_wind_field_report;

/** Every field of `wk_wind_field_report` at its default. */
#define WK_WIND_FIELD_REPORT_INIT { \
    /* struct_size */ (uint32_t)sizeof(wk_wind_field_report), \
    /* struct_type */ WK_STRUCT_TYPE_WIND_FIELD_REPORT, \
    /* next */ NULL, \
    /* present */ 0, \
    /* rests */ 0, \
    /* time_s */ 0.0, \
    /* begun_s */ 0.0, \
    /* step_s */ 0.0, \
    /* corner_m */ { 0.0, 0.0, 0.0 }, \
    /* fastest_m_s */ 0.0, \
    /* bytes */ UINT64_C(0) \
}

/**
 * Sets a wind field from simulation time `start_time_s` on, [-1e10, 1e10] s, not before the last update or change;
 * NULL ends the field at that time. If only the place differs from that of the present field, by less than half of the
 * cells along each axis, the field moves there by whole cells. If it moves farther, or if the size, mode, walls,
 * scheme or pressure method differs, the field begins anew. A new field begins with the steady wind at the time of its
 * first step. wk_context_update advances the field in steps that end at multiples of wk_wind_field_report.step_s,
 * whatever is drawn, so it is the same on all channels of a simulator. Part of the saved state. Unchanged after an
 * error.
 * Thread: exclusive.
 * Errors: WK_ERROR_INVALID_ARGUMENT naming the field and its range; WK_ERROR_WRONG_ORDER for a time that has passed.
 */
WK_API
wk_status wk_context_set_wind_field(wk_context *context,
                                    const wk_wind_field *wind_field,
                                    double start_time_s);

/**
 * Gets the state of the wind field now.
 * Thread: concurrent.
 * Errors: WK_ERROR_INVALID_ARGUMENT for an invalid output struct.
 */
WK_API wk_status wk_context_get_wind_field_report(const wk_context *context, wk_wind_field_report *out_report);

/**
 * Writes the default of every field: the same bytes as `WK_WIND_FIELD_INIT`. `struct_size` is `sizeof(wk_wind_field)`
 * as the caller was compiled, and is stored in the struct.
 */
WK_API wk_status wk_wind_field_init(wk_wind_field *out, uint32_t struct_size);

/**
 * Writes the default of every field: the same bytes as `WK_WIND_FIELD_REPORT_INIT`. `struct_size` is `sizeof(wk_wind_field_report)`
 * as the caller was compiled, and is stored in the struct.
 */
WK_API
wk_status wk_wind_field_report_init(wk_wind_field_report *out,
                                    uint32_t struct_size);

/*
 * ====================================================================================================
 * [occluder] Maps of objects that keep rain off
 *
 * For shelter that boxes cannot describe, pass at most four depth images of your world, with standing or moving
 * objects, seen from any direction. A drop is not drawn if its own slanted path crosses a surface in a map.
 *
 * A map does not show what is hidden behind its surfaces. Render it along wk_rainfall.fall_velocity_m_s, the path of
 * the median drop. Then the hidden parts do not matter for half of the rain, and matter little for the other half.
 * Where objects stand below others (a pier below a deck), add maps along the paths of slower drops, with the same wind
 * and fall speeds of 3.4 and 2.1 m/s. The edges of mapped surfaces are exact to two texels.
 *
 * Welkin copies a map during the call. The copy includes the results of work that you submitted to the queue (or, with
 * OpenGL, issued) before the call. Afterwards the image is yours again.
 * ====================================================================================================
 */

/** Flags of a map. */
typedef uint32_t wk_occluder_map_flags;

/** The map's depth is reversed: 1 is near, 0 is far. */
#define WK_OCCLUDER_MAP_DEPTH_REVERSED 1
/** The first row of the image lies at clip y = -1. In OpenGL this is always so, and the flag need not be set. */
#define WK_OCCLUDER_MAP_FIRST_ROW_AT_MINUS_Y 2

/** A depth image of objects that keep rain off: one sample in each texel, and 8 to 4096 texels along each side. */
typedef struct wk_occluder_map {
    /** sizeof(wk_occluder_map) of your header. */
    uint32_t struct_size;
    /** WK_STRUCT_TYPE_OCCLUDER_MAP. */
    wk_struct_type struct_type;
    /** No extensions in this version: NULL. */
    const void *next;
    /**
     * Matrix from the host's world to clip space, invertible: parallel rays or perspective, column-major. Default
     * identity.
     */
    double clip_from_world[16];
    /** Flags of the map. Default 0. */
    wk_occluder_map_flags flags;
    /** Range of clip-space z. Default WK_CLIP_ZERO_TO_ONE. */
    wk_clip_space clip_space;
    /** Simulation time at which the objects stood as the map shows them, s. Default 0. */
    double time_s;
    /**
     * Velocity of the objects in the map, m/s; its length is at most 2000. With it, the map of a moving truck need not
     * be rendered in every frame. Default 0, 0, 0.
     */
    double velocity_m_s[3];
    /** The image on one of Welkin's own devices. Default NULL. */
    const wk_texture *texture;
    /** The image of a Vulkan host. Default NULL. */
    const wk_vulkan_image *vulkan;
    /** The image of an OpenGL host: a depth texture or renderbuffer. Default none. */
    wk_opengl_image opengl;
    /** Width of an OpenGL host's image, texels; must equal the image's own. Default 0. */
    uint32_t width;
    /** Height of an OpenGL host's image, texels; must equal the image's own. Default 0. */
    uint32_t height;
    /**
     * For an OpenGL host's image: increase this number when you create an object again under an old name. Default 0.
     */
    uint64_t generation;
} wk_occluder_map;

/** Every field of `wk_occluder_map` at its default. */
#define WK_OCCLUDER_MAP_INIT { \
    /* struct_size */ (uint32_t)sizeof(wk_occluder_map), \
    /* struct_type */ WK_STRUCT_TYPE_OCCLUDER_MAP, \
    /* next */ NULL, \
    /* clip_from_world */ { 1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0 }, \
    /* flags */ 0, \
    /* clip_space */ WK_CLIP_ZERO_TO_ONE, \
    /* time_s */ 0.0, \
    /* velocity_m_s */ { 0.0, 0.0, 0.0 }, \
    /* texture */ NULL, \
    /* vulkan */ NULL, \
    /* opengl */ WK_OPENGL_IMAGE_INIT, \
    /* width */ 0, \
    /* height */ 0, \
    /* generation */ UINT64_C(0) \
}

/**
 * Sets the maps of objects that keep rain off, at most 4, and replaces those set before; count 0 removes all. After an
 * error the previous maps stay. No map is part of a saved state, because each channel may have maps of its own.
 * Thread: exclusive.
 * Errors: WK_ERROR_INVALID_ARGUMENT and WK_ERROR_UNSUPPORTED naming the element, its field and what is accepted;
 * WK_ERROR_BAD_HANDLE; WK_ERROR_DEVICE_LOST.
 */
WK_API
wk_status wk_context_set_occluder_maps(wk_context *context,
                                       const wk_occluder_map *maps,
                                       uint32_t count,
                                       uint32_t stride);

/**
 * Writes the default of every field: the same bytes as `WK_OCCLUDER_MAP_INIT`. `struct_size` is `sizeof(wk_occluder_map)`
 * as the caller was compiled, and is stored in the struct.
 */
WK_API
wk_status wk_occluder_map_init(wk_occluder_map *out,
                               uint32_t struct_size);

/*
 * ====================================================================================================
 * [light] Lamps
 *
 * Head lights, work lights, search lights: the host's lamps light what Welkin draws in their beams (rain, snow, hail,
 * splashes and clouds) and are reflected in wet ground. The host lights its own world itself.
 * ====================================================================================================
 */

/** A lamp of the host. */
typedef struct wk_light {
    /** sizeof(wk_light) of your header. */
    uint32_t struct_size;
    /** WK_STRUCT_TYPE_LIGHT. */
    wk_struct_type struct_type;
    /** No extensions in this version: NULL. */
    const void *next;
    /** Position in the host's world, m, within 1e12 m of the origin. Default 0, 0, 0. */
    double position_m[3];
    /** Direction of the beam, in the host's world; any length in [1e-6, 1e6]. Default 0, 1, 0. */
    double direction[3];
    /**
     * Luminous intensity in the middle of the beam, cd per channel of linear Rec. 709. Range [0, 1e9], default 1000
     * each. A low beam has about 10 000 cd, a work light 2000 to 5000 cd.
     */
    double intensity_cd[3];
    /** Angle from the middle of the beam up to which it has full intensity, degrees. Range [0, 180], default 10. */
    double inner_deg;
    /**
     * Angle from the middle of the beam at which it ends, degrees. Range [inner_deg, 180], default 30. If both angles
     * are 180, the lamp shines to all sides.
     */
    double outer_deg;
} wk_light;

/** Every field of `wk_light` at its default. */
#define WK_LIGHT_INIT { \
    /* struct_size */ (uint32_t)sizeof(wk_light), \
    /* struct_type */ WK_STRUCT_TYPE_LIGHT, \
    /* next */ NULL, \
    /* position_m */ { 0.0, 0.0, 0.0 }, \
    /* direction */ { 0.0, 1.0, 0.0 }, \
    /* intensity_cd */ { 1000.0, 1000.0, 1000.0 }, \
    /* inner_deg */ 10.0, \
    /* outer_deg */ 30.0 \
}

/**
 * Sets the host's lamps, at most 64, and replaces all lamps set before; count 0 removes all. Set moving lamps again in
 * every frame. A failed call changes nothing.
 * Thread: exclusive.
 * Errors: WK_ERROR_INVALID_ARGUMENT naming the element, its field and range.
 */
WK_API
wk_status wk_context_set_lights(wk_context *context,
                                const wk_light *lights,
                                uint32_t count,
                                uint32_t stride);

/**
 * Writes the default of every field: the same bytes as `WK_LIGHT_INIT`. `struct_size` is `sizeof(wk_light)`
 * as the caller was compiled, and is stored in the struct.
 */
WK_API wk_status wk_light_init(wk_light *out, uint32_t struct_size);

/*
 * ====================================================================================================
 * [stars] Stars
 *
 * At night every view draws the 9096 stars of the Yale Bright Star Catalogue, Mercury to Uranus, the airglow, the
 * zodiacal light and the Milky Way behind its sky, at their positions for the context's place and time. By day, in fog
 * and under closed clouds none of them is drawn. A budget may leave all of these lights out (WK_PART_STARS).
 * ====================================================================================================
 */

/** Flags of a wk_stars. */
typedef uint32_t wk_stars_flags;

/** stars and star_count: the host's own stars replace the catalogue's. */
#define WK_STARS_OWN 1
/** celestial_to_world: the host orients the celestial sphere itself. */
#define WK_STARS_TURNED 2
/** No planets. */
#define WK_STARS_NO_PLANETS 4

/** Settings of the night sky. */
typedef struct wk_stars {
    /** sizeof(wk_stars) of your header. */
    uint32_t struct_size;
    /** WK_STRUCT_TYPE_STARS. */
    wk_struct_type struct_type;
    /** No extensions in this version: NULL. */
    const void *next;
    /**
     * WK_STARS_ flags: the settings that replace the defaults. Default 0: the stars of the catalogue and the planets,
     * at their positions over the Earth.
     */
    wk_stars_flags flags;
    /** Number of stars in `stars`, at most 1 000 000. Default 0. */
    uint32_t star_count;
    /**
     * With WK_STARS_OWN: four numbers for each star: right ascension, degrees in [-1e6, 1e6], and declination, degrees
     * in [-90, 90], both in the equator and equinox of J2000.0; visual magnitude in [-30, 30]; colour temperature of a
     * black body, K, in [1000, 100000]. Copied by the call. Default NULL.
     */
    const double *stars;
    /**
     * With WK_STARS_TURNED: rotation from the equator and equinox of J2000.0 (x to the equinox, z to the north pole)
     * to (east, north, up), column-major. Default the identity.
     */
    double celestial_to_world[9];
    /**
     * Strength of the airglow. Range [0, 10], default 1, as near the minimum of solar activity; 1.7 at the maximum.
     */
    double airglow;
} wk_stars;

/** Every field of `wk_stars` at its default. */
#define WK_STARS_INIT { \
    /* struct_size */ (uint32_t)sizeof(wk_stars), \
    /* struct_type */ WK_STRUCT_TYPE_STARS, \
    /* next */ NULL, \
    /* flags */ 0, \
    /* star_count */ 0, \
    /* stars */ NULL, \
    /* celestial_to_world */ { 1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0 }, \
    /* airglow */ 1.0 \
}

/**
 * Sets how the night sky is drawn; NULL returns to the default. Part of the saved state, except the list of stars: a
 * context that loads a state keeps its own list. Unchanged after an error.
 * Thread: exclusive.
 * Errors: WK_ERROR_INVALID_ARGUMENT naming the field and its range.
 */
WK_API wk_status wk_context_set_stars(wk_context *context, const wk_stars *stars);

/**
 * Gets the magnitude, as catalogues give it, of the faintest star that the naked eye sees straight up from a place at
 * a simulation time. This magnitude decreases with the brightness of the sky, and with the extinction of the star's
 * light in air, fog and clouds. It is minus infinity where no starlight gets through.
 * Thread: concurrent.
 * Errors: as wk_context_get_conditions.
 */
WK_API
wk_status wk_context_get_limiting_magnitude_at(const wk_context *context,
                                               const double (*position_m)[3],
                                               double time_s,
                                               double *out_magnitude);

/**
 * Writes the default of every field: the same bytes as `WK_STARS_INIT`. `struct_size` is `sizeof(wk_stars)`
 * as the caller was compiled, and is stored in the struct.
 */
WK_API wk_status wk_stars_init(wk_stars *out, uint32_t struct_size);

/*
 * ====================================================================================================
 * [cloud_map] Cloud map
 *
 * A map of where cloud layers stand over the ground: a storm ahead of the runway, a clearing over the harbour. The map
 * applies to pictures, shadows, and queries of light, radiance and visibility, but not to wk_context_get_conditions
 * and wk_context_get_cloud_slabs. docs/clouds.md has an example.
 * ====================================================================================================
 */

/**
 * Cover of cloud layers over each place of the ground, as a share of the cover that the weather gives the layers. For
 * a layer of cover 1 the map is the cover itself. The map is level, aligned to true north and fixed to the ground.
 * Clouds drift across the map with their wind, and grow and dissolve on the way so that the cover stays that of the
 * map. Values are interpolated linearly between the centres of cells, and constant beyond the outermost centres.
 */
typedef struct wk_cloud_map {
    /** sizeof(wk_cloud_map) of your header. */
    uint32_t struct_size;
    /** WK_STRUCT_TYPE_CLOUD_MAP. */
    wk_struct_type struct_type;
    /** No extensions in this version: NULL. */
    const void *next;
    /**
     * Centre of the south-western cell: metres east and north of the world's origin. Range [-1e7, 1e7], default 0, 0.
     */
    double first_m[2];
    /** Side of a cell, m. Range [100, 50 000], default 1000. */
    double cell_m;
    /** Number of cells east and north. Range [1, 128], default 1, 1. */
    uint32_t cells[2];
    /**
     * Lowest and highest base of the layers that follow the map, above the station, m. Range [-1000, 20 000], the
     * lower one first, default -1000, 20 000: all layers.
     */
    double base_m[2];
    /**
     * Share of the layer's cover in each cell, in [0, 1]: 0 for no cloud, 1 for the layer's cover. Cells run from west
     * to east, rows from south to north. Copied by the call.
     */
    const float *cover;
    /** Number of cells in `cover`: the product of `cells`. */
    uint32_t cover_count;
    /** Must be 0. */
    uint32_t reserved0;
} wk_cloud_map;

/** Every field of `wk_cloud_map` at its default. */
#define WK_CLOUD_MAP_INIT { \
    /* struct_size */ (uint32_t)sizeof(wk_cloud_map), \
    /* struct_type */ WK_STRUCT_TYPE_CLOUD_MAP, \
    /* next */ NULL, \
    /* first_m */ { 0.0, 0.0 }, \
    /* cell_m */ 1000.0, \
    /* cells */ { 1, 1 }, \
    /* base_m */ { -1000.0, 20000.0 }, \
    /* cover */ NULL, \
    /* cover_count */ 0, \
    /* reserved0 */ 0 \
}

/**
 * Sets the map of cloud cover, in place of any earlier map; NULL removes the map. Clouds change at once. The map is
 * part of the saved state. With WK_CLOUD_MODEL_DECK the map affects only the light. A failed call changes nothing.
 * Thread: exclusive.
 * Errors: WK_ERROR_INVALID_ARGUMENT naming the field and its range.
 */
WK_API wk_status wk_context_set_cloud_map(wk_context *context, const wk_cloud_map *cloud_map);

/**
 * Writes the default of every field: the same bytes as `WK_CLOUD_MAP_INIT`. `struct_size` is `sizeof(wk_cloud_map)`
 * as the caller was compiled, and is stored in the struct.
 */
WK_API wk_status wk_cloud_map_init(wk_cloud_map *out, uint32_t struct_size);

/*
 * ====================================================================================================
 * [clouds] Clouds
 *
 * Cloud layers come with the weather: from wk_cloud_layer, a report or a preset. wk_context_set_cloud_model sets how
 * views draw them. Conditions, precipitation and the mean light are the same for both models, deck and volume.
 * docs/clouds.md has costs and errors.
 *
 * Clouds drawn as a volume cast shadows. The host lights its picture by the mean light (wk_context_get_light). The
 * stage SURFACE then finds the place of each pixel from the host's depth, and multiplies the pixel by the ratio of the
 * light there to the mean light. A host that lights an object separately, such as a cab's interior, can query the
 * share at the object's place (wk_context_get_sun_share).
 * ====================================================================================================
 */

/** Way to draw clouds. */
typedef uint32_t wk_cloud_model;

/**
 * A grey deck where more than half of the sky is covered; broken clouds only dim the light. It costs no more than a
 * clear sky.
 */
#define WK_CLOUD_MODEL_DECK 0
/**
 * Volumes that the camera can fly through, lit by the sun or moon, the sky and the ground. A closed layer seen from
 * below is drawn as a deck. Each frame computes one of every sixteen pixels (by default: see wk_clouds.square_side);
 * wk_frame.frame_id selects which, so increase it by one in every frame.
 */
#define WK_CLOUD_MODEL_VOLUME 1

/** Flags of a wk_clouds. */
typedef uint32_t wk_clouds_flags;

/**
 * Shafts of light: the air under broken clouds is brighter where the sun shines through and darker in the clouds'
 * shadows. Drawn with WK_STAGE_SURFACE, up to 10 km away, where the host gives depth and does not read the shadow map
 * itself (wk_view_get_cloud_shadows). The flag costs 24 texture look-ups a pixel. Without this flag the air has its
 * mean brightness everywhere.
 */
#define WK_CLOUDS_SHAFTS 1

/** Quality of clouds that a view draws as a volume. */
typedef struct wk_clouds {
    /** sizeof(wk_clouds) of your header. */
    uint32_t struct_size;
    /** WK_STRUCT_TYPE_CLOUDS. */
    wk_struct_type struct_type;
    /** No extensions in this version: NULL. */
    const void *next;
    /**
     * Relative number of steps along each ray: twice the value means twice as many steps. Range [0.125, 32], default
     * 2.
     */
    double fineness;
    /**
     * Side of a square block of pixels: each frame computes one pixel of a block and takes the others from earlier
     * frames. 1, 2 or 4, default 4. Frames with WK_FRAME_NO_HISTORY compute all.
     */
    uint32_t square_side;
    /** WK_CLOUDS_* flags. Default 0. */
    wk_clouds_flags flags;
} wk_clouds;

/** Every field of `wk_clouds` at its default. */
#define WK_CLOUDS_INIT { \
    /* struct_size */ (uint32_t)sizeof(wk_clouds), \
    /* struct_type */ WK_STRUCT_TYPE_CLOUDS, \
    /* next */ NULL, \
    /* fineness */ 2.0, \
    /* square_side */ 4, \
    /* flags */ 0 \
}

/**
 * Sets how views draw clouds. Default WK_CLOUD_MODEL_VOLUME; a budget may draw the deck in place of the volume
 * (WK_PART_CLOUDS). The model is part of the saved state.
 * Thread: exclusive.
 * Errors: WK_ERROR_INVALID_ARGUMENT for an unknown model.
 */
WK_API wk_status wk_context_set_cloud_model(wk_context *context, wk_cloud_model cloud_model);

/**
 * Gets the share of the direct light of the sun or the moon, whichever is brighter, that clouds let through to a
 * place, in [0, 1]: low in the shadow of a cloud, high between two. With this share s, the direct sunlight at exactly
 * this place is sun_lux * s / direct_share (wk_ground_light, wk_celestial). With WK_CLOUD_MODEL_DECK the share is the
 * mean, wk_celestial.direct_share. The first call builds the noise field from which clouds are cut, which takes some
 * tenths of a second.
 * Thread: concurrent.
 * Errors: as wk_context_get_conditions.
 */
WK_API
wk_status wk_context_get_sun_share(const wk_context *context,
                                   const double (*position_m)[3],
                                   double time_s,
                                   double *out_share);

/**
 * Sets the quality of the clouds in a view; NULL returns to the default. A failed call changes nothing.
 * docs/lab/README.md has the cost and error of some choices.
 * Thread: exclusive on the view.
 * Errors: WK_ERROR_INVALID_ARGUMENT naming the field and its range.
 */
WK_API wk_status wk_view_set_clouds(wk_view *view, const wk_clouds *clouds);

/**
 * Writes the default of every field: the same bytes as `WK_CLOUDS_INIT`. `struct_size` is `sizeof(wk_clouds)`
 * as the caller was compiled, and is stored in the struct.
 */
WK_API wk_status wk_clouds_init(wk_clouds *out, uint32_t struct_size);

/*
 * ====================================================================================================
 * [cloud_shadow] Shadows of clouds as a texture
 *
 * A native texture for the host's own materials: the share of the direct light of the sun or moon that broken clouds
 * let through, for all places around the camera. The function from wk_get_cloud_shadow_snippet, in GLSL or WGSL,
 * samples the texture.
 * ====================================================================================================
 */

/**
 * Map of the clouds' shadows, and its placement in the view's last frame. The map is a level plane at the altitude of
 * the weather's station (station_altitude_m of wk_weather). It moves with the air that carries the clouds, and repeats
 * every 20.48 km.
 */
typedef struct wk_cloud_shadows {
    /** sizeof(wk_cloud_shadows) of your header. */
    uint32_t struct_size;
    /** WK_STRUCT_TYPE_CLOUD_SHADOWS. */
    wk_struct_type struct_type;
    /** No extensions in this version: NULL. */
    const void *next;
    /**
     * Share of the direct light of the sun or the moon, whichever is brighter, that clouds let through. One channel of
     * 8 bits: an OpenGL texture name (GL_TEXTURE_2D, GL_R8) or a VkImage (VK_FORMAT_R8_UNORM). Sample it with a linear
     * filter and a repeating wrap mode.
     */
    uint64_t texture;
    /** Width, texels; equal to the height. */
    uint32_t width;
    /** Height, texels; equal to the width. */
    uint32_t height;
    /**
     * Two rows of a matrix: multiplied by (x, y, z, 1) of a place in the host's world, m, they give the texture
     * coordinates u and v of the place. For single precision, subtract the camera's position (x0, y0, z0) from the
     * place. In each row (p, q, r, s), then replace s by p x0 + q y0 + r z0 + s, computed in double precision.
     */
    double uv_from_world[2][4];
    /** Row of a matrix, used like uv_from_world: it gives the height of a place above the plane, m. */
    double height_from_world[4];
    /** Texture coordinates u and v of the point of the plane that was below the camera in the last frame. */
    double camera_uv[2];
    /**
     * Mean over all places of the share in `texture`. The direct light from wk_context_get_light includes it already:
     * multiply that light by the place's own share / mean_share.
     */
    double mean_share;
    /**
     * Weight of the texture against mean_share, 0 to 1. It is 0 without broken clouds, with WK_CLOUD_MODEL_DECK, and
     * with the light near the horizon: the texture is then meaningless.
     */
    double map_weight;
    /**
     * Height above the plane, m, from which on mean_share replaces the texture: 100 m above the base of the lowest
     * clouds.
     */
    double top_m;
} wk_cloud_shadows;

/** Every field of `wk_cloud_shadows` at its default. */
#define WK_CLOUD_SHADOWS_INIT { \
    /* struct_size */ (uint32_t)sizeof(wk_cloud_shadows), \
    /* struct_type */ WK_STRUCT_TYPE_CLOUD_SHADOWS, \
    /* next */ NULL, \
    /* texture */ UINT64_C(0), \
    /* width */ 0, \
    /* height */ 0, \
    /* uv_from_world */ { { 0.0, 0.0, 0.0, 0.0 }, { 0.0, 0.0, 0.0, 0.0 } }, \
    /* height_from_world */ { 0.0, 0.0, 0.0, 0.0 }, \
    /* camera_uv */ { 0.0, 0.0 }, \
    /* mean_share */ 0.0, \
    /* map_weight */ 0.0, \
    /* top_m */ 0.0 \
}

/**
 * Gets the native texture of the clouds' shadows. From the first call on, the first wk_view_record of each frame
 * updates it, and WK_STAGE_SURFACE no longer draws cloud shadows: your materials do. The texture belongs to the view
 * and stays the same until the view is destroyed. In Vulkan the texture is in VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL
 * between calls. Call this function after each frame to get the placement of the map. If you draw before Welkin, use
 * the placement of the last frame, or record WK_STAGE_PREPARE first.
 * Thread: exclusive on the view.
 * Errors: WK_ERROR_UNSUPPORTED on a device that Welkin made itself (wk_device_create), on which the host's shaders
 * cannot run.
 */
WK_API
wk_status wk_view_get_cloud_shadows(wk_view *view,
                                    wk_cloud_shadows *out_shadows);

/**
 * Gets the text of the sampling function: NUL-terminated UTF-8 that lives as long as the process.
 * Thread: any.
 * Errors: WK_ERROR_INVALID_ARGUMENT for an unknown language.
 */
WK_API wk_status wk_get_cloud_shadow_snippet(wk_shading_language language, const char **out_text);

/**
 * Writes the default of every field: the same bytes as `WK_CLOUD_SHADOWS_INIT`. `struct_size` is `sizeof(wk_cloud_shadows)`
 * as the caller was compiled, and is stored in the struct.
 */
WK_API
wk_status wk_cloud_shadows_init(wk_cloud_shadows *out,
                                uint32_t struct_size);

/*
 * ====================================================================================================
 * [lightning] Lightning
 *
 * A thunderstorm (WK_PRECIPITATION_THUNDERSTORM, a report with TS) flashes three times a minute in each square of 20
 * km by 20 km. The host may set another rate, and the places of the storm cells. Every flash is a function of the
 * context's seed, the time, the rate and the storm cells. All channels of a simulator therefore show the same flashes,
 * and any time can be shown again. Views draw the paths of flashes, the glow of clouds and air, and the light of
 * flashes on rain and wet ground. The host queries flashes to play thunder, and queries their light to light its own
 * scene:
 *
 * wk_flash flashes[16];
 * uint32_t count = 0;
 * wk_context_get_flashes(context, ear, last_s, now_s, 20e3, flashes, 16, sizeof flashes[0], &count);
 * for (uint32_t i = 0; i < count; i++)
 *     play_thunder_at(flashes[i].time_s + flashes[i].thunder_delay_s, flashes[i].distance_m);
 *
 * A frame contains the light of flashes from the time of the view's previous frame to the frame's own time. No flash
 * is missed or drawn twice, whatever the frame rate. A frame contains the light of the last 1/60 s alone if it is the
 * view's first one, if it has WK_FRAME_CUT or WK_FRAME_NO_HISTORY, or if time has jumped by more than 0.5 s or
 * backwards.
 * ====================================================================================================
 */

/** Flags of a wk_lightning. */
typedef uint32_t wk_lightning_flags;

/** The host's rate, flashes_per_minute, replaces the weather's. */
#define WK_LIGHTNING_RATE 1

/** Flicker of flashes in a picture. */
typedef uint32_t wk_flicker;

/** Flicker as in nature: many changes of luminance a second. */
#define WK_FLICKER_AS_IN_NATURE 0
/**
 * Limited flicker, for viewers whom flicker may harm: at most three changes of luminance in any second. A drawn flash
 * rises once and fades, which is two changes. The next drawn flash begins a second later at the earliest; flashes in
 * between are not drawn. Queries return all flashes and all of their light.
 */
#define WK_FLICKER_LIMITED 1

/** Rate and places of flashes, and how views draw them. */
typedef struct wk_lightning {
    /** sizeof(wk_lightning) of your header. */
    uint32_t struct_size;
    /** WK_STRUCT_TYPE_LIGHTNING. */
    wk_struct_type struct_type;
    /** No extensions in this version: NULL. */
    const void *next;
    /** WK_LIGHTNING_* flags. Default 0: the weather gives the rate. */
    wk_lightning_flags flags;
    /** Flicker of the drawn flashes. Default WK_FLICKER_AS_IN_NATURE. */
    wk_flicker flicker;
    /**
     * Flashes a minute in each square of 20 km by 20 km, whatever the weather. The rate is used with
     * WK_LIGHTNING_RATE, and only if there are no `cells`, which have rates of their own. Range [0, 60], default 0.
     */
    double flashes_per_minute;
    /**
     * Number of storm cells in `cells`, at most 16. If there are any, they replace the weather's storm cells. Default
     * 0.
     */
    uint32_t cell_count;
    /** Number of tall objects in `masts`, at most 64. Default 0. */
    uint32_t mast_count;
    /**
     * Five numbers for each cell. The first three are its middle in the host's world, m; the height has no effect. The
     * fourth is the horizontal distance from the middle within which two thirds of the cell's flashes start, m, in [0,
     * 1e5]. The fifth is the number of flashes a minute, in [0, 60]. Copied by the call. Default NULL.
     */
    const double *cells;
    /**
     * Three numbers for each mast: its tip in the host's world, m. Masts and the tops of shelters
     * (wk_context_set_shelters) attract ground flashes, except flashes that the host triggers. Copied by the call.
     * Default NULL.
     */
    const double *masts;
} wk_lightning;

/** Every field of `wk_lightning` at its default. */
#define WK_LIGHTNING_INIT { \
    /* struct_size */ (uint32_t)sizeof(wk_lightning), \
    /* struct_type */ WK_STRUCT_TYPE_LIGHTNING, \
    /* next */ NULL, \
    /* flags */ 0, \
    /* flicker */ WK_FLICKER_AS_IN_NATURE, \
    /* flashes_per_minute */ 0.0, \
    /* cell_count */ 0, \
    /* mast_count */ 0, \
    /* cells */ NULL, \
    /* masts */ NULL \
}

/** Place where a flash ends: on the ground or in the cloud. */
typedef uint32_t wk_flash_kind;

/** The flash strikes the ground. */
#define WK_FLASH_KIND_TO_GROUND 0
/** The flash stays within the cloud. */
#define WK_FLASH_KIND_IN_CLOUD 1

/** A flash that the host triggers. */
typedef struct wk_flash_trigger {
    /** sizeof(wk_flash_trigger) of your header. */
    uint32_t struct_size;
    /** WK_STRUCT_TYPE_FLASH_TRIGGER. */
    wk_struct_type struct_type;
    /** No extensions in this version: NULL. */
    const void *next;
    /** Simulation time of the flash's first stroke, s, not before the present. Range [-1e10, 1e10], default 0. */
    double time_s;
    /**
     * Position in the host's world, m, that a ground flash strikes, or over which a flash within the cloud passes. A
     * flash that meets a shelter on its way ends there. Default 0, 0, 0.
     */
    double position_m[3];
    /** Largest peak current of the flash's strokes, kA. Range [1, 500], or 0, the default: random. */
    double peak_ka;
    /** Place where the flash ends. Default WK_FLASH_KIND_TO_GROUND. */
    wk_flash_kind kind;
    /** Number of strokes. Range [0, 26], default 0: random. */
    uint32_t strokes;
} wk_flash_trigger;

/** Every field of `wk_flash_trigger` at its default. */
#define WK_FLASH_TRIGGER_INIT { \
    /* struct_size */ (uint32_t)sizeof(wk_flash_trigger), \
    /* struct_type */ WK_STRUCT_TYPE_FLASH_TRIGGER, \
    /* next */ NULL, \
    /* time_s */ 0.0, \
    /* position_m */ { 0.0, 0.0, 0.0 }, \
    /* peak_ka */ 0.0, \
    /* kind */ WK_FLASH_KIND_TO_GROUND, \
    /* strokes */ 0 \
}

/**
 * A flash as seen and heard from a place. Element of an array, without struct_size; calls take its sizeof instead.
 */
typedef struct wk_flash {
    /** Number that identifies the flash within the context. */
    uint64_t id;
    /** Simulation time of the flash's first stroke, s. */
    double time_s;
    /** Place where the flash ends. */
    wk_flash_kind kind;
    /** Number of strokes. For a flash within the cloud: number of pulses of light. */
    uint32_t strokes;
    /** Largest peak current of the flash's strokes or pulses, kA. */
    double peak_ka;
    /**
     * Point that a ground flash struck, or middle of the path of a flash within the cloud, in the host's world, m.
     */
    double position_m[3];
    /** Distance from the queried place to the nearest point of the flash's path, m. */
    double distance_m;
    /** Unit vector towards position_m, (east, north, up) at the queried place. */
    double direction[3];
    /**
     * Time from time_s to the beginning of the thunder at the queried place, s: distance_m / (331.3 + 0.606 t), with
     * the air's temperature t in degrees Celsius.
     */
    double thunder_delay_s;
} wk_flash;

/** Light of flashes at a place. */
typedef struct wk_flash_light {
    /** sizeof(wk_flash_light) of your header. */
    uint32_t struct_size;
    /** WK_STRUCT_TYPE_FLASH_LIGHT. */
    wk_struct_type struct_type;
    /** No extensions in this version: NULL. */
    const void *next;
    /**
     * Illuminance that each source gives to a surface facing it, summed over all sources, lux for each of red, green
     * and blue (linear Rec. 709).
     */
    double facing_lux[3];
    /** Illuminance on level ground, lux. */
    double level_lux;
    /**
     * Mean direction towards the light: unit vector (east, north, up) at the place. Straight up where there is no
     * light.
     */
    double direction[3];
} wk_flash_light;

/** Every field of `wk_flash_light` at its default. */
#define WK_FLASH_LIGHT_INIT { \
    /* struct_size */ (uint32_t)sizeof(wk_flash_light), \
    /* struct_type */ WK_STRUCT_TYPE_FLASH_LIGHT, \
    /* next */ NULL, \
    /* facing_lux */ { 0.0, 0.0, 0.0 }, \
    /* level_lux */ 0.0, \
    /* direction */ { 0.0, 0.0, 0.0 } \
}

/**
 * Sets the rate and the places of flashes, and how views draw them; NULL returns to the default. The settings are part
 * of the saved state. A failed call changes nothing.
 * Thread: exclusive.
 * Errors: WK_ERROR_INVALID_ARGUMENT naming the field and its range.
 */
WK_API
wk_status wk_context_set_lightning(wk_context *context,
                                   const wk_lightning *lightning);

/**
 * Triggers a flash, whatever the weather. The flash is part of the saved state until 120 s after its time_s. At most
 * 64 triggered flashes are kept at a time. A failed call triggers nothing.
 * Thread: exclusive.
 * Errors: WK_ERROR_INVALID_ARGUMENT naming the field and its range, or if there are too many flashes;
 * WK_ERROR_WRONG_ORDER for a time before the present.
 */
WK_API wk_status wk_context_trigger_flash(wk_context *context, const wk_flash_trigger *flash);

/**
 * Gets the flashes that begin at or after `from_s` and before `until_s`, past or future, in order of time. `until_s`
 * is from 0 to 3600 s later than `from_s`. Flashes that start farther from the position than `most_distance_m`, in [0,
 * 50000] m, measured horizontally, are left out. `*out_count` gets the number of flashes found. With capacity 0
 * nothing else is written, and the call succeeds. If `capacity` is too small, the call writes only the number and
 * fails. `flash_size` is sizeof(wk_flash) of your header. If the timeline no longer knows the weather of a time, the
 * call uses the earliest weather that the timeline knows.
 * Thread: concurrent.
 * Errors: WK_ERROR_INVALID_ARGUMENT naming the parameter.
 */
WK_API
wk_status wk_context_get_flashes(const wk_context *context,
                                 const double (*position_m)[3],
                                 double from_s,
                                 double until_s,
                                 double most_distance_m,
                                 wk_flash *flashes,
                                 uint32_t capacity,
                                 uint32_t flash_size,
                                 uint32_t *out_count);

/**
 * Gets the light of flashes at a place of the host's world, averaged from `time_s` - `exposure_s` to `time_s`.
 * `exposure_s` is in [0, 1] s; with 0 the call gets the light at `time_s` itself. Use the answer to light the host's
 * own scene, and pass the time since the host's last frame as `exposure_s`.
 * Thread: concurrent.
 * Errors: WK_ERROR_INVALID_ARGUMENT naming the parameter.
 */
WK_API
wk_status wk_context_get_flash_light(const wk_context *context,
                                     const double (*position_m)[3],
                                     double time_s,
                                     double exposure_s,
                                     wk_flash_light *out_light);

/**
 * Writes the default of every field: the same bytes as `WK_LIGHTNING_INIT`. `struct_size` is `sizeof(wk_lightning)`
 * as the caller was compiled, and is stored in the struct.
 */
WK_API wk_status wk_lightning_init(wk_lightning *out, uint32_t struct_size);

/**
 * Writes the default of every field: the same bytes as `WK_FLASH_TRIGGER_INIT`. `struct_size` is `sizeof(wk_flash_trigger)`
 * as the caller was compiled, and is stored in the struct.
 */
WK_API
wk_status wk_flash_trigger_init(wk_flash_trigger *out,
                                uint32_t struct_size);

/**
 * Writes the default of every field: the same bytes as `WK_FLASH_LIGHT_INIT`. `struct_size` is `sizeof(wk_flash_light)`
 * as the caller was compiled, and is stored in the struct.
 */
WK_API
wk_status wk_flash_light_init(wk_flash_light *out,
                              uint32_t struct_size);

/*
 * ====================================================================================================
 * [windscreen] Water on the windscreen
 *
 * A view may look through a window. Rain lands on it at the rate and speed with which the window meets the drops.
 * Beads merge, run down by gravity or up with the air, are wiped, and refract the picture behind them. Mist on the
 * inside blurs the picture. Snow lies on the window until wipers remove it or heat melts it. The stage LENS draws
 * water, mist and snow over everything drawn so far, inside the window only. Masked pixels stay the host's. In a call
 * with TONE, the glass is drawn before the tone curve if the target is a float one, else after it.
 *
 * The water is part of the view. It moves in steps of 1/60 s, counted from simulation time 0. Each frame computes its
 * steps when it records WK_STAGE_PREPARE or, without that, its first later stage. The water does not depend on the
 * frame rate, and views of one seed and history agree bit for bit. At the first frame, after WK_FRAME_CUT, and when a
 * frame comes more than half a second after the one before, the water takes the default state of that time: a function
 * of seed, time and rain. With WK_FRAME_NO_HISTORY it always has that state. LENS costs nothing without a windscreen,
 * or while the whole of it is dry and clear.
 * ====================================================================================================
 */

/** Shape of the glass. */
typedef uint32_t wk_windscreen_pane;

/** A flat window of four corners. */
#define WK_WINDSCREEN_PANE_QUAD 0
/** Glass across the whole view. */
#define WK_WINDSCREEN_PANE_WHOLE_VIEW 1

/** A wiper: a blade on an arm that turns about a pivot in the glass's plane. */
typedef struct wk_wiper_arm {
    /** sizeof(wk_wiper_arm) of your header. */
    uint32_t struct_size;
    /** WK_STRUCT_TYPE_WIPER_ARM. */
    wk_struct_type struct_type;
    /** No extensions in this version: NULL. */
    const void *next;
    /**
     * Position of the pivot along the glass, m to the right of and above the lower left corner of the pane's bounding
     * rectangle. Range [-4, 12] each. Default 0, 0.
     */
    double pivot_m[2];
    /** Distance from the pivot to the blade's outer end, m. Range [0.01, 3], default 0.6. */
    double length_m;
    /** Distance from the pivot to the blade's inner end, m. Range [0, length_m), default 0.1. */
    double inner_radius_m;
    /**
     * Angle of the parked blade, degrees anticlockwise from the glass's right as seen from the camera. Range
     * [-360, 360], default 0.
     */
    double parked_deg;
    /** Angle at the far end of the stroke, degrees, within 350 of parked_deg. Default 90. */
    double far_deg;
    /**
     * Position of the blade in this frame: 0 parked, 1 at the far end. Range [0, 1], default 0. The blade moves at
     * constant speed from one frame to the next.
     */
    double position;
    /** Width of the rubber on the glass, m. Range [0, 0.1], default 0.006. */
    double blade_width_m;
} wk_wiper_arm;

/** Every field of `wk_wiper_arm` at its default. */
#define WK_WIPER_ARM_INIT { \
    /* struct_size */ (uint32_t)sizeof(wk_wiper_arm), \
    /* struct_type */ WK_STRUCT_TYPE_WIPER_ARM, \
    /* next */ NULL, \
    /* pivot_m */ { 0.0, 0.0 }, \
    /* length_m */ 0.6, \
    /* inner_radius_m */ 0.1, \
    /* parked_deg */ 0.0, \
    /* far_deg */ 90.0, \
    /* position */ 0.0, \
    /* blade_width_m */ 0.006 \
}

/** The window that a view looks through. */
typedef struct wk_windscreen {
    /** sizeof(wk_windscreen) of your header. */
    uint32_t struct_size;
    /** WK_STRUCT_TYPE_WINDSCREEN. */
    wk_struct_type struct_type;
    /** No extensions in this version: NULL. */
    const void *next;
    /** Shape of the glass. Default WK_WINDSCREEN_PANE_QUAD. */
    wk_windscreen_pane pane;
    /** Number of wipers in `arms`, at most 2. Default 0. */
    uint32_t arm_count;
    /**
     * Corners of a QUAD: lower left, lower right, upper right and upper left as seen from the camera. Each is three
     * numbers in the camera's axes (x right, y up, z backwards), m from the camera. The window is flat within 2 % of
     * its diagonal, and convex. Its edges are 0.05 to 8 m long, and no coordinate of a corner exceeds 20 m. Its slope
     * relative to gravity follows from the frame's view matrix. Default 1 m x 0.6 m across the view, 0.7 m away.
     */
    double corners_m[12];
    /** Distance of the glass of a WHOLE_VIEW, m. Range [0.1, 3], default 0.6. */
    double distance_m;
    /**
     * Velocity of the glass relative to the air (the vehicle's minus the wind's) in the camera's axes, m/s; it decides
     * how many drops the glass meets. Range [-400, 400] each, default 0, 0, 0.
     */
    double velocity_m_s[3];
    /**
     * Speed of the air along the glass, upwards, as close to the glass as a bead is high, m/s. It drives the beads.
     * About 0.7 of the vehicle's speed on a car's windscreen, 0 on upright glass. Range [-100, 100], default 0.
     */
    double airflow_m_s;
    /**
     * Share of the weather's rain that reaches the glass, such as 0 in a tunnel that you have not described as a
     * shelter. Shelters and occluder maps keep rain off each part of the pane separately. A box that contains the
     * camera and ends within 3 m in front of the glass is the vehicle's own, and keeps no rain off. Range [0, 1],
     * default 1.
     */
    double exposed;
    /** Amount of mist on the inside. Range [0, 1], default 0. */
    double fogging;
    /**
     * Share of the pane that the blower has cleared of mist, from the lower edge upwards. Range [0, 1], default 0.
     */
    double demist;
    /** The wipers; may be NULL if there are none. Read during the call only. */
    const wk_wiper_arm *arms;
    /** Bytes from one wiper to the next: sizeof(wk_wiper_arm) of your header, which is the default. */
    uint32_t arm_stride;
    /** Must be 0. */
    uint32_t reserved0;
    /**
     * Heat that wires in the glass or a blower give to the glass, W/m^2. It melts snow once it exceeds the loss to
     * cold air. A heated windscreen has about 600. Range [0, 3000], default 0.
     */
    double heat_w_m2;
} wk_windscreen;

/** Every field of `wk_windscreen` at its default. */
#define WK_WINDSCREEN_INIT { \
    /* struct_size */ (uint32_t)sizeof(wk_windscreen), \
    /* struct_type */ WK_STRUCT_TYPE_WINDSCREEN, \
    /* next */ NULL, \
    /* pane */ WK_WINDSCREEN_PANE_QUAD, \
    /* arm_count */ 0, \
    /* corners_m */ { -0.5, -0.3, -0.7, 0.5, -0.3, -0.7, 0.5, 0.3, -0.7, -0.5, 0.3, -0.7 }, \
    /* distance_m */ 0.6, \
    /* velocity_m_s */ { 0.0, 0.0, 0.0 }, \
    /* airflow_m_s */ 0.0, \
    /* exposed */ 1.0, \
    /* fogging */ 0.0, \
    /* demist */ 0.0, \
    /* arms */ NULL, \
    /* arm_stride */ (uint32_t)sizeof(wk_wiper_arm), \
    /* reserved0 */ 0, \
    /* heat_w_m2 */ 0.0 \
}

/** Water on a windscreen. */
typedef struct wk_windscreen_report {
    /** sizeof(wk_windscreen_report) of your header. */
    uint32_t struct_size;
    /** WK_STRUCT_TYPE_WINDSCREEN_REPORT. */
    wk_struct_type struct_type;
    /** No extensions in this version: NULL. */
    const void *next;
    /** Number of drops that hit the pane in a second (rain drops from 0.1 mm in diameter). */
    double drops_per_s;
    /** Rate of the water that hits the pane, mm/h on its area. */
    double water_mm_h;
    /** Share of the pane under water, 0 to 1. */
    double covered;
    /** Mass of the water on the pane, kg. */
    double water_kg;
    /** Simulation time of the state, s. */
    double state_time_s;
    /** Mass of the water in the snow on the pane, kg. */
    double snow_kg;
} wk_windscreen_report;

/** Every field of `wk_windscreen_report` at its default. */
#define WK_WINDSCREEN_REPORT_INIT { \
    /* struct_size */ (uint32_t)sizeof(wk_windscreen_report), \
    /* struct_type */ WK_STRUCT_TYPE_WINDSCREEN_REPORT, \
    /* next */ NULL, \
    /* drops_per_s */ 0.0, \
    /* water_mm_h */ 0.0, \
    /* covered */ 0.0, \
    /* water_kg */ 0.0, \
    /* state_time_s */ 0.0, \
    /* snow_kg */ 0.0 \
}

/**
 * Sets the window that the view looks through; NULL removes it. While the vehicle drives, the wipers move or the
 * camera turns, set it again before each frame: the water stays on the glass as long as the glass keeps its size.
 * Unchanged after an error. With a window, recording the stage LENS gives WK_ERROR_UNSUPPORTED for multisampled colour
 * and for parallel projections.
 * Thread: exclusive on the view.
 * Errors: WK_ERROR_INVALID_ARGUMENT naming the field and its range.
 */
WK_API
wk_status wk_view_set_windscreen(wk_view *view,
                                 const wk_windscreen *windscreen);

/**
 * Gets the amount of water on the view's windscreen as of its last frame, and the rate at which it lands. The call
 * reads the state back and waits for the GPU: use it now and then, not in every frame. All fields are 0 without a
 * windscreen or before the view's first frame.
 * Thread: exclusive on the view.
 * Errors: WK_ERROR_DEVICE_LOST.
 */
WK_API wk_status wk_view_get_windscreen_report(wk_view *view, wk_windscreen_report *out_report);

/**
 * Writes the default of every field: the same bytes as `WK_WIPER_ARM_INIT`. `struct_size` is `sizeof(wk_wiper_arm)`
 * as the caller was compiled, and is stored in the struct.
 */
WK_API wk_status wk_wiper_arm_init(wk_wiper_arm *out, uint32_t struct_size);

/**
 * Writes the default of every field: the same bytes as `WK_WINDSCREEN_INIT`. `struct_size` is `sizeof(wk_windscreen)`
 * as the caller was compiled, and is stored in the struct.
 */
WK_API wk_status wk_windscreen_init(wk_windscreen *out, uint32_t struct_size);

/**
 * Writes the default of every field: the same bytes as `WK_WINDSCREEN_REPORT_INIT`. `struct_size` is `sizeof(wk_windscreen_report)`
 * as the caller was compiled, and is stored in the struct.
 */
WK_API
wk_status wk_windscreen_report_init(wk_windscreen_report *out,
                                    uint32_t struct_size);

/*
 * ====================================================================================================
 * [ground] Wet ground
 *
 * The stage SURFACE reads the host's depth and draws water onto the host's picture. Wet ground is darker and mirrors
 * the sky, paved ground has puddles, and rain makes rings in them. Colours are right with WK_COLOR_SCENE_LINEAR; in
 * the display spaces Welkin takes the displayed colour for the ground's albedo. Ground without a wk_surface_class is
 * natural and hardly mirrors: mark roads and yards as WK_SURFACE_CLASS_PAVED. The mirrored picture is the sky's. Of
 * the host's objects, only shelters and occluder maps appear in it, as dark shapes.
 *
 * Wetness follows the present weather (wk_conditions.wetness, .puddles). With WK_GROUND_SIMULATED, set by a
 * wk_simulation_desc in wk_context_desc.next, the water on the ground is instead a state that fills, drains and dries
 * over time. wk_context_save keeps this state.
 * ====================================================================================================
 */

/**
 * Material of the ground; each value says how the material looks when it is wet. The first source that names a
 * material decides: an image of the target (the byte of red), then the wk_ground_grid or the tiles of the wk_terrain,
 * then the context's default.
 */
typedef uint32_t wk_surface_class;

/**
 * No material. In an image, a grid or a tile this value leaves the decision to the next source. As the context's
 * default it means natural ground: vegetation where the host's colour is green, soil elsewhere.
 */
#define WK_SURFACE_CLASS_UNSPECIFIED 0
/** Earth, sand, gravel: darkens and hardly mirrors. */
#define WK_SURFACE_CLASS_SOIL 1
/** Bare rock: darkens, and shines in places. */
#define WK_SURFACE_CLASS_ROCK 2
/** Asphalt, concrete, paving: darkens, gets a film that mirrors, and puddles. */
#define WK_SURFACE_CLASS_PAVED 3
/** Grass, crops, shrubs, trees: hardly changes. */
#define WK_SURFACE_CLASS_VEGETATION 4
/** Water that the host draws: Welkin leaves it as it is. */
#define WK_SURFACE_CLASS_WATER 5
/** Roofs and walls: darken and shine, without puddles. */
#define WK_SURFACE_CLASS_BUILDING 6

/** Water at a place of the ground. */
typedef struct wk_ground {
    /** sizeof(wk_ground) of your header. */
    uint32_t struct_size;
    /** WK_STRUCT_TYPE_GROUND. */
    wk_struct_type struct_type;
    /** No extensions in this version: NULL. */
    const void *next;
    /** Depth of the water on the ground, mm, as a tyre meets it: the film, plus standing water in a hollow. */
    double water_mm;
    /**
     * Depth of the film, mm: at the place if it lies on the host's terrain, else on level ground outside hollows.
     */
    double film_mm;
    /**
     * Wetness, of the place if it lies on the host's terrain, else of level, open ground: 0 dry, 0.3 damp, 1 under a
     * closed film.
     */
    double wetness;
    /**
     * Share of the host's terrain that is under standing water; for a place off the terrain, share of all ground.
     */
    double puddles;
    /** 1 where standing water covers the place, else 0. Off the host's terrain only paved ground has puddles. */
    uint32_t in_puddle;
    /** Always 0. */
    uint32_t reserved0;
    /** Material of the ground at the place, from the host's terrain or else from the context's default. */
    wk_surface_class surface_class;
    /** Always 0. */
    uint32_t reserved1;
} wk_ground;

/** Every field of `wk_ground` at its default. */
#define WK_GROUND_INIT { \
    /* struct_size */ (uint32_t)sizeof(wk_ground), \
    /* struct_type */ WK_STRUCT_TYPE_GROUND, \
    /* next */ NULL, \
    /* water_mm */ 0.0, \
    /* film_mm */ 0.0, \
    /* wetness */ 0.0, \
    /* puddles */ 0.0, \
    /* in_puddle */ 0, \
    /* reserved0 */ 0, \
    /* surface_class */ WK_SURFACE_CLASS_UNSPECIFIED, \
    /* reserved1 */ 0 \
}

/** Source of the ground's wetness. */
typedef uint32_t wk_ground_model;

/**
 * The present weather: the ground is as wet as the weather reports, or as the present rain keeps it. Ground that only
 * the rain keeps wet is dry as soon as the rain ends.
 */
#define WK_GROUND_REPORTED 0
/**
 * A simulated state. At simulation time 0 it starts with the wetness of the weather at that time. Rain fills the
 * ground's pores, the film on it and its hollows. The water drains and dries by wind, sun and humidity (Penman 1948)
 * in steps of 10 s. After a leap of more than a day only the last day is simulated, from the wetness of the weather at
 * the beginning of that day. See wk_context_update for leaps that take more than one call.
 */
#define WK_GROUND_SIMULATED 1

/** Source of the lying snow. */
typedef uint32_t wk_lying_snow_model;

/** The present weather: snow as deep as reported (wk_conditions.snow_depth_m), everywhere. */
#define WK_LYING_SNOW_REPORTED 0
/**
 * A simulated state that starts with the reported depth. Snowfall fills it; the snow settles, drifts, slides, melts
 * and refreezes in steps of 60 s. The state has the snow on level, open ground and on each cell of the host's terrain
 * (wk_context_set_ground_grid, wk_context_set_terrain). An update that moves time by more than a day runs as a
 * fast-forward (wk_context_accumulate). Of an update by more than 30 days only the last 30 days are simulated.
 */
#define WK_LYING_SNOW_SIMULATED 1

/** Settings of a context's simulated state. An extension: put it into wk_context_desc.next. */
typedef struct wk_simulation_desc {
    /** sizeof(wk_simulation_desc) of your header. */
    uint32_t struct_size;
    /** WK_STRUCT_TYPE_SIMULATION_DESC. */
    wk_struct_type struct_type;
    /** The next extension. Default NULL. */
    const void *next;
    /** Source of the ground's wetness. Default WK_GROUND_REPORTED. */
    wk_ground_model ground_model;
    /** Must be 0. */
    uint32_t reserved0;
    /** Source of the lying snow. Default WK_LYING_SNOW_REPORTED. */
    wk_lying_snow_model lying_snow_model;
    /** Must be 0. */
    uint32_t reserved1;
} wk_simulation_desc;

/** Every field of `wk_simulation_desc` at its default. */
#define WK_SIMULATION_DESC_INIT { \
    /* struct_size */ (uint32_t)sizeof(wk_simulation_desc), \
    /* struct_type */ WK_STRUCT_TYPE_SIMULATION_DESC, \
    /* next */ NULL, \
    /* ground_model */ WK_GROUND_REPORTED, \
    /* reserved0 */ 0, \
    /* lying_snow_model */ WK_LYING_SNOW_REPORTED, \
    /* reserved1 */ 0 \
}

/**
 * Gets the water on the ground at a place of the host's world, as of wk_context_get_state_time. On the host's terrain
 * (wk_context_set_ground_grid, wk_context_set_terrain) and up to 3 m above it, the answer is for the terrain's cell.
 * Elsewhere it is for level, open ground with the hollows that Welkin draws: a pattern fixed to the world by the
 * context's seed.
 * Thread: concurrent.
 * Errors: WK_ERROR_INVALID_ARGUMENT for an invalid position.
 */
WK_API
wk_status wk_context_get_ground(const wk_context *context,
                                const double (*position_m)[3],
                                wk_ground *out_ground);

/**
 * Sets the surface class of ground that has none from the target's image or the host's terrain. Default
 * WK_SURFACE_CLASS_UNSPECIFIED: natural ground. The class is part of the saved state.
 * Thread: exclusive.
 * Errors: WK_ERROR_INVALID_ARGUMENT for an unknown class.
 */
WK_API wk_status wk_context_set_default_surface_class(wk_context *context, wk_surface_class surface_class);

/**
 * Writes the default of every field: the same bytes as `WK_SIMULATION_DESC_INIT`. `struct_size` is `sizeof(wk_simulation_desc)`
 * as the caller was compiled, and is stored in the struct.
 */
WK_API
wk_status wk_simulation_desc_init(wk_simulation_desc *out,
                                  uint32_t struct_size);

/**
 * Writes the default of every field: the same bytes as `WK_GROUND_INIT`. `struct_size` is `sizeof(wk_ground)`
 * as the caller was compiled, and is stored in the struct.
 */
WK_API wk_status wk_ground_init(wk_ground *out, uint32_t struct_size);

/*
 * ====================================================================================================
 * [ground_grid] Water on the host's terrain
 *
 * Give the heights of your terrain on a grid, and Welkin computes wetness and puddles cell by cell. Rain areas, and
 * boxes that stand still (wk_context_set_shelters), determine the rain that each cell receives. Water runs off and
 * fills the terrain's hollows until they spill. wk_context_get_ground answers by place, the stage SURFACE draws the
 * water, and wk_context_get_ground_cells returns it for your own materials. With WK_GROUND_SIMULATED the water is a
 * state, which wk_context_save keeps together with the heights. Otherwise the water follows from the weather's
 * wetness, spread over the hollows.
 * ====================================================================================================
 */

/**
 * Heights of the host's terrain on a grid that is level and aligned to true north. Each node is the middle of a square
 * cell. Water is interpolated linearly between nodes. Outside the grid lies the world's ground, into which the picture
 * blends over two cells.
 */
typedef struct wk_ground_grid {
    /** sizeof(wk_ground_grid) of your header. */
    uint32_t struct_size;
    /** WK_STRUCT_TYPE_GROUND_GRID. */
    wk_struct_type struct_type;
    /** No extensions in this version: NULL. */
    const void *next;
    /**
     * Position of the south-western node in the host's world, m, within 1e12 m of the world's origin. heights_m are
     * measured upwards from this position. Default 0, 0, 0.
     */
    double origin_m[3];
    /** Distance between nodes, m. Range [0.01, 10 000], default 1. A puddle must be several cells wide to appear. */
    double cell_m;
    /** Number of nodes east and north. Range [2, 512] each, default 2, 2. */
    uint32_t nodes[2];
    /**
     * Heights of the nodes above origin_m, m, within 1e5. Nodes run from west to east, rows from south to north.
     * Copied by the call.
     */
    const float *heights_m;
    /** Number of values in heights_m: the product of `nodes`. */
    uint32_t height_count;
    /** Must be 0. */
    uint32_t reserved0;
    /**
     * Class of each cell, in the order of the heights: a wk_surface_class, or 0 to use the context's default. Copied
     * by the call. Default NULL: 0 for all cells.
     */
    const uint8_t *surface_classes;
    /** Number of values in surface_classes: 0 (the default), or height_count. */
    uint32_t surface_class_count;
    /** Must be 0. */
    uint32_t reserved1;
} wk_ground_grid;

/** Every field of `wk_ground_grid` at its default. */
#define WK_GROUND_GRID_INIT { \
    /* struct_size */ (uint32_t)sizeof(wk_ground_grid), \
    /* struct_type */ WK_STRUCT_TYPE_GROUND_GRID, \
    /* next */ NULL, \
    /* origin_m */ { 0.0, 0.0, 0.0 }, \
    /* cell_m */ 1.0, \
    /* nodes */ { 2, 2 }, \
    /* heights_m */ NULL, \
    /* height_count */ 0, \
    /* reserved0 */ 0, \
    /* surface_classes */ NULL, \
    /* surface_class_count */ 0, \
    /* reserved1 */ 0 \
}

/**
 * Water of a cell of the host's terrain. Element of an array, without struct_size; calls take its sizeof instead. A
 * packed array can be uploaded as a texture of four floats per texel.
 */
typedef struct wk_ground_cell {
    /** Film: water on and between the grains of the surface, mm; 0 under standing water. */
    float film_mm;
    /** Water in the pores, as a share of their capacity, 0 to 1. */
    float soaked;
    /** Standing water, mm. */
    float standing_mm;
    /**
     * Share of the cell under ice, 0 to 1, by the present weather. Freezing rain leaves no ice where boxes that stand
     * still keep it off.
     */
    float ice;
} wk_ground_cell;

/**
 * Sets the heights of the host's terrain, in place of a grid or tiles (wk_context_set_terrain) set before. NULL
 * removes the grid, but not tiles; without either the ground is level everywhere. Setting the same grid again keeps
 * its water, even with other classes; a different grid starts as wet as level ground is. For the largest grids the
 * call may take some tenths of a second. A failed call changes nothing.
 * Thread: exclusive.
 * Errors: WK_ERROR_INVALID_ARGUMENT naming the field and its range.
 */
WK_API wk_status wk_context_set_ground_grid(wk_context *context, const wk_ground_grid *ground_grid);

/**
 * Copies the water of the cells of a wk_ground_grid as of wk_context_get_state_time, in the order of the heights. For
 * tiles use wk_context_get_terrain_water. `cell_size` is sizeof(wk_ground_cell) of your header. `out_revision` gets a
 * number that changes whenever the cells change, at most once every 10 s of simulation time. With capacity 0 the call
 * returns only this number, so you can skip uploads when nothing has changed.
 * Thread: concurrent.
 * Errors: WK_ERROR_WRONG_ORDER without a wk_ground_grid; WK_ERROR_INVALID_ARGUMENT for a capacity other than 0 that is
 * too small.
 */
WK_API
wk_status wk_context_get_ground_cells(const wk_context *context,
                                      wk_ground_cell *cells,
                                      uint32_t capacity,
                                      uint32_t cell_size,
                                      uint64_t *out_revision);

/**
 * Writes the default of every field: the same bytes as `WK_GROUND_GRID_INIT`. `struct_size` is `sizeof(wk_ground_grid)`
 * as the caller was compiled, and is stored in the struct.
 */
WK_API
wk_status wk_ground_grid_init(wk_ground_grid *out,
                              uint32_t struct_size);

/*
 * ====================================================================================================
 * [ground_texture] Water on the host's terrain as a texture
 *
 * A native texture for the host's own materials, with the water of the terrain's cells. The cells of a grid
 * (wk_context_set_ground_grid) are uploaded once for both the host and the stage SURFACE. For tiles
 * (wk_context_set_terrain) the texture covers a window around a place. Each cell is one texel; the first one is the
 * south-western cell, and rows go north, in every graphics interface. The functions from wk_get_ground_snippet, in
 * GLSL and WGSL, compute how the wet surface looks.
 * ====================================================================================================
 */

/** Texture of the water of the terrain's cells: of a whole grid, or of the tiles around a place. */
typedef struct wk_ground_texture {
    /** sizeof(wk_ground_texture) of your header. */
    uint32_t struct_size;
    /** WK_STRUCT_TYPE_GROUND_TEXTURE. */
    wk_struct_type struct_type;
    /** No extensions in this version: NULL. */
    const void *next;
    /**
     * RGBA half floats: an OpenGL texture name (GL_TEXTURE_2D) or a VkImage (VK_FORMAT_R16G16B16A16_SFLOAT). The
     * channels are film_mm, soaked, standing_mm and ice of wk_ground_cell, each within 1/2048 of its value, standing
     * water up to 65 504 mm. Where no water stands, standing_mm is negative: it is the depth of the hollow's water
     * level below the ground, mm, or -50 where the hollow is dry. A shore between texels therefore lies where
     * standing_mm crosses 0.
     */
    uint64_t texture;
    /**
     * Number that changes whenever `texture` becomes another object, even one of the same name: after another grid was
     * set or loaded. For tiles it never changes.
     */
    uint64_t generation;
    /**
     * Revision of the texture's contents: for a grid, that of wk_context_get_ground_cells; for tiles, the number of
     * writes to the texture so far.
     */
    uint64_t revision;
    /** Width, texels: the number of nodes of a grid to the east, or 512 for tiles. */
    uint32_t width;
    /** Height, texels: the number of nodes of a grid to the north, or 512 for tiles. */
    uint32_t height;
    /**
     * Two rows of a matrix: multiplied by (x, y, z, 1) of a place in the host's world, m, they give the texture
     * coordinates u and v of the place. (0, 0) is the south-western corner of the first texel. For single precision,
     * see uv_from_world of wk_cloud_shadows.
     */
    double uv_from_world[2][4];
    /**
     * Texture of the snow on the same grid, an object like `texture`; its channels are depth_m, density_kg_m3, wetness
     * and albedo of wk_lying_snow. The field is 0 without WK_LYING_SNOW_SIMULATED. The snow in the texture changes at
     * most once every 60 s of simulation time.
     */
    uint64_t snow_texture;
} wk_ground_texture;

/** Every field of `wk_ground_texture` at its default. */
#define WK_GROUND_TEXTURE_INIT { \
    /* struct_size */ (uint32_t)sizeof(wk_ground_texture), \
    /* struct_type */ WK_STRUCT_TYPE_GROUND_TEXTURE, \
    /* next */ NULL, \
    /* texture */ UINT64_C(0), \
    /* generation */ UINT64_C(0), \
    /* revision */ UINT64_C(0), \
    /* width */ 0, \
    /* height */ 0, \
    /* uv_from_world */ { { 0.0, 0.0, 0.0, 0.0 }, { 0.0, 0.0, 0.0, 0.0 } }, \
    /* snow_texture */ UINT64_C(0) \
}

/**
 * Gets the native texture of the water on a wk_ground_grid, up to date. Call this function after each
 * wk_context_update; the call costs nothing if nothing has changed. The water changes at most once every 10 s of
 * simulation time. This call, or a wk_view_record with SURFACE, uploads the changes in order with the host's work on
 * the device's queue or context. The texture belongs to the context and stays the same until you set or load another
 * grid, or remove the grid. Before you do so, wait for GPU work that samples the texture. In Vulkan it is in
 * VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL between calls, and you may copy from it. It has no mipmaps; choose filter
 * and wrap yourself.
 * Thread: exclusive.
 * Errors: WK_ERROR_WRONG_ORDER without a wk_ground_grid; WK_ERROR_UNSUPPORTED on an own device, where the host has no
 * shaders.
 */
WK_API wk_status wk_context_get_ground_texture(wk_context *context, wk_ground_texture *out_texture);

/**
 * Gets the native textures of the tiles around a place, up to date, as wk_context_get_ground_texture does for a grid.
 * The textures cover a window of 512 x 512 cells, which moves in steps of 64 cells so that `center_m` stays within the
 * middle 64 x 64 cells of the window. `uv_from_world` is the present placement of the window. Where no tile has
 * ground, the textures have neither water nor snow. Call this function after each wk_context_update; with several
 * cameras, call it before you draw the picture of each one. The call costs nothing if nothing has changed; after a
 * move it uploads the whole window. Both textures stay the same as long as the context lives.
 * Thread: exclusive.
 * Errors: WK_ERROR_INVALID_ARGUMENT for an invalid position; WK_ERROR_WRONG_ORDER where no tile reaches into the
 * window; WK_ERROR_UNSUPPORTED on an own device, where the host has no shaders.
 */
WK_API
wk_status wk_context_get_terrain_texture(wk_context *context,
                                         const double (*center_m)[3],
                                         wk_ground_texture *out_texture);

/**
 * Gets the text of the functions that compute how a texel's surface looks: how dark it is, how much of it mirrors, and
 * how rough it is. NUL-terminated UTF-8 that lives as long as the process.
 * Thread: any.
 * Errors: WK_ERROR_INVALID_ARGUMENT for an unknown language.
 */
WK_API
wk_status wk_get_ground_snippet(wk_shading_language language,
                                const char **out_text);

/**
 * Writes the default of every field: the same bytes as `WK_GROUND_TEXTURE_INIT`. `struct_size` is `sizeof(wk_ground_texture)`
 * as the caller was compiled, and is stored in the struct.
 */
WK_API
wk_status wk_ground_texture_init(wk_ground_texture *out,
                                 uint32_t struct_size);

/*
 * ====================================================================================================
 * [snowpack] Lying snow
 *
 * The stage SURFACE draws snow onto the host's surfaces that face up, as deep as the weather reports it
 * (wk_weather.surface_snow_depth_m). Shallow snow lies in patches, deeper snow everywhere. With
 * WK_LYING_SNOW_SIMULATED in a wk_simulation_desc the snow is a simulated state: it falls, settles, drifts, slides,
 * melts into the ground's water and refreezes. The state covers level, open ground and each cell of the host's terrain
 * (wk_context_set_ground_grid, wk_context_set_terrain), and wk_context_save keeps it. Standing boxes
 * (wk_context_set_shelters) keep snow off the ground and cause drifts.
 * ====================================================================================================
 */

/** Class of the grip that snow leaves to a wheel. */
typedef uint32_t wk_snow_friction;

/** No snow, or so little that it covers less than 30 % of the ground. */
#define WK_SNOW_FRICTION_BARE 0
/** Loose snow, dry or with at most half of the liquid water that it can hold. */
#define WK_SNOW_FRICTION_LOOSE 1
/** Snow above 350 kg/m^3: pressed, or packed by wind. */
#define WK_SNOW_FRICTION_PACKED 2
/** Slush: snow with more than half of the liquid water that it can hold. */
#define WK_SNOW_FRICTION_SLUSH 3
/** Snow above 650 kg/m^3: frozen hard. */
#define WK_SNOW_FRICTION_ICE 4

/** Snow at a place. Element of an array, without struct_size; calls take its sizeof instead. */
typedef struct wk_lying_snow {
    /** Depth, m. */
    double depth_m;
    /** Mass of ice and liquid water, kg/m^2 (millimetres of water). */
    double mass_kg_m2;
    /** Density, kg/m^3; 0 without snow. */
    double density_kg_m3;
    /** Ratio of the liquid water in the snow to the most that the snow can hold, 0 to 1. */
    double wetness;
    /** Albedo for visible light; 0 without snow. */
    double albedo;
    /** Share of the ground that snow covers, 0 to 1. */
    double cover;
    /**
     * Point of the snow's surface above or below the queried position, in the host's world: at the terrain's height
     * plus the snow's depth. Off the host's terrain, or more than 3 m above it, the queried position itself.
     */
    double surface_m[3];
    /** Grip of a wheel. */
    wk_snow_friction friction;
    /** Always 0. */
    uint32_t reserved0;
} wk_lying_snow;

/** A strip of ground: a path with a width. Two points and a width make a rectangle. */
typedef struct wk_snow_strip {
    /** sizeof(wk_snow_strip) of your header. */
    uint32_t struct_size;
    /** WK_STRUCT_TYPE_SNOW_STRIP. */
    wk_struct_type struct_type;
    /** No extensions in this version: NULL. */
    const void *next;
    /**
     * Points of the path in the host's world, m, within 1e12 m of the origin; their heights do not matter. The path
     * has square ends and round bends. Read during the call.
     */
    const double (*points_m)[3];
    /** Number of points. Range 2 to 1024. */
    uint32_t point_count;
    /** Must be 0. */
    uint32_t reserved0;
    /** Width of the strip, m. Range [0.01, 1000], default 1. */
    double width_m;
} wk_snow_strip;

/** Every field of `wk_snow_strip` at its default. */
#define WK_SNOW_STRIP_INIT { \
    /* struct_size */ (uint32_t)sizeof(wk_snow_strip), \
    /* struct_type */ WK_STRUCT_TYPE_SNOW_STRIP, \
    /* next */ NULL, \
    /* points_m */ NULL, \
    /* point_count */ 0, \
    /* reserved0 */ 0, \
    /* width_m */ 1.0 \
}

/**
 * Gets the snow at places of the host's world, at most wk_caps.max_batch of them, as of wk_context_get_state_time. On
 * the host's terrain and up to 3 m above it, the answer is interpolated between the terrain's cells; elsewhere it is
 * that of level, open ground. `position_size` and `snow_size` are the distances from one element to the next, bytes:
 * 24 or more for positions, sizeof(wk_lying_snow) of your header for snow.
 * Thread: concurrent.
 * Errors: WK_ERROR_INVALID_ARGUMENT for an invalid position.
 */
WK_API
wk_status wk_context_get_lying_snow(const wk_context *context,
                                    const double (*positions_m)[3],
                                    uint32_t count,
                                    uint32_t position_size,
                                    wk_lying_snow *snow,
                                    uint32_t snow_size);

/**
 * Removes the snow of a strip of the host's terrain except the lowest `left_m` metres (range [0, 100]), as a plough or
 * a shovel does. `out_mass_kg` gets the removed mass and may be NULL.
 * Thread: exclusive.
 * Errors: WK_ERROR_INVALID_ARGUMENT naming the field; WK_ERROR_WRONG_ORDER without a terrain or without
 * WK_LYING_SNOW_SIMULATED, and while steps of an update remain.
 */
WK_API
wk_status wk_context_take_snow(wk_context *context,
                               const wk_snow_strip *strip,
                               double left_m,
                               double *out_mass_kg);

/**
 * Compacts the snow of a strip of the host's terrain to 500 kg/m^3 where it is less dense, as a wheel does.
 * Thread: exclusive.
 * Errors: as wk_context_take_snow.
 */
WK_API wk_status wk_context_press_snow(wk_context *context, const wk_snow_strip *strip);

/**
 * Advances time by `hours`, in (0, 720], with the snow in steps of ten minutes, so that a lesson can begin after a
 * night's snowfall. The laws are those of ordinary steps, but the resulting state differs by up to some percent from
 * the state after ordinary steps. The state records that it was made in this way (wk_context_state_hash). Everything
 * else advances as with wk_context_update, but in this one call: with the largest terrain it may take some seconds.
 * Thread: exclusive.
 * Errors: WK_ERROR_INVALID_ARGUMENT naming the range; WK_ERROR_WRONG_ORDER while steps of an update remain.
 */
WK_API wk_status wk_context_accumulate(wk_context *context, double hours);

/**
 * Writes the default of every field: the same bytes as `WK_SNOW_STRIP_INIT`. `struct_size` is `sizeof(wk_snow_strip)`
 * as the caller was compiled, and is stored in the struct.
 */
WK_API wk_status wk_snow_strip_init(wk_snow_strip *out, uint32_t struct_size);

/*
 * ====================================================================================================
 * [terrain] Terrain in tiles
 *
 * The host can describe its terrain as a lattice of equal cells, cut into square tiles with keys. The lattice is
 * horizontal and aligned to true north at its origin. Each cell has a height and a class of surface, or is a hole.
 * Tiles can be added and removed, and rectangles of their cells changed. The cost of a change grows with the
 * rectangle, so an excavator's bucket may dig in every frame. Water, the wind field and queries read the tiles. With
 * WK_GROUND_SIMULATED each cell has its own water, and hollows join across the borders of tiles; with
 * WK_GROUND_REPORTED tiles are as wet as level ground. A context has either tiles or one wk_ground_grid.
 *
 * The host's heights are the undug ground. With wk_context_set_soil the library adds what the soil's tools dig and
 * heap, and queries, water, snow and wind see the sum. wk_context_save saves the water and the change by soil, not the
 * host's heights, and wk_context_load requires that the same tiles have been set before. wk_context_set_terrain and
 * the functions of tiles may be called between updates at any time; while an update has steps left (WK_PENDING), a
 * change takes effect after the last of them.
 * ====================================================================================================
 */

/** Value in surface_classes of wk_terrain_cells for a cell without ground. Water beside it runs off. */
#define WK_TERRAIN_HOLE 255

/** The lattice of a terrain in tiles. */
typedef struct wk_terrain {
    /** sizeof(wk_terrain) of your header. */
    uint32_t struct_size;
    /** WK_STRUCT_TYPE_TERRAIN. */
    wk_struct_type struct_type;
    /** No extensions in this version: NULL. */
    const void *next;
    /**
     * Position of the south-western cell of tile (0, 0), in the host's world, m, within 1e12 m of the origin. Heights
     * of cells are relative to the height of this position. Default 0, 0, 0.
     */
    double origin_m[3];
    /** Distance between cells, m. Range [0.01, 10 000], default 1. A puddle must be several cells wide to appear. */
    double cell_m;
    /**
     * Number of cells along each side of a tile: a power of two from 32 to 1024. Default 256. The tiles of a terrain
     * may have 16 777 216 cells together.
     */
    uint32_t tile_cells;
    /** Must be 0. */
    uint32_t reserved0;
} wk_terrain;

/** Every field of `wk_terrain` at its default. */
#define WK_TERRAIN_INIT { \
    /* struct_size */ (uint32_t)sizeof(wk_terrain), \
    /* struct_type */ WK_STRUCT_TYPE_TERRAIN, \
    /* next */ NULL, \
    /* origin_m */ { 0.0, 0.0, 0.0 }, \
    /* cell_m */ 1.0, \
    /* tile_cells */ 256, \
    /* reserved0 */ 0 \
}

/**
 * Heights and classes of a tile, or of a rectangle of its cells. Cells run from west to east, rows from south to
 * north.
 */
typedef struct wk_terrain_cells {
    /** sizeof(wk_terrain_cells) of your header. */
    uint32_t struct_size;
    /** WK_STRUCT_TYPE_TERRAIN_CELLS. */
    wk_struct_type struct_type;
    /** No extensions in this version: NULL. */
    const void *next;
    /**
     * Key of the tile: its position east and north of the origin in tiles, each within 1 000 000; negative to the west
     * and south. Default 0, 0.
     */
    int32_t tile[2];
    /** Position of the rectangle's south-western cell in the tile, cells east and north. Default 0, 0. */
    uint32_t first_cell[2];
    /** Size of the rectangle, cells east and north. Default 0, 0: the whole tile. */
    uint32_t cells[2];
    /**
     * Heights above the terrain's origin, m, within 1e5. Copied by the call. NULL with a count of 0 leaves the heights
     * unchanged; a new tile needs them. The height of a hole is not read and may be anything, also NaN.
     */
    const float *heights_m;
    /** Length of heights_m: at least (rows - 1) x stride + columns of the rectangle. */
    uint32_t height_count;
    /**
     * Number of elements of heights_m from the beginning of a row to that of the next. Default 0: the columns of the
     * rectangle, so that rows follow without a gap.
     */
    uint32_t height_stride;
    /**
     * Class of each cell: a wk_surface_class, 0 to use the context's default, or WK_TERRAIN_HOLE. Copied by the call.
     * NULL with a count of 0 leaves the classes unchanged; in a new tile they are then 0.
     */
    const uint8_t *surface_classes;
    /** Length of surface_classes: at least (rows - 1) x stride + columns of the rectangle. */
    uint32_t surface_class_count;
    /**
     * Number of elements of surface_classes from the beginning of a row to that of the next. Default 0: the columns of
     * the rectangle, so that rows follow without a gap.
     */
    uint32_t surface_class_stride;
    /** 1 if no_data_m is used; 0, the default, if every number in heights_m is a height. */
    uint32_t has_no_data;
    /**
     * Number in heights_m for cells without data, such as -9999, -32768, or your source's own; NaN then also means no
     * data. These cells become holes. A hole becomes ground again when surface_classes gives it a class. The call
     * fails if the number is also a real height: in a cell to which surface_classes gives a class other than 0, or in
     * a cell with ground in the same tile outside the rectangle. Default 0.
     */
    float no_data_m;
} wk_terrain_cells;

/** Every field of `wk_terrain_cells` at its default. */
#define WK_TERRAIN_CELLS_INIT { \
    /* struct_size */ (uint32_t)sizeof(wk_terrain_cells), \
    /* struct_type */ WK_STRUCT_TYPE_TERRAIN_CELLS, \
    /* next */ NULL, \
    /* tile */ { 0, 0 }, \
    /* first_cell */ { 0, 0 }, \
    /* cells */ { 0, 0 }, \
    /* heights_m */ NULL, \
    /* height_count */ 0, \
    /* height_stride */ 0, \
    /* surface_classes */ NULL, \
    /* surface_class_count */ 0, \
    /* surface_class_stride */ 0, \
    /* has_no_data */ 0, \
    /* no_data_m */ 0.0f \
}

/** Settings with which Welkin draws the tiles of a terrain. */
typedef struct wk_terrain_drawing {
    /** sizeof(wk_terrain_drawing) of your header. */
    uint32_t struct_size;
    /** WK_STRUCT_TYPE_TERRAIN_DRAWING. */
    wk_struct_type struct_type;
    /** No extensions in this version: NULL. */
    const void *next;
    /**
     * Largest vertical error of the drawn triangles on 99.7 % of the ground, pixels. Range [0.25, 16], default 1. It
     * sets the distance up to which each level of detail is drawn: 40 to 160 times the side of the level's squares.
     * Ground so rough that it would need a longer distance is drawn with a larger error.
     */
    double error_px;
    /**
     * Distance from the camera up to which the ground has shadows of the sun and the moon, m. 0 for none, or range
     * [100, 1e5], default 1e4. A shorter distance makes near shadows sharper. A view with shadows holds up to about 36
     * MB more: the shadow maps, and the heights of the ground that is drawn into them.
     */
    double shadows_to_m;
} wk_terrain_drawing;

/** Every field of `wk_terrain_drawing` at its default. */
#define WK_TERRAIN_DRAWING_INIT { \
    /* struct_size */ (uint32_t)sizeof(wk_terrain_drawing), \
    /* struct_type */ WK_STRUCT_TYPE_TERRAIN_DRAWING, \
    /* next */ NULL, \
    /* error_px */ 1.0, \
    /* shadows_to_m */ 1e4 \
}

/** Terrain at a queried place. Element of an array, without struct_size; calls take its sizeof instead. */
typedef struct wk_terrain_point {
    /**
     * Height of the ground above the terrain's origin, m, on the triangle of three neighbouring cells: each square of
     * four cells is split from its south-western to its north-eastern cell. 0 where there is no ground.
     */
    double height_m;
    /** Unit normal of the ground's triangle in the host's axes, upwards; 0, 0, 0 where there is no ground. */
    double normal[3];
    /** Revision of the terrain at the last change of the nearest cell's tile. 0 where there is no ground. */
    uint64_t revision;
    /** Key of the nearest cell's tile. */
    int32_t tile[2];
    /** Material of the nearest cell; WK_SURFACE_CLASS_UNSPECIFIED if it has none. */
    wk_surface_class surface_class;
    /**
     * 1 on the ground of a tile; 0 off all tiles, and on a triangle with a corner that is a hole or lies off all
     * tiles.
     */
    uint32_t has_ground;
} wk_terrain_point;

/**
 * Sets the lattice of a terrain in tiles, which has no tiles at first. The lattice replaces all tiles or the
 * wk_ground_grid set before; NULL removes a lattice with its tiles. Setting the present lattice again keeps its tiles.
 * Unchanged after an error.
 * Thread: exclusive.
 * Errors: WK_ERROR_INVALID_ARGUMENT naming the field and its range.
 */
WK_API
wk_status wk_context_set_terrain(wk_context *context,
                                 const wk_terrain *terrain);

/**
 * Adds a tile, or replaces the values of all cells of an existing tile. A new tile begins as wet as level ground; an
 * existing one keeps its water. The call takes some tens of milliseconds for 256 x 256 cells. Unchanged after an
 * error.
 * Thread: exclusive.
 * Errors: WK_ERROR_WRONG_ORDER before wk_context_set_terrain; WK_ERROR_INVALID_ARGUMENT naming the field, or for more
 * cells than a terrain may have.
 */
WK_API wk_status wk_context_set_terrain_tile(wk_context *context, const wk_terrain_cells *terrain_cells);

/**
 * Changes the heights, the classes, or both, of a rectangle of a tile's cells. Water that stands there flows as the
 * new ground allows: off a raised floor, into a new pit. The cost grows with the rectangle and with the standing water
 * that it touches, not with the tile or the terrain. Unchanged after an error.
 * Thread: exclusive.
 * Errors: as wk_context_set_terrain_tile; WK_ERROR_INVALID_ARGUMENT for a key that no tile has.
 */
WK_API
wk_status wk_context_update_terrain(wk_context *context,
                                    const wk_terrain_cells *terrain_cells);

/**
 * Removes a tile and the water on it. Water of the other tiles runs off where the tile was.
 * Thread: exclusive.
 * Errors: WK_ERROR_WRONG_ORDER before wk_context_set_terrain; WK_ERROR_INVALID_ARGUMENT for a key that no tile has.
 */
WK_API wk_status wk_context_remove_terrain_tile(wk_context *context, int32_t tile_east, int32_t tile_north);

/**
 * Sets whether and how Welkin draws the tiles into frames whose depth it may write, in WK_STAGE_SURFACE. NULL, the
 * default, leaves them to the host. Settings are not saved. Unchanged after an error.
 * Thread: exclusive.
 * Errors: WK_ERROR_INVALID_ARGUMENT naming the field and its range.
 */
WK_API
wk_status wk_context_set_terrain_drawing(wk_context *context,
                                         const wk_terrain_drawing *terrain_drawing);

/**
 * Gets a number that grows whenever the host changes the tiles or soil changes their heights; 0 without a terrain.
 * Thread: concurrent.
 */
WK_API wk_status wk_context_get_terrain_revision(const wk_context *context, uint64_t *out_revision);

/**
 * Gets the terrain straight below or above places of the host's world, at most wk_caps.max_batch of them.
 * `position_size` and `point_size` are the distances from one element to the next, bytes: 24 or more for positions,
 * sizeof(wk_terrain_point) of your header for points.
 * Thread: concurrent.
 * Errors: WK_ERROR_INVALID_ARGUMENT for an invalid position.
 */
WK_API
wk_status wk_context_get_terrain_at(const wk_context *context,
                                    const double (*positions_m)[3],
                                    uint32_t count,
                                    uint32_t position_size,
                                    wk_terrain_point *points,
                                    uint32_t point_size);

/**
 * Copies the water of a tile's cells as of wk_context_get_state_time, by rows from the south-west; `cell_size` is
 * sizeof(wk_ground_cell) of your header. Holes are dry. `out_revision` gets a number that changes whenever water on
 * the terrain changes; with capacity 0 the call returns only this number.
 * Thread: concurrent.
 * Errors: WK_ERROR_INVALID_ARGUMENT for a key that no tile has, or a capacity other than 0 that is too small.
 */
WK_API
wk_status wk_context_get_terrain_water(const wk_context *context,
                                       int32_t tile_east,
                                       int32_t tile_north,
                                       wk_ground_cell *cells,
                                       uint32_t capacity,
                                       uint32_t cell_size,
                                       uint64_t *out_revision);

/**
 * Writes the default of every field: the same bytes as `WK_TERRAIN_INIT`. `struct_size` is `sizeof(wk_terrain)`
 * as the caller was compiled, and is stored in the struct.
 */
WK_API wk_status wk_terrain_init(wk_terrain *out, uint32_t struct_size);

/**
 * Writes the default of every field: the same bytes as `WK_TERRAIN_DRAWING_INIT`. `struct_size` is `sizeof(wk_terrain_drawing)`
 * as the caller was compiled, and is stored in the struct.
 */
WK_API
wk_status wk_terrain_drawing_init(wk_terrain_drawing *out,
                                  uint32_t struct_size);

/**
 * Writes the default of every field: the same bytes as `WK_TERRAIN_CELLS_INIT`. `struct_size` is `sizeof(wk_terrain_cells)`
 * as the caller was compiled, and is stored in the struct.
 */
WK_API
wk_status wk_terrain_cells_init(wk_terrain_cells *out,
                                uint32_t struct_size);

/*
 * ====================================================================================================
 * [sea] The sea: settings and queries
 *
 * Describe your sea. Queries then give the height and slope of its surface and the motion of the water at any time, so
 * that a hull can float by the answers. Without settings a context has no sea. A wave height, swell or water
 * temperature that you set here replaces that of the weather (wk_weather.sea_significant_wave_height_m,
 * swell_height_m, sea_temperature_c). If neither you nor the weather gives a wave height or a sea state, the weather's
 * wind raises the waves by fetch and duration. The waves have the requested height within 1 %, their pattern does not
 * repeat, and the same time gives the same bits on every machine. Regions (wk_context_set_sea_regions) describe dry
 * places, sheltered harbours, and lakes with a level of their own. Hulls (wk_context_set_sea_hulls) raise wakes.
 *
 * wk_sea sea = WK_SEA_INIT;
 * sea.has = WK_SEA_HAS_HEIGHT | WK_SEA_HAS_PEAK_PERIOD;
 * sea.significant_height_m = 2.1;
 * sea.peak_period_s = 6.2;
 * wk_context_set_sea(context, &sea);
 * wk_context_get_sea_at(context, corners_m, 4, sizeof corners_m[0], time_s, 0.0, points, sizeof points[0]);
 * ====================================================================================================
 */

/** Flags that say which optional fields of a wk_sea are set. */
typedef uint32_t wk_sea_has_flags;

/** fetch_m */
#define WK_SEA_HAS_FETCH 1
/** significant_height_m; not together with SEA_STATE or BEAUFORT. */
#define WK_SEA_HAS_HEIGHT 2
/** peak_period_s; needs HEIGHT. */
#define WK_SEA_HAS_PEAK_PERIOD 4
/** peak_gamma; needs HEIGHT. */
#define WK_SEA_HAS_PEAK_GAMMA 8
/** sea_state; not together with HEIGHT or BEAUFORT. */
#define WK_SEA_HAS_SEA_STATE 16
/** beaufort; not together with HEIGHT or SEA_STATE. */
#define WK_SEA_HAS_BEAUFORT 32
/** wind_sea_from_deg */
#define WK_SEA_HAS_WIND_SEA_FROM 64
/** swells: they replace the weather's swell, also with swell_count 0. */
#define WK_SEA_HAS_SWELLS 128
/** temperature_c */
#define WK_SEA_HAS_TEMPERATURE 256
/** clarity_percent, in place of water_type. */
#define WK_SEA_HAS_CLARITY 512
/** ice_cover, ice_floe_m and ice_width_m */
#define WK_SEA_HAS_ICE 1024

/** Properties of a sea. */
typedef uint32_t wk_sea_flags;

/** Waves break without foam. */
#define WK_SEA_WITHOUT_WHITECAPS 1
/** There is water only inside regions (wk_context_set_sea_regions). */
#define WK_SEA_ONLY_IN_REGIONS 2

/** Optical type of water (Jerlov 1976). */
typedef uint32_t wk_water_type;

/** Ocean I, the clearest. */
#define WK_WATER_TYPE_I 0
/** Ocean IB. */
#define WK_WATER_TYPE_IB 1
/** Ocean II. */
#define WK_WATER_TYPE_II 2
/** Ocean III. */
#define WK_WATER_TYPE_III 3
/** Coast 1C. */
#define WK_WATER_TYPE_1C 4
/** Coast 3C. */
#define WK_WATER_TYPE_3C 5
/** Coast 5C. */
#define WK_WATER_TYPE_5C 6
/** Coast 7C, the most turbid of these eight. */
#define WK_WATER_TYPE_7C 7

/** A swell: waves from far away. */
typedef struct wk_sea_swell {
    /** sizeof(wk_sea_swell) of your header. */
    uint32_t struct_size;
    /** WK_STRUCT_TYPE_SEA_SWELL. */
    wk_struct_type struct_type;
    /** No extensions in this version: NULL. */
    const void *next;
    /** Significant height, m. Range [0, 20], default 0; at most a fifteenth of the wave length at the peak. */
    double height_m;
    /** Peak period, s. Range [1, 30], default 10. */
    double period_s;
    /** Direction that the swell comes from, degrees clockwise from true north. Range [0, 360], default 0. */
    double from_deg;
    /** Directional width, degrees. Range [1, 60]; 0, the default, means 15.07. */
    double spread_deg;
} wk_sea_swell;

/** Every field of `wk_sea_swell` at its default. */
#define WK_SEA_SWELL_INIT { \
    /* struct_size */ (uint32_t)sizeof(wk_sea_swell), \
    /* struct_type */ WK_STRUCT_TYPE_SEA_SWELL, \
    /* next */ NULL, \
    /* height_m */ 0.0, \
    /* period_s */ 10.0, \
    /* from_deg */ 0.0, \
    /* spread_deg */ 0.0 \
}

/** A regular wave with infinitely long crests, added to all others. */
typedef struct wk_sea_wave {
    /** sizeof(wk_sea_wave) of your header. */
    uint32_t struct_size;
    /** WK_STRUCT_TYPE_SEA_WAVE. */
    wk_struct_type struct_type;
    /** No extensions in this version: NULL. */
    const void *next;
    /**
     * Height from trough to crest, m. Range [0, 40], default 0. The steepness of a wave is height / length / tanh(2 pi
     * depth / length). The sum of the steepnesses of all single waves is at most 0.142: steeper waves break (Miche
     * 1944).
     */
    double height_m;
    /** Wave length, m. Range [0.1, 2000]; 0, the default, if you set period_s instead. */
    double length_m;
    /** Period, s. Range [0.25, 40]; 0, the default, if you set length_m instead. Set exactly one of the two. */
    double period_s;
    /** Direction that the wave comes from, degrees clockwise from true north. Range [0, 360], default 0. */
    double from_deg;
    /**
     * Time from simulation time 0 until a crest passes the world's origin, in degrees: 360 is one period of the wave.
     * Range [-360, 360], default 0.
     */
    double phase_deg;
} wk_sea_wave;

/** Every field of `wk_sea_wave` at its default. */
#define WK_SEA_WAVE_INIT { \
    /* struct_size */ (uint32_t)sizeof(wk_sea_wave), \
    /* struct_type */ WK_STRUCT_TYPE_SEA_WAVE, \
    /* next */ NULL, \
    /* height_m */ 0.0, \
    /* length_m */ 0.0, \
    /* period_s */ 0.0, \
    /* from_deg */ 0.0, \
    /* phase_deg */ 0.0 \
}

/** The sea of a context. Optional fields have a flag in `has`. */
typedef struct wk_sea {
    /** sizeof(wk_sea) of your header. */
    uint32_t struct_size;
    /** WK_STRUCT_TYPE_SEA. */
    wk_struct_type struct_type;
    /** No extensions in this version: NULL. */
    const void *next;
    /** Flags of the optional fields that are set. Default 0. */
    wk_sea_has_flags has;
    /** Properties. Default 0. */
    wk_sea_flags flags;
    /** Mean level, m above mean sea level. Range [-500, 9000], default 0. */
    double level_m;
    /**
     * Depth of the water below the mean level, m, the same everywhere. Range [0.5, 12000], default 4000. It sets the
     * lengths and speeds of waves. Over the host's terrain tiles, queries return the depth above the terrain instead.
     */
    double depth_m;
    /**
     * Height of high water above the mean level, m; the tide has the period of the moon's half-day, 12.4206 h. Range
     * [0, 10]; 0, the default, is no tide.
     */
    double tide_amplitude_m;
    /** Simulation time of a high water, s. Range [-1e10, 1e10], default 0. */
    double tide_high_water_s;
    /** Optional: distance over which the wind raises waves, m. Range [10, 2e7]; else the open sea. */
    double fetch_m;
    /**
     * Optional: significant height of the wind sea, m. Range [0, 30], at most a fifteenth of the wave length at the
     * peak; else by sea_state, beaufort, or the weather.
     */
    double significant_height_m;
    /**
     * Optional: peak period of the wind sea, s. Range [0.5, 30]; else that of a fully developed sea of this height.
     */
    double peak_period_s;
    /**
     * Optional: peak enhancement of JONSWAP. Range [1, 10]; else 3.3 if peak_period_s is set, and 1 if it is not.
     */
    double peak_gamma;
    /**
     * Optional: Beaufort number B. Range [0, 12]. The sea is the one that a steady wind of 0.836 B^1.5 m/s sustains
     * over the fetch.
     */
    double beaufort;
    /**
     * Optional: direction that the wind sea comes from, degrees clockwise from true north. Range [0, 360]; else that
     * of the wind that raised it.
     */
    double wind_sea_from_deg;
    /** Optional: temperature of the water, degrees Celsius. Range [-3, 45]; else the weather's. */
    double temperature_c;
    /** Salinity, g/kg. Range [0, 45], default 35. */
    double salinity_g_kg;
    /**
     * Optional: share of downward blue light (450 nm) that passes a metre of water, percent. Range [41.1, 98.1]: from
     * type 7C to type I; else by water_type.
     */
    double clarity_percent;
    /**
     * Optional, with ice_floe_m and ice_width_m: share of the surface under ice floes. Range [0, 1]; else no ice.
     */
    double ice_cover;
    /** Diameter of the floes, m. Range [0.1, 10000], default 20. Waves shorter than a floe do not lift it. */
    double ice_floe_m;
    /**
     * Distance that the waves have travelled through the ice, m. Range [0, 1e7], default 1000. The waves decay along
     * this distance (Meylan, Bennetts and Kohout 2014).
     */
    double ice_width_m;
    /**
     * Optional: WMO sea state, code table 3700. Range 0 to 9. The sea is fully developed, with the middle of the
     * code's range of heights.
     */
    uint32_t sea_state;
    /** Optical type of the water. Default WK_WATER_TYPE_IB. */
    wk_water_type water_type;
    /** Optional: the swells; else the weather's swell. May be NULL if there are none. Read during the call only. */
    const wk_sea_swell *swells;
    /** Number of swells, at most 4. Default 0. */
    uint32_t swell_count;
    /** Bytes from one swell to the next: sizeof(wk_sea_swell) of your header, which is the default. */
    uint32_t swell_stride;
    /** Single waves; may be NULL if there are none. Read during the call only. */
    const wk_sea_wave *waves;
    /** Number of single waves, at most 16. Default 0. */
    uint32_t wave_count;
    /** Bytes from one wave to the next: sizeof(wk_sea_wave) of your header, which is the default. */
    uint32_t wave_stride;
} wk_sea;

/** Every field of `wk_sea` at its default. */
#define WK_SEA_INIT { \
    /* struct_size */ (uint32_t)sizeof(wk_sea), \
    /* struct_type */ WK_STRUCT_TYPE_SEA, \
    /* next */ NULL, \
    /* has */ 0, \
    /* flags */ 0, \
    /* level_m */ 0.0, \
    /* depth_m */ 4000.0, \
    /* tide_amplitude_m */ 0.0, \
    /* tide_high_water_s */ 0.0, \
    /* fetch_m */ 0.0, \
    /* significant_height_m */ 0.0, \
    /* peak_period_s */ 0.0, \
    /* peak_gamma */ 0.0, \
    /* beaufort */ 0.0, \
    /* wind_sea_from_deg */ 0.0, \
    /* temperature_c */ 0.0, \
    /* salinity_g_kg */ 35.0, \
    /* clarity_percent */ 0.0, \
    /* ice_cover */ 0.0, \
    /* ice_floe_m */ 20.0, \
    /* ice_width_m */ 1000.0, \
    /* sea_state */ 0, \
    /* water_type */ WK_WATER_TYPE_IB, \
    /* swells */ NULL, \
    /* swell_count */ 0, \
    /* swell_stride */ (uint32_t)sizeof(wk_sea_swell), \
    /* waves */ NULL, \
    /* wave_count */ 0, \
    /* wave_stride */ (uint32_t)sizeof(wk_sea_wave) \
}

/** Kind of water inside a region. */
typedef uint32_t wk_sea_region_kind;

/** No water: inside a hull or an empty dock. Such a region takes precedence over all others. */
#define WK_SEA_REGION_DRY 0
/** The sea with lower waves: a harbour. */
#define WK_SEA_REGION_SHELTERED 1
/** Water with a level of its own: a lake, a lock. */
#define WK_SEA_REGION_LAKE 2

/** A region of the ground plan with water of its own, or without water. */
typedef struct wk_sea_region {
    /** sizeof(wk_sea_region) of your header. */
    uint32_t struct_size;
    /** WK_STRUCT_TYPE_SEA_REGION. */
    wk_struct_type struct_type;
    /** No extensions in this version: NULL. */
    const void *next;
    /**
     * Corners of the outline, in clockwise or counter-clockwise order. Each corner is two numbers: its distances from
     * the centre to the right of the heading and along the heading, m, within 1e6. The outline must not cross or touch
     * itself. Read during the call only.
     */
    const double (*corners_m)[2];
    /** Number of corners, [3, 64]. Default 0; must be given. */
    uint32_t corner_count;
    /** Kind of water inside. Default WK_SEA_REGION_DRY. */
    wk_sea_region_kind kind;
    /**
     * Position of the centre in the host's world at the time at_s, m, within 1e12 m of the origin; its height has no
     * effect. Default 0, 0, 0.
     */
    double center_m[3];
    /** Heading of the outline at the time at_s, degrees clockwise from true north. Range [-360, 360], default 0. */
    double heading_deg;
    /** Velocity to the east and north, m/s; its length is at most 60. Default 0, 0. */
    double velocity_m_s[2];
    /** Rate of turn, degrees clockwise a second. Range [-90, 90], default 0. */
    double turn_deg_s;
    /** Simulation time at which the centre is at center_m, s. Range [-1e10, 1e10], default 0. */
    double at_s;
    /** Lakes: level without waves, m above mean sea level. Range [-500, 9000], default 0. */
    double level_m;
    /**
     * Lakes: depth below that level, m. Range [0.1, 12000], default 10. Waves keep the lengths that they have over the
     * sea's depth.
     */
    double depth_m;
    /**
     * Lakes and sheltered regions: ratio of the height of the waves to that on the open sea. Range [0, 1], default 1.
     */
    double wave_share;
    /**
     * Sheltered regions: width of the band inside the outline over which the waves become lower, m. Range [0, 10000];
     * 0, the default, is a step at the outline.
     */
    double rim_m;
} wk_sea_region;

/** Every field of `wk_sea_region` at its default. */
#define WK_SEA_REGION_INIT { \
    /* struct_size */ (uint32_t)sizeof(wk_sea_region), \
    /* struct_type */ WK_STRUCT_TYPE_SEA_REGION, \
    /* next */ NULL, \
    /* corners_m */ NULL, \
    /* corner_count */ 0, \
    /* kind */ WK_SEA_REGION_DRY, \
    /* center_m */ { 0.0, 0.0, 0.0 }, \
    /* heading_deg */ 0.0, \
    /* velocity_m_s */ { 0.0, 0.0 }, \
    /* turn_deg_s */ 0.0, \
    /* at_s */ 0.0, \
    /* level_m */ 0.0, \
    /* depth_m */ 10.0, \
    /* wave_share */ 1.0, \
    /* rim_m */ 0.0 \
}

/**
 * A hull that moves through the water and raises a wake. The waves of its bow and stern follow from its length, beam,
 * draught and speed (Michell 1898); the wake also contains the foam of the hull's wash. The hull goes on at its speed
 * and rate of turn until it is set anew.
 */
typedef struct wk_sea_hull {
    /** sizeof(wk_sea_hull) of your header. */
    uint32_t struct_size;
    /** WK_STRUCT_TYPE_SEA_HULL. */
    wk_struct_type struct_type;
    /** No extensions in this version: NULL. */
    const void *next;
    /** Your number for the hull; no two hulls of a list have the same. Default 0. */
    uint32_t id;
    /** Must be 0. */
    uint32_t reserved0;
    /** Length of the waterline, m. Range [1, 500], default 30. */
    double length_m;
    /** Beam of the waterline, m. Range [0.2, 100], default 8. */
    double beam_m;
    /** Draught, m. Range [0.05, 30], default 2.5. */
    double draught_m;
    /**
     * Position of the middle of the waterline in the host's world at the time at_s, m, within 1e12 m of the origin.
     * Its height does not matter. Default 0, 0, 0.
     */
    double position_m[3];
    /** Heading at at_s, degrees clockwise from true north. Range [-360, 360], default 0. The hull moves along it. */
    double heading_deg;
    /** Speed through the water, m/s. Range [0, 60], default 0. */
    double speed_m_s;
    /** Rate of turn, degrees clockwise a second. Range [-90, 90], default 0. */
    double turn_deg_s;
    /** Simulation time of position and heading, s. Range [-1e10, 1e10], default 0. */
    double at_s;
} wk_sea_hull;

/** Every field of `wk_sea_hull` at its default. */
#define WK_SEA_HULL_INIT { \
    /* struct_size */ (uint32_t)sizeof(wk_sea_hull), \
    /* struct_type */ WK_STRUCT_TYPE_SEA_HULL, \
    /* next */ NULL, \
    /* id */ 0, \
    /* reserved0 */ 0, \
    /* length_m */ 30.0, \
    /* beam_m */ 8.0, \
    /* draught_m */ 2.5, \
    /* position_m */ { 0.0, 0.0, 0.0 }, \
    /* heading_deg */ 0.0, \
    /* speed_m_s */ 0.0, \
    /* turn_deg_s */ 0.0, \
    /* at_s */ 0.0 \
}

/**
 * The sea at a place and time. Element of an array, without struct_size; calls take its sizeof instead. Where there is
 * no water, surface_m is the queried position, normal is up, and all other numbers are 0. A dry region is an
 * exception: there has_water is 0, and the other fields are those of the water around the region.
 */
typedef struct wk_sea_point {
    /** Height of the surface above mean sea level, m. */
    double height_m;
    /**
     * Bound of the error of height_m, m: 4 standard deviations of the waves left out, plus the tolerance of the
     * computation.
     */
    double height_error_m;
    /** Point of the surface above or below the position, in the host's world, m. */
    double surface_m[3];
    /** Unit normal of the surface (east, north, up). */
    double normal[3];
    /** Velocity of the water at the surface, m/s (east, north, up), without its slow drift. */
    double velocity_m_s[3];
    /** Acceleration of the water at the surface, m/s^2 (east, north, up). */
    double acceleration_m_s2[3];
    /** Depth of the water under the surface, m. */
    double depth_m;
    /**
     * Share of the place under foam, 0 to 1: foam of waves that break now, what is left of the foam of the last 3.6 s,
     * and the wash of hulls.
     */
    double foam;
    /** 1 where there is water, 0 where there is none or in a dry region. */
    uint32_t has_water;
    /** Always 0. */
    uint32_t reserved0;
} wk_sea_point;

/** Statistics of the sea at a time. */
typedef struct wk_sea_state {
    /** sizeof(wk_sea_state) of your header. */
    uint32_t struct_size;
    /** WK_STRUCT_TYPE_SEA_STATE. */
    wk_struct_type struct_type;
    /** No extensions in this version: NULL. */
    const void *next;
    /** Level without waves, m above mean sea level: wk_sea.level_m plus the tide. */
    double level_m;
    /**
     * Significant height of all waves, m: four standard deviations of the surface's height, single waves included.
     */
    double significant_height_m;
    /** Period of the strongest waves, s; that of the highest single wave if there are no others; 0 without waves. */
    double peak_period_s;
    /**
     * Mean direction that the waves come from, degrees clockwise from true north, weighted by variance; 0 without
     * waves.
     */
    double mean_from_deg;
    /**
     * Mean square slope of the surface: Cox and Munk's (1954) for the wind, or that of the waves if theirs is larger.
     */
    double mean_square_slope;
    /**
     * Part of mean_square_slope that belongs to the waves in the computed surface. The rest belongs to waves too short
     * for that surface.
     */
    double drawn_square_slope;
    /**
     * Height of the largest wave expected in an hour, m, crest to trough (Longuet-Higgins 1952), plus the heights of
     * all single waves.
     */
    double highest_in_hour_m;
    /** Share of the sea under whitecaps, 0 to 1 (Monahan and O'Muircheartaigh 1980), less under ice. */
    double whitecap_share;
    /** Temperature of the water, degrees Celsius. */
    double water_temperature_c;
    /** Refractive index of the water against air at 550 nm (Quan and Fry 1995). */
    double refractive_index;
    /** Diffuse attenuation of downward light at 450, 550 and 650 nm, 1/m (Jerlov 1976). */
    double attenuation_per_m[3];
} wk_sea_state;

/** Every field of `wk_sea_state` at its default. */
#define WK_SEA_STATE_INIT { \
    /* struct_size */ (uint32_t)sizeof(wk_sea_state), \
    /* struct_type */ WK_STRUCT_TYPE_SEA_STATE, \
    /* next */ NULL, \
    /* level_m */ 0.0, \
    /* significant_height_m */ 0.0, \
    /* peak_period_s */ 0.0, \
    /* mean_from_deg */ 0.0, \
    /* mean_square_slope */ 0.0, \
    /* drawn_square_slope */ 0.0, \
    /* highest_in_hour_m */ 0.0, \
    /* whitecap_share */ 0.0, \
    /* water_temperature_c */ 0.0, \
    /* refractive_index */ 0.0, \
    /* attenuation_per_m */ { 0.0, 0.0, 0.0 } \
}

/**
 * Sets the sea; NULL removes it. Part of the saved state. Set it before the first update: waves grow from the past
 * weather that the timeline still knows, and updates forget past weather. A new fetch applies to all of this past.
 * Unchanged after an error.
 * Thread: exclusive.
 * Errors: WK_ERROR_INVALID_ARGUMENT naming the field and its range, also for two sources of the wave height.
 */
WK_API wk_status wk_context_set_sea(wk_context *context, const wk_sea *sea);

/**
 * Replaces the list of regions, at most 64; count 0 removes all. Regions move at their velocity and rate of turn by
 * themselves: set them again when these change. Where regions overlap, the last one in the list applies, but a dry one
 * takes precedence over all others. Part of the saved state. Unchanged after an error.
 * Thread: exclusive.
 * Errors: WK_ERROR_INVALID_ARGUMENT naming the element, its field and range, or for an outline that crosses itself.
 */
WK_API
wk_status wk_context_set_sea_regions(wk_context *context,
                                     const wk_sea_region *regions,
                                     uint32_t count,
                                     uint32_t stride);

/**
 * Replaces the list of hulls that raise wakes; count 0 removes all. At most 64. A hull goes on at its speed and rate
 * of turn: set the list again when these change, in every frame if you like. A hull whose id was in the previous list
 * continues its track, unless its new position is more than two of its lengths from where that track would have led.
 * The waves of a hull that is no longer in the list stay until they have faded, after 240 s at most. Wakes are in the
 * picture and in the answers of wk_context_get_sea_at. In the answers for a place inside a dry region, the wake of the
 * hull at this place is left out, so that a hull does not float by its own waves. Keep water out of the hull by a dry
 * region (wk_context_set_sea_regions). Part of the state that wk_context_save keeps. Unchanged after an error.
 * Thread: exclusive.
 * Errors: WK_ERROR_INVALID_ARGUMENT naming the element, its field and range, or for two hulls with the same id.
 */
WK_API
wk_status wk_context_set_sea_hulls(wk_context *context,
                                   const wk_sea_hull *hulls,
                                   uint32_t count,
                                   uint32_t stride);

/**
 * Gets the sea at places of the host's world, at most wk_caps.max_batch of them, at a past or future simulation time.
 * The height of a position has no effect. There is no water where the terrain's tiles lie above the surface of the
 * sea, except in cells of WK_SURFACE_CLASS_WATER. In a dry region `has_water` is 0, and the other fields are those of
 * the water around the region, so that a hull can float by them. `shortest_wave_m`, in [0, 10000] m, is the length of
 * the shortest waves to include: leave out those too short to move your hull. 0 includes all. `position_size` and
 * `point_size` are the distances from one element to the next, bytes: 24 or more for positions, sizeof(wk_sea_point)
 * of your header for points. The first call for a time costs some milliseconds; the results for the last two times are
 * kept, and each place then costs some microseconds. No work of the GPU is needed, and nothing is allocated after the
 * first calls.
 * Thread: concurrent.
 * Errors: WK_ERROR_WRONG_ORDER without a sea; WK_ERROR_INVALID_ARGUMENT for an invalid position or a `shortest_wave_m`
 * out of range; for times as wk_context_get_conditions.
 */
WK_API
wk_status wk_context_get_sea_at(const wk_context *context,
                                const double (*positions_m)[3],
                                uint32_t count,
                                uint32_t position_size,
                                double time_s,
                                double shortest_wave_m,
                                wk_sea_point *points,
                                uint32_t point_size);

/**
 * Gets the statistics of the open sea at a simulation time, past or future.
 * Thread: concurrent.
 * Errors: WK_ERROR_WRONG_ORDER without a sea; for times as wk_context_get_conditions.
 */
WK_API wk_status wk_context_get_sea_state(const wk_context *context, double time_s, wk_sea_state *out_state);

/**
 * Writes the default of every field: the same bytes as `WK_SEA_SWELL_INIT`. `struct_size` is `sizeof(wk_sea_swell)`
 * as the caller was compiled, and is stored in the struct.
 */
WK_API wk_status wk_sea_swell_init(wk_sea_swell *out, uint32_t struct_size);

/**
 * Writes the default of every field: the same bytes as `WK_SEA_WAVE_INIT`. `struct_size` is `sizeof(wk_sea_wave)`
 * as the caller was compiled, and is stored in the struct.
 */
WK_API wk_status wk_sea_wave_init(wk_sea_wave *out, uint32_t struct_size);

/**
 * Writes the default of every field: the same bytes as `WK_SEA_INIT`. `struct_size` is `sizeof(wk_sea)`
 * as the caller was compiled, and is stored in the struct.
 */
WK_API wk_status wk_sea_init(wk_sea *out, uint32_t struct_size);

/**
 * Writes the default of every field: the same bytes as `WK_SEA_REGION_INIT`. `struct_size` is `sizeof(wk_sea_region)`
 * as the caller was compiled, and is stored in the struct.
 */
WK_API wk_status wk_sea_region_init(wk_sea_region *out, uint32_t struct_size);

/**
 * Writes the default of every field: the same bytes as `WK_SEA_HULL_INIT`. `struct_size` is `sizeof(wk_sea_hull)`
 * as the caller was compiled, and is stored in the struct.
 */
WK_API wk_status wk_sea_hull_init(wk_sea_hull *out, uint32_t struct_size);

/**
 * Writes the default of every field: the same bytes as `WK_SEA_STATE_INIT`. `struct_size` is `sizeof(wk_sea_state)`
 * as the caller was compiled, and is stored in the struct.
 */
WK_API wk_status wk_sea_state_init(wk_sea_state *out, uint32_t struct_size);

/*
 * ====================================================================================================
 * [soil] Soil
 *
 * Soil is ground that tools dig, carry, heap and press, on the host's tiles (wk_context_set_terrain). The tiles are
 * the undug ground. Soil adds the change by digging and heaping, and wk_context_get_terrain_at, water, snow and wind
 * use the sum. Mass is counted in whole micrograms and never lost. Walls up to their critical height stand, and higher
 * ones fall. Heaps rest at their angle of repose. Rain and frost change the ground. The state is advanced by
 * wk_context_update, saved and hashed with the context. It depends on the timed poses of the tools, not on the frame
 * rate: send each pose before the update that reaches its time.
 *
 * A host with physics or a network of its own gets the changes of the ground from wk_context_get_soil_changes. The
 * steps of the soil are 1/64 s long. docs/soil.md shows how to dig.
 * ====================================================================================================
 */

/** Number of the built-in kinds, and thus the number of the first kind in wk_soil.own_kinds. */
#define WK_SOIL_BUILT_IN_KINDS 7

/** Largest number of kinds, the built-in ones among them. */
#define WK_SOIL_KINDS 16

/** A kind of soil of the host's own. Element of a list in wk_soil. */
typedef struct wk_soil_kind {
    /** sizeof(wk_soil_kind) of your header. */
    uint32_t struct_size;
    /** WK_STRUCT_TYPE_SOIL_KIND. */
    wk_struct_type struct_type;
    /** No extensions in this version: NULL. */
    const void *next;
    /** Density of the undisturbed soil (bank), kg/m^3. Range [50, 10 000], default 1800. */
    double density_kg_m3;
    /** Growth of volume when the soil is dug, as a share of its bank volume. Range [0, 1.5], default 0.25. */
    double swell;
    /** Angle at which the loose soil rests, degrees. Range [5, 60], default 37. */
    double repose_deg;
    /**
     * Cohesion of moist bank, kPa. Range [0, 10 000], default 2. Soil with 100 kPa or more counts as cemented: water
     * does not weaken it.
     */
    double cohesion_kpa;
    /** Friction angle of the bank, degrees. Range [0, 60], default 30. */
    double friction_deg;
    /**
     * 1 if wheels and tracks sink into the soil, by the three numbers below (Bekker 1969); 0, the default, if it
     * carries them without sinking.
     */
    uint32_t sinks;
    /** Must be 0. */
    uint32_t reserved0;
    /** Cohesive modulus kc, kN/m^(n + 1). Range [0, 1e6], default 0. */
    double sinkage_kc;
    /** Frictional modulus kphi, kN/m^(n + 2). Range [0.1, 1e8], default 1500. */
    double sinkage_kphi;
    /** Exponent n of the sinkage in Bekker's law. Range [0.1, 3], default 1. */
    double sinkage_n;
    /** Mean colour of the drawn surface when moist, linear Rec. 709 albedo. Range [0, 1], default that of loam. */
    double albedo[3];
} wk_soil_kind;

/** Every field of `wk_soil_kind` at its default. */
#define WK_SOIL_KIND_INIT { \
    /* struct_size */ (uint32_t)sizeof(wk_soil_kind), \
    /* struct_type */ WK_STRUCT_TYPE_SOIL_KIND, \
    /* next */ NULL, \
    /* density_kg_m3 */ 1800.0, \
    /* swell */ 0.25, \
    /* repose_deg */ 37.0, \
    /* cohesion_kpa */ 2.0, \
    /* friction_deg */ 30.0, \
    /* sinks */ 0, \
    /* reserved0 */ 0, \
    /* sinkage_kc */ 0.0, \
    /* sinkage_kphi */ 1500.0, \
    /* sinkage_n */ 1.0, \
    /* albedo */ { 0.18, 0.106, 0.045 } \
}

/**
 * Number of a kind of soil: a constant below for a built-in kind, or 7 and more for the kinds in wk_soil.own_kinds, in
 * their order.
 */
typedef uint32_t wk_soil_kind_id;

/**
 * Moist sand: density of the bank (undisturbed soil) 1794 kg/m^3, swell 12 %, repose 34 degrees, cohesion 1.04 kPa,
 * friction 28 degrees.
 */
#define WK_SOIL_SAND 0
/** Dry gravel, with its values in the same order: 1750 kg/m^3, 15 %, 37 degrees, no cohesion, 37 degrees. */
#define WK_SOIL_GRAVEL 1
/** Dry clay: 1449 kg/m^3, 35 %, 32 degrees, 4.14 kPa, 13 degrees. */
#define WK_SOIL_CLAY 2
/** Moist sandy loam: 1803 kg/m^3, 25 %, 37 degrees, 1.72 kPa, 29 degrees. */
#define WK_SOIL_LOAM 3
/** Topsoil: 1561 kg/m^3, 25 %, 37 degrees, 3.3 kPa, 33.7 degrees. */
#define WK_SOIL_TOPSOIL 4
/** Limestone: 2533 kg/m^3, 63 %, 38 degrees, 1000 kPa, 40 degrees. */
#define WK_SOIL_ROCK 5
/** Hard coal: 1202 kg/m^3, 35 %, 37 degrees, 100 kPa, 35 degrees. */
#define WK_SOIL_COAL 6

/** Kinds and layers of the ground. */
typedef struct wk_soil {
    /** sizeof(wk_soil) of your header. */
    uint32_t struct_size;
    /** WK_STRUCT_TYPE_SOIL. */
    wk_struct_type struct_type;
    /** No extensions in this version: NULL. */
    const void *next;
    /** Number of kinds in `own_kinds`, at most 9. Default 0. */
    uint32_t own_kind_count;
    /** Bytes from one kind to the next: sizeof(wk_soil_kind) of your header, which is the default. */
    uint32_t own_kind_stride;
    /** Your own kinds; their numbers follow those of the built-in ones. Copied by the call. Default NULL. */
    const wk_soil_kind *own_kinds;
    /** Number of layers, at most 8. Default 0: 0.3 m of topsoil on loam. */
    uint32_t horizon_count;
    /** Must be 0. */
    uint32_t reserved0;
    /**
     * Depth of each layer's upper side below the undug surface, m: 0 for the first layer, then increasing, up to
     * 1000. Copied by the call. Default NULL.
     */
    const double *horizon_tops_m;
    /** Kind of each layer, a wk_soil_kind_id. Copied by the call. Default NULL. */
    const wk_soil_kind_id *horizon_kinds;
    /**
     * Share of the pores of the bank that water fills before rain and sun change it. Range [0, 1], default 0.3, moist.
     * Bank at 0 (dry sand) and at 1 (below the water table) has no cohesion.
     */
    double saturation;
} wk_soil;

/** Every field of `wk_soil` at its default. */
#define WK_SOIL_INIT { \
    /* struct_size */ (uint32_t)sizeof(wk_soil), \
    /* struct_type */ WK_STRUCT_TYPE_SOIL, \
    /* next */ NULL, \
    /* own_kind_count */ 0, \
    /* own_kind_stride */ (uint32_t)sizeof(wk_soil_kind), \
    /* own_kinds */ NULL, \
    /* horizon_count */ 0, \
    /* reserved0 */ 0, \
    /* horizon_tops_m */ NULL, \
    /* horizon_kinds */ NULL, \
    /* saturation */ 0.3 \
}

/** Shape of a tool, which decides how it moves the soil. */
typedef uint32_t wk_soil_tool_shape;

/** Bucket or shovel: cuts with its edge, fills, carries and pours. */
#define WK_SOIL_TOOL_BUCKET 0
/** Blade of a dozer or grader: cuts with its edge, and pushes the soil ahead. */
#define WK_SOIL_TOOL_BLADE 1
/** Bed of a truck: catches what falls into it, carries and pours, but does not cut. */
#define WK_SOIL_TOOL_BED 2
/** Wheel: its edge is the line of contact with the ground, across the wheel's width. */
#define WK_SOIL_TOOL_WHEEL 3
/** Crawler track: its edge is the line under the track's middle, across its width. */
#define WK_SOIL_TOOL_TRACK 4

/** A tool that works the soil. */
typedef struct wk_soil_tool {
    /** sizeof(wk_soil_tool) of your header. */
    uint32_t struct_size;
    /** WK_STRUCT_TYPE_SOIL_TOOL. */
    wk_struct_type struct_type;
    /** No extensions in this version: NULL. */
    const void *next;
    /** Shape of the tool. Default WK_SOIL_TOOL_BUCKET. */
    wk_soil_tool_shape shape;
    /** Must be 0. */
    uint32_t reserved0;
    /** Volume of a bucket or bed when struck level, m^3. Range [0.001, 1000], default 1. Not used by other tools. */
    double struck_m3;
    /**
     * Slope of the rated heap of a bucket or bed, rise per unit of length: 1, the default, for excavators by SAE J296;
     * 0.5 by CECE and for loaders (SAE J742). Range [0, 1]. Not used by other tools.
     */
    double heap_rise;
    /** Diameter of a wheel, m. Range [0.1, 10], default 1. Not used by other tools. */
    double diameter_m;
    /** Length of a track's contact with the ground, m. Range [0.1, 20], default 3. Not used by other tools. */
    double contact_m;
} wk_soil_tool;

/** Every field of `wk_soil_tool` at its default. */
#define WK_SOIL_TOOL_INIT { \
    /* struct_size */ (uint32_t)sizeof(wk_soil_tool), \
    /* struct_type */ WK_STRUCT_TYPE_SOIL_TOOL, \
    /* next */ NULL, \
    /* shape */ WK_SOIL_TOOL_BUCKET, \
    /* reserved0 */ 0, \
    /* struck_m3 */ 1.0, \
    /* heap_rise */ 1.0, \
    /* diameter_m */ 1.0, \
    /* contact_m */ 3.0 \
}

/**
 * Pose of a tool at a time. Left and right are as seen by a viewer inside the tool who looks out of its opening. All
 * points lie within 1e7 m of wk_terrain.origin_m.
 */
typedef struct wk_soil_pose {
    /** sizeof(wk_soil_pose) of your header. */
    uint32_t struct_size;
    /** WK_STRUCT_TYPE_SOIL_POSE. */
    wk_struct_type struct_type;
    /** No extensions in this version: NULL. */
    const void *next;
    /** Simulation time, s. Range [-1e10, 1e10], default 0. */
    double time_s;
    /**
     * Left end of the cutting edge, or of the line of contact of a wheel or track, in the host's world, m. Default 0,
     * 0, 0.
     */
    double edge_left_m[3];
    /** Right end of the cutting edge or line of contact, 0.05 to 20 m from its left end. Default 0, 0, 0. */
    double edge_right_m[3];
    /**
     * Left end of the upper edge of the opening, opposite to the cutting edge and 0.02 to 20 m from it. Not used for
     * wheels and tracks. Default 0, 0, 0.
     */
    double upper_left_m[3];
    /** Right end of the opening's upper edge, 0.05 to 20 m from its left end. Default 0, 0, 0. */
    double upper_right_m[3];
    /**
     * Direction out of the opening in the host's world; any length in [1e-6, 1e6]. Not used for wheels and tracks.
     * Default 0, 0, 0; must be given for other tools.
     */
    double facing[3];
    /** Load of a wheel or track on the ground, N. Range [0, 1e7], default 0. Not used by other tools. */
    double load_n;
} wk_soil_pose;

/** Every field of `wk_soil_pose` at its default. */
#define WK_SOIL_POSE_INIT { \
    /* struct_size */ (uint32_t)sizeof(wk_soil_pose), \
    /* struct_type */ WK_STRUCT_TYPE_SOIL_POSE, \
    /* next */ NULL, \
    /* time_s */ 0.0, \
    /* edge_left_m */ { 0.0, 0.0, 0.0 }, \
    /* edge_right_m */ { 0.0, 0.0, 0.0 }, \
    /* upper_left_m */ { 0.0, 0.0, 0.0 }, \
    /* upper_right_m */ { 0.0, 0.0, 0.0 }, \
    /* facing */ { 0.0, 0.0, 0.0 }, \
    /* load_n */ 0.0 \
}

/** Content of a tool, and the soil that it met in the last step of the soil (1/64 s). */
typedef struct wk_soil_tool_report {
    /** sizeof(wk_soil_tool_report) of your header. */
    uint32_t struct_size;
    /** WK_STRUCT_TYPE_SOIL_TOOL_REPORT. */
    wk_struct_type struct_type;
    /** No extensions in this version: NULL. */
    const void *next;
    /** Simulation time of the tool's pose, s. */
    double time_s;
    /** Mass of the soil in the tool, kg. */
    double mass_kg;
    /** Bulk volume of the soil in the tool, m^3. */
    double bulk_m3;
    /** Ratio of bulk_m3 to the rated volume of the tool with its heap. */
    double fill;
    /** Centre of the soil in the tool, in the host's world, m. */
    double centre_m[3];
    /** Mass of each kind of soil in the tool, kg, by the kind's number. */
    double kinds_kg[16];
    /** Share of the pores of the soil in the tool that water fills, 0 to 1; 0 if the tool is empty. */
    double saturation;
    /** Mean depth of the cut, m. */
    double cut_depth_m;
    /** Deepest sinkage of a wheel or track, m. */
    double sinkage_m;
    /** Kind that makes up most of the soil that was cut. */
    wk_soil_kind_id cut_kind;
    /**
     * 1 if the sinkage was limited to half a wheel's radius or half the shorter side of a track's contact, or if it
     * comes from sinkage numbers that hold for a small range only; else 0.
     */
    uint32_t sinkage_is_beyond_range;
    /** 1 if the edge met ground frozen deeper than 5 cm, which it cannot cut; else 0. */
    uint32_t is_stopped_by_frost;
    /** Always 0. */
    uint32_t reserved0;
} wk_soil_tool_report;

/** Every field of `wk_soil_tool_report` at its default. */
#define WK_SOIL_TOOL_REPORT_INIT { \
    /* struct_size */ (uint32_t)sizeof(wk_soil_tool_report), \
    /* struct_type */ WK_STRUCT_TYPE_SOIL_TOOL_REPORT, \
    /* next */ NULL, \
    /* time_s */ 0.0, \
    /* mass_kg */ 0.0, \
    /* bulk_m3 */ 0.0, \
    /* fill */ 0.0, \
    /* centre_m */ { 0.0, 0.0, 0.0 }, \
    /* kinds_kg */ { 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0 }, \
    /* saturation */ 0.0, \
    /* cut_depth_m */ 0.0, \
    /* sinkage_m */ 0.0, \
    /* cut_kind */ 0, \
    /* sinkage_is_beyond_range */ 0, \
    /* is_stopped_by_frost */ 0, \
    /* reserved0 */ 0 \
}

/** Blade of a tool, for the force of the soil on it. */
typedef struct wk_soil_blade {
    /** sizeof(wk_soil_blade) of your header. */
    uint32_t struct_size;
    /** WK_STRUCT_TYPE_SOIL_BLADE. */
    wk_struct_type struct_type;
    /** No extensions in this version: NULL. */
    const void *next;
    /**
     * Angle of the blade to the horizontal in the direction of motion, degrees; 90 is upright. Range [3, 148], default
     * 60.
     */
    double rake_deg;
    /** Friction angle between soil and blade, degrees. Range [0, 68], default 23, steel. */
    double soil_metal_deg;
    /** Adhesion of the soil to the blade, kPa. Range [0, 10 000], default 0. */
    double adhesion_kpa;
    /** Load on the surface in front of the blade, kPa. Range [0, 10 000], default 0. */
    double surcharge_kpa;
} wk_soil_blade;

/** Every field of `wk_soil_blade` at its default. */
#define WK_SOIL_BLADE_INIT { \
    /* struct_size */ (uint32_t)sizeof(wk_soil_blade), \
    /* struct_type */ WK_STRUCT_TYPE_SOIL_BLADE, \
    /* next */ NULL, \
    /* rake_deg */ 60.0, \
    /* soil_metal_deg */ 23.0, \
    /* adhesion_kpa */ 0.0, \
    /* surcharge_kpa */ 0.0 \
}

/** Force of the soil on a blade. */
typedef struct wk_cutting_force {
    /** sizeof(wk_cutting_force) of your header. */
    uint32_t struct_size;
    /** WK_STRUCT_TYPE_CUTTING_FORCE. */
    wk_struct_type struct_type;
    /** No extensions in this version: NULL. */
    const void *next;
    /**
     * Force at the angle soil_metal_deg from the normal of the blade, N: P of the equation at
     * wk_context_get_soil_resistance.
     */
    double force_n;
    /** Component of the total force against the motion, N. */
    double horizontal_n;
    /** Component of the total force that pulls the blade down, N; negative where the soil lifts the blade. */
    double vertical_n;
    /** Angle of the plane of failure to the horizontal, degrees. */
    double failure_deg;
} wk_cutting_force;

/** Every field of `wk_cutting_force` at its default. */
#define WK_CUTTING_FORCE_INIT { \
    /* struct_size */ (uint32_t)sizeof(wk_cutting_force), \
    /* struct_type */ WK_STRUCT_TYPE_CUTTING_FORCE, \
    /* next */ NULL, \
    /* force_n */ 0.0, \
    /* horizontal_n */ 0.0, \
    /* vertical_n */ 0.0, \
    /* failure_deg */ 0.0 \
}

/** Ground of a cell. Element of an array, without struct_size; calls take its sizeof instead. */
typedef struct wk_soil_point {
    /** Height of the surface above the terrain's origin, m: the host's height plus change_m. */
    double surface_m;
    /** Change of the height by soil, m: the surface minus the undug height; negative in a pit. */
    double change_m;
    /** Depth of loose soil, m. */
    double loose_m;
    /** Density of the loose soil, kg/m^3; 0 without any. */
    double loose_kg_m3;
    /**
     * Revision of the terrain at the last change by soil in the cell's rectangle of wk_context_get_soil_changes; 0
     * where nothing was dug.
     */
    uint64_t revision;
    /** Kind of soil on the surface: that of most of the loose soil, or of the bank where no loose soil lies. */
    wk_soil_kind_id kind;
    /** 1 if the cell has ground; all other fields are 0 otherwise. */
    uint32_t has_ground;
    /** Colour of the dug, loose or pressed soil that shows, linear Rec. 709 albedo. */
    float albedo[3];
    /** Share of the cell in which that soil shows, 0 to 1; the undug surface shows in the rest. */
    float covered;
} wk_soil_point;

/**
 * Rectangle of a tile in which soil has changed heights. Element of an array, without struct_size; calls take its
 * sizeof instead.
 */
typedef struct wk_soil_change {
    /** Revision of the terrain at the last change. */
    uint64_t revision;
    /** Key of the tile. */
    int32_t tile[2];
    /** South-western cell of the rectangle in the tile, cells east and north. */
    uint32_t first_cell[2];
    /** Size of the rectangle, cells east and north. */
    uint32_t cells[2];
} wk_soil_change;

/**
 * Balance of the soil's mass, in whole micrograms. After every call, dug + brought equals lying + held + taken
 * exactly.
 */
typedef struct wk_soil_balance {
    /** sizeof(wk_soil_balance) of your header. */
    uint32_t struct_size;
    /** WK_STRUCT_TYPE_SOIL_BALANCE. */
    wk_struct_type struct_type;
    /** No extensions in this version: NULL. */
    const void *next;
    /**
     * Bank that was loosened, micrograms. Each number of this struct is limited to the range of its type, 9.2 million
     * tonnes.
     */
    int64_t dug_ug;
    /** Soil that the host brought, micrograms. */
    int64_t brought_ug;
    /** Loose soil on the ground, micrograms. */
    int64_t lying_ug;
    /** Soil in buckets and beds, micrograms. */
    int64_t held_ug;
    /** Soil that left with tools that ended, micrograms. */
    int64_t taken_ug;
} wk_soil_balance;

/** Every field of `wk_soil_balance` at its default. */
#define WK_SOIL_BALANCE_INIT { \
    /* struct_size */ (uint32_t)sizeof(wk_soil_balance), \
    /* struct_type */ WK_STRUCT_TYPE_SOIL_BALANCE, \
    /* next */ NULL, \
    /* dug_ug */ 0, \
    /* brought_ug */ 0, \
    /* lying_ug */ 0, \
    /* held_ug */ 0, \
    /* taken_ug */ 0 \
}

/**
 * Sets the soil of the terrain's tiles. The ground is undug at first; NULL removes the soil with all changes by
 * digging. Setting equal settings again changes nothing. Setting another lattice (wk_context_set_terrain) removes the
 * soil. Part of the saved state. Unchanged after an error.
 * Thread: exclusive.
 * Errors: WK_ERROR_WRONG_ORDER before wk_context_set_terrain, and while steps of an update remain;
 * WK_ERROR_INVALID_ARGUMENT naming the field, also for a terrain with cells of more than 4 m.
 */
WK_API wk_status wk_context_set_soil(wk_context *context, const wk_soil *soil);

/**
 * Adds a tool at its first pose; there may be 64 tools at a time. `out_tool` gets its number, which no other tool of
 * the same soil gets. Unchanged after an error.
 * Thread: exclusive.
 * Errors: WK_ERROR_INVALID_ARGUMENT naming the field; WK_ERROR_WRONG_ORDER without soil, while steps of an update
 * remain, and for a pose before the last update.
 */
WK_API
wk_status wk_context_add_soil_tool(wk_context *context,
                                   const wk_soil_tool *shape,
                                   const wk_soil_pose *pose,
                                   uint32_t *out_tool);

/**
 * Adds the next pose of a tool: later than the last pose and the last update, at most 600 s after the last pose, and
 * with each point at most 20 m from its place in the last pose. The tool moves at constant speed between its poses,
 * and stands still after the last one. Its edge must stay over tiles. Unchanged after an error.
 * Thread: exclusive.
 * Errors: WK_ERROR_INVALID_ARGUMENT naming the field or an unknown tool; WK_ERROR_WRONG_ORDER for a pose that is not
 * later than the last pose and the last update, for a tool that has ended, without soil, and while steps of an update
 * remain.
 */
WK_API wk_status wk_context_move_soil_tool(wk_context *context, uint32_t tool, const wk_soil_pose *pose);

/**
 * Ends a tool at its last pose. The soil that the tool still holds then leaves with it, and is added to
 * wk_soil_balance.taken_ug.
 * Thread: exclusive.
 * Errors: WK_ERROR_INVALID_ARGUMENT for an unknown tool; WK_ERROR_WRONG_ORDER for one that has ended, without soil,
 * and while steps of an update remain.
 */
WK_API wk_status wk_context_end_soil_tool(wk_context *context, uint32_t tool);

/**
 * Gets the content of a tool, and the soil that it met in the last step, as of wk_context_get_state_time.
 * Thread: concurrent.
 * Errors: WK_ERROR_INVALID_ARGUMENT for an unknown tool; WK_ERROR_WRONG_ORDER without soil.
 */
WK_API
wk_status wk_context_get_soil_tool(const wk_context *context,
                                   uint32_t tool,
                                   wk_soil_tool_report *out_report);

/**
 * Gets the force of the soil on the edge of a tool, for the depth of the cut and the soil of the last step: P = w
 * (gamma d^2 Ng + c d Nc + q d Nq + ca d Na) (Reece 1965; McKyes 1985), with width w, unit weight of the soil gamma,
 * depth d, cohesion c, surcharge q, adhesion ca and the factors Ng, Nc, Nq and Na. The answer is in closed form, for
 * the physics of your machine. It is 0 where the tool does not cut.
 * Thread: concurrent.
 * Errors: WK_ERROR_INVALID_ARGUMENT naming the field or an unknown tool; WK_ERROR_WRONG_ORDER without soil.
 */
WK_API
wk_status wk_context_get_soil_resistance(const wk_context *context,
                                         uint32_t tool,
                                         const wk_soil_blade *blade,
                                         wk_cutting_force *out_force);

/**
 * Drops loose soil of a kind, which the host brings, onto a place of the host's world, at once. `mass_kg` is the mass
 * of the soil, in [0, 1e6] kg. The height of the position does not matter. `out_lands`, which may be NULL, gets 1 if
 * there is ground to land on, else 0.
 * Thread: exclusive.
 * Errors: WK_ERROR_INVALID_ARGUMENT naming the parameter, also where loose soil would lie more than 1000 m deep;
 * WK_ERROR_WRONG_ORDER without soil, and while steps of an update remain.
 */
WK_API
wk_status wk_context_bring_soil(wk_context *context,
                                const double (*position_m)[3],
                                wk_soil_kind_id kind,
                                double mass_kg,
                                uint32_t *out_lands);

/**
 * Gets the ground of the cells nearest to places of the host's world, at most wk_caps.max_batch of them.
 * `position_size` and `point_size` are the distances from one element to the next, bytes: 24 or more for positions,
 * sizeof(wk_soil_point) of your header for points.
 * Thread: concurrent.
 * Errors: WK_ERROR_INVALID_ARGUMENT for an invalid position; WK_ERROR_WRONG_ORDER without soil.
 */
WK_API
wk_status wk_context_get_soil_points(const wk_context *context,
                                     const double (*positions_m)[3],
                                     uint32_t count,
                                     uint32_t position_size,
                                     wk_soil_point *points,
                                     uint32_t point_size);

/**
 * Gets the rectangles in which soil has changed heights since a revision of the terrain
 * (wk_context_get_terrain_revision), ordered by rows from the south. A revision of 0 gets all. `*out_count` always
 * gets the number of rectangles. If `capacity` is too small, nothing else is written and the call fails; with capacity
 * 0 it succeeds. `change_size` is sizeof(wk_soil_change) of your header. wk_context_get_soil_cells returns the heights
 * and kinds of a rectangle's cells. Do not pass these heights to wk_context_update_terrain: the tiles are the undug
 * ground.
 * Thread: concurrent.
 * Errors: WK_ERROR_INVALID_ARGUMENT naming the parameter.
 */
WK_API
wk_status wk_context_get_soil_changes(const wk_context *context,
                                      uint64_t since_revision,
                                      wk_soil_change *changes,
                                      uint32_t capacity,
                                      uint32_t change_size,
                                      uint32_t *out_count);

/**
 * Gets the ground of a rectangle of a tile's cells, by rows from the south-west: `cells[0]` cells east and `cells[1]`
 * north from `first_cell` on, at most 2^20 in all. `points` must have room for all of them. `point_size` is
 * sizeof(wk_soil_point) of your header.
 * Thread: concurrent.
 * Errors: WK_ERROR_INVALID_ARGUMENT for a key that no tile has, a rectangle that is empty, too large or leaves the
 * tile, or a capacity that is too small; WK_ERROR_WRONG_ORDER without soil.
 */
WK_API
wk_status wk_context_get_soil_cells(const wk_context *context,
                                    const int32_t (*tile)[2],
                                    const uint32_t (*first_cell)[2],
                                    const uint32_t (*cells)[2],
                                    wk_soil_point *points,
                                    uint32_t capacity,
                                    uint32_t point_size);

/**
 * Gets the balance of the soil's mass.
 * Thread: concurrent.
 * Errors: WK_ERROR_WRONG_ORDER without soil.
 */
WK_API wk_status wk_context_get_soil_balance(const wk_context *context, wk_soil_balance *out_balance);

/**
 * Writes the default of every field: the same bytes as `WK_SOIL_KIND_INIT`. `struct_size` is `sizeof(wk_soil_kind)`
 * as the caller was compiled, and is stored in the struct.
 */
WK_API wk_status wk_soil_kind_init(wk_soil_kind *out, uint32_t struct_size);

/**
 * Writes the default of every field: the same bytes as `WK_SOIL_INIT`. `struct_size` is `sizeof(wk_soil)`
 * as the caller was compiled, and is stored in the struct.
 */
WK_API wk_status wk_soil_init(wk_soil *out, uint32_t struct_size);

/**
 * Writes the default of every field: the same bytes as `WK_SOIL_TOOL_INIT`. `struct_size` is `sizeof(wk_soil_tool)`
 * as the caller was compiled, and is stored in the struct.
 */
WK_API wk_status wk_soil_tool_init(wk_soil_tool *out, uint32_t struct_size);

/**
 * Writes the default of every field: the same bytes as `WK_SOIL_POSE_INIT`. `struct_size` is `sizeof(wk_soil_pose)`
 * as the caller was compiled, and is stored in the struct.
 */
WK_API wk_status wk_soil_pose_init(wk_soil_pose *out, uint32_t struct_size);

/**
 * Writes the default of every field: the same bytes as `WK_SOIL_TOOL_REPORT_INIT`. `struct_size` is `sizeof(wk_soil_tool_report)`
 * as the caller was compiled, and is stored in the struct.
 */
WK_API
wk_status wk_soil_tool_report_init(wk_soil_tool_report *out,
                                   uint32_t struct_size);

/**
 * Writes the default of every field: the same bytes as `WK_SOIL_BLADE_INIT`. `struct_size` is `sizeof(wk_soil_blade)`
 * as the caller was compiled, and is stored in the struct.
 */
WK_API wk_status wk_soil_blade_init(wk_soil_blade *out, uint32_t struct_size);

/**
 * Writes the default of every field: the same bytes as `WK_CUTTING_FORCE_INIT`. `struct_size` is `sizeof(wk_cutting_force)`
 * as the caller was compiled, and is stored in the struct.
 */
WK_API
wk_status wk_cutting_force_init(wk_cutting_force *out,
                                uint32_t struct_size);

/**
 * Writes the default of every field: the same bytes as `WK_SOIL_BALANCE_INIT`. `struct_size` is `sizeof(wk_soil_balance)`
 * as the caller was compiled, and is stored in the struct.
 */
WK_API
wk_status wk_soil_balance_init(wk_soil_balance *out,
                               uint32_t struct_size);

#ifdef __cplusplus
} /* extern "C" */
#endif

#endif /* WELKIN_H */
