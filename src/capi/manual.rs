//! Welkin: weather for simulators, drawn into the host's own picture.
//!
//! This header is the whole C API, in reading order: status, devices, the kinds of host (own, window, OpenGL, Vulkan),
//! weather, contexts, queries, frames, views. It is C99 and C++11 and later; welkin.hpp wraps it for C++.
//!
//! IN SHORT
//!
//! ```text
//!     wk_device *device = NULL; wk_context *context = NULL; wk_view *view = NULL;
//!     wk_device_create(NULL, &device);                       or ..._create_opengl, ..._create_vulkan
//!     wk_context_create(device, NULL, &context);             weather, time and place
//!     wk_view_create(context, NULL, &view);                  one camera
//!     wk_context_set_weather(context, &weather, 0.0, 0.0);   from a METAR report, a preset or your own figures
//!     each frame:
//!         wk_context_update(context, time_s);
//!         ... the host draws its world ...
//!         wk_view_record(view, &frame, WK_STAGE_ALL);        sky behind it, fog and air before it
//! ```
//!
//! OWNERSHIP
//!
//! wk_x_create writes a new handle to its out-parameter, on success only; wk_x_destroy(handle) ends it, and NULL does
//! nothing. Children go before parents: a device has contexts, surfaces and textures, a context has views; a parent with
//! live children answers WK_ERROR_IN_USE. A handle is a number in pointer's clothing and is never followed: one that is
//! dead, foreign or of another kind gives WK_ERROR_BAD_HANDLE.
//! Structs, texts and lists that are passed in are the caller's and are read during the call only. Texts that come back
//! live as long as their function says. Native objects (windows, OpenGL names, Vulkan handles) stay the host's.
//!
//! ERRORS
//!
//! Every call answers a wk_status: 0 or more is an answer, less than 0 a failure. After a failure no output was written
//! and nothing was changed or drawn; wk_last_error_message() has the calling thread's sentence, which names the parameter
//! and what is accepted, as in `wk_view_record: frame.projection[5] must be finite, got NaN`. Nothing aborts, prints or
//! throws. A fault inside Welkin is caught and answers WK_ERROR_INTERNAL; its device answers WK_ERROR_POISONED from then
//! on, and only destroying works.
//!
//! STRUCTS
//!
//! Structs begin with struct_size, struct_type and next; start from WK_X_INIT (or wk_x_init, which writes the same bytes)
//! and change fields. Later versions append fields whose zero means "as before": a library takes the structs of older
//! headers and fills in defaults, and those of newer ones if what it does not know is zero. `next` leads to extension
//! structs where a call names them; an unknown one is refused. Reserved fields must be 0.
//! Zero is a value (0 degrees, north, calm), never "default"; what may be left out has a bit in `has`.
//! Lists are (pointer, count, stride): stride is the size of an element in your header.
//! Reals are doubles and must be finite. Texts are NUL-terminated UTF-8. Sizes are in bytes.
//!
//! THREADS
//!
//! Functions may be called from any thread. `const T *` may be shared: any number of calls with it at the same time.
//! `T *` is exclusive: one call at a time with that handle, and none with its `const` beside it; calls that break this
//! wait for each other. Welkin starts no threads. With an OpenGL host all calls that draw, create or destroy go to
//! the thread on which its context is (or can be made) current; what is destroyed on another is released at the device's
//! next call. Inside a callback no Welkin function may be called: it would answer WK_ERROR_WRONG_ORDER.
//!
//! UNITS AND COORDINATES
//!
//! SI units; a field's name ends in its unit unless that is metres, seconds or radians. Angles that people name are in
//! degrees (_deg). Azimuths are clockwise from true north; wind direction is where the wind comes from.
//! Positions are in the host's world in double precision, however far from its origin; see Contexts for world frames and
//! Frames for matrices, depth and clip space. Colours are linear Rec. 709 unless they say otherwise.
//!
//! DETERMINISM
//!
//! The same description, timeline, seed and time give the same world on every machine: channels of one simulator agree
//! when they are told the same, and wk_context_state_hash lets them compare. Changes of weather carry absolute times.
//! Pictures are bit-identical from run to run on one driver; drivers differ in the last bits.
//!
//! WHAT COMES LATER, AND HOW
//!
//! Numbers, names and layouts here never change within a major version; new ones are added. For the effects that follow,
//! so that a host can plan for them:
//! terrain, with tiles that a digging host updates by rectangle, holes and soil materials, is a new child of the context with
//! its own functions; material ids, normals, base colour and motion are images appended to the target structs; bodies of water
//! are new functions of the context; allocator and file callbacks and the star sky's matrix come as extensions of
//! wk_device_desc and wk_context_desc through `next`; snow falls in the stage PARTICLES, as rain does.
