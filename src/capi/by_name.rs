//! Structs and calls of the C interface by their names, for tools that are made from the header. Not part of the API.
//!
//! A tool keeps a struct as bytes, finds its fields in a table, and hands the bytes to the call that takes them. The
//! tool thus sets what a C host sets, by the same checks.

use std::{
    ffi::{CStr, CString, c_char},
    ptr::{null, null_mut},
    sync::Arc,
};

use super::{
    area,
    boundary::{
        Host, handles,
        layout::{self, FieldKind, STRUCTS, StructInfo},
        objects::{ViewObject, wk_context, wk_device, wk_view},
    },
    clouds, context, device, fog_law, light, lightning, plan, rain, region, report, sea, sky, snow, stars, status,
    terrain, timeline, view, weather, wind_field, windscreen,
};
use crate::{context::Context, frame::View, gpu::Device};

/// Bytes of a struct, aligned for every struct.
pub type StructBytes = Vec<u64>;

/// Refusal of a call.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Refusal {
    /// Sentence for the user, without the name of the call.
    pub message: String,
    /// Field that is wrong, as the header names it; may be empty.
    pub field: String,
}

/// Kind of a field.
#[derive(Clone, Copy, Debug)]
pub enum NamedKind {
    /// An integer, with its size in bytes.
    Integer(usize),
    /// A float, with its size in bytes.
    Float(usize),
    /// A constant or, if `union`, a union of constants.
    Choice {
        /// Bytes of the number.
        bytes: usize,
        /// Whether any union of the constants is accepted.
        union: bool,
        /// Names and numbers of the constants.
        values: &'static [(&'static str, u64)],
    },
    /// A pointer, which a tool cannot set.
    Pointer,
    /// A struct by value.
    Struct(&'static str),
}

/// Field of a struct.
#[derive(Clone, Copy, Debug)]
pub struct NamedField {
    /// Name.
    pub name: &'static str,
    /// Offset in the struct, bytes.
    pub offset: usize,
    /// Number of elements.
    pub count: usize,
    /// Kind of an element.
    pub kind: NamedKind,
    /// Range that the documentation states, such as `[0, 1]`; may be empty.
    pub range: &'static str,
}

fn info(name: &str) -> Option<&'static StructInfo> {
    STRUCTS.iter().find(|s| s.name == name).copied()
}

fn kind(kind: FieldKind) -> NamedKind {
    match kind {
        FieldKind::F32 | FieldKind::F64 => NamedKind::Float(kind.size()),
        FieldKind::Pointer => NamedKind::Pointer,
        FieldKind::Struct(info) => NamedKind::Struct(info.name),
        FieldKind::Enum(e) => NamedKind::Choice { bytes: kind.size(), union: e.flags, values: e.values },
        _ => NamedKind::Integer(kind.size()),
    }
}

/// Returns the fields of a struct that begins with struct_size, without the three fields of its head; `None` for an
/// unknown name.
pub fn fields(name: &str) -> Option<Vec<NamedField>> {
    let own = info(name)?.fields.iter().skip(3);
    let field =
        own.map(|f| NamedField { name: f.name, offset: f.offset, count: f.count, kind: kind(f.kind), range: f.range });
    Some(field.collect())
}

/// Returns a struct with every field at its default; `None` for an unknown name and for a struct without struct_size.
pub fn default_of(name: &str) -> Option<StructBytes> {
    let info = info(name).filter(|info| info.has_init)?;
    let mut bytes = vec![0; info.size.div_ceil(size_of::<u64>())];
    // SAFETY: `bytes` is writable and holds the struct.
    let done = unsafe { layout::init_by_name(name, bytes.as_mut_ptr().cast(), info.size as u32) };
    (done == status::WK_OK).then_some(bytes)
}

/// Returns a copy of a struct's bytes that a call may read. The copy has the head of the default struct, and its
/// pointers are NULL.
fn sealed(name: &str, bytes: &[u64]) -> Result<StructBytes, Refusal> {
    let refused = |message: String| Refusal { message, field: String::new() };
    let (info, default) =
        info(name).zip(default_of(name)).ok_or_else(|| refused(format!("there is no struct {name}")))?;
    if bytes.len() != default.len() {
        return Err(refused(format!("{name} has {} words, got {}", default.len(), bytes.len())));
    }
    let mut sealed = bytes.to_vec();
    sealed[..2].copy_from_slice(&default[..2]);
    for field in info.fields.iter().filter(|f| matches!(f.kind, FieldKind::Pointer)) {
        let word = field.offset / size_of::<u64>();
        sealed[word..word + field.count].fill(0);
    }
    Ok(sealed)
}

/// Returns the last refusal of this thread.
fn refusal() -> Refusal {
    let text = |p: *const c_char| {
        // SAFETY: the thread's last texts, which are strings and live until its next failing call.
        unsafe { CStr::from_ptr(p) }.to_string_lossy().into_owned()
    };
    let message = text(status::wk_last_error_message());
    let message = message.split_once(": ").map_or(message.clone(), |(_, sentence)| sentence.to_owned());
    Refusal { message, field: text(status::wk_last_error_field()) }
}

fn done(status: status::wk_status) -> Result<(), Refusal> {
    if status >= status::WK_OK { Ok(()) } else { Err(refusal()) }
}

/// A weather in the structs of C: the weather itself, its overrides if there are any, and its cloud layers.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct NamedWeather {
    /// Bytes of a `wk_weather`.
    pub weather: StructBytes,
    /// Bytes of a `wk_weather_overrides`.
    pub overrides: Option<StructBytes>,
    /// Bytes of each `wk_cloud_layer`.
    pub layers: Vec<StructBytes>,
}

/// Most cloud layers of a weather.
const LAYERS: usize = crate::weather::MAX_CLOUD_LAYERS;

impl NamedWeather {
    fn filled(
        text: &str,
        fill: impl Fn(*const c_char, *mut weather::wk_cloud_layer, *mut weather::wk_weather) -> status::wk_status,
    ) -> Result<Self, Refusal> {
        let text = CString::new(text.replace('\0', " ")).unwrap_or_default();
        let mut layers = [weather::wk_cloud_layer::INIT; LAYERS];
        let mut c = weather::wk_weather::INIT;
        done(fill(text.as_ptr(), layers.as_mut_ptr(), &raw mut c))?;
        let layers = layers.iter().take(c.cloud_count as usize).map(bytes_of).collect();
        Ok(Self { weather: bytes_of(&c), overrides: None, layers })
    }

    /// Reads a report (METAR).
    ///
    /// # Errors
    /// The errors of `wk_weather_from_metar`.
    pub fn of_metar(report: &str) -> Result<Self, Refusal> {
        let (capacity, size) = (LAYERS as u32, size_of::<weather::wk_cloud_layer>() as u32);
        // SAFETY: the pointers are to a text, to as many layers as is said, and to a struct.
        Self::filled(report, |text, layers, out| unsafe {
            report::wk_weather_from_metar(text, layers, capacity, size, out, null_mut())
        })
    }

    /// Returns a preset.
    ///
    /// # Errors
    /// The errors of `wk_weather_from_preset`.
    pub fn of_preset(name: &str) -> Result<Self, Refusal> {
        let (capacity, size) = (LAYERS as u32, size_of::<weather::wk_cloud_layer>() as u32);
        // SAFETY: as above.
        Self::filled(name, |text, layers, out| unsafe {
            report::wk_weather_from_preset(text, layers, capacity, size, out)
        })
    }
}

/// Bytes of a struct of the interface, without its pointers.
fn bytes_of<T: layout::Layout>(value: &T) -> StructBytes {
    let mut bytes = vec![0_u64; size_of::<T>().div_ceil(size_of::<u64>())];
    // SAFETY: `bytes` holds a `T`, which has no padding by the promise of `Layout`.
    unsafe { std::ptr::from_ref(value).copy_to_nonoverlapping(bytes.as_mut_ptr().cast(), 1) };
    sealed(T::INFO.name, &bytes).unwrap_or(bytes)
}

/// Element of a list of the C interface: its own struct, and the weather that it points to, if it has one.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct NamedItem {
    /// Bytes of the element's struct.
    pub own: StructBytes,
    /// Bytes of a `wk_weather`, for structs with a field `weather`.
    pub weather: Option<StructBytes>,
}

/// A context with one view on a device, behind the handles of the C interface.
pub struct NamedCalls {
    device: *mut wk_device,
    context: *mut wk_context,
    view: *mut wk_view,
}

impl NamedCalls {
    /// Creates a context and a view on a device. `desc` has the bytes of a `wk_context_desc`.
    ///
    /// # Errors
    /// The errors of `wk_context_create` and `wk_view_create`.
    pub fn new(gpu: &Arc<Device>, desc: &[u64]) -> Result<Self, Refusal> {
        let device = device::issue(gpu.clone(), Host::Own)
            .map_err(|e| Refusal { message: e.to_string(), field: String::new() })?;
        // From here on `drop` destroys whatever has been created.
        let mut calls = Self { device, context: null_mut(), view: null_mut() };
        let desc = sealed("wk_context_desc", desc)?;
        // SAFETY: the bytes are those of the struct, and the places are this function's.
        done(unsafe { context::wk_context_create(device, desc.as_ptr().cast(), &raw mut calls.context) })?;
        // SAFETY: as above.
        done(unsafe { view::wk_view_create(calls.context, null(), &raw mut calls.view) })?;
        Ok(calls)
    }

    /// Makes the call that takes one struct, by the call's name; `None` for `bytes` passes NULL. A call that also takes
    /// a time gets the present simulation time.
    ///
    /// # Errors
    /// The errors of the call; an unknown call; bytes of another number than the struct's.
    pub fn set(&self, call: &str, bytes: Option<&[u64]>) -> Result<(), Refusal> {
        let unknown = || Refusal { message: format!("there is no call {call} for one struct"), field: String::new() };
        let (_, name) = SETTERS.iter().find(|s| s.0 == call).ok_or_else(unknown)?;
        let bytes = bytes.map(|bytes| sealed(name, bytes)).transpose()?;
        let p = bytes.as_ref().map_or(null(), Vec::as_ptr);
        let (context, view) = (self.context, self.view);
        // SAFETY: `p` is NULL or points to the struct that the call takes, as `sealed` has checked.
        done(unsafe {
            match call {
                "wk_context_set_sun" => timeline::wk_context_set_sun(context, p.cast()),
                "wk_context_set_moon" => timeline::wk_context_set_moon(context, p.cast()),
                "wk_context_set_sky_settings" => sky::wk_context_set_sky_settings(context, p.cast()),
                "wk_context_set_fog_law" => fog_law::wk_context_set_fog_law(context, p.cast()),
                "wk_context_set_wind_field" => wind_field::wk_context_set_wind_field(context, p.cast(), self.time_s()),
                "wk_context_set_lightning" => lightning::wk_context_set_lightning(context, p.cast()),
                "wk_context_set_stars" => stars::wk_context_set_stars(context, p.cast()),
                "wk_context_set_sea" => sea::wk_context_set_sea(context, p.cast()),
                "wk_context_set_terrain_drawing" => terrain::wk_context_set_terrain_drawing(context, p.cast()),
                "wk_view_set_clouds" => clouds::wk_view_set_clouds(view, p.cast()),
                "wk_view_set_rain" => rain::wk_view_set_rain(view, p.cast()),
                "wk_view_set_snow" => snow::wk_view_set_snow(view, p.cast()),
                "wk_view_set_windscreen" => windscreen::wk_view_set_windscreen(view, p.cast()),
                _ => plan::wk_view_set_budget(view, p.cast()),
            }
        })
    }

    /// Makes the call that takes a list of structs, by the call's name.
    ///
    /// # Errors
    /// The errors of the call; an unknown call.
    pub fn set_list(&self, call: &str, items: &[NamedItem]) -> Result<(), Refusal> {
        let unknown = || Refusal { message: format!("there is no call {call} for a list"), field: String::new() };
        let list = LISTS.iter().find(|list| list.call == call).ok_or_else(unknown)?;
        let own = info(list.of).ok_or_else(unknown)?;
        let weather_at = own.fields.iter().find(|field| field.name == "weather").map(|field| field.offset);
        let (mut words, mut weathers) = (Vec::new(), Vec::new());
        for item in items {
            let mut bytes = sealed(list.of, &item.own)?;
            if let (Some(offset), Some(weather)) = (weather_at, &item.weather) {
                let weather = sealed("wk_weather", weather)?;
                bytes[offset / size_of::<u64>()] = weather.as_ptr() as u64;
                weathers.push(weather);
            }
            words.extend(bytes);
        }
        let p = if words.is_empty() { null() } else { words.as_ptr() };
        let (context, count, stride) = (self.context, items.len() as u32, own.size as u32);
        // SAFETY: `p` points to `count` structs, `stride` bytes apart, as `sealed` has checked. The weathers that they
        // point to live until the call has returned.
        done(unsafe {
            match call {
                "wk_context_set_rain_areas" => area::wk_context_set_rain_areas(context, p.cast(), count, stride),
                "wk_context_set_weather_regions" => {
                    region::wk_context_set_weather_regions(context, p.cast(), count, stride)
                }
                "wk_context_set_lights" => light::wk_context_set_lights(context, p.cast(), count, stride),
                _ => sea::wk_context_set_sea_hulls(context, p.cast(), count, stride),
            }
        })
    }

    /// Changes to a weather, beginning at simulation time `start_s` and lasting `transition_s`, s.
    ///
    /// # Errors
    /// The errors of `wk_context_set_weather`.
    pub fn set_weather(&self, given: &NamedWeather, start_s: f64, transition_s: f64) -> Result<(), Refusal> {
        let mut bytes = sealed("wk_weather", &given.weather)?;
        let overrides = given.overrides.as_ref().map(|b| sealed("wk_weather_overrides", b)).transpose()?;
        let mut layers = Vec::new();
        for layer in &given.layers {
            layers.extend(sealed("wk_cloud_layer", layer)?);
        }
        // SAFETY: `sealed` has checked that the bytes are those of the struct, which has no invalid bit patterns.
        let c = unsafe { &mut *bytes.as_mut_ptr().cast::<weather::wk_weather>() };
        c.next = overrides.as_ref().map_or(null(), |o| o.as_ptr().cast());
        c.clouds = if layers.is_empty() { null() } else { layers.as_ptr().cast() };
        c.cloud_count = given.layers.len() as u32;
        c.cloud_stride = size_of::<weather::wk_cloud_layer>() as u32;
        // SAFETY: the struct, its extension and its layers live until the call has returned.
        done(unsafe { timeline::wk_context_set_weather(self.context, c, start_s, transition_s) })
    }

    /// Gets a struct of answers by the name of the call, and the struct's name: the present conditions of the weather
    /// at a position, m, or the report of the last frame.
    ///
    /// # Errors
    /// The errors of the call; an unknown call.
    pub fn get(&self, call: &str, position_m: [f64; 3]) -> Result<(&'static str, StructBytes), Refusal> {
        let unknown = || Refusal { message: format!("there is no call {call} for answers"), field: String::new() };
        let (_, name) = GETTERS.iter().find(|s| s.0 == call).ok_or_else(unknown)?;
        let mut bytes = default_of(name).ok_or_else(unknown)?;
        let p = bytes.as_mut_ptr();
        // SAFETY: `p` points to the struct that the call fills.
        done(unsafe {
            match call {
                "wk_context_get_conditions" => {
                    let place = &raw const position_m;
                    super::conditions::wk_context_get_conditions(self.context, place, self.time_s(), p.cast())
                }
                _ => view::wk_view_get_report(self.view, p.cast()),
            }
        })?;
        Ok((name, bytes))
    }

    /// Simulation time of the context, s; 0 if an earlier call has panicked.
    pub fn time_s(&self) -> f64 {
        self.with(|_, context| context.time_s()).unwrap_or(0.0)
    }

    /// Calls `read` with the view and the context of the Rust API, and returns its result; `None` if an earlier call
    /// has panicked.
    pub fn with<R>(&self, read: impl FnOnce(&mut View, &mut Context) -> R) -> Option<R> {
        let object = handles::get::<ViewObject>("view", self.view).ok()?;
        object.cell.check_alive().ok()?;
        let (mut view, mut context) = (object.lock(), object.context.write());
        Some(read(&mut view, &mut context))
    }
}

impl Drop for NamedCalls {
    fn drop(&mut self) {
        // SAFETY: handles of this object or NULL, children first.
        unsafe {
            view::wk_view_destroy(self.view);
            context::wk_context_destroy(self.context);
            device::wk_device_destroy(self.device);
        }
    }
}

/// Calls that take one struct, each with the name of the struct.
pub const SETTERS: [(&str, &str); 14] = [
    ("wk_context_set_sun", "wk_given_direction"),
    ("wk_context_set_moon", "wk_given_direction"),
    ("wk_context_set_sky_settings", "wk_sky_settings"),
    ("wk_context_set_fog_law", "wk_fog_law"),
    ("wk_context_set_wind_field", "wk_wind_field"),
    ("wk_context_set_lightning", "wk_lightning"),
    ("wk_context_set_stars", "wk_stars"),
    ("wk_context_set_sea", "wk_sea"),
    ("wk_context_set_terrain_drawing", "wk_terrain_drawing"),
    ("wk_view_set_clouds", "wk_clouds"),
    ("wk_view_set_rain", "wk_rain"),
    ("wk_view_set_snow", "wk_snow"),
    ("wk_view_set_windscreen", "wk_windscreen"),
    ("wk_view_set_budget", "wk_budget"),
];

/// Call that takes a list of structs.
#[derive(Clone, Copy, Debug)]
pub struct NamedList {
    /// Name of the call.
    pub call: &'static str,
    /// Name of the struct of an element.
    pub of: &'static str,
    /// Largest number of elements.
    pub most: usize,
    /// Whether each element points to a weather.
    pub has_weather: bool,
}

/// Calls that take a list of structs.
pub const LISTS: [NamedList; 4] = [
    NamedList {
        call: "wk_context_set_rain_areas",
        of: "wk_rain_area",
        most: crate::rain::MAX_AREAS,
        has_weather: false,
    },
    NamedList {
        call: "wk_context_set_weather_regions",
        of: "wk_weather_region",
        most: crate::regions::MAX_WEATHER_REGIONS,
        has_weather: true,
    },
    NamedList { call: "wk_context_set_lights", of: "wk_light", most: crate::scene::MAX_LIGHTS, has_weather: false },
    NamedList {
        call: "wk_context_set_sea_hulls",
        of: "wk_sea_hull",
        most: crate::sea::MAX_SEA_HULLS,
        has_weather: false,
    },
];

/// Calls that fill one struct of answers, each with the name of the struct.
pub const GETTERS: [(&str, &str); 2] =
    [("wk_context_get_conditions", "wk_conditions"), ("wk_view_get_report", "wk_report")];
