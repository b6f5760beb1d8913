//! Everything that is set: the structs of the C interface as bytes. It is compared, undone, handed to the library, and
//! written to and read from a file.

use std::collections::BTreeMap;

use welkin::capi::by_name::{
    LISTS, NamedCalls, NamedItem, NamedList, NamedWeather, Refusal, SETTERS, StructBytes, default_of,
};

use crate::{
    bytes,
    table::{self, Row},
};

/// Struct that is set.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Part {
    /// Description of the context: place, axes, exposure. Its change makes a new context.
    World,
    /// The weather.
    Weather,
    /// Quantities that stand in place of those that the weather gives.
    Overrides,
    /// A cloud layer, from 0.
    Layer(usize),
    /// Struct of a call, by the call's name.
    Call(&'static str),
    /// Element of the list with this index in [`LISTS`], from 0.
    Item(usize, usize),
    /// Weather of an element of a list.
    ItemWeather(usize, usize),
}

pub use welkin::weather::MAX_CLOUD_LAYERS as LAYERS;

impl Part {
    /// Name of the struct.
    pub fn structure(self) -> &'static str {
        match self {
            Self::World => "wk_context_desc",
            Self::Weather => "wk_weather",
            Self::Overrides => "wk_weather_overrides",
            Self::Layer(_) => "wk_cloud_layer",
            Self::Call(call) => SETTERS.iter().find(|s| s.0 == call).map_or("", |s| s.1),
            Self::Item(list, _) => LISTS.get(list).map_or("", |list| list.of),
            Self::ItemWeather(..) => "wk_weather",
        }
    }

    /// Short name for files and scripts: `weather`, `layer1`, `sea`, `light1`, `weather_region1`,
    /// `weather_of_region1`.
    pub fn key(self) -> String {
        match self {
            Self::World => "world".into(),
            Self::Weather => "weather".into(),
            Self::Overrides => "overrides".into(),
            Self::Layer(i) => format!("layer{}", i + 1),
            Self::Call(call) => call.rsplit_once("_set_").map_or(call, |split| split.1).into(),
            Self::Item(_, i) => format!("{}{}", self.structure().trim_start_matches("wk_"), i + 1),
            Self::ItemWeather(list, i) => format!("weather_of_{}", Self::Item(list, i).key().replace("weather_", "")),
        }
    }

    /// All parts, with `layers` cloud layers and, for each of [`LISTS`], as many elements as `items` says.
    fn all(layers: usize, items: impl Fn(usize) -> usize) -> Vec<Self> {
        let weather = [Self::World, Self::Weather, Self::Overrides].into_iter();
        let item = |list: usize, i: usize| {
            let weather = LISTS[list].has_weather.then_some(Self::ItemWeather(list, i));
            [Self::Item(list, i)].into_iter().chain(weather)
        };
        let items = (0..LISTS.len()).flat_map(|list| (0..items(list)).flat_map(move |i| item(list, i)));
        let calls = SETTERS.iter().map(|s| Self::Call(s.0));
        weather.chain((0..layers).map(Self::Layer)).chain(calls).chain(items).collect()
    }

    /// One part of each kind.
    pub fn kinds() -> Vec<Self> {
        Self::all(1, |_| 1)
    }

    /// Part of a short name; elements of lists beyond the last have names too.
    pub fn of_key(key: &str) -> Result<Self, String> {
        let all = Self::all(LAYERS, |list| LISTS[list].most);
        let known = |part: &&Self| part.key() == key;
        all.iter().find(known).copied().ok_or_else(|| {
            let keys: Vec<String> = Self::kinds().into_iter().map(Self::key).collect();
            let most = LISTS.iter().map(|list| list.most).fold(LAYERS, usize::max);
            format!("`{key}` is not one of {} (lists have up to {LAYERS} or {most} elements)", keys.join(", "))
        })
    }

    /// Whether the part is there as long as the part that it belongs to.
    pub fn is_fixed(self) -> bool {
        matches!(self, Self::World | Self::Weather | Self::ItemWeather(..))
    }
}

/// Returns a new element of a list. Elements with a number of their own get the next one.
fn new_item(list: &NamedList, index: usize) -> NamedItem {
    let mut own = default_of(list.of).unwrap_or_default();
    if let Some(row) = table::rows(list.of).iter().find(|row| row.field.name == "id") {
        bytes::set_integer(&mut own, &row.field, 0, index as u64 + 1);
    }
    NamedItem { own, weather: if list.has_weather { default_of("wk_weather") } else { None } }
}

/// Returns the bytes of a part that is new.
fn new_bytes(part: Part) -> StructBytes {
    match part {
        Part::Item(list, i) => new_item(&LISTS[list], i).own,
        other => default_of(other.structure()).unwrap_or_default(),
    }
}

/// Everything that is set.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Settings {
    world: StructBytes,
    weather: NamedWeather,
    calls: BTreeMap<&'static str, Option<StructBytes>>,
    /// Elements of each of [`LISTS`].
    lists: [Vec<NamedItem>; LISTS.len()],
}

impl Default for Settings {
    fn default() -> Self {
        let bytes = |name| default_of(name).unwrap_or_default();
        let weather = NamedWeather { weather: bytes("wk_weather"), overrides: None, layers: Vec::new() };
        // The studio's world has terrain, which would not be seen otherwise.
        let is_on = |call: &str| call == "wk_context_set_terrain_drawing";
        let calls = SETTERS.iter().map(|s| (s.0, is_on(s.0).then(|| bytes(s.1)))).collect();
        Self { world: bytes("wk_context_desc"), weather, calls, lists: Default::default() }
    }
}

impl Settings {
    /// Replaces the weather.
    pub fn set_weather(&mut self, weather: NamedWeather) {
        self.weather = weather;
    }

    /// Number of cloud layers.
    pub fn layers(&self) -> usize {
        self.weather.layers.len()
    }

    /// Number of elements of the list with an index in [`LISTS`].
    pub fn items(&self, list: usize) -> usize {
        self.lists[list].len()
    }

    /// Parts that there may be now.
    pub fn parts(&self) -> Vec<Part> {
        Part::all(self.layers(), |list| self.items(list))
    }

    /// Bytes of a part; `None` where the library's own choice holds.
    pub fn bytes(&self, part: Part) -> Option<&StructBytes> {
        match part {
            Part::World => Some(&self.world),
            Part::Weather => Some(&self.weather.weather),
            Part::Overrides => self.weather.overrides.as_ref(),
            Part::Layer(i) => self.weather.layers.get(i),
            Part::Call(call) => self.calls.get(call)?.as_ref(),
            Part::Item(list, i) => self.lists[list].get(i).map(|item| &item.own),
            Part::ItemWeather(list, i) => self.lists[list].get(i)?.weather.as_ref(),
        }
    }

    /// Bytes of a part to change.
    pub fn bytes_mut(&mut self, part: Part) -> Option<&mut StructBytes> {
        match part {
            Part::World => Some(&mut self.world),
            Part::Weather => Some(&mut self.weather.weather),
            Part::Overrides => self.weather.overrides.as_mut(),
            Part::Layer(i) => self.weather.layers.get_mut(i),
            Part::Call(call) => self.calls.get_mut(call)?.as_mut(),
            Part::Item(list, i) => self.lists[list].get_mut(i).map(|item| &mut item.own),
            Part::ItemWeather(list, i) => self.lists[list].get_mut(i)?.weather.as_mut(),
        }
    }

    /// Gives a part its defaults, or leaves it to the library. The elements of a list before one that is added are
    /// added too; one that is taken away takes those after it along.
    pub fn switch(&mut self, part: Part, on: bool) {
        let bytes = new_bytes(part);
        match part {
            Part::World | Part::Weather => {}
            Part::Overrides => self.weather.overrides = on.then_some(bytes),
            Part::Layer(i) if on => self.weather.layers.resize_with(self.layers().max(i + 1), || bytes.clone()),
            Part::Layer(i) => self.weather.layers.truncate(i),
            Part::Call(call) => {
                self.calls.insert(call, on.then_some(bytes));
            }
            Part::Item(list, i) if on => {
                let items = &mut self.lists[list];
                (items.len()..=i).for_each(|new| items.push(new_item(&LISTS[list], new)));
            }
            Part::Item(list, i) => self.lists[list].truncate(i),
            Part::ItemWeather(list, i) if on => self.switch(Part::Item(list, i), true),
            Part::ItemWeather(..) => {}
        }
    }

    /// Takes one cloud layer or one element of a list away.
    pub fn remove(&mut self, part: Part) {
        match part {
            Part::Layer(i) if i < self.layers() => drop(self.weather.layers.remove(i)),
            Part::Item(list, i) if i < self.items(list) => drop(self.lists[list].remove(i)),
            other => self.switch(other, false),
        }
    }

    /// Whether a new context is needed to get here from `before`.
    pub fn needs_new_context(&self, before: &Self) -> bool {
        self.world != before.world
    }

    /// Bytes of the context's description.
    pub fn world(&self) -> &StructBytes {
        &self.world
    }

    /// Hands what differs from `before` to the library, all of it without one. A weather fades in over `transition_s`.
    /// Returns what was refused.
    pub fn apply(&self, calls: &NamedCalls, before: Option<&Self>, transition_s: f64) -> Vec<(Part, Refusal)> {
        let mut refused = Vec::new();
        if before.is_none_or(|before| before.weather != self.weather)
            && let Err(refusal) = calls.set_weather(&self.weather, calls.time_s(), transition_s)
        {
            refused.push((self.place_of(&refusal), refusal));
        }
        for (call, bytes) in &self.calls {
            if before.and_then(|before| before.calls.get(call)) == Some(bytes) || (before.is_none() && bytes.is_none())
            {
                continue;
            }
            if let Err(refusal) = calls.set(call, bytes.as_deref()) {
                refused.push((Part::Call(call), refusal));
            }
        }
        for (list, items) in self.lists.iter().enumerate() {
            if before.map_or(items.is_empty(), |before| before.lists[list] == *items) {
                continue;
            }
            if let Err(refusal) = calls.set_list(LISTS[list].call, items) {
                refused.push((self.item_of(list, &refusal), refusal));
            }
        }
        refused
    }

    /// Part of a list that a refusal is about.
    fn item_of(&self, list: usize, refusal: &Refusal) -> Part {
        let index = refusal.field.split_once('[').and_then(|(_, rest)| rest.split(']').next()?.parse().ok());
        let index = index.unwrap_or(0).min(self.items(list).saturating_sub(1));
        let is_of_weather = LISTS[list].has_weather && refusal.field.contains(".weather");
        if is_of_weather { Part::ItemWeather(list, index) } else { Part::Item(list, index) }
    }

    /// Part of the weather that a refusal is about.
    fn place_of(&self, refusal: &Refusal) -> Part {
        if refusal.field.starts_with("wk_weather_overrides") {
            return Part::Overrides;
        }
        let layer = refusal.field.split_once("clouds[").and_then(|(_, rest)| rest.split(']').next()?.parse().ok());
        layer.map_or(Part::Weather, Part::Layer)
    }
}

/// A field's value as the settings file has it.
fn value(bytes: &[u64], row: &Row) -> toml::Value {
    let one = |i: usize| {
        let word = bytes::integer(bytes, &row.field, i);
        if row.choices.is_empty() {
            let number = bytes::number(bytes, &row.field, i);
            let is_whole = matches!(row.field.kind, welkin::capi::by_name::NamedKind::Integer(_));
            return if is_whole { toml::Value::Integer(word as i64) } else { toml::Value::Float(number) };
        }
        let name = |c: &table::Choice| toml::Value::String(c.name.clone());
        if row.is_union() {
            return row.choices.iter().filter(|c| word & c.value != 0).map(name).collect::<Vec<_>>().into();
        }
        row.choices.iter().find(|c| c.value == word).map_or(toml::Value::Integer(word as i64), name)
    };
    if row.field.count == 1 { one(0) } else { (0..row.field.count).map(one).collect::<Vec<_>>().into() }
}

/// Writes a field's value from a settings file or a script.
fn set_value(bytes: &mut StructBytes, row: &Row, value: &toml::Value) -> Result<(), String> {
    let place = format!("{}.{}", row.of, row.field.name);
    let named = |text: &str| {
        let names = || row.choices.iter().map(|c| c.name.as_str()).collect::<Vec<_>>().join(", ");
        let found = row.choices.iter().find(|c| c.name == text);
        found.map(|c| c.value).ok_or_else(|| format!("{place} is one of {}; got `{text}`", names()))
    };
    let number = |value: &toml::Value| match value {
        toml::Value::Integer(i) => Ok(*i as f64),
        toml::Value::Float(f) => Ok(*f),
        other => Err(format!("{place} is a number{}; got {other}", row.limits_text())),
    };
    match value {
        toml::Value::String(text) if !row.choices.is_empty() => {
            bytes::set_integer(bytes, &row.field, 0, named(text)?);
        }
        toml::Value::Array(names) if row.is_union() => {
            let mut all = 0;
            for name in names {
                all |= named(name.as_str().ok_or_else(|| format!("{place} is a list of names; got {name}"))?)?;
            }
            bytes::set_integer(bytes, &row.field, 0, all);
        }
        toml::Value::Array(elements) if row.field.count > 1 => {
            if elements.len() != row.field.count {
                return Err(format!("{place} has {} numbers; got {}", row.field.count, elements.len()));
            }
            for (i, element) in elements.iter().enumerate() {
                bytes::set_number(bytes, &row.field, i, number(element)?);
            }
        }
        toml::Value::Integer(whole) => match row.field.kind {
            welkin::capi::by_name::NamedKind::Float(_) => bytes::set_number(bytes, &row.field, 0, *whole as f64),
            _ => bytes::set_integer(bytes, &row.field, 0, *whole as u64),
        },
        one => bytes::set_number(bytes, &row.field, 0, number(one)?),
    }
    table::turn(bytes, row, true);
    Ok(())
}

impl Row {
    /// The accepted range as text, with a space before it; empty without one.
    pub fn limits_text(&self) -> String {
        self.limits.map_or(String::new(), |[low, high]| format!(" in [{low}, {high}]"))
    }
}

impl Settings {
    /// Sets one field by its name; turns its part on.
    ///
    /// # Errors
    /// The name or the value is wrong; nothing has changed then.
    pub fn set(&mut self, part: Part, field: &str, value: &toml::Value) -> Result<(), String> {
        let rows = table::rows(part.structure());
        let row = rows.iter().find(|row| row.field.name == field).ok_or_else(|| {
            let names: Vec<&str> = rows.iter().map(|row| row.field.name).collect();
            format!("{} has no field `{field}` to set; it has {}", part.structure(), names.join(", "))
        })?;
        let mut changed = self.clone();
        if changed.bytes(part).is_none() {
            changed.switch(part, true);
        }
        let bytes = changed.bytes_mut(part).ok_or_else(|| format!("there is no {}", part.key()))?;
        set_value(bytes, row, value)?;
        *self = changed;
        Ok(())
    }

    /// Everything that differs from the defaults, as a settings file.
    pub fn to_toml(&self) -> String {
        let mut file = toml::Table::new();
        for part in self.parts() {
            let Some(bytes) = self.bytes(part) else {
                if Self::default().bytes(part).is_some() {
                    file.insert(part.key(), false.into());
                }
                continue;
            };
            let default = new_bytes(part);
            let mut own = toml::Table::new();
            for row in table::rows(part.structure()) {
                let is_set = row.is_optional() && table::is_on(bytes, row);
                if is_set || (!row.is_optional() && value(bytes, row) != value(&default, row)) {
                    own.insert(row.field.name.into(), value(bytes, row));
                }
            }
            let stays = part.is_fixed() && own.is_empty();
            if !stays {
                file.insert(part.key(), own.into());
            }
        }
        toml::to_string(&file).unwrap_or_default()
    }

    /// Reads a settings file.
    ///
    /// # Errors
    /// A sentence that names the place.
    pub fn from_toml(text: &str) -> Result<Self, String> {
        let file: toml::Table = text.parse().map_err(|e: toml::de::Error| e.to_string())?;
        let mut settings = Self::default();
        for (key, own) in &file {
            let part = Part::of_key(key)?;
            if own.as_bool() == Some(false) {
                settings.switch(part, false);
                continue;
            }
            let own = own.as_table().ok_or_else(|| format!("{key} is a table of fields, or false; got {own}"))?;
            if settings.bytes(part).is_none() {
                settings.switch(part, true);
            }
            for (field, value) in own {
                settings.set(part, field, value)?;
            }
        }
        Ok(settings)
    }
}
