/*
 * Welkin: weather drawn into a simulator's own picture.
 *
 * (The article is written when the interface stands.)
 */
#ifndef WELKIN_H
#define WELKIN_H

#include <stddef.h>
#include <stdint.h>

/** Version of this header; `wk_version` gives the library's. */
#define WK_VERSION_MAJOR 0
#define WK_VERSION_MINOR 1
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
 * Status, versions, messages
 *
 * Every call answers a wk_status. 0 and positive values are answers; negative ones are failures, after which no
 * output was written and wk_last_error_message() says which parameter was wrong and what would have been accepted.
 * ====================================================================================================
 */

/** What a call answers. The numbers never change and are never reused. */
typedef int32_t wk_status;

/** The call did what it says. */
#define WK_OK 0
/** More steps are due than one update may take; call again. Not a failure. */
#define WK_PENDING 1
/** A parameter is missing, not finite or outside its range; the message names it. */
#define WK_ERROR_INVALID_ARGUMENT (-1)
/** A handle is NULL, destroyed, foreign or of another kind. */
#define WK_ERROR_BAD_HANDLE (-2)
/** A parent was to be destroyed while it has live children, or the handle is in another call at this moment. */
#define WK_ERROR_IN_USE (-3)
/** This device, tier or build cannot do what was asked; the message names the feature. */
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
/** Calls came in an order that the API forbids: stages of a frame, dates before the last update. */
#define WK_ERROR_WRONG_ORDER (-13)
/** The host aborted a long operation through its callback. */
#define WK_ERROR_ABORTED (-14)
/** A fault inside Welkin; the message says where. */
#define WK_ERROR_INTERNAL (-15)

/** How grave a message is. */
typedef uint32_t wk_log_level;

/** Something failed; the call also answers so. */
#define WK_LOG_LEVEL_ERROR 1
/** Something works worse than it could: a fallback, a slow path. */
#define WK_LOG_LEVEL_WARNING 2
/** Once-in-a-while news: which adapter, which plan. */
#define WK_LOG_LEVEL_INFO 3
/** For those who develop Welkin. */
#define WK_LOG_LEVEL_DEBUG 4

/**
 * Receives a message, NUL-terminated UTF-8 that is valid during the call. It may come from any thread that is in a
 * Welkin call; it must not call Welkin and must not unwind.
 */
typedef void (*wk_log_fn)(void *user, wk_log_level level, const char *message);

/** Which struct a pointer leads to: the second field of every tagged struct. WK_X_INIT sets it. */
typedef uint32_t wk_struct_type;

/** wk_device_desc */
#define WK_STRUCT_TYPE_DEVICE_DESC 1
/** wk_caps */
#define WK_STRUCT_TYPE_CAPS 2

/**
 * The name of a status, such as "WK_ERROR_BAD_HANDLE"; "unknown status" for other numbers. Never NULL, never freed.
 */
WK_API const char *wk_status_name(wk_status status);

/**
 * What the last failed call of the calling thread says: one sentence that begins with the function's name and names
 * the parameter and the accepted range. Empty before the first failure; successful calls leave it alone. Never NULL;
 * valid until the next failing call of this thread.
 */
WK_API const char *wk_last_error_message(void);

/**
 * The library's version, as WK_VERSION_MAJOR, _MINOR and _PATCH are the header's. A library of the same major version
 * and at least the header's minor one serves it. Each of the three may be NULL.
 */
WK_API wk_status wk_version(uint32_t *major, uint32_t *minor, uint32_t *patch);

/**
 * Sends Welkin's messages, and its graphics layer's warnings and errors, to `callback` from now on; NULL stops them.
 * They are off until a host asks. Nothing is ever printed. One callback a process; `max_level` is the least grave
 * level that is sent. If `callback` fails it must return normally: Welkin ignores it.
 * Errors: WK_ERROR_INVALID_ARGUMENT for an unknown level; WK_ERROR_IN_USE in a Rust program that has its own logger.
 */
WK_API wk_status wk_set_log_callback(wk_log_fn callback, void *user, wk_log_level max_level);

/*
 * ====================================================================================================
 * Devices
 *
 * A wk_device is one native queue or OpenGL context and everything on it that contexts share: pipelines, tables,
 * caches. It comes from one of four places: made here (below), round the host's OpenGL context, round the host's
 * Vulkan device, or, in Rust, from the host's wgpu device. All later calls are the same for all of them.
 *
 * Make one device per native queue or context: a second one answers WK_ERROR_ALREADY_WRAPPED. When the GPU is lost
 * (driver reset, unplugged) every call answers WK_ERROR_DEVICE_LOST: destroy the views, contexts and the device,
 * create them anew, and load the state that was saved.
 * ====================================================================================================
 */

/** A native queue or OpenGL context. Parent of contexts, surfaces and textures. */
typedef struct wk_device wk_device;

/** Native graphics interfaces. */
typedef uint32_t wk_backend_flags;

/** Draws nothing and needs no GPU: for tests of the host's own code. */
#define WK_BACKEND_NOOP 1
/** Vulkan. */
#define WK_BACKEND_VULKAN 2
/** Metal. */
#define WK_BACKEND_METAL 4
/** Direct3D 12. */
#define WK_BACKEND_DX12 8
/** OpenGL or OpenGL ES. */
#define WK_BACKEND_GL 16
/** Whatever serves, the best first. */
#define WK_BACKEND_ANY 30

/** Choices for an own device. */
typedef uint32_t wk_device_flags;

/** Use no compute shaders even where there are any: draws as on an OpenGL 3.3 machine. */
#define WK_DEVICE_FORCE_TIER0 1
/** Take the software driver. */
#define WK_DEVICE_FORCE_SOFTWARE 2

/** How to make an own device. */
typedef struct wk_device_desc {
    /** sizeof(wk_device_desc) of your header. */
    uint32_t struct_size;
    /** WK_STRUCT_TYPE_DEVICE_DESC. */
    wk_struct_type struct_type;
    /** No extensions in this version: NULL. */
    const void *next;
    /** Which native interfaces may serve. Default WK_BACKEND_ANY. */
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

/** What a device can do. */
typedef struct wk_caps {
    /** sizeof(wk_caps) of your header. */
    uint32_t struct_size;
    /** WK_STRUCT_TYPE_CAPS. */
    wk_struct_type struct_type;
    /** No extensions in this version: NULL. */
    const void *next;
    /** The one native interface that serves it. */
    wk_backend_flags backend;
    /**
     * 0: no compute (OpenGL 3.3 to 4.2, OpenGL on macOS). 1: compute. What needs tier 1 answers WK_ERROR_UNSUPPORTED
     * by name on tier 0.
     */
    uint32_t tier;
    /** 1 if the driver computes on the CPU, else 0. */
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
 * Makes an own device, without a window. `desc` NULL means WK_DEVICE_DESC_INIT. On success `*out` is a new handle that
 * the caller must give to `wk_device_destroy`; else it is not touched.
 * Thread: any.
 * Errors: WK_ERROR_NO_ADAPTER if no driver serves the request; WK_ERROR_INVALID_ARGUMENT by name.
 */
WK_API
wk_status wk_device_create(const wk_device_desc *desc,
                           wk_device **out_device);

/**
 * Destroys a device. NULL does nothing.
 * Thread: for a device round an OpenGL context, the thread on which it was created; else any.
 * Errors: WK_ERROR_IN_USE while it has contexts, surfaces or textures.
 */
WK_API wk_status wk_device_destroy(wk_device *device);

/**
 * WK_OK while the device works, WK_ERROR_DEVICE_LOST or WK_ERROR_POISONED when it no longer does.
 * Thread: any, at any time.
 */
WK_API wk_status wk_device_get_status(const wk_device *device);

/**
 * Says what a device can do. The two texts in the answer live as long as the device.
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

#ifdef __cplusplus
} /* extern "C" */
#endif

#endif /* WELKIN_H */
