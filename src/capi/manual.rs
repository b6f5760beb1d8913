//! Welkin: weather for simulators, drawn into the host's own picture.
//!
//! This header is the whole C API, in reading order; CONTENTS below names its sections. It compiles as C99 or C++11,
//! and as later versions of both. welkin.hpp wraps it for C++.
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
//!         wk_view_record(view, &frame, WK_STAGE_ALL);        sky behind it, fog and air in front of it
//! ```
//!
//! OWNERSHIP
//!
//! wk_x_create writes a new handle to its out-parameter, on success only. wk_x_destroy(handle) destroys the object;
//! NULL does nothing. Destroy children before parents: a device has contexts, surfaces and textures, a context has
//! views. Destroying a parent with live children gives WK_ERROR_IN_USE. A handle looks like a pointer but is a number,
//! and Welkin never dereferences it: a handle that is dead, foreign or of another kind gives WK_ERROR_BAD_HANDLE.
//! Structs, texts and lists that you pass in stay yours; Welkin reads them during the call only. How long a returned
//! text stays valid is stated at its function. Native objects (windows, OpenGL names, Vulkan handles) stay the host's.
//!
//! ERRORS
//!
//! Every call that can fail returns a wk_status: 0 and positive values mean success, negative ones failure. A failed
//! call writes no output, changes nothing and draws nothing. Only a list that does not fit into its buffer is an
//! exception: the call fails, but still writes the number of elements or bytes needed. wk_last_error_message() has the
//! calling thread's message, which names the parameter and what is accepted, as in `wk_view_record: frame.projection[5]
//! must be finite, got NaN`; wk_last_error_field() has `frame.projection[5]` alone. Welkin never aborts, prints or
//! throws. If a fault in Welkin itself is caught, the call returns WK_ERROR_INTERNAL. After that, every call on the
//! device returns WK_ERROR_POISONED, except those that destroy.
//!
//! STRUCTS
//!
//! Structs begin with struct_size, struct_type and next. Some structs are elements of arrays that calls read or fill in
//! bulk, such as wk_flash. They have no such head: the call takes their sizeof. Start from WK_X_INIT (or wk_x_init,
//! which writes the same bytes) and change fields. Later versions append fields for which zero means "as before". A
//! library therefore accepts structs of older headers, whose missing fields get their defaults, and structs of newer
//! headers if the fields that it does not know are zero. `next` points to extension structs, of the types that a call
//! names; an extension of another type is refused. Reserved fields must be 0. Zero is a value (0 degrees, north, calm),
//! never "default". An optional field has a bit in `has`, which you set together with the field. Lists are (pointer,
//! count, stride): stride is the size of an element in your header. Reals are doubles, or floats in some fields and
//! lists, and must be finite. Texts are NUL-terminated UTF-8. Sizes are in bytes.
//!
//! THREADS
//!
//! You may call functions from any thread. The line "Thread:" of a function says which calls may run at the same time.
//! "any": no rule. "concurrent": the handle is a `const T *`, and any number of such calls may use it at the same time.
//! "exclusive": the handle is a `T *`; make one call at a time with it, and no concurrent call with it at the same
//! time. "exclusive on the view" names the handle. Calls that break this rule wait for each other. Welkin starts no
//! threads. With an OpenGL host, make all calls that draw, create or destroy on the thread where its context is (or can
//! be made) current; what you destroy on another thread is released at the device's next call. Call no Welkin function
//! inside a callback: it would return WK_ERROR_WRONG_ORDER.
//!
//! UNITS AND COORDINATES
//!
//! Units are SI. A field's name ends in its unit (_m, _s, _mm_h). Angles that people usually state in degrees are in
//! degrees (_deg); angles without a unit in their names are in radians. Azimuths are clockwise from true north; wind
//! direction is where the wind comes from. Positions are in the host's world, in double precision, however far from its
//! origin. See Contexts for world frames and Frames for matrices, depth and clip space. Colours are linear Rec. 709
//! unless they say otherwise.
//!
//! DETERMINISM
//!
//! On every machine, the same description, timeline, seed and time give the same world. Channels of one simulator with
//! the same input agree; wk_context_state_hash lets them check that. Changes of weather have absolute times. Pictures
//! are bit-identical from run to run on one driver; between drivers the last bits differ.
//!
//! WHAT COMES LATER, AND HOW
//!
//! Before 1.0 a minor version may change this header; from 1.0 on, numbers, names and layouts never change within a
//! major version, and later versions add new ones. These points are settled for planned features, so that a host can
//! prepare:
//! - Snow in rain areas will be wk_rain_area.snow.
//! - Images of base colour and motion will be appended to the target structs.
//! - Callbacks for memory and files will be extensions of wk_device_desc through `next`.
//!
//! A field, a bit or a value that this version does not draw yet is refused by name where it is set.
//!
//! CONTENTS
//!
//! Each section begins with its name in brackets. The name stays the same from version to version: search for it.
