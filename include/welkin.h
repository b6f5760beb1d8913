/*
 * Welkin: weather for simulators, drawn into the host's own picture.
 *
 * This header is the whole C API, in reading order; CONTENTS below names its sections. It is C99 and C++11 and later;
 * welkin.hpp wraps it for C++.
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
 *         wk_view_record(view, &frame, WK_STAGE_ALL);        sky behind it, fog and air before it
 *
 * OWNERSHIP
 *
 * wk_x_create writes a new handle to its out-parameter, on success only. wk_x_destroy(handle) ends it; NULL does
 * nothing. Destroy children before parents: a device has contexts, surfaces and textures, a context has views. A
 * parent with live children answers WK_ERROR_IN_USE. A handle looks like a pointer but is a number, and Welkin never
 * dereferences it: a handle that is dead, foreign or of another kind gives WK_ERROR_BAD_HANDLE. Structs, texts and
 * lists that you pass in stay yours; Welkin reads them during the call only. Texts that come back live as long as
 * their function says. Native objects (windows, OpenGL names, Vulkan handles) stay the host's.
 *
 * ERRORS
 *
 * Every call answers a wk_status: 0 or more is an answer, less than 0 a failure. A failed call writes no output,
 * changes nothing and draws nothing. wk_last_error_message() has the calling thread's message, which names the
 * parameter and what is accepted, as in `wk_view_record: frame.projection[5] must be finite, got NaN`;
 * wk_last_error_field() has `frame.projection[5]` alone. Welkin never aborts, prints or throws. It catches a fault of
 * its own and answers WK_ERROR_INTERNAL. The device then answers WK_ERROR_POISONED, and only destroying works.
 *
 * STRUCTS
 *
 * Structs begin with struct_size, struct_type and next. Start from WK_X_INIT (or wk_x_init, which writes the same
 * bytes) and change fields. Later versions append fields whose zero means "as before". So a library takes structs of
 * older headers and fills in defaults, and structs of newer headers if the fields that it does not know are zero.
 * `next` leads to extension structs where a call names them; an unknown one is refused. Reserved fields must be 0.
 * Zero is a value (0 degrees, north, calm), never "default". What you may leave out has a bit in `has`. Lists are
 * (pointer, count, stride): stride is the size of an element in your header. Reals are doubles and must be finite.
 * Texts are NUL-terminated UTF-8. Sizes are in bytes.
 *
 * THREADS
 *
 * You may call functions from any thread. `const T *` is shared: any number of calls with it at the same time. `T *`
 * is exclusive: one call at a time with that handle, and none with its `const` at the same time. Calls that break this
 * rule wait for each other. Welkin starts no threads. With an OpenGL host make all calls that draw, create or destroy
 * on the thread where its context is (or can be made) current; what you destroy on another thread is released at the
 * device's next call. Call no Welkin function inside a callback: it would answer WK_ERROR_WRONG_ORDER.
 *
 * UNITS AND COORDINATES
 *
 * Units are SI. A field's name ends in its unit, except for metres, seconds and radians. Angles that people use by
 * name are in degrees (_deg). Azimuths are clockwise from true north; wind direction is where the wind comes from.
 * Positions are in the host's world, in double precision, however far from its origin. See Contexts for world frames
 * and Frames for matrices, depth and clip space. Colours are linear Rec. 709 unless they say otherwise.
 *
 * DETERMINISM
 *
 * The same description, timeline, seed and time give the same world on every machine. Channels of one simulator with
 * the same input agree, and wk_context_state_hash lets them compare. Changes of weather carry absolute times. Pictures
 * are bit-identical from run to run on one driver; drivers differ in the last bits.
 *
 * WHAT COMES LATER, AND HOW
 *
 * Before 1.0 a minor version may change this header; from 1.0 on, numbers, names and layouts never change within a
 * major version, and later versions add new ones. Settled for what is planned, so that a host can prepare:
 * - The sea is drawn by new functions of the context. It tests and writes the host's depth, which a frame lends with
 *   wk_frame.depth_access.
 * - Soil materials of the terrain's tiles are new functions of the context.
 * - Snow in rain areas is wk_rain_area.snow.
 * - Base colour and motion are images appended to the target structs.
 * - Allocator and file callbacks come as extensions of wk_device_desc through `next`.
 *
 * A field, a bit or a value that this version does not draw yet is refused by name where it is set.
 *
 * CONTENTS
 *
 * Each section begins with its name in brackets, which stays from version to version: search for it.
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
 *
 * Wind, shelter and lamps
 *   [wind_grid]       Wind that varies in space
 *   [wind_field]      Wind round terrain and buildings
 *   [occluder]        Maps of what keeps rain off
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
 * Every call answers a wk_status. 0 and positive values are answers, negative ones failures. A failed call writes no
 * output. wk_last_error_message() then says which parameter was wrong and what is accepted, and wk_last_error_field()
 * gives that parameter or field alone.
 * ====================================================================================================
 */

/** The result of a call. The numbers never change and are never reused. */
typedef int32_t wk_status;

/** The call succeeded. */
#define WK_OK 0
/** More steps are due than one update may take; call again. Not a failure. */
#define WK_PENDING 1
/** A parameter is missing, not finite or outside its range; the message names it. */
#define WK_ERROR_INVALID_ARGUMENT (-1)
/** A handle is NULL, destroyed, foreign or of another kind. */
#define WK_ERROR_BAD_HANDLE (-2)
/** The parent still has live children, or another call is using the handle at this moment. */
#define WK_ERROR_IN_USE (-3)
/** This device, tier or build does not support the request; the message names the feature. */
#define WK_ERROR_UNSUPPORTED (-4)
/** No adapter or driver serves the request. */
#define WK_ERROR_NO_ADAPTER (-5)
/** The GPU device is lost: destroy it with its children, and create a new one. */
#define WK_ERROR_DEVICE_LOST (-6)
/** Memory ran out, on the host or on the GPU. */
#define WK_ERROR_OUT_OF_MEMORY (-7)
/** An earlier call on this device ended in a fault inside Welkin. Only destroy works on it and its children. */
#define WK_ERROR_POISONED (-8)
/** The native queue or OpenGL context already belongs to another wk_device. */
#define WK_ERROR_ALREADY_WRAPPED (-9)
/** A text (METAR report, planet file, saved state) does not parse; the message gives line and column. */
#define WK_ERROR_PARSE (-10)
/** A file could not be read or written. */
#define WK_ERROR_IO (-11)
/** The surface must be configured again: it was resized, minimised or lost. */
#define WK_ERROR_SURFACE_OUTDATED (-12)
/** Calls in a wrong order: stages of a frame, or dates before the last update. */
#define WK_ERROR_WRONG_ORDER (-13)
/** The host aborted a long operation through its callback. */
#define WK_ERROR_ABORTED (-14)
/** A fault inside Welkin; the message says where. */
#define WK_ERROR_INTERNAL (-15)

/** Severity of a message. */
typedef uint32_t wk_log_level;

/** Something failed; the call's status says so too. */
#define WK_LOG_LEVEL_ERROR 1
/** Something works less well than it could: a fallback, a slow path. */
#define WK_LOG_LEVEL_WARNING 2
/** Occasional information: which adapter, which plan. */
#define WK_LOG_LEVEL_INFO 3
/** For developers of Welkin. */
#define WK_LOG_LEVEL_DEBUG 4

/**
 * Receives a message: NUL-terminated UTF-8, valid during the call. Welkin calls it from any thread that is in a Welkin
 * call. It must not call Welkin and must not unwind.
 */
typedef void (*wk_log_fn)(void *user, wk_log_level level, const char *message);

/** The type of a tagged struct: its second field. WK_X_INIT sets it. */
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

/**
 * The name of a status, such as "WK_ERROR_BAD_HANDLE"; "unknown status" for other numbers. Never NULL, never freed.
 */
WK_API const char *wk_status_name(wk_status status);

/**
 * The message of the calling thread's last failed call: one sentence that begins with the function's name and names
 * the parameter and the accepted range. Empty before the first failure; successful calls leave it alone. Never NULL;
 * valid until the next failing call of this thread.
 */
WK_API const char *wk_last_error_message(void);

/**
 * The parameter or field that the calling thread's last failed call was about, as a path of names in this header that
 * begins at the function's parameter or at a struct's name: `frame.projection`, `shelters[2].half_size_m`,
 * `wk_sky_settings.suns`, `time_s`. A host's editor can mark a control by it. The last failure with
 * WK_ERROR_INVALID_ARGUMENT always has one; empty where a failure is about no field, and before the first failure.
 * Never NULL; valid until the next failing call of this thread.
 */
WK_API const char *wk_last_error_field(void);

/**
 * The library's version. WK_VERSION_MAJOR, _MINOR and _PATCH are the header's. A library fits a header if the major
 * version is equal and its minor version is at least the header's. Each of the three may be NULL.
 */
WK_API wk_status wk_version(uint32_t *major, uint32_t *minor, uint32_t *patch);

/**
 * Sends Welkin's messages, and its graphics layer's warnings and errors, to `callback` from now on; NULL stops them.
 * They are off by default, and Welkin never prints. There is one callback in a process. `max_level` is the least
 * severe level that is sent. If `callback` fails, it must return normally; Welkin ignores the failure.
 * Errors: WK_ERROR_INVALID_ARGUMENT for an unknown level; WK_ERROR_IN_USE in a Rust program that has its own logger.
 */
WK_API wk_status wk_set_log_callback(wk_log_fn callback, void *user, wk_log_level max_level);

/*
 * ====================================================================================================
 * [device] Devices
 *
 * A wk_device is one native queue or OpenGL context, with everything that its contexts share: pipelines, tables,
 * caches. Make one here (below), from the host's OpenGL context, from the host's Vulkan device, or, in Rust, from the
 * host's wgpu device. All later calls are the same for all four.
 *
 * Make one device per native queue or context: a second one answers WK_ERROR_ALREADY_WRAPPED. When the GPU is lost
 * (driver reset, unplugged) every call that needs it answers WK_ERROR_DEVICE_LOST: those that create, build, draw,
 * read or write what lies on it, and wk_context_get_ambient. A context's weather, time, settings, other queries and
 * state need no GPU and go on: save the state with wk_context_save, destroy the views, contexts and the device, create
 * them again, and load the state.
 * ====================================================================================================
 */

/** A native queue or OpenGL context. Parent of contexts, surfaces and textures. */
typedef struct wk_device wk_device;

/** Native graphics interfaces. */
typedef uint32_t wk_backend_flags;

/** Draws nothing and needs no GPU: for tests of your own code. */
#define WK_BACKEND_NOOP 1
/** Vulkan. */
#define WK_BACKEND_VULKAN 2
/** Metal. */
#define WK_BACKEND_METAL 4
/** Direct3D 12. */
#define WK_BACKEND_DX12 8
/** OpenGL or OpenGL ES. */
#define WK_BACKEND_GL 16
/** Any that works, the best first. */
#define WK_BACKEND_ANY 30

/** Flags of an own device. */
typedef uint32_t wk_device_flags;

/** Use no compute shaders, even where the device has them: draws as on an OpenGL 3.3 machine. */
#define WK_DEVICE_FORCE_TIER0 1
/** Use the software driver. */
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
    /** Default 0. */
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
    /** The native interface that it uses. */
    wk_backend_flags backend;
    /**
     * 0: no compute (OpenGL 3.3 to 4.2, OpenGL on macOS). 1: compute. Features that need tier 1 answer
     * WK_ERROR_UNSUPPORTED by name on tier 0.
     */
    uint32_t tier;
    /** 1 for a software driver, which draws on the CPU, else 0. */
    uint32_t software;
    /** Largest edge of a 2-D texture, pixels. */
    uint32_t max_texture_size;
    /** Most cloud layers in a wk_weather. */
    uint32_t max_cloud_layers;
    /** Most places or rays in one batch query. */
    uint32_t max_batch;
    /** The adapter's own name, UTF-8; lives as long as the device. */
    const char *adapter_name;
    /** The driver's own name and version, UTF-8; lives as long as the device. */
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
 * Makes an own device, without a window. `desc` NULL means WK_DEVICE_DESC_INIT. On success `*out` is a new handle,
 * which you destroy with `wk_device_destroy`; else it stays untouched. Thread: any. Errors: WK_ERROR_NO_ADAPTER if no
 * driver fits the request, or an OpenGL driver draws a few known texels wrong or does not finish them within 6 s;
 * WK_ERROR_INVALID_ARGUMENT by name.
 */
WK_API wk_status wk_device_create(const wk_device_desc *desc, wk_device **out_device);

/**
 * Destroys a device. NULL does nothing.
 * Thread: for a device on an OpenGL context, one where that context is (or can be made) current; elsewhere, or when
 * the context is already gone, its objects are abandoned. For other devices any.
 * Errors: WK_ERROR_IN_USE while it has contexts, surfaces or textures.
 */
WK_API wk_status wk_device_destroy(wk_device *device);

/**
 * WK_OK while the device works, WK_ERROR_DEVICE_LOST or WK_ERROR_POISONED when it no longer does.
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
 * For hosts without graphics of their own: programs that want pictures in memory, or that draw with Welkin only. Hosts
 * with OpenGL, Vulkan or wgpu hand over their own images instead and need none of this.
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
/** Floats, 16 bytes: scene-linear colour. Not on every driver as a target. */
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
    /** Pixels. Range [1, wk_caps.max_texture_size], default 1. */
    uint32_t width;
    /** Pixels. Range [1, wk_caps.max_texture_size], default 1. */
    uint32_t height;
    /** Default WK_FORMAT_RGBA8_UNORM. */
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
 * Makes a texture, filled with zeros. On success `*out_texture` is a new handle for `wk_texture_destroy`.
 * Thread: any.
 * Errors: WK_ERROR_UNSUPPORTED if the device cannot make the format; WK_ERROR_OUT_OF_MEMORY.
 */
WK_API
wk_status wk_texture_create(wk_device *device,
                            const wk_texture_desc *desc,
                            wk_texture **out_texture);

/**
 * Destroys a texture. NULL does nothing. Views that use it keep it alive for as long as they need it.
 * Thread: any.
 */
WK_API wk_status wk_texture_destroy(wk_texture *texture);

/**
 * Fills a texture from memory: `height` rows of `bytes_per_row` bytes, the first row the picture's top. `data_size` is
 * the number of bytes at `data`: at least `bytes_per_row` times the height. Copied during the call.
 * Thread: exclusive.
 */
WK_API
wk_status wk_texture_write(wk_texture *texture,
                           const void *data,
                           size_t data_size,
                           uint32_t bytes_per_row);

/**
 * Waits for the GPU and copies a texture to memory: `height` rows of `bytes_per_row` bytes, the first row the
 * picture's top. `data_size` is the room at `data`: at least `bytes_per_row` times the height. Slow: do not call it in
 * every frame.
 * Thread: exclusive.
 * Errors: WK_ERROR_UNSUPPORTED for WK_FORMAT_R8_UNORM.
 */
WK_API
wk_status wk_texture_read(wk_texture *texture,
                          void *data,
                          size_t data_size,
                          uint32_t bytes_per_row);

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
 * For hosts without graphics of their own: Welkin presents to a window that the host names by its native handle. The
 * host makes the window, keeps its event loop, and tells Welkin when its size changes. Resized, hidden, minimised and
 * lost windows give a status and never a fault.
 *
 *   wk_device_create_for_window, wk_surface_create, wk_surface_configure
 *   each frame: wk_surface_acquire, wk_view_record (wk_own_target.surface), wk_surface_present
 *   on WK_ERROR_SURFACE_OUTDATED: wk_surface_configure with the window's present size, next frame
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
/** macOS: `handle` is the NSView*; all calls on the main thread. */
#define WK_WINDOW_APPKIT 5

/**
 * A native window. Welkin ignores fields that its kind does not use. The window must outlive the surface, and its
 * connection the device.
 */
typedef struct wk_window {
    /** sizeof(wk_window) of your header. */
    uint32_t struct_size;
    /** WK_STRUCT_TYPE_WINDOW. */
    wk_struct_type struct_type;
    /** No extensions in this version: NULL. */
    const void *next;
    /** Default WK_WINDOW_XLIB. */
    wk_window_kind kind;
    /** X11's screen number. Default 0. */
    int32_t screen;
    /** See wk_window_kind. Default NULL. */
    void *display;
    /** See wk_window_kind. Default NULL. */
    void *handle;
    /** See wk_window_kind. Default 0. */
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

/** Encoding of the values drawn to a surface; give the frame the matching color_space. */
typedef uint32_t wk_surface_encoding;

/** Display-linear: the hardware encodes to sRGB (WK_COLOR_DISPLAY_LINEAR, or TONE from WK_COLOR_SCENE_LINEAR). */
#define WK_SURFACE_DISPLAY_LINEAR 0
/** Encoded already (WK_COLOR_DISPLAY_SRGB, or TONE from WK_COLOR_SCENE_LINEAR). */
#define WK_SURFACE_DISPLAY_SRGB 1

/** When images reach the screen. */
typedef uint32_t wk_pacing;

/** With the screen's refresh; acquire waits for it. */
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
    /** Width of the window's drawable area, pixels; 0 (the default) while it is minimised. */
    uint32_t width;
    /** Height of the window's drawable area, pixels; 0 (the default) while it is minimised. */
    uint32_t height;
    /** Default WK_SURFACE_DISPLAY_LINEAR. */
    wk_surface_encoding encoding;
    /** Default WK_PACING_REFRESH. */
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
 * Makes an own device that can present to `window` and to other windows of the same connection. `desc` NULL means
 * WK_DEVICE_DESC_INIT. On success `*out_device` is a new handle for `wk_device_destroy`.
 * Thread: any; on macOS the main one. With X11, call XInitThreads first if you use Xlib from several threads.
 * Errors: WK_ERROR_NO_ADAPTER if no driver can present to the window, or as wk_device_create.
 */
WK_API
wk_status wk_device_create_for_window(const wk_device_desc *desc,
                                      const wk_window *window,
                                      wk_device **out_device);

/**
 * Makes a surface on a window. Configure it before use. On success `*out_surface` is a new handle for
 * `wk_surface_destroy`.
 * Thread: exclusive on the device; on macOS the main one.
 * Errors: WK_ERROR_UNSUPPORTED if the device cannot present to this window.
 */
WK_API
wk_status wk_surface_create(wk_device *device,
                            const wk_window *window,
                            wk_surface **out_surface);

/** Destroys a surface; the window stays the host's. NULL does nothing. */
WK_API wk_status wk_surface_destroy(wk_surface *surface);

/**
 * Configures a surface, the first time or after its window changed. An acquired image is given back undrawn. With a
 * width or height of 0 the call succeeds, and acquire answers WK_ERROR_SURFACE_OUTDATED until there is an area.
 * Thread: exclusive.
 * Errors: WK_ERROR_UNSUPPORTED if the window has no format for the encoding; WK_ERROR_SURFACE_OUTDATED if it is gone.
 */
WK_API wk_status wk_surface_configure(wk_surface *surface, const wk_surface_config *config);

/**
 * Acquires the next image to draw into. Called again before `wk_surface_present`, it returns the same image.
 * Thread: exclusive.
 * Answers WK_PENDING if the window shows nothing now: skip this frame.
 * Errors: WK_ERROR_SURFACE_OUTDATED: configure again, also while it is minimised.
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
 * puts it back. Any framebuffer can be a target, the window's (0) too, by copies in and out.
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
 * or glXGetProcAddress do. With WGL, ask wglGetProcAddress, then GetProcAddress of opengl32.dll, which exports what
 * OpenGL 1.1 had. Welkin reads 1, 2, 3 and -1 as NULL: some drivers' wglGetProcAddress returns them. Called with the
 * host's or Welkin's context current.
 */
typedef const void *(*wk_opengl_get_proc_fn)(void *user, const char *name);

/**
 * Makes a context current on the calling thread: `which` is WK_OPENGL_CONTEXT_HOST or WK_OPENGL_CONTEXT_WELKIN.
 * Returns 0 on success, anything else on failure.
 */
typedef int32_t (*wk_opengl_make_current_fn)(void *user, uint32_t which);

/** The context that Welkin draws in. */
typedef uint32_t wk_opengl_mode;

/** Its own context, which shares objects with the host's. */
#define WK_OPENGL_SHARED 0
/** The host's context, whose state it puts back. */
#define WK_OPENGL_HOST_CONTEXT 1

/** Order of the two contexts' commands in shared mode. */
typedef uint32_t wk_opengl_handover;

/** By fences, as the standard requires. */
#define WK_OPENGL_FENCE 0
/** By a flush alone: enough, and cheaper, where one queue serves both contexts. Measure before you rely on it. */
#define WK_OPENGL_FLUSH 1

/** The host's OpenGL. */
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
     * Makes contexts current. Required in shared mode. In the host's context it may be NULL (the default); Welkin then
     * uses the current context as it is.
     */
    wk_opengl_make_current_fn make_current;
    /** Passed to both callbacks. Welkin calls them on the thread that calls it, one at a time. Default NULL. */
    void *user;
    /** Default WK_OPENGL_SHARED. */
    wk_opengl_mode mode;
    /** Default WK_OPENGL_FENCE. */
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
/** The attachments of a framebuffer, 0 being the window's; only in the host's own context. */
#define WK_OPENGL_FRAMEBUFFER 3

/** A host's image, embedded in wk_opengl_target. */
typedef struct wk_opengl_image {
    /** Default WK_OPENGL_NONE. */
    wk_opengl_image_kind kind;
    /** Its OpenGL name. Default 0. */
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
     * one, else another image. It has as many samples as `color`. If `color` has one sample (a resolved picture),
     * depth may have more, except on OpenGL ES; one sample of each pixel then counts.
     */
    wk_opengl_image depth;
    /**
     * A mask of one sample: where red is 1, the host's pixel stays; where it is 0, Welkin draws weather. Default none.
     */
    wk_opengl_image mask;
    /** Pixels; must equal the images' size, and a window's present size. Default 0; must be given. */
    uint32_t width;
    /** Pixels; must equal the images' size, and a window's present size. Default 0; must be given. */
    uint32_t height;
    /** Raise this number when you make an object again under an old name. It must never fall. Default 0. */
    uint64_t generation;
    /** Default WK_OPENGL_MULTISAMPLE_EACH. */
    wk_opengl_multisample multisample;
    /** Must be 0. */
    uint32_t reserved0;
    /**
     * A texture of one sample with each pixel's surface class: the byte of red is a wk_surface_class, or 0 to use
     * wk_ground_grid or the context's default. GL_R8, GL_RGB8 or GL_RGBA8. Default none.
     */
    wk_opengl_image surface_classes;
    /**
     * A texture of one sample with unit normals, in the host's world or in eye space (WK_FRAME_NORMALS_IN_EYE_SPACE):
     * (n + 1) / 2 in GL_RGB8, GL_RGBA8 and GL_RGB10_A2, n in GL_RGB16F, GL_RGBA16F and GL_RGBA32F. Where a pixel is no
     * unit vector (a cleared pixel), Welkin uses the host's terrain or depth. Default none.
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
 * The context that the host draws in. With several windows: the one that was current when the call came (remember it
 * for each thread).
 */
#define WK_OPENGL_CONTEXT_HOST 0
/** The context that the host made for Welkin, sharing objects with its own. */
#define WK_OPENGL_CONTEXT_WELKIN 1

/**
 * Wraps the host's OpenGL context, which must be current on this thread. On success `*out_device` is a new handle for
 * `wk_device_destroy`; call that while the contexts live. Welkin never deletes the host's objects.
 * Thread: the one on which the host's context is current.
 * Errors: WK_ERROR_INVALID_ARGUMENT for callbacks that are missing or return NULL; WK_ERROR_WRONG_ORDER if no context
 * is current, or the wrong one, or conditional rendering or a query that counts is active in WK_OPENGL_HOST_CONTEXT;
 * WK_ERROR_UNSUPPORTED if it is too old; WK_ERROR_ALREADY_WRAPPED if it has a wk_device; WK_ERROR_NO_ADAPTER, with the
 * driver's name, if its driver draws a few known texels wrong or does not finish them within 6 s.
 */
WK_API
wk_status wk_device_create_opengl(const wk_opengl_host_desc *desc,
                                  wk_device **out_device);

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
 * wk_view_record returns, the work is on the queue. Only one thread at a time may use a VkQueue. So either keep other
 * threads away from the queue during Welkin's calls on this device, or pass lock_queue and unlock_queue, which Welkin
 * calls around every submission. Call no Welkin function inside them.
 *
 * Welkin takes an image in the layout in which the host left it and returns it in the layout that the host asks for.
 * On one queue no semaphores are needed: Welkin's work waits for what the host submitted before, and what the host
 * submits afterwards waits for Welkin's. Semaphores order work with other queues.
 *
 * Pass handles as Vulkan has them: dispatchable ones as pointers, others as 64-bit numbers.
 *
 * Needed: Vulkan 1.1, or 1.0 with VK_KHR_maintenance1 and VK_KHR_storage_buffer_storage_class; a queue that draws and
 * computes. For these features, enable on the device and list here:
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

/** The host's Vulkan device. All handles stay the host's and outlive the wk_device. */
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
    /** Takes the host's queue lock. Give it together with unlock_queue, or leave both NULL (the default). */
    wk_vulkan_queue_fn lock_queue;
    /** Releases it. */
    wk_vulkan_queue_fn unlock_queue;
    /** Passed to both. Default NULL. */
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
    /** VkFormat that it was created with. Default 0; must be given. */
    uint32_t format;
    /** Pixels. Default 0; must be given. */
    uint32_t width;
    /** Pixels. Default 0; must be given. */
    uint32_t height;
    /**
     * Samples of a pixel. Default 1. Colour with several needs sampleRateShading in enabled_features of the
     * wk_vulkan_host_desc.
     */
    uint32_t samples;
    /**
     * VkImageUsageFlags that it was created with: COLOR_ATTACHMENT and TRANSFER_SRC for colour, SAMPLED for what is
     * read, DEPTH_STENCIL_ATTACHMENT too for depth with WK_DEPTH_ACCESS_READ_WRITE.
     */
    uint32_t usage;
    /** Array layers that it was created with. Default 1. For an occluder map it must be 1. */
    uint32_t array_layers;
    /**
     * The layer handed over, such as one eye of a stereo or multiview host; the others stay untouched. Default 0.
     */
    uint32_t layer;
    /**
     * VkImageLayout in which the host left that layer. Default 0 (UNDEFINED: its content may be dropped; colour only).
     */
    uint32_t layout;
    /**
     * VkImageLayout in which the host wants it back. Default 0; must be given. PRESENT_SRC_KHR, here and in `layout`,
     * needs VK_KHR_swapchain in enabled_device_extensions of the wk_vulkan_host_desc.
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
    /** Value to wait for or to signal, of a timeline semaphore. Default 0. */
    uint64_t value;
    /** Default WK_VULKAN_SEMAPHORE_BINARY. */
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
     * depth may have more; the first of each pixel then counts. NULL (the default) shows the sky in every pixel.
     */
    const wk_vulkan_image *depth;
    /**
     * A mask: where it is 1, the host's pixel stays; where it is 0, Welkin draws weather. As large as `color`, one
     * sample, another image. Default NULL.
     */
    const wk_vulkan_image *mask;
    /** Semaphores to wait for before drawing; the signal of a binary one must be submitted. At most 16. */
    const wk_vulkan_semaphore *wait_semaphores;
    /** Semaphores to signal when all is drawn and the images are in their final layouts. At most 16. */
    const wk_vulkan_semaphore *signal_semaphores;
    /** Number of waits. Default 0. */
    uint32_t wait_count;
    /** Bytes from one wait to the next: sizeof(wk_vulkan_semaphore) of your header, which is the default. */
    uint32_t wait_stride;
    /** Number of signals. Default 0. */
    uint32_t signal_count;
    /** Bytes from one signal to the next: sizeof(wk_vulkan_semaphore) of your header, which is the default. */
    uint32_t signal_stride;
    /**
     * Each pixel's surface class: the byte of red is a wk_surface_class, or 0 to use wk_ground_grid or the context's
     * default. VK_FORMAT_R8_UNORM or the like, as large as `color`, one sample. Default NULL.
     */
    const wk_vulkan_image *surface_classes;
    /**
     * Unit normals, in the host's world or in eye space (WK_FRAME_NORMALS_IN_EYE_SPACE): (n + 1) / 2 in normalised
     * formats, n in float formats. Where a pixel is no unit vector (a cleared pixel), Welkin uses the host's terrain
     * or depth. As large as `color`, one sample. Default NULL.
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
 * WK_ERROR_UNSUPPORTED names what the driver cannot do; WK_ERROR_ALREADY_WRAPPED if the queue has a wk_device.
 */
WK_API wk_status wk_device_create_vulkan(const wk_vulkan_host_desc *desc, wk_device **out_device);

/**
 * Waits until the GPU no longer uses a VkImage, and forgets it. Call it for each image that you handed over, before or
 * after you destroy it (an engine may rebuild its swapchain inside a call), but before you hand over a new one: Vulkan
 * may give the new image the old handle, and Welkin would draw into the dead image. As always, destroy an image only
 * when the GPU has finished with it: after the signals of its last wk_view_record, or after vkDeviceWaitIdle. An
 * unknown image is no error. Slow: do not call it in every frame.
 * Thread: exclusive on the device.
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
 * Kinds that a report names by words. The numbers never change.
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

/** No fog: the aerosol takes what visibility lacks. */
#define WK_FOG_NONE 0
/** Mist (METAR BR): droplets, 1 to 5 km. */
#define WK_FOG_MIST 1
/** Shallow fog (METAR MIFG): below 2 m, clear above. */
#define WK_FOG_SHALLOW 2
/** Patches of fog (METAR BCFG). */
#define WK_FOG_PATCHES 3
/** Part of the aerodrome in fog (METAR PRFG). */
#define WK_FOG_PARTIAL 4
/** Fog (METAR FG): below 1 km. */
#define WK_FOG_FOG 5
/** Freezing fog (METAR FZFG): supercooled droplets. */
#define WK_FOG_FREEZING 6

/** Cloud genera, and the two that METAR names. */
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
 * Kind of precipitation. For the types of rain choose: frontal (stratiform): RAIN, usually 1 to 10 mm/h; convective:
 * RAIN with WK_PRECIPITATION_SHOWERS, 10 to 100 mm/h; relief (orographic), with many small drops: DRIZZLE, 0.5 to 3
 * mm/h; drizzle: DRIZZLE, 0.1 to 1 mm/h. docs/rain.md has the drop sizes of each.
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
/** Lying snow; see snow_depth_m. */
#define WK_SURFACE_SNOW 6

/*
 * ====================================================================================================
 * [weather] Weather
 *
 * A wk_weather describes the weather: plain data in SI units, which every call copies. Start from WK_WEATHER_INIT (a
 * clear standard day), a METAR report or a preset, and change what you know better. Zero is a value everywhere (0
 * degrees, north, calm, 0 %). What may be unknown has a bit in `has`: where the bit is clear, Welkin ignores the field
 * and derives the value by a named physical law. All reals are doubles.
 * ====================================================================================================
 */

/** Flags of the optional fields of a wk_cloud_layer that are set. */
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
    /** Fraction of the sky that it covers (eighths / 8). Range [0, 1], default 0. */
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
     * middle of the layer, which grows and veers with height (docs/clouds.md). A change of it moves no cloud at once.
     */
    double wind_m_s;
    /**
     * Optional, with the field before: where that wind comes from, degrees clockwise from true north. Range [0, 360].
     */
    double wind_from_deg;
    /** Distance from cloud to cloud, m. Range [50, 200000]; 0, the default, by kind and thickness. */
    double spacing_m;
    /** Time in which its clouds come and go, s. Range [60, 1e6]; 0, the default, is 1200. */
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

/** Flags of the optional fields of a wk_weather that are set. */
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

/** How precipitation falls. */
typedef uint32_t wk_precipitation_flags;

/** From convective cloud (SH): fewer and larger drops, sharp onset and end. */
#define WK_PRECIPITATION_SHOWERS 1
/** With thunder (TS). */
#define WK_PRECIPITATION_THUNDERSTORM 2
/** With hail besides the kind (GR, GS). */
#define WK_PRECIPITATION_WITH_HAIL 4

/** The weather at a station and moment. Heights are above the station unless stated otherwise. */
typedef struct wk_weather {
    /** sizeof(wk_weather) of your header. */
    uint32_t struct_size;
    /** WK_STRUCT_TYPE_WEATHER. */
    wk_struct_type struct_type;
    /** No extensions in this version: NULL. */
    const void *next;
    /** Flags of the optional fields that are set. Default 0. */
    wk_weather_has_flags has;
    /**
     * Meteorological optical range at the station, m: where 550 nm light falls to 5 % (the reported visibility). It is
     * total: air, haze, fog, rain and snow together. Range [1, 1e6], default 40000.
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
    /** Optional: exponent with which extinction falls, wavelength^-exponent. Range [-1, 4]; else by kind. */
    double aerosol_angstrom_exponent;
    /** Optional: single scattering albedo at 550 nm. Range [0, 1]; else by kind and humidity. */
    double aerosol_single_scattering_albedo;
    /** Optional: mean cosine of the phase function. Range [-0.99, 0.99]; else by kind and humidity. */
    double aerosol_asymmetry;
    /**
     * Optional: height over which particles thin out by 1/e, m. Range [10, 20000]; else by kind. At least the
     * station's altitude over 4.6 is used (435 m at 2000 m), because the sky counts densities from the sea.
     */
    double aerosol_scale_height_m;
    /** Optional: top of the fog, m. Range [0.1, 2000]; else by kind or vertical visibility. */
    double fog_top_m;
    /** Optional: fraction of the ground under fog. Range [0, 1]; else by kind. */
    double fog_coverage;
    /**
     * Optional: visibility inside the fog, m. Range [1, 10000]; else visibility_m, or 200 m in shallow or patchy fog
     * that the reported visibility looks over or past.
     */
    double fog_visibility_inside_m;
    /** Kind of precipitation. Default WK_PRECIPITATION_NONE. */
    wk_precipitation_kind precipitation_kind;
    /** How precipitation falls. Default 0. */
    wk_precipitation_flags precipitation_flags;
    /** Precipitation rate, mm/h of liquid water. Range [0, 500], default 0; must be 0 if nothing falls. */
    double precipitation_rate_mm_h;
    /** Optional: liquid fraction of it. Range [0, 1]; else by kind. */
    double precipitation_liquid_fraction;
    /** Mean wind at 10 m above ground, m/s. Range [0, 120], default 0. */
    double wind_speed_m_s;
    /** Direction that the wind comes from, degrees clockwise from true north. Range [0, 360], default 0. */
    double wind_from_deg;
    /** Optional: highest 3-second gust, m/s. Range [wind_speed_m_s, 150]; else from the turbulence. */
    double wind_gust_m_s;
    /**
     * Optional, together with the next field: start of the range of varying direction, degrees; the range runs
     * clockwise. Range [0, 360].
     */
    double wind_variable_from_deg;
    /** End of that range, degrees. Range [0, 360]. 0 to 360 means all directions (VRB). */
    double wind_variable_to_deg;
    /**
     * Optional: turbulence intensity, the standard deviation of speed over its mean. Range [0, 1]; else from the
     * roughness.
     */
    double wind_turbulence_intensity;
    /** Optional: significant height of the wind sea, m. Range [0, 30]; else from sea_state or the wind. */
    double sea_significant_wave_height_m;
    /** Optional: water temperature, degrees Celsius. Range [-3, 45]; else the air's, not below -1.8. */
    double sea_temperature_c;
    /** Optional, together with the next two fields: significant height of the swell, m. Range [0, 20]. */
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
    /** Optional: depth of the layer that the wind lifts, m. Range [0.1, 5000]; else by kind. */
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

/** Flags of the fields of a wk_weather_overrides that are set. */
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
/** Rain adds no cloud that the report lacks. */
#define WK_OVERRIDE_RAIN_WITHOUT_CLOUD 128
/** cloud_direct and cloud_diffuse */
#define WK_OVERRIDE_CLOUD_LIGHT 256
/** wave_height_m */
#define WK_OVERRIDE_WAVE_HEIGHT 512
/** wetness */
#define WK_OVERRIDE_WETNESS 1024

/**
 * Your own values in place of the laws that couple the parts of the weather. An extension: put it into
 * wk_weather.next.
 */
typedef struct wk_weather_overrides {
    /** sizeof(wk_weather_overrides) of your header. */
    uint32_t struct_size;
    /** WK_STRUCT_TYPE_WEATHER_OVERRIDES. */
    wk_struct_type struct_type;
    /** The next extension. Default NULL. */
    const void *next;
    /** Flags of the fields that are set; laws give the others. Default 0. */
    wk_override_flags set;
    /** Must be 0. */
    uint32_t reserved0;
    /**
     * Aerosol extinction at 550 nm and station height, 1/m, in place of the share of the visibility. Range [0, 10].
     */
    double aerosol_extinction_per_m;
    /** Extinction inside the ground layer, 1/m, in place of the rest of the visibility. Range [0, 10]. */
    double fog_extinction_per_m;
    /** Extinction of precipitation, 1/m, in place of what the drop and flake spectra give. Range [0, 10]. */
    double precipitation_extinction_per_m;
    /** Visibility in the air above a mist or fog, m. Range [100, 1e6]; law: 5 km over mist, 10 km over fog. */
    double visibility_above_fog_m;
    /**
     * Growth factor of particles by humidity, over their size at 80 %. Range [0.1, 20]; law: Haenel's; 1 switches
     * growth off.
     */
    double humidity_growth;
    /** Air density at sea level over the standard's. Range [0, 10]. */
    double rayleigh_density_ratio;
    /** Scale height of the air, m. Range [100, 50000]. */
    double rayleigh_scale_height_m;
    /** Fraction of the sun's direct beam that passes the clouds. Range [0, 1]. */
    double cloud_direct;
    /** Diffuse light below the clouds as a fraction of the light above. Range [0, 1]. */
    double cloud_diffuse;
    /** Significant wave height, m, in place of what wind or sea state give. Range [0, 30]. */
    double wave_height_m;
    /** Wetness of the ground, in place of what precipitation gives. Range [0, 1]. */
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
 * Turns a METAR or SPECI report, as airports send it, into a wk_weather. Welkin reads what is there, in any order up
 * to the pressure. Fields that the report leaves out or marks as missing keep their defaults, or what the rest of the
 * report makes likely, and have a bit in wk_metar.assumed; words that are no group of the code change nothing and are
 * counted. So a calm wind (00000KT) and one that nobody measured (/////KT) differ by WK_METAR_ASSUMED_WIND.
 *
 * No report says how high its station lies: weather.station_altitude_m is 0 afterwards. Look wk_metar.station up in
 * your list of airports and set it, because cloud bases, visibility and temperature refer to that height.
 * ====================================================================================================
 */

/** Flags of a report. */
typedef uint32_t wk_metar_flags;

/** A special report (SPECI). */
#define WK_METAR_SPECIAL 1
/** Made without an observer (AUTO). */
#define WK_METAR_AUTOMATIC 2
/** A correction (COR). */
#define WK_METAR_CORRECTED 4
/** The report says only that visibility is at least so much (CAVOK, 9999, 10SM). */
#define WK_METAR_VISIBILITY_IS_MINIMUM 8

/** Fields that a report leaves out or marks as missing. */
typedef uint32_t wk_metar_assumed_flags;

/** wind_speed_m_s, with all of the wind: calm is assumed. */
#define WK_METAR_ASSUMED_WIND 1
/** wind_from_deg: 0 is assumed. */
#define WK_METAR_ASSUMED_WIND_DIRECTION 2
/** visibility_m: what humidity and what falls leave, at most 1 km in fog and 5 km in mist or haze. */
#define WK_METAR_ASSUMED_VISIBILITY 4
/** The present weather (`//`): neither precipitation nor fog nor haze is assumed. */
#define WK_METAR_ASSUMED_PRECIPITATION 8
/** The clouds (`//////`, or no group at all): none are assumed beside those that are reported. */
#define WK_METAR_ASSUMED_CLOUDS 16
/** base_m of a layer (`BKN///`): 600 m is assumed. */
#define WK_METAR_ASSUMED_CLOUD_BASE 32
/** cover of a layer (`///015`, `//////CB`): 3.5 eighths are assumed. */
#define WK_METAR_ASSUMED_CLOUD_COVER 64
/** vertical_visibility_m (`VV///`): 60 m is assumed. */
#define WK_METAR_ASSUMED_VERTICAL_VISIBILITY 128
/**
 * temperature_c: 15, at most -1 where it snows or drops freeze, at most 1 where rain and snow fall together or what
 * falls is unknown; from the dew point at 70 % if only that is there.
 */
#define WK_METAR_ASSUMED_TEMPERATURE 256
/** relative_humidity: 0.7, or what a dew point gives at the assumed temperature. */
#define WK_METAR_ASSUMED_HUMIDITY 512
/** pressure_hpa: 1013.25 is assumed. */
#define WK_METAR_ASSUMED_PRESSURE 1024
/** wk_metar.day, hour and minute: 0. */
#define WK_METAR_ASSUMED_TIME 2048

/** How the amounts of cloud groups count. Nations differ, and a report does not say which practice it follows. */
typedef uint32_t wk_cloud_amount_rule;

/**
 * By the station's first letters: sums in the United States with its territories and in Canada (K, C; P but for PC and
 * PL; TI, TJ, NSTU, MUGM), layers elsewhere. American bases abroad report sums under the host country's letters: set
 * the rule for them.
 */
#define WK_CLOUD_AMOUNT_BY_STATION 0
/**
 * Each group counts what its layer and all lower ones hide (Federal Meteorological Handbook No. 1, 9.4.2 b and 9.5.2).
 */
#define WK_CLOUD_AMOUNT_SUMS 1
/** Each group counts its layer as if there were no other cloud (WMO-No. 306, FM 15, 15.9.1.2). */
#define WK_CLOUD_AMOUNT_LAYERS 2

/**
 * Place and time of a report, and what of it the weather does not hold. Offsets and lengths are bytes in the text that
 * you passed; 0 and 0 where the report has no such part.
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
    /** Flags of a report. */
    wk_metar_flags flags;
    /** Fields that the report leaves out or marks as missing. */
    wk_metar_assumed_flags assumed;
    /** Rule by which the amounts of clouds were read: WK_CLOUD_AMOUNT_SUMS or WK_CLOUD_AMOUNT_LAYERS. */
    wk_cloud_amount_rule cloud_amounts;
    /**
     * Lowest visibility in some direction, m, where the report states one beside the prevailing one (`4000 1500NE`,
     * `9999 3100`), else 0. For information: the weather has the prevailing one.
     */
    double lowest_visibility_m;
    /** Where the runway visual ranges begin. */
    uint32_t runways_offset;
    /** Bytes from the first to the last of them. */
    uint32_t runways_length;
    /** Where the trend forecast begins, its first word (NOSIG, BECMG, TEMPO) included. */
    uint32_t trend_offset;
    /** Bytes of the trend forecast. */
    uint32_t trend_length;
    /** Where the remarks begin, after RMK. */
    uint32_t remarks_offset;
    /** Bytes of the remarks. */
    uint32_t remarks_length;
    /** Where the first word stands that is no group of the code. */
    uint32_t unread_offset;
    /** Bytes of that word. */
    uint32_t unread_length;
    /** Number of such words. */
    uint32_t unread_count;
    /** Must be 0. */
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

/** How a report is read. */
typedef struct wk_metar_options {
    /** sizeof(wk_metar_options) of your header. */
    uint32_t struct_size;
    /** WK_STRUCT_TYPE_METAR_OPTIONS. */
    wk_struct_type struct_type;
    /** No extensions in this version: NULL. */
    const void *next;
    /** How the amounts of cloud groups count. Default WK_CLOUD_AMOUNT_BY_STATION. */
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
 * the station's rule. Its cloud layers go to `layers`, which has room for `layer_capacity` of `layer_size` bytes
 * (sizeof(wk_cloud_layer) of your header; 16 always suffice), and out_weather->clouds leads there: keep it as long as
 * the weather. `out_metar` may be NULL. out_weather->station_altitude_m is 0: set it from a list of airports. Thread:
 * any. Errors: WK_ERROR_PARSE for a text without a station, without an observation (NIL) or without any group of the
 * weather, with line and column, what was expected there and what was found; WK_ERROR_INVALID_ARGUMENT if the layers
 * do not fit.
 */
WK_API
wk_status wk_weather_from_metar(const char *report,
                                wk_cloud_layer *layers,
                                uint32_t layer_capacity,
                                uint32_t layer_size,
                                wk_weather *out_weather,
                                wk_metar *out_metar);

/**
 * Reads a report as wk_weather_from_metar does, and as `options` say. NULL is every default.
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
 * Writes the weather of a named preset to `*out_weather`; layers as in wk_weather_from_metar. wk_get_preset lists the
 * names.
 * Thread: any.
 * Errors: WK_ERROR_INVALID_ARGUMENT for a name that is not listed; the message lists them.
 */
WK_API
wk_status wk_weather_from_preset(const char *name,
                                 wk_cloud_layer *layers,
                                 uint32_t layer_capacity,
                                 uint32_t layer_size,
                                 wk_weather *out_weather);

/**
 * Gets name and one-line description of the preset `index`, from 0 in the order of a menu. Both texts live as long as
 * the process. Either pointer may be NULL.
 * Thread: any.
 * Errors: WK_ERROR_INVALID_ARGUMENT beyond the last one.
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
 * A wk_context has the weather, the time and the place that all views of a simulator share. It is a function of its
 * description, its timeline and its time: two contexts with the same input answer the same, on every machine.
 *
 * The world. FLAT: the ground is a plane, altitude is the up coordinate. TANGENT: east-north-up at the origin's place,
 * with the curved planet below. ECEF: Earth-centred, Earth-fixed (WGS 84) coordinates. Axes of flat and tangent worlds
 * are x east, y north, z up (Z_UP) or x east, y up, z south (Y_UP, the usual OpenGL world). Directions in answers are
 * unit vectors (east, north, up) at the place asked for; azimuths are degrees clockwise from true north.
 *
 * Altitudes count from mean sea level everywhere in this header. In an ECEF world that lies geoid_height_m of
 * wk_context_desc above the ellipsoid; with the default of 0 heights above the ellipsoid are taken for altitudes.
 * ====================================================================================================
 */

/** Weather, time and place. Child of a wk_device, parent of views. */
typedef struct wk_context wk_context;

/** How the host's world is placed on the planet. */
typedef uint32_t wk_world_kind;

/** A plane: up is the same everywhere, altitude is the up coordinate plus the origin's. */
#define WK_WORLD_FLAT 0
/** East-north-up at the origin's place, the curved planet below. */
#define WK_WORLD_TANGENT 1
/**
 * Earth-centred, Earth-fixed (WGS 84); axes and grid bearing have no effect, and the origin only affects the sunlight
 * that dries a simulated ground (WK_GROUND_SIMULATED). Altitudes are heights above the ellipsoid less geoid_height_m.
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

/** From the light that falls on level ground; exposure_value is a compensation in stops, [-20, 20]. */
#define WK_EXPOSURE_AUTO 0
/** exposure_value is an exposure value at ISO 100, [-20, 30]: 15 a sunny day, -4 a moonlit night. */
#define WK_EXPOSURE_EV100 1
/** exposure_value is display units per cd/m^2, (0, 1e6]. */
#define WK_EXPOSURE_FACTOR 2
/** In a wk_frame: the context's exposure; exposure_value is not used. */
#define WK_EXPOSURE_OF_CONTEXT 3

/** Curve from exposed luminance to display values. */
typedef uint32_t wk_tone_curve;

/** Clamp. */
#define WK_TONE_LINEAR 0
/** 1 - exp(-x) a channel: bright skies never burn out. */
#define WK_TONE_EXPONENTIAL 1
/** Hable's filmic curve, white at 11.2. */
#define WK_TONE_FILMIC 2

/** Settings for a new context. */
typedef struct wk_context_desc {
    /** sizeof(wk_context_desc) of your header. */
    uint32_t struct_size;
    /** WK_STRUCT_TYPE_CONTEXT_DESC. */
    wk_struct_type struct_type;
    /** NULL (the default), or a chain of wk_sky_settings and wk_simulation_desc. */
    const void *next;
    /** Default WK_WORLD_FLAT. */
    wk_world_kind world_kind;
    /** Default WK_AXES_Z_UP. */
    wk_axes axes;
    /** Latitude of the host's (0, 0, 0), degrees north. Range [-90, 90], default 50. */
    double latitude_deg;
    /** Longitude of the host's (0, 0, 0), degrees east. Range [-360, 360], default 10. */
    double longitude_deg;
    /** Altitude of the host's (0, 0, 0) above mean sea level, m. Range [-1e4, 1e9], default 0. */
    double altitude_m;
    /** Bearing of the world's north axis, degrees clockwise from true north. Range [-360, 360], default 0. */
    double grid_bearing_deg;
    /** Seed of everything random. Default 0. */
    uint64_t seed;
    /** A planet file's text (TOML, UTF-8; docs/planets.md), read during the call. Default NULL: the Earth. */
    const char *planet_toml;
    /**
     * Exposure of frames that have none of their own. Default WK_EXPOSURE_AUTO; WK_EXPOSURE_OF_CONTEXT is refused
     * here.
     */
    wk_exposure_mode exposure_mode;
    /** Default WK_TONE_EXPONENTIAL. */
    wk_tone_curve tone_curve;
    /** See wk_exposure_mode. Default 0. */
    double exposure_value;
    /**
     * Universal time at simulation time 0, seconds since 1970-01-01T00:00:00Z without leap seconds (Unix time).
     * Range: the years -2000 to 6000. Default 2026-06-21 10:00.
     */
    double utc_at_zero_s;
    /**
     * A directory, UTF-8, for the sky's finished tables; Welkin makes it if needed. A later start with the same
     * planet, sky settings and weather reads the tables instead of building them. Welkin keeps the tables of the first
     * drawn weather and those of wk_context_build_sky: the newest 32 of all programs that name the directory (2 MB
     * each). If a file is damaged or cannot be written, Welkin logs that and builds the tables. Read during the call.
     * Default NULL: no files.
     */
    const char *cache_dir;
    /**
     * Height of mean sea level above the WGS 84 ellipsoid where the simulation takes place (the geoid's undulation),
     * m: 47.8 at Frankfurt, -30 at New York. One number for the context; it varies by some metres over 100 km. For
     * WK_WORLD_ECEF, whose coordinates know the ellipsoid alone: altitudes, the tops of fog and the bases of clouds
     * among them, count from mean sea level. Without effect in other worlds. Range [-120, 120], default 0.
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
 * Receives how much of a long operation is done, from 0 to 1, never less than before. Return 0 to go on; anything else
 * ends the operation with WK_ERROR_ABORTED. It must not call Welkin and must not unwind. It may draw with the host's
 * own means, an OpenGL context included.
 */
typedef int32_t (*wk_progress_fn)(void *user, double share);

/**
 * Makes a context on a device. `desc` NULL means WK_CONTEXT_DESC_INIT. On success `*out_context` is a new handle for
 * `wk_context_destroy`. The weather is a clear standard day at noon until you set another.
 * Thread: exclusive on the device.
 * Errors: WK_ERROR_PARSE for the planet file, with line and column; WK_ERROR_INVALID_ARGUMENT naming the field.
 */
WK_API
wk_status wk_context_create(wk_device *device,
                            const wk_context_desc *desc,
                            wk_context **out_context);

/**
 * Replaces the planet: its air, ground and sun. `planet_toml` is a planet file's text (TOML, UTF-8), read during the
 * call; NULL means the Earth. Light and queries are those of the new planet at once; nothing is blended. The sky's
 * tables follow as after a change of weather: a draft fades in over sixteen frames, and later frames refine it. If the
 * radius, the top or the wavelengths differ, the next frame shows a draft of the new planet at once
 * (docs/planets.md).
 * Thread: exclusive.
 * Errors: WK_ERROR_PARSE for the text, with line and column; WK_ERROR_INVALID_ARGUMENT naming the field. The planet
 * stays as it was.
 */
WK_API
wk_status wk_context_set_planet(wk_context *context,
                                const char *planet_toml);

/**
 * Sets the curve from luminance to the display for the next frames, as tone_curve of wk_context_desc did.
 * Thread: exclusive.
 */
WK_API wk_status wk_context_set_tone_curve(wk_context *context, wk_tone_curve curve);

/**
 * Builds the sky's tables for the context's planet and the weather of its present time completely, so that no frame
 * has to. Call it at load time, behind a progress bar. It takes tables that another context of the device already
 * shows or that lie in the context's cache_dir, and writes new ones there. Without this call the first frame shows a
 * draft of the sky, within 3 of 255 of the whole one, and 120 frames refine it without a visible step.
 * WK_FRAME_NO_HISTORY in a frame builds everything in that frame (docs/first-frames.md). `progress` may be NULL; else
 * it is called about sixteen times, the last time with 1. An aborted build leaves the context as it was and writes no
 * file. Thread: exclusive on the context. For a device round an OpenGL context as wk_view_record; that is the host's
 * own again while `progress` runs. Errors: WK_ERROR_ABORTED; WK_ERROR_DEVICE_LOST.
 */
WK_API wk_status wk_context_build_sky(wk_context *context, wk_progress_fn progress, void *user);

/**
 * Destroys a context. NULL does nothing.
 * Thread: any; the GPU's part is released at the device's next call if it must be.
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
 * Four models share the same look-ups. Use the default: 95 % of its pixels are within 2.4 % of converged multiple
 * scattering in clear air and haze. The others are for comparison and for slow machines. A wk_sky_settings goes into
 * wk_context_desc.next, or to wk_context_set_sky_settings later.
 * ====================================================================================================
 */

/** Model of the sky. */
typedef uint32_t wk_sky_model;

/** Light scattered more than once keeps its direction, order by order. The default. */
#define WK_SKY_DIRECTIONAL 0
/**
 * Light scattered more than once is the same in all directions (Hillaire 2020); less accurate and quicker to build.
 * docs/lab charts both.
 */
#define WK_SKY_ISOTROPIC 1
/**
 * Light scattered once, from a table over altitude, view angle and sun angle (Elek 2008), as in older systems; light
 * scattered more often is missing.
 */
#define WK_SKY_TABLE_3D 2
/** As the default, but light scattered once is marched in every pixel: a reference for the tables. */
#define WK_SKY_BRUTE_FORCE 3

/**
 * Sizes of the sky's tables. An extension: put it into wk_context_desc.next. Or set it later by
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
     * Orders of scattering computed one by one; a geometric series stands for the rest. Range [3, 16], default 5.
     */
    uint32_t orders;
    /** Sun angles of the planet's tables. Range [16, 128], default 64. */
    uint32_t suns;
    /** Altitudes of the planet's tables. Range [8, 64], default 22. */
    uint32_t altitudes;
    /** Azimuths on [0, pi] of an observer's sky. Range [8, 256], default 40. */
    uint32_t sky_azimuths;
    /** Rows of an observer's sky above the horizon. Range [8, 256], default 80. */
    uint32_t sky_above;
    /** Rows of an observer's sky below the horizon. Range [8, 256], default 40. */
    uint32_t sky_below;
    /** Distances of the air in front of things. Range [4, 64], default 16. */
    uint32_t air_slices;
    /** Cells of a march per pixel (WK_SKY_BRUTE_FORCE). Range [1, 4096], default 64. */
    uint32_t march_cells;
    /**
     * Wavelengths that the sky is computed for, a multiple of 3. Range [3, 15]; 3 (the default) and 0 mean the
     * planet's own three. More wavelengths give truer colours at a low sun: the error of the worst channel over the
     * luminance is 6 % with 3, 2.4 % with 9, and 15 are within 1 % of 40. The time to build tables grows in
     * proportion, for a change of air as for a moving sun: five times with 15. Pixels cost the same.
     * WK_SKY_DIRECTIONAL and WK_SKY_ISOTROPIC only.
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
 * Changes how the sky is drawn, as wk_sky_settings in wk_context_desc.next did. `settings` NULL means
 * WK_SKY_SETTINGS_INIT. Views use the new tables from their next frame on, and that frame shows a draft of the sky as
 * a first frame does; wk_context_build_sky after this call makes the final picture ready. Pipelines of another model
 * are compiled in that frame. The same settings again change nothing. Thread: exclusive. Errors:
 * WK_ERROR_INVALID_ARGUMENT naming the field; WK_ERROR_DEVICE_LOST. The settings stay as they were.
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
 * The host owns simulation time: seconds in double precision, moved forward by wk_context_update. Weather is a
 * timeline of changes, each with an absolute start and a duration; between changes it stays. A change that begins
 * during another one is laid over it, so neither the weather nor its rate of change jumps. The same calls in the same
 * order give the same weather on every machine.
 *
 * Sun and moon follow from place and universal time, which is tied to simulation time, or stand where the host puts
 * them.
 * ====================================================================================================
 */

/** A direction to the sun or moon, given by the host in place of the almanac. */
typedef struct wk_given_direction {
    /** sizeof(wk_given_direction) of your header. */
    uint32_t struct_size;
    /** WK_STRUCT_TYPE_GIVEN_DIRECTION. */
    wk_struct_type struct_type;
    /** No extensions in this version: NULL. */
    const void *next;
    /** Degrees clockwise from true north. Range [-360, 360], default 180. */
    double azimuth_deg;
    /** Degrees above the horizon, without refraction. Range [-90, 90], default 45. */
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
 * or before a change that was given earlier. After an error the weather stays as it was.
 */
WK_API
wk_status wk_context_set_weather(wk_context *context,
                                 const wk_weather *weather,
                                 double start_time_s,
                                 double transition_s);

/**
 * Moves simulation time to `time_s`, [-1e10, 1e10]; the same time again changes nothing. Call it once a frame before
 * the views record. Weather and light are functions of time and follow at once. A simulated ground
 * (WK_GROUND_SIMULATED) takes one step for every 10 s. One call steps for at most 50 ms, and at least once. If steps
 * remain, as after a leap of hours, the call answers WK_PENDING: call it again with the same time, in a loop or once a
 * frame, until it answers WK_OK. Until then water on the ground is drawn and answered as of wk_context_get_state_time,
 * settings take effect only after the remaining steps, and a later time is taken up when these are done. So the state
 * is the same however many calls it takes. A leap of more than a day starts the ground a day before its end, as wet as
 * the weather reports it then.
 * Thread: exclusive. Answers WK_PENDING, which is no error, while steps remain.
 * Errors: WK_ERROR_WRONG_ORDER if it lies before the present.
 */
WK_API
wk_status wk_context_update(wk_context *context,
                            double time_s);

/**
 * Simulation time of the state, s: that of the last wk_context_update, or earlier while that answers WK_PENDING. The
 * difference is how far the state lags behind. It never goes back, except by wk_context_load.
 * Thread: concurrent.
 */
WK_API wk_status wk_context_get_state_time(const wk_context *context, double *out_state_time_s);

/**
 * Ties universal time to simulation time: universal time is `utc_s` (Unix time, seconds without leap seconds) at
 * simulation time `time_s`. Before the first call it is wk_context_desc.utc_at_zero_s at simulation time 0.
 * Thread: exclusive.
 */
WK_API wk_status wk_context_set_clock(wk_context *context, double utc_s, double time_s);

/**
 * Unix time of a calendar date (proleptic Gregorian) and a time of day in UTC. `year` in [-2000, 6000]; `second` in
 * [0, 60), in the last minute of a day in [0, 61): the leap second 23:59:60 is the first second of the next day, as
 * Unix time has it. Thread: any.
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
 * Puts the sun into a given direction; NULL returns it to the almanac.
 * Thread: exclusive.
 */
WK_API wk_status wk_context_set_sun(wk_context *context, const wk_given_direction *direction);

/**
 * Puts the moon into a given direction (its phase follows from the sun's place); NULL returns it to the almanac.
 * Thread: exclusive.
 */
WK_API wk_status wk_context_set_moon(wk_context *context, const wk_given_direction *direction);

/**
 * Sets the exposure of frames that have none of their own; see wk_exposure_mode. WK_EXPOSURE_OF_CONTEXT is refused
 * here.
 * Thread: exclusive.
 */
WK_API wk_status wk_context_set_exposure(wk_context *context, wk_exposure_mode mode, double value);

/**
 * Writes everything that decides what the context shows from now on, as UTF-8 text, the same on every machine:
 * weather, time, clock, given sun and moon, planet, exposure, tone curve, fog law, shelters, lamps, rain areas, wind
 * grid, the terrain with its water, and the world, place, seed and ground model that it belongs to. Of the tiles of a
 * wk_terrain it has the water alone. Not included:
 * how it is drawn (sky settings, views, plans), and the images of wk_context_set_occluder_maps, because each channel
 * may have its own. `*out_size` gets the bytes needed, even if `capacity` is too small (then nothing else is written
 * and the call fails) or `buffer` is NULL with `capacity` 0 (then it succeeds).
 * Thread: concurrent.
 * Errors: WK_ERROR_WRONG_ORDER while wk_context_update answers WK_PENDING.
 */
WK_API wk_status wk_context_save(const wk_context *context, void *buffer, size_t capacity, size_t *out_size);

/**
 * Loads a state that wk_context_save wrote and replaces the context's own. The context must have been created with the
 * same world_kind, latitude_deg, longitude_deg, altitude_m, axes and grid_bearing_deg (for WK_WORLD_ECEF instead of
 * these two geoid_height_m), seed and ground_model. A state of an earlier version that holds no planet and tone curve
 * needs the same of these too. Occluder maps stay as they are. Tiles of a wk_terrain stay too: set those of the state,
 * as they were when it was saved, before. Thread: exclusive. Errors: WK_ERROR_PARSE for bytes that are no saved state,
 * are cut short, have even one byte changed, or have another format, which the message names (this version reads
 * format 2; save states of format 1 again, because they did not say what place they were of);
 * WK_ERROR_INVALID_ARGUMENT naming all settings that differ. After an error the context stays as it was.
 */
WK_API
wk_status wk_context_load(wk_context *context,
                          const void *state,
                          size_t size);

/**
 * Gets a hash of what wk_context_save writes. It is equal on two channels whose contexts show the same world from now
 * on.
 * Thread: concurrent.
 * Errors: WK_ERROR_WRONG_ORDER while wk_context_update answers WK_PENDING.
 */
WK_API wk_status wk_context_state_hash(const wk_context *context, uint64_t *out_hash);

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
 * Fog follows from the weather and is lit by sun and sky. For pictures that must look as before, Welkin can draw the
 * laws of older systems instead: linear, exponential, exponential squared, on range or plane distance.
 * ====================================================================================================
 */

/** Curve of the fog: V is the share of an object's colour that is left at distance d, 1 clear, 0 all fog. */
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

/** From the camera's centre: turning the camera changes nothing. */
#define WK_FOG_DISTANCE_RANGE 0
/** From the camera's plane, as in the oldest systems. */
#define WK_FOG_DISTANCE_PLANE 1

/** Flags of the optional fields of a wk_fog_law that are set. */
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
    /** Default WK_FOG_CURVE_CLEAR. */
    wk_fog_curve curve;
    /** Default WK_FOG_DISTANCE_RANGE. */
    wk_fog_distance distance;
    /** Flags of the optional fields that are set. Default 0. */
    wk_fog_law_has_flags has;
    /** Must be 0. */
    uint32_t reserved0;
    /** Linear: distance where fog begins, m. Range [0, 1e9], default 0. */
    double start_m;
    /** Linear: distance where all is fog, m. Above start_m, at most 1e9; default 1000. */
    double end_m;
    /** Exponential and squared: density, 1/m. Range [0, 10], default 0.003. */
    double density_per_m;
    /**
     * Optional: radiance that the picture fades into, cd/m^2 a channel. Range [0, 1e12]; else that of deep fog under
     * the present light.
     */
    double color[3];
    /**
     * Elevation above the horizon up to which sky pixels fade, rad: fully at the horizon, not at all here. Range [0,
     * pi], default 0.2. 0 leaves the sky as it is, pi covers all of it.
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
 */
WK_API wk_status wk_context_set_fog_law(wk_context *context, const wk_fog_law *fog_law);

/**
 * Gets the distance beyond which a fog law leaves less than 1/255 of an object's colour, m: you need not draw anything
 * farther away. It uses the law's measure of distance, and is infinite if the law never reaches that.
 * Thread: any.
 */
WK_API
wk_status wk_fog_law_cull_distance(const wk_fog_law *fog_law,
                                   double *out_distance_m);

/**
 * Gets the distance beyond which air of a visibility (meteorological optical range, m, [1, 1e6]) leaves less than
 * 1/255 of an object's contrast, m: about 1.85 times the visibility.
 * Thread: any.
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
 * The weather as physical quantities, at any place and any past or future time that the timeline still knows. The
 * answers are in closed form and need no device. Heights are above the station unless stated otherwise. Every number
 * is continuous in time while the weather changes, including the geometry of a layer that comes or goes.
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
    /** Total extinction at 550 nm, 1/m: air, particles and fog at station height, and what falls at the position. */
    double extinction_per_m;
    /** Meteorological optical range of that extinction, m; at most 1e9, as without any air. */
    double visibility_m;
    /** Air temperature at 2 m, degrees Celsius. */
    double temperature_c;
    /** Fraction. */
    double relative_humidity;
    /** Pressure reduced to sea level, hPa. */
    double pressure_hpa;
    /** Pressure at the station, hPa. */
    double station_pressure_hpa;
    /** Station above mean sea level, m. */
    double station_altitude_m;
    /** Air density at sea level over that at 15 C and 1013.25 hPa. */
    double rayleigh_density_ratio;
    /** Scale height of the air: density falls by 1/e over it, m. */
    double rayleigh_scale_height_m;
    /** Extinction by air, at 550 nm and station height, 1/m. */
    double rayleigh_extinction_per_m;
    /** Extinction by particles, at 550 nm and station height, 1/m. */
    double aerosol_extinction_per_m;
    /** Exponent of the particles' extinction: (wavelength / 550 nm)^-exponent. */
    double aerosol_angstrom_exponent;
    /** At 550 nm. */
    double aerosol_single_scattering_albedo;
    /** Mean cosine of the phase function. */
    double aerosol_asymmetry;
    /** Scale height of the particles: density falls by 1/e over it, m. */
    double aerosol_scale_height_m;
    /** Extinction inside the layer at the ground, at 550 nm, 1/m; 0 if there is none. */
    double fog_extinction_per_m;
    /** Base of the layer, m. */
    double fog_base_m;
    /** Top of the layer, m. */
    double fog_top_m;
    /** Depth of its soft upper edge, m. */
    double fog_softness_m;
    /** Fraction of the ground that the layer covers. */
    double fog_coverage;
    /**
     * Fraction of the sky hidden by all layers together. During a change it stays between the values at both ends.
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
    /** How convective it is: 0 steady, 1 showers. */
    double showers;
    /** Whether there is thunder: 0 to 1. */
    double thunder;
    /** Extinction by all precipitation, at 550 nm, 1/m. */
    double precipitation_extinction_per_m;
    /** Velocity at 10 m towards the east, m/s. */
    double wind_east_m_s;
    /** Velocity at 10 m towards the north, m/s. */
    double wind_north_m_s;
    /** Highest 3-second gust at 10 m, m/s. */
    double wind_gust_m_s;
    /** Standard deviation of speed over its mean, at 10 m. */
    double wind_turbulence_intensity;
    /** Half the range over which the direction wanders, degrees: 0 steady, 180 all round. */
    double wind_wander_deg;
    /** Roughness length of the land, m. */
    double roughness_length_m;
    /** Roughness length of the sea, m. */
    double sea_roughness_length_m;
    /** Significant wave height of the wind sea, m. */
    double significant_wave_height_m;
    /** Height of the swell, m; 0 without swell. */
    double swell_height_m;
    /** Its peak period, s. */
    double swell_period_s;
    /** Its direction of travel: east component of the unit vector. */
    double swell_east;
    /** Its direction of travel: north component of the unit vector. */
    double swell_north;
    /** Water, degrees Celsius. */
    double sea_temperature_c;
    /** Wetness of the ground: 0 dry, 0.3 damp, 1 under a closed film. */
    double wetness;
    /** Fraction of the ground under standing water. */
    double puddles;
    /** Fraction of the ground under ice or frost. */
    double ice;
    /** Lying snow, m. */
    double snow_depth_m;
    /** Ozone column, Dobson units. */
    double ozone_du;
    /** Part of snow_mm_h that falls as flakes, mm/h of melted water; 0 where none falls. */
    double snow_flakes_mm_h;
    /** Part of snow_mm_h that falls as snow grains, mm/h of melted water; 0 where none falls. */
    double snow_grains_mm_h;
    /** Part of snow_mm_h that falls as ice crystals, mm/h of melted water; 0 where none falls. */
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

/** A horizontally mixed layer of cloud; plain values of a list. */
typedef struct wk_cloud_slab {
    /** Fraction of the sky covered. */
    double cover;
    /** Base, m. */
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
 * Gets the conditions at a position and a past or future simulation time. What falls is what falls at the position
 * itself: that of the rain areas there (wk_context_set_rain_areas), mixed by their rims, and nothing above the cloud
 * that it falls from. rain_mm_h and drizzle_mm_h add up to rate_mm_h of wk_context_get_rainfall_at.
 * precipitation_extinction_per_m, extinction_per_m and visibility_m go with what falls there. All other fields are the
 * weather's, the same everywhere, at the station's height unless they say otherwise.
 * Thread: concurrent.
 * Errors: WK_ERROR_INVALID_ARGUMENT for an invalid position, and for a time that the timeline has forgotten: before
 * the end of the last change that was over at the last update.
 */
WK_API
wk_status wk_context_get_conditions(const wk_context *context,
                                    const double (*position_m)[3],
                                    double time_s,
                                    wk_conditions *out_conditions);

/**
 * Gets the cloud layers at a position and time, low ones first; position and time as in wk_context_get_conditions.
 * `*out_count` gets their number, at most 16, even if `capacity` is too small (then nothing else is written and the
 * call fails) or 0 (then it succeeds). `slab_size` is sizeof(wk_cloud_slab) of your header.
 * Thread: concurrent.
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
 * These answer at any place of the host's world, for the present or (functions that end in _at) for any past or future
 * simulation time that the timeline still knows. The answers are in closed form and need no device. A sun or moon that
 * the host has placed stands there at all times. Only wk_context_get_ambient and wk_context_get_ambient_at read the
 * sky's tables. Directions are unit vectors (east, north, up) at the place asked for. Light is in lux and cd/m^2,
 * three channels of linear Rec. 709 whose luminance-weighted sum (0.2126, 0.7152, 0.0722) is the photometric value.
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
    /** Direction towards it, without refraction, as scattering uses it. */
    double direction[3];
    /** Direction towards it as it appears, lifted by refraction. */
    double apparent[3];
    /** Direction in the disc's plane towards the middle of the lit limb (moon). */
    double bright_limb[3];
    /** Illuminance above the air on a surface facing it, lux a channel. */
    double illuminance_lux[3];
    /** Degrees clockwise from true north, [0, 360). */
    double azimuth_deg;
    /** Degrees above the horizon, without refraction. */
    double elevation_deg;
    /** Degrees above the horizon as it appears. */
    double apparent_elevation_deg;
    /** Angular radius, rad. */
    double angular_radius;
    /** Lit fraction of the face. */
    double lit;
    /** Vertical over horizontal diameter of the disc. */
    double flattening;
    /** Share of its direct light that clouds above the place let through, on the mean over places at its height. */
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
 * Light that arrives at a place, after air, clouds and fog; plain values of a list. Light scattered forward once by
 * fog counts as the sun's or the moon's.
 */
typedef struct wk_ground_light {
    /** Direct sun on a surface facing it, lux a channel. */
    double sun_lux[3];
    /** Direct moon on a surface facing it, lux a channel. */
    double moon_lux[3];
    /** Sky, clouds and fog on level ground, lux a channel. */
    double sky_lux[3];
    /** Everything on level ground, luminance-weighted, lux. */
    double total_lux;
} wk_ground_light;

/** Two points of the host's world, m; plain values of a list. */
typedef struct wk_segment {
    /** Position of the eye. */
    double from_m[3];
    /** Position of the object, at least a millimetre away. */
    double to_m[3];
} wk_segment;

/** Transmittance and visibility between two points; plain values of a list. */
typedef struct wk_between {
    /**
     * Share of light that gets through, per channel (wavelengths of the planet, 620, 550 and 450 nm for the Earth).
     */
    double transmittance[3];
    /**
     * Meteorological optical range along the segment, m: the distance at which 550 nm light would fall to 5 % if the
     * air were everywhere as on this segment. Infinite if nothing stops light.
     */
    double visibility_m;
} wk_between;

/** The sky's light on surfaces of any slope. */
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
 * Gets the light that arrives at places of the host's world now, at most wk_caps.max_batch of them. Clouds count by
 * what of them lies above a place, as the mean over places at its height. `position_size` and `light_size` are the
 * bytes from one element to the next: 24 or more, and sizeof(wk_ground_light) of your header. Thread: concurrent.
 */
WK_API
wk_status wk_context_get_light(const wk_context *context,
                               const double (*positions_m)[3],
                               uint32_t count,
                               uint32_t position_size,
                               wk_ground_light *lights,
                               uint32_t light_size);

/**
 * As wk_context_get_light, at a simulation time.
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
 * Gets transmittance and visibility between pairs of points now, at most wk_caps.max_batch of them. Air, haze, fog,
 * precipitation and clouds drawn as a volume count, a deck and the host's objects do not. `segment_size` and
 * `between_size` are the sizes of an element in your header. Thread: concurrent.
 */
WK_API
wk_status wk_context_get_between(const wk_context *context,
                                 const wk_segment *segments,
                                 uint32_t count,
                                 uint32_t segment_size,
                                 wk_between *between,
                                 uint32_t between_size);

/**
 * As wk_context_get_between, at a simulation time.
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
 * Gets the slant visual range from a place at a simulation time, m: how far a black object is seen along a direction,
 * a vector (east, north, up) at the place, of length 1 within 0.001. There the air, fog, rain, snow and clouds drawn
 * as a volume before it leave 5 % of the light of 550 nm, and so 5 % of its contrast. Infinite where more is left at
 * the end of the air or on the planet's ground. Thread: concurrent. Errors: as wk_context_get_conditions;
 * WK_ERROR_INVALID_ARGUMENT naming the direction.
 */
WK_API
wk_status wk_context_get_visibility_at(const wk_context *context,
                                       const double (*position_m)[3],
                                       const double (*direction)[3],
                                       double time_s,
                                       double *out_visibility_m);

/**
 * Gets the sky's light on surfaces of any slope at a place. It reads the sky's tables: it builds them if no frame has
 * done so yet, and waits for the GPU once after every change of the air.
 * Thread: as wk_view_record.
 * Errors: WK_ERROR_INVALID_ARGUMENT naming the position.
 */
WK_API
wk_status wk_context_get_ambient(wk_context *context,
                                 const double (*position_m)[3],
                                 wk_ambient *out_ambient);

/**
 * As wk_context_get_ambient, at a simulation time. The clear sky's pattern is that of the air that the tables show;
 * how bright all of it is, and clouds and fog, are those of `time_s`. Thread: as wk_view_record. Errors: as
 * wk_context_get_ambient and wk_context_get_conditions.
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
 * For sensors, reflections and lighting that the host computes itself: how bright the sky is towards a direction, as
 * the picture shows it where the host drew nothing. It has the clear air, clouds as the model draws them, fog with
 * what falls in it, the night's glow, and below the horizon the planet's own ground. It has no discs of sun and moon
 * (wk_context_get_light has their light), no stars and planets, no rain areas, and nothing that the host drew.
 *
 * The double-precision reference of the sky answers on the calling thread; no device is asked. The first question in a
 * new air solves the reference (a second or two; weather in transition is a new air at every time), and other threads
 * that ask meanwhile wait. The last four airs are kept for all contexts of a device. docs/reflections.md has what a
 * direction costs and how far pictures may be off.
 * ====================================================================================================
 */

/** The sky's light from one direction; plain values of a list. */
typedef struct wk_sky_radiance {
    /** cd/m^2, three channels of linear Rec. 709, none below 0. */
    double radiance_cd_m2[3];
} wk_sky_radiance;

/**
 * Gets the sky's radiance at a place towards directions now, at most wk_caps.max_batch of them. A direction is a
 * vector (east, north, up) at the place, of length 1 within 0.001. `direction_size` and `radiance_size` are the bytes
 * from one element to the next: 24 or more, and sizeof(wk_sky_radiance) of your header. Thread: concurrent. Errors:
 * WK_ERROR_INVALID_ARGUMENT naming the position or the first wrong direction; nothing is written then.
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
 * As wk_context_get_sky_radiance, at a simulation time.
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
 * How the air moves and how far it has moved, what falls through it, and what lands on a surface, at any place and any
 * simulation time that the timeline still knows. The answers are in closed form and need no device. Vectors are (east,
 * north, up) at the place. Only wk_context_get_rain_on_at knows shelters.
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
    /** Velocity of the air at this moment, gusts included, m/s. */
    double velocity_m_s[3];
    /** Mean velocity, without gusts, m/s. */
    double mean_m_s[3];
    /**
     * Displacement of the air at 10 m since simulation time 0, gusts included, m; the same at every place. Move what
     * the air carries by differences of this, never by velocity times time: it is continuous whatever the weather
     * does, and the same to the last bit on every channel.
     */
    double displacement_m[3];
    /** Standard deviation of gusts along the mean wind, m/s. */
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

/** Precipitation at a place and time: rain and drizzle, hail and ice pellets; all 0 if nothing falls. */
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
     * Drops of 0.1 to 6 mm in the air, 1/m^3 (Marshall and Palmer 1948; showers and drizzle Joss et al. 1968; scaled
     * so that they give the rate).
     */
    double number_per_m3;
    /** Water in the air, g/m^3. */
    double liquid_g_m3;
    /** Extinction by the drops, 1/m. */
    double extinction_per_m;
    /** Mean diameter of the drops in the air, mm. */
    double mean_diameter_mm;
    /** Median volume diameter, mm: half of the water in the air is in smaller drops. */
    double median_volume_diameter_mm;
    /** Drops that land on level ground, 1/(m^2 s). */
    double drops_per_m2_s;
    /**
     * Velocity of the median drop of the falling water, m/s: half of the water falls steeper, the other half flatter.
     * Draw occluder maps along its direction. It falls at Gunn and Kinzer's (1949) speed and moves with the wind at 10
     * m.
     */
    double fall_velocity_m_s[3];
    /** Hail, small hail and ice pellets on level ground, mm/h of melted water. */
    double ice_mm_h;
    /**
     * Stones in the air, 1/m^3: hail of 5 to 60 mm (Cheng and English 1983), pellets of 0.5 to 5 mm, which are frozen
     * raindrops.
     */
    double stones_per_m3;
    /** Extinction by the stones, 1/m. */
    double stone_extinction_per_m;
    /** Mean diameter of the stones in the air, mm. */
    double stone_diameter_mm;
    /** Stones that land on level ground, 1/(m^2 s). */
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

/** A surface that rain lands on, or an opening that it falls through; plain values of a list. */
typedef struct wk_rain_surface {
    /** Position in the host's world, m. */
    double position_m[3];
    /** Normal of its wet side, (east, north, up) of the place; of any length but 0. */
    double normal[3];
    /** Its velocity, m/s (east, north, up). Range [-1000, 1000] each. */
    double velocity_m_s[3];
    /** Its area, m^2. Range [0, 1e6]. */
    double area_m2;
} wk_rain_surface;

/** Rain on a surface; plain values of a list. */
typedef struct wk_rain_on {
    /** Water, mm/h, which is litres for each square metre and hour. */
    double rate_mm_h;
    /** Drops of 0.1 to 6 mm on the whole surface, 1/s. */
    double drops_per_s;
} wk_rain_on;

/**
 * Gets the wind at a place of the host's world and a simulation time. The mean follows the logarithmic profile over
 * the ground's roughness up to 100 m, and above grows and veers to the geostrophic wind (docs/clouds.md). Gusts have
 * Kaimal's spectrum (1972, as in IEC 61400-1) and are the same all over the world. Heights count from the station's
 * altitude above mean sea level, and reported wind holds 10 m above it. A host with terrain asks at the station's
 * altitude plus the height above its own ground. At and below the roughness length there is no wind. Thread:
 * concurrent. Errors: as wk_context_get_conditions.
 */
WK_API
wk_status wk_context_get_wind_at(const wk_context *context,
                                 const double (*position_m)[3],
                                 double time_s,
                                 wk_wind *out_wind);

/**
 * Gets what falls at a place of the host's world and a simulation time. What falls begins in the lower half of the
 * clouds, at most 500 m above their bases, averaged over what covers the sky; above that nothing falls. Thread:
 * concurrent. Errors: as wk_context_get_conditions.
 */
WK_API
wk_status wk_context_get_rainfall_at(const wk_context *context,
                                     const double (*position_m)[3],
                                     double time_s,
                                     wk_rainfall *out_rainfall);

/**
 * Gets what lands on surfaces at a simulation time, at most wk_caps.max_batch of them. Every size of drop comes along
 * its own slant, in the wind at 10 m with its gusts and in the wind that the surface makes by moving. A windscreen at
 * 25 m/s meets far more than the ground. Boxes (wk_context_set_shelters) keep rain off where they shelter a point 5 cm
 * before the surface; occluder maps do not count. `surface_size` and `on_size` are sizeof(wk_rain_surface) and
 * sizeof(wk_rain_on) of your header. If one surface is wrong, nothing is written.
 * Thread: concurrent.
 * Errors: as wk_context_get_conditions; the field of a surface by name and range.
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
 * works: perspective, off-axis, one eye of a stereo pair, orthographic, infinite far, reversed depth.
 *
 * Welkin reads depth as the projection gives it, z / w mapped to the depth buffer's 0 to 1. With WK_DEPTH_LOGARITHMIC
 * the host's shaders must have written ln(C w + 1) / ln(C far + 1) instead. Pixels at the far depth show the sky.
 *
 * `target` points to the images, in the struct for the kind of device: wk_own_target, wk_opengl_target,
 * wk_vulkan_target.
 * ====================================================================================================
 */

/** Relation of depth to distance. */
typedef uint32_t wk_depth_kind;

/** As the projection matrix says: perspective (finite or infinite far) or orthographic. */
#define WK_DEPTH_PROJECTION 0
/** ln(C w + 1) / ln(C far + 1) with w = clip w, written by the host's shaders. */
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
 * yet, this frame builds them, which takes as long as many frames: use it for stills and comparisons, not for every
 * frame of a changing weather.
 */
#define WK_FRAME_NO_HISTORY 2
/** Depth is reversed: 1 is near, 0 is far. */
#define WK_FRAME_DEPTH_REVERSED 4
/**
 * The first row of the images lies at clip y = -1: always so in OpenGL (there it need not be set), and in Vulkan with
 * a viewport of positive height. Without it the first row lies at clip y = +1.
 */
#define WK_FRAME_FIRST_ROW_AT_MINUS_Y 8
/**
 * Measure what each effect costs: wk_report.ms, wk_view_get_costs. Welkin draws stages one by one and waits for each,
 * so the frame is slower and its picture may differ by rounding. Use it now and then, not in every frame.
 * WK_ERROR_UNSUPPORTED on a Vulkan host, whose images are lent for one submission.
 */
#define WK_FRAME_MEASURE 16
/**
 * The target's normals are in the camera's axes (x right, y up, z towards the viewer: gl_NormalMatrix * gl_Normal),
 * not in those of the host's world.
 */
#define WK_FRAME_NORMALS_IN_EYE_SPACE 32

/** Meaning of the numbers in the host's colour. */
typedef uint32_t wk_color_space;

/**
 * Linear Rec. 709, proportional to luminance (cd_m2_per_unit). The only space in which WK_STAGE_TONE does anything.
 */
#define WK_COLOR_SCENE_LINEAR 0
/** Already tone-mapped, linear Rec. 709 in [0, 1]. Welkin tone-maps its own light and composites linearly. */
#define WK_COLOR_DISPLAY_LINEAR 1
/** Already tone-mapped and encoded by the sRGB curve, or in an sRGB format in which the hardware encodes. */
#define WK_COLOR_DISPLAY_SRGB 2

/**
 * Access of Welkin to the target's depth. Nothing that this version draws is opaque, so both give the same picture;
 * sea and terrain will be.
 */
typedef uint32_t wk_depth_access;

/** Read it: not a bit of it changes, and Welkin draws nothing opaque of its own. */
#define WK_DEPTH_ACCESS_READ 0
/**
 * Test and write it where Welkin draws opaque things (stage SURFACE, before the water on surfaces); stencil stays.
 * Needs depth that can be attached: a depth format, as many samples as the colour, and in Vulkan
 * DEPTH_STENCIL_ATTACHMENT among its usage. Not with WK_OPENGL_MULTISAMPLE_RESOLVE of several samples, and not on an
 * own device, whose depth is WK_FORMAT_R32_FLOAT.
 */
#define WK_DEPTH_ACCESS_READ_WRITE 1

/**
 * A false-colour picture in place of a frame's, for developers: one number of each pixel on a scale from black over
 * blue, green, yellow and red to white. The call with the number's stage draws it; other calls of the frame draw
 * nothing. Masked pixels stay yours. Where nothing of what it shows is in the frame, all is black.
 */
typedef uint32_t wk_diagnostic;

/** The picture itself. */
#define WK_DIAGNOSTIC_NONE 0
/** Distance along the ray, by decades: black 1 m or less, white 100 km and more, and the sky. Stage MEDIUM. */
#define WK_DIAGNOSTIC_DISTANCE 1
/**
 * Optical depth of air, fog and what falls between the eye and what is seen: black 0, 1 a step, white 5 and more. The
 * columns of rain areas are left out. Stage MEDIUM.
 */
#define WK_DIAGNOSTIC_OPTICAL_DEPTH 2
/** Share of a surface under a film, standing water or clear ice: black 0, 0.2 a step, white 1. Stage SURFACE. */
#define WK_DIAGNOSTIC_WETNESS 3
/**
 * Error by what the plan leaves out of air, fog and clear sky: relative change of luminance over a hundredth of white,
 * by decades: black 1e-4 or less, white 10 and more. Drops and stars are not counted. Stage MEDIUM.
 */
#define WK_DIAGNOSTIC_PLAN_ERROR 4
/**
 * How often what falls was drawn over a pixel: black never, 4 times a step, white 20 times and more. Stage PARTICLES.
 */
#define WK_DIAGNOSTIC_OVERDRAW 5
/**
 * The wind that carries what falls, 2 m over what you drew: black a calm, 4 m/s a step, white 20 m/s and more. Each
 * square of the ground has an arrow along the wind, or a dot where it is slower than 0.3 m/s. The sky is black. Stage
 * MEDIUM.
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
    /** World to eye; only its rotation counts. Default identity. */
    double view[16];
    /** Eye to clip, invertible. Default identity. */
    double projection[16];
    /** Default WK_DEPTH_PROJECTION. */
    wk_depth_kind depth_kind;
    /** Default WK_CLIP_ZERO_TO_ONE. */
    wk_clip_space clip_space;
    /** C of logarithmic depth, 1/m. Range [1e-9, 1e6] where depth_kind is LOGARITHMIC. Default 1. */
    double logarithmic_c;
    /**
     * Distance at depth 1 of logarithmic depth, m. Range [1e-3, 1e12] where depth_kind is LOGARITHMIC. Default 1e7.
     */
    double logarithmic_far_m;
    /** Default 0. */
    wk_frame_flags flags;
    /** Default WK_COLOR_SCENE_LINEAR. */
    wk_color_space color_space;
    /** Luminance of the value 1 in a scene-linear colour image, cd/m^2. Range [1e-9, 1e9], default 1. */
    double cd_m2_per_unit;
    /** Default WK_EXPOSURE_OF_CONTEXT. */
    wk_exposure_mode exposure_mode;
    /** Must be 0. */
    uint32_t reserved0;
    /** See wk_exposure_mode. Default 0. */
    double exposure_value;
    /**
     * The images: a wk_own_target, wk_opengl_target or wk_vulkan_target, by the kind of device. May be NULL for
     * PREPARE alone.
     */
    const void *target;
    /**
     * Velocity of the camera in the host's world, m/s, at most 2000 in all. Streaks of rain lean against it. Default
     * 0, 0, 0.
     */
    double velocity_m_s[3];
    /** Default WK_DEPTH_ACCESS_READ. */
    wk_depth_access depth_access;
    /** Default WK_DIAGNOSTIC_NONE. */
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
 * Light for the host's own shading of a frame, in the numbers of its color_space. A surface of colour c with normal n
 * shows c * (ambient + direct * max(dot(n, direction), 0)).
 *
 * Scene-linear: exact for matt surfaces. Display spaces: the light includes the tone curve at the frame's exposure, so
 * one pair of lights cannot be right for every surface. It is right for a grey card of 18 %, in shade and facing the
 * sun. With WK_COLOR_DISPLAY_LINEAR c is linear, and the host (or its sRGB framebuffer) encodes the result. With
 * WK_COLOR_DISPLAY_SRGB both are encoded numbers, as fixed-function OpenGL multiplies them.
 */
typedef struct wk_frame_light {
    /** sizeof(wk_frame_light) of your header. */
    uint32_t struct_size;
    /** WK_STRUCT_TYPE_FRAME_LIGHT. */
    wk_struct_type struct_type;
    /** No extensions in this version: NULL. */
    const void *next;
    /** Unit vector in the host's world towards the sun, or towards the moon where that is brighter. */
    double direction[3];
    /** Its direct light on a surface that faces it, after air, clouds and fog; 0 below the horizon. */
    double direct[3];
    /** Light of sky, clouds and fog on level ground. */
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
    /** The image to draw into. Default NULL. */
    const wk_texture *color;
    /** If `color` is NULL: the surface whose acquired image is drawn into. Default NULL. */
    const wk_surface *surface;
    /** The host's depth, as large as `color`; NULL (the default) shows the sky in every pixel. */
    const wk_texture *depth;
    /**
     * A mask: where it is 1, the host's pixel stays (cab, HUD); where it is 0, Welkin draws weather. As large as
     * `color`. Default NULL.
     */
    const wk_texture *mask;
    /**
     * Each pixel's surface class: the byte of red is a wk_surface_class, or 0 to use wk_ground_grid or the context's
     * default. R8_UNORM or the like, as large as `color`. Default NULL.
     */
    const wk_texture *surface_classes;
    /**
     * Unit normals, in the host's world or in eye space (WK_FRAME_NORMALS_IN_EYE_SPACE): (n + 1) / 2 in normalised
     * formats, n in float formats. Where a pixel is no unit vector (a cleared pixel), Welkin uses the host's terrain
     * or depth. As large as `color`. Default NULL.
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
 * Gets the light with which the host should light its own objects in a frame; call it before you draw them. Of `frame`
 * the camera's position, the color_space with cd_m2_per_unit, and the exposure count; its target is ignored.
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
 *   SURFACE     water on surfaces: darker, with the sky in it; after the opaque things, needs depth, free where it is dry
 *   MEDIUM      fog and aerial perspective on all that was drawn so far
 *   PARTICLES   what falls and flies
 *   LENS        water on the windscreen
 *   TONE        exposure, tone curve, encoding and dither of a scene-linear picture; nothing in the display colour spaces
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
/** Sky behind everything: pixels at the far depth, or all pixels without depth. */
#define WK_STAGE_BACKGROUND 2
/** Water on surfaces; after the host's opaque objects. */
#define WK_STAGE_SURFACE 4
/** Fog and aerial perspective on everything that the host has drawn. */
#define WK_STAGE_MEDIUM 8
/** Particles that fall and fly. */
#define WK_STAGE_PARTICLES 16
/** Water on the windscreen. */
#define WK_STAGE_LENS 32
/**
 * Exposure, tone curve, encoding and dither of a scene-linear picture: float targets and sRGB formats get
 * display-linear values, other formats get sRGB-encoded ones. With WK_COLOR_DISPLAY_LINEAR and WK_COLOR_DISPLAY_SRGB
 * the host has done all that, and TONE does nothing, alone or with other stages.
 */
#define WK_STAGE_TONE 64
/** Everything in one call. */
#define WK_STAGE_ALL 127

/** Flags of a report's optional fields that are set. */
typedef uint32_t wk_report_flags;

/** wk_report.ms. */
#define WK_REPORT_HAS_MS 1
/** wk_report.predicted_ms: the view has a budget, its picture was gauged and a time was reported. */
#define WK_REPORT_HAS_PREDICTED_MS 2
/** wk_report.reported_ms: wk_view_report_time was called since the frame. */
#define WK_REPORT_HAS_REPORTED_MS 4
/** wk_report.predicted_error and predicted_error_bound: the view has a budget and its picture was gauged. */
#define WK_REPORT_HAS_PREDICTED_ERROR 8
/** wk_report.checked_error_bound and checked_error: it was gauged again since. */
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
    /** Full-screen draws recorded for this frame so far. */
    uint32_t passes;
    /**
     * Tables built, refined or faded for this frame so far; 0 when only the camera turned and the sky has its final
     * quality.
     */
    uint32_t tables_rebuilt;
    /** Display units per cd/m^2 that were applied; 0 if nothing was drawn. */
    double exposure;
    /** Bytes of GPU memory that the view holds for itself. */
    uint64_t bytes;
    /** Flags of the following fields that are set. */
    wk_report_flags has;
    /** 0. */
    uint32_t reserved0;
    /**
     * Time of the frame's calls so far, including the wait for the GPU, ms. Set if the frame was measured
     * (WK_FRAME_MEASURE).
     */
    double ms;
    /** Predicted time of the weather in this frame, ms, from the times reported before it. */
    double predicted_ms;
    /** Time that the host reported for it, ms. */
    double reported_ms;
    /**
     * Estimated error of what this frame left out, without parts that still fade: 95th percentile over the gauged
     * pixels.
     */
    double predicted_error;
    /** Upper end of the 95 % confidence interval of that percentile over all pixels. */
    double predicted_error_bound;
    /** For the newest gauge's picture: the bound predicted for what it left out ... */
    double checked_error_bound;
    /** ... and the error that was found. */
    double checked_error;
    /** Drops and stones around the camera; those in the picture were drawn. */
    uint32_t drops;
    /** Flakes around the camera; those in the picture were drawn. 0 if none were. */
    uint32_t flakes;
    /** Number of drops that each drawn drop stood for: 1 unless more fell than wk_rain.most_drops; 0 without any. */
    double drop_weight;
    /** Splashes, 1/(m^2 s) on level ground, that were left out for lack of room: those of the smallest drops. */
    double splashes_left_out_per_m2_s;
    /** Stones, 1/(m^2 s), that did not bounce for lack of room: the smallest ones. */
    double stones_left_out_per_m2_s;
    /**
     * The contrast gain that rain was drawn with (wk_rain.contrast_gain): 1 is as in nature; 0 if none was drawn.
     */
    double contrast_gain;
    /** Distance up to which flakes were drawn, m; farther snow is extinction alone. 0 if none were. */
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

/** Tables over the planet: built when the air changes. */
#define WK_EFFECT_SKY_TABLES 0
/** The sky and the air as seen from the camera's height: built when height, sun or air change. */
#define WK_EFFECT_SKY_VIEW 1
/** Sky behind everything. */
#define WK_EFFECT_BACKGROUND 2
/** Fog and aerial perspective. */
#define WK_EFFECT_MEDIUM 3
/** Exposure, tone curve, encoding. */
#define WK_EFFECT_TONE 4
/** Stages in one draw, where the target's format does not allow separate draws. */
#define WK_EFFECT_COMPOSITION 5
/** Textures for the host's own shaders. */
#define WK_EFFECT_VEIL 6
/** Taking the host's context and images, and giving them back. */
#define WK_EFFECT_HAND_OVER 7
/** Rain. */
#define WK_EFFECT_PARTICLES 8
/** Water on surfaces. */
#define WK_EFFECT_SURFACE 9
/** Water on the windscreen: its steps (after the sky's tables) and the lens. */
#define WK_EFFECT_WINDSCREEN 10

/** Cost of one effect in a frame; plain values of a list. */
typedef struct wk_effect_cost {
    /** Effect whose cost this is. */
    wk_effect effect;
    /** 0. */
    uint32_t reserved0;
    /** Its name in English; lives as long as the library. */
    const char *name;
    /** Wall time around a submission that is waited for, the CPU's part included, ms. 0 if it did not run. */
    double ms;
} wk_effect_cost;

/**
 * Makes a view of a context. `desc` NULL means WK_VIEW_DESC_INIT. On success `*out_view` is a new handle for
 * `wk_view_destroy`.
 * Thread: exclusive on the context.
 */
WK_API wk_status wk_view_create(wk_context *context, const wk_view_desc *desc, wk_view **out_view);

/**
 * Destroys a view. NULL does nothing.
 * Thread: any; the GPU's part is released at the device's next call if it must be.
 */
WK_API wk_status wk_view_destroy(wk_view *view);

/**
 * Records the stages of a frame and submits them. `stages` is a union of WK_STAGE_ constants, not empty. Welkin checks
 * the frame before any work: after an error nothing is drawn, built or changed.
 * Thread: exclusive on the view; views of one context may record from several threads while none updates the context.
 * Errors: WK_ERROR_WRONG_ORDER if a stage comes twice or late; WK_ERROR_UNSUPPORTED and WK_ERROR_INVALID_ARGUMENT
 * naming the field; WK_ERROR_DEVICE_LOST.
 */
WK_API
wk_status wk_view_record(wk_view *view,
                         const wk_frame *frame,
                         wk_stage_flags stages);

/**
 * Gets costs and contents of the view's last frame.
 * Thread: exclusive on the view.
 */
WK_API wk_status wk_view_get_report(wk_view *view, wk_report *out_report);

/**
 * Gets the cost of each effect of the view's last frame, in the order in which they happen. `*out_count` gets their
 * number, 0 if the frame was not measured (WK_FRAME_MEASURE), even if `capacity` is too small (then nothing else is
 * written and the call fails) or 0 (then it succeeds). `cost_size` is sizeof(wk_effect_cost) of your header. Later
 * versions may know more effects.
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
 * Glass, lamps and smoke that the host draws after MEDIUM lie in the same air. Their shaders sample the frame's veil:
 * the light that air, fog and rain add on the way to a point, and the share of the light behind it that gets through.
 * The published sampling functions, GLSL and WGSL, map clip coordinates and distance to texels.
 * ====================================================================================================
 */

/** The veil of the view's last frame: air, clouds drawn as a volume, fog, the weather's rain, and rain areas. */
typedef struct wk_frame_textures {
    /** sizeof(wk_frame_textures) of your header. */
    uint32_t struct_size;
    /** WK_STRUCT_TYPE_FRAME_TEXTURES. */
    wk_struct_type struct_type;
    /** No extensions in this version: NULL. */
    const void *next;
    /** Light that air and fog add, RGB half floats: an OpenGL texture name (GL_TEXTURE_2D) or a VkImage. */
    uint64_t light;
    /** Share of the light behind that gets through, RGB half floats: as `light`. */
    uint64_t through;
    /** Pixels of both. */
    uint32_t width;
    /** Pixels of both. */
    uint32_t height;
    /** Multiply `light` by this to get units of the host's colour. */
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
 * between wk_view_record calls with MEDIUM. Call this after each frame for its light_scale.
 * Thread: exclusive on the view.
 * Errors: WK_ERROR_UNSUPPORTED on an own device, which has no shaders of the host's.
 */
WK_API wk_status wk_view_get_frame_textures(wk_view *view, wk_frame_textures *out_textures);

/**
 * Gets the text of the sampling functions: NUL-terminated UTF-8 that lives as long as the process.
 * Thread: any.
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
 * For reflections in the host's own things: paint, water, windows. Six faces of 64 x 64 texels show the sky with its
 * clouds, fog and rain as far as the horizon, and the planet's ground below, without the discs of sun and moon (the
 * host lights by those itself), stars and the host's objects; the night's glow is even. Its axes are those of the
 * host's world: a shader looks it up by the reflected direction as it is. Level m of the 7 is what a mirror of
 * roughness m/6 shows (the distribution of Trowbridge and Reitz, alpha = roughness^2; Karis 2013, Real Shading in
 * Unreal Engine 4), so textureLod(cube, reflected, 6 * roughness) is the specular light before the surface's
 * reflectance. OpenGL hosts enable GL_TEXTURE_CUBE_MAP_SEAMLESS and set their filters by a sampler object. Welkin
 * draws one face a frame, in turn; all six in the first frame, in frames with WK_FRAME_CUT or WK_FRAME_NO_HISTORY, and
 * where light or weather leap. Views whose hosts do not ask have none of it.
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
    /** Texels of a face's edge. */
    uint32_t size;
    /** Levels, down to one texel. */
    uint32_t level_count;
    /**
     * Multiply texels by this to get cd/m^2; 0 before the first frame. It changes only where all faces are drawn.
     */
    double cd_m2_per_unit;
    /**
     * Multiply texels by this to get units of the last frame's colour of a scene-linear host, else display values
     * before the tone curve.
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
 * Gets the native texture of the cube map. From the first call on, the first call of each frame with
 * WK_STAGE_BACKGROUND or WK_STAGE_MEDIUM draws what is due of it. It belongs to the view and stays the same until that
 * is destroyed. In Vulkan it is in VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL after each such wk_view_record call. Call
 * this after each frame for its scales. Thread: exclusive on the view. Errors: WK_ERROR_UNSUPPORTED on an own device,
 * which has no shaders of the host's.
 */
WK_API
wk_status wk_view_get_environment(wk_view *view,
                                  wk_environment *out_environment);

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
 * With a tolerance, a view gauges its own pictures. In every eighth frame it composes a grid of 64 x 36 of its pixels
 * with everything and without each part of the weather, and reads the differences back some frames later without
 * waiting. Parts that change the picture by less than the tolerance fade out, and fade in again when they matter.
 * Under a budget of time, parts also fade out as the reported times demand, starting with those whose loss is
 * perceived least for the time that they save. They come back when there is time again. After a jump of camera, sun or
 * weather, and in frames with WK_FRAME_CUT or WK_FRAME_NO_HISTORY, everything is drawn.
 *
 * A part has a number (WK_PART_), a name and rungs. Rung 0 is all of it; the last is nothing of it, or the cheapest
 * that stands for it. Later versions have more parts, at the end: wk_plan.part_count says how many,
 * wk_view_get_part_plan what they are called.
 *
 * Error means the same everywhere in Welkin: |Y' - Y| / (Y + 0.01 white) of luminances after exposure, its 95th
 * percentile over the picture's pixels. A tolerance also bounds the worst pixel, by ten times as much.
 *
 * Leaving parts out changes no simulation: time, weather and state stay the same on all channels of a simulator.
 * Channels that must also leave out the same parts pin their plan: by hand (WK_PART_WISH_HAS_RUNG), or with one
 * that another view found (wk_view_save_plan, wk_view_load_plan).
 * ====================================================================================================
 */

/** Flags of the optional fields of a wk_budget that are set. */
typedef uint32_t wk_budget_has_flags;

/** tolerance */
#define WK_BUDGET_HAS_TOLERANCE 1
/** milliseconds */
#define WK_BUDGET_HAS_MILLISECONDS 2

/** Flags of the optional fields of a wk_part_wish that are set. */
typedef uint32_t wk_part_wish_has_flags;

/** importance */
#define WK_PART_WISH_HAS_IMPORTANCE 1
/** rung */
#define WK_PART_WISH_HAS_RUNG 2

/** A part of the weather that a picture may do with less of, by its number. */
typedef uint32_t wk_part;

/** Air and haze between the camera and what the host drew. Rungs: all, none. */
#define WK_PART_AIR 0
/** Fog, mist, dust and what falls, as a layer. Rungs: all, none. */
#define WK_PART_FOG 1
/** The clear sky above the horizon, behind clouds. Rungs: all, none. */
#define WK_PART_SKY 2
/**
 * Streaks and splashes of rain, where the view has no rain model of the host's choice. Rungs: drops (each near the
 * camera by itself), cones (which stand for them), none (all rain is a veil, and without WK_PART_FOG too nothing of it
 * is drawn).
 */
#define WK_PART_RAIN 3
/** Stars, planets and the glow of the night between them. Rungs: all, none (an even sky of the same light). */
#define WK_PART_STARS 4
/** Clouds, where the context draws them as a volume. Rungs: volume, deck (as WK_CLOUD_MODEL_DECK). */
#define WK_PART_CLOUDS 5
/**
 * Flakes of falling snow, where the view has no snow model of the host's choice. Rungs: flakes, none (all snow is a
 * veil, and without WK_PART_FOG too nothing of it is drawn).
 */
#define WK_PART_SNOW 6

/** Wish of a host for one part. */
typedef struct wk_part_wish {
    /** sizeof(wk_part_wish) of your header. */
    uint32_t struct_size;
    /** WK_STRUCT_TYPE_PART_WISH. */
    wk_struct_type struct_type;
    /** No extensions in this version: NULL. */
    const void *next;
    /** Flags of the optional fields that are set. */
    wk_part_wish_has_flags has;
    /** Part that the wish is about. */
    wk_part part;
    /**
     * Optional: draw the part at exactly this rung, whatever the tolerance and the time, so that all channels draw the
     * same. Range: below the part's wk_part_plan.rung_count. wk_plan.gave_way still says what of a tolerance and a
     * time is not kept.
     */
    uint32_t rung;
    /** 0. */
    uint32_t reserved;
    /**
     * Optional: how much the part matters to those who look, which says what is left out first under a budget of time.
     * Range [0, 1], default wk_part_plan.importance.
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

/** How wrong a view's pictures may be, and how long they may take. */
typedef struct wk_budget {
    /** sizeof(wk_budget) of your header. */
    uint32_t struct_size;
    /** WK_STRUCT_TYPE_BUDGET. */
    wk_struct_type struct_type;
    /** No extensions in this version: NULL. */
    const void *next;
    /** Flags of the optional fields that are set. Default 0: everything is drawn. */
    wk_budget_has_flags has;
    /** Length of `wishes`. Default 0: parts that are not in it are planned, and matter as by default. */
    uint32_t wish_count;
    /** sizeof(wk_part_wish) of your header. */
    uint32_t wish_stride;
    /** 0. */
    uint32_t reserved;
    /** Wishes for single parts, each of them once. */
    const wk_part_wish *wishes;
    /** Optional: largest error of what is left out. Range (0, 1]; 0.01 is not seen. */
    double tolerance;
    /**
     * Optional: longest time of the weather in a frame, ms; wins over the tolerance. Range (0, 1000]. The plan knows
     * only the times of wk_view_report_time.
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

/** Part of a budget that could not be kept, by the estimates. */
typedef uint32_t wk_gave_way;

/** Nothing had to give way. */
#define WK_GAVE_WAY_NOTHING 0
/** The tolerance: the time allows no better picture. */
#define WK_GAVE_WAY_TOLERANCE 1
/**
 * Time, and the tolerance: even with every part left out, or with the parts that are pinned, the picture takes longer
 * than the budget.
 */
#define WK_GAVE_WAY_TIME 2

/** Parts that a view's last frame left out. Errors are estimates from the gauged pixels. */
typedef struct wk_plan {
    /** sizeof(wk_plan) of your header. */
    uint32_t struct_size;
    /** WK_STRUCT_TYPE_PLAN. */
    wk_struct_type struct_type;
    /** No extensions in this version: NULL. */
    const void *next;
    /** How many parts there are: their numbers are below it. */
    uint32_t part_count;
    /** Limit of the budget that could not be kept. */
    wk_gave_way gave_way;
    /** Error of everything left out together: 95th percentile over the gauged pixels. */
    double error;
    /** Upper end of the 95 % confidence interval of that percentile over all pixels. */
    double error_bound;
    /** Error of the worst gauged pixel. */
    double worst;
    /** Work of the picture as planned, in units of a pixel with none of the parts; 0 before the first gauge. */
    double work;
    /** Work of the picture with everything, in the same units. */
    double work_of_everything;
    /** Predicted time of the picture from the times reported so far, ms; 0 before the first. */
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

/** Why a part is drawn as it is. */
typedef uint32_t wk_plan_reason;

/** No tolerance was given: everything is drawn. */
#define WK_PLAN_REASON_EVERYTHING_ASKED 0
/** This picture has not been gauged yet, or must not depend on earlier ones: everything is drawn. */
#define WK_PLAN_REASON_NOT_GAUGED 1
/** The weather has none of it, or the recorded stages do not draw it. */
#define WK_PLAN_REASON_ABSENT 2
/** With less of it the error would be beyond the tolerance. */
#define WK_PLAN_REASON_NEEDED 3
/** The error with less of it is within the tolerance. */
#define WK_PLAN_REASON_WITHIN_TOLERANCE 4
/** The host pinned it. */
#define WK_PLAN_REASON_PINNED 5
/** The time allows no more. */
#define WK_PLAN_REASON_OUT_OF_TIME 6

/** One part of a plan. */
typedef struct wk_part_plan {
    /** sizeof(wk_part_plan) of your header. */
    uint32_t struct_size;
    /** WK_STRUCT_TYPE_PART_PLAN. */
    wk_struct_type struct_type;
    /** No extensions in this version: NULL. */
    const void *next;
    /** Why it is drawn as it is. */
    wk_plan_reason reason;
    /** The rung at which it is drawn once it has faded; 0, all of it, if there is none of it. */
    uint32_t rung;
    /** How many rungs it has. */
    uint32_t rung_count;
    /** 0. */
    uint32_t reserved;
    /** Its name in saved plans and messages, UTF-8; lives as long as the process, as the other texts do. */
    const char *name;
    /** That of the rung. */
    const char *rung_name;
    /** The reason in a few words of English. */
    const char *reason_text;
    /** How much it matters where a budget does not say. */
    double importance;
    /** How much of it is drawn: 1 all, 0 its last rung, between while it fades or on another. */
    double share;
    /** Error of the picture with this part alone at its last rung, as last gauged. */
    double error;
    /** Error of the worst gauged pixel with this part alone at its last rung, as last gauged. */
    double worst;
    /**
     * Work that all of it adds to this picture with everything, or would add, in units of a pixel with none of the
     * parts.
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
 * Sets the tolerance and the time of the view's pictures; NULL draws everything again. Unchanged after an error.
 * Thread: exclusive on the view.
 * Errors: WK_ERROR_INVALID_ARGUMENT naming the field and its range.
 */
WK_API wk_status wk_view_set_budget(wk_view *view, const wk_budget *budget);

/**
 * Reports the time that the weather took in the last frame, ms, measured as for the budget (your GPU timer, or a call
 * that you wait for). Under a budget of time the plan uses the median of the last five reports.
 * Thread: exclusive on the view.
 * Errors: WK_ERROR_INVALID_ARGUMENT outside of (0, 1e5] ms; nothing changes then.
 */
WK_API wk_status wk_view_report_time(wk_view *view, double milliseconds);

/**
 * Gets what the view's last frame left out.
 * Thread: exclusive on the view.
 */
WK_API wk_status wk_view_get_plan(wk_view *view, wk_plan *out_plan);

/**
 * Says of one part how much of it the view's last frame drew, and why; and what the part is called, before any frame
 * too. Thread: exclusive on the view. Errors: WK_ERROR_INVALID_ARGUMENT for a number that no part has.
 */
WK_API wk_status wk_view_get_part_plan(wk_view *view, wk_part part, wk_part_plan *out_part);

/**
 * Writes the view's plan, for wk_view_load_plan on other channels or another day: the parts that are drawn, and the
 * settings of the sky. UTF-8 text. `*out_size` gets the bytes needed, even if `capacity` is too small (then nothing
 * else is written and the call fails) or `buffer` is NULL with `capacity` 0 (then it succeeds).
 * Thread: exclusive on the view.
 * Errors: WK_ERROR_WRONG_ORDER while the view has a budget but has not gauged its picture yet: some frames follow each
 * jump of camera, sun or weather.
 */
WK_API
wk_status wk_view_save_plan(wk_view *view,
                            void *buffer,
                            size_t capacity,
                            size_t *out_size);

/**
 * Pins a plan that wk_view_save_plan wrote, as WK_PART_WISH_HAS_RUNG does for every part; the rest of the view's
 * budget stays, and wk_view_set_budget ends it. Thread: exclusive on the view. Errors: WK_ERROR_PARSE for bytes that
 * are no such plan or of another version, naming line and column or the field; WK_ERROR_INVALID_ARGUMENT naming the
 * setting of the sky in which the view's context differs. After an error the view's plan stays as it was.
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
 * drops have places of their own, farther ones are streaks on cones. Both follow from seed and time alone, so all
 * channels of a simulator draw the same rain and any time can be shown again. The wind carries the drops, the host's
 * depth hides them, sky, ground, sun and lamps light them, and they splash on what the picture shows within ten
 * metres.
 *
 * Give boxes that keep rain off: a roof, a bridge deck, a cab, a truck. A drop whose own path crossed a box is gone,
 * whatever the wind. So it is wet on the windward side of a box, dry on its lee side and dry inside. Planes cut a box
 * to any convex shape (wk_shelter_shape): a gable roof, a cab with a slanted front.
 * ====================================================================================================
 */

/** wk_rain.shutter_s of an eye, which adds up light over about this time by day. Streaks are long and faint. */
#define WK_RAIN_SHUTTER_EYE_S 0.05

/** wk_rain.shutter_s of a video camera whose shutter is open for a whole frame of 60 a second: the default. */
#define WK_RAIN_SHUTTER_CAMERA_60_S 0.016666666666666666

/** wk_rain.shutter_s of a camera in good light. Streaks are short. */
#define WK_RAIN_SHUTTER_CAMERA_500_S 0.002

/** wk_rain.contrast_gain for trainers: on a display of eight bits rain by day is as visible as in a film. */
#define WK_RAIN_GAIN_TRAINER 4.0

/** How a view draws rain; what falls is the same. */
typedef uint32_t wk_rain_model;

/**
 * Welkin chooses: single drops to 1.9 m and cones to 14.8 m; with a wk_budget less, where the picture does not need it
 * or the time does not allow it (WK_PART_RAIN). Near a wind that varies in space (wk_context_set_wind_grid,
 * wk_context_set_wind_field) the drops follow it, on devices with compute shaders.
 */
#define WK_RAIN_MODEL_AUTOMATIC 0
/** No drops: all rain is extinction in the air. */
#define WK_RAIN_MODEL_VEIL 1
/**
 * Streaks on three nested cones around the camera. The cost depends only on the picture's size: the cheapest moving
 * rain without compute shaders (wk_caps.tier 0). No splashes.
 */
#define WK_RAIN_MODEL_CONES 2
/** Single drops to 4 m, each where seed and time put it; cones beyond only where lamps light the rain. */
#define WK_RAIN_MODEL_DROPS 3
/** Drops to 4 m that follow a wind varying in space, step by step. Needs compute shaders (wk_caps.tier 1). */
#define WK_RAIN_MODEL_INTEGRATED 4

/** How a view draws what falls: rain, hail and splashes. What falls does not depend on it. */
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
     * Most drops to draw; if more fall, each drawn drop stands for several. Range [1000, 8 000 000], or 0, the
     * default: 400 000, and 100 000 on a software driver.
     */
    uint32_t most_drops;
    /** A WK_RAIN_MODEL_ constant; 0, the default, lets Welkin choose. */
    wk_rain_model model;
    /**
     * Contrast of rain, over that in nature. Range [1, 16], or 0, the default: 1, as in nature. Beyond 1 a streak,
     * stone or splash hides as much as that many of them one before the other. This departs from physics, for displays
     * on which rain by day cannot be seen otherwise (WK_RAIN_GAIN_TRAINER). Light, visibility, water and queries do
     * not depend on it. Set the same value on all channels of a simulator.
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
    /** Its centre, m, within 1e12 m of the origin. Default 0, 0, 0. */
    double center_m[3];
    /** Its three axes, one after the other: unit vectors at right angles. Default: the world's axes. */
    double axes[9];
    /** Half its size along each axis, m. Range [1e-3, 1e5], default 1, 1, 1. */
    double half_size_m[3];
    /** Its velocity, m/s, at most 2000 in all. Default 0, 0, 0. */
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
 * Planes that cut a wk_shelter to another convex shape; put it into the shelter's chain. The part of the box beyond
 * any plane keeps nothing off. Describe a convex shape by the box around it and the planes of its faces.
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
     * distance along it from the box's centre, m, within 1e6. The planes must leave some of the box. Default 0.
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
 * Sets how the view draws rain; NULL returns to the default. Unchanged after an error. Thread: exclusive on the view.
 * Errors: WK_ERROR_INVALID_ARGUMENT naming the field and its range; WK_ERROR_UNSUPPORTED for a model, or more drops of
 * it, than the device can draw.
 */
WK_API
wk_status wk_view_set_rain(wk_view *view,
                           const wk_rain *rain);

/**
 * Sets the boxes that keep rain off, in place of those before; set moving ones again in every frame. count 0 removes
 * all. At most 32. Unchanged after an error.
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
 * WK_STAGE_PARTICLES draws falling snow wherever the weather has it: flakes of the sizes and speeds that rate, kind
 * and temperature give, each at a place that follows from seed and time alone, so all channels of a simulator draw the
 * same flakes. The wind carries them, the host's depth hides them, shelters and occluder maps keep them off, sky,
 * ground, sun and lamps light them. What is farther than the flakes is extinction in the air.
 * ====================================================================================================
 */

/** How a view draws falling snow; what falls is the same. */
typedef uint32_t wk_snow_model;

/**
 * Flakes near the camera; with a wk_budget none, where the picture does not need them or the time does not allow them
 * (WK_PART_SNOW).
 */
#define WK_SNOW_MODEL_AUTOMATIC 0
/** No flakes: all snow is extinction in the air. */
#define WK_SNOW_MODEL_VEIL 1
/** Flakes, whatever a budget says. */
#define WK_SNOW_MODEL_FLAKES 2

/** How a view draws falling snow. What falls does not depend on it. */
typedef struct wk_snow {
    /** sizeof(wk_snow) of your header. */
    uint32_t struct_size;
    /** WK_STRUCT_TYPE_SNOW. */
    wk_struct_type struct_type;
    /** No extensions in this version: NULL. */
    const void *next;
    /**
     * Exposure time of a picture, s: flakes that move by more than their size in it are streaks. Range [1e-4, 0.1],
     * default 1/250, at which flakes in a light wind show their shapes.
     */
    double shutter_s;
    /**
     * Most flakes to draw. The more, the farther they reach, up to 16 m; of what there is no room for some stand for
     * others. Range [1000, 8 000 000], or 0, the default: 1 000 000, and 60 000 on a software driver.
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
 * Regions with rain of their own: a passing shower, a squall line, a dry hole in steady rain. Inside a region the
 * weather's rain and drizzle give way to the area's, smoothly over the rim inside its border. Where areas overlap, a
 * later one in the list lies over the earlier ones. A camera inside sees drops of the rate at each drop's own place.
 * From outside the rain is a shaft with falling curtains, which leans as the drops fall behind their cloud. All
 * queries of rain and visibility, and the ground's wetness by the weather of the moment, include the areas. Where
 * clouds are a volume (WK_CLOUD_MODEL_VOLUME), an area has cloud over it. wk_context_save keeps them.
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

/** The wind at 10 m with its gusts, by its displacement. */
#define WK_AREA_MOTION_WITH_WIND 0
/** A velocity of its own. */
#define WK_AREA_MOTION_OWN 1

/** Kind of snow in a rain area. */
typedef uint32_t wk_area_snow;

/** None. */
#define WK_AREA_SNOW_NONE 0
/** Flakes. Not in this version. */
#define WK_AREA_SNOW_FLAKES 1
/** Snow grains. Not in this version. */
#define WK_AREA_SNOW_GRAINS 2
/** Snow pellets. Not in this version. */
#define WK_AREA_SNOW_PELLETS 3

/** A region with rain of its own. */
typedef struct wk_rain_area {
    /** sizeof(wk_rain_area) of your header. */
    uint32_t struct_size;
    /** WK_STRUCT_TYPE_RAIN_AREA. */
    wk_struct_type struct_type;
    /** No extensions in this version: NULL. */
    const void *next;
    /**
     * Its centre in the host's world at the time at_s, m, within 1e12 m of the origin; the height has no effect.
     * Default 0, 0, 0.
     */
    double center_m[3];
    /**
     * Half the extent of an ellipse to the right of the heading and along it, m. Range [10, 1e6], default 2000, 2000.
     */
    double semi_axes_m[2];
    /**
     * Corners of a polygon in place of the ellipse, in either direction around it, two numbers each: distance from the
     * centre to the right of the heading and along it, m, within 1e6. The region must be convex and larger than 1 m^2.
     * Default 0.
     */
    double corners_m[16];
    /** Corners of the polygon, [3, 8], or 0, the default, for the ellipse. */
    uint32_t corner_count;
    /** Default WK_AREA_RAIN_STEADY. */
    wk_area_rain rain;
    /** Heading of the shape, degrees clockwise from true north. Range [-360, 360], default 0. */
    double heading_deg;
    /**
     * Width inside of the border over which the rain fades, m. Range [1, 1e6], at most an ellipse's smaller half
     * extent, or the radius of the largest circle in a polygon. Default 500.
     */
    double rim_m;
    /** Rate at the ground, mm/h; 0 makes a dry hole. Range [0, 500], default 10. */
    double rate_mm_h;
    /**
     * Altitude of the cloud base above mean sea level (not above the ground), m: above it falls neither the area's
     * rain nor the weather's. Range [-1000, 20 000], default 1500.
     */
    double top_m;
    /** Own velocity to the east and north, m/s, each within [-200, 200]. Default 0, 0. For WK_AREA_MOTION_OWN. */
    double velocity_m_s[2];
    /**
     * Simulation time at which the centre is at center_m, s. Range [-1e10, 1e10]. With WK_AREA_MOTION_WITH_WIND not
     * before what the timeline still knows, except 0, from which the wind's displacement counts. Default 0.
     */
    double at_s;
    /** Default WK_AREA_MOTION_WITH_WIND. */
    wk_area_motion motion;
    /** Snow that falls in place of the rain. Default WK_AREA_SNOW_NONE, the only one in this version. */
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
 * Sets the rain areas, in place of those before. They move by themselves: set them again only to change them. count 0
 * removes all. At most 16. Unchanged after an error.
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
 * [wind_grid] Wind that varies in space
 *
 * If you know how air flows around your buildings, over your deck or under your rotor, give the velocities on a grid.
 * They act in wk_context_get_wind_at, in what lands on surfaces and windscreens, on patches of fog and dust, and on
 * drops and flakes near a camera, in place of a wind field's (wk_context_set_wind_field). Everything else follows the
 * weather's wind.
 * ====================================================================================================
 */

/** Meaning of a grid's velocities. */
typedef uint32_t wk_wind_grid_kind;

/** The whole wind: replaces the weather's wind inside the grid. */
#define WK_WIND_GRID_WHOLE 0
/** A difference: added to the weather's wind. */
#define WK_WIND_GRID_ADDED 1

/**
 * Velocities of the air at the nodes of a grid that is level and aligned to true north, linear between nodes along
 * each axis. Outside the grid the weather's wind blows: make the grid large enough for the flow to have become that
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
     * The lowest node farthest to the south-west, in the host's world, m, within 1e12 m of the origin. Default 0, 0,
     * 0.
     */
    double origin_m[3];
    /** Distance between nodes east, north and up, m. Range [0.01, 10 000], default 1, 1, 1. */
    double cell_m[3];
    /** Number of nodes east, north and up. Range 2 to 64, 64 and 32, default 2, 2, 2. */
    uint32_t nodes[3];
    /** A WK_WIND_GRID_ constant, default WK_WIND_GRID_WHOLE. */
    wk_wind_grid_kind kind;
    /**
     * Three numbers for each node (east, north, up), m/s, of at most 300 m/s together. Nodes run from west to east,
     * rows from south to north, layers upwards. Copied by the call.
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
 * Sets a wind that varies in space, in place of the one before; NULL removes it. Unchanged after an error.
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
 * A context can solve for the wind in a box of air about a place: it goes round the terrain of
 * wk_context_set_ground_grid or wk_context_set_terrain and the boxes of wk_context_set_shelters, moving ones too,
 * comes in as the weather's wind and leaves behind. It acts where a wind grid of your own would
 * (wk_context_set_wind_grid): in wk_context_get_wind_at, in what lands on surfaces and windscreens, and on drops and
 * flakes near a camera. Nothing is solved unless you ask for it.
 * ====================================================================================================
 */

/** How a wind field is led through time. */
typedef uint32_t wk_wind_field_mode;

/**
 * The mean wind: solved for over the first moments after the wind or an obstacle has changed, then it rests at no
 * cost. Gusts are as strong, against the weather's, as the mean is there.
 */
#define WK_WIND_FIELD_STEADY 0
/**
 * The wind with gusts, the whirls that come in with it and those that obstacles shed, stepped all the time.
 * docs/wind-field.md says what sizes a core keeps up with.
 */
#define WK_WIND_FIELD_RUNNING 1

/** Effect of terrain and boxes on air that passes along them. */
typedef uint32_t wk_wind_walls;

/** They slow it, by the weather's roughness length. */
#define WK_WIND_WALLS_ROUGH 0
/** It slides. */
#define WK_WIND_WALLS_SMOOTH 1

/**
 * A box of air in which the wind is solved for: level and aligned to true north. Within four cells of its sides and
 * top it goes over into the weather's wind.
 */
typedef struct wk_wind_field {
    /** sizeof(wk_wind_field) of your header. */
    uint32_t struct_size;
    /** WK_STRUCT_TYPE_WIND_FIELD. */
    wk_struct_type struct_type;
    /** No extensions in this version: NULL. */
    const void *next;
    /**
     * Middle of the field's floor, in the host's world, m, within 1e12 m of the origin: no higher than the lowest
     * ground that matters. Where it moves the field follows by whole cells. Default 0, 0, 0.
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
     * Memory that the field may take, bytes; more is refused, and the message says how much is needed. Range [1048576,
     * 17179869184], default 1073741824.
     */
    uint64_t most_bytes;
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
    /* most_bytes */ UINT64_C(1073741824) \
}

/** How a wind field stands. */
typedef struct wk_wind_field_report {
    /** sizeof(wk_wind_field_report) of your header. */
    uint32_t struct_size;
    /** WK_STRUCT_TYPE_WIND_FIELD_REPORT. */
    wk_struct_type struct_type;
    /** No extensions in this version: NULL. */
    const void *next;
    /**
     * 1: there is a field. 0: none is set, its time has not come, or its first steady state is still being solved for;
     * all else is 0 then.
     */
    uint32_t present;
    /** 1: it is steady and rests; nothing is stepped. */
    uint32_t rests;
    /** Simulation time of the field, s: the present, or up to one step before it. */
    double time_s;
    /**
     * Simulation time at which it last began from a steady field, s: when it was first set, after a leap of more than
     * 60 s, or far off.
     */
    double begun_s;
    /** Length of its steps, s. */
    double step_s;
    /** Its lowest corner, farthest to the south-west, in the host's world, m. */
    double corner_m[3];
    /** The largest component of the wind anywhere in it, m/s. */
    double fastest_m_s;
    /** Memory that it may take, bytes. */
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
 * Sets a wind field from simulation time start_time_s on, not before the last update or change; NULL ends it then. The
 * same size, mode and walls at another place move it by whole cells; anything else begins it anew. wk_context_update
 * leads it in steps on a grid anchored at time 0, whatever is drawn: the same on every channel. It begins with the
 * steady field of its first moment. Part of the saved state. Unchanged after an error. Thread: exclusive. Errors:
 * WK_ERROR_INVALID_ARGUMENT naming the field and its range; WK_ERROR_WRONG_ORDER for a time that has passed.
 */
WK_API
wk_status wk_context_set_wind_field(wk_context *context,
                                    const wk_wind_field *wind_field,
                                    double start_time_s);

/**
 * How the wind field stands now.
 * Thread: concurrent.
 * Errors: WK_ERROR_INVALID_ARGUMENT for a structure that is none.
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
 * [occluder] Maps of what keeps rain off
 *
 * For everything that boxes cannot describe, give up to four depth images of your world, of standing or moving things,
 * from any direction. A drop is gone where its own slanted path crosses a surface that a map shows.
 *
 * A map knows nothing of what its surfaces hide. Draw it along wk_rainfall.fall_velocity_m_s: then it hides nothing
 * that matters for half of the rain, and little for the rest. Where things stand below others (a pier below a deck),
 * add maps along slower drops: the same wind with fall speeds of 3.4 and 2.1 m/s. What a map shows is exact to two
 * texels.
 *
 * Welkin copies a map during the call. Work that you submitted to the queue before (or, with OpenGL, issued) is
 * included. Afterwards the image is yours again.
 * ====================================================================================================
 */

/** Flags of a map. */
typedef uint32_t wk_occluder_map_flags;

/** Its depth is reversed: 1 is near, 0 is far. */
#define WK_OCCLUDER_MAP_DEPTH_REVERSED 1
/** The first row of the image lies at clip y = -1: always so in OpenGL (there it need not be set). */
#define WK_OCCLUDER_MAP_FIRST_ROW_AT_MINUS_Y 2

/** A depth image of things that keep rain off: one sample, from 8 to 4096 texels along either side. */
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
    /** Default 0. */
    wk_occluder_map_flags flags;
    /** Default WK_CLIP_ZERO_TO_ONE. */
    wk_clip_space clip_space;
    /** Simulation time of what it shows, s. Default 0. */
    double time_s;
    /**
     * Velocity of what it shows, m/s, at most 2000 in all, so that a truck's own map need not be drawn in every frame.
     * Default 0, 0, 0.
     */
    double velocity_m_s[3];
    /** The image on an own device. Default NULL. */
    const wk_texture *texture;
    /** The image of a Vulkan host. Default NULL. */
    const wk_vulkan_image *vulkan;
    /** The image of an OpenGL host: a depth texture or renderbuffer. Default none. */
    wk_opengl_image opengl;
    /** Texels of an OpenGL host's image; must be its own. Default 0. */
    uint32_t width;
    /** Texels of an OpenGL host's image; must be its own. Default 0. */
    uint32_t height;
    /** For an OpenGL host's image: raise it when you make an object again under an old name. Default 0. */
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
 * Sets the maps of things that keep rain off, in place of those before. count 0 removes them. At most 4. After an
 * error the maps before stay. They are not part of a saved state, because each channel may have its own.
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
 * splashes and clouds) and shine in wet ground. The host lights its own world itself.
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
    /** Direction that it shines in, in the host's world; any length in [1e-6, 1e6]. Default 0, 1, 0. */
    double direction[3];
    /**
     * Luminous intensity in the middle of the beam, cd a channel of linear Rec. 709. Range [0, 1e9], default 1000
     * each. A low beam has about 10 000, a work light 2000 to 5000.
     */
    double intensity_cd[3];
    /** Angle from the middle up to which the beam has full intensity, degrees. Range [0, 180], default 10. */
    double inner_deg;
    /** Angle from the middle at which the beam ends, degrees. Range [inner_deg, 180], default 30; 180: no end. */
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
 * Sets the host's lamps, in place of those before; set moving ones again in every frame. count 0 removes all. At
 * most 64. Unchanged after an error.
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
 * zodiacal light and the Milky Way behind its sky, where they stand over the context's place by its clock; by day, in
 * fog and under closed clouds there is nothing of it. A budget may leave them out (WK_PART_STARS).
 * ====================================================================================================
 */

/** Flags of the settings in a wk_stars. */
typedef uint32_t wk_stars_flags;

/** stars and star_count: the host's own stars in place of the catalogue's. */
#define WK_STARS_OWN 1
/** celestial_to_world: the host turns the heavens itself. */
#define WK_STARS_TURNED 2
/** No planets. */
#define WK_STARS_NO_PLANETS 4

/** How the night sky is drawn. */
typedef struct wk_stars {
    /** sizeof(wk_stars) of your header. */
    uint32_t struct_size;
    /** WK_STRUCT_TYPE_STARS. */
    wk_struct_type struct_type;
    /** No extensions in this version: NULL. */
    const void *next;
    /** Default 0: the catalogue's stars and the planets, where they stand over the Earth. */
    wk_stars_flags flags;
    /** Stars in `stars`, at most 1 000 000. Default 0. */
    uint32_t star_count;
    /**
     * With WK_STARS_OWN: four numbers a star: right ascension, degrees, declination, degrees in [-90, 90], both in the
     * equator and equinox of J2000.0; visual magnitude in [-30, 30]; temperature of its colour as a black body, K, in
     * [1000, 100000]. Copied. Default NULL.
     */
    const double *stars;
    /**
     * With WK_STARS_TURNED: rotation from the equator and equinox of J2000.0 (x to the equinox, z to the north pole)
     * to (east, north, up), column after column. Default the identity.
     */
    double celestial_to_world[9];
    /** Strength of the airglow. Range [0, 10], default 1: near the sun's least activity; 1.7 at the greatest. */
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
 * Sets how the night sky is drawn; NULL returns to the default. All but the list of stars is part of the saved state:
 * a context that loads one keeps its own list. Unchanged after an error. Thread: exclusive. Errors:
 * WK_ERROR_INVALID_ARGUMENT naming the field and its range.
 */
WK_API wk_status wk_context_set_stars(wk_context *context, const wk_stars *stars);

/**
 * Gets the magnitude, as catalogues give it, of the faintest star that the naked eye sees straight up from a place at
 * a simulation time. It falls with the sky's light, and with what air, fog and clouds take of the star's. Minus
 * infinity where nothing comes through. Thread: concurrent. Errors: as wk_context_get_conditions.
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
 * Where over the ground layers of cloud stand: a storm ahead of the runway, a clearing over the harbour. The map holds
 * in pictures, shadows, the light of a place and all questions about clouds. docs/clouds.md has an example.
 * ====================================================================================================
 */

/**
 * How much of the cover that layers have in the weather they have over each part of the ground. Give a layer cover 1,
 * and the map says its cover. The map is level, aligned to true north and stands still over the ground; clouds go
 * through it with their wind, and grow and dissolve as it says. Linear between the middles of cells; beyond the
 * outermost middles theirs hold on.
 */
typedef struct wk_cloud_map {
    /** sizeof(wk_cloud_map) of your header. */
    uint32_t struct_size;
    /** WK_STRUCT_TYPE_CLOUD_MAP. */
    wk_struct_type struct_type;
    /** No extensions in this version: NULL. */
    const void *next;
    /**
     * Middle of the cell farthest to the south-west, east and north of the world's origin, m. Range [-1e7, 1e7],
     * default 0, 0.
     */
    double first_m[2];
    /** Side of a cell, m. Range [100, 50 000], default 1000. */
    double cell_m;
    /** Number of cells east and north. Range [1, 128], default 1, 1. */
    uint32_t cells[2];
    /**
     * Layers whose base above the station lies between these follow the map, m. Range [-1000, 20 000], the lower one
     * first, default -1000, 20 000: all layers.
     */
    double base_m[2];
    /**
     * A number for each cell in [0, 1]: 0 for no cloud, 1 for the layer's cover. Cells run from west to east, rows
     * from south to north. Copied by the call.
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
 * Lays a map on layers of cloud, in place of the one before; NULL takes it off. Clouds change at once. Part of the
 * saved state. With WK_CLOUD_MODEL_DECK it holds for light alone. Unchanged after an error. Thread: exclusive. Errors:
 * WK_ERROR_INVALID_ARGUMENT naming the field and its range.
 */
WK_API
wk_status wk_context_set_cloud_map(wk_context *context,
                                   const wk_cloud_map *cloud_map);

/**
 * Writes the default of every field: the same bytes as `WK_CLOUD_MAP_INIT`. `struct_size` is `sizeof(wk_cloud_map)`
 * as the caller was compiled, and is stored in the struct.
 */
WK_API wk_status wk_cloud_map_init(wk_cloud_map *out, uint32_t struct_size);

/*
 * ====================================================================================================
 * [clouds] Clouds
 *
 * Layers of cloud come with the weather: wk_cloud_layer, a report, a preset. wk_context_set_cloud_model says how views
 * draw them. Conditions, what falls and light on the mean are the same either way. docs/clouds.md has costs and
 * errors.
 *
 * Volumes cast shadows: the stage SURFACE darkens and brightens what the host drew from its depth, in the ratio of the
 * light at each pixel's place to the light on the mean, in which the host lit it (wk_context_get_light). A host that
 * lights a thing of its own by itself, such as the view out of a cab, asks for the share at its place.
 * ====================================================================================================
 */

/** How clouds are drawn. */
typedef uint32_t wk_cloud_model;

/**
 * A grey deck where more than half of the sky is covered; broken clouds only dim the light. It costs no more than a
 * clear sky.
 */
#define WK_CLOUD_MODEL_DECK 0
/**
 * Layers of a volume that one can fly through, lit by sun or moon, sky and ground. A closed layer seen from below is
 * drawn as a deck. A sixteenth of the pixels is computed in a frame: count wk_frame.frame_id up by one.
 */
#define WK_CLOUD_MODEL_VOLUME 1

/** Effects of clouds that a view draws beside the clouds. */
typedef uint32_t wk_clouds_flags;

/**
 * Shafts of light: the air under broken clouds is brighter where the sun shines through and darker in their shadows.
 * Drawn with WK_STAGE_SURFACE where the host gives depth and does not read the map of shadows itself
 * (wk_view_get_cloud_shadows), up to 10 km away; 24 look-ups a pixel. Without it the air is as bright as on the mean
 * over places.
 */
#define WK_CLOUDS_SHAFTS 1

/** How finely a view draws clouds that are a volume. */
typedef struct wk_clouds {
    /** sizeof(wk_clouds) of your header. */
    uint32_t struct_size;
    /** WK_STRUCT_TYPE_CLOUDS. */
    wk_struct_type struct_type;
    /** No extensions in this version: NULL. */
    const void *next;
    /** How many steps a ray takes: twice the value, twice as many. Range [0.125, 32], default 2. */
    double fineness;
    /**
     * One pixel of a square of so many on a side is computed in a frame; the others are taken over from earlier
     * frames: 1, 2 or 4, default 4. Frames with WK_FRAME_NO_HISTORY compute all.
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
 * Sets how views draw clouds. Default WK_CLOUD_MODEL_VOLUME; a budget may draw the deck in its place (WK_PART_CLOUDS).
 * Part of the saved state. Thread: exclusive. Errors: WK_ERROR_INVALID_ARGUMENT for an unknown model.
 */
WK_API
wk_status wk_context_set_cloud_model(wk_context *context,
                                     wk_cloud_model cloud_model);

/**
 * Gets the share of the direct light of sun or moon, whichever is brighter, that clouds let through to a place, in
 * [0, 1]: in the shadow of a cloud, or between two. wk_ground_light.sun_lux times this over wk_celestial.direct_share
 * is the sun's light at the very place. With WK_CLOUD_MODEL_DECK it is the mean, wk_celestial.direct_share. The first
 * question makes the field that clouds are cut out of, in some tenths of a second.
 * Thread: concurrent.
 * Errors: as wk_context_get_conditions.
 */
WK_API
wk_status wk_context_get_sun_share(const wk_context *context,
                                   const double (*position_m)[3],
                                   double time_s,
                                   double *out_share);

/**
 * Sets how finely the view draws clouds; NULL returns to the default. Unchanged after an error. docs/lab/README.md has
 * cost and error of some choices.
 * Thread: exclusive on the view.
 * Errors: WK_ERROR_INVALID_ARGUMENT naming the field and its range.
 */
WK_API
wk_status wk_view_set_clouds(wk_view *view,
                             const wk_clouds *clouds);

/**
 * Writes the default of every field: the same bytes as `WK_CLOUDS_INIT`. `struct_size` is `sizeof(wk_clouds)`
 * as the caller was compiled, and is stored in the struct.
 */
WK_API wk_status wk_clouds_init(wk_clouds *out, uint32_t struct_size);

/*
 * ====================================================================================================
 * [cloud_shadow] Shadows of clouds as a texture
 *
 * For the host's own materials: the share of the direct light of sun or moon that broken clouds let through, as one
 * native texture for all places about the camera. The published sampling function, GLSL and WGSL, looks it up.
 * ====================================================================================================
 */

/**
 * The map of the clouds' shadows, and how it lay in the view's last frame: a plane at the station's height, fixed to
 * the air that carries the clouds, which repeats every 20 km.
 */
typedef struct wk_cloud_shadows {
    /** sizeof(wk_cloud_shadows) of your header. */
    uint32_t struct_size;
    /** WK_STRUCT_TYPE_CLOUD_SHADOWS. */
    wk_struct_type struct_type;
    /** No extensions in this version: NULL. */
    const void *next;
    /**
     * Share of the direct light of sun or moon, whichever is brighter, that clouds let through: one channel of 8 bits,
     * an OpenGL texture name (GL_TEXTURE_2D, GL_R8) or a VkImage (VK_FORMAT_R8_UNORM). Sample it with a linear filter
     * that repeats.
     */
    uint64_t texture;
    /** Texels of both sides. */
    uint32_t width;
    /** Texels of both sides. */
    uint32_t height;
    /**
     * Two rows of a matrix: multiplied by (x, y, z, 1) of a place in the host's world, m, they give its u and v.
     * Single precision is enough once the fourth column includes the camera's position.
     */
    double uv_from_world[2][4];
    /** Row of a matrix, used as uv_from_world: it gives the height of a place over the plane, m. */
    double height_from_world[4];
    /** u and v of the place in the plane that the camera of the last frame stood over. */
    double camera_uv[2];
    /** Share of the direct light on the mean over places: wk_context_get_light has that light. */
    double mean_share;
    /**
     * How far shadows are told apart, 0 to 1: 0 without broken clouds, with WK_CLOUD_MODEL_DECK, and under a light
     * near the horizon. The texture means nothing then.
     */
    double told;
    /**
     * Height over the plane, m, from which on shadows are not told apart: 100 m above the base of the lowest clouds.
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
    /* told */ 0.0, \
    /* top_m */ 0.0 \
}

/**
 * Gets the native texture of the clouds' shadows. From the first call on, the first wk_view_record of each frame
 * brings it up to date, and WK_STAGE_SURFACE lays no shadows of clouds any more: your materials do. It belongs to the
 * view and stays the same until that is destroyed. In Vulkan it is in VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL between
 * calls. Call this after each frame for how the map lies. If you draw before Welkin, use that of the last frame, or
 * record WK_STAGE_PREPARE first. Thread: exclusive on the view. Errors: WK_ERROR_UNSUPPORTED on an own device, which
 * has no shaders of the host's.
 */
WK_API
wk_status wk_view_get_cloud_shadows(wk_view *view,
                                    wk_cloud_shadows *out_shadows);

/**
 * Gets the text of the sampling function: NUL-terminated UTF-8 that lives as long as the process.
 * Thread: any.
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
 * A thunderstorm (WK_PRECIPITATION_THUNDERSTORM, a report with TS) flashes: three times a minute in each square of 20
 * km, or as often and where the host says. Every flash is a function of the context's seed, the time, the rate and the
 * storm cells: all channels see the same ones, and any time can be shown again. Views draw channels, the glow of
 * clouds and air, and light rain and wet ground by them. The host asks for events to play thunder, and for light to
 * light its own scene:
 *
 * wk_flash flashes[16];
 * uint32_t count = 0;
 * wk_context_get_flashes(context, ear, last_s, now_s, 20e3, flashes, 16, sizeof flashes[0], &count);
 * for (uint32_t i = 0; i < count; i++)
 *     play_thunder_at(flashes[i].time_s + flashes[i].thunder_delay_s, flashes[i].distance_m);
 *
 * A frame has the light from the view's frame before it to its own time: a flash is neither missed nor doubled,
 * however many frames a second there are.
 * ====================================================================================================
 */

/** Flags of the settings in a wk_lightning. */
typedef uint32_t wk_lightning_flags;

/** flashes_per_minute: the host's rate in place of the weather's. */
#define WK_LIGHTNING_RATE 1

/** How flashes flicker in a picture. */
typedef uint32_t wk_flicker;

/** As in nature: many changes of luminance a second. */
#define WK_FLICKER_AS_IN_NATURE 0
/**
 * At most three changes of luminance a second, for viewers whom flicker may harm: each drawn flash rises once and
 * fades, and the next one comes a second later at the earliest. Events and light that are asked for stay.
 */
#define WK_FLICKER_LIMITED 1

/** How often it flashes, where, and how views draw it. */
typedef struct wk_lightning {
    /** sizeof(wk_lightning) of your header. */
    uint32_t struct_size;
    /** WK_STRUCT_TYPE_LIGHTNING. */
    wk_struct_type struct_type;
    /** No extensions in this version: NULL. */
    const void *next;
    /** Default 0: the weather's rate. */
    wk_lightning_flags flags;
    /** Default WK_FLICKER_AS_IN_NATURE. */
    wk_flicker flicker;
    /**
     * With WK_LIGHTNING_RATE: flashes a minute of each square of 20 km, whatever the weather. Range [0, 60], default
     * 0.
     */
    double flashes_per_minute;
    /** Storm cells in `cells`, at most 16, in place of the weather's. Default 0. */
    uint32_t cell_count;
    /** Tall things in `masts`, at most 64. Default 0. */
    uint32_t mast_count;
    /**
     * Five numbers a cell: its middle in the host's world, m (the height does not matter); the distance from it within
     * which two of three flashes start, m, in [0, 1e5]; flashes a minute in [0, 60]. Copied. Default NULL.
     */
    const double *cells;
    /**
     * Three numbers each: the tip in the host's world, m. Masts draw ground flashes; so do the tops of shelters.
     * Copied. Default NULL.
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

/** Where a flash goes. */
typedef uint32_t wk_flash_kind;

/** To the ground. */
#define WK_FLASH_KIND_TO_GROUND 0
/** Within the cloud. */
#define WK_FLASH_KIND_IN_CLOUD 1

/** A flash that the host triggers. */
typedef struct wk_flash_trigger {
    /** sizeof(wk_flash_trigger) of your header. */
    uint32_t struct_size;
    /** WK_STRUCT_TYPE_FLASH_TRIGGER. */
    wk_struct_type struct_type;
    /** No extensions in this version: NULL. */
    const void *next;
    /** When its first stroke comes, s of simulation time, not before the present. Range [-1e10, 1e10], default 0. */
    double time_s;
    /**
     * Where it strikes in the host's world, m; one within the cloud passes over it. A shelter in its way ends it.
     * Default 0, 0, 0.
     */
    double position_m[3];
    /** Largest peak current of its strokes, kA. Range [0, 500], default 0: by chance. At least 1 otherwise. */
    double peak_ka;
    /** Default WK_FLASH_KIND_TO_GROUND. */
    wk_flash_kind kind;
    /** Strokes. Range [0, 26], default 0: by chance. */
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

/** A flash as a place has it; plain values of a list. */
typedef struct wk_flash {
    /** Number of its own among the flashes of the context. */
    uint64_t id;
    /** When its first stroke comes, s of simulation time. */
    double time_s;
    /** Where it goes. */
    wk_flash_kind kind;
    /** Strokes, or steps of the light of one within the cloud. */
    uint32_t strokes;
    /** Largest peak current of its strokes, kA. */
    double peak_ka;
    /** Position of what it struck, or of the middle of its way in the cloud, in the host's world, m. */
    double position_m[3];
    /** Distance of the nearest point of its channel, m. */
    double distance_m;
    /** Direction to position_m. */
    double direction[3];
    /**
     * Time from the flash to the beginning of its thunder, s: distance_m over the speed of sound, 331.3 m/s and 0.606
     * m/s for each degree Celsius.
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
    /** Illuminance on surfaces that face the sources, all together, lux a channel. */
    double facing_lux[3];
    /** Illuminance on level ground, lux. */
    double level_lux;
    /** Direction to the middle of the light; straight up where there is none. */
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
 * Sets how often it flashes, where, and how views draw it; NULL returns to the default. Part of the saved state.
 * Unchanged after an error.
 * Thread: exclusive.
 * Errors: WK_ERROR_INVALID_ARGUMENT naming the field and its range.
 */
WK_API wk_status wk_context_set_lightning(wk_context *context, const wk_lightning *lightning);

/**
 * Triggers a flash, whatever the weather. Part of the saved state until 120 s after it; at most 64 at a time.
 * Unchanged after an error. Thread: exclusive. Errors: WK_ERROR_INVALID_ARGUMENT naming the field and its range;
 * WK_ERROR_WRONG_ORDER for a time before the present.
 */
WK_API wk_status wk_context_trigger_flash(wk_context *context, const wk_flash_trigger *flash);

/**
 * Gets the flashes that begin from `from_s` on until `until_s`, 3600 s at most, within `most_distance_m` of a place of
 * the host's world (on the map; at most 50000 m), in order of time: past or to come. `*out_count` gets their number
 * even if `capacity` is too small (then nothing else is written and the call fails) or 0 (then it succeeds).
 * `flash_size` is sizeof(wk_flash) of your header. Where the timeline has forgotten the weather of then, the first
 * that it knows counts. Thread: concurrent. Errors: WK_ERROR_INVALID_ARGUMENT naming the parameter.
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
 * Gets the light of flashes at a place of the host's world, on the mean of `exposure_s`, [0, 1], before `time_s`; with
 * 0 that of the very moment. A host lights its own scene by it, with the time from its last frame as exposure. Thread:
 * concurrent. Errors: WK_ERROR_INVALID_ARGUMENT naming the parameter.
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
 * A view may look through a window. Rain lands on it at the rate and speed at which the window meets it. Beads merge,
 * run down by gravity or up by the air, are wiped, and bend the picture behind them. Mist on the inside blurs the
 * picture. Snow lies on it until wipers take it or heat melts it. The stage LENS draws this over everything drawn so
 * far, inside the window only; pixels of the mask stay. In a call with TONE the glass lies before the tone curve if
 * the target is a float one, else after it.
 *
 * The water is part of the view. It moves in steps of 1/60 s from simulation time 0, with the frame that records
 * WK_STAGE_PREPARE or the first stage after it. The frame rate changes nothing, and views of one seed and history
 * agree bit for bit. At the first frame, after WK_FRAME_CUT, and when a frame comes more than half a second after the
 * one before, the water takes the declared state of that moment: a function of seed, time and rain. With
 * WK_FRAME_NO_HISTORY it always has that state. Without a windscreen, or where it is dry and clear, LENS costs
 * nothing.
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
     * Pivot, m right of and above the pane's lower left corner (that of its bounds), along the glass. Range [-4, 12]
     * each. Default 0, 0.
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
     * Position of the blade in this frame: 0 parked, 1 at the far end. Between two frames it moves evenly. Default 0.
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
    /** Default WK_WINDSCREEN_PANE_QUAD. */
    wk_windscreen_pane pane;
    /** Number of wipers in `arms`, at most 2. Default 0. */
    uint32_t arm_count;
    /**
     * Corners of a QUAD in the camera's axes (x right, y up, z backwards), m from the camera, x, y, z each: lower
     * left, lower right, upper right, upper left as seen from the camera. Flat within 2 % of the diagonal, convex,
     * edges in [0.05, 8] m, within 20 m. Its slope against gravity follows from the frame's view matrix. Default 1 m x
     * 0.6 m across the view, 0.7 m away.
     */
    double corners_m[12];
    /** Distance of the glass of a WHOLE_VIEW, m. Range [0.1, 3], default 0.6. */
    double distance_m;
    /**
     * Velocity of the glass relative to the air (the vehicle's minus the wind's) in the camera's axes, m/s: decides
     * how many drops it meets. Range [-400, 400] each, default 0, 0, 0.
     */
    double velocity_m_s[3];
    /**
     * Speed of the air along the glass at the drops' height, upwards, m/s: drives the beads; about 0.7 of the
     * vehicle's speed on a car's windscreen, 0 on upright glass. Range [-100, 100], default 0.
     */
    double airflow_m_s;
    /**
     * Share of the weather's rain that reaches the glass, such as 0 in a tunnel that you have not described as
     * shelter. Shelters and occluder maps keep rain off each part of the pane separately. The vehicle's own box does
     * not count: one that holds the camera and ends within 3 m before the glass. Range [0, 1], default 1.
     */
    double exposed;
    /** Mist on the inside. Range [0, 1], default 0. */
    double fogging;
    /** How far the blower has cleared the mist, from the lower edge upwards. Range [0, 1], default 0. */
    double demist;
    /** The wipers; may be NULL if there are none. Read during the call only. */
    const wk_wiper_arm *arms;
    /** sizeof(wk_wiper_arm) of your header. Default that of this header. */
    uint32_t arm_stride;
    /** Must be 0. */
    uint32_t reserved0;
    /**
     * Heat that the glass gets from wires in it or from a blower, W/m^2: melts snow, once it outweighs what cold air
     * takes. A heated windscreen has some 600. Range [0, 3000], default 0.
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
    /** Drops that hit the pane in a second (rain from 0.1 mm of diameter). */
    double drops_per_s;
    /** Water that hits it, mm/h on its area. */
    double water_mm_h;
    /** Share of the pane under water, 0 to 1. */
    double covered;
    /** Water on it, kg. */
    double water_kg;
    /** Simulation time of the state, s. */
    double state_time_s;
    /** Water in the snow on it, kg. */
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
 * Sets the window that the view looks through; NULL removes it. If you drive, wipe or turn the camera, set it again
 * before each frame: the water stays on the glass as long as the glass keeps its size. Unchanged after an error. With
 * a window the stage LENS answers WK_ERROR_UNSUPPORTED for multisampled colour and for projections of parallel rays.
 * Thread: exclusive on the view.
 * Errors: WK_ERROR_INVALID_ARGUMENT naming the field and its range.
 */
WK_API wk_status wk_view_set_windscreen(wk_view *view, const wk_windscreen *windscreen);

/**
 * Gets how much water is on the view's windscreen as of its last frame, and how much lands on it. Reads the state back
 * and waits for the GPU: call it now and then, not in every frame. All 0 without a windscreen or before its first
 * frame.
 * Thread: exclusive on the view.
 * Errors: WK_ERROR_DEVICE_LOST.
 */
WK_API
wk_status wk_view_get_windscreen_report(wk_view *view,
                                        wk_windscreen_report *out_report);

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
 * The stage SURFACE reads the host's depth and draws water onto its picture. Wet ground is darker and mirrors the sky,
 * paved ground has puddles, and rain makes rings in them. Colours are right with WK_COLOR_SCENE_LINEAR; in the display
 * spaces Welkin takes the shown colour for the ground's own. Ground without a wk_surface_class is natural and hardly
 * mirrors: mark roads and yards as WK_SURFACE_CLASS_PAVED. Mirrors show the sky; of objects only shelters and occluder
 * maps appear in them, as dark shapes.
 *
 * Wetness follows the weather of the moment (wk_conditions.wetness, .puddles). With a wk_simulation_desc in
 * wk_context_desc.next it is a state that fills, drains and dries over time, and wk_context_save keeps it.
 * ====================================================================================================
 */

/**
 * Material of the ground. An image of the target (the byte of red) counts first, then the wk_ground_grid or the tiles
 * of the wk_terrain, then the context's default.
 */
typedef uint32_t wk_surface_class;

/**
 * In an image or a grid: the next source decides. As the context's default: natural ground, which is vegetation where
 * the host's colour is green and soil elsewhere.
 */
#define WK_SURFACE_CLASS_UNSPECIFIED 0
/** Earth, sand, gravel: darkens and hardly mirrors. */
#define WK_SURFACE_CLASS_SOIL 1
/** Bare rock: darkens, and shines in parts. */
#define WK_SURFACE_CLASS_ROCK 2
/** Asphalt, concrete, paving: darkens, gets a film that mirrors, and puddles. */
#define WK_SURFACE_CLASS_PAVED 3
/** Grass, crops, shrubs, trees: hardly changes. */
#define WK_SURFACE_CLASS_VEGETATION 4
/** Water that the host draws: rain leaves it as it is. */
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
    /** Depth of water there, mm, as tyres meet it: the film, plus standing water in a hollow. */
    double water_mm;
    /** Film on level ground outside hollows, mm; on the host's terrain the film at the place. */
    double film_mm;
    /** Wetness of all the ground, or of the place on the host's terrain: 0 dry, 0.3 damp, 1 under a closed film. */
    double wetness;
    /** Share of all the ground, or of the host's terrain, under standing water. */
    double puddles;
    /** 1 where standing water covers the place, else 0. Off the host's terrain only paved ground has puddles. */
    uint32_t in_puddle;
    /** 0. */
    uint32_t reserved0;
    /** Material of the ground there, by the host's terrain, else by the context's default. */
    wk_surface_class surface_class;
    /** 0. */
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
 * The weather of the moment: as reported, or as wet as the rain of the moment keeps it. When the rain ends, the ground
 * is dry.
 */
#define WK_GROUND_REPORTED 0
/**
 * A state that begins at simulation time 0 as wet as the weather has the ground then. Rain fills pores, film and
 * hollows; they drain and dry by wind, sun and humidity (Penman 1948) in steps of 10 s. A leap of more than a day is
 * simulated over its last day, which begins as wet as the weather has the ground then. See wk_context_update for leaps
 * that take more than one call.
 */
#define WK_GROUND_SIMULATED 1

/** Source of the lying snow. */
typedef uint32_t wk_lying_snow_model;

/** The weather of the moment: as deep as it reports (wk_conditions.snow_depth_m), everywhere. */
#define WK_LYING_SNOW_REPORTED 0
/**
 * A state that begins as deep as the weather reports. Snowfall fills it; it settles, drifts, slides, melts and
 * refreezes in steps of 60 s, on level, open ground and on each cell of the host's terrain
 * (wk_context_set_ground_grid). An update that moves time by more than a day is fast-forward
 * (wk_context_accumulate); of one of more than 30 days the last 30 count.
 */
#define WK_LYING_SNOW_SIMULATED 1

/** Simulated state of a context. An extension: put it into wk_context_desc.next. */
typedef struct wk_simulation_desc {
    /** sizeof(wk_simulation_desc) of your header. */
    uint32_t struct_size;
    /** WK_STRUCT_TYPE_SIMULATION_DESC. */
    wk_struct_type struct_type;
    /** The next extension. Default NULL. */
    const void *next;
    /** Default WK_GROUND_REPORTED. */
    wk_ground_model ground_model;
    /** Must be 0. */
    uint32_t reserved0;
    /** Default WK_LYING_SNOW_REPORTED. */
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
 * (wk_context_set_ground_grid, wk_context_set_terrain) and up to 3 m above it, the answer is that of its cells.
 * Elsewhere it is that of level, open ground with the hollows that are drawn, a pattern fixed to the world by the
 * context's seed.
 * Thread: concurrent.
 * Errors: WK_ERROR_INVALID_ARGUMENT for an invalid position.
 */
WK_API
wk_status wk_context_get_ground(const wk_context *context,
                                const double (*position_m)[3],
                                wk_ground *out_ground);

/**
 * Sets the class of ground for which neither the target's image nor the host's terrain has one. Default
 * WK_SURFACE_CLASS_UNSPECIFIED: natural ground. Part of the saved state.
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
 * Give the heights of your terrain on a grid, and Welkin computes wetness and puddles cell by cell. Rain areas and
 * standing boxes (wk_context_set_shelters) decide what falls where. Water runs off and fills the terrain's hollows
 * until they spill. wk_context_get_ground answers by place, the stage SURFACE draws the water, and
 * wk_context_get_ground_cells returns it for your own materials. With WK_GROUND_SIMULATED the water is a state, which
 * wk_context_save keeps together with the heights; else it is the weather's wetness, spread over the hollows.
 * ====================================================================================================
 */

/**
 * Heights of the host's terrain on a grid that is level and aligned to true north. Each node stands for the square
 * cell around it; water is linear between nodes. Outside lies the world's ground; the picture blends into it over two
 * cells.
 */
typedef struct wk_ground_grid {
    /** sizeof(wk_ground_grid) of your header. */
    uint32_t struct_size;
    /** WK_STRUCT_TYPE_GROUND_GRID. */
    wk_struct_type struct_type;
    /** No extensions in this version: NULL. */
    const void *next;
    /**
     * The node farthest to the south-west, in the host's world, m, within 1e12 m of the origin; heights count from its
     * own. Default 0, 0, 0.
     */
    double origin_m[3];
    /** Distance between nodes, m. Range [0.01, 10 000], default 1. Puddles need several cells. */
    double cell_m;
    /** Number of nodes east and north. Range 2 to 512, default 2, 2. */
    uint32_t nodes[2];
    /**
     * Heights above the origin, m, within 1e5. Nodes run from west to east, rows from south to north. Copied by the
     * call.
     */
    const float *heights_m;
    /** Numbers in heights_m: the product of `nodes`. */
    uint32_t height_count;
    /** Must be 0. */
    uint32_t reserved0;
    /**
     * Class of each cell, in the order of the heights: a wk_surface_class, or 0 to use the context's default. Copied
     * by the call. Default NULL: 0 for all cells.
     */
    const uint8_t *surface_classes;
    /** Numbers in surface_classes: 0 (the default), or height_count. */
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
 * Water of a cell of the host's terrain; plain values of a list. Packed, the list can be uploaded as a texture of four
 * floats.
 */
typedef struct wk_ground_cell {
    /** Film: water between and on the grains, mm; 0 under standing water. */
    float film_mm;
    /** Water in the pores, as a share of what they can hold. */
    float soaked;
    /** Standing water, mm. */
    float standing_mm;
    /** Share under ice, by the weather of the moment; freezing rain leaves none where standing boxes keep it off. */
    float ice;
} wk_ground_cell;

/**
 * Sets the heights of the host's terrain, in place of those before; NULL leaves level ground everywhere. Setting the
 * same grid again keeps its water, even with other classes; another grid begins as wet as level ground is. May take
 * some tenths of a second for the largest grids. Unchanged after an error.
 * Thread: exclusive.
 * Errors: WK_ERROR_INVALID_ARGUMENT naming the field and its range.
 */
WK_API wk_status wk_context_set_ground_grid(wk_context *context, const wk_ground_grid *ground_grid);

/**
 * Copies the water of the terrain's cells as of wk_context_get_state_time, in the order of the heights; `cell_size` is
 * sizeof(wk_ground_cell) of your header. `out_revision` gets a number that changes whenever the cells change, at most
 * once every 10 s of simulation time. With capacity 0 the call returns only this number, so you can skip uploads when
 * nothing has changed. Thread: concurrent. Errors: WK_ERROR_WRONG_ORDER without a terrain; WK_ERROR_INVALID_ARGUMENT
 * for a capacity other than 0 that is too small.
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
 * For the host's own materials: the water of the terrain's cells as one native texture, of a grid
 * (wk_context_set_ground_grid) uploaded once for the host and for the stage SURFACE, of tiles (wk_context_set_terrain)
 * those about a place. One texel for each cell, the first one south-west, rows to the north, in every graphics
 * interface. Published functions, GLSL and WGSL, compute how it looks.
 * ====================================================================================================
 */

/** The water of the terrain's cells on the GPU, of a grid or about a place on tiles. */
typedef struct wk_ground_texture {
    /** sizeof(wk_ground_texture) of your header. */
    uint32_t struct_size;
    /** WK_STRUCT_TYPE_GROUND_TEXTURE. */
    wk_struct_type struct_type;
    /** No extensions in this version: NULL. */
    const void *next;
    /**
     * RGBA half floats, an OpenGL texture name (GL_TEXTURE_2D) or a VkImage (VK_FORMAT_R16G16B16A16_SFLOAT): film_mm,
     * soaked, standing_mm and ice of wk_ground_cell, each within 1/2048 of its value, standing water up to 65 504 mm.
     * Where none stands, standing_mm is negative: the depth of its hollow's level below the ground, mm, or -50 where
     * the hollow is dry. So a shore between texels lies where it crosses 0.
     */
    uint64_t texture;
    /**
     * Changes whenever `texture` becomes another object, whatever its name: after another grid was set or loaded.
     */
    uint64_t generation;
    /** Revision of the texture's contents, as in wk_context_get_ground_cells. */
    uint64_t revision;
    /** Texels: the grid's nodes east and north. */
    uint32_t width;
    /** Texels: the grid's nodes east and north. */
    uint32_t height;
    /**
     * Two rows of a matrix: multiplied by (x, y, z, 1) of a place in the host's world, m, they give its u and v.
     * (0, 0) is the south-western corner of the first texel. Single precision is enough once the fourth column
     * includes the camera's position.
     */
    double uv_from_world[2][4];
    /**
     * The snow on the same grid, an object like `texture`: depth_m, density_kg_m3, wetness and albedo of
     * wk_lying_snow. 0 without WK_LYING_SNOW_SIMULATED. It changes at most once every 60 s of simulation time.
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
 * Gets the native texture of the terrain's water, up to date: call it after each wk_context_update. It costs nothing
 * if nothing has changed. Changes come at most once every 10 s of simulation time; this call, or a wk_view_record with
 * SURFACE, uploads them in order with the host's work on the device's queue or context. The texture belongs to the
 * context and stays the same until another grid, or none, is set or loaded: wait for the GPU's work that samples it
 * before that. In Vulkan it is in VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL between calls, and you may copy from it. It
 * has no mipmaps; choose filter and wrap yourself. Thread: exclusive. Errors: WK_ERROR_WRONG_ORDER without a terrain;
 * WK_ERROR_UNSUPPORTED on an own device, which has no shaders of the host's.
 */
WK_API
wk_status wk_context_get_ground_texture(wk_context *context,
                                        wk_ground_texture *out_texture);

/**
 * Gets the native textures of the tiles about a place, up to date, as wk_context_get_ground_texture does those of a
 * grid: a window of 512 x 512 cells, which has `center_m` in its middle quarter and moves by 64 cells at a time.
 * `uv_from_world` is where it is now; where no tile has ground there is neither water nor snow. Call it after each
 * wk_context_update, and for several cameras before you draw each. It costs nothing if nothing has changed; all of it
 * is uploaded where the window has moved. Both textures stay the same as long as the context lives. Thread: exclusive.
 * Errors: WK_ERROR_INVALID_ARGUMENT for a place that is none; WK_ERROR_WRONG_ORDER where no tile reaches into the
 * window; WK_ERROR_UNSUPPORTED on an own device, which has no shaders of the host's.
 */
WK_API
wk_status wk_context_get_terrain_texture(wk_context *context,
                                         const double (*center_m)[3],
                                         wk_ground_texture *out_texture);

/**
 * Gets the text of the functions that compute how a place of the texture looks: how dark, how much of it mirrors, how
 * rough. NUL-terminated UTF-8 that lives as long as the process.
 * Thread: any.
 */
WK_API wk_status wk_get_ground_snippet(wk_shading_language language, const char **out_text);

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
 * The stage SURFACE draws snow onto what the host drew, as deep as the weather reports it (wk_surface.snow_depth_m):
 * patches first, then whole, on what faces up. With WK_LYING_SNOW_SIMULATED in a wk_simulation_desc the snow is a
 * state: it falls, settles, drifts, slides, melts into the ground's water and refreezes, on level, open ground and on
 * each cell of the host's terrain (wk_context_set_ground_grid, wk_context_set_terrain), and wk_context_save keeps it.
 * Standing boxes (wk_context_set_shelters) keep it off and cast drifts.
 * ====================================================================================================
 */

/** How a wheel holds on the ground, as far as snow decides it. */
typedef uint32_t wk_snow_friction;

/** No snow, or too little to matter. */
#define WK_SNOW_FRICTION_BARE 0
/** Loose, dry snow. */
#define WK_SNOW_FRICTION_LOOSE 1
/** Snow above 350 kg/m^3: pressed, or packed by wind. */
#define WK_SNOW_FRICTION_PACKED 2
/** Slush: more than half of the water that it can hold. */
#define WK_SNOW_FRICTION_SLUSH 3
/** Above 650 kg/m^3: frozen hard. */
#define WK_SNOW_FRICTION_ICE 4

/** Snow at a place; plain values of a list. */
typedef struct wk_lying_snow {
    /** Depth, m. */
    double depth_m;
    /** Ice and water, kg/m^2: millimetres of water. */
    double mass_kg_m2;
    /** kg/m^3; 0 without snow. */
    double density_kg_m3;
    /** Held water over what the snow can hold, 0 to 1. */
    double wetness;
    /** Albedo of visible light; 0 without snow. */
    double albedo;
    /** Share of the ground that it covers. */
    double cover;
    /**
     * The place above or below the one asked for on the snow's surface, in the host's world: the terrain's height
     * raised by the snow. Off the host's terrain the place itself.
     */
    double surface_m[3];
    /** How a wheel holds. */
    wk_snow_friction friction;
    /** 0. */
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
     * The path's points in the host's world, m, within 1e12 m of the origin; their heights do not matter. The path's
     * ends are cut straight, its bends are round. Read during the call.
     */
    const double (*points_m)[3];
    /** Number of points. Range 2 to 1024. */
    uint32_t point_count;
    /** Must be 0. */
    uint32_t reserved0;
    /** From side to side, m. Range [0.01, 1000], default 1. */
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
 * the host's terrain and up to 3 m above it, the answer is that between its cells, elsewhere that of level, open
 * ground. `position_size` and `snow_size` are the bytes from one element to the next: 24 or more, and
 * sizeof(wk_lying_snow) of your header.
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
 * Takes the snow of a strip of the host's terrain away, but for the lowest `left_m` (range [0, 100]): a plough, a
 * shovel. `out_mass_kg` gets what was taken and may be NULL.
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
 * Presses the snow of a strip of the host's terrain to 500 kg/m^3 where it is less dense: a wheel's track.
 * Thread: exclusive.
 * Errors: as wk_context_take_snow.
 */
WK_API wk_status wk_context_press_snow(wk_context *context, const wk_snow_strip *strip);

/**
 * Moves time on by `hours`, in (0, 720], and lays the snow of that time by steps of ten minutes, so that a lesson may
 * begin after a night's snowfall. The laws are those of ordinary steps; the state differs from theirs by up to some
 * percent and remembers that it was laid so (wk_context_state_hash). All else is led as by wk_context_update, to the
 * end: with the largest terrain this may take some seconds.
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
 * The host's terrain as a lattice of equal cells, level and aligned to true north at its origin, cut into square tiles
 * with keys. Each cell has a height and a class of surface, or is a hole. Tiles are added, removed, and changed by
 * rectangles, in time that grows with the rectangle: a bucket may dig in every frame. Water, the wind field and
 * queries read the tiles. With WK_GROUND_SIMULATED each cell has water of its own, and hollows join across the borders
 * of tiles; with WK_GROUND_REPORTED tiles are as wet as level ground. A context has tiles or one wk_ground_grid.
 *
 * Heights belong to the host: wk_context_save keeps the water of the tiles, and wk_context_load wants the same tiles
 * set before. wk_context_set_terrain and the functions of tiles may be called between updates at any time; while steps
 * remain (WK_PENDING) they act after these.
 * ====================================================================================================
 */

/** In surface_classes of wk_terrain_cells: a cell without ground. Water beside it runs off. */
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
     * The south-western cell of tile (0, 0), in the host's world, m, within 1e12 m of the origin; heights count from
     * its own. Default 0, 0, 0.
     */
    double origin_m[3];
    /** Distance between cells, m. Range [0.01, 10 000], default 1. Puddles need several cells. */
    double cell_m;
    /**
     * Cells along each side of a tile: a power of two from 32 to 1024. Default 256. The tiles of a terrain may have
     * 16 777 216 cells together.
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
     * Key of the tile: how many tiles it lies east and north of the origin, each within 1 000 000; negative to the
     * west and south. Default 0, 0.
     */
    int32_t tile[2];
    /** The rectangle's south-western cell in the tile, east and north. Default 0, 0. */
    uint32_t first_cell[2];
    /** Cells of the rectangle east and north. Default 0, 0: all of the tile. */
    uint32_t cells[2];
    /**
     * Heights above the terrain's origin, m, within 1e5. Copied by the call. NULL with a count of 0 leaves them as
     * they are; a new tile needs them. That of a hole may be anything, also NaN: what is no height is not read.
     */
    const float *heights_m;
    /** Numbers in heights_m, at least as many as the rectangle reaches over. */
    uint32_t height_count;
    /**
     * Numbers from the beginning of a row in heights_m to that of the next. Default 0: rows follow without a gap.
     */
    uint32_t height_stride;
    /**
     * Class of each cell: a wk_surface_class, 0 to use the context's default, or WK_TERRAIN_HOLE. Copied by the call.
     * NULL with a count of 0 leaves them as they are; in a new tile 0.
     */
    const uint8_t *surface_classes;
    /** Numbers in surface_classes, at least as many as the rectangle reaches over. */
    uint32_t surface_class_count;
    /**
     * Numbers from the beginning of a row in surface_classes to that of the next. Default 0: rows follow without a
     * gap.
     */
    uint32_t surface_class_stride;
    /** 1 where no_data_m counts, else 0, the default: every number in heights_m is a height. */
    uint32_t has_no_data;
    /**
     * Stands in heights_m for cells of which there are no data, and NaN then does too: -9999, -32768, or what your
     * source has. These cells become holes, whatever surface_classes says of them but a class of ground; a hole
     * becomes ground again by its class. Must be no height in use: of no cell to which surface_classes gives a class
     * other than 0, and of no cell with ground beside the rectangle in its tile. Default 0.
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

/** The terrain under a place; plain values of a list. */
typedef struct wk_terrain_point {
    /** Height of the ground above the terrain's origin, m, linear between cells; 0 where there is none. */
    double height_m;
    /** Revision of the nearest cell's tile: the terrain's when it changed last. 0 where there is no ground. */
    uint64_t revision;
    /** Key of that tile. */
    int32_t tile[2];
    /** Material of the nearest cell; WK_SURFACE_CLASS_UNSPECIFIED where none is given. */
    wk_surface_class surface_class;
    /** 1 on the ground of a tile, else 0. */
    uint32_t has_ground;
} wk_terrain_point;

/**
 * Sets the lattice of a terrain in tiles, still without any, in place of the tiles or the wk_ground_grid before; NULL
 * leaves no tiles. The lattice that is set already stays with its tiles. Unchanged after an error.
 * Thread: exclusive.
 * Errors: WK_ERROR_INVALID_ARGUMENT naming the field and its range.
 */
WK_API wk_status wk_context_set_terrain(wk_context *context, const wk_terrain *terrain);

/**
 * Adds a tile, or gives all cells of one that is there other values. A new tile begins as wet as level ground is; one
 * that is there keeps its water. Takes some tens of milliseconds for 256 x 256 cells. Unchanged after an error.
 * Thread: exclusive.
 * Errors: WK_ERROR_WRONG_ORDER before wk_context_set_terrain; WK_ERROR_INVALID_ARGUMENT naming the field, or for more
 * cells than a terrain may have.
 */
WK_API wk_status wk_context_set_terrain_tile(wk_context *context, const wk_terrain_cells *terrain_cells);

/**
 * Gives a rectangle of a tile's cells other heights, other classes, or both. Water that stands there runs where the
 * ground lets it: off a raised floor, into a new pit. The time grows with the rectangle and with the standing water
 * that it touches, not with the tile or the terrain. Unchanged after an error. Thread: exclusive. Errors: as
 * wk_context_set_terrain_tile, and for the key of no tile.
 */
WK_API wk_status wk_context_update_terrain(wk_context *context, const wk_terrain_cells *terrain_cells);

/**
 * Takes a tile away with the water on it. Where it was, water of the other tiles runs off.
 * Thread: exclusive.
 * Errors: WK_ERROR_WRONG_ORDER before wk_context_set_terrain; WK_ERROR_INVALID_ARGUMENT for the key of no tile.
 */
WK_API wk_status wk_context_remove_terrain_tile(wk_context *context, int32_t tile_east, int32_t tile_north);

/**
 * Gets a number that grows whenever the tiles change; 0 without a terrain.
 * Thread: concurrent.
 */
WK_API wk_status wk_context_get_terrain_revision(const wk_context *context, uint64_t *out_revision);

/**
 * Gets the terrain's tiles under or above places of the host's world, at most wk_caps.max_batch of them.
 * `position_size` and `point_size` are the bytes from one element to the next: 24 or more, and
 * sizeof(wk_terrain_point) of your header. Thread: concurrent.
 */
WK_API
wk_status wk_context_get_terrain_points(const wk_context *context,
                                        const double (*positions_m)[3],
                                        uint32_t count,
                                        uint32_t position_size,
                                        wk_terrain_point *points,
                                        uint32_t point_size);

/**
 * Copies the water of a tile's cells as of wk_context_get_state_time, by rows from the south-west; `cell_size` is
 * sizeof(wk_ground_cell) of your header. Holes are dry. `out_revision` gets a number that changes whenever water on
 * the terrain changes; with capacity 0 the call returns only this number. Thread: concurrent. Errors:
 * WK_ERROR_INVALID_ARGUMENT for the key of no tile, or a capacity other than 0 that is too small.
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
 * Writes the default of every field: the same bytes as `WK_TERRAIN_CELLS_INIT`. `struct_size` is `sizeof(wk_terrain_cells)`
 * as the caller was compiled, and is stored in the struct.
 */
WK_API
wk_status wk_terrain_cells_init(wk_terrain_cells *out,
                                uint32_t struct_size);

#ifdef __cplusplus
} /* extern "C" */
#endif

#endif /* WELKIN_H */
